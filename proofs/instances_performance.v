(* Two states, two inputs and two outputs: x' = -x + u and x(t+1) = x/2 + u, their costs under dynamic controllers, bounds for
   every controller, disk margins and sectors. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From Coq Require Import Ring.
From mcexact Require Import location stability instability positive_forms performance cost_bound cost_groups.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Abstract.
Variables (T : Type) (o i : T) (add mul sub : T -> T -> T) (opp : T -> T).
Hypothesis rt : ring_theory o i add mul sub opp eq.
Add Ring abstract_ring : rt.
Local Notation "x + y" := (add x y). Local Notation "x * y" := (mul x y). Local Notation "- x" := (opp x).
Lemma abs_three (a d f g h z v w : T) : (a + - g) * z + (d + - (g + h)) * v + (f + - h) * w =
  a * z + d * v + - (g * (z + v)) + f * w + - (h * (v + w)).
Proof. ring. Qed.
End Abstract.

Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").
(* A rational multiple of the identity. *)
Definition multiple d (a : rat) : 'M[algC]_d := (ratr a)%:M.

Lemma times_mul d a b : multiple d a *m multiple d b = multiple d (a * b).
Proof. by rewrite /multiple -scalar_mxM -rmorphM. Qed.
Lemma times_add d a b : multiple d a + multiple d b = multiple d (a + b).
Proof. by rewrite /multiple -raddfD -rmorphD. Qed.
Lemma times_opp d a : - multiple d a = multiple d (- a).
Proof. by rewrite /multiple -raddfN -rmorphN. Qed.
Lemma times_adj d a : (multiple d a)^H = multiple d a.
Proof. by rewrite /multiple /adjoint tr_scalar_mx map_scalar_mx fmorph_rat. Qed.
Lemma times_scale d (c a : rat) : ratr c *: multiple d a = multiple d (c * a).
Proof. by rewrite /multiple scale_scalar_mx -rmorphM. Qed.
Lemma times1 d : 1%:M = multiple d 1. Proof. by congr (_%:M); rewrite rmorph1. Qed.
Lemma times0 d : 0 = multiple d 0. Proof. by rewrite /multiple [ratr 0]rmorph0 raddf0. Qed.
Lemma times_form d a x : form (multiple d a) x = ratr a * form 1%:M x.
Proof. by rewrite -formZ scalemx1. Qed.

(* All these matrices are multiples of the identity again. *)
Definition timesE := (@times1 2, @times0 2, @times_mul 2, @times_add 2, @times_opp 2, @times_adj 2, @times_scale 2).
Notation times := (multiple 2).

Lemma psd_times d a : 0 <= a -> psd (multiple d a).
Proof. by move=> a0 x; rewrite times_form mulr_ge0 ?form1_ge0 ?ler0q. Qed.
Lemma posdef_times d a : 0 < a -> posdef (multiple d a).
Proof. by move=> a0 x nx; rewrite times_form mulr_gt0 ?form1_gt0 ?ltr0q. Qed.

Definition both d (z w : 'cV[algC]_d) := (z^H *m w) 0 0 + ((z^H *m w) 0 0)^*.
Lemma both_bound d (z w : 'cV[algC]_d) (b : rat) : - (ratr `|b| * (form 1%:M z + form 1%:M w)) <= ratr b * both z w.
Proof.
have one : (1%:M : 'M[algC]_d)^H = 1%:M by rewrite adj1.
have up : 0 <= form 1%:M z + form 1%:M w + both z w.
  by have := form1_ge0 (z + w); rewrite form_sum// mulmx1.
have low : 0 <= form 1%:M z + form 1%:M w - both z w.
  have := form1_ge0 (z - w); rewrite form_sum// mulmx1 mulmxN.
  have -> : form 1%:M (- w) = form 1%:M w by rewrite -scaleN1r form_scaled normrN normr1 expr1n mul1r.
  by rewrite [(- (z^H *m w)) 0 0]mxE rmorphN -opprD.
have [b0|b0] := ger0P b.
  by rewrite -mulrN ler_wpmul2l ?ler0q// -subr_ge0 opprK addrC.
rewrite rmorphN mulNr opprK ler_nmul2l ?ltrq0// -subr_ge0; exact: low.
Qed.

Lemma form_times_block d a b e z w :
  form (block_mx (multiple d a) (multiple d b) (multiple d b) (multiple d e)) (col_mx z w) =
  ratr a * form 1%:M z + ratr e * form 1%:M w + ratr b * both z w.
Proof.
rewrite -[X in block_mx _ _ X _](times_adj d b) form_block ?times_adj// !times_form.
rewrite /multiple mul_mx_scalar -scalemxAl [((_ *: _) : 'M_1) 0 0]mxE rmorphM fmorph_rat -mulrDr.
by [].
Qed.

Lemma posdef_block d (a b e : rat) : `|b| < a -> `|b| < e -> posdef (block_mx (multiple d a) (multiple d b) (multiple d b) (multiple d e)).
Proof.
move=> ba bd x; rewrite -[x]vsubmxK; move: (usubmx x) (dsubmx x) => z w nx; rewrite form_times_block.
apply: lt_le_trans (ler_add (lexx _) (both_bound z w b)); rewrite mulrDr opprD addrACA -!mulrBl -!rmorphB.
have pa : 0 < ratr (a - `|b|) :> algC by rewrite ltr0q subr_gt0.
have pd : 0 < ratr (e - `|b|) :> algC by rewrite ltr0q subr_gt0.
have [z0|nz] := eqVneq z 0; last first.
  by rewrite ltr_paddr ?(mulr_gt0 pa (form1_gt0 nz))// (mulr_ge0 (ltW pd) (form1_ge0 w)).
have nw : w != 0 by apply: contra nx => /eqP w0; rewrite z0 w0 col_mx0.
by rewrite ltr_paddl ?(mulr_gt0 pd (form1_gt0 nw))// (mulr_ge0 (ltW pa) (form1_ge0 z)).
Qed.

(* x' = -x + w + v without control, of which u = x is penalized: the cost is at most 8, of 2 tr X = 8/2. *)
Notation I := (times 1).
Lemma inst_cost_continuous : stable_continuous (times (-1)) /\
  forall X, times (-1) *m X + X *m (times (-1))^H + (I^H *m I *m I + I *m I *m I^H) = 0 ->
  \tr (I *m (I *m X *m I^H)) + \tr (I *m (I *m X *m I^H)) <=
  \tr (I *m times 2%:R *m I^H *m I) + \tr (I^H *m times 2%:R *m I *m I).
Proof.
apply: cost_continuous; rewrite ?timesE; do ?[exact: psd_times | exact: posdef_times].
Qed.

(* x(t+1) = x/2 + w + v, u = x + v. *)
Lemma inst_cost_discrete : stable_discrete (times (1 / 2%:R)) /\
  forall X, X = times (1 / 2%:R) *m X *m (times (1 / 2%:R))^H + (I^H *m I *m I + I *m I *m I^H) ->
  \tr (I *m (I *m X *m I^H)) + \tr (I *m (I *m X *m I^H + I *m I *m I^H)) <=
  \tr (I *m times 3%:R *m I^H *m I) + \tr (I^H *m times 3%:R *m I *m I) + \tr (I^H *m I *m I *m I).
Proof.
apply: cost_discrete; rewrite ?timesE; do ?[exact: psd_times | exact: posdef_times].
Qed.

(* z' = -z + v, v' = -v + n, u = z + v. *)
Lemma inst_cost_filtered : let Mv := with_noise (times (-1)) I 1 in let xv := row_mx I 0 in let uv := row_mx I I in
  let Gv : 'M_(2 + 2, 2) := col_mx 0 1%:M in let P := block_mx (times 4%:R) 0 0 (times 4%:R) in
  stable_continuous (times (-1)) /\
  forall X, Mv *m X + X *m Mv^H + (xv^H *m I *m xv + Gv *m I *m Gv^H) = 0 ->
  \tr (I *m (xv *m X *m xv^H)) + \tr (I *m (uv *m X *m uv^H)) <= \tr (xv *m P *m xv^H *m I) + \tr (Gv^H *m P *m Gv *m I).
Proof.
move=> Mv xv uv Gv P; apply: cost_filtered; rewrite ?ltr01//; do ?[exact: psd_times].
  by rewrite /P [0]times0; apply: posdef_block.
rewrite /P /Mv /xv /uv /with_noise !adj_block !adj_row !mulmx_block !mul_col_mx !mul_mx_row /block_mx.
rewrite !(opp_col_mx, add_col_mx, opp_row_mx, add_row_mx) !timesE.
exact: posdef_block.
Qed.

(* Both ports of x' = -x + w, u = x, at once: T = 1/(s + 1), and |T + 1/2| is at most 3/2. *)
Definition ones : 'rV[algC]_2 := const_mx 1.
Lemma diag_ones : diag_mx ones = I.
Proof. by rewrite /ones diag_const_mx times1. Qed.
Lemma ones0 k : 0 < ones 0 k. Proof. by rewrite mxE ltr01. Qed.
Lemma half_ratr : 2%:R^-1 = ratr (2%:R^-1) :> algC. Proof. by rewrite fmorphV rmorph_nat. Qed.
Lemma half_gt0 : 0 < (2%:R^-1 : algC). Proof. by rewrite invr_gt0 ltr0n. Qed.
Lemma corner_of (a : rat) (r : rat) : a ^- 2 - 2%:R^-1 ^+ 2 = r -> (ratr a ^- 2 - 2%:R^-1 ^+ 2) *: diag_mx ones = times r :> 'M[algC]_2.
Proof.
by move=> <-; rewrite diag_ones half_ratr -!rmorphX -fmorphV -rmorphB times_scale mulr1.
Qed.

Lemma inst_margin_continuous (d : 'rV[algC]_2) : (forall k, `|d 0 k| <= ratr (1 / 2%:R)) ->
  (forall k, 1 - d 0 k * 2%:R^-1 != 0) /\
  forall lambda, eigenvalue (multiplied (times (-1)) I I d) lambda -> 'Re lambda < 0.
Proof.
move=> near; apply: (margin_continuous (P := times 2%:R) _ ones0 _ near); first by rewrite ltr0q.
  exact: posdef_times.
rewrite /gain_continuous /= (@corner_of _ (15%:R / 4%:R))// diag_ones half_ratr !timesE.
exact: posdef_block.
Qed.

Lemma inst_margin_discrete (d : 'rV[algC]_2) : (forall k, `|d 0 k| <= ratr (1 / 4%:R)) ->
  (forall k, 1 - d 0 k * 2%:R^-1 != 0) /\
  forall lambda, eigenvalue (multiplied (times (1 / 2%:R)) I I d) lambda -> `|lambda| < 1.
Proof.
move=> near; apply: (margin_discrete (P := times 8%:R) _ ones0 _ near); first by rewrite ltr0q.
  exact: posdef_times.
rewrite /gain_discrete /= (@corner_of _ (63%:R / 4%:R))// diag_ones half_ratr !timesE.
exact: posdef_block.
Qed.

(* x' = -2x + f(x) and x(t+1) = f(x)/2, f between 0 and 1 times its argument. *)
Lemma diag_row (f : 'I_2 -> algC) (a : rat) : (forall k, f k = ratr a) -> diag_mx (\row_k f k) = times a.
Proof. by move=> e; rewrite /times -diag_const_mx; congr diag_mx; apply/rowP => k; rewrite !mxE e. Qed.
Lemma real_times a : real_mx (times a).
Proof. by move=> i j; rewrite mxE; case: (i == j); rewrite ?rpred0// CrealE fmorph_rat. Qed.
Lemma real_ones : real_mx ones. Proof. by move=> i j; rewrite mxE rpred1. Qed.
Lemma real_zeros : real_mx (0 : 'rV[algC]_2). Proof. by move=> i j; rewrite mxE rpred0. Qed.
Lemma products_of : products ones 0 ones = times 0.
Proof. by apply: diag_row => k; rewrite !mxE mul0r mulr0 rmorph0. Qed.
Lemma means_of : means ones 0 ones = times (1 / 2%:R).
Proof. by apply: diag_row => k; rewrite !mxE add0r !mul1r half_ratr. Qed.

Definition inst_sector_continuous := @sector_continuous _ 2 2 (times (-2%:R)) I I (times (-1)) ones 0 ones (real_times _)
  real_zeros real_ones ones0 (posdef_times ltr01).
Lemma inst_falls : exists2 e : algC, 0 < e & forall (z rate f : 'cV[algC]_2), real_mx z -> real_mx f -> within (times (-1)) 0 ones z f ->
  rate = (times (-2%:R) - I *m times (-1)) *m z + I *m f -> (rate^H *m I *m z + z^H *m I *m rate) 0 0 <= - (e * form I z).
Proof.
apply: inst_sector_continuous; rewrite /decrease_continuous /= products_of means_of diag_ones !timesE.
exact: posdef_block.
Qed.

Lemma inst_sector_discrete : exists rho : algC, [/\ 0 <= rho, rho < 1 & forall z f : nat -> 'cV[algC]_2,
  (forall t, [/\ real_mx (z t), real_mx (f t), within (times (- (1 / 2%:R))) 0 ones (z t) (f t) &
    z t.+1 = (times 0 - I *m times (- (1 / 2%:R))) *m z t + I *m f t]) ->
  forall t, form (times (1 / 4%:R)) (z t) <= rho ^+ t * form (times (1 / 4%:R)) (z 0%N)].
Proof.
apply: (@sector_discrete _ 2 2 (times 0) (times (1 / 4%:R)) I (times (- (1 / 2%:R))) ones 0 ones (real_times _)
  real_zeros real_ones ones0); first exact: posdef_times.
rewrite /decrease_discrete /= products_of means_of diag_ones !timesE.
exact: posdef_block.
Qed.

(* Bounds for every controller of x' = -x + u + w, y = x + v, at the controller z' = -2z + y, u = -z; the covariance exists. *)
Definition opE := (opp_col_mx, add_col_mx, opp_row_mx, add_row_mx).
Lemma block_times0 a d : block_mx (times a) 0 0 (times d) = block_mx (times a) (times 0) (times 0) (times d).
Proof. by rewrite -times0. Qed.
Lemma psd_block d (a b e : rat) : `|b| < a -> `|b| < e ->
  psd (block_mx (multiple d a) (multiple d b) (multiple d b) (multiple d e)).
Proof. by move=> ba bd; apply/posdef_psd/posdef_block. Qed.
Lemma one_block : posdef (1%:M : 'M[algC]_(2 + 2)). Proof. by move=> x; apply: form1_gt0. Qed.

Notation quarter := (times (1 / 4%:R)).
Notation half := (times (1 / 2%:R)).
Lemma psd_I : psd I. Proof. exact: psd_times. Qed.
Lemma psd_quarter : psd quarter. Proof. exact: psd_times. Qed.
Lemma psd_half : psd half. Proof. exact: psd_times. Qed.
Definition proper := loop_proper (times (-1)) I I (times (-2%:R)) I (times (-1)).
Lemma stable_proper : stable_continuous proper.
Proof.
apply: (posdef_stable_continuous one_block); rewrite mul1mx mulmx1 /proper /loop_proper !timesE adj_block !timesE.
by rewrite /block_mx !opE !timesE; apply: posdef_block.
Qed.

Lemma first_quarter : psd (first_continuous (times (-1)) I I quarter I quarter (times (-1))).
Proof.
rewrite /first_continuous adj_row !mul_col_mx !mul_mx_row /block_mx !timesE !opE !timesE; exact: psd_block.
Qed.

Lemma inst_bound_proper : exists X, [/\ proper *m X + X *m proper^H + noise_proper I I I = 0, psd X &
  \tr (quarter *m I) + \tr ((times (-1))^H *m quarter *m times (-1) *m quarter) <=
  \tr (I *m (state_proper _ 2 2 *m X *m (state_proper _ 2 2)^H)) +
    \tr (I *m (inputs_proper 2 (times (-1)) *m X *m (inputs_proper 2 (times (-1)))^H))].
Proof.
have pN : psd (noise_proper I I I) by rewrite /noise_proper !timesE; apply: psd_block.
have [X [eX pX _]] := covariance_continuous stable_proper pN; exists X; split=> //.
apply: (bound_proper psd_I psd_I (times_adj _ _) psd_quarter stable_proper eX first_quarter).
rewrite /second_proper !timesE; exact: psd_block.
Qed.

(* The same where the noise passes v' = -4v + 4n, at z' = -2z + y, u = -z - y. *)
Lemma posdef_three (a b d e f : rat) : `|b| < a -> `|b| + `|e| < d -> `|e| < f ->
  posdef (block_mx (block_mx (times a) (times b) (times b) (times d)) (col_mx (times 0) (times e))
    (row_mx (times 0) (times e)) (times f)).
Proof.
move=> ba bed ef x; rewrite -[x]vsubmxK; move: (usubmx x) (dsubmx x) => y w; rewrite -[y]vsubmxK.
move: (usubmx y) (dsubmx y) => z v nx.
have eX : (col_mx (times 0) (times e))^H = row_mx (times 0) (times e) by rewrite adj_col !times_adj.
rewrite -eX form_block; [|by rewrite adj_block !times_adj|exact: times_adj].
have -> : ((col_mx z v)^H *m col_mx (times 0) (times e) *m w) 0 0 = ratr e * (v^H *m w) 0 0.
  by rewrite adj_col mul_row_col -times0 mulmx0 add0r /times mul_mx_scalar -scalemxAl mxE.
rewrite rmorphM fmorph_rat -mulrDr -/(both v w) form_times_block times_form.
have pa : 0 < ratr (a - `|b|) :> algC by rewrite ltr0q subr_gt0.
have pd : 0 < ratr (d - (`|b| + `|e|)) :> algC by rewrite ltr0q subr_gt0.
have pf : 0 < ratr (f - `|e|) :> algC by rewrite ltr0q subr_gt0.
have h1 := both_bound z v b; have h2 := both_bound v w e.
apply: (@lt_le_trans _ _ (ratr (a - `|b|) * form 1%:M z + ratr (d - (`|b| + `|e|)) * form 1%:M v + ratr (f - `|e|) * form 1%:M w)).
  have [z0|nz] := eqVneq z 0; last first.
    rewrite -addrA ltr_paddr ?(mulr_gt0 pa (form1_gt0 nz))// addr_ge0//.
      exact: (mulr_ge0 (ltW pd) (form1_ge0 v)).
    exact: (mulr_ge0 (ltW pf) (form1_ge0 w)).
  have [v0|nv] := eqVneq v 0; last first.
    rewrite ltr_paddr ?(mulr_ge0 (ltW pf) (form1_ge0 w))// ltr_paddl ?(mulr_gt0 pd (form1_gt0 nv))//.
    exact: (mulr_ge0 (ltW pa) (form1_ge0 z)).
  have nw : w != 0 by apply: contra nx => /eqP w0; rewrite z0 v0 w0 !col_mx0.
  by rewrite z0 v0 !form0 !mulr0 !add0r; apply: (mulr_gt0 pf (form1_gt0 nw)).
rewrite !rmorphB rmorphD /= (abs_three (ring_of_R _)) ler_add// ler_add// ler_add//; exact: h1.
Qed.

Notation four := (ratr 4%:R : algC).
Definition filtered := loop_filtered (times (-1)) I I (times (-2%:R)) I (times (-1)) (times (-1)) four.
Lemma stable_filtered : stable_continuous filtered.
Proof.
have one : posdef (1%:M : 'M[algC]_(2 + 2 + 2)) by move=> x; apply: form1_gt0.
have four4 : (ratr 4%:R)%:M = times 4%:R by [].
apply: (posdef_stable_continuous one); rewrite mul1mx mulmx1 /filtered /loop_filtered four4 !timesE !adj_block adj_col adj_row !timesE.
rewrite !(opp_block_mx, add_block_mx) !opE !timesE; exact: posdef_three.
Qed.

Lemma inst_bound_continuous : exists X, [/\ filtered *m X + X *m filtered^H + noise_filtered 2 I I four = 0, psd X &
  \tr (quarter *m I) + \tr ((times (-1))^H *m quarter *m times (-1) *m quarter) <=
  \tr (I *m (state_filtered _ 2 2 2 *m X *m (state_filtered _ 2 2 2)^H)) +
    \tr (I *m (inputs_filtered I (times (-1)) (times (-1)) *m X *m (inputs_filtered I (times (-1)) (times (-1)))^H))].
Proof.
have four0 : 0 < four by rewrite ltr0q.
have pN : psd (noise_filtered 2 I I four).
  apply: psd_corner; rewrite -rmorphX !timesE; exact: psd_block.
have [X [eX pX _]] := covariance_continuous stable_filtered pN; exists X; split=> //.
apply: (bound_continuous psd_I psd_I (times_adj _ _) psd_quarter four0 stable_filtered eX first_quarter).
have two : 2%:R / four = ratr (2%:R / 4%:R) by rewrite fmorph_div; congr (_ / _); rewrite rmorph_nat.
rewrite /second_filtered /= two -fmorphV !timesE; exact: psd_block.
Qed.

(* Discrete time: x(t+1) = x/2 + u + w, y = x/2 + v, z(t+1) = z/4 + y/2, u = -z/4 - y/2. *)
Notation minus_half := (times (- (1 / 2%:R))).
Notation minus_quarter := (times (- (1 / 4%:R))).
Definition sampled := loop_discrete half I half quarter half minus_quarter minus_half.
Lemma stable_sampled : stable_discrete sampled.
Proof.
apply: (posdef_stable_discrete one_block); rewrite mulmx1 /sampled /loop_discrete !timesE adj_block !timesE mulmx_block.
have -> : 1%:M = block_mx I (times 0) (times 0) I by rewrite -times1 -times0 -scalar_mx_block.
rewrite /block_mx !opE !timesE; exact: posdef_block.
Qed.

Lemma inst_bound_discrete : exists X, [/\ X = sampled *m X *m sampled^H + noise_discrete I half minus_half I I, psd X &
  \tr (half *m I) + \tr (minus_half^H *m half *m minus_half *m quarter) <=
  \tr (I *m (state_proper _ 2 2 *m X *m (state_proper _ 2 2)^H)) +
    \tr (I *m (inputs_discrete half minus_quarter minus_half *m X *m (inputs_discrete half minus_quarter minus_half)^H +
      minus_half *m I *m minus_half^H))].
Proof.
have pN : psd (noise_discrete I half minus_half I I).
  by apply: psdD; [apply/psd_corner/psd_times | apply/psd_of/psd_times].
have [X [eX pX _]] := covariance_discrete stable_sampled pN; exists X; split=> //.
apply: (bound_discrete psd_I psd_I (times_adj _ _) psd_half stable_sampled eX).
  rewrite /first_discrete adj_row !mul_col_mx !mul_mx_row /block_mx !timesE !opE !timesE; exact: psd_block.
rewrite /second_discrete /= !timesE; exact: psd_block.
Qed.

(* Two agents that do not act on each other, each a group of its own; the intensities are those that the groups share out. *)
Definition nobody : rel 'I_2 := fun _ _ => false.
Definition alone (l : 'I_2) : {set 'I_2} := [set l].
Lemma alone_closed l j i : nobody j i -> j \in alone l -> i \in alone l. Proof. by []. Qed.
Lemma along_times a : along nobody id id (times a).
Proof. by move=> i j; rewrite mxE; case: (i =P j) => [->|]; rewrite ?eqxx //; left. Qed.
Lemma restricted_times (G : {set 'I_2}) a : restricted G id id (times a) = multiple _ a.
Proof. by rewrite /restricted /multiple mul_mx_scalar -scalemxAl chosen_one scalemx1. Qed.
Definition shared : 'M[algC]_2 := \sum_l chosen [numClosedFieldType of algC] (alone l) (@id 'I_2) *m multiple _ 1 *m (chosen [numClosedFieldType of algC] (alone l) (@id 'I_2))^H.
Lemma shared_rest : psd (shared - shared). Proof. by rewrite subrr; apply: psd0. Qed.
Definition genE d := (times1 d, times0 d, times_mul d, times_add d, times_opp d, times_adj d, times_scale d).

Lemma psd_shared : psd shared.
Proof. by apply: psd_sum => l; apply/psd_of/psd_times. Qed.
Notation certificate a := (fun l => multiple #|owned (alone l) (@id 'I_2)| a).

Lemma inst_groups_proper : exists X, [/\ proper *m X + X *m proper^H + noise_proper I shared shared = 0, psd X &
  \sum_(l < 2) (\tr (certificate (1 / 4%:R) l *m certificate 1 l) +
    \tr ((certificate (-1) l)^H *m certificate (1 / 4%:R) l *m certificate (-1) l *m certificate (1 / 4%:R) l)) <=
  \tr (I *m (state_proper _ 2 2 *m X *m (state_proper _ 2 2)^H)) +
    \tr (I *m (inputs_proper 2 (times (-1)) *m X *m (inputs_proper 2 (times (-1)))^H))].
Proof.
have pN : psd (noise_proper I shared shared).
  by apply: psd_blocks; [exact: psd_shared | apply: psd_of; exact: psd_shared].
have [X [eX pX _]] := covariance_continuous stable_proper pN; exists X; split=> //.
have ld l : psd (certificate 1 l) by exact: psd_times.
have lq l : psd (certificate (1 / 4%:R) l) by exact: psd_times.
have hS l : (certificate (1 / 4%:R) l)^H = certificate (1 / 4%:R) l by exact: times_adj.
have h := bound_by_groups_proper (@along_times _) (@along_times _) (@along_times _) (@along_times _) (@along_times _) (@along_times _)
  (psd_times ler01) (psd_times ler01) (@alone_closed) (P' := certificate (1 / 4%:R)) (F' := certificate (-1)) (@ld) (@ld) hS (@lq)
  (@shared_rest) (@shared_rest) stable_proper eX.
apply: h => l.
  rewrite !restricted_times /first_continuous adj_row !mul_col_mx !mul_mx_row /block_mx !genE !opE !genE.
  exact: psd_block.
rewrite !restricted_times /second_proper !genE; exact: psd_block.
Qed.

Lemma inst_groups_continuous : exists X, [/\ filtered *m X + X *m filtered^H + noise_filtered 2 shared shared four = 0, psd X &
  \sum_(l < 2) (\tr (certificate (1 / 4%:R) l *m certificate 1 l) +
    \tr ((certificate (-1) l)^H *m certificate (1 / 4%:R) l *m certificate (-1) l *m certificate (1 / 4%:R) l)) <=
  \tr (I *m (state_filtered _ 2 2 2 *m X *m (state_filtered _ 2 2 2)^H)) +
    \tr (I *m (inputs_filtered I (times (-1)) (times (-1)) *m X *m (inputs_filtered I (times (-1)) (times (-1)))^H))].
Proof.
have four0 : 0 < four by rewrite ltr0q.
have pN : psd (noise_filtered 2 shared shared four).
  by apply: psd_corner; apply: psd_blocks; [exact: psd_shared | apply: psdZ psd_shared; rewrite exprn_ge0// ltW].
have [X [eX pX _]] := covariance_continuous stable_filtered pN; exists X; split=> //.
have ld l : psd (certificate 1 l) by exact: psd_times.
have lq l : psd (certificate (1 / 4%:R) l) by exact: psd_times.
have hS l : (certificate (1 / 4%:R) l)^H = certificate (1 / 4%:R) l by exact: times_adj.
have h := bound_by_groups_continuous (@along_times _) (@along_times _) (@along_times _) (@along_times _) (@along_times _)
  (@along_times _) (@along_times _) (psd_times ler01) (psd_times ler01) (@alone_closed) (P' := certificate (1 / 4%:R))
  (F' := certificate (-1)) (@ld) (@ld) hS (@lq) (@shared_rest) (@shared_rest) four0 stable_filtered eX.
apply: h => l.
  rewrite !restricted_times /first_continuous adj_row !mul_col_mx !mul_mx_row /block_mx !genE !opE !genE.
  exact: psd_block.
have two : 2%:R / four = ratr (2%:R / 4%:R) by rewrite fmorph_div; congr (_ / _); rewrite rmorph_nat.
rewrite !restricted_times /second_filtered /= two -fmorphV !genE; exact: psd_block.
Qed.

Lemma inst_groups_discrete : exists X, [/\ X = sampled *m X *m sampled^H + noise_discrete I half minus_half shared shared, psd X &
  \sum_(l < 2) (\tr (certificate (1 / 2%:R) l *m certificate 1 l) + \tr ((certificate (- (1 / 2%:R)) l)^H *m
    certificate (1 / 2%:R) l *m certificate (- (1 / 2%:R)) l *m certificate (1 / 4%:R) l)) <=
  \tr (I *m (state_proper _ 2 2 *m X *m (state_proper _ 2 2)^H)) +
    \tr (I *m (inputs_discrete half minus_quarter minus_half *m X *m (inputs_discrete half minus_quarter minus_half)^H +
      minus_half *m shared *m minus_half^H))].
Proof.
have pN : psd (noise_discrete I half minus_half shared shared).
  by apply: psdD; [apply: psd_corner psd_shared | apply: psd_of psd_shared].
have [X [eX pX _]] := covariance_discrete stable_sampled pN; exists X; split=> //.
have ld l : psd (certificate 1 l) by exact: psd_times.
have lh l : psd (certificate (1 / 2%:R) l) by exact: psd_times.
have hS l : (certificate (1 / 4%:R) l)^H = certificate (1 / 4%:R) l by exact: times_adj.
have h := bound_by_groups_discrete (@along_times _) (@along_times _) (@along_times _) (@along_times _) (@along_times _)
  (@along_times _) (@along_times _) (psd_times ler01) (psd_times ler01) (@alone_closed) (P' := certificate (1 / 2%:R))
  (F' := certificate (- (1 / 2%:R))) (@ld) (@ld) hS (@lh) (@shared_rest) (@shared_rest) stable_sampled eX.
apply: h => l.
  rewrite !restricted_times /first_discrete adj_row !mul_col_mx !mul_mx_row /block_mx !genE !opE !genE.
  exact: psd_block.
rewrite !restricted_times /second_discrete /= !genE; exact: psd_block.
Qed.
