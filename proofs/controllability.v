(* checker/core/reach.py and checker/structure.py: kinds `controllability`,
   `controllability_indices`, and the spaces of `assignability`.

   (A, B) is the pair of the channels named, B = B_T.  krylov A B k = A^k B and
   reach A B k = [B, A B, ..., A^(k-1) B].  Observability is the same on the transposes. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Krylov.
Variables (R : ringType) (n b : nat).
Definition krylov (A : 'M[R]_n) (B : 'M[R]_(n, b)) k : 'M[R]_(n, b) := iter k (mulmx A) B.
Definition reach (A : 'M[R]_n) (B : 'M[R]_(n, b)) k : 'M[R]_(n, \sum_(i < k) b) :=
  \mxrow_(i < k) krylov A B i.

Lemma krylovS A B k : krylov A B k.+1 = A *m krylov A B k. Proof. by []. Qed.

Lemma krylov_annihilated A B w (W : 'M[R]_(w, n)) Z k :
  W *m A = Z *m W -> W *m B = 0 -> W *m krylov A B k = 0.
Proof.
move=> e z; elim: k => [//|k IH]; by rewrite krylovS mulmxA e -mulmxA IH mulmx0.
Qed.

Lemma reach_annihilated A B w (W : 'M[R]_(w, n)) k :
  (forall i, (i < k)%N -> W *m krylov A B i = 0) <-> W *m reach A B k = 0.
Proof.
rewrite /reach mul_mxrow; split=> [z|/mxrowP z i ik].
  by apply/mxrowP=> i; rewrite mxrowK submxrow0 z.
by have := z (Ordinal ik); rewrite mxrowK submxrow0.
Qed.
End Krylov.

Section MapKrylov.
Variables (R R' : ringType) (f : {rmorphism R -> R'}) (n b : nat).
Lemma map_krylov (A : 'M[R]_n) (B : 'M[R]_(n, b)) k :
  map_mx f (krylov A B k) = krylov (map_mx f A) (map_mx f B) k.
Proof. by elim: k => [//|k IH]; rewrite !krylovS map_mxM IH. Qed.
Lemma map_reach (A : 'M[R]_n) (B : 'M[R]_(n, b)) k :
  map_mx f (reach A B k) = reach (map_mx f A) (map_mx f B) k.
Proof.
apply/mxrowP=> i; rewrite mxrowK -map_krylov.
have := mxrowK (fun i : 'I_k => krylov A B i) i; rewrite /reach.
by move: (mxrow _) => M; rewrite /submxrow -map_mxsub => ->.
Qed.
End MapKrylov.

Section Field.
Variables (L : fieldType) (n b : nat).
Implicit Types (A : 'M[L]_n) (B : 'M[L]_(n, b)).

(* A rank is bounded from above by an annihilator of full row rank. *)
Theorem rank_from_above c w (M : 'M[L]_(n, c)) (W : 'M[L]_(w, n)) :
  W *m M = 0 -> row_free W -> (\rank M <= n - w)%N.
Proof. by move=> e /eqP rW; have := mulmx0_rank_max e; rewrite rW leq_subRL ?rW// -rW rank_leq_col. Qed.

Lemma pivots_free w (W : 'M[L]_(w, n)) (piv : 'I_w -> 'I_n) : colsub piv W = 1%:M -> row_free W.
Proof.
move=> e; rewrite /row_free eqn_leq rank_leq_row/= -[X in (X <= _)%N](mxrank1 L) -e.
by rewrite -{1}[W]mulmx1 -mulmx_colsub mxrankM_maxl.
Qed.

(* Rule `controllability`, upper half: the reachable space has dimension at most n - w. *)
Theorem uncontrollable_space w (W : 'M[L]_(w, n)) Z A B k :
  row_free W -> W *m A = Z *m W -> W *m B = 0 -> (\rank (reach A B k) <= n - w)%N.
Proof.
move=> fW e z; apply: rank_from_above fW; apply/reach_annihilated => i _.
exact: krylov_annihilated e z.
Qed.

(* Popov, Belevitch, Hautus: lambda is an uncontrollable mode. *)
Definition uncontrollable_mode A B lambda := (\rank (row_mx (lambda%:M - A) B) < n)%N.

Lemma uncontrollable_modeP A B lambda :
  reflect (exists w : 'rV_n, [/\ w != 0, w *m A = lambda *: w & w *m B = 0])
          (uncontrollable_mode A B lambda).
Proof.
apply: (iffP idP) => [r | [w [nw wA wB]]].
  have : kermx (row_mx (lambda%:M - A) B) != 0.
    by rewrite -mxrank_eq0 mxrank_ker subn_eq0 -ltnNge.
  case/rowV0Pn=> w /sub_kermxP; rewrite mul_mx_row => e nw; exists w.
  have := e; rewrite -(row_mx0 _ 1 n b) => /eq_row_mx[]; rewrite mulmxBr mul_mx_scalar.
  by move/eqP; rewrite subr_eq0 => /eqP.
rewrite /uncontrollable_mode ltnNge; apply: contra nw => r.
have fr : row_free (row_mx (lambda%:M - A) B) by rewrite /row_free eqn_leq rank_leq_row.
apply/eqP; apply: (row_free_inj fr); rewrite mul_mx_row mul0mx wB mulmxBr mul_mx_scalar wA subrr.
by rewrite row_mx0.
Qed.

(* The eigenvalues of Z are exactly the uncontrollable modes, once the dimension is reached. *)
Theorem uncontrollable_modes w (W : 'M[L]_(w, n)) Z A B k lambda :
  row_free W -> W *m A = Z *m W -> W *m B = 0 -> (n - w <= \rank (reach A B k))%N ->
  uncontrollable_mode A B lambda = root (char_poly Z) lambda.
Proof.
move=> fW e z r; rewrite -eigenvalue_root_char; apply/uncontrollable_modeP/eigenvalueP.
  case=> v [nv vA vB]; have vr : v *m reach A B k = 0.
    apply/reach_annihilated => i _; apply: (@krylov_annihilated _ _ _ _ _ _ _ lambda%:M) vB.
    by rewrite mul_scalar_mx.
  have sW : (W <= kermx (reach A B k))%MS.
    by apply/sub_kermxP; apply/reach_annihilated => i _; apply: krylov_annihilated e z.
  have /eqmxP eW : (W == kermx (reach A B k))%MS.
    rewrite -(mxrank_leqif_eq sW) eqn_leq (mxrankS sW) mxrank_ker (eqP fW).
    by rewrite leq_subLR addnC -leq_subLR.
  have /submxP[y ey] : (v <= W)%MS by rewrite eW; apply/sub_kermxP.
  exists y; last by apply: contra nv; rewrite ey => /eqP->; rewrite mul0mx.
  by apply: (row_free_inj fW); rewrite -mulmxA -e mulmxA -ey vA ey scalemxAl.
case=> y yZ ny; exists (y *m W); split.
- by apply: contra ny => /eqP yW; apply/eqP; apply: (row_free_inj fW); rewrite yW mul0mx.
- by rewrite -mulmxA e mulmxA yZ scalemxAl.
- by rewrite -mulmxA z mulmx0.
Qed.

Lemma char_poly_similar a (A' : 'M[L]_a) A (G : 'M[L]_(a, n)) :
  row_free G -> row_full G -> G *m A = A' *m G -> char_poly A' = char_poly A.
Proof.
move=> fG uG e; have an : a = n by rewrite -(eqP fG) (eqP uG).
move: A' G fG uG e; rewrite an => A' G; rewrite row_free_unit => uG _ e.
have nG : \det (map_mx polyC G) != 0 by rewrite det_map_mx polyC_eq0 -unitfE -unitmxE.
apply: (mulIf nG); rewrite -det_mulmx mulrC -det_mulmx /char_poly_mx.
by rewrite mulmxBl mulmxBr -!map_mxM e scalar_mxC.
Qed.

(* The uncontrollable polynomial det(xI - Z) divides chi_A, with multiplicities. *)
Theorem uncontrollable_polynomial_divides w (W : 'M[L]_(w, n)) Z A :
  row_free W -> W *m A = Z *m W -> char_poly Z %| char_poly A.
Proof.
move=> fW e; pose W' := row_base (W^C)%MS; pose G := col_mx W W'.
have rG : \rank G = n.
  by rewrite -addsmxE (adds_eqmx (eqmx_refl W) (eq_row_base _)) (eqP (addsmx_compl_full W)).
have rC : \rank (W^C)%MS = (n - w)%N by rewrite mxrank_compl (eqP fW).
have wn : (w <= n)%N by rewrite -(eqP fW) rank_leq_col.
have fG : row_free G by rewrite /row_free rG rC subnKC.
have uG : row_full G by rewrite /row_full rG.
have [Y eY] : exists Y, G *m A = Y *m G by apply/submxP; rewrite submx_full.
rewrite -(char_poly_similar fG uG eY).
have eU : usubmx Y = row_mx Z 0.
  apply: (row_free_inj fG); rewrite mul_usub_mx -eY mul_row_col mul0mx addr0 -e.
  by rewrite mul_col_mx col_mxKu.
rewrite -[Y]vsubmxK eU -[dsubmx Y]hsubmxK -block_mxEv /char_poly /char_poly_mx.
rewrite map_block_mx scalar_mx_block opp_block_mx add_block_mx /= map_mx0 subr0.
by rewrite det_lblock dvdp_mulr.
Qed.
End Field.

Section Rules.
Variables (l : modulus) (n b : nat) (A : 'M[Zloc l]_n) (B : 'M[Zloc l]_(n, b)).
Variables (L : fieldType) (h : {rmorphism rat -> L}).
Notation up := (into (l:=l) h).
Notation res := (map_mx (@residue l)).

Let map_free w (W : 'M[Zloc l]_(w, n)) (piv : 'I_w -> 'I_n) :
  colsub piv W = 1%:M -> row_free (map_mx up W).
Proof. by move=> e; apply: (@pivots_free _ _ _ _ piv); rewrite -map_mxsub e map_mx1. Qed.

(* Kind `controllability`: the dimension is d, the uncontrollable modes are the roots of the
   polynomial, and (A, B) is controllable iff d = n. *)
Theorem controllability_rule d (W : 'M[Zloc l]_(n - d, n)) (piv : 'I_(n - d) -> 'I_n) k X Y :
  (d <= n)%N -> colsub piv W = 1%:M -> W *m A = colsub piv (W *m A) *m W -> W *m B = 0 ->
  X *m res (reach A B k) *m Y = 1%:M :> 'M_d ->
  [/\ \rank (reach (map_mx up A) (map_mx up B) k) = d,
      (forall lambda, uncontrollable_mode (map_mx up A) (map_mx up B) lambda =
         root (map_poly up (char_poly (colsub piv (W *m A)))) lambda) &
      map_poly up (char_poly (colsub piv (W *m A))) %| map_poly up (char_poly A)].
Proof.
move=> dn pW e z XY; have lo := rank_from_below h XY; rewrite map_reach in lo.
have fW := map_free pW.
have e' : map_mx up W *m map_mx up A = map_mx up (colsub piv (W *m A)) *m map_mx up W.
  by rewrite -!map_mxM -e.
have z' : map_mx up W *m map_mx up B = 0 by rewrite -map_mxM z map_mx0.
have hi := uncontrollable_space k fW e' z'; rewrite subKn// in hi.
split=> [|lambda|].
- by apply/eqP; rewrite eqn_leq hi.
- rewrite map_char_poly; have lo' := lo; rewrite -{1}(subKn dn) in lo'.
  exact: (uncontrollable_modes lambda fW e' z' lo').
- by rewrite !map_char_poly; apply: uncontrollable_polynomial_divides fW e'.
Qed.

(* Kind `controllability_indices`: the rank of the first k blocks is r, from both sides. *)
Theorem indices_rule k r w (W : 'M[Zloc l]_(w, n)) X Y (X' : 'M_(w, w)) Y' :
  (r <= n)%N -> w = (n - r)%N -> X' *m res W *m Y' = 1%:M :> 'M_w ->
  (forall i, (i < k)%N -> W *m krylov A B i = 0) ->
  X *m res (reach A B k) *m Y = 1%:M :> 'M_r ->
  \rank (reach (map_mx up A) (map_mx up B) k) = r.
Proof.
move=> rn ew fW z XY; have lo := rank_from_below h XY; rewrite map_reach in lo.
apply/eqP; rewrite eqn_leq lo andbT -[X in (_ <= X)%N](subKn rn) -ew.
apply: (@rank_from_above _ _ _ _ _ (map_mx up W)).
  by apply/reach_annihilated => i ik; rewrite -map_krylov -map_mxM z// map_mx0.
by rewrite /row_free eqn_leq rank_leq_row/=; apply: rank_from_below fW.
Qed.
End Rules.

Section Stationary.
Variables (L : fieldType) (n b : nat) (A : 'M[L]_n) (B : 'M[L]_(n, b)).

Lemma ker_rank c c' (M : 'M[L]_(n, c)) (N : 'M[L]_(n, c')) :
  (kermx M <= kermx N)%MS -> (\rank N <= \rank M)%N.
Proof.
move/mxrankS; rewrite !mxrank_ker => /(leq_sub2l n).
by rewrite !subKn ?rank_leq_row.
Qed.

(* The last step of `controllability_indices`: ranks that stop once stop forever. *)
Theorem indices_stationary k : \rank (reach A B k.+1) = \rank (reach A B k) ->
  forall j, (k <= j)%N -> \rank (reach A B j) = \rank (reach A B k).
Proof.
move=> e; have sub j i : (i <= j)%N -> (kermx (reach A B j) <= kermx (reach A B i))%MS.
  move=> ij; apply/sub_kermxP/reach_annihilated => t ti.
  by have /reach_annihilated := mulmx_ker (reach A B j); apply; apply: leq_trans ij.
have rk j i : (i <= j)%N -> (\rank (reach A B i) <= \rank (reach A B j))%N.
  by move=> /sub; apply: ker_rank.
have eqk : (kermx (reach A B k) <= kermx (reach A B k.+1))%MS.
  have := mxrank_leqif_sup (sub _ _ (leqnSn k)); rewrite !mxrank_ker e => -[_].
  by rewrite eqxx => <-.
(* the annihilator of k blocks annihilates every further one *)
have all j : kermx (reach A B k) *m krylov A B j = 0.
  have [c ec] : exists c, kermx (reach A B k) *m A = c *m kermx (reach A B k).
    apply/submxP/sub_kermxP/reach_annihilated => i ik; rewrite -mulmxA -krylovS.
    by have /sub_kermxP/reach_annihilated := eqk; apply.
  case: k e sub rk eqk c ec => [|k] e sub rk eqk c ec.
    apply: (krylov_annihilated _ ec).
    by have /sub_kermxP/reach_annihilated/(_ 0%N isT) := eqk.
  apply: (krylov_annihilated _ ec).
  by have /reach_annihilated/(_ 0%N isT) := mulmx_ker (reach A B k.+1).
move=> j kj; apply/eqP; rewrite eqn_leq (rk _ _ kj) andbT.
have : (kermx (reach A B k) <= kermx (reach A B j))%MS.
  by apply/sub_kermxP/reach_annihilated => i _; apply: all.
exact: ker_rank.
Qed.
End Stationary.
