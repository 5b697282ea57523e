(* The example of IV-B, over the rationals with its modes among the algebraic numbers, for the theorems about shared
   sub-states, delays and decentralized control: every hypothesis holds for it.  Every agent shares one number,
   and a message from another agent is late by one step. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel evidence controllability joint_controllability neighbor_graph.
From mcexact Require Import gain_lines extended extended_bound delayed_systems delays free_assignment.
From mcexact Require Import error_system brasch_pearson corollary_1 example example_hypotheses.
From mcexact Require Import dynamic_controllers trajectories almost_all_gains two_sided_gains wang_davison.
From mcexact Require Import instances_paper.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation plant := (plant Q).
Notation one_each := (fun _ : 'I_3 => 1%N).
Definition late (i j : 'I_3) : nat := (i != j).

Lemma map_plant s lambda :
  pencil (map_system f plant) s lambda = pencil (example.plant [fieldType of algC]) s lambda.
Proof.
apply: pencil_eq => [|i|i]; apply/matrixP => a b; rewrite !mxE ?rmorphD ?rmorph_nat //.
Qed.

Lemma bound_27 i s (lambda : algC) : s != set0 -> s != setT -> eigenvalue (map_mx f (mcA plant)) lambda ->
  (3 - \rank (pencil (map_system f plant) s lambda) <= one_each i)%N.
Proof. by move=> _ _ _; rewrite map_plant; exact: example_bound_states. Qed.

Lemma bound_26 i s (lambda : algC) : s != set0 -> s != setT -> eigenvalue (map_mx f (mcA plant)) lambda ->
  (3 - \rank (neighbor_pencil N3 (map_system f plant) s lambda) <= one_each i)%N.
Proof.
move=> s0 sT el; apply: leq_trans (bound_27 i s0 sT el).
exact: (deficiency_le f N3_own plant).
Qed.

Example theorem_2_example : forall lambda, ~ fixed_over f (extended N3 one_each plant) lambda :=
  theorem_2 N3_own example_connected (example_controllable Q) (example_observable Q) bound_26.
Example remark_2_example : forall lambda, ~ fixed_over f (extended_states N3 one_each plant) lambda :=
  remark_2 N3_own example_connected (example_controllable Q) (example_observable Q) bound_27.
Lemma theorem_3_example lambda : lambda != 0 -> ~ fixed_over f (lifted N3 one_each late plant) lambda.
Proof. exact: (theorem_3 (d := late) N3_own example_connected (example_controllable Q) (example_observable Q) bound_26). Qed.
Example theorem_4_example : forall lambda, ~ fixed_over f (held N3 one_each late plant) lambda :=
  theorem_4 (d := late) N3_own example_connected (example_controllable Q) (example_observable Q) bound_27.
Example corollary_1_example : freely_assignable (extended N3 one_each plant) :=
  corollary_1_positive (k := one_each) infinite_rat N3_own example_connected (example_controllable Q) (example_observable Q)
    (fun=> isT) bound_26.
Example free_assignment_held_example : freely_assignable (held N3 one_each late plant) :=
  free_assignment_held (k := one_each) infinite_rat late N3_own example_connected (example_controllable Q) (example_observable Q)
    (fun=> isT) bound_27.
Example corollary_1_gains_example := corollary_1_gains (k := one_each) infinite_rat N3_own example_connected
  (example_controllable Q) (example_observable Q) (fun=> isT) bound_26.

(* almost_all_gains.v *)
Example corfmat_morse_almost_all_example := corfmat_morse_almost_all infinite_rat
  (proposition_3_strongly_connected (k := one_each) N3_own plant (fun=> isT) example_connected) theorem_2_example.
Notation no_feedback := (fun i : 'I_3 => 0 : 'M[rat]_(p3 i, 3)).
Example lemma_4_almost_all_example := lemma_4_almost_all f infinite_rat example_connected (ltn0Sn 2) plant no_feedback.
Example observed_almost_all_example := observed_almost_all f infinite_rat example_connected (ltn0Sn 2) no_feedback
  (example_observable Q).
Example proposition_1_almost_all_example := proposition_1_almost_all f infinite_rat example_connected (ltn0Sn 2)
  no_feedback (example_observable Q).

(* wang_davison.v: every eigenvalue of the extended system at -1; of the one with delays at 0 *)
Example hidden_splits_example := hidden_splits f (mcA plant) (mcB plant ord0) (mcC plant ord0).
Example all_but_hidden_example := all_but_hidden f (mcA plant) (mcB plant ord0) (mcC plant ord0) infinite_rat.
Lemma only_0 (lambda : algC) : fixed_over f (lifted N3 one_each late plant) lambda -> pred1 0 lambda.
Proof. by move=> fx; rewrite /=; apply: contraT => /theorem_3_example/(_ fx). Qed.
Example wang_davison_example := wang_davison infinite_rat 0 only_0.
Example region_attained_example := (region_attained
  (lifted N3 one_each late plant) infinite_rat (Z := pred1 0) (a := 0) (introT eqP (rmorph0 f))).1 only_0.
Lemma example_lifted_connected : strongly_connected (transfer_arc (lifted N3 one_each late plant)).
Proof.
apply: (delayed_transfer.lifted_strongly_connected plant N3_own) => //; last exact: example_connected.
by move=> i; rewrite /late eqxx.
Qed.
Example one_channel_but_example := one_channel_but infinite_rat ord0 example_lifted_connected only_0.
Example connected_but_example := connected_but infinite_rat ord0 example_lifted_connected only_0.
Example at_rest_example : forall x t, (1 <= t)%N -> trajectory (0 : 'M[rat]_1) x t = 0.
Proof.
apply: (only_0_at_rest (f := f)) => lambda; rewrite map_mx0 => /eigenvalueP[v].
rewrite mulmx0 => /esym/eqP; rewrite scaler_eq0 => /orP[/eqP //|/eqP ->]; by rewrite eqxx.
Qed.

(* transfer_graph.v: agent 1 of instances_paper.v measures nothing *)
Lemma no_path : transfer_graph.closed_states opened ord0 ord0 setT.
Proof. by split=> [a u _|a b _ _|v b _]; rewrite ?inE //= !mxE mul0rn. Qed.
Example no_arc_example : ~~ transfer_graph.arc opened ord0 ord0 := transfer_graph.closed_states_no_arc no_path.
