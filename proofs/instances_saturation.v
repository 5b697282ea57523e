(* Two states and two inputs that are cut off at -1 and 1, with the matrices of the sectors in instances_performance.v: the
   rules about saturation applied, with every hypothesis discharged. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import location stability instability positive_forms performance saturation instances_performance.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").
Local Notation low := (const_mx (-1) : 'rV[algC]_2).

(* x(t+1) = w + x/2, w what is cut off of -x/2 + j: any two solutions approach each other. *)
Lemma inst_global_discrete : exists rho : algC, [/\ 0 <= rho, rho < 1 & forall (z y d : nat -> 'cV[algC]_2) (w x j : nat -> 'cV[algC]_2),
  (forall t, [/\ real_mx (z t), real_mx (w t), cut_off_at low ones (times (- (1 / 2%:R)) *m z t + j t) (w t) &
    z t.+1 = times 0 *m z t + I *m (w t - (times (- (1 / 2%:R)) *m z t + j t)) + d t]) ->
  (forall t, [/\ real_mx (y t), real_mx (x t), cut_off_at low ones (times (- (1 / 2%:R)) *m y t + j t) (x t) &
    y t.+1 = times 0 *m y t + I *m (x t - (times (- (1 / 2%:R)) *m y t + j t)) + d t]) ->
  forall t, form (times (1 / 4%:R)) (z t - y t) <= rho ^+ t * form (times (1 / 4%:R)) (z 0%N - y 0%N)].
Proof.
apply: (@global_discrete _ 2 2 (times 0) (times (1 / 4%:R)) I (times (- (1 / 2%:R))) ones low ones (real_times _) ones0).
  exact: posdef_times.
rewrite /decrease_discrete /= products_of means_of diag_ones !timesE.
exact: posdef_block.
Qed.

(* x' = -x + w - j, w what is cut off of -x + j. *)
Lemma inst_global_continuous : exists2 e : algC, 0 < e & forall (z y zrate yrate d w x j : 'cV[algC]_2),
  real_mx z -> real_mx y -> real_mx w -> real_mx x ->
  cut_off_at low ones (times (-1) *m z + j) w -> cut_off_at low ones (times (-1) *m y + j) x ->
  zrate = times (-2%:R) *m z + I *m (w - (times (-1) *m z + j)) + d ->
  yrate = times (-2%:R) *m y + I *m (x - (times (-1) *m y + j)) + d ->
  ((zrate - yrate)^H *m I *m (z - y) + (z - y)^H *m I *m (zrate - yrate)) 0 0 <= - (e * form I (z - y)).
Proof.
apply: (@global_continuous _ 2 2 (times (-2%:R)) I I (times (-1)) ones low ones (real_times _) ones0 (posdef_times ltr01)).
rewrite /decrease_continuous /= products_of means_of diag_ones !timesE.
exact: posdef_block.
Qed.

(* The unit row of an input takes at most so much of a multiple of the identity. *)
Lemma posdef_less (p u s : rat) k : 0 <= s -> s * u ^+ 2 < p ->
  posdef (times p - ratr s *: ((row k (times u))^H *m row k (times u))).
Proof.
move=> s0 sp z nz; rewrite formD formN formZ -[(row k _)^H]mulmx1 form_sub form1 big_ord1 -row_mul mxE times_form.
rewrite mul_scalar_mx mxE normrM exprMn -ratr_norm -!rmorphX mulrA -rmorphM subr_gt0.
have less : ratr (s * `|u| ^+ 2) * `|z k 0| ^+ 2 <= ratr (s * `|u| ^+ 2) * form 1%:M z :> algC.
  rewrite ler_wpmul2l ?ler0q ?mulr_ge0 ?exprn_ge0// form1 (bigD1 k)//= ler_addl sumr_ge0// => i _.
  by rewrite exprn_ge0.
by rewrite (le_lt_trans less)// ltr_pmul2r ?form1_gt0// ltr_rat real_normK ?num_real.
Qed.

Local Notation far := (const_mx 2%:R : 'rV[algC]_2).
Lemma ones_ge0 k : 0 <= ones 0 k. Proof. by rewrite mxE ler01. Qed.
Lemma far_gt0 k : 0 < far 0 k. Proof. by rewrite mxE ltr0n. Qed.
Lemma far_low k : (- far) 0 k <= - far 0 k. Proof. by rewrite [(- far) 0 k]mxE. Qed.
Lemma far_high k : far 0 k <= far 0 k. Proof. exact: lexx. Qed.
Lemma quarter k : (ones 0 k / far 0 k) ^+ 2 = ratr (1 / 4%:R).
Proof. by rewrite !mxE !fmorph_div /= !ratr_nat rmorph1 expr_div_n expr1n -natrX. Qed.
Lemma products_ones : products ones ones ones = times 1.
Proof. by apply: diag_row => k; rewrite !mxE !mul1r rmorph1. Qed.
Lemma means_ones : means ones ones ones = times 1.
Proof. by apply: diag_row => k; rewrite !mxE mul1r -[1 + 1]/(2%:R) mulfV ?pnatr_eq0// rmorph1. Qed.

(* x(t+1) = 3/2 x + u, w what is cut off of u = -x at -2 and 2: where x'x <= 2 the solution stays, and it tends to 0. *)
Lemma inst_region_discrete : exists rho : algC, [/\ 0 <= rho, rho < 1 & forall z w : nat -> 'cV[algC]_2,
  form (times (1 / 2%:R)) (z 0%N) <= 1 ->
  (forall t, [/\ real_mx (z t), real_mx (w t), cut_off_at (- far) far (times (-1) *m z t) (w t) &
    z t.+1 = times (1 / 2%:R) *m z t + I *m (w t - times (-1) *m z t)]) ->
  forall t, form (times (1 / 2%:R)) (z t) <= 1 /\ form (times (1 / 2%:R)) (z t) <= rho ^+ t * form (times (1 / 2%:R)) (z 0%N)].
Proof.
apply: (region_discrete (real_times _) ones0 (posdef_times _) ones_ge0 far_gt0 far_low far_high) => // [k|].
  by rewrite quarter; apply: posdef_less.
rewrite /decrease_discrete /= products_ones means_ones diag_ones !timesE.
exact: posdef_block.
Qed.

(* x' = x + u, w what is cut off of u = -2 x. *)
Lemma inst_region_continuous : exists2 e : algC, 0 < e & forall z rate w : 'cV[algC]_2,
  real_mx z -> real_mx w -> form (times (3%:R / 2%:R)) z <= 1 -> cut_off_at (- far) far (times (-2%:R) *m z) w ->
  rate = times (-1) *m z + I *m (w - times (-2%:R) *m z) ->
  (rate^H *m times (3%:R / 2%:R) *m z + z^H *m times (3%:R / 2%:R) *m rate) 0 0 <= - (e * form (times (3%:R / 2%:R)) z).
Proof.
apply: (region_continuous (real_times _) ones0 (posdef_times _) ones_ge0 far_gt0 far_low far_high) => // [k|].
  by rewrite quarter; apply: posdef_less.
rewrite /decrease_continuous /= products_ones means_ones diag_ones !timesE.
exact: posdef_block.
Qed.

(* What falls at the rate 1 from 0 on stays below 0. *)
Lemma inst_ellipsoid_stays (R : rcfType) (sup : convergence.complete_order R) (b : R) : 0 <= b -> - b <= 0.
Proof.
apply: (@ellipsoid_stays R sup -%R 0) => [|t _]; first by rewrite oppr0.
exists (- 1) => [|_]; last by rewrite ltrN10.
by exists (fun=> - 1) => [|h]; [exact: convergence.limit_constant | rewrite mulN1r opprD].
Qed.
