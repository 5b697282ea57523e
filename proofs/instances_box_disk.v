(* One state and one signal, x' = ax + w, w = 0, a a complex number within 1/2 of -1: regular between 0 and i/2 and beyond, so
   every member is stable; no states, on arcs; and the numbers by which a port is multiplied. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mcexact Require Import location crossing arcs box_stable box_disk instances_box_stable.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Instance.
Variable R : rcfType.
Notation C := [numClosedFieldType of complex R].
Notation inC := [rmorphism of real_complex R].
Notation half := (2%:R^-1 : R).
Notation quarter := (4%:R^-1 : R).
Notation Z0 := (center (-1 : R)).
Notation D0 := (@radii R).

Lemma near_members Z' : near Z0 D0 Z' -> exists2 x : C, `|x - inC (-1)| <= inC half & Z' = block_mx x%:M 0 0 (-1)%:M.
Proof.
move=> mem; have part i j : `|Z' i j - inC (Z0 i j)| <= inC (D0 i j) by exact: mem.
have same i j : D0 i j = 0 -> Z' i j = inC (Z0 i j).
  by move=> r0; apply/eqP; rewrite -subr_eq0 -normr_le0 (le_trans (part i j))// r0 rmorph0.
exists (Z' (lshift 1 0) (lshift 1 0)).
  by have := part (lshift 1 0) (lshift 1 0); rewrite !block_mxEul !mxE.
rewrite -[LHS]submxK; congr block_mx; apply/matrixP => i j; rewrite !ord1 !mxE ?eqxx //=.
- by rewrite same /center ?block_mxEur ?mxE ?rmorph0// /radii block_mxEur mxE.
- by rewrite same /center ?block_mxEdl ?mxE ?rmorph0// /radii block_mxEdl mxE.
by rewrite same /center ?block_mxEdr ?mxE ?eqxx ?rmorphN ?rmorph1// /radii block_mxEdr mxE.
Qed.

Lemma near_finite Z' : near Z0 D0 Z' -> drsubmx Z' \in unitmx.
Proof. by case/near_members => x _ ->; rewrite block_mxKdr unitmxE det_scalar1 unitrN1. Qed.

Lemma loop_one (F : comUnitRingType) (x : F) : loop_of (block_mx x%:M 0 0 (-1)%:M : 'M[F]_(1 + 1)) = x%:M.
Proof. by rewrite /loop_of block_mxKul block_mxKur !mul0mx subr0. Qed.

Lemma eigenvalue_one (F : fieldType) (x lambda : F) : eigenvalue (x%:M : 'M_1) lambda = (lambda == x).
Proof.
rewrite eigenvalue_root_char /char_poly /char_poly_mx map_scalar_mx /=.
by rewrite -raddfB det_scalar1 root_XsubC.
Qed.

Lemma near_regular (lambda : C) : - inC quarter <= 'Re lambda -> forall Z', near Z0 D0 Z' ->
  lambda *: block_mx 1%:M 0 0 0 - Z' \in unitmx.
Proof.
move=> re Z' mem; have u := near_finite mem; have [x small e] := near_members mem.
rewrite loop_eigenvalue// e loop_one eigenvalue_one; apply/eqP => same.
have [h _] := leif_normC_Re_Creal (x - inC (-1)).
have := le_trans h small; rewrite raddfB /= (Creal_ReP _ (inC_real (-1))) real_ler_norml ?rpredB ?Creal_Re ?inC_real//.
move=> /andP[_]; rewrite ler_subl_addr -rmorphD -same => up.
have := le_trans re up; rewrite -rmorphN inC_le leNgt => /negP; apply.
have one : half + half = 1 by rewrite -[half]div1r -splitr.
have -> : half + -1 = - half by rewrite -[X in _ + - X]one opprD addrA subrr sub0r.
rewrite ltr_oppl opprK.
by rewrite ltf_pinv ?posrE ?ltr0n// ltr_nat.
Qed.

Lemma near_border : segments (fun lambda : C => forall Z', near Z0 D0 Z' ->
  lambda *: block_mx 1%:M 0 0 0 - Z' \in unitmx) (inC 0) 0 [:: 2%:R^-1].
Proof.
split=> lambda.
  move=> close; apply: near_regular; rewrite rmorph0 !oppr0 !add0r addr0 in close.
  have [h _] := leif_normC_Re_Creal (lambda - 'i * (2%:R^-1 / 2%:R)).
  have := le_trans h close; rewrite raddfB /= ReMr ?rpred_div ?rpredV ?realn// Re_i mul0r subr0.
  rewrite real_ler_norml ?Creal_Re// => /andP[low _]; apply: le_trans low.
  by rewrite fmorphV rmorph_nat -invfM -natrM.
move=> re _; apply: near_regular; rewrite re rmorph0 oppr0 oppr_le0.
by rewrite -(rmorph0 inC) inC_le invr_ge0 ler0n.
Qed.

Lemma radii_pos i j : 0 <= D0 i j.
Proof.
case: (split_ordP i) => k ->; case: (split_ordP j) => l ->; rewrite ?ord1 /radii.
- by rewrite block_mxEul !mxE eqxx invr_ge0 ler0n.
- by rewrite block_mxEur !mxE.
- by rewrite block_mxEdl !mxE.
by rewrite block_mxEdr !mxE.
Qed.

Lemma near_start (lambda : C) : eigenvalue (loop_of (map_mx inC Z0)) lambda -> 'Re lambda < - inC 0.
Proof.
rewrite /center map_block_mx !map_scalar_mx !map_mx0.
have -> : inC (-1) = -1 :> C by rewrite rmorphN rmorph1.
rewrite loop_one eigenvalue_one => /eqP ->.
by rewrite raddfN /= (Creal_ReP _ (rpred1 _)) rmorph0 oppr0 ltrN10.
Qed.

Definition inst_box_disk_continuous := box_disk_continuous radii_pos near_finite (@rising R) near_start near_border.
Definition inst_complex_continuous := complex_continuous (near_center Z0 radii_pos) near_finite (@near_mirrored _ _ _ _ _)
  (@near_connected _ _ _ _ _) near_start.

(* No states, on arcs. *)
Notation N0 := (@nothing R).
Lemma near_nothing Z' : near N0 0 Z' -> Z' = map_mx inC N0.
Proof.
by move=> mem; apply/matrixP => i j; apply/eqP; rewrite -subr_eq0 -normr_le0 mxE (le_trans (mem i j))// mxE rmorph0.
Qed.

Lemma nothing_finite Z' : near N0 0 Z' -> drsubmx Z' \in unitmx.
Proof.
move/near_nothing ->; rewrite -map_drsubmx map_unitmx; apply: computed => i j.
by rewrite subrr normr0 mxE.
Qed.

Lemma near_around : arcs (fun lambda : C => forall Z', near N0 0 Z' ->
  lambda *: block_mx 1%:M 0 0 0 - Z' \in unitmx) (inC 1) 0 [:: 1; 2%:R].
Proof.
have reg (lambda : C) Z' : near N0 0 Z' -> lambda *: block_mx 1%:M 0 0 0 - Z' \in unitmx.
  move=> mem; rewrite loop_eigenvalue ?nothing_finite//; apply/negP => /eqP; case; apply/matrixP; case=> //.
by split=> [lambda _ Z'|]; [apply: reg|split=> lambda _ Z'; apply: reg].
Qed.

Lemma zero_pos i j : 0 <= (0 : 'M[R]_(0 + 1)) i j. Proof. by rewrite mxE. Qed.
Lemma rising_arcs : path.path <%R 0 [:: 1; 2%:R : C]. Proof. by rewrite /= ltr01 ltr1n. Qed.
Lemma nothing_start (lambda : C) : eigenvalue (loop_of (map_mx inC N0)) lambda -> `|lambda| < inC 1.
Proof. exact: out. Qed.
Definition inst_box_disk_discrete := box_disk_discrete zero_pos nothing_finite (@ltr01 R) rising_arcs nothing_start near_around.
Definition inst_complex_discrete := complex_discrete (near_center N0 zero_pos) nothing_finite (@near_mirrored _ _ _ _ _)
  (@near_connected _ _ _ _ _) (@ltr01 R) nothing_start.

(* delta = alpha = 1, y = 1: v = w = 2, and everybody reads 3. *)
Lemma below_two : (1 : C) < 2%:R. Proof. by rewrite ltr1n. Qed.
Lemma on_disk : `|1 : C| <= 1. Proof. by rewrite normr1. Qed.
Lemma mean : (2%:R : C) = 1 + 2%:R / 2%:R. Proof. by rewrite divff ?pnatr_eq0. Qed.
Definition inst_disk_loop := disk_loop below_two on_disk mean (esym (mul1r (2%:R : C))).
Definition inst_disk_reads := disk_reads below_two on_disk.
End Instance.
