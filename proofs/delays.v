(* Section V: the lifted system (emcsdd) and the held system (emcsdd-hold) with their block
   matrices; Theorems 3 and 4 and the exact conditions behind them (DESIGN 2.9).
   d i j is the paper's d_ij, k i its n_i. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability neighbor_graph.
From mcexact Require Import extended_bound.

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

Section Held.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel L n p q).
Notation chain := (chain N k d).

Lemma span_mxcol r (c : 'I_m -> nat) (V : forall i, 'M[L]_(c i, r)) (s : {set 'I_m}) :
  (\mxcol_i (if i \in s then V i else 0) :=: span V s)%MS.
Proof. exact: mxcol_space. Qed.

(* the exact rank of the held system, at every lambda *)
Theorem rank_held S s lambda :
  \rank (pencil (held N k d S) s lambda) =
  (\rank (pencil S s lambda) + \sum_i chain i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
pose X0 i := pick L (dmax N d i).+1 (k i) 0; pose X1 i := pick L (dmax N d i).+1 (k i) (dmax N d i).
pose B i : 'M[L]_(chain i) := (if i \in ~: s then <<X0 i>>%MS else 0)^T.
pose C i : 'M[L]_(chain i) := if i \in neighborhood N s then <<X1 i>>%MS else 0.
have eB : ((inputs (held N k d S) (~: s))^T :=: (block_mx (inputs S (~: s)) 0 0 (\mxdiag_i B i))^T)%MS.
  apply: eqmx_trans (eqmx_inputs _ _) _; rewrite trmxK.
  have e i : i \in ~: s -> ((mcB (held N k d S) i)^T :=:
      block_mx (mcB S i)^T 0 0 (X0 i *m agent_block L chain i))%MS.
    by move=> _; rewrite /= tr_block_mx !trmx0 trmxK.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  rewrite tr_block_mx !trmx0 tr_mxdiag; have eI := eqmx_inputs S (~: s); rewrite trmxK in eI.
  have eD := span_diag X0 (~: s); rewrite (eq_mxdiag (B'_ := fun i => (B i)^T)) in eD; last first.
    by move=> i; rewrite trmxK.
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?eI ?eD.
have eC : (outputs (held N k d S) s :=: block_mx (outputs S s) 0 0 (\mxdiag_i C i))%MS.
  apply: eqmx_trans (eqmx_outputs _ _) _.
  have e i : i \in s -> (mcC (held N k d S) i :=: block_mx (mcC S i) 0 0
      (span (fun j => X1 j *m agent_block L chain j) (N i)))%MS.
    by move=> _ /=; apply/eqmxP/andP; split; apply: block_sub; rewrite // span_mxcol.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  have eO := eqmx_outputs S s; have eD := span_diag X1 (neighborhood N s).
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?span_bigcup ?eO ?eD.
rewrite /pencil (rank_block_eq _ eB eC) /= scalar_mx_block opp_block_mx add_block_mx.
rewrite !(subr0, oppr0, addr0) rank_block_diag -addnA; congr addn.
rewrite -mxdiagZ -mxdiagB rank_block_mxdiag.
rewrite (eq_bigr (fun i => chain i + if (i \in ~: s) && (i \in neighborhood N s) then k i else 0)%N).
  rewrite big_split /=; congr addn; rewrite -big_mkcond; apply: eq_bigl => i.
  by rewrite !inE.
move=> i _; rewrite -(@rank_chain L (k i) lambda (dmax N d i) (i \in ~: s) (i \in neighborhood N s)).
  apply: rank_block_eq; [rewrite /B !trmxK | rewrite /C]; case: ifP => _; try exact: genmxE.
    exact: eqmx_sym (eqmx0 _ _ _).
  exact: eqmx_sym (eqmx0 _ _ _).
by rewrite inE; case: (boolP (i \in s)) => // si; rewrite (subsetP (sub_neighborhood hears s)).
Qed.

Theorem held_not_fixed S lambda :
  ~ fixed (held N k d S) lambda <->
  forall s, (n - \rank (pencil S s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite anderson_clements; split=> [nf s|h [s]]; last first.
  by rewrite rank_held addnAC ltn_add2r ltnNge -leq_subLR h.
rewrite leq_subLR leqNgt; apply/negP => lt; apply: nf; exists s.
by rewrite rank_held addnAC ltn_add2r.
Qed.

End Held.

Section Resolvent.
Variables (L : fieldType) (lambda : L).
Hypothesis l0 : lambda != 0.

(* the rows of (lambda I - S_r)^-1 (x) I_k *)
Fixpoint resolvent r k t : 'M[L]_(k, \sum_(i < r) k) :=
  lambda^-1 *: (if t is t'.+1 then pick L r k t + resolvent r k t' else pick L r k t).

Lemma resolventK r k t : (t < r)%N -> resolvent r k t *m (lambda%:M - shift L r k) = pick L r k t.
Proof.
elim: t => [|t IH] tr; rewrite -scalemxAl ?mulmxDl ?IH ?(ltnW tr) //; rewrite mulmxBr mul_mx_scalar.
  by rewrite pick_shift0 subr0 scalerA mulVf // scale1r.
by rewrite pick_shiftS // subrK scalerA mulVf // scale1r.
Qed.

Lemma resolvent_pick r k t : (0 < r)%N -> resolvent r k t *m (pick L r k 0)^T = (lambda^-1 ^+ t.+1)%:M.
Proof.
move=> r0; elim: t => [|t IH]; rewrite -scalemxAl.
  by rewrite pick_tr // expr1 scalemx1.
by rewrite mulmxDl IH pick_tr0 // add0r scale_scalar_mx -exprS.
Qed.

Lemma shift_unit r k : lambda%:M - shift L r k \in unitmx.
Proof.
have e : (\mxcol_(i < r) resolvent r k i) *m (lambda%:M - shift L r k) = 1%:M.
  rewrite mxcol_mul; apply/mxcolP => i; rewrite mxcolK resolventK //.
  apply/mxrowP => j; rewrite submxrow_pick.
  by apply/matrixP => x y; rewrite !mxE -val_eqE /= tagnat.eq_Rank eq_sym val_eqE; case: eqVneq => /= e;
     rewrite ?mxE // e.
by case: (mulmx1_unit e).
Qed.

End Resolvent.

Section Schur.
Variable L : fieldType.

Lemma rank_block_shift a n r c (N : 'M[L]_(a, n)) (B : 'M_(a, r)) (C : 'M_(c, n)) (X : 'M_(c, a)) :
  X *m B = 0 -> \rank (block_mx N B C 0) = \rank (block_mx N B (C - X *m N) 0).
Proof.
move=> XB; pose U Y : 'M[L]_(a + c) := block_mx 1%:M 0 Y 1%:M.
have UU Y : U (- Y) *m U Y = 1%:M.
  rewrite /U mulmx_block !(mul1mx, mulmx1, mul0mx, mulmx0, addr0, add0r) addNr.
  by rewrite -scalar_mx_block.
have fU : row_full (U (- X)).
  by rewrite row_full_unit; have := UU X => /mulmx1_unit[].
rewrite -(eqmxMfull (block_mx N B C 0) fU); congr (\rank _); rewrite /U mulmx_block.
by rewrite !(mul1mx, mul0mx, mulmx0, addr0) !mulNmx XB oppr0 addrC.
Qed.

Lemma rank_block_right a n r c (N : 'M[L]_(a, n)) (B : 'M_(a, r)) (C : 'M_(c, n)) (T : 'M_n) :
  T \in unitmx -> \rank (block_mx N B C 0) = \rank (block_mx (N *m T) B (C *m T) 0).
Proof.
move=> uT; pose U : 'M[L]_(n + r) := block_mx T 0 0 1%:M.
have fU : row_free U.
  by rewrite /row_free /U rank_diag_block_mx mxrank1 mxrank_unit.
rewrite -(mxrankMfree _ fU); congr (\rank _); rewrite /U mulmx_block.
by rewrite !(mulmx1, mulmx0, mul0mx, addr0, add0r).
Qed.

Lemma rank_schur z r c (Z : 'M[L]_z) (h : 'M_(z, r)) (R : 'M_(c, z)) : Z \in unitmx ->
  \rank (block_mx Z h R 0) = (z + \rank (R *m invmx Z *m h))%N.
Proof.
move=> uZ; pose U : 'M[L]_(z + c) := block_mx 1%:M 0 (- (R *m invmx Z)) 1%:M.
pose V : 'M[L]_(z + r) := block_mx 1%:M (- (invmx Z *m h)) 0 1%:M.
have fU : row_full U.
  rewrite row_full_unit unitmxE /U det_lblock !det1 mulr1 unitr1 //.
have fV : row_free V.
  by rewrite row_free_unit unitmxE /V det_ublock !det1 mulr1 unitr1.
rewrite -(eqmxMfull _ fU) -(mxrankMfree _ fV).
have -> : U *m block_mx Z h R 0 *m V = block_mx Z 0 0 (- (R *m invmx Z *m h)).
  rewrite /U /V !mulmx_block !(mul1mx, mulmx1, mul0mx, mulmx0, addr0, add0r).
  rewrite !mulNmx !mulmxN mulKVmx // addNr -[R *m invmx Z *m Z]mulmxA mulVmx // mulmx1 addNr.
  by rewrite mul0mx oppr0 add0r.
by rewrite rank_diag_block_mx mxrank_unit // mxrank_opp.
Qed.

End Schur.

Definition stack (R : ringType) m r c (V : 'I_m -> 'M[R]_(r, c)) (s : {set 'I_m}) :
  'M[R]_(\sum_(i < m) r, c) := \mxcol_i (if i \in s then V i else 0).

Section Lifted.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (lambda : L).
Hypothesis hears : forall i, i \in N i.
Hypothesis l0 : lambda != 0.
Variable (S : multichannel L n p q).
Notation chain := (chain N k d).
Notation past := (past q N d).
Notation memory := (memory q N k d).
Notation blk := (agent_block L memory).
Notation sub_state := (sub_state L q N k d).
Notation past_output := (past_output L q N k d).
Notation G := (lifted_G N k d S).
Let Z : 'M[L]_(\sum_i memory i) := lambda%:M - lifted_K L q N k d.

Let D i : 'M[L]_(memory i) :=
  block_mx (lambda%:M - shift L (dmax N d i).+1 (k i)) 0 0 (lambda%:M - shift L (dmax N d i) (q i)).

Lemma Z_diag : Z = \mxdiag_i D i.
Proof.
rewrite /Z /lifted_K -mxdiagZ -mxdiagB; apply: eq_mxdiag => i.
by rewrite scalar_mx_block opp_block_mx add_block_mx !(subr0, oppr0, addr0).
Qed.

Lemma Z_unit : Z \in unitmx.
Proof.
rewrite -row_free_unit /row_free Z_diag rank_mxdiag; apply/eqP; apply: eq_bigr => i _.
by rewrite rank_diag_block_mx !mxrank_unit // shift_unit.
Qed.

Definition XH i t : 'M[L]_(k i, \sum_i memory i) :=
  (row_mx (resolvent lambda (dmax N d i).+1 (k i) t) 0 : 'M[L]_(k i, memory i)) *m blk i.
Definition XQ i t : 'M[L]_(q i, \sum_i memory i) :=
  (row_mx 0 (resolvent lambda (dmax N d i) (q i) t.-1) : 'M[L]_(q i, memory i)) *m blk i.

Lemma XH_Z i t : (t <= dmax N d i)%N -> XH i t *m Z = sub_state i t.
Proof.
move=> td; rewrite /XH Z_diag -mulmxA block_diag mulmxA mul_row_block !(mul0mx, mulmx0, addr0).
by rewrite resolventK.
Qed.

Lemma XQ_Z i t : (0 < t)%N -> (t <= dmax N d i)%N -> XQ i t *m Z = past_output i t.
Proof.
move=> t0 td; rewrite /XQ Z_diag -mulmxA block_diag mulmxA mul_row_block !(mul0mx, mulmx0, add0r).
by rewrite resolventK // prednK.
Qed.

Lemma XH_G i t : XH i t *m G = 0.
Proof. by rewrite /XH -mulmxA block_col mul_row_col mulmx0 mul0mx addr0. Qed.

Lemma XQ_G i t : (0 < t)%N -> (t <= dmax N d i)%N -> XQ i t *m G = lambda^-1 ^+ t *: mcC S i.
Proof.
move=> t0 td; rewrite /XQ -mulmxA block_col mul_row_col mul0mx add0r mulmxA.
by rewrite resolvent_pick ?prednK ?(leq_trans t0) // mul_scalar_mx.
Qed.

Lemma XQ_input i j t : XQ i t *m (sub_state j 0)^T = 0.
Proof.
rewrite /XQ /sub_state trmx_mul mulmxA -(mulmxA _ (blk i)).
have [<-|ij] := eqVneq i j; last by rewrite block_tr0 // mulmx0 mul0mx.
by rewrite block_tr mulmx1 tr_row_mx mul_row_col trmx0 mul0mx mulmx0 addr0.
Qed.

Lemma XH_input i t : XH i t *m (sub_state i 0)^T = (lambda^-1 ^+ t.+1)%:M.
Proof.
rewrite /XH /sub_state trmx_mul mulmxA -(mulmxA _ (blk i)) block_tr mulmx1 tr_row_mx.
by rewrite mul_row_col trmx0 mulmx0 addr0 resolvent_pick.
Qed.

Lemma XH_input0 i j t : i != j -> XH i t *m (sub_state j 0)^T = 0.
Proof.
by move=> ij; rewrite /XH /sub_state trmx_mul mulmxA -(mulmxA _ (blk i)) block_tr0 // mulmx0 mul0mx.
Qed.

Lemma delay_le i j : j \in N i -> (d i j <= dmax N d j)%N.
Proof. by move=> Nj; apply: (leq_bigmax_cond (F := fun i => d i j)). Qed.

(* the signals of agent i after the shifts are eliminated *)
Let C0 i := \mxcol_j (if (j \in N i) && (d i j == 0)%N then mcC S j else 0).
Let Y i := \mxcol_j (if (j \in N i) && (d i j != 0)%N then lambda^-1 ^+ d i j *: mcC S j else 0).
Let Hs i := \mxcol_j (if j \in N i then sub_state j (d i j) else 0).
Let WQ i := \mxcol_j (if (j \in N i) && (d i j != 0)%N then XQ j (d i j) else 0).
Let X i : 'M[L]_(\sum_i q i + (\sum_i q i + \sum_i k i), n + \sum_i memory i) :=
  col_mx 0 (row_mx 0 (col_mx (WQ i) 0)).
Let C' i : 'M[L]_(\sum_i q i + (\sum_i q i + \sum_i k i), n + \sum_i memory i) :=
  block_mx (C0 i) 0 (col_mx (Y i) 0) (col_mx 0 (Hs i)).
Let NN : 'M[L]_(n + \sum_i memory i) := block_mx (lambda%:M - mcA S) 0 (- G) Z.

Lemma X_input i j : X i *m mcB (lifted N k d S) j = 0.
Proof.
rewrite /X /= mul_col_mx mul0mx mul_row_block !(mul0mx, mulmx0, addr0, add0r) mul_col_mx mul0mx.
have -> : WQ i *m (sub_state j 0)^T = 0.
  rewrite /WQ mxcol_mul; apply/mxcolP => l; rewrite mxcolK submxcol0.
  by case: ifP => _; rewrite ?XQ_input ?mul0mx.
by rewrite col_mx0 row_mx0 col_mx0.
Qed.

Lemma X_output i : mcC (lifted N k d S) i - X i *m NN = C' i.
Proof.
have eG : WQ i *m G = Y i.
  rewrite /WQ mxcol_mul; apply: eq_mxcol => j; case: ifP => [/andP[Nj dj]|_]; last by rewrite mul0mx.
  by rewrite XQ_G ?lt0n // delay_le.
have eZ : WQ i *m Z = \mxcol_j (if (j \in N i) && (d i j != 0)%N then past_output j (d i j) else 0).
  rewrite /WQ mxcol_mul; apply: eq_mxcol => j; case: ifP => [/andP[Nj dj]|_]; last by rewrite mul0mx.
  by rewrite XQ_Z ?lt0n // delay_le.
rewrite /X /NN mul_col_mx mul0mx mul_row_block !(mul0mx, mulmx0, add0r) !mul_col_mx !mul0mx.
rewrite mulmxN eG eZ /= block_mxEv opp_col_mx add_col_mx oppr0 addr0 opp_row_mx add_row_mx.
rewrite !opp_col_mx !add_col_mx !oppr0 opprK !addr0 subrr /C' block_mxEv.
by congr (col_mx _ (row_mx _ _)); rewrite -[X in X + _]col_mx0 add_col_mx add0r addr0.
Qed.

Lemma Hs_G i : Hs i *m invmx Z *m G = 0.
Proof.
rewrite /Hs !mxcol_mul; apply/mxcolP => j; rewrite mxcolK submxcol0.
case: ifP => [Nj|_]; last by rewrite !mul0mx.
by rewrite -XH_Z ?delay_le // mulmxK ?Z_unit // XH_G.
Qed.

Let T : 'M[L]_(n + \sum_i memory i) := block_mx 1%:M 0 (invmx Z *m G) 1%:M.

Lemma C'_T i : C' i *m T = C' i.
Proof.
rewrite /C' /T mulmx_block !(mulmx1, mulmx0, mul0mx, addr0, add0r); congr block_mx.
by rewrite mul_col_mx mul0mx mulmxA Hs_G col_mx0 addr0.
Qed.

Lemma rank_eliminated s :
  \rank (pencil (lifted N k d S) s lambda) =
  \rank (block_mx (block_mx (lambda%:M - mcA S) 0 0 Z) (inputs (lifted N k d S) (~: s))
                  (stack C' s) 0).
Proof.
pose XX := stack X s.
have eN : lambda%:M - mcA (lifted N k d S) = NN.
  by rewrite /= scalar_mx_block opp_block_mx add_block_mx !(subr0, oppr0, addr0, add0r).
rewrite /pencil eN (@rank_block_shift _ _ _ _ _ _ _ _ XX); last first.
  rewrite /inputs mul_mxrow; apply/mxrowP => j; rewrite mxrowK submxrow0 /XX /stack mxcol_mul.
  apply/mxcolP => i; rewrite mxcolK submxcol0; case: (i \in s); last by rewrite mul0mx.
  by case: (j \in ~: s); rewrite ?mulmx0 // X_input.
have -> : outputs (lifted N k d S) s - XX *m NN = stack C' s.
  rewrite /outputs /XX /stack mxcol_mul -mxcolB; apply: eq_mxcol => i.
  by case: ifP => _; rewrite ?X_output // mul0mx subr0.
rewrite (@rank_block_right _ _ _ _ _ _ _ _ T); last first.
  by rewrite unitmxE /T det_lblock !det1 mulr1 unitr1.
congr (\rank (block_mx _ _ _ _)).
  rewrite /NN /T mulmx_block !(mulmx1, mulmx0, mul0mx, addr0, add0r).
  by rewrite mulKVmx ?Z_unit // addNr.
rewrite /stack mxcol_mul; apply: eq_mxcol => i; case: ifP => _; last by rewrite mul0mx.
exact: C'_T.
Qed.

(* the exact rank of the lifted system, at every lambda that is not 0 *)
Theorem rank_lifted s :
  \rank (pencil (lifted N k d S) s lambda) =
  (\rank (neighbor_pencil N S s lambda) + \sum_i memory i
    + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
pose h := \mxrow_i (if i \in ~: s then (sub_state i 0)^T else 0).
pose R : 'M[L]_(\sum_i memory i) := span Hs s.
have eB : ((inputs (lifted N k d S) (~: s))^T :=: (block_mx (inputs S (~: s)) 0 0 h)^T)%MS.
  apply: eqmx_trans (eqmx_inputs _ _) _; rewrite trmxK.
  have e i : i \in ~: s -> ((mcB (lifted N k d S) i)^T :=:
      block_mx (mcB S i)^T 0 0 (sub_state i 0))%MS.
    by move=> _; rewrite /= tr_block_mx !trmx0 trmxK.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  rewrite tr_block_mx !trmx0; have eI := eqmx_inputs S (~: s); rewrite trmxK in eI.
  have eh : (h^T :=: span (fun i => sub_state i 0) (~: s))%MS.
    rewrite /h tr_mxrow; have -> : \mxcol_i (if i \in ~: s then (sub_state i 0)^T else 0)^T =
        \mxcol_i (if i \in ~: s then sub_state i 0 else 0).
      by apply: eq_mxcol => i; case: ifP => _; rewrite ?trmxK ?trmx0.
    exact: mxcol_space.
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?eI ?eh.
have eC : (stack C' s :=:
    block_mx (outputs S (neighborhood N s)) 0 0 R)%MS.
  apply: eqmx_trans (mxcol_space _ _) _.
  have CN i : (col_mx (C0 i) (Y i) :=: span (mcC S) (N i))%MS.
    apply/eqmxP/andP; split.
      rewrite col_mx_sub /C0 /Y !eqmx_col; apply/andP; split; apply/sumsmx_subP => j _; rewrite genmxE.
        by case: ifP => [/andP[Nj _]|_]; rewrite ?sub0mx // sub_span.
      case: ifP => [/andP[Nj _]|_]; rewrite ?sub0mx //; apply: scalemx_sub; exact: sub_span.
    apply/span_sub => j Nj; rewrite -addsmxE; have [dj|dj] := eqVneq (d i j) 0%N.
      apply: submx_trans (addsmxSl _ _); rewrite /C0 eqmx_col; apply: (sumsmx_sup j) => //.
      by rewrite genmxE Nj dj.
    apply: submx_trans (addsmxSr _ _); rewrite /Y eqmx_col; apply: (sumsmx_sup j) => //.
    by rewrite genmxE Nj dj /= eqmx_scale // expf_neq0 // invr_eq0.
  have e i : i \in s -> (C' i :=: block_mx (span (mcC S) (N i)) 0 0 (Hs i))%MS.
    move=> _; rewrite /C'; apply/eqmxP/andP; split.
      have -> : block_mx (C0 i) 0 (col_mx (Y i) 0) (col_mx 0 (Hs i)) =
          col_mx (row_mx (C0 i) 0) (col_mx (row_mx (Y i) 0) (row_mx 0 (Hs i))).
        by rewrite block_mxEv; congr col_mx; rewrite -block_mxEh block_mxEv.
      rewrite !col_mx_sub; set M := block_mx (span _ _) _ _ _.
      have s1 r (c : 'M_(r, n)) : (c <= span (mcC S) (N i))%MS -> (row_mx c 0 <= M)%MS.
        case/submxP=> D' ->; apply/submxP; exists (row_mx D' 0).
        by rewrite mul_row_block !(mul0mx, mulmx0, addr0).
      rewrite !s1 //=; last 2 first.
      - by rewrite -CN -addsmxE addsmxSr.
      - by rewrite -CN -addsmxE addsmxSl.
      apply/submxP; exists (row_mx 0 1%:M); by rewrite mul_row_block !(mul0mx, mulmx0, mul1mx, add0r, addr0).
    have -> : block_mx (C0 i) 0 (col_mx (Y i) 0) (col_mx 0 (Hs i)) =
        col_mx (row_mx (C0 i) 0) (col_mx (row_mx (Y i) 0) (row_mx 0 (Hs i))).
      by rewrite block_mxEv; congr col_mx; rewrite -block_mxEh block_mxEv.
    rewrite block_mxEv col_mx_sub; set M := col_mx _ (col_mx _ _); apply/andP; split; last first.
      apply/submxP; exists (row_mx 0 (row_mx 0 1%:M)).
      by rewrite !mul_row_col !mul0mx mul1mx !add0r.
    have : (span (mcC S) (N i) <= col_mx (C0 i) (Y i))%MS by rewrite CN.
    case/submxP=> D' ->; rewrite -[D']hsubmxK mul_row_col; apply/submxP.
    exists (row_mx (lsubmx D') (row_mx (rsubmx D') 0)).
    by rewrite !mul_row_col mul0mx addr0 !mul_mx_row !mulmx0 add_row_mx addr0.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  have eO := eqmx_outputs S (neighborhood N s).
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?span_bigcup ?eO.
rewrite rank_eliminated (rank_block_eq _ eB eC) rank_block_diag (rank_schur _ _ Z_unit).
rewrite addnA; congr addn; rewrite -(rank_select L k (neighborhood N s :\: s)).
have Hh i j : j \in N i -> XH j (d i j) *m h =
    (if j \in ~: s then lambda^-1 ^+ (d i j).+1 else 0) *: (shared_input L k j)^T.
  move=> Nj; rewrite /h mul_mxrow; apply/mxrowP => l; rewrite mxrowK.
  have -> : submxrow ((if j \in ~: s then lambda^-1 ^+ (d i j).+1 else 0) *: (shared_input L k j)^T) l =
      (if j \in ~: s then lambda^-1 ^+ (d i j).+1 else 0) *: (agent_block L k j *m (agent_block L k l)^T).
    rewrite /agent_block tr_submxcol trmx1 mul_submxrow mulmx1 /shared_input tr_submxrow trmx1.
    by apply/matrixP => x y; rewrite !mxE.
  have [->|lj] := eqVneq l j.
    rewrite block_tr; case: ifP => _; last by rewrite mulmx0 scale0r.
    by rewrite XH_input scalemx1.
  rewrite block_tr0 1?eq_sym // scaler0; case: ifP => _; last by rewrite mulmx0.
  by rewrite XH_input0 // eq_sym.
have subZ i j : j \in N i -> sub_state j (d i j) *m (invmx Z *m h) = XH j (d i j) *m h.
  by move=> Nj; rewrite -XH_Z ?delay_le // mulmxA mulmxK ?Z_unit.
rewrite -mulmxA; apply: eqmx_rank; apply/andP; split.
  rewrite -sub_preimage; apply/span_sub => i si; rewrite sub_preimage /Hs mxcol_mul eqmx_col.
  apply/sumsmx_subP => j _; rewrite genmxE; case: ifP => [Nj|_]; last by rewrite mul0mx sub0mx.
  rewrite subZ // Hh //; case: ifP => [sj|_]; last by rewrite scale0r sub0mx.
  apply: scalemx_sub; rewrite -span_shared; apply: sub_span; rewrite !inE in sj *; rewrite sj.
  by apply/bigcupP; exists i.
rewrite -span_shared; apply/span_sub => j; rewrite inE => /andP[sj /bigcupP[i si Nj]].
have -> : ((shared_input L k j)^T :=: XH j (d i j) *m h)%MS.
  by apply: eqmx_sym; rewrite Hh // inE sj; apply: eqmx_scale; rewrite expf_neq0 // invr_eq0.
rewrite -(subZ _ _ Nj); apply: submxMr; apply: submx_trans (sub_span _ si).
by rewrite /Hs eqmx_col; apply: (sumsmx_sup j) => //; rewrite genmxE Nj.
Qed.

Theorem lifted_not_fixed :
  ~ fixed (lifted N k d S) lambda <->
  forall s, (n - \rank (neighbor_pencil N S s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite anderson_clements; split=> [nf s|h [s]]; last first.
  by rewrite rank_lifted addnAC ltn_add2r ltnNge -leq_subLR h.
rewrite leq_subLR leqNgt; apply/negP => lt; apply: nf; exists s.
by rewrite rank_lifted addnAC ltn_add2r.
Qed.

End Lifted.

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

(* DESIGN 2.9: the held system has the fixed eigenvalues of the extended system of Remark 2 *)
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
