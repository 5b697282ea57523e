(* checker/parameters.py: kind `parametric_rank`.

   M is a matrix of polynomials in the parameter.  The statements are about its rank at a value of the parameter in
   a field that contains the rational numbers. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence determinantal_divisors.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* A kernel over the functions bounds the rank at every value, also where its pivots vanish. *)
Section Domain.
Variables (D : idomainType) (L : fieldType) (f : {rmorphism D -> L}) (a b : nat) (M : 'M[D]_(a, b)).
Notation F := [rmorphism of @FracField.tofrac D].

Lemma rank_specialized : (\rank (map_mx f M) <= \rank (map_mx F M))%N.
Proof.
rewrite leqNgt; apply/negP => less; apply: (rank_minor less) => i j.
rewrite /minor -map_mxsub det_map_mx; suff -> : \det (mxsub i j M) = 0 by rewrite rmorph0.
apply/eqP; rewrite -tofrac_eq0 -[FracField.tofrac _]/(F _) -det_map_mx map_mxsub.
apply: contraT => nz; have := @minor_rank _ _ _ (map_mx F M) _ i j nz.
by rewrite ltnn.
Qed.

Theorem rank_at_most u (N : 'M[D]_(b, u)) (pivots : 'I_u -> 'I_b) (c : D) :
  M *m N = 0 -> rowsub pivots N = c%:M -> c != 0 -> (\rank (map_mx f M) + u <= b)%N.
Proof.
move=> z eN c0; apply: (@leq_trans (\rank (map_mx F M) + u)); first by rewrite leq_add2r rank_specialized.
have rN : \rank (map_mx F N) = u.
  apply/eqP; rewrite eqn_leq rank_leq_col /=.
  have e : rowsub pivots (map_mx F N) = F c *: 1%:M.
    by rewrite -map_mxsub eN map_scalar_mx scalemx1.
  have r : \rank (rowsub pivots (map_mx F N)) = u.
    by rewrite e mxrank_scale_nz ?mxrank1// tofrac_eq0.
  by rewrite -[X in (X <= _)%N]r; apply/mxrankS/rowsub_sub.
by rewrite -{1}rN; apply: mulmx0_rank_max; rewrite -map_mxM z map_mx0.
Qed.
End Domain.

Section Values.
Variables (l : modulus) (L : fieldType) (h : {rmorphism rat -> L}) (a b : nat).
Variable (M : 'M[{poly Zloc l}]_(a, b)).
Notation MQ := (map_mx (map_poly (@Zloc_rat l)) M).

(* A kernel modulo q bounds the rank at every root of q. *)
Theorem rank_at_root (q : {poly rat}) u (N : 'M[{poly rat}]_(b, u)) (pivots : 'I_u -> 'I_b) t :
  zero_modulo q (MQ *m N) -> rowsub pivots N = 1%:M -> root (map_poly h q) t ->
  (\rank (map_mx (value h t) MQ) + u <= b)%N.
Proof.
move=> z eN rt; have := value_zero rt z; rewrite map_mxM => /mulmx0_rank_max.
suff -> : \rank (map_mx (value h t) N) = u by [].
apply/eqP; rewrite eqn_leq rank_leq_col /=.
rewrite -[X in (X <= _)%N](mxrank1 L u) -(map_mx1 [rmorphism of value h t]) -eN map_mxsub.
by apply/mxrankS/rowsub_sub.
Qed.

(* X M Y has a determinant that does not vanish there. *)
Lemma rank_compressed r (X : 'M[Zloc l]_(r, a)) (Y : 'M[Zloc l]_(b, r)) t :
  ~~ root (map_poly (into h) (\det (map_mx polyC X *m M *m map_mx polyC Y))) t ->
  (r <= \rank (map_mx (value h t) MQ))%N.
Proof.
pose ev : {rmorphism {poly Zloc l} -> L} := [rmorphism of horner_eval t \o map_poly (into h)].
rewrite /root -[_.[_]]/(ev _) -det_map_mx -unitfE -unitmxE -row_full_unit !map_mxM => /eqP e.
have -> : map_mx (value h t) MQ = map_mx ev M.
  by apply/matrixP=> i j; rewrite !mxE /value/= map_poly_into.
by rewrite -{1}e (leq_trans (mxrankM_maxl _ _))// mxrankM_maxr.
Qed.

(* At the roots of q it is no less than the order of a minor of X M Y that is coprime to q modulo l. *)
Theorem rank_at_least (q : {poly Zloc l}) u v r (X : 'M[Zloc l]_(r, a)) (Y : 'M[Zloc l]_(b, r)) t :
  unit_lead q ->
  u * map_poly (@residue l) q
    + v * map_poly (@residue l) (\det (map_mx polyC X *m M *m map_mx polyC Y)) = 1 ->
  root (map_poly (into h) q) t -> (r <= \rank (map_mx (value h t) MQ))%N.
Proof. by move=> uq e rt; apply: (rank_compressed (no_common_root uq e rt)). Qed.

(* Elsewhere it is r: a minor, divided by the values as often as they go, is Q, and Q is coprime to det(X M Y). *)
Theorem rank_kept r (i : 'I_r -> 'I_a) (j : 'I_r -> 'I_b) (X : 'M[Zloc l]_(r, a))
    (Y : 'M[Zloc l]_(b, r)) (f : {poly rat}) (Q : {poly Zloc l}) u v t :
  map_poly (@Zloc_rat l) (\det (mxsub i j M)) = f * map_poly (@Zloc_rat l) Q -> unit_lead Q ->
  u * map_poly (@residue l) Q
    + v * map_poly (@residue l) (\det (map_mx polyC X *m M *m map_mx polyC Y)) = 1 ->
  ~~ root (map_poly h f) t -> (r <= \rank (map_mx (value h t) MQ))%N.
Proof.
move=> eD uQ e nf; have [rQ|nQ] := boolP (root (map_poly (into h) Q) t).
  exact: rank_compressed (no_common_root uQ e rQ).
apply: (@minor_rank _ _ _ _ _ i j); rewrite /minor -map_mxsub det_map_mx.
have -> : \det (mxsub i j MQ) = map_poly (@Zloc_rat l) (\det (mxsub i j M)).
  by rewrite -det_map_mx map_mxsub.
rewrite eD; suff : ~~ root (map_poly h (f * map_poly (@Zloc_rat l) Q)) t by [].
by rewrite rmorphM/= rootM negb_or nf -map_poly_into.
Qed.
End Values.
