(* Four states and three channels, x2' = x0 and x3' = x2: each channel drives one of x1, x3 and x0 and measures it.
   The states x1 and x2 drive x3 alone, no channel reaches x2 but by x0, and the mode 0 is fixed. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence blocks local_subspace dual_subspace.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Notation one3 := (fun _ : 'I_3 => 1%N).
Definition x0 := @Ordinal 4 0 isT.
Definition x1 := @Ordinal 4 1 isT.
Definition x2 := @Ordinal 4 2 isT.
Definition x3 := @Ordinal 4 3 isT.
Definition own (i : 'I_3) : 'I_4 := nth x0 [:: x1; x3] i.
Definition plant : multichannel rat 4 one3 one3 :=
  Multichannel (delta_mx x2 x0 + delta_mx x3 x2) (fun i => delta_mx (own i) 0) (fun i => delta_mx 0 (own i)).
Definition Z := [set x1; x2].
Definition D := [set x3].
Definition T := [set i : 'I_3 | (i < 2)%N].
Definition first (_ : 'I_1) : 'I_3 := ord0.

Lemma state_entry a b : mcA plant a b = ((a == x2) && (b == x0))%:R + ((a == x3) && (b == x2))%:R.
Proof. by rewrite !mxE. Qed.

Lemma apart a : a \in D -> a \notin Z.
Proof. by rewrite !inE => /eqP->. Qed.
Lemma closed a b : a \notin D -> b \in D -> mcA plant a b = 0.
Proof. by rewrite state_entry !inE => aD /eqP->; rewrite !andbF. Qed.
Lemma driven a b : a \notin Z -> a \notin D -> b \in Z -> mcA plant a b = 0.
Proof.
rewrite state_entry !inE negb_or => /andP[_ /negPf->] /negPf-> _.
by rewrite addr0.
Qed.
Lemma acting i a u : i \in T -> a \notin Z -> a \notin D -> mcB plant i a u = 0.
Proof.
rewrite !inE mxE negb_or => iT /andP[/negPf a1 _] /negPf a3.
by case: i iT => -[|[|]]//= ? _; rewrite /own /= ?a1 ?a3.
Qed.
Lemma unseen i v b : i \notin T -> b \in D -> mcC plant i v b = 0.
Proof.
rewrite !inE mxE => iT /eqP->.
by case: i iT => -[|[|[|]]]//= ? _; rewrite /own /= andbF.
Qed.
Lemma idle i : i \in T -> (forall a u, a \in Z -> mcB plant i a u = 0) \/ exists2 j, j \in [set: 'I_1] & first j = i.
Proof.
rewrite inE; case: i => -[|[|]]//= i3 _; first by right; exists ord0; [rewrite inE | apply: val_inj].
by left=> a u; rewrite !inE mxE => /orP[]/eqP->.
Qed.
Lemma blind i : i \notin T -> (forall v b, b \in Z -> mcC plant i v b = 0) \/ exists2 j, j \notin [set: 'I_1] & first j = i.
Proof.
rewrite inE; case: i => -[|[|[|]]]//= i3 _.
by left=> v b; rewrite !inE mxE => /orP[]/eqP->; rewrite andbF.
Qed.

(* x1 and x2 by themselves, with the first channel: both columns of the identity, and one input. *)
Definition part := some_channels (restrict plant Z) first.
Lemma part_state : mcA part = 0.
Proof.
apply/matrixP=> i k; have := enum_valP i; have := enum_valP k; rewrite !mxE !inE.
by move=> /orP[]/eqP-> /orP[]/eqP->; rewrite addr0.
Qed.
Lemma part_shrunk : shrunk_subspace part 'X [set: 'I_1] 1.
Proof.
apply: (@shrunk_by_inputs _ _ _ _ _ _ _ _ _ #|Z| 1%:M 0 id).
- rewrite part_state map_mx0 subr0 mulmx1 mulmx0 subr0 => i j; rewrite mxE.
  by case: eqP => _; rewrite ?dvdp0// dvdpp.
- by move=> i; rewrite inE.
- by move=> i j; rewrite !mxE subrr dvdp0.
have two : (1 < #|Z|)%N by rewrite cards2.
by rewrite addn1 (leq_trans _ two)// ltnS (leq_trans (rank_leq_col _))// big_ord1.
Qed.

Definition inst_shrunk_channels : shrunk_subspace (restrict plant Z) 'X T 1.
Proof.
apply: (shrunk_subspace_channels _ _ part_shrunk) => i.
  by case/idle=> [z|]; [left; apply/matrixP => a u; rewrite [LHS]mxE z ?enum_valP// mxE | right].
by case/blind=> [z|]; [left; apply/matrixP => v b; rewrite [LHS]mxE z ?enum_valP// mxE | right].
Defined.
Definition inst_shrunk_within := shrunk_subspace_within apart closed driven acting unseen inst_shrunk_channels.
Definition inst_shrunk_local : shrunk_subspace plant 'X T 1 :=
  shrunk_subspace_local apart closed driven acting unseen idle blind part_shrunk.

(* The same by one row of the identity, which the channel does not drive. *)
Definition row2 : 'M[{poly rat}]_(#|Z|, 1) := \matrix_(a, _) (enum_val a == x2)%:R.
Definition in_Z : x2 \in Z. Proof. by rewrite !inE. Qed.
Lemma part_dual : shrunk_subspace (dual part) 'X (~: [set: 'I_1]) 1.
Proof.
apply: (@shrunk_by_inputs _ _ _ _ _ _ _ _ _ 1 row2 0 (fun=> enum_rank_in in_Z x2)).
- have -> : mcA (dual part) = 0 by rewrite -[LHS]/((mcA part)^T) part_state trmx0.
  rewrite mulmx0 subr0 map_mx0 subr0 => i j.
  by rewrite mul_scalar_mx mxE dvdp_mulIl.
- move=> i _; rewrite (_ : map_mx polyC _ *m row2 = 0); first exact: zero_modulo0.
  apply/matrixP=> v j; rewrite !mxE big1// => a _; rewrite !mxE.
  by case: eqP => [->|_]; rewrite ?mulr0// /own /= polyC0 mul0r.
- by move=> i j; rewrite !mxE enum_rankK_in ?in_Z// eqxx !ord1 eqxx subrr dvdp0.
by rewrite (_ : inputs _ _ = 0) ?mxrank0//; apply/mxrowP => i; rewrite mxrowK submxrow0 inE inE.
Qed.
Definition inst_dual_loss : rank_loss part 'X [set: 'I_1] 1 := dual_subspace_loss part_dual.
Definition inst_dual_local : rank_loss plant 'X T 1 :=
  dual_subspace_local apart closed driven acting unseen idle blind part_dual.

(* What follows from it: the mode is fixed, with its multiplicity. *)
Notation h := ([rmorphism of (ratr : rat -> algC)]).
Lemma root0 : root (map_poly h 'X) 0. Proof. by rewrite map_polyX rootX. Qed.
Lemma inst_local_fixed : fixed (map_system h plant) 0.
Proof. exact: (shrunk_subspace_fixed inst_shrunk_local root0 isT). Qed.
