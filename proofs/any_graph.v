(* Theorem 2 over every neighbor graph.  A set s of agents is closed if it hears nobody outside, N_s = s.  Where the graph is
   strongly connected only the empty set and the set of all are closed, and these two stand for joint controllability and
   observability: so the theorems here contain Theorem 2. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph extended_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section AnyGraph.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variable N : 'I_m -> {set 'I_m}.
Hypothesis hears : forall i, i \in N i.
Variable S : multichannel K n p q.
Definition closed (s : {set 'I_m}) := neighborhood N s = s.

Lemma boundary0 (s : {set 'I_m}) : (neighborhood N s :\: s == set0) = (neighborhood N s == s).
Proof. by rewrite setD_eq0 eqEsubset sub_neighborhood ?andbT. Qed.

(* shared sub-states of some dimensions leave no mode fixed iff no closed set is deficient *)
Theorem some_dimensions_suffice :
  (exists k, forall lambda : L, ~ fixed_over f (extended N k S) lambda) <->
  (forall s (lambda : L), closed s -> (n <= \rank (pencil (map_system f S) s lambda))%N).
Proof.
split=> [[k free] s lambda cl|full].
  have := free lambda; rewrite fixed_over_extended extended_not_fixed // => /(_ s).
  by rewrite cl setDv big_set0 leqn0 subn_eq0 /neighbor_pencil cl.
exists (fun=> n) => lambda; apply/fixed_over_extended; apply/extended_not_fixed => // s.
have [/eqP cl|open] := boolP (neighborhood N s == s).
  suff /eqP -> : (n - \rank (neighbor_pencil N (map_system f S) s lambda) == 0)%N by [].
  by rewrite /neighbor_pencil cl subn_eq0; apply: full.
have /set0Pn[i bi] : neighborhood N s :\: s != set0 by rewrite boundary0.
by rewrite [X in (_ <= X)%N](bigD1 i) //= (leq_trans (leq_subr _ _)) // leq_addr.
Qed.

(* and then the largest deficiency of the other sets suffices for every agent, as (26) has it *)
Theorem theorem_2_any_graph k :
  (forall s (lambda : L), closed s -> (n <= \rank (pencil (map_system f S) s lambda))%N) ->
  (forall i s (lambda : L), ~ closed s -> eigenvalue (map_mx f (mcA S)) lambda -> (deficiency f N S s lambda <= k i)%N) ->
  forall lambda : L, ~ fixed_over f (extended N k S) lambda.
Proof.
move=> full enough; apply/(extended_no_fixed f k hears S) => s lambda el.
have [/eqP cl|open] := boolP (neighborhood N s == s).
  suff /eqP -> : (deficiency f N S s lambda == 0)%N by [].
  by rewrite /deficiency /neighbor_pencil cl subn_eq0; apply: full.
have /set0Pn[i bi] : neighborhood N s :\: s != set0 by rewrite boundary0.
rewrite [X in (_ <= X)%N](bigD1 i) //=; apply: leq_trans (leq_addr _ _); apply: enough => //; exact/eqP.
Qed.
End AnyGraph.
