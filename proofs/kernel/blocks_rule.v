(* Rule Blocks, checker/core/evidence.py, split: the bounds of blocks of states add up, where no closed loop leads from a
   block to a later one.  A block is a system of its own, cut out of the lists. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel fixed_bound blocks.
From mcexact.kernel Require Import lists systems.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Definition nonzero (r : zrow) : bool := has (fun x => ~~ Z.eqb x 0) r.
(* The entries of a row that are not 0 are those of states in the block k and later ones. *)
Definition row_after (k : nat) (blk : seq nat) (r : zrow) : bool := all (fun kx => (k <= kx.1)%N || Z.eqb kx.2 0) (zip blk r).
(* The last block on which an input acts. *)
Definition moved (blk : seq nat) (B : zmat) : nat := foldr (fun kr acc => if nonzero kr.2 then maxn kr.1 acc else acc) 0%N (zip blk B).
(* blk is the block of each state. *)
Definition check_order (s : zsystem) (blk : seq nat) : bool :=
  [&& size blk == zn s, all (fun kr => row_after kr.1 blk kr.2) (zip blk (zA s)) &
      all (fun ch => let k := moved blk (zB ch) in all (row_after k blk) (zC ch)) (zchannels s)].
(* The states of one block. *)
Definition block_mask (blk : seq nat) (k : nat) : seq bool := [seq b == k | b <- blk].

Lemma moved_max blk B a u : (a < size blk)%N -> (a < size B)%N -> nth z0 (nth [::] B a) u <> z0 -> (nth 0%N blk a <= moved blk B)%N.
Proof.
rewrite /moved; elim: blk B a => [|k blk IH] [|r B] [|a] //=; last first.
  move=> sa sB nz; have := IH B a sa sB nz; case: ifP => // _ h; by rewrite leq_max h orbT.
move=> _ _ nz; have -> : nonzero r.
  apply/(has_nthP z0); have [us|us] := ltnP u (size r); last by case: nz; rewrite nth_default.
  by exists u => //; apply/negP => /Z.eqb_eq.
by rewrite leq_maxl.
Qed.
Lemma row_afterP k blk r b : row_after k blk r -> (b < size blk)%N -> (b < size r)%N -> nth z0 r b <> z0 -> (k <= nth 0%N blk b)%N.
Proof.
elim: blk r b => [|k' blk IH] [|x r] [|b] //= /andP[h1 h2] sb sr nz; last exact: (IH r b h2 sb sr nz).
by case/orP: h1 => // /Z.eqb_eq.
Qed.

Theorem check_order_sound (K : fieldType) s blk n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> check_order s blk -> triangular S (fun a : 'I_n => nth 0%N blk a).
Proof.
move=> re; have sA := represented_A re; have sBC := represented_channel re; case: (re) => _ en em ep eq eA eB eC.
case/and3P=> /eqP sb okA okC; rewrite -en in sb.
have nz d z : (phi [comRingType of K] d)^-1 * phi [comRingType of K] z != 0 -> z <> z0.
  by move=> ne e; move: ne; rewrite e phi0 mulr0 eqxx.
split=> [a b|k a b u v].
  rewrite eA overE => /nz ne; have /(all_nthP (0%N, [::])) := okA; move/(_ a); rewrite size_zip sb (shape_size sA) minnn ltn_ord => /(_ isT).
  by rewrite nth_zip ?sb ?(shape_size sA) //= => /row_afterP; apply; rewrite ?sb ?(row_size sA).
rewrite eB eC !overE => /nz nB /nz nC; have [sB sC] := sBC k.
have km : (k < size (zchannels s))%N by rewrite -em.
have /(all_nthP zch0) := okC; move/(_ k km) => /= /(all_nthP [::])/(_ v); rewrite -/(channel s k).
rewrite (shape_size sC) ltn_ord => /(_ isT) /row_afterP rw.
apply: leq_trans (rw b _ _ nC); [apply: (@moved_max _ _ _ u) => // | |]; by rewrite ?sb ?(shape_size sB) ?(row_size sC).
Qed.

Theorem blocks_sound (K : fieldType) s blk r (f : nat -> nat) n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> all (fun k => k < r)%N blk -> check_order s blk ->
  (forall i, (i < r)%N -> forall n' (S' : multichannel K n' p q), represents (zpart s (block_mask blk i)) S' -> bounded S' (f i)) ->
  bounded S (\sum_(i < r) f i)%N.
Proof.
move=> re /(all_nthP 0%N) few ok fE; have tri := check_order_sound re ok.
have /and3P[/eqP sb _ _] := ok; have en := re_n re; rewrite -en in sb.
have few' (a : 'I_n) : (nth 0%N blk a < r)%N by apply: few; rewrite sb.
apply: (block_bounded tri few') => k.
have sm : size (block_mask blk k) = n by rewrite size_map.
have := fE k (ltn_ord k) _ _ (part_represents re sm).
suff -> : masked (block_mask blk k) n = [set a : 'I_n | nth 0%N blk a == k] by [].
by apply/setP=> a; rewrite !inE (nth_map 0%N) // sb.
Qed.
