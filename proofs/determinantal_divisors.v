(* The greatest common divisors of the minors of a polynomial matrix, from a diagonal matrix that is
   equivalent to it; used by complementary_subsystem.v.

   M and N are called equivalent when each is U N' V of the other, N', for some polynomial matrices U, V
   of any shape: then they have the same common divisors of minors at every order, whatever their
   shapes.  A minor is the determinant of rows f and columns g, f and g any maps. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Factoring.
Variable R : comRingType.

Definition factors a b c d (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) := exists U V, M = U *m N *m V.
Definition equivalent a b c d (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) := factors M N /\ factors N M.
Definition dsum a b c d (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) : 'M_(a + c, b + d) :=
  block_mx M 0 0 N.

Lemma factors_refl a b (M : 'M[R]_(a, b)) : factors M M.
Proof. by exists 1%:M, 1%:M; rewrite mul1mx mulmx1. Qed.
Lemma factors_trans a b c d e f (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) (Q : 'M[R]_(e, f)) :
  factors M N -> factors N Q -> factors M Q.
Proof. by case=> U [V ->] [U' [V' ->]]; exists (U *m U'), (V' *m V); rewrite !mulmxA. Qed.
Lemma factors_dsum a b c d a' b' c' d' (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d))
    (M' : 'M[R]_(a', b')) (N' : 'M[R]_(c', d')) :
  factors M N -> factors M' N' -> factors (dsum M M') (dsum N N').
Proof.
case=> U [V ->] [U' [V' ->]]; exists (dsum U U'), (dsum V V').
by rewrite /dsum !mulmx_block !(mulmx0, mul0mx, addr0, add0r).
Qed.
Lemma factors_mxsub a b c d (M : 'M[R]_(a, b)) (f : 'I_c -> 'I_a) (g : 'I_d -> 'I_b) :
  factors (mxsub f g M) M.
Proof.
by exists (rowsub f 1%:M), (colsub g 1%:M); rewrite mul_rowsub_mx mul1mx mulmx_colsub mulmx1 -mxsubcr.
Qed.

Lemma equivalent_refl a b (M : 'M[R]_(a, b)) : equivalent M M.
Proof. by split; apply: factors_refl. Qed.
Lemma equivalent_sym a b c d (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) :
  equivalent M N -> equivalent N M.
Proof. by case. Qed.
Lemma equivalent_trans a b c d e f (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) (Q : 'M[R]_(e, f)) :
  equivalent M N -> equivalent N Q -> equivalent M Q.
Proof. by case=> h1 h2 [h3 h4]; split; [apply: factors_trans h3|apply: factors_trans h2]. Qed.
Lemma equivalent_dsum a b c d a' b' c' d' (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d))
    (M' : 'M[R]_(a', b')) (N' : 'M[R]_(c', d')) :
  equivalent M N -> equivalent M' N' -> equivalent (dsum M M') (dsum N N').
Proof. by case=> h1 h2 [h3 h4]; split; apply: factors_dsum. Qed.

(* a block beside a matrix with a right inverse, or above one with a left inverse, can be cleared *)
Lemma right_inverse_equivalent a b (M : 'M[R]_(a, b)) V : M *m V = 1%:M -> equivalent M (1%:M : 'M_a).
Proof. by move=> e; split; [exists 1%:M, M|exists 1%:M, V]; rewrite ?mul1mx. Qed.
Lemma left_inverse_equivalent a b (M : 'M[R]_(a, b)) U : U *m M = 1%:M -> equivalent M (1%:M : 'M_b).
Proof. by move=> e; split; [exists M, 1%:M|exists U, 1%:M]; rewrite ?mulmx1 ?e. Qed.
Lemma clear_above a b c d (M : 'M[R]_(a, b)) G (N : 'M[R]_(c, d)) E : E *m N = 1%:M ->
  equivalent (block_mx M G 0 N) (dsum M N).
Proof.
move=> e; split; [exists (block_mx 1%:M (G *m E) 0 1%:M), 1%:M
                 |exists (block_mx 1%:M (- (G *m E)) 0 1%:M), 1%:M];
  rewrite mulmx1 mulmx_block !(mul0mx, mul1mx, mulmx0, mulmx1, addr0, add0r) ?mulNmx -mulmxA e mulmx1//.
by rewrite subrr.
Qed.

(* diagonal matrices *)
Definition diagonal (s : seq R) : 'M[R]_(size s) := diag_mx (\row_i s`_i).
Lemma diagonalE s i j : diagonal s i j = s`_i *+ (i == j).
Proof. by rewrite !mxE. Qed.

Lemma diagonal_perm s t : perm_eq s t -> equivalent (diagonal s) (diagonal t).
Proof.
suff le s' t' : perm_eq s' t' -> factors (diagonal s') (diagonal t').
  by move=> e; split; apply: le => //; rewrite perm_sym.
move/(perm_iotaP 0) => [Is pI es].
have lt (i : 'I_(size s')) : (nth 0%N Is i < size t')%N.
  have : nth 0%N Is i \in Is.
    by rewrite mem_nth// -(size_map (nth 0 t')) -es.
  by rewrite (perm_mem pI) mem_iota.
pose f i := Ordinal (lt i).
suff -> : diagonal s' = mxsub f f (diagonal t') by apply: factors_mxsub.
have sI : size s' = size Is by rewrite es size_map.
apply/matrixP=> i j; rewrite [RHS]mxE !diagonalE -[f i == _]val_eqE/= nth_uniq -?sI//; last first.
  by rewrite (perm_uniq pI) iota_uniq.
by rewrite {1}es (nth_map 0%N) -?sI.
Qed.

Lemma diagonal_cat s t : equivalent (dsum (diagonal s) (diagonal t)) (diagonal (s ++ t)).
Proof.
pose f := cast_ord (esym (size_cat s t)).
have e : dsum (diagonal s) (diagonal t) = mxsub f f (diagonal (s ++ t)).
  apply/matrixP=> i j; rewrite [RHS]mxE diagonalE (inj_eq (@cast_ord_inj _ _ _)) nth_cat /=.
  case: (split_ordP i) => i' ->; case: (split_ordP j) => j' ->; rewrite -val_eqE /=.
  - by rewrite block_mxEul diagonalE.
  - by rewrite block_mxEur mxE ltn_eqF ?mulr0n// ltn_addr.
  - by rewrite block_mxEdl mxE gtn_eqF ?mulr0n// ltn_addr.
  - by rewrite block_mxEdr diagonalE addKn eqn_add2l.
split; first by rewrite e; apply: factors_mxsub.
have -> : diagonal (s ++ t) = mxsub (cast_ord (size_cat s t)) (cast_ord (size_cat s t))
    (dsum (diagonal s) (diagonal t)).
  by apply/matrixP=> i j; rewrite e [RHS]mxE [RHS]mxE /f !cast_ordK.
exact: factors_mxsub.
Qed.

Lemma diagonal_ones k : equivalent (1%:M : 'M_k) (diagonal (nseq k 1)).
Proof.
pose f := cast_ord (esym (size_nseq k (1 : R))); pose g := cast_ord (size_nseq k (1 : R)).
have e : 1%:M = mxsub f f (diagonal (nseq k 1)).
  apply/matrixP=> i j; rewrite [RHS]mxE diagonalE (inj_eq (@cast_ord_inj _ _ _)) mxE.
  by rewrite nth_nseq /= ltn_ord.
split; first by rewrite e; apply: factors_mxsub.
have -> : diagonal (nseq k 1) = mxsub g g (1%:M : 'M_k).
  by apply/matrixP=> i j; rewrite e [RHS]mxE [RHS]mxE /f !cast_ordK.
exact: factors_mxsub.
Qed.

Lemma diagonal_one a : equivalent (a%:M : 'M_1) (diagonal [:: a]).
Proof.
have <- : diagonal [:: a] = a%:M by apply/matrixP=> i j; rewrite diagonalE !ord1 !mxE.
exact: equivalent_refl.
Qed.

(* The determinant of a product of rectangular matrices. *)
Lemma det_mul_rect r k (A : 'M[R]_(r, k)) (B : 'M_(k, r)) :
  \det (A *m B) = \sum_(f : {ffun 'I_r -> 'I_k}) (\prod_i A i (f i)) * \det (rowsub f B).
Proof.
rewrite /determinant; under [RHS]eq_bigr => f _ do rewrite mulr_sumr.
rewrite exchange_big; apply: eq_bigr => s _ /=.
under eq_bigr => i _ do rewrite mxE; rewrite bigA_distr_bigA mulr_sumr.
apply: eq_bigr => f _; rewrite mulrCA big_split /=; congr (_ * (_ * _)).
by apply: eq_bigr => i _; rewrite mxE.
Qed.

Definition minor a b (M : 'M[R]_(a, b)) r (f : 'I_r -> 'I_a) (g : 'I_r -> 'I_b) := \det (mxsub f g M).

Lemma minor_factor a b c d (M : 'M[R]_(a, b)) (N : 'M[R]_(c, d)) U V r f g : M = U *m N *m V ->
  @minor _ _ M r f g = \sum_(e : {ffun 'I_r -> 'I_c}) (\prod_i U (f i) (e i)) *
    \sum_(e' : {ffun 'I_r -> 'I_d}) (\prod_i V (e' i) (g i)) * minor N e e'.
Proof.
move=> ->; rewrite /minor mxsubcr -!mul_rowsub_mx -mulmx_colsub -mulmxA det_mul_rect.
apply: eq_bigr => e _; congr (_ * _); first by apply: eq_bigr => i _; rewrite mxE.
rewrite -mul_rowsub_mx -det_tr trmx_mul det_mul_rect; apply: eq_bigr => e' _; congr (_ * _).
  by apply: eq_bigr => i _; rewrite !mxE.
by rewrite -det_tr; congr (\det _); apply/matrixP=> i j; rewrite !mxE.
Qed.

Lemma minor_repeated a b (M : 'M[R]_(a, b)) r (f : 'I_r -> 'I_a) g : ~ injective f -> minor M f g = 0.
Proof.
move=> nf; have /injectivePn[i [j ij e]] : ~~ injectiveb f by apply/injectiveP.
by apply: (determinant_alternate ij) => t; rewrite !mxE e.
Qed.
Lemma minor_narrow a b k (U : 'M[R]_(a, k)) (V : 'M_(k, b)) r f g :
  (k < r)%N -> @minor _ _ (U *m V) r f g = 0.
Proof.
move=> kr; rewrite /minor mxsubcr -mul_rowsub_mx -mulmx_colsub det_mul_rect big1 // => e _.
have -> : \det (rowsub e (colsub g V)) = minor V e g.
  by apply: (congr1 (fun M : 'M_r => \det M)); apply/matrixP=> i j; rewrite !mxE.
rewrite minor_repeated ?mulr0 // => /leq_card; by rewrite !card_ord leqNgt kr.
Qed.
End Factoring.

Section Divisors.
Variable L : fieldType.
Notation P := {poly L}.

(* d divides every minor of order r; d = 0: every such minor is 0 *)
Definition divides_minors a b (M : 'M[P]_(a, b)) r (d : P) := forall f g, d %| @minor _ _ _ M r f g.

Lemma dvdp_sum (I : Type) (s : seq I) (Q : pred I) (F : I -> P) d :
  (forall i, Q i -> d %| F i) -> d %| \sum_(i <- s | Q i) F i.
Proof. by move=> h; elim/big_ind: _ => [|p q hp hq|//]; [exact: dvdp0|exact: dvdp_add]. Qed.

Lemma dvdp_prod2 (I : Type) (s : seq I) (Q : pred I) (F G : I -> P) :
  (forall i, Q i -> F i %| G i) -> \prod_(i <- s | Q i) F i %| \prod_(i <- s | Q i) G i.
Proof. by move=> h; elim/big_ind2: _ => [|p q p' q' h1 h2|//]; [exact: dvdpp|exact: dvdp_mul]. Qed.

Lemma divides_factors a b c d (M : 'M[P]_(a, b)) (N : 'M[P]_(c, d)) r e :
  factors M N -> divides_minors N r e -> divides_minors M r e.
Proof.
case=> U [V eM] h f g; rewrite (minor_factor _ _ eM).
by apply: dvdp_sum => i _; apply/dvdp_mull/dvdp_sum => j _; apply: dvdp_mull.
Qed.

Lemma divides_equivalent a b c d (M : 'M[P]_(a, b)) (N : 'M[P]_(c, d)) r e :
  equivalent M N -> divides_minors M r e <-> divides_minors N r e.
Proof. by case=> h1 h2; split; apply: divides_factors. Qed.

(* each polynomial divides the next *)
Definition chain (s : seq P) := forall i j, (i <= j < size s)%N -> s`_i %| s`_j.

Lemma chain_product s r (f : 'I_r -> nat) : chain s -> injective f -> (forall i, f i < size s)%N ->
  \prod_(i < r) s`_i %| \prod_i s`_(f i).
Proof.
move=> c; elim: r f => [|r IH] f inj lt; first by rewrite !big_ord0.
have [i0 i0r] : exists i0, (r <= f i0)%N.
  have [i0 h|no] := pickP (fun i : 'I_r.+1 => r <= f i)%N; first by exists i0.
  have lt' i : (f i < r)%N by rewrite ltnNge (no i).
  have : (#|'I_r.+1| <= #|'I_r|)%N.
    by apply: (@leq_card _ _ (fun i => Ordinal (lt' i))) => i j /(congr1 val)/inj.
  by rewrite !card_ord ltnn.
rewrite big_ord_recr /= mulrC (bigD1_ord i0)//=; apply: dvdp_mul.
  by apply: c; rewrite i0r lt.
by apply: IH => [i j /inj/lift_inj|i].
Qed.

Lemma diagonal_divides (s : seq P) r : chain s -> (r <= size s)%N ->
  divides_minors (diagonal s) r (\prod_(i < r) s`_i).
Proof.
move=> c rs f g; have [inj|ninj] := boolP (injectiveb f); last first.
  by rewrite minor_repeated ?dvdp0// => /injectiveP; apply/negP.
apply: dvdp_sum => t _; apply: dvdp_mull.
have := @chain_product s r (fun i => f i) c => /(_ _ _)/dvdp_trans; apply.
- by move=> i j /val_inj; apply/injectiveP.
- by move=> i.
by apply: dvdp_prod2 => i _; rewrite mxE diagonalE; case: eqP => _; rewrite ?dvdpp ?dvdp0.
Qed.

Lemma diagonal_attained (s : seq P) r (rs : (r <= size s)%N) :
  minor (diagonal s) (widen_ord rs) (widen_ord rs) = \prod_(i < r) s`_i.
Proof.
rewrite /minor (_ : mxsub _ _ _ = diag_mx (\row_i s`_i)); first by
  rewrite det_diag; apply: eq_bigr => i _; rewrite mxE.
by apply/matrixP=> i j; rewrite mxE diagonalE !mxE -val_eqE.
Qed.

(* Whatever is equivalent to the diagonal matrix of a chain s: the common divisors of its minors of order r
   are the divisors of the product of the first r, and there is no minor of higher order but 0. *)
Theorem determinantal_divisors a b (M : 'M[P]_(a, b)) s : equivalent M (diagonal s) -> chain s ->
  (forall r d, (r <= size s)%N -> divides_minors M r d <-> d %| \prod_(i < r) s`_i) /\
  (forall r f g, (size s < r)%N -> @minor _ _ _ M r f g = 0).
Proof.
move=> e c; split=> [r d rs|r f g sr].
  rewrite (divides_equivalent _ _ e); split=> [h|h f g].
    by rewrite -(diagonal_attained rs); apply: h.
  exact: dvdp_trans h (diagonal_divides c rs f g).
apply/eqP; rewrite -dvd0p; move: f g; apply/(divides_equivalent _ _ e) => f g.
rewrite minor_repeated ?dvdp0// => /leq_card; by rewrite !card_ord leqNgt sr.
Qed.

Lemma prod_take (s : seq P) r : (r <= size s)%N -> \prod_(i < r) s`_i = \prod_(g <- take r s) g.
Proof.
move=> rs; rewrite [RHS](big_nth 0) size_takel// big_mkord; apply: eq_bigr => i _.
by rewrite nth_take.
Qed.

(* ranks of matrices over a field and their minors *)
Lemma minor_rank a b (M : 'M[L]_(a, b)) r f g : @minor _ _ _ M r f g != 0 -> (r <= \rank M)%N.
Proof.
have -> : minor M f g = \det (rowsub f 1%:M *m M *m colsub g 1%:M).
  by rewrite mul_rowsub_mx mul1mx mulmx_colsub mulmx1 -mxsubcr.
rewrite -unitfE -unitmxE -row_full_unit => /eqP <-.
by rewrite (leq_trans (mxrankM_maxl _ _))// mxrankM_maxr.
Qed.

Lemma rank_select a b r (M : 'M[L]_(a, b)) : (r <= \rank M)%N -> exists R : 'M_(r, a), row_free (R *m M).
Proof.
move=> le; have /submxP[D eD] : (row_base M <= M)%MS by rewrite eq_row_base.
exists (pid_mx r *m D); rewrite -mulmxA -eD /row_free mxrankMfree ?row_base_free//.
by rewrite rank_pid_mx.
Qed.

Lemma rank_minor a b (M : 'M[L]_(a, b)) r : (r <= \rank M)%N -> ~ forall f g, @minor _ _ _ M r f g = 0.
Proof.
case/rank_select=> R fR z; have : minor (1%:M : 'M[L]_r) id id = 0.
  rewrite (minor_factor (V := pinvmx (R *m M)) id id (esym (mulmxVp fR))).
  by rewrite big1// => e _; rewrite [X in _ * X]big1 ?mulr0// => e' _; rewrite z mulr0.
by rewrite /minor mxsub_id det1 => /eqP; rewrite oner_eq0.
Qed.
End Divisors.
