(* checker/core/evidence.py: a shrunk subspace of the system of some states Z is one of the whole system, if the states D
   that Z drives do not act on Z.

   In the order D, Z, others, with N = xI - A and U, V the shrunk subspace of Z:

       [N_D  *    *  ] [I  0]   [I  0   ]
       [0    N_Z  *  ] [0  U] = [0  B_TZ] [N_D  *]
       [0    0    *  ] [0  0]   [0  0   ] [0    V]    modulo p. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence blocks.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* Some of the channels by themselves: of the others those in T do not act, and those outside T see nothing. *)
Section Channels.
Variables (K : fieldType) (n m m' : nat) (p q : 'I_m -> nat) (S : multichannel K n p q) (f : 'I_m' -> 'I_m).
Definition some_channels : multichannel K n (fun j => p (f j)) (fun j => q (f j)) :=
  Multichannel (mcA S) (fun j => mcB S (f j)) (fun j => mcC S (f j)).

Variables (P : {poly K}) (T' : {set 'I_m'}) (T : {set 'I_m}) (d : nat).
Hypothesis acting : forall i, i \in T -> mcB S i = 0 \/ exists2 j, j \in T' & f j = i.
Hypothesis seeing : forall i, i \notin T -> mcC S i = 0 \/ exists2 j, j \notin T' & f j = i.

Theorem shrunk_subspace_channels : shrunk_subspace some_channels P T' d -> shrunk_subspace S P T d.
Proof.
move=> E; apply: (@ShrunkSubspace _ _ _ _ _ S P T d _ _ (sh_Y E) (sh_U E) (sh_V E) (@sh_pivots _ _ _ _ _ _ _ _ _ E)).
- have /inputs_within within := sh_inputs E.
  apply/inputs_within => i /acting[->|[j /within /= wj <-]]; last exact: wj.
  by exists 0; rewrite mulmx0.
- exact: (@sh_state _ _ _ _ _ _ _ _ _ E).
- move=> i /seeing[->|[j jT <-]]; last exact: (@sh_output _ _ _ _ _ _ _ _ _ E j jT).
  by rewrite map_mx0 mul0mx => a b; rewrite mxE dvdp0.
- exact: (@sh_identity _ _ _ _ _ _ _ _ _ E).
exact: (sh_count E).
Qed.
End Channels.

Section Selection.
Variables (R : comRingType) (n : nat).

(* The columns of the identity for some states. *)
Definition columns (c : {set 'I_n}) : 'M[R]_(n, #|c|) := \matrix_(a, k) (a == enum_val k)%:R.

Lemma columnsE c m (M : 'M[R]_(n, m)) a j :
  (columns c *m rowsub enum_val M) a j = if a \in c then M a j else 0.
Proof.
rewrite mxE; pose g b := (a == b)%:R * M b j.
have -> : \sum_k columns c a k * (rowsub enum_val M : 'M_(#|c|, m)) k j = \sum_(k < #|c|) g (enum_val k).
  by apply: eq_bigr => k _; rewrite !mxE.
rewrite -(big_enum_val g); case: ifP => [ac|ac].
  rewrite (bigD1 a)//= big1 ?addr0 => [|b /andP[_ ba]]; first by rewrite /g eqxx mul1r.
  by rewrite /g eq_sym (negPf ba) mul0r.
rewrite big1// => b bc; rewrite /g; case: eqVneq => [e|_]; last by rewrite mul0r.
by rewrite e bc in ac.
Qed.

Lemma mul_columns c m (M : 'M[R]_(m, n)) : M *m columns c = colsub enum_val M.
Proof.
apply/matrixP => i k; rewrite !mxE (bigD1 (enum_val k))//= big1 => [|b bk].
  by rewrite mxE eqxx mulr1 addr0.
by rewrite mxE (negPf bk) mulr0.
Qed.

(* A matrix whose other rows are 0. *)
Lemma columns_split (Z D : {set 'I_n}) m (M : 'M[R]_(n, m)) : (forall a, a \in D -> a \notin Z) ->
  (forall a j, a \notin Z -> a \notin D -> M a j = 0) ->
  M = columns D *m rowsub enum_val M + columns Z *m rowsub enum_val M.
Proof.
move=> apart z; apply/matrixP => a j; rewrite mxE !columnsE.
have [aD|aD] := boolP (a \in D); first by rewrite (negPf (apart _ aD)) addr0.
by rewrite add0r; case: ifPn => // aZ; apply: z.
Qed.
End Selection.

Section Local.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Variables (P : {poly K}) (T : {set 'I_m}) (d : nat) (Z D : {set 'I_n}).
Hypothesis apart : forall a, a \in D -> a \notin Z.
Hypothesis closed : forall a b, a \notin D -> b \in D -> mcA S a b = 0.
Hypothesis driven : forall a b, a \notin Z -> a \notin D -> b \in Z -> mcA S a b = 0.
Hypothesis acting : forall i a u, i \in T -> a \notin Z -> a \notin D -> mcB S i a u = 0.
Hypothesis unseen : forall i v b, i \notin T -> b \in D -> mcC S i v b = 0.

Section Within.
Variable E : shrunk_subspace (restrict S Z) P T d.
Notation constant M := (map_mx polyC M).
Let N : 'M[{poly K}]_n := 'X%:M - constant (mcA S).
Let ED := columns [comRingType of {poly K}] D.
Let EZ := columns [comRingType of {poly K}] Z.

Lemma constant_columns (c : {set 'I_n}) : constant (columns K c) = columns [comRingType of {poly K}] c.
Proof. by apply/matrixP => a k; rewrite !mxE rmorph_nat. Qed.

Lemma state_entry a b : a != b -> mcA S a b = 0 -> N a b = 0.
Proof. by move=> ab e; rewrite !mxE (negPf ab) e polyC0 subr0. Qed.

Lemma state_D : N *m ED = ED *m rowsub enum_val (N *m ED).
Proof.
have z a k : a \notin D -> (N *m ED) a k = 0.
  rewrite mul_columns mxE => aD; have kD := enum_valP k.
  by apply: state_entry; [apply: contraNneq aD => -> | apply: closed].
by apply/matrixP => a k; rewrite columnsE; case: ifPn => // /z.
Qed.

Lemma state_Z : N *m EZ = ED *m rowsub enum_val (N *m EZ) + EZ *m ('X%:M - constant (mcA (restrict S Z))).
Proof.
have {1}-> : N *m EZ = ED *m rowsub enum_val (N *m EZ) + EZ *m rowsub enum_val (N *m EZ).
  apply: columns_split => // a k aZ aD; rewrite mul_columns mxE; have kZ := enum_valP k.
  by apply: state_entry; [apply: contraNneq aZ => -> | apply: driven].
congr (_ + EZ *m _); rewrite mul_columns; apply/matrixP => i k.
by rewrite !mxE (inj_eq enum_val_inj).
Qed.

Let U : 'M[{poly K}]_(n, #|D| + sh_u E) := row_mx ED (EZ *m sh_U E).
Let Y : 'M[K]_(n, #|D| + sh_r E) := row_mx (columns K D) (columns K Z *m sh_Y E).
Let V : 'M[{poly K}]_(#|D| + sh_r E, #|D| + sh_u E) :=
  block_mx (rowsub enum_val (N *m ED)) (rowsub enum_val (N *m EZ) *m sh_U E) 0 (sh_V E).
Let pivots (k : 'I_(#|D| + sh_u E)) : 'I_n :=
  match split k with inl i => enum_val i | inr i => enum_val (@sh_pivots _ _ _ _ _ _ _ _ _ E i) end.

Lemma local_inputs : exists X, inputs S T = Y *m X.
Proof.
apply/inputs_within => i iT; have /inputs_within/(_ i iT)[/= X eX] := sh_inputs E.
exists (col_mx (rowsub enum_val (mcB S i)) X); rewrite mul_row_col -mulmxA -eX.
by apply: columns_split => // a u aZ aD; apply: acting.
Qed.

Lemma local_state : zero_modulo P (N *m U - constant Y *m V).
Proof.
pose NZ := 'X%:M - constant (mcA (restrict S Z)).
have eZ : N *m (EZ *m sh_U E) = ED *m (rowsub enum_val (N *m EZ) *m sh_U E) + EZ *m (NZ *m sh_U E).
  by rewrite [LHS]mulmxA {1}state_Z mulmxDl -!mulmxA.
have -> : N *m U - constant Y *m V = row_mx 0 (EZ *m (NZ *m sh_U E - constant (sh_Y E) *m sh_V E)).
  rewrite /U /Y /V mul_mx_row map_row_mx map_mxM !constant_columns mul_row_block mulmx0 addr0 eZ.
  rewrite -[columns _ D]/ED -state_D opp_row_mx add_row_mx subrr; congr row_mx.
  by rewrite opprD addrACA subrr add0r -(mulmxA EZ) -mulmxBr.
move=> i j; rewrite mxE; case: splitP => k _; first by rewrite mxE dvdp0.
exact: (zero_modulo_mull _ (@sh_state _ _ _ _ _ _ _ _ _ E)).
Qed.

Lemma local_output i : i \notin T -> zero_modulo P (constant (mcC S i) *m U).
Proof.
move=> iT; rewrite /U mul_mx_row mulmxA !mul_columns => v j; rewrite mxE; case: splitP => k _.
  by rewrite !mxE unseen ?enum_valP// polyC0 dvdp0.
have -> : colsub enum_val (constant (mcC S i)) = constant (mcC (restrict S Z) i) by apply/matrixP => a b; rewrite !mxE.
exact: (@sh_output _ _ _ _ _ _ _ _ _ E i iT).
Qed.

Lemma local_identity : zero_modulo P (rowsub pivots U - 1%:M).
Proof.
have e i (v : 'M[{poly K}]_(#|Z|, sh_u E)) k : (EZ *m v) (enum_val i) k = v i k.
  rewrite mxE (bigD1 i)//= mxE eqxx mul1r big1 ?addr0// => j ji.
  by rewrite mxE (inj_eq enum_val_inj) eq_sym (negPf ji) mul0r.
move=> i j; rewrite !mxE /pivots.
have ij : (i == j) = (split i == split j) by rewrite (can_eq splitK).
rewrite ij; case: (split i) => a; case: (split j) => b.
- by rewrite !mxE (inj_eq enum_val_inj) subrr dvdp0.
- rewrite mxE big1 ?subr0 ?dvdp0// => k _; rewrite mxE.
  case: eqVneq => [e'|_]; last by rewrite mul0r.
  by have := apart (enum_valP a); rewrite e' enum_valP.
- rewrite !mxE; case: eqVneq => [e'|_]; last by rewrite subr0 dvdp0.
  by have := apart (enum_valP b); rewrite -e' enum_valP.
by rewrite e; have := @sh_identity _ _ _ _ _ _ _ _ _ E a b; rewrite !mxE.
Qed.

(* The same deficiency, for the whole system. *)
Theorem shrunk_subspace_within : shrunk_subspace S P T d.
Proof.
apply: (@ShrunkSubspace _ _ _ _ _ S P T d _ _ Y U V pivots).
- exact: local_inputs.
- exact: local_state.
- exact: local_output.
- exact: local_identity.
by rewrite -addnA leq_add2l; apply: (sh_count E).
Qed.
End Within.

(* The rule: E is one of the states Z with the channels f, of which T' are in T.  T' and T differ by channels that
   do not act on Z, and a channel outside T that is none of these sees nothing of Z. *)
Variables (m' : nat) (f : 'I_m' -> 'I_m) (T' : {set 'I_m'}).
Hypothesis idle : forall i, i \in T -> (forall a u, a \in Z -> mcB S i a u = 0) \/ exists2 j, j \in T' & f j = i.
Hypothesis blind : forall i, i \notin T -> (forall v b, b \in Z -> mcC S i v b = 0) \/ exists2 j, j \notin T' & f j = i.

Theorem shrunk_subspace_local : shrunk_subspace (some_channels (restrict S Z) f) P T' d -> shrunk_subspace S P T d.
Proof.
move=> E; apply: shrunk_subspace_within; apply: shrunk_subspace_channels E => i.
  by case/idle=> [z|]; [left; apply/matrixP => a u; rewrite !mxE z ?enum_valP | right].
by case/blind=> [z|]; [left; apply/matrixP => v b; rewrite !mxE z ?enum_valP | right].
Qed.
End Local.
