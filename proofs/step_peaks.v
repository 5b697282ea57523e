(* checker/steps.py: kind `step_peaks`, how large inputs and outputs of a loop become after a step.

   The loop is z' = M z + b or z(t+1) = M z + b from z(0) = 0, over a real closed field R in which bounded sets have
   suprema where time is continuous (complete_order of convergence.v; real_numbers.v discharges it), and a signal is
   s z + d.  The response of the checker is a sequence of vectors, in continuous time with a polynomial after each of them;
   time is measured in steps of its length h, so that M, b and a are h times those of the loop.  Errors are measured
   by the norm of P, which falls along the loop. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import convergence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Norm.
Variables (R : rcfType) (n : nat) (P : 'M[R]_n).
Hypotheses (sP : P^T = P) (pP : forall v, 0 <= form P v v).
Implicit Types u v : 'cV[R]_n.

Definition norm v := Num.sqrt (form P v v).

Lemma formDl u v w : form P (u + v) w = form P u w + form P v w.
Proof. by rewrite /form /dot linearD /= mulmxDl mxE. Qed.
Lemma formDr u v w : form P w (u + v) = form P w u + form P w v.
Proof. by rewrite /form /dot mulmxDr mulmxDr mxE. Qed.
Lemma formZl k u v : form P (k *: u) v = k * form P u v.
Proof. by rewrite /form /dot linearZ /= -scalemxAl mxE. Qed.
Lemma formZr k u v : form P u (k *: v) = k * form P u v.
Proof. by rewrite /form /dot -scalemxAr -scalemxAr mxE. Qed.
Lemma form_sym u v : form P u v = form P v u.
Proof.
rewrite /form /dot; have -> : (u^T *m (P *m v)) 0 0 = ((u^T *m (P *m v))^T) 0 0 by rewrite [RHS]mxE.
by rewrite !trmx_mul trmxK sP -mulmxA.
Qed.

Lemma norm_ge0 v : 0 <= norm v. Proof. exact: sqrtr_ge0. Qed.
Lemma norm_sqr v : norm v ^+ 2 = form P v v. Proof. exact: sqr_sqrtr. Qed.
Lemma norm0 : norm 0 = 0.
Proof. by rewrite /norm -[X in form P X _](scale0r (0 : 'cV[R]_n)) formZl mul0r sqrtr0. Qed.
Lemma normZ k v : norm (k *: v) = `|k| * norm v.
Proof. by rewrite /norm formZl formZr mulrA -expr2 sqrtrM ?sqr_ge0// sqrtr_sqr. Qed.

Lemma cauchy_schwarz u v : form P u v <= norm u * norm v.
Proof.
have [u0|u0] := eqVneq (norm u) 0.
  have fu : form P u u = 0 by rewrite -norm_sqr u0 expr0n.
  rewrite u0 mul0r leNgt; apply/negP => lt.
  pose k := (form P v v + 1) / (form P u v *+ 2).
  have p0 : 0 < form P u v *+ 2 by rewrite pmulrn_lgt0.
  have := pP (v + - k *: u); rewrite formDl !formDr !formZl !formZr fu (form_sym v u) !mulr0 addr0 -addrA -mulr2n.
rewrite -mulrnAr mulNr /k divfK ?gt_eqF// opprD addrA subrr add0r.
by rewrite leNgt oppr_lt0 ltr01.
have u1 : 0 < norm u by rewrite lt_neqAle eq_sym u0 norm_ge0.
have [v0|v0] := leP (form P u v) 0; first exact: le_trans v0 (mulr_ge0 (norm_ge0 _) (norm_ge0 _)).
rewrite -ler_sqr ?nnegrE ?mulr_ge0 ?norm_ge0 ?(ltW v0)// exprMn !norm_sqr.
have f0 : 0 < form P u u by rewrite -norm_sqr exprn_gt0.
have := pP (form P u u *: v + - form P u v *: u).
rewrite formDl !formDr !formZl !formZr (form_sym v u).
set a := form P u u in f0 *; set b := form P u v; set c := form P v v.
have -> : a * (a * c) + a * (- b * b) + (- b * (a * b) + - b * (- b * a)) = a * (a * c - b ^+ 2).
  by rewrite !mulNr !mulrN opprK [b * a]mulrC addNr addr0 mulrBr expr2.
by rewrite pmulr_rge0// subr_ge0.
Qed.

Lemma normD u v : norm (u + v) <= norm u + norm v.
Proof.
rewrite -ler_sqr ?nnegrE ?addr_ge0 ?norm_ge0// sqrrD !norm_sqr formDl !formDr (form_sym v u) addrA.
by rewrite ler_add2r -addrA ler_add2l -mulr2n ler_muln2r/= cauchy_schwarz.
Qed.
End Norm.

Section Bounds.
Variables (R : rcfType) (n : nat) (P : 'M[R]_n).
Hypotheses (sP : P^T = P) (pP : forall v, 0 <= form P v v).
Local Notation norm := (norm P).

(* errors of entries: the norm of v is at most the sum of f_i |v_i|, where P_ii <= f_i^2 *)
Theorem norm_entries (f : 'I_n -> R) (v : 'cV[R]_n) : (forall i, 0 <= f i) -> (forall i, P i i <= f i ^+ 2) ->
  norm v <= \sum_i f i * `|v i 0|.
Proof.
move=> f0 fP; have -> : v = \sum_i v i 0 *: delta_mx i 0.
  by rewrite {1}[v]matrix_sum_delta; apply: eq_bigr => i _; rewrite big_ord1.
have bound (r : seq 'I_n) : norm (\sum_(i <- r) v i 0 *: delta_mx i 0) <= \sum_(i <- r) f i * `|v i 0|.
  elim: r => [|i r IH]; first by rewrite !big_nil norm0.
  rewrite !big_cons; apply: le_trans (normD sP pP _ _) _; apply: ler_add => //.
  rewrite normZ mulrC ler_wpmul2r//.
  rewrite /norm -[f i]ger0_norm// -sqrtr_sqr ler_wsqrtr//.
  suff -> : form P (delta_mx i 0) (delta_mx i 0) = P i i by [].
  by rewrite /form /dot trmx_delta mulmxA -rowE -colE !mxE.
apply: le_trans (bound _) _; apply: ler_sum => i _.
rewrite summxE (bigD1 i)//= big1 ?addr0 => [|j ne]; first by rewrite !mxE !eqxx mulr1.
by rewrite !mxE eq_sym (negPf ne) mulr0.
Qed.

(* a signal of a vector is at most its size times the norm *)
Lemma signal_size (s : 'rV[R]_n) (size : R) (v : 'cV[R]_n) : 0 < size ->
  (forall v, 0 <= form (P - size ^- 2 *: (s^T *m s)) v v) -> `|(s *m v) 0 0| <= size * norm v.
Proof.
move=> s0 h; have n0 : 0 <= size * norm v by rewrite mulr_ge0 ?(ltW s0) ?norm_ge0.
rewrite -ler_sqr ?nnegrE// exprMn (norm_sqr pP) -normrX ger0_norm ?sqr_ge0//.
suff e : form (P - size ^- 2 *: (s^T *m s)) v v = form P v v - size ^- 2 * (s *m v) 0 0 ^+ 2.
  by have := h v; rewrite e subr_ge0 ler_pdivr_mull ?exprn_gt0.
have entry (X Y : 'M[R]_1) k : (X - k *: Y) 0 0 = X 0 0 - k * Y 0 0 by rewrite !mxE.
rewrite /form /dot mulmxBl mulmxBr -scalemxAl -scalemxAr entry; congr (_ - _ * _).
by rewrite -[s^T *m s *m v]mulmxA [v^T *m _]mulmxA -trmx_mul expr2 mxE big_ord1 [X in X * _]mxE.
Qed.

Lemma signal_near (s : 'rV[R]_n) (d size e : R) (u v : 'cV[R]_n) : 0 < size ->
  (forall v, 0 <= form (P - size ^- 2 *: (s^T *m s)) v v) -> norm (u - v) <= e ->
  `|(s *m v) 0 0 + d| <= `|(s *m u) 0 0 + d| + size * e.
Proof.
move=> s0 seen ne; have -> : (s *m v) 0 0 + d = ((s *m u) 0 0 + d) - (s *m (u - v)) 0 0.
  by rewrite mulmxBr [X in _ - X]mxE [X in _ - (_ + X)]mxE opprD opprK addrACA subrr add0r addrC.
apply: le_trans (ler_norm_sub _ _) _; rewrite ler_add2l.
by apply: le_trans (signal_size _ s0 seen) _; rewrite ler_wpmul2l// ltW.
Qed.
End Bounds.

(* The inequalities of the checker: P - sum S_i' S_i / size_i^2, and the decrease along the loop at the rate a. *)
Section Inequalities.
Variables (R : rcfType) (n m : nat) (M P : 'M[R]_n) (a : R) (S : 'M[R]_(m, n)) (size : 'I_m -> R).
Hypotheses (sP : P^T = P) (size0 : forall i, 0 < size i).
Hypothesis seen : forall v, 0 <= form (P - \sum_i size i ^- 2 *: ((row i S)^T *m row i S)) v v.

Lemma form_minus (Q T : 'M[R]_n) u v : form (Q - T) u v = form Q u v - form T u v.
Proof. by rewrite /form /dot mulmxBl mulmxBr !mxE. Qed.
Lemma form_square (s : 'rV[R]_n) k v : form (k *: (s^T *m s)) v v = k * (s *m v) 0 0 ^+ 2.
Proof.
rewrite /form /dot -scalemxAl -scalemxAr mxE; congr (_ * _).
by rewrite -[s^T *m s *m v]mulmxA [v^T *m _]mulmxA -trmx_mul expr2 mxE big_ord1 [X in X * _]mxE.
Qed.
Lemma form_squares v : form (\sum_i size i ^- 2 *: ((row i S)^T *m row i S)) v v = \sum_i size i ^- 2 * (row i S *m v) 0 0 ^+ 2.
Proof.
rewrite {1}/form /dot mulmx_suml mulmx_sumr summxE; apply: eq_bigr => i _; exact: form_square.
Qed.
Lemma square_ge0 i (v : 'cV[R]_n) : 0 <= size i ^- 2 * (row i S *m v) 0 0 ^+ 2.
Proof. by rewrite mulr_ge0 ?sqr_ge0// invr_ge0 exprn_ge0 ?ltW. Qed.

Lemma positive v : 0 <= form P v v.
Proof.
have := seen v; rewrite form_minus form_squares subr_ge0; apply: le_trans.
by apply: sumr_ge0 => i _; apply: square_ge0.
Qed.
Lemma each_signal i v : 0 <= form (P - size i ^- 2 *: ((row i S)^T *m row i S)) v v.
Proof.
have := seen v; rewrite !form_minus form_squares form_square !subr_ge0; apply: le_trans.
by rewrite (bigD1 i)//= ler_addl sumr_ge0// => j _; apply: square_ge0.
Qed.
Lemma falls_discrete : (forall v, 0 <= form (P - M^T *m P *m M - (a *+ 2) *: P) v v) ->
  forall v, form P (M *m v) (M *m v) <= (1 - a *+ 2) * form P v v.
Proof.
move=> h v; have := h v; rewrite !form_minus.
have -> : form ((a *+ 2) *: P) v v = (a *+ 2) * form P v v by rewrite /form /dot -scalemxAl -scalemxAr mxE.
have -> : form (M^T *m P *m M) v v = form P (M *m v) (M *m v) by rewrite /form /dot trmx_mul !mulmxA.
by rewrite addrAC => le; rewrite -subr_ge0 mulrBl mul1r.
Qed.
Lemma falls_continuous : (forall v, 0 <= form (- (P *m M + M^T *m P) - (a *+ 2) *: P) v v) ->
  forall v, form P v (M *m v) <= - a * form P v v.
Proof.
move=> h v; have := h v; rewrite form_minus.
have -> : form ((a *+ 2) *: P) v v = (a * form P v v) *+ 2 by rewrite /form /dot -scalemxAl -scalemxAr mxE mulrnAl.
have -> : form (- (P *m M + M^T *m P)) v v = - (form P v (M *m v) *+ 2).
  have entry (X Y : 'M[R]_1) : (- (X + Y)) 0 0 = - (X 0 0 + Y 0 0) by rewrite !mxE.
  rewrite mulr2n {2}(form_sym sP) /form /dot mulNmx mulmxN mulmxDl mulmxDr entry; congr (- (_ + _)).
    by rewrite -mulmxA.
  by rewrite trmx_mul !mulmxA.
by rewrite -opprD oppr_ge0 -mulrnDl pmulrn_lle0// => le; rewrite mulNr -subr_le0 opprK.
Qed.
End Inequalities.

(* Discrete time.  y is the response of the checker, which errs by at most delta t in the step from t to t + 1. *)
Section Discrete.
Variables (R : rcfType) (n : nat) (M P : 'M[R]_n) (a : R).
Hypotheses (sP : P^T = P) (pP : forall v, 0 <= form P v v) (a0 : 0 < a).
Hypothesis falls : forall v, form P (M *m v) (M *m v) <= (1 - a *+ 2) * form P v v.
Local Notation norm := (norm P).

Lemma contraction v : norm (M *m v) <= (1 - a) * norm v.
Proof.
have [f0|f0] := eqVneq (form P v v) 0.
  have := falls v; rewrite f0 mulr0 => le; rewrite /norm f0 sqrtr0 mulr0 ler0_sqrtr//.
have p0 : 0 < form P v v by rewrite lt_neqAle eq_sym f0 pP.
have q0 : 0 <= 1 - a *+ 2 by rewrite -(pmulr_lge0 _ p0) (le_trans (pP _) (falls v)).
have a1 : 0 <= 1 - a by rewrite (le_trans q0)// ler_add2l ler_opp2 mulr2n ler_addl ltW.
rewrite /norm -[1 - a]ger0_norm// -sqrtr_sqr -sqrtrM ?sqr_ge0// ler_wsqrtr//.
by apply: le_trans (falls v) _; rewrite ler_wpmul2r// sqrrB expr1n mul1r ler_addl sqr_ge0.
Qed.
Lemma contraction1 v : norm (M *m v) <= norm v.
Proof. by apply: le_trans (contraction v) _; rewrite mulrBl mul1r ger_addl oppr_le0 mulr_ge0 ?norm_ge0 ?ltW. Qed.
Lemma slow_or_nothing : (forall v, norm v = 0) \/ 0 <= 1 - a.
Proof.
have [a1|a1] := leP 0 (1 - a); [by right | left => v; apply/eqP; rewrite eq_le norm_ge0 andbT].
rewrite leNgt; apply/negP => n0; have := le_trans (norm_ge0 P (M *m v)) (contraction v).
by rewrite pmulr_lge0// leNgt a1.
Qed.

Variables (b : 'cV[R]_n) (z y : nat -> 'cV[R]_n) (delta : nat -> R) (T : nat).
Hypotheses (z0 : z 0%N = 0) (zS : forall t, z t.+1 = M *m z t + b) (y0 : y 0%N = 0).
Hypothesis errs : forall t, (t < T)%N -> norm (M *m y t + b - y t.+1) <= delta t.

Lemma error_discrete t : (t <= T)%N -> norm (y t - z t) <= \sum_(k < t) delta k.
Proof.
elim: t => [|t IH] tT; first by rewrite y0 z0 subrr norm0 big_ord0.
have -> : y t.+1 - z t.+1 = M *m (y t - z t) + -1 *: (M *m y t + b - y t.+1).
  rewrite zS scaleN1r mulmxBr opprB [RHS]addrC -[RHS]addrA; congr (_ + _).
  by rewrite !opprD [X in X + (_ - _)]addrC addrA subrK addrC.
rewrite big_ord_recr/=; apply: le_trans (normD sP pP _ _) _; apply: ler_add.
  by apply: le_trans (contraction1 _) (IH (ltnW tT)).
by rewrite normZ normrN1 mul1r errs.
Qed.

Lemma error_after t : norm (y T - z (T + t)) <= \sum_(k < T) delta k + norm (M *m y T + b - y T) / a.
Proof.
set E := \sum_(k < T) _; set g := M *m y T + b - y T.
have E0 : 0 <= E by apply: le_trans (norm_ge0 _ _) (error_discrete (leqnn T)).
have [nothing|a1] := slow_or_nothing; first by rewrite !nothing mul0r addr0.
elim: t => [|t IH].
  by rewrite addn0; apply: le_trans (error_discrete (leqnn T)) _; rewrite ler_addl divr_ge0 ?norm_ge0 ?ltW.
have -> : y T - z (T + t.+1) = M *m (y T - z (T + t)) + -1 *: g.
  rewrite addnS zS scaleN1r mulmxBr opprB [RHS]addrC -[RHS]addrA; congr (_ + _).
  by rewrite !opprD [X in X + (_ - _)]addrC addrA subrK addrC.
apply: le_trans (normD sP pP _ _) _; rewrite normZ normrN1 mul1r.
apply: le_trans (ler_add (contraction _) (lexx _)) _.
apply: le_trans (ler_add (ler_wpmul2l a1 IH) (lexx _)) _.
rewrite mulrDr -addrA; apply: ler_add; first by rewrite mulrBl mul1r ger_addl oppr_le0 mulr_ge0 ?(ltW a0).
by rewrite mulrBl mul1r mulrCA divff ?gt_eqF// mulr1 subrK.
Qed.

Lemma signal_discrete (s : 'rV[R]_n) (d size bound : R) : 0 < size ->
  (forall v, 0 <= form (P - size ^- 2 *: (s^T *m s)) v v) ->
  (forall t, (t < T)%N -> (`|(s *m y t) 0 0 + d| + size * (\sum_(k < t) delta k) <= bound)%R) ->
  (`|(s *m y T) 0 0 + d| + size * (\sum_(k < T) delta k + norm (M *m y T + b - y T) / a) <= bound)%R ->
  forall t, `|(s *m z t) 0 0 + d| <= bound.
Proof.
move=> s0 seen before after t.
have near u v e := @signal_near _ _ _ pP s d size e u v s0 seen.
have [tT|Tt] := ltnP t T; first exact: le_trans (near _ _ _ (error_discrete (ltnW tT))) (before t tT).
by apply: le_trans (near _ _ _ _) after; rewrite -(subnKC Tt); apply: error_after.
Qed.
End Discrete.

(* Derivatives, as in convergence.v. *)
Section Derivatives.
Variable R : rcfType.
Implicit Types (u v : R -> R) (t d : R).

Lemma derivative_identity t : derivative id t 1.
Proof. by exists (fun=> 1) => [|h]; [exact: limit_constant | rewrite mul1r]. Qed.

Lemma derivative_power k t : derivative (fun s => s ^+ k) t (k%:R * t ^+ k.-1).
Proof.
elim: k => [|k IH]; first by rewrite mul0r; apply: derivative_constant.
apply: (@derivative_same _ (fun s => s * s ^+ k)) => [s|]; first by rewrite exprS.
have -> : k.+1%:R * t ^+ k = 1 * t ^+ k + t * (k%:R * t ^+ k.-1).
  rewrite mul1r; case: k {IH} => [|k]; first by rewrite mul0r mulr0 addr0 mul1r.
  by rewrite [t * _]mulrCA -exprS (mulrS 1 k.+1) mulrDl mul1r.
exact: derivativeM (derivative_identity t) IH.
Qed.

Lemma derivative_scaled u t d c : derivative u t d -> derivative (fun s => u s * c) t (d * c).
Proof. by move=> du; have := derivativeM du (derivative_constant c t); rewrite mulr0 addr0. Qed.

Lemma derivative_opposite u t d : derivative u t d -> derivative (fun s => - u s) t (- d).
Proof.
move=> du; have := derivative_scaled (-1) du; rewrite mulrN1; apply: derivative_same => s; by rewrite mulrN1.
Qed.

Lemma derivative_later u k t d : derivative u (k + t) d -> derivative (fun s => u (k + s)) t d.
Proof. by case=> s ls e; exists s => // h; rewrite addrA. Qed.

(* the root of what stays above c^2 > 0 *)
Lemma derivative_root u t d c : 0 < c -> (forall s, c ^+ 2 <= u s) -> derivative u t d ->
  derivative (fun s => Num.sqrt (u s)) t (d / (Num.sqrt (u t) *+ 2)).
Proof.
move=> c0 above [s ls e]; pose r x := Num.sqrt (u x).
have rc x : c <= r x by rewrite /r -[c]ger0_norm ?(ltW c0)// -sqrtr_sqr ler_wsqrtr.
have r0 x : 0 < r x by apply: lt_le_trans c0 (rc x).
have sq x : r x ^+ 2 = u x by rewrite sqr_sqrtr// (le_trans _ (above x))// sqr_ge0.
have p0 h : 0 < r (t + h) + r t by rewrite addr_gt0.
have step h : (r (t + h) - r t) * (r (t + h) + r t) = s h * h.
  by rewrite -subr_sqr !sq e addrAC subrr add0r.
have cc h : c <= r (t + h) + r t by rewrite (le_trans (rc t))// ler_addr ltW.
exists (fun h => s h * (r (t + h) + r t)^-1) => [|h]; last first.
  by rewrite mulrAC -step mulfK ?gt_eqF// [RHS]addrC subrK.
apply: limitM => // x x0; have lim := limitM ls (@limit_identity R); rewrite mulr0 in lim.
have [q q0 close] := lim _ (mulr_gt0 x0 (exprn_gt0 3 c0)).
exists q => // h /close; rewrite subr0 -step normrM (gtr0_norm (p0 h)) => small.
have m0 : 0 < r t *+ 2 by rewrite pmulrn_lgt0.
have -> : (r (t + h) + r t)^-1 - (r t *+ 2)^-1 = - (r (t + h) - r t) / ((r (t + h) + r t) * (r t *+ 2)).
  apply: (@mulIf _ ((r (t + h) + r t) * (r t *+ 2))); first by rewrite mulf_neq0// gt_eqF.
  rewrite divfK; last by rewrite mulf_neq0// gt_eqF.
  rewrite mulrBl mulKf ?gt_eqF// [X in _ - _ * X]mulrC mulKf ?gt_eqF//.
  by rewrite opprB mulr2n opprD addrACA subrr addr0.
rewrite normrM normrN normfV (gtr0_norm (mulr_gt0 (p0 h) m0)) ler_pdivr_mulr ?mulr_gt0//.
have le2 : c <= r t *+ 2 by rewrite (le_trans (rc t))// mulr2n ler_addl ltW.
rewrite -(ler_pmul2r (p0 h)); apply: le_trans small _; rewrite -mulrA ler_pmul2l//.
rewrite exprSr expr2; have c1 := ltW c0; apply: ler_pmul => //; first by rewrite mulr_ge0.
exact: ler_pmul.
Qed.

(* the square of the positive part *)
Definition positive_square (x : R) := if 0 <= x then x ^+ 2 else 0.

Lemma positive_square_near x k : `|positive_square (x + k) - positive_square x - Num.max 0 x *+ 2 * k| <= k ^+ 2.
Proof.
have cancel A B D : A + B + D - A - B = D :> R by rewrite -addrA -opprD [A + B + D]addrC addrK.
have opposite A B D : - A - B = D - (A + B + D) :> R by rewrite [A + B + D]addrC opprD addrA subrr add0r opprD.
rewrite /positive_square; have [x0|x0] := leP 0 x; have [y0|y0] := leP 0 (x + k).
- have -> : (x + k) ^+ 2 - x ^+ 2 - x *+ 2 * k = k ^+ 2.
    by rewrite sqrrD mulrnAl cancel.
  by rewrite ger0_norm ?sqr_ge0.
- have k0 : k <= 0 by rewrite -(ler_add2l x) addr0 (le_trans (ltW y0)).
  have -> : 0 - x ^+ 2 - x *+ 2 * k = k ^+ 2 - (x + k) ^+ 2.
    by rewrite sub0r sqrrD mulrnAl -opposite.
  have le : (x + k) ^+ 2 <= k ^+ 2.
    rewrite -(sqrrN (x + k)) -(sqrrN k) ler_sqr ?nnegrE ?oppr_ge0// ?(ltW y0)//.
    by rewrite opprD ger_addr oppr_le0.
  by rewrite ger0_norm ?subr_ge0// ger_addl oppr_le0 sqr_ge0.
- rewrite subr0 mul0rn mul0r subr0 ger0_norm ?sqr_ge0//.
  have xk : x + k <= k by rewrite ger_addr ltW.
  by rewrite ler_sqr ?nnegrE// (le_trans y0).
by rewrite subrr mul0rn mul0r subr0 normr0 sqr_ge0.
Qed.

Lemma derivative_positive_square u t d : derivative u t d ->
  derivative (fun s => positive_square (u s)) t (Num.max 0 (u t) *+ 2 * d).
Proof.
case=> s ls e; pose m := Num.max 0 (u t) *+ 2.
pose rest h := positive_square (u (t + h)) - positive_square (u t) - m * (s h * h).
have restP h : `|rest h| <= (s h * h) ^+ 2 by rewrite /rest e positive_square_near.
pose q h := if h == 0 then 0 else rest h / h.
exists (fun h => m * s h + q h) => [|h]; last first.
  rewrite mulrDl /q; have [->|h0] := eqVneq h 0; first by rewrite mulr0 mul0r !addr0.
  by rewrite divfK// /rest -mulrA [RHS]addrC [m * _ + _]addrC subrK subrK.
rewrite -[X in limit _ X]addr0; apply: limitD; first exact: limitM (limit_constant _) ls.
have lim := limitM (limitM ls ls) (@limit_identity R); rewrite mulr0 in lim.
move=> x x0; have [r r0 close] := lim x x0; exists r => // h /close; rewrite !subr0; apply: le_trans.
rewrite /q; have [->|h0] := eqVneq h 0; first by rewrite normr0 mulr0 normr0.
rewrite normrM normfV ler_pdivr_mulr ?normr_gt0// -normrM; apply: le_trans (restP h) _.
by rewrite exprMn !expr2 mulrA ler_norm.
Qed.
End Derivatives.

(* Where the checker bounds a polynomial from 0 to 1: the linear part is between its ends. *)
Theorem polynomial_between (R : rcfType) (K : nat) (c : nat -> R) (s : R) : 0 <= s <= 1 ->
  `|\sum_(j < K.+2) c j * s ^+ j| <= Num.max `|c 0%N| `|c 0%N + c 1%N| + \sum_(j < K) `|c j.+2|.
Proof.
move=> /andP[s0 s1]; rewrite !big_ord_recl/= expr0 mulr1 expr1 addrA; apply: le_trans (ler_norm_add _ _) _.
apply: ler_add.
  have -> : c 0%N + c 1%N * s = (1 - s) * c 0%N + s * (c 0%N + c 1%N).
    by rewrite mulrBl mul1r mulrDr addrA subrK mulrC.
  set L := Num.max _ _; have l0 : `|c 0%N| <= L by rewrite le_maxr lexx.
  have l1 : `|c 0%N + c 1%N| <= L by rewrite le_maxr lexx orbT.
  apply: le_trans (ler_norm_add _ _) _; rewrite !normrM (ger0_norm s0) ger0_norm ?subr_ge0//.
  have -> : L = (1 - s) * L + s * L by rewrite -mulrDl subrK mul1r.
  by apply: ler_add; apply: ler_wpmul2l; rewrite ?subr_ge0.
apply: le_trans (ler_norm_sum _ _ _) _; apply: ler_sum => j _.
by rewrite normrM ler_pimulr// ger0_norm ?exprn_ge0// exprn_ile1.
Qed.

(* Continuous time. *)
Section Continuous.
Variables (R : rcfType) (n : nat) (M P : 'M[R]_n) (a : R).
Hypotheses (sup : complete_order R) (sP : P^T = P) (pP : forall v, 0 <= form P v v) (a0 : 0 < a).
Hypothesis falls : forall v, form P v (M *m v) <= - a * form P v v.
Local Notation norm := (norm P).

Definition moves (x d : R -> 'cV[R]_n) := forall t, 0 <= t -> forall i, derivative (fun s => x s i 0) t (d t i 0).

Lemma form_entries (u w : 'cV[R]_n) : form P u w = \sum_i \sum_j P i j * (u i 0 * w j 0).
Proof.
rewrite /form dotE; apply: eq_bigr => i _; rewrite mxE mulr_sumr; apply: eq_bigr => j _.
by rewrite mulrCA.
Qed.

Lemma derivative_form v d t : moves v d -> 0 <= t ->
  derivative (fun s => form P (v s) (v s)) t (form P (v t) (d t) *+ 2).
Proof.
move=> dv t0; rewrite mulr2n {1}(form_sym sP) !form_entries -big_split /=.
apply: (@derivative_same _ (fun s => \sum_i \sum_j P i j * (v s i 0 * v s j 0))).
  by move=> s; rewrite form_entries.
apply: derivative_sum => i; rewrite -big_split /=; apply: derivative_sum => j.
rewrite -mulrDr -[X in derivative _ _ X]add0r -(mul0r (v t i 0 * v t j 0)).
exact: derivativeM (derivative_constant _ _) (derivativeM (dv t t0 i) (dv t t0 j)).
Qed.

(* the error of a function that does not quite solve the equation *)
Lemma error_grows v r (rho G : R -> R) t : moves v (fun s => M *m v s + r s) ->
  (forall s, 0 <= s -> norm (r s) <= rho s) -> (forall s, 0 <= s -> derivative G s (rho s)) -> 0 <= t ->
  norm (v t) <= norm (v 0) + (G t - G 0).
Proof.
move=> dv small dG t0; apply/ler_addgt0Pr => e e0; pose u s := form P (v s) (v s) + e ^+ 2.
have u1 s : e ^+ 2 <= u s by rewrite ler_addr.
have nu s : norm (v s) <= Num.sqrt (u s) by rewrite ler_wsqrtr// ler_addl sqr_ge0.
have r0 s : 0 < Num.sqrt (u s) by rewrite sqrtr_gt0 (lt_le_trans _ (u1 s))// exprn_gt0.
have du s : 0 <= s -> derivative (fun s => Num.sqrt (u s) - G s) s
    ((form P (v s) (M *m v s + r s) *+ 2 + 0) / (Num.sqrt (u s) *+ 2) - rho s).
  move=> s0; apply: derivativeD; last exact: derivative_opposite (dG s s0).
  apply: derivative_root e0 u1 _; apply: derivativeD (derivative_constant _ _).
  exact: (derivative_form dv).
have fall s : 0 <= s -> exists2 d, d <= 0 & derivative (fun s => Num.sqrt (u s) - G s) s d.
  move=> s0; exists ((form P (v s) (M *m v s + r s) *+ 2 + 0) / (Num.sqrt (u s) *+ 2) - rho s); last exact: du.
  rewrite subr_le0 addr0 ler_pdivr_mulr ?pmulrn_lgt0// mulrnAr ler_muln2r/= (formDr _ (M *m v s)).
  apply: (@le_trans _ _ (0 + norm (v s) * rho s)).
    apply: ler_add; first by apply: le_trans (falls _) _; rewrite mulNr oppr_le0 mulr_ge0 ?(ltW a0).
    by apply: le_trans (cauchy_schwarz sP pP _ _) _; rewrite ler_wpmul2l ?norm_ge0 ?small.
  by rewrite add0r mulrC; apply: ler_wpmul2l (nu s); apply: le_trans (norm_ge0 P (r s)) (small s s0).
have := no_growth sup fall t0; rewrite ler_subl_addr => le.
apply: le_trans (nu t) (le_trans le _); rewrite [G t - G 0]addrC [X in _ <= X]addrAC [X in _ <= X]addrA ler_add2r ler_add2r.
rewrite -ler_sqr ?nnegrE ?addr_ge0 ?norm_ge0 ?(ltW (r0 _)) ?(ltW e0)// sqr_sqrtr ?(le_trans _ (u1 0)) ?sqr_ge0//.
by rewrite sqrrD (norm_sqr pP) /u ler_add2r ler_addl mulrn_wge0// mulr_ge0 ?norm_ge0 ?(ltW e0).
Qed.

(* with a constant added: the norm is bounded by what it was and by the constant divided by the rate *)
Lemma error_stays v g t : moves v (fun s => M *m v s + g) -> 0 <= t -> norm (v t) <= norm (v 0) + norm g / a.
Proof.
move=> dv t0; set c := norm g / a; have c0 : 0 <= c by rewrite divr_ge0 ?norm_ge0 ?ltW.
pose L := Num.max (form P (v 0) (v 0)) (c ^+ 2).
have fall s : 0 <= s -> exists2 d, d <= 0 & derivative (fun s => positive_square (form P (v s) (v s) - L)) s d.
  move=> s0; have dw : derivative (fun s => form P (v s) (v s) - L) s (form P (v s) (M *m v s + g) *+ 2).
    rewrite -[X in derivative _ _ X]addr0; apply: derivativeD; last exact: derivative_constant.
    exact: (derivative_form dv).
  exists (Num.max 0 (form P (v s) (v s) - L) *+ 2 * (form P (v s) (M *m v s + g) *+ 2)); last exact: derivative_positive_square.
  have [lt|le] := ltP 0 (form P (v s) (v s) - L); last by rewrite mul0rn mul0r.
  rewrite pmulr_rle0 ?pmulrn_lgt0// pmulrn_lle0// (formDr _ (M *m v s)).
  apply: le_trans (ler_add (falls _) (cauchy_schwarz sP pP _ _)) _.
  have large : c <= norm (v s).
    rewrite -ler_sqr ?nnegrE ?norm_ge0// (norm_sqr pP) ltW//; move: lt; rewrite subr_gt0; apply: le_lt_trans.
    by rewrite le_maxr lexx orbT.
  rewrite mulNr addrC subr_le0 -(norm_sqr pP) expr2 mulrCA ler_wpmul2l ?norm_ge0//.
  by rewrite mulrC -ler_pdivr_mulr.
have Lm : form P (v 0) (v 0) <= L by rewrite le_maxr lexx.
have start : positive_square (form P (v 0) (v 0) - L) = 0.
  rewrite /positive_square; case: ifP => // p; have -> : form P (v 0) (v 0) - L = 0.
    by apply/eqP; rewrite eq_le p subr_le0 Lm.
  by rewrite expr0n.
have := no_growth sup fall t0; rewrite start => le; have {le} small : form P (v t) (v t) <= L.
  rewrite leNgt; apply/negP => lt; move: le; rewrite /positive_square subr_ge0 (ltW lt).
  by rewrite leNgt exprn_gt0// subr_gt0.
have n0 := norm_ge0 P (v 0).
rewrite -ler_sqr ?nnegrE ?addr_ge0 ?norm_ge0// (norm_sqr pP) (le_trans small)// le_maxl.
rewrite -(norm_sqr pP) !ler_sqr ?nnegrE ?addr_ge0//.
by rewrite ler_addl c0 ler_addr n0.
Qed.

Lemma entry_difference (X Y : 'cV[R]_n) i : (X - Y) i 0 = X i 0 - Y i 0. Proof. by rewrite !mxE. Qed.

(* The polynomial of the checker: w 0 + w 1 s + ... + w K s^K. *)
Section Polynomial.
Variables (b : 'cV[R]_n) (K : nat) (w : nat -> 'cV[R]_n).
Hypothesis last : w K.+1 = 0.
Definition polynomial (s : R) := \sum_(j < K.+2) s ^+ j *: w j.
Definition residue j := j.+1%:R *: w j.+1 - M *m w j - (if j == 0%N then b else 0).
Definition missed := \sum_(j < K.+1) norm (residue j) / j.+1%:R.

Lemma polynomial0 : polynomial 0 = w 0%N.
Proof.
rewrite /polynomial big_ord_recl expr0 scale1r big1 ?addr0// => i _.
by rewrite exprS mul0r scale0r.
Qed.

Lemma polynomial_moves : moves polynomial (fun s => M *m polynomial s + b + \sum_(j < K.+1) s ^+ j *: residue j).
Proof.
move=> t t0 i.
have e s : polynomial s i 0 = \sum_(j < K.+2) s ^+ j * w j i 0.
  by rewrite /polynomial summxE; apply: eq_bigr => j _; rewrite mxE.
apply: (@derivative_same _ (fun s => \sum_(j < K.+2) s ^+ j * w j i 0)) => [s|]; first by rewrite e.
have -> : (M *m polynomial t + b + \sum_(j < K.+1) t ^+ j *: residue j) i 0 =
    \sum_(j < K.+2) (j%:R * t ^+ j.-1) * w j i 0.
  have -> : M *m polynomial t + b + \sum_(j < K.+1) t ^+ j *: residue j = \sum_(j < K.+1) (j.+1%:R * t ^+ j) *: w j.+1.
    rewrite /polynomial big_ord_recr/= last scaler0 addr0 mulmx_sumr.
    have -> : \sum_(j < K.+1) t ^+ j *: residue j = \sum_(j < K.+1) (j.+1%:R * t ^+ j) *: w j.+1 - \sum_(j < K.+1) M *m (t ^+ j *: w j) - b.
      rewrite -sumrB [X in _ = _ - X](_ : b = \sum_(j < K.+1) t ^+ j *: (if j == 0%N :> nat then b else 0)).
        rewrite -sumrB; apply: eq_bigr => j _; rewrite /residue !scalerBr scalerA mulrC -scalemxAr.
        by [].
      by rewrite big_ord_recl/= expr0 scale1r big1 ?addr0// => j _; rewrite scaler0.
    by rewrite -[X in _ + X]addrA -opprD addrC subrK.
  by rewrite [in RHS]big_ord_recl mulr0n !mul0r add0r summxE; apply: eq_bigr => j _; rewrite mxE.
apply: derivative_sum => j; exact: derivative_scaled (derivative_power j t).
Qed.

Lemma polynomial_error (z : R -> 'cV[R]_n) s : moves z (fun t => M *m z t + b) -> 0 <= s <= 1 ->
  norm (polynomial s - z s) <= norm (w 0%N - z 0) + missed.
Proof.
move=> dz /andP[s0 s1]; pose r t := \sum_(j < K.+1) t ^+ j *: residue j.
pose rho t := \sum_(j < K.+1) t ^+ j * norm (residue j).
pose G t := \sum_(j < K.+1) t ^+ j.+1 * (norm (residue j) / j.+1%:R).
have dv : moves (fun t => polynomial t - z t) (fun t => M *m (polynomial t - z t) + r t).
  move=> t t0 i; apply: (@derivative_same _ (fun x => polynomial x i 0 - z x i 0)) => [x|]; first by rewrite !mxE.
  have -> : M *m (polynomial t - z t) + r t = (M *m polynomial t + b + r t) - (M *m z t + b).
    by rewrite mulmxBr opprD [M *m _ + b + _]addrAC addrACA subrr addr0 addrAC.
  rewrite entry_difference.
  by apply: derivativeD (polynomial_moves t0 i) _; apply: derivative_opposite; apply: dz.
have small t : 0 <= t -> norm (r t) <= rho t.
  rewrite /r /rho => t0; elim/big_rec2: _ => [|j x v _ le]; first by rewrite norm0.
  apply: le_trans (normD sP pP _ _) (ler_add _ le); by rewrite normZ ger0_norm ?exprn_ge0.
have dG t : 0 <= t -> derivative G t (rho t).
  move=> _; apply: derivative_sum => j.
  have -> : t ^+ j * norm (residue j) = (j.+1%:R * t ^+ j) * (norm (residue j) / j.+1%:R).
    by rewrite [_%:R * _]mulrC mulrACA divff ?pnatr_eq0// mulr1.
  exact: derivative_scaled (derivative_power j.+1 t).
have := error_grows dv small dG s0; rewrite polynomial0 => le; apply: le_trans le _.
rewrite ler_add2l /G [X in _ - X]big1 ?subr0 => [|j _]; last by rewrite exprS !mul0r.
apply: ler_sum => j _; rewrite ler_pimull ?divr_ge0 ?norm_ge0 ?ler0n//.
exact: exprn_ile1.
Qed.
End Polynomial.

Lemma in_some_step T (t : R) : 0 <= t -> t < T%:R -> exists2 k : nat, (k < T)%N & k%:R <= t <= k.+1%:R.
Proof.
move=> t0; elim: T => [|T IH]; first by rewrite ltNge t0.
have [lt _|le lt] := ltP t T%:R; last by exists T => //; rewrite le ltW.
by have [k kT h] := IH lt; exists k => //; rewrite (ltn_trans kT).
Qed.

(* The response of the checker: T polynomials, each of which begins where the one before ends. *)
Section Response.
Variables (b : 'cV[R]_n) (T : nat) (K : nat -> nat) (w : nat -> nat -> 'cV[R]_n) (delta : nat -> R) (z : R -> 'cV[R]_n).
Hypotheses (z0 : z 0 = 0) (dz : moves z (fun t => M *m z t + b)) (w0 : w 0%N 0%N = 0).
Hypothesis ends : forall k, (k < T)%N -> w k (K k).+1 = 0.
Hypothesis joined : forall k, (k < T)%N -> w k.+1 0%N = polynomial (K k) (w k) 1.
Hypothesis errs : forall k, (k < T)%N -> missed b (K k) (w k) <= delta k.

Lemma later k : 0 <= k -> moves (fun s => z (k + s)) (fun s => M *m z (k + s) + b).
Proof. by move=> k0 s s0 i; apply: (@derivative_later _ (fun x => z x i 0)); apply: dz; rewrite addr_ge0. Qed.

Lemma error_at k : (k <= T)%N -> norm (w k 0%N - z k%:R) <= \sum_(i < k) delta i.
Proof.
elim: k => [|k IH] kT; first by rewrite w0 z0 subrr norm0 big_ord0.
have := @polynomial_error b (K k) (w k) (ends kT) (fun s => z (k%:R + s)) 1 (later (ler0n _ _)).
rewrite ler01 lexx -joined// -[k%:R + 1]mulrSr addr0 big_ord_recr/= => /(_ isT) le.
by apply: le_trans le (ler_add (IH (ltnW kT)) (errs kT)).
Qed.

Lemma signal_continuous (s : 'rV[R]_n) (d size bound : R) : 0 < size ->
  (forall v, 0 <= form (P - size ^- 2 *: (s^T *m s)) v v) ->
  (forall k x, (k < T)%N -> 0 <= x <= 1 ->
    (`|(s *m polynomial (K k) (w k) x) 0 0 + d| + size * (\sum_(i < k.+1) delta i) <= bound)%R) ->
  (`|(s *m w T 0%N) 0 0 + d| + size * (\sum_(i < T) delta i + norm (M *m w T 0%N + b) / a) <= bound)%R ->
  forall t, 0 <= t -> `|(s *m z t) 0 0 + d| <= bound.
Proof.
move=> s0 seen before after t t0; have [lt|le] := ltP t T%:R.
  have [k kT /andP[kt tk]] := in_some_step t0 lt.
  have x01 : 0 <= t - k%:R <= 1 by rewrite subr_ge0 kt ler_subl_addl -mulrSr.
  apply: le_trans (before k (t - k%:R) kT x01); apply: (signal_near pP _ s0 seen).
  have := polynomial_error (ends kT) (later (ler0n _ k)) x01; rewrite /= [_ + (t - _)]addrC subrK addr0 big_ord_recr/= => ne.
  by apply: le_trans ne (ler_add (error_at (ltnW kT)) (errs kT)).
apply: le_trans after; apply: (signal_near pP _ s0 seen).
have dv : moves (fun s => w T 0%N - z (T%:R + s)) (fun s => M *m (w T 0%N - z (T%:R + s)) + -1 *: (M *m w T 0%N + b)).
  move=> x x0 i; apply: (@derivative_same _ (fun y => w T 0%N i 0 - z (T%:R + y) i 0)) => [y|]; first by rewrite !mxE.
  have -> : M *m (w T 0%N - z (T%:R + x)) + -1 *: (M *m w T 0%N + b) = 0 - (M *m z (T%:R + x) + b).
    by rewrite scaleN1r mulmxBr !opprD addrACA subrr.
  rewrite entry_difference [X in X - _]mxE; apply: derivativeD (derivative_constant _ _) _.
  exact: derivative_opposite (later (ler0n _ T) x0 i).
have x0 : 0 <= t - T%:R by rewrite subr_ge0.
have := error_stays dv x0; rewrite normZ normrN1 mul1r addr0 [T%:R + _]addrC subrK => ne.
exact: le_trans ne (ler_add (error_at (leqnn T)) (lexx _)).
Qed.
End Response.
End Continuous.

(* Kind `step_peaks`. *)
Section Kind.
Variables (R : rcfType) (n m : nat) (M P : 'M[R]_n) (a : R) (S : 'M[R]_(m, n)) (size : 'I_m -> R).
Variables (b : 'cV[R]_n) (d bound : 'cV[R]_m) (T : nat) (delta : nat -> R).
Hypotheses (sP : P^T = P) (size0 : forall i, 0 < size i) (a0 : 0 < a).
Hypothesis seen : forall v, 0 <= form (P - \sum_i size i ^- 2 *: ((row i S)^T *m row i S)) v v.

Lemma entry_row (v : 'cV[R]_n) i : (S *m v + d) i 0 = (row i S *m v) 0 0 + d i 0.
Proof. by rewrite -row_mul !mxE. Qed.

Theorem peaks_discrete (z y : nat -> 'cV[R]_n) :
  (forall v, 0 <= form (P - M^T *m P *m M - (a *+ 2) *: P) v v) ->
  z 0%N = 0 -> (forall t, z t.+1 = M *m z t + b) ->
  y 0%N = 0 -> (forall t, (t < T)%N -> norm P (M *m y t + b - y t.+1) <= delta t) ->
  (forall i t, (t < T)%N -> (`|(S *m y t + d) i 0| + size i * (\sum_(k < t) delta k) <= bound i 0)%R) ->
  (forall i, (`|(S *m y T + d) i 0| + size i * (\sum_(k < T) delta k + norm P (M *m y T + b - y T) / a) <= bound i 0)%R) ->
  forall t i, `|(S *m z t + d) i 0| <= bound i 0.
Proof.
move=> falls z0 zS y0 errs before after t i; have pP := positive size0 seen.
rewrite entry_row; apply: (signal_discrete sP pP a0 (falls_discrete falls) z0 zS y0 errs (size0 i) (each_signal size0 seen i)).
  by move=> k kT; rewrite -entry_row; apply: before.
by rewrite -entry_row; apply: after.
Qed.

Theorem peaks_continuous (K : nat -> nat) (w : nat -> nat -> 'cV[R]_n) (z : R -> 'cV[R]_n) : complete_order R ->
  (forall v, 0 <= form (- (P *m M + M^T *m P) - (a *+ 2) *: P) v v) ->
  z 0 = 0 -> moves z (fun t => M *m z t + b) ->
  w 0%N 0%N = 0 -> (forall k, (k < T)%N -> w k (K k).+1 = 0) ->
  (forall k, (k < T)%N -> w k.+1 0%N = polynomial (K k) (w k) 1) ->
  (forall k, (k < T)%N -> missed M P b (K k) (w k) <= delta k) ->
  (forall i k x, (k < T)%N -> 0 <= x <= 1 ->
    (`|(S *m polynomial (K k) (w k) x + d) i 0| + size i * (\sum_(j < k.+1) delta j) <= bound i 0)%R) ->
  (forall i, (`|(S *m w T 0%N + d) i 0| + size i * (\sum_(j < T) delta j + norm P (M *m w T 0%N + b) / a) <= bound i 0)%R) ->
  forall t i, 0 <= t -> `|(S *m z t + d) i 0| <= bound i 0.
Proof.
move=> sup falls z0 dz w0 ends joined errs before after t i t0; have pP := positive size0 seen.
rewrite entry_row; apply: (signal_continuous sup sP pP a0 (falls_continuous sP falls) z0 dz w0 ends joined errs (size0 i) (each_signal size0 seen i)) => //.
  by move=> k x kT x01; rewrite -entry_row; apply: before.
by rewrite -entry_row; apply: after.
Qed.
End Kind.
