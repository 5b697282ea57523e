(* checker/performance.py: kind `cost_bound`, a lower bound on the cost for every linear controller.

   The controller is z' = K z + L y, u = H z + D y of any order, y = Cy x + v; the cost is defined by the covariance of the
   loop as in performance.v.  No filter appears in the proof: S, put in the place of the plant's state (and of minus its
   output, beside the noise), satisfies the inequality of the loop's Lyapunov equation, and the loop is stable, so that the
   covariance of the loop is at least this matrix. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location stability instability positive_forms performance.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Bound.
Variable C : numClosedFieldType.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").

Lemma trace_around a b c (X : 'M[C]_(a, b)) (S : 'M_a) (Y : 'M_(a, c)) (Z : 'M_(c, b)) :
  \tr (X^H *m S *m Y *m Z) = \tr (S *m (Y *m Z *m X^H)).
Proof. by rewrite -!mulmxA mxtrace_mulC !mulmxA. Qed.

(* The first inequality, for the covariance T of the state and the input together. *)
Section First.
Variables (n p : nat) (A : 'M[C]_n) (B : 'M[C]_(n, p)) (Q P W S : 'M[C]_n) (R Rs : 'M[C]_p) (F : 'M[C]_(p, n)).
Hypotheses (pRs : psd Rs).
Local Notation wanted := (row_mx F (- 1%:M)).
Definition first_continuous := block_mx (P *m A + A^H *m P + Q) (P *m B) (B^H *m P) R - wanted^H *m Rs *m wanted.
Definition first_discrete :=
  block_mx (A^H *m P *m A + Q - P) (A^H *m P *m B) (B^H *m P *m A) (R + B^H *m P *m B) - wanted^H *m Rs *m wanted.

Local Notation on_x := (row_mx 1%:M 0 : 'M[C]_(n, n + p)).
Local Notation on_u := (row_mx 0 1%:M : 'M[C]_(p, n + p)).
Local Notation next := (row_mx A B).

Lemma first_continuousE :
  first_continuous = on_x^H *m P *m next + next^H *m P *m on_x + on_x^H *m Q *m on_x + on_u^H *m R *m on_u -
    wanted^H *m Rs *m wanted.
Proof.
rewrite /first_continuous; congr (_ - _); rewrite !adj_row !adj1 !adj0 !mul_col_mx !mul1mx !mul0mx.
rewrite !mul_mx_row !mulmx1 !mulmx0 /block_mx !add_col_mx !(addr0, add0r) !add_row_mx.
by rewrite !(addr0, add0r).
Qed.

Lemma first_discreteE :
  first_discrete = next^H *m P *m next - on_x^H *m P *m on_x + on_x^H *m Q *m on_x + on_u^H *m R *m on_u -
    wanted^H *m Rs *m wanted.
Proof.
rewrite /first_discrete; congr (_ - _); rewrite !adj_row !adj1 !adj0 !mul_col_mx !mul1mx !mul0mx.
rewrite !mul_mx_row !mulmx1 !mulmx0 /block_mx opp_col_mx !add_col_mx !(addr0, add0r, oppr0) opp_row_mx !add_row_mx.
by rewrite !(addr0, add0r, oppr0) [R + _]addrC addrAC.
Qed.

Variable T : 'M[C]_(n + p).
Hypotheses (pT : psd T) (better : psd (wanted *m T *m wanted^H - F *m S *m F^H)).

Lemma enough : \tr (P *m W) + \tr (Rs *m (wanted *m T *m wanted^H)) <=
    \tr (Q *m (on_x *m T *m on_x^H)) + \tr (R *m (on_u *m T *m on_u^H)) ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <=
    \tr (Q *m (on_x *m T *m on_x^H)) + \tr (R *m (on_u *m T *m on_u^H)).
Proof. by apply: le_trans; rewrite ler_add2l trace_around; apply: psd_trace_le. Qed.

Lemma bound_by_first_continuous : psd first_continuous ->
  next *m T *m on_x^H + on_x *m T *m next^H + W = 0 ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <=
    \tr (Q *m (on_x *m T *m on_x^H)) + \tr (R *m (on_u *m T *m on_u^H)).
Proof.
move=> p1 /eqP; rewrite addrC addr_eq0 => /eqP eW; apply: enough; have := psd_trace p1 pT.
rewrite first_continuousE !(mulmxDl, mulmxBl, mulNmx) !(mxtraceD, raddfN) /= !trace_around => le.
have -> : \tr (P *m W) = - (\tr (P *m (next *m T *m on_x^H)) + \tr (P *m (on_x *m T *m next^H))).
  by rewrite eW mulmxN mulmxDr raddfN /= mxtraceD.
by rewrite addrC ler_subl_addr addrC addrA -subr_ge0.
Qed.

Lemma bound_by_first_discrete : psd first_discrete ->
  on_x *m T *m on_x^H = next *m T *m next^H + W ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <=
    \tr (Q *m (on_x *m T *m on_x^H)) + \tr (R *m (on_u *m T *m on_u^H)).
Proof.
move=> p1 eW; apply: enough; have := psd_trace p1 pT.
rewrite first_discreteE !(mulmxDl, mulmxBl, mulNmx) !(mxtraceD, raddfN) /= !trace_around => le.
have -> : \tr (P *m W) = \tr (P *m (on_x *m T *m on_x^H)) - \tr (P *m (next *m T *m next^H)).
  by rewrite [in X in X - _]eW mulmxDr mxtraceD addrAC subrr add0r.
by rewrite addrC -opprB ler_subl_addr addrC addrA -subr_ge0.
Qed.
End First.

(* Any loop in continuous time: x M = A x + B u; J puts an error of the plant's state, of which the controller knows
   nothing, into the loop. *)
Section Core.
Variables (N n p : nat) (M X I : 'M[C]_N) (x : 'M[C]_(n, N)) (u : 'M[C]_(p, N)) (J : 'M[C]_(N, n)).
Variables (A : 'M[C]_n) (B : 'M[C]_(n, p)) (Q P W S : 'M[C]_n) (R Rs : 'M[C]_p) (F : 'M[C]_(p, n)).
Hypotheses (hS : S^H = S) (pRs : psd Rs) (st : stable_continuous M) (pI : psd I).
Hypotheses (xM : x *m M = A *m x + B *m u) (xJ : x *m J = 1%:M) (uJ : u *m J = 0) (xI : x *m I *m x^H = W).

Lemma above_continuous : M *m X + X *m M^H + I = 0 ->
  psd (M *m J *m S *m J^H + J *m S *m (M *m J)^H + I) -> psd X /\ psd (X - J *m S *m J^H).
Proof.
move=> eX p2; have [Z [_ pZ /(_ X eX) XZ]] := covariance_continuous st pI; rewrite -XZ in pZ.
split=> //; apply: (comparison_continuous st); first by rewrite adjB !adjM adjK hS mulmxA (psd_adj pZ).
have eI : I = - flow M X by apply/eqP; rewrite -addr_eq0 addrC -/(flow M X) in eX *; rewrite eX.
rewrite -/(flow M _) raddfB /= opprB -eI; move: p2; congr psd; congr (_ + _).
by rewrite /flow adjM !mulmxA.
Qed.

Lemma core_continuous : M *m X + X *m M^H + I = 0 ->
  psd (first_continuous A B Q P R Rs F) -> psd (M *m J *m S *m J^H + J *m S *m (M *m J)^H + I) ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <= \tr (Q *m (x *m X *m x^H)) + \tr (R *m (u *m X *m u^H)).
Proof.
move=> eX p1 /(above_continuous eX)[pX above]; pose Z := col_mx x u; pose T := Z *m X *m Z^H.
have at_x : row_mx 1%:M 0 *m Z = x by rewrite mul_row_col mul1mx mul0mx addr0.
have at_u : row_mx 0 1%:M *m Z = u by rewrite mul_row_col mul1mx mul0mx add0r.
have at_next : row_mx A B *m Z = x *m M by rewrite mul_row_col xM.
have two a b (Y : 'M[C]_(a, n + p)) (Y' : 'M[C]_(b, n + p)) : Y *m T *m Y'^H = (Y *m Z) *m X *m (Y' *m Z)^H.
  by rewrite /T adjM !mulmxA.
have -> : x *m X *m x^H = row_mx 1%:M 0 *m T *m (row_mx 1%:M 0)^H by rewrite two at_x.
have -> : u *m X *m u^H = row_mx 0 1%:M *m T *m (row_mx 0 1%:M)^H by rewrite two at_u.
apply: (@bound_by_first_continuous _ _ A B) => //; first by apply: psd_of.
  rewrite two; set Y := _ *m Z; have eY : Y *m J = F by rewrite /Y mul_row_col mulmxDl -!mulmxA xJ uJ !mulmx0 addr0 mulmx1.
  have -> : Y *m X *m Y^H - F *m S *m F^H = Y *m (X - J *m S *m J^H) *m Y^H.
    by rewrite mulmxBr mulmxBl -{1 2}eY adjM !mulmxA.
  exact: psd_of.
have -> : row_mx A B *m T *m (row_mx 1%:M 0)^H + row_mx 1%:M 0 *m T *m (row_mx A B)^H + W =
    x *m (M *m X + X *m M^H + I) *m x^H.
  by rewrite !two at_next at_x -xI !mulmxDr !mulmxDl adjM !mulmxA.
by rewrite eX mulmx0 mul0mx.
Qed.
End Core.

Section Loops.
Variables (n p q k : nat) (A : 'M[C]_n) (B : 'M[C]_(n, p)) (Cy : 'M[C]_(q, n)).
Variables (K : 'M[C]_k) (L : 'M[C]_(k, q)) (H : 'M[C]_(p, k)) (D : 'M[C]_(p, q)).
Variables (Q W : 'M[C]_n) (R : 'M[C]_p) (V : 'M[C]_q) (P S : 'M[C]_n) (Rs : 'M[C]_p) (F : 'M[C]_(p, n)) (omega : C).
Hypotheses (pW : psd W) (pV : psd V) (hS : S^H = S) (pRs : psd Rs).

Lemma psd_corner a b (Y : 'M[C]_a) : psd Y -> psd (block_mx Y 0 0 (0 : 'M_b)).
Proof.
move=> pY; have -> : block_mx Y 0 0 (0 : 'M_b) = col_mx 1%:M 0 *m Y *m (col_mx 1%:M 0)^H.
  by rewrite adj_col adj1 adj0 mul_col_mx mul1mx mul0mx mul_col_row !mulmx1 !mulmx0.
exact: psd_of.
Qed.

Lemma psd_blocks a b (Y : 'M[C]_a) (Z : 'M[C]_b) : psd Y -> psd Z -> psd (block_mx Y 0 0 Z).
Proof.
move=> pY pZ x; rewrite -[x]vsubmxK; have := form_block 0 (usubmx x) (dsubmx x) (psd_adj pY) (psd_adj pZ).
by rewrite adj0 => ->; rewrite mulmx0 mul0mx mxE conjC0 !addr0 addr_ge0.
Qed.

(* Continuous time without a bandwidth: v is white, and u does not depend on y at once. *)
Definition loop_proper : 'M[C]_(n + k) := block_mx A (B *m H) (L *m Cy) K.
Definition noise_proper := block_mx W 0 0 (L *m V *m L^H).
Definition state_proper : 'M[C]_(n, n + k) := row_mx 1%:M 0.
Definition inputs_proper : 'M[C]_(p, n + k) := row_mx 0 H.
Definition second_proper := block_mx (A *m S + S *m A^H + W) (S *m Cy^H) (Cy *m S) V.

Theorem bound_proper X : stable_continuous loop_proper ->
  loop_proper *m X + X *m loop_proper^H + noise_proper = 0 ->
  psd (first_continuous A B Q P R Rs F) -> psd second_proper ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <=
  \tr (Q *m (state_proper *m X *m state_proper^H)) + \tr (R *m (inputs_proper *m X *m inputs_proper^H)).
Proof.
move=> st eX p1 p2; pose x := state_proper; pose u := inputs_proper.
have eJ : loop_proper *m col_mx 1%:M 0 = col_mx A (L *m Cy) :> 'M_(n + k, n).
  by rewrite /loop_proper mul_block_col !mulmx1 !mulmx0 !addr0.
apply: (core_continuous hS pRs st _ (x := x) (u := u) (J := col_mx 1%:M 0) (B := B) _ _ _ _ eX p1).
- apply: psd_blocks => //; exact: psd_of.
- by rewrite /loop_proper mul_row_block !mul_mx_row add_row_mx !mulmx0 !mul0mx !mul1mx mulmx1 !addr0 add0r.
- by rewrite /x /state_proper mul_row_col mul1mx mul0mx addr0.
- by rewrite /u /inputs_proper mul_row_col mul0mx mulmx0 addr0.
- by rewrite /noise_proper /x /state_proper mul_row_block adj_row adj1 adj0 mul_row_col !mul0mx !mul1mx !mulmx0 !addr0 mulmx1.
have -> : loop_proper *m col_mx 1%:M 0 *m S *m (col_mx 1%:M 0)^H + col_mx 1%:M 0 *m S *m (loop_proper *m col_mx 1%:M 0)^H +
    noise_proper = block_mx 1%:M 0 0 L *m second_proper *m (block_mx 1%:M 0 0 L)^H.
  rewrite eJ adj_block !adj_col adj1 !adj0 !mulmx_block !mul_col_mx !mul_mx_row /block_mx !add_col_mx !add_row_mx.
  by rewrite !(mul0mx, mulmx0, mul1mx, mulmx1, addr0, add0r) adjM !mulmxA.
exact: psd_of.
Qed.

(* Continuous time with v' = - omega v + omega n, n of intensity V: v is beside x. *)
Definition loop_filtered : 'M[C]_(n + q + k) :=
  block_mx (block_mx (A + B *m D *m Cy) (B *m D) 0 (- omega%:M)) (col_mx (B *m H) 0) (row_mx (L *m Cy) L) K.
Definition noise_filtered : 'M[C]_(n + q + k) := block_mx (block_mx W 0 0 (omega ^+ 2 *: V)) 0 0 0.
Definition state_filtered : 'M[C]_(n, n + q + k) := row_mx (row_mx 1%:M 0) 0.
Definition inputs_filtered : 'M[C]_(p, n + q + k) := row_mx (row_mx (D *m Cy) D) H.
Definition second_filtered := let Y := S *m Cy^H - omega^-1 *: (A *m S *m Cy^H) in
  block_mx (A *m S + S *m A^H + W) Y Y^H (V - (2%:R / omega) *: (Cy *m S *m Cy^H)).

Theorem bound_continuous X : 0 < omega -> stable_continuous loop_filtered ->
  loop_filtered *m X + X *m loop_filtered^H + noise_filtered = 0 ->
  psd (first_continuous A B Q P R Rs F) -> psd second_filtered ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <=
  \tr (Q *m (state_filtered *m X *m state_filtered^H)) + \tr (R *m (inputs_filtered *m X *m inputs_filtered^H)).
Proof.
move=> o0 st eX p1 p2; pose x := state_filtered; pose u := inputs_filtered; have ro : omega^* = omega by apply/CrealP/ger0_real/ltW.
pose J : 'M[C]_(n + q + k, n) := col_mx (col_mx 1%:M (- Cy)) 0.
have eJ : loop_filtered *m J = col_mx (col_mx A (omega *: Cy)) 0 :> 'M_(n + q + k, n).
  rewrite /loop_filtered /J mul_block_col mul_block_col mul_row_col !mulmx0 !addr0 !mulmxN mulmx1 mul0mx add0r.
  by rewrite mulNmx opprK mul_scalar_mx addrK mulmx1 subrr.
apply: (core_continuous hS pRs st _ (x := x) (u := u) (J := J) (B := B) _ _ _ _ eX p1).
- by apply: psd_corner; apply: psd_blocks => //; apply: psdZ => //; rewrite exprn_ge0// ltW.
- rewrite /loop_filtered /x /state_filtered /u /inputs_filtered !mul_row_block !mul_mx_row !add_row_mx !(mul0mx, mulmx0, mul1mx, mulmx1, addr0, add0r) mul_row_col.
  by rewrite !(mul0mx, mul1mx, addr0) mulmxA.
- by rewrite /x /state_filtered /J !mul_row_col !(mul0mx, mul1mx, addr0).
- by rewrite /u /inputs_filtered /J !mul_row_col mulmx0 addr0 mulmx1 mulmxN subrr.
- rewrite /noise_filtered /x /state_filtered !mul_row_block !adj_row adj1 !adj0 !mul_row_col.
  by rewrite !(mul0mx, mul1mx, mulmx0, mulmx1, addr0) mul_row_col mulmx1 mulmx0 addr0.
pose J1 : 'M[C]_(n + q, n) := col_mx 1%:M (- Cy); pose J2 : 'M[C]_(n + q, n) := col_mx A (omega *: Cy).
have -> : loop_filtered *m J *m S *m J^H + J *m S *m (loop_filtered *m J)^H + noise_filtered =
    block_mx (J2 *m S *m J1^H + J1 *m S *m J2^H + block_mx W 0 0 (omega ^+ 2 *: V)) 0 0 0.
  have corner (Y Z : 'M[C]_(n + q, n)) : col_mx Y 0 *m S *m (col_mx Z 0)^H = block_mx (Y *m S *m Z^H) 0 0 (0 : 'M_k).
    by rewrite adj_col adj0 mul_col_mx mul0mx mul_col_row !mulmx0 mul0mx.
  by rewrite eJ /J !corner /noise_filtered !add_block_mx !addr0.
apply: psd_corner; pose T : 'M[C]_(n + q) := block_mx 1%:M 0 0 omega%:M.
have -> : J2 *m S *m J1^H + J1 *m S *m J2^H + block_mx W 0 0 (omega ^+ 2 *: V) = T *m second_filtered *m T^H.
  have eT : T^H = T by rewrite /T adj_block !adj0 adj1 /adjoint tr_scalar_mx map_scalar_mx /= ro.
  rewrite eT /T /J1 /J2 !adj_col adj1 adjN adjZ ro /second_filtered !mulmx_block !mul_col_mx !mul_mx_row /block_mx.
  rewrite !add_col_mx !add_row_mx !(mul0mx, mulmx0, mul1mx, mulmx1, addr0, add0r).
  have no : omega != 0 by apply: lt0r_neq0.
  congr (col_mx (row_mx _ _) (row_mx _ _)).
  - by rewrite mul_mx_scalar scalerBr scalerA mulfV// scale1r mulmxN -scalemxAr addrC.
  - rewrite adjB adjZ !adjM adjK hS rmorphV ?unitfE// ro mul_scalar_mx scalerBr scalerA mulfV// scale1r !mulmxA.
    by rewrite !mulNmx -scalemxAl.
  rewrite mul_scalar_mx mul_mx_scalar scalerA -expr2 scalerBr scalerA mulmxN mulNmx mulNmx -!scalemxAl -!scalemxAr.
  have -> : omega ^+ 2 * (2%:R / omega) = omega *+ 2 by rewrite mulrCA expr2 mulfK// mulr_natl.
  by rewrite -opprD -scalerDl addrC mulr2n.
exact: psd_of.
Qed.

(* Discrete time: v is independent of the state, and enters the input at once. *)
Definition loop_discrete : 'M[C]_(n + k) := block_mx (A + B *m D *m Cy) (B *m H) (L *m Cy) K.
Definition noise_discrete : 'M[C]_(n + k) := block_mx W 0 0 0 + col_mx (B *m D) L *m V *m (col_mx (B *m D) L)^H.
Definition inputs_discrete : 'M[C]_(p, n + k) := row_mx (D *m Cy) H.
Definition second_discrete := let S' := A *m S *m A^H + W in
  block_mx (S' - S) (S' *m Cy^H) (Cy *m S') (Cy *m S' *m Cy^H + V).

Theorem bound_discrete X : stable_discrete loop_discrete ->
  X = loop_discrete *m X *m loop_discrete^H + noise_discrete ->
  psd (first_discrete A B Q P R Rs F) -> psd second_discrete ->
  \tr (P *m W) + \tr (F^H *m Rs *m F *m S) <=
  \tr (Q *m (state_proper *m X *m state_proper^H)) +
    \tr (R *m (inputs_discrete *m X *m inputs_discrete^H + D *m V *m D^H)).
Proof.
move=> st eX p1 p2; pose S' := A *m S *m A^H + W; pose J : 'M[C]_(n + k, n) := col_mx 1%:M 0.
have hS' : S'^H = S' by rewrite adjD !adjM adjK hS (psd_adj pW) mulmxA.
have pI : psd noise_discrete by apply: psdD; [apply: psd_corner | apply: psd_of].
have [Z [_ pZ /(_ X eX) XZ]] := covariance_discrete st pI; rewrite -XZ in pZ.
have above : psd (X - J *m S' *m J^H).
  apply: (comparison_discrete st); first by rewrite adjB !adjM adjK hS' mulmxA (psd_adj pZ).
  have eD : decrement loop_discrete X = noise_discrete by rewrite /decrement {1}eX addrAC subrr add0r.
  pose T : 'M[C]_(n + k, n + q) := block_mx 1%:M (B *m D) 0 L.
  have eJ : J = T *m col_mx 1%:M 0 by rewrite /T mul_block_col !mulmx0 !addr0 mul0mx mulmx1.
  have eMJ : loop_discrete *m J = T *m col_mx A Cy.
    by rewrite /loop_discrete /T /J !mul_block_col !mulmx0 !addr0 mul0mx add0r mul1mx !mulmx1.
  have eN : noise_discrete = T *m block_mx W 0 0 V *m T^H.
    rewrite /T adj_block adj1 adj0 !mulmx_block !(mul0mx, mulmx0, mul1mx, mulmx1, addr0, add0r).
    rewrite /noise_discrete adj_col !mul_col_mx !mul_mx_row /block_mx !add_col_mx !add_row_mx.
    by rewrite !(addr0, add0r).
  pose E : 'M[C]_(n + q) := block_mx A 0 0 1%:M.
  have inner : block_mx W 0 0 V - (col_mx 1%:M 0 *m S' *m (col_mx 1%:M 0)^H - col_mx A Cy *m S' *m (col_mx A Cy)^H) =
      E *m second_discrete *m E^H.
    rewrite /E /second_discrete -/S' adj_block !adj_col adj1 !adj0 !mulmx_block.
    rewrite !(mul0mx, mulmx0, mul1mx, mulmx1, addr0, add0r) !mul_col_mx !mul_mx_row mul0mx !mulmx0 mul1mx mulmx1 /block_mx.
    rewrite opprB opp_col_mx opp_row_mx !add_col_mx !add_row_mx.
    rewrite ?mul0mx adj1 !mulmx1 opp_row_mx !add_row_mx oppr0 !addr0 !add0r !mulmxA [V + _]addrC ?subr0.
    have eW : W - S' = - (A *m S *m A^H) by rewrite /S' opprD addrC subrK.
    by rewrite addrCA eW mulmxBr mulmxBl.
  rewrite -/(decrement loop_discrete _) raddfB /= eD /decrement.
  have -> : loop_discrete *m (J *m S' *m J^H) *m loop_discrete^H = loop_discrete *m J *m S' *m (loop_discrete *m J)^H.
    by rewrite adjM !mulmxA.
  have -> : noise_discrete - (J *m S' *m J^H - loop_discrete *m J *m S' *m (loop_discrete *m J)^H) =
      T *m (E *m second_discrete *m E^H) *m T^H.
    by rewrite -inner eN eMJ eJ !adjM !(mulmxBr, mulmxBl) !mulmxA.
  by apply: psd_of; apply: psd_of.
pose x : 'M[C]_(n, n + k) := state_proper; pose u : 'M[C]_(p, n + k) := inputs_discrete.
pose Y := col_mx x u; pose G : 'M[C]_(n + p, q) := col_mx 0 D; pose T := Y *m X *m Y^H + G *m V *m G^H.
have at_x : row_mx 1%:M 0 *m Y = x by rewrite mul_row_col mul1mx mul0mx addr0.
have at_u : row_mx 0 1%:M *m Y = u by rewrite mul_row_col mul1mx mul0mx add0r.
have x_G : row_mx 1%:M 0 *m G = 0 :> 'M_(n, q) by rewrite mul_row_col mulmx0 mul0mx addr0.
have u_G : row_mx 0 1%:M *m G = D by rewrite mul_row_col mulmx0 mul1mx add0r.
have two a (y : 'M[C]_(a, n + p)) : y *m T *m y^H = (y *m Y) *m X *m (y *m Y)^H + (y *m G) *m V *m (y *m G)^H.
  by rewrite /T mulmxDr mulmxDl !adjM !mulmxA.
have -> : x *m X *m x^H = row_mx 1%:M 0 *m T *m (row_mx 1%:M 0)^H.
  by rewrite two at_x x_G adj0 mulmx0 addr0.
have -> : u *m X *m u^H + D *m V *m D^H = row_mx 0 1%:M *m T *m (row_mx 0 1%:M)^H by rewrite two at_u u_G.
apply: (@bound_by_first_discrete _ _ A B) => //; first by apply: psdD; apply: psd_of.
  pose y := row_mx F (- 1%:M) *m Y; pose r := row_mx F (- D).
  have eY : y *m J = F - D *m Cy.
    by rewrite /y /Y /x /u /state_proper /inputs_discrete /J !(mul_row_col, mulmxDl) -!mulmxA !mul_row_col !(mulmx0, addr0) !mulmx1 mulNmx mul1mx.
  have eG : row_mx F (- 1%:M) *m G = - D by rewrite mul_row_col mulmx0 add0r mulNmx mul1mx.
  rewrite two eG adjN mulNmx mulmxN mulNmx opprK -/y.
  have -> : y *m X *m y^H + D *m V *m D^H - F *m S *m F^H =
      y *m (X - J *m S' *m J^H) *m y^H + r *m second_discrete *m r^H.
    have -> : y *m (X - J *m S' *m J^H) *m y^H = y *m X *m y^H - (F - D *m Cy) *m S' *m (F - D *m Cy)^H.
      by rewrite -eY adjM mulmxBr mulmxBl !mulmxA.
    have -> : second_discrete = col_mx 1%:M Cy *m S' *m (col_mx 1%:M Cy)^H + block_mx (- S) 0 0 V.
      rewrite adj_col adj1 !mul_col_mx mul1mx !mul_mx_row !mulmx1 /second_discrete -/S' /block_mx add_col_mx !add_row_mx.
      by rewrite !addr0.
    have rC : r *m col_mx 1%:M Cy = F - D *m Cy by rewrite mul_row_col mulmx1 mulNmx.
    have -> : r *m (col_mx 1%:M Cy *m S' *m (col_mx 1%:M Cy)^H + block_mx (- S) 0 0 V) *m r^H =
        (F - D *m Cy) *m S' *m (F - D *m Cy)^H + (D *m V *m D^H - F *m S *m F^H).
      rewrite mulmxDr mulmxDl -rC adjM !mulmxA; congr (_ + _).
      rewrite mul_row_block adj_row mul_row_col adjN !mulmx0 addr0 add0r !(mulmxN, mulNmx) opprK.
      exact: addrC.
    by rewrite addrA subrK addrA.
  by apply: psdD; apply: psd_of.
have at_next : row_mx A B *m Y = x *m loop_discrete.
  rewrite mul_row_col /x /u /state_proper /inputs_discrete /loop_discrete mul_row_block !mul_mx_row add_row_mx.
  by rewrite !(mul0mx, mul1mx, mulmx0, mulmx1, addr0, add0r) !mulmxA.
have next_G : row_mx A B *m G = B *m D by rewrite mul_row_col mulmx0 add0r.
rewrite !two at_x x_G adj0 mulmx0 addr0 at_next next_G {1}eX mulmxDr mulmxDl adjM !mulmxA -addrA; congr (_ + _).
rewrite /noise_discrete mulmxDr mulmxDl [LHS]addrC; congr (_ + _).
  have -> : x *m (col_mx (B *m D) L *m V *m (col_mx (B *m D) L)^H) *m x^H =
      (x *m col_mx (B *m D) L) *m V *m (x *m col_mx (B *m D) L)^H by rewrite adjM !mulmxA.
  by rewrite {1 2}/x /state_proper mul_row_col mul1mx mul0mx addr0 adjM !mulmxA.
by rewrite /x /state_proper adj_row adj1 adj0 mul_row_block !(mul0mx, mul1mx, addr0) mul_row_col mulmx1 mulmx0 addr0.
Qed.

End Loops.
End Bound.
