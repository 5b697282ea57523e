(* The paper, end of IV-A, with dynamic controllers: the spectrum is that of the strong components, each with
   the controllers of its own channels; and when nothing is fixed, a controller at one channel of every
   component gives each component any characteristic polynomial.

   A dynamic controller is a gain over the field of fractions of K[x]: x - A_F with that gain is the Schur
   complement of the loop. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import neighbor_graph extended_bound feedback corfmat_morse brasch_pearson.
From mcexact Require Import strong_components spectrum_split assignability component_gains.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Lemma char_poly_mxdiag (R : comRingType) m (k : 'I_m -> nat) (M : forall i, 'M[R]_(k i)) :
  char_poly (\mxdiag_i M i) = \prod_i char_poly (M i).
Proof.
elim: m k M => [|m IH] k M.
  have d0 n : n = 0%N -> forall N : 'M[{poly R}]_n, \det N = 1 by move=> -> N; apply: det_mx00.
  by rewrite [RHS]big_ord0; apply: d0; rewrite big_ord0.
rewrite mxdiag_recl [RHS]big_ord_recl -IH.
have cast n n' (e : n = n') (N : 'M[R]_n) : char_poly (castmx (e, e) N) = char_poly N.
  by case: _ / e; rewrite castmx_id.
rewrite cast /char_poly /char_poly_mx map_block_mx scalar_mx_block opp_block_mx add_block_mx.
by rewrite /= !map_mx0 !oppr0 !addr0 det_ublock.
Qed.

Lemma map_mxdiag (R R' : ringType) (h : {rmorphism R -> R'}) m (k : 'I_m -> nat) (M : forall i, 'M[R]_(k i)) :
  map_mx h (\mxdiag_i M i) = \mxdiag_i map_mx h (M i).
Proof.
elim: m k M => [|m IH] k M.
  by apply/matrixP=> i; have := ltn_ord i; rewrite [X in (_ < X)%N]big_ord0.
rewrite !mxdiag_recl -IH; move: (\mxdiag_i M (lift ord0 i)) => N.
by rewrite map_castmx map_block_mx !map_mx0.
Qed.

Section Fractions.
Variable K : fieldType.
Notation L := {fraction {poly K}}.
Notation tofrac := (@FracField.tofrac [idomainType of {poly K}]).
Definition constant_fraction : {rmorphism K -> L} := [rmorphism of tofrac \o polyC].
Notation g := constant_fraction.
Notation x := (tofrac 'X : L).

Lemma char_poly_at n (M : 'M[L]_n) : (char_poly M).[x] = \det (x%:M - M).
Proof.
rewrite -/(horner_eval x _) -det_map_mx; congr (\det _); apply/matrixP=> i j.
by rewrite !mxE /= /horner_eval; case: eqP => _; rewrite !hornerE.
Qed.

Lemma poly_at (r : {poly K}) : (map_poly g r).[x] = tofrac r.
Proof.
rewrite -[RHS](congr1 _ (comp_polyXr r)) /comp_poly -horner_map; congr (_.[_]).
by rewrite -map_poly_comp.
Qed.

Lemma char_poly_fraction n (M : 'M[K]_n) : tofrac (char_poly M) = \det (x%:M - map_mx g M) :> L.
Proof. by rewrite -poly_at map_char_poly char_poly_at. Qed.

Lemma char_unit n (M : 'M[K]_n) : x%:M - map_mx g M \in unitmx.
Proof. by rewrite unitmxE unitfE -char_poly_fraction tofrac_eq0 monic_neq0 ?char_poly_monic. Qed.

(* what the input is of the output: D + Cc (x - Ac)^-1 Bc *)
Definition response p q k (Ac : 'M[K]_k) (Bc : 'M_(k, q)) (Cc : 'M_(p, k)) (D : 'M_(p, q)) : 'M[L]_(p, q) :=
  map_mx g D + map_mx g Cc *m invmx (x%:M - map_mx g Ac) *m map_mx g Bc.

Lemma schur n k (M : 'M[L]_n) (N : 'M_(n, k)) R (Z : 'M[L]_k) Y : (x%:M - Z) *m Y = R ->
  \det (x%:M - block_mx M N R Z) = \det (x%:M - (M + N *m Y)) * \det (x%:M - Z).
Proof.
move=> e; have -> : \det (x%:M - block_mx M N R Z) =
    \det ((x%:M - block_mx M N R Z) *m block_mx 1%:M 0 Y 1%:M).
  by rewrite det_mulmx det_lblock !det1 !mulr1.
rewrite scalar_mx_block opp_block_mx add_block_mx !add0r mulmx_block !(mulmx1, mulmx0, add0r) e.
by rewrite addNr det_ublock mulNmx opprD addrA.
Qed.

Lemma compensated_fraction n p q k (A : 'M[K]_n) (B : 'M_(n, p)) (C : 'M_(q, n))
    (Ac : 'M_k) (Bc : 'M_(k, q)) (Cc : 'M_(p, k)) (D : 'M_(p, q)) :
  tofrac (char_poly (compensated A B C Ac Bc Cc D)) =
  \det (x%:M - (map_mx g A + map_mx g B *m response Ac Bc Cc D *m map_mx g C)) * tofrac (char_poly Ac) :> L.
Proof.
rewrite !char_poly_fraction /compensated map_block_mx.
rewrite (@schur _ _ _ _ _ _ (invmx (x%:M - map_mx g Ac) *m map_mx g (Bc *m C))); last first.
  by rewrite mulKVmx// char_unit.
congr (\det (_ - _) * _); rewrite map_mxD !map_mxM /response mulmxDr mulmxDl -addrA !mulmxA.
by [].
Qed.

Section Loop.
Variables (m : nat) (p q : 'I_m -> nat) (k : 'I_m -> nat).

Lemma dynamic_fraction n (S : multichannel K n p q) (D : controllers K p q k) :
  tofrac (char_poly (dynamic_loop S D)) = \det (x%:M - closed_loop (map_system g S)
    (fun i => response (ctK D i) (ctL D i) (ctG D i) (ctF D i))) * \prod_i tofrac (char_poly (ctK D i)) :> L.
Proof.
pose Y := \mxcol_i (invmx (x%:M - map_mx g (ctK D i)) *m map_mx g (ctL D i *m mcC S i)).
have mapcol : map_mx g (\mxcol_i (ctL D i *m mcC S i)) = \mxcol_i map_mx g (ctL D i *m mcC S i).
  apply/mxcolP=> i; rewrite mxcolK; have := mxcolK (fun i => ctL D i *m mcC S i) i.
  by move: (mxcol _) => M; rewrite /submxcol -map_mxsub => ->.
have maprow : map_mx g (\mxrow_i (mcB S i *m ctG D i)) = \mxrow_i map_mx g (mcB S i *m ctG D i).
  apply/mxrowP=> i; rewrite mxrowK; have := mxrowK (fun i => mcB S i *m ctG D i) i.
  by move: (mxrow _) => M; rewrite /submxrow -map_mxsub => ->.
have mapdiag : map_mx g (\mxdiag_i ctK D i) = \mxdiag_i map_mx g (ctK D i).
  exact: map_mxdiag.
rewrite char_poly_fraction /dynamic_loop map_block_mx (@schur _ _ _ _ _ _ Y); last first.
  rewrite mapcol mapdiag /Y mulmxBl mul_mxdiag_mxcol mul_scalar_mx.
  apply/mxcolP=> i; rewrite mxcolK.
  have sub a b (k' : 'I_a -> nat) (c : L) (U V : 'M[L]_(\sum_i k' i, b)) i' :
      submxcol (c *: U - V) i' = c *: submxcol U i' - submxcol V i' by apply/matrixP=> u v; rewrite !mxE.
  by rewrite sub !mxcolK -mul_scalar_mx -mulmxBl mulKVmx// char_unit.
rewrite -char_poly_fraction char_poly_mxdiag rmorph_prod; congr (\det (_ - _) * _).
rewrite maprow mul_mxrow_mxcol /closed_loop map_mxD (map_mx_sum g) -addrA -big_split /=; congr (_ + _).
apply: eq_bigr => i _; rewrite !map_mxM /response mulmxDr mulmxDl !mulmxA.
by [].
Qed.
End Loop.
End Fractions.

Section Components.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Notation e := (transfer_arc S).
Notation L := {fraction {poly K}}.
Notation g := (constant_fraction K).
Notation tofrac := (@FracField.tofrac [idomainType of {poly K}]).
Variables (d : {set 'I_m} -> nat) (T : forall c, multichannel K (d c) p q).
Hypothesis min : forall c, minimal c S (T c).

Lemma prod_components (h : 'I_m -> L) :
  \prod_(c in components S) \prod_(t < #|c|) h (enum_val t) = \prod_i h i.
Proof.
under eq_bigr => c _ do rewrite -(big_enum_val h) big_mkcond.
rewrite exchange_big /=; apply: eq_bigr => i _.
rewrite -big_mkcondr (big_pred1 (component e i))// => c /=.
have [cC|nC] := boolP (c \in components S); first by rewrite (component_unique i cC).
by apply/esym/negbTE; apply: contraNneq nC => ->; apply: component_of.
Qed.

(* the controllers of the channels of c *)
Definition own_controllers (c : {set 'I_m}) k (D : controllers K p q k) :
    controllers K (fun t : 'I_#|c| => p (enum_val t)) (fun t => q (enum_val t)) (fun t => k (enum_val t)) :=
  Controllers (fun t => ctF D (enum_val t)) (fun t => ctG D (enum_val t))
              (fun t => ctL D (enum_val t)) (fun t => ctK D (enum_val t)).
Definition component_loop c k (D : controllers K p q k) :=
  dynamic_loop (own_channels c (T c)) (own_controllers c D).

(* Dynamic channel controllers: one factor that they do not change, times the loop of every component. *)
Theorem component_spectrum_dynamic : exists phi : {poly K},
  [/\ phi \is monic, (size phi + \sum_(c in components S) d c = n.+1)%N &
  forall k (D : controllers K p q k),
    char_poly (dynamic_loop S D) = phi * \prod_(c in components S) char_poly (component_loop c D)].
Proof.
have [phi [mphi s split]] := component_spectrum min.
exists phi; split=> // k D; apply/eqP; rewrite -tofrac_eq; apply/eqP.
rewrite dynamic_fraction -char_poly_at split hornerM poly_at horner_prod rmorphM rmorph_prod /= -mulrA.
congr (_ * _); under [RHS]eq_bigr => c _ do rewrite dynamic_fraction.
rewrite big_split /= (prod_components (fun i => tofrac (char_poly (ctK D i)))); congr (_ * _).
apply: eq_bigr => c _; rewrite char_poly_at.
by rewrite -(own_channels_loop c (map_system g (T c))).
Qed.
End Components.

Section Assignment.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}) (n m : nat) (p q : 'I_m -> nat).
Variables (S : multichannel K n p q).
Hypothesis inf : infinite K.
Notation e := (transfer_arc S).

(* When nothing is fixed, n is the sum of the dimensions d c of the minimal realizations of the components;
   whatever the controllers, the spectrum is that of the components; and with a controller of order k c at
   one channel o c of each, every family of monic polynomials of degrees d c + k c is reached. *)
Theorem component_assignment : (forall lambda, ~ fixed_over f S lambda) ->
  exists (d : {set 'I_m} -> nat) (T : forall c, multichannel K (d c) p q),
  [/\ (\sum_(c in components S) d c = n)%N, forall c, minimal c S (T c),
  forall k (D : controllers K p q k),
    char_poly (dynamic_loop S D) = \prod_(c in components S) char_poly (component_loop T c D) &
  forall (o : {set 'I_m} -> 'I_m) (k : {set 'I_m} -> nat) (P : {set 'I_m} -> {poly K}),
    (forall c, c \in components S -> [/\ o c \in c, (d c <= (k c).+1)%N, P c \is monic &
      size (P c) = (d c + k c).+1]) ->
    exists (k' : 'I_m -> nat) (D : controllers K p q k'),
      (forall i, k' i = if o (component e i) == i then k (component e i) else 0%N) /\
      char_poly (dynamic_loop S D) = \prod_(c in components S) P c].
Proof.
move=> nofix; have [d [T [F [s split min own]]]] := component_gains inf nofix.
have [phi [mphi sphi parts]] := component_spectrum_dynamic min.
have phi1 : phi = 1.
  apply/eqP; rewrite -eqp_monic ?monic1// -size_poly_eq1 -(eqn_add2r n) -{1}s.
  by rewrite sphi.
have {}parts k (D : controllers K p q k) :
    char_poly (dynamic_loop S D) = \prod_(c in components S) char_poly (component_loop T c D).
  by rewrite parts phi1 mul1r.
exists d, T; split=> // o k P hP.
pose A c := own_loop c (T c) F.
pose g := constant_fraction K; pose tof := @FracField.tofrac [idomainType of {poly K}].
pose spec i (D : {ki : nat & ('M[K]_(p i, ki) * 'M[K]_(ki, q i) * 'M[K]_ki * 'M[K]_(p i, q i))%type}) :=
  let c := component e i in let: (G, H, Z, F') := projT2 D in
  projT1 D = (if o c == i then k c else 0%N) /\
  if o c == i then tof (P c) = \det ((tof 'X)%:M - (map_mx g (A c) +
      map_mx g (mcB (T c) i) *m (response Z H G F' - map_mx g (F i)) *m map_mx g (mcC (T c) i)))
      * tof (char_poly Z)
  else response Z H G F' = map_mx g (F i) /\ char_poly Z = 1.
have each i : exists D, spec i D.
  rewrite /spec; set c := component e i; have cC : c \in components S by apply: component_of.
  have [oi|_] := eqVneq (o c) i; last first.
    exists (existT _ 0%N (0, 0, 0, F i)); split=> //; split; last exact: det_mx00.
    by rewrite /response map_mx0 !mul0mx addr0.
  have [oc kd mP sP] := hP c cC; rewrite oi in oc; have [ctr obs] := own c i cC oc.
  have rk : \rank (reach (A c) (mcB (T c) i) (k c).+1) = d c by rewrite rank_reach_n//; apply/eqP.
  have [Z [H [G [D0 e0]]]] := brasch_pearson_minimum f inf ctr obs (or_introl rk) mP sP.
  exists (existT _ (k c) (G, H, Z, F i + D0)); split=> //.
  have -> : response Z H G (F i + D0) - map_mx g (F i) = response Z H G D0.
    by rewrite /response map_mxD -addrA addrAC subrr add0r.
  by rewrite /tof -compensated_fraction e0.
have [X hX] := fin_all_exists each.
pose k' i := projT1 (X i); pose D : controllers K p q k' := Controllers
  (fun i => (projT2 (X i)).2) (fun i => (projT2 (X i)).1.1.1) (fun i => (projT2 (X i)).1.1.2)
  (fun i => (projT2 (X i)).1.2).
pose R i := response (ctK D i) (ctL D i) (ctG D i) (ctF D i).
have hk i : k' i = (if o (component e i) == i then k (component e i) else 0%N).
  by have := hX i; rewrite /spec; case: (projT2 (X i)) => [[[G H] Z] F'] [].
have at_o i : o (component e i) = i -> tof (P (component e i)) =
    \det ((tof 'X)%:M - (map_mx g (A (component e i)) + map_mx g (mcB (T (component e i)) i) *m
      (R i - map_mx g (F i)) *m map_mx g (mcC (T (component e i)) i))) * tof (char_poly (ctK D i)).
  by move=> oi; have := hX i; rewrite /spec oi eqxx /R /D /=; case: (projT2 (X i)) => [[[G H] Z] F'] [].
have off_o i : o (component e i) != i -> R i = map_mx g (F i) /\ char_poly (ctK D i) = 1.
  move=> /negPf oi; have := hX i; rewrite /spec oi /R /D /=.
  by case: (projT2 (X i)) => [[[G H] Z] F'] [].
exists k', D; split=> //.
rewrite parts; apply: eq_bigr => c cC; apply/eqP; rewrite -tofrac_eq; apply/eqP.
have [oc _ _ _] := hP c cC.
have ec i : i \in c -> component e i = c by rewrite (component_unique i cC) => /eqP.
rewrite dynamic_fraction (own_channels_loop c (map_system g (T c)) R).
have prod1 : \prod_(i in c) tof (char_poly (ctK D i)) = tof (char_poly (ctK D (o c))).
  rewrite (big_setD1 (o c))//= big1 ?mulr1// => i; rewrite in_setD1 => /andP[io ic].
  have oi : o (component e i) != i by rewrite ec// eq_sym.
  by have [_ ->] := off_o i oi; rewrite /tof rmorph1.
rewrite -(big_enum_val (fun i => tof (char_poly (ctK D i)))) prod1.
rewrite -/tof; have := at_o (o c); rewrite ec// => -> //; congr (\det (_ - _) * _).
have -> : map_mx g (A c) = own_loop c (map_system g (T c)) (fun i => map_mx g (F i)).
  rewrite /A /own_loop map_mxD (map_mx_sum g); congr (_ + _).
  by apply: eq_bigr => i _; rewrite !map_mxM.
rewrite /own_loop -[RHS]addrA; congr (_ + _).
rewrite [LHS](big_setD1 (o c))//= [X in _ = X + _](big_setD1 (o c))//= mulmxBr mulmxBl.
rewrite [RHS]addrC addrA subrK; congr (_ + _); apply: eq_bigr => i; rewrite in_setD1 => /andP[io ic].
have oi : o (component e i) != i by rewrite ec// eq_sym.
by have [-> _] := off_o i oi.
Qed.
End Assignment.
