(* checker/sharing.py: cuts and the branch tree.

   Variables n_i (shared dimensions, or z_ji in {0, 1} for arcs) are natural numbers within bounds; a cut
   says sum_{i in boundary} n_i >= depth.  The tree proves that no choice costs less than `opt`.
   The rounding is to multiples of 1/D, with D w_i and D opt integers: opt < bound + 1/D says that
   the bound, rounded up, is at least opt. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Covering.
Variables (I J : finType) (boundary : J -> {set I}) (depth : J -> nat) (w : I -> rat).

Inductive tree :=
  | Split of I & nat & tree & tree           (* n_i <= k below, n_i >= k + 1 above *)
  | Violated of J                            (* the upper bounds violate this cut *)
  | Multipliers of (J -> rat).               (* nonnegative multipliers of the cuts *)

Definition within (lo : I -> nat) (up : I -> option nat) (x : I -> nat) :=
  forall i, (lo i <= x i)%N /\ (forall u, up i = Some u -> (x i <= u)%N).
Definition covers (x : I -> nat) := forall c, (depth c <= \sum_(i in boundary c) x i)%N.
Definition cost (x : I -> nat) : rat := \sum_i w i * (x i)%:R.

Definition update A (f : I -> A) i a : I -> A := fun j => if j == i then a else f j.
Definition lower (u : option nat) k := Some (if u is Some u' then minn u' k else k).

Definition violated (up : I -> option nat) c :=
  [forall i in boundary c, up i != None] && (\sum_(i in boundary c) odflt 0 (up i) < depth c)%N.

(* r_i, what the multipliers leave of the cost of i. *)
Definition reduced (y : J -> rat) i : rat := w i - \sum_(c | i \in boundary c) y c.
Definition part (lo : I -> nat) (up : I -> option nat) y i : rat :=
  if 0 <= reduced y i then reduced y i * (lo i)%:R else reduced y i * (odflt 0%N (up i))%:R.
Definition bound (lo : I -> nat) (up : I -> option nat) (y : J -> rat) : rat := \sum_c y c * (depth c)%:R + \sum_i part lo up y i.
Definition leaf (up : I -> option nat) (y : J -> rat) := [forall c, 0 <= y c] && [forall i, (0 <= reduced y i) || (up i != None)].

Fixpoint checks D opt lo up t : bool := match t with
  | Split i k below above => checks D opt lo (update up i (lower (up i) k)) below
      && checks D opt (update lo i (maxn (lo i) k.+1)) up above
  | Violated c => violated up c
  | Multipliers y => leaf up y && (opt < bound lo up y + (D%:R)^-1) end.

(* When not feasible, every leaf is violated. *)
Fixpoint refutes lo up t : bool := match t with
  | Split i k below above => refutes lo (update up i (lower (up i) k)) below
      && refutes (update lo i (maxn (lo i) k.+1)) up above
  | Violated c => violated up c
  | Multipliers y => false end.

Lemma within_split lo up x i k : within lo up x ->
  within lo (update up i (lower (up i) k)) x \/ within (update lo i (maxn (lo i) k.+1)) up x.
Proof.
move=> wx; have [xk|kx] := leqP (x i) k; [left | right] => j; have [lj uj] := wx j.
  split=> // u; rewrite /update; case: eqP => [->|_ /uj//] [<-].
  rewrite /lower; case e: (up i) => [u'|//]; rewrite leq_min xk andbT.
  by have [_] := wx i; apply.
by split=> //; rewrite /update; case: eqP => [->|//]; rewrite geq_max kx andbT; case: (wx i).
Qed.

Lemma violated_sound lo up x c : within lo up x -> covers x -> ~~ violated up c.
Proof.
move=> wx /(_ c) cx; rewrite /violated negb_and -leqNgt; apply/orP.
have [/forall_inP all|] := boolP [forall i in boundary c, up i != None]; last by left.
right; apply: leq_trans cx _; apply: leq_sum => i /all; case e: (up i) => [u|//] _.
by have [_] := wx i; apply.
Qed.

(* Weak duality at a leaf: the bound is at most the cost. *)
Lemma bound_sound lo up y x : leaf up y -> within lo up x -> covers x ->
  bound lo up y <= cost x.
Proof.
case/andP=> /forallP y0 /forallP b0 wx cx.
have -> : cost x = \sum_c y c * (\sum_(i in boundary c) x i)%:R + \sum_i reduced y i * (x i)%:R.
  have -> : \sum_c y c * (\sum_(i in boundary c) x i)%:R =
            \sum_i (\sum_(c | i \in boundary c) y c) * (x i)%:R.
    under eq_bigr => c _ do rewrite natr_sum mulr_sumr.
    rewrite (exchange_big_dep predT)//=; apply: eq_bigr => i _.
    by rewrite mulr_suml.
  rewrite -big_split; apply: eq_bigr => i _ /=.
  by rewrite -mulrDl /reduced addrC subrK.
apply: ler_add.
  by apply: ler_sum => c _; rewrite ler_wpmul2l// ler_nat.
apply: ler_sum => i _; have [lx ux] := wx i; rewrite /part.
have [r0|r0] := boolP (0 <= reduced y i); first by rewrite ler_wpmul2l// ler_nat.
have := b0 i; rewrite (negPf r0) /=; case e: (up i) => [u|//] _ /=.
by rewrite ler_wnmul2l ?ler_nat ?ux// ltW// ltNge.
Qed.

(* Rule "branch tree". *)
Theorem branch_tree D opt lo up t x : (0 < D)%N ->
  (forall i, exists z : int, D%:R * w i = z%:~R) -> (exists z : int, D%:R * opt = z%:~R) ->
  checks D opt lo up t -> within lo up x -> covers x -> opt <= cost x.
Proof.
move=> D0 wz [zo eo]; elim: t lo up => [i k b IHb a IHa|c|y] lo up /=.
- by case/andP=> /IHb hb /IHa ha /(within_split i k)[].
- by move=> v wx cx; have := violated_sound c wx cx; rewrite v.
case/andP=> lf lt wx cx; have := lt_le_trans lt (ler_add (bound_sound lf wx cx) (lexx _)).
have D1 : 0 < D%:R :> rat by rewrite ltr0n.
rewrite -(ltr_pmul2l D1) -(ler_pmul2l D1) mulrDr mulfV ?gt_eqF// eo.
have [z ez] : exists z : int, D%:R * cost x = z%:~R.
  have /fin_all_exists[f ef] := wz; exists (\sum_i f i * (x i)%:Z).
  rewrite /cost mulr_sumr rmorph_sum; apply: eq_bigr => i _.
  by rewrite mulrA ef rmorphM.
by rewrite ez -[1]/(1%:~R) -rmorphD /= ltr_int ler_int ltz_addr1.
Qed.

(* Not feasible: no choice within the bounds satisfies the cuts. *)
Theorem branch_tree_infeasible lo up t x : refutes lo up t -> within lo up x -> ~ covers x.
Proof.
elim: t lo up => [i k b IHb a IHa|c|y] lo up //=.
  by case/andP=> /IHb hb /IHa ha /(within_split i k)[].
by move=> v wx cx; have := violated_sound c wx cx; rewrite v.
Qed.
End Covering.

(* checker/sharing.py: a shrunk subspace over the given graph survives every added arc that does
   not break it, that is as long as what each channel outside T hears vanishes on U. *)
Section Communication.
Variables (L : fieldType) (n m : nat) (p q q' : 'I_m -> nat).

Theorem communication_cut (S : multichannel L n p q) (heard : forall i, 'M[L]_(q' i, n)) lambda T u
    (U : 'M[L]_(n, u)) (V : 'M[L]_(\sum_i p i, u)) :
  shrunk S lambda T U V -> \rank U = u -> (\rank (inputs S T) < u)%N ->
  (forall i, i \notin T -> heard i *m U = 0) ->
  fixed (Multichannel (mcA S) (mcB S) heard) lambda.
Proof.
move=> [e _] fU r z F; rewrite eigenvalue_rank.
have sh : shrunk (Multichannel (mcA S) (mcB S) heard) lambda T U V by split.
by rewrite -addn1; apply: (shrunk_rank sh fU F); rewrite addn1.
Qed.
End Communication.
