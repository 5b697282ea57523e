(* The strong components of the transfer graph: two integrators that know nothing of each other, over Q
   with eigenvalues among the algebraic numbers.  Nothing is fixed, there are two components, and the
   spectrum is that of both. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel controllability anderson_clements joint_controllability.
From mcexact Require Import gain_lines neighbor_graph extended_bound strong_components component_gains.
From mcexact Require Import component_assignment.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation f := [rmorphism of (ratr : rat -> algC)].
Notation Q := [fieldType of rat].
Notation one := (fun _ : 'I_2 => 1%N).

Definition apart : multichannel rat 2 one one :=
  Multichannel 0 (fun i => delta_mx i 0) (fun i => delta_mx 0 i).

Lemma apart_infinite : infinite Q. Proof. exact/char0_infinite/char_num. Qed.

Lemma apart_loop (a : rat) : closed_loop apart (fun=> a%:M) = a%:M.
Proof.
rewrite /closed_loop add0r /= -[RHS]scalemx1 mx1_sum_delta scaler_sumr; apply: eq_bigr => i _.
by rewrite mul_mx_scalar -scalemxAl mul_delta_mx.
Qed.

Lemma apart_not_fixed lambda : ~ fixed_over f apart lambda.
Proof.
move=> h; have := h (fun=> (if lambda == 0 then 1 else 0)%:M); rewrite apart_loop map_scalar_mx /=.
case/eigenvalueP=> v; rewrite mul_mx_scalar => /eqP; rewrite -subr_eq0 -scalerBl scaler_eq0 subr_eq0.
case/orP=> [/eqP e|/eqP-> /eqP//]; move: e; have [->|l0] := eqVneq lambda 0.
  by rewrite rmorph1 => /eqP; rewrite oner_eq0.
by rewrite rmorph0 => /esym/eqP; rewrite (negPf l0).
Qed.

Lemma apart_arc j i : transfer_arc apart j i = (j == i).
Proof.
apply/transfer_arcP/eqP=> [[[|t]]|->].
- by rewrite /krylov /= mul_delta_mx_cond; case: (eqVneq i j) => [->//|_]; rewrite mulr0n eqxx.
- by rewrite krylovS mul0mx mulmx0 eqxx.
exists 0%N; rewrite /krylov /= mul_delta_mx; apply/eqP=> /matrixP/(_ 0 0)/eqP.
by rewrite !mxE !eqxx oner_eq0.
Qed.

Lemma apart_components : #|components apart| = 2%N.
Proof.
have c1 j : component (transfer_arc apart) j = [set j].
  apply/setP=> i; rewrite component_rule inE; apply/andP/eqP=> [[/connectP[s]]|->]; last by rewrite connect0.
  by elim: s j => [j _ -> //|k s IH j /= /andP[]]; rewrite apart_arc => /eqP <-; apply: IH.
rewrite /components card_in_imset ?card_ord// => j i _ _; rewrite !c1; exact: set1_inj.
Qed.

Example component_gains_apart := component_gains apart_infinite apart_not_fixed.
Example component_spectrum_apart d T h := @component_spectrum Q 2 2 one one apart d T h.
Example component_assignment_apart := component_assignment apart_infinite apart_not_fixed.
Example component_spectrum_dynamic_apart d T h := @component_spectrum_dynamic Q 2 2 one one apart d T h.
