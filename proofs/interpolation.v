(* checker/structure.py: the determinant of a polynomial matrix, through its values at 0, 1, ... *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Values.
Variables (F : numFieldType) (n d : nat) (M : 'M[{poly F}]_n) (q : {poly F}).
Hypotheses (low : forall i j, (size (M i j) <= d.+1)%N) (small : (size q <= (n * d).+1)%N).

Lemma size_det : (size (\det M) <= (n * d).+1)%N.
Proof.
rewrite /determinant; apply: (leq_trans (size_sum _ _ _)); apply/bigmax_leqP => s _.
have -> : (-1) ^+ s = ((-1) ^+ s)%:P :> {poly F} by rewrite rmorphX rmorphN1.
rewrite mul_polyC; apply: (leq_trans (size_scale_leq _ _)).
apply: (leq_trans (size_prod_leq _ _)); rewrite card_ord leq_subLR addnS ltnS.
apply: (@leq_trans (\sum_(i < n) d.+1)); first by apply: leq_sum => i _; apply: low.
by rewrite sum_nat_const card_ord mulnS leqnn.
Qed.

(* Values at n d + 1 points determine it. *)
Theorem determinant_by_values :
  (forall g, (g < (n * d).+1)%N -> q.[g%:R] = \det (map_mx (horner_eval (g%:R : F)) M)) -> \det M = q.
Proof.
move=> e; apply/eqP; rewrite -subr_eq0; apply/eqP.
apply: (@roots_geq_poly_eq0 _ _ [seq g%:R | g <- iota 0 (n * d).+1]).
- apply/allP => x /mapP[g]; rewrite mem_iota => gn ->{x}.
  by rewrite /root hornerD hornerN e// det_map_mx subrr.
- rewrite map_inj_uniq ?iota_uniq// => a b /eqP.
  by rewrite eqr_nat => /eqP.
rewrite size_map size_iota (leq_trans (size_add _ _))// geq_max size_opp small size_det//.
Qed.
End Values.
