(* Every theorem about delays applied to a concrete system, with every hypothesis discharged; every
   equivalence to one system on each side.  The systems are those of instances_paper.v. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel neighbor_graph extended extended_bound feedback.
From mcexact Require Import delayed_systems held lifted delays delayed_transfer instances_paper.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* delays.v: a step of delay between different agents *)
Definition delay (i j : 'I_2) : nat := (i != j).
Example rank_held_open := rank_held (share 1) delay all_hear_self opened [set ord0] 0.
Example rank_lifted_open := rank_lifted all_hear (share 1) delay (oner_neq0 Q) opened [set ord0].
Example theorem_3_open : forall lambda, lambda != 0 ->
  ~ fixed_over f (lifted all_hear (share 1) delay opened) lambda.
Proof.
apply: (theorem_3 (k := share 1) (d := delay) all_hear_self all_strongly_connected
         (open_controllable Q) (open_observable Q)) => i s lambda _ _ _; exact: leq_subr.
Qed.
Example theorem_4_open : forall lambda,
  ~ fixed_over f (held all_hear (share 1) delay opened) lambda.
Proof.
apply: (theorem_4 (k := share 1) (d := delay) all_hear_self all_strongly_connected
         (open_controllable Q) (open_observable Q)) => i s lambda _ _ _; exact: leq_subr.
Qed.
Example held_fixed_iff_yes : fixed_over f (held all_hear (share 0) delay opened) 0 :=
  (held_fixed_iff f (share 0) delay all_hear_self opened 0).2 silent_states_fixed.
Example held_fixed_iff_no : ~ fixed_over f (extended_states all_hear (share 1) opened) 0 :=
  fun h => theorem_4_open ((held_fixed_iff f (share 1) delay all_hear_self opened 0).2 h).

Example held_not_fixed_yes : forall s : {set 'I_2}, (1 - \rank (pencil opened s 0%R)
    <= \sum_(i in neighborhood all_hear s :\: s) 1)%N.
Proof.
apply: (held_not_fixed (share 1) delay all_hear_self opened 0).1 => h.
by apply: (@theorem_4_open 0) => F; have := h F; rewrite -(eigenvalue_map f) rmorph0.
Qed.
Example held_not_fixed_no : ~ ~ fixed (held none_hear (share 1) delay opened) 0 :=
  fun h => alone_deficient 0 ((held_not_fixed (share 1) delay none_hear_self opened 0).1 h [set ord0]).

(* A = 1: a fixed eigenvalue that is not 0 *)
Definition shifted : multichannel Q 1 one one := Multichannel 1%:M (mcB opened) (mcC opened).

Lemma shifted_pencil : (\rank (pencil shifted [set ord0] 1) < 1)%N.
Proof.
have := open_pencil Q; rewrite /pencil /= raddf0 !subrr; congr (\rank (block_mx _ _ _ _) < _)%N.
Qed.
Lemma shifted_deficient : ~ (1 - \rank (neighbor_pencil none_hear shifted [set ord0] 1)
  <= \sum_(i in neighborhood none_hear [set ord0] :\: [set ord0]) 1)%N.
Proof.
have -> : neighbor_pencil none_hear shifted [set ord0] 1 = pencil shifted [set ord0] 1.
  by rewrite /neighbor_pencil none_hears_nothing.
rewrite none_hears_nothing setDv big_set0 leqn0 subn_eq0 leqNgt.
by rewrite shifted_pencil.
Qed.
Lemma shifted_fixed : fixed_over f (extended none_hear (share 1) shifted) 1.
Proof.
move=> F; rewrite -(rmorph1 f) eigenvalue_map; apply: contraT => nn; exfalso.
apply: shifted_deficient; apply: (extended_not_fixed (share 1) none_hear_self shifted 1).1 => h.
by have := h F; rewrite (negPf nn).
Qed.
Example lifted_fixed_iff_yes : fixed_over f (lifted none_hear (share 1) delay shifted) 1 :=
  (lifted_fixed_iff f (share 1) delay none_hear_self shifted (oner_neq0 _)).2 shifted_fixed.
Example lifted_fixed_iff_no : ~ fixed_over f (extended all_hear (share 1) opened) 1 :=
  fun h => theorem_3_open (oner_neq0 _)
    ((lifted_fixed_iff f (share 1) delay all_hear_self opened (oner_neq0 _)).2 h).
Example lifted_not_fixed_no : ~ ~ fixed (lifted none_hear (share 1) delay shifted) 1 :=
  fun h => shifted_deficient
    ((lifted_not_fixed none_hear (share 1) delay (oner_neq0 Q) shifted).1 h [set ord0]).
Example lifted_not_fixed_yes : forall s : {set 'I_2},
    (1 - \rank (neighbor_pencil all_hear opened s 1%R)
    <= \sum_(i in neighborhood all_hear s :\: s) 1)%N.
Proof.
apply: (lifted_not_fixed all_hear (share 1) delay (oner_neq0 Q) opened).1 => h.
apply: (@theorem_3_open 1 (oner_neq0 _)) => F.
by have := h F; rewrite -(eigenvalue_map f) rmorph1.
Qed.

(* delayed_transfer.v *)
Example lifted_arcs_open : transfer_arc (lifted all_hear (share 1) delay opened) (lift ord0 ord0) ord0.
Proof. by apply: (lifted_arcs all_hear_self) => //; rewrite /neighbor_arc inE. Qed.
Example lifted_strongly_connected_open :
    strongly_connected (transfer_arc (lifted all_hear (share 1) delay opened)).
Proof.
apply: (lifted_strongly_connected opened all_hear_self) => //.
  by move=> i; rewrite /delay eqxx.
exact: all_strongly_connected.
Qed.
Example held_arcs_yes : transfer_arc (held all_hear (share 1) delay opened) (lift ord0 ord0) ord0.
Proof. by apply/held_arcs => //; rewrite /neighbor_arc inE. Qed.
Lemma nothing_to_first j : ~~ (neighbor_arc none_hear j ord0 || transfer_arc opened j ord0) || (j == ord0).
Proof.
have [->|j0] := eqVneq j ord0; first by rewrite orbT.
rewrite orbF negb_or /neighbor_arc inE j0; apply/transfer_arcP => -[t].
by rewrite /= raddf0 mul0mx eqxx.
Qed.
Example held_arcs_no : ~ transfer_arc (held none_hear (share 1) delay opened) (lift ord0 ord0) ord0.
Proof.
move/(held_arcs (k := share 1) none_hear delay opened ord0 isT).1.
by have := nothing_to_first (lift ord0 ord0); rewrite orbF => /negP.
Qed.
Example held_strongly_connected_yes :
    strongly_connected (transfer_arc (held all_hear (share 1) delay opened)).
Proof.
apply/held_strongly_connected => // j i; apply: connect1.
by rewrite /neighbor_arc inE.
Qed.
Example held_strongly_connected_no :
    ~ strongly_connected (transfer_arc (held none_hear (share 1) delay opened)).
Proof.
move/(held_strongly_connected (k := share 1) none_hear delay opened (fun=> isT)).1.
move/strongly_connectedP/(_ _ proper0 properT) => [j [i [a]]]; rewrite !inE => j0 /eqP ei.
by move: a (nothing_to_first j); rewrite ei => ->; rewrite (negPf j0).
Qed.
