(* What no decentralized control moves, if it may vary in time and be nonlinear.

   The channels of the system are those of the strong components of a transfer graph, merged: then they have an
   order such that no channel acts on the outputs of one before it.  A set s is an initial part of it, T the
   others.  W has as rows what annihilates <A | B_T>; what agents of s measure is seen through W x.  Where
   rank P_s(lambda) < n, two states have the same measurements at s for ever, whatever the agents of T do, and
   their difference, through W, is driven by lambda alone (Anderson and Moore 1981; Gong and Aldeen 1997). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability joint_controllability pencil_space anderson_clements extended_bound nested_sets.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* Causal decentralized controllers in discrete time: what agent i does at t depends on what it measured until t. *)
Section Causal.
Variables (K : ringType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).

Definition controller := forall i, nat -> (nat -> 'cV[K]_(q i)) -> 'cV[K]_(p i).
Definition causal (phi : controller) := forall i t y y',
  (forall k, (k <= t)%N -> y k = y' k) -> phi i t y = phi i t y'.
Definition follows (phi : controller) (x : nat -> 'cV[K]_n) := forall t,
  x t.+1 = mcA S *m x t + \sum_i mcB S i *m phi i t (fun k => mcC S i *m x k).

Variables (s : {set 'I_m}) (c k : nat).
Variables (W : 'M[K]_(c, n)) (Z : 'M[K]_c) (Y : forall i, 'M[K]_(q i, c)) (V : 'M[K]_(c, k)) (M : 'M[K]_k).
Hypothesis invariant : W *m mcA S = Z *m W.
Hypothesis unmoved : forall j, j \notin s -> W *m mcB S j = 0.
Hypothesis seen : forall i, i \in s -> mcC S i = Y i *m W.
Hypothesis driven : Z *m V = V *m M.
Hypothesis hidden : forall i, i \in s -> Y i *m V = 0.

Theorem same_for_ever phi x x' v : causal phi -> follows phi x -> follows phi x' ->
  W *m x' 0%N = W *m x 0%N + V *m v -> forall t, W *m x' t = W *m x t + V *m iter t (mulmx M) v.
Proof.
move=> ca fx fx' start t.
elim: t {-2}t (leqnn t) => [|t IH] r; first by rewrite leqn0 => /eqP ->.
rewrite leq_eqVlt => /orP[/eqP ->|]; last by rewrite ltnS; apply: IH.
rewrite fx fx' !mulmxDr !mulmxA !invariant -!mulmxA (IH t (leqnn t)) mulmxDr addrAC; congr (_ + _).
  congr (_ + _); rewrite !mulmx_sumr; apply: eq_bigr => i _; rewrite !mulmxA.
  have [si|/unmoved ->] := boolP (i \in s); last by rewrite !mul0mx.
  congr (_ *m _); apply: ca => u ut.
  by rewrite seen // -!mulmxA (IH u ut) mulmxDr !mulmxA hidden // mul0mx addr0.
by rewrite !mulmxA driven.
Qed.
End Causal.

(* what annihilates B, ..., A^(n-1)B annihilates all *)
Lemma annihilated_longer (K : fieldType) n b (A : 'M[K]_n) (B : 'M_(n, b)) w (X : 'M_(w, n)) k :
  X *m reach A B n = 0 -> X *m krylov A B k = 0.
Proof.
move=> z; have sk : (kermx (reach A B (maxn n k.+1)) <= kermx (reach A B n))%MS.
  apply/sub_kermxP/reach_annihilated => u un.
  have /reach_annihilated := mulmx_ker (reach A B (maxn n k.+1)); apply.
  by apply: leq_trans un (leq_maxl _ _).
have := mxrank_leqif_sup sk; rewrite !mxrank_ker rank_reach_n ?leq_maxl // => -[_].
rewrite eqxx => /esym sk'.
have /sub_kermxP/submx_trans/(_ sk')/sub_kermxP/reach_annihilated := z.
by apply; rewrite leq_maxr.
Qed.

(* The initial parts: no channel outside acts on the outputs of one within. *)
Section Parts.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Implicit Types (s : {set 'I_m}).

Definition unaffected s := forall i j k, i \in s -> j \notin s -> mcC S i *m krylov (mcA S) (mcB S j) k = 0.

Lemma krylov_inputs T k : krylov (mcA S) (inputs S T) k =
  \mxrow_i (if i \in T then krylov (mcA S) (mcB S i) k else 0).
Proof.
elim: k => [//|k IH]; rewrite krylovS IH mul_mxrow; apply: eq_mxrow => i.
by case: ifP => // _; rewrite mulmx0.
Qed.

(* rows that annihilate <A | B_T>: they are independent, A keeps them, and C_s is made of them *)
Lemma annihilator s : unaffected s -> exists c (W : 'M_(c, n)) Z (Y : forall i, 'M_(q i, c)),
  [/\ row_free W, W *m mcA S = Z *m W, W *m reach (mcA S) (inputs S (~: s)) n = 0,
     (W :=: kermx (reach (mcA S) (inputs S (~: s)) n))%MS & forall i, i \in s -> mcC S i = Y i *m W].
Proof.
move=> un; set R := reach _ _ _; exists (\rank (kermx R)), (row_base (kermx R)).
have W0 : row_base (kermx R) *m R = 0 by apply/sub_kermxP; rewrite eq_row_base.
have /submxP[Z eZ] : (row_base (kermx R) *m mcA S <= row_base (kermx R))%MS.
  rewrite eq_row_base; apply/sub_kermxP/reach_annihilated => k _.
  by rewrite -mulmxA -krylovS; apply: annihilated_longer.
have sub i : exists Yi, i \in s -> mcC S i = Yi *m row_base (kermx R).
  have [si|_] := boolP (i \in s); last by exists 0.
  suff /submxP[Yi e] : (mcC S i <= row_base (kermx R))%MS by exists Yi.
  rewrite eq_row_base; apply/sub_kermxP/reach_annihilated => k _.
  rewrite krylov_inputs mul_mxrow -[RHS](@mxrow0 _ _ p); apply: eq_mxrow => j.
  by rewrite inE; case: ifP => [sj|_]; [apply: un | rewrite mulmx0].
have [Y eY] := fin_all_exists sub.
exists Z, Y; split=> //; [exact: row_base_free | exact: eq_row_base].
Qed.

Lemma annihilator_inputs s c (W : 'M_(c, n)) : W *m reach (mcA S) (inputs S (~: s)) n = 0 ->
  forall j, j \notin s -> W *m mcB S j = 0.
Proof.
move=> z j sj; have := annihilated_longer 0 z; rewrite /krylov /= => /(congr1 (fun M => submxrow M j)).
by rewrite -mul_submxrow /inputs mxrowK inE sj submxrow0.
Qed.

Lemma outputs_made s c (W : 'M_(c, n)) (Y : forall i, 'M_(q i, c)) : (forall i, i \in s -> mcC S i = Y i *m W) ->
  outputs S s = (\mxcol_i (if i \in s then Y i else 0)) *m W.
Proof.
move=> e; rewrite mxcol_mul; apply: eq_mxcol => i; case: ifP => [/e//|_]; by rewrite mul0mx.
Qed.

(* the rank is at most n: [W, 0] spans the rows of C_s, and what W picks of the first rows *)
Lemma rank_unaffected s lambda : unaffected s -> (\rank (pencil S s lambda) <= n)%N.
Proof.
move=> /annihilator[c [W [Z [Y [fW eA W0 _ eC]]]]].
have WB : W *m inputs S (~: s) = 0 := annihilated_longer 0 W0.
set N := row_mx (lambda%:M - mcA S) (inputs S (~: s)).
have WN : W *m N = (lambda%:M - Z) *m row_mx W 0.
  by rewrite /N !mul_mx_row WB mulmx0 mulmxBr mulmxBl eA scalar_mxC.
have /sub_addsmxP[[u v] /= e1] : (1%:M <= W + W^C)%MS by rewrite sub1mx addsmx_compl_full.
have sub : (pencil S s lambda <= row_mx W (0 : 'M_(c, \sum_i p i)) + W^C *m N)%MS.
  rewrite /pencil block_mxEv col_mx_sub; apply/andP; split.
    rewrite -/N -{1}[N]mul1mx e1 mulmxDl -!mulmxA WN; apply: addmx_sub_adds; last exact: submxMl.
    by rewrite mulmxA submxMl.
  rewrite (outputs_made eC); set Yc := mxcol _.
  have -> : row_mx (Yc *m W) (0 : 'M_(_, \sum_i p i)) = Yc *m row_mx W 0 by rewrite mul_mx_row mulmx0.
  by apply: submx_trans (submxMl _ _) (addsmxSl _ _).
apply: leq_trans (mxrankS sub) _; apply: leq_trans (mxrank_adds_leqif _ _) _.
have rW : (\rank W <= n)%N by rewrite rank_leq_col.
apply: (@leq_trans (\rank W + (n - \rank W))); last by rewrite subnKC.
apply: leq_add.
  have -> : row_mx W 0 = W *m row_mx 1%:M (0 : 'M_(n, \sum_i p i)) by rewrite mul_mx_row mulmx1 mulmx0.
  exact: mxrankM_maxl.
by rewrite -mxrank_compl mxrankM_maxl.
Qed.
End Parts.

(* an eigenvalue of what s sees, that s does not see *)
Section Hidden.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q) (s : {set 'I_m}).
Variables (c : nat) (W : 'M[K]_(c, n)) (Z : 'M[K]_c) (Y : forall i, 'M[K]_(q i, c)).
Hypothesis free : row_free W.
Hypothesis invariant : W *m mcA S = Z *m W.
Hypothesis unmoved : W *m reach (mcA S) (inputs S (~: s)) n = 0.
Hypothesis all : (W :=: kermx (reach (mcA S) (inputs S (~: s)) n))%MS.
Hypothesis made : forall i, i \in s -> mcC S i = Y i *m W.
Let Ys := \mxcol_i (if i \in s then Y i else 0).

(* [lambda I - A, B_T; W, 0] has rank n: its rows have c relations at most *)
Lemma rank_with_annihilator lambda :
  (n <= \rank (block_mx (lambda%:M - mcA S) (inputs S (~: s)) W 0))%N.
Proof.
set N := inputs _ _; set Q := block_mx _ _ _ _.
suff le : (\rank (kermx Q) <= c)%N.
  by move: le; rewrite mxrank_ker leq_subLR leq_add2r.
have e0 := mulmx_ker Q; rewrite -[kermx Q]hsubmxK mul_row_block in e0.
move: e0; set G := lsubmx _; set H := rsubmx _ => e0.
have [eH eB] : G *m (lambda%:M - mcA S) + H *m W = 0 /\ G *m N = 0.
  by move: e0; rewrite mulmx0 addr0 -[0]hsubmxK !linear0 => /eq_row_mx[].
have GA : G *m mcA S = lambda *: G + H *m W.
  by apply/eqP; rewrite eq_sym -subr_eq0 -eH mulmxBr mul_mx_scalar addrAC.
have /submxP[E eE] : (G <= W)%MS.
  rewrite all; apply/sub_kermxP/reach_annihilated => k _.
  elim: k => [//|k IH]; rewrite krylovS mulmxA GA mulmxDl -scalemxAl IH scaler0 add0r -mulmxA.
  by rewrite annihilated_longer ?mulmx0.
have eHE : H = - (E *m (lambda%:M - Z)).
  apply: (row_free_inj free); apply/eqP; rewrite mulNmx -addr_eq0 addrC -eH eE -!mulmxA; apply/eqP.
  by congr (_ *m _ + _); rewrite mulmxBr mulmxBl invariant scalar_mxC.
have -> : kermx Q = E *m row_mx W (- (lambda%:M - Z)) by rewrite -[LHS]hsubmxK -/G -/H eHE eE mul_mx_row mulmxN.
exact: leq_trans (mxrankM_maxr _ _) (rank_leq_row _).
Qed.

Lemma hidden_eigenvector lambda : (\rank (pencil S s lambda) < n)%N ->
  exists2 z : 'cV_c, z != 0 & Z *m z = lambda *: z /\ Ys *m z = 0.
Proof.
move=> less; have [/eqP full|nfull] := boolP (\rank (col_mx (lambda%:M - Z) Ys) == c); last first.
  have /rowV0Pn[v vk v0] : kermx (col_mx (lambda%:M - Z) Ys)^T != 0.
    by rewrite -mxrank_eq0 mxrank_ker mxrank_tr subn_eq0 -ltnNge ltn_neqAle nfull rank_leq_col.
  have : col_mx (lambda%:M - Z) Ys *m v^T = 0.
    by apply: trmx_inj; rewrite trmx_mul trmxK trmx0; apply/sub_kermxP.
  rewrite mul_col_mx -[0]vsubmxK !linear0 => /eq_col_mx[e1 e2].
  exists v^T; first by rewrite trmx_eq0.
  split=> //; apply/eqP; rewrite -subr_eq0 -opprB -mul_scalar_mx -mulmxBl e1 oppr0.
  by [].
have /submxP[L eL] : (1%:M <= col_mx (lambda%:M - Z) Ys)%MS by rewrite sub1mx; apply/eqP.
case/negP: (ltn_geF less); apply: leq_trans (rank_with_annihilator lambda) _; apply: mxrankS.
set N := row_mx (lambda%:M - mcA S) (inputs S (~: s)).
have eP : pencil S s lambda = col_mx N (row_mx (outputs S s) 0) by rewrite /pencil block_mxEv.
have NP : (N <= pencil S s lambda)%MS by rewrite eP; apply/submxP; exists (row_mx 1%:M 0); rewrite mul_row_col mul1mx mul0mx addr0.
have CP : (row_mx (outputs S s) 0 <= pencil S s lambda)%MS.
  by rewrite eP; apply/submxP; exists (row_mx 0 1%:M); rewrite mul_row_col mul1mx mul0mx add0r.
rewrite block_mxEv col_mx_sub NP /=.
have -> : row_mx W 0 = lsubmx L *m (W *m N) + rsubmx L *m row_mx (outputs S s) 0.
  have WB : W *m inputs S (~: s) = 0 := annihilated_longer 0 unmoved.
  rewrite /N (outputs_made made) !mul_mx_row WB !mulmx0 add_row_mx addr0; congr row_mx.
  rewrite mulmxBr invariant scalar_mxC -mulmxBl !mulmxA -mulmxDl -mul_row_col hsubmxK -eL.
  by rewrite mul1mx.
apply: addmx_sub; first by rewrite mulmxA; exact: submx_trans (submxMl _ _) NP.
exact: submx_trans (submxMl _ _) CP.
Qed.
End Hidden.

(* Among the sets at which the rank is low there is an initial part. *)
Section Order.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel L n p q) (lambda : L).
Variable order : 'I_m -> nat.
Hypothesis apart : injective order.
Hypothesis later : forall i j k, (order i < order j)%N -> mcC S i *m krylov (mcA S) (mcB S j) k = 0.
Let before k := [set i | (order i < k)%N].

Lemma before_unaffected k : unaffected S (before k).
Proof.
by move=> i j r; rewrite !inE -leqNgt => ik kj; apply: later; apply: leq_trans ik kj.
Qed.

Lemma beforeS j k : (j <= k)%N -> before j \subset before k.
Proof. by move=> jk; apply/subsetP => i; rewrite !inE => /leq_trans; apply. Qed.

Lemma uncrossed s k : (\rank (pencil S s lambda) < n)%N ->
  exists2 t, (\rank (pencil S t lambda) < n)%N &
    forall j, (j < k)%N -> (t \subset before j) || (before j \subset t).
Proof.
move=> low; elim: k => [|k [t lt cmp]]; first by exists s.
have sum := rank_submodular_states S lambda t (before k).
have le : (\rank (pencil S (before k) lambda) <= n)%N by apply: rank_unaffected; apply: before_unaffected.
have [lU|nU] := boolP (\rank (pencil S (t :|: before k) lambda) < n)%N.
  exists (t :|: before k) => // j; rewrite ltnS leq_eqVlt => /orP[/eqP ->|jk]; first by rewrite subsetUr orbT.
  by rewrite (subset_trans (beforeS (ltnW jk)) (subsetUr _ _)) orbT.
exists (t :&: before k).
  rewrite -leqNgt in nU; rewrite ltnNge; apply/negP => nI.
  have := leq_trans (leq_add nU nI) sum; rewrite leqNgt => /negP; apply.
  by rewrite -addSn leq_add.
move=> j; rewrite ltnS leq_eqVlt => /orP[/eqP ->|jk]; first by rewrite subsetIr.
have /orP[h|h] := cmp j jk; first by rewrite (subset_trans (subsetIl _ _) h).
by rewrite subsetI h (beforeS (ltnW jk)) orbT.
Qed.

Theorem initial_part : fixed S lambda -> exists k, (\rank (pencil S (before k) lambda) < n)%N.
Proof.
move=> /anderson_clements[s low]; have [b bound] : exists b, forall i, (order i < b)%N.
  by exists (\max_i order i).+1 => i; rewrite ltnS leq_bigmax.
have [t lt cmp] := uncrossed b.+1 low.
have whole : before b = setT by apply/setP => i; rewrite !inE bound.
have [k kt kmax] : exists2 k, before k \subset t & forall j, (j <= b)%N -> before j \subset t -> (j <= k)%N.
  have ex0 : exists j, (j <= b)%N && (before j \subset t).
    by exists 0%N; apply/subsetP => i; rewrite inE.
  have [k /andP[_ kt] kmax] := ex_maxnP ex0 (fun j h => proj1 (andP h)).
  by exists k => // j jb jt; apply: kmax; rewrite jb.
have [bk|kb] := leqP b k.
  exists b; suff -> : before b = t by [].
  by apply/eqP; rewrite eqEsubset whole subsetT -whole (subset_trans (beforeS bk)).
exists k; suff -> : before k = t by [].
have nk : ~~ (before k.+1 \subset t) by apply/negP => /(kmax _ kb); rewrite ltnn.
have /orP[tk|/(negP nk)//] := cmp k.+1 kb.
apply/eqP; rewrite eqEsubset kt /=; apply/subsetP => i it; rewrite inE.
have := subsetP tk i it; rewrite inE ltnS leq_eqVlt => /orP[/eqP ik|//].
case/negP: nk; apply/subsetP => j; rewrite inE ltnS leq_eqVlt => /orP[/eqP jk|jk].
  by rewrite (apart (etrans jk (esym ik))).
by apply: (subsetP kt); rewrite inE.
Qed.
End Order.

(* A fixed mode lambda of the merged plant, in an extension of the field of the data: whatever causal
   decentralized controllers do, the difference of two trajectories follows lambda through W. *)
Section Moved.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (S : multichannel K n p q) (lambda : L) (order : 'I_m -> nat).
Hypothesis apart : injective order.
Hypothesis later : forall i j k, (order i < order j)%N -> mcC S i *m krylov (mcA S) (mcB S j) k = 0.

Theorem no_causal_control_moves : fixed (map_system f S) lambda ->
  exists c k (W : 'M[K]_(c, n)) (U : 'M[K]_(n, k)) (M : 'M[K]_k),
  [/\ eigenvalue (map_mx f M) lambda, row_free (W *m U)^T &
     forall phi x x' v, causal phi -> follows S phi x -> follows S phi x' -> x' 0%N = x 0%N + U *m v ->
     forall t, W *m (x' t - x t) = W *m U *m iter t (mulmx M) v].
Proof.
have later' i j k : (order i < order j)%N ->
    mcC (map_system f S) i *m krylov (mcA (map_system f S)) (mcB (map_system f S) j) k = 0.
  by move=> /later e; rewrite /= -map_krylov -map_mxM e map_mx0.
move=> /(initial_part apart later')[k]; set s := [set i | _] => low.
have un : unaffected S s by move=> i j r; rewrite !inE -leqNgt => ik kj; apply: later; apply: leq_trans ik kj.
have [c [W [Z [Y [fW eA W0 all made]]]]] := annihilator un.
have [z z0 [ez hz]] : exists2 z : 'cV_c, z != 0 & map_mx f Z *m z = lambda *: z /\
    (\mxcol_i (if i \in s then map_mx f (Y i) else 0)) *m z = 0.
  apply: (@hidden_eigenvector _ _ _ _ _ (map_system f S) s c (map_mx f W)) low => //=.
  - by rewrite row_free_map.
  - by rewrite -!map_mxM eA.
  - by rewrite -map_inputs -map_reach -map_mxM W0 map_mx0.
  - rewrite -map_inputs -map_reach -map_kermx; apply/eqmxP; rewrite !map_submx; exact/eqmxP.
  - by move=> i /made ->; rewrite map_mxM.
set Ys := \mxcol_i (if i \in s then Y i else 0).
have eYs := map_outputs f (Multichannel 0 (fun i => 0 : 'M_(c, p i)) Y) s.
rewrite /outputs /= -/Ys in eYs; rewrite -{}eYs in hz.
set R := reach Z^T Ys^T c; set V := (row_base (kermx R))^T.
have ZV : exists M, Z *m V = V *m M.
  have /submxP[M eM] : (row_base (kermx R) *m Z^T <= row_base (kermx R))%MS.
    rewrite eq_row_base; apply/sub_kermxP/reach_annihilated => j _.
    by rewrite -mulmxA -krylovS annihilated_longer //; apply/sub_kermxP; rewrite eq_row_base.
  by exists M^T; apply: trmx_inj; rewrite !trmx_mul !trmxK.
have [M eM] := ZV.
have YV : Ys *m V = 0.
  apply: trmx_inj; rewrite trmx_mul trmxK trmx0; have := @annihilated_longer _ _ _ Z^T Ys^T _ (row_base (kermx R)) 0.
  by apply; apply/sub_kermxP; rewrite eq_row_base.
have [w ew] : exists w, z = map_mx f V *m w.
  suff /submxP[w ew] : (z^T <= map_mx f (row_base (kermx R)))%MS.
    by exists w^T; apply: trmx_inj; rewrite ew trmx_mul map_trmx !trmxK.
  apply: (@submx_trans _ _ _ _ _ _ (map_mx f (kermx R))); last by rewrite map_submx eq_row_base.
  rewrite map_kermx; apply/sub_kermxP; rewrite map_reach; apply/reach_annihilated => j _.
  apply: (@krylov_annihilated _ _ _ _ _ _ _ lambda%:M).
    by rewrite mul_scalar_mx -map_trmx -trmx_mul ez linearZ.
  by rewrite -map_trmx -trmx_mul hz trmx0.
have fV : row_free V^T by rewrite trmxK row_base_free.
have wV : map_mx f V *m (map_mx f M *m w) = map_mx f V *m (lambda *: w).
  by rewrite mulmxA -map_mxM -eM map_mxM -mulmxA -ew ez ew -scalemxAr.
have free u u' : map_mx f V *m u = map_mx f V *m u' -> u = u'.
  move=> /(congr1 trmx); rewrite !trmx_mul map_trmx => e; apply: trmx_inj.
  by apply: (row_free_inj _ e); rewrite row_free_map.
have w0 : w != 0 by apply: contraNneq z0 => w0; rewrite ew w0 mulmx0.
have made_free : W *m (pinvmx W *m V) = V by rewrite mulmxA mulmxVp // mul1mx.
exists c, (\rank (kermx R)), W, (pinvmx W *m V), M; split; last 2 first.
- by rewrite made_free.
- move=> phi x x' v ca fx fx' start t; rewrite mulmxBr made_free.
  apply/eqP; rewrite subr_eq addrC; apply/eqP.
  apply: (@same_for_ever _ _ _ _ _ S s c _ W Z Y V M) ca fx fx' _ t => //.
  - exact: annihilator_inputs W0.
  - move=> i si; have := congr1 (fun X => submxcol X i) YV.
    by rewrite -submxcol_mul mxcolK si submxcol0.
  - by rewrite start mulmxDr mulmxA mulmxA mulmxVp // mul1mx.
rewrite eigenvalue_rank ltn_neqAle rank_leq_row andbT; apply: contraNneq w0 => full.
have : (lambda%:M - map_mx f M) *m w = 0 by rewrite mulmxBl mul_scalar_mx (free _ _ _ wV) subrr.
move=> /(congr1 trmx); rewrite trmx_mul trmx0 => e; rewrite -[w]trmxK -(inj_eq trmx_inj) trmxK trmx0.
by apply/eqP; apply: (@row_free_inj _ _ _ _ (lambda%:M - map_mx f M)^T); rewrite ?mul0mx // /row_free mxrank_tr full.
Qed.
End Moved.
