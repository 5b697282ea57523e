(* The paper, end of IV-A: without fixed eigenvalues the spectrum is that of the strong components of the
   transfer graph, and decentralized gains make every channel control and observe its own component.

   For a set c of channels `realizes` says that T has the transfer matrices of S within c, `minimal` that
   besides c controls and observes T; `own_loop` is the loop that the gains of c close around T. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import neighbor_graph extended_bound feedback corfmat_morse.
From mcexact Require Import strong_components spectrum_split assignability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Realization.
Variables (K : fieldType) (m : nat) (p q : 'I_m -> nat).
Implicit Types (c : {set 'I_m}).

Definition realizes c n (S : multichannel K n p q) d (T : multichannel K d p q) := forall i j k,
  i \in c -> j \in c ->
  mcC S j *m krylov (mcA S) (mcB S i) k = mcC T j *m krylov (mcA T) (mcB T i) k.
Definition controlled c n (S : multichannel K n p q) := forall w : 'rV_n,
  (forall i k, i \in c -> w *m krylov (mcA S) (mcB S i) k = 0) -> w = 0.
Definition observed c n (S : multichannel K n p q) := forall w : 'rV_n,
  (forall i k, i \in c -> w *m krylov (mcA S)^T (mcC S i)^T k = 0) -> w = 0.
Definition minimal c n (S : multichannel K n p q) d (T : multichannel K d p q) :=
  [/\ realizes c S T, controlled c T & observed c T].

Definition own_loop c n (S : multichannel K n p q) (F : gains K p q) : 'M_n :=
  mcA S + \sum_(i in c) mcB S i *m F i *m mcC S i.
End Realization.

Section Exists.
Variables (K : fieldType) (m : nat).

Lemma krylov_block n (p : 'I_m -> nat) (A : 'M[K]_n) (B : forall i, 'M_(n, p i))
    (c : {set 'I_m}) t (w : 'M_(t, n)) :
  (forall k, w *m krylov A (\mxrow_i (if i \in c then B i else 0)) k = 0) <->
  (forall i k, i \in c -> w *m krylov A (B i) k = 0).
Proof.
have eq k : w *m krylov A (\mxrow_i (if i \in c then B i else 0)) k =
    \mxrow_i (w *m krylov A (if i \in c then B i else 0) k).
  rewrite -[X in krylov A X k]mul1mx krylovM mulmxA mul_mxrow; apply/eq_mxrow => i.
  by rewrite -mulmxA -krylovM mul1mx.
split=> [z i k ic|z k].
  by have := z k; rewrite eq => /mxrowP/(_ i); rewrite mxrowK submxrow0 ic.
rewrite eq; apply/mxrowP=> i; rewrite mxrowK submxrow0; case: ifP => [/z//|_].
by rewrite -(mulmx0 _ (1%:M : 'M_n)) krylovM !mulmx0.
Qed.

(* the states that c reaches *)
Lemma reachable n (p q : 'I_m -> nat) (S : multichannel K n p q) (c : {set 'I_m}) :
  exists v (X : 'M_(n, v)) (T : multichannel K v p q), [/\ row_full X, mcA S *m X = X *m mcA T,
    forall i, i \in c -> mcB S i = X *m mcB T i, forall i, mcC T i = mcC S i *m X & controlled c T].
Proof.
have [w [Q [A2 [fQ QA QB un]]]] := unreached (mcA S) (inputs S c).
have [v [X [en fX QX kerQ]]] := kernel_basis fQ.
have [A1 AX] : exists A1, mcA S *m X = X *m A1 by apply: kerQ; rewrite mulmxA QA -mulmxA QX mulmx0.
have [B1 BX] : exists B1 : forall i, 'M_(v, p i), forall i, i \in c -> mcB S i = X *m B1 i.
  apply: (fin_all_exists (P := fun i B => i \in c -> mcB S i = X *m B)) => i.
  have [ic|ic] := boolP (i \in c); last by exists 0.
  have [Z eZ] : exists Z, mcB S i = X *m Z.
    apply: kerQ; have := QB; rewrite /inputs mul_mxrow => /mxrowP/(_ i).
    by rewrite mxrowK submxrow0 ic.
  by exists Z.
exists v, X, (Multichannel A1 B1 (fun i => mcC S i *m X)); split=> // y /= hy.
have kX i k : i \in c -> krylov (mcA S) (mcB S i) k = X *m krylov A1 (B1 i) k.
  by move=> ic; elim: k => [|k IH]; [exact: BX | rewrite !krylovS IH !mulmxA AX].
have [Z eZ] : exists Z, y *m pinvmx X = Z *m Q.
  apply: un; apply/krylov_block => i k ic.
  by rewrite kX// mulmxA -(mulmxA y) mulVpmx// mulmx1 hy.
by rewrite -[y]mulmx1 -(mulVpmx fX) mulmxA eZ -mulmxA QX mulmx0.
Qed.

Lemma minimal_exists n (p q : 'I_m -> nat) (S : multichannel K n p q) (c : {set 'I_m}) :
  exists d (T : multichannel K d p q), minimal c S T.
Proof.
have [v [X [S1 [fX AX BX CX con]]]] := reachable S c.
have [u [Y [T1 [fY AY BY CY obs]]]] := reachable (dual S1) c; rewrite /= in AY BY CY.
pose T := Multichannel (mcA T1)^T (fun i => (mcC T1 i)^T) (fun i => (mcB T1 i)^T).
have AT : Y^T *m mcA S1 = mcA T *m Y^T.
  by apply: trmx_inj; rewrite !trmx_mul !trmxK AY.
have BT i : mcB T i = Y^T *m mcB S1 i by rewrite /= CY trmx_mul trmxK.
have CT i : i \in c -> mcC S1 i = mcC T i *m Y^T.
  by move=> ic; rewrite /= -trmx_mul -(BY i ic) trmxK.
have kY i k : krylov (mcA T) (mcB T i) k = Y^T *m krylov (mcA S1) (mcB S1 i) k.
  by elim: k => [|k IH]; [exact: BT | rewrite !krylovS IH !mulmxA AT].
have kX i k : i \in c -> krylov (mcA S) (mcB S i) k = X *m krylov (mcA S1) (mcB S1 i) k.
  by move=> ic; elim: k => [|k IH]; [exact: BX | rewrite !krylovS IH !mulmxA AX].
exists u, T; split.
- by move=> i j k ic jc; rewrite kX// mulmxA -CX CT// kY mulmxA.
- move=> w hw; have fYT : row_free Y^T by rewrite /row_free mxrank_tr.
  apply: (row_free_inj fYT); rewrite mul0mx; apply: con => i k ic.
  by rewrite -mulmxA -kY hw.
by move=> w hw; apply: obs => i k ic; have := hw i k ic; rewrite /= !trmxK.
Qed.
End Exists.

Section Spectrum.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Notation e := (transfer_arc S).

(* the strong components *)
Definition components : {set {set 'I_m}} := [set component e j | j in 'I_m].

Lemma component_of i : component e i \in components. Proof. exact: imset_f. Qed.
Lemma in_component i : i \in component e i. Proof. by rewrite component_rule connect0. Qed.
Lemma component_connect c i j : c \in components -> i \in c -> (j \in c) = connect e i j && connect e j i.
Proof.
case/imsetP=> r _ ->; rewrite !component_rule => /andP[ri ir].
apply/andP/andP=> -[h1 h2]; split.
- exact: connect_trans ir h1.
- exact: connect_trans h2 ri.
- exact: connect_trans ri h1.
exact: connect_trans h2 ir.
Qed.
Lemma component_unique c i : c \in components -> (i \in c) = (c == component e i).
Proof.
move=> cC; apply/idP/eqP=> [ic|->]; last exact: in_component.
by apply/setP=> j; rewrite (component_connect _ cC ic) component_rule.
Qed.

Lemma no_arc_up c c' : c \in components -> c' \in components -> c != c' ->
  (#|[set k | [exists x in c, connect e x k]]| <= #|[set k | [exists x in c', connect e x k]]|)%N ->
  forall j i, j \in c -> i \in c' -> ~~ e j i.
Proof.
move=> cC cC' cc' h j i jc ic'; apply: contraNN cc' => ji.
pose ahead (c : {set 'I_m}) := [set k | [exists x in c, connect e x k]].
have aheadE c0 i0 k0 : c0 \in components -> i0 \in c0 -> (k0 \in ahead c0) = connect e i0 k0.
  move=> c0C i0c; rewrite inE; apply/existsP/idP=> [[x /andP[xc xk]]|ik]; last by exists i0; rewrite i0c.
  by apply: connect_trans xk; have := component_connect x c0C i0c; rewrite xc => /esym/andP[].
have le : ahead c' \subset ahead c.
  apply/subsetP=> t; rewrite (aheadE _ _ _ cC' ic') (aheadE _ _ _ cC jc); apply: connect_trans.
  exact: connect1.
have ge : ahead c \subset ahead c' by rewrite -(geq_leqif (subset_leqif_card le)).
have ij : connect e i j.
  by rewrite -(aheadE _ _ _ cC' ic') (subsetP ge)// (aheadE _ _ _ cC jc) connect0.
have ic : i \in c by rewrite (component_connect _ cC jc) connect1.
by move: ic ic'; rewrite !component_unique// => /eqP-> /eqP->.
Qed.

Variables (d : {set 'I_m} -> nat) (T : forall c, multichannel K (d c) p q).
Hypothesis min : forall c, minimal c S (T c).

Lemma inputs_krylov n' (S' : multichannel K n' p q) c k :
  krylov (mcA S') (inputs S' c) k = \mxrow_i (if i \in c then krylov (mcA S') (mcB S' i) k else 0).
Proof.
rewrite -[X in krylov _ X k]mul1mx krylovM mul_mxrow; apply/eq_mxrow => i.
by case: ifP => _; rewrite ?mulmx0// -krylovM mul1mx.
Qed.

Theorem component_spectrum : exists phi : {poly K},
  [/\ phi \is monic, (size phi + \sum_(c in components) d c = n.+1)%N &
  forall (L : fieldType) (f : {rmorphism K -> L}) (F : gains L p q),
    char_poly (closed_loop (map_system f S) F) =
    map_poly f phi * \prod_(c in components) char_poly (own_loop c (map_system f (T c)) F)].
Proof.
have con c : row_free (reach (mcA (T c)) (inputs (T c) c) (d c)).
  have [_ h _] := min c; apply/controllableP => w hw; apply: h => i k ic.
  exact: (krylov_block _ _ _ _).1 hw i k ic.
have obs c : row_free (reach (mcA (T c))^T (outputs (T c) c)^T (d c)).
  have [_ _ h] := min c; apply/controllableP => w hw; apply: h => i k ic.
  apply: (krylov_block (mcA (T c))^T (fun i => (mcC (T c) i)^T) c w).1 _ i k ic => k'.
  rewrite -(hw k'); congr (_ *m krylov _ _ _).
  by rewrite /outputs tr_mxcol; apply/eq_mxrow => i'; case: ifP => //; rewrite trmx0.
have same c k : outputs S c *m krylov (mcA S) (inputs S c) k =
    outputs (T c) c *m krylov (mcA (T c)) (inputs (T c) c) k.
  have [h _ _] := min c; rewrite !inputs_krylov !mul_mxrow; apply/eq_mxrow => i.
  case: ifP => ic; last by rewrite !mulmx0.
  rewrite /outputs !mxcol_mul; apply/eq_mxcol => j; case: ifP => jc; last by rewrite !mul0mx.
  exact: h.
have [|c c' cC c'C cc' h k|phi [mphi s split]] := @spectrum_split K [finType of {set 'I_m}]
  (fun=> (\sum_i p i)%N) (fun=> (\sum_i q i)%N) d (fun c => #|[set k | [exists x in c, connect e x k]]|)
  (fun c => mcA (T c)) (fun c => inputs (T c) c) (fun c => outputs (T c) c) d d con obs
  components n (mcA S) (fun c => inputs S c) (fun c => outputs S c).
- by move=> c _ k; apply: same.
- have none := no_arc_up cC c'C cc' h; rewrite inputs_krylov mul_mxrow; apply/mxrowP=> j.
  rewrite mxrowK submxrow0; case: ifP => [jc|_]; last exact: mulmx0.
  apply/outputs_eq0 => i ic'; apply: contraNeq (none j i jc ic') => nz.
  by apply/transfer_arcP; exists k.
exists phi; split=> // L f F; have := split L f (fun=> gain_matrix F).
have sum n' (S' : multichannel K n' p q) c :
    map_mx f (inputs S' c) *m gain_matrix F *m map_mx f (outputs S' c) =
    \sum_(i in c) map_mx f (mcB S' i) *m F i *m map_mx f (mcC S' i).
  rewrite map_inputs map_outputs gain_matrixE [RHS]big_mkcond; apply: eq_bigr => i _.
  by rewrite mxrowK mxcolK; case: ifP => // _; rewrite mulmx0.
under eq_bigr => c _ do rewrite sum.
have -> : \prod_(c in components) part (fun c => mcA (T c)) (fun c => inputs (T c) c)
    (fun c => outputs (T c) c) f (fun=> gain_matrix F) c =
    \prod_(c in components) char_poly (own_loop c (map_system f (T c)) F).
  by apply: eq_bigr => c _; rewrite /part sum.
move=> <-; congr (char_poly (_ + _)).
under [RHS]eq_bigr => c _ do rewrite big_mkcond; rewrite exchange_big /=; apply: eq_bigr => i _.
rewrite -big_mkcondr (big_pred1 (component e i))// => c /=.
have [cC|nC] := boolP (c \in components); first by rewrite component_unique.
by apply/esym/negbTE; apply: contraNneq nC => ->; apply: component_of.
Qed.
End Spectrum.

(* the system of the channels of c alone *)
Section Own.
Variables (R : fieldType) (m : nat) (p q : 'I_m -> nat) (c : {set 'I_m}) (d : nat) (T : multichannel R d p q).
Definition own_channels : multichannel R d (fun t : 'I_#|c| => p (enum_val t)) (fun t => q (enum_val t)) :=
  Multichannel (mcA T) (fun t => mcB T (enum_val t)) (fun t => mcC T (enum_val t)).

Lemma own_channels_loop (F : gains R p q) :
  closed_loop own_channels (fun t => F (enum_val t)) = own_loop c T F.
Proof.
rewrite /closed_loop /own_loop; congr (_ + _).
by rewrite (big_enum_val (fun i => mcB T i *m F i *m mcC T i)).
Qed.
End Own.

Section Gains.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (S : multichannel K n p q).
Hypothesis inf : infinite K.
Notation e := (transfer_arc S).

(* gains of the channels of c alone, with anything for the others *)
Lemma extend_gains (c : {set 'I_m}) (F : forall t : 'I_#|c|, 'M[K]_(p (enum_val t), q (enum_val t))) :
  exists G : gains K p q, forall t, G (enum_val t) = F t.
Proof.
have [G GE] : exists G : gains K p q, forall i, forall t (e : enum_val t = i),
    G i = eq_rect _ (fun i => 'M[K]_(p i, q i)) (F t) i e.
  apply: (fin_all_exists (P := fun i G => forall t (e : enum_val t = i),
    G = eq_rect _ (fun i => 'M[K]_(p i, q i)) (F t) i e)) => i.
  have [ic|ic] := boolP (i \in c); last first.
    by exists 0 => t et; case/negP: ic; rewrite -et enum_valP.
  pose t0 := enum_rank_in ic i; have e0 : enum_val t0 = i by rewrite enum_rankK_in.
  exists (eq_rect _ (fun i => 'M[K]_(p i, q i)) (F t0) i e0) => t et.
  have tt : t = t0 by apply: enum_val_inj; rewrite e0.
  by subst t; rewrite (eq_irrelevance et e0).
by exists G => t; rewrite (GE _ t erefl).
Qed.

(* within a component every channel still reaches every other *)
Lemma own_channels_connected (c : {set 'I_m}) d (T : multichannel K d p q) : c \in components S ->
  realizes c S T -> neighbor_graph.strongly_connected (transfer_arc (own_channels c T)).
Proof.
move=> cC real a b.
have path j : j \in c -> connect e (enum_val a) j -> forall t, enum_val t = j ->
    connect (transfer_arc (own_channels c T)) a t.
  move=> jc /connectP[s]; elim/last_ind: s j jc => [j jc _ -> t /enum_val_inj ->|s k IH j jc].
    exact: connect0.
  rewrite rcons_path last_rcons => /andP[ps sk] ej t et; subst k.
  set y := last _ s in sk; have ay : connect e (enum_val a) y by apply/connectP; exists s.
  have yc : y \in c.
    rewrite (component_connect _ cC (enum_valP a)) ay (connect_trans (connect1 sk))//.
    by have := component_connect j cC (enum_valP a); rewrite jc => /esym/andP[].
  have ey : enum_val (enum_rank_in yc y) = y by rewrite enum_rankK_in.
  apply: connect_trans (IH y yc ps erefl _ ey) (connect1 _).
  move/transfer_arcP: sk => [k nz]; apply/transfer_arcP; exists k; rewrite /= ey et -real//.
apply: (path (enum_val b)) => //; first exact: enum_valP.
by have := component_connect (enum_val b) cC (enum_valP a); rewrite enum_valP => /esym/andP[].
Qed.

Theorem component_gains : (forall lambda, ~ fixed_over f S lambda) ->
  exists (d : {set 'I_m} -> nat) (T : forall c, multichannel K (d c) p q) (F : gains K p q),
  [/\ (\sum_(c in components S) d c = n)%N,
      forall (R : fieldType) (g : {rmorphism K -> R}) (F' : gains R p q),
        char_poly (closed_loop (map_system g S) F') =
        \prod_(c in components S) char_poly (own_loop c (map_system g (T c)) F'),
      forall c, minimal c S (T c) &
      forall c o, c \in components S -> o \in c ->
        controllable (own_loop c (T c) F) (mcB (T c) o) /\
        controllable (own_loop c (T c) F)^T (mcC (T c) o)^T].
Proof.
move=> nofix.
have [DT min] : exists DT : forall c : {set 'I_m}, {d & multichannel K d p q},
    forall c, minimal c S (projT2 (DT c)).
  apply: (fin_all_exists (P := fun c DT => minimal c S (projT2 DT))) => c.
  by have [d [T h]] := minimal_exists S c; exists (existT _ d T).
pose d c := projT1 (DT c); pose T c : multichannel K (d c) p q := projT2 (DT c).
have [phi [mphi s split]] := @component_spectrum K n m p q S d T min.
have fixedP lambda : (forall F : gains K p q,
    root (char_poly (closed_loop (map_system f S) (fun i => map_mx f (F i)))) lambda) -> False.
  move=> h; apply: (nofix lambda) => F; rewrite eigenvalue_root_char map_closed_loop; exact: h.
have phi1 : phi = 1.
  apply/eqP; rewrite -eqp_monic ?monic1// -size_poly_eq1 -(size_map_poly f).
  apply/negPn/negP => /closed_rootP[x rx]; apply: (fixedP x) => F.
  by rewrite split rootM rx.
rewrite phi1 size_poly1 add1n in s; case: s => s.
have each c : exists G : gains K p q, c \in components S -> forall o, o \in c ->
    controllable (own_loop c (T c) G) (mcB (T c) o) /\
    controllable (own_loop c (T c) G)^T (mcC (T c) o)^T.
  have [cC|nC] := boolP (c \in components S); last by exists (fun=> 0).
  have [real _ _] := min c.
  have [lambda fx|F hF] := corfmat_morse inf (own_channels_connected cC real) (f := f).
    apply: (fixedP lambda) => F; rewrite split rootM (big_setD1 c)//= rootM orbA orbC.
    have := fx (fun t => F (enum_val t)); rewrite eigenvalue_root_char map_closed_loop.
    by rewrite (own_channels_loop c (map_system f (T c)) (fun i => map_mx f (F i))) => ->; rewrite !orbT.
  have [G GE] := extend_gains F; exists G => _ o oc.
  have eL : closed_loop (own_channels c (T c)) F = own_loop c (T c) G.
    rewrite -own_channels_loop; congr (_ + _); apply: eq_bigr => t _; by rewrite GE.
  rewrite -eL; move: (enum_rank_in oc o) (enum_rankK_in oc oc) => t et; subst o; exact: hF.
have [G GE] := fin_all_exists each; pose F i := G (component e i) i.
exists d, T, F; split=> // [R g F'|c o cC oc]; first by rewrite split phi1 rmorph1 mul1r.
have -> : own_loop c (T c) F = own_loop c (T c) (G c); last exact: GE oc.
rewrite /own_loop; congr (_ + _); apply: eq_bigr => i ic; rewrite /F.
by move: ic; rewrite (component_unique i cC) => /eqP <-.
Qed.
End Gains.
