(* checker/core/roots.py: `best_rate`, the interval for minus the largest real part, or for the largest
   modulus, of all fixed modes.

   The discs are those of all factors together; root_discs in root_discs.v gives the root z_i in each and
   says that there are no others.  The checker compares squares of rationals. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Rate.
Variables (C : numClosedFieldType) (I : finType) (c rho z : I -> C) (spectrum : C -> Prop).
Hypotheses (disc : forall i, `|c i - z i| <= rho i) (all_roots : forall x, spectrum x <-> exists i, x = z i).
Variables low high : C.

Lemma real_part_in_disc i : 'Re (c i) - rho i <= 'Re (z i) <= 'Re (c i) + rho i.
Proof.
have := le_trans (leif_normC_Re_Creal (c i - z i)).1 (disc i).
rewrite raddfB /= real_ler_norml ?rpredB ?Creal_Re// => /andP[lo hi].
apply/andP; split; first by rewrite ler_subl_addr -ler_subl_addl.
by move: lo; rewrite ler_subr_addr addrC ler_subl_addr.
Qed.

(* Continuous time: low is at most, and high at least, minus the largest real part. *)
Theorem rate_interval_continuous :
  (forall i, low <= - ('Re (c i) + rho i)) -> (exists i, - ('Re (c i) - rho i) <= high) ->
  (forall x, spectrum x -> low <= - 'Re x) /\ (exists2 x, spectrum x & - 'Re x <= high).
Proof.
move=> lo [i hi]; split=> [x /all_roots[j ->]|].
  have /andP[_ h] := real_part_in_disc j.
  by apply: le_trans (lo j) _; rewrite ler_opp2.
exists (z i); first by apply/all_roots; exists i.
by have /andP[h _] := real_part_in_disc i; apply: le_trans hi; rewrite ler_opp2.
Qed.

(* Discrete time: low is at most, and high at least, the largest modulus. *)
Theorem rate_interval_discrete : low \is Num.real ->
  (exists i, low <= - rho i \/ (low + rho i) ^+ 2 <= `|c i| ^+ 2) ->
  (forall i, rho i <= high /\ `|c i| ^+ 2 <= (high - rho i) ^+ 2) ->
  (exists2 x, spectrum x & low <= `|x|) /\ (forall x, spectrum x -> `|x| <= high).
Proof.
move=> rl [i lo] hi; have rho0 j : 0 <= rho j by apply: le_trans (disc j).
split=> [|x /all_roots[j ->]].
  exists (z i); first by apply/all_roots; exists i.
  have out : `|c i| - rho i <= `|z i|.
    rewrite ler_subl_addr (le_trans _ (ler_add (lexx _) (disc i)))//.
    by rewrite -{1}[c i](subrK (z i)) addrC ler_norm_add.
  case: lo => [lo|sq]; first by apply: le_trans lo (le_trans _ (normr_ge0 _)); rewrite oppr_le0.
  have rs : low + rho i \is Num.real by rewrite rpredD// ger0_real.
  apply: le_trans out; rewrite ler_subr_addr; have [s0|/ltW s0] := real_leP (real0 _) rs.
    by rewrite -(@ler_pexpn2r _ 2)// nnegrE.
  exact: le_trans s0 (normr_ge0 _).
have [rh sq] := hi j; apply: (@le_trans _ _ (`|c j| + rho j)).
  rewrite addrC (le_trans _ (ler_add (disc j) (lexx _)))//.
  by rewrite -{1}[z j](subKr (c j)) addrC (le_trans (ler_norm_add _ _))// normrN addrC.
rewrite -ler_subr_addr -(@ler_pexpn2r _ 2) ?nnegrE//.
by rewrite subr_ge0.
Qed.
End Rate.
