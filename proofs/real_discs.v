(* checker/structure.py: which roots are real.  A disc about a point of the real axis holds a real
   root, a disc that does not meet the real axis holds none. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location root_discs.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Theorem real_discs (C : numClosedFieldType) (p : {poly C}) d (c rho : 'I_d.+1 -> C) :
  real_poly p -> size p = d.+2 -> (forall i, 0 <= rho i) ->
  (forall i, (d.+1)%:R ^+ 2 * `|p.[c i]| ^+ 2 <= rho i ^+ 2 * `|p^`().[c i]| ^+ 2) ->
  (forall i j, i != j -> rho i + rho j < `|c i - c j|) ->
  exists z : 'I_d.+1 -> C, [/\ injective z, forall x, root p x <-> exists i, x = z i,
    forall i, c i \is Num.real -> z i \is Num.real &
    forall i, rho i < `|'Im (c i)| -> z i \isn't Num.real].
Proof.
move=> rp sp rho0 h dis; have [z [zi all_roots at_z]] := root_discs sp rho0 h dis.
have rz i : root p (z i) by apply/all_roots; exists i.
have near i : `|c i - z i| <= rho i by apply/at_z.
exists z; split=> // [i rc|i out].
  have rz' : root p (z i)^* by rewrite /root -conj_horner// (rootP (rz i)) rmorph0.
  apply/CrealP/(at_z i _ rz'); rewrite -{1}(CrealP rc) -rmorphB norm_conjC; exact: near.
apply/negP => rzi; suff lt : rho i < `|c i - z i| by have := lt_le_trans lt (near i); rewrite ltxx.
apply: lt_le_trans out _; have -> : 'Im (c i) = 'Im (c i - z i) by rewrite raddfB /= (Creal_ImP _ rzi) subr0.
have -> : 'Im (c i - z i) = - 'Re ('i * (c i - z i)) by rewrite ReMil opprK.
by rewrite normrN (le_trans (leif_normC_Re_Creal _).1)// normrM normCi mul1r.
Qed.
