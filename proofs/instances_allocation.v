(* The rules for the least to share, the arcs to add, and set-points, applied to concrete systems with
   every hypothesis discharged. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph allocation setpoint.
From mcexact Require Import extended shared_dimensions instances.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* One variable, one cut n >= 1: the tree is one leaf with multiplier 1. *)
Lemma inst_branch_tree x : covers (fun _ : 'I_1 => setT) (fun=> 1%N) x -> 1 <= cost (fun _ : 'I_1 => 1) x.
Proof.
apply: (@branch_tree _ _ (fun _ : 'I_1 => setT) (fun=> 1%N) (fun=> 1) 1 1 (fun=> 0%N) (fun=> None)
  (Multipliers _ (fun=> 1))) => //.
- by move=> _; exists 1.
- by exists 1.
rewrite /= /leaf /bound /part /reduced; apply/andP; split.
  by apply/andP; split; apply/forallP => i; rewrite ?ler01// big_ord1_cond inE subrr lexx.
by rewrite !big_ord1 big_ord1_cond inE subrr lexx mul0r addr0 mulr1 invr1 ltr_addl ltr01.
Qed.
Lemma inst_infeasible (x : 'I_1 -> nat) : (x ord0 <= 0)%N -> ~ covers (fun _ : 'I_1 => setT) (fun=> 1%N) x.
Proof.
move=> x0; apply: (@branch_tree_infeasible _ _ (fun _ : 'I_1 => setT) (fun=> 1%N) (fun=> 0%N)
  (fun=> Some 0%N) (Violated _ ord0)).
  by rewrite /= /violated big1 // andbT; apply/forall_inP.
by move=> i; split=> // u [<-]; rewrite ord1.
Qed.

(* Two channels, A = 0, B = (0, 1), C = (1, 0), T = {1}: whatever the first hears, 0 stays fixed. *)
Notation pair := (fun _ : 'I_2 => 1%N).
Definition cut_off : multichannel rat 1 pair pair :=
  Multichannel 0 (fun j => (j != ord0)%:R%:M) (fun i => (i == ord0)%:R%:M).
Definition heard (i : 'I_2) : 'M[rat]_(2, 1) := if i == ord0 then const_mx 1 else 0.
Lemma shrunk_cut_off : shrunk cut_off 0 [set ord0] (1%:M : 'M_1) 0.
Proof.
split=> [|i]; first by rewrite mulmx0 mulmx1 /= raddf0 subrr.
by rewrite inE => /negPf i0; rewrite /= i0 mulmx1 raddf0.
Qed.
Lemma inputs_cut_off : inputs cut_off [set ord0] = 0.
Proof.
apply/mxrowP=> i; rewrite mxrowK submxrow0 !inE /=.
by case: eqVneq => // _; rewrite raddf0.
Qed.
Lemma inst_communication_cut : fixed (Multichannel 0 (mcB cut_off) heard) 0.
Proof.
apply: (communication_cut shrunk_cut_off (mxrank1 _ 1)); first by rewrite inputs_cut_off mxrank0.
by move=> i; rewrite inE /heard => /negPf ->; rewrite mul0mx.
Qed.

(* The same system, s = {2}: when nobody shares anything, or nobody hears anybody, 0 stays fixed and nothing
   passes to the second channel. *)
Notation b := (lift ord0 ord0 : 'I_2).
Notation all_hear := (fun _ : 'I_2 => [set: 'I_2]).
Notation none_hear := (fun i : 'I_2 => [set i]).
Lemma all_hear_self (i : 'I_2) : i \in all_hear i. Proof. by rewrite inE. Qed.
Lemma none_hear_self (i : 'I_2) : i \in none_hear i. Proof. by rewrite inE. Qed.
Lemma not_b (i : 'I_2) : i != b -> i = ord0.
Proof. by case: i => -[|[|]] //= ? _; apply: val_inj. Qed.
Lemma inputs_other q (C : forall i : 'I_2, 'M_(q i, 1)) : inputs (Multichannel 0 (mcB cut_off) C) (~: [set b]) = 0.
Proof.
apply/mxrowP=> i; rewrite mxrowK submxrow0 !inE; case: eqVneq => // /not_b -> /=.
by rewrite raddf0.
Qed.
Lemma shrunk_other q (C : forall i : 'I_2, 'M_(q i, 1)) : C b = 0 ->
  shrunk_subspace (Multichannel 0 (mcB cut_off) C) 'X (~: [set b]) 1.
Proof.
move=> Cb; apply: (@shrunk_by_inputs _ _ _ _ _ _ _ _ _ 1 1%:M 0 id).
- rewrite mulmx0 subr0 mulmx1 => i j; rewrite !mxE rmorph0 subr0 !ord1 eqxx; exact: dvdpp.
- by move=> i; rewrite !inE negbK => /eqP-> /= j l; rewrite Cb map_mx0 mul0mx mxE dvdp0.
- move=> i j; rewrite !mxE subrr; exact: dvdp0.
- by rewrite inputs_other mxrank0.
Qed.
Lemma outputs_b : outputs cut_off [set b] = 0.
Proof.
apply/mxcolP=> i; rewrite mxcolK submxcol0 !inE; case: eqVneq => // -> /=.
by rewrite raddf0.
Qed.
Lemma few (k : 'I_2 -> nat) (N : 'I_2 -> {set 'I_2}) : (forall i, i \in neighborhood N [set b] :\: [set b] -> k i = 0%N) ->
  (\sum_(i in neighborhood N [set b] :\: [set b]) k i < 1)%N.
Proof. by move=> z; rewrite big1. Qed.
Lemma none_boundary i : i \in neighborhood none_hear [set b] :\: [set b] -> 1%N = 0%N.
Proof. by rewrite /neighborhood big_set1 setDv inE. Qed.
Lemma inst_dimensions_cut_states :
  fixed (extended_states all_hear (fun=> 0%N) (map_system h (Multichannel 0 (mcB cut_off) (mcC cut_off)))) 0.
Proof.
apply: (dimensions_cut_states all_hear_self root0 (few _) (shrunk_other _)) => //.
by rewrite /= raddf0.
Qed.
Lemma inst_dimensions_cut_outputs : fixed (extended none_hear pair (map_system h cut_off)) 0.
Proof.
apply: (dimensions_cut_outputs none_hear_self root0 (few none_boundary)).
exact: (shrunk_other outputs_b).
Qed.
Lemma zero_other q (C : forall i : 'I_2, 'M_(q i, 1)) :
  zero_transfer (Multichannel 0 (mcB cut_off) C) (~: [set b]) [set b].
Proof.
apply: (@ZeroTransfer _ _ _ _ _ _ _ _ 0 0 (fun i : 'I_0 => ord0)) => [|j|i _]; rewrite ?mulmx0 ?mul0mx//.
by rewrite !inE => /not_b -> /=; rewrite raddf0.
Qed.
Lemma b_not_empty : [set b] != set0. Proof. by apply/set0Pn; exists b; rewrite inE. Qed.
Lemma b_not_all : [set b] != setT. Proof. by apply/eqP => /setP/(_ ord0); rewrite !inE. Qed.
Lemma inst_connection_cut_states : ~ strongly_connected (extended_states all_hear (fun=> 0%N) cut_off).
Proof. by apply: connection_cut_states b_not_empty b_not_all _ => //; apply: zero_other. Qed.
Lemma inst_connection_cut_outputs : ~ strongly_connected (extended none_hear pair cut_off).
Proof. by apply: connection_cut_outputs none_boundary b_not_empty b_not_all _; apply: zero_other. Qed.

(* Three agents in a chain: the first measures, the third drives, each hears the one before it.  The third
   is one dimension short; one dimension for each agent is the least that is enough. *)
Notation near := (lift ord0 ord0 : 'I_3).
Notation far := (lift ord0 (lift ord0 ord0) : 'I_3).
Notation three := (fun _ : 'I_3 => 1%N).
Definition relay : multichannel rat 1 three three :=
  Multichannel 0 (fun j => (j == far)%:R%:M) (fun i => (i == ord0)%:R%:M).
Definition chain (i : 'I_3) : {set 'I_3} := if i == ord0 then [set ord0] else if i == near then [set ord0; near] else [set near; far].
Lemma chain_self i : i \in chain i.
Proof. by rewrite /chain; case: i => -[|[|[|]]] //= ?; rewrite !inE. Qed.
Lemma inputs_relay (t : {set 'I_3}) : far \notin t -> inputs (map_system h relay) (~: t) != 0.
Proof.
move=> ft; apply/eqP => /(congr1 (fun M => submxrow M far)); rewrite submxrow0 mxrowK inE ft /= map_mx1 => /matrixP/(_ 0 0)/eqP.
by rewrite !mxE oner_eq0.
Qed.
Lemma outputs_relay (t : {set 'I_3}) : ord0 \in t -> outputs (map_system h relay) t != 0.
Proof.
move=> t0; apply/eqP => /(congr1 (fun M => submxcol M ord0)); rewrite submxcol0 mxcolK t0 /= map_mx1 => /matrixP/(_ 0 0)/eqP.
by rewrite !mxE oner_eq0.
Qed.
Lemma enough a b (M : 'M[algC]_1) (B : 'M_(1, a)) (C : 'M_(b, 1)) (t : {set 'I_3}) :
  [|| B != 0, C != 0 | neighborhood chain t :\: t != set0] ->
  (1 - \rank (block_mx M B C 0) <= \sum_(i in neighborhood chain t :\: t) 1)%N.
Proof.
rewrite sum1_card -card_gt0 orbA => /orP[nz|]; last by apply: leq_trans; apply: leq_subr.
rewrite (leq_trans _ (leq0n _))// leqn0 subn_eq0 lt0n mxrank_eq0.
by apply: contraTneq nz => /eqP; rewrite block_mx_eq0 => /and4P[_ /eqP-> /eqP-> _]; rewrite !eqxx.
Qed.
Lemma chain_near (t : {set 'I_3}) : near \in t -> ord0 \in neighborhood chain t.
Proof. by move=> nt; apply/bigcupP; exists near; rewrite // /chain !inE. Qed.
Lemma chain_far (t : {set 'I_3}) : far \in t -> near \in neighborhood chain t.
Proof. by move=> ft; apply/bigcupP; exists far; rewrite // /chain !inE. Qed.
Lemma frees_relay : frees chain relay h 1.
Proof.
move=> lambda; apply/(extended_not_fixed _ chain_self) => t; apply: enough.
have [ft|/inputs_relay->//] := boolP (far \in t).
have [/outputs_relay->|t0] := boolP (ord0 \in neighborhood chain t); first by rewrite orbT.
apply/orP; right; apply/orP; right; apply/set0Pn; exists near; rewrite inE chain_far// andbT.
by apply: contra t0 => /chain_near.
Qed.
Lemma frees_states_relay : frees_states chain relay h 1.
Proof.
move=> lambda; apply/(extended_states_not_fixed _ chain_self) => t; apply: enough.
have [ft|/inputs_relay->//] := boolP (far \in t).
have [/outputs_relay->|t0] := boolP (ord0 \in t); first by rewrite orbT.
apply/orP; right; apply/orP; right; apply/set0Pn.
have [nt|nt] := boolP (near \in t); first by exists ord0; rewrite inE t0 chain_near.
by exists near; rewrite inE nt chain_far.
Qed.

(* s = {3}: the first two have no input, and the third does not see the first. *)
Lemma inputs_far q (C : forall i : 'I_3, 'M_(q i, 1)) : inputs (Multichannel 0 (mcB relay) C) (~: [set far]) = 0.
Proof.
apply/mxrowP=> i; rewrite mxrowK submxrow0 !inE /=; case: eqVneq => // _.
by rewrite raddf0.
Qed.
Lemma shrunk_far q (C : forall i : 'I_3, 'M_(q i, 1)) : C far = 0 ->
  shrunk_subspace (Multichannel 0 (mcB relay) C) 'X (~: [set far]) 1.
Proof.
move=> Cb; apply: (@shrunk_by_inputs _ _ _ _ _ _ _ _ _ 1 1%:M 0 id).
- rewrite mulmx0 subr0 mulmx1 => i j; rewrite !mxE rmorph0 subr0 !ord1 eqxx; exact: dvdpp.
- by move=> i; rewrite !inE negbK => /eqP-> /= j l; rewrite Cb map_mx0 mul0mx mxE dvdp0.
- move=> i j; rewrite !mxE subrr; exact: dvdp0.
- by rewrite inputs_far mxrank0.
Qed.
Lemma far_hears_nothing : outputs relay (chain far) = 0.
Proof.
apply/mxcolP=> i; rewrite mxcolK submxcol0 /chain !inE /=; case: ifP => // /orP[]/eqP->; by rewrite raddf0.
Qed.
Lemma none_left k : (#|neighborhood chain [set far] :\: [set far]| * 0 < k.+1)%N. Proof. by rewrite muln0. Qed.
Lemma inst_common_dimension_outputs k : frees chain relay h k <-> (0 < k)%N.
Proof.
apply: (common_dimension_outputs chain_self root0 _ (none_left 0) frees_relay k).
exact: (shrunk_far far_hears_nothing).
Qed.
Lemma inst_common_dimension_states k : frees_states chain relay h k <-> (0 < k)%N.
Proof.
apply: (common_dimension_states chain_self root0 _ (none_left 0) frees_states_relay k).
by rewrite -[relay]/(Multichannel 0 (mcB relay) (mcC relay)); apply: shrunk_far; rewrite /= raddf0.
Qed.
Lemma inst_frees_more : frees chain relay h 2. Proof. exact: (frees_more chain_self _ frees_relay). Qed.
Lemma inst_frees_states_more : frees_states chain relay h 2.
Proof. exact: (frees_states_more chain_self _ frees_states_relay). Qed.

(* The system of two agents, nobody hears anybody: no common dimension is enough. *)
Lemma none_around : neighborhood none_hear [set b] :\: [set b] = set0.
Proof. by rewrite /neighborhood big_set1 setDv. Qed.
Lemma inst_no_common_dimension_outputs k : ~ frees none_hear cut_off h k.
Proof.
have E : shrunk_subspace (augmented_outputs none_hear cut_off) 'X (~: [set b]) 1 by exact: (shrunk_other outputs_b).
exact: (no_common_dimension_outputs none_hear_self root0 E none_around isT).
Qed.
Lemma inst_no_common_dimension_states k : ~ frees_states none_hear cut_off h k.
Proof.
have E : shrunk_subspace (Multichannel 0 (mcB cut_off) (mcC cut_off)) 'X (~: [set b]) 1.
  by apply: shrunk_other; rewrite /= raddf0.
exact: (no_common_dimension_states none_hear_self root0 E none_around isT).
Qed.

(* Set-points. *)
Lemma inst_setpoint_rank : \rank (map_mx up (1%:M : 'M_1)) = 1%N.
Proof.
apply: (@setpoint_rank l6 _ h 1 1 1 1%:M 1%:M 1%:M 0 (fun=> ord0)) => //.
- by rewrite map_mx1 !mulmx1.
- by rewrite mul0mx.
- by apply/matrixP=> -[].
Qed.
Lemma inst_normal_rank : (\rank (map_mx (horner_eval 0%R) (0%R : 'M[{poly algC}]_1)) < 1)%N.
Proof.
apply: (@normal_rank_deficient _ 1 1 0 1%:M) => //; last by rewrite mulmx0.
by apply/eqP=> /matrixP/(_ 0 0)/eqP; rewrite !mxE oner_eq0.
Qed.

(* A = 0, B = 1 and two equal outputs: the same set-point for both can be held, different ones cannot. *)
Notation twice := (const_mx 1 : 'M[rat]_(2, 1)).
Definition difference : 'rV[rat]_2 := delta_mx 0 0 - delta_mx 0 1.
Lemma difference_twice : difference *m twice = 0.
Proof. by apply/matrixP=> i j; rewrite mxE big_ord_recl big_ord1 !mxE !ord1. Qed.
Lemma left_of_setpoint : row_mx 0 difference *m block_mx (0 : 'M_1) (1%:M : 'M_1) twice 0 = 0.
Proof. by rewrite mul_row_block !mul0mx mulmx0 difference_twice !addr0 row_mx0. Qed.
Lemma inst_setpoint_held : difference *m twice = 0.
Proof.
apply: (@setpoint_unreachable _ 1 1 2 0 1%:M twice 0 difference twice 1%:M 0 left_of_setpoint).
  by rewrite mulmx0 mul0mx addr0.
by rewrite mulmx1.
Qed.
Lemma inst_setpoint_unreachable : ~ exists x u : 'cV_1, 0 *m x + 1%:M *m u = 0 /\ twice *m x = delta_mx 0 0.
Proof.
case=> x [u [e r]]; have := setpoint_unreachable left_of_setpoint e r.
by move/matrixP/(_ 0 0)/eqP; rewrite mxE big_ord_recl big_ord1 !mxE.
Qed.
Lemma inst_setpoint_output_part : difference != 0.
Proof.
apply: (setpoint_output_part _ left_of_setpoint).
  by rewrite /uncontrollable_mode raddf0 subr0 rank_row_0mx mxrank1.
by apply/eqP => /matrixP/(_ 0 (rshift 1 0))/eqP; rewrite row_mxEr !mxE.
Qed.
