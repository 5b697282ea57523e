(* The rules that place the roots of a polynomial or the eigenvalues of a matrix, applied to concrete
   ones with every hypothesis discharged. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import location mobius moved_roots root_discs rate_interval real_discs stability instability
  routh_integers sector.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Location: x + 1 is Hurwitz, x - 1 is not; x is Schur, x - 1 is not. *)
Lemma real_XaddC (a : algC) : a \is Num.real -> real_poly ('X - a%:P).
Proof. by move=> ra; rewrite /real_poly rpredB ?polyOverX ?polyOverC. Qed.
Lemma inst_hurwitz : hurwitz ('X - (-1)%:P : {poly algC}).
Proof.
apply/(@is_hurwitzP _ 1); rewrite ?size_XsubC ?lead_coefXsubC ?ltr01//; first by apply: real_XaddC; rewrite rpredN1.
by rewrite /= size_XsubC /= coefB coefX coefC /= sub0r opprK ltr01.
Qed.
Lemma inst_not_hurwitz : ~ hurwitz ('X - 1%:P : {poly algC}).
Proof.
apply/(@is_hurwitzP _ 1); rewrite ?size_XsubC ?lead_coefXsubC ?ltr01//; first by apply: real_XaddC; rewrite rpred1.
by rewrite /= size_XsubC /= coefB coefX coefC /= sub0r oppr_gt0 ltr10.
Qed.
Lemma inst_schur : schur ('X - 0%:P : {poly algC}).
Proof.
apply/(@is_schurP _ 1); rewrite ?size_XsubC ?polyXsubC_eq0//; first by apply: real_XaddC; rewrite rpred0.
by rewrite /= size_XsubC /= !coefB !coefX !coefC /= subrr subr0 normr0 normr1 ltr01.
Qed.
Lemma inst_not_schur : ~ schur ('X - 1%:P : {poly algC}).
Proof.
apply/(@is_schurP _ 1); rewrite ?size_XsubC ?polyXsubC_eq0//; first by apply: real_XaddC; rewrite rpred1.
by rewrite /= size_XsubC /= !coefB !coefX !coefC /= sub0r subr0 normrN normr1 ltxx.
Qed.

(* One step of Routh's and of Schur and Cohn's recursions. *)
Section Steps.
Variable a : algC.
Hypothesis ra : a \is Num.real.
Notation p := ('X - a%:P).
Lemma one_routh_step : hurwitz p <-> 0 < p`_0 /\ hurwitz (routh_step p).
Proof. by apply: routh; rewrite ?size_XsubC ?lead_coefXsubC ?ltr01//; apply: real_XaddC. Qed.
Lemma one_schur_step : schur p <-> `|p`_0| < `|p`_1| /\ schur (schur_step p).
Proof. by apply: schur_cohn; rewrite ?size_XsubC//; apply: real_XaddC. Qed.
End Steps.
Definition inst_routh := (one_routh_step (rpredN1 _)).1 inst_hurwitz.
Lemma inst_not_routh : ~ (0 < ('X - 1%:P : {poly algC})`_0 /\ hurwitz (routh_step ('X - 1%:P : {poly algC}))).
Proof. by move/(one_routh_step (rpred1 _))/inst_not_hurwitz. Qed.
Definition inst_schur_cohn := (one_schur_step (rpred0 _)).1 inst_schur.
Lemma inst_not_schur_cohn :
  ~ (`|('X - 1%:P : {poly algC})`_0| < `|('X - 1%:P)`_1| /\ schur (schur_step ('X - 1%:P : {poly algC}))).
Proof. by move/(one_schur_step (rpred1 _))/inst_not_schur. Qed.

(* A disc about the root of x. *)
Lemma inst_root_discs : exists z : 'I_1 -> algC, forall x, root 'X x <-> exists i, x = z i.
Proof.
have [] := @root_discs [numClosedFieldType of algC] 'X 0 (fun=> 1) (fun=> 1).
- by rewrite size_polyX.
- by move=> _; apply: ler01.
- by move=> _; rewrite hornerX derivX hornerC.
- by move=> i j; rewrite !ord1 eqxx.
by move=> z [_ zP _]; exists z.
Qed.

Lemma inst_root_disc : exists2 z : algC, root 'X z & `|0 - z| <= 0.
Proof.
apply: (@root_disc _ 'X 0); rewrite ?size_polyX ?lexx//.
by rewrite hornerX normr0 expr0n mulr0 mul0r.
Qed.

(* The root -3 in the disc of radius 1 about -2: the rate lies in [1, 3], and so does the modulus. *)
Notation only := (fun x : algC => x = - 3%:R).
Lemma inst_disc (i : 'I_1) : `|- 2%:R - - 3%:R| <= 1 :> algC.
Proof. by rewrite opprK addrC -natrB// normr1. Qed.
Lemma inst_only x : only x <-> exists i : 'I_1, x = - 3%:R.
Proof. by split=> [->|[]//]; exists ord0. Qed.
Lemma two_real : - 2%:R \is (Num.real : {pred algC}). Proof. by rewrite rpredN realn. Qed.
Lemma inst_rate_continuous : (forall x, only x -> 1 <= - 'Re x) /\ (exists2 x, only x & - 'Re x <= 3%:R).
Proof.
apply: (rate_interval_continuous inst_disc inst_only) => [_|]; last exists ord0.
  by rewrite (Creal_ReP _ two_real) opprD opprK addrC -[X in _ <= _ + X]/(1 *+ 2) mulrS addKr.
by rewrite (Creal_ReP _ two_real) opprB opprK -mulrS.
Qed.
Lemma inst_rate_discrete : (exists2 x, only x & 1 <= `|x|) /\ (forall x, only x -> `|x| <= 3%:R).
Proof.
apply: (rate_interval_discrete inst_disc inst_only); rewrite ?rpred1//.
  by exists ord0; right; rewrite normrN normr_nat.
by move=> _; rewrite ler1n normrN normr_nat [in X in _ <= X]mulrS [1 + _ - 1]addrC addKr.
Qed.

(* x^2 + 1 in discs of radius 1/2 about i and -i: no root is real; that of x is. *)
Definition turn (i : 'I_2) : algC := if i == ord0 then 'i else - 'i.
Lemma size_turn : size ('X^2 + 1 : {poly algC}) = 3%N.
Proof. by rewrite size_addl size_polyXn ?size_poly1. Qed.
Lemma root_turn i : ('X^2 + 1 : {poly algC}).[turn i] = 0.
Proof. by rewrite !hornerE /= /turn; case: ifP => _; rewrite ?mulrNN -expr2 sqrCi addNr. Qed.
Lemma inst_not_real : exists z : 'I_2 -> algC, forall i, root ('X^2 + 1) (z i) /\ z i \isn't Num.real.
Proof.
have rp : real_poly ('X^2 + 1 : {poly algC}) by rewrite /real_poly rpredD ?rpredX ?polyOverX ?rpred1.
have half : 0 < 2%:R^-1 :> algC by rewrite invr_gt0 ltr0n.
have [|||z [_ zP _ nr]] := @real_discs _ ('X^2 + 1) 1 turn (fun=> 2%:R^-1) rp size_turn.
- by move=> _; apply: ltW.
- by move=> i; rewrite root_turn normr0 expr0n mulr0 mulr_ge0 ?exprn_ge0// ltW.
- move=> i j ij; rewrite -mulr2n -[_ *+ 2]mulr_natr mulVf ?pnatr_eq0//.
  have -> : `|turn i - turn j| = `|'i *+ 2|.
    by case: i j ij => [[|[|]]] // ? [[|[|]]] // ? _; rewrite /turn /= ?opprK -?opprD ?normrN mulr2n.
  by rewrite -mulr_natr normrM normCi mul1r normr_nat ltr1n.
exists z => i; split; first by apply/zP; exists i.
by apply: nr; rewrite /turn; case: ifP => _; rewrite ?raddfN /= ?normrN Im_i normr1 invf_lt1 ?ltr0n// ltr1n.
Qed.
Lemma inst_real : exists z : 'I_1 -> algC, forall i, root 'X (z i) /\ z i \is Num.real.
Proof.
have rp : real_poly ('X : {poly algC}) by rewrite /real_poly polyOverX.
have [|||z [_ zP re _]] := @real_discs _ 'X 0 (fun=> 0) (fun=> 0) rp (size_polyX _).
- by [].
- by move=> _; rewrite hornerX normr0 expr0n mulr0 mul0r.
- by move=> i j; rewrite !ord1 eqxx.
by exists z => i; split; [apply/zP; exists i | apply/re/real0].
Qed.

(* Lyapunov: M = -1 in continuous time, M = 0 in discrete time, P = R = R2 = 1. *)
Lemma real1 : real_mx (1%:M : 'M[algC]_1). Proof. by move=> i j; rewrite !ord1 mxE eqxx rpred1. Qed.
Lemma dominant1 (a : algC) : 0 < a -> dominant (a%:M : 'M_1).
Proof. by move=> a0 i; rewrite big1 ?ord1 ?mxE ?eqxx// => j; rewrite !ord1 eqxx. Qed.
Lemma inst_dominant_congruence : posdef (1%:M : 'M[algC]_1).
Proof.
apply: (dominant_congruence real1 real1 (trmx1 _ _)).
by rewrite trmx1 !mulmx1; apply: dominant1; apply: ltr01.
Qed.
Lemma inst_lyapunov_continuous lambda : eigenvalue (- 1%:M : 'M[algC]_1) lambda -> 'Re lambda < - 0.
Proof.
have rM : real_mx (- 1%:M : 'M[algC]_1) by move=> i j; rewrite mxE rpredN real1.
apply: (stability_continuous rM real1 real1 real1 (rpred0 _) (trmx1 _ _)).
  by rewrite trmx1 !mulmx1; apply: dominant1; apply: ltr01.
have tN : (- 1%:M : 'M[algC]_1)^T = - 1%:M by apply/matrixP=> i j; rewrite !mxE !ord1.
rewrite mul0rn scale0r addr0 tN trmx1 !mulmx1 !mul1mx opprD opprK.
have -> : 1%:M + 1%:M = (1 + 1)%:M :> 'M[algC]_1 by rewrite raddfD.
by apply: dominant1; rewrite addr_gt0 ?ltr01.
Qed.
Lemma inst_lyapunov_discrete lambda : eigenvalue (0 : 'M[algC]_1) lambda -> `|lambda| < 1.
Proof.
have rM : real_mx (0 : 'M[algC]_1) by move=> i j; rewrite mxE rpred0.
apply: (stability_discrete rM real1 real1 real1 ler01 (trmx1 _ _)).
  by rewrite trmx1 !mulmx1; apply: dominant1; apply: ltr01.
rewrite trmx0 !mul0mx subr0 trmx1 mul1mx mulmx1 expr1n scale1r; apply: dominant1; exact: ltr01.
Qed.
Lemma inst_blocks lambda : eigenvalue (block_mx (0 : 'M[algC]_1) 1%:M 0 (0 : 'M_1)) lambda -> `|lambda| < 1.
Proof.
apply: (@stability_blocks _ 1 1 _ 1%:M 0 1%:M 0 (fun x => `|x| < 1)); first exact: unitmx1.
- by rewrite mulmx1 mul1mx.
- exact: inst_lyapunov_discrete.
- exact: inst_lyapunov_discrete.
Qed.

(* The Moebius transform of a Schur polynomial is Hurwitz; that of x - 1 is not. *)
Lemma nonzero_XsubC (a : algC) : 'X - a%:P != 0. Proof. by rewrite polyXsubC_eq0. Qed.
Definition inst_mobius := ((schur_mobius (nonzero_XsubC 0)).1 inst_schur).2.
Lemma inst_not_mobius :
  ~ (('X - 1%:P : {poly algC}).[-1] != 0 /\ hurwitz (transformed ('X - 1%:P : {poly algC}))).
Proof. by move/(schur_mobius (nonzero_XsubC 1))/inst_not_schur. Qed.

(* The root of x - 3: its modulus is below 4, not below 2; its real part is not below -1. *)
Lemma below4 (z : algC) : root ('X - 3%:R%:P) z -> `|z| < 4%:R.
Proof. by rewrite root_XsubC => /eqP->; rewrite normr_nat ltr_nat. Qed.
Lemma inst_radius_rule : schur (scaled ('X - 3%:R%:P : {poly algC}) 4%:R).
Proof. by apply/(radius_rule _ (ltr0Sn _ 3)); apply: below4. Qed.
Lemma inst_not_radius_rule : ~ schur (scaled ('X - 3%:R%:P : {poly algC}) 2%:R).
Proof.
move/(radius_rule _ (ltr0Sn _ 1))/(_ 3%:R).
by rewrite root_XsubC eqxx normr_nat ltr_nat => /(_ isT).
Qed.
Lemma inst_not_rate_rule : ~ hurwitz (shifted ('X - 3%:R%:P : {poly algC}) 1).
Proof.
move/(rate_rule _ (rpred1 _))/(_ 3%:R); rewrite root_XsubC eqxx => /(_ isT).
rewrite (Creal_ReP _ (realn _ _)) => /lt_le_trans/(_ (le_trans (lerN10 _) (ler0n _ 3))).
by rewrite ltxx.
Qed.

(* Instability: M = 1, P = -1 in continuous time; M = 2, P = -1 in discrete time. *)
Lemma form1 (a : algC) (x : 'cV_1) : form (a%:M : 'M_1) x = `|x 0 0| ^+ 2 * a.
Proof. by rewrite formE !big_ord1 !mxE eqxx mulr1n sqr_norm mulrAC [_^* * _]mulrC. Qed.
Lemma posdef1 (a : algC) : 0 < a -> posdef (a%:M : 'M_1).
Proof.
move=> a0 x nx; rewrite form1 mulr_gt0// exprn_gt0// normr_gt0.
by apply: contra nx => /eqP x0; apply/eqP/matrixP=> i j; rewrite !ord1 x0 mxE.
Qed.
Lemma adjoint1 (a : algC) : a \is Num.real -> adjoint (a%:M : 'M_1) = a%:M.
Proof. by move=> ra; rewrite /adjoint tr_scalar_mx map_scalar_mx /= (CrealP ra). Qed.
Lemma one_neq0 : (1%:M : 'M[algC]_1) != 0.
Proof. by apply/eqP=> /matrixP/(_ 0 0)/eqP; rewrite !mxE oner_eq0. Qed.
Lemma inst_instability_continuous : ~ (forall lambda, eigenvalue (1%:M : 'M[algC]_1) lambda -> 'Re lambda < - 0).
Proof.
apply: (@instability_continuous _ 1 1%:M (-1)%:M 0 1%:M).
- by rewrite adjoint1// rpredN1.
- rewrite mul0rn scale0r addr0 adjoint1 ?rpred1// mul1mx mulmx1 -!raddfD -raddfN; apply: posdef1.
  by rewrite ?opprD !opprK addr_gt0 ?ltr01.
- exact: one_neq0.
- by rewrite form1 mxE eqxx normr1 expr1n mul1r oppr_le0 ler01.
Qed.
Lemma inst_instability_discrete : ~ (forall lambda, eigenvalue (2%:R%:M : 'M[algC]_1) lambda -> `|lambda| < 1).
Proof.
apply: (@instability_discrete _ 1 2%:R%:M (-1)%:M 1 1%:M) => //.
- by rewrite adjoint1// rpredN1.
- rewrite expr1n scale1r adjoint1 ?realn// -!scalar_mxM -raddfB; apply: posdef1.
  by rewrite mulrN1 mulNr opprK addrC subr_gt0 -natrM ltr1n.
- exact: one_neq0.
- by rewrite form1 mxE eqxx normr1 expr1n mul1r oppr_le0 ler01.
Qed.

(* The same rules for complex matrices: P = 1 and M = -1, or M = 0. *)
Lemma inst_lyapunov_posdef lambda : eigenvalue ((-1)%:M : 'M[algC]_1) lambda -> 'Re lambda < - 0.
Proof.
apply: (@lyapunov_continuous _ 1 _ 1%:M); rewrite ?rpred0//; first exact/posdef1/ltr01.
rewrite mul0rn scale0r addr0 adjoint1 ?rpredN1// mul1mx mulmx1 -raddfD -raddfN; apply: posdef1.
by rewrite ?opprD !opprK addr_gt0 ?ltr01.
Qed.
Lemma inst_lyapunov_posdef_discrete lambda : eigenvalue (0%:M : 'M[algC]_1) lambda -> `|lambda| < 1.
Proof.
apply: (@lyapunov_discrete _ 1 _ 1%:M); rewrite ?ler01//; first exact/posdef1/ltr01.
by rewrite raddf0 mulmx0 subr0 expr1n scale1r; apply/posdef1/ltr01.
Qed.

(* A damping ratio: x + 1 has the ratio 1/2, and x - 1 has not; their polynomials are x^2 + 6x + 12 and
   x^2 - 6x + 12.  So have the matrices -1 and 1. *)
Lemma inst_turned (a : rat) : a ^+ 2 = 1 -> turned ('X + a%:P) 1 2%:R = Poly [:: 12%:R; 6%:R * a; 1].
Proof.
move=> a1; have sp : size ('X + a%:P) = 2%N by rewrite size_XaddC.
have pE k : ('X + a%:P)`_k = if k is j.+1 then (j == 0%N)%:R else a by case: k => [|k]; rewrite coefD coefX coefC ?add0r ?addr0.
have eR (h e : rat) : real_part ('X + a%:P) h e = 'X + (a * h)%:P.
  apply/polyP=> k; rewrite coef_poly sp [RHS]coefD coefX coefC.
  by case: k => [|[|k]] //=; rewrite pE /= ?add0r ?addr0 ?mulr0 ?subr0 ?mulr1.
have eO (h e : rat) : other_part ('X + a%:P) h e = a%:P.
  by apply/polyP=> k; rewrite coef_poly sp coefC; case: k => [|[|k]] //=; rewrite pE /= ?mulr0 ?addr0 ?mulr1.
rewrite /turned eR eO; have -> : a * (2%:R ^+ 2 - 1 ^+ 2) = 3%:R * a by rewrite mulrC.
apply/polyP=> k; rewrite coef_Poly sqrrD !coefD coefXn !coefMC coefX coefZ -!polyC_exp !coefC.
case: k => [|[|[|k]]] /=; first by rewrite !mul0r !add0r mulrACA -[a * a]expr2 a1 !mulr1.
- by rewrite !mul1r mul0r mulr0 add0r !addr0 -mulrDl.
- by rewrite !mul0r mulr0 !addr0.
by rewrite !mul0r mulr0 !addr0 nth_nil.
Qed.
Lemma inst_turned_integers (a : rat) (w : int) : a ^+ 2 = 1 -> w%:~R = 6%:R * a ->
  integers_of (turned ('X + a%:P) 1 2%:R) [:: 1; w; 12%:Z].
Proof.
move=> a1 we; rewrite inst_turned//; exists 1, 1; split=> //; first by rewrite (@PolyK _ 0).
by rewrite /lead_coef !(@PolyK _ 0)//; case=> [|[|[|k]]] //= _; rewrite expr1n mulr1 mul1r divr1.
Qed.
Lemma inst_damping (z : algC) : root (map_poly ratr ('X + 1%:P)) z -> damped (ratr (1 / 2%:R)) z.
Proof.
move: z; apply/(@damping_by_integers _ ('X + 1%:P) 1 2%:R [:: 1; 6%:Z; 12%:Z] true) => //.
  by rewrite -size_poly_eq0 size_XaddC.
exact: inst_turned_integers.
Qed.
Lemma inst_not_damping : ~ (forall z : algC, root (map_poly ratr ('X + (-1)%:P)) z -> damped (ratr (1 / 2%:R)) z).
Proof.
apply/(@damping_by_integers _ ('X + (-1)%:P) 1 2%:R [:: 1; - 6%:Z; 12%:Z] false) => //.
  by rewrite -size_poly_eq0 size_XaddC.
exact: inst_turned_integers.
Qed.
Lemma inst_damping_rule (z : algC) : root (turned ('X + 1%:P) 1 2%:R) z -> 'Re z < 0.
Proof.
have r1 : 1 < 2%:R :> algC by rewrite ltr1n.
move: z; apply/(damping_rule _ ltr01 r1) => z rz.
have e : ratr (1 / 2%:R) = 1 / 2%:R :> algC by rewrite fmorph_div rmorph1 rmorph_nat.
by rewrite -e; apply: inst_damping; rewrite rmorphD /= map_polyX map_polyC /= rmorph1.
Qed.
Lemma half01 : 0 < 2%:R^-1 :> algC /\ 2%:R^-1 < 1 :> algC.
Proof. by rewrite invr_gt0 ltr0n invf_lt1 ?ltr0n// ltr1n. Qed.
Lemma eigenvalue_scalar (a lambda : algC) : eigenvalue (a%:M : 'M_1) lambda -> lambda = a.
Proof.
move/eigenvalueP=> [v]; rewrite mul_mx_scalar => /eqP; rewrite -subr_eq0 -scalerBl scaler_eq0.
by case/orP=> [|/eqP-> /eqP //]; rewrite subr_eq0 => /eqP.
Qed.
Lemma inst_damping_matrix mu :
  eigenvalue (lifted ((-1)%:M : 'M[algC]_1) (2%:R^-1 ^+ 2 / (1 - 2%:R^-1 ^+ 2))) mu -> 'Re mu < 0.
Proof.
move: mu; apply/(damping_matrix _ half01.1 half01.2) => lambda /eigenvalue_scalar ->.
by rewrite /damped normrN1 mulr1 raddfN /= (Creal_ReP _ (rpred1 _)) ltr_oppl opprK half01.2.
Qed.
Lemma inst_not_damping_matrix : ~ (forall mu,
  eigenvalue (lifted (1%:M : 'M[algC]_1) (2%:R^-1 ^+ 2 / (1 - 2%:R^-1 ^+ 2))) mu -> 'Re mu < 0).
Proof.
move/(damping_matrix _ half01.1 half01.2)/(_ 1) => h.
have e : eigenvalue (1%:M : 'M[algC]_1) 1.
  by apply/eigenvalueP; exists 1%:M; [rewrite mulmx1 scale1r | exact: one_neq0].
move: (h e); rewrite /damped normr1 mulr1 (Creal_ReP _ (rpred1 _)) => l.
by have := lt_trans l (_ : - 2%:R^-1 < 0); rewrite oppr_lt0 half01.1 ltr10 => /(_ isT).
Qed.
