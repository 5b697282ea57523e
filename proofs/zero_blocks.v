(* checker/parameters.py: zero blocks of a system with a parameter.

   The statements are about one value of the parameter and one mode lambda, over the field of both, and about
   polynomials over an integral domain. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Field.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel L n p q).
Variables (T : {set 'I_m}) (lambda : L) (a u : nat) (W : 'M[L]_(a, n)) (U : 'M[L]_(n, u)).
Hypothesis unmoved : forall i, i \in T -> W *m mcB S i = 0.
Hypothesis unseen : forall i, i \notin T -> mcC S i *m U = 0.
Hypothesis zero : W *m (lambda%:M - mcA S) *m U = 0.

Lemma zero_closed (F : gains L p q) : W *m (lambda%:M - closed_loop S F) *m U = 0.
Proof.
rewrite /closed_loop opprD addrA mulmxDr mulmxDl zero add0r mulmxN mulNmx.
rewrite mulmx_sumr mulmx_suml big1 ?oppr0// => i _.
have [iT|iT] := boolP (i \in T); first by rewrite !mulmxA (unmoved iT) !mul0mx.
by rewrite -!mulmxA (unseen iT) !mulmx0.
Qed.

(* A block of zeros that is too large leaves a matrix singular. *)
Lemma zero_block_singular (M : 'M[L]_n) :
  W *m M *m U = 0 -> (n < \rank W + \rank U)%N -> (\rank M < n)%N.
Proof.
move=> z big; rewrite ltn_neqAle rank_leq_row andbT; apply/negP => full.
have WM : \rank (W *m M) = \rank W by rewrite mxrankMfree.
by have := mulmx0_rank_max z; rewrite WM leqNgt big.
Qed.

Theorem zero_block_rank (F : gains L p q) :
  (n < \rank W + \rank U)%N -> (\rank (lambda%:M - closed_loop S F)%R < n)%N.
Proof. by move=> big; apply: zero_block_singular big; apply: zero_closed. Qed.

(* The pivots that the checker looks at: the rows of W and the columns of U are independent. *)
Theorem zero_block_pivots (row_pivots : 'I_u -> 'I_n) (column_pivots : 'I_a -> 'I_n) :
  rowsub row_pivots U = 1%:M -> colsub column_pivots W = 1%:M ->
  (n < a + u)%N -> (n < \rank W + \rank U)%N.
Proof.
move=> eU eW; suff [-> ->] : \rank W = a /\ \rank U = u by [].
split; apply/eqP; rewrite eqn_leq ?rank_leq_row ?rank_leq_col /=; last first.
  by rewrite -[X in (X <= _)%N](mxrank1 L u) -eU; apply/mxrankS/rowsub_sub.
rewrite -[X in (_ <= X)%N]mxrank_tr -[X in (X <= _)%N](mxrank1 L a).
have -> : 1%:M = rowsub column_pivots W^T.
  by rewrite -trmx1 -eW; apply/matrixP => i j; rewrite !mxE.
by apply/mxrankS/rowsub_sub.
Qed.

Theorem zero_block_fixed : (n < \rank W + \rank U)%N -> fixed S lambda.
Proof.
move=> big F; rewrite /eigenvalue /eigenspace -mxrank_eq0 mxrank_ker subn_eq0 -ltnNge -opprB.
by rewrite mxrank_opp zero_block_rank.
Qed.

(* The pencil of the other channels loses rank. *)
Theorem zero_block_pencil :
  (n < \rank W + \rank U)%N -> (\rank (pencil S (~: T) lambda) < n)%N.
Proof.
move=> big; set P := pencil S (~: T) lambda.
pose Z := block_mx U 0 0 1%:M : 'M[L]_(n + \sum_i p i, u + \sum_i p i).
have PZ : P *m Z = col_mx (row_mx ((lambda%:M - mcA S) *m U) (inputs S T)) 0.
  rewrite /P /Z /pencil setCK mulmx_block !mulmx0 !mulmx1 !addr0 !add0r block_mxEv.
  have -> : outputs S (~: T) *m U = 0.
    rewrite mxcol_mul -[RHS](@mxcol0 _ _ q); apply: eq_mxcol => i; rewrite inE.
    by have [iT|iT] := boolP (i \in T); rewrite ?mul0mx ?unseen.
  by rewrite row_mx0.
have WT : W *m inputs S T = 0.
  rewrite mul_mxrow -[RHS](@mxrow0 _ _ p); apply/eq_mxrow => i.
  by case: ifP => iT; rewrite ?mulmx0 ?unmoved.
have rZ : \rank Z = (\rank U + \sum_i p i)%N by rewrite rank_diag_block_mx mxrank1.
have rPZ : (\rank W + \rank (P *m Z) <= n)%N.
  rewrite PZ rank_col_mx0; apply: mulmx0_rank_max.
  by rewrite mul_mx_row mulmxA zero WT row_mx0.
have := mxrank_mul_min P Z; rewrite rZ leq_subLR => h.
have : (\rank P + \rank U <= n + \rank (P *m Z))%N.
  by move: h; rewrite addnA [(n + _ + _)%N]addnAC leq_add2r.
move=> h'; rewrite -(ltn_add2r (\rank U)) (leq_ltn_trans h')// ltn_add2l.
by rewrite -(ltn_add2l (\rank W)) (leq_ltn_trans rPZ).
Qed.
End Field.

(* Polynomials in t and x: p divides det(xI - A_F) where c and c' are polynomials in t alone, and D is
   Q[t][x]/(p) for an irreducible p that is monic in x. *)
Section Domain.
Variables (D : idomainType) (n a u : nat) (M : 'M[D]_n) (W : 'M[D]_(a, n)) (U : 'M[D]_(n, u)).
Variables (row_pivots : 'I_u -> 'I_n) (column_pivots : 'I_a -> 'I_n) (c c' : D).

Theorem zero_block_det :
  W *m M *m U = 0 -> rowsub row_pivots U = c%:M -> colsub column_pivots W = c'%:M ->
  c != 0 -> c' != 0 -> (n < a + u)%N -> \det M = 0.
Proof.
move=> z eU eW c0 c'0 big; pose f := [rmorphism of @FracField.tofrac D].
have rU : \rank (map_mx f U) = u.
  apply/eqP; rewrite eqn_leq rank_leq_col /=.
  have e : rowsub row_pivots (map_mx f U) = f c *: 1%:M.
    by rewrite -map_mxsub eU map_scalar_mx scalemx1.
  have r : \rank (rowsub row_pivots (map_mx f U)) = u.
    by rewrite e mxrank_scale_nz ?mxrank1// tofrac_eq0.
  by rewrite -[X in (X <= _)%N]r; apply/mxrankS/rowsub_sub.
have rW : \rank (map_mx f W) = a.
  apply/eqP; rewrite eqn_leq rank_leq_row /= -[X in (_ <= X)%N]mxrank_tr.
  have e : rowsub column_pivots (map_mx f W)^T = f c' *: 1%:M.
    rewrite scalemx1 -tr_scalar_mx -map_scalar_mx -eW map_mxsub.
    by apply/matrixP=> i j; rewrite !mxE.
  have r : \rank (rowsub column_pivots (map_mx f W)^T) = a.
    by rewrite e mxrank_scale_nz ?mxrank1// tofrac_eq0.
  by rewrite -[X in (X <= _)%N]r; apply/mxrankS/rowsub_sub.
have zf : map_mx f W *m map_mx f M *m map_mx f U = 0 by rewrite -!map_mxM z map_mx0.
have : (\rank (map_mx f M) < n)%N by apply: (zero_block_singular zf); rewrite rW rU.
move=> small; apply/eqP; rewrite -tofrac_eq0 -[FracField.tofrac _]/(f _) -det_map_mx.
by apply: contraTT small; rewrite -unitfE -unitmxE -row_full_unit -leqNgt => /eqP ->.
Qed.
End Domain.
