(* checker/loops.py: kind `distributed_observer`, and the loop of the paper's observer.
   The estimation errors evolve by themselves, and the spectrum is that of both diagonal blocks. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel location moved_roots error_system.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Separation.
Variables (R : comRingType) (n k : nat).
Implicit Types (M : 'M[R]_(n + k)) (J : 'M[R]_(k, n)).

Lemma char_poly_similar a (P Q M : 'M[R]_a) : Q *m P = 1%:M -> char_poly (P *m M *m Q) = char_poly M.
Proof.
move=> QP; have PQ : P *m Q = 1%:M by apply: mulmx1C.
have e : char_poly_mx (P *m M *m Q) = map_mx polyC P *m char_poly_mx M *m map_mx polyC Q.
  rewrite /char_poly_mx !map_mxM mulmxBr mulmxBl; congr (_ - _).
  by rewrite -mulmxA -scalar_mxC mulmxA -map_mxM PQ map_mx1 mul1mx.
by rewrite /char_poly e !det_mulmx mulrAC -det_mulmx -map_mxM PQ map_mx1 det1 mul1r.
Qed.

Lemma char_poly_blocks (X : 'M[R]_n) (Y : 'M[R]_(n, k)) (Z : 'M[R]_k) :
  char_poly (block_mx X Y 0 Z) = char_poly X * char_poly Z.
Proof.
rewrite /char_poly /char_poly_mx map_block_mx map_mx0 scalar_mx_block opp_block_mx add_block_mx.
by rewrite subr0 det_ublock.
Qed.

(* J takes x to the rows of the estimates: (x, x_1, z_1, ...) = change J (x, e_1, z_1, ...). *)
Definition change J : 'M[R]_(n + k) := block_mx 1%:M 0 J 1%:M.
Definition separated M J := change (- J) *m M *m change J.

Lemma changeN J : change (- J) *m change J = 1%:M.
Proof.
by rewrite /change mulmx_block !mul1mx !mul0mx !mulmx1 !mulmx0 !addr0 add0r addNr -scalar_mx_block.
Qed.

(* The rule: the rows of the errors vanish in the columns of x. *)
Theorem separation M J : dlsubmx (separated M J) = 0 ->
  M *m change J = change J *m block_mx (ulsubmx (separated M J)) (ursubmx (separated M J)) 0 (drsubmx (separated M J))
  /\ char_poly M = char_poly (ulsubmx (separated M J)) * char_poly (drsubmx (separated M J)).
Proof.
move=> z; have e := submxK (separated M J); rewrite z in e; split.
  by rewrite e /separated !mulmxA (mulmx1C (changeN J)) mul1mx.
rewrite -(char_poly_blocks _ (ursubmx (separated M J))) e /separated char_poly_similar//.
exact: mulmx1C (changeN J).
Qed.
End Separation.

(* The state of the loop that the checker builds is (x, x_1, z_1, ..., x_m, z_m). *)
Definition estimates (R : ringType) n m (k : 'I_m -> nat) : 'M[R]_(\sum_i (n + k i), n) :=
  \mxcol_i col_mx 1%:M 0.

Section Bound.
Variables (C : numClosedFieldType) (n m : nat) (k : 'I_m -> nat).
Notation up := (map_mx (ratr : rat -> C)).
Variables (M : 'M[rat]_(n + \sum_i (n + k i))) (p q : {poly rat}) (b : rat).
Let M' := separated M (estimates _ n k).
Hypotheses (alone : dlsubmx M' = 0) (feedback : char_poly (ulsubmx M') = p) (error : char_poly (drsubmx M') = q).

Theorem observer_spectrum : char_poly M = p * q.
Proof. by have [_ ->] := separation alone; rewrite feedback error. Qed.

Let either lambda : eigenvalue (up M) lambda ->
  root (map_poly (ratr : rat -> C) p) lambda \/ root (map_poly (ratr : rat -> C) q) lambda.
Proof.
rewrite eigenvalue_root_char -(map_char_poly [rmorphism of ratr]) observer_spectrum rmorphM rootM.
by case/orP; [left|right].
Qed.

Theorem observer_rate : is_hurwitz (size p).-1 (shifted p b) -> is_hurwitz (size q).-1 (shifted q b) ->
  forall lambda : C, eigenvalue (up M) lambda -> 'Re lambda < - ratr b.
Proof.
move=> hp hq lambda /either[]; move: lambda; apply/region_continuous => //.
  by rewrite -feedback char_poly_monic.
by rewrite -error char_poly_monic.
Qed.

Theorem observer_radius : 0 < b -> schur_by_moebius (scaled p b) -> schur_by_moebius (scaled q b) ->
  forall lambda : C, eigenvalue (up M) lambda -> `|lambda| < ratr b.
Proof.
move=> b0 hp hq lambda /either[]; move: lambda; apply/region_discrete => //.
  by rewrite -feedback monic_neq0 ?char_poly_monic.
by rewrite -error monic_neq0 ?char_poly_monic.
Qed.
End Bound.

(* The paper's observer (me1), (me2) in the loop (2ssxmcs), for channel controllers of every agent; the
   paper's own has k_i = 0 except at q.  The state is (x, X, z), X = (x_1, ..., x_m), z = (z_1, ..., z_m);
   ctF D i = [K_i, H_i1, ..., H_im], ctG D i = C-bar, ctL D i = [K-bar, H-bar_1, ..., H-bar_m], ctK D i = A-bar. *)
Section Paper.
Variables (K : fieldType) (n m : nat) (p q k : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).
Notation nm := (\sum_(i < m) n)%N.
Notation E := (error_system N S F).
Variable D : controllers K (fun=> n) (fun i => q i + nm)%N k.

(* A + sum B_i F_i *)
Definition feedback_loop : 'M[K]_n := mcA S + \sum_i mcB S i *m F i.
(* How x_i, through -K_i y_i, and z_i, through -K-bar y_i, depend on x. *)
Definition measured i : 'M[K]_(q i + nm, n) := col_mx (mcC S i) 0.

Definition observer_loop : 'M[K]_(n + (nm + \sum_i k i)) :=
  block_mx (mcA S) (row_mx (\mxrow_j (mcB S j *m F j)) 0)
    (col_mx (- (\mxcol_i (ctF D i *m measured i))) (- (\mxcol_i (ctL D i *m measured i))))
    (block_mx ((\mxdiag_(i < m) feedback_loop) + \sum_i error_input K n i *m ctF D i *m mcC E i)
              (\mxrow_i (error_input K n i *m ctG D i))
              (\mxcol_i (ctL D i *m mcC E i)) (\mxdiag_i ctK D i)).

(* x -> (x, ..., x; 0) *)
Definition copies : 'M[K]_(nm, n) := \mxcol_i 1%:M.
Definition copied : 'M[K]_(nm + \sum_i k i, n) := col_mx copies 0.

Lemma block_copies i : block_of K n i *m copies = 1%:M.
Proof. by rewrite block_ofE mxcolK. Qed.

Lemma measured_copies i : mcC E i *m copies = measured i.
Proof.
rewrite /= mul_col_mx -mulmxA block_copies mulmx1; congr col_mx.
by apply/differences_eq0 => j _; rewrite !block_copies.
Qed.

Lemma block_mxcol r (Y : forall i : 'I_m, 'M[K]_(n, r)) i : block_of K n i *m \mxcol_j Y j = Y i.
Proof. by rewrite block_ofE mxcolK. Qed.

Lemma block_mxdiag r i (X : 'M[K]_(nm, r)) :
  block_of K n i *m ((\mxdiag_(j < m) feedback_loop) *m X) = feedback_loop *m (block_of K n i *m X).
Proof. by rewrite -{1}(submxcolK X) mul_mxdiag_mxcol block_mxcol block_ofE. Qed.

Lemma block_inputs r i (Y : forall i : 'I_m, 'M[K]_(n, r)) :
  block_of K n i *m (\sum_j error_input K n j *m Y j) = Y i.
Proof.
rewrite mulmx_sumr (bigD1 i)//= mulmxA block_of_error_input eqxx mul1mx big1 ?addr0// => j.
by rewrite mulmxA block_of_error_input eq_sym => /negPf->; rewrite raddf0 mul0mx.
Qed.

Lemma mxrow_blocks r (Y : forall j : 'I_m, 'M[K]_(r, n)) (X : 'M[K]_nm) :
  (\mxrow_j Y j) *m X = \sum_j Y j *m (block_of K n j *m X).
Proof. by rewrite -{1}(submxcolK X) mul_mxrow_mxcol; apply: eq_bigr => j _; rewrite block_ofE. Qed.

Lemma error_A_blocks : error_A S F = (\mxdiag_(i < m) feedback_loop) - copies *m \mxrow_j (mcB S j *m F j).
Proof.
apply: blocks_eq => i; rewrite -[error_A S F]mulmx1 block_error_A mulmxBr.
rewrite [_ *m (copies *m _)]mulmxA block_copies mul1mx.
by rewrite -[\mxdiag__ _]mulmx1 block_mxdiag -[\mxrow__ _]mulmx1 mxrow_blocks.
Qed.

Lemma separated_blocks (R : comRingType) a b (X : 'M[R]_a) (Y : 'M[R]_(a, b)) Z W (J : 'M[R]_(b, a)) :
  separated (block_mx X Y Z W) J = block_mx (X + Y *m J) Y (Z + W *m J - J *m (X + Y *m J)) (W - J *m Y).
Proof.
rewrite /separated /change !mulmx_block !mul1mx !mul0mx !mulmx1 !mulmx0 !addr0 !add0r !mulNmx.
congr block_mx; last by rewrite addrC.
by rewrite mulmxDl mulNmx mulmxDr opprD mulmxA addrACA [RHS]addrC addrCA addrA.
Qed.

(* Separation: in the coordinates (x, E, z) the plant does not drive the errors, whose loop is the
   closed loop (eme1), (eme2) of the error system with the channel controllers. *)
Theorem paper_separation : separated observer_loop copied =
  block_mx feedback_loop (row_mx (\mxrow_j (mcB S j *m F j)) 0) 0 (dynamic_loop E D).
Proof.
have top : mcA S + row_mx (\mxrow_j (mcB S j *m F j)) 0 *m copied = feedback_loop.
  rewrite /copied mul_row_col mul0mx addr0 /copies mul_mxrow_mxcol; congr (_ + _).
  by apply: eq_bigr => i _; rewrite mulmx1.
rewrite /observer_loop separated_blocks top; congr block_mx.
  rewrite /copied mul_block_col mulmx0 !addr0 mul_col_mx mul0mx add_col_mx opp_col_mx add_col_mx oppr0 addr0.
  rewrite -[RHS]col_mx0; congr col_mx.
    apply: blocks_eq => i; rewrite mulmx0 mulmxBr mulmxDr mulmxN block_mxcol mulmxDl mulmxDr.
    rewrite block_mxdiag block_copies mulmx1 [_ *m (copies *m _)]mulmxA block_copies mul1mx.
    rewrite [feedback_loop + _]addrC addrA addrK mulmx_suml.
    rewrite (eq_bigr (fun j => error_input K n j *m (ctF D j *m measured j))) => [|j _].
      by rewrite block_inputs addNr.
    by rewrite -!mulmxA measured_copies.
  rewrite mulmx0 addr0 mxcol_mul -mxcolN -mxcolD -[RHS]mxcol0; apply: eq_mxcol => i.
  by rewrite -mulmxA measured_copies addNr.
rewrite /copied mul_col_row !mul0mx mulmx0 opp_block_mx add_block_mx !oppr0 !addr0.
by rewrite /dynamic_loop /closed_loop /= error_A_blocks addrAC.
Qed.

(* The spectrum of the whole loop: that of A + sum B_i F_i and that of the closed error system. *)
Theorem paper_spectrum : char_poly observer_loop = char_poly feedback_loop * char_poly (dynamic_loop E D).
Proof.
have [] := @separation _ _ _ observer_loop copied; first by rewrite paper_separation block_mxKdl.
by rewrite paper_separation block_mxKul block_mxKdr.
Qed.

(* That observer_loop is the loop of (2ssxmcs), (me1) and (me2). *)
Section Equations.
Variables (x : 'cV[K]_n) (X : 'cV[K]_nm) (z : 'cV[K]_(\sum_i k i)).
Notation x_ i := (block_of K n i *m X).
Let v := observer_loop *m col_mx x (col_mx X z).

Lemma innovation r i (G : 'M[K]_(r, q i + nm)) : G *m mcC E i *m X - G *m measured i *m x =
  lsubmx G *m (mcC S i *m x_ i - mcC S i *m x) +
  \sum_(j in N i) submxrow (rsubmx G) j *m (x_ i - x_ j).
Proof.
rewrite -{1 2}(hsubmxK G) !mul_row_col mulmx0 addr0 mulmxDl -!mulmxA addrAC mulmxBr; congr (_ + _).
rewrite /differences mxcol_mul -{1}(submxrowK (rsubmx G)) mul_mxrow_mxcol [RHS]big_mkcond.
by apply: eq_bigr => j _; case: ifP; rewrite ?mul0mx ?mulmx0// mulmxBl.
Qed.

Let vE : dsubmx v = col_mx (- (\mxcol_i (ctF D i *m measured i))) (- (\mxcol_i (ctL D i *m measured i))) *m x +
  col_mx (((\mxdiag_(i < m) feedback_loop) + \sum_i error_input K n i *m ctF D i *m mcC E i) *m X
    + \mxrow_i (error_input K n i *m ctG D i) *m z) (\mxcol_i (ctL D i *m mcC E i) *m X + \mxdiag_i ctK D i *m z).
Proof. by rewrite /v /observer_loop !mul_block_col col_mxKd. Qed.

(* (2ssxmcs) *)
Lemma observer_plant : usubmx v = mcA S *m x + \sum_i mcB S i *m F i *m x_ i.
Proof.
rewrite /v /observer_loop mul_block_col col_mxKu mul_row_col mul0mx addr0; congr (_ + _).
by rewrite -{1}(submxcolK X) mul_mxrow_mxcol; apply: eq_bigr => i _; rewrite block_ofE.
Qed.

(* (me1) *)
Lemma observer_estimate i (K_i := lsubmx (ctF D i)) (H_i := fun j => submxrow (rsubmx (ctF D i)) j) :
  block_of K n i *m usubmx (dsubmx v) = mcA S *m x_ i + K_i *m (mcC S i *m x_ i - mcC S i *m x) +
    \sum_(j in N i) H_i j *m (x_ i - x_ j) + ctG D i *m submxcol z i + (\sum_j mcB S j *m F j) *m x_ i.
Proof.
have order (V : zmodType) (a b g t u : V) : - a + (t + u + b + g) = t + (b - a) + g + u.
  rewrite addrC [t + (b - a)]addrA [LHS]addrAC [RHS]addrAC; congr (_ + g).
  by rewrite [RHS]addrAC; congr (_ - a); rewrite addrAC.
rewrite -(addrA (mcA S *m _)) -innovation vE mul_col_mx add_col_mx col_mxKu mulNmx mulmxDr mulmxN.
rewrite [block_of K n i *m (_ *m x)]mulmxA block_mxcol.
have e1 : block_of K n i *m ((\sum_j error_input K n j *m ctF D j *m mcC E j) *m X) = ctF D i *m mcC E i *m X.
  rewrite mulmx_suml (eq_bigr (fun j => error_input K n j *m (ctF D j *m mcC E j *m X))) => [|j _].
    by rewrite block_inputs.
  by rewrite !mulmxA.
have e2 : block_of K n i *m (\mxrow_i (error_input K n i *m ctG D i) *m z) = ctG D i *m submxcol z i.
  rewrite -{1}(submxcolK z) mul_mxrow_mxcol.
  rewrite (eq_bigr (fun j => error_input K n j *m (ctG D j *m submxcol z j))) => [|j _].
    by rewrite block_inputs.
  by rewrite !mulmxA.
by rewrite mulmxDr mulmxDl mulmxDr block_mxdiag e1 e2 mulmxDl order.
Qed.

(* (me2), with A-bar = ctK D i *)
Lemma observer_channel i (K_i := lsubmx (ctL D i)) (H_i := fun j => submxrow (rsubmx (ctL D i)) j) :
  submxcol (dsubmx (dsubmx v)) i = ctK D i *m submxcol z i + K_i *m (mcC S i *m x_ i - mcC S i *m x) +
    \sum_(j in N i) H_i j *m (x_ i - x_ j).
Proof.
rewrite vE mul_col_mx add_col_mx col_mxKd mulNmx !mxcol_mul -{1}(submxcolK z) mul_mxdiag_mxcol.
rewrite -mxcolN -!mxcolD mxcolK -addrA -innovation addrC addrAC [RHS]addrC -addrA; congr (_ + _).
Qed.

(* At rest under constant signals, b to the plant and c to the estimators: where all estimates are right, an estimator
   without a channel controller receives the signal that the plant receives. *)
Theorem right_at_rest (b : 'cV[K]_n) (c : 'cV[K]_nm) i : k i = 0%N -> usubmx v + b = 0 -> usubmx (dsubmx v) + c = 0 ->
  (forall j, x_ j = x) -> block_of K n i *m c = b.
Proof.
move=> none plant estimates right.
have z0 : submxcol z i = 0 by apply/matrixP => a; have := ltn_ord a; rewrite {2}none.
have := congr1 (mulmx (block_of K n i)) estimates; rewrite mulmxDr mulmx0 observer_estimate z0 mulmx0 addr0 right.
rewrite subrr mulmx0 addr0 big1 => [|j _]; last by rewrite !right subrr mulmx0.
rewrite addr0 => e; move: plant; rewrite observer_plant (eq_bigr (fun j => mcB S j *m F j *m x)) => [|j _].
  by rewrite -mulmx_suml => e'; apply: (addrI (mcA S *m x + (\sum_j mcB S j *m F j) *m x)); rewrite e e'.
by rewrite right.
Qed.
End Equations.
End Paper.
