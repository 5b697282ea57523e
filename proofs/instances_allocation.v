(* The rules for the least to share, the arcs to add, and set-points, applied to concrete systems with
   every hypothesis discharged. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph allocation setpoint.
From mcexact Require Import shared_dimensions instances.
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
move=> Cb; apply: (@ShrunkSubspace _ _ _ _ _ _ _ _ _ 1 1%:M 0 id).
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
