(* Rules about one closed loop modulo l, checker/core/evidence.py, TwoPolynomials: det(xI - A_F) modulo l is coprime to
   another polynomial, or not divisible by a power.  The matrix of the loop is computed, its polynomial by
   hessenberg_rule.v. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence fixed_spectrum fixed_bound.
From mcexact.kernel Require Import lists systems residues krylov_rule hessenberg_rule coprime_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Record loop_witness := LoopWitness { w_ell : Z; w_inv : Z; w_gains : seq zmat; w_similar : similar }.
Definition loop_residues (s : zsystem) (w : loop_witness) : zmat :=
  zfeedback (w_ell w) (zscale_mod (w_ell w) (w_inv w) (zA s)) [seq reduced (w_ell w) (w_inv w) ch | ch <- zchannels s] (w_gains w).
Definition sized_loop (s : zsystem) (w : loop_witness) : bool :=
  [&& inverse_modulo (w_ell w) (zD s) (w_inv w), size (w_gains w) == size (zchannels s) & all sized_gain (zip (zchannels s) (w_gains w))].
Definition check_loop (s : zsystem) (w : loop_witness) : bool :=
  sized_loop s w && check_similar (w_ell w) (zn s) (loop_residues s w) (w_similar w).
Definition loop_polynomial (s : zsystem) (w : loop_witness) : zrow := zchar (w_ell w) (h_H (w_similar w)) (zn s).

(* A loop that moves all roots of g: u g + v det(xI - A_F) = 1 modulo l. *)
Record moved_witness := MovedWitness { mv_loop : loop_witness; mv_inv : Z; mv_u : zrow; mv_v : zrow }.
Definition check_moved (s : zsystem) (g : zrow) (c : moved_witness) : bool :=
  let l := w_ell (mv_loop c) in
  [&& check_loop s (mv_loop c), inverse_modulo l (last z0 g) (mv_inv c) &
      bezout_modulo l (mv_u c) g (mv_v c) (loop_polynomial s (mv_loop c))].
(* A loop that moves every eigenvalue of A. *)
Record two_witness := TwoWitness { tw_loop : loop_witness; tw_similar : similar; tw_u : zrow; tw_v : zrow }.
Definition check_two (s : zsystem) (c : two_witness) : bool :=
  let: (l, i) := (w_ell (tw_loop c), w_inv (tw_loop c)) in
  [&& check_loop s (tw_loop c), check_similar l (zn s) (zscale_mod l i (zA s)) (tw_similar c) &
      bezout_modulo l (tw_u c) (zchar l (h_H (tw_similar c)) (zn s)) (tw_v c) (loop_polynomial s (tw_loop c))].
(* p^(e+1) does not divide f: this is p^e (q p + r) modulo l, r of less degree than p, with a coefficient that is a unit. *)
Record power := Power { pw_inv : Z; pw_q : zrow; pw_r : zrow; pw_place : nat; pw_unit : Z }.
Definition zmonic (l i : Z) (p : zrow) : zrow := head [::] (zscale_mod l i [:: p]).
Definition check_power (l : Z) (f p : zrow) (e : nat) (c : power) : bool :=
  let monic := zmonic l (pw_inv c) p in
  [&& Z.ltb 0 (last z0 p), inverse_modulo l (last z0 p) (pw_inv c), (size (pw_r c) < size p)%N,
      inverse_modulo l (nth z0 (pw_r c) (pw_place c)) (pw_unit c) &
      zero_mod l (zaxpy (-1) (zpmul (zppow monic e) (zaxpy 1 (zpmul (pw_q c) monic) (pw_r c))) f)].
Record power_witness := PowerWitness { pw_loop : loop_witness; pw_power : power }.
Definition check_at_most (s : zsystem) (p : zrow) (e : nat) (c : power_witness) : bool :=
  check_loop s (pw_loop c) && check_power (w_ell (pw_loop c)) (loop_polynomial s (pw_loop c)) p e (pw_power c).
(* No root of p is an eigenvalue of A_F + B0 C0, with d columns and rows. *)
Record low_witness := LowWitness { lw_loop : loop_witness; lw_B0 : zmat; lw_C0 : zmat; lw_inv : Z; lw_u : zrow; lw_v : zrow }.
Definition completed (s : zsystem) (c : low_witness) : zmat :=
  zmat_mod (w_ell (lw_loop c)) (zmaxpy 1 (zmm (lw_B0 c) (lw_C0 c)) (loop_residues s (lw_loop c))).
Definition check_low (s : zsystem) (p : zrow) (d : nat) (c : low_witness) : bool :=
  let l := w_ell (lw_loop c) in
  [&& sized_loop s (lw_loop c), (size (lw_C0 c) <= d)%N, ~~ Z.eqb (last z0 p) 0, check_similar l (zn s) (completed s c) (w_similar (lw_loop c)),
      inverse_modulo l (last z0 p) (lw_inv c) &
      bezout_modulo l (lw_u c) p (lw_v c) (zchar l (h_H (w_similar (lw_loop c))) (zn s))].

Lemma map_up (K : fieldType) (h : {rmorphism rat -> K}) g : map_poly h (up [fieldType of rat] g) = up K g.
Proof. by rewrite /up map_polyZ fmorphV map_phi map_pol. Qed.
(* The monic polynomial of a list, over the rationals with denominators prime to l. *)
Lemma local_monic lz (l1 : (1 < lz)%coqZ) g i : (0 < last z0 g)%coqZ -> inverse_modulo lz (last z0 g) i ->
  exists P : {poly Zloc (modulus_of l1)}, [/\ P \is monic, map_poly (@residue _) P = pol [comRingType of 'Z_(modulus_of l1)] (zmonic lz i g) &
    map_poly (@Zloc_rat _) P = up [fieldType of rat] g].
Proof.
move=> g0 /andP[_ /Z.eqb_eq inv]; pose l := modulus_of l1; pose h := [rmorphism of @idfun rat].
have gnz : ~~ Z.eqb (last z0 g) 0 by apply/negP => /Z.eqb_eq e0; move: (g0); rewrite e0.
pose P : {poly Zloc l} := \poly_(t < size g) ToZloc (ratz_integral l1 g0 inv (nth z0 g t)).
have Pt t : P`_t = ToZloc (ratz_integral l1 g0 inv (nth z0 g t)).
  rewrite coef_poly; case: ltnP => // gt; apply: val_inj; by rewrite /= /ratz nth_default // mul0r.
have ratP : map_poly (@Zloc_rat l) P = up [fieldType of rat] g.
  apply/polyP=> t; rewrite coef_map Pt upE.
  have := into_local l1 g0 inv h 1 t.+1 [:: g] => /matrixP/(_ 0 ord_max); by rewrite !mxE.
exists P; split=> //.
  rewrite monicE -(inj_eq (@Zloc_rat_inj l)) rmorph1 -(monicP (up_monic h gnz)) -ratP lead_coef_map_inj ?rmorph0 //.
  exact: Zloc_rat_inj.
apply/polyP=> t; rewrite coef_map Pt polE.
have := residue_local l1 g0 inv 1 t.+1 [:: g] => /matrixP/(_ 0 ord_max); by rewrite !mxE.
Qed.

Section Loop.
Variables (s : zsystem) (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Let D0 := represented_D re.

Section Witness.
Variable w : loop_witness.
Hypothesis ok : sized_loop s w.
Lemma loop_modulus : (1 < w_ell w)%coqZ. Proof. by case/and3P: ok => /andP[/Z.ltb_lt]. Qed.
Notation l := (modulus_of loop_modulus).
Notation Zl := [comRingType of 'Z_l].
Lemma loop_inverse : ((w_inv w * zD s) mod w_ell w = 1)%coqZ. Proof. by case/and3P: ok => /andP[_ /Z.eqb_eq]. Qed.
Definition loop_system : multichannel (Zloc l) n p q := local_system loop_modulus D0 loop_inverse s n p q.
Definition loop_gains : gains (Zloc l) p q := fun k => mx [comRingType of Zloc l] (p k) (q k) (nth [::] (w_gains w) k).
Lemma loop_residuesE : map_mx (@residue l) (closed_loop loop_system loop_gains) = mx Zl n n (loop_residues s w).
Proof.
case: (re) => /and4P[_ _ _ alc] en em ep eq _ _ _; case/and3P: (ok) => _ /eqP sF sG.
rewrite (feedbackE (modulus_gt0 loop_modulus) (phi_modulus loop_modulus)) ?size_map //; last first.
- suff reduce t G : all sized_gain (zip t G) -> all sized_gain (zip (map (reduced (w_ell w) (w_inv w)) t) G) by apply: reduce.
  by elim: t G => [|ch t IH] [|H G] //= /andP[g /IH ->]; rewrite andbT.
- by rewrite all_map; apply: sub_all alc => ch; rewrite /= /sized_channel /= !shape_scale en.
rewrite /closed_loop map_mxD residue_local; congr (_ + _); rewrite map_mx_sum -em; apply: eq_bigr => k _.
rewrite (nth_map zch0) -?em //= -/(channel s k) -ep -eq !map_mxM !residue_local; congr (_ *m _ *m _).
exact: residue_mx.
Qed.
Lemma residue_char (M : 'M[Zloc l]_n) A v : map_mx (@residue l) M = mx Zl n n A -> check_similar (w_ell w) n A v ->
  map_poly (@residue l) (char_poly M) = pol Zl (zchar (w_ell w) (h_H v) n).
Proof. by move=> e okS; rewrite map_char_poly e (check_similar_sound loop_modulus okS). Qed.
(* Coprime modulo l to the polynomial of a matrix, hence over K. *)
Lemma residue_coprime (M : 'M[Zloc l]_n) A v g i u t : map_mx (@residue l) M = mx Zl n n A -> check_similar (w_ell w) n A v ->
  inverse_modulo (w_ell w) (last z0 g) i -> bezout_modulo (w_ell w) u g t (zchar (w_ell w) (h_H v) n) ->
  coprimep (pol [comRingType of K] g) (char_poly (map_mx (into h) M)).
Proof.
move=> e okS /andP[_ /Z.eqb_eq inv] /(bezout_moduloP loop_modulus); rewrite -(residue_char e okS) -(residue_pol loop_modulus g) => bez.
have u1 : phi Zl (last z0 g) \is a GRing.unit by apply/unitrPr; exists (phi _ i); rewrite mulrC (inverse_unit loop_modulus inv).
have nz : phi [comRingType of Zloc l] (last z0 g) != 0.
  by apply: contraTneq u1 => e0; rewrite -(residue_phi loop_modulus) e0 rmorph0 unitr0.
have ul : unit_lead (pol [comRingType of Zloc l] g) by rewrite /unit_lead lead_pol // residue_phi.
by have := coprime_modulo h ul bez; rewrite into_pol map_char_poly.
Qed.
Definition field_gains : gains K p q := fun k => map_mx (into h) (loop_gains k).
Lemma field_loop : map_mx (into h) (closed_loop loop_system loop_gains) = closed_loop S field_gains.
Proof. by rewrite map_loop_into (local_loop loop_modulus D0 loop_inverse h re erefl). Qed.
End Witness.

Theorem check_moved_sound g c : check_moved s g c ->
  exists F : gains K p q, coprimep (pol [comRingType of K] g) (char_poly (closed_loop S F)).
Proof.
case/and3P=> /andP[ok okS] inv bez; rewrite /loop_polynomial -(re_n re) in okS bez.
by exists (field_gains ok); rewrite -field_loop; exact: (residue_coprime (loop_residuesE ok) okS inv bez).
Qed.

Theorem check_two_sound c : check_two s c -> bounded S n.
Proof.
case/and3P=> /andP[ok okS] okA; rewrite /loop_polynomial -(re_n re) in okS okA * => /(bezout_moduloP (loop_modulus ok)) bez.
have eA : map_mx (@residue (modulus_of (loop_modulus ok))) (mcA (loop_system ok)) = mx _ n n (zscale_mod (w_ell (tw_loop c)) (w_inv (tw_loop c)) (zA s)).
  exact: residue_local.
rewrite -(residue_char (loop_residuesE ok) okS) -(residue_char eA okA) in bez.
have bd := @coprime_bounded _ _ _ _ _ (loop_system ok) _ h (loop_gains ok) _ _ bez.
exact: (local_bounded re erefl bd).
Qed.

Theorem check_power_sound w g e c : check_loop s w -> check_power (w_ell w) (loop_polynomial s w) g e c ->
  ~ (forall F : gains K p q, up K g ^+ e.+1 %| char_poly (closed_loop S F)).
Proof.
case/andP=> ok okS /and5P[/Z.ltb_lt g0 invg sr nzr ze] all; rewrite /loop_polynomial -(re_n re) in okS ze.
have gnz : ~~ Z.eqb (last z0 g) 0 by apply/negP => /Z.eqb_eq e0; move: (g0); rewrite e0.
set l1 := loop_modulus ok; pose l := modulus_of l1; pose Zl := [comRingType of 'Z_l].
have [P [mP resP ratP]] := local_monic l1 g0 invg.
have intoP : map_poly (into h) P = up K g by rewrite map_poly_into ratP map_up.
have := all (field_gains ok); rewrite -field_loop -map_char_poly -intoP.
apply/negP; apply: (multiplicity_at_most h mP) => -[r].
rewrite (residue_char (loop_residuesE ok) okS) resP.
have := pol_zero (modulus_gt0 l1) (phi_modulus l1) ze; rewrite pol_axpy pol_mul pol_pow pol_axpy pol_mul phi1 phiN1 polyCN mulN1r mul1r.
move/eqP; rewrite addrC subr_eq0 => /eqP ->; rewrite -resP; set M := map_poly _ P; have mM : M \is monic by apply: monic_map.
rewrite exprS [r * _]mulrA [RHS]mulrC => /(monic_lreg (monic_exp e mM)); set Q := pol Zl (pw_q c); set R := pol Zl (pw_r c) => /eqP.
rewrite addrC -subr_eq0 -addrA -mulrBl addr_eq0 -mulNr opprB => /eqP eR.
have sM : size M = size g.
  rewrite size_map_poly_id0 ?(monicP mP) ?rmorph1 ?oner_eq0 // -(up_size h gnz) -intoP.
  by rewrite size_map_poly_id0 // (monicP mP) rmorph1 oner_eq0.
have sR : (size R < size M)%N by rewrite sM; apply: leq_ltn_trans sr; rewrite (leq_trans (size_Poly _)) // size_map.
have R0 : R = 0.
  have [e0|nz] := eqVneq (r - Q) 0; first by rewrite eR e0 mul0r.
  have := sR; rewrite eR size_Mmonic // ltnNge; case/negP.
  by rewrite -ltnS prednK ?addn_gt0 ?size_poly_gt0 ?nz // -[X in (X < _)%N]add0n ltn_add2r size_poly_gt0.
have /andP[_ /Z.eqb_eq ui] := nzr; have := inverse_unit l1 ui; rewrite -(polE Zl) -/R R0 coef0 mulr0 => /eqP.
by rewrite eq_sym oner_eq0.
Qed.
Theorem check_at_most_sound g e c : check_at_most s g e c ->
  ~ (forall F : gains K p q, up K g ^+ e.+1 %| char_poly (closed_loop S F)).
Proof. by case/andP; apply: check_power_sound. Qed.

Theorem check_low_sound g d c : check_low s g d c ->
  forall t lambda, root (up K g) lambda -> (n <= \rank (pencil S t lambda) + d)%N.
Proof.
case/and5P=> ok sC g0 okS /andP[inv bez] t lambda rt; rewrite -(re_n re) in okS bez; set l1 := loop_modulus ok; pose l := modulus_of l1.
pose B0 := mx [comRingType of Zloc l] n d (lw_B0 c); pose C0 := mx [comRingType of Zloc l] d n (lw_C0 c).
pose CL := closed_loop (loop_system ok) (loop_gains ok).
have e : map_mx (@residue l) (CL + B0 *m C0) = mx [comRingType of 'Z_l] n n (completed s c).
  rewrite /completed (zmat_modE (modulus_gt0 l1) (phi_modulus l1)) zmaxpyE phi1 scale1r (zmmE _ _ _ _ sC) map_mxD map_mxM.
  by rewrite !residue_mx (loop_residuesE ok) addrC.
have cop := residue_coprime e okS inv bez.
have nr : ~~ eigenvalue (map_mx (into h) (CL + B0 *m C0)) lambda.
  rewrite eigenvalue_root_char; apply/negP => rc; have gp : gcdp (pol [comRingType of K] g) (char_poly (map_mx (into h) (CL + B0 *m C0))) %= 1 by rewrite gcdp_eqp1.
  have : root (gcdp (pol [comRingType of K] g) (char_poly (map_mx (into h) (CL + B0 *m C0)))) lambda.
    by rewrite root_gcd rc andbT -(eqp_root (up_eqp h g0)).
  by rewrite (eqp_root gp) (negPf (root1 _)).
apply: leq_trans (leq_add (loop_rank_pencil S t lambda (field_gains ok)) (leqnn d)); rewrite -(field_loop ok) -/CL.
move: nr; rewrite eigenvalue_rank -leqNgt map_mxD map_mxM opprD addrA => /leq_trans; apply.
apply: leq_trans (mxrank_add _ _) _; rewrite leq_add2l mxrank_opp.
by rewrite (leq_trans (mxrankM_maxl _ _)) // rank_leq_col.
Qed.
End Loop.
