(* checker/sharing.py: what a cut of the base system says about the extended systems.

   The base has the outputs C_{N_i} when outputs and sub-states are shared, and C_i when sub-states alone
   are.  The boundary of s is N_s \ s; a cut demands that its agents share at least so much. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence transfer_graph pencil_space anderson_clements extended.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Cuts.
Variables (n m : nat) (p q k : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (s : {set 'I_m}).
Hypothesis hears : forall i, i \in N i.
Notation boundary := (neighborhood N s :\: s).

Section Modes.
Variables (K : fieldType) (S : multichannel K n p q) (P : {poly K}) (d : nat).
Variables (L : fieldType) (f : {rmorphism K -> L}) (lambda : L).
Hypotheses (rP : root (map_poly f P) lambda) (few : (\sum_(i in boundary) k i < d)%N).

(* Sub-states alone: a shrunk subspace of the plant that loses d needs d shared dimensions around s. *)
Theorem dimensions_cut_states (E : rank_loss S P (~: s) d) :
  fixed (extended_states N k (map_system f S)) lambda.
Proof.
have := shrunk_subspace_pencil E rP; rewrite setCK => lost.
apply: (@anderson_clements_easy _ _ _ _ _ _ s); rewrite rank_extended_states// addnAC ltn_add2r.
by apply: leq_trans lost; rewrite ltn_add2l.
Qed.

(* Outputs and sub-states: the same for the system in which every agent hears its neighbors' outputs. *)
Theorem dimensions_cut_outputs (E : rank_loss (augmented_outputs N S) P (~: s) d) :
  fixed (extended N k (map_system f S)) lambda.
Proof.
have := shrunk_subspace_pencil E rP; rewrite setCK => lost.
apply: (@anderson_clements_easy _ _ _ _ _ _ s); rewrite rank_extended// addnAC ltn_add2r.
apply: leq_trans lost; rewrite -addnS; apply: leq_add few.
have eC : (outputs (map_system f (augmented_outputs N S)) s :=: outputs (map_system f S) (neighborhood N s))%MS.
  apply: eqmx_trans (eqmx_outputs _ _) _; apply: eqmx_trans (eqmx_sym (eqmx_outputs _ _)).
  apply: eqmx_trans (span_bigcup _ _ _); apply: span_eqmx => i _ /=.
  by rewrite map_outputs; apply: eqmx_outputs.
have /submxP[D eD] : (outputs (map_system f S) (neighborhood N s) <=
    outputs (map_system f (augmented_outputs N S)) s)%MS by rewrite eC.
rewrite /neighbor_pencil eD.
have -> : block_mx (lambda%:M - mcA (map_system f S)) (inputs (map_system f S) (~: s))
    (D *m outputs (map_system f (augmented_outputs N S)) s) 0 =
  block_mx 1%:M 0 0 D *m pencil (map_system f (augmented_outputs N S)) s lambda.
  by rewrite mulmx_block !mul1mx !mul0mx !mulmx0 !addr0 !add0r.
exact: mxrankM_maxr.
Qed.
End Modes.

(* A free assignment also needs arcs into s: where the base lets nothing pass to s, an agent of the boundary
   has to share something. *)
Section Arcs.
Variables (q' : 'I_m -> nat) (K : fieldType) (S : multichannel K n p q) (heard : forall i, 'M[K]_(q' i, n)).
Notation base := (Multichannel (mcA S) (mcB S) heard).
Hypothesis silent : forall i, i \in boundary -> k i = 0%N.

Definition sharing : multichannel K (n + \sum_i k i) (fun i => p i + k i)%N (fun i => q' i + \sum_i k i)%N :=
  Multichannel (block_mx (mcA S) 0 0 0)
    (fun i => block_mx (mcB S i) 0 0 (shared_input K k i))
    (fun i => block_mx (heard i) 0 0 (shared_output K k (N i))).

Lemma silent_cut : zero_transfer base (~: s) s -> zero_transfer sharing (~: s) (~: ~: s).
Proof.
case=> x X piv inv inp out; rewrite setCK.
pose pivots (a : 'I_(x + \sum_i k i)) : 'I_(n + \sum_i k i) :=
  match split a with inl b => lshift _ (piv b) | inr b => rshift _ b end.
have pivE a (M : 'M_(n + \sum_i k i, a)) : rowsub pivots M = col_mx (rowsub piv (usubmx M)) (dsubmx M).
  by apply/matrixP=> i j; rewrite mxE [RHS]mxE /pivots; case: (split i) => c; rewrite !mxE.
have pivR a b (U : 'M_(n, a)) (V : 'M_(n, b)) : rowsub piv (row_mx U V) = row_mx (rowsub piv U) (rowsub piv V).
  by apply/matrixP=> i j; rewrite !mxE; case: (split j) => c; rewrite !mxE.
have piv0 a : rowsub piv (0 : 'M[K]_(n, a)) = 0 by apply/matrixP=> i j; rewrite !mxE.
have own j : j \in ~: s -> select K k (~: s) *m shared_input K k j = shared_input K k j.
  move=> js; apply: trmx_inj; rewrite trmx_mul tr_select.
  have -> : (shared_input K k j)^T = submxcol (select K k [set j]) j.
    by rewrite -selectE mxcolK inE eqxx.
  rewrite submxcol_mul select_mul; congr (submxcol (select K k _) j).
  by apply/setIidPl; rewrite sub1set.
have quiet i : i \in s -> shared_output K k (N i) *m select K k (~: s) = 0.
  move=> si; rewrite selectE select_mul; apply/eqP; rewrite -mxrank_eq0 rank_select big1// => j.
  rewrite !inE => /andP[jN js]; apply: silent; rewrite inE js /=.
  by apply/bigcupP; exists i.
apply: (@ZeroTransfer _ _ _ _ _ _ _ _ _ (block_mx X 0 0 (select K k (~: s))) pivots).
- rewrite /= mulmx_block !mul0mx !mulmx0 !addr0 pivE block_mxEv col_mxKu col_mxKd pivR piv0.
  by rewrite row_mx0 mul_block_col mulmx0 mul0mx addr0 mulmx0 add0r mul_mx_row mulmx0 -inv.
- move=> j js; rewrite /= pivE {1 2}block_mxEv col_mxKu col_mxKd pivR piv0 mul_block_col !mul_mx_row !mul0mx.
  by rewrite !mulmx0 !row_mx0 addr0 add0r own// -inp.
- move=> i si; rewrite /= mulmx_block !mul0mx !mulmx0 !addr0 add0r out// quiet//.
  by rewrite block_mx0.
Qed.

Lemma boundary_silent : zero_transfer base (~: s) s -> s != set0 -> s != setT ->
  ~ strongly_connected sharing.
Proof.
move=> E s0 sT; apply: (zero_transfer_cut (silent_cut E)).
  by rewrite -setCT (inj_eq (can_inj (@setCK _))).
by rewrite -setC0 (inj_eq (can_inj (@setCK _))).
Qed.
End Arcs.

Section Connection.
Variables (K : fieldType) (S : multichannel K n p q).
Hypotheses (silent : forall i, i \in boundary -> k i = 0%N) (s0 : s != set0) (sT : s != setT).

Theorem connection_cut_states : zero_transfer S (~: s) s -> ~ strongly_connected (extended_states N k S).
Proof. by case: S => A B C E; apply: (boundary_silent silent _ s0 sT). Qed.

Theorem connection_cut_outputs : zero_transfer (augmented_outputs N S) (~: s) s -> ~ strongly_connected (extended N k S).
Proof. by move=> E; apply: (boundary_silent silent E s0 sT). Qed.
End Connection.
End Cuts.

(* checker/sharing.py: the least k such that with n_i = k for all i nothing is fixed.  Around s
   there are |N_s \ s| agents, which share |N_s \ s| k dimensions together. *)
Section CommonDimension.
Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (s : {set 'I_m}).
Hypothesis hears : forall i, i \in N i.
Notation boundary := (neighborhood N s :\: s).
Variables (K : fieldType) (S : multichannel K n p q) (L : fieldType) (f : {rmorphism K -> L}).

(* With n_i = k for all i no mode is fixed; and the same with sub-states alone. *)
Definition frees k := forall lambda : L, ~ fixed (extended N (fun=> k) (map_system f S)) lambda.
Definition frees_states k := forall lambda : L, ~ fixed (extended_states N (fun=> k) (map_system f S)) lambda.

Theorem frees_more k k' : (k <= k')%N -> frees k -> frees k'.
Proof.
move=> le enough lambda; apply/(extended_not_fixed _ hears) => t.
have /(extended_not_fixed _ hears)/(_ t)/leq_trans := enough lambda; apply.
exact: leq_sum.
Qed.

Theorem frees_states_more k k' : (k <= k')%N -> frees_states k -> frees_states k'.
Proof.
move=> le enough lambda; apply/(extended_states_not_fixed _ hears) => t.
have /(extended_states_not_fixed _ hears)/(_ t)/leq_trans := enough lambda; apply.
exact: leq_sum.
Qed.

Section Cut.
Variables (P : {poly K}) (d : nat) (lambda : L).
Hypothesis rP : root (map_poly f P) lambda.

(* A shrunk subspace that loses more than k dimensions for each agent around s: k is too few, or any. *)
Lemma too_few k k' : (#|boundary| * k < d)%N -> (k' <= k)%N -> (\sum_(i in boundary) k' < d)%N.
Proof. by move=> few le; rewrite sum_nat_const (leq_ltn_trans _ few)// leq_mul. Qed.

Theorem common_dimension_outputs k (E : rank_loss (augmented_outputs N S) P (~: s) d) :
  (#|boundary| * k < d)%N -> frees k.+1 -> forall k', frees k' <-> (k < k')%N.
Proof.
move=> few enough k'; split=> [free|lt]; last exact: frees_more enough.
rewrite ltnNge; apply/negP => /(too_few few) less.
exact: free (dimensions_cut_outputs hears rP less E).
Qed.

Theorem common_dimension_states k (E : rank_loss S P (~: s) d) :
  (#|boundary| * k < d)%N -> frees_states k.+1 -> forall k', frees_states k' <-> (k < k')%N.
Proof.
move=> few enough k'; split=> [free|lt]; last exact: frees_states_more enough.
rewrite ltnNge; apply/negP => /(too_few few) less.
exact: free (dimensions_cut_states hears rP less E).
Qed.

Theorem no_common_dimension_outputs (E : rank_loss (augmented_outputs N S) P (~: s) d) :
  boundary = set0 -> (0 < d)%N -> forall k, ~ frees k.
Proof.
move=> none lost k; apply; apply: (dimensions_cut_outputs hears rP _ E).
by rewrite none big_set0.
Qed.

Theorem no_common_dimension_states (E : rank_loss S P (~: s) d) :
  boundary = set0 -> (0 < d)%N -> forall k, ~ frees_states k.
Proof.
move=> none lost k; apply; apply: (dimensions_cut_states hears rP _ E).
by rewrite none big_set0.
Qed.
End Cut.
End CommonDimension.
