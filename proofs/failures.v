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

(* Several failures: parts E fail, and P S, Q S are the masks of the parts S that work. *)
Section SoMany.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (X : multichannel L n p q) (E : finType).
Variables (P : {set E} -> forall i, 'M[L]_(p i)) (Q : {set E} -> forall i, 'M[L]_(q i)).
Hypothesis masks_in : forall S S' i, P (S :&: S') i = P S i *m P S' i.
Hypothesis masks_out : forall S S' i, Q (S :&: S') i = Q S' i *m Q S i.

Definition after (K : {set E}) := failed X (P (~: K)) (Q (~: K)).

Theorem fixed_after_all_in (K K' : {set E}) lambda :
  K \subset K' -> fixed (after K) lambda -> fixed (after K') lambda.
Proof.
move=> sub h F; rewrite failed_loop.
have -> : closed_loop X (fun i => P (~: K') i *m F i *m Q (~: K') i) =
    closed_loop (after K) (fun i => P (~: K') i *m F i *m Q (~: K') i).
  have both : ~: K' = ~: K :&: ~: K' by apply/esym/setIidPr; rewrite setCS.
  rewrite failed_loop; congr (_ + _); apply: eq_bigr => i _.
  by rewrite {1}both {2}both masks_in masks_out !mulmxA.
exact: h.
Qed.

(* Where no k parts meet the complement of every set of failures that are harmless, more than k matter. *)
Theorem at_least_so_many (harmless : seq {set E}) k lambda (K : {set E}) :
  (forall G, G \in harmless -> ~ fixed (after G) lambda) ->
  (forall H : {set E}, (#|H| <= k)%N -> exists2 G, G \in harmless & [disjoint H & ~: G]) ->
  fixed (after K) lambda -> (k < #|K|)%N.
Proof.
move=> good miss fx; rewrite ltnNge; apply/negP => /miss [G inG]; rewrite disjoints_subset setCK => sub.
exact: good inG (fixed_after_all_in sub fx).
Qed.
End SoMany.
