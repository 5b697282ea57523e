(* checker/loops.py, method `instability`: if the form of P decreases along M and is not positive at
   some v != 0, then M is not stable; for a stable M would make P positive definite (one half of the
   inertia theorem), by splitting off one eigenvector at a time. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import controllability location stability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Instability.
Variable C : numClosedFieldType.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").

Lemma exists_eigenvalue n (M : 'M[C]_n.+1) : exists lambda, eigenvalue M lambda.
Proof.
have [x rx] : exists x, root (char_poly M) x by apply/closed_rootP; rewrite size_char_poly.
by exists x; rewrite eigenvalue_root_char.
Qed.

(* A basis whose first column is u, the others P-orthogonal to u. *)
Lemma split_basis n (P : 'M[C]_n.+1) (u : 'cV[C]_n.+1) : form P u != 0 ->
  exists W : 'M[C]_(n.+1, n), u^H *m P *m W = 0 /\ (row_mx u W : 'M_(n.+1, 1 + n)) \in unitmx.
Proof.
move=> fu; pose r := u^H *m P; pose K := kermx r^T.
have rn : r != 0 by apply: contraNneq fu => r0; rewrite /form -/r r0 mul0mx mxE.
have rK : \rank K = n by rewrite mxrank_ker mxrank_tr rank_rV rn subn1.
pose W := (castmx (rK, erefl _) (row_base K))^T.
have rW : r *m W = 0.
  apply: trmx_inj; rewrite trmx_mul trmxK trmx0; apply/sub_kermxP.
  by rewrite (eqmx_cast (row_base K)) eq_row_base.
have fW : row_free W^T.
  by rewrite /row_free trmxK (eqmx_cast (row_base K)) (eq_row_base K) rK.
exists W; split=> //; rewrite -unitmx_tr -row_free_unit -kermx_eq0; apply/negPn/negP.
case/rowV0Pn=> y /sub_kermxP ey /negP; apply.
pose a := lsubmx (y : 'rV_(1 + n)); pose b := rsubmx (y : 'rV_(1 + n)).
have e : a *m u^T + b *m W^T = 0 by rewrite -mul_row_col hsubmxK -tr_row_mx.
have a0 : a = 0.
  have := congr1 (fun X => X *m r^T) e; rewrite /= mul0mx mulmxDl -!mulmxA -!trmx_mul rW trmx0 mulmx0 addr0.
  rewrite [r *m u]mx11_scalar -/(form P u) tr_scalar_mx mul_mx_scalar => /eqP.
  by rewrite scalemx_eq0 (negPf fu) => /eqP.
move: e; rewrite a0 mul0mx add0r => e; have b0 : b = 0 by apply: (row_free_inj fW); rewrite e mul0mx.
have -> : y = row_mx a b by rewrite hsubmxK.
by rewrite a0 b0 row_mx0.
Qed.

(* The step: M in that basis, and what it keeps. *)
Lemma split_step n (M P : 'M[C]_n.+1) u (W : 'M[C]_(n.+1, n)) lambda : P^H = P -> M *m u = lambda *: u ->
  u^H *m P *m W = 0 -> (row_mx u W : 'M_(n.+1, 1 + n)) \in unitmx ->
  exists (c : 'M_(1, n)) (N : 'M_n), [/\ M *m W = u *m c + W *m N,
    (forall mu, eigenvalue N mu -> eigenvalue M mu) &
    (forall x, exists a y, x = a *: u + W *m y /\ form P x = `|a| ^+ 2 * form P u + form (W^H *m P *m W) y)].
Proof.
move=> hP eu oW uG; pose G : 'M_(n.+1, 1 + n) := row_mx u W.
pose X : 'M_(1 + n, n) := invmx G *m (M *m W); exists (usubmx X), (dsubmx X).
have eMW : M *m W = u *m usubmx X + W *m dsubmx X.
  by rewrite -mul_row_col vsubmxK /X mulKVmx.
have oW' : W^H *m P *m u = 0.
  by have := congr1 (@adjoint C _ _) oW; rewrite !adjM adjK hP mulmxA => ->; rewrite /adjoint trmx0 map_mx0.
split=> // [mu|x].
  rewrite !eigenvalue_root_char => rN.
  pose D : 'M_(1 + n) := block_mx lambda%:M (usubmx X) 0 (dsubmx X).
  have eG : M *m G = G *m D.
    by rewrite mul_mx_row mul_row_block mulmx0 addr0 mul_mx_scalar eu -eMW.
  have <- : char_poly D = char_poly M.
    apply: (@char_poly_similar _ _ _ _ _ (invmx G)).
    - by rewrite row_free_unit unitmx_inv.
    - by rewrite row_full_unit unitmx_inv.
    - by rewrite -[LHS](mulmxK uG) -[_ *m M *m G]mulmxA eG mulKmx.
  rewrite /char_poly /char_poly_mx map_block_mx scalar_mx_block opp_block_mx add_block_mx /= map_mx0 subr0.
  by rewrite det_ublock rootM -/(char_poly_mx (dsubmx X)) -/(char_poly (dsubmx X)) rN orbT.
pose z : 'cV_(1 + n) := invmx G *m x; exists (usubmx z 0 0), (dsubmx z).
have ex : x = usubmx z 0 0 *: u + W *m dsubmx z.
  rewrite -mul_mx_scalar -mx11_scalar -mul_row_col vsubmxK /z mulKVmx//.
split=> //; set a := usubmx z 0 0 in ex *; set y := dsubmx z in ex *.
have c1 : (a *: u)^H *m P *m (W *m y) = 0 by rewrite adjZ -!scalemxAl mulmxA oW mul0mx scaler0.
have c2 : (W *m y)^H *m P *m (a *: u) = 0.
  by rewrite adjM -scalemxAr -!mulmxA (mulmxA W^H) oW' mulmx0 scaler0.
rewrite {1}ex /form adjD !mulmxDl !mulmxDr c1 c2 addr0 add0r mxE; congr (_ + _).
  by rewrite adjZ -!scalemxAl -scalemxAr scalerA mxE sqr_norm [a * _]mulrC.
by rewrite adjM !mulmxA.
Qed.

Lemma form_adj n (P : 'M[C]_n) : P^H = P -> forall a (W : 'M[C]_(n, a)), (W^H *m P *m W)^H = W^H *m P *m W.
Proof. by move=> hP a W; rewrite !adjM adjK hP mulmxA. Qed.

Lemma form_sub n a (Q : 'M[C]_n) (W : 'M[C]_(n, a)) y : form (W^H *m Q *m W) y = form Q (W *m y).
Proof. by rewrite /form adjM !mulmxA. Qed.

Lemma posdef_split n (P : 'M[C]_n.+1) u (W : 'M[C]_(n.+1, n)) : 0 < form P u ->
  posdef (W^H *m P *m W) ->
  (forall x, exists a y, x = a *: u + W *m y /\ form P x = `|a| ^+ 2 * form P u + form (W^H *m P *m W) y) ->
  posdef P.
Proof.
move=> pu pW sp x nx; have [a [y [ex ->]]] := sp x.
have [y0|ny] := eqVneq y 0.
  have na : a != 0 by apply: contra nx => /eqP a0; rewrite ex a0 y0 scale0r mulmx0 addr0.
  by rewrite y0 /form mulmx0 [X in _ + X]mxE addr0 mulr_gt0// exprn_gt0// normr_gt0.
by rewrite ltr_paddl// ?pW// mulr_ge0 ?exprn_ge0// ltW.
Qed.

(* Continuous time: a stable M and a decreasing form make P positive definite. *)
Lemma continuous_posdef n (M P : 'M[C]_n) a : P^H = P ->
  posdef (- (M^H *m P + P *m M + a *: P)) ->
  (forall lambda, eigenvalue M lambda -> lambda^* + lambda + a < 0) -> posdef P.
Proof.
elim: n M P => [|n IH] M P hP pQ st; first by move=> x; rewrite [x]flatmx0 eqxx.
have [lambda el] := exists_eigenvalue M; have [u nu eu] := right_eigenvector el.
have pu : 0 < form P u.
  have := pQ u nu; have -> : form (- (M^H *m P + P *m M + a *: P)) u = - (lambda^* + lambda + a) * form P u.
    rewrite /form mulmxN mulNmx !mulmxDr !mulmxDl (form_left eu) mulmxA (form_right eu) form_scale -scalemxAl.
    by rewrite -!scalerDl mulNr mxE [in LHS]mxE.
  by rewrite pmulr_rgt0// oppr_gt0 st.
have [W [oW uG]] := split_basis (lt0r_neq0 pu).
have [c [N [eMW eN sp]]] := split_step hP eu oW uG.
have oW' : W^H *m P *m u = 0.
  by have := congr1 (@adjoint C _ _) oW; rewrite !adjM adjK hP mulmxA => ->; rewrite /adjoint trmx0 map_mx0.
have nW (y : 'cV[C]_n) : y != 0 -> W *m y != 0.
  apply: contra => /eqP Wy; have : (row_mx u W : 'M_(n.+1, 1 + n)) *m col_mx 0 y = 0.
    by rewrite mul_row_col mulmx0 add0r.
  by move/(congr1 (mulmx (invmx (row_mx u W : 'M_(n.+1, 1 + n))))); rewrite mulKmx// mulmx0 => e0;
    have := congr1 (fun X : 'M_(1 + n, 1) => dsubmx X) e0; rewrite col_mxKd => ->; rewrite linear0.
apply: posdef_split pu _ sp; apply: (IH N); first exact: form_adj.
  have e : W^H *m P *m M *m W = W^H *m P *m W *m N.
    by rewrite -mulmxA eMW mulmxDr !mulmxA oW' mul0mx add0r.
  have e' : W^H *m M^H *m P *m W = N^H *m (W^H *m P *m W).
    by have := congr1 (@adjoint C _ _) e; rewrite !adjM adjK hP !mulmxA.
  have -> : - (N^H *m (W^H *m P *m W) + W^H *m P *m W *m N + a *: (W^H *m P *m W)) =
      W^H *m (- (M^H *m P + P *m M + a *: P)) *m W.
    rewrite mulmxN mulNmx !mulmxDr !mulmxDl -e -e' !mulmxA; congr (- (_ + _)).
    by rewrite -scalemxAr -scalemxAl.
  by move=> y ny; rewrite form_sub pQ// nW.
by move=> mu /eN/st.
Qed.

(* Rule "instability", continuous time. *)
Theorem instability_continuous n (M P : 'M[C]_n) alpha v : P^H = P ->
  posdef (- (M^H *m P + P *m M + (alpha *+ 2) *: P)) -> v != 0 -> form P v <= 0 ->
  ~ (forall lambda, eigenvalue M lambda -> 'Re lambda < - alpha).
Proof.
move=> hP pQ nv fv st; have pP : posdef P.
  apply: (continuous_posdef hP pQ) => lambda /st h.
  have -> : lambda^* + lambda = 'Re lambda *+ 2.
    by rewrite ReE -[_ / _ *+ 2]mulr_natr divfK ?pnatr_eq0// addrC.
  by rewrite -mulrnDl pmulrn_llt0// -subr_lt0 opprK in h *.
by have := le_lt_trans fv (pP v nv); rewrite ltxx.
Qed.

(* Discrete time. *)
Lemma discrete_posdef n (M P : 'M[C]_n) r : P^H = P -> posdef (r *: P - M^H *m P *m M) ->
  (forall lambda, eigenvalue M lambda -> `|lambda| ^+ 2 < r) -> posdef P.
Proof.
elim: n M P => [|n IH] M P hP pQ st; first by move=> x; rewrite [x]flatmx0 eqxx.
have [lambda el] := exists_eigenvalue M; have [u nu eu] := right_eigenvector el.
have pu : 0 < form P u.
  have := pQ u nu; have -> : form (r *: P - M^H *m P *m M) u = (r - `|lambda| ^+ 2) * form P u.
    rewrite /form mulmxBr mulmxBl form_scale -[M^H *m P *m M]mulmxA (form_left eu) mulmxA.
    by rewrite -scalemxAl (form_right eu) scalerA -scalerBl mxE sqr_norm [lambda * _]mulrC.
  by rewrite pmulr_rgt0// subr_gt0 st.
have [W [oW uG]] := split_basis (lt0r_neq0 pu).
have [c [N [eMW eN sp]]] := split_step hP eu oW uG.
have oW' : W^H *m P *m u = 0.
  by have := congr1 (@adjoint C _ _) oW; rewrite !adjM adjK hP mulmxA => ->; rewrite /adjoint trmx0 map_mx0.
have nW (y : 'cV[C]_n) : y != 0 -> W *m y != 0.
  apply: contra => /eqP Wy; have : (row_mx u W : 'M_(n.+1, 1 + n)) *m col_mx 0 y = 0.
    by rewrite mul_row_col mulmx0 add0r.
  by move/(congr1 (mulmx (invmx (row_mx u W : 'M_(n.+1, 1 + n))))); rewrite mulKmx// mulmx0 => e0;
    have := congr1 (fun X : 'M_(1 + n, 1) => dsubmx X) e0; rewrite col_mxKd => ->; rewrite linear0.
apply: (posdef_split pu _ sp); apply: (IH N); first exact: form_adj; last by move=> mu /eN/st.
have e : W^H *m (M^H *m P *m M) *m W =
    c^H *m (u^H *m P *m u) *m c + N^H *m (W^H *m P *m W) *m N.
  have -> : W^H *m (M^H *m P *m M) *m W = (M *m W)^H *m P *m (M *m W) by rewrite adjM !mulmxA.
  rewrite eMW adjD !adjM !mulmxDl !mulmxDr !mulmxA.
  rewrite -[c^H *m u^H *m P *m W]mulmxA -[c^H *m u^H *m (P *m W)]mulmxA [u^H *m (P *m W)]mulmxA oW mulmx0 mul0mx addr0.
  rewrite -[N^H *m W^H *m P *m u]mulmxA -[N^H *m W^H *m (P *m u)]mulmxA [W^H *m (P *m u)]mulmxA oW'.
  by rewrite mulmx0 mul0mx add0r.
move=> y ny; have -> : r *: (W^H *m P *m W) - N^H *m (W^H *m P *m W) *m N =
    W^H *m (r *: P - M^H *m P *m M) *m W + c^H *m (u^H *m P *m u) *m c.
  rewrite mulmxBr mulmxBl e -scalemxAr -scalemxAl opprD.
  by rewrite [- (c^H *m _ *m c) - _]addrC addrA subrK.
have fD (X Y : 'M[C]_n) : form (X + Y) y = form X y + form Y y.
  by rewrite /form mulmxDr mulmxDl mxE.
rewrite fD form_sub form_sub ltr_paddr ?pQ ?nW// formE !big_ord1 -/(form P u).
have -> (b : C) : b^* * form P u * b = form P u * `|b| ^+ 2.
  by rewrite sqr_norm mulrAC mulrC [b^* * b]mulrC.
by apply: mulr_ge0; [exact: (ltW pu) | rewrite exprn_ge0].
Qed.

(* Rule "instability", discrete time. *)
Theorem instability_discrete n (M P : 'M[C]_n) rho v : 0 <= rho -> P^H = P ->
  posdef ((rho ^+ 2) *: P - M^H *m P *m M) -> v != 0 -> form P v <= 0 ->
  ~ (forall lambda, eigenvalue M lambda -> `|lambda| < rho).
Proof.
move=> r0 hP pQ nv fv st; have pP : posdef P.
  by apply: (discrete_posdef hP pQ) => lambda /st h; rewrite ltr_pexpn2r ?nnegrE.
by have := le_lt_trans fv (pP v nv); rewrite ltxx.
Qed.
End Instability.
