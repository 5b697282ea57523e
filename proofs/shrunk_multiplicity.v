(* A shrunk subspace of deficiency d for p: p^d divides det(xI - A_F) for all gains F, with the multiplicities
   that p has as a polynomial.  evidence.v says the same of ranks at one root. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Determinants.
Variable R : comRingType.

(* det(1 + X Y) = det(1 + Y X) *)
Lemma det_one_plus n r (X : 'M[R]_(n, r)) (Y : 'M_(r, n)) : \det (1%:M + X *m Y) = \det (1%:M + Y *m X).
Proof.
have e1 : block_mx 1%:M (- X) Y 1%:M = block_mx (1%:M + X *m Y) (- X) 0 1%:M *m block_mx 1%:M 0 Y 1%:M.
  by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r, addr0) mulNmx addrK.
have e2 : block_mx 1%:M (- X) Y 1%:M = block_mx 1%:M 0 Y 1%:M *m block_mx 1%:M (- X) 0 (1%:M + Y *m X).
  by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r, addr0) mulmxN [1%:M + _]addrC addKr.
have := congr1 determinant e1; rewrite e2 !det_mulmx !det_ublock det_lblock !det1 !mulr1 !mul1r.
by move=> ->.
Qed.

(* det(1 + t Z) is 1 modulo t. *)
Lemma det_near_one n (t : R) (Z : 'M[R]_n) : exists z, \det (1%:M + t *: Z) = 1 + z * t.
Proof.
pose q : {poly R} := \det (1%:M + 'X *: map_mx polyC Z).
have qE x : q.[x] = \det (1%:M + x *: Z).
  rewrite /q -[LHS]/(horner_eval x _) -det_map_mx map_mxD map_mx1 map_mxZ /= /horner_eval hornerX.
  by congr (\det (_ + _ *: _)); apply/matrixP=> i j; rewrite !mxE /= /horner_eval hornerC.
have /factor_theorem[q1 e] : root (q - 1) 0.
  by rewrite /root !hornerE qE scale0r addr0 det1 subrr.
by exists q1.[t]; rewrite -qE -[q](subrK 1) e subr0 !hornerE addrC.
Qed.
End Determinants.

Section Power.
Variable L : fieldType.
Notation P1 := {poly L}.
Variables (P : P1) (n r u d : nat) (M : 'M[P1]_n) (U W : 'M[P1]_(n, u)) (B : 'M[P1]_(n, r)) (V : 'M[P1]_(r, u)).
Variables (piv : 'I_u -> 'I_n) (Z : 'M[P1]_u).
Hypotheses (P0 : P != 0) (image : M *m U = B *m V + P *: W) (identity : rowsub piv U = 1%:M + P *: Z).
Hypothesis count : (r + d <= u)%N.

Let E : 'M[P1]_(u, n) := rowsub piv 1%:M.
Let I := E^T *m E.

Lemma pivots_orthonormal : ~~ (P %| 1) -> E *m E^T = 1%:M.
Proof.
move=> nP; apply/matrixP=> i j; rewrite -rowsubE !mxE.
have [->|ij] := eqVneq i j; first by rewrite eqxx.
case: eqVneq => // e; case/negP: nP; have /matrixP h := identity.
have := h i i; have := h j i; rewrite !mxE e eqxx eq_sym (negPf ij) add0r => -> ei.
have -> : 1 = P * (Z j i - Z i i) by rewrite mulrBr ei addrK.
exact: dvdp_mulr.
Qed.

(* M with P taken out of the columns at the pivots, up to multiples of the columns of B. *)
Lemma power_divides : P ^+ d %| \det M.
Proof.
have [P1|/pivots_orthonormal EE] := boolP (P %| 1).
  by apply: dvdp_trans (dvdp_exp2r d P1) _; rewrite expr1n dvd1p.
pose N := 1%:M + (U - E^T) *m E.
have [z detN] : exists z, \det N = 1 + z * P.
  have [z e] := det_near_one P Z; exists z; rewrite -e /N det_one_plus mulmxBr EE -rowsubE identity.
  by rewrite addrC subrK.
have copN : coprimep (P ^+ d) (\det N).
  by apply: coprimep_expl; rewrite detN addrC coprimep_addl_mul coprimep1.
rewrite -(Gauss_dvdpl _ copN) -det_mulmx.
have MN : M *m N = M *m (1%:M - I) + (P *: W) *m E + B *m (V *m E).
  rewrite /N mulmxDr mulmx1 mulmxBl mulmxBr !mulmxA image mulmxDl -!mulmxA -/I mulmxBr mulmx1.
  by rewrite addrA addrAC [X in _ + X]addrC addrA.
have EI : E *m I = E by rewrite mulmxA EE mul1mx.
have II : I *m I = I by rewrite -{1}/(E^T *m E) -mulmxA EI.
pose T := 1%:M + (P - 1) *: I; pose Y := M *m (1%:M - I) + W *m E.
have detT : \det T = P ^+ u.
  rewrite /T /I scalemxAl det_one_plus -scalemxAr EE scalemx1 -raddfD /= addrC subrK.
  by rewrite det_scalar.
have YT : Y *m T = M *m (1%:M - I) + (P *: W) *m E.
  rewrite /T mulmxDr mulmx1 -scalemxAr mulmxDl -!mulmxA mulmxBl mul1mx II subrr mulmx0 add0r EI.
  by rewrite scalerBl scale1r -addrA [W *m E + _]addrC subrK scalemxAl.
have VT : V *m E *m T = P *: (V *m E).
  by rewrite /T mulmxDr mulmx1 -scalemxAr -mulmxA EI scalerBl scale1r addrC subrK.
have e1 : P ^+ r * \det (M *m N) = \det (block_mx (Y *m T) (- B) (V *m E *m T) P%:M).
  have e : block_mx (Y *m T) (- B) (V *m E) 1%:M = block_mx (M *m N) (- B) 0 1%:M *m block_mx 1%:M 0 (V *m E) 1%:M.
    by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r, addr0) MN YT mulNmx addrK.
  have -> : block_mx (Y *m T) (- B) (V *m E *m T) P%:M = block_mx 1%:M 0 0 P%:M *m block_mx (Y *m T) (- B) (V *m E) 1%:M.
    by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r, addr0) VT mul_scalar_mx.
  by rewrite e !det_mulmx !det_ublock det_lblock !det1 !mulr1 mul1r det_scalar -det_mulmx.
have e2 : P ^+ r * \det (M *m N) = \det (block_mx Y (- B) (V *m E) P%:M) * P ^+ u.
  rewrite e1 -detT; have -> : block_mx (Y *m T) (- B) (V *m E *m T) P%:M = block_mx Y (- B) (V *m E) P%:M *m block_mx T 0 0 1%:M.
    by rewrite mulmx_block !(mulmx1, mulmx0, add0r, addr0).
  by rewrite det_mulmx det_ublock det1 mulr1.
have : P ^+ r * P ^+ d %| P ^+ r * \det (M *m N).
  by rewrite e2 -exprD dvdp_mull// dvdp_exp2l.
by rewrite dvdp_mul2l// expf_neq0.
Qed.
End Power.

Section Certificate.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Variables (P : {poly K}) (T : {set 'I_m}) (d : nat) (E : rank_loss S P T d).
Variables (L : fieldType) (f : {rmorphism K -> L}).
Notation up := (map_poly f).
Notation SL := (map_system f S).
Notation constant M := (map_mx polyC M).

Lemma multiple a b (M : 'M[{poly K}]_(a, b)) : zero_modulo P M -> exists W, map_mx up M = up P *: W.
Proof.
move=> z; exists (\matrix_(i, j) up (M i j %/ P)); apply/matrixP=> i j; rewrite !mxE -rmorphM /=.
by rewrite mulrC divpK.
Qed.

Lemma up_constant a b (M : 'M[K]_(a, b)) : map_mx up (constant M) = constant (map_mx f M).
Proof. by apply/matrixP=> i j; rewrite !mxE map_polyC. Qed.

(* Rule "shrunk subspace", with multiplicities: p^d divides det(xI - A_F) for all F over all extensions. *)
Theorem shrunk_subspace_divides (F : gains L p q) : P != 0 -> up P ^+ d %| char_poly (closed_loop SL F).
Proof.
move=> P0; pose U := map_mx up (rl_U E); pose V := map_mx up (rl_V E); pose Y := map_mx up (rl_Y E).
have [W state] := multiple (@rl_state _ _ _ _ _ _ _ _ _ E).
have [Z id] := multiple (@rl_identity _ _ _ _ _ _ _ _ _ E).
have out i : exists W, i \notin T -> constant (mcC SL i) *m U = up P *: W.
  have [|iT] := boolP (i \in T); first by exists 0.
  by have [W' e] := multiple (@rl_output _ _ _ _ _ _ _ _ _ E i iT); exists W' => _; rewrite -e map_mxM up_constant.
have [Wo output] := fin_all_exists out.
have inp i : exists XR, i \in T -> constant (mcB SL i) = Y *m XR.1 + up P *: XR.2.
  have [iT|_] := boolP (i \in T); last by exists (0, 0).
  have [X z] := @rl_inputs _ _ _ _ _ _ _ _ _ E i iT; have [R e] := multiple z; exists (map_mx up X, R) => _.
  by rewrite /= -e map_mxB map_mxM up_constant addrC subrK.
have [XR input] := fin_all_exists inp.
pose G i := constant (F i) *m constant (mcC SL i) *m U.
pose X := \sum_(i | i \in T) (XR i).1 *m G i.
pose W' := \sum_(i | i \in T) (XR i).2 *m G i + \sum_(i | i \notin T) constant (mcB SL i) *m constant (F i) *m Wo i.
have state' : ('X%:M - constant (mcA SL)) *m U = Y *m V + up P *: W.
  by rewrite -state map_mxB !map_mxM map_mxB map_scalar_mx /= map_polyX !up_constant [RHS]addrC subrK.
have loop : char_poly_mx (closed_loop SL F) *m U = Y *m (V - X) + up P *: (W - W').
  rewrite /char_poly_mx /closed_loop map_mxD map_mx_sum opprD addrA mulmxBl state' mulmxBr scalerBr.
  rewrite addrACA -opprD mulmx_suml [X in _ - X = _](bigID (mem T)) /=; congr (_ - _).
  rewrite /W' scalerDr addrA; congr (_ + _).
    rewrite /X mulmx_sumr scaler_sumr -big_split; apply: eq_bigr => i iT.
    by rewrite !map_mxM -!mulmxA input// mulmxDl -scalemxAl !mulmxA.
  rewrite scaler_sumr; apply: eq_bigr => i iT.
  by rewrite !map_mxM -!mulmxA output// -!scalemxAr.
rewrite /char_poly; apply: (@power_divides L (up P) n (rl_r E) (rl_u E) d _ U (W - W')
  Y (V - X) (@rl_pivots _ _ _ _ _ _ _ _ _ E) Z).
- by rewrite map_poly_eq0.
- exact: loop.
- by rewrite -id map_mxB map_mx1 map_mxsub addrC subrK.
exact: (@rl_count _ _ _ _ _ _ _ _ _ E).
Qed.
End Certificate.
