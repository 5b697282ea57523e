(* Controllability and observability by Kalman's rank, what they say of every row vector and of
   P_s(lambda) at s empty and s = m, over every extension field. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability pencil_space anderson_clements.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Pair.
Variables (K : fieldType) (n b : nat).
Implicit Types (A : 'M[K]_n) (B : 'M[K]_(n, b)).

(* rank [B, AB, ..., A^{n-1} B] = n *)
Definition controllable A B := \rank (reach A B n) == n.

(* the controllability index is nu: nu blocks reach rank n, fewer do not *)
Definition controllability_index A B nu :=
  \rank (reach A B nu) = n /\ forall j, (j < nu)%N -> (\rank (reach A B j) < n)%N.

Lemma rank_reachP A B k : reflect
  (forall w : 'rV_n, (forall i, (i < k)%N -> w *m krylov A B i = 0) -> w = 0)
  (\rank (reach A B k) == n).
Proof.
apply: (iffP idP) => [fr w|h]; last first.
  rewrite -/(row_free (reach A B k)) -kermx_eq0; apply/rowV0P => w /sub_kermxP/reach_annihilated.
  exact: h.
by move/reach_annihilated => e; apply: (row_free_inj fr); rewrite e mul0mx.
Qed.

Lemma reach_sub A B j k : (j <= k)%N -> (\rank (reach A B j) <= \rank (reach A B k))%N.
Proof.
move=> jk; have : (kermx (reach A B k) <= kermx (reach A B j))%MS.
  apply/sub_kermxP/reach_annihilated => i ij.
  have /reach_annihilated := mulmx_ker (reach A B k); apply; exact: leq_trans jk.
move/mxrankS; rewrite !mxrank_ker => h.
by rewrite -(subKn (rank_leq_row (reach A B j))) -(subKn (rank_leq_row (reach A B k))) leq_sub2l.
Qed.

(* n blocks reach all that any number of blocks reaches *)
Lemma rank_reach_n A B k : (n <= k)%N -> \rank (reach A B k) = \rank (reach A B n).
Proof.
have [j jn e] : exists2 j, (j <= n)%N & \rank (reach A B j.+1) = \rank (reach A B j).
  have [/existsP[j /eqP h]|] := boolP [exists j : 'I_n.+1, \rank (reach A B j.+1) == \rank (reach A B j)].
    by exists j; rewrite // -ltnS.
  rewrite negb_exists => /forallP h; have grow j : (j <= n.+1)%N -> (j <= \rank (reach A B j))%N.
    elim: j => // j IH jn; apply: leq_ltn_trans (IH (ltnW jn)) _.
    by rewrite ltn_neqAle eq_sym (h (Ordinal jn)) reach_sub.
  by have := grow _ (leqnn _); rewrite leqNgt ltnS rank_leq_row.
move=> nk; rewrite (indices_stationary e (leq_trans jn nk)).
by rewrite (indices_stationary e jn).
Qed.

Lemma controllableP A B : reflect
  (forall w : 'rV_n, (forall i, w *m krylov A B i = 0) -> w = 0) (controllable A B).
Proof.
apply: (iffP idP) => [/rank_reachP h w wz|h]; first by apply: h => i _; apply: wz.
apply/rank_reachP => w wz; apply: h => i.
have : \rank (reach A B (maxn n i.+1)) = \rank (reach A B n) by rewrite rank_reach_n // leq_maxl.
move=> e; have sk : (kermx (reach A B (maxn n i.+1)) <= kermx (reach A B n))%MS.
  apply/sub_kermxP/reach_annihilated => t tn.
  have /reach_annihilated := mulmx_ker (reach A B (maxn n i.+1)); apply.
  by apply: leq_trans tn (leq_maxl _ _).
have := mxrank_leqif_sup sk; rewrite !mxrank_ker e => -[_]; rewrite eqxx => /esym.
move/reach_annihilated: wz => /sub_kermxP wz /(submx_trans wz)/sub_kermxP/reach_annihilated.
by apply; rewrite leq_maxr.
Qed.

Lemma controllable_blocks A B k : \rank (reach A B k) = n -> controllable A B.
Proof.
move/eqP/rank_reachP => h; apply/controllableP => w wz; apply: h => i _; exact: wz.
Qed.

End Pair.

Section Hautus.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n b : nat).
Implicit Types (A : 'M[K]_n) (B : 'M[K]_(n, b)).

Lemma controllable_map A B : controllable (map_mx f A) (map_mx f B) = controllable A B.
Proof. by rewrite /controllable -map_reach mxrank_map. Qed.

(* Popov, Belevitch, Hautus, over every extension field *)
Theorem controllable_hautus A B (lambda : L) : controllable A B ->
  \rank (row_mx (lambda%:M - map_mx f A) (map_mx f B)) = n.
Proof.
rewrite -controllable_map => /controllableP h; apply/eqP.
rewrite eqn_leq rank_leq_row leqNgt; apply/negP => /uncontrollable_modeP[w [nw wA wB]].
case/eqP: nw; apply: h => i; apply: (@krylov_annihilated _ _ _ _ _ _ _ lambda%:M) => //.
by rewrite wA mul_scalar_mx.
Qed.

Theorem observable_hautus A (C : 'M[K]_(b, n)) (lambda : L) : controllable A^T C^T ->
  \rank (col_mx (lambda%:M - map_mx f A) (map_mx f C)) = n.
Proof.
move/(controllable_hautus lambda); rewrite -mxrank_tr tr_row_mx.
by rewrite linearB /= tr_scalar_mx -!map_trmx !trmxK.
Qed.

End Hautus.

Section Joint.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel K n p q).

Definition jointly_controllable S := controllable (mcA S) (inputs S setT).
Definition jointly_observable S := controllable (mcA S)^T (outputs S setT)^T.

Lemma jointly_controllable_pencil (L : fieldType) (f : {rmorphism K -> L}) S lambda :
  jointly_controllable S -> \rank (pencil (map_system f S) set0 lambda) = n.
Proof. by move=> h; rewrite rank_pencil0 -map_inputs controllable_hautus. Qed.

Lemma jointly_observable_pencil (L : fieldType) (f : {rmorphism K -> L}) S lambda :
  jointly_observable S -> \rank (pencil (map_system f S) setT lambda) = n.
Proof. by move=> h; rewrite rank_pencilT -map_outputs observable_hautus. Qed.

(* Proposition 2 as the paper states it *)
Theorem proposition_2 (L : fieldType) (f : {rmorphism K -> L}) S lambda :
  jointly_controllable S -> jointly_observable S ->
  fixed_over f S lambda <->
  exists s, [/\ s != set0, s != setT & (\rank (pencil (map_system f S) s lambda) < n)%N].
Proof.
move=> jc jo; rewrite fixed_over_fixed; apply: anderson_clements_proper.
  exact: jointly_controllable_pencil.
exact: jointly_observable_pencil.
Qed.

End Joint.
