(* checker/boxes.py, segments_of: discs on the segments of the upper half of the border of a region, which contain it. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Coq Require Import Ring.
From mcexact Require Import location.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Identities, by the ring tactic over an arbitrary commutative ring structure. *)
Section Abstract.
Variables (T : Type) (o i : T) (add mul sub : T -> T -> T) (opp : T -> T).
Hypothesis rt : ring_theory o i add mul sub opp eq.
Add Ring arcs_ring : rt.
Local Notation "x + y" := (add x y). Local Notation "x * y" := (mul x y).
Local Notation "x - y" := (add x (opp y)). Local Notation "- x" := (opp x).

Lemma abs_polar (p p' w w' : T) : (p - w) * (p' - w') - (p + w) * (p' + w') =
  - ((p * w' + w * p') + (p * w' + w * p')).
Proof. ring. Qed.
Lemma abs_chord (a a' c c' j s t : T) : a = i - j * t -> a' = i + j * t -> c = i - j * s -> c' = i + j * s ->
  a' * c - c' * a = (i + i) * (j * (t - s)).
Proof. move=> -> -> -> ->; ring. Qed.
Lemma abs_quotient (x y a a' c d A B : T) : x * (A * (a' * c)) * (y * (B * (a * d))) =
  A * B * (a * a') * (x * y * (c * d)).
Proof. ring. Qed.
Lemma abs_product (r two j s t u : T) : r * (two * (j * (t - s))) * (r * (two * (- j * (t - u)))) =
  j * j * (r * r * (two * two) * ((t - s) * (u - t))).
Proof. ring. Qed.
Lemma abs_product' (r two j s t : T) : r * (two * (j * (t - s))) * (r * two) =
  j * (r * r * (two * two) * (t - s)).
Proof. ring. Qed.
End Abstract.

Section Arcs.
Variable C : numClosedFieldType.
Implicit Types (p w z r b s t u : C) (ps : seq C).

(* The point of the circle whose half angle has the tangent t. *)
Definition circle r t : C := r * ((1 + 'i * t) / (1 - 'i * t)).

Lemma conj_side t : t \is Num.real -> (1 - 'i * t)^* = 1 + 'i * t.
Proof. by move=> rt; rewrite rmorphB rmorphM rmorph1 /= conjCi (CrealP rt) mulNr opprK. Qed.
Lemma conj_side' t : t \is Num.real -> (1 + 'i * t)^* = 1 - 'i * t.
Proof. by move=> rt; rewrite rmorphD rmorphM rmorph1 /= conjCi (CrealP rt) mulNr. Qed.

Lemma side_neq0 t : t \is Num.real -> 1 - 'i * t != 0.
Proof.
move=> rt; apply/eqP => e; have := congr1 (fun x : C => 'Re x) e.
rewrite raddfB /= (Creal_ReP _ (rpred1 _)) raddf0 ReMr ?rt// Re_i mul0r subr0 => /eqP.
by rewrite oner_eq0.
Qed.

(* The coordinates, as the checker computes them. *)
Theorem circle_point r t : t \is Num.real ->
  circle r t = r * ((1 - t ^+ 2) / (1 + t ^+ 2)) + 'i * (r * (t *+ 2 / (1 + t ^+ 2))).
Proof.
move=> rt; have n1 := side_neq0 rt; have n2 : 1 + 'i * t != 0 by rewrite -conj_side// conjC_eq0.
have e : (1 - 'i * t) * (1 + 'i * t) = 1 + t ^+ 2.
  by rewrite -subr_sqr expr1n exprMn sqrCi mulN1r opprK.
have n : 1 + t ^+ 2 != 0 by rewrite -e mulf_neq0.
rewrite [X in _ + X]mulrCA -mulrDr /circle; congr (r * _); rewrite mulrA -mulrDl; apply: (mulIf n).
rewrite divfK// -{1}e mulrA divfK// -expr2 sqrrD expr1n mul1r exprMn sqrCi mulN1r addrAC.
by rewrite mulrnAr.
Qed.

Lemma right_angle p w : 'Re (p * w^*) <= 0 -> `|p + w| <= `|p - w|.
Proof.
move=> le; rewrite -(@ler_pexpn2r _ 2) ?nnegrE// -subr_ge0 !sqr_norm rmorphB rmorphD.
rewrite (abs_polar (ring_of_R C)) oppr_ge0.
have -> : p * w^* + w * p^* = 'Re (p * w^*) *+ 2.
  by rewrite ReE rmorphM conjCK [_ * w]mulrC -[_ / _ *+ 2]mulr_natr divfK ?pnatr_eq0.
by rewrite -mulr2n !mulrn_wle0.
Qed.

(* How a point of the circle sees the chord between two others. *)
Lemma seen r s t (a := 1 - 'i * t) (c := 1 - 'i * s) : s \is Num.real -> t \is Num.real ->
  circle r t - circle r s = r * (2%:R * ('i * (t - s))) / (a * c).
Proof.
move=> rs rt; have [na nc] := (side_neq0 rt, side_neq0 rs).
rewrite /circle -mulrBr -mulrA; congr (r * _); apply: (mulIf (mulf_neq0 na nc)).
rewrite divfK ?mulf_neq0// mulrBl mulrA divfK// [a * c]mulrC [_ / c * _]mulrA divfK//.
exact: (abs_chord (ring_of_R C)).
Qed.

Lemma conj_quotient (x y a c d : C) :
  x / (a * c) * (y / (a * d))^* = (`|a * c| ^- 2 * `|a * d| ^- 2 * `|a| ^+ 2) * (x * y^* * (c^* * d)).
Proof.
have inv z : (z^-1)^* = `|z| ^- 2 * z.
  have rn : `|z| ^- 2 \is Num.real by rewrite rpredV rpredX ?normr_real.
  by rewrite invC_norm rmorphM /= conjCK (CrealP rn).
rewrite [(y / _)^*]rmorphM /= inv [(a * c)^-1]invC_norm (rmorphM _ a c) /=.
rewrite [`|a| ^+ 2]sqr_norm; set A := `|a * c| ^- 2; set B := `|a * d| ^- 2; clearbody A B.
by move: (a^*) (c^*) (y^*) => a' c' y'; rewrite (abs_quotient (ring_of_R C)).
Qed.

Lemma Re_sides s u : s \is Num.real -> u \is Num.real -> 'Re ((1 - 'i * s)^* * (1 - 'i * u)) = 1 + s * u.
Proof.
move=> rs ru; rewrite conj_side// mulrDl mul1r mulrBr mulr1.
rewrite mulrACA -expr2 sqrCi mulN1r opprK ['i * s + _]addrC addrACA [- _ + _]addrC -mulrBr raddfD /=.
have r1 : 1 + s * u \is Num.real by rewrite rpredD ?rpredM ?rpred1.
by rewrite (Creal_ReP _ r1) ReMr ?rpredB// Re_i mul0r addr0.
Qed.

(* The disc whose diameter is a chord contains the arc between its ends. *)
Theorem arc_in_disc r s t u : r \is Num.real -> 0 <= s -> s <= t -> t <= u ->
  `|circle r t - (circle r s + circle r u) / 2%:R| <= `|circle r u - circle r s| / 2%:R.
Proof.
move=> rr s0 st tu; have t0 := le_trans s0 st; have u0 := le_trans t0 tu.
have [rs rt ru] := And3 (ger0_real s0) (ger0_real t0) (ger0_real u0).
set p := circle r t - circle r s; set w := circle r t - circle r u.
have n2 : (2%:R : C) != 0 by rewrite pnatr_eq0.
have -> : circle r t - (circle r s + circle r u) / 2%:R = (p + w) / 2%:R.
  by rewrite /p /w addrACA -opprD mulrBl -mulr2n -[circle r t *+ 2]mulr_natr mulfK.
have -> : circle r u - circle r s = p - w by rewrite /p /w opprB [RHS]addrC [RHS]addrA subrK.
rewrite normrM normfV normr_nat ler_pmul2r ?invr_gt0 ?ltr0n//; apply: right_angle.
rewrite /p /w !seen//; set a := 1 - 'i * t; set c := 1 - 'i * s; set d := 1 - 'i * u.
have [na nc nd] : [/\ a != 0, c != 0 & d != 0] by rewrite !side_neq0.
rewrite conj_quotient; have -> : r * (2%:R * ('i * (t - s))) * (r * (2%:R * ('i * (t - u))))^* =
    - (r ^+ 2 * 4%:R * ((t - s) * (u - t))).
  rewrite !rmorphM rmorphB conjCi (CrealP rr) (CrealP rt) (CrealP ru) rmorph_nat.
  by rewrite (abs_product (ring_of_R C)) -!expr2 sqrCi mulN1r -natrX.
pose k := `|a * c| ^- 2 / `|a * d| ^+ 2 * `|a| ^+ 2 * (r ^+ 2 * 4%:R * ((t - s) * (u - t))).
have k0 : 0 <= k.
  have r2 : 0 <= r ^+ 2 by rewrite -real_normK// exprn_ge0.
  by rewrite /k; move: (r ^+ 2) r2 => q q0; rewrite !mulr_ge0 ?invr_ge0 ?ler0n ?subr_ge0 ?exprn_ge0.
rewrite mulNr mulrN raddfN /= oppr_le0 [_ * (_ * (c^* * d))]mulrA -/k (ReMl (ger0_real k0)) /= mulr_ge0//.
by rewrite Re_sides// addr_ge0 ?ler01 ?mulr_ge0.
Qed.

(* The last arc, from t to -r, for t without limit. *)
Theorem last_arc_in_disc r s t : r \is Num.real -> 0 <= s -> s <= t ->
  `|circle r t - (circle r s - r) / 2%:R| <= `|r + circle r s| / 2%:R.
Proof.
move=> rr s0 st; have t0 := le_trans s0 st; have [rs rt] := (ger0_real s0, ger0_real t0).
set p := circle r t - circle r s; set w := circle r t + r.
have n2 : (2%:R : C) != 0 by rewrite pnatr_eq0.
have -> : circle r t - (circle r s - r) / 2%:R = (p + w) / 2%:R.
  by rewrite /p /w addrACA [- _ + r]addrC -(opprB (circle r s) r) [RHS]mulrBl -mulr2n -[circle r t *+ 2]mulr_natr mulfK.
have -> : r + circle r s = - (p - w).
  by rewrite [RHS]opprB /p /w opprB [RHS]addrC [RHS]addrA subrK addrC.
rewrite normrN normrM normfV normr_nat ler_pmul2r ?invr_gt0 ?ltr0n//; apply: right_angle.
set a := 1 - 'i * t; set c := 1 - 'i * s.
have [na nc] : a != 0 /\ c != 0 by rewrite !side_neq0.
have -> : w = r * 2%:R / (a * 1).
  rewrite /w /circle -/a mulr1 -[X in _ + X]mulr1 -mulrDr -mulrA; congr (r * _); apply: (mulIf na).
  by rewrite [LHS]mulrDl !divfK// mul1r /a addrACA subrr addr0 -mulr2n.
rewrite /p seen// -/a -/c conj_quotient mulr1.
have -> : r * (2%:R * ('i * (t - s))) * (r * 2%:R)^* = 'i * (r ^+ 2 * 4%:R * (t - s)).
  by rewrite rmorphM (CrealP rr) rmorph_nat (abs_product' (ring_of_R C)) -!expr2 -natrX.
pose k := `|a * c| ^- 2 / `|a| ^+ 2 * `|a| ^+ 2 * (r ^+ 2 * 4%:R * (t - s)).
have k0 : 0 <= k.
  have r2 : 0 <= r ^+ 2 by rewrite -real_normK// exprn_ge0.
  by rewrite /k; move: (r ^+ 2) r2 => q q0; rewrite !mulr_ge0 ?invr_ge0 ?ler0n ?subr_ge0 ?exprn_ge0.
rewrite mulr1 -['i * _ * _]mulrA ['i * _]mulrC -[_ * c^* * 'i]mulrA [X in 'Re X]mulrA -/k.
rewrite (ReMl (ger0_real k0)) /= conj_side// mulrDl mul1r ['i * s * 'i]mulrAC -expr2 sqrCi mulN1r.
by rewrite raddfB /= Re_i sub0r (Creal_ReP _ rs) mulrN oppr_le0 mulr_ge0.
Qed.

(* The upper half of the circle: r, the points with t above 0, and -r. *)
Lemma on_circle r z : 0 < r -> `|z| = r -> 0 <= 'Im z -> z = - r \/ exists2 t, 0 <= t & z = circle r t.
Proof.
move=> r0 zr im; have [e|ne] := eqVneq z (- r); first by left.
right; have rr := gtr0_real r0; have rz := Creal_Re z.
have rim := Creal_Im z; pose x := r + 'Re z.
have x0 : 0 <= x.
  rewrite /x -ler_subl_addl sub0r; have [h _] := leif_normC_Re_Creal z.
  by move: h; rewrite zr real_ler_norml// => /andP[].
have nx : x != 0.
  apply: contra ne => /eqP e; have ez : 'Re z = - r by apply/eqP; rewrite -addr_eq0 addrC -/x e.
  have := normC2_Re_Im z; rewrite zr ez sqrrN -[LHS]addr0 => /addrI/esym/eqP.
  by rewrite expf_eq0 /= => /eqP e'; rewrite [z]Crect ez e' mulr0 addr0.
exists ('Im z / x); first by rewrite divr_ge0.
have rt : 'Im z / x \is Num.real by rewrite rpred_div// rpredD.
have sum : x + 'i * 'Im z = r + z by rewrite {2}[z]Crect addrA.
have dif : x - 'i * 'Im z = r + z^*.
  by rewrite -[LHS]conjCK rmorphB rmorphM conjCi (CrealP rim) mulNr opprK (CrealP (ger0_real x0)) sum rmorphD (CrealP rr).
have e1 : (1 + 'i * ('Im z / x)) * x = r + z by rewrite mulrDl mul1r mulrA divfK.
have e2 : (1 - 'i * ('Im z / x)) * x = r + z^* by rewrite mulrBl mul1r mulrA divfK.
have n2 : 1 - 'i * ('Im z / x) != 0 by exact: side_neq0.
have e3 : circle r ('Im z / x) * ((1 - 'i * ('Im z / x)) * x) = r * (r + z).
  by rewrite /circle -mulrA; congr (r * _); rewrite mulrA divfK.
apply: (mulIf (mulf_neq0 n2 nx)); rewrite e3 e2 !mulrDr -sqr_norm zr -expr2 addrC.
by rewrite [r * z]mulrC.
Qed.

(* Rule "arcs": what holds on the discs of the arcs between rising points, and of the last one, holds on the upper half. *)
Variable P : C -> Prop.
Fixpoint arcs r s ps : Prop := if ps is u :: ps' then
    (forall z, `|z - (circle r s + circle r u) / 2%:R| <= `|circle r u - circle r s| / 2%:R -> P z) /\ arcs r u ps'
  else forall z, `|z - (circle r s - r) / 2%:R| <= `|r + circle r s| / 2%:R -> P z.

Theorem upper_half ps r z : 0 < r -> path <%R 0 ps -> arcs r 0 ps -> `|z| = r -> 0 <= 'Im z -> P z.
Proof.
move=> r0 up on zr im; have rr := gtr0_real r0.
have minus s : 0 <= s -> path <%R s ps -> arcs r s ps -> P (- r).
  elim: ps s {up on} => [|u ps IH] s s0 /=; last by move=> /andP[su up] [_ on]; apply: (IH u) => //; apply: le_trans (ltW su).
  move=> _; apply; rewrite -[X in `|X|]opprK normrN opprD !opprK.
  have -> : r + (circle r s - r) / 2%:R = (r + circle r s) / 2%:R.
    by rewrite mulrBl [RHS]mulrDl {1}(splitr r) addrCA addrK addrC.
  by rewrite normrM normfV normr_nat.
have [->|[t t0 ->]] := on_circle r0 zr im; first exact: (minus 0).
suff go s : 0 <= s -> s <= t -> arcs r s ps -> path <%R s ps -> P (circle r t) by apply: (go 0).
elim: ps s {up on minus} => [|u ps IH] s s0 st /=.
  by move=> last _; apply: last; apply: last_arc_in_disc.
move=> [first on] /andP[su up].
have [tu|ut] := real_leP (ger0_real (le_trans s0 st)) (ger0_real (le_trans s0 (ltW su))).
  by apply: first; apply: arc_in_disc.
by apply: (IH u) => //; rewrite ?(le_trans s0)// ltW.
Qed.

(* Rule "segments", continuous time: what holds on the discs of the segments, and beyond the last point. *)
Fixpoint segments b s ps : Prop := if ps is u :: ps' then
    (forall z, `|z - (- b + 'i * ((s + u) / 2%:R))| <= (u - s) / 2%:R -> P z) /\ segments b u ps'
  else forall z, 'Re z = - b -> s <= `|z| -> P z.

Theorem upper_line ps b z : b \is Num.real -> path <%R 0 ps -> segments b 0 ps ->
  'Re z = - b -> 0 <= 'Im z -> P z.
Proof.
move=> rb up on re im; have ez : z = - b + 'i * 'Im z by rewrite {1}[z]Crect re.
suff go s : s <= 'Im z -> segments b s ps -> path <%R s ps -> 0 <= s -> P z by apply: (go 0).
elim: ps s {up on} => [|u ps IH] s st /=.
  move=> last _ s0; apply: last => //; apply: le_trans st _; rewrite -(ger0_norm im).
  by rewrite -ler_sqr ?nnegrE// [X in _ <= X]normC2_Re_Im ger0_norm// ler_addr -real_normK ?exprn_ge0 ?Creal_Re.
move=> [first on] /andP[su up] s0; have u0 := le_trans s0 (ltW su).
have [tu|ut] := real_leP (Creal_Im z) (ger0_real u0); last by apply: (IH u) => //; apply: ltW.
apply: first; rewrite {1}ez opprD addrACA subrr add0r -mulrBr normrM normCi mul1r.
have rs := ger0_real s0; have ru := ger0_real u0.
rewrite real_ler_norml ?rpredB ?rpred_div ?rpredD ?Creal_Im ?realn ?real1//.
have e1 : (s + u) / 2%:R - (u - s) / 2%:R = s by rewrite -mulrBl opprB addrACA subrr addr0 -mulr2n -mulr_natr mulfK ?pnatr_eq0.
have e2 : (s + u) / 2%:R + (u - s) / 2%:R = u by rewrite -mulrDl [s + u]addrC addrACA subrr addr0 -mulr2n -mulr_natr mulfK ?pnatr_eq0.
by rewrite ler_subr_addr ler_subl_addr [- _ + _]addrC e1 st [_ / _ + _]addrC e2.
Qed.
End Arcs.
