(* One state, one channel, A = 0, B = 0, C = 1: the channel moves nothing, so the mode 0 is fixed; and 0, a
   matrix of polynomials in t, with the pivot t. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel zero_blocks.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Notation one := (fun _ : 'I_1 => 1%N).
Definition unmoving : multichannel rat 1 one one := Multichannel 0 (fun=> 0) (fun=> 1%:M).

Lemma unmoved i : i \in setT -> (1%:M : 'M_1) *m mcB unmoving i = 0.
Proof. by rewrite mulmx0. Qed.
Lemma unseen i : i \notin setT -> mcC unmoving i *m (1%:M : 'M_1) = 0.
Proof. by rewrite inE. Qed.
Lemma zero : (1%:M : 'M_1) *m (0%:M - mcA unmoving) *m (1%:M : 'M_1) = 0.
Proof. by rewrite mul1mx mulmx1 subr0 raddf0. Qed.
Lemma too_large : (1 < \rank (1%:M : 'M[rat]_1) + \rank (1%:M : 'M[rat]_1))%N.
Proof.
have h : rowsub id 1%:M = 1%:M :> 'M[rat]_1 by apply/matrixP => i j; rewrite !mxE.
have g : colsub id 1%:M = 1%:M :> 'M[rat]_1 by apply/matrixP => i j; rewrite !mxE.
exact: zero_block_pivots h g (ltnSn 1).
Qed.
Definition inst_zero_block_pivots := too_large.

Definition inst_zero_block_rank := zero_block_rank unmoved unseen zero (fun=> 1%:M) too_large.
Definition inst_zero_block_fixed := zero_block_fixed unmoved unseen zero too_large.
Definition inst_zero_block_pencil := zero_block_pencil unmoved unseen zero too_large.

Lemma inst_zero_block_det : \det (0 : 'M[{poly rat}]_1) = 0.
Proof.
apply: (@zero_block_det _ 1 1 1 0 1%:M 'X%:M id id 'X 1) => //.
- by rewrite mulmx0 mul0mx.
- by apply/matrixP => i j; rewrite mxE.
- by apply/matrixP => i j; rewrite mxE.
- by rewrite polyX_eq0.
exact: oner_neq0.
Qed.
