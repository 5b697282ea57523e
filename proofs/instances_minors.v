(* The rules of `complementary_subsystem` and `assignability` applied to concrete systems, with every
   hypothesis discharged, so that no theorem is vacuous.

   One state, A = 0, one input, one output; the modulus is 6.  With B = C = 1 the pencil [x, 1; 1, 0] is
   complete; with B = C = 0 the pencil [x, 0; 0, 0] has the remnant polynomial x. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph strong_components.
From mcexact Require Import determinantal_divisors companions complementary_subsystem.
From mcexact Require Import spectrum_split assignability.
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

(* `assignability`.  One channel with B = C = 1: one component, of dimension 1, and nothing fixed. *)
Notation one := (fun _ : 'I_1 => 1%N).
Definition free : multichannel R 1 one one := Multichannel 0 (fun=> 1%:M) (fun=> 1%:M).
Notation Q S := (map_system (@Zloc_rat l6) S).

Lemma whole_space (n m : nat) (p q : 'I_m -> nat) (S : multichannel rat n p q) c : zero_transfer S c set0.
Proof.
apply: (@ZeroTransfer _ _ _ _ _ S c set0 n 1%:M id) => [|j _|i]; last by rewrite inE.
  by rewrite mxsub_id mul1mx mulmx1.
by rewrite mxsub_id mul1mx.
Defined.

Lemma stack1 (K : ringType) (S : multichannel K 1 one one) :
  mcB S ord0 = 1%:M -> inputs S setT = \mxrow_(i < 1) 1%:M.
Proof. by move=> e; apply/eq_mxrow => i; rewrite inE ord1. Qed.
Lemma reached_stack (M : 'M[R]_1) B : map_mx (@residue l6) B = \mxrow_(i < 1) 1%:M ->
  reached (reach M B 1) 1.
Proof.
move=> e; exists 1%:M, (\mxcol_(k < 1) \mxcol_(i < 1) 1%:M); rewrite mul1mx map_reach e.
by rewrite /reach mul_mxrow_mxcol big_ord1 /= mul_mxrow_mxcol big_ord1 mulmx1.
Qed.

Lemma free_evidence c : c = setT -> minimal_evidence free c.
Proof.
move=> ->; apply: (@MinimalEvidence l6 1 1 one one free setT 1 (whole_space _ _) 1%:M 0
  (inputs free setT) (outputs free setT)) => /=.
- by rewrite map_mx0 !mul0mx; apply/matrixP=> i j; rewrite !mxE big1// => t _; rewrite !mxE mulr0.
- by rewrite mul1mx mxsub_id map_inputs.
- by rewrite map_outputs.
- by apply: reached_stack; rewrite map_inputs stack1//= map_mx1.
apply: reached_stack; rewrite -map_trmx map_outputs /outputs tr_mxcol; apply/eq_mxrow => i.
by rewrite inE /= map_mx1 trmx1.
Defined.

Lemma one_component (e : rel 'I_1) j : component e j = setT.
Proof. by apply/setP=> i; rewrite component_rule inE !ord1 !connect0. Qed.
Lemma free_components : [set (fun _ : 'I_1 => [set: 'I_1]) b | b in 'I_1] =
  [set component (arc (Q free)) j | j in 'I_1].
Proof. by apply: eq_imset => j; rewrite one_component. Qed.

Definition free_one := free_evidence erefl.
Lemma inst_assignability : exists phi : {poly rat}, [/\ phi \is monic, (size phi + 1 = 2)%N &
  forall F : gains algC one one, char_poly (closed_loop (map_system h (Q free)) F) =
    map_poly h phi * component_polynomial free_one h F].
Proof.
have inj : injective (fun _ : 'I_1 => [set: 'I_1]) by move=> i j _; rewrite !ord1.
have [phi [m s e]] := assignability_rule inj free_components (fun=> free_one).
by exists phi; split=> [//||F]; [rewrite -s big_ord1 | rewrite e big_ord1].
Qed.
Definition inst_component_realized := component_realized free_one 3.
Lemma inst_mcmillan : (1 <= 1)%N.
Proof. by exact: (mcmillan_degree free_one (fun k => erefl)). Qed.
Definition inst_own_gains (F : gains algC one one) :=
  component_own_gains free_one h (fun i (_ : i \in [set: 'I_1]) => erefl (F i)).

(* One state that channel 0 drives and channel 1 measures: two components of dimension 0, and the
   eigenvalue 0 of A stays for all gains. *)
Notation two := (fun _ : 'I_2 => 1%N).
Definition line : multichannel R 1 two two :=
  Multichannel 0 (fun i => (i == ord0)%:R%:M) (fun i => (i != ord0)%:R%:M).

Lemma line_arc j i : arc (Q line) j i -> (j == ord0) && (i != ord0).
Proof.
have z : map_mx (@Zloc_rat l6) (0%:R%:M : 'M_1) = 0.
  by apply/matrixP=> a b; rewrite !mxE mul0rn rmorph0.
apply: contraR; rewrite negb_and negbK => /orP[/negPf j1|i0]; rewrite /arc /transfer /=.
  by rewrite j1 [map_mx _ 0%:R%:M]z (map_mx0 (polyC_rmorphism _)) mulmx0.
by rewrite i0 [map_mx _ 0%:R%:M]z (map_mx0 (polyC_rmorphism _)) !mul0mx.
Qed.
Lemma line_component j : component (arc (Q line)) j = [set j].
Proof.
have up a b : connect (arc (Q line)) a b -> (a <= b)%N.
  case/connectP=> s; elim: s a => [a _ ->//|t s IH a /= /andP[/line_arc/andP[/eqP-> _] _] _] //.
apply/setP=> i; rewrite component_rule inE; apply/andP/eqP=> [[/up ji /up ij]|->]; last by rewrite !connect0.
by apply/val_inj/eqP; rewrite eqn_leq ij ji.
Qed.
Lemma line_components : [set (fun b : 'I_2 => [set b]) b | b in 'I_2] =
  [set component (arc (Q line)) j | j in 'I_2].
Proof. by apply: eq_imset => j; rewrite line_component. Qed.

Lemma line_zero b : zero_transfer (Q line) [set b] set0.
Proof.
apply: (@ZeroTransfer _ _ _ _ _ (Q line) [set b] _ (b == ord0) (const_mx 1) (fun=> ord0)) => /=.
- by rewrite map_mx0 mul0mx; apply/matrixP=> i j; rewrite !mxE big1// => k _; rewrite !mxE mulr0.
- move=> j /set1P ->; apply/matrixP=> i k; rewrite !mxE !ord1.
  case: eqP => _; last by rewrite big_ord0 mul0rn rmorph0.
  by rewrite big_ord1 !mxE mul1r.
by move=> i; rewrite inE.
Defined.

Lemma line_evidence b : minimal_evidence line [set b].
Proof.
apply: (@MinimalEvidence l6 1 2 two two line [set b] 0 (line_zero b) 0 0 0 0) => /=; try exact: reached0;
  try by apply/matrixP=> -[].
rewrite mulmx0; apply/outputs_eq0 => i /set1P -> /=; apply/matrixP=> j k; rewrite !mxE.
case: eqP k => [_ k|_ []//]; rewrite big1// => t _; by rewrite !mxE mul0rn rmorph0 mul0r.
Defined.

Lemma inst_line : exists phi : {poly rat}, [/\ phi \is monic, size phi = 2%N &
  forall F : gains algC two two, char_poly (closed_loop (map_system h (Q line)) F) =
    map_poly h phi * \prod_(b < 2) component_polynomial (line_evidence b) h F].
Proof.
have [phi [m s e]] := assignability_rule (@set1_inj _) line_components line_evidence.
exists phi; split=> [//||F]; last exact: e.
by move: s; rewrite big1 ?addn0.
Qed.

(* The same by hand: A = 0, B = C = 1 is its own minimal realization. *)
Lemma reach_unit (K : fieldType) (M : 'M[K]_1) : row_free (reach M (1%:M : 'M_1) 1).
Proof.
apply/row_freeP; exists (\mxcol_(i < 1) 1%:M).
by rewrite /reach mul_mxrow_mxcol big_ord1 mulmx1.
Qed.
Lemma inst_spectrum_split : exists phi : {poly rat},
  [/\ phi \is monic, (size phi + \sum_(j in [set: 'I_1]) 1 = 2)%N &
  forall (L : fieldType) (f : {rmorphism rat -> L}) (F : forall j : 'I_1, 'M[L]_1),
    char_poly (map_mx f (0 : 'M_1) + \sum_(j in [set: 'I_1]) map_mx f 1%:M *m F j *m map_mx f 1%:M) =
    map_poly f phi * \prod_(j in [set: 'I_1]) part (fun=> 0) (fun=> 1%:M) (fun=> 1%:M) f F j].
Proof.
apply: (@spectrum_split rat_fieldType [finType of 'I_1] one one one (fun=> 0%N) (fun=> 0) (fun=> 1%:M)
  (fun=> 1%:M) one one) => // [j|j|j i _ _]; first exact: reach_unit.
  by rewrite trmx1; apply: reach_unit.
by rewrite !ord1 eqxx.
Qed.
Lemma inst_minimal_realization : (1 <= 1)%N.
Proof.
have obs : row_free (reach (0 : 'M[rat]_1)^T (1%:M : 'M_1)^T 1) by rewrite trmx1; apply: reach_unit.
exact: (minimal_realization (reach_unit 0) obs (fun k => erefl)).
Qed.
