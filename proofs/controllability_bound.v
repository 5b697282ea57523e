(* controllability.md: what bounds the fixed polynomial of channels bounds from below what their inputs reach.

   The states that no input reaches have a characteristic polynomial that divides det(xI - A_F) for all F. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability joint_controllability.
From mcexact Require Import spectrum_split fixed_polynomial fixed_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Bound.
Variables (K : fieldType) (n b m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q) (B : 'M[K]_(n, b)).
Hypothesis within : forall i, exists M : 'M_(b, p i), mcB S i = B *m M.

(* The outputs of S may be any. *)
Theorem bounded_reach L : bounded S L -> (L <= \rank (reach (mcA S) B n))%N.
Proof.
case=> g [g0 top sg]; have [w [Q [Z [fQ QA QB un]]]] := unreached (mcA S) B.
have ann k : Q *m krylov (mcA S) B k = 0 by apply: krylov_annihilated QA QB.
have dv F : char_poly Z %| char_poly (closed_loop S F).
  apply: uncontrollable_polynomial_divides fQ _.
  rewrite /closed_loop mulmxDr QA mulmx_sumr big1 ?addr0// => i _.
  by have [M ->] := within i; rewrite !mulmxA QB !mul0mx.
have := leq_trans (leq_add (dvdp_leq g0 (top _ dv)) (leqnn L)) sg; rewrite size_char_poly addSn ltnS => wL.
rewrite -(leq_add2l w); apply: leq_trans wL _.
have zero k : kermx (reach (mcA S) B n) *m krylov (mcA S) B k = 0.
  have /mxrank_leqif_sup[_] : (kermx (reach (mcA S) B (maxn n k.+1)) <= kermx (reach (mcA S) B n))%MS.
    apply/sub_kermxP/reach_annihilated => i ik.
    have /reach_annihilated := mulmx_ker (reach (mcA S) B (maxn n k.+1)); apply.
    by rewrite leq_max ik.
  rewrite !mxrank_ker rank_reach_n ?leq_maxl// eqxx => /esym/sub_kermxP/reach_annihilated.
  by apply; rewrite leq_maxr.
have [Y eY] := un _ _ zero; have : (\rank (kermx (reach (mcA S) B n)) <= w)%N.
  by rewrite eY (leq_trans (mxrankM_maxr _ _))// rank_leq_row.
by rewrite mxrank_ker leq_subLR addnC.
Qed.

(* Kind `controllability`, by blocks: as controllability.controllability_rule, with a bound in place of a rank. *)
Theorem controllability_by_bound d (W : 'M[K]_(n - d, n)) (piv : 'I_(n - d) -> 'I_n) L :
  (d <= n)%N -> colsub piv W = 1%:M -> W *m mcA S = colsub piv (W *m mcA S) *m W -> W *m B = 0 ->
  bounded S L -> (d <= L)%N ->
  [/\ \rank (reach (mcA S) B n) = d,
      (forall lambda, uncontrollable_mode (mcA S) B lambda = root (char_poly (colsub piv (W *m mcA S))) lambda) &
      char_poly (colsub piv (W *m mcA S)) %| char_poly (mcA S)].
Proof.
move=> dn pW e z bd dL; have fW := pivots_free pW; have lo := leq_trans dL (bounded_reach bd).
have hi := uncontrollable_space n fW e z; rewrite subKn// in hi.
split=> [|lambda|]; first by apply/eqP; rewrite eqn_leq hi.
  by rewrite -{1}(subKn dn) in lo; apply: (uncontrollable_modes lambda fW e z lo).
exact: uncontrollable_polynomial_divides fW e.
Qed.
End Bound.
