(* checker/boxes.py: no member of a box has an eigenvalue on the border of the region, so all are stable, as the
   center is.  The signals behind the state are computed from it and from each other: what makes this possible for every
   member, regular at infinity, is that the last block is nonsingular. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex polyrcf.
From mcexact Require Import location crossing arcs.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Regions.
Variable C : numClosedFieldType.
Implicit Types z r : C.

Lemma apart_left z : [\/ 'Re z < 0, 'Re z = 0 |
  exists2 c : C, 0 < c & forall r, 'Re r < 0 -> c <= `|z - r|].
Proof.
have [l|g|e] := real_ltgtP (Creal_Re z) (real0 C); [by constructor 1| |by constructor 2].
constructor 3; exists ('Re z) => // r r0.
apply: (@le_trans _ _ `|'Re (z - r)|); last by case: (leif_normC_Re_Creal (z - r)).
by rewrite raddfB /= ger0_norm ?subr_ge0 ?ler_subr_addl ?ger_addr ?(ltW r0)// (le_trans (ltW r0))// ltW.
Qed.

Lemma apart_disc z : [\/ `|z| < 1, `|z| = 1 |
  exists2 c : C, 0 < c & forall r, `|r| < 1 -> c <= `|z - r|].
Proof.
have [l|g|e] := real_ltgtP (normr_real z) (real1 C); [by constructor 1| |by constructor 2].
constructor 3; exists (`|z| - 1); first by rewrite subr_gt0.
move=> r r1; rewrite ler_subl_addr (@le_trans _ _ (`|z - r| + `|r|))//; last by rewrite ler_add2l ltW.
by rewrite -{1}[z](subrK r) ler_norm_add.
Qed.

(* The eigenvalues of a real matrix come in conjugate pairs: the upper half of a border is enough. *)
Theorem conjugate_eigenvalue n (M : 'M[C]_n) z : (forall i j, M i j \is Num.real) ->
  eigenvalue M z -> eigenvalue M z^*.
Proof.
move=> rM; have e : map_poly conjC (char_poly M) = char_poly M.
  by rewrite map_char_poly; congr char_poly; apply/matrixP => i j; rewrite mxE /= (CrealP (rM i j)).
have rc : real_poly (char_poly M) by apply/polyOverP => i; rewrite CrealE -{2}e coef_map.
by rewrite !eigenvalue_root_char /root -conj_horner// => /eqP ->; rewrite rmorph0.
Qed.
End Regions.

Section Loop.
Variables n k : nat.

(* The matrix of the loop, where the last signals are computed from the others and from each other. *)
Definition loop_of (F : comUnitRingType) (Z : 'M[F]_(n + k)) : 'M[F]_n :=
  ulsubmx Z - ursubmx Z *m invmx (drsubmx Z) *m dlsubmx Z.

Theorem loop_eigenvalue (F : fieldType) (Z : 'M[F]_(n + k)) lambda : drsubmx Z \in unitmx ->
  (lambda *: block_mx 1%:M 0 0 0 - Z \in unitmx) = ~~ eigenvalue (loop_of Z) lambda.
Proof.
move=> uZ; pose S := invmx (drsubmx Z) *m dlsubmx Z.
have e : (lambda *: block_mx 1%:M 0 0 0 - Z) *m block_mx 1%:M 0 (- S) 1%:M =
    block_mx (lambda%:M - loop_of Z) (- ursubmx Z) 0 (- drsubmx Z).
  rewrite -{1}[Z]submxK scale_block_mx !scaler0 opp_block_mx add_block_mx mulmx_block.
  rewrite !mulmx1 !mulmx0 !add0r !mulmxN !mulNmx !opprK /S mulKVmx// addNr scalemx1 mulmxA.
  by congr (block_mx _ _ _ _); rewrite /loop_of opprB [RHS]addrA [RHS]addrAC.
have uL : block_mx 1%:M 0 (- S) 1%:M \in unitmx by rewrite unitmxE det_lblock !det1 mulr1 unitr1.
rewrite -[LHS]andbT -[in LHS]uL -unitmx_mul e unitmxE det_ublock unitrM -!unitmxE.
have opp (m : nat) (M : 'M[F]_m) : (- M \in unitmx) = (M \in unitmx).
  by rewrite !unitmxE -scaleN1r detZ unitrM unitrX ?unitrN1.
by rewrite opp uZ andbT /eigenvalue /eigenspace kermx_eq0 row_free_unit negbK -(opp n (lambda%:M - _)) opprB.
Qed.
End Loop.

Section Members.
Variable R : rcfType.
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Variables (n k : nat) (Z0 Z1 : 'M[R]_(n + k)).
Implicit Types (t a c : R) (z : C).

(* The systems on the line from Z0 to Z1. *)
Definition along t : 'M[R]_(n + k) := Z0 + t *: (Z1 - Z0).
Notation loop_at t := (map_mx inC (loop_of (along t))).

Let P : 'M[{poly R}]_(n + k) := map_mx polyC Z0 + 'X *: map_mx polyC (Z1 - Z0).
Let d : {poly R} := \det (drsubmx P).
Let N a c : 'M[{poly R}]_n := c%:P *: (d ^+ 2 *: (ulsubmx P + (a%:P)%:M) -
  d *: (ursubmx P *m \adj (drsubmx P) *m dlsubmx P)).
Let p a c : {poly {poly R}} := \poly_(i < n.+1) ((char_poly (N a c))`_i * (d ^+ 2) ^+ i).

Let evaluated t : map_mx (horner_eval t) P = along t.
Proof.
apply/matrixP => i j; rewrite /along /horner_eval !mxE !hornerE; congr (_ + _); exact: mulrC.
Qed.

Let d_at t : d.[t] = \det (drsubmx (along t)).
Proof. by rewrite -/(horner_eval t d) -det_map_mx map_drsubmx evaluated. Qed.

Let N_at a c t : drsubmx (along t) \in unitmx ->
  map_mx (horner_eval t) (N a c) = d.[t] ^+ 2 *: (c *: (loop_of (along t) + a%:M)).
Proof.
move=> u; have nz : d.[t] != 0 by rewrite d_at -unitfE -unitmxE.
rewrite /N map_mxZ raddfB /= !map_mxZ map_mxD !map_mxM map_mx_adj /= map_scalar_mx /=.
rewrite map_ulsubmx map_ursubmx map_dlsubmx map_drsubmx evaluated /horner_eval !hornerE.
rewrite [RHS]scalerA [_ * c]mulrC -[RHS]scalerA; congr (_ *: _).
rewrite /loop_of /invmx u -d_at -scalemxAr -scalemxAl addrAC scalerBr expr2; congr (_ - _).
by rewrite scalerA mulfK.
Qed.

Let root_p a c t z : drsubmx (along t) \in unitmx ->
  root (at_ t (p a c)) z = eigenvalue (map_mx inC (c *: (loop_of (along t) + a%:M))) z.
Proof.
move=> u; have nz : d.[t] != 0 by rewrite d_at -unitfE -unitmxE.
pose D : C := inC (d.[t] ^+ 2); have nD : D != 0 by rewrite fmorph_eq0 expf_neq0.
pose L := map_mx inC (c *: (loop_of (along t) + a%:M)).
have echar : at_ t (char_poly (N a c)) = char_poly (D *: L).
  by rewrite /at_ map_char_poly N_at// map_char_poly map_mxZ.
have -> : eigenvalue L z = eigenvalue (D *: L) (D * z).
  apply/eigenvalueP/eigenvalueP => -[v ev nv]; exists v => //.
    by rewrite -scalemxAr ev scalerA.
  by apply: (scalerI nD); rewrite scalemxAr ev scalerA.
rewrite eigenvalue_root_char -echar /root; congr (_ == _).
have sp (q : {poly {poly R}}) : (size q <= n.+1)%N -> forall x, (at_ t q).[x] = \sum_(i < n.+1) (at_ t q)`_i * x ^+ i.
  move=> sq x; apply: horner_coef_wide.
  by rewrite (leq_trans (size_poly _ _))// (leq_trans (size_poly _ _)).
rewrite !sp ?size_poly ?size_char_poly//; apply: eq_bigr => i _.
rewrite !coef_at coef_poly ltn_ord hornerM !horner_exp rmorphM rmorphX /= exprMn mulrA.
by [].
Qed.

(* A region that polynomials in t decide, and its border. *)
Variables inner border : C -> Prop.
Hypothesis apart : forall z, [\/ inner z, border z |
  exists2 c : C, 0 < c & forall r, inner r -> c <= `|z - r|].
Hypothesis decided : forall m (q : {poly {poly R}}), (size q <= m.+1)%N -> exists qs, forall t,
  0 < (q`_m).[t] -> (forall z, root (at_ t q) z -> inner z) <-> signs qs t.
Hypothesis finite : forall t, 0 <= t <= 1 -> drsubmx (along t) \in unitmx.

Lemma on_line a c (W := fun t => map_mx inC (c *: (loop_of (along t) + a%:M))) :
  (forall t z, 0 <= t <= 1 -> border z -> ~~ eigenvalue (W t) z) ->
  (forall z, eigenvalue (W 0) z -> inner z) -> forall z, eigenvalue (W 1) z -> inner z.
Proof.
move=> off start z; have [i0 i1] : (0 : R) <= 0 <= (1 : R) /\ (0 : R) <= 1 <= (1 : R) by rewrite !lexx ler01.
have sp : (size (p a c) <= n.+1)%N by exact: size_poly.
have lead t : 0 <= t <= 1 -> 0 < ((p a c)`_n).[t].
  move=> /finite u; have nz : d.[t] != 0 by rewrite d_at -unitfE -unitmxE.
  rewrite coef_poly ltnSn; have /monicP := char_poly_monic (N a c); rewrite lead_coefE size_char_poly /= => ->.
  by rewrite mul1r !horner_exp exprn_gt0// lt0r expf_neq0// sqr_ge0.
have [qs h] := decided sp.
rewrite -root_p ?finite//; apply: (no_crossing apart sp lead h) => [t y t01 by_|y]; rewrite root_p ?finite//.
  exact: off.
exact: start.
Qed.
End Members.

(* Any set of members that contains with each of them the line to it from the center. *)
Section Stable.
Variables (R : rcfType) (n k : nat) (Z : 'M[R]_(n + k)) (member : 'M[R]_(n + k) -> Prop).
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Notation up M := (map_mx inC M).

Hypothesis finite : forall Z', member Z' -> drsubmx Z' \in unitmx.
Notation regular lambda := (forall Z', member Z' -> lambda *: block_mx 1%:M 0 0 0 - up Z' \in unitmx).

Lemma loop_up Z' : member Z' -> map_mx inC (loop_of Z') = loop_of (up Z').
Proof.
move=> /finite u; rewrite /loop_of map_mxB !map_mxM map_invmx.
by rewrite map_ulsubmx map_ursubmx map_dlsubmx map_drsubmx.
Qed.

Lemma regular_not lambda Z' : regular lambda -> member Z' -> ~~ eigenvalue (up (loop_of Z')) lambda.
Proof.
move=> reg mem; rewrite loop_up// -loop_eigenvalue ?reg//.
by rewrite -map_drsubmx map_unitmx finite.
Qed.

Hypothesis connected : forall Z' t, member Z' -> 0 <= t <= 1 -> member (along Z Z' t).

Lemma moved_eigenvalue (M : 'M[R]_n) (a c : R) lambda : c != 0 ->
  eigenvalue (up (c *: (M + a%:M))) (inC c * (lambda + inC a)) = eigenvalue (up M) lambda.
Proof.
move=> c0; have nc : inC c != 0 :> C by rewrite fmorph_eq0.
rewrite map_mxZ map_mxD map_scalar_mx /=.
apply/eigenvalueP/eigenvalueP => -[v ev nv]; exists v => //.
  move: ev; rewrite -scalemxAr -scalerA => /(scalerI nc).
  by rewrite mulmxDr mul_mx_scalar scalerDl => /addIr.
by rewrite -scalemxAr mulmxDr mul_mx_scalar ev -scalerDl scalerA.
Qed.

Lemma loop_real (Z' : 'M[R]_(n + k)) i j : (up (loop_of Z')) i j \is Num.real.
Proof. by rewrite mxE inC_real. Qed.

(* Rule "border", continuous time: regular on the upper half of the border for all members, stable at the center. *)
Theorem members_continuous (b : R) :
  (forall lambda, eigenvalue (up (loop_of Z)) lambda -> 'Re lambda < - inC b) ->
  (forall lambda, 'Re lambda = - inC b -> 0 <= 'Im lambda -> regular lambda) ->
  forall Z', member Z' -> forall lambda, eigenvalue (up (loop_of Z')) lambda -> 'Re lambda < - inC b.
Proof.
move=> start reg Z' mem lambda ev.
have line t : 0 <= t <= 1 -> member (along Z Z' t) by exact: connected.
have one : (1 : R) != 0 by exact: oner_neq0.
have half (y : C) : ('Re y < - inC b) = ('Re (inC 1 * (y + inC b)) < 0).
  by rewrite rmorph1 mul1r raddfD /= (Creal_ReP _ (inC_real b)) -ltr_subr_addr sub0r.
have e0 : along Z Z' 0 = Z by rewrite /along scale0r addr0.
have e1 : along Z Z' 1 = Z' by rewrite /along scale1r addrC subrK.
rewrite half; apply: (@on_line R n k Z Z' (fun z => 'Re z < 0) (fun z => 'Re z = 0) (@apart_left C) _ _ b 1).
- by move=> m q; apply: hurwitz_signs.
- by move=> t /line; apply: finite.
- move=> t z t01 z0; have -> : z = inC 1 * (z - inC b + inC b) by rewrite subrK rmorph1 mul1r.
  rewrite moved_eigenvalue//; set y := z - inC b.
  have yb : 'Re y = - inC b by rewrite raddfB /= z0 (Creal_ReP _ (inC_real b)) sub0r.
  have [pos|neg] := real_leP (real0 C) (Creal_Im y).
    by apply: regular_not (line _ t01); apply: reg.
  apply/negP => /conjugate_eigenvalue -/(_ (loop_real _)); apply/negP.
  by apply: regular_not (line _ t01); apply: reg; rewrite ?Re_conj// Im_conj oppr_ge0 ltW.
- move=> z; have -> : z = inC 1 * (z - inC b + inC b) by rewrite subrK rmorph1 mul1r.
  by rewrite moved_eigenvalue// e0 -half => /start.
by rewrite e1 moved_eigenvalue.
Qed.

(* Discrete time. *)
Theorem members_discrete (r : R) : 0 < r ->
  (forall lambda, eigenvalue (up (loop_of Z)) lambda -> `|lambda| < inC r) ->
  (forall lambda, `|lambda| = inC r -> 0 <= 'Im lambda -> regular lambda) ->
  forall Z', member Z' -> forall lambda, eigenvalue (up (loop_of Z')) lambda -> `|lambda| < inC r.
Proof.
move=> r0 start reg Z' mem lambda ev.
have line t : 0 <= t <= 1 -> member (along Z Z' t) by exact: connected.
have nz : r^-1 != 0 by rewrite invr_eq0 gt_eqF.
have cr : 0 < inC r :> C by rewrite -(rmorph0 inC) inC_lt.
have ncr : inC r != 0 :> C by rewrite gt_eqF.
have back (y : C) : y = inC r^-1 * (inC r * y + inC 0) by rewrite rmorph0 addr0 fmorphV mulKf.
have disc (y : C) : (`|y| < inC r) = (`|inC r^-1 * (y + inC 0)| < 1).
  by rewrite rmorph0 addr0 fmorphV normrM normfV (gtr0_norm cr) mulrC ltr_pdivr_mulr// mul1r.
have e0 : along Z Z' 0 = Z by rewrite /along scale0r addr0.
have e1 : along Z Z' 1 = Z' by rewrite /along scale1r addrC subrK.
rewrite disc; apply: (@on_line R n k Z Z' (fun z => `|z| < 1) (fun z => `|z| = 1) (@apart_disc C) _ _ 0 r^-1).
- move=> m q sq; have [qs h] := schur_signs sq; exists qs => t pos; apply: h; exact: lt0r_neq0.
- by move=> t /line; apply: finite.
- move=> t z t01 z1; rewrite [z]back moved_eigenvalue//; set y := inC r * z.
  have yr : `|y| = inC r by rewrite normrM z1 mulr1 gtr0_norm.
  have [pos|neg] := real_leP (real0 C) (Creal_Im y).
    by apply: regular_not (line _ t01); apply: reg.
  apply/negP => /conjugate_eigenvalue -/(_ (loop_real _)); apply/negP.
  by apply: regular_not (line _ t01); apply: reg; rewrite ?norm_conjC// Im_conj oppr_ge0 ltW.
- move=> z; rewrite {1}[z]back moved_eigenvalue// e0 => /start.
  by rewrite disc -back.
by rewrite e1 moved_eigenvalue.
Qed.

(* Every disc of the segments is regular, and so is every point of the border beyond the last one. *)
Lemma segments_continuous (b : R) (ps : seq C) : path <%R 0 ps ->
  (forall lambda, eigenvalue (up (loop_of Z)) lambda -> 'Re lambda < - inC b) ->
  segments (fun lambda => regular lambda) (inC b) 0 ps ->
  forall Z', member Z' -> forall lambda, eigenvalue (up (loop_of Z')) lambda -> 'Re lambda < - inC b.
Proof.
move=> rise start on; apply: members_continuous start _ => lambda re im.
exact: (upper_line (inC_real b) rise on re im).
Qed.

(* In discrete time every disc of the arcs is regular. *)
Lemma arcs_discrete (r : R) (ps : seq C) : 0 < r -> path <%R 0 ps ->
  (forall lambda, eigenvalue (up (loop_of Z)) lambda -> `|lambda| < inC r) ->
  arcs (fun lambda => regular lambda) (inC r) 0 ps ->
  forall Z', member Z' -> forall lambda, eigenvalue (up (loop_of Z')) lambda -> `|lambda| < inC r.
Proof.
move=> r0 rise start on; have cr : 0 < inC r :> C by rewrite -(rmorph0 inC) inC_lt.
apply: members_discrete r0 start _ => lambda edge im.
exact: (upper_half cr rise on edge im).
Qed.
End Stable.

(* The kinds: entries within their radii, and entries that also move along given matrices, with real factors of at most 1. *)
Section Kinds.
Variables (R : rcfType) (n k : nat) (Z D : 'M[R]_(n + k)) (K : nat) (S : 'I_K -> 'M[R]_(n + k)).
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Notation up M := (map_mx inC M).
Notation regular within lambda :=
  (forall Z', within Z' -> lambda *: block_mx 1%:M 0 0 0 - up Z' \in unitmx).
Notation inside_line b Z' := (forall lambda : C, eigenvalue (up (loop_of Z')) lambda -> 'Re lambda < - inC b).
Notation inside_circle r Z' := (forall lambda : C, eigenvalue (up (loop_of Z')) lambda -> `|lambda| < inC r).

Definition member (Z' : 'M[R]_(n + k)) := forall i j, `|Z' i j - Z i j| <= D i j.
Definition tied_member (Z' : 'M[R]_(n + k)) := exists2 p : 'I_K -> R,
  forall l, `|p l| <= 1 & forall i j, `|(Z' - (Z + \sum_l p l *: S l)) i j| <= D i j.

Lemma shrunk (x d t : R) : 0 <= t <= 1 -> `|x| <= d -> `|t * x| <= d.
Proof.
move=> /andP[t0 t1] xd; rewrite normrM (ger0_norm t0) (le_trans (ler_wpmul2r _ t1))//.
by rewrite mul1r.
Qed.

Lemma members_convex Z' t : member Z' -> 0 <= t <= 1 -> member (along Z Z' t).
Proof. by move=> mem t01 i j; rewrite /along !mxE addrAC subrr add0r shrunk. Qed.

Lemma tied_convex Z' t : tied_member Z' -> 0 <= t <= 1 -> tied_member (along Z Z' t).
Proof.
move=> [p p1 mem] t01; exists (fun l => t * p l) => [l|i j]; first exact: shrunk.
have -> : \sum_l (t * p l) *: S l = t *: \sum_l p l *: S l.
  by rewrite scaler_sumr; apply: eq_bigr => l _; rewrite scalerA.
have -> : along Z Z' t - (Z + t *: \sum_l p l *: S l) = t *: (Z' - (Z + \sum_l p l *: S l)).
  by rewrite /along [Z + t *: (Z' - Z)]addrC addrKA -scalerBr opprD addrA.
by rewrite mxE shrunk.
Qed.

(* box_stable *)
Theorem box_stable_continuous (finite : forall Z', member Z' -> drsubmx Z' \in unitmx) (b : R) (ps : seq C) :
  path <%R 0 ps -> inside_line b Z -> segments (fun lambda => regular member lambda) (inC b) 0 ps ->
  forall Z', member Z' -> inside_line b Z'.
Proof. by move=> rise start; apply: (segments_continuous finite members_convex rise start). Qed.

Theorem box_stable_discrete (finite : forall Z', member Z' -> drsubmx Z' \in unitmx) (r : R) (ps : seq C) :
  0 < r -> path <%R 0 ps -> inside_circle r Z -> arcs (fun lambda => regular member lambda) (inC r) 0 ps ->
  forall Z', member Z' -> inside_circle r Z'.
Proof. by move=> r0 rise start; apply: (arcs_discrete finite members_convex r0 rise start). Qed.

(* parametric_box_stable *)
Theorem tied_stable_continuous (finite : forall Z', tied_member Z' -> drsubmx Z' \in unitmx) (b : R) (ps : seq C) :
  path <%R 0 ps -> inside_line b Z -> segments (fun lambda => regular tied_member lambda) (inC b) 0 ps ->
  forall Z', tied_member Z' -> inside_line b Z'.
Proof. by move=> rise start; apply: (segments_continuous finite tied_convex rise start). Qed.

Theorem tied_stable_discrete (finite : forall Z', tied_member Z' -> drsubmx Z' \in unitmx) (r : R) (ps : seq C) :
  0 < r -> path <%R 0 ps -> inside_circle r Z -> arcs (fun lambda => regular tied_member lambda) (inC r) 0 ps ->
  forall Z', tied_member Z' -> inside_circle r Z'.
Proof. by move=> r0 rise start; apply: (arcs_discrete finite tied_convex r0 rise start). Qed.
End Kinds.
