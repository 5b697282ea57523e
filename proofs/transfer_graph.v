(* checker/core/reach.py and checker/core/evidence.py: arcs and zero transfers.

   C (xI - A)^-1 B is C adj(xI - A) B divided by chi_A, so it vanishes iff the polynomial matrix
   C adj(xI - A) B does; `transfer` is that matrix. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Transfer.
Variables (R : comRingType) (n b c : nat).
Implicit Types (A : 'M[R]_n) (B : 'M[R]_(n, b)) (C : 'M[R]_(c, n)).

Definition transfer A B C : 'M[{poly R}]_(c, b) :=
  map_mx polyC C *m \adj (char_poly_mx A) *m map_mx polyC B.

(* N_j, the coefficient of x^j in adj(xI - A), satisfies N_j = A N_(j+1) + chi_(j+1) I. *)
Let N A j : 'M[R]_n := map_mx (fun r : {poly R} => r`_j) (\adj (char_poly_mx A)).

Lemma adj_step A j : N A j = A *m N A j.+1 + (char_poly A)`_j.+1%:M.
Proof.
have /matrixP e := mul_mx_adj (char_poly_mx A).
apply/matrixP=> i t; have := congr1 (fun r : {poly R} => r`_j.+1) (e i t).
rewrite /char_poly_mx mulmxBl mul_scalar_mx !mxE coefB coefXM /= coefMn mulrb => e1.
have -> : \sum_k A i k * N A j.+1 k t = (\sum_k (map_mx polyC A) i k * (\adj (char_poly_mx A)) k t)`_j.+1.
  by rewrite coef_sum; apply: eq_bigr => s _; rewrite !mxE coefCM.
by rewrite -e1 addrC subrK.
Qed.

Lemma adj_coefficients A B C t j :
  C *m N A j *m B =
  C *m iter t (mulmx A) (N A (j + t)) *m B
    + \sum_(i < t) (char_poly A)`_(j + i).+1 *: (C *m krylov A B i).
Proof.
elim: t => [|t IH]; first by rewrite big_ord0 addr0 addn0.
rewrite IH big_ord_recr/= addrA addrAC; congr (_ + _).
rewrite adj_step addnS.
have it M M' : iter t (mulmx A) (M + M') = iter t (mulmx A) M + iter t (mulmx A) M'.
  by elim: t {IH} => [//|t IH] /=; rewrite IH mulmxDr.
have itS M : iter t (mulmx A) (A *m M) = A *m iter t (mulmx A) M.
  by elim: t {IH it} => [//|t IH] /=; rewrite IH.
have itC a : iter t (mulmx A) a%:M *m B = a *: krylov A B t.
  elim: t {IH it itS} => [|t IH] /=; first by rewrite mul_scalar_mx.
  by rewrite -mulmxA IH -scalemxAr.
by rewrite it itS mulmxDr mulmxDl -!mulmxA itC -scalemxAr.
Qed.

Lemma adj_bounded A : exists t, forall j, (t <= j)%N -> N A j = 0.
Proof.
exists (\max_(ij : 'I_n * 'I_n) size ((\adj (char_poly_mx A)) ij.1 ij.2)) => j /bigmax_leqP tj.
by apply/matrixP=> i k; have := tj (i, k) isT; rewrite /= !mxE => ?; rewrite nth_default.
Qed.

Lemma adj_markov A B C j : exists t, (forall s, (t <= s)%N -> C *m N A j *m B =
  \sum_(i < s) (char_poly A)`_(j + i).+1 *: (C *m krylov A B i)).
Proof.
have [t z] := adj_bounded A; exists t => s ts; rewrite (adj_coefficients A B C s) z.
  suff -> : iter s (mulmx A) 0 = 0 :> 'M_n by rewrite mulmx0 mul0mx add0r.
  by elim: s {ts} => [//|s IH] /=; rewrite IH mulmx0.
by rewrite (leq_trans ts)// leq_addl.
Qed.

Lemma transfer_coef A B C j i k : (transfer A B C i k)`_j = (C *m N A j *m B) i k.
Proof.
rewrite /transfer !mxE coef_sum; apply: eq_bigr => s _; rewrite !mxE.
rewrite coefMC coef_sum; congr (_ * _).
by apply: eq_bigr => t _; rewrite !mxE coefCM.
Qed.

(* A nonzero Markov parameter is a nonzero transfer matrix, and conversely. *)
Theorem transfer_markov A B C : (exists k, (k < n)%N && (C *m krylov A B k != 0)) -> transfer A B C != 0.
Proof.
case=> k /andP[kn]; apply: contraNneq => T0.
have z j : C *m N A j *m B = 0.
  by apply/matrixP=> i t; rewrite -transfer_coef T0 !mxE coef0.
have top : (char_poly A)`_n = 1.
  by have /monicP := char_poly_monic A; rewrite lead_coefE size_char_poly.
elim/ltn_ind: k kn => k IH kn; apply/eqP.
have [t /(_ (maxn t k.+1) (leq_maxl _ _))] := adj_markov A B C (n - k.+1).
have kl : (k < maxn t k.+1)%N by rewrite leq_max leqnn orbT.
rewrite z (bigD1 (Ordinal kl))//= -addnS subnK// top scale1r big1 ?addr0// => -[i il].
rewrite -val_eqE/= => ik; have [lik|] := ltnP i k.
  by rewrite (eqP (IH i lik (ltn_trans lik kn))) scaler0.
rewrite leq_eqVlt eq_sym (negPf ik)/= => ki.
by rewrite nth_default ?scale0r// size_char_poly ltnS -{1}(subnK kn) leq_add2l.
Qed.

Theorem transfer0_markov A B C : (forall k, C *m krylov A B k = 0) -> transfer A B C = 0.
Proof.
move=> z; apply/matrixP=> i k; apply/polyP=> j; rewrite transfer_coef [in RHS]mxE coef0.
have [t /(_ t (leqnn _)) ->] := adj_markov A B C j.
by rewrite big1 ?mxE// => s _; rewrite z scaler0.
Qed.
End Transfer.

Section Graph.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel L n p q) (T : {set 'I_m}).

(* Arc j -> i iff C_i (xI - A)^-1 B_j is not 0. *)
Definition arc S : rel 'I_m := fun j i => transfer (mcA S) (mcB S j) (mcC S i) != 0.
Definition strongly_connected S := forall j i, connect (arc S) j i.

(* Zero transfer from T to T': X spans an A-invariant space that holds B_T and that C_T' kills. *)
Record zero_transfer S T T' := ZeroTransfer {
  zt_dim : nat;
  zt_X : 'M[L]_(n, zt_dim);
  zt_pivots : 'I_zt_dim -> 'I_n;
  zt_invariant : mcA S *m zt_X = zt_X *m rowsub zt_pivots (mcA S *m zt_X);
  zt_input : forall j, j \in T -> mcB S j = zt_X *m rowsub zt_pivots (mcB S j);
  zt_output : forall i, i \in T' -> mcC S i *m zt_X = 0 }.

(* Rule "zero transfer". *)
Theorem zero_transfer_no_arc S T T' (E : zero_transfer S T T') j i :
  j \in T -> i \in T' -> ~~ arc S j i.
Proof.
move=> jT iT; rewrite negbK; apply/eqP/transfer0_markov => k.
have [x X piv inv inp out] := E; have [Y ->] : exists Y, krylov (mcA S) (mcB S j) k = X *m Y.
  elim: k => [|k [Y eY]]; first by exists (rowsub piv (mcB S j)); rewrite -inp.
  by exists (rowsub piv (mcA S *m X) *m Y); rewrite krylovS eY !mulmxA {1}inv.
by rewrite mulmxA out// mul0mx.
Qed.

Lemma connect_cut S T : (forall j i, j \in T -> i \notin T -> ~~ arc S j i) ->
  forall j i, connect (arc S) j i -> j \in T -> i \in T.
Proof.
move=> cut j i /connectP[s]; elim: s j => [j _ -> //|t s IH j /= /andP[jt pt] e jT].
by apply: IH pt e _; apply: contraLR jt => tT; apply: cut.
Qed.

(* Rule "cut": a zero transfer from a nonempty proper T to its complement. *)
(* Rule "no path": states that hold the inputs of j, that A does not leave, and that C_i does not see. *)
Record closed_states S (j i : 'I_m) (Z : {set 'I_n}) := ClosedStates {
  cs_input : forall a u, mcB S j a u != 0 -> a \in Z;
  cs_state : forall a b, b \in Z -> mcA S a b != 0 -> a \in Z;
  cs_output : forall v b, b \in Z -> mcC S i v b = 0 }.

Theorem closed_states_no_arc S j i Z : closed_states S j i Z -> ~~ arc S j i.
Proof.
case=> inp st out; rewrite negbK; apply/eqP/transfer0_markov => k.
have held a u : krylov (mcA S) (mcB S j) k a u != 0 -> a \in Z.
  elim: k a u => [|k IH] a u; first exact: inp.
  apply: contraNT => aZ; rewrite krylovS mxE big1// => b _.
  have [bZ|/negP bZ] := boolP (b \in Z); last by have [->|/IH//] := eqVneq (krylov (mcA S) (mcB S j) k b u) 0; rewrite mulr0.
  by have [->|/(st _ _ bZ)] := eqVneq (mcA S a b) 0; rewrite ?mul0r// => /(negP aZ).
apply/matrixP=> v u; rewrite !mxE big1// => b _.
have [bZ|/negP bZ] := boolP (b \in Z); first by rewrite out ?mul0r.
by have [->|/held//] := eqVneq (krylov (mcA S) (mcB S j) k b u) 0; rewrite mulr0.
Qed.

Theorem zero_transfer_cut S T (E : zero_transfer S T (~: T)) :
  T != set0 -> T != setT -> ~ strongly_connected S.
Proof.
move=> /set0Pn[j jT]; rewrite -subTset => /subsetPn[i _ iT] sc.
suff cut : forall j' i', j' \in T -> i' \notin T -> ~~ arc S j' i'.
  by have := connect_cut cut (sc j i) jT; rewrite (negPf iT).
move=> j' i' jT' iT'; by apply: (zero_transfer_no_arc E) => //; rewrite inE.
Qed.

(* Rule "arcs": some arcs that connect the graph are enough. *)
Theorem strongly_connected_arcs S (e : rel 'I_m) : (forall j i, e j i -> arc S j i) ->
  (forall j i, connect e j i) -> strongly_connected S.
Proof. by move=> sub c j i; apply: (connect_sub _ (c j i)) => a b /sub/connect1. Qed.
End Graph.

Section ArcRule.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Variables (L : fieldType) (h : {rmorphism rat -> L}).

Lemma residue_neq0 a b (M : 'M[Zloc l]_(a, b)) : map_mx (@residue l) M != 0 -> map_mx (into h) M != 0.
Proof.
apply: contraNneq => M0; apply/eqP/matrixP=> i j; have /matrixP/(_ i j)/eqP := M0.
by rewrite !mxE into_eq0 => /eqP->; rewrite rmorph0.
Qed.

(* Rule "arc": C_i A^k B_j is not 0 modulo l for one k < n. *)
Theorem arc_rule j i k : (k < n)%N ->
  map_mx (@residue l) (mcC S i *m krylov (mcA S) (mcB S j) k) != 0 -> arc (map_system (into h) S) j i.
Proof.
move=> kn /residue_neq0; rewrite map_mxM map_krylov => nz.
by apply: transfer_markov; exists k; rewrite kn.
Qed.

(* Kind `transfer_graph`: arcs and zero transfers for the rest give the graph exactly. *)
Theorem transfer_graph_rule (e : rel 'I_m) :
  (forall j i, e j i -> exists2 k, (k < n)%N &
     map_mx (@residue l) (mcC S i *m krylov (mcA S) (mcB S j) k) != 0) ->
  (forall j i, ~~ e j i -> (exists Z, closed_states (map_system (into h) S) j i Z) \/
     exists T T' (E : zero_transfer (map_system (into h) S) T T'), j \in T /\ i \in T') ->
  arc (map_system (into h) S) =2 e.
Proof.
move=> yes no j i; have [/yes[k kn]|/no[[Z cs]|[T [T' [E [jT iT]]]]]] := boolP (e j i).
- exact: arc_rule.
- by apply/negbTE/(closed_states_no_arc cs).
by apply/negbTE/(zero_transfer_no_arc E jT iT).
Qed.
End ArcRule.
