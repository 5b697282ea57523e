(* From eigenvalues to trajectories, in discrete time: a loop whose characteristic polynomial is x^N
   is at rest after N steps, from every state.  So the construction attains every rate. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines neighbor_graph error_system.
From mcexact Require Import delayed_systems brasch_pearson theorem_1 corollary_1.
From mcexact Require Import distributed_observer construction.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* x(t+1) = M x(t) *)
Definition trajectory (K : ringType) N (M : 'M[K]_N) (x : 'cV[K]_N) t : 'cV[K]_N :=
  iter t (mulmx M) x.

Lemma trajectory_add (K : ringType) N (M : 'M[K]_N) x s t :
  trajectory M x (s + t) = trajectory M (trajectory M x t) s.
Proof. exact: iterD. Qed.

Lemma trajectory_power (K : ringType) N (M : 'M[K]_N.+1) x t : trajectory M x t = M ^+ t *m x.
Proof.
elim: t => [|t IH]; first by rewrite expr0 mul1mx.
by rewrite /trajectory iterS -/(trajectory M x t) IH mulmxA exprS.
Qed.

Theorem at_rest (K : fieldType) N (M : 'M[K]_N) (x : 'cV[K]_N) t : char_poly M = 'X^N ->
  (N <= t)%N -> trajectory M x t = 0.
Proof.
case: N M x => [|N] M x e le; first exact: flatmx0.
have z : M ^+ N.+1 = 0.
  by have := Cayley_Hamilton M; rewrite e rmorphX /= horner_mx_X.
by rewrite trajectory_power -(subnK le) exprD z mulr0 mul0mx.
Qed.

(* nothing but 0 in the spectrum *)
Lemma char_poly_only_0 (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) N (M : 'M[K]_N) :
  (forall lambda, eigenvalue (map_mx f M) lambda -> lambda = 0) -> char_poly M = 'X^N.
Proof.
move=> zero; have [rs e] := closed_field_poly_normal (char_poly (map_mx f M)).
rewrite (monicP (char_poly_monic _)) scale1r in e.
have {}e : char_poly (map_mx f M) = 'X^(size rs).
  rewrite e (eq_big_seq (fun=> 'X)) => [|r rin]; last first.
    by rewrite (zero r) ?subr0 // eigenvalue_root_char e root_prod_XsubC.
  by rewrite big_const_seq count_predT iter_mulr_1.
have := size_char_poly (map_mx f M); rewrite e size_polyXn => -[sr].
by apply: (map_poly_inj f); rewrite map_char_poly e sr map_polyXn.
Qed.

(* so the loop is at rest after as many steps as it has states *)
Theorem only_0_at_rest (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) N (M : 'M[K]_N) :
  (forall lambda, eigenvalue (map_mx f M) lambda -> lambda = 0) ->
  forall x t, (N <= t)%N -> trajectory M x t = 0.
Proof. by move=> zero x t; apply: at_rest; apply: char_poly_only_0 zero. Qed.

Lemma at_rest_only_0 (K L : fieldType) (f : {rmorphism K -> L}) N (M : 'M[K]_N) t :
  (forall x, trajectory M x t = 0) -> forall lambda, eigenvalue (map_mx f M) lambda -> lambda = 0.
Proof.
case: N M => [|N] M rest lambda /eigenvalueP[w wM w0]; first by rewrite (thinmx0 w) eqxx in w0.
have z : M ^+ t = 0.
  apply/matrixP => i j; have := rest (delta_mx j 0); rewrite trajectory_power -colE.
  by move/matrixP/(_ i 0); rewrite !mxE.
have pow s : w *m (map_mx f M) ^+ s = lambda ^+ s *: w.
  elim: s => [|s IH]; first by rewrite expr0 scale1r mulmx1.
  by rewrite exprSr mulmxA IH -scalemxAl wM scalerA -exprSr.
have := pow t; rewrite -(rmorphX (map_mx_rmorphism f N)) /= z map_mx0 mulmx0 => /esym/eqP.
by rewrite scaler_eq0 (negPf w0) orbF expf_eq0 => /andP[_ /eqP].
Qed.

Section Construction.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Hypothesis inf : infinite K.
Variables (n m : nat) (p q k : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (o : 'I_m).
Hypothesis sc : strongly_connected (neighbor_arc N).
Hypothesis only : forall i, i != o -> k i = 0%N.
Hypothesis order : k o = m.-1.
Variable S : multichannel K n p q.
Notation nm := (\sum_(i < m) n)%N.

(* The plant and all agents come to rest after as many steps as they have states. *)
Theorem construction_at_rest : jointly_controllable S -> jointly_observable S ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers K (fun=> n) (fun i => q i + nm)%N k),
    forall x t, (n + (nm + \sum_i k i) <= t)%N -> trajectory (observer_loop N S F D) x t = 0.
Proof.
move=> jc jo; have [F [D e]] := construction f inf sc only order jc jo (monicXn _ n)
  (size_polyXn _ n) (monicXn _ _) (size_polyXn _ (m * n + m.-1)).
have := size_char_poly (observer_loop N S F D); rewrite e -exprD size_polyXn => -[s].
have e' : char_poly (observer_loop N S F D) = 'X^(n + (nm + \sum_i k i)) by rewrite e -exprD s.
by exists F, D => x t; apply: at_rest.
Qed.
End Construction.
