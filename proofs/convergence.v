(* From eigenvalues to trajectories, in continuous time.  Where all eigenvalues of a real matrix M have real parts below
   a, some quadratic form V(x) = x'Px >= |x|^2 satisfies x'PMx <= a V(x), so that V' <= 2aV along x' = Mx: every
   trajectory goes to 0 as fast as exp(at).

   Over the complex numbers V is the sum of w^k |y_k|^2, where y_0 = x, y_(k+1) = (M - z_k) y_k, and z_0, ..., z_(n-1)
   are the eigenvalues, so that y_n = 0.  In place of exp(-at) stands any function g with g' = -ag, and what is used
   of the real numbers is that bounded sets have suprema. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Chain.
Variable C : numClosedFieldType.
Implicit Types (a d z : C).

Definition inner n (u v : 'cV[C]_n) : C := \sum_i (u i 0)^* * v i 0.
Definition norm2 n (u : 'cV[C]_n) : C := \sum_i `|u i 0| ^+ 2.

Lemma innerD n (u v w : 'cV[C]_n) : inner u (v + w) = inner u v + inner u w.
Proof. by rewrite -big_split; apply: eq_bigr => i _; rewrite mxE mulrDr. Qed.
Lemma innerZ n z (u : 'cV[C]_n) : inner u (z *: u) = z * norm2 u.
Proof. by rewrite mulr_sumr; apply: eq_bigr => i _; rewrite mxE normCKC mulrCA. Qed.
Lemma norm2_ge0 n (u : 'cV[C]_n) : 0 <= norm2 u.
Proof. by apply: sumr_ge0 => i _; rewrite exprn_ge0. Qed.
Lemma norm2_0 n : norm2 (0 : 'cV[C]_n) = 0.
Proof. by apply: big1 => i _; rewrite mxE normr0 expr0n. Qed.

Lemma young (a b d : C) : 0 < d -> `|a| * `|b| <= d * `|a| ^+ 2 + d^-1 * `|b| ^+ 2.
Proof.
move=> d0; have dn : d != 0 by rewrite gt_eqF.
have s0 : 0 <= d * `|a| by rewrite mulr_ge0 // ltW.
suff : d * `|a| * `|b| <= (d * `|a|) ^+ 2 + `|b| ^+ 2.
  rewrite -subr_ge0 => h; rewrite -subr_ge0 -(pmulr_rge0 _ d0).
  by move: h; rewrite mulrBr mulrDr mulVKf // !mulrA exprMn expr2 -!mulrA.
have [sb|bs] := real_leP (ger0_real s0) (normr_real b).
  rewrite (le_trans (ler_wpmul2r (normr_ge0 b) sb)) // -expr2 ler_addr exprn_ge0 //.
by rewrite (le_trans (ler_wpmul2l s0 (ltW bs))) // -expr2 ler_addl exprn_ge0.
Qed.

Lemma Re_inner n (u v : 'cV[C]_n) d : 0 < d -> 'Re (inner u v) <= d * norm2 u + d^-1 * norm2 v.
Proof.
move=> d0; rewrite raddf_sum /= !mulr_sumr -big_split /=; apply: ler_sum => i _.
apply: le_trans (young (u i 0) (v i 0) d0).
have -> : `|u i 0| * `|v i 0| = `|(u i 0)^* * v i 0| by rewrite normrM norm_conjC.
by apply: le_trans (leif_normC_Re_Creal _).1; rewrite real_ler_norm ?Creal_Re.
Qed.

(* sum w^k Re <y_k, y_k'> <= a sum w^k |y_k|^2, for y_k' = z_k y_k + y_(k+1) and w = d^-2 *)
Lemma chain_rate n (y y' : nat -> 'cV[C]_n) (z : nat -> C) a d N (w := d^-1 ^+ 2) : 0 < d -> y N = 0 ->
  (forall k, (k < N)%N -> y' k = z k *: y k + y k.+1) -> (forall k, (k < N)%N -> 'Re (z k) + (d + d) <= a) ->
  \sum_(k < N) w ^+ k * 'Re (inner (y k) (y' k)) <= a * \sum_(k < N) w ^+ k * norm2 (y k).
Proof.
move=> d0 yN step small; have dn : d != 0 by rewrite gt_eqF.
have w0 : 0 <= w by rewrite exprn_ge0 // invr_ge0 ltW.
have wd : d^-1 = w * d by rewrite /w expr2 mulfVK.
pose s k := w ^+ k * (d * norm2 (y k)).
have s0 k : 0 <= s k.
  exact: mulr_ge0 (exprn_ge0 _ w0) (mulr_ge0 (ltW d0) (norm2_ge0 _)).
have each k : (k < N)%N -> w ^+ k * 'Re (inner (y k) (y' k)) <=
    w ^+ k * ('Re (z k) * norm2 (y k)) + s k + s k.+1.
  move=> kN; rewrite step // innerD innerZ raddfD /= ReMr ?ger0_real ?norm2_ge0 //.
  rewrite mulrDr -addrA ler_add2l /s exprSr -mulrA [w * (d * _)]mulrA -wd -mulrDr.
  by apply: ler_wpmul2l (Re_inner _ _ d0); rewrite exprn_ge0.
apply: le_trans (ler_sum _ (fun (k : 'I_N) _ => each k (ltn_ord k))) _.
rewrite !big_split /=.
have shift : \sum_(k < N) s k.+1 <= \sum_(k < N) s k.
  case: (N) yN => [|M] yM; first by rewrite !big_ord0 lexx.
  rewrite big_ord_recr [X in _ <= X]big_ord_recl /= {2}/s yM norm2_0 !mulr0 addr0.
  by rewrite ler_addr.
apply: le_trans (ler_add (lexx _) shift) _.
rewrite -!big_split mulr_sumr /=; apply: ler_sum => k _.
rewrite /s -!mulrDr [a * _]mulrCA; apply: ler_wpmul2l; first by rewrite exprn_ge0.
rewrite -addrA -!mulrDl; apply: ler_wpmul2r; first exact: norm2_ge0.
exact: small.
Qed.
End Chain.

(* finitely many real parts below a stay below it by a margin *)
Lemma margin (C : numClosedFieldType) (a : C) (s : seq C) : a \is Num.real -> (forall z, z \in s -> 'Re z < a) ->
  exists2 d, 0 < d & forall z, z \in s -> 'Re z + (d + d) <= a.
Proof.
move=> ra; elim: s => [_|z s IH h]; first by exists 1; rewrite ?ltr01.
have [x xs|d d0 hd] := IH; first by apply: h; rewrite inE xs orbT.
have rz : 'Re z + (d + d) \is Num.real by rewrite rpredD ?Creal_Re // rpredD ?gtr0_real.
have [le|lt] := real_leP rz ra.
  by exists d => // x; rewrite inE => /orP[/eqP->|/hd].
have two : 0 < 2%:R :> C by rewrite ltr0n.
exists ((a - 'Re z) / 2%:R); first by rewrite divr_gt0 // subr_gt0 h ?mem_head.
have half : (a - 'Re z) / 2%:R + (a - 'Re z) / 2%:R = a - 'Re z.
  by rewrite -mulrDr -mulr2n -[_ *+ 2]mulr_natr mulVf ?mulr1 // gt_eqF.
move=> x; rewrite half inE => /orP[/eqP->|/hd]; first by rewrite addrC subrK lexx.
by apply: le_trans; rewrite ler_add2l ler_subl_addl ltW.
Qed.

Section Lyapunov.
Variable R : rcfType.
Notation C := [numClosedFieldType of complex R].
Notation f := [rmorphism of real_complex R].

Definition dot n (u v : 'cV[R]_n) : R := (u^T *m v) 0 0.
Notation re M := (map_mx (@complex.Re R) M).
Notation im M := (map_mx (@complex.Im R) M).

Lemma dotE n (u v : 'cV[R]_n) : dot u v = \sum_i u i 0 * v i 0.
Proof. by rewrite /dot mxE; apply: eq_bigr => i _; rewrite mxE. Qed.

Lemma inner_dot n (u v : 'cV[C]_n) : 'Re (inner u v) = f (dot (re u) (re v) + dot (im u) (im v)).
Proof.
rewrite /inner (raddf_sum (Re_additive _)) !dotE -big_split rmorph_sum; apply: eq_bigr => i _ /=.
rewrite ReM Re_conj Im_conj mulNr opprK !mxE rmorphD !rmorphM /=.
by rewrite -!complexRe -!complexIm.
Qed.

Lemma norm2_dot n (u : 'cV[C]_n) : norm2 u = f (dot (re u) (re u) + dot (im u) (im u)).
Proof.
rewrite -inner_dot; have -> : inner u u = norm2 u by apply: eq_bigr => i _; rewrite normCKC.
by rewrite (Creal_ReP _ _) // ger0_real ?norm2_ge0.
Qed.

Lemma re_mul a b (M : 'M[C]_(a, b)) (x : 'cV[R]_b) :
  re (M *m map_mx f x) = re M *m x /\ im (M *m map_mx f x) = im M *m x.
Proof.
have part (M' : 'M[C]_(a, b)) i j : (M' i j * map_mx f x j 0) =
    Complex (complex.Re (M' i j) * x j 0) (complex.Im (M' i j) * x j 0) :> complex R.
  by rewrite mxE; case: (M' i j) => u v /=; apply/eqP; rewrite eq_complex /= !mulr0 subr0 add0r !eqxx.
split; apply/matrixP => i j; rewrite (ord1 j) !mxE raddf_sum; apply: eq_bigr => k _;
  by rewrite part /= mxE.
Qed.

(* the form of a matrix P *)
Definition form n (P : 'M[R]_n) (x y : 'cV[R]_n) : R := dot x (P *m y).

(* Lyapunov: a form that decays *)
Theorem decaying_form n (M : 'M[R]_n) (a : R) :
  (forall lambda : C, eigenvalue (map_mx f M) lambda -> 'Re lambda < f a) ->
  exists P : 'M[R]_n, [/\ P^T = P, forall x, dot x x <= form P x x &
    forall x, form P x (M *m x) <= a * form P x x].
Proof.
case: n M => [|n] M low.
  exists 0; split=> [|x|x]; first exact: trmx0.
    by rewrite /form dotE big_ord0 dotE big_ord0.
  by rewrite /form !dotE !big_ord0 mulr0.
pose Mc := map_mx f M; have [rs ers] := closed_field_poly_normal (char_poly Mc).
rewrite (monicP (char_poly_monic _)) scale1r in ers.
have srs : size rs = n.+1.
  by have := size_char_poly Mc; rewrite ers size_prod_XsubC => -[].
have [|z zrs|d d0 hd] := @margin C (f a) rs; first by apply/complex_realP; exists a.
  by apply: low; rewrite eigenvalue_root_char ers root_prod_XsubC.
have [d' ed] : exists d', d = f d' by apply/complex_realP/gtr0_real.
have d'0 : 0 < d' by have := d0; rewrite ed ltcE /= => /andP[].
pose p k : {poly C} := \prod_(z <- take k rs) ('X - z%:P); pose Y k := horner_mx Mc (p k).
pose z k := rs`_k; pose w := d'^-1 ^+ 2.
have pS k : (k < n.+1)%N -> 'X * p k = (z k)%:P * p k + p k.+1.
  move=> kn; rewrite /p (take_nth 0) ?srs // -cats1 big_cat big_seq1 /= -/(z k).
  by rewrite mulrBr addrC [_ * (z k)%:P]mulrC subrK mulrC.
pose P : 'M[R]_n.+1 := \sum_(k < n.+1) w ^+ k *: ((re (Y k))^T *m re (Y k) + (im (Y k))^T *m im (Y k)).
have formP x y : f (form P x y) =
    \sum_(k < n.+1) (d^-1 ^+ 2) ^+ k * 'Re (inner (Y k *m map_mx f x) (Y k *m map_mx f y)).
  rewrite /form /dot /P mulmx_suml mulmx_sumr summxE rmorph_sum; apply: eq_bigr => k _.
  rewrite inner_dot !(re_mul _ _).1 !(re_mul _ _).2 -scalemxAl -scalemxAr mxE rmorphM /=.
  congr (_ * f _); first by rewrite ed /w !rmorphX fmorphV.
  by rewrite mulmxDl mulmxDr mxE /dot !trmx_mul !mulmxA.
have commute k x : Y k *m (Mc *m x) = Mc *m (Y k *m x).
  by rewrite !mulmxA; congr (_ *m x); exact: comm_horner_mx.
exists P; split.
- rewrite /P linear_sum; apply: eq_bigr => k _.
  by rewrite linearZ /= linearD /= !trmx_mul !trmxK.
- move=> x; have : f (dot x x) <= f (form P x x); last by rewrite lecE /= eqxx.
  rewrite formP (bigD1 ord0) //= expr0 mul1r.
  have -> : Y 0%N = 1%:M by rewrite /Y /p take0 big_nil rmorph1.
  rewrite mul1mx inner_dot.
  have -> : re (map_mx f x) = x by apply/matrixP => i j; rewrite !mxE.
  have -> : im (map_mx f x) = 0 by apply/matrixP => i j; rewrite !mxE.
  have -> : dot (0 : 'cV[R]_n.+1) 0 = 0 by rewrite dotE big1 // => i _; rewrite mxE mul0r.
  rewrite addr0 ler_addl; apply: sumr_ge0 => k _; rewrite mulr_ge0 ?exprn_ge0 ?invr_ge0 ?(ltW d0) //.
  have -> u : inner u u = norm2 u :> C by apply: eq_bigr => i _; rewrite normCKC.
  by rewrite (Creal_ReP _ _) ?norm2_ge0 // ger0_real ?norm2_ge0.
move=> x; have : f (form P x (M *m x)) <= f (a * form P x x); last by rewrite lecE /= eqxx.
rewrite rmorphM /= !formP map_mxM.
pose y k := Y k *m map_mx f x; pose y' k := Y k *m (Mc *m map_mx f x).
have e k : 'Re (inner (y k) (y k)) = norm2 (y k).
  have -> : inner (y k) (y k) = norm2 (y k) by apply: eq_bigr => i _; rewrite normCKC.
  by rewrite (Creal_ReP _ _) // ger0_real ?norm2_ge0.
rewrite (eq_bigr (fun k : 'I_n.+1 => (d^-1 ^+ 2) ^+ k * norm2 (y k)) (fun k _ => congr1 _ (e k))).
apply: (@chain_rate C _ y y' z (f a) d n.+1) => //.
- have pn : p n.+1 = char_poly Mc by rewrite /p take_oversize ?srs.
  by rewrite /y /Y pn Cayley_Hamilton mul0mx.
- move=> k kn; rewrite /y' commute /y mulmxA.
  have -> : Mc *m Y k = horner_mx Mc ('X * p k) by rewrite rmorphM /= horner_mx_X.
  by rewrite pS // rmorphD rmorphM /= horner_mx_C mulmxDl -mulmxA mul_scalar_mx.
by move=> k kn; apply: hd; rewrite /z mem_nth // srs.
Qed.
End Lyapunov.

Section Trajectories.
Variable R : rcfType.
Implicit Types (u v : R -> R) (t a e h : R).

(* bounded sets have suprema *)
Definition complete_order := forall E : pred R, (exists t, E t) -> (exists b, forall t, E t -> t <= b) ->
  exists s, (forall t, E t -> t <= s) /\ forall b, (forall t, E t -> t <= b) -> s <= b.

(* s(h) goes to d as h goes to 0 *)
Definition limit (s : R -> R) d := forall e, 0 < e -> exists2 r, 0 < r & forall h, `|h| < r -> `|s h - d| <= e.

Lemma limit_constant c : limit (fun=> c) c.
Proof. by move=> e e0; exists 1 => // h _; rewrite subrr normr0 ltW. Qed.

Lemma limit_identity : limit id 0.
Proof. by move=> e e0; exists e => // h he; rewrite subr0 ltW. Qed.

Lemma limitD s s' d d' : limit s d -> limit s' d' -> limit (fun h => s h + s' h) (d + d').
Proof.
move=> ls ls' e e0; have e2 : 0 < e / 2%:R by rewrite divr_gt0 ?ltr0n.
have [r r0 hs] := ls _ e2; have [r' r'0 hs'] := ls' _ e2.
exists (Num.min r r') => [|h]; first by rewrite lt_minr r0.
rewrite lt_minr => /andP[/hs a /hs' b]; rewrite opprD addrACA.
apply: le_trans (ler_norm_add _ _) (le_trans (ler_add a b) _).
by rewrite -mulrDr -mulr2n -[_ *+ 2]mulr_natr mulVf ?mulr1 ?pnatr_eq0.
Qed.

Lemma limitM s s' d d' : limit s d -> limit s' d' -> limit (fun h => s h * s' h) (d * d').
Proof.
move=> ls ls' e e0; have e2 : 0 < e / 2%:R by rewrite divr_gt0 ?ltr0n.
have b0 : 0 < `|d| + 1 by rewrite ltr_paddl ?ltr01.
have b'0 : 0 < `|d'| + 1 by rewrite ltr_paddl ?ltr01.
have [r r0 hs] := ls _ (divr_gt0 e2 b'0); have [q q0 hq] := ls' _ ltr01.
have [r' r'0 hs'] := ls' _ (divr_gt0 e2 b0).
exists (Num.min r (Num.min q r')) => [|h]; first by rewrite !lt_minr r0 q0.
rewrite !lt_minr => /and3P[/hs a /hq b /hs' c].
have bound : `|s' h| <= `|d'| + 1.
  by rewrite -[s' h](subrK d') (le_trans (ler_norm_add _ _)) // addrC ler_add2l.
have -> : s h * s' h - d * d' = (s h - d) * s' h + d * (s' h - d').
  by rewrite mulrBl mulrBr addrA subrK.
apply: le_trans (ler_norm_add _ _) _; rewrite !normrM.
have -> : e = e / 2%:R + e / 2%:R.
  by rewrite -mulrDr -mulr2n -[_ *+ 2]mulr_natr mulVf ?mulr1 ?pnatr_eq0.
apply: ler_add.
  apply: le_trans (ler_pmul _ _ a bound) _; rewrite ?normr_ge0 //.
  by rewrite divfK // gt_eqF.
apply: le_trans (ler_pmul _ _ (_ : `|d| <= `|d| + 1) c) _; rewrite ?normr_ge0 // ?ler_addl ?ler01 //.
by rewrite mulrC divfK // gt_eqF.
Qed.

(* u'(t) = d *)
Definition derivative u t d := exists2 s, limit s d & forall h, u (t + h) = u t + s h * h.

Lemma derivative_same u v t d : u =1 v -> derivative u t d -> derivative v t d.
Proof. by move=> uv [s ls e]; exists s => // h; rewrite -!uv. Qed.

Lemma derivative_constant c t : derivative (fun=> c) t 0.
Proof. by exists (fun=> 0) => [|h]; [exact: limit_constant | rewrite mul0r addr0]. Qed.

Lemma derivativeD u v t d d' : derivative u t d -> derivative v t d' -> derivative (fun s => u s + v s) t (d + d').
Proof.
move=> [s ls e] [s' ls' e']; exists (fun h => s h + s' h); first exact: limitD.
by move=> h; rewrite e e' mulrDl addrACA.
Qed.

Lemma derivativeM u v t d d' : derivative u t d -> derivative v t d' ->
  derivative (fun s => u s * v s) t (d * v t + u t * d').
Proof.
move=> [s ls e] [s' ls' e']; exists (fun h => s h * (v t + s' h * h) + u t * s' h).
  apply: limitD; last exact: limitM (limit_constant _) ls'.
  apply: limitM => //; rewrite -[X in limit _ X]addr0 -[X in _ + X](mulr0 d').
  apply: limitD; first exact: limit_constant.
  exact: limitM limit_identity.
move=> h; rewrite e e'; set y := v t + s' h * h; rewrite [in RHS]mulrDl [LHS]mulrDl /y [in LHS]mulrDr -/y.
by rewrite -addrA [in RHS](addrC (s h * y * h)) mulrA [s h * y * h]mulrAC.
Qed.

Lemma derivative_sum (I : Type) (r : seq I) (u : I -> R -> R) (d : I -> R) t :
  (forall i, derivative (u i) t (d i)) -> derivative (fun s => \sum_(i <- r) u i s) t (\sum_(i <- r) d i).
Proof.
move=> h; elim: r => [|i r IH].
  rewrite big_nil; apply: derivative_same (derivative_constant 0 t) => s; by rewrite big_nil.
by rewrite big_cons; apply: derivative_same (derivativeD (h i) IH) => s; rewrite big_cons.
Qed.

(* where no derivative is positive, nothing grows *)
Lemma no_growth u b : complete_order -> (forall t, 0 <= t -> exists2 d, d <= 0 & derivative u t d) ->
  0 <= b -> u b <= u 0.
Proof.
move=> sup fall b0.
have slow e : 0 < e -> u b <= u 0 + e * b.
  move=> e0; pose E t := (0 <= t <= b) && (u t <= u 0 + e * t).
  have E0 : E 0 by rewrite /E lexx b0 mulr0 addr0 lexx.
  have [||s [above least]] := sup E; first by exists 0.
    by exists b => t /andP[/andP[]].
  have s0 : 0 <= s by apply: above.
  have sb : s <= b by apply: least => t /andP[/andP[]].
  have [d d0 [slope ls step]] := fall s s0; have [r r0 close] := ls _ e0.
  have slope_le h : `|h| < r -> slope h <= e.
    move/close => le; rewrite -[slope h](subrK d) -[e]addr0 ler_add //.
    exact: le_trans (ler_norm _) le.
  have Es : E s.
    apply: contraT => nE; have : s <= s - r / 2%:R; last first.
      by rewrite ler_addl oppr_ge0 leNgt divr_gt0 // ltr0n.
    apply: least => t Et; rewrite leNgt; apply: contra nE => lt.
    have ts : t <= s by apply: above.
    rewrite /E s0 sb /=; pose h := t - s; have eh : t = s + h by rewrite /h addrCA subrr addr0.
    have hr : `|h| < r.
      rewrite ler0_norm /h ?subr_le0 // opprB ltr_subl_addl -ltr_subl_addr (le_lt_trans _ lt) //.
      by rewrite ler_add2l ler_opp2 ler_pdivr_mulr ?ltr0n // ler_pmulr // ler1n.
    have /andP[_] := Et; rewrite eh step -ler_subr_addr => /le_trans; apply.
    rewrite -addrA ler_add2l mulrDr -addrA ger_addl subr_le0.
    by rewrite ler_wnmul2r ?slope_le // /h subr_le0.
  have [->|ns] := eqVneq b s; first by case/andP: Es.
  have lt : s < b by rewrite lt_neqAle eq_sym ns.
  pose h := Num.min (r / 2%:R) (b - s); have h0 : 0 < h by rewrite lt_minr divr_gt0 ?ltr0n // subr_gt0.
  have hr : `|h| < r.
    rewrite gtr0_norm // (le_lt_trans (_ : _ <= r / 2%:R)) ?le_minl ?lexx //.
    by rewrite ltr_pdivr_mulr ?ltr0n // ltr_pmulr // ltr1n.
  suff /above : E (s + h) by rewrite ger_addl leNgt h0.
  rewrite /E addr_ge0 ?(ltW h0) //= -ler_subr_addl le_minl lexx orbT /= step.
  by case/andP: Es => _ le; rewrite mulrDr addrA ler_add // ler_wpmul2r ?slope_le // ltW.
rewrite leNgt; apply/negP => lt; pose e := u b - u 0; have e0 : 0 < e by rewrite subr_gt0.
have b1 : 0 < b + 1 by rewrite ltr_paddl ?ltr01.
have := slow _ (divr_gt0 e0 b1); rewrite -ler_subl_addl -/e mulrAC ler_pdivl_mulr // ler_pmul2l //.
by rewrite leNgt ltr_addl ltr01.
Qed.

(* every trajectory goes to 0 as fast as exp(at) *)
Theorem exponential_rate n (M : 'M[R]_n) (a : R) : complete_order ->
  (forall lambda : complex R, eigenvalue (map_mx (real_complex R) M) lambda -> 'Re lambda < real_complex R a) ->
  exists c, forall (x : R -> 'cV[R]_n) (g : R -> R),
    (forall t i, 0 <= t -> derivative (fun s => x s i 0) t ((M *m x t) i 0)) ->
    (forall t, 0 <= t -> derivative g t (- a * g t)) ->
    forall t, 0 <= t -> dot (x t) (x t) * g t ^+ 2 <= c * (dot (x 0) (x 0) * g 0 ^+ 2).
Proof.
move=> sup low; have [P [sP above falls]] := decaying_form low.
have formE (y z : 'cV[R]_n) : form P y z = \sum_i \sum_j P i j * (y i 0 * z j 0).
  rewrite /form dotE; apply: eq_bigr => i _; rewrite mxE mulr_sumr; apply: eq_bigr => j _.
  by rewrite mulrCA.
have sym y z : form P y z = form P z y.
  rewrite !formE exchange_big; apply: eq_bigr => i _; apply: eq_bigr => j _.
  have -> : P j i = P i j by rewrite -{1}sP mxE.
  by rewrite [y j 0 * _]mulrC.
exists (\sum_i \sum_j `|P i j|) => x g dx dg t t0.
have bound y : form P y y <= (\sum_i \sum_j `|P i j|) * dot y y.
  have sq i : y i 0 ^+ 2 <= dot y y.
    by rewrite dotE (bigD1 i) //= -expr2 ler_addl sumr_ge0 // => j _; rewrite -expr2 sqr_ge0.
  rewrite formE mulr_suml; apply: ler_sum => i _; rewrite mulr_suml; apply: ler_sum => j _.
  apply: le_trans (ler_norm _) _; rewrite normrM; apply: ler_wpmul2l => //.
  have [le|lt] := leP `|y i 0| `|y j 0|.
    apply: le_trans (sq j); rewrite normrM -[X in _ <= X]ger0_norm ?sqr_ge0 // normrX expr2.
    exact: ler_wpmul2r.
  apply: le_trans (sq i); rewrite normrM -[X in _ <= X]ger0_norm ?sqr_ge0 // normrX expr2.
  by apply: ler_wpmul2l (ltW lt).
pose V s := form P (x s) (x s); pose u s := V s * (g s * g s).
have dV s : 0 <= s -> derivative V s (form P (M *m x s) (x s) + form P (x s) (M *m x s)).
  move=> s0; rewrite !formE -big_split /=.
  apply: (@derivative_same (fun s => \sum_i \sum_j P i j * (x s i 0 * x s j 0))).
    by move=> r; rewrite /V formE.
  apply: derivative_sum => i; rewrite -big_split /=; apply: derivative_sum => j.
  rewrite -mulrDr -[X in derivative _ _ X]add0r -(mul0r (x s i 0 * x s j 0)).
  exact: derivativeM (derivative_constant _ _) (derivativeM (dx s i s0) (dx s j s0)).
have du s : 0 <= s -> exists2 d, d <= 0 & derivative u s d.
  move=> s0; exists ((form P (M *m x s) (x s) + form P (x s) (M *m x s)) * (g s * g s) +
    V s * (- a * g s * g s + g s * (- a * g s))); last first.
    exact: derivativeM (dV s s0) (derivativeM (dg s s0) (dg s s0)).
  set F := form P (x s) (M *m x s); set G := g s * g s; rewrite sym -/F.
  have -> : - a * g s * g s + g s * (- a * g s) = - (a * G) *+ 2.
    by rewrite mulrCA mulrA mulr2n -[- a * g s * g s]mulrA !mulNr.
  have -> : (F + F) * G + V s * (- (a * G) *+ 2) = (F - a * V s) * G *+ 2.
    rewrite -mulr2n mulrnAl mulrnAr -mulrnDl; congr (_ *+ 2).
    by rewrite mulrN mulrBl [V s * _]mulrCA mulrA.
  rewrite pmulrn_lle0 //; apply: mulr_le0_ge0; first by rewrite subr_le0; exact: falls.
  by rewrite /G -expr2 sqr_ge0.
have := no_growth sup du t0; rewrite /u -!expr2 => le.
apply: le_trans (ler_wpmul2r (sqr_ge0 _) (above _)) (le_trans le _).
by rewrite mulrA ler_wpmul2r ?sqr_ge0 // bound.
Qed.

(* with a constant input: every trajectory goes to the one equilibrium *)
Theorem settles n (M : 'M[R]_n) (a : R) : complete_order -> a <= 0 ->
  (forall lambda : complex R, eigenvalue (map_mx (real_complex R) M) lambda -> 'Re lambda < real_complex R a) ->
  exists c, forall b : 'cV[R]_n, exists2 e : 'cV[R]_n, M *m e + b = 0 & forall (x : R -> 'cV[R]_n) (g : R -> R),
    (forall t i, 0 <= t -> derivative (fun s => x s i 0) t ((M *m x t + b) i 0)) ->
    (forall t, 0 <= t -> derivative g t (- a * g t)) ->
    forall t, 0 <= t -> dot (x t - e) (x t - e) * g t ^+ 2 <= c * (dot (x 0 - e) (x 0 - e) * g 0 ^+ 2).
Proof.
move=> sup a0 low; have [c h] := exponential_rate sup low; exists c => b.
have uM : M \in unitmx.
  rewrite -row_free_unit /row_free eqn_leq rank_leq_row leqNgt; apply/negP => lt.
  have ev : eigenvalue (map_mx (real_complex R) M) 0.
    rewrite -(rmorph0 [rmorphism of real_complex R]) eigenvalue_map; apply/eigenvalueP.
    have : kermx M != 0 by rewrite -mxrank_eq0 mxrank_ker subn_eq0 -ltnNge.
    by case/rowV0Pn=> w /sub_kermxP wM w0; exists w; rewrite // scale0r.
  have := low _ ev; rewrite raddf0 => a0'.
  have : (0 : R) < a by move: a0'; rewrite ltcE /= => /andP[].
  by rewrite ltNge a0.
have e0 : M *m (- (invmx M *m b)) + b = 0 by rewrite mulmxN mulKVmx // addNr.
exists (- (invmx M *m b)) => // x g dx dg t t0; set e := - _ in e0 *.
apply: (h (fun s => x s - e) g) => // s i s0.
have -> : (M *m (x s - e)) i 0 = (M *m x s + b) i 0 + 0.
  rewrite addr0; congr (fun_of_matrix _ i 0); rewrite mulmxBr; congr (_ + _).
  by apply/eqP; rewrite eq_sym -subr_eq0 opprK addrC e0.
apply: derivative_same (derivativeD (dx s i s0) (derivative_constant (- e i 0) s)) => r.
by rewrite !mxE.
Qed.
End Trajectories.
