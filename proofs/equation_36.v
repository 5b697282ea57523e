(* Section V-A, (36): below the k x (k + 1) matrix M_k with -1 on its diagonal and lambda beside it, any row e_i' makes a
   nonsingular matrix, where lambda is not 0. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Equation36.
Variables (L : fieldType) (k : nat) (lambda : L).
Definition shifted_rows : 'M[L]_(k, k.+1) :=
  \matrix_(t, j) (if j == t :> nat then -1 else if j == t.+1 :> nat then lambda else 0).

(* what is in the kernel of M_k: v_t = lambda v_(t+1) *)
Lemma shifted_kernel (v : 'cV[L]_k.+1) : shifted_rows *m v = 0 ->
  forall t, (t < k)%N -> v (inord t) 0 = lambda * v (inord t.+1) 0.
Proof.
move=> e t tk; have := congr1 (fun M : 'cV[L]_k => M (Ordinal tk) 0) e; rewrite !mxE.
pose a : 'I_k.+1 := inord t; pose b : 'I_k.+1 := inord t.+1.
have ea : a = t :> nat by rewrite inordK // ltnW.
have eb : b = t.+1 :> nat by rewrite inordK.
have ba : b != a by rewrite -val_eqE /= ea eb gtn_eqF.
rewrite (bigD1 a) //= (bigD1 b) //= big1 => [|j /andP[ja jb]]; last first.
  rewrite mxE /=; have -> : (j == t :> nat) = false by apply: contraNF ja => /eqP jt; apply/eqP/val_inj; rewrite /= jt ea.
  have -> : (j == t.+1 :> nat) = false by apply: contraNF jb => /eqP jt; apply/eqP/val_inj; rewrite /= jt eb.
  by rewrite mul0r.
rewrite !mxE /= ea eb eqxx gtn_eqF // eqxx mulN1r addr0 => /eqP.
by rewrite addrC subr_eq0 => /eqP.
Qed.

Theorem equation_36 (i : 'I_k.+1) : lambda != 0 -> \rank (col_mx shifted_rows (delta_mx 0 i : 'rV_k.+1)) = k.+1.
Proof.
move=> l0; set M := col_mx _ _; suff inj (v : 'cV_k.+1) : M *m v = 0 -> v = 0.
  apply/eqP; rewrite -mxrank_tr -[_ == _]/(row_free _) -kermx_eq0; apply/rowV0P => w /sub_kermxP e.
  by apply: trmx_inj; rewrite trmx0; apply: inj; apply: trmx_inj; rewrite trmx_mul trmxK trmx0.
rewrite /M mul_col_mx => e; have e1 : shifted_rows *m v = 0 by move/(congr1 usubmx): e; rewrite col_mxKu linear0.
have e2 : v i 0 = 0.
  by move/(congr1 dsubmx): e; rewrite col_mxKd linear0 -rowE => /matrixP/(_ 0 0); rewrite !mxE.
have step := shifted_kernel e1.
have all t : (t <= k)%N -> v (inord t) 0 = 0 -> forall j, (j <= k)%N -> v (inord j) 0 = 0.
  move=> tk vt; have up r : (t + r <= k)%N -> v (inord (t + r)) 0 = 0.
    elim: r => [|r IH] le; first by rewrite addn0.
    have lt : (t + r < k)%N by rewrite -addnS.
    have := step _ lt; rewrite IH ?(ltnW lt) // -addnS => /esym/eqP.
    by rewrite mulf_eq0 (negPf l0) => /eqP.
  have down r : (r <= t)%N -> v (inord (t - r)) 0 = 0.
    elim: r => [|r IH] le; first by rewrite subn0.
    have lt : (t - r.+1 < k)%N by apply: leq_trans tk; rewrite ltn_subrL; case: (t) le.
    by rewrite step // subnSK // IH ?mulr0 // ltnW.
  move=> j jk; have [jt|/ltnW tj] := leqP j t.
    by rewrite -(subKn jt); apply: down; rewrite leq_subr.
  by rewrite -(subnKC tj); apply: up; rewrite subnKC.
apply/colP => j; rewrite [RHS]mxE; have ik : (i <= k)%N by rewrite -ltnS.
have ji : (j <= k)%N by rewrite -ltnS.
by have := all i ik; rewrite inord_val => /(_ e2 j ji); rewrite inord_val.
Qed.
End Equation36.
