(* The exact rank of the lifted system (emcsdd), at every lambda that is not 0: lambda I minus the
   shifts is invertible, and what is left is the extended system. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space anderson_clements.
From mcexact Require Import extended delayed_systems.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

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
