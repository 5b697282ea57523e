(* checker/core/evidence.py, root discs: n^2 |p(c)|^2 <= r^2 |p'(c)|^2 puts a root within r of c, and
   n disjoint discs hold exactly one root each. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Discs.
Variable C : numClosedFieldType.
Implicit Types (p : {poly C}) (c z rho : C).

Lemma deriv_far c rho (rs : seq C) : 0 <= rho -> all (fun r => rho < `|c - r|) rs ->
  let P := \prod_(r <- rs) ('X - r%:P) in
  rho * `|P^`().[c]| <= (size rs)%:R * `|P.[c]| ?= iff (rs == [::]) /\ P.[c] != 0.
Proof.
move=> rho0; elim: rs => [_|r rs IH] /=.
  by rewrite !big_nil derivC !hornerC normr0 mulr0 mul0r oner_eq0; split=> //; split; rewrite ?eqxx.
case/andP=> far /IH; rewrite !big_cons; set P := \prod_(j <- rs) _; case=> [[le _] nP].
have cr : c - r != 0 by rewrite -normr_gt0 (le_lt_trans rho0).
have Pc : 0 < `|P.[c]| by rewrite normr_gt0.
rewrite derivM derivXsubC mul1r hornerD !hornerM hornerXsubC.
split; last by rewrite mulf_neq0.
have lt : rho * `|P.[c] + (c - r) * P^`().[c]| < (size rs).+1%:R * `|(c - r) * P.[c]|.
  apply: (@le_lt_trans _ _ (rho * `|P.[c]| + `|c - r| * (rho * `|P^`().[c]|))).
    by rewrite mulrCA -mulrDr ler_wpmul2l// -normrM ler_norm_add.
  rewrite -addn1 natrD mulrDl mul1r addrC normrM ler_lt_add//.
    by rewrite [X in _ <= X]mulrCA ler_wpmul2l.
  by rewrite ltr_pmul2r.
by split; [exact: ltW | rewrite lt_eqF].
Qed.

(* Rule "root disc". *)
Theorem root_disc p d c rho : size p = d.+2 -> 0 <= rho ->
  (d.+1)%:R ^+ 2 * `|p.[c]| ^+ 2 <= rho ^+ 2 * `|p^`().[c]| ^+ 2 ->
  exists2 z, root p z & `|c - z| <= rho.
Proof.
move=> sp rho0 h; have [rs e] := roots_of p.
have lp : lead_coef p != 0 by rewrite lead_coef_eq0 -size_poly_eq0 sp.
have srs : size rs = d.+1.
  by have := congr1 (fun f : {poly C} => size f) e; rewrite size_scale// size_prod_XsubC sp => -[].
have [/allP far|/allPn[z zrs near]] := boolP (all (fun r => rho < `|c - r|) rs); last first.
  exists z; first exact: root_in zrs.
  by rewrite real_leNgt ?normr_real ?ger0_real.
have /allP/(deriv_far rho0)[[le eq] nP] := far; rewrite srs /= in le eq.
have lt : rho * `|p^`().[c]| < (d.+1)%:R * `|p.[c]|.
  rewrite e derivZ !hornerZ !normrM !(mulrCA _ `|lead_coef p|) ltr_pmul2l ?normr_gt0//.
  by rewrite lt_neqAle le eq; case: (rs) srs.
have := lt; rewrite -(@ltr_pexpn2r _ 2) ?nnegrE ?mulr_ge0 ?ler0n// !exprMn => /lt_geF.
by rewrite h.
Qed.

(* Rule "root discs": d disjoint discs hold exactly one root each, and every root is in one. *)
Theorem root_discs p d (c rho : 'I_d.+1 -> C) : size p = d.+2 -> (forall i, 0 <= rho i) ->
  (forall i, (d.+1)%:R ^+ 2 * `|p.[c i]| ^+ 2 <= rho i ^+ 2 * `|p^`().[c i]| ^+ 2) ->
  (forall i j, i != j -> rho i + rho j < `|c i - c j|) ->
  exists z : 'I_d.+1 -> C, [/\ injective z, forall x, root p x <-> exists i, x = z i &
    forall i x, root p x -> (`|c i - x| <= rho i <-> x = z i)].
Proof.
move=> sp rho0 h dis.
have [z zP] : exists z : 'I_d.+1 -> C, forall i, root p (z i) /\ `|c i - z i| <= rho i.
  have /fin_all_exists2[z rz nz] i := root_disc sp (rho0 i) (h i).
  by exists z => i; split.
have apart i j x : `|c i - x| <= rho i -> `|c j - x| <= rho j -> i = j.
  move=> hi hj; apply/eqP; apply: contraT => /dis; rewrite -[c i](subrK x) -addrA.
  have -> : x - c j = - (c j - x) by rewrite opprB.
  move=> /lt_le_trans/(_ (ler_norm_sub _ _))/lt_le_trans/(_ (ler_add hi hj)).
  by rewrite ltxx.
have zi : injective z by move=> i j e; apply: (apart _ _ (z i)); [case: (zP i)|rewrite e; case: (zP j)].
have [rs e] := roots_of p.
have lp : lead_coef p != 0 by rewrite lead_coef_eq0 -size_poly_eq0 sp.
have srs : size rs = d.+1.
  by have := congr1 (fun f : {poly C} => size f) e; rewrite size_scale// size_prod_XsubC sp => -[].
have inrs x : root p x = (x \in rs).
  by rewrite {1}e -root_prod_XsubC /root hornerZ mulf_eq0 (negPf lp).
have all_roots x : root p x <-> exists i, x = z i.
  split=> [|[i ->]]; last by case: (zP i).
  have u : uniq (codom z) by rewrite map_inj_uniq ?enum_uniq.
  have sub : {subset codom z <= rs} by move=> y /codomP[i ->]; rewrite -inrs; case: (zP i).
  have [|_ eqs] := uniq_min_size u sub; first by rewrite srs size_codom card_ord.
  by rewrite inrs -eqs => /codomP[i ->]; exists i.
exists z; split=> // i x /all_roots[j ->]; split=> [hi|->]; last by case: (zP i).
by congr z; apply: (apart _ _ (z j)) => //; case: (zP j).
Qed.
End Discs.
