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

(* The transitive closure: agent i receives from every j from which a path leads to i. *)
Definition closure (i : 'I_m) : {set 'I_m} := [set j | connect [rel a b | b \in N a] i j].

Lemma closure_closed s : closed (neighborhood closure s).
Proof.
apply/eqP; rewrite eqEsubset sub_neighborhood // andbT; apply/bigcupsP => j /bigcupP[i si].
rewrite inE => ij; apply/subsetP => k jk; apply/bigcupP; exists i => //.
by rewrite inE; apply: connect_trans ij _; exact: connect1.
Qed.

Lemma closed_closure s : closed s -> neighborhood closure s = s.
Proof.
move=> cl; apply/eqP; rewrite eqEsubset; apply/andP; split; last first.
  by apply/subsetP => i si; apply/bigcupP; exists i; rewrite // inE connect0.
apply/bigcupsP => i si; apply/subsetP => j; rewrite inE => /connectP[path].
elim: path i si => [|a path IH] i si /=; first by move=> _ ->.
by case/andP => ia; apply: IH; rewrite -cl; apply/bigcupP; exists i.
Qed.

Lemma rank_augmented (M : 'I_m -> {set 'I_m}) s (lambda : L) :
  \rank (pencil (map_system f (augmented_outputs M S)) s lambda) = \rank (neighbor_pencil M (map_system f S) s lambda).
Proof.
rewrite /pencil /neighbor_pencil; apply: rank_block_eq => //.
apply: eqmx_trans (eqmx_outputs _ _) _; apply: eqmx_trans (eqmx_sym (eqmx_outputs _ _)).
apply: eqmx_trans (span_bigcup _ _ _); apply: span_eqmx => i _ /=.
by rewrite map_outputs; apply: eqmx_outputs.
Qed.

(* However much the agents share, a mode stays iff it is fixed where every agent has the outputs of all agents
   from which a path leads to it; and then the others do not control it, and some closed set does not observe it. *)
Theorem any_sharing (lambda : L) :
  (forall k, fixed_over f (extended N k S) lambda) <-> fixed_over f (augmented_outputs closure S) lambda.
Proof.
rewrite anderson_clements_over; split=> [stays|[s]].
  have := stays (fun=> n); rewrite fixed_over_extended anderson_clements => -[s].
  rewrite rank_extended // addnAC ltn_add2r => low.
  have [/eqP cl|open] := boolP (neighborhood N s == s).
    exists s; rewrite rank_augmented /neighbor_pencil closed_closure //.
    by apply: leq_ltn_trans low; rewrite /neighbor_pencil cl leq_addr.
  have /set0Pn[i bi] : neighborhood N s :\: s != set0 by rewrite boundary0.
  have enough : (n <= \sum_(j in neighborhood N s :\: s) n)%N by rewrite (bigD1 i) //= leq_addr.
  by have := leq_ltn_trans (leq_trans enough (leq_addl _ _)) low; rewrite ltnn.
rewrite rank_augmented => low k; apply/fixed_over_extended; apply/anderson_clements.
exists (neighborhood closure s); rewrite rank_extended // addnAC ltn_add2r.
have cl := closure_closed s; rewrite cl setDv big_set0 addn0 /neighbor_pencil cl.
have /submxP[D] : ((inputs (map_system f S) (~: neighborhood closure s))^T <= (inputs (map_system f S) (~: s))^T)%MS.
  rewrite eqmx_inputs (eqmx_inputs _ (~: s)) /input_space !trmxK; apply/sumsmx_subP => j outside.
  apply: (sumsmx_sup j) => //; move: outside; rewrite !inE; apply: contra => sj.
  by apply/bigcupP; exists j; rewrite // inE connect0.
move/(congr1 trmx); rewrite trmx_mul !trmxK => ->; apply: leq_ltn_trans low.
set T := map_system f S; set C := outputs T _.
have -> : block_mx (lambda%:M - mcA T) (inputs T (~: s) *m D^T) C 0 =
    block_mx (lambda%:M - mcA T) (inputs T (~: s)) C 0 *m block_mx 1%:M 0 0 D^T.
  by rewrite mulmx_block !mulmx1 !mulmx0 !mul0mx !addr0 !add0r.
exact: mxrankM_maxl.
Qed.
End AnyGraph.
