(* checker/core/evidence.py: shrunk subspaces and zero transfers, the evidence that several kinds share.

   A shrunk subspace (T, U, V) of deficiency d for p: modulo p, (xI - A) U = B_T V and C_i U = 0
   for i outside T; some rows of U are an identity modulo p; the columns of U number at least
   rank B_T + d (rank over the field of the data).  In place of B_T there may be any matrix Y whose image contains
   that of B_T, with the number of its columns for the rank: local_subspace.v needs this.  The rules are proved for a
   loss of rank, where Y is a matrix of polynomials, and contains the inputs modulo p: dual_subspace.v needs that. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Lemma rank_count (r u n b d : nat) : (r + u - n <= b -> b + d <= u -> r + d <= n)%N.
Proof.
rewrite leq_subLR => h1 h2; rewrite -(leq_add2r b) -addnA [(d + b)%N]addnC.
by apply: leq_trans h1; rewrite leq_add2l.
Qed.

Section Stacks.
Variables (R : comRingType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel R n p q) (T : {set 'I_m}).

Lemma inputsE S T u (X : forall i, 'M[R]_(p i, u)) :
  (forall i, i \notin T -> X i = 0) -> \sum_i mcB S i *m X i = inputs S T *m \mxcol_i X i.
Proof.
move=> X0; rewrite mul_mxrow_mxcol; apply: eq_bigr => i _.
by case: ifPn => // /X0->; rewrite !mulmx0.
Qed.

Lemma outputs_eq0 S T u (U : 'M[R]_(n, u)) :
  outputs S T *m U = 0 <-> (forall i, i \in T -> mcC S i *m U = 0).
Proof.
rewrite /outputs mxcol_mul; split=> [/mxcolP e i iT | e].
  by have := e i; rewrite mxcolK iT submxcol0.
apply/mxcolP => i; rewrite mxcolK submxcol0; case: ifPn => [/e //|_]; exact: mul0mx.
Qed.
End Stacks.

Section Map.
Variables (R R' : ringType) (f : {rmorphism R -> R'}) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel R n p q).

Lemma map_inputs S T : map_mx f (inputs S T) = inputs (map_system f S) T.
Proof.
apply/mxrowP=> i; rewrite mxrowK; have := mxrowK (fun i => if i \in T then mcB S i else 0) i.
rewrite /inputs; move: (mxrow _) => M; rewrite /submxrow => e.
by rewrite -map_mxsub e; case: ifP => //= _; rewrite map_mx0.
Qed.

Lemma map_outputs S T : map_mx f (outputs S T) = outputs (map_system f S) T.
Proof.
apply/mxcolP=> i; rewrite mxcolK; have := mxcolK (fun i => if i \in T then mcC S i else 0) i.
rewrite /outputs; move: (mxcol _) => M; rewrite /submxcol => e.
by rewrite -map_mxsub e; case: ifP => //= _; rewrite map_mx0.
Qed.

Lemma map_closed_loop S (F : gains R p q) :
  map_mx f (closed_loop S F) = closed_loop (map_system f S) (fun i => map_mx f (F i)).
Proof.
rewrite /closed_loop map_mxD (map_mx_sum f); congr (_ + _).
by apply: eq_bigr => i _; rewrite !map_mxM.
Qed.

Lemma map_pencil S s x : map_mx f (pencil S s x) = pencil (map_system f S) s (f x).
Proof.
by rewrite /pencil map_block_mx map_mxB map_scalar_mx map_inputs map_outputs map_mx0.
Qed.
End Map.

(* im Y contains im B_T if it contains im B_i for i in T. *)
Lemma inputs_within (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) (T : {set 'I_m}) r (Y : 'M[K]_(n, r)) :
  (exists X, inputs S T = Y *m X) <-> (forall i, i \in T -> exists X, mcB S i = Y *m X).
Proof.
split=> [[X e] i iT|each].
  by exists (submxrow X i); rewrite mul_submxrow -e mxrowK iT.
have each' i : exists X, (if i \in T then mcB S i else 0) = Y *m X.
  by case: ifP => [/each//|_]; exists 0; rewrite mulmx0.
have [X e] := fin_all_exists each'.
by exists (\mxrow_i X i); rewrite mul_mxrow; apply: eq_mxrow.
Qed.

Section Shrunk.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).
Variables (S : multichannel L n p q) (lambda : L) (T : {set 'I_m}).

(* At a point lambda of any field. *)
Definition shrunk u (U : 'M[L]_(n, u)) (V : 'M[L]_(\sum_i p i, u)) :=
  (lambda%:M - mcA S) *m U = inputs S T *m V /\ (forall i, i \notin T -> mcC S i *m U = 0).

(* The same with a matrix Y whose image contains that of B_T. *)
Definition shrunk_into r u (Y : 'M[L]_(n, r)) (U : 'M[L]_(n, u)) (V : 'M[L]_(r, u)) :=
  [/\ (lambda%:M - mcA S) *m U = Y *m V, forall i, i \notin T -> mcC S i *m U = 0 &
      exists X, inputs S T = Y *m X].

Lemma shrunk_base u (U : 'M[L]_(n, u)) (V : 'M[L]_(\sum_i p i, u)) : shrunk U V ->
  shrunk_into (col_base (inputs S T)) U (row_base (inputs S T) *m V).
Proof.
by case=> e z; split=> //; [rewrite mulmxA mulmx_base | exists (row_base (inputs S T)); rewrite mulmx_base].
Qed.

Section Into.
Variables (r u : nat) (Y : 'M[L]_(n, r)) (U : 'M[L]_(n, u)) (V : 'M[L]_(r, u)).
Hypotheses (sh : shrunk_into Y U V) (fU : \rank U = u).

Lemma shrunk_image (F : gains L p q) : exists W, (lambda%:M - closed_loop S F) *m U = Y *m W.
Proof.
have [e z [X eX]] := sh; exists (V - X *m \mxcol_i (F i *m mcC S i *m U)).
rewrite /closed_loop opprD addrA mulmxDl e mulmxBr; congr (_ + _).
rewrite mulNmx mulmx_suml mulmxA -eX; congr (- _).
rewrite -(@inputsE _ _ _ _ _ S T u (fun i => F i *m mcC S i *m U)).
  by apply: eq_bigr => i _; rewrite !mulmxA.
by move=> i /z e'; rewrite -mulmxA e' mulmx0.
Qed.

(* Rule "shrunk subspace": for every F, rank (lambda I - A_F) <= n - d. *)
Theorem shrunk_into_rank d (F : gains L p q) : (r + d <= u)%N ->
  (\rank (lambda%:M - closed_loop S F)%R + d <= n)%N.
Proof.
have := mxrank_mul_min (lambda%:M - closed_loop S F) U.
have [W ->] := shrunk_image F; rewrite fU => h1.
by apply: rank_count (leq_trans h1 (leq_trans (mxrankM_maxl _ _) (rank_leq_col _))).
Qed.

(* The pencil of the paper's subset s, the complement of T, loses rank as well. *)
Theorem shrunk_into_pencil_rank d : (r + d <= u)%N ->
  (\rank (pencil S (~: T) lambda) + d <= n)%N.
Proof.
have [e z [X eX]] := sh.
have z' : outputs S (~: T) *m U = 0 by apply/outputs_eq0 => i; rewrite inE => /z.
pose N := block_mx U 0 0 1%:M : 'M_(n + \sum_i p i, u + \sum_i p i).
have eN : pencil S (~: T) lambda *m N = block_mx Y 0 0 0 *m block_mx V X 0 (0 : 'M_(0, _)).
  by rewrite !mulmx_block setCK e z' eX !(mulmx0, mul0mx, addr0, add0r, mulmx1).
have := mxrank_mul_min (pencil S (~: T) lambda) N.
rewrite {1}rank_diag_block_mx fU mxrank1 addnA subnDr eN => h.
apply: rank_count (leq_trans h (leq_trans (mxrankM_maxl _ _) _)).
by rewrite rank_diag_block_mx mxrank0 addn0 rank_leq_col.
Qed.
End Into.

(* With Y a base of im B_T. *)
Variables (u : nat) (U : 'M[L]_(n, u)) (V : 'M[L]_(\sum_i p i, u)).
Hypotheses (sh : shrunk U V) (fU : \rank U = u).

Theorem shrunk_rank d (F : gains L p q) : (\rank (inputs S T) + d <= u)%N ->
  (\rank (lambda%:M - closed_loop S F)%R + d <= n)%N.
Proof. exact: (shrunk_into_rank (shrunk_base sh) fU F). Qed.

Theorem shrunk_pencil_rank d : (\rank (inputs S T) + d <= u)%N ->
  (\rank (pencil S (~: T) lambda) + d <= n)%N.
Proof. exact: (shrunk_into_pencil_rank (shrunk_base sh) fU). Qed.
End Shrunk.

Section Dynamic.
Variables (L : fieldType) (n m : nat) (p q k : 'I_m -> nat).
Variables (S : multichannel L n p q) (lambda : L) (T : {set 'I_m}).

(* The same evidence for every dynamic linear time-invariant channel controller.  U is enlarged by all
   states z_i, i in T; nothing is assumed of the K_i, so lambda may be a pole of the controller. *)
Theorem shrunk_into_dynamic_rank r u (Y : 'M[L]_(n, r)) (U : 'M[L]_(n, u)) V d (D : controllers L p q k) :
  shrunk_into S lambda T Y U V -> \rank U = u -> (r + d <= u)%N ->
  (\rank (lambda%:M - dynamic_loop S D)%R + d <= n + \sum_i k i)%N.
Proof.
move=> sh fU h; have [_ z [X eX]] := sh; have [W eW] := shrunk_image sh (ctF D).
pose Z : 'M[L]_(\sum_i k i) := \mxdiag_i (if i \in T then 1%:M else 0).
pose X12 : 'M[L]_(\sum_i p i, \sum_i k i) := \mxrow_j (submxrow 1%:M j *m ctG D j).
pose X' : 'M_(r + \sum_i k i, u + \sum_i k i) :=
  block_mx W (- (X *m X12)) (- \mxcol_i (ctL D i *m mcC S i *m U)) (lambda%:M - \mxdiag_i ctK D i).
have e : (lambda%:M - dynamic_loop S D) *m block_mx U 0 0 Z = block_mx Y 0 0 Z *m X'.
  rewrite /dynamic_loop scalar_mx_block opp_block_mx add_block_mx !mulmx_block.
  rewrite !mulmx0 !mul0mx !addr0 !add0r eW; congr block_mx.
  - rewrite mulNmx mulmxN mulmxA -eX; congr (- _); rewrite mul_mxrow_mxdiag mul_mxrow; apply: eq_mxrow => j.
    rewrite mulmxA mul_submxrow mulmx1 mxrowK.
    by case: ifP => _; rewrite ?mulmx1 ?mulmx0 ?mul0mx.
  - rewrite mulNmx mulmxN; congr (- _); rewrite mxcol_mul mul_mxdiag_mxcol; apply: eq_mxcol => j.
    by case: ifPn => [|/z zj]; rewrite ?mul1mx ?mul0mx// -mulmxA zj mulmx0.
  - rewrite mulmxBl mulmxBr scalar_mxC; congr (_ - _).
    rewrite /mxdiag !mul_mxblock_mxdiag; apply: eq_mxblock => i j.
    case: eqVneq => [{j}<-|_]; last by rewrite !mul0mx.
    by rewrite !conform_mx_id; case: ifP => _; rewrite ?mulmx1 ?mul1mx ?mulmx0 ?mul0mx.
have := mxrank_mul_min (lambda%:M - dynamic_loop S D) (block_mx U 0 0 Z).
rewrite e rank_diag_block_mx fU => h1.
apply: rank_count (leq_trans h1 (mxrankM_maxl _ _)) _.
by rewrite rank_diag_block_mx addnAC leq_add// (leq_trans _ h)// leq_add2r rank_leq_col.
Qed.

Theorem shrunk_dynamic_rank u (U : 'M[L]_(n, u)) V d (D : controllers L p q k) :
  shrunk S lambda T U V -> \rank U = u -> (\rank (inputs S T) + d <= u)%N ->
  (\rank (lambda%:M - dynamic_loop S D)%R + d <= n + \sum_i k i)%N.
Proof. by move=> /shrunk_base sh fU h; apply: (shrunk_into_dynamic_rank D sh fU h). Qed.
End Dynamic.

Section ModuloPolynomial.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (P : {poly K}).

(* "exactly, modulo p": every entry of the difference is a multiple of p. *)
Definition zero_modulo a b (M : 'M[{poly K}]_(a, b)) := forall i j, P %| M i j.

(* The value of a polynomial over K at a point of L. *)
Definition value (lambda : L) : {poly K} -> L := horner_eval lambda \o map_poly f.
Canonical value_additive lambda := [additive of value lambda].
Canonical value_rmorphism lambda := [rmorphism of value lambda].

Lemma value_poly lambda r : value lambda r = (map_poly f r).[lambda]. Proof. by []. Qed.
Lemma valueC lambda c : value lambda c%:P = f c.
Proof. by rewrite value_poly map_polyC hornerC. Qed.
Lemma valueX lambda : value lambda 'X = lambda.
Proof. by rewrite value_poly map_polyX hornerX. Qed.

Lemma value_const lambda a b (M : 'M[K]_(a, b)) :
  map_mx (value lambda) (map_mx polyC M) = map_mx f M.
Proof. by apply/matrixP=> i j; rewrite !mxE valueC. Qed.

Lemma value_zero lambda a b (M : 'M[{poly K}]_(a, b)) :
  root (map_poly f P) lambda -> zero_modulo M -> map_mx (value lambda) M = 0.
Proof.
move=> /rootP r0 z; apply/matrixP=> i j; rewrite !mxE value_poly.
by have /dvdpP[c ->] := z i j; rewrite rmorphM hornerM r0 mulr0.
Qed.

Lemma zero_modulo0 a b : zero_modulo (0 : 'M_(a, b)).
Proof. by move=> i j; rewrite mxE dvdp0. Qed.
Lemma zero_moduloD a b (M N : 'M_(a, b)) : zero_modulo M -> zero_modulo N -> zero_modulo (M + N).
Proof. by move=> zM zN i j; rewrite mxE dvdp_add. Qed.
Lemma zero_moduloN a b (M : 'M_(a, b)) : zero_modulo M -> zero_modulo (- M).
Proof. by move=> z i j; rewrite mxE dvdpNr. Qed.
Lemma zero_modulo_mull a b c (M : 'M_(a, b)) (N : 'M_(b, c)) : zero_modulo N -> zero_modulo (M *m N).
Proof.
move=> z i j; rewrite mxE; apply: (big_ind (fun r => P %| r)) => [|r r' Pr Pr'|k _]; first exact: dvdp0.
  exact: dvdp_add.
exact/dvdp_mull/z.
Qed.
Lemma zero_modulo_tr a b (M : 'M_(a, b)) : zero_modulo M -> zero_modulo M^T.
Proof. by move=> z i j; rewrite mxE. Qed.
Lemma zero_modulo_mulr a b c (M : 'M_(a, b)) (N : 'M_(b, c)) : zero_modulo M -> zero_modulo (M *m N).
Proof. by move=> z; rewrite -[M *m N]trmxK trmx_mul; apply/zero_modulo_tr/zero_modulo_mull/zero_modulo_tr. Qed.
End ModuloPolynomial.

Section Certificate.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).

(* The certificate: polynomial matrices U, V over K, the rows `pivots`, and Y, whose image contains that of B_T. *)
Record shrunk_subspace (P : {poly K}) (T : {set 'I_m}) (d : nat) := ShrunkSubspace {
  sh_r : nat;
  sh_u : nat;
  sh_Y : 'M[K]_(n, sh_r);
  sh_U : 'M[{poly K}]_(n, sh_u);
  sh_V : 'M[{poly K}]_(sh_r, sh_u);
  sh_pivots : 'I_sh_u -> 'I_n;
  sh_inputs : exists X, inputs S T = sh_Y *m X;
  sh_state : zero_modulo P (('X%:M - map_mx polyC (mcA S)) *m sh_U - map_mx polyC sh_Y *m sh_V);
  sh_output : forall i, i \notin T -> zero_modulo P (map_mx polyC (mcC S i) *m sh_U);
  sh_identity : zero_modulo P (rowsub sh_pivots sh_U - 1%:M);
  sh_count : (sh_r + d <= sh_u)%N }.

(* The same with a matrix Y of polynomials. *)
Record rank_loss (P : {poly K}) (T : {set 'I_m}) (d : nat) := RankLoss {
  rl_r : nat;
  rl_u : nat;
  rl_Y : 'M[{poly K}]_(n, rl_r);
  rl_U : 'M[{poly K}]_(n, rl_u);
  rl_V : 'M[{poly K}]_(rl_r, rl_u);
  rl_pivots : 'I_rl_u -> 'I_n;
  rl_inputs : forall i, i \in T -> exists X, zero_modulo P (map_mx polyC (mcB S i) - rl_Y *m X);
  rl_state : zero_modulo P (('X%:M - map_mx polyC (mcA S)) *m rl_U - rl_Y *m rl_V);
  rl_output : forall i, i \notin T -> zero_modulo P (map_mx polyC (mcC S i) *m rl_U);
  rl_identity : zero_modulo P (rowsub rl_pivots rl_U - 1%:M);
  rl_count : (rl_r + d <= rl_u)%N }.

Lemma shrunk_inputs P T d (E : shrunk_subspace P T d) i : i \in T ->
  exists X, zero_modulo P (map_mx polyC (mcB S i) - map_mx polyC (sh_Y E) *m X).
Proof.
move=> iT; have /inputs_within/(_ i iT)[X ->] := sh_inputs E.
by exists (map_mx polyC X); rewrite map_mxM subrr; apply: zero_modulo0.
Qed.
Coercion loss_of P T d (E : shrunk_subspace P T d) : rank_loss P T d :=
  RankLoss (@shrunk_inputs _ _ _ E) (@sh_state _ _ _ E) (@sh_output _ _ _ E) (@sh_identity _ _ _ E) (sh_count E).

Variables (P : {poly K}) (T : {set 'I_m}) (d : nat) (E : rank_loss P T d).
Variables (L : fieldType) (f : {rmorphism K -> L}) (lambda : L).
Hypothesis root_lambda : root (map_poly f P) lambda.

Let Y := map_mx (value f lambda) (rl_Y E).
Let U := map_mx (value f lambda) (rl_U E).
Let V := map_mx (value f lambda) (rl_V E).

Lemma certificate_inputs : exists X, inputs (map_system f S) T = Y *m X.
Proof.
apply/inputs_within => i /(@rl_inputs _ _ _ E)[X z]; exists (map_mx (value f lambda) X); apply/eqP.
have := value_zero root_lambda z; rewrite map_mxB map_mxM value_const => /eqP.
by rewrite subr_eq0.
Qed.

Lemma certificate_shrunk : shrunk_into (map_system f S) lambda T Y U V.
Proof.
split=> [|i iT|]; last exact: certificate_inputs.
  have := value_zero root_lambda (@rl_state _ _ _ E).
  rewrite map_mxB !map_mxM map_mxB map_scalar_mx /= valueX !value_const => /eqP.
  by rewrite subr_eq0 => /eqP.
by have := value_zero root_lambda (@rl_output _ _ _ E i iT); rewrite map_mxM value_const.
Qed.

Lemma certificate_free : \rank U = rl_u E.
Proof.
have := value_zero root_lambda (@rl_identity _ _ _ E); rewrite map_mxB map_mx1 => /eqP.
rewrite subr_eq0 => /eqP e; apply/eqP; rewrite eqn_leq rank_leq_col /=.
rewrite -[X in (X <= _)%N](mxrank1 L) -e map_mxsub mxrankS//; exact: rowsub_sub.
Qed.

(* Rule "shrunk subspace": static gains over every extension field L of the field of the data. *)
Theorem shrunk_subspace_rank (F : gains L p q) :
  (\rank (lambda%:M - closed_loop (map_system f S) F)%R + d <= n)%N.
Proof. exact: (shrunk_into_rank certificate_shrunk certificate_free F (rl_count E)). Qed.

(* The same rule for the paper's pencil, s the complement of T. *)
Theorem shrunk_subspace_pencil :
  (\rank (pencil (map_system f S) (~: T) lambda) + d <= n)%N.
Proof. exact: (shrunk_into_pencil_rank certificate_shrunk certificate_free (rl_count E)). Qed.

(* The same rule for dynamic channel controllers. *)
Theorem shrunk_subspace_dynamic k (D : controllers L p q k) :
  (\rank (lambda%:M - dynamic_loop (map_system f S) D)%R + d <= n + \sum_i k i)%N.
Proof. exact: (shrunk_into_dynamic_rank D certificate_shrunk certificate_free (rl_count E)). Qed.

Lemma eigenvalue_rank a (M : 'M[L]_a) : eigenvalue M lambda = (\rank (lambda%:M - M)%R < a)%N.
Proof.
rewrite /eigenvalue /eigenspace -mxrank_eq0 mxrank_ker subn_eq0 -ltnNge -opprB.
by rewrite mxrank_opp.
Qed.

(* Every root of p is fixed, and remains so under dynamic linear time-invariant channel controllers. *)
Theorem shrunk_subspace_fixed : (0 < d)%N -> fixed (map_system f S) lambda.
Proof.
move=> d0 F; rewrite eigenvalue_rank (leq_trans _ (shrunk_subspace_rank F))//.
by rewrite -[X in (X < _)%N]addn0 ltn_add2l.
Qed.

Theorem shrunk_subspace_fixed_dynamic k (D : controllers L p q k) : (0 < d)%N ->
  eigenvalue (dynamic_loop (map_system f S) D) lambda.
Proof.
move=> d0; rewrite eigenvalue_rank (leq_trans _ (shrunk_subspace_dynamic D))//.
by rewrite -[X in (X < _)%N]addn0 ltn_add2l.
Qed.
End Certificate.

Section Inputs.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).

(* With V for all inputs: Y is a base of im B_T. *)
Lemma shrunk_by_inputs P T d u (U : 'M[{poly K}]_(n, u)) (V : 'M[{poly K}]_(\sum_i p i, u)) (pivots : 'I_u -> 'I_n) :
  zero_modulo P (('X%:M - map_mx polyC (mcA S)) *m U - map_mx polyC (inputs S T) *m V) ->
  (forall i, i \notin T -> zero_modulo P (map_mx polyC (mcC S i) *m U)) ->
  zero_modulo P (rowsub pivots U - 1%:M) -> (\rank (inputs S T) + d <= u)%N -> shrunk_subspace S P T d.
Proof.
move=> state output identity count.
apply: (@ShrunkSubspace _ _ _ _ _ S P T d _ _ (col_base (inputs S T)) U (map_mx polyC (row_base (inputs S T)) *m V) pivots) => //.
  by exists (row_base (inputs S T)); rewrite mulmx_base.
by rewrite mulmxA -map_mxM mulmx_base.
Qed.
End Inputs.

(* The easy half of Anderson-Clements (Proposition 2): no gains exceed the rank of a pencil. *)
Section Easy.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).

Theorem loop_rank_pencil (S : multichannel L n p q) (s : {set 'I_m}) (lambda : L) (F : gains L p q) :
  (\rank (lambda%:M - closed_loop S F)%R <= \rank (pencil S s lambda))%N.
Proof.
pose X := row_mx 1%:M (- \mxrow_i (mcB S i *m F i)) : 'M_(n, n + \sum_i q i).
pose Y := col_mx 1%:M (- \mxcol_i (F i *m mcC S i)) : 'M_(n + \sum_i p i, n).
have -> : lambda%:M - closed_loop S F = X *m pencil S s lambda *m Y.
  rewrite mul_row_block mul_row_col !mul1mx !mulmx0 addr0 !mulmx1 mulNmx mulmxN.
  rewrite !mul_mxrow_mxcol -addrA -opprD -big_split /closed_loop opprD addrA; congr (_ - _).
  apply: eq_bigr => i _; rewrite inE; case: (i \in s) => /=.
    by rewrite mul0mx [RHS]addr0.
  by rewrite mulmx0 [RHS]add0r mulmxA.
by rewrite (leq_trans (mxrankM_maxl _ _))// mxrankM_maxr.
Qed.
End Easy.
