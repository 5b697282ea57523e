(* One state that no input moves and no output shows, beside a feedthrough: it stays fixed. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel feedthrough.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Definition one (i : 'I_1) := 1%N.
Definition S : multichannel rat_fieldType 1 one one := Multichannel 0 (fun=> 0) (fun=> 0).
Definition D : 'M[rat]_(\sum_i one i, \sum_i one i) := 1%:M.

Definition inst_same_rank (lambda : rat) :
    \rank (pencil (filtered S D) setT lambda) =
    (\rank (direct_pencil S D setT lambda) + \sum_i one i)%N := same_rank S D setT lambda.
Definition inst_same_fixed_modes (lambda : rat) :
    fixed (filtered S D) lambda <-> exists s, (\rank (direct_pencil S D s lambda) < 1)%N :=
  same_fixed_modes S D lambda.

Lemma inputs0 s : inputs S s = 0.
Proof.
rewrite /inputs -[RHS](@mxrow0 _ _ one); apply: eq_mxrow => i.
by case: ifP.
Qed.

Lemma outputs0 s : outputs S s = 0.
Proof.
rewrite /outputs -[RHS](@mxcol0 _ _ one); apply: eq_mxcol => i.
by case: ifP.
Qed.

Example fixed_zero : fixed (filtered S D) 0.
Proof.
apply/inst_same_fixed_modes; exists set0; rewrite /direct_pencil inputs0 outputs0 oppr0 select_rows.
have -> : \mxcol_i (if i \in set0 then submxcol D i else 0) = 0 :> 'M[rat]_(\sum_i one i, _).
  by rewrite -[RHS](@mxcol0 _ _ one); apply: eq_mxcol => i; rewrite inE.
by rewrite mul0mx /= raddf0 subrr block_mx_const mxrank0.
Qed.
