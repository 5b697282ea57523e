(* Kind `fixed_spectrum`, two polynomials modulo a large l: what divides a product h of factors modulo l has no
   other roots, if l is larger than h at every eigenvalue of A.

   No polynomial over Q is needed then.  The data are rationals whose denominators are prime to l, and h embeds Q
   into any field K; D is a common denominator of A. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence fixed_spectrum krylov_sequence gauss.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Determinant.
Variable F : closedFieldType.

Lemma det_shifted n (M : 'M[F]_n) rs (c : F) : char_poly M = \prod_(b <- rs) ('X - b%:P) ->
  \det (M - c%:M) = \prod_(b <- rs) (b - c).
Proof.
move=> eM; have sr : size rs = n.
  by have := size_char_poly M; rewrite eM size_prod_XsubC => -[].
have e : \det (c%:M - M) = (char_poly M).[c].
  rewrite /char_poly -horner_evalE -det_map_mx; congr (\det _); apply/matrixP=> i j.
  by rewrite !mxE /= !horner_evalE hornerD hornerN hornerC hornerMn hornerX.
rewrite -[M - _]opprB -scaleN1r detZ e eM horner_prod -sr.
elim: rs {eM sr e} => [|b rs IH]; first by rewrite !big_nil mulr1 expr0.
rewrite !big_cons /= exprS hornerXsubC -IH; set P := \prod_(i <- rs) _.
by rewrite mulrACA mulN1r opprB.
Qed.

(* det P(M) is the product of P over the roots of det(xI - M). *)
Lemma det_horner n (M : 'M[F]_n.+1) rs (P : {poly F}) : char_poly M = \prod_(b <- rs) ('X - b%:P) ->
  P \is monic -> \det (horner_mx M P) = \prod_(b <- rs) P.[b].
Proof.
move=> eM mP; have [cs ->] := closed_field_poly_normal P.
rewrite (monicP mP) scale1r; elim: cs => [|c cs IH].
  by rewrite big_nil rmorph1 det1 big1// => b _; rewrite hornerC.
rewrite big_cons rmorphM /= det_mulmx IH rmorphB /= horner_mx_X horner_mx_C (det_shifted _ eM) -big_split /=.
by apply: eq_bigr => b _; rewrite hornerM hornerXsubC.
Qed.
End Determinant.

Section Multiple.
Variable l : modulus.

Lemma residue0 (x : Zloc l) : residue x = 0 -> exists y, x = l%:R * y.
Proof.
have /integral_atP[d cd [z xd]] := Zloc_valP x => r0.
have zl : (l %| `|z|)%N.
  have := residue_ratE cd xd; rewrite -[residue_rat l _]/(residue x) r0 mul0r => /esym z0.
  have : (`|z|%N%:R : 'Z_l) = 0.
    by rewrite pmulrn abszEsign rmorphM /= z0 mulr0.
  by move/eqP; rewrite -val_eqE /= val_Zp_nat ?modulus_gt1.
have [t et] : exists t : int, z = l%:Z * t.
  by exists (z %/ l%:Z)%Z; rewrite mulrC divzK// dvdzE.
have d0 : (d%:R : rat) != 0.
  rewrite pnatr_eq0; apply: contraTneq cd => ->.
  by rewrite /coprime gcdn0 gtn_eqF ?modulus_gt1.
have yP : t%:~R / d%:R \in integral_at l.
  by apply/integral_atP; exists d => //; exists t; rewrite -[d%:~R]/(d%:R) divfK.
exists (ToZloc yP); apply: (@Zloc_rat_inj l); rewrite rmorphM rmorph_nat /=.
apply: (mulIf d0); rewrite -[d%:R in LHS]/(d%:~R) [LHS]xd et rmorphM /=.
by rewrite mulrA mulrAC -mulrA divff// mulr1.
Qed.

(* An integer that l^g divides at l is 0 if it is smaller. *)
Lemma small_multiple g (z : int) (w : Zloc l) :
  z%:~R = l%:R ^+ g * Zloc_rat w -> (`|z| < l ^ g)%N -> z = 0.
Proof.
have /integral_atP[d cd [t wd]] := Zloc_valP w => e small.
have zd : z * d%:Z = (l ^ g)%N%:Z * t.
  apply: (@intr_inj [numDomainType of rat]); rewrite !rmorphM /= e -wd -[(l ^ g)%N%:~R]/((l ^ g)%:R) natrX.
  by rewrite mulrA.
have dv : (l ^ g %| `|z|)%N.
  have : ((l ^ g)%N%:Z %| z * d%:Z)%Z by rewrite zd dvdz_mulr.
  by rewrite dvdzE abszM /= Gauss_dvdl// coprimeXl.
apply/eqP; rewrite -absz_eq0 -leqn0 leqNgt; apply: contraL dv => z0.
by rewrite gtnNdvd.
Qed.
End Multiple.

Section Bound.
Variables (l : modulus) (f h s e : {poly Zloc l}) (D k : nat) (H : {poly int}).
Notation up := (map_poly (@Zloc_rat l)).
Notation toC := (into (l := l) [rmorphism of @ratr algCfield]).
Notation HC := (map_poly intr H : {poly algC}).
Hypotheses (mf : f \is monic) (mh : h \is monic) (D0 : (0 < D)%N).
Hypothesis div : h = f * s + l%:R *: e.
Hypothesis scaled : forall x : algC, HC.[D%:R * x] = D%:R ^+ k * (map_poly toC h).[x].
Hypothesis integer : forall x, root (map_poly toC f) x -> D%:R * x \in Aint.
Hypothesis small : forall x, root (map_poly toC f) x -> `|HC.[D%:R * x]| < l%:R.

Let phi := gdcop (up h) (up f).

Lemma rest_constant : size phi = 1%N.
Proof.
have f0 : up f != 0 by rewrite monic_neq0 ?monic_map.
have [dv cop _] : [/\ phi %| up f, coprimep phi (up h) & True].
  rewrite /phi; case: gdcopP => g gf; rewrite (negPf f0) orbF => cg _; split=> //.
have phi0 : phi != 0 by apply: contraTneq dv => ->; rewrite dvd0p.
pose P := (lead_coef phi)^-1 *: phi.
have lp : (lead_coef phi)^-1 != 0 by rewrite invr_eq0 lead_coef_eq0.
have mP : P \is monic by rewrite monicE lead_coefZ mulVf// lead_coef_eq0.
have Pf : P %| up f by rewrite dvdpZl.
have [Q mQ eQ] := monic_factor mP mf Pf.
have [t et] : exists t, f = t * Q.
  apply: (@monic_divides _ _ [rmorphism of @idfun rat]) => //.
  by rewrite -[map_poly _ Q]/(up Q) -eQ.
have sQ : size Q = size phi.
  by rewrite -(size_scale phi lp) -/P eQ size_map_poly_id0// (monicP mQ) rmorph1 oner_eq0.
apply/eqP; rewrite eqn_leq size_poly_gt0 phi0 andbT leqNgt -sQ; apply/negP => big.
have [g eg] : exists g, (size Q).-1 = g.+1.
  by case: (size Q) big => [|[|a]] //= _; exists a.
have := companionmxK mQ; move: (companionmx Q); rewrite eg => M cM.
have hM : horner_mx M h = l%:R *: horner_mx M e.
  have z : horner_mx M Q = 0 by rewrite -cM Cayley_Hamilton.
  by rewrite div et rmorphD !rmorphM /= z mulr0 mul0r add0r linearZ.
pose MC := map_mx toC M.
have [rs ers] := closed_field_poly_normal (char_poly MC).
rewrite (monicP (char_poly_monic _)) scale1r in ers.
have rQ b : b \in rs -> root (map_poly toC Q) b.
  move=> brs; rewrite -cM map_char_poly -/MC ers root_prod_XsubC //.
have rf b : b \in rs -> root (map_poly toC f) b.
  by move/rQ => rb; rewrite et rmorphM rootM rb orbT.
have dC : toC (\det (horner_mx M h)) = \prod_(b <- rs) (map_poly toC h).[b].
  by rewrite -det_map_mx map_horner_mx (det_horner ers)// monic_map.
have srs : size rs = g.+1.
  by have := size_char_poly MC; rewrite ers size_prod_XsubC => -[].
pose q : Zloc l := D%:R ^+ (k * g.+1) * \det (horner_mx M h).
have qC : toC q = \prod_(b <- rs) HC.[D%:R * b].
  have -> : toC q = D%:R ^+ (k * g.+1) * toC (\det (horner_mx M h)) by rewrite rmorphM rmorphX rmorph_nat.
  rewrite dC exprM -srs.
  elim: (rs) => [|b r IH]; first by rewrite !big_nil expr0 mulr1.
  by rewrite !big_cons scaled exprS -IH mulrACA.
have HA b : b \in rs -> HC.[D%:R * b] \in Aint.
  move/rf/integer=> Ab; rewrite horner_poly; apply: rpred_sum => i _.
  by rewrite rpredM ?rpredX// rpred_int.
have : toC q \in Cint.
  apply: Cint_rat_Aint; first by apply: Crat_rat.
  by rewrite qC big_seq; apply: rpred_prod.
move/CintP=> [z ez].
have qz : Zloc_rat q = z%:~R.
  by apply: (fmorph_inj [rmorphism of @ratr algCfield]); rewrite rmorph_int -ez.
have z0 : z = 0.
  apply: (@small_multiple l g.+1 z (D%:R ^+ (k * g.+1) * \det (horner_mx M e))).
    by rewrite -qz /q hM detZ !rmorphM /= !rmorphX !rmorph_nat mulrCA.
  rewrite -ltz_nat -(ltr_int [numDomainType of algC]) abszE intr_norm -ez qC normr_prod.
  rewrite -[(l ^ _)%N%:~R]/((l ^ g.+1)%:R) natrX -srs.
  have := rf; have : (0 < size rs)%N by rewrite srs.
  elim: (rs) => [//|b r IH] _ rf'; rewrite big_cons exprS /=.
  have sb : `|HC.[D%:R * b]| < l%:R by apply/small/rf'; rewrite mem_head.
  case: r IH rf' => [|c r] IH rf'; first by rewrite big_nil expr0 !mulr1.
  apply: ltr_pmul; rewrite ?normr_ge0 ?prodr_ge0//.
  by apply: IH => // a ar; apply: rf'; rewrite inE ar orbT.
have : toC q == 0 by rewrite ez z0.
rewrite qC prodf_seq_eq0 => /hasP[b brs /=]; rewrite scaled mulf_eq0 expf_eq0 pnatr_eq0 (gtn_eqF D0) andbF /=.
move=> /eqP rh.
have copC : coprimep (map_poly toC Q) (map_poly toC h).
  rewrite !map_poly_into coprimep_map -eQ coprimepZl//.
by have /eqP[] := coprimep_root copC (rQ _ brs).
Qed.

Theorem divides_at_bound (K : fieldType) (hK : {rmorphism rat -> K}) lambda :
  root (map_poly (into hK) f) lambda -> root (map_poly (into hK) h) lambda.
Proof.
rewrite !map_poly_into => rf; apply: contraT => rh.
have fK : map_poly hK (up f) != 0 by rewrite map_poly_eq0 monic_neq0 ?monic_map.
have := root_gdco (map_poly hK (up h)) lambda fK; rewrite rf rh -gdcop_map -/phi => r.
have [c c0 ec] := size_poly1P _ (introT eqP rest_constant).
by move: r; rewrite ec map_polyC /root hornerC fmorph_eq0 (negPf c0).
Qed.
End Bound.

Lemma monic_common (a b : {poly rat}) : a \is monic -> exists P, [/\ P \is monic, P %| a, P %| b,
  forall d, d %| a -> d %| b -> d %| P & forall (K : fieldType) (h : {rmorphism rat -> K}) x,
  root (map_poly h a) x -> root (map_poly h b) x -> root (map_poly h P) x].
Proof.
move=> ma; have a0 := monic_neq0 ma; have g0 : gcdp a b != 0 by rewrite gcdp_eq0 (negPf a0).
have lg : (lead_coef (gcdp a b))^-1 != 0 by rewrite invr_eq0 lead_coef_eq0.
exists ((lead_coef (gcdp a b))^-1 *: gcdp a b); split; rewrite ?dvdpZl ?dvdp_gcdl ?dvdp_gcdr//.
- by rewrite monicE lead_coefZ mulVf// lead_coef_eq0.
- by move=> d da db; rewrite dvdpZr// dvdp_gcd da.
by move=> K h x ra rb; rewrite map_polyZ rootZ ?fmorph_eq0// gcdp_map root_gcd ra.
Qed.

(* The modulus of an eigenvalue is at most the largest sum of a row. *)
Lemma eigenvalue_at_most n (M : 'M[algC]_n) (r : algC) x :
  (forall i, \sum_j `|M i j| <= r) -> eigenvalue M x -> `|x| <= r.
Proof.
move=> rows /eigenvalueP[v ev v0]; pose s := \sum_j `|v 0 j|.
have s0 : 0 < s.
  rewrite lt_def sumr_ge0 ?andbT//; apply: contraNneq v0 => z; apply/eqP/matrixP=> i j.
  rewrite ord1 mxE; apply/normr0_eq0/eqP; rewrite eq_le normr_ge0 andbT -z /s (bigD1 j)//= ler_addl.
  exact: sumr_ge0.
rewrite -(ler_pmul2r s0) /s mulr_sumr.
apply: (@le_trans _ _ (\sum_j \sum_i `|v 0 i| * `|M i j|)).
  apply: ler_sum => j _; rewrite -normrM; have := congr1 (fun w : 'rV_n => w 0 j) ev; rewrite !mxE => <-.
  by rewrite (le_trans (ler_norm_sum _ _ _))//; apply: ler_sum => i _; rewrite normrM.
rewrite exchange_big mulr_sumr; apply: ler_sum => i _.
by rewrite -mulr_sumr mulrC; apply: ler_wpmul2r.
Qed.

(* M to the power 2^t, and its eigenvalues. *)
Definition squared (R : ringType) n t (M : 'M[R]_n) := iter t (fun X => X *m X) M.

Lemma map_squared (R R' : ringType) (f : {rmorphism R -> R'}) n t (M : 'M[R]_n) :
  map_mx f (squared t M) = squared t (map_mx f M).
Proof. by rewrite /squared; elim: t => //= t IH; rewrite map_mxM IH. Qed.

Lemma eigenvalue_squared (K : fieldType) n t (M : 'M[K]_n) x : eigenvalue M x -> eigenvalue (squared t M) (x ^+ (2 ^ t)).
Proof.
move/eigenvalueP=> [v ev v0]; apply/eigenvalueP; exists v => //; rewrite /squared.
elim: t => [|t /= IH]; first by rewrite expn0 expr1.
by rewrite mulmxA IH -scalemxAl IH scalerA expnS mul2n -addnn exprD.
Qed.

Section Rule.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Variables (F : gains (Zloc l) p q) (g h : {poly Zloc l}) (psi u v : {poly 'Z_l}).
Notation SQ := (map_system (@Zloc_rat l) S).
Notation res := (map_poly (@residue l)).
Notation chi F := (char_poly (closed_loop S F)).
(* Modulo l, g h is all that det(xI - A_F) has in common with det(xI - A); g divides these for all F. *)
Hypotheses (mg : g \is monic) (mh : h \is monic) (factored : res (chi F) = res (g * h) * psi).
Hypothesis always : forall G : gains rat p q, map_poly (@Zloc_rat l) g %| char_poly (closed_loop SQ G).
Hypothesis rest : u * psi + v * res (char_poly (mcA S)) = 1.
(* D A and the D^(k - i) h_i are integers; with r^(2^t) at least the largest sum of a row of |(D A)^(2^t)|, or of a
   column, l is above sum_i |D^(k - i) h_i| r^i. *)
Variables (D r t : nat) (N : 'M[int]_n) (H : {poly int}).
Hypotheses (D0 : (0 < D)%N) (eN : forall i j, D%:R * Zloc_rat (mcA S i j) = (N i j)%:~R).
Hypotheses (sH : (size H <= size h)%N) (eH : forall i, (i < size h)%N -> (H`_i)%:~R = D%:R ^+ ((size h).-1 - i) * Zloc_rat h`_i).
Hypothesis sums : (forall i, \sum_j `|squared t N i j| <= (r ^ (2 ^ t))%N%:Z) \/
  (forall j, \sum_i `|squared t N i j| <= (r ^ (2 ^ t))%N%:Z).
Hypothesis large : \sum_(i < size H) `|H`_i| * r%:Z ^+ i < l%:Z.

Notation toC := (into (l := l) [rmorphism of @ratr algCfield]).
Notation up := (map_poly (@Zloc_rat l)).

Lemma scaled_eigenvalue x : root (map_poly toC (char_poly (mcA S))) x ->
  D%:R * x \in Aint /\ `|D%:R * x| <= r%:R.
Proof.
rewrite map_char_poly -eigenvalue_root_char => ex.
pose NC := map_mx intr N : 'M[algC]_n.
have eNC : NC = D%:R *: map_mx toC (mcA S).
  apply/matrixP=> i j; rewrite !mxE -(rmorph_int [rmorphism of @ratr algCfield]) -eN rmorphM rmorph_nat.
  by [].
have eD : eigenvalue NC (D%:R * x).
  have /eigenvalueP[w ew w0] := ex; apply/eigenvalueP; exists w => //.
  by rewrite eNC -scalemxAr ew scalerA.
have sumC (M : 'M[int]_n) i : \sum_j `|M i j| <= (r ^ (2 ^ t))%N%:Z ->
    \sum_j `|(map_mx intr M : 'M[algC]_n) i j| <= r%:R ^+ (2 ^ t).
  rewrite -(ler_int [numDomainType of algC]) rmorph_sum /= -[X in _ <= X -> _]/((r ^ (2 ^ t))%:R) natrX => le.
  by apply: le_trans le; apply: ler_sum => j _; rewrite mxE intr_norm.
split.
  have rD : root (map_poly intr (char_poly N)) (D%:R * x) by rewrite map_char_poly -eigenvalue_root_char.
  apply: root_monic_Aint rD _ _; first by rewrite monic_map// char_poly_monic.
  by apply/polyOverP=> i; rewrite coef_map rpred_int.
have e2 : eigenvalue (map_mx intr (squared t N) : 'M[algC]_n) ((D%:R * x) ^+ (2 ^ t)).
  by rewrite map_squared; apply: eigenvalue_squared.
rewrite -(@ler_pexpn2r _ (2 ^ t)) ?nnegrE ?normr_ge0 ?ler0n ?expn_gt0// -normrX.
case: sums => s; first by apply: eigenvalue_at_most e2 => i; apply/sumC/s.
have eT : eigenvalue (map_mx intr (squared t N)^T : 'M[algC]_n) ((D%:R * x) ^+ (2 ^ t)).
  suff eT M : char_poly (M^T : 'M[algC]_n) = char_poly M by rewrite -map_trmx eigenvalue_root_char eT -eigenvalue_root_char.
  by rewrite /char_poly -[RHS]det_tr; congr (\det _); apply/matrixP=> i j; rewrite !mxE eq_sym.
apply: eigenvalue_at_most eT => i; apply: sumC; apply: le_trans (s i).
by apply: ler_sum => j _; rewrite mxE.
Qed.

Theorem large_modulus (K : fieldType) (hK : {rmorphism rat -> K}) lambda :
  fixed (map_system hK SQ) lambda -> root (map_poly (into hK) (g * h)) lambda.
Proof.
move=> fx.
have mA : up (char_poly (mcA S)) \is monic by rewrite monic_map// char_poly_monic.
have [P [mP PA PF most common]] := monic_common (up (chi F)) mA.
have [f0 mf0 ef0] := monic_factor mP (char_poly_monic (mcA S)) PA.
have gP : up g %| up f0.
  rewrite -ef0; apply: most; last by rewrite map_char_poly map_closed_loop; exact: always.
  have := always (fun=> 0); rewrite /closed_loop big1 => [|i _]; last by rewrite mulmx0 mul0mx.
  by rewrite addr0 map_char_poly.
have [f ef] : exists f, f0 = f * g.
  by apply: (@monic_divides _ _ [rmorphism of @idfun rat]); [exact: mg | exact: gP].
have mf : f \is monic by rewrite -(monicMr f mg) -ef.
have [a ea] : exists a, char_poly (mcA S) = a * f0.
  apply: (@monic_divides _ _ [rmorphism of @idfun rat]); first exact: mf0.
  by rewrite -[map_poly _ f0]/(up f0) -ef0; exact: PA.
have [b eb] : exists b, chi F = b * f0.
  apply: (@monic_divides _ _ [rmorphism of @idfun rat]); first exact: mf0.
  by rewrite -[map_poly _ f0]/(up f0) -ef0; exact: PF.
have [s es] : exists s, res h = res f * s.
  exists (u * res b + v * res a * res (g * h)).
  have mrg : res g \is monic by rewrite monic_map.
  apply: (monic_cancel mrg); rewrite -rmorphM /= mulrA -rmorphM /= [g * f]mulrC -ef mulrDr.
  have -> : res f0 * (u * res b) = u * psi * res (g * h).
    by rewrite mulrCA [res f0 * _]mulrC -rmorphM /= -eb factored [res (g * h) * _]mulrC mulrA.
  have -> : res f0 * (v * res a * res (g * h)) = v * res (char_poly (mcA S)) * res (g * h).
    by rewrite mulrA; congr (_ * _); rewrite mulrCA [res f0 * _]mulrC -rmorphM /= -ea.
  by rewrite -mulrDl rest mul1r.
pose s' : {poly Zloc l} := \poly_(i < size s) representative s`_i.
have es' : res s' = s.
  apply/polyP=> i; rewrite coef_map coef_poly; case: ltnP => si; first by rewrite /= representativeK.
  by rewrite nth_default//=; exact: (rmorph0 [rmorphism of @residue l]).
pose d := h - f * s'.
have [e ee] : exists e, h = f * s' + l%:R *: e.
  have zero i : exists y, d`_i = l%:R * y.
    apply: residue0; have : res d = 0 by rewrite rmorphB rmorphM /= es' -es subrr.
    by move/polyP/(_ i); rewrite coef_map coef0.
  have [y ey] : exists y : nat -> Zloc l, forall i, (i < size d)%N -> d`_i = l%:R * y i.
    elim: (size _) => [|k [y ey]]; first by exists (fun=> 0).
    have [z ez] := zero k; exists (fun i => if i == k then z else y i) => i; rewrite ltnS leq_eqVlt.
    by case: eqVneq => [->|ne /= ik] //; rewrite ey.
  exists (\poly_(i < size d) y i); apply/eqP; rewrite addrC -subr_eq; apply/eqP/polyP=> i.
  rewrite -/d coefZ coef_poly; case: ltnP => [/ey//|si]; by rewrite nth_default// mulr0.
have froot x : root (map_poly toC f) x -> root (map_poly toC (char_poly (mcA S))) x.
  by move=> rf; rewrite ea ef !rmorphM !rootM rf orbT.
have key : root (map_poly (into hK) f) lambda -> root (map_poly (into hK) h) lambda.
  apply: (@divides_at_bound _ f h s' e D (size h).-1 H) => //.
  - move=> x; rewrite (@horner_coef_wide _ (size h)) ?(leq_trans (size_poly _ _))//.
    rewrite (@horner_coef_wide _ (size h) (map_poly toC h)) ?size_poly// mulr_sumr; apply: eq_bigr => i _.
    have -> : (map_poly intr H : {poly algC})`_i = D%:R ^+ ((size h).-1 - i) * toC h`_i.
      by rewrite coef_map /= -(rmorph_int [rmorphism of @ratr algCfield]) eH// rmorphM rmorphX rmorph_nat.
    have ik : (i <= (size h).-1)%N by rewrite -ltnS prednK// (leq_ltn_trans (leq0n i) (ltn_ord i)).
    have -> : (map_poly toC h)`_i = toC h`_i by rewrite coef_map.
    move: (toC h`_i) => c; rewrite exprMn -[in RHS](subnK ik) exprD -!mulrA; congr (_ * _).
    by rewrite mulrCA.
  - by move=> x /froot/scaled_eigenvalue[].
  - move=> x /froot/scaled_eigenvalue[_ sx]; have := large; rewrite -(ltr_int [numDomainType of algC]).
    rewrite (@horner_coef_wide _ (size H)) ?size_poly//; apply: le_lt_trans; rewrite rmorph_sum /=.
    apply: le_trans (ler_norm_sum _ _ _) _; apply: ler_sum => i _.
    rewrite coef_map normrM normrX rmorphM rmorphX /= intr_norm; apply: ler_wpmul2l => //.
    by apply: ler_expn2r => //; rewrite ?nnegrE ?normr_ge0 ?ler0n.
have eA : eigenvalue (mcA (map_system hK SQ)) lambda.
  have := fx (fun=> 0); rewrite /closed_loop big1 ?addr0// => i _.
  by rewrite mulmx0 mul0mx.
have eF : root (map_poly (into hK) (chi F)) lambda by rewrite -eigenvalue_into map_loop_into.
move: eA; rewrite /= -map_mx_comp eigenvalue_into => eA.
have : root (map_poly (into hK) f0) lambda by rewrite map_poly_into -ef0; apply: common; rewrite -map_poly_into.
by rewrite ef !rmorphM !rootM => /orP[/key->|->//]; rewrite orbT.
Qed.
End Rule.
