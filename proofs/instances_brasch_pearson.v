(* Brasch and Pearson's theorem, Theorem 1 and Corollary 1 applied to concrete systems, with every
   hypothesis discharged: the double integrator with position output, and the systems of
   instances_paper.v.  The real algebraic numbers stand for the reals. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel controllability joint_controllability neighbor_graph.
From mcexact Require Import gain_lines extended_bound error_system delayed_systems brasch_pearson.
From mcexact Require Import theorem_1 corollary_1 construction instances_paper instances_delays.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation Q := [fieldType of rat].
Notation f := [rmorphism of (ratr : rat -> algC)].

(* x'' = u, y = x *)
Definition double : 'M[rat]_2 := delta_mx 0 1.
Definition force : 'cV[rat]_2 := delta_mx 1 0.
Definition position : 'rV[rat]_2 := delta_mx 0 0.

Lemma row2_eq0 (w : 'rV[rat]_2) :
  w *m (delta_mx 0 0 : 'cV_2) = 0 -> w *m (delta_mx 1 0 : 'cV_2) = 0 -> w = 0.
Proof.
rewrite -!colE => /matrixP/(_ 0 0) + /matrixP/(_ 0 0); rewrite !mxE => w0 w1.
apply/rowP => -[[|[|//]] lt]; rewrite mxE; [rewrite -[RHS]w0 | rewrite -[RHS]w1];
  by congr (w _ _); apply: val_inj.
Qed.

Lemma double_reached : \rank (reach double force 2) = 2%N.
Proof.
apply/eqP/rank_reachP => w h; apply: row2_eq0; last exact: (h 0%N isT).
by have := h 1%N isT; rewrite /krylov /= mul_delta_mx.
Qed.

Lemma double_observed : \rank (reach double^T position^T 2) = 2%N.
Proof.
apply/eqP/rank_reachP => w h; have := h 1%N isT; have := h 0%N isT.
by rewrite /krylov /= !trmx_delta mul_delta_mx; apply: row2_eq0.
Qed.

(* every eigenvalue at -1 *)
Definition decaying (K : fieldType) k : {poly K} := ('X - (- 1)%:P) ^+ k.
Lemma decaying_monic K k : decaying K k \is monic. Proof. by rewrite monic_exp ?monicXsubC. Qed.
Lemma size_decaying K k : size (decaying K k) = k.+1. Proof. by rewrite size_exp_XsubC. Qed.

(* brasch_pearson.v: a controller of order 1, three eigenvalues *)
Example brasch_pearson_one_input_double := brasch_pearson_one_input
  (controllable_blocks double_reached) double_observed (decaying_monic Q 3) (size_decaying Q 3).
Example one_input_enough_double := one_input_enough f infinite_rat
  (controllable_blocks double_reached) (controllable_blocks double_observed).
Example brasch_pearson_double := brasch_pearson f infinite_rat
  (controllable_blocks double_reached) double_observed (decaying_monic Q 3) (size_decaying Q 3).
Example brasch_pearson_dual_double := brasch_pearson_dual f infinite_rat
  double_reached (controllable_blocks double_observed) (decaying_monic Q 3) (size_decaying Q 3).
Example brasch_pearson_minimum_double := brasch_pearson_minimum f infinite_rat
  (controllable_blocks double_reached) (controllable_blocks double_observed)
  (or_introl double_reached) (decaying_monic Q 3) (size_decaying Q 3).

(* theorem_1.v: two agents, one state, so three eigenvalues; agent 1 carries the controller *)
Example theorem_1_open := theorem_1 f infinite_rat all_strongly_connected no_feedback ord0
  (open_observable Q) (decaying_monic Q 3) (size_decaying Q 3).

(* the real algebraic numbers *)
Record algR := AlgR {algR_val : algC; algR_real : algR_val \is Num.real}.
Canonical algR_subType := [subType for algR_val].
Definition algR_eqMixin := [eqMixin of algR by <:].
Canonical algR_eqType := EqType algR algR_eqMixin.
Definition algR_choiceMixin := [choiceMixin of algR by <:].
Canonical algR_choiceType := ChoiceType algR algR_choiceMixin.
Definition algR_zmodMixin := [zmodMixin of algR by <:].
Canonical algR_zmodType := ZmodType algR algR_zmodMixin.
Definition algR_ringMixin := [ringMixin of algR by <:].
Canonical algR_ringType := RingType algR algR_ringMixin.
Definition algR_comRingMixin := [comRingMixin of algR by <:].
Canonical algR_comRingType := ComRingType algR algR_comRingMixin.
Definition algR_unitRingMixin := [unitRingMixin of algR by <:].
Canonical algR_unitRingType := UnitRingType algR algR_unitRingMixin.
Canonical algR_comUnitRingType := [comUnitRingType of algR].
Definition algR_idomainMixin := [idomainMixin of algR by <:].
Canonical algR_idomainType := IdomainType algR algR_idomainMixin.
Definition algR_fieldMixin := [fieldMixin of algR by <:].
Canonical algR_fieldType := FieldType algR algR_fieldMixin.

Lemma algR_val_is_rmorphism : rmorphism algR_val. Proof. by []. Qed.
Canonical algR_val_additive := Additive algR_val_is_rmorphism.
Canonical algR_val_rmorphism := RMorphism algR_val_is_rmorphism.

Lemma algR_reals (x : algC) : x \is Num.real -> exists y, algR_val y = x.
Proof. by move=> rx; exists (AlgR rx). Qed.

(* i, -i and -1 *)
Definition eigenvalues : seq algC := [:: 'i; - 'i; -1].
Lemma eigenvalues_symmetric : perm_eq eigenvalues [seq x^* | x <- eigenvalues].
Proof.
rewrite /= rmorphN /= conjCi opprK rmorphN1.
by rewrite -[X in perm_eq X _]/([:: 'i] ++ [:: - 'i] ++ [:: -1]) perm_catCA.
Qed.
Example theorem_1_symmetric_open := theorem_1_symmetric algR_reals all_strongly_connected
  (fun i : 'I_2 => 0 : 'M_1) ord0 (open_observable [fieldType of algR])
  (erefl : size eigenvalues = (2 * 1 + 2.-1)%N) eigenvalues_symmetric.

(* corollary_1.v *)
Example free_assignment_free := free_assignment infinite_rat (free_arcs Q) free_not_fixed_over.
Example state_feedback_double := state_feedback f infinite_rat
  (controllable_blocks double_reached) (decaying_monic Q 2) (size_decaying Q 2).
Example joint_state_feedback_open := joint_state_feedback f infinite_rat (open_controllable Q)
  (decaying_monic Q 1) (size_decaying Q 1).
Example corollary_1_open : freely_assignable (extended all_hear (share 1) opened).
Proof.
apply: (corollary_1 (f := f) infinite_rat all_hear_self all_strongly_connected
  (open_controllable Q) (open_observable Q)) => [|i s lambda _ _ _]; last exact: leq_subr.
exact: proposition_3_strongly_connected_open.
Qed.
Example corollary_1_positive_open : freely_assignable (extended all_hear (share 1) opened).
Proof.
apply: (corollary_1_positive (f := f) infinite_rat all_hear_self all_strongly_connected
  (open_controllable Q) (open_observable Q)) => // i s lambda _ _ _; exact: leq_subr.
Qed.
Example free_assignment_held_open : freely_assignable (held all_hear (share 1) delay opened).
Proof.
apply: (free_assignment_held (f := f) infinite_rat delay all_hear_self all_strongly_connected
  (open_controllable Q) (open_observable Q)) => // i s lambda _ _ _; exact: leq_subr.
Qed.
Example free_assignment_delays_open := free_assignment_delays f infinite_rat delay (ltn0Sn 0)
  all_hear_self all_strongly_connected (open_controllable Q) (open_observable Q).

(* construction.v: the channel controller of order 1 belongs to agent 1 *)
Definition carried (i : 'I_2) : nat := (i == ord0).
Lemma carried_only i : i != ord0 -> carried i = 0%N. Proof. by rewrite /carried => /negPf ->. Qed.
Example theorem_1_controllers_open := theorem_1_controllers f infinite_rat all_strongly_connected
  carried_only erefl no_feedback (open_observable Q) (decaying_monic Q 3) (size_decaying Q 3).
Example construction_open := construction f infinite_rat all_strongly_connected carried_only erefl
  (open_controllable Q) (open_observable Q) (decaying_monic Q 1) (size_decaying Q 1)
  (decaying_monic Q 3) (size_decaying Q 3).
Example construction_rate_open := construction_rate f infinite_rat all_strongly_connected
  carried_only erefl (-1) (open_controllable Q) (open_observable Q).
