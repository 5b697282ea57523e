(* Section V-A: the system (34) is jointly observable, at every lambda, 0 among them: what an agent has sent is seen by the
   follower with the longest delay until the last, and before that moves on by one step each time. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence controllability rank_one_repair pencil_space.
From mcexact Require Import anderson_clements extended joint_controllability extended_bound.
From mcexact Require Import delayed_systems lifted delays wang_davison meaning.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Observability.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (S : multichannel K n p q).
Hypotheses (hears : forall i, i \in N i) (own_at_once : forall i, d i i = 0%N).
Notation blk := (agent_block K (memory q N k d)).
Notation sub := (sub_state K q N k d).
Notation out := (past_output K q N k d).
Notation dmax := (dmax N d).
Variables (lambda : K) (x : 'cV[K]_n) (Y : 'cV[K]_(\sum_i memory q N k d i)).

(* a follower with the longest delay *)
Lemma longest j : exists2 i, j \in N i & d i j = dmax j.
Proof.
have [|i Nj e] := @eq_bigmax_cond _ [pred i | j \in N i] (fun i => d i j); last by exists i.
by apply/card_gt0P; exists j; rewrite inE.
Qed.

(* registers that are scaled by lambda, and whose last cell is empty, are empty *)
Lemma empty_register r a (c : 'cV[K]_(\sum_(i < r) a)) : shift K r a *m c = lambda *: c ->
  ((0 < r)%N -> pick K r a r.-1 *m c = 0) -> c = 0.
Proof.
move=> e last; have cell t : (t < r)%N -> pick K r a (r.-1 - t) *m c = 0.
  elim: t => [|t IH] tr; first by rewrite subn0 last.
  have r0 : (0 < r)%N by apply: leq_ltn_trans tr.
  have lt : (r.-1 - t.+1).+1 = (r.-1 - t)%N by rewrite subnSK // -ltnS prednK.
  rewrite -(@pick_shiftS _ a r) ?lt; last by rewrite (leq_ltn_trans (leq_subr _ _)) // prednK.
  by rewrite -mulmxA e -scalemxAr IH ?scaler0 // ltnW.
apply/mxcolP => j; rewrite submxcol0; have jr : (j <= r.-1)%N by rewrite -ltnS prednK // (leq_ltn_trans _ (ltn_ord j)).
have := cell (r.-1 - j)%N; rewrite subKn // => <-; last by rewrite (leq_ltn_trans (leq_subr _ _)) // prednK // (leq_ltn_trans _ (ltn_ord j)).
rewrite /pick -{2}[c]submxcolK mul_mxrow_mxcol (bigD1 j) //= eqxx mul1mx big1 ?addr0 // => i ij.
by rewrite val_eqE (negPf ij) mul0mx.
Qed.

Lemma nothing_stored : lifted_K K q N k d *m Y = lambda *: Y ->
  (forall j, sub j (dmax j) *m Y = 0) -> (forall j, (0 < dmax j)%N -> out j (dmax j) *m Y = 0) -> Y = 0.
Proof.
move=> e subs outs; have zero j : blk j *m Y = 0.
  have := congr1 (fun M => blk j *m M) e; rewrite mulmxA block_diag -mulmxA -scalemxAr -[blk j *m Y]vsubmxK.
  rewrite mul_block_col !mul0mx addr0 add0r scale_col_mx => /eq_col_mx[e1 e2].
  rewrite (empty_register e1) => [|_]; last by rewrite -[RHS](subs j) sub_cell.
  rewrite (empty_register e2) ?col_mx0 // => d0; by rewrite -[RHS](outs j d0) out_cell.
by apply/mxcolP => j; rewrite submxcol0 -[RHS](zero j) /agent_block submxcol_mul mul1mx.
Qed.

(* what no output shows, and what moves by lambda, is 0 *)
Theorem lifted_unobservable : (forall v : 'cV[K]_n, mcA S *m v = lambda *: v -> (forall i, mcC S i *m v = 0) -> v = 0) ->
  mcA (lifted N k d S) *m col_mx x Y = lambda *: col_mx x Y ->
  (forall i, mcC (lifted N k d S) i *m col_mx x Y = 0) -> col_mx x Y = 0.
Proof.
move=> observable; rewrite /= mul_block_col mul0mx addr0 scale_col_mx => /eq_col_mx[eA eK] unseen.
have seen i : [/\ forall j, j \in N i -> d i j = 0%N -> mcC S j *m x = 0,
    forall j, j \in N i -> (0 < d i j)%N -> out j (d i j) *m Y = 0 & forall j, j \in N i -> sub j (d i j) *m Y = 0].
  have := unseen i; rewrite lifted_output => /eqP; rewrite -[X in _ == X](col_mx0 K) => /eqP/eq_col_mx[e0].
  rewrite -[RHS](col_mx0 K) => /eq_col_mx[e1 e2]; split=> j Nj.
  - move=> dj; have := congr1 (fun M => submxcol M j) e0; by rewrite mxcolK Nj dj eqxx submxcol0.
  - move=> dj; have := congr1 (fun M => submxcol M j) e1; by rewrite mxcolK Nj -lt0n dj submxcol0.
  by have := congr1 (fun M => submxcol M j) e2; rewrite mxcolK Nj submxcol0.
have x0 : x = 0.
  by apply: observable => // i; have [own _ _] := seen i; apply: own.
rewrite x0 mulmx0 add0r in eK; rewrite x0 (nothing_stored eK) ?col_mx0 // => j; have [i Nj e] := longest j.
  by have [_ _ s] := seen i; rewrite -e s.
by move=> d0; have [_ o _] := seen i; rewrite -e o // e.
Qed.
End Observability.

Section Joint.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (S : multichannel K n p q).
Hypotheses (hears : forall i, i \in N i) (own_at_once : forall i, d i i = 0%N).
Notation T := (lifted N k d S).
Notation T' := (lifted N k d (map_system f S)).

Lemma map_lifted : map_mx f (mcA T) = mcA T' /\ outputs (map_system f T) setT = outputs T' setT.
Proof.
have := pencil_map_lifted f N k d S setT 0; rewrite /pencil => /eq_block_mx[eA _ eC _]; split=> //.
by apply: oppr_inj; move: eA; rewrite raddf0 !add0r.
Qed.

Theorem lifted_jointly_observable : jointly_observable S -> jointly_observable T.
Proof.
move=> jo; have [eA eC] := map_lifted; apply/(controllable_modes f) => lambda.
apply/uncontrollable_modeP => -[w [/eqP w0 wA wC]]; case: w0; apply: trmx_inj; rewrite trmx0 -[w^T]vsubmxK.
have moved : mcA T' *m w^T = lambda *: w^T.
  by rewrite -eA -[map_mx f _]trmxK map_trmx -trmx_mul wA linearZ.
have unseen : outputs T' setT *m w^T = 0.
  by rewrite -eC -map_outputs -[map_mx f _]trmxK map_trmx -trmx_mul wC trmx0.
apply: (lifted_unobservable hears own_at_once (S := map_system f S) (lambda := lambda)); rewrite ?vsubmxK //; last first.
  by move=> i; move/outputs_eq0/(_ i (in_setT i)): unseen.
move=> v vA vC; have rank := observable_hautus f lambda jo.
have free : row_free (col_mx (lambda%:M - map_mx f (mcA S)) (map_mx f (outputs S setT)))^T by rewrite /row_free mxrank_tr rank.
apply: trmx_inj; apply/eqP; rewrite trmx0 -(mulmx_free_eq0 _ free) -trmx_mul mul_col_mx mulmxBl mul_scalar_mx -vA.
rewrite subrr map_outputs; have -> : outputs (map_system f S) setT *m v = 0 by apply/outputs_eq0 => i _; exact: vC.
by rewrite col_mx0 trmx0.
Qed.

(* its uncontrollable modes are at 0 *)
Theorem lifted_uncontrollable_at_0 (lambda : L) : jointly_controllable S -> lambda != 0 ->
  ~~ uncontrollable_mode (map_mx f (mcA T)) (map_mx f (inputs T setT)) lambda.
Proof.
move=> jc l0; have := rank_lifted N k d l0 (map_system f S) set0; rewrite -pencil_map_lifted rank_pencil0 map_inputs.
rewrite neighborhood0 set0D big_set0 addn0 /neighbor_pencil neighborhood0.
rewrite -/(pencil (map_system f S) set0 lambda) jointly_controllable_pencil //.
by rewrite /uncontrollable_mode => ->; rewrite ltnn.
Qed.
End Joint.
