(* Rule Krylov, checker/core/evidence.py, unmoved_degree: at most n - L modes are fixed, by one sequence of numbers modulo l.

   With b = B_q x, c = y C_q and s_k = c A_F^k b, the monic d of degree L satisfies sum_j d_j s_(k+j) = 0 for
   k < L - 1, and a num + e d = 1, num the polynomial part of d times the sum of s_k x^(-k-1).  The recurrence holds
   for all k if sum_k d_k A_F^k b = 0, which takes half of the steps. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph fixed_spectrum.
From mcexact Require Import krylov_sequence fixed_bound krylov.
From mcexact.kernel Require Import lists systems residues packed.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Gains [::] are zero: the channel is left out. *)
Definition sized_gain (cF : zchannel * zmat) : bool := nilp cF.2 || shape (zp cF.1) (zq cF.1) cF.2.
(* The inputs of the channels side by side, and F_i C_i one above the other *)
Definition zacting (cFs : seq (zchannel * zmat)) : zmat :=
  foldr (fun cF acc => if nilp cF.2 then acc else zbeside (zB cF.1) acc) [::] cFs.
Definition zfed (l : Z) (cFs : seq (zchannel * zmat)) : zmat :=
  foldr (fun cF acc => if nilp cF.2 then acc else zmm_mod l cF.2 (zC cF.1) ++ acc) [::] cFs.
(* A + sum_i B_i F_i C_i modulo l, of residues *)
Definition zfeedback (l : Z) (A : zmat) (chs : seq zchannel) (Fs : seq zmat) : zmat :=
  let cFs := zip chs Fs in zmat_mod l (zmaxpy 1 (zmm_mod l (zacting cFs) (zfed l cFs)) A).
(* sum_k d_k M^k v, and the numbers c M^k v for k < size d *)
Fixpoint zrun (step : zrow -> zrow) (c : zrow) (d v : zrow) : zrow * zrow :=
  match d with
  | [::] => ([::], [::])
  | d0 :: d' => let: (tot, s) := zrun step c d' (step v) in (zaxpy d0 v tot, zdot c v :: s) end.
Fixpoint zseq (step : zrow -> zrow) (c : zrow) (k : nat) (v : zrow) : zrow :=
  if k is k'.+1 then zdot c v :: zseq step c k' (step v) else [::].
Fixpoint zrecurs l (d s : zrow) (k : nat) : bool :=
  if k is k'.+1 then Z.eqb (Z.modulo (zdot d s) l) 0 && zrecurs l d (behead s) k' else true.
(* num_i = sum_(j > i) d_j s_(j-i-1) *)
Fixpoint znum (d s : zrow) : zrow := match d with [::] => [::] | _ :: d' => zdot d' s :: znum d' s end.

Record krylov_witness := KrylovWitness { k_ell : Z; k_inv : Z; k_F : seq zmat; k_channel : nat; k_x : zrow; k_y : zrow;
  k_d : zrow; k_a : zrow; k_e : zrow }.
Definition krylov_degree_of (c : krylov_witness) : nat := (size (k_d c)).-1.
Definition check_krylov (s : zsystem) (c : krylov_witness) : bool :=
  let: (n, l, i) := (zn s, k_ell c, k_inv c) in
  let A := zscale_mod l i (zA s) in
  let chs := [seq reduced l i ch | ch <- zchannels s] in
  let AF := zfeedback l A chs (k_F c) in
  let o := nth zch0 chs (k_channel c) in
  let b := zmod l (zmv (zB o) (k_x c)) in
  let cT := zmod l (zvm (k_y c) (zC o)) in
  let L := krylov_degree_of c in
  let AFs := zpacked l AF in
  let step u := zvm_mod l u AFs in
  [&& inverse_modulo l (zD s) i, size (k_F c) == size chs, all sized_gain (zip (zchannels s) (k_F c)),
      k_channel c < size chs, size (k_y c) == zq o, size b <= n, size AF <= n, 0 < size (k_d c), Z.eqb (last z0 (k_d c)) 1 &
      let: (tot, sq) := zrun step b (k_d c) cT in
      let num := zmod l (znum (k_d c) sq) in
      (zero_mod l tot || zrecurs l (k_d c) (zseq step b (L + L) cT) L.-1) &&
      zero_mod l (zaxpy (-1) [:: 1%coqZ] (zaxpy 1 (zpmul (k_a c) num) (zpmul (k_e c) (k_d c))))]%N.

Section Computed.
Variable R : comRingType.
Notation phi := (phi R).
Notation mx := (mx R).
Notation cv := (cv R).

Lemma krylov_shift n (A : 'M[R]_n) (v : 'cV[R]_n) j : krylov A (A *m v) j = krylov A v j.+1.
Proof. by rewrite /krylov iterSr. Qed.
Lemma znum_nth d s i : phi (nth z0 (znum d s) i) =
  \sum_(j < size d | (i < j)%N) phi (nth z0 d j) * phi (nth z0 s (j - i.+1)%N).
Proof.
elim: d i => [|d0 d IH] i; first by rewrite nth_nil big_ord0.
rewrite big_mkcond big_ord_recl /= add0r -big_mkcond /=; case: i => [|i] /=.
  rewrite (zdotE _ _ (leqnn _)); apply: eq_big => j //= _; by rewrite /bump /= add1n subn1.
by rewrite IH; apply: eq_big => j //= _; rewrite /bump /= add1n subSS.
Qed.

Section Feedback.
Variables (lz : Z) (n : nat).
Hypotheses (l0 : (0 < lz)%coqZ) (pl : phi lz = 0).
Lemma zfedE chs Fs : size Fs = size chs -> all (sized_channel n) chs -> all sized_gain (zip chs Fs) ->
  mx n (size (zfed lz (zip chs Fs))) (zacting (zip chs Fs)) *m mx (size (zfed lz (zip chs Fs))) n (zfed lz (zip chs Fs)) = \sum_(k < size chs)
    mx n (zp (nth zch0 chs k)) (zB (nth zch0 chs k)) *m mx _ (zq (nth zch0 chs k)) (nth [::] Fs k) *m mx _ n (zC (nth zch0 chs k)).
Proof.
elim: chs Fs => [|ch chs IH] [|F Fs] //; first by rewrite big_ord0 [zacting _]/= mx_nil mul0mx.
case=> sF /andP[/andP[sB sC] alc] /andP[gF sG]; rewrite big_ord_recl.
have -> : zacting (zip (ch :: chs) (F :: Fs)) = if nilp F then zacting (zip chs Fs) else zbeside (zB ch) (zacting (zip chs Fs)) by [].
have -> : zfed lz (zip (ch :: chs) (F :: Fs)) = if nilp F then zfed lz (zip chs Fs) else zmm_mod lz F (zC ch) ++ zfed lz (zip chs Fs) by [].
have e := IH Fs sF alc sG; case: nilP gF => [->|nF]; first by rewrite e [nth [::] _ _]/= mx_nil mulmx0 mul0mx add0r.
case/orP=> [/nilP //|sh]; have sP : size (zmm_mod lz F (zC ch)) = zp ch by rewrite size_map (shape_size sh).
rewrite size_cat sP (@zbesideE _ _ _ _ _ _ _ _ _ sB sP) e; congr (_ + _).
by rewrite (zmm_modE l0 pl _ _ _ (eq_leq (shape_size sC))) mulmxA.
Qed.
Lemma feedbackE A chs Fs : all (sized_channel n) chs -> size Fs = size chs -> all sized_gain (zip chs Fs) ->
  mx n n (zfeedback lz A chs Fs) = mx n n A + \sum_(k < size chs)
    mx n (zp (nth zch0 chs k)) (zB (nth zch0 chs k)) *m mx _ (zq (nth zch0 chs k)) (nth [::] Fs k) *m mx _ n (zC (nth zch0 chs k)).
Proof.
move=> alc sF sG; rewrite /zfeedback (zmat_modE l0 pl) zmaxpyE phi1 scale1r addrC; congr (_ + _).
by rewrite -(zfedE sF alc sG) (zmm_modE l0 pl _ _ _ (leqnn _)).
Qed.
End Feedback.
Lemma zrecursE lz d s N k : (0 < lz)%coqZ -> phi lz = 0 -> zrecurs lz d s N -> (k < N)%N -> phi (zdot d (drop k s)) = 0.
Proof.
move=> l0 pl; elim: N s k => [//|N IH] s [|k] /= /andP[h0 h1] kN; first by rewrite drop0 (phi_eq0 l0 pl).
by rewrite -drop1 in h1; rewrite -addn1 -drop_drop IH.
Qed.

Section Run.
Variables (n : nat) (step : zrow -> zrow) (AF : 'M[R]_n) (c : zrow).
Hypothesis stepE : forall v, cv n (step v) = AF *m cv n v.
Hypothesis cn : (size c <= n)%N.
Definition rowv m (u : zrow) : 'rV[R]_m := \row_j phi (nth z0 u j).
Lemma zrun1 d v : cv n (zrun step c d v).1 = \sum_(j < size d) phi (nth z0 d j) *: krylov AF (cv n v) j.
Proof.
elim: d v => [|d0 d IH] v; first by rewrite big_ord0; apply/matrixP=> i j; rewrite !mxE nth_nil.
rewrite /=; have := IH (step v); case: (zrun _ _ _ _) => tot s /= e; rewrite zaxpyE big_ord_recl e; congr (_ + _).
by apply: eq_bigr => j _; rewrite lift0 stepE krylov_shift.
Qed.
Lemma dot_markov v : phi (zdot c v) = markov AF (cv n v) (rowv n c) 0.
Proof. by rewrite (zdotE _ _ cn) /markov mxE; apply: eq_bigr => j _; rewrite !mxE. Qed.
Lemma zrun2 d v k : (k < size d)%N -> phi (nth z0 (zrun step c d v).2 k) = markov AF (cv n v) (rowv n c) k.
Proof.
elim: d v k => [//|d0 d IH] v k; rewrite /= ltnS; have := IH (step v); case: (zrun _ _ _ _) => tot s /= e kd.
case: k kd => [_|k kd] /=; first exact: dot_markov.
by rewrite e // /markov stepE krylov_shift.
Qed.
Lemma zseqE N v k : (k < N)%N -> phi (nth z0 (zseq step c N v) k) = markov AF (cv n v) (rowv n c) k.
Proof.
elim: N v k => [//|N IH] v [_|k]; first exact: dot_markov.
by rewrite ltnS => /IH /= ->; rewrite /markov stepE krylov_shift.
Qed.
End Run.
(* The numbers of the transposed matrix, by which rows are multiplied. *)
Lemma markov_trmx n (A : 'M[R]_n) b c k : markov A^T c^T b^T k = markov A b c k.
Proof.
have com j : krylov A 1%:M j *m A = A *m krylov A 1%:M j.
  by elim: j => [|j IH]; rewrite ?mulmx1 ?mul1mx // !krylovS -mulmxA IH.
have tr : (krylov A^T c^T k)^T = c *m krylov A 1%:M k.
  by elim: k => [|k IH]; rewrite ?mulmx1 ?trmxK // !krylovS trmx_mul trmxK IH -mulmxA com.
have Kb : krylov A 1%:M k *m b = krylov A b k.
  by elim: k {tr} => [|k IH]; rewrite ?mul1mx // !krylovS -mulmxA IH.
by rewrite /markov -Kb mulmxA -tr -[b in RHS]trmxK -trmx_mul [RHS]mxE.
Qed.
End Computed.

Theorem check_krylov_sound (s : zsystem) (c : krylov_witness) : check_krylov s c ->
  forall (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat) (S : multichannel K n p q),
  represents s S -> bounded S (krylov_degree_of c).
Proof.
rewrite /check_krylov => ok K h n m p q S re.
have D0 := represented_D re; have sA := represented_A re; have sBC := represented_channel re.
case: (re) => /and4P[_ _ _ alc] en em ep eq _ _ _; move: ok; rewrite -en; set lz := k_ell c; set i := k_inv c.
set A := zscale_mod _ _ _; set chs := map _ _; set o := nth _ _ _; set cT := zmod _ (zvm _ _); set b := zmod _ (zmv _ _); set L := krylov_degree_of _.
case/andP=> /andP[/Z.ltb_lt l1 /Z.eqb_eq inv] /and5P[/eqP sF sG om /eqP sy] /and5P[bn sAF d0 /Z.eqb_eq ld].
have sd : size (k_d c) = L.+1 by rewrite /L /krylov_degree_of prednK.
case run: (zrun _ _ _ _) => [tot sq] /andP[recs bez].
pose l := modulus_of l1; have l0 := modulus_gt0 l1; pose Zl := [comRingType of 'Z_l]; have pl : phi Zl lz = 0 := phi_modulus l1.
pose SL : multichannel (Zloc l) n p q := local_system l1 D0 inv s n p q.
pose up a d (M : zmat) : 'M[Zloc l]_(a, d) := mx [comRingType of Zloc l] a d M.
pose F (k : 'I_m) := up (p k) (q k) (nth [::] (k_F c) k).
have sc : size chs = m by rewrite size_map em.
have om' : (k_channel c < m)%N by rewrite -sc.
pose oo := Ordinal om'.
pose x : 'cV[Zloc l]_(p oo) := cv [comRingType of Zloc l] _ (k_x c).
pose y : 'rV[Zloc l]_(q oo) := rowv [comRingType of Zloc l] _ (k_y c).
have chE (k : 'I_m) : nth zch0 chs k = reduced lz i (channel s k) by rewrite (nth_map zch0) // -em.
have resR a d M : map_mx (@residue l) (local l1 D0 inv a d M) = mx Zl a d (zscale_mod lz i M) := residue_local l1 D0 inv a d M.
have resU a d M : map_mx (@residue l) (up a d M) = mx Zl a d M := residue_mx l1 a d M.
pose CL := closed_loop SL F; pose AF := map_mx (@residue l) CL.
have alr : all (sized_channel n) chs.
  rewrite all_map; apply: sub_all alc => ch /=; by rewrite /sized_channel /= !shape_scale en.
have alg : all sized_gain (zip chs (k_F c)).
  suff reduce t G : all sized_gain (zip t G) -> all sized_gain (zip (map (reduced lz i) t) G) by apply: reduce.
  by elim: t G => [|ch t IH] [|H G] //= /andP[g /IH ->]; rewrite andbT.
have sA' : shape n n A by rewrite shape_scale.
have AFE : mx Zl n n (zfeedback lz A chs (k_F c)) = AF.
  rewrite (feedbackE l0 pl A alr sF alg) /AF /CL /closed_loop map_mxD resR; congr (_ + _).
  rewrite map_mx_sum sc; apply: eq_bigr => k _.
  by rewrite chE /= -ep -eq !map_mxM !resR resU.
have loopE v : cv Zl n (zvm_mod lz v (zpacked lz (zfeedback lz A chs (k_F c)))) = AF^T *m cv Zl n v.
  apply/matrixP=> t r; rewrite !mxE (zvm_mod_nth l0 pl _ _ sAF); apply: eq_bigr => k _.
  by rewrite -AFE !mxE mulrC.
pose bb : 'cV['Z_l]_n := map_mx (@residue l) (mcB SL oo *m x); pose cc : 'rV['Z_l]_n := map_mx (@residue l) (y *m mcC SL oo).
have oE : o = reduced lz i (channel s oo) by rewrite /o -chE.
have [sB sC] := sBC oo; rewrite -(shape_scale _ _ lz i) in sB; rewrite -(shape_scale _ _ lz i) in sC.
have bE : cv Zl n b = bb.
  rewrite /b (zmodE l0 pl) oE (zmvE _ _ sB) /bb map_mxM resR; congr (_ *m _).
  by apply/matrixP=> r t; rewrite !mxE rmorph_int.
have bT : rowv Zl n b = bb^T by rewrite -bE; apply/matrixP=> r t; rewrite !mxE.
have cT' : cv Zl n cT = cc^T.
  apply/matrixP=> t r; rewrite /cc map_mxM resR !mxE (zmod_nth l0 pl) oE.
  rewrite (zvm_nth _ _ (q := q oo)) //; last by rewrite sy oE eq leqnn.
  by apply: eq_bigr => k _; rewrite !mxE rmorph_int.
have ld1 : phi Zl (last z0 (k_d c)) = 1 by rewrite ld phi1.
have nz : phi Zl (last z0 (k_d c)) != 0 by rewrite ld1 oner_eq0.
have szd : size (pol Zl (k_d c)) = L.+1 by rewrite size_pol.
have monic_d : pol Zl (k_d c) \is monic by rewrite monicE lead_pol // ld1.
have run1 := zrun1 b loopE (k_d c) cT; have run2 k := zrun2 loopE bn (d := k_d c) cT (k := k); rewrite run /= in run1 run2.
rewrite cT' in run1; have {}run2 k : (k < size (k_d c))%N -> phi Zl (nth z0 sq k) = markov AF bb cc k.
  by move/run2; rewrite cT' bT markov_trmx.
have seqE k : residue (markov (closed_loop SL F) (mcB SL oo *m x) (y *m mcC SL oo) k) = markov AF bb cc k by rewrite map_markov.
have rec k : (k.+1 < L)%N -> recurrence (markov AF bb cc) (pol Zl (k_d c)) k = 0.
  move=> kL; case/orP: recs => [tot0|recs].
    have app0 : applied AF^T cc^T (pol Zl (k_d c)) = 0.
      have := zero_modE l0 pl n tot0; rewrite run1 => e0; rewrite /applied szd -sd -[RHS]e0.
      by apply: eq_bigr => j _; rewrite polE.
    transitivity (recurrence (markov AF^T cc^T bb^T) (pol Zl (k_d c)) k).
      by apply: eq_bigr => j _; rewrite markov_trmx.
    rewrite -markov_applied app0 /markov (_ : krylov AF^T 0 k = 0) ?mulmx0 ?mxE //.
    by elim: k {kL} => // k IH; rewrite krylovS IH mulmx0.
  have kL' : (k < L.-1)%N by rewrite -ltnS (ltn_predK kL).
  have := zrecursE l0 pl recs kL'; rewrite (zdotE _ _ (leqnn _)) sd => e; rewrite /recurrence szd -[RHS]e.
  apply: eq_bigr => j _; rewrite polE nth_drop (zseqE loopE bn) ?cT' ?bT ?markov_trmx //.
  by rewrite -addSn leq_add ?(ltnW kL) // -ltnS ltn_ord.
have numE : pol Zl (zmod lz (znum (k_d c) sq)) = numerator (markov AF bb cc) (pol Zl (k_d c)).
  apply/polyP=> k; rewrite polE (zmod_nth l0 pl) znum_nth coef_poly szd sd -pred_Sn; case: ltnP => kd.
    apply: eq_bigr => j kj; rewrite polE run2 // sd.
    by apply: leq_ltn_trans (leq_subr _ _) (ltn_ord j).
  rewrite big1 // => j kj; have := ltn_ord j; rewrite ltnS leqNgt => /negP[].
  exact: leq_ltn_trans kd kj.
have eqb : pol Zl (k_a c) * numerator (markov AF bb cc) (pol Zl (k_d c)) + pol Zl (k_e c) * pol Zl (k_d c) = 1.
  have := pol_zero l0 pl bez; rewrite !pol_axpy !pol_mul numE phi1 mul1r pol_one => /eqP; rewrite addr_eq0 => /eqP e.
  by apply: oppr_inj; rewrite -e phiN1 mulr1 polyCN.
have nE (t t' : nat -> 'Z_l) d : t =1 t' -> numerator t d = numerator t' d.
  by move=> e; apply/polyP=> k; rewrite !coef_poly; case: ifP => // _; apply: eq_bigr => j _; rewrite e.
have E : krylov_certificate (closed_loop SL F) (mcB SL oo *m x) (y *m mcC SL oo) L.
  apply: (@KrylovCertificate l n _ _ _ L (pol Zl (k_d c)) (pol Zl (k_a c)) (pol Zl (k_e c)) monic_d szd).
    by move=> k kL; rewrite -(rec k kL); apply: eq_bigr => j _; rewrite seqE.
  by rewrite (nE _ _ _ seqE).
exact: (local_bounded re erefl (krylov_bounded E h)).
Qed.
