(* The transfer graphs of the lifted and of the held system (end of V-A, end of V-B): if n_j > 0 the
   arcs from j are, under holding, exactly those of the neighbor graph and of the transfer graph of
   the plant; without holding these are among them. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import joint_controllability extended neighbor_graph extended_bound.
From mcexact Require Import delayed_systems.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Delayed.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (S : multichannel K n p q).
Hypothesis hears : forall i, i \in N i.

Lemma krylov_lower n' a b (A : 'M[K]_n) (G : 'M_(n', n)) (Z : 'M_n') (B : 'M_(n, a)) (H : 'M_(n', b)) t :
  exists X, krylov (block_mx A 0 G Z) (block_mx B 0 0 H) t = block_mx (krylov A B t) 0 X (krylov Z H t).
Proof.
elim: t => [|t [X e]]; first by exists 0.
exists (G *m krylov A B t + Z *m X); rewrite krylovS e mulmx_block.
by rewrite !(mulmx0, mul0mx, addr0, add0r).
Qed.

Lemma block0 a b c e (P : 'M[K]_(a, b)) (P' : 'M_(a, c)) (X : 'M_(e, b)) (Y : 'M_(e, c)) :
  block_mx P P' X Y = 0 -> P = 0 /\ Y = 0.
Proof.
rewrite -[0 in RHS](block_mx0 _ a e b c); move/eq_block_mx => [-> _ _ ->]; by [].
Qed.

(* one step of a shift *)
Lemma sub_state_step j t : (t < dmax N d j)%N ->
  sub_state K q N k d j t.+1 *m lifted_K K q N k d = sub_state K q N k d j t.
Proof.
move=> td; rewrite /sub_state /lifted_K -mulmxA block_diag mulmxA mul_row_block.
by rewrite !(mulmx0, mul0mx, addr0) pick_shiftS.
Qed.

Lemma sub_state_delay j t r (H : 'M[K]_(_, r)) : (t <= dmax N d j)%N ->
  sub_state K q N k d j t *m krylov (lifted_K K q N k d) H t = sub_state K q N k d j 0 *m H.
Proof.
by elim: t => [//|t IH] td; rewrite krylovS mulmxA sub_state_step // IH // ltnW.
Qed.

Lemma sub_state_tr j : sub_state K q N k d j 0 *m (sub_state K q N k d j 0)^T = 1%:M.
Proof.
rewrite /sub_state trmx_mul mulmxA -(mulmxA _ (agent_block _ _ j)) block_tr mulmx1.
by rewrite tr_row_mx mul_row_col trmx0 mulmx0 addr0 pick_tr.
Qed.

Lemma unit_nonzero (j : 'I_m) : (0 < k j)%N -> (1%:M : 'M[K]_(k j)) <> 0.
Proof. by move=> kj e; have := mxrank1 K (k j); rewrite e mxrank0 => e'; rewrite -e' in kj. Qed.

Theorem lifted_arcs j i : (0 < k j)%N -> d i i = 0%N ->
  neighbor_arc N j i || transfer_arc S j i -> transfer_arc (lifted N k d S) j i.
Proof.
move=> kj dii; case/orP=> [Nji|/transfer_arcP[t h]]; apply/transfer_arcP.
  have Nj : j \in N i := Nji; exists (d i j); apply/eqP => /=.
  have [X ->] := @krylov_lower _ _ _ (mcA S) (lifted_G N k d S) (lifted_K K q N k d)
    (mcB S j) (sub_state K q N k d j 0)^T (d i j).
  rewrite mulmx_block => /block0[_]; rewrite !mul0mx add0r mul_col_mx -[0 in RHS]col_mx0.
  case/eq_col_mx=> _; rewrite mxcol_mul => /mxcolP/(_ j); rewrite mxcolK Nj submxcol0.
  have dj : (d i j <= dmax N d j)%N by apply: (leq_bigmax_cond (F := fun i => d i j)).
  by rewrite sub_state_delay // sub_state_tr; apply: unit_nonzero.
exists t; apply/eqP => /=.
have [X ->] := @krylov_lower _ _ _ (mcA S) (lifted_G N k d S) (lifted_K K q N k d)
  (mcB S j) (sub_state K q N k d j 0)^T t.
rewrite mulmx_block => /block0[]; rewrite !mul0mx addr0 mxcol_mul => /mxcolP/(_ i).
by rewrite mxcolK hears dii submxcol0 => e; rewrite e eqxx in h.
Qed.

Lemma held_step j t : (t < dmax N d j)%N ->
  held_state K N k d j t.+1 *m (\mxdiag_i shift K (dmax N d i).+1 (k i)) = held_state K N k d j t.
Proof.
by move=> td; rewrite /held_state -mulmxA block_diag mulmxA pick_shiftS.
Qed.

Lemma held_delay j t r (H : 'M[K]_(_, r)) : (t <= dmax N d j)%N ->
  held_state K N k d j t *m krylov (\mxdiag_i shift K (dmax N d i).+1 (k i)) H t =
  held_state K N k d j 0 *m H.
Proof. by elim: t => [//|t IH] td; rewrite krylovS mulmxA held_step // IH // ltnW. Qed.

Lemma held_tr j : held_state K N k d j 0 *m (held_state K N k d j 0)^T = 1%:M.
Proof.
rewrite /held_state trmx_mul mulmxA -(mulmxA _ (agent_block _ _ j)) block_tr mulmx1.
by rewrite pick_tr.
Qed.

(* agents do not mix *)
Lemma held_apart j l s t : l != j ->
  held_state K N k d l s *m krylov (\mxdiag_i shift K (dmax N d i).+1 (k i))
    (held_state K N k d j 0)^T t = 0.
Proof.
move=> lj; rewrite /held_state trmx_mul.
elim: t (pick _ _ (k l) s) => [|t IH] X.
  by rewrite /krylov /= mulmxA -(mulmxA X) block_tr0 // mulmx0 mul0mx.
rewrite krylovS mulmxA -(mulmxA X) block_diag (mulmxA X); exact: IH.
Qed.

Lemma krylov_diag n' a b (A : 'M[K]_n) (Z : 'M_n') (B : 'M_(n, a)) (H : 'M_(n', b)) t :
  krylov (block_mx A 0 0 Z) (block_mx B 0 0 H) t = block_mx (krylov A B t) 0 0 (krylov Z H t).
Proof.
elim: t => [//|t IH]; rewrite !krylovS IH mulmx_block.
by rewrite !(mulmx0, mul0mx, addr0, add0r).
Qed.

Theorem held_arcs j i : (0 < k j)%N ->
  transfer_arc (held N k d S) j i <-> neighbor_arc N j i || transfer_arc S j i.
Proof.
move=> kj; pose Z := \mxdiag_i shift K (dmax N d i).+1 (k i); pose H := (held_state K N k d j 0)^T.
pose R := \mxcol_l (if l \in N i then held_state K N k d l (dmax N d l) else 0).
have kr t : mcC (held N k d S) i *m krylov (mcA (held N k d S)) (mcB (held N k d S) j) t =
    block_mx (mcC S i *m krylov (mcA S) (mcB S j) t) 0 0 (R *m krylov Z H t).
  by rewrite /= krylov_diag mulmx_block !(mulmx0, mul0mx, addr0, add0r).
split=> [/transfer_arcP[t]|].
  rewrite kr; have [//|] := boolP (neighbor_arc N j i || transfer_arc S j i).
  rewrite negb_or => /andP[Nji na]; case/eqP.
  have -> : mcC S i *m krylov (mcA S) (mcB S j) t = 0.
    by apply/eqP; apply: contraNT na => h; apply/transfer_arcP; exists t.
  have -> : R *m krylov Z H t = 0; last by rewrite block_mx0.
  rewrite /R mxcol_mul; apply/mxcolP => l; rewrite mxcolK submxcol0.
  case: ifP => [Nl|_]; last by rewrite mul0mx.
  by apply: held_apart; apply: contraNneq Nji => <-.
case/orP=> [Nji|/transfer_arcP[t h]]; apply/transfer_arcP.
  have Nj : j \in N i := Nji; exists (dmax N d j); rewrite kr; apply/eqP => /block0[_].
  rewrite /R mxcol_mul => /mxcolP/(_ j); rewrite mxcolK Nj submxcol0.
  by rewrite held_delay // held_tr; apply: unit_nonzero.
by exists t; rewrite kr; apply/eqP => /block0[e _]; rewrite e eqxx in h.
Qed.

(* end of V-B: strongly connected iff the union of the two graphs is *)
Theorem held_strongly_connected : (forall i, 0 < k i)%N ->
  strongly_connected (transfer_arc (held N k d S)) <->
  strongly_connected (fun j i => neighbor_arc N j i || transfer_arc S j i).
Proof.
by move=> k0; split; apply: strongly_connected_sub => j i a; apply/(held_arcs i (k0 j)).
Qed.

(* end of V-A *)
Theorem lifted_strongly_connected : (forall i, 0 < k i)%N -> (forall i, d i i = 0%N) ->
  strongly_connected (neighbor_arc N) -> strongly_connected (transfer_arc (lifted N k d S)).
Proof.
move=> k0 d0; apply: strongly_connected_sub => j i Nji; apply: lifted_arcs => //.
by rewrite Nji.
Qed.

End Delayed.
