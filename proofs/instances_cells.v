(* The square of half the side 1 around 0, whole and cut into four, and one real system with an input that does nothing. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel cells.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Instances.
Variable C : numClosedFieldType.

Lemma near : `|(0 : C) - 0| <= 1. Proof. by rewrite subr0 normr0 ler01. Qed.
Definition inst_disc_in_square : square (0 : C) 1 0 := disc_in_square near.
Definition inst_four_parts := four_parts inst_disc_in_square.

Lemma cut : covered (fun z : C => square 0 1 z \/ True) 0 1.
Proof. by apply: Cut => e f _ _; apply: Leaf => z _; right. Qed.
Definition inst_cover := cover cut inst_disc_in_square.
Definition inst_cover_disc := cover_disc cut near.

Notation one := (fun _ : 'I_1 => 1%N).
Definition idle : multichannel C 1 one one := Multichannel 0 (fun=> 0) (fun=> 0).
Lemma real_0 a b : real_entries (0 : 'M[C]_(a, b)). Proof. exact: map_mx0. Qed.
Lemma idle_fixed : fixed idle 0.
Proof.
move=> F; have -> : closed_loop idle F = 0 by rewrite /closed_loop big1 ?addr0// => i _; rewrite !mul0mx.
by rewrite eigenvalue_root_char /char_poly /char_poly_mx map_mx0 subr0 det_scalar1 rootX.
Qed.
Definition inst_conjugate_fixed : fixed idle 0^* :=
  conjugate_fixed (@real_0 _ _ : real_entries (mcA idle)) (fun i => @real_0 _ _) (fun i => @real_0 _ _) idle_fixed.
Definition inst_conjugate_rank := @conjugate_rank C 1 1 one one idle (@real_0 _ _) 1 0 'i (@real_0 _ _).
End Instances.
