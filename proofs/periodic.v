(* checker/constructions.py: the loop of a periodic controller over one period.

   In step t the state is multiplied by M t, and M (t + N) = M t.  The monodromy matrix is the product over the N steps of
   a period, the last one left.  A loop that starts in any step is, after the rest of that period, the iteration of this
   matrix, with the steps of a part of a period behind it; and the products that begin in other steps have the same
   eigenvalues but 0. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Loop.
Variables (R : ringType) (n : nat) (M : nat -> 'M[R]_n).

(* k steps from step s on *)
Fixpoint passed s k : 'M[R]_n := if k is k'.+1 then M (s + k')%N *m passed s k' else 1%:M.

Lemma passed_add s j k : passed s (j + k) = passed (s + j) k *m passed s j.
Proof. by elim: k => [|k IH]; rewrite ?addn0 ?mul1mx // addnS /= IH mulmxA addnA. Qed.

(* a loop that starts in step s *)
Definition loop s (x : nat -> 'cV[R]_n) := forall t, x t.+1 = M (s + t)%N *m x t.

Lemma loop_passed s x t k : loop s x -> x (t + k)%N = passed (s + t) k *m x t.
Proof. by move=> h; elim: k => [|k IH]; rewrite ?addn0 ?mul1mx // addnS h IH /= mulmxA addnA. Qed.

Variable N : nat.
Hypothesis periodic : forall t, M (t + N)%N = M t.

Definition monodromy := passed 0 N.

Lemma passed_later s q k : passed (s + q * N) k = passed s k.
Proof.
have again t : M (t + q * N)%N = M t by elim: q => [|q IH]; rewrite ?mul0n ?addn0 // mulSn addnCA addnC periodic.
by elim: k => //= k ->; rewrite addnAC again.
Qed.

Theorem periods x k : loop 0 x -> x (k * N)%N = iter k (mulmx monodromy) (x 0%N).
Proof.
move=> h; elim: k => [|k IH]; first by rewrite mul0n.
by rewrite mulSn addnC (loop_passed _ _ h) passed_later IH.
Qed.

Theorem any_step s x k r : (s <= N)%N -> loop s x ->
  x (N - s + (k * N + r))%N = passed 0 r *m iter k (mulmx monodromy) (passed s (N - s) *m x 0%N).
Proof.
move=> sN h; rewrite addnA (loop_passed _ _ h) addnA subnKC // -mulSn -[(k.+1 * N)%N]add0n passed_later.
congr (_ *m _); elim: k => [|k IH]; first by rewrite mul0n addn0 -[(N - s)%N]add0n (loop_passed _ _ h) addn0 add0n.
rewrite mulSn addnCA addnC (loop_passed _ _ h) IH addnA subnKC //.
by rewrite -mulSn -[(k.+1 * N)%N]add0n passed_later.
Qed.
End Loop.

(* AB and BA have the same eigenvalues but 0. *)
Lemma eigenvalue_swap (L : fieldType) n (A B : 'M[L]_n) mu : mu != 0 -> eigenvalue (A *m B) mu -> eigenvalue (B *m A) mu.
Proof.
move=> m0 /eigenvalueP[v e v0]; apply/eigenvalueP; exists (v *m A).
  by rewrite mulmxA -(mulmxA v) e -scalemxAl.
apply: contraNneq v0 => z; move: e; rewrite mulmxA z mul0mx => /esym/eqP.
by rewrite scaler_eq0 (negPf m0).
Qed.

Theorem same_eigenvalues (L : fieldType) n (M : nat -> 'M[L]_n) N s mu : (forall t, M (t + N)%N = M t) -> (s <= N)%N ->
  mu != 0 -> eigenvalue (passed M s N) mu = eigenvalue (monodromy M N) mu.
Proof.
move=> periodic sN m0.
have e0 : monodromy M N = passed M s (N - s) *m passed M 0 s.
  by rewrite /monodromy -{1}(subnKC sN) passed_add add0n.
have es : passed M s N = passed M 0 s *m passed M s (N - s).
  rewrite -{1}(subnK sN) passed_add subnKC // -{1}[N]add0n -{1}[N]mul1n.
  by rewrite (passed_later periodic).
by rewrite e0 es; apply/idP/idP; apply: eigenvalue_swap.
Qed.
