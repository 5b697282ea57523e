(* checker/core/fixed_modes.py: kind `fixed_spectrum`, rules 1 to 5.

   The data are rationals whose denominators are prime to l; h embeds Q into any field L. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Pdiv.CommonRing Pdiv.RingMonic.
Local Open Scope ring_scope.

Section Rules.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Notation SQ := (map_system (@Zloc_rat l) S).
Notation res := (map_poly (@residue l)).
Notation chi F := (char_poly (closed_loop S F)).

Section Field.
Variables (L : fieldType) (h : {rmorphism rat -> L}).
Notation up := (into (l:=l) h).
Notation SL := (map_system h SQ).

Lemma loop_into (F : gains L p q) : closed_loop SL F = closed_loop (map_system up S) F.
Proof.
rewrite /closed_loop /= -map_mx_comp; congr (_ + _); apply: eq_bigr => i _.
by rewrite -!map_mx_comp.
Qed.

Lemma map_loop_into F : map_mx up (closed_loop S F) = closed_loop SL (fun i => map_mx up (F i)).
Proof. by rewrite map_closed_loop loop_into. Qed.

Lemma eigenvalue_into a (M : 'M[Zloc l]_a) lambda :
  eigenvalue (map_mx up M) lambda = root (map_poly up (char_poly M)) lambda.
Proof. by rewrite eigenvalue_root_char -map_char_poly. Qed.

(* Rule "absence": one F and one modulus leave nothing fixed outside phi. *)
Theorem absence (F : gains (Zloc l) p q) (psi : {poly Zloc l}) (phi : {poly rat}) u v lambda :
  psi \is monic ->
  map_poly (@Zloc_rat l) (char_poly (mcA S)) = phi * map_poly (@Zloc_rat l) psi ->
  u * res psi + v * res (chi F) = 1 ->
  fixed SL lambda -> root (map_poly h phi) lambda.
Proof.
move=> mpsi e b fx.
have eA : eigenvalue (mcA SL) lambda.
  have := fx (fun=> 0); rewrite /closed_loop big1 ?addr0// => i _.
  by rewrite mulmx0 mul0mx.
have eF : root (map_poly up (chi F)) lambda.
  by rewrite -eigenvalue_into map_loop_into.
move: eA; rewrite /= -map_mx_comp eigenvalue_into map_poly_into e rmorphM/= rootM => /orP[//|].
by rewrite -map_poly_into => /(no_common_root (monic_unit_lead mpsi) b); rewrite eF.
Qed.

(* Rule "absence" without factors, chi_A needed only modulo l: the fixed spectrum is empty. *)
Theorem absence_all (F : gains (Zloc l) p q) u v lambda :
  u * res (char_poly (mcA S)) + v * res (chi F) = 1 -> ~ fixed SL lambda.
Proof.
move=> b fx; have := @absence F (char_poly (mcA S)) 1 u v lambda (char_poly_monic _) _ b fx.
by rewrite mul1r => /(_ erefl); rewrite rmorph1 (negPf (root1 _)).
Qed.

(* Rule 5, completion: rank(lambda I - A_F) is not below n - d at a root of p. *)
Theorem completion d (F : gains (Zloc l) p q) (B0 : 'M_(n, d)) (C0 : 'M_(d, n)) (P : {poly Zloc l})
    u v lambda :
  P \is monic -> u * res P + v * res (char_poly (closed_loop S F + B0 *m C0)) = 1 ->
  root (map_poly up P) lambda ->
  (n <= \rank (lambda%:M - map_mx up (closed_loop S F))%R + d)%N.
Proof.
move=> mP b rP; have := no_common_root (monic_unit_lead mP) b rP; rewrite -eigenvalue_into eigenvalue_rank -leqNgt.
rewrite map_mxD map_mxM opprD addrA => /leq_trans; apply.
apply: leq_trans (mxrank_add _ _) _; rewrite leq_add2l mxrank_opp.
by rewrite (leq_trans (mxrankM_maxl _ _))// rank_leq_col.
Qed.

(* Rules 2 and 5 together: r = n - d is the largest rank of lambda I - A_F over all gains, and the
   rank of the pencil of the subset named. *)
Theorem rank_exact d T (F : gains (Zloc l) p q) (B0 : 'M_(n, d)) (C0 : 'M_(d, n)) (P : {poly Zloc l})
    (E : rank_loss SQ (map_poly (@Zloc_rat l) P) T d) u v lambda :
  P \is monic -> u * res P + v * res (char_poly (closed_loop S F + B0 *m C0)) = 1 ->
  root (map_poly up P) lambda ->
  [/\ (\rank (lambda%:M - map_mx up (closed_loop S F))%R = n - d)%N,
      (forall G : gains L p q, \rank (lambda%:M - closed_loop SL G)%R <= n - d)%N &
      (\rank (pencil SL (~: T) lambda) = n - d)%N].
Proof.
move=> mP b rP; have lo := completion mP b rP.
have rP' : root (map_poly h (map_poly (@Zloc_rat l) P)) lambda by rewrite -map_poly_into.
have hi G := shrunk_subspace_rank E rP' G; have hp := shrunk_subspace_pencil E rP'.
have dn : (d <= n)%N by rewrite (leq_trans _ hp)// leq_addl.
have eF := map_loop_into F.
have lo' : (n - d <= \rank (lambda%:M - map_mx up (closed_loop S F))%R)%N.
  by rewrite leq_subLR addnC.
split=> [|G|].
- by apply/eqP; rewrite eqn_leq lo' andbT -(leq_add2r d) subnK// eF hi.
- by rewrite -(leq_add2r d) subnK.
- apply/eqP; rewrite eqn_leq -(leq_add2r d) subnK// hp/=.
  by rewrite (leq_trans lo')// eF loop_rank_pencil.
Qed.
End Field.

(* A monic polynomial that divides over a field L containing Q divides over the rationals prime to
   l, hence modulo l. *)
Lemma monic_divides (L : fieldType) (h : {rmorphism rat -> L}) (P c : {poly Zloc l}) :
  P \is monic -> map_poly (into h) P %| map_poly (into h) c -> exists r, c = r * P.
Proof.
move=> mP dv; exists (rdivp c P).
suff: map_poly (into h) (rmodp c P) = 0.
  move=> e0; have r0 : rmodp c P = 0.
    by apply: (map_inj_poly (@into_inj _ _ h) (rmorph0 _)); rewrite e0 rmorph0.
  by rewrite [LHS](rdivp_eq mP) r0 addr0.
move: dv; rewrite {1}(rdivp_eq mP c) rmorphD rmorphM/= dvdp_addr ?dvdp_mull//.
move=> /dvdp_leq; have [//|nz] := eqVneq (map_poly _ (rmodp c P)) 0.
have sP : size (map_poly (into h) P) = size P.
  by apply: size_map_poly_id0; rewrite (monicP mP) rmorph1 oner_eq0.
move=> /(_ isT); rewrite leqNgt sP.
by rewrite (leq_ltn_trans (size_poly _ _))// ltn_rmodpN0 ?monic_neq0.
Qed.

(* Rule 4: p^(e+1) does not divide chi_{A_F} modulo l, so it does not over any field. *)
Theorem multiplicity_at_most (L : fieldType) (h : {rmorphism rat -> L}) (P c : {poly Zloc l}) e :
  P \is monic -> ~ (exists r, res c = r * res P ^+ e.+1) ->
  ~~ (map_poly (into h) P ^+ e.+1 %| map_poly (into h) c).
Proof.
move=> mP nd; apply/negP; rewrite -rmorphX => /(monic_divides (monic_exp _ mP))[r e'].
by apply: nd; exists (res r); rewrite e' rmorphM rmorphX.
Qed.

Lemma root_product (L : fieldType) (h : {rmorphism rat -> L}) r (P : 'I_r -> {poly rat}) lambda :
  reflect (exists i, root (map_poly h (P i)) lambda) (root (map_poly h (\prod_i P i)) lambda).
Proof.
rewrite rmorph_prod /root horner_prod; apply: (iffP (prodf_eq0 _ _)) => [[i _]|[i]]; first by exists i.
by exists i.
Qed.

(* Kind `fixed_spectrum`: the roots of `polynomial`, the product of the factors, are exactly the fixed
   modes, over every field that contains Q. *)
Theorem fixed_spectrum_rule r (P : 'I_r -> {poly rat}) (a : 'I_r -> nat) T (d : 'I_r -> nat)
    (E : forall i, rank_loss SQ (P i) (T i) (d i)) (F : gains (Zloc l) p q)
    (psi : {poly Zloc l}) u v :
  (forall i, 0 < d i)%N -> psi \is monic ->
  map_poly (@Zloc_rat l) (char_poly (mcA S)) = (\prod_i P i ^+ a i) * map_poly (@Zloc_rat l) psi ->
  u * res psi + v * res (chi F) = 1 ->
  forall (L : fieldType) (h : {rmorphism rat -> L}) (lambda : L),
  fixed (map_system h SQ) lambda <-> root (map_poly h (\prod_i P i)) lambda.
Proof.
move=> d0 mpsi e b L h lambda; split=> [/(absence mpsi e b)|] /root_product[i ri].
  by apply/root_product; exists i; move: ri; rewrite rmorphX /root horner_exp expf_eq0 => /andP[].
exact: (shrunk_subspace_fixed (E i) (f := h) ri (d0 i)).
Qed.
End Rules.
