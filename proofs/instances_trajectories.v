(* integrators.v, trajectories.v and dynamic_controllers.v applied to concrete systems, with every hypothesis discharged. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel controllability joint_controllability neighbor_graph.
From mcexact Require Import gain_lines extended_bound error_system delayed_systems brasch_pearson.
From mcexact Require Import theorem_1 corollary_1 construction instances_paper instances_delays.
From mcexact Require Import instances_brasch_pearson example integrators trajectories.
From mcexact Require Import dynamic_controllers.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation one := (1%:M : 'M[rat]_1).

(* x' = x + u, y = x *)
Lemma scalar_reached lambda : ~~ uncontrollable_mode one one lambda.
Proof.
apply/uncontrollable_modeP => -[w [nw _]]; rewrite mulmx1 => w0.
by rewrite w0 eqxx in nw.
Qed.

Lemma scalar_full : row_free (block_mx one one one (0 : 'M_(1, 1))).
Proof.
apply/row_freeP; exists (block_mx 0 1%:M 1%:M (- 1%:M)).
rewrite mulmx_block !mul1mx !mul0mx !add0r !addr0 subrr; exact/esym/scalar_mx_block.
Qed.

Example integrated_controllable_scalar : ~~ uncontrollable_mode (integrated_A one one) (integrated_B 1 one) 1.
Proof. exact: integrated_controllable (oner_neq0 _) (scalar_reached 1). Qed.
Example integrated_observable_scalar :
  ~~ uncontrollable_mode (integrated_A one one)^T (integrated_C Q 1 1)^T 0.
Proof. by apply: integrated_observable; rewrite !trmx1; exact: scalar_reached. Qed.
Example integrated_zero_scalar : ~~ uncontrollable_mode (integrated_A one one) (integrated_B 1 one) 0.
Proof. by rewrite integrated_zero; exact: scalar_full. Qed.

(* x' = x + u rests at x = 2 for u = -2: there y = 2 *)
Example integrated_equilibrium_scalar : one *m 2%:M = (2%:M : 'M[rat]_1).
Proof.
apply: (@integrated_equilibrium _ _ _ _ one one one 2%:M 0 2%:M (- 2%:M)).
rewrite /integrated_A /integrated_B mul_block_col !mul0mx !addr0 mul_col_mx mul0mx add_col_mx.
by rewrite opp_col_mx add_col_mx !mul1mx subrr oppr0 !addr0 subrr col_mx0.
Qed.

(* x(t+1) = 0: at rest after one step *)
Example at_rest_zero (x : 'cV[rat]_1) : trajectory (0 : 'M_1) x 1 = 0.
Proof. by apply: at_rest; rewrite ?char_poly_trig ?big_ord1 ?mxE ?subr0 ?expr1 //; apply/is_trig_mxP => i j; rewrite mxE. Qed.

(* the system of instances_brasch_pearson.v, whose agents hear each other *)
Example construction_at_rest_open := construction_at_rest f infinite_rat all_strongly_connected
  carried_only erefl (open_controllable Q) (open_observable Q).

(* dynamic_controllers.v: the example of IV-B over the rationals, seen over the algebraic numbers; its
   agents have one state each *)
Definition lazy_agents : controllers Q p3 (fun=> \sum_(i < 3) q3 i)%N (fun=> 1%N) :=
  Controllers (fun=> 0) (fun=> 0) (fun=> 0) (fun=> 0).
Example fixed_dynamic_example : eigenvalue (dynamic_loop (augmented_outputs N3 (plant Q)) lazy_agents) 1 :=
  fixed_dynamic (@example_mss_fixed Q) lazy_agents.
Example example_dynamic_lazy := example_dynamic lazy_agents.
Example fixed_dynamic_over_example (D : controllers [fieldType of algC] p3 (fun=> \sum_(i < 3) q3 i)%N (fun=> 1%N)) :
  eigenvalue (dynamic_loop (map_system f (augmented_outputs N3 (plant Q))) D) (f 1).
Proof.
apply: fixed_dynamic_over => F; rewrite (eigenvalue_map f); exact: example_mss_fixed.
Qed.
