(* A system without a part of its state: x modulo what no output shows, or within what the inputs move;
   used by the construction "modulo" of certificates.

   W has k independent rows; U and R are the columns of the identity at its pivots and at the other places,
   so that W U = 1 and every x is U U' x + R R' x.  On W x = 0, x = S R' x for S = R - U (W R). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import spectrum_split.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Modulo.
Variables (K : fieldType) (n k r p q d : nat).
Variables (A : 'M[K]_n) (B : 'M[K]_(n, p)) (C : 'M[K]_(q, n)).
Variables (W : 'M[K]_(k, n)) (Z : 'M[K]_k) (U : 'M[K]_(n, k)) (R : 'M[K]_(n, r)).
Hypothesis pivots : W *m U = 1%:M.
Hypothesis others : R^T *m R = 1%:M.
Hypothesis apart : R^T *m U = 0.
Hypothesis together : U *m U^T + R *m R^T = 1%:M.
Let S := R - U *m (W *m R).

Lemma W_S : W *m S = 0.
Proof. by rewrite mulmxBr mulmxA pivots mul1mx subrr. Qed.

Lemma R_S : R^T *m S = 1%:M.
Proof. by rewrite mulmxBr mulmxA apart mul0mx subr0. Qed.

(* what W does not see is on the subspace *)
Lemma on_subspace t (X : 'M_(n, t)) : W *m X = 0 -> X = S *m (R^T *m X).
Proof.
move=> WX; have e : U^T *m X = - (W *m R *m (R^T *m X)).
  apply/eqP; rewrite -addr_eq0 -{1}[U^T]mul1mx -pivots -!mulmxA -mulmxDr !mulmxA -mulmxDl together mul1mx.
  by rewrite WX.
by rewrite -[LHS]mul1mx -together mulmxDl -!mulmxA e mulmxN addrC /S mulmxBl -!mulmxA.
Qed.

Section Uncontrollable.
Hypothesis invariant : W *m A = Z *m W.
Hypothesis unmoved : W *m B = 0.

(* the loop with a controller z' = L z + J y, u = H z + G y of any dimension *)
Theorem uncontrollable_loop (G : 'M_(p, q)) (H : 'M_(p, d)) (J : 'M_(d, q)) (L : 'M_d) : n = (r + k)%N ->
  char_poly (block_mx (A + B *m G *m C) (B *m H) (J *m C) L) =
  char_poly Z * char_poly (block_mx (R^T *m A *m S + R^T *m B *m G *m (C *m S)) (R^T *m B *m H)
                                    (J *m (C *m S)) L).
Proof.
move=> en; have AS : A *m S = S *m (R^T *m (A *m S)).
  by apply: on_subspace; rewrite mulmxA invariant -mulmxA W_S mulmx0.
have BE : B = S *m (R^T *m B) by apply: on_subspace.
pose X : 'M_(n + d, r + d) := block_mx S 0 0 1%:M; pose Q : 'M_(k, n + d) := row_mx W 0.
rewrite mulrC; apply: (@char_poly_split _ _ (r + d) k X Q).
- by rewrite en addnAC.
- apply/row_fullP; exists (block_mx R^T 0 0 1%:M).
  by rewrite mulmx_block !(mulmx0, mul0mx, addr0, add0r, mul1mx) R_S -scalar_mx_block.
- by apply/row_freeP; exists (col_mx U 0); rewrite mul_row_col pivots mul0mx addr0.
- by rewrite mul_row_block W_S !(mulmx0, mul0mx, addr0) row_mx0.
- rewrite !mulmx_block !(mulmx0, mul0mx, addr0, add0r, mul1mx, mulmx1) mulmxDl mulmxDr.
  rewrite {1}AS [in LHS]BE !mulmxA.
  by [].
rewrite !mul_row_block !(mulmx0, mul0mx, addr0, add0r) mulmxDr invariant !mulmxA unmoved !mul0mx addr0.
by rewrite mul_mx_row mulmx0.
Qed.

Theorem uncontrollable_part (F : 'M_(p, q)) : n = (r + k)%N ->
  char_poly (A + B *m F *m C) = char_poly Z * char_poly (R^T *m A *m S + R^T *m B *m F *m (C *m S)).
Proof.
move=> en; have AS : A *m S = S *m (R^T *m (A *m S)).
  by apply: on_subspace; rewrite mulmxA invariant -mulmxA W_S mulmx0.
have BE : B = S *m (R^T *m B) by apply: on_subspace.
rewrite mulrC; apply: (@char_poly_split _ _ r k S W) => //; last first.
- by rewrite mulmxDr invariant !mulmxA unmoved !mul0mx addr0.
- by rewrite mulmxDl mulmxDr {1}AS [in LHS]BE !mulmxA.
- exact: W_S.
- by apply/row_freeP; exists U.
by apply/row_fullP; exists R^T; apply: R_S.
Qed.
End Uncontrollable.
End Modulo.

(* x modulo the span of the rows of W: the dual of what is above, for the dual system *)
Section Unobservable.
Variables (K : fieldType) (n k r p q d : nat).
Variables (A : 'M[K]_n) (B : 'M[K]_(n, p)) (C : 'M[K]_(q, n)).
Variables (W : 'M[K]_(k, n)) (Z : 'M[K]_k) (U : 'M[K]_(n, k)) (R : 'M[K]_(n, r)).
Hypothesis pivots : W *m U = 1%:M.
Hypothesis others : R^T *m R = 1%:M.
Hypothesis apart : R^T *m U = 0.
Hypothesis together : U *m U^T + R *m R^T = 1%:M.
Hypothesis invariant : W *m A^T = Z *m W.
Hypothesis unseen : W *m C^T = 0.
Let T := (R - U *m (W *m R))^T.

Lemma char_poly_tr m (M : 'M[K]_m) : char_poly M^T = char_poly M.
Proof. by rewrite /char_poly -[RHS]det_tr /char_poly_mx linearB /= tr_scalar_mx map_trmx. Qed.

Theorem unobservable_loop (G : 'M_(p, q)) (H : 'M_(p, d)) (J : 'M_(d, q)) (L : 'M_d) : n = (r + k)%N ->
  char_poly (block_mx (A + B *m G *m C) (B *m H) (J *m C) L) =
  char_poly Z * char_poly (block_mx (T *m A *m R + T *m B *m G *m (C *m R)) (T *m B *m H)
                                    (J *m (C *m R)) L).
Proof.
move=> en; rewrite -char_poly_tr tr_block_mx linearD /= !trmx_mul -!mulmxA mulmxA.
rewrite (uncontrollable_loop B^T pivots others apart together invariant unseen G^T J^T H^T L^T en).
congr (_ * _); rewrite -[LHS]char_poly_tr; congr char_poly.
by rewrite tr_block_mx linearD /= !trmx_mul !trmxK /T !mulmxA.
Qed.

Theorem unobservable_part (F : 'M_(p, q)) : n = (r + k)%N ->
  char_poly (A + B *m F *m C) = char_poly Z * char_poly (T *m A *m R + T *m B *m F *m (C *m R)).
Proof.
move=> en; rewrite -char_poly_tr linearD /= !trmx_mul mulmxA.
rewrite (uncontrollable_part B^T pivots others apart together invariant unseen F^T en).
congr (_ * _); rewrite -[LHS]char_poly_tr; congr char_poly.
by rewrite linearD /= !trmx_mul !trmxK /T !mulmxA.
Qed.
End Unobservable.
