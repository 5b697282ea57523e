(* The rule of `step_peaks` applied to two states, with every hypothesis discharged: x(t+1) = x/2 + u and x' = -x + u, each after
   a constant 1 at both inputs, over every real closed field, in continuous time one in which bounded sets have suprema. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import convergence step_peaks.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Two.
Variable R : rcfType.
Notation ones := (const_mx 1 : 'cV[R]_2).
Notation one := (1%:M : 'M[R]_2).
Definition half : R := 2%:R^-1.
Definition sizes : 'I_2 -> R := fun=> 2%:R.

Lemma form_one (v : 'cV[R]_2) : form one v v = \sum_i v i 0 ^+ 2.
Proof. by rewrite /form mul1mx dotE; apply: eq_bigr => i _; rewrite expr2. Qed.
Lemma form_one_ge0 (v : 'cV[R]_2) : 0 <= form one v v.
Proof. by rewrite form_one sumr_ge0// => i _; rewrite sqr_ge0. Qed.
Lemma form_multiple (k : R) (v : 'cV[R]_2) : form k%:M v v = k * form one v v.
Proof. by rewrite -[k%:M]scalemx1 /form /dot -scalemxAl -scalemxAr mxE. Qed.
Lemma sizes_gt0 i : 0 < sizes i. Proof. by rewrite ltr0n. Qed.
Lemma symmetric : one^T = one. Proof. exact: trmx1. Qed.

(* 1 - 1/4 of the sum of squares *)
Lemma both_seen (v : 'cV[R]_2) : 0 <= form (one - \sum_i sizes i ^- 2 *: ((row i one)^T *m row i one)) v v.
Proof.
rewrite form_minus form_squares subr_ge0 form_one; apply: ler_sum => i _.
rewrite -row_mul mul1mx mxE ler_pimull ?sqr_ge0// invf_le1 ?exprn_gt0 ?ltr0n//.
by rewrite -natrX ler1n.
Qed.

(* x(t+1) = x/2 + 1: the response of the checker is exact for one step *)
Definition quarter : R := 4%:R^-1.
Definition halving : nat -> 'cV[R]_2 := fun t => iter t (fun x => half%:M *m x + ones) 0.
Definition first : nat -> 'cV[R]_2 := fun t => if t == 0%N then 0 else ones.
Definition reached : 'cV[R]_2 := \col_i (1 + 2%:R * (norm one (half%:M *m ones) / quarter)).

Lemma falls_by_half (v : 'cV[R]_2) : 0 <= form (one - (half%:M)^T *m one *m half%:M - (quarter *+ 2) *: one) v v.
Proof.
rewrite tr_scalar_mx mulmx1 -scalar_mxM scalemx1 -!raddfB form_multiple mulr_ge0 ?form_one_ge0//.
have -> : quarter *+ 2 = half.
  by rewrite /quarter /half (natrM _ 2 2) invfM -[_ *+ 2]mulr_natr -mulrA mulVf ?mulr1 ?pnatr_eq0.
have h1 : half * half <= half by rewrite ger_pmulr ?invr_gt0 ?ltr0n// invf_le1 ?ltr0n// ler1n.
have -> : 1 = half + half by rewrite /half -mulr2n -[_ *+ 2]mulr_natr mulVf ?pnatr_eq0.
by rewrite addrAC addrK subr_ge0.
Qed.

Example halved : forall t i, `|(one *m halving t + 0) i 0| <= reached i 0.
Proof.
apply: (@peaks_discrete R 2 2 half%:M one quarter one sizes ones 0 reached 1 (fun=> 0) symmetric sizes_gt0 _ both_seen halving first falls_by_half) => //.
- by rewrite invr_gt0 ltr0n.
- by case=> // _; rewrite mulmx0 add0r subrr norm0.
- move=> i [|//] _; rewrite big_ord0 mulr0 addr0 mulmx0 addr0 mxE normr0 mxE addr_ge0 ?ler01// mulr_ge0 ?ler0n//.
  by rewrite divr_ge0 ?norm_ge0// invr_ge0 ler0n.
- move=> i; rewrite big_ord_recl big_ord0 !addr0 add0r mul1mx [reached i 0]mxE /first /= [X in `|X|]mxE normr1 addrK.
  exact: lexx.
Qed.

(* x' = -x + 1: one step of time with the polynomial s (1, 1), whose error is at most half the norm of (1, 1) *)
Definition line : nat -> nat -> 'cV[R]_2 := fun k j =>
  if k == 0%N then (if j == 1%N then ones else 0) else (if j == 0%N then ones else 0).
Definition missing : nat -> R := fun=> norm one ones / 2%:R.
Definition near_one : 'cV[R]_2 := \col_i (1 + 2%:R * missing 0).

Lemma missing_ge0 k : 0 <= missing k. Proof. by rewrite divr_ge0 ?norm_ge0 ?ler0n. Qed.

Lemma falls_at_rate_one (v : 'cV[R]_2) : 0 <= form (- (one *m (- one) + (- one)^T *m one) - (1 *+ 2) *: one) v v.
Proof.
have -> : - (one *m (- one) + (- one)^T *m one) - (1 *+ 2) *: one = 0 :> 'M[R]_2.
  by rewrite mul1mx mulmx1 linearN /= trmx1 mulr2n scalerDl scale1r opprD !opprK subrr.
by rewrite /form mul0mx /dot mulmx0 mxE.
Qed.

Lemma line_polynomial (s : R) : polynomial 1 (line 0) s = s *: ones.
Proof. by rewrite /polynomial !big_ord_recl big_ord0 /= !scaler0 expr1 add0r !addr0. Qed.

Lemma line_missed : missed (- one) one ones 1 (line 0) = missing 0.
Proof.
rewrite /missed !big_ord_recl big_ord0 /residue /line /= mulmx0 scale1r subr0 subrr norm0 mul0r add0r addr0.
by rewrite scaler0 subr0 sub0r mulNmx mul1mx opprK.
Qed.

Example settled (sup : complete_order R) (z : R -> 'cV[R]_2) : z 0 = 0 ->
  moves z (fun t => - one *m z t + ones) -> forall t i, 0 <= t -> `|(one *m z t + 0) i 0| <= near_one i 0.
Proof.
move=> z0 dz.
apply: (@peaks_continuous R 2 2 (- one) one 1 one sizes ones 0 near_one 1 missing symmetric sizes_gt0 ltr01 both_seen (fun=> 1%N) line z
  sup falls_at_rate_one z0 dz) => //.
- by case.
- by case=> // _; rewrite line_polynomial scale1r.
- by case=> // _; rewrite line_missed.
- move=> i [|//] x _ /andP[x0 x1]; rewrite line_polynomial big_ord_recl big_ord0 !addr0 mul1mx [near_one i 0]mxE.
  by rewrite ler_add2r mxE mxE mulr1 ger0_norm.
move=> i; rewrite big_ord_recl big_ord0 !addr0 mul1mx [near_one i 0]mxE /line /= mulNmx mul1mx addNr norm0 mul0r addr0.
by rewrite ler_add2r mxE normr1.
Qed.

(* between its ends a line is nowhere larger than there, and the norm of (1, 1) is at most 2 *)
Example between : `|\sum_(j < 2) (1 : R) * half ^+ j| <= Num.max `|1| `|1 + 1| + \sum_(j < 0) `|1|.
Proof.
apply: (@polynomial_between R 0 (fun=> 1)); rewrite invr_ge0 ler0n/= invf_le1 ?ltr0n//.
by rewrite ler1n.
Qed.
Example norm_of_ones : norm one ones <= \sum_i 1 * `|ones i 0|.
Proof. by apply: norm_entries => [||i|i]; rewrite ?ler01//; [exact: symmetric | exact: form_one_ge0 | rewrite mxE eqxx expr1n]. Qed.
End Two.
