(* The theorems about how far the bounds (26) and (27) can be from the least common dimension, about any graph, about when
   the bound is reached, and about nested sets, applied to concrete plants; every equivalence on each side.

   The graphs are the ring of the example, two agents that hear each other, the diamond of four agents, on which (26) can
   be twice the least common dimension, and the star of three, on which (27) can.  The plants are that of the example and
   the plants that attain the factor on the diamond and on the star. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel evidence controllability joint_controllability neighbor_graph concrete.
From mcexact Require Import rank_one_repair pencil_space anderson_clements.
From mcexact Require Import extended extended_bound delayed_systems delays example example_hypotheses.
From mcexact Require Import sharing_gap any_graph bound_reached nested_sets.
From mcexact Require Import instances_paper instances_example.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation algebraic := [fieldType of algC].

(* four agents in a diamond: agent 1 hears all but agent 4, whom agents 2 and 3 hear *)
Notation diamond4 := (@diamond 1).
Notation first4 := (ord0 : 'I_4).
Notation last4 := (ord_max : 'I_4).
Definition extremal : multichannel Q 4 (fun _ : 'I_4 => 4%N) (fun _ => 4%N) := copies (1 : Q) 2 [set first4] [set last4].

Lemma example_moves (K : fieldType) : mcA (example.plant K) != 0.
Proof.
apply/eqP => /matrixP/(_ (inord 2) (inord 1)); rewrite !mxE !eqxx -val_eqE /= !inordK //.
by rewrite add0r; apply/eqP; rewrite oner_eq0.
Qed.
Global Instance example_concrete (K : fieldType) : concrete_system (example.plant K).
Proof. by split=> //; exact: example_moves. Qed.
Lemma copies_move m r (S R : {set 'I_m}) : mcA (copies (1 : Q) r S R) != 0.
Proof. by apply/eqP => /matrixP/(_ ord0 ord0); rewrite !mxE eqxx; apply/eqP; rewrite oner_eq0. Qed.
Global Instance extremal_concrete : concrete_system extremal.
Proof. by split=> //; exact: copies_move. Qed.
Global Instance ring_concrete : concrete_graph N3. Proof. by []. Qed.
Global Instance diamond_concrete l : concrete_graph (@diamond l). Proof. by []. Qed.
Global Instance star_concrete l : concrete_graph (@star l). Proof. by []. Qed.
Global Instance all_hear_concrete : concrete_graph all_hear. Proof. by []. Qed.

Lemma first_last_apart : apart diamond4 [set first4] [set last4].
Proof.
rewrite /apart -!card_gt0 !cards1 /= /neighborhood big_set1 /diamond eqxx -setI_eq0.
by apply/eqP/setP => j; rewrite !inE; case: eqP.
Qed.
Lemma two_relays : relay_number diamond4 = 2%N. Proof. exact: relay_number_diamond. Qed.
Lemma relays_between : #|relays diamond4 [set first4] [set last4]| = 2%N.
Proof.
apply/eqP; rewrite eqn_leq -[X in (_ <= X)%N && _]two_relays relays_le ?first_last_apart //=.
rewrite -[X in (X <= _)%N](_ : #|~: [set first4; last4]| = _); last by rewrite cardsCs setCK card_ord cards2.
apply: subset_leq_card; apply/subsetP => j; rewrite /relays /neighborhood big_set1 in_setI !inE negb_or => /andP[j0 jm].
rewrite jm -setI_eq0; apply/set0Pn; exists last4.
by rewrite /diamond (negPf j0) (negPf jm) !inE eqxx orbT.
Qed.

(* each of the four shares one number *)
Notation one4 := (fun _ : 'I_4 => 1%N).
Lemma extremal_controllable : jointly_controllable extremal.
Proof. by apply: copies_controllable; apply/set0Pn; exists first4; rewrite inE. Qed.
Lemma extremal_observable : jointly_observable extremal.
Proof. by apply: copies_observable; apply/set0Pn; exists last4; rewrite inE. Qed.
Lemma extremal_free : forall lambda : algC, ~ fixed_over f (extended diamond4 one4 extremal) lambda.
Proof.
have /and3P[s0 r0 d] := first_last_apart.
apply: (copies_outputs_shared (@diamond_hears 1) s0 r0 (c := 1) d).
by rewrite relays_between.
Qed.
Lemma extremal_deficiency : deficiency f diamond4 extremal [set first4] 1 = 2%N.
Proof.
have /and3P[s0 r0 d] := first_last_apart; rewrite -(rmorph1 f).
exact: (copies_deficiency f 1 2 (@diamond_hears 1) s0 r0 d).
Qed.
Lemma extremal_mode : eigenvalue (map_mx f (mcA extremal)) 1.
Proof. by rewrite -(rmorph1 f); exact: copies_eigenvalue. Qed.

(* sharing_gap.v: the bound is 2 where 1 is enough *)
Example bound_26_at_most_extremal : (deficiency f diamond4 extremal [set first4] 1 <= relay_number diamond4 * 1)%N :=
  bound_26_at_most (c := 1) (@diamond_hears 1) [set first4] (@extremal_free 1).
Example bound_27_at_most_example :
    (deficiency_states f plant [set inord 1] 1 <= boundary_number N3 * 1)%N :=
  bound_27_at_most (c := 1) N3_own [set inord 1] (@remark_2_example 1).
Example bound_26_at_most_delays_example :
    (deficiency f N3 plant [set inord 1] 1 <= relay_number N3 * 1)%N :=
  bound_26_at_most_delays (c := 1) (d := late) N3_own [set inord 1] (oner_neq0 _) (theorem_3_example (oner_neq0 _)).
Example bound_27_at_most_held_example :
    (deficiency_states f plant [set inord 1] 1 <= boundary_number N3 * 1)%N :=
  bound_27_at_most_held (c := 1) (d := late) N3_own [set inord 1] (@theorem_4_example 1).
Example bound_26_attained_diamond : exists n p q (S : multichannel Q n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', (forall lambda : algC, ~ fixed_over f (extended diamond4 (fun=> c') S) lambda) <-> (3 <= c')%N,
      exists s (lambda : algC), eigenvalue (map_mx f (mcA S)) lambda /\
        deficiency f diamond4 S s lambda = (relay_number diamond4 * 3)%N
    & forall s (lambda : algC), eigenvalue (map_mx f (mcA S)) lambda ->
        (deficiency f diamond4 S s lambda <= relay_number diamond4 * 3)%N].
Proof. by apply: (bound_26_attained f 1 3 (@diamond_hears 1)); rewrite two_relays. Qed.
Notation star3 := (@star 0).
Example bound_27_attained_star : exists n p q (S : multichannel Q n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', (forall lambda : algC, ~ fixed_over f (extended_states star3 (fun=> c') S) lambda) <-> (3 <= c')%N,
      exists s (lambda : algC), eigenvalue (map_mx f (mcA S)) lambda /\
        deficiency_states f S s lambda = (boundary_number star3 * 3)%N
    & forall s (lambda : algC), eigenvalue (map_mx f (mcA S)) lambda ->
        (deficiency_states f S s lambda <= boundary_number star3 * 3)%N].
Proof. by apply: (bound_27_attained f 1 3 (@star_hears 0)); rewrite boundary_number_star. Qed.
Example relay_number_le_diamond : (relay_number diamond4 <= 4 - 2)%N := relay_number_le (@diamond_hears 1).
Example boundary_number_domination_star : exists D, [/\ neighborhood star3 D = setT, boundary_number star3 = (3 - #|D|)%N
  & forall D', neighborhood star3 D' = setT -> (#|D| <= #|D'|)%N] := boundary_number_domination (@star_hears 0).
Example diamond4_connected : strongly_connected (neighbor_arc diamond4) := @diamond_connected 1.
Example star3_connected : strongly_connected (neighbor_arc star3) := @star_connected 0.
Example relay_number_diamond4 : relay_number diamond4 = (4 - 2)%N := relay_number_diamond 1.
Example boundary_number_star3 : boundary_number star3 = (3 - 1)%N := boundary_number_star 0.

(* on the ring of the example (26) is right, on the diamond it is not *)
Lemma ring_relays : (relay_number N3 <= 1)%N. Proof. exact: relay_number_le N3_own. Qed.
Example bound_26_tight_ring : forall s (lambda : algC), (deficiency f N3 plant s lambda <= 1)%N.
Proof.
move=> s lambda; have [el|/deficient0 -> //] := boolP (eigenvalue (map_mx f (mcA plant)) lambda).
have := (bound_26_tight f N3_own).1 ring_relays _ _ _ plant 1%N (example_controllable Q) (example_observable Q).
exact: (fun h => h theorem_2_example s lambda el).
Qed.
Example bound_26_not_tight_diamond : ~ (forall n p q (S : multichannel Q n p q) c, jointly_controllable S ->
    jointly_observable S -> (forall lambda : algC, ~ fixed_over f (extended diamond4 (fun=> c) S) lambda) ->
    forall s (lambda : algC), eigenvalue (map_mx f (mcA S)) lambda -> (deficiency f diamond4 S s lambda <= c)%N).
Proof. by move/(bound_26_tight f (@diamond_hears 1)).2; rewrite two_relays. Qed.

(* two agents that hear each other: (27) is right; on the star it is not *)
Definition seen_by_2 : multichannel Q 3 (fun _ : 'I_2 => 3%N) (fun _ => 3%N) := copies (1 : Q) 1 [set ord0] (~: [set ord0]).
Global Instance seen_by_2_concrete : concrete_system seen_by_2.
Proof. by split=> //; exact: copies_move. Qed.
Lemma other_one : ~: [set ord0] != set0 :> {set 'I_2}.
Proof. by apply/set0Pn; exists (lift ord0 ord0); rewrite !inE. Qed.
Lemma one_around : #|neighborhood all_hear [set ord0] :\: [set ord0]| = 1%N.
Proof. by rewrite /neighborhood big_set1 /all_hear setTD cardsCs setCK card_ord cards1. Qed.
Lemma two_hear : (boundary_number all_hear <= 1)%N.
Proof.
have [D [DT -> _]] := boundary_number_domination all_hear_self.
rewrite leq_subLR addn1 ltnS card_gt0; apply/eqP => e; move: DT; rewrite e neighborhood0 => /setP/(_ ord0).
by rewrite !inE.
Qed.
Lemma seen_by_2_free : forall lambda : algC, ~ fixed_over f (extended_states all_hear (fun=> 1%N) seen_by_2) lambda.
Proof. by apply: (copies_states_shared all_hear_self proper0 other_one) => //; rewrite one_around. Qed.
Example bound_27_tight_two : forall s, (deficiency_states f seen_by_2 s 1 <= 1)%N.
Proof.
move=> s; have el : eigenvalue (map_mx f (mcA seen_by_2)) 1 by rewrite -(rmorph1 f); exact: copies_eigenvalue.
have := (bound_27_tight f all_hear_self).1 two_hear _ _ _ seen_by_2 1%N
  (copies_controllable 1 1 (~: [set ord0]) proper0) (copies_observable 1 1 [set ord0] other_one).
exact: (fun h => h seen_by_2_free s 1 el).
Qed.
Example bound_27_not_tight_star : ~ (forall n p q (S : multichannel Q n p q) c, jointly_controllable S ->
    jointly_observable S -> (forall lambda : algC, ~ fixed_over f (extended_states star3 (fun=> c) S) lambda) ->
    forall s (lambda : algC), eigenvalue (map_mx f (mcA S)) lambda -> (deficiency_states f S s lambda <= c)%N).
Proof. by move/(bound_27_tight f (@star_hears 0)).2; rewrite boundary_number_star. Qed.

(* Theorem 3 at 0: on the diamond a bound of 100 where nothing need be shared *)
Example theorem_3_at_0_diamond : exists n p q (S : multichannel Q n p q),
  [/\ jointly_controllable S, jointly_observable S,
      eigenvalue (map_mx f (mcA S)) 0 /\ deficiency f diamond4 S [set first4] 0 = 100%N
    & forall d (lambda : algC), lambda != 0 -> ~ fixed_over f (lifted diamond4 (fun=> 0%N) d S) lambda] :=
  theorem_3_at_0 f (@diamond_hears 1) 100 first_last_apart.
Example theorem_3_nonzero_example : ~ fixed_over f (lifted N3 one_each late plant) 1.
Proof.
apply: (theorem_3_nonzero N3_own (example_controllable Q) (example_observable Q) example_connected) (oner_neq0 _).
by move=> i s lambda s0 sT _ el; exact: bound_26.
Qed.

(* any_graph.v: over the ring one number each; nobody hearing anybody, no dimensions suffice for a plant with a fixed mode *)
Lemma example_closed_full s (lambda : algC) : closed N3 s -> (3 <= \rank (pencil (map_system f plant) s lambda))%N.
Proof.
move: s lambda; apply: (some_dimensions_suffice f N3_own plant).1; exists one_each; exact: theorem_2_example.
Qed.
Example some_dimensions_suffice_example : exists k, forall lambda : algC, ~ fixed_over f (extended N3 k plant) lambda :=
  (some_dimensions_suffice f N3_own plant).2 example_closed_full.
Definition alone3 (i : 'I_3) : {set 'I_3} := [set i].
Global Instance alone3_concrete : concrete_graph alone3. Proof. by []. Qed.
Lemma alone3_hears i : i \in alone3 i. Proof. by rewrite inE. Qed.
Lemma alone3_closed s : closed alone3 s.
Proof.
apply/setP => i; apply/bigcupP/idP => [[j js]|si]; first by rewrite inE => /eqP ->.
by exists i; rewrite ?inE.
Qed.
Example no_dimensions_suffice_alone : ~ exists k, forall lambda : algC, ~ fixed_over f (extended alone3 k plant) lambda.
Proof.
move/(some_dimensions_suffice f alone3_hears plant).1/(_ [set inord 1] 1 (alone3_closed _)).
have T0 : (inord 0 : 'I_3) \notin [set inord 1] by rewrite !inE -val_eqE /= !inordK.
have [c eC] := outputs_e2 algebraic T0; rewrite map_plant leqNgt.
by rewrite /pencil /= ltnS (rank_at_agent2 eC).
Qed.
(* any sharing: over the ring nothing stays; where nobody hears anybody 1 stays, however many states are shared *)
Example any_sharing_ring (lambda : algC) : ~ fixed_over f (augmented_outputs (closure N3) plant) lambda.
Proof. by move/(any_sharing f N3_own plant lambda).2/(_ one_each); exact: theorem_2_example. Qed.
Example any_sharing_alone k : fixed_over f (extended alone3 k plant) (1 : algC).
Proof.
move: k; apply/(any_sharing f alone3_hears plant 1); apply/anderson_clements_over; exists [set inord 1].
rewrite (rank_augmented f plant) /neighbor_pencil (closed_closure (alone3_closed _)).
have T0 : (inord 0 : 'I_3) \notin [set inord 1] by rewrite !inE -val_eqE /= !inordK.
have [c eC] := outputs_e2 algebraic T0; rewrite -/(pencil (map_system f plant) [set inord 1] 1) map_plant.
by rewrite /pencil /= ltnS (rank_at_agent2 eC).
Qed.
Example theorem_2_any_graph_example : forall lambda : algC, ~ fixed_over f (extended N3 one_each plant) lambda.
Proof.
apply: (theorem_2_any_graph N3_own example_closed_full) => i s lambda _ el.
exact: bound_26_tight_ring.
Qed.

(* bound_reached.v: a plant without fixed modes; in the example, whose bound is 1, agent 3 needs 1 and agent 1 does not *)
Lemma extended_moves (K : fieldType) n m (p q k : 'I_m -> nat) N (S : multichannel K n p q) :
  mcA S != 0 -> mcA (extended N k S) != 0.
Proof. by apply: contraNneq => /(congr1 ulsubmx); rewrite block_mxKul => ->; apply/eqP/matrixP => i j; rewrite !mxE. Qed.
Global Instance extended_concrete (K : fieldType) n m (p q k : 'I_m -> nat) N (S : multichannel K n p q) :
  concrete_system S -> concrete_system (extended N k S).
Proof. by case=> n2 m2 A0; split=> //; [rewrite (leq_trans n2) // leq_addr | exact: extended_moves]. Qed.
Notation enlarged := (extended N3 one_each plant).
Example bound_without_fixed_modes_example : forall s (lambda : algC),
    (3 + \sum_(i < 3) 1 <= \rank (neighbor_pencil N3 (map_system f enlarged) s lambda))%N :=
  bound_without_fixed_modes N3_own theorem_2_example.

Lemma example_mode_1 : eigenvalue (map_mx f (mcA plant)) 1.
Proof.
have := map_plant set0 1; rewrite /pencil => /(congr1 ulsubmx); rewrite !block_mxKul => e.
rewrite eigenvalue_rank -[map_mx f (mcA plant)]/(mcA (map_system f plant)) e plant_at_1 mxrank_opp.
by rewrite (leq_ltn_trans (mxrankM_maxl _ _)) // (leq_ltn_trans (rank_leq_col _)).
Qed.
Lemma example_only_mode (lambda : algC) : eigenvalue (map_mx f (mcA plant)) lambda -> lambda \in [:: 1].
Proof.
have := map_plant set0 lambda; rewrite /pencil => /(congr1 ulsubmx); rewrite !block_mxKul => e.
rewrite inE eigenvalue_rank -[map_mx f (mcA plant)]/(mcA (map_system f plant)) e; apply: contraTT => l1.
rewrite -leqNgt -[X in (X <= _)%N](@mxrank1 algebraic); apply/mxrankS; rewrite sub1mx row_full_unit.
rewrite -row_free_unit -kermx_eq0; apply/rowV0P => w /sub_kermxP; exact: away.
Qed.
Lemma example_at_most s (lambda : algC) : eigenvalue (map_mx f (mcA plant)) lambda -> (deficiency f N3 plant s lambda <= 1)%N.
Proof. by move=> _; exact: bound_26_tight_ring. Qed.
Lemma same_neighbor_pencil s (lambda : algC) :
  neighbor_pencil N3 (map_system f plant) s lambda = neighbor_pencil N3 (example.plant algebraic) s lambda.
Proof.
rewrite /neighbor_pencil; have := map_plant (neighborhood N3 s) lambda; have := map_plant s lambda.
by rewrite /pencil => /eq_block_mx[eA eB _ _] /eq_block_mx[_ _ eC _]; rewrite eA eB eC.
Qed.
Lemma example_deficient : deficiency f N3 plant [set inord 1] 1 = 1%N.
Proof.
apply/eqP; rewrite eqn_leq bound_26_tight_ring /deficiency subn_gt0.
rewrite same_neighbor_pencil /neighbor_pencil hear_agent2; have [c eC] := outputs_e2 algebraic not_heard.
by rewrite ltnS; apply: rank_at_agent2 eC.
Qed.
Lemma around_agent_2 : neighborhood N3 [set inord 1] :\: [set inord 1] = [set inord 2].
Proof.
rewrite hear_agent2; apply/setP => i; rewrite !inE; case: eqVneq => // ->.
by rewrite -val_eqE /= !inordK.
Qed.
Example bound_reached_example : forall k : 'I_3 -> nat, (forall i, i != inord 2 -> (1 <= k i)%N) ->
  (forall lambda : algC, ~ fixed_over f (extended N3 k plant) lambda) -> (1 <= k (inord 2))%N.
Proof.
apply: (bound_reached N3_own (example_controllable Q) (example_observable Q) example_connected example_at_most
  (inord 2) (ltn0Sn 0) example_only_mode).2.
by exists [set inord 1], 1; rewrite example_mode_1 around_agent_2 example_deficient.
Qed.
Example bound_reached_agent_3 : exists s (lambda : algC), [/\ eigenvalue (map_mx f (mcA plant)) lambda,
    neighborhood N3 s :\: s = [set inord 2] & deficiency f N3 plant s lambda = 1%N] :=
  (bound_reached N3_own (example_controllable Q) (example_observable Q) example_connected example_at_most
    (inord 2) (ltn0Sn 0) example_only_mode).1 bound_reached_example.

(* agent 1 does with nothing, agent 3 does not *)
Lemma agent_1_not_needed s (lambda : algC) : eigenvalue (map_mx f (mcA plant)) lambda ->
  neighborhood N3 s :\: s = [set inord 0] -> (deficiency f N3 plant s lambda < 1)%N.
Proof.
move=> el e; have free : forall lambda : algC, ~ fixed_over f (extended N3 one_scalar plant) lambda.
  move=> x /fixed_over_extended/anderson_clements [s']; rewrite rank_extended; last exact: N3_own.
  by rewrite same_neighbor_pencil -(rank_extended one_scalar N3_own) => low; apply: (@example_one_scalar algebraic x);
    apply/anderson_clements; exists s'.
apply: leq_ltn_trans ((extended_no_fixed f one_scalar N3_own plant).1 free s lambda el) _.
by rewrite e big_set1 /one_scalar /= inordK.
Qed.
Example bound_not_reached_agent_1 : exists k : 'I_3 -> nat, [/\ (k (inord 0) < 1)%N, forall i, i != inord 0 -> (1 <= k i)%N
    & forall lambda : algC, ~ fixed_over f (extended N3 k plant) lambda] :=
  (bound_not_reached N3_own (example_controllable Q) (example_observable Q) example_connected example_at_most
    (inord 0) (ltn0Sn 0)).2 agent_1_not_needed.
Example bound_reached_agent_3_not : ~ exists k : 'I_3 -> nat, [/\ (k (inord 2) < 1)%N,
    forall i, i != inord 2 -> (1 <= k i)%N & forall lambda : algC, ~ fixed_over f (extended N3 k plant) lambda].
Proof.
move/(bound_not_reached N3_own (example_controllable Q) (example_observable Q) example_connected example_at_most
  (inord 2) (ltn0Sn 0)).1/(_ [set inord 1] 1 example_mode_1 around_agent_2).
by rewrite example_deficient.
Qed.

(* nested_sets.v: at least 2 numbers in all for the diamond, 1 for the example where sub-states alone are shared *)
Example total_at_least_extremal : forall k : 'I_4 -> nat,
  (forall lambda : algC, ~ fixed_over f (extended diamond4 k extremal) lambda) -> (2 <= \sum_i k i)%N.
Proof.
move=> k free; have := total_at_least (@diamond_hears 1) (c := fun=> 1%N) (y := fun _ : 'I_1 => 1%N)
  (s := fun=> [set first4]) (fun=> 1) _ free.
rewrite big_ord1 mul1n extremal_deficiency (eq_bigr k) => [|i _]; last by rewrite mul1n.
by apply=> i; rewrite big_mkcond /= big_ord1; case: ifP.
Qed.
Example total_at_least_extremal_applied : (\sum_(j < 1) 1 * deficiency f diamond4 extremal [set first4] 1 <=
  \sum_(i < 4) 1 * 1)%N.
Proof.
apply: (total_at_least (@diamond_hears 1) (c := fun=> 1%N) (y := fun=> 1%N) (s := fun=> [set first4]) (fun=> 1) _ extremal_free).
by move=> i; rewrite big_mkcond /= big_ord1; case: ifP.
Qed.
Example total_at_least_states_example : (\sum_(j < 1) 1 * deficiency_states f plant [set inord 1] 1 <=
  \sum_(i < 3) 1 * 1)%N.
Proof.
apply: (total_at_least_states N3_own (c := fun=> 1%N) (y := fun=> 1%N) (s := fun=> [set inord 1]) (fun=> 1) _
  remark_2_example).
by move=> i; rewrite big_mkcond /= big_ord1; case: ifP.
Qed.
Example rank_submodular_extremal := rank_submodular diamond4 extremal 1 [set first4] [set last4].
Example rank_submodular_states_extremal := rank_submodular_states extremal 1 [set first4] [set last4].
Example boundary_submodular_diamond := boundary_submodular (@diamond_hears 1) [set first4] [set last4] last4.

(* two sets that are not nested, of agents 1 and 2 and of agents 1 and 3, where everybody hears himself alone *)
Notation agent4 a := (inord a : 'I_4).
Notation crossing4 := [:: [set first4; agent4 1]; [set first4; agent4 2]].
Definition alone4 (i : 'I_4) : {set 'I_4} := [set i].
Global Instance alone4_concrete : concrete_graph alone4. Proof. by []. Qed.
Lemma alone4_hears i : i \in alone4 i. Proof. by rewrite inE. Qed.
Lemma alone4_neighborhood s : neighborhood alone4 s = s.
Proof.
apply/setP => i; apply/bigcupP/idP => [[j js]|si]; first by rewrite inE => /eqP ->.
by exists i; rewrite ?inE.
Qed.
Notation mapped := (map_system f extremal).
Lemma crossing_deficient s : s \in crossing4 -> \rank (pencil mapped s 1) = 2%N.
Proof.
move=> sc; have [f4 l4] : first4 \in s /\ last4 \notin s.
  by move: sc; rewrite !inE => /orP[] /eqP ->; rewrite !inE eqxx -!val_eqE /= inordK.
rewrite -(rmorph1 f); apply: (lost f 1 2) => //.
- by apply/set0Pn; exists first4; rewrite inE.
- by apply/set0Pn; exists last4; rewrite inE.
- by rewrite sub1set.
by rewrite -setI_eq0; apply/eqP/setP => i; rewrite !inE; case: eqP => [->|_]; rewrite ?andbF // andbT; apply: negbTE.
Qed.
Lemma crossing_low s : s \in crossing4 -> (\rank (pencil mapped s 1) <= 4)%N.
Proof. by move/crossing_deficient ->. Qed.
Lemma alone4_pencil s : neighbor_pencil alone4 mapped s 1 = pencil mapped s 1.
Proof. by rewrite /neighbor_pencil alone4_neighborhood. Qed.
Example uncross_crossing : exists ts : seq {set 'I_4}, [/\ sorted (fun s t : {set 'I_4} => s \subset t) ts,
    forall i, (\sum_(s <- ts) (i \in neighborhood alone4 s :\: s) <=
               \sum_(s <- crossing4) (i \in neighborhood alone4 s :\: s))%N &
    (\sum_(s <- crossing4) (4 - \rank (neighbor_pencil alone4 mapped s 1)) <=
     \sum_(s <- ts) (4 - \rank (neighbor_pencil alone4 mapped s 1)))%N].
Proof. by apply: (uncross alone4_hears) => s sc; rewrite alone4_pencil crossing_low. Qed.
Example uncross_states_crossing : exists ts : seq {set 'I_4}, [/\ sorted (fun s t : {set 'I_4} => s \subset t) ts,
    forall i, (\sum_(s <- ts) (i \in neighborhood diamond4 s :\: s) <=
               \sum_(s <- crossing4) (i \in neighborhood diamond4 s :\: s))%N &
    (\sum_(s <- crossing4) (4 - \rank (pencil mapped s 1)) <= \sum_(s <- ts) (4 - \rank (pencil mapped s 1)))%N] :=
  uncross_states (@diamond_hears 1) crossing_low.
Lemma around_last (s : {set 'I_4}) : agent4 1 \in s -> last4 \notin s -> last4 \in neighborhood diamond4 s :\: s.
Proof.
move=> s1 sl; rewrite inE sl; apply/bigcupP; exists (agent4 1) => //.
by rewrite /diamond -!val_eqE /= inordK //= !inE eqxx orbT.
Qed.
Example around_interval_diamond : last4 \in neighborhood diamond4 [set agent4 1; agent4 2] :\: [set agent4 1; agent4 2].
Proof.
have l a : (a < 3)%N -> (last4 == agent4 a) = false.
  by move=> a3; rewrite -val_eqE /= inordK ?gtn_eqF // (leqW a3).
apply: (around_interval (s := [set agent4 1]) (u := [set agent4 1; agent4 2; agent4 0])).
- by apply/subsetP => i; rewrite !inE => ->.
- exact: subsetUl.
- by apply: around_last; rewrite !inE ?eqxx ?l.
by apply: around_last; rewrite !inE ?eqxx ?l.
Qed.
