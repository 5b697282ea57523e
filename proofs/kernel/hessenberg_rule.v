(* det(xI - A) modulo l, checker/core/arithmetic.py, characteristic_polynomial_modulo: with A L = L H modulo l, L unit lower
   triangular but for the order of its rows, and H zero below its first subdiagonal, it is det(xI - H), which a recursion
   on the columns of H computes.  L, the order and H are prepared outside.

   Each polynomial of the recursion is one integer, as the rows in packed.v are. *)
From Coq Require Import ZArith Lia.
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import arithmetic hessenberg.
From mcexact.kernel Require Import lists residues packed.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* From hs, which has h_kk, ..., h_0k, and bs, which has b_(k-1), ..., b_0: the - h_ik b_i ... b_(k-1) for i = k, ..., 0. *)
Fixpoint zweights (l : Z) (hs bs : zrow) (prod : Z) : zrow :=
  if hs is h :: hs' then Z.modulo (- (h * prod)) l :: zweights l hs' (behead bs) (Z.modulo (prod * head z0 bs) l) else [::].
(* p_(k+1) = x p_k - sum_(i <= k) (h_ik b_i ... b_(k-1)) p_i; p is p_k, and ps has p_k, ..., p_0 in one integer each. *)
Definition znext (l w : Z) (levels : seq (Z * Z)) (k : nat) (hs bs p ps : zrow) : zrow :=
  zmod l (take k.+2 (zunpack levels (zcombined (zpack w (z0 :: p)) (zweights l hs bs 1) ps))).
(* Of the rows of H the first k entries are gone. *)
Fixpoint zsteps (l w : Z) (levels : seq (Z * Z)) (n : nat) (rows : zmat) (k : nat) (bs p ps : zrow) : zrow :=
  if n is n'.+1 then
    let next := znext l w levels k (rev (map (head z0) (take k.+1 rows))) bs p ps in
    zsteps l w levels n' (map behead rows) k.+1 (head z0 (nth [::] rows k.+1) :: bs) next (zpack w next :: ps)
  else p.
Definition zwidth (l : Z) (n : nat) : Z := (Z.log2 (Z.of_nat n.+1 * (l * l)) + 1)%coqZ.
Definition zchar (l : Z) (H : zmat) (n : nat) : zrow :=
  let w := zwidth l n in zsteps l w (zlevels w (up_log 2 n.+1)) n H 0 [::] [:: 1%coqZ] [:: 1%coqZ].

(* Row i of the order is the row of L that has its last entry other than 0 in column i. *)
Record similar := Similar { h_H : zmat; h_L : zmat; h_order : seq nat }.
Definition unit_row (r : zrow) (i : nat) : bool := Z.eqb (nth z0 r i) 1 && zrow0 (drop i.+1 r).
Definition check_similar (l : Z) (n : nat) (A : zmat) (w : similar) : bool :=
  let: Similar H L order := w in
  [&& (size L <= n)%N, (size H == n)%N, all (fun k => (k < n)%N) order, all (fun iH => zrow0 (take iH.1.-1 iH.2)) (zip (iota 0 n) H) &
      all (fun i => unit_row (nth [::] L (nth 0%N order i)) i) (iota 0 n) && zmat0_mod l (zmaxpy (-1) (zmm_mod l A L) (zmm_mod l L H))].

Definition entry (M : zmat) (i j : nat) : Z := nth z0 (nth [::] M i) j.
Section Lists.
Variables (l w : Z) (levels : seq (Z * Z)) (H : zmat).
Notation hs k := [seq entry H j k | j <- rev (iota 0 k.+1)].
Notation bs k := [seq entry H j j.-1 | j <- rev (iota 1 k)].
(* p_k, ..., p_0 *)
Fixpoint zcolumns (k : nat) : seq zrow :=
  if k is k'.+1 then let ps := zcolumns k' in znext l w levels k' (hs k') (bs k') (head [::] ps) (map (zpack w) ps) :: ps else [:: [:: 1%coqZ]].
Definition zpower (k : nat) : zrow := head [::] (zcolumns k).
Lemma size_zcolumns k : size (zcolumns k) = k.+1. Proof. by elim: k => //= k ->. Qed.
Lemma nth_zcolumns k j : (j <= k)%N -> nth [::] (zcolumns k) j = zpower (k - j).
Proof. by elim: k j => [|k IH] [|j] // jk; rewrite subSS -IH. Qed.
Lemma zstepsE n k : (k + n <= size H)%N ->
  zsteps l w levels n [seq drop k r | r <- H] k (bs k) (zpower k) (map (zpack w) (zcolumns k)) = zpower (k + n).
Proof.
elim: n k => [|n IH] k kn; first by rewrite addn0.
have kH : (k < size H)%N by apply: leq_trans kn; rewrite addnS ltnS leq_addr.
rewrite [zsteps _ _ _ _ _ _ _ _ _]/=; have -> : rev (map (head z0) (take k.+1 [seq drop k r | r <- H])) = hs k.
  rewrite map_rev; congr rev; apply: (@eq_from_nth _ z0); first by rewrite !size_map size_iota size_takel ?size_map.
  move=> j; rewrite size_map size_takel ?size_map // => jk; have jH := leq_trans jk kH.
  rewrite (nth_map [::]) ?size_takel ?size_map // nth_take // (nth_map [::]) // -nth0 nth_drop addn0 (nth_map 0%N) ?size_iota //.
  by rewrite nth_iota.
rewrite -addSnnS -IH ?addSnnS //; congr (zsteps _ _ _ _ _ _ _ _ _).
  by rewrite -map_comp; apply: eq_map => r; rewrite /= -drop1 drop_drop add1n.
have -> : iota 1 k.+1 = iota 1 k ++ [:: k.+1] by rewrite -(iotaD 1 k 1) addn1.
rewrite rev_cat map_cat /=; congr (_ :: _); rewrite -nth0 /entry.
have [H1|H1] := ltnP k.+1 (size H); first by rewrite (nth_map [::]) // nth_drop addn0.
by rewrite !nth_default ?size_map.
Qed.
Lemma size_zpower k : (size (zpower k) <= k.+1)%N.
Proof. by case: k => [//|k]; rewrite /zpower /= size_map size_take; case: ltnP. Qed.
Lemma zpower_range k i : (1 < l)%coqZ -> (0 <= nth z0 (zpower k) i < l)%coqZ.
Proof.
move=> l1; case: k => [|k]; first by case: i => [|i] /=; rewrite ?nth_nil; lia.
by apply: nth_mod; lia.
Qed.
Lemma size_zweights us vs prod : size (zweights l us vs prod) = size us. Proof. by elim: us vs prod => //= u us IH vs prod; rewrite IH. Qed.
Lemma zweights_range us vs prod i : (0 < l)%coqZ -> (0 <= nth z0 (zweights l us vs prod) i < l)%coqZ.
Proof. by move=> l0; elim: us vs prod i => [|u us IH] vs prod [|i] /=; rewrite ?nth_nil; try lia; [apply: Z.mod_pos_bound | apply: IH]. Qed.
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
Variables (H : zmat) (n : nat).
Let h i j := phi (entry H i j).
Let b j := phi (entry H j.+1 j).
Let w := zwidth lz n.
Notation levels := (zlevels w (up_log 2 n.+1)).
Notation power := (zpower lz w levels H).
Notation columns := (zcolumns lz w levels H).

Lemma zweightsE us vs prod j : (j < size us)%N ->
  phi (nth z0 (zweights lz us vs prod) j) = - (phi (nth z0 us j) * phi prod * \prod_(t < j) phi (nth z0 vs t)).
Proof.
elim: us vs prod j => [//|u us IH] vs prod [|j] /= jus; first by rewrite big_ord0 mulr1 (phi_mod l0 pl) phiN phiM.
rewrite IH // (phi_mod l0 pl) phiM big_ord_recl -nth0 !mulrA; congr (- (_ * _)).
by apply: eq_bigr => t _; rewrite nth_behead.
Qed.
Lemma zpowerS k : (k < n)%N -> pol (power k.+1) = 'X * pol (power k) - \sum_(i < k.+1) (h i k * \prod_(i <= t < k) b t) *: pol (power i).
Proof.
move=> kn; have -> : power k.+1 = znext lz w levels k [seq entry H j k | j <- rev (iota 0 k.+1)] [seq entry H j j.-1 | j <- rev (iota 1 k)] (power k) (map (zpack w) (columns k)) by [].
have w0 : (0 < w)%coqZ by rewrite /w /zwidth; have := Z.log2_nonneg (Z.of_nat n.+1 * (lz * lz)); lia.
rewrite /znext (zcombinedE w0) (pol_zmod l0 pl).
set us := zweights _ _ _ _; set v := zaxpy 1 (zvm us (columns k)) (z0 :: power k).
have -> : (zpack w (z0 :: power k) + zpack w (zvm us (columns k)))%coqZ = zpack w v by rewrite zpack_axpy; lia.
have cr j i : (0 <= nth z0 (nth [::] (columns k) j) i < lz)%coqZ.
  have [jk|jk] := leqP j k; first by rewrite nth_zcolumns //; apply: zpower_range.
  by rewrite (@nth_default _ [::]) ?size_zcolumns // nth_nil; lia.
have vr i : (0 <= nth z0 v i < 2 ^ w)%coqZ.
  rewrite nth_axpy Z.mul_1_l; have := zvm_range i (fun j => zweights_range _ _ _ j l0) cr : (0 <= nth z0 (zvm us (columns k)) i <= _)%coqZ.
  have : (0 <= nth z0 (z0 :: power k) i < lz)%coqZ by case: i => [|i] /=; [lia | apply: zpower_range].
  rewrite size_zcolumns; have [_] := Z.log2_spec (Z.of_nat n.+1 * (lz * lz)) ltac:(lia); rewrite -Z.add_1_r -/(zwidth lz n) -/w.
  have : (Z.of_nat k.+1 <= Z.of_nat n)%coqZ by apply/inj_le/ssrnat.leP.
  rewrite Nat2Z.inj_succ; nia.
have sv : (size v <= k.+2)%N.
  rewrite size_axpy geq_max /= ltnS size_zpower andbT; apply: leq_trans (size_zvm _ _) _; apply: leqW.
  suff al N : all (fun r : zrow => size r <= k.+1)%N N -> (foldr maxn 0 (map size N) <= k.+1)%N.
    apply: al; apply/(all_nthP [::]) => j; rewrite size_zcolumns ltnS => jk; rewrite nth_zcolumns //.
    by apply: leq_trans (size_zpower _ _ _ _ _) _; rewrite ltnS leq_subr.
  by elim: N => //= r N IH /andP[sr /IH]; rewrite geq_max sr.
have -> : pol (take k.+2 (zunpack levels (zpack w v))) = pol v.
  apply/polyP=> i; rewrite !polE; congr phi; have [ik|ik] := ltnP i k.+2; last first.
    by rewrite !nth_default // ?(leq_trans sv) // size_take; case: ltnP => // /leq_trans->.
  rewrite nth_take // zunpackE //; last by apply: leq_trans sv (leq_trans _ (up_logP _ _)).
  by apply/(all_nthP z0) => j _; have [/Z.leb_le -> /Z.ltb_lt ->] := vr j.
rewrite /v pol_axpy phi1 mul1r pol_cons phi0 addr0 addrC mulrC; congr (_ + _).
apply/polyP=> i; rewrite polE (zvm_nth _ _ (q := k.+1)) ?size_zcolumns ?leqnn ?orbT // coefN coef_sum -sumrN.
rewrite (reindex_inj rev_ord_inj); apply: eq_bigr => j _ /=; rewrite subSS.
have jk : (k - j <= k)%N := leq_subr _ _; rewrite nth_zcolumns // (subKn (ltn_ord j : (j <= k)%N)) coefZ polE -mulNr; congr (_ * _).
have jk' : (j <= k)%N by rewrite -ltnS.
have inner i0 : (i0 <= k)%N -> nth z0 [seq entry H j0 k | j0 <- rev (iota 0 k.+1)] i0 = entry H (k - i0) k.
  by move=> ik; rewrite (nth_map 0%N) ?size_rev ?size_iota // nth_rev ?size_iota // nth_iota // ?subSS ?ltnS ?leq_subr.
have below t : (t < k)%N -> nth z0 [seq entry H j0 j0.-1 | j0 <- rev (iota 1 k)] t = entry H (k - t) (k - t).-1.
  move=> tk; rewrite (nth_map 0%N) ?size_rev ?size_iota // nth_rev ?size_iota // nth_iota ?ltn_subrL //; last by case: (k) tk.
  by rewrite add1n -subSn // subSS.
rewrite /us [LHS]zweightsE ?size_map ?size_rev ?size_iota ?ltnS // phi1 mulr1; congr (- (_ * _)); first by rewrite inner // subKn.
have from (F : nat -> Zl) a : \prod_(a <= t < k) F t = \prod_(t < k - a) F (t + a)%N by rewrite -{1}[a]add0n big_addn big_mkord.
rewrite [RHS]big_nat_rev from; apply: eq_bigr => t _; have tk : (t < k)%N by apply: leq_trans (ltn_ord t) (leq_subr _ _).
rewrite below // /b; have -> : (j + k - (t + j).+1 = (k - t).-1)%N by rewrite -addSn [(t.+1 + j)%N]addnC subnDl subnS.
by rewrite prednK // subn_gt0.
Qed.

Theorem zchar_hessenberg : (n <= size H)%N -> char_poly (hessenberg h b n) = pol (zchar lz H n).
Proof.
move=> nH; have -> : zchar lz H n = power n.
  have := @zstepsE lz w levels H n 0; rewrite add0n => /(_ nH) <-; rewrite /zchar -/w; congr (zsteps _ _ _ _ _ _ _ _ _).
    by rewrite -[LHS]map_id; apply: eq_map => r; rewrite drop0.
  by rewrite /= Z.shiftl_0_l.
rewrite hessenberg_polynomial; suff all k : (k <= n)%N -> forall i, (i <= k)%N -> hessenberg_poly h b i = pol (power i) by apply: (all n).
elim: k => [|k IH] kn i; first by rewrite leqn0 => /eqP->; rewrite /hessenberg_poly /= /zpower /= pol_one.
rewrite leq_eqVlt => /predU1P[->|]; last by rewrite ltnS; apply: IH; apply: ltnW.
rewrite hessenberg_polyS zpowerS // (IH (ltnW kn) k) //; congr (_ - _); apply: eq_bigr => j _.
by rewrite (IH (ltnW kn) j) // -ltnS.
Qed.
End Recursion.

Lemma unit_rows n L order : all (fun k => (k < n)%N) order -> all (fun i => unit_row (nth [::] L (nth 0%N order i)) i) (iota 0 n) ->
  mx n n L \in unitmx.
Proof.
case: n => [|n] /(all_nthP 0%N) small /allP ok; first by rewrite unitmxE det_mx00 unitr1.
pose f (i : 'I_n.+1) : 'I_n.+1 := inord (nth 0%N order i).
have fE i : f i = nth 0%N order i :> nat.
  by rewrite inordK //; have [io|io] := ltnP i (size order); [apply: small | rewrite nth_default].
have row i : unit_row (nth [::] L (f i)) i by rewrite fE; apply: ok; rewrite mem_iota ltn_ord.
pose T := \matrix_(i, j) mx n.+1 n.+1 L (f i) j.
have tT : is_trig_mx T.
  apply/is_trig_mxP => i j ij; rewrite !mxE; have /andP[_ z] := row i.
  by have := zrow0_nth Zl (j - i.+1) z; rewrite nth_drop subnKC.
have T1 i : T i i = 1 by rewrite !mxE; have /andP[/Z.eqb_eq -> _] := row i.
have uT : T \in unitmx by rewrite unitmxE det_trig // big1 ?unitr1.
have e : T = (\matrix_(i, j) (f i == j)%:R) *m mx n.+1 n.+1 L.
  apply/matrixP=> i j; rewrite !mxE (bigD1 (f i)) //= !mxE eqxx mul1r big1 ?addr0 // => k /negPf ki.
  by rewrite mxE eq_sym ki mul0r.
by move: uT; rewrite e unitmxE det_mulmx unitrM => /andP[_]; rewrite unitmxE.
Qed.

Theorem check_similar_sound n A w : check_similar lz n A w -> char_poly (mx n n A) = pol (zchar lz (h_H w) n).
Proof.
case: w => H L order /= /and5P[sL /eqP sH small /(all_nthP (0%N, [::])) low /andP[rows /(zmat0_modE l0 pl) e1]].
have uL := unit_rows small rows.
have HE : mx n n H = hessenberg (fun i j => phi (entry H i j)) (fun j => phi (entry H j.+1 j)) n.
  apply/matrixP=> i j; rewrite !mxE; case: leqP => // ji; case: eqP => [->//|/eqP nij].
  have := low i; rewrite size_zip size_iota sH minnn ltn_ord => /(_ isT); rewrite nth_zip ?size_iota ?sH //= nth_iota // add0n.
  have lt : (j < i.-1)%N by rewrite ltn_predRL ltn_neqAle ji andbT eq_sym.
  by move/(zrow0_nth Zl j); rewrite nth_take.
rewrite -zchar_hessenberg ?sH // -HE; apply: (hessenberg_similar (s := 1%g) uL).
have -> : \matrix_(i, j) mx n n A ((1%g : {perm 'I_n}) i) ((1%g : {perm 'I_n}) j) = mx n n A by apply/matrixP=> i j; rewrite !mxE !perm1.
have := e1 n n; rewrite zmaxpyE (zmm_modE l0 pl _ _ _ sL) (zmm_modE l0 pl _ _ _ (eq_leq sH)) phiN1 scaleN1r addrC => /eqP; rewrite subr_eq0 => /eqP ->.
by [].
Qed.
End Modulus.
