(* checker/structure.py: kind `exceptional_gains` (Lemma 3).

   K(g) = [B, (M + gA) B, ..., (M + gA)^(blocks - 1) B] is a polynomial matrix in g with n rows; the
   statements hold for every polynomial matrix. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Exceptional.
Variables (l : modulus) (L : fieldType) (h : {rmorphism rat -> L}) (n c : nat).
Variable (K : 'M[{poly Zloc l}]_(n, c)).
Notation KQ := (map_mx (map_poly (@Zloc_rat l)) K).

(* At a root of a factor the rank is lost: one row, with an entry 1, annihilates K modulo f. *)
Theorem exceptional_lost (f : {poly rat}) (w : 'rV[{poly rat}]_n) (pivot : 'I_n) g :
  zero_modulo f (w *m KQ) -> w 0 pivot = 1 -> root (map_poly h f) g ->
  (\rank (map_mx (value h g) KQ) < n)%N.
Proof.
move=> z w1 rg; have := value_zero rg z; rewrite map_mxM => /mulmx0_rank_max; apply: leq_trans.
rewrite -[X in (X < _)%N]add0n ltn_add2r lt0n mxrank_eq0; apply/eqP => /matrixP/(_ 0 pivot)/eqP.
by rewrite !mxE w1 rmorph1 oner_eq0.
Qed.

(* Elsewhere it is not: two compressions, with Q the quotient of the first by the factors. *)
Theorem exceptional_kept (R R' : 'M[Zloc l]_(c, n)) (f : {poly rat}) (Q : {poly Zloc l}) e u v g :
  map_poly (@Zloc_rat l) (\det (K *m map_mx polyC R)) = f ^+ e * map_poly (@Zloc_rat l) Q ->
  unit_lead Q ->
  u * map_poly (@residue l) Q + v * map_poly (@residue l) (\det (K *m map_mx polyC R')) = 1 ->
  ~~ root (map_poly h f) g -> \rank (map_mx (value h g) KQ) = n.
Proof.
move=> eD uQ b nf.
have full (X : 'M[Zloc l]_(c, n)) :
    ~~ root (map_poly (into h) (\det (K *m map_mx polyC X))) g -> \rank (map_mx (value h g) KQ) = n.
  pose ev : {rmorphism {poly Zloc l} -> L} := [rmorphism of horner_eval g \o map_poly (into h)].
  rewrite /root -[_.[_]]/(ev _) -det_map_mx -unitfE -unitmxE -row_full_unit => /eqP r.
  apply/eqP; rewrite eqn_leq rank_leq_row -{1}r map_mxM.
  have -> : map_mx ev K = map_mx (value h g) KQ.
    by apply/matrixP=> i j; rewrite !mxE /value/= map_poly_into.
  exact: mxrankM_maxl.
have [rQ|nQ] := boolP (root (map_poly (into h) Q) g).
  exact: full (no_common_root uQ b rQ).
apply: (full R); rewrite map_poly_into eD rmorphM/= rootM negb_or -map_poly_into nQ andbT.
by rewrite rmorphX /root horner_exp expf_eq0 negb_and nf orbT.
Qed.
End Exceptional.
