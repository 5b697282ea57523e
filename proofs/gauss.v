(* Gauss's lemma at a modulus: a monic factor over Q of a monic polynomial whose denominators are prime to l
   has denominators prime to l. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Gauss.
Variable l : modulus.
Notation up := (map_poly (@Zloc_rat l)).

(* A multiple of integers, by a number prime to l. *)
Lemma cleared (c : {poly Zloc l}) : exists2 D : nat, coprime l D &
  exists z : {poly int}, D%:R *: up c = map_poly intr z.
Proof.
pose D := (\prod_(i < size c) `|denq (Zloc_rat (c`_i)%R)|)%N; exists D.
  by apply: (big_rec (coprime l)) => [|i x _ cx]; rewrite ?coprimen1// coprimeMr cx andbT; exact: Zloc_valP.
exists (\poly_(i < size c) numq (D%:R * Zloc_rat c`_i)); apply/polyP=> i.
rewrite coefZ !coef_map coef_poly /=; case: ltnP => [ic|ci]; last first.
  by rewrite nth_default// rmorph0 mulr0.
rewrite /D (bigD1 (Ordinal ic))//= mulnC natrM -mulrA.
set x := Zloc_rat _; have -> : `|denq x|%N%:R * x = (numq x)%:~R.
  by rewrite -[X in X * _]/(`|denq x|%N%:~R) absz_denq mulrC -numqE.
by rewrite -[X in X * _]/((Posz _)%:~R) -rmorphM numq_int.
Qed.

Theorem monic_factor (P : {poly rat}) (c : {poly Zloc l}) : P \is monic -> c \is monic -> P %| up c ->
  exists2 P' : {poly Zloc l}, P' \is monic & P = up P'.
Proof.
move=> mP mc dv; have [D cD [z ez]] := cleared c.
have lz : lead_coef z = D%:Z.
  apply: (@intr_inj [numDomainType of rat]); rewrite -lead_coef_map_inj//; last exact: intr_inj.
  by rewrite -ez lead_coefZ lead_coef_map_inj ?(monicP mc) ?rmorph1 ?mulr1//; apply: Zloc_rat_inj.
have D0 : D != 0%N.
  by apply: contraTneq cD => ->; rewrite coprime_sym /coprime gcd0n gtn_eqF ?modulus_gt1.
have : P %| map_poly intr z by rewrite -ez dvdpZr// pnatr_eq0.
case/dvdpP_rat_int=> p1 [a a0 eP] [r er].
pose k := lead_coef p1; have kD : (k %| D%:Z)%Z by rewrite -lz er lead_coefM dvdz_mulr.
have k0 : k != 0 by apply: contraTneq kD => ->; rewrite dvd0z.
have ck : coprime l `|k| by apply: coprime_dvdr cD; move: kD; rewrite dvdzE.
have ak : a * k%:~R = 1.
  by have /monicP := mP; rewrite eP lead_coefZ lead_coef_map_inj//; apply: intr_inj.
have int i : P`_i \in integral_at l.
  apply/integral_atP; exists `|k|%N => //; exists ((-1) ^+ (k < 0)%R * p1`_i).
  have -> : `|k|%N%:~R = (-1) ^+ (k < 0)%R * k%:~R :> rat.
    by rewrite -[X in X = _]/((Posz _)%:~R) abszEsign rmorphM rmorph_sign.
  rewrite eP coefZ coef_map /= rmorphM rmorph_sign mulrCA; congr (_ * _).
  by rewrite mulrAC ak mul1r.
have eP' : P = up (\poly_(i < size P) insubd (0 : Zloc l) P`_i).
  apply/polyP=> i; rewrite coef_map coef_poly /=; case: ltnP => iP; last by rewrite nth_default// rmorph0.
  by rewrite /Zloc_rat /= insubdK.
exists (\poly_(i < size P) insubd (0 : Zloc l) P`_i) => //; rewrite monicE; apply/eqP.
apply: (@Zloc_rat_inj l); rewrite rmorph1 -lead_coef_map_inj//; last exact: Zloc_rat_inj.
by rewrite -eP' (monicP mP).
Qed.
End Gauss.
