(* The construction after Theorem 1: plant and distributed observer get every spectrum, n eigenvalues
   by the F_i and mn + m - 1 by the observer, whose channel controller has order m - 1. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines neighbor_graph error_system.
From mcexact Require Import delayed_systems brasch_pearson theorem_1 corollary_1.
From mcexact Require Import distributed_observer.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section OneController.
Variables (K : fieldType) (n m : nat) (p q k : 'I_m -> nat) (o : 'I_m).
Hypothesis only : forall i, i != o -> k i = 0%N.
Notation J := (agent_block K k o).

Lemma sum_only : (\sum_i k i = k o)%N.
Proof. by rewrite (bigD1 o) //= big1 ?addn0. Qed.

Lemma only_tr : J^T *m J = 1%:M.
Proof.
have JJ := block_tr K k o; have rJ : \rank J = k o.
  by apply/eqP/row_freeP; exists J^T.
have /row_fullP[B eB] : row_full J by rewrite /row_full rJ sum_only.
by rewrite -eB; congr (_ *m _); rewrite -[LHS]mul1mx -eB -mulmxA JJ mulmx1.
Qed.

(* where agent o alone has a controller *)
Lemma dynamic_loop_only (S : multichannel K n p q) (D : controllers K p q k) :
  char_poly (dynamic_loop S D) = char_poly (block_mx (closed_loop S (ctF D)) (mcB S o *m ctG D o)
    (ctL D o *m mcC S o) (ctK D o)).
Proof.
pose G : 'M[K]_(n + k o, n + \sum_i k i) := block_mx 1%:M 0 0 J.
have GG : G *m G^T = 1%:M.
  rewrite /G tr_block_mx !trmx0 trmx1 mulmx_block !(mulmx0, mul0mx, mulmx1, addr0, add0r).
  by rewrite block_tr -scalar_mx_block.
have fG : row_free G by apply/row_freeP; exists G^T.
have uG : row_full G by rewrite /row_full (eqP fG) sum_only.
symmetry; apply: (controllability.char_poly_similar fG uG).
rewrite /G /dynamic_loop !mulmx_block !(mulmx0, mul0mx, mulmx1, mul1mx, addr0, add0r).
congr block_mx.
- rewrite -[LHS]mulmx1 -only_tr mulmxA; congr (_ *m _).
  by apply: trmx_inj; rewrite trmx_mul trmxK tr_mxrow block_col.
- exact: block_col.
exact: block_diag.
Qed.

End OneController.

Section Construction.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Hypothesis inf : infinite K.
Variables (n m : nat) (p q k : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (o : 'I_m).
Hypothesis sc : strongly_connected (neighbor_arc N).
Hypothesis only : forall i, i != o -> k i = 0%N.
Hypothesis order : k o = m.-1.
Variable S : multichannel K n p q.
Notation nm := (\sum_(i < m) n)%N.

Lemma member_at (T : 'I_m -> Type) (d : forall i, T i) (x : T o) :
  exists g : forall i, T i, g o = x.
Proof.
exists (fun i => if o =P i is ReflectT e then ecast i (T i) e x else d i).
by case: eqP => // e; rewrite eq_axiomK.
Qed.

(* the channel controller of agent o, for given F_i *)
Theorem theorem_1_controllers F (P : {poly K}) : jointly_observable S ->
  P \is monic -> size P = (m * n + m.-1).+1 ->
  exists D : controllers K (fun=> n) (fun i => q i + nm)%N k,
    char_poly (dynamic_loop (error_system N S F) D) = P.
Proof.
move=> jo mP sP; have := theorem_1 f inf sc F o jo mP sP; rewrite -order.
move=> [KK [H [Kb [Hb [Ab [Cb eP]]]]]].
have [G eG] := @member_at (fun i => 'M[K]_(n, k i)) (fun=> 0) Cb.
have [X eX] := @member_at (fun i => 'M[K]_(k i, q i + nm)) (fun=> 0) (row_mx Kb (\mxrow_j Hb j)).
have [Z eZ] := @member_at (fun i => 'M[K]_(k i)) (fun=> 0) Ab.
exists (Controllers (observer_gains KK H) G X Z); rewrite (dynamic_loop_only only) /=.
by rewrite -eP /error_loop eG eX eZ.
Qed.

(* plant and observer: the spectra of A + sum B_i F_i and of the errors, both prescribed *)
Theorem construction (P P' : {poly K}) : jointly_controllable S -> jointly_observable S ->
  P \is monic -> size P = n.+1 -> P' \is monic -> size P' = (m * n + m.-1).+1 ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers K (fun=> n) (fun i => q i + nm)%N k),
    char_poly (observer_loop N S F D) = P * P'.
Proof.
move=> jc jo mP sP mP' sP'; have [F eF] := joint_state_feedback f inf jc mP sP.
have [D eD] := theorem_1_controllers F jo mP' sP'; exists F, D.
by rewrite paper_spectrum eD /feedback_loop eF.
Qed.

(* any rate: all eigenvalues at one place *)
Theorem construction_rate (x : K) : jointly_controllable S -> jointly_observable S ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers K (fun=> n) (fun i => q i + nm)%N k),
    forall lambda : L, eigenvalue (map_mx f (observer_loop N S F D)) lambda -> lambda = f x.
Proof.
move=> jc jo; pose P t : {poly K} := ('X - x%:P) ^+ t.
have mP t : P t \is monic by rewrite monic_exp ?monicXsubC.
have sP t : size (P t) = t.+1 by rewrite size_exp_XsubC.
have [F [D e]] := construction jc jo (mP n) (sP n) (mP _) (sP _); exists F, D => lambda.
rewrite eigenvalue_root_char -map_char_poly e /P -exprD rmorphX /= rmorphB /= map_polyX map_polyC.
by move/rootP; rewrite horner_exp hornerXsubC => /eqP; rewrite expf_eq0 subr_eq0 => /andP[_ /eqP].
Qed.

End Construction.
