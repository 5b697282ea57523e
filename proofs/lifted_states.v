(* Section V-A, the remark after the proof of Theorem 3: where sub-states alone are sent, and nothing is held, Theorem 3
   holds with the bound (27).  The system is that of (37) with x_j(t - d_ij) in place of x_j(t - d_j) in what agent i
   receives; at every lambda that is not 0 its pencil has the same rank. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space anderson_clements.
From mcexact Require Import extended joint_controllability neighbor_graph extended_bound delayed_systems held lifted delays.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section System.
Variables (R : ringType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (S : multichannel R n p q).
Definition lifted_states : multichannel R (n + \sum_i chain N k d i) (fun i => p i + k i)%N
    (fun i => q i + \sum_i k i)%N :=
  Multichannel
    (block_mx (mcA S) 0 0 (\mxdiag_i shift R (dmax N d i).+1 (k i)))
    (fun i => block_mx (mcB S i) 0 0 (held_state R N k d i 0)^T)
    (fun i => block_mx (mcC S i) 0 0 (\mxcol_j (if j \in N i then held_state R N k d j (d i j) else 0))).
End System.

Section Rank.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (lambda : L).
Hypothesis l0 : lambda != 0.
Variable S : multichannel L n p q.
Notation chain := (chain N k d).
Notation blk := (agent_block L chain).
Notation cell := (held_state L N k d).
Notation T := (lifted_states N k d S).
Let Z : 'M[L]_(\sum_i chain i) := lambda%:M - \mxdiag_i shift L (dmax N d i).+1 (k i).

Lemma Z_diagonal : Z = \mxdiag_i (lambda%:M - shift L (dmax N d i).+1 (k i)).
Proof. by rewrite /Z -mxdiagZ -mxdiagB. Qed.

Lemma Z_invertible : Z \in unitmx.
Proof.
rewrite -row_free_unit /row_free Z_diagonal rank_mxdiag; apply/eqP; apply: eq_bigr => i _.
by rewrite mxrank_unit // shift_unit.
Qed.

Let X i t : 'M[L]_(k i, \sum_i chain i) := resolvent lambda (dmax N d i).+1 (k i) t *m blk i.

Lemma X_Z i t : (t <= dmax N d i)%N -> X i t *m Z = cell i t.
Proof. by move=> td; rewrite /X Z_diagonal -mulmxA block_diag mulmxA resolventK. Qed.

Lemma X_own i t : X i t *m (cell i 0)^T = (lambda^-1 ^+ t.+1)%:M.
Proof. by rewrite /X /held_state trmx_mul mulmxA -(mulmxA _ (blk i)) block_tr mulmx1 resolvent_pick. Qed.

Lemma X_other i j t : i != j -> X i t *m (cell j 0)^T = 0.
Proof. by move=> ij; rewrite /X /held_state trmx_mul mulmxA -(mulmxA _ (blk i)) block_tr0 // mulmx0 mul0mx. Qed.

Theorem rank_lifted_states s : \rank (pencil T s lambda) =
  (\rank (pencil S s lambda) + \sum_i chain i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
pose h := \mxrow_i (if i \in ~: s then (cell i 0)^T else 0).
pose H i := \mxcol_j (if j \in N i then cell j (d i j) else 0).
pose R : 'M[L]_(\sum_i chain i) := span H s.
have eB : ((inputs T (~: s))^T :=: (block_mx (inputs S (~: s)) 0 0 h)^T)%MS.
  apply: eqmx_trans (eqmx_inputs _ _) _; rewrite trmxK.
  have e i : i \in ~: s -> ((mcB T i)^T :=: block_mx (mcB S i)^T 0 0 (cell i 0))%MS.
    by move=> _; rewrite /= tr_block_mx !trmx0 trmxK.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  rewrite tr_block_mx !trmx0; have eI := eqmx_inputs S (~: s); rewrite trmxK in eI.
  have eh : (h^T :=: span (fun i => cell i 0) (~: s))%MS.
    rewrite /h tr_mxrow; have -> : \mxcol_i (if i \in ~: s then (cell i 0)^T else 0)^T =
        \mxcol_i (if i \in ~: s then cell i 0 else 0).
      by apply: eq_mxcol => i; case: ifP => _; rewrite ?trmxK ?trmx0.
    exact: mxcol_space.
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?eI ?eh.
have eC : (outputs T s :=: block_mx (outputs S s) 0 0 R)%MS.
  apply: eqmx_trans (eqmx_outputs _ _) _.
  have e i : i \in s -> (mcC T i :=: block_mx (mcC S i) 0 0 (H i))%MS by [].
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  have eO := eqmx_outputs S s.
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?eO.
rewrite /pencil (rank_block_eq _ eB eC) /= scalar_mx_block opp_block_mx add_block_mx.
rewrite !(subr0, oppr0, addr0) rank_block_diag -/Z (rank_schur _ _ Z_invertible) -addnA; congr addn.
congr addn; rewrite -(rank_select L k (neighborhood N s :\: s)).
have Xh i j : j \in N i -> X j (d i j) *m h =
    (if j \in ~: s then lambda^-1 ^+ (d i j).+1 else 0) *: (shared_input L k j)^T.
  move=> Nj; rewrite /h mul_mxrow; apply/mxrowP => l; rewrite mxrowK.
  have -> : submxrow ((if j \in ~: s then lambda^-1 ^+ (d i j).+1 else 0) *: (shared_input L k j)^T) l =
      (if j \in ~: s then lambda^-1 ^+ (d i j).+1 else 0) *: (agent_block L k j *m (agent_block L k l)^T).
    rewrite /agent_block tr_submxcol trmx1 mul_submxrow mulmx1 /shared_input tr_submxrow trmx1.
    by apply/matrixP => x y; rewrite !mxE.
  have [->|lj] := eqVneq l j.
    rewrite block_tr; case: ifP => _; last by rewrite mulmx0 scale0r.
    by rewrite X_own scalemx1.
  rewrite block_tr0 1?eq_sym // scaler0; case: ifP => _; last by rewrite mulmx0.
  by rewrite X_other // eq_sym.
have subZ i j : j \in N i -> cell j (d i j) *m (invmx Z *m h) = X j (d i j) *m h.
  by move=> Nj; rewrite -X_Z ?delay_le // mulmxA mulmxK ?Z_invertible.
rewrite -mulmxA; apply: eqmx_rank; apply/andP; split.
  rewrite -sub_preimage; apply/span_sub => i si; rewrite sub_preimage /H mxcol_mul eqmx_col.
  apply/sumsmx_subP => j _; rewrite genmxE; case: ifP => [Nj|_]; last by rewrite mul0mx sub0mx.
  rewrite subZ // Xh //; case: ifP => [sj|_]; last by rewrite scale0r sub0mx.
  apply: scalemx_sub; rewrite -span_shared; apply: sub_span; rewrite !inE in sj *; rewrite sj.
  by apply/bigcupP; exists i.
rewrite -span_shared; apply/span_sub => j; rewrite inE => /andP[sj /bigcupP[i si Nj]].
have -> : ((shared_input L k j)^T :=: X j (d i j) *m h)%MS.
  by apply: eqmx_sym; rewrite Xh // inE sj; apply: eqmx_scale; rewrite expf_neq0 // invr_eq0.
rewrite -(subZ _ _ Nj); apply: submxMr; apply: submx_trans (sub_span _ si).
by rewrite /H eqmx_col; apply: (sumsmx_sup j) => //; rewrite genmxE Nj.
Qed.

Lemma lifted_states_not_fixed :
  ~ fixed T lambda <->
  forall s, (n - \rank (pencil S s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite anderson_clements; split=> [nf s|enough [s]]; last first.
  by rewrite rank_lifted_states addnAC ltn_add2r ltnNge -leq_subLR enough.
rewrite leq_subLR leqNgt; apply/negP => lt; apply: nf; exists s.
by rewrite rank_lifted_states addnAC ltn_add2r.
Qed.
End Rank.

Section Theorem3.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat).
Variable S : multichannel K n p q.

Lemma pencil_map_lifted_states s lambda :
  pencil (map_system f (lifted_states N k d S)) s lambda = pencil (lifted_states N k d (map_system f S)) s lambda.
Proof.
have eh i t : map_mx f (held_state K N k d i t) = held_state L N k d i t.
  by rewrite /held_state map_mxM map_pick map_agent_block.
apply: pencil_eq => [|i|i] /=; rewrite map_block_mx !map_mx0.
- by rewrite map_mxdiag; congr block_mx; apply: eq_mxdiag => i; rewrite map_shift.
- by rewrite -map_trmx eh.
rewrite map_mxcol; congr block_mx; apply: eq_mxcol => j.
by case: ifP => _; rewrite ?map_mx0 // eh.
Qed.

(* Theorem 3 with (27), at the nonzero eigenvalues of A alone *)
Theorem theorem_3_states : jointly_controllable S -> jointly_observable S -> strongly_connected (neighbor_arc N) ->
  (forall i s (lambda : L), s != set0 -> s != setT -> lambda != 0 -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (pencil (map_system f S) s lambda) <= k i)%N) ->
  forall lambda : L, lambda != 0 -> ~ fixed_over f (lifted_states N k d S) lambda.
Proof.
move=> jc jo connected enough lambda l0 /anderson_clements_over[s]; rewrite pencil_map_lifted_states.
rewrite rank_lifted_states // addnAC ltn_add2r ltnNge -leq_subLR => /negP; apply.
have [el|/deficient_states0 e] := boolP (eigenvalue (map_mx f (mcA S)) lambda); last first.
  by have := e s; rewrite /deficiency_states => ->.
have [->|s0] := eqVneq s set0; first by rewrite jointly_controllable_pencil // subnn.
have [->|sT] := eqVneq s setT; first by rewrite jointly_observable_pencil // subnn.
have /set0Pn[i bi] := (neighborhood_strongly_connected N).1 connected s s0 sT.
by rewrite [X in (_ <= X)%N](bigD1 i) //= (leq_trans (enough i s lambda s0 sT l0 el)) // leq_addr.
Qed.
End Theorem3.
