(* checker/structure.py: the matrix K, block diagonal with the companions of the invariant
   polynomials (ones below the diagonal, -f in the last column): xI - K is equivalent to the diagonal
   matrix of ones and these polynomials. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import determinantal_divisors.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Companions.
Variable L : fieldType.
Notation P := {poly L}.
Implicit Types (f : P) (fs : seq P).

(* xI - the companion of f is equivalent to diag(f, 1, ..., 1) *)
Lemma companion_equivalent f k : f \is monic -> (size f).-1 = k.+1 ->
  equivalent (char_poly_mx (companionmx f)^T) (diagonal (f :: nseq k 1)).
Proof.
move=> mf sf; have s2 : size f = k.+2 by rewrite -sf prednK// size_poly_gt0 monic_neq0.
have := companionmxK mf; have CE i j := mxE matrix_key (fun i j : 'I_(size f).-1 =>
  if i == (size f).-1.-1 :> nat then - f`_j else (i.+1 == j :> nat)%:R) i j.
rewrite -/(companionmx f) in CE; move: (companionmx f) CE; rewrite {}sf /= => C CE dC.
pose M := char_poly_mx C^T; have dM : \det M = f.
  by rewrite -dC /M -[RHS]det_tr; congr (\det _); apply/matrixP=> i j; rewrite !mxE eq_sym.
pose w : 'rV[P]_k.+1 := \row_i 'X^i.
have wM j : (w *m M) 0 j = f *+ (j == ord_max).
  have -> : (w *m M) 0 j = 'X^j.+1 - \sum_(i < k.+1) (C j i)%:P * 'X^i.
    rewrite mxE; under eq_bigr => i _ do rewrite !mxE mulrBr [X in _ - X]mulrC.
    rewrite sumrB; congr (_ - _); rewrite (bigD1 j)//= eqxx mulr1n big1 ?addr0 ?exprSr// => i ij.
    by rewrite (negPf ij) mulr0n mulr0.
  have [-> | jk] := eqVneq j ord_max.
    rewrite -sumrN mulr1n -[in RHS](coefK f) poly_def s2 [RHS]big_ord_recr addrC /=.
    congr (_ + _); last by rewrite -[k.+1]/(k.+2.-1) -s2 -lead_coefE (monicP mf) scale1r.
    by apply: eq_bigr => i _; rewrite CE /= eqxx polyCN mulNr opprK mul_polyC.
  have jk' : (j < k)%N by rewrite ltn_neqAle -ltnS ltn_ord andbT.
  rewrite (bigD1 (Ordinal (jk' : j.+1 < k.+1)%N))//= CE (ltn_eqF jk') eqxx mul1r big1 ?addr0 ?subrr// => i.
  by rewrite -val_eqE /= CE (ltn_eqF jk') eq_sym => /negPf ->; rewrite mul0r.
pose U : 'M[P]_(1 + k) := col_mx w (- rowsub (lift ord0) 1%:M).
pose rot (j : 'I_(1 + k)) : 'I_k.+1 := if split j is inr j' then widen_ord (leqnSn k) j' else ord_max.
pose V : 'M[P]_(1 + k) := colsub rot 1%:M; pose Q : 'M[P]_(1 + k) := U *m M *m V.
have QE i j : Q i j = (U *m M) i (rot j) by rewrite /Q mulmx_colsub mulmx1 mxE.
have ul : ulsubmx Q = f%:M.
  apply/matrixP=> i j; do 2!rewrite [LHS]mxE; rewrite QE mul_col_mx col_mxEu !ord1 wM /rot.
  by rewrite (unsplitK (inl _)) eqxx mxE.
have ur : ursubmx Q = 0.
  apply/matrixP=> i j; do 2!rewrite [LHS]mxE; rewrite QE mul_col_mx col_mxEu !ord1 wM /rot.
  by rewrite (unsplitK (inr _)) -val_eqE /= ltn_eqF// mxE.
have Td : \det (drsubmx Q) = 1.
  have TE i j : (drsubmx Q) i j = (i == j)%:R - 'X *+ (i.+1 == j :> nat).
    do 2!rewrite [LHS]mxE; rewrite QE mul_col_mx col_mxEd /rot (unsplitK (inr _)) mulNmx mxE.
    rewrite mul_rowsub_mx mul1mx !mxE.
    rewrite CE /= ltn_eqF// opprB -!val_eqE /= /bump add1n eqSS [j == i :> nat]eq_sym rmorph_nat.
    by [].
  rewrite -det_tr det_trig => [|].
    by apply: big1 => i _; rewrite mxE TE eqxx gtn_eqF// subr0.
  apply/is_trig_mxP=> i j ij; rewrite mxE TE -val_eqE /= gtn_eqF// gtn_eqF ?subr0//.
  exact: ltn_trans ij _.
have Tu : drsubmx Q \in unitmx by rewrite unitmxE Td unitr1.
have eQ : Q = block_mx f%:M 0 (dlsubmx Q) (drsubmx Q) by rewrite -ul -ur submxK.
have UV : \det U * \det V = 1.
  have : \det Q = f by rewrite eQ det_lblock Td mulr1 det_scalar1.
  rewrite /Q !det_mulmx dM mulrAC => e; apply: (mulIf (monic_neq0 mf)); by rewrite e mul1r.
have [uU uV] : U \in unitmx /\ V \in unitmx.
  by apply/andP; rewrite !unitmxE -unitrM UV unitr1.
have e1 : equivalent M Q.
  split; last by exists U, V.
  by exists (invmx U), (invmx V); rewrite /Q !mulmxA mulVmx// mul1mx mulmxK.
have e2 : equivalent Q (dsum (f%:M : 'M_1) (1%:M : 'M_k)).
  set T := drsubmx Q in Tu eQ; rewrite eQ; split.
    exists 1%:M, (block_mx 1%:M 0 (dlsubmx Q) T).
    by rewrite mul1mx mulmx_block !(mulmx0, mul0mx, mulmx1, mul1mx, addr0, add0r).
  exists 1%:M, (block_mx 1%:M 0 (- (invmx T *m dlsubmx Q)) (invmx T)).
  rewrite mul1mx mulmx_block !(mulmx0, mul0mx, mulmx1, mul1mx, addr0, add0r) mulmxN mulmxA.
  by rewrite mulmxV// mul1mx subrr.
apply: equivalent_trans e1 (equivalent_trans e2 _).
apply: equivalent_trans (equivalent_dsum (diagonal_one f) (diagonal_ones _ k)) _.
exact: diagonal_cat.
Qed.

(* the block diagonal matrix K of the checker *)
Fixpoint degrees fs : nat := if fs is f :: fs' then (size f).-1 + degrees fs' else 0.
Fixpoint companions fs : 'M[L]_(degrees fs) :=
  if fs is f :: fs' then block_mx (companionmx f)^T 0 0 (companions fs') else 0.

Definition nonconstant f := (f \is monic) && (1 < size f)%N.

Lemma char_poly_mx_dsum a b (M : 'M[L]_a) (N : 'M_b) :
  char_poly_mx (block_mx M 0 0 N) = dsum (char_poly_mx M) (char_poly_mx N).
Proof.
by rewrite /char_poly_mx map_block_mx scalar_mx_block opp_block_mx add_block_mx /= !map_mx0 !subr0.
Qed.

Lemma degrees_ge fs : all nonconstant fs -> (size fs <= degrees fs)%N.
Proof.
elim: fs => [//|f fs IH] /= /andP[/andP[_ s2] /IH]; rewrite -[X in _ -> (X <= _)%N]add1n.
by apply: leq_add; case: (size f) s2 => [|[]].
Qed.

Lemma companions_equivalent fs : all nonconstant fs ->
  equivalent (char_poly_mx (companions fs)) (diagonal (nseq (degrees fs - size fs) 1 ++ fs)).
Proof.
elim: fs => [_|f fs IH] /=.
  by split; exists 0, 0; apply/matrixP=> -[].
case/andP=> /andP[mf s2] nfs; have ge := degrees_ge nfs.
have [k sf] : exists k, (size f).-1 = k.+1 by case: (size f) s2 => [|[|k]]// _; exists k.
rewrite char_poly_mx_dsum.
apply: equivalent_trans (equivalent_dsum (companion_equivalent mf sf) (IH nfs)) _.
apply: equivalent_trans (diagonal_cat _ _) _; apply: diagonal_perm.
rewrite sf addSn subSS -addnBA//; apply/permP=> p; rewrite !count_cat /= !count_nseq.
rewrite mulnDr -!addnA; set x := nat_of_bool (p f); set y := (_ * k)%N; set z := (_ * _)%N.
by rewrite [in RHS](addnCA z) (addnCA x).
Qed.
End Companions.
