(* x' = x + u_1 + u_2, y_1 = y_2 = x: either agent moves the mode 1, and it is fixed once both have failed. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel failures.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Notation ones := (fun _ : 'I_2 => 1%N).
Notation one := (1%:M : 'M[rat]_1).
Definition double : multichannel rat 1 ones ones := Multichannel one (fun=> one) (fun=> one).
Definition working (i : 'I_2) : 'M[rat]_1 := 1%:M.
Definition without (j i : 'I_2) : 'M[rat]_1 := (i != j)%:R%:M.
Definition lost (i : 'I_2) : 'M[rat]_1 := 0.

Lemma both_fixed : fixed (failed double lost working) 1.
Proof.
move=> F; apply/eigenvalueP; exists one; last by rewrite -[1%:M]/one oner_eq0.
by rewrite /closed_loop big1 => [|i _]; rewrite /= ?mulmx0 ?mul0mx// addr0 mul1mx scale1r.
Qed.

Definition inst_failed_loop := failed_loop double (without ord0) working (fun=> - 2%:R%:M).
Definition inst_fixed_after_failure := fixed_after_failure working working both_fixed.
Definition inst_fixed_after_more := fixed_after_more working (without ord0) both_fixed.

(* One agent is enough: without the first one, the gain -1 of the second moves the mode to 0. *)
Lemma one_moves : ~ fixed (failed double (without ord0) working) 1.
Proof.
move=> /(_ (fun=> - one)) /eigenvalueP [v h nz]; case/negP: nz.
move: h; rewrite /closed_loop big_ord_recl big_ord1 /=.
rewrite /without eqxx /= mulr0n raddf0 mulmx0 !mul0mx add0r mulmx1 !mul1mx mulmx1 subrr mulmx0 scale1r.
by move=> <-.
Qed.
