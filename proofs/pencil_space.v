(* The rank of P_s(lambda) depends only on the row space of C_s and on the column space of B_{m-s}:
   the stacks of multichannel.v and the spaces of rank_one_repair.v have the same rank. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Block.
Variable L : fieldType.

Lemma rank_block_le k n p p' q q' (N : 'M[L]_(k, n)) (B : 'M_(k, p)) (B' : 'M_(k, p'))
    (C : 'M_(q, n)) (C' : 'M_(q', n)) : (B^T <= B'^T)%MS -> (C <= C')%MS ->
  (\rank (block_mx N B C 0) <= \rank (block_mx N B' C' 0))%N.
Proof.
case/submxP=> E /(congr1 trmx); rewrite trmx_mul !trmxK => ->; case/submxP=> D ->.
have -> : block_mx N (B' *m E^T) (D *m C') 0 =
    block_mx 1%:M 0 0 D *m block_mx N B' C' 0 *m block_mx 1%:M 0 0 E^T.
  by rewrite !mulmx_block !(mul1mx, mul0mx, mulmx0, mulmx1, addr0, add0r).
exact: leq_trans (mxrankM_maxl _ _) (mxrankM_maxr _ _).
Qed.

Lemma rank_block_eq k n p p' q q' (N : 'M[L]_(k, n)) (B : 'M_(k, p)) (B' : 'M_(k, p'))
    (C : 'M_(q, n)) (C' : 'M_(q', n)) : (B^T :=: B'^T)%MS -> (C :=: C')%MS ->
  \rank (block_mx N B C 0) = \rank (block_mx N B' C' 0).
Proof.
move=> eB eC; apply/eqP; rewrite eqn_leq !rank_block_le //.
- by rewrite eB.
- by rewrite eC.
- by rewrite -eB.
- by rewrite -eC.
Qed.

(* two uncoupled systems *)
Lemma rank_block_diag k1 n1 p1 q1 k2 n2 p2 q2 (N1 : 'M[L]_(k1, n1)) (B1 : 'M_(k1, p1))
    (C1 : 'M_(q1, n1)) (N2 : 'M_(k2, n2)) (B2 : 'M_(k2, p2)) (C2 : 'M_(q2, n2)) :
  \rank (block_mx (block_mx N1 0 0 N2) (block_mx B1 0 0 B2) (block_mx C1 0 0 C2) 0) =
  (\rank (block_mx N1 B1 C1 0) + \rank (block_mx N2 B2 C2 0))%N.
Proof.
rewrite -rank_diag_block_mx.
pose z a b c d : 'M[L]_(a + b, c + d) := block_mx 0 0 0 0.
have zE a b c d : z a b c d = 0 by rewrite /z !block_mx_const.
pose M := block_mx (block_mx N1 0 0 N2) (block_mx B1 0 0 B2) (block_mx C1 0 0 C2) (z q1 q2 p1 p2).
pose D := block_mx (block_mx N1 B1 C1 0) (z k1 q1 n2 p2) (z k2 q2 n1 p1) (block_mx N2 B2 C2 0).
pose X a b c d : 'M[L]_(a + b + (c + d), a + c + (b + d)) :=
  block_mx (block_mx 1%:M 0 0 0) (block_mx 0 0 1%:M 0)
           (block_mx 0 1%:M 0 0) (block_mx 0 0 0 1%:M).
have simp := (mul1mx, mul0mx, mulmx0, mulmx1, addr0, add0r).
have eD : D = X _ _ _ _ *m M *m X _ _ _ _.
  by rewrite /X /M /D /z !(mulmx_block, add_block_mx, simp).
have eM : M = X _ _ _ _ *m D *m X _ _ _ _.
  by rewrite /X /M /D /z !(mulmx_block, add_block_mx, simp).
rewrite -(zE q1 q2) -(zE k1) -(zE k2) -/M -/D.
have le1 : (\rank M <= \rank D)%N.
  by rewrite [M in (\rank M <= _)%N]eM (leq_trans (mxrankM_maxl _ _)) // mxrankM_maxr.
have le2 : (\rank D <= \rank M)%N.
  by rewrite [D in (\rank D <= _)%N]eD (leq_trans (mxrankM_maxl _ _)) // mxrankM_maxr.
by apply/eqP; rewrite eqn_leq le1.
Qed.

End Block.

Section Stacks.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel L n p q) (s : {set 'I_m}) (lambda : L).

Lemma mxcol_space k (d : 'I_m -> nat) (V : forall i, 'M[L]_(d i, k)) s :
  (\mxcol_i (if i \in s then V i else 0) :=: (\sum_(i in s) <<V i>>)%MS)%MS.
Proof.
apply: eqmx_trans (eqmx_col _) _; rewrite [X in (_ :=: X)%MS]big_mkcond /=.
by rewrite (eq_bigr (fun i => if i \in s then <<V i>>%MS else 0)) // => i _; case: ifP; rewrite ?genmx0.
Qed.

Lemma eqmx_outputs S s : (outputs S s :=: output_space (mcC S) s)%MS.
Proof. exact: mxcol_space. Qed.

Lemma eqmx_inputs S s : ((inputs S s)^T :=: (input_space (mcB S) s)^T)%MS.
Proof.
rewrite trmxK /inputs tr_mxrow.
have -> : \mxcol_i (if i \in s then mcB S i else 0)^T =
          \mxcol_i (if i \in s then (mcB S i)^T else 0).
  by apply: eq_mxcol => i; case: ifP => // _; rewrite trmx0.
exact: mxcol_space.
Qed.

Lemma rank_pencilE S s lambda :
  \rank (pencil S s lambda) =
  \rank (wong_pencil (mcB S) (mcC S) (lambda%:M - mcA S) s).
Proof. exact: rank_block_eq (eqmx_inputs _ _) (eqmx_outputs _ _). Qed.

Lemma perturbed_closed_loop S (F : gains L p q) lambda :
  perturbed (mcB S) (mcC S) (lambda%:M - mcA S) F = lambda%:M - closed_loop S F.
Proof. by rewrite /perturbed /closed_loop opprD addrA. Qed.

Lemma eigenvalue_rank k (M : 'M[L]_k) lambda :
  eigenvalue M lambda = (\rank (lambda%:M - M)%R < k)%N.
Proof.
rewrite /eigenvalue /eigenspace -mxrank_eq0 mxrank_ker -mxrank_opp opprB subn_eq0 -ltnNge.
by [].
Qed.

End Stacks.
