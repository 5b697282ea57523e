(* Corollary 1 as far as gains go: under Theorem 2 and n_i > 0, one list of gains makes the extended
   system controllable and observable through every channel, (sys:contr-obs-thru-q).  The extended
   systems are jointly controllable and observable whatever the graph.  And the converse of Corfmat
   and Morse: what they conclude implies what they assume. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import extended neighbor_graph extended_bound.
From mcexact Require Import sequential_gains feedback corfmat_morse error_system.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section ExtendedJoint.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel K n p q).

Lemma krylov_mxrow n' (c : 'I_m -> nat) (A : 'M[K]_n') (V : forall i, 'M[K]_(n', c i)) t :
  krylov A (\mxrow_i V i) t = \mxrow_i krylov A (V i) t.
Proof. by elim: t => [//|t IH]; rewrite krylovS IH mul_mxrow. Qed.

Lemma annihilates_inputs n' (p' q' : 'I_m -> nat) (T : multichannel K n' p' q') (w : 'rV_n') :
  (forall t, w *m krylov (mcA T) (inputs T setT) t = 0) <->
  (forall i t, w *m krylov (mcA T) (mcB T i) t = 0).
Proof.
rewrite /inputs; split=> h => [i t|t].
  have := h t; rewrite krylov_mxrow mul_mxrow => /mxrowP/(_ i).
  by rewrite mxrowK submxrow0 in_setT.
rewrite krylov_mxrow mul_mxrow; apply/mxrowP => i; rewrite mxrowK submxrow0 in_setT.
exact: h.
Qed.

Lemma shared_input_tr i : (shared_input K k i)^T = submxcol 1%:M i.
Proof. by rewrite /shared_input tr_submxrow trmx1. Qed.

(* after (emcs): jointly controllable, whatever the neighbor graph *)
Theorem extended_jointly_controllable S : jointly_controllable S ->
  jointly_controllable (extended N k S).
Proof.
move=> /controllableP jc; apply/controllableP => w /annihilates_inputs h.
rewrite -[w]hsubmxK; have b i t : row_mx (lsubmx w *m krylov (mcA S) (mcB S i) t)
    (rsubmx w *m (if t is 0 then shared_input K k i else 0)) = 0.
  have := h i t; rewrite /= krylov_block -{1}[w]hsubmxK mul_row_block.
  by rewrite !mulmx0 addr0 add0r.
have -> : lsubmx w = 0.
  apply: jc; apply/annihilates_inputs => i t.
  by have := b i t; rewrite -[0 in RHS](@row_mx0 _ _ (p i)) => /eq_row_mx[].
have -> : rsubmx w = 0; last by rewrite row_mx0.
apply/mxrowP => i; have := b i 0%N; rewrite -[0 in RHS](@row_mx0 _ _ (p i)) => /eq_row_mx[_].
by rewrite /shared_input mul_submxrow mulmx1 submxrow0.
Qed.

Definition at_once r (v : 'cV[K]_r) (t : nat) : 'cV[K]_r := if t is 0 then v else 0.

Lemma krylov_block_col (A : 'M[K]_n) k' (v : 'cV[K]_(n + k')) t :
  krylov (block_mx A 0 0 0) v t =
  col_mx (krylov A (usubmx v) t) (at_once (dsubmx v) t).
Proof.
elim: t => [|t IH]; first by rewrite /krylov /= vsubmxK.
by rewrite krylovS IH mul_block_col !mul0mx !addr0.
Qed.

(* and jointly observable *)
Theorem extended_jointly_observable S : jointly_observable S -> jointly_observable (extended N k S).
Proof.
move=> /observableP jo; apply/observableP => v h; rewrite -[v]vsubmxK.
have b i t : outputs S (N i) *m krylov (mcA S) (usubmx v) t = 0 /\
    shared_output K k (N i) *m (at_once (dsubmx v) t) = 0.
  have /outputs_eq0/(_ i (in_setT _)) := h t; rewrite /= krylov_block_col mul_block_col.
  by rewrite !mul0mx addr0 add0r -[0 in RHS]col_mx0 => /eq_col_mx.
have -> : usubmx v = 0.
  apply: jo => t; apply/outputs_eq0 => i _.
  by have [/outputs_eq0/(_ i (hears i)) ] := b i t.
have -> : dsubmx v = 0; last by rewrite col_mx0.
apply/mxcolP => i; have [_] := b i 0%N; rewrite /shared_output mxcol_mul => /mxcolP/(_ i).
by rewrite mxcolK hears shared_input_tr submxcol_mul mul1mx !submxcol0.
Qed.

(* Remark 2: also when only sub-states are shared *)
Theorem extended_states_jointly_observable S : jointly_observable S ->
  jointly_observable (extended_states N k S).
Proof.
move=> /observableP jo; apply/observableP => v h; rewrite -[v]vsubmxK.
have b i t : mcC S i *m krylov (mcA S) (usubmx v) t = 0 /\
    shared_output K k (N i) *m (at_once (dsubmx v) t) = 0.
  have /outputs_eq0/(_ i (in_setT _)) := h t; rewrite /= krylov_block_col mul_block_col.
  by rewrite !mul0mx addr0 add0r -[0 in RHS]col_mx0 => /eq_col_mx.
have -> : usubmx v = 0.
  by apply: jo => t; apply/outputs_eq0 => i _; case: (b i t).
have -> : dsubmx v = 0; last by rewrite col_mx0.
apply/mxcolP => i; have [_] := b i 0%N; rewrite /shared_output mxcol_mul => /mxcolP/(_ i).
by rewrite mxcolK hears shared_input_tr submxcol_mul mul1mx !submxcol0.
Qed.

End ExtendedJoint.

Section Corollary.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat).
Hypothesis inf : infinite K.
Implicit Types (S : multichannel K n p q).

(* Corollary 1, (sys:contr-obs-thru-q) *)
Theorem corollary_1_gains (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) S :
  (forall i, i \in N i) -> strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S -> (forall i, 0 < k i)%N ->
  (forall i s (lambda : L), s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  exists F, forall o : 'I_m,
    controllable (closed_loop (extended N k S) F) (mcB (extended N k S) o) /\
    controllable (closed_loop (extended N k S) F)^T (mcC (extended N k S) o)^T.
Proof.
move=> hears sc jc jo k0 h; apply: (corfmat_morse (f := f) inf).
  exact: proposition_3_strongly_connected.
exact: theorem_2.
Qed.

(* the converse of Corfmat and Morse *)
Theorem corfmat_morse_converse S F : (0 < n)%N -> (0 < m)%N ->
  (forall o : 'I_m, controllable (closed_loop S F) (mcB S o) /\
                    controllable (closed_loop S F)^T (mcC S o)^T) ->
  strongly_connected (transfer_arc S) /\ (forall lambda : L, ~ fixed_over f S lambda).
Proof.
move=> n0 m0 h; split.
  apply: (strongly_connected_feedback_back (G := F)) => j i; apply: connect1.
  have [/controllableP cj _] := h j; have [_ /observableP ci] := h i.
  apply: contraT => na.
  have z t : mcC S i *m krylov (closed_loop S F) (mcB S j) t = 0.
    by apply/eqP; apply: contraNT na => nz; apply/transfer_arcP; exists t.
  have C0 : mcC S i = 0.
    by apply/row_matrixP => a; rewrite row0; apply: cj => t; rewrite -row_mul z row0.
  have /matrixP/(_ (Ordinal n0) 0) : const_mx 1 = 0 :> 'cV[K]_n.
    by apply: ci => t; rewrite C0 mul0mx.
  by rewrite !mxE => /eqP; rewrite oner_eq0.
move=> lambda; rewrite anderson_clements_over => -[s]; rewrite ltnNge => /negP; apply.
pose o := Ordinal m0; have [->|sT] := eqVneq s setT.
  have [_ ob] := h o; rewrite rank_pencilT.
  have := observable_hautus f lambda ob; rewrite map_closed_loop => {1}<-.
  have sub : (map_mx f (mcC S o) <= outputs (map_system f S) setT)%MS.
    by rewrite eqmx_outputs; apply: (sumsmx_sup o); rewrite ?inE // genmxE.
  have [Y eY] : exists Y, \sum_i mcB (map_system f S) i *m map_mx f (F i) *m mcC (map_system f S) i =
      Y *m outputs (map_system f S) setT.
    apply/submxP; apply: summx_sub => i _; rewrite eqmx_outputs.
    by apply: submx_trans (output_space_sup _ (in_setT i)); rewrite submxMl.
  apply: mxrankS; rewrite col_mx_sub; apply/andP; split; last first.
    by apply: submx_trans sub _; apply: submx_trans (addsmxSr _ _) _; rewrite addsmxE.
  rewrite /closed_loop opprD addrA eY addmx_sub //.
    by apply: submx_trans (addsmxSl _ _) _; rewrite addsmxE.
  rewrite eqmx_opp; apply: submx_trans (submxMl _ _) _.
  by apply: submx_trans (addsmxSr _ _) _; rewrite addsmxE.
have [i si] : exists i, i \notin s.
  by apply/existsP; rewrite -negb_forall; apply: contra sT => /forallP h'; apply/eqP/setP => i; rewrite h' inE.
apply: leq_trans (rank_row_le_pencil (map_system f S) (fun i => map_mx f (F i)) s lambda).
have [ci _] := h i; rewrite -map_closed_loop -{1}(controllable_hautus f lambda ci).
rewrite -mxrank_tr -[X in (_ <= X)%N]mxrank_tr !tr_row_mx; apply: mxrankS.
have sub : ((map_mx f (mcB S i))^T <= (inputs (map_system f S) (~: s))^T)%MS.
  by rewrite eqmx_inputs trmxK; apply: (sumsmx_sup i); rewrite ?inE // genmxE.
rewrite -(addsmxE _ (map_mx f (mcB S i))^T) -(addsmxE _ (inputs _ _)^T).
by rewrite addsmxS.
Qed.

(* Corfmat and Morse, as an equivalence *)
Theorem corfmat_morse_iff S : (0 < n)%N -> (0 < m)%N ->
  (strongly_connected (transfer_arc S) /\ (forall lambda : L, ~ fixed_over f S lambda)) <->
  exists F, forall o : 'I_m, controllable (closed_loop S F) (mcB S o) /\
                             controllable (closed_loop S F)^T (mcC S o)^T.
Proof.
move=> n0 m0; split=> [[sc nf]|[F h]]; first exact: corfmat_morse.
exact: corfmat_morse_converse h.
Qed.

End Corollary.
