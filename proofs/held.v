(* The exact rank of the held system (emcsdd-hold), at every lambda. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space anderson_clements.
From mcexact Require Import extended delayed_systems.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Held.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat).
Hypothesis hears : forall i, i \in N i.
Implicit Types (S : multichannel L n p q).
Notation chain := (chain N k d).

Lemma span_mxcol r (c : 'I_m -> nat) (V : forall i, 'M[L]_(c i, r)) (s : {set 'I_m}) :
  (\mxcol_i (if i \in s then V i else 0) :=: span V s)%MS.
Proof. exact: mxcol_space. Qed.

(* the exact rank of the held system, at every lambda *)
Theorem rank_held S s lambda :
  \rank (pencil (held N k d S) s lambda) =
  (\rank (pencil S s lambda) + \sum_i chain i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
pose X0 i := pick L (dmax N d i).+1 (k i) 0; pose X1 i := pick L (dmax N d i).+1 (k i) (dmax N d i).
pose B i : 'M[L]_(chain i) := (if i \in ~: s then <<X0 i>>%MS else 0)^T.
pose C i : 'M[L]_(chain i) := if i \in neighborhood N s then <<X1 i>>%MS else 0.
have eB : ((inputs (held N k d S) (~: s))^T :=: (block_mx (inputs S (~: s)) 0 0 (\mxdiag_i B i))^T)%MS.
  apply: eqmx_trans (eqmx_inputs _ _) _; rewrite trmxK.
  have e i : i \in ~: s -> ((mcB (held N k d S) i)^T :=:
      block_mx (mcB S i)^T 0 0 (X0 i *m agent_block L chain i))%MS.
    by move=> _; rewrite /= tr_block_mx !trmx0 trmxK.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  rewrite tr_block_mx !trmx0 tr_mxdiag; have eI := eqmx_inputs S (~: s); rewrite trmxK in eI.
  have eD := span_diag X0 (~: s); rewrite (eq_mxdiag (B'_ := fun i => (B i)^T)) in eD; last first.
    by move=> i; rewrite trmxK.
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?eI ?eD.
have eC : (outputs (held N k d S) s :=: block_mx (outputs S s) 0 0 (\mxdiag_i C i))%MS.
  apply: eqmx_trans (eqmx_outputs _ _) _.
  have e i : i \in s -> (mcC (held N k d S) i :=: block_mx (mcC S i) 0 0
      (span (fun j => X1 j *m agent_block L chain j) (N i)))%MS.
    by move=> _ /=; apply/eqmxP/andP; split; apply: block_sub; rewrite // span_mxcol.
  apply: eqmx_trans (span_eqmx e) _; apply: eqmx_trans (span_block _ _ _) _.
  have eO := eqmx_outputs S s; have eD := span_diag X1 (neighborhood N s).
  by apply/eqmxP/andP; split; apply: block_sub; rewrite ?span_bigcup ?eO ?eD.
rewrite /pencil (rank_block_eq _ eB eC) /= scalar_mx_block opp_block_mx add_block_mx.
rewrite !(subr0, oppr0, addr0) rank_block_diag -addnA; congr addn.
rewrite -mxdiagZ -mxdiagB rank_block_mxdiag.
rewrite (eq_bigr (fun i => chain i + if (i \in ~: s) && (i \in neighborhood N s) then k i else 0)%N).
  rewrite big_split /=; congr addn; rewrite -big_mkcond; apply: eq_bigl => i.
  by rewrite !inE.
move=> i _; rewrite -(@rank_chain L (k i) lambda (dmax N d i) (i \in ~: s) (i \in neighborhood N s)).
  apply: rank_block_eq; [rewrite /B !trmxK | rewrite /C]; case: ifP => _; try exact: genmxE.
    exact: eqmx_sym (eqmx0 _ _ _).
  exact: eqmx_sym (eqmx0 _ _ _).
by rewrite inE; case: (boolP (i \in s)) => // si; rewrite (subsetP (sub_neighborhood hears s)).
Qed.

Theorem held_not_fixed S lambda :
  ~ fixed (held N k d S) lambda <->
  forall s, (n - \rank (pencil S s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof.
rewrite anderson_clements; split=> [nf s|h [s]]; last first.
  by rewrite rank_held addnAC ltn_add2r ltnNge -leq_subLR h.
rewrite leq_subLR leqNgt; apply/negP => lt; apply: nf; exists s.
by rewrite rank_held addnAC ltn_add2r.
Qed.

End Held.
