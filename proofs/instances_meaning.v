(* The equations behind the extended, the lifted and the held system (meaning.v), for the example: one number shared by
   each agent, messages of others late by one step, and every agent acting as it likes. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel joint_controllability neighbor_graph extended extended_bound delayed_systems.
From mcexact Require Import example example_hypotheses concrete meaning lifted_states equation_36.
From mcexact Require Import delayed_observability instances_paper.
From mcexact Require Import instances_example instances_sharing_gap.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Example.
Variable K : fieldType.
Notation plant := (example.plant K).
Notation one_each := (fun _ : 'I_3 => 1%N).
Notation late := instances_example.late.

Example loop_equations_example := @loop_equations K 3 3 p3 q3 one_each plant.
Example extended_equations_example := @extended_equations K 3 3 p3 q3 N3 one_each plant.
Example extended_output_example := @extended_output K 3 3 p3 q3 N3 one_each plant.
Example decentralized_is_distributed_example := @decentralized_is_distributed K 3 3 p3 q3 N3 one_each one_each plant.
Example distributed_is_decentralized_example := @distributed_is_decentralized K 3 3 p3 q3 N3 one_each one_each plant.

Lemma late_at_most_1 (j : 'I_3) : dmax N3 late j = 1%N.
Proof.
apply/eqP; rewrite eqn_leq /dmax; apply/andP; split; first by apply/bigmax_leqP => i _; rewrite leq_b1.
have follower : j \in N3 (inord ((j + 2) %% 3)).
  rewrite !inE /next; apply/orP; right; apply/eqP/val_inj; rewrite /= !inordK ?ltn_mod //.
  by case: j => [[|[|[|]]]].
apply: (@leq_trans (late (inord ((j + 2) %% 3)) j)); last exact: (@leq_bigmax_cond _ (fun i => j \in N3 i) (fun i => late i j) _ follower).
rewrite /late lt0b -val_eqE /= inordK ?ltn_mod //.
by case: j {follower} => [[|[|[|]]]].
Qed.

Variables (u : nat -> forall i, 'cV[K]_(p3 i)) (v : nat -> forall i : 'I_3, 'cV[K]_1).

Notation H := (held N3 one_each late plant).
Example held_plant_example := @held_plant K 3 3 p3 q3 N3 one_each late plant.
Example held_first_example := @held_first K 3 3 p3 q3 N3 one_each late plant.
Example held_later_example x Y w z := @held_later K 3 3 p3 q3 N3 one_each late plant x Y w z (inord 0) 0
  (eq_ind_r (fun d => (0 < d)%N) (isT : (0 < 1)%N) (late_at_most_1 (inord 0))).
Example held_output_example := @held_output K 3 3 p3 q3 N3 one_each late plant.

(* from any state on *)
Fixpoint course (s : 'cV[K]_(3 + \sum_i chain N3 one_each late i)) t :=
  if t is t'.+1 then mcA H *m course s t' + \sum_i mcB H i *m col_mx (u t' i) (v t' i) else s.
Lemma course_steps s t : col_mx (usubmx (course s t.+1)) (dsubmx (course s t.+1)) =
  mcA H *m col_mx (usubmx (course s t)) (dsubmx (course s t)) + \sum_i mcB H i *m col_mx (u t i) (v t i).
Proof. by rewrite !vsubmxK. Qed.
Lemma one_late (j : 'I_3) : (dmax N3 late j <= 5)%N. Proof. by rewrite late_at_most_1. Qed.
Lemma hears_1 : inord 1 \in N3 (inord 0). Proof. by rewrite !inE /next -!val_eqE /= !inordK. Qed.
Lemma late_to_0 : (late (inord 0) (inord 1) <= 5)%N. Proof. exact: leq_trans (leq_b1 _) _. Qed.
Example held_delay_example s := held_delay (course_steps s) (j := inord 1) (a := 0) (b := 1)
  (eq_ind_r (fun d => (0 + 1 <= d)%N) (isT : (0 + 1 <= 1)%N) (late_at_most_1 (inord 1))) (isT : (1 <= 5)%N).
Example held_arrives_example s := held_arrives (course_steps s) (one_late (inord 1)).
Example held_then_sent_example s := held_then_sent (course_steps s) hears_1 late_to_0.

Notation L := (lifted N3 one_each late plant).
Example lifted_plant_example := @lifted_plant K 3 3 p3 q3 N3 one_each late plant.
Example lifted_first_example := @lifted_first K 3 3 p3 q3 N3 one_each late plant.
Example lifted_later_example x Y w z := @lifted_later K 3 3 p3 q3 N3 one_each late plant x Y w z (inord 0) 0
  (eq_ind_r (fun d => (0 < d)%N) (isT : (0 < 1)%N) (late_at_most_1 (inord 0))).
Example lifted_stored_example x Y w z := @lifted_stored K 3 3 p3 q3 N3 one_each late plant x Y w z (inord 0)
  (eq_ind_r (fun d => (0 < d)%N) (isT : (0 < 1)%N) (late_at_most_1 (inord 0))).
Example lifted_output_example := @lifted_output K 3 3 p3 q3 N3 one_each late plant.
Fixpoint lifted_course (s : 'cV[K]_(3 + \sum_i memory q3 N3 one_each late i)) t :=
  if t is t'.+1 then mcA L *m lifted_course s t' + \sum_i mcB L i *m col_mx (u t' i) (v t' i) else s.
Lemma lifted_course_steps s t : col_mx (usubmx (lifted_course s t.+1)) (dsubmx (lifted_course s t.+1)) =
  mcA L *m col_mx (usubmx (lifted_course s t)) (dsubmx (lifted_course s t)) + \sum_i mcB L i *m col_mx (u t i) (v t i).
Proof. by rewrite !vsubmxK. Qed.
Lemma within_1 : (1 <= dmax N3 late (inord 1))%N. Proof. by rewrite late_at_most_1. Qed.
Example lifted_shared_example s := lifted_shared (lifted_course_steps s) within_1 (isT : (1 <= 5)%N).
Example lifted_outputs_example s := lifted_outputs (lifted_course_steps s) (isT : (0 < 1)%N) within_1 (isT : (1 <= 5)%N).
End Example.

(* Theorem 3 where sub-states alone are sent *)
Notation plantQ := (example.plant Q).
Notation ones := (fun _ : 'I_3 => 1%N).
Example rank_lifted_states_example := rank_lifted_states N3 ones instances_example.late (oner_neq0 Q) plantQ [set inord 1].
Example theorem_3_states_example : ~ fixed_over f (lifted_states N3 ones instances_example.late plantQ) 1.
Proof.
apply: (theorem_3_states (example_controllable Q) (example_observable Q) example_connected) (oner_neq0 _).
by move=> i s lambda s0 sT _ el; exact: bound_27.
Qed.

(* (36) with two steps, at the eigenvalue of the example *)
Notation mode := (mcA plantQ ord0 ord0).
Lemma mode_not_0 : mode != 0.
Proof.
rewrite !mxE eqxx; have -> : (ord0 == inord 2 :> 'I_3) = false by rewrite -val_eqE /= inordK.
by rewrite addr0 oner_neq0.
Qed.
Example equation_36_example (i : 'I_3) : \rank (col_mx (shifted_rows 2 mode) (delta_mx 0 i : 'rV_3)) = 3%N :=
  equation_36 i mode_not_0.

(* the example under delays is jointly observable, and its mode 1 is controllable *)
Lemma late_own (i : 'I_3) : instances_example.late i i = 0%N. Proof. by rewrite /instances_example.late eqxx. Qed.
Example lifted_jointly_observable_example : jointly_observable (lifted N3 ones instances_example.late plantQ) :=
  lifted_jointly_observable f ones N3_own late_own (example_observable Q).
Example lifted_uncontrollable_at_0_example := lifted_uncontrollable_at_0 f N3 ones instances_example.late
  (example_controllable Q) (oner_neq0 [ringType of algC]).
