(* checker/structure.py: kind `complementary_subsystem`, the Smith form of
   P(x) = [xI - A, B; C, 0] from constant rational matrices, ranks of which are taken modulo l.

   `block_form` is the page's block triangular form over any field: an equivalence of P with
   diag(I, xI - K, I).  The theorems of the last section are the claim: invariant polynomials, normal
   rank, remnant polynomial, whether the transfer matrix is 0, completeness. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic controllability transfer_graph determinantal_divisors companions.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Field.
Variable K : fieldType.
Notation P := {poly K}.
Notation "M ^~" := (map_mx polyC M) (at level 2, format "M ^~").

(* P(x) = [xI - A, B; C, 0] *)
Definition system_matrix n p q (A : 'M[K]_n) (B : 'M_(n, p)) (C : 'M_(q, n)) : 'M[P]_(n + q, n + p) :=
  block_mx (char_poly_mx A) B^~ C^~ 0.

Lemma complement n v c (X : 'M[K]_(n, v)) (W : 'M_(c, n)) : n = (v + c)%N ->
  row_full X -> row_free W -> W *m X = 0 ->
  exists Y Z, [/\ Y *m X = 1%:M, W *m Z = 1%:M, Y *m Z = 0 & X *m Y + Z *m W = 1%:M].
Proof.
move=> en fX fW z; pose Y := pinvmx X; pose Z0 := pinvmx W; pose Z := Z0 - X *m (Y *m Z0).
have YX : Y *m X = 1%:M by apply: mulVpmx.
have WZ : W *m Z = 1%:M by rewrite mulmxBr mulmxA z mul0mx subr0 mulmxVp.
have YZ : Y *m Z = 0 by rewrite mulmxBr mulmxA YX mul1mx subrr.
exists Y, Z; split=> //; move: X W Y Z0 Z z fX fW YX WZ YZ; rewrite en => X W Y _ Z z _ _ YX WZ YZ.
rewrite -mul_row_col; apply: mulmx1C.
by rewrite mul_col_row YX WZ YZ z -scalar_mx_block.
Qed.

Lemma krylov_polynomial n b (A : 'M[K]_n) (B : 'M_(n, b)) i :
  exists Q, (krylov A B i)^~ = 'X^i *: B^~ - char_poly_mx A *m Q.
Proof.
elim: i => [|i [Q e]]; first by exists 0; rewrite mulmx0 subr0 expr0 scale1r.
exists ('X *: Q + (krylov A B i)^~); rewrite krylovS map_mxM.
have -> : A^~ = 'X%:M - char_poly_mx A by rewrite /char_poly_mx subKr.
by rewrite mulmxBl mul_scalar_mx {1}e scalerBr scalerA -exprS mulmxDr opprD addrA scalemxAr.
Qed.

(* a controllable pair: [xI - A, B] has a polynomial right inverse *)
Lemma controllable_right_inverse n b (A : 'M[K]_n) (B : 'M_(n, b)) k : (n <= \rank (reach A B k))%N ->
  exists R, row_mx (char_poly_mx A) B^~ *m R = 1%:M.
Proof.
move=> r; have fr : row_free (reach A B k) by rewrite /row_free eqn_leq rank_leq_row.
pose W := pinvmx (reach A B k); have eW : reach A B k *m W = 1%:M by apply: mulmxVp.
rewrite -[W]submxcolK /reach mul_mxrow_mxcol in eW.
have [Q eQ] : exists Q, forall i : 'I_k,
    (krylov A B i)^~ = 'X^i *: B^~ - char_poly_mx A *m Q i.
  have [Q eQ] := fin_all_exists (fun i : 'I_k => krylov_polynomial A B i).
  by exists Q.
exists (col_mx (- \sum_(i < k) Q i *m (submxcol W i)^~) (\sum_(i < k) 'X^i *: (submxcol W i)^~)).
rewrite mul_row_col mulmxN !mulmx_sumr addrC -sumrB -[RHS](map_mx1 (polyC_rmorphism K)) -eW raddf_sum /=.
apply: eq_bigr => i _; by rewrite map_mxM eQ [RHS]mulmxBl -mulmxA -scalemxAl -scalemxAr.
Qed.

Lemma unit_triangular c (N : 'M[K]_c) : (forall i j : 'I_c, (i <= j)%N -> N i j = 0) ->
  1%:M - 'X *: N^~ \in unitmx.
Proof.
move=> low; rewrite unitmxE det_trig; last first.
  apply/is_trig_mxP=> i j ij; rewrite !mxE low ?(ltnW ij)// mulr0 subr0.
  by rewrite -val_eqE /= ltn_eqF.
by rewrite big1 ?unitr1// => i _; rewrite !mxE low// eqxx mulr0 subr0.
Qed.

Section BlockForm.
Variables (n p q a b f c e : nat) (A : 'M[K]_n) (B : 'M[K]_(n, p)) (C : 'M[K]_(q, n)).
Variables (X1 : 'M[K]_(n, a)) (X2 : 'M[K]_(n, b)) (F : 'M[K]_(p, a + b)).
Variables (A11 : 'M[K]_a) (A12 : 'M[K]_(a, b)) (Z : 'M[K]_b).
Variables (S : 'M[K]_(p, f)) (B1 : 'M[K]_(a, f)).
Variables (W : 'M[K]_(c, n)) (G : 'M[K]_(c, q)) (N : 'M[K]_c).
Notation X := (row_mx X1 X2).
Hypotheses (en : n = (a + b + c)%N) (ep : p = (f + e)%N).
Hypothesis AX : A *m X + B *m F = X *m col_mx (row_mx A11 A12) (row_mx 0 Z).
Hypothesis BS : B *m S = X1 *m B1.
Hypothesis CX : C *m X = 0.
Hypothesis WX : W *m X = 0.
Hypothesis WA : W = G *m C + N *m W *m A.
Hypothesis NWB : N *m W *m B = 0.
Hypothesis low : forall i j : 'I_c, (i <= j)%N -> N i j = 0.
Hypotheses (rX : row_full X) (rW : row_free W) (rS : row_full S) (rWB : (e <= \rank (W *m B))%N).
Hypothesis reached : (a <= \rank (reach A11 B1 a))%N.

(* the last block has a polynomial left inverse *)
Lemma last_block (X3 : 'M_(n, c)) (S2 : 'M_(p, e)) (H : 'M_(e, c)) :
  W *m X3 = 1%:M -> H *m (W *m B *m S2) = 1%:M ->
  exists E, E *m system_matrix (W *m A *m X3) (W *m B *m S2) (C *m X3) = 1%:M.
Proof.
move=> WX3 HB; pose T := 1%:M - 'X *: N^~; have uT : T \in unitmx by apply: unit_triangular.
pose D := char_poly_mx (W *m A *m X3).
have NA : N *m (W *m A *m X3) = 1%:M - G *m (C *m X3).
  by rewrite -WX3 {2}WA mulmxDl -!mulmxA addrC addKr.
pose E1 := invmx T *m row_mx (- N^~) G^~.
have E1D : E1 *m system_matrix (W *m A *m X3) (W *m B *m S2) (C *m X3) = row_mx 1%:M 0.
  have NB : N^~ *m (W *m B *m S2)^~ = 0 by rewrite -map_mxM !mulmxA NWB mul0mx map_mx0.
  have ND : - N^~ *m D + G^~ *m (C *m X3)^~ = T.
    rewrite /D /char_poly_mx mulNmx mulmxBr mul_mx_scalar -!map_mxM NA map_mxB map_mx1 opprB.
    by rewrite addrAC subrK.
  rewrite /E1 -[LHS]mulmxA /system_matrix mul_row_block mulmx0 addr0 ND mulNmx NB oppr0.
  by rewrite mul_mx_row mulmx0 mulVmx.
exists (col_mx E1 (row_mx H^~ 0 - H^~ *m D *m E1)).
rewrite mul_col_mx mulmxBl -[_ *m E1 *m _]mulmxA E1D /system_matrix.
rewrite mul_row_block !mul0mx !addr0 -map_mxM HB map_mx1 mul_mx_row mulmx0 mulmx1.
by rewrite opp_row_mx add_row_mx subrr subr0 -block_mxEv -scalar_mx_block.
Qed.

(* the first blocks: A12 is cleared by a right inverse of [xI - A11, B1] *)
Lemma first_blocks :
  equivalent (row_mx (char_poly_mx (block_mx A11 A12 0 Z)) (col_mx B1 0)^~)
             (dsum (1%:M : 'M[P]_a) (char_poly_mx Z)).
Proof.
have [R eR] := controllable_right_inverse reached; pose D1 := row_mx (char_poly_mx A11) B1^~.
apply: equivalent_trans (equivalent_dsum (right_inverse_equivalent eR) (equivalent_refl _)).
have -> : row_mx (char_poly_mx (block_mx A11 A12 0 Z)) (col_mx B1 0)^~ =
    row_mx (block_mx (char_poly_mx A11) (- A12^~) 0 (char_poly_mx Z)) (col_mx B1^~ 0).
  rewrite map_col_mx map_mx0 /char_poly_mx map_block_mx map_mx0 scalar_mx_block.
  by rewrite opp_block_mx add_block_mx oppr0 addr0 add0r.
pose r := R *m (- A12^~); have D1r : D1 *m r = - A12^~ by rewrite mulmxA eR mul1mx.
split.
  exists 1%:M, (row_mx (block_mx (col_mx 1%:M 0) r 0 1%:M) (col_mx (col_mx 0 1%:M) 0)).
  rewrite mul1mx mul_mx_row mulmx_block mul_block_col !(mulmx0, mul0mx, addr0, add0r, mulmx1) D1r.
  by rewrite !mul_row_col !(mulmx0, mulmx1, addr0, add0r).
exists 1%:M, (row_mx (col_mx (block_mx 1%:M 0 0 0) (row_mx 0 1%:M))
                     (col_mx (col_mx (- usubmx r) 1%:M) (- dsubmx r))).
have e1 : - A12^~ = char_poly_mx A11 *m usubmx r + B1^~ *m dsubmx r.
  by rewrite -mul_row_col vsubmxK D1r.
rewrite mul1mx mul_mx_row !mul_row_col mulmx_block mul_col_row mul_block_col mul_col_mx.
rewrite !(mulmx0, mul0mx, addr0, add0r, mulmx1) add_block_mx !(addr0, add0r) add_col_mx addr0.
rewrite e1 !mulmxN addKr subrr /dsum [LHS]block_mxEh; congr (row_mx _ _).
by rewrite block_mxEv row_mx0.
Qed.

(* P(x) is equivalent to diag(I, xI - Z, I) *)
Lemma block_form : equivalent (system_matrix A B C)
  (dsum (dsum (1%:M : 'M[P]_a) (char_poly_mx Z)) (1%:M : 'M[P]_(c + e))).
Proof.
have [Y [X3 [YX WX3 YX3 XY]]] := complement en rX rW WX.
have [R fY2] := rank_select rWB; pose Y2 := R *m (W *m B).
have WBS : W *m B *m S = 0.
  have := congr1 (fun M => lsubmx M) WX; rewrite /= mul_mx_row row_mxKl => WX1.
  by rewrite -mulmxA BS mulmxA WX1 linear0 mul0mx.
have [V [S2 [VS YS2 VS2 SV]]] : exists V S2, [/\ V *m S = 1%:M, Y2 *m S2 = 1%:M, V *m S2 = 0 &
    S *m V + S2 *m Y2 = 1%:M].
  by apply: complement => //; rewrite -mulmxA WBS mulmx0.
have [E ED] := @last_block X3 S2 R WX3 (etrans (mulmxA _ _ _) YS2).
move: Y2 fY2 YS2 SV => Y2 _ _ SV.
pose J : 'M[K]_(a + b) := block_mx A11 A12 0 Z.
have AXJ : A *m X + B *m F = X *m J by rewrite AX /J block_mxEv.
pose A3 := W *m A *m X3; pose B3 := W *m B *m S2; pose C3 := C *m X3.
pose D := row_mx (char_poly_mx J) (col_mx B1 0)^~.
pose H := row_mx (- (Y *m A *m X3)^~) (Y *m B *m S2)^~.
pose M := block_mx D H 0 (system_matrix A3 B3 C3).
suff eM : equivalent (system_matrix A B C) M.
  apply: equivalent_trans eM (equivalent_trans (clear_above _ _ ED) _).
  exact: equivalent_dsum first_blocks (left_inverse_equivalent ED).
pose T : 'M[P]_(n + p, a + b + f + (c + e)) :=
  block_mx (row_mx X^~ 0) (row_mx X3^~ 0) (row_mx (- F^~) S^~) (row_mx 0 S2^~).
pose T' : 'M[P]_(a + b + f + (c + e), n + p) :=
  block_mx (col_mx Y^~ (V *m F *m Y)^~) (col_mx 0 V^~) (col_mx W^~ (Y2 *m F *m Y)^~) (col_mx 0 Y2^~).
pose U : 'M[P]_(n + q, a + b + (c + q)) := block_mx X^~ (row_mx X3^~ 0) 0 (row_mx 0 1%:M).
pose U' : 'M[P]_(a + b + (c + q), n + q) := block_mx Y^~ 0 (col_mx W^~ 0) (col_mx 0 1%:M).
have TT' : T *m T' = 1%:M.
  have SFY : S *m (V *m F *m Y) + S2 *m (Y2 *m F *m Y) = F *m Y.
    by rewrite !mulmxA -!mulmxDl SV mul1mx.
  rewrite mulmx_block !mul_row_col !(mulmx0, mul0mx, addr0, add0r) mulNmx -addrA -!map_mxM -!map_mxD.
  by rewrite XY SV SFY addNr !map_mx1 -scalar_mx_block.
have U'U : U' *m U = 1%:M.
  rewrite mulmx_block !(mulmx0, mul0mx, addr0, add0r) mul_mx_row mul_col_mx mul_col_row.
  rewrite !(mulmx0, mul0mx) -!map_mxM YX YX3 WX WX3 map_mx0 row_mx0 map_mx1.
  rewrite mul_col_row !(mulmx0, mulmx1) !map_mx0 map_mx1 col_mx0 add_block_mx !(addr0, add0r).
  by rewrite -!scalar_mx_block.
have PT : system_matrix A B C *m T = U *m M.
  have cJ : char_poly_mx A *m X^~ - B^~ *m F^~ = X^~ *m char_poly_mx J.
    rewrite /char_poly_mx mulmxBl mulmxBr -scalar_mxC -!map_mxM -addrA -opprD -map_mxD.
    by rewrite AXJ.
  have cA : char_poly_mx A *m X3^~ = - X^~ *m (Y *m A *m X3)^~ + X3^~ *m char_poly_mx A3.
    rewrite /char_poly_mx mulmxBl mulmxBr -scalar_mxC mulNmx -!map_mxM addrCA -opprD -map_mxD /A3.
    by rewrite !mulmxA -!mulmxDl XY mul1mx.
  have cB : B^~ *m S2^~ = X^~ *m (Y *m B *m S2)^~ + X3^~ *m B3^~.
    by rewrite /B3 -!map_mxM -map_mxD !mulmxA -!mulmxDl XY mul1mx.
  have cS : B^~ *m S^~ = X^~ *m (col_mx B1 0)^~.
    by rewrite -!map_mxM mul_row_col mulmx0 addr0 BS.
  rewrite !mulmx_block !(mulmx0, mul0mx, addr0, add0r) !mul_mx_row !mulmx0 !add_row_mx.
  rewrite !(mulmx0, mul0mx, addr0, add0r) mulmxN cJ cA cB cS.
  rewrite -[C^~ *m X^~]map_mxM CX map_mx0 row_mx0 /system_matrix !mul_row_block !(mulmx0, mul0mx).
  by rewrite !addr0 !add0r !mul1mx add_row_mx mulmxN mulNmx /C3 [(C *m X3)^~]map_mxM.
have eP : system_matrix A B C = U *m M *m T' by rewrite -PT -mulmxA TT' mulmx1.
by split; [exists U, T' | exists U', T; rewrite -mulmxA PT mulmxA U'U mul1mx].
Qed.
End BlockForm.

(* a list of polynomials, each of which divides the next *)
Lemma chain_ones k (fs : seq P) : sorted (fun g h => g %| h) fs -> chain (nseq k 1 ++ fs).
Proof.
move=> srt i j /andP[ij]; rewrite size_cat size_nseq !nth_cat size_nseq !nth_nseq => js.
case: ltnP => ik; first by rewrite dvd1p.
have jk := leq_trans ik ij; rewrite ltnNge jk /=.
have tr : transitive (fun g h : P => g %| h) by move=> f g h; apply: dvdp_trans.
have lt : (j - k < size fs)%N by rewrite ltn_subLR.
apply: (sorted_leq_nth tr (@dvdpp _) _ srt); rewrite ?inE ?leq_sub2r//.
by apply: leq_ltn_trans lt; rewrite leq_sub2r.
Qed.

(* C adj(xI - A) B = 0 iff no minor of order n + 1 is different from 0 *)
Lemma transfer0_minors n p q (A : 'M[K]_n) (B : 'M_(n, p)) (C : 'M_(q, n)) :
  transfer A B C = 0 <-> forall f g, @minor _ _ _ (system_matrix A B C) n.+1 f g = 0.
Proof.
set M := char_poly_mx A; pose chi := \det M; have nchi : chi != 0.
  by rewrite monic_neq0 ?char_poly_monic.
pose Q := block_mx 1%:M 0 (- (C^~ *m \adj M)) chi%:M : 'M_(n + q).
have QP : Q *m system_matrix A B C = block_mx M B^~ 0 (- transfer A B C).
  rewrite mulmx_block !(mul1mx, mul0mx, mulmx0, addr0) mulNmx -mulmxA mul_adj_mx -/chi scalar_mxC.
  by rewrite addNr mulNmx.
split=> [T0 f g | z].
  have e : \det Q *: system_matrix A B C = \adj Q *m col_mx 1%:M 0 *m row_mx M B^~.
    rewrite -mul_scalar_mx -mul_adj_mx -!mulmxA QP T0 oppr0 mul_col_mx mul1mx mul0mx.
    by rewrite -[0 in RHS](row_mx0 _ q n p).
  have dQ : \det Q != 0 by rewrite det_lblock det1 mul1r det_scalar expf_neq0.
  have : minor (\det Q *: system_matrix A B C) f g = 0 by rewrite e minor_narrow.
  have -> : minor (\det Q *: system_matrix A B C) f g = \det (\det Q *: mxsub f g (system_matrix A B C)).
    by congr (\det _); apply/matrixP=> i j; rewrite !mxE.
  by rewrite detZ => /eqP; rewrite mulf_eq0 expf_eq0 (negPf dQ) andbF => /eqP.
apply/matrixP=> i j; rewrite [RHS]mxE.
have : divides_minors (Q *m system_matrix A B C) n.+1 0.
  apply: (@divides_factors _ _ _ _ _ _ (system_matrix A B C)); first by exists Q, 1%:M; rewrite mulmx1.
  by move=> f g; rewrite z dvdpp.
rewrite QP.
pose f (k : 'I_(1 + n)) : 'I_(n + q) := if split k is inr k' then lshift q k' else rshift n i.
pose g (k : 'I_(1 + n)) : 'I_(n + p) := if split k is inr k' then lshift p k' else rshift n j.
move=> /(_ f g); rewrite dvd0p /minor.
have -> : mxsub f g (block_mx M B^~ 0 (- transfer A B C)) =
    block_mx (- transfer A B C i j)%:M 0 (col j B^~) M :> 'M_(1 + n).
  apply/matrixP=> k t; rewrite [LHS]mxE /f /g.
  case: (split_ordP k) => k' ->; case: (split_ordP t) => t' ->.
  - by rewrite block_mxEdr block_mxEul !ord1 !mxE eqxx.
  - by rewrite block_mxEdl block_mxEur !mxE.
  - by rewrite block_mxEur block_mxEdl !mxE.
  - by rewrite block_mxEul block_mxEdr.
by rewrite (@det_lblock _ 1 n) det_scalar1 mulNr oppr_eq0 mulf_eq0 (negPf nchi) orbF => /eqP.
Qed.
End Field.

(* Modulo l, M has rank r: elimination with unit pivots. *)
Definition reached (l : modulus) d e (M : 'M[Zloc l]_(d, e)) r :=
  exists X Y, X *m map_mx (@residue l) M *m Y = 1%:M :> 'M_r.

(* Kind `complementary_subsystem`: the normal rank k, the invariant polynomials fs, and the witness.  A, C,
   F, G, N and the invariant polynomials are rational; B and what is reduced modulo l, X = [X1, X2],
   A1 = [A11, A12], S, B1 and L, have denominators prime to l. *)
Section Rule.
Variables (l : modulus) (n p q : nat).
Variables (A : 'M[rat]_n) (B : 'M[Zloc l]_(n, p)) (C : 'M[rat]_(q, n)) (k : nat) (fs : seq {poly rat}).
Notation b := (degrees fs).
Notation Qm := (map_mx (@Zloc_rat l)).

Record smith_evidence (a c f : nat) := SmithEvidence {
  sm_X1 : 'M[Zloc l]_(n, a); sm_X2 : 'M[Zloc l]_(n, b); sm_F : 'M[rat]_(p, a + b);
  sm_A11 : 'M[Zloc l]_a; sm_A12 : 'M[Zloc l]_(a, b);
  sm_S : 'M[Zloc l]_(p, f); sm_B1 : 'M[Zloc l]_(a, f);
  sm_L : 'M[Zloc l]_(c, n); sm_G : 'M[rat]_(c, q); sm_N : 'M[rat]_c;
  sm_X := row_mx sm_X1 sm_X2;
  sm_nonconstant : all (@nonconstant _) fs;
  sm_chain : sorted (fun g h => g %| h) fs;
  sm_k : (n <= k)%N; sm_n : n = (a + b + c)%N; sm_f : (f + k = n + p)%N;
  sm_AX : A *m Qm sm_X + Qm B *m sm_F
    = Qm sm_X *m col_mx (Qm (row_mx sm_A11 sm_A12)) (row_mx 0 (companions fs));
  sm_BS : B *m sm_S = sm_X1 *m sm_B1;
  sm_CX : C *m Qm sm_X = 0;
  sm_LX : sm_L *m sm_X = 0;
  sm_LGN : Qm sm_L = sm_G *m C + sm_N *m Qm sm_L *m A;
  sm_NLB : sm_N *m Qm sm_L *m Qm B = 0;
  sm_low : forall i j : 'I_c, (i <= j)%N -> sm_N i j = 0;
  sm_rankX : reached sm_X (a + b);
  sm_rankL : reached sm_L c;
  sm_rankS : reached sm_S f;
  sm_rankLB : reached (sm_L *m B) (k - n);
  sm_controllable : reached (reach sm_A11 sm_B1 a) a }.

Variables (a c f : nat) (E : smith_evidence a c f).
Notation P := (system_matrix A (Qm B) C).
Let s := nseq (k - size fs) 1 ++ fs.
Definition remnant : {poly rat} := \prod_(g <- take (size fs - (k - n)) fs) g.

Let hk : (size fs <= k)%N.
Proof.
by rewrite (leq_trans (degrees_ge (sm_nonconstant E)))// (leq_trans _ (sm_k E))// (sm_n E) addnAC leq_addl.
Qed.
Let size_s : size s = k. Proof. by rewrite size_cat size_nseq subnK. Qed.

Let rank_Q d e (M : 'M[Zloc l]_(d, e)) r : reached M r -> (r <= \rank (Qm M))%N.
Proof. by case=> Y [Z YZ]; apply: (rank_from_below [rmorphism of (@idfun rat)] YZ). Qed.

Let smith : equivalent P (diagonal s).
Proof.
case: E => X1 X2 F A11 A12 S B1 W G N X shapes _ nk en ef AX BS CX WX WA NWB low rX rW rS rWB rA.
have full (d e : nat) (M : 'M[Zloc l]_(d, e)) : reached M e -> row_full (Qm M).
  by move=> /rank_Q r; rewrite /row_full eqn_leq rank_leq_col.
have free (d e : nat) (M : 'M[Zloc l]_(d, e)) : reached M d -> row_free (Qm M).
  by move=> /rank_Q r; rewrite /row_free eqn_leq rank_leq_row.
have ep : p = (f + (k - n))%N.
  by apply/eqP; rewrite -(eqn_add2l n) addnCA subnKC// ef.
have eX : Qm X = row_mx (Qm X1) (Qm X2) by rewrite map_row_mx.
have := @block_form _ n p q a b f c (k - n) A (Qm B) C (Qm X1) (Qm X2) F (Qm A11) (Qm A12)
  (companions fs) (Qm S) (Qm B1) (Qm W) G N en ep.
rewrite -eX -!map_mxM -map_row_mx => /(_ AX) bf; apply: equivalent_trans (bf _ _ _ _ _ _ _ _ _ _ _) _ => //.
- by rewrite BS.
- by rewrite WX map_mx0.
- exact: full.
- exact: free.
- exact: full.
- exact: rank_Q.
- by rewrite -map_reach; apply: rank_Q.
have ones := equivalent_dsum (equivalent_dsum (diagonal_ones _ a) (companions_equivalent shapes))
  (diagonal_ones _ (c + (k - n))).
apply: equivalent_trans ones _.
apply: equivalent_trans (equivalent_dsum (diagonal_cat _ _) (equivalent_refl _)) _.
apply: equivalent_trans (diagonal_cat _ _) (diagonal_perm _).
rewrite /s; have -> : (k - size fs = a + (b - size fs) + (c + (k - n)))%N.
  have hb := degrees_ge shapes; apply/eqP; rewrite -(eqn_add2r (size fs)) subnK// addnAC.
  rewrite -[(a + _ + _)%N]addnA subnK//.
  by rewrite addnA -en subnKC.
by rewrite !nseqD -!catA perm_cat2l perm_cat2l perm_catC -catA perm_refl.
Qed.

Let smith_chain : chain s. Proof. exact: chain_ones (sm_chain E). Qed.

(* The greatest common divisors of the minors: f_1, ..., f_h are the invariant polynomials other than 1. *)
Theorem invariant_polynomials r d : (r <= k)%N ->
  divides_minors P r d <-> d %| \prod_(i < r) (nseq (k - size fs) 1 ++ fs)`_i.
Proof. by move=> rk; apply: (determinantal_divisors smith smith_chain).1; rewrite size_s. Qed.

Let nonzero r : \prod_(i < r) s`_i != 0 \/ (k < r)%N.
Proof.
have [kr|rk] := ltnP k r; [by right|left]; rewrite prodf_seq_neq0; apply/allP=> i _ /=.
have : s`_i \in s by rewrite mem_nth// size_s (leq_trans _ rk).
rewrite mem_cat => /orP[/nseqP[-> _]|/(allP (sm_nonconstant E))/andP[m _]]; first exact: oner_neq0.
exact: monic_neq0.
Qed.

(* The normal rank is k: the largest order of a minor that is not 0. *)
Theorem normal_rank r : (forall f g, @minor _ _ _ P r f g = 0) <-> (k < r)%N.
Proof.
split=> [z|kr f' g]; last by apply: (determinantal_divisors smith smith_chain).2; rewrite size_s.
have [nz|//] := nonzero r; rewrite ltnNge; apply/negP => rk.
have : divides_minors P r 0 by move=> f' g; rewrite z dvdpp.
by move/(invariant_polynomials _ rk); rewrite dvd0p (negPf nz).
Qed.

(* The remnant polynomial is the greatest common divisor of the minors of order n. *)
Let remnantE : \prod_(i < n) s`_i = remnant.
Proof.
have ones m : \prod_(g <- nseq m (1 : {poly rat})) g = 1.
  by rewrite big1_seq// => g /andP[_ /nseqP[]].
have nk := sm_k E; rewrite prod_take ?size_s// take_cat size_nseq /remnant; case: ltnP => h.
  rewrite take_nseq ?(ltnW h)// ones; have -> : (size fs - (k - n) = 0)%N; last by rewrite take0 big_nil.
  by apply/eqP; rewrite subn_eq0 ltnW// ltn_subRL addnC -ltn_subRL.
rewrite big_cat ones /= mul1r subnBA// [in RHS]subnBA//.
by rewrite addnC.
Qed.

Theorem remnant_gcd d : divides_minors P n d <-> d %| remnant.
Proof. by rewrite -remnantE; apply: invariant_polynomials (sm_k E). Qed.

Theorem transfer_zero : transfer A (Qm B) C = 0 <-> k = n.
Proof.
rewrite transfer0_minors normal_rank ltnS; split=> [kn|->//].
by apply/eqP; rewrite eqn_leq kn (sm_k E).
Qed.

(* The roots of the remnant polynomial are the numbers where the rank is below n. *)
Theorem remnant_roots (L : fieldType) (h : {rmorphism rat -> L}) lambda :
  (n <= \rank (map_mx (horner_eval lambda \o map_poly h) P))%N = ~~ root (map_poly h remnant) lambda.
Proof.
pose ev : {rmorphism {poly rat} -> L} := [rmorphism of horner_eval lambda \o map_poly h].
rewrite -/(map_mx ev P); have evr g : (ev g == 0) = root (map_poly h g) lambda by [].
have minor_ev d e (M : 'M[{poly rat}]_(d, e)) r f' g : minor (map_mx ev M) f' g = ev (@minor _ _ _ M r f' g).
  by rewrite /minor -map_mxsub det_map_mx.
rewrite -evr; apply/idP/idP=> [/rank_minor nz|nz].
  apply: contra_notN nz => /eqP z f' g.
  have /dvdpP[u eu] := (remnant_gcd remnant).2 (dvdpp _) f' g.
  by rewrite minor_ev eu rmorphM z mulr0.
have [_ [U [V eD]]] := smith; have ns : (n <= size s)%N by rewrite size_s (sm_k E).
have : minor (map_mx ev (diagonal s)) (widen_ord ns) (widen_ord ns) != 0.
  by rewrite minor_ev diagonal_attained remnantE.
move/minor_rank=> /leq_trans; apply; rewrite eD !map_mxM.
by rewrite (leq_trans (mxrankM_maxl _ _))// mxrankM_maxr.
Qed.

(* Complete: the transfer matrix is not 0, and no complex number lowers the rank below n. *)
Theorem complete_rule (L : closedFieldType) (h : {rmorphism rat -> L}) :
  transfer A (Qm B) C != 0 /\
    (forall lambda, (n <= \rank (map_mx (horner_eval lambda \o map_poly h) P))%N) <->
  (n < k)%N /\ remnant = 1.
Proof.
have t0 : (transfer A (Qm B) C != 0) = (n < k)%N.
  rewrite ltn_neqAle (sm_k E) andbT [n == k]eq_sym; congr (~~ _).
  by apply/eqP/eqP => /transfer_zero.
have mr : remnant \is monic.
  rewrite /remnant big_seq; apply: rpred_prod => g /mem_take gs.
  by have /andP[] := allP (sm_nonconstant E) g gs.
rewrite t0; split=> -[kn c1]; split=> //;
  last by move=> lambda; rewrite remnant_roots c1 rmorph1 root1.
apply/eqP; rewrite -eqp_monic ?monic1// -size_poly_eq1 -(size_map_poly h).
apply/negPn/negP => /closed_rootP[x rx].
by have := c1 x; rewrite remnant_roots rx.
Qed.
End Rule.
