(* checker/discs.py and checker/boxes.py: answers for every system whose entries are
   within their radii.

   A matrix near the identity, in rows with positive weights, is regular; so is a pencil on a disc, for every
   member, and outside of the exterior discs no member has an eigenvalue. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel gain_lines.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Dominance.
Variable C : numFieldType.

(* The largest entry of a vector, in weights of the rows; it is not 0 unless the vector is. *)
Lemma largest n (v : 'cV[C]_n) (w : 'I_n -> C) (P : pred 'I_n) i0 : P i0 -> (forall i, P i -> 0 < w i) ->
  exists2 i, P i & forall j, P j -> `|v j 0| <= `|v i 0| / w i * w j.
Proof.
move=> Pi0 w0; pose F j := `|v j 0| / w j.
have F0 i : P i -> 0 <= F i by move=> /w0/ltW wi; rewrite divr_ge0.
have cmp : {in P &, forall i j, F i >=< F j}.
  by move=> i j Pi Pj; apply: real_comparable; rewrite ger0_real ?F0.
have := comparable_arg_maxP Pi0 cmp; case=> i Pi /= top; exists i => // j Pj.
by rewrite -ler_pdivr_mulr ?w0//; apply: top.
Qed.

Lemma kernel_dominant n (M : 'M[C]_n) (w : 'I_n -> C) (v : 'cV[C]_n) : (forall i, 0 < w i) ->
  (forall i, \sum_j `|(i == j)%:R - M i j| * w j < w i) -> M *m v = 0 -> v = 0.
Proof.
move=> w0 near Mv; apply/colP => k; rewrite mxE.
have [i _ top] := largest v (P := predT) (i0 := k) isT (fun i _ => w0 i).
pose mu := `|v i 0| / w i; have mu0 : 0 <= mu by rewrite divr_ge0// ltW.
have vi : `|v i 0| = mu * w i by rewrite divfK// gt_eqF.
have [z|nz] := eqVneq mu 0.
  by apply/normr0_eq0/le_anti; rewrite normr_ge0 andbT; have := top k isT; rewrite -/mu z mul0r.
have e : v i 0 = \sum_j ((i == j)%:R - M i j) * v j 0.
  have := congr1 (fun u : 'cV_n => u i 0) Mv; rewrite !mxE => s.
  rewrite (eq_bigr (fun j => (i == j)%:R * v j 0 - M i j * v j 0)) => [|j _]; last by rewrite mulrBl.
  rewrite sumrB s subr0 (bigD1 i)//= eqxx mul1r big1 ?addr0//.
  by move=> j /negPf ji; rewrite eq_sym ji mul0r.
have : `|v i 0| < mu * w i; last by rewrite vi ltxx.
rewrite {1}e (le_lt_trans (ler_norm_sum _ _ _))//.
apply: (@le_lt_trans _ _ (mu * \sum_j `|(i == j)%:R - M i j| * w j)).
  by rewrite mulr_sumr ler_sum// => j _; rewrite normrM mulrCA ler_wpmul2l// top.
by rewrite ltr_pmul2l// lt0r nz.
Qed.

(* A matrix near the identity is regular. *)
Theorem near_identity n (M : 'M[C]_n) (w : 'I_n -> C) : (forall i, 0 < w i) ->
  (forall i, \sum_j `|(i == j)%:R - M i j| * w j < w i) -> M \in unitmx.
Proof.
move=> w0 near; rewrite -unitmx_tr unitmxE unitfE; apply/negP => /det0P[u nu uM].
case/negP: nu; rewrite -trmx_eq0; apply/eqP/(kernel_dominant w0 near).
by rewrite -[M]trmxK -trmx_mul uM trmx0.
Qed.

(* So is a matrix with a strictly dominant diagonal. *)
Theorem dominant n (M : 'M[C]_n) :
  (forall i, \sum_(j | j != i) `|M i j| < `|M i i|) -> M \in unitmx.
Proof.
move=> dom; have d0 i : M i i != 0.
  by rewrite -normr_gt0 (le_lt_trans _ (dom i))// sumr_ge0.
pose D : 'M[C]_n := \matrix_(i, j) ((i == j)%:R / M i i).
have : D *m M \in unitmx; last by rewrite unitmx_mul => /andP[].
have eD i j : (D *m M) i j = M i j / M i i.
  rewrite mxE (bigD1 i)//= big1 ?addr0 => [|k /negPf ki]; rewrite mxE ?eqxx ?mul1r 1?mulrC//.
  by rewrite eq_sym ki mul0r mulr0.
apply: (@near_identity _ _ (fun=> 1)) => i; first exact: ltr01.
rewrite (bigD1 i)//= eqxx eD divff// subrr normr0 mul0r add0r.
have -> : \sum_(j < n | j != i) `|(i == j)%:R - (D *m M) i j| * 1 = (\sum_(j | j != i) `|M i j|) / `|M i i|.
  rewrite mulr_suml; apply: eq_bigr => j /negPf ji.
  by rewrite eq_sym ji eD sub0r mulr1 normrN normrM normfV.
by rewrite ltr_pdivr_mulr ?normr_gt0// mul1r.
Qed.
End Dominance.

(* Pencils lambda E - Z, for every Z' within D of Z, and every lambda within rho of c. *)
Section Discs.
Variables (C : numFieldType) (c lambda rho : C).
Hypothesis inside : `|lambda - c| <= rho.

Lemma three (a b d e : C) : `|a - (b - (d - e))| <= `|a - b| + `|d| + `|e|.
Proof.
have -> : a - (b - (d - e)) = (a - b) + (d - e) by rewrite opprB addrCA addrC.
apply: le_trans (ler_norm_add _ _) _; rewrite -[X in _ <= X]addrA ler_add2l; exact: ler_norm_sub.
Qed.

Lemma moved_pencil m n (E Z Z' : 'M[C]_(m, n)) :
  lambda *: E - Z' = (c *: E - Z) - ((Z' - Z) - (lambda - c) *: E).
Proof.
have -> : lambda *: E = c *: E + (lambda - c) *: E by rewrite -scalerDl addrCA subrr addr0.
rewrite !opprB [RHS]addrCA [c *: E - Z + _]addrA subrK [RHS]addrA.
by rewrite [(lambda - c) *: E + _]addrC.
Qed.

(* What the disc and the radii add to a row. *)
Lemma row_bound n (M P N B : 'M[C]_n) (w : 'I_n -> C) i : (forall i, 0 < w i) ->
  (forall j, `|N i j| <= B i j) ->
  \sum_j `|(i == j)%:R - M i j| * w j + \sum_j B i j * w j + rho * (\sum_j `|P i j| * w j) < w i ->
  \sum_j `|(i == j)%:R - (M - (N - (lambda - c) *: P)) i j| * w j < w i.
Proof.
move=> w0 hN; apply: le_lt_trans; rewrite mulr_sumr -!big_split ler_sum// => j _ /=.
rewrite mulrA -!mulrDl ler_wpmul2r ?(ltW (w0 j))// !mxE (le_trans (three _ _ _ _))//.
by rewrite ler_add ?ler_add// normrM ler_wpmul2r.
Qed.

Section Left.
Variables (n : nat) (V Z Z' E D : 'M[C]_n) (w : 'I_n -> C).
Hypotheses (w0 : forall i, 0 < w i) (within : forall i j, `|(Z' - Z) i j| <= D i j).

(* Rule "regular disc": V is about the inverse of cE - Z. *)
Theorem regular_disc_left :
  (forall i, \sum_j `|(i == j)%:R - (V *m (c *: E - Z)) i j| * w j +
    \sum_j (\matrix_(i, j) \sum_k `|V i k| * D k j) i j * w j +
    rho * (\sum_j `|(V *m E) i j| * w j) < w i) -> lambda *: E - Z' \in unitmx.
Proof.
move=> small; have : V *m (lambda *: E - Z') \in unitmx; last by rewrite unitmx_mul => /andP[].
rewrite (moved_pencil E Z) mulmxBr [V *m (Z' - Z - _)]mulmxBr -scalemxAr.
apply: near_identity w0 _ => i; apply: row_bound w0 _ (small i) => j.
rewrite !mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
by rewrite normrM ler_wpmul2l.
Qed.
End Left.

Section Right.
Variables (n m : nat) (R : 'M[C]_(m, n)) (Z Z' E D : 'M[C]_(n, m)) (w : 'I_n -> C).
Hypotheses (w0 : forall i, 0 < w i) (within : forall i j, `|(Z' - Z) i j| <= D i j).

(* The same on the other side: R is about a right inverse of cE - Z. *)
Theorem regular_disc_right :
  (forall i, \sum_j `|(i == j)%:R - ((c *: E - Z) *m R) i j| * w j +
    \sum_j (\matrix_(i, j) \sum_k D i k * `|R k j|) i j * w j +
    rho * (\sum_j `|(E *m R) i j| * w j) < w i) -> \rank (lambda *: E - Z') = n.
Proof.
move=> small; have u : (lambda *: E - Z') *m R \in unitmx.
  rewrite (moved_pencil E Z) mulmxBl [(Z' - Z - _) *m R]mulmxBl -scalemxAl.
  apply: near_identity w0 _ => i; apply: row_bound w0 _ (small i) => j.
  rewrite !mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
  by rewrite normrM ler_wpmul2r.
apply/eqP; rewrite eqn_leq rank_leq_row -[X in (X <= _)%N](mxrank_unit u).
exact: mxrankM_maxl.
Qed.
End Right.

(* Rule "exterior discs": every eigenvalue of every A' within D of A is in one of the discs. *)
Theorem exterior n (Y T A A' D : 'M[C]_n) (a rad : 'I_n -> C) :
  (forall i j, `|(A' - A) i j| <= D i j) ->
  let G := Y *m T in let H := Y *m A *m T in
  let e i := \sum_j \sum_l (\sum_k `|Y i k| * D k l) * `|T l j| in
  (forall i, 0 < `|G i i| - \sum_(j | j != i) `|G i j|) ->
  (forall i, \sum_j `|a i * G i j - H i j| + e i < rad i * (`|G i i| - \sum_(j | j != i) `|G i j|)) ->
  lambda%:M - A' \notin unitmx -> exists i, ~~ (rad i < `|lambda - a i|).
Proof.
move=> within G H e slack disc sing; apply/existsP; apply: contraT; rewrite negb_exists => /forallP out.
case/negP: sing; have : Y *m (lambda%:M - A') *m T \in unitmx; last first.
  by rewrite !unitmx_mul -andbA => /and3P[].
apply: dominant => i; have {}out : rad i < `|lambda - a i| by have := out i; rewrite negbK.
set M := _ *m T; pose N := Y *m (A' - A) *m T.
have eM j : M i j = (lambda - a i) * G i j + (a i * G i j - H i j) - N i j.
  have -> : M = lambda *: G - H - N.
    rewrite /M /G /H /N scalemxAl -mul_mx_scalar -!mulmxBl -!mulmxBr; congr (_ *m _ *m _).
    by rewrite opprB addrA subrK.
  by rewrite !mxE mulrBl addrA subrK.
have hN j : `|N i j| <= \sum_l (\sum_k `|Y i k| * D k l) * `|T l j|.
  rewrite mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => l _; rewrite normrM ler_wpmul2r//.
  rewrite mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
  by rewrite normrM ler_wpmul2l.
pose r j := `|a i * G i j - H i j| + \sum_l (\sum_k `|Y i k| * D k l) * `|T l j|.
have far : \sum_j r j < `|lambda - a i| * (`|G i i| - \sum_(j | j != i) `|G i j|).
  by rewrite big_split (lt_trans (disc i))// ltr_pmul2r.
have off j : `|M i j| <= `|lambda - a i| * `|G i j| + r j.
  rewrite eM (le_trans (ler_norm_sub _ _))// [X in _ <= X]addrA ler_add// (le_trans (ler_norm_add _ _))//.
  by rewrite normrM.
have on : `|lambda - a i| * `|G i i| - r i <= `|M i i|.
  rewrite ler_subl_addr -normrM.
  have -> : (lambda - a i) * G i i = M i i - (a i * G i i - H i i - N i i).
    by rewrite eM; move: ((lambda - a i) * _) (a i * _ - _) (N i i) => x u v; rewrite -(addrA x) addrK.
  rewrite (le_trans (ler_norm_sub _ _))// ler_add2l (le_trans (ler_norm_sub _ _))//.
  by rewrite ler_add2l.
apply: lt_le_trans on; apply: le_lt_trans (ler_sum _ (fun j _ => off j)) _.
rewrite big_split /= -mulr_sumr ltr_subr_addr -addrA.
by move: far; rewrite (bigD1 i)//= mulrBr ltr_subr_addl [r i + _]addrC.
Qed.
End Discs.

(* Members that differ along given matrices as well, each times a factor of at most 1: entries that depend on the same
   parameters. *)
Section Tied.
Variables (C : numFieldType) (c lambda rho : C) (K : nat) (p : 'I_K -> C).
Hypotheses (inside : `|lambda - c| <= rho) (p1 : forall k, `|p k| <= 1).

Lemma tied_sum (a : C) (b : 'I_K -> C) : `|a + \sum_k p k * b k| <= `|a| + \sum_k `|b k|.
Proof.
apply: le_trans (ler_norm_add _ _) _; rewrite ler_add2l (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
by rewrite normrM ler_pimull.
Qed.

Lemma moved_along m n (E Z : 'M[C]_(m, n)) (S : 'I_K -> 'M[C]_(m, n)) :
  c *: E - (Z + \sum_k p k *: S k) = (c *: E - Z) - \sum_k p k *: S k.
Proof. by rewrite opprD addrA. Qed.

(* Rule "regular disc", where entries depend on the same parameters. *)
Theorem regular_disc_left_tied n (V Z Z' E D : 'M[C]_n) (S : 'I_K -> 'M[C]_n) (w : 'I_n -> C) :
  (forall i, 0 < w i) -> (forall i j, `|(Z' - (Z + \sum_k p k *: S k)) i j| <= D i j) ->
  (forall i, \sum_j `|(i == j)%:R - (V *m (c *: E - Z)) i j| * w j +
    \sum_j (\matrix_(i, j) (\sum_k `|V i k| * D k j + \sum_k `|(V *m S k) i j|)) i j * w j +
    rho * (\sum_j `|(V *m E) i j| * w j) < w i) -> lambda *: E - Z' \in unitmx.
Proof.
move=> w0 within small; apply: (regular_disc_left (V := V) inside w0 within) => i.
apply: le_lt_trans (small i); rewrite ler_add2r -!big_split ler_sum// => j _ /=.
have -> : (V *m (c *: E - (Z + \sum_k p k *: S k))) i j =
    (V *m (c *: E - Z)) i j - \sum_k p k * (V *m S k) i j.
  rewrite moved_along mulmxBr mulmx_sumr; move: (V *m (c *: E - Z)) => A; rewrite mxE [X in _ + X]mxE summxE.
  by congr (_ - _); apply: eq_bigr => k _; rewrite -scalemxAr mxE.
move: (V *m (c *: E - Z)) => A; rewrite -!mulrDl ler_wpmul2r ?(ltW (w0 j))// opprB.
rewrite addrCA addrC ![(\matrix_(_, _) _) i j]mxE [X in _ <= X]addrCA ler_add2l [X in `|X|]addrC.
exact: tied_sum.
Qed.

Theorem regular_disc_right_tied n m (R : 'M[C]_(m, n)) (Z Z' E D : 'M[C]_(n, m)) (S : 'I_K -> 'M[C]_(n, m))
  (w : 'I_n -> C) :
  (forall i, 0 < w i) -> (forall i j, `|(Z' - (Z + \sum_k p k *: S k)) i j| <= D i j) ->
  (forall i, \sum_j `|(i == j)%:R - ((c *: E - Z) *m R) i j| * w j +
    \sum_j (\matrix_(i, j) (\sum_k D i k * `|R k j| + \sum_k `|(S k *m R) i j|)) i j * w j +
    rho * (\sum_j `|(E *m R) i j| * w j) < w i) -> \rank (lambda *: E - Z') = n.
Proof.
move=> w0 within small; apply: (regular_disc_right (R := R) inside w0 within) => i.
apply: le_lt_trans (small i); rewrite ler_add2r -!big_split ler_sum// => j _ /=.
have -> : ((c *: E - (Z + \sum_k p k *: S k)) *m R) i j =
    ((c *: E - Z) *m R) i j - \sum_k p k * (S k *m R) i j.
  rewrite moved_along mulmxBl mulmx_suml; move: ((c *: E - Z) *m R) => A; rewrite mxE [X in _ + X]mxE summxE.
  by congr (_ - _); apply: eq_bigr => k _; rewrite -scalemxAl mxE.
move: ((c *: E - Z) *m R) => A; rewrite -!mulrDl ler_wpmul2r ?(ltW (w0 j))// opprB.
rewrite addrCA addrC ![(\matrix_(_, _) _) i j]mxE [X in _ <= X]addrCA ler_add2l [X in `|X|]addrC.
exact: tied_sum.
Qed.

Theorem exterior_tied n (Y T A A' D : 'M[C]_n) (S : 'I_K -> 'M[C]_n) (a rad : 'I_n -> C) :
  (forall i j, `|(A' - (A + \sum_k p k *: S k)) i j| <= D i j) ->
  let G := Y *m T in let H := Y *m A *m T in
  let e i := \sum_j (\sum_l (\sum_k `|Y i k| * D k l) * `|T l j| + \sum_k `|(Y *m S k *m T) i j|) in
  (forall i, 0 < `|G i i| - \sum_(j | j != i) `|G i j|) ->
  (forall i, \sum_j `|a i * G i j - H i j| + e i < rad i * (`|G i i| - \sum_(j | j != i) `|G i j|)) ->
  lambda%:M - A' \notin unitmx -> exists i, ~~ (rad i < `|lambda - a i|).
Proof.
move=> within G H e slack disc; apply: (exterior within (Y := Y) (T := T)) => // i.
apply: le_lt_trans (disc i); rewrite /e big_split addrA addrAC ler_add2r -big_split ler_sum// => j _ /=.
have -> : (Y *m (A + \sum_k p k *: S k) *m T) i j = H i j + \sum_k p k * (Y *m S k *m T) i j.
  rewrite mulmxDr mulmxDl mulmx_sumr mulmx_suml -/H mxE summxE.
  by congr (_ + _); apply: eq_bigr => k _; rewrite -scalemxAr -scalemxAl mxE.
rewrite -/G opprD addrA -sumrN; under eq_bigr do rewrite -mulNr.
apply: le_trans (ler_norm_add _ _) _; rewrite ler_add2l (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
by rewrite normrM normrN ler_pimull.
Qed.
End Tied.

(* Rule "cover": a square of half side h is in the disc of radius rho around its center. *)
Theorem square_in_disc (C : numClosedFieldType) (z h rho : C) : 0 <= rho -> h ^+ 2 *+ 2 <= rho ^+ 2 ->
  `|'Re z| <= h -> `|'Im z| <= h -> `|z| <= rho.
Proof.
move=> rho0 hh re im; have h0 : 0 <= h by rewrite (le_trans _ re).
rewrite -(@ler_pexpn2r _ 2) ?nnegrE// normC2_Re_Im (le_trans _ hh)// mulr2n.
by rewrite ler_add// -real_normK ?Creal_Re ?Creal_Im// ler_expn2r ?nnegrE.
Qed.

(* Rule "growth": beyond R there is no eigenvalue.  The signals outside of dyn are computed from earlier ones. *)
Theorem growth (C : numFieldType) n (Z T : 'M[C]_n) (g : 'I_n -> C) (dyn : pred 'I_n) (lambda R : C) (v : 'cV[C]_n) :
  (forall i j, `|Z i j| <= T i j) -> (forall i, 0 <= g i) -> (forall i, dyn i -> 0 < g i) ->
  (forall i, ~~ dyn i -> \sum_(j < n | (j < i)%N) T i j * g j <= g i) ->
  (forall i, dyn i -> \sum_j T i j * g j < R * g i) ->
  (forall i, dyn i -> (Z *m v) i 0 = lambda * v i 0) ->
  (forall i, ~~ dyn i -> v i 0 = \sum_(j < n | (j < i)%N) Z i j * v j 0) ->
  v != 0 -> ~~ (R <= `|lambda|).
Proof.
move=> ZT g0 gd static small eig computed nv; apply/negP => Rl; case/negP: nv.
have T0 i j : 0 <= T i j by rewrite (le_trans _ (ZT i j)).
have [i0 d0|none] := pickP dyn; last first.
  apply/eqP/colP => i; rewrite mxE; have [k] := ubnP (val i); elim: k i => // k IH i; rewrite ltnS => ik.
  rewrite computed ?none// big1// => j ji; rewrite IH ?mulr0//; exact: leq_trans ji ik.
have [i di top] := largest v d0 gd; pose mu := `|v i 0| / g i; rewrite -/mu in top.
have mu0 : 0 <= mu by rewrite divr_ge0.
have all_top j : `|v j 0| <= mu * g j.
  have [k] := ubnP (val j); elim: k j => // k IH j; rewrite ltnS => jk.
  have [/top//|sj] := boolP (dyn j); rewrite computed// (le_trans (ler_norm_sum _ _ _))//.
  apply: (@le_trans _ _ (mu * \sum_(l < n | (l < j)%N) T j l * g l)); last by rewrite ler_wpmul2l ?static.
  rewrite mulr_sumr ler_sum// => l lj; rewrite normrM mulrCA ler_pmul// IH//; exact: leq_trans lj jk.
have vi : `|v i 0| = mu * g i by rewrite divfK// gt_eqF ?gd.
have [z|nz] := eqVneq mu 0.
  by apply/eqP/colP => j; rewrite mxE; apply/normr0_eq0/le_anti; rewrite normr_ge0 andbT -(mul0r (g j)) -z all_top.
have : `|lambda| * `|v i 0| < R * `|v i 0|.
  rewrite -normrM -eig// mxE (le_lt_trans (ler_norm_sum _ _ _))//.
  apply: (@le_lt_trans _ _ (mu * \sum_j T i j * g j)).
    by rewrite mulr_sumr ler_sum// => j _; rewrite normrM mulrCA ler_pmul.
  by rewrite vi mulrCA ltr_pmul2l ?small// lt0r nz.
have vp : 0 < `|v i 0| by rewrite vi mulr_gt0 ?gd// lt0r nz.
rewrite ltr_pmul2r// => lt.
by have := lt_le_trans lt Rl; rewrite ltxx.
Qed.


(* Where the pencil [lambda I - A, -B; XC, W] is regular, lambda is not fixed. *)
Section NotFixed.
Variables (C : numFieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel C n p q) (lambda : C).
Variables (X : forall i, 'M[C]_(p i, q i)) (W : forall i, 'M[C]_(p i)).
Notation constant M := (map_mx polyC M).

Lemma det_at k (M N : 'M[C]_k) x : (\det (constant M + 'X *: constant N)).[x] = \det (M + x *: N).
Proof.
rewrite -/(horner_eval x _) -det_map_mx; congr (\det _); apply/matrixP=> i j.
by rewrite !mxE /= /horner_eval !hornerE.
Qed.

Lemma shifted_nonzero k (M : 'M[C]_k) : \det (constant M + 'X *: constant 1%:M) != 0.
Proof.
have -> : constant M + 'X *: constant 1%:M = char_poly_mx (- M).
  by rewrite /char_poly_mx map_mxN opprK addrC map_mx1 scalemx1.
by rewrite -/(char_poly _) monic_neq0 ?char_poly_monic.
Qed.

Definition pencil_of (t : C) : 'M[C]_(n + \sum_i p i) :=
  block_mx (lambda%:M - mcA S) (- \mxrow_i mcB S i) (\mxcol_i (X i *m mcC S i)) (\mxdiag_i (W i + t%:M)).

Theorem regular_not_fixed : pencil_of 0 \in unitmx -> ~ fixed S lambda.
Proof.
move=> reg fix_.
pose N : 'M[C]_(n + \sum_i p i) := block_mx 0 0 0 1%:M.
have eZ t : pencil_of t = pencil_of 0 + t *: N.
  rewrite /pencil_of /N scale_block_mx !scaler0 add_block_mx !addr0 scalemx1.
  by rewrite -mxdiagZ -mxdiagD; congr (block_mx _ _ _ _); apply/eq_mxdiag => i; rewrite raddf0 addr0.
pose P := \det (constant (pencil_of 0) + 'X *: constant N).
pose Q := \prod_i \det (constant (W i) + 'X *: constant 1%:M).
have P0 : P != 0.
  apply/eqP => z; have := det_at (pencil_of 0) N 0; rewrite -/P z horner0 scale0r addr0 => /esym/eqP.
  by apply/negP; rewrite -unitfE -unitmxE.
have Q0 : Q != 0 by apply/prodf_neq0 => i _; apply: shifted_nonzero.
have inf : infinite C by apply/char0_infinite/char_num.
have [|t] := infinite_nonroot [rmorphism of idfun] inf (_ : P * Q != 0); first by rewrite mulf_neq0.
rewrite hornerM mulf_eq0 negb_or /= => /andP[Pt Qt].
have uZ : pencil_of t \in unitmx by rewrite unitmxE unitfE eZ -det_at.
have uW i : W i + t%:M \in unitmx.
  move: Qt; rewrite horner_prod => /prodf_neq0/(_ i isT).
  by rewrite det_at scalemx1 unitmxE unitfE.
pose F i := - (invmx (W i + t%:M) *m X i).
pose Y := \mxcol_i (invmx (W i + t%:M) *m X i *m mcC S i).
have cut : pencil_of t *m block_mx 1%:M 0 (- Y) 1%:M =
    block_mx (lambda%:M - closed_loop S F) (- \mxrow_i mcB S i) 0 (\mxdiag_i (W i + t%:M)).
  rewrite /pencil_of mulmx_block !mulmx1 !mulmx0 !add0r; congr (block_mx _ _ _ _); last first.
    rewrite mulmxN mul_mxdiag_mxcol -[RHS](subrr (\mxcol_i (X i *m mcC S i))); congr (_ - _).
    by apply: eq_mxcol => i; rewrite -!mulmxA mulKVmx ?uW.
  rewrite mulmxN mulNmx opprK mul_mxrow_mxcol /closed_loop opprD addrA; congr (_ + _).
  by rewrite -sumrN; apply: eq_bigr => i _; rewrite /F mulmxN mulNmx opprK !mulmxA.
have uL : block_mx 1%:M 0 (- Y) 1%:M \in unitmx by rewrite unitmxE det_lblock !det1 mulr1 unitr1.
have : block_mx (lambda%:M - closed_loop S F) (- \mxrow_i mcB S i) 0 (\mxdiag_i (W i + t%:M)) \in unitmx.
  by rewrite -cut unitmx_mul uZ uL.
rewrite unitmxE det_ublock unitrM -!unitmxE => /andP[u _].
have := fix_ F; rewrite /eigenvalue /eigenspace kermx_eq0 row_free_unit -opprB.
by rewrite unitmxE -scaleN1r detZ unitrM unitrX ?unitrN1//= -unitmxE u.
Qed.
End NotFixed.

(* Rule "discs of gains": what is fixed is in an exterior disc of A_F, for any gains F; the same of what channels do
   not control, with gains from the state. *)
Section Gains.
Variable C : numFieldType.

Lemma product_within n p q l (B B' DB : 'M[C]_(n, p)) (F : 'M[C]_(p, q)) (M M' DM : 'M[C]_(q, l)) :
  (forall i j, `|(B' - B) i j| <= DB i j) -> (forall i j, `|(M' - M) i j| <= DM i j) -> forall i j,
  `|(B' *m F *m M' - B *m F *m M) i j| <=
    \sum_k (`|B i k| + DB i k) * (\sum_h `|F k h| * DM h j) + \sum_k DB i k * (\sum_h `|F k h| * `|M h j|).
Proof.
move=> hB hM i j.
have -> : B' *m F *m M' - B *m F *m M = B' *m (F *m (M' - M)) + (B' - B) *m (F *m M).
  by rewrite !mulmxBr mulmxBl !mulmxA addrA subrK.
have hB' k : `|B' i k| <= `|B i k| + DB i k.
  have -> : B' i k = B i k + (B' - B) i k by rewrite !mxE addrCA subrr addr0.
  by rewrite (le_trans (ler_norm_add _ _))// ler_add2l.
have hF r (N E : 'M[C]_(q, r)) k h : (forall i j, `|N i j| <= E i j) ->
    `|(F *m N) k h| <= \sum_l `|F k l| * E l h.
  move=> small; rewrite mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => a _.
  by rewrite normrM ler_wpmul2l.
rewrite mxE (le_trans (ler_norm_add _ _))// ler_add//.
  rewrite mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
  by rewrite normrM ler_pmul// hF.
rewrite mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
rewrite normrM ler_pmul//; have := @hF _ M (\matrix_(a, b) `|M a b|) k j.
by under eq_bigr do rewrite mxE; apply=> a b; rewrite mxE.
Qed.

Variables (n m : nat) (p q : 'I_m -> nat) (S S' : multichannel C n p q) (F : forall i, 'M[C]_(p i, q i)).
Variables (DA : 'M[C]_n) (DB : forall i, 'M[C]_(n, p i)) (DC : forall i, 'M[C]_(q i, n)).
Hypotheses (wA : forall i j, `|(mcA S' - mcA S) i j| <= DA i j)
  (wB : forall c i j, `|(mcB S' c - mcB S c) i j| <= DB c i j)
  (wC : forall c i j, `|(mcC S' c - mcC S c) i j| <= DC c i j).

Definition gains_radii : 'M[C]_n := \matrix_(i, j) (DA i j +
  \sum_c (\sum_k (`|mcB S c i k| + DB c i k) * (\sum_h `|F c k h| * DC c h j) +
          \sum_k DB c i k * (\sum_h `|F c k h| * `|mcC S c h j|))).

Theorem gains_within i j : `|(closed_loop S' F - closed_loop S F) i j| <= gains_radii i j.
Proof.
rewrite /closed_loop opprD addrACA -sumrB mxE [gains_radii i j]mxE (le_trans (ler_norm_add _ _))// ler_add//.
rewrite summxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => c _.
by apply: product_within; [apply: wB | apply: wC].
Qed.

Section Disc.
Variables (Y T : 'M[C]_n) (a rad : 'I_n -> C) (lambda : C).
Let A := closed_loop S F.
Let G := Y *m T.
Let H := Y *m A *m T.
Let e i := \sum_j \sum_l (\sum_k `|Y i k| * gains_radii k l) * `|T l j|.
Hypotheses (dominant_rows : forall i, 0 < `|G i i| - \sum_(j | j != i) `|G i j|)
  (large : forall i, \sum_j `|a i * G i j - H i j| + e i < rad i * (`|G i i| - \sum_(j | j != i) `|G i j|)).

Theorem fixed_in_exterior : fixed S' lambda -> exists i, ~~ (rad i < `|lambda - a i|).
Proof.
move=> /(_ F) eig; apply: exterior dominant_rows large _; first exact: gains_within.
move: eig; rewrite /eigenvalue /eigenspace kermx_eq0 row_free_unit -opprB.
by rewrite unitmxE -scaleN1r detZ unitrM unitrX ?unitrN1//= -unitmxE.
Qed.
End Disc.
End Gains.

(* What inputs do not control no gains from the state move: it is fixed for one channel that measures the state. *)
Definition measured (C : numFieldType) n p (A : 'M[C]_n) (B : 'M[C]_(n, p)) :
  multichannel C n (fun _ : 'I_1 => p) (fun _ : 'I_1 => n) := Multichannel A (fun=> B) (fun=> 1%:M).

Theorem uncontrolled_fixed (C : numFieldType) n p (A : 'M[C]_n) (B : 'M[C]_(n, p)) lambda :
  (\rank (row_mx (lambda%:M - A) (- B)) < n)%N -> fixed (measured A B) lambda.
Proof.
move=> low F; have [u nu] : exists2 u : 'rV_n, u != 0 & u *m row_mx (lambda%:M - A) (- B) = 0.
  have /rowV0Pn[u] : kermx (row_mx (lambda%:M - A) (- B)) != 0.
    by rewrite -mxrank_eq0 mxrank_ker -lt0n subn_gt0.
  by move=> /sub_kermxP k nu; exists u.
rewrite mul_mx_row -[0]row_mx0 => /eq_row_mx[uA uB].
apply/eigenvalueP; exists u => //; rewrite /closed_loop big_ord1 mulmxDr !mulmxA /=.
have -> : u *m B = 0 by apply/eqP; rewrite -oppr_eq0 -mulmxN uB.
by rewrite !mul0mx addr0 -mul_mx_scalar; apply/esym/eqP; rewrite -subr_eq0 -mulmxBr uA.
Qed.
