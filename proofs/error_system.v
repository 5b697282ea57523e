(* The open-loop error system (com.o), (anal) of the distributed observer: Lemmas 1, 2 and 4 and
   Proposition 1, with Corfmat and Morse's theorem proved, not assumed. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import extended neighbor_graph extended_bound.
From mcexact Require Import sequential_gains feedback corfmat_morse.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Lemma observableP (K : fieldType) n r (A : 'M[K]_n) (C : 'M[K]_(r, n)) : reflect
  (forall v : 'cV_n, (forall t, C *m krylov A v t = 0) -> v = 0) (controllable A^T C^T).
Proof.
apply: (iffP (controllableP _ _)) => h v hv.
  apply: trmx_inj; rewrite trmx0; apply: h => t.
  by rewrite -krylov_tr hv trmx0.
apply: trmx_inj; rewrite trmx0; apply: h => t.
by apply: trmx_inj; rewrite krylov_tr trmxK hv trmx0.
Qed.

Section ErrorSystem.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Hypothesis hears : forall i, i \in N i.
Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).
Notation nm := (\sum_(i < m) n)%N.

(* e_i, and the input of agent i: b_i (x) I *)
Definition block_of (i : 'I_m) : 'M[K]_(n, nm) := submxcol 1%:M i.
Definition error_input (i : 'I_m) : 'M[K]_(nm, n) := submxrow 1%:M i.

(* I (x) (A + sum B_j F_j) - Q *)
Definition error_A : 'M[K]_nm :=
  \mxblock_(i, j) ((if i == j then mcA S + \sum_l mcB S l *m F l else 0) - mcB S j *m F j).

(* column of C_ij = (b_i' - b_j') (x) I, j in N_i *)
Definition differences (i : 'I_m) : 'M[K]_nm :=
  \mxcol_j (if j \in N i then block_of i - block_of j else 0).

Definition error_system : multichannel K nm (fun=> n) (fun i => q i + nm)%N :=
  Multichannel error_A error_input (fun i => col_mx (mcC S i *m block_of i) (differences i)).

Lemma block_ofE r i (M : 'M[K]_(nm, r)) : block_of i *m M = submxcol M i.
Proof. by rewrite /block_of submxcol_mul mul1mx. Qed.

Lemma blocks_eq r (M M' : 'M[K]_(nm, r)) : (forall i, block_of i *m M = block_of i *m M') -> M = M'.
Proof. by move=> e; apply/mxcolP => i; rewrite -!block_ofE. Qed.

Lemma block_error_A r i (M : 'M[K]_(nm, r)) : block_of i *m (error_A *m M) =
  (mcA S + \sum_l mcB S l *m F l) *m (block_of i *m M) - \sum_j mcB S j *m F j *m (block_of j *m M).
Proof.
rewrite -[M in error_A *m M](submxcolK M) /error_A mul_mxblock_mxrow block_ofE mxcolK.
rewrite (eq_bigr (fun j => (if i == j then (mcA S + \sum_l mcB S l *m F l) *m (block_of j *m M) else 0)
   - mcB S j *m F j *m (block_of j *m M))) => [|j _]; last first.
  by rewrite mulmxBl block_ofE; case: ifP; rewrite ?mul0mx.
rewrite sumrB -big_mkcond /= (big_pred1 i) // => j; by rewrite eq_sym.
Qed.

Lemma differences_eq0 r i (M : 'M[K]_(nm, r)) :
  differences i *m M = 0 <-> (forall j, j \in N i -> block_of i *m M = block_of j *m M).
Proof.
rewrite /differences mxcol_mul; split=> [/mxcolP e j Nj|e].
  have := e j; rewrite mxcolK Nj submxcol0 mulmxBl => /eqP; rewrite subr_eq0.
  by move/eqP.
apply/mxcolP => j; rewrite mxcolK submxcol0; case: ifP => [/e|_]; last by rewrite mul0mx.
by rewrite mulmxBl => ->; rewrite subrr.
Qed.

(* Lemma 1, first half *)
Theorem lemma_1_controllable : jointly_controllable error_system.
Proof.
apply/controllableP => w /(_ 0%N); rewrite /krylov /=.
have -> : inputs error_system setT = 1%:M.
  rewrite /inputs -[RHS](submxrowK 1%:M); apply: eq_mxrow => i; by rewrite inE.
by rewrite mulmx1.
Qed.

Lemma connect_eq (T : Type) (e : rel 'I_m) (g : 'I_m -> T) :
  (forall x y, e x y -> g x = g y) -> forall x y, connect e x y -> g x = g y.
Proof.
move=> ge x y /connectP[w]; elim: w x => [|z w IH] x /=; first by move=> _ ->.
by case/andP=> /ge -> /IH h /h.
Qed.

(* Lemma 1, second half *)
Theorem lemma_1_observable : strongly_connected (neighbor_arc N) -> jointly_observable S ->
  jointly_observable error_system.
Proof.
move=> sc /observableP jo; apply/observableP => v hv; set e := krylov error_A v.
have out t i : mcC error_system i *m e t = 0.
  by apply: ((outputs_eq0 _ _ _).1 (hv t)); rewrite inE.
have same t i j : block_of i *m e t = block_of j *m e t.
  apply: (connect_eq (g := fun i => block_of i *m e t) _ (sc i j)) => x y Nx.
  have := out t y; rewrite /= mul_col_mx -[0]col_mx0 => /eq_col_mx[_ /differences_eq0 h].
  by rewrite (h x Nx).
apply: blocks_eq => i; rewrite mulmx0.
have all t j : block_of j *m e t = krylov (mcA S) (block_of i *m v) t.
  elim: t j => [|t IH] j; first by rewrite (same 0%N j i).
  rewrite /e krylovS block_error_A -/e (eq_bigr (fun l => mcB S l *m F l *m (block_of j *m e t))).
    by rewrite mulmxDl -mulmx_suml addrK IH.
  by move=> l _; rewrite (same t j l).
apply: jo => t; apply/outputs_eq0 => j _; rewrite -(all t j) mulmxA.
by have := out t j; rewrite /= mul_col_mx -[0]col_mx0 => /eq_col_mx[-> _].
Qed.

End ErrorSystem.

Section GraphScalars.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (m : nat).
Variable (N : 'I_m -> {set 'I_m}).
Hypothesis inf : infinite K.
Hypothesis sc : strongly_connected (neighbor_arc N).

(* b_i and the rows c_ij = b_i' - b_j', j in N_i; a gain row phi_i has the entries phi_ij *)
Definition graph_system (R : ringType) : multichannel R m (fun=> 1%N) (fun=> m) :=
  Multichannel 0 (fun i => delta_mx i 0)
    (fun i => \matrix_(j, k) if j \in N i then (k == i)%:R - (k == j)%:R else 0).

Lemma map_graph_system : mcA (map_system f (graph_system K)) = mcA (graph_system L) /\
  (forall i, mcB (map_system f (graph_system K)) i = mcB (graph_system L) i) /\
  (forall i, mcC (map_system f (graph_system K)) i = mcC (graph_system L) i).
Proof.
split; first by rewrite /= map_mx0.
split=> i; apply/matrixP => a b; rewrite !mxE ?rmorph_nat //.
by case: ifP => _; rewrite ?rmorph0 // rmorphB /= !rmorph_nat.
Qed.

Lemma rank_block0 (R : fieldType) r c b a (B : 'M[R]_(r, b)) (C : 'M_(a, c)) :
  (\rank B + \rank C <= \rank (block_mx 0 B C 0))%N.
Proof.
rewrite -rank_diag_block_mx.
have -> : block_mx B 0 0 C = block_mx 0 B C 0 *m block_mx 0 1%:M 1%:M 0.
  by rewrite mulmx_block !(mul0mx, mulmx0, mulmx1, addr0, add0r).
exact: mxrankM_maxl.
Qed.

(* no nonempty proper set of agents hides a difference *)
Lemma graph_no_kernel (R : fieldType) (s : {set 'I_m}) (x : 'cV[R]_m) : s != setT ->
  (forall i, i \notin s -> x i 0 = 0) ->
  (forall i j, i \in s -> j \in N i -> x i 0 = x j 0) -> x = 0.
Proof.
move=> sT xs xe; pose s' := [set i | x i 0 != 0].
have [s'0|s'0] := eqVneq s' set0.
  apply/matrixP => i k; rewrite (ord1 k) [RHS]mxE; apply/eqP.
  by have := in_set0 i; rewrite -s'0 inE => /negbFE.
have ss i : x i 0 != 0 -> i \in s by apply: contraR => /xs ->.
have s'T : s' != setT.
  apply: contraNneq sT => e; apply/eqP/setP => i; rewrite in_setT ss //.
  by have := in_setT i; rewrite -e inE.
have /strongly_connectedP/(_ s' s'0 s'T)[j [i [Nji]]] := sc.
rewrite !inE negbK => /eqP xj xi; have := xe i j (ss i xi) Nji.
by rewrite xj => e; rewrite e eqxx in xi.
Qed.

Lemma graph_pencil (s : {set 'I_m}) (lambda : L) : s != setT ->
  (m <= \rank (pencil (graph_system L) s lambda))%N.
Proof.
move=> sT; have [->|l0] := eqVneq lambda 0; last first.
  rewrite /pencil /= subr0; apply: leq_trans (le_rank_block _ _ _).
  by rewrite mxrank_unit // unitmxE det_scalar unitfE expf_neq0.
rewrite /pencil /= subr0 -scalemx1 scale0r; apply: leq_trans (rank_block0 _ _).
rewrite -[X in (X + _)%N]mxrank_tr; apply: leq_trans (mxrank_adds_leqif _ _).
set M := (_ + _)%MS; rewrite -mxrank_tr -subn_eq0.
suff : kermx M^T == 0 by rewrite -mxrank_eq0 mxrank_ker.
apply/rowV0P => w /sub_kermxP wM; apply: trmx_inj; rewrite trmx0.
have zero r (Z : 'M[L]_(r, m)) : (Z <= M)%MS -> Z *m w^T = 0.
  by case/submxP=> D ->; apply: trmx_inj; rewrite !trmx_mul trmxK mulmxA wM mul0mx trmx0.
have zI : (inputs (graph_system L) (~: s))^T *m w^T = 0 by apply: zero; apply: addsmxSl.
have zO : outputs (graph_system L) s *m w^T = 0 by apply: zero; apply: addsmxSr.
apply: (graph_no_kernel sT).
  move=> i si; have : (delta_mx i 0 : 'cV[L]_m)^T *m w^T = 0.
    have : ((delta_mx i 0 : 'cV[L]_m)^T <= (inputs (graph_system L) (~: s))^T)%MS.
      rewrite eqmx_inputs trmxK; apply: (sumsmx_sup i); first by rewrite inE.
      by rewrite genmxE.
    by case/submxP=> D ->; rewrite -mulmxA zI mulmx0.
  by rewrite trmx_delta -rowE => /matrixP/(_ 0 0); rewrite !mxE.
move=> i j si Nj; have /outputs_eq0/(_ i si) := zO.
move/matrixP/(_ j 0); rewrite [RHS]mxE mxE.
rewrite (eq_bigr (fun k => (k == i)%:R * w^T k 0 - (k == j)%:R * w^T k 0)) => [|k _]; last first.
  by rewrite [in LHS]mxE Nj mulrBl.
have pick t : \sum_k (k == t)%:R * w^T k 0 = w^T t 0.
  rewrite (bigD1 t) //= eqxx mul1r big1 ?addr0 // => k /negPf ->; by rewrite mul0r.
by rewrite sumrB !pick => /eqP; rewrite subr_eq0 => /eqP.
Qed.

(* the scalars phi_ij: (sum b_i phi_ij c_ij, b_q) is controllable for every q *)
Theorem lemma_2_scalars : exists phi, forall i : 'I_m,
  controllable (closed_loop (graph_system K) phi) (delta_mx i 0 : 'cV_m).
Proof.
have sct : strongly_connected (transfer_arc (graph_system K)).
  apply/strongly_connectedP => s s0 sT.
  have /strongly_connectedP/(_ s s0 sT)[j [i [Nji sj si]]] := sc.
  exists j, i; split=> //; apply/transfer_arcP; exists 0%N; apply/eqP => /matrixP/(_ j 0).
  have Nji' : j \in N i := Nji.
  rewrite /krylov /= -colE !mxE Nji' eqxx => /eqP.
  have -> : (j == i) = false by apply: contraNF sj => /eqP ->.
  by rewrite sub0r oppr_eq0 oner_eq0.
have each (o : 'I_m) : exists phi, \rank (reach (closed_loop (graph_system K) phi)
    (delta_mx o 0 : 'cV_m) m) == m.
  apply: (@corfmat_morse_controllable _ _ f _ _ _ _ inf _ o sct) => lambda.
  pose S' : multichannel L m (fun=> 1%N) (fun=> m) := Multichannel 0 (fun i => delta_mx i 0)
    (fun i => if i == o then 1%:M else mcC (graph_system L) i).
  have [G [s e]] := rank_closed_loop_max S' lambda.
  have rk : (m <= \rank (pencil S' s lambda))%N.
    have [os|os] := boolP (o \in s).
      have sub : (1%:M <= outputs S' s)%MS.
        rewrite eqmx_outputs; apply: (sumsmx_sup o) => //; by rewrite genmxE /= eqxx.
      rewrite /pencil block_mxEv -addsmxE; apply: leq_trans (mxrankS (addsmxSr _ _)).
      by rewrite rank_row_mx0 -{1}(mxrank1 L m) mxrankS.
    have sT : s != setT by apply: contraNneq os => ->; rewrite inE.
    apply: leq_trans (graph_pencil lambda sT) _; rewrite leq_eqVlt; apply/orP; left; apply/eqP.
    rewrite /pencil; congr (\rank (block_mx _ _ _ _)); apply: eq_mxcol => i.
    by case: ifP => // si; rewrite /=; case: eqP => // e'; rewrite -e' si in os.
  have full : \rank (lambda%:M - closed_loop S' (natural L G)) = m.
    by apply/eqP; rewrite eqn_leq rank_leq_row e.
  have [eA [eB eC]] := map_graph_system.
  exists (fun i => if i == o then 0 else natural L G i).
  have e2 : closed_loop S' (natural L G) =
      closed_loop (map_system f (graph_system K)) (fun i => if i == o then 0 else natural L G i)
      + map_mx f (mcB (graph_system K) o) *m natural L G o.
    rewrite /closed_loop eA -addrA; congr (_ + _); rewrite (bigD1 o) //= eqxx mulmx1 addrC.
    rewrite [in RHS](bigD1 o) //= eqxx mulmx0 mul0mx add0r; congr (_ + _).
      apply: eq_bigr => i io; rewrite (negPf io).
      by congr (_ *m _ *m _); [exact: (esym (eB i)) | exact: (esym (eC i))].
    by congr (_ *m _); exact: (esym (eB o)).
  by rewrite -(own_feedback _ _ (natural L G o)) -e2 full_no_mode.
have [phi h] := @gains_common K _ _ _ _ inf (graph_system K) [eqType of 'I_m]
  (fun o X => \rank (reach X (delta_mx o 0 : 'cV_m) m) == m) (index_enum [finType of 'I_m])
  (fun o => @open_reach _ _ _ _ _) (fun o _ => each o).
by exists phi => o; apply: h; apply: mem_index_enum.
Qed.

End GraphScalars.

Section Kronecker.
Variables (K : fieldType) (n m : nat).
Notation nm := (\sum_(i < m) n)%N.
Notation unit_vector i := (delta_mx i 0 : 'cV[K]_m).

(* D (x) I *)
Definition kronecker1 (D : 'M[K]_m) : 'M[K]_nm := \mxblock_(i < m, j < m) ((D i j)%:M : 'M[K]_n).

Lemma block_of_error_input (i j : 'I_m) : block_of K n i *m error_input K n j = (i == j)%:R%:M.
Proof.
rewrite block_ofE; apply/matrixP => a b; rewrite !mxE -val_eqE /= tagnat.eq_Rank.
by case: (i == j) => /=; rewrite ?mul0rn.
Qed.

Lemma block_ofE_row (i : 'I_m) : block_of K n i = \mxrow_(j < m) (((i == j)%:R)%:M : 'M[K]_n).
Proof.
apply/mxrowP => j; rewrite mxrowK -block_of_error_input /error_input mul_submxrow mulmx1.
by [].
Qed.

Lemma krylov_kronecker1 (D : 'M[K]_m) i k : krylov (kronecker1 D) (error_input K n i) k =
  \mxcol_(j < m) ((krylov D (unit_vector i) k j 0)%:M : 'M[K]_n).
Proof.
elim: k => [|k IH].
  apply/mxcolP => j; rewrite mxcolK -block_ofE block_of_error_input !mxE andbT.
  by [].
rewrite !krylovS IH mul_mxblock_mxrow; apply: eq_mxcol => j.
rewrite [in RHS]mxE raddf_sum /=; apply: eq_bigr => t _.
by rewrite -scalar_mxM.
Qed.

Lemma rank_reach_kronecker1 (D : 'M[K]_m) i k : \rank (reach D (unit_vector i) k) = m ->
  \rank (reach (kronecker1 D) (error_input K n i) k) = nm.
Proof.
move/eqP/rank_reachP => h; apply/eqP/rank_reachP => w wz.
apply/mxrowP => j; rewrite submxrow0; apply/matrixP => r c; rewrite (ord1 r) [RHS]mxE.
pose u : 'rV[K]_m := \row_t submxrow w t 0 c.
suff u0 : u = 0 by have /matrixP/(_ 0 j) := u0; rewrite !mxE.
apply: h => t tk; have := wz t tk; rewrite krylov_kronecker1 -{1}[w]submxrowK mul_mxrow_mxcol.
move/matrixP/(_ 0 c) => e; apply/matrixP => r' c'; rewrite (ord1 r') (ord1 c') mxE [RHS]mxE.
rewrite [RHS]mxE in e; rewrite -[RHS]e summxE; apply: eq_bigr => s _.
by rewrite mul_mx_scalar [in LHS]mxE [in RHS]mxE mulrC.
Qed.

Lemma index_of_rank (A : 'M[K]_nm) (B : 'M[K]_(nm, n)) : (0 < n)%N ->
  \rank (reach A B m) = nm -> controllability_index A B m.
Proof.
move=> n0 r; split=> // j jm; apply: leq_ltn_trans (rank_leq_col _) _.
by rewrite !sum_nat_const !card_ord ltn_pmul2r.
Qed.

End Kronecker.

Section Propositions.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Hypothesis inf : infinite K.
Hypothesis hears : forall i, i \in N i.
Hypothesis sc : strongly_connected (neighbor_arc N).
Hypothesis n0 : (0 < n)%N.
Notation nm := (\sum_(i < m) n)%N.

Lemma differences_kronecker1 (phi : 'I_m -> 'rV[K]_m) :
  \sum_i error_input K n i *m (\mxrow_(j < m) ((phi i 0 j)%:M : 'M[K]_n)) *m differences K n N i =
  kronecker1 n (closed_loop (graph_system N K) phi).
Proof.
apply: blocks_eq => r; rewrite mulmx_sumr [LHS](bigD1 r) //= [X in _ + X]big1 => [|i ir]; last first.
  by rewrite !mulmxA block_of_error_input eq_sym (negPf ir) mulr0n raddf0 !mul0mx.
rewrite addr0 !mulmxA block_of_error_input eqxx mul1mx /differences mul_mxrow_mxcol.
rewrite block_ofE /kronecker1 mxblockEv mxcolK.
rewrite (eq_bigr (fun j => \mxrow_(k < m)
   ((if j \in N r then phi r 0 j * ((r == k)%:R - (j == k)%:R) else 0)%:M : 'M[K]_n))) => [|j _]; last first.
  case: ifP => _; last first.
    by rewrite mulmx0; apply/mxrowP => k; rewrite mxrowK submxrow0 raddf0.
  rewrite mulmxBr !block_ofE_row !mul_mxrow -mxrowB; apply: eq_mxrow => k.
  by rewrite -!scalar_mxM mulrBr raddfB.
rewrite -mxrow_sum; apply: eq_mxrow => k; rewrite -raddf_sum /=; congr (_%:M).
rewrite /closed_loop add0r summxE [RHS](bigD1 r) //= [X in _ = _ + X]big1 ?addr0 => [|i ir]; last first.
  by rewrite -mulmxA mxE big_ord1 !mxE eq_sym (negPf ir) mul0r.
rewrite -mulmxA mxE big_ord1 [delta_mx _ _ _ _]mxE !eqxx mul1r mxE; apply: eq_bigr => j _.
by rewrite mxE; case: ifP => _; rewrite ?mulr0 // (eq_sym r) (eq_sym j).
Qed.

(* Lemma 2 *)
Theorem lemma_2 : exists H : 'I_m -> 'M[K]_(n, nm), forall i : 'I_m,
  controllability_index (\sum_j error_input K n j *m H j *m differences K n N j) (error_input K n i) m.
Proof.
have [phi h] := lemma_2_scalars f inf sc; exists (fun i => \mxrow_(j < m) ((phi i 0 j)%:M : 'M[K]_n)) => i.
apply: index_of_rank => //; rewrite differences_kronecker1; apply: rank_reach_kronecker1.
exact/eqP/h.
Qed.

Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).
Notation E := (error_system N S F).

(* Lemma 4, the gain of agent i is [K_i H_i] *)
Theorem lemma_4 (KK : forall i, 'M[K]_(n, q i)) : exists H : 'I_m -> 'M[K]_(n, nm),
  forall i : 'I_m,
    controllability_index (closed_loop E (fun j => row_mx (KK j) (H j))) (error_input K n i) m.
Proof.
have [Hhat hH] := lemma_2.
pose D := \sum_j error_input K n j *m Hhat j *m differences K n N j.
pose M := error_A S F + \sum_j error_input K n j *m KK j *m (mcC S j *m block_of K n j).
have [i _|P P0 hP] := @lines_all K [eqType of 'I_m] (fun i h => h != 0 ->
    \rank (reach (M + h^-1 *: D) (error_input K n i) m) = nm) (index_enum [finType of 'I_m]).
  have [P P0 hP] := lemma_3_polynomial M (hH i).1.
  exists P => [|h Ph h0]; first exact: nonzero_at P0.
  by apply: hP; rewrite ?invr_eq0 ?invrK.
have [|h] := infinite_nonroot [rmorphism of idfun] inf (_ : P * 'X != 0).
  by rewrite mulf_neq0 // polyX_eq0.
rewrite hornerM hornerX mulf_eq0 negb_or /= => /andP[/hP rk h0].
exists (fun j => h^-1 *: Hhat j) => i; apply: index_of_rank => //.
have -> : closed_loop E (fun j => row_mx (KK j) (h^-1 *: Hhat j)) = M + h^-1 *: D; last first.
  by apply: rk; rewrite ?mem_index_enum.
rewrite /closed_loop /M /D -addrA scaler_sumr -big_split /=; congr (_ + _); apply: eq_bigr => j _.
rewrite mul_mx_row mul_row_col; congr (_ + _).
by rewrite -scalemxAr -scalemxAl.
Qed.

(* a gain that lets channels outside s control keeps the rank of P_s *)
Lemma rank_row_le_pencil (L' : fieldType) n' (p' q' : 'I_m -> nat) (T : multichannel L' n' p' q')
    (G : gains L' p' q') s lambda :
  (\rank (row_mx (lambda%:M - closed_loop T G) (inputs T (~: s))) <= \rank (pencil T s lambda))%N.
Proof.
have [Y eY] : exists Y, \sum_(i in s) mcB T i *m G i *m mcC T i = Y *m outputs T s.
  apply/submxP; apply: summx_sub => i si; rewrite eqmx_outputs.
  by apply: submx_trans (output_space_sup _ si); rewrite submxMl.
have [X eX] : exists X, \sum_(i in ~: s) mcB T i *m G i *m mcC T i = inputs T (~: s) *m X.
  have : ((\sum_(i in ~: s) mcB T i *m G i *m mcC T i)^T <= (inputs T (~: s))^T)%MS.
    rewrite linear_sum /=; apply: summx_sub => i si; rewrite -mulmxA trmx_mul eqmx_inputs trmxK.
    by apply: submx_trans (submxMl _ _) _; apply: (sumsmx_sup i) => //; rewrite genmxE.
  by case/submxP=> D /(congr1 trmx); rewrite trmxK trmx_mul trmxK => ->; exists D^T.
have -> : row_mx (lambda%:M - closed_loop T G) (inputs T (~: s)) =
    row_mx 1%:M (- Y) *m pencil T s lambda *m block_mx 1%:M 0 (- X) 1%:M.
  rewrite mul_row_block !mul1mx mulmx0 addr0 mul_row_block !mulmx1 mulmx0 add0r mulmxN mulNmx.
  rewrite -eX -eY; congr row_mx; rewrite /closed_loop [in LHS](bigID [pred i | i \in s]) /=.
  rewrite opprD addrA opprD !addrA; congr (_ - _); by apply: eq_bigl => i; rewrite inE.
exact: leq_trans (mxrankM_maxl _ _) (mxrankM_maxr _ _).
Qed.

Lemma strongly_connected_feedback_back n' (p' q' : 'I_m -> nat) (T : multichannel K n' p' q')
    (G : gains K p' q') : strongly_connected (transfer_arc (feedback T G)) ->
  strongly_connected (transfer_arc T).
Proof.
move/(strongly_connected_feedback (fun i => - G i)); rewrite /transfer_arc /= closed_loop_feedback.
have -> // : closed_loop T (fun i => G i + - G i) = mcA T.
by rewrite /closed_loop big1 ?addr0 // => i _; rewrite subrr mulmx0 mul0mx.
Qed.

(* Proposition 1 *)
Theorem proposition_1 : jointly_observable S -> exists KH : gains K (fun=> n) (fun i => q i + nm)%N,
  forall i : 'I_m, controllability_index (closed_loop E KH) (mcB E i) m /\
                   controllable (closed_loop E KH)^T (mcC E i)^T.
Proof.
move=> jo; have [H hH] := lemma_4 (fun i => 0); set G := fun j => row_mx _ (H j) in hH.
have ctr i : controllable (closed_loop E G) (mcB E i).
  by apply: (@controllable_blocks _ _ _ _ _ m); case: (hH i).
have nofix (lambda : L) : ~ fixed_over f E lambda.
  rewrite anderson_clements_over => -[s]; rewrite ltnNge => /negP; apply.
  have [->|sT] := eqVneq s setT.
    by rewrite jointly_observable_pencil //; apply: lemma_1_observable.
  have [i si] : exists i, i \notin s.
    by apply/existsP; rewrite -negb_forall; apply: contra sT => /forallP h; apply/eqP/setP => i; rewrite h inE.
  apply: leq_trans (rank_row_le_pencil (map_system f E) (fun i => map_mx f (G i)) s lambda).
  rewrite -closed_loop_map -{1}(controllable_hautus f lambda (ctr i)).
  rewrite -mxrank_tr -[X in (_ <= X)%N]mxrank_tr !tr_row_mx; apply: mxrankS.
  have sub : ((map_mx f (mcB E i))^T <= (inputs (map_system f E) (~: s))^T)%MS.
    by rewrite eqmx_inputs trmxK; apply: (sumsmx_sup i); rewrite ?inE // genmxE.
  rewrite -(addsmxE _ (map_mx f (mcB E i))^T) -(addsmxE _ (inputs _ _)^T).
  by rewrite addsmxS.
have sct : strongly_connected (transfer_arc E).
  apply: (strongly_connected_feedback_back (G := G)); apply/strongly_connectedP => s s0 sT.
  have /strongly_connectedP/(_ s s0 sT)[j [i [Nji sj si]]] := sc.
  exists j, i; split=> //; apply: contraT => na.
  have z t : mcC E i *m krylov (closed_loop E G) (mcB E j) t = 0.
    by apply/eqP; apply: contraNT na => h; apply/transfer_arcP; exists t.
  have C0 : mcC E i = 0.
    apply/row_matrixP => a; rewrite row0; move/controllableP: (ctr j); apply=> t.
    by rewrite -row_mul z row0.
  have : mcC E i *m error_input K n j = 0 by rewrite C0 mul0mx.
  rewrite /= mul_col_mx -[0]col_mx0 => /eq_col_mx[_ /differences_eq0/(_ j Nji)].
  rewrite !block_of_error_input eqxx => /matrixP/(_ (Ordinal n0) (Ordinal n0)).
  have -> : (i == j) = false by apply: contraNF sj => /eqP <-.
  by rewrite raddf0 !mxE eqxx => /esym/eqP; rewrite oner_eq0.
have [KH h] := corfmat_morse inf sct nofix.
pose P (ob : 'I_m * bool) (X : 'M[K]_nm) : Prop := if ob.2
  then \rank (reach X (mcB E ob.1) m) == nm else \rank (reach X^T (mcC E ob.1)^T nm) == nm.
have oP ob : open_on_lines (P ob).
  by case: ob => o [] /=; [apply: open_reach | apply: open_reach_tr].
have [ob _|KH' h'] := gains_common inf (S := E) (js := index_enum [finType of 'I_m * bool]) oP.
  case: ob => o []; rewrite /P /=; first by exists G; apply/eqP; case: (hH o).
  by exists KH; case: (h o).
exists KH' => o; split; last exact: (h' (o, false) (mem_index_enum _)).
by apply: index_of_rank => //; apply/eqP; exact: (h' (o, true) (mem_index_enum _)).
Qed.

End Propositions.
