(* The rules of the checker applied to concrete systems, with every hypothesis discharged, so that no
   theorem is vacuous; every equivalence to one system on each side.  The other files instances_*.v do
   the same for the rules and theorems that they are named for.

   One state, one channel, A = 0, C = 1, and B = 1 (free) or B = 0 (stuck: the mode 0 is fixed).
   The modulus is 6, which is not prime, and the field is that of the algebraic numbers. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import fixed_spectrum completeness deficiency single_channel_gains.
From mcexact Require Import exceptional_gains.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Definition l6 := @Modulus 6 isT.
Notation R := (Zloc l6).
Notation h := ([rmorphism of (ratr : rat -> algC)]).
Notation one := (fun _ : 'I_1 => 1%N).
Notation up := (into (l:=l6) h).
Notation res := (map_poly (@residue l6)).

Definition system (b : R) : multichannel R 1 one one :=
  Multichannel 0 (fun=> b%:M) (fun=> 1%:M).
Notation free := (system 1). Notation stuck := (system 0).
Notation Q S := (map_system (@Zloc_rat l6) S).

Lemma char1 (K : comRingType) (a : K) : char_poly (a%:M : 'M_1) = 'X - a%:P.
Proof. by rewrite /char_poly det_mx11 !mxE !eqxx. Qed.
Lemma char0 (K : comRingType) : char_poly (0 : 'M[K]_1) = 'X.
Proof. by rewrite -(raddf0 (scalar_mx_additive _ 1)) char1 subr0. Qed.
Lemma loop1 (b k : R) : closed_loop (system b) (fun=> k%:M) = (b * k)%:M.
Proof. by rewrite /closed_loop big_ord1 add0r /= mulmx1 -scalar_mxM. Qed.

(* x * 1 - (x - 1) * 1 = 1 modulo 6. *)
Lemma bezout : 1 * res 'X + (- 1) * res ('X - 1) = 1.
Proof. by rewrite rmorphB /= rmorph1 map_polyX mul1r mulN1r opprB addrC subrK. Qed.

Lemma inst_absence_all (lambda : algC) : ~ fixed (map_system h (Q free)) lambda.
Proof.
apply: (@absence_all l6 _ _ _ _ free algCfield h (fun=> 1%:M) 1 (- 1)).
by rewrite loop1 mulr1 char0 char1 bezout.
Qed.

(* A shrunk subspace of deficiency 1 for p = x in the stuck system. *)
Lemma evidence_stuck P : P = 'X -> shrunk_subspace (Q stuck) P setT 1.
Proof.
move=> ->; apply: (@shrunk_by_inputs _ _ _ _ _ _ _ _ _ 1 1%:M 0 id).
- rewrite mulmx0 subr0 mulmx1 => i j; rewrite !mxE rmorph0 subr0 !ord1 eqxx; exact: dvdpp.
- by move=> i; rewrite inE.
- move=> i j; rewrite !mxE subrr; exact: dvdp0.
- suff -> : inputs (Q stuck) setT = 0 by rewrite mxrank0.
  apply/mxrowP=> i; rewrite mxrowK submxrow0 inE /=.
  by apply/matrixP=> a b; rewrite !mxE mul0rn rmorph0.
Qed.
Definition E := evidence_stuck erefl.

Lemma root0 : root (map_poly h 'X) 0. Proof. by rewrite map_polyX rootX. Qed.
Lemma root0' : root (map_poly (into h) ('X : {poly R})) 0. Proof. by rewrite map_polyX rootX. Qed.

Definition inst_shrunk_rank := shrunk_subspace_rank E root0.
Definition inst_shrunk_pencil := shrunk_subspace_pencil E root0.
Definition inst_shrunk_dynamic (k : 'I_1 -> nat) (D : controllers algCfield one one k) :=
  shrunk_subspace_dynamic E root0 D.
Definition inst_shrunk_fixed := shrunk_subspace_fixed E root0 isT.
Definition inst_shrunk_fixed_dynamic (k : 'I_1 -> nat) (D : controllers algCfield one one k) :=
  shrunk_subspace_fixed_dynamic E root0 D isT.
Definition inst_loop_rank := loop_rank_pencil (map_system h (Q free)) setT 0 (fun=> 1%:M).

(* The same at one point of the larger field. *)
Definition inst_shrunk_into_point (F : gains algCfield one one) :=
  shrunk_into_rank (certificate_shrunk E root0) (certificate_free E root0) F (sh_count E).
Definition inst_shrunk_into_pencil_point :=
  shrunk_into_pencil_rank (certificate_shrunk E root0) (certificate_free E root0) (sh_count E).
Definition inst_shrunk_into_dynamic_point (k : 'I_1 -> nat) (D : controllers algCfield one one k) :=
  shrunk_into_dynamic_rank D (certificate_shrunk E root0) (certificate_free E root0) (sh_count E).

(* And with the inputs themselves: (0 I - A) 1 = B_T 0. *)
Lemma shrunk_stuck : shrunk (map_system h (Q stuck)) 0 setT (1%:M : 'M[algC]_1) 0.
Proof. by split=> [|i]; rewrite ?inE// mulmx0 mulmx1 raddf0 sub0r; apply/matrixP=> i j; rewrite !mxE !rmorph0 oppr0. Qed.
Lemma few_stuck : (\rank (inputs (map_system h (Q stuck)) setT) + 1 <= 1)%N.
Proof.
suff -> : inputs (map_system h (Q stuck)) setT = 0 by rewrite mxrank0.
apply/mxrowP=> i; rewrite mxrowK submxrow0 inE /=.
by apply/matrixP=> a b; rewrite !mxE mul0rn !rmorph0.
Qed.
Definition inst_shrunk_point (F : gains algCfield one one) := shrunk_rank shrunk_stuck (mxrank1 _ _) F few_stuck.
Definition inst_shrunk_pencil_point := shrunk_pencil_rank shrunk_stuck (mxrank1 _ _) few_stuck.
Definition inst_shrunk_dynamic_point (k : 'I_1 -> nat) (D : controllers algCfield one one k) :=
  shrunk_dynamic_rank D shrunk_stuck (mxrank1 _ _) few_stuck.

Lemma inst_fixed_spectrum (lambda : algC) :
  fixed (map_system h (Q stuck)) lambda <-> root (map_poly h (\prod_(i < 1) 'X)) lambda.
Proof.
apply: (@fixed_spectrum_rule l6 _ _ _ _ stuck 1 (fun=> 'X) (fun=> 1%N) (fun=> setT) (fun=> 1%N)
  (fun=> E) (fun=> 0) 1 1 0) => //; first exact: monic1.
  by rewrite big_ord1 expr1 rmorph1 mulr1 char0 map_polyX.
by rewrite rmorph1 mulr1 mul0r addr0.
Qed.

Lemma inst_fixed_yes : fixed (map_system h (Q stuck)) 0.
Proof. by apply/inst_fixed_spectrum; rewrite big_ord1 map_polyX rootX. Qed.
Lemma inst_fixed_no : ~ fixed (map_system h (Q stuck)) 1.
Proof. by move/inst_fixed_spectrum; rewrite big_ord1 map_polyX rootX oner_eq0. Qed.
Lemma inst_absence : root (map_poly h 'X) 0.
Proof.
apply: (@absence l6 _ _ _ _ stuck _ h (fun=> 1) 1 'X 1 0 0); [exact: monic1| | |exact: inst_shrunk_fixed].
  by rewrite rmorph1 mulr1 char0 map_polyX.
by rewrite rmorph1 mulr1 mul0r addr0.
Qed.

Lemma completed : char_poly (closed_loop stuck (fun=> 0%:M) + 1%:M *m 1%:M : 'M_1) = 'X - 1.
Proof. by rewrite loop1 mul0r mulmx1 -raddfD /= add0r char1. Qed.

Lemma inst_completion : (1 <= \rank (0%:M - map_mx (into h) (closed_loop stuck (fun=> 0%:M)))%R + 1)%N.
Proof.
apply: (@completion l6 _ _ _ _ stuck algCfield h 1 (fun=> 0%:M) 1%:M 1%:M 'X 1 (- 1) 0).
- exact: monicX.
- by rewrite completed bezout.
- exact: root0'.
Qed.

Lemma inst_rank_exact : \rank (pencil (map_system h (Q stuck)) (~: setT) 0) = 0%N.
Proof.
have E' : shrunk_subspace (Q stuck) (map_poly (@Zloc_rat l6) 'X) setT 1.
  by apply: evidence_stuck; rewrite map_polyX.
have [] := @rank_exact l6 _ _ _ _ stuck algCfield h 1 setT (fun=> 0%:M) 1%:M 1%:M 'X E' 1 (- 1) 0.
- exact: monicX.
- by rewrite completed bezout.
- exact: root0'.
by [].
Qed.

Lemma inst_multiplicity : ~~ (map_poly (into h) ('X : {poly R}) ^+ 2 %| map_poly (into h) ('X : {poly R})).
Proof.
apply: multiplicity_at_most; first exact: monicX.
case=> r; rewrite !map_polyX => /(congr1 (fun p : {poly 'Z_l6} => p`_1)).
by rewrite coefX coefMXn /= => /eqP; rewrite oner_eq0.
Qed.

(* Both coprimality rules, and why a leading coefficient has to be a unit: 1 + 6x and 1 + 6x are
   coprime modulo 6, and share the root -1/6. *)
Definition inst_coprime_modulo : coprimep (map_poly up 'X) (map_poly up ('X - 1)) :=
  coprime_modulo h (monic_unit_lead (monicX _)) bezout.
Lemma inst_no_common_root : ~~ root (map_poly (into h) ('X - 1 : {poly R})) 0.
Proof. by apply: (no_common_root _ bezout root0'); apply: monic_unit_lead; apply: monicX. Qed.

Lemma leading_unit_needed : let a : {poly R} := 6%:R%:P * 'X + 1 in
  [/\ 1 * res a + 0 * res a = 1, ~~ unit_lead a & ~~ coprimep (map_poly (into h) a) (map_poly (into h) a)].
Proof.
move=> a; have z6 : residue (6%:R : R) = 0 by rewrite rmorph_nat; apply/val_inj.
have n6 : into h (6%:R : R) != 0 by rewrite rmorph_nat pnatr_eq0.
have nz : (6%:R%:P : {poly R}) != 0.
  by rewrite polyC_eq0; apply: contraNneq n6 => ->; rewrite rmorph0.
have la : lead_coef a = 6%:R.
  rewrite /a lead_coefDl; first by rewrite lead_coef_Mmonic ?monicX// lead_coefC.
  by rewrite size_poly1 size_mulX// ltnS size_poly_gt0.
split.
- rewrite mul0r addr0 mul1r rmorphD rmorph1 rmorphM /= map_polyC /= z6.
  by rewrite polyC0 mul0r add0r.
- by rewrite /unit_lead la z6 unitr0.
- rewrite coprimepp rmorphD rmorph1 rmorphM /= map_polyC map_polyX.
  by rewrite size_MXaddC oner_eq0 andbF size_polyC n6.
Qed.

Definition inst_euclid_end := @euclid_end [comUnitRingType of 'Z_l6] 'X 1 (unitr1 _).
Lemma inst_euclid_step : comaximal (R := [comUnitRingType of 'Z_l6]) ('X - 1) 1.
Proof.
apply: (@euclid_step _ ('X - 1) 1 ('X - 1) 0); first by rewrite mulr1 addr0.
by exists (1, 0); rewrite /= mul1r mul0r addr0.
Qed.

(* Ranks from below. *)
Lemma inst_rank_from_below : (1 <= \rank (map_mx (into h) (1%:M : 'M[R]_1)))%N.
Proof. by apply: (@rank_from_below l6 _ h 1 1 1 1%:M 1%:M 1%:M); rewrite map_mx1 !mulmx1. Qed.
Lemma inst_rank_from_below_minor : (1 <= \rank (map_mx (into h) (1%:M : 'M[R]_1)))%N.
Proof.
apply: (@rank_from_below_minor l6 _ h 1 1 1 1%:M id id).
by rewrite map_mx1 mxsub_id det1 unitr1.
Qed.

(* Controllability: free is controllable, stuck is not. *)
Lemma reach1 (K : ringType) (b : K) : reach (0 : 'M_1) (b%:M : 'M_1) 1 = \mxrow_(i < 1) b%:M.
Proof. by apply: eq_mxrow => i; rewrite ord1. Qed.
Lemma res_reach1 : map_mx (@residue l6) (reach (0 : 'M[R]_1) 1%:M 1) = \mxrow_(i < 1) 1%:M.
Proof. by rewrite map_reach map_mx0 map_mx1 reach1. Qed.
Lemma mxrow_mxcol1 (K : ringType) : \mxrow_(i < 1) (1%:M : 'M[K]_1) *m \mxcol_(i < 1) 1%:M = 1%:M.
Proof. by rewrite mul_mxrow_mxcol big_ord1 mulmx1. Qed.

Lemma inst_controllable : \rank (reach (map_mx up (0 : 'M_1)) (map_mx up 1%:M) 1) = 1%N.
Proof.
have [] // := @controllability_rule l6 1 1 0 1%:M algCfield h 1 0 (fun=> ord0) 1 1%:M (\mxcol_(i < 1) 1%:M).
- by apply/matrixP=> -[].
- by apply/matrixP=> -[].
- by apply/matrixP=> -[].
- by rewrite res_reach1 mul1mx mxrow_mxcol1.
Qed.

Lemma uncontrolled : [/\ \rank (reach (map_mx up (0 : 'M_1)) (map_mx up (0 : 'M_1)) 1) = 0%N,
  (forall lambda, uncontrollable_mode (map_mx up (0 : 'M_1)) (map_mx up (0 : 'M_1)) lambda =
     root (map_poly up (char_poly (colsub id (1%:M *m (0 : 'M[R]_1))))) lambda) &
  map_poly up (char_poly (colsub id (1%:M *m (0 : 'M[R]_1)))) %| map_poly up (char_poly (0 : 'M_1))].
Proof.
apply: (@controllability_rule l6 1 1 0 0 algCfield h 0 1%:M id 1 0 0) => //.
- by rewrite mxsub_id.
- by rewrite mul1mx mulmx1 mxsub_id.
- by rewrite mulmx0.
- by apply/matrixP=> -[].
Qed.
Lemma inst_uncontrollable_mode : uncontrollable_mode (map_mx up (0 : 'M_1)) (map_mx up (0 : 'M_1)) 0.
Proof. by have [_ -> _] := uncontrolled; rewrite mul1mx mxsub_id char0 root0'. Qed.

Lemma inst_indices : \rank (reach (map_mx up (0 : 'M_1)) (map_mx up 1%:M) 1) = 1%N.
Proof.
apply: (@indices_rule l6 1 1 0 1%:M algCfield h 1 1 0 0 1%:M (\mxcol_(i < 1) 1%:M) 0 0) => //.
- by apply/matrixP=> -[].
- by move=> i _; rewrite mul0mx.
- by rewrite res_reach1 mul1mx mxrow_mxcol1.
Qed.

(* Ranks from above, and ranks that stop: [B], [B, A B], ... for A = 0, B = 1. *)
Lemma inst_rank_from_above : (\rank (0%R : 'M[algC]_1) <= 1 - 1)%N.
Proof. by apply: (@rank_from_above _ 1 1 1 0 1%:M); rewrite ?mulmx0// /row_free mxrank1. Qed.
Lemma reach_full k : (0 < k)%N -> \rank (reach (0 : 'M[algC]_1) 1%:M k) = 1%N.
Proof.
move=> k0; apply/eqP; rewrite -[_ == _]/(row_free _) -kermx_eq0.
have /reach_annihilated/(_ 0%N k0) := mulmx_ker (reach (0 : 'M[algC]_1) 1%:M k).
by rewrite /krylov /= mulmx1 => ->.
Qed.
Lemma inst_indices_stationary : \rank (reach (0 : 'M[algC]_1) 1%:M 5) = \rank (reach (0 : 'M[algC]_1) 1%:M 1).
Proof. by apply: indices_stationary; rewrite ?reach_full. Qed.

(* A = 0, B = 0, W = 1, Z = 0: the uncontrollable space is everything. *)
Lemma row_free1 : row_free (1%:M : 'M[algC]_1). Proof. by rewrite /row_free mxrank1. Qed.
Notation zero1 := (0 : 'M[algC]_1).
Lemma annihilates : 1%:M *m zero1 = 0 *m 1%:M. Proof. by rewrite mulmx0 mul0mx. Qed.
Definition inst_uncontrollable_space := uncontrollable_space 1 row_free1 annihilates (mulmx0 1 1%:M).
Lemma inst_uncontrollable_modes lambda : uncontrollable_mode zero1 zero1 lambda = (lambda == 0).
Proof.
by rewrite (uncontrollable_modes lambda row_free1 annihilates (mulmx0 1 1%:M) (k := 1))// char0 rootX.
Qed.
Definition inst_uncontrollable_divides := uncontrollable_polynomial_divides row_free1 annihilates.

(* Transfer graph: the one arc of free, none in stuck. *)
Lemma res_markov1 : map_mx (@residue l6) (mcC free ord0 *m krylov (mcA free) (mcB free ord0) 0) != 0.
Proof. by rewrite /= mulmx1 map_mx1; apply/eqP=> /matrixP/(_ 0 0)/eqP; rewrite !mxE oner_eq0. Qed.
Lemma inst_arc : arc (map_system up free) ord0 ord0.
Proof. exact: (@arc_rule l6 _ _ _ _ free _ h ord0 ord0 0%N isT res_markov1). Qed.
Lemma inst_transfer_markov : transfer (0 : 'M[rat]_1) 1%:M 1%:M != 0.
Proof.
apply: transfer_markov; exists 0%N; rewrite /krylov /= mulmx1.
by apply/eqP=> /matrixP/(_ 0 0)/eqP; rewrite !mxE oner_eq0.
Qed.
Lemma inst_transfer0_markov : transfer (0 : 'M[rat]_1) 0 1%:M = 0 :> 'M_1.
Proof. by apply: transfer0_markov => k; rewrite (krylov_annihilated _ (Z := 0)) ?mulmx0 ?mul0mx. Qed.
Lemma zero_stuck T T' : zero_transfer (map_system up stuck) T T'.
Proof.
apply: (@ZeroTransfer _ _ _ _ _ _ _ _ 0 0 (fun i : 'I_0 => ord0)).
- by rewrite mulmx0 mul0mx.
- by move=> j _; rewrite mul0mx /=; apply/matrixP=> a b; rewrite !mxE mul0rn rmorph0.
- by move=> i _; rewrite mulmx0.
Qed.
Lemma inst_no_arc : ~~ arc (map_system up stuck) ord0 ord0.
Proof. by apply: (zero_transfer_no_arc (zero_stuck setT setT)); rewrite inE. Qed.
Lemma inst_transfer_graph : arc (map_system up free) =2 (fun _ _ => true).
Proof. by apply: transfer_graph_rule => // j i _; exists 0%N; rewrite // !ord1 res_markov1. Qed.

Lemma inst_transfer_graph_empty : arc (map_system up stuck) =2 (fun _ _ => false).
Proof.
apply: transfer_graph_rule => // j i _; right; exists setT, setT, (zero_stuck setT setT); by rewrite !inE.
Qed.

Lemma inst_complete : complete (Q free).
Proof.
apply: (@completeness_yes 1 1 one one l6 free (fun _ _ => true) (fun=> 1%:M) 1 (- 1)).
- by move=> j i _; exists 0%N; rewrite // !ord1 res_markov1.
- by move=> j i; rewrite !ord1 connect0.
- by rewrite loop1 mulr1 char0 char1 bezout.
Qed.
Lemma inst_not_complete : ~ complete (Q stuck).
Proof. by apply: (completeness_no_mode E) => //; rewrite size_polyX. Qed.

(* Pencil rank and deficiency. *)
Lemma inst_pencil_rank_upper : (\rank (map_mx (value h 0) ('X%:M : 'M_1)) <= 1 - 1)%N.
Proof.
apply: (@pencil_rank_upper _ _ h 'X 0 root0 1 1 1 'X%:M 1%:M id) => i j.
  by rewrite mulmx1 !mxE !ord1 eqxx dvdpp.
by rewrite mxsub_id !mxE subrr dvdp0.
Qed.
Lemma inst_pencil_rank_lower : (1 <= \rank (map_mx (horner_eval 0%R \o map_poly up) (1%:M : 'M_1)))%N.
Proof.
apply: (@pencil_rank_lower l6 _ h 1 1 1 1%:M 'X 1%:M 1%:M 0) => //; first exact: monicX.
  by rewrite map_mx1 !mulmx1 scaler0 addr0.
exact: root0'.
Qed.
Lemma inst_deficiency : (\rank (pencil (map_system h (Q stuck)) (~: setT) 0%R) + 1 = 1)%N.
Proof.
apply: (@deficiency_rule l6 _ h 1 1 one one stuck 1 (fun=> 0%:M) 1%:M 1%:M 1 (- 1) 'X setT E 0).
  by rewrite completed char0 bezout.
exact: root0.
Qed.

Lemma inst_deficiency_bound (s : {set 'I_1}) (lambda : algC) :
  (1 <= \rank (pencil (map_system h (Q stuck)) s lambda) + 1)%N.
Proof.
apply: (@deficiency_bound l6 _ h 1 1 one one stuck 1 (fun=> 0%:M) 1%:M 1%:M 1 (- 1)).
by rewrite completed char0 bezout.
Qed.

(* Two dead channels: a cut between them. *)
Notation two := (fun _ : 'I_2 => 1%N).
Definition dead : multichannel rat 1 two two := Multichannel 0 (fun=> 0) (fun=> 0).
Lemma zero_dead T T' : zero_transfer dead T T'.
Proof.
apply: (@ZeroTransfer _ _ _ _ _ _ _ _ 0 0 (fun i : 'I_0 => ord0)) => [|j _|i _]; by rewrite ?mulmx0 ?mul0mx.
Qed.
Lemma proper0 : [set ord0 : 'I_2] != set0. Proof. by apply/set0Pn; exists ord0; rewrite inE. Qed.
Lemma properT : [set ord0 : 'I_2] != setT.
Proof. by apply/eqP => /setP/(_ (lift ord0 ord0)); rewrite !inE. Qed.
Definition inst_cut := zero_transfer_cut (zero_dead _ _) proper0 properT.
Definition inst_no_cut := completeness_no_cut (zero_dead _ _) proper0 properT.
Lemma inst_strongly_connected : strongly_connected (map_system up free).
Proof.
apply: (@strongly_connected_arcs _ _ _ _ _ _ (fun _ _ => true)) => j i; rewrite !ord1.
  by move=> _; apply: inst_arc.
exact: connect0.
Qed.

(* Single channels. *)
Lemma inst_single_yes : \rank (reach (map_mx up (closed_loop free (fun=> 1%:M))) (map_mx up (mcB free ord0)) 1) = 1%N.
Proof.
have res1 : map_mx (@residue l6) (reach (closed_loop free (fun=> 1%:M)) (mcB free ord0) 1) = \mxrow_(i < 1) 1%:M.
  by rewrite map_reach /= map_mx1; apply: eq_mxrow => i; rewrite ord1.
have [] // := @single_channel_yes l6 1 1 one one free _ h (fun=> 1%:M) ord0 1 1%:M (\mxcol_(i < 1) 1%:M) 1%:M.
- by rewrite res1 mul1mx mxrow_mxcol1.
- by apply/eqP=> /matrixP/(_ 0 0)/(congr1 (@residue l6))/eqP; rewrite !mxE rmorph1 rmorph0 oner_eq0.
Qed.
Lemma inst_single_no_mode : uncontrollable_mode (closed_loop (map_system h (Q stuck)) (fun=> 0)) (mcB (map_system h (Q stuck)) ord0) 0.
Proof. by apply: (single_channel_no_mode E (f := h) _ isT root0); rewrite inE. Qed.

(* The input of the first channel moves one state, the second channel sees the other: a cut. *)
Definition apart : multichannel rat 2 two two :=
  Multichannel 0 (fun j => (j == ord0)%:R *: delta_mx ord0 0) (fun i => (i != ord0)%:R *: delta_mx 0 ord_max).
Lemma zero_apart : zero_transfer apart [set ord0] (~: [set ord0]).
Proof.
apply: (@ZeroTransfer _ _ _ _ _ _ _ _ 1 (delta_mx ord0 0) (fun=> ord0)) => [|j|i]; rewrite ?mul0mx.
- by apply/matrixP=> a b; rewrite !mxE big1// => c _; rewrite !mxE mulr0.
- rewrite inE => /eqP -> /=; rewrite scale1r; apply/matrixP=> a b.
  by rewrite !mxE big_ord1 !mxE !ord1 !eqxx mulr1.
- by rewrite !inE => i0 /=; rewrite i0 scale1r mul_delta_mx_0.
Qed.
Lemma inst_single_no_cut (F : gains rat two two) :
  (\rank (reach (closed_loop apart F) (mcB apart ord0) 2) < 2)%N.
Proof.
apply: (single_channel_no_cut zero_apart (i := lift ord0 ord0)); rewrite ?inE//= scale1r.
by apply/eqP => /matrixP/(_ 0 ord_max)/eqP; rewrite !mxE oner_eq0.
Qed.

(* Exceptional gains: K(g) = g loses rank exactly at 0. *)
Lemma inst_exceptional_lost : (\rank (map_mx (value h 0) (map_mx (map_poly (@Zloc_rat l6)) ('X%:M : 'M_1))) < 1)%N.
Proof.
apply: (@exceptional_lost l6 _ h 1 1 'X%:M 'X 1%:M ord0 0 _ _ root0); last by rewrite mxE.
by move=> i j; rewrite mul1mx !mxE !ord1 eqxx map_polyX dvdpp.
Qed.
Lemma inst_exceptional_kept : \rank (map_mx (value h 1) (map_mx (map_poly (@Zloc_rat l6)) ('X%:M : 'M_1))) = 1%N.
Proof.
apply: (@exceptional_kept l6 _ h 1 1 'X%:M 1%:M 1%:M 'X 1 1 1 0 1).
- by rewrite map_mx1 mulmx1 det_scalar1 expr1 rmorph1 mulr1 map_polyX.
- by rewrite /unit_lead lead_coef1 rmorph1 unitr1.
- by rewrite rmorph1 mulr1 mul0r addr0.
- by rewrite map_polyX rootX oner_eq0.
Qed.
