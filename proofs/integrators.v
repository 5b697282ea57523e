(* Section III: the plant with an integrator of every output.  (19): it is observable where the plant
   is; (20): every mode but 0 is controllable where the plant's is; (21): 0 is controllable iff
   [A, B; C, 0] has full row rank; and whatever the inputs are, y = r at every equilibrium. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Integrators.
Variables (K : fieldType) (n b q : nat) (A : 'M[K]_n) (B : 'M[K]_(n, b)) (C : 'M[K]_(q, n)).

(* (18) without r: state (x, w), w' = C x *)
Definition integrated_A : 'M[K]_(n + q) := block_mx A 0 C 0.
Definition integrated_B : 'M[K]_(n + q, b) := col_mx B 0.
Definition integrated_C : 'M[K]_(q, n + q) := row_mx 0 1%:M.

Lemma integrated_left (w1 : 'rV[K]_n) (w2 : 'rV[K]_q) lambda :
  row_mx w1 w2 *m integrated_A = lambda *: row_mx w1 w2 <->
  w1 *m A + w2 *m C = lambda *: w1 /\ lambda *: w2 = 0.
Proof.
rewrite /integrated_A mul_row_block !mulmx0 addr0 scale_row_mx; split; last by move=> [-> ->].
by move/eq_row_mx => [e1 e2]; split; first exact: e1; exact: esym e2.
Qed.

Lemma integrated_input (w1 : 'rV[K]_n) (w2 : 'rV[K]_q) : row_mx w1 w2 *m integrated_B = w1 *m B.
Proof. by rewrite /integrated_B mul_row_col mulmx0 addr0. Qed.

(* (19) *)
Theorem integrated_observable lambda : ~~ uncontrollable_mode A^T C^T lambda ->
  ~~ uncontrollable_mode integrated_A^T integrated_C^T lambda.
Proof.
move=> h; apply/uncontrollable_modeP => -[w [nw wA wC]]; move: nw wA wC.
rewrite -[w]hsubmxK /integrated_A /integrated_C tr_block_mx tr_row_mx !trmx0 trmx1.
set w1 := lsubmx w; set w2 := rsubmx w => nw.
rewrite mul_row_block !mulmx0 !addr0 scale_row_mx => /eq_row_mx[e1 e2].
rewrite mul_row_col mulmx0 add0r mulmx1 => w20.
case/negP: h; apply/uncontrollable_modeP; exists w1; split.
- by apply: contra nw => /eqP w10; rewrite w10 w20 row_mx0.
- exact: e1.
by rewrite e2 w20 scaler0.
Qed.

(* (20), for lambda other than 0 *)
Theorem integrated_controllable lambda : lambda != 0 -> ~~ uncontrollable_mode A B lambda ->
  ~~ uncontrollable_mode integrated_A integrated_B lambda.
Proof.
move=> n0 h; apply/uncontrollable_modeP => -[w [nw wA wB]]; move: nw wA wB.
rewrite -[w]hsubmxK; set w1 := lsubmx w; set w2 := rsubmx w => nw /integrated_left[e1 /eqP].
rewrite scaler_eq0 (negPf n0) /= => /eqP w20; rewrite integrated_input => wB.
case/negP: h; apply/uncontrollable_modeP; exists w1; split => //.
  by apply: contra nw => /eqP w10; rewrite w10 w20 row_mx0.
by rewrite -e1 w20 mul0mx addr0.
Qed.

(* (21) *)
Theorem integrated_zero : ~~ uncontrollable_mode integrated_A integrated_B 0 =
  row_free (block_mx A B C (0 : 'M_(q, b))).
Proof.
apply/idP/idP => [h|fr].
  rewrite -kermx_eq0; apply/rowV0P => w /sub_kermxP e; apply/eqP; apply: contraNT h => nw.
  move: nw e; rewrite -[w]hsubmxK; set w1 := lsubmx w; set w2 := rsubmx w => nw.
  rewrite mul_row_block mulmx0 addr0 -(row_mx0 _ 1 n b) => /eq_row_mx[e1 e2].
  apply/uncontrollable_modeP; exists (row_mx w1 w2); split; first exact: nw.
    by apply/integrated_left; rewrite !scale0r; split.
  by rewrite integrated_input.
apply/uncontrollable_modeP => -[w [nw wA wB]]; move: nw wA wB.
rewrite -[w]hsubmxK; set w1 := lsubmx w; set w2 := rsubmx w => nw /integrated_left[e1 _].
rewrite integrated_input => e2; case/negP: nw; apply/eqP; apply: (row_free_inj fr).
by rewrite /= mul0mx mul_row_block mulmx0 addr0 e1 e2 scale0r row_mx0.
Qed.

(* Whatever u is, be it of a controller or not: where x and w stand still, y = r. *)
Theorem integrated_equilibrium (x : 'cV[K]_n) (w r : 'cV[K]_q) (u : 'cV[K]_b) :
  integrated_A *m col_mx x w + integrated_B *m u - col_mx 0 r = 0 -> C *m x = r.
Proof.
rewrite /integrated_A /integrated_B mul_block_col !mul0mx !addr0 mul_col_mx mul0mx add_col_mx.
rewrite opp_col_mx add_col_mx => /eqP; rewrite col_mx_eq0 => /andP[_].
by rewrite addr0 subr_eq0 => /eqP.
Qed.
End Integrators.

(* (18) as a system with m channels: agent i has the input u_i and the outputs w_i *)
Section Channels.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Notation sum_q := (\sum_i q i)%N.

Definition integrated : multichannel K (n + sum_q) p q :=
  Multichannel (integrated_A (mcA S) (outputs S setT)) (fun i => integrated_B sum_q (mcB S i))
               (fun i => row_mx 0 (submxcol 1%:M i)).

Lemma inputs_integrated : inputs integrated setT = integrated_B sum_q (inputs S setT).
Proof.
have sub a b (X : 'M[K]_(a, \sum_i p i)) i :
    submxrow (col_mx X (0 : 'M_(b, \sum_i p i))) i = col_mx (submxrow X i) 0.
  by apply/matrixP => r c; rewrite !mxE; case: split => s; rewrite !mxE.
by apply/mxrowP => i; rewrite mxrowK in_setT /integrated_B sub mxrowK in_setT.
Qed.

Lemma outputs_integrated : outputs integrated setT = integrated_C K n sum_q.
Proof.
apply/mxcolP => i; rewrite mxcolK in_setT /=; apply/matrixP => r c; rewrite /integrated_C !mxE.
by case: split => s; rewrite !mxE.
Qed.
End Channels.

(* Whatever the controller is that stands beside plant and integrators: where all stands still, y = r. *)
Theorem integrators_at_rest (K : fieldType) n q l (C : 'M[K]_(q, n)) (M : 'M[K]_(n + q + l))
    (e : 'cV_(n + q + l)) (r : 'cV_q) : dsubmx (usubmx M) = row_mx (row_mx C 0) 0 ->
  M *m e + col_mx (col_mx 0 (- r)) 0 = 0 ->
  C *m usubmx (usubmx e) = r.
Proof.
move=> rows z; have : dsubmx (usubmx (M *m e + col_mx (col_mx 0 (- r)) 0)) = 0.
  by rewrite z !linear0.
rewrite !linearD /= col_mxKu col_mxKd -mul_usub_mx -mul_dsub_mx rows -{1}[e]vsubmxK mul_row_col mul0mx addr0.
rewrite -{1}[usubmx e]vsubmxK mul_row_col mul0mx addr0 => /eqP.
by rewrite subr_eq0 => /eqP.
Qed.
