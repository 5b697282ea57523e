(* Lemma 3: (M + gA, B) keeps the controllability index of (A, B) for all but finitely many g.
   A rank that a polynomial matrix has at one point it has at all but finitely many. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability joint_controllability.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* the value of a polynomial matrix at x *)
Notation at_point x M := (map_mx (horner_eval x) M).
Notation constant M := (map_mx polyC M).

Section Generic.
Variable L : fieldType.

Lemma at_constant a b (M : 'M[L]_(a, b)) x : at_point x (constant M) = M.
Proof. by apply/matrixP => i j; rewrite !mxE /horner_eval hornerC. Qed.

Lemma at_line a b (M N : 'M[L]_(a, b)) x : at_point x (constant M + 'X *: constant N) = M + x *: N.
Proof.
by apply/matrixP => i j; rewrite !mxE /horner_eval hornerD hornerM hornerX !hornerC.
Qed.

Theorem generic_rank a b (M : 'M[{poly L}]_(a, b)) x0 :
  exists2 D : {poly L}, D.[x0] != 0 &
    forall x, D.[x] != 0 -> (\rank (at_point x0 M) <= \rank (at_point x M))%N.
Proof.
set A := at_point x0 M; pose X := pinvmx (col_base A); pose Y := pinvmx (row_base A).
have e : X *m A *m Y = 1%:M.
  rewrite -[A in X *m A](mulmx_base A) mulmxA mulVpmx ?col_base_full // mul1mx.
  by rewrite mulmxVp // row_base_free.
have eD x : (\det (constant X *m M *m constant Y)).[x] = \det (X *m at_point x M *m Y).
  by rewrite -/(horner_eval x _) -det_map_mx !map_mxM !at_constant.
exists (\det (constant X *m M *m constant Y)); first by rewrite eD e det1 oner_neq0.
move=> x; rewrite eD -unitfE -unitmxE => /mxrank_unit <-.
exact: leq_trans (mxrankM_maxl _ _) (mxrankM_maxr _ _).
Qed.

(* any list of distinct exceptions is no longer than the degree of D *)
Lemma exceptions_bound (P : pred L) (D : {poly L}) : D != 0 ->
  (forall x, D.[x] != 0 -> P x) ->
  forall xs, uniq xs -> all (predC P) xs -> (size xs < size D)%N.
Proof.
move=> D0 h xs uxs /allP ex; apply: max_poly_roots => //; apply/allP => x /ex /=.
by apply: contraR => /h.
Qed.

End Generic.

Section Infinite.

Definition infinite (K : eqType) := forall xs : seq K, exists x, x \notin xs.

Lemma infinite_uniq (K : eqType) : infinite K -> forall d, exists xs : seq K, uniq xs /\ size xs = d.
Proof.
move=> inf; elim=> [|d [xs [u sz]]]; first by exists [::].
by have [x nx] := inf xs; exists (x :: xs); rewrite /= nx u sz.
Qed.

(* an infinite field has a point where a nonzero polynomial over an extension does not vanish *)
Lemma infinite_nonroot (K L : fieldType) (f : {rmorphism K -> L}) (D : {poly L}) :
  infinite K -> D != 0 -> exists x, D.[f x] != 0.
Proof.
move=> inf D0; have [xs [u sz]] := infinite_uniq inf (size D).
have [/allP h|/allPn[x _ nx]] := boolP (all (fun x => D.[f x] == 0) xs); last by exists x.
have : (size (map f xs) < size D)%N.
  apply: max_poly_roots => //; last by rewrite map_inj_uniq //; apply: fmorph_inj.
  by apply/allP => _ /mapP[x /h hx ->].
by rewrite size_map sz ltnn.
Qed.

Lemma char0_infinite (K : fieldType) : [char K] =i pred0 -> infinite K.
Proof.
move=> c0 xs; pose ys := [seq (i%:R : K) | i <- iota 0 (size xs).+1].
have [/allP h|/allPn[y _ ny]] := boolP (all (mem xs) ys); last by exists y.
have u : uniq ys.
  rewrite map_inj_in_uniq ?iota_uniq // => i j _ _ /eqP.
  wlog ij : i j / (i <= j)%N.
    by move=> w; case/orP: (leq_total i j) => ?; [apply: w|rewrite eq_sym => /w <-].
  rewrite eq_sym -subr_eq0 -natrB // (charf0P _).1 // subn_eq0 => ji.
  by apply/eqP; rewrite eqn_leq ij.
by have := uniq_leq_size u h; rewrite size_map size_iota ltnn.
Qed.

End Infinite.

Section Gains.
Variables (K : fieldType) (n r : nat).
Implicit Types (A M : 'M[K]_n) (B : 'M[K]_(n, r)).

Lemma krylov_scale A B c i : krylov (c *: A) B i = c ^+ i *: krylov A B i.
Proof.
elim: i => [|i IH]; first by rewrite expr0 scale1r.
by rewrite !krylovS IH -scalemxAl -scalemxAr scalerA -exprS.
Qed.

Lemma rank_reach_scale A B c k : c != 0 -> \rank (reach (c *: A) B k) = \rank (reach A B k).
Proof.
move=> c0; rewrite -(subKn (rank_leq_row (reach (c *: A) B k))) -[RHS](subKn (rank_leq_row _)).
congr (_ - _)%N; rewrite -!mxrank_ker; apply: eqmx_rank; apply/andP; split; apply/sub_kermxP;
  apply/reach_annihilated => i ik.
  have /reach_annihilated/(_ i ik) := mulmx_ker (reach (c *: A) B k).
  by rewrite krylov_scale -scalemxAr => /eqP; rewrite scaler_eq0 expf_eq0 (negPf c0) andbF => /eqP.
have /reach_annihilated/(_ i ik) := mulmx_ker (reach A B k).
by rewrite krylov_scale -scalemxAr => ->; rewrite scaler0.
Qed.

Lemma generic_reach A0 A1 B k t0 : exists2 D : {poly K}, D.[t0] != 0 &
  forall t, D.[t] != 0 -> (\rank (reach (A0 + t0 *: A1) B k) <= \rank (reach (A0 + t *: A1) B k))%N.
Proof.
have [D D0 h] := generic_rank (reach (constant A0 + 'X *: constant A1) (constant B) k) t0.
exists D => // t /h; rewrite !map_reach !at_line !at_constant; exact.
Qed.

(* Lemma 3, first part: nu blocks of (M + gA, B) reach rank n for all g but 0 and the inverses of
   the roots of one nonzero polynomial *)
Theorem lemma_3_polynomial A B M nu : \rank (reach A B nu) = n ->
  exists2 D : {poly K}, D.[0] != 0 &
    forall g, g != 0 -> D.[g^-1] != 0 -> \rank (reach (M + g *: A) B nu) = n.
Proof.
move=> rn; have [D D0 h] := generic_reach A M B nu 0; exists D => // g g0 /h.
rewrite scale0r addr0 rn => le; apply/eqP; rewrite eqn_leq rank_leq_row (leq_trans le) //.
rewrite -(rank_reach_scale (A + g^-1 *: M) B nu g0) scalerDr scalerA divff // scale1r.
by rewrite addrC.
Qed.

(* at most finitely many g fail *)
Theorem lemma_3 A B M nu : controllability_index A B nu ->
  exists d, forall gs : seq K, uniq gs ->
    all (fun g => \rank (reach (M + g *: A) B nu) != n) gs -> (size gs <= d)%N.
Proof.
case=> rn _; have [D D0 h] := lemma_3_polynomial M rn; exists (size D) => gs u /allP bad.
have Dn0 : D != 0 by apply: contraNneq D0 => ->; rewrite horner0.
pose hs := [seq g^-1 | g <- gs & g != 0].
have : (size hs < size D)%N.
  apply: max_poly_roots => //; last by rewrite map_inj_uniq ?filter_uniq //; apply: invr_inj.
  apply/allP => x /mapP[g]; rewrite mem_filter => /andP[g0 /bad bg] ->.
  by rewrite /root; apply: contraNT bg => /(h _ g0) ->.
rewrite size_map size_filter => lt; apply: leq_trans lt.
rewrite -(count_predC (fun g => g != 0)) -addn1 leq_add2l.
rewrite (eq_count (a2 := pred1 0)) => [|g]; last by rewrite /= negbK.
by rewrite count_uniq_mem //; case: (_ \in _).
Qed.

(* Lemma 3, second part: if nu r = n the index itself is kept *)
Theorem lemma_3_index A B M nu : controllability_index A B nu -> (nu * r)%N = n ->
  exists d, forall gs : seq K, uniq gs ->
    (forall g, g \in gs -> ~ controllability_index (M + g *: A) B nu) -> (size gs <= d)%N.
Proof.
move=> idx e; have [d h] := lemma_3 M idx; exists d => gs u bad; apply: h => //.
apply/allP => g /bad nidx; apply/eqP => rg; apply: nidx; split=> // j jnu.
apply: leq_ltn_trans (rank_leq_col _) _; rewrite sum_nat_const card_ord -[X in (_ < X)%N]e.
rewrite ltn_pmul2r //; case: (posnP r) => // r0; case: idx => _ /(_ _ jnu).
have n0 : n = 0%N by rewrite -e r0 muln0.
by rewrite [X in (_ < X)%N]n0.
Qed.

End Gains.
