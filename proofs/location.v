(* checker/location.py: where the roots of a polynomial lie, by exact recursions.

   Routh's recursion (continuous time) and Schur and Cohn's (discrete time), each an equivalence, for
   polynomials with real coefficients over a closed field C such as algC.  No analysis is used: the
   inequality behind Routh's step is Julia's for finite Blaschke products, by induction on the roots. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Coq Require Import Ring.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Identities, by the ring tactic over an arbitrary commutative ring structure. *)
Section Abstract.
Variables (T : Type) (o i : T) (add mul sub : T -> T -> T) (opp : T -> T).
Hypothesis rt : ring_theory o i add mul sub opp eq.
Add Ring abstract_ring : rt.
Local Notation "x + y" := (add x y). Local Notation "x * y" := (mul x y).
Local Notation "x - y" := (add x (opp y)). Local Notation "- x" := (opp x).

Lemma abs_factor (z z' r r' : T) : (z - r') * (z' - r) - (z + r) * (z' + r') = - (r + r') * (z + z').
Proof. ring. Qed.
Lemma abs_split (D N d e : T) : d * D - e * N = (D - N) * d + N * (d - e).
Proof. ring. Qed.
Lemma abs_cauchy (s t X X' Y Y' : T) : (s + t) * (t * (X * X') + s * (Y * Y')) =
  s * t * ((X + Y) * (X' + Y')) + (t * X - s * Y) * (t * X' - s * Y').
Proof. ring. Qed.
Lemma abs_gap (D D' N N' d d' e e' : T) : d * D * (d' * D') - e * N * (e' * N') =
  (D * D' - N * N') * (d * d') + N * N' * (d * d' - e * e').
Proof. ring. Qed.
Lemma abs_weights (s t a d2 N2 x : T) : s * t * ((t + s) * (a * d2 + N2 * (t * x))) =
  (s + t) * (t * (s * a * d2) + s * (N2 * (t * t) * x)).
Proof. ring. Qed.
Lemma abs_disc (z z' r r' : T) :
  (z' - r) * (z - r') - (i - r * z) * (i - r' * z') = (z * z' - i) * (i - r * r').
Proof. ring. Qed.
End Abstract.

Section Identities.
Variable R : comRingType.
Implicit Types z d e r : R.

Definition ring_of_R : ring_theory (0 : R) 1 +%R *%R (fun x y => x - y) -%R eq.
Proof.
by split; [exact: add0r|exact: addrC|exact: addrA|exact: mul1r|exact: mulrC|exact: mulrA
  |exact: mulrDl|by []|exact: subrr].
Qed.

Lemma id_factor (z z' r r' : R) : (z - r') * (z' - r) - (z + r) * (z' + r') = - (r + r') * (z + z').
Proof. exact: (abs_factor ring_of_R). Qed.
Lemma id_split (D N d e : R) : d * D - e * N = (D - N) * d + N * (d - e).
Proof. exact: (abs_split ring_of_R). Qed.
Lemma id_cauchy (s t X X' Y Y' : R) : (s + t) * (t * (X * X') + s * (Y * Y')) =
  s * t * ((X + Y) * (X' + Y')) + (t * X - s * Y) * (t * X' - s * Y').
Proof. exact: (abs_cauchy ring_of_R). Qed.
Lemma id_gap (D D' N N' d d' e e' : R) : d * D * (d' * D') - e * N * (e' * N') =
  (D * D' - N * N') * (d * d') + N * N' * (d * d' - e * e').
Proof. exact: (abs_gap ring_of_R). Qed.
Lemma id_disc (z z' r r' : R) :
  (z' - r) * (z - r') - (1 - r * z) * (1 - r' * z') = (z * z' - 1) * (1 - r * r').
Proof. exact: (abs_disc ring_of_R). Qed.
End Identities.

Section Closed.
Variable C : numClosedFieldType.
Implicit Types (p f : {poly C}) (z r : C) (rs : seq C).

Lemma sqr_norm z : `|z| ^+ 2 = z * z^*. Proof. exact: normCK. Qed.

Lemma julia rs z : all (fun r => r + r^* < 0) rs -> 0 <= z + z^* ->
  let D := \prod_(r <- rs) (z - r^*) in let N := \prod_(r <- rs) (z + r) in
  let s := \sum_(r <- rs) - (r + r^*) in
  [/\ `|D - N| ^+ 2 * (z + z^*) <= s * (`|D| ^+ 2 - `|N| ^+ 2), `|N| ^+ 2 <= `|D| ^+ 2 & 0 <= s].
Proof.
move=> + z0; elim: rs => [_|r rs IH] /=; first by rewrite !big_nil subrr normr0 expr0n mul0r mul0r.
case/andP=> r0 /IH; rewrite !big_cons.
move: (\prod_(j <- rs) (z - j^*)) (\prod_(j <- rs) (z + j)) => D N [IH1 IH2 IH3].
set s := \sum_(j <- rs) _ in IH1 IH3 *.
set d := z - r^*; set e := z + r; pose t := - (r + r^*).
have t0 : 0 < t by rewrite oppr_gt0.
have tr : t^* = t by rewrite /t rmorphN rmorphD conjCK addrC.
have de : d - e = t by rewrite /d /e /t opprD addrACA subrr add0r opprD addrC.
have gap : `|d| ^+ 2 - `|e| ^+ 2 = t * (z + z^*).
  by rewrite !sqr_norm /d /e !rmorphD !rmorphN conjCK id_factor.
have ed : `|e| ^+ 2 <= `|d| ^+ 2 by rewrite -subr_ge0 gap mulr_ge0// ltW.
have gap2 : `|d * D| ^+ 2 - `|e * N| ^+ 2 =
    (`|D| ^+ 2 - `|N| ^+ 2) * `|d| ^+ 2 + `|N| ^+ 2 * (t * (z + z^*)).
  by rewrite -gap !sqr_norm !rmorphM id_gap.
have nn (x : C) : 0 <= `|x| ^+ 2 by rewrite exprn_ge0.
have a0 : 0 <= `|D| ^+ 2 - `|N| ^+ 2 by rewrite subr_ge0.
split; last by rewrite addr_ge0// ltW.
  rewrite gap2 id_split de.
  have [s0|s0] := eqVneq s 0.
    have DN : `|D - N| ^+ 2 * (z + z^*) = 0.
      by apply/eqP; rewrite eq_le (le_trans IH1) ?s0 ?mul0r//= mulr_ge0.
    have e1 : `|(D - N) * d + N * t| ^+ 2 * (z + z^*) = t * (`|N| ^+ 2 * (t * (z + z^*))).
      have [->|zn] := eqVneq (z + z^*) 0; first by rewrite !mulr0.
      move/eqP: DN; rewrite mulf_eq0 (negPf zn) orbF expf_eq0 normr_eq0 /= => /eqP->.
      rewrite mul0r add0r normrM exprMn (gtr0_norm t0) (expr2 t).
      by move: (`|N| ^+ 2) (z + z^*) => N2 x; rewrite -!mulrA mulrCA.
    by rewrite s0 addr0 e1 -/t ler_pmul2l// ler_addr mulr_ge0.
  have {}s0 : 0 < s by rewrite lt_def s0.
  rewrite -(ler_pmul2l (mulr_gt0 s0 t0)).
  have sr : s^* = s by rewrite (CrealP _)// ger0_real// ltW.
  have := id_cauchy s t ((D - N) * d) ((D - N) * d)^* (N * t) (N * t)^*.
  have -> : (t * ((D - N) * d) - s * (N * t)) * (t * ((D - N) * d)^* - s * (N * t)^*) =
      `|t * ((D - N) * d) - s * (N * t)| ^+ 2.
    by rewrite sqr_norm rmorphB !(rmorphM _ t) !(rmorphM _ s) tr sr.
  rewrite -rmorphD -!sqr_norm => id1.
  apply: (@le_trans _ _ ((s + t) * (t * (`|D - N| ^+ 2 * (z + z^*) * `|d| ^+ 2)
      + s * (`|N| ^+ 2 * t ^+ 2 * (z + z^*))))).
    have -> : t * (`|D - N| ^+ 2 * (z + z^*) * `|d| ^+ 2) + s * (`|N| ^+ 2 * t ^+ 2 * (z + z^*)) =
        (t * `|(D - N) * d| ^+ 2 + s * `|N * t| ^+ 2) * (z + z^*).
      rewrite !normrM !exprMn (gtr0_norm t0).
      move: (`|N| ^+ 2) (`|D - N| ^+ 2) (`|d| ^+ 2) (t ^+ 2) (z + z^*) => N2 a d2 t2 x.
      by rewrite mulrDl -!mulrA [d2 * x]mulrC.
    rewrite (mulrA (s * t)) (mulrA (s + t)) id1 (mulrDl _ _ (z + z^*)) ler_addl.
    by rewrite mulr_ge0.
  have e2 : s * t * ((t + s) * ((`|D| ^+ 2 - `|N| ^+ 2) * `|d| ^+ 2 + `|N| ^+ 2 * (t * (z + z^*)))) =
     (s + t) * (t * (s * (`|D| ^+ 2 - `|N| ^+ 2) * `|d| ^+ 2) + s * (`|N| ^+ 2 * t ^+ 2 * (z + z^*))).
    rewrite (expr2 t).
    move: (`|N| ^+ 2) (`|D| ^+ 2 - `|N| ^+ 2) (`|d| ^+ 2) (z + z^*) => N2 a d2 x.
    exact: (abs_weights (ring_of_R _)).
  rewrite -/t e2 ler_pmul2l ?addr_gt0// ler_add2r ler_pmul2l// ler_wpmul2r//.
by rewrite !normrM !exprMn; apply: ler_pmul.
Qed.
End Closed.
