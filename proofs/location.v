(* checker/core/roots.py: where the roots of a polynomial lie, by exact recursions.

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
Lemma abs_last (c z z' G G' : T) :
  c * z * G * (c * z' * G') - (c * z * G - (G + G)) * (c * z' * G' - (G' + G')) =
  c * (z + z') * (G * G') + c * (z + z') * (G * G') - ((G * G' + G * G') + (G * G' + G * G')).
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
(* Hurwitz: every root has negative real part; Schur: modulus below 1. *)
Definition hurwitz p := forall z, root p z -> 'Re z < 0.
Definition schur p := forall z, root p z -> `|z| < 1.

Lemma Re_lt0 z : ('Re z < 0) = (z + z^* < 0).
Proof. by rewrite ReE pmulr_llt0 ?invr_gt0 ?ltr0n. Qed.

Definition real_poly p := p \is a polyOver Num.real.

Lemma conj_horner p z : real_poly p -> (p.[z])^* = p.[z^*].
Proof.
move=> /polyOverP rp; rewrite -horner_map; congr (_.[_]); apply/polyP=> i.
by rewrite coef_map /= (CrealP (rp i)).
Qed.

Lemma roots_of p : {rs | p = lead_coef p *: \prod_(r <- rs) ('X - r%:P)}.
Proof. exact: closed_field_poly_normal. Qed.

Lemma root_in p rs r : p = lead_coef p *: \prod_(r <- rs) ('X - r%:P) -> r \in rs -> root p r.
Proof. by move=> ->; rewrite -root_prod_XsubC => /rootP e; rewrite /root hornerZ e mulr0. Qed.

Lemma horner_roots p rs z : p = lead_coef p *: \prod_(r <- rs) ('X - r%:P) ->
  p.[z] = lead_coef p * \prod_(r <- rs) (z - r).
Proof.
move=> {1}->; rewrite hornerZ horner_prod; congr (_ * _).
by apply: eq_bigr => r _; rewrite hornerXsubC.
Qed.

Lemma horner_roots_conj p rs z : real_poly p -> p = lead_coef p *: \prod_(r <- rs) ('X - r%:P) ->
  p.[z] = lead_coef p * \prod_(r <- rs) (z - r^*).
Proof.
move=> rp e; rewrite -[z]conjCK -conj_horner// (horner_roots _ e) rmorphM rmorph_prod.
rewrite /lead_coef (CrealP (polyOverP rp _)); congr (_ * _); apply: eq_bigr => r _.
by rewrite rmorphB conjCK.
Qed.

Lemma horner_roots_opp p rs z : p = lead_coef p *: \prod_(r <- rs) ('X - r%:P) ->
  (-1) ^+ size rs * p.[- z] = lead_coef p * \prod_(r <- rs) (z + r).
Proof.
move=> e; rewrite (horner_roots _ e) mulrCA; congr (_ * _).
elim: rs {e} => [|r rs IH]; first by rewrite !big_nil mulr1.
by rewrite !big_cons -IH /= exprS mulrACA mulN1r opprB opprK addrC.
Qed.

Lemma subleading rs :
  ('X * \prod_(r <- rs) ('X - r%:P))`_(size rs) = - \sum_(r <- rs) r :> C.
Proof.
elim: rs => [|r rs IH]; first by rewrite !big_nil mulr1 coefX oppr0.
rewrite !big_cons /= coefXM /= mulrBl coefB IH coefCM opprD addrC.
have /monicP : \prod_(r <- rs) ('X - r%:P) \is @monic C by apply: monic_prod_XsubC.
by rewrite lead_coefE size_prod_XsubC /= => ->; rewrite mulr1.
Qed.

Lemma last_gap (c z G : C) : c^* = c -> `|c * z * G| ^+ 2 - `|c * z * G - (G + G)| ^+ 2 =
  c * (z + z^*) * `|G| ^+ 2 *+ 2 - `|G| ^+ 2 *+ 4.
Proof.
move=> cr; rewrite !sqr_norm rmorphB rmorphD (rmorphM _ (c * z)) (rmorphM _ c) cr.
by rewrite (abs_last (ring_of_R C)) -!mulr2n -mulrnA.
Qed.

Section Routh.

(* The next polynomial: every second coefficient, from x^(n-1) down, less a_n / a_(n-1) times the one
   before it; that is p - (a_n / a_(n-1)) x g, with g the part of p of the parity of n - 1. *)
Definition routh_step (F : fieldType) (p : {poly F}) : {poly F} := let n := (size p).-1 in
  \poly_(i < n) (if (0 < i)%N && ~~ odd (n - i) then p`_i - p`_n / p`_n.-1 * p`_i.-1 else p`_i).

Variables (p : {poly C}) (n : nat).
Hypotheses (rp : real_poly p) (sp : size p = n.+2).
Let c := p`_n.+1 / p`_n.
Let s : C := (-1) ^+ n.
Let g z := (p.[z] + s * p.[- z]) / 2%:R.
Let q := routh_step p.

Let gE z : g z = \sum_(i < n.+2) (if odd (n + i) then 0 else p`_i * z ^+ i).
Proof.
rewrite /g !horner_coef sp mulr_sumr -big_split mulr_suml; apply: eq_bigr => i _ /=.
have -> : s * (p`_i * (- z) ^+ i) = (-1) ^+ (n + i) * (p`_i * z ^+ i).
  by rewrite (exprNn z) exprD -/s -mulrA; congr (s * _); rewrite mulrCA.
have n2 : (2%:R : C) != 0 by rewrite pnatr_eq0.
rewrite -signr_odd; case: odd => /=.
  by rewrite expr1 mulN1r subrr mul0r.
by rewrite expr0 mul1r -mulr2n -mulr_natr mulfK.
Qed.

Lemma routh_coef : 0 < lead_coef p -> hurwitz p ->
  exists rs, [/\ p = lead_coef p *: \prod_(r <- rs) ('X - r%:P),
    all (fun r => r + r^* < 0) rs, size rs = n.+1 &
    p`_n *+ 2 = lead_coef p * (\sum_(r <- rs) - (r + r^*)) /\ 0 < \sum_(r <- rs) - (r + r^*)].
Proof.
move=> lp hp; have [rs e] := roots_of p; exists rs.
have ars : all (fun r => r + r^* < 0) rs.
  by apply/allP=> r /(root_in e)/hp; rewrite Re_lt0.
have srs : size rs = n.+1.
  by have := congr1 (fun f : {poly C} => size f) e; rewrite size_scale ?gt_eqF// size_prod_XsubC sp => -[].
pose sg := \sum_(r <- rs) - (r + r^*).
have epn : p`_n *+ 2 = lead_coef p * sg.
  have pnE : p`_n = - (lead_coef p * \sum_(r <- rs) r).
    have := subleading rs; rewrite srs coefXM /= => e1.
    by rewrite {1}e coefZ e1 mulrN.
  rewrite mulr2n {2}pnE -[p`_n](CrealP (polyOverP rp n)) pnE rmorphN rmorphM rmorph_sum.
  rewrite [(lead_coef p)^*](CrealP (polyOverP rp _)) -opprD -mulrDr addrC -big_split/= -mulrN.
  by rewrite -sumrN.
have sg0 : 0 < sg.
  have [r [rs' ers]] : exists r rs', rs = r :: rs' by case: (rs) srs => // r rs' _; exists r, rs'.
  move: ars; rewrite /sg ers big_cons /= => /andP[r0 ars].
  rewrite ltr_paddr ?oppr_gt0// big_seq sumr_ge0// => t /(allP ars).
  by rewrite oppr_ge0 => /ltW.
by split.
Qed.

Hypothesis pn : p`_n != 0.

Lemma routh_horner z : q.[z] = p.[z] - c * z * g z.
Proof.
rewrite gE /q /routh_step sp /= horner_poly horner_coef sp.
have -> : \sum_(i < n.+2) (if odd (n + i) then 0 else p`_i * z ^+ i) =
    \sum_(i < n) (if odd (n + i) then 0 else p`_i * z ^+ i) + p`_n * z ^+ n.
  by rewrite !big_ord_recr /= addnS /= addnn odd_double /= addr0.
have -> : \sum_(i < n.+2) p`_i * z ^+ i = \sum_(i < n.+1) p`_i * z ^+ i + p`_n.+1 * z ^+ n.+1.
  by rewrite big_ord_recr.
rewrite mulrDr; have -> : c * z * (p`_n * z ^+ n) = p`_n.+1 * z ^+ n.+1.
  by rewrite mulrACA divfK// exprS.
rewrite opprD addrACA subrr addr0 !big_ord_recl /= -addrA; congr (_ + _).
rewrite mulr_sumr -sumrB; apply: eq_bigr => i _; rewrite /bump /= add1n subSS.
have -> : odd (n - i) = odd (n + i) by rewrite oddB 1?ltnW// oddD.
case: odd => /=; first by rewrite mulr0 subr0.
by rewrite mulrBl exprS -/c; congr (_ - _); rewrite mulrACA.
Qed.

Lemma routh_opp z : q.[z] + s * q.[- z] = 2%:R * g z.
Proof.
have ss : s * s = 1 by rewrite /s -exprD addnn -mul2n exprM sqrrN !expr1n.
have gN : s * g (- z) = g z.
  by rewrite /g opprK mulrA mulrDr mulrA ss mul1r addrC.
have n2 : (2%:R : C) != 0 by rewrite pnatr_eq0.
rewrite !routh_horner mulrN mulNr opprK [s * (_ + _)]mulrDr [s * (c * z * _)]mulrCA gN.
by rewrite addrACA addNr addr0 /g [RHS]mulrC divfK.
Qed.

Lemma routh_size : size q = n.+1 /\ q`_n = p`_n.
Proof.
have qn : q`_n = p`_n by rewrite /q /routh_step sp coef_poly ltnSn subSnn andbF.
split=> //; apply/eqP; rewrite eqn_leq; apply/andP; split.
  by rewrite /q /routh_step sp size_poly.
by rewrite ltnNge; apply: contra pn => /leq_sizeP/(_ n (leqnn n)); rewrite qn => ->.
Qed.

Lemma routh_real : real_poly q.
Proof.
apply/polyOverP=> i; rewrite coef_poly; case: ifP => _; rewrite ?rpred0//.
have r j : p`_j \is Num.real by apply: (polyOverP rp).
by case: ifP => _ //; rewrite rpredB// rpredM// rpred_div.
Qed.

Lemma hurwitz_bound f z : real_poly f -> hurwitz f -> 0 <= z + z^* -> `|f.[- z]| <= `|f.[z]|.
Proof.
move=> rf hf z0; have [rs e] := roots_of f.
have ars : all (fun r => r + r^* < 0) rs.
  by apply/allP=> r /(root_in e)/hf; rewrite Re_lt0.
have [_ h _] := julia ars z0.
have -> : `|f.[- z]| = `|(-1) ^+ size rs * f.[- z]| by rewrite normrM normrX normrN1 expr1n mul1r.
rewrite (horner_roots_opp _ e) (horner_roots_conj _ rf e) !normrM ler_wpmul2l//.
by rewrite -(@ler_pexpn2r _ 2) ?nnegrE.
Qed.

Lemma routh_sufficient : 0 < c -> hurwitz q -> hurwitz p.
Proof.
move=> c0 hq z rz; rewrite Re_lt0 real_ltNge ?real0//; last first.
  by rewrite CrealE rmorphD conjCK addrC.
apply/negP=> z0.
have nq : q.[z] != 0.
  by apply: contraL z0 => /hq; rewrite Re_lt0 => /lt_geF->.
have bq := hurwitz_bound routh_real hq z0.
pose w := c * z / 2%:R.
have e : q.[z] * (1 + w) = - (w * (s * q.[- z])).
  have cg : c * z * g z = w * (q.[z] + s * q.[- z]) by rewrite routh_opp /w mulrA divfK// pnatr_eq0.
  have e1 := routh_horner z; rewrite (rootP rz) sub0r cg mulrDr opprD in e1.
  by rewrite mulrDr mulr1 {1}e1 [q.[z] * w]mulrC addrAC addNr add0r.
have : `|1 + w| <= `|w|.
  have e2 : `|q.[z]| * `|1 + w| = `|w| * `|q.[- z]|.
    by rewrite -normrM e normrN (normrM w) (normrM s) /s normrX normrN1 expr1n mul1r.
  rewrite -(ler_pmul2l (x := `|q.[z]|)) ?normr_gt0// e2 [X in _ <= X]mulrC.
  by rewrite ler_wpmul2l.
apply/negP; rewrite lt_geF//.
rewrite -(@ltr_pexpn2r _ 2) ?nnegrE// !sqr_norm rmorphD rmorph1 mulrDl mul1r mulrDr mulr1.
rewrite addrA -subr_gt0 addrK -addrA; apply: ltr_paddr; last exact: ltr01.
have k0 : 0 <= c / 2%:R by apply: divr_ge0; [exact: ltW | exact: ler0n].
have kr : (c / 2%:R)^* = c / 2%:R by apply: CrealP; apply: ger0_real.
have -> : w^* + w = c / 2%:R * (z + z^*).
  by rewrite /w mulrAC (rmorphM _ (c / 2%:R)) kr mulrDr addrC.
by rewrite mulr_ge0.
Qed.

Lemma routh_necessary : 0 < lead_coef p -> hurwitz p -> hurwitz q.
Proof.
move=> lp hp; have [rs [e ars srs]] := routh_coef lp hp.
set sg := \sum_(r <- rs) - (r + r^*) => -[epn sg0].
have p0 : 0 < p`_n by rewrite -(@pmulrn_lgt0 _ _ 2)// epn mulr_gt0.
move=> z rz; rewrite Re_lt0 real_ltNge ?real0//; last first.
  by rewrite CrealE rmorphD conjCK addrC.
apply/negP=> z0; have [J _ _] := julia ars z0.
set D := \prod_(r <- rs) (z - r^*) in J; set N := \prod_(r <- rs) (z + r) in J.
rewrite -/sg in J; pose G := g z.
have eP : p.[z] = lead_coef p * D by apply: horner_roots_conj.
have eN : lead_coef p * N = p.[z] - (G + G).
  have := horner_roots_opp z e; rewrite srs exprS mulN1r mulNr -/s => <-.
  have -> : G + G = p.[z] + s * p.[- z] by rewrite /G /g -mulr2n -mulr_natr divfK// pnatr_eq0.
  by rewrite opprD addrA subrr add0r.
have cE : c * sg = 2%:R.
  have -> : c = lead_coef p / p`_n by rewrite lead_coefE sp.
  by rewrite mulrAC -epn -mulr_natl mulfK.
have eG : p.[z] = c * z * G by apply/eqP; rewrite -subr_eq0 -routh_horner; apply/eqP/rootP.
have cr : c^* = c by apply: CrealP; rewrite rpred_div//; apply: (polyOverP rp).
have lr : (lead_coef p)^* = lead_coef p by apply: CrealP; apply: (polyOverP rp).
have l2 : 0 < `|lead_coef p| ^+ 2 by rewrite exprn_gt0// normr_gt0 gt_eqF.
have nG : `|G| ^+ 2 <= 0.
  have : `|lead_coef p| ^+ 2 * (`|D - N| ^+ 2 * (z + z^*)) <=
         `|lead_coef p| ^+ 2 * (sg * (`|D| ^+ 2 - `|N| ^+ 2)) by rewrite ler_pmul2l.
  rewrite mulrA -exprMn -normrM mulrBr -eP eN opprB addrC subrK.
  rewrite mulrCA mulrBr -!exprMn -!normrM -eP eN eG.
  rewrite (last_gap _ _ cr) -mulr2n normrMn exprMn_n mulrBr.
  move: (`|G| ^+ 2) (z + z^*) => G2 x; rewrite -[(2 ^ 2)%N]/(4%N).
  have -> : sg * (c * x * G2 *+ 2) = G2 *+ 4 * x.
    by rewrite mulrnAr -(mulrA c x) (mulrA sg c) (mulrC sg c) cE mulr_natl -mulrnA [x * G2]mulrC mulrnAl.
  by rewrite ler_addl oppr_ge0 pmulr_rle0// pmulrn_lle0.
have G0 : G = 0.
  have : `|G| ^+ 2 == 0 by rewrite eq_le nG exprn_ge0.
  by rewrite expf_eq0 normr_eq0 => /eqP.
have : root p z by rewrite /root eG G0 mulr0.
by move/hp; rewrite Re_lt0 => /lt_geF; rewrite z0.
Qed.
End Routh.

(* Rule "Routh": one step of the recursion, in both directions. *)
Theorem routh p n : real_poly p -> size p = n.+2 -> 0 < lead_coef p ->
  (hurwitz p <-> 0 < p`_n /\ hurwitz (routh_step p)).
Proof.
move=> rp sp lp; split=> [hp | [pn hq]].
  have pn : 0 < p`_n.
    have [rs [_ _ _ [e sg0]]] := routh_coef rp sp lp hp.
    by rewrite -(@pmulrn_lgt0 _ _ 2)// e mulr_gt0.
  by split=> //; apply: routh_necessary (lt0r_neq0 pn) lp hp.
have pn' : p`_n != 0 by rewrite gt_eqF.
apply: (routh_sufficient rp sp pn' _ hq).
by rewrite divr_gt0//; move: lp; rewrite lead_coefE sp.
Qed.

(* The recursion, as the checker runs it. *)
Fixpoint is_hurwitz (F : numFieldType) k (p : {poly F}) := if k is k'.+1 then
  (size p <= 1)%N || (0 < p`_(size p).-2) && is_hurwitz k' (routh_step p) else true.

Lemma no_root_const p (P : C -> Prop) : p != 0 -> (size p <= 1)%N -> forall z, root p z -> P z.
Proof.
move=> p0 sp z; rewrite [p]size1_polyC// rootC => /eqP c0.
by move: p0; rewrite [p]size1_polyC// c0 polyC0 eqxx.
Qed.

Theorem is_hurwitzP k p : real_poly p -> 0 < lead_coef p -> (size p <= k.+1)%N ->
  reflect (hurwitz p) (is_hurwitz k p).
Proof.
elim: k p => [|k IH] p rp lp sp; have p0 : p != 0 by rewrite -lead_coef_eq0 gt_eqF.
  by apply: ReflectT; apply: no_root_const.
rewrite /=; case: leqP => [s1|s1]; first by apply: ReflectT; apply: no_root_const.
pose n := (size p).-2; have sn : size p = n.+2 by rewrite /n; case: (size p) s1 => [|[|]].
apply: (iffP andP) => [[pn hk] | hp].
  apply/(routh rp sn lp); rewrite sn /= in pn; split=> //.
  have [s2 l2] := routh_size sn (lt0r_neq0 pn); apply/IH: hk.
  - exact: routh_real.
  - by rewrite lead_coefE s2 /= l2.
  - by rewrite s2 -ltnS -sn.
have [pn hq] := (routh rp sn lp).1 hp; rewrite sn /=; split=> //.
have [s2 l2] := routh_size sn (lt0r_neq0 pn); apply/IH => //.
- exact: routh_real.
- by rewrite lead_coefE s2 /= l2.
- by rewrite s2 -ltnS -sn.
Qed.

Section SchurCohn.

(* The next polynomial: (p - (p_0 / p_d) r) / x, r having the coefficients of p in reverse. *)
Definition schur_step (F : fieldType) (p : {poly F}) : {poly F} := let d := (size p).-1 in
  \poly_(i < d) (p`_i.+1 - p`_0 / p`_d * p`_(d - i.+1)).

(* z^d p(1/z), the value of r at z. *)
Let rev p z := z ^+ (size p).-1 * p.[z^-1].

Lemma rev_sum p z : z != 0 -> rev p z = \sum_(i < size p) p`_((size p).-1 - i) * z ^+ i.
Proof.
move=> z0; rewrite /rev horner_coef mulr_sumr (reindex_inj rev_ord_inj) /=; apply: eq_bigr => i _.
have il : (i <= (size p).-1)%N by rewrite -ltnS (leq_trans (ltn_ord i))// leqSpred.
have -> : (size p - i.+1 = (size p).-1 - i)%N by rewrite subnS predn_sub.
rewrite mulrCA; congr (_ * _); rewrite exprVn -{1}(subnK il) exprD mulrAC mulfV ?mul1r//.
by rewrite expf_neq0.
Qed.

Variables (p : {poly C}) (d : nat).
Hypotheses (rp : real_poly p) (sp : size p = d.+2).
Let k := p`_0 / p`_d.+1.
Let q := schur_step p.

Let pd0 : p`_d.+1 != 0.
Proof.
have : lead_coef p != 0 by rewrite lead_coef_eq0 -size_poly_eq0 sp.
by rewrite lead_coefE sp.
Qed.

Lemma schur_horner z : z != 0 -> z * q.[z] = p.[z] - k * rev p z.
Proof.
move=> z0; rewrite (rev_sum _ z0) (horner_coef p) mulr_sumr -sumrB sp big_ord_recl /=.
rewrite subn0 expr0 !mulr1 {1}/k divfK// subrr add0r /q /schur_step sp /= horner_poly mulr_sumr.
apply: eq_bigr => i _; rewrite /bump /= add1n mulrA -mulrBl exprS.
by rewrite mulrCA.
Qed.

Lemma schur_size : `|k| < 1 -> size q = d.+1.
Proof.
move=> k1; apply/eqP; rewrite eqn_leq; apply/andP; split.
  by rewrite /q /schur_step sp size_poly.
rewrite ltnNge; apply/negP => /leq_sizeP/(_ d (leqnn d)).
rewrite /q /schur_step sp coef_poly /= ltnSn subnn -/k => /eqP.
have -> : p`_0 = k * p`_d.+1 by rewrite divfK.
rewrite mulrA -{1}[p`_d.+1]mul1r -mulrBl mulf_eq0 (negPf pd0) orbF subr_eq0 => /eqP k2.
have : `|k| * `|k| < 1 by rewrite mulr_ilt1.
by rewrite -normrM -k2 normr1 ltxx.
Qed.

Lemma schur_real : real_poly q.
Proof.
apply/polyOverP=> i; rewrite coef_poly; case: ifP => _; rewrite ?rpred0//.
have r j : p`_j \is Num.real by apply: (polyOverP rp).
by rewrite rpredB// rpredM// rpred_div.
Qed.

Lemma schur_rev z : z != 0 -> `|k| < 1 -> rev q z = rev p z - k * p.[z].
Proof.
move=> z0 k1; rewrite {1}/rev (schur_size k1) /=.
have := schur_horner (invr_neq0 z0); rewrite {1}/rev invrK sp /= => e.
have -> : q.[z^-1] = z * (z^-1 * q.[z^-1]) by rewrite mulrA mulfV ?mul1r.
rewrite e mulrA -exprSr mulrBr /rev sp; congr (_ - _).
by rewrite mulrCA [z ^+ d.+1 * _]mulrA exprVn mulfV ?mul1r// expf_neq0.
Qed.

Lemma schur_bound f z : real_poly f -> schur f -> 1 <= `|z| -> `|rev f z| <= `|f.[z]|.
Proof.
move=> rf hf z1; have [rs e] := roots_of f.
have [f0|nf] := eqVneq f 0; first by rewrite /rev f0 !horner0 mulr0.
have z0 : z != 0 by rewrite -normr_gt0 (lt_le_trans ltr01).
have srs : (size f).-1 = size rs.
  by rewrite e size_scale ?lead_coef_eq0// size_prod_XsubC.
have -> : rev f z = lead_coef f * \prod_(r <- rs) (1 - r * z).
  rewrite /rev srs (horner_roots _ e) mulrCA; congr (_ * _).
  elim: (rs) => [|r t IH]; first by rewrite !big_nil mulr1.
  by rewrite !big_cons -IH /= exprS mulrACA mulrBr mulfV// [z * r]mulrC.
rewrite (horner_roots_conj _ rf e) !normrM ler_wpmul2l// !normr_prod.
rewrite big_seq [X in _ <= X]big_seq; apply: ler_prod => r rrs; rewrite normr_ge0 /=.
rewrite -(@ler_pexpn2r _ 2) ?nnegrE// -subr_ge0 !sqr_norm !rmorphB rmorphM rmorph1 conjCK.
have -> : (z - r^*) * (z^* - r) = (z^* - r) * (z - r^*) by rewrite mulrC.
rewrite (id_disc z z^* r r^*) -!sqr_norm mulr_ge0// subr_ge0.
  by rewrite exprn_ege1.
by rewrite exprn_ile1// ltW//; apply: hf; apply: root_in rrs.
Qed.

Lemma schur_sufficient : `|k| < 1 -> schur q -> schur p.
Proof.
move=> k1 hq z rz; rewrite real_ltNge ?normr_real ?real1//; apply/negP => z1.
have z0 : z != 0 by rewrite -normr_gt0 (lt_le_trans ltr01).
have nq : q.[z] != 0 by apply: contraL z1 => /hq /lt_geF->.
have b := schur_bound schur_real hq z1.
have e1 := schur_rev z0 k1; have e2 := schur_horner z0.
rewrite (rootP rz) mulr0 subr0 in e1; rewrite (rootP rz) sub0r -e1 in e2.
have : `|z| * `|q.[z]| <= `|k| * `|q.[z]|.
  by rewrite -normrM e2 normrN normrM ler_wpmul2l.
rewrite ler_pmul2r ?normr_gt0// => zk.
by have := le_lt_trans (le_trans z1 zk) k1; rewrite ltxx.
Qed.

Lemma schur_necessary : schur p -> `|k| < 1 /\ schur q.
Proof.
move=> hp; have [rs e] := roots_of p.
have srs : size rs = d.+1.
  have lp : lead_coef p != 0 by rewrite lead_coef_eq0 -size_poly_eq0 sp.
  by have := congr1 (fun f : {poly C} => size f) e; rewrite size_scale// size_prod_XsubC sp => -[].
have k1 : `|k| < 1.
  have -> : k = \prod_(r <- rs) - r.
    have := horner_roots 0 e; rewrite horner_coef0 /k => ->.
    rewrite lead_coefE sp mulrAC mulfV// mul1r; apply: eq_bigr => r _; exact: sub0r.
  have h r : r \in rs -> `|r| < 1 by move/(root_in e)/hp.
  case: (rs) srs h => // r t _ h; rewrite big_cons normrM normrN normr_prod.
  apply: (@le_lt_trans _ _ (`|r| * 1)); last by rewrite mulr1 h// mem_head.
  rewrite ler_wpmul2l// big_seq; apply: (@le_trans _ _ (\prod_(i <- t | i \in t) 1)).
    by apply: ler_prod => x xt; rewrite normr_ge0 normrN ltW// h// in_cons xt orbT.
  by rewrite big1.
split=> // z rz; rewrite real_ltNge ?normr_real ?real1//; apply/negP => z1.
have z0 : z != 0 by rewrite -normr_gt0 (lt_le_trans ltr01).
have np : p.[z] != 0 by apply: contraL z1 => /hp /lt_geF->.
have := schur_horner z0; rewrite (rootP rz) mulr0 => /esym/eqP; rewrite subr_eq0 => /eqP e1.
have : `|p.[z]| <= `|k| * `|p.[z]| by rewrite {1}e1 normrM ler_wpmul2l// schur_bound.
by rewrite -{1}[`|p.[z]|]mul1r ler_pmul2r ?normr_gt0// => /le_lt_trans/(_ k1); rewrite ltxx.
Qed.
End SchurCohn.

(* Rule "Schur-Cohn": one step of the recursion, in both directions. *)
Theorem schur_cohn p d : real_poly p -> size p = d.+2 ->
  (schur p <-> `|p`_0| < `|p`_d.+1| /\ schur (schur_step p)).
Proof.
move=> rp sp; have lp : 0 < `|p`_d.+1|.
  by rewrite normr_gt0; have := size_poly_eq0 p; rewrite sp -lead_coef_eq0 lead_coefE sp => <-.
have e : (`|p`_0 / p`_d.+1| < 1) = (`|p`_0| < `|p`_d.+1|).
  by rewrite normrM normfV ltr_pdivr_mulr// mul1r.
split=> [/(schur_necessary rp sp)|]; rewrite -e; first by [].
by case=> k1; apply: (schur_sufficient rp sp k1).
Qed.

Fixpoint is_schur (F : numFieldType) k (p : {poly F}) := if k is k'.+1 then
  (size p <= 1)%N || (`|p`_0| < `|p`_(size p).-1|) && is_schur k' (schur_step p) else true.

Theorem is_schurP k p : real_poly p -> p != 0 -> (size p <= k.+1)%N ->
  reflect (schur p) (is_schur k p).
Proof.
elim: k p => [|k IH] p rp p0 sp; first by apply: ReflectT; apply: no_root_const.
rewrite /=; case: leqP => [s1|s1]; first by apply: ReflectT; apply: no_root_const.
pose n := (size p).-2; have sn : size p = n.+2 by rewrite /n; case: (size p) s1 => [|[|]].
have lp : 0 < `|p`_n.+1|.
  by rewrite normr_gt0; have := size_poly_eq0 p; rewrite sn -lead_coef_eq0 lead_coefE sn => <-.
have small : `|p`_0| < `|p`_n.+1| -> size (schur_step p) = n.+1.
  by move=> h; apply: schur_size => //; rewrite normrM normfV ltr_pdivr_mulr// mul1r.
have key : `|p`_0| < `|p`_n.+1| -> reflect (schur (schur_step p)) (is_schur k (schur_step p)).
  move=> h; apply: IH; rewrite ?(small h)//; first exact: schur_real.
    by rewrite -size_poly_eq0 (small h).
  by rewrite -ltnS -sn.
rewrite sn /=; apply: (iffP andP) => [[h hk] | hp].
  by apply/(schur_cohn rp sn); split=> //; apply/(key h).
by have [h hq] := (schur_cohn rp sn).1 hp; split=> //; apply/(key h).
Qed.
End Closed.
