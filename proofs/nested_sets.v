(* The least total of shared sub-states by nested sets of agents.

   Dimensions n_i leave no mode fixed iff sum_{i in N_s \ s} n_i >= delta_s(lambda) for all s and lambda.  Give some of these
   inequalities multipliers y_j, so that no agent i stands around sets with multipliers of more than c_i in sum: then
   sum_j y_j delta_{s_j}(lambda_j) <= sum_i c_i n_i (total_at_least).  With c_i = 1 these are sets with disjoint
   boundaries.  The bound holds for all sets, eigenvalues and costs.

   Why nested sets are enough where one eigenvalue alone is deficient: delta_s is supermodular in s, because the rank of
   P_s is submodular (rank_submodular), and every agent is around s and t at least as often as around their union and
   intersection (boundary_submodular).  So two sets may be replaced by their union and intersection until all are nested,
   and nothing is lost (uncross).  Around nested sets an agent stands for a stretch of them (around_interval): a matrix of
   intervals, for which the linear program and its dual have integral solutions.  So the bound by nested sets is attained;
   this last step (Edmonds and Giles) is proved by hand, and no rule of the checker uses it. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph extended_bound.
From Coq Require Import Lia.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Total.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variable N : 'I_m -> {set 'I_m}.
Hypothesis hears : forall i, i \in N i.
Variable S : multichannel K n p q.
Variables (k c : 'I_m -> nat) (J : finType) (y : J -> nat) (s : J -> {set 'I_m}) (lambda : J -> L).
Hypothesis within_costs : forall i, (\sum_(j | i \in neighborhood N (s j) :\: s j) y j <= c i)%N.

Lemma weighted (depth : J -> nat) : (forall j, (depth j <= \sum_(i in neighborhood N (s j) :\: s j) k i)%N) ->
  (\sum_j y j * depth j <= \sum_i c i * k i)%N.
Proof.
move=> covers; apply: (@leq_trans (\sum_j \sum_(i in neighborhood N (s j) :\: s j) y j * k i)%N).
  by apply: leq_sum => j _; rewrite -big_distrr leq_mul2l covers orbT.
rewrite (exchange_big_dep xpredT) //=; apply: leq_sum => i _.
by rewrite -big_distrl leq_mul2r within_costs orbT.
Qed.

Theorem total_at_least : (forall lambda : L, ~ fixed_over f (extended N k S) lambda) ->
  (\sum_j y j * deficiency f N S (s j) (lambda j) <= \sum_i c i * k i)%N.
Proof.
move=> free; apply: weighted => j.
by have := free (lambda j); rewrite fixed_over_extended extended_not_fixed //; apply.
Qed.

Theorem total_at_least_states : (forall lambda : L, ~ fixed_over f (extended_states N k S) lambda) ->
  (\sum_j y j * deficiency_states f S (s j) (lambda j) <= \sum_i c i * k i)%N.
Proof.
move=> free; apply: weighted => j.
by have := free (lambda j); rewrite fixed_over_extended_states extended_states_not_fixed //; apply.
Qed.
End Total.

Section Submodular.
Variable L : fieldType.

Lemma pencil_submodular n p1 p2 p0 pu q1 q2 q0 qu (M : 'M[L]_n) (B1 : 'M_(n, p1)) (B2 : 'M_(n, p2)) (B0 : 'M_(n, p0))
    (Bu : 'M_(n, pu)) (C1 : 'M_(q1, n)) (C2 : 'M_(q2, n)) (C0 : 'M_(q0, n)) (Cu : 'M_(qu, n)) :
  (B0^T <= B1^T + B2^T)%MS -> (B1^T <= B0^T)%MS -> (B2^T <= B0^T)%MS -> (Bu^T <= B1^T)%MS -> (Bu^T <= B2^T)%MS ->
  (Cu :=: C1 + C2)%MS -> (C0 <= C1)%MS -> (C0 <= C2)%MS ->
  (\rank (block_mx M Bu Cu 0) + \rank (block_mx M B0 C0 0) <= \rank (block_mx M B1 C1 0) + \rank (block_mx M B2 C2 0))%N.
Proof.
move=> b0 b10 b20 bu1 bu2 cu c01 c02.
pose W p q (B : 'M_(n, p)) (C : 'M_(q, n)) := (preimage M C :&: kermx B)%MS.
have rW p q (B : 'M_(n, p)) (C : 'M_(q, n)) : (\rank (block_mx M B C 0) + \rank (W p q B C) = n + \rank C)%N := rank_pencil M B C.
have ker p p' (B : 'M[L]_(n, p)) (B' : 'M_(n, p')) r (U : 'M_(r, n)) : (B^T <= B'^T)%MS -> U *m B' = 0 -> U *m B = 0.
  by case/submxP=> D /(congr1 trmx); rewrite !trmxK trmx_mul trmxK => -> e; rewrite mulmxA e mul0mx.
have up : (W _ _ B1 C1 + W _ _ B2 C2 <= W _ _ Bu Cu)%MS.
  rewrite addsmx_sub; apply/andP; split; rewrite sub_capmx sub_preimage sub_kermx.
    have : (W _ _ B1 C1 <= W _ _ B1 C1)%MS by [].
    rewrite {2}/W sub_capmx sub_preimage sub_kermx => /andP[h /eqP g].
    by rewrite (ker _ _ _ _ _ _ bu1 g) eqxx andbT cu (submx_trans h) ?addsmxSl.
  have : (W _ _ B2 C2 <= W _ _ B2 C2)%MS by [].
  rewrite {2}/W sub_capmx sub_preimage sub_kermx => /andP[h /eqP g].
  by rewrite (ker _ _ _ _ _ _ bu2 g) eqxx andbT cu (submx_trans h) ?addsmxSr.
pose V := (W _ _ B1 C1 :&: W _ _ B2 C2)%MS; pose Z := M *m cokermx C0.
have V1 : (V *m M <= C1)%MS /\ V *m B1 = 0.
  by have := capmxSl (W _ _ B1 C1) (W _ _ B2 C2); rewrite {2}/W sub_capmx sub_preimage sub_kermx => /andP[h /eqP g].
have V2 : (V *m M <= C2)%MS /\ V *m B2 = 0.
  by have := capmxSr (W _ _ B1 C1) (W _ _ B2 C2); rewrite {2}/W sub_capmx sub_preimage sub_kermx => /andP[h /eqP g].
have VB0 : V *m B0 = 0.
  case/sub_addsmxP: b0 => -[D1 D2] /= /(congr1 trmx); rewrite trmxK linearD /= !trmx_mul !trmxK => ->.
  by rewrite mulmxDr !mulmxA V1.2 V2.2 !mul0mx addr0.
have down : (V :&: kermx Z <= W _ _ B0 C0)%MS.
  rewrite sub_capmx /preimage capmxSr /=.
  by rewrite sub_kermx; have /submxP[D ->] := capmxSl V (kermx Z); rewrite -mulmxA VB0 mulmx0.
have lost : (\rank (V *m Z) + \rank C0 <= \rank (C1 :&: C2)%MS)%N.
  have c0 : (C0 <= C1 :&: C2)%MS by rewrite sub_capmx c01.
  have vm : (V *m M <= C1 :&: C2)%MS by rewrite sub_capmx V1.1 V2.1.
  rewrite /Z mulmxA addnC -(rank_adds_coker (V *m M) (kermx_coker C0)).
  by apply: mxrankS; rewrite addsmx_sub vm.
have eV := mxrank_mul_ker V Z; have s1 := mxrank_sum_cap (W _ _ B1 C1) (W _ _ B2 C2).
have s2 := mxrank_sum_cap C1 C2; have ru := mxrankS up; have rd := mxrankS down.
have cuE : \rank Cu = \rank (C1 + C2)%MS by rewrite cu.
have e1 := rW _ _ B1 C1; have e2 := rW _ _ B2 C2; have e0 := rW _ _ B0 C0; have eu := rW _ _ Bu Cu.
rewrite -/V in s1.
move: cuE s1 s2 eV ru rd lost e1 e2 e0 eu.
set a1 := \rank (W _ _ B1 C1); set a2 := \rank (W _ _ B2 C2); set a0 := \rank (W _ _ B0 C0); set au := \rank (W _ _ Bu Cu).
set r1 := \rank (block_mx M B1 C1 0); set r2 := \rank (block_mx M B2 C2 0).
set r0 := \rank (block_mx M B0 C0 0); set ru' := \rank (block_mx M Bu Cu 0).
set w1 := \rank (_ + _)%MS; set w2 := \rank V; set w3 := \rank (C1 + C2)%MS; set w4 := \rank (C1 :&: C2)%MS.
set w5 := \rank (V *m Z); set w6 := \rank (V :&: kermx Z)%MS.
move: (\rank C1) (\rank C2) (\rank C0) (\rank Cu) => x1 x2 x0 xu.
rewrite -!plusE => cuE s1 s2 eV /leP ru /leP rd /leP lost e1 e2 e0 eu; apply/leP; lia.
Qed.
End Submodular.

Section Supermodular.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (S : multichannel L n p q) (lambda : L).
Implicit Types (s t T : {set 'I_m}).

Lemma inputs_sub T T' : T \subset T' -> ((inputs S T)^T <= (inputs S T')^T)%MS.
Proof.
move=> TT; apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB S) T)^T); first by rewrite eqmx_inputs.
apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB S) T')^T); last by rewrite eqmx_inputs.
by rewrite /input_space !trmxK; apply/sumsmx_subP => i Ti; apply: (sumsmx_sup i) => //; apply: (subsetP TT).
Qed.

Lemma inputs_union T T' : ((inputs S (T :|: T'))^T <= (inputs S T)^T + (inputs S T')^T)%MS.
Proof.
apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB S) (T :|: T'))^T); first by rewrite eqmx_inputs.
rewrite {1}/input_space trmxK; apply/sumsmx_subP => i; rewrite genmxE inE => /orP[h|h].
  apply: submx_trans (addsmxSl _ _); apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB S) T)^T); last by rewrite eqmx_inputs.
  by rewrite /input_space trmxK; apply: (sumsmx_sup i) => //; rewrite genmxE.
apply: submx_trans (addsmxSr _ _); apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB S) T')^T); last by rewrite eqmx_inputs.
by rewrite /input_space trmxK; apply: (sumsmx_sup i) => //; rewrite genmxE.
Qed.

Lemma outputs_sub T T' : T \subset T' -> (outputs S T <= outputs S T')%MS.
Proof. by move=> TT; rewrite !eqmx_outputs; apply: output_spaceS. Qed.

Lemma outputs_union T T' : (outputs S (T :|: T') :=: outputs S T + outputs S T')%MS.
Proof.
apply/eqmxP/andP; split; last by rewrite addsmx_sub !outputs_sub ?subsetUl ?subsetUr.
rewrite eqmx_outputs /output_space; apply/sumsmx_subP => i; rewrite genmxE inE => /orP[h|h].
  by apply: submx_trans (addsmxSl _ _); rewrite eqmx_outputs output_space_sup.
by apply: submx_trans (addsmxSr _ _); rewrite eqmx_outputs output_space_sup.
Qed.

Lemma neighborhoodS s T : s \subset T -> neighborhood N s \subset neighborhood N T.
Proof. by move=> sT; apply/bigcupsP => i si; apply: (bigcup_max i) => //; apply: (subsetP sT). Qed.
Lemma neighborhoodU s t : neighborhood N (s :|: t) = neighborhood N s :|: neighborhood N t.
Proof. by rewrite /neighborhood bigcup_setU. Qed.
Lemma neighborhoodI s t : neighborhood N (s :&: t) \subset neighborhood N s :&: neighborhood N t.
Proof. by rewrite subsetI !neighborhoodS // ?subsetIl ?subsetIr. Qed.

(* rank P_s(lambda) is submodular, with C_{N_s} and with C_s *)
Theorem rank_submodular s t :
  (\rank (neighbor_pencil N S (s :|: t) lambda) + \rank (neighbor_pencil N S (s :&: t) lambda) <=
   \rank (neighbor_pencil N S s lambda) + \rank (neighbor_pencil N S t lambda))%N.
Proof.
apply: pencil_submodular; rewrite ?setCU ?setCI ?neighborhoodU.
- exact: inputs_union.
- by apply: inputs_sub; apply: subsetUl.
- by apply: inputs_sub; apply: subsetUr.
- by apply: inputs_sub; apply: subsetIl.
- by apply: inputs_sub; apply: subsetIr.
- exact: outputs_union.
- by apply: outputs_sub; have := neighborhoodI s t; rewrite subsetI => /andP[].
- by apply: outputs_sub; have := neighborhoodI s t; rewrite subsetI => /andP[].
Qed.

Theorem rank_submodular_states s t :
  (\rank (pencil S (s :|: t) lambda) + \rank (pencil S (s :&: t) lambda) <=
   \rank (pencil S s lambda) + \rank (pencil S t lambda))%N.
Proof.
apply: pencil_submodular; rewrite ?setCU ?setCI.
- exact: inputs_union.
- by apply: inputs_sub; apply: subsetUl.
- by apply: inputs_sub; apply: subsetUr.
- by apply: inputs_sub; apply: subsetIl.
- by apply: inputs_sub; apply: subsetIr.
- exact: outputs_union.
- by apply: outputs_sub; apply: subsetIl.
- by apply: outputs_sub; apply: subsetIr.
Qed.

(* every agent is around s or t at least as often as around s u t and s n t *)
Theorem boundary_submodular (hears : forall i, i \in N i) s t i :
  ((i \in neighborhood N (s :|: t) :\: (s :|: t)) + (i \in neighborhood N (s :&: t) :\: (s :&: t)) <=
   (i \in neighborhood N s :\: s) + (i \in neighborhood N t :\: t))%N.
Proof.
have := subsetP (neighborhoodI s t) i; have := subsetP (sub_neighborhood hears s) i.
have := subsetP (sub_neighborhood hears t) i; rewrite neighborhoodU !inE.
case: (i \in s); case: (i \in t); case: (i \in neighborhood N s); case: (i \in neighborhood N t);
  case: (i \in neighborhood N (s :&: t)) => //= a b c;
  by [have := a isT | have := b isT | have := c isT | ].
Qed.
End Supermodular.


(* Sets made nested one after another: s and t give way to their intersection and union, and the union goes on. *)
Section Uncross.
Variables (m : nat) (N : 'I_m -> {set 'I_m}).
Hypothesis hears : forall i, i \in N i.
Implicit Types (s t : {set 'I_m}) (ss ts : seq {set 'I_m}).
Notation nested := (sorted (fun s t : {set 'I_m} => s \subset t)).
Notation around i s := (i \in neighborhood N s :\: s).

Fixpoint insert s ts := if ts is t :: ts' then (s :&: t) :: insert (s :|: t) ts' else [:: s].

Lemma size_insert s ts : size (insert s ts) = (size ts).+1.
Proof. by elim: ts s => //= t ts IH s; rewrite IH. Qed.

Lemma path_insert (x s : {set 'I_m}) ts : x \subset s -> path (fun s t : {set 'I_m} => s \subset t) x ts ->
  path (fun s t : {set 'I_m} => s \subset t) x (insert s ts).
Proof.
elim: ts x s => [|t ts IH] x s xs /=; first by rewrite xs.
case/andP=> xt pt; rewrite subsetI xs xt /=; apply: IH; first exact: subset_trans (subsetIl _ _) (subsetUl _ _).
case: ts pt => //= t' ts /andP[tt' ->]; rewrite andbT; exact: subset_trans (subsetIr _ _) tt'.
Qed.

Lemma sorted_insert s ts : nested ts -> nested (insert s ts).
Proof.
case: ts => //= t ts pt; apply: path_insert; first exact: subset_trans (subsetIl _ _) (subsetUl _ _).
case: ts pt => //= t' ts /andP[tt' ->]; rewrite andbT; exact: subset_trans (subsetIr _ _) tt'.
Qed.

Lemma insert_le (w : {set 'I_m} -> nat) s ts : (forall s t, w (s :|: t) + w (s :&: t) <= w s + w t)%N ->
  (\sum_(x <- insert s ts) w x <= w s + \sum_(x <- ts) w x)%N.
Proof.
move=> sub; elim: ts s => [|t ts IH] s /=; first by rewrite big_seq1 big_nil addn0.
rewrite !big_cons; apply: (@leq_trans (w (s :&: t) + (w (s :|: t) + \sum_(x <- ts) w x))); first by rewrite leq_add2l.
by rewrite !addnA leq_add2r addnC.
Qed.

(* whatever submodular quantities are summed over the sets, none of these sums grows *)
Definition uncrossed ss := foldr insert [::] ss.

Lemma uncrossed_le (w : {set 'I_m} -> nat) ss : (forall s t, w (s :|: t) + w (s :&: t) <= w s + w t)%N ->
  (\sum_(x <- uncrossed ss) w x <= \sum_(x <- ss) w x)%N.
Proof.
move=> sub; elim: ss => [|s ss IH]; first by rewrite !big_nil.
by rewrite /= big_cons; apply: leq_trans (insert_le _ _ sub) _; rewrite leq_add2l.
Qed.

Lemma uncrossed_nested ss : nested (uncrossed ss).
Proof. by elim: ss => //= s ss; apply: sorted_insert. Qed.

Lemma size_uncrossed ss : size (uncrossed ss) = size ss.
Proof. by elim: ss => //= s ss <-; rewrite size_insert. Qed.

Variables (L : fieldType) (n : nat) (p q : 'I_m -> nat) (S : multichannel L n p q) (lambda : L).

(* a sum of deficiencies, over sets that are deficient, in terms of ranks *)
Lemma lost_sum (r : {set 'I_m} -> nat) ss : (forall s t, r (s :|: t) + r (s :&: t) <= r s + r t)%N ->
  (forall s, s \in ss -> (r s <= n)%N) ->
  (\sum_(s <- ss) (n - r s) <= \sum_(s <- uncrossed ss) (n - r s))%N.
Proof.
move=> sub low; apply: (@leq_trans (n * size ss - \sum_(s <- ss) r s)).
  elim: ss low => [|s ss IH] low; first by rewrite !big_nil.
  have rs : (r s <= n)%N by apply: low; rewrite inE eqxx.
  have rss : (\sum_(t <- ss) r t <= n * size ss)%N.
    elim: ss low {IH} => [|t ss IH] low; first by rewrite big_nil.
    rewrite big_cons mulnS leq_add ?low ?inE ?eqxx ?orbT // IH // => u; rewrite inE => /orP[/eqP ->|us].
      by apply: low; rewrite inE eqxx.
    by apply: low; rewrite !inE us !orbT.
  rewrite !big_cons /= mulnS subnDA -addnBAC // -addnBA // leq_add2l IH // => t ts.
  by apply: low; rewrite inE ts orbT.
apply: (@leq_trans (n * size ss - \sum_(s <- uncrossed ss) r s)); first exact/leq_sub2l/uncrossed_le.
rewrite -{1}size_uncrossed; elim: (uncrossed ss) => [|s ts IH]; first by rewrite !big_nil muln0.
by rewrite !big_cons /= mulnS leq_subLR addnACA; apply: leq_add; rewrite -leq_subLR.
Qed.

(* Sets whose boundaries contain no agent more than some numbers of times can be nested: with these boundaries, and with
   no smaller sum of deficiencies at one eigenvalue. *)
Theorem uncross ss : (forall s, s \in ss -> (\rank (neighbor_pencil N S s lambda) <= n)%N) ->
  exists ts, [/\ nested ts, forall i, (\sum_(s <- ts) around i s <= \sum_(s <- ss) around i s)%N &
    (\sum_(s <- ss) (n - \rank (neighbor_pencil N S s lambda)) <=
     \sum_(s <- ts) (n - \rank (neighbor_pencil N S s lambda)))%N].
Proof.
move=> low; exists (uncrossed ss); split=> [|i|]; first exact: uncrossed_nested.
  apply: uncrossed_le => s t; exact: boundary_submodular.
apply: lost_sum low => s t; exact: rank_submodular.
Qed.

Theorem uncross_states ss : (forall s, s \in ss -> (\rank (pencil S s lambda) <= n)%N) ->
  exists ts, [/\ nested ts, forall i, (\sum_(s <- ts) around i s <= \sum_(s <- ss) around i s)%N &
    (\sum_(s <- ss) (n - \rank (pencil S s lambda)) <= \sum_(s <- ts) (n - \rank (pencil S s lambda)))%N].
Proof.
move=> low; exists (uncrossed ss); split=> [|i|]; first exact: uncrossed_nested.
  apply: uncrossed_le => s t; exact: boundary_submodular.
apply: lost_sum low => s t; exact: rank_submodular_states.
Qed.

(* around nested sets an agent stands for a stretch of them: from the first that hears it to the last that it is no
   member of *)
Theorem around_interval i s t (u : {set 'I_m}) : s \subset t -> t \subset u -> around i s -> around i u -> around i t.
Proof.
move=> st tu; rewrite !inE => /andP[_ Ns] /andP[iu _].
by rewrite (subsetP (neighborhoodS N st) _ Ns) andbT; apply: contra iu; apply: (subsetP tu).
Qed.
End Uncross.
