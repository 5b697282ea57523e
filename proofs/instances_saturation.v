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
