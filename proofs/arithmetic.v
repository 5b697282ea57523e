(* checker/core/arithmetic.py: rationals modulo l, and what a computation modulo l proves over Q.

   `integral_at l` are the rationals whose denominator is prime to l ("a modulus divides no
   denominator in use"); `Zloc l` is the ring of them, `Zloc_rat` its embedding in Q, `residue`
   its reduction to Z/l.  l need not be prime.
   Rules: absence (resultants), ranks from below, elimination with unit pivots. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* A modulus: an integer that is at least 2. *)
Record modulus := Modulus { modulus_nat :> nat; modulus_gt1 : (1 < modulus_nat)%N }.

Section Integral.
Variable l : modulus.

Definition integral_at : {pred rat} := [pred x | coprime l `|denq x|].

Lemma integral_atP x : reflect (exists2 d : nat, coprime l d
    & exists z : int, x * d%:~R = z%:~R) (x \in integral_at).
Proof.
apply: (iffP idP) => [cx | [d cd [z xd]]].
  exists `|denq x|%N => //; exists (numq x).
  by rewrite absz_denq -numqE.
rewrite inE; apply: (coprime_dvdr _ cd).
have e : numq x * d%:Z = z * denq x.
  by apply: (@intr_inj [numDomainType of rat]); rewrite !rmorphM/= -xd numqE mulrAC.
have : (denq x %| numq x * d%:Z)%Z by rewrite e dvdz_mull.
rewrite Gauss_dvdzr ?dvdzE// coprimezE coprime_sym; exact: coprime_num_den.
Qed.

Definition residue_rat (x : rat) : 'Z_l := (numq x)%:~R / (denq x)%:~R.

Lemma unit_nat_modulus (d : nat) : coprime l d -> (d%:R : 'Z_l) \is a GRing.unit.
Proof. by move=> cd; rewrite unitZpE// modulus_gt1. Qed.

Lemma unit_modulus (d : int) : coprime l `|d| -> (d%:~R : 'Z_l) \is a GRing.unit.
Proof.
move=> cd; have -> : (d%:~R : 'Z_l) = (-1) ^+ (d < 0)%R * `|d|%:R by rewrite {1}[d]intEsign rmorphM rmorphX/= rmorphN1.
by rewrite unitrM unit_nat_modulus// andbT unitrX// unitrN unitr1.
Qed.

(* The residue does not depend on how the fraction is written. *)
Lemma residue_ratE x (d : nat) (z : int) : coprime l d -> x * d%:~R = z%:~R ->
  residue_rat x * d%:R = z%:~R.
Proof.
move=> cd xd; have ux : x \in integral_at by apply/integral_atP; exists d => //; exists z.
have e : numq x * d%:Z = z * denq x.
  by apply: (@intr_inj [numDomainType of rat]); rewrite !rmorphM/= -xd numqE mulrAC.
have ud : ((denq x)%:~R : 'Z_l) \is a GRing.unit by apply: unit_modulus.
have /(congr1 (fun t : int => t%:~R : 'Z_l)) := e; rewrite !rmorphM/= => e'.
by apply: (mulIr ud); rewrite -e' /residue_rat mulrAC divrK.
Qed.

Fact integral_subring : subring_closed integral_at.
Proof.
split=> [|x y /integral_atP[d cd [z xd]] /integral_atP[e ce [t ye]]
         |x y /integral_atP[d cd [z xd]] /integral_atP[e ce [t ye]]].
- by rewrite inE coprimen1.
- apply/integral_atP; exists (d * e)%N; first by rewrite coprimeMr cd.
  exists (z * e%:Z - t * d%:Z); rewrite PoszM !rmorphB !rmorphM/= -xd -ye.
  by rewrite mulrBl mulrA; congr (_ - _); rewrite [_ * e%:~R]mulrC mulrA.
- apply/integral_atP; exists (d * e)%N; first by rewrite coprimeMr cd.
  by exists (z * t); rewrite PoszM !rmorphM/= -xd -ye mulrACA.
Qed.
Fact integral_key : pred_key integral_at. Proof. by []. Qed.
Canonical integral_keyed := KeyedPred integral_key.
Canonical integral_opprPred := OpprPred integral_subring.
Canonical integral_addrPred := AddrPred integral_subring.
Canonical integral_zmodPred := ZmodPred integral_subring.
Canonical integral_mulrPred := MulrPred integral_subring.
Canonical integral_semiringPred := SemiringPred integral_subring.
Canonical integral_smulrPred := SmulrPred integral_subring.
Canonical integral_subringPred := SubringPred integral_subring.

Record Zloc := ToZloc { Zloc_val :> rat; Zloc_valP : Zloc_val \in integral_at }.
Canonical Zloc_subType := [subType for Zloc_val].
Definition Zloc_eqMixin := [eqMixin of Zloc by <:].
Canonical Zloc_eqType := EqType Zloc Zloc_eqMixin.
Definition Zloc_choiceMixin := [choiceMixin of Zloc by <:].
Canonical Zloc_choiceType := ChoiceType Zloc Zloc_choiceMixin.
Definition Zloc_zmodMixin := [zmodMixin of Zloc by <:].
Canonical Zloc_zmodType := ZmodType Zloc Zloc_zmodMixin.
Definition Zloc_ringMixin := [ringMixin of Zloc by <:].
Canonical Zloc_ringType := RingType Zloc Zloc_ringMixin.
Definition Zloc_comRingMixin := [comRingMixin of Zloc by <:].
Canonical Zloc_comRingType := ComRingType Zloc Zloc_comRingMixin.

Definition Zloc_rat : Zloc -> rat := val.
Fact Zloc_rat_rmorph : rmorphism Zloc_rat. Proof. by do !split. Qed.
Canonical Zloc_rat_additive := Additive Zloc_rat_rmorph.
Canonical Zloc_rat_rmorphism := RMorphism Zloc_rat_rmorph.

Definition residue (x : Zloc) : 'Z_l := residue_rat (Zloc_rat x).
Fact residue_rmorph : rmorphism residue.
Proof.
split=> [[x Px] [y Py] | ]; last split=> [[x Px] [y Py] | ].
- rewrite /residue/Zloc_rat/=.
  have /integral_atP[d cd [z xd]] := Px; have /integral_atP[e ce [t ye]] := Py.
  have cde : coprime l (d * e) by rewrite coprimeMr cd.
  have ude := unit_nat_modulus cde.
  apply: (mulIr ude); rewrite (@residue_ratE _ (d * e) (z * e%:Z - t * d%:Z))//; last first.
    rewrite PoszM !rmorphB !rmorphM/= -xd -ye mulrBl mulrA; congr (_ - _).
    by rewrite [_ * e%:~R]mulrC mulrA.
  rewrite mulrBl natrM mulrA (residue_ratE cd xd) [d%:R * e%:R]mulrC mulrA (residue_ratE ce ye).
  by rewrite rmorphB !rmorphM.
- rewrite /residue/Zloc_rat/=.
  have /integral_atP[d cd [z xd]] := Px; have /integral_atP[e ce [t ye]] := Py.
  have cde : coprime l (d * e) by rewrite coprimeMr cd.
  have ude := unit_nat_modulus cde.
  apply: (mulIr ude); rewrite (@residue_ratE _ (d * e) (z * t))//; last first.
    by rewrite PoszM !rmorphM/= -xd -ye mulrACA.
  by rewrite natrM mulrACA (residue_ratE cd xd) (residue_ratE ce ye) rmorphM.
- by rewrite /residue/residue_rat/= divr1.
Qed.
Canonical residue_additive := Additive residue_rmorph.
Canonical residue_rmorphism := RMorphism residue_rmorph.

(* A representative of every residue. *)
Definition representative (x : 'Z_l) : Zloc := (x : nat)%:R.
Lemma representativeK : cancel representative residue.
Proof. by move=> x; rewrite /representative rmorph_nat natr_Zp. Qed.

Lemma Zloc_rat_inj : injective Zloc_rat. Proof. exact: val_inj. Qed.

(* From Z/l to the field of its least prime factor; 'F_l is that field for every l >= 2. *)
Definition to_prime (x : 'Z_l) : 'F_l := (x : nat)%:R.
Lemma to_prime_nat (a : nat) : to_prime a%:R = a%:R.
Proof.
have l1 := modulus_gt1 l; have p_pr := pdiv_prime l1.
rewrite /to_prime val_Zp_nat//; apply/eqP; rewrite -val_eqE/= !val_Zp_nat ?prime_gt1//.
by rewrite modn_dvdm// pdiv_dvd.
Qed.
Fact to_prime_rmorph : rmorphism to_prime.
Proof.
split=> [x y | ]; last split=> [x y | ].
- have add (a b : 'Z_l) : to_prime (a + b) = to_prime a + to_prime b.
    by rewrite -[a]natr_Zp -[b]natr_Zp -natrD !to_prime_nat natrD.
  by apply: (addIr (to_prime y)); rewrite -add !subrK.
- by rewrite -[x]natr_Zp -[y]natr_Zp -natrM !to_prime_nat natrM.
- by rewrite -[1]/(1%:R) to_prime_nat.
Qed.
Canonical to_prime_additive := Additive to_prime_rmorph.
Canonical to_prime_rmorphism := RMorphism to_prime_rmorph.
End Integral.

(* What holds modulo l, carried to any field that contains the rationals. *)
Section Lifting.
Variables (l : modulus) (L : fieldType) (h : {rmorphism rat -> L}).

Definition into : Zloc l -> L := h \o @Zloc_rat l.
Canonical into_additive := [additive of into].
Canonical into_rmorphism := [rmorphism of into].

Lemma into_eq0 x : (into x == 0) = (x == 0).
Proof. by rewrite /into/= fmorph_eq0 -(rmorph0 [rmorphism of @Zloc_rat l]) (inj_eq (@Zloc_rat_inj l)). Qed.

Lemma into_inj : injective into.
Proof. by move=> x y /eqP; rewrite -subr_eq0 -rmorphB into_eq0 subr_eq0 => /eqP. Qed.

Lemma Zloc_neq0 (x : Zloc l) : residue x \is a GRing.unit -> into x != 0.
Proof. by move=> u; rewrite into_eq0; apply: contraTneq u => ->; rewrite rmorph0 unitr0. Qed.

Lemma map_poly_into (r : {poly Zloc l}) : map_poly into r = map_poly h (map_poly (@Zloc_rat l) r).
Proof. by rewrite -map_poly_comp. Qed.

(* A rank is reached from below: elimination with unit pivots gives X and Y, a minor that is a
   unit gives a selection of rows and its inverse times a selection of columns. *)
Theorem rank_from_below a b r (M : 'M[Zloc l]_(a, b)) (X : 'M['Z_l]_(r, a)) (Y : 'M['Z_l]_(b, r)) :
  X *m map_mx (@residue l) M *m Y = 1%:M -> (r <= \rank (map_mx into M))%N.
Proof.
move=> e; pose X' := map_mx (@representative l) X; pose Y' := map_mx (@representative l) Y.
have d : into (\det (X' *m M *m Y')) != 0.
  apply: Zloc_neq0; rewrite -det_map_mx !map_mxM.
  have -> : map_mx (residue (l:=l)) X' = X by apply/matrixP=> i j; rewrite !mxE representativeK.
  have -> : map_mx (residue (l:=l)) Y' = Y by apply/matrixP=> i j; rewrite !mxE representativeK.
  by rewrite e det1 unitr1.
have : map_mx into (X' *m M *m Y') \in unitmx by rewrite unitmxE det_map_mx unitfE.
rewrite !map_mxM -row_full_unit => /eqP <-.
by rewrite (leq_trans (mxrankM_maxl _ _))// mxrankM_maxr.
Qed.

Theorem rank_from_below_minor a b r (M : 'M[Zloc l]_(a, b)) (i : 'I_r -> 'I_a) (j : 'I_r -> 'I_b) :
  \det (mxsub i j (map_mx (@residue l) M)) \is a GRing.unit -> (r <= \rank (map_mx into M))%N.
Proof.
rewrite -unitmxE => u; apply: (@rank_from_below _ _ _ _ (rowsub i 1%:M)
  (colsub j 1%:M *m invmx (mxsub i j (map_mx (@residue l) M)))).
by rewrite mulmxA mul_rowsub_mx mul1mx mulmx_colsub mulmx1 -mxsubcr mulmxV.
Qed.

Lemma map_resultant_lead (aR rR : ringType) (f : {rmorphism aR -> rR}) (a b : {poly aR}) :
  f (lead_coef a) != 0 -> f (lead_coef b) != 0 ->
  f (resultant a b) = resultant (map_poly f a) (map_poly f b).
Proof.
move=> na nb; rewrite /resultant /Sylvester_mx !size_map_poly_id0//.
rewrite -det_map_mx /= map_col_mx; congr (\det (col_mx _ _));
  by apply: map_lin1_mx => v; rewrite map_poly_rV rmorphM /= map_rVpoly.
Qed.

(* The leading coefficient is a unit modulo l; a monic polynomial is the case that is most used. *)
Definition unit_lead (a : {poly Zloc l}) := residue (lead_coef a) \is a GRing.unit.
Lemma monic_unit_lead a : a \is monic -> unit_lead a.
Proof. by rewrite /unit_lead => /monicP->; rewrite rmorph1 unitr1. Qed.

Lemma coprime_modulo_both (a b : {poly Zloc l}) (u v : {poly 'Z_l}) :
  unit_lead a -> unit_lead b ->
  u * map_poly (@residue l) a + v * map_poly (@residue l) b = 1 ->
  coprimep (map_poly into a) (map_poly into b).
Proof.
move=> ma mb e; pose r : {rmorphism Zloc l -> 'F_l} := [rmorphism of @to_prime l \o @residue l].
have cF : coprimep (map_poly r a) (map_poly r b).
  apply/Bezout_eq1_coprimepP; exists (map_poly (@to_prime l) u, map_poly (@to_prime l) v) => /=.
  by rewrite !map_poly_comp -!rmorphM -rmorphD e rmorph1.
have cop (F : fieldType) (f : {rmorphism Zloc l -> F}) :
    f (lead_coef a) != 0 -> f (lead_coef b) != 0 ->
    coprimep (map_poly f a) (map_poly f b) = (f (resultant a b) != 0).
  move=> na nb; rewrite map_resultant_lead// resultant_eq0 /coprimep ltnNge negbK eqn_leq.
  have nz : map_poly f a != 0.
    by apply: contraNneq na => e0; rewrite lead_coefE -coef_map e0 coef0.
  by rewrite size_poly_gt0 gcdp_eq0 (negPf nz) andbT.
have nr (c : {poly Zloc l}) : unit_lead c -> r (lead_coef c) != 0.
  by move=> uc; rewrite -unitfE; apply: (rmorph_unit [rmorphism of @to_prime l] uc).
have ni (c : {poly Zloc l}) : unit_lead c -> into (lead_coef c) != 0 by apply: Zloc_neq0.
move: cF; rewrite (cop _ r) ?nr// (cop _ into_rmorphism) ?ni// => nres.
by rewrite into_eq0; apply: contraNneq nres => ->; rewrite rmorph0.
Qed.

(* The rule: no common factor modulo l is no common root over any field that contains Q, provided
   that one of the two leading coefficients is a unit modulo l (1 + l x and 1 + l x have no common
   factor modulo l).  A Bezout identity modulo l is what Euclid's algorithm with unit leading
   coefficients yields (euclid_step, euclid_end). *)
Theorem coprime_modulo (a b : {poly Zloc l}) (u v : {poly 'Z_l}) :
  unit_lead a -> u * map_poly (@residue l) a + v * map_poly (@residue l) b = 1 ->
  coprimep (map_poly into a) (map_poly into b).
Proof.
move=> ma e; pose k := size b; pose b' := b + 'X^k * a.
have na : a != 0 by apply: contraTneq ma => ->; rewrite /unit_lead lead_coef0 rmorph0 unitr0.
have lb' : lead_coef b' = lead_coef a.
  have s : size ('X^k * a) = (k + size a)%N.
    by rewrite size_monicM ?monicXn// size_polyXn.
  rewrite /b' lead_coefDr; first by rewrite lead_coef_monicM ?monicXn.
  by rewrite s -[X in (X < _)%N]addn0 ltn_add2l size_poly_gt0.
have := @coprime_modulo_both a b' (u - v * 'X^k) v ma.
rewrite /unit_lead lb' /b' !rmorphD !rmorphM/= !map_polyXn mulrDr mulrBl mulrA addrACA.
rewrite [- _ + _]addrC subrr addr0 => /(_ ma e).
by rewrite addrC coprimep_addl_mul.
Qed.

Theorem no_common_root (a b : {poly Zloc l}) (u v : {poly 'Z_l}) (x : L) :
  unit_lead a -> u * map_poly (@residue l) a + v * map_poly (@residue l) b = 1 ->
  root (map_poly into a) x -> ~~ root (map_poly into b) x.
Proof. by move=> ma e ra; rewrite /root (coprimep_root (coprime_modulo ma e) ra). Qed.
End Lifting.

(* Euclid's algorithm over any commutative ring: a division step keeps, a unit starts. *)
Section Euclid.
Variable R : comUnitRingType.
Definition comaximal (a b : {poly R}) := exists uv, uv.1 * a + uv.2 * b = 1.

Theorem euclid_end (a : {poly R}) c : c \is a GRing.unit -> comaximal a c%:P.
Proof. by move=> uc; exists (0, c^-1%:P); rewrite mul0r add0r -polyCM mulVr. Qed.

Theorem euclid_step (a b q r : {poly R}) : a = q * b + r -> comaximal b r -> comaximal a b.
Proof.
move=> -> [[u v] /= e]; exists (v, u - v * q) => /=.
by rewrite mulrDr mulrBl !mulrA -e addrC addrA subrK.
Qed.
End Euclid.
