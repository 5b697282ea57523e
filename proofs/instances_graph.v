(* The strong components of concrete graphs on two nodes: one arc, and both. *)
From mathcomp Require Import all_ssreflect.
From mcexact Require Import strong_components.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.

Notation a := (ord0 : 'I_2). Notation b := (lift ord0 ord0 : 'I_2).
Definition one_way : rel 'I_2 := fun j i => (j == a) && (i == b).
Definition both_ways : rel 'I_2 := fun j i => j != i.

Lemma both_ways_connected j i : connect both_ways j i.
Proof. by have [->|ji] := eqVneq j i; [exact: connect0 | exact: connect1]. Qed.
Lemma one_way_not_back : ~~ connect one_way b a.
Proof.
by apply/negP => /connectP[[|k w]] //= /andP[/andP[]].
Qed.

Lemma inst_closure_yes : closure one_way a b.
Proof. by rewrite closure_connect connect1. Qed.
Lemma inst_closure_no : ~~ closure one_way b a.
Proof. by rewrite closure_connect one_way_not_back. Qed.
Lemma inst_component_yes : b \in component both_ways a.
Proof. by rewrite component_rule !both_ways_connected. Qed.
Lemma inst_component_no : b \notin component one_way a.
Proof. by rewrite component_rule negb_and one_way_not_back orbT. Qed.
Lemma inst_strongly_connected : (#|[set component both_ways j | j : 'I_2]| <= 1)%N.
Proof. by apply/strongly_connected_rule; apply: both_ways_connected. Qed.
Lemma inst_not_strongly_connected : ~ (#|[set component one_way j | j : 'I_2]| <= 1)%N.
Proof. by move/strongly_connected_rule/(_ b a); apply/negP/one_way_not_back. Qed.
(* One arc: each node by itself, the first one before the second. *)
Lemma inst_ordered (j i : 'I_2) : connect one_way j i && connect one_way i j = (j == i).
Proof.
rewrite (@ordered_components _ (fun _ _ => false) one_way (fun k => k : nat)) => [//|//| |j' i' /ord_inj->].
- by move=> j' i' ij; apply/negP => /andP[/eqP jE /eqP iE]; rewrite jE iE in ij.
- exact: connect0.
Qed.
(* In the other order the arc leads back. *)
Lemma inst_order_needed : ~ (forall j i : 'I_2, (1 - i < 1 - j)%N -> ~~ one_way j i).
Proof. by move/(_ a b isT)/negP; apply. Qed.
