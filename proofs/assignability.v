(* checker/modes.py: kind `assignability`, how det(xI - A_F) splits over the strong components.

   `minimal_evidence` is what the checker is given for one component c and checks modulo l: a space X that is
   invariant and holds B_c, and a map W of it onto (A', B', C'), which is controllable and observable.
   The inputs and outputs of c are stacked with zero blocks for the other channels, as in multichannel.v. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import extended_bound feedback strong_components complementary_subsystem spectrum_split.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Assignability.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Notation Qm := (map_mx (@Zloc_rat l)).
Notation SQ := (map_system (@Zloc_rat l) S).
Implicit Types (c : {set 'I_m}).

Record minimal_evidence c := MinimalEvidence {
  me_dim : nat;
  me_zero : zero_transfer SQ c set0;
  me_W : 'M[rat]_(me_dim, zt_dim me_zero);
  me_A : 'M[Zloc l]_me_dim;
  me_B : 'M[Zloc l]_(me_dim, \sum_i p i);
  me_C : 'M[Zloc l]_(\sum_i q i, me_dim);
  me_state : me_W *m rowsub (zt_pivots (z := me_zero)) (mcA SQ *m zt_X me_zero) = Qm me_A *m me_W;
  me_input : Qm me_B = me_W *m rowsub (zt_pivots (z := me_zero)) (inputs SQ c);
  me_output : outputs SQ c *m zt_X me_zero = Qm me_C *m me_W;
  me_controllable : reached (reach me_A me_B me_dim) me_dim;
  me_observable : reached (reach me_A^T me_C^T me_dim) me_dim }.

(* All gains in one matrix, block diagonal; det(xI - A' - B' F C') *)
Definition gain_matrix (L : fieldType) (F : gains L p q) : 'M[L]_(\sum_i p i, \sum_i q i) :=
  \mxcol_i (F i *m submxcol 1%:M i).

Definition component_polynomial c (E : minimal_evidence c) (L : fieldType) (f : {rmorphism rat -> L})
    (F : gains L p q) : {poly L} :=
  char_poly (map_mx f (Qm (me_A E)) + map_mx f (Qm (me_B E)) *m gain_matrix F *m map_mx f (Qm (me_C E))).

Lemma gain_matrixE (L : fieldType) (F : gains L p q) r t (B : 'M_(r, _)) (C : 'M_(_, t)) :
  B *m gain_matrix F *m C = \sum_i submxrow B i *m F i *m submxcol C i.
Proof.
rewrite -[B in LHS]submxrowK mul_mxrow_mxcol mulmx_suml; apply: eq_bigr => i _.
by rewrite -!mulmxA submxcol_mul mul1mx.
Qed.

Lemma reached_free d e (M : 'M[Zloc l]_(d, e)) : reached M d -> row_free (Qm M).
Proof.
case=> Y [Z YZ]; rewrite /row_free eqn_leq rank_leq_row.
exact: (rank_from_below [rmorphism of (@idfun rat)] YZ).
Qed.

Lemma me_reach c (E : minimal_evidence c) : row_free (reach (Qm (me_A E)) (Qm (me_B E)) (me_dim E)).
Proof. by rewrite -map_reach; apply/reached_free/me_controllable. Qed.
Lemma me_observe c (E : minimal_evidence c) : row_free (reach (Qm (me_A E))^T (Qm (me_C E))^T (me_dim E)).
Proof. by rewrite !map_trmx -map_reach; apply/reached_free/me_observable. Qed.

(* It realizes the transfer matrix of the component. *)
Theorem component_realized c (E : minimal_evidence c) k :
  outputs SQ c *m krylov (mcA SQ) (inputs SQ c) k =
  Qm (me_C E) *m krylov (Qm (me_A E)) (Qm (me_B E)) k.
Proof.
case: E => d [x X piv inv inp /= _] W A B C eA eB eC _ _ /=; rewrite /= in W eA eB eC.
have eI : inputs SQ c = X *m rowsub piv (inputs SQ c).
  rewrite -[in RHS](mul1mx (inputs _ _)) -mul_rowsub_mx mulmxA /inputs mul_mxrow; apply/eq_mxrow => i.
  case: ifP => ic; last by rewrite mulmx0.
  by rewrite -mulmxA mul_rowsub_mx mul1mx -inp.
have kX : krylov (mcA SQ) (inputs SQ c) k =
    X *m krylov (rowsub piv (mcA SQ *m X)) (rowsub piv (inputs SQ c)) k.
  elim: k => [|k IH]; first exact: eI.
  by rewrite !krylovS IH !mulmxA {1}inv.
rewrite kX mulmxA eC -mulmxA; congr (_ *m _); rewrite eB; elim: k {kX} => [//|k IH].
by rewrite !krylovS -IH !mulmxA eA.
Qed.

(* Its dimension is the McMillan degree: no realization is smaller. *)
Theorem mcmillan_degree c (E : minimal_evidence c) n' (A : 'M[rat]_n') B C :
  (forall k, C *m krylov A B k = outputs SQ c *m krylov (mcA SQ) (inputs SQ c) k) -> (me_dim E <= n')%N.
Proof.
move=> same; apply: (@minimal_realization _ _ _ _ _ A B C _ _ _ _ _ (me_reach E) (me_observe E)) => k.
by rewrite same (component_realized E).
Qed.

(* The factor of a component depends on its own gains alone. *)
Theorem component_own_gains c (E : minimal_evidence c) (L : fieldType) (f : {rmorphism rat -> L})
    (F F' : gains L p q) : (forall i, i \in c -> F i = F' i) ->
  component_polynomial E f F = component_polynomial E f F'.
Proof.
move=> same; congr (char_poly (_ + _)); rewrite !gain_matrixE; apply: eq_bigr => i _.
have [ic|ic] := boolP (i \in c); first by rewrite same.
suff -> : submxrow (map_mx f (Qm (me_B E))) i = 0 by rewrite !mul0mx.
have z : submxrow (inputs SQ c) i = 0 by rewrite mxrowK (negPf ic).
rewrite me_input /submxrow -map_mxsub -mulmx_colsub -mxsubcr mxsubrc; rewrite /submxrow in z.
rewrite z [rowsub _ 0](_ : _ = 0) ?mulmx0 ?map_mx0//.
by apply/matrixP=> u v; rewrite !mxE.
Qed.

(* The components: what the checker names blocks. *)
Variables (nb : nat) (comp : 'I_nb -> {set 'I_m}).
Hypothesis comp_inj : injective comp.
Hypothesis comp_all : [set comp b | b in 'I_nb] = [set component (arc SQ) j | j in 'I_m].
Variable E : forall b, minimal_evidence (comp b).

Lemma comp_of i : exists b, i \in comp b.
Proof.
have : component (arc SQ) i \in [set comp b | b in 'I_nb] by rewrite comp_all imset_f.
by case/imsetP=> b _ e; exists b; rewrite -e component_rule connect0.
Qed.

Lemma comp_connect b i j : i \in comp b ->
  (j \in comp b) = connect (arc SQ) i j && connect (arc SQ) j i.
Proof.
have : comp b \in [set component (arc SQ) j | j in 'I_m] by rewrite -comp_all imset_f.
case/imsetP=> r _ ->; rewrite !component_rule => /andP[ri ir].
apply/andP/andP=> -[h1 h2]; split.
- exact: connect_trans ir h1.
- exact: connect_trans h2 ri.
- exact: connect_trans ri h1.
exact: connect_trans h2 ir.
Qed.

Theorem assignability_rule : exists phi : {poly rat},
  [/\ phi \is monic, (size phi + \sum_b me_dim (E b) = n.+1)%N &
  forall (L : fieldType) (f : {rmorphism rat -> L}) (F : gains L p q),
    char_poly (closed_loop (map_system f SQ) F) =
    map_poly f phi * \prod_b component_polynomial (E b) f F].
Proof.
pose ahead b := [set k | [exists x in comp b, connect (arc SQ) x k]].
have [|b b' _ _ bb' h k|phi [mphi s split]] := @spectrum_split rat_fieldType [finType of 'I_nb]
  (fun=> (\sum_i p i)%N) (fun=> (\sum_i q i)%N) (fun b => me_dim (E b)) (fun b => #|ahead b|)
  (fun b => Qm (me_A (E b))) (fun b => Qm (me_B (E b))) (fun b => Qm (me_C (E b)))
  (fun b => me_dim (E b)) (fun b => me_dim (E b)) (fun b => me_reach (E b)) (fun b => me_observe (E b))
  setT n (mcA SQ) (fun b => inputs SQ (comp b)) (fun b => outputs SQ (comp b)).
- by move=> b _ k; apply: component_realized.
- have none : forall j i, j \in comp b -> i \in comp b' -> ~~ arc SQ j i.
    move=> j i jb ib'; apply: contraNN bb' => ji.
    have aheadE b0 i0 k0 : i0 \in comp b0 -> (k0 \in ahead b0) = connect (arc SQ) i0 k0.
      move=> i0b; rewrite inE; apply/existsP/idP=> [[x /andP[xb xk]]|ik].
        by apply: connect_trans xk; have := comp_connect x i0b; rewrite xb => /esym/andP[].
      by exists i0; rewrite i0b.
    have le : ahead b' \subset ahead b.
      apply/subsetP=> t; rewrite (aheadE _ _ _ ib') (aheadE _ _ _ jb); apply: connect_trans.
      exact: connect1.
    have ge : ahead b \subset ahead b' by rewrite -(geq_leqif (subset_leqif_card le)).
    have ij : connect (arc SQ) i j.
      by rewrite -(aheadE _ _ _ ib') (subsetP ge)// (aheadE _ _ _ jb) connect0.
    have ib : i \in comp b by rewrite (comp_connect _ jb) connect1.
    apply/eqP/comp_inj/setP=> t; by rewrite (comp_connect t ib) (comp_connect t ib').
  apply/outputs_eq0 => i ib'; rewrite -[inputs _ _]mul1mx krylovM mulmxA /inputs mul_mxrow.
  apply/mxrowP=> j; rewrite mxrowK submxrow0; case: ifP => [jb|_]; last exact: mulmx0.
  rewrite -mulmxA -krylovM mul1mx; apply: contraNeq (none j i jb ib') => nz.
  have : transfer_arc SQ j i by apply/transfer_arcP; exists k.
  by case/existsP=> t nzt; apply: transfer_markov; exists t; rewrite ltn_ord.
exists phi; split=> [//||L f F].
  by rewrite -s; congr (_ + _)%N; apply: eq_bigl => b; rewrite inE.
have := split L f (fun=> gain_matrix F); rewrite !(eq_bigl xpredT _ (fun b => in_setT b)) => <-.
congr (char_poly (_ + _)).
rewrite [RHS](eq_bigr (fun b => \sum_(i | i \in comp b) map_mx f (mcB SQ i) *m F i *m map_mx f (mcC SQ i))).
  under [RHS]eq_bigr => b _ do rewrite big_mkcond; rewrite exchange_big /=; apply: eq_bigr => i _.
  have [b0 ib0] := comp_of i; rewrite -big_mkcond (big_pred1 b0)// => b /=.
  apply/idP/eqP=> [ib|->//]; apply/comp_inj/setP=> t.
  by rewrite (comp_connect t ib) (comp_connect t ib0).
move=> b _; rewrite map_inputs map_outputs gain_matrixE [RHS]big_mkcond; apply: eq_bigr => i _.
by rewrite mxrowK mxcolK; case: ifP => // _; rewrite mulmx0.
Qed.
End Assignability.
