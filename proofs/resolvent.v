(* The polynomials C adj(xI - A) B: their degrees, what A does to them, and that v adj(xI - A) b is
   every polynomial of degree < n if (A, b) is controllable.  The determinant of M - u v. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import joint_controllability.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Resolvent.
Variables (K : fieldType) (n : nat).
Implicit Types A : 'M[K]_n.

Lemma size_adj A i j : (size (\adj (char_poly_mx A) i j) <= n)%N.
Proof.
rewrite mxE /cofactor size_Msign; apply: leq_trans (size_sum _ _ _) _; apply/bigmax_leqP => s _.
rewrite size_Msign; apply: leq_trans (size_prod_leq _ _) _.
rewrite [#|_|]card_ord; apply: (@leq_trans ((n.-1 * 2).+1 - n.-1)).
  apply/leq_sub2r; rewrite ltnS; apply: (@leq_trans (\sum_(t < n.-1) 2)); last first.
    by rewrite sum_nat_const card_ord.
  apply: leq_sum => t _.
  rewrite !mxE; apply: leq_trans (size_add _ _) _; rewrite geq_max size_opp.
  rewrite (leq_trans (size_polyC_leq1 _)) // andbT; case: (_ == _); rewrite ?mulr0n ?size_poly0 //.
  by rewrite size_polyX.
have n0 : (0 < n)%N by apply: leq_trans (ltn_ord i).
by rewrite muln2 -addnn -addnS addKn prednK.
Qed.

Lemma size_transfer b c A (B : 'M_(n, b)) (C : 'M_(c, n)) i j :
  (size (transfer A B C i j) <= n)%N.
Proof.
rewrite mxE; apply: leq_trans (size_sum _ _ _) _; apply/bigmax_leqP => s _.
rewrite [map_mx _ _ _ _]mxE mulrC mul_polyC; apply: leq_trans (size_scale_leq _ _) _.
rewrite mxE; apply: leq_trans (size_sum _ _ _) _; apply/bigmax_leqP => t _.
by rewrite [map_mx _ _ _ _]mxE mul_polyC; apply: leq_trans (size_scale_leq _ _) (size_adj _ _ _).
Qed.

Lemma transfer_mull b c d A (B : 'M_(n, b)) (M : 'M_(d, c)) (C : 'M_(c, n)) :
  transfer A B (M *m C) = map_mx polyC M *m transfer A B C.
Proof. by rewrite /transfer map_mxM !mulmxA. Qed.

Lemma transfer_mulr b c d A (B : 'M_(n, b)) (M : 'M_(b, d)) (C : 'M_(c, n)) :
  transfer A (B *m M) C = transfer A B C *m map_mx polyC M.
Proof. by rewrite /transfer map_mxM !mulmxA. Qed.

Lemma transferDl b c A (B : 'M_(n, b)) (C C' : 'M_(c, n)) :
  transfer A B (C + C') = transfer A B C + transfer A B C'.
Proof. by rewrite /transfer map_mxD !mulmxDl. Qed.

Lemma transfer_tr b c A (B : 'M_(n, b)) (C : 'M_(c, n)) :
  (transfer A B C)^T = transfer A^T C^T B^T.
Proof.
rewrite /transfer !trmx_mul -!map_trmx mulmxA; congr (_ *m _ *m _).
by rewrite trmx_adj /char_poly_mx linearB /= tr_scalar_mx map_trmx.
Qed.

(* C A adj(xI - A) B = x C adj(xI - A) B - chi_A C B *)
Lemma transfer_shift b c A (B : 'M_(n, b)) (C : 'M_(c, n)) :
  transfer A B (C *m A) = 'X *: transfer A B C - char_poly A *: map_mx polyC (C *m B).
Proof.
have e : map_mx polyC A = 'X%:M - char_poly_mx A by rewrite /char_poly_mx opprB addrC subrK.
rewrite /transfer map_mxM e mulmxBr mul_mx_scalar !mulmxBl -!scalemxAl; congr (_ - _).
by rewrite -(mulmxA _ (char_poly_mx A)) mul_mx_adj mul_mx_scalar -scalemxAl map_mxM.
Qed.

(* every polynomial of degree < n is v adj(xI - A) b *)
Lemma transfer_onto A (b : 'cV_n) (r : {poly K}) : controllable A b -> (size r <= n)%N ->
  exists v : 'rV_n, transfer A b v 0 0 = r.
Proof.
move=> ctr sr; pose T : 'M_n := \matrix_(i, j) (transfer A b 1%:M i 0)`_j.
have vT (v : 'rV_n) : v *m T = poly_rV (transfer A b v 0 0).
  apply/rowP => j; rewrite [RHS]mxE -[v in RHS]mulmx1 transfer_mull !mxE coef_sum.
  by apply: eq_bigr => i _; rewrite !mxE coefCM.
have uT : T \in unitmx.
  rewrite -row_free_unit -kermx_eq0; apply/rowV0P => v /sub_kermxP; rewrite vT => e.
  move/rank_reachP: ctr; apply=> i ni; apply/eqP; apply: contraT => ne.
  have /matrix0Pn[a [c]] : transfer A b v != 0 by apply: transfer_markov; exists i; rewrite ni.
  by rewrite !ord1 -[_ 0 0](@poly_rV_K _ n) ?size_transfer // e raddf0 eqxx.
exists (poly_rV r *m invmx T); rewrite -[LHS](@poly_rV_K _ n) ?size_transfer // -vT.
by rewrite mulmxKV // poly_rV_K.
Qed.

(* det (M - u v) from a vector y with M y = det M u *)
Lemma det_rank_one (R : idomainType) r (M : 'M[R]_r) (u y : 'cV_r) (v : 'rV_r) :
  M *m y = \det M *: u -> \det M != 0 -> \det (M - u *m v) = \det M - (v *m y) 0 0.
Proof.
move=> e nz; have e1 : \det (block_mx M u v 1%:M) = \det (M - u *m v).
  have -> : block_mx M u v 1%:M = block_mx (M - u *m v) u 0 1%:M *m block_mx 1%:M 0 v 1%:M.
    by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r) subrK.
  by rewrite det_mulmx det_ublock det_lblock !det1 !mulr1.
apply: (mulIf nz); rewrite -e1.
have e2 : block_mx M u v 1%:M *m block_mx 1%:M (- y) 0 (\det M)%:M =
    block_mx M 0 v ((\det M)%:M - v *m y).
  rewrite mulmx_block !mulmx1 !mulmx0 !addr0 !mulmxN mul_mx_scalar e addNr.
  by rewrite mul_mx_scalar scalemx1 addrC.
have := congr1 determinant e2; rewrite det_mulmx det_ublock det_lblock det1 mul1r det_scalar1.
by move=> ->; rewrite mulrC; congr (_ * _); rewrite [X in \det X]mx11_scalar det_scalar1 !mxE eqxx.
Qed.

End Resolvent.
