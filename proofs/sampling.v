(* checker/sampling.py: the matrices of a plant with held inputs are within the radii of the ones that
   are built.

   The terms of the series are v 1 = h[A, B], (k + 1) v (k + 1) = hA v k, for a member; V k are those that
   are built, and F k bounds the distance.  All sums of the series are within the radii, and what they tend to, which
   is the exponential less its constant term. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Sampling.
Variable R : realFieldType.

Notation moduli A := (map_mx (fun x : R => `|x|) A).
Definition within m n (A : 'M[R]_(m, n)) (D : 'M[R]_(m, n)) := forall i j, `|A i j| <= D i j.

Lemma within_mul m n p (A P : 'M[R]_(m, n)) (B Q : 'M[R]_(n, p)) :
  within A P -> within B Q -> within (A *m B) (P *m Q).
Proof.
move=> AP BQ i j; rewrite !mxE (le_trans (ler_norm_sum _ _ _))// ler_sum// => k _.
by rewrite normrM ler_pmul.
Qed.

Lemma within_add m n (A D B E : 'M[R]_(m, n)) : within A D -> within B E -> within (A + B) (D + E).
Proof. by move=> AD BE i j; rewrite !mxE (le_trans (ler_norm_add _ _))// ler_add. Qed.

Lemma within_moduli m n (A : 'M[R]_(m, n)) : within A (moduli A).
Proof. by move=> i j; rewrite mxE. Qed.

(* A term that is rounded, and how far it is from that of a member. *)
Theorem term_within n m (X' X P E : 'M[R]_n) (V' V F W' W : 'M[R]_(n, m)) (c : R) : 0 < c ->
  within X' P -> within (X' - X) E -> within (V' - V) F -> c *: W' = X' *m V' ->
  within (W' - W) (c^-1 *: (P *m F + E *m moduli V + moduli (X *m V - c *: W))).
Proof.
move=> c0 XP XE VF eW i j.
have e : c *: (W' - W) = X' *m (V' - V) + (X' - X) *m V + (X *m V - c *: W).
  by rewrite scalerBr eW mulmxBr mulmxBl !subrKA.
have := within_add (within_add (within_mul XP VF) (within_mul XE (within_moduli V)))
  (within_moduli (X *m V - c *: W)).
rewrite -e => /(_ i j).
by rewrite !mxE normrM gtr0_norm// => b; rewrite ler_pdivl_mull.
Qed.

(* What follows after the last term, in weights w of the rows. *)
Section Tail.
Variables (n : nat) (X P : 'M[R]_n) (w : 'I_n -> R) (nu : R) (K : nat) (v : nat -> 'cV[R]_n) (c : R).
Hypothesis weights : forall i, 0 < w i.
Hypothesis member : within X P.
Hypothesis growth : forall i, \sum_j P i j * w j <= nu * w i.
Hypothesis nu_ge0 : 0 <= nu.
Hypothesis far : nu < K.+1%:R.
Hypothesis series : forall j, (K + j).+1%:R *: v j.+1 = X *m v j.
Hypothesis last : forall i, `|v 0%N i 0| <= c * w i.

Let q := nu / K.+1%:R.

Lemma c_ge0 (i : 'I_n) : 0 <= c.
Proof. by rewrite -(pmulr_lge0 _ (weights i)) (le_trans _ (last i)). Qed.

Lemma term_small j i : `|v j i 0| <= c * q ^+ j * w i.
Proof.
have c0 := c_ge0 i.
have q0 : 0 <= q by rewrite /q divr_ge0 ?ler0n.
elim: j i => [|j IH] i; first by rewrite expr0 mulr1.
have s : `|(X *m v j) i 0| <= c * q ^+ j * (nu * w i).
  rewrite mxE (le_trans (ler_norm_sum _ _ _))//.
  apply: (@le_trans _ _ (\sum_l P i l * (c * q ^+ j * w l))).
    by apply: ler_sum => l _; rewrite normrM ler_pmul.
  rewrite (eq_bigr (fun l => c * q ^+ j * (P i l * w l))) => [|l _]; last by rewrite mulrCA.
  by rewrite -mulr_sumr ler_wpmul2l// mulr_ge0// exprn_ge0.
have k0 : 0 < (K + j).+1%:R :> R by rewrite ltr0n.
have : `|v j.+1 i 0| <= (c * q ^+ j * (nu * w i)) / (K + j).+1%:R.
  rewrite ler_pdivl_mulr// mulrC -[X in X * _]gtr0_norm// -normrM.
  by have := series j => /(congr1 (fun u : 'cV_n => u i 0)); rewrite mxE => ->.
move=> /le_trans; apply.
have b : (K + j).+1%:R^-1 <= K.+1%:R^-1 :> R.
  by rewrite lef_pinv ?posrE ?ltr0n// ler_nat ltnS leq_addr.
have -> : c * q ^+ j.+1 * w i = c * q ^+ j * (nu * w i) * K.+1%:R^-1.
  by rewrite exprSr /q !mulrA [RHS]mulrAC.
by rewrite ler_wpmul2l// !mulr_ge0 ?exprn_ge0// ltW.
Qed.

Theorem tail_within J i :
  \sum_(j < J) `|v j.+1 i 0| <= c * w i * (nu / (K.+1%:R - nu)).
Proof.
have c0 := c_ge0 i.
have k0 : 0 < K.+1%:R :> R by rewrite ltr0n.
have q0 : 0 <= q by rewrite /q divr_ge0 ?ler0n.
have q1 : q < 1 by rewrite /q ltr_pdivr_mulr ?mul1r.
have e : nu / (K.+1%:R - nu) = q / (1 - q).
  have -> : 1 - q = (K.+1%:R - nu) / K.+1%:R by rewrite mulrBl divff ?lt0r_neq0.
  by rewrite invf_div /q mulrA divfK ?lt0r_neq0.
have geo : \sum_(j < J) q ^+ j.+1 <= q / (1 - q).
  have s1 : (1 - q) * (\sum_(j < J) q ^+ j) <= 1.
    by rewrite -[1 - q]opprB mulNr -subrX1 opprB ler_subl_addr ler_addl exprn_ge0.
  rewrite ler_pdivl_mulr ?subr_gt0// (eq_bigr (fun j : 'I_J => q * q ^+ j)) => [|j _]; last by rewrite exprS.
  by rewrite -mulr_sumr -mulrA [_ * (1 - q)]mulrC -[X in _ <= X]mulr1 ler_wpmul2l.
rewrite e (le_trans _ (ler_wpmul2l _ geo)) ?mulr_ge0 ?(ltW (weights i))//.
rewrite mulr_sumr ler_sum// => j _.
by rewrite (le_trans (term_small j.+1 i))// -mulrA [_ * w i]mulrC mulrA.
Qed.
End Tail.

(* All sums of the series beyond the last term that is built are within the radii. *)
Section Series.
Variables (n m : nat) (X' X P E : 'M[R]_n) (v V F : nat -> 'M[R]_(n, m)) (w : 'I_n -> R) (nu : R) (K : nat).
Variables (c : 'I_m -> R) (reached : 'I_n -> 'I_m -> bool).
Hypothesis member : within X' P.
Hypothesis near : within (X' - X) E.
Hypothesis first : within (v 1%N - V 1%N) (F 1%N).
Hypothesis series : forall k, (0 < k)%N -> k.+1%:R *: v k.+1 = X' *m v k.
Hypothesis errors : forall k, (0 < k < K)%N -> forall i j,
  (P *m F k + E *m moduli (V k) + moduli (X *m V k - k.+1%:R *: V k.+1)) i j <= k.+1%:R * F k.+1 i j.
Hypothesis K_gt0 : (0 < K)%N.
Hypothesis last_built : V K = 0.
Hypothesis weights : forall i, 0 < w i.
Hypothesis growth : forall i, \sum_j P i j * w j <= nu * w i.
Hypothesis nu_ge0 : 0 <= nu.
Hypothesis far : nu < K.+1%:R.
Hypothesis last : forall i j, F K i j <= c j * w i.
Hypothesis not_last : forall i j, ~~ reached i j -> F K i j = 0.
Hypothesis paths : forall i l j, ~~ reached i j -> reached l j -> P i l = 0.

Lemma near_terms k : (0 < k <= K)%N -> within (v k - V k) (F k).
Proof.
elim: k => // -[_ _ //|k IH] /andP[_ kK] i j.
have k0 : 0 < k.+2%:R :> R by rewrite ltr0n.
apply: le_trans (term_within (V k.+2) k0 member near (IH (ltnW kK)) (series (ltn0Sn k)) i j) _.
by rewrite mxE ler_pdivr_mull//; apply: errors.
Qed.

Lemma unreached t i j : ~~ reached i j -> v (K + t) i j = 0.
Proof.
elim: t i => [|t IH] i no.
  have := near_terms (k := K); rewrite K_gt0 leqnn last_built subr0 addn0 => /(_ isT i j).
  by rewrite not_last// normr_le0 => /eqP.
have Kt : (0 < K + t)%N by rewrite addn_gt0 K_gt0.
have := congr1 (fun M : 'M_(n, m) => M i j) (series Kt); rewrite !mxE addnS.
rewrite big1 => [/eqP|l _]; first by rewrite mulf_eq0 pnatr_eq0 => /eqP.
have [yes|/negPf/negbT/IH ->] := boolP (reached l j); last by rewrite mulr0.
by have := member i l; rewrite (paths no yes) normr_le0 => /eqP ->; rewrite mul0r.
Qed.

Theorem sampled_within N : (K <= N)%N ->
  within (\sum_(1 <= k < N.+1) v k - \sum_(1 <= k < K.+1) V k)
    (\sum_(1 <= k < K.+1) F k +
     \matrix_(i, j) (if reached i j then c j * w i * (nu / (K.+1%:R - nu)) else 0)).
Proof.
move=> KN i j.
rewrite (@big_cat_nat _ _ _ K.+1 1 N.+1)//= addrAC -sumrB mxE [in X in _ <= X]mxE.
rewrite (le_trans (ler_norm_add _ _))// ler_add//.
  rewrite !summxE (le_trans (ler_norm_sum _ _ _))// big_seq [X in _ <= X]big_seq ler_sum// => k.
  by rewrite mem_index_iota ltnS => kK; apply: near_terms.
rewrite mxE summxE (le_trans (ler_norm_sum _ _ _))//.
have -> : \sum_(K.+1 <= k < N.+1) `|v k i j| = \sum_(t < N - K) `|v (K + t.+1) i j|.
  rewrite -{1}[K.+1]add0n big_addn subSS big_mkord.
  by apply: eq_bigr => t _; rewrite addnS addnC -addnS.
case: ifPn => [_|no]; last by rewrite big1// => t _; rewrite unreached ?normr0.
pose u t : 'cV_n := col j (v (K + t)).
have su t : (K + t).+1%:R *: u t.+1 = X' *m u t.
  by rewrite /u addnS !colE scalemxAl series ?addn_gt0 ?K_gt0// mulmxA.
have := @tail_within n X' P w nu K u (c j) weights member growth nu_ge0 far su _ (N - K) i.
rewrite (eq_bigr (fun t : 'I_(N - K) => `|v (K + t.+1) i j|)) => [|t _]; last by rewrite mxE.
apply=> l; rewrite mxE addn0 (le_trans _ (last l j))//.
by have := near_terms (k := K); rewrite K_gt0 leqnn last_built subr0 => /(_ isT l j).
Qed.

(* What the sums tend to is within the radii, too: the exponential less its constant term. *)
Theorem sampled_limit (L : 'M[R]_(n, m)) :
  (forall eps, 0 < eps -> exists N0, forall N, (N0 <= N)%N -> forall i j,
    `|(\sum_(1 <= k < N.+1) v k) i j - L i j| <= eps) ->
  within (L - \sum_(1 <= k < K.+1) V k)
    (\sum_(1 <= k < K.+1) F k +
     \matrix_(i, j) (if reached i j then c j * w i * (nu / (K.+1%:R - nu)) else 0)).
Proof.
move=> tends i j; apply/ler_addgt0Pr => eps /tends[N0 h]; rewrite [X in _ <= X]addrC.
have := h _ (leq_maxl N0 K) i j; have := sampled_within (leq_maxr N0 K) i j.
set s := \sum_(1 <= k < (maxn N0 K).+1) v k; set b := \sum_(1 <= k < K.+1) V k => near_sum close.
have -> : (L - b) i j = (L i j - s i j) + (s - b) i j by rewrite !mxE addrA subrK.
by rewrite (le_trans (ler_norm_add _ _))// ler_add// distrC.
Qed.
End Series.
End Sampling.
