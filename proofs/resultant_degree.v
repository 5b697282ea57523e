(* A bound for the degree in t of the resultant in x of two polynomials in x and t, by slopes.

   Over the series in 1/t the resultant of a monic f and of g is the product of g(alpha) over the roots alpha of f, of
   degrees a_r.  The proof needs no series: degrees of the entries of Sylvester's matrix are at most sums of a number of
   the row and one of the column, and so is the degree of every product of its determinant. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Close Scope group_scope.
Local Open Scope ring_scope.

Section Slopes.
Implicit Types (a b : nat -> rat).
Definition upto a p := \sum_(r < p) a r.
Lemma uptoS a p : upto a p.+1 = upto a p + a p. Proof. by rewrite /upto big_ord_recr. Qed.
Lemma falling a n : (forall r, (r.+1 < n)%N -> a r.+1 <= a r) -> forall r s, (r <= s)%N -> (s < n)%N -> a s <= a r.
Proof.
move=> fall r; elim=> [|s IH]; first by rewrite leqn0 => /eqP ->.
rewrite leq_eqVlt => /orP[/eqP -> //|rs] sn; exact: le_trans (fall s sn) (IH rs (ltnW sn)).
Qed.
Lemma shuffle (P Q S x y : rat) : P + Q + S + (x + y) = P + x + Q + (S + y).
Proof. by rewrite [P + x + Q]addrAC -!addrA [S + (x + y)]addrCA. Qed.
Lemma shuffle2 (P Q S x y : rat) : P + Q + S + (x + y) = P + (Q + y) + (S + x).
Proof. by rewrite -!addrA; congr (_ + (_ + _)); rewrite addrA addrC. Qed.
Lemma balance (A B C V X : rat) : V <= A + B + X -> - B + (C - A) + V <= C + X.
Proof.
move=> le; have -> : - B + (C - A) = C - (A + B) by rewrite addrCA -opprD [B + A]addrC.
have -> : C + X = C - (A + B) + (A + B + X) by rewrite [RHS]addrA subrK.
by rewrite ler_add2l.
Qed.
(* One number for each sum p + q of numbers of largest slopes. *)
Lemma merged a b n m : (forall r, (r.+1 < n)%N -> a r.+1 <= a r) -> (forall s, (s.+1 < m)%N -> b s.+1 <= b s) ->
  exists V : nat -> rat, (forall p q, (p <= n)%N -> (q <= m)%N -> upto a p + upto b q <= V (p + q)%N) /\
    \sum_(t < n + m) V t.+1 <= \sum_(p < n) upto a p.+1 + \sum_(q < m) upto b q.+1 + \sum_(r < n) \sum_(s < m) Num.max (a r) (b s).
Proof.
have [k] := ubnP (n + m); elim: k n m => // k IH [|n] [|m] lt fa fb.
- by exists (upto b); split=> [[|p] q //= _ _|]; rewrite ?big_ord0 ?addr0 // {1}/upto big_ord0 add0r.
- exists (upto b); split=> [[|p] q //= _ _|]; first by rewrite {1}/upto big_ord0 add0r.
  by rewrite [X in _ <= X + _ + _]big_ord0 [X in _ <= _ + X]big_ord0 add0r addr0.
- exists (upto a); split=> [p [|q] //= _ _|]; first by rewrite addn0 [upto b 0]big_ord0 addr0.
  rewrite addn0 [X in _ <= _ + X + _]big_ord0 addr0 [X in _ <= _ + X]big1 ?addr0 // => r _; exact: big_ord0.
have fa' r : (r.+1 < n)%N -> a r.+1 <= a r by move=> h; apply: fa; apply: ltnW.
have fb' s : (s.+1 < m)%N -> b s.+1 <= b s by move=> h; apply: fb; apply: ltnW.
pose top V t := if (t == n.+1 + m.+1)%N then upto a n.+1 + upto b m.+1 else V t : rat.
have last p q : (p <= n.+1)%N -> (q <= m.+1)%N -> (p + q == n.+1 + m.+1)%N -> p = n.+1 /\ q = m.+1.
  move=> pn qm /eqP e; have ep : p = n.+1.
    by apply/eqP; rewrite eqn_leq pn -(leq_add2r m.+1) -e leq_add2l.
  by split=> //; move/eqP: e; rewrite ep eqn_add2l => /eqP.
have sum V : \sum_(t < n.+1 + m.+1) top V t.+1 = \sum_(t < n + m.+1) V t.+1 + (upto a n.+1 + upto b m.+1).
  rewrite addSn big_ord_recr /= /top addSn eqxx; congr (_ + _); apply: eq_bigr => t _.
  by rewrite eqSS ltn_eqF.
have [le|gt] := leP (a n) (b m).
- have [|V [above total]] := IH n m.+1 _ fa' fb; first by move: lt; rewrite addSn ltnS.
  exists (top V); split=> [p q pn qm|]; rewrite ?sum.
    rewrite /top; case: ifP => [/(last _ _ pn qm)[-> ->] //|/negbT ne].
    move: pn; rewrite leq_eqVlt => /orP[/eqP ep|]; last by rewrite ltnS => pn; apply: above.
    rewrite ep in ne *; have qm' : (q < m.+1)%N by rewrite ltn_neqAle qm andbT; move: ne; rewrite eqn_add2l.
    rewrite addSnnS; apply: le_trans (above n q.+1 (leqnn n) qm'); rewrite !uptoS -addrA ler_add2l [a n + _]addrC ler_add2l.
    by apply: le_trans le _; apply: (falling fb).
  rewrite [X in _ <= X + _ + _]big_ord_recr [X in _ <= _ + X]big_ord_recr /=.
  have -> : \sum_(s < m.+1) Num.max (a n) (b s) = upto b m.+1.
    by apply: eq_bigr => s _; apply/max_idPr/(le_trans le)/(falling fb) => //; rewrite -ltnS.
  by rewrite -shuffle ler_add2r.
have [|V [above total]] := IH n.+1 m _ fa fb'; first by move: lt; rewrite addnS ltnS.
exists (top V); split=> [p q pn qm|]; rewrite ?sum.
  rewrite /top; case: ifP => [/(last _ _ pn qm)[-> ->] //|/negbT ne].
  move: qm; rewrite leq_eqVlt => /orP[/eqP eq|]; last by rewrite ltnS => qm; apply: above.
  rewrite eq in ne *; have pn' : (p < n.+1)%N by rewrite ltn_neqAle pn andbT; move: ne; rewrite eqn_add2r.
  rewrite addnS -addSn; apply: le_trans (above p.+1 m pn' (leqnn m)); rewrite !uptoS addrA [X in _ <= X]addrAC ler_add2l.
  by apply: le_trans (ltW gt) _; apply: (falling fa).
rewrite [X in _ <= _ + X + _]big_ord_recr /=.
have -> : \sum_(r < n.+1) \sum_(s < m.+1) Num.max (a r) (b s) = \sum_(r < n.+1) \sum_(s < m) Num.max (a r) (b s) + upto a n.+1.
  rewrite /upto -big_split; apply: eq_bigr => r _; rewrite big_ord_recr /=; congr (_ + _).
  by apply/max_idPl/(le_trans (ltW gt))/(falling fa) => //; rewrite -ltnS.
by rewrite -shuffle2 ler_add2r -addSnnS.
Qed.
End Slopes.

Section Determinant.
Variable R : idomainType.
Lemma det_degree N (S : 'M[{poly R}]_N) (u v : 'I_N -> rat) :
  (forall i j, S i j != 0 -> ((size (S i j)).-1)%:R <= u i + v j) ->
  \det S != 0 -> ((size (\det S)).-1)%:R <= \sum_i u i + \sum_j v j.
Proof.
move=> small; set d := (size _).-1 => nz; rewrite leNgt; apply/negP => big.
have : (\det S)`_d != 0 by rewrite -lead_coefE lead_coef_eq0.
case/negP; rewrite /determinant coef_sum big1 // => s _.
have [z|nzp] := eqVneq (\prod_i S i (s i)) 0; first by rewrite z mulr0 coef0.
have each i : S i (s i) != 0 by apply: contraNneq nzp => z; rewrite (bigD1 i) //= z mul0r.
have sz : ((size (\prod_i S i (s i))).-1)%:R <= \sum_i u i + \sum_j v j.
  have -> : (size (\prod_i S i (s i))).-1 = (\sum_i (size (S i (s i))).-1)%N.
    rewrite size_prod => [|i _]; last exact: each.
    rewrite subSKn; apply/eqP; rewrite -(eqn_add2r #|'I_N|) subnK; last first.
      by rewrite -sum1_card; apply: leq_sum => i _; rewrite size_poly_gt0.
    by rewrite -sum1_card -big_split; apply/eqP/eq_bigr => i _; rewrite /= addn1 prednK // size_poly_gt0.
  rewrite natr_sum [X in _ <= _ + X](reindex_inj (@perm_inj _ s)) -big_split /=; apply: ler_sum => i _; exact/small/each.
set P := \prod_i S i (s i) in nzp sz *; have dp : (size P <= d)%N.
  have sp : (0 < size P)%N by rewrite size_poly_gt0.
  by rewrite -(prednK sp) -(ltr_nat [numDomainType of rat]) (le_lt_trans sz).
by rewrite mulr_sign; case: ifP => _; rewrite ?coefN nth_default ?oppr0.
Qed.
End Determinant.

Section Resultant.
Variables (R : idomainType) (f g : {poly {poly R}}).
Notation n := (size f).-1.
Notation m := (size g).-1.
Notation degree c := ((size (c : {poly R})).-1)%:R.

(* By slopes of both polynomials. *)
Lemma resultant_slopes (a b : nat -> rat) (c : rat) :
  (forall r, (r.+1 < n)%N -> a r.+1 <= a r) -> (forall s, (s.+1 < m)%N -> b s.+1 <= b s) ->
  (forall k, (k <= n)%N -> f`_k != 0 -> degree f`_k <= upto a (n - k)) ->
  (forall k, (k <= m)%N -> g`_k != 0 -> degree g`_k <= c + upto b (m - k)) ->
  resultant f g != 0 -> degree (resultant f g) <= \sum_(r < n) (c + \sum_(s < m) Num.max (a r) (b s)).
Proof.
move=> fa fb df dg nz; have [V [above total]] := merged fa fb.
pose u (i : 'I_(m + n)) := match split i with inl i' => - upto b (m - i') | inr j => c - upto a (n - j) end.
pose v (l : 'I_(m + n)) := V (n + m - l)%N.
have apart i l N M : (i <= l)%N -> (l - i <= N)%N -> (i <= M)%N -> (N - (l - i) + (M - i) = N + M - l)%N.
  by move=> il lN iM; rewrite addnBA // addnBAC // -subnDA subnK.
have small i l : Sylvester_mx f g i l != 0 -> degree (Sylvester_mx f g i l) <= u i + v l.
  rewrite Sylvester_mxE /u /v; case: (split i) => [i'|j]; (case: leqP => [il|_]; last by rewrite mulr0n eqxx); rewrite mulr1n => nz0.
    have kn : (l - i' <= n)%N.
      by rewrite -ltnS (leq_trans _ (leqSpred _)) // ltnNge; apply: contra nz0 => h; rewrite nth_default.
    apply: le_trans (df _ kn nz0) _; rewrite addrC -ler_subl_addr opprK -(apart _ _ _ _ il kn (ltnW (ltn_ord i'))).
    by apply: above; rewrite leq_subr.
  have km : (l - j <= m)%N.
    by rewrite -ltnS (leq_trans _ (leqSpred _)) // ltnNge; apply: contra nz0 => h; rewrite nth_default.
  apply: le_trans (dg _ km nz0) _; rewrite -addrA ler_add2l addrC -ler_subl_addr opprK.
  have -> : (n + m - l = n - j + (m - (l - j)))%N by rewrite [RHS]addnC (apart _ _ _ _ il km (ltnW (ltn_ord j))) [in LHS]addnC.
  rewrite addrC.
  by apply: above; rewrite leq_subr.
apply: le_trans (det_degree small nz) _.
have rev N (F : nat -> rat) : \sum_(i < N) F (N - i)%N = \sum_(i < N) F i.+1.
  by rewrite (reindex_inj rev_ord_inj) /=; apply: eq_bigr => i _; rewrite subKn.
have -> : \sum_i u i = - (\sum_(q < m) upto b q.+1) + ((\sum_(r < n) c) - \sum_(p < n) upto a p.+1).
  rewrite big_split_ord /=; congr (_ + _).
    by rewrite -(rev m (upto b)) -sumrN; apply: eq_bigr => i _; rewrite /u (unsplitK (inl i)).
  by rewrite -(rev n (upto a)) -sumrB; apply: eq_bigr => j _; rewrite /u (unsplitK (inr j)).
have -> : \sum_l v l = \sum_(t < n + m) V t.+1 by rewrite -(rev (n + m)%N V) /v addnC.
by rewrite big_split; apply: balance.
Qed.

(* The nonincreasing b of which the sums are the least line above the degrees, at the slopes a. *)
Lemma steepest (a : rat) (b : nat -> rat) M : (forall s, (s.+1 < M)%N -> b s.+1 <= b s) ->
  exists2 q, (q <= M)%N & \sum_(s < M) Num.max a (b s) = upto b q + (M - q)%:R * a.
Proof.
elim: M => [|M IH] fall; first by exists 0%N; rewrite // /upto !big_ord0 mul0r addr0.
have [le|gt] := leP a (b M).
  exists M.+1; rewrite // subnn mul0r addr0; apply: eq_bigr => s _.
  by apply/max_idPr/(le_trans le)/(falling fall) => //; rewrite -ltnS.
have [q qM e] := IH (fun s h => fall s (ltnW h)); exists q; first exact: leqW.
by rewrite big_ord_recr /= e (max_idPl (ltW gt)) subSn // -addrA mulrS mulrDl mul1r [a + _]addrC.
Qed.

(* By the slopes of f alone: M r bounds the degree of g at the root r of f. *)
Theorem resultant_degree (a : nat -> rat) (M : nat -> rat) : (0 < n)%N ->
  (forall r, (r.+1 < n)%N -> a r.+1 <= a r) ->
  (forall k, (k <= n)%N -> f`_k != 0 -> degree f`_k <= upto a (n - k)) ->
  (forall r k, (r < n)%N -> g`_k != 0 -> degree g`_k + k%:R * a r <= M r) ->
  resultant f g != 0 -> degree (resultant f g) <= \sum_(r < n) M r.
Proof.
move=> n0 fa df dg nz; pose line (r : 'I_n) q := M r - (m - q)%:R * a r.
have i0 : 'I_n := Ordinal n0.
pose least q := line [arg min_(r < i0) line r q]%O q.
have leastP q r : least q <= line r q by rewrite /least; case: arg_minP => // r' _ /(_ r isT).
pose b s := least s.+1 - least s.
have sum q : least 0%N + upto b q = least q.
  by elim: q => [|q IH]; rewrite /upto ?big_ord0 ?addr0 // big_ord_recr /= addrA IH addrC subrK.
have fb s : (s.+1 < m)%N -> b s.+1 <= b s.
  have step r q : (q < m)%N -> line r q.+1 = line r q + a r.
    move=> qm; rewrite /line -addrA; congr (_ + _).
    by rewrite -[(m - q)%N]prednK ?subn_gt0 // -subnS mulrS mulrDl mul1r opprD addrAC addNr add0r.
  move=> sm; have [r e] : exists r, least s.+1 = line r s.+1 by exists [arg min_(r < i0) line r s.+1]%O.
  have up : least s.+2 <= least s.+1 + a r by rewrite e -step //; apply: leastP.
  have down : least s + a r <= least s.+1 by rewrite e step ?(ltnW sm) // ler_add2r; apply: leastP.
  rewrite /b; apply: (@le_trans _ _ (a r)); first by rewrite ler_subl_addl.
  by rewrite ler_subr_addl.
have bound := resultant_slopes fa fb (c := least 0%N) df _ nz; apply: le_trans (bound _) _ => [k km nk|].
  rewrite sum /least; set r := [arg min_(_ < _) _]%O; rewrite /line subKn // ler_subr_addr.
  exact: dg.
apply: ler_sum => r _; have [q qm ->] := steepest (a r) fb; rewrite addrA sum.
by apply: le_trans (_ : line r q + (m - q)%:R * a r <= _); [rewrite ler_add2r | rewrite /line subrK].
Qed.
End Resultant.
