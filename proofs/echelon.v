(* checker/core/arithmetic.py: `ByteEchelon`, an echelon form in blocks.

   The rows E of a block are the identity at the pivots of the block, and 0 at the pivots of all blocks
   before it.  So the rows that are kept have a right inverse, which `arithmetic.rank_from_below` asks for. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Blocks.
Variables (R : comUnitRingType) (r m n : nat) (M : 'M[R]_(m, n)) (X : 'M[R]_(r, m)).
Variables (piv : 'I_r -> 'I_n) (block : 'I_r -> nat).
Local Notation E := (X *m M).
Hypothesis later : forall s t : 'I_r, (s <= t)%N -> (block s <= block t)%N.
Hypothesis cleared : forall s t, (block t < block s)%N -> E s (piv t) = 0.
Hypothesis identity : forall s t, block s = block t -> E s (piv t) = (s == t)%:R.

Theorem block_echelon : exists Y : 'M_(n, r), E *m Y = 1%:M.
Proof.
have tri : is_trig_mx (colsub piv E)^T.
  apply/is_trig_mxP => t s ts; rewrite mxE [LHS]mxE.
  have := later (ltnW ts); rewrite leq_eqVlt => /orP[/eqP e|/cleared//].
  by rewrite identity//; case: eqP ts => // ->; rewrite ltnn.
have u : colsub piv E \in unitmx.
  rewrite -unitmx_tr unitmxE det_trig// big1 ?unitr1// => s _.
  by rewrite mxE [LHS]mxE identity// eqxx.
exists (colsub piv 1%:M *m invmx (colsub piv E)).
by rewrite mulmxA mulmx_colsub mulmx1 mulmxV.
Qed.
End Blocks.
