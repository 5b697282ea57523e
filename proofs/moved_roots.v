(* checker/core/roots.py, in_region (L4 and L5 of location.md): a rate by a shift, a radius by scaling.
   The polynomials are made by Horner's rule, as the checker makes them, over Q; C is a closed field. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location mobius.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Horner.
Variable F : fieldType.
Implicit Types (p : {poly F}) (b c z : F).

(* p(x - b): from the last coefficient on, times x - b, plus the next one. *)
Definition shifted p b : {poly F} := foldr (fun c q => c%:P + ('X - b%:P) * q) 0 p.
(* p(bx) *)
Definition scaled p b : {poly F} := \poly_(k < size p) (p`_k * b ^+ k).
(* Sum p_k (1 + x)^k (1 - x)^(d - k), and the power of 1 - x beside it. *)
Definition moebius p : {poly F} :=
  (foldr (fun c q => ((1 + 'X) * q.1 + c *: q.2, (1 - 'X) * q.2)) (0, 1) p).1.

Lemma shiftedE p b : shifted p b = p \Po ('X - b%:P).
Proof.
rewrite comp_polyE /shifted; elim: (polyseq p) => [|c s IH] /=; first by rewrite big_ord0.
rewrite IH big_ord_recl expr0 alg_polyC mulr_sumr; congr (_ + _); apply: eq_bigr => i _ /=.
by rewrite -scalerAr exprS.
Qed.

Lemma scaledE p b z : (scaled p b).[z] = p.[b * z].
Proof.
rewrite /scaled horner_poly horner_coef; apply: eq_bigr => k _.
by rewrite exprMn mulrA.
Qed.

Lemma moebiusE p : moebius p = \sum_(k < size p) p`_k *: ((1 + 'X) ^+ k * (1 - 'X) ^+ ((size p).-1 - k)).
Proof.
rewrite /moebius; move: (polyseq p) => s.
suff -> : foldr (fun c q => ((1 + 'X) * q.1 + c *: q.2, (1 - 'X) * q.2)) (0, 1) s =
    (\sum_(k < size s) s`_k *: ((1 + 'X) ^+ k * (1 - 'X) ^+ ((size s).-1 - k)), (1 - 'X) ^+ size s) by [].
elim: s => [|c s IH] /=; first by rewrite big_ord0 expr0.
rewrite IH /= big_ord_recl expr0 mul1r subn0 -exprS addrC; congr (_ + _, _).
rewrite mulr_sumr; apply: eq_bigr => k _ /=; rewrite /bump /= add1n -scalerAr mulrA -exprS.
by congr (_ *: (_ * _ ^+ _)); rewrite subnS predn_sub.
Qed.

Lemma moebius_term d k : (k <= d)%N -> let t := (1 + 'X) ^+ k * (1 - 'X) ^+ (d - k) : {poly F} in
  size t = d.+1 /\ t`_d = (-1) ^+ (d - k).
Proof.
move=> kd t; pose m := ('X - (-1)%:P) ^+ k * ('X - 1%:P) ^+ (d - k) : {poly F}.
have mm : m \is monic by rewrite monicMl monic_exp ?monicXsubC.
have sm : size m = d.+1.
  by rewrite /m size_monicM ?monic_exp ?monicXsubC// -?size_poly_eq0 !size_exp_XsubC// addSn addnS subnKC.
have -> : t = (-1) ^+ (d - k) *: m.
  have e1 : 1 + 'X = 'X - (-1)%:P :> {poly F} by rewrite polyCN opprK addrC.
  have e2 : 1 - 'X = - ('X - 1%:P) :> {poly F} by rewrite opprB.
  by rewrite /t e1 e2 [(- ('X - 1%:P)) ^+ _]exprNn mulrCA -mul_polyC rmorphX rmorphN1.
have n1 : (-1) ^+ (d - k) != 0 :> F by rewrite signr_eq0.
split; first by rewrite size_scale.
by rewrite coefZ; have /monicP := mm; rewrite lead_coefE sm /= => ->; rewrite mulr1.
Qed.

Let moebius_d p k : (k < size p)%N -> (k <= (size p).-1)%N.
Proof. by move=> kp; rewrite -ltnS (leq_trans kp)// leqSpred. Qed.

Lemma size_moebius p : (size (moebius p) <= size p)%N.
Proof.
rewrite moebiusE; apply: (leq_trans (size_sum _ _ _)); apply/bigmax_leqP => k _.
apply: (leq_trans (size_scale_leq _ _)).
by have [-> _] := moebius_term (moebius_d (ltn_ord k)); rewrite prednK// (leq_trans _ (ltn_ord k)).
Qed.

(* The coefficient of x^d is +-p(-1). *)
Lemma moebius_lead p : (moebius p)`_(size p).-1 = (-1) ^+ (size p).-1 * p.[-1].
Proof.
rewrite moebiusE coef_sum horner_coef mulr_sumr; apply: eq_bigr => k _.
have kd := moebius_d (ltn_ord k); have [_ e] := moebius_term kd.
rewrite coefZ e mulrCA; congr (_ * _).
by rewrite -[in RHS](subnK kd) exprD -mulrA -exprD addnn -[X in _ * X]signr_odd odd_double mulr1.
Qed.
End Horner.

Section Maps.
Variables (F L : fieldType) (f : {rmorphism F -> L}).

Lemma map_shifted p b : map_poly f (shifted p b) = shifted (map_poly f p) (f b).
Proof. by rewrite !shiftedE map_comp_poly rmorphB /= map_polyX map_polyC. Qed.
Lemma map_scaled p b : map_poly f (scaled p b) = scaled (map_poly f p) (f b).
Proof.
apply/polyP=> i; rewrite coef_map [in LHS]coef_poly [RHS]coef_poly size_map_poly coef_map /=.
by case: ifP => _; rewrite ?rmorph0// rmorphM rmorphX.
Qed.
Lemma map_moebius p : map_poly f (moebius p) = moebius (map_poly f p).
Proof.
rewrite !moebiusE rmorph_sum size_map_poly; apply: eq_bigr => k _ /=.
by rewrite map_polyZ coef_map rmorphM !rmorphX rmorphB rmorphD /= map_polyX rmorph1.
Qed.
End Maps.

Section Closed.
Variable C : numClosedFieldType.
Implicit Types (p : {poly C}) (b z : C).

(* The roots of p(x - b) are those of p, plus b. *)
Theorem shifted_roots p b z : root (shifted p b) z = root p (z - b).
Proof. by rewrite shiftedE /root horner_comp !hornerE. Qed.

(* The roots of p(bx) are those of p, divided by b. *)
Theorem scaled_roots p b z : root (scaled p b) z = root p (b * z).
Proof. by rewrite /root scaledE. Qed.

(* Rule "rate": every real part is below -b iff p(x - b) is Hurwitz. *)
Theorem rate_rule p b : b \is Num.real -> (forall z, root p z -> 'Re z < - b) <-> hurwitz (shifted p b).
Proof.
move=> rb; have e z : ('Re z < 0) = ('Re (z - b) < - b).
  by rewrite raddfB /= (Creal_ReP _ rb) ltr_subl_addl subrr.
split=> [h z|h z rz]; first by rewrite shifted_roots e => /h.
by have := h (z + b); rewrite shifted_roots e addrK; apply.
Qed.

(* Rule "radius": every modulus is below b > 0 iff p(bx) is Schur. *)
Theorem radius_rule p b : 0 < b -> (forall z, root p z -> `|z| < b) <-> schur (scaled p b).
Proof.
move=> b0; have nb : b != 0 by rewrite gt_eqF.
have e z : (`|z| < 1) = (`|b * z| < b).
  by rewrite normrM (gtr0_norm b0) -{2}[b]mulr1 ltr_pmul2l.
split=> [h z|h z rz]; first by rewrite scaled_roots e => /h.
by have := h (b^-1 * z); rewrite scaled_roots e mulVKf//; apply.
Qed.
End Closed.

(* The rules as the checker runs them: on rational polynomials, with Routh's recursion. *)
Section Rational.
Variable C : numClosedFieldType.
Notation up := (map_poly (ratr : rat -> C)).
Implicit Types (p : {poly rat}) (b : rat).

Lemma ratr_real (x : rat) : (ratr x : C) \is Num.real.
Proof. by rewrite realE ler0q lerq0 le_total. Qed.
Lemma real_up p : real_poly (up p).
Proof. by apply/polyOverP=> i; rewrite coef_map; exact: ratr_real. Qed.

Lemma routh_step_up p : routh_step (up p) = up (routh_step p).
Proof.
apply/polyP=> i; rewrite coef_map [in RHS]coef_poly [LHS]coef_poly size_map_poly !coef_map /=.
case: ifP => _; rewrite ?rmorph0//; case: ifP => _ //.
by rewrite rmorphB rmorphM fmorph_div.
Qed.

Lemma is_hurwitz_up k p : is_hurwitz k (up p) = is_hurwitz k p.
Proof.
elim: k p => //= k IH p; rewrite routh_step_up IH size_map_poly coef_map /=.
by rewrite ltr0q.
Qed.

(* Routh's recursion over Q for a polynomial with leading coefficient above 0. *)
Lemma routh_rational p : 0 < lead_coef p -> reflect (hurwitz (up p)) (is_hurwitz (size p).-1 p).
Proof.
move=> lp; rewrite -is_hurwitz_up; apply: is_hurwitzP; first exact: real_up.
  by rewrite lead_coef_map ltr0q.
by rewrite size_map_poly leqSpred.
Qed.

(* in_region, continuous time. *)
Theorem region_continuous p b : p \is monic ->
  reflect (forall z : C, root (up p) z -> 'Re z < - ratr b) (is_hurwitz (size p).-1 (shifted p b)).
Proof.
move=> /monicP mp; have s2 : size ('X - b%:P) = 2%N by rewrite size_XsubC.
have ss : size (shifted p b) = size p by rewrite shiftedE size_comp_poly2.
have ls : lead_coef (shifted p b) = 1.
  by rewrite shiftedE lead_coef_comp ?s2// mp lead_coefXsubC expr1n mulr1.
rewrite -{1}ss; apply: (iffP (routh_rational _)); rewrite ?ls ?ltr01// map_shifted.
  by move/(rate_rule _ (ratr_real b)).
by move=> h; apply/(rate_rule _ (ratr_real b)).
Qed.

(* is_schur: the coefficient of x^d is not 0, and what is left after division by it is Hurwitz. *)
Definition schur_by_moebius p := let m := moebius p in let l := m`_(size p).-1 in
  (l != 0) && is_hurwitz (size p).-1 (l^-1 *: m).

Theorem schur_by_moebiusP p : p != 0 -> reflect (schur (up p)) (schur_by_moebius p).
Proof.
move=> p0; pose d := (size p).-1; have np : up p != 0 by rewrite map_poly_eq0.
have e : transformed (up p) = up (moebius p) by rewrite map_moebius moebiusE.
have el : ((moebius p)`_d != 0) = ((up p).[-1] != 0).
  have -> : -1 = ratr (-1) :> C by rewrite rmorphN1.
  by rewrite moebius_lead mulf_eq0 signr_eq0 horner_map fmorph_eq0.
have sm : (moebius p)`_d != 0 -> size (moebius p) = size p.
  move=> nl; apply/eqP; rewrite eqn_leq size_moebius /= -[size p]prednK ?size_poly_gt0//.
  by rewrite ltnNge; apply: contra nl => /leq_sizeP/(_ d (leqnn d)) ->.
have key : (moebius p)`_d != 0 ->
    reflect (hurwitz (up (moebius p))) (is_hurwitz d ((moebius p)`_d^-1 *: moebius p)).
  move=> nl; have nv : (moebius p)`_d^-1 != 0 by rewrite invr_eq0.
  have sz : size ((moebius p)`_d^-1 *: moebius p) = size p by rewrite size_scale// sm.
  have lz : lead_coef ((moebius p)`_d^-1 *: moebius p) = 1.
    by rewrite lead_coefE sz coefZ mulVf.
  have := @routh_rational ((moebius p)`_d^-1 *: moebius p); rewrite sz lz => /(_ ltr01) rr.
  apply: (iffP rr); rewrite map_polyZ => h z rz.
    by apply: h; rewrite /root hornerZ (rootP rz) mulr0.
  by apply: h; move: rz; rewrite rootZ// fmorph_eq0.
apply: (iffP andP) => [[nl hk]|/(schur_mobius np)[n1 hm]].
  by apply/(schur_mobius np); rewrite -el e; split=> //; apply/(key nl).
have nl : (moebius p)`_d != 0 by rewrite el.
by split=> //; apply/(key nl); rewrite -e.
Qed.

(* in_region, discrete time. *)
Theorem region_discrete p b : p != 0 -> 0 < b ->
  reflect (forall z : C, root (up p) z -> `|z| < ratr b) (schur_by_moebius (scaled p b)).
Proof.
move=> p0 b0; have b0' : 0 < ratr b :> C by rewrite ltr0q.
have s0 : scaled p b != 0.
  apply: contraNneq p0 => e; apply/eqP/polyP=> i; rewrite coef0.
  have [ip|pi] := ltnP i (size p); last by rewrite nth_default.
  have := congr1 (fun q : {poly rat} => q`_i) e; rewrite coef_poly ip coef0 => /eqP.
  by rewrite mulf_eq0 expf_eq0 (gt_eqF b0) andbF orbF => /eqP.
apply: (iffP (schur_by_moebiusP s0)); rewrite map_scaled; first by move/(radius_rule _ b0').
by move=> h; apply/(radius_rule _ b0').
Qed.
End Rational.
