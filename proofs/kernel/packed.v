(* Products of matrices modulo l, with a whole row in one integer.

   A row of residues is the sum of its entries times powers of 2^w, so a combination of rows is one of such integers: a
   few products of large integers by small ones in the place of many small products.  With 2^w above the number of rows
   times l^2 no entry of a combination reaches the next one, and its binary digits, cut in halves, are the entries
   (`zunpackE`).  `zmm_modE` says of all lists that what is computed so is the product modulo l. *)
From Coq Require Import ZArith Lia.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact.kernel Require Import lists.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.

Definition zpack (w : Z) (v : zrow) : Z := foldr (fun x acc => x + Z.shiftl acc w)%coqZ z0 v.
(* For each half: by how many binary digits it is moved, and as many ones. *)
Fixpoint zlevels (w : Z) (d : nat) : seq (Z * Z) :=
  if d is d'.+1 then let k := Z.shiftl w (Z.of_nat d') in (k, Z.ones k) :: zlevels w d' else [::].
Fixpoint zunpack (levels : seq (Z * Z)) (x : Z) : zrow :=
  if levels is (k, ones) :: levels' then zunpack levels' (Z.land x ones) ++ zunpack levels' (Z.shiftr x k) else [:: x].
Fixpoint zcombined (acc : Z) (u ps : zrow) : Z :=
  match u, ps with x :: u', p :: ps' => zcombined (if Z.eqb x 0 then acc else acc + x * p)%coqZ u' ps' | _, _ => acc end.

(* Rows modulo l as integers, in parts of 2^d columns: larger integers take longer than their parts. *)
Definition longest : Z := 16384.
Fixpoint zdepth (w : Z) (d : nat) : nat := if d is d'.+1 then if Z.leb (Z.shiftl w (Z.of_nat d)) longest then d else zdepth w d' else 0%N.
Fixpoint zparts (w : Z) (h k : nat) (N : zmat) : seq zrow :=
  if k is k'.+1 then [seq zpack w (take h r) | r <- N] :: zparts w h k' [seq drop h r | r <- N] else [::].
Record packed := Packed { pk_levels : seq (Z * Z); pk_size : nat; pk_parts : seq zrow }.
Definition zpacked (l : Z) (N : zmat) : packed :=
  let w := (Z.log2 (Z.of_nat (size N) * (l * l)) + 1)%coqZ in
  let b := foldr maxn 0%N (map size N) in
  let d := zdepth w (up_log 2 b) in
  Packed (zlevels w d) b (zparts w (2 ^ d) (b.-1 %/ 2 ^ d).+1 (zmat_mod l N)).
(* u N and M N modulo l *)
Definition zvm_mod (l : Z) (u : zrow) (N : packed) : zrow :=
  let u := zmod l u in zmod l (take (pk_size N) (flatten [seq zunpack (pk_levels N) (zcombined z0 u part) | part <- pk_parts N])).
Definition zmm_mod (l : Z) (M N : zmat) : zmat := let P := zpacked l N in [seq zvm_mod l u P | u <- M].

(* Side by side: as many columns more. *)
Fixpoint zbeside (M N : zmat) : zmat :=
  match M, N with [::], _ => N | _, [::] => M | u :: M', v :: N' => (u ++ v) :: zbeside M' N' end.

Definition digits (w : Z) (v : zrow) : bool := all (fun x => Z.leb 0 x && Z.ltb x (2 ^ w)) v.

Lemma pow_gt0 k : (0 <= k -> 0 < 2 ^ k)%coqZ. Proof. exact: Z.pow_pos_nonneg. Qed.

Lemma nth_axpy k u v i : nth z0 (zaxpy k u v) i = (k * nth z0 u i + nth z0 v i)%coqZ.
Proof. by elim: u v i => [|x u IH] [|y v] [|i] /=; rewrite ?IH ?nth_nil; lia. Qed.
Lemma size_axpy k u v : size (zaxpy k u v) = maxn (size u) (size v).
Proof. by elim: u v => [|x u IH] [|y v] //=; rewrite ?max0n ?maxn0 ?IH ?maxnSS //= maxn0. Qed.
Lemma size_zvm u N : (size (zvm u N) <= foldr maxn 0%N (map size N))%N.
Proof.
elim: u N => [|x u IH] [|r N] //; rewrite /zvm /= -/(zvm u N); case: Z.eqb.
  by rewrite leq_max IH orbT.
by rewrite size_axpy geq_max leq_maxl leq_max IH orbT.
Qed.
Lemma zvm_cons x u r N : zvm (x :: u) (r :: N) = if Z.eqb x 0 then zvm u N else zaxpy x r (zvm u N).
Proof. by []. Qed.
Lemma nth_zvm x u r N i : nth z0 (zvm (x :: u) (r :: N)) i = (x * nth z0 r i + nth z0 (zvm u N) i)%coqZ.
Proof. by rewrite zvm_cons; case: Z.eqb_spec => [->|_]; rewrite ?nth_axpy. Qed.
Lemma nth_zvm_take h u N i : nth z0 (zvm u [seq take h r | r <- N]) i = if (i < h)%N then nth z0 (zvm u N) i else z0.
Proof.
elim: u N => [|x u IH] [|r N]; try by rewrite nth_nil if_same.
rewrite map_cons !nth_zvm IH; case: ltnP => ih; first by rewrite nth_take.
by rewrite nth_default ?Z.mul_0_r // size_take; case: ltnP => // /leq_trans->.
Qed.
Lemma nth_zvm_drop h u N i : nth z0 (zvm u [seq drop h r | r <- N]) i = nth z0 (zvm u N) (h + i).
Proof.
elim: u N => [|x u IH] [|r N]; try by rewrite !nth_nil.
by rewrite map_cons !nth_zvm IH nth_drop.
Qed.

Section Packing.
Variable w : Z.
Hypothesis w0 : (0 < w)%coqZ.

Lemma zpack_cat u v : zpack w (u ++ v) = (zpack w u + zpack w v * 2 ^ (w * Z.of_nat (size u)))%coqZ.
Proof.
elim: u => [|x u IH]; first by rewrite /= Z.mul_0_r Z.pow_0_r Z.mul_1_r.
rewrite [zpack _ (_ ++ _)]/= -/(zpack w (u ++ v)) IH [zpack _ (_ :: _)]/= -/(zpack w u) [size _]/= Nat2Z.inj_succ.
have -> : (w * Z.succ (Z.of_nat (size u)) = w + w * Z.of_nat (size u))%coqZ by lia.
rewrite !Z.shiftl_mul_pow2; try lia; rewrite Z.pow_add_r; try lia; ring.
Qed.
Lemma zpack_bound v : digits w v -> (0 <= zpack w v < 2 ^ (w * Z.of_nat (size v)))%coqZ.
Proof.
elim: v => [|x v IH]; first by rewrite Z.mul_0_r.
rewrite /digits /= => /andP[/andP[/Z.leb_le x0 /Z.ltb_lt xw] /IH]; rewrite -/(zpack w v) => b.
have e : (w * Z.pos (Pos.of_succ_nat (size v)) = w + w * Z.of_nat (size v))%coqZ by lia.
have p := pow_gt0 (Z.lt_le_incl _ _ w0).
by rewrite Z.shiftl_mul_pow2 ?e ?Z.pow_add_r; nia.
Qed.
Lemma size_zunpack d x : size (zunpack (zlevels w d) x) = (2 ^ d)%N.
Proof. by elim: d x => [//|d IH] x /=; rewrite size_cat !IH expnS mul2n addnn. Qed.
Lemma zunpackE d v : digits w v -> (size v <= 2 ^ d)%N -> forall i, nth z0 (zunpack (zlevels w d) (zpack w v)) i = nth z0 v i.
Proof.
elim: d v => [|d IH] v dv sv i.
  case: v sv {dv} => [|x [|//]] _; last by rewrite /= Z.shiftl_0_l Z.add_0_r.
  by case: i => [|i]; rewrite /= ?nth_nil.
pose h := (2 ^ d)%N; have ve := cat_take_drop h v; move: (dv); rewrite -{1}ve /digits all_cat => /andP[dt dd].
have hZ : (Z.shiftl w (Z.of_nat d) = w * Z.of_nat h)%coqZ.
  rewrite Z.shiftl_mul_pow2; last exact: Nat2Z.is_nonneg.
  congr (w * _)%coqZ; rewrite /h; elim: (d) => [//|k kE]; rewrite expnS Nat2Z.inj_succ Z.pow_succ_r; last exact: Nat2Z.is_nonneg.
  by rewrite kE mul2n -addnn; rewrite Nat2Z.inj_add; ring.
have k0 : (0 <= w * Z.of_nat h)%coqZ by lia.
have e : zpack w v = (zpack w (take h v) + zpack w (drop h v) * 2 ^ (w * Z.of_nat h))%coqZ.
  rewrite -{1}ve zpack_cat; have [hv|hv] := leqP h (size v); first by rewrite size_takel.
  by rewrite drop_oversize ?(ltnW hv) // !Z.mul_0_l.
have p := pow_gt0 k0.
have b : (0 <= zpack w (take h v) < 2 ^ (w * Z.of_nat h))%coqZ.
  have [b0 b1] := zpack_bound dt; split=> //; apply: Z.lt_le_trans b1 _; apply: Z.pow_le_mono_r => //.
  apply: Z.mul_le_mono_nonneg_l; first by lia.
  by apply: inj_le; apply/leP; rewrite size_take; case: ltnP.
rewrite /= hZ Z.land_ones // Z.shiftr_div_pow2 // e Z.mod_add; last by lia.
rewrite Z.mod_small // Z.div_add; last by lia.
rewrite Z.div_small // Z.add_0_l nth_cat size_zunpack -/h.
rewrite !IH // ?size_drop ?size_take; last 2 first.
- by rewrite leq_subLR /h addnn -mul2n -expnS.
- by case: ltnP => // /ltnW.
case: ltnP => ih; first by rewrite nth_take.
by rewrite nth_drop subnKC.
Qed.

Lemma zpack_axpy k u v : zpack w (zaxpy k u v) = (k * zpack w u + zpack w v)%coqZ.
Proof.
elim: u v => [|x u IH] [|y v]; rewrite [zaxpy _ _ _]/= /zpack /= -!/(zpack w _) ?IH ?Z.shiftl_mul_pow2 ?[zpack w [::]]/=; lia.
Qed.
Lemma zcombinedE acc u N : zcombined acc u [seq zpack w r | r <- N] = (acc + zpack w (zvm u N))%coqZ.
Proof.
elim: u N acc => [|x u IH] [|r N] acc; rewrite ?[zvm _ _]/= ?Z.add_0_r //.
by rewrite zvm_cons [LHS]/= IH; case: Z.eqb => //; rewrite zpack_axpy Z.add_assoc.
Qed.

Lemma zparts_nth d u k N j : (forall i, (0 <= nth z0 (zvm u N) i < 2 ^ w)%coqZ) -> (j < k * 2 ^ d)%N ->
  nth z0 (flatten [seq zunpack (zlevels w d) (zcombined z0 u part) | part <- zparts w (2 ^ d) k N]) j = nth z0 (zvm u N) j.
Proof.
set h := (2 ^ d)%N; elim: k N j => [//|k IH] N j b jk; rewrite [zparts _ _ _ _]/= map_cons [flatten _]/= -/(flatten _).
have -> : [seq zpack w (take h r) | r <- N] = [seq zpack w r | r <- [seq take h r | r <- N]] by rewrite -map_comp.
have tk i : nth z0 (zvm u [seq take h r | r <- N]) i = if (i < h)%N then nth z0 (zvm u N) i else z0 by apply: nth_zvm_take.
have dv : digits w (zvm u [seq take h r | r <- N]).
  apply/(all_nthP z0) => i _; rewrite tk; have [b0 b1] := b i; case: ltnP => _; last by rewrite /=; apply/Z.ltb_lt/pow_gt0/Z.lt_le_incl.
  by rewrite (introT (Z.leb_spec0 _ _) b0) (introT (Z.ltb_spec0 _ _) b1).
have sv : (size (zvm u [seq take h r | r <- N]) <= h)%N.
  apply: leq_trans (size_zvm _ _) _; elim: (N) => [//|r N' IHN]; rewrite /= geq_max IHN andbT size_take; by case: ltnP.
rewrite nth_cat size_zunpack zcombinedE Z.add_0_l -/h; case: ltnP => jh; first by rewrite zunpackE // tk jh.
have dr i : nth z0 (zvm u [seq drop h r | r <- N]) i = nth z0 (zvm u N) (h + i) by apply: nth_zvm_drop.
rewrite IH; first by rewrite dr subnKC.
  by move=> i; rewrite dr.
by rewrite ltn_subLR // -mulSn.
Qed.
End Packing.

Lemma nth_mod l v i : (0 < l)%coqZ -> (0 <= nth z0 (zmod l v) i < l)%coqZ.
Proof.
move=> l0; have [iv|iv] := ltnP i (size v); last by rewrite nth_default ?size_map.
by rewrite (nth_map z0) //; apply: Z.mod_pos_bound.
Qed.
Lemma zvm_range l u N i : (forall k, 0 <= nth z0 u k < l)%coqZ -> (forall k j, 0 <= nth z0 (nth [::] N k) j < l)%coqZ ->
  (0 <= nth z0 (zvm u N) i <= Z.of_nat (size N) * (l * l))%coqZ.
Proof.
have l2 := Z.square_nonneg l; elim: u N => [|x u IH] [|r N] ul Nl; rewrite ?[zvm _ _]/= ?nth_nil ?[size _]/=; try nia.
rewrite nth_zvm; have b := IH N (fun k => ul k.+1) (fun k => Nl k.+1); have x0 := ul 0%N; have r0 := Nl 0%N i; rewrite /= in x0 r0; nia.
Qed.
Lemma zvm_bound l u N i : (0 < l)%coqZ ->
  (0 <= nth z0 (zvm (zmod l u) (zmat_mod l N)) i <= Z.of_nat (size N) * (l * l))%coqZ.
Proof.
move=> l0; have -> : size N = size (zmat_mod l N) by rewrite size_map.
apply: zvm_range => [k|k j]; first exact: nth_mod.
have [kN|kN] := ltnP k (size N); last by rewrite (@nth_default _ [::]) ?size_map // nth_nil; lia.
by rewrite (nth_map [::]) //; apply: nth_mod.
Qed.

Section Product.
Variables (R : comRingType) (l : Z).
Hypotheses (l0 : (0 < l)%coqZ) (pl : phi R l = 0%R).
Local Open Scope ring_scope.
Local Notation phi := (phi R).

Lemma zvm_mod_nth u N c j : (size N <= c)%N ->
  phi (nth z0 (zvm_mod l u (zpacked l N)) j) = \sum_(k < c) phi (nth z0 u k) * phi (nth z0 (nth [::] N k) j).
Proof.
move=> Nc; rewrite /zvm_mod (zmod_nth l0 pl) /zpacked; set w := (Z.log2 _ + 1)%coqZ; set b := foldr _ _ _; set d := zdepth _ _; cbn [pk_size pk_levels pk_parts].
have w0 : (0 < w)%coqZ by have := Z.log2_nonneg (Z.of_nat (size N) * (l * l)); rewrite /w; lia.
set u' := zmod l u; have sb : (size (zvm u' (zmat_mod l N)) <= b)%N.
  apply: leq_trans (size_zvm _ _) _; rewrite /b (_ : map size (zmat_mod l N) = map size N) // -map_comp.
  by apply: eq_map => r; rewrite /= size_map.
have bound i : (0 <= nth z0 (zvm u' (zmat_mod l N)) i < 2 ^ w)%coqZ.
  have := zvm_bound u N i l0; set t := (Z.of_nat _ * _)%coqZ => -[x0 xt]; split=> //; apply: Z.le_lt_trans xt _.
  have [t0|t0] := Z_lt_le_dec 0 t; first by have [_] := Z.log2_spec _ t0; rewrite -Z.add_1_r.
  by apply: Z.le_lt_trans t0 _; apply: pow_gt0; lia.
have -> x : nth z0 (take b x) j = if (j < b)%N then nth z0 x j else z0.
  by case: ltnP => jb; [rewrite nth_take | rewrite nth_default // size_take; case: ltnP => // /leq_trans->].
have -> : (if (j < b)%N then nth z0 (flatten [seq zunpack (zlevels w d) (zcombined z0 u' part) | part <- zparts w (2 ^ d) (b.-1 %/ 2 ^ d).+1 (zmat_mod l N)]) j else z0)
    = nth z0 (zvm u' (zmat_mod l N)) j.
  case: ltnP => jb; last by rewrite nth_default // (leq_trans sb).
  apply: zparts_nth => //; apply: leq_trans jb _; case: (b) => [//|b']; exact: ltn_ceil (expn_gt0 2 d).
rewrite (zvm_nth _ _ (q := c)); last by apply/orP; right; rewrite size_map.
apply: eq_bigr => k _; rewrite (zmod_nth l0 pl); congr (_ * _).
have [kN|kN] := ltnP k (size N); last by rewrite !nth_default ?size_map ?(nth_default _ kN).
by rewrite (nth_map [::]) // (zmod_nth l0 pl).
Qed.
Lemma zmm_modE a b c M N : (size N <= c)%N -> mx R a b (zmm_mod l M N) = mx R a c M *m mx R c b N.
Proof.
move=> h; apply/matrixP=> i j; rewrite !mxE.
have [il|il] := ltnP i (size M); last first.
  rewrite (@nth_default _ [::]) ?size_map // nth_nil phi0 big1 // => k _; by rewrite mxE (@nth_default _ [::] M) // nth_nil phi0 mul0r.
rewrite (nth_map [::]) // (zvm_mod_nth _ _ h); apply: eq_bigr => k _; by rewrite !mxE.
Qed.
Lemma zbeside_nth M N i : nth [::] (zbeside M N) i = nth [::] M i ++ nth [::] N i.
Proof. by elim: M N i => [|u M IH] [|v N] [|i] //=; rewrite ?nth_nil ?cats0. Qed.
Lemma zbesideE n p q b M N P Q : shape n p M -> size P = p ->
  mx R n (p + q) (zbeside M N) *m mx R (p + q) b (P ++ Q) = mx R n p M *m mx R p b P + mx R n q N *m mx R q b Q.
Proof.
move=> /andP[/eqP sM /(all_nthP [::]) al] sP; apply/matrixP=> i j; rewrite !mxE big_split_ord /=.
have si : size (nth [::] M i) = p by apply/eqP/al; rewrite sM.
by congr (_ + _); apply: eq_bigr => k _; rewrite !mxE zbeside_nth !nth_cat si sP /= ?ltn_ord // ltnNge leq_addr /= addKn.
Qed.
End Product.
