(* Every theorem of paper.v that the ledger cites, applied to concrete systems over every real closed field R, with no
   hypothesis left: `assumptions.py` tests this of every statement here (concrete.v).

   Most are about the paper's example: three states, three channels, its ring of neighbors, one shared number for each
   agent, and messages of others late by one step.  Where no mode may be fixed it is the extended system of the example,
   with six states; where set-points are held, a plant of two states with one state for each of two channels. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space anderson_clements.
From mcexact Require Import joint_controllability neighbor_graph gain_lines extended extended_bound feedback.
From mcexact Require Import error_system theorem_1 delayed_systems distributed_observer integrators example example_hypotheses.
From mcexact Require Import free_assignment sharing_gap any_graph concrete instances_paper instances_sharing_gap paper.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Reproduction.
Variable R : rcfType.
Notation C := (complex R).
Notation f := [rmorphism of real_complex R].
Notation Rf := [fieldType of R].
Notation Cf := [fieldType of C].
Notation plant := (example.plant Rf).
Notation agent a := (inord a : 'I_3).
Notation late := instances_example.late.
Notation one_each := (fun _ : 'I_3 => 1%N).
Notation sc := example_connected.
Notation jc := (example_controllable Rf).
Notation jo := (example_observable Rf).
Notation three := (isT : (0 < 3)%N).

Lemma map_example s lambda : pencil (map_system f plant) s lambda = pencil (example.plant Cf) s lambda.
Proof. by apply: pencil_eq => [|i|i]; apply/matrixP => a b; rewrite !mxE ?rmorphD ?rmorph_nat. Qed.
Lemma map_example_neighbors s lambda :
  neighbor_pencil N3 (map_system f plant) s lambda = neighbor_pencil N3 (example.plant Cf) s lambda.
Proof.
rewrite /neighbor_pencil; have := map_example (neighborhood N3 s) lambda; have := map_example s lambda.
by rewrite /pencil => /eq_block_mx[eA eB _ _] /eq_block_mx[_ _ eC _]; rewrite eA eB eC.
Qed.
Lemma within_27 : bound_27 plant one_each.
Proof. by move=> i s lambda _ _ _; rewrite map_example; exact: example_bound_states. Qed.
Lemma within_26 : bound_26 plant N3 one_each.
Proof. exact: (remark_2_demands_more N3_own within_27). Qed.
Lemma positive (i : 'I_3) : (0 < one_each i)%N. Proof. by []. Qed.
Lemma own_at_once i : late i i = 0%N. Proof. by rewrite /late eqxx. Qed.
Lemma s_not_0 : [set agent 1] != set0. Proof. by apply/set0Pn; exists (agent 1); rewrite inE. Qed.
Lemma s_not_T : [set agent 1] != setT.
Proof. by apply/eqP => /setP/(_ (agent 2)); rewrite !inE -val_eqE /= !inordK. Qed.
Lemma only_mode (lambda : C) : eigenvalue (map_mx f (mcA plant)) lambda -> lambda = 1.
Proof.
have := map_example set0 lambda; rewrite /pencil => /(congr1 ulsubmx); rewrite !block_mxKul => e.
rewrite eigenvalue_rank -[map_mx f (mcA plant)]/(mcA (map_system f plant)) e => low; apply/eqP; apply: contraTT low => l1.
rewrite -leqNgt -[X in (X <= _)%N](@mxrank1 Cf); apply/mxrankS; rewrite sub1mx row_full_unit.
rewrite -row_free_unit -kermx_eq0; apply/rowV0P => w /sub_kermxP; exact: away.
Qed.
Lemma mode_1 : eigenvalue (map_mx f (mcA plant)) 1.
Proof.
have := map_example set0 1; rewrite /pencil => /(congr1 ulsubmx); rewrite !block_mxKul => e.
rewrite eigenvalue_rank -[map_mx f (mcA plant)]/(mcA (map_system f plant)) e plant_at_1 mxrank_opp.
by rewrite (leq_ltn_trans (mxrankM_maxl _ _)) // (leq_ltn_trans (rank_leq_col _)).
Qed.

(* II-A *)
Example cancellation_example := cancellation plant (inputs plant setT) (outputs plant setT).
Notation ones := (fun j : 'I_3 => const_mx 1 : 'M[R]_(p3 j, 3)).
Lemma no_product_0 j : mcB plant j *m ones j != 0.
Proof.
apply/eqP => /matrixP/(_ (inord (enters j)) 0); rewrite !mxE big_ord1 !mxE inordK ?eqxx ?mulr1.
  by apply/eqP; rewrite oner_eq0.
by rewrite /enters; case: ifP.
Qed.
(* agent 1 does not hear agent 3, whose input would matter *)
Example cancellation_graph_example : ~ (forall x x' : 'I_3 -> 'cV[R]_3, (forall j, j \in N3 (agent 0) -> x j = x' j) ->
  \sum_j mcB plant j *m ones j *m x j = \sum_j mcB plant j *m ones j *m x' j).
Proof.
move/(cancellation_graph plant N3 ones (agent 0)).1/(_ (agent 2) (no_product_0 _)).
by rewrite !inE /next -!val_eqE /= !inordK.
Qed.
Example cancellation_graph_enough : forall x x' : 'I_3 -> 'cV[R]_3,
  (forall j, j \in (fun _ : 'I_3 => setT) (agent 0) -> x j = x' j) ->
  \sum_j mcB plant j *m ones j *m x j = \sum_j mcB plant j *m ones j *m x' j.
Proof. by apply/(cancellation_graph plant (fun=> setT) ones (agent 0)).2 => j _; rewrite inE. Qed.
Example cancellation_complete_example : ~ (forall i j, mcB plant j *m ones j != 0 -> j \in N3 i).
Proof.
move/(cancellation_complete N3 no_product_0).1/(_ (agent 0))/setP/(_ (agent 2)).
by rewrite !inE /next -!val_eqE /= !inordK.
Qed.
Example cancellation_complete_all : forall i j, mcB plant j *m ones j != 0 -> j \in (fun _ : 'I_3 => [set: 'I_3]) i :=
  (cancellation_complete (fun=> setT) no_product_0).2 (fun=> erefl).

(* II-B *)
Definition observer_states n m (N : 'I_m -> {set 'I_m}) := (\sum_(i < m) n + m.-1)%N.
Example open_loop_dimension_example : observer_states 3 N3 = (3 * 3 + 3 - 1)%N := open_loop_dimension 3 three.
Notation eleven := (nseq 11 (-1 : C)).
Lemma eleven_symmetric : perm_eq eleven [seq x^* | x <- eleven].
Proof. by rewrite map_nseq rmorphN1. Qed.
Example open_loop_spectrum_example := open_loop_spectrum jo (agent 0) sc (erefl : size eleven = 11%N) eleven_symmetric.
Example open_loop_gains_example := open_loop_gains three jo sc.
Example open_loop_almost_all_example := open_loop_almost_all three jo sc.

(* a controller with two states, and any of the inputs and outputs of the example together *)
Lemma all_reach : \rank (reach (mcA plant) (inputs plant setT) 3) = 3%N. Proof. exact: (eqP jc). Qed.
Example brasch_pearson_example : exists (Ac : 'M_2) Bc Cc D,
  char_poly (brasch_pearson.compensated (mcA plant) (inputs plant setT) (outputs plant setT) Ac Bc Cc D) = 'X^5.
Proof.
apply: (brasch_pearson jc _ (or_introl all_reach)); first exact: jo; last by rewrite size_polyXn.
exact: monicXn.
Qed.

(* II-C *)
Example state_feedback_example : exists F : forall i, 'M_(p3 i, 3), char_poly (mcA plant + \sum_i mcB plant i *m F i) = 'X^3.
Proof. by apply: (state_feedback jc); rewrite ?monicXn ?size_polyXn. Qed.
Section Observer.
Variables (F : forall i, 'M[R]_(p3 i, 3)) (k : 'I_3 -> nat).
Variable D : controllers R (fun=> 3%N) (fun i => q3 i + \sum_(i < 3) 3)%N k.
Example errors_example := errors plant N3 F D.
Example spectrum_of_both_example := spectrum_of_both plant N3 F D.
Example equation_9_example := equation_9 plant N3 F D.
Example equation_10_example := equation_10 plant N3 F D.
Example equation_11_example := equation_11 plant N3 F D.
Example equation_12_example := equation_12 plant N3 F (o := agent 0).
Example equation_13_example := equation_13 plant N3 F (o := agent 0).
Example proposition_1_example := proposition_1 three jo F sc.
Example theorem_1_example := theorem_1 jo F (agent 0) sc (erefl : size eleven = 11%N) eleven_symmetric.

(* II-D *)
Example lemma_1_example := lemma_1 jo F sc.
Example inputs_identity_example := inputs_identity plant N3 F.
Example lemma_4_example := lemma_4 plant three F (fun=> 0) sc.
Example lemma_4_almost_all_example := lemma_4_almost_all plant three F sc.
Example complementary_complete_example := complementary_complete three three jo F sc s_not_0 s_not_T.
Example observable_almost_all_example := observable_almost_all three jo F sc.
Example both_almost_all_example := both_almost_all three jo F sc.
End Observer.
Example lemma_2_example : exists H : 'I_3 -> 'M[R]_(3, \sum_(i < 3) 3), forall o : 'I_3,
    controllability_index (\sum_j error_input R 3 j *m H j *m differences R 3 N3 j) (error_input R 3 o) 3 :=
  lemma_2 R three sc.
Example scalars_example := scalars R sc.

(* Lemma 3 with the index 3 of the differences of Lemma 2 and any feedback F of the error system *)
Example lemma_3_example F : exists A', exists d, forall gs : seq R, uniq gs ->
  all (fun g => \rank (reach (mcA (error_system N3 plant F) + g *: A') (error_input R 3 (agent 0)) 3) != (\sum_(i < 3) 3)%N) gs ->
  (size gs <= d)%N.
Proof.
have [H h] := lemma_2_example; exists (\sum_j error_input R 3 j *m H j *m differences R 3 N3 j).
exact: (lemma_3 (mcA (error_system N3 plant F)) (h (agent 0))).
Qed.
Example lemma_3_moreover_example F : exists A', exists d, forall gs : seq R, uniq gs ->
  (forall g, g \in gs -> ~ controllability_index (mcA (error_system N3 plant F) + g *: A') (error_input R 3 (agent 0)) 3) ->
  (size gs <= d)%N.
Proof.
have [H h] := lemma_2_example; exists (\sum_j error_input R 3 j *m H j *m differences R 3 N3 j).
by apply: (lemma_3_moreover (mcA (error_system N3 plant F)) (h (agent 0))); rewrite sum_nat_const card_ord.
Qed.

(* the construction: agent 1 has a channel controller with two states, the others have none *)
Notation two_at_1 := (fun i : 'I_3 => if i == agent 0 then 2%N else 0%N).
Lemma none_elsewhere i : i != agent 0 -> two_at_1 i = 0%N. Proof. by move/negPf => /= ->. Qed.
Lemma two_states_at_1 : two_at_1 (agent 0) = 2%N. Proof. by rewrite /= eqxx. Qed.
Example construction_example : exists (F : forall i, 'M_(p3 i, 3))
    (D : controllers R (fun=> 3%N) (fun i => q3 i + \sum_(i < 3) 3)%N two_at_1),
  char_poly (observer_loop N3 plant F D) = 'X^3 * 'X^11.
Proof.
by apply: (construction jc jo none_elsewhere two_states_at_1 sc); rewrite ?monicXn ?size_polyXn.
Qed.
Example construction_rate_example := construction_rate jc jo none_elsewhere two_states_at_1 (-1) sc.
Example construction_discrete_example := construction_discrete jc jo none_elsewhere two_states_at_1 sc.

(* III: two states, one for each channel *)
Notation one2 := (fun _ : 'I_2 => 1%N).
Definition pair : multichannel R 2 one2 one2 :=
  Multichannel (diag_mx (\row_j (j.+1)%:R)) (fun i => delta_mx i 0) (fun i => delta_mx 0 i).
Lemma pair_moves : mcA pair != 0.
Proof. by apply/eqP => /matrixP/(_ ord0 ord0); rewrite !mxE eqxx mulr1n; apply/eqP; rewrite oner_eq0. Qed.
Global Instance pair_concrete : concrete_system pair. Proof. by split=> //; exact: pair_moves. Qed.
Lemma pair_inputs (w : 'rV[R]_2) : w *m inputs pair setT = 0 -> w = 0.
Proof.
move=> e; apply/rowP => i; have := congr1 (fun M => submxrow M i 0 0) e.
by rewrite /inputs mul_mxrow mxrowK in_setT /= -colE submxrow0 !mxE.
Qed.
Lemma pair_controllable : jointly_controllable pair.
Proof. by apply/controllableP => w /(_ 0%N); rewrite /krylov /=; exact: pair_inputs. Qed.
Lemma pair_outputs (v : 'cV[R]_2) : outputs pair setT *m v = 0 -> v = 0.
Proof.
move=> e; apply/colP => i; have := congr1 (fun M => submxcol M i 0 0) e.
by rewrite /outputs mxcol_mul mxcolK in_setT /= -rowE submxcol0 !mxE.
Qed.
Lemma pair_observable : jointly_observable pair.
Proof.
apply/observableP => v /(_ 0%N); rewrite /krylov /=; exact: pair_outputs.
Qed.
Example equation_19_example := equation_19 jo.
Example equation_20_example := equation_20 jc (oner_neq0 [ringType of C]).
Lemma pair_21 : condition_21 pair.
Proof.
rewrite /condition_21 -kermx_eq0; apply/rowV0P => w /sub_kermxP; rewrite -[w]hsubmxK mul_row_block.
rewrite !mulmx0 addr0 => /eqP; rewrite -[X in _ == X]row_mx0 => /eqP/eq_row_mx[eA /pair_inputs w1].
move: eA; rewrite w1 mul0mx add0r => w2; rewrite (_ : rsubmx w = 0) ?row_mx0 //.
apply/mxrowP => i; rewrite submxrow0; apply/matrixP => a b; rewrite [RHS]mxE.
have := congr1 (fun M : 'rV[R]_2 => M 0 i) w2; rewrite (ord1 a) [RHS]mxE => <-.
rewrite -{2}[rsubmx w]submxrowK /outputs mul_mxrow_mxcol summxE [RHS](bigD1 i) //= [X in _ = _ + X]big1 => [|j ji].
  by rewrite addr0 in_setT /= [in RHS]mxE [RHS]big_ord1 [X in _ * X]mxE !eqxx mulr1 (ord1 b).
by rewrite in_setT /= mxE [LHS]big_ord1 [X in _ * X]mxE [i == j]eq_sym (negPf ji) andbF mulr0.
Qed.
Example equation_21_example : jointly_controllable (integrated pair) := (equation_21 pair_controllable).2 pair_21.
Lemma no_21 : ~ condition_21 plant.
Proof.
rewrite /condition_21 /row_free => /eqP full.
have := rank_leq_col (block_mx (mcA plant) (inputs plant setT) (outputs plant setT) (0 : 'M_(\sum_i q3 i, \sum_i p3 i))).
by rewrite full leq_add2l !big_ord_recl !big_ord0.
Qed.
Example equation_21_not : ~ jointly_controllable (integrated plant).
Proof. by move/(equation_21 jc).1/no_21. Qed.
Example zero_canceled_example : forall k (D : controllers R p3 q3 k), eigenvalue (map_mx f (dynamic_loop (integrated plant) D)) 0 :=
  fun k D => zero_canceled D no_21.

(* at rest without any control, a state that drifts and the estimates 0; and diag(1, 2) with references -1 and -2, of which
   every estimator knows its own *)
Notation N2 := (fun _ : 'I_2 => [set: 'I_2]).
Definition drift : multichannel R 2 one2 one2 :=
  Multichannel (delta_mx 0 1) (fun i => delta_mx i 0) (fun i => delta_mx 0 i).
Definition idle n : controllers R (fun=> n) (fun i : 'I_2 => one2 i + \sum_(i < 2) n)%N (fun=> 0%N) :=
  Controllers (fun=> 0) (fun=> 0) (fun=> 0) (fun=> 0).
Notation e1 := (delta_mx 0 0 : 'cV[R]_2).
Notation r1 := (outputs drift setT *m e1).
Lemma drift_outputs : r1 != 0.
Proof.
apply/eqP => e; have := congr1 (fun M => submxcol M 0 0 0) e.
rewrite /outputs mxcol_mul mxcolK in_setT /= -rowE submxcol0 !mxE eqxx /=.
by move/eqP; rewrite oner_eq0.
Qed.
Lemma observer_idle n (S : multichannel R n one2 one2) (x : 'cV[R]_n) (X : 'cV[R]_(\sum_(i < 2) n)) :
  observer_loop N2 S (fun=> 0) (idle n) *m col_mx x (col_mx X 0) =
  col_mx (mcA S *m x) (col_mx (\mxcol_i (mcA S *m (block_of R n i *m X))) 0).
Proof.
set v := LHS; rewrite -[v]vsubmxK -[dsubmx v]vsubmxK; congr col_mx; last congr col_mx.
- rewrite observer_plant (_ : \sum_i _ = 0) ?addr0 //; apply: big1 => i _; by rewrite mulmx0 mul0mx.
- apply: blocks_eq => i; rewrite observer_estimate block_mxcol /= linear0 !mul0mx !addr0.
  rewrite (_ : \sum_(j in _) _ = 0); last first.
    apply: big1 => j _; rewrite (_ : submxrow _ _ = 0) ?mul0mx //; apply/matrixP => a b; by rewrite !mxE.
  by rewrite (_ : \sum_j _ = 0) ?mul0mx ?addr0 //; apply: big1 => j _; rewrite mulmx0.
by apply/matrixP => a; have := ltn_ord a; rewrite {2}big1.
Qed.
Notation nI := (2 + \sum_(i < 2) 1)%N.
Global Instance drift_concrete : concrete_system drift.
Proof. by split=> //; apply/eqP => /matrixP/(_ 0 1); rewrite !mxE !eqxx; apply/eqP; rewrite oner_eq0. Qed.
Notation drift_at_rest := (observer_loop N2 (integrated drift) (fun=> 0) (idle nI) *m
  col_mx (col_mx e1 0) (col_mx 0 0) + col_mx (col_mx 0 (- r1)) 0 = 0).
Lemma drift_rest : drift_at_rest.
Proof.
rewrite observer_idle (_ : \mxcol_i (_ *m (_ *m 0)) = 0); last by rewrite -[RHS]mxcol0; apply: eq_mxcol => i; rewrite !mulmx0.
rewrite /= /integrated_A mul_block_col !mul0mx !addr0 mul_delta_mx_cond mulr0n.
by rewrite !add_col_mx !addr0 subrr !col_mx0.
Qed.
Example wrong_estimates_example : drift_at_rest /\ exists j, block_of R nI j *m (0 : 'cV[R]_(\sum_(i < 2) nI)) != col_mx e1 0
  := conj drift_rest (wrong_estimates (i := ord0) erefl drift_outputs drift_rest).
Notation less j := ((- (j.+1)%:R)%:M : 'cV[R]_1).
Lemma pair_against (i : 'I_2) : mcB pair i *m less i = - (mcA pair *m delta_mx i 0).
Proof.
rewrite mul_mx_scalar scaleNr; congr (- _); apply/colP => a; rewrite /= mul_diag_mx !mxE.
by case: (a =P i) => [->|] //; rewrite /= !mulr0.
Qed.
Notation units := (\mxcol_i delta_mx i 0 : 'cV[R]_(\sum_(i < 2) 2)).
Notation pair_at_rest := (observer_loop N2 pair (fun=> 0) (idle 2) *m col_mx (const_mx 1) (col_mx units 0) +
  col_mx (\sum_j mcB pair j *m less j) (col_mx (\mxcol_j (mcB pair j *m less j)) 0) = 0).
Lemma pair_rest : pair_at_rest.
Proof.
have ones : const_mx 1 = \sum_i delta_mx i 0 :> 'cV[R]_2.
  apply/colP => i; rewrite summxE mxE (bigD1 i) //= big1 => [|j ji]; first by rewrite mxE !eqxx addr0.
  by rewrite mxE eq_sym (negPf ji).
rewrite observer_idle !add_col_mx -mxcolD (_ : \mxcol_i (_ + _) = 0); last first.
  rewrite -[RHS]mxcol0; apply: eq_mxcol => i; by rewrite block_mxcol pair_against subrr.
rewrite (eq_bigr _ (fun j _ => pair_against j)) sumrN -mulmx_sumr -ones subrr addr0.
by rewrite !col_mx0.
Qed.
Lemma others_act : \sum_(j | j != ord0) mcB pair j *m less j != 0.
Proof.
rewrite (big_pred1 (lift ord0 ord0 : 'I_2)) => [|j]; last by case: j => [[|[|]]].
rewrite pair_against oppr_eq0 /= mul_diag_mx; apply/eqP => /matrixP/(_ (lift ord0 ord0) 0); rewrite !mxE !eqxx mulr1.
by apply/eqP; rewrite pnatr_eq0.
Qed.
Example added_references_example : pair_at_rest /\ exists j, block_of R 2 j *m units != const_mx 1
  := conj pair_rest (added_references (i := ord0) (r := fun j => less j) erefl others_act pair_rest).

(* IV-A *)
Notation enlarged := (extended N3 one_each plant).
Notation none_fixed := (theorem_2 N3_own jc jo sc within_26).
Notation enlarged_connected := (extended_connected plant N3_own positive sc).
Notation ejc := (extended_jointly N3_own jc jo one_each).1.
Notation ejo := (extended_jointly N3_own jc jo one_each).2.
Notation unshared := (augmented_outputs N3 plant).
Global Instance augmented_concrete (K : fieldType) n m (p q : 'I_m -> nat) N (S : multichannel K n p q) :
  concrete_system S -> concrete_system (augmented_outputs N S).
Proof. by case=> n2 m2 A0; split. Qed.
Lemma unshared_fixed : fixed_over f unshared 1.
Proof. exact: (fixed_spectrum_dynamic unshared 1).2 (fun k D => example_not_stabilized D). Qed.
Lemma unshared_controllable : jointly_controllable unshared. Proof. exact: jc. Qed.
Lemma unshared_observable : jointly_observable unshared.
Proof.
apply/observableP => v h; apply: (observableP _ _ jo) => t; have := h t; rewrite /krylov /= => e.
rewrite /outputs mxcol_mul; apply/mxcolP => i; rewrite submxcol0 mxcolK in_setT.
move: e; rewrite {1}/outputs mxcol_mul => /(congr1 (fun M => submxcol M i)); rewrite submxcol0 mxcolK in_setT /=.
by move/outputs_eq0/(_ i (N3_own i)).
Qed.
Example fixed_spectrum_dynamic_example : forall k (D : controllers R p3 (fun=> \sum_(i < 3) q3 i)%N k),
  eigenvalue (map_mx f (dynamic_loop unshared D)) 1 := (fixed_spectrum_dynamic unshared 1).1 unshared_fixed.
Example fixed_spectrum_dynamic_enlarged : ~ (forall k (D : controllers R _ _ k),
  eigenvalue (map_mx f (dynamic_loop enlarged D)) 1) := fun h => none_fixed ((fixed_spectrum_dynamic enlarged 1).2 h).
Example every_rate_example : forall a : R, exists k (D : controllers R _ _ k), forall lambda : C,
  eigenvalue (map_mx f (dynamic_loop enlarged D)) lambda -> 'Re lambda <= f a := (every_rate enlarged).1 none_fixed.
Example every_rate_not : ~ (forall a : R, exists k (D : controllers R _ _ k), forall lambda : C,
  eigenvalue (map_mx f (dynamic_loop unshared D)) lambda -> 'Re lambda <= f a) :=
  fun h => (every_rate unshared).2 h 1 unshared_fixed.
Example every_rate_discrete_example : exists k (D : controllers R _ _ k), forall x t,
  (3 + \sum_(i < 3) 1 + \sum_i k i <= t)%N -> trajectories.trajectory (dynamic_loop enlarged D) x t = 0 :=
  (every_rate_discrete enlarged).1 (fun lambda fx => False_ind _ (none_fixed fx)).
Example every_rate_discrete_not : ~ exists k (D : controllers R _ _ k), forall x t,
  (3 + \sum_i k i <= t)%N -> trajectories.trajectory (dynamic_loop unshared D) x t = 0.
Proof. by move/(every_rate_discrete unshared).2/(_ 1 unshared_fixed)/eqP; rewrite oner_eq0. Qed.
Example proposition_2_example : exists s,
  [/\ s != set0, s != setT & (\rank (pencil (map_system f unshared) s 1) < 3)%N] :=
  (proposition_2 unshared_controllable unshared_observable 1).1 unshared_fixed.
Example proposition_2_none (lambda : C) : ~ exists s, [/\ s != set0, s != setT &
    (\rank (pencil (map_system f enlarged) s lambda) < 3 + \sum_(i < 3) 1)%N] :=
  fun h => none_fixed ((proposition_2 ejc ejo lambda).2 h).
Example footnote_example := footnote jc jo.
Example nothing_fixed_not : ~ (forall s (lambda : C), s != set0 -> s != setT ->
  eigenvalue (map_mx f (mcA unshared)) lambda -> (3 <= \rank (pencil (map_system f unshared) s lambda))%N) :=
  fun h => (nothing_fixed unshared_controllable unshared_observable).2 h 1 unshared_fixed.
Lemma enlarged_mode : eigenvalue (map_mx f (mcA enlarged)) 1.
Proof.
rewrite eigenvalue_root_char -map_char_poly -(rmorph1 f) fmorph_root /= /char_poly /char_poly_mx.
rewrite map_block_mx scalar_mx_block opp_block_mx add_block_mx !map_mx0 !oppr0 !addr0 det_ublock rootM.
have := mode_1; rewrite eigenvalue_root_char -map_char_poly -(rmorph1 f) fmorph_root.
by rewrite /char_poly /char_poly_mx => ->.
Qed.
Example nothing_fixed_example : (3 + \sum_(i < 3) 1 <= \rank (pencil (map_system f enlarged) [set agent 1] 1))%N :=
  (nothing_fixed ejc ejo).1 none_fixed [set agent 1] 1 s_not_0 s_not_T enlarged_mode.
Example one_channel_example := one_channel enlarged_connected none_fixed.
Example one_channel_assigns_example := one_channel_assigns enlarged_connected none_fixed.
Example partition_example := partition none_fixed.

(* IV-B *)
Example example_jointly_example : jointly_controllable plant /\ jointly_observable plant := example_jointly R.
Example example_rank_example : \rank (pencil (augmented_outputs N3 (example.plant Cf)) [set agent 1] 1) = 2%N := example_rank R.
Example example_fixed_example : fixed (augmented_outputs N3 (example.plant Cf)) 1 := @example_fixed R.
Example example_not_stabilized_example := @example_not_stabilized R.
Notation without_3 := (fun i : 'I_3 => (i != agent 2) : nat).
Lemma nothing_of_3 : without_3 (agent 2) = 0%N. Proof. by rewrite /= eqxx. Qed.
Example example_needs_agent_3_example : fixed (extended N3 without_3 (example.plant Cf)) 1 :=
  @example_needs_agent_3 R _ nothing_of_3.
Example example_extended_fixed_example : fixed (extended N3 without_3 plant) 1 := example_extended_fixed nothing_of_3.
Example example_one_scalar_example : ~ fixed (extended N3 one_scalar plant) 1 := @example_one_scalar Rf 1.

(* IV-C, IV-D *)
Example extended_jointly_example := extended_jointly N3_own jc jo one_each.
Example theorem_2_example : forall lambda : C, ~ fixed_over f (extended N3 one_each plant) lambda :=
  theorem_2 N3_own jc jo sc within_26.
Example bound_without_fixed_modes_example : (3 + \sum_(i < 3) 1 <=
    \rank (neighbor_pencil N3 (map_system f enlarged) [set agent 1] 1))%N :=
  bound_without_fixed_modes N3_own none_fixed [set agent 1] 1.
Lemma at_most_1 s (lambda : C) : eigenvalue (map_mx f (mcA plant)) lambda ->
  (3 - \rank (neighbor_pencil N3 (map_system f plant) s lambda) <= 1)%N.
Proof. by move=> _; rewrite map_example_neighbors; exact: example_bound. Qed.
Lemma lost_at_2 : (3 - \rank (neighbor_pencil N3 (map_system f plant) [set agent 1] 1) = 1)%N.
Proof.
apply/eqP; rewrite eqn_leq (at_most_1 _ mode_1) subn_gt0 map_example_neighbors.
rewrite /neighbor_pencil hear_agent2; have [c eC] := outputs_e2 Cf not_heard.
by rewrite ltnS; apply: rank_at_agent2 eC.
Qed.
Example bound_reached_example : forall k : 'I_3 -> nat, (forall i, i != agent 2 -> (1 <= k i)%N) ->
  (forall lambda : C, ~ fixed_over f (extended N3 k plant) lambda) -> (1 <= k (agent 2))%N.
Proof.
apply: (bound_reached N3_own jc jo (agent 2) sc (ltn0Sn 0) at_most_1).2.
by exists [set agent 1], 1; rewrite mode_1 around_agent_2 lost_at_2.
Qed.
Example bound_reached_by_2 : exists s (lambda : C), [/\ eigenvalue (map_mx f (mcA plant)) lambda,
    neighborhood N3 s :\: s = [set agent 2] & (3 - \rank (neighbor_pencil N3 (map_system f plant) s lambda) = 1)%N] :=
  (bound_reached N3_own jc jo (agent 2) sc (ltn0Sn 0) at_most_1).1 bound_reached_example.
Example gap_26_example : (3 - \rank (neighbor_pencil N3 (map_system f plant) [set agent 1] 1) <= relay_number N3 * 1)%N :=
  gap_26 N3_own (c := 1) none_fixed [set agent 1] 1.
Example gap_26_attained_example : exists n p q (S : multichannel R n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', (forall lambda : C, ~ fixed_over f (extended diamond4 (fun=> c') S) lambda) <-> (3 <= c')%N,
      exists s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda /\
        (n - \rank (neighbor_pencil diamond4 (map_system f S) s lambda) = relay_number diamond4 * 3)%N
    & forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
        (n - \rank (neighbor_pencil diamond4 (map_system f S) s lambda) <= relay_number diamond4 * 3)%N].
Proof. by apply: (gap_26_attained R (@diamond_hears 1)); rewrite two_relays. Qed.
Example tight_26_example : (3 - \rank (neighbor_pencil N3 (map_system f plant) [set agent 1] 1) <= 1)%N :=
  (tight_26 R N3_own).1 ring_relays _ _ _ plant 1%N jc jo none_fixed [set agent 1] 1 mode_1.
Example tight_26_not : ~ (forall n p q (S : multichannel R n p q) c, jointly_controllable S -> jointly_observable S ->
    (forall lambda : C, ~ fixed_over f (extended diamond4 (fun=> c) S) lambda) ->
    forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
    (n - \rank (neighbor_pencil diamond4 (map_system f S) s lambda) <= c)%N).
Proof. by move/(tight_26 R (@diamond_hears 1)).2; rewrite two_relays. Qed.
Lemma closed_full s (lambda : C) : any_graph.closed N3 s -> (3 <= \rank (pencil (map_system f plant) s lambda))%N.
Proof. by move: s lambda; apply: (some_dimensions_suffice plant N3_own).1; exists one_each; exact: none_fixed. Qed.
Example theorem_2_any_graph_example : forall lambda : C, ~ fixed_over f (extended N3 one_each plant) lambda :=
  theorem_2_any_graph N3_own (k := one_each) closed_full (fun i s lambda _ el => at_most_1 s el).
Example some_dimensions_suffice_example : exists k, forall lambda : C, ~ fixed_over f (extended N3 k plant) lambda :=
  (some_dimensions_suffice plant N3_own).2 closed_full.
Example some_dimensions_suffice_not : ~ exists k, forall lambda : C, ~ fixed_over f (extended alone3 k plant) lambda.
Proof.
move/(some_dimensions_suffice plant alone3_hears).1/(_ [set agent 1] 1 (alone3_closed _)).
have T0 : (agent 0) \notin [set agent 1] by rewrite !inE -val_eqE /= !inordK.
have [c eC] := outputs_e2 Cf T0; rewrite map_example leqNgt.
by rewrite /pencil /= ltnS (rank_at_agent2 eC).
Qed.
Example least_total_example : (\sum_(j < 1) 1 * (3 - \rank (neighbor_pencil N3 (map_system f plant) [set agent 1] 1)) <=
  \sum_(i < 3) 1)%N.
Proof.
apply: (least_total N3_own (y := fun _ : 'I_1 => 1%N) (s := fun=> [set agent 1]) (fun=> 1) _ none_fixed).
by move=> i; rewrite big_mkcond /= big_ord1; case: ifP.
Qed.
Example remark_2_observable_example := remark_2_observable N3_own jo one_each.
Example remark_2_example : forall lambda : C, ~ fixed_over f (extended_states N3 one_each plant) lambda :=
  remark_2 N3_own jc jo sc within_27.
Example remark_2_demands_more_example : bound_26 plant N3 one_each := remark_2_demands_more N3_own within_27.
Example gap_27_example : (3 - \rank (pencil (map_system f plant) [set agent 1] 1) <= boundary_number N3 * 1)%N :=
  gap_27 N3_own (c := 1) remark_2_example [set agent 1] 1.
Example gap_27_attained_example : exists n p q (S : multichannel R n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', (forall lambda : C, ~ fixed_over f (extended_states star3 (fun=> c') S) lambda) <-> (3 <= c')%N,
      exists s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda /\
        (n - \rank (pencil (map_system f S) s lambda) = boundary_number star3 * 3)%N
    & forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
        (n - \rank (pencil (map_system f S) s lambda) <= boundary_number star3 * 3)%N].
Proof. by apply: (gap_27_attained R (@star_hears 0)); rewrite boundary_number_star. Qed.
Example tight_27_not : ~ (forall n p q (S : multichannel R n p q) c, jointly_controllable S -> jointly_observable S ->
    (forall lambda : C, ~ fixed_over f (extended_states star3 (fun=> c) S) lambda) ->
    forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda -> (n - \rank (pencil (map_system f S) s lambda) <= c)%N).
Proof. by move/(tight_27 R (@star_hears 0)).2; rewrite boundary_number_star. Qed.
Example equations_28_to_30_example := equations_28_to_30 plant N3_own one_each [set agent 1].
Example connected_by_subsets_example : neighborhood N3 [set agent 1] :\: [set agent 1] != set0 :=
  (connected_by_subsets N3).1 sc [set agent 1] s_not_0 s_not_T.
Example connected_by_subsets_alone : ~ strongly_connected (neighbor_arc alone3).
Proof.
move/(connected_by_subsets alone3).1/(_ [set agent 1] s_not_0 s_not_T).
by rewrite (alone3_closed [set agent 1]) setDv eqxx.
Qed.
Example suitable_dimensions_example : (3 - \rank (neighbor_pencil N3 (map_system f plant) [set agent 1] 1) <=
    \sum_(i in neighborhood N3 [set agent 1] :\: [set agent 1]) 1)%N :=
  (suitable_dimensions plant N3_own one_each).1 none_fixed [set agent 1] 1 mode_1.
Example suitable_dimensions_not : ~ forall lambda : C, ~ fixed_over f (extended N3 without_3 plant) lambda.
Proof.
move/(suitable_dimensions plant N3_own without_3).1/(_ [set agent 1] 1 mode_1).
by rewrite lost_at_2 around_agent_2 big_set1 eqxx.
Qed.

(* IV-E *)
Lemma hears_next : neighbor_arc N3 (next (agent 0)) (agent 0) || transfer_arc plant (next (agent 0)) (agent 0).
Proof. by rewrite /neighbor_arc !inE eqxx orbT. Qed.
Example proposition_3_example := proposition_3 N3_own positive hears_next.
Example extended_connected_example := extended_connected plant N3_own positive sc.
Example corollary_1_printed_example : exists l (D : controllers R _ _ l), char_poly (dynamic_loop enlarged D) = 'X^12.
Proof.
apply: (corollary_1_printed three N3_own jc jo sc within_26); rewrite ?monicXn // size_polyXn.
by rewrite !big_ord_recl big_ord0.
Qed.
Example corollary_1_example := corollary_1 N3_own jc jo enlarged_connected sc within_26.
Example corollary_1_positive_example := corollary_1_positive N3_own jc jo positive sc within_26.
Example corollary_1_rate_example := corollary_1_rate N3_own jc jo (-1) sc within_26.
Example equation_31_example := equation_31 N3_own jc jo positive sc within_26.
Example equation_31_almost_all_example := equation_31_almost_all N3_own jc jo positive sc within_26.

(* V *)
Example lifted_graph_example := lifted_graph N3_own own_at_once positive hears_next.
Example theorem_3_example : ~ fixed_over f (lifted N3 one_each late plant) 1 :=
  theorem_3 N3_own jc jo (d := late) sc within_26 (oner_neq0 _).
Example theorem_3_nonzero_example : ~ fixed_over f (lifted N3 one_each late plant) 1 :=
  theorem_3_nonzero N3_own jc jo (d := late) sc (fun i s lambda s0 sT _ el => within_26 i s0 sT el) (oner_neq0 _).
Example lifted_rank_example := lifted_rank plant N3 one_each late [set agent 1] (oner_neq0 [ringType of C]).
Example lifted_assignment_example := lifted_assignment N3_own jc jo own_at_once positive (agent 0) sc within_26.
Example corollary_2_example := corollary_2 N3_own jc jo late sc within_26.
Example held_jointly_example := held_jointly N3_own jc jo one_each late.
Example theorem_4_example : forall lambda : C, ~ fixed_over f (held N3 one_each late plant) lambda :=
  theorem_4 N3_own jc jo (d := late) sc within_27.
Example held_rank_example := held_rank plant N3_own one_each late [set agent 1].
Lemma union_connected : strongly_connected (fun j i => neighbor_arc N3 j i || transfer_arc plant j i).
Proof. by apply: strongly_connected_sub sc => j i ->. Qed.
Example held_graph_example : strongly_connected (transfer_arc (held N3 one_each late plant)) :=
  (held_graph plant N3 late positive).2 union_connected.
Example held_assignment_example := held_assignment N3_own jc jo late positive sc within_27.
End Reproduction.
