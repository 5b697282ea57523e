(* checker/structure.py and checker/core/reach.py: kind `neighbor_graph`, and the strong components of `transfer_graph`
   and `assignability`.

   The recursion of Roy and Warshall: start from j -> j and the arcs, and for one node k after the other
   let every node that reaches k reach what k reaches.  The order of the nodes does not matter. *)
From mathcomp Require Import all_ssreflect.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.

Section Closure.
Variable m : nat.
Implicit Types (e r : rel 'I_m).

Definition start e : rel 'I_m := fun j i => (j == i) || e j i.
Definition through r k : rel 'I_m := fun j i => r j i || r j k && r k i.
Definition closure e : rel 'I_m := foldl through (start e) (enum 'I_m).

Lemma closure_sound e ks r : (forall j i, r j i -> connect e j i) ->
  forall j i, foldl through r ks j i -> connect e j i.
Proof.
elim: ks r => [//|k ks IH] r sound; apply: IH => j i /orP[/sound//|/andP[/sound jk /sound]].
exact: connect_trans.
Qed.

(* Nothing is reached through k that is not reached already. *)
Definition done r k := forall j i, r j k -> r k i -> r j i.

Lemma through_done r k : done (through r k) k.
Proof.
by move=> j i /orP[jk|/andP[jk _]] /orP[ki|/andP[_ ki]]; rewrite /through jk ki orbT.
Qed.

Lemma through_keeps r k k' : done r k' -> done (through r k) k'.
Proof.
move=> d j i; rewrite /through => /orP[jk'|/andP[jk kk']] /orP[k'i|/andP[k'k ki]].
- by rewrite (d _ _ jk' k'i).
- by rewrite (d _ _ jk' k'k) ki orbT.
- by rewrite jk (d _ _ kk' k'i) orbT.
- by rewrite jk ki orbT.
Qed.

Lemma closure_done ks r k : k \in ks \/ done r k -> done (foldl through r ks) k.
Proof.
elim: ks r k => [|k' ks IH] r k /=; first by case.
rewrite inE => -[/orP[/eqP->|kks]|d]; apply: IH; [|by left|].
  by right; apply: through_done.
by right; apply: through_keeps.
Qed.

Lemma closure_grows ks r j i : r j i -> foldl through r ks j i.
Proof. by elim: ks r => [//|k ks IH] r ji; apply: IH; rewrite /through ji. Qed.

(* The recursion finds exactly what a path reaches. *)
Theorem closure_connect e j i : closure e j i = connect e j i.
Proof.
apply/idP/idP => [|/connectP[w]].
  by apply: closure_sound => a b /orP[/eqP->//|]; apply: connect1.
elim: w j => [j _ ->|k w IH j /= /andP[jk kw] iw]; first by apply: closure_grows; rewrite /start eqxx.
have d : done (closure e) k by apply: closure_done; left; rewrite mem_enum.
by apply: d (IH _ kw iw); apply: closure_grows; rewrite /start jk orbT.
Qed.

(* What j reaches ahead and behind, by the recursion on the arcs and on the arcs turned around. *)
Definition component e j : {set 'I_m} := [set i | closure e j i && closure (fun a b => e b a) j i].

Theorem component_rule e j i : (i \in component e j) = connect e j i && connect e i j.
Proof.
have turned : connect (fun a b => e b a) j i = connect e i j := connect_rev e j i.
by rewrite inE !closure_connect turned.
Qed.

(* Kind `neighbor_graph`: at most one component is strong connectivity. *)
Theorem strongly_connected_rule e :
  (#|[set component e j | j : 'I_m]| <= 1)%N <-> (forall j i, connect e j i).
Proof.
split=> [/card_le1_eqP one j i | sc].
  have inC k : component e k \in [set component e k | k : 'I_m] by apply: imset_f.
  have /setP/(_ i) := one _ _ (inC j) (inC i).
  by rewrite !component_rule connect0 /=; case: (connect e j i).
apply/card_le1_eqP => _ _ /imsetP[j _ ->] /imsetP[i _ ->].
by apply/setP => k; rewrite !component_rule !sc.
Qed.
(* Kind `assignability`: edges that connect each part, and parts in an order in which no edge leads back. *)
Theorem ordered_components e r (at_ : 'I_m -> nat) : (forall j i, e j i -> r j i) ->
  (forall j i, (at_ i < at_ j)%N -> ~~ r j i) -> (forall j i, at_ j = at_ i -> connect e j i) ->
  forall j i, connect r j i && connect r i j = (at_ j == at_ i).
Proof.
move=> er back within j i.
have up a b : connect r a b -> (at_ a <= at_ b)%N.
  move=> /connectP[w]; elim: w a => [a _ ->//|c w IH a /= /andP[ac cw] bw].
  by apply: leq_trans (IH c cw bw); rewrite leqNgt; apply: contraL ac; apply: back.
apply/andP/eqP => [[/up le /up ge]|same]; first by apply/eqP; rewrite eqn_leq le.
have sub a b : connect e a b -> connect r a b by apply: connect_sub => x y /er; apply: connect1.
by split; apply: sub; apply: within.
Qed.
End Closure.
