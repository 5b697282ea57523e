(* Free assignment of the whole spectrum through one channel (end of IV-A), and what follows:
   Corollary 1 for extended systems, and the end of V-B for extended systems whose delays are
   bridged by holding.  State feedback is the case k = 0 with the state as output. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines extended neighbor_graph extended_bound.
From mcexact Require Import sequential_gains feedback corfmat_morse error_system free_assignment.
From mcexact Require Import lifted held delayed_systems delays delayed_transfer brasch_pearson.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* gains F, then for every channel o, every k with k + 1 at least one of the two indices through o,
   and every monic polynomial of degree n + k, a controller of order k at channel o that gives it *)
Definition freely_assignable (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) :=
  exists F, forall o : 'I_m,
    let A := closed_loop S F in let B := mcB S o in let C := mcC S o in
    [/\ controllable A B, controllable A^T C^T &
        forall k (P : {poly K}),
          \rank (reach A B k.+1) = n \/ \rank (reach A^T C^T k.+1) = n ->
          P \is monic -> size P = (n + k).+1 ->
          exists (Ac : 'M_k) (Bc : 'M_(k, q o)) (Cc : 'M_(p o, k)) (D : 'M_(p o, q o)),
            char_poly (compensated A B C Ac Bc Cc D) = P].

Section Free.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Hypothesis inf : infinite K.
Variables (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel K n p q).

(* end of IV-A: through any one channel *)
Theorem free_assignment S : strongly_connected (transfer_arc S) ->
  (forall lambda : L, ~ fixed_over f S lambda) -> freely_assignable S.
Proof.
move=> sc nofix; have [F hF] := corfmat_morse inf sc nofix; exists F => o /=.
by have [ctr obs] := hF o; split=> // k P; apply: (brasch_pearson_minimum f inf).
Qed.

(* state feedback: F gives A + B F any monic characteristic polynomial of degree n *)
Theorem state_feedback b (A : 'M[K]_n) (B : 'M_(n, b)) (P : {poly K}) :
  controllable A B -> P \is monic -> size P = n.+1 -> exists F, char_poly (A + B *m F) = P.
Proof.
move=> ctr mP sP; have obs : \rank (reach A^T (1%:M : 'M_n)^T 1) = n.
  apply/eqP/rank_reachP => w /(_ 0%N isT); by rewrite /krylov /= trmx1 mulmx1.
have [|Ac [Bc [Cc [D <-]]]] := brasch_pearson f inf ctr obs mP; first by rewrite addn0.
exists D; rewrite /compensated mulmx1; set X := A + _.
rewrite [B *m Cc]thinmx0 [Bc *m _]flatmx0 /char_poly char_block_diag_mx det_ublock.
by rewrite [\det (char_poly_mx Ac)]det_mx00 mulr1.
Qed.

(* split among the agents: A + sum B_i F_i *)
Theorem joint_state_feedback S (P : {poly K}) : jointly_controllable S ->
  P \is monic -> size P = n.+1 ->
  exists F : forall i, 'M_(p i, n), char_poly (mcA S + \sum_i mcB S i *m F i) = P.
Proof.
move=> jc mP sP; have [F <-] := state_feedback jc mP sP.
exists (fun i => submxcol F i); rewrite -[F in RHS]submxcolK /inputs mul_mxrow_mxcol.
by congr (char_poly (_ + _)); apply: eq_bigr => i _; rewrite inE.
Qed.

End Free.

Section Extended.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Hypothesis inf : infinite K.
Variables (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel K n p q).

(* Corollary 1, for a strongly connected extended transfer graph *)
Theorem corollary_1 (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) S :
  (forall i, i \in N i) -> strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S ->
  strongly_connected (transfer_arc (extended N k S)) ->
  (forall i s (lambda : L), s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  freely_assignable (extended N k S).
Proof.
by move=> hears sc jc jo sce h; apply: (free_assignment (f := f) inf sce); apply: theorem_2.
Qed.

(* which n_i > 0 gives *)
Theorem corollary_1_positive (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) S :
  (forall i, i \in N i) -> strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S -> (forall i, 0 < k i)%N ->
  (forall i s (lambda : L), s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  freely_assignable (extended N k S).
Proof.
move=> hears sc jc jo k0; apply: corollary_1 => //.
exact: proposition_3_strongly_connected.
Qed.

(* end of V-B: the same under delays, with holding *)
Theorem free_assignment_held (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) d S :
  (forall i, i \in N i) -> strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S -> (forall i, 0 < k i)%N ->
  (forall i s (lambda : L), s != set0 -> s != setT -> eigenvalue (map_mx f (mcA S)) lambda ->
     (n - \rank (pencil (map_system f S) s lambda) <= k i)%N) ->
  freely_assignable (held N k d S).
Proof.
move=> hears sc jc jo k0 h; apply: (free_assignment (f := f) inf); last exact: theorem_4.
apply/held_strongly_connected => //; apply: strongly_connected_sub sc => j i a.
by rewrite a.
Qed.

(* so finite delays never stand in the way: n_i = n is enough *)
Theorem free_assignment_delays (N : 'I_m -> {set 'I_m}) d S : (0 < n)%N ->
  (forall i, i \in N i) -> strongly_connected (neighbor_arc N) ->
  jointly_controllable S -> jointly_observable S -> freely_assignable (held N (fun=> n) d S).
Proof.
move=> n0 hears sc jc jo; apply: free_assignment_held => // i s lambda _ _ _; exact: leq_subr.
Qed.

End Extended.
