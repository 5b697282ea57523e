(* What a list stands for modulo l, where l is prime to its denominator.

   `local` is the matrix of rationals with denominators prime to l: its residues are the list times the inverse of the
   denominator, and over every field it is the matrix that the list represents.  The theorems of krylov.v and its like
   are about such matrices. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic fixed_bound.
From mcexact.kernel Require Import lists systems.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* l is a modulus, and i the inverse of d modulo l. *)
Definition inverse_modulo (l d i : Z) : bool := Z.ltb 1 l && Z.eqb (Z.modulo (i * d) l) 1.
Definition reduced l i (ch : zchannel) := ZChannel (zp ch) (zq ch) (zscale_mod l i (zB ch)) (zscale_mod l i (zC ch)).

Lemma shape_scale a b l k M : shape a b (zscale_mod l k M) = shape a b M.
Proof.
rewrite /shape /zscale_mod size_map all_map; congr (_ && _); apply: eq_all => r /=.
by rewrite size_map.
Qed.

Lemma to_nat_gt1 lz : (1 < lz)%coqZ -> (1 < Z.to_nat lz)%N.
Proof. by move=> l1; apply/ltP; rewrite -[1%N]/(Z.to_nat 1); apply/Z2Nat.inj_lt => //; apply: Z.lt_le_incl; apply: Z.lt_trans l1. Qed.
Definition modulus_of lz (l1 : (1 < lz)%coqZ) : modulus := Modulus (to_nat_gt1 l1).

Section Modulus.
Variables (lz : Z) (l1 : (1 < lz)%coqZ).
Notation l := (modulus_of l1).
Notation Zl := [comRingType of 'Z_l].
Lemma modulus_gt0 : (0 < lz)%coqZ. Proof. exact: Z.lt_trans l1. Qed.
Lemma phi_modulus : phi Zl lz = 0. Proof. exact: (residue_modulus _ modulus_gt0). Qed.
Lemma residue_phi z : residue (phi [comRingType of Zloc l] z) = phi Zl z. Proof. exact: map_phi. Qed.
Lemma residue_mx a b M : map_mx (@residue l) (mx [comRingType of Zloc l] a b M) = mx Zl a b M.
Proof. exact: map_mx_mx. Qed.
Lemma residue_pol v : map_poly (@residue l) (pol [comRingType of Zloc l] v) = pol Zl v.
Proof. exact: map_pol. Qed.
Lemma into_pol (K : fieldType) (h : {rmorphism rat -> K}) v : map_poly (into h) (pol [comRingType of Zloc l] v) = pol [comRingType of K] v.
Proof. exact: map_pol. Qed.

Section Denominator.
Variables (d i : Z).
Hypotheses (d0 : (0 < d)%coqZ) (inv : ((i * d) mod lz = 1)%coqZ).

Definition ratz (z : Z) : rat := (int_of_Z z)%:~R / (int_of_Z d)%:~R.
Lemma inverse_unit : phi Zl i * phi Zl d = 1.
Proof. by rewrite -phiM -(phi_mod modulus_gt0 phi_modulus) inv. Qed.
Let dn := Z.to_nat d.
Fact denominatorE : int_of_Z d = dn.
Proof. by rewrite -[in LHS](Z2Nat.id d) ?int_of_Z_nat //; exact: Z.lt_le_incl. Qed.
Fact inverse1 : phi Zl i * dn%:R = 1.
Proof. by rewrite -[RHS]inverse_unit [phi _ d]/phi denominatorE. Qed.
Fact coprime_denominator : coprime l dn.
Proof.
have: (dn%:R : 'Z_l) \is a GRing.unit by apply/unitrPr; exists (phi Zl i); rewrite mulrC inverse1.
by rewrite (@unitZpE l dn (modulus_gt1 l)).
Qed.
Fact denominator_neq0 : (dn%:~R : rat) != 0.
Proof.
rewrite intr_eq0; apply: contraTneq coprime_denominator => -[->].
by rewrite /coprime gcdn0 neq_ltn (modulus_gt1 l) orbT.
Qed.
Fact ratz_times z : ratz z * dn%:~R = (int_of_Z z)%:~R.
Proof. by rewrite /ratz denominatorE divfK // denominator_neq0. Qed.
Fact ratz_integral z : ratz z \in integral_at l.
Proof. by apply/integral_atP; exists dn; [exact: coprime_denominator | exists (int_of_Z z); exact: ratz_times]. Qed.

Definition local a b (M : zmat) : 'M[Zloc l]_(a, b) := \matrix_(r, t) ToZloc (ratz_integral (nth z0 (nth [::] M r) t)).
Lemma residue_local a b M : map_mx (@residue l) (local a b M) = mx Zl a b (zscale_mod lz i M).
Proof.
rewrite (zscaleE modulus_gt0 phi_modulus); apply/matrixP=> r t; rewrite !mxE /residue /=.
set z := nth _ _ _; have e := residue_ratE coprime_denominator (ratz_times z).
by rewrite -[LHS]mulr1 -inverse1 mulrCA e.
Qed.
Lemma into_local (K : fieldType) (h : {rmorphism rat -> K}) a b M : map_mx h (map_mx (@Zloc_rat l) (local a b M)) = over K d a b M.
Proof.
apply/matrixP=> r t; rewrite !mxE /Zloc_rat /= /ratz fmorph_div !rmorph_int /phi mulrC //.
Qed.

Section System.
Variables (s : zsystem) (n m : nat) (p q : 'I_m -> nat).
Definition local_system : multichannel (Zloc l) n p q :=
  Multichannel (local n n (zA s)) (fun k => local n (p k) (zB (channel s k))) (fun k => local (q k) n (zC (channel s k))).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (S : multichannel K n p q).
Hypotheses (re : represents s S) (ds : zD s = d).
Notation SL := (map_system h (map_system (@Zloc_rat l) local_system)).
Lemma local_loop F : closed_loop SL F = closed_loop S F.
Proof.
case: re => _ _ _ _ _ eA eB eC; rewrite /closed_loop eA /= into_local ds; congr (_ + _).
by apply: eq_bigr => k _; rewrite eB eC /= !into_local ds.
Qed.
Lemma local_bounded L : bounded SL L -> bounded S L.
Proof. by apply: bounded_loops => F; exists F; rewrite local_loop. Qed.
End System.
End Denominator.
End Modulus.
