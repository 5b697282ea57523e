(* checker/core/arithmetic.py, rank: elimination without fractions (A6 of arithmetic.md).

   With pivots in the rows and columns of W, the entry in row r and column c is the minor of W bordered by
   r and c.  A step yields the minors bordered once more, so that every division is exact; where all
   are 0, the rank is the number of pivots. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Definition bordered (R : comRingType) k (W : 'M[R]_k) (r : 'rV_k) (c : 'cV_k) (m : R) : R :=
  \det (block_mx W c r m%:M).

Section Field.
Variable K : fieldType.

Lemma det_schur k n (W : 'M[K]_k) (C : 'M_(k, n)) (R : 'M_(n, k)) (M : 'M_n) : W \in unitmx ->
  \det (block_mx W C R M) = \det W * \det (M - R *m invmx W *m C).
Proof.
move=> uW; have -> : block_mx W C R M = block_mx 1%:M 0 (R *m invmx W) 1%:M *m block_mx W C 0 (M - R *m invmx W *m C).
  by rewrite mulmx_block !mul1mx !mul0mx !addr0 mulmxKV// addrC subrK.
by rewrite det_mulmx det_lblock !det1 !mul1r det_ublock.
Qed.

(* What the pivots leave of the entry m. *)
Definition left_over k (W : 'M[K]_k) (r : 'rV_k) (c : 'cV_k) (m : K) : K := m - (r *m invmx W *m c) 0 0.

Lemma bordered_left k (W : 'M[K]_k) r c m : W \in unitmx -> bordered W r c m = \det W * left_over W r c m.
Proof.
by move=> uW; rewrite /bordered det_schur// det_mx11 mxE [X in X + _]mxE [X in _ + X]mxE eqxx mulr1n.
Qed.

Let step_algebra (d p s11 s12 s21 s22 : K) : p / s11 = d ->
  d * (p * (s22 - s21 * (s12 / s11))) = p * (d * s22) - d * s21 * (d * s12).
Proof.
move=> e; rewrite !mulrBr; congr (_ - _); first by rewrite mulrCA.
by rewrite [p * _]mulrCA [p * _]mulrCA e -!mulrA [s12 * d]mulrC.
Qed.

(* One step, with the pivot in row r and column c. *)
Theorem bareiss_step k (W : 'M[K]_k) r c m r' c' m12 m21 m22 : W \in unitmx -> bordered W r c m != 0 ->
  \det W * bordered (block_mx W c r m%:M) (row_mx r' m21%:M) (col_mx c' m12%:M) m22 =
  bordered W r c m * bordered W r' c' m22 - bordered W r' c m21 * bordered W r c' m12.
Proof.
move=> uW; set p := bordered W r c m => np; have ep : p = \det W * left_over W r c m by apply: bordered_left.
have ns : left_over W r c m != 0 by apply: contraNneq np => e; rewrite ep e mulr0.
have uW' : block_mx W c r m%:M \in unitmx by rewrite unitmxE unitfE.
pose y := left_over W r c' m12 / left_over W r c m.
pose x := invmx W *m c' - y *: (invmx W *m c).
have solved : r *m x + m%:M *m y%:M = m12%:M.
  rewrite /x mulmxBr -scalemxAr !mulmxA [r *m _ *m c']mx11_scalar [r *m _ *m c]mx11_scalar.
  rewrite -mul_scalar_mx -!scalar_mxM -raddfB -raddfD /= [m * y]mulrC -addrA -mulrN -mulrDr [- _ + m]addrC.
  by rewrite -[m - _]/(left_over W r c m) divfK// addrC subrK.
have sol : block_mx W c r m%:M *m col_mx x y%:M = col_mx c' m12%:M.
  by rewrite mul_block_col solved /x mulmxBr -scalemxAr !mulKVmx// mul_mx_scalar subrK.
have -> : bordered (block_mx W c r m%:M) (row_mx r' m21%:M) (col_mx c' m12%:M) m22 =
    p * (left_over W r' c' m22 - left_over W r' c m21 * y).
  have inv : invmx (block_mx W c r m%:M) *m col_mx c' m12%:M = col_mx x y%:M by rewrite -sol mulKmx.
  rewrite bordered_left//; congr (_ * _); rewrite /left_over -mulmxA inv mul_row_col /x mulmxBr -scalemxAr !mulmxA -scalar_mxM.
  move: (r' *m _ *m c') (r' *m _ *m c) => a b; rewrite !mxE eqxx mulr1n.
  by rewrite mulrBl !opprD !opprK !addrA [y * _]mulrC addrAC.
have pD : p / left_over W r c m = \det W by rewrite ep mulfK.
rewrite [bordered W r' c' m22]bordered_left// [bordered W r' c m21]bordered_left// [bordered W r c' m12]bordered_left//.
exact: step_algebra.
Qed.

(* The end: where every bordered minor is 0, the rank is the number of pivots. *)
Theorem bareiss_rank k a b (W : 'M[K]_k) (C : 'M_(k, b)) (R : 'M_(a, k)) (M : 'M_(a, b)) : W \in unitmx ->
  (forall i j, bordered W (row i R) (col j C) (M i j) = 0) -> \rank (block_mx W C R M) = k.
Proof.
move=> uW z; have nW : \det W != 0 by rewrite -unitfE -unitmxE.
have eM : M = R *m invmx W *m C.
  apply/matrixP=> i j; have := z i j; rewrite bordered_left// => /eqP.
  rewrite mulf_eq0 (negPf nW) /= subr_eq0 => /eqP ->.
  by rewrite -row_mul colE mulmxA -row_mul -colE !mxE.
apply/eqP; rewrite eqn_leq; apply/andP; split.
  have -> : block_mx W C R M = col_mx 1%:M (R *m invmx W) *m row_mx W C.
    by rewrite mul_col_row !mul1mx mulmxKV// -eM.
  by rewrite (leq_trans (mxrankM_maxl _ _)) ?rank_leq_col.
rewrite block_mxEv -addsmxE; apply: leq_trans (mxrankS (addsmxSl _ _)).
have {1}<- : \rank W = k by apply/eqP; rewrite -[_ == _]/(row_free W) row_free_unit.
have {1}-> : W = row_mx W C *m col_mx 1%:M 0 by rewrite mul_row_col mulmx1 mulmx0 addr0.
exact: mxrankM_maxl.
Qed.
End Field.

(* Over the integers: every division leaves no remainder. *)
Theorem bareiss_exact k (W : 'M[int]_k) r c m r' c' m12 m21 m22 : \det W != 0 -> bordered W r c m != 0 ->
  bordered W r c m * bordered W r' c' m22 - bordered W r' c m21 * bordered W r c' m12 =
  bordered (block_mx W c r m%:M) (row_mx r' m21%:M) (col_mx c' m12%:M) m22 * \det W.
Proof.
have up n (X : 'M[int]_n) r0 c0 m0 : (bordered X r0 c0 m0)%:~R =
    bordered (map_mx (intr : int -> rat) X) (map_mx intr r0) (map_mx intr c0) m0%:~R.
  by rewrite /bordered -det_map_mx map_block_mx map_scalar_mx.
move=> nW np; apply: (@intr_inj [numDomainType of rat]).
have dW : (\det W)%:~R = \det (map_mx (intr : int -> rat) W) by rewrite det_map_mx.
rewrite rmorphB !rmorphM /= !up map_block_mx map_row_mx map_col_mx !map_scalar_mx dW [RHS]mulrC.
by rewrite bareiss_step ?unitmxE -?dW ?unitfE ?intr_eq0 -?up ?intr_eq0.
Qed.
