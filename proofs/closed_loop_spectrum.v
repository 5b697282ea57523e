(* checker/loops.py: kind `closed_loop_spectrum`, and both spectra of `distributed_observer`.
   A polynomial that agrees with det(xI - A) modulo enough moduli is det(xI - A). *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import arithmetic.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* The sum of the absolute values of the coefficients. *)
Section Length.
Implicit Types p q : {poly int}.
Definition length p := \sum_(k < size p) `|p`_k|.

Lemma length_wide p s : (size p <= s)%N -> length p = \sum_(k < s) `|p`_k|.
Proof.
move=> sp; rewrite /length (big_ord_widen _ (fun k => `|p`_k|) sp) big_mkcond /=.
by apply: eq_bigr => k _; case: ltnP => // /leq_sizeP->; rewrite ?normr0.
Qed.

Lemma length_ge0 p : 0 <= length p. Proof. exact: sumr_ge0. Qed.
Lemma length0 : length 0 = 0. Proof. by rewrite /length size_poly0 big_ord0. Qed.

Lemma coef_length p k : `|p`_k| <= length p.
Proof.
have [kp|pk] := ltnP k (size p); last by rewrite nth_default// normr0 length_ge0.
by rewrite /length (bigD1 (Ordinal kp))//= ler_addl sumr_ge0// => f _; apply: G0.
Qed.

Lemma lengthC (c : int) : length c%:P = `|c|.
Proof. by rewrite (@length_wide _ 1) ?size_polyC ?leq_b1// big_ord1 coefC. Qed.

Lemma lengthD p q : length (p + q) <= length p + length q.
Proof.
pose s := maxn (size p) (size q).
rewrite (@length_wide _ s) ?size_add// (@length_wide p s) ?leq_maxl// (@length_wide q s) ?leq_maxr//.
by rewrite -big_split ler_sum// => k _; rewrite coefD ler_norm_add.
Qed.

Lemma lengthZ (c : int) p : length (c *: p) = `|c| * length p.
Proof.
rewrite (@length_wide _ (size p)) ?size_scale_leq// mulr_sumr.
by apply: eq_bigr => k _; rewrite coefZ normrM.
Qed.

Lemma lengthXn p n : length (p * 'X^n) = length p.
Proof.
rewrite (@length_wide _ (n + size p)) ?big_split_ord; last first.
  by apply: (leq_trans (size_mul_leq _ _)); rewrite size_polyXn addnS /= addnC.
rewrite /= big1 ?add0r => [|k _]; last by rewrite coefMXn ltn_ord normr0.
by apply: eq_bigr => k _; rewrite coefMXn ltnNge leq_addr /= addKn.
Qed.

Lemma length_sum (I : Type) (r : seq I) (P : pred I) (f : I -> {poly int}) :
  length (\sum_(i <- r | P i) f i) <= \sum_(i <- r | P i) length (f i).
Proof.
elim/big_rec2: _ => [|i y x _ le]; first by rewrite length0.
by apply: (le_trans (lengthD _ _)); rewrite ler_add2l.
Qed.

Lemma lengthM p q : length (p * q) <= length p * length q.
Proof.
rewrite -[p in p * q]coefK poly_def mulr_suml; apply: (le_trans (length_sum _ _ _)).
rewrite {2}/length mulr_suml ler_sum// => k _.
by rewrite -scalerAl lengthZ mulrC [_ * q]mulrC lengthXn mulrC.
Qed.

Lemma length_prod (I : Type) (r : seq I) (f : I -> {poly int}) :
  length (\prod_(i <- r) f i) <= \prod_(i <- r) length (f i).
Proof.
elim: r => [|i r IH]; first by rewrite !big_nil -polyC1 lengthC normr1.
rewrite !big_cons; apply: (le_trans (lengthM _ _)).
by rewrite ler_wpmul2l ?length_ge0.
Qed.

(* A determinant, expanded row by row. *)
Lemma length_det n (P : 'M[{poly int}]_n) : length (\det P) <= \prod_i \sum_j length (P i j).
Proof.
pose G (f : {ffun 'I_n -> 'I_n}) := \prod_i length (P i (f i)).
have G0 f : 0 <= G f by apply: prodr_ge0 => i _; apply: length_ge0.
pose choice (s : 'S_n) := [ffun i => s i].
apply: (@le_trans _ _ (\sum_(s : 'S_n) G (choice s))).
  rewrite /determinant; apply: (le_trans (length_sum _ _ _)); rewrite ler_sum// => s _.
  have -> : (-1) ^+ s = ((-1) ^+ s)%:P :> {poly int} by rewrite rmorphX rmorphN1.
  have -> : G (choice s) = \prod_i length (P i (s i)) by apply: eq_bigr => i _; rewrite ffunE.
  by rewrite mul_polyC lengthZ normrX normrN1 expr1n mul1r; apply: length_prod.
pose S := [set: {perm 'I_n}]; rewrite bigA_distr_bigA (eq_bigl (mem S)) => [|s]; last by rewrite /= /S in_setT.
rewrite -(big_imset G) /=; last first.
  by move=> s t _ _ /ffunP e; apply/permP=> i; have := e i; rewrite !ffunE.
by rewrite [X in _ <= X](bigID (mem [set choice s | s in S])) /= ler_addl sumr_ge0// => f _; apply: G0.
Qed.
End Length.

(* A number divisible by every modulus, whose absolute value is below their product, is 0. *)
Section Residues.
Variables (r : nat) (ell : 'I_r -> modulus).

Lemma modulus_dvd (l : modulus) (z : int) : (z%:~R : 'Z_l) = 0 -> (l %| `|z|)%N.
Proof.
have nat0 (a : nat) : (a%:R : 'Z_l) = 0 -> (l %| a)%N.
  by move/(congr1 val); rewrite /= val_Zp_nat ?modulus_gt1// /dvdn => ->.
have -> : (z%:~R : 'Z_l) = (-1) ^+ (z < 0)%R * `|z|%:R.
  by rewrite {1}[z]intEsign rmorphM rmorphX/= rmorphN1.
case: (z < 0)%R; rewrite ?expr1 ?expr0 ?mulN1r ?mul1r; last exact: nat0.
by move/eqP; rewrite oppr_eq0 => /eqP; apply: nat0.
Qed.

(* Each modulus is coprime to the product of those before it. *)
Definition pairwise_coprime := forall a : 'I_r, coprime (\prod_(b < r | (b < a)%N) ell b) (ell a).

Lemma product_dvd (z : nat) : pairwise_coprime -> (forall a, (ell a %| z)%N) -> (\prod_a ell a %| z)%N.
Proof.
move=> cop dv; have -> : (\prod_a ell a = \prod_(b < r | b < r) ell b)%N.
  by apply: eq_bigl => b; rewrite ltn_ord.
suff h k : (k <= r)%N -> (\prod_(b < r | b < k) ell b %| z)%N by apply: h.
elim: k => [_|k IH kr]; first by rewrite big_pred0.
rewrite (bigD1 (Ordinal kr))//= mulnC (eq_bigl (fun b : 'I_r => (b < k)%N)) => [|b].
  by rewrite Gauss_dvd ?IH ?dv// 1?ltnW//; have := cop (Ordinal kr).
by rewrite -val_eqE /= ltnS [(b < k)%N]ltn_neqAle andbC.
Qed.
End Residues.

Section Rule.
Variables (n r : nat) (ell : 'I_r -> modulus) (A : 'M[rat]_n) (p : {poly rat}).
Variables (d : 'I_n -> nat) (M : 'M[int]_n).
Hypotheses (d0 : forall i, (0 < d i)%N) (dA : forall i j, (d i)%:R * A i j = (M i j)%:~R).

Definition scale := (\prod_i d i)%N.
Definition bound := (\prod_i (d i + \sum_j `|M i j|))%N.

(* det(diag(d) x - M), of integers. *)
Definition scaled_poly : {poly int} := \det (\matrix_(i, j) (((d i)%:R *+ (i == j))%:P * 'X - (M i j)%:P)).

(* The same over any ring in which M = diag(d) A. *)
Lemma scaled_char_poly (R : comRingType) (B : 'M[R]_n) :
  (forall i j, (d i)%:R * B i j = (M i j)%:~R) ->
  map_poly intr scaled_poly = scale%:R *: char_poly B.
Proof.
move=> dB; rewrite /scaled_poly -det_map_mx /char_poly.
have -> : map_mx (map_poly intr) (\matrix_(i, j) (((d i)%:R *+ (i == j))%:P * 'X - (M i j)%:P)) =
    diag_mx (\row_i (d i)%:R%:P) *m char_poly_mx B.
  apply/matrixP=> i j; rewrite mul_diag_mx !mxE rmorphB rmorphM /= map_polyX !map_polyC /=.
  rewrite mulrBr -[in RHS]polyCM dB rmorphMn rmorph_nat; congr (_ - _).
  by rewrite mulrnAr polyCMn mulrnAl.
rewrite det_mulmx det_diag -mul_polyC; congr (_ * _).
by rewrite /scale natr_prod rmorph_prod; apply: eq_bigr => i _; rewrite mxE.
Qed.

Theorem scaled_bound k : `|scaled_poly`_k| <= bound%:R.
Proof.
apply: (le_trans (coef_length _ _)); apply: (le_trans (length_det _)).
rewrite /bound natr_prod; apply: ler_prod => i _; rewrite sumr_ge0 => [|j _]; last exact: length_ge0.
rewrite natrD natr_sum.
have le j : length ((\matrix_(i, j) (((d i)%:R *+ (i == j))%:P * 'X - (M i j)%:P)) i j) <=
    (d i)%:R *+ (i == j) + `|M i j|%:R.
  rewrite mxE; apply: (le_trans (lengthD _ _)).
  rewrite -['X]expr1 lengthXn -rmorphN !lengthC normrN.
  by rewrite -mulrnA normr_nat ler_add2l natz abszE.
apply: (le_trans (ler_sum _ (fun j _ => le j))); rewrite big_split /= (bigD1 i)//= eqxx mulr1n.
by rewrite big1 ?addr0// => j; rewrite eq_sym => /negPf->.
Qed.

(* Residues of rational numbers. *)
Definition residues (l : modulus) (q : {poly rat}) := \poly_(k < size q) residue_rat l q`_k.

Hypotheses (whole : forall k, exists2 z : int, scale%:R * p`_k = z%:~R & (`|z| <= bound)%N).
Hypotheses (cop : pairwise_coprime ell) (enough : (2 * bound < \prod_a ell a)%N).
Hypothesis unit_scale : forall a, coprime (ell a) scale.
Hypothesis agrees : forall a, char_poly (map_mx (residue_rat (ell a)) A) = residues (ell a) p.

Theorem spectrum_by_residues : char_poly A = p.
Proof.
have D0 : scale%:R != 0 :> rat by rewrite pnatr_eq0 -lt0n prodn_gt0.
apply: (scalerI D0); rewrite -(scaled_char_poly dA); apply/polyP=> k; rewrite coef_map coefZ /=.
have [z wz zb] := whole k; rewrite wz; congr (_%:~R); apply/eqP; rewrite -subr_eq0 -absz_eq0.
pose w := absz (scaled_poly`_k - z)%R; rewrite -[(_ == _)%N]/(w == 0%N).
have dvw : (\prod_a ell a %| w)%N.
  apply: product_dvd => // a; apply: modulus_dvd; rewrite rmorphB /=.
  have dl i : coprime (ell a) (d i).
    by apply: coprime_dvdr (unit_scale a); rewrite /scale (bigD1 i)//= dvdn_mulr.
  have e : forall i j, (d i)%:R * (map_mx (residue_rat (ell a)) A) i j = (M i j)%:~R.
    move=> i j; rewrite mxE mulrC; apply: residue_ratE => //.
    by rewrite mulrC -dA; congr (_ * _); rewrite -pmulrn.
  have /(congr1 (fun q : {poly 'Z_(ell a)} => q`_k)) := scaled_char_poly e.
  rewrite coef_map coefZ /= => ->; rewrite agrees coef_poly.
  have ez : residue_rat (ell a) p`_k * scale%:R = z%:~R.
    by apply: residue_ratE => //; rewrite mulrC -pmulrn.
  suff -> : (if (k < size p)%N then residue_rat (ell a) p`_k else 0) = residue_rat (ell a) p`_k.
    by rewrite mulrC ez subrr.
  by case: ltnP => // /leq_sizeP->//; rewrite /residue_rat mul0r.
have wb : (w <= 2 * bound)%N.
  rewrite -lez_nat /w abszE (le_trans (ler_norm_sub _ _))// mul2n -addnn PoszD ler_add//.
  by have := scaled_bound k; rewrite natz.
by apply: contraLR (leq_ltn_trans wb enough) => w0; rewrite -leqNgt dvdn_leq// lt0n.
Qed.
End Rule.

(* The rule as the checker runs it: A = N / den, g_i the greatest common divisor of den and the row i of N,
   D = prod den / g_i, beta = prod (den + sum_j |N_ij|) / g_i. *)
Section Kind.
Variables (n r : nat) (ell : 'I_r -> modulus) (den : nat) (N : 'M[int]_n) (p : {poly rat}).
Let A : 'M[rat]_n := \matrix_(i, j) ((N i j)%:~R / den%:R).
Definition row_gcd i := gcdn den (\big[gcdn/0%N]_j `|N i j|%N).
Definition D := (\prod_i (den %/ row_gcd i))%N.
Definition beta := (\prod_i ((den + \sum_j `|N i j|) %/ row_gcd i))%N.

(* The integers of the rows, divided by their greatest common divisors with den. *)
Definition rows : 'M[int]_n := \matrix_(i, j) (N i j %/ row_gcd i)%Z.
Definition row_den i := (den %/ row_gcd i)%N.

Hypothesis den0 : (0 < den)%N.
Fact row_gcd_gt0 i : (0 < row_gcd i)%N. Proof. by rewrite gcdn_gt0 den0. Qed.
Fact row_denE i : (row_den i * row_gcd i)%N = den. Proof. by rewrite divnK// dvdn_gcdl. Qed.
Fact row_gcd_dvd i j : (row_gcd i %| `|N i j|)%N.
Proof. by apply: dvdn_trans (dvdn_gcdr _ _) _; rewrite (bigD1 j)//= dvdn_gcdl. Qed.
Fact rowsE i j : rows i j * (row_gcd i)%:Z = N i j.
Proof. by rewrite mxE divzK// dvdzE row_gcd_dvd. Qed.

Fact betaE : beta = bound row_den rows.
Proof.
have absM i j : (`|rows i j| * row_gcd i = `|N i j|)%N by rewrite -(rowsE i j) abszM.
apply: eq_bigr => i _; apply/eqP; rewrite -(eqn_pmul2r (row_gcd_gt0 i)) divnK; last first.
  by rewrite dvdn_add ?dvdn_gcdl// big_seq dvdn_sum// => j _; apply: row_gcd_dvd.
by rewrite mulnDl row_denE big_distrl /=; apply/eqP; congr (_ + _)%N; apply: eq_bigr => j _; rewrite absM.
Qed.

Fact rows_rat i j : (row_den i)%:R * A i j = (rows i j)%:~R.
Proof.
have nz (m : nat) : (0 < m)%N -> m%:R != 0 :> rat by rewrite pnatr_eq0 lt0n.
rewrite mxE; apply: (mulIf (nz _ (row_gcd_gt0 i))); rewrite mulrAC -natrM row_denE mulrC divfK ?nz//.
by rewrite -(rowsE i j) rmorphM /= -pmulrn.
Qed.

Theorem closed_loop_spectrum :
  (forall k, exists2 z : int, D%:R * p`_k = z%:~R & (`|z| <= beta)%N) ->
  pairwise_coprime ell -> (2 * beta < \prod_a ell a)%N -> (forall a, coprime (ell a) den) ->
  (forall a, char_poly (\matrix_(i, j) ((N i j)%:~R / den%:R : 'Z_(ell a))) = residues (ell a) p) ->
  char_poly A = p.
Proof.
move=> whole cop enough unit_den agrees.
have nz (m : nat) : (0 < m)%N -> m%:R != 0 :> rat by rewrite pnatr_eq0 lt0n.
apply: (@spectrum_by_residues n r ell A p row_den rows) => //; rewrite -?betaE //.
- by move=> i; rewrite divn_gt0 ?row_gcd_gt0// dvdn_leq ?dvdn_gcdl.
- exact: rows_rat.
- move=> a; apply: (big_rec (coprime (ell a))); first exact: coprimen1.
  move=> i x _ cx; rewrite coprimeMr cx andbT; apply: coprime_dvdr (unit_den a).
  by apply/dvdnP; exists (row_gcd i); rewrite mulnC row_denE.
move=> a; rewrite -agrees; congr char_poly; apply/matrixP=> i j; rewrite !mxE.
have ud := unit_nat_modulus (unit_den a); apply: (mulIr ud); rewrite divrK//.
by apply: residue_ratE => //; rewrite -pmulrn divfK ?nz.
Qed.
End Kind.
