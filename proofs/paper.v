(* F. Liu, L. Wang, D. Fullmer, A. S. Morse, Distributed Feedback Control of Multi-Channel Linear Systems: what is
   proved of the paper, in its order.

   R is any real closed field and C = R[i] its complex numbers; the paper's R is the field of all real numbers.
   Every statement is one about R and C, and its proof applies a theorem of another file, most of which
   hold over more fields.  Letters are the paper's, with these exceptions: k i is the dimension n_i of the shared
   sub-state x_i, f is the inclusion of R in C, o is the agent called q.  A symmetric set of complex numbers
   with their multiplicities is the monic real polynomial with these roots.  What the paper assumes throughout is
   assumed of the section; a hypothesis that it does not print where it states a result is named added.

   Where the words are defined: systems, closed and dynamic loops, pencils, extended systems, fixed and fixed_over in
   multichannel.v; controllable, controllability_index and jointly_controllable in joint_controllability.v;
   neighbor_pencil in extended.v; transfer_arc in extended_bound.v; strongly_connected and neighbor_arc in
   neighbor_graph.v; error_system, (14) to (16), in error_system.v; error_loop, (12) and (13), in theorem_1.v;
   observer_loop, (9) to (11), in distributed_observer.v; integrated, (17) and (18), in integrators.v; components and
   minimal in component_gains.v, component_loop in component_assignment.v; freely_assignable in corollary_1.v; almost_all
   in almost_all_gains.v; compensated in brasch_pearson.v; lifted and held, (32) to (38), in delayed_systems.v, and the
   equations that they stand for in meaning.v; trajectory in trajectories.v; derivative and complete_order in
   convergence.v; apart, relay_number and boundary_number in sharing_gap.v; closed in any_graph.v.  THEOREMS.md has every
   theorem beside the paper's statements that it proves, by their numbers in STATEMENTS.md. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import extended neighbor_graph extended_bound sequential_gains feedback.
From mcexact Require Import corfmat_morse error_system free_assignment lifted held delayed_systems.
From mcexact Require Import delays delayed_transfer brasch_pearson theorem_1 distributed_observer.
From mcexact Require Import corollary_1 construction strong_components component_gains.
From mcexact Require Import component_assignment integrators trajectories dynamic_controllers.
From mcexact Require Import example example_hypotheses almost_all_gains two_sided_gains wang_davison.
From mcexact Require Import convergence sharing_gap any_graph bound_reached nested_sets even_spectrum.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Paper.
Variable R : rcfType.
Notation C := (complex R).
Notation f := [rmorphism of real_complex R].

Fact real_numbers (x : C) : x \is Num.real -> exists y, f y = x.
Proof.
case: x => a b r; exists a; have -> : b = 0; last by [].
by case/orP: r; rewrite lecE /= => /andP[/eqP e _]; rewrite // e.
Qed.

Fact infinitely_many : infinite R.
Proof. exact: (@reals_infinite _ [numClosedFieldType of C] f). Qed.

(* I.  The plant (1), or (2) in discrete time: x' = A x + sum B_i u_i, y_i = C_i x; agent i hears the agents of
   N i, itself among them. *)
Variables (n m : nat) (p q : 'I_m -> nat).
Variable S : multichannel R n p q.
Variable N : 'I_m -> {set 'I_m}.
Hypothesis n_positive : (0 < n)%N.
Hypothesis m_positive : (0 < m)%N.
Hypothesis itself : forall i, i \in N i.
Notation A := (mcA S).
Notation B := (mcB S).
Notation nm := (\sum_(i < m) n)%N.
Notation no_fixed_mode T := (forall lambda : C, ~ fixed_over f T lambda).
Notation strongly_connected_neighbors := (strongly_connected (neighbor_arc N)).

(* I-A *)
Hypothesis controllable : jointly_controllable S.
Hypothesis observable : jointly_observable S.

(* II-A.  One agent, which knows the input: the spectra of A + BF and of A + KC. *)
Theorem cancellation b c (B : 'M[R]_(n, b)) (C : 'M[R]_(c, n)) F K :
  char_poly (block_mx A (B *m F) (- (K *m C)) (A + K *m C + B *m F)) =
  char_poly (A + B *m F) * char_poly (A + K *m C).
Proof.
set M := block_mx _ _ _ _; have e : separated M 1%:M = block_mx (A + B *m F) (B *m F) 0 (A + K *m C).
  have z (V : zmodType) (x y w : V) : - x + (y + x + w) - (y + w) = 0.
    by rewrite [y + x]addrC -(addrA x) addKr subrr.
  by rewrite /M separated_blocks !mulmx1 !mul1mx addrK z.
by have [] := @separation _ _ _ M 1%:M; rewrite e ?block_mxKdl // block_mxKul block_mxKdr.
Qed.

(* With the cancellation rule agent i needs sum B_j F_j x_j, which it can find from what it hears iff it hears all
   agents j for which B_j F_j is not zero; where none is, iff it hears all. *)
Theorem cancellation_graph (F : forall j, 'M[R]_(p j, n)) i :
  (forall x x' : 'I_m -> 'cV[R]_n, (forall j, j \in N i -> x j = x' j) ->
     \sum_j B j *m F j *m x j = \sum_j B j *m F j *m x' j) <->
  (forall j, B j *m F j != 0 -> j \in N i).
Proof.
split=> [hears j|needs x x' same]; last first.
  apply: eq_bigr => j _; have [->|/needs/same -> //] := eqVneq (B j *m F j) 0.
  by rewrite !mul0mx.
apply: contraR => nj; apply/eqP/matrixP => a b.
have unit_ l : l \in N i -> (if l == j then delta_mx b 0 else 0 : 'cV[R]_n) = 0.
  by move=> Nl; case: eqP => // e; rewrite -e Nl in nj.
have := hears _ (fun=> 0) unit_; rewrite [RHS]big1 => [|l _]; last by rewrite mulmx0.
rewrite (bigD1 j) //= eqxx big1 => [|l /negPf ->]; last by rewrite mulmx0.
by rewrite addr0 -colE => /matrixP/(_ a 0); rewrite !mxE.
Qed.

Theorem cancellation_complete (F : forall j, 'M[R]_(p j, n)) (added : forall j, B j *m F j != 0) :
  (forall i j, B j *m F j != 0 -> j \in N i) <-> forall i, N i = setT.
Proof.
split=> [needs i|all_ i j _]; last by rewrite all_ inE.
by apply/setP => j; rewrite inE needs.
Qed.

(* II-B.  The errors (5), (6) of the observer (3), (4), open-loop: there are no F_i. *)
Notation no_feedback := (fun i => 0 : 'M[R]_(p i, n)).

Theorem open_loop_dimension : (nm + m.-1 = m * n + m - 1)%N.
Proof. by rewrite sum_nat_const card_ord -subn1 addnBA. Qed.

Theorem open_loop_spectrum o (Lambda : seq C) : strongly_connected_neighbors ->
  size Lambda = (m * n + m.-1)%N -> perm_eq Lambda [seq x^* | x <- Lambda] ->
  exists K H (Kbar : 'M_(m.-1, q o)) (Hbar : 'I_m -> 'M_(m.-1, n)) (Abar : 'M_m.-1) (Cbar : 'M_(n, m.-1)),
    char_poly (map_mx f (error_loop N S no_feedback K H Kbar Hbar Abar Cbar)) = \prod_(x <- Lambda) ('X - x%:P).
Proof. by move=> connected; exact: (theorem_1_symmetric real_numbers connected no_feedback o observable). Qed.

(* (7), (8) *)
Theorem open_loop_gains : strongly_connected_neighbors ->
  exists KH : gains R (fun=> n) (fun i => q i + nm)%N, let E := error_system N S no_feedback in forall o : 'I_m,
    controllability_index (closed_loop E KH) (mcB E o) m /\
    joint_controllability.controllable (closed_loop E KH)^T (mcC E o)^T.
Proof. by move=> connected; exact: (error_system.proposition_1 f infinitely_many connected n_positive _ observable). Qed.

(* almost any K_i, H_ij will do *)
Theorem open_loop_almost_all : strongly_connected_neighbors -> let E := error_system N S no_feedback in
  almost_all (fun KH => forall o : 'I_m, controllability_index (closed_loop E KH) (mcB E o) m /\
                        joint_controllability.controllable (closed_loop E KH)^T (mcC E o)^T).
Proof. by move=> connected; exact: (proposition_1_almost_all f infinitely_many connected n_positive _ observable). Qed.

(* Brasch and Pearson *)
Theorem brasch_pearson k a b c (A : 'M[R]_a) (B : 'M_(a, b)) (C : 'M_(c, a)) (P : {poly R}) :
  joint_controllability.controllable A B -> joint_controllability.controllable A^T C^T ->
  \rank (reach A B k.+1) = a \/ \rank (reach A^T C^T k.+1) = a -> P \is monic -> size P = (a + k).+1 ->
  exists (Ac : 'M_k) (Bc : 'M_(k, c)) (Cc : 'M_(b, k)) (D : 'M_(b, c)),
    char_poly (compensated A B C Ac Bc Cc D) = P.
Proof. exact: (brasch_pearson_minimum f infinitely_many). Qed.

(* II-C.  BF = sum B_i F_i has any spectrum *)
Theorem state_feedback (P : {poly R}) : P \is monic -> size P = n.+1 ->
  exists F : forall i, 'M_(p i, n), char_poly (A + \sum_i B i *m F i) = P.
Proof. exact: (joint_state_feedback f infinitely_many controllable). Qed.

Section Observer.
Variable F : forall i, 'M[R]_(p i, n).
Notation E := (error_system N S F).
Variables (k : 'I_m -> nat) (D : controllers R (fun=> n) (fun i => q i + nm)%N k).

(* In terms of the errors the plant (9) with the observer (10), (11) is x' = (A + sum B_i F_i) x + sum B_i F_i e_i,
   with the errors (12), (13), which obey a system of their own.  observer_loop is the matrix of (9) to (11). *)
Theorem errors : separated (observer_loop N S F D) (copied R n k) =
  block_mx (A + \sum_i B i *m F i) (row_mx (\mxrow_j (B j *m F j)) 0) 0 (dynamic_loop E D).
Proof. exact: paper_separation. Qed.

Theorem spectrum_of_both : char_poly (observer_loop N S F D) =
  char_poly (A + \sum_i B i *m F i) * char_poly (dynamic_loop E D).
Proof. exact: paper_spectrum. Qed.

Section Equations.
Variables (x : 'cV[R]_n) (X : 'cV[R]_nm) (z : 'cV[R]_(\sum_i k i)).
Notation x_ i := (block_of R n i *m X).
Notation v := (observer_loop N S F D *m col_mx x (col_mx X z)).

(* (9) *)
Theorem equation_9 : usubmx v = A *m x + \sum_i B i *m F i *m x_ i.
Proof. exact: observer_plant. Qed.

(* (10) *)
Theorem equation_10 i (K := lsubmx (ctF D i)) (H := fun j => submxrow (rsubmx (ctF D i)) j) :
  block_of R n i *m usubmx (dsubmx v) = A *m x_ i + K *m (mcC S i *m x_ i - mcC S i *m x) +
    \sum_(j in N i) H j *m (x_ i - x_ j) + ctG D i *m submxcol z i + (\sum_j B j *m F j) *m x_ i.
Proof. exact: observer_estimate. Qed.

(* (11) *)
Theorem equation_11 i (Kbar := lsubmx (ctL D i)) (Hbar := fun j => submxrow (rsubmx (ctL D i)) j) :
  submxcol (dsubmx (dsubmx v)) i = ctK D i *m submxcol z i + Kbar *m (mcC S i *m x_ i - mcC S i *m x) +
    \sum_(j in N i) Hbar j *m (x_ i - x_ j).
Proof. exact: observer_channel. Qed.
End Equations.

(* (12) *)
Theorem equation_12 o K H l Kbar Hbar (Abar : 'M_l) Cbar (e : 'cV_nm) z (i : 'I_m) (e_ := fun i => block_of R n i *m e) :
  block_of R n i *m usubmx (error_loop (o := o) N S F K H Kbar Hbar Abar Cbar *m col_mx e z) =
  (A + K i *m mcC S i) *m e_ i + \sum_(j in N i) H i j *m (e_ i - e_ j)
  + \sum_j B j *m F j *m (e_ i - e_ j) + (if i == o then Cbar *m z else 0).
Proof. exact: error_loop_errors. Qed.

(* (13) *)
Theorem equation_13 o K H l Kbar Hbar (Abar : 'M_l) Cbar (e : 'cV_nm) z (e_ := fun i => block_of R n i *m e) :
  dsubmx (error_loop (o := o) N S F K H Kbar Hbar Abar Cbar *m col_mx e z) =
  Abar *m z + Kbar *m (mcC S o *m e_ o) + \sum_(j in N o) Hbar j *m (e_ o - e_ j).
Proof. exact: error_loop_controller. Qed.

Proposition proposition_1 : strongly_connected_neighbors ->
  exists KH : gains R (fun=> n) (fun i => q i + nm)%N, forall o : 'I_m,
    controllability_index (closed_loop E KH) (mcB E o) m /\
    joint_controllability.controllable (closed_loop E KH)^T (mcC E o)^T.
Proof. by move=> connected; exact: (error_system.proposition_1 f infinitely_many connected n_positive F observable). Qed.

Theorem theorem_1 (o : 'I_m) (Lambda : seq C) : strongly_connected_neighbors ->
  size Lambda = (m * n + m.-1)%N -> perm_eq Lambda [seq x^* | x <- Lambda] ->
  exists K H (Kbar : 'M_(m.-1, q o)) (Hbar : 'I_m -> 'M_(m.-1, n)) (Abar : 'M_m.-1) (Cbar : 'M_(n, m.-1)),
    char_poly (map_mx f (error_loop N S F K H Kbar Hbar Abar Cbar)) = \prod_(x <- Lambda) ('X - x%:P).
Proof. by move=> connected; exact: (theorem_1_symmetric real_numbers connected F o observable). Qed.

(* II-D *)
Lemma lemma_1 (added : strongly_connected_neighbors) : jointly_controllable E /\ jointly_observable E.
Proof. by split; [exact: lemma_1_controllable | exact: lemma_1_observable]. Qed.

Theorem inputs_identity : inputs E setT = 1%:M.
Proof. by rewrite /inputs -[RHS](submxrowK 1%:M); apply: eq_mxrow => i; rewrite inE. Qed.

Lemma lemma_2 : strongly_connected_neighbors -> exists H : 'I_m -> 'M[R]_(n, nm), forall o : 'I_m,
  controllability_index (\sum_j error_input R n j *m H j *m differences R n N j) (error_input R n o) m.
Proof. by move=> connected; exact: (error_system.lemma_2 f infinitely_many connected n_positive). Qed.

Theorem scalars : strongly_connected_neighbors -> exists phi, forall o : 'I_m,
  joint_controllability.controllable (closed_loop (graph_system N R) phi) (delta_mx o 0 : 'cV_m).
Proof. by move=> connected; exact: (lemma_2_scalars f infinitely_many connected). Qed.

Lemma lemma_3 a r (A M : 'M[R]_a) (B : 'M[R]_(a, r)) nu : controllability_index A B nu ->
  exists d, forall gs : seq R, uniq gs ->
    all (fun g => \rank (reach (M + g *: A) B nu) != a) gs -> (size gs <= d)%N.
Proof. exact: gain_lines.lemma_3. Qed.

Lemma lemma_3_moreover a r (A M : 'M[R]_a) (B : 'M[R]_(a, r)) nu :
  controllability_index A B nu -> (nu * r)%N = a ->
  exists d, forall gs : seq R, uniq gs ->
    (forall g, g \in gs -> ~ controllability_index (M + g *: A) B nu) -> (size gs <= d)%N.
Proof. exact: lemma_3_index. Qed.

Lemma lemma_4 (K : forall i, 'M[R]_(n, q i)) : strongly_connected_neighbors ->
  exists H : 'I_m -> 'M[R]_(n, nm), forall o : 'I_m,
    controllability_index (closed_loop E (fun j => row_mx (K j) (H j))) (error_input R n o) m.
Proof. by move=> connected; exact: (error_system.lemma_4 f infinitely_many connected n_positive S F K). Qed.

(* the gains of Lemma 4 are the complement of a proper algebraic set *)
Theorem lemma_4_almost_all : strongly_connected_neighbors ->
  almost_all (fun KH => forall o : 'I_m, controllability_index (closed_loop E KH) (mcB E o) m).
Proof. by move=> connected; exact: (almost_all_gains.lemma_4_almost_all f infinitely_many connected n_positive). Qed.

(* every complementary subsystem of (16) is complete *)
Theorem complementary_complete s : strongly_connected_neighbors -> s != set0 -> s != setT ->
  (exists t, outputs E s *m krylov (mcA E) (inputs E (~: s)) t != 0) /\
  (forall lambda : C, (nm <= \rank (pencil (map_system f E) s lambda))%N).
Proof.
move=> connected s0 sT; have [KH h] := proposition_1 connected.
have nm0 : (0 < nm)%N by rewrite sum_nat_const card_ord muln_gt0 m_positive.
have [o|sct nofix] := @corfmat_morse_converse _ _ f _ _ _ _ E KH nm0 m_positive.
  by have [[r _] ob] := h o; split=> //; apply: controllable_blocks r.
split; last first.
  by move=> lambda; rewrite leqNgt; apply/negP => low; apply: (nofix lambda); apply/anderson_clements_over; exists s.
have /strongly_connectedP/(_ s s0 sT)[j [i [/transfer_arcP[t nz] sj si]]] := sct.
exists t; apply: contraNneq nz => /outputs_eq0/(_ i si); rewrite inputs_krylov mul_mxrow => /mxrowP/(_ j).
by rewrite mxrowK submxrow0 inE sj => ->.
Qed.

(* so are those that make it observable through every channel, and those that do both *)
Theorem observable_almost_all : strongly_connected_neighbors ->
  almost_all (fun KH => forall o : 'I_m, joint_controllability.controllable (closed_loop E KH)^T (mcC E o)^T).
Proof. by move=> connected; exact: (observed_almost_all f infinitely_many connected n_positive F observable). Qed.

Theorem both_almost_all : strongly_connected_neighbors ->
  almost_all (fun KH => forall o : 'I_m, controllability_index (closed_loop E KH) (mcB E o) m /\
                        joint_controllability.controllable (closed_loop E KH)^T (mcC E o)^T).
Proof. by move=> connected; exact: (proposition_1_almost_all f infinitely_many connected n_positive F observable). Qed.
End Observer.

(* The construction: the F_i, and then the observer, with a channel controller at one agent o *)
Section Construction.
Variables (o : 'I_m) (k : 'I_m -> nat).
Hypothesis at_o : forall i, i != o -> k i = 0%N.
Hypothesis order : k o = m.-1.

Theorem construction (P P' : {poly R}) : strongly_connected_neighbors ->
  P \is monic -> size P = n.+1 -> P' \is monic -> size P' = (m * n + m.-1).+1 ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers R (fun=> n) (fun i => q i + nm)%N k),
    char_poly (observer_loop N S F D) = P * P'.
Proof. by move=> connected; exact: (construction.construction f infinitely_many connected at_o order controllable observable). Qed.

Theorem construction_rate (x : R) : strongly_connected_neighbors ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers R (fun=> n) (fun i => q i + nm)%N k),
    forall lambda : C, eigenvalue (map_mx f (observer_loop N S F D)) lambda -> lambda = f x.
Proof. by move=> connected; exact: (construction.construction_rate f infinitely_many connected at_o order x controllable observable). Qed.

(* in continuous time, where R is complete: every trajectory goes to 0 as fast as exp(at) *)
Theorem construction_continuous (a : R) : complete_order R -> strongly_connected_neighbors ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers R (fun=> n) (fun i => q i + nm)%N k) c,
    forall (x : R -> 'cV_(n + (nm + \sum_i k i))) (g : R -> R),
      (forall t i, 0 <= t -> derivative (fun s => x s i 0) t ((observer_loop N S F D *m x t) i 0)) ->
      (forall t, 0 <= t -> derivative g t (- a * g t)) ->
      forall t, 0 <= t -> dot (x t) (x t) * g t ^+ 2 <= c * (dot (x 0) (x 0) * g 0 ^+ 2).
Proof.
move=> sup connected; have [F [D low]] := construction_rate (a - 1) connected; exists F, D.
apply: exponential_rate sup _ => lambda /low ->.
rewrite (Creal_ReP _ _) ?ltcE /= ?eqxx /= ?gtr_addl ?oppr_lt0 ?ltr01 //.
by apply/complex_realP; exists (a - 1).
Qed.

(* in discrete time: at rest after as many steps as there are states *)
Theorem construction_discrete : strongly_connected_neighbors ->
  exists (F : forall i, 'M_(p i, n)) (D : controllers R (fun=> n) (fun i => q i + nm)%N k),
    forall x t, (n + (nm + \sum_i k i) <= t)%N -> trajectory (observer_loop N S F D) x t = 0.
Proof. by move=> connected; exact: (construction_at_rest f infinitely_many connected at_o order controllable observable). Qed.
End Construction.

(* III.  The plant with integrators, (17) and (18) *)
Notation I := (integrated S).

(* (19) *)
Theorem equation_19 : jointly_observable I.
Proof.
have eA : map_mx f (mcA I) = integrated_A (map_mx f A) (map_mx f (outputs S setT)).
  by rewrite /= /integrated_A map_block_mx !map_mx0.
have eC : map_mx f (outputs I setT) = integrated_C [fieldType of C] n (\sum_i q i).
  by rewrite outputs_integrated /integrated_C map_row_mx map_mx0 map_mx1.
apply/(controllable_modes f) => lambda; rewrite -!map_trmx eA eC; apply: integrated_observable.
rewrite !map_trmx; exact: ((controllable_modes f _ _).1 observable lambda).
Qed.

(* (20), for the modes other than 0 *)
Theorem equation_20 (lambda : C) : lambda != 0 ->
  ~~ uncontrollable_mode (map_mx f (mcA I)) (map_mx f (inputs I setT)) lambda.
Proof.
have eA : map_mx f (mcA I) = integrated_A (map_mx f A) (map_mx f (outputs S setT)).
  by rewrite /= /integrated_A map_block_mx !map_mx0.
have eB : map_mx f (inputs I setT) = integrated_B (\sum_i q i) (map_mx f (inputs S setT)).
  by rewrite inputs_integrated /integrated_B map_col_mx map_mx0.
move=> l0; rewrite eA eB; apply: integrated_controllable => //.
exact: ((controllable_modes f _ _).1 controllable lambda).
Qed.

(* (21) *)
Definition condition_21 := row_free (block_mx A (inputs S setT) (outputs S setT) (0 : 'M_(\sum_i q i, \sum_i p i))).

Theorem equation_21 : jointly_controllable I <-> condition_21.
Proof.
have zero : ~~ uncontrollable_mode (mcA I) (inputs I setT) 0 = condition_21.
  by rewrite inputs_integrated; exact: integrated_zero.
have map0 : uncontrollable_mode (map_mx f (mcA I)) (map_mx f (inputs I setT)) 0 =
    uncontrollable_mode (mcA I) (inputs I setT) 0.
  by rewrite /uncontrollable_mode -(rmorph0 f) -map_scalar_mx -map_mxB -map_row_mx mxrank_map.
split=> [/(controllable_modes f)/(_ 0)|c21]; first by rewrite map0 zero.
apply/(controllable_modes f) => lambda; have [->|/equation_20 //] := eqVneq lambda 0.
by rewrite map0 zero.
Qed.

(* A zero at 0, where (21) fails, is canceled by the integrators: 0 is an eigenvalue of every loop of channel controllers. *)
Theorem zero_canceled k (D : controllers R p q k) : ~ condition_21 -> eigenvalue (map_mx f (dynamic_loop I D)) 0.
Proof.
move=> no; rewrite map_dynamic_loop; apply: fixed_dynamic_over => F.
have : uncontrollable_mode (mcA I) (inputs I setT) 0.
  by apply: contra_notT no => h; rewrite /condition_21 -integrated_zero; move: h; rewrite inputs_integrated.
case/uncontrollable_modeP => w [nw wA wB].
have wBi i : w *m mcB I i = 0.
  have := congr1 (fun M => submxrow M i) wB; rewrite /inputs mul_mxrow mxrowK inE => ->.
  by apply/matrixP => a b; rewrite !mxE.
rewrite -(rmorph0 f) eigenvalue_map; apply/eigenvalueP; exists w => //.
rewrite /closed_loop mulmxDr wA mulmx_sumr -[RHS]addr0; congr (_ + _).
by apply: big1 => i _; rewrite !mulmxA wBi !mul0mx.
Qed.

(* Whatever the set-points r are, every trajectory of x' = M x - (0, r, 0) goes as fast as exp(at) to one point e, where
   y = r; the first rows of x are the plant's state and the next the integrators'. *)
Definition attains_setpoints l (M : 'M[R]_(n + \sum_i q i + l)) (a : R) :=
  exists c, forall r : 'cV_(\sum_i q i), let b := col_mx (col_mx 0 (- r)) 0 in
    exists2 e, outputs S setT *m usubmx (usubmx e) = r & forall (x : R -> 'cV_(n + \sum_i q i + l)) (g : R -> R),
      (forall t i, 0 <= t -> derivative (fun s => x s i 0) t ((M *m x t + b) i 0)) ->
      (forall t, 0 <= t -> derivative g t (- a * g t)) ->
      forall t, 0 <= t -> dot (x t - e) (x t - e) * g t ^+ 2 <= c * (dot (x 0 - e) (x 0 - e) * g 0 ^+ 2).

(* Any linear time-invariant control beside plant and integrators, with l states: where it stabilizes, all outputs
   settle at their set-points. *)
Theorem setpoints_attained l (M : 'M[R]_(n + \sum_i q i + l)) (a : R) : complete_order R -> a <= 0 ->
  dsubmx (usubmx M) = row_mx (row_mx (outputs S setT) 0) 0 ->
  (forall lambda : C, eigenvalue (map_mx f M) lambda -> 'Re lambda < f a) -> attains_setpoints M a.
Proof.
move=> sup a0 rows low; have [c h] := settles sup a0 low; exists c => r.
have [e rest settle] := h (col_mx (col_mx 0 (- r)) 0); exists e => //.
exact: integrators_at_rest rows rest.
Qed.

(* So where (21) holds, the distributed observer of plant and integrators does. *)
Theorem setpoints_solved o (k : 'I_m -> nat) (a : R) : (forall i, i != o -> k i = 0%N) -> k o = m.-1 ->
  complete_order R -> a <= 0 -> strongly_connected_neighbors -> condition_21 ->
  exists F (D : controllers R (fun=> (n + \sum_i q i)%N) (fun i => q i + \sum_(i < m) (n + \sum_i q i))%N k),
    attains_setpoints (observer_loop N I F D) a.
Proof.
move=> at_o order sup a0 connected /equation_21 jc.
have [F [D low]] := construction.construction_rate f infinitely_many connected at_o order (a - 1) jc equation_19.
exists F, D; apply: setpoints_attained sup a0 _ _ => [|lambda /low ->]; last first.
  rewrite (Creal_ReP _ _) ?ltcE /= ?eqxx /= ?gtr_addl ?oppr_lt0 ?ltr01 //.
  by apply/complex_realP; exists (a - 1).
have lower a' b' c' d' (P : 'M[R]_(a' + b', c')) (Q : 'M_(a' + b', d')) :
    dsubmx (row_mx P Q) = row_mx (dsubmx P) (dsubmx Q).
  by apply/matrixP => i j; rewrite !mxE; case: split => s; rewrite !mxE.
have still : dsubmx (\mxrow_j (mcB I j *m F j)) = 0.
  by apply/matrixP => i j; rewrite !mxE big1 // => l _; rewrite col_mxEd mxE mul0r.
rewrite /observer_loop block_mxEv col_mxKu !lower still linear0 row_mx0.
by rewrite /= /integrated_A block_mxEv col_mxKd.
Qed.

(* where the observers' estimates are no right ones: at rest, with set-points that are not all 0 and an agent without a
   channel controller, some x_j is not the state x of plant and integrators *)
Notation nI := (n + \sum_i q i)%N.
Theorem wrong_estimates F k (D : controllers R (fun=> nI) (fun i => q i + \sum_(i < m) nI)%N k) (x : 'cV[R]_nI)
    (X : 'cV[R]_(\sum_(i < m) nI)) (z : 'cV[R]_(\sum_i k i)) (r : 'cV[R]_(\sum_i q i)) i : k i = 0%N -> r != 0 ->
  observer_loop N I F D *m col_mx x (col_mx X z) + col_mx (col_mx 0 (- r)) 0 = 0 ->
  exists j, block_of R nI j *m X != x.
Proof.
move=> none r0 rest; apply/existsP; apply: contraNT r0 => /existsPn right.
have := @right_at_rest _ _ _ _ _ k N I F D x X z (col_mx 0 (- r)) 0 i none.
rewrite mulmx0 => h; have /(congr1 dsubmx) : 0 = col_mx (0 : 'cV_n) (- r); last first.
  by rewrite col_mxKd linear0 => /eqP; rewrite eq_sym oppr_eq0.
apply: h => [||j]; last by apply/eqP; move: (right j); rewrite negbK.
  by have := congr1 usubmx rest; rewrite linearD linear0 /= col_mxKu.
by have := congr1 (usubmx \o dsubmx) rest; rewrite /= !linearD !linear0 /= col_mxKd linear0.
Qed.

(* The substitution rule with references u_i = F_i x_i + r_i, of which estimator i knows its own: at rest, where those of
   the others act on the plant and agent i has no channel controller, some estimate is wrong. *)
Theorem added_references (F : forall i, 'M[R]_(p i, n)) k (D : controllers R (fun=> n) (fun i => q i + nm)%N k)
    (x : 'cV[R]_n) (X : 'cV[R]_nm) (z : 'cV[R]_(\sum_i k i)) (r : forall j, 'cV_(p j)) i : k i = 0%N ->
  \sum_(j | j != i) B j *m r j != 0 ->
  observer_loop N S F D *m col_mx x (col_mx X z) +
    col_mx (\sum_j B j *m r j) (col_mx (\mxcol_j (B j *m r j)) 0) = 0 ->
  exists j, block_of R n j *m X != x.
Proof.
move=> none r0 rest; apply/existsP; apply: contraNT r0 => /existsPn right.
have := @right_at_rest _ _ _ _ _ k N S F D x X z (\sum_j B j *m r j) (\mxcol_j (B j *m r j)) i none.
have sumE : \sum_j B j *m r j = B i *m r i + \sum_(j | j != i) B j *m r j by rewrite (bigD1 i).
rewrite block_mxcol => h; apply/eqP/(addrI (B i *m r i)); rewrite -sumE addr0; symmetry; apply: h => [||j].
- by have := congr1 usubmx rest; rewrite linearD linear0 /= col_mxKu.
- by have := congr1 (usubmx \o dsubmx) rest; rewrite /= !linearD !linear0 /= col_mxKd col_mxKu.
by apply/eqP; move: (right j); rewrite negbK.
Qed.

(* IV-A.  The fixed spectrum is that under dynamic controllers *)
Theorem fixed_spectrum_dynamic (lambda : C) : fixed_over f S lambda <->
  forall k (D : controllers R p q k), eigenvalue (map_mx f (dynamic_loop S D)) lambda.
Proof.
split=> [fx k D|h F].
  by rewrite map_dynamic_loop; apply: fixed_dynamic_over.
have := h _ (assembled (fun i => existT _ 0%N (F i, 0, 0, 0))).
by rewrite !eigenvalue_root_char -!map_char_poly static_loop.
Qed.

(* Wang and Davison *)
Theorem every_rate : no_fixed_mode S <-> forall a : R, exists k (D : controllers R p q k),
  forall lambda : C, eigenvalue (map_mx f (dynamic_loop S D)) lambda -> 'Re lambda <= f a.
Proof.
split=> [nofix a|rate lambda fx].
  have [k [D h]] := @wang_davison _ _ f _ _ _ _ S infinitely_many pred0 a (fun l fx => False_ind _ (nofix l fx)).
  exists k, D => lambda /h /= /eqP ->; rewrite (Creal_ReP _ _) //.
  by rewrite -(RRe_real (x := f a)) // complex_real.
have [a la] : exists a, ~~ ('Re lambda <= f a).
  have [a ea] := real_numbers (Creal_Re lambda); exists (a - 1); rewrite -ea rmorphB rmorph1.
  by rewrite ler_subr_addl ger_addr ler10.
have [k [D h]] := rate a; case/negP: la; apply: h; exact: (fixed_spectrum_dynamic lambda).1.
Qed.

(* in discrete time, fixed modes at 0 hinder no rate *)
Theorem every_rate_discrete : (forall lambda : C, fixed_over f S lambda -> lambda = 0) <->
  exists k (D : controllers R p q k), forall x t, (n + \sum_i k i <= t)%N -> trajectory (dynamic_loop S D) x t = 0.
Proof.
split=> [zero|[k [D rest]] lambda /fixed_spectrum_dynamic/(_ k D)]; last first.
  by apply: (@at_rest_only_0 _ _ _ _ _ (n + \sum_i k i)%N) => x; apply: rest.
have [k [D h]] := @wang_davison _ _ f _ _ _ _ S infinitely_many (pred1 0) 0 (fun l fx => introT eqP (zero l fx)).
exists k, D; apply: (only_0_at_rest (f := f)) => lambda /h /=.
by rewrite rmorph0 orbb => /eqP.
Qed.

(* Proposition 2 *)
Proposition proposition_2 (lambda : C) : fixed_over f S lambda <->
  exists s, [/\ s != set0, s != setT & (\rank (pencil (map_system f S) s lambda) < n)%N].
Proof. exact: joint_controllability.proposition_2. Qed.

(* the footnote: the empty set and the set of all *)
Theorem footnote (lambda : C) : \rank (pencil (map_system f S) set0 lambda) = n /\
  \rank (pencil (map_system f S) setT lambda) = n.
Proof. by split; [exact: jointly_controllable_pencil | exact: jointly_observable_pencil]. Qed.

Theorem nothing_fixed : no_fixed_mode S <-> forall s (lambda : C), s != set0 -> s != setT ->
  eigenvalue (map_mx f A) lambda -> (n <= \rank (pencil (map_system f S) s lambda))%N.
Proof.
split=> [nofix s lambda s0 sT _|h lambda /proposition_2[s [s0 sT]]].
  by rewrite leqNgt; apply/negP => low; apply: (nofix lambda); apply/proposition_2; exists s.
rewrite ltnNge; case el : (eigenvalue (map_mx f A) lambda); first by rewrite h.
move: el; rewrite eigenvalue_rank => /negbT; rewrite -leqNgt => full.
by rewrite (leq_trans full) // /pencil le_rank_block.
Qed.

(* one channel suffices (Corfmat and Morse) *)
Theorem one_channel : strongly_connected (transfer_arc S) -> no_fixed_mode S ->
  exists F, forall o : 'I_m, joint_controllability.controllable (closed_loop S F) (B o) /\
                             joint_controllability.controllable (closed_loop S F)^T (mcC S o)^T.
Proof. exact: (corfmat_morse infinitely_many). Qed.

Theorem one_channel_assigns : strongly_connected (transfer_arc S) -> no_fixed_mode S -> freely_assignable S.
Proof. exact: (free_assignment infinitely_many). Qed.

(* otherwise the spectrum is partitioned into one set for each strong component *)
Theorem partition : no_fixed_mode S ->
  exists (d : {set 'I_m} -> nat) (T : forall c, multichannel R (d c) p q),
  [/\ (\sum_(c in components S) d c = n)%N, forall c, minimal c S (T c),
  forall k (D : controllers R p q k),
    char_poly (dynamic_loop S D) = \prod_(c in components S) char_poly (component_loop T c D) &
  forall (o : {set 'I_m} -> 'I_m) (k : {set 'I_m} -> nat) (P : {set 'I_m} -> {poly R}),
    (forall c, c \in components S -> [/\ o c \in c, (d c <= (k c).+1)%N, P c \is monic &
      size (P c) = (d c + k c).+1]) ->
    exists (k' : 'I_m -> nat) (D : controllers R p q k'),
      (forall i, k' i = if o (component (transfer_arc S) i) == i then k (component (transfer_arc S) i) else 0%N) /\
      char_poly (dynamic_loop S D) = \prod_(c in components S) P c].
Proof. exact: (component_assignment infinitely_many). Qed.

(* IV-B.  The example. *)
Theorem example_jointly : jointly_controllable (plant [fieldType of R]) /\ jointly_observable (plant [fieldType of R]).
Proof. by split; [exact: example_controllable | exact: example_observable]. Qed.

Theorem example_rank : \rank (pencil (augmented_outputs N3 (plant [fieldType of C])) [set inord 1] 1) = 2%N.
Proof. exact: example_hypotheses.example_rank. Qed.

Theorem example_fixed : fixed (augmented_outputs N3 (plant [fieldType of C])) 1.
Proof. exact: example_mss_fixed. Qed.

(* no distributed controller that shares outputs alone stabilizes it, be time continuous or discrete *)
Theorem example_not_stabilized l (D : controllers R p3 (fun=> \sum_(i < 3) q3 i)%N l) :
  eigenvalue (map_mx f (dynamic_loop (augmented_outputs N3 (plant [fieldType of R])) D)) 1.
Proof. by rewrite -(rmorph1 f) eigenvalue_map; exact: example_dynamic. Qed.

(* nor one to whom agent 3 sends no sub-state *)
Theorem example_needs_agent_3 (k : 'I_3 -> nat) : k (inord 2) = 0%N ->
  fixed (extended N3 k (plant [fieldType of C])) 1.
Proof. exact: example_extended_fixed. Qed.

(* IV-C and IV-D.  Shared sub-states of dimensions k i. *)
Section Extended.
Variable k : 'I_m -> nat.

(* after (25) *)
Theorem extended_jointly : jointly_controllable (extended N k S) /\ jointly_observable (extended N k S).
Proof. by split; [exact: extended_jointly_controllable | exact: extended_jointly_observable]. Qed.

(* (26) and (27) *)
Definition bound_26 := forall i s (lambda : C), s != set0 -> s != setT -> eigenvalue (map_mx f A) lambda ->
  (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N.
Definition bound_27 := forall i s (lambda : C), s != set0 -> s != setT -> eigenvalue (map_mx f A) lambda ->
  (n - \rank (pencil (map_system f S) s lambda) <= k i)%N.

Theorem theorem_2 : strongly_connected_neighbors -> bound_26 -> no_fixed_mode (extended N k S).
Proof. by move=> connected h; exact: extended_bound.theorem_2. Qed.

(* after Theorem 2: without fixed modes the bound is at most 0, since no rank is below n *)
Theorem bound_without_fixed_modes : no_fixed_mode S -> forall s (lambda : C),
  (n <= \rank (neighbor_pencil N (map_system f S) s lambda))%N.
Proof. exact: bound_reached.bound_without_fixed_modes. Qed.

(* "the lower bound is reached": agent a cannot do with less than the bound rho, the others having rho or more, iff some s
   with N_s \ s = {a} has the least rank *)
Theorem bound_reached rho a : strongly_connected_neighbors -> (0 < rho)%N ->
  (forall s (lambda : C), eigenvalue (map_mx f A) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= rho)%N) ->
  (forall k, (forall i, i != a -> (rho <= k i)%N) -> no_fixed_mode (extended N k S) -> (rho <= k a)%N) <->
  (exists s (lambda : C), [/\ eigenvalue (map_mx f A) lambda, neighborhood N s :\: s = [set a] &
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) = rho)%N]).
Proof.
move=> connected rho0 most; have [modes e] := closed_field_poly_normal (char_poly (map_mx f A)).
apply: (bound_reached.bound_reached itself controllable observable connected most a rho0 (modes := modes)) => lambda.
rewrite eigenvalue_root_char e (monicP (char_poly_monic _)) scale1r.
by rewrite root_prod_XsubC.
Qed.

(* "Whether or not this lower bound is tight remains to be seen": if n_i = c for all i is enough, (26) is at most c times
   relay_number N, a number of the graph (sharing_gap.v) *)
Theorem gap_26 c : no_fixed_mode (extended N (fun=> c) S) -> forall s (lambda : C),
  (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= relay_number N * c)%N.
Proof. by move=> free s lambda; exact: (bound_26_at_most itself s (free lambda)). Qed.

(* for every graph and c there is a plant for which c is the least common dimension and (26) is as large as that *)
Theorem gap_26_attained c : (0 < relay_number N)%N -> exists n p q (S : multichannel R n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', no_fixed_mode (extended N (fun=> c') S) <-> (c <= c')%N,
      exists s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda /\
        (n - \rank (neighbor_pencil N (map_system f S) s lambda) = relay_number N * c)%N
    & forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
        (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= relay_number N * c)%N].
Proof. exact: (bound_26_attained f 1 c itself). Qed.

(* so (26) is the least common dimension of every plant for which there is one iff relay_number N <= 1 *)
Theorem tight_26 : (relay_number N <= 1)%N <->
  (forall n p q (S : multichannel R n p q) c, jointly_controllable S -> jointly_observable S ->
    no_fixed_mode (extended N (fun=> c) S) -> forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
    (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= c)%N).
Proof. exact: (bound_26_tight f itself). Qed.

(* any neighbor graph: closed N s says that s hears nobody outside, N_s = s *)
Theorem theorem_2_any_graph :
  (forall s (lambda : C), closed N s -> (n <= \rank (pencil (map_system f S) s lambda))%N) ->
  (forall i s (lambda : C), ~ closed N s -> eigenvalue (map_mx f A) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  no_fixed_mode (extended N k S).
Proof. exact: (any_graph.theorem_2_any_graph itself). Qed.

Theorem some_dimensions_suffice : (exists k, no_fixed_mode (extended N k S)) <->
  (forall s (lambda : C), closed N s -> (n <= \rank (pencil (map_system f S) s lambda))%N).
Proof. exact: (any_graph.some_dimensions_suffice f itself S). Qed.

(* the least total: sets s_j with multipliers y_j, none of whose boundaries N_s \ s hold an agent more than once in sum *)
Theorem least_total (J : finType) (y : J -> nat) (s : J -> {set 'I_m}) (lambda : J -> C) :
  (forall i, \sum_(j | i \in neighborhood N (s j) :\: s j) y j <= 1)%N -> no_fixed_mode (extended N k S) ->
  (\sum_j y j * (n - \rank (neighbor_pencil N (map_system f S) (s j) (lambda j))) <= \sum_i k i)%N.
Proof.
move=> once free; have := total_at_least itself lambda once free.
by rewrite [X in (_ <= X)%N -> _](eq_bigr k) // => i _; rewrite mul1n.
Qed.

(* Remark 2 *)
Remark remark_2_observable : jointly_observable (extended_states N k S).
Proof. exact: extended_states_jointly_observable. Qed.
Remark remark_2 : strongly_connected_neighbors -> bound_27 -> no_fixed_mode (extended_states N k S).
Proof. by move=> connected h; exact: extended_bound.remark_2. Qed.
Remark remark_2_demands_more : bound_27 -> bound_26.
Proof. by move=> h i s lambda s0 sT el; apply: leq_trans (deficiency_le f itself S s lambda) (h i s lambda s0 sT el). Qed.

(* and the same question about (27) *)
Theorem gap_27 c : no_fixed_mode (extended_states N (fun=> c) S) -> forall s (lambda : C),
  (n - \rank (pencil (map_system f S) s lambda) <= boundary_number N * c)%N.
Proof. by move=> free s lambda; exact: (bound_27_at_most itself s (free lambda)). Qed.

Theorem gap_27_attained c : (0 < boundary_number N)%N -> exists n p q (S : multichannel R n p q),
  [/\ [/\ jointly_controllable S, jointly_observable S & forall i, (mcB S i != 0) && (mcC S i != 0)],
      forall c', no_fixed_mode (extended_states N (fun=> c') S) <-> (c <= c')%N,
      exists s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda /\
        (n - \rank (pencil (map_system f S) s lambda) = boundary_number N * c)%N
    & forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
        (n - \rank (pencil (map_system f S) s lambda) <= boundary_number N * c)%N].
Proof. exact: (bound_27_attained f 1 c itself). Qed.

Theorem tight_27 : (boundary_number N <= 1)%N <->
  (forall n p q (S : multichannel R n p q) c, jointly_controllable S -> jointly_observable S ->
    no_fixed_mode (extended_states N (fun=> c) S) -> forall s (lambda : C), eigenvalue (map_mx f (mcA S)) lambda ->
    (n - \rank (pencil (map_system f S) s lambda) <= c)%N).
Proof. exact: (bound_27_tight f itself). Qed.

(* (28) to (30), where the sum of (30) goes over N_s: a neighbor of several members of s counts once *)
Theorem equations_28_to_30 s (lambda : C) : \rank (pencil (extended N k (map_system f S)) s lambda) =
  (\rank (neighbor_pencil N (map_system f S) s lambda) + \sum_i k i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof. exact: rank_extended. Qed.

(* strong connectivity by subsets *)
Theorem connected_by_subsets : strongly_connected_neighbors <->
  (forall s, s != set0 -> s != setT -> neighborhood N s :\: s != set0).
Proof. exact: neighborhood_strongly_connected. Qed.

(* which dimensions suffice, and are necessary, over any graph *)
Theorem suitable_dimensions : no_fixed_mode (extended N k S) <->
  forall s (lambda : C), eigenvalue (map_mx f A) lambda ->
    (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= \sum_(i in neighborhood N s :\: s) k i)%N.
Proof. exact: extended_no_fixed. Qed.

(* IV-E *)
Proposition proposition_3 (positive : forall i, (0 < k i)%N) j i :
  neighbor_arc N j i || transfer_arc S j i -> transfer_arc (extended N k S) j i.
Proof. exact: extended_bound.proposition_3. Qed.

Theorem extended_connected (added : forall i, (0 < k i)%N) :
  strongly_connected_neighbors -> strongly_connected (transfer_arc (extended N k S)).
Proof. exact: proposition_3_strongly_connected. Qed.

(* as printed: the spectrum splits over the strong components of the extended transfer graph, and a symmetric set of so many
   numbers splits with it *)
Corollary corollary_1_printed : strongly_connected_neighbors -> bound_26 ->
  forall P : {poly R}, P \is monic -> size P = (n + \sum_i k i).*2.+1 ->
  exists l (D : controllers R _ _ l), char_poly (dynamic_loop (extended N k S) D) = P.
Proof. by move=> connected h; apply: even_assignment m_positive _; exact: theorem_2. Qed.

(* through one channel, where the extended transfer graph is strongly connected *)
Corollary corollary_1 (added : strongly_connected (transfer_arc (extended N k S))) :
  strongly_connected_neighbors -> bound_26 -> freely_assignable (extended N k S).
Proof. by move=> connected h; apply: (corollary_1.corollary_1 (f := f) infinitely_many). Qed.

Corollary corollary_1_positive (added : forall i, (0 < k i)%N) :
  strongly_connected_neighbors -> bound_26 -> freely_assignable (extended N k S).
Proof. by move=> connected; apply: corollary_1 => //; exact: extended_connected. Qed.

(* whatever the k i, every rate *)
Corollary corollary_1_rate (a : R) : strongly_connected_neighbors -> bound_26 -> exists l (D : controllers R _ _ l),
  forall lambda : C, eigenvalue (map_mx f (dynamic_loop (extended N k S) D)) lambda -> lambda = f a.
Proof.
move=> connected /(theorem_2 connected) nofix.
have [l [D h]] := @wang_davison _ _ f _ _ _ _ (extended N k S) infinitely_many pred0 a
  (fun x fx => False_ind _ (nofix x fx)).
by exists l, D => lambda /h /= /eqP.
Qed.

(* (31) *)
Theorem equation_31 (added : forall i, (0 < k i)%N) : strongly_connected_neighbors -> bound_26 ->
  exists F, forall o : 'I_m,
    joint_controllability.controllable (closed_loop (extended N k S) F) (mcB (extended N k S) o) /\
    joint_controllability.controllable (closed_loop (extended N k S) F)^T (mcC (extended N k S) o)^T.
Proof. by move=> connected h; apply: (corollary_1_gains (f := f) infinitely_many). Qed.

(* the footnote: almost all do *)
Theorem equation_31_almost_all (added : forall i, (0 < k i)%N) : strongly_connected_neighbors -> bound_26 ->
  almost_all (fun F => forall o : 'I_m,
    joint_controllability.controllable (closed_loop (extended N k S) F) (mcB (extended N k S) o) /\
    joint_controllability.controllable (closed_loop (extended N k S) F)^T (mcC (extended N k S) o)^T).
Proof.
move=> connected h; apply: (corfmat_morse_almost_all (f := f) infinitely_many); first exact: extended_connected.
exact: theorem_2.
Qed.

(* V.  Delays: d i j steps from agent j to agent i. *)
Variable d : 'I_m -> 'I_m -> nat.
Hypothesis own_at_once : forall i, d i i = 0%N.

(* V-A, the system (34) *)
Theorem lifted_graph (positive : forall i, (0 < k i)%N) j i :
  neighbor_arc N j i || transfer_arc S j i -> transfer_arc (lifted N k d S) j i.
Proof. exact: lifted_arcs. Qed.

Theorem theorem_3 : strongly_connected_neighbors -> bound_26 ->
  forall lambda : C, lambda != 0 -> ~ fixed_over f (lifted N k d S) lambda.
Proof. by move=> connected h; exact: delays.theorem_3. Qed.

(* (26) is needed at the nonzero eigenvalues of A alone *)
Theorem theorem_3_nonzero : strongly_connected_neighbors ->
  (forall i s (lambda : C), s != set0 -> s != setT -> lambda != 0 -> eigenvalue (map_mx f A) lambda ->
     (n - \rank (neighbor_pencil N (map_system f S) s lambda) <= k i)%N) ->
  forall lambda : C, lambda != 0 -> ~ fixed_over f (lifted N k d S) lambda.
Proof. by move=> connected h; exact: (sharing_gap.theorem_3_nonzero itself controllable observable connected h). Qed.

Theorem lifted_rank s (lambda : C) : lambda != 0 -> \rank (pencil (lifted N k d (map_system f S)) s lambda) =
  (\rank (neighbor_pencil N (map_system f S) s lambda) + \sum_i memory q N k d i
   + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof. by move=> l0; exact: rank_lifted. Qed.

(* all the spectrum but zeros that are fixed, through any channel *)
Theorem lifted_assignment (added : forall i, (0 < k i)%N) (o : 'I_m) : strongly_connected_neighbors -> bound_26 ->
  exists c (psi : {poly R}), [/\ (c + (size psi).-1)%N = (n + \sum_i memory q N k d i)%N, psi \is monic,
    forall lambda : C, root (map_poly f psi) lambda -> lambda = 0 &
    forall l (P : {poly R}), (c <= l.+1)%N -> P \is monic -> size P = (c + l).+1 ->
      exists X : forall i, controller_at R (fun i => p i + k i)%N (fun=> \sum_i q i + (\sum_i q i + \sum_i k i))%N i,
        [/\ projT1 (X o) = l, forall i, i != o -> projT1 (X i) = 0%N &
            char_poly (dynamic_loop (lifted N k d S) (assembled X)) = P * psi]].
Proof.
move=> connected h.
have sc := lifted_strongly_connected S itself added own_at_once connected.
have [|c [psi [e mpsi roots all]]] := @connected_but _ _ f _ _ _ _ (lifted N k d S) infinitely_many (pred1 0) o sc.
  by move=> lambda fx; apply/eqP; apply/eqP; apply: contraT => /(theorem_3 connected h)/(_ fx).
by exists c, psi; split=> // lambda /roots /eqP.
Qed.

(* every rate: at rest after as many steps as there are states *)
Corollary corollary_2 : strongly_connected_neighbors -> bound_26 -> exists l (D : controllers R _ _ l),
  forall x t, (n + \sum_i memory q N k d i + \sum_i l i <= t)%N -> trajectory (dynamic_loop (lifted N k d S) D) x t = 0.
Proof.
move=> connected h; have zero (lambda : C) : fixed_over f (lifted N k d S) lambda -> pred1 0 lambda.
  by move=> fx; rewrite /=; apply: contraT => /(theorem_3 connected h)/(_ fx).
have [l [D e]] := wang_davison infinitely_many 0 zero; exists l, D.
by apply: (only_0_at_rest (f := f)) => lambda /e /=; rewrite rmorph0 orbb => /eqP.
Qed.

(* V-B, the system (37) *)
Theorem held_jointly : jointly_controllable (held N k d S) /\ jointly_observable (held N k d S).
Proof.
have full s lambda : s = set0 \/ s = setT -> \rank (pencil (map_system f (held N k d S)) s lambda) =
    (n + \sum_i chain N k d i)%N.
  rewrite pencil_map_held rank_held // => -[] ->.
    by rewrite (footnote lambda).1 neighborhood0 set0D big_set0 addn0.
  by rewrite (footnote lambda).2 setDT big_set0 addn0.
split; apply/(controllable_modes f) => lambda; rewrite /uncontrollable_mode -leqNgt.
  by rewrite -{1}(full set0 lambda (or_introl erefl)) rank_pencil0 map_inputs.
rewrite -{1}(full setT lambda (or_intror erefl)) rank_pencilT -mxrank_tr tr_col_mx linearB /= tr_scalar_mx.
by rewrite -!map_trmx map_outputs.
Qed.

Theorem theorem_4 : strongly_connected_neighbors -> bound_27 -> no_fixed_mode (held N k d S).
Proof. by move=> connected h; exact: delays.theorem_4. Qed.

Theorem held_rank s (lambda : C) : \rank (pencil (held N k d (map_system f S)) s lambda) =
  (\rank (pencil (map_system f S) s lambda) + \sum_i chain N k d i + \sum_(i in neighborhood N s :\: s) k i)%N.
Proof. exact: rank_held. Qed.

Theorem held_graph (positive : forall i, (0 < k i)%N) : strongly_connected (transfer_arc (held N k d S)) <->
  strongly_connected (fun j i => neighbor_arc N j i || transfer_arc S j i).
Proof. exact: held_strongly_connected. Qed.

Theorem held_assignment (added : forall i, (0 < k i)%N) : strongly_connected_neighbors -> bound_27 ->
  freely_assignable (held N k d S).
Proof. by move=> connected h; apply: (free_assignment_held (f := f) infinitely_many). Qed.
End Extended.
End Paper.
