(* checker/boxes.py: along a path of polynomials on which no root meets the border of the region, roots stay in it.

   What the real numbers are used for is that a polynomial has a first root: whether all roots of p(t) are in the region
   is a matter of the signs of some polynomials in t (Routh; Schur and Cohn), and where such a sign is lost first, the
   roots before it keep their distance to every point outside of the region. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex polyrcf.
From mcexact Require Import location.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Path.
Variable R : rcfType.
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Implicit Types (p : {poly {poly R}}) (q : {poly R}) (qs : seq {poly R}) (s t : R) (z : C).

(* The polynomial in x at one t. *)
Definition at_ t p : {poly C} := map_poly inC (map_poly (horner_eval t) p).

Lemma coef_at t p k : (at_ t p)`_k = inC (p`_k).[t].
Proof. by rewrite !coef_map. Qed.

Lemma inC_real s : (inC s : C) \is Num.real.
Proof. by apply/complex_realP; exists s. Qed.

Lemma real_at t p : real_poly (at_ t p).
Proof. by apply/polyOverP => k; rewrite coef_at inC_real. Qed.

Lemma inC_lt s t : (inC s < inC t :> C) = (s < t).
Proof. by rewrite ltcE /= eqxx. Qed.
Lemma inC_le s t : (inC s <= inC t :> C) = (s <= t).
Proof. by rewrite lecE /= eqxx. Qed.
Lemma inC_norm s : `|inC s : C| = inC `|s|.
Proof. by rewrite normc_def /= expr0n addr0 sqrtr_sqr. Qed.

Lemma size_at t p n : (size p <= n.+1)%N -> (p`_n).[t] != 0 -> size (at_ t p) = n.+1.
Proof.
move=> sp nl; have l : (at_ t p)`_n != 0 by rewrite coef_at fmorph_eq0.
apply/eqP; rewrite eqn_leq ltnNge; apply/andP; split; last first.
  by apply: contra l => /leq_sizeP/(_ n (leqnn n)) ->.
by rewrite (leq_trans (size_poly _ _))// (leq_trans (size_poly _ _)).
Qed.

Definition signs qs t := all (fun q => 0 < q.[t]) qs.

(* Whether all real parts are negative is decided by the signs of polynomials in t. *)
Lemma hurwitz_signs n p : (size p <= n.+1)%N ->
  exists qs, forall t, 0 < (p`_n).[t] -> (hurwitz (at_ t p) <-> signs qs t).
Proof.
elim: n p => [|n IH] p sp.
  exists [::] => t l; split=> // _; have s1 := size_at sp (lt0r_neq0 l).
  by apply: no_root_const; rewrite ?s1// -size_poly_eq0 s1.
pose g : {poly {poly R}} := \poly_(i < n.+1)
  (if (0 < i)%N && ~~ odd (n.+1 - i) then p`_n * p`_i - p`_n.+1 * p`_i.-1 else p`_n * p`_i).
have [qs h] := IH g (size_poly _ _); exists (p`_n :: qs) => t l.
have sP := size_at sp (lt0r_neq0 l); pose P := at_ t p; rewrite -/P in sP *.
have lP : 0 < lead_coef P by rewrite lead_coefE sP coef_at -(rmorph0 inC) inC_lt.
have gn : g`_n = p`_n ^+ 2 by rewrite coef_poly ltnSn subSnn andbF expr2.
have hP k : P`_k = inC (p`_k).[t] by exact: coef_at.
have rP : real_poly P by exact: real_at.
have eg : (p`_n).[t] != 0 -> at_ t g = P`_n *: routh_step P.
  move=> nz; clearbody P; apply/polyP => i.
  rewrite coef_at coefZ ![(\poly_(_ < _) _)`_i]coef_poly sP /=.
  case: (ltnP i n.+1) => i1; last by rewrite horner0 rmorph0 mulr0.
  rewrite !hP; case: ifP => _; last by rewrite hornerM rmorphM.
  rewrite hornerD hornerN !hornerM rmorphB !rmorphM /= mulrBr; congr (_ - _).
  by rewrite [RHS]mulrA [X in _ = X * _]mulrC divfK// fmorph_eq0.
have hg : 0 < (p`_n).[t] -> (hurwitz (routh_step P) <-> signs qs t).
  move=> pos; rewrite -h ?gn ?hornerE_comm ?exprn_gt0//; last by rewrite horner_exp exprn_gt0.
  rewrite (eg (lt0r_neq0 pos)); have nz : P`_n != 0 by rewrite hP fmorph_eq0 gt_eqF.
  by split=> H z; [rewrite rootZ// => /H | have := H z; rewrite rootZ].
rewrite (routh rP sP lP) hP -(rmorph0 inC) inC_lt /=.
by split=> [[pos /(hg pos) ->]|/andP[pos /(hg pos)]]; rewrite ?pos.
Qed.

(* Whether all moduli are below 1, in the same way. *)
Lemma schur_signs n p : (size p <= n.+1)%N ->
  exists qs, forall t, (p`_n).[t] != 0 -> (schur (at_ t p) <-> signs qs t).
Proof.
elim: n p => [|n IH] p sp.
  exists [::] => t l; split=> // _; have s1 := size_at sp l.
  by apply: no_root_const; rewrite ?s1// -size_poly_eq0 s1.
pose g : {poly {poly R}} := \poly_(i < n.+1) (p`_n.+1 * p`_i.+1 - p`_0 * p`_(n.+1 - i.+1)).
have [qs h] := IH g (size_poly _ _); exists (p`_n.+1 ^+ 2 - p`_0 ^+ 2 :: qs) => t l.
have sP := size_at sp l; pose P := at_ t p; rewrite -/P in sP *.
have hP k : P`_k = inC (p`_k).[t] by exact: coef_at.
have rP : real_poly P by exact: real_at.
have nz : P`_n.+1 != 0 by rewrite hP fmorph_eq0.
have gn : g`_n = p`_n.+1 ^+ 2 - p`_0 ^+ 2 by rewrite coef_poly ltnSn subnn !expr2.
have eg : at_ t g = P`_n.+1 *: schur_step P.
  clearbody P; apply/polyP => i.
  rewrite coef_at coefZ ![(\poly_(_ < _) _)`_i]coef_poly sP /=.
  case: (ltnP i n.+1) => i1; last by rewrite horner0 rmorph0 mulr0.
  rewrite !hP hornerD hornerN !hornerM rmorphB !rmorphM /= mulrBr; congr (_ - _).
  by rewrite [RHS]mulrA [X in _ = X * _]mulrC divfK// fmorph_eq0.
have first : (`|P`_0| < `|P`_n.+1|) = (0 < (p`_n.+1 ^+ 2 - p`_0 ^+ 2).[t]).
  rewrite !hP !inC_norm inC_lt hornerD hornerN !horner_exp subr_gt0.
  by rewrite -[LHS](@ltr_pexpn2r _ 2) ?nnegrE// !real_normK ?num_real.
have hg : 0 < (g`_n).[t] -> (schur (schur_step P) <-> signs qs t).
  move=> pos; rewrite -h ?gt_eqF//.
  by rewrite eg; split=> H z; [rewrite rootZ// => /H | have := H z; rewrite rootZ].
rewrite (schur_cohn rP sP) first /= -gn.
by split=> [[pos /(hg pos) ->]|/andP[pos /(hg pos)]]; rewrite ?pos.
Qed.

(* The value at z changes little with t. *)
Lemma value_cont p s z (e : C) : 0 < e -> exists2 d : R, 0 < d &
  forall t, `|t - s| < d -> `|(at_ t p).[z] - (at_ s p).[z]| < e.
Proof.
move=> e0; elim/poly_ind: p e e0 => [|p c IH] e e0.
  by exists 1 => [|t _]; rewrite ?ltr01// /at_ !rmorph0 !horner0 subrr normr0.
have h0 : 0 < e / 2%:R by rewrite divr_gt0 ?ltr0n.
have k0 : 0 < `|z| + 1 by rewrite ltr_paddl.
have [d1 d10 h1] := IH _ (divr_gt0 h0 k0).
have [x ex] : exists x : R, e / 2%:R = inC x by apply/complex_realP; rewrite gtr0_real.
have x0 : 0 < x by rewrite -inC_lt -ex rmorph0.
have [d2 d20 h2] := poly_cont s c x0.
exists (Num.min d1 d2) => [|t]; first by rewrite lt_minr d10.
rewrite lt_minr => /andP[/h1 {}h1 /h2 {}h2].
have v t' : (at_ t' (p * 'X + c%:P)).[z] = (at_ t' p).[z] * z + inC c.[t'].
  by rewrite /at_ !rmorphD !rmorphM /= !map_polyX !map_polyC !hornerE.
rewrite !v opprD addrACA -mulrBl -rmorphB; apply: le_lt_trans (ler_norm_add _ _) _.
rewrite [X in _ < X](splitr e) ler_lt_add//; last by rewrite inC_norm ex inC_lt.
rewrite normrM; apply: (@le_trans _ _ (e / 2%:R / (`|z| + 1) * (`|z| + 1))); last by rewrite divfK ?gt_eqF.
by rewrite ler_pmul// ?ler_addl// ltW.
Qed.

(* A region, its border, and a distance from what is beyond the border. *)
Variables (inner border : C -> Prop).
Hypothesis apart : forall z, [\/ inner z, border z |
  exists2 c : C, 0 < c & forall r, inner r -> c <= `|z - r|].

Theorem no_crossing p n qs : (size p <= n.+1)%N -> (forall t, 0 <= t <= 1 -> 0 < (p`_n).[t]) ->
  (forall t, 0 < (p`_n).[t] -> (forall z, root (at_ t p) z -> inner z) <-> signs qs t) ->
  (forall t z, 0 <= t <= 1 -> border z -> ~~ root (at_ t p) z) ->
  (forall z, root (at_ 0 p) z -> inner z) -> forall z, root (at_ 1 p) z -> inner z.
Proof.
move=> sp lead decide off start.
have decided t : 0 <= t <= 1 -> (forall z, root (at_ t p) z -> inner z) <-> signs qs t by move/lead/decide.
have [i0 i1] : (0 : R) <= 0 <= (1 : R) /\ (0 : R) <= 1 <= (1 : R) by rewrite !lexx ler01.
apply: (decided 1 i1).2.
pose Q := \prod_(q <- qs) q; have all0 : signs qs 0 by apply: (decided 0 i0).1.
have Qt t : Q.[t] = \prod_(q <- qs) q.[t] by rewrite horner_prod.
have pos t : signs qs t -> 0 < Q.[t].
  by move=> /allP h; rewrite Qt big_seq prodr_gt0.
have Q0 : Q != 0 by apply: contraTneq (pos 0 all0) => ->; rewrite horner0 ltxx.
pose s := next_root Q 0 1.
have s01 : s \in `[0, 1] by have := next_root_in Q 0 1; rewrite max_l ?ler01.
have s0 : 0 < s := next_root_gt ltr01 Q0.
have before t : 0 <= t < s -> signs qs t.
  move=> /andP[t0 ts]; apply/allP => q qin; rewrite ltNge; apply/negP => qt.
  have q0 : 0 < q.[0] by apply: (allP all0).
  have [|x x0t rx] := @polyrcf.poly_ivt _ (- q) 0 t t0.
    by rewrite in_itv /= !hornerN oppr_le0 oppr_ge0 qt andbT ltW.
  have x0 : x != 0 by apply: contraTneq rx => ->; rewrite rootN rootE gt_eqF.
  have xs : x \in `]0, s[.
    by move: x0t; rewrite !in_itv /= => /andP[x0' xt]; rewrite lt_def x0 x0' (le_lt_trans xt).
  have := next_noroot xs; rewrite rootE Qt prodf_seq_neq0 => /allP/(_ q qin) /=.
  by move: rx; rewrite rootN rootE => ->.
have at_s : signs qs s.
  apply: (decided s s01).1 => z rz; case: (apart z) => // [bz|[c c0 far]].
    by have := off s z; rewrite rz => /(_ s01 bz).
  pose l := (p`_n).[s] / 2%:R; have l0 : 0 < l by rewrite divr_gt0 ?ltr0n ?lead.
  have il0 : 0 < inC l :> C by rewrite -(rmorph0 inC) inC_lt.
  have cl0 : 0 < inC l * c ^+ n by rewrite mulr_gt0 ?exprn_gt0.
  have [d1 d10 near] := value_cont p s z cl0; have [d2 d20 near'] := poly_cont s p`_n l0.
  pose d := Num.min d1 d2; have d0 : 0 < d by rewrite lt_minr d10.
  have [dd1 dd2] : d <= d1 /\ d <= d2 by rewrite !le_minl !lexx orbT.
  clearbody d; have m0 : 0 < Num.min d s by rewrite lt_minr d0.
  have half : Num.min d s / 2%:R < Num.min d s.
    by rewrite ltr_pdivr_mulr ?ltr0n// mulr_natr mulr2n ltr_addl.
  have [md ms] : Num.min d s <= d /\ Num.min d s <= s by rewrite !le_minl !lexx orbT.
  pose t := s - Num.min d s / 2%:R.
  have ts : 0 <= t < s.
    by rewrite /t subr_ge0 (le_trans (ltW half))//= ltr_subl_addl ltr_addr divr_gt0 ?ltr0n.
  have td : `|t - s| < d.
    by rewrite /t addrAC subrr add0r normrN gtr0_norm ?divr_gt0 ?ltr0n// (lt_le_trans half).
  have t01 : 0 <= t <= 1.
    by case/andP: ts => -> /ltW/le_trans->//; move: s01; rewrite in_itv /= => /andP[].
  have lt : l <= (p`_n).[t].
    have := near' t (lt_le_trans td dd2); rewrite distrC => /(le_lt_trans (ler_norm _)).
    by rewrite ltr_subl_addr {1}(splitr (p`_n).[s]) -/l ltr_add2l => /ltW.
  have := near t (lt_le_trans td dd1); rewrite (rootP rz) subr0.
  have [rs ers] := roots_of (at_ t p).
  have st : size (at_ t p) = n.+1 by apply: size_at; rewrite ?gt_eqF ?lead.
  have mt : lead_coef (at_ t p) = inC (p`_n).[t] by rewrite lead_coefE st coef_at.
  have srs : size rs = n.
    apply: succn_inj; rewrite -st ers size_scale ?size_prod_XsubC// mt.
    by rewrite fmorph_eq0 gt_eqF ?lead.
  rewrite (horner_roots _ ers) mt normrM normr_prod => small.
  have : inC l * c ^+ n <= `|inC (p`_n).[t]| * \prod_(r <- rs) `|z - r|.
    apply: ler_pmul; rewrite ?exprn_ge0 ?(ltW c0)//; first exact: ltW.
      by rewrite inC_norm inC_le (le_trans lt)// ler_norm.
    have <- : \prod_(r <- rs) c = c ^+ n by rewrite big_const_seq count_predT iter_mulr_1 srs.
    rewrite big_seq [X in _ <= X]big_seq; apply: ler_prod => r rin; rewrite (ltW c0)/= far//.
    by apply: (decided t t01).2; rewrite ?before//; apply: root_in ers rin.
  by move/(lt_le_trans small); rewrite ltxx.
have : Q.[s] != 0 by rewrite gt_eqF ?pos.
suff -> : 1 = s by [].
move: (pos s at_s); rewrite /s; case: next_rootP => [->|y _ -> _ _|c _ -> _ _].
- by rewrite horner0 ltxx.
- by rewrite ltxx.
by rewrite max_l ?ler01.
Qed.
End Path.
