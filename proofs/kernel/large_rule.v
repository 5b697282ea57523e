(* Rule about one closed loop modulo a large l, checker/core/evidence.py, TwoPolynomials.require_bounded: all fixed modes are
   roots of some factors, without a polynomial over Q.

   Modulo l, det(xI - A_F) is the product of the p^e times psi, and psi is coprime to det(xI - A).  Each p^d divides
   det(xI - A_F) for all F.  Let h be the product of the p^(e - d), of degree k.  D A and the D^(k - i) h_i are integers,
   and with r^8 at least the largest sum of a row, or of a column, of |(D A)^8| the sum of the |D^(k - i) h_i| r^i is below
   l (large_modulus.v). *)
From Coq Require Import ZArith Lia.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence large_modulus.
From mcexact.kernel Require Import lists systems residues packed hessenberg_rule coprime_rule spectrum_rule loop_rule fixed_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* N N over the integers, from its residues modulo a number that is more than twice as large as all its entries. *)
Definition zlarger (x : Z) (acc : Z) : Z := if Z.leb acc (Z.abs x) then Z.abs x else acc.
Definition zmost (M : zmat) : Z := foldr (fun r acc => foldr zlarger acc r) z0 M.
Definition zlift (l x : Z) : Z := if Z.leb (2 * x) l then x else (x - l)%coqZ.
Definition zsquare (N : zmat) : zmat :=
  let b := zmost N in
  let l := (2 * (Z.of_nat (size N) * (b * b)) + 2)%coqZ in
  [seq [seq zlift l x | x <- r] | r <- zmm_mod l N N].

(* The sums of all rows, or of all columns, of the absolute values are at most b. *)
Definition zcolumn_sums (M : zmat) : zrow := foldr (fun r acc => zaxpy 1 [seq Z.abs x | x <- r] acc) [::] M.
Definition sums_at_most (M : zmat) (b : Z) : bool :=
  all (fun r => Z.leb (zabs_sum r) b) M || all (fun x => Z.leb x b) (zcolumn_sums M).
Definition zeighth (r : Z) : Z := let s := (r * r)%coqZ in let t := (s * s)%coqZ in (t * t)%coqZ.
(* The sum of the |c_i| r^i *)
Definition zvalue (r : Z) (v : zrow) : Z := foldr (fun c acc => Z.abs c + r * acc)%coqZ z0 v.
(* From the last coefficient on: those of v times lead are those of f times 1, D, D^2, ... *)
Fixpoint zscaled_by (D lead power : Z) (f v : zrow) : bool :=
  match f, v with
  | x :: f', y :: v' => Z.eqb (y * lead) (power * x) && zscaled_by D lead (power * D) f' v'
  | [::], [::] => true
  | _, _ => false end.

Definition zraised (l : Z) (p : zrow) (e : nat) (f : zrow) : zrow := iter e (fun g => zmod l (zpmul p g)) f.
(* Modulo l, the product of the p^e and psi. *)
Fixpoint zcommon (l : Z) (fs : seq zfactor) (ps : seq power) (psi : zrow) : zrow :=
  match fs, ps with
  | f :: fs', w :: ps' => zraised l (zmonic l (pw_inv w) (f_p f)) (f_most f) (zcommon l fs' ps' psi)
  | _, _ => psi end.
Fixpoint all_powers (l : Z) (chi : zrow) (n : nat) (fs : seq zfactor) (ps : seq power) : bool :=
  match fs, ps with
  | f :: fs', w :: ps' => [&& (loss n f <= f_most f)%N, check_power l chi (f_p f) (f_most f) w & all_powers l chi n fs' ps']
  | [::], [::] => true
  | _, _ => false end.
(* The product of the p^(e - d), up to a factor. *)
Definition zexcess (n : nat) (fs : seq zfactor) : zrow :=
  foldr (fun f acc => zpmul (zppow (f_p f) (f_most f - loss n f)) acc) [:: 1%coqZ] fs.

Record large_witness := LargeWitness { lg_loop : loop_witness; lg_similar : similar; lg_powers : seq power;
  lg_psi : zrow; lg_u : zrow; lg_v : zrow; lg_D : Z; lg_N : zmat; lg_r : Z; lg_H : zrow }.
Definition check_bound (s : zsystem) (fs : seq zfactor) (l : Z) (c : large_witness) : bool :=
  let: (D, N, H) := (lg_D c, lg_N c, lg_H c) in
  let f := zexcess (zn s) fs in
  [&& Z.ltb 0 D, Z.leb 0 (lg_r c), shape (zn s) (zn s) N, zmat0 (zmaxpy (- zD s) N (zmaxpy D (zA s) [::])) &
  [&& ~~ Z.eqb (last z0 f) 0, zscaled_by D (last z0 f) 1 (rev f) (rev H), Z.ltb (zvalue (lg_r c) H) l &
      sums_at_most (zsquare (zsquare (zsquare N))) (zeighth (lg_r c))]].
Definition check_large (s : zsystem) (fs : seq zfactor) (c : large_witness) : bool :=
  let: (l, i) := (w_ell (lg_loop c), w_inv (lg_loop c)) in
  check_loop s (lg_loop c) &&
  let chi := loop_polynomial s (lg_loop c) in
  [&& all_powers l chi (zn s) fs (lg_powers c), zero_mod l (zaxpy (-1) (zcommon l fs (lg_powers c) (lg_psi c)) chi),
      check_bound s fs l c, check_similar l (zn s) (zscale_mod l i (zA s)) (lg_similar c) &
      bezout_modulo l (lg_u c) (lg_psi c) (lg_v c) (zchar l (h_H (lg_similar c)) (zn s))].

(* Integers. *)
Lemma intE z : phi [comRingType of int] z = int_of_Z z. Proof. exact: intz. Qed.
Lemma phi_residue0 lz (l1 : (1 < lz)%coqZ) z : phi [comRingType of 'Z_(modulus_of l1)] z = 0 -> (z mod lz = 0)%coqZ.
Proof.
have l0 := modulus_gt0 l1; rewrite -(phi_mod l0 (phi_modulus l1)).
have [] := Z.mod_pos_bound z lz l0; set r := (z mod lz)%coqZ => r0 rl.
rewrite -{1}[r]Z2Nat.id // /phi int_of_Z_nat -pmulrn => /eqP.
rewrite -val_eqE /= val_Zp_nat ?to_nat_gt1 // modn_small; last by apply/ssrnat.ltP/Z2Nat.inj_lt => //; exact: Z.lt_le_incl.
by move=> /eqP e; rewrite -[r]Z2Nat.id // e.
Qed.

Lemma zmostP M i j : (Z.abs (nth z0 (nth [::] M i) j) <= zmost M)%coqZ.
Proof.
have row r acc : (0 <= acc)%coqZ -> (acc <= foldr zlarger acc r)%coqZ /\ forall j, (Z.abs (nth z0 r j) <= foldr zlarger acc r)%coqZ.
  move=> acc0; elim: r => [|x r [IH1 IH2]] /=; first by split=> [|k]; rewrite ?nth_nil /=; lia.
  set t := foldr _ _ r in IH1 IH2 *; have big : (t <= zlarger x t)%coqZ /\ (Z.abs x <= zlarger x t)%coqZ by rewrite /zlarger; case: Z.leb_spec; lia.
  by split=> [|[|k]] /=; last have := IH2 k; lia.
have pos N : (0 <= zmost N)%coqZ by elim: N => [|r N IH] //=; have [] := row r _ IH; rewrite -/(zmost N); lia.
elim: M i => [|r M IH] [|i] /=; rewrite ?nth_nil //=; have [h1 h2] := row r _ (pos M); rewrite -/(zmost M); first exact: h2.
by have := IH i; lia.
Qed.
Lemma zvm_abs a b u N i : (0 <= a)%coqZ -> (0 <= b)%coqZ -> (forall k, Z.abs (nth z0 u k) <= a)%coqZ ->
  (forall k j, Z.abs (nth z0 (nth [::] N k) j) <= b)%coqZ -> (Z.abs (nth z0 (zvm u N) i) <= Z.of_nat (size N) * (a * b))%coqZ.
Proof.
move=> a0 b0; elim: u N => [|x u IH] [|r N] ub Nb; rewrite ?[zvm _ _]/= ?nth_nil ?[size _]/=; try nia.
rewrite nth_zvm; have h := IH N (fun k => ub k.+1) (fun k => Nb k.+1); have hx := ub 0%N; have hr := Nb 0%N i; rewrite /= in hx hr.
have := Z.abs_triangle (x * nth z0 r i) (nth z0 (zvm u N) i); rewrite Z.abs_mul; nia.
Qed.
Lemma zliftE t l x y q : l = (2 * t + 2)%coqZ -> (0 <= x < l)%coqZ -> (Z.abs y <= t)%coqZ -> (x - y = l * q)%coqZ -> zlift l x = y.
Proof.
move=> -> xl yt e; have : (q <= -1 \/ q = 0 \/ q = 1 \/ 2 <= q)%coqZ by lia.
by rewrite /zlift; case: Z.leb_spec => c [q1|[q0|[q1|q2]]]; nia.
Qed.
Lemma zsquareE n N : size N = n -> mx [comRingType of int] n n (zsquare N) = mx _ n n N *m mx _ n n N.
Proof.
move=> sN; rewrite -(zmmE _ _ _ _ (eq_leq sN)); apply/matrixP=> i j; rewrite !mxE !intE; congr int_of_Z.
rewrite /zsquare; set b := zmost N; set l := (_ + 2)%coqZ.
have b0 : (0 <= b)%coqZ by have := @zmostP N 0 0; rewrite -/b; lia.
have l1 : (1 < l)%coqZ by rewrite /l; nia.
have l0 : (0 < l)%coqZ by lia.
have iN : (i < size N)%N by rewrite sN.
set y := nth z0 (nth [::] (zmm N N) i) j; have yb : (Z.abs y <= Z.of_nat (size N) * (b * b))%coqZ.
  by rewrite /y (nth_map [::]) //; apply: zvm_abs => // k *; apply: zmostP.
pose x := nth z0 (nth [::] (zmm_mod l N N) i) j.
have xb : (0 <= x < l)%coqZ by rewrite /x (nth_map [::]) // /zvm_mod; apply: nth_mod.
have [q e] : exists q, (x - y = l * q)%coqZ.
  have := zmm_modE l0 (phi_modulus l1) n n N (eq_leq sN); rewrite -(zmmE _ _ _ _ (eq_leq sN)) => /matrixP/(_ i j); rewrite !mxE -/x -/y => exy.
  have : (phi [comRingType of 'Z_(modulus_of l1)] (x - y) = 0) by rewrite phiD phiN exy subrr.
  by move/phi_residue0 => z; exists ((x - y) / l)%coqZ; have := Z.div_mod (x - y) l; lia.
have -> : nth z0 (nth [::] [seq [seq zlift l x | x <- r] | r <- zmm_mod l N N] i) j = zlift l x.
  have sr : (i < size (zmm_mod l N N))%N by rewrite size_map.
  rewrite (nth_map [::]) //; have [js|js] := ltnP j (size (nth [::] (zmm_mod l N N) i)); first by rewrite (nth_map z0).
  have e0 : zlift l 0 = z0 by rewrite /zlift; case: Z.leb_spec => // ?; lia.
  by rewrite /x (@nth_default _ z0 (map _ _)) ?size_map // (@nth_default _ z0 (nth _ _ _)) // e0.
exact: zliftE (erefl l) xb yb e.
Qed.
Lemma size_zsquare N : size (zsquare N) = size N. Proof. by rewrite !size_map. Qed.

Lemma zabs_sum_least r n : \sum_(j < n) `|int_of_Z (nth z0 r j)|%N%:Z <= int_of_Z (zabs_sum r).
Proof.
elim: r n => [|x r IH] [|n]; rewrite ?big_ord0 //.
- by rewrite big1 // => j _; rewrite nth_nil.
- by rewrite /= int_of_ZD int_of_Z_abs addr_ge0 //; have := IH 0%N; rewrite big_ord0.
by rewrite big_ord_recl /= int_of_ZD int_of_Z_abs ler_add2l; apply: IH.
Qed.
Lemma zcolumn_sums_nth M n j : \sum_(i < n) `|int_of_Z (nth z0 (nth [::] M i) j)|%N%:Z <= int_of_Z (nth z0 (zcolumn_sums M) j).
Proof.
elim: M n => [|r M IH] [|n]; rewrite ?big_ord0 //.
- by rewrite nth_nil.
- by rewrite big1 ?nth_nil // => i _; rewrite !nth_nil.
- rewrite /= nth_axpy Z.mul_1_l int_of_ZD addr_ge0 //; last by have := IH 0%N; rewrite big_ord0.
  have [jr|jr] := ltnP j (size r); last by rewrite nth_default ?size_map.
  by rewrite (nth_map z0) // int_of_Z_abs.
rewrite big_ord_recl [zcolumn_sums _]/= -/(zcolumn_sums M) nth_axpy Z.mul_1_l int_of_ZD; apply: ler_add (IH n); rewrite /=.
have [jr|jr] := ltnP j (size r); last by rewrite !nth_default ?size_map.
by rewrite (nth_map z0) // int_of_Z_abs.
Qed.
Lemma zvalueE r v : (0 <= r)%coqZ -> int_of_Z (zvalue r v) = \sum_(i < size v) `|int_of_Z (nth z0 v i)|%N%:Z * int_of_Z r ^+ i.
Proof.
move=> r0; elim: v => [|c v IH]; first by rewrite big_ord0.
rewrite big_ord_recl /= -/(zvalue r v) int_of_ZD int_of_Z_abs int_of_ZM IH expr0 mulr1; congr (_ + _).
by rewrite mulr_sumr; apply: eq_bigr => i _; rewrite exprS mulrCA.
Qed.
Lemma zscaled_byE (R : comRingType) D lead power f v : zscaled_by D lead power f v -> size v = size f /\
  forall i, (i < size f)%N -> phi R (nth z0 v i) * phi R lead = phi R power * phi R D ^+ i * phi R (nth z0 f i).
Proof.
elim: f v power => [|x f IH] [|y v] power //= /andP[/Z.eqb_eq e /IH[-> h]]; split=> // -[_|i /h] /=.
  by rewrite expr0 mulr1 -!phiM e.
by move=> ->; rewrite phiM exprS !mulrA.
Qed.

Section Residues.
Variables (l : Z) (l1 : (1 < l)%coqZ).
Notation Zl := [comRingType of 'Z_(modulus_of l1)].
Let m0 := modulus_gt0 l1.
Lemma zraisedE p e f : pol Zl (zraised l p e f) = pol Zl p ^+ e * pol Zl f.
Proof.
rewrite /zraised; elim: e => [|e IH]; first by rewrite expr0 mul1r.
by rewrite iterS (pol_zmod m0 (phi_modulus l1)) pol_mul IH exprS mulrA.
Qed.

Notation up := (up [fieldType of rat]).
(* The polynomials of large_modulus.v. *)
Lemma all_powers_local n chi fs ps psi : all_powers l chi n fs ps -> exists G H : {poly Zloc (modulus_of l1)},
  [/\ G \is monic, H \is monic, map_poly (@residue _) (G * H) * pol Zl psi = pol Zl (zcommon l fs ps psi),
      map_poly (@Zloc_rat _) G = whole [fieldType of rat] n fs & map_poly (@Zloc_rat _) H = \prod_(f <- fs) up (f_p f) ^+ (f_most f - loss n f)].
Proof.
rewrite /whole; elim: fs ps => [|f fs IH] [|w ps] //=.
  by move=> _; exists 1, 1; rewrite !big_nil !mulr1 !rmorph1 mul1r monic1.
case/and3P=> le /and5P[/Z.ltb_lt g0 inv _ _ _] /IH[G [H [mG mH cm gG gH]]].
have [P [mP rP uP]] := local_monic l1 g0 inv.
exists (P ^+ loss n f * G), (P ^+ (f_most f - loss n f) * H); rewrite !big_cons; split.
- by rewrite monicMl ?monic_exp.
- by rewrite monicMl ?monic_exp.
- by rewrite zraisedE -rP -cm mulrACA -exprD subnKC // !rmorphM rmorphX /= !mulrA.
- by rewrite rmorphM rmorphX /= uP gG.
by rewrite rmorphM rmorphX /= uP gH.
Qed.
End Residues.

Lemma zexcessE (K : fieldType) (h : {rmorphism rat -> K}) n fs : (forall f, List.In f fs -> ~~ Z.eqb (last z0 (f_p f)) 0) ->
  ~~ Z.eqb (last z0 (zexcess n fs)) 0 -> up K (zexcess n fs) = \prod_(f <- fs) up K (f_p f) ^+ (f_most f - loss n f).
Proof.
move=> l0 e0; apply/eqP; rewrite -eqp_monic; last 2 first.
- exact: (up_monic h).
- elim: fs l0 {e0} => [|f fs IH] l0; first by rewrite big_nil monic1.
  have mf := up_monic h (l0 f (or_introl erefl)).
  by rewrite big_cons monicMl ?monic_exp //; apply: IH => g gin; apply: l0; right.
apply: eqp_trans (up_eqp h e0) _; elim: fs l0 {e0} => [|f fs IH] l0; first by rewrite big_nil [zexcess _ _]/= pol_one eqpxx.
rewrite big_cons [zexcess _ _]/= -/(zexcess n fs) pol_mul pol_pow; apply: eqp_trans (eqp_mull _ (IH (fun g gin => l0 g (or_intror gin)))) _.
by apply: eqp_mulr; apply: eqp_exp; rewrite eqp_sym up_eqp //; apply: l0; left.
Qed.

Section Large.
Variables (s : zsystem) (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Variables (fs : seq zfactor) (c : large_witness).
Hypothesis ok : check_large s fs c.

(* The rational system that the local one is. *)
Lemma local_represents (w : loop_witness) (okw : sized_loop s w) : represents s (map_system (@Zloc_rat _) (loop_system re okw)).
Proof.
pose i0 := [rmorphism of @idfun rat].
have up a b M : map_mx (@Zloc_rat _) (local (loop_modulus okw) (represented_D re) (loop_inverse okw) a b M) = over [fieldType of rat] (zD s) a b M.
  by have := into_local (loop_modulus okw) (represented_D re) (loop_inverse okw) i0 a b M; rewrite map_mx_id.
split; [exact: re_sized re | exact: re_n re | exact: re_m re | exact: re_p re | exact: re_q re | exact: up | move=> k; exact: up | move=> k; exact: up].
Qed.

Lemma check_large_most : each (fun f => ~ (forall F : gains K p q, up K (f_p f) ^+ (f_most f).+1 %| char_poly (closed_loop S F))) fs.
Proof.
case/andP: ok => okl /and5P[+ _ _ _ _]; elim: fs (lg_powers c) => [|f fs' IH] [|w ps] //= /and3P[_ pw /IH ?].
by split=> //; exact: (check_power_sound h re okl pw).
Qed.
Hypothesis facts : forall (K' : fieldType) (h' : {rmorphism rat -> K'}) (S' : multichannel K' n p q), represents s S' ->
  each (known S') fs /\ separate K' fs.

Theorem check_large_confined lambda : fixed S lambda -> root (\prod_(f <- fs) up K (f_p f)) lambda.
Proof.
move=> fx; have en := re_n re; case/andP: (ok) => /andP[okw okS] /and5P[pw /= fac bd okA bez].
rewrite /loop_polynomial -en in okS okA fac bez pw; set l1 := loop_modulus okw; pose l := modulus_of l1; pose Zl := [comRingType of 'Z_l].
pose SL := loop_system re okw; pose SQ := map_system (@Zloc_rat l) SL; have reQ : represents s SQ := local_represents okw.
pose i0 := [rmorphism of @idfun rat]; have [kQ sepQ] := facts i0 reQ.
have [G [H [mG mH cm gG gH]]] := all_powers_local l1 (lg_psi c) pw.
case/and5P: bd => /Z.ltb_lt D0 /Z.leb_le r0 sN eN /and4P[e0 sc /Z.ltb_lt big sums]; rewrite -en in sN e0 sc.
have l0 f : List.In f fs -> ~~ Z.eqb (last z0 (f_p f)) 0 by move=> fin; apply: kn_lead (each_in kQ fin).
have gH' := gH; rewrite -(zexcessE i0 l0 e0) in gH; have [sH HE] := zscaled_byE [comRingType of rat] sc; rewrite !size_rev in sH HE.
set f := zexcess n fs in e0 sc gH sH HE.
have fxQ : fixed (map_system h SQ) lambda by move=> F; rewrite (local_loop l1 (represented_D re) (loop_inverse okw) h re erefl).
have /bezout_moduloP := bez; move=> /(_ l1) bz.
have eA : map_mx (@residue l) (mcA SL) = mx _ n n (zscale_mod (w_ell (lg_loop c)) (w_inv (lg_loop c)) (zA s)) by exact: residue_local.
rewrite -(residue_char eA okA) in bz.
have sz : size H = size f by rewrite -(up_size i0 e0) -gH size_map_poly_id0 // (monicP mH) rmorph1 oner_eq0.
have f0 : phi [comRingType of rat] (last z0 f) != 0 by exact: (phi_neq0 i0 e0).
have Dn : int_of_Z (lg_D c) = Z.to_nat (lg_D c) by apply/to_natE/Z.lt_le_incl.
have rn : int_of_Z (lg_r c) = Z.to_nat (lg_r c) by apply/to_natE.
have rt : root (map_poly (into h) (G * H)) lambda.
  apply: (@large_modulus l n m p q SL (loop_gains p q okw) G H (pol Zl (lg_psi c)) (pol Zl (lg_u c)) (pol Zl (lg_v c)) mG mH _ _ bz
    (Z.to_nat (lg_D c)) (Z.to_nat (lg_r c)) 3 (mx [comRingType of int] n n (lg_N c)) (pol [comRingType of int] (lg_H c)) _ _ _ _ _ _ K h lambda fxQ).
  - rewrite (residue_char (loop_residuesE re okw) okS) cm.
    have := pol_zero (modulus_gt0 l1) (phi_modulus l1) fac; rewrite pol_axpy phiN1 polyCN mulN1r => /eqP.
    by rewrite addrC subr_eq0 => /eqP.
  - by move=> F; rewrite gG; apply: whole_dv => //.
  - by rewrite -ltz_nat -Dn; apply: (int_of_Z_lt D0).
  - move=> i j; rewrite pmulrn -Dn !mxE /Zloc_rat /= /ratz intE.
    have := zmat0E [comRingType of rat] n n eN; rewrite !zmaxpyE mx_nil addr0 phiN scaleNr addrC => /eqP; rewrite subr_eq0 => /eqP/matrixP/(_ i j).
    rewrite !mxE => e; rewrite mulrA; apply: (canLR (mulfK _)); last by rewrite [RHS]mulrC; exact: e.
    by apply: (phi_neq0 i0); case: (zD s) (represented_D re).
  - by rewrite (leq_trans (size_Poly _)) // size_map sH sz.
  - move=> i; rewrite sz => ik; rewrite polE intE pmulrn -Dn.
    have s0 : (0 < size f)%N by apply: leq_ltn_trans ik.
    have jf : ((size f).-1 - i < size f)%N by apply: leq_ltn_trans (leq_subr _ _) _; rewrite ltn_predL.
    have ej : (size f - ((size f).-1 - i).+1 = i)%N by rewrite -{1}(prednK s0) subSS subKn // -ltnS prednK.
    have := HE _ jf; rewrite !nth_rev ?sH // ej mul1r => e.
    have -> : Zloc_rat H`_i = (map_poly (@Zloc_rat l) H)`_i by rewrite coef_map.
    by rewrite gH upE mulrCA -[_ ^+ _ * _]e mulrCA mulVf // mulr1.
  - have e8 : int_of_Z (zeighth (lg_r c)) = (Z.to_nat (lg_r c) ^ (2 ^ 3))%N by rewrite /zeighth !int_of_ZM rn -!PoszM !mulnn -!expnM.
    have eq8 : squared 3 (mx [comRingType of int] n n (lg_N c)) = mx _ n n (zsquare (zsquare (zsquare (lg_N c)))).
      by rewrite /squared /= !zsquareE ?size_zsquare //; case/andP: sN => /eqP.
    rewrite eq8; set E := zsquare _ in sums *; have sE : size E = n by rewrite !size_zsquare; case/andP: sN => /eqP.
    case/orP: sums => [/(all_nthP [::])|/(all_nthP z0)] small; [left|right] => i; rewrite -e8.
      have le1 : (zabs_sum (nth [::] E i) <= zeighth (lg_r c))%coqZ by apply/Z.leb_le/small; rewrite sE.
      apply: le_trans (int_of_Z_le le1); apply: le_trans (zabs_sum_least _ n).
      by apply: ler_sum => j _; rewrite mxE intE abszE.
    have le1 : (nth z0 (zcolumn_sums E) i <= zeighth (lg_r c))%coqZ.
      have [iE|iE] := ltnP i (size (zcolumn_sums E)); first exact/Z.leb_le/small.
      by rewrite nth_default // /zeighth; apply: Z.square_nonneg.
    apply: le_trans (int_of_Z_le le1); apply: le_trans (zcolumn_sums_nth _ n _).
    by apply: ler_sum => j _; rewrite mxE intE abszE.
  have ln : int_of_Z (w_ell (lg_loop c)) = l by apply/to_natE/Z.lt_le_incl/modulus_gt0.
  rewrite -ln; apply: le_lt_trans (int_of_Z_lt big); rewrite zvalueE // rn.
  have le : (size (pol [comRingType of int] (lg_H c)) <= size (lg_H c))%N by rewrite (leq_trans (size_Poly _)) // size_map.
  rewrite (big_ord_widen _ (fun i => `|(pol [comRingType of int] (lg_H c))`_i| * (Z.to_nat (lg_r c))%:Z ^+ i) le) big_mkcond; apply: ler_sum => i _.
  by rewrite polE intE abszE; case: ifP => // _; rewrite mulr_ge0 // exprn_ge0.
have powers (e : zfactor -> nat) : root (map_poly h (\prod_(f <- fs) up [fieldType of rat] (f_p f) ^+ e f)) lambda -> root (\prod_(f <- fs) up K (f_p f)) lambda.
  rewrite rmorph_prod; elim: fs => [|f' fs' IH]; rewrite ?big_nil // !big_cons !rootM rmorphX /= map_up => /orP[|/IH->]; last by rewrite orbT.
  by rewrite /root horner_exp expf_eq0 => /andP[_ ->].
by move: rt; rewrite map_poly_into !rmorphM /= gG gH' rootM => /orP[]; apply: powers.
Qed.
End Large.
