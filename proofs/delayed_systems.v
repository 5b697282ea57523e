(* Section V: the lifted system (emcsdd) and the held system (emcsdd-hold) with their block
   matrices.  d i j is the paper's d_ij, k i its n_i. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space extended.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Definitions.
Variable (R : ringType).

(* e_t' (x) I_k and S_r (x) I_k; steps are counted from 0 *)
Definition pick r k t : 'M[R]_(k, \sum_(i < r) k) :=
  \mxrow_(i < r) (if i == t :> nat then 1%:M else 0).
Definition shift r k : 'M[R]_(\sum_(i < r) k) :=
  \mxblock_(i < r, j < r) (if i == j.+1 :> nat then 1%:M else 0 : 'M[R]_k).

(* the coordinates of agent i *)
Definition agent_block m (a : 'I_m -> nat) i : 'M[R]_(a i, \sum_i a i) := submxcol 1%:M i.

Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat).
Implicit Types (S : multichannel R n p q).

(* d_j, the longest delay to a follower of j *)
Definition dmax j : nat := \max_(i | j \in N i) d i j.

(* held: (x, x_1(t), ..., x_1(t - d_1), ..., x_m(t - d_m)) *)
Definition chain i : nat := (\sum_(t < (dmax i).+1) k i)%N.
Definition held_state i t : 'M[R]_(k i, \sum_i chain i) :=
  pick (dmax i).+1 (k i) t *m agent_block chain i.
Definition held S : multichannel R (n + \sum_i chain i) (fun i => p i + k i)%N
    (fun i => q i + \sum_i k i)%N :=
  Multichannel
    (block_mx (mcA S) 0 0 (\mxdiag_i shift (dmax i).+1 (k i)))
    (fun i => block_mx (mcB S i) 0 0 (held_state i 0)^T)
    (fun i => block_mx (mcC S i) 0 0 (\mxcol_j (if j \in N i then held_state j (dmax j) else 0))).

(* lifted: (x, x_1, w_1, ..., x_m, w_m) *)
Definition past i : nat := (\sum_(t < dmax i) q i)%N.
Definition memory i : nat := (chain i + past i)%N.
Definition lifted_G S : 'M[R]_(\sum_i memory i, n) :=
  \mxcol_i col_mx (0 : 'M[R]_(chain i, n)) ((pick (dmax i) (q i) 0)^T *m mcC S i : 'M[R]_(past i, n)).
Definition lifted_K : 'M[R]_(\sum_i memory i) :=
  \mxdiag_i (block_mx (shift (dmax i).+1 (k i)) 0 0 (shift (dmax i) (q i)) : 'M[R]_(memory i)).
(* H_{i t}' for 0 <= t <= d_i and Q_{i t} for 1 <= t <= d_i *)
Definition sub_state i t : 'M[R]_(k i, \sum_i memory i) :=
  (row_mx (pick (dmax i).+1 (k i) t) 0 : 'M[R]_(k i, memory i)) *m agent_block memory i.
Definition past_output i t : 'M[R]_(q i, \sum_i memory i) :=
  (row_mx 0 (pick (dmax i) (q i) t.-1) : 'M[R]_(q i, memory i)) *m agent_block memory i.
Definition lifted S : multichannel R (n + \sum_i memory i) (fun i => p i + k i)%N
    (fun=> \sum_i q i + (\sum_i q i + \sum_i k i))%N :=
  Multichannel
    (block_mx (mcA S) 0 (lifted_G S) lifted_K)
    (fun i => block_mx (mcB S i) 0 0 (sub_state i 0)^T)
    (fun i => block_mx (\mxcol_j (if (j \in N i) && (d i j == 0)%N then mcC S j else 0)) 0 0
       (col_mx (\mxcol_j (if (j \in N i) && (d i j != 0)%N then past_output j (d i j) else 0))
               (\mxcol_j (if j \in N i then sub_state j (d i j) else 0)))).
End Definitions.

Section Blocks.
Variables (L : fieldType) (m : nat) (a : 'I_m -> nat).
Notation blk := (agent_block L a).

Lemma mxdiagE (D : forall i, 'M[L]_(a i)) : \mxdiag_i D i = \mxcol_i (D i *m blk i).
Proof. by rewrite -[LHS]mulmx1 -[X in _ *m X](submxcolK 1%:M) mul_mxdiag_mxcol. Qed.

Lemma block_diag (D : forall i, 'M[L]_(a i)) i : blk i *m \mxdiag_i D i = D i *m blk i.
Proof. by rewrite /agent_block submxcol_mul mul1mx mxdiagE mxcolK. Qed.

Lemma block_col r (V : forall i, 'M[L]_(a i, r)) i : blk i *m \mxcol_i V i = V i.
Proof. by rewrite /agent_block submxcol_mul mul1mx mxcolK. Qed.

Lemma block_tr i : blk i *m (blk i)^T = 1%:M.
Proof.
rewrite {1}/agent_block submxcol_mul mul1mx /agent_block tr_submxcol trmx1.
by apply/matrixP => x y; rewrite !mxE -val_eqE /= tagnat.eq_Rank eqxx.
Qed.

Lemma block_tr0 i j : i != j -> blk i *m (blk j)^T = 0.
Proof.
move=> ij; rewrite {1}/agent_block submxcol_mul mul1mx /agent_block tr_submxcol trmx1.
by apply/matrixP => x y; rewrite !mxE -val_eqE /= tagnat.eq_Rank (negPf ij).
Qed.

(* X_i in the coordinates of agent i, for i in s *)
Lemma span_diag (c : 'I_m -> nat) (X : forall i, 'M[L]_(c i, a i)) (s : {set 'I_m}) :
  (span (fun i => X i *m blk i) s :=: \mxdiag_i (if i \in s then <<X i>>%MS else 0))%MS.
Proof.
rewrite mxdiagE; have -> : \mxcol_i ((if i \in s then <<X i>>%MS else 0) *m blk i) =
    \mxcol_i (if i \in s then <<X i>>%MS *m blk i else 0).
  by apply: eq_mxcol => i; case: ifP => _; rewrite ?mul0mx.
apply: eqmx_trans (eqmx_sym (mxcol_space _ _)); apply: span_eqmx => i _.
exact/eqmx_sym/eqmxMr/genmxE.
Qed.

Lemma row_block_sub (y : 'rV[L]_(\sum_i a i)) (C : forall i, 'M[L]_(a i)) :
  (y <= \mxdiag_i C i)%MS <-> (forall i, (submxrow y i <= C i)%MS).
Proof.
split=> [/submxP[D ->] i|h].
  by rewrite -[D]submxrowK mul_mxrow_mxdiag mxrowK submxMl.
rewrite -[y]submxrowK; have h' i : exists D, submxrow y i = D *m C i by apply/submxP.
apply/submxP; exists (\mxrow_i (submxrow y i *m pinvmx (C i))); rewrite mul_mxrow_mxdiag.
by apply: eq_mxrow => i; rewrite mulmxKpV.
Qed.

(* uncoupled agents *)
Lemma rank_block_mxdiag (Z B C : forall i, 'M[L]_(a i)) :
  \rank (block_mx (\mxdiag_i Z i) (\mxdiag_i B i) (\mxdiag_i C i) 0) =
  (\sum_i \rank (block_mx (Z i) (B i) (C i) 0))%N.
Proof.
pose W i := (preimage (Z i) (C i) :&: kermx (B i))%MS.
have eW : \rank (preimage (\mxdiag_i Z i) (\mxdiag_i C i) :&: kermx (\mxdiag_i B i))%MS =
          \rank (\mxdiag_i W i).
  apply: eqmx_rank; apply/andP; split; apply/rV_subP => v.
    rewrite sub_capmx sub_preimage => /andP[/row_block_sub h1 /sub_kermxP h2].
    apply/row_block_sub => i; rewrite sub_capmx sub_preimage; apply/andP; split.
      by have := h1 i; rewrite -[v]submxrowK mul_mxrow_mxdiag !mxrowK.
    apply/sub_kermxP; move: h2; rewrite -[v]submxrowK mul_mxrow_mxdiag => /mxrowP/(_ i).
    by rewrite !mxrowK submxrow0.
  move/row_block_sub => h; rewrite sub_capmx sub_preimage; apply/andP; split.
    apply/row_block_sub => i; have := h i; rewrite sub_capmx sub_preimage => /andP[h1 _].
    by rewrite -[v]submxrowK mul_mxrow_mxdiag mxrowK.
  apply/sub_kermxP; rewrite -[v]submxrowK mul_mxrow_mxdiag; apply/mxrowP => i.
  have := h i; rewrite sub_capmx => /andP[_ /sub_kermxP h2].
  by rewrite mxrowK submxrow0.
have := rank_pencil (\mxdiag_i Z i) (\mxdiag_i B i) (\mxdiag_i C i).
rewrite eW !rank_mxdiag => e; apply/eqP; rewrite -(eqn_add2r (\sum_i \rank (W i))) e.
rewrite -!big_split /=; apply/eqP; apply: eq_bigr => i _.
by rewrite (rank_pencil (Z i) (B i) (C i)).
Qed.

End Blocks.

Section Chain.
Variables (L : fieldType) (k : nat) (lambda : L).

Lemma pick_tr r t : (t < r)%N -> pick L r k t *m (pick L r k t)^T = 1%:M.
Proof.
move=> tr; rewrite /pick tr_mxrow mul_mxrow_mxcol (bigD1 (Ordinal tr)) //= eqxx trmx1 mulmx1.
rewrite big1 ?addr0 // => i it; have -> : (i == t :> nat) = false by apply: contraNF it => /eqP e; apply/eqP/val_inj.
by rewrite mul0mx.
Qed.

Lemma pick_tr0 r t u : t != u -> pick L r k t *m (pick L r k u)^T = 0.
Proof.
move=> tu; rewrite /pick tr_mxrow mul_mxrow_mxcol big1 // => i _.
have [e|_] := eqVneq (i : nat) t; last by rewrite mul0mx.
by rewrite e (negPf tu) trmx0 mulmx0.
Qed.

Lemma rank_pick r t : (t < r)%N -> \rank (pick L r k t) = k.
Proof.
move=> tr; apply/eqP; rewrite eqn_leq rank_leq_row /= -{1}(mxrank1 L k) -(pick_tr tr).
exact: mxrankM_maxl.
Qed.

Lemma row_shift r a (x : 'M[L]_(a, \sum_(i < r) k)) (j j' : 'I_r) : j' = j.+1 :> nat ->
  submxrow (x *m shift L r k) j = submxrow x j'.
Proof.
move=> e; rewrite -{1}[x]submxrowK mul_mxrow_mxblock mxrowK (bigD1 j') //= e eqxx mulmx1.
rewrite big1 ?addr0 // => i ij; have -> : (i == j.+1 :> nat) = false.
  by apply: contraNF ij => /eqP ei; apply/eqP/val_inj; rewrite /= ei e.
by rewrite mulmx0.
Qed.

Lemma row_shift_last r a (x : 'M[L]_(a, \sum_(i < r) k)) (j : 'I_r) : (r <= j.+1)%N ->
  submxrow (x *m shift L r k) j = 0.
Proof.
move=> rj; rewrite -{1}[x]submxrowK mul_mxrow_mxblock mxrowK big1 // => i _.
have -> : (i == j.+1 :> nat) = false.
  by apply/eqP => e; have := ltn_ord i; rewrite e ltnNge rj.
by rewrite mulmx0.
Qed.

Lemma submxrow_pick r t (j : 'I_r) : submxrow (pick L r k t) j = if j == t :> nat then 1%:M else 0.
Proof. by rewrite mxrowK. Qed.

Lemma pick_shiftS r t : (t.+1 < r)%N -> pick L r k t.+1 *m shift L r k = pick L r k t.
Proof.
move=> tr; apply/mxrowP => j; have [jr|jr] := ltnP j.+1 r.
  by rewrite (@row_shift _ _ _ j (Ordinal jr)) // !submxrow_pick.
rewrite row_shift_last // submxrow_pick; case: eqP => // e.
by move: jr; rewrite e leqNgt tr.
Qed.

Lemma pick_shift0 r : pick L r k 0 *m shift L r k = 0.
Proof.
apply/mxrowP => j; rewrite submxrow0; have [jr|jr] := ltnP j.+1 r.
  by rewrite (@row_shift _ _ _ j (Ordinal jr)) // !submxrow_pick.
by rewrite row_shift_last.
Qed.

(* x (lambda I - S) vanishes before the last block: the blocks of x are a geometric sequence *)
Lemma geometric r (x : 'rV[L]_(\sum_(i < r.+1) k)) :
  (forall j : 'I_r.+1, (j < r)%N -> submxrow (x *m (lambda%:M - shift L r.+1 k)) j = 0) ->
  forall j : 'I_r.+1, submxrow x j = lambda ^+ j *: submxrow x ord0.
Proof.
move=> h [j]; elim: j => [|j IH] jr /=.
  by rewrite expr0 scale1r; congr submxrow; apply: val_inj.
have jr' := ltnW jr; have := h (Ordinal jr') jr.
rewrite mulmxBr mul_mx_scalar submxrowB (@row_shift _ _ _ (Ordinal jr') (Ordinal jr)) //.
move/eqP; rewrite subr_eq0 => /eqP <-.
have -> : submxrow (lambda *: x) (Ordinal jr') = lambda *: submxrow x (Ordinal jr').
  by apply/matrixP => u v; rewrite !mxE.
by rewrite IH /= scalerA exprS.
Qed.

(* one agent of the held system *)
Lemma rank_chain r (b c : bool) : b || c ->
  \rank (block_mx (lambda%:M - shift L r.+1 k) (if b then pick L r.+1 k 0 else 0)^T
                  (if c then pick L r.+1 k r else 0) 0) =
  (\sum_(t < r.+1) k + if b && c then k else 0)%N.
Proof.
move=> bc; set Z := _ - _.
pose W := (preimage Z (if c then pick L r.+1 k r else 0) :&:
           kermx (if b then pick L r.+1 k 0 else 0)^T)%MS.
have := rank_pencil Z (if b then pick L r.+1 k 0 else 0)^T (if c then pick L r.+1 k r else 0).
rewrite -/W.
have geo (v : 'rV_(\sum_(i < r.+1) k)) : (v <= W)%MS ->
    forall j : 'I_r.+1, submxrow v j = lambda ^+ j *: submxrow v ord0.
  rewrite sub_capmx sub_preimage => /andP[/submxP[D e] _]; apply: geometric => j jr.
  rewrite -/Z e; case: (c); last by rewrite mulmx0 submxrow0.
  rewrite -mul_submxrow submxrow_pick; case: eqP => [e'|_]; last by rewrite mulmx0.
  by rewrite e' ltnn in jr.
case: b bc @W geo => [_ W geo|/= -> {c} geo e].
  have W0 : \rank W = 0%N.
    apply/eqP; rewrite mxrank_eq0; apply/rowV0P => v vW; apply/mxrowP => j.
    rewrite (geo v vW) submxrow0; suff -> : submxrow v ord0 = 0 by rewrite scaler0.
    have := vW; rewrite sub_capmx => /andP[_ /sub_kermxP].
    rewrite /pick tr_mxrow -{1}[v]submxrowK mul_mxrow_mxcol (bigD1 ord0) //= trmx1 mulmx1.
    rewrite big1 ?addr0 // => i i0; have -> : ((i : nat) == 0%N) = false by apply: negbTE.
    by rewrite trmx0 mulmx0.
  by rewrite W0 addn0 => ->; case: c {geo W W0} => /=; rewrite ?rank_pick // mxrank0.
set W := (_ :&: _)%MS in geo e; rewrite addn0; apply/eqP; rewrite eqn_leq; apply/andP; split.
  by rewrite trmx0 block_mxEh col_mx0 rank_row_mx0 rank_leq_col.
rewrite rank_pick // in e.
have Wk : (\rank W <= k)%N.
  pose V : 'M[L]_(k, \sum_(i < r.+1) k) := \mxrow_(i < r.+1) (lambda ^+ i)%:M.
  apply: leq_trans (rank_leq_row V); apply: mxrankS; apply/rV_subP => v /geo h.
  apply/submxP; exists (submxrow v ord0); rewrite mul_mxrow; apply/mxrowP => j.
  by rewrite mxrowK mul_mx_scalar; apply: h.
have aux (a b c w : nat) : (a + w = b + c -> w <= c -> b <= a)%N.
  by move=> ee wc; rewrite -(leq_add2r c) -ee leq_add2l.
exact: aux e Wk.
Qed.

End Chain.
