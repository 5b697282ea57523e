(* Corfmat and Morse: a strongly connected transfer graph and no fixed eigenvalue give one F for
   which every channel controls and observes A_F.  Over every infinite field K, with eigenvalues in
   an algebraically closed L that contains it (the paper's K is R, its L is C). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import transfer_graph extended neighbor_graph extended_bound.

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

Section Feedback.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel K n p q) (F G : gains K p q) (T : {set 'I_m}).

(* the system after u_i = F_i y_i + v_i *)
Definition feedback S F : multichannel K n p q := Multichannel (closed_loop S F) (mcB S) (mcC S).

Lemma closed_loop_feedback S F G :
  closed_loop (feedback S F) G = closed_loop S (fun i => F i + G i).
Proof.
rewrite /closed_loop /= -addrA -big_split /=; congr (_ + _); apply: eq_bigr => i _.
by rewrite mulmxDr mulmxDl.
Qed.

(* one entry of one gain changed *)
Definition bump F j (x : 'I_(p j)) (y : 'I_(q j)) t : gains K p q := fun i =>
  \matrix_(a, b) (F i a b + t *+ [&& i == j, a == x :> nat & b == y :> nat]).

Lemma closed_loop_bump S F j (x : 'I_(p j)) (y : 'I_(q j)) t :
  closed_loop S (bump F x y t) = closed_loop S F + t *: (col x (mcB S j) *m row y (mcC S j)).
Proof.
rewrite /closed_loop -addrA; congr (_ + _).
rewrite (bigD1 j) //= [in RHS](bigD1 j) //= addrAC; congr (_ + _); last first.
  apply: eq_bigr => i ij; congr (_ *m _ *m _); apply/matrixP => a b; rewrite !mxE.
  by rewrite (negbTE ij) addr0.
rewrite colE rowE mulmxA -(mulmxA (mcB S j) (delta_mx _ _)) mul_delta_mx scalemxAl scalemxAr.
rewrite -mulmxDl -mulmxDr; congr (_ *m _ *m _); apply/matrixP => a b; rewrite !mxE eqxx.
by rewrite !(inj_eq val_inj) mulr_natr.
Qed.

(* a cut of the transfer graph stays a cut under feedback *)
Lemma cut_feedback S F T :
  (forall j i, j \in T -> i \notin T -> ~~ transfer_arc S j i) ->
  forall j i, j \in T -> i \notin T -> ~~ transfer_arc (feedback S F) j i.
Proof.
move=> cut j i Tj Ti; apply/negP => /transfer_arcP[t] /eqP; apply.
have CB i' j' k : j' \in T -> i' \notin T -> mcC S i' *m krylov (mcA S) (mcB S j') k = 0.
  move=> Tj' Ti'; apply/eqP; apply: contraNT (cut _ _ Tj' Ti') => h; apply/transfer_arcP; by exists k.
suff gen r (v : 'M[K]_(r, n)) :
    (forall k j', j' \in T -> v *m krylov (mcA S) (mcB S j') k = 0) ->
    v *m krylov (closed_loop S F) (mcB S j) t = 0 by apply: gen => k j' Tj'; apply: CB.
elim: t v => [|t IH] v hv; first exact: (hv 0%N).
rewrite krylovS mulmxA; apply: IH => k j' Tj'.
rewrite /closed_loop mulmxDr mulmxDl -mulmxA -krylovS hv // add0r mulmx_sumr mulmx_suml.
rewrite big1 // => i' _; have [Ti'|Ti'] := boolP (i' \in T).
  by rewrite !mulmxA (hv 0%N) // !mul0mx.
by rewrite -!mulmxA CB // !mulmx0.
Qed.

Lemma strongly_connected_feedback S F : strongly_connected (transfer_arc S) ->
  strongly_connected (transfer_arc (feedback S F)).
Proof.
move=> /strongly_connectedP sc; apply/strongly_connectedP => s s0 sT.
have [/existsP[j /existsP[i /and3P[a sj si]]]|] :=
  boolP [exists j, exists i, [&& transfer_arc (feedback S F) j i, j \notin s & i \in s]].
  by exists j, i.
move=> none; have [j [i [a sj si]]] := sc s s0 sT.
have cut j' i' : j' \in ~: s -> i' \notin ~: s -> ~~ transfer_arc (feedback S F) j' i'.
  rewrite !inE negbK => sj' si'; apply: contra none => a'.
  by apply/existsP; exists j'; apply/existsP; exists i'; apply/and3P.
have := cut_feedback (fun i => - F i) cut; rewrite /transfer_arc /= closed_loop_feedback.
have -> : closed_loop S (fun i => F i + - F i) = mcA S.
  by rewrite /closed_loop big1 ?addr0 // => i' _; rewrite subrr mulmx0 mul0mx.
by move/(_ j i); rewrite !inE negbK sj si => /(_ isT isT); rewrite [X in ~~ X]a.
Qed.

Lemma krylov_open r b (C : 'M[K]_(r, n)) (A G : 'M[K]_n) (B : 'M[K]_(n, b)) k x0 :
  C *m krylov (A + x0 *: G) B k != 0 ->
  exists2 D : {poly K}, D != 0 & forall x, D.[x] != 0 -> C *m krylov (A + x *: G) B k != 0.
Proof.
have [D D0 h] := generic_rank (constant C *m
  krylov (constant A + 'X *: constant G) (constant B) k) x0.
rewrite -mxrank_eq0 -lt0n => c0; exists D => [|x /h]; first exact: nonzero_at D0.
rewrite !map_mxM !map_krylov !at_line !at_constant => le.
by rewrite -mxrank_eq0 -lt0n; apply: leq_trans le.
Qed.

Lemma krylov_add (A : 'M[K]_n) b (B : 'M[K]_(n, b)) s t :
  krylov A B (s + t) = krylov A (krylov A B t) s.
Proof. by rewrite /krylov iterD. Qed.

Lemma krylovSr (A : 'M[K]_n) b (B : 'M[K]_(n, b)) t : krylov A B t.+1 = krylov A (A *m B) t.
Proof. by rewrite /krylov iterSr. Qed.

Lemma krylovM (A : 'M[K]_n) b c (B : 'M[K]_(n, b)) (D : 'M[K]_(b, c)) t :
  krylov A (B *m D) t = krylov A B t *m D.
Proof. by elim: t => [//|t IH]; rewrite !krylovS IH mulmxA. Qed.

Lemma krylovD (A : 'M[K]_n) b (B D : 'M[K]_(n, b)) t :
  krylov A (B + D) t = krylov A B t + krylov A D t.
Proof. by elim: t => [//|t IH]; rewrite !krylovS IH mulmxDr. Qed.

(* an arc from o to j and one from j to i: a gain on j makes an arc from o to i *)
Lemma compose_arcs S o j i : transfer_arc S o j -> transfer_arc S j i -> ~~ transfer_arc S o i ->
  exists x y k, mcC S i *m krylov (mcA S + 1 *: (col x (mcB S j) *m row y (mcC S j))) (mcB S o) k != 0.
Proof.
move=> oj ji noi; set A := mcA S; pose B := mcB S j; pose C := mcC S j.
have oi k : mcC S i *m krylov A (mcB S o) k = 0.
  by apply/eqP; apply: contraNT noi => h; apply/transfer_arcP; exists k.
have [a aP amin] := ex_minnP (elimT (transfer_arcP S j i) ji).
have [d dP dmin] := ex_minnP (elimT (transfer_arcP S o j) oj).
case/matrix0Pn: (aP) => i' [x ax]; case/matrix0Pn: (dP) => y [o' dy].
exists x, y, (a + d.+1)%N; set g := col x _; set c := row y _; rewrite scale1r.
set A' := A + g *m c.
have ga t : (t < a)%N -> mcC S i *m krylov A g t = 0.
  move=> ta; apply/eqP; rewrite /g colE krylovM mulmxA; apply: contraTT ta => h; rewrite -leqNgt.
  by apply: amin; apply: contraNneq h => ->; rewrite mul0mx.
have cd t : (t < d)%N -> c *m krylov A (mcB S o) t = 0.
  move=> td; apply/eqP; rewrite /c rowE -mulmxA; apply: contraTT td => h; rewrite -leqNgt.
  by apply: dmin; apply: contraNneq h => ->; rewrite mulmx0.
have kd t : (t <= d)%N -> krylov A' (mcB S o) t = krylov A (mcB S o) t.
  elim: t => [//|t IH] td; rewrite !krylovS IH ?(ltnW td) // mulmxDl -mulmxA cd //.
  by rewrite mulmx0 addr0.
have ka b (Z : 'M[K]_(n, b)) t : (t <= a)%N ->
    mcC S i *m krylov A' Z t = mcC S i *m krylov A Z t.
  elim: t Z => [//|t IH] Z ta; rewrite !krylovSr IH ?(ltnW ta) // /A' mulmxDl -mulmxA.
  by rewrite krylovD [krylov A (g *m _) t]krylovM mulmxDr (mulmxA (mcC S i) (krylov _ g t)) ga // mul0mx addr0.
rewrite krylov_add ka // krylovS kd // {1}/A' mulmxDl krylovD mulmxDr -krylovS -krylov_add oi add0r.
rewrite -mulmxA [krylov A (g *m _) a]krylovM mulmxA.
have -> : mcC S i *m krylov A g a = col x (mcC S i *m krylov A B a).
  by rewrite /g !colE krylovM mulmxA.
have -> : c *m krylov A (mcB S o) d = row y (C *m krylov A (mcB S o) d).
  by rewrite /c !rowE mulmxA.
move: ax dy; rewrite -/A -/B -/C.
move: (mcC S i *m krylov A B a) (C *m krylov A (mcB S o) d) => X Y Xx Yy.
apply/eqP => /matrixP/(_ i' o'); rewrite !mxE big_ord1 !mxE => /eqP.
by rewrite mulf_eq0 (negPf Xx) (negPf Yy).
Qed.

Hypothesis inf : infinite K.

(* some gains give the transfer graph an arc from o to every other channel *)
Lemma arcs_from S o : strongly_connected (transfer_arc S) ->
  exists F, forall i, i != o -> transfer_arc (feedback S F) o i.
Proof.
move=> sc; pose T F := [set i | (i == o) || transfer_arc (feedback S F) o i].
suff gen d F : (m - #|T F| <= d)%N -> exists F', T F' = setT.
  have [F TF] := gen _ (fun i => 0) (leqnn _); exists F => i io.
  by have := in_setT i; rewrite -TF inE (negPf io).
elim: d F => [|d IH] F hd.
  exists F; apply/eqP; rewrite eqEcard subsetT cardsT card_ord /=.
  by rewrite -subn_eq0 -leqn0.
have [TF|TF] := eqVneq (T F) setT; first by exists F.
have To : o \in T F by rewrite inE eqxx.
have sT : ~: T F != setT by apply/negP => /eqP e; have := in_setT o; rewrite -e inE To.
have s0 : ~: T F != set0 by rewrite -setCT (inj_eq (can_inj (@setCK _))).
have /strongly_connectedP sc' := strongly_connected_feedback F sc.
have [j [i [ji sj si]]] := sc' _ s0 sT.
rewrite in_setC negbK inE in sj; rewrite in_setC inE negb_or in si; case/andP: si => io noi.
have jo : j != o by apply: contraNneq noi => <-.
rewrite (negPf jo) /= in sj; have oj := sj.
have [x [y [k xy]]] := compose_arcs oj ji noi.
pose G := col x (mcB S j) *m row y (mcC S j).
have [D1 D10 h1] := krylov_open xy.
have [i' Ti'|D2 D20 h2] := @lines_all K _ (fun i' t =>
    exists k, mcC S i' *m krylov (closed_loop S F + t *: G) (mcB S o) k != 0) (enum (T F :\ o)).
  rewrite mem_enum !inE in Ti'; case/andP: Ti' => i'o; rewrite (negPf i'o) /= => /transfer_arcP[k' hk'].
  have [|D D0 h] := @krylov_open _ _ (mcC S i') (closed_loop S F) G (mcB S o) k' 0.
    by rewrite scale0r addr0.
  by exists D => // t /h; exists k'.
have [|t] := infinite_nonroot [rmorphism of idfun] inf (_ : D1 * D2 != 0); first by rewrite mulf_neq0.
rewrite hornerM mulf_eq0 negb_or /= => /andP[/h1 m1 /h2 m2].
apply: (IH (bump F x y t)); rewrite -ltnS; apply: leq_trans hd; apply: ltn_sub2l.
  rewrite -[X in (_ < X)%N]card_ord -cardsT; apply: proper_card; rewrite properEneq TF subsetT //.
apply: proper_card; apply/properP; split; last first.
  exists i; last by rewrite inE negb_or io.
  by rewrite inE; apply/orP; right; apply/transfer_arcP; exists k; rewrite /= closed_loop_bump.
apply/subsetP => i' Ti'; rewrite inE; have [//|i'o /=] := eqVneq i' o.
have [|k' hk'] := m2 i'; first by rewrite mem_enum !inE i'o; move: Ti'; rewrite inE (negPf i'o).
by apply/transfer_arcP; exists k'; rewrite /= closed_loop_bump.
Qed.

End Feedback.

Section Channels.
Variables (L : closedFieldType) (n b : nat) (B : 'M[L]_(n, b)).

Lemma can_seq lambda (J : Type) (js : seq J) (g : J -> 'cV[L]_n) (c : J -> 'rV[L]_n) (x : J -> L)
    cs M : can B lambda cs (M + \sum_(j <- js) x j *: (g j *m c j)) ->
  can B lambda ([seq (g j, c j) | j <- js] ++ cs) M.
Proof.
elim: js M => [|j js IH] M; first by rewrite big_nil addr0.
by rewrite big_cons addrA /= => h; exists (x j); apply: IH.
Qed.

Lemma gain_entries p q (Bi : 'M[L]_(n, p)) (G : 'M_(p, q)) (Ci : 'M_(q, n)) :
  Bi *m G *m Ci = \sum_(kl : 'I_p * 'I_q) G kl.1 kl.2 *: (col kl.1 Bi *m row kl.2 Ci).
Proof.
rewrite {1}(matrix_sum_delta G) pair_bigA /= mulmx_sumr mulmx_suml; apply: eq_bigr => kl _.
rewrite -scalemxAr -scalemxAl; congr (_ *: _).
by rewrite colE rowE !mulmxA -(mulmxA Bi (delta_mx _ _)) mul_delta_mx.
Qed.

(* what agent o feeds back to its own input changes no mode *)
Lemma own_feedback M (Y : 'M_(b, n)) lambda :
  uncontrollable_mode (M + B *m Y) B lambda = uncontrollable_mode M B lambda.
Proof.
suff le M' Y' : (\rank (row_mx (lambda%:M - (M' + B *m Y')) B) <= \rank (row_mx (lambda%:M - M') B))%N.
  rewrite /uncontrollable_mode; congr (_ < _)%N; apply/eqP; rewrite eqn_leq le /=.
  by have := le (M + B *m Y) (- Y); rewrite mulmxN addrK.
have -> : row_mx (lambda%:M - (M' + B *m Y')) B =
    row_mx (lambda%:M - M') B *m block_mx 1%:M 0 (- Y') 1%:M.
  by rewrite mul_row_block !mulmx1 mulmx0 add0r mulmxN opprD addrA.
exact: mxrankM_maxl.
Qed.

End Channels.

Section Controllable.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat).
Hypothesis inf : infinite K.
Implicit Types (S : multichannel K n p q) (F : gains K p q).
Notation up M := (map_mx f M).

(* the scalar channels of channel i, each reached from B0 *)
Lemma scalar_channels S F b (B0 : 'M[K]_(n, b)) i t :
  (t < n)%N -> mcC S i *m krylov (closed_loop S F) B0 t != 0 ->
  exists cs : seq ('cV[K]_n * 'rV[K]_n), [/\
    (forall gc, gc \in cs -> exists2 k, (k < n)%N & gc.2 *m krylov (closed_loop S F) B0 k != 0),
    (forall F' x gc, gc \in cs -> exists F'',
       closed_loop S F'' = closed_loop S F' + x *: (gc.1 *m gc.2)) &
    (forall lambda cs' M (G : 'M[L]_(p i, q i)),
       can (up B0) lambda cs' (M + up (mcB S i) *m G *m up (mcC S i)) ->
       can (up B0) lambda ([seq (up gc.1, up gc.2) | gc <- cs] ++ cs') M)].
Proof.
move=> tn; case/matrix0Pn => l0 [o' nz]; set A := closed_loop S F in nz *.
have r0 : row l0 (mcC S i) *m krylov A B0 t != 0.
  rewrite -row_mul; apply: contraNneq nz => /matrixP/(_ 0 o'); rewrite [LHS]mxE [RHS]mxE => ->.
  by [].
pose ok l := [exists k : 'I_n, row l (mcC S i) *m krylov A B0 k != 0].
pose h l := row l (mcC S i) + (if ok l then 0 else row l0 (mcC S i)).
have hok l : exists2 k, (k < n)%N & h l *m krylov A B0 k != 0.
  rewrite /h; case: ifPn => [/existsP[k hk]|]; first by exists k; rewrite // addr0.
  rewrite negb_exists => /forallP no; exists t => //; rewrite mulmxDl.
  by have := no (Ordinal tn); rewrite negbK => /eqP ->; rewrite add0r.
pose cs1 := [seq (col kl.1 (mcB S i), h kl.2) | kl <- index_enum [finType of 'I_(p i) * 'I_(q i)]].
pose cs2 := [seq (col k (mcB S i), row l0 (mcC S i)) | k <- index_enum [finType of 'I_(p i)]].
exists (cs1 ++ cs2); split.
- move=> gc; rewrite mem_cat => /orP[/mapP[kl _ ->]|/mapP[k _ ->]] /=; first exact: hok.
  by exists t.
- move=> F' x gc; rewrite mem_cat => /orP[/mapP[kl _ ->]|/mapP[k _ ->]] /=; last first.
    by exists (bump F' k l0 x); rewrite closed_loop_bump.
  rewrite /h; case: ifP => _.
    by exists (bump F' kl.1 kl.2 x); rewrite closed_loop_bump addr0.
  exists (bump (bump F' kl.1 kl.2 x) kl.1 l0 x).
  by rewrite !closed_loop_bump mulmxDr scalerDr addrA.
move=> lambda cs' M G; rewrite map_cat -catA -!map_comp => hc.
pose y k : L := - \sum_l (if ok l then 0 else G k l).
apply: (can_seq (g := fun kl => up (col kl.1 (mcB S i))) (c := fun kl => up (h kl.2))
                (x := fun kl => G kl.1 kl.2)).
apply: (can_seq (g := fun k => up (col k (mcB S i))) (c := fun k => up (row l0 (mcC S i)))
                (x := y)).
suff e : \sum_(kl : 'I_(p i) * 'I_(q i)) G kl.1 kl.2 *: (up (col kl.1 (mcB S i)) *m up (h kl.2)) +
    \sum_(k : 'I_(p i)) y k *: (up (col k (mcB S i)) *m up (row l0 (mcC S i))) =
    up (mcB S i) *m G *m up (mcC S i) by rewrite -addrA e.
rewrite gain_entries.
rewrite -(pair_bigA _ (fun k l => G k l *: (up (col k (mcB S i)) *m up (h l)))) /=.
rewrite -(pair_bigA _ (fun k l => G k l *: (col k (up (mcB S i)) *m row l (up (mcC S i))))) /=.
rewrite -big_split /=; apply: eq_bigr => k _; rewrite /y scaleNr scaler_suml -sumrB.
apply: eq_bigr => l _; rewrite map_col !map_row /h map_mxD map_row mulmxDr scalerDr.
case: ifP => _; first by rewrite map_mx0 mulmx0 scaler0 scale0r addr0 subr0.
by rewrite map_row addrK.
Qed.

Lemma all_channels S F b (B0 : 'M[K]_(n, b)) (hs : seq 'I_m) :
  (forall i, i \in hs -> exists2 t, (t < n)%N & mcC S i *m krylov (closed_loop S F) B0 t != 0) ->
  exists cs : seq ('cV[K]_n * 'rV[K]_n), [/\
    (forall gc, gc \in cs -> exists2 k, (k < n)%N & gc.2 *m krylov (closed_loop S F) B0 k != 0),
    (forall F' x gc, gc \in cs -> exists F'',
       closed_loop S F'' = closed_loop S F' + x *: (gc.1 *m gc.2)) &
    (forall lambda cs' M (G : gains L p q),
       can (up B0) lambda cs' (M + \sum_(i <- hs) up (mcB S i) *m G i *m up (mcC S i)) ->
       can (up B0) lambda ([seq (up gc.1, up gc.2) | gc <- cs] ++ cs') M)].
Proof.
elim: hs => [_|i hs IH h].
  by exists [::]; split=> // lambda cs' M G; rewrite big_nil addr0.
have [t tn ti] := h i (mem_head _ _); have [cs1 [r1 q1 c1]] := scalar_channels tn ti.
have [j jhs|cs2 [r2 q2 c2]] := IH; first by apply: h; rewrite inE jhs orbT.
exists (cs1 ++ cs2); split.
- by move=> gc; rewrite mem_cat => /orP[/r1|/r2].
- by move=> F' x gc; rewrite mem_cat => /orP[/(q1 F' x)|/(q2 F' x)].
move=> lambda cs' M G; rewrite big_cons addrA map_cat -catA => hc.
by apply: (c1 _ _ _ (G i)); apply: (c2 _ _ _ G).
Qed.

(* Corfmat and Morse, the half about controllability through one channel *)
Theorem corfmat_morse_controllable S o : strongly_connected (transfer_arc S) ->
  (forall lambda : L, exists F : gains L p q,
     ~~ uncontrollable_mode (closed_loop (map_system f S) F) (up (mcB S o)) lambda) ->
  exists F : gains K p q, controllable (closed_loop S F) (mcB S o).
Proof.
move=> sc nofix; have [F0 arcs] := arcs_from inf o sc.
pose hs := [seq i <- enum 'I_m | i != o].
have [i|cs [reached moves cans]] := @all_channels S F0 _ (mcB S o) hs.
  rewrite mem_filter => /andP[/arcs /existsP[t ht] _]; by exists t.
pose A0 := closed_loop S F0.
pose modes := (closed_field_poly_normal (char_poly (up A0))).
have [ls els] := modes.
have inls lambda : uncontrollable_mode (up A0) (up (mcB S o)) lambda -> lambda \in ls.
  case/uncontrollable_modeP=> w [w0 wA _].
  have : eigenvalue (up A0) lambda by apply/eigenvalueP; exists w.
  rewrite eigenvalue_root_char els (monicP (char_poly_monic _)) scale1r.
  by rewrite root_prod_XsubC.
pose Q X := exists F, X = closed_loop S F.
have Qm X x gc : gc \in cs -> Q X -> Q (X + x *: (gc.1 *m gc.2)).
  by move=> gccs [F ->]; have [F' e] := moves F x gc gccs; exists F'; rewrite e.
have QA : Q A0 by exists F0.
suff cn lambda : lambda \in ls ->
    can (up (mcB S o)) lambda [seq (up gc.1, up gc.2) | gc <- cs] (up A0).
  have [A' [F eF] ctr] := sequential_gains inf Qm QA reached inls cn.
  by exists F; rewrite -eF.
move=> _; have [F hF] := nofix lambda.
rewrite -[X in can _ _ X]cats0; apply: (cans _ _ _ (fun i => F i - up (F0 i))) => /=.
have tot : \sum_i up (mcB S i) *m (F i - up (F0 i)) *m up (mcC S i) =
    \sum_i up (mcB S i) *m F i *m up (mcC S i) - \sum_i up (mcB S i) *m up (F0 i) *m up (mcC S i).
  by rewrite -sumrB; apply: eq_bigr => i _; rewrite mulmxBr mulmxBl.
rewrite (bigD1 o) //= in tot.
have e : up A0 + \sum_(i <- hs) up (mcB S i) *m (F i - up (F0 i)) *m up (mcC S i) =
  closed_loop (map_system f S) F + up (mcB S o) *m (- (F o - up (F0 o)) *m up (mcC S o)).
  rewrite /A0 closed_loop_map /closed_loop /= big_filter big_enum_cond /=.
  rewrite -(subrK (\sum_i up (mcB S i) *m up (F0 i) *m up (mcC S i))
                  (\sum_i up (mcB S i) *m F i *m up (mcC S i))) -tot.
  rewrite mulNmx mulmxN mulmxA; move: (\sum_(i | _) _) (\sum_i _) (_ *m _ *m _) => X Y Z.
  by rewrite -[LHS]addrA -[RHS]addrA; congr (_ + _); rewrite -(addrA Z) [Z + _]addrC addrK addrC.
by rewrite e own_feedback.
Qed.

End Controllable.

Section Open.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat).
Hypothesis inf : infinite K.
Implicit Types (S : multichannel K n p q) (F : gains K p q).

(* a condition on matrices that holds at all but finitely many points of a line, or at none *)
Definition open_on_lines (P : 'M[K]_n -> Prop) := forall X Y t0, P (X + t0 *: Y) ->
  exists2 D : {poly K}, D != 0 & forall t, D.[t] != 0 -> P (X + t *: Y).

Lemma open_reach b (B : 'M[K]_(n, b)) k : open_on_lines (fun X => \rank (reach X B k) == n).
Proof.
move=> X Y t0 /eqP r; have [D D0 h] := generic_reach X Y B k t0.
exists D => [|t /h]; first exact: nonzero_at D0.
by rewrite r eqn_leq rank_leq_row.
Qed.

Lemma open_reach_tr b (B : 'M[K]_(n, b)) k : open_on_lines (fun X => \rank (reach X^T B k) == n).
Proof.
move=> X Y t0; rewrite linearD linearZ /= => /open_reach[D D0 h].
by exists D => // t /h; rewrite linearD linearZ.
Qed.

Lemma open_and P P' : open_on_lines P -> open_on_lines P' -> open_on_lines (fun X => P X /\ P' X).
Proof.
move=> o o' X Y t0 [/o[D D0 h] /o'[D' D0' h']]; exists (D * D'); first by rewrite mulf_neq0.
by move=> t; rewrite hornerM mulf_eq0 negb_or => /andP[/h ? /h' ?].
Qed.

Lemma open_all (I : eqType) (P : I -> 'M[K]_n -> Prop) (js : seq I) :
  (forall i, open_on_lines (P i)) -> open_on_lines (fun X => forall i, i \in js -> P i X).
Proof.
move=> o X Y t0 h; have [i ijs|D D0 hD] := @lines_all K I (fun i t => P i (X + t *: Y)) js.
  by apply: (o i X Y t0); apply: h.
by exists D.
Qed.

Lemma closed_loop_line S F0 F1 t :
  closed_loop S (fun i => F0 i + t *: (F1 i - F0 i)) =
  closed_loop S F0 + t *: (closed_loop S F1 - closed_loop S F0).
Proof.
rewrite /closed_loop -addrA opprD addrACA subrr add0r -sumrB scaler_sumr -big_split /=.
congr (_ + _); apply: eq_bigr => i _.
by rewrite mulmxDr mulmxDl -scalemxAr -scalemxAl mulmxBr mulmxBl.
Qed.

(* open conditions that gains meet one by one are met by one list of gains *)
Lemma gains_common S (I : eqType) (P : I -> 'M[K]_n -> Prop) (js : seq I) :
  (forall i, open_on_lines (P i)) -> (forall i, i \in js -> exists F, P i (closed_loop S F)) ->
  exists F, forall i, i \in js -> P i (closed_loop S F).
Proof.
move=> o; elim: js => [_|j js IH h]; first by exists (fun=> 0).
have [i ijs|F0 h0] := IH; first by apply: h; rewrite inE ijs orbT.
have [F1 h1] := h j (mem_head _ _).
pose X := closed_loop S F0; pose Y := closed_loop S F1 - X.
have [|D D0 hD] := o j X Y 1; first by rewrite scale1r addrC subrK.
have [|E E0 hE] := open_all o (js := js) (X := X) (Y := Y) (t0 := 0).
  by move=> i ijs; rewrite scale0r addr0; apply: h0.
have [|t] := infinite_nonroot [rmorphism of idfun] inf (_ : D * E != 0); first by rewrite mulf_neq0.
rewrite hornerM mulf_eq0 negb_or => /andP[/hD Pj /hE Pjs].
exists (fun i => F0 i + t *: (F1 i - F0 i)) => i; rewrite closed_loop_line inE.
by case/orP=> [/eqP->|/Pjs].
Qed.

End Open.

Section Dual.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel K n p q) (F : gains K p q).

Definition dual S : multichannel K n q p :=
  Multichannel (mcA S)^T (fun i => (mcC S i)^T) (fun i => (mcB S i)^T).

Lemma closed_loop_dual S (F : gains K q p) :
  closed_loop (dual S) F = (closed_loop S (fun i => (F i)^T))^T.
Proof.
rewrite /closed_loop linearD linear_sum /=; congr (_ + _); apply: eq_bigr => i _.
by rewrite !trmx_mul trmxK mulmxA.
Qed.

Lemma krylov_tr r b (C : 'M[K]_(r, n)) (A : 'M[K]_n) (B : 'M[K]_(n, b)) k :
  (C *m krylov A B k)^T = B^T *m krylov A^T C^T k.
Proof.
elim: k C B => [|k IH] C B; first by rewrite trmx_mul.
rewrite krylovSr krylovS mulmxA -trmx_mul -IH.
by elim: k C B {IH} => [|k IH] C B //; rewrite krylovSr.
Qed.

Lemma transfer_arc_dual S j i : transfer_arc (dual S) j i = transfer_arc S i j.
Proof. by apply: eq_existsb => t; rewrite /= -krylov_tr trmx_eq0. Qed.

Lemma strongly_connected_dual S : strongly_connected (transfer_arc S) ->
  strongly_connected (transfer_arc (dual S)).
Proof.
move=> /strongly_connectedP sc; apply/strongly_connectedP => s s0 sT.
have [||j [i [a]]] := sc (~: s).
- by rewrite -setCT (inj_eq (can_inj (@setCK _))).
- by rewrite -setC0 (inj_eq (can_inj (@setCK _))).
by rewrite !inE negbK => sj si; exists i, j; rewrite transfer_arc_dual.
Qed.

End Dual.

Section CorfmatMorse.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat).
Hypothesis inf : infinite K.
Implicit Types (S : multichannel K n p q) (F : gains K p q).

Lemma not_fixed_gains (K' : fieldType) n' (p' q' : 'I_m -> nat)
    (S : multichannel K' n' p' q') lambda : ~ fixed S lambda ->
  exists F : gains K' p' q', \rank (lambda%:M - closed_loop S F) = n'.
Proof.
have [G [s e]] := rank_closed_loop_max S lambda => nf; exists (natural K' G).
apply/eqP; rewrite eqn_leq rank_leq_row leqNgt e; apply/negP => lt.
by apply: nf; apply: anderson_clements_easy lt.
Qed.

Lemma full_no_mode (L' : fieldType) k b (X : 'M[L']_k) (B : 'M_(k, b)) lambda :
  \rank (lambda%:M - X) = k -> ~~ uncontrollable_mode X B lambda.
Proof.
move=> r; rewrite /uncontrollable_mode -leqNgt -{1}r.
have e : row_mx (lambda%:M - X) B *m col_mx 1%:M 0 = lambda%:M - X.
  by rewrite mul_row_col mulmx1 mulmx0 addr0.
by rewrite -{1}e mxrankM_maxl.
Qed.

(* Corfmat and Morse: controllable and observable through every channel *)
Theorem corfmat_morse S : strongly_connected (transfer_arc S) ->
  (forall lambda : L, ~ fixed_over f S lambda) ->
  exists F, forall o : 'I_m, controllable (closed_loop S F) (mcB S o) /\
                             controllable (closed_loop S F)^T (mcC S o)^T.
Proof.
move=> sc nf.
have rk lambda : exists F : gains L p q, \rank (lambda%:M - closed_loop (map_system f S) F) = n.
  by apply: not_fixed_gains; rewrite -fixed_over_fixed; apply: nf.
pose P (ob : 'I_m * bool) (X : 'M[K]_n) : Prop :=
  if ob.2 then \rank (reach X (mcB S ob.1) n) == n else \rank (reach X^T (mcC S ob.1)^T n) == n.
have oP ob : open_on_lines (P ob).
  by case: ob => o [] /=; [apply: open_reach | apply: open_reach_tr].
have each ob : ob \in index_enum [finType of 'I_m * bool] -> exists F, P ob (closed_loop S F).
  move=> _; case: ob => o []; rewrite /P /=.
    apply: (@corfmat_morse_controllable _ _ f _ _ _ _ inf) => // lambda; have [F rF] := rk lambda.
    by exists F; apply: full_no_mode.
  have [|lambda|F] := @corfmat_morse_controllable _ _ f _ _ _ _ inf (dual S) o.
  - exact: strongly_connected_dual.
  - have [F rF] := rk lambda; exists (fun i => (F i)^T).
    apply: full_no_mode; rewrite -[RHS]rF -[RHS]mxrank_tr linearB /= tr_scalar_mx.
    have e : (closed_loop (map_system f S) F)^T = closed_loop (map_system f (dual S)) (fun i => (F i)^T).
      rewrite /closed_loop /= linearD linear_sum /= map_trmx; congr (_ + _).
      by apply: eq_bigr => i _; rewrite !trmx_mul mulmxA !map_trmx.
    by rewrite e.
  by rewrite closed_loop_dual => h; exists (fun i => (F i)^T).
have [F hF] := gains_common inf oP each.
exists F => o; split; first exact: (hF (o, true) (mem_index_enum _)).
exact: (hF (o, false) (mem_index_enum _)).
Qed.

End CorfmatMorse.
