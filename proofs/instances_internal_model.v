(* x' = x + u, y = x, whose output follows ramps: at 0, and at another number. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel internal_model instances_servo.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Lemma ramp_root : root ('X^2 : {poly rat}) 0.
Proof. by rewrite rootE hornerXn expr0n. Qed.
Lemma no_ramp_root : ~~ root ('X^2 : {poly rat}) 1.
Proof. by rewrite rootE hornerXn expr1n oner_eq0. Qed.

Definition inst_signal_fixed := signal_fixed lag itself (monicXn _ 2) ramp_root.
Definition inst_other_fixed := other_fixed lag itself (monicXn _ 2) no_ramp_root.
