(* Subjects: systems made from a plant by constructions, in order.

   `zmade` applies a construction to a list, and `made` to a system as the other theorems define it; what `zsubject`
   makes of a list represents what `subject_of` makes of the system of the list (`subject_represents`), so that what
   is proved of the list is proved of the subject.  A system of unknown sizes is a record with these. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel completeness feedback.
From mcexact.kernel Require Import lists systems fixed_rule regions_rule facts reach_rule arcs_rule setpoint_rule program_rule stacked shared kinds.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Definition zscaled (k : Z) (M : zmat) : zmat := [seq [seq (k * x)%coqZ | x <- r] | r <- M].

(* The system after u_i = F_i y_i + v_i, all F_i over one denominator. *)
Record zgains := ZGains { ga_den : Z; ga_F : seq zmat }.
Definition gain (g : zgains) k : zmat := nth [::] (ga_F g) k.
Definition zterm (s : zsystem) (g : zgains) k : zmat :=
  let ch := nth zch0 (zchannels s) k in zmm (zB ch) (zmm (zblock (zp ch) (zq ch) (gain g k)) (zC ch)).
Definition zterms (s : zsystem) (g : zgains) : zmat :=
  foldr (fun k acc => zmaxpy 1 (zterm s g k) acc) [::] (iota 0 (size (zchannels s))).
Definition zfeedback (s : zsystem) (g : zgains) : zsystem :=
  let k := (zD s * ga_den g)%coqZ in
  ZSystem (zn s) (zD s * k) (zblock (zn s) (zn s) (zmaxpy k (zA s) (zterms s g)))
    [seq ZChannel (zp ch) (zq ch) (zscaled k (zB ch)) (zscaled k (zC ch)) | ch <- zchannels s] (zfeed s).
Definition gains_of (K : fieldType) (g : zgains) m (p q : 'I_m -> nat) : gains K p q := fun i => over K (ga_den g) (p i) (q i) (gain g i).

(* The same system over a smaller denominator. *)
Definition zlowered (g : Z) (s : zsystem) : zsystem :=
  ZSystem (zn s) (zD s / g)%coqZ (zdivs g (zA s)) [seq ZChannel (zp ch) (zq ch) (zdivs g (zB ch)) (zdivs g (zC ch)) | ch <- zchannels s] (zfeed s).
Definition lowerable (g : Z) (s : zsystem) : bool :=
  [&& Z.ltb 0 g, Z.eqb (Z.modulo (zD s) g) 0, divisible g (zA s) & all (fun ch => divisible g (zB ch) && divisible g (zC ch)) (zchannels s)].

Lemma shape_scaled k a b M : shape a b M -> shape a b (zscaled k M).
Proof. by case/andP=> sM al; rewrite /shape size_map sM all_map; apply: sub_all al => r; rewrite /= size_map. Qed.
Lemma scaledE (R : comRingType) k a b M : mx R a b (zscaled k M) = phi R k *: mx R a b M.
Proof.
apply/matrixP=> i j; rewrite !mxE; have [il|il] := ltnP i (size M); last first.
  by rewrite (@nth_default _ [::]) ?size_map // (@nth_default _ [::] M) // nth_nil phi0 mulr0.
rewrite (nth_map [::]) //; have [jl|jl] := ltnP j (size (nth [::] M i)); first by rewrite (nth_map z0) // phiM.
by rewrite nth_default ?size_map // nth_default // phi0 mulr0.
Qed.
Lemma sum_listE (R : comRingType) a b (f : nat -> zmat) k m :
  mx R a b (foldr (fun i acc => zmaxpy 1 (f i) acc) [::] (iota k m)) = \sum_(i < m) mx R a b (f (k + i)%N).
Proof.
elim: m k => [|m IH] k; first by rewrite big_ord0 mx_nil.
rewrite big_ord_recl /= zmaxpyE phi1 scale1r IH addn0; congr (_ + _).
by apply: eq_bigr => i _; rewrite addSnnS.
Qed.
Lemma positive_neq0 (K : fieldType) (h : {rmorphism rat -> K}) d : (0 < d)%coqZ -> phi [comRingType of K] d != 0.
Proof. by move=> d0; apply: (phi_neq0 h); apply/negP => /Z.eqb_eq z; rewrite z in d0. Qed.

Section Constructions.
Variables (K : fieldType) (h : {rmorphism rat -> K}) (s : zsystem) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Notation phi := (phi [comRingType of K]).
Notation mx := (mx [comRingType of K]).

Theorem feedback_represents g : (0 < ga_den g)%coqZ -> represents (zfeedback s g) (feedback S (gains_of K g p q)).
Proof.
move=> e0; have sBC := represented_channel re; have D0 := represented_D re.
case: (re) => /and4P[_ feed _ al] en em ep eq eA eB eC.
have d1 := positive_neq0 h D0; have e1 := positive_neq0 h e0; set d := zD s in D0 d1 *; set e := ga_den g in e0 e1 *.
have k1 : phi (d * e)%coqZ != 0 by rewrite phiM mulf_neq0.
have chE (k : 'I_m) : channel (zfeedback s g) k = ZChannel (zp (channel s k)) (zq (channel s k)) (zscaled (d * e) (zB (channel s k))) (zscaled (d * e) (zC (channel s k))).
  by rewrite /channel (nth_map zch0) // -em.
have back a b M : over K (d * (d * e)) a b (zscaled (d * e) M) = over K d a b M.
  by rewrite /over scaledE scalerA phiM invfM -mulrA mulVf // mulr1.
split=> //=.
- apply/and4P; split=> //=; first by apply/Z.ltb_lt; apply: Z.mul_pos_pos => //; apply: Z.mul_pos_pos.
    exact: shape_block.
  rewrite all_map; apply: sub_all al => ch /andP[sB sC] /=.
  by apply/andP; split; apply: shape_scaled.
- by rewrite size_map.
- by move=> k; rewrite chE ep.
- by move=> k; rewrite chE eq.
- rewrite -en /over zblockE zmaxpyE scalerDr scalerA phiM invfM -mulrA mulVf // mulr1.
  rewrite /closed_loop eA; congr (_ + _); rewrite /zterms sum_listE scaler_sumr -em.
  apply: eq_bigr => i _; have [sB sC] := sBC i; rewrite add0n /zterm -/(channel s i) eB eC /gains_of /over.
  have le : (size (zmm (zblock (zp (channel s i)) (zq (channel s i)) (gain g i)) (zC (channel s i))) <= p i)%N by rewrite size_map size_mkseq ep.
  have le' : (size (zC (channel s i)) <= q i)%N by rewrite (shape_size sC).
  rewrite (zmmE _ _ _ _ le) (zmmE _ _ _ _ le') -(ep i) -(eq i) zblockE.
  rewrite -scalemxAr -!scalemxAl -scalemxAr -scalemxAl !scalerA mulmxA; congr (_ *: _).
  by rewrite !phiM !invfM !mulrA.
- by move=> k; rewrite chE eB back.
by move=> k; rewrite chE eC back.
Qed.

Theorem lowered_represents g : lowerable g s -> represents (zlowered g s) S.
Proof.
case/and4P=> /Z.ltb_lt g0 dg gA gBC; have D0 := represented_D re; have low := lower_over h g0 D0 dg.
case: (re) => /and4P[_ feed sA al] en em ep eq eA eB eC.
have chE (k : 'I_m) : channel (zlowered g s) k = ZChannel (zp (channel s k)) (zq (channel s k)) (zdivs g (zB (channel s k))) (zdivs g (zC (channel s k))).
  by rewrite /channel (nth_map zch0) // -em.
have ok (k : 'I_m) : divisible g (zB (channel s k)) && divisible g (zC (channel s k)).
  by have /(all_nthP zch0) := gBC; apply; rewrite -em.
split=> //=.
- apply/and4P; split=> //=; first by apply/Z.ltb_lt; apply: lower_denominator.
    by rewrite shape_divs.
  by rewrite all_map; apply: sub_all al => ch /andP[sB sC]; rewrite /= /sized_channel /= !shape_divs sB.
- by rewrite size_map.
- by move=> k; rewrite chE ep.
- by move=> k; rewrite chE eq.
- by rewrite low.
- by move=> k; rewrite chE low ?eB //; case/andP: (ok k).
by move=> k; rewrite chE low ?eC //; case/andP: (ok k).
Qed.
End Constructions.

(* A system with its sizes. *)
Record some_system (K : fieldType) := SomeSystem
  { sy_n : nat; sy_m : nat; sy_p : 'I_sy_m -> nat; sy_q : 'I_sy_m -> nat; sy_system : multichannel K sy_n sy_p sy_q }.
Inductive construction :=
 | ToDual
 | ToFeedback of zgains
 | ToNeighbors of seq (seq bool)  (* for each channel, who is heard *)
 | ToMerged of seq (seq bool)     (* for each new channel, which are merged *)
 | ToRestricted of seq bool
 | ToFullOutput of nat
 | ToExtended of seq nat & seq (seq bool) & seq (seq bool)  (* dimensions, whose outputs are heard, and whose states *)
 | ToLowest of Z.                 (* the same system over a smaller denominator *)
Definition made (K : fieldType) (X : some_system K) (c : construction) : some_system K :=
  match c with
  | ToDual => SomeSystem (dual (sy_system X))
  | ToFeedback g => SomeSystem (feedback (sy_system X) (gains_of K g (@sy_p K X) (@sy_q K X)))
  | ToNeighbors N => SomeSystem (neighbor_outputs (sy_system X) (sets_of (sy_m X) N))
  | ToMerged Ts => SomeSystem (merged (sy_system X) (fun k : 'I_(size Ts) => sets_of (sy_m X) Ts k))
  | ToRestricted T => SomeSystem (restricted (sy_system X) (masked T (sy_m X)))
  | ToFullOutput k => SomeSystem (full_output (sy_system X) k)
  | ToExtended k own N =>
    SomeSystem (extended_rows (sy_system X) (fun i : 'I_(sy_m X) => nth 0%N k i) (sets_of (sy_m X) own) (sets_of (sy_m X) N))
  | ToLowest _ => X end.
Definition zmade (s : zsystem) (c : construction) : option zsystem :=
  match c with
  | ToDual => Some (zdual s)
  | ToFeedback g => if Z.ltb 0 (ga_den g) then Some (zfeedback s g) else None
  | ToNeighbors N => if masks s N && (size N == size (zchannels s)) then Some (zneighbors s N) else None
  | ToMerged Ts => if masks s Ts then Some (zmerged s Ts) else None
  | ToRestricted T => if size T == size (zchannels s) then Some (zrestricted s T) else None
  | ToFullOutput k => Some (zfull_output s k)
  | ToExtended k own N =>
    if [&& masks s own, masks s N, size own == size (zchannels s), size N == size (zchannels s) & size k == size (zchannels s)]
    then Some (zextended s k own N) else None
  | ToLowest g => if lowerable g s then Some (zlowered g s) else None end.
Definition subject_of (K : fieldType) (s : zsystem) (cs : seq construction) : some_system K :=
  foldl (@made K) (SomeSystem (system_of K s)) cs.
Fixpoint zsubject (s : zsystem) (cs : seq construction) : option zsystem :=
  if cs is c :: cs' then if zmade s c is Some s' then zsubject s' cs' else None else Some s.

Theorem made_represents (K : fieldType) (h : {rmorphism rat -> K}) s c s' (X : some_system K) :
  zmade s c = Some s' -> represents s (sy_system X) -> represents s' (sy_system (made X c)).
Proof.
move=> + re; case: c => [|g|N|Ts|T|k|k own N|g] /=.
- by case=> <-; apply: dual_represents.
- by case: Z.ltb_spec => // e0 [<-]; apply: (feedback_represents h re e0).
- by case: ifP => // /andP[ok /eqP sN] [<-]; apply: (neighbors_represents re ok sN).
- by case: ifP => // ok [<-]; apply: (merged_represents re ok).
- by case: eqP => // sT [<-]; apply: (restricted_represents re sT).
- by case=> <-; apply: (full_output_represents re h k).
- case: ifP => // /and5P[ok1 ok2 /eqP s1 /eqP s2 /eqP s3] [<-].
  exact: (extended_represents h re ok1 ok2 s1 s2 s3).
by case: ifP => // ok [<-]; apply: (lowered_represents h re ok).
Qed.
Theorem subject_represents (K : fieldType) (h : {rmorphism rat -> K}) s cs s' :
  sized_system s -> zsubject s cs = Some s' -> represents s' (sy_system (subject_of K s cs)).
Proof.
move=> sz; rewrite /subject_of; set X0 := SomeSystem _; have : represents s (sy_system X0) by apply: system_of_represents.
elim: cs s X0 {sz} => [|c cs IH] s X re /=; first by case=> <-.
by case mk: zmade => [s1|//]; apply: IH; apply: made_represents mk re.
Qed.

(* What the kinds say of a subject. *)
Section Subject.
Variables (s : zsystem) (cs : seq construction) (s' : zsystem).
Hypotheses (sz : sized_system s) (mk : zsubject s cs = Some s').
Notation subject K := (sy_system (subject_of K s cs)).
Let re (K : fieldType) (h : {rmorphism rat -> K}) := subject_represents h sz mk.
Corollary fixed_spectrum_subject rs g c : check_whole s' rs g = Some c ->
  (forall (K : fieldType) (h : {rmorphism rat -> K}), claim_holds (subject K) c) /\ (forall C : numClosedFieldType, regions_hold (subject C) c g).
Proof.
case/check_whole_sound=> h1 h2; split=> [K h|C]; first by apply: (h1 K h); apply: re h.
by apply: h2; apply: re [rmorphism of ratr].
Qed.
Corollary controllability_subject c a ev : check_controllability s' c a ev ->
  forall (K : fieldType) (h : {rmorphism rat -> K}), reach_holds (subject K) c.
Proof. by move=> ok K h; apply: (check_controllability_sound ok h); apply: re h. Qed.
Corollary transfer_graph_subject c w : check_graph s' c w -> forall (K : fieldType) (h : {rmorphism rat -> K}), graph_holds (subject K) c.
Proof. by move=> ok K h; apply: (check_graph_sound ok h); apply: re h. Qed.
Corollary completeness_subject ev b : check_complete s' ev = Some b -> complete (subject [fieldType of rat]) <-> b.
Proof. by apply: check_complete_sound; apply: re [rmorphism of idfun]. Qed.
Corollary setpoint_subject d c w : check_setpoint s' d c w -> forall (K : fieldType) (h : {rmorphism rat -> K}), setpoint_holds d (subject K) c.
Proof. by move=> ok K h; apply: (check_setpoint_sound ok h); apply: re h. Qed.
Corollary closed_loop_spectrum_subject f g w : check_open_spectrum s' f g w ->
  forall (K : fieldType) (h : {rmorphism rat -> K}), char_poly (mcA (subject K)) = up K f.
Proof. by move=> ok K h; apply: (check_open_spectrum_sound ok h); apply: re h. Qed.
Corollary stability_subject continuous u v flag f w : check_open_stability s' continuous u v flag f w ->
  forall C : numClosedFieldType, flag <-> (forall z, eigenvalue (mcA (subject C)) z -> within u v continuous z).
Proof. by move=> ok C; apply: (check_open_stability_sound ok); apply: re [rmorphism of ratr]. Qed.
End Subject.
