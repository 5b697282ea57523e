(* checker/modes.py: kinds `pencil_rank` and `deficiency`.

   pencil_rank is stated for every polynomial matrix M(x), of which P_s(x) is one: the checker's
   P_s(x) leaves out the zero rows and columns that `pencil` keeps. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability fixed_spectrum.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Determinant.
Variable R : comRingType.

Lemma det_1_plus n (c : R) (E : 'M[R]_n) : exists e, \det (1%:M + c *: E) = 1 + c * e.
Proof.
pose f := \det (1%:M + 'X *: map_mx polyC E : 'M[{poly R}]_n).
have fE x : f.[x] = \det (1%:M + x *: E).
  rewrite -[LHS]/(horner_eval x f) -det_map_mx map_mxD map_mx1; congr (\det (_ + _)).
  by apply/matrixP=> i j; rewrite !mxE /= /horner_eval hornerM hornerX hornerC.
have /factor_theorem[g eg] : root (f - 1) 0.
  by rewrite /root hornerD hornerN fE scale0r addr0 det1 hornerC subrr.
exists g.[c]; rewrite -fE -[f](subrK 1) eg subr0 hornerD hornerC hornerM hornerX.
by rewrite addrC mulrC.
Qed.
End Determinant.

Section Upper.
Variables (K L : fieldType) (f : {rmorphism K -> L}) (P : {poly K}) (lambda : L).
Hypothesis root_lambda : root (map_poly f P) lambda.

(* Rule `pencil_rank`, upper half: k independent columns of the kernel modulo p. *)
Theorem pencil_rank_upper a c k (M : 'M[{poly K}]_(a, c)) (N : 'M[{poly K}]_(c, k)) (piv : 'I_k -> 'I_c) :
  zero_modulo P (M *m N) -> zero_modulo P (rowsub piv N - 1%:M) ->
  (\rank (map_mx (value f lambda) M) <= c - k)%N.
Proof.
move=> z piv1; have eN := value_zero root_lambda z; rewrite map_mxM in eN.
have rN : \rank (map_mx (value f lambda) N) = k.
  have := value_zero root_lambda piv1; rewrite map_mxB map_mx1 => /eqP.
  rewrite subr_eq0 => /eqP e; apply/eqP; rewrite eqn_leq rank_leq_col /=.
  by rewrite -[X in (X <= _)%N](mxrank1 L) -e map_mxsub mxrankS// rowsub_sub.
have := mulmx0_rank_max eN; rewrite rN => h.
by rewrite -(leq_add2r k) subnK// (leq_trans _ h)// leq_addl.
Qed.
End Upper.

Section Lower.
Variables (l : modulus) (L : fieldType) (h : {rmorphism rat -> L}).
Notation res := (map_poly (@residue l)).

Lemma representative_poly (r : {poly 'Z_l}) : res (map_poly (@representative l) r) = r.
Proof.
apply/polyP=> i; by rewrite coef_map coef_map_id0 //= representativeK.
Qed.

(* Rule `pencil_rank`, lower half: elimination over (Z/l)[x]/(p) with unit pivots. *)
Theorem pencil_rank_lower a c r (M : 'M[{poly Zloc l}]_(a, c)) (P : {poly Zloc l})
    (X : 'M[{poly 'Z_l}]_(r, a)) (Y : 'M_(c, r)) (E : 'M_r) lambda :
  P \is monic -> X *m map_mx res M *m Y = 1%:M + res P *: E ->
  root (map_poly (into h) P) lambda ->
  (r <= \rank (map_mx (horner_eval lambda \o map_poly (into h)) M))%N.
Proof.
move=> mP e rP; pose X' := map_mx (map_poly (@representative l)) X.
pose Y' := map_mx (map_poly (@representative l)) Y; pose D := \det (X' *m M *m Y').
have resD : res D = \det (X *m map_mx res M *m Y).
  have eX : map_mx res X' = X by apply/matrixP=> i j; rewrite !mxE representative_poly.
  have eY : map_mx res Y' = Y by apply/matrixP=> i j; rewrite !mxE representative_poly.
  by rewrite -det_map_mx !map_mxM /= eX eY.
have [d ed] := det_1_plus (res P) E; rewrite e ed in resD.
have : ~~ root (map_poly (into h) D) lambda.
  by apply: (@no_common_root _ _ h P D (- d) 1 _ (monic_unit_lead mP)) => //; rewrite resD mulNr mul1r mulrC addrCA addNr addr0.
pose ev : {rmorphism {poly Zloc l} -> L} := [rmorphism of horner_eval lambda \o map_poly (into h)].
rewrite /root -[_.[_]]/(ev D) /D -det_map_mx -unitfE -unitmxE -row_full_unit.
move=> /eqP <-; rewrite !map_mxM.
by rewrite (leq_trans (mxrankM_maxl _ _))// mxrankM_maxr.
Qed.

Section Deficiency.
Variables (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Notation SQ := (map_system (@Zloc_rat l) S).

(* Rule `deficiency`, upper half: no subset and no lambda loses more than rho. *)
Theorem deficiency_bound rho (F : gains (Zloc l) p q) (B0 : 'M_(n, rho)) (C0 : 'M_(rho, n)) u v :
  u * res (char_poly (mcA S)) + v * res (char_poly (closed_loop S F + B0 *m C0)) = 1 ->
  forall (s : {set 'I_m}) (lambda : L), (n <= \rank (pencil (map_system h SQ) s lambda) + rho)%N.
Proof.
move=> b s lambda.
have [rA|nrA] := boolP (root (map_poly (into h) (char_poly (mcA S))) lambda).
  have := completion (char_poly_monic _) b rA; rewrite map_loop_into.
  by move=> /leq_trans; apply; rewrite leq_add2r loop_rank_pencil.
have := loop_rank_pencil (map_system h SQ) s lambda (fun=> 0).
rewrite /closed_loop big1 => [|i _]; last by rewrite mulmx0 mul0mx.
rewrite addr0 => lo; rewrite (leq_trans _ (leq_addr _ _))// (leq_trans _ lo)//.
by move: nrA; rewrite -eigenvalue_into /= map_mx_comp eigenvalue_rank -leqNgt.
Qed.

(* Kind `deficiency`: rho is the largest n - rank P_s(lambda), and it is attained. *)
Theorem deficiency_rule rho (F : gains (Zloc l) p q) (B0 : 'M_(n, rho)) (C0 : 'M_(rho, n)) u v
    P T (E : rank_loss SQ P T rho) (lambda : L) :
  u * res (char_poly (mcA S)) + v * res (char_poly (closed_loop S F + B0 *m C0)) = 1 ->
  root (map_poly h P) lambda ->
  (\rank (pencil (map_system h SQ) (~: T) lambda) + rho = n)%N.
Proof.
move=> b rP; apply/eqP; rewrite eqn_leq (deficiency_bound b) andbT.
exact: (shrunk_subspace_pencil E (f := h) rP).
Qed.
End Deficiency.
End Lower.
