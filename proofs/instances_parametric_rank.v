(* The matrix t of one row and one column has rank 0 at t = 0, and rank 1 elsewhere; and the matrix 0, with a kernel
   whose pivot t vanishes at 0. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence parametric_rank.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Definition l6 := @Modulus 6 isT.
Notation h := ([rmorphism of (ratr : rat -> algC)]).
Definition K : 'M[{poly Zloc l6}]_1 := 'X%:M.
Notation at_t t := (map_mx (value h t) (map_mx (map_poly (@Zloc_rat l6)) K)).

Lemma inst_rank_at_most : (\rank (map_mx (horner_eval (0%R : rat)) (0%R : 'M_1)) + 1 <= 1)%N.
Proof.
apply: (@rank_at_most _ _ [rmorphism of horner_eval (0 : rat)] 1 1 0 1 'X%:M id 'X).
- by rewrite mul0mx.
- by apply/matrixP => i j; rewrite mxE.
by rewrite polyX_eq0.
Qed.

Lemma inst_rank_at_root : (\rank (at_t 0%R) + 1 <= 1)%N.
Proof.
apply: (@rank_at_root l6 _ h 1 1 K 'X 1 1%:M id).
- by move=> i j; rewrite mulmx1 !mxE !ord1 eqxx map_polyX dvdpp.
- by apply/matrixP => i j; rewrite mxE.
by rewrite map_polyX rootX.
Qed.

Lemma determinant_K : \det (map_mx polyC 1%:M *m K *m map_mx polyC (1%:M : 'M_1)) = 'X.
Proof. by rewrite map_mx1 mul1mx mulmx1 det_scalar1. Qed.

Lemma inst_rank_at_least : (1 <= \rank (at_t 1%R))%N.
Proof.
apply: (@rank_at_least l6 _ h 1 1 K ('X - 1) (-1) 1 1 1%:M 1%:M).
- by apply: monic_unit_lead; rewrite -polyC1 monicXsubC.
- by rewrite determinant_K rmorphB/= rmorph1 !map_polyX mulN1r mul1r opprB addrNK.
by rewrite rmorphB/= rmorph1 map_polyX /root hornerD hornerN hornerX hornerC subrr.
Qed.

Lemma inst_rank_kept : (1 <= \rank (at_t 1%R))%N.
Proof.
apply: (@rank_kept l6 _ h 1 1 K 1 id id 1%:M 1%:M 'X 1 1 0).
- have -> : mxsub id id K = K by apply/matrixP => i j; rewrite mxE.
  by rewrite det_scalar1 map_polyX rmorph1 mulr1.
- by rewrite /unit_lead lead_coef1 rmorph1 unitr1.
- by rewrite rmorph1 mulr1 mul0r addr0.
by rewrite map_polyX rootX oner_eq0.
Qed.
