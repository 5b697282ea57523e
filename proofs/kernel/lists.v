(* Lists of binary integers, and the vectors, matrices and polynomials that they stand for.

   The kernel computes on rows (`zrow`), matrices (`zmat`, a list of rows) and polynomials (a `zrow`, constant term
   first) of Coq's binary integers.  A list that is too short stands for zeros.  `phi` takes an integer into any
   commutative ring; `cv`, `mx` and `pol` take lists to MathComp's column vectors, matrices and polynomials over this
   ring, of the size that is asked for.  Every function here has a lemma that says which operation on these it is.
   So one computation is about Q, about a field that contains Q, and modulo l. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Delimit Scope Z_scope with coqZ.
Notation z0 := (0%coqZ : Z).

(* Coq's binary integers in MathComp's: a morphism of rings. *)
Definition int_of_Z (z : Z) : int :=
  match z with Z0 => 0 | Zpos p => Posz (Pos.to_nat p) | Zneg p => Negz (Pos.to_nat p).-1 end.
Lemma int_of_Z_nat n : int_of_Z (Z.of_nat n) = n.
Proof. by case: n => [//|n]; rewrite /= SuccNat2Pos.id_succ. Qed.
Lemma int_of_ZN z : int_of_Z (- z) = (- int_of_Z z)%R.
Proof.
case: z => [|p|p] //=; first by rewrite NegzE prednK ?oppr0//; apply/ltP/Pos2Nat.is_pos.
by rewrite NegzE prednK ?opprK//; apply/ltP/Pos2Nat.is_pos.
Qed.
Lemma int_of_ZM a b : int_of_Z (a * b) = (int_of_Z a * int_of_Z b)%R.
Proof.
have pos x y : int_of_Z (Zpos x * Zpos y) = (int_of_Z (Zpos x) * int_of_Z (Zpos y))%R.
  by rewrite /= Pos2Nat.inj_mul PoszM.
have neg p : Zneg p = (- Zpos p)%coqZ by [].
case: a b => [|x|x] [|y|y] //; rewrite ?mulr0 ?mul0r //; rewrite ?neg ?Z.mul_opp_l ?Z.mul_opp_r ?int_of_ZN ?pos ?mulrN ?mulNr //.
Qed.
Lemma int_of_ZD a b : int_of_Z (a + b) = (int_of_Z a + int_of_Z b)%R.
Proof.
have pp x y : int_of_Z (Zpos x + Zpos y) = (int_of_Z (Zpos x) + int_of_Z (Zpos y))%R.
  by rewrite /= Pos2Nat.inj_add PoszD.
have pn x y : int_of_Z (Zpos x + Zneg y) = (int_of_Z (Zpos x) + int_of_Z (Zneg y))%R.
  have -> : Zneg y = (- Zpos y)%coqZ by []. rewrite int_of_ZN.
  case: (Z.compare_spec (Zpos x) (Zpos y)) => [->|lt|lt].
  - by rewrite Z.add_opp_diag_r subrr.
  - have -> : (Zpos x + - Zpos y = - (Zpos y - Zpos x))%coqZ by rewrite Z.opp_sub_distr Z.add_comm.
    have [d ->] : exists d, (Zpos y = Zpos x + Zpos d)%coqZ.
      exists (y - x)%positive; rewrite -Pos2Z.inj_add; congr Zpos; rewrite Pos.add_comm Pos.sub_add //.
    by rewrite Z.add_simpl_l int_of_ZN pp opprD addrA subrr add0r.
  have [d ->] : exists d, (Zpos x = Zpos y + Zpos d)%coqZ.
    exists (x - y)%positive; rewrite -Pos2Z.inj_add; congr Zpos; rewrite Pos.add_comm Pos.sub_add //.
  by rewrite Z.add_opp_r Z.add_simpl_l pp addrAC subrr add0r.
have np x y : int_of_Z (Zneg x + Zpos y) = (int_of_Z (Zneg x) + int_of_Z (Zpos y))%R.
  by rewrite Z.add_comm pn addrC.
have nn x y : int_of_Z (Zneg x + Zneg y) = (int_of_Z (Zneg x) + int_of_Z (Zneg y))%R.
  have neg p : Zneg p = (- Zpos p)%coqZ by [].
  by rewrite !neg -Z.opp_add_distr !int_of_ZN pp opprD.
case: a b => [|x|x] [|y|y]; rewrite ?Z.add_0_l ?Z.add_0_r ?pp ?pn ?np ?nn /int_of_Z ?add0r ?addr0 //.
Qed.


(* What is computed. *)
Definition zrow := seq Z.
Definition zmat := seq zrow.
Fixpoint zdot_acc (acc : Z) (u v : zrow) : Z :=
  match u, v with x :: u', y :: v' => zdot_acc (acc + x * y)%coqZ u' v' | _, _ => acc end.
Definition zdot := zdot_acc z0.
(* M v, and the row u M *)
Definition zmv (M : zmat) (v : zrow) : zrow := [seq zdot r v | r <- M].
(* k u + v *)
Fixpoint zaxpy (k : Z) (u v : zrow) : zrow :=
  match u, v with
  | [::], _ => v
  | x :: u', [::] => (k * x)%coqZ :: zaxpy k u' [::]
  | x :: u', y :: v' => (k * x + y)%coqZ :: zaxpy k u' v' end.
Definition zvm (u : zrow) (M : zmat) : zrow :=
  foldr (fun ur acc => if Z.eqb ur.1 0 then acc else zaxpy ur.1 ur.2 acc) [::] (zip u M).
Definition zmm (M N : zmat) : zmat := [seq zvm u N | u <- M].
Fixpoint zmaxpy (k : Z) (M N : zmat) : zmat :=
  match M, N with
  | [::], _ => N
  | u :: M', [::] => zaxpy k u [::] :: zmaxpy k M' [::]
  | u :: M', v :: N' => zaxpy k u v :: zmaxpy k M' N' end.
Definition zmod l (v : zrow) : zrow := [seq Z.modulo x l | x <- v].
Definition zmat_mod l (M : zmat) : zmat := [seq zmod l r | r <- M].
Definition zscale_mod l k (M : zmat) : zmat := [seq [seq Z.modulo (k * x) l | x <- r] | r <- M].
Definition zrow0 (v : zrow) : bool := all (fun x => Z.eqb x 0) v.
Definition zmat0 (M : zmat) : bool := all zrow0 M.
Definition zero_mod l (v : zrow) : bool := all (fun x => Z.eqb (Z.modulo x l) 0) v.
Definition zmat0_mod l (M : zmat) : bool := all (zero_mod l) M.
(* d times the unit row r, and d times the identity matrix *)
Definition zunit (d : Z) (r : nat) : zrow := ncons r z0 [:: d].
Definition zidentity (d : Z) (n : nat) : zmat := [seq zunit d r | r <- iota 0 n].
Definition shape (a b : nat) (M : zmat) : bool := (size M == a) && all (fun r : zrow => size r == b) M.
(* polynomials *)
Fixpoint zpmul (f g : zrow) : zrow := match f with [::] => [::] | x :: f' => zaxpy x g (z0 :: zpmul f' g) end.
Definition zppow (f : zrow) (k : nat) : zrow := iter k (zpmul f) [:: 1%coqZ].
Fixpoint zderiv (k : Z) (p : zrow) : zrow := match p with [::] => [::] | a :: p' => (k * a)%coqZ :: zderiv (k + 1) p' end.
Definition zderivative (p : zrow) : zrow := zderiv 1 (behead p).
(* p over its last coefficient is q over its last coefficient, and these are not 0 *)
Definition same_up_to_scale (p q : zrow) : bool :=
  [&& ~~ Z.eqb (last z0 p) 0, ~~ Z.eqb (last z0 q) 0 &
      zrow0 (zaxpy (- last z0 q) p (zaxpy (last z0 p) q [::]))].
Fixpoint zeq (a b : zrow) : bool :=
  match a, b with [::], [::] => true | x :: a', y :: b' => Z.eqb x y && zeq a' b' | _, _ => false end.
Lemma zeqP a b : zeq a b -> a = b.
Proof. by elim: a b => [|x a IH] [|y b] //= /andP[/Z.eqb_eq -> /IH ->]. Qed.

Local Open Scope ring_scope.

Lemma int_of_Z_eq0 z : int_of_Z z = 0 -> z = z0.
Proof.
case: z => [//|p|p] //= e; have := Pos2Nat.is_pos p; case: (Pos.to_nat p) e => [|k] //; last first.
by move=> _ /ltP; rewrite ltnn.
Qed.

Section Ring.
Variable R : comRingType.
Definition phi (z : Z) : R := (int_of_Z z)%:~R.
Lemma phi0 : phi 0%coqZ = 0. Proof. by []. Qed.
Lemma phi1 : phi 1%coqZ = 1. Proof. by []. Qed.
Lemma phiD a b : phi (a + b)%coqZ = phi a + phi b. Proof. by rewrite /phi int_of_ZD rmorphD. Qed.
Lemma phiM a b : phi (a * b)%coqZ = phi a * phi b. Proof. by rewrite /phi int_of_ZM rmorphM. Qed.
Lemma phiN1 : phi (-1)%coqZ = -1. Proof. by []. Qed.
Lemma phiN a : phi (- a)%coqZ = - phi a. Proof. by rewrite /phi int_of_ZN rmorphN. Qed.

Lemma nth_phi (v : zrow) i : nth 0 [seq phi x | x <- v] i = phi (nth z0 v i).
Proof. by have [h|h] := ltnP i (size v); [rewrite (nth_map z0)|rewrite !nth_default ?size_map]. Qed.

Definition cv a (v : zrow) : 'cV[R]_a := \col_j phi (nth z0 v j).
Definition mx a b (M : zmat) : 'M[R]_(a, b) := \matrix_(i, j) phi (nth z0 (nth [::] M i) j).
Lemma mx_nil a b : mx a b [::] = 0.
Proof. by apply/matrixP=> i j; rewrite !mxE !nth_nil. Qed.

Lemma zdot_accE b acc u v : (size u <= b)%N ->
  phi (zdot_acc acc u v) = phi acc + \sum_(j < b) phi (nth z0 u j) * phi (nth z0 v j).
Proof.
elim: u v b acc => [|x u IH] v b acc /=.
  by move=> _; rewrite big1 ?addr0 // => j _; rewrite nth_nil mul0r.
case: b => [//|b]; rewrite ltnS => sb; case: v => [|y v].
  by rewrite big1 ?addr0 // => j _; rewrite nth_nil mulr0.
by rewrite (IH _ b) // phiD phiM big_ord_recl /= addrA.
Qed.
Lemma zdotE b u v : (size u <= b)%N -> phi (zdot u v) = \sum_(j < b) phi (nth z0 u j) * phi (nth z0 v j).
Proof. by move=> s; rewrite /zdot (zdot_accE _ _ s) phi0 add0r. Qed.

Lemma shapeP a b M : shape a b M -> size M = a /\ forall i, (size (nth [::] M i) <= b)%N.
Proof.
case/andP=> /eqP s /(all_nthP [::]) h; split=> // i; have [il|il] := ltnP i (size M); last by rewrite nth_default.
by rewrite (eqP (h _ il)).
Qed.

Lemma zmvE a b M v : shape a b M -> cv a (zmv M v) = mx a b M *m cv b v.
Proof.
move/shapeP=> [s h]; apply/matrixP=> i j; rewrite !mxE (nth_map [::]) ?s // (zdotE _ (h i)).
by apply: eq_bigr => k _; rewrite !mxE.
Qed.

Lemma zaxpy_nth k u v j : phi (nth z0 (zaxpy k u v) j) = phi k * phi (nth z0 u j) + phi (nth z0 v j).
Proof.
elim: u v j => [|x u IH] v j; first by rewrite nth_nil phi0 mulr0 add0r.
by case: v => [|y v]; case: j => [|j] /=; rewrite ?IH ?phiD ?phiM ?nth_nil ?phi0 ?addr0.
Qed.
Lemma zaxpyE n k u v : cv n (zaxpy k u v) = phi k *: cv n u + cv n v.
Proof. by apply/matrixP=> i j; rewrite !mxE zaxpy_nth. Qed.
Lemma zmaxpy_nth k M N i j : phi (nth z0 (nth [::] (zmaxpy k M N) i) j) =
  phi k * phi (nth z0 (nth [::] M i) j) + phi (nth z0 (nth [::] N i) j).
Proof.
elim: M N i => [|u M IH] N i; first by rewrite !nth_nil phi0 mulr0 add0r.
case: N => [|v N]; case: i => [|i]; rewrite [zmaxpy _ _ _]/= [nth _ (_ :: _) _]/= ?zaxpy_nth ?IH //.
by rewrite !nth_nil.
Qed.
Lemma zmaxpyE a b k M N : mx a b (zmaxpy k M N) = phi k *: mx a b M + mx a b N.
Proof. by apply/matrixP=> i j; rewrite !mxE zmaxpy_nth. Qed.
Lemma zvm_nth u M q j : (size u <= q)%N || (size M <= q)%N ->
  phi (nth z0 (zvm u M) j) = \sum_(k < q) phi (nth z0 u k) * phi (nth z0 (nth [::] M k) j).
Proof.
elim: u M q => [|x u IH] M q.
  move=> _; have -> : zvm [::] M = [::] by case: M.
  by rewrite nth_nil phi0 big1 // => k _; rewrite nth_nil phi0 mul0r.
case: M => [|r M]; first by move=> _; rewrite [zvm _ _]/= nth_nil phi0 big1 // => k _; rewrite !nth_nil phi0 mulr0.
case: q => [//|q]; rewrite !ltnS => h; rewrite big_ord_recl -(IH M q h) /zvm /=.
case: Z.eqb_spec => [->|_]; first by rewrite phi0 mul0r add0r.
by rewrite zaxpy_nth.
Qed.
Lemma zmmE a b c M N : (size N <= c)%N -> mx a b (zmm M N) = mx a c M *m mx c b N.
Proof.
move=> h; apply/matrixP=> i j; rewrite !mxE.
have [il|il] := ltnP i (size M).
  rewrite (nth_map [::]) // (zvm_nth _ (q := c)) ?h ?orbT //; apply: eq_bigr => k _; by rewrite !mxE.
rewrite (@nth_default _ [::]) ?size_map // nth_nil phi0 big1 // => k _; rewrite mxE (@nth_default _ [::] M) // nth_nil phi0 mul0r //.
Qed.
Lemma zrow0_nth v j : zrow0 v -> phi (nth z0 v j) = 0.
Proof.
move/(all_nthP z0)=> h; have [il|il] := ltnP j (size v); last by rewrite nth_default.
by have /Z.eqb_eq -> := h _ il.
Qed.
Lemma zmat0E a b M : zmat0 M -> mx a b M = 0.
Proof.
move/(all_nthP [::])=> h; apply/matrixP=> i j; rewrite !mxE; have [il|il] := ltnP i (size M).
  by rewrite zrow0_nth //; apply: h.
by rewrite (@nth_default _ [::] M i il) nth_nil.
Qed.

(* polynomials *)
Definition pol (v : zrow) : {poly R} := Poly [seq phi x | x <- v].
Lemma polE v i : (pol v)`_i = phi (nth z0 v i). Proof. by rewrite coef_Poly nth_phi. Qed.
Lemma pol_axpy k u v : pol (zaxpy k u v) = (phi k)%:P * pol u + pol v.
Proof. by apply/polyP=> i; rewrite coefD coefCM !polE zaxpy_nth. Qed.
Lemma pol_cons y u : pol (y :: u) = pol u * 'X + (phi y)%:P.
Proof. by rewrite /pol /= cons_poly_def. Qed.
Lemma pol_one : pol [:: 1%coqZ] = 1.
Proof. by rewrite pol_cons /pol /= mul0r add0r phi1. Qed.
Lemma pol_mul f g : pol (zpmul f g) = pol f * pol g.
Proof.
elim: f => [|x f IH]; first by rewrite /pol /= mul0r.
rewrite [zpmul _ _]/= pol_axpy !pol_cons IH phi0 addr0 mulrDl addrC; congr (_ + _).
by rewrite mulrAC.
Qed.
Lemma pol_zero0 v : zrow0 v -> pol v = 0.
Proof. by move=> h; apply/polyP=> i; rewrite polE coef0 zrow0_nth. Qed.
Lemma size_pol v : phi (last z0 v) != 0 -> size (pol v) = size v.
Proof.
case: v => [|x v] /= nz; first by rewrite /pol size_poly0.
by rewrite /pol (PolyK (c := 0)) ?size_map //= last_map.
Qed.
Lemma lead_pol v : phi (last z0 v) != 0 -> lead_coef (pol v) = phi (last z0 v).
Proof. by move=> nz; rewrite lead_coefE size_pol // polE nth_last. Qed.
Lemma pol_derivative v : pol (zderivative v) = (pol v)^`().
Proof.
have step k u i : phi (nth z0 (zderiv k u) i) = (phi k + i%:R) * phi (nth z0 u i).
  elim: u k i => [|x u IH] k i; first by rewrite /= !nth_nil phi0 mulr0.
  case: i => [|i] /=; first by rewrite addr0 phiM.
  by rewrite IH phiD phi1 -addrA -mulrS.
apply/polyP=> i; rewrite coef_deriv !polE /zderivative step nth_behead phi1 -mulrS mulr_natl //.
Qed.

Lemma pol_pow f k : pol (zppow f k) = pol f ^+ k.
Proof. by elim: k => [|k IH]; rewrite ?pol_one // /zppow iterS pol_mul IH exprS. Qed.
Lemma zidentityE d n : mx n n (zidentity d n) = (phi d)%:M.
Proof.
apply/matrixP=> i j; rewrite !mxE (nth_map 0%N) ?size_iota // nth_iota // add0n /zunit nth_ncons -val_eqE /=.
case: ltngtP => ij; rewrite ?mulr1n ?mulr0n ?phi0 //; last by rewrite ij subnn.
by rewrite nth_default // subn_gt0.
Qed.
Section Modulus.
Variable lz : Z.
Hypotheses (l0 : (0 < lz)%coqZ) (phil : phi lz = 0).
Lemma phi_mod a : phi (a mod lz)%coqZ = phi a.
Proof.
have ne : lz <> 0%coqZ by move=> e; move: l0; rewrite e.
by rewrite [in RHS](Z.div_mod a lz ne) phiD phiM phil mul0r add0r.
Qed.
Lemma phi_eq0 a : Z.eqb (a mod lz) 0 -> phi a = 0.
Proof. by move/Z.eqb_eq => e; rewrite -phi_mod e. Qed.
Lemma zmod_nth v j : phi (nth z0 (zmod lz v) j) = phi (nth z0 v j).
Proof.
have [h|h] := ltnP j (size v); last by rewrite !nth_default ?size_map.
by rewrite (nth_map z0) // phi_mod.
Qed.
Lemma zmodE n v : cv n (zmod lz v) = cv n v.
Proof. by apply/matrixP=> i j; rewrite !mxE zmod_nth. Qed.
Lemma zero_modE n v : zero_mod lz v -> cv n v = 0.
Proof.
move/(all_nthP z0)=> h; apply/matrixP=> i j; rewrite !mxE; have [il|il] := ltnP i (size v).
  by rewrite phi_eq0 // h.
by rewrite nth_default.
Qed.
Lemma zscaleE a b k M : mx a b (zscale_mod lz k M) = phi k *: mx a b M.
Proof.
apply/matrixP=> i j; rewrite !mxE; have [il|il] := ltnP i (size M); last first.
  by rewrite !nth_default ?size_map // ?nth_nil ?phi0 ?mulr0.
rewrite (nth_map [::]) //; have [jl|jl] := ltnP j (size (nth [::] M i)); last first.
  by rewrite [in LHS]nth_default ?size_map // [in RHS]nth_default // phi0 mulr0.
by rewrite (nth_map z0) // phi_mod phiM.
Qed.
Lemma pol_zero v : zero_mod lz v -> pol v = 0.
Proof.
move/(all_nthP z0)=> h; apply/polyP=> i; rewrite polE coef0; have [il|il] := ltnP i (size v).
  by rewrite phi_eq0 // h.
by rewrite nth_default.
Qed.
Lemma zmat_modE a b M : mx a b (zmat_mod lz M) = mx a b M.
Proof.
apply/matrixP=> i j; rewrite !mxE; have [il|il] := ltnP i (size M); last by rewrite !nth_default ?size_map ?nth_nil.
by rewrite (nth_map [::]) // zmod_nth.
Qed.
Lemma pol_zmod v : pol (zmod lz v) = pol v.
Proof. by apply/polyP=> i; rewrite !polE zmod_nth. Qed.
Lemma zmat0_modE a b M : zmat0_mod lz M -> mx a b M = 0.
Proof.
move/(all_nthP [::])=> h; apply/matrixP=> i j; rewrite !mxE; have [il|il] := ltnP i (size M); last first.
  by rewrite (@nth_default _ [::] M i il) nth_nil.
have /(all_nthP z0) h' := h _ il; have [jl|jl] := ltnP j (size (nth [::] M i)); last by rewrite nth_default.
by rewrite phi_eq0 // h'.
Qed.
End Modulus.

End Ring.

Lemma map_phi (R R' : comRingType) (f : {rmorphism R -> R'}) z : f (phi R z) = phi R' z.
Proof. exact: rmorph_int. Qed.
Lemma map_mx_mx (R R' : comRingType) (f : {rmorphism R -> R'}) a b M : map_mx f (mx R a b M) = mx R' a b M.
Proof. by apply/matrixP=> i j; rewrite !mxE; apply: map_phi. Qed.
Lemma map_pol (R R' : comRingType) (f : {rmorphism R -> R'}) v : map_poly f (pol R v) = pol R' v.
Proof. by apply/polyP=> i; rewrite coef_map !polE; apply: map_phi. Qed.
Lemma residue_modulus (l : modulus) lz : Z.to_nat lz = l :> nat -> (0 < lz)%coqZ -> phi [comRingType of 'Z_l] lz = 0.
Proof.
move=> lE l0; rewrite /phi -[lz]Z2Nat.id ?int_of_Z_nat; last exact: Z.lt_le_incl.
by rewrite lE -[X in X = _]/((l : nat)%:R) char_Zp ?modulus_gt1.
Qed.

(* Over a field that contains Q, an integer other than 0 is not 0. *)
Lemma phi_neq0 (K : fieldType) (h : {rmorphism rat -> K}) z : ~~ Z.eqb z 0 -> phi [comRingType of K] z != 0.
Proof.
move=> nz; rewrite -(@map_phi [comRingType of rat] _ h) fmorph_eq0 /phi intr_eq0.
by apply: contra nz => /eqP/int_of_Z_eq0 ->.
Qed.
Lemma same_up_to_scaleP (K : fieldType) (h : {rmorphism rat -> K}) p q : same_up_to_scale p q ->
  [/\ phi [comRingType of K] (last z0 p) != 0, phi [comRingType of K] (last z0 q) != 0 &
    phi _ (last z0 q) *: pol [comRingType of K] p = phi _ (last z0 p) *: pol [comRingType of K] q].
Proof.
case/and3P=> /(phi_neq0 h) p0 /(phi_neq0 h) q0 z; split=> //.
have := pol_zero0 [comRingType of K] z; rewrite !pol_axpy {2}/pol /= addr0 phiN polyCN mulNr addrC => /eqP.
by rewrite subr_eq0 !mul_polyC => /eqP ->.
Qed.

(* A list of integers stands for a monic polynomial, too: its coefficients over the last one. *)
Section Monic.
Variables (K : fieldType) (h : {rmorphism rat -> K}).
Notation phi := (phi [comRingType of K]).
Notation pol := (pol [comRingType of K]).
Definition up (p : zrow) : {poly K} := (phi (last z0 p))^-1 *: pol p.
Lemma upE p i : (up p)`_i = (phi (last z0 p))^-1 * phi (nth z0 p i).
Proof. by rewrite coefZ polE. Qed.
Variable p : zrow.
Hypothesis p0 : ~~ Z.eqb (last z0 p) 0.
Lemma up_monic : up p \is monic.
Proof. by rewrite monicE lead_coefZ lead_pol ?mulVf // (phi_neq0 h). Qed.
Lemma up_size : size (up p) = size p.
Proof. by rewrite size_scale ?invr_eq0 ?size_pol // (phi_neq0 h). Qed.
Lemma eqp_deriv_up : (up p)^`() %= pol (zderivative p).
Proof. by rewrite /up derivZ pol_derivative eqp_scale // invr_eq0 (phi_neq0 h). Qed.
Lemma up_eqp : up p %= pol p.
Proof. by rewrite /up eqp_scale // invr_eq0 (phi_neq0 h). Qed.
End Monic.
