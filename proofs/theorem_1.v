(* Theorem 1: over a strongly connected neighbor graph the error system of the distributed observer
   gets any monic characteristic polynomial of degree mn + m - 1, for given F_i and any agent q that
   carries the channel controller; and any symmetric list of complex numbers as its spectrum. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines neighbor_graph error_system.
From mcexact Require Import brasch_pearson.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section ErrorLoop.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).
Notation nm := (\sum_(i < m) n)%N.
Notation E := (error_system N S F).
Notation block i M := (block_of K n i *m M).

(* the gain [K_i H_i] of agent i *)
Definition observer_gains (KK : forall i, 'M[K]_(n, q i)) (H : 'I_m -> 'I_m -> 'M[K]_n) :
    gains K (fun=> n) (fun i => q i + nm)%N := fun i => row_mx (KK i) (\mxrow_j H i j).

(* (eme1), (eme2): channel controller of order k at agent o; state (e_1, ..., e_m, z) *)
Definition error_loop k (o : 'I_m) KK H (Kb : 'M_(k, q o)) (Hb : 'I_m -> 'M_(k, n)) (Ab : 'M_k)
    (Cb : 'M_(n, k)) : 'M[K]_(nm + k) :=
  block_mx (closed_loop E (observer_gains KK H)) (mcB E o *m Cb)
           (row_mx Kb (\mxrow_j Hb j) *m mcC E o) Ab.

Lemma differences_sum r i (H : 'I_m -> 'M[K]_(r, n)) (e : 'cV_nm) :
  \mxrow_j H j *m (differences K n N i *m e) = \sum_(j in N i) H j *m (block i e - block j e).
Proof.
rewrite /differences mxcol_mul mul_mxrow_mxcol [RHS]big_mkcond /=; apply: eq_bigr => j _.
by case: ifP => _; rewrite ?mul0mx ?mulmx0 // mulmxBl.
Qed.

Lemma block_input r i (G : 'I_m -> 'M[K]_(n, r)) :
  block i (\sum_j error_input K n j *m G j) = G i.
Proof.
rewrite mulmx_sumr [LHS](bigD1 i) //= [X in _ + X]big1 => [|j ji].
  by rewrite mulmxA block_of_error_input eqxx mul1mx addr0.
by rewrite mulmxA block_of_error_input eq_sym (negPf ji) mulr0n raddf0 mul0mx.
Qed.

(* what agent i's estimation error obeys, as printed *)
Lemma error_loop_errors k o KK H Kb Hb (Ab : 'M_k) Cb (e : 'cV_nm) z (i : 'I_m) :
  block i (usubmx (error_loop (o := o) KK H Kb Hb Ab Cb *m col_mx e z)) =
  (mcA S + KK i *m mcC S i) *m block i e + \sum_(j in N i) H i j *m (block i e - block j e)
  + \sum_j mcB S j *m F j *m (block i e - block j e) + (if i == o then Cb *m z else 0).
Proof.
rewrite mul_block_col col_mxKu mulmxDr; congr (_ + _); last first.
  rewrite /= !mulmxA block_of_error_input; case: eqP => _; first by rewrite mul1mx.
  by rewrite raddf0 !mul0mx.
rewrite /closed_loop mulmxDl mulmxDr block_error_A mulmx_suml.
rewrite (eq_bigr (fun j => error_input K n j *m
   (observer_gains KK H j *m (mcC E j *m e)))) => [|j _]; last by rewrite /= !mulmxA.
rewrite block_input /= mul_col_mx mul_row_col differences_sum mulmxDl [in RHS]mulmxDl !mulmxA.
have -> : \sum_j mcB S j *m F j *m (block i e - block j e) =
    (\sum_j mcB S j *m F j) *m block i e - \sum_j mcB S j *m F j *m block j e.
  by rewrite mulmx_suml -sumrB; apply: eq_bigr => j _; rewrite mulmxBr.
by rewrite -!addrA; congr (_ + _); rewrite addrA [RHS]addrA addrC !mulmxA.
Qed.

(* and the channel controller *)
Lemma error_loop_controller k o KK H Kb Hb (Ab : 'M_k) Cb (e : 'cV_nm) z :
  dsubmx (error_loop (o := o) KK H Kb Hb Ab Cb *m col_mx e z) =
  Ab *m z + Kb *m (mcC S o *m block o e) + \sum_(j in N o) Hb j *m (block o e - block j e).
Proof.
rewrite mul_block_col col_mxKd addrC -addrA; congr (_ + _).
by rewrite /= -!mulmxA mul_col_mx mul_row_col differences_sum -!mulmxA.
Qed.

End ErrorLoop.

Section OneChannel.
Variables (K : ringType) (n m : nat) (p q : 'I_m -> nat) (o : 'I_m).

(* a gain at one channel *)
Definition at_channel (D : 'M[K]_(p o, q o)) : gains K p q := fun i =>
  if o =P i is ReflectT e then ecast i 'M[K]_(p i, q i) e D else 0.

Lemma closed_loop_at_channel (S : multichannel K n p q) (F : gains K p q) D :
  closed_loop S (fun i => F i + at_channel D i) = closed_loop S F + mcB S o *m D *m mcC S o.
Proof.
rewrite /closed_loop -addrA; congr (_ + _).
rewrite (eq_bigr (fun i => mcB S i *m F i *m mcC S i + mcB S i *m at_channel D i *m mcC S i));
  last by move=> i _; rewrite mulmxDr mulmxDl.
rewrite big_split; congr (_ + _); rewrite (bigD1 o) //= big1 ?addr0 => [|i io]; last first.
  by rewrite /at_channel; case: eqP => [e|_]; [rewrite e eqxx in io | rewrite mulmx0 mul0mx].
by rewrite /at_channel; case: eqP => // e; rewrite eq_axiomK.
Qed.

End OneChannel.

Section Theorem1.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Hypothesis inf : infinite K.
Hypothesis sc : strongly_connected (neighbor_arc N).
Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).
Notation nm := (\sum_(i < m) n)%N.
Notation E := (error_system N S F).

(* Theorem 1: K_i, H_ij, and a controller of order m - 1 at agent o *)
Theorem theorem_1 (o : 'I_m) (P : {poly K}) : jointly_observable S ->
  P \is monic -> size P = (m * n + m.-1).+1 ->
  exists KK H (Kb : 'M_(m.-1, q o)) (Hb : 'I_m -> 'M_(m.-1, n)) (Ab : 'M_m.-1) (Cb : 'M_(n, m.-1)),
    char_poly (error_loop N S F KK H Kb Hb Ab Cb) = P.
Proof.
move=> jo mP sP; have em : m = m.-1.+1 by rewrite prednK // (leq_trans _ (ltn_ord o)).
have enm : (m * n = nm)%N by rewrite sum_nat_const card_ord.
have [G [ctr obs]] : exists G, \rank (reach (closed_loop E G) (mcB E o) m.-1.+1) = nm /\
    controllable (closed_loop E G)^T (mcC E o)^T.
  have [n0|n0] := posnP n; last first.
    have [G /(_ o)[[ctr _] obs]] := proposition_1 f inf sc n0 F jo.
    by exists G; rewrite -em.
  have nm0 : nm = 0%N by rewrite -enm n0 muln0.
  have full a (M : 'M[K]_(nm, a)) : \rank M = nm.
    by apply/eqP; rewrite eqn_leq rank_leq_row (leq_trans (eq_leq nm0)).
  by exists (fun=> 0); split; [|apply: (@controllable_blocks _ _ _ _ _ 0)]; apply: full.
rewrite enm in sP.
have [Ab [Bb [Cb [D eP]]]] := brasch_pearson_dual f inf ctr obs mP sP.
pose G' : gains K (fun=> n) (fun i => q i + nm)%N :=
  fun i => G i + @at_channel K m (fun=> n) (fun i => q i + nm)%N o D i.
exists (fun i => lsubmx (G' i)), (fun i j => submxrow (rsubmx (G' i)) j), (lsubmx Bb).
exists (fun j => submxrow (rsubmx Bb) j), Ab, Cb.
have eG : closed_loop E (observer_gains (fun i => lsubmx (G' i))
    (fun i j => submxrow (rsubmx (G' i)) j)) = closed_loop E G + mcB E o *m D *m mcC E o.
  rewrite -(closed_loop_at_channel E G D) /closed_loop; congr (_ + _); apply: eq_bigr => i _.
  by rewrite /observer_gains submxrowK hsubmxK.
by rewrite -eP /error_loop eG submxrowK hsubmxK.
Qed.

End Theorem1.

Section Symmetric.
Variables (K : fieldType) (C : numClosedFieldType) (f : {rmorphism K -> C}).
Hypothesis reals : forall x, x \is Num.real -> exists y, f y = x.

(* a list that conjugation only permutes belongs to a monic polynomial over the reals *)
Lemma symmetric_polynomial (Lambda : seq C) : perm_eq Lambda [seq x^* | x <- Lambda] ->
  exists P : {poly K}, [/\ P \is monic, size P = (size Lambda).+1 &
    map_poly f P = \prod_(x <- Lambda) ('X - x%:P)].
Proof.
move=> sym; pose Q := \prod_(x <- Lambda) ('X - x%:P).
have Qc : map_poly conjC Q = Q.
  rewrite rmorph_prod /= [RHS](perm_big _ sym) big_map; apply: eq_bigr => x _.
  by rewrite rmorphB /= map_polyX map_polyC.
have /fin_all_exists[g hg] (i : 'I_(size Q)) : exists y, f y = Q`_i.
  by apply/reals/CrealP; rewrite -[RHS](congr1 (fun R : {poly C} => R`_i) Qc) coef_map.
pose P := \poly_(i < size Q) (if insub i is Some j then g j else 0).
have fP : map_poly f P = Q.
  apply/polyP => i; rewrite coef_map coef_poly; case: ltnP => iQ; last first.
    by rewrite raddf0 nth_default.
  by rewrite insubT /= hg.
exists P; split=> //.
  by rewrite -(map_monic f) fP monic_prod_XsubC.
by rewrite -(size_map_poly f) fP size_prod_XsubC.
Qed.

(* R is infinite *)
Lemma reals_infinite : infinite K.
Proof. by apply: char0_infinite => i; rewrite -(fmorph_char f) char_num. Qed.

Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Hypothesis sc : strongly_connected (neighbor_arc N).
Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).

(* Theorem 1 as printed: real matrices, and any symmetric list of mn + m - 1 eigenvalues *)
Theorem theorem_1_symmetric (o : 'I_m) (Lambda : seq C) : jointly_observable S ->
  size Lambda = (m * n + m.-1)%N -> perm_eq Lambda [seq x^* | x <- Lambda] ->
  exists KK H (Kb : 'M_(m.-1, q o)) (Hb : 'I_m -> 'M_(m.-1, n)) (Ab : 'M_m.-1) (Cb : 'M_(n, m.-1)),
    char_poly (map_mx f (error_loop N S F KK H Kb Hb Ab Cb)) = \prod_(x <- Lambda) ('X - x%:P).
Proof.
move=> jo sL /symmetric_polynomial[P [mP sP fP]]; rewrite sL in sP.
have [KK [H [Kb [Hb [Ab [Cb e]]]]]] := theorem_1 f reals_infinite sc F o jo mP sP.
by exists KK, H, Kb, Hb, Ab, Cb; rewrite -map_char_poly e.
Qed.

End Symmetric.
