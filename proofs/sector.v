(* checker/loops.py: the sector of a damping ratio zeta, - Re z > zeta |z|, as the stability of another
   polynomial and of another matrix.  w z and w^* z have negative real parts, for a w = h + ks with k > 0
   times the imaginary unit, iff z is in the sector; c = (k/h)^2 = zeta^2 / (1 - zeta^2). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location routh_integers.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Turned.
Variable R : comRingType.
Implicit Types (p : {poly R}) (a b h e : R).

(* (h + r)^k = u + v r where r^2 = - e. *)
Fixpoint power h e k : R * R :=
  if k is j.+1 then let t := power h e j in (h * t.1 - e * t.2, t.1 + h * t.2) else (1, 0).
Definition real_part p h e := \poly_(k < size p) (p`_k * (power h e ((size p).-1 - k)).1).
Definition other_part p h e := \poly_(k < size p) (p`_k * (power h e ((size p).-1 - k)).2).
(* U^2 + e V^2 with h = b^2 - a^2 and e = a^2 h, for zeta = a / b. *)
Definition turned p a b := let h := b ^+ 2 - a ^+ 2 in let e := a ^+ 2 * h in
  real_part p h e ^+ 2 + e *: other_part p h e ^+ 2.

Lemma powerE h e r k : r ^+ 2 = - e -> (h + r) ^+ k = (power h e k).1 + r * (power h e k).2.
Proof.
move=> er; elim: k => [|k IH] /=; first by rewrite expr0 mulr0 addr0.
rewrite exprS IH mulrDl !mulrDr [r * (r * _)]mulrA -expr2 er mulNr [r * (h * _)]mulrCA.
by rewrite addrACA [RHS]addrACA [h * (r * _) + _]addrC.
Qed.

Definition scaled_up p w := \poly_(k < size p) (p`_k * w ^+ ((size p).-1 - k)).
Lemma turnedE p a b r : r ^+ 2 = - (a ^+ 2 * (b ^+ 2 - a ^+ 2)) ->
  turned p a b = scaled_up p (b ^+ 2 - a ^+ 2 + r) * scaled_up p (b ^+ 2 - a ^+ 2 - r).
Proof.
set h := b ^+ 2 - a ^+ 2 => er; rewrite /turned -/h.
have half s : s ^+ 2 = - (a ^+ 2 * h) ->
    scaled_up p (h + s) = real_part p h (a ^+ 2 * h) + s *: other_part p h (a ^+ 2 * h).
  move=> es; apply/polyP=> k; rewrite coefD coefZ !coef_poly; case: ltnP => _; last by rewrite mulr0 addr0.
  by rewrite (powerE _ _ es) mulrDr mulrCA.
by rewrite (half r er) (half (- r)) ?sqrrN// scaleNr [RHS]mulrC -subr_sqr exprZn er scaleNr opprK.
Qed.
End Turned.

Section Sector.
Variable C : numClosedFieldType.
Implicit Types (z w zeta : C).

Definition damped zeta z := 'Re z < - (zeta * `|z|).

(* Two lines through 0 bound the sector. *)
Lemma damped_lines zeta s z : 0 < zeta -> zeta < 1 -> 0 <= s -> s ^+ 2 * (1 - zeta ^+ 2) = zeta ^+ 2 ->
  damped zeta z <-> 'Re z - s * 'Im z < 0 /\ 'Re z + s * 'Im z < 0.
Proof.
move=> z0 z1 s0 e; have rs : s * 'Im z \is Num.real by apply: rpredM; [apply: ger0_real | apply: Creal_Im].
have lines : ('Re z - s * 'Im z < 0 /\ 'Re z + s * 'Im z < 0) <-> `|s * 'Im z| < - 'Re z.
  have -> : ('Re z + s * 'Im z < 0) = (s * 'Im z < - 'Re z) by rewrite -[RHS]subr_lt0 opprK addrC.
  by rewrite (real_ltr_norml _ rs) opprK subr_lt0; split=> [[-> ->]|/andP[]].
apply: iff_trans (iff_sym lines); rewrite /damped ltr_oppr.
have rx : - 'Re z \is Num.real by rewrite rpredN Creal_Re.
have [x0|x0] := real_ltP (real0 _) rx; last first.
  have no t : 0 <= t -> t < - 'Re z -> False.
    by move=> t0 h; have := lt_geF (lt_le_trans h x0); rewrite t0.
  by split=> h; case: (no _ _ h); rewrite ?mulr_ge0 ?normr_ge0 ?(ltW z0).
have sq (t : C) : 0 <= t -> (t < - 'Re z) = (t ^+ 2 < 'Re z ^+ 2).
  by move=> t0; rewrite -(sqrrN ('Re z)) ltr_pexpn2r ?nnegrE ?(ltW x0).
rewrite !sq ?normr_ge0 ?mulr_ge0 ?normr_ge0 ?(ltW z0)// real_normK// !exprMn normC2_Re_Im.
have d0 : 0 < 1 - zeta ^+ 2 by rewrite subr_gt0 exprn_ilt1// ltW.
suff -> : (s ^+ 2 * 'Im z ^+ 2 < 'Re z ^+ 2) = (zeta ^+ 2 * ('Re z ^+ 2 + 'Im z ^+ 2) < 'Re z ^+ 2) by [].
rewrite -[LHS](ltr_pmul2r d0) mulrAC e mulrBr mulr1 ltr_subr_addr.
by rewrite ['Re z ^+ 2 * _]mulrC -mulrDr addrC.
Qed.

(* w = h + 'i k with k = s h turns the two lines into the imaginary axis. *)
Lemma damped_turned zeta h s z : 0 < zeta -> zeta < 1 -> 0 <= s -> s ^+ 2 * (1 - zeta ^+ 2) = zeta ^+ 2 -> 0 < h ->
  damped zeta z <-> 'Re ((h + 'i * (s * h)) * z) < 0 /\ 'Re ((h - 'i * (s * h)) * z) < 0.
Proof.
move=> z0 z1 s0 e h0; have rh : h \is Num.real by apply: ger0_real; apply: ltW.
have rs : s \is Num.real by apply: ger0_real.
have turn t : t \is Num.real -> ('Re ((h + 'i * (t * h)) * z) < 0) = ('Re z - t * 'Im z < 0).
  move=> rt; have -> : (h + 'i * (t * h)) * z = h * (z + 'i * (t * z)) by rewrite mulrDl mulrDr !mulrA [_ * h]mulrC !mulrA.
  by rewrite (ReMl rh) pmulr_rlt0// raddfD /= ReMil (ImMl rt).
rewrite (turn s rs); have -> : h - 'i * (s * h) = h + 'i * (- s * h) by rewrite mulNr mulrN.
by rewrite (turn (- s)) ?rpredN// mulNr opprK; apply: damped_lines.
Qed.

Lemma direction (h k : C) : 0 < h -> k \is Num.real -> h + 'i * k != 0.
Proof.
move=> h0 rk; apply/eqP=> e; have := Re_rect (ger0_real (ltW h0)) rk.
by rewrite e raddf0 => z; move: h0; rewrite -z ltxx.
Qed.

Lemma root_scaled_up (p : {poly C}) w z : w != 0 -> root (scaled_up p w) z = root p (z / w).
Proof.
move=> nw; have e : (scaled_up p w).[z] = w ^+ (size p).-1 * p.[z / w].
  rewrite /scaled_up horner_poly [p.[_]]horner_coef mulr_sumr; apply: eq_bigr => k _.
  have -> : (size p).-1 = ((size p).-1 - k + k)%N by rewrite subnK// -ltnS prednK// (leq_trans _ (ltn_ord k)).
  by rewrite addnK exprD expr_div_n mulrCA -!mulrA [w ^+ k * _]mulrC divfK ?expf_neq0.
by rewrite !rootE e mulf_eq0 expf_eq0 (negPf nw) andbF.
Qed.

(* Kind `stability`, by the polynomial: U^2 + e V^2 has its roots in the left half-plane iff all roots of p
   have a damping ratio above a / b. *)
Theorem damping_rule (p : {poly C}) (a b : C) : 0 < a -> a < b ->
  (forall z, root (turned p a b) z -> 'Re z < 0) <-> (forall z, root p z -> damped (a / b) z).
Proof.
move=> a0 ab; have b0 := lt_trans a0 ab; pose h := b ^+ 2 - a ^+ 2.
have h0 : 0 < h by rewrite subr_gt0 ltr_pexpn2r ?nnegrE// ltW.
pose k := sqrtC (a ^+ 2 * h); have k0 : 0 <= k by rewrite sqrtC_ge0 mulr_ge0 ?exprn_ge0 ?ltW.
have s0 : 0 <= k / h by rewrite divr_ge0// ltW.
have z0 : 0 < a / b by rewrite divr_gt0. have z1 : a / b < 1 by rewrite ltr_pdivr_mulr// mul1r.
have e : (k / h) ^+ 2 * (1 - (a / b) ^+ 2) = (a / b) ^+ 2.
  rewrite !expr_div_n sqrtCK; have -> : 1 - a ^+ 2 / b ^+ 2 = h / b ^+ 2.
    by rewrite mulrBl divff// expf_neq0// gt_eqF.
  by rewrite mulrA [h ^+ 2]expr2 invfM mulrA mulfK ?gt_eqF// divfK ?gt_eqF.
have ek : k / h * h = k by rewrite divfK// gt_eqF.
have rk := ger0_real k0; have er : ('i * k) ^+ 2 = - (a ^+ 2 * h) by rewrite exprMn sqrCi sqrtCK mulN1r.
have n1 := direction h0 rk; have n2 : h - 'i * k != 0 by rewrite -mulrN; apply: direction; rewrite ?rpredN.
have rt z : root (turned p a b) z = root p (z / (h + 'i * k)) || root p (z / (h - 'i * k)).
  by rewrite (turnedE p er) rootM !root_scaled_up.
have cancel_left w z : w != 0 -> w * z / w = z by move=> nw; rewrite mulrAC divff// mul1r.
have cancel_right w z : w != 0 -> w * (z / w) = z by move=> nw; rewrite mulrC divfK.
split=> H z.
  move=> rz; apply/(damped_turned _ z0 z1 s0 e h0); rewrite ek.
  by split; apply: H; rewrite rt cancel_left// rz ?orbT.
by rewrite rt => /orP[] /H /(damped_turned _ z0 z1 s0 e h0); rewrite ek => -[]; rewrite !cancel_right.
Qed.

(* Kind `stability`, by quadratic forms: the matrix whose stability is shown. *)
Definition lifted n (M : 'M[C]_n) c : 'M[C]_(n + n) := block_mx M (- c *: M) M M.

Lemma lifted_eigenvalue n (M : 'M[C]_n) c r mu : r ^+ 2 = - c -> r != 0 -> 1 + r != 0 -> 1 - r != 0 ->
  eigenvalue (lifted M c) mu <->
  exists2 lambda, eigenvalue M lambda & mu = (1 + r) * lambda \/ mu = (1 - r) * lambda.
Proof.
move=> er nr n1 n2; have er' : (- r) ^+ 2 = - c by rewrite sqrrN.
split.
  case/eigenvalueP=> v; rewrite -[v]hsubmxK; move: (lsubmx v) (rsubmx v) => u1 u2.
  rewrite mul_row_block scale_row_mx => /eq_row_mx[e1 e2] nv.
  have each k : k ^+ 2 = - c -> 1 + k != 0 -> u2 + k *: u1 != 0 -> eigenvalue M (mu / (1 + k)).
    move=> ek nk nz; apply/eigenvalueP; exists (u2 + k *: u1) => //.
    have key : (1 + k) *: ((u2 + k *: u1) *m M) = mu *: (u2 + k *: u1).
      rewrite mulmxDl -scalemxAl scalerDl scale1r scalerDr [k *: (k *: _)]scalerA -expr2 ek.
      rewrite [RHS]scalerDr -e2 scalerA [mu * k]mulrC -scalerA -e1 -scalemxAr [k *: (_ + _)]scalerDr.
      by rewrite [X in _ + X = _]addrC addrACA [u2 *m M + _]addrC.
    by apply: (scalerI nk); rewrite key scalerA mulrCA divff// mulr1.
  have [z1|nz] := eqVneq (u2 + r *: u1) 0; last first.
    by exists (mu / (1 + r)); [apply: each | left; rewrite mulrC divfK].
  have [z2|nz] := eqVneq (u2 - r *: u1) 0; last first.
    by exists (mu / (1 - r)); [apply: each; rewrite ?scaleNr | right; rewrite mulrC divfK].
  have u10 : u1 = 0.
    have twice : (r *+ 2) *: u1 = (u2 + r *: u1) - (u2 - r *: u1).
      by rewrite opprB addrC subrKA mulr2n scalerDl.
    move: twice; rewrite z1 z2 subr0.
    by move/eqP; rewrite scaler_eq0 mulrn_eq0 /= (negPf nr) => /eqP.
  by move: nv z1; rewrite u10 scaler0 addr0 => /eqP nv z; case: nv; rewrite z row_mx0.
case=> lambda /eigenvalueP[v ev nv] h.
have each k : k ^+ 2 = - c -> eigenvalue (lifted M c) ((1 + k) * lambda).
  move=> ek; apply/eigenvalueP; exists (row_mx v (k *: v)); last first.
    by apply: contra nv => /eqP; rewrite -row_mx0 => /eq_row_mx[-> _].
  rewrite mul_row_block scale_row_mx -scalemxAl -scalemxAr ev -ek; congr row_mx.
    by rewrite scalerA -scalerDl mulrDl mul1r.
  by rewrite !scalerA -scalerDl expr2 -mulrDl [_ * lambda * k]mulrAC [(1 + k) * k]mulrDl mul1r addrC.
by case: h => ->; apply: each.
Qed.

Theorem damping_matrix n (M : 'M[C]_n) zeta : 0 < zeta -> zeta < 1 ->
  (forall mu, eigenvalue (lifted M (zeta ^+ 2 / (1 - zeta ^+ 2))) mu -> 'Re mu < 0) <->
  (forall lambda, eigenvalue M lambda -> damped zeta lambda).
Proof.
move=> z0 z1; set c := zeta ^+ 2 / _.
have d0 : 0 < 1 - zeta ^+ 2 by rewrite subr_gt0 exprn_ilt1// ltW.
have c0 : 0 < c by rewrite divr_gt0// exprn_gt0.
pose s := sqrtC c; have s0 : 0 < s by rewrite sqrtC_gt0.
have e : s ^+ 2 * (1 - zeta ^+ 2) = zeta ^+ 2 by rewrite sqrtCK divfK// gt_eqF.
have rs := ger0_real (ltW s0); have er : ('i * s) ^+ 2 = - c by rewrite exprMn sqrCi sqrtCK mulN1r.
have nr : 'i * s != 0 by rewrite mulf_neq0 ?neq0Ci// gt_eqF.
have n1 := direction ltr01 rs; have n2 : 1 - 'i * s != 0 by rewrite -mulrN; apply: (direction ltr01); rewrite rpredN.
have dt z := damped_turned z z0 z1 (ltW s0) e ltr01.
split=> H z.
  by move=> ez; apply/dt; rewrite mulr1; split; apply: H; apply/(lifted_eigenvalue _ _ er nr n1 n2); exists z; [|left| |right].
case/(lifted_eigenvalue _ _ er nr n1 n2) => lambda /H /dt; rewrite mulr1 => -[h1 h2] [] ->; assumption.
Qed.
End Sector.

(* Over the rationals, where the checker computes: w are the integers of Routh's array as in routh_integers.v. *)
Section Rational.
Variable C : numClosedFieldType.
Local Notation up := (map_poly (@ratr C)).

Lemma map_power (h e : rat) k : power (ratr h : C) (ratr e) k = (ratr (power h e k).1, ratr (power h e k).2).
Proof. by elim: k => [|k /= ->] /=; rewrite ?rmorph1 ?rmorph0// rmorphB rmorphD !rmorphM. Qed.

Lemma map_turned (p : {poly rat}) a b : up (turned p a b) = turned (up p) (ratr a) (ratr b).
Proof.
have one (h e : rat) : up (real_part p h e) = real_part (up p) (ratr h) (ratr e).
  apply/polyP=> k; rewrite coef_map coef_poly [RHS]coef_poly size_map_poly; case: ltnP => _ /=; last by rewrite rmorph0.
  by rewrite map_power rmorphM coef_map.
have other (h e : rat) : up (other_part p h e) = other_part (up p) (ratr h) (ratr e).
  apply/polyP=> k; rewrite coef_map coef_poly [RHS]coef_poly size_map_poly; case: ltnP => _ /=; last by rewrite rmorph0.
  by rewrite map_power rmorphM coef_map.
rewrite /turned rmorphD /= map_polyZ !rmorphX /= one other.
by rewrite rmorphM !(rmorphB, rmorphX).
Qed.

Lemma turned_neq0 (p : {poly rat}) a b : p != 0 -> turned p a b != 0.
Proof.
move=> p0; apply/eqP=> z.
pose r : C := 'i * sqrtC (ratr (a ^+ 2 * (b ^+ 2 - a ^+ 2))).
have er : r ^+ 2 = - (ratr a ^+ 2 * (ratr b ^+ 2 - ratr a ^+ 2)).
  by rewrite exprMn sqrCi sqrtCK mulN1r rmorphM !(rmorphB, rmorphX).
have last w : scaled_up (up p) w != 0.
  apply/eqP=> e; have : (scaled_up (up p) w)`_(size p).-1 = ratr (lead_coef p).
    by rewrite coef_poly size_map_poly coef_map /= subnn expr0 mulr1 ltn_predL size_poly_gt0 p0.
  by rewrite e coef0 => /esym/eqP; rewrite fmorph_eq0 lead_coef_eq0 (negPf p0).
have := turnedE (up p) er; rewrite -map_turned z rmorph0 => /esym/eqP.
by rewrite mulf_eq0 !(negPf (last _)).
Qed.

(* Kind `stability`, a damping ratio by the polynomial, in the integers of Routh's array. *)
Theorem damping_by_integers (p : {poly rat}) a b w answer : p != 0 -> 0 < a -> a < b ->
  integers_of (turned p a b) w -> hurwitz_integers w = Some answer ->
  (forall z : C, root (up p) z -> damped (ratr (a / b)) z) <-> answer.
Proof.
move=> p0 a0 ab [t [s [t0 s0 sw hw]]] h.
rewrite -(is_hurwitz_integers C (turned_neq0 a b p0) t0 s0 sw hw h) map_turned.
apply: iff_sym; rewrite fmorph_div; apply: damping_rule; by rewrite ?ltr0q ?ltr_rat.
Qed.
End Rational.
