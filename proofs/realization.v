(* checker/modes.py: the McMillan degree from above, and states off all paths; kind `assignability`.

   Rows W with W A = Z W, W B = 0 annihilate what the inputs reach; columns U with A U = U Y, C U = 0,
   W U = 0 are states that the outputs do not see.  The realization on ker W / im U has the same C A^k B. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic controllability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Realization.
Variables (L : fieldType) (n p q w u : nat).
Variables (A : 'M[L]_n) (B : 'M[L]_(n, p)) (C : 'M[L]_(q, n)).
Variables (W : 'M[L]_(w, n)) (Z : 'M[L]_w) (U : 'M[L]_(n, u)) (Y : 'M[L]_u).
Hypothesis free_W : row_free W.
Hypothesis free_U : row_free U^T.
Hypothesis state_W : W *m A = Z *m W.
Hypothesis input_W : W *m B = 0.
Hypothesis state_U : A *m U = U *m Y.
Hypothesis output_U : C *m U = 0.
Hypothesis inside : W *m U = 0.

(* The columns of X are a basis of ker W. *)
Local Notation X := (row_base (kermx W^T))^T.
Local Notation a := (\rank (kermx W^T)).

Lemma in_kernel m (M : 'M[L]_(n, m)) : W *m M = 0 -> exists M', M = X *m M'.
Proof.
move=> z; have : (M^T <= row_base (kermx W^T))%MS.
  by rewrite eq_row_base; apply/sub_kermxP; rewrite -trmx_mul z trmx0.
by case/submxP => D e; exists D^T; rewrite -trmx_mul -e trmxK.
Qed.

Lemma kernel_kept : W *m X = 0.
Proof.
have : (row_base (kermx W^T) <= kermx W^T)%MS by rewrite eq_row_base.
by move/sub_kermxP => e; rewrite -[LHS]trmxK trmx_mul trmxK e trmx0.
Qed.

Lemma kernel_size : a = (n - w)%N.
Proof. by rewrite mxrank_ker mxrank_tr (eqP free_W). Qed.

Lemma rank_inside m (M : 'M[L]_(a, m)) : \rank (X *m M) = \rank M.
Proof. by rewrite -mxrank_tr trmx_mul trmxK mxrankMfree ?row_base_free// mxrank_tr. Qed.

(* Theorem: a realization of n - w - u states. *)
Theorem kernel_realization : exists (d : nat) (A' : 'M[L]_d) (B' : 'M_(d, p)) (C' : 'M_(q, d)),
  d = (n - w - u)%N /\ forall k, C *m krylov A B k = C' *m krylov A' B' k.
Proof.
have [Ax eA] : exists Ax, A *m X = X *m Ax.
  by apply: in_kernel; rewrite mulmxA state_W -mulmxA kernel_kept mulmx0.
have [Bx eB] := in_kernel input_W; have [Ux eU] := in_kernel inside.
have rU : \rank Ux = u by rewrite -(rank_inside Ux) -eU -mxrank_tr (eqP free_U).
pose V := row_base (kermx Ux).
have quot m (N : 'M[L]_(m, a)) : N *m Ux = 0 -> exists N', N = N' *m V.
  by move=> z; apply/submxP; rewrite eq_row_base sub_kermx; apply/eqP.
have VU : V *m Ux = 0 by apply/sub_kermxP; rewrite /V eq_row_base.
have cancel m (N N' : 'M[L]_(a, m)) : X *m N = X *m N' -> N = N'.
  by move/eqP; rewrite -subr_eq0 -mulmxBr -mxrank_eq0 rank_inside mxrank_eq0 subr_eq0 => /eqP.
have eY : Ax *m Ux = Ux *m Y by apply: cancel; rewrite !mulmxA -eA -mulmxA -eU state_U eU.
have [A' eA'] : exists A', V *m Ax = A' *m V by apply: quot; rewrite -mulmxA eY mulmxA VU mul0mx.
have [C' eC'] : exists C', C *m X = C' *m V by apply: quot; rewrite -mulmxA -eU.
exists (\rank (kermx Ux)), A', (V *m Bx), C'; split.
  by rewrite mxrank_ker rU kernel_size.
move=> k; have -> : krylov A B k = X *m krylov Ax Bx k.
  elim: k => [|k IH]; first exact: eB.
  by rewrite !krylovS IH !mulmxA eA.
have vk : V *m krylov Ax Bx k = krylov A' (V *m Bx) k.
  by elim: k => [//|k IH]; rewrite krylovS mulmxA eA' -mulmxA IH.
by rewrite mulmxA eC' -mulmxA vk.
Qed.
End Realization.

(* Paths: what inputs and the states of P drive outside of P leads to none of them and is not measured. *)
Section Paths.
Variables (L : fieldType) (n p q : nat).
Variables (A : 'M[L]_n) (B : 'M[L]_(n, p)) (C : 'M[L]_(q, n)) (P F : {set 'I_n}).
Hypothesis outside : forall a, a \in F -> a \notin P.
Hypothesis driven_by_inputs : forall a u, a \notin P -> a \notin F -> B a u = 0.
Hypothesis driven_by_states : forall a b, a \notin P -> a \notin F -> b \in P -> A a b = 0.
Hypothesis stays : forall a b, a \notin F -> b \in F -> A a b = 0.
Hypothesis not_measured : forall v b, b \in F -> C v b = 0.

Local Notation A' := (mxsub enum_val enum_val A : 'M_#|P|).
Local Notation B' := (rowsub enum_val B : 'M_(#|P|, p)).
Local Notation C' := (colsub enum_val C : 'M_(q, #|P|)).

Lemma path_zero k a u : a \notin P -> a \notin F -> krylov A B k a u = 0.
Proof.
elim: k a u => [|k IH] a u aP aF; first exact: driven_by_inputs.
rewrite krylovS mxE big1// => b _.
have [bP|bP] := boolP (b \in P); first by rewrite driven_by_states// mul0r.
have [bF|bF] := boolP (b \in F); first by rewrite stays// mul0r.
by rewrite IH// mulr0.
Qed.

(* A sum over all states is one over P, if the factor is 0 on F. *)
Lemma path_sum k u (w : 'I_n -> L) : (forall b, b \in F -> w b = 0) ->
  \sum_b w b * krylov A B k b u = \sum_(i < #|P|) w (enum_val i) * krylov A B k (enum_val i) u.
Proof.
move=> w0; rewrite (bigID (mem P)) /= [X in _ + X]big1 => [|b bP].
  by rewrite addr0 (big_enum_val (fun b => w b * krylov A B k b u)).
have [bF|bF] := boolP (b \in F); first by rewrite w0// mul0r.
by rewrite path_zero// mulr0.
Qed.

Lemma path_krylov k : rowsub enum_val (krylov A B k) = krylov A' B' k.
Proof.
elim: k => [|k IH]; first by [].
apply/matrixP => i u; rewrite !krylovS -IH !mxE path_sum => [|b bF].
  by apply: eq_bigr => j _; rewrite !mxE.
by apply: stays => //; apply: contraL (enum_valP i) => /outside.
Qed.

(* Theorem: the states off all paths may be left out. *)
Theorem path_realization k : C *m krylov A B k = C' *m krylov A' B' k.
Proof.
apply/matrixP => v u; rewrite -path_krylov !mxE path_sum; last exact: not_measured.
by apply: eq_bigr => j _; rewrite !mxE.
Qed.
End Paths.
