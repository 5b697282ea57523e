(* checker/structure.py: how the ranks of [B, A B, ..., A^(k-1) B] can grow; kind
   `controllability_indices`.

   A step from one rank to the next is at most the step before.  A relation of degree h,
   sum_(i <= h) A^i B v_i = 0, takes one input from every step after the first h, if the last
   coefficients of the relations are independent. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic controllability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Growth.
Variables (L : fieldType) (n b : nat) (A : 'M[L]_n) (B : 'M[L]_(n, b)).
Local Notation K k := (reach A B k)^T.
Local Notation P k := (krylov A B k)^T.

Lemma reach_sum k : (K k :=: \sum_(i < k) <<P i>>)%MS.
Proof. rewrite /reach tr_mxrow; exact: eqmx_col. Qed.

Lemma reach_next k : (K k.+1 :=: K k + P k)%MS.
Proof.
apply: (eqmx_trans (reach_sum k.+1)); rewrite big_ord_recr/=.
apply: adds_eqmx; last exact: genmxE.
by apply: eqmx_sym; apply: reach_sum.
Qed.

Lemma krylov_next k : P k.+1 = P k *m A^T.
Proof. by rewrite krylovS trmx_mul. Qed.

Lemma power_reached i k : (i < k)%N -> (P i <= K k)%MS.
Proof.
move=> ik; rewrite reach_sum; apply: (sumsmx_sup (Ordinal ik)) => //.
by rewrite genmxE.
Qed.

Lemma reach_moved k : (K k *m A^T <= K k.+1)%MS.
Proof.
rewrite (eqmxMr _ (reach_sum k)) sumsmxMr_gen; apply/sumsmx_subP => i _.
by rewrite genmxE (eqmxMr _ (genmxE _)) -krylov_next power_reached// ltnS.
Qed.

(* How much the block k adds to the rank. *)
Lemma rank_next k :
  \rank (reach A B k.+1) = (\rank (reach A B k) + \rank (P k *m cokermx (K k)))%N.
Proof.
rewrite -[LHS]mxrank_tr -[X in (X + _)%N]mxrank_tr (reach_next k).
have e := mxrank_mul_ker (K k + P k)%MS (cokermx (K k)).
have sk : ((K k + P k) :&: kermx (cokermx (K k)) :=: K k)%MS.
  apply/eqmxP/andP; split.
    by apply: submx_trans (capmxSr _ _) _; rewrite submxE mulmx_ker.
  by rewrite sub_capmx addsmxSl; apply/sub_kermxP; rewrite mulmx_coker.
rewrite -e sk addnC; congr (_ + _)%N.
by rewrite (addsmxMr (K k)) mulmx_coker adds0mx.
Qed.

(* The combinations of inputs that block k adds nothing for. *)
Definition idle k : 'M[L]_b := kermx (P k *m cokermx (K k)).

Lemma idleP k m (V : 'M[L]_(m, b)) : (V <= idle k)%MS = (V *m P k <= K k)%MS.
Proof. by rewrite [RHS]submxE -mulmxA; apply/sub_kermxP/eqP. Qed.

Lemma rank_step k : \rank (reach A B k.+1) = (\rank (reach A B k) + (b - \rank (idle k)))%N.
Proof. by rewrite rank_next /idle mxrank_ker subKn// rank_leq_row. Qed.

Lemma idle_next k : (idle k <= idle k.+1)%MS.
Proof.
rewrite idleP krylov_next mulmxA.
have s : (idle k *m P k <= K k)%MS by rewrite -idleP.
exact: submx_trans (submxMr A^T s) (reach_moved k).
Qed.

Lemma idle_later h k : (h <= k)%N -> (idle h <= idle k)%MS.
Proof.
elim: k => [|k IH]; first by rewrite leqn0 => /eqP->.
rewrite leq_eqVlt => /orP[/eqP->//|/IH s].
exact: submx_trans s (idle_next k).
Qed.

(* The steps from one rank to the next do not grow. *)
Theorem steps_do_not_grow k :
  (\rank (reach A B k.+2) + \rank (reach A B k) <= \rank (reach A B k.+1) + \rank (reach A B k.+1))%N.
Proof.
rewrite (rank_step k.+1) -addnA leq_add2l addnC [X in (_ <= X)%N]rank_step leq_add2l.
by rewrite leq_sub2l// mxrankS// idle_next.
Qed.

(* Independent last coefficients of relations of degree at most k. *)
Theorem relations_bound k m (V : 'M[L]_(m, b)) :
  row_free V -> (forall t, exists2 h, (h <= k)%N & (row t V *m P h <= K h)%MS) ->
  (\rank (reach A B k.+1) <= \rank (reach A B k) + (b - m))%N.
Proof.
move=> /eqP rV rel; rewrite rank_step leq_add2l leq_sub2l// -rV mxrankS//.
apply/row_subP => t; have [h hk] := rel t.
by rewrite -idleP => s; apply: submx_trans s (idle_later hk).
Qed.

(* A relation puts its last coefficient among the idle combinations of its degree. *)
Lemma relation_idle h (v : nat -> 'cV[L]_b) :
  \sum_(i < h.+1) krylov A B i *m v i = 0 -> ((v h)^T *m P h <= K h)%MS.
Proof.
rewrite big_ord_recr/= => /eqP; rewrite addrC addr_eq0 -trmx_mul => /eqP->.
rewrite raddfN/= eqmx_opp raddf_sum/=; apply: summx_sub => i _.
by rewrite trmx_mul mulmx_sub// power_reached.
Qed.

(* A row of V is the last coefficient of a relation of degree at most k. *)
Definition related k (c : 'rV[L]_b) := exists2 h, (h <= k)%N & exists v : nat -> 'cV[L]_b,
  \sum_(i < h.+1) krylov A B i *m v i = 0 /\ c = (v h)^T.

(* Each column has an input of its own, at which it is not 0 and all later ones are. *)
Theorem own_inputs_free m (V : 'M[L]_(m, b)) (j : 'I_m -> 'I_b) :
  (forall t, V t (j t) != 0) -> (forall s t : 'I_m, (s < t)%N -> V t (j s) = 0) -> row_free V.
Proof.
move=> own later; rewrite -row_leq_rank.
have u : (colsub j V)^T \in unitmx.
  rewrite unitmxE det_trig; last by apply/is_trig_mxP => s t st; rewrite !mxE later.
  by rewrite unitfE; apply/prodf_neq0 => t _; rewrite !mxE.
have : \rank (colsub j V) = m by rewrite -mxrank_tr; apply/eqP; have := u; rewrite -row_free_unit.
by move=> {1}<-; rewrite -{1}[V]mulmx1 -mulmx_colsub mxrankM_maxl.
Qed.

(* Rule `controllability_indices`: ranks that are reached, and cannot grow faster, are all. *)
Theorem growth_rule nu (r lam : nat -> nat) w (W : 'M[L]_(w, n)) Z :
  row_free W -> W *m A = Z *m W -> W *m B = 0 ->
  r 0%N = 0%N -> r nu.+1 = r nu -> (forall k, (k <= nu)%N -> (r k <= \rank (reach A B k))%N) ->
  (forall k, (k <= nu)%N -> exists2 V : 'M[L]_(lam k, b), row_free V & forall t, related k (row t V)) ->
  (forall k, (k <= nu)%N ->
    (minn (n - w) (r k + minn (if k is i.+1 then r k - r i else b) (b - lam k)) <= r k.+1)%N) ->
  forall k, (k <= nu.+1)%N -> \rank (reach A B k) = r k.
Proof.
move=> fW e z r0 last lo rel up; have rk i : (\rank (reach A B i) <= \rank (reach A B i.+1))%N.
  by rewrite rank_step leq_addr.
have lo' k : (k <= nu.+1)%N -> (r k <= \rank (reach A B k))%N.
  by rewrite leq_eqVlt => /orP[/eqP->|/lo//]; rewrite last; apply: leq_trans (lo _ _) (rk _).
have next k : (k <= nu)%N -> \rank (reach A B k) = r k ->
    (forall i, k = i.+1 -> \rank (reach A B i) = r i) -> \rank (reach A B k.+1) = r k.+1.
  move=> kn ek ei; apply/eqP; rewrite eqn_leq lo'// andbT; apply: leq_trans (up k kn).
  rewrite leq_min (uncontrollable_space _ fW e z)/= -leq_subLR leq_min; apply/andP; split.
    case: k kn ek ei => [|i] kn ek ei; first by rewrite rank_step ek addKn leq_subr.
    have := steps_do_not_grow i; rewrite ek (ei _ erefl) => s.
    rewrite leq_subLR -(leq_add2r (r i)); apply: leq_trans s _.
    by rewrite -addnA subnK// -ek -(ei _ erefl) rk.
  have [V fV relV] := rel k kn; rewrite leq_subLR -ek; apply: (relations_bound fV) => t.
  by have [h hk [v [rv ->]]] := relV t; exists h => //; apply: relation_idle rv.
suff both k : (k <= nu.+1)%N -> \rank (reach A B k) = r k /\
    (forall i, k = i.+1 -> \rank (reach A B i) = r i) by move=> k /both[].
elim: k => [_|k IH kn].
  by split=> [|i //]; apply/eqP; rewrite r0 -leqn0 (leq_trans (rank_leq_col _))// big_ord0.
by have [ek ei] := IH (ltnW kn); split=> [|i [<-]//]; apply: next.
Qed.
End Growth.
