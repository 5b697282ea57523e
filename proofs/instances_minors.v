(* The rules of `complementary_subsystem` and `assignability` applied to concrete systems, with every
   hypothesis discharged, so that no theorem is vacuous.

   One state, A = 0, one input, one output; the modulus is 6.  With B = C = 1 the pencil [x, 1; 1, 0] is
   complete; with B = C = 0 the pencil [x, 0; 0, 0] has the remnant polynomial x. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic controllability transfer_graph.
From mcexact Require Import determinantal_divisors companions complementary_subsystem.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Definition l6 := @Modulus 6 isT.
Notation R := (Zloc l6).
Notation Qm := (map_mx (@Zloc_rat l6)).
Notation h := ([rmorphism of (ratr : rat -> algC)]).

Lemma reached1 : reached (1%:M : 'M[R]_1) 1.
Proof. by exists 1%:M, 1%:M; rewrite map_mx1 !mulmx1. Qed.
Lemma reached0 d e (M : 'M[R]_(d, e)) : reached M 0.
Proof. by exists 0, 0; apply/matrixP=> -[]. Qed.

(* B = C = 1: c = 1, everything else of no size; L = G = 1, N = 0. *)
Lemma open_evidence : smith_evidence (l := l6) (0 : 'M_1) 1%:M (1%:M : 'M_1) 2 [::] 0 1 0.
Proof.
apply: (@SmithEvidence l6 1 1 1 0 1%:M 1%:M 2 [::] 0 1 0 0 0 0 0 0 0 0 1%:M 1%:M 0) => //;
  try exact: reached0; try (exact: reached1); try by apply/matrixP=> i [].
- by rewrite mulmx0 addr0 mulmx1 map_mx1.
- by rewrite !mul0mx.
- by move=> i j; rewrite mxE.
- by rewrite mulmx1; apply: reached1.
Qed.

Notation opened := (system_matrix 0 (Qm 1%:M) (1%:M : 'M_1)).
Lemma inst_complete : transfer 0 (Qm 1%:M) (1%:M : 'M_1) != 0 /\
  forall lambda : algC, (1 <= \rank (map_mx (horner_eval lambda \o map_poly h) opened))%N.
Proof. by apply/(complete_rule open_evidence); split=> //; apply: big_nil. Qed.

(* B = C = 0: X = 1, the invariant polynomial x, S = 1. *)
Lemma size_X1 : (size ('X : {poly rat})).-1 = 1%N. Proof. by rewrite size_polyX. Qed.
Lemma degrees_X : degrees [:: 'X : {poly rat}] = 1%N. Proof. by rewrite /= size_polyX. Qed.
Lemma companions_X : companions [:: 'X : {poly rat}] = 0.
Proof.
apply/matrixP=> i j; have z (m : nat) (e : m = 1%N) (t : 'I_m) : t = 0%N :> nat.
  by move: t; rewrite e => t; rewrite ord1.
rewrite /=; case: (split_ordP i) => [i' ->|[]//]; case: (split_ordP j) => [j' ->|[]//].
rewrite block_mxEul !mxE (z _ size_X1 i') (z _ size_X1 j') size_polyX eqxx coefX oppr0.
by [].
Qed.
Lemma reached_const d : d = 1%N -> reached (row_mx (0 : 'M[R]_(1, 0)) (const_mx 1 : 'M_(1, d))) (0 + d).
Proof.
move=> ->; exists (1%:M : 'M_1), (1%:M : 'M_1); rewrite mul1mx mulmx1.
apply/matrixP=> i j; rewrite !mxE !ord1; case: splitP => [[]//|t _]; rewrite mxE.
by rewrite -[RHS](rmorph1 [rmorphism of @residue l6]).
Qed.
Lemma stuck_evidence : smith_evidence (l := l6) (0 : 'M_1) (0 : 'M_1) (0 : 'M_1) 1 [:: 'X] 0 0 1.
Proof.
apply: (@SmithEvidence l6 1 1 1 0 0 0 1 [:: 'X] 0 0 1 0 (const_mx 1) 0 0 0 1%:M 0 0 0 0) => //;
  try exact: reached0; try (exact: reached1); try by apply/matrixP=> i [].
- by rewrite /= /nonconstant monicX size_polyX.
- by rewrite degrees_X.
- by rewrite mul0mx map_mx0 mulmx0 addr0 companions_X row_mx0 map_mx0 row_mx0 col_mx0 mulmx0.
- by rewrite mul0mx mulmx0.
- by rewrite mul0mx.
- by rewrite mul0mx.
- by rewrite map_mx0 !mul0mx addr0.
- by rewrite !mul0mx.
- by case.
- exact: reached_const degrees_X.
Qed.

Notation stuck := (system_matrix 0 (Qm (0 : 'M_1)) (0 : 'M_1)).
Lemma inst_remnant d : divides_minors stuck 1 d <-> d %| 'X.
Proof. by rewrite (remnant_gcd stuck_evidence) /remnant big_seq1. Qed.
Lemma inst_transfer_zero : transfer (0 : 'M_1) (Qm (0 : 'M_1)) (0 : 'M_1) = 0.
Proof. exact/(transfer_zero stuck_evidence). Qed.
Lemma inst_normal_rank f g : minor (r := 2) stuck f g = 0.
Proof. by have /(_ 2%N)[_] := normal_rank stuck_evidence; apply. Qed.
Lemma inst_invariant d : divides_minors stuck 0 d <-> d %| 1.
Proof. by rewrite (invariant_polynomials stuck_evidence _ (leq0n _)) big_ord0. Qed.
Lemma inst_remnant_roots : (1 <= \rank (map_mx (horner_eval 0 \o map_poly h)
  stuck))%N = false.
Proof. by rewrite (remnant_roots stuck_evidence) /remnant big_seq1 map_polyX rootX eqxx. Qed.
Definition inst_determinantal_divisors (K : fieldType) :=
  @determinantal_divisors K _ _ (diagonal [:: 1; 'X]) _ (equivalent_refl _).
