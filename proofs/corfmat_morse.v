(* Corfmat and Morse: a strongly connected transfer graph and no fixed eigenvalue give one F for
   which every channel controls and observes A_F.  Over every infinite field K, with eigenvalues in
   an algebraically closed L that contains it (the paper's K is R, its L is C). *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import extended neighbor_graph extended_bound sequential_gains feedback.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

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
