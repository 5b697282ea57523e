(* Where the roots of the factors lie, checker/core/roots.py: stability by Routh's test, discs with one root each, and the
   interval for the rate.  These are about complex numbers: every closed field with a conjugation and a norm. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location mobius moved_roots root_discs rate_interval.
From mcexact Require Import multichannel.
From mcexact.kernel Require Import lists systems fixed_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* A list without zeros at its end. *)
Fixpoint ztrim (p : zrow) : zrow := if p is c :: p' then let q := ztrim p' in if nilp q && Z.eqb c 0 then [::] else c :: q else [::].
(* A polynomial over the greatest common divisor of its coefficients. *)
Definition zprimitive (p : zrow) : zrow :=
  let g := foldr Z.gcd z0 p in let q := [seq Z.div x g | x <- p] in
  if Z.ltb 0 g && zeq [seq (g * x)%coqZ | x <- q] p then q else p.
(* The next polynomial of Routh's test, times the last coefficient but one; n is the degree. *)
Definition zrouth_step (p : zrow) : zrow :=
  let: (n, a, b) := ((size p).-1, last z0 p, nth z0 p (size p).-2) in
  mkseq (fun i => if (0 < i)%N && ~~ odd (n - i) then (b * nth z0 p i - a * nth z0 p i.-1)%coqZ else (b * nth z0 p i)%coqZ) n.
Fixpoint zrouth (k : nat) (p : zrow) : bool :=
  if k is k'.+1 then (size p <= 1)%N || Z.ltb 0 (nth z0 p (size p).-2) && zrouth k' (zprimitive (zrouth_step p)) else true.
(* The last coefficient made positive. *)
Definition zpositive (p : zrow) : zrow := if Z.ltb (last z0 p) 0 then [seq Z.opp x | x <- p] else p.
Definition zhurwitz (p : zrow) : bool := zrouth (size p) (zpositive p).
(* sum p_k (1 + x)^k (1 - x)^(d - k), and p(-1) *)
Definition zmoebius_step (c : Z) (q : zrow * zrow) : zrow * zrow :=
  (zaxpy 1 (zpmul [:: 1%coqZ; 1%coqZ] q.1) (zaxpy c q.2 [::]), zpmul [:: 1%coqZ; (-1)%coqZ] q.2).
Definition zmoebius (p : zrow) : zrow := (foldr zmoebius_step ([::], [:: 1%coqZ]) p).1.
Definition zat_minus_one (p : zrow) : Z := foldr (fun c v => (c - v)%coqZ) z0 p.
Definition zschur (p : zrow) : bool := ~~ Z.eqb (zat_minus_one p) 0 && zhurwitz (ztrim (zmoebius p)).
(* Discs around (re + i im) / w of radius rad / w. *)
Record zdisc := ZDisc { d_re : Z; d_im : Z; d_rad : Z }.
(* w^d p(c) for c = (x + iy) / w *)
Definition zgauss_step (x y w c : Z) (a : (Z * Z) * Z) : (Z * Z) * Z :=
  let: ((u, v), t) := a in ((x * u - y * v + c * t, x * v + y * u)%coqZ, (t * w)%coqZ).
Definition zgauss (x y w : Z) (p : zrow) : Z * Z :=
  (foldr (zgauss_step x y w) ((z0, z0), 1%coqZ) p).1.
Definition znorm (a : Z * Z) : Z := (a.1 * a.1 + a.2 * a.2)%coqZ.
Definition check_disc (w : Z) (p : zrow) (c : zdisc) : bool :=
  let d := Z.of_nat (size p).-1 in
  [&& Z.leb 0 (d_rad c) &
      Z.leb (d * d * znorm (zgauss (d_re c) (d_im c) w p)) (d_rad c * d_rad c * znorm (zgauss (d_re c) (d_im c) w (zderivative p)))].
Definition apart (c c' : zdisc) : bool :=
  Z.ltb ((d_rad c + d_rad c') * (d_rad c + d_rad c')) (znorm ((d_re c - d_re c')%coqZ, (d_im c - d_im c')%coqZ)).
Fixpoint all_apart (cs : seq zdisc) : bool := if cs is c :: cs' then all (apart c) cs' && all_apart cs' else true.
Definition check_discs (w : Z) (p : zrow) (cs : seq zdisc) : bool :=
  [&& Z.ltb 0 w, (1 < size p)%N, ~~ Z.eqb (last z0 p) 0, size cs == (size p).-1, all (check_disc w p) cs & all_apart cs].

Local Arguments zaxpy : simpl never.
Local Arguments zpmul : simpl never.

Section Complex.
Variable C : numClosedFieldType.
Notation phi := (phi [comRingType of C]).
Notation pol := (pol [comRingType of C]).
Let h : {rmorphism rat -> C} := [rmorphism of ratr].

Lemma phi_real z : phi z \is Num.real. Proof. exact: realz. Qed.
Lemma int_of_Z_pos z : (0 < int_of_Z z) = Z.ltb 0 z.
Proof. by case: z => //= p; have := Pos2Nat.is_pos p; case: (Pos.to_nat p) => // /ssrnat.ltP. Qed.
Lemma phi_gt0 z : (0 < phi z) = Z.ltb 0 z.
Proof. by rewrite /phi ltr0z int_of_Z_pos. Qed.
Lemma phi_le a b : (phi a <= phi b) = Z.leb a b.
Proof.
rewrite real_leNgt ?phi_real // -subr_gt0 -phiN -phiD phi_gt0 Z.leb_antisym; congr (~~ _).
apply/idP/idP => /Z.ltb_lt lt; apply/Z.ltb_lt; [exact/Z.lt_0_sub | exact/Z.lt_0_sub].
Qed.
Lemma phi_lt a b : (phi a < phi b) = Z.ltb a b.
Proof. by rewrite real_ltNge ?phi_real // phi_le Z.ltb_antisym. Qed.
Lemma phi_eq0 z : (phi z == 0) = Z.eqb z 0.
Proof.
apply/idP/idP => [|/Z.eqb_eq -> //]; apply: contraTT => nz; exact: (phi_neq0 h nz).
Qed.
Lemma pol_real p : real_poly (pol p).
Proof. by apply/polyOverP => i; rewrite polE phi_real. Qed.

Lemma ztrimE p : pol (ztrim p) = pol p.
Proof.
elim: p => [//|c p IH]; rewrite [ztrim _]/=; case: ifP => [/andP[/nilP e /Z.eqb_eq ->]|_]; last by rewrite !pol_cons IH.
by rewrite pol_cons -IH e [phi 0%coqZ]phi0 polyC0 addr0 /lists.pol /= mul0r.
Qed.
Lemma ztrim_last p : nilp (ztrim p) || ~~ Z.eqb (last z0 (ztrim p)) 0.
Proof.
elim: p => [|c p IH] //=; case: ifP => //=; case: (ztrim p) IH => [|c' q] //= _; by [move=> ->|].
Qed.
Lemma zprimitiveE p : exists2 k : C, 0 < k & pol (zprimitive p) = k *: pol p.
Proof.
rewrite /zprimitive; set g := foldr _ _ _; case: ifP => [/andP[g0 /zeqP e]|_]; last by exists 1; rewrite ?ltr01 ?scale1r.
have gp : 0 < phi g by rewrite phi_gt0.
exists (phi g)^-1; first by rewrite invr_gt0.
apply: (scalerI (lt0r_neq0 gp)); rewrite scalerA divff ?lt0r_neq0 // scale1r -[in RHS]e.
apply/polyP=> i; rewrite coefZ !polE; set q := map _ p.
have n0 s : (size s <= i)%N -> phi (nth z0 s i) = 0 by move=> le; rewrite nth_default.
have [iq|iq] := ltnP i (size q); last by rewrite !n0 ?size_map ?mulr0 // -(size_map (Z.div^~ g)).
by rewrite [in RHS](nth_map z0) // phiM.
Qed.
Lemma zprimitive_size p : size (zprimitive p) = size p.
Proof. by rewrite /zprimitive; case: ifP; rewrite ?size_map. Qed.

Lemma hurwitzZ (k : C) q : k != 0 -> hurwitz (k *: q) <-> hurwitz q.
Proof. by move=> k0; split=> hq z; have := hq z; rewrite rootZ. Qed.

Lemma zrouth_stepE p n : size p = n.+2 -> phi (nth z0 p n) != 0 -> phi (last z0 p) != 0 ->
  pol (zrouth_step p) = phi (nth z0 p n) *: routh_step (pol p).
Proof.
move=> sp b0 a0; have sP : size (pol p) = n.+2 by rewrite size_pol.
rewrite /zrouth_step /routh_step sp sP /=; apply/polyP=> i; rewrite polE coefZ coef_poly.
case: ltnP => [ni|ni]; last by rewrite nth_default ?size_mkseq // phi0 mulr0.
rewrite nth_mkseq // !polE; have eL : nth z0 p n.+1 = last z0 p by rewrite -nth_last sp.
rewrite eL; case: ifP => _; last by rewrite phiM.
by rewrite -[(_ - _)%coqZ]/(_ + - _)%coqZ phiD phiN !phiM mulrBr mulrA [phi (nth z0 p n) * (_ / _)]mulrCA divff // mulr1.
Qed.

Lemma zrouthP k p : (size p <= k)%N -> (0 < size p)%N -> 0 < phi (last z0 p) -> hurwitz (pol p) <-> zrouth k p.
Proof.
elim: k p => [|k IH] p sk s0 a0; first by move: (leq_trans s0 sk).
have an : phi (last z0 p) != 0 by rewrite gt_eqF.
have sP : size (pol p) = size p by rewrite size_pol.
have P0 : pol p != 0 by rewrite -size_poly_gt0 sP.
rewrite /=; case: leqP => [s1|s1] /=; first by split=> // _; apply: no_root_const; rewrite ?sP.
have [n sn] : exists n, size p = n.+2 by case: (size p) s1 => [|[|n]] // _; exists n.
have lp : 0 < lead_coef (pol p) by rewrite lead_pol.
have sPn : size (pol p) = n.+2 by rewrite sP.
rewrite (routh (pol_real p) sPn lp) polE sn /= phi_gt0.
case b0 : (Z.ltb _ _); last by split=> [[]|].
have bp : 0 < phi (nth z0 p n) by rewrite phi_gt0.
have bn : phi (nth z0 p n) != 0 by rewrite gt_eqF.
have eS := zrouth_stepE sn bn an; have [c c0 eP] := zprimitiveE (zrouth_step p).
have sS : size (zrouth_step p) = n.+1 by rewrite size_mkseq sn.
have lS : last z0 (zrouth_step p) = (nth z0 p n * nth z0 p n)%coqZ.
  by rewrite -nth_last sS /= /zrouth_step sn nth_mkseq // subSnn /= andbF.
have key : 0 < phi (last z0 (zprimitive (zrouth_step p))).
  rewrite -nth_last zprimitive_size sS /= -polE eP coefZ polE -[n in nth _ _ n]/(n.+1.-1) -sS nth_last lS phiM.
  by rewrite !mulr_gt0.
rewrite -(IH _ _ _ key) ?zprimitive_size ?sS //; last by move: sk; rewrite sn.
rewrite eP eS scalerA hurwitzZ ?mulf_neq0 ?gt_eqF //; by split=> [[]|].
Qed.

Lemma zhurwitzP p : ~~ Z.eqb (last z0 p) 0 -> (0 < size p)%N -> hurwitz (pol p) <-> zhurwitz p.
Proof.
move=> l0 s0; have ln : phi (last z0 p) != 0 by rewrite phi_eq0.
rewrite /zhurwitz /zpositive; case: ifP => neg.
  have e : pol [seq Z.opp x | x <- p] = -1 *: pol p.
    apply/polyP=> i; rewrite coefZ !polE; have [ip|ip] := ltnP i (size p); last by rewrite !nth_default ?size_map // phi0 mulr0.
    by rewrite (nth_map z0) // phiN mulN1r.
  rewrite -zrouthP ?size_map //; first by rewrite e hurwitzZ // oppr_eq0 oner_eq0.
  have -> : last z0 [seq Z.opp x | x <- p] = Z.opp (last z0 p) by case: (p) s0 => //= x q _; rewrite last_map.
  by rewrite phiN oppr_gt0 -phi0 phi_lt.
apply: zrouthP => //; rewrite lt_neqAle eq_sym ln /= -phi0 phi_le Z.leb_antisym neg //.
Qed.

Lemma pol_size1 c : pol [:: c] = (phi c)%:P. Proof. by rewrite pol_cons /lists.pol /= mul0r add0r. Qed.
Lemma pol_nil : pol [::] = 0. Proof. by []. Qed.
Lemma zmoebius_foldr s : let q := foldr zmoebius_step ([::], [:: 1%coqZ]) s in
  let r := foldr (fun c q => ((1 + 'X) * q.1 + c *: q.2, (1 - 'X) * q.2)) (0, 1) [seq phi x | x <- s] : {poly C} * {poly C} in
  pol q.1 = r.1 /\ pol q.2 = r.2.
Proof.
elim: s => [|c s] /=; first by rewrite pol_nil pol_one.
move: (foldr zmoebius_step _ s) (foldr _ _ [seq phi x | x <- s]) => [a b] [A B] /= [IH1 IH2]; split.
  rewrite pol_axpy pol_mul pol_axpy IH2 IH1 pol_nil addr0 phi1 mul1r !pol_cons pol_nil mul0r add0r phi1 mul1r mul_polyC polyC1; congr (_ * _ + _).
  by rewrite addrC.
by rewrite pol_mul IH2 !pol_cons pol_nil mul0r add0r phi1 phiN1 polyCN polyC1 mulN1r addrC.
Qed.
Lemma zmoebiusE p : phi (last z0 p) != 0 -> pol (zmoebius p) = transformed (pol p).
Proof.
move=> l0; rewrite /transformed -moebiusE /moebius.
have -> : polyseq (pol p) = [seq phi x | x <- p].
  case: p l0 => [|x p] /= l0; first by rewrite pol_nil polyseq0.
  by rewrite /lists.pol (PolyK (c := 0)) //= last_map.
by have [-> _] := zmoebius_foldr p.
Qed.
Lemma zat_minus_oneE p : phi (zat_minus_one p) = (pol p).[-1].
Proof.
elim: p => [|c p IH]; first by rewrite pol_nil horner0.
rewrite [zat_minus_one _]/= pol_cons hornerD hornerMX hornerC -IH mulrN1 addrC -[(_ - _)%coqZ]/(_ + - _)%coqZ phiD phiN //.
Qed.
Lemma zschurP p : ~~ Z.eqb (last z0 p) 0 -> (0 < size p)%N -> schur (pol p) <-> zschur p.
Proof.
move=> l0 s0; have ln : phi (last z0 p) != 0 by rewrite phi_eq0.
have P0 : pol p != 0 by rewrite -size_poly_gt0 size_pol.
rewrite (schur_mobius P0) -zat_minus_oneE phi_eq0 /zschur -zmoebiusE // -ztrimE.
case: (Z.eqb _ _) => //=; first by split=> [[]|].
have T0 : transformed (pol p) != 0.
  by apply: contraNneq (transformed_at_1 P0) => ->; rewrite horner0.
have := ztrim_last (zmoebius p); case nl : (nilp _) => /= lt.
  by move: T0; rewrite -zmoebiusE // -ztrimE (nilP nl) /lists.pol /= eqxx.
rewrite -zhurwitzP //; last by rewrite lt0n -/(nilp _) nl.
by split=> [[]|].
Qed.

Lemma complex_mul (u v x y : C) : (u + 'i * v) * (x + 'i * y) = x * u - y * v + 'i * (x * v + y * u).
Proof.
rewrite mulrDl !mulrDr ['i * v * ('i * y)]mulrACA -expr2 sqrCi mulN1r (mulrC u x) (mulrC v y) [u * ('i * y)]mulrCA (mulrC u y).
by rewrite -['i * v * x]mulrA (mulrC v x) ['i * (x * v) - _]addrC addrACA ['i * (y * u) + _]addrC.
Qed.

Section Discs.
Variable w : Z.
Hypothesis w0 : Z.ltb 0 w.
Let wp : 0 < phi w. Proof. by rewrite phi_gt0. Qed.
Let wn : phi w != 0. Proof. by rewrite gt_eqF. Qed.
Definition center (c : zdisc) : C := (phi (d_re c) + 'i * phi (d_im c)) / phi w.
Definition radius (c : zdisc) : C := phi (d_rad c) / phi w.
Definition complex (a : Z * Z) : C := phi a.1 + 'i * phi a.2.
Lemma complex_norm a : `|complex a| ^+ 2 = phi (znorm a).
Proof. by rewrite normC2_rect ?phi_real // /znorm phiD !phiM !expr2. Qed.
Lemma zgaussE c p : complex (zgauss (d_re c) (d_im c) w p) * phi w = phi w ^+ size p * (pol p).[center c].
Proof.
rewrite /zgauss; set st := zgauss_step _ _ _.
suff [-> _] : complex (foldr st (z0, z0, 1%coqZ) p).1 * phi w = phi w ^+ size p * (pol p).[center c] /\
  phi (foldr st (z0, z0, 1%coqZ) p).2 = phi w ^+ size p by [].
elim: p => [|a p]; first by rewrite pol_nil horner0 mulr0 /complex /= !phi0 mulr0 addr0 mul0r phi1 expr0.
rewrite [foldr _ _ (_ :: _)]/=; case: (foldr st _ p) => [[u v] t]; rewrite [fst _]/= [snd _]/= => -[IH1 IH2].
rewrite /st /zgauss_step [fst _]/= [snd _]/= [size _]/=; split; last by rewrite phiM IH2 exprSr.
rewrite pol_cons hornerD hornerMX hornerC exprS -mulrA mulrDr [phi w ^+ _ * (_ * _)]mulrA -IH1 -IH2.
have -> : complex (u, v) * phi w * center c = complex (u, v) * complex (d_re c, d_im c).
  by rewrite /center -/(complex (d_re c, d_im c)) -mulrA [phi w * _]mulrC divfK.
rewrite /complex /= complex_mul -[(_ - _)%coqZ]/(_ + - _)%coqZ !(phiD, phiN, phiM) [RHS]mulrC; congr (_ * _).
by rewrite [RHS]addrAC [phi t * _]mulrC.
Qed.
Lemma zgauss_norm c p : (0 < size p)%N ->
  phi (znorm (zgauss (d_re c) (d_im c) w p)) = (phi w ^+ (size p).-1) ^+ 2 * `|(pol p).[center c]| ^+ 2.
Proof.
move=> s0; rewrite -complex_norm -exprMn; congr (_ ^+ 2).
have -> : complex (zgauss (d_re c) (d_im c) w p) = phi w ^+ (size p).-1 * (pol p).[center c].
  by apply: (mulIf wn); rewrite zgaussE mulrAC -exprSr prednK.
by rewrite normrM ger0_norm // exprn_ge0 // ltW.
Qed.
Lemma size_zderivative p : size (zderivative p) = (size p).-1.
Proof. by rewrite /zderivative -size_behead; elim: (behead p) 1%coqZ => //= c q IH k; rewrite IH. Qed.
Lemma check_discP p c d : size p = d.+2 -> check_disc w p c -> 0 <= radius c /\
  (d.+1)%:R ^+ 2 * `|(pol p).[center c]| ^+ 2 <= radius c ^+ 2 * `|(pol p)^`().[center c]| ^+ 2.
Proof.
move=> sp /andP[r0]; rewrite -phi_le !phiM !zgauss_norm ?size_zderivative ?sp // pol_derivative [d.+2.-1]/= [d.+1.-1]/= => le.
have dE : phi (Z.of_nat d.+1) = (d.+1)%:R by rewrite /phi int_of_Z_nat.
split; first by rewrite /radius divr_ge0 ?(ltW wp) // -(phi0 [comRingType of C]) phi_le.
have W0 : 0 < (phi w ^+ d.+1) ^+ 2 by rewrite !exprn_gt0.
rewrite -(ler_pmul2l W0); set Y := `|(pol p)^`().[_]| ^+ 2 in le *.
have -> : (phi w ^+ d.+1) ^+ 2 * (radius c ^+ 2 * Y) = phi (d_rad c) ^+ 2 * ((phi w ^+ d) ^+ 2 * Y).
  have e1 : phi w ^+ d.+1 * (phi (d_rad c) / phi w) = phi (d_rad c) * phi w ^+ d by rewrite exprS mulrAC [phi w * _]mulrC divfK.
  rewrite /radius [LHS]mulrA -[_ ^+ 2 * _ ^+ 2]exprMn e1 exprMn -mulrA //.
by rewrite [X in X <= _]mulrCA -dE [phi (Z.of_nat _) ^+ 2]expr2 [phi (d_rad c) ^+ 2]expr2.
Qed.
Lemma apartP c c' : 0 <= radius c -> 0 <= radius c' -> apart c c' -> radius c + radius c' < `|center c - center c'|.
Proof.
move=> r0 r0' ap; rewrite -(@ltr_pexpn2r _ 2) ?nnegrE ?addr_ge0 // /radius -mulrDl expr_div_n.
have -> : center c - center c' = complex (d_re c - d_re c', d_im c - d_im c')%coqZ / phi w.
  rewrite /center /complex /= -!/(Z.add _ (Z.opp _)) !phiD !phiN -mulrBl; congr (_ / _).
  by rewrite mulrBr opprD addrACA.
rewrite normrM normfV (ger0_norm (ltW wp)) expr_div_n ltr_pmul2r ?invr_gt0 ?exprn_gt0 // complex_norm.
by rewrite -phiD expr2 -phiM phi_lt.
Qed.

(* Every root is in a disc, and every disc holds exactly one. *)
Definition discs_hold (p : zrow) (cs : seq zdisc) : Prop :=
  (forall x, root (pol p) x -> exists2 c, List.In c cs & `|center c - x| <= radius c) /\
  (forall c, List.In c cs -> exists x, [/\ root (pol p) x, `|center c - x| <= radius c &
    forall y, root (pol p) y -> `|center c - y| <= radius c -> y = x]).
Lemma In_nth (T : Type) (x0 : T) s i : (i < size s)%N -> List.In (nth x0 s i) s.
Proof. by elim: s i => [|x s IH] [|i] //= lt; [left | right; apply: IH]. Qed.
Lemma nth_In (T : Type) (x0 : T) s x : List.In x s -> exists2 i, (i < size s)%N & x = nth x0 s i.
Proof. by elim: s => //= y s IH [->|/IH[i lt ->]]; [exists 0%N | exists i.+1]. Qed.
Let no_disc := ZDisc z0 z0 z0.
Lemma all_apartP cs i j : all_apart cs -> (i < j)%N -> (j < size cs)%N -> apart (nth no_disc cs i) (nth no_disc cs j).
Proof.
elim: cs i j => [|c cs IH] [|i] [|j] //= /andP[/(all_nthP no_disc) ac rest] ij js; first exact: ac.
exact: IH.
Qed.
Theorem check_discs_sound p cs : check_discs w p cs -> discs_hold p cs.
Proof.
case/and5P=> _ s1 l0 /eqP sc /andP[/(all_nthP no_disc) each ap].
have [d sp] : exists d, size p = d.+2 by case: (size p) s1 => [|[|d]] // _; exists d.
rewrite sp /= in sc; have sP : size (pol p) = d.+2 by rewrite size_pol // phi_eq0.
pose c (i : 'I_d.+1) := nth no_disc cs i; have one (i : 'I_d.+1) := check_discP sp (each i (leq_trans (ltn_ord i) (eq_leq (esym sc)))).
have far i j : i != j -> radius (c i) + radius (c j) < `|center (c i) - center (c j)|.
  have [ri _] := one i; have [rj _] := one j.
  rewrite neq_ltn => /orP[] lt; last rewrite addrC distrC.
    by apply: apartP => //; apply: all_apartP; rewrite ?sc ?ltn_ord.
  by apply: apartP => //; apply: all_apartP; rewrite ?sc ?ltn_ord.
have [z [zi roots inz]] := root_discs sP (fun i => (one i).1) (fun i => (one i).2) far.
split=> [x /roots[i ->]|c' /(nth_In no_disc)[i ic ->]].
  exists (c i); first by apply: In_nth; rewrite sc.
  by apply/(inz i); [apply/roots; exists i|].
rewrite sc in ic; pose i' := Ordinal ic; exists (z i'); have rz : root (pol p) (z i') by apply/roots; exists i'.
by split=> // [|y ry]; [apply/(inz i') | move/(inz i' y ry)].
Qed.

(* The interval for the rate, of all discs together; low and high over w. *)
Definition check_rate (continuous : bool) (cs : seq zdisc) (low high : Z) : bool :=
  if continuous then
    all (fun c => Z.leb low (- (d_re c + d_rad c))) cs && has (fun c => Z.leb (- (d_re c - d_rad c)) high) cs
  else
    has (fun c => Z.leb low (- d_rad c) || Z.leb ((low + d_rad c) * (low + d_rad c)) (znorm (d_re c, d_im c))) cs &&
    all (fun c => Z.leb (d_rad c) high && Z.leb (znorm (d_re c, d_im c)) ((high - d_rad c) * (high - d_rad c))) cs.
Definition rate_holds (continuous : bool) (spectrum : C -> Prop) (low high : Z) : Prop :=
  if continuous then
    (forall x, spectrum x -> phi low / phi w <= - 'Re x) /\ (exists2 x, spectrum x & - 'Re x <= phi high / phi w)
  else
    (exists2 x, spectrum x & phi low / phi w <= `|x|) /\ (forall x, spectrum x -> `|x| <= phi high / phi w).
Lemma Re_center c : 'Re (center c) = phi (d_re c) / phi w.
Proof.
rewrite /center mulrDl -mulrA; have rr : phi (d_re c) / phi w \is Num.real by rewrite rpred_div ?phi_real.
have ri : phi (d_im c) / phi w \is Num.real by rewrite rpred_div ?phi_real.
exact: Re_rect.
Qed.
Lemma over_le a b : (phi a / phi w <= phi b / phi w) = Z.leb a b.
Proof. by rewrite ler_pmul2r ?invr_gt0 // phi_le. Qed.
Lemma center_norm c : `|center c| ^+ 2 = phi (znorm (d_re c, d_im c)) / phi w ^+ 2.
Proof. by rewrite /center -/(complex (d_re c, d_im c)) normrM normfV (ger0_norm (ltW wp)) expr_div_n complex_norm. Qed.
Lemma all_In (T : Type) (a : pred T) s x : all a s -> List.In x s -> a x.
Proof. by elim: s => //= y s IH /andP[ay /IH al] [<-|/al]. Qed.
Lemma has_In (T : Type) (a : pred T) s : has a s -> exists2 x, List.In x s & a x.
Proof. by elim: s => //= y s IH /orP[ay|/IH[x xs ax]]; [exists y; [left|] | exists x; [right|]]. Qed.
Theorem check_rate_sound continuous cs low high (spectrum : C -> Prop) :
  (forall x, spectrum x -> exists2 c, List.In c cs & `|center c - x| <= radius c) ->
  (forall c, List.In c cs -> exists2 x, spectrum x & `|center c - x| <= radius c) ->
  check_rate continuous cs low high -> rate_holds continuous spectrum low high.
Proof.
move=> near far; rewrite /check_rate /rate_holds.
have bounds c x : `|center c - x| <= radius c -> - (phi (d_re c) / phi w + radius c) <= - 'Re x <= - (phi (d_re c) / phi w - radius c).
  move=> dc; have := @real_part_in_disc C unit_finType (fun=> center c) (fun=> radius c) (fun=> x) (fun=> dc) tt.
  by rewrite Re_center => /andP[lo hi]; rewrite !ler_opp2 hi lo.
case: continuous => /andP[].
  move=> al /has_In[c cin hi]; split=> [x /near[c' cin' dc]|].
    have /andP[le _] := bounds _ _ dc; apply: le_trans le; have := all_In al cin' => /=.
    by rewrite -over_le phiN phiD mulNr mulrDl.
  have [x sx dc] := far c cin; exists x => //; have /andP[_ le] := bounds _ _ dc; apply: le_trans le _.
  move: hi; rewrite -over_le phiN -[(_ - _)%coqZ]/(_ + - _)%coqZ phiD phiN mulNr mulrBl //.
have rlow : phi low / phi w \is Num.real by rewrite rpred_div ?phi_real.
move=> /has_In[c cin lo] al; split.
  have [x sx dc] := far c cin.
  have := @rate_interval_discrete C unit_finType (fun=> center c) (fun=> radius c) (fun=> x) (fun y => y = x) (fun=> dc)
    (fun y => conj (fun e => ex_intro _ tt e) (fun e : exists i : unit, y = x => let: ex_intro _ e := e in e)) (phi low / phi w) (radius c + `|center c|) rlow.
  case=> [||[y -> le] _]; last by exists x.
    exists tt; case/orP: lo => [lo|lo]; [left|right].
      by rewrite /radius -mulNr -phiN over_le.
    rewrite /radius -mulrDl expr_div_n center_norm ler_pmul2r ?invr_gt0 ?exprn_gt0 // -phiD expr2 -phiM phi_le //.
  by move=> _; rewrite addrC addrK lexx ler_addr normr_ge0.
move=> x /near[c' cin' dc]; have /andP[h1 h2] := all_In al cin'.
have := @rate_interval_discrete C unit_finType (fun=> center c') (fun=> radius c') (fun=> x) (fun y => y = x) (fun=> dc)
  (fun y => conj (fun e => ex_intro _ tt e) (fun e : exists i : unit, y = x => let: ex_intro _ e := e in e)) (- radius c') (phi high / phi w).
case=> [|||_ le]; last exact: le.
- by rewrite rpredN rpred_div ?phi_real.
- by exists tt; left.
move=> _; split; first by rewrite over_le.
rewrite center_norm /radius -mulrBl expr_div_n ler_pmul2r ?invr_gt0 ?exprn_gt0 // -phiN -phiD expr2 -phiM phi_le //.
Qed.
End Discs.

(* What a claim of the kind `fixed_spectrum` says of the complex plane: a flag and discs for each factor, whether all
   fixed modes lie in the region of stability, and the rate if there is one.  All discs and the rate are over g_w. *)
Definition inside (continuous : bool) (z : C) : bool := if continuous then 'Re z < 0 else `|z| < 1.
End Complex.

Record zregions := ZRegions { g_w : Z; g_continuous : bool; g_stable : seq bool; g_discs : seq (seq zdisc); g_stabilizable : bool;
  g_rate : option (Z * Z) }.
Definition zstable (continuous : bool) (p : zrow) : bool := if continuous then zhurwitz p else zschur p.
Fixpoint check_each (g : zregions) (fs : seq zfactor) (flags : seq bool) (discs : seq (seq zdisc)) : bool :=
  match fs, flags, discs with
  | [::], [::], [::] => true
  | f :: fs', flag :: flags', cs :: discs' =>
    [&& flag == zstable (g_continuous g) (f_p f), check_discs (g_w g) (f_p f) cs & check_each g fs' flags' discs']
  | _, _, _ => false end.
Definition check_regions (c : zclaim) (g : zregions) : bool :=
  [&& Z.ltb 0 (g_w g), check_each g (c_factors c) (g_stable g) (g_discs g), same_up_to_scale (c_poly c) (zproduct (c_factors c)),
      g_stabilizable g == all id (g_stable g) &
      match g_rate g with
      | None => nilp (c_factors c)
      | Some (low, high) => check_rate (g_continuous g) (flatten (g_discs g)) low high end].

Lemma In_cat (T : Type) (a b : seq T) x : List.In x (a ++ b) <-> List.In x a \/ List.In x b.
Proof. by elim: a => [|y a IH] /=; [split=> [bx|[]//]; right | rewrite IH; split=> [[]|[[]|]]; tauto]. Qed.

Section Regions.
Variables (C : numClosedFieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel C n p q).
Let h : {rmorphism rat -> C} := [rmorphism of ratr].
Fixpoint each_holds (g : zregions) (fs : seq zfactor) (flags : seq bool) (discs : seq (seq zdisc)) : Prop :=
  match fs, flags, discs with
  | f :: fs', flag :: flags', cs :: discs' =>
    [/\ flag <-> (forall z, root (up C (f_p f)) z -> inside (g_continuous g) z), discs_hold C (g_w g) (f_p f) cs & each_holds g fs' flags' discs']
  | _, _, _ => True end.
Definition regions_hold (c : zclaim) (g : zregions) : Prop :=
  [/\ each_holds g (c_factors c) (g_stable g) (g_discs g),
      g_stabilizable g <-> (forall z, fixed S z -> inside (g_continuous g) z) &
      if g_rate g is Some (low, high) then rate_holds (g_w g) (g_continuous g) (fun z => fixed S z) low high
      else forall z, ~ fixed S z].

Lemma up_root f z : ~~ Z.eqb (last z0 f) 0 -> root (up C f) z = root (pol [comRingType of C] f) z.
Proof. by move=> l0; rewrite (eqp_root (up_eqp h l0)). Qed.
Lemma zstableP g f : ~~ Z.eqb (last z0 f) 0 -> (0 < size f)%N -> zstable (g_continuous g) f <->
  (forall z : C, root (up C f) z -> inside (g_continuous g) z).
Proof.
move=> l0 s0; rewrite /zstable /inside; case: (g_continuous g).
  by rewrite -(zhurwitzP C l0 s0); split=> hz z rz; apply: hz; rewrite ?(up_root _ l0) // -(up_root _ l0).
by rewrite -(zschurP C l0 s0); split=> hz z rz; apply: hz; rewrite ?(up_root _ l0) // -(up_root _ l0).
Qed.
Definition some_root fs (z : C) : Prop := exists2 f, List.In f fs & root (pol [comRingType of C] (f_p f)) z.
Lemma zproduct_root fs z : root (pol [comRingType of C] (zproduct fs)) z <-> some_root fs z.
Proof.
elim: fs => [|f fs IH]; first by rewrite /zproduct /= pol_one (negPf (root1 _)); split=> // -[].
rewrite [zproduct _]/= pol_mul rootM; split=> [/orP[rf|/IH[g gin rg]]|[g [<-|gin] rg]].
- by exists f; [left|].
- by exists g; [right|].
- by rewrite rg.
by apply/orP; right; apply/IH; exists g.
Qed.
Lemma check_each_sound g fs flags discs : Z.ltb 0 (g_w g) -> check_each g fs flags discs ->
  [/\ each_holds g fs flags discs, all id flags <-> (forall z, some_root fs z -> inside (g_continuous g) z),
    forall z, some_root fs z -> exists2 c, List.In c (flatten discs) & `|center C (g_w g) c - z| <= radius C (g_w g) c &
    forall c, List.In c (flatten discs) -> exists2 z, some_root fs z & `|center C (g_w g) c - z| <= radius C (g_w g) c].
Proof.
move=> w0; elim: fs flags discs => [|f fs IH] [|flag flags] [|cs discs] //=; first by move=> _; split=> //; [split=> // _ z []|move=> z []].
case/and3P=> /eqP -> ok /IH[h1 h2 h3 h4]; have /and5P[_ s1 l0 _ _] := ok.
have dh := check_discs_sound C w0 ok; have st := zstableP g l0 (ltnW s1).
split=> //.
- split=> [/andP[/st a1 /h2 a2] z [f' [<-|fin] rz]|al]; [by apply: a1; rewrite up_root| by apply: a2; exists f'|].
  apply/andP; split; first by apply/st => z; rewrite up_root // => rz; apply: al; exists f; [left|].
  by apply/h2 => z [f' fin rz]; apply: al; exists f'; [right|].
- move=> z [f' [<-|fin] rz].
    by have [c cin dc] := dh.1 z rz; exists c => //; apply/In_cat; left.
  by have [|c cin dc] := h3 z; [exists f' | exists c => //; apply/In_cat; right].
move=> c /In_cat[cin|cin].
  by have [z [rz dc _]] := dh.2 c cin; exists z => //; exists f; [left|].
by have [z [f' fin rz] dc] := h4 c cin; exists z => //; exists f'; [right|].
Qed.
Theorem check_regions_sound c g : claim_holds S c -> check_regions c g -> regions_hold c g.
Proof.
case=> fx _ /and5P[w0 /(check_each_sound w0)[h1 h2 h3 h4] same /eqP es rate].
have fixedE z : fixed S z <-> some_root (c_factors c) z.
  have [f0 g0 e] := same_up_to_scaleP h same; rewrite fx -zproduct_root.
  have -> : root (up C (c_poly c)) z = root (pol [comRingType of C] (zproduct (c_factors c))) z; last by [].
  apply: eqp_root; apply: eqp_trans (_ : pol _ (c_poly c) %= _); first by rewrite /up eqp_scale // invr_eq0.
  by apply/eqpP; exists (phi _ (last z0 (zproduct (c_factors c))), phi _ (last z0 (c_poly c))) => //=; rewrite g0 f0.
split=> //; first by rewrite es h2; split=> al z /fixedE; apply: al.
case: (g_rate g) rate => [[low high] ok|/nilP e z /fixedE]; last by rewrite e => -[].
apply: (check_rate_sound w0 _ _ ok) => [z /fixedE|d /h4[z /fixedE fz dz]]; [exact: h3 | by exists z].
Qed.
End Regions.
