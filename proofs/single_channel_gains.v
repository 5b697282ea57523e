(* checker/structure.py: kind `single_channel_gains`, rules yes and no.
   The observable side is the same on the dual system. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph fixed_spectrum.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section No.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).

(* No, by a shrunk subspace with the channel in T: no gains make it control (A_F, B_channel). *)
Theorem single_channel_no_mode P T d (E : rank_loss S P T d) (L : fieldType)
    (f : {rmorphism K -> L}) lambda channel (F : gains L p q) :
  (0 < d)%N -> root (map_poly f P) lambda -> channel \in T ->
  uncontrollable_mode (closed_loop (map_system f S) F) (mcB (map_system f S) channel) lambda.
Proof.
move=> d0 rP cT; have sh := certificate_shrunk E rP; have fU := certificate_free E rP.
have [X eX] := certificate_inputs E rP; have [W eW] := shrunk_image sh F.
rewrite /uncontrollable_mode; set M := row_mx _ _; set Y := map_mx _ (rl_Y E) in eX eW.
have eB : mcB (map_system f S) channel = Y *m (X *m submxrow 1%:M channel).
  by rewrite mulmxA -eX mul_submxrow mulmx1 mxrowK cT.
have e : M *m block_mx (map_mx (value f lambda) (rl_U E)) 0 0 1%:M = Y *m row_mx W (X *m submxrow 1%:M channel).
  by rewrite mul_row_block !mulmx0 addr0 add0r mulmx1 eW {1}eB mul_mx_row.
have := mxrank_mul_min M (block_mx (map_mx (value f lambda) (rl_U E)) 0 0 1%:M).
rewrite e rank_diag_block_mx fU mxrank1 addnA subnDr => h.
have := rank_count (leq_trans h (leq_trans (mxrankM_maxl _ _) (rank_leq_col _))) (rl_count E).
by apply: leq_trans; rewrite -[X in (X < _)%N]addn0 ltn_add2l.
Qed.

(* No, by a zero transfer from T, which holds the channel, where some C_i outside T is not 0. *)
Theorem single_channel_no_cut T (E : zero_transfer S T (~: T)) channel i (F : gains K p q) k :
  channel \in T -> i \notin T -> mcC S i != 0 ->
  (\rank (reach (closed_loop S F) (mcB S channel) k) < n)%N.
Proof.
move=> cT iT nC; have [x X piv inv inp out] := E.
pose Z := rowsub piv (mcA S *m X)
  + \sum_(j | j \in T) rowsub piv (mcB S j) *m F j *m mcC S j *m X.
have eZ : closed_loop S F *m X = X *m Z.
  rewrite /closed_loop mulmxDl mulmxDr -inv mulmx_suml mulmx_sumr; congr (_ + _).
  rewrite (bigID (mem T)) /= [X in _ + X]big1 ?addr0 => [|j jT]; last first.
    by rewrite -mulmxA out ?inE// mulmx0.
  by apply: eq_bigr => j jT; rewrite {1}(inp _ jT) !mulmxA.
have ck t : mcC S i *m krylov (closed_loop S F) (mcB S channel) t = 0.
  suff [Y ->] : exists Y, krylov (closed_loop S F) (mcB S channel) t = X *m Y.
    by rewrite mulmxA out ?inE// mul0mx.
  elim: t => [|t [Y eY]]; first by exists (rowsub piv (mcB S channel)); rewrite -inp.
  by exists (Z *m Y); rewrite krylovS eY !mulmxA eZ.
have /mulmx0_rank_max : mcC S i *m reach (closed_loop S F) (mcB S channel) k = 0.
  by apply/reach_annihilated => t _.
by apply: leq_trans; rewrite -[X in (X < _)%N]add0n ltn_add2r lt0n mxrank_eq0.
Qed.
End No.

Section Yes.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Variables (L : fieldType) (h : {rmorphism rat -> L}).

(* Yes: one list of gains and the index nu, from both sides. *)
Theorem single_channel_yes (F : gains (Zloc l) p q) channel nu X Y (w : 'rV[Zloc l]_n) :
  X *m map_mx (@residue l) (reach (closed_loop S F) (mcB S channel) nu) *m Y = 1%:M :> 'M_n ->
  w != 0 -> (forall i, (i < nu.-1)%N -> w *m krylov (closed_loop S F) (mcB S channel) i = 0) ->
  let AF := map_mx (into h) (closed_loop S F) in let B := map_mx (into h) (mcB S channel) in
  \rank (reach AF B nu) = n /\ (\rank (reach AF B nu.-1) < n)%N.
Proof.
move=> XY nw wz AF B; have lo := rank_from_below h XY; rewrite map_reach in lo.
split; first by apply/eqP; rewrite eqn_leq rank_leq_row lo.
have /mulmx0_rank_max : map_mx (into h) w *m reach AF B nu.-1 = 0.
  by apply/reach_annihilated => i il; rewrite -map_krylov -map_mxM wz// map_mx0.
apply: leq_trans; rewrite -[X in (X < _)%N]add0n ltn_add2r lt0n mxrank_eq0.
apply: contra nw => /eqP w0; apply/eqP/matrixP=> i j; have /matrixP/(_ i j) := w0.
by rewrite !mxE => /eqP; rewrite into_eq0 => /eqP.
Qed.
End Yes.
