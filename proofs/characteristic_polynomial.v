(* checker/core/arithmetic.py: det(xI - A) over Q from its residues; modulo l it is computed as
   in hessenberg.v.

   M = N / den, N of integers, is A, its transpose or a multiple of A.  D det(xI - M) has integer
   coefficients of absolute value at most beta (closed_loop_spectrum.v); integers of absolute value at most
   half the product of the moduli that agree with it modulo each of them are therefore its coefficients. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import arithmetic closed_loop_spectrum.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* One more modulus l: `old` is right modulo the product w of those before, and `now` modulo l as well. *)
Theorem combined (w l : nat) (f v old : int) : (0 < l)%N -> (w%:Z * f = 1 %[mod l])%Z -> 0 <= old < w%:Z ->
  let now := old + ((v - old) * f %% l)%Z * w in
  [/\ (now = v %[mod l])%Z, (forall m : nat, (m %| w)%N -> (now = old %[mod m])%Z) & 0 <= now < (w * l)%N%:Z].
Proof.
move=> l0 wf /andP[o0 ow] now; set t := ((v - old) * f %% l)%Z in now *.
have t0 : 0 <= t by apply: modz_ge0; rewrite -lt0n.
have tl : t < l%:Z by apply: ltz_pmod.
split.
- have e : (t * w = v - old %[mod l])%Z.
    by rewrite -modzMml modz_mod modzMml -mulrA [f * _]mulrC -modzMmr wf modzMmr mulr1.
  by rewrite /now -modzDmr e modzDmr addrC subrK.
- move=> m mw; apply/eqP; rewrite eqz_mod_dvd /now addrAC subrr add0r.
  by apply: dvdz_mull; rewrite dvdzE.
rewrite /now addr_ge0 ?mulr_ge0//=; apply: (@lt_le_trans _ _ (w%:Z + t * w)); first by rewrite ltr_add2r.
by rewrite mulnC PoszM -[X in X + _]mul1r -mulrDl; apply: ler_wpmul2r => //; rewrite addrC lez_addr1.
Qed.

Section Residues.
Variables (n r : nat) (ell : 'I_r -> modulus) (den : nat) (N : 'M[int]_n) (c : {poly int}).
Let D := D den N.
Let M (R : unitRingType) : 'M[R]_n := \matrix_(i, j) ((N i j)%:~R / den%:R).
Hypotheses (den0 : (0 < den)%N) (cop : pairwise_coprime ell) (unit_den : forall a, coprime (ell a) den).
Hypotheses (enough : (2 * beta den N < \prod_a ell a)%N).
Hypothesis least : forall k, (2 * `|(c`_k)%R| <= \prod_a ell a)%N.
Hypothesis agrees : forall a, map_poly intr c = D%:R *: char_poly (M [unitRingType of 'Z_(ell a)]).

Theorem characteristic_polynomial_residues : map_poly intr c = D%:R *: char_poly (M rat_unitRing).
Proof.
rewrite -(scaled_char_poly (rows_rat N den0)); congr (map_poly _ _); apply/polyP=> k.
apply/eqP; rewrite eq_sym -subr_eq0 -absz_eq0; set q := scaled_poly _ _.
rewrite -[(_ == _)%N]/(`|(q`_k - c`_k)%R| == 0)%N; set z := q`_k - c`_k.
have dv : (\prod_a ell a %| `|z|)%N.
  apply: product_dvd => // a; apply: modulus_dvd; rewrite /z rmorphB /=; apply/eqP; rewrite subr_eq0.
  have e i j : (row_den den N i)%:R * M [unitRingType of 'Z_(ell a)] i j = (rows den N i j)%:~R.
    have ug : ((row_gcd den N i)%:R : 'Z_(ell a)) \is a GRing.unit.
      by apply: unit_nat_modulus; apply: coprime_dvdr (unit_den a); apply: dvdn_gcdl.
    apply: (mulIr ug); rewrite mulrAC -natrM row_denE// mxE mulrC divrK ?unit_nat_modulus//.
    by rewrite -(rowsE den N i j) rmorphM /= -pmulrn.
  by apply/eqP; rewrite -!coef_map (scaled_char_poly e) /= agrees.
have le : (`|(q`_k)%R| <= beta den N)%N.
  by rewrite betaE// -lez_nat abszE -natz; apply: scaled_bound.
apply: contraTT dv => nz; rewrite gtnNdvd// ?lt0n//.
have tri : (`|z| <= `|(q`_k)%R| + `|(c`_k)%R|)%N by rewrite -lez_nat PoszD !abszE ler_norm_sub.
rewrite -(ltn_pmul2l (isT : 0 < 2)%N) (leq_ltn_trans (leq_mul (leqnn 2) tri))// mulnDr.
rewrite [X in (_ < X)%N]mul2n -addnn -addSn leq_add ?least//.
by rewrite (leq_ltn_trans _ enough)// leq_mul2l le.
Qed.

(* A = M / e, or its transpose. *)
Theorem characteristic_polynomial_rule (A : 'M[rat]_n) (e : rat) : e != 0 ->
  e *: A = M rat_unitRing \/ e *: A = (M rat_unitRing)^T ->
  char_poly A = \poly_(k < n.+1) ((c`_k)%:~R / (D%:R * e ^+ (n - k))).
Proof.
move=> ne AM; have sA : size (char_poly A) = n.+1 by rewrite size_char_poly.
have D0 : D%:R != 0 :> rat.
  rewrite pnatr_eq0 -lt0n prodn_gt0// => i.
  by rewrite divn_gt0 ?row_gcd_gt0// dvdn_leq ?dvdn_gcdl.
have eM : char_poly (e *: A) = char_poly (M rat_unitRing).
  case: AM => ->//; rewrite /char_poly -det_tr; congr (\det _).
  by apply/matrixP=> i j; rewrite !mxE eq_sym.
have eA : (e ^+ n) *: char_poly A = char_poly (M rat_unitRing) \Po (e *: 'X).
  rewrite -eM /char_poly -[RHS]/(comp_poly (e *: 'X) (\det _)) -det_map_mx.
  rewrite -[LHS]mul_polyC rmorphX -detZ; congr (\det _); apply/matrixP=> i j.
  rewrite !mxE rmorphB !mulrb /= comp_polyC mulrBr -polyCM; congr (_ - _).
  by case: (i == j); rewrite ?comp_polyX ?mul_polyC ?comp_polyC ?scaler0.
apply/polyP=> k; rewrite coef_poly; case: ltnP => [kn|nk]; last by rewrite nth_default// sA.
have ce : e ^+ n * (char_poly A)`_k = (char_poly (M rat_unitRing))`_k * e ^+ k.
  rewrite -coefZ eA comp_polyE coef_sum (eq_bigr (fun i : 'I_(size (char_poly (M rat_unitRing))) =>
    (char_poly (M rat_unitRing))`_i * (e ^+ i * (k == i)%:R))) => [|i _]; last first.
    by rewrite coefZ exprZn coefZ coefXn.
  have ks : (k < size (char_poly (M rat_unitRing)))%N by rewrite size_char_poly.
  rewrite (bigD1 (Ordinal ks))//= eqxx mulr1 big1 ?addr0// => i; rewrite -val_eqE eq_sym /= => /negPf->.
  by rewrite !mulr0.
have cM : (c`_k)%:~R = D%:R * (char_poly (M rat_unitRing))`_k.
  by rewrite -coefZ -characteristic_polynomial_residues coef_map.
apply: (mulfI (expf_neq0 n ne)); rewrite ce cM invfM mulrACA mulfV// mul1r mulrCA; congr (_ * _).
by rewrite -{1}(subnK (ltnSE kn)) exprD mulrAC mulfV ?mul1r// expf_neq0.
Qed.
End Residues.
