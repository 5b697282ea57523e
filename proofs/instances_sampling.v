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
