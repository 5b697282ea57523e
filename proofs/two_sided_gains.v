(* One list of gains for both sides of one channel: where the transfer graph is strongly connected, some gains leave no
   mode uncontrollable or unobservable through a channel except fixed ones.  Corfmat and Morse's theorem is the
   case in which nothing is fixed.

   The gains are chosen one after another, as in sequential_gains.v, each for a scalar input that the outputs
   of the channel see and a scalar output that its inputs reach; Z holds what may stay. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import extended neighbor_graph extended_bound sequential_gains feedback.
From mcexact Require Import corfmat_morse brasch_pearson theorem_1.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Sides.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n : nat).
Hypothesis inf : infinite K.
Notation up M := (map_mx f M).
Notation scalar := ('cV[K]_n * 'rV[K]_n)%type.
Implicit Types (A : 'M[K]_n) (gc : scalar) (cs : seq scalar) (ls : seq L) (Z : pred L).

(* lambda is uncontrollable by B or unobservable by C *)
Definition hidden b c A (B : 'M_(n, b)) (C : 'M_(c, n)) (lambda : L) :=
  uncontrollable_mode (up A) (up B) lambda || uncontrollable_mode (up A^T) (up C^T) lambda.
(* B reaches the scalar output of gc *)
Definition reached_by b (B : 'M[K]_(n, b)) A gc := exists2 k, (k < n)%N & gc.2 *m krylov A B k != 0.
Definition turned gc : scalar := (gc.2^T, gc.1^T).
Definition lifted_channels cs : seq ('cV[L]_n * 'rV[L]_n) := [seq (up gc.1, up gc.2) | gc <- cs].

(* one gain: no new mode, nothing lost that was reached, and the rest still serves *)
Lemma side_step b (B : 'M[K]_(n, b)) A gc cs ls :
  (forall gc', gc' \in gc :: cs -> reached_by B A gc') ->
  (forall lambda, lambda \in ls -> can (up B) lambda (lifted_channels (gc :: cs)) (up A)) ->
  exists2 D : {poly L}, D != 0 & forall x, D.[f x] != 0 -> let A' := A + x *: (gc.1 *m gc.2) in
    [/\ forall lambda, uncontrollable_mode (up A') (up B) lambda -> uncontrollable_mode (up A) (up B) lambda,
        forall gc', gc' \in cs -> reached_by B A' gc' &
        forall lambda, lambda \in ls -> can (up B) lambda (lifted_channels cs) (up A')].
Proof.
case: gc => g c reached cans; have [k kn ck] := reached (g, c) (mem_head _ _).
have ck' : up c *m krylov (up A) (up B) k != 0 by rewrite -map_krylov -map_mxM map_mx_eq0.
have [D1 D10 h1] := line_modes (up g) kn ck'.
have [gc gccs|D2 D20 h2] := @lines_all L _ (fun gc x =>
    exists2 k, (k < n)%N & up gc.2 *m krylov (up A + x *: up (g *m c)) (up B) k != 0) cs.
  have [|j jn cj] := reached gc; first by rewrite inE gccs orbT.
  have [|D D0 h] := @krylov_open _ _ _ _ (up gc.2) (up A) (up (g *m c)) (up B) j 0.
    by rewrite scale0r addr0 -map_krylov -map_mxM map_mx_eq0.
  by exists D => // x /h; exists j.
have [l lls|D3 D30 h3] := @lines_all L _ (fun l x =>
    can (up B) l (lifted_channels cs) (up A + x *: up (g *m c))) ls.
  have [y] := cans l lls; rewrite /= -map_mxM; exact: can_line.
exists (D1 * D2 * D3) => [|x]; first by rewrite !mulf_neq0.
rewrite !hornerM !mulf_eq0 !negb_or => /andP[/andP[/h1 m1 /h2 m2] /h3 m3] /=.
have eA : up (A + x *: (g *m c)) = up A + f x *: up (g *m c) by rewrite map_mxD map_mxZ.
split=> [lambda|gc /m2[j jn]|lambda /m3]; first by rewrite eA map_mxM => /m1.
  by rewrite -eA -map_krylov -map_mxM map_mx_eq0; exists j.
by rewrite eA.
Qed.

(* gains chosen one after another leave what is in Z *)
Theorem two_sided_gains b c (B : 'M[K]_(n, b)) (C : 'M[K]_(c, n)) (Q : 'M[K]_n -> Prop) cs ls Z A :
  (forall X x gc, gc \in cs -> Q X -> Q (X + x *: (gc.1 *m gc.2))) -> Q A ->
  (forall gc, gc \in cs -> reached_by B A gc /\ reached_by C^T A^T (turned gc)) ->
  (forall lambda, hidden A B C lambda -> lambda \in ls \/ Z lambda) ->
  (forall lambda, lambda \in ls -> can (up B) lambda (lifted_channels cs) (up A) /\
     can (up C^T) lambda (lifted_channels (map turned cs)) (up A^T)) ->
  exists2 A', Q A' & forall lambda, hidden A' B C lambda -> Z lambda.
Proof.
elim: cs A => [|gc cs IH] A Qcl QA reached inls cans.
  exists A => // lambda h; case: (inls _ h) => // /cans[/= /negPf hB /negPf hC].
  by rewrite /hidden hB hC in h.
have [|lambda /cans[] //|D D0 h] := @side_step _ B A gc cs ls.
  by move=> gc' /reached[].
have [||E E0 h'] := @side_step _ C^T A^T (turned gc) (map turned cs) ls.
- move=> gc'; rewrite -map_cons => /mapP[gc2 /reached[_ r] ->]; exact: r.
- by move=> lambda /cans[].
have [|x] := infinite_nonroot f inf (_ : D * E != 0); first by rewrite mulf_neq0.
rewrite hornerM mulf_eq0 negb_or => /andP[/h[m1 m2 m3] /h'[]].
have -> : A^T + x *: ((turned gc).1 *m (turned gc).2) = (A + x *: (gc.1 *m gc.2))^T.
  by rewrite linearD linearZ /= trmx_mul.
move=> m1' m2' m3'; apply: (IH (A + x *: (gc.1 *m gc.2))).
- by move=> X y gc' gccs; apply: Qcl; rewrite inE gccs orbT.
- exact: Qcl (mem_head _ _) QA.
- by move=> gc' gccs; split; [exact: m2 | apply: m2'; rewrite map_f].
- by move=> lambda /orP[/m1|/m1'] hid; apply: inls; rewrite /hidden hid ?orbT.
by move=> lambda lls; split; [exact: m3 | exact: m3'].
Qed.
End Sides.

(* every output of an agent, up to a change of basis, is reached where one is *)
Lemma reached_basis (K : fieldType) n b r (A : 'M[K]_n) (B : 'M[K]_(n, b)) (C : 'M[K]_(r, n)) t :
  (t < n)%N -> C *m krylov A B t != 0 ->
  exists2 V : 'M[K]_r, V \in unitmx & forall l, exists2 k, (k < n)%N & row l (V *m C) *m krylov A B k != 0.
Proof.
move=> tn /matrix0Pn[l0 [o nz]].
have r0 : row l0 C *m krylov A B t != 0.
  by rewrite -row_mul; apply: contraNneq nz => /matrixP/(_ 0 o); rewrite [LHS]mxE [RHS]mxE => ->.
pose ok l := [exists k : 'I_n, row l C *m krylov A B k != 0].
have ok0 : ok l0 by apply/existsP; exists (Ordinal tn).
pose E : 'M[K]_r := \matrix_(l, l') (if ok l then 0 else (l' == l0)%:R).
have EC a (M : 'M[K]_(r, a)) l : row l (E *m M) = if ok l then 0 else row l0 M.
  apply/rowP => j; rewrite !mxE; case okl : (ok l).
    by rewrite big1 ?mxE // => k _; rewrite mxE okl mul0r.
  rewrite (bigD1 l0) //= !mxE okl eqxx mul1r big1 ?addr0 // => k kl.
  by rewrite mxE okl (negPf kl) mul0r.
have EE : E *m E = 0.
  apply/row_matrixP => l; rewrite EC row0; case: ifP => // _.
  by apply/rowP => j; rewrite !mxE ok0.
exists (1%:M + E).
  have : (1%:M + E) *m (1%:M - E) = 1%:M.
    by rewrite mulmxDl mul1mx mulmxBr mulmx1 EE subr0 subrK.
  by case/mulmx1_unit.
move=> l; rewrite mulmxDl mul1mx linearD /= EC; case okl : (ok l).
  by move/existsP: okl => [k hk]; exists k => //; rewrite addr0.
exists t => //; rewrite mulmxDl; move/negbT: okl; rewrite negb_exists => /forallP/(_ (Ordinal tn)).
by rewrite negbK => /eqP ->; rewrite add0r.
Qed.

Section Channels.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat).
Hypothesis inf : infinite K.
Variable S : multichannel K n p q.
Implicit Types (F : gains K p q).
Notation up M := (map_mx f M).
Notation scalar := ('cV[K]_n * 'rV[K]_n)%type.

(* the scalar channels of agents i that B0 reaches and C0 sees *)
Lemma two_sided_channel A b (B0 : 'M[K]_(n, b)) c (C0 : 'M[K]_(c, n)) i t t' :
  (t < n)%N -> mcC S i *m krylov A B0 t != 0 ->
  (t' < n)%N -> (mcB S i)^T *m krylov A^T C0^T t' != 0 ->
  exists cs : seq scalar, [/\
    forall gc, gc \in cs -> reached_by B0 A gc /\ reached_by C0^T A^T (turned gc),
    forall F x gc, gc \in cs -> exists F', closed_loop S F' = closed_loop S F + x *: (gc.1 *m gc.2),
    forall lambda cs' M (G : 'M[L]_(p i, q i)),
       can (up B0) lambda cs' (M + up (mcB S i) *m G *m up (mcC S i)) ->
       can (up B0) lambda (lifted_channels f cs ++ cs') M &
    forall lambda cs' M (G : 'M[L]_(p i, q i)),
       can (up C0^T) lambda cs' (M + (up (mcB S i) *m G *m up (mcC S i))^T) ->
       can (up C0^T) lambda (lifted_channels f (map (@turned K n) cs) ++ cs') M].
Proof.
move=> tn nz tn' nz'; have [V uV hV] := reached_basis tn nz; have [U uU hU] := reached_basis tn' nz'.
pose X := mcB S i *m U^T; pose Y := V *m mcC S i.
pose js := index_enum [finType of 'I_(p i) * 'I_(q i)].
pose cs : seq scalar := [seq (col kl.1 X, row kl.2 Y) | kl <- js].
have seen k : exists2 s, (s < n)%N & (col k X)^T *m krylov A^T C0^T s != 0.
  have [s sn h] := hU k; exists s => //.
  by rewrite tr_col /X trmx_mul trmxK.
have term k l : col k X *m row l Y = mcB S i *m (U^T *m delta_mx k l *m V) *m mcC S i.
  by rewrite colE rowE mulmxA -(mulmxA X) mul_delta_mx /X /Y !mulmxA.
have total (G : 'M[L]_(p i, q i)) : exists x : 'I_(p i) * 'I_(q i) -> L,
    \sum_(kl <- js) x kl *: (up (col kl.1 X) *m up (row kl.2 Y)) = up (mcB S i) *m G *m up (mcC S i).
  pose G' := up (invmx U^T) *m G *m up (invmx V); exists (fun kl => G' kl.1 kl.2).
  have -> : up (mcB S i) *m G *m up (mcC S i) = up X *m G' *m up Y.
    have eX : up X *m up (invmx U^T) = up (mcB S i) by rewrite -map_mxM mulmxK ?unitmx_tr.
    have eY : up (invmx V) *m up Y = up (mcC S i) by rewrite -map_mxM mulKmx.
    by rewrite /G' !mulmxA eX -!mulmxA eY.
  by rewrite gain_entries; apply: eq_bigr => kl _; rewrite map_col map_row.
exists cs; split.
- by move=> gc /mapP[kl _ ->]; split; [exact: hV | exact: seen].
- move=> F x gc /mapP[[k l] _ ->] /=.
  exists (fun j => F j + @at_channel K m p q i (x *: (U^T *m delta_mx k l *m V)) j).
  by rewrite closed_loop_at_channel term -scalemxAr -scalemxAl.
- move=> lambda cs' M G; have [x <-] := total G => h; rewrite /lifted_channels -map_comp.
  exact: (can_seq (g := fun kl => up (col kl.1 X)) (c := fun kl => up (row kl.2 Y)) (x := x)).
move=> lambda cs' M G; have [x <-] := total G => h; rewrite /lifted_channels -!map_comp.
apply: (can_seq (g := fun kl => up (row kl.2 Y)^T) (c := fun kl => up (col kl.1 X)^T) (x := x)).
congr (can _ _ _ (_ + _)): h; rewrite linear_sum; apply: eq_bigr => kl _.
by rewrite linearZ /= trmx_mul !map_trmx.
Qed.

Lemma two_sided_channels A b (B0 : 'M[K]_(n, b)) c (C0 : 'M[K]_(c, n)) (hs : seq 'I_m) :
  (forall i, i \in hs -> (exists2 t, (t < n)%N & mcC S i *m krylov A B0 t != 0) /\
     exists2 t, (t < n)%N & (mcB S i)^T *m krylov A^T C0^T t != 0) ->
  exists cs : seq scalar, [/\
    forall gc, gc \in cs -> reached_by B0 A gc /\ reached_by C0^T A^T (turned gc),
    forall F x gc, gc \in cs -> exists F', closed_loop S F' = closed_loop S F + x *: (gc.1 *m gc.2),
    forall lambda cs' M (G : gains L p q),
       can (up B0) lambda cs' (M + \sum_(i <- hs) up (mcB S i) *m G i *m up (mcC S i)) ->
       can (up B0) lambda (lifted_channels f cs ++ cs') M &
    forall lambda cs' M (G : gains L p q),
       can (up C0^T) lambda cs' (M + \sum_(i <- hs) (up (mcB S i) *m G i *m up (mcC S i))^T) ->
       can (up C0^T) lambda (lifted_channels f (map (@turned K n) cs) ++ cs') M].
Proof.
elim: hs => [_|i hs IH h].
  by exists [::]; split=> // lambda cs' M G; rewrite big_nil addr0.
have [[t tn ti] [t' tn' ti']] := h i (mem_head _ _).
have [cs1 [r1 q1 c1 d1]] := two_sided_channel tn ti tn' ti'.
have [j jhs|cs2 [r2 q2 c2 d2]] := IH; first by apply: h; rewrite inE jhs orbT.
exists (cs1 ++ cs2); split.
- by move=> gc; rewrite mem_cat => /orP[/r1|/r2].
- by move=> F x gc; rewrite mem_cat => /orP[/(q1 F x)|/(q2 F x)].
- move=> lambda cs' M G; rewrite big_cons addrA /lifted_channels map_cat -catA => hc.
  by apply: (c1 _ _ _ (G i)); apply: (c2 _ _ _ G).
move=> lambda cs' M G; rewrite big_cons addrA /lifted_channels !map_cat -catA => hc.
by apply: (d1 _ _ _ (G i)); apply: (d2 _ _ _ G).
Qed.

(* gains by which agent o's inputs reach all other agents' outputs, and its outputs see their inputs *)
Lemma arcs_both o : strongly_connected (transfer_arc S) -> exists F, forall i, i != o ->
  (exists2 t, (t < n)%N & mcC S i *m krylov (closed_loop S F) (mcB S o) t != 0) /\
  exists2 t, (t < n)%N & (mcB S i)^T *m krylov (closed_loop S F)^T (mcC S o)^T t != 0.
Proof.
move=> sc; have [F1 h1] := arcs_from inf o sc.
have [F2 h2] := arcs_from inf o (strongly_connected_dual sc).
pose P (ib : 'I_m * bool) (X : 'M[K]_n) : Prop := ib.1 != o ->
  if ib.2 then exists2 t, (t < n)%N & mcC S ib.1 *m krylov X (mcB S o) t != 0
  else exists2 t, (t < n)%N & (mcB S ib.1)^T *m krylov X^T (mcC S o)^T t != 0.
have oP ib : open_on_lines (P ib).
  case: ib => i b X Y t0; rewrite /P /=; have [_ _|io /(_ isT)] := eqVneq i o.
    by exists 1; rewrite ?oner_neq0.
  case: b => -[t tn]; rewrite ?linearD ?linearZ /= => /krylov_open[D D0 h]; exists D => // x /h hx _;
    by exists t; rewrite ?linearD ?linearZ.
have [ib _|F h] := gains_common inf (S := S) (js := index_enum [finType of 'I_m * bool]) oP.
  case: ib => i [].
    by exists F1 => /h1/existsP[t ht]; exists t.
  exists (fun i => (F2 i)^T) => /h2/existsP[t ht]; exists t => //.
  by have := ht; rewrite /= closed_loop_dual.
by exists F => i io; split; [exact: h (i, true) (mem_index_enum _) io | exact: h (i, false) (mem_index_enum _) io].
Qed.

Lemma hidden_eigenvalue A b c (B : 'M[K]_(n, b)) (C : 'M[K]_(c, n)) lambda :
  hidden f A B C lambda -> root (char_poly (up A)) lambda.
Proof.
case/orP=> /uncontrollable_modeP[w [w0 wA _]]; rewrite -eigenvalue_root_char; first by apply/eigenvalueP; exists w.
by rewrite eigenvalue_root_char -char_poly_tr -eigenvalue_root_char map_trmx; apply/eigenvalueP; exists w.
Qed.

(* what no gains of agent o hide is not fixed *)
Theorem one_channel_but (Z : pred L) o : strongly_connected (transfer_arc S) ->
  (forall lambda, fixed_over f S lambda -> Z lambda) ->
  exists F, forall lambda, hidden f (closed_loop S F) (mcB S o) (mcC S o) lambda -> Z lambda.
Proof.
move=> sc fixZ; have [F0 arcs] := arcs_both o sc.
pose A0 := closed_loop S F0; pose hs := [seq i <- enum 'I_m | i != o].
have [i|cs [reached moves cans cans']] := @two_sided_channels A0 _ (mcB S o) _ (mcC S o) hs.
  by rewrite mem_filter => /andP[/arcs].
have [ls els] := closed_field_poly_normal (char_poly (up A0)).
pose Q X := exists F, X = closed_loop S F.
have [||||| A' [F eF] h] := @two_sided_gains _ _ f _ inf _ _ (mcB S o) (mcC S o) Q cs
  [seq l <- ls | ~~ Z l] Z A0; last by exists F => lambda; rewrite -eF; apply: h.
- by move=> X x gc gccs [F ->]; have [F' e] := moves F x gc gccs; exists F'; rewrite e.
- by exists F0.
- exact: reached.
- move=> lambda /hidden_eigenvalue; rewrite els (monicP (char_poly_monic _)) scale1r root_prod_XsubC => lls.
  by rewrite mem_filter lls andbT; case: (Z lambda); [right | left].
move=> lambda; rewrite mem_filter => /andP[nZ _].
have [F rF] : exists F : gains L p q, \rank (lambda%:M - closed_loop (map_system f S) F) = n.
  apply: not_fixed_gains; rewrite -fixed_over_fixed => /fixZ zl.
  by rewrite zl in nZ.
pose W := F o - up (F0 o).
have tot : \sum_i up (mcB S i) *m (F i - up (F0 i)) *m up (mcC S i) =
    \sum_i up (mcB S i) *m F i *m up (mcC S i) - \sum_i up (mcB S i) *m up (F0 i) *m up (mcC S i).
  by rewrite -sumrB; apply: eq_bigr => i _; rewrite mulmxBr mulmxBl.
have e : up A0 + \sum_(i <- hs) up (mcB S i) *m (F i - up (F0 i)) *m up (mcC S i) =
    closed_loop (map_system f S) F - up (mcB S o) *m W *m up (mcC S o).
  rewrite /A0 closed_loop_map /closed_loop /= big_filter big_enum_cond /=.
  move: tot; rewrite (bigD1 o) //= => /(canRL (addKr _)) ->.
  rewrite /W; move: (\sum_i _ *m up (F0 _) *m _) (\sum_i _ *m F _ *m _) (_ *m _ *m _) => X Y V.
  by rewrite -!addrA; congr (_ + _); rewrite addrCA [X + _]addrC subrK addrC.
split.
  rewrite -[lifted_channels _ _]cats0; apply: (cans _ _ _ (fun i => F i - up (F0 i))) => /=.
  by rewrite e -!mulmxA -mulmxN own_feedback full_no_mode.
rewrite -[lifted_channels _ _]cats0; apply: (cans' _ _ _ (fun i => F i - up (F0 i))) => /=.
rewrite -linear_sum /= -map_trmx -linearD /= e linearB /= trmx_mul -mulmxN -map_trmx own_feedback.
by rewrite full_no_mode // -[RHS]rF -[RHS]mxrank_tr linearB /= tr_scalar_mx.
Qed.
End Channels.
