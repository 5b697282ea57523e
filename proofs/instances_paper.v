(* Every theorem about the paper applied to a concrete system, with every hypothesis discharged;
   every equivalence to one system on each side.

   Two channels, one state, A = 0, over Q with eigenvalues among the algebraic numbers:
   open: B = (1, 0), C = (0, 1), jointly controllable and observable, 0 is fixed;
   free: B = (1, 1), C = (1, 1), nothing is fixed.
   Neighbor graphs: everybody hears everybody, or nobody hears anybody else. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability.
From mcexact Require Import neighbor_graph extended_bound gain_lines sequential_gains feedback.
From mcexact Require Import corfmat_morse error_system free_assignment verdict example.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation f := [rmorphism of (ratr : rat -> algC)].
Notation one := (fun _ : 'I_2 => 1%N).

Definition open_system (K : fieldType) : multichannel K 1 one one :=
  Multichannel 0 (fun i => (i == ord0)%:R%:M) (fun i => (i != ord0)%:R%:M).
Definition free_system (K : fieldType) : multichannel K 1 one one :=
  Multichannel 0 (fun i => 1%:M) (fun i => 1%:M).
Definition all_hear (i : 'I_2) : {set 'I_2} := setT.
Definition none_hear (i : 'I_2) : {set 'I_2} := [set i].

Lemma all_hear_self i : i \in all_hear i. Proof. by rewrite inE. Qed.
Lemma none_hear_self i : i \in none_hear i. Proof. by rewrite inE. Qed.

Lemma infinite_rat : infinite [fieldType of rat].
Proof. exact/char0_infinite/char_num. Qed.

Lemma other : lift ord0 ord0 != ord0 :> 'I_2. Proof. by []. Qed.

Lemma all_strongly_connected : strongly_connected (neighbor_arc all_hear).
Proof. by move=> j i; apply: connect1; rewrite /neighbor_arc inE. Qed.

Lemma proper0 : [set ord0 : 'I_2] != set0.
Proof. by apply/set0Pn; exists ord0; rewrite inE. Qed.
Lemma properT : [set ord0 : 'I_2] != setT.
Proof. by apply/eqP => /setP/(_ (lift ord0 ord0)); rewrite !inE. Qed.

Lemma none_hears_nothing (s : {set 'I_2}) : neighborhood none_hear s = s.
Proof.
apply/setP => i; apply/bigcupP/idP => [[j js]|si]; first by rewrite inE => /eqP ->.
by exists i; rewrite ?inE.
Qed.

Lemma none_not_strongly_connected : ~ strongly_connected (neighbor_arc none_hear).
Proof.
move/neighborhood_strongly_connected/(_ _ proper0 properT).
by rewrite none_hears_nothing setDv eqxx.
Qed.

Section Facts.
Variable K : fieldType.

Lemma free_loop (F : gains K one one) : closed_loop (free_system K) F = F ord0 + F (lift ord0 ord0).
Proof.
rewrite /closed_loop /= add0r big_ord_recl big_ord1 /=.
by rewrite !mul1mx !mulmx1.
Qed.

Lemma open_loop (F : gains K one one) : closed_loop (open_system K) F = 0.
Proof.
rewrite /closed_loop /= add0r big_ord_recl big_ord1 /=.
by rewrite mulr0n mulr1n raddf0 mulmx0 !mul0mx addr0.
Qed.

Lemma eigenvalue0 : eigenvalue (0 : 'M[K]_1) 0.
Proof. by rewrite eigenvalue_rank raddf0 subr0 mxrank0. Qed.

Lemma open_fixed : fixed (open_system K) 0.
Proof. by move=> F; rewrite open_loop eigenvalue0. Qed.

Lemma scalar_eigenvalue (a b : K) : eigenvalue (a%:M : 'M_1) b = (a == b).
Proof.
rewrite eigenvalue_rank -raddfB /= rank_rV; have [->|ab] := eqVneq a b.
  by rewrite subrr raddf0 eqxx.
have -> // : (b - a)%:M != 0 :> 'M_1.
apply: contraNneq ab => /matrixP/(_ 0 0); rewrite !mxE eqxx => /eqP.
by rewrite subr_eq0 eq_sym.
Qed.

Lemma free_not_fixed lambda : ~ fixed (free_system K) lambda.
Proof.
move/(_ (fun i => if i == ord0 then (lambda + 1)%:M else 0)).
rewrite free_loop /= addr0 scalar_eigenvalue -subr_eq0 addrAC subrr add0r.
by rewrite oner_eq0.
Qed.

Lemma open_controllable : jointly_controllable (open_system K).
Proof.
apply/controllableP => w /(_ 0%N); rewrite /krylov /= /inputs mul_mxrow => /mxrowP/(_ ord0).
by rewrite mxrowK submxrow0 inE /= mulmx1.
Qed.

Lemma open_observable : jointly_observable (open_system K).
Proof.
apply/observableP => v /(_ 0%N); rewrite /krylov /= /outputs mxcol_mul.
move/mxcolP/(_ (lift ord0 ord0)).
by rewrite mxcolK submxcol0 inE /= mul1mx.
Qed.

Lemma free_controllable : jointly_controllable (free_system K).
Proof.
apply/controllableP => w /(_ 0%N); rewrite /krylov /= /inputs mul_mxrow => /mxrowP/(_ ord0).
by rewrite mxrowK submxrow0 inE /= mulmx1.
Qed.

Lemma free_observable : jointly_observable (free_system K).
Proof.
apply/observableP => v /(_ 0%N); rewrite /krylov /= /outputs mxcol_mul.
move/mxcolP/(_ ord0).
by rewrite mxcolK submxcol0 inE /= mul1mx.
Qed.

Lemma free_arcs : strongly_connected (transfer_arc (free_system K)).
Proof.
move=> j i; apply: connect1; apply/transfer_arcP; exists 0%N.
by rewrite /krylov /= mulmx1 -mxrank_eq0 mxrank1.
Qed.

(* s = {1}: neither its output nor the other channel's input does anything *)
Lemma open_pencil : (\rank (pencil (open_system K) [set ord0] 0) < 1)%N.
Proof.
rewrite /pencil /= raddf0 subr0.
have -> : inputs (open_system K) (~: [set ord0]) = 0.
  apply/mxrowP => i; rewrite mxrowK submxrow0 !inE /=.
  by case: eqVneq => //= _; rewrite raddf0.
have -> : outputs (open_system K) [set ord0] = 0.
  apply/mxcolP => i; rewrite mxcolK submxcol0 !inE /=.
  by case: eqVneq => //= _; rewrite raddf0.
by rewrite block_mx0 mxrank0.
Qed.

End Facts.

Lemma map_open : forall F : gains rat one one,
  map_mx f (closed_loop (open_system _) F) = 0.
Proof. by move=> F; rewrite open_loop map_mx0. Qed.

Lemma open_fixed_over : fixed_over f (open_system _) 0.
Proof. by move=> F; rewrite map_open eigenvalue0. Qed.

Lemma free_not_fixed_over lambda : ~ fixed_over f (free_system _) lambda.
Proof.
pose g := (if lambda == 0 then 1 else 0) : rat.
move/(_ (fun i => if i == ord0 then g%:M else 0)); rewrite free_loop /= addr0 map_scalar_mx /=.
rewrite scalar_eigenvalue /g; have [->|l0] := eqVneq lambda 0; first by rewrite rmorph1 oner_eq0.
by rewrite rmorph0 eq_sym (negPf l0).
Qed.

Notation Q := [fieldType of rat].
Notation opened := (open_system Q).
Notation free := (free_system Q).

(* rank_one_repair.v *)
Example max_rank_min_pencil_open := max_rank_min_pencil (mcB opened) (mcC opened) 0.

(* anderson_clements.v *)
Example rank_closed_loop_le_open := rank_closed_loop_le opened (fun=> 1%:M) setT 0.
Example rank_closed_loop_max_open := rank_closed_loop_max opened 0.
Example anderson_clements_easy_open : fixed opened 0 := anderson_clements_easy (open_pencil Q).
Example anderson_clements_yes : exists s, (\rank (pencil opened s 0%R) < 1)%N :=
  (anderson_clements opened 0).1 (@open_fixed Q).
Example anderson_clements_no : ~ exists s, (\rank (pencil free s 0%R) < 1)%N :=
  fun h => free_not_fixed ((anderson_clements free 0).2 h).
Example anderson_clements_over_yes :
    exists s, (\rank (pencil (map_system f opened) s 0%R) < 1)%N :=
  (anderson_clements_over f opened 0).1 open_fixed_over.
Example anderson_clements_over_no lambda :
    ~ exists s, (\rank (pencil (map_system f free) s lambda) < 1)%N :=
  fun h => free_not_fixed_over ((anderson_clements_over f free lambda).2 h).
Example fixed_over_fixed_yes : fixed (map_system f opened) 0 :=
  (fixed_over_fixed f opened 0).1 open_fixed_over.
Example fixed_over_fixed_no lambda : ~ fixed (map_system f free) lambda :=
  fun h => free_not_fixed_over ((fixed_over_fixed f free lambda).2 h).
Example anderson_clements_proper_yes : exists s,
    [/\ s != set0, s != setT & (\rank (pencil (map_system f opened) s 0%R) < 1)%N] :=
  (anderson_clements_proper (jointly_controllable_pencil f 0 (open_controllable Q))
     (jointly_observable_pencil f 0 (open_observable Q))).1 fixed_over_fixed_yes.
Example anderson_clements_proper_no lambda : ~ exists s,
    [/\ s != set0, s != setT & (\rank (pencil (map_system f free) s lambda) < 1)%N] :=
  fun h => fixed_over_fixed_no
    ((anderson_clements_proper (jointly_controllable_pencil f lambda (free_controllable Q))
       (jointly_observable_pencil f lambda (free_observable Q))).2 h).

(* joint_controllability.v *)
Example controllable_hautus_open lambda := controllable_hautus f lambda (open_controllable Q).
Example observable_hautus_open lambda := observable_hautus f lambda (open_observable Q).
Example proposition_2_yes : exists s,
    [/\ s != set0, s != setT & (\rank (pencil (map_system f opened) s 0%R) < 1)%N] :=
  (proposition_2 f 0 (open_controllable Q) (open_observable Q)).1 open_fixed_over.
Example proposition_2_no lambda : ~ exists s,
    [/\ s != set0, s != setT & (\rank (pencil (map_system f free) s lambda) < 1)%N] :=
  fun h => free_not_fixed_over
    ((proposition_2 f lambda (free_controllable Q) (free_observable Q)).2 h).

(* neighbor_graph.v *)
Example neighborhood_strongly_connected_yes : forall s : {set 'I_2}, s != set0 -> s != setT ->
    neighborhood all_hear s :\: s != set0 :=
  (neighborhood_strongly_connected all_hear).1 all_strongly_connected.
Example neighborhood_strongly_connected_no := none_not_strongly_connected.

(* extended.v and extended_bound.v *)
Notation share c := (fun _ : 'I_2 => c%N).
Example rank_extended_open := rank_extended (share 1) all_hear_self opened [set ord0] 0.
Example rank_extended_states_open := rank_extended_states (share 1) all_hear_self opened [set ord0] 0.

(* one shared scalar each, everybody hears everybody: nothing is fixed *)
Lemma one_is_enough (S : multichannel Q 1 one one) : jointly_controllable S ->
  jointly_observable S -> forall lambda, ~ fixed_over f (extended_states all_hear (share 1) S) lambda.
Proof.
move=> jc jo; apply: (remark_2 all_hear_self all_strongly_connected jc jo) => i s lambda _ _ _.
exact: leq_subr.
Qed.
Example remark_2_open := one_is_enough (open_controllable Q) (open_observable Q).
Example theorem_2_open : forall lambda, ~ fixed_over f (extended all_hear (share 1) opened) lambda.
Proof.
apply: (theorem_2 all_hear_self all_strongly_connected (open_controllable Q) (open_observable Q)).
by move=> i s lambda _ _ _; apply: leq_subr.
Qed.

Example extended_no_fixed_yes := (extended_no_fixed f (share 1) all_hear_self opened).1 theorem_2_open.
Example extended_states_no_fixed_yes :=
  (extended_states_no_fixed f (share 1) all_hear_self opened).1 remark_2_open.

(* nobody hears anybody: 0 stays fixed, whatever is shared *)
Lemma alone_deficient : forall lambda : Q, ~ (1 - \rank (pencil opened [set ord0] 0)
  <= \sum_(i in neighborhood none_hear [set ord0] :\: [set ord0]) 1)%N.
Proof.
move=> _; rewrite none_hears_nothing setDv big_set0 leqn0 subn_eq0 leqNgt.
by rewrite open_pencil.
Qed.
Example extended_states_not_fixed_no : ~ ~ fixed (extended_states none_hear (share 1) opened) 0 :=
  fun h => alone_deficient 0
    ((extended_states_not_fixed (share 1) none_hear_self opened 0).1 h [set ord0]).
Example extended_not_fixed_no : ~ ~ fixed (extended none_hear (share 1) opened) 0.
Proof.
move/(extended_not_fixed (share 1) none_hear_self opened 0).1/(_ [set ord0]).
have -> : neighbor_pencil none_hear opened [set ord0] 0 = pencil opened [set ord0] 0.
  by rewrite /neighbor_pencil none_hears_nothing.
exact: (alone_deficient 0).
Qed.

Lemma extended_drop (N : 'I_2 -> {set 'I_2}) (c : nat) : (forall i, i \in N i) ->
  (\sum_(i in neighborhood N [set ord0] :\: [set ord0]) c = 0)%N ->
  (\rank (pencil (extended_states N (share c) opened) [set ord0] 0%R) < 1 + \sum_(i < 2) c)%N.
Proof.
move=> hN e; rewrite (rank_extended_states (share c) hN) e addn0 ltn_add2r.
exact: open_pencil.
Qed.

Lemma alone_states_fixed : fixed_over f (extended_states none_hear (share 1) opened) 0.
Proof.
have e : (\sum_(i in neighborhood none_hear [set ord0] :\: [set ord0]) 1 = 0)%N.
  by rewrite none_hears_nothing setDv big_set0.
have := anderson_clements_easy (extended_drop none_hear_self e) => h F.
have := h F; by rewrite -(eigenvalue_map f) rmorph0.
Qed.
Lemma silent_states_fixed : fixed_over f (extended_states all_hear (share 0) opened) 0.
Proof.
have e : (\sum_(i in neighborhood all_hear [set ord0] :\: [set ord0]) 0 = 0)%N by rewrite big1.
have := anderson_clements_easy (extended_drop all_hear_self e) => h F.
have := h F; by rewrite -(eigenvalue_map f) rmorph0.
Qed.

(* everybody hears everybody, and nothing is shared: 0 stays fixed *)
Example extended_states_no_fixed_no : ~ (forall s (lambda : algC),
    eigenvalue (map_mx f (mcA opened)) lambda -> (deficiency_states f opened s lambda
      <= \sum_(i in neighborhood all_hear s :\: s) 0)%N) :=
  fun h => (extended_states_no_fixed f (share 0) all_hear_self opened).2 h 0 silent_states_fixed.
Example extended_states_not_fixed_yes : forall s : {set 'I_2}, (1 - \rank (pencil opened s 0%R)
    <= \sum_(i in neighborhood all_hear s :\: s) 1)%N.
Proof.
apply: (extended_states_not_fixed (share 1) all_hear_self opened 0).1 => h.
by apply: (@remark_2_open 0) => F; have := h F; rewrite -(eigenvalue_map f) rmorph0.
Qed.
Example extended_not_fixed_yes : forall s : {set 'I_2},
    (1 - \rank (neighbor_pencil all_hear opened s 0%R)
    <= \sum_(i in neighborhood all_hear s :\: s) 1)%N.
Proof.
apply: (extended_not_fixed (share 1) all_hear_self opened 0).1 => h.
by apply: (@theorem_2_open 0) => F; have := h F; rewrite -(eigenvalue_map f) rmorph0.
Qed.
Lemma alone_outputs_fixed : fixed_over f (extended none_hear (share 1) opened) 0.
Proof.
move=> F; have := extended_not_fixed_no; case E : (eigenvalue _ _) => // nn; exfalso; apply: nn => h.
by have := h F; rewrite -(eigenvalue_map f) rmorph0 E.
Qed.
Example extended_no_fixed_no : ~ (forall s (lambda : algC),
    eigenvalue (map_mx f (mcA opened)) lambda -> (deficiency f none_hear opened s lambda
      <= \sum_(i in neighborhood none_hear s :\: s) 1)%N) :=
  fun h => (extended_no_fixed f (share 1) none_hear_self opened).2 h 0 alone_outputs_fixed.
Example deficiency_le_open s lambda := deficiency_le f all_hear_self opened s lambda.
Example proposition_3_open : transfer_arc (extended all_hear (share 1) opened) (lift ord0 ord0) ord0.
Proof. by apply: (proposition_3 all_hear_self) => //; rewrite /neighbor_arc inE. Qed.
Example proposition_3_strongly_connected_open :
    strongly_connected (transfer_arc (extended all_hear (share 1) opened)) :=
  proposition_3_strongly_connected (k := share 1) all_hear_self opened (fun=> isT) all_strongly_connected.

(* gain_lines.v *)
Example generic_rank_line := generic_rank ('X%:M : 'M[{poly rat}]_1) 1.
Lemma index_one : controllability_index (0 : 'M[rat]_1) (1%:M : 'M_1) 1.
Proof.
split=> [|[] // _].
  apply/eqP/rank_reachP => w /(_ 0%N isT); by rewrite /krylov /= mulmx1.
by apply: leq_ltn_trans (rank_leq_col _) _; rewrite big_ord0.
Qed.
Example lemma_3_polynomial_one := lemma_3_polynomial (1%:M : 'M[rat]_1) index_one.1.
Example lemma_3_one := lemma_3 (1%:M : 'M[rat]_1) index_one.
Example lemma_3_index_one := lemma_3_index (1%:M : 'M[rat]_1) index_one erefl.

(* corfmat_morse.v *)
Example corfmat_morse_free := corfmat_morse infinite_rat (free_arcs Q) free_not_fixed_over.
Example corfmat_morse_controllable_free : exists F, controllable (closed_loop free F) (mcB free ord0).
Proof.
apply: (corfmat_morse_controllable (f := f) infinite_rat (free_arcs Q)) => lambda; exists (fun=> 0).
by apply/uncontrollable_modeP => -[w [/eqP w0 _]]; rewrite /= map_mx1 mulmx1 => /w0.
Qed.

(* error_system.v: both agents hear each other, no feedback *)
Definition no_feedback (i : 'I_2) : 'M[rat]_(1, 1) := 0.
Example lemma_1_controllable_open := @lemma_1_controllable _ _ _ _ _ all_hear opened no_feedback.
Example lemma_1_observable_open :=
  lemma_1_observable no_feedback all_strongly_connected (open_observable Q).
Example lemma_2_scalars_two := lemma_2_scalars f infinite_rat all_strongly_connected.
Example lemma_2_two := lemma_2 f infinite_rat all_strongly_connected (isT : (0 < 1)%N).
Example lemma_4_open := lemma_4 f infinite_rat all_strongly_connected (isT : (0 < 1)%N)
  opened no_feedback (fun=> 0).
Example proposition_1_open := proposition_1 f infinite_rat all_strongly_connected (isT : (0 < 1)%N)
  no_feedback (open_observable Q).

(* one scalar channel that the input reaches *)
Example sequential_gains_one : exists2 A', True & controllable A' (1%:M : 'M[rat]_1).
Proof.
have one0 : (1%:M : 'M[rat]_1) != 0 by rewrite -mxrank_eq0 mxrank1.
apply: (sequential_gains (f := f) (Q := fun=> True) infinite_rat
         (cs := [:: (1%:M, 1%:M)]) (ls := [::]) (A := 0)) => //.
  by move=> gc; rewrite inE => /eqP ->; exists 0%N; rewrite // /krylov /= mulmx1.
move=> lambda; rewrite /uncontrollable_mode controllable_hautus ?ltnn //.
by apply/controllableP => w /(_ 0%N); rewrite /krylov /= mulmx1.
Qed.

(* free_assignment.v *)
Example extended_jointly_controllable_open :=
  @extended_jointly_controllable _ _ _ _ _ all_hear (share 1) opened (open_controllable Q).
Example extended_jointly_observable_open :=
  extended_jointly_observable (share 1) all_hear_self (open_observable Q).
Example extended_states_jointly_observable_open :=
  extended_states_jointly_observable (share 1) all_hear_self (open_observable Q).
Example corollary_1_gains_open : exists F, forall o : 'I_2,
  controllable (closed_loop (extended all_hear (share 1) opened) F)
    (mcB (extended all_hear (share 1) opened) o) /\
  controllable (closed_loop (extended all_hear (share 1) opened) F)^T
    (mcC (extended all_hear (share 1) opened) o)^T.
Proof.
apply: (corollary_1_gains (f := f) infinite_rat all_hear_self all_strongly_connected
  (open_controllable Q) (open_observable Q)) => // i s lambda _ _ _; exact: leq_subr.
Qed.
Example corfmat_morse_converse_free : strongly_connected (transfer_arc free) /\
    (forall lambda : algC, ~ fixed_over f free lambda).
Proof. by have [F h] := corfmat_morse_free; apply: corfmat_morse_converse h. Qed.
Example corfmat_morse_iff_yes : exists F, forall o : 'I_2,
    controllable (closed_loop free F) (mcB free o) /\ controllable (closed_loop free F)^T (mcC free o)^T :=
  (corfmat_morse_iff f infinite_rat free isT isT).1 (conj (free_arcs Q) free_not_fixed_over).
Example corfmat_morse_iff_no : ~ exists F, forall o : 'I_2,
    controllable (closed_loop opened F) (mcB opened o) /\ controllable (closed_loop opened F)^T (mcC opened o)^T :=
  fun h => ((corfmat_morse_iff f infinite_rat opened isT isT).2 h).2 0 open_fixed_over.

(* verdict.v *)
Example check_shrunk_fixed_example :=
  @verdict.check_shrunk_fixed _ [fieldType of algC] verdict.example_verdict.
Example example_fixed_algC : fixed (verdict.system_of verdict.example_certificate algCfield) 1 :=
  @verdict.example_fixed _.

(* example.v: one scalar of agents 1 and 2, none of agent 3 *)
Definition without_agent_3 (i : 'I_3) : nat := (i != inord 2).
Example example_mss_fixed_algC : fixed (augmented_outputs N3 (plant algCfield)) 1 :=
  @example_mss_fixed _.
Example example_one_scalar_algC : ~ fixed (extended N3 one_scalar (plant algCfield)) 1 :=
  @example_one_scalar _ 1.
Example example_extended_fixed_algC : fixed (extended N3 without_agent_3 (plant algCfield)) 1.
Proof. by apply: example_extended_fixed; rewrite /without_agent_3 eqxx. Qed.
