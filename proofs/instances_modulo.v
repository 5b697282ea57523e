(* Two states that grow alike: the input moves their difference alone, and the output shows it alone. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import modulo.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Notation one := (1%:M : 'M[rat]_1).
Definition A : 'M[rat]_(1 + 1) := 1%:M.
Definition B : 'M[rat]_(1 + 1, 1) := col_mx one (- one).
Definition C : 'M[rat]_(1, 1 + 1) := row_mx one (- one).
Definition W : 'M[rat]_(1, 1 + 1) := row_mx one one.
Definition U : 'M[rat]_(1 + 1, 1) := col_mx one 0.
Definition R : 'M[rat]_(1 + 1, 1) := col_mx 0 one.

Lemma pivots : W *m U = 1%:M.
Proof. by rewrite mul_row_col mulmx0 addr0 mul1mx. Qed.
Lemma others : R^T *m R = 1%:M.
Proof. by rewrite tr_col_mx mul_row_col mulmx0 add0r trmx1 mul1mx. Qed.
Lemma apart : R^T *m U = 0.
Proof. by rewrite tr_col_mx mul_row_col mulmx0 addr0 trmx0 mul0mx. Qed.
Lemma together : U *m U^T + R *m R^T = 1%:M.
Proof.
rewrite !tr_col_mx !mul_col_row !(mulmx0, mul0mx, trmx0, trmx1, mul1mx) add_block_mx.
by rewrite !addr0 add0r -scalar_mx_block.
Qed.
Lemma invariant : W *m A = one *m W.
Proof. by rewrite mulmx1 mul1mx. Qed.
Lemma invariant_tr : W *m A^T = one *m W.
Proof. by rewrite trmx1 mulmx1 mul1mx. Qed.
Lemma unmoved : W *m B = 0.
Proof. by rewrite mul_row_col !mul1mx subrr. Qed.
Lemma unseen : W *m C^T = 0.
Proof. by rewrite tr_row_mx linearN /= trmx1 mul_row_col !mul1mx subrr. Qed.

Notation S := (R - U *m (W *m R)).
Definition inst_uncontrollable_part (F : 'M[rat]_1) :
    char_poly (A + B *m F *m C) = char_poly one * char_poly (R^T *m A *m S + R^T *m B *m F *m (C *m S)) :=
  uncontrollable_part C pivots others apart together invariant unmoved F erefl.
Definition inst_uncontrollable_loop (G H J L : 'M[rat]_1) :
    char_poly (block_mx (A + B *m G *m C) (B *m H) (J *m C) L) = char_poly one *
    char_poly (block_mx (R^T *m A *m S + R^T *m B *m G *m (C *m S)) (R^T *m B *m H) (J *m (C *m S)) L) :=
  uncontrollable_loop C pivots others apart together invariant unmoved G H J L erefl.
Definition inst_unobservable_part (F : 'M[rat]_1) :
    char_poly (A + B *m F *m C) = char_poly one * char_poly (S^T *m A *m R + S^T *m B *m F *m (C *m R)) :=
  unobservable_part B pivots others apart together invariant_tr unseen F erefl.
Definition inst_unobservable_loop (G H J L : 'M[rat]_1) :
    char_poly (block_mx (A + B *m G *m C) (B *m H) (J *m C) L) = char_poly one *
    char_poly (block_mx (S^T *m A *m R + S^T *m B *m G *m (C *m R)) (S^T *m B *m H) (J *m (C *m R)) L) :=
  unobservable_loop B pivots others apart together invariant_tr unseen G H J L erefl.
