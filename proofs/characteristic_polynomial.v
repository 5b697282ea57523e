(* checker/characteristic_polynomial.py: det(xI - A) over Q, read off modulo one large l; modulo l it is
   computed as in hessenberg.v.

   A = N/d, N of integers, the row i of N of Euclidean length at most h_i.  Hadamard's inequality bounds
   the coefficients of det(xI - N) by the product of the 1 + h_i; residues modulo l > twice that, of
   least absolute value, are therefore the coefficients. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import arithmetic closed_loop_spectrum.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Hadamard.
Variable F : realFieldType.

Definition form n (P : 'M[F]_n) (x : 'rV_n) : F := (x *m P *m x^T) 0 0.
Definition posdef n (P : 'M[F]_n) := P^T = P /\ forall x, x != 0 -> 0 < form P x.

Lemma posdef_unit n (P : 'M[F]_n) : posdef P -> P \in unitmx.
Proof.
case=> _ pP; rewrite -row_free_unit -kermx_eq0; apply/negPn/negP => /rowV0Pn[x /sub_kermxP e nx].
by have := pP x nx; rewrite /form e mul0mx mxE ltxx.
Qed.

(* The determinant is positive and at most the product of the diagonal, by a Schur complement. *)
Let bounded n := forall P : 'M[F]_n, posdef P -> 0 < \det P <= \prod_i P i i.

Let bounded_step n : bounded n -> bounded (1 + n)%N.
Proof.
move=> IH P pd; have [sP pP] := pd.
pose a := ulsubmx P; pose v := ursubmx P; pose Q := drsubmx P.
have eP : P = block_mx a v v^T Q by rewrite /v trmx_ursub sP submxK.
have sQ : Q^T = Q by rewrite /Q trmx_drsub sP.
have pQ : posdef Q.
  split=> // x nx; have := pP (row_mx 0 x); rewrite /form eP mul_row_block !mul0mx !add0r.
  rewrite tr_row_mx mul_row_col trmx0 mulmx0 add0r; apply.
  by apply: contra nx => /eqP/(congr1 rsubmx); rewrite row_mxKr => ->; rewrite linear0.
have uQ := posdef_unit pQ; have [dQ leQ] := andP (IH Q pQ).
pose w := v *m invmx Q; have wQ : w *m Q = v by rewrite mulmxKV.
have Qw : Q *m w^T = v^T by rewrite -{1}sQ -trmx_mul wQ.
pose s := a - w *m v^T.
have es : \det P = s 0 0 * \det Q.
  have <- : \det (block_mx s v 0 Q) = s 0 0 * \det Q by rewrite det_ublock [s in LHS]mx11_scalar det_scalar1.
  have <- : P *m block_mx 1%:M 0 (- w^T) 1%:M = block_mx s v 0 Q.
    rewrite eP mulmx_block !mulmx1 !mulmx0 !add0r !mulmxN Qw subrr; congr (block_mx (_ - _) _ _ _).
    by rewrite -[LHS]trmxK trmx_mul trmxK [RHS]mx11_scalar [LHS]mx11_scalar mxE.
  by rewrite det_mulmx det_lblock !det1 !mulr1.
have s0 : 0 < s 0 0.
  have := pP (row_mx 1%:M (- w)); rewrite /form eP mul_row_block !mul1mx !mulNmx wQ subrr.
  rewrite tr_row_mx mul_row_col mul0mx addr0 trmx1 mulmx1; apply.
  by apply/eqP=> /(congr1 lsubmx)/matrixP/(_ 0 0)/eqP; rewrite row_mxKl !mxE oner_eq0.
have sa : s 0 0 <= a 0 0.
  rewrite !mxE ler_subl_addr ler_addl; have -> : \sum_j w 0 j * v^T j 0 = form Q w.
    by rewrite /form -mulmxA Qw [RHS]mxE.
  have [->|nw] := eqVneq w 0; last by case: pQ => _ /(_ w nw)/ltW.
  by rewrite /form !mul0mx mxE.
rewrite es mulr_gt0//= (big_split_ord _ _ (m := 1) (n := n)).
have -> : \prod_(i < 1) P (lshift n i) (lshift n i) = a 0 0 by rewrite big_ord1 !mxE.
apply: ler_pmul; rewrite ?(ltW s0) ?(ltW dQ)//.
by apply: le_trans leQ _; rewrite le_eqVlt; apply/orP; left; apply/eqP/eq_bigr => i _; rewrite !mxE.
Qed.

Lemma posdef_det n (P : 'M[F]_n) : posdef P -> 0 < \det P <= \prod_i P i i.
Proof.
elim: n P => [P _|n IH]; first by rewrite det_mx00 big_ord0 ltr01 lexx.
exact: bounded_step.
Qed.

(* Hadamard's inequality, with squares. *)
Lemma hadamard n (A : 'M[F]_n) : \det A ^+ 2 <= \prod_i \sum_j A i j ^+ 2.
Proof.
have r0 i : 0 <= \sum_j A i j ^+ 2 by apply: sumr_ge0 => j _; apply: sqr_ge0.
have [->|nA] := eqVneq (\det A) 0; first by rewrite expr0n prodr_ge0.
have uA : A \in unitmx by rewrite unitmxE unitfE.
have gram (x : 'rV_n) : form (A *m A^T) x = \sum_j (x *m A) 0 j ^+ 2.
  by rewrite /form mulmxA -mulmxA -trmx_mul mxE; apply: eq_bigr => j _; rewrite [X in _ * X]mxE expr2.
have pd : posdef (A *m A^T).
  split=> [|x nx]; first by rewrite trmx_mul trmxK.
  have nxA : x *m A != 0 by apply: contra nx => /eqP e; rewrite -[x](mulmxK uA) e mul0mx.
  rewrite gram lt_neqAle sumr_ge0 ?andbT => [|j _]; last exact: sqr_ge0.
  apply: contra nxA => /eqP/esym/eqP; rewrite psumr_eq0 => [/allP z|j _]; last exact: sqr_ge0.
  apply/eqP/matrixP=> i j; rewrite ord1 [RHS]mxE; have := z j (mem_index_enum _).
  by rewrite /= sqrf_eq0 => /eqP.
have /andP[_] := posdef_det pd; rewrite det_mulmx det_tr -expr2 => /le_trans; apply.
rewrite le_eqVlt; apply/orP; left; apply/eqP; apply: eq_bigr => i _.
by rewrite mxE; apply: eq_bigr => j _; rewrite mxE expr2.
Qed.
End Hadamard.

(* A row that is a sum: the determinant is the sum over all choices of a summand in each row. *)
Lemma det_choices (R : comRingType) n (a b : 'M[R]_n) :
  \det (a + b) = \sum_(f : {ffun 'I_n -> bool}) \det (\matrix_(i, j) if f i then a i j else b i j).
Proof.
rewrite /determinant exchange_big; apply: eq_bigr => s _; rewrite -mulr_sumr; congr (_ * _).
rewrite (eq_bigr (fun i => \sum_(c : bool) if c then a i (s i) else b i (s i))) => [|i _].
  rewrite bigA_distr_bigA; apply: eq_bigr => f _; apply: eq_bigr => i _.
  by rewrite mxE.
by rewrite big_bool mxE.
Qed.

Section Bound.
Variables (n : nat) (N : 'M[int]_n) (h : 'I_n -> nat).
Hypothesis rows : forall i, \sum_j N i j ^+ 2 <= (h i)%:R ^+ 2.

Lemma hadamard_int (M : 'M[int]_n) (b : 'I_n -> nat) :
  (forall i, \sum_j M i j ^+ 2 <= (b i)%:R ^+ 2) -> `|\det M| <= \prod_i (b i)%:R.
Proof.
move=> le; have p0 : 0 <= \prod_i (b i)%:R :> int by apply: prodr_ge0 => i _; apply: ler0n.
rewrite -(@ler_pexpn2r _ 2) ?nnegrE// -normrX ger0_norm ?sqr_ge0//.
rewrite -(ler_int [numDomainType of rat]) rmorphX /= -det_map_mx; apply: le_trans (hadamard _) _.
rewrite -prodrXl rmorph_prod; apply: ler_prod => i _; rewrite sumr_ge0 => [|j _]; last exact: sqr_ge0.
apply: le_trans (_ : (\sum_j M i j ^+ 2)%:~R <= _); last by rewrite ler_int.
by rewrite rmorph_sum /=; apply: ler_sum => j _; rewrite mxE rmorphX.
Qed.

(* det(xI - N) is the sum over the sets of rows kept from xI of x^k times an integer determinant. *)
Lemma length_char_poly : length (char_poly N) <= \prod_i (1 + (h i)%:R).
Proof.
rewrite /char_poly /char_poly_mx det_choices; apply: le_trans (length_sum _ _ _) _.
pose D (f : {ffun 'I_n -> bool}) : 'M[int]_n := \matrix_(i, j) if f i then (i == j)%:R else - N i j.
have e (f : {ffun 'I_n -> bool}) : \det (\matrix_(i, j) if f i then ('X%:M : 'M[{poly int}]_n) i j else (- map_mx polyC N) i j) =
    (\det (D f))%:P * 'X^#|[pred i | f i]|.
  have -> : (\matrix_(i, j) if f i then ('X%:M : 'M[{poly int}]_n) i j else (- map_mx polyC N) i j) =
      diag_mx (\row_i (if f i then 'X else 1)) *m map_mx polyC (D f).
    apply/matrixP=> i j; rewrite mul_diag_mx !mxE; case: ifP => _; last by rewrite mul1r polyCN.
    by case: eqP => _; rewrite ?mulr1 ?mulr0.
  rewrite det_mulmx det_diag det_map_mx mulrC; congr (_ * _).
  rewrite (eq_bigr (fun i => if f i then 'X else 1)) => [|i _]; last by rewrite mxE.
  by rewrite -big_mkcond prodr_const.
under eq_bigr => f _ do rewrite e.
apply: (@le_trans _ _ (\sum_(f : {ffun 'I_n -> bool}) \prod_i (if f i then 1 else (h i)%:R))).
  apply: ler_sum => f _; rewrite lengthXn lengthC.
  have -> : \prod_i (if f i then 1 else (h i)%:R) = \prod_i (if f i then 1 else h i)%N%:R :> int.
    by apply: eq_bigr => i _; case: ifP.
  apply: hadamard_int => i; case E : (f i); last first.
    by apply: le_trans (rows i); apply: ler_sum => j _; rewrite mxE E sqrrN.
  rewrite (bigD1 i)//= mxE E eqxx big1 ?addr0// => j ji.
  by rewrite mxE E eq_sym (negPf ji) expr0n.
rewrite -(bigA_distr_bigA (fun i (c : bool) => if c then 1 else (h i)%:R : int)).
by apply: ler_prod => i _; rewrite big_bool /= addr_ge0 ?ler0n ?ler01 //= lexx.
Qed.

(* Rule: residues of least absolute value modulo a large enough l. *)
Variables (l : modulus) (c : {poly int}).
Hypotheses (large : (2 * \prod_i (1 + h i) < l)%N) (least : forall k, (2 * `|(c`_k)%R| <= l)%N).

Theorem characteristic_polynomial_integers :
  map_poly intr c = char_poly (map_mx intr N) :> {poly 'Z_l} -> char_poly N = c.
Proof.
move=> e; apply/polyP=> k; apply/eqP; rewrite -subr_eq0 -absz_eq0.
pose z := (char_poly N)`_k - c`_k; rewrite -[(_ == _)%N]/(`|z| == 0)%N.
have dv : (l %| `|z|)%N.
  apply: modulus_dvd; rewrite /z rmorphB /=; apply/eqP; rewrite subr_eq0; apply/eqP.
  by rewrite -[RHS]coef_map /= e -map_char_poly coef_map.
have le : (`|((char_poly N)`_k)%R| <= \prod_i (1 + h i))%N.
  rewrite -lez_nat abszE; apply: le_trans (coef_length _ _) _; apply: le_trans length_char_poly _.
  rewrite -natz natr_prod; apply: ler_prod => i _; rewrite addr_ge0 ?ler01 ?ler0n//=.
  by rewrite natrD.
apply: contraTT dv => nz; rewrite gtnNdvd// ?lt0n//.
have tri : (`|z| <= `|((char_poly N)`_k)%R| + `|(c`_k)%R|)%N.
  by rewrite -lez_nat PoszD !abszE ler_norm_sub.
rewrite -(ltn_pmul2l (isT : 0 < 2)%N) (leq_ltn_trans (leq_mul (leqnn 2) tri))// mulnDr.
rewrite [X in (_ < X)%N]mul2n -addnn -addSn leq_add ?least//.
by rewrite (leq_ltn_trans _ large)// leq_mul2l le.
Qed.

Theorem characteristic_polynomial_rule (d : rat) : d != 0 ->
  map_poly intr c = char_poly (map_mx intr N) :> {poly 'Z_l} ->
  char_poly (\matrix_(i, j) ((N i j)%:~R / d) : 'M[rat]_n) = \poly_(k < n.+1) ((c`_k)%:~R / d ^+ (n - k)).
Proof.
move=> nd e; set A := (X in char_poly X); have sA : size (char_poly A) = n.+1 by rewrite size_char_poly.
have eA : (d ^+ n) *: char_poly A = map_poly intr c \Po (d *: 'X).
  rewrite -(characteristic_polynomial_integers e) map_char_poly /char_poly.
  rewrite -[RHS]/(comp_poly (d *: 'X) (\det _)) -det_map_mx.
  rewrite -[LHS]mul_polyC rmorphX -detZ; congr (\det _); apply/matrixP=> i j.
  rewrite !mxE rmorphB !mulrb /= comp_polyC mulrBr; congr (_ - _); last by rewrite -polyCM mulrC divfK.
  by case: (i == j); rewrite ?comp_polyX ?mul_polyC ?comp_polyC ?scaler0.
apply/polyP=> k; rewrite coef_poly; case: ltnP => [kn|nk]; last by rewrite nth_default// sA.
have ce : d ^+ n * (char_poly A)`_k = (c`_k)%:~R * d ^+ k.
  rewrite -coefZ eA comp_polyE coef_sum (eq_bigr (fun i : 'I_(size (map_poly intr c)) =>
    (map_poly (intr : int -> rat) c)`_i * (d ^+ i * (k == i)%:R))) => [|i _]; last first.
    by rewrite coefZ exprZn coefZ coefXn.
  have [ks|sk] := ltnP k (size (map_poly (intr : int -> rat) c)).
    rewrite (bigD1 (Ordinal ks))//= eqxx mulr1 coef_map big1 ?addr0// => i; rewrite -val_eqE eq_sym /= => /negPf->.
    by rewrite !mulr0.
  rewrite big1 => [|i _]; last by rewrite gtn_eqF ?mulr0// (leq_trans _ sk).
  by rewrite -[(c`_k)%:~R]/(intr c`_k) -coef_map nth_default ?mul0r.
apply: (mulfI (expf_neq0 n nd)); rewrite ce mulrCA; congr (_ * _).
by rewrite -{1}(subnK (ltnSE kn)) exprD mulrAC mulfV ?mul1r// expf_neq0.
Qed.
End Bound.
