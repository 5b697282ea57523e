(* checker/discs.py: squares that are cut into four cover a disc, and of two conjugate points one is enough. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Cells.
Variable C : numClosedFieldType.
Implicit Types (c h r z : C).

(* The square of half the side h around c. *)
Definition square c h z := `|'Re (z - c)| <= h /\ `|'Im (z - c)| <= h.

Theorem disc_in_square c r z : `|z - c| <= r -> square c r z.
Proof.
move=> zr; have [re _] := leif_normC_Re_Creal (z - c); split; first exact: le_trans zr.
apply: le_trans zr; have [im _] := leif_normC_Re_Creal ('i * (z - c)).
by move: im; rewrite normrM normCi mul1r mulrC ReMir normrN.
Qed.

(* One of the two halves of an interval. *)
Lemma half_of (x h : C) : x \is Num.real -> `|x| <= h -> exists2 e : C, e = 1 \/ e = -1 & `|x - e * (h / 2%:R)| <= h / 2%:R.
Proof.
move=> rx xh; have rh : h \is Num.real by rewrite ger0_real ?(le_trans _ xh).
have r2 : h / 2%:R \is Num.real by rewrite rpred_div ?realn.
have := xh; rewrite real_ler_norml// => /andP[low up].
have [pos|neg] := real_leP (real0 C) rx.
  exists 1; first by left.
  rewrite mul1r real_ler_norml ?rpredB// ler_subr_addr addNr pos /=.
  by rewrite ler_subl_addr -splitr.
exists (-1); first by right.
rewrite mulN1r opprK real_ler_norml ?rpredD//; apply/andP; split; last by rewrite ger_addr ltW.
by rewrite -ler_subl_addr -opprD -splitr.
Qed.

Theorem four_parts c h z : square c h z ->
  exists e f : C, [/\ e = 1 \/ e = -1, f = 1 \/ f = -1 & square (c + (e + 'i * f) * (h / 2%:R)) (h / 2%:R) z].
Proof.
move=> [re im]; have [e he e2] := half_of (Creal_Re _) re; have [f hf f2] := half_of (Creal_Im _) im.
exists e, f; split=> //; have rh : h / 2%:R \is Num.real by rewrite ger0_real ?(le_trans _ e2).
have [rre rf] : e * (h / 2%:R) \is Num.real /\ f * (h / 2%:R) \is Num.real.
  by split; apply: rpredM => //; [case: he|case: hf] => ->; rewrite ?rpredN rpred1.
rewrite /square opprD addrA mulrDl -mulrA.
by split; rewrite raddfB /= ?(Re_rect rre rf) ?(Im_rect rre rf).
Qed.

(* A tree of cells: a leaf is proved as a whole, another node by its four parts. *)
Inductive covered (P : C -> Prop) : C -> C -> Prop :=
| Leaf c h : (forall z, square c h z -> P z) -> covered P c h
| Cut c h : (forall e f : C, e = 1 \/ e = -1 -> f = 1 \/ f = -1 ->
    covered P (c + (e + 'i * f) * (h / 2%:R)) (h / 2%:R)) -> covered P c h.

Theorem cover P c h z : covered P c h -> square c h z -> P z.
Proof.
move=> cov; elim: cov z => {c h} [c h leaf|c h _ IH] z sq; first exact: leaf.
by have [e [f [he hf part]]] := four_parts sq; apply: IH part.
Qed.

(* A disc, cut at once. *)
Theorem cover_disc P c r z : covered P c r -> `|z - c| <= r -> P z.
Proof. by move=> cov /disc_in_square; apply: cover. Qed.

(* What is fixed for a real system comes in conjugate pairs. *)
Variables (n m : nat) (p q : 'I_m -> nat) (S : multichannel C n p q).
Definition real_entries a b (M : 'M[C]_(a, b)) := map_mx conjC M = M.
Hypotheses (rA : real_entries (mcA S)) (rB : forall i, real_entries (mcB S i)) (rC : forall i, real_entries (mcC S i)).

Theorem conjugate_fixed lambda : fixed S lambda -> fixed S lambda^*.
Proof.
move=> fix_ F; pose G i := map_mx conjC (F i).
have -> : closed_loop S F = map_mx conjC (closed_loop S G).
  rewrite /closed_loop map_mxD rA raddf_sum /=; congr (_ + _); apply: eq_bigr => i _.
  rewrite !map_mxM /= rB rC; congr (_ *m _ *m _); apply/matrixP => a b; rewrite !mxE conjCK//.
rewrite eigenvalue_map; exact: fix_.
Qed.

(* So does the rank of [lambda I - A, B] for real A and B. *)
Theorem conjugate_rank k (B : 'M[C]_(n, k)) lambda : real_entries B ->
  \rank (row_mx (lambda^*%:M - mcA S) B) = \rank (row_mx (lambda%:M - mcA S) B).
Proof.
move=> rB'; rewrite -[RHS](mxrank_map [rmorphism of conjC]) map_row_mx map_mxB map_scalar_mx /= rA rB'.
by [].
Qed.
End Cells.
