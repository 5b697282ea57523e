(* Systems with other channels: each agent with the outputs of its neighbors as well, channels merged, some of the
   channels alone, and one that measures the whole state; as definitions, and on lists that represent them.

   `multichannel.augmented_outputs` has zero rows for agents who are not heard.  A list has the rows of those alone who are
   heard: these are other outputs with the same span, with which loops, ranks of pencils and edges are the same. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel pencil_space extended transfer_graph.
From mcexact.kernel Require Import lists systems program_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Outputs of the same span. *)
Section SameRows.
Variables (K : fieldType) (n m : nat) (p q q' : 'I_m -> nat) (S : multichannel K n p q) (S' : multichannel K n p q').
Hypotheses (eA : mcA S' = mcA S) (eB : forall i, mcB S' i = mcB S i) (eC : forall i, (mcC S i :=: mcC S' i)%MS).
Theorem same_rows_loops F : exists G, closed_loop S' G = closed_loop S F.
Proof.
exists (fun i => F i *m (mcC S i *m pinvmx (mcC S' i))); rewrite /closed_loop eA; congr (_ + _); apply: eq_bigr => i _.
rewrite /= eB; have {2}<- := mulmxKpV (_ : (mcC S i <= mcC S' i)%MS); last by rewrite eC.
by rewrite !mulmxA.
Qed.
Theorem same_rows_rank T lambda : \rank (pencil S' T lambda) = \rank (pencil S T lambda).
Proof.
rewrite /pencil eA; apply: rank_block_eq.
  by have -> : inputs S' (~: T) = inputs S (~: T) by apply: eq_mxrow => i; rewrite eB.
apply: eqmx_trans (eqmx_outputs _ _) _; apply: eqmx_sym; apply: eqmx_trans (eqmx_outputs _ _) _.
exact: (span_eqmx (fun i _ => eC i)).
Qed.
Lemma same_rows_sub (X : 'M[K]_n) i : mcC S' i *m X = 0 -> mcC S i *m X = 0.
Proof. by move=> z; have /submxP[D ->] : (mcC S i <= mcC S' i)%MS by [rewrite eC]; rewrite -mulmxA z mulmx0. Qed.
Lemma same_rows_transfer j i : transfer (mcA S) (mcB S j) (mcC S' i) = 0 -> transfer (mcA S) (mcB S j) (mcC S i) = 0.
Proof.
rewrite /transfer => z; have /submxP[D ->] : (mcC S i <= mcC S' i)%MS by rewrite eC.
by rewrite map_mxM -!mulmxA mulmxA in z *; rewrite -mulmxA (mulmxA (map_mx polyC (mcC S' i))) z mulmx0.
Qed.
End SameRows.
Theorem same_rows_arc (K : fieldType) n m (p q q' : 'I_m -> nat) (S : multichannel K n p q) (S' : multichannel K n p q') :
  mcA S' = mcA S -> (forall i, mcB S' i = mcB S i) -> (forall i, (mcC S i :=: mcC S' i)%MS) -> forall j i, arc S' j i = arc S j i.
Proof.
move=> eA eB eC j i; rewrite /arc eA eB; congr (~~ _); apply/eqP/eqP; first exact: (same_rows_transfer eC).
by rewrite -eA -eB; apply: same_rows_transfer => i'; apply: eqmx_sym.
Qed.

Section Stacked.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Definition many (d : 'I_m -> nat) (T : {set 'I_m}) : nat := (\sum_(j < #|T|) d (enum_val j))%N.
Definition stacked_inputs T : 'M[K]_(n, many p T) := \mxrow_(j < #|T|) mcB S (enum_val j).
Definition stacked_outputs T : 'M[K]_(many q T, n) := \mxcol_(j < #|T|) mcC S (enum_val j).
Definition neighbor_outputs (N : 'I_m -> {set 'I_m}) : multichannel K n p (fun i => many q (N i)) :=
  Multichannel (mcA S) (mcB S) (fun i => stacked_outputs (N i)).
Definition merged r (T : 'I_r -> {set 'I_m}) : multichannel K n (fun k => many p (T k)) (fun k => many q (T k)) :=
  Multichannel (mcA S) (fun k => stacked_inputs (T k)) (fun k => stacked_outputs (T k)).
Definition restricted T : multichannel K n (fun k : 'I_#|T| => p (enum_val k)) (fun k => q (enum_val k)) :=
  Multichannel (mcA S) (fun k => mcB S (enum_val k)) (fun k => mcC S (enum_val k)).
Definition whole_or_own (b : bool) d (C : 'M[K]_(d, n)) : 'M[K]_(if b then n else d, n) :=
  if b as b' return 'M[K]_(if b' then n else d, n) then 1%:M else C.
Definition full_output (k : nat) : multichannel K n p (fun i => if i == k :> nat then n else q i) :=
  Multichannel (mcA S) (mcB S) (fun i => whole_or_own (i == k :> nat) (mcC S i)).

Lemma stacked_outputs_span T : (outputs S T :=: stacked_outputs T)%MS.
Proof.
apply: eqmx_trans (eqmx_outputs _ _) _; apply: eqmx_sym; apply: eqmx_trans (eqmx_col _) _.
apply/eqmxP/andP; split; apply/sumsmx_subP => i iT; rewrite genmxE.
  by apply: (sumsmx_sup (enum_val i)); rewrite ?enum_valP ?genmxE.
by apply: (sumsmx_sup (enum_rank_in iT i)) => //; rewrite genmxE enum_rankK_in.
Qed.
(* The rows of the neighbors instead of zero rows as well: loops, ranks and edges are the same. *)
Theorem augmented_loops N F : exists G, closed_loop (neighbor_outputs N) G = closed_loop (augmented_outputs N S) F.
Proof. by apply: same_rows_loops => // i; apply: stacked_outputs_span. Qed.
Theorem neighbor_loops N F : exists G, closed_loop (augmented_outputs N S) G = closed_loop (neighbor_outputs N) F.
Proof. by apply: same_rows_loops => // i; apply: eqmx_sym; apply: stacked_outputs_span. Qed.
Theorem neighbor_rank N T lambda : \rank (pencil (neighbor_outputs N) T lambda) = \rank (pencil (augmented_outputs N S) T lambda).
Proof. by apply: same_rows_rank => // i; apply: stacked_outputs_span. Qed.
Theorem neighbor_arc N j i : arc (neighbor_outputs N) j i = arc (augmented_outputs N S) j i.
Proof. by apply: same_rows_arc => // k; apply: stacked_outputs_span. Qed.
End Stacked.

(* On lists: sets of channels are masks, one entry for each channel. *)
Definition zbeside n (Ms : seq zmat) : zmat := mkseq (fun i => flatten [seq nth [::] M i | M <- Ms]) n.
Definition zstacked (chs : seq zchannel) : zmat := flatten [seq zC ch | ch <- chs].
Definition zwith_outputs (chs : seq zchannel) (ch : zchannel) : zchannel := ZChannel (zp ch) (sumn [seq zq c | c <- chs]) (zB ch) (zstacked chs).
Definition zneighbors (s : zsystem) (N : seq (seq bool)) : zsystem :=
  ZSystem (zn s) (zD s) (zA s) [seq zwith_outputs (mask cN.2 (zchannels s)) cN.1 | cN <- zip (zchannels s) N] (zfeed s).
Definition zjoined n (chs : seq zchannel) : zchannel :=
  ZChannel (sumn [seq zp c | c <- chs]) (sumn [seq zq c | c <- chs]) (zbeside n [seq zB c | c <- chs]) (zstacked chs).
Definition zmerged (s : zsystem) (Ts : seq (seq bool)) : zsystem :=
  ZSystem (zn s) (zD s) (zA s) [seq zjoined (zn s) (mask T (zchannels s)) | T <- Ts] (zfeed s).
Definition zrestricted (s : zsystem) (T : seq bool) : zsystem := ZSystem (zn s) (zD s) (zA s) (mask T (zchannels s)) (zfeed s).
Definition zfull_output (s : zsystem) (k : nat) : zsystem :=
  ZSystem (zn s) (zD s) (zA s)
    (mkseq (fun i => let ch := nth zch0 (zchannels s) i in
       if i == k then ZChannel (zp ch) (zn s) (zB ch) (zblock (zn s) (zn s) (zidentity (zD s) (zn s))) else ch) (size (zchannels s))) (zfeed s).
Definition sets_of (m : nat) (Ts : seq (seq bool)) (i : nat) : {set 'I_m} := masked (nth [::] Ts i) m.

Lemma mx_beside (R : comRingType) n m (k : 'I_m -> nat) (Ms : seq zmat) : size Ms = m -> (forall i : 'I_m, shape n (k i) (nth [::] Ms i)) ->
  mx R n (\sum_i k i) (zbeside n Ms) = \mxrow_i mx R n (k i) (nth [::] Ms i).
Proof.
move=> sm sk; apply/matrixP=> i r; rewrite !mxE nth_mkseq //; congr (phi _ _).
rewrite (@nth_flatten_sig _ _ _ k) ?size_map // => [|t]; first by rewrite (nth_map [::]) // sm.
by rewrite (nth_map [::]) ?sm // (row_size (sk t)).
Qed.
Lemma shape_beside n m (k : 'I_m -> nat) (Ms : seq zmat) : size Ms = m -> (forall i : 'I_m, shape n (k i) (nth [::] Ms i)) ->
  shape n (\sum_i k i) (zbeside n Ms).
Proof.
move=> sm sk; rewrite /shape size_mkseq eqxx; apply/(all_nthP [::]) => i; rewrite size_mkseq => il.
rewrite nth_mkseq // size_flatten (sumn_ord (m := m) (k := k)) ?size_map // => t.
by rewrite (nth_map [::]) ?size_map ?sm // (nth_map [::]) ?sm // (row_size (sk t)).
Qed.

Section Lists.
Variables (K : fieldType) (s : zsystem) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Notation chs := (zchannels s).
Let en := re_n re.
Let em := re_m re.

Section Mask.
Variables (T : seq bool).
Hypothesis sT : size T = m.
Notation C := (mask T chs).
Lemma chosen_size : size C = #|masked T m|. Proof. by rewrite card_masked // size_mask // sT. Qed.
Lemma chosen_nth (j : 'I_#|masked T m|) : nth zch0 C j = channel s (enum_val j).
Proof.
have jl : (j < count id T)%N by rewrite -(card_masked sT).
by rewrite (nth_mask_states zch0 sT _ jl) -?em // -(enum_val_masked sT).
Qed.
Lemma chosen_map (X : Type) (x : X) (f : zchannel -> X) (j : 'I_#|masked T m|) : nth x (map f C) j = f (channel s (enum_val j)).
Proof. by rewrite (nth_map zch0) ?chosen_size // chosen_nth. Qed.
Lemma stacked_q : sumn [seq zq c | c <- C] = many q (masked T m).
Proof. by apply: sumn_ord => [|j]; rewrite ?size_map ?chosen_size // chosen_map (re_q re). Qed.
Lemma stacked_p : sumn [seq zp c | c <- C] = many p (masked T m).
Proof. by apply: sumn_ord => [|j]; rewrite ?size_map ?chosen_size // chosen_map (re_p re). Qed.
Lemma stackedE : over K (zD s) (many q (masked T m)) n (zstacked C) = stacked_outputs S (masked T m).
Proof.
rewrite /over /zstacked (@mx_flatten _ _ (fun j : 'I_#|masked T m| => q (enum_val j))) ?size_map ?chosen_size // => [|j].
  by rewrite scale_mxcol; apply: eq_mxcol => j; rewrite chosen_map (re_C re).
by rewrite chosen_map (shape_size (represented_channel re _).2).
Qed.
Lemma shape_stacked : shape (many q (masked T m)) n (zstacked C).
Proof.
rewrite /shape /zstacked size_flatten; apply/andP; split.
  apply/eqP; apply: sumn_ord => [|j]; first by rewrite !size_map chosen_size.
  by rewrite (nth_map [::]) ?size_map ?chosen_size // chosen_map (shape_size (represented_channel re _).2).
apply: all_flatten; rewrite all_map; apply/(all_nthP zch0) => i; rewrite chosen_size => il.
by rewrite /= (chosen_nth (Ordinal il)); case/andP: (represented_channel re (enum_val (Ordinal il))).2.
Qed.
Let shape_B (j : 'I_#|masked T m|) : shape n (p (enum_val j)) (nth [::] [seq zB c | c <- C] j).
Proof. by rewrite chosen_map; apply: (represented_channel re _).1. Qed.
Lemma besideE : over K (zD s) n (many p (masked T m)) (zbeside n [seq zB c | c <- C]) = stacked_inputs S (masked T m).
Proof.
rewrite /over (@mx_beside _ _ _ (fun j : 'I_#|masked T m| => p (enum_val j))) ?size_map ?chosen_size //.
apply/matrixP=> i r; rewrite !mxE; set j := tagnat.sig1 r.
by have := re_B re (enum_val j); rewrite chosen_map => ->; rewrite !mxE.
Qed.
Lemma shape_beside_chosen : shape n (many p (masked T m)) (zbeside n [seq zB c | c <- C]).
Proof. by apply: (shape_beside (k := fun j : 'I_#|masked T m| => p (enum_val j))); rewrite ?size_map ?chosen_size. Qed.
End Mask.

Definition masks (Ts : seq (seq bool)) : bool := all (fun T : seq bool => size T == size chs) Ts.
Lemma masks_size Ts i : masks Ts -> (i < size Ts)%N -> size (nth [::] Ts i) = m.
Proof. by move=> /(all_nthP [::]) ok /ok /eqP ->. Qed.
Let base : [&& Z.ltb 0 (zD s), zmat0 (zfeed s) & shape n n (zA s)].
Proof. by case: (re) => /and4P[-> -> sA _] *; rewrite en. Qed.
Let sized chs' : (forall i, (i < size chs')%N -> sized_channel n (nth zch0 chs' i)) -> sized_system (ZSystem (zn s) (zD s) (zA s) chs' (zfeed s)).
Proof.
by move=> ok; case/and3P: base => D0 feed sA; apply/and4P; split=> //=; rewrite -en //; apply/(all_nthP zch0).
Qed.

Theorem neighbors_represents N : masks N -> size N = size chs -> represents (zneighbors s N) (neighbor_outputs S (sets_of m N)).
Proof.
move=> ok sN; have sT i : (i < m)%N -> size (nth [::] N i) = m by move=> im; apply: masks_size; rewrite // sN -em.
have nthE i : (i < m)%N -> nth zch0 (zchannels (zneighbors s N)) i = zwith_outputs (mask (nth [::] N i) chs) (nth zch0 chs i).
  by move=> im; rewrite (nth_map (zch0, [::])) ?size_zip ?sN ?minnn -?em // nth_zip // sN.
have chE (k : 'I_m) : channel (zneighbors s N) k = zwith_outputs (mask (nth [::] N k) chs) (channel s k) by apply: nthE.
split=> //=.
- apply: sized => i; rewrite size_map size_zip sN minnn -em => im; rewrite [nth _ _ _](nthE i im) /sized_channel /=.
  by rewrite (stacked_q (sT i im)) (shape_stacked (sT i im)) andbT -(re_p re (Ordinal im)); apply: (represented_channel re (Ordinal im)).1.
- by rewrite size_map size_zip sN minnn.
- by move=> k; rewrite chE (re_p re).
- by move=> k; rewrite chE /= stacked_q ?sT.
- exact: (re_A re).
- by move=> k; rewrite chE /= (re_B re).
by move=> k; rewrite chE /= stackedE ?sT.
Qed.
Theorem merged_represents Ts : masks Ts -> represents (zmerged s Ts) (merged S (fun k : 'I_(size Ts) => sets_of m Ts k)).
Proof.
move=> ok; have sT := masks_size ok.
have nthE i : (i < size Ts)%N -> nth zch0 (zchannels (zmerged s Ts)) i = zjoined n (mask (nth [::] Ts i) chs).
  by move=> ir; rewrite (nth_map [::]) // en.
have chE (k : 'I_(size Ts)) : channel (zmerged s Ts) k = zjoined n (mask (nth [::] Ts k) chs) by apply: nthE.
split=> //=.
- apply: sized => i; rewrite size_map => ir; rewrite [nth _ _ _](nthE i ir) /sized_channel /=.
  by rewrite (stacked_q (sT i ir)) (stacked_p (sT i ir)) (shape_stacked (sT i ir)) (shape_beside_chosen (sT i ir)).
- by rewrite size_map.
- by move=> k; rewrite chE /= stacked_p ?sT.
- by move=> k; rewrite chE /= stacked_q ?sT.
- exact: (re_A re).
- by move=> k; rewrite chE /= besideE ?sT.
by move=> k; rewrite chE /= stackedE ?sT.
Qed.
Theorem restricted_represents T : size T = size chs -> represents (zrestricted s T) (restricted S (masked T m)).
Proof.
move=> sT0; have sT : size T = m by rewrite em.
have chE (k : 'I_#|masked T m|) : channel (zrestricted s T) k = channel s (enum_val k) by apply: chosen_nth.
split=> //=.
- apply: sized => i; rewrite (chosen_size sT) => ir; rewrite (chosen_nth sT (Ordinal ir)) /sized_channel -(re_p re) -(re_q re).
  by have [-> ->] := represented_channel re (enum_val (Ordinal ir)).
- by rewrite (chosen_size sT).
- by move=> k; rewrite chE (re_p re).
- by move=> k; rewrite chE (re_q re).
- exact: (re_A re).
- by move=> k; rewrite chE (re_B re).
by move=> k; rewrite chE (re_C re).
Qed.
Theorem full_output_represents (h : {rmorphism rat -> K}) k : represents (zfull_output s k) (full_output S k).
Proof.
have chE i : (i < m)%N -> nth zch0 (zchannels (zfull_output s k)) i = let ch := nth zch0 chs i in
    if i == k then ZChannel (zp ch) (zn s) (zB ch) (zblock (zn s) (zn s) (zidentity (zD s) (zn s))) else ch.
  by move=> im; rewrite /= nth_mkseq // -em.
have chE' (i : 'I_m) := chE i (ltn_ord i).
have d1 : phi [comRingType of K] (zD s) != 0.
  by apply: (phi_neq0 h); apply/negP => /Z.eqb_eq z; have := represented_D re; rewrite z.
split=> //=.
- apply: sized => i; rewrite size_mkseq => im0; have im : (i < m)%N by rewrite em.
  rewrite nth_mkseq //=.
  have [sB sC] := represented_channel re (Ordinal im); rewrite (re_p re) in sB; rewrite (re_q re) in sC.
  case: ifP => _; rewrite /sized_channel /=; apply/andP; split=> //.
  by rewrite -en shape_block.
- by rewrite size_mkseq.
- by move=> i; rewrite /channel chE' (re_p re) /=; case: ifP.
- by move=> i; rewrite /channel chE' /= -en (re_q re) /=; case: ifP.
- exact: (re_A re).
- by move=> i; rewrite /channel chE' (re_B re) /=; case: ifP.
move=> i; rewrite /channel chE' /=; case: eqP => _ /=; last exact: (re_C re).
rewrite -en /over zblockE; apply/matrixP=> a b; rewrite !mxE (nth_map 0%N) ?size_iota // nth_iota // add0n /zunit nth_ncons.
case: ltngtP => ab.
- by rewrite phi0 mulr0 -val_eqE /= gtn_eqF.
- by rewrite (_ : (a == b) = false) -?val_eqE ?ltn_eqF //; case: (b - a)%N (subn_gt0 a b) => [|t]; rewrite ?ab //= nth_nil phi0 mulr0.
by rewrite ab subnn /= mulVf // -val_eqE /= ab eqxx.
Qed.
End Lists.
