(* The real numbers: the only file that rests on axioms, those of mathcomp-analysis and of Coq's real numbers, which
   `make proofs` prints apart.

   The other files speak of trajectories in continuous time over a real closed field in which bounded sets have suprema
   (complete_order of convergence.v), and of every solution of x' = Mx.  Here both are discharged for every real type of
   mathcomp-analysis, among them Coq's real numbers: the order is complete (real_complete), and x' = Mx has a solution from
   every initial value, the power series of exp(tM) x(0) (solution_exists), and so has x' = Mx + b (solution_with_input).
   The function g with g' = -ag, which stands in place of the exponential elsewhere, is exp(-at) (decay).

   With them the theorems of paper.v about continuous time have no hypothesis but the paper's: construction_real and
   setpoints_real; they are applied to the systems of instances_reproduction.v at the end. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import boolp classical_sets functions reals topology normedtype sequences derive exp.
From mathcomp.real_closed Require Import complex.
From mathcomp Require Rstruct.
From mcexact Require Import multichannel joint_controllability neighbor_graph error_system distributed_observer.
From mcexact Require Import integrators convergence example example_hypotheses concrete paper.
From mcexact Require Import instances_sharing_gap instances_reproduction.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Import numFieldNormedType.Exports.
Local Open Scope ring_scope.

Section Real.
Variable R : realType.

Theorem real_complete : complete_order R.
Proof.
move=> E [t Et] [b ub]; pose A : set R := [set x | E x]%classic.
have ne : (A !=set0)%classic by exists t.
have bounded : has_ubound A by exists b => x /ub.
exists (sup A); split=> [x Ex|c uc]; first exact: sup_ub.
by apply: sup_le_ub => // x /uc.
Qed.

(* the derivative of mathcomp-analysis is that of convergence.v *)
Lemma derivative_of (u : R -> R) (t d : R) : is_derive (t : R^o) (1 : R^o) (u : R^o -> R^o) d -> derivative u t d.
Proof.
case=> du; rewrite /derive => ed; pose s h := if h == 0 then d else h^-1 * (u (t + h) - u t).
exists s => [e e0|h]; last first.
  rewrite /s; case: eqP => [->|/eqP h0]; first by rewrite addr0 mulr0 addr0.
  by rewrite mulrAC mulVf // mul1r [RHS]addrC subrK.
move/cvgrPdist_le/(_ _ e0): du; rewrite ed => /nbhs_ballP[r /= r0 near_0]; exists r => // h hr.
rewrite /s; case: eqP => [_|/eqP h0]; first by rewrite subrr normr0 ltW.
have := near_0 h; rewrite /ball /= sub0r normrN => /(_ hr h0).
by rewrite distrC /GRing.scale /= mulr1 [h + t]addrC.
Qed.

Lemma derivative_scaled (u : R -> R) c t d : derivative u (c * t) d -> derivative (fun s => u (c * s)) t (c * d).
Proof.
case=> s ls e; exists (fun h => c * s (c * h)) => [|h]; last by rewrite mulrDr e [c * s _]mulrC -mulrA.
apply: limitM; first exact: limit_constant.
move=> x x0; have [r r0 hs] := ls x x0; have c0 : 0 < `|c| + 1 by rewrite ltr_paddl ?ltr01.
exists (r / (`|c| + 1)) => [|h]; first exact: divr_gt0.
rewrite ltr_pdivl_mulr // => hr; apply: hs; rewrite normrM mulrC.
by apply: le_lt_trans hr; rewrite ler_wpmul2l // ler_addl.
Qed.

Lemma derivative_exp (a t : R) : derivative (fun s : R => expR (- a * s)) t (- a * expR (- a * t)).
Proof. by apply: derivative_scaled; apply: derivative_of; exact: (@is_derive_expR R _). Qed.

Section Solution.
Variables (n : nat) (M : 'M[R]_n) (x0 : 'cV[R]_n).
Definition coefficient (i : 'I_n) (k : nat) : R := (iter k (mulmx M) x0) i 0 / k`!%:R.
Definition solution (t : R) : 'cV[R]_n := \col_i lim (pseries (coefficient i) t).

Let size_of (v : 'cV[R]_n) := \sum_i `|v i 0|.
Let bound := \sum_i \sum_j `|M i j|.

Lemma entry_le (v : 'cV[R]_n) i : `|v i 0| <= size_of v.
Proof. by rewrite /size_of (bigD1 i) //= ler_addl sumr_ge0. Qed.

Lemma size_mul (v : 'cV[R]_n) : size_of (M *m v) <= bound * size_of v.
Proof.
rewrite /bound mulr_suml; apply: ler_sum => i _; rewrite mxE mulr_suml.
apply: le_trans (ler_norm_sum _ _ _) _; apply: ler_sum => j _.
by rewrite normrM ler_wpmul2l // entry_le.
Qed.

Lemma bound_ge0 : 0 <= bound. Proof. by apply: sumr_ge0 => i _; apply: sumr_ge0. Qed.

Lemma iter_le k : size_of (iter k (mulmx M) x0) <= bound ^+ k * size_of x0.
Proof.
elim: k => [|k IH] /=; first by rewrite expr0 mul1r.
by apply: le_trans (size_mul _) _; rewrite exprS -mulrA ler_wpmul2l // bound_ge0.
Qed.

(* every entry is dominated by the exponential series *)
Lemma series_converges i t : cvg (pseries (coefficient i) t).
Proof.
apply: normed_cvg; rewrite /pseries.
apply: (@series_le_cvg _ _ (fun k => size_of x0 * exp_coeff (bound * `|t|) k)) => [k|k|k|].
- exact: normr_ge0.
- by rewrite mulr_ge0 ?sumr_ge0 // exp_coeff_ge0 // mulr_ge0 // bound_ge0.
- rewrite /coefficient /exp_coeff /= !normrM normfV normr_nat normrX exprMn.
  rewrite mulrAC -mulrA -[bound ^+ k * _ / _]mulrA [X in _ <= X]mulrA ler_wpmul2r ?divr_ge0 ?exprn_ge0 //.
  by rewrite [_ * bound ^+ k]mulrC (le_trans (entry_le _ _) (iter_le k)).
apply: is_cvg_seriesZ; exact: is_cvg_series_exp_coeff.
Qed.
End Solution.

Lemma coefficient_diffs n (M : 'M[R]_n) x0 i : pseries_diffs (coefficient M x0 i) = coefficient M (M *m x0) i.
Proof.
apply/funext => k; rewrite /pseries_diffs /coefficient -iterSr factS natrM invfM mulrCA mulVKf //.
by rewrite pnatr_eq0.
Qed.

Local Open Scope classical_set_scope.

Lemma sum_converges n (a : 'I_n -> R) (c : 'I_n -> nat -> R) t : (forall j, cvg (pseries (c j) t)) ->
  pseries (fun k => \sum_j a j * c j k) t --> \sum_j a j * lim (pseries (c j) t).
Proof.
move=> cv; have e : pseries (fun k => \sum_j a j * c j k) t = fun K => \sum_j a j * pseries (c j) t K.
  apply/funext => K; rewrite /pseries /series /=; under [RHS]eq_bigr do rewrite mulr_sumr.
  rewrite exchange_big /=; apply: eq_bigr => k _; rewrite mulr_suml.
  by apply: eq_bigr => j _; rewrite mulrA.
rewrite e; have -> : (fun K => \sum_j a j * pseries (c j) t K) = \sum_j (fun K => a j * pseries (c j) t K).
  by apply/funext => K; rewrite fct_sumE.
elim/big_rec2: _ => [|j l g _ ih]; first exact: cvg_cst.
by apply: cvgD ih; apply: cvgM; [exact: cvg_cst | exact: cv].
Qed.

Lemma solution_linear n (M : 'M[R]_n) x0 t : solution M (M *m x0) t = M *m solution M x0 t.
Proof.
apply/matrixP => i z; rewrite ord1 !mxE; under [RHS]eq_bigr do rewrite mxE.
have <- : lim (pseries (fun k => \sum_j M i j * coefficient M x0 j k) t) =
    \sum_j M i j * lim (pseries (coefficient M x0 j) t).
  by apply/cvg_lim => //; apply: sum_converges => j; exact: series_converges.
congr (lim (pseries _ t)); apply/funext => k; rewrite /coefficient -iterSr /= mxE mulr_suml.
by apply: eq_bigr => j _; rewrite mulrA.
Qed.

Theorem solution_exists n (M : 'M[R]_n) (x0 : 'cV[R]_n) : exists x : R -> 'cV[R]_n,
  x 0 = x0 /\ forall t i, derivative (fun s => x s i 0) t ((M *m x t) i 0).
Proof.
exists (solution M x0); split=> [|t i].
  apply/matrixP => i z; rewrite ord1 !mxE; apply/cvg_lim => //; rewrite -(cvg_shiftS _) /=.
  have -> : (fun K => pseries (coefficient M x0 i) 0 K.+1) = fun=> x0 i 0; last exact: cvg_cst.
  apply/funext => k; rewrite /pseries /series /= big_nat_recl // expr0 mulr1 big1 ?addr0 => [|j _].
    by rewrite /coefficient /= divr1.
  by rewrite expr0n mulr0.
have e : (fun s => solution M x0 s i 0) = (fun s => lim (pseries (coefficient M x0 i) s)).
  by apply/funext => s; rewrite mxE.
rewrite e -solution_linear mxE -coefficient_diffs; apply: derivative_of.
apply: (@pseries_snd_diffs _ _ (`|t| + 1)); rewrite ?coefficient_diffs.
- exact: series_converges.
- exact: series_converges.
- exact: series_converges.
by rewrite [X in _ < X]ger0_norm ?addr_ge0 // ltr_addl.
Qed.

(* where M e + b = 0, the equilibrium e plus a solution of x' = Mx *)
Theorem solution_with_input n (M : 'M[R]_n) (b e x0 : 'cV[R]_n) : M *m e + b = 0 -> exists x : R -> 'cV[R]_n,
  x 0 = x0 /\ forall t i, derivative (fun s => x s i 0) t ((M *m x t + b) i 0).
Proof.
move=> rest; have [y [y0 dy]] := solution_exists M (x0 - e); exists (fun s => y s + e); split=> [|t i].
  by rewrite y0 subrK.
have -> : (M *m (y t + e) + b) i 0 = (M *m y t) i 0 + 0 by rewrite addr0 mulmxDr -addrA rest addr0.
apply: derivative_same (derivativeD (dy t i) (derivative_constant (e i 0) t)) => s.
by rewrite mxE.
Qed.

Lemma exp_square a t : (expR (- a * t) * expR (a * t)) ^+ 2 = 1 :> R.
Proof. by rewrite -expRD mulNr addNr expR0 expr1n. Qed.

(* eigenvalues with real parts below a: every solution decays as exp(at) *)
Theorem decay n (M : 'M[R]_n) (a : R) :
  (forall lambda : complex R, eigenvalue (map_mx (real_complex R) M) lambda -> 'Re lambda < real_complex R a) ->
  exists c, forall x : R -> 'cV[R]_n, (forall t i, 0 <= t -> derivative (fun s => x s i 0) t ((M *m x t) i 0)) ->
    forall t, 0 <= t -> dot (x t) (x t) <= c * expR (a * t) ^+ 2 * dot (x 0) (x 0).
Proof.
move=> low; have [c h] := exponential_rate real_complete low; exists c => x dx t t0.
have := h x (fun s => expR (- a * s)) dx (fun s _ => derivative_exp a s) t t0.
rewrite mulr0 expR0 expr1n mulr1 => le.
have g2 : 0 <= expR (a * t) ^+ 2 by rewrite exprn_ge0 // ltW // expR_gt0.
have := ler_wpmul2r g2 le; rewrite -[X in X <= _]mulrA -exprMn exp_square mulr1 => /le_trans; apply.
by rewrite mulrAC.
Qed.

(* The distributed observer attains every rate: all solutions exist, and decay as exp(at). *)
Theorem construction_real n m (p q : 'I_m -> nat) (S : multichannel R n p q) (N : 'I_m -> {set 'I_m}) (o : 'I_m)
    (k : 'I_m -> nat) (a : R) :
  jointly_controllable S -> jointly_observable S -> strongly_connected (neighbor_arc N) ->
  (forall i, i != o -> k i = 0%N) -> k o = m.-1 ->
  exists F (D : controllers R (fun=> n) (fun i => q i + \sum_(i < m) n)%N k) c,
    (forall x0, exists x : R -> 'cV_(n + (\sum_(i < m) n + \sum_i k i)), x 0 = x0 /\
       forall t i, derivative (fun s => x s i 0) t ((observer_loop N S F D *m x t) i 0)) /\
    (forall x : R -> 'cV_(n + (\sum_(i < m) n + \sum_i k i)),
       (forall t i, 0 <= t -> derivative (fun s => x s i 0) t ((observer_loop N S F D *m x t) i 0)) ->
       forall t, 0 <= t -> dot (x t) (x t) <= c * expR (a * t) ^+ 2 * dot (x 0) (x 0)).
Proof.
move=> jc jo connected none order.
have [F [D low]] := construction_rate jc jo none order (a - 1) connected; exists F, D.
have [|c h] := @decay _ (observer_loop N S F D) a; last by exists c; split=> // x0; exact: solution_exists.
move=> lambda /low ->; rewrite (Creal_ReP _ _) ?ltcE /= ?eqxx /= ?gtr_addl ?oppr_lt0 ?ltr01 //.
by apply/complex_realP; exists (a - 1).
Qed.

(* and holds all set-points where (21) holds *)
Theorem setpoints_real n m (p q : 'I_m -> nat) (S : multichannel R n p q) (N : 'I_m -> {set 'I_m}) (o : 'I_m)
    (k : 'I_m -> nat) (a : R) :
  jointly_controllable S -> jointly_observable S -> strongly_connected (neighbor_arc N) -> condition_21 S ->
  (forall i, i != o -> k i = 0%N) -> k o = m.-1 -> a <= 0 ->
  exists F (D : controllers R (fun=> n + \sum_i q i)%N (fun i => q i + \sum_(i < m) (n + \sum_i q i))%N k),
    attains_setpoints S (observer_loop N (integrated S) F D) a.
Proof. by move=> jc jo connected c21 none order a0; exact: setpoints_solved jc jo o k a none order real_complete a0 connected c21. Qed.
End Real.

(* Applied over every real type, and over Coq's real numbers. *)
Section Applied.
Variable R : realType.
Notation Rf := [fieldType of R].
Notation plant := (example.plant Rf).
Notation jc := (example_controllable Rf).
Notation jo := (example_observable Rf).
Notation two_at_1 := (fun i : 'I_3 => if i == inord 0 then 2%N else 0%N).

Example construction_continuous_example :=
  construction_continuous jc jo none_elsewhere two_states_at_1 (-1) (@real_complete R) example_connected.
Example construction_real_example := construction_real (-1) jc jo example_connected none_elsewhere two_states_at_1.

(* two agents that hear each other, with a channel controller of one state at agent 1 *)
Notation pair := (pair R).
Notation one_at_1 := (fun i : 'I_2 => if i == ord0 then 1%N else 0%N).
Lemma none_at_2 i : i != ord0 -> one_at_1 i = 0%N. Proof. by move/negPf => /= ->. Qed.
Lemma one_state_at_1 : one_at_1 ord0 = 1%N. Proof. by []. Qed.
Notation pair_connected := instances_paper.all_strongly_connected.
Lemma lerN10 : (-1 : R) <= 0. Proof. by rewrite oppr_le0 ler01. Qed.
Example setpoints_solved_example := setpoints_solved (pair_controllable R) (pair_observable R) (o := ord0) none_at_2
  one_state_at_1 (@real_complete R) lerN10 pair_connected (pair_21 R).
Example setpoints_real_example := setpoints_real (pair_controllable R) (pair_observable R) pair_connected (pair_21 R)
  none_at_2 one_state_at_1 lerN10.

(* any control of plant and integrators, here the distributed observer of both, with all eigenvalues at -2 *)
Notation whole := (integrated pair).
Example setpoints_attained_example : exists F (D : controllers R _ _ one_at_1),
  attains_setpoints pair (observer_loop instances_paper.all_hear whole F D) (-1).
Proof.
have ic : jointly_controllable whole := equation_21_example R.
have io : jointly_observable whole := equation_19 (pair_observable R).
have [F [D low]] := construction_rate ic io none_at_2 one_state_at_1 (-1 - 1) pair_connected.
exists F, D; apply: (setpoints_attained (@real_complete R) lerN10) => [|lambda /low ->]; last first.
  rewrite (Creal_ReP _ _) ?ltcE /= ?eqxx /= ?gtr_addl ?oppr_lt0 ?ltr01 //.
  by apply/complex_realP; exists (-1 - 1).
have lower a' b' c' d' (P : 'M[R]_(a' + b', c')) (Q : 'M_(a' + b', d')) :
    dsubmx (row_mx P Q) = row_mx (dsubmx P) (dsubmx Q).
  by apply/matrixP => i j; rewrite !mxE; case: fintype.split => s; rewrite !mxE.
have still : dsubmx (\mxrow_j (mcB whole j *m F j)) = 0.
  by apply/matrixP => i j; rewrite !mxE big1 // => l _; rewrite col_mxEd mxE mul0r.
rewrite /observer_loop block_mxEv col_mxKu !lower still linear0 row_mx0.
by rewrite /= /integrated_A block_mxEv col_mxKd.
Qed.
End Applied.

(* over Coq's real numbers *)
Notation reals := Rstruct.real_realType.
Example construction_of_the_reals := construction_real_example reals.
Example setpoints_of_the_reals := setpoints_real_example reals.
