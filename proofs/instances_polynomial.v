(* The characteristic polynomial of [3/2], read off modulo 11, and that of [1, 1; 1, 1], by columns;
   elimination without fractions with the pivots 2 and 6. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic hessenberg characteristic_polynomial elimination interpolation.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Definition l11 := @Modulus 11 isT.
Definition N : 'M[int]_1 := 3%:R%:M.
Definition h (i : 'I_1) : nat := 3.
Definition c : {poly int} := 'X - 3%:R%:P.
Lemma rows_N i : \sum_j N i j ^+ 2 <= (h i)%:R ^+ 2.
Proof. by rewrite big_ord1 mxE !ord1. Qed.
Lemma large_l11 : (2 * \prod_(i < 1) (1 + h i) < l11)%N. Proof. by rewrite big_ord1. Qed.
Lemma least_c k : (2 * `|(c`_k)%R| <= l11)%N.
Proof. by rewrite coefB coefX coefC; case: k => [|[|k]]. Qed.
Lemma residues_c : map_poly intr c = char_poly (map_mx intr N) :> {poly 'Z_l11}.
Proof.
rewrite /char_poly det_mx11 !mxE eqxx rmorphB /= map_polyX map_polyC.
by rewrite !mulr1n.
Qed.
Definition inst_integers : char_poly N = c := characteristic_polynomial_integers rows_N large_l11 least_c residues_c.
Lemma inst_rational :
  char_poly (\matrix_(i, j) ((N i j)%:~R / 2%:R) : 'M[rat]_1) = \poly_(k < 2) ((c`_k)%:~R / 2%:R ^+ (1 - k)).
Proof. exact: (characteristic_polynomial_rule rows_N large_l11 least_c _ residues_c). Qed.

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
