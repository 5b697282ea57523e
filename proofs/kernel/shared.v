(* Extended systems, in which agents share states of their own, on lists.

   `multichannel.extended` and `extended_states` have zero rows for what is not heard, a list none; loops, ranks and edges
   are the same, as in stacked.v. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel pencil_space extended transfer_graph.
From mcexact.kernel Require Import lists systems program_rule stacked.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Sums.
Variables (K : fieldType) (m : nat).
Definition direct_sum n n' (p q p' q' : 'I_m -> nat) (S : multichannel K n p q) (S' : multichannel K n' p' q') :
    multichannel K (n + n') (fun i => p i + p' i)%N (fun i => q i + q' i)%N :=
  Multichannel (block_mx (mcA S) 0 0 (mcA S')) (fun i => block_mx (mcB S i) 0 0 (mcB S' i)) (fun i => block_mx (mcC S i) 0 0 (mcC S' i)).
(* The shared states alone: agent i sets x_i, and measures it. *)
Definition shared_system (k : 'I_m -> nat) : multichannel K (\sum_i k i) k k :=
  Multichannel 0 (shared_input K k) (fun i => (shared_input K k i)^T).
(* Agent i has the outputs of one set of agents, and the shared states of another. *)
Definition extended_rows n (p q : 'I_m -> nat) (S : multichannel K n p q) (k : 'I_m -> nat) (own N : 'I_m -> {set 'I_m}) :=
  direct_sum (neighbor_outputs S own) (neighbor_outputs (shared_system k) N).

Variables (n : nat) (p q k : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (S : multichannel K n p q).
Notation rows := (extended_rows S k N N).
Lemma extended_span i : (mcC (extended N k S) i :=: mcC rows i)%MS.
Proof.
have e1 := stacked_outputs_span S (N i); have e2 := stacked_outputs_span (shared_system k) (N i).
by apply/eqmxP/andP; split; apply: block_sub; rewrite ?e1 ?e2 // -?e1 -?e2.
Qed.
Theorem extended_loops F : exists G, closed_loop rows G = closed_loop (extended N k S) F.
Proof. by apply: same_rows_loops => // i; apply: extended_span. Qed.
Theorem extended_rows_loops F : exists G, closed_loop (extended N k S) G = closed_loop rows F.
Proof. by apply: same_rows_loops => // i; apply: eqmx_sym; apply: extended_span. Qed.
Theorem extended_rows_rank T lambda : \rank (pencil rows T lambda) = \rank (pencil (extended N k S) T lambda).
Proof. by apply: same_rows_rank => // i; apply: extended_span. Qed.
Theorem extended_rows_arc j i : arc rows j i = arc (extended N k S) j i.
Proof. by apply: same_rows_arc => // i'; apply: extended_span. Qed.

(* The same where sub-states alone are shared. *)
Notation own_rows := (extended_rows S k (fun i => [set i]) N).
Lemma extended_states_span i : (mcC (extended_states N k S) i :=: mcC own_rows i)%MS.
Proof.
have e1 : (mcC S i :=: stacked_outputs S [set i])%MS.
  apply: eqmx_trans (stacked_outputs_span _ _); apply: eqmx_sym; apply: eqmx_trans (mxcol_space _ _) _.
  by rewrite big_set1; apply: genmxE.
have e2 := stacked_outputs_span (shared_system k) (N i).
by apply/eqmxP/andP; split; apply: block_sub; rewrite ?e1 ?e2 // -?e1 -?e2.
Qed.
Theorem extended_states_loops F : exists G, closed_loop own_rows G = closed_loop (extended_states N k S) F.
Proof. by apply: same_rows_loops => // i; apply: extended_states_span. Qed.
Theorem own_rows_loops F : exists G, closed_loop (extended_states N k S) G = closed_loop own_rows F.
Proof. by apply: same_rows_loops => // i; apply: eqmx_sym; apply: extended_states_span. Qed.
Theorem own_rows_rank T lambda : \rank (pencil own_rows T lambda) = \rank (pencil (extended_states N k S) T lambda).
Proof. by apply: same_rows_rank => // i; apply: extended_states_span. Qed.
Theorem own_rows_arc j i : arc own_rows j i = arc (extended_states N k S) j i.
Proof. by apply: same_rows_arc => // i'; apply: extended_states_span. Qed.
End Sums.

(* On lists. *)
Definition zdiag (b b' : nat) (M M' : zmat) : zmat := [seq r ++ nseq b' z0 | r <- M] ++ [seq nseq b z0 ++ r | r <- M'].
Definition zsum_channel n n' (c : zchannel * zchannel) : zchannel :=
  ZChannel (zp c.1 + zp c.2) (zq c.1 + zq c.2) (zdiag (zp c.1) (zp c.2) (zB c.1) (zB c.2)) (zdiag n n' (zC c.1) (zC c.2)).
Definition zsum (s s' : zsystem) : zsystem :=
  ZSystem (zn s + zn s') (zD s) (zdiag (zn s) (zn s') (zA s) (zA s')) (map (zsum_channel (zn s) (zn s')) (zip (zchannels s) (zchannels s'))) (zfeed s).
Definition zunits (d : Z) (sizes : seq nat) (i : nat) : zmat :=
  zblock (nth 0%N sizes i) (sumn sizes) [seq zunit d (sumn (take i sizes) + t) | t <- iota 0 (nth 0%N sizes i)].
Definition zshared (d : Z) (sizes : seq nat) : zsystem :=
  ZSystem (sumn sizes) d (zblock (sumn sizes) (sumn sizes) [::])
    (mkseq (fun i => let: (k, C) := (nth 0%N sizes i, zunits d sizes i) in ZChannel k k (ztranspose k (sumn sizes) C) C) (size sizes)) [::].
Definition zextended (s : zsystem) (sizes : seq nat) (own N : seq (seq bool)) : zsystem := zsum (zneighbors s own) (zneighbors (zshared (zD s) sizes) N).

Lemma diagE (R : comRingType) a b a' b' M M' : shape a b M -> shape a' b' M' ->
  mx R (a + a') (b + b') (zdiag b b' M M') = block_mx (mx R a b M) 0 0 (mx R a' b' M').
Proof.
move=> sM sM'; rewrite /zdiag mx_cat ?size_map ?(shape_size sM) // block_mxEv; congr (col_mx _ _); apply/matrixP=> i j.
  case: (split_ordP j) => j' ->; rewrite ?row_mxEl ?row_mxEr !mxE (nth_map [::]) ?(shape_size sM) // nth_cat (row_size sM (ltn_ord i)) /=.
    by rewrite ltn_ord.
  by rewrite ltnNge leq_addr /= nth_nseq if_same.
case: (split_ordP j) => j' ->; rewrite ?row_mxEl ?row_mxEr !mxE (nth_map [::]) ?(shape_size sM') // nth_cat size_nseq /=.
  by rewrite ltn_ord nth_nseq if_same.
by rewrite ltnNge leq_addr /= addKn.
Qed.
Lemma shape_diag a b a' b' M M' : shape a b M -> shape a' b' M' -> shape (a + a') (b + b') (zdiag b b' M M').
Proof.
case/andP=> /eqP sM al /andP[/eqP sM' al']; rewrite /shape /zdiag size_cat !size_map sM sM' eqxx all_cat !all_map /=.
apply/andP; split; [apply: sub_all al | apply: sub_all al'] => r /eqP sr; by rewrite /= size_cat size_nseq sr.
Qed.
Lemma block_nth a b M i j : (i < a)%N -> (j < b)%N -> nth z0 (nth [::] (zblock a b M) i) j = nth z0 (nth [::] M i) j.
Proof.
move=> ia jb; rewrite nth_mkseq // /zwide nth_take // nth_cat nth_nseq if_same.
by case: ifP => // /negbT; rewrite -leqNgt => jM; rewrite [in RHS]nth_default.
Qed.
Lemma zunit_nth (R : comRingType) d u r : phi R (nth z0 (zunit d u) r) = if r == u then phi R d else 0.
Proof.
rewrite /zunit nth_ncons; case: ltngtP => ru //; first by case: (r - u)%N (subn_gt0 u r) => [|t]; rewrite ?ru //= nth_nil.
by rewrite ru subnn.
Qed.

Section Lists.
Variables (K : fieldType) (m : nat).
Theorem sum_represents s s' n n' (p q p' q' : 'I_m -> nat) (S : multichannel K n p q) (S' : multichannel K n' p' q') :
  represents s S -> represents s' S' -> zD s = zD s' -> represents (zsum s s') (direct_sum S S').
Proof.
move=> re re' ed; have [sA sA'] := (represented_A re, represented_A re'); have [en en'] := (re_n re, re_n re').
have [em em'] := (re_m re, re_m re').
have chE i : (i < m)%N -> nth zch0 (zchannels (zsum s s')) i = zsum_channel n n' (nth zch0 (zchannels s) i, nth zch0 (zchannels s') i).
  by move=> im; rewrite (nth_map (zch0, zch0)) ?size_zip -?em -?em' ?minnn // nth_zip -?em -?em' // en en'.
have chE' (i : 'I_m) : channel (zsum s s') i = zsum_channel n n' (channel s i, channel s' i) by apply: chE.
have sBC := represented_channel re; have sBC' := represented_channel re'.
have blockE a b a' b' M M' : shape a b M -> shape a' b' M' ->
    over K (zD s) (a + a') (b + b') (zdiag b b' M M') = block_mx (over K (zD s) a b M) 0 0 (over K (zD s') a' b' M').
  by move=> sM sM'; rewrite /over diagE // scale_block_mx !scaler0 ed.
split=> //=.
- case: (re) => /and4P[D0 feed _ _] *; apply/and4P; split=> //=; first by rewrite -en -en'; apply: shape_diag.
  apply/(all_nthP zch0) => i; rewrite size_map size_zip -em -em' minnn => im.
  have := chE i im; rewrite /= => ->; rewrite -en -en' /sized_channel /=.
  have [sB sC] := sBC (Ordinal im); have [sB' sC'] := sBC' (Ordinal im).
  rewrite (re_p re) in sB; rewrite (re_q re) in sC; rewrite (re_p re') in sB'; rewrite (re_q re') in sC'.
  by apply/andP; split; apply: shape_diag.
- by rewrite en en'.
- by rewrite size_map size_zip -em -em' minnn.
- by move=> i; rewrite chE' /= (re_p re) (re_p re').
- by move=> i; rewrite chE' /= (re_q re) (re_q re').
- by rewrite -en -en' blockE // (re_A re) (re_A re').
- move=> i; have [sB _] := sBC i; have [sB' _] := sBC' i; rewrite chE' /= -(re_p re) -(re_p re') blockE //.
  by rewrite (re_B re) (re_B re').
by move=> i; have [_ sC] := sBC i; have [_ sC'] := sBC' i; rewrite chE' /= blockE // (re_C re) (re_C re').
Qed.

Theorem shared_represents (h : {rmorphism rat -> K}) d sizes : (0 < d)%coqZ -> size sizes = m ->
  represents (zshared d sizes) (shared_system K (fun i : 'I_m => nth 0%N sizes i)).
Proof.
move=> d0 sm; set k := fun i : 'I_m => nth 0%N sizes i.
have sumE : sumn sizes = (\sum_i k i)%N by apply: sumn_ord.
have chE i : (i < m)%N -> nth zch0 (zchannels (zshared d sizes)) i =
    ZChannel (nth 0%N sizes i) (nth 0%N sizes i) (ztranspose (nth 0%N sizes i) (sumn sizes) (zunits d sizes i)) (zunits d sizes i).
  by move=> im; rewrite /= nth_mkseq // sm.
have chE' (i : 'I_m) := chE i (ltn_ord i).
have d1 : phi [comRingType of K] d != 0 by apply: (phi_neq0 h); apply/negP => /Z.eqb_eq z; rewrite z in d0.
have unitE (i : 'I_m) (t : 'I_(k i)) (r : 'I_(\sum_i k i)) :
    phi [comRingType of K] (nth z0 (nth [::] (zunits d sizes i) t) r) = if r == tagnat.Rank i t then phi [comRingType of K] d else 0.
  rewrite /zunits block_nth ?sumE // (nth_map 0%N) ?size_iota // nth_iota // add0n zunit_nth.
  congr (if _ then _ else _); rewrite -(inj_eq val_inj) [val (tagnat.Rank _ _)]tagnat.RankEsum; congr (_ == _ + _)%N.
  rewrite sumn_take ?sm ?(ltnW (ltn_ord i)) //.
  by rewrite (big_ord_widen m (fun l => nth 0%N sizes l) (ltnW (ltn_ord i))).
split=> //=.
- apply/and4P; split=> //; first by apply/Z.ltb_lt.
    exact: shape_block.
  apply/(all_nthP zch0) => i; rewrite size_mkseq => il; rewrite nth_mkseq // /sized_channel /= shape_transpose.
  exact: shape_block.
- by rewrite size_mkseq.
- by move=> i; rewrite /channel chE'.
- by move=> i; rewrite /channel chE'.
- by rewrite sumE /over zblockE mx_nil scaler0.
- move=> i; rewrite /channel chE' /=; apply/matrixP=> r t; rewrite overE transpose_nth ?sumE // unitE !mxE.
  by case: eqP => _; rewrite ?mulVf ?mulr0.
move=> i; rewrite /channel chE' /=; apply/matrixP=> t r; rewrite overE unitE !mxE.
by case: eqP => _; rewrite ?mulVf ?mulr0.
Qed.

Theorem extended_represents (h : {rmorphism rat -> K}) s n (p q : 'I_m -> nat) (S : multichannel K n p q) sizes own N : represents s S ->
  masks s own -> masks s N -> size own = size (zchannels s) -> size N = size (zchannels s) -> size sizes = size (zchannels s) ->
  represents (zextended s sizes own N) (extended_rows S (fun i : 'I_m => nth 0%N sizes i) (sets_of m own) (sets_of m N)).
Proof.
move=> re ok1 ok2 s1 s2 s3; have em := re_m re; have sh := shared_represents h (represented_D re) (etrans s3 (esym em)).
by apply: sum_represents => //; apply: neighbors_represents => //; rewrite ?/masks /= size_mkseq s3.
Qed.
End Lists.
