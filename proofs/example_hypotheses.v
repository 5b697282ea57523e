(* The example of IV-B meets the hypotheses of Theorems 2 to 4, of Remark 2 and of Corollary 1, over every field: it is
   jointly controllable and observable, its neighbor graph is strongly connected, and n_i = 1 is within both
   bounds, (26) and (27). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph.
From mcexact Require Import extended_bound error_system example.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Notation agent a := (inord a : 'I_3).

Lemma agents (i : 'I_3) : [\/ i = agent 0, i = agent 1 | i = agent 2].
Proof.
case: i => [[|[|[|//]]] lt]; [apply: Or31 | apply: Or32 | apply: Or33];
  by apply: val_inj; rewrite /= inordK.
Qed.

Theorem example_connected : strongly_connected (neighbor_arc N3).
Proof.
have step i : connect (neighbor_arc N3) (next i) i.
  by apply: connect1; rewrite /neighbor_arc !inE eqxx orbT.
have next_of a b : (a < 3)%N -> (a.+1 %% 3)%N = b -> next (agent a) = agent b.
  by move=> a3 <-; rewrite /next inordK.
have c10 : connect (neighbor_arc N3) (agent 1) (agent 0) by rewrite -(@next_of 0%N 1%N).
have c21 : connect (neighbor_arc N3) (agent 2) (agent 1) by rewrite -(@next_of 1%N 2%N).
have c02 : connect (neighbor_arc N3) (agent 0) (agent 2) by rewrite -(@next_of 2%N 0%N).
move=> j i; case: (agents j) => ->; case: (agents i) => ->; rewrite ?connect0 //.
- exact: connect_trans c02 c21.
- exact: connect_trans c10 c02.
exact: connect_trans c21 c10.
Qed.

Section Example.
Variable L : fieldType.
Notation plant := (plant L).
Notation e a := (delta_mx 0 (agent a) : 'rV[L]_3).

Lemma row_entries (w : 'rV[L]_3) T : w *m inputs plant T = 0 ->
  [/\ (agent 0 \in T) || (agent 2 \in T) -> w 0 (agent 0) = 0 & agent 1 \in T -> w 0 (agent 1) = 0].
Proof.
move=> z; split=> [/orP[]|] Ti; have := kernel_inputs z Ti; by rewrite /enters /= inordK.
Qed.

Lemma column_entries (v : 'cV[L]_3) T : outputs plant T *m v = 0 ->
  [/\ agent 0 \in T -> v (agent 0) 0 = 0, agent 0 \in T -> v (agent 2) 0 = 0 &
      (agent 1 \in T) || (agent 2 \in T) -> v (agent 1) 0 = 0].
Proof.
move=> z; have at_ i a (Ti : i \in T) (aq : (a < q3 i)%N) := kernel_outputs aq z Ti.
split=> [Ti|Ti|/orP[] Ti].
- by have := @at_ _ 0%N Ti; rewrite /q3 /reads /= inordK //; apply.
- by have := @at_ _ 1%N Ti; rewrite /q3 /reads /= inordK //; apply.
- by have := @at_ _ 0%N Ti; rewrite /q3 /reads /= inordK //; apply.
by have := @at_ _ 0%N Ti; rewrite /q3 /reads /= inordK //; apply.
Qed.

Theorem example_controllable : jointly_controllable plant.
Proof.
apply/controllableP => w z; have [w0 w1] := row_entries (z 0%N).
have : (w *m mcA plant) *m inputs plant setT = 0 by rewrite -mulmxA; exact: z 1%N.
case/row_entries=> _; rewrite !inE => /(_ isT).
rewrite /= mulmxDr mulmx1 mxE w1 ?inE // add0r mxE (bigD1 (agent 2)) //= !mxE !eqxx mulr1.
rewrite big1 ?addr0 => [w2|i ni]; last by rewrite mxE (negPf ni) mulr0.
by apply: zero_row; rewrite ?w0 ?w1 ?inE.
Qed.

Theorem example_observable : jointly_observable plant.
Proof.
apply/observableP => v /(_ 0%N)/column_entries[v0 v2 v1].
by apply: trmx_inj; rewrite trmx0; apply: zero_row; rewrite mxE ?v0 ?v1 ?v2 ?inE.
Qed.

Lemma away lambda (w : 'rV[L]_3) : lambda != 1 -> w *m (lambda%:M - mcA plant) = 0 -> w = 0.
Proof.
rewrite -subr_eq0 => l1; have -> : lambda%:M - mcA plant = (lambda - 1)%:M - delta_mx (agent 2) (agent 1).
  by rewrite /plant /= opprD addrA raddfB.
rewrite mulmxBr mul_mx_scalar => /eqP; rewrite subr_eq0 => /eqP eq.
have col j : (lambda - 1) * w 0 j = w 0 (agent 2) * (j == agent 1)%:R.
  have /matrixP/(_ 0 j) := eq; rewrite mxE => ->; rewrite mxE (bigD1 (agent 2)) //= big1 ?addr0.
    by rewrite mxE eqxx.
  by move=> i ni; rewrite mxE (negPf ni) mulr0.
have w2 : w 0 (agent 2) = 0.
  by apply: (mulfI l1); rewrite col -val_eqE /= !inordK // mulr0 mulr0.
by apply/rowP => j; rewrite mxE; apply: (mulfI l1); rewrite col w2 mul0r mulr0.
Qed.

(* n_i = 1 is within the bound (27) *)
Theorem example_bound_states s lambda : (3 - \rank (pencil plant s lambda) <= 1)%N.
Proof.
rewrite leq_subLR addnC -leq_subLR; have [->|l1] := eqVneq lambda 1; last first.
  by apply: (@rank_by_inputs _ _ _ _ _ _ _ 1 (e 1)) => w wA _; rewrite (away l1 wA) sub0mx.
have [s0|s0] := boolP (agent 0 \in s).
  apply: leq_trans (_ : 3 <= _)%N => //; rewrite /pencil.
  have le : (\rank (col_mx (1%:M - mcA plant) (outputs plant s)) <=
      \rank (block_mx (1%:M - mcA plant) (inputs plant (~: s)) (outputs plant s) 0))%N.
    rewrite -[X in (X <= _)%N]mxrank_tr -[X in (_ <= X)%N]mxrank_tr tr_block_mx tr_col_mx.
    by rewrite block_mxEv -addsmxE mxrankS // addsmxSl.
  apply: leq_trans le; rewrite -mxrank_tr tr_col_mx.
  set X := row_mx _ _; suff /eqP-> : row_free X by [].
  rewrite -kermx_eq0; apply/rowV0P => w /sub_kermxP; rewrite mul_mx_row -(row_mx0 _ 1 3) => /eq_row_mx[wA wC].
  have /column_entries[v0 v2 _] : outputs plant s *m w^T = 0.
    by apply: trmx_inj; rewrite trmx_mul trmxK trmx0.
  have v1 : w 0 (agent 1) = 0.
    have : (1%:M - mcA plant) *m w^T = 0 by apply: trmx_inj; rewrite trmx_mul trmxK trmx0.
    rewrite plant_at_1 mulNmx => /eqP; rewrite oppr_eq0 -mulmxA => /eqP/matrixP/(_ (agent 2) 0).
    rewrite trmx_delta [RHS]mxE mxE big_ord1 !mxE eqxx mul1r (bigD1 (agent 1)) //= big1 ?addr0.
      by rewrite !mxE !eqxx mul1r.
    by move=> i ni; rewrite !mxE (negPf ni) andbF mul0r.
  by apply: zero_row => //; [have := v0 s0 | have := v2 s0]; rewrite mxE.
apply: (@rank_by_inputs _ _ _ _ _ _ _ 1 (e 1)) => w wA wB; have w2 := kernel_plant wA.
have [w0 _] := row_entries wB.
have -> : w = w 0 (agent 1) *: e 1; last exact: scalemx_sub.
apply/eqP; rewrite -subr_eq0; apply/eqP/zero_row; rewrite !mxE -?val_eqE /= ?inordK //.
- by rewrite w0 ?inE ?s0 // mulr0 subrr.
- by rewrite mulr1 subrr.
- by rewrite w2 mulr0 subrr.
Qed.

(* and within the bound (26), which asks for no more *)
Theorem example_bound s lambda : (3 - \rank (neighbor_pencil N3 plant s lambda) <= 1)%N.
Proof.
apply: leq_trans (example_bound_states s lambda); apply: leq_sub2l; apply: rank_block_le => //.
rewrite !eqmx_outputs; apply: output_spaceS; exact: (sub_neighborhood N3_own).
Qed.

(* where outputs alone are sent, the rank at agent 2 and 1 is 2 *)
Theorem example_rank : \rank (pencil (augmented_outputs N3 plant) [set agent 1] 1) = 2%N.
Proof.
apply/eqP; rewrite eqn_leq; apply/andP; split.
  have [c eC] : exists c, outputs (augmented_outputs N3 plant) [set agent 1] = c *m e 1.
    have [c ec] := outputs_e2 L not_heard.
    pose c' i : 'cV[L]_(\sum_i q3 i) := if i \in [set agent 1] then c else 0.
    exists (\mxcol_i c' i); rewrite mxcol_mul; apply/eq_mxcolP => i.
    rewrite /c' inE; case: eqP => [->|_]; last by rewrite mul0mx.
    by rewrite -ec /= -hear_agent2 /neighborhood big_set1.
  exact: rank_at_agent2 eC.
apply: (@rank_by_inputs _ _ _ _ _ _ _ 1 (e 1)) => w wA wB; have w2 := kernel_plant wA.
have w0 : w 0 (agent 0) = 0.
  have [] := @row_entries w (~: [set agent 1]) => [|-> //].
    rewrite -[RHS]wB; congr (_ *m _).
  by rewrite !inE -val_eqE /= !inordK.
have -> : w = w 0 (agent 1) *: e 1; last exact: scalemx_sub.
apply/eqP; rewrite -subr_eq0; apply/eqP/zero_row; rewrite !mxE -?val_eqE /= ?inordK //.
- by rewrite w0 mulr0 subrr.
- by rewrite mulr1 subrr.
- by rewrite w2 mulr0 subrr.
Qed.
End Example.
