(* checker/core/reach.py: kind `setpoint`.  S = [A, B; C, 0] (discrete time: A - I for A), B and C of all
   channels; q outputs. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic evidence controllability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* The rank of S from both sides. *)
Theorem setpoint_rank (l : modulus) (L : fieldType) (h : {rmorphism rat -> L}) a b r
    (S : 'M[Zloc l]_(a, b)) X Y (W : 'M[Zloc l]_(a - r, a)) (piv : 'I_(a - r) -> 'I_a) : (r <= a)%N ->
  X *m map_mx (@residue l) S *m Y = 1%:M :> 'M_r -> W *m S = 0 -> colsub piv W = 1%:M ->
  \rank (map_mx (into h) S) = r.
Proof.
move=> ra XY z pW; have lo := rank_from_below h XY; apply/eqP; rewrite eqn_leq lo andbT.
rewrite -[X in (_ <= X)%N](subKn ra); apply: (rank_from_above (W := map_mx (into h) W)).
  by rewrite -map_mxM z map_mx0.
by apply: (@pivots_free _ _ _ _ piv); rewrite -map_mxsub pW map_mx1.
Qed.

Section Field.
Variables (L : fieldType) (n b q : nat) (A : 'M[L]_n) (B : 'M[L]_(n, b)) (C : 'M[L]_(q, n)).

(* A row that annihilates S: the combination w2 r of set-points that no input can hold. *)
Theorem setpoint_unreachable (w1 : 'rV[L]_n) (w2 : 'rV[L]_q) (r : 'cV_q) x u :
  row_mx w1 w2 *m block_mx A B C 0 = 0 -> A *m x + B *m u = 0 -> C *m x = r -> w2 *m r = 0.
Proof.
rewrite mul_row_block mulmx0 addr0 -(row_mx0 _ 1 n b) => /eq_row_mx[e1 e2] e <-.
have /eqP := congr1 (mulmx^~ x) e1; rewrite /= mulmxDl mul0mx addr_eq0 => /eqP e3.
rewrite mulmxA; have /eqP := congr1 (mulmx w1) e; rewrite /= mulmxDr mulmx0 !mulmxA e2 mul0mx addr0 => /eqP e4.
by move: e3; rewrite e4 => /esym/eqP; rewrite oppr_eq0 => /eqP.
Qed.

(* For a controllable mode 0 such a row has a nonzero part on the outputs. *)
Theorem setpoint_output_part (w1 : 'rV[L]_n) (w2 : 'rV[L]_q) : ~~ uncontrollable_mode A B 0 ->
  row_mx w1 w2 *m block_mx A B C 0 = 0 -> row_mx w1 w2 != 0 -> w2 != 0.
Proof.
move=> c; rewrite mul_row_block mulmx0 addr0 -(row_mx0 _ 1 n b) => /eq_row_mx[e1 e2].
apply: contra => /eqP w20; rewrite w20 mul0mx addr0 in e1.
have [->|nw] := eqVneq w1 0; first by rewrite w20 row_mx0.
by case/negP: c; apply/uncontrollable_modeP; exists w1; rewrite scale0r.
Qed.
End Field.

(* Not an invariant zero: a polynomial row that annihilates the pencil makes it lose rank everywhere. *)
Theorem normal_rank_deficient (L : fieldType) a b (M : 'M[{poly L}]_(a, b)) (w : 'rV[{poly L}]_a) lambda :
  w != 0 -> w *m M = 0 -> (\rank (map_mx (horner_eval lambda) M) < a)%N.
Proof.
move=> nw z; rewrite ltn_neqAle rank_leq_row andbT; apply/negP => full.
pose N := map_mx (horner_eval lambda) M.
have fN : row_full N^T by rewrite /row_full mxrank_tr.
pose j := fullrankfun fN; pose Mj := colsub j M.
have uN : map_mx (horner_eval lambda) Mj \in unitmx.
  rewrite map_mxsub -/N -unitmx_tr; have := fullrowsub_unit fN.
  by congr (_ \in unitmx); apply/matrixP=> i k; rewrite !mxE.
have d0 : \det Mj != 0.
  by apply: contraTneq uN => d0; rewrite unitmxE det_map_mx d0 rmorph0 unitr0.
have zj : w *m Mj = 0 by rewrite mulmx_colsub z; apply/matrixP=> i k; rewrite !mxE.
case/negP: nw; have := congr1 (mulmx^~ (\adj Mj)) zj; rewrite /= -mulmxA mul_mx_adj mul0mx.
by rewrite mul_mx_scalar => /eqP; rewrite scalemx_eq0 (negPf d0).
Qed.
