(* Rule Spectrum, checker/core/arithmetic.py, characteristic_polynomial: det(xI - A) over Q.

   Row i of A times the integer d_i > 0 is a row of integers N.  The coefficients of prod d_i times det(xI - A) are then
   integers of absolute value at most prod (d_i + sum_j |N_ij|), so they are known from their residues modulo enough l. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic closed_loop_spectrum.
From mcexact.kernel Require Import lists systems residues hessenberg_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Definition zprod (ds : zrow) : Z := foldr Z.mul 1%coqZ ds.
Definition zabs_sum (r : zrow) : Z := foldr (fun x acc => Z.abs x + acc)%coqZ z0 r.
Definition zbound (ds : zrow) (N : zmat) : Z := zprod [seq (dr.1 + zabs_sum dr.2)%coqZ | dr <- zip ds N].
(* A modulus; the inverses of the denominator of A, of prod d_i and of the product of the moduli before; and H, L, Y. *)
Record residue_witness := ResidueWitness { m_ell : Z; m_inv : Z; m_scale : Z; m_before : Z; m_similar : similar }.
Definition no_residue := ResidueWitness z0 z0 z0 z0 (Similar [::] [::] [::]).
Record spectrum_witness := SpectrumWitness { s_ds : zrow; s_N : zmat; s_moduli : seq residue_witness }.
Definition check_residue (n : nat) (d : Z) (A : zmat) (scale : Z) (f : zrow) (before : Z) (w : residue_witness) : bool :=
  let l := m_ell w in
  let A' := zscale_mod l (m_inv w) A in
  [&& inverse_modulo l d (m_inv w), inverse_modulo l scale (m_scale w), inverse_modulo l before (m_before w),
      check_similar l n A' (m_similar w) & zero_mod l (zaxpy (- scale) (zchar l (h_H (m_similar w)) n) f)].
Fixpoint check_residues n d A scale f before (ws : seq residue_witness) : bool :=
  if ws is w :: ws' then check_residue n d A scale f before w && check_residues n d A scale f (before * m_ell w)%coqZ ws' else true.
(* det(xI - A) is f over its last coefficient, A over the denominator d. *)
Definition check_spectrum (n : nat) (d : Z) (A : zmat) (f : zrow) (w : spectrum_witness) : bool :=
  let: (ds, N) := (s_ds w, s_N w) in
  let: (scale, bound) := (zprod ds, zbound ds N) in
  [&& Z.ltb 0 d, shape n n A, shape n n N, size ds == n, all (fun x => Z.ltb 0 x) ds &
  [&& all (fun dAN => zrow0 (zaxpy (- d) dAN.2.2 (zaxpy dAN.1 dAN.2.1 [::]))) (zip ds (zip A N)),
      size f == n.+1, Z.eqb (last z0 f) scale, all (fun x => Z.leb (Z.abs x) bound) f,
      Z.ltb (2 * bound)%coqZ (zprod [seq m_ell v | v <- s_moduli w]) & check_residues n d A scale f 1 (s_moduli w)]]%N.

Lemma int_of_Z_ge0 z : (0 <= z)%coqZ -> 0 <= int_of_Z z. Proof. by case: z. Qed.
Lemma int_of_Z_le a b : (a <= b)%coqZ -> int_of_Z a <= int_of_Z b.
Proof. by move=> ab; rewrite -subr_ge0 -int_of_ZN -int_of_ZD; apply/int_of_Z_ge0/Z.le_0_sub. Qed.
Lemma int_of_Z_lt a b : (a < b)%coqZ -> int_of_Z a < int_of_Z b.
Proof. by move=> ab; rewrite -lez_addr1 -[1]/(int_of_Z 1) -int_of_ZD; apply/int_of_Z_le/Z.le_succ_l. Qed.
Lemma int_of_Z_abs z : int_of_Z (Z.abs z) = `|int_of_Z z|%N.
Proof.
case: z => [//|p|p] //=; by rewrite (prednK (introT ssrnat.ltP (Pos2Nat.is_pos p))).
Qed.
Lemma to_natE z : (0 <= z)%coqZ -> int_of_Z z = Z.to_nat z. Proof. by move=> z_ge0; rewrite -[in LHS](Z2Nat.id z z_ge0) int_of_Z_nat. Qed.
Lemma zprodE ds : int_of_Z (zprod ds) = \prod_(i < size ds) int_of_Z (nth z0 ds i).
Proof. by elim: ds => [|d ds IH]; rewrite ?big_ord0 // big_ord_recl /= int_of_ZM IH. Qed.
Lemma zprod_rcons s x : zprod (rcons s x) = (zprod s * x)%coqZ.
Proof.
elim: s => [|y s IH]; first by rewrite [LHS]Z.mul_1_r [RHS]Z.mul_1_l.
by rewrite -[LHS]/(y * zprod (rcons s x))%coqZ IH Z.mul_assoc.
Qed.
Lemma zabs_sumE r b : size r = b -> int_of_Z (zabs_sum r) = \sum_(j < b) `|int_of_Z (nth z0 r j)|%N%:Z.
Proof.
elim: r b => [|x r IH] [|b] //=; first by rewrite big_ord0.
by case=> /IH e; rewrite big_ord_recl /= int_of_ZD int_of_Z_abs e.
Qed.

Section Spectrum.
Variables (n : nat) (d : Z) (A : zmat) (f : zrow) (w : spectrum_witness).
Definition rational_matrix : 'M[rat]_n := over [fieldType of rat] d n n A.

Theorem check_spectrum_rat : check_spectrum n d A f w -> char_poly rational_matrix = up [fieldType of rat] f.
Proof.
case: w => ds N ws; rewrite /check_spectrum; cbn [s_ds s_N s_moduli]; set scale := zprod ds; set bound := zbound ds N.
case/and5P=> /Z.ltb_lt d0 sA sN /eqP sds /andP[/(all_nthP z0) dpos] /and5P[/(all_nthP (z0, ([::], [::]))) rows /eqP sf /Z.eqb_eq lf /(all_nthP z0) small].
case/andP=> /Z.ltb_lt enough oks.
have dp (i : 'I_n) : (0 < nth z0 ds i)%coqZ by apply/Z.ltb_lt/dpos; rewrite sds.
pose dn (i : 'I_n) := Z.to_nat (nth z0 ds i); have dnE (i : 'I_n) : int_of_Z (nth z0 ds i) = dn i by apply/to_natE/Z.lt_le_incl.
pose M : 'M[int]_n := \matrix_(i, j) int_of_Z (entry N i j).
have dn0 i : (0 < dn i)%N by rewrite -ltz_nat -dnE; apply: (int_of_Z_lt (dp i)).
have scaleE : int_of_Z scale = closed_loop_spectrum.scale dn.
  rewrite zprodE sds /closed_loop_spectrum.scale (big_morph Posz PoszM (erefl 1%:Z)).
  by apply: eq_bigr => i _; rewrite dnE.
have boundE : int_of_Z bound = closed_loop_spectrum.bound dn M.
  rewrite /bound /zbound zprodE size_map size_zip sds (shape_size sN) minnn /closed_loop_spectrum.bound (big_morph Posz PoszM (erefl 1%:Z)).
  apply: eq_bigr => i _; rewrite (nth_map (z0, [::])) ?size_zip ?sds ?(shape_size sN) ?minnn // nth_zip ?sds ?(shape_size sN) //=.
  rewrite int_of_ZD dnE PoszD (zabs_sumE (row_size sN (ltn_ord i))) (big_morph Posz PoszD (erefl 0%:Z)).
  by congr (_ + _); apply: eq_bigr => j _; rewrite mxE.
have phi_int z : phi [comRingType of rat] z = (int_of_Z z)%:~R by [].
have dq : phi [comRingType of rat] d != 0.
  by rewrite (phi_neq0 [rmorphism of @idfun rat]) //; apply/negP => /Z.eqb_eq e; rewrite e in d0.
have dA i j : (dn i)%:R * rational_matrix i j = (M i j)%:~R.
  rewrite overE !mxE; have := rows i; rewrite !size_zip sds (shape_size sA) (shape_size sN) !minnn ltn_ord => /(_ isT).
  rewrite !nth_zip ?size_zip ?sds ?(shape_size sA) ?(shape_size sN) ?minnn //= => /(zrow0_nth [comRingType of rat] j).
  rewrite !zaxpy_nth nth_nil phi0 addr0 phiN mulNr addrC => /eqP; rewrite subr_eq0 => /eqP e.
  rewrite mulrCA pmulrn -dnE -phi_int e mulrA mulVf // mul1r; by [].
pose p := up [fieldType of rat] f.
have scale0 : closed_loop_spectrum.scale dn != 0%N by rewrite -lt0n prodn_gt0.
have pE k : (closed_loop_spectrum.scale dn)%:R * p`_k = (int_of_Z (nth z0 f k))%:~R.
  by rewrite upE lf phi_int scaleE -pmulrn mulrA mulfV ?mul1r // pnatr_eq0.
pose r := size ws; pose wit k := nth no_residue ws k.
have wsP k before : check_residues n d A scale f before (drop k ws) -> (k < r)%N ->
    check_residue n d A scale f before (wit k) /\
    check_residues n d A scale f (before * m_ell (wit k))%coqZ (drop k.+1 ws).
  by move=> ok kr; move: ok; rewrite (drop_nth no_residue kr) /= => /andP[].
pose before k := zprod [seq m_ell v | v <- take k ws].
have each k : (k < r)%N -> check_residue n d A scale f (before k) (wit k).
  suff both j : (j <= r)%N -> check_residues n d A scale f (before j) (drop j ws).
    by move=> kr; case: (wsP _ _ (both k (ltnW kr)) kr).
  elim: j => [_|j IH jr]; first by rewrite drop0 /before take0.
  have [_] := wsP _ _ (IH (ltnW jr)) jr.
  by rewrite /before (take_nth no_residue jr) map_rcons zprod_rcons.
have ell1 (a : 'I_r) : (1 < m_ell (wit a))%coqZ.
  by have /andP[/andP[/Z.ltb_lt]] := each a (ltn_ord a).
pose ell (a : 'I_r) := modulus_of (ell1 a).
have ellE (a : 'I_r) : int_of_Z (m_ell (wit a)) = ell a.
  by rewrite to_natE //; apply/Z.lt_le_incl/(modulus_gt0 (ell1 a)).
have beforeE k : (k <= r)%N -> int_of_Z (before k) = (\prod_(b < r | (b < k)%N) ell b)%N.
  elim: k => [_|k IH kr]; first by rewrite big_pred0 // /before take0.
  rewrite /before (take_nth no_residue kr) map_rcons zprod_rcons int_of_ZM -/(before k) -/(wit k) IH ?(ltnW kr) //.
  rewrite [in RHS](bigD1 (Ordinal kr)) //= PoszM mulrC -(ellE (Ordinal kr)); congr (_ * Posz _).
  by apply: eq_bigl => b; rewrite -val_eqE /= ltnS [(b < k)%N]ltn_neqAle andbC.
have inv_coprime (a : 'I_r) x i : (0 < x)%coqZ -> inverse_modulo (m_ell (wit a)) x i -> coprime (ell a) (Z.to_nat x).
  by move=> x0 /andP[_ /Z.eqb_eq inv]; apply: (coprime_denominator (ell1 a) x0 inv).
have scale_pos : (0 < scale)%coqZ.
  have : 0 < int_of_Z scale by rewrite scaleE ltz_nat lt0n.
  by case: (scale).
have before_pos k : (k <= r)%N -> (0 < before k)%coqZ.
  move=> kr; have : 0 < int_of_Z (before k) by rewrite beforeE // ltz_nat prodn_gt0 // => a; apply: ltnW; apply: modulus_gt1.
  by case: (before k).
have parts (a : 'I_r) := each a (ltn_ord a).
rewrite -/p; apply: (@spectrum_by_residues n r ell rational_matrix p dn M dn0 dA).
- move=> k; exists (int_of_Z (nth z0 f k)); first exact: pE.
  have [kf|kf] := ltnP k (size f); last by rewrite nth_default.
  by rewrite -lez_nat -int_of_Z_abs -boundE; apply/int_of_Z_le/Z.leb_le/small.
- move=> a; have /and5P[_ _ ib _ _] := parts a; have := inv_coprime a _ _ (before_pos a (ltnW (ltn_ord a))) ib.
  rewrite coprime_sym; suff -> : Z.to_nat (before a) = (\prod_(b < r | (b < a)%N) ell b)%N by [].
  apply/eqP; rewrite -eqz_nat -beforeE ?(ltnW (ltn_ord a)) // to_natE //; exact/Z.lt_le_incl/before_pos/ltnW.
- have := int_of_Z_lt enough; rewrite int_of_ZM boundE -ltz_nat PoszM => /lt_le_trans; apply.
  have := beforeE r (leqnn r); rewrite /before take_size => ->; rewrite lez_nat leq_eqVlt; apply/orP; left; apply/eqP.
  by apply: eq_bigl => b; rewrite ltn_ord.
- move=> a; have /and5P[_ isc _ _ _] := parts a; have := inv_coprime a _ _ scale_pos isc.
  suff -> : Z.to_nat scale = closed_loop_spectrum.scale dn by [].
  by apply/eqP; rewrite -eqz_nat -scaleE to_natE //; apply/Z.lt_le_incl.
move=> a; have /and5P[/andP[_ /Z.eqb_eq invd] /andP[_ /Z.eqb_eq invs] _ okS agree] := parts a.
pose Zl := [comRingType of 'Z_(ell a)].
have -> : map_mx (residue_rat (ell a)) rational_matrix = mx Zl n n (zscale_mod (m_ell (wit a)) (m_inv (wit a)) A).
  rewrite -(residue_local (ell1 a) d0 invd); apply/matrixP=> i j; rewrite [LHS]mxE [RHS]mxE /residue; congr residue_rat.
  by rewrite [in RHS]mxE /Zloc_rat /= overE /ratz mulrC.
rewrite (check_similar_sound (ell1 a) okS); apply/polyP=> k; rewrite coef_poly polE.
have cop := coprime_denominator (ell1 a) scale_pos invs.
have res0 (x : rat) : (int_of_Z (nth z0 f k))%:~R = (closed_loop_spectrum.scale dn)%:R * x ->
    phi Zl scale * residue_rat (ell a) x = phi Zl (nth z0 f k).
  move=> e; have ns : Z.to_nat scale = closed_loop_spectrum.scale dn.
    by apply/eqP; rewrite -eqz_nat -scaleE to_natE //; apply/Z.lt_le_incl.
  have e2 : x * (Z.to_nat scale)%:~R = (int_of_Z (nth z0 f k))%:~R by rewrite e mulrC ns pmulrn.
  by have e3 := residue_ratE cop e2; rewrite /phi -e3 scaleE ns mulrC pmulrn.
have e1 := res0 _ (esym (pE k)).
have := zmod_nth (modulus_gt0 (ell1 a)) (phi_modulus (ell1 a)) (zaxpy (- scale) (zchar (m_ell (wit a)) (h_H (m_similar (wit a))) n) f) k.
have -> : phi Zl (nth z0 (zmod (m_ell (wit a)) (zaxpy (- scale) (zchar (m_ell (wit a)) (h_H (m_similar (wit a))) n) f)) k) = 0.
  have /(all_nthP z0) ag := agree; rewrite zmod_nth ?phi_modulus //; last exact: modulus_gt0.
  set v := zaxpy _ _ _ in ag *; have [kv|kv] := ltnP k (size v); last by rewrite nth_default.
  by apply: (phi_eq0 (modulus_gt0 (ell1 a)) (phi_modulus (ell1 a))); apply: ag.
rewrite zaxpy_nth phiN mulNr addrC => /esym/eqP; rewrite subr_eq0 => /eqP e2.
have us : phi Zl scale \is a GRing.unit by apply/unitrPr; exists (phi Zl (m_scale (wit a))); rewrite mulrC (inverse_unit (ell1 a) invs).
apply: (mulrI us); rewrite -e2 -e1; case: ltnP => // kp; rewrite nth_default // /residue_rat mul0r //.
Qed.

Theorem check_spectrum_sound : check_spectrum n d A f w -> forall (K : fieldType) (h : {rmorphism rat -> K}),
  char_poly (over K d n n A) = up K f.
Proof.
move=> ok K h; have e := check_spectrum_rat ok.
have -> : over K d n n A = map_mx h rational_matrix.
  by apply/matrixP=> i j; rewrite overE mxE overE rmorphM fmorphV !map_phi.
by rewrite -map_char_poly e /up map_polyZ fmorphV map_phi map_pol.
Qed.
End Spectrum.
