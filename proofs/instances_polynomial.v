(* The characteristic polynomial of [3/2] from residues modulo 11, and that of [1, 1; 1, 1], by columns;
   elimination without fractions with the pivots 2 and 6. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic hessenberg closed_loop_spectrum characteristic_polynomial elimination interpolation.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* 2 det(xI - 3/2) = 2x - 3, modulo 11; then of 3/2 / 5 and of its transpose. *)
Definition l11 (a : 'I_1) := @Modulus 11 isT.
Definition N : 'M[int]_1 := 3%:R%:M.
Definition c : {poly int} := 2%:R *: 'X - 3%:R%:P.
Lemma eD : D 2 N = 2%N. Proof. by rewrite /D /row_gcd !big_ord1 mxE eqxx. Qed.
Lemma ebeta : beta 2 N = 5%N. Proof. by rewrite /beta /row_gcd !big_ord1 mxE eqxx. Qed.
Lemma pairwise_l11 : pairwise_coprime l11. Proof. by case=> [[|a]]// a1; rewrite big_ord1_cond. Qed.
Lemma large_l11 : (2 * beta 2 N < \prod_a l11 a)%N. Proof. by rewrite ebeta big_ord1. Qed.
Lemma least_c k : (2 * `|(c`_k)%R| <= \prod_a l11 a)%N.
Proof. by rewrite big_ord1 coefB coefZ coefX coefC; case: k => [|[|k]]. Qed.
Lemma residues_c (a : 'I_1) :
  map_poly intr c = (D 2 N)%:R *: char_poly (\matrix_(i, j) ((N i j)%:~R / 2%:R) : 'M['Z_(l11 a)]_1).
Proof.
rewrite eD /char_poly det_mx11 !mxE eqxx rmorphB /= map_polyC map_polyZ map_polyX !mulr1n scalerBr.
congr (_ - _); rewrite -mul_polyC -polyCM; congr (_%:P).
rewrite [RHS]mulrC divrK; last exact: (@unit_nat_modulus (l11 a)).
by [].
Qed.
Definition inst_scaled_bound k := scaled_bound (row_den 2 N) (rows 2 N) k.
Definition inst_residues := characteristic_polynomial_residues
  (isT : 0 < 2)%N pairwise_l11 (fun=> isT) large_l11 least_c residues_c.
Lemma inst_rational (A : 'M[rat]_1) : 5%:R *: A = (\matrix_(i, j) ((N i j)%:~R / 2%:R))^T ->
  char_poly A = \poly_(k < 2) ((c`_k)%:~R / ((D 2 N)%:R * 5%:R ^+ (1 - k))).
Proof.
move=> e; have n5 : 5%:R != 0 :> rat by [].
exact: (characteristic_polynomial_rule (isT : 0 < 2)%N pairwise_l11 (fun=> isT) large_l11 least_c residues_c n5 (or_intror e)).
Qed.
(* 2 modulo 5, and 1 modulo 3: 7. *)
Definition inst_combined := @combined 5 3 2 1 2 isT erefl isT.

Notation ones := (hessenberg (fun _ _ => 1) (fun=> 1) 2 : 'M[int]_2).
Lemma inst_hessenberg_polynomial : char_poly ones = ('X - 1) ^+ 2 - 1.
Proof.
rewrite hessenberg_polynomial /hessenberg_poly /= !big_ord_recl !big_ord0 /=.
rewrite !big_nat1 /bump /= !big_geq// !mulr1 !scale1r !addr0 opprD addrA addrAC.
by rewrite expr2 mulrBl mul1r.
Qed.

Section Elimination.
Variable R : comRingType.
Definition two : 'M[R]_1 := 2%:R%:M.
Lemma second_pivot : bordered two 1 0 3%:R = 6%:R.
Proof. by rewrite /bordered det_lblock !det_scalar1 -natrM. Qed.
End Elimination.
Lemma inst_bareiss_step r' c' m12 m21 m22 :
  2%:R * bordered (block_mx (two _) 0 1 3%:R%:M) (row_mx r' m21%:M) (col_mx c' m12%:M) m22 =
  6%:R * bordered (two _) r' c' m22 - bordered (two _) r' 0 m21 * bordered (two _) 1 c' m12 :> rat.
Proof.
by rewrite -second_pivot -bareiss_step ?second_pivot ?unitmxE ?det_scalar1.
Qed.
Lemma inst_bareiss_exact r' c' m12 m21 m22 :
  6%:R * bordered (two _) r' c' m22 - bordered (two _) r' 0 m21 * bordered (two _) 1 c' m12 =
  bordered (block_mx (two _) 0 1 3%:R%:M) (row_mx r' m21%:M) (col_mx c' m12%:M) m22 * 2%:R :> int.
Proof.
have d2 : \det (two int_comRing) = 2%:R by rewrite det_scalar1.
by rewrite -second_pivot bareiss_exact ?second_pivot ?d2.
Qed.
Lemma inst_bareiss_rank : \rank (block_mx (two _) 0 1 0 : 'M[rat]_(1 + 1)) = 1%N.
Proof.
apply: bareiss_rank => [|i j]; first by rewrite unitmxE det_scalar1.
by rewrite /bordered linear0 det_lblock [X in X%:M]mxE !det_scalar1 mulr0.
Qed.

(* det [x] = x from its values at 0 and 1. *)
Lemma inst_values : \det ('X%:M : 'M[{poly rat}]_1) = 'X.
Proof.
apply: (@determinant_by_values _ 1 1); rewrite ?size_polyX//.
  by move=> i j; rewrite !mxE !ord1 size_polyX.
by move=> g _; rewrite det_mx11 !mxE /= /horner_eval !hornerX.
Qed.
