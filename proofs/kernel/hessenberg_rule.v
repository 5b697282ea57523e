(* det(xI - A) modulo l, checker/core/arithmetic.py, characteristic_polynomial_modulo: with A L = L H and L Y = I modulo l, H
   zero below its first subdiagonal, it is det(xI - H), which a recursion on the columns of H computes.  L, H and Y are
   prepared outside. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import arithmetic hessenberg.
From mcexact.kernel Require Import lists residues packed.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Definition entry (M : zmat) (i j : nat) : Z := nth z0 (nth [::] M i) j.
(* acc - sum_(j <= i) (h_jk prod b_j ... b_(i-1)) p_j, where ps lists p_i, ..., p_0 *)
Fixpoint zless (l : Z) (H : zmat) (k : nat) (ps : seq zrow) (i : nat) (prod : Z) (acc : zrow) : zrow :=
  if ps is p :: ps' then
    zless l H k ps' i.-1 (Z.modulo (prod * entry H i i.-1) l) (zaxpy (Z.modulo (- (entry H i k * prod)) l) p acc)
  else acc.
(* p_k, ..., p_0: p_(k+1) = x p_k - sum_(i <= k) (h_ik b_i ... b_(k-1)) p_i *)
Fixpoint zcolumns (l : Z) (H : zmat) (k : nat) : seq zrow :=
  if k is k'.+1 then let ps := zcolumns l H k' in zmod l (zless l H k' ps k' 1 (z0 :: head [::] ps)) :: ps else [:: [:: 1%coqZ]].
Local Arguments zaxpy : simpl never.
Definition zchar (l : Z) (H : zmat) (n : nat) : zrow := head [::] (zcolumns l H n).

Record similar := Similar { h_H : zmat; h_L : zmat; h_Y : zmat }.
Definition check_similar (l : Z) (n : nat) (A : zmat) (w : similar) : bool :=
  let: Similar H L Y := w in
  [&& (size L <= n)%N, (size H == n)%N, (size Y <= n)%N, all (fun iH => zrow0 (take iH.1.-1 iH.2)) (zip (iota 0 n) H),
      zmat0_mod l (zmaxpy (-1) (zmm_mod l A L) (zmm_mod l L H)) & zmat0_mod l (zmaxpy (-1) (zidentity 1 n) (zmm_mod l L Y))].

Section Modulus.
Variables (lz : Z) (l1 : (1 < lz)%coqZ).
Notation Zl := [comRingType of 'Z_(modulus_of l1)].
Notation phi := (phi Zl).
Notation pol := (pol Zl).
Notation mx := (mx Zl).
Let l0 := modulus_gt0 l1.
Let pl : phi lz = 0 := phi_modulus l1.

Section Recursion.
Variable H : zmat.
Let h i j := phi (entry H i j).
Let b j := phi (entry H j.+1 j).
Notation P k := (pol (zchar lz H k)).

Lemma zlessE k i prod acc : pol (zless lz H k (zcolumns lz H i) i prod acc) =
  pol acc - \sum_(j < i.+1) (h j k * phi prod * \prod_(j <= t < i) b t) *: P j.
Proof.
elim: i prod acc => [|i IH] prod acc.
  rewrite big_ord1 big_geq // mulr1 /= pol_axpy (phi_mod l0 pl) phiN phiM polyCN mulNr addrC -mul_polyC //.
rewrite [zcolumns _ _ _.+1]/= -/(zcolumns _ _ _) [zless _ _ _ _ _ _ _]/= IH pol_axpy (phi_mod l0 pl) phiN phiM polyCN mulNr.
rewrite [in RHS]big_ord_recr /= big_geq // mulr1 -mul_polyC opprD addrA [in RHS]addrAC; congr (_ + _); last first.
  congr (- _); apply: eq_bigr => j _; congr (_ *: _); rewrite (phi_mod l0 pl) phiM big_nat_recr //=; last by rewrite -ltnS.
  by rewrite -!mulrA; congr (_ * _); congr (_ * _); rewrite mulrC.
by rewrite addrC.
Qed.

Lemma zchar0 : P 0 = 1. Proof. exact: pol_one. Qed.
Lemma zcharS k : P k.+1 = 'X * P k - \sum_(i < k.+1) (h i k * \prod_(i <= t < k) b t) *: P i.
Proof.
rewrite {1}/zchar [zcolumns _ _ _.+1]/= [head _ _]/= (pol_zmod l0 pl) zlessE pol_cons phi0 addr0 mulrC.
by congr (_ - _); apply: eq_bigr => i _; rewrite phi1 mulr1.
Qed.
Theorem zchar_hessenberg n : char_poly (hessenberg h b n) = P n.
Proof. exact: (hessenberg_sequence (p := fun k => P k) zchar0 zcharS). Qed.
End Recursion.

Theorem check_similar_sound n A w : check_similar lz n A w -> char_poly (mx n n A) = pol (zchar lz (h_H w) n).
Proof.
case: w => H L Y /= /and5P[sL /eqP sH sY /(all_nthP (0%N, [::])) low /andP[/(zmat0_modE l0 pl) e1 /(zmat0_modE l0 pl) e2]].
have uL : mx n n L \in unitmx.
  have := e2 n n; rewrite zmaxpyE (zmm_modE l0 pl _ _ _ sY) zidentityE phiN1 scaleN1r phi1 addrC => /eqP; rewrite subr_eq0 => /eqP e.
  exact: (mulmx1_unit e).1.
have HE : mx n n H = hessenberg (fun i j => phi (entry H i j)) (fun j => phi (entry H j.+1 j)) n.
  apply/matrixP=> i j; rewrite !mxE; case: leqP => // ji; case: eqP => [->//|/eqP nij].
  have := low i; rewrite size_zip size_iota sH minnn ltn_ord => /(_ isT); rewrite nth_zip ?size_iota ?sH //= nth_iota // add0n.
  have lt : (j < i.-1)%N by rewrite ltn_predRL ltn_neqAle ji andbT eq_sym.
  by move/(zrow0_nth Zl j); rewrite nth_take.
rewrite -(zchar_hessenberg H) -HE; apply: (hessenberg_similar (s := 1%g) uL).
have -> : \matrix_(i, j) mx n n A ((1%g : {perm 'I_n}) i) ((1%g : {perm 'I_n}) j) = mx n n A by apply/matrixP=> i j; rewrite !mxE !perm1.
have := e1 n n; rewrite zmaxpyE (zmm_modE l0 pl _ _ _ sL) (zmm_modE l0 pl _ _ _ (eq_leq sH)) phiN1 scaleN1r addrC => /eqP; rewrite subr_eq0 => /eqP ->.
by [].
Qed.
End Modulus.
