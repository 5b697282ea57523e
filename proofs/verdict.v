(* The checker's verdict on one certificate, recomputed here: the example of Section IV-B keeps 1
   fixed when agents share their outputs only.  `check_shrunk` is the rule "shrunk subspace" of
   checker/core/evidence.py on integer entries, evaluated by the kernel; `check_shrunk_fixed` says what a
   positive verdict means. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence pencil_space anderson_clements.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* Matrices are lists of rows of integers, given by their entries. *)
Definition entry (M : seq (seq int)) i j : int := nth 0 (nth [::] M i) j.
Definition matrix_of a b (M : seq (seq int)) : 'M[int]_(a, b) := \matrix_(i, j) entry M i j.
Fixpoint total (k : nat) (g : nat -> int) : int := if k is k'.+1 then total k' g + g k' else 0.
Definition agree a b (g h : nat -> nat -> int) : bool :=
  all (fun i => all (fun j => g i j == h i j) (iota 0 b)) (iota 0 a).

Lemma totalE k g : total k g = \sum_(i < k) g i.
Proof. by elim: k => [|k IH]; rewrite ?big_ord0 // big_ord_recr /= IH. Qed.

Lemma agreeP a b g h : agree a b g h -> forall (i : 'I_a) (j : 'I_b), g i j = h i j.
Proof.
move=> /allP ag i j; have := ag i; rewrite mem_iota add0n ltn_ord => /(_ isT)/allP/(_ j).
by rewrite mem_iota add0n ltn_ord => /(_ isT)/eqP.
Qed.

(* A certificate: the matrix A, one pair (B_i, C_i) for each channel with its sizes, an integer
   eigenvalue, the set T as a list of booleans, U with u columns and the V_i, and rows of U that
   form the identity. *)
Record certificate := Certificate {
  states : nat;
  channels : nat;
  c_A : seq (seq int);
  c_B : seq (seq (seq int));
  c_p : seq nat;
  c_C : seq (seq (seq int));
  c_q : seq nat;
  c_lambda : int;
  c_T : seq bool;
  c_u : nat;
  c_U : seq (seq int);
  c_V : seq (seq (seq int));
  c_pivots : seq nat;
  c_rank : nat;                                   (* rank B_T <= c_rank < u: B_T = c_L c_R *)
  c_L : seq (seq int);
  c_R : seq (seq (seq int)) }.

Section Verdict.
Variable c : certificate.
Notation n := (states c).
Notation m := (channels c).
Notation u := (c_u c).
Definition sizes_p (i : 'I_m) : nat := nth 0%N (c_p c) i.
Definition sizes_q (i : 'I_m) : nat := nth 0%N (c_q c) i.
Definition block M i : seq (seq int) := nth [::] M i.

Definition check_shrunk : bool :=
  [&& (* (lambda I - A) U = sum over T of B_i V_i *)
      agree n u
        (fun i j => c_lambda c * entry (c_U c) i j - total n (fun k => entry (c_A c) i k * entry (c_U c) k j))
        (fun i j => total m (fun t => if nth false (c_T c) t then
             total (nth 0%N (c_p c) t) (fun k => entry (block (c_B c) t) i k * entry (block (c_V c) t) k j)
           else 0)),
      (* C_i U = 0 outside T *)
      all (fun t => nth false (c_T c) t ||
         agree (nth 0%N (c_q c) t) u
           (fun i j => total n (fun k => entry (block (c_C c) t) i k * entry (c_U c) k j)) (fun _ _ => 0))
        (iota 0 m),
      (* rows of U form the identity *)
      all (fun r => (nth 0%N (c_pivots c) r < n)%N) (iota 0 u),
      agree u u (fun i j => entry (c_U c) (nth 0%N (c_pivots c) i)%N j) (fun i j => (i == j)%:Z),
      (* B_i = L R_i for every i in T *)
      all (fun t => ~~ nth false (c_T c) t ||
         agree n (nth 0%N (c_p c) t) (fun i j => entry (block (c_B c) t) i j)
           (fun i j => total (c_rank c) (fun k => entry (c_L c) i k * entry (block (c_R c) t) k j)))
        (iota 0 m) &
      (c_rank c < u)%N].

Variable L : fieldType.
Notation up M := (map_mx (intr : int -> L) M).
Definition system_of : multichannel L n sizes_p sizes_q := Multichannel
  (up (matrix_of n n (c_A c)))
  (fun i => up (matrix_of n (sizes_p i) (block (c_B c) i)))
  (fun i => up (matrix_of (sizes_q i) n (block (c_C c) i))).

(* VALID means: lambda is fixed, over every field *)
Theorem check_shrunk_fixed : check_shrunk -> fixed system_of (c_lambda c)%:~R.
Proof.
case/and5P=> /agreeP eU /allP zC /allP piv /agreeP idU /andP[/allP eB lt].
pose T := [set i : 'I_m | nth false (c_T c) i].
pose U := matrix_of n u (c_U c).
pose V (i : 'I_m) : 'M[int]_(sizes_p i, u) := if i \in T then matrix_of _ _ (block (c_V c) i) else 0.
have in_m (i : 'I_m) : (i : nat) \in iota 0 m by rewrite mem_iota ltn_ord.
have sh : shrunk system_of (c_lambda c)%:~R T (up U) (\mxcol_i up (V i)).
  split; last first.
    move=> i; rewrite inE => iT; have := zC i (in_m i); rewrite (negPf iT) /= => /agreeP e.
    rewrite -map_mxM; apply/matrixP => a b; rewrite [LHS]mxE [RHS]mxE.
    have e' := e a b; rewrite totalE in e'.
    have -> : (matrix_of (sizes_q i) n (block (c_C c) i) *m U) a b = 0; last by rewrite rmorph0.
    by rewrite mxE -[RHS]e'; apply: eq_bigr => k _; rewrite !mxE.
  rewrite -inputsE; last by move=> i iT; rewrite /V (negPf iT) map_mx0.
  rewrite -map_scalar_mx -map_mxB -map_mxM.
  rewrite (eq_bigr (fun i => up (matrix_of n (sizes_p i) (block (c_B c) i) *m V i))); last first.
    by move=> i _; rewrite map_mxM.
  rewrite -map_mx_sum; congr (map_mx _ _); apply/matrixP => a b.
  rewrite mulmxBl mul_scalar_mx summxE !mxE; have := eU a b; rewrite !totalE => e.
  rewrite (eq_bigr (fun k : 'I_n => entry (c_A c) a k * entry (c_U c) k b)); last first.
    by move=> k _; rewrite !mxE.
  rewrite e; apply: eq_bigr => t _; rewrite /V inE; case: ifP => _; last by rewrite mulmx0 mxE.
  by rewrite totalE mxE; apply: eq_bigr => k _; rewrite !mxE.
have piv' (r : 'I_u) : (nth 0%N (c_pivots c) r < n)%N by apply: piv; rewrite mem_iota ltn_ord.
have rU : \rank (up U) = u.
  pose P : 'M[L]_(u, n) := \matrix_(r, i) ((i : nat) == nth 0%N (c_pivots c) r)%:R.
  apply/eqP; rewrite eqn_leq rank_leq_col -{1}(mxrank1 L u).
  have <- : P *m up U = 1%:M; last exact: mxrankM_maxr.
  apply/matrixP => r j; rewrite !mxE (bigD1 (Ordinal (piv' r))) //= !mxE eqxx mul1r.
  rewrite big1 ?addr0 => [|i ir].
    by have := idU r j; rewrite /= => ->; rewrite -[r == j]val_eqE.
  rewrite !mxE; have -> : ((i : nat) == nth 0%N (c_pivots c) r) = false.
    by apply: contraNF ir => /eqP e; apply/eqP/val_inj.
  by rewrite mul0r.
have rB : (\rank (inputs system_of T) + 1 <= u)%N.
  rewrite addn1; apply: leq_ltn_trans lt.
  pose R (i : 'I_m) : 'M[int]_(c_rank c, sizes_p i) :=
    if i \in T then matrix_of _ _ (block (c_R c) i) else 0.
  have -> : inputs system_of T = up (matrix_of n (c_rank c) (c_L c)) *m \mxrow_i up (R i).
    rewrite mul_mxrow; apply: eq_mxrow => i; rewrite /R; case: ifPn => iT; last first.
      by rewrite map_mx0 mulmx0.
    rewrite /= -map_mxM; congr (map_mx _ _); apply/matrixP => a b; rewrite !mxE.
    have := eB i (in_m i); rewrite inE in iT; rewrite iT /= => /agreeP/(_ a b) ->.
    by rewrite totalE; apply: eq_bigr => k _; rewrite !mxE.
  exact: leq_trans (mxrankM_maxl _ _) (rank_leq_col _).
move=> F; rewrite pencil_space.eigenvalue_rank -(addn1 (\rank _)).
exact: (shrunk_rank sh rU F rB).
Qed.

End Verdict.

(* The plant of IV-B after the outputs are shared along the cyclic graph: T = {1, 3}. *)
Definition i0 : int := 0.
Definition i1 : int := 1.
Definition example_certificate : certificate := Certificate 3 3
  [:: [:: i1; i0; i0]; [:: i0; i1; i0]; [:: i0; i1; i1]]
  [:: [:: [:: i1]; [:: i0]; [:: i0]]; [:: [:: i0]; [:: i1]; [:: i0]]; [:: [:: i1]; [:: i0]; [:: i0]]]
  [:: 1; 1; 1]%N
  [:: [:: [:: i1; i0; i0]; [:: i0; i0; i1]; [:: i0; i1; i0]];
      [:: [:: i0; i1; i0]; [:: i0; i1; i0]];
      [:: [:: i0; i1; i0]; [:: i1; i0; i0]; [:: i0; i0; i1]]]
  [:: 3; 2; 3]%N
  1 [:: true; false; true] 2
  [:: [:: i1; i0]; [:: i0; i0]; [:: i0; i1]]
  [:: [:: [:: i0; i0]]; [::]; [:: [:: i0; i0]]]
  [:: 0; 2]%N
  1 [:: [:: i1]; [:: i0]; [:: i0]]
  [:: [:: [:: i1]]; [::]; [:: [:: i1]]].

Lemma example_verdict : check_shrunk example_certificate.
Proof. by vm_compute. Qed.

(* the same certificate with u = rank B_T is refused *)
Definition too_small : certificate := Certificate 3 3
  (c_A example_certificate) (c_B example_certificate) (c_p example_certificate)
  (c_C example_certificate) (c_q example_certificate) 1 (c_T example_certificate) 1
  [:: [:: i1]; [:: i0]; [:: i0]] [:: [:: [:: i0]]; [::]; [:: [:: i0]]] [:: 0]%N
  1 (c_L example_certificate) (c_R example_certificate).
Lemma too_small_verdict : check_shrunk too_small = false.
Proof. by vm_compute. Qed.

(* 1 stays an eigenvalue for all constant gains over every field: with evidence.shrunk_subspace_fixed_dynamic, no
   linear time-invariant control by outputs alone stabilizes *)
Theorem example_fixed (L : fieldType) : fixed (system_of example_certificate L) 1.
Proof.
have h := @check_shrunk_fixed _ L example_verdict.
by have e : (c_lambda example_certificate)%:~R = 1 :> L; [apply: rmorph1 | rewrite e in h].
Qed.
