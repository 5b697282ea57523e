(* Brasch and Pearson: a plant that is controllable and whose observability index is at most k + 1
   has, for every monic polynomial of degree n + k, a compensator of order k that gives the closed
   loop this characteristic polynomial; dually with the controllability index.  With one input the
   field is any; with several it is infinite, with eigenvalues in an algebraically closed field. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import resolvent pencil_space anderson_clements joint_controllability.
From mcexact Require Import gain_lines neighbor_graph extended_bound sequential_gains feedback.
From mcexact Require Import corfmat_morse error_system free_assignment.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* plant (A, B, C) and compensator z' = Ac z + Bc y, u = Cc z + D y; state (x, z) *)
Definition compensated (K : ringType) n p q k (A : 'M[K]_n) (B : 'M_(n, p)) (C : 'M_(q, n))
    (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'M_(p, k)) (D : 'M_(p, q)) : 'M_(n + k) :=
  block_mx (A + B *m D *m C) (B *m Cc) (Bc *m C) Ac.

Section OneInput.
Variables (K : fieldType) (n q k : nat) (A : 'M[K]_n) (b : 'cV[K]_n) (C : 'M[K]_(q, n)).

(* the characteristic polynomial of the loop *)
Lemma char_poly_compensated (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'rV_k) (D : 'rV_q) :
  char_poly (compensated A b C Ac Bc Cc D) = char_poly A * char_poly Ac -
    ((char_poly Ac *: map_mx polyC D + transfer Ac Bc Cc) *m transfer A b C) 0 0.
Proof.
pose M := block_mx (char_poly_mx A) 0 (- map_mx polyC (Bc *m C)) (char_poly_mx Ac).
pose u : 'cV_(n + k) := col_mx (map_mx polyC b) 0.
pose v : 'rV_(n + k) := row_mx (map_mx polyC (D *m C)) (map_mx polyC Cc).
pose z := \adj (char_poly_mx A) *m map_mx polyC b.
pose y : 'cV_(n + k) := col_mx (char_poly Ac *: z)
  (\adj (char_poly_mx Ac) *m map_mx polyC (Bc *m C) *m z).
have dM : \det M = char_poly A * char_poly Ac by rewrite det_lblock.
rewrite {1}/char_poly.
have -> : char_poly_mx (compensated A b C Ac Bc Cc D) = M - u *m v.
  rewrite /char_poly_mx /compensated map_block_mx scalar_mx_block /M /u /v mul_col_row !mul0mx.
  rewrite !opp_block_mx !add_block_mx !subr0 sub0r map_mxD opprD addrA !map_mxM.
  by rewrite -mulmxA !add0r.
rewrite (@det_rank_one _ _ _ _ y).
- rewrite dM; congr (_ - _ 0 0); rewrite /v /y mul_row_col mulmxDl -!scalemxAl -!scalemxAr.
  by rewrite /transfer /z !map_mxM !mulmxA.
- rewrite /M /y /u mul_block_col mul0mx addr0 dM scale_col_mx scaler0; congr col_mx.
    by rewrite -scalemxAr /z mulmxA mul_mx_adj mul_scalar_mx scalerA mulrC.
  by rewrite -scalemxAr mulNmx !mulmxA mul_mx_adj mul_scalar_mx -!scalemxAl scalerN addNr.
by rewrite dM mulf_neq0 // monic_neq0 // char_poly_monic.
Qed.

(* r = sum n_i c_i - chi_A s with deg n_i <= t, deg s < t *)
Definition below t (r : {poly K}) := exists (N : 'rV[{poly K}]_q) (s : {poly K}),
  [/\ r = (N *m transfer A b C) 0 0 - char_poly A * s,
      forall i, (size (N 0%R i) <= t.+1)%N & (size s <= t)%N].

Lemma below_w t t' r : (t <= t')%N -> below t r -> below t' r.
Proof.
move=> tt [N [s [e sN ss]]]; exists N, s; split=> // [i|]; last exact: leq_trans tt.
by apply: leq_trans (sN i) _.
Qed.

Lemma belowD t r r' : below t r -> below t r' -> below t (r + r').
Proof.
move=> [N [s [-> sN ss]]] [N' [s' [-> sN' ss']]]; exists (N + N'), (s + s'); split.
- by rewrite mulmxDl [in RHS]mxE mulrDr opprD addrACA.
- by move=> i; rewrite mxE (leq_trans (size_add _ _)) // geq_max sN sN'.
by rewrite (leq_trans (size_add _ _)) // geq_max ss.
Qed.

Lemma below0 t : below t 0.
Proof.
exists 0, 0; split=> [||]; rewrite ?mul0mx ?mxE ?mulr0 ?subr0 ?size_poly0 // => i.
by rewrite mxE size_poly0.
Qed.

Lemma below_krylov t (w : 'rV_q) : below t (transfer A b (w *m (krylov A^T C^T t)^T) 0 0).
Proof.
elim: t => [|t [N [s [e sN ss]]]].
  exists (map_mx polyC w), 0; rewrite mulr0 subr0 size_poly0 /krylov /= trmxK transfer_mull.
  by split=> // i; rewrite mxE size_polyC_leq1.
set v := w *m _ in e; have -> : w *m (krylov A^T C^T t.+1)^T = v *m A.
  by rewrite krylovS trmx_mul trmxK mulmxA.
exists ('X *: N), ('X * s + ((v *m b) 0 0)%:P); split.
- have at00 (x y : {poly K}) (X Y : 'M_1) : (x *: X - y *: Y) 0 0 = x * X 0 0 - y * Y 0 0.
    by rewrite !mxE.
  rewrite transfer_shift at00 e [map_mx _ _ _ _]mxE -scalemxAl [in RHS]mxE.
  by rewrite mulrBr mulrDr opprD addrA mulrCA.
- move=> i; rewrite mxE; apply: leq_trans (size_mul_leq _ _) _; rewrite size_polyX.
  by rewrite addSn /= ltnS sN.
apply: leq_trans (size_add _ _) _; rewrite geq_max; apply/andP; split; last first.
  exact: leq_trans (size_polyC_leq1 _) _.
by apply: leq_trans (size_mul_leq _ _) _; rewrite size_polyX.
Qed.

Hypothesis ctr : controllable A b.
Hypothesis obs : \rank (reach A^T C^T k.+1) = n.

Lemma below_all (r : {poly K}) : (size r <= n)%N -> below k r.
Proof.
move=> sr; have [v <-] := transfer_onto ctr sr.
have /submxP[z ez] : (v <= (reach A^T C^T k.+1)^T)%MS.
  by rewrite submx_full // /row_full mxrank_tr obs.
have -> : v = \sum_(t < k.+1) (submxcol z^T t)^T *m (krylov A^T C^T t)^T.
  apply: trmx_inj; rewrite ez trmx_mul trmxK linear_sum /= -[z^T]submxcolK.
  rewrite /reach mul_mxrow_mxcol; apply: eq_bigr => t _.
  by rewrite trmx_mul !trmxK mxcolK.
elim/big_rec: _ => [|t v' _ IH].
  by rewrite /transfer map_mx0 !mul0mx mxE; apply: below0.
rewrite transferDl mxE; apply: belowD => //; apply: (@below_w t); first by rewrite -ltnS.
exact: below_krylov.
Qed.


End OneInput.

Section Realization.
Variable K : fieldType.

(* d has a companion matrix that one output row observes *)
Lemma companion_observed k (d : {poly K}) : d \is monic -> size d = k.+1 ->
  exists (Ac : 'M_k) (Cc : 'rV_k), char_poly Ac = d /\ controllable Ac^T Cc^T.
Proof.
move=> md sd; have e : (size d).-1 = k by rewrite sd.
case: k / e {sd}; exists (companionmx d), (\row_j (j == 0%N :> nat)%:R).
split; first exact: companionmxK.
set Cc := \row_j _; have rows t (lt : (t < (size d).-1)%N) :
    krylov (companionmx d)^T Cc^T t = (delta_mx 0 (Ordinal lt))^T.
  elim: t lt => [|t IH] lt.
    by rewrite /krylov /=; congr _^T; apply/rowP => j; rewrite !mxE.
  have lt' := ltnW lt; rewrite krylovS (IH lt') -trmx_mul.
  by rewrite (@mulmx_delta_companion _ _ (Ordinal lt') lt).
apply/rank_reachP => w wz; apply/rowP => j; have := wz j (ltn_ord j).
rewrite (rows _ (ltn_ord j)) trmx_delta -colE => /matrixP/(_ 0 0); rewrite !mxE => e.
by rewrite -[RHS]e; congr (w _ _); apply: val_inj.
Qed.

(* every strictly proper row over d is Cc adj(xI - Ac) Bc *)
Lemma realization k q (d : {poly K}) (N : 'I_q -> {poly K}) : d \is monic -> size d = k.+1 ->
  (forall i, (size (N i) <= k)%N) ->
  exists (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'rV_k),
    char_poly Ac = d /\ transfer Ac Bc Cc = \row_i N i.
Proof.
move=> md sd sN; have [Ac [Cc [eA obs]]] := companion_observed md sd.
have /fin_all_exists[g hg] i : exists w : 'rV_k, transfer Ac^T Cc^T w 0 0 = N i.
  exact: transfer_onto.
exists Ac, (\matrix_(j, i) g i 0 j), Cc; split=> //; apply/rowP => i.
rewrite [RHS]mxE -hg; set B := \matrix_(j, i) _.
have -> : g i = (B *m delta_mx i 0)^T by rewrite -colE; apply/rowP => j; rewrite !mxE.
by rewrite -transfer_tr transfer_mulr map_delta_mx -colE [RHS]mxE [RHS]mxE.
Qed.

Lemma size_quotient (n k : nat) (a p : {poly K}) : a \is monic -> p \is monic ->
  size a = n.+1 -> size p = (n + k).+1 -> (p %/ a \is monic) /\ size (p %/ a) = k.+1.
Proof.
move=> ma mp sa sp; have sq : size (p %/ a) = k.+1.
  by rewrite size_divp ?monic_neq0 // sa sp /= subSn ?leq_addr // addKn.
split=> //; have lc := divp_eq p a; apply/eqP.
have : lead_coef p = lead_coef (p %/ a * a).
  rewrite {1}lc lead_coefDl // size_proper_mul; last first.
    by rewrite (monicP ma) mulr1 lead_coef_eq0 -size_poly_eq0 sq.
  rewrite sq sa addSn addnS /=; apply: leq_trans (ltn_modpN0 _ _) _; first exact: monic_neq0.
  by rewrite sa ltnS leq_addl.
by rewrite lead_coefM (monicP ma) mulr1 (monicP mp) => ->.
Qed.

(* Brasch and Pearson, one input, over every field *)
Theorem brasch_pearson_one_input n q k (A : 'M[K]_n) (b : 'cV_n) (C : 'M_(q, n)) (p : {poly K}) :
  controllable A b -> \rank (reach A^T C^T k.+1) = n -> p \is monic -> size p = (n + k).+1 ->
  exists (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'rV_k) (D : 'rV_q),
    char_poly (compensated A b C Ac Bc Cc D) = p.
Proof.
move=> ctr obs mp sp; set a := char_poly A.
have [mq sq] := size_quotient (char_poly_monic A) mp (size_char_poly A) sp.
have sr : (size (- (p %% a)) <= n)%N.
  by rewrite size_opp -ltnS -(size_char_poly A) ltn_modpN0 // monic_neq0 // char_poly_monic.
have [N [s [er sN ss]]] := below_all ctr obs sr.
pose d := p %/ a + s; have sd : size d = k.+1 by rewrite size_addl sq ?ltnS.
have md : d \is monic by rewrite monicE lead_coefDl ?sq ?ltnS.
pose D : 'rV_q := \row_i (N 0 i)`_k.
have [i|Ac [Bc [Cc [eA eT]]]] := @realization k q d (fun i => N 0 i - (N 0 i)`_k *: d) md sd.
  apply/leq_sizeP => j kj; rewrite coefB coefZ.
  have [->|jk] := eqVneq j k; last first.
    have lt : (k < j)%N by rewrite ltn_neqAle eq_sym jk.
    rewrite [d`_j]nth_default ?sd // mulr0 subr0 nth_default //.
    exact: leq_trans (sN i) lt.
  by have := monicP md; rewrite lead_coefE sd /= => ->; rewrite mulr1 subrr.
exists Ac, Bc, Cc, D; rewrite char_poly_compensated eA eT.
have -> : d *: map_mx polyC D + \row_i (N 0 i - (N 0 i)`_k *: d) = N.
  by apply/rowP => i; rewrite !mxE mulrC mul_polyC addrC subrK.
have -> : (N *m transfer A b C) 0 0 = a * s - p %% a by rewrite addrC er subrK.
by rewrite mulrDr opprB -addrA (addrCA (a * s)) subrr addr0 mulrC -divp_eq.
Qed.

End Realization.

Section Feedback.
Variables (K : fieldType) (n p q : nat).
Implicit Types (A : 'M[K]_n) (B : 'M[K]_(n, p)) (C : 'M[K]_(q, n)).

(* output injection keeps the observability stack's rank *)
Lemma index_feedback A B C F k : \rank (reach A^T C^T k) = n ->
  \rank (reach (A + B *m F *m C)^T C^T k) = n.
Proof.
move=> /eqP/rank_reachP h; apply/eqP/rank_reachP => w wz; apply: h => t.
set A' := A + B *m F *m C in wz.
have same s : (s <= k)%N -> (forall t, (t < s)%N -> C *m krylov A' w^T t = 0) ->
    krylov A' w^T s = krylov A w^T s.
  elim: s => [//|s IH] sk z; rewrite !krylovS -IH ?(ltnW sk) // => [|t' ts].
    by rewrite {1}/A' mulmxDl -!mulmxA z // !mulmx0 addr0.
  exact/z/ltnW.
have z t' : (t' < k)%N -> C *m krylov A' w^T t' = 0.
  by move=> tk; have /(congr1 trmx) := wz t' tk; rewrite trmx0 krylov_tr !trmxK.
move=> tk; have := z t tk; rewrite same ?(ltnW tk) // => [|t' tt].
  by move/(congr1 trmx); rewrite trmx0 krylov_tr trmxK.
exact/z/(ltn_trans tt).
Qed.

End Feedback.

Section OneInputEnough.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Hypothesis inf : infinite K.
Variables (n p q : nat).
Implicit Types (A : 'M[K]_n) (B : 'M[K]_(n, p)) (C : 'M[K]_(q, n)).

Lemma krylov_col A B j t : col j (krylov A B t) = krylov A (col j B) t.
Proof. by elim: t => [//|t IH]; rewrite !krylovS -IH !colE mulmxA. Qed.

Lemma krylov0 r A t : krylov A (0 : 'M_(n, r)) t = 0.
Proof. by elim: t => [//|t IH]; rewrite krylovS IH mulmx0. Qed.

(* no mode of a plant all of whose channels see the whole output is fixed *)
Lemma common_output_not_fixed A C (b : 'I_p -> 'cV[K]_n) lambda :
  let S := @Multichannel K n p (fun=> 1%N) (fun=> q) A b (fun=> C) in
  jointly_controllable S -> controllable A^T C^T -> ~ fixed_over f S lambda.
Proof.
move=> S jc obs; rewrite anderson_clements_over => -[s]; rewrite ltnNge => /negP; apply.
have [->|[i si]] := set_0Vmem s; first by rewrite jointly_controllable_pencil.
have := observable_hautus f lambda obs => {1}<-.
apply: (@leq_trans (\rank (col_mx (lambda%:M - map_mx f A) (outputs (map_system f S) s)))).
  apply: mxrankS; rewrite col_mx_sub; apply/andP; split.
    by apply: submx_trans (addsmxSl _ _) _; rewrite addsmxE.
  apply: (@submx_trans _ _ _ _ _ _ (outputs (map_system f S) s)).
    by rewrite eqmx_outputs; apply: (sumsmx_sup i); rewrite // genmxE.
  by apply: submx_trans (addsmxSr _ _) _; rewrite addsmxE.
rewrite /pencil block_mxEh; set Y := col_mx _ _; set Z := col_mx _ _.
have {1}-> : Y = row_mx Y Z *m col_mx 1%:M 0 by rewrite mul_row_col mulmx1 mulmx0 addr0.
exact: mxrankM_maxl.
Qed.

(* static output feedback and one combination of the inputs keep a complete plant controllable *)
Theorem one_input_enough A B C : controllable A B -> controllable A^T C^T ->
  exists (F : 'M_(p, q)) (g : 'cV_p), controllable (A + B *m F *m C) (B *m g).
Proof.
move=> ctr obs; have [n0|n0] := posnP n.
  exists 0, 0; apply/controllableP => w _; apply/rowP => j.
  by have := ltn_ord j; rewrite {2}n0.
have [j0 bj0] : exists j0, col j0 B != 0.
  apply/existsP; rewrite -negb_forall; apply: contraL ctr => /forallP cols.
  have B0 : B = 0.
    by apply/matrixP => i j; have /eqP/matrixP/(_ i 0) := cols j; rewrite !mxE.
  apply/controllableP => /(_ (const_mx 1)) h.
  have /matrixP/(_ 0 (Ordinal n0)) : const_mx 1 = 0 :> 'rV[K]_n.
    by apply: h => t; rewrite B0 krylov0 mulmx0.
  by rewrite !mxE => /eqP; rewrite oner_eq0.
pose e j : 'cV[K]_p := delta_mx (if col j B == 0 then j0 else j) 0.
have be j : B *m e j = if col j B == 0 then col j0 B else col j B.
  by rewrite /e -colE; case: ifP.
pose S := @Multichannel K n p (fun=> 1%N) (fun=> q) A (fun j => B *m e j) (fun=> C).
have nz j : B *m e j != 0 by rewrite be; case: ifPn.
have sc : strongly_connected (transfer_arc S).
  move=> i j; apply: connect1; apply: contraT => na; case/negP: (nz i).
  apply/eqP; move/observableP: obs; apply=> t; apply/eqP; apply: contraNT na => h.
  by apply/transfer_arcP; exists t.
have jc : jointly_controllable S.
  apply/controllableP => w /annihilates_inputs h; move/controllableP: ctr; apply=> t.
  apply/rowP => j; rewrite [RHS]mxE; have := h j t; rewrite /= be.
  suff e0 : w *m krylov A (col j B) t = 0 -> (w *m krylov A B t) 0 j = 0.
    by case: eqP => [cj _|_]; [apply: e0; rewrite cj krylov0 mulmx0 | apply: e0].
  rewrite -krylov_col colE mulmxA -colE => /matrixP/(_ 0 0); by rewrite !mxE.
have [F hF] := corfmat_morse inf sc (fun lambda => @common_output_not_fixed _ _ _ lambda jc obs).
exists (\sum_j e j *m F j), (e j0); have [+ _] := hF j0.
rewrite /closed_loop /= mulmx_sumr mulmx_suml; congr (is_true (controllable (_ + _) _)).
by apply: eq_bigr => j _; rewrite !mulmxA.
Qed.

(* Brasch and Pearson, by the observability index *)
Theorem brasch_pearson k A B C (P : {poly K}) :
  controllable A B -> \rank (reach A^T C^T k.+1) = n -> P \is monic -> size P = (n + k).+1 ->
  exists (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'M_(p, k)) (D : 'M_(p, q)),
    char_poly (compensated A B C Ac Bc Cc D) = P.
Proof.
move=> ctr obs mP sP; have [F [g cg]] := one_input_enough ctr (controllable_blocks obs).
have [Ac [Bc [Cc [D e]]]] := brasch_pearson_one_input cg (index_feedback B F obs) mP sP.
exists Ac, Bc, (g *m Cc), (F + g *m D); rewrite -e /compensated; congr char_poly.
by rewrite mulmxDr mulmxDl addrA !mulmxA.
Qed.

End OneInputEnough.

Section Dual.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Hypothesis inf : infinite K.
Variables (n p q : nat).
Implicit Types (A : 'M[K]_n) (B : 'M[K]_(n, p)) (C : 'M[K]_(q, n)).

Lemma char_poly_tr r (M : 'M[K]_r) : char_poly M^T = char_poly M.
Proof.
by rewrite /char_poly -[RHS]det_tr /char_poly_mx linearB /= tr_scalar_mx map_trmx.
Qed.

(* by the controllability index *)
Theorem brasch_pearson_dual k A B C (P : {poly K}) :
  \rank (reach A B k.+1) = n -> controllable A^T C^T -> P \is monic -> size P = (n + k).+1 ->
  exists (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'M_(p, k)) (D : 'M_(p, q)),
    char_poly (compensated A B C Ac Bc Cc D) = P.
Proof.
move=> ctr obs mP sP; have ctr' : \rank (reach A^T^T B^T^T k.+1) = n by rewrite !trmxK.
have [Ac [Bc [Cc [D <-]]]] := brasch_pearson f inf obs ctr' mP sP.
exists Ac^T, Cc^T, Bc^T, D^T; rewrite -[RHS]char_poly_tr /compensated tr_block_mx; congr char_poly.
by rewrite linearD /= !trmx_mul !trmxK !mulmxA.
Qed.

(* by whichever of the two is smaller *)
Theorem brasch_pearson_minimum k A B C (P : {poly K}) :
  controllable A B -> controllable A^T C^T ->
  \rank (reach A B k.+1) = n \/ \rank (reach A^T C^T k.+1) = n ->
  P \is monic -> size P = (n + k).+1 ->
  exists (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'M_(p, k)) (D : 'M_(p, q)),
    char_poly (compensated A B C Ac Bc Cc D) = P.
Proof.
move=> ctr obs [idx|idx] mP sP; first exact: (brasch_pearson_dual idx obs mP sP).
exact: (brasch_pearson f inf ctr idx mP sP).
Qed.

End Dual.
