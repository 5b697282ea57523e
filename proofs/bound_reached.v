(* What the paper says of the bound of Theorem 2 in passing, in the form in which it holds.

   "In the special case when (1) has no fixed eigenvalues, this lower bound is zero": it is at most zero, since no rank is
   below n (bound_without_fixed_modes).

   "The lower bound is reached for every i iff for each i there is an s with N_s \ s = {i} of the least rank": true for a
   bound rho of at least 1 (bound_reached): agent a needs rho, the others having as many, iff such an s exists for a. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph extended_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Bound.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variable N : 'I_m -> {set 'I_m}.
Hypothesis hears : forall i, i \in N i.
Variable S : multichannel K n p q.
Notation no_fixed k := (forall lambda : L, ~ fixed_over f (extended N k S) lambda).
Notation delta := (deficiency f N S).
Notation mode lambda := (eigenvalue (map_mx f (mcA S)) lambda).

Theorem bound_without_fixed_modes : (forall lambda : L, ~ fixed_over f S lambda) ->
  forall s (lambda : L), (n <= \rank (neighbor_pencil N (map_system f S) s lambda))%N.
Proof.
move=> nofix s lambda; rewrite -subn_eq0 -leqn0.
apply: leq_trans (deficiency_le f hears S s lambda) _; rewrite leqn0 subn_eq0 leqNgt.
by apply/negP => low; apply: (nofix lambda); apply/anderson_clements_over; exists s.
Qed.

Hypotheses (controllable : jointly_controllable S) (observable : jointly_observable S).

Lemma deficiency_set0 lambda : delta set0 lambda = 0%N.
Proof.
rewrite /deficiency /neighbor_pencil neighborhood0 -/(pencil (map_system f S) set0 lambda).
by rewrite jointly_controllable_pencil // subnn.
Qed.

Lemma deficiency_setT lambda : delta setT lambda = 0%N.
Proof.
rewrite /deficiency /neighbor_pencil neighborhoodT // -/(pencil (map_system f S) setT lambda).
by rewrite jointly_observable_pencil // subnn.
Qed.

Variable rho : nat.
Hypothesis connected : strongly_connected (neighbor_arc N).
Hypothesis most : forall s (lambda : L), mode lambda -> (delta s lambda <= rho)%N.

(* agent a with less than rho suffices, the others having rho at least, iff every s with N_s \ s = {a} lacks less than rho *)
Theorem bound_not_reached a : (0 < rho)%N ->
  (exists k, [/\ (k a < rho)%N, forall i, i != a -> (rho <= k i)%N & no_fixed k]) <->
  (forall s (lambda : L), mode lambda -> neighborhood N s :\: s = [set a] -> (delta s lambda < rho)%N).
Proof.
move=> rho0; split=> [[k [ka _ free]] s lambda el e|less].
  apply: leq_ltn_trans ((extended_no_fixed f k hears S).1 free s lambda el) _.
  by rewrite e big_set1.
pose k i := if i == a then rho.-1 else rho.
have ka : k a = rho.-1 by rewrite /k eqxx.
exists k; split; first by rewrite ka prednK.
  by move=> i /negPf ia; rewrite /k ia.
apply/(extended_no_fixed f k hears S) => s lambda el.
have [->|s0] := eqVneq s set0; first by rewrite -/(delta set0 lambda) deficiency_set0.
have [->|sT] := eqVneq s setT; first by rewrite -/(delta setT lambda) deficiency_setT.
have [e|ne] := eqVneq (neighborhood N s :\: s) [set a].
  by rewrite e big_set1 ka -ltnS prednK //; apply: less.
have [i si ia] : exists2 i, i \in neighborhood N s :\: s & i != a.
  apply/exists_inP; apply: contraNT ne; rewrite negb_exists_in => /forall_inP only.
  have /set0Pn[j sj] := (neighborhood_strongly_connected N).1 connected s s0 sT.
  apply/eqP/setP => x; rewrite in_set1; apply/idP/eqP => [/only|->]; first by rewrite negbK => /eqP.
  by have := only j sj; rewrite negbK => /eqP <-.
apply: leq_trans (most s el) _.
by rewrite (bigD1 i) //= {1}/k (negPf ia) leq_addr.
Qed.

(* the same as the paper turns it: agent a cannot do with less than rho, the others having rho at least, iff some s with
   N_s \ s = {a} lacks rho; the eigenvalues of A are those of a list *)
Theorem bound_reached a (modes : seq L) : (0 < rho)%N -> (forall lambda : L, mode lambda -> lambda \in modes) ->
  (forall k, (forall i, i != a -> (rho <= k i)%N) -> no_fixed k -> (rho <= k a)%N) <->
  (exists s (lambda : L), [/\ mode lambda, neighborhood N s :\: s = [set a] & delta s lambda = rho]).
Proof.
move=> rho0 all; split=> [needs|[s [lambda [el e <-]]] k _ free]; last first.
  by apply: leq_trans ((extended_no_fixed f k hears S).1 free s lambda el) _; rewrite e big_set1.
pose at_ s lambda := [&& mode lambda, neighborhood N s :\: s == [set a] & delta s lambda == rho].
have [/existsP[s /hasP[lambda _ /and3P[el /eqP e /eqP d]]]|none] := boolP [exists s, has (at_ s) modes].
  by exists s, lambda.
have [|k [ka others free]] := (bound_not_reached a rho0).2; last by move: (needs k others free); rewrite leqNgt ka.
move=> s lambda el e; rewrite ltn_neqAle most // andbT; apply: contraNneq none => d.
by apply/existsP; exists s; apply/hasP; exists lambda; rewrite ?all // /at_ el e d !eqxx.
Qed.
End Bound.
