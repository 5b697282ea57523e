(* checker/boxes.py: one input, or one output, is multiplied by complex numbers near 1, for every plant within the radii.
   Members have complex entries, and the conjugate of each of them is one, too: so the upper half of the border is enough.
   A complex matrix is the same as a real one of twice its size, to which the theorems about real members apply. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex polyrcf.
From mcexact Require Import location crossing arcs box_stable.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Lemma conj_sum (F : numClosedFieldType) (a b : F) : a \is Num.real -> b \is Num.real -> (a + 'i * b)^* = a - 'i * b.
Proof. by move=> ra rb; rewrite rmorphD rmorphM /= conjCi (CrealP ra) (CrealP rb) mulNr. Qed.

Section Double.
Variable R : rcfType.
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Notation up M := (map_mx inC M).
Notation bar M := (map_mx conjC M).

Lemma conj_inC (x : R) : (inC x : C)^* = inC x.
Proof. exact/CrealP/inC_real. Qed.

(* [Re M, -Im M; Im M, Re M]. *)
Definition twice m n (M : 'M[C]_(m, n)) : 'M[R]_(m + m, n + n) :=
  block_mx (map_mx (@complex.Re R) M) (- map_mx (@complex.Im R) M) (map_mx (@complex.Im R) M) (map_mx (@complex.Re R) M).

Lemma parts (z : C) : z = inC (complex.Re z) + 'i * inC (complex.Im z).
Proof.
have re : inC (complex.Re z) = 'Re z by exact: complexRe.
have im : inC (complex.Im z) = 'Im z by exact: complexIm.
by rewrite re im -Crect.
Qed.

Definition pair m n (M : 'M[C]_(m, n)) : 'M[C]_(m + m, n + n) := block_mx M 0 0 (bar M).
Definition turn n : 'M[C]_(n + n) := block_mx 1%:M 1%:M (- 'i)%:M 'i%:M.
Definition back n : 'M[C]_(n + n) := 2%:R^-1 *: block_mx 1%:M 'i%:M 1%:M (- 'i)%:M.

Lemma turn_back n : turn n *m back n = 1%:M.
Proof.
have z : (0 : C)%:M = 0 :> 'M_n by exact: raddf0.
have plus (a b : C) : a%:M + b%:M = (a + b)%:M :> 'M_n by rewrite raddfD.
have e : turn n *m block_mx 1%:M 'i%:M 1%:M (- 'i)%:M = (2%:R)%:M.
  rewrite /turn mulmx_block !mulmx1 !mul1mx -!scalar_mxM !plus !mulNr !mulrN -!expr2 sqrCi !opprK.
  by rewrite subrr addNr z -[1 + 1]/(2%:R) -scalar_mx_block.
by rewrite /back -scalemxAr e scale_scalar_mx mulVf ?pnatr_eq0.
Qed.

Lemma back_turn n : back n *m turn n = 1%:M.
Proof. exact/mulmx1C/turn_back. Qed.

Lemma twice_turn m n (M : 'M[C]_(m, n)) : up (twice M) *m turn n = turn m *m pair M.
Proof.
rewrite /twice /turn /pair map_block_mx mulmx_block mulmx_block !mulmx1 !mul1mx !mulmx0 !addr0 !add0r.
have real (x : C) : x = inC (complex.Re x) + 'i * inC (complex.Im x) by exact: parts.
congr block_mx; apply/matrixP => i j; rewrite ?mul_mx_scalar ?mul_scalar_mx !mxE;
  rewrite [in RHS](real (M i j)) ?conj_sum ?inC_real//; move: (complex.Re _) (complex.Im _) => x y.
- by rewrite rmorphN /= mulrNN.
- by rewrite rmorphN /= mulrN.
- by rewrite mulrDr mulNr mulNr mulrA -expr2 sqrCi mulN1r opprK addrC.
by rewrite mulrBr mulrA -expr2 sqrCi mulN1r opprK addrC.
Qed.

Lemma up_twice m n (M : 'M[C]_(m, n)) : up (twice M) = turn m *m pair M *m back n.
Proof. by rewrite -twice_turn -mulmxA turn_back mulmx1. Qed.

Lemma pairM m n p (M : 'M[C]_(m, n)) (N : 'M[C]_(n, p)) : pair (M *m N) = pair M *m pair N.
Proof. by rewrite /pair mulmx_block !mulmx0 !mul0mx !addr0 !add0r map_mxM. Qed.

Lemma pairB m n (M N : 'M[C]_(m, n)) : pair (M - N) = pair M - pair N.
Proof. by rewrite /pair opp_block_mx add_block_mx !oppr0 !addr0 map_mxB. Qed.

Lemma pair1 n : pair (1%:M : 'M[C]_n) = 1%:M.
Proof. by rewrite /pair map_mx1 -scalar_mx_block. Qed.

Lemma unit_pair n (M : 'M[C]_n) : M \in unitmx -> pair M \in unitmx.
Proof. by move=> u; rewrite unitmxE /pair det_ublock unitrM -!unitmxE map_unitmx u. Qed.

Lemma pairV n (M : 'M[C]_n) : M \in unitmx -> pair (invmx M) = invmx (pair M).
Proof.
move=> u; apply: (can_inj (mulKmx (unit_pair u))); rewrite mulmxV ?unit_pair//.
by rewrite -pairM mulmxV// pair1.
Qed.

Lemma unit_turn n : turn n \in unitmx.
Proof. by case: (mulmx1_unit (turn_back n)). Qed.
Lemma unit_back n : back n \in unitmx.
Proof. by case: (mulmx1_unit (turn_back n)). Qed.

Lemma inv_turned n (M : 'M[C]_(n + n)) : M \in unitmx -> invmx (turn n *m M *m back n) = turn n *m invmx M *m back n.
Proof.
move=> u; have uT : turn n *m M *m back n \in unitmx by rewrite !unitmx_mul unit_turn u unit_back.
apply: (can_inj (mulKmx uT)); rewrite mulmxV// !mulmxA -[_ *m back n *m turn n]mulmxA back_turn mulmx1.
by rewrite -[turn n *m M *m invmx M]mulmxA mulmxV// mulmx1 turn_back.
Qed.

Lemma unit_twice n (M : 'M[C]_n) : M \in unitmx -> twice M \in unitmx.
Proof. by move=> u; rewrite -(map_unitmx inC) up_twice !unitmx_mul unit_turn unit_back unit_pair. Qed.

Lemma part_along (z w : C) (t : R) :
  complex.Re (z + inC t * (w - z)) = complex.Re z + t * (complex.Re w - complex.Re z) /\
  complex.Im (z + inC t * (w - z)) = complex.Im z + t * (complex.Im w - complex.Im z).
Proof. by case: z w => [a b] [c d] /=; rewrite !mul0r subr0 addr0. Qed.

Lemma twice_along m n (M N : 'M[C]_(m, n)) (t : R) : twice (M + inC t *: (N - M)) = twice M + t *: (twice N - twice M).
Proof.
rewrite /twice opp_block_mx add_block_mx scale_block_mx add_block_mx.
congr block_mx; apply/matrixP => i j; have [re im] := part_along (M i j) (N i j) t;
  rewrite !mxE ?re ?im// opprD -mulrN opprB.
by congr (_ + t * _); rewrite opprK addrC.
Qed.

Lemma eigenvalue_turned n (M : 'M[C]_(n + n)) z : eigenvalue (turn n *m M *m back n) z = eigenvalue M z.
Proof.
apply/eigenvalueP/eigenvalueP => -[v ev nv].
  exists (v *m turn n); first by rewrite -[v *m turn n *m M]mulmxA -[turn n *m M]mulmx1 -(back_turn n) [_ *m (back n *m _)]mulmxA mulmxA ev scalemxAl.
  by apply: contra nv => /eqP e; rewrite -[v]mulmx1 -(turn_back n) mulmxA e mul0mx.
exists (v *m back n); last by apply: contra nv => /eqP e; rewrite -[v]mulmx1 -(back_turn n) mulmxA e mul0mx.
by rewrite !mulmxA -[v *m back n *m turn n]mulmxA back_turn mulmx1 ev scalemxAl.
Qed.

Lemma eigenvalue_pair n (M : 'M[C]_n) z : eigenvalue (pair M) z = eigenvalue M z || eigenvalue (bar M) z.
Proof.
apply/eigenvalueP/orP => [[v]|[/eigenvalueP[v ev nv]|/eigenvalueP[v ev nv]]].
- rewrite -[v]hsubmxK mul_row_block !mulmx0 addr0 add0r scale_row_mx => /eq_row_mx[el er] nv.
  have [l0|nl] := eqVneq (lsubmx v) 0; last by left; apply/eigenvalueP; exists (lsubmx v).
  right; apply/eigenvalueP; exists (rsubmx v) => //; apply: contra nv => /eqP r0.
  by rewrite l0 r0 row_mx0.
- exists (row_mx v 0); first by rewrite mul_row_block !mulmx0 !mul0mx !addr0 ev scale_row_mx scaler0.
  by apply: contra nv => /eqP e; rewrite -(row_mxKl v (0 : 'rV[C]_n)) e raddf0.
exists (row_mx 0 v); first by rewrite mul_row_block !mulmx0 !mul0mx !add0r ev scale_row_mx scaler0.
by apply: contra nv => /eqP e; rewrite -(row_mxKr (0 : 'rV[C]_n) v) e raddf0.
Qed.

(* The loop of twice a pencil has the eigenvalues of the loop, and their conjugates. *)
Section Loop.
Variables n k : nat.
Implicit Types Z : 'M[C]_(n + k).

Definition twice_pencil Z : 'M[R]_((n + n) + (k + k)) :=
  block_mx (twice (ulsubmx Z)) (twice (ursubmx Z)) (twice (dlsubmx Z)) (twice (drsubmx Z)).

Lemma unit_twice_pencil Z : drsubmx Z \in unitmx -> drsubmx (twice_pencil Z) \in unitmx.
Proof. by move=> u; rewrite block_mxKdr unit_twice. Qed.

Lemma loop_twice Z : drsubmx Z \in unitmx ->
  loop_of (up (twice_pencil Z)) = turn n *m pair (loop_of Z) *m back n.
Proof.
move=> u; rewrite /loop_of -!map_ulsubmx -!map_ursubmx -!map_dlsubmx -!map_drsubmx.
rewrite block_mxKul block_mxKur block_mxKdl block_mxKdr !up_twice inv_turned ?unit_pair//.
rewrite !mulmxA -[_ *m back k *m turn k]mulmxA back_turn mulmx1 -[_ *m back k *m turn k]mulmxA back_turn mulmx1.
rewrite pairB !pairM pairV// mulmxBr mulmxBl; congr (_ - _).
by rewrite !mulmxA.
Qed.

Lemma loop_bar Z : drsubmx Z \in unitmx -> bar (loop_of Z) = loop_of (bar Z).
Proof.
move=> u; rewrite /loop_of map_mxB !map_mxM map_invmx.
by rewrite map_ulsubmx map_ursubmx map_dlsubmx map_drsubmx.
Qed.

Lemma eigenvalue_twice Z z : drsubmx Z \in unitmx ->
  eigenvalue (loop_of (up (twice_pencil Z))) z = eigenvalue (loop_of Z) z || eigenvalue (loop_of (bar Z)) z.
Proof. by move=> u; rewrite loop_twice// eigenvalue_turned eigenvalue_pair loop_bar. Qed.

Lemma twice_pencil_along Z Z' (t : R) :
  twice_pencil (Z + inC t *: (Z' - Z)) = along (twice_pencil Z) (twice_pencil Z') t.
Proof.
rewrite /along /twice_pencil opp_block_mx add_block_mx scale_block_mx add_block_mx -!twice_along.
by congr block_mx; congr twice; apply/matrixP => i j; rewrite !mxE.
Qed.
End Loop.

(* Any set of complex members that contains their conjugates, and with each of them the line to it from the center. *)
Section Stable.
Variables (n k : nat) (Z : 'M[R]_(n + k)) (member : 'M[C]_(n + k) -> Prop).
Hypothesis center : member (up Z).
Hypothesis finite : forall Z', member Z' -> drsubmx Z' \in unitmx.
Hypothesis mirrored : forall Z', member Z' -> member (bar Z').
Hypothesis connected : forall Z' t, member Z' -> 0 <= t <= 1 -> member (up Z + inC t *: (Z' - up Z)).
Notation regular lambda := (forall Z', member Z' -> lambda *: block_mx 1%:M 0 0 0 - Z' \in unitmx).

Let doubled (D : 'M[R]_((n + n) + (k + k))) := exists2 Z', member Z' & D = twice_pencil Z'.

Let finite2 D : doubled D -> drsubmx D \in unitmx.
Proof. by case=> Z' mem ->; rewrite unit_twice_pencil ?finite. Qed.

Let connected2 D t : doubled D -> 0 <= t <= 1 -> doubled (along (twice_pencil (up Z)) D t).
Proof.
case=> Z' mem -> t01; exists (up Z + inC t *: (Z' - up Z)); first exact: connected.
by rewrite twice_pencil_along.
Qed.

Let regular2 lambda : regular lambda -> forall D, doubled D -> lambda *: block_mx 1%:M 0 0 0 - up D \in unitmx.
Proof.
move=> reg D [Z' mem ->]; have u := finite mem.
rewrite loop_eigenvalue -?map_drsubmx ?map_unitmx ?unit_twice_pencil// eigenvalue_twice// negb_or.
have mem' := mirrored mem; have v := finite mem'.
apply/andP; split.
  by move: (reg _ mem); rewrite (loop_eigenvalue lambda u).
by move: (reg _ mem'); rewrite (loop_eigenvalue lambda v).
Qed.

Let bar_center : bar (up Z) = up Z.
Proof. by apply/matrixP => i j; rewrite !mxE conj_inC. Qed.

Let eigenvalues2 Z' z : member Z' ->
  eigenvalue (up (loop_of (twice_pencil Z'))) z = eigenvalue (loop_of Z') z || eigenvalue (loop_of (bar Z')) z.
Proof.
move=> mem; have u := finite mem.
by rewrite (@loop_up _ _ _ doubled finite2) ?eigenvalue_twice//; exists Z'.
Qed.

Theorem complex_continuous (b : R) :
  (forall lambda, eigenvalue (loop_of (up Z)) lambda -> 'Re lambda < - inC b) ->
  (forall lambda, 'Re lambda = - inC b -> 0 <= 'Im lambda -> regular lambda) ->
  forall Z', member Z' -> forall lambda, eigenvalue (loop_of Z') lambda -> 'Re lambda < - inC b.
Proof.
move=> start reg Z' mem lambda ev.
apply: (members_continuous (Z := twice_pencil (up Z)) (member := doubled) finite2 connected2 (b := b) _ _ (Z' := twice_pencil Z')).
- by move=> z; rewrite eigenvalues2// bar_center orbb; apply: start.
- by move=> z re im; apply/regular2/reg.
- by exists Z'.
by rewrite eigenvalues2// ev.
Qed.

Theorem complex_discrete (r : R) : 0 < r ->
  (forall lambda, eigenvalue (loop_of (up Z)) lambda -> `|lambda| < inC r) ->
  (forall lambda, `|lambda| = inC r -> 0 <= 'Im lambda -> regular lambda) ->
  forall Z', member Z' -> forall lambda, eigenvalue (loop_of Z') lambda -> `|lambda| < inC r.
Proof.
move=> r0 start reg Z' mem lambda ev.
apply: (members_discrete (Z := twice_pencil (up Z)) (member := doubled) finite2 connected2 (r := r) _ _ _ (Z' := twice_pencil Z')) => //.
- by move=> z; rewrite eigenvalues2// bar_center orbb; apply: start.
- by move=> z re im; apply/regular2/reg.
- by exists Z'.
by rewrite eigenvalues2// ev.
Qed.
End Stable.

(* The kind: complex entries within real radii of real ones. *)
Section Kind.
Variables (n k : nat) (Z D : 'M[R]_(n + k)).
Notation regular within lambda := (forall Z', within Z' -> lambda *: block_mx 1%:M 0 0 0 - Z' \in unitmx).

Definition near (Z' : 'M[C]_(n + k)) := forall i j, `|Z' i j - inC (Z i j)| <= inC (D i j).
Hypothesis radii : forall i j, 0 <= D i j.
Hypothesis finite : forall Z', near Z' -> drsubmx Z' \in unitmx.

Lemma near_center : near (up Z).
Proof. by move=> i j; rewrite mxE subrr normr0 -(rmorph0 inC) inC_le radii. Qed.

Lemma near_mirrored Z' : near Z' -> near (bar Z').
Proof. by move=> mem i j; rewrite mxE -(conj_inC (Z i j)) -rmorphB norm_conjC. Qed.

Lemma near_connected Z' t : near Z' -> 0 <= t <= 1 -> near (up Z + inC t *: (Z' - up Z)).
Proof.
move=> mem /andP[t0 t1] i j; rewrite !mxE addrAC subrr add0r normrM inC_norm (ger0_norm t0).
apply: le_trans (mem i j); rewrite -[X in _ <= X]mul1r ler_wpmul2r//.
by rewrite -(rmorph1 inC) inC_le.
Qed.

(* box_stable with a disk *)
Theorem box_disk_continuous (b : R) (ps : seq C) : path <%R 0 ps ->
  (forall lambda, eigenvalue (loop_of (up Z)) lambda -> 'Re lambda < - inC b) ->
  segments (fun lambda => regular near lambda) (inC b) 0 ps ->
  forall Z', near Z' -> forall lambda, eigenvalue (loop_of Z') lambda -> 'Re lambda < - inC b.
Proof.
move=> rise start on; apply: (complex_continuous near_center finite near_mirrored near_connected start) => lambda re im.
exact: (upper_line (inC_real b) rise on re im).
Qed.

Theorem box_disk_discrete (r : R) (ps : seq C) : 0 < r -> path <%R 0 ps ->
  (forall lambda, eigenvalue (loop_of (up Z)) lambda -> `|lambda| < inC r) ->
  arcs (fun lambda => regular near lambda) (inC r) 0 ps ->
  forall Z', near Z' -> forall lambda, eigenvalue (loop_of Z') lambda -> `|lambda| < inC r.
Proof.
move=> r0 rise start on; have cr : 0 < inC r :> C by rewrite -(rmorph0 inC) inC_lt.
apply: (complex_discrete near_center finite near_mirrored near_connected r0 start) => lambda edge im.
exact: (upper_half cr rise on edge im).
Qed.
End Kind.
End Double.

(* The two signals of a port: v is the mean of y, what the port is computed from, and of what everybody reads, v + w/2;
   w = delta v is what is added.  They exist for every delta of the disk, and multiply the port by one number. *)
Section Port.
Variables (F : numFieldType) (alpha delta : F).
Hypotheses (small : alpha < 2%:R) (inside : `|delta| <= alpha).

Lemma side_pos : 1 - delta / 2%:R != 0.
Proof.
rewrite subr_eq0; apply/negP => /eqP e; have : `|delta / 2%:R| < 1.
  by rewrite normrM normfV normr_nat ltr_pdivr_mulr ?ltr0n// mul1r (le_lt_trans inside).
by rewrite -e normr1 ltxx.
Qed.

Theorem disk_loop (y v w : F) : v = y + w / 2%:R -> w = delta * v ->
  v + w / 2%:R = (1 + delta / 2%:R) / (1 - delta / 2%:R) * y.
Proof.
move=> ev ew; have ey : y = (1 - delta / 2%:R) * v.
  by rewrite mulrBl mul1r mulrAC -ew ev addrK.
by rewrite ey mulrA divfK ?side_pos// mulrDl mul1r mulrAC -ew.
Qed.

(* What a port is multiplied by at most. *)
Theorem disk_reads : `|(1 + delta / 2%:R) / (1 - delta / 2%:R)| <= (1 + alpha / 2%:R) / (1 - alpha / 2%:R).
Proof.
have two : (0 : F) < 2%:R by rewrite ltr0n.
have half : `|delta / 2%:R| <= alpha / 2%:R by rewrite normrM normfV normr_nat ler_pmul2r ?invr_gt0.
have below : 0 < 1 - alpha / 2%:R by rewrite subr_gt0 ltr_pdivr_mulr// mul1r.
have low : 1 - alpha / 2%:R <= `|1 - delta / 2%:R|.
  by rewrite ler_subl_addr (le_trans _ (ler_add (lexx _) half))// -{1}(normr1 F) -{1}[1](subrK (delta / 2%:R)) ler_norm_add.
have high : `|1 + delta / 2%:R| <= 1 + alpha / 2%:R.
  by rewrite (le_trans (ler_norm_add _ _))// normr1 ler_add2l.
rewrite normrM normfV ler_pmul ?invr_ge0// lef_pinv ?posrE//; exact: lt_le_trans low.
Qed.
End Port.
