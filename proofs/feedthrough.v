(* A plant with feedthrough, y = C x + D u, and the system with its inputs as states: u' = v, in discrete
   time u(t+1) = v, and agent i measures y_i and u_i; used by the construction "input_filters" of certificates. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space anderson_clements extended.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Matrices.
Variable L : fieldType.

(* rows that a projection keeps, and rows that it drops *)
Lemma rank_apart t a b (X : 'M[L]_(a, t)) (Y : 'M_(b, t)) (P : 'M_t) :
  X *m P = X -> Y *m P = 0 -> \rank (col_mx X Y) = (\rank X + \rank Y)%N.
Proof.
move=> XP YP; rewrite -addsmxE; apply: mxrank_disjoint_sum; apply/eqP/rowV0P => v.
rewrite sub_capmx => /andP[/submxP[w ev] /submxP[z ez]].
by rewrite ev -XP mulmxA -ev ez -mulmxA YP mulmx0.
Qed.

Lemma col_sub t a b (X : 'M[L]_(a, t)) (Y : 'M_(b, t)) : (X <= col_mx X Y)%MS /\ (Y <= col_mx X Y)%MS.
Proof. by apply/andP; rewrite -col_mx_sub. Qed.

Lemma rank_idempotent p (T : 'M[L]_p) : T *m T = T -> (\rank T + \rank (1%:M - T)%R = p)%N.
Proof.
move=> TT; rewrite -(@rank_apart p p p T (1%:M - T) T TT); last first.
  by rewrite mulmxBl mul1mx TT subrr.
have h : (\rank (1%:M : 'M[L]_p) <= \rank (col_mx T (1%:M - T)))%N.
  by apply: mxrankS; apply/submxP; exists (row_mx 1%:M 1%:M); rewrite mul_row_col !mul1mx addrC subrK.
rewrite mxrank1 in h; by apply/eqP; rewrite eqn_leq rank_leq_col h.
Qed.

Variables (n p r : nat) (M : 'M[L]_n) (B : 'M[L]_(n, p)) (C : 'M[L]_(r, n)) (D : 'M[L]_(r, p)).
Variables (T : 'M[L]_p) (lambda : L).
Hypothesis idempotent : T *m T = T.

(* the pencil of the system with inputs as states, T selecting the inputs of the other channels *)
Let wide := block_mx (block_mx M (- B) 0 lambda%:M) (col_mx 0 T) (block_mx C D 0 (1%:M - T)) 0.
Let above := block_mx 1%:M (block_mx 0 B 0 (- lambda%:M)) 0 (block_mx 1%:M (- D) 0 1%:M)
  : 'M[L]_((n + p) + (r + p)).
Let beside := block_mx 1%:M 0 (row_mx 0 (- (lambda *: T))) 1%:M : 'M[L]_((n + p) + p).
Let narrow := block_mx (block_mx M (- (B *m T)) 0 0) (col_mx 0 T) (block_mx C (D *m T) 0 (1%:M - T)) 0.

Lemma above_unit : above \in unitmx.
Proof. by rewrite unitmxE det_ublock det1 mul1r det_ublock !det1 mul1r unitr1. Qed.

Lemma beside_unit : beside \in unitmx.
Proof. by rewrite unitmxE det_lblock !det1 mul1r unitr1. Qed.

Lemma eliminated : above *m wide *m beside = narrow.
Proof.
have eT (X : 'M[L]_(r, p)) : X - X *m (1%:M - T) = X *m T.
  by rewrite mulmxBr mulmx1 opprB addrC subrK.
have eB : - B + B *m (1%:M - T) = - (B *m T) by rewrite mulmxBr mulmx1 addrA addNr add0r.
have el : lambda%:M - lambda%:M *m (1%:M - T) = lambda *: T.
  by rewrite mulmxBr mulmx1 opprB addrC subrK mul_scalar_mx.
have -> : above *m wide = block_mx (block_mx M (- (B *m T)) 0 (lambda *: T)) (col_mx 0 T)
                                   (block_mx C (D *m T) 0 (1%:M - T)) 0.
  rewrite /above /wide mulmx_block !(mul1mx, mul0mx, mulmx0, add0r, addr0); congr block_mx.
    by rewrite mulmx_block add_block_mx !(mul1mx, mul0mx, mulmx0, add0r, addr0) eB mulNmx el.
  by rewrite mulmx_block !(mul1mx, mul0mx, mulmx0, add0r, addr0) mulNmx eT.
rewrite /beside mulmx_block !(mulmx1, mul0mx, mulmx0, add0r, addr0); congr block_mx.
rewrite mul_col_row !(mul0mx, mulmx0) add_block_mx !addr0 mulmxN -scalemxAr idempotent.
by rewrite subrr.
Qed.

Lemma rank_narrow : \rank narrow = (\rank (block_mx M (- (B *m T)) C (D *m T)) + p)%N.
Proof.
pose a := row_mx (row_mx M (- (B *m T))) (0 : 'M[L]_(n, p)); pose b := row_mx (0 : 'M[L]_(p, n + p)) T.
pose c := row_mx (row_mx C (D *m T)) (0 : 'M[L]_(r, p)).
pose d := row_mx (row_mx (0 : 'M[L]_(p, n)) (1%:M - T)) (0 : 'M[L]_(p, p)).
have -> : \rank narrow = \rank (col_mx (col_mx (col_mx a c) d) b).
  apply: eqmx_rank; rewrite /narrow block_mxEv !col_mx_sub.
  have -> : row_mx (block_mx M (- (B *m T)) 0 0) (col_mx 0 T) = col_mx a b.
    by rewrite -block_mxEh block_mxEv /a /b row_mx0.
  have -> : row_mx (block_mx C (D *m T) 0 (1%:M - T)) 0 = col_mx c d.
    have z : (0 : 'M[L]_(r + p, p)) = col_mx 0 0 by rewrite col_mx0.
    by rewrite z -block_mxEh block_mxEv.
  rewrite !col_mx_sub.
  have [s1 s2] := col_sub (col_mx a b) (col_mx c d); have [s3 s4] := col_sub a b; have [s5 s6] := col_sub c d.
  have [t1 t2] := col_sub (col_mx (col_mx a c) d) b; have [t3 t4] := col_sub (col_mx a c) d.
  have [t5 t6] := col_sub a c.
  rewrite (submx_trans s3 s1) (submx_trans s4 s1) (submx_trans s5 s2) (submx_trans s6 s2).
  by rewrite t2 (submx_trans t4 t1) !(submx_trans (submx_trans _ t3) t1).
rewrite (@rank_apart _ _ _ _ _ (block_mx 1%:M 0 0 0)); last 2 first.
- by rewrite /a /c /d !mul_col_mx !mul_row_block !(mulmx0, mulmx1, addr0, mul0mx).
- by rewrite /b mul_row_block !(mulmx0, mul0mx, addr0, add0r) row_mx0.
rewrite (@rank_apart _ _ _ _ _ (block_mx (block_mx 1%:M 0 0 T) 0 0 0)); last 2 first.
- rewrite /a /c !mul_col_mx !mul_row_block !(mulmx0, mulmx1, addr0, add0r, mul0mx).
  by rewrite mulNmx -!mulmxA idempotent.
- rewrite /d !mul_row_block !(mulmx0, mul0mx, mulmx1, addr0, add0r).
  by rewrite mulmxBl mul1mx idempotent subrr !row_mx0.
rewrite -addnA; congr addn; last first.
  rewrite -[RHS](rank_idempotent idempotent) addnC; congr addn.
    by rewrite /b rank_row_0mx.
  by rewrite /d rank_row_mx0 rank_row_0mx.
have -> : col_mx a c = row_mx (block_mx M (- (B *m T)) C (D *m T)) 0.
  by rewrite [block_mx M _ _ _]block_mxEv -[0](@col_mx0 _ n r p) -block_mxEh block_mxEv.
by rewrite rank_row_mx0.
Qed.

Lemma rank_wide : \rank wide = (\rank (block_mx M (- (B *m T)) C (D *m T)) + p)%N.
Proof.
rewrite -rank_narrow -eliminated mxrankMfree ?row_free_unit ?beside_unit //.
by rewrite -[in RHS]mxrank_tr trmx_mul mxrankMfree ?row_free_unit ?unitmx_tr ?above_unit // mxrank_tr.
Qed.
End Matrices.

Section Filtered.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).
Variables (S : multichannel L n p q) (D : 'M[L]_(\sum_i q i, \sum_i p i)).
Implicit Types (s : {set 'I_m}) (lambda : L).

(* the state (x, u), u' = v, and agent i measures C_i x + D_i u and u_i *)
Definition filtered : multichannel L (n + \sum_i p i) p (fun i => q i + p i)%N :=
  Multichannel (block_mx (mcA S) (inputs S setT) 0 0) (fun i => col_mx 0 (shared_input L p i))
    (fun i => block_mx (mcC S i) (submxcol D i) 0 (shared_input L p i)^T).

(* [lambda I - A, -B_{m-s}; C_s, D_{s,m-s}] *)
Definition direct_pencil s lambda : 'M[L]_(n + \sum_i q i, n + \sum_i p i) :=
  block_mx (lambda%:M - mcA S) (- inputs S (~: s)) (outputs S s) (select L q s *m D *m select L p (~: s)).

Lemma mxcol_row t a (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, t)) (W : forall i, 'M[L]_(d i, a)) :
  row_mx (\mxcol_i V i) (\mxcol_i W i) = \mxcol_i row_mx (V i) (W i).
Proof.
have e b (X : 'M[L]_(b, t)) (Y : 'M_(b, a)) : row_mx X Y = X *m row_mx 1%:M 0 + Y *m row_mx 0 1%:M.
  by rewrite !mul_mx_row !mulmx1 !mulmx0 add_row_mx addr0 add0r.
rewrite e !mxcol_mul -mxcolD; apply: eq_mxcol => i; by rewrite -e.
Qed.

Lemma select_rows s : select L q s *m D = \mxcol_i (if i \in s then submxcol D i else 0).
Proof.
rewrite -{1}(submxcolK D) mul_mxdiag_mxcol; apply: eq_mxcol => i.
by case: ifP; rewrite ?mul1mx ?mul0mx.
Qed.

Lemma select_columns s : inputs S setT *m select L p s = inputs S s.
Proof.
rewrite /inputs mul_mxrow_mxdiag; apply: eq_mxrow => i; rewrite inE.
by case: ifP; rewrite ?mulmx1 ?mulmx0.
Qed.

Lemma span_mul t a (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, t)) (W : 'M_(t, a)) s :
  (span (fun i => V i *m W) s :=: span V s *m W)%MS.
Proof.
apply: eqmx_sym; apply: eqmx_trans (sumsmxMr_gen _ _ _) _.
apply/eqmxP/andP; split; apply/sumsmx_subP => i si; apply: (sumsmx_sup i) => //; rewrite !genmxE.
  by apply: submxMr; rewrite genmxE.
by apply: submxMr; rewrite genmxE.
Qed.

Lemma filtered_inputs s : ((inputs filtered s)^T :=: (col_mx 0 (select L p s))^T)%MS.
Proof.
apply: eqmx_trans (eqmx_inputs _ _) _; rewrite trmxK tr_col_mx trmx0 tr_select.
have e t (X : 'M[L]_(t, \sum_i p i)) : row_mx (0 : 'M_(t, n)) X = X *m row_mx 0 1%:M.
  by rewrite mul_mx_row mulmx1 mulmx0.
have f i : i \in s -> ((mcB filtered i)^T :=: (shared_input L p i)^T *m row_mx (0 : 'M_(_, n)) 1%:M)%MS.
  by move=> _; rewrite /= tr_col_mx trmx0 e.
apply: eqmx_trans (span_eqmx f) _; apply: eqmx_trans (span_mul _ _ _) _; rewrite e.
exact: eqmxMr (span_shared _ _ _).
Qed.

Lemma filtered_outputs s :
  (outputs filtered s :=: block_mx (outputs S s) (select L q s *m D) 0 (select L p s))%MS.
Proof.
apply: eqmx_trans (eqmx_outputs _ _) _; rewrite block_mxEv select_rows mxcol_row.
pose V i := row_mx (mcC S i) (submxcol D i); pose W i := row_mx (0 : 'M[L]_(p i, n)) (shared_input L p i)^T.
have -> : \mxcol_i row_mx (if i \in s then mcC S i else 0) (if i \in s then submxcol D i else 0) =
          \mxcol_i (if i \in s then V i else 0).
  by apply: eq_mxcol => i; case: ifP; rewrite ?row_mx0.
have eW : (row_mx 0 (select L p s) :=: span W s)%MS.
  have e t (X : 'M[L]_(t, \sum_i p i)) : row_mx (0 : 'M_(t, n)) X = X *m row_mx 0 1%:M.
    by rewrite mul_mx_row mulmx1 mulmx0.
  rewrite e; apply: eqmx_sym; apply: eqmx_trans (_ : _ :=: span (fun i => (shared_input L p i)^T *m row_mx 0 1%:M) s)%MS _.
    by apply: span_eqmx => i _; rewrite /W e.
  apply: eqmx_trans (span_mul _ _ _) _; exact: eqmxMr (span_shared _ _ _).
have eV := mxcol_space V s.
apply/eqmxP/andP; split.
  apply/sumsmx_subP => i si; rewrite genmxE /= block_mxEv col_mx_sub; apply/andP; split.
    apply: submx_trans (_ : _ <= \mxcol_i (if i \in s then V i else 0))%MS _.
      by rewrite eV; apply: (sumsmx_sup i) => //; rewrite genmxE.
    by case: (col_sub (\mxcol_i (if i \in s then V i else 0)) (row_mx 0 (select L p s))).
  apply: submx_trans (_ : _ <= row_mx 0 (select L p s))%MS _.
    by rewrite eW; apply: sub_span.
  by case: (col_sub (\mxcol_i (if i \in s then V i else 0)) (row_mx 0 (select L p s))).
have sub i : i \in s -> (V i <= \sum_(i in s) <<mcC filtered i>>)%MS /\ (W i <= \sum_(i in s) <<mcC filtered i>>)%MS.
  by move=> si; apply/andP; rewrite -col_mx_sub -block_mxEv; apply: (sumsmx_sup i) => //; rewrite genmxE.
rewrite col_mx_sub; apply/andP; split.
  by rewrite eV; apply/sumsmx_subP => i /sub [h _]; rewrite genmxE.
by rewrite eW; apply/span_sub => i /sub [_ h].
Qed.

(* for every set of channels and every lambda *)
Theorem same_rank s lambda :
  \rank (pencil filtered s lambda) = (\rank (direct_pencil s lambda) + \sum_i p i)%N.
Proof.
rewrite /pencil (rank_block_eq _ (filtered_inputs _) (filtered_outputs _)) /=.
have idem : select L p (~: s) *m select L p (~: s) = select L p (~: s) by rewrite select_mul setIid.
have es : select L p s = 1%:M - select L p (~: s) by rewrite -(selectC L p s) addrK.
rewrite scalar_mx_block opp_block_mx add_block_mx !(subr0, oppr0, addr0, add0r) es.
by rewrite (rank_wide _ _ _ _ _ idem) select_columns.
Qed.

(* the fixed modes of the system with its inputs as states are those of the plant with its feedthrough *)
Theorem same_fixed_modes lambda :
  fixed filtered lambda <-> exists s, (\rank (direct_pencil s lambda) < n)%N.
Proof.
split=> [/anderson_clements[s h]|[s h]].
  by exists s; rewrite same_rank ltn_add2r in h.
by apply/anderson_clements; exists s; rewrite same_rank ltn_add2r.
Qed.
End Filtered.
