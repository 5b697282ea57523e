(* checker/core/fixed_modes.py: kind `completeness`, rules yes and no. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph fixed_spectrum.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Completeness.
Variables (n m : nat) (p q : 'I_m -> nat).

(* Complete: the transfer graph is strongly connected and no mode is fixed, over any field. *)
Definition complete (S : multichannel rat n p q) :=
  strongly_connected S /\
  forall (L : fieldType) (h : {rmorphism rat -> L}) (lambda : L), ~ fixed (map_system h S) lambda.

Section Yes.
Variables (l : modulus) (S : multichannel (Zloc l) n p q).

Theorem completeness_yes (e : rel 'I_m) (F : gains (Zloc l) p q) u v :
  (forall j i, e j i -> exists2 k, (k < n)%N &
     map_mx (@residue l) (mcC S i *m krylov (mcA S) (mcB S j) k) != 0) ->
  (forall j i, connect e j i) ->
  u * map_poly (@residue l) (char_poly (mcA S))
    + v * map_poly (@residue l) (char_poly (closed_loop S F)) = 1 ->
  complete (map_system (@Zloc_rat l) S).
Proof.
move=> arcs conn b; split=> [|L h lambda]; last exact: absence_all b.
apply: strongly_connected_arcs conn => j i /arcs[k kn].
move/(residue_neq0 [rmorphism of @idfun rat]).
have -> : map_mx (into [rmorphism of @idfun rat]) (mcC S i *m krylov (mcA S) (mcB S j) k) =
          map_mx (@Zloc_rat l) (mcC S i *m krylov (mcA S) (mcB S j) k).
  by apply/matrixP=> a b'; rewrite !mxE.
by rewrite map_mxM map_krylov => nz; apply: transfer_markov; exists k; rewrite kn.
Qed.
End Yes.

Variable S : multichannel rat n p q.

(* No, by a fixed mode: a polynomial of degree at least 1 has a root in algC. *)
Theorem completeness_no_mode P T d (E : rank_loss S P T d) :
  (0 < d)%N -> (1 < size P)%N -> ~ complete S.
Proof.
move=> d0 sP [_ /(_ _ [rmorphism of @ratr algCfield])] nf.
have [x rx] : exists x : algC, root (map_poly ratr P) x.
  by apply/closed_rootP; rewrite size_map_poly gtn_eqF.
exact: (nf x (shrunk_subspace_fixed E (f := [rmorphism of @ratr algCfield]) rx d0)).
Qed.

(* No, by a cut. *)
Theorem completeness_no_cut T (E : zero_transfer S T (~: T)) :
  T != set0 -> T != setT -> ~ complete S.
Proof. by move=> T0 T1 [sc _]; apply: (zero_transfer_cut E T0 T1 sc). Qed.
End Completeness.
