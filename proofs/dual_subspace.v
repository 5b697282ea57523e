(* checker/core/evidence.py, _loss: a shrunk subspace of the dual system (A', C_i', B_i') for the complement s of T proves
   the same loss of rank as one of the system for T.

   With W the transpose of its columns, modulo p: W (xI - A) = Z C_s, W B_i = 0 for i in T, and some columns of W are
   an identity.  U is a base of the null space of C_s, or of what stands for it, so that W (xI - A) U = 0 and
   C_i U = 0 for i in s.  Whatever W maps to 0 modulo p is in the image of Y, with a column for every other state. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence blocks local_subspace.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Annihilated.
Variables (K : fieldType) (n u : nat) (P : {poly K}) (W : 'M[{poly K}]_(u, n)) (piv : 'I_u -> 'I_n).
Hypothesis identity : zero_modulo P (colsub piv W - 1%:M).
Let others := ~: [set piv k | k : 'I_u].
Let E : 'M[{poly K}]_(n, u) := colsub piv 1%:M.
Let Y : 'M[{poly K}]_(n, #|others|) := columns [comRingType of {poly K}] others - E *m (W *m columns _ others).

Lemma pivots_apart : ~~ (P %| 1) -> injective piv.
Proof.
move=> nP i j e; apply/eqP; apply: contraNT nP => ij.
have := identity i i; have := identity i j; rewrite !mxE -e eqxx (negPf ij) subr0 => z z1.
by rewrite -(subKr (W i (piv i)) 1) dvdp_sub.
Qed.

Lemma others_count : ~~ (P %| 1) -> (#|others| + u)%N = n.
Proof.
move=> /pivots_apart inj; have := cardsC [set piv k | k : 'I_u].
by rewrite card_imset// card_ord addnC => ->; rewrite card_ord.
Qed.

Lemma annihilated c (X : 'M_(n, c)) : zero_modulo P (W *m X) -> ~~ (P %| 1) ->
  zero_modulo P (X - Y *m rowsub enum_val X).
Proof.
move=> z nP; have inj := pivots_apart nP.
have split : X = columns _ others *m rowsub enum_val X + E *m rowsub piv X.
  apply/matrixP => a j; rewrite mxE columnsE !mxE; case: ifPn => [|]; rewrite !inE ?negbK.
    move=> aP; rewrite big1 ?addr0// => k _; rewrite !mxE; case: eqP => [e|_]; last by rewrite mul0r.
    by case/negP: aP; rewrite e imset_f.
  case/imsetP=> k _ ->; rewrite add0r (bigD1 k)//= !mxE eqxx mul1r big1 ?addr0// => l lk.
  by rewrite !mxE (inj_eq inj) eq_sym (negPf lk) mul0r.
have WE : W *m E = colsub piv W.
  by rewrite /E mulmx_colsub mulmx1.
have rest : columns _ others *m rowsub enum_val X = X - E *m rowsub piv X by rewrite {2}split addrK.
have -> : X - Y *m rowsub enum_val X = E *m (W *m X) - E *m ((colsub piv W - 1%:M) *m rowsub piv X).
  rewrite /Y mulmxBl -!mulmxA rest -WE mulmxBl mul1mx !mulmxBr -!mulmxA !opprB addrCA.
  by rewrite [X + _]addrC subrK -addrA [- _ + _]addrC.
by apply: zero_moduloD; [|apply: zero_moduloN]; apply: zero_modulo_mull => //; apply: zero_modulo_mulr.
Qed.
End Annihilated.

Section Dual.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Variables (P : {poly K}) (T : {set 'I_m}) (d : nat).
Notation constant M := (map_mx polyC M).

Theorem dual_subspace_loss : shrunk_subspace (dual S) P (~: T) d -> rank_loss S P T d.
Proof.
move=> E; have [P1|nP] := boolP (P %| 1).
  have z a b (M : 'M[{poly K}]_(a, b)) : zero_modulo P M by move=> i j; apply: dvdp_trans P1 (dvd1p _).
  apply: (@RankLoss _ _ _ _ _ S P T d (sh_r E) (sh_u E) 0 0 0 (@sh_pivots _ _ _ _ _ _ _ _ _ E)) => // [i _|].
    by exists 0.
  exact: sh_count.
pose W := (sh_U E)^T; pose piv := @sh_pivots _ _ _ _ _ _ _ _ _ E.
have id : zero_modulo P (colsub piv W - 1%:M).
  by rewrite -trmx1 -trmx_mxsub -linearB; apply/zero_modulo_tr/(@sh_identity _ _ _ _ _ _ _ _ _ E).
have := others_count id nP; set others := ~: _ => count.
pose N := row_base (kermx (sh_Y E)); have NY : N *m sh_Y E = 0.
  by apply/eqP; rewrite -sub_kermx eq_row_base.
have full : row_full N^T by rewrite /row_full mxrank_tr eq_row_base.
pose f := fullrankfun full; pose M := rowsub f N^T.
have uM : M \in unitmx by apply: fullrowsub_unit.
pose U := N^T *m invmx M.
have YU : (sh_Y E)^T *m U = 0 by rewrite mulmxA -trmx_mul NY trmx0 mul0mx.
apply: (@RankLoss _ _ _ _ _ S P T d #|others| _ _ (constant U) (rowsub enum_val (('X%:M - constant (mcA S)) *m constant U)) f).
- move=> i iT; exists (rowsub enum_val (constant (mcB S i))); apply: annihilated => //.
  have iT' : i \notin ~: T by rewrite inE negbK.
  have := @sh_output _ _ _ _ _ _ _ _ _ E i iT' => /= /zero_modulo_tr.
  by rewrite trmx_mul map_trmx trmxK.
- apply: annihilated => //.
  have := zero_modulo_mulr (constant U) (zero_modulo_tr (@sh_state _ _ _ _ _ _ _ _ _ E)).
  rewrite linearB /= !trmx_mul linearB /= tr_scalar_mx map_trmx trmxK mulmxBl -!mulmxA.
  by rewrite map_trmx -map_mxM YU map_mx0 mulmx0 subr0.
- move=> i iT; have iT' : i \in ~: T by rewrite inE.
  have /inputs_within/(_ i iT')[X /= e] := sh_inputs E.
  by rewrite -map_mxM -[mcC S i]trmxK e trmx_mul -mulmxA YU mulmx0 map_mx0; apply: zero_modulo0.
- have -> : rowsub f (constant U) = 1%:M; last by rewrite subrr; apply: zero_modulo0.
  by rewrite -map_mxsub -mul_rowsub_mx mulmxV// map_mx1.
rewrite mxrank_ker -(leq_add2r (sh_u E)) addnAC count -{1}(subnK (rank_leq_row (sh_Y E))) -addnA leq_add2l.
by rewrite (leq_trans _ (sh_count E))// leq_add2r rank_leq_col.
Qed.
End Dual.

Section Equal.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S S' : multichannel K n p q).
Hypotheses (eA : mcA S = mcA S') (eB : forall i, mcB S i = mcB S' i) (eC : forall i, mcC S i = mcC S' i).

Lemma shrunk_subspace_equal P T d : shrunk_subspace S P T d -> shrunk_subspace S' P T d.
Proof.
move=> E; apply: (@ShrunkSubspace _ _ _ _ _ S' P T d _ _ (sh_Y E) (sh_U E) (sh_V E) (@sh_pivots _ _ _ _ _ _ _ _ _ E)).
- by apply/inputs_within => i iT; have /inputs_within/(_ i iT) := sh_inputs E; rewrite eB.
- by rewrite -eA; apply: (@sh_state _ _ _ _ _ _ _ _ _ E).
- by move=> i iT; rewrite -eC; apply: (@sh_output _ _ _ _ _ _ _ _ _ E).
- exact: (@sh_identity _ _ _ _ _ _ _ _ _ E).
exact: (sh_count E).
Qed.
End Equal.

(* The same in place of a shrunk subspace of some states Z: in the dual system, the states outside Z and D are those
   that drive others alone. *)
Section Local.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Variables (P : {poly K}) (T : {set 'I_m}) (d : nat) (Z D : {set 'I_n}).
Hypothesis apart : forall a, a \in D -> a \notin Z.
Hypothesis closed : forall a b, a \notin D -> b \in D -> mcA S a b = 0.
Hypothesis driven : forall a b, a \notin Z -> a \notin D -> b \in Z -> mcA S a b = 0.
Hypothesis acting : forall i a u, i \in T -> a \notin Z -> a \notin D -> mcB S i a u = 0.
Hypothesis unseen : forall i v b, i \notin T -> b \in D -> mcC S i v b = 0.
Variables (m' : nat) (f : 'I_m' -> 'I_m) (T' : {set 'I_m'}).
Hypothesis idle : forall i, i \in T -> (forall a u, a \in Z -> mcB S i a u = 0) \/ exists2 j, j \in T' & f j = i.
Hypothesis blind : forall i, i \notin T -> (forall v b, b \in Z -> mcC S i v b = 0) \/ exists2 j, j \notin T' & f j = i.

Theorem dual_subspace_local : shrunk_subspace (dual (some_channels (restrict S Z) f)) P (~: T') d -> rank_loss S P T d.
Proof.
move=> E; apply: dual_subspace_loss; pose R := ~: (Z :|: D).
have inR a : (a \in R) = (a \notin Z) && (a \notin D) by rewrite !inE negb_or.
have inD a : a \notin Z -> a \notin R -> a \in D by move=> aZ; rewrite inR aZ negbK.
apply: (@shrunk_subspace_local _ _ _ _ _ (dual S) P (~: T) d Z R _ _ _ _ _ m' f (~: T')).
- by move=> a; rewrite inR => /andP[].
- move=> a b aR; rewrite inR mxE => /andP[bZ bD].
  have [aZ|aZ] := boolP (a \in Z); [exact: driven|exact/closed/inD].
- move=> a b aZ aR bZ; rewrite mxE; apply: closed (inD _ aZ aR).
  by apply: contraL bZ; apply: apart.
- by move=> i a u; rewrite inE mxE => iT aZ aR; apply: unseen iT (inD _ aZ aR).
- by move=> i v b; rewrite inE negbK inR mxE => iT /andP[bZ bD]; apply: acting.
- move=> i; rewrite inE => iT; case: (blind iT) => [z|[j jT e]]; last by right; exists j; rewrite ?inE.
  by left=> a u aZ; rewrite mxE z.
- move=> i; rewrite inE negbK => iT; case: (idle iT) => [z|[j jT e]]; last by right; exists j; rewrite ?inE ?negbK.
  by left=> v b bZ; rewrite mxE z.
by apply: shrunk_subspace_equal E => [|i|i] /=; rewrite trmx_mxsub.
Qed.
End Local.
