(* One Krylov sequence s_k = c A^k b of one closed loop, and what a recurrence of it proves: the first
   theorems of krylov.md, over every commutative ring.

   b and c are one input and one output; N = c adj(xI - A) b, so that N / chi_A = sum_k s_k x^(-k-1). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Sequence.
Variables (R : ringType) (n : nat).
Implicit Types (A : 'M[R]_n) (b : 'cV[R]_n) (c : 'rV[R]_n) (s : nat -> R) (d : {poly R}).

(* s_k = c A^k b *)
Definition markov A b c k : R := (c *m krylov A b k) 0 0.

(* The polynomial part of d sum_k s_k x^(-k-1), and the coefficient of x^(-k-1) in the same product. *)
Definition numerator s d : {poly R} :=
  \poly_(i < (size d).-1) \sum_(j < size d | (i < j)%N) d`_j * s (j - i.+1)%N.
Definition recurrence s d k : R := \sum_(j < size d) d`_j * s (k + j)%N.
End Sequence.

Section Map.
Variables (R R' : ringType) (f : {rmorphism R -> R'}) (n : nat).
Lemma map_markov (A : 'M[R]_n) b c k : f (markov A b c k) = markov (map_mx f A) (map_mx f b) (map_mx f c) k.
Proof. by rewrite /markov -map_krylov -map_mxM [RHS]mxE. Qed.
End Map.

Lemma monic_cancel (R : ringType) (d x y : {poly R}) : d \is monic -> d * x = d * y -> x = y.
Proof. by move=> /monicP md; apply: lreg_lead; rewrite md; apply: lreg1. Qed.

Section Ring.
Variables (R : comRingType) (n : nat).
Implicit Types (A : 'M[R]_n) (b : 'cV[R]_n) (c : 'rV[R]_n) (d : {poly R}).

(* N = c adj(xI - A) b *)
Definition response A b c : {poly R} := transfer A b c 0 0.

(* c adj(xI - A) A b = x N - chi_A c b *)
Lemma response_step A b c : response A (A *m b) c = 'X * response A b c - char_poly A * (markov A b c 0)%:P.
Proof.
have e : map_mx polyC A = 'X%:M - char_poly_mx A by rewrite /char_poly_mx opprB addrC subrK.
rewrite /response /transfer map_mxM e mulmxBl mulmxBr mul_scalar_mx -scalemxAr mulmxA.
rewrite -(mulmxA _ (\adj _)) mul_adj_mx mul_mx_scalar -scalemxAl -map_mxM.
rewrite [LHS]mxE [X in X + _]mxE [X in _ + X]mxE [X in - X]mxE [X in _ - _ * X]mxE.
by congr (_ - _ * _).
Qed.

Lemma response_krylov A b c j : response A (krylov A b j) c =
  'X^j * response A b c - char_poly A * \sum_(i < j) markov A b c i *: 'X^(j - i.+1).
Proof.
elim: j => [|j IH]; first by rewrite big_ord0 mulr0 subr0 expr0 mul1r.
rewrite krylovS response_step IH mulrBr mulrA -exprS -addrA -opprD; congr (_ - _).
rewrite big_ord_recr /= subnn expr0 mulrDr alg_polyC mulrCA; congr (_ * _ + _ * _).
rewrite mulr_sumr; apply: eq_bigr => i _.
by rewrite -scalerAr -exprS subSn ?ltn_ord.
Qed.

(* d(A) b *)
Definition applied A b d : 'cV[R]_n := \sum_(j < size d) d`_j *: krylov A b j.

Lemma markov_applied A b c d k : markov A (applied A b d) c k = recurrence (markov A b c) d k.
Proof.
rewrite /markov; have -> : krylov A (applied A b d) k = \sum_(j < size d) d`_j *: krylov A b (k + j).
  elim: k => [//|k IH]; rewrite krylovS IH mulmx_sumr; apply: eq_bigr => j _.
  by rewrite -scalemxAr -krylovS.
rewrite mulmx_sumr summxE; apply: eq_bigr => j _.
by rewrite -scalemxAr mxE.
Qed.

(* d annihilates the row c from the right: sum_j d_j c A^j = 0, and no number of the sequence is needed. *)
Theorem annihilated_recurrence A b c d :
  \sum_(j < size d) d`_j *: (c *m krylov A 1%:M j) = 0 -> forall k, recurrence (markov A b c) d k = 0.
Proof.
move=> z k; have e j : krylov A b (k + j) = krylov A 1%:M j *m krylov A b k.
  by elim: j => [|j IH]; rewrite ?addn0 ?mul1mx// addnS !krylovS IH mulmxA.
transitivity (((\sum_(j < size d) d`_j *: (c *m krylov A 1%:M j)) *m krylov A b k) 0 0); last first.
  by rewrite z mul0mx mxE.
rewrite mulmx_suml summxE; apply: eq_bigr => j _.
by rewrite -scalemxAl [RHS]mxE -mulmxA -e.
Qed.

Lemma numeratorE (s : nat -> R) d :
  numerator s d = \sum_(j < size d) (d`_j)%:P * \sum_(i < j) s i *: 'X^(j - i.+1).
Proof.
apply/polyP=> k; rewrite coef_sum coef_poly.
transitivity (\sum_(j < size d | (k < j)%N) d`_j * s (j - k.+1)%N).
  case: ltnP => // dk; rewrite big1// => j kj; have := ltn_ord j.
  by rewrite ltnNge (leq_trans (leq_trans (leqSpred _) (dk : (_ < k.+1)%N)) kj).
rewrite big_mkcond; apply: eq_bigr => j _; rewrite coefCM coef_sum; case: ltnP => [kj|jk].
  have jl : (j - k.+1 < j)%N by rewrite -subn_gt0 subKn.
  rewrite (bigD1 (Ordinal jl))//= coefZ coefXn big1 => [|i].
    by rewrite subnSK// subKn// 1?ltnW// eqxx mulr1 addr0.
  rewrite -val_eqE /= coefZ coefXn => ne; case: eqP => [e|]; last by rewrite mulr0.
  by case/eqP: ne; rewrite e subnSK ?subKn// ltnW.
rewrite big1 ?mulr0// => i _; rewrite coefZ coefXn gtn_eqF ?mulr0//.
by rewrite (leq_trans _ jk)// -subn_gt0 subKn.
Qed.

(* d N - chi num is the numerator of d(A) b. *)
Lemma response_applied A b c d : response A (applied A b d) c =
  d * response A b c - char_poly A * numerator (markov A b c) d.
Proof.
transitivity (\sum_(j < size d) (d`_j)%:P * response A (krylov A b j) c).
  rewrite /response /transfer /applied map_mx_sum mulmx_sumr summxE; apply: eq_bigr => j _.
  by rewrite map_mxZ -scalemxAr [LHS]mxE.
under eq_bigr => j _ do rewrite response_krylov mulrBr mulrA [X in _ - X]mulrCA.
rewrite sumrB -mulr_suml -mulr_sumr -numeratorE; congr (_ * _ - _).
by rewrite -[RHS]coefK poly_def; apply: eq_bigr => j _; rewrite mul_polyC.
Qed.

(* If the recurrence holds for k < K, the degree of N for d(A) b is below n - K. *)
Lemma size_applied A b c d K : (forall k, (k < K)%N -> recurrence (markov A b c) d k = 0) ->
  (size (response A (applied A b d) c) <= n - K)%N.
Proof.
move=> rec; apply/leq_sizeP => j; rewrite leq_subLR addnC => jK.
have [t /(_ t (leqnn _)) e] := adj_markov A (applied A b d) c j.
rewrite transfer_coef e summxE big1// => i _; rewrite mxE.
have [iK|Ki] := ltnP i K.
  by rewrite -[X in _ * X]/(markov A (applied A b d) c i) markov_applied rec ?mulr0.
rewrite nth_default ?mul0r// size_char_poly ltnS (leq_trans jK)// leq_add2l//.
Qed.

(* The recurrence for k < n, d monic and coprime to its numerator: d divides chi. *)
Theorem krylov_factor A b c d a e : let num := numerator (markov A b c) d in
  let h := a * response A b c + e * char_poly A in
  d \is monic -> (forall k, (k < n)%N -> recurrence (markov A b c) d k = 0) -> a * num + e * d = 1 ->
  [/\ char_poly A = d * h, response A b c = num * h, h \is monic & (size d + size h = n.+2)%N].
Proof.
move=> num h md rec bez; have dN : d * response A b c = char_poly A * num.
  apply/eqP; rewrite -subr_eq0 -response_applied -size_poly_leq0.
  by have := size_applied rec; rewrite subnn.
have e1 : char_poly A = d * h.
  rewrite -[LHS]mulr1 -bez /h !mulrDr mulrCA -dN [in RHS]mulrCA; congr (_ + _).
  by rewrite mulrC -mulrA mulrCA.
have mh : h \is monic by rewrite -(monicMl _ md) -e1 char_poly_monic.
split=> //; first by apply: (monic_cancel md); rewrite dN e1 mulrAC -mulrA.
have := size_char_poly A; rewrite e1 size_monicM ?monic_neq0// => <-.
by rewrite prednK// addn_gt0 size_poly_gt0 monic_neq0.
Qed.

(* With d of degree n nothing is left: d = chi. *)
Theorem krylov_whole A b c d a e : let num := numerator (markov A b c) d in
  d \is monic -> size d = n.+1 -> (forall k, (k < n)%N -> recurrence (markov A b c) d k = 0) ->
  a * num + e * d = 1 -> char_poly A = d /\ response A b c = num.
Proof.
move=> num md sd rec bez; have [e1 e2 mh] := krylov_factor md rec bez.
rewrite sd addSn => -[] /eqP; rewrite -[X in _ == X]addn1 eqn_add2l => /size_poly1P[u _ eh].
have h1 : a * response A b c + e * char_poly A = 1.
  by move: mh; rewrite eh monicE lead_coefC => /eqP->.
by split; [rewrite e1 h1 mulr1 | rewrite e2 h1 mulr1].
Qed.

(* The recurrence for k < L - 1 alone, L the degree of d: no monic common divisor of chi and N has a
   degree above n - L. *)
Theorem krylov_degree A b c d a e phi chi0 N0 :
  d \is monic -> (forall k, (k.+2 < size d)%N -> recurrence (markov A b c) d k = 0) ->
  a * numerator (markov A b c) d + e * d = 1 ->
  phi \is monic -> char_poly A = phi * chi0 -> response A b c = phi * N0 -> (size phi + size d <= n.+2)%N.
Proof.
move=> md rec bez mphi eC eN; set num := numerator _ _ in bez.
have m0 : chi0 \is monic by rewrite -(monicMl _ mphi) -eC char_poly_monic.
have s0 : (size phi + size chi0)%N = n.+2.
  have := size_char_poly A; rewrite eC size_monicM ?monic_neq0// => <-.
  by rewrite prednK// addn_gt0 size_poly_gt0 monic_neq0.
rewrite -s0 leq_add2l leqNgt; apply/negP => lt.
have eT : response A (applied A b d) c = phi * (d * N0 - chi0 * num).
  by rewrite response_applied eC eN [d * _]mulrCA -mulrA -mulrBr.
have [z|nz] := eqVneq (d * N0 - chi0 * num) 0.
  have e0 : chi0 = d * (a * N0 + e * chi0).
    move/eqP: z; rewrite subr_eq0 => /eqP z.
    rewrite -[LHS]mulr1 -bez !mulrDr mulrCA -z [in RHS]mulrCA; congr (_ + _).
    by rewrite mulrC -mulrA mulrCA.
  have nh : a * N0 + e * chi0 != 0.
    by apply: contraTneq (monic_neq0 m0) => h0; rewrite e0 h0 mulr0 eqxx.
  move: lt; rewrite e0 size_monicM// ltnNge -ltnS prednK ?addn_gt0 ?size_poly_gt0 ?nh ?orbT//.
  by rewrite -addn1 leq_add2l size_poly_gt0 nh.
have p0 : (0 < size phi)%N by rewrite size_poly_gt0 monic_neq0.
have c0 : (0 < size chi0)%N by rewrite size_poly_gt0 monic_neq0.
have : (size phi <= n - (size d).-2)%N.
  apply: (@leq_trans (size (response A (applied A b d) c))).
    by rewrite eT size_monicM// -subn1 leq_subRL ?addn_gt0 ?p0// addnC leq_add2l size_poly_gt0.
  by apply: size_applied => k kd; apply: rec; case: (size d) kd => [|[|t]].
rewrite leqNgt -[size phi]prednK// ltnS leq_subLR.
case: (size d) lt => [|[|t]] //=; rewrite ltnS => ct; first by move: c0; rewrite ltnNge ct.
move/negP; apply; have : (n.+2 <= size phi + t.+1)%N by rewrite -s0 leq_add2l.
by rewrite -[size phi]prednK// addnS addSn !ltnS addnC.
Qed.

(* A rank-one change of the loop subtracts N: det(xI - A - b c) = chi - N. *)
Theorem char_poly_rank_one A b c : char_poly (A + b *m c) = char_poly A - response A b c.
Proof.
pose M := char_poly_mx A; pose u := map_mx polyC b; pose v := map_mx polyC c; pose y := \adj M *m u.
have My : M *m y = \det M *: u by rewrite mulmxA mul_mx_adj mul_scalar_mx.
have -> : char_poly (A + b *m c) = \det (M - u *m v).
  by rewrite /char_poly /char_poly_mx map_mxD map_mxM opprD addrA.
have -> : response A b c = (v *m y) 0 0 by rewrite /response /transfer mulmxA.
have e1 : \det (block_mx M u v 1%:M) = \det (M - u *m v).
  have -> : block_mx M u v 1%:M = block_mx (M - u *m v) u 0 1%:M *m block_mx 1%:M 0 v 1%:M.
    by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r) subrK.
  by rewrite det_mulmx det_ublock det_lblock !det1 !mulr1.
have e2 : block_mx M u v 1%:M *m block_mx 1%:M (- y) 0 (\det M)%:M =
    block_mx M 0 v ((\det M)%:M - v *m y).
  rewrite mulmx_block !mulmx1 !mulmx0 !addr0 !mulmxN mul_mx_scalar My addNr.
  by rewrite mul_mx_scalar scalemx1 addrC.
apply: (monic_cancel (char_poly_monic A)); rewrite -e1 mulrC.
have := congr1 determinant e2; rewrite det_mulmx det_ublock det_lblock det1 mul1r det_scalar1.
by move=> ->; congr (_ * _); rewrite [X in \det X]mx11_scalar det_scalar1 !mxE eqxx.
Qed.
End Ring.
