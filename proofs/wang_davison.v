(* Wang and Davison: decentralized control gives a plant every spectrum region that contains its fixed modes.  For every
   number a of the field some dynamic channel controllers leave no eigenvalue but fixed ones and a.

   One channel: Kalman's decomposition splits off what the channel does not control or observe, and
   Brasch and Pearson's theorem places the rest.  A strongly connected transfer graph: the gains of
   two_sided_gains.v leave only fixed modes to be split off.  Any transfer graph: component by component.

   Z is what may stay; controller_at i is a controller at channel i, of any dimension. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import neighbor_graph extended_bound sequential_gains feedback corfmat_morse.
From mcexact Require Import brasch_pearson theorem_1 delayed_systems construction strong_components.
From mcexact Require Import spectrum_split component_gains component_assignment two_sided_gains.
From mcexact Require Import dynamic_controllers.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section OneChannel.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Notation up M := (map_mx f M).

Lemma controllable_modes n b (A : 'M[K]_n) (B : 'M_(n, b)) :
  controllable A B <-> forall lambda, ~~ uncontrollable_mode (up A) (up B) lambda.
Proof.
split=> [ctr lambda|none]; first by rewrite /uncontrollable_mode controllable_hautus // ltnn.
rewrite -(controllable_map f); apply: contraT => /uncontrollable_has_mode[l ml].
by have := none l; rewrite ml.
Qed.

(* what B does not reach splits off, whatever the controller *)
Lemma unreached_splits n b c (A : 'M[K]_n) (B : 'M_(n, b)) (C : 'M_(c, n)) :
  exists v (A1 : 'M[K]_v) (B1 : 'M_(v, b)) (C1 : 'M_(c, v)) (psi : {poly K}), [/\ controllable A1 B1,
    forall k (Ac : 'M_k) (Bc : 'M_(k, c)) (Cc : 'M_(b, k)) (D : 'M_(b, c)),
      char_poly (compensated A B C Ac Bc Cc D) = char_poly (compensated A1 B1 C1 Ac Bc Cc D) * psi,
    (v + (size psi).-1)%N = n /\ psi \is monic,
    forall lambda, root (map_poly f psi) lambda -> uncontrollable_mode (up A) (up B) lambda &
    forall lambda, uncontrollable_mode (up A1^T) (up C1^T) lambda ->
                   uncontrollable_mode (up A^T) (up C^T) lambda].
Proof.
have [w [Q [A2 [fQ QA QB un]]]] := unreached A B; have [v [X [en fX QX kerQ]]] := kernel_basis fQ.
have [A1 AX] : exists A1, A *m X = X *m A1 by apply: kerQ; rewrite mulmxA QA -mulmxA QX mulmx0.
have [B1 BX] : exists B1, B = X *m B1 by apply: kerQ.
have kX k : krylov A B k = X *m krylov A1 B1 k.
  by elim: k => [|k IH]; [exact: BX | rewrite !krylovS IH !mulmxA AX].
exists v, A1, B1, (C *m X), (char_poly A2); split.
- apply/controllableP => y hy; have [Z eZ] : exists Z, y *m pinvmx X = Z *m Q.
    by apply: un => k; rewrite kX mulmxA -(mulmxA y) mulVpmx // mulmx1 hy.
  by rewrite -[y]mulmx1 -(mulVpmx fX) mulmxA eZ -mulmxA QX mulmx0.
- move=> k Ac Bc Cc D.
  apply: (@char_poly_split _ _ _ _ (block_mx X 0 0 1%:M) (row_mx Q 0)).
  + by rewrite en addnAC.
  + apply/row_fullP; exists (block_mx (pinvmx X) 0 0 1%:M).
    by rewrite mulmx_block !(mulmx0, mul0mx, mulmx1, addr0, add0r) mulVpmx // -scalar_mx_block.
  + apply/row_freeP; exists (col_mx (pinvmx Q) 0).
    by rewrite mul_row_col mulmx0 addr0 mulmxVp.
  + by rewrite mul_row_block QX !(mulmx0, mul0mx, addr0) row_mx0.
  + rewrite /compensated !mulmx_block !(mulmx0, mul0mx, mulmx1, mul1mx, addr0, add0r) mulmxDl mulmxDr AX.
    by rewrite {1 2}BX !mulmxA.
  rewrite /compensated mul_row_block !mul0mx !addr0 mul_mx_row mulmx0 mulmxDr QA mulmxA.
  by rewrite mulmxA QB !mul0mx addr0 [Q *m (B *m Cc)]mulmxA QB mul0mx.
- by rewrite size_char_poly char_poly_monic -en.
- move=> lambda; rewrite map_char_poly -eigenvalue_root_char => /eigenvalueP[y yA y0].
  have fQ' : row_free (up Q) by rewrite row_free_map.
  apply/uncontrollable_modeP; exists (y *m up Q); split.
  + by apply: contra y0 => /eqP yQ; apply/eqP/(row_free_inj fQ'); rewrite yQ mul0mx.
  + by rewrite -mulmxA -map_mxM QA map_mxM mulmxA yA scalemxAl.
  by rewrite -mulmxA -map_mxM QB map_mx0 mulmx0.
move=> lambda /uncontrollable_modeP[y [y0 yA yC]]; apply/uncontrollable_modeP; exists (y *m up X^T).
have fXT : row_free (up X^T) by rewrite row_free_map /row_free mxrank_tr.
split.
- by apply: contra y0 => /eqP yX; apply/eqP/(row_free_inj fXT); rewrite yX mul0mx.
- by rewrite -mulmxA -map_mxM -trmx_mul AX trmx_mul map_mxM mulmxA yA scalemxAl.
by rewrite -mulmxA -map_mxM -trmx_mul.
Qed.

Lemma compensated_tr n b c k (A : 'M[K]_n) (B : 'M_(n, b)) (C : 'M_(c, n))
    (Ac : 'M_k) (Bc : 'M_(k, c)) (Cc : 'M_(b, k)) (D : 'M_(b, c)) :
  char_poly (compensated A^T C^T B^T Ac^T Cc^T Bc^T D^T) = char_poly (compensated A B C Ac Bc Cc D).
Proof.
rewrite -char_poly_tr /compensated tr_block_mx; congr char_poly.
by rewrite linearD /= !trmx_mul !trmxK !mulmxA.
Qed.

(* Kalman: what is controllable and observable, and what is not *)
Theorem hidden_splits n b c (A : 'M[K]_n) (B : 'M_(n, b)) (C : 'M_(c, n)) :
  exists d (A1 : 'M[K]_d) (B1 : 'M_(d, b)) (C1 : 'M_(c, d)) (psi : {poly K}), [/\
    controllable A1 B1 /\ controllable A1^T C1^T,
    forall k (Ac : 'M_k) (Bc : 'M_(k, c)) (Cc : 'M_(b, k)) (D : 'M_(b, c)),
      char_poly (compensated A B C Ac Bc Cc D) = char_poly (compensated A1 B1 C1 Ac Bc Cc D) * psi,
    (d + (size psi).-1)%N = n /\ psi \is monic &
    forall lambda, root (map_poly f psi) lambda -> hidden f A B C lambda].
Proof.
have [v [A1 [B1 [C1 [psi1 [ctr s1 [d1 m1] u1 o1]]]]]] := unreached_splits A B C.
have [d [A2 [C2 [B2 [psi2 [obs s2 [d2 m2] u2 o2]]]]]] := unreached_splits A1^T C1^T B1^T.
exists d, A2^T, B2^T, C2^T, (psi2 * psi1); split.
- split; last by rewrite !trmxK.
  apply/controllable_modes => lambda; apply: contra ((controllable_modes _ _).1 ctr lambda) => h.
  by have := o2 lambda h; rewrite !trmxK.
- move=> k Ac Bc Cc D; rewrite s1 -compensated_tr s2 mulrA; congr (_ * _ * _).
  by rewrite -[RHS]compensated_tr !trmxK.
- split; last by rewrite rpredM.
  rewrite -d1 -d2 -addnA size_mul ?monic_neq0 //; congr addn.
  have [g2 g1] : (0 < size psi2)%N /\ (0 < size psi1)%N by rewrite !size_poly_gt0 !monic_neq0.
  by rewrite -{1}(prednK g2) -{1}(prednK g1) addSn addnS.
by move=> lambda; rewrite rmorphM rootM => /orP[/u2/o1|/u1]; rewrite /hidden => ->; rewrite ?orbT.
Qed.

(* all but the hidden part of the spectrum is freely assignable *)
Theorem all_but_hidden n b c (A : 'M[K]_n) (B : 'M_(n, b)) (C : 'M_(c, n)) : infinite K ->
  exists d (psi : {poly K}), [/\ (d + (size psi).-1)%N = n, psi \is monic,
    forall lambda, root (map_poly f psi) lambda -> hidden f A B C lambda &
    forall k (P : {poly K}), (d <= k.+1)%N -> P \is monic -> size P = (d + k).+1 ->
      exists (Ac : 'M_k) (Bc : 'M_(k, c)) (Cc : 'M_(b, k)) (D : 'M_(b, c)),
        char_poly (compensated A B C Ac Bc Cc D) = P * psi].
Proof.
move=> inf; have [d [A1 [B1 [C1 [psi [[ctr obs] s [dn mpsi] h]]]]]] := hidden_splits A B C.
exists d, psi; split=> // k P dk mP sP.
have rk : \rank (reach A1 B1 k.+1) = d by rewrite rank_reach_n //; apply/eqP.
have [Ac [Bc [Cc [D e]]]] := brasch_pearson_minimum f inf ctr obs (or_introl rk) mP sP.
by exists Ac, Bc, Cc, D; rewrite s e.
Qed.
End OneChannel.

Section Controllers.
Variables (K : fieldType) (m : nat) (p q : 'I_m -> nat).

Definition controller_at (i : 'I_m) :=
  {k : nat & ('M[K]_(p i, q i) * 'M[K]_(p i, k) * 'M[K]_(k, q i) * 'M[K]_k)%type}.
Definition assembled (X : forall i, controller_at i) : controllers K p q (fun i => projT1 (X i)) :=
  Controllers (fun i => (projT2 (X i)).1.1.1) (fun i => (projT2 (X i)).1.1.2)
              (fun i => (projT2 (X i)).1.2) (fun i => (projT2 (X i)).2).

Lemma assembled_eq n (S : multichannel K n p q) (X Y : forall i, controller_at i) :
  (forall i, X i = Y i) -> char_poly (dynamic_loop S (assembled X)) = char_poly (dynamic_loop S (assembled Y)).
Proof.
move=> e; apply/eqP; rewrite -tofrac_eq; apply/eqP; rewrite !dynamic_fraction /=; congr (\det (_ - _) * _).
  by rewrite /closed_loop; congr (_ + _); apply: eq_bigr => i _; rewrite /= e.
by apply: eq_bigr => i _; rewrite e.
Qed.

Lemma member_at_alone (T : 'I_m -> Type) (d : forall i, T i) o (x : T o) :
  exists g : forall i, T i, g o = x /\ forall i, i != o -> g i = d i.
Proof.
exists (fun i => if o =P i is ReflectT e then ecast i (T i) e x else d i); split.
  by case: eqP => // e; rewrite eq_axiomK.
by move=> i /eqP io; case: eqP => // e; case: io; exact: esym e.
Qed.

(* without states *)
Lemma static_loop n (S : multichannel K n p q) (F : gains K p q) :
  char_poly (dynamic_loop S (assembled (fun i => existT _ 0%N (F i, 0, 0, 0)))) = char_poly (closed_loop S F).
Proof.
apply/eqP; rewrite -tofrac_eq; apply/eqP; rewrite dynamic_fraction /= [RHS]char_poly_fraction.
rewrite big1 => [|i _]; last by rewrite /char_poly det_mx00 tofrac1.
rewrite mulr1; congr (\det (_ - _)); rewrite /closed_loop map_mxD (map_mx_sum (constant_fraction K)).
by congr (_ + _); apply: eq_bigr => i _; rewrite /response map_mx0 !mul0mx addr0 /= !map_mxM.
Qed.
End Controllers.

Section Connected.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variable S : multichannel K n p q.
Hypothesis inf : infinite K.

(* through one channel, whichever it is *)
Theorem connected_but (Z : pred L) (o : 'I_m) : strongly_connected (transfer_arc S) ->
  (forall lambda, fixed_over f S lambda -> Z lambda) ->
  exists d (psi : {poly K}), [/\ (d + (size psi).-1)%N = n, psi \is monic,
    forall lambda, root (map_poly f psi) lambda -> Z lambda &
    forall k (P : {poly K}), (d <= k.+1)%N -> P \is monic -> size P = (d + k).+1 ->
      exists X : forall i, controller_at K p q i, [/\ projT1 (X o) = k,
        forall i, i != o -> projT1 (X i) = 0%N & char_poly (dynamic_loop S (assembled X)) = P * psi]].
Proof.
move=> sc fixZ; have [F hF] := one_channel_but inf o sc fixZ.
have [d [psi [dn mpsi roots assign]]] := all_but_hidden f (closed_loop S F) (mcB S o) (mcC S o) inf.
exists d, psi; split=> [||lambda /roots/hF|k P dk mP sP] //.
have [Ac [Bc [Cc [D e]]]] := assign k P dk mP sP.
have [X [Xo Xi]] := @member_at_alone m (controller_at K p q) (fun i => existT _ 0%N (F i, 0, 0, 0)) o
  (existT _ k (F o + D, Cc, Bc, Ac)).
exists X; split; first by rewrite Xo.
  by move=> i /Xi ->.
have only i : i != o -> projT1 (X i) = 0%N by move/Xi->.
rewrite (dynamic_loop_only only) -e /compensated.
pose loop (x : controller_at K p q o) M := char_poly (block_mx M (mcB S o *m (projT2 x).1.1.2)
  ((projT2 x).1.2 *m mcC S o) (projT2 x).2).
transitivity (loop (X o) (closed_loop S (ctF (assembled X)))); first exact: erefl.
rewrite Xo.
rewrite /loop.
have -> : closed_loop S (ctF (assembled X)) = closed_loop S F + mcB S o *m D *m mcC S o; last by [].
pose G i := (projT2 (X i)).1.1.1; rewrite -[ctF _]/G.
have GF i : i != o -> G i = F i by rewrite /G => /Xi ->.
have GD : G o = F o + D by rewrite /G Xo.
rewrite /closed_loop -addrA; congr (_ + _); rewrite (bigD1 o) //= [in RHS](bigD1 o) //= GD.
rewrite mulmxDr mulmxDl addrAC; congr (_ + _ + _).
by apply: eq_bigr => i /GF ->.
Qed.
End Connected.

Section AnyGraph.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variable S : multichannel K n p q.
Hypothesis inf : infinite K.
Notation e := (transfer_arc S).

(* controllers of the components together *)
Lemma join_components (E : forall (c : {set 'I_m}) (t : 'I_#|c|), controller_at K p q (enum_val t)) :
  exists X : forall i, controller_at K p q i,
    forall c, c \in components S -> forall t : 'I_#|c|, X (enum_val t) = E c t.
Proof.
have [X h] : exists X : forall i, controller_at K p q i, forall i c, c \in components S ->
    forall (t : 'I_#|c|) (et : enum_val t = i), X i = eq_rect _ (controller_at K p q) (E c t) i et.
  apply: (fin_all_exists (P := fun i X => forall c, c \in components S ->
    forall (t : 'I_#|c|) (et : enum_val t = i), X = eq_rect _ (controller_at K p q) (E c t) i et)) => i.
  pose t0 := enum_rank_in (in_component S i) i.
  have e0 : enum_val t0 = i by rewrite enum_rankK_in ?in_component.
  exists (eq_rect _ (controller_at K p q) (E _ t0) i e0) => c cC t et.
  have ec : c = component e i by apply/eqP; rewrite -component_unique // -et enum_valP.
  subst c; have tt : t = t0 by apply: enum_val_inj; rewrite e0.
  by subst t; rewrite (eq_irrelevance et e0).
by exists X => c cC t; rewrite (h _ c cC t erefl).
Qed.

(* Wang and Davison *)
Theorem wang_davison (Z : pred L) (a : K) : (forall lambda, fixed_over f S lambda -> Z lambda) ->
  exists k (D : controllers K p q k), forall lambda : L,
    eigenvalue (map_mx f (dynamic_loop S D)) lambda -> Z lambda || (lambda == f a).
Proof.
move=> fixZ; have [DT min] : exists DT : forall c : {set 'I_m}, {d & multichannel K d p q},
    forall c, minimal c S (projT2 (DT c)).
  apply: (fin_all_exists (P := fun c DT => minimal c S (projT2 DT))) => c.
  by have [d [T h]] := minimal_exists S c; exists (existT _ d T).
pose d c := projT1 (DT c); pose T c : multichannel K (d c) p q := projT2 (DT c).
have [phi [_ _ parts]] := @component_spectrum_dynamic K n m p q S d T min.
have [phi' [_ _ split]] := @component_spectrum K n m p q S d T min.
have phiZ lambda : root (map_poly f phi) lambda -> Z lambda.
  move=> r; apply: fixZ => F; rewrite eigenvalue_root_char -map_char_poly -static_loop parts.
  by rewrite rmorphM rootM r.
have each (c : {set 'I_m}) : exists E : forall t : 'I_#|c|, controller_at K p q (enum_val t), c \in components S ->
    forall lambda, root (map_poly f (char_poly (dynamic_loop (own_channels c (T c))
      (@assembled _ _ (fun t : 'I_#|c| => p (enum_val t)) (fun t => q (enum_val t)) E)))) lambda ->
    Z lambda || (lambda == f a).
  have [cC|nC] := boolP (c \in components S); last by exists (fun=> existT _ 0%N (0, 0, 0, 0)).
  have [real _ _] := min c; have /imsetP[o _ ec] := cC.
  have oc : o \in c by rewrite ec in_component.
  have fixT lambda : fixed_over f (own_channels c (T c)) lambda -> Z lambda.
    move=> fx; apply: fixZ => F; rewrite eigenvalue_root_char map_closed_loop split rootM (big_setD1 c) //=.
    rewrite rootM; have := fx (fun t => F (enum_val t)); rewrite eigenvalue_root_char map_closed_loop.
    by rewrite (own_channels_loop c (map_system f (T c)) (fun i => map_mx f (F i))) => ->; rewrite orbT.
  have [r [psi [_ mpsi psiZ assign]]] := connected_but inf (enum_rank_in oc o) (own_channels_connected cC real) fixT.
  have [||X [_ _ eX]] := assign r (('X - a%:P) ^+ (r + r)) (leqnSn _).
  - by rewrite monic_exp ?monicXsubC.
  - by rewrite size_exp_XsubC.
  exists X => _ lambda; rewrite eX rmorphM rootM => /orP[|/psiZ -> //].
  rewrite rmorphX /= rmorphB /= map_polyX map_polyC /= => /rootP.
  rewrite horner_exp hornerXsubC => /eqP; rewrite expf_eq0 subr_eq0 => /andP[_ ->].
  by rewrite orbT.
have [E hE] := fin_all_exists each; have [X hX] := join_components E.
exists (fun i => projT1 (X i)), (assembled X) => lambda.
rewrite eigenvalue_root_char -map_char_poly parts rmorphM rootM => /orP[/phiZ -> //|].
rewrite rmorph_prod /= => /rootP; rewrite horner_prod => /eqP/prodf_eq0[c cC].
rewrite -/(root _ lambda).
move=> r; apply: (hE c cC); move: r; congr (root (map_poly f _) lambda).
exact: (assembled_eq (own_channels c (T c)) (hX c cC)).
Qed.

(* so fixed modes in a region are enough, and every loop has them *)
Theorem region_attained (Z : pred L) (a : K) : Z (f a) ->
  (forall lambda, fixed_over f S lambda -> Z lambda) <->
  exists k (D : controllers K p q k), forall lambda : L,
    eigenvalue (map_mx f (dynamic_loop S D)) lambda -> Z lambda.
Proof.
move=> Za; split=> [fixZ|[k [D h]] lambda fx].
  have [k [D h]] := wang_davison a fixZ; exists k, D => lambda /h /orP[|/eqP ->] //.
by apply: h; rewrite map_dynamic_loop; apply: fixed_dynamic_over.
Qed.
End AnyGraph.
