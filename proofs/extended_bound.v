(* Theorem 2, Remark 2, the exact condition on the n_i over every extension field, Proposition 3. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Map.
Variables (K L : ringType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat).
Implicit Types (S : multichannel K n p q).

Lemma map_shared_input i : map_mx f (shared_input K k i) = shared_input L k i.
Proof. by apply/matrixP => x y; rewrite !mxE rmorph_nat. Qed.

Lemma map_shared_output T : map_mx f (shared_output K k T) = shared_output L k T.
Proof.
apply/mxcolP => i; rewrite mxcolK.
have := mxcolK (fun i => if i \in T then (shared_input K k i)^T else 0) i.
rewrite /shared_output; move: (mxcol _) => M; rewrite /submxcol => e.
rewrite -map_mxsub e; case: ifP => _; last by rewrite map_mx0.
by rewrite -map_trmx map_shared_input.
Qed.

Lemma pencil_eq n' (p' q' : 'I_m -> nat) (S S' : multichannel L n' p' q') s lambda :
  mcA S = mcA S' -> (forall i, mcB S i = mcB S' i) -> (forall i, mcC S i = mcC S' i) ->
  pencil S s lambda = pencil S' s lambda.
Proof.
move=> eA eB eC; rewrite /pencil eA; congr block_mx.
  by apply: eq_mxrow => i; rewrite eB.
by apply: eq_mxcol => i; rewrite eC.
Qed.

Lemma pencil_map_extended S s lambda :
  pencil (map_system f (extended N k S)) s lambda =
  pencil (extended N k (map_system f S)) s lambda.
Proof.
apply: pencil_eq => [|i|i] /=; rewrite map_block_mx ?map_mx0 //.
  by rewrite map_shared_input.
by rewrite map_outputs map_shared_output.
Qed.

Lemma pencil_map_extended_states S s lambda :
  pencil (map_system f (extended_states N k S)) s lambda =
  pencil (extended_states N k (map_system f S)) s lambda.
Proof.
apply: pencil_eq => [|i|i] /=; rewrite map_block_mx ?map_mx0 //.
  by rewrite map_shared_input.
by rewrite map_shared_output.
Qed.

End Map.

Section Exact.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel K n p q) (lambda : L).

(* delta_s(lambda), what P_s lacks of rank n, and the same in Remark 2 *)
Definition deficiency S s lambda := (n - \rank (neighbor_pencil N (map_system f S) s lambda))%N.
Definition deficiency_states S s lambda := (n - \rank (pencil (map_system f S) s lambda))%N.

Lemma fixed_over_extended S lambda :
  fixed_over f (extended N k S) lambda <-> fixed (extended N k (map_system f S)) lambda.
Proof.
rewrite anderson_clements_over anderson_clements.
by split=> -[s h]; exists s; move: h; rewrite pencil_map_extended.
Qed.

Lemma fixed_over_extended_states S lambda :
  fixed_over f (extended_states N k S) lambda <-> fixed (extended_states N k (map_system f S)) lambda.
Proof.
rewrite anderson_clements_over anderson_clements.
by split=> -[s h]; exists s; move: h; rewrite pencil_map_extended_states.
Qed.

(* away from the eigenvalues of A nothing is deficient *)
Lemma le_rank_block r1 r2 (M : 'M[L]_n) (B : 'M_(n, r1)) (C : 'M_(r2, n)) :
  (\rank M <= \rank (block_mx M B C 0))%N.
Proof.
have e : row_mx 1%:M 0 *m block_mx M B C 0 *m col_mx 1%:M 0 = M.
  by rewrite mul_row_block mul_row_col !(mul1mx, mul0mx, mulmx1, mulmx0, addr0).
by rewrite -{1}e (leq_trans (mxrankM_maxl _ _)) // mxrankM_maxr.
Qed.

Lemma deficient_block0 S r1 r2 (B : 'M_(n, r1)) (C : 'M_(r2, n)) lambda :
  ~~ eigenvalue (map_mx f (mcA S)) lambda ->
  (n - \rank (block_mx (lambda%:M - map_mx f (mcA S)) B C 0) = 0)%N.
Proof.
rewrite eigenvalue_rank -leqNgt => h; apply/eqP; rewrite subn_eq0.
exact: leq_trans h (le_rank_block _ _ _).
Qed.

Lemma deficient0 S s lambda : ~~ eigenvalue (map_mx f (mcA S)) lambda -> deficiency S s lambda = 0%N.
Proof. exact: deficient_block0. Qed.

Lemma deficient_states0 S s lambda :
  ~~ eigenvalue (map_mx f (mcA S)) lambda -> deficiency_states S s lambda = 0%N.
Proof. exact: deficient_block0. Qed.

(* no fixed eigenvalue iff sum_{i in N_s \ s} n_i >= delta_s(lambda) for all s and all
   eigenvalues lambda of A *)
Theorem extended_no_fixed S :
  (forall lambda : L, ~ fixed_over f (extended N k S) lambda) <->
  (forall s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda ->
     (deficiency S s lambda <= \sum_(i in neighborhood N s :\: s) k i)%N).
Proof.
split=> h.
  by move=> s lambda _; have := h lambda; rewrite fixed_over_extended extended_not_fixed //; apply.
move=> lambda; rewrite fixed_over_extended extended_not_fixed // => s.
rewrite -/(deficiency S s lambda).
by have [/h|/deficient0->] := boolP (eigenvalue (map_mx f (mcA S)) lambda).
Qed.

Theorem extended_states_no_fixed S :
  (forall lambda : L, ~ fixed_over f (extended_states N k S) lambda) <->
  (forall s (lambda : L), eigenvalue (map_mx f (mcA S)) lambda ->
     (deficiency_states S s lambda <= \sum_(i in neighborhood N s :\: s) k i)%N).
Proof.
split=> h.
  move=> s lambda _; have := h lambda.
  by rewrite fixed_over_extended_states extended_states_not_fixed //; apply.
move=> lambda; rewrite fixed_over_extended_states extended_states_not_fixed // => s.
rewrite -/(deficiency_states S s lambda).
by have [/h|/deficient_states0->] := boolP (eigenvalue (map_mx f (mcA S)) lambda).
Qed.

Lemma neighborhood0 : neighborhood N set0 = set0.
Proof. by rewrite /neighborhood big_set0. Qed.

Lemma neighborhoodT : neighborhood N setT = setT.
Proof. by apply/eqP; rewrite eqEsubset subsetT sub_neighborhood. Qed.

Lemma heard_enough r s : strongly_connected (neighbor_arc N) -> s != set0 -> s != setT ->
  (forall i, r <= k i)%N -> (r <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
move=> /neighborhood_strongly_connected sc s0 sT h; have /set0Pn[j sj] := sc s s0 sT.
by rewrite (bigD1 j) //=; apply: leq_trans (h j) (leq_addr _ _).
Qed.

(* Theorem 2 *)
Theorem theorem_2 S : strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S ->
  (forall i s (lambda : L), s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  forall lambda : L, ~ fixed_over f (extended N k S) lambda.
Proof.
move=> sc jc jo h; apply/extended_no_fixed => s lambda el.
have [->|s0] := eqVneq s set0.
  rewrite /deficiency /neighbor_pencil neighborhood0.
  by rewrite -/(pencil (map_system f S) set0 lambda) jointly_controllable_pencil // subnn.
have [->|sT] := eqVneq s setT.
  rewrite /deficiency /neighbor_pencil neighborhoodT.
  by rewrite -/(pencil (map_system f S) setT lambda) jointly_observable_pencil // subnn.
by apply: heard_enough => // i; apply: h.
Qed.

(* Remark 2 *)
Theorem remark_2 S : strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S ->
  (forall i s (lambda : L), s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (pencil (map_system f S) s lambda) <= k i)%N) ->
  forall lambda : L, ~ fixed_over f (extended_states N k S) lambda.
Proof.
move=> sc jc jo h; apply/extended_states_no_fixed => s lambda el.
have [->|s0] := eqVneq s set0.
  by rewrite /deficiency_states jointly_controllable_pencil // subnn.
have [->|sT] := eqVneq s setT.
  by rewrite /deficiency_states jointly_observable_pencil // subnn.
by apply: heard_enough => // i; apply: h.
Qed.

(* C_{N_s} demands no more than C_s *)
Theorem deficiency_le S s lambda : (deficiency S s lambda <= deficiency_states S s lambda)%N.
Proof.
apply: leq_sub2l; apply: rank_block_le => //.
rewrite !eqmx_outputs; apply: output_spaceS; exact: sub_neighborhood.
Qed.

End Exact.

Section Transfer.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel K n p q).

(* an arc from j to i: C_i (sI - A)^{-1} B_j, whose Markov parameters are C_i A^t B_j, is not zero *)
Definition transfer_arc n' (p' q' : 'I_m -> nat) (S : multichannel K n' p' q') : rel 'I_m := fun j i =>
  [exists t : 'I_n', mcC S i *m krylov (mcA S) (mcB S j) t != 0].

(* Markov parameters beyond the first n bring nothing new *)
Lemma transfer_arcP n' (p' q' : 'I_m -> nat) (S : multichannel K n' p' q') j i :
  reflect (exists t, mcC S i *m krylov (mcA S) (mcB S j) t != 0) (transfer_arc S j i).
Proof.
apply: (iffP existsP) => [[t h]|[t h]]; first by exists t.
apply/existsP; rewrite -[X in is_true X]negbK negb_exists; apply: contra h => /forallP h.
have sk : (kermx (reach (mcA S) (mcB S j) (maxn n' t.+1)) <= kermx (reach (mcA S) (mcB S j) n'))%MS.
  apply/sub_kermxP/reach_annihilated => u un.
  have /reach_annihilated := mulmx_ker (reach (mcA S) (mcB S j) (maxn n' t.+1)); apply.
  by apply: leq_trans un (leq_maxl _ _).
have := mxrank_leqif_sup sk; rewrite !mxrank_ker rank_reach_n ?leq_maxl // => -[_].
rewrite eqxx => /esym sk'.
have /sub_kermxP/submx_trans/(_ sk')/sub_kermxP/reach_annihilated :
    mcC S i *m reach (mcA S) (mcB S j) n' = 0.
  by apply/reach_annihilated => u un; have := h (Ordinal un); rewrite negbK => /eqP.
by move=> ->; rewrite // leq_maxr.
Qed.

Lemma krylov_block r k' r' (A : 'M[K]_n) (B : 'M[K]_(n, r)) (E' : 'M[K]_(k', r')) t :
  krylov (block_mx A 0 0 0) (block_mx B 0 0 E') t =
  block_mx (krylov A B t) 0 0 (if t is 0 then E' else 0).
Proof.
elim: t => [//|t IH]; rewrite krylovS IH mulmx_block.
by rewrite !(mul0mx, mulmx0, addr0, add0r) -krylovS.
Qed.

(* x_j reaches every agent that hears it *)
Lemma shared_output_input (T : {set 'I_m}) j : j \in T -> (0 < k j)%N ->
  shared_output K k T *m shared_input K k j != 0.
Proof.
move=> Tj kj; apply/eqP => /(congr1 (fun M => submxcol M j)).
rewrite submxcol0 -submxcol_mul mxcolK Tj /shared_input tr_submxrow trmx1 submxcol_mul mul1mx.
move/matrixP/(_ (Ordinal kj) (Ordinal kj)); rewrite !mxE eqxx => /eqP.
by rewrite oner_eq0.
Qed.

(* Proposition 3, for one arc: it asks n_j > 0 of the sending agent alone *)
Theorem proposition_3 S j i : (0 < k j)%N -> neighbor_arc N j i || transfer_arc S j i ->
  transfer_arc (extended N k S) j i.
Proof.
move=> kj /orP[Nji|/transfer_arcP[t h]]; apply/transfer_arcP.
  exists 0%N; rewrite /krylov /= mulmx_block !(mul0mx, mulmx0, addr0, add0r).
  rewrite -mxrank_eq0 rank_diag_block_mx addn_eq0 negb_and; apply/orP; right.
  by rewrite mxrank_eq0 shared_output_input.
exists t; rewrite /= krylov_block mulmx_block !(mul0mx, mulmx0, addr0, add0r).
rewrite -mxrank_eq0 rank_diag_block_mx addn_eq0 negb_and; apply/orP; left.
rewrite mxrank_eq0; apply: contraNneq h => e; apply/eqP.
have /submxP[D ->] : (mcC S i <= outputs S (N i))%MS.
  by rewrite eqmx_outputs; apply: output_space_sup.
by rewrite -mulmxA e mulmx0.
Qed.

Theorem proposition_3_strongly_connected S : (forall i, 0 < k i)%N ->
  strongly_connected (neighbor_arc N) -> strongly_connected (transfer_arc (extended N k S)).
Proof.
by move=> k0; apply: strongly_connected_sub => j i Nji; apply: proposition_3; rewrite ?Nji.
Qed.

End Transfer.
