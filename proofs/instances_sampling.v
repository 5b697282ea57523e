(* x' = x + u, held for h = 1: the terms 1/k!, of which the first is built, and all that follow are within the
   radii; and the second alone. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import sampling.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Local Notation one := (1%:M : 'M[rat]_1).
Local Notation half := (2%:R^-1 : rat).
Definition v k : 'M[rat]_1 := (k`!%:R^-1)%:M.
Definition V k : 'M[rat]_1 := (k == 1%N)%:R%:M.
Definition F k : 'M[rat]_1 := (if k == 2%N then half else 0)%:M.

Lemma member : within one one.
Proof. by move=> i j; rewrite !ord1 mxE eqxx normr1. Qed.
Lemma near : within (one - one) (0 : 'M[rat]_1).
Proof. by move=> i j; rewrite subrr !mxE normr0. Qed.
Lemma first : within (v 1%N - V 1%N) (F 1%N).
Proof. by move=> i j; rewrite /v /V /F /= invr1 subrr !mxE normr0 mul0rn. Qed.
Lemma series k : (0 < k)%N -> k.+1%:R *: v k.+1 = one *m v k.
Proof.
move=> _; rewrite mul1mx /v scale_scalar_mx factS natrM invfM mulrA divff ?mul1r//.
by rewrite pnatr_eq0.
Qed.
Lemma errors k : (0 < k < 2)%N -> forall i j,
  (one *m F k + 0 *m map_mx (fun x : rat => `|x|) (V k) + map_mx (fun x : rat => `|x|) (one *m V k - k.+1%:R *: V k.+1)) i j
    <= k.+1%:R * F k.+1 i j.
Proof.
case: k => [|[|]]// _ i j; rewrite !ord1 /F /V /= mul1mx mul0mx addr0 mul1mx scale_scalar_mx mulr0.
by rewrite !mxE eqxx !mulr1n add0r subr0 normr1 mulfV.
Qed.
Lemma last_built : V 2%N = 0. Proof. by rewrite /V /= raddf0. Qed.
Lemma growth (i : 'I_1) : \sum_j one i j * 1 <= 1 * 1 :> rat.
Proof. by rewrite big_ord1 !ord1 mxE eqxx !mulr1. Qed.
Lemma last (i j : 'I_1) : F 2%N i j <= half * 1.
Proof. by rewrite !ord1 /F /= mxE eqxx mulr1. Qed.

Definition inst_sampled_within N (KN : (2 <= N)%N) := @sampled_within _ 1 1 one one one 0 v V F (fun=> 1) 1 2 (fun=> half)
  (fun _ _ => true) member near first series errors isT last_built (fun=> ltr01) growth ler01 isT last
  (fun i j no => False_ind _ (notF no)) (fun i l j no => False_ind _ (notF no)) N KN.

(* 2 v 2 = v 1, and nothing is built. *)
Lemma second : 2%:R *: v 2%N = one *m v 1%N. Proof. exact: series. Qed.
Lemma exact_first : within (v 1%N - v 1%N) (0 : 'M[rat]_1).
Proof. by move=> i j; rewrite subrr !mxE normr0. Qed.
Lemma two_pos : 0 < 2%:R :> rat. Proof. by rewrite ltr0n. Qed.
Definition inst_term_within := term_within (0 : 'M[rat]_1) two_pos member near exact_first second.

(* Of the terms after 1/2! = 1/2. *)
Lemma column_series j : (2 + j).+1%:R *: col ord0 (v (2 + j.+1)%N) = one *m col ord0 (v (2 + j)%N).
Proof. by rewrite addnS !colE scalemxAl series// mulmxA. Qed.
Lemma column_last (i : 'I_1) : `|col ord0 (v (2 + 0)%N) i 0| <= half * 1.
Proof. by rewrite mxE !ord1 /v mxE eqxx mulr1n mulr1 ger0_norm ?invr_ge0 ?ler0n. Qed.
Definition inst_tail_within J := @tail_within _ 1 one one (fun=> 1) 1 2 (fun j => col ord0 (v (2 + j)%N)) half
  (fun=> ltr01) member growth ler01 isT column_series column_last J ord0.

(* x' = u, held for h = 1: the one term is 1, to which the sums tend. *)
Local Notation zero := (0 : 'M[rat]_1).
Definition v0 k : 'M[rat]_1 := (k == 1%N)%:R%:M.
Lemma zero_member (M : 'M[rat]_1) : within zero (map_mx (fun x : rat => `|x|) M).
Proof. by move=> i j; rewrite !mxE normr0 normr_ge0. Qed.
Lemma zero_near : within (zero - zero) zero. Proof. by move=> i j; rewrite subrr !mxE normr0. Qed.
Lemma zero_first : within (v0 1%N - v0 1%N) zero. Proof. by move=> i j; rewrite subrr !mxE normr0. Qed.
Lemma zero_series k : (0 < k)%N -> k.+1%:R *: v0 k.+1 = zero *m v0 k.
Proof. by case: k => // k _; rewrite mul0mx /v0 /= raddf0 scaler0. Qed.
Lemma zero_errors k : (0 < k < 2)%N -> forall i j,
  (map_mx (fun x : rat => `|x|) zero *m zero + zero *m map_mx (fun x : rat => `|x|) (v0 k)
    + map_mx (fun x : rat => `|x|) (zero *m v0 k - k.+1%:R *: v0 k.+1)) i j <= k.+1%:R * zero i j.
Proof.
case: k => [|[|]]// _ i j; rewrite -zero_series// subrr mulmx0 mul0mx !add0r !mxE normr0.
by rewrite mulr0.
Qed.
Lemma zero_last_built : v0 2%N = 0. Proof. by rewrite /v0 raddf0. Qed.
Lemma zero_growth (i : 'I_1) : \sum_j map_mx (fun x : rat => `|x|) zero i j * 1 <= 0 * 1 :> rat.
Proof. by rewrite big_ord1 !mxE normr0 mul0r. Qed.
Lemma zero_last (i j : 'I_1) : zero i j <= 0 * 1. Proof. by rewrite mxE mul0r. Qed.
Lemma sums_tend : forall eps : rat, 0 < eps -> exists N0, forall N, (N0 <= N)%N -> forall i j,
  `|(\sum_(1 <= k < N.+1) v0 k) i j - one i j| <= eps.
Proof.
move=> eps e0; exists 1%N => -[//|N] _ i j; rewrite big_nat_recl// big1_seq => [|k /andP[_]]; last first.
  by rewrite mem_index_iota => /andP[k0 _]; rewrite /v0 eqSS (gtn_eqF k0) raddf0.
by rewrite addr0 /v0 eqxx subrr normr0 ltW.
Qed.
Definition inst_sampled_limit := @sampled_limit _ 1 1 zero zero _ zero v0 v0 (fun=> zero) (fun=> 1) 0 2 (fun=> 0)
  (fun _ _ => true) (zero_member zero) zero_near zero_first zero_series zero_errors isT zero_last_built (fun=> ltr01) zero_growth
  (lexx 0) isT zero_last (fun i j no => False_ind _ (notF no)) (fun i l j no => False_ind _ (notF no)) one sums_tend.
