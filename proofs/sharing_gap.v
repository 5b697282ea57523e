(* Is the bound of Theorem 2 tight?  The answer for every neighbor graph.

   delta_s(lambda) is what P_s(lambda) lacks of rank n (deficiency, extended_bound.v): (26) says n_i >= delta_s(lambda)
   for all s, and no eigenvalue is fixed iff sum_{i in N_s \ s} n_i >= delta_s(lambda) for all s (extended_no_fixed).  So the
   bound (26) can exceed the least common dimension c, n_i = c for all i, only where several agents stand around one s.

   S and R, nonempty sets of agents, are apart if nobody in S hears anybody in R.  A relay between them is an agent that
   somebody in S hears and that hears somebody in R.  relay_number N is the largest number of relays between two sets
   apart, the paper's graph being N; boundary_number N is the largest number of agents in N_s \ s.

   bound_26_at_most    (26) is at most relay_number N times every common dimension that suffices
   bound_26_attained   and equal to that for some plant, whatever the graph, the field and the dimension are
   bound_26_tight      so (26) is the least common dimension of every plant iff relay_number N <= 1
   bound_27_at_most, bound_27_attained, bound_27_tight
                       the same for (27), where sub-states alone are shared, with boundary_number N

   boundary_number N is m less the domination number (boundary_number_domination), and relay_number N <= m - 2.  Both are
   reached for every m >= 3: on diamonds and on stars. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph extended_bound.
From mcexact Require Import delayed_systems held lifted delays.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Graph.
Variables (m : nat) (N : 'I_m -> {set 'I_m}).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S R s : {set 'I_m}).
Notation boundary s := (neighborhood N s :\: s).

Definition apart S R := [&& S != set0, R != set0 & [disjoint neighborhood N S & R]].
Definition relays S R := neighborhood N S :&: [set j | ~~ [disjoint N j & R]].
Definition relay_number := \max_(sr : {set 'I_m} * {set 'I_m} | apart sr.1 sr.2) #|relays sr.1 sr.2|.
Definition boundary_number := \max_(s : {set 'I_m}) #|boundary s|.

Lemma neighborhoodS s S : s \subset S -> neighborhood N s \subset neighborhood N S.
Proof. by move=> sS; apply/bigcupsP => i si; apply: (bigcup_max i) => //; apply: (subsetP sS). Qed.

Lemma disjoint_neighborhood S R : [disjoint neighborhood N S & R] = [forall i in S, [disjoint N i & R]].
Proof.
apply/idP/forall_inP => [h i si|h].
  by apply: disjointWl h; apply/subsetP => j Nj; apply/bigcupP; exists i.
rewrite -setI_eq0; apply/eqP/setP => j; rewrite !inE; apply/andP => -[/bigcupP[i si Nj] Rj].
by have := h i si; rewrite -setI_eq0 => /eqP/setP/(_ j); rewrite !inE Nj Rj.
Qed.

(* every set that contains S and hears nobody in R has all relays around it *)
Lemma relays_around S R s : S \subset s -> [disjoint neighborhood N s & R] -> relays S R \subset boundary s.
Proof.
move=> Ss; rewrite disjoint_neighborhood => /forall_inP h; apply/subsetP => j; rewrite !inE => /andP[NSj Nj].
rewrite (subsetP (neighborhoodS Ss) _ NSj) andbT; apply: contra Nj; exact: h.
Qed.

Lemma relays_le S R : apart S R -> (#|relays S R| <= relay_number)%N.
Proof. by move=> ap; apply: (@leq_bigmax_cond _ _ (fun sr => #|relays sr.1 sr.2|) (S, R)). Qed.

Lemma boundary_le s : (#|boundary s| <= boundary_number)%N.
Proof. exact: (@leq_bigmax _ (fun s => #|boundary s|)). Qed.

Lemma proper_less l a : (0 < a)%N -> (l < m)%N -> (l - a <= m - 2)%N.
Proof.
move=> a0 lm; apply: (leq_trans (leq_sub2r a (_ : l <= m.-1)%N)); first by rewrite -ltnS prednK // (leq_ltn_trans _ lm).
by rewrite -subn1 -subnDA leq_sub2l // addnC addn1 ltnS.
Qed.

(* S has a member that is no relay, and so has R *)
Theorem relay_number_le : (relay_number <= m - 2)%N.
Proof.
apply/bigmax_leqP => -[S R] /= /and3P[S0 /set0Pn[r Rr] ap].
apply: leq_trans (subset_leq_card (relays_around (subxx _) ap)) _.
rewrite cardsDS ?sub_neighborhood //; apply: proper_less; first by rewrite card_gt0.
rewrite -[X in (_ < X)%N]card_ord -cardsT proper_card //; apply/properP; split; first exact: subsetT.
exists r; rewrite ?inE //; apply/negP => h; move: ap; rewrite -setI_eq0 => /eqP/setP/(_ r).
by rewrite !inE h Rr.
Qed.

(* the domination number is the least number of agents that together hear everybody *)
Theorem boundary_number_domination : exists D, [/\ neighborhood N D = setT, boundary_number = (m - #|D|)%N
  & forall D', neighborhood N D' = setT -> (#|D| <= #|D'|)%N].
Proof.
have cover s : neighborhood N (~: boundary s) = setT.
  apply/setP => j; rewrite [RHS]inE; apply/bigcupP.
  have [/setDP[/bigcupP[i si Nj] sj]|nj] := boolP (j \in boundary s); last by exists j; rewrite // in_setC.
  by exists i => //; rewrite in_setC in_setD si.
have [D0 D0T least] : exists2 D : {set 'I_m}, neighborhood N D == setT & forall D', neighborhood N D' == setT -> (#|D| <= #|D'|)%N.
  have T : neighborhood N setT == setT by rewrite neighborhoodT.
  by case: (@arg_minnP _ setT (fun D => neighborhood N D == setT) (fun D => #|D|) T) => D DT h; exists D => // D' /h.
exists D0; split; [exact/eqP| |by move=> D' /eqP; apply: least].
apply/eqP; rewrite eqn_leq; apply/andP; split.
  apply/bigmax_leqP => s _; have := least _ (introT eqP (cover s)).
  rewrite [X in (_ <= X)%N -> _]cardsCs setCK card_ord => h.
  have le : (#|boundary s| <= m)%N by rewrite -[X in (_ <= X)%N]card_ord -cardsT subset_leq_card // subsetT.
  by rewrite -(subKn le) leq_sub2l.
by apply: leq_trans (boundary_le D0); rewrite (eqP D0T) setTD [X in (_ <= X)%N]cardsCs setCK card_ord.
Qed.
End Graph.

(* How much the bounds can exceed a common dimension that suffices: one eigenvalue at a time, and nothing is
   assumed of the plant or of the connectivity of the graph. *)
Section AtMost.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variable N : 'I_m -> {set 'I_m}.
Hypothesis hears : forall i, i \in N i.
Variable S : multichannel K n p q.

(* a larger s that hears nobody else is at least as deficient *)
Lemma deficiency_grows (s s' : {set 'I_m}) (lambda : L) : s \subset s' -> neighborhood N s' = neighborhood N s ->
  (deficiency f N S s lambda <= deficiency f N S s' lambda)%N.
Proof.
move=> ss e; apply: leq_sub2l; rewrite /neighbor_pencil e; apply: rank_block_le => //.
apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB (map_system f S)) (~: s'))^T); first by rewrite eqmx_inputs.
apply: (@submx_trans _ _ _ _ _ _ (input_space (mcB (map_system f S)) (~: s))^T); last by rewrite eqmx_inputs.
rewrite /input_space !trmxK; apply/sumsmx_subP => i si; apply: (sumsmx_sup i) => //.
by move: si; rewrite !inE; apply: contra; apply: (subsetP ss).
Qed.

(* Of all s with the same N_s take the largest: the agents around it are relays between s and all that s does not hear. *)
Theorem bound_26_at_most c (lambda : L) s : ~ fixed_over f (extended N (fun=> c) S) lambda ->
  (deficiency f N S s lambda <= relay_number N * c)%N.
Proof.
rewrite fixed_over_extended extended_not_fixed // => enough.
pose s' := [set i | N i \subset neighborhood N s].
have ss' : s \subset s'.
  by apply/subsetP => i si; rewrite inE; apply/subsetP => j Nj; apply/bigcupP; exists i.
have e : neighborhood N s' = neighborhood N s.
  apply/eqP; rewrite eqEsubset (neighborhoodS N ss') andbT; apply/bigcupsP => i; by rewrite inE.
apply: leq_trans (deficiency_grows lambda ss' e) _; apply: leq_trans (enough s') _.
rewrite sum_nat_const leq_mul2r; apply/orP; right; rewrite e.
have [->|s0] := eqVneq s set0; first by rewrite neighborhood0 set0D cards0.
have [NT|NT] := eqVneq (neighborhood N s) setT.
  suff -> : neighborhood N s :\: s' = set0 by rewrite cards0.
  by apply/setP => i; rewrite !inE NT subsetT.
have R0 : ~: neighborhood N s != set0 by rewrite -setCT (inj_eq (can_inj (@setCK _))).
have ap : apart N s (~: neighborhood N s) by rewrite /apart s0 R0 /= -subsets_disjoint.
apply: leq_trans (relays_le ap); apply: subset_leq_card; apply/subsetP => i; rewrite !inE => /andP[Ni ->] /=.
by rewrite -subsets_disjoint.
Qed.

Theorem bound_27_at_most c (lambda : L) s : ~ fixed_over f (extended_states N (fun=> c) S) lambda ->
  (deficiency_states f S s lambda <= boundary_number N * c)%N.
Proof.
rewrite fixed_over_extended_states extended_states_not_fixed // => /(_ s) /leq_trans; apply.
by rewrite sum_nat_const leq_mul2r boundary_le orbT.
Qed.

(* under delays: the system of Theorem 3 away from 0, that of Theorem 4 at every lambda *)
Theorem bound_26_at_most_delays d c (lambda : L) s : lambda != 0 -> ~ fixed_over f (lifted N (fun=> c) d S) lambda ->
  (deficiency f N S s lambda <= relay_number N * c)%N.
Proof. by move=> l0; rewrite lifted_fixed_iff //; apply: bound_26_at_most. Qed.

Theorem bound_27_at_most_held d c (lambda : L) s : ~ fixed_over f (held N (fun=> c) d S) lambda ->
  (deficiency_states f S s lambda <= boundary_number N * c)%N.
Proof. by rewrite held_fixed_iff //; apply: bound_27_at_most. Qed.
End AtMost.

(* The plants that attain them: r + 2 copies of x' = a x.  The members of S drive all of them and those of R see all of them;
   everybody else drives the first and sees the first. *)
Section Copies.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (m : nat) (N : 'I_m -> {set 'I_m}) (a : K) (r : nat).
Hypothesis hears : forall i, i \in N i.
Variables S R : {set 'I_m}.
Hypotheses (S0 : S != set0) (R0 : R != set0).
Notation n := r.+2.

Definition copies : multichannel K n (fun=> n) (fun=> n) :=
  @Multichannel K n m (fun=> n) (fun=> n) a%:M
    (fun i => if i \in S then 1%:M else delta_mx ord0 ord0)
    (fun i => if i \in R then 1%:M else delta_mx ord0 ord0).

Lemma copies_inputs i : mcB copies i != 0.
Proof. by rewrite /=; case: ifP => _; rewrite -mxrank_eq0 ?mxrank1 ?mxrank_delta. Qed.
Lemma copies_outputs i : mcC copies i != 0.
Proof. by rewrite /=; case: ifP => _; rewrite -mxrank_eq0 ?mxrank1 ?mxrank_delta. Qed.

Notation P := (map_system f copies).

Lemma mapped_input i : mcB P i = if i \in S then 1%:M else delta_mx ord0 ord0.
Proof. by rewrite /=; case: ifP => _; rewrite ?map_mx1 ?map_delta_mx. Qed.
Lemma mapped_output i : mcC P i = if i \in R then 1%:M else delta_mx ord0 ord0.
Proof. by rewrite /=; case: ifP => _; rewrite ?map_mx1 ?map_delta_mx. Qed.

Lemma full_inputs (T : {set 'I_m}) i : i \in S -> i \in T -> (1%:M <= (inputs P T)^T)%MS.
Proof.
move=> Si Ti; rewrite eqmx_inputs /input_space trmxK; apply: (sumsmx_sup i) => //.
by rewrite genmxE mapped_input Si trmx1.
Qed.
Lemma full_outputs (T : {set 'I_m}) i : i \in R -> i \in T -> (1%:M <= outputs P T)%MS.
Proof.
move=> Ri Ti; rewrite eqmx_outputs /output_space; apply: (sumsmx_sup i) => //.
by rewrite genmxE mapped_output Ri.
Qed.

Lemma copies_controllable : jointly_controllable copies.
Proof.
apply/controllableP => w /(_ 0%N); rewrite /krylov /= => wB.
have [i Si] := set0Pn _ S0.
have : w *m mcB copies i = 0.
  have := congr1 (fun M => submxrow M i) wB; rewrite submxrow0 => <-.
  by rewrite /inputs mul_mxrow mxrowK in_setT.
by rewrite /= Si mulmx1.
Qed.

Lemma copies_observable : jointly_observable copies.
Proof.
apply/controllableP => w /(_ 0%N); rewrite /krylov /= => wC.
have [i Ri] := set0Pn _ R0.
have : mcC copies i *m w^T = 0.
  move/(congr1 trmx): wC; rewrite trmx_mul trmxK trmx0 => /(congr1 (fun M => submxcol M i)).
  by rewrite submxcol0 /outputs mxcol_mul mxcolK in_setT.
by rewrite /= Ri mul1mx => /(congr1 trmx); rewrite trmxK trmx0.
Qed.

(* no rank is lost where a member of S is outside s, or the outputs of T have those of a member of R *)
Lemma nothing_lost (s T : {set 'I_m}) (lambda : L) : ~~ (S \subset s) || ~~ [disjoint T & R] ->
  (n <= \rank (block_mx (lambda%:M - mcA P) (inputs P (~: s)) (outputs P T) 0))%N.
Proof.
case/orP=> [/subsetPn[i Si si]|].
  have full : (1%:M <= (inputs P (~: s))^T)%MS by apply: (full_inputs Si); rewrite inE.
  have le : (\rank (block_mx (lambda%:M - mcA P) 1%:M (0 : 'M[L]_(0, n)) 0)%R <=
             \rank (block_mx (lambda%:M - mcA P) (inputs P (~: s)) (outputs P T) 0)%R)%N.
    by apply: rank_block_le; rewrite ?trmx1 ?sub0mx.
  apply: leq_trans le; rewrite -{1}(mxrank1 L n).
  have e : row_mx 1%:M 0 *m block_mx (lambda%:M - mcA P) 1%:M (0 : 'M_(0, n)) 0 *m col_mx 0 1%:M = 1%:M.
    by rewrite mul_row_block mul_row_col !(mul1mx, mul0mx, mulmx1, mulmx0, addr0, add0r).
  by rewrite -{1}e (leq_trans (mxrankM_maxl _ _)) // mxrankM_maxr.
rewrite -setI_eq0 => /set0Pn[i]; rewrite inE => /andP[Ti Ri].
have full : (1%:M <= outputs P T)%MS by apply: (full_outputs Ri).
have le : (\rank (block_mx (lambda%:M - mcA P) (0 : 'M[L]_(n, 0)) 1%:M 0)%R <=
           \rank (block_mx (lambda%:M - mcA P) (inputs P (~: s)) (outputs P T) 0)%R)%N.
  by apply: rank_block_le => //; rewrite trmx0 sub0mx.
apply: leq_trans le; rewrite -{1}(mxrank1 L n).
have e : row_mx 0 1%:M *m block_mx (lambda%:M - mcA P) (0 : 'M_(n, 0)) 1%:M 0 *m col_mx 1%:M 0 = 1%:M.
  by rewrite mul_row_block mul_row_col !(mul1mx, mul0mx, mulmx1, mulmx0, addr0, add0r).
by rewrite -{1}e (leq_trans (mxrankM_maxl _ _)) // mxrankM_maxr.
Qed.

Lemma rank_antidiagonal p q (B : 'M[L]_(n, p)) (C : 'M[L]_(q, n)) : \rank (block_mx 0 B C 0) = (\rank C + \rank B)%N.
Proof.
rewrite -rank_diag_block_mx.
have e1 : block_mx C 0 0 B = block_mx (0 : 'M_(q, n)) 1%:M 1%:M 0 *m block_mx 0 B C 0.
  by rewrite mulmx_block !(mul1mx, mul0mx, addr0, add0r).
have e2 : block_mx 0 B C 0 = block_mx (0 : 'M_(n, q)) 1%:M 1%:M 0 *m block_mx C 0 0 B.
  by rewrite mulmx_block !(mul1mx, mul0mx, addr0, add0r).
by apply/eqP; rewrite eqn_leq [X in (\rank X <= _)%N]e2 mxrankM_maxr e1 mxrankM_maxr.
Qed.

Lemma one_input (T : {set 'I_m}) : T != set0 -> [disjoint S & T] -> \rank (inputs P T) = 1%N.
Proof.
case/set0Pn=> j Tj /pred0P d; have ns i : i \in T -> (i \in S) = false.
  by move=> Ti; have := d i; rewrite /= Ti andbT.
rewrite -mxrank_tr -(mxrank_delta L (ord0 : 'I_n) (ord0 : 'I_n)); apply/eqmx_rank/andP; split.
  rewrite eqmx_inputs /input_space trmxK; apply/sumsmx_subP => i Ti.
  by rewrite genmxE mapped_input ns // trmx_delta.
rewrite eqmx_inputs /input_space trmxK; apply: (sumsmx_sup j) => //.
by rewrite genmxE mapped_input ns // trmx_delta.
Qed.

Lemma one_output (T : {set 'I_m}) : T != set0 -> [disjoint T & R] -> \rank (outputs P T) = 1%N.
Proof.
case/set0Pn=> j Tj /pred0P d; have ns i : i \in T -> (i \in R) = false.
  by move=> Ti; have := d i; rewrite /= Ti.
rewrite -(mxrank_delta L (ord0 : 'I_n) (ord0 : 'I_n)); apply/eqmx_rank/andP; split.
  rewrite eqmx_outputs /output_space; apply/sumsmx_subP => i Ti.
  by rewrite genmxE mapped_output ns.
rewrite eqmx_outputs /output_space; apply: (sumsmx_sup j) => //.
by rewrite genmxE mapped_output ns.
Qed.

(* elsewhere r ranks are: what is left is one input and one output *)
Lemma lost (s T : {set 'I_m}) : s \subset T -> S \subset s -> [disjoint T & R] ->
  \rank (block_mx ((f a)%:M - mcA P) (inputs P (~: s)) (outputs P T) 0) = 2%N.
Proof.
move=> sT Ss d; have -> : (f a)%:M - mcA P = 0 by rewrite /= map_scalar_mx subrr.
rewrite rank_antidiagonal one_output //; last first.
  by have /set0Pn[i Si] := S0; apply/set0Pn; exists i; apply: (subsetP sT); apply: (subsetP Ss).
rewrite one_input //; last by rewrite -subsets_disjoint.
have /set0Pn[i Ri] := R0; apply/set0Pn; exists i; rewrite inE; apply/negP => si.
by have /pred0P/(_ i) := d; rewrite /= Ri (subsetP sT).
Qed.

Lemma copies_eigenvalue : eigenvalue (map_mx f (mcA copies)) (f a).
Proof. by rewrite eigenvalue_rank /= map_scalar_mx subrr mxrank0. Qed.

Lemma copies_eigenvalues lambda : eigenvalue (map_mx f (mcA copies)) lambda -> lambda = f a.
Proof.
rewrite eigenvalue_rank /= map_scalar_mx; have [->//|ne] := eqVneq lambda (f a).
by rewrite -raddfB /= -scalemx1 mxrank_scale_nz ?mxrank1 ?ltnn // subr_eq0.
Qed.

Lemma copies_deficiency : [disjoint neighborhood N S & R] -> deficiency f N copies S (f a) = r.
Proof. by move=> d; rewrite /deficiency /neighbor_pencil lost ?sub_neighborhood // subSS subSS subn0. Qed.

Lemma copies_outputs_shared c : [disjoint neighborhood N S & R] -> r = (#|relays N S R| * c)%N ->
  forall lambda : L, ~ fixed_over f (extended N (fun=> c) copies) lambda.
Proof.
move=> d er; apply/(extended_no_fixed f (fun=> c) hears copies) => s lambda /copies_eigenvalues ->.
have [/andP[Ss ds]|] := boolP ((S \subset s) && [disjoint neighborhood N s & R]); last first.
  by rewrite negb_and => /nothing_lost h; rewrite /deficiency /neighbor_pencil (eqP (_ : _ - _ == 0)%N) // subn_eq0 h.
rewrite /deficiency /neighbor_pencil lost ?sub_neighborhood // subSS subSS subn0 {1}er sum_nat_const leq_mul2r.
by rewrite subset_leq_card ?orbT // relays_around.
Qed.

Lemma copies_deficiency_states : [disjoint S & R] -> deficiency_states f copies S (f a) = r.
Proof. by move=> d; rewrite /deficiency_states lost // subSS subSS subn0. Qed.

Lemma copies_states_shared c : R = ~: S -> r = (#|neighborhood N S :\: S| * c)%N ->
  forall lambda : L, ~ fixed_over f (extended_states N (fun=> c) copies) lambda.
Proof.
move=> eR er; have d : [disjoint S & R] by rewrite eR -subsets_disjoint.
apply/(extended_states_no_fixed f (fun=> c) hears copies) => s lambda /copies_eigenvalues ->.
have [/andP[Ss ds]|] := boolP ((S \subset s) && [disjoint s & R]); last first.
  by rewrite negb_and => /nothing_lost h; rewrite /deficiency_states (eqP (_ : _ - _ == 0)%N) // subn_eq0 h.
have -> : s = S by apply/eqP; rewrite eqEsubset Ss andbT subsets_disjoint -eR.
by rewrite /deficiency_states lost // subSS subSS subn0 {1}er sum_nat_const.
Qed.
End Copies.

Section Attained.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (m : nat) (N : 'I_m -> {set 'I_m}) (a : K) (c : nat).
Hypothesis hears : forall i, i \in N i.

(* Whatever the graph, the field and c are: a plant for which c is the least common dimension, and for which the bound (26),
   the largest deficiency at an eigenvalue of A, is relay_number N * c. *)
Theorem bound_26_attained : (0 < relay_number N)%N -> exists n p q (S : multichannel K n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', (forall lambda : L, ~ fixed_over f (extended N (fun=> c') S) lambda) <-> (c <= c')%N,
      exists s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda /\ deficiency f N S s lambda = (relay_number N * c)%N
    & forall s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda -> (deficiency f N S s lambda <= relay_number N * c)%N].
Proof.
move=> b0; have [[S R] /= ap eb] :
    exists2 sr : {set 'I_m} * {set 'I_m}, apart N sr.1 sr.2 & relay_number N = #|relays N sr.1 sr.2|.
  have [|sr ap e] := @eq_bigmax_cond _ [pred sr : {set 'I_m} * {set 'I_m} | apart N sr.1 sr.2] (fun sr => #|relays N sr.1 sr.2|).
    rewrite lt0n; apply: contraTneq b0 => e; rewrite -leqNgt leqn0 /relay_number big_pred0 // => sr.
    exact: (card0_eq e sr).
  by exists sr.
have /and3P[S0 R0 d] := ap; pose r := (#|relays N S R| * c)%N.
have free := copies_outputs_shared (f := f) (a := a) hears S0 R0 d (erefl r).
have eqd : deficiency f N (copies a r S R) S (f a) = (relay_number N * c)%N by rewrite eb; apply: copies_deficiency.
exists r.+2, (fun=> r.+2), (fun=> r.+2), (copies a r S R); split.
- split; [exact: copies_controllable|exact: copies_observable|].
  by move=> i; rewrite copies_inputs copies_outputs.
- move=> c'; split=> [h|le lambda].
    have := bound_26_at_most hears S (h (f a)).
    by rewrite eqd leq_mul2l eqn0Ngt b0.
  have enough := (extended_no_fixed f (fun=> c) hears (copies a r S R)).1 free.
  move: lambda; apply/(extended_no_fixed f (fun=> c') hears) => s lambda el.
  by apply: leq_trans (enough s lambda el) _; apply: leq_sum.
- by exists S, (f a); rewrite eqd; split=> //; apply: copies_eigenvalue.
- by move=> s lambda _; apply: bound_26_at_most.
Qed.

(* the same for (27), where sub-states alone are shared *)
Theorem bound_27_attained : (0 < boundary_number N)%N -> exists n p q (S : multichannel K n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', (forall lambda : L, ~ fixed_over f (extended_states N (fun=> c') S) lambda) <-> (c <= c')%N,
      exists s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda /\ deficiency_states f S s lambda = (boundary_number N * c)%N
    & forall s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda ->
        (deficiency_states f S s lambda <= boundary_number N * c)%N].
Proof.
move=> b0; have [S eb] : exists S : {set 'I_m}, boundary_number N = #|neighborhood N S :\: S|.
  by have [|S] := @eq_bigmax _ (fun s : {set 'I_m} => #|neighborhood N s :\: s|); [apply/card_gt0P; exists set0|exists S].
have S0 : S != set0 by apply: contraTneq b0 => e; rewrite eb e neighborhood0 set0D cards0.
have R0 : ~: S != set0.
  by apply: contraTneq b0 => e; rewrite eb -[S]setCK e setC0 setDT cards0.
pose r := (#|neighborhood N S :\: S| * c)%N.
have free := copies_states_shared (f := f) (a := a) hears S0 R0 (erefl _) (erefl r).
have eqd : deficiency_states f (copies a r S (~: S)) S (f a) = (boundary_number N * c)%N.
  by rewrite eb; apply: copies_deficiency_states => //; rewrite -subsets_disjoint.
exists r.+2, (fun=> r.+2), (fun=> r.+2), (copies a r S (~: S)); split.
- split; [exact: copies_controllable|exact: copies_observable|].
  by move=> i; rewrite copies_inputs copies_outputs.
- move=> c'; split=> [h|le lambda].
    have := bound_27_at_most hears S (h (f a)).
    by rewrite eqd leq_mul2l eqn0Ngt b0.
  have enough := (extended_states_no_fixed f (fun=> c) hears (copies a r S (~: S))).1 free.
  move: lambda; apply/(extended_states_no_fixed f (fun=> c') hears) => s lambda el.
  by apply: leq_trans (enough s lambda el) _; apply: leq_sum.
- by exists S, (f a); rewrite eqd; split=> //; apply: copies_eigenvalue.
- by move=> s lambda _; apply: bound_27_at_most.
Qed.
End Attained.

(* The graphs on which the bounds are right: the bound is the least common dimension of every plant for which some common
   dimension suffices. *)
Section Tight.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (m : nat) (N : 'I_m -> {set 'I_m}).
Hypothesis hears : forall i, i \in N i.

Theorem bound_26_tight : (relay_number N <= 1)%N <->
  (forall n p q (S : multichannel K n p q) c, jointly_controllable S -> jointly_observable S ->
    (forall lambda : L, ~ fixed_over f (extended N (fun=> c) S) lambda) ->
    forall s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda -> (deficiency f N S s lambda <= c)%N).
Proof.
split=> [b1 n p q S c _ _ free s lambda _|h].
  by apply: leq_trans (bound_26_at_most hears s (free lambda)) _; rewrite -[X in (_ <= X)%N]mul1n leq_mul2r b1 orbT.
have [->//|] := posnP (relay_number N).
case/(bound_26_attained f 0 1 hears) => n [p [q [S [[jc jo _] least [s [lambda [el e]]] _]]]].
by rewrite -[relay_number N]muln1 -e; apply: h el => //; apply/least.
Qed.

Theorem bound_27_tight : (boundary_number N <= 1)%N <->
  (forall n p q (S : multichannel K n p q) c, jointly_controllable S -> jointly_observable S ->
    (forall lambda : L, ~ fixed_over f (extended_states N (fun=> c) S) lambda) ->
    forall s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda -> (deficiency_states f S s lambda <= c)%N).
Proof.
split=> [b1 n p q S c _ _ free s lambda _|h].
  by apply: leq_trans (bound_27_at_most hears s (free lambda)) _; rewrite -[X in (_ <= X)%N]mul1n leq_mul2r b1 orbT.
have [->//|] := posnP (boundary_number N).
case/(bound_27_attained f 0 1 hears) => n [p [q [S [[jc jo _] least [s [lambda [el e]]] _]]]].
by rewrite -[boundary_number N]muln1 -e; apply: h el => //; apply/least.
Qed.

(* Theorem 3 asks for (26) at all eigenvalues of A, at 0 among them, where its conclusion says nothing: there the bound can
   be as large as one likes while nothing need be shared.  In (26) for Theorem 3 lambda has to range over the nonzero
   eigenvalues. *)
Theorem theorem_3_at_0 (r : nat) (S0 R0 : {set 'I_m}) : apart N S0 R0 -> exists n p q (S : multichannel K n p q),
  [/\ jointly_controllable S, jointly_observable S,
      eigenvalue (map_mx f (mcA S)) 0 /\ deficiency f N S S0 0 = r
    & forall d (lambda : L), lambda != 0 -> ~ fixed_over f (lifted N (fun=> 0%N) d S) lambda].
Proof.
move=> /and3P[s0 r0 ap].
exists r.+2, (fun=> r.+2), (fun=> r.+2), (copies (0 : K) r S0 R0); split.
- exact: copies_controllable.
- exact: copies_observable.
- have := copies_eigenvalue f 0 r S0 R0; rewrite rmorph0 => el; split=> //.
  by have := copies_deficiency f 0 r hears s0 r0 ap; rewrite rmorph0.
move=> d lambda l0; rewrite lifted_fixed_iff // fixed_over_extended extended_not_fixed // => s.
rewrite -/(deficiency f N (copies (0 : K) r S0 R0) s lambda) deficient0 //.
by apply: contraNN l0 => /copies_eigenvalues ->; rewrite rmorph0.
Qed.

(* Theorem 3 with (26) at the nonzero eigenvalues alone *)
Theorem theorem_3_nonzero n p q (S : multichannel K n p q) k d : jointly_controllable S -> jointly_observable S ->
  strongly_connected (neighbor_arc N) ->
  (forall i s (lambda : L), s != set0 -> s != setT -> lambda != 0 -> eigenvalue (map_mx f (mcA S)) lambda ->
     (deficiency f N S s lambda <= k i)%N) ->
  forall lambda : L, lambda != 0 -> ~ fixed_over f (lifted N k d S) lambda.
Proof.
move=> jc jo sc enough lambda l0; rewrite lifted_fixed_iff // fixed_over_extended extended_not_fixed // => s.
rewrite -/(deficiency f N S s lambda); have [el|/deficient0 -> //] := boolP (eigenvalue (map_mx f (mcA S)) lambda).
have [->|s0] := eqVneq s set0.
  rewrite /deficiency /neighbor_pencil neighborhood0 -/(pencil (map_system f S) set0 lambda).
  by rewrite jointly_controllable_pencil // subnn.
have [->|sT] := eqVneq s setT.
  rewrite /deficiency /neighbor_pencil neighborhoodT // -/(pencil (map_system f S) setT lambda).
  by rewrite jointly_observable_pencil // subnn.
have /set0Pn[i bi] := (neighborhood_strongly_connected N).1 sc s s0 sT.
by rewrite [X in (_ <= X)%N](bigD1 i) //= (leq_trans (enough i s lambda s0 sT l0 el)) // leq_addr.
Qed.
End Tight.

(* The largest factors, m - 2 and m - 1, with every number m = l + 3 of agents.  In a diamond agent 1 hears all but the last,
   the last hears itself and agent 1, and the others hear themselves and the last; in a star agent 1 hears all, and all
   hear agent 1. *)
Section Extreme.
Variable l : nat.
Notation m := l.+3.
Definition diamond (i : 'I_m) : {set 'I_m} :=
  if i == ord0 then ~: [set ord_max] else if i == ord_max then [set ord_max; ord0] else [set i; ord_max].
Definition star (i : 'I_m) : {set 'I_m} := if i == ord0 then setT else [set i; ord0].

Lemma max_not_0 : ((ord_max : 'I_m) == ord0) = false. Proof. by []. Qed.
Lemma diamond_hears i : i \in diamond i.
Proof. by rewrite /diamond; case: eqP => [->|_]; [rewrite !inE|case: eqP => [->|_]; rewrite !inE eqxx]. Qed.
Lemma star_hears i : i \in star i.
Proof. by rewrite /star; case: eqP => _; rewrite !inE ?eqxx. Qed.

Theorem diamond_connected : strongly_connected (neighbor_arc diamond).
Proof.
have to_max i : connect (neighbor_arc diamond) i ord_max.
  have z : connect (neighbor_arc diamond) ord0 ord_max by apply: connect1; rewrite /neighbor_arc /diamond max_not_0 eqxx !inE eqxx orbT.
  have [->|nm] := eqVneq i ord_max; first exact: connect0.
  by apply: connect_trans z; apply: connect1; rewrite /neighbor_arc /diamond eqxx !inE.
have from_max i : connect (neighbor_arc diamond) ord_max i.
  have mid j : j != ord0 -> j != ord_max -> connect (neighbor_arc diamond) ord_max j.
    by move=> j0 jm; apply: connect1; rewrite /neighbor_arc /diamond (negPf j0) (negPf jm) !inE eqxx orbT.
  have [->|nm] := eqVneq i ord_max; first exact: connect0.
  have [->|n0] := eqVneq i ord0; last exact: mid.
  pose one := @Ordinal m 1 isT; apply: (connect_trans (mid one _ _)) => //.
  by apply: connect1; rewrite /neighbor_arc /diamond eqxx !inE.
by move=> j i; apply: connect_trans (to_max j) (from_max i).
Qed.

Theorem relay_number_diamond : relay_number diamond = (m - 2)%N.
Proof.
apply/eqP; rewrite eqn_leq relay_number_le; last exact: diamond_hears.
have nb : neighborhood diamond [set ord0] = ~: [set ord_max] by rewrite /neighborhood big_set1 /diamond eqxx.
have ap : apart diamond [set ord0] [set ord_max].
  rewrite /apart nb -!card_gt0 !cards1 /= -setI_eq0.
  by apply/eqP/setP => j; rewrite !inE; case: eqP.
apply: leq_trans (relays_le ap); rewrite -[X in (X <= _)%N](_ : #|~: [set (ord0 : 'I_m); ord_max]| = _); last first.
  by rewrite cardsCs setCK card_ord cards2.
apply: subset_leq_card; apply/subsetP => j; rewrite /relays nb !inE negb_or => /andP[j0 jm]; rewrite jm /=.
by rewrite -setI_eq0; apply/set0Pn; exists ord_max; rewrite /diamond (negPf j0) (negPf jm) !inE eqxx orbT.
Qed.

Theorem star_connected : strongly_connected (neighbor_arc star).
Proof.
move=> j i; apply: (@connect_trans _ _ ord0); apply: connect1; rewrite /neighbor_arc /star ?eqxx ?inE //.
by case: eqP => _; rewrite !inE ?eqxx ?orbT.
Qed.

Theorem boundary_number_star : boundary_number star = (m - 1)%N.
Proof.
have [D [DT -> least]] := boundary_number_domination star_hears; congr (_ - _)%N; apply/eqP; rewrite eqn_leq; apply/andP; split.
  by rewrite -(cards1 (ord0 : 'I_m)) least // /neighborhood big_set1 /star eqxx.
rewrite card_gt0; apply/eqP => e; move: DT; rewrite e neighborhood0 => /setP/(_ ord0).
by rewrite !inE.
Qed.
End Extreme.
