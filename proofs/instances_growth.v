(* One state and one input: ranks that stop by a relation, a state that is not controlled and one that
   is not observed, and rows in two blocks. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic controllability rank_growth realization echelon hankel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Local Notation A0 := (0 : 'M[rat]_1).
Local Notation B1 := (1%:M : 'M[rat]_1).

Lemma reach_one k : (0 < k)%N -> \rank (reach A0 B1 k) = 1%N.
Proof.
move=> k0; apply/eqP; rewrite -[_ == _]/(row_free _) -kermx_eq0.
have /reach_annihilated/(_ 0%N k0) := mulmx_ker (reach A0 B1 k).
by rewrite /krylov /= mulmx1 => ->.
Qed.

Lemma inst_own_inputs_free : row_free B1.
Proof.
apply: (@own_inputs_free _ 1 1 B1 id) => [t|s t]; first by rewrite !ord1 !mxE oner_eq0.
by rewrite !ord1 ltnn.
Qed.

(* A B = 0 is a relation of degree 1. *)
Lemma inst_related : related A0 B1 1 (row 0 B1).
Proof.
exists 1%N => //; exists (fun i => (i == 1%N)%:R%:M); split.
  by rewrite !big_ord_recl big_ord0 /= raddf0 mulmx0 /krylov /= !mul0mx !addr0.
by apply/rowP => j; rewrite !ord1 !mxE.
Qed.

Lemma inst_relations_bound : (\rank (reach A0 B1 2) <= \rank (reach A0 B1 1) + (1 - 1))%N.
Proof.
apply: (relations_bound inst_own_inputs_free) => t; rewrite ord1.
by have [h hk [v [rv ->]]] := inst_related; exists h => //; apply: relation_idle rv.
Qed.

Lemma inst_steps_do_not_grow :
  (\rank (reach A0 B1 2) + \rank (reach A0 B1 0) <= \rank (reach A0 B1 1) + \rank (reach A0 B1 1))%N.
Proof. exact: steps_do_not_grow. Qed.

Lemma inst_growth_rule : \rank (reach A0 B1 2) = 1%N.
Proof.
apply: (@growth_rule _ 1 1 A0 B1 1 (fun k => (0 < k)%N : nat) (fun k => (0 < k)%N : nat) 0 0 0) => //.
- by rewrite mul0mx mulmx0.
- by rewrite mul0mx.
- by move=> [|[|//]] _ //; rewrite reach_one.
- move=> [|[|//]] _.
    exists (0 : 'M_(0, 1)); last by case.
    by rewrite /row_free mxrank0.
  exists B1; first exact: inst_own_inputs_free.
  by move=> t; rewrite ord1; apply: inst_related.
- by move=> [|[|//]] _.
Qed.

(* A state that no input moves: W = 1, and nothing is left. *)
Lemma inst_kernel_realization : exists (d : nat) (A' : 'M[rat]_d) (B' : 'M_(d, 1)) (C' : 'M_(1, d)),
  d = 0%N /\ forall k, B1 *m krylov A0 A0 k = C' *m krylov A' B' k.
Proof.
apply: (@kernel_realization _ 1 1 1 1 0 A0 A0 B1 1%:M 0 0 0).
- by rewrite /row_free mxrank1.
- by rewrite /row_free ?trmx0 mxrank0.
- by rewrite mulmx0 mul0mx.
- by rewrite mulmx0.
- by apply/matrixP => i -[].
- by apply/matrixP => i -[].
- by apply/matrixP => i -[].
Qed.

(* One state, which is on the path. *)
Lemma inst_path_realization k : A0 *m krylov A0 B1 k =
  colsub enum_val A0 *m krylov (mxsub enum_val enum_val A0 : 'M_#|[set: 'I_1]|) (rowsub enum_val B1) k.
Proof.
apply: (@path_realization _ 1 1 1 A0 B1 A0 setT set0).
- by move=> a; rewrite inE.
- by move=> a u; rewrite inE.
- by move=> a b; rewrite inE.
- by move=> a b _; rewrite inE.
by move=> v b; rewrite inE.
Qed.

Lemma inst_block_echelon : exists Y : 'M[rat]_2, (1%:M *m 1%:M : 'M[rat]_2) *m Y = 1%:M.
Proof.
apply: (@block_echelon _ 2 2 2 1%:M 1%:M id (fun s : 'I_2 => s : nat)) => // s t.
- by rewrite mulmx1 mxE => ts; case: eqP ts => // ->; rewrite ltnn.
- by move=> _; rewrite mulmx1 mxE.
Qed.

Definition l7 : modulus := @Modulus 7 isT.

(* s = 1, 0, 0, ... has the degree 1, and 1 is its numerator. *)
Lemma num_one (R : comRingType) (s : nat -> R) : s 0%N = 1 -> num 'X 1 s = 1.
Proof.
move=> s0; rewrite /num big_ord1 s0 scale1r /dual; apply/polyP => i.
by rewrite coef_poly coefX coef1; case: i => [|[|i]].
Qed.

Lemma inst_mcmillan_from_below : (1 <= 1)%N.
Proof.
apply: (@mcmillan_from_below l7 'X 1 (fun k => (k == 0%N)%:R) 1 0 _ _ _ _ 1 1 1 A0 B1 B1 0 B1 B1 1 A0 B1 B1) => //.
- exact: monicX.
- by rewrite size_polyX.
- by rewrite num_one ?mul1r ?mul0r ?addr0// rmorph1.
- by move=> k; rewrite mulmx0 mul0mx addr0 !mulmx1 mul1mx; case: k => [|k]; rewrite ?krylovS ?mul0mx /= ?rmorph1 ?rmorph0 ?scalar_mx0 ?raddf0.
Qed.
