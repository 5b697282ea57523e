(* checker/performance.py: kinds `loop_cost`, `disk_margin` and `sector`; cost_bound.v has the fourth kind.

   C is a closed field such as algC, in which the checker's real matrices are seen; x^H is the conjugate transpose, and the
   transpose of real matrices.  The cost is defined by the covariance X, the solution of Lyapunov's equation, which exists
   once and is positive semidefinite for a stable loop (covariance_continuous and covariance_discrete in positive_forms.v):
   no probability is needed.  That the checker's matrices are positive definite is stability.dominant_congruence. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location stability instability positive_forms.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Identities, by the ring tactic over an arbitrary commutative ring structure, as in location.v. *)
Section Abstract.
Variables (T : Type) (o i : T) (add mul sub : T -> T -> T) (opp : T -> T).
Hypothesis rt : ring_theory o i add mul sub opp eq.
Add Ring abstract_ring : rt.
Local Notation "x + y" := (add x y). Local Notation "x * y" := (mul x y).
Local Notation "x - y" := (add x (opp y)). Local Notation "- x" := (opp x).

Lemma abs_gain (a a' b b' e e' f g h r : T) :
  - (a + a') - f + (g - r) * h + (- (b + e) + - (b' + e')) = - (a + b + (a' + b')) - (f + r * h + (e + e')) + g * h.
Proof. ring. Qed.
Lemma abs_gain_discrete (a c k b b' e e' f g h r : T) :
  a - c - f + ((g - r) * h - k) + (- (b + e) + - (b' + e')) = a - (c + k + (b + b')) - (f + r * h + (e + e')) + g * h.
Proof. ring. Qed.
Lemma abs_sector (t a b v u h : T) : h + h = i ->
  t * (a * b) * (v * v) + t * (u * u) - (t * (a + b) * h * (v * u) + t * (a + b) * h * (v * u)) =
  - (t * ((u - a * v) * (b * v - u))).
Proof.
move=> hh; transitivity (t * (a * b) * (v * v) + t * (u * u) - t * (a + b) * (h + h) * (v * u)); first by ring.
by rewrite hh; ring.
Qed.
Lemma abs_falls (a a' b b' s e e' k : T) :
  - (a + a') + s + k + (- (b + e) + - (b' + e')) = - (a + b + (a' + b')) + (s + k - (e + e')).
Proof. ring. Qed.
Lemma abs_falls_discrete (a c s k l b b' e e' : T) :
  a - c + s + (k - l) + (- (b + e) + - (b' + e')) = a - (c + l + (b + b')) + (s + k - (e + e')).
Proof. ring. Qed.
End Abstract.

Section Performance.
Variable C : numClosedFieldType.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").
Local Notation real := (@real_mx C _ _).

Lemma posdef_stable_continuous n (M P : 'M[C]_n) : posdef P -> posdef (- (P *m M + M^H *m P)) -> stable_continuous M.
Proof.
move=> pP pQ l /(lyapunov_continuous (rpred0 _) pP); rewrite oppr0; apply.
by rewrite mul0rn scale0r addr0 addrC.
Qed.
Lemma posdef_stable_discrete n (M P : 'M[C]_n) : posdef P -> posdef (P - M^H *m P *m M) -> stable_discrete M.
Proof. by move=> pP pQ l /(lyapunov_discrete ler01 pP); apply; rewrite expr1n scale1r. Qed.

Lemma posdef_add n (P Q : 'M[C]_n) : posdef (P - Q) -> psd Q -> posdef P.
Proof. by move=> p q x nx; rewrite -[P](subrK Q) formD ltr_paddr ?p. Qed.

(* Kind `loop_cost`: z' = M z + x^H w + G v, of which the plant's state is x z, and the inputs are u = U z (in discrete time
   U z + K v), w of intensity W, v of intensity V.  The cost is tr(Q cov x) + tr(R cov u). *)
Section Cost.
Variables (N n p q : nat) (M : 'M[C]_N) (x : 'M[C]_(n, N)) (U : 'M[C]_(p, N)) (G : 'M[C]_(N, q)).
Variables (Q W : 'M[C]_n) (R : 'M[C]_p) (V : 'M[C]_q).
Hypotheses (pQ : psd Q) (pR : psd R) (pW : psd W) (pV : psd V).
Definition intensity := x^H *m W *m x + G *m V *m G^H.
Definition spent := x^H *m Q *m x + U^H *m R *m U.

Lemma intensity_psd : psd intensity.
Proof. by apply: psdD; [apply: psd_at | apply: psd_of]. Qed.
Lemma spent_psd : psd spent.
Proof. by apply: psdD; apply: psd_at. Qed.
Lemma spent_trace X : \tr (spent *m X) = \tr (Q *m (x *m X *m x^H)) + \tr (R *m (U *m X *m U^H)).
Proof. by rewrite mulmxDl mxtraceD -!mulmxA; congr (_ + _); rewrite mxtrace_mulC -!mulmxA. Qed.
Lemma intensity_trace P : \tr (P *m intensity) = \tr (x *m P *m x^H *m W) + \tr (G^H *m P *m G *m V).
Proof.
rewrite mulmxDr mxtraceD !mulmxA; congr (_ + _); first by rewrite mxtrace_mulC !mulmxA.
by rewrite mxtrace_mulC !mulmxA.
Qed.

Theorem cost_continuous P : posdef P -> posdef (- (P *m M + M^H *m P) - (x^H *m Q *m x + U^H *m R *m U)) ->
  stable_continuous M /\
  forall X, M *m X + X *m M^H + (x^H *m W *m x + G *m V *m G^H) = 0 ->
    \tr (Q *m (x *m X *m x^H)) + \tr (R *m (U *m X *m U^H)) <= \tr (x *m P *m x^H *m W) + \tr (G^H *m P *m G *m V).
Proof.
rewrite -/spent -/intensity => pP pS; have st := posdef_stable_continuous pP (posdef_add pS spent_psd).
split=> // X eX; have [Z [_ pZ /(_ X eX) XZ]] := covariance_continuous st intensity_psd.
rewrite -XZ in pZ; rewrite -spent_trace -intensity_trace -subr_ge0.
have -> : intensity = - (M *m X + X *m M^H) by apply/eqP; rewrite -addr_eq0 addrC eX.
have -> : \tr (P *m - (M *m X + X *m M^H)) = \tr (- (P *m M + M^H *m P) *m X).
  rewrite mulmxN mulNmx ![\tr (- _)]raddfN /= mulmxDr mulmxDl ![\tr (_ + _)]raddfD /= !mulmxA; congr (- (_ + _)).
  by rewrite mxtrace_mulC mulmxA.
by rewrite -raddfB -mulmxBl; apply: psd_trace pZ; apply: posdef_psd.
Qed.

Theorem cost_discrete P (K : 'M[C]_(p, q)) :
  posdef P -> posdef (P - M^H *m P *m M - (x^H *m Q *m x + U^H *m R *m U)) ->
  stable_discrete M /\
  forall X, X = M *m X *m M^H + (x^H *m W *m x + G *m V *m G^H) ->
    \tr (Q *m (x *m X *m x^H)) + \tr (R *m (U *m X *m U^H + K *m V *m K^H)) <=
    \tr (x *m P *m x^H *m W) + \tr (G^H *m P *m G *m V) + \tr (K^H *m R *m K *m V).
Proof.
rewrite -/spent -/intensity => pP pS; have st := posdef_stable_discrete pP (posdef_add pS spent_psd).
split=> // X eX; have [Z [_ pZ /(_ X eX) XZ]] := covariance_discrete st intensity_psd.
rewrite -XZ in pZ; rewrite mulmxDr mxtraceD addrA -intensity_trace.
have -> : \tr (R *m (K *m V *m K^H)) = \tr (K^H *m R *m K *m V) by rewrite !mulmxA mxtrace_mulC !mulmxA.
rewrite ler_add2r -spent_trace -subr_ge0.
have -> : intensity = X - M *m X *m M^H by rewrite {1}eX addrAC subrr add0r.
have -> : \tr (P *m (X - M *m X *m M^H)) = \tr ((P - M^H *m P *m M) *m X).
  rewrite mulmxBr mulmxBl !raddfB /= !mulmxA; congr (_ - _).
  by rewrite mxtrace_mulC !mulmxA.
by rewrite -raddfB -mulmxBl; apply: psd_trace pZ; apply: posdef_psd.
Qed.
End Cost.

(* In continuous time with the filtered noise v' = - omega v + omega n, as the checker writes the loop: z and v together, and
   the loop without noise is stable, too. *)
Section Filtered.
Variables (N n p q : nat) (M : 'M[C]_N) (x : 'M[C]_(n, N)) (G : 'M[C]_(N, q)) (U : 'M[C]_(p, N)) (K : 'M[C]_(p, q)).
Variable omega : C.
Definition with_noise : 'M[C]_(N + q) := block_mx M G 0 (- omega%:M).

Lemma loop_stable : 0 < omega -> stable_continuous with_noise -> stable_continuous M.
Proof.
move=> o0 st l /eigenvalueP[v e nv]; have [z|nz] := eqVneq (l + omega) 0.
  move/eqP: z; rewrite addr_eq0 => /eqP ->; rewrite raddfN /= oppr_lt0 (Creal_ReP _ _)//.
  by rewrite ger0_real// ltW.
apply: st; apply/eigenvalueP; exists (row_mx v ((l + omega)^-1 *: (v *m G))); last first.
  by apply: contra nv => /eqP z; have := congr1 lsubmx z; rewrite row_mxKl linear0 => ->.
rewrite /with_noise mul_row_block mulmx0 addr0 e scale_row_mx; congr row_mx.
rewrite mulmxN mul_mx_scalar scalerA -scaleNr -{1}[v *m G]scale1r -scalerDl [RHS]scalerA; congr (_ *: _).
by rewrite -{1}(mulfV nz) -mulrBl addrK.
Qed.

Theorem cost_filtered (Q W : 'M[C]_n) (R : 'M[C]_p) (V : 'M[C]_q) P :
  let Mv := with_noise in let xv := row_mx x 0 in let Uv := row_mx U K in let Gv : 'M_(N + q, q) := col_mx 0 omega%:M in
  0 < omega -> psd Q -> psd R -> psd W -> psd V ->
  posdef P -> posdef (- (P *m Mv + Mv^H *m P) - (xv^H *m Q *m xv + Uv^H *m R *m Uv)) ->
  stable_continuous M /\
  forall X, Mv *m X + X *m Mv^H + (xv^H *m W *m xv + Gv *m V *m Gv^H) = 0 ->
    \tr (Q *m (xv *m X *m xv^H)) + \tr (R *m (Uv *m X *m Uv^H)) <=
    \tr (xv *m P *m xv^H *m W) + \tr (Gv^H *m P *m Gv *m V).
Proof.
move=> Mv xv Uv Gv o0 pQ pR pW pV pP pS; have [st bound] := cost_continuous Gv pQ pR pW pV pP pS.
by split; [apply: loop_stable | exact: bound].
Qed.
End Filtered.

(* Forms of block matrices. *)
Lemma form_block a b (P : 'M[C]_a) X (Q : 'M[C]_b) z w : P^H = P -> Q^H = Q ->
  form (block_mx P X X^H Q) (col_mx z w) =
  form P z + form Q w + ((z^H *m X *m w) 0 0 + ((z^H *m X *m w) 0 0)^*).
Proof.
move=> hP hQ; have -> : ((z^H *m X *m w) 0 0)^* = (w^H *m X^H *m z) 0 0.
  have -> : w^H *m X^H *m z = (z^H *m X *m w)^H by rewrite !adjM adjK mulmxA.
  by rewrite [RHS]mxE [in RHS]mxE.
have two (S T : 'M[C]_1) : (S + T) 0 0 = S 0 0 + T 0 0 by rewrite mxE.
rewrite /form adj_col mul_row_block mul_row_col !mulmxDl !two -[LHS]addrA -[RHS]addrA; congr (_ + _).
by rewrite addrA addrC; congr (_ + _); rewrite addrC.
Qed.

Lemma form_diag n (d : 'rV[C]_n) (x : 'cV_n) : form (diag_mx d) x = \sum_k d 0 k * `|x k 0| ^+ 2.
Proof.
rewrite formE; apply: eq_bigr => i _; rewrite (bigD1 i)//= big1 ?addr0 => [|j ne].
  by rewrite !mxE eqxx mulr1n mulrAC [_^* * _]mulrC -sqr_norm mulrC.
by rewrite !mxE eq_sym (negPf ne) mulr0n mulr0 mul0r.
Qed.

(* Kind `disk_margin`: z' = M z + E w, u = Y z at some ports, which are multiplied by (1 + d/2)/(1 - d/2). *)
Section Margin.
Variables (n r : nat) (M P : 'M[C]_n) (E : 'M[C]_(n, r)) (Y : 'M[C]_(r, n)) (theta : 'rV[C]_r) (alpha : C).
Local Notation Theta := (diag_mx theta).
Local Notation half := (2%:R^-1 : C).
Local Notation corner := ((alpha ^- 2 - half ^+ 2) *: Theta).
Hypotheses (alpha0 : 0 < alpha) (theta0 : forall k, 0 < theta 0 k) (pP : posdef P).

Definition multiplier (d : C) := (1 + d * half) / (1 - d * half).
Definition multiplied (d : 'rV[C]_r) := M + E *m diag_mx (\row_k (multiplier (d 0 k) - 1)) *m Y.
Definition gain_continuous :=
  let X := - (P *m E + half *: (Y^H *m Theta)) in block_mx (- (P *m M + M^H *m P) - Y^H *m Theta *m Y) X X^H corner.
Definition gain_discrete := let X := - (M^H *m P *m E + half *: (Y^H *m Theta)) in
  block_mx (P - M^H *m P *m M - Y^H *m Theta *m Y) X X^H (corner - E^H *m P *m E).

Lemma hP : P^H = P. Proof. exact/psd_adj/posdef_psd. Qed.
Lemma half0 : 0 < half. Proof. by rewrite invr_gt0 ltr0n. Qed.
Lemma psd_Theta : psd Theta.
Proof. by move=> x; rewrite form_diag sumr_ge0// => k _; rewrite mulr_ge0 ?exprn_ge0// ltW. Qed.
Lemma hTheta : Theta^H = Theta. Proof. exact/psd_adj/psd_Theta. Qed.
Lemma real_gap : alpha ^- 2 - half ^+ 2 \is Num.real.
Proof. by rewrite rpredB ?rpredV ?rpredX ?ger0_real// ltW// half0. Qed.
Lemma hcorner : corner^H = corner.
Proof. by rewrite adjZ hTheta (CrealP real_gap). Qed.

Lemma entry_sum (S T : 'M[C]_1) : (S + T) 0 0 = S 0 0 + T 0 0. Proof. by rewrite mxE. Qed.
Lemma entry_opp (S : 'M[C]_1) : (- S) 0 0 = - S 0 0. Proof. by rewrite mxE. Qed.

Lemma form_rate (X : 'M[C]_n) z :
  form (- (P *m X + X^H *m P)) z = - ((z^H *m P *m (X *m z)) 0 0 + ((z^H *m P *m (X *m z)) 0 0)^*).
Proof.
have -> : X^H *m P = (P *m X)^H by rewrite adjM hP.
by rewrite formN formD -form_conj /form !mulmxA.
Qed.

(* The value at z and w. *)
Lemma seen (z : 'cV_n) (w : 'cV_r) : (z^H *m (half *: (Y^H *m Theta)) *m w) 0 0 = ((Y *m z)^H *m Theta *m (half *: w)) 0 0.
Proof. by rewrite adjM -!scalemxAr -scalemxAl !mulmxA. Qed.
Lemma quarter (w : 'cV_r) : form Theta (half *: w) = half ^+ 2 * form Theta w.
Proof. by rewrite form_scaled ger0_norm// ltW// half0. Qed.

Lemma gain_continuous_at (z : 'cV_n) (w : 'cV_r) :
  form gain_continuous (col_mx z w) =
  - ((z^H *m P *m (M *m z + E *m w)) 0 0 + ((z^H *m P *m (M *m z + E *m w)) 0 0)^*) -
    form Theta (Y *m z + half *: w) + alpha ^- 2 * form Theta w.
Proof.
rewrite /gain_continuous form_block ?hcorner//; last first.
  by rewrite adjB adjN adjD !adjM hP adjK hTheta !adjK mulmxA [M^H *m P + _]addrC.
rewrite formD form_rate formN form_sub formZ (form_sum _ _ hTheta) quarter.
rewrite mulmxN mulNmx entry_opp mulmxDr mulmxDl entry_sum seen mulmxDr entry_sum !mulmxA !rmorphN !rmorphD.
exact: (abs_gain (ring_of_R C)).
Qed.

Lemma gain_discrete_at (z : 'cV_n) (w : 'cV_r) :
  form gain_discrete (col_mx z w) =
  form P z - form P (M *m z + E *m w) - form Theta (Y *m z + half *: w) + alpha ^- 2 * form Theta w.
Proof.
rewrite /gain_discrete form_block; last 2 first.
- by rewrite !adjB !adjM !adjK hP hTheta !mulmxA.
- by rewrite adjB hcorner !adjM adjK hP mulmxA.
rewrite !formD !formN !form_sub formZ (form_sum _ _ hTheta) (form_sum _ _ hP) quarter.
rewrite mulmxN mulNmx entry_opp mulmxDr mulmxDl entry_sum seen !adjM !mulmxA !rmorphN !rmorphD.
exact: (abs_gain_discrete (ring_of_R C)).
Qed.

(* Where w_k = d_k (u_k + w_k / 2) the last two terms are at most 0. *)
Lemma apart d : half ^+ 2 < alpha ^- 2 -> `|d| <= alpha -> 1 - d * half != 0.
Proof.
move=> g da; apply/eqP => /eqP; rewrite subr_eq0 => /eqP e.
have d2 : d = 2%:R by apply: (mulIf (lt0r_neq0 half0)); rewrite -e mulfV ?pnatr_eq0.
move: da; rewrite d2 normr_nat => a2; move: g.
by rewrite -exprVn ltr_pexpn2r ?nnegrE ?invr_ge0 ?(ltW half0) ?(ltW alpha0) ?ler0n// ltf_pinv ?posrE ?ltr0n// => /lt_geF; rewrite a2.
Qed.

Lemma small d u : 1 - d * half != 0 -> `|d| <= alpha ->
  alpha ^- 2 * `|(multiplier d - 1) * u| ^+ 2 <= `|u + half * ((multiplier d - 1) * u)| ^+ 2.
Proof.
move=> nd da; pose v := u / (1 - d * half).
have e : (multiplier d - 1) * u = d * v.
  rewrite /multiplier -[X in _ - X](divff nd) -mulrBl opprB addrA addrAC [1 + _]addrC addrK.
  by rewrite -splitr /v mulrAC mulrA.
have -> : u + half * ((multiplier d - 1) * u) = v.
  have {1}-> : u = (1 - d * half) * v by rewrite /v mulrC divfK.
  by rewrite e mulrBl mul1r -[d * half * v]mulrA [d * (half * v)]mulrCA subrK.
rewrite e normrM exprMn mulrA ler_pimull ?exprn_ge0// mulrC ler_pdivr_mulr ?exprn_gt0// mul1r.
by rewrite ler_pexpn2r ?nnegrE// ltW.
Qed.

Section Multiplied.
Variable d : 'rV[C]_r.
Hypothesis near : forall k, `|d 0 k| <= alpha.

Lemma gap (P' : 'M[C]_n) X X' (Z : 'M[C]_r) (k : 'I_r) : posdef (block_mx P' X X' (corner - Z)) -> psd Z ->
  half ^+ 2 < alpha ^- 2.
Proof.
move=> pd pZ; have ne : (col_mx 0 (delta_mx k 0) : 'cV[C]_(n + r)) != 0.
  apply/eqP => /(congr1 dsubmx); rewrite col_mxKd linear0 => /matrixP/(_ k 0)/eqP.
  by rewrite !mxE !eqxx oner_eq0.
have := pd _ ne; rewrite /form adj_col mul_row_block mul_row_col adj0 !mul0mx !add0r mulmx0 add0r -/(form _ _).
rewrite formD formN => h.
have {h} : 0 < form corner (delta_mx k 0) by apply: lt_le_trans h _; rewrite ger_addl oppr_le0.
rewrite formZ form_diag (bigD1 k)//= big1 ?addr0 => [|j ne']; last by rewrite !mxE (negPf ne') normr0 expr0n mulr0.
by rewrite mxE !eqxx normr1 expr1n mulr1 pmulr_lgt0// subr_gt0.
Qed.

Lemma sum_small (z : 'cV_n) : (forall k, 1 - d 0 k * half != 0) -> let w := diag_mx (\row_k (multiplier (d 0 k) - 1)) *m (Y *m z) in
  alpha ^- 2 * form Theta w <= form Theta (Y *m z + half *: w).
Proof.
move=> nd; set w := (X in let _ := X in _); rewrite /= !form_diag mulr_sumr; apply: ler_sum => k _; rewrite mulrCA ler_pmul2l//.
have -> : w k 0 = (multiplier (d 0 k) - 1) * (Y *m z) k 0 by rewrite /w mul_diag_mx !mxE.
have -> : (Y *m z + half *: w) k 0 = (Y *m z) k 0 + half * ((multiplier (d 0 k) - 1) * (Y *m z) k 0).
  by rewrite [LHS]mxE; congr (_ + _); rewrite [LHS]mxE /w mul_diag_mx; congr (_ * _); rewrite [LHS]mxE; congr (_ * _); rewrite mxE.
exact: small.
Qed.

Theorem margin_continuous : posdef gain_continuous ->
  (forall k, 1 - d 0 k * half != 0) /\ (forall lambda, eigenvalue (multiplied d) lambda -> 'Re lambda < 0).
Proof.
move=> pG; have nd k : 1 - d 0 k * half != 0.
  apply: apart => //; apply: (@gap _ _ _ 0 k); last exact: psd0.
  by rewrite subr0; exact: pG.
split=> //; apply: (posdef_stable_continuous pP) => z nz; rewrite form_rate.
pose w := diag_mx (\row_k (multiplier (d 0 k) - 1)) *m (Y *m z).
have -> : multiplied d *m z = M *m z + E *m w by rewrite mulmxDl /w !mulmxA.
have ne : col_mx z w != 0 by apply: contra nz => /eqP /(congr1 usubmx); rewrite col_mxKu linear0 => ->.
have := pG _ ne; rewrite gain_continuous_at -addrA => /lt_le_trans; apply.
by rewrite ger_addl addrC subr_le0; apply: sum_small.
Qed.

Theorem margin_discrete : posdef gain_discrete ->
  (forall k, 1 - d 0 k * half != 0) /\ (forall lambda, eigenvalue (multiplied d) lambda -> `|lambda| < 1).
Proof.
move=> pG; have nd k : 1 - d 0 k * half != 0.
  by apply: apart => //; apply: (gap k pG); apply: psd_at; apply: posdef_psd.
split=> //; apply: (posdef_stable_discrete pP) => z nz; rewrite formD formN form_sub.
pose w := diag_mx (\row_k (multiplier (d 0 k) - 1)) *m (Y *m z).
have -> : multiplied d *m z = M *m z + E *m w by rewrite mulmxDl /w !mulmxA.
have ne : col_mx z w != 0 by apply: contra nz => /eqP /(congr1 usubmx); rewrite col_mxKu linear0 => ->.
have := pG _ ne; rewrite gain_discrete_at -addrA => /lt_le_trans; apply.
by rewrite ger_addl addrC subr_le0; apply: sum_small.
Qed.
End Multiplied.
End Margin.

(* Kind `sector`: z' = M0 z + E f, M0 = M - E U, where f_i is between a_i v_i and b_i v_i, v = U z, all real. *)
Section Nonlinear.
Variables (n r : nat) (M P : 'M[C]_n) (E : 'M[C]_(n, r)) (U : 'M[C]_(r, n)) (theta a b : 'rV[C]_r).
Hypotheses (rU : real_mx U) (ra : real_mx a) (rb : real_mx b) (theta0 : forall k, 0 < theta 0 k) (pP : posdef P).
Local Notation Theta := (diag_mx theta).
Local Notation half := (2%:R^-1 : C).
Local Notation M0 := (M - E *m U).

Definition products := diag_mx (\row_k (theta 0 k * (a 0 k * b 0 k))).
Definition means := diag_mx (\row_k (theta 0 k * (a 0 k + b 0 k) * half)).
Definition decrease_continuous :=
  let X := - (P *m E + U^H *m means) in block_mx (- (P *m M0 + M0^H *m P) + U^H *m products *m U) X X^H Theta.
Definition decrease_discrete := let X := - (M0^H *m P *m E + U^H *m means) in
  block_mx (P - M0^H *m P *m M0 + U^H *m products *m U) X X^H (Theta - E^H *m P *m E).
Definition within (z : 'cV[C]_n) (f : 'cV[C]_r) :=
  forall i, 0 <= (f i 0 - a 0 i * (U *m z) i 0) * (b 0 i * (U *m z) i 0 - f i 0).

Lemma adj_diag (d : 'rV[C]_r) : real_mx d -> (diag_mx d)^H = diag_mx d.
Proof.
move=> rd; apply/matrixP=> i j; rewrite !mxE rmorphMn /= (CrealP (rd _ _)) eq_sym.
by case: eqP => [->|].
Qed.
Lemma real_theta k : theta 0 k \is Num.real. Proof. exact/ger0_real/ltW. Qed.
Lemma adj_theta : Theta^H = Theta. Proof. by apply: adj_diag => i k; rewrite ord1 real_theta. Qed.
Lemma adj_products : products^H = products.
Proof. by apply: adj_diag => i k; rewrite mxE !rpredM ?real_theta. Qed.
Lemma adj_P : P^H = P. Proof. exact/psd_adj/posdef_psd. Qed.

(* What the sectors add. *)
Definition gap_of (z : 'cV[C]_n) (f : 'cV[C]_r) :=
  \sum_k theta 0 k * ((f k 0 - a 0 k * (U *m z) k 0) * (b 0 k * (U *m z) k 0 - f k 0)).

Lemma real_seen (z : 'cV[C]_n) : real_mx z -> real_mx (U *m z).
Proof. by move=> rz i j; rewrite mxE rpred_sum// => k _; rewrite rpredM. Qed.

Lemma gap_at (z : 'cV[C]_n) (f : 'cV[C]_r) : real_mx z -> real_mx f ->
  form products (U *m z) + form Theta f -
    (((U *m z)^H *m means *m f) 0 0 + (((U *m z)^H *m means *m f) 0 0)^*) = - gap_of z f.
Proof.
rewrite /gap_of => rz rf; move: (U *m z) (real_seen rz) => v rv.
have em : (v^H *m means *m f) 0 0 = \sum_k theta 0 k * (a 0 k + b 0 k) * half * (v k 0 * f k 0).
  rewrite mxE; apply: eq_bigr => k _; rewrite mul_mx_diag !mxE (CrealP (rv k 0)).
  by rewrite [LHS]mulrAC [RHS]mulrC.
have ec : ((v^H *m means *m f) 0 0)^* = (v^H *m means *m f) 0 0.
  by apply/CrealP; rewrite em rpred_sum// => k _; rewrite !(rpredM, rpredD, rpredV) ?real_theta ?ra ?rb ?rv ?rf ?rpred1.
rewrite ec em !form_diag -!big_split /= -sumrB -sumrN; apply: eq_bigr => k _.
rewrite mxE !sqr_norm (CrealP (rv k 0)) (CrealP (rf k 0)).
by apply: (abs_sector (ring_of_R C)); rewrite -[half]div1r -splitr.
Qed.

Lemma decrease_continuous_at (z : 'cV[C]_n) (f : 'cV[C]_r) : real_mx z -> real_mx f ->
  form decrease_continuous (col_mx z f) =
  - ((z^H *m P *m (M0 *m z + E *m f)) 0 0 + ((z^H *m P *m (M0 *m z + E *m f)) 0 0)^*) - gap_of z f.
Proof.
move=> rz rf; rewrite -gap_at// /decrease_continuous; move: M0 => X.
rewrite form_block; last 2 first.
- by rewrite adjD adjN adjD !adjM adj_P !adjK adj_products mulmxA [X^H *m P + _]addrC.
- exact: adj_theta.
rewrite formD form_sub (form_rate pP).
rewrite mulmxN mulNmx entry_opp mulmxDr mulmxDl entry_sum mulmxDr entry_sum !adjM !mulmxA !rmorphN !rmorphD.
exact: (abs_falls (ring_of_R C)).
Qed.

Lemma decrease_discrete_at (z : 'cV[C]_n) (f : 'cV[C]_r) : real_mx z -> real_mx f ->
  form decrease_discrete (col_mx z f) = form P z - form P (M0 *m z + E *m f) - gap_of z f.
Proof.
move=> rz rf; rewrite -gap_at// /decrease_discrete; move: M0 => X.
rewrite form_block; last 2 first.
- by rewrite adjD adjB !adjM adj_P !adjK adj_products !mulmxA.
- by rewrite adjB adj_theta !adjM adjK adj_P mulmxA.
rewrite !formD !formN !form_sub (form_sum _ _ adj_P).
rewrite mulmxN mulNmx entry_opp mulmxDr mulmxDl entry_sum !adjM !mulmxA !rmorphN !rmorphD.
exact: (abs_falls_discrete (ring_of_R C)).
Qed.

Lemma gap_ge0 z f : within z f -> 0 <= gap_of z f.
Proof. by move=> w; rewrite sumr_ge0// => k _; rewrite mulr_ge0 ?w// ltW. Qed.

(* A positive definite form of z and f is at least a multiple of the form of P at z. *)
Lemma falls (D : 'M[C]_(n + r)) : posdef D ->
  exists2 e, 0 < e & forall (z : 'cV[C]_n) (f : 'cV[C]_r), e * form P z <= form D (col_mx z f).
Proof.
move=> /posdef_margin[e e0 h]; have t0 : 0 <= \tr P.
  by have := psd_trace (posdef_psd pP) (@form1_ge0 C n); rewrite mulmx1.
have t1 : 0 < 1 + \tr P by rewrite ltr_paddr ?ltr01.
exists (e / (1 + \tr P)) => [|z f]; first by rewrite divr_gt0.
apply: le_trans (h _); rewrite -mulrA ler_wpmul2l ?(ltW e0)// ler_pdivr_mull//.
apply: le_trans (trace_bound z (posdef_psd pP)) _.
apply: (@le_trans _ _ (\tr P * form 1%:M (col_mx z f))).
  rewrite ler_wpmul2l// !form1 big_split_ord /=.
  have -> : \sum_i `|col_mx z f (lshift r i) 0| ^+ 2 = \sum_i `|z i 0| ^+ 2 by apply: eq_bigr => i _; rewrite col_mxEu.
  by rewrite ler_addl sumr_ge0// => i _; rewrite exprn_ge0.
by rewrite ler_wpmul2r ?form1_ge0// ler_addr ler01.
Qed.

(* Along z' = M0 z + E f, the form z'Pz falls at least as fast as e z'Pz, so that it tends to 0 exponentially. *)
Theorem sector_continuous : posdef decrease_continuous ->
  exists2 e, 0 < e & forall (z rate : 'cV[C]_n) (f : 'cV[C]_r), real_mx z -> real_mx f -> within z f ->
    rate = M0 *m z + E *m f -> (rate^H *m P *m z + z^H *m P *m rate) 0 0 <= - (e * form P z).
Proof.
move=> /falls[e e0 h]; exists e => // z rate f rz rf w er.
rewrite entry_sum; have -> : (rate^H *m P *m z) 0 0 = ((z^H *m P *m rate) 0 0)^*.
  have -> : rate^H *m P *m z = (z^H *m P *m rate)^H by rewrite !adjM adjK adj_P mulmxA.
  by rewrite [LHS]mxE [in LHS]mxE.
rewrite ler_oppr addrC; apply: le_trans (h z f) _.
by rewrite decrease_continuous_at// -er ger_addl oppr_le0 gap_ge0.
Qed.

(* z'Pz falls at least by a factor in each step. *)
Theorem sector_discrete : posdef decrease_discrete ->
  exists rho, [/\ 0 <= rho, rho < 1 & forall (z : nat -> 'cV[C]_n) (f : nat -> 'cV[C]_r),
    (forall t, [/\ real_mx (z t), real_mx (f t), within (z t) (f t) & z t.+1 = M0 *m z t + E *m f t]) ->
    forall t, form P (z t) <= rho ^+ t * form P (z 0%N)].
Proof.
move=> /falls[e e0 h]; have e1 : 0 < 1 + e by rewrite addr_gt0 ?ltr01.
have r0 : 0 <= (1 + e)^-1 by rewrite invr_ge0 ltW.
exists (1 + e)^-1; split=> // [|z f sol]; first by rewrite invf_lt1// ltr_addl.
elim=> [|t IH]; first by rewrite expr0 mul1r.
have [rz rf w ez] := sol t; apply: (@le_trans _ _ ((1 + e)^-1 * form P (z t))); last first.
  by rewrite exprS -mulrA ler_wpmul2l.
rewrite ez ler_pdivl_mull// mulrDl mul1r; set next := M0 *m z t + E *m f t.
have le : form P next <= form P (z t) - e * form P (z t).
  rewrite ler_subr_addr -ler_subr_addl (le_trans (h (z t) (f t)))// decrease_discrete_at// -/next.
  by rewrite ger_addl oppr_le0 gap_ge0.
have up : form P next <= form P (z t) by apply: le_trans le _; rewrite ger_addl oppr_le0 mulr_ge0 ?(posdef_psd pP)// ltW.
by have := ler_add le (ler_wpmul2l (ltW e0) up); rewrite subrK.
Qed.
End Nonlinear.
End Performance.
