(* x' = x + u, y = x: its output with an integrator, twice as an output, and its input two steps late; and x' = x, which
   no input moves. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence sampling servo.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation ones := (fun _ : 'I_1 => 1%N).
Notation one := (1%:M : 'M[rat]_1).
Definition lag : multichannel rat 1 ones ones := Multichannel one (fun=> one) (fun=> one).
Definition unmoved : multichannel rat 1 ones ones := Multichannel one (fun=> 0) (fun=> one).
Definition twice (i : 'I_1) : 'M[rat]_1 := 2%:R%:M.
Definition itself (i : 'I_1) : 'M[rat]_1 := 1%:M.

Lemma unmoved_fixed : fixed unmoved 1.
Proof.
move=> F; apply/eigenvalueP; exists one; last by rewrite -[1%:M]/one oner_eq0.
by rewrite /closed_loop big1 => [|i _]; rewrite /= ?mul0mx// addr0 mul1mx scale1r.
Qed.

Definition inst_regulated_loop := regulated_loop lag twice itself.
Definition inst_regulated_fixed := regulated_fixed twice unmoved_fixed.
Definition inst_servo_loop := servo_loop lag itself 0 itself (fun=> 0).
Definition inst_servo_fixed := servo_fixed itself 0 unmoved_fixed.

(* At rest where x = 3, u = -3, w = 0: y is at its set-point 3. *)
Lemma rest : col_mx (mcA lag *m 3%:R%:M + inputs lag setT *m - (\mxcol_i 3%:R%:M))
    (selected lag itself *m 3%:R%:M + 0 *: 0 - (\mxcol_i 3%:R%:M)) = col_mx (0 *: 3%:R%:M) (0 *: 0).
Proof.
rewrite !scale0r !addr0; congr col_mx.
  rewrite mulmxN /inputs mul_mxrow_mxcol big_ord1 in_setT /= !mul1mx subrr.
  by [].
rewrite /selected mxcol_mul; apply/eqP; rewrite subr_eq0; apply/eqP/eq_mxcol => i.
by rewrite /= !mul1mx.
Qed.
Definition inst_servo_equilibrium := servo_equilibrium rest.

(* The gain 1 from w and none from y: no eigenvalue is 0. *)
Lemma moved : ~ fixed (servo lag itself 0) 0.
Proof.
move=> /(_ (fun i => row_mx one 0)); rewrite (servo_loop lag itself 0 (fun=> one) (fun=> 0)) /dynamic_loop.
case/eigenvalueP => v; rewrite scale0r -[v]hsubmxK; set v1 := lsubmx v; set v2 := rsubmx v.
rewrite mul_row_block -(row_mx0 _ 1 1) => /eq_row_mx[e1 e2] /negP; apply; apply/eqP.
have v10 : v1 = 0.
  move: e2; rewrite /= mxdiagZ raddf0 mulmx0 addr0 mul_mxrow => /(congr1 (fun M => submxrow M ord0)).
  by rewrite mxrowK submxrow0 /= !mulmx1.
move: e1; rewrite v10 mul0mx add0r -[v2]submxrowK mul_mxrow_mxcol big_ord1 /= !mulmx1 => e1.
by rewrite -(row_mx0 _ 1 1); congr row_mx; apply/mxrowP => i; rewrite mxrowK submxrow0 ord1.
Qed.
Definition inst_servo_solvable := servo_solvable moved.
Definition inst_solvable_equilibrium := solvable_equilibrium one (\mxcol_i one) inst_servo_solvable.

(* Two steps late, from rest, with the input 1 at every step: the first state counts up, later ones follow. *)
Fixpoint run t : 'cV[rat]_(states 1 1 2) :=
  if t is t'.+1 then (registered one one 2).1 *m run t' + (registered one one 2).2 *m one else 0.
Definition inst_registered_late := registered_late (fun t => erefl : run t.+1 = _ *m run t + _ *m one).

Lemma tenth (M : 'M[rat]_1) : within (M + (10%:R^-1)%:M - M) (10%:R^-1)%:M.
Proof. by move=> i j; rewrite addrC addKr !ord1 mxE eqxx ger0_norm ?invr_ge0 ?ler0n. Qed.
Definition inst_registered_within := registered_within 2 (tenth one) (tenth one).
Definition inst_selected_within := selected_within (2%:R%:M : 'M_1) (tenth one).
