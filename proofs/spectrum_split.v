(* How the characteristic polynomial of a closed loop splits when the transfer matrix is block triangular;
   used by assignability.v.  A channel here is a whole strong component, its inputs and its outputs stacked.

   One channel that none of the others hears is taken off at a time: the space that it controls goes, and of
   it the minimal realization stays, with a part that its gain does not change. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import controllability joint_controllability.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Invariant.
Variable K : fieldType.

(* X spans an invariant space and Q has it for its kernel: M is block triangular. *)
Lemma char_poly_split n v w (X : 'M[K]_(n, v)) (Q : 'M_(w, n)) M M1 M2 : n = (v + w)%N ->
  row_full X -> row_free Q -> Q *m X = 0 -> M *m X = X *m M1 -> Q *m M = M2 *m Q ->
  char_poly M = char_poly M1 * char_poly M2.
Proof.
move=> en fX fQ QX MX QM; pose Y := pinvmx X; have YX : Y *m X = 1%:M by apply: mulVpmx.
pose Z := pinvmx Q - X *m (Y *m pinvmx Q).
have QZ : Q *m Z = 1%:M by rewrite mulmxBr mulmxA QX mul0mx subr0 mulmxVp.
have YZ : Y *m Z = 0 by rewrite mulmxBr mulmxA YX mul1mx subrr.
pose G := col_mx Y Q; pose H := row_mx X Z.
have GH : G *m H = 1%:M by rewrite mul_col_row YX QX YZ QZ -scalar_mx_block.
have HG : H *m G = 1%:M.
  by clear -en GH; move: G H GH; rewrite en => G H; apply: mulmx1C.
have fG : row_free G by apply/row_freeP; exists H.
have uG : row_full G by apply/row_fullP; exists H.
have e : G *m M = block_mx M1 (Y *m M *m Z) 0 M2 *m G.
  rewrite -[LHS]mulmx1 -HG mulmxA; congr (_ *m _).
  rewrite -mulmxA mul_mx_row mul_col_row MX mulmxA YX mul1mx !mulmxA QX mul0mx QM.
  by rewrite -[M2 *m Q *m Z]mulmxA QZ mulmx1.
rewrite -(char_poly_similar fG uG e) /char_poly /char_poly_mx map_block_mx scalar_mx_block opp_block_mx.
by rewrite add_block_mx /= map_mx0 oppr0 addr0 det_ublock.
Qed.

(* the kernel of a matrix of full row rank *)
Lemma kernel_basis n w (Q : 'M[K]_(w, n)) : row_free Q ->
  exists v (X : 'M_(n, v)), [/\ n = (v + w)%N, row_full X, Q *m X = 0 &
    forall t (Y : 'M_(n, t)), Q *m Y = 0 -> exists Z, Y = X *m Z].
Proof.
move=> fQ; pose N := kermx Q^T; exists (\rank N), (row_base N)^T; split.
- by rewrite mxrank_ker mxrank_tr (eqP fQ) subnK// -(eqP fQ) rank_leq_col.
- by rewrite /row_full mxrank_tr -/(row_free (row_base N)) row_base_free.
- apply: trmx_inj; rewrite trmx_mul trmxK trmx0; apply/sub_kermxP; by rewrite eq_row_base.
move=> t Y QY; have : (Y^T <= row_base N)%MS.
  by rewrite eq_row_base; apply/sub_kermxP; rewrite -trmx_mul QY trmx0.
by case/submxP=> Z eZ; exists Z^T; apply: trmx_inj; rewrite trmx_mul !trmxK.
Qed.

(* what a channel does not reach *)
Lemma unreached n b (A : 'M[K]_n) (B : 'M_(n, b)) :
  exists w (Q : 'M_(w, n)) A', [/\ row_free Q, Q *m A = A' *m Q, Q *m B = 0 &
    forall t (Y : 'M_(t, n)), (forall k, Y *m krylov A B k = 0) -> exists Z, Y = Z *m Q].
Proof.
pose N := kermx (reach A B n); pose Q := row_base N.
have all t (Y : 'M_(t, n)) : (Y <= N)%MS <-> forall k, Y *m krylov A B k = 0.
  split=> [YN k|z]; last by apply/sub_kermxP/reach_annihilated => k _.
  have /mxrank_leqif_sup[_] : (kermx (reach A B (maxn n k.+1)) <= N)%MS.
    apply/sub_kermxP/reach_annihilated => i ik.
    have /reach_annihilated := mulmx_ker (reach A B (maxn n k.+1)); apply.
    by rewrite leq_max ik.
  rewrite !mxrank_ker rank_reach_n ?leq_maxl// eqxx => /esym /(submx_trans YN).
  by move/sub_kermxP/reach_annihilated; apply; rewrite leq_maxr.
have QN : (Q <= N)%MS by rewrite eq_row_base.
have [A' eA] : exists A', Q *m A = A' *m Q.
  apply/submxP; rewrite eq_row_base; apply/all => k.
  by rewrite -mulmxA -krylovS; apply: (all _ Q).1 QN k.+1.
exists (\rank N), Q, A'; split=> //; first exact: row_base_free.
  exact: (all _ Q).1 QN 0%N.
by move=> t Y /all YN; apply/submxP; rewrite eq_row_base.
Qed.
End Invariant.

Section Channel.
Variables (K : fieldType) (n b c d : nat) (A : 'M[K]_n) (B : 'M[K]_(n, b)) (C : 'M[K]_(c, n)).
Variables (A' : 'M[K]_d) (B' : 'M[K]_(d, b)) (C' : 'M[K]_(c, d)) (kc ko : nat).
(* (A', B', C') has the same transfer matrix, is controllable and observable *)
Hypothesis same : forall k, C *m krylov A B k = C' *m krylov A' B' k.
Hypothesis controls : row_free (reach A' B' kc).
Hypothesis observes : row_free (reach A'^T C'^T ko).

(* a map onto the states of the minimal realization *)
Lemma onto_minimal : exists W : 'M_(d, n), forall k, W *m krylov A B k = krylov A' B' k.
Proof.
pose V := pinvmx (reach A'^T C'^T ko); have := mulmxVp observes.
rewrite -/V -[V]submxcolK /reach mul_mxrow_mxcol => /(congr1 trmx); rewrite trmx1 linear_sum /= => e.
pose O n' (A0 : 'M[K]_n') (C0 : 'M_(c, n')) i := (krylov A0^T C0^T i)^T.
have OE n' (A0 : 'M_n') (C0 : 'M_(c, n')) (B0 : 'M_(n', b)) i k :
    O n' A0 C0 i *m krylov A0 B0 k = C0 *m krylov A0 B0 (i + k).
  elim: i k => [|i IH] k; first by rewrite /O /= trmxK.
  by rewrite /O krylovS trmx_mul trmxK -mulmxA -krylovS -/(O n' A0 C0 i) IH addnS.
exists (\sum_(i < ko) (submxcol V i)^T *m O n A C i) => k.
rewrite -[RHS]mul1mx -e !mulmx_suml; apply: eq_bigr => i _.
by rewrite trmx_mul -!mulmxA -/(O d A' C' i) !OE same.
Qed.

Lemma reached_free e (Y : 'M_(d, e)) : (forall k, exists Z, krylov A' B' k = Y *m Z) -> row_free Y.
Proof.
move=> h; have [Z eZ] : exists Z, forall k : 'I_kc, krylov A' B' k = Y *m Z k.
  by have [Z eZ] := fin_all_exists (fun k : 'I_kc => h k); exists Z.
apply/row_freeP; exists (\mxrow_(k < kc) Z k *m pinvmx (reach A' B' kc)).
by rewrite mulmxA mul_mxrow -(eq_mxrow eZ) mulmxVp.
Qed.

Lemma peel : exists w (Q : 'M_(w, n)) A2 (phi : {poly K}),
  [/\ row_free Q, Q *m A = A2 *m Q, Q *m B = 0, phi \is monic & (size phi + d + w = n.+1)%N] /\
  [/\ forall t (Y : 'M_(t, n)), (forall k, Y *m krylov A B k = 0) -> Y = Y *m pinvmx Q *m Q &
  forall (L : fieldType) (f : {rmorphism K -> L}) (F : 'M[L]_(b, c)) (R : 'M[L]_(n, w)),
    char_poly (map_mx f A + map_mx f B *m F *m map_mx f C + R *m map_mx f Q) =
    map_poly f phi * char_poly (map_mx f A' + map_mx f B' *m F *m map_mx f C')
      * char_poly (map_mx f A2 + map_mx f Q *m R)].
Proof.
have [w [Q [A2 [fQ QA QB un]]]] := unreached A B.
have [v [X [en fX QX kerQ]]] := kernel_basis fQ.
have [A1 AX] : exists A1, A *m X = X *m A1 by apply: kerQ; rewrite mulmxA QA -mulmxA QX mulmx0.
have [B1 BX] : exists B1, B = X *m B1 by apply: kerQ.
have killed t (Y : 'M_(t, n)) : (forall k, Y *m krylov A B k = 0) -> Y *m X = 0.
  by case/un=> Z ->; rewrite -mulmxA QX mulmx0.
have kX k : krylov A B k = X *m krylov A1 B1 k.
  by elim: k => [//|k IH]; rewrite !krylovS IH !mulmxA AX.
have [W WE] := onto_minimal; pose W1 := W *m X.
have fW1 : row_free W1.
  by apply: reached_free => k; exists (krylov A1 B1 k); rewrite -WE kX mulmxA.
have W1A : W1 *m A1 = A' *m W1.
  rewrite /W1 -mulmxA -AX !mulmxA; apply/eqP; rewrite -subr_eq0 -mulmxBl; apply/eqP/killed => k.
  by rewrite mulmxBl -mulmxA -krylovS WE -mulmxA WE krylovS subrr.
have W1B : W1 *m B1 = B' by rewrite -mulmxA -BX -[B]/(krylov A B 0) WE.
have CW : C *m X = C' *m W1.
  rewrite mulmxA; apply/eqP; rewrite -subr_eq0 -mulmxBl; apply/eqP/killed => k.
  by rewrite mulmxBl -mulmxA WE same subrr.
have [u [X0 [ev fX0 WX0 kerW]]] := kernel_basis fW1.
have [A0 AX0] : exists A0, A1 *m X0 = X0 *m A0 by apply: kerW; rewrite mulmxA W1A -mulmxA WX0 mulmx0.
exists w, Q, A2, (char_poly A0); split.
  split=> //; first exact: char_poly_monic.
  by rewrite size_char_poly en ev !addSn.
split=> [t Y /un[Z ->]|L f F R]; first by rewrite mulmxKpV// submxMl.
rewrite (@char_poly_split L n v w (map_mx f X) (map_mx f Q) _
  (map_mx f A1 + map_mx f B1 *m F *m map_mx f C' *m map_mx f W1) (map_mx f A2 + map_mx f Q *m R))
  ?row_full_map ?row_free_map//; first last.
- by rewrite mulmxDr mulmxDr !mulmxA -!map_mxM QA QB map_mx0 !mul0mx addr0 mulmxDl map_mxM.
- rewrite mulmxDl mulmxDl -[R *m _ *m _]mulmxA -!map_mxM QX map_mx0 mulmx0 addr0 mulmxDr.
  by rewrite AX {1}BX -[_ *m map_mx f C *m _]mulmxA -!map_mxM CW !map_mxM !mulmxA.
- by rewrite -map_mxM QX map_mx0.
congr (_ * _); rewrite map_char_poly.
apply: (@char_poly_split L v u d (map_mx f X0) (map_mx f W1)); rewrite ?row_full_map ?row_free_map//.
- by rewrite -map_mxM WX0 map_mx0.
- by rewrite mulmxDl -!map_mxM AX0 -[_ *m map_mx f W1 *m _]mulmxA -map_mxM WX0 map_mx0 mulmx0 addr0.
- by rewrite mulmxDr mulmxDl !mulmxA -!map_mxM W1A W1B.
Qed.
End Channel.

(* All components: J, with an order in which every arc but those within a component goes down. *)
Section Split.
Variables (K : fieldType) (J : finType) (p q d : J -> nat) (height : J -> nat).
Variables (A' : forall j, 'M[K]_(d j)) (B' : forall j, 'M[K]_(d j, p j)) (C' : forall j, 'M[K]_(q j, d j)).
Variables (kc ko : J -> nat).
Hypothesis controls : forall j, row_free (reach (A' j) (B' j) (kc j)).
Hypothesis observes : forall j, row_free (reach (A' j)^T (C' j)^T (ko j)).

(* det(xI - A'_j - B'_j F_j C'_j) *)
Definition part (L : fieldType) (f : {rmorphism K -> L}) (F : forall j, 'M[L]_(p j, q j)) j : {poly L} :=
  char_poly (map_mx f (A' j) + map_mx f (B' j) *m F j *m map_mx f (C' j)).

Theorem spectrum_split (D : {set J}) n (A : 'M[K]_n) (B : forall j, 'M_(n, p j)) (C : forall j, 'M_(q j, n)) :
  (forall j, j \in D -> forall k, C j *m krylov A (B j) k = C' j *m krylov (A' j) (B' j) k) ->
  (forall j i, j \in D -> i \in D -> j != i -> (height j <= height i)%N ->
     forall k, C i *m krylov A (B j) k = 0) ->
  exists phi : {poly K}, [/\ phi \is monic, (size phi + \sum_(j in D) d j = n.+1)%N &
    forall (L : fieldType) (f : {rmorphism K -> L}) (F : forall j, 'M[L]_(p j, q j)),
      char_poly (map_mx f A + \sum_(j in D) map_mx f (B j) *m F j *m map_mx f (C j)) =
      map_poly f phi * \prod_(j in D) part f F j].
Proof.
elim: {D}_.+1 {-2}D (ltnSn #|D|) n A B C => // N IH D leD n A B C same down.
have [->|[j0 j0D]] := set_0Vmem D.
  exists (char_poly A); split; first exact: char_poly_monic.
    by rewrite big_set0 addn0 size_char_poly.
  by move=> L f F; rewrite !big_set0 addr0 mulr1 map_char_poly.
case: (arg_minnP height j0D) => j jD' low; have jD : j \in D by exact: jD'.
have [w [Q [A2 [phi0 [[fQ QA QB m0 s0] [un split0]]]]]] := peel (same j jD) (controls j) (observes j).
pose C2 i := C i *m pinvmx Q.
have CE i : i \in D :\ j -> C i = C2 i *m Q.
  rewrite in_setD1 => /andP[ij iD]; apply: un => k; apply: down => //; first by rewrite eq_sym.
  exact: low.
have kQ i k : Q *m krylov A (B i) k = krylov A2 (Q *m B i) k.
  by elim: k => [//|k IHk]; rewrite !krylovS mulmxA QA -mulmxA IHk.
have markov i i' k : i' \in D :\ j -> C2 i' *m krylov A2 (Q *m B i) k = C i' *m krylov A (B i) k.
  by move=> i'D; rewrite -kQ mulmxA -CE.
have leD' : (#|D :\ j| < N)%N by move: leD; rewrite (cardsD1 j) jD.
have [i iD k|i i' iD i'D ii' h k|phi [m s sp]] := IH _ leD' w A2 (fun i => Q *m B i) C2.
- by rewrite markov// same//; move: iD; rewrite in_setD1 => /andP[].
- by rewrite markov//; apply: down => //; [move: iD|move: i'D]; rewrite in_setD1 => /andP[].
exists (phi0 * phi); split=> [||L f F]; first by rewrite monicMl.
  rewrite size_monicM ?monic_neq0// (big_setD1 j)//=.
  apply: succn_inj; rewrite -addSn prednK; first by rewrite addnACA s addnS s0.
  by rewrite addn_gt0 size_poly_gt0 monic_neq0.
rewrite (big_setD1 j)//= addrA rmorphM /= [\prod_(i in D) _](big_setD1 j)//=.
have -> : \sum_(i in D :\ j) map_mx f (B i) *m F i *m map_mx f (C i) =
    (\sum_(i in D :\ j) map_mx f (B i) *m F i *m map_mx f (C2 i)) *m map_mx f Q.
  by rewrite mulmx_suml; apply: eq_bigr => i iD; rewrite CE// map_mxM mulmxA.
rewrite split0 mulmx_sumr -/(part f F j).
have -> : \sum_(i in D :\ j) map_mx f Q *m (map_mx f (B i) *m F i *m map_mx f (C2 i)) =
    \sum_(i in D :\ j) map_mx f (Q *m B i) *m F i *m map_mx f (C2 i).
  by apply: eq_bigr => i _; rewrite [map_mx f (Q *m B i)]map_mxM !mulmxA.
by rewrite sp mulrACA -!mulrA; congr (_ * _); rewrite mulrCA.
Qed.
End Split.

(* A realization that is controllable and observable has the least dimension: the McMillan degree. *)
Section Minimal.
Variables (K : fieldType) (n b c d : nat) (A : 'M[K]_n) (B : 'M[K]_(n, b)) (C : 'M[K]_(c, n)).
Variables (A' : 'M[K]_d) (B' : 'M[K]_(d, b)) (C' : 'M[K]_(c, d)) (kc ko : nat).

Theorem minimal_realization : row_free (reach A' B' kc) -> row_free (reach A'^T C'^T ko) ->
  (forall k, C *m krylov A B k = C' *m krylov A' B' k) -> (d <= n)%N.
Proof.
move=> con obs same; have [w [Q [A2 [phi [[_ _ _ m e] _]]]]] := peel same con obs.
by rewrite -ltnS -e -addnA -[d.+1]add1n leq_add ?leq_addr// size_poly_gt0 monic_neq0.
Qed.
End Minimal.
