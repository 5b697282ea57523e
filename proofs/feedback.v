(* What feedback does to the transfer graph: a cut stays a cut, arcs compose for some gains; the dual
   system; and conditions on gains that hold at all but finitely many points of every line. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines sequential_gains.
From mcexact Require Import extended neighbor_graph extended_bound.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

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
