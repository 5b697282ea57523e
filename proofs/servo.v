(* checker/constructions.py: regulated outputs, plants with integrators of these, and plants at the samples whose
   inputs are applied some steps late.

   Agent i measures y_i = C_i x and holds S_i y_i at set-points.  `regulated` has S_i y_i in place of y_i; `servo`
   has the state (x, w), w' = S y, in discrete time w(t+1) = w + S y: with e = 0 or e = 1, w changes to e w + S y,
   and agent i measures w_i and y_i.  `registered` has the inputs of the last d steps as further states. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability dynamic_controllers sampling.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Construction `regulated`: S_i y_i in place of y_i. *)
Section Regulated.
Variables (R : ringType) (n m : nat) (p q k : 'I_m -> nat) (X : multichannel R n p q).
Variable S : forall i, 'M[R]_(k i, q i).

Definition regulated : multichannel R n p k :=
  Multichannel (mcA X) (mcB X) (fun i => S i *m mcC X i).

(* Whoever feeds S_i y_i back feeds y_i back. *)
Theorem regulated_loop (F : gains R p k) :
  closed_loop regulated F = closed_loop X (fun i => F i *m S i).
Proof. by congr (_ + _); apply: eq_bigr => i _; rewrite /= !mulmxA. Qed.
End Regulated.

Theorem regulated_fixed (L : fieldType) n m (p q k : 'I_m -> nat) (X : multichannel L n p q)
    (S : forall i, 'M[L]_(k i, q i)) lambda : fixed X lambda -> fixed (regulated X S) lambda.
Proof. by move=> h F; rewrite regulated_loop; apply: h. Qed.

(* Construction `servo`; w is the stack of all w_i. *)
Section Servo.
Variables (R : ringType) (n m : nat) (p q k : 'I_m -> nat) (X : multichannel R n p q).
Variables (S : forall i, 'M[R]_(k i, q i)) (e : R).
Notation sum_k := (\sum_i k i)%N.

Definition selected : 'M[R]_(sum_k, n) := \mxcol_i (S i *m mcC X i).

Definition servo : multichannel R (n + sum_k) p (fun i => k i + q i)%N :=
  Multichannel (block_mx (mcA X) 0 selected e%:M)
    (fun i => col_mx (mcB X i) 0)
    (fun i => col_mx (row_mx 0 (submxcol 1%:M i)) (row_mx (mcC X i) 0)).

Definition integral (K : forall i, 'M[R]_(p i, k i)) (F : gains R p q) : controllers R p q k :=
  Controllers F K S (fun i => e%:M).

Lemma sum_row_mx a b c (M : 'I_m -> 'M[R]_(a, b)) (N : 'I_m -> 'M[R]_(a, c)) :
  \sum_i row_mx (M i) (N i) = row_mx (\sum_i M i) (\sum_i N i).
Proof.
by apply: (big_rec3 (fun x y z => x = row_mx y z)) => [|i x y z _ ->]; rewrite ?row_mx0 ?add_row_mx.
Qed.

Lemma sum_col_mx0 a b c (M : 'I_m -> 'M[R]_(a, c)) :
  \sum_i col_mx (M i) 0 = col_mx (\sum_i M i) 0 :> 'M_(a + b, c).
Proof.
apply: (big_rec2 (fun x y => x = col_mx y 0)) => [|i x y _ ->]; first by rewrite col_mx0.
by rewrite add_col_mx addr0.
Qed.

(* Gains (K_i, F_i) from (w_i, y_i) are the controllers w_i' = e w_i + S_i y_i, u_i = K_i w_i + F_i y_i of the plant. *)
Theorem servo_loop (K : forall i, 'M[R]_(p i, k i)) (F : gains R p q) :
  closed_loop servo (fun i => row_mx (K i) (F i)) = dynamic_loop X (integral K F).
Proof.
rewrite /closed_loop /dynamic_loop /=.
have fed i : col_mx (mcB X i) 0 *m row_mx (K i) (F i) *m
    col_mx (row_mx 0 (submxcol 1%:M i)) (row_mx (mcC X i) 0) =
    col_mx (row_mx (mcB X i *m F i *m mcC X i) (mcB X i *m K i *m submxcol 1%:M i)) 0 :> 'M_(n + sum_k).
  rewrite mul_col_mx mul_col_mx !mul0mx; congr col_mx.
  by rewrite mul_mx_row mul_row_col !mul_mx_row !mulmx0 add_row_mx add0r addr0.
rewrite (eq_bigr _ (fun i _ => fed i)) sum_col_mx0 sum_row_mx mxdiagZ /block_mx.
rewrite add_col_mx addr0 add_row_mx add0r; congr (col_mx (row_mx _ _) _).
by rewrite -mul_mxrow_mxcol submxcolK mulmx1.
Qed.

(* Where plant and integrators stand still, S_i y_i is at its set-point r_i, whatever the inputs are. *)
Theorem servo_equilibrium (x : 'cV[R]_n) (w r : 'cV[R]_sum_k) (u : 'cV[R]_(\sum_i p i)) :
  col_mx (mcA X *m x + inputs X setT *m u) (selected *m x + e *: w - r) = col_mx (e *: x) (e *: w) ->
  forall i, S i *m (mcC X i *m x) = submxcol r i.
Proof.
move=> /eq_col_mx[_ h] i; have : selected *m x = r.
  by move: h; rewrite addrAC -[in RHS](add0r (e *: w)) => /addIr/eqP; rewrite subr_eq0 => /eqP.
by move=> <-; rewrite /selected mxcol_mul mxcolK mulmxA.
Qed.
End Servo.

Section Solvable.
Variables (L : fieldType) (n m : nat) (p q k : 'I_m -> nat) (X : multichannel L n p q).
Variables (S : forall i, 'M[L]_(k i, q i)) (e : L).
Notation sum_k := (\sum_i k i)%N.

(* Fixed modes of the plant are fixed where outputs are integrated. *)
Theorem servo_fixed lambda : fixed X lambda -> fixed (servo X S e) lambda.
Proof.
move=> h G; have := fixed_dynamic h (integral S e (fun i => lsubmx (G i)) (fun i => rsubmx (G i))).
rewrite -servo_loop; congr (eigenvalue _ lambda); congr (_ + _); apply: eq_bigr => i _.
by rewrite hsubmxK.
Qed.

(* One loop without the mode e is a proof that the rows of [A - e, B; S C, 0] are independent, so that every
   set-point and every constant disturbance has an equilibrium. *)
Theorem servo_solvable : ~ fixed (servo X S e) e ->
  row_free (block_mx (mcA X - e%:M) (inputs X setT) (selected X S) (0 : 'M_(sum_k, \sum_i p i))).
Proof.
move=> h; rewrite -kermx_eq0; apply/rowV0P => w /sub_kermxP z; apply/eqP; apply: contra_notT h => nw G.
apply/eigenvalueP; exists w => //; move: nw z; rewrite -[w]hsubmxK; set w1 := lsubmx w; set w2 := rsubmx w => _.
rewrite mul_row_block mulmx0 addr0 -(row_mx0 _ 1 n) => /eq_row_mx[wA wB].
have wBi i : w1 *m mcB X i = 0.
  have := congr1 (fun M => submxrow M i) wB; rewrite /inputs -mul_submxrow mxrowK in_setT submxrow0.
  by [].
rewrite /closed_loop mulmxDr mulmx_sumr [X in _ + X]big1 => [|i _]; last first.
  by rewrite /= mul_col_mx mul0mx mul_col_mx mul0mx mul_row_col mulmx0 addr0 !mulmxA wBi !mul0mx.
rewrite addr0 /= mul_row_block mulmx0 add0r mul_mx_scalar scale_row_mx; congr row_mx.
by apply/eqP; rewrite -subr_eq0 addrAC -mul_mx_scalar -mulmxBr wA.
Qed.

(* Then every set-point r with every constant disturbance d has an equilibrium x with some inputs u. *)
Theorem solvable_equilibrium (d : 'cV[L]_n) (r : 'cV[L]_sum_k) :
  row_free (block_mx (mcA X - e%:M) (inputs X setT) (selected X S) (0 : 'M_(sum_k, \sum_i p i))) ->
  exists x u, mcA X *m x + inputs X setT *m u + d = e *: x /\ selected X S *m x = r.
Proof.
move=> /row_freeP[N e1]; set M := block_mx _ _ _ _ in e1.
pose z := N *m col_mx (- d) r; have : M *m z = col_mx (- d) r by rewrite /z mulmxA e1 mul1mx.
exists (usubmx z), (dsubmx z); move: H; rewrite -{1}[z]vsubmxK /M mul_block_col mul0mx addr0.
move/eq_col_mx => [ez ->]; split => //; move: (congr1 (+%R^~ d) ez).
rewrite /= addNr mulmxBl mul_scalar_mx => h; apply/eqP; rewrite -subr_eq0 -h.
by apply/eqP; rewrite [LHS]addrAC; congr (_ + _); apply: addrAC.
Qed.
End Solvable.

(* Construction `sampled`: registers of the inputs that are not applied yet. *)
Section Registers.
Variables (R : ringType) (n b : nat) (A : 'M[R]_n) (B : 'M[R]_(n, b)).

Definition states d := iter d (addn^~ b) n.

(* State (x, v_1, ..., v_d): x changes to A x + B v_1, v_k to v_(k+1), and v_d to u. *)
Fixpoint registered d : 'M[R]_(states d) * 'M[R]_(states d, b) :=
  if d is d'.+1 then
    (block_mx (registered d').1 (registered d').2 0 0, col_mx 0 1%:M)
  else (A, B).

Fixpoint plant_part d : 'M[R]_(n, states d) := if d is d'.+1 then row_mx (plant_part d') 0 else 1%:M.

(* What agents give at t acts at t + d. *)
Theorem registered_late d (s : nat -> 'cV[R]_(states d)) (u : nat -> 'cV[R]_b) :
  (forall t, s t.+1 = (registered d).1 *m s t + (registered d).2 *m u t) ->
  forall t, plant_part d *m s (t + d).+1 = A *m (plant_part d *m s (t + d)%N) + B *m u t.
Proof.
elim: d s u => [|d IH] s u h t; first by rewrite !addn0 !mul1mx; apply: h.
pose x t := usubmx (s t); pose v t := dsubmx (s t).
have part t' : plant_part d.+1 *m s t' = plant_part d *m x t'.
  by rewrite -[s t']vsubmxK /= mul_row_col mul0mx addr0.
have step t' : s t'.+1 = col_mx ((registered d).1 *m x t' + (registered d).2 *m v t') (u t').
  rewrite h -{1}[s t']vsubmxK /= mul_block_col !mul0mx addr0 mul_col_mx mul0mx mul1mx add_col_mx.
  by rewrite addr0 add0r.
have xs t' : x t'.+1 = (registered d).1 *m x t' + (registered d).2 *m v t' by rewrite /x step col_mxKu.
have vs t' : v t'.+1 = u t' by rewrite /v step col_mxKd.
rewrite !part addnS -addSn -vs; exact: (IH x v xs t.+1).
Qed.
End Registers.

(* Radii: entries of registers are certain. *)
Section Radii.
Variables (R : realFieldType) (n b : nat).

Fixpoint uncertain d (D : 'M[R]_n) (E : 'M[R]_(n, b)) : 'M[R]_(states n b d) * 'M[R]_(states n b d, b) :=
  if d is d'.+1 then (block_mx (uncertain d' D E).1 (uncertain d' D E).2 0 0, 0) else (D, E).

Lemma within_block a c a' c' (M : 'M[R]_(a, a')) (N : 'M[R]_(a, c')) (M' : 'M[R]_(a, a')) (N' : 'M[R]_(a, c')) :
  within M M' -> within N N' -> within (block_mx M N 0 (0 : 'M_(c, c'))) (block_mx M' N' 0 0).
Proof.
move=> hM hN i j; rewrite !mxE; case: split => i'; rewrite !mxE; case: split => j'; rewrite ?mxE ?normr0 //.
Qed.

Theorem registered_within d (A A' D : 'M[R]_n) (B B' E : 'M[R]_(n, b)) :
  within (A' - A) D -> within (B' - B) E ->
  within ((registered A' B' d).1 - (registered A B d).1) (uncertain d D E).1 /\
  within ((registered A' B' d).2 - (registered A B d).2) (uncertain d D E).2.
Proof.
move=> hA hB; elim: d => [//|d [IHA IHB]] /=; split; last by rewrite subrr => i j; rewrite !mxE normr0.
by rewrite opp_block_mx add_block_mx !oppr0 !addr0; apply: within_block.
Qed.

(* The regulated rows of a member, and with them its integrators. *)
Theorem selected_within k q (S : 'M[R]_(k, q)) (C C' E : 'M[R]_(q, n)) :
  within (C' - C) E -> within (S *m C' - S *m C) (map_mx (fun x : R => `|x|) S *m E).
Proof. by rewrite -mulmxBr => h; apply: within_mul => //; apply: within_moduli. Qed.
End Radii.
