(* checker/constructions.py: plants with models of the signals that their outputs follow.

   Agent i has the states w_i, w_i' = K_i w_i + E_i S_i y_i, in discrete time w_i(t+1), and measures y_i and w_i.  With
   the companion matrix of f behind each row of S_i y_i, a root lambda of f is fixed iff the rank of
   [lambda I - A, B_T; C_s, 0; S_T C_T, 0] is below n plus the rows of S_T for some set T of channels, s the others; any
   other number is fixed iff it is fixed for the plant. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space anderson_clements extended feedthrough servo.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Kernel.
Variable L : fieldType.

(* rows that a map drops, and the combinations of others that it drops *)
Lemma rank_dropped a c t d (X : 'M[L]_(a, t)) (Y : 'M_(c, t)) (J : 'M_(t, d)) : X *m J = 0 ->
  \rank (col_mx X Y) = (\rank (Y *m J) + \rank (col_mx X (kermx (Y *m J) *m Y)))%N.
Proof.
move=> XJ; set M := col_mx X Y; have MJ : M *m J = col_mx 0 (Y *m J) by rewrite mul_col_mx XJ.
rewrite -(mxrank_mul_ker M J) MJ rank_col_0mx; congr addn; apply: eqmx_rank; apply/andP; split; last first.
  rewrite sub_capmx; apply/andP; split; last first.
    by rewrite sub_kermx mul_col_mx XJ -mulmxA mulmx_ker col_mx0.
  rewrite col_mx_sub; have [sX sY] := col_sub X Y; rewrite sX /=; exact: submx_trans (submxMl _ _) sY.
apply/row_subP => i; set v := row i _; have /andP[/submxP[x ev] /sub_kermxP vJ] : (v <= M)%MS && (v <= kermx J)%MS.
  by rewrite -sub_capmx row_sub.
move: vJ; rewrite ev -mulmxA MJ -[x]hsubmxK mul_row_col mulmx0 add0r => /sub_kermxP/submxP[y ey].
rewrite mul_row_col ey; apply/submxP; exists (row_mx (lsubmx x) y).
by rewrite mul_row_col !mulmxA.
Qed.

Lemma rank_back a t d (X : 'M[L]_(a, t)) (J : 'M_(t, d)) (J' : 'M_(d, t)) :
  X *m J *m J' = X -> \rank (X *m J) = \rank X.
Proof. by move=> e; apply/eqP; rewrite eqn_leq mxrankM_maxl -{1}e mxrankM_maxl. Qed.

Lemma diag_mul m (k : 'I_m -> nat) (U V : forall i, 'M[L]_(k i)) :
  \mxdiag_i U i *m \mxdiag_i V i = \mxdiag_i (U i *m V i).
Proof.
rewrite -[RHS]mulmx1 -[X in _ = _ *m X](submxcolK 1%:M) -[X in _ *m X]mulmx1 -[X in _ *m (_ *m X)](submxcolK 1%:M).
by rewrite !mul_mxdiag_mxcol; apply: eq_mxcol => i; rewrite mulmxA.
Qed.
End Kernel.

Section Models.
Variable L : fieldType.

(* w' = K w + E e, whose solutions for e = 0 contain a mode lambda for every entry of e. *)
Definition models (lambda : L) h k (K : 'M[L]_h) (E : 'M_(h, k)) :=
  exists N : 'M_(k, h), [/\ N *m (lambda%:M - K) = 0, N *m E = 1%:M &
    forall v : 'rV_h, v *m (lambda%:M - K) = 0 -> v = v *m E *m N].

Lemma models_kernel lambda h k (K : 'M[L]_h) (E : 'M_(h, k)) : models lambda K E ->
  (kermx (lambda%:M - K) *m E :=: (1%:M : 'M_k))%MS /\ (\rank (lambda%:M - K)%R + k = h)%N.
Proof.
case=> N [NK NE all]; set Z := lambda%:M - K in NK all *.
have kN : (kermx Z :=: N)%MS.
  apply/eqmxP/andP; split; last by apply/sub_kermxP.
  apply/row_subP => i; have /sub_kermxP/all -> : (row i (kermx Z) <= kermx Z)%MS by rewrite row_sub.
  exact: submxMl.
split; first by apply: eqmx_trans (eqmxMr E kN) _; rewrite NE.
have rN : \rank N = k by apply/eqP; apply/row_freeP; exists E.
have := mxrank_ker Z; rewrite (eqmx_rank (introT eqmxP kN)) rN => ->; exact: subnKC (rank_leq_row _).
Qed.

Lemma models_empty lambda : models lambda (0 : 'M[L]_0) (0 : 'M_(0, 0)).
Proof. by exists 0; split => [||v _]; rewrite ?mul0mx ?thinmx0 //; apply/matrixP => i []. Qed.

Lemma models_sum lambda h k h' k' (K : 'M[L]_h) (E : 'M_(h, k)) (K' : 'M_h') (E' : 'M_(h', k')) :
  models lambda K E -> models lambda K' E' ->
  models lambda (block_mx K 0 0 K') (block_mx E 0 0 E').
Proof.
case=> N [NK NE all] [N' [NK' NE' all']]; exists (block_mx N 0 0 N').
rewrite scalar_mx_block opp_block_mx add_block_mx !(oppr0, addr0).
split=> [||v].
- by rewrite mulmx_block !(mul0mx, mulmx0, addr0, add0r) NK NK' block_mx0.
- by rewrite mulmx_block !(mul0mx, mulmx0, addr0, add0r) NE NE' -scalar_mx_block.
rewrite -[v]hsubmxK (mul_row_block _ _ (lambda%:M - K)) (mul_row_block _ _ E) !(mulmx0, addr0, add0r).
rewrite (mul_row_block _ _ N) !(mulmx0, addr0, add0r) -(row_mx0 _ 1 h h').
by move=> /eq_row_mx[/all e /all' e']; rewrite -e -e'.
Qed.

(* The model of the solutions of f: the companion matrix with ones above the diagonal, behind its last state. *)
Section Companion.
Variable f : {poly L}.
Notation d := (size f).-1.

Definition last_state : 'M[L]_(d, 1) := \matrix_(i, j) (i == d.-1 :> nat)%:R.

Lemma models_companion lambda : f \is monic -> root f lambda -> models lambda (companionmx f) last_state.
Proof.
move=> mf rf; set Z := lambda%:M - companionmx f.
have f0 : f != 0 by apply: monic_neq0.
have d0 : (0 < d)%N.
  have := root_size_gt1 f0 rf; by case: (size f) => [|[|]].
have lastE (v : 'rV[L]_d) (j : 'I_d) : j = d.-1 :> nat -> (v *m last_state) 0 0 = v 0 j.
  move=> ej; rewrite mxE (bigD1 j) //= mxE ej eqxx mulr1 big1 ?addr0 // => i ij.
  rewrite mxE; have /negPf -> : (i != d.-1 :> nat) by rewrite -ej. by rewrite mulr0.
have zero (v : 'rV[L]_d) : v *m Z = 0 -> v *m last_state = 0 -> v = 0.
  move=> vZ vl; suff h t : forall j : 'I_d, (j + t)%N = d.-1 -> v 0 j = 0.
    apply/rowP => j; rewrite [RHS]mxE; apply: (h (d.-1 - j)%N); rewrite subnKC //.
    by rewrite -ltnS prednK.
  elim: t => [|t IH] j ej.
    by rewrite addn0 in ej; rewrite -lastE // vl mxE.
  have lj : (j.+1 < d)%N.
    by apply: (@leq_ltn_trans d.-1); rewrite ?ltn_predL // -ej addnS ltnS leq_addr.
  pose next := Ordinal lj.
  have nz : v 0 next = 0 by apply: IH; rewrite /= addSn -addnS.
  have := congr1 (fun M : 'M[L]__ => M 0 next) vZ; rewrite mulmxBr mul_mx_scalar !mxE nz mulr0 add0r => /eqP.
  rewrite oppr_eq0 (bigD1 j) //= mxE; have /negPf -> : j != d.-1 :> nat.
    by rewrite -ej -[X in X != _]addn0 eqn_add2l.
  rewrite eqxx mulr1 big1 ?addr0 => [/eqP //|i ij]; rewrite mxE.
  case: ifP => [/eqP ei|_]; last by rewrite eqSS; rewrite -val_eqE in ij; rewrite (negPf ij) mulr0.
  by rewrite -lastE // vl mxE mul0r.
have /eigenvalueP[u /eqP] : eigenvalue (companionmx f) lambda.
  by rewrite eigenvalue_root_char companionmxK.
rewrite -subr_eq0 -mul_mx_scalar -mulmxBr -oppr_eq0 -mulmxN opprB => /eqP uZ u0.
have ul : (u *m last_state) 0 0 != 0.
  apply: contraNneq u0 => h; apply/eqP; apply: zero => //.
  by apply/matrixP => i j; rewrite !ord1 h mxE.
set c := (u *m last_state) 0 0 in ul.
have NE : (c^-1 *: u) *m last_state = 1%:M.
  by rewrite -scalemxAl [X in _ *: X]mx11_scalar scale_scalar_mx mulVf.
have NZ : (c^-1 *: u) *m Z = 0 by rewrite -scalemxAl uZ scaler0.
exists (c^-1 *: u); split => // v vZ; apply/eqP; rewrite -subr_eq0; apply/eqP; apply: zero.
  by rewrite mulmxBl vZ -mulmxA NZ mulmx0 subr0.
by rewrite mulmxBl -[X in _ - X]mulmxA NE mulmx1 subrr.
Qed.
End Companion.

(* One model behind each of k rows. *)
Section Copies.
Variables (h : nat) (K : 'M[L]_h) (E : 'M[L]_(h, 1)).

Fixpoint size_of k := if k is k'.+1 then (h + size_of k')%N else 0%N.
Fixpoint copies k : 'M[L]_(size_of k) := if k is k'.+1 then block_mx K 0 0 (copies k') else 0.
Fixpoint ends k : 'M[L]_(size_of k, k) :=
  if k is k'.+1 then block_mx E 0 0 (ends k') : 'M_(h + size_of k', 1 + k') else 0.

Lemma size_ofE k : size_of k = (k * h)%N.
Proof. by elim: k => // k IH; rewrite /= IH mulSn. Qed.

Lemma models_copies lambda k : models lambda K E -> models lambda (copies k) (ends k).
Proof. by move=> one; elim: k => [|k IH]; [exact: models_empty | exact: (models_sum one IH)]. Qed.
End Copies.
End Models.

(* Construction `internal_model`: agent i has the states w_i, w_i' = K_i w_i + E_i S_i y_i, and measures y_i and w_i. *)
Section Modeled.
Variables (L : fieldType) (n m : nat) (p q k h : 'I_m -> nat) (X : multichannel L n p q).
Variables (S : forall i, 'M[L]_(k i, q i)) (K : forall i, 'M[L]_(h i)) (E : forall i, 'M[L]_(h i, k i)).
Notation sum_h := (\sum_i h i)%N.
Implicit Types (s : {set 'I_m}) (lambda : L).

Definition driven : 'M[L]_(sum_h, n) := \mxcol_i (E i *m (S i *m mcC X i)).

Definition modeled : multichannel L (n + sum_h) p (fun i => q i + h i)%N :=
  Multichannel (block_mx (mcA X) 0 driven (\mxdiag_i K i)) (fun i => col_mx (mcB X i) 0)
    (fun i => block_mx (mcC X i) 0 0 (shared_input L h i)^T).

(* [lambda I - A, B_T; C_s, 0; S_T C_T, 0], T the channels that are not in s: all rows of C, if S_i = I *)
Definition followed_pencil s lambda : 'M[L]_((n + \sum_i q i) + \sum_i k i, n + \sum_i p i) :=
  col_mx (pencil X s lambda) (row_mx (outputs (regulated X S) (~: s)) 0).

Lemma modeled_inputs T : inputs modeled T = col_mx (inputs X T) 0.
Proof.
have e a (M : 'M[L]_(n, a)) : col_mx M (0 : 'M_(sum_h, a)) = col_mx 1%:M 0 *m M.
  by rewrite mul_col_mx mul1mx mul0mx.
rewrite e /inputs mul_mxrow; apply: eq_mxrow => i; case: ifP => _; last by rewrite mulmx0.
by rewrite -e.
Qed.

Lemma modeled_outputs s : (outputs modeled s :=: block_mx (outputs X s) 0 0 (select L h s))%MS.
Proof.
apply: eqmx_trans (eqmx_outputs _ _) _; apply: eqmx_trans (span_block _ _ _) _.
apply/eqmxP/andP; split; apply: block_sub; rewrite ?span_shared ?(eqmx_outputs X s) //.
Qed.

Section At.
Variables (s : {set 'I_m}) (lambda : L).
Notation T := (~: s).
Let Z : 'M[L]_sum_h := lambda%:M - \mxdiag_i K i.
Let P : 'M[L]_(n + \sum_i q i, n + \sum_i p i) := pencil X s lambda.
Let G : 'M[L]_(sum_h, n + \sum_i p i) := row_mx (- driven) 0.
Notation sel U := (select L h U).

Lemma Zdiag : Z = \mxdiag_i (lambda%:M - K i).
Proof. by rewrite /Z -mxdiagZ -mxdiagB. Qed.

Lemma selZ U : sel U *m Z = \mxdiag_i (if i \in U then lambda%:M - K i else 0).
Proof. by rewrite Zdiag diag_mul; apply: eq_mxdiag => i; case: ifP => _; rewrite ?mul1mx ?mul0mx. Qed.

Lemma Zsel U : Z *m sel U = sel U *m Z.
Proof. by rewrite selZ Zdiag diag_mul; apply: eq_mxdiag => i; case: ifP => _; rewrite ?mulmx1 ?mulmx0. Qed.

Lemma sel_driven U : sel U *m driven = \mxcol_i (if i \in U then E i *m (S i *m mcC X i) else 0).
Proof. by rewrite mul_mxdiag_mxcol; apply: eq_mxcol => i; case: ifP => _; rewrite ?mul1mx ?mul0mx. Qed.

Lemma driven_outputs U : (sel U *m driven <= outputs X U)%MS.
Proof.
rewrite sel_driven (eqmx_outputs X U).
rewrite (mxcol_space (fun i => E i *m (S i *m mcC X i))); apply/span_sub => i Ui.
by rewrite mulmxA; apply: submx_trans (submxMl _ _) _; apply: sub_span.
Qed.

Lemma rank_selZ : \rank (sel T *m Z) = (\sum_(i in T) \rank (lambda%:M - K i)%R)%N.
Proof.
rewrite selZ rank_mxdiag [RHS]big_mkcond; apply: eq_bigr => i _.
by case: ifP; rewrite ?mxrank0.
Qed.

Lemma kernel_selZ : (kermx (sel T *m Z) *m sel T :=:
  sel T *m \mxdiag_i kermx (lambda%:M - K i))%MS.
Proof.
set D := \mxdiag_i _; have DT : sel T *m D = D *m sel T.
  by rewrite !diag_mul; apply: eq_mxdiag => i; case: ifP => _; rewrite ?mulmx1 ?mul1mx ?mulmx0 ?mul0mx.
have TT : sel T *m sel T = sel T by rewrite select_mul setIid.
have DZ : D *m Z = 0.
  by rewrite Zdiag diag_mul -[RHS]mxdiag0; apply: eq_mxdiag => i; rewrite mulmx_ker.
apply/eqmxP/andP; split; last first.
  rewrite -{1}TT -mulmxA DT mulmxA; apply: submxMr; apply/sub_kermxP.
  by rewrite mulmxA -(mulmxA (sel T)) -DT mulmxA TT -mulmxA DZ mulmx0.
suff kept (v : 'rV_sum_h) : v *m Z = 0 -> (v *m sel T <= sel T *m D)%MS.
  apply/row_subP => i; rewrite row_mul; set u := row i _.
  have -> : u *m sel T = u *m sel T *m sel T by rewrite -mulmxA TT.
  by apply: kept; rewrite -mulmxA /u -row_mul mulmx_ker row0.
move=> vZ; rewrite DT; apply: submxMr; rewrite -(submxrowK v) Zdiag mul_mxrow_mxdiag in vZ.
have z i : submxrow v i *m (lambda%:M - K i) = 0.
  by have := congr1 (fun M => submxrow M i) vZ; rewrite mxrowK submxrow0.
have s' i : (submxrow v i <= kermx (lambda%:M - K i))%MS by apply/sub_kermxP.
rewrite -(submxrowK v); apply/submxP; exists (\mxrow_i (submxrow v i *m pinvmx (kermx (lambda%:M - K i)))).
by rewrite mul_mxrow_mxdiag; apply: eq_mxrow => i; rewrite mulmxKpV.
Qed.

Definition seen : 'M[L]_(sum_h, n) :=
  \mxcol_i (if i \in T then kermx (lambda%:M - K i) *m E i *m (S i *m mcC X i) else 0).

Lemma rank_modeled : \rank (pencil modeled s lambda) =
  (\sum_(i in s) h i + (\sum_(i in T) \rank (lambda%:M - K i)%R + \rank (col_mx P (row_mx seen 0))))%N.
Proof.
rewrite /pencil modeled_inputs (rank_block_eq _ (eqmx_refl _) (modeled_outputs s)) /=.
rewrite scalar_mx_block opp_block_mx add_block_mx oppr0 !add0r -/Z.
set B := inputs X T; set C := outputs X s.
pose X1 := row_mx (row_mx (lambda%:M - mcA X) (0 : 'M_(n, sum_h))) B.
pose X2 := row_mx (row_mx C (0 : 'M_(_, sum_h))) (0 : 'M_(_, \sum_i p i)).
pose W := row_mx (row_mx (- driven) Z) (0 : 'M_(sum_h, \sum_i p i)).
pose V := row_mx (row_mx (0 : 'M_(sum_h, n)) (sel s)) (0 : 'M_(_, \sum_i p i)).
pose R := col_mx X1 X2.
have TT : sel T *m sel T = sel T by rewrite select_mul setIid.
have sT : sel s *m sel T = 0.
  by rewrite select_mul setICr -[RHS]mxdiag0; apply: eq_mxdiag => i; rewrite inE.
have one : sel s + sel T = 1%:M by apply: selectC.
have -> : \rank (block_mx (block_mx (lambda%:M - mcA X) 0 (- driven) Z) (col_mx B 0) (block_mx C 0 0 (sel s)) 0) =
    \rank (col_mx (col_mx R (sel T *m W)) V).
  apply: eqmx_rank; rewrite block_mxEv.
  have -> : row_mx (block_mx (lambda%:M - mcA X) 0 (- driven) Z) (col_mx B 0) = col_mx X1 W.
    by rewrite block_mxEv -block_mxEh block_mxEv.
  have -> : row_mx (block_mx C 0 0 (sel s)) (0 : 'M_(_, \sum_i p i)) = col_mx X2 V.
    have z : (0 : 'M[L]_(\sum_i q i + sum_h, \sum_i p i)) = col_mx 0 0 by rewrite col_mx0.
    by rewrite z block_mxEv -block_mxEh block_mxEv.
  have [s1 s2] := col_sub (col_mx X1 W) (col_mx X2 V); have [s3 s4] := col_sub X1 W; have [s5 s6] := col_sub X2 V.
  have [t1 t2] := col_sub (col_mx R (sel T *m W)) V; have [t3 t4] := col_sub R (sel T *m W).
  have [t5 t6] := col_sub X1 X2.
  have eW : sel s *m W = row_mx (row_mx (- (sel s *m driven)) 0) 0 + Z *m V.
    rewrite /W /V !mul_mx_row !mulmx0 Zsel add_row_mx addr0; congr row_mx.
    by rewrite mulmxN add_row_mx addr0 add0r.
  have sW : (sel s *m W <= col_mx (col_mx R (sel T *m W)) V)%MS.
    rewrite eW addmx_sub ?(submx_trans (submxMl _ _) t2) //.
    have /submxP[Y ->] := driven_outputs s.
    have -> : row_mx (row_mx (- (Y *m C)) 0) 0 = (- Y) *m X2 by rewrite !mul_mx_row !mulmx0 mulNmx.
    exact: submx_trans (submxMl _ _) (submx_trans t6 (submx_trans t3 t1)).
  have hW : (W <= col_mx (col_mx R (sel T *m W)) V)%MS.
    rewrite -{1}[W]mul1mx -one mulmxDl addmx_sub //; exact: submx_trans t4 t1.
  rewrite !col_mx_sub (submx_trans s3 s1) (submx_trans s5 s2) (submx_trans s6 s2) hW t2 /=.
  rewrite (submx_trans (submxMl _ _) (submx_trans s4 s1)) /=.
  by rewrite (submx_trans t5 (submx_trans t3 t1)) (submx_trans t6 (submx_trans t3 t1)).
rewrite (@rank_apart _ _ _ _ _ _ (block_mx (block_mx 1%:M 0 0 (sel T)) 0 0 1%:M)); last 2 first.
- rewrite /R /W !mul_col_mx !mul_mx_row !mul_row_block !(mulmx0, mulmx1, mul0mx, addr0, add0r).
  by rewrite -mulmxA Zsel mulmxA TT.
- by rewrite /V !mul_row_block !(mulmx0, mulmx1, mul0mx, addr0, add0r) sT !row_mx0.
have -> : \rank V = (\sum_(i in s) h i)%N by rewrite /V rank_row_mx0 rank_row_0mx rank_select.
rewrite addnC; congr addn.
pose J : 'M[L]_((n + sum_h) + \sum_i p i, sum_h) := col_mx (col_mx 0 1%:M) 0.
have RJ : R *m J = 0.
  by rewrite /R mul_col_mx !mul_row_col !(mulmx0, mul0mx, addr0, add0r) col_mx0.
have WJ : sel T *m W *m J = sel T *m Z.
  by rewrite -mulmxA /W !mul_row_col !(mulmx0, mulmx1, addr0, add0r).
rewrite (rank_dropped _ RJ) WJ rank_selZ; congr addn.
pose I : 'M[L]_((n + sum_h) + \sum_i p i, n + \sum_i p i) := block_mx (col_mx 1%:M 0) 0 0 1%:M.
pose I' : 'M[L]_(n + \sum_i p i, (n + sum_h) + \sum_i p i) := block_mx (row_mx 1%:M 0) 0 0 1%:M.
set F := kermx _ *m _.
have eF : F = row_mx (row_mx (- (kermx (sel T *m Z) *m sel T *m driven)) 0) 0.
  rewrite /F mulmxA /W !mul_mx_row mulmx0; congr (row_mx (row_mx _ _) _); first by rewrite mulmxN.
  by rewrite -mulmxA mulmx_ker.
have <- : \rank (col_mx R F *m I) = \rank (col_mx R F).
  apply: (rank_back (J' := I')); rewrite eF /R !mul_col_mx !mul_row_block !mul_row_col !mul_mx_row.
  by rewrite !(mulmx0, mulmx1, mul0mx, addr0, add0r).
have -> : col_mx R F *m I = col_mx P (row_mx (- (kermx (sel T *m Z) *m sel T *m driven)) 0).
  rewrite eF /R !mul_col_mx !mul_row_block !mul_row_col !(mulmx0, mulmx1, mul0mx, addr0, add0r).
  by rewrite /P /pencil block_mxEv.
have eS : (- (kermx (sel T *m Z) *m sel T *m driven) :=: seen)%MS.
  apply: eqmx_trans (eqmx_opp _) _; apply: eqmx_trans (eqmxMr driven kernel_selZ) _.
  have -> : sel T *m \mxdiag_i kermx (lambda%:M - K i) *m driven = seen; last exact: eqmx_refl.
  rewrite diag_mul mul_mxdiag_mxcol; apply: eq_mxcol => i.
  by case: ifP => _; rewrite ?mul1mx ?mul0mx ?mulmxA.
have e a (Y : 'M[L]_(a, n)) : row_mx Y (0 : 'M_(a, \sum_i p i)) = Y *m row_mx 1%:M 0.
  by rewrite mul_mx_row mulmx1 mulmx0.
rewrite -!addsmxE (e _ (- _)) (e _ seen); exact: eqmx_rank (introT eqmxP (adds_eqmx (eqmx_refl P) (eqmxMr _ eS))).
Qed.

(* A mode that no model contains: the rank is that of the plant. *)
Theorem rank_elsewhere : (forall i, row_free (lambda%:M - K i)) ->
  \rank (pencil modeled s lambda) = (\rank P + \sum_i h i)%N.
Proof.
move=> free; rewrite rank_modeled.
have -> : seen = 0.
  rewrite /seen -[RHS]mxcol0; apply: eq_mxcol => i; case: ifP => // _.
  by have := free i; rewrite -kermx_eq0 => /eqP ->; rewrite !mul0mx.
have -> : \rank (col_mx P (row_mx 0 (0 : 'M_(sum_h, _)))) = \rank P.
  by rewrite row_mx0 -addsmxE; apply: eqmx_rank (introT eqmxP (addsmx0 _ _)).
rewrite addnA addnC; congr addn; rewrite [RHS](bigID [pred i | i \in s]) /=; congr addn.
by apply: eq_big => i; rewrite ?inE // => _; apply/eqP; apply: free.
Qed.

(* A mode of all models: the rank of the plant's pencil with the rows that are followed. *)
Theorem rank_at_root : (forall i, models lambda (K i) (E i)) ->
  (\rank (pencil modeled s lambda) + \sum_(i in T) k i =
   \rank (followed_pencil s lambda) + \sum_i h i)%N.
Proof.
move=> all; rewrite rank_modeled.
have -> : \rank (col_mx P (row_mx seen 0)) = \rank (followed_pencil s lambda).
  have eS : (seen :=: outputs (regulated X S) T)%MS.
    apply: eqmx_trans (mxcol_space _ _) _; apply: eqmx_sym; apply: eqmx_trans (mxcol_space _ _) _.
    apply: span_eqmx => i _; have [kE _] := models_kernel (all i).
    by apply: eqmx_sym; apply: eqmx_trans (eqmxMr _ kE) _; rewrite mul1mx; apply: eqmx_refl.
  have e a (Y : 'M[L]_(a, n)) : row_mx Y (0 : 'M_(a, \sum_i p i)) = Y *m row_mx 1%:M 0.
    by rewrite mul_mx_row mulmx1 mulmx0.
  rewrite /followed_pencil -!addsmxE (e _ seen) (e _ (outputs _ _)).
  exact: eqmx_rank (introT eqmxP (adds_eqmx (eqmx_refl P) (eqmxMr _ eS))).
rewrite [RHS]addnC addnA -addnA [(_ + \sum_(i in T) k i)%N]addnC !addnA; congr addn.
rewrite -addnA -big_split /= [RHS](bigID [pred i | i \in s]) /=; congr addn.
apply: eq_big => i; rewrite ?inE // => _.
by have [_ e] := models_kernel (all i); rewrite ?[(k i + _)%N]addnC e.
Qed.
End At.

(* A mode of all models is fixed iff, for some set of channels, the rank is below n plus the rows that are followed. *)
Theorem root_fixed lambda : (forall i, models lambda (K i) (E i)) ->
  fixed modeled lambda <->
  exists s, (\rank (followed_pencil s lambda) < n + \sum_(i in ~: s) k i)%N.
Proof.
move=> all; have e s : (\rank (pencil modeled s lambda) < n + \sum_i h i)%N =
    (\rank (followed_pencil s lambda) < n + \sum_(i in ~: s) k i)%N.
  rewrite -(ltn_add2r (\sum_(i in ~: s) k i)) rank_at_root //.
  by rewrite (addnAC n (\sum_i h i)%N) ltn_add2r.
split=> [/anderson_clements[s h']|[s h']]; first by exists s; rewrite -e.
by apply/anderson_clements; exists s; rewrite e.
Qed.

(* A mode of no model is fixed iff it is a fixed mode of the plant. *)
Theorem elsewhere_fixed lambda : (forall i, row_free (lambda%:M - K i)) ->
  fixed modeled lambda <-> fixed X lambda.
Proof.
move=> free; split=> /anderson_clements[s h']; apply/anderson_clements; exists s; move: h';
  by rewrite rank_elsewhere // ltn_add2r.
Qed.
End Modeled.

(* With a model of the solutions of f behind each followed row; the states of an agent are those of one row after
   those of another, in another order than in the checker, which changes no fixed mode. *)
Section Signals.
Variables (L : fieldType) (n m : nat) (p q k : 'I_m -> nat) (X : multichannel L n p q).
Variables (S : forall i, 'M[L]_(k i, q i)) (f : {poly L}).
Hypothesis monic_f : f \is monic.

Definition internal_model :=
  modeled X S (fun i => copies (companionmx f) (k i)) (fun i => ends (last_state f) (k i)).

Theorem signal_fixed lambda : root f lambda ->
  fixed internal_model lambda <->
  exists s, (\rank (followed_pencil X S s lambda) < n + \sum_(i in ~: s) k i)%N.
Proof. by move=> rf; apply: root_fixed => i; apply: models_copies; apply: models_companion. Qed.

Lemma copies_free lambda j : ~~ root f lambda -> row_free (lambda%:M - copies (companionmx f) j).
Proof.
move=> rf; elim: j => [|j IH] /=; first by rewrite -row_leq_rank.
rewrite scalar_mx_block opp_block_mx add_block_mx !(oppr0, addr0) row_free_unit unitmxE det_ublock unitrM.
rewrite -!unitmxE -!row_free_unit IH andbT -kermx_eq0 -[X in kermx X]opprB.
have := rf; rewrite -[f in root f _](companionmxK monic_f) -eigenvalue_root_char /eigenvalue negbK /eigenspace.
by rewrite -!mxrank_eq0 !mxrank_ker mxrank_opp.
Qed.

Theorem other_fixed lambda : ~~ root f lambda -> fixed internal_model lambda <-> fixed X lambda.
Proof. by move=> rf; apply: elsewhere_fixed => i; apply: copies_free. Qed.
End Signals.
