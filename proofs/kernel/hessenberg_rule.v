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
Definition zcolumn (l : Z) (H : zmat) (n : nat) : zrow := head [::] (zcolumns l H n).
(* The same with lists in the place of entries: hs has h_kk, ..., h_0k, bs has b_(k-1), ..., b_0, and of the rows of H the
   first k entries are gone. *)
Fixpoint zless_of (l : Z) (hs bs : zrow) (ps : seq zrow) (prod : Z) (acc : zrow) : zrow :=
  match ps, hs with
  | p :: ps', h :: hs' => zless_of l hs' (behead bs) ps' (Z.modulo (prod * head z0 bs) l) (zaxpy (Z.modulo (- (h * prod)) l) p acc)
  | _, _ => acc end.
Fixpoint zsteps (l : Z) (n : nat) (rows : zmat) (k : nat) (bs : zrow) (ps : seq zrow) : zrow :=
  if n is n'.+1 then
    let hs := rev (map (head z0) (take k.+1 rows)) in
    zsteps l n' (map behead rows) k.+1 (head z0 (nth [::] rows k.+1) :: bs) (zmod l (zless_of l hs bs ps 1 (z0 :: head [::] ps)) :: ps)
  else head [::] ps.
Definition zchar (l : Z) (H : zmat) (n : nat) : zrow := zsteps l n H 0 [::] [:: [:: 1%coqZ]].

Record similar := Similar { h_H : zmat; h_L : zmat; h_Y : zmat }.
Definition check_similar (l : Z) (n : nat) (A : zmat) (w : similar) : bool :=
  let: Similar H L Y := w in
  [&& (size L <= n)%N, (size H == n)%N, (size Y <= n)%N, all (fun iH => zrow0 (take iH.1.-1 iH.2)) (zip (iota 0 n) H),
      zmat0_mod l (zmaxpy (-1) (zmm_mod l A L) (zmm_mod l L H)) & zmat0_mod l (zmaxpy (-1) (zidentity 1 n) (zmm_mod l L Y))].

Section Lists.
Variables (l : Z) (H : zmat).
Notation bs k := [seq entry H j j.-1 | j <- rev (iota 1 k)].
Lemma zless_ofE k i ps prod acc : size ps = i.+1 ->
  zless_of l [seq entry H j k | j <- rev (iota 0 i.+1)] (bs i) ps prod acc = zless l H k ps i prod acc.
Proof.
elim: i ps prod acc => [|i IH] [|p ps] prod acc //= [sp]; first by case: ps sp.
have -> : 0%N :: 1%N :: iota 2 i = iota 0 i.+1 ++ [:: i.+1] by rewrite -(iotaD 0 i.+1 1) addn1.
have -> : 1%N :: iota 2 i = iota 1 i ++ [:: i.+1] by rewrite -(iotaD 1 i 1) addn1.
by rewrite !rev_cat !map_cat /= IH.
Qed.
Lemma size_zcolumns k : size (zcolumns l H k) = k.+1. Proof. by elim: k => //= k ->. Qed.
Lemma zstepsE n k : (k + n <= size H)%N -> zsteps l n [seq drop k r | r <- H] k (bs k) (zcolumns l H k) = zcolumn l H (k + n).
Proof.
elim: n k => [|n IH] k kn; first by rewrite addn0.
have kH : (k < size H)%N by apply: leq_trans kn; rewrite addnS ltnS leq_addr.
rewrite [zsteps _ _ _ _ _ _]/=; have -> : rev (map (head z0) (take k.+1 [seq drop k r | r <- H])) = [seq entry H j k | j <- rev (iota 0 k.+1)].
  rewrite map_rev; congr rev; apply: (@eq_from_nth _ z0); first by rewrite !size_map size_iota size_takel ?size_map.
  move=> j; rewrite size_map size_takel ?size_map // => jk; have jH := leq_trans jk kH.
  rewrite (nth_map [::]) ?size_takel ?size_map // nth_take // (nth_map [::]) // -nth0 nth_drop addn0 (nth_map 0%N) ?size_iota //.
  by rewrite nth_iota.
rewrite (zless_ofE _ _ _ (size_zcolumns k)) -addSnnS -IH ?addSnnS //; congr (zsteps _ _ _ _ _ _).
  by rewrite -map_comp; apply: eq_map => r; rewrite /= -drop1 drop_drop add1n.
have -> : iota 1 k.+1 = iota 1 k ++ [:: k.+1] by rewrite -(iotaD 1 k 1) addn1.
rewrite rev_cat map_cat /=; congr (_ :: _); rewrite -nth0 /entry.
have [H1|H1] := ltnP k.+1 (size H); first by rewrite (nth_map [::]) // nth_drop addn0.
by rewrite !nth_default ?size_map.
Qed.
Lemma zcharE n : (n <= size H)%N -> zchar l H n = zcolumn l H n.
Proof. by move=> nH; rewrite -(@zstepsE n 0) //; congr (zsteps _ _ _ _ _ _); rewrite -[LHS]map_id; apply: eq_map => r; rewrite drop0. Qed.
End Lists.

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
Notation P k := (pol (zcolumn lz H k)).

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
rewrite {1}/zcolumn [zcolumns _ _ _.+1]/= [head _ _]/= (pol_zmod l0 pl) zlessE pol_cons phi0 addr0 mulrC.
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
rewrite zcharE ?sH // -(zchar_hessenberg H) -HE; apply: (hessenberg_similar (s := 1%g) uL).
have -> : \matrix_(i, j) mx n n A ((1%g : {perm 'I_n}) i) ((1%g : {perm 'I_n}) j) = mx n n A by apply/matrixP=> i j; rewrite !mxE !perm1.
have := e1 n n; rewrite zmaxpyE (zmm_modE l0 pl _ _ _ sL) (zmm_modE l0 pl _ _ _ (eq_leq sH)) phiN1 scaleN1r addrC => /eqP; rewrite subr_eq0 => /eqP ->.
by [].
Qed.
End Modulus.
