(* Rule Coprime, checker/core/evidence.py, require_coprime: u p + v q = 1 modulo l, and the last coefficient of p is a unit.
   Then p and q have no common root over any field that contains Q. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic.
From mcexact.kernel Require Import lists residues.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Record bezout := Bezout { z_ell : Z; z_inv : Z; z_u : zrow; z_v : zrow }.
(* u p + v q = 1 modulo l *)
Definition bezout_modulo (l : Z) (u p v q : zrow) : bool :=
  zero_mod l (zaxpy (-1) [:: 1%coqZ] (zaxpy 1 (zpmul u p) (zpmul v q))).
Definition check_coprime (p q : zrow) (c : bezout) : bool :=
  inverse_modulo (z_ell c) (last z0 p) (z_inv c) && bezout_modulo (z_ell c) (z_u c) p (z_v c) q.

Lemma bezout_moduloP lz (l1 : (1 < lz)%coqZ) u p v q : bezout_modulo lz u p v q ->
  pol [comRingType of 'Z_(modulus_of l1)] u * pol _ p + pol _ v * pol _ q = 1.
Proof.
move=> ok; have := pol_zero (modulus_gt0 l1) (phi_modulus l1) ok.
rewrite !pol_axpy !pol_mul phi1 mul1r pol_one => /eqP; rewrite addr_eq0 => /eqP e.
by apply: oppr_inj; rewrite -e phiN1 mulr1 polyCN.
Qed.

Theorem check_coprime_sound p q c : check_coprime p q c ->
  forall (K : fieldType) (h : {rmorphism rat -> K}), coprimep (pol [comRingType of K] p) (pol [comRingType of K] q).
Proof.
case/andP=> /andP[/Z.ltb_lt l1 /Z.eqb_eq inv] /(bezout_moduloP l1) b1 K h.
have u1 : phi [comRingType of 'Z_(modulus_of l1)] (last z0 p) \is a GRing.unit.
  by apply/unitrPr; exists (phi _ (z_inv c)); rewrite mulrC (inverse_unit l1 inv).
have nz : phi [comRingType of Zloc (modulus_of l1)] (last z0 p) != 0.
  by apply: contraTneq u1 => e; rewrite -(residue_phi l1) e rmorph0 unitr0.
have ul : unit_lead (pol [comRingType of Zloc (modulus_of l1)] p) by rewrite /unit_lead lead_pol // residue_phi.
rewrite -!(residue_pol l1) in b1; by have := coprime_modulo h ul b1; rewrite !into_pol.
Qed.
