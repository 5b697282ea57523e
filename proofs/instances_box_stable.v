(* One state and one signal, x' = ax + w, w = 0, a within 1/2 of -1: regular between 0 and i/2 and beyond, so every member is
   stable; and arcs of the unit circle. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mcexact Require Import location crossing arcs box_stable.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Instance.
Variable R : rcfType.
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Notation half := (2%:R^-1 : R).

Definition center a : 'M[R]_(1 + 1) := block_mx a%:M 0 0 (-1)%:M.
Definition radii : 'M[R]_(1 + 1) := block_mx half%:M 0 0 0.

Lemma members a Z' : member (center a) radii Z' -> exists2 x, `|x - a| <= half & Z' = block_mx x%:M 0 0 (-1)%:M.
Proof.
move=> mem; have part i j : `|Z' i j - center a i j| <= radii i j by exact: mem.
have same i j : radii i j = 0 -> Z' i j = center a i j.
  by move=> r0; apply/eqP; rewrite -subr_eq0 -normr_le0 -r0.
exists (Z' (lshift 1 0) (lshift 1 0)).
  by have := part (lshift 1 0) (lshift 1 0); rewrite !block_mxEul !mxE.
rewrite -[LHS]submxK; congr block_mx; apply/matrixP => i j; rewrite !ord1 !mxE ?eqxx //=.
- by rewrite same /center ?block_mxEur ?mxE// /radii block_mxEur mxE.
- by rewrite same /center ?block_mxEdl ?mxE// /radii block_mxEdl mxE.
by rewrite same /center ?block_mxEdr ?mxE// /radii block_mxEdr mxE.
Qed.

Lemma loop x : loop_of (block_mx x%:M 0 0 (-1)%:M : 'M[R]_(1 + 1)) = x%:M.
Proof. by rewrite /loop_of block_mxKul block_mxKur !mul0mx subr0. Qed.

Lemma finite a Z' : member (center a) radii Z' -> drsubmx Z' \in unitmx.
Proof. by case/members => x _ ->; rewrite block_mxKdr unitmxE det_scalar1 unitrN1. Qed.

Lemma eigenvalue_of (x : R) (lambda : C) : eigenvalue (map_mx inC (x%:M : 'M_1)) lambda = (lambda == inC x).
Proof.
rewrite map_scalar_mx eigenvalue_root_char /char_poly /char_poly_mx map_scalar_mx /=.
by rewrite -raddfB det_scalar1 root_XsubC.
Qed.

Lemma regular a lambda : (forall x, `|x - a| <= half -> lambda != inC x) ->
  forall Z', member (center a) radii Z' -> lambda *: block_mx 1%:M 0 0 0 - map_mx inC Z' \in unitmx.
Proof.
move=> off Z' mem; have u := finite mem; have [x near e] := members mem.
rewrite loop_eigenvalue -?map_drsubmx ?map_unitmx// -(loop_up (@finite a) mem) e loop eigenvalue_of.
exact: off.
Qed.

Lemma start a (lambda : C) : eigenvalue (map_mx inC (loop_of (center a))) lambda -> lambda = inC a.
Proof. by rewrite loop eigenvalue_of => /eqP. Qed.

Lemma half_1 : half < 1.
Proof. by rewrite invf_lt1 ?ltr0n// ltr1n. Qed.

Lemma off_axis (lambda : C) : 'Re lambda = - inC 0 -> forall x, `|x - (-1)| <= half -> lambda != inC x.
Proof.
move=> re x near; apply/eqP => e; move: re; rewrite e (Creal_ReP _ (inC_real x)) rmorph0 oppr0.
move=> /eqP; rewrite fmorph_eq0 => /eqP x0; move: near; rewrite x0 sub0r opprK normr1 => /le_lt_trans/(_ half_1).
by rewrite ltxx.
Qed.

Notation quarter := (4%:R^-1 : R).
Lemma off_left (lambda : C) : - inC quarter <= 'Re lambda -> forall x, `|x - (-1)| <= half -> lambda != inC x.
Proof.
move=> re x near; apply/eqP => e; move: re; rewrite e (Creal_ReP _ (inC_real x)) -rmorphN inC_le => le.
have q : quarter < half by rewrite ltf_pinv ?posrE ?ltr0n// ltr_nat.
have one : half + half = 1 by rewrite -[half]div1r -splitr.
move: near; rewrite opprK => /(le_trans (ler_norm _)); 
have -> : x + 1 = x + half + half by rewrite -addrA one.
rewrite ger_addr => up.
have : half <= quarter.
  rewrite -subr_le0 (le_trans _ up)// addrC ler_add2r//.
by rewrite leNgt q.
Qed.

Lemma on_border : segments (fun lambda : C => forall Z', member (center (-1)) radii Z' ->
  lambda *: block_mx 1%:M 0 0 0 - map_mx inC Z' \in unitmx) (inC 0) 0 [:: 2%:R^-1].
Proof.
split=> lambda.
  move=> near; apply: regular; apply: off_left; rewrite rmorph0 !oppr0 !add0r addr0 in near.
  have [h _] := leif_normC_Re_Creal (lambda - 'i * (2%:R^-1 / 2%:R)).
  have := le_trans h near; rewrite raddfB /= ReMr ?rpred_div ?rpredV ?realn// Re_i mul0r subr0.
  rewrite real_ler_norml ?Creal_Re// => /andP[low _]; apply: le_trans low.
  by rewrite fmorphV rmorph_nat -invfM -natrM.
by move=> re _; apply: regular; apply: off_axis.
Qed.

Lemma inside (lambda : C) : eigenvalue (map_mx inC (loop_of (center (-1)))) lambda -> 'Re lambda < - inC 0.
Proof. by move=> /start ->; rewrite (Creal_ReP _ (inC_real _)) -rmorphN inC_lt oppr0 ltrN10. Qed.

Lemma rising : path.path <%R 0 [:: 2%:R^-1 : C].
Proof. by rewrite /= invr_gt0 ltr0n. Qed.

Definition inst_box_stable_continuous := box_stable_continuous (@finite (-1)) rising inside on_border.

(* The same where a is p/4 with |p| <= 1 from -1, up to 1/4. *)
Definition slope (_ : 'I_1) : 'M[R]_(1 + 1) := block_mx quarter%:M 0 0 0.
Lemma tied_near a Z' : tied_member (center a) (slope 0) slope Z' -> member (center a) radii Z'.
Proof.
move=> [p p1 mem] i j; apply: (@le_trans _ _ (slope 0 i j + `|slope 0 i j|)).
  have -> : Z' i j - center a i j = (Z' - (center a + \sum_l p l *: slope l)) i j + p 0 * slope 0 i j.
    by rewrite big_ord1; move: (center a) (slope 0) => c s; rewrite !mxE opprD addrA subrK.
  rewrite (le_trans (ler_norm_add _ _))// ler_add// normrM.
  by rewrite (le_trans (ler_wpmul2r (normr_ge0 _) (p1 0)))// mul1r.
have e : quarter + `|quarter| = half.
  have -> : quarter = half / 2%:R by rewrite -invfM -natrM.
  by rewrite ger0_norm ?divr_ge0 ?invr_ge0 ?ler0n// -splitr.
case: (split_ordP i) => k ->; case: (split_ordP j) => l ->; rewrite ?ord1 /slope /radii.
- by rewrite !block_mxEul !mxE eqxx e.
- by rewrite !block_mxEur !mxE normr0 addr0.
- by rewrite !block_mxEdl !mxE normr0 addr0.
by rewrite !block_mxEdr !mxE normr0 addr0.
Qed.

Definition inst_tied_stable_continuous : forall Z', tied_member (center (-1)) (slope 0) slope Z' -> forall lambda,
  eigenvalue (map_mx inC (loop_of Z')) lambda -> 'Re lambda < - inC 0.
Proof.
have u Z' : tied_member (center (-1)) (slope 0) slope Z' -> drsubmx Z' \in unitmx by move/tied_near/finite.
apply: (tied_stable_continuous u rising inside); have [first last] := on_border.
by split=> lambda => [near|re far] Z' /tied_near; [apply: first near Z'|apply: last re far Z'].
Qed.

(* No states: nothing to be stable, on arcs that are not trivial. *)
Definition nothing : 'M[R]_(0 + 1) := block_mx 0 0 0 (-1)%:M.
Lemma same Z' : member nothing 0 Z' -> Z' = nothing.
Proof. by move=> mem; apply/matrixP => i j; apply/eqP; rewrite -subr_eq0 -normr_le0 (le_trans (mem i j))// mxE. Qed.

Lemma computed Z' : member nothing 0 Z' -> drsubmx Z' \in unitmx.
Proof. by move/same ->; rewrite block_mxKdr unitmxE det_scalar1 unitrN1. Qed.

Lemma out (N : 'M[C]_0) lambda : eigenvalue N lambda -> `|lambda| < inC 1.
Proof. by rewrite /eigenvalue => /eqP; case; apply/matrixP => i; case: i. Qed.

Lemma around : arcs (fun lambda : C => forall Z', member nothing 0 Z' ->
  lambda *: block_mx 1%:M 0 0 0 - map_mx inC Z' \in unitmx) (inC 1) 0 [:: 1; 2%:R].
Proof.
have reg (lambda : C) Z' : member nothing 0 Z' -> lambda *: block_mx 1%:M 0 0 0 - map_mx inC Z' \in unitmx.
  move=> mem; rewrite loop_eigenvalue -?map_drsubmx ?map_unitmx ?computed//.
  by rewrite /eigenvalue negbK; apply/eqP/matrixP => i; case: i.
by split=> [z _ Z'|]; [exact: reg | split=> z _ Z'; exact: reg].
Qed.

Lemma growing : path.path <%R 0 [:: 1; 2%:R : C].
Proof. by rewrite /= ltr01 ltr1n. Qed.

Definition inst_box_stable_discrete := box_stable_discrete computed ltr01 growing (@out _) around.

Lemma tied_nothing Z' : tied_member nothing 0 (fun _ : 'I_1 => 0) Z' -> member nothing 0 Z'.
Proof.
move=> [p _ mem] i j; have := mem i j; rewrite big_ord1 scaler0 addr0.
by move: nothing => c; rewrite [X in `|X| <= _ -> _]mxE [(- c) i j]mxE.
Qed.

Definition inst_tied_stable_discrete : forall Z', tied_member nothing 0 (fun _ : 'I_1 => 0) Z' -> forall lambda,
  eigenvalue (map_mx inC (loop_of Z')) lambda -> `|lambda| < inC 1.
Proof.
have u Z' : tied_member nothing 0 (fun _ : 'I_1 => 0) Z' -> drsubmx Z' \in unitmx by move/tied_nothing/computed.
apply: (tied_stable_discrete u ltr01 growing (@out _)); have [first [second last]] := around.
split=> [z near Z' /tied_nothing|]; first by apply: first near Z'.
by split=> z near Z' /tied_nothing; [apply: second near Z'|apply: last near Z'].
Qed.

(* x + 1 at every t: no root meets the axis. *)
Definition path : {poly {poly R}} := 'X + 1%:P.
Lemma path_root t (z : C) : root (at_ t path) z = (z == -1).
Proof.
rewrite /at_ /path !rmorphD /= !map_polyX !rmorph1.
have -> : 'X + 1 = 'X - (-1)%:P :> {poly C} by rewrite polyCN opprK.
exact: root_XsubC.
Qed.

Lemma inst_no_crossing : forall z : C, root (at_ 1 path) z -> 'Re z < 0.
Proof.
have s2 : size path = 2%N by rewrite /path -[1%:P]opprK -polyCN size_XsubC.
have l1 t : (path`_1).[t] = 1 by rewrite /path coefD coefX coefC addr0 hornerC.
have m1 (z : C) : z = -1 -> 'Re z < 0.
  by move=> ->; rewrite (Creal_ReP _ _) ?rpredN ?rpred1// ltrN10.
have [qs h] := @hurwitz_signs R 1 path (eq_leq s2).
apply: (no_crossing (@apart_left C) (eq_leq s2) _ h) => [t _|t z _ re|z].
- by rewrite l1 ltr01.
- by rewrite path_root; apply: contra_eqN re => /eqP/m1; rewrite lt_def eq_sym => /andP[].
by rewrite path_root => /eqP/m1.
Qed.
End Instance.

Section Arcs.
Variable C : numClosedFieldType.
Definition inst_circle_point := @circle_point C 1 1 (real1 C).
Definition inst_arc_in_disc := @arc_in_disc C 1 0 1 2%:R (real1 C) (lexx _) ler01 (ler1n _ 2).
Definition inst_last_arc_in_disc := @last_arc_in_disc C 1 1 2%:R (real1 C) ler01 (ler1n _ 2).
Lemma im_i : 0 <= 'Im ('i : C). Proof. by rewrite Im_i ler01. Qed.
Definition inst_upper_half : True := @upper_half C (fun=> True) [:: 1] 1 'i ltr01
  (andb_true_intro (conj ltr01 isT)) (conj (fun _ _ => I) (fun _ _ => I)) (normCi C) im_i.
Definition inst_upper_line : True := @upper_line C (fun=> True) [:: 1] 0 'i (real0 C)
  (andb_true_intro (conj ltr01 isT)) (conj (fun _ _ => I) (fun _ _ _ => I)) (etrans (Re_i C) (esym (oppr0 _))) im_i.
Lemma zero_real : forall i j, (0 : 'M[C]_1) i j \is Num.real. Proof. by move=> i j; rewrite mxE real0. Qed.
Definition inst_conjugate_eigenvalue := @conjugate_eigenvalue C 1 0 0 zero_real.
End Arcs.
