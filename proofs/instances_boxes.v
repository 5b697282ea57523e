(* One state, one channel, A = 0, B = C = 1: on the disc |lambda| <= 1/2 the pencil of u = -y is regular for every A
   within 1/4 of 0, and every such A has its eigenvalue within 1/2 of 0. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel boxes.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation K := [numFieldType of rat].
Notation half := (2%:R^-1 : rat).
Notation quarter := (4%:R^-1 : rat).
Definition A' : 'M[K]_1 := quarter%:M.

Lemma ord1_all (P : 'I_1 -> Prop) : P 0 -> forall i, P i. Proof. by move=> P0 i; rewrite ord1. Qed.
Lemma inside : `|half - 0| <= half. Proof. by rewrite subr0. Qed.
Lemma within : forall i j, `|(A' - 0) i j| <= (quarter%:M : 'M[K]_1) i j.
Proof. by do 2!apply: ord1_all; rewrite !mxE subr0. Qed.
Lemma positive : forall i : 'I_1, (0 : K) < 1. Proof. by []. Qed.

(* 1 is about the inverse of 1 - 0, for E = 1 and c = 1, within 1/2. *)
Lemma near : `|half - 1| <= half. Proof. by []. Qed.
Lemma small i : \sum_j `|(i == j)%:R - ((1%:M : 'M[K]_1) *m (1 *: 1%:M - 0)) i j| * 1 +
    \sum_j (\matrix_(i, j) \sum_k `|(1%:M : 'M[K]_1) i k| * (quarter%:M : 'M[K]_1) k j) i j * 1 +
    half * (\sum_j `|((1%:M : 'M[K]_1) *m 1%:M) i j| * 1) < 1.
Proof. by move: i; apply: ord1_all; rewrite !big_ord1 subr0 scale1r mulmx1 !mxE big_ord1 !mxE. Qed.
Definition inst_regular_disc_left := regular_disc_left near positive within small.

Lemma small' i : \sum_j `|(i == j)%:R - ((1 *: 1%:M - 0) *m (1%:M : 'M[K]_1)) i j| * 1 +
    \sum_j (\matrix_(i, j) \sum_k (quarter%:M : 'M[K]_1) i k * `|(1%:M : 'M[K]_1) k j|) i j * 1 +
    half * (\sum_j `|((1%:M : 'M[K]_1) *m 1%:M) i j| * 1) < 1.
Proof. by move: i; apply: ord1_all; rewrite !big_ord1 subr0 scale1r mulmx1 !mxE big_ord1 !mxE. Qed.
Definition inst_regular_disc_right := regular_disc_right near positive within small'.

Lemma others (f : 'I_1 -> K) : \sum_(j | j != 0) f j = 0.
Proof. by rewrite big1 => // j; rewrite ord1. Qed.
Lemma inst_exterior : exists i : 'I_1, ~~ (half < `|quarter - 0|).
Proof.
apply: (@exterior K quarter 1 1%:M 1%:M 0 A' quarter%:M (fun=> 0) (fun=> half) within).
- by apply: ord1_all; rewrite others mulmx1 mxE.
- apply: ord1_all; rewrite others !mulmx1 mul1mx !big_ord_recl !big_ord0 !mxE.
  by [].
by rewrite subrr unitmxE det0 unitr0.
Qed.

(* The same where A is p/8 with |p| <= 1, up to 1/8. *)
Notation part := (8%:R^-1 : rat).
Notation share := (fun _ : 'I_1 => (1 : K)).
Definition direction (_ : 'I_1) : 'M[K]_1 := part%:M.
Lemma share1 : forall k, `|share k| <= 1. Proof. by move=> k; rewrite normr1. Qed.
Lemma moved_within : forall i j, `|(A' - (0 + \sum_k share k *: direction k)) i j| <= (part%:M : 'M[K]_1) i j.
Proof. by do 2!apply: ord1_all; rewrite big_ord1 scale1r add0r !mxE. Qed.
Lemma small_tied i : \sum_j `|(i == j)%:R - ((1%:M : 'M[K]_1) *m (1 *: 1%:M - 0)) i j| * 1 +
    \sum_j (\matrix_(i, j) (\sum_k `|(1%:M : 'M[K]_1) i k| * (part%:M : 'M[K]_1) k j +
      \sum_k `|((1%:M : 'M[K]_1) *m direction k) i j|)) i j * 1 +
    half * (\sum_j `|((1%:M : 'M[K]_1) *m 1%:M) i j| * 1) < 1.
Proof. by move: i; apply: ord1_all; rewrite !big_ord1 subr0 scale1r mulmx1 [(\matrix_(_, _) _) _ _]mxE !big_ord1 mul1mx !mxE. Qed.
Definition inst_regular_disc_left_tied := regular_disc_left_tied near share1 positive moved_within small_tied.

Lemma small_tied' i : \sum_j `|(i == j)%:R - ((1 *: 1%:M - 0) *m (1%:M : 'M[K]_1)) i j| * 1 +
    \sum_j (\matrix_(i, j) (\sum_k (part%:M : 'M[K]_1) i k * `|(1%:M : 'M[K]_1) k j| +
      \sum_k `|(direction k *m (1%:M : 'M[K]_1)) i j|)) i j * 1 +
    half * (\sum_j `|((1%:M : 'M[K]_1) *m 1%:M) i j| * 1) < 1.
Proof. by move: i; apply: ord1_all; rewrite !big_ord1 subr0 scale1r mulmx1 [(\matrix_(_, _) _) _ _]mxE !big_ord1 !mulmx1 !mxE. Qed.
Definition inst_regular_disc_right_tied := regular_disc_right_tied near share1 positive moved_within small_tied'.

Lemma inst_exterior_tied : exists i : 'I_1, ~~ (half < `|quarter - 0|).
Proof.
apply: (@exterior_tied K quarter 1 share share1 1 1%:M 1%:M 0 A' part%:M direction (fun=> 0) (fun=> half) moved_within).
- by apply: ord1_all; rewrite others mulmx1 mxE.
- apply: ord1_all; rewrite others !mulmx1 mul1mx !big_ord1 !mulmx1 !mul1mx !mxE.
  by [].
by rewrite subrr unitmxE det0 unitr0.
Qed.

Definition inst_square_in_disc : `|(0 : algC)| <= 2%:R.
Proof.
apply: (@square_in_disc _ 0 1 2%:R) => //; rewrite ?raddf0 ?normr0 ?ler01// ?ler0n//.
by rewrite expr1n -natrX ler_nat.
Qed.

Lemma inst_growth : ~~ ((2%:R : K) <= `|quarter|).
Proof.
apply: (@growth K 1 A' A' (fun=> 1) xpredT quarter 2%:R (const_mx 1)).
- by do 2!apply: ord1_all; rewrite !mxE.
- by [].
- by [].
- by [].
- by move=> i _; rewrite big_ord_recl big_ord0 ord1 mxE.
- by move=> i _; rewrite mul_scalar_mx !mxE.
- by [].
by apply/eqP => /colP/(_ 0); rewrite !mxE.
Qed.

Notation one := (fun _ : 'I_1 => 1%N).
Definition driven : multichannel K 1 one one := Multichannel 0 (fun=> 1%:M) (fun=> 1%:M).
Lemma inst_regular_not_fixed : ~ fixed driven 1.
Proof.
apply: (@regular_not_fixed K 1 1 one one driven 1 (fun=> 0) (fun=> 1%:M)).
have e : \mxcol_i ((0 : 'M[K]_1) *m mcC driven i) = 0 :> 'M_(\sum_i one i, 1).
  by rewrite -[RHS](@mxcol0 _ _ one); apply: eq_mxcol => i; rewrite mul0mx.
have e' : \mxdiag_i (1%:M + 0%:M : 'M[K]_(one i)) = 1%:M.
  by rewrite -mxdiagZ; apply: eq_mxdiag => i; rewrite raddf0 addr0.
by rewrite /pencil_of e e' unitmxE det_ublock det1 mulr1 subr0 det_scalar1 unitr1.
Qed.
Definition inst_near_identity := fun M : 'M[K]_1 => @near_identity K 1 M (fun=> 1) positive.
Definition inst_dominant := @dominant K 1 1%:M.

(* x' = u, y = x: under u = -y the eigenvalue is within 1/2 of -1 for every input and output within 1/8 of 1. *)
Notation eighth := (8%:R^-1 : rat).
Definition driven' : multichannel K 1 one one := Multichannel 0 (fun=> (1 + eighth)%:M) (fun=> (1 + eighth)%:M).
Definition back (i : 'I_1) : 'M[K]_(one i, one i) := (- 1)%:M.
Definition radii (i : 'I_1) : 'M[K]_(one i, 1) := eighth%:M.
Definition radii' (i : 'I_1) : 'M[K]_(1, one i) := eighth%:M.
Lemma certain : forall i j, `|(mcA driven' - mcA driven) i j| <= (0 : 'M[K]_1) i j.
Proof. by do 2!apply: ord1_all; rewrite !mxE. Qed.
Lemma inputs_within : forall c i j, `|(mcB driven' c - mcB driven c) i j| <= radii' c i j.
Proof. by move=> c; do 2!apply: ord1_all; rewrite !mxE. Qed.
Lemma outputs_within : forall c i j, `|(mcC driven' c - mcC driven c) i j| <= radii c i j.
Proof. by move=> c; do 2!apply: ord1_all; rewrite !mxE. Qed.
Definition inst_gains_within := gains_within back certain inputs_within outputs_within.
Lemma inst_fixed_in_exterior : ~ fixed driven' 0.
Proof.
move=> fix_; have [||i] := fixed_in_exterior (F := back) certain inputs_within outputs_within
    (Y := 1%:M) (T := 1%:M) (a := fun=> - 1) (rad := fun=> half) _ _ fix_.
- by apply: ord1_all; rewrite others mulmx1 mxE.
- apply: ord1_all; rewrite others /closed_loop !mulmx1 mul1mx !big_ord1 !mxE !big_ord1 !mxE /= !big_ord1 !mxE /=. by [].
by rewrite sub0r opprK normr1.
Qed.

Lemma inst_uncontrolled_fixed : fixed (measured (0 : 'M[K]_1) (0 : 'M[K]_1)) 0.
Proof. by apply: uncontrolled_fixed; rewrite raddf0 subr0 oppr0 row_mx0 mxrank0. Qed.
