(* checker/loops.py: kind `stability`, by Lyapunov matrices, as a whole and by blocks, and the rule
   for instability.  The rule by the characteristic polynomial is in_region_continuous and
   in_region_discrete in routh_integers.v.

   C is a closed field such as algC; M, P, R are real, seen in C; x^H is the conjugate transpose. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import controllability location.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Stability.
Variable C : numClosedFieldType.

Definition adjoint a b (X : 'M[C]_(a, b)) : 'M[C]_(b, a) := map_mx conjC X^T.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").

Lemma adjM a b c (X : 'M[C]_(a, b)) (Y : 'M_(b, c)) : (X *m Y)^H = Y^H *m X^H.
Proof. by rewrite /adjoint trmx_mul map_mxM. Qed.
Lemma adjK a b (X : 'M[C]_(a, b)) : X^H^H = X.
Proof. by apply/matrixP=> i j; rewrite !mxE conjCK. Qed.
Lemma adjZ a b k (X : 'M[C]_(a, b)) : (k *: X)^H = k^* *: X^H.
Proof. by apply/matrixP=> i j; rewrite !mxE rmorphM. Qed.
Lemma adjD a b (X Y : 'M[C]_(a, b)) : (X + Y)^H = X^H + Y^H.
Proof. by apply/matrixP=> i j; rewrite !mxE rmorphD. Qed.

Definition real_mx a b (X : 'M[C]_(a, b)) := forall i j, X i j \is Num.real.
Lemma adj_real a b (X : 'M[C]_(a, b)) : real_mx X -> X^H = X^T.
Proof. by move=> rX; apply/matrixP=> i j; rewrite !mxE (CrealP (rX _ _)). Qed.

(* The value of the form at a column, and positive definiteness. *)
Definition form n (P : 'M[C]_n) (x : 'cV[C]_n) : C := (x^H *m P *m x) 0 0.
Definition posdef n (P : 'M[C]_n) := forall x, x != 0 -> 0 < form P x.

(* Strict diagonal dominance with positive diagonal. *)
Definition dominant n (N : 'M[C]_n) := forall i, \sum_(j | j != i) `|N i j| < N i i.

Lemma formE n (N : 'M[C]_n) x : form N x = \sum_i \sum_j (x i 0)^* * N i j * x j 0.
Proof.
rewrite /form mxE exchange_big /=; apply: eq_bigr => j _; rewrite mxE mulr_suml.
by apply: eq_bigr => i _; rewrite !mxE.
Qed.

Lemma amgm (a b : C) : 0 <= a -> 0 <= b -> a * b <= (a ^+ 2 + b ^+ 2) / 2%:R.
Proof.
move=> a0 b0; rewrite ler_pdivl_mulr ?ltr0n// -subr_ge0.
have -> : a ^+ 2 + b ^+ 2 - a * b * 2%:R = (a - b) ^+ 2.
  by rewrite sqrrB mulr_natr addrAC.
by apply: real_exprn_even_ge0; rewrite // rpredB ?ger0_real.
Qed.

Lemma form_conj n (N : 'M[C]_n) x : (form N x)^* = form N^H x.
Proof.
have -> : (form N x)^* = ((x^H *m N *m x)^H) 0 0 by rewrite [RHS]mxE mxE.
by rewrite !adjM adjK mulmxA.
Qed.

(* Diagonal dominance is positive definiteness. *)
Lemma dominant_posdef n (N : 'M[C]_n) : N^H = N -> dominant N -> posdef N.
Proof.
move=> sN dN x nx.
have symm i j : `|N i j| = `|N j i|.
  by have /matrixP/(_ i j) := sN; rewrite !mxE => <-; rewrite norm_conjC.
have Nii i : 0 < N i i by apply: le_lt_trans (dN i); apply: sumr_ge0.
pose T := \sum_i N i i * `|x i 0| ^+ 2.
pose U := \sum_i \sum_(j | j != i) (x i 0)^* * N i j * x j 0.
have eF : form N x = T + U.
  rewrite formE -big_split; apply: eq_bigr => i _ /=; rewrite (bigD1 i)//=; congr (_ + _).
  by rewrite mulrAC sqr_norm mulrC [_^* * _]mulrC.
have rF : form N x \is Num.real by rewrite CrealE form_conj sN.
have rT : T \is Num.real.
  by apply: rpred_sum => i _; rewrite rpredM ?ger0_real ?exprn_ge0// ltW.
have rU : U \is Num.real by rewrite -[U](addKr T) addrC rpredB// -eF.
have lt : \sum_i \sum_(j | j != i) `|N i j| * `|x i 0| ^+ 2 < T.
  have [i0 ni0] : exists i, x i 0 != 0.
    apply/existsP; apply: contraR nx; rewrite negb_exists => /forallP z.
    by apply/eqP/matrixP=> i j; rewrite ord1 mxE; have := z i; rewrite negbK => /eqP.
  have le i : \sum_(j | j != i) `|N i j| * `|x i 0| ^+ 2 <= N i i * `|x i 0| ^+ 2.
    by rewrite -mulr_suml ler_wpmul2r ?exprn_ge0// ltW.
  rewrite (bigD1 i0)//= /T [X in _ < X](bigD1 i0)//= ltr_le_add ?ler_sum//.
  by rewrite -mulr_suml ltr_pmul2r ?exprn_gt0 ?normr_gt0.
have leU : `|U| <= \sum_i \sum_(j | j != i) `|N i j| * `|x i 0| ^+ 2.
  apply: (@le_trans _ _ (\sum_i \sum_(j | j != i) `|N i j| * ((`|x i 0| ^+ 2 + `|x j 0| ^+ 2) / 2%:R))).
    apply: le_trans (ler_norm_sum _ _ _) _; apply: ler_sum => i _.
    apply: le_trans (ler_norm_sum _ _ _) _; apply: ler_sum => j _.
    by rewrite !normrM norm_conjC [_ * `|N i j|]mulrC -mulrA ler_wpmul2l// amgm.
  have e : \sum_i \sum_(j | j != i) `|N i j| * `|x j 0| ^+ 2 =
           \sum_i \sum_(j | j != i) `|N i j| * `|x i 0| ^+ 2.
    rewrite (exchange_big_dep predT)//=; apply: eq_bigr => i _.
    by apply: eq_big => [j|j _]; rewrite ?[j == i]eq_sym// symm.
  have half (a b : C) : b = a -> a = (a + b) / 2%:R.
    by move=> ->; rewrite -mulr2n -[a *+ 2]mulr_natr mulfK// pnatr_eq0.
  rewrite [X in _ <= X](half _ _ e) -big_split mulr_suml.
  apply: ler_sum => i _; rewrite -big_split /= mulr_suml; apply: ler_sum => j _.
  by rewrite -mulrDr mulrA.
rewrite eF -(opprK U) subr_gt0; apply: le_lt_trans lt; apply: le_trans leU.
by rewrite -normrN real_ler_norm// rpredN.
Qed.

(* Rule "Lyapunov matrix": R^T P R dominant makes P positive definite; R is then nonsingular. *)
Theorem dominant_congruence n (P R : 'M[C]_n) : real_mx P -> real_mx R -> P^T = P ->
  dominant (R^T *m P *m R) -> posdef P.
Proof.
move=> rP rR sP dN; have hP : P^H = P by rewrite adj_real.
have hN : (R^T *m P *m R)^H = R^T *m P *m R.
  by rewrite -(adj_real rR) !adjM hP adjK mulmxA.
have pd := dominant_posdef hN dN.
have uR : R \in unitmx.
  rewrite -unitmx_tr -row_free_unit -kermx_eq0; apply/negPn/negP => /rowV0Pn[w /sub_kermxP e nw].
  have := pd w^T; rewrite trmx_eq0 => /(_ nw); rewrite /form -!mulmxA -[R *m w^T]trmxK trmx_mul trmxK e.
  by rewrite trmx0 !mulmx0 mxE ltxx.
move=> x nx; have ny : invmx R *m x != 0.
  by apply: contra nx => /eqP e; rewrite -[x](mulKVmx uR) e mulmx0.
have := pd _ ny; rewrite /form -(adj_real rR) !mulmxA -adjM !mulmxA mulmxV// mul1mx.
by rewrite -!mulmxA mulKVmx.
Qed.

Lemma right_eigenvector n (M : 'M[C]_n) lambda : eigenvalue M lambda ->
  exists2 v : 'cV[C]_n, v != 0 & M *m v = lambda *: v.
Proof.
case/eigenvalueP=> w e nw; have : \det (M - lambda%:M) == 0.
  by apply/det0P; exists w => //; rewrite mulmxBr e mul_mx_scalar subrr.
rewrite -det_tr => /det0P[v nv ev]; exists v^T; first by rewrite trmx_eq0.
have := congr1 trmx ev; rewrite trmx_mul trmxK trmx0 mulmxBl mul_scalar_mx => /eqP.
by rewrite subr_eq0 => /eqP.
Qed.

Section Eigen.
Variables (n : nat) (M P : 'M[C]_n) (v : 'cV[C]_n) (lambda : C).
Hypothesis e : M *m v = lambda *: v.
Lemma form_left b (X : 'M[C]_(n, b)) : v^H *m (M^H *m X) = lambda^* *: (v^H *m X).
Proof. by rewrite mulmxA -adjM e adjZ -scalemxAl. Qed.
Lemma form_right a (X : 'M[C]_(a, n)) : X *m M *m v = lambda *: (X *m v).
Proof. by rewrite -mulmxA e -scalemxAr. Qed.
Lemma form_scale k : v^H *m (k *: P) *m v = k *: (v^H *m P *m v).
Proof. by rewrite -scalemxAr -scalemxAl. Qed.
End Eigen.

(* Rule "Lyapunov", continuous time: every eigenvalue has real part below -alpha. *)
Theorem lyapunov_continuous n (M P : 'M[C]_n) alpha : alpha \is Num.real -> posdef P ->
  posdef (- (M^H *m P + P *m M + (alpha *+ 2) *: P)) ->
  forall lambda, eigenvalue M lambda -> 'Re lambda < - alpha.
Proof.
move=> ra pP pQ lambda /right_eigenvector[v nv e].
have p0 := pP v nv; have := pQ v nv.
have -> : form (- (M^H *m P + P *m M + alpha *+ 2 *: P)) v =
    - (lambda^* + lambda + alpha *+ 2) * form P v.
  rewrite /form mulmxN mulNmx !mulmxDr !mulmxDl (form_left e) mulmxA (form_right e) form_scale -scalemxAl.
  by rewrite -!scalerDl mulNr mxE [in LHS]mxE.
rewrite pmulr_lgt0// oppr_gt0 => h.
rewrite -subr_gt0 -oppr_lt0 opprB opprK -(@pmulrn_llt0 _ _ 2)// mulrnDl.
have -> : 'Re lambda *+ 2 = lambda^* + lambda; last exact: h.
by rewrite ReE -[_ / _ *+ 2]mulr_natr divfK ?pnatr_eq0// addrC.
Qed.

(* Rule "Lyapunov", discrete time: every eigenvalue has modulus below rho. *)
Theorem lyapunov_discrete n (M P : 'M[C]_n) rho : 0 <= rho -> posdef P ->
  posdef ((rho ^+ 2) *: P - M^H *m P *m M) ->
  forall lambda, eigenvalue M lambda -> `|lambda| < rho.
Proof.
move=> r0 pP pQ lambda /right_eigenvector[v nv e].
have p0 := pP v nv; have := pQ v nv.
have -> : form (rho ^+ 2 *: P - M^H *m P *m M) v = (rho ^+ 2 - `|lambda| ^+ 2) * form P v.
  rewrite /form mulmxBr mulmxBl form_scale -[M^H *m P *m M]mulmxA (form_left e) mulmxA.
  by rewrite -scalemxAl (form_right e) scalerA -scalerBl mxE sqr_norm [lambda * _]mulrC.
by rewrite pmulr_lgt0// subr_gt0 ltr_pexpn2r ?nnegrE.
Qed.

(* Kind `stability`, one block: P and R as the checker reads them, then R2 for the derivative. *)
Theorem stability_continuous n (M P R R2 : 'M[C]_n) alpha :
  real_mx M -> real_mx P -> real_mx R -> real_mx R2 -> alpha \is Num.real -> P^T = P ->
  dominant (R^T *m P *m R) ->
  dominant (R2^T *m - (M^T *m P + P *m M + (alpha *+ 2) *: P) *m R2) ->
  forall lambda, eigenvalue M lambda -> 'Re lambda < - alpha.
Proof.
move=> rM rP rR rR2 ra sP d1 d2; apply: (lyapunov_continuous ra (dominant_congruence rP rR sP d1)).
have rk (X : 'M[C]_n) (Y : 'M[C]_n) : real_mx X -> real_mx Y -> real_mx (X *m Y).
  by move=> rX rY i j; rewrite mxE rpred_sum// => k _; rewrite rpredM.
rewrite (adj_real rM); apply: dominant_congruence rR2 _ d2.
  move=> i j; rewrite !mxE; rewrite rpredN !rpredD ?rpredM ?rpredMn ?rP ?ra//.
    by rewrite rpred_sum// => k _; rewrite rpredM// mxE.
  by rewrite rpred_sum// => k _; rewrite rpredM.
rewrite linearN !linearD /= linearZ /= !trmx_mul trmxK sP; congr (_ - _); exact: addrC.
Qed.

Theorem stability_discrete n (M P R R2 : 'M[C]_n) rho :
  real_mx M -> real_mx P -> real_mx R -> real_mx R2 -> 0 <= rho -> P^T = P ->
  dominant (R^T *m P *m R) -> dominant (R2^T *m (rho ^+ 2 *: P - M^T *m P *m M) *m R2) ->
  forall lambda, eigenvalue M lambda -> `|lambda| < rho.
Proof.
move=> rM rP rR rR2 r0 sP d1 d2; apply: (lyapunov_discrete r0 (dominant_congruence rP rR sP d1)).
rewrite (adj_real rM); apply: dominant_congruence rR2 _ d2.
  have rk (X Y : 'M[C]_n) : real_mx X -> real_mx Y -> real_mx (X *m Y).
    by move=> rX rY i j; rewrite mxE rpred_sum// => k _; rewrite rpredM.
  have rMT : real_mx M^T by move=> i j; rewrite mxE.
  move=> i j; have h := rk _ _ (rk _ _ rMT rP) rM i j; rewrite mxE rpredD//.
    by rewrite mxE rpredM// rpredX// ger0_real.
  by rewrite mxE rpredN.
by rewrite linearB /= linearZ /= !trmx_mul trmxK sP mulmxA.
Qed.

(* Rule "blocks": M T = T Delta with T nonsingular and Delta block upper triangular; applied again to
   the last block for more than two. *)
Theorem stability_blocks a b (M T : 'M[C]_(a + b)) (D1 : 'M_a) (D12 : 'M_(a, b)) (D2 : 'M_b)
    (region : C -> Prop) :
  T \in unitmx -> M *m T = T *m block_mx D1 D12 0 D2 ->
  (forall lambda, eigenvalue D1 lambda -> region lambda) ->
  (forall lambda, eigenvalue D2 lambda -> region lambda) ->
  forall lambda, eigenvalue M lambda -> region lambda.
Proof.
move=> uT e r1 r2 lambda; rewrite eigenvalue_root_char.
have <- : char_poly (block_mx D1 D12 0 D2) = char_poly M.
  apply: (@char_poly_similar _ _ _ _ _ (invmx T)).
  - by rewrite row_free_unit unitmx_inv.
  - by rewrite row_full_unit unitmx_inv.
  - by rewrite -[LHS](mulmxK uT) -[_ *m M *m T]mulmxA e mulKmx.
rewrite /char_poly /char_poly_mx map_block_mx scalar_mx_block opp_block_mx add_block_mx /= map_mx0 subr0.
rewrite det_ublock rootM => /orP[h|h]; [apply: r1 | apply: r2]; by rewrite eigenvalue_root_char.
Qed.
End Stability.
