(* checker/saturation.py: kind `saturation`, inputs that are cut off at their limits, with anti-windup gains.

   The loop is z' = M z + E (w - v) + d, v = U z + j the inputs that agents compute, w these cut off at their limits, E with
   the anti-windup gains in the rows of the agents' states, and d and j what set-points and disturbances add.  So the sectors
   of performance.v hold for the difference of two solutions, and in an ellipsoid for one. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location stability instability positive_forms performance.
From mcexact Require convergence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Saturation.
Variable C : numClosedFieldType.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").

(* w is v cut off at l and h. *)
Definition cut_off (l h v w : C) := [/\ l <= w, w <= h & [\/ w = v, w = h /\ h <= v | w = l /\ v <= l]].

Lemma cut_off_normal l h v w y : cut_off l h v w -> l <= y -> y <= h -> 0 <= (w - y) * (v - w).
Proof.
move=> [lw wh [->|[-> hv]|[-> vl]]] ly yh; first by rewrite subrr mulr0.
  by rewrite mulr_ge0// subr_ge0.
by rewrite mulr_le0// subr_le0.
Qed.

(* What is cut off is between 0 and what is not, and so are increments. *)
Lemma cut_off_increment l h v w x y : cut_off l h v w -> cut_off l h x y ->
  0 <= (w - y) * ((v - x) - (w - y)).
Proof.
move=> cv cx; have [[lw wh _] [ly yh _]] := (cv, cx).
have -> : (w - y) * ((v - x) - (w - y)) = (w - y) * (v - w) + (y - w) * (x - y).
  by rewrite -[y - w]opprB mulNr -mulrN -mulrDr; congr (_ * _); rewrite !opprB addrACA [RHS]addrACA [- x - w]addrC.
by rewrite addr_ge0 ?(cut_off_normal cv)// (cut_off_normal cx).
Qed.

Section Loop.
Variables (n r : nat) (M P : 'M[C]_n) (E : 'M[C]_(n, r)) (U : 'M[C]_(r, n)) (theta l h : 'rV[C]_r).
Hypotheses (rU : real_mx U) (theta0 : forall k, 0 < theta 0 k) (pP : posdef P).
Definition cut_off_at (v w : 'cV[C]_r) := forall k, cut_off (l 0 k) (h 0 k) (v k 0) (w k 0).
Local Notation ones := (const_mx 1 : 'rV[C]_r).
Local Notation v z j := (U *m z + j).

Lemma real_zeros : real_mx (0 : 'rV[C]_r). Proof. by move=> i k; rewrite mxE rpred0. Qed.
Lemma real_ones : real_mx ones. Proof. by move=> i k; rewrite mxE rpred1. Qed.
Lemma real_difference a b (x y : 'M[C]_(a, b)) : real_mx x -> real_mx y -> real_mx (x - y).
Proof. by move=> rx ry i k; rewrite !mxE rpredB. Qed.

Lemma difference_within (z y : 'cV[C]_n) (w x j : 'cV[C]_r) : cut_off_at (v z j) w -> cut_off_at (v y j) x ->
  within U 0 ones (z - y) (w - x).
Proof.
move=> cw cx k; have := cut_off_increment (cw k) (cx k).
have -> : (v z j) k 0 - (v y j) k 0 = (U *m (z - y)) k 0.
  by rewrite mulmxBr ![(_ + _ : 'cV__) k 0]mxE [(- (U *m y)) k 0]mxE opprD addrACA subrr addr0.
by rewrite [(w - x) k 0]mxE [(- x) k 0]mxE [(0 : 'rV__) 0 k]mxE [ones 0 k]mxE mul0r subr0 mul1r.
Qed.

Lemma difference_moves (z y d : 'cV[C]_n) (w x j : 'cV[C]_r) :
  (M *m z + E *m (w - v z j) + d) - (M *m y + E *m (x - v y j) + d) = (M - E *m U) *m (z - y) + E *m (w - x).
Proof.
have one (s : 'cV[C]_n) (u : 'cV[C]_r) : M *m s + E *m (u - v s j) + d = (M - E *m U) *m s + E *m u + (d - E *m j).
  by rewrite mulmxBl mulmxBr mulmxDr mulmxA opprD !addrA [LHS]addrAC; congr (_ + _ + _); rewrite addrAC.
rewrite !one opprD addrACA subrr addr0 opprD addrACA.
by rewrite -!mulmxBr.
Qed.

(* The form of the difference of two solutions falls at least as fast as e times itself. *)
Theorem global_continuous : posdef (decrease_continuous M P E U theta 0 ones) ->
  exists2 e, 0 < e & forall (z y zrate yrate d : 'cV[C]_n) (w x j : 'cV[C]_r),
    real_mx z -> real_mx y -> real_mx w -> real_mx x -> cut_off_at (v z j) w -> cut_off_at (v y j) x ->
    zrate = M *m z + E *m (w - v z j) + d -> yrate = M *m y + E *m (x - v y j) + d ->
    ((zrate - yrate)^H *m P *m (z - y) + (z - y)^H *m P *m (zrate - yrate)) 0 0 <= - (e * form P (z - y)).
Proof.
move=> /(sector_continuous rU real_zeros real_ones theta0 pP)[e e0 fall]; exists e => // z y zrate yrate d w x j rz ry rw rx cw cx ez ey.
apply: (fall _ _ (w - x)); try exact: real_difference; first exact: difference_within cw cx.
by rewrite ez ey difference_moves.
Qed.

Theorem global_discrete : posdef (decrease_discrete M P E U theta 0 ones) ->
  exists rho, [/\ 0 <= rho, rho < 1 & forall (z y d : nat -> 'cV[C]_n) (w x j : nat -> 'cV[C]_r),
    (forall t, [/\ real_mx (z t), real_mx (w t), cut_off_at (v (z t) (j t)) (w t) &
      z t.+1 = M *m z t + E *m (w t - v (z t) (j t)) + d t]) ->
    (forall t, [/\ real_mx (y t), real_mx (x t), cut_off_at (v (y t) (j t)) (x t) &
      y t.+1 = M *m y t + E *m (x t - v (y t) (j t)) + d t]) ->
    forall t, form P (z t - y t) <= rho ^+ t * form P (z 0%N - y 0%N)].
Proof.
move=> /(sector_discrete rU real_zeros real_ones theta0 pP)[rho [rho0 rho1 fall]].
exists rho; split=> // z y d w x j sz sy; apply: (fall (fun t => z t - y t) (fun t => w t - x t)) => t.
have [[rz rw cw ez] [ry rx cx ey]] := (sz t, sy t).
split; try exact: real_difference; first exact: difference_within cw cx.
by rewrite ez ey difference_moves.
Qed.

(* In the ellipsoid z'Pz <= 1 every a v is within the limits, so that what is cut off is between a v and v. *)
Section Region.
Variables (a c : 'rV[C]_r).
Hypotheses (a0 : forall k, 0 <= a 0 k) (c0 : forall k, 0 < c 0 k).
Hypotheses (lc : forall k, l 0 k <= - c 0 k) (ch : forall k, c 0 k <= h 0 k).
Hypothesis inside : forall k, posdef (P - (a 0 k / c 0 k) ^+ 2 *: ((row k U)^H *m row k U)).

Lemma real_a : real_mx a. Proof. by move=> i k; rewrite ord1 ger0_real. Qed.

Lemma small_input (z : 'cV[C]_n) k : form P z <= 1 -> `|a 0 k * (U *m z) k 0| <= c 0 k.
Proof.
move=> z1; have := posdef_psd (inside k) z.
rewrite formD formN formZ -[(row k U)^H]mulmx1 form_sub form1 big_ord1 -row_mul mxE subr_ge0 => small.
have c1 : 0 <= c 0 k by apply: ltW.
rewrite -(@ler_pexpn2r _ 2)// ?nnegrE ?normr_ge0// normrM exprMn (ger0_norm (a0 k)).
have c2 : 0 < c 0 k ^+ 2 by rewrite exprn_gt0.
move: small; rewrite expr_div_n mulrAC ler_pdivr_mulr// => /le_trans; apply.
by rewrite ler_pimull// ltW.
Qed.

Lemma region_within (z : 'cV[C]_n) (w : 'cV[C]_r) : real_mx z -> form P z <= 1 -> cut_off_at (U *m z) w ->
  within U a ones z w.
Proof.
move=> rz z1 cw k; rewrite [ones 0 k]mxE mul1r.
have ra : a 0 k * (U *m z) k 0 \is Num.real by rewrite rpredM ?real_a// real_seen.
have := small_input k z1; rewrite real_ler_norml// => /andP[low high].
by apply: cut_off_normal (cw k) _ _; [apply: le_trans (lc k) _ | apply: le_trans high (ch k)].
Qed.

Lemma moves (z : 'cV[C]_n) (w : 'cV[C]_r) : M *m z + E *m (w - U *m z) = (M - E *m U) *m z + E *m w.
Proof. by rewrite mulmxBl mulmxBr mulmxA addrA addrAC. Qed.

Theorem region_continuous : posdef (decrease_continuous M P E U theta a ones) ->
  exists2 e, 0 < e & forall (z rate : 'cV[C]_n) (w : 'cV[C]_r), real_mx z -> real_mx w -> form P z <= 1 ->
    cut_off_at (U *m z) w -> rate = M *m z + E *m (w - U *m z) ->
    (rate^H *m P *m z + z^H *m P *m rate) 0 0 <= - (e * form P z).
Proof.
move=> /(sector_continuous rU real_a real_ones theta0 pP)[e e0 fall]; exists e => // z rate w rz rw z1 cw er.
by apply: (fall _ _ w) => //; [apply: region_within | rewrite er moves].
Qed.

(* Solutions that start in the ellipsoid stay in it, and tend to 0. *)
Theorem region_discrete : posdef (decrease_discrete M P E U theta a ones) ->
  exists rho, [/\ 0 <= rho, rho < 1 & forall (z : nat -> 'cV[C]_n) (w : nat -> 'cV[C]_r), form P (z 0%N) <= 1 ->
    (forall t, [/\ real_mx (z t), real_mx (w t), cut_off_at (U *m z t) (w t) &
      z t.+1 = M *m z t + E *m (w t - U *m z t)]) ->
    forall t, form P (z t) <= 1 /\ form P (z t) <= rho ^+ t * form P (z 0%N)].
Proof.
move=> /(falls pP)[e e0 fall]; have e1 : 0 < 1 + e by rewrite addr_gt0 ?ltr01.
have rho0 : 0 <= (1 + e)^-1 by rewrite invr_ge0 ltW.
have rho1 : (1 + e)^-1 < 1 by rewrite invf_lt1// ltr_addl.
exists (1 + e)^-1; split=> // z w z1 sol; elim=> [|t [in1 IH]]; first by rewrite expr0 mul1r.
have [rz rw cw ez] := sol t; set next := z t.+1.
have le : form P next <= form P (z t) - e * form P (z t).
  rewrite ler_subr_addr -ler_subr_addl (le_trans (fall (z t) (w t)))//.
  rewrite (decrease_discrete_at M E rU real_a real_ones theta0 pP rz rw) -moves -ez -/next.
  by rewrite ger_addl oppr_le0 (gap_ge0 theta0)//; apply: region_within.
have zt0 : 0 <= e * form P (z t) by rewrite mulr_ge0 ?(posdef_psd pP)// ltW.
have up : form P next <= form P (z t) by apply: le_trans le _; rewrite ger_addl oppr_le0.
split; first exact: le_trans up in1.
apply: (@le_trans _ _ ((1 + e)^-1 * form P (z t))); last by rewrite exprS -mulrA ler_wpmul2l.
rewrite ler_pdivl_mull// mulrDl mul1r.
by have := ler_add le (ler_wpmul2l (ltW e0) up); rewrite subrK.
Qed.
End Region.
End Loop.
End Saturation.

(* In continuous time: what falls where it is at most c, stays at most c. *)
Section Staying.
Import convergence.
Variable R : rcfType.
Hypothesis complete : complete_order R.

Lemma near_values (u : R -> R) t d : derivative u t d -> forall e, 0 < e ->
  exists2 q, 0 < q & forall k, `|k| < q -> `|u (t + k) - u t| < e.
Proof.
move=> [s ls step] e e0; have [q q0 close] := ls _ ltr01.
have B0 : 0 < `|d| + 1 by rewrite ltr_paddl ?ltr01.
exists (Num.min q (e / (`|d| + 1))) => [|k]; first by rewrite lt_minr q0 divr_gt0.
rewrite lt_minr => /andP[/close kq ke]; rewrite step addrAC subrr add0r normrM.
have bs : `|s k| <= `|d| + 1.
  have := ler_norm_add (s k - d) d; rewrite subrK => /le_trans; apply.
  by rewrite addrC ler_add2l.
by rewrite (le_lt_trans (ler_wpmul2r _ bs))// mulrC -ltr_pdivl_mulr.
Qed.

Theorem ellipsoid_stays (u : R -> R) c : u 0 <= c ->
  (forall t, 0 <= t -> exists2 d, derivative u t d & u t = c -> d < 0) -> forall b, 0 <= b -> u b <= c.
Proof.
move=> u0 fall b b0; rewrite leNgt; apply/negP => cb.
pose E t := (0 <= t <= b) && (u t <= c).
have E0 : E 0 by rewrite /E lexx b0 u0.
have [||s [above least]] := complete (E := E); first by exists 0.
  by exists b => t /andP[/andP[]].
have s0 : 0 <= s by apply: above.
have sb : s <= b by apply: least => t /andP[/andP[]].
have half (q : R) : 0 < q -> 0 < q / 2%:R < q.
  move=> q0; apply/andP; split; first by rewrite divr_gt0 ?ltr0n.
  by rewrite ltr_pdivr_mulr ?ltr0n// ltr_pmulr// ltr1n.
have [d du at_c] := fall s s0.
have us : u s <= c.
  rewrite leNgt; apply/negP => cs; have e0 : 0 < u s - c by rewrite subr_gt0.
  have [q q0 close] := near_values du e0.
  have /andP[h0 hq] := half _ q0; have : s <= s - q / 2%:R; last by rewrite ler_addl oppr_ge0 leNgt h0.
  apply: least => t Et; rewrite leNgt; apply/negP => lt.
  have ts : t <= s by apply: above.
  have := close (t - s); rewrite [s + _]addrC subrK ler0_norm ?subr_le0// opprB => near.
  have {near} : `|u t - u s| < u s - c.
    by apply: near; rewrite (lt_trans _ hq)// ltr_subl_addl -ltr_subl_addr.
  have /andP[_ ut] := Et; rewrite distrC ger0_norm ?subr_ge0 ?(le_trans ut) ?(ltW cs)//.
  by rewrite ltr_add2l ltr_opp2 ltNge ut.
have lt : s < b by rewrite lt_neqAle sb andbT; apply: contraL us => /eqP ->; rewrite -ltNge.
have [q q0 later] : exists2 q, 0 < q & forall k, 0 < k -> k < q -> u (s + k) <= c.
  have [e|] := eqVneq (u s) c; last first.
    move=> ne; have e0 : 0 < c - u s by rewrite subr_gt0 lt_neqAle ne.
    have [q q0 close] := near_values du e0.
    exists q => // k k0 kq; have := close k; rewrite gtr0_norm// => /(_ kq) /(le_lt_trans (ler_norm _)).
    by rewrite ltr_add2r => /ltW.
  have [slope ls step] := du; have d0 : 0 < - d by rewrite oppr_gt0 at_c.
  have [q q0 close] := ls _ d0; exists q => // k k0 kq.
  rewrite step e ger_addl pmulr_lle0// -(subrK d (slope k)) -[0](addNr d) ler_add2r.
  by apply: le_trans (ler_norm _) _; apply: close; rewrite gtr0_norm.
have /andP[h0 hq] := half _ q0; pose k := Num.min (q / 2%:R) (b - s).
have k0 : 0 < k by rewrite lt_minr h0 subr_gt0.
suff /above : E (s + k) by rewrite ger_addl leNgt k0.
rewrite /E addr_ge0 ?(ltW k0)//= -ler_subr_addl le_minl lexx orbT /=.
by apply: later => //; rewrite (le_lt_trans _ hq)// le_minl lexx.
Qed.
End Staying.
