(* Anderson and Clements (paper, Proposition 2): lambda is a fixed eigenvalue iff some P_s(lambda)
   has rank < n.  Over every field, lambda in any extension field of the field of the data; gains
   with natural-number entries already move every eigenvalue that any constant gains move. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section AndersonClements.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel L n p q) (s : {set 'I_m}) (lambda : L).

(* easy half: rank (lambda I - A_F) <= rank P_s(lambda) for all F and s *)
Theorem rank_closed_loop_le S (F : gains L p q) s lambda :
  (\rank (lambda%:M - closed_loop S F)%R <= \rank (pencil S s lambda))%N.
Proof. by rewrite rank_pencilE -perturbed_closed_loop rank_perturbed_le. Qed.

Theorem anderson_clements_easy S s lambda :
  (\rank (pencil S s lambda) < n)%N -> fixed S lambda.
Proof. by move=> h F; rewrite eigenvalue_rank; apply: leq_ltn_trans h; apply: rank_closed_loop_le. Qed.

(* hard half: some gain with natural entries reaches some P_s(lambda) *)
Theorem rank_closed_loop_max S lambda :
  exists (G : forall i, 'M[nat]_(p i, q i)) (s : {set 'I_m}),
    \rank (lambda%:M - closed_loop S (natural L G)) = \rank (pencil S s lambda).
Proof.
have [G [s e]] := max_rank_min_pencil (mcB S) (mcC S) (lambda%:M - mcA S).
by exists G, s; rewrite rank_pencilE -perturbed_closed_loop.
Qed.

Theorem anderson_clements S lambda :
  fixed S lambda <-> exists s, (\rank (pencil S s lambda) < n)%N.
Proof.
split=> [fix_l|[s]]; last exact: anderson_clements_easy.
have [G [s e]] := rank_closed_loop_max S lambda.
by exists s; rewrite -e -eigenvalue_rank.
Qed.

(* the paper's form: for the nonempty proper s when P_0 and P_m keep rank n, which joint
   controllability and observability say (controllability.v) *)
Theorem anderson_clements_proper S lambda :
  \rank (pencil S set0 lambda) = n -> \rank (pencil S setT lambda) = n ->
  fixed S lambda <->
  exists s, [/\ s != set0, s != setT & (\rank (pencil S s lambda) < n)%N].
Proof.
move=> e0 eT; split=> [/anderson_clements[s h]|[s [_ _ h]]]; last by apply/anderson_clements; exists s.
exists s; split=> //; apply: contraTneq h => ->; by rewrite ?e0 ?eT ltnn.
Qed.

Lemma rank_pencil0 S lambda :
  \rank (pencil S set0 lambda) = \rank (row_mx (lambda%:M - mcA S) (inputs S setT)).
Proof.
rewrite /pencil setC0 block_mxEv; set Z := row_mx (outputs _ _) 0.
have -> : Z = 0.
  rewrite /Z /outputs -[0 in RHS](@row_mx0 _ _ n); congr row_mx.
  rewrite -[RHS](@mxcol0 _ _ q); apply: eq_mxcol => i; by rewrite inE.
by rewrite rank_col_mx0.
Qed.

Lemma rank_pencilT S lambda :
  \rank (pencil S setT lambda) = \rank (col_mx (lambda%:M - mcA S) (outputs S setT)).
Proof.
rewrite /pencil setCT block_mxEh; set Z := col_mx (inputs _ _) 0.
have -> : Z = 0.
  rewrite /Z /inputs -[0 in RHS](@col_mx0 _ n); congr col_mx.
  rewrite -[RHS](@mxrow0 _ _ p); apply: eq_mxrow => i; by rewrite inE.
by rewrite rank_row_mx0.
Qed.

End AndersonClements.

Section Extension.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel K n p q) (lambda : L).

Lemma closed_loop_map S (F : gains K p q) :
  map_mx f (closed_loop S F) = closed_loop (map_system f S) (fun i => map_mx f (F i)).
Proof.
rewrite /closed_loop map_mxD map_mx_sum; congr (_ + _); apply: eq_bigr => i _.
by rewrite !map_mxM.
Qed.

Lemma natural_map (G : forall i, 'M[nat]_(p i, q i)) i :
  map_mx f (natural K G i) = natural L G i.
Proof. by apply/matrixP => x y; rewrite !mxE rmorph_nat. Qed.

(* gains over the small field fix no more than gains over the large one *)
Theorem anderson_clements_over S lambda :
  fixed_over f S lambda <-> exists s, (\rank (pencil (map_system f S) s lambda) < n)%N.
Proof.
split=> [fix_l|/anderson_clements fix_l F]; last by rewrite closed_loop_map; apply: fix_l.
have [G [s e]] := rank_closed_loop_max (map_system f S) lambda.
exists s; rewrite -e -eigenvalue_rank.
have <- : map_mx f (closed_loop S (natural K G)) = closed_loop (map_system f S) (natural L G).
  rewrite closed_loop_map /closed_loop; congr (_ + _); apply: eq_bigr => i _.
  by rewrite natural_map.
exact: fix_l.
Qed.

Theorem fixed_over_fixed S lambda : fixed_over f S lambda <-> fixed (map_system f S) lambda.
Proof. by rewrite anderson_clements_over anderson_clements. Qed.

End Extension.
