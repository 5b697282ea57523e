(* The matrix t of one row and one column has rank 0 at t = 0, and rank 1 elsewhere; and the matrix 0, with a kernel
   whose pivot t vanishes at 0. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence parametric_rank resultant_degree.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
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

(* The resultant in x of x - t and of t, which is t up to sign: the root t of the first has the degree 1, and so has the
   second there. *)
Definition t_ : {poly rat} := 'X.
Lemma inst_resultant_degree : ((size (resultant ('X - t_%:P) t_%:P)).-1 <= 1)%N.
Proof.
have st : size t_ = 2%N by rewrite size_polyX.
have nz : resultant ('X - t_%:P) t_%:P != 0.
  have t0 : t_%:P != 0 by rewrite polyC_eq0 polyX_eq0.
  by rewrite resultant_eq0 -leqNgt (leq_trans (dvdp_leq t0 (dvdp_gcdr _ _))) // size_polyC_leq1.
rewrite -(ler_nat [numDomainType of rat]); apply: le_trans (resultant_degree (a := fun=> 1) (M := fun=> 1) _ _ _ _ nz) _.
- by rewrite size_XsubC.
- by [].
- rewrite size_XsubC => -[|[|k]] //= _ _; rewrite coefB coefX coefC /= ?sub0r ?subr0 ?size_opp ?st ?size_poly1 /upto.
    by rewrite big_ord_recl big_ord0.
  by rewrite subnn big_ord0.
- move=> r [|k] _; rewrite coefC /= ?eqxx // => _.
  by rewrite st mul0r addr0.
by rewrite size_XsubC big_ord_recl big_ord0.
Qed.
