(* checker/core/arithmetic.py, characteristic_polynomial_modulo (A3 of arithmetic.md): a matrix over
   a commutative ring is brought to Hessenberg form by A L = L H with L invertible, and det(xI - H) follows by
   a recursion on the columns of H.  No property of the ring but commutativity is used. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Similar.
Variable R : comUnitRingType.

(* A, after a common permutation s of rows and columns. *)
Theorem hessenberg_similar n (A L H : 'M[R]_n) (s : 'S_n) : L \in unitmx ->
  (\matrix_(i, j) A (s i) (s j)) *m L = L *m H -> char_poly A = char_poly H.
Proof.
move=> uL e; pose B := \matrix_(i, j) A (s i) (s j).
have -> : char_poly A = char_poly B.
  rewrite /char_poly -(mulr1 (\det _)).
  have -> : char_poly_mx B = row_perm s (col_perm s (char_poly_mx A)).
    by apply/matrixP=> i j; rewrite !mxE (inj_eq perm_inj).
  rewrite row_permE col_permE !det_mulmx !det_perm odd_permV mulr1 mulrC -mulrA.
  by rewrite -signr_addb addbb mulr1.
have e' : char_poly_mx B *m map_mx polyC L = map_mx polyC L *m char_poly_mx H.
  by rewrite /char_poly_mx mulmxBl mulmxBr -!map_mxM e scalar_mxC.
have eD : char_poly B * (\det L)%:P = char_poly H * (\det L)%:P.
  by have := congr1 determinant e'; rewrite !det_mulmx det_map_mx [RHS]mulrC.
have := congr1 (fun f => f * (\det L)^-1%:P) eD; rewrite -!mulrA -polyCM mulrV ?mulr1//.
Qed.
End Similar.

Section Recursion.
Variables (R : comRingType) (h : nat -> nat -> R) (b : nat -> R).

(* Column k holds h 0 k, ..., h k k, then b k. *)
Definition hessenberg n : 'M[R]_n :=
  \matrix_(i, j) (if (i <= j)%N then h i j else if i == j.+1 :> nat then b j else 0).

Section Sequence.
Variable p : nat -> {poly R}.
Hypotheses (p0 : p 0%N = 1)
  (pS : forall k, p k.+1 = 'X * p k - \sum_(i < k.+1) (h i k * \prod_(i <= t < k) b t) *: p i).

Lemma minor_hessenberg n : row' ord_max (col' ord_max (char_poly_mx (hessenberg n.+1))) = char_poly_mx (hessenberg n).
Proof. by apply/matrixP=> i j; rewrite !mxE !lift_max (inj_eq lift_inj). Qed.

(* A row that the matrix takes to p_(n+1) times the last unit row. *)
Let q n : 'rV[{poly R}]_n.+1 := \row_i ((\prod_(i <= t < n) b t) *: p i).

Lemma row_hessenberg n : q n *m char_poly_mx (hessenberg n.+1) = p n.+1 *: delta_mx 0 ord_max.
Proof.
apply/rowP=> k; rewrite !mxE /=.
have -> : \sum_j q n 0 j * char_poly_mx (hessenberg n.+1) j k =
    'X * q n 0 k - \sum_(j < n.+1) (if (j <= k)%N then h j k else if j == k.+1 :> nat then b k else 0) *: q n 0 j.
  rewrite -[X in X - _](_ : \sum_j q n 0 j * ('X *+ (j == k)) = _); last first.
    rewrite (bigD1 k)//= eqxx mulr1n mulrC big1 ?addr0// => j /negPf->.
    by rewrite mulr0n mulr0.
  rewrite -sumrB; apply: eq_bigr => j _; rewrite !mxE mulrBr; congr (_ - _).
  by rewrite mulrC mul_polyC.
pose chain i := \prod_(i <= t < n) b t; pose f j := if (j <= k)%N then h j k else if j == k.+1 then b k else 0.
have -> : \sum_(j < n.+1) f j *: q n 0 j = \sum_(0 <= j < n.+1) f j *: (chain j *: p j).
  by rewrite big_mkord; apply: eq_bigr => j _; rewrite mxE.
have kn : (k <= n)%N by rewrite -ltnS.
have low : \sum_(0 <= j < k.+1) f j *: (chain j *: p j) = chain k *: ('X * p k - p k.+1).
  rewrite pS opprB addrC subrK scaler_sumr big_mkord; apply: eq_bigr => j _.
  have jk : (j <= k)%N by rewrite -ltnS.
  by rewrite /f jk !scalerA /chain (big_cat_nat _ _ _ jk kn) /= mulrA mulrC.
rewrite (@big_cat_nat _ _ _ k.+1)//= low mxE -/(chain k) -scalerAr scalerBr opprD opprB addrA [_ *: ('X * _) + _]addrC subrK.
have [e|nk] := eqVneq k ord_max.
  by rewrite e /= big_geq// subr0 /chain big_geq// scale1r mulr1.
have kn' : (k < n)%N by rewrite ltn_neqAle kn andbT.
rewrite big_ltn// {1}/f ltnn eqxx big_nat_cond big1 => [|j].
  by rewrite addr0 scalerA /chain [in LHS]big_ltn// subrr mulr0.
rewrite andbT => /andP[kj _]; rewrite /f leqNgt (ltn_trans (ltnSn k) kj) /= gtn_eqF// scale0r.
by [].
Qed.

Lemma hessenberg_sequence n : char_poly (hessenberg n) = p n.
Proof.
elim: n => [|n IH]; first by rewrite /char_poly det_mx00 p0.
have e := row_hessenberg n; have := congr1 (fun r => (r *m \adj (char_poly_mx (hessenberg n.+1))) 0 ord_max) e.
rewrite -mulmxA mul_mx_adj mul_mx_scalar -scalemxAl !mxE big_geq// scale1r (bigD1 ord_max)//=.
rewrite !mxE !eqxx mul1r big1 ?addr0 => [|j /negPf nj]; last by rewrite mxE nj andbF mul0r.
rewrite /cofactor minor_hessenberg addnn -signr_odd odd_double mul1r -/(char_poly _) -/(char_poly _) IH.
have reg : GRing.rreg (p n) by apply: monic_rreg; rewrite -IH char_poly_monic.
exact: reg.
Qed.
End Sequence.

(* p_0, ..., p_n, each from those before it. *)
Fixpoint columns n : seq {poly R} := if n is k.+1 then let s := columns k in
  rcons s ('X * s`_k - \sum_(i < k.+1) (h i k * \prod_(i <= t < k) b t) *: s`_i) else [:: 1].
Definition hessenberg_poly n := (columns n)`_n.

Lemma size_columns n : size (columns n) = n.+1.
Proof. by elim: n => //= n IH; rewrite size_rcons IH. Qed.

Lemma nth_columns n i : (i <= n)%N -> (columns n)`_i = hessenberg_poly i.
Proof.
elim: n => [|n IH]; first by rewrite leqn0 => /eqP->.
rewrite leq_eqVlt => /predU1P[-> //|lt] /=.
by rewrite nth_rcons size_columns lt IH.
Qed.

Lemma hessenberg_polyS k : hessenberg_poly k.+1 = 'X * hessenberg_poly k - \sum_(i < k.+1) (h i k * \prod_(i <= t < k) b t) *: hessenberg_poly i.
Proof.
rewrite {1}/hessenberg_poly /= nth_rcons size_columns ltnn eqxx.
by rewrite nth_columns//; congr (_ - _); apply: eq_bigr => i _; rewrite nth_columns// -ltnS.
Qed.

Theorem hessenberg_polynomial n : char_poly (hessenberg n) = hessenberg_poly n.
Proof. by apply: hessenberg_sequence => // k; exact: hessenberg_polyS. Qed.
End Recursion.

(* The rule: A L = L H, after a common permutation of rows and columns of A. *)
Theorem characteristic_polynomial_modulo (R : comUnitRingType) n (A L : 'M[R]_n) (s : 'S_n)
    (h : nat -> nat -> R) (b : nat -> R) : is_trig_mx L -> (forall i, L i i = 1) ->
  (\matrix_(i, j) A (s i) (s j)) *m L = L *m hessenberg h b n -> char_poly A = hessenberg_poly h b n.
Proof.
move=> tL dL e; rewrite -hessenberg_polynomial; apply: hessenberg_similar e.
by rewrite unitmxE det_trig// big1 ?unitr1.
Qed.
