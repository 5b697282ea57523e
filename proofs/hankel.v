(* checker/modes.py: the McMillan degree from below; kind `assignability`.

   A monic d of degree L with sum_j d_j s_(k+j) = 0 for k < L - 1, and with a num + e d = 1, makes the
   Hankel matrix (s_(i+j)) of L rows invertible, over every commutative ring.  So no realization of the
   sequence has less than L states. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic controllability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Pdiv.Ring Pdiv.CommonRing Pdiv.RingMonic.
Local Open Scope ring_scope.

Section Hankel.
Variables (R : comRingType) (d : {poly R}) (L : nat).
Hypothesis monic_d : d \is monic.
Hypothesis size_d : size d = L.+1.
Implicit Types (f g : {poly R}) (c : R).

(* The coefficient of x^(L-1) of the remainder. *)
Definition top f : R := (rmodp f d)`_L.-1.

Lemma topD f g : top (f + g) = top f + top g.
Proof. by rewrite /top rmodpD// coefD. Qed.
Lemma top_mul f g : top (f * d + g) = top g.
Proof. by rewrite topD /top rmodp_mull// coef0 add0r. Qed.
Lemma top_small f : (size f <= L)%N -> top f = f`_L.-1.
Proof. by move=> sf; rewrite /top rmodp_small// size_d ltnS. Qed.
Lemma topZ c f : top (c *: f) = c * top f.
Proof.
rewrite {1}(rdivp_eq monic_d f) scalerDr scalerAl top_mul top_small ?coefZ//.
have d0 : d != 0 by rewrite monic_neq0.
by apply: leq_trans (size_scale_leq _ _) _; rewrite -ltnS -size_d ltn_rmodp.
Qed.
Lemma top0 : top 0 = 0.
Proof. by rewrite -(scale0r 0) topZ mul0r. Qed.
Lemma top_sum I r (P : pred I) (f : I -> {poly R}) : top (\sum_(i <- r | P i) f i) = \sum_(i <- r | P i) top (f i).
Proof. exact: (big_morph top topD top0). Qed.

(* The dual basis of 1, x, ..., x^(L-1). *)
Definition dual i : {poly R} := \poly_(m < L - i) d`_(m + i.+1).

Lemma dual_size i : (size (dual i) <= L - i)%N. Proof. exact: size_poly. Qed.

Lemma top_dual k i : (k < L)%N -> (i < L)%N -> top ('X^k * dual i) = (k == i)%:R.
Proof.
move=> kL iL; have eL : L = L.-1.+1 by case: (L) kL.
have [ki|ik] := leqP k i.
  have sz : (size ('X^k * dual i)%R <= L)%N.
    apply: leq_trans (size_mul_leq _ _) _; rewrite size_polyXn /=.
    apply: leq_trans (leq_add ki (dual_size i)) _.
    by rewrite subnKC// ltnW.
  rewrite top_small// coefXnM ltnNge -ltnS -eL kL /= coef_poly.
  have e1 : (L.-1 - k = L - k.+1)%N by rewrite [in RHS]eL subSS.
  have [e|ne] := eqVneq k i.
    rewrite e1 -e ltn_sub2l// subnK//.
    by move/monicP: monic_d; rewrite /lead_coef size_d.
  by rewrite ifF//; apply/negbTE; rewrite -leqNgt e1 leq_sub2l// ltn_neqAle ne.
rewrite (gtn_eqF ik).
have e : 'X^(i.+1) * dual i = d - \poly_(m < i.+1) d`_m.
  apply/polyP => j; rewrite coefXnM coefB [(\poly_(_ < i.+1) _)`_j]coef_poly ltnS.
  have [ji|ij] := leqP j i; first by rewrite subrr.
  rewrite subr0 coef_poly subnK//; have [//|Lj] := ltnP (j - i.+1) (L - i).
  rewrite nth_default// size_d.
  have : (L - i + i.+1 <= j - i.+1 + i.+1)%N by rewrite leq_add2r.
  by rewrite addnS !subnK// ltnW.
have -> : 'X^k * dual i = 'X^(k - i.+1) * d + - ('X^(k - i.+1) * \poly_(m < i.+1) d`_m).
  by rewrite -mulrBr -e mulrA -exprD subnK.
rewrite top_mul -scaleN1r topZ.
have sz : (size ('X^(k - i.+1) * \poly_(m < i.+1) d`_m : {poly R})%R <= k)%N.
  apply: leq_trans (size_mul_leq _ _) _; rewrite size_polyXn /=.
  by apply: leq_trans (leq_add (leqnn _) (size_poly _ _)) _; rewrite subnK.
rewrite top_small; last exact: leq_trans sz (ltnW kL).
by rewrite nth_default ?mulr0// (leq_trans sz)// -ltnS -eL.
Qed.

(* A sequence s, and the polynomial part of d times the series of s: its coefficient of x^i is
   sum_(j > i) d_j s_(j-i-1). *)
Variable s : nat -> R.
Definition num : {poly R} := \sum_(m < L) s m *: dual m.
Hypothesis recurrence : forall k, (k.+1 < L)%N -> \sum_(j < L.+1) d`_j * s (k + j) = 0.

Lemma top_num k : (k < L)%N -> top ('X^k * num) = s k.
Proof.
move=> kL; rewrite mulr_sumr top_sum (bigD1 (Ordinal kL))//= -scalerAr topZ top_dual// eqxx mulr1.
rewrite big1 ?addr0// => m ne; rewrite -scalerAr topZ top_dual//.
by rewrite [k == m](_ : _ = false) ?mulr0//; apply: contraNF ne => /eqP e; apply/eqP/val_inj.
Qed.

Lemma top_series k : (k < L + L.-1)%N -> top ('X^k * num) = s k.
Proof.
elim/ltn_ind: k => k IH kL; have [/top_num//|Lk] := ltnP k L.
have L0 : (0 < L)%N by case: (L) kL.
have ek : (k - L + L = k)%N by rewrite subnK.
have k'L : ((k - L).+1 < L)%N by rewrite -[X in (_ < X)%N]prednK// ltnS ltn_subLR.
have z : top ('X^(k - L) * num * d) = 0 by rewrite -[X in top X]addr0 top_mul top0.
have dE : d = \sum_(j < L.+1) d`_j *: 'X^j by rewrite -{1}[d]coefK poly_def size_d.
have dL : d`_L = 1 by move/monicP: monic_d; rewrite /lead_coef size_d.
move: z; rewrite [X in _ * X]dE mulr_sumr top_sum big_ord_recr/= => z.
move: z; rewrite -scalerAr topZ mulrAC -exprD ek dL mul1r => z.
have := etrans z (esym (recurrence k'L)); rewrite big_ord_recr/= ek dL mul1r => e.
suff same : \sum_(j < L) d`_j * s (k - L + j) = \sum_(j < L) top ('X^(k - L) * num * (d`_j *: 'X^j)).
  by move: e; rewrite same => /addrI.
apply: eq_bigr => j _; rewrite -scalerAr topZ mulrAC -exprD IH//.
  by rewrite -[X in (_ < X)%N]ek ltn_add2l.
by apply: ltn_trans kL; rewrite -[X in (_ < X)%N]ek ltn_add2l.
Qed.

Lemma hankel_invertible a e : a * num + e * d = 1 ->
  exists Y : 'M_L, (\matrix_(i < L, j < L) s (i + j)) *m Y = 1%:M.
Proof.
move=> bez; exists (\matrix_(j, i) (rmodp (a * dual i) d)`_j); apply/matrixP => k i; rewrite !mxE.
set g := rmodp (a * dual i) d; have d0 : d != 0 by rewrite monic_neq0.
have sg : (size g <= L)%N by rewrite -ltnS -size_d ltn_rmodp.
have gE : g = \sum_(j < L) g`_j *: 'X^j.
  rewrite -poly_def; apply/polyP => j; rewrite coef_poly; case: ltnP => // Lj.
  by rewrite nth_default// (leq_trans sg).
have sum_top : \sum_(j < L) s (k + j) * g`_j = top ('X^k * num * g).
  rewrite [X in _ = top (_ * X)]gE mulr_sumr top_sum; apply: eq_bigr => j _.
  rewrite -scalerAr topZ mulrAC -exprD top_series 1?mulrC//.
  have eL : L = L.-1.+1 by case: (L) k => [[]|].
  by rewrite -addSn leq_add// -ltnS -eL.
rewrite (eq_bigr (fun j : 'I_L => s (k + j) * g`_j)); last by move=> j _; rewrite !mxE.
rewrite sum_top.
rewrite -(top_mul ('X^k * num * rdivp (a * dual i) d)) -mulrA -mulrDr -(rdivp_eq monic_d).
have -> : 'X^k * num * (a * dual i) = - ('X^k * dual i * e) * d + 'X^k * dual i.
  have -> : 'X^k * num * (a * dual i) = 'X^k * dual i * (a * num) by rewrite -!mulrA; congr (_ * _); rewrite mulrC -mulrA mulrCA.
  by rewrite (canRL (addrK _) bez) mulrBr mulr1 mulNr mulrA addrC.
by rewrite top_mul top_dual.
Qed.
End Hankel.

Section Markov.
Variable L : fieldType.

Lemma krylov_one n b (A : 'M[L]_n) (B : 'M_(n, b)) i j :
  krylov A 1%:M i *m krylov A B j = krylov A B (i + j).
Proof. by elim: i => [|i IH]; rewrite ?mul1mx// addSn !krylovS -mulmxA IH. Qed.

(* Feedback changes the Markov parameters in a way that depends on these alone. *)
Lemma krylov_loop n p q (A : 'M[L]_n) (B : 'M_(n, p)) (C : 'M_(q, n)) (F : 'M_(p, q)) k :
  krylov (A + B *m F *m C) B k = krylov A B k +
    \sum_(i < k) krylov A B i *m F *m (C *m krylov (A + B *m F *m C) B (k - i.+1)).
Proof.
elim: k => [|k IH]; first by rewrite big_ord0 addr0.
rewrite big_ord_recl subSS subn0 [LHS]krylovS mulmxDl {1}IH mulmxDr -krylovS -addrA; congr (_ + _).
rewrite addrC; congr (_ + _); first by rewrite -mulmxA.
rewrite mulmx_sumr; apply: eq_bigr => i _; rewrite lift0 subSS krylovS.
by rewrite -!mulmxA.
Qed.

Lemma loops_agree n n' p q (A : 'M[L]_n) (B : 'M_(n, p)) (C : 'M_(q, n)) (A' : 'M_n') B' C' F :
  (forall k, C *m krylov A B k = C' *m krylov A' B' k) ->
  forall k, C *m krylov (A + B *m F *m C) B k = C' *m krylov (A' + B' *m F *m C') B' k.
Proof.
move=> same; elim/ltn_ind => k IH; rewrite !krylov_loop !mulmxDr same; congr (_ + _).
rewrite !mulmx_sumr; apply: eq_bigr => i _; rewrite !mulmxA same -[in RHS]mulmxA -IH ?mulmxA//.
by rewrite ltn_subrL (leq_trans _ (ltn_ord i)).
Qed.
End Markov.

Section Below.
Variables (l : modulus) (d : {poly 'Z_l}) (L : nat) (s : nat -> Zloc l) (a e : {poly 'Z_l}).
Local Notation residues := (fun k => residue (s k)).
Hypothesis monic_d : d \is monic.
Hypothesis size_d : size d = L.+1.
Hypothesis recurrence : forall k, (k.+1 < L)%N -> \sum_(j < L.+1) d`_j * residues (k + j)%N = 0.
Hypothesis bezout : a * num d L residues + e * d = 1.

(* A sequence of degree L has no realization of less than L states. *)
Lemma degree_from_below r (A : 'M[rat]_r) (B : 'cV_r) (C : 'rV_r) :
  (forall k, C *m krylov A B k = (Zloc_rat (s k))%:M) -> (L <= r)%N.
Proof.
move=> real; have [Y HY] := hankel_invertible monic_d size_d recurrence bezout.
pose H := \matrix_(i < L, j < L) s (i + j)%N.
have rH : 1%:M *m map_mx (@residue l) H *m Y = 1%:M.
  rewrite mul1mx -HY; congr (_ *m _); by apply/matrixP => i j; rewrite !mxE.
apply: leq_trans (rank_from_below [rmorphism of (@idfun rat)] rH) _.
pose O := \matrix_(i < L) (C *m krylov A 1%:M i); pose P := \matrix_(t < r, j < L) krylov A B j t 0.
suff -> : map_mx (fun x => idfun (Zloc_rat x)) H = O *m P by apply: leq_trans (mxrankM_maxr _ _) (rank_leq_row _).
apply/matrixP => i j; rewrite !mxE /=; have := real (i + j)%N; rewrite -krylov_one mulmxA.
move/matrixP/(_ 0 0); rewrite !mxE /= mulr1n => <-.
by apply: eq_bigr => t _; rewrite !mxE.
Qed.

(* Kind `assignability`: so has every transfer matrix with such a sequence in one of its loops. *)
Theorem mcmillan_from_below n p q (A : 'M[rat]_n) (B : 'M_(n, p)) (C : 'M_(q, n)) F (x : 'cV_p) (y : 'rV_q)
    r (A' : 'M[rat]_r) B' C' :
  (forall k, y *m C *m krylov (A + B *m F *m C) (B *m x) k = (Zloc_rat (s k))%:M) ->
  (forall k, C *m krylov A B k = C' *m krylov A' B' k) -> (L <= r)%N.
Proof.
move=> seq same; apply: (@degree_from_below r (A' + B' *m F *m C') (B' *m x) (y *m C')) => k; rewrite -seq.
have kx m (N : 'M[rat]_m) (M : 'M_(m, p)) : krylov N (M *m x) k = krylov N M k *m x.
  by elim: k => [//|j IH]; rewrite !krylovS IH mulmxA.
by rewrite !kx !mulmxA -!(mulmxA y) (loops_agree F same).
Qed.
End Below.
