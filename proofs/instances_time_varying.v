(* x(t+1) = 2 x + 0 u, y = x: no input moves it, and twice as far apart after each step are two of its states. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability time_varying.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Notation ones := (fun _ : 'I_1 => 1%N).
Notation one := (1%:M : 'M[rat]_1).
Definition doubled : multichannel rat 1 ones ones := Multichannel 2%:R%:M (fun=> 0) (fun=> one).
Definition place (i : 'I_1) : nat := i.

Lemma apart : injective place. Proof. exact: ord_inj. Qed.
Lemma later i j k : (place i < place j)%N -> mcC doubled i *m krylov (mcA doubled) (mcB doubled j) k = 0.
Proof. by rewrite (ord1 i) (ord1 j). Qed.

Lemma doubled_fixed : fixed (map_system (idfun : rat -> rat) doubled) 2%:R.
Proof.
move=> F; apply/eigenvalueP; exists one; last by rewrite -[1%:M]/one oner_eq0.
rewrite /closed_loop big1 => [|i _]; last by rewrite /= map_mx0 !mul0mx.
by apply/matrixP => i j; rewrite addr0 !mxE big_ord1 !mxE (ord1 i) (ord1 j) /= !mulr1n mul1r mulr1.
Qed.

Definition inst_no_causal_control_moves := no_causal_control_moves apart later doubled_fixed.

(* Nobody measures: the states 0 and 2^t from rest. *)
Definition idle : controller [ringType of rat] ones ones := fun _ _ _ => 0.
Definition still (t : nat) : 'cV[rat]_1 := 0.
Definition running (t : nat) : 'cV[rat]_1 := iter t (mulmx 2%:R%:M) 1.
Lemma follows_still : follows doubled idle still.
Proof. by move=> t; rewrite big1 ?addr0 ?mulmx0 // => i _; rewrite mul0mx. Qed.
Lemma follows_running : follows doubled idle running.
Proof. by move=> t; rewrite big1 ?addr0 // => i _; rewrite mul0mx. Qed.
Lemma causal_idle : causal idle. Proof. by []. Qed.
Lemma start : one *m running 0%N = one *m still 0%N + one *m 1. Proof. by rewrite /still mulmx0 add0r. Qed.

Lemma invariant : one *m mcA doubled = 2%:R%:M *m one. Proof. by rewrite mul1mx mulmx1. Qed.
Lemma unmoved j : j \notin (set0 : {set 'I_1}) -> one *m mcB doubled j = 0. Proof. by rewrite mulmx0. Qed.
Lemma seen i : i \in (set0 : {set 'I_1}) -> mcC doubled i = 0 *m one. Proof. by rewrite inE. Qed.
Lemma driven : 2%:R%:M *m one = one *m 2%:R%:M. Proof. by rewrite mul1mx mulmx1. Qed.
Lemma hidden i : i \in (set0 : {set 'I_1}) -> (0 : 'M[rat]_1) *m one = 0. Proof. by rewrite inE. Qed.
Definition inst_same_for_ever :=
  same_for_ever invariant unmoved seen driven hidden causal_idle follows_still follows_running start.
