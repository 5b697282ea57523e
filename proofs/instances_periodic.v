(* x(t+1) = 4 x(t) in even steps, x(t+1) = x(t) / 8 in odd ones: over two steps half of it is left. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import periodic.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Definition factor (t : nat) : rat := if odd t then 8%:R^-1 else 4%:R.
Definition step (t : nat) : 'M[rat]_1 := (factor t)%:M.
Lemma step_periodic t : step (t + 2) = step t. Proof. by rewrite /step /factor oddD addbF. Qed.

Definition from (s t : nat) : 'cV[rat]_1 := passed step s t *m 1.
Lemma from_loop s : loop step s (from s). Proof. by move=> t; rewrite /from /= mulmxA. Qed.

Definition inst_periods := periods step_periodic 3 (from_loop 0).
Definition inst_any_step := any_step step_periodic 3 1 (isT : (1 <= 2)%N) (from_loop 1).

Lemma halved : monodromy step 2 = (2%:R^-1)%:M.
Proof.
rewrite /monodromy /= mulmx1 -scalar_mxM; congr (_%:M); exact/eqP.
Qed.
Lemma half : eigenvalue (monodromy step 2) 2%:R^-1.
Proof.
apply/eigenvalueP; exists 1; last by rewrite -[1]/(1%:M) -scalemx1 scaler_eq0 oner_eq0 oner_eq0.
by rewrite halved mul1mx scalemx1.
Qed.
Definition inst_same_eigenvalues := same_eigenvalues step_periodic (isT : (1 <= 2)%N) (isT : (2%:R^-1 : rat) != 0).
