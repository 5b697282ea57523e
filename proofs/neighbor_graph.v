(* The neighbor graph has an arc from j to i iff j is in N i.  It is strongly connected iff no
   nonempty proper s hears nothing from outside: N_s \ s is nonempty. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section StronglyConnected.
Variable (m : nat).
Implicit Types (e : rel 'I_m) (N : 'I_m -> {set 'I_m}) (s : {set 'I_m}).

Definition strongly_connected e := forall j i, connect e j i.
Definition neighbor_arc N : rel 'I_m := fun j i => j \in N i.

(* no set is closed under arcs that enter it *)
Lemma strongly_connectedP e :
  strongly_connected e <->
  (forall s, s != set0 -> s != setT -> exists j i, [/\ e j i, j \notin s & i \in s]).
Proof.
split=> [sc s s0 sT|h a b]; last first.
  pose s := [set j | connect e j b].
  have [sT|/(h s) []] := eqVneq s setT.
  - by have := in_setT a; rewrite -sT inE.
  - by apply/set0Pn; exists b; rewrite inE.
  by move=> j [i []]; rewrite !inE => eji /negP nj ib; case: nj; apply: connect_trans (connect1 eji) ib.
have /set0Pn[b sb] := s0.
have /set0Pn[a] : ~: s != set0 by rewrite -setCT (inj_eq (can_inj (@setCK _))).
rewrite inE => sa; have /connectP[w] := sc a b.
elim: w a sa => [|c w IH] a sa /=; first by move=> _ eb; rewrite -eb sb in sa.
case/andP=> eac pw eb; have [sc'|sc'] := boolP (c \in s); first by exists a, c.
exact: IH pw eb.
Qed.

Theorem neighborhood_strongly_connected N :
  strongly_connected (neighbor_arc N) <->
  (forall s, s != set0 -> s != setT -> neighborhood N s :\: s != set0).
Proof.
rewrite strongly_connectedP; split=> h s s0 sT.
  have [j [i [Nji sj si]]] := h s s0 sT; apply/set0Pn; exists j; rewrite inE sj.
  by apply/bigcupP; exists i.
have /set0Pn[j] := h s s0 sT; rewrite inE => /andP[sj /bigcupP[i si Nji]].
by exists j, i.
Qed.

Lemma strongly_connected_sub e e' : subrel e e' -> strongly_connected e -> strongly_connected e'.
Proof. by move=> ee sc j i; apply: connect_sub (sc j i) => x y /ee; apply: connect1. Qed.

End StronglyConnected.
