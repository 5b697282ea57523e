(* Theorems 3 and 4, and the exact conditions behind them: under delays nothing more is
   fixed than without, 0 apart when outputs are sent and nothing is held. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability pencil_space anderson_clements.
From mcexact Require Import extended joint_controllability neighbor_graph extended_bound.
From mcexact Require Import delayed_systems held lifted.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Map.
Variables (K L : ringType) (f : {rmorphism K -> L}).

Lemma map_mxcol m r (c : 'I_m -> nat) (V : forall i, 'M[K]_(c i, r)) :
  map_mx f (\mxcol_i V i) = \mxcol_i map_mx f (V i).
Proof. by apply/matrixP => x y; rewrite !mxE. Qed.

Lemma map_mxdiag m (a : 'I_m -> nat) (V : forall i, 'M[K]_(a i)) :
  map_mx f (\mxdiag_i V i) = \mxdiag_i map_mx f (V i).
Proof.
have e (R : ringType) (W : forall i, 'M[R]_(a i)) : \mxdiag_i W i = \mxcol_i (W i *m agent_block R a i).
  by rewrite -[LHS]mulmx1 -[X in _ *m X](submxcolK 1%:M) mul_mxdiag_mxcol.
rewrite !e map_mxcol; apply: eq_mxcol => i; rewrite map_mxM; congr (_ *m _).
by apply/matrixP => x y; rewrite !mxE rmorph_nat.
Qed.

Lemma map_agent_block m (a : 'I_m -> nat) i : map_mx f (agent_block K a i) = agent_block L a i.
Proof. by apply/matrixP => x y; rewrite !mxE rmorph_nat. Qed.

Lemma map_pick r k t : map_mx f (pick K r k t) = pick L r k t.
Proof.
by apply/matrixP => x y; rewrite !mxE; case: ifP => _; rewrite !mxE ?rmorph_nat ?rmorph0.
Qed.

Lemma map_shift r k : map_mx f (shift K r k) = shift L r k.
Proof.
by apply/matrixP => x y; rewrite !mxE; case: ifP => _; rewrite !mxE ?rmorph_nat ?rmorph0.
Qed.

Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (S : multichannel K n p q).

Lemma pencil_map_held s lambda :
  pencil (map_system f (held N k d S)) s lambda = pencil (held N k d (map_system f S)) s lambda.
Proof.
have eh i t : map_mx f (held_state K N k d i t) = held_state L N k d i t.
  by rewrite /held_state map_mxM map_pick map_agent_block.
apply: pencil_eq => [|i|i] /=; rewrite map_block_mx !map_mx0.
- by rewrite map_mxdiag; congr block_mx; apply: eq_mxdiag => i; rewrite map_shift.
- by rewrite -map_trmx eh.
rewrite map_mxcol; congr block_mx; apply: eq_mxcol => j.
by case: ifP => _; rewrite ?map_mx0 // eh.
Qed.

Lemma pencil_map_lifted s lambda :
  pencil (map_system f (lifted N k d S)) s lambda = pencil (lifted N k d (map_system f S)) s lambda.
Proof.
have es i t : map_mx f (sub_state K q N k d i t) = sub_state L q N k d i t.
  by rewrite /sub_state map_mxM map_row_mx map_pick map_mx0 map_agent_block.
have ep i t : map_mx f (past_output K q N k d i t) = past_output L q N k d i t.
  by rewrite /past_output map_mxM map_row_mx map_pick map_mx0 map_agent_block.
apply: pencil_eq => [|i|i] /=; rewrite map_block_mx !map_mx0.
- congr block_mx.
    rewrite map_mxcol; apply: eq_mxcol => i.
    by rewrite map_col_mx map_mx0 map_mxM -map_trmx map_pick.
  by rewrite /lifted_K map_mxdiag; apply: eq_mxdiag => i; rewrite map_block_mx !map_mx0 !map_shift.
- by rewrite -map_trmx es.
rewrite map_col_mx !map_mxcol; congr (block_mx _ _ _ (col_mx _ _)); apply: eq_mxcol => j;
  by case: ifP => _; rewrite ?map_mx0 // ?ep ?es.
Qed.

End Map.

Section Theorems.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel K n p q) (lambda : L).

(* the held system has the fixed eigenvalues of the extended system of Remark 2 *)
Theorem held_fixed_iff S lambda :
  fixed_over f (held N k d S) lambda <-> fixed_over f (extended_states N k S) lambda.
Proof.
rewrite !anderson_clements_over; split=> -[s h]; exists s; move: h;
  rewrite pencil_map_held pencil_map_extended_states rank_held // rank_extended_states //.
  by rewrite ![(_ + \sum_i _ + _)%N]addnAC !ltn_add2r.
by rewrite ![(_ + \sum_i _ + _)%N]addnAC !ltn_add2r.
Qed.

(* the lifted system has, 0 apart, those of the extended system *)
Theorem lifted_fixed_iff S lambda : lambda != 0 ->
  fixed_over f (lifted N k d S) lambda <-> fixed_over f (extended N k S) lambda.
Proof.
move=> l0; rewrite !anderson_clements_over; split=> -[s h]; exists s; move: h;
  rewrite pencil_map_lifted pencil_map_extended rank_lifted // rank_extended //.
  by rewrite ![(_ + \sum_i _ + _)%N]addnAC !ltn_add2r.
by rewrite ![(_ + \sum_i _ + _)%N]addnAC !ltn_add2r.
Qed.

(* Theorem 3: no fixed eigenvalue but 0 *)
Theorem theorem_3 S : strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S ->
  (forall i s lambda, s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  forall lambda, lambda != 0 -> ~ fixed_over f (lifted N k d S) lambda.
Proof.
by move=> sc jc jo h lambda l0; rewrite lifted_fixed_iff //; apply: theorem_2.
Qed.

(* Theorem 4: no fixed eigenvalue at all *)
Theorem theorem_4 S : strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S ->
  (forall i s lambda, s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (pencil (map_system f S) s lambda) <= k i)%N) ->
  forall lambda, ~ fixed_over f (held N k d S) lambda.
Proof. by move=> sc jc jo h lambda; rewrite held_fixed_iff; apply: remark_2. Qed.

End Theorems.
