(* The extended systems (emcs) and of Remark 2: the rank identity, and for which shared dimensions an
   eigenvalue is not fixed.  k i is the paper's n_i. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space anderson_clements.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Spaces.
Variable L : fieldType.

(* the span of V_i, i in s *)
Definition span k m (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, k)) (s : {set 'I_m}) : 'M[L]_k :=
  (\sum_(i in s) <<V i>>)%MS.

Lemma span_sub k m (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, k)) s r (Z : 'M[L]_(r, k)) :
  (span V s <= Z)%MS <-> (forall i, i \in s -> (V i <= Z)%MS).
Proof.
split=> [h i si|h]; last by apply/sumsmx_subP => i /h; rewrite genmxE.
by apply: submx_trans h; apply: (sumsmx_sup i) => //; rewrite genmxE.
Qed.

Lemma sub_span k m (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, k)) (s : {set 'I_m}) i :
  i \in s -> (V i <= span V s)%MS.
Proof. by move=> si; apply: (sumsmx_sup i) => //; rewrite genmxE. Qed.

Lemma span_eqmx k m (d d' : 'I_m -> nat) (V : forall i, 'M[L]_(d i, k))
    (V' : forall i, 'M[L]_(d' i, k)) (s : {set 'I_m}) :
  (forall i, i \in s -> (V i :=: V' i)%MS) -> (span V s :=: span V' s)%MS.
Proof.
move=> e; apply/eqmxP/andP; split; apply/span_sub => i si.
  by rewrite e //; apply: sub_span.
by rewrite -e //; apply: sub_span.
Qed.

Lemma block_sub k1 k2 a1 a2 b1 b2 (X : 'M[L]_(a1, k1)) (X' : 'M_(b1, k1)) (Y : 'M_(a2, k2))
    (Y' : 'M_(b2, k2)) : (X <= X')%MS -> (Y <= Y')%MS ->
  (block_mx X 0 0 Y <= block_mx X' 0 0 Y')%MS.
Proof.
case/submxP=> D1 ->; case/submxP=> D2 ->; apply/submxP; exists (block_mx D1 0 0 D2).
by rewrite mulmx_block !(mul0mx, mulmx0, addr0, add0r).
Qed.

Lemma span_block k1 k2 m (d1 d2 : 'I_m -> nat) (X : forall i, 'M[L]_(d1 i, k1))
    (Y : forall i, 'M[L]_(d2 i, k2)) (s : {set 'I_m}) :
  (span (fun i => block_mx (X i) 0 0 (Y i)) s :=: block_mx (span X s) 0 0 (span Y s))%MS.
Proof.
apply/eqmxP/andP; split.
  by apply/span_sub => i si; apply: block_sub; apply: sub_span.
set Z := span (fun i => block_mx (X i) 0 0 (Y i)) s.
have subZ i : i \in s -> (row_mx (X i) 0 <= Z)%MS /\ (row_mx 0 (Y i) <= Z)%MS.
  by move=> si; apply/andP; rewrite -col_mx_sub -block_mxEv; apply: sub_span.
rewrite block_mxEv col_mx_sub; apply/andP; split.
  have -> : row_mx (span X s) 0 = span X s *m row_mx 1%:M (0 : 'M_(k1, k2)).
    by rewrite mul_mx_row mulmx1 mulmx0.
  rewrite sumsmxMr_gen; apply/sumsmx_subP => i si; rewrite genmxE.
  rewrite (eqmxMr _ (genmxE _)) mul_mx_row mulmx1 mulmx0.
  by case: (subZ i si).
have -> : row_mx 0 (span Y s) = span Y s *m row_mx (0 : 'M_(k2, k1)) 1%:M.
  by rewrite mul_mx_row mulmx1 mulmx0.
rewrite sumsmxMr_gen; apply/sumsmx_subP => i si; rewrite genmxE.
rewrite (eqmxMr _ (genmxE _)) mul_mx_row mulmx1 mulmx0.
by case: (subZ i si).
Qed.

Lemma span_bigcup k m (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, k)) (N : 'I_m -> {set 'I_m}) s :
  (span (fun i => span V (N i)) s :=: span V (neighborhood N s))%MS.
Proof.
apply/eqmxP/andP; split; apply/span_sub => i.
  move=> si; apply/span_sub => j Nj; apply: sub_span; apply/bigcupP; by exists i.
case/bigcupP=> j sj Nj; apply: submx_trans (sub_span _ sj); exact: sub_span.
Qed.

(* the rows of an identity that belong to the sub-states of T *)
Definition select m (k : 'I_m -> nat) (T : {set 'I_m}) : 'M[L]_(\sum_i k i) :=
  \mxdiag_i (if i \in T then 1%:M else 0).

Lemma selectE m (k : 'I_m -> nat) T : shared_output L k T = select k T.
Proof.
rewrite -[RHS]mulmx1 -[X in _ *m X](submxcolK 1%:M) mul_mxdiag_mxcol.
apply: eq_mxcol => i; case: ifP => _; rewrite ?mul1mx ?mul0mx //.
by rewrite /shared_input tr_submxrow trmx1.
Qed.

Lemma rank_select m (k : 'I_m -> nat) T : \rank (select k T) = (\sum_(i in T) k i)%N.
Proof.
rewrite rank_mxdiag [RHS]big_mkcond; apply: eq_bigr => i _.
by case: ifP; rewrite ?mxrank1 ?mxrank0.
Qed.

Lemma select_mul m (k : 'I_m -> nat) T T' : select k T *m select k T' = select k (T :&: T').
Proof.
rewrite -[X in _ *m X]mulmx1 -[X in _ *m (_ *m X)](submxcolK 1%:M) !mul_mxdiag_mxcol.
rewrite -[RHS]mulmx1 -[X in _ = _ *m X](submxcolK 1%:M) !mul_mxdiag_mxcol.
apply: eq_mxcol => i; rewrite inE; case: (i \in T); case: (i \in T');
  by rewrite ?mul1mx ?mul0mx.
Qed.

Lemma selectC m (k : 'I_m -> nat) T : select k T + select k (~: T) = 1%:M.
Proof.
rewrite -mxdiagD -[RHS]mxdiagZ; apply: eq_mxdiag => i; rewrite inE.
by case: (i \in T); rewrite /= ?addr0 ?add0r.
Qed.

Lemma tr_select m (k : 'I_m -> nat) T : (select k T)^T = select k T.
Proof.
by rewrite tr_mxdiag; apply: eq_mxdiag => i; case: ifP => _; rewrite ?trmx1 ?trmx0.
Qed.

(* the sub-state part of the pencil *)
Lemma rank_select_pencil m (k : 'I_m -> nat) (T T' : {set 'I_m}) (lambda : L) :
  ~: T \subset T' ->
  \rank (block_mx (lambda%:M : 'M_(\sum_i k i)) (select k T) (select k T') 0) =
  (\sum_(i in T) k i + \sum_(i in T') k i)%N.
Proof.
move=> sTT'; have := rank_pencil lambda%:M (select k T) (select k T').
have -> : \rank (preimage lambda%:M (select k T') :&: kermx (select k T))%MS =
          \rank (select k (~: T)).
  apply: eqmx_rank; apply/andP; split.
    apply/rV_subP => v; rewrite sub_capmx [X in _ && X]sub_kermx => /andP[_ /eqP v0].
    by rewrite -[v]mulmx1 -(selectC k T) mulmxDr v0 add0r submxMl.
  rewrite sub_capmx; apply/andP; split; last first.
    by rewrite sub_kermx select_mul setIC setICr -mxrank_eq0 rank_select big_set0.
  rewrite sub_preimage.
  rewrite mul_mx_scalar; apply: scalemx_sub.
  by rewrite -(setIidPl sTT') -select_mul submxMl.
have sumC : (\sum_(i in T) k i + \sum_(i in ~: T) k i = \sum_i k i)%N.
  rewrite [RHS](bigID [pred i | i \in T]) /=; congr addn.
  by apply: eq_bigl => i; rewrite inE.
rewrite !rank_select => e; apply/eqP; rewrite -(eqn_add2r (\sum_(i in ~: T) k i)) e.
by rewrite -sumC addnAC.
Qed.

End Spaces.

Section Extended.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel L n p q) (s : {set 'I_m}) (lambda : L).

(* [lambda I - A, B_{m-s}; C_{N_s}, 0] *)
Definition neighbor_pencil S s lambda : 'M[L]_(n + \sum_i q i, n + \sum_i p i) :=
  block_mx (lambda%:M - mcA S) (inputs S (~: s)) (outputs S (neighborhood N s)) 0.

Lemma sub_neighborhood s : s \subset neighborhood N s.
Proof. by apply/subsetP => i si; apply/bigcupP; exists i. Qed.

(* sub-states heard from outside s *)
Definition heard s : nat := (\sum_(i in neighborhood N s :\: s) k i)%N.

Lemma sum_heard s : (\sum_(i in ~: s) k i + \sum_(i in neighborhood N s) k i =
  \sum_i k i + heard s)%N.
Proof.
have -> : (\sum_(i in neighborhood N s) k i = \sum_(i in s) k i + heard s)%N.
  by rewrite (big_setID s) /= (setIidPr (sub_neighborhood s)).
rewrite addnA; congr addn; rewrite addnC [RHS](bigID [pred i | i \in s]) /=; congr addn.
by apply: eq_bigl => i; rewrite inE.
Qed.

Lemma span_shared s : (span (fun i => (shared_input L k i)^T) s :=: select L k s)%MS.
Proof. by rewrite -selectE; apply: eqmx_sym; apply: mxcol_space. Qed.

Lemma eqmx_extended_inputs q' S (S' : multichannel L (n + \sum_i k i) (fun i => p i + k i)%N q') s :
  (forall i, mcB S' i = block_mx (mcB S i) 0 0 (shared_input L k i)) ->
  ((inputs S' s)^T :=: (block_mx (inputs S s) 0 0 (select L k s))^T)%MS.
Proof.
move=> eB; apply: eqmx_trans (eqmx_inputs _ _) _; rewrite trmxK.
have e i : i \in s -> ((mcB S' i)^T :=: block_mx (mcB S i)^T 0 0 (shared_input L k i)^T)%MS.
  by move=> _; rewrite eB tr_block_mx !trmx0.
apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
rewrite tr_block_mx !trmx0 tr_select; have eI := eqmx_inputs S s; rewrite trmxK in eI.
apply/eqmxP/andP; split; apply: block_sub.
- by rewrite eI.
- by rewrite span_shared.
- by rewrite eI.
- by rewrite span_shared.
Qed.

Lemma rank_extended_pencil q' r (S : multichannel L n p q) s lambda
    (S' : multichannel L (n + \sum_i k i) (fun i => p i + k i)%N q') (C : 'M_(r, n)) :
  mcA S' = block_mx (mcA S) 0 0 0 ->
  (forall i, mcB S' i = block_mx (mcB S i) 0 0 (shared_input L k i)) ->
  (outputs S' s :=: block_mx C 0 0 (select L k (neighborhood N s)))%MS ->
  \rank (pencil S' s lambda) =
  (\rank (block_mx (lambda%:M - mcA S) (inputs S (~: s)) C 0) + (\sum_i k i + heard s))%N.
Proof.
move=> eA eB eC; rewrite /pencil (rank_block_eq _ (eqmx_extended_inputs _ eB) eC) eA.
rewrite scalar_mx_block opp_block_mx add_block_mx !(subr0, oppr0, addr0) rank_block_diag.
by rewrite rank_select_pencil ?setCK ?sub_neighborhood // sum_heard.
Qed.

(* the rank identity: Sum over the union N_s, as the equation pppp should read *)
Theorem rank_extended S s lambda :
  \rank (pencil (extended N k S) s lambda) =
  (\rank (neighbor_pencil S s lambda) + \sum_i k i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite -[RHS]addnA; apply: rank_extended_pencil => //.
apply: eqmx_trans (eqmx_outputs _ _) _.
have e i : i \in s -> (mcC (extended N k S) i :=:
    block_mx (span (mcC S) (N i)) 0 0 (span (fun j => (shared_input L k j)^T) (N i)))%MS.
  move=> _ /=; rewrite selectE; apply/eqmxP/andP; split; apply: block_sub;
    by rewrite ?(eqmx_outputs S (N i)) ?span_shared.
apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
apply/eqmxP/andP; split; apply: block_sub.
- by rewrite span_bigcup (eqmx_outputs S).
- by rewrite span_bigcup span_shared.
- by rewrite span_bigcup (eqmx_outputs S).
- by rewrite span_bigcup span_shared.
Qed.

(* Remark 2: C_s in place of C_{N_s} when only sub-states are shared *)
Theorem rank_extended_states S s lambda :
  \rank (pencil (extended_states N k S) s lambda) =
  (\rank (pencil S s lambda) + \sum_i k i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite -[RHS]addnA; apply: rank_extended_pencil => //.
apply: eqmx_trans (eqmx_outputs _ _) _.
have e i : i \in s -> (mcC (extended_states N k S) i :=:
    block_mx (mcC S i) 0 0 (span (fun j => (shared_input L k j)^T) (N i)))%MS.
  move=> _ /=; rewrite selectE; apply/eqmxP/andP; split; apply: block_sub => //;
    by rewrite span_shared.
apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
apply/eqmxP/andP; split; apply: block_sub.
- by rewrite (eqmx_outputs S).
- by rewrite span_bigcup span_shared.
- by rewrite (eqmx_outputs S).
- by rewrite span_bigcup span_shared.
Qed.

(* the exact condition, for one lambda and every graph *)
Theorem extended_not_fixed S lambda :
  ~ fixed (extended N k S) lambda <->
  forall s, (n - \rank (neighbor_pencil S s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite anderson_clements; split=> [nf s|h [s]]; last first.
  by rewrite rank_extended addnAC ltn_add2r ltnNge -leq_subLR h.
rewrite leq_subLR leqNgt; apply/negP => lt; apply: nf; exists s.
by rewrite rank_extended addnAC ltn_add2r.
Qed.

Theorem extended_states_not_fixed S lambda :
  ~ fixed (extended_states N k S) lambda <->
  forall s, (n - \rank (pencil S s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite anderson_clements; split=> [nf s|h [s]]; last first.
  by rewrite rank_extended_states addnAC ltn_add2r ltnNge -leq_subLR h.
rewrite leq_subLR leqNgt; apply/negP => lt; apply: nf; exists s.
by rewrite rank_extended_states addnAC ltn_add2r.
Qed.

End Extended.
