(* Scalar gains chosen one after another, each outside a finite set, leave no uncontrollable mode:
   a gain on a channel that the input reaches adds no mode for all but finitely many values.
   Eigenvalues lie in an algebraically closed field L that contains the infinite field K. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines transfer_graph.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Product.
Variable L : fieldType.

(* finitely many conditions that all but finitely many x meet *)
Lemma lines_all (I : eqType) (P : I -> L -> Prop) (js : seq I) :
  (forall i, i \in js -> exists2 D : {poly L}, D != 0 & forall x, D.[x] != 0 -> P i x) ->
  exists2 D : {poly L}, D != 0 & forall x, D.[x] != 0 -> forall i, i \in js -> P i x.
Proof.
elim: js => [_|i js IH h]; first by exists 1; rewrite ?oner_neq0.
have [D D0 hD] := h i (mem_head _ _).
have [j jjs|E E0 hE] := IH; first by apply: h; rewrite inE jjs orbT.
exists (D * E) => [|x]; first by rewrite mulf_neq0.
rewrite hornerM mulf_eq0 negb_or => /andP[/hD Pi /hE Pj] j; rewrite inE.
by case/orP=> [/eqP->|/Pj].
Qed.

Lemma nonzero_at (D : {poly L}) x : D.[x] != 0 -> D != 0.
Proof. by apply: contraNneq => ->; rewrite horner0. Qed.

End Product.

Section Hautus.
Variables (L : closedFieldType) (n b : nat).
Implicit Types (A : 'M[L]_n) (B : 'M[L]_(n, b)).

Lemma uncontrollable_has_mode A B : ~~ controllable A B -> exists lambda, uncontrollable_mode A B lambda.
Proof.
move=> nc; pose W := kermx (reach A B n).
have Wk i : W *m krylov A B i = 0.
  have sk : (kermx (reach A B (maxn n i.+1)) <= W)%MS.
    apply/sub_kermxP/reach_annihilated => t tn.
    have /reach_annihilated := mulmx_ker (reach A B (maxn n i.+1)); apply.
    by apply: leq_trans tn (leq_maxl _ _).
  have := mxrank_leqif_sup sk; rewrite !mxrank_ker rank_reach_n ?leq_maxl // => -[_].
  by rewrite eqxx => /esym/sub_kermxP/reach_annihilated; apply; rewrite leq_maxr.
have WA : (W *m A <= W)%MS.
  by apply/sub_kermxP/reach_annihilated => i _; rewrite -mulmxA -krylovS Wk.
have Wn : (0 < \rank W)%N.
  rewrite mxrank_ker subn_gt0 ltn_neqAle rank_leq_row andbT; exact: nc.
pose V := row_base W; have VW : (V :=: W)%MS by apply: eq_row_base.
have /submxP[Z eZ] : (V *m A <= V)%MS by rewrite VW (eqmxMr _ VW).
have VB : V *m B = 0.
  have W0 : W *m B = 0 := Wk 0%N.
  by have /submxP[D ->] : (V <= W)%MS; [rewrite VW | rewrite -mulmxA W0 mulmx0].
have /closed_rootP[lambda] : size (char_poly Z) != 1%N by rewrite size_char_poly eqSS -lt0n.
rewrite -eigenvalue_root_char => /eigenvalueP[v vZ v0]; exists lambda.
apply/uncontrollable_modeP; exists (v *m V); split.
- by apply: contra v0 => /eqP e; apply/eqP; apply: (row_free_inj (row_base_free W)); rewrite e mul0mx.
- by rewrite -mulmxA eZ mulmxA vZ scalemxAl.
- by rewrite -mulmxA VB mulmx0.
Qed.

End Hautus.

Section Line.
Variables (L : closedFieldType) (n b : nat) (B : 'M[L]_(n, b)).
Implicit Types (A M : 'M[L]_n).

(* one scalar gain x on a channel that B reaches: for all but finitely many x no new mode appears *)
Lemma line_modes A (g : 'cV[L]_n) (c : 'rV[L]_n) k : (k < n)%N -> c *m krylov A B k != 0 ->
  exists2 D : {poly L}, D != 0 & forall x, D.[x] != 0 ->
    forall lambda, uncontrollable_mode (A + x *: (g *m c)) B lambda -> uncontrollable_mode A B lambda.
Proof.
move=> kn ck; have : transfer A B c != 0 by apply: transfer_markov; exists k; rewrite kn.
case/matrix0Pn => i [j nu0]; set P := transfer A B c i j in nu0.
have [rs eP] := closed_field_poly_normal P.
have [lambda _|D D0 hD] := @lines_all _ _
    (fun lambda x => uncontrollable_mode (A + x *: (g *m c)) B lambda -> uncontrollable_mode A B lambda) rs.
  have [D D0 h] := generic_rank (row_mx (constant (lambda%:M - A) + 'X *: constant (- (g *m c)))
                                        (constant B)) 0.
  exists D => [|x /h]; first exact: nonzero_at D0.
  rewrite !map_row_mx !at_line !at_constant scale0r addr0 scalerN -addrA -opprD => le.
  by rewrite /uncontrollable_mode; apply: leq_ltn_trans.
exists D => // x /hD h lambda mx; have [|nrs] := boolP (lambda \in rs); first by move/h; apply.
have Pl : P.[lambda] != 0.
  rewrite eP hornerZ mulf_neq0 ?lead_coef_eq0 // -/(root _ lambda) root_prod_XsubC //.
have /uncontrollable_modeP[w [w0 wA wB]] := mx.
apply/uncontrollable_modeP; exists w; split=> //.
have e : w *m (lambda%:M - A) = x *: (w *m g *m c).
  rewrite mulmxBr mul_mx_scalar -wA mulmxDr addrAC subrr add0r -scalemxAr mulmxA //.
have ev : at_point lambda (transfer A B c) = c *m \adj (lambda%:M - A) *m B.
  rewrite /transfer !map_mxM !at_constant map_mx_adj; congr (_ *m \adj _ *m _).
  by rewrite /char_poly_mx map_mxB at_constant map_scalar_mx /= /horner_eval hornerX.
have z : x *: (w *m g *m at_point lambda (transfer A B c)) = 0.
  rewrite ev !mulmxA scalemxAl scalemxAl -e -(mulmxA w) mul_mx_adj.
  by rewrite mul_mx_scalar -scalemxAl wB scaler0.
have Nj : (at_point lambda (transfer A B c)) 0 j != 0 by rewrite mxE -(ord1 i).
have xw : x * (w *m g) 0 0 = 0.
  move: {e} z Nj; move: (w *m g) (at_point lambda _) => beta N z Nj; apply/eqP.
  have := congr1 (fun M : 'M_(1, b) => M 0 j) z.
  rewrite [beta]mx11_scalar mul_scalar_mx scalerA [LHS]mxE [RHS]mxE => /eqP.
  by rewrite mulf_eq0 (negPf Nj) orbF mxE eqxx mulr1n.
move: e; rewrite [w *m g]mx11_scalar mul_scalar_mx scalerA xw scale0r mulmxBr mul_mx_scalar.
by move/eqP; rewrite subr_eq0 => /eqP.
Qed.

(* rank [lambda I - M, B] = n for some gains of the channels in the list *)
Fixpoint can lambda (cs : seq ('cV[L]_n * 'rV[L]_n)) M : Prop :=
  if cs is gc :: cs' then exists x, can lambda cs' (M + x *: (gc.1 *m gc.2))
  else ~~ uncontrollable_mode M B lambda.

Lemma can_line lambda cs M0 M1 x0 : can lambda cs (M0 + x0 *: M1) ->
  exists2 D : {poly L}, D != 0 & forall x, D.[x] != 0 -> can lambda cs (M0 + x *: M1).
Proof.
elim: cs M0 => [|gc cs IH] M0 /= => [r|[y]].
  have [D D0 h] := generic_rank (row_mx (constant (lambda%:M - M0) + 'X *: constant (- M1))
                                        (constant B)) x0.
  exists D => [|x /h]; first exact: nonzero_at D0.
  rewrite !map_row_mx !at_line !at_constant !scalerN -!addrA -!opprD => le.
  by rewrite /uncontrollable_mode -leqNgt; apply: leq_trans le; rewrite leqNgt.
rewrite addrAC => /IH[D D0 h]; exists D => // x /h; rewrite addrAC; by exists y.
Qed.

End Line.

Section Sequential.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n b : nat).
Variables (B : 'M[K]_(n, b)) (Q : 'M[K]_n -> Prop).
Hypothesis inf : infinite K.
Implicit Types (A : 'M[K]_n).
Notation up M := (map_mx f M).
Notation mode A lambda := (uncontrollable_mode (up A) (up B) lambda).

Lemma krylov_line A G c k (x0 : L) : up c *m krylov (up A + x0 *: up G) (up B) k != 0 ->
  exists2 D : {poly L}, D != 0 & forall x, D.[x] != 0 ->
    up c *m krylov (up A + x *: up G) (up B) k != 0 :> 'rV[L]_b.
Proof.
have [D D0 h] := generic_rank (constant (up c) *m
  krylov (constant (up A) + 'X *: constant (up G)) (constant (up B)) k) x0.
rewrite -mxrank_eq0 -lt0n => c0; exists D => [|x /h]; first exact: nonzero_at D0.
rewrite !map_mxM !map_krylov !at_line !at_constant => le.
by rewrite -mxrank_eq0 -lt0n; apply: leq_trans le.
Qed.

(* gains chosen one after another, each outside a finite set, leave no mode *)
Theorem sequential_gains (cs : seq ('cV[K]_n * 'rV[K]_n)) (ls : seq L) A :
  (forall X x gc, gc \in cs -> Q X -> Q (X + x *: (gc.1 *m gc.2))) -> Q A ->
  (forall gc, gc \in cs -> exists2 k, (k < n)%N & gc.2 *m krylov A B k != 0) ->
  (forall lambda, mode A lambda -> lambda \in ls) ->
  (forall lambda, lambda \in ls ->
     can (up B) lambda [seq (up gc.1, up gc.2) | gc <- cs] (up A)) ->
  exists2 A', Q A' & controllable A' B.
Proof.
elim: cs A => [|[g c] cs IH] A Qcl QA reached inls cans.
  exists A => //; rewrite -(controllable_map f); apply: contraT => /uncontrollable_has_mode[l ml].
  by have := cans l (inls l ml); rewrite /= ml.
have [k kn ck] := reached (g, c) (mem_head _ _).
have ck' : up c *m krylov (up A) (up B) k != 0 by rewrite -map_krylov -map_mxM map_mx_eq0.
have [D1 D10 h1] := line_modes (up g) kn ck'.
have [gc gccs|D2 D20 h2] := @lines_all L _ (fun gc x =>
    exists2 k, (k < n)%N & up gc.2 *m krylov (up A + x *: up (g *m c)) (up B) k != 0) cs.
  have [|j jn cj] := reached gc; first by rewrite inE gccs orbT.
  have [|D D0 h] := @krylov_line A (g *m c) gc.2 j 0.
    by rewrite scale0r addr0 -map_krylov -map_mxM map_mx_eq0.
  by exists D => // x /h; exists j.
have [l lls|D3 D30 h3] := @lines_all L _ (fun l x =>
    can (up B) l [seq (up gc.1, up gc.2) | gc <- cs] (up A + x *: up (g *m c))) ls.
  have [y] := cans l lls; rewrite /= -map_mxM; exact: can_line.
have [|x] := infinite_nonroot f inf (_ : D1 * D2 * D3 != 0); first by rewrite !mulf_neq0.
rewrite !hornerM !mulf_eq0 !negb_or => /andP[/andP[/h1 m1 /h2 m2] /h3 m3].
have eA : up (A + x *: (g *m c)) = up A + f x *: up (g *m c) by rewrite map_mxD map_mxZ.
apply: (IH (A + x *: (g *m c))).
- by move=> X y gc gccs; apply: Qcl; rewrite inE gccs orbT.
- exact: (Qcl _ _ (g, c) (mem_head _ _)).
- move=> gc /m2[j jn]; rewrite -eA -map_krylov -map_mxM map_mx_eq0; by exists j.
- by move=> l; rewrite eA map_mxM => /m1 /inls.
- by move=> l /m3; rewrite eA.
Qed.

End Sequential.
