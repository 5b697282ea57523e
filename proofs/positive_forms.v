(* Positive semidefinite forms, and Lyapunov's equation for a stable matrix: what performance.v is made of.
   A form that does not increase along a stable matrix is positive semidefinite (the other half of what instability.v
   needs); so the equations M X + X M^H + N = 0 and X = M X M^H + N have one solution each, which is positive
   semidefinite where N is: the covariance. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location stability instability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Forms.
Variable C : numClosedFieldType.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").

Lemma adj0 a b : (0 : 'M[C]_(a, b))^H = 0.
Proof. by rewrite /adjoint trmx0 map_mx0. Qed.
Lemma adjN a b (X : 'M[C]_(a, b)) : (- X)^H = - X^H.
Proof. by apply/matrixP=> i j; rewrite !mxE rmorphN. Qed.
Lemma adjB a b (X Y : 'M[C]_(a, b)) : (X - Y)^H = X^H - Y^H.
Proof. by rewrite adjD adjN. Qed.
Lemma adj1 n : (1%:M : 'M[C]_n)^H = 1%:M.
Proof. by rewrite /adjoint trmx1 map_mx1. Qed.
Lemma adj_block a b c d (P : 'M[C]_(a, b)) Q R (S : 'M_(c, d)) :
  (block_mx P Q R S)^H = block_mx P^H R^H Q^H S^H.
Proof. by rewrite /adjoint tr_block_mx map_block_mx. Qed.
Lemma adj_col a b c (X : 'M[C]_(a, c)) (Y : 'M_(b, c)) : (col_mx X Y)^H = row_mx X^H Y^H.
Proof. by rewrite /adjoint tr_col_mx map_row_mx. Qed.
Lemma adj_row a b c (X : 'M[C]_(c, a)) (Y : 'M_(c, b)) : (row_mx X Y)^H = col_mx X^H Y^H.
Proof. by rewrite /adjoint tr_row_mx map_col_mx. Qed.

(* A form that is nowhere negative. *)
Definition psd n (P : 'M[C]_n) := forall x, 0 <= form P x.

Lemma formD n (P Q : 'M[C]_n) x : form (P + Q) x = form P x + form Q x.
Proof. by rewrite /form mulmxDr mulmxDl mxE. Qed.
Lemma formN n (P : 'M[C]_n) x : form (- P) x = - form P x.
Proof. by rewrite /form mulmxN mulNmx mxE. Qed.
Lemma formZ n k (P : 'M[C]_n) x : form (k *: P) x = k * form P x.
Proof. by rewrite /form -scalemxAr -scalemxAl mxE. Qed.
Lemma form0 n (P : 'M[C]_n) : form P 0 = 0.
Proof. by rewrite /form mulmx0 mxE. Qed.

Lemma form_scaled n (P : 'M[C]_n) k x : form P (k *: x) = `|k| ^+ 2 * form P x.
Proof.
have scale a (X : 'M[C]_1) : (a *: X) 0 0 = a * X 0 0 by rewrite mxE.
by rewrite /form -scalemxAr adjZ -!scalemxAl !scale mulrA sqr_norm.
Qed.

Lemma posdef_psd n (P : 'M[C]_n) : posdef P -> psd P.
Proof. by move=> p x; have [->|nx] := eqVneq x 0; [rewrite form0 | apply: ltW; apply: p]. Qed.
Lemma psdD n (P Q : 'M[C]_n) : psd P -> psd Q -> psd (P + Q).
Proof. by move=> p q x; rewrite formD addr_ge0. Qed.
Lemma psdZ n k (P : 'M[C]_n) : 0 <= k -> psd P -> psd (k *: P).
Proof. by move=> k0 p x; rewrite formZ mulr_ge0. Qed.
Lemma psd_at n a (P : 'M[C]_n) (W : 'M[C]_(n, a)) : psd P -> psd (W^H *m P *m W).
Proof. by move=> p x; rewrite form_sub. Qed.
Lemma psd_of n a (P : 'M[C]_n) (W : 'M[C]_(a, n)) : psd P -> psd (W *m P *m W^H).
Proof. by move=> p; have := psd_at W^H p; rewrite adjK. Qed.
Lemma psd0 n : psd (0 : 'M[C]_n).
Proof. by move=> x; rewrite /form mulmx0 mul0mx mxE. Qed.

(* The value at a sum. *)
Lemma form_sum n (P : 'M[C]_n) x y : P^H = P ->
  form P (x + y) = form P x + form P y + ((x^H *m P *m y) 0 0 + ((x^H *m P *m y) 0 0)^*).
Proof.
move=> hP; have -> : ((x^H *m P *m y) 0 0)^* = (y^H *m P *m x) 0 0.
  have -> : y^H *m P *m x = (x^H *m P *m y)^H by rewrite !adjM adjK hP mulmxA.
  by rewrite [RHS]mxE [in RHS]mxE.
have two (X Y : 'M[C]_1) : (X + Y) 0 0 = X 0 0 + Y 0 0 by rewrite mxE.
rewrite /form adjD !mulmxDl !mulmxDr !two -[LHS]addrA -[RHS]addrA; congr (_ + _).
by rewrite addrA addrC.
Qed.

(* Such a matrix is Hermitian, since its form takes real values. *)
Lemma psd_adj n (P : 'M[C]_n) : psd P -> P^H = P.
Proof.
move=> p; pose K := P^H - P.
have fK x : form K x = 0.
  by rewrite /K formD formN -form_conj (CrealP (ger0_real (p x))) subrr.
have both (x y : 'cV[C]_n) : (x^H *m K *m y) 0 0 + (y^H *m K *m x) 0 0 = 0.
  have := fK (x + y); have := fK x; have := fK y; rewrite /form adjD !mulmxDl !mulmxDr !mxE => -> ->.
  by rewrite add0r addr0.
suff : K = 0 by move/eqP; rewrite subr_eq0 => /eqP.
have zero (x y : 'cV[C]_n) : (x^H *m K *m y) 0 0 = 0.
  have h1 := both x y; have := both x ('i *: y).
  rewrite -scalemxAr adjZ -!scalemxAl ![((_ *: _) : 'M_1) 0 0]mxE conjCi mulNr -mulrBr.
  move/eqP; rewrite mulf_eq0 (negPf (neq0Ci _)) /= subr_eq0 => /eqP e; move: h1; rewrite -e -mulr2n => /eqP.
  by rewrite mulrn_eq0 => /eqP.
apply/matrixP => i j; have := zero (delta_mx i 0) (delta_mx j 0).
have -> : (delta_mx i 0 : 'cV[C]_n)^H = delta_mx 0 i by rewrite /adjoint trmx_delta map_delta_mx.
by rewrite -rowE -colE !mxE.
Qed.

(* Where the form is 0, the matrix is. *)
Lemma ge0_affine (a b : C) : 0 <= b -> (forall s, 0 <= s -> 0 <= a - s * b) -> b = 0.
Proof.
move=> b0 h; apply/eqP; have [//|nb] := eqVneq b 0.
have a0 : 0 <= a by have := h 0 (lexx _); rewrite mul0r subr0.
have /h : 0 <= (a + 1) / b by rewrite divr_ge0 ?addr_ge0 ?ler01.
by rewrite divfK// subr_ge0 ger_addl ler10.
Qed.

Lemma psd_kernel n (P : 'M[C]_n) u : psd P -> form P u = 0 -> P *m u = 0.
Proof.
move=> p fu; have hP := psd_adj p.
have zero (x : 'cV[C]_n) : (x^H *m P *m u) 0 0 = 0.
  pose c := (x^H *m P *m u) 0 0; apply/eqP; rewrite -normr_eq0 -sqrf_eq0 -/c; apply/eqP.
  suff : (`|c| ^+ 2) *+ 2 = 0 by move/eqP; rewrite mulrn_eq0 => /eqP.
  apply: (@ge0_affine (form P x)); first by rewrite pmulrn_lge0// exprn_ge0.
  move=> s s0; have := p (x + (- (s * c^*)) *: u); rewrite form_sum//.
  rewrite -scalemxAr [((_ *: _) : 'M_1) 0 0]mxE -/c.
  have e : s * c^* * c = s * `|c| ^+ 2 by rewrite -mulrA sqr_norm [c * _]mulrC.
  have rs : s * `|c| ^+ 2 \is Num.real by rewrite ger0_real// mulr_ge0// exprn_ge0.
  by rewrite form_scaled fu mulr0 addr0 mulNr e (CrealP _) ?rpredN// -mulr2n mulNrn mulrnAr.
apply/matrixP=> i j; have := zero (delta_mx i 0).
have -> : (delta_mx i 0 : 'cV[C]_n)^H = delta_mx 0 i by rewrite /adjoint trmx_delta map_delta_mx.
by rewrite -mulmxA -rowE !mxE ord1.
Qed.

(* What is left of the form beside a vector u: the P-orthogonal part. *)
Definition deflated n (P : 'M[C]_n) u := P - (form P u)^-1 *: ((P *m u) *m (P *m u)^H).

Lemma deflatedE n (P : 'M[C]_n) u x : P^H = P ->
  form (deflated P u) x = form P x - (form P u)^-1 * `|(u^H *m P *m x) 0 0| ^+ 2.
Proof.
move=> hP; rewrite /deflated formD formN formZ; congr (_ - _ * _); set c := (u^H *m P *m x) 0 0.
have e : (P *m u)^H *m x = c%:M by rewrite adjM hP [LHS]mx11_scalar.
rewrite /form mulmxA -mulmxA e mul_mx_scalar mxE sqr_norm; congr (_ * _).
have -> : x^H *m (P *m u) = ((P *m u)^H *m x)^H by rewrite adjM adjK.
by rewrite e !mxE eqxx.
Qed.

Lemma form_deflated n (P : 'M[C]_n) u x : P^H = P -> form P u \is Num.real -> form P u != 0 ->
  form (deflated P u) x = form P (x - ((u^H *m P *m x) 0 0 / form P u) *: u).
Proof.
move=> hP rf nf; rewrite deflatedE//; set f := form P u in rf nf *; set c := (u^H *m P *m x) 0 0.
rewrite -scaleNr form_sum//.
have -> : form P (- (c / f) *: u) = `|c| ^+ 2 / f.
  rewrite form_scaled normrN normf_div expr_div_n (real_normK rf).
  by rewrite -/f [f ^+ 2]expr2 invfM mulrA divfK.
have -> : (x^H *m P *m (- (c / f) *: u)) 0 0 = - (`|c| ^+ 2 / f).
  rewrite -scalemxAr mxE mulNr; congr (- _).
  have -> : x^H *m P *m u = (u^H *m P *m x)^H by rewrite !adjM adjK hP mulmxA.
  by rewrite [((_)^H) 0 0]mxE [((_)^T) 0 0]mxE -/c sqr_norm mulrAC.
rewrite rmorphN rmorphM fmorphV (CrealP rf) (CrealP (ger0_real _)) ?exprn_ge0//.
by rewrite -addrA; congr (_ + _); rewrite addrA subrr add0r mulrC.
Qed.

Lemma psd_deflated n (P : 'M[C]_n) u : psd P -> form P u != 0 -> psd (deflated P u).
Proof. by move=> p nf x; rewrite (form_deflated _ (psd_adj p))// ger0_real. Qed.

(* The trace of a product of two such matrices, column by column of the second. *)
Lemma trace_rank_one n (H : 'M[C]_n) (w : 'cV[C]_n) : \tr (H *m (w *m w^H)) = form H w.
Proof. by rewrite mulmxA mxtrace_mulC mulmxA /mxtrace big_ord1. Qed.

Lemma psd_trace n (H X : 'M[C]_n) : psd H -> psd X -> 0 <= \tr (H *m X).
Proof.
move=> pH; have step k : (k <= n)%N -> forall X : 'M[C]_n, psd X ->
    (forall i : 'I_n, (k <= i)%N -> X *m (delta_mx i 0 : 'cV_n) = 0) -> 0 <= \tr (H *m X).
  elim: k => [_|k IH lt] Y pY zero.
    suff -> : Y = 0 by rewrite mulmx0 mxtrace0.
    by apply/matrixP => i j; have := zero j isT; rewrite -colE => /matrixP/(_ i 0); rewrite !mxE.
  pose u : 'cV[C]_n := delta_mx (Ordinal lt) 0.
  have [f0|nf] := eqVneq (form Y u) 0.
    apply: (IH (ltnW lt)) => // i; rewrite leq_eqVlt => /orP[/eqP e|]; last exact: zero.
    by have -> : i = Ordinal lt; [apply: val_inj | apply: psd_kernel].
  have -> : Y = deflated Y u + (form Y u)^-1 *: ((Y *m u) *m (Y *m u)^H) by rewrite subrK.
  rewrite mulmxDr mxtraceD -scalemxAr mxtraceZ trace_rank_one addr_ge0 ?mulr_ge0 ?invr_ge0//.
  apply: (IH (ltnW lt)); first exact: psd_deflated.
  move=> i; rewrite leq_eqVlt => /orP[/eqP e|gt].
    have -> : i = Ordinal lt by apply: val_inj.
    rewrite -/u mulmxBl -scalemxAl -mulmxA.
    have -> : (Y *m u)^H *m u = (form Y u)%:M by rewrite adjM (psd_adj pY) [LHS]mx11_scalar.
    by rewrite mul_mx_scalar scalerA mulVf// scale1r subrr.
  rewrite mulmxBl zero// -scalemxAl -mulmxA adjM (psd_adj pY) -[u^H *m Y *m _]mulmxA zero// !mulmx0 scaler0.
  by rewrite subrr.
by move=> pX; apply: (step n) => // i; rewrite leqNgt ltn_ord.
Qed.

Lemma psd_trace_le n (H X Y : 'M[C]_n) : psd H -> psd (Y - X) -> \tr (H *m X) <= \tr (H *m Y).
Proof. by move=> h d; rewrite -subr_ge0 -raddfB /= -mulmxBr; apply: psd_trace. Qed.

(* Between multiples of |x|^2: a form that is nowhere negative is at most its trace, a positive definite one is at least
   some positive multiple. *)
Lemma form1 n (x : 'cV[C]_n) : form 1%:M x = \sum_i `|x i 0| ^+ 2.
Proof. by rewrite /form mulmx1 mxE; apply: eq_bigr => i _; rewrite !mxE mulrC -sqr_norm. Qed.
Lemma form1_ge0 n (x : 'cV[C]_n) : 0 <= form 1%:M x.
Proof. by rewrite form1 sumr_ge0// => i _; rewrite exprn_ge0. Qed.
Lemma form1_gt0 n (x : 'cV[C]_n) : x != 0 -> 0 < form 1%:M x.
Proof.
move=> nx; rewrite lt_def form1_ge0 andbT; apply: contra nx => /eqP e.
by rewrite -[x]mul1mx; apply/eqP; apply: psd_kernel e; apply: form1_ge0.
Qed.

Lemma trace_bound n (P : 'M[C]_n) x : psd P -> form P x <= \tr P * form 1%:M x.
Proof.
move=> p; have [->|nx] := eqVneq x 0; first by rewrite !form0 mulr0.
have f0 := form1_gt0 nx; have := psd_trace p (psd_deflated (@form1_ge0 n) (lt0r_neq0 f0)).
rewrite /deflated mul1mx mulmxBr mulmx1 raddfB /= -scalemxAr mxtraceZ trace_rank_one subr_ge0.
by rewrite mulrC ler_pdivr_mulr.
Qed.

Lemma posdef_unit n (P : 'M[C]_n) : posdef P -> P \in unitmx.
Proof.
move=> p; rewrite -unitmx_tr -row_free_unit -kermx_eq0; apply/negPn/negP => /rowV0Pn[w /sub_kermxP e nw].
have := p w^T; rewrite trmx_eq0 => /(_ nw); rewrite /form -mulmxA.
by have -> : P *m w^T = 0; [apply: trmx_inj; rewrite trmx_mul trmxK trmx0 | rewrite mulmx0 mxE ltxx].
Qed.

Lemma posdef_margin n (P : 'M[C]_n) : posdef P -> exists2 e, 0 < e & forall x, e * form 1%:M x <= form P x.
Proof.
case: n P => [|n] P p; first by exists 1; rewrite ?ltr01// => x; rewrite [x]flatmx0 !form0 mulr0.
have hP := psd_adj (posdef_psd p); have uP := posdef_unit p; pose T := invmx P.
have hT : T^H = T.
  by have := congr1 (@adjoint C _ _) (mulmxV uP); rewrite adjM hP adj1 => e; rewrite -[LHS]mulmx1 -(mulmxV uP) mulmxA e mul1mx.
have fT x : form T x = form P (T *m x) by rewrite -form_sub hT mulVmx// mul1mx.
have pT : psd T by move=> x; rewrite fT (posdef_psd p).
have t0 : 0 < \tr T.
  have nd : (delta_mx 0 0 : 'cV[C]_n.+1) != 0 by apply/eqP => /matrixP/(_ 0 0)/eqP; rewrite !mxE oner_eq0.
  have := trace_bound (delta_mx 0 0) pT; rewrite -(pmulr_lgt0 _ (form1_gt0 nd)); apply: lt_le_trans.
  rewrite fT p//; apply: contra nd => /eqP z; by rewrite -[delta_mx 0 0](mulKVmx uP) -/T z mulmx0.
exists (\tr T)^-1 => [|x]; first by rewrite invr_gt0.
have [->|nx] := eqVneq x 0; first by rewrite !form0 mulr0.
have nu : T *m x != 0 by apply: contra nx => /eqP z; rewrite -[x](mulKVmx uP) -/T z mulmx0.
have := psd_deflated (posdef_psd p) (lt0r_neq0 (p _ nu)) x; rewrite deflatedE// adjM hT -[x^H *m T *m P]mulmxA mulVmx//.
rewrite -/(form 1%:M x) -fT subr_ge0 ger0_norm ?form1_ge0// mulrC => le.
have f1 := form1_gt0 nx; have fx : 0 < form T x by rewrite fT p.
rewrite ler_pdivr_mull//; rewrite ler_pdivr_mulr// in le.
rewrite -(ler_pmul2r f1) -expr2 (le_trans le)// [_ * form P x]mulrC -mulrA ler_wpmul2l ?(posdef_psd p)//.
exact: trace_bound.
Qed.

(* Stability, and forms that do not increase. *)
Definition stable_continuous n (M : 'M[C]_n) := forall lambda, eigenvalue M lambda -> 'Re lambda < 0.
Definition stable_discrete n (M : 'M[C]_n) := forall lambda, eigenvalue M lambda -> `|lambda| < 1.

Lemma adjoint_eigenvalue n (M : 'M[C]_n) (v : 'cV[C]_n) lambda : v != 0 -> M^H *m v = lambda *: v ->
  eigenvalue M lambda^*.
Proof.
move=> nv e; apply/eigenvalueP; exists v^H; first by rewrite -adjZ -e adjM adjK.
by apply: contra nv => /eqP z; rewrite -[v]adjK z adj0.
Qed.

Lemma stable_continuous_adj n (M : 'M[C]_n) : stable_continuous M -> stable_continuous M^H.
Proof.
by move=> st l /right_eigenvector[v nv e]; have := st _ (adjoint_eigenvalue nv e); rewrite Re_conj.
Qed.
Lemma stable_discrete_adj n (M : 'M[C]_n) : stable_discrete M -> stable_discrete M^H.
Proof.
by move=> st l /right_eigenvector[v nv e]; have := st _ (adjoint_eigenvalue nv e); rewrite norm_conjC.
Qed.

(* A basis that begins with u, the form of P split along it, where P u = 0 or u^H P u != 0. *)
Lemma basis_of n (P : 'M[C]_n.+1) (u : 'cV[C]_n.+1) : P^H = P -> u != 0 -> (form P u = 0 -> P *m u = 0) ->
  exists W : 'M[C]_(n.+1, n), u^H *m P *m W = 0 /\ (row_mx u W : 'M_(n.+1, 1 + n)) \in unitmx.
Proof.
move=> hP nu h; have [/h Pu|nf] := eqVneq (form P u) 0; last exact: split_basis.
have [W [_ uG]] := split_basis (lt0r_neq0 (form1_gt0 nu)); exists W; split=> //.
by have -> : u^H *m P = (P *m u)^H; [rewrite adjM hP | rewrite Pu adj0 mul0mx].
Qed.

Lemma psd_split n (P : 'M[C]_n.+1) u (W : 'M[C]_(n.+1, n)) : 0 <= form P u -> psd (W^H *m P *m W) ->
  (forall x, exists a y, x = a *: u + W *m y /\ form P x = `|a| ^+ 2 * form P u + form (W^H *m P *m W) y) ->
  psd P.
Proof.
by move=> pu pW sp x; have [a [y [_ ->]]] := sp x; rewrite addr_ge0// mulr_ge0// exprn_ge0.
Qed.

Lemma continuous_psd n (M P : 'M[C]_n) : P^H = P -> psd (- (M^H *m P + P *m M)) -> stable_continuous M -> psd P.
Proof.
elim: n M P => [|n IH] M P hP pQ st; first by move=> x; rewrite [x]flatmx0 form0.
have [lambda el] := exists_eigenvalue M; have [u nu eu] := right_eigenvector el.
have rl : lambda^* + lambda < 0.
  have -> : lambda^* + lambda = 'Re lambda *+ 2 by rewrite ReE -[_ / _ *+ 2]mulr_natr divfK ?pnatr_eq0// addrC.
  by rewrite pmulrn_llt0// st.
have fQ : form (- (M^H *m P + P *m M)) u = - (lambda^* + lambda) * form P u.
  rewrite /form mulmxN mulNmx mulmxDr mulmxDl (form_left eu) mulmxA (form_right eu) -scalemxAl -scalerDl.
  by rewrite mulNr mxE [in LHS]mxE.
have pu : 0 <= form P u by have := pQ u; rewrite fQ pmulr_rge0// oppr_gt0.
have [W [oW uG]] : exists W : 'M[C]_(n.+1, n), u^H *m P *m W = 0 /\ (row_mx u W : 'M_(n.+1, 1 + n)) \in unitmx.
  apply: basis_of => // f0; have := psd_kernel pQ (etrans fQ _); rewrite f0 mulr0 => /(_ erefl).
  move/eqP; rewrite mulNmx oppr_eq0 mulmxDl (form_right eu) -mulmxA addr_eq0 -scaleNr => /eqP e.
  apply/eqP/negPn/negP => nPu; have := st _ (adjoint_eigenvalue nPu e).
  by rewrite Re_conj raddfN /= oppr_lt0 => /(lt_trans (st _ el)); rewrite ltxx.
have [c [N [eMW eN sp]]] := split_step hP eu oW uG.
have oW' : W^H *m P *m u = 0.
  by have := congr1 (@adjoint C _ _) oW; rewrite !adjM adjK hP mulmxA adj0.
apply: (psd_split pu _ sp); apply: (IH N); [exact: form_adj| |by move=> mu /eN/st].
have e : W^H *m P *m M *m W = W^H *m P *m W *m N by rewrite -mulmxA eMW mulmxDr !mulmxA oW' mul0mx add0r.
have e' : W^H *m M^H *m P *m W = N^H *m (W^H *m P *m W).
  by have := congr1 (@adjoint C _ _) e; rewrite !adjM adjK hP !mulmxA.
have -> : - (N^H *m (W^H *m P *m W) + W^H *m P *m W *m N) = W^H *m (- (M^H *m P + P *m M)) *m W.
  by rewrite mulmxN mulNmx mulmxDr mulmxDl -e -e' !mulmxA.
exact: psd_at.
Qed.

Lemma discrete_psd n (M P : 'M[C]_n) : P^H = P -> psd (P - M^H *m P *m M) -> stable_discrete M -> psd P.
Proof.
elim: n M P => [|n IH] M P hP pQ st; first by move=> x; rewrite [x]flatmx0 form0.
have [lambda el] := exists_eigenvalue M; have [u nu eu] := right_eigenvector el.
have rl : 0 < 1 - `|lambda| ^+ 2 by rewrite subr_gt0 exprn_ilt1 ?st.
have fQ : form (P - M^H *m P *m M) u = (1 - `|lambda| ^+ 2) * form P u.
  rewrite /form mulmxBr mulmxBl -[M^H *m P *m M]mulmxA (form_left eu) mulmxA.
  rewrite -scalemxAl (form_right eu) scalerA mulrBl mul1r sqr_norm [lambda * _]mulrC.
  by rewrite ![((_ + _) : 'M_1) 0 0]mxE ![((- _) : 'M_1) 0 0]mxE [((_ *: _) : 'M_1) 0 0]mxE.
have pu : 0 <= form P u by have := pQ u; rewrite fQ pmulr_rge0.
have [W [oW uG]] : exists W : 'M[C]_(n.+1, n), u^H *m P *m W = 0 /\ (row_mx u W : 'M_(n.+1, 1 + n)) \in unitmx.
  apply: basis_of => // f0; have := psd_kernel pQ (etrans fQ _); rewrite f0 mulr0 => /(_ erefl).
  move/eqP; rewrite mulmxBl (form_right eu) subr_eq0 -mulmxA => /eqP e.
  apply/eqP/negPn/negP => nPu; have nl : lambda != 0.
    by apply: contra nPu => /eqP l0; rewrite e l0 scale0r.
  have /(adjoint_eigenvalue nPu)/st : M^H *m (P *m u) = lambda^-1 *: (P *m u).
    by rewrite {2}e scalerA mulVf// scale1r.
  rewrite norm_conjC normfV invf_lt1 ?normr_gt0// => /(lt_trans (st _ el)); by rewrite ltxx.
have [c [N [eMW eN sp]]] := split_step hP eu oW uG.
have oW' : W^H *m P *m u = 0.
  by have := congr1 (@adjoint C _ _) oW; rewrite !adjM adjK hP mulmxA adj0.
apply: (psd_split pu _ sp); apply: (IH N); [exact: form_adj| |by move=> mu /eN/st].
have e : W^H *m (M^H *m P *m M) *m W = c^H *m (u^H *m P *m u) *m c + N^H *m (W^H *m P *m W) *m N.
  have -> : W^H *m (M^H *m P *m M) *m W = (M *m W)^H *m P *m (M *m W) by rewrite adjM !mulmxA.
  rewrite eMW adjD !adjM !mulmxDl !mulmxDr !mulmxA.
  rewrite -[c^H *m u^H *m P *m W]mulmxA -[c^H *m u^H *m (P *m W)]mulmxA [u^H *m (P *m W)]mulmxA oW mulmx0 mul0mx addr0.
  rewrite -[N^H *m W^H *m P *m u]mulmxA -[N^H *m W^H *m (P *m u)]mulmxA [W^H *m (P *m u)]mulmxA oW'.
  by rewrite mulmx0 mul0mx add0r.
have -> : W^H *m P *m W - N^H *m (W^H *m P *m W) *m N =
    W^H *m (P - M^H *m P *m M) *m W + c^H *m (u^H *m P *m u) *m c.
  by rewrite mulmxBr mulmxBl e opprD [- (c^H *m _ *m c) - _]addrC addrA subrK.
apply: psdD; apply: psd_at => // x; rewrite formE !big_ord1 -/(form P u) mulrAC [_^* * _]mulrC -sqr_norm.
by apply: mulr_ge0; [rewrite exprn_ge0 | exact: pu].
Qed.

(* The same for covariances. *)
Theorem comparison_continuous n (M X : 'M[C]_n) : stable_continuous M -> X^H = X ->
  psd (- (M *m X + X *m M^H)) -> psd X.
Proof. by move=> st hX p; apply: (@continuous_psd _ M^H) => //; [rewrite adjK | apply: stable_continuous_adj]. Qed.
Theorem comparison_discrete n (M X : 'M[C]_n) : stable_discrete M -> X^H = X ->
  psd (X - M *m X *m M^H) -> psd X.
Proof. by move=> st hX p; apply: (@discrete_psd _ M^H) => //; [rewrite adjK | apply: stable_discrete_adj]. Qed.

(* Two solutions differ by a D with f D = 0 for a linear f that respects conjugates: it is enough to know of Hermitian D. *)
Lemma hermitian_zero n (D : 'M[C]_n) : psd D -> psd (- D) -> D = 0.
Proof.
move=> p q; apply/matrixP => i j.
have : D *m (delta_mx j 0 : 'cV_n) = 0.
  by apply: (psd_kernel p); apply/eqP; rewrite eq_le p andbT -oppr_ge0 -formN.
by rewrite -colE => /matrixP/(_ i 0); rewrite !mxE.
Qed.

Lemma linear_solution n (f : {linear 'M[C]_n -> 'M[C]_n}) : (forall D, f D^H = (f D)^H) ->
  (forall D, D^H = D -> f D = 0 -> D = 0) ->
  (forall D, f D = 0 -> D = 0) /\ (forall N, exists X, f X = N).
Proof.
move=> fH f0; have inj D : f D = 0 -> D = 0.
  move=> e; have eH : f D^H = 0 by rewrite fH e adj0.
  have h1 : D + D^H = 0 by apply: f0; [rewrite adjD adjK addrC | rewrite raddfD /= e eH addr0].
  have /eqP : 'i *: (D - D^H) = 0.
    apply: f0; last by rewrite linearZ /= raddfB /= e eH subr0 scaler0.
    by rewrite adjZ adjB adjK conjCi scaleNr -scalerN opprB.
  rewrite scaler_eq0 (negPf (neq0Ci _)) /= subr_eq0 => /eqP h2; move: h1; rewrite -h2 -mulr2n => /eqP.
  by rewrite -scaler_nat scaler_eq0 pnatr_eq0 => /eqP.
split=> // N; exists (vec_mx (mxvec N *m invmx (lin_mx f))); apply: (can_inj mxvecK).
rewrite -mul_vec_lin vec_mxK mulmxKV// -row_free_unit -kermx_eq0; apply/negPn/negP.
case/rowV0Pn => v /sub_kermxP e /negP; apply; rewrite -[v]vec_mxK; apply/eqP.
suff -> : vec_mx v = 0 by rewrite linear0.
by apply: inj; apply: (can_inj mxvecK); rewrite -mul_vec_lin vec_mxK e linear0.
Qed.

Section Solutions.
Variables (n : nat) (M : 'M[C]_n).
Definition flow X := M *m X + X *m M^H.
Definition decrement X := X - M *m X *m M^H.
Lemma flow_linear : linear flow.
Proof. by move=> k X Y; rewrite /flow mulmxDr mulmxDl -scalemxAr -scalemxAl scalerDr addrACA. Qed.
Lemma decrement_linear : linear decrement.
Proof.
move=> k X Y; rewrite /decrement mulmxDr mulmxDl -scalemxAr -scalemxAl scalerBr opprD.
by rewrite addrACA.
Qed.
Canonical flow_additive := Additive flow_linear.
Canonical flow_is_linear := Linear flow_linear.
Canonical decrement_additive := Additive decrement_linear.
Canonical decrement_is_linear := Linear decrement_linear.
Lemma flow_adj X : flow X^H = (flow X)^H.
Proof. by rewrite /flow adjD !adjM adjK addrC. Qed.
Lemma decrement_adj X : decrement X^H = (decrement X)^H.
Proof. by rewrite /decrement adjB !adjM adjK mulmxA. Qed.

(* The covariance exists, once, and is positive semidefinite. *)
Theorem covariance_continuous N : stable_continuous M -> psd N ->
  exists X, [/\ M *m X + X *m M^H + N = 0, psd X & forall Y, M *m Y + Y *m M^H + N = 0 -> Y = X].
Proof.
move=> st pN; have h0 D : D^H = D -> flow D = 0 -> D = 0.
  move=> hD e; apply: hermitian_zero; apply: (comparison_continuous st); rewrite ?adjN ?hD//.
    by rewrite -/(flow D) e oppr0; apply: psd0.
  by rewrite -/(flow (- D)) raddfN /= e oppr0 oppr0; apply: psd0.
have [inj ex] := linear_solution flow_adj h0; have [X eX] := ex (- N).
have un Y : M *m Y + Y *m M^H + N = 0 -> Y = X.
  move/eqP; rewrite addr_eq0 => /eqP e; apply/eqP; rewrite -subr_eq0; apply/eqP; apply: inj.
  by rewrite raddfB /= {1}/flow e eX subrr.
have solves : M *m X + X *m M^H + N = 0 by rewrite -/(flow X) eX addNr.
exists X; split=> //; apply: (comparison_continuous st); last by rewrite -/(flow X) eX opprK.
by apply: un; rewrite -/(flow X^H) flow_adj eX adjN (psd_adj pN) addNr.
Qed.

Theorem covariance_discrete N : stable_discrete M -> psd N ->
  exists X, [/\ X = M *m X *m M^H + N, psd X & forall Y, Y = M *m Y *m M^H + N -> Y = X].
Proof.
move=> st pN; have h0 D : D^H = D -> decrement D = 0 -> D = 0.
  move=> hD e; apply: hermitian_zero; apply: (comparison_discrete st); rewrite ?adjN ?hD//.
    by rewrite -/(decrement D) e; apply: psd0.
  by rewrite -/(decrement (- D)) raddfN /= e oppr0; apply: psd0.
have [inj ex] := linear_solution decrement_adj h0; have [X eX] := ex N.
have solved Y : Y = M *m Y *m M^H + N <-> decrement Y = N.
  by rewrite /decrement; split=> [e|<-]; [rewrite {1}e addrAC subrr add0r | rewrite addrC subrK].
have un Y : Y = M *m Y *m M^H + N -> Y = X.
  by move/solved => e; apply/eqP; rewrite -subr_eq0; apply/eqP; apply: inj; rewrite raddfB /= e eX subrr.
exists X; split=> //; first exact/solved.
apply: (comparison_discrete st); last by rewrite -/(decrement X) eX.
by apply: un; apply/solved; rewrite decrement_adj eX (psd_adj pN).
Qed.
End Solutions.
End Forms.
