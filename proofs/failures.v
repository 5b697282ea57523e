(* checker/constructions.py: plants after failures of actuators, sensors, agents and links.

   What failed does nothing any more: inputs reach the plant through P_i and outputs the controllers through Q_i,
   diagonal matrices of ones and, for what failed, zeros.  P_i and Q_i are any matrices here, so that rows which a
   link that failed no longer carries may also be left out. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Failed.
Variables (R : ringType) (n m : nat) (p q a b : 'I_m -> nat) (X : multichannel R n p q).
Variables (P : forall i, 'M[R]_(p i, a i)) (Q : forall i, 'M[R]_(b i, q i)).

Definition failed : multichannel R n a b :=
  Multichannel (mcA X) (fun i => mcB X i *m P i) (fun i => Q i *m mcC X i).

(* A controller of what is left is one of the plant. *)
Theorem failed_loop (F : gains R a b) :
  closed_loop failed F = closed_loop X (fun i => P i *m F i *m Q i).
Proof. by congr (_ + _); apply: eq_bigr => i _; rewrite /= !mulmxA. Qed.
End Failed.

(* No failure moves a fixed mode. *)
Theorem fixed_after_failure (L : fieldType) n m (p q a b : 'I_m -> nat) (X : multichannel L n p q)
    (P : forall i, 'M[L]_(p i, a i)) (Q : forall i, 'M[L]_(b i, q i)) lambda :
  fixed X lambda -> fixed (failed X P Q) lambda.
Proof. by move=> h F; rewrite failed_loop; apply: h. Qed.

(* What is fixed after some failures is fixed after more of them. *)
Theorem fixed_after_more (L : fieldType) n m (p q a b c d : 'I_m -> nat) (X : multichannel L n p q)
    (P : forall i, 'M[L]_(p i, a i)) (Q : forall i, 'M[L]_(b i, q i))
    (P' : forall i, 'M[L]_(a i, c i)) (Q' : forall i, 'M[L]_(d i, b i)) lambda :
  fixed (failed X P Q) lambda -> fixed (failed X (fun i => P i *m P' i) (fun i => Q' i *m Q i)) lambda.
Proof.
move=> h F; rewrite failed_loop.
have -> : closed_loop X (fun i => P i *m P' i *m F i *m (Q' i *m Q i)) =
    closed_loop (failed X P Q) (fun i => P' i *m F i *m Q' i).
  by rewrite failed_loop; congr (_ + _); apply: eq_bigr => i _; rewrite !mulmxA.
exact: h.
Qed.
