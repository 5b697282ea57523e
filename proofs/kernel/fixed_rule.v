(* The claim of the kind `fixed_spectrum`, checker/core/fixed_modes.py, check_fixed_spectrum: all fixed modes, with their
   multiplicities, ranks and channels; and how it follows from facts about the factors, block by block or by two
   characteristic polynomials.  Where the roots of the factors lie is in regions_rule.v. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel fixed_polynomial fixed_bound.
From mcexact.kernel Require Import lists systems shrunk_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* p over its last coefficient is the factor; f_in_A is its exponent in det(xI - A), where it is claimed. *)
Record zfactor := ZFactor { f_p : zrow; f_in_A : option nat; f_most : nat; f_channels : seq bool; f_rank : nat }.
Record zclaim := ZClaim { c_poly : zrow; c_factors : seq zfactor }.
Definition zproduct (fs : seq zfactor) : zrow := foldr (fun f g => zpmul (f_p f) g) [:: 1%coqZ] fs.

(* f is p^a w, and k w = q p + r with an r other than 0 of less degree than p. *)
Record exponent_witness := ExponentWitness { x_w : zrow; x_q : zrow; x_r : zrow; x_k : Z }.
Definition check_exponent (f p : zrow) (a : nat) (c : exponent_witness) : bool :=
  [&& same_up_to_scale f (zpmul (zppow p a) (x_w c)), ~~ Z.eqb (last z0 p) 0, ~~ Z.eqb (x_k c) 0,
      (size (x_r c) < size p)%N, has (fun x => ~~ Z.eqb x 0) (x_r c) &
      zrow0 (zaxpy (- x_k c) (x_w c) (zaxpy 1 (zpmul (x_q c) p) (x_r c)))].

Section Field.
Variables (K : fieldType) (h : {rmorphism rat -> K}).
Notation phi := (phi [comRingType of K]).
Notation pol := (pol [comRingType of K]).
Notation up := (up K).

Theorem check_exponent_sound f p a c : check_exponent f p a c -> (up p ^+ a %| up f) /\ ~~ (up p ^+ a.+1 %| up f).
Proof.
case/and5P=> same p0 k0 sr /andP[/(has_nthP z0)[t tr nz] ze].
have [f0 g0 e] := same_up_to_scaleP h same; set w := x_w c in same e g0 ze.
have ef : up f %= up p ^+ a * pol w.
  have /eqp_trans : up f %= pol f by rewrite /up eqp_scale // invr_eq0.
  apply; have e1 : pol f %= pol (zpmul (zppow p a) w).
    by apply/eqpP; exists (phi (last z0 (zpmul (zppow p a) w)), phi (last z0 f)) => //=; rewrite g0 f0.
  apply: eqp_trans e1 _; rewrite pol_mul pol_pow eqp_sym eqp_mulr // eqp_exp //; exact: up_eqp.
split; first by rewrite (eqp_dvdr _ ef) dvdp_mulr.
apply/negP; rewrite (eqp_dvdr _ ef) exprSr dvdp_mul2l ?expf_neq0 ?(monic_neq0 (up_monic h p0)) // => dv.
have z := pol_zero0 [comRingType of K] ze; move: z; rewrite !pol_axpy pol_mul phi1 mul1r phiN polyCN mulNr addrC => /eqP.
rewrite subr_eq0 => /eqP eR; have pw : pol p %| pol w by rewrite -(eqp_dvdl _ (up_eqp h p0)).
have dr : pol p %| pol (x_r c).
  have -> : pol (x_r c) = (phi (x_k c))%:P * pol w - pol (x_q c) * pol p by rewrite -eR addrAC subrr add0r.
  by rewrite dvdp_sub ?dvdp_mull.
have sp : size (pol p) = size p by rewrite size_pol // (phi_neq0 h).
have R0 : pol (x_r c) != 0.
  apply: contraNneq (phi_neq0 h nz) => e0; have := polE [comRingType of K] (x_r c) t; by rewrite e0 coef0 => <-.
have := dvdp_leq R0 dr; rewrite sp leqNgt; case/negP; apply: leq_ltn_trans sr.
by rewrite (leq_trans (size_Poly _)) // size_map.
Qed.

Section Claim.
Variables (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Definition loss f := (n - f_rank f)%N.
Definition factor_holds (f : zfactor) : Prop :=
  [/\ ~ (forall F, up (f_p f) ^+ (f_most f).+1 %| char_poly (closed_loop S F)),
      forall lambda, root (up (f_p f)) lambda -> (forall t, (f_rank f <= \rank (pencil S t lambda))%N) /\
        \rank (pencil S (channels_at m (f_channels f)) lambda) = f_rank f &
      if f_in_A f is Some a then up (f_p f) ^+ a %| char_poly (mcA S) /\ ~~ (up (f_p f) ^+ a.+1 %| char_poly (mcA S)) else True].
(* What the claim says: the fixed modes are the roots of its polynomial; and of each factor the largest exponent in
   what divides det(xI - A_F) for all F, the least rank of all pencils, and the channels whose pencil has it. *)
Definition claim_holds (c : zclaim) : Prop :=
  (forall lambda, fixed S lambda <-> root (up (c_poly c)) lambda) /\ (forall f, List.In f (c_factors c) -> factor_holds f).

(* What is known of a factor in both forms. *)
Record known (f : zfactor) : Prop := Known {
  kn_lead : ~~ Z.eqb (last z0 (f_p f)) 0; kn_rank : (f_rank f < n)%N;
  kn_dv : forall F, up (f_p f) ^+ loss f %| char_poly (closed_loop S F);
  kn_pencil : forall lambda, root (up (f_p f)) lambda -> (\rank (pencil S (channels_at m (f_channels f)) lambda) + loss f <= n)%N;
  kn_in_A : if f_in_A f is Some a then up (f_p f) ^+ a %| char_poly (mcA S) /\ ~~ (up (f_p f) ^+ a.+1 %| char_poly (mcA S)) else True }.
Fixpoint each (P : zfactor -> Prop) (fs : seq zfactor) : Prop := if fs is f :: fs' then P f /\ each P fs' else True.
Lemma each_in P fs f : each P fs -> List.In f fs -> P f.
Proof. by elim: fs => //= g fs IH [Pg Pfs] [<-|/(IH Pfs)]. Qed.
Fixpoint separate (fs : seq zfactor) : Prop :=
  if fs is f :: fs' then coprimep (up (f_p f)) (\prod_(g <- fs') up (f_p g)) /\ separate fs' else True.

Lemma zproductE fs : each known fs -> \prod_(f <- fs) up (f_p f) %= pol (zproduct fs).
Proof.
elim: fs => [|f fs IH] /=; first by rewrite big_nil /zproduct /= pol_one eqpxx.
case=> kf /IH e; rewrite big_cons pol_mul; apply: eqp_trans (eqp_mull _ e); apply: eqp_mulr.
exact: up_eqp (kn_lead kf).
Qed.
(* A loop at the rank of lambda I - A_F: the rank that is claimed. *)
Lemma rank_of f lambda : known f -> (forall t, (n <= \rank (pencil S t lambda) + loss f)%N) -> root (up (f_p f)) lambda ->
  (forall t, (f_rank f <= \rank (pencil S t lambda))%N) /\ \rank (pencil S (channels_at m (f_channels f)) lambda) = f_rank f.
Proof.
move=> kf low rt; have e : (f_rank f + loss f = n)%N by rewrite /loss subnKC // ltnW // (kn_rank kf).
split=> [t|]; first by rewrite -(leq_add2r (loss f)) e.
set rk := \rank _; have b1 : (rk + loss f <= f_rank f + loss f)%N by rewrite e; apply: (kn_pencil kf).
have b2 : (f_rank f + loss f <= rk + loss f)%N by rewrite e; apply: low.
by apply/eqP; rewrite eqn_leq; rewrite !leq_add2r in b1 b2; rewrite b1 b2.
Qed.
Lemma loss_gt0 f : known f -> (0 < loss f)%N. Proof. by move=> kf; rewrite subn_gt0 (kn_rank kf). Qed.
Lemma fixed_factor f lambda : known f -> root (up (f_p f)) lambda -> fixed S lambda.
Proof.
move=> kf rt F; rewrite eigenvalue_root_char -dvdp_XsubCl; apply: dvdp_trans (kn_dv kf F).
by rewrite -(prednK (loss_gt0 kf)) exprS dvdp_mulr // dvdp_XsubCl.
Qed.
Lemma root_product lambda fs : root (\prod_(f <- fs) up (f_p f)) lambda -> exists2 f, List.In f fs & root (up (f_p f)) lambda.
Proof.
elim: fs => [|f fs IH]; first by rewrite big_nil (negPf (root1 _)).
rewrite big_cons rootM => /orP[rt|/IH[g gin rt]]; first by exists f; [left|].
by exists g; [right|].
Qed.
Lemma polynomial_roots c : each known (c_factors c) -> same_up_to_scale (c_poly c) (zproduct (c_factors c)) ->
  forall lambda, root (up (c_poly c)) lambda = root (\prod_(f <- c_factors c) up (f_p f)) lambda.
Proof.
move=> kf same lambda; have [f0 g0 e] := same_up_to_scaleP h same.
rewrite (eqp_root (zproductE kf)); have -> : root (up (c_poly c)) lambda = root (pol (c_poly c)) lambda.
  by apply: eqp_root; rewrite /up eqp_scale // invr_eq0.
apply: eqp_root; apply/eqpP; exists (phi (last z0 (zproduct (c_factors c))), phi (last z0 (c_poly c))) => //=; by rewrite g0 f0.
Qed.

Section Blocks.
Definition whole fs := \prod_(f <- fs) up (f_p f) ^+ loss f.
Definition simple f := coprimep (up (f_p f)) (up (f_p f))^`() /\ (1 < size (f_p f))%N /\ f_most f = loss f.

Lemma coprime_powers g fs : coprimep g (\prod_(f <- fs) up (f_p f)) -> coprimep g (whole fs).
Proof.
rewrite /whole; elim: fs => [|f fs IH]; first by rewrite !big_nil.
by rewrite !big_cons !coprimepMr => /andP[cf /IH ->]; rewrite andbT coprimep_expr.
Qed.
Lemma whole_dv fs F : each known fs -> separate fs -> whole fs %| char_poly (closed_loop S F).
Proof.
rewrite /whole; elim: fs => [|f fs IH] /=; first by rewrite big_nil dvd1p.
case=> kf kfs [cf sep]; rewrite big_cons Gauss_dvdp; first by rewrite (kn_dv kf) IH.
by apply: coprimep_expl; apply: coprime_powers.
Qed.
Lemma whole_monic fs : each known fs -> each simple fs ->
  whole fs \is monic /\ size (whole fs) = (sumn [seq (loss f * (size (f_p f)).-1)%N | f <- fs]).+1.
Proof.
rewrite /whole; elim: fs => [|f fs IH] /=; first by rewrite big_nil monic1 size_poly1.
case=> kf kfs [_ sfs]; have [mw sw] := IH kfs sfs; rewrite big_cons.
have mf := up_monic h (kn_lead kf); have me : up (f_p f) ^+ loss f \is monic by apply: monic_exp.
rewrite monicMl ?mw // size_monicM ?monic_neq0 // sw addnS /=; split=> //.
by rewrite -[size (up (f_p f) ^+ _)]prednK ?size_poly_gt0 ?monic_neq0 // size_exp (up_size h (kn_lead kf)) mulnC.
Qed.
Lemma whole_power fs f g k : separate fs -> List.In f fs -> g %| up (f_p f) -> g ^+ k %| whole fs -> g ^+ k %| up (f_p f) ^+ loss f.
Proof.
rewrite /whole; elim: fs => //= f' fs IH [cf sep] fin gf; rewrite big_cons; case: fin => [e|fin].
  subst f'; rewrite Gauss_dvdpl //; apply: coprimep_expl; apply: coprimep_dvdr gf _.
  exact: coprime_powers cf.
rewrite Gauss_dvdpr; first exact: IH.
apply: coprimep_expl; apply: coprimep_expr; rewrite coprimep_sym.
have fg : coprimep (up (f_p f')) (up (f_p f)).
  elim: fs fin cf {IH sep} => //= f'' fs IH; rewrite big_cons coprimepMr => -[->|fin] /andP[c1 c2] //; exact: IH.
exact: coprimep_dvdl gf fg.
Qed.

Theorem claim_by_blocks (c : zclaim) L : bounded S L -> each known (c_factors c) -> each simple (c_factors c) -> separate (c_factors c) ->
  same_up_to_scale (c_poly c) (zproduct (c_factors c)) ->
  (n <= L + sumn [seq (loss f * (size (f_p f)).-1)%N | f <- c_factors c])%N -> claim_holds c.
Proof.
move=> bd kf sf sep same full; set fs := c_factors c in kf sf sep full *; have [mw sw] := whole_monic kf sf.
have fp : fixed_polynomial S (whole fs).
  case: bd => g [g0 top sg]; have Pg : whole fs %| g by apply: top => F; apply: whole_dv.
  split=> [F|D dvD]; first exact: whole_dv.
  suff e : whole fs %= g by rewrite (eqp_dvdr _ e); apply: top.
  rewrite -dvdp_size_eqp // eqn_leq (dvdp_leq g0 Pg) sw -(leq_add2r L) (leq_trans sg) //.
  by rewrite addSn ltnS addnC.
split=> [lambda|f fin].
  rewrite (polynomial_roots kf same); split=> [fx|/root_product[f fin rt]]; last exact: (fixed_factor (each_in kf fin) rt).
  have := (fixed_polynomial_root lambda fp).1 fx; rewrite /whole -/fs; elim: fs {kf sf sep same full mw sw fp fx} => [|f fs IH].
    by rewrite !big_nil.
  rewrite !big_cons !rootM => /orP[|/IH->]; last by rewrite orbT.
  by rewrite /root horner_exp expf_eq0 => /andP[_ ->].
have kn := each_in kf fin; have [cp [big most]] := each_in sf fin; have mf := up_monic h (kn_lead kn); have f0 := monic_neq0 mf.
have s1 : (1 < size (up (f_p f)))%N by rewrite (up_size h (kn_lead kn)).
split; [|move=> lambda rt|exact: kn_in_A kn].
  rewrite most => all; have := proj2 fp _ all => /(whole_power sep fin (dvdpp _)); rewrite dvdp_Pexp2l //.
  by rewrite ltnn.
apply: (rank_of kn _ rt); apply: (fixed_polynomial_rank fp); apply/negP => /(whole_power sep fin _); rewrite dvdp_XsubCl => /(_ rt).
have [R eR] := factor_theorem _ _ rt; set t := 'X - _ in eR *.
have t0 : t != 0 by rewrite polyXsubC_eq0.
rewrite eR exprMn exprS dvdp_mul2r ?expf_neq0 // dvdp_XsubCl /root horner_exp expf_eq0 => /andP[_ Rr].
have := coprimep_root cp rt; rewrite eR derivM hornerD !hornerM (eqP Rr) mul0r addr0.
by rewrite /t hornerXsubC subrr mulr0 eqxx.
Qed.
End Blocks.

(* All fixed modes are roots of the factors, each of which is bounded by itself. *)
Theorem claim_by_confined (c : zclaim) : each known (c_factors c) ->
  (forall lambda, fixed S lambda -> root (\prod_(f <- c_factors c) up (f_p f)) lambda) ->
  each (fun f => ~ (forall F, up (f_p f) ^+ (f_most f).+1 %| char_poly (closed_loop S F))) (c_factors c) ->
  each (fun f => forall t lambda, root (up (f_p f)) lambda -> (n <= \rank (pencil S t lambda) + loss f)%N) (c_factors c) ->
  same_up_to_scale (c_poly c) (zproduct (c_factors c)) -> claim_holds c.
Proof.
move=> kf among most low same; split=> [lambda|f fin].
  by rewrite (polynomial_roots kf same); split=> [/among//|/root_product[f fin rt]]; exact: (fixed_factor (each_in kf fin) rt).
have kn := each_in kf fin; split; [exact: (each_in most fin)|move=> lambda rt|exact: kn_in_A kn].
by apply: (rank_of kn _ rt) => t; apply: (each_in low fin).
Qed.

Section Two.
(* g is what is left of det(xI - A) without the factors, which have the exponents f_in_A there. *)
Definition exponent_in_A f := odflt 0%N (f_in_A f).
Definition zpowers (fs : seq zfactor) (g : zrow) : zrow := foldr (fun f acc => zpmul (zppow (f_p f) (exponent_in_A f)) acc) g fs.
Lemma zpowersE fs g : pol (zpowers fs g) = (\prod_(f <- fs) pol (f_p f) ^+ exponent_in_A f) * pol g.
Proof. by elim: fs => [|f fs IH] /=; rewrite ?big_nil ?mul1r // pol_mul pol_pow IH big_cons mulrA. Qed.

Theorem claim_by_two (c : zclaim) f_A g : char_poly (mcA S) = up f_A -> each known (c_factors c) ->
  same_up_to_scale f_A (zpowers (c_factors c) g) -> (exists F, coprimep (pol g) (char_poly (closed_loop S F))) ->
  each (fun f => ~ (forall F, up (f_p f) ^+ (f_most f).+1 %| char_poly (closed_loop S F))) (c_factors c) ->
  each (fun f => forall t lambda, root (up (f_p f)) lambda -> (n <= \rank (pencil S t lambda) + loss f)%N) (c_factors c) ->
  same_up_to_scale (c_poly c) (zproduct (c_factors c)) -> claim_holds c.
Proof.
move=> eA kf same [F cop] most low; apply: claim_by_confined => // lambda fx.
have rA : root (char_poly (mcA S)) lambda.
  have := fx (fun=> 0); rewrite eigenvalue_root_char /closed_loop big1 ?addr0 // => i _; by rewrite mulmx0 mul0mx.
have rF : root (char_poly (closed_loop S F)) lambda by rewrite -eigenvalue_root_char.
have [f0 g0 e] := same_up_to_scaleP h same.
have : root (pol (zpowers (c_factors c) g)) lambda.
  have -> : root (pol (zpowers (c_factors c) g)) lambda = root (up f_A) lambda; last by rewrite -eA.
  apply: eqp_root; apply: eqp_trans (_ : pol (zpowers (c_factors c) g) %= pol f_A) _; last by rewrite eqp_sym /up eqp_scale // invr_eq0.
  by apply/eqpP; exists (phi (last z0 f_A), phi (last z0 (zpowers (c_factors c) g))) => //=; rewrite f0 g0.
rewrite zpowersE rootM => /orP[|rg]; last by have := coprimep_root cop rg; rewrite (eqP rF) eqxx.
elim: (c_factors c) kf => [|f fs IH] /=; first by rewrite !big_nil.
case=> kn kfs; rewrite !big_cons !rootM => /orP[|/(IH kfs)->]; last by rewrite orbT.
by rewrite /root horner_exp expf_eq0 => /andP[_ rt]; rewrite -[_ == 0]/(root (up (f_p f)) lambda) (eqp_root (up_eqp h (kn_lead kn))) [root _ _]rt.
Qed.
End Two.
End Claim.
End Field.
