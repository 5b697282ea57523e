(* Kind `setpoint`, checker/core/reach.py, check_setpoint: the rank of M = [A, B; C, 0], in discrete time [A - I, B; C, 0],
   B and C those of all channels; and whether [xI - A, B; C, 0] has full row rank for some x.

   A row of as many numbers as M has rows is one of n and one for the outputs of each channel.  From above by rows W with
   an identity at the pivots and W M = 0, from below by rows X for which some columns of X M are the unit vectors modulo l.
   No x gives full rank if a polynomial row other than 0 annihilates the pencil. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability setpoint.
From mcexact.kernel Require Import lists systems residues shrunk_rule reach_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* A column of M, or of a row beside it: of a state, or of an input (of an output) of a channel. *)
Inductive place := OfState of nat | OfPort of nat & nat.
(* a W1 A + b P + sum_i W2_i C_i *)
Definition ztop (s : zsystem) (a : Z) (W1 : zmat) (b : Z) (P : zmat) (W2 : seq zmat) : zmat :=
  zmaxpy a (zmm W1 (zA s)) (zmaxpy b P (foldr (fun cW acc => zmaxpy 1 (zmm cW.2 (zC cW.1)) acc) [::] (zip (zchannels s) W2))).
Definition at_place (G : zmat) (H : seq zmat) (x : place) : zrow := match x with OfState a => zcolumn G a | OfPort i u => zcolumn (nth [::] H i) u end.
Definition fits (n : nat) (widths : seq nat) (x : place) : bool := match x with OfState a => (a < n)%N | OfPort i u => (i < size widths)%N && (u < nth 0 widths i)%N end.

(* Rank from below: of [a A + b, B; C, 0] modulo l. *)
Record below_witness := BelowWitness { w_l : Z; w_i : Z; w_X1 : zmat; w_X2 : seq zmat; w_columns : seq place }.
Definition check_below (s : zsystem) (a b : Z) (w : below_witness) : bool :=
  let: (l, i) := (w_l w, w_i w) in
  let s' := ZSystem (zn s) 1 (zscale_mod l i (zA s)) [seq reduced l i ch | ch <- zchannels s] [::] in
  let G := zmat_mod l (ztop s' a (w_X1 w) b (w_X1 w) (w_X2 w)) in
  let H := [seq zmm (w_X1 w) (zB ch) | ch <- zchannels s'] in
  [&& inverse_modulo l (zD s) i, size (w_X2 w) == size (zchannels s), all (fits (zn s) (map zp (zchannels s))) (w_columns w) &
      all (fun kx => zero_mod l (zaxpy (-1) (zunit 1 kx.1) (at_place G H kx.2))) (zip (iota 0 (size (w_columns w))) (w_columns w))].

(* Rank from above: of the same over a field. *)
Record above_witness := AboveWitness { x_den : Z; x_W1 : zmat; x_W2 : seq zmat; x_places : seq place }.
Definition check_above (s : zsystem) (a b : Z) (w : above_witness) : bool :=
  let: (W1, W2, e) := (x_W1 w, x_W2 w, x_den w) in
  [&& Z.ltb 0 e, size W2 == size (zchannels s), all (fits (zn s) (map zq (zchannels s))) (x_places w) &
  [&& all (fun kx => zrow0 (zaxpy (-1) (zunit e kx.1) (at_place W1 W2 kx.2))) (zip (iota 0 (size (x_places w))) (x_places w)),
      zmat0 (ztop s a W1 (b * zD s)%coqZ W1 W2) & all (fun ch => zmat0 (zmm W1 (zB ch))) (zchannels s)]].

(* A polynomial row, the coefficient of 1 first, that annihilates [xI - A, B; C, 0]. *)
Fixpoint zgone (s : zsystem) (before : zmat) (ws : seq (zmat * seq zmat)) : bool :=
  if ws is w :: ws' then
    [&& size w.2 == size (zchannels s), zmat0 (ztop s (-1) w.1 (zD s) before w.2), all (fun ch => zmat0 (zmm w.1 (zB ch))) (zchannels s) & zgone s w.1 ws']
  else zmat0 before.
Definition zsome (n : nat) (widths : seq nat) (w : zmat * seq zmat) : bool :=
  has (fun x => ~~ Z.eqb x 0) (take n (nth [::] w.1 0)) || has (fun kW => has (fun x => ~~ Z.eqb x 0) (take kW.1 (nth [::] kW.2 0))) (zip widths w.2).

Section System.
Variables (R : comRingType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel R n p q).
(* [a A + b, B; C, 0], and the row [W1, W2_1, ..., W2_m] *)
Definition system_matrix (a b : R) : 'M[R]_(n + \sum_i q i, n + \sum_i p i) :=
  block_mx (a *: mcA S + b%:M) (inputs S setT) (outputs S setT) 0.
Definition beside w (W1 : 'M[R]_(w, n)) (W2 : forall i, 'M[R]_(w, q i)) : 'M[R]_(w, n + \sum_i q i) := row_mx W1 (\mxrow_i W2 i).
Lemma beside_matrix w (W1 : 'M_(w, n)) W2 a b : beside W1 W2 *m system_matrix a b =
  row_mx (a *: (W1 *m mcA S) + b *: W1 + \sum_i W2 i *m mcC S i) (\mxrow_i (W1 *m mcB S i)).
Proof.
rewrite /beside /system_matrix mul_row_block mulmx0 addr0 mulmxDr -scalemxAr mul_mx_scalar; congr (row_mx (_ + _) _).
  by rewrite /outputs mul_mxrow_mxcol; apply: eq_bigr => i _; rewrite inE.
by rewrite /inputs mul_mxrow; apply: eq_mxrow => i; rewrite inE.
Qed.
End System.
Section Places.
Variables (R : comRingType) (n m w : nat) (d : 'I_m -> nat) (G : 'M[R]_(w, n)) (H : forall i, 'M[R]_(w, d i)).
(* A column of the row of blocks G, H_1, ..., H_m. *)
Lemma state_column a : exists y : 'cV_(n + \sum_i d i), row_mx G (\mxrow_i H i) *m y = col a G.
Proof. by exists (col_mx (delta_mx a 0) 0); rewrite mul_row_col mulmx0 addr0 -colE. Qed.
Lemma port_column i u : exists y : 'cV_(n + \sum_i d i), row_mx G (\mxrow_i H i) *m y = col u (H i).
Proof.
exists (col_mx 0 (submxrow 1%:M i *m delta_mx u 0)); rewrite mul_row_col mulmx0 add0r mulmxA mul_submxrow mulmx1 mxrowK -colE //.
Qed.
End Places.

Section Lists.
Variable R : comRingType.
Notation mx := (mx R).
Lemma zsumE a b (l : seq (zchannel * zmat)) : mx a b (foldr (fun cW acc => zmaxpy 1 (zmm cW.2 (zC cW.1)) acc) [::] l) =
  \sum_(k < size l) mx a b (zmm (nth (zch0, [::]) l k).2 (zC (nth (zch0, [::]) l k).1)).
Proof.
elim: l => [|x l IH]; first by rewrite big_ord0 mx_nil.
by rewrite /= zmaxpyE phi1 scale1r IH big_ord_recl.
Qed.
Lemma at_placeE n m w (d : 'I_m -> nat) widths G H x : size widths = m -> (forall i : 'I_m, d i = nth 0%N widths i) -> fits n widths x ->
  exists y : 'cV_(n + \sum_i d i), row_mx (mx w n G) (\mxrow_i mx w (d i) (nth [::] H i)) *m y = cv R w (at_place G H x).
Proof.
move=> sw dE; case: x => [a an|i u] /=; first by rewrite (zcolumnE _ _ _ an); apply: state_column.
rewrite sw => /andP[im ui]; pose i' := Ordinal im; have ui' : (u < d i')%N by rewrite dE.
by rewrite (zcolumnE _ _ _ ui'); exact: (@port_column R n m w d (mx w n G) (fun k => mx w (d k) (nth [::] H k)) i' (Ordinal ui')).
Qed.
End Lists.

Section Sound.
Variables (s : zsystem).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Notation Kc := [comRingType of K].

Lemma ztopE (R : comRingType) s' a b W1 P W2 w : zn s' = n -> size (zchannels s') = m -> (forall k : 'I_m, shape (q k) n (zC (channel s' k))) ->
  shape n n (zA s') -> size W2 = m ->
  mx R w n (ztop s' a W1 b P W2) = phi R a *: (mx R w n W1 *m mx R n n (zA s')) + phi R b *: mx R w n P +
    \sum_(k < m) mx R w (q k) (nth [::] W2 k) *m mx R (q k) n (zC (channel s' k)).
Proof.
move=> en em sC sA sW; rewrite /ztop !zmaxpyE zsumE (zmmE _ _ _ _ (eq_leq (shape_size sA))) addrA; congr (_ + _).
have sz : size (zip (zchannels s') W2) = m by rewrite size_zip em sW minnn.
rewrite sz; apply: eq_bigr => k _; by rewrite (nth_zip _ _ _ (etrans em (esym sW))) /= (zmmE _ _ _ _ (eq_leq (shape_size (sC k)))).
Qed.
Let widthsE (f : zchannel -> nat) (d : 'I_m -> nat) : (forall k, d k = f (channel s k)) -> forall k : 'I_m, d k = nth 0%N (map f (zchannels s)) k.
Proof. by move=> dE k; rewrite dE (nth_map zch0) // -(re_m re). Qed.

Theorem check_below_sound a b w : check_below s a b w -> (size (w_columns w) <= \rank (system_matrix S (phi Kc a) (phi Kc b)))%N.
Proof.
have D0 := represented_D re; have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC.
rewrite /check_below -en; set lz := w_l w; set i := w_i w; set s' := ZSystem _ _ _ _ _; set G := zmat_mod _ _; set H := map _ (zchannels s'); set r := size (w_columns w).
case/and4P=> /andP[/Z.ltb_lt l1 /Z.eqb_eq inv] /eqP sX /(all_nthP (OfState 0)) fit /(all_nthP (0%N, OfState 0)) units.
pose l := modulus_of l1; have l0 := modulus_gt0 l1; pose Zl := [comRingType of 'Z_l]; have pl : phi Zl lz = 0 := phi_modulus l1.
pose SL : multichannel (Zloc l) n p q := local_system l1 D0 inv s n p q.
have resR c d M : map_mx (@residue l) (local l1 D0 inv c d M) = mx Zl c d (zscale_mod lz i M) := residue_local l1 D0 inv c d M.
have up c d M : map_mx (into h) (local l1 D0 inv c d M) = over K (zD s) c d M by rewrite -(into_local l1 D0 inv h) -map_mx_comp.
pose M := system_matrix SL (phi [comRingType of Zloc l] a) (phi [comRingType of Zloc l] b).
have -> : system_matrix S (phi Kc a) (phi Kc b) = map_mx (into h) M.
  rewrite /M /system_matrix map_block_mx map_mx0 map_inputs map_outputs map_mxD map_mxZ map_scalar_mx /= up -eA !map_phi; congr block_mx.
    by apply: eq_mxrow => k; rewrite inE eB /= up.
  by apply: eq_mxcol => k; rewrite inE eC /= up.
have em' : size (zchannels s') = m by rewrite size_map.
have chE (k : 'I_m) : channel s' k = reduced lz i (channel s k) by rewrite /channel (nth_map zch0) // -em.
pose X2 k := mx Zl r (q k) (nth [::] (w_X2 w) k); pose X := beside (mx Zl r n (w_X1 w)) X2.
have XM : X *m map_mx (@residue l) M = row_mx (mx Zl r n G) (\mxrow_k mx Zl r (p k) (nth [::] H k)).
  have -> : map_mx (@residue l) M = system_matrix (map_system (@residue l) SL) (phi Zl a) (phi Zl b).
    by rewrite /M /system_matrix map_block_mx map_mx0 map_inputs map_outputs map_mxD map_mxZ map_scalar_mx !map_phi.
  have sC' (k : 'I_m) : shape (q k) n (zC (channel s' k)) by rewrite chE shape_scale; case: (represented_channel re k).
  have sA' : shape n n (zA s') by rewrite /= shape_scale.
  have eC' (k : 'I_m) : X2 k *m mcC (map_system (@residue l) SL) k = X2 k *m mx Zl (q k) n (zC (channel s' k)) by rewrite chE [mcC _ _]resR.
  have eB' (k : 'I_m) : mx Zl r n (w_X1 w) *m mcB (map_system (@residue l) SL) k = mx Zl r (p k) (nth [::] H k).
    rewrite (nth_map zch0) ?em' // -/(channel s' k) chE [mcB _ _]resR.
    by rewrite (@zmmE Zl r (p k) n) // size_map (shape_size (represented_channel re k).1).
  rewrite beside_matrix [mcA _]resR (eq_bigr _ (fun k _ => eC' k)) (eq_mxrow eB').
  by rewrite (zmat_modE l0 pl) (@ztopE Zl s' _ _ _ _ _ r erefl em' sC' sA' (etrans sX (esym em))).
have [Y eY] : exists Y, X *m map_mx (@residue l) M *m Y = 1%:M.
  apply: right_inverse => k; have kr : (k < r)%N := ltn_ord k.
  have [y ey] := @at_placeE Zl n m r p (map zp (zchannels s)) G H _ (etrans (size_map _ _) (esym em)) (widthsE ep) (fit k kr).
  exists y; rewrite mulmxA XM.
  have := units k; rewrite size_zip size_iota minnn => /(_ kr); rewrite nth_zip ?size_iota //= nth_iota // add0n => /(zero_modE l0 pl r).
  by rewrite zaxpyE zunitE phiN1 scaleN1r addrC => /eqP; rewrite subr_eq0 => /eqP <-; rewrite -ey.
exact: (rank_from_below h eY).
Qed.

Theorem check_above_sound a b w : check_above s a b w -> (\rank (system_matrix S (phi Kc a) (phi Kc b)) + size (x_places w) <= n + \sum_i q i)%N.
Proof.
have D0 := represented_D re; have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC.
rewrite /check_above -en; set e := x_den w; set W1 := x_W1 w; set W2 := x_W2 w; set r := size (x_places w).
case/and4P=> /Z.ltb_lt e0 /eqP sW /(all_nthP (OfState 0)) fit /and3P[/(all_nthP (0%N, OfState 0)) units top /(all_nthP zch0) ins].
have nz d : (0 < d)%coqZ -> phi Kc d != 0 by move=> d0; apply: phi_neq0 h _ _; apply/negP => /Z.eqb_eq ed; rewrite ed in d0.
have u0 := nz _ e0; have D1 := nz _ D0.
pose W2' k := mx Kc r (q k) (nth [::] W2 k); pose W := beside (mx Kc r n W1) W2'.
have WM : W *m system_matrix S (phi Kc a) (phi Kc b) = 0.
  rewrite beside_matrix -[RHS](row_mx0 _ r n _); congr row_mx; last first.
    apply/mxrowP=> k; rewrite mxrowK submxrow0 eB /over -scalemxAr -(zmmE _ _ _ _ (eq_leq (shape_size (represented_channel re k).1))).
    by rewrite zmat0E ?scaler0 //; apply: ins; rewrite -em.
  have sC (k : 'I_m) : shape (q k) n (zC (channel s k)) by case: (represented_channel re k).
  have := zmat0E Kc r n top; rewrite (@ztopE Kc s _ _ _ _ _ r (esym en) (esym em) sC sA (etrans sW (esym em))).
  move/(congr1 (fun M => (phi Kc (zD s))^-1 *: M)); rewrite scaler0 !scalerDr phiM scalerA => top0; rewrite -[RHS]top0; congr (_ + _ + _).
  - by rewrite eA /over -scalemxAr !scalerA mulrC.
  - by rewrite scalerA mulrCA mulVf ?mulr1.
  by rewrite scaler_sumr; apply: eq_bigr => k _; rewrite eC /over -scalemxAr.
have [Y eY] : exists Y, W *m 1%:M *m Y = 1%:M.
  apply: right_inverse => k; have kr : (k < r)%N := ltn_ord k.
  have [y ey] := @at_placeE Kc n m r q (map zq (zchannels s)) W1 W2 _ (etrans (size_map _ _) (esym em)) (widthsE eq) (fit k kr).
  exists ((phi Kc e)^-1 *: y); rewrite mul1mx -scalemxAr ey.
  have := units k; rewrite size_zip size_iota minnn => /(_ kr); rewrite nth_zip ?size_iota //= nth_iota // add0n => z.
  have {z} : cv Kc r (zaxpy (-1) (zunit e k) (at_place W1 W2 (nth (OfState 0) (x_places w) k))) = 0.
    by apply/matrixP=> i j; rewrite !mxE zrow0_nth.
  rewrite zaxpyE phiN1 scaleN1r addrC => /eqP; rewrite subr_eq0 => /eqP ->.
  apply/matrixP=> i j; have /matrixP/(_ i j) := zunitE Kc k; rewrite !mxE => <-; rewrite /zunit !nth_ncons.
  have [ik|ki] := ltnP i k; first by rewrite mulr0.
  by case: (i - k)%N => [|t] /=; rewrite ?mulVf // ?nth_nil ?mulr0.
rewrite addnC -leq_subRL; last by rewrite -[r](mxrank1 K) -eY (leq_trans (mxrankM_maxl _ _)) // (leq_trans (mxrankM_maxl _ _)) // rank_leq_col.
apply: (rank_from_above WM); rewrite /row_free eqn_leq rank_leq_row /= -[X in (X <= _)%N](mxrank1 K) -eY mulmx1.
exact: mxrankM_maxl.
Qed.
End Sound.

(* A polynomial row that annihilates the pencil. *)
Section Normal.
Variables (s : zsystem).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Notation Kc := [comRingType of K].
Notation Kx := [comRingType of {poly K}].
Definition zrow_of (w : zmat * seq zmat) : 'rV[K]_(n + \sum_i q i) := beside (mx Kc 1 n w.1) (fun k => mx Kc 1 (q k) (nth [::] w.2 k)).
Definition polynomial_row (ws : seq (zmat * seq zmat)) : 'rV[{poly K}]_(n + \sum_i q i) := foldr (fun w acc => map_mx polyC (zrow_of w) + 'X *: acc) 0 ws.
Let M : 'M[{poly K}]_(n + \sum_i q i, n + \sum_i p i) := system_matrix (map_system polyC S) (-1) 'X.

Lemma polynomial_row_coef ws k j : (polynomial_row ws 0 j)`_k = zrow_of (nth ([::], [::]) ws k) 0 j.
Proof.
have nil : zrow_of ([::], [::]) = 0.
  rewrite /zrow_of /beside mx_nil -(row_mx0 _ 1 n (\sum_i q i)); congr row_mx; apply/mxrowP=> i; rewrite mxrowK submxrow0 nth_nil mx_nil //.
elim: ws k => [|w ws IH] k; first by rewrite nth_nil nil !mxE coef0.
have -> : polynomial_row (w :: ws) 0 j = (zrow_of w 0 j)%:P + 'X * polynomial_row ws 0 j.
  by rewrite /= mxE [map_mx _ _ _ _]mxE; congr (_ + _); rewrite mxE.
rewrite coefD coefC coefXM; case: k => [|k] /=; first by rewrite addr0.
by rewrite add0r IH.
Qed.
Lemma zgone_sound before ws : zgone s before ws -> polynomial_row ws *m M + row_mx (map_mx polyC (mx Kc 1 n before)) 0 = 0.
Proof.
have D0 := represented_D re; have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC.
have D1 : phi Kc (zD s) != 0 by apply: phi_neq0 h _ _; apply/negP => /Z.eqb_eq ed; rewrite ed in D0.
elim: ws before => [|[w1 w2] ws IH] before /=.
  by move=> /(zmat0E Kc 1 n) ->; rewrite map_mx0 row_mx0 mul0mx addr0.
case/and4P=> /eqP sw top /(all_nthP zch0) ins /IH {}IH.
have sC (k : 'I_m) : shape (q k) n (zC (channel s k)) by case: (represented_channel re k).
have := zmat0E Kc 1 n top; rewrite (@ztopE n m q Kc s _ _ _ _ _ 1 (esym en) (esym em) sC sA (etrans sw (esym em))).
move/(congr1 (fun N => (phi Kc (zD s))^-1 *: N)); rewrite scaler0 !scalerDr !scalerA mulVf // scale1r phiN1 mulrN1 scaleNr => top0.
have eT : map_mx polyC (\sum_k mx Kc 1 (q k) (nth [::] w2 k) *m mcC S k) - map_mx polyC (mx Kc 1 n w1 *m mcA S) = - map_mx polyC (mx Kc 1 n before).
  rewrite -map_mxB -map_mxN; congr (map_mx _ _); apply/eqP; rewrite -addr_eq0 -[X in _ == X]top0; apply/eqP.
  rewrite [RHS]addrAC [RHS]addrC addrC; congr (_ + _); rewrite addrC; congr (_ + _).
    by rewrite eA /over -scalemxAr.
  by rewrite scaler_sumr; apply: eq_bigr => k _; rewrite eC /over -scalemxAr.
have wM : map_mx polyC (zrow_of (w1, w2)) *m M = row_mx ('X *: map_mx polyC (mx Kc 1 n w1) - map_mx polyC (mx Kc 1 n before)) 0.
  have -> : map_mx polyC (zrow_of (w1, w2)) = beside (map_mx polyC (mx Kc 1 n w1)) (fun k => map_mx polyC (mx Kc 1 (q k) (nth [::] w2 k))).
    rewrite /zrow_of /beside map_row_mx; congr row_mx; apply/mxrowP=> k; rewrite mxrowK.
    have := mxrowK (fun k => mx Kc 1 (q k) (nth [::] w2 k)) k; move: (mxrow _) => N; by rewrite /submxrow -map_mxsub => ->.
  rewrite /M beside_matrix; congr row_mx; last first.
    apply/mxrowP=> k; rewrite mxrowK submxrow0 /= -map_mxM eB /over -scalemxAr -(zmmE _ _ _ _ (eq_leq (shape_size (represented_channel re k).1))).
    by rewrite zmat0E ?scaler0 ?map_mx0 //; apply: ins; rewrite -em.
  rewrite scaleN1r /= -map_mxM addrAC -eT addrC; congr (_ + _).
  rewrite addrC (map_mx_sum [rmorphism of polyC]); congr (_ - _).
  by apply: eq_bigr => k _; rewrite map_mxM.
rewrite mulmxDl wM -scalemxAl.
have -> : polynomial_row ws *m M = - row_mx (map_mx polyC (mx Kc 1 n w1)) 0 by apply/eqP; rewrite -addr_eq0 IH.
rewrite scalerN scale_row_mx scaler0 opp_row_mx oppr0 !add_row_mx !addr0 -[RHS](row_mx0 _ 1 n (\sum_i p i)); congr row_mx.
by rewrite addrAC subrK subrr.
Qed.
Lemma zsome_sound w : zsome n (map zq (zchannels s)) w -> zrow_of w != 0.
Proof.
case: (re) => _ en em ep eq _ _ _.
have lt k c d : (k < if c < d then c else d)%N -> (k < c)%N by case: (ltnP c d) => // dc kd; apply: leq_trans kd dc.
have nz b (W : zmat) : has (fun x => ~~ Z.eqb x 0) (take b (nth [::] W 0)) -> mx Kc 1 b W != 0.
  case/(has_nthP z0)=> j; rewrite size_take => /lt jb; rewrite nth_take // => ne.
  apply: contraNneq (phi_neq0 h ne) => /matrixP/(_ 0 (Ordinal jb)); by rewrite !mxE /= => ->.
case/orP=> [/nz|/(has_nthP (0%N, [::]))[k]].
  by apply: contraNneq; rewrite /zrow_of /beside -(row_mx0 _ 1 n (\sum_i q i)) => /eq_row_mx[->].
rewrite size_zip size_map leq_min => /andP[km kw]; rewrite -em in km; set i := Ordinal km.
rewrite nth_zip_cond size_zip size_map leq_min -em km kw /= (nth_map zch0) -?em // -[nth zch0 _ k]/(channel s i) -eq => /nz.
apply: contraNneq; rewrite /zrow_of /beside -(row_mx0 _ 1 n (\sum_i q i)) => /eq_row_mx[_ /mxrowP/(_ i)].
by rewrite mxrowK submxrow0 => ->.
Qed.
Theorem normal_rank ws lambda : zgone s [::] ws -> has (zsome n (map zq (zchannels s))) ws ->
  (\rank (system_matrix S (-1) lambda) < n + \sum_i q i)%N.
Proof.
move=> /zgone_sound; rewrite mx_nil map_mx0 row_mx0 addr0 => gone /(has_nthP ([::], [::]))[k kw some].
have nw : polynomial_row ws != 0.
  apply: contraNneq (zsome_sound some) => e; apply/eqP/matrixP=> i j; by rewrite ord1 -polynomial_row_coef e !mxE coef0.
have := normal_rank_deficient lambda nw gone; congr (\rank _ < _)%N.
rewrite /M /system_matrix map_block_mx map_mx0 map_inputs map_outputs map_mxD map_mxZ map_scalar_mx /= rmorphN1 /horner_eval hornerX.
have const a b (N : 'M[K]_(a, b)) : map_mx (horner_eval lambda) (map_mx polyC N) = N by apply/matrixP=> i j; rewrite !mxE /horner_eval hornerC.
congr block_mx; first by rewrite const.
  by apply: eq_mxrow => k'; case: ifP => //= _; rewrite const.
by apply: eq_mxcol => k'; case: ifP => //= _; rewrite const.
Qed.
End Normal.

(* The claim. *)
Record zsetpoint := ZSetpoint { p_solvable : bool; p_rank : nat; p_zero : option bool }.
Definition setpoint_holds (discrete : bool) (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) (c : zsetpoint) : Prop :=
  [/\ \rank (system_matrix S 1 (- discrete%:R)) = p_rank c, p_solvable c = (p_rank c == n + \sum_i q i)%N &
      match p_zero c with
      | None => p_solvable c
      | Some true => ~~ p_solvable c /\ exists x, \rank (system_matrix S (-1) x) = (n + \sum_i q i)%N
      | Some false => ~~ p_solvable c /\ forall x, (\rank (system_matrix S (-1) x) < n + \sum_i q i)%N end].
Record setpoint_witness := SetpointWitness { sp_below : below_witness; sp_above : above_witness; sp_point : Z; sp_full : below_witness;
  sp_row : seq (zmat * seq zmat) }.
Definition check_setpoint (s : zsystem) (discrete : bool) (c : zsetpoint) (w : setpoint_witness) : bool :=
  let: (rows, b) := ((zn s + sumn (map zq (zchannels s)))%N, if discrete then (-1)%coqZ else z0) in
  [&& check_below s 1 b (sp_below w), check_above s 1 b (sp_above w), size (w_columns (sp_below w)) == p_rank c,
      size (x_places (sp_above w)) + p_rank c == rows & [&& p_solvable c == (p_rank c == rows) &
      match p_zero c with
      | None => p_solvable c
      | Some true => [&& ~~ p_solvable c, check_below s (-1) (sp_point w) (sp_full w) & size (w_columns (sp_full w)) == rows]
      | Some false => [&& ~~ p_solvable c, zgone s [::] (sp_row w) & has (zsome (zn s) (map zq (zchannels s))) (sp_row w)] end]]%N.

Theorem check_setpoint_sound s discrete c w : check_setpoint s discrete c w -> forall (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat)
  (S : multichannel K n p q), represents s S -> setpoint_holds discrete S c.
Proof.
move=> ok K h n m p q S re; case: (re) => _ en em ep eq _ _ _; move: ok; rewrite /check_setpoint -en.
have -> : sumn (map zq (zchannels s)) = (\sum_i q i)%N.
  rewrite sumnE big_map (big_nth zch0) big_mkord -em; apply: eq_bigr => k _; by rewrite eq.
set b := if _ then _ else _; have eb : phi [comRingType of K] b = - discrete%:R by rewrite /b; case: (discrete); rewrite ?oppr0.
case/and5P=> /(check_below_sound h re) low /(check_above_sound h re) up /eqP sl /eqP su /andP[/eqP solv zero].
rewrite eb phi1 sl in low up; split=> //.
  by apply/eqP; rewrite eqn_leq low andbT -(leq_add2l (size (x_places (sp_above w)))) su addnC.
move: zero; case: (p_zero c) => [[]|] //; last by case/and3P=> not gone some; split=> // x; exact: (normal_rank h re x gone some).
case/and3P=> not /(check_below_sound h re); rewrite phiN1 => full /eqP sf; split=> //; exists (phi [comRingType of K] (sp_point w)).
by apply/eqP; rewrite eqn_leq rank_leq_row -{1}sf.
Qed.
