(* The paper's example (IV-B) over any field: three channels, cyclic neighbor graph.  The agents 1, 2,
   3 of the paper are the ordinals 0, 1, 2.  `mcexact reproduce` checks the same statements by
   certificates. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence anderson_clements extended.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Example.
Variable L : fieldType.

(* B_1 = B_3 = e_1, B_2 = e_2; C_1 has the rows e_1', e_3', and C_2 = C_3 = e_2'. *)
Definition p3 (i : 'I_3) : nat := 1%N.
Definition q3 (i : 'I_3) : nat := (if val i == 0 then 2 else 1)%N.
Definition enters (i : 'I_3) : nat := (if val i == 1 then 1 else 0)%N.
Definition reads (i : 'I_3) (a : nat) : nat := (if val i == 0 then (if a == 0 then 0 else 2) else 1)%N.

Definition plant : multichannel L 3 p3 q3 := Multichannel
  (1%:M + delta_mx (inord 2) (inord 1))
  (fun i => \matrix_(a, b) (a == enters i :> nat)%:R)
  (fun i => \matrix_(a, b) (b == reads i a :> nat)%:R).

(* N_1 = {1, 2}, N_2 = {2, 3}, N_3 = {3, 1} *)
Definition next (i : 'I_3) : 'I_3 := inord (i.+1 %% 3).
Definition N3 (i : 'I_3) : {set 'I_3} := [set i; next i].

Lemma N3_own i : i \in N3 i. Proof. by rewrite !inE eqxx. Qed.

Let e a : 'rV[L]_3 := delta_mx 0 (inord a).
Notation agent2 := (inord 1 : 'I_3).

Lemma plant_at_1 : 1%:M - mcA plant = - ((e 2)^T *m e 1).
Proof.
by rewrite /plant /= opprD addrA subrr add0r /e trmx_delta mul_delta_mx.
Qed.

Lemma input_e i : mcB plant i = (e (enters i))^T.
Proof.
apply/matrixP=> a b; rewrite !mxE ord1 eqxx /= -val_eqE /= inordK//.
by rewrite /enters; case: ifP.
Qed.

Lemma output_e2 i : val i != 0%N -> mcC plant i = const_mx 1 *m e 1.
Proof.
move=> i0; apply/matrixP=> a b.
by rewrite !mxE big_ord1 !mxE eqxx /= mul1r /reads (negPf i0) -val_eqE /= inordK.
Qed.

(* With u = {agent 2} and outputs that see x_2 only, the rank at 1 is at most 2. *)
Lemma rank_at_agent2 q (C : 'M[L]_(q, 3)) c : C = c *m e 1 ->
  (\rank (block_mx (1%:M - mcA plant)%R (inputs plant (~: [set agent2])) C 0%R) <= 2)%N.
Proof.
move=> eC.
have [b eb] : exists b, inputs plant (~: [set agent2]) = (e 0)^T *m b.
  exists (\mxrow_i (if i \in ~: [set agent2] then 1%:M else 0)); rewrite mul_mxrow.
  apply/eq_mxrowP => i; rewrite !inE; case: ifPn => [i1|]; last by rewrite mulmx0.
  rewrite input_e mulmx1 /enters ifN//; apply: contra i1 => /eqP i1.
  by apply/eqP/val_inj; rewrite /= inordK.
have -> : block_mx (1%:M - mcA plant) (inputs plant (~: [set agent2])) C 0 =
    col_mx (- (e 2)^T) c *m row_mx (e 1) 0 + col_mx (e 0)^T 0 *m row_mx 0 b.
  rewrite !mul_col_row add_block_mx !mulmx0 !mul0mx !addr0 add0r -eC -eb.
  by rewrite plant_at_1 mulNmx.
apply: leq_trans (mxrank_add _ _) _; apply: (@leq_add _ _ 1 1).
  by rewrite (leq_trans (mxrankM_maxl _ _))// rank_leq_col.
by rewrite (leq_trans (mxrankM_maxl _ _))// rank_leq_col.
Qed.

Lemma outputs_e2 (T : {set 'I_3}) : inord 0 \notin T -> exists c, outputs plant T = c *m e 1.
Proof.
move=> T0; exists (\mxcol_i (if i \in T then const_mx 1 else 0)); rewrite mxcol_mul.
apply/eq_mxcolP => i; case: ifP => [iT|_]; last by rewrite mul0mx.
apply: output_e2; apply: contra T0 => /eqP i0; suff <- : i = inord 0 by [].
by apply/val_inj; rewrite /= inordK.
Qed.

Lemma hear_agent2 : neighborhood N3 [set agent2] = [set agent2; inord 2].
Proof. by rewrite /neighborhood big_set1 /N3 /next inordK. Qed.

Lemma not_heard : (inord 0 : 'I_3) \notin [set agent2; inord 2].
Proof. by rewrite !inE -!val_eqE /= !inordK. Qed.

(* IV-B: with augmented outputs, whatever F_1, F_2, F_3 are, over whatever extension field, 1 is an
   eigenvalue of the closed loop of (mss). *)
Theorem example_mss_fixed : fixed (augmented_outputs N3 plant) 1.
Proof.
apply: (@anderson_clements_easy _ _ _ _ _ _ [set agent2]).
suff [c eC] : exists c, outputs (augmented_outputs N3 plant) [set agent2] = c *m e 1.
  by rewrite /pencil ltnS; apply: rank_at_agent2 eC.
have [c ec] := outputs_e2 not_heard.
pose c' i : 'cV[L]_(\sum_i q3 i) := if i \in [set agent2] then c else 0.
exists (\mxcol_i c' i); rewrite mxcol_mul; apply/eq_mxcolP => i.
rewrite /c' inE; case: eqP => [->|_]; last by rewrite mul0mx.
by rewrite -ec /= -hear_agent2 /neighborhood big_set1.
Qed.

(* With no scalar shared by agent 3 the extended system still has the fixed mode 1, whatever agents 1
   and 2 share; k i is the paper's n_i. *)
Theorem example_extended_fixed (k : 'I_3 -> nat) : k (inord 2) = 0%N -> fixed (extended N3 k plant) 1.
Proof.
move=> k2; apply/anderson_clements; exists [set agent2]; rewrite rank_extended.
rewrite hear_agent2 (_ : [set agent2; inord 2] :\: [set agent2] = [set inord 2]); last first.
  by apply/setP=> i; rewrite !inE; case: eqVneq => // ->; rewrite -val_eqE /= !inordK.
rewrite big_set1 k2 addn0 ltn_add2r ltnS /neighbor_pencil hear_agent2.
  by have [c eC] := outputs_e2 not_heard; apply: rank_at_agent2 eC.
exact: N3_own.
Qed.

(* One scalar, shared by agent 3. *)
Definition one_scalar (i : 'I_3) : nat := (val i == 2)%N.

Lemma kernel_inputs (w : 'rV[L]_3) (T : {set 'I_3}) i : w *m inputs plant T = 0 -> i \in T -> w 0 (inord (enters i)) = 0.
Proof.
rewrite /inputs mul_mxrow => /mxrowP/(_ i); rewrite mxrowK submxrow0 => + iT; rewrite iT.
move=> /matrixP/(_ 0 (ord0 : 'I_(p3 i))); rewrite [RHS]mxE mxE (bigD1 (inord (enters i)))//= big1.
  by rewrite addr0 !mxE inordK ?eqxx ?mulr1// /enters; case: ifP.
move=> j ji; rewrite !mxE; case: eqP => [ej|]; last by rewrite mulr0.
by case/eqP: ji; apply/val_inj; rewrite /= inordK// /enters; case: ifP.
Qed.

Lemma kernel_plant (w : 'rV[L]_3) : w *m (1%:M - mcA plant) = 0 -> w 0 (inord 2) = 0.
Proof.
rewrite plant_at_1 mulmxN => /eqP; rewrite oppr_eq0 mulmxA => /eqP/matrixP/(_ 0 (inord 1)).
by rewrite [RHS]mxE mxE big_ord1 !mxE (bigD1 (inord 2))//= !mxE !eqxx mulr1 big1 ?addr0 ?mulr1// => j; rewrite !mxE eq_sym => /negPf->; rewrite mulr0.
Qed.

Lemma zero_row (w : 'rV[L]_3) : w 0 (inord 0) = 0 -> w 0 (inord 1) = 0 -> w 0 (inord 2) = 0 -> w = 0.
Proof.
move=> w0 w1 w2; apply/matrixP=> a b; rewrite ord1 mxE.
have -> : b = inord b by apply/val_inj; rewrite /= inordK.
by case: b => [[|[|[|]]]] //= _.
Qed.

Lemma kernel_outputs (v : 'cV[L]_3) (T : {set 'I_3}) i a : (a < q3 i)%N -> outputs plant T *m v = 0 ->
  i \in T -> v (inord (reads i a)) 0 = 0.
Proof.
move=> aq /outputs_eq0 h /h /matrixP/(_ (Ordinal aq) 0); rewrite [RHS]mxE mxE.
have r3 : (reads i a < 3)%N by rewrite /reads; do 2?case: ifP.
rewrite (bigD1 (inord (reads i a)))//= !mxE inordK// eqxx mul1r big1 ?addr0// => j jr.
rewrite !mxE; case: eqP => [ej|]; last by rewrite mul0r.
by case/eqP: jr; apply/val_inj; rewrite /= inordK.
Qed.

(* Rows: a left kernel that is 0 gives rank 3, whatever the outputs are. *)
Lemma rank_by_inputs q (B : 'M[L]_(3, q)) r (C : 'M[L]_(r, 3)) (X : 'M_(r, q)) lambda d (Z : 'M_(d, 3)) :
  (forall w : 'rV_3, w *m (lambda%:M - mcA plant) = 0 -> w *m B = 0 -> (w <= Z)%MS) ->
  (3 - d <= \rank (block_mx (lambda%:M - mcA plant) B C X))%N.
Proof.
move=> h; have le : (\rank (row_mx (lambda%:M - mcA plant) B) <=
    \rank (block_mx (lambda%:M - mcA plant)%R B C X))%N by rewrite block_mxEv -addsmxE mxrankS// addsmxSl.
apply: leq_trans le; rewrite leq_subLR addnC -leq_subLR -mxrank_ker.
apply: leq_trans (rank_leq_row Z); apply/mxrankS/row_subP => i; apply: h.
  by have := row_sub i (kermx (row_mx (lambda%:M - mcA plant) B)) => /sub_kermxP;
    rewrite mul_mx_row -(row_mx0 _ 1 3 q) => /eq_row_mx[].
by have := row_sub i (kermx (row_mx (lambda%:M - mcA plant) B)) => /sub_kermxP;
    rewrite mul_mx_row -(row_mx0 _ 1 3 q) => /eq_row_mx[].
Qed.

Lemma rank_by_inputs3 q (B : 'M[L]_(3, q)) r (C : 'M[L]_(r, 3)) (X : 'M_(r, q)) lambda :
  (forall w : 'rV_3, w *m (lambda%:M - mcA plant) = 0 -> w *m B = 0 -> w = 0) ->
  (3 <= \rank (block_mx (lambda%:M - mcA plant) B C X))%N.
Proof.
by move=> h; apply: (@rank_by_inputs _ _ _ _ _ _ 0 (0 : 'M_(0, 3))) => w wA wB; rewrite (h w) ?sub0mx.
Qed.

Lemma rank_by_outputs q (B : 'M[L]_(3, q)) r (C : 'M[L]_(r, 3)) lambda :
  (forall v : 'cV_3, C *m v = 0 -> v = 0) -> (3 <= \rank (block_mx (lambda%:M - mcA plant) B C 0))%N.
Proof.
move=> h; have rC : \rank C = 3%N.
  apply/eqP; rewrite -mxrank_tr -[_ == _]/(row_free C^T) -kermx_eq0; apply/negPn/negP.
  case/rowV0Pn=> w /sub_kermxP e0 /negP; apply; rewrite -trmx_eq0; apply/eqP/h.
  by rewrite -[C]trmxK -trmx_mul e0 trmx0.
by rewrite -{1}rC block_mxEv -addsmxE -(rank_row_mx0 q C) mxrankS// addsmxSr.
Qed.

(* With one scalar shared by agent 3 the extended system has no fixed mode, over any field. *)
Theorem example_one_scalar lambda : ~ fixed (extended N3 one_scalar plant) lambda.
Proof.
apply/(extended_not_fixed one_scalar N3_own) => s; rewrite /neighbor_pencil.
have zero r : (3 <= r)%N -> (3 - r <= \sum_(i in neighborhood N3 s :\: s) one_scalar i)%N.
  by rewrite -subn_eq0 => /eqP->.
have [->|l1] := eqVneq lambda 1; last first.
  (* away from 1 the matrix lambda I - A is nonsingular *)
  apply/zero/rank_by_inputs3 => w e0 _.
  have := e0; rewrite mulmxBr mul_mx_scalar /plant /= mulmxDr mulmx1 opprD addrA -{2}[w]scale1r -scalerBl.
  move=> /eqP; rewrite subr_eq0 => /eqP e1.
  have ent j : (lambda - 1) * w 0 j = (w *m delta_mx (inord 2) (inord 1)) 0 j.
    by have /matrixP/(_ 0 j) := e1; rewrite mxE.
  have dl j : (w *m delta_mx (inord 2) (inord 1)) 0 j = w 0 (inord 2) * (j == inord 1)%:R.
    rewrite mxE (bigD1 (inord 2))//= big1 ?addr0; first by rewrite !mxE eqxx.
    by move=> i i2; rewrite !mxE (negPf i2) mulr0.
  have nl : lambda - 1 != 0 by rewrite subr_eq0.
  have w2 : w 0 (inord 2) = 0.
    by apply: (mulfI nl); rewrite ent dl -val_eqE /= !inordK// mulr0 mulr0.
  have wj j : w 0 j = 0 by apply: (mulfI nl); rewrite ent dl w2 mul0r mulr0.
  by apply/matrixP=> i j; rewrite ord1 wj mxE.
pose o (a : nat) : 'I_3 := inord a.
(* whether the inputs outside s reach everything, the outputs of N_s see everything, or s is {2} *)
have reach3 : o 1%N \notin s -> (o 0%N \notin s) || (o 2%N \notin s) ->
    (3 <= \rank (block_mx (1%:M - mcA plant) (inputs plant (~: s)) (outputs plant (neighborhood N3 s)) 0))%N.
  move=> s1 s02; apply: rank_by_inputs3 => w wA wB.
  apply: zero_row; last exact: kernel_plant.
    case/orP: s02 => si; have := kernel_inputs wB; [move/(_ (o 0%N)) | move/(_ (o 2%N))];
    by rewrite inE si /enters /= inordK//; apply.
  have := kernel_inputs wB; move/(_ (o 1%N)); rewrite inE s1 /enters /= inordK//; exact.
have see3 (T : {set 'I_3}) : o 0%N \in T -> (o 1%N \in T) || (o 2%N \in T) ->
    (3 <= \rank (block_mx (1%:M - mcA plant) (inputs plant (~: s)) (outputs plant T) 0))%N.
  move=> T0 T12; apply: rank_by_outputs => v ov.
  have v0 : v (inord 0) 0 = 0.
    by have := @kernel_outputs v T (o 0%N) 0%N; rewrite /q3 /reads /= inordK//; apply.
  have v2 : v (inord 2) 0 = 0.
    by have := @kernel_outputs v T (o 0%N) 1%N; rewrite /q3 /reads /= inordK//; apply.
  have v1 : v (inord 1) 0 = 0.
    case/orP: T12 => Ti; [have := @kernel_outputs v T (o 1%N) 0%N | have := @kernel_outputs v T (o 2%N) 0%N];
    by rewrite /q3 /reads /= inordK//; apply.
  by apply: trmx_inj; rewrite trmx0; apply: zero_row; rewrite mxE.
have own i : i \in s -> i \in neighborhood N3 s by move=> si; apply/bigcupP; exists i; rewrite ?N3_own.
have nxt i : i \in s -> next i \in neighborhood N3 s.
  by move=> si; apply/bigcupP; exists i; rewrite // !inE eqxx orbT.
have n1 : next (o 1%N) = o 2%N by rewrite /next /o inordK.
have n2 : next (o 2%N) = o 0%N by rewrite /next /o inordK.
have [s1|s1] := boolP (o 1%N \in s); last first.
  have [s0|s0] := boolP (o 0%N \in s); last by apply/zero/reach3; rewrite ?s0.
  have [s2|s2] := boolP (o 2%N \in s); last by apply/zero/reach3; rewrite ?s2 ?orbT.
  by apply/zero/see3; [exact: own | rewrite (own _ s2) orbT].
have [s0|s0] := boolP (o 0%N \in s); first by apply/zero/see3; [exact: own | rewrite (own _ s1)].
have [s2|s2] := boolP (o 2%N \in s); first by apply/zero/see3; [rewrite -n2 nxt | rewrite (own _ s1)].
apply: (@leq_trans 1); last first.
  rewrite (bigD1 (o 2%N)) /=; first by rewrite /one_scalar /o /= inordK.
  by rewrite inE s2 -n1 nxt.
rewrite leq_subLR addnC -leq_subLR; apply: (@rank_by_inputs _ _ _ _ _ _ 1 (e 1)) => w wA wB.
have w0 : w 0 (inord 0) = 0.
  by have := kernel_inputs wB; move/(_ (o 0%N)); rewrite inE s0 /enters /= inordK//; apply.
have -> : w = w 0 (inord 1) *: e 1.
  apply/eqP; rewrite -subr_eq0; apply/eqP/zero_row; rewrite !mxE ?kernel_plant// ?w0 -?val_eqE /= ?inordK//.
  - by rewrite mulr0 subrr.
  - by rewrite mulr1 subrr.
  - by rewrite mulr0 subrr.
exact: scalemx_sub.
Qed.
End Example.
