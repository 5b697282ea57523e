(* checker/core/roots.py, is_schur: s -> (1 + s)/(1 - s) maps the left half-plane onto the unit disc.
   With is_hurwitzP of location.v for the transformed polynomial, or its opposite. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Coq Require Import Ring.
From mcexact Require Import location.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Abstract.
Variables (T : Type) (o i : T) (add mul sub : T -> T -> T) (opp : T -> T).
Hypothesis rt : ring_theory o i add mul sub opp eq.
Add Ring mobius_ring : rt.
Lemma abs_mobius (s t : T) : add (mul (add i s) (add i t)) (opp (mul (add i (opp s)) (add i (opp t)))) =
  add (add s t) (add s t).
Proof. ring. Qed.
End Abstract.

Section Mobius.
Variable C : numClosedFieldType.
Implicit Types (p : {poly C}) (z s : C).

(* Sum p_k (1 + s)^k (1 - s)^(d - k) *)
Definition transformed p : {poly C} :=
  \sum_(k < size p) p`_k *: ((1 + 'X) ^+ k * (1 - 'X) ^+ ((size p).-1 - k)).

Lemma transformedE p s : (transformed p).[s] =
  \sum_(k < size p) p`_k * ((1 + s) ^+ k * (1 - s) ^+ ((size p).-1 - k)).
Proof.
rewrite /transformed horner_sum; apply: eq_bigr => k _.
by rewrite hornerZ hornerM !horner_exp !hornerE.
Qed.

Lemma transformed_value p s : s != 1 ->
  (transformed p).[s] = (1 - s) ^+ (size p).-1 * p.[(1 + s) / (1 - s)].
Proof.
move=> s1; have n0 : 1 - s != 0 by rewrite subr_eq0 eq_sym.
rewrite transformedE horner_coef mulr_sumr; apply: eq_bigr => k _.
have kd : (k <= (size p).-1)%N by rewrite -ltnS (leq_trans (ltn_ord k))// leqSpred.
rewrite [RHS]mulrCA; congr (_ * _); rewrite expr_div_n [RHS]mulrCA; congr (_ * _).
by rewrite -{2}(subnK kd) exprD mulfK// expf_neq0.
Qed.

Lemma transformed_at_1 p : p != 0 -> (transformed p).[1] != 0.
Proof.
move=> p0; rewrite transformedE subrr; have lt : ((size p).-1 < size p)%N by rewrite prednK// size_poly_gt0.
rewrite (bigD1 (Ordinal lt))//= subnn expr0 mulr1 big1 ?addr0 => [|k].
  by rewrite mulf_neq0 -?lead_coefE ?lead_coef_eq0// expf_neq0// -[1 + 1]/(2%:R) pnatr_eq0.
rewrite -val_eqE /= => kd; rewrite -[((size p).-1 - k)%N]prednK ?exprS ?mul0r ?mulr0//.
by rewrite subn_gt0 ltn_neqAle kd -ltnS (leq_trans (ltn_ord k))// leqSpred.
Qed.

Lemma disc_plane s : (`|1 + s| < `|1 - s|) = (s + s^* < 0).
Proof.
rewrite -(@ltr_pexpn2r _ 2) ?nnegrE// -subr_lt0 !sqr_norm rmorphD rmorphB rmorph1.
by rewrite (abs_mobius (ring_of_R C)) -mulr2n pmulrn_llt0.
Qed.

(* Rule "Schur": p is Schur iff p(-1) is not 0 and the transformed polynomial is Hurwitz. *)
Theorem schur_mobius p : p != 0 -> (schur p <-> p.[-1] != 0 /\ hurwitz (transformed p)).
Proof.
move=> p0; split=> [hp | [n1 hP] z rz].
  split; first by apply/negP => /hp; rewrite normrN1 ltxx.
  move=> s rs; rewrite Re_lt0 -disc_plane.
  have s1 : s != 1 by apply: contraTneq rs => ->; apply: transformed_at_1.
  have n0 : 1 - s != 0 by rewrite subr_eq0 eq_sym.
  have : root p ((1 + s) / (1 - s)).
    by move: rs; rewrite /root transformed_value// mulf_eq0 expf_eq0 (negPf n0) andbF.
  by move/hp; rewrite normrM normfV ltr_pdivr_mulr ?normr_gt0// mul1r.
have z1 : z + 1 != 0.
  by apply: contra n1; rewrite addr_eq0 => /eqP e; rewrite -e.
have n2 : (2%:R : C) != 0 by rewrite pnatr_eq0.
pose s := (z - 1) / (z + 1).
have e1 : (1 - s) * (z + 1) = 2%:R.
  by rewrite mulrBl mul1r divfK// opprB addrC addrA subrK.
have e2 : 1 + s = z * (1 - s).
  by apply: (mulIf z1); rewrite -mulrA e1 mulrDl mul1r divfK// addrACA subrr addr0 mulr_natr.
have n0 : 1 - s != 0 by apply: contraNneq n2 => e0; rewrite -e1 e0 mul0r.
have s1 : s != 1 by rewrite eq_sym -subr_eq0.
have : root (transformed p) s by rewrite /root transformed_value// e2 mulfK// (rootP rz) mulr0.
by move/hP; rewrite Re_lt0 -disc_plane e2 normrM -{2}[`|1 - s|]mul1r ltr_pmul2r ?normr_gt0.
Qed.
End Mobius.
