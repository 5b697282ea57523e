(* Facts, rules and runs: the program, and the one theorem about it.

   A run starts with no facts and applies rules, each of which adds one; a rule computes, and may use facts that are
   there by their places.  A fact has a subject: the plant, or what is left of it when the states outside a mask are
   deleted, in turn.  A fact holds if it is true of every system, over every field that contains Q, that the list of
   its subject represents.  `run_sound`: what a run adds holds. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel fixed_bound.
From mcexact.kernel Require Import lists systems residues krylov_rule shrunk_rule coprime_rule blocks_rule.
From mcexact.kernel Require Import hessenberg_rule spectrum_rule loop_rule fixed_rule large_rule regions_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Inductive fact :=
 | Bounded of nat                     (* whatever divides det(xI - A_F) for all F has at most n - L roots *)
 | Fixed of zrow & seq bool & nat     (* p^d divides it for all F, and the pencil of the channels outside T loses d *)
 | Coprime of zrow & zrow
 | Spectrum of zrow                   (* det(xI - A) *)
 | Moved of zrow                      (* some loop has no root of the polynomial as an eigenvalue *)
 | AtMost of zrow & nat               (* p^(e+1) does not divide det(xI - A_F) for all F *)
 | Low of zrow & nat                  (* no pencil loses more than d at a root of p *)
 | AllFixed of zclaim.

Definition meaning (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) (f : fact) : Prop :=
  match f with
  | Bounded L => bounded S L
  | Fixed g T d => (forall F, up K g ^+ d %| char_poly (closed_loop S F)) /\
      (forall lambda, root (up K g) lambda -> (\rank (pencil S (~: channels_at m T) lambda) + d <= n)%N)
  | Coprime f g => coprimep (pol [comRingType of K] f) (pol [comRingType of K] g)
  | Spectrum f => char_poly (mcA S) = up K f
  | Moved g => exists F, coprimep (pol [comRingType of K] g) (char_poly (closed_loop S F))
  | AtMost g e => ~ (forall F, up K g ^+ e.+1 %| char_poly (closed_loop S F))
  | Low g d => forall t lambda, root (up K g) lambda -> (n <= \rank (pencil S t lambda) + d)%N
  | AllFixed c => claim_holds S c end.
Definition holds (s : zsystem) (f : fact) : Prop := forall (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat)
  (S : multichannel K n p q), represents s S -> meaning S f.

Definition subject := seq (seq bool).
Definition resolve (s : zsystem) (t : subject) : zsystem := foldl zpart s t.
Definition env := seq (subject * fact).
Definition premise (e : env) k : subject * fact := nth ([::], Bounded 0) e k.

(* The places of what is known of a factor; the places that its form does not use are not read. *)
Record factor_premises := FactorPremises { y_fixed : nat; y_coprime : nat; y_simple : nat; y_most : nat; y_low : nat;
  y_spectrum : nat; y_exponent : exponent_witness }.
Inductive rule :=
 | RNothing of subject
 | RKrylov of subject & krylov_witness
 | RTwo of subject & two_witness
 | RShrunk of subject & zrow & shrunk_witness & nat
 | RDual of subject & zrow & shrunk_witness & nat   (* a shrunk subspace of the dual system *)
 | RLocal of subject & seq bool & seq bool & zrow & shrunk_witness & nat  (* one of some states, and what they drive *)
 | RLocalDual of subject & seq bool & seq bool & zrow & shrunk_witness & nat
 | RCoprime of zrow & zrow & bezout
 | RBlocks of subject & seq nat & seq nat     (* the block of each state, and for each block the place of its fact *)
 | RSpectrum of subject & zrow & spectrum_witness
 | RMoved of subject & zrow & moved_witness
 | RAtMost of subject & zrow & nat & power_witness
 | RLow of subject & zrow & nat & low_witness
 | RAllBlocks of subject & zclaim & nat & seq factor_premises
 | RAllTwo of subject & zclaim & nat & zrow & nat & seq factor_premises
 | RAllLarge of subject & zclaim & large_witness & seq factor_premises.

Fixpoint part_bounds (e : env) (t : subject) (blk : seq nat) (k : nat) (ps : seq nat) : option nat :=
  if ps is p :: ps' then
    match premise e p, part_bounds e t blk k.+1 ps' with
    | (t', Bounded L), Some L' => if t' == rcons t (block_mask blk k) then Some (L + L')%N else None
    | _, _ => None end
  else Some 0%N.
Definition is_coprime (e : env) k f g : bool := if premise e k is ([::], Coprime f' g') then zeq f' f && zeq g' g else false.
Definition is_fixed s t e k (f : zfactor) : bool := match premise e k with
  | (t', Fixed g T d) => [&& t' == t, zeq g (f_p f), size T == size (zchannels s), f_channels f == map negb T & d == (zn s - f_rank f)%N]
  | _ => false end.
Definition is_exponent t e (f : zfactor) (y : factor_premises) : bool := if f_in_A f is Some a then
  match premise e (y_spectrum y) with (t', Spectrum g) => (t' == t) && check_exponent g (f_p f) a (y_exponent y) | _ => false end else true.
Definition is_known s t e (f : zfactor) (y : factor_premises) : bool :=
  [&& ~~ Z.eqb (last z0 (f_p f)) 0, (f_rank f < zn s)%N, is_fixed s t e (y_fixed y) f & is_exponent t e f y].
Fixpoint all_known s t e (fs : seq zfactor) (ys : seq factor_premises) : bool :=
  match fs, ys with [::], [::] => true | f :: fs', y :: ys' => is_known s t e f y && all_known s t e fs' ys' | _, _ => false end.
Fixpoint all_simple s e (fs : seq zfactor) (ys : seq factor_premises) : bool :=
  match fs, ys with
  | f :: fs', y :: ys' => [&& (1 < size (f_p f))%N, f_most f == (zn s - f_rank f)%N, is_coprime e (y_simple y) (f_p f) (zderivative (f_p f)),
      is_coprime e (y_coprime y) (f_p f) (zproduct fs') & all_simple s e fs' ys']
  | _, _ => true end.
Fixpoint all_separate e (fs : seq zfactor) (ys : seq factor_premises) : bool :=
  match fs, ys with f :: fs', y :: ys' => is_coprime e (y_coprime y) (f_p f) (zproduct fs') && all_separate e fs' ys' | _, _ => true end.
Fixpoint all_most t e (fs : seq zfactor) (ys : seq factor_premises) : bool :=
  match fs, ys with
  | f :: fs', y :: ys' =>
    match premise e (y_most y) with (t', AtMost g k) => [&& t' == t, zeq g (f_p f) & k == f_most f] | _ => false end && all_most t e fs' ys'
  | _, _ => true end.
(* Of all factors with the same rank one fact says that no pencil loses more. *)
Definition same_rank (fs : seq zfactor) (f : zfactor) : zrow := zproduct [seq g <- fs | f_rank g == f_rank f].
Fixpoint all_low s t e (all fs : seq zfactor) (ys : seq factor_premises) : bool :=
  match fs, ys with
  | f :: fs', y :: ys' =>
    match premise e (y_low y) with (t', Low g d) => [&& t' == t, zeq g (same_rank all f) & d == (zn s - f_rank f)%N] | _ => false end &&
    all_low s t e all fs' ys'
  | _, _ => true end.
Definition check_all_blocks s t (e : env) (c : zclaim) pb ys : bool :=
  [&& all_known s t e (c_factors c) ys, all_simple s e (c_factors c) ys, same_up_to_scale (c_poly c) (zproduct (c_factors c)) &
    match premise e pb with
    | (t', Bounded L) => (t' == t) && (zn s <= L + sumn [seq (zn s - f_rank f) * (size (f_p f)).-1 | f <- c_factors c])%N
    | _ => false end].
Definition check_all_two s t (e : env) (c : zclaim) ps g pm ys : bool :=
  [&& all_known s t e (c_factors c) ys, all_most t e (c_factors c) ys && all_low s t e (c_factors c) (c_factors c) ys, same_up_to_scale (c_poly c) (zproduct (c_factors c)),
    match premise e ps with (t', Spectrum f) => (t' == t) && same_up_to_scale f (zpowers (c_factors c) g) | _ => false end &
    match premise e pm with (t', Moved g') => (t' == t) && zeq g' g | _ => false end].

Definition check_all_large s t (e : env) (c : zclaim) w ys : bool :=
  [&& all_known s t e (c_factors c) ys, all_separate e (c_factors c) ys, all_low s t e (c_factors c) (c_factors c) ys,
    same_up_to_scale (c_poly c) (zproduct (c_factors c)) & check_large s (c_factors c) w].

Definition step (s0 : zsystem) (e : env) (r : rule) : option (subject * fact) :=
  match r with
  | RNothing t => Some (t, Bounded 0)
  | RKrylov t c => if check_krylov (resolve s0 t) c then Some (t, Bounded (krylov_degree_of c)) else None
  | RTwo t c => if check_two (resolve s0 t) c then Some (t, Bounded (zn (resolve s0 t))) else None
  | RShrunk t p c d => if check_shrunk (resolve s0 t) p c d then Some (t, Fixed p (b_T c) d) else None
  | RDual t p c d => if check_shrunk (zdual (resolve s0 t)) p c d then Some (t, Fixed p (map negb (b_T c)) d) else None
  | RLocal t Z D p c d => let s := resolve s0 t in
    if check_driven s Z D (b_T c) && check_shrunk (zpart s Z) p c d then Some (t, Fixed p (b_T c) d) else None
  | RLocalDual t Z D p c d => let s := resolve s0 t in
    if check_driven s Z D (map negb (b_T c)) && check_shrunk (zdual (zpart s Z)) p c d then Some (t, Fixed p (map negb (b_T c)) d) else None
  | RCoprime p q c => if check_coprime p q c then Some ([::], Coprime p q) else None
  | RBlocks t blk ps => let s := resolve s0 t in
    if all (fun k => k < size ps)%N blk && check_order s blk
    then if part_bounds e t blk 0 ps is Some L then Some (t, Bounded L) else None else None
  | RSpectrum t f w => let s := resolve s0 t in if check_spectrum (zn s) (zD s) (zA s) f w then Some (t, Spectrum f) else None
  | RMoved t g c => if check_moved (resolve s0 t) g c then Some (t, Moved g) else None
  | RAtMost t g k c => if check_at_most (resolve s0 t) g k c then Some (t, AtMost g k) else None
  | RLow t g d c => if check_low (resolve s0 t) g d c then Some (t, Low g d) else None
  | RAllBlocks t c pb ys => if check_all_blocks (resolve s0 t) t e c pb ys then Some (t, AllFixed c) else None
  | RAllTwo t c ps g pm ys => if check_all_two (resolve s0 t) t e c ps g pm ys then Some (t, AllFixed c) else None
  | RAllLarge t c w ys => if check_all_large (resolve s0 t) t e c w ys then Some (t, AllFixed c) else None end.
Fixpoint run s (e : env) (rs : seq rule) : option env :=
  if rs is r :: rs' then if step s e r is Some f then run s (rcons e f) rs' else None else Some e.

Definition all_hold s (e : env) := forall k, holds (resolve s (premise e k).1) (premise e k).2.

Section Sound.
Variables (s0 : zsystem) (e : env).
Hypotheses (sz : sized_system s0) (ok : all_hold s0 e).

Lemma part_boundsE t blk k ps L : part_bounds e t blk k ps = Some L ->
  exists2 f : nat -> nat, L = (\sum_(i < size ps) f i)%N & forall i, (i < size ps)%N ->
    holds (zpart (resolve s0 t) (block_mask blk (k + i))) (Bounded (f i)).
Proof.
elim: ps k L => [|p ps IH] k L /=; first by case=> <-; exists (fun=> 0%N) => //; rewrite big_ord0.
have := @ok p; case: (premise e p) => t' [L1| | | | | | |] //= hL; case pb: (part_bounds _ _ _ _ _) => [L2|] //.
case: eqP => // et -[<-]; have [f e2 fE] := IH _ _ pb.
exists (fun i => if i is i'.+1 then f i' else L1); first by rewrite big_ord_recl /= -e2.
case=> [_|i]; last by rewrite ltnS => /fE; rewrite addSnnS.
by rewrite addn0; move: hL; rewrite et /resolve foldl_rcons.
Qed.

Lemma is_coprimeP (K : fieldType) (h : {rmorphism rat -> K}) k f g :
  is_coprime e k f g -> coprimep (pol [comRingType of K] f) (pol [comRingType of K] g).
Proof.
have := @ok k; rewrite /is_coprime; case: (premise e k) => -[|? ?] [| |f' g'| | | | |] //= c /andP[/zeqP <- /zeqP <-].
exact: (c K h _ _ _ _ _ (system_of_represents K sz)).
Qed.

Variables (t : subject) (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Notation s := (resolve s0 t).
Hypothesis re : represents s S.

Lemma is_knownP f y : is_known s t e f y -> known S f.
Proof.
have en := re_n re; have em := re_m re.
case/and4P=> l0 rk fx ex; split=> //; rewrite ?en //.
- move: fx; rewrite /is_fixed; have := @ok (y_fixed y); case: (premise e _) => t' [|g T d| | | | | |] //= c.
  case/and5P=> /eqP et /zeqP <- /eqP sT /eqP chE /eqP ed F; rewrite et in c; have [dv _] := c K h _ _ _ _ _ re.
  by have <- : d = loss n f by [rewrite ed /loss en].
- move: fx; rewrite /is_fixed; have := @ok (y_fixed y); case: (premise e _) => t' [|g T d| | | | | |] //= c.
  case/and5P=> /eqP et /zeqP <- /eqP sT /eqP -> /eqP ed lambda rt; rewrite et in c; have [_ low] := c K h _ _ _ _ _ re.
  by have <- : d = loss n f by [rewrite ed /loss en]; rewrite channels_at_compl ?sT -?em //; apply: low.
move: ex; rewrite /is_exponent; case: (f_in_A f) => [a|//]; have := @ok (y_spectrum y); case: (premise e _) => t' [| | |g| | | |] //= c.
case/andP=> /eqP et ex; rewrite et in c; rewrite (c K h _ _ _ _ _ re); exact: (check_exponent_sound h ex).
Qed.
Lemma all_knownP fs ys : all_known s t e fs ys -> each (known S) fs /\ size ys = size fs.
Proof. by elim: fs ys => [|f fs IH] [|y ys] //= /andP[/is_knownP kf /IH[kfs ->]]. Qed.

Lemma up_coprime f g : ~~ Z.eqb (last z0 f) 0 -> coprimep (pol [comRingType of K] f) (pol [comRingType of K] g) -> coprimep (up K f) (pol [comRingType of K] g).
Proof. by move=> l0; rewrite (eqp_coprimepl _ (up_eqp h l0)). Qed.
Lemma all_simpleP fs ys : each (known S) fs -> size ys = size fs -> all_simple s e fs ys -> each (simple K n) fs /\ separate K fs.
Proof.
have en := re_n re; elim: fs ys => [|f fs IH] [|y ys] //= [kf kfs] [sy] /and5P[big /eqP most cs cc rest].
have [sf sep] := IH ys kfs sy rest; have l0 := kn_lead kf; split; split=> //; last first.
  by rewrite (eqp_coprimepr _ (zproductE h kfs)); apply: (up_coprime l0); apply: is_coprimeP cc.
split; last by rewrite most /loss en.
have c0 := up_coprime l0 (is_coprimeP h cs); by rewrite (eqp_coprimepr _ (eqp_deriv_up h l0)).
Qed.
Lemma all_separateP fs ys : each (known S) fs -> size ys = size fs -> all_separate e fs ys -> separate K fs.
Proof.
elim: fs ys => [|f fs IH] [|y ys] //= [kf kfs] [sy] /andP[cc /(IH _ kfs sy) sep]; split=> //.
by rewrite (eqp_coprimepr _ (zproductE h kfs)); apply: (up_coprime (kn_lead kf)); apply: is_coprimeP cc.
Qed.
Lemma all_mostP fs ys : size ys = size fs -> all_most t e fs ys ->
  each (fun f => ~ (forall F, up K (f_p f) ^+ (f_most f).+1 %| char_poly (closed_loop S F))) fs.
Proof.
elim: fs ys => [|f fs IH] [|y ys] //= [sy] /andP[am /(IH _ sy) rest]; split=> //.
move: am; have := @ok (y_most y); case: (premise e _) => t' [| | | | |g k| |] //= c /and3P[/eqP et /zeqP <- /eqP <-].
by rewrite et in c; apply: (c K h _ _ _ _ _ re).
Qed.
Lemma root_same_rank fs f lambda : ~~ Z.eqb (last z0 (f_p f)) 0 -> List.In f fs -> root (up K (f_p f)) lambda -> root (up K (same_rank fs f)) lambda.
Proof.
move=> l0 fin; rewrite (eqp_root (up_eqp h l0)) => rt; rewrite /root /up hornerZ mulf_eq0; apply/orP; right.
suff : root (pol [comRingType of K] (same_rank fs f)) lambda by [].
rewrite /same_rank; elim: fs fin => //= g fs IH [->|/IH fin]; first by rewrite eqxx /zproduct /= pol_mul rootM rt.
by case: ifP => // _; rewrite /zproduct /= pol_mul rootM fin orbT.
Qed.
Lemma all_lowP all fs ys : each (known S) all -> (forall f, List.In f fs -> List.In f all) -> size ys = size fs -> all_low s t e all fs ys ->
  each (fun f => forall T lambda, root (up K (f_p f)) lambda -> (n <= \rank (pencil S T lambda) + loss n f)%N) fs.
Proof.
have en := re_n re; move=> kn; elim: fs ys => [|f fs IH] [|y ys] //= inn [sy] /andP[lw /(IH _ (fun g gin => inn g (or_intror gin)) sy) rest].
split=> // T lambda rt.
have fin := inn f (or_introl erefl); have := root_same_rank (kn_lead (each_in kn fin)) fin rt.
move: lw; have := @ok (y_low y); case: (premise e _) => t' [| | | | | |g d|] //= c /and3P[/eqP et /zeqP eg /eqP ed].
have <- : d = loss n f by [rewrite ed /loss en]; rewrite et in c; rewrite -eg; exact: (c K h _ _ _ _ _ re).
Qed.
Lemma check_all_blocksP c pb ys : check_all_blocks s t e c pb ys -> claim_holds S c.
Proof.
have en := re_n re; case/and4P=> /all_knownP[kf sy] /(all_simpleP kf sy)[sf sep] same.
have := @ok pb; case: (premise e pb) => t' [L| | | | | | |] //= bd /andP[/eqP et full]; rewrite et in bd.
by apply: (claim_by_blocks h (bd K h _ _ _ _ _ re) kf sf sep same); rewrite /loss en.
Qed.
Lemma check_all_twoP c ps g pm ys : check_all_two s t e c ps g pm ys -> claim_holds S c.
Proof.
case/and5P=> /all_knownP[kf sy] /andP[/(all_mostP sy) most /(all_lowP kf (fun f => id) sy) low] same.
have := @ok ps; case: (premise e ps) => t' [| | |f| | | |] //= cA /andP[/eqP et sameA]; rewrite et in cA.
have := @ok pm; case: (premise e pm) => t2 [| | | |g'| | |] //= cM /andP[/eqP et2 /zeqP eg]; rewrite et2 eg in cM.
exact: (claim_by_two h (cA K h _ _ _ _ _ re) kf sameA (cM K h _ _ _ _ _ re) most low same).
Qed.
End Sound.

Lemma check_all_largeP s0 e t (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat) (S : multichannel K n p q) c w ys :
  sized_system s0 -> all_hold s0 e -> represents (resolve s0 t) S -> check_all_large (resolve s0 t) t e c w ys -> claim_holds S c.
Proof.
move=> sz ok re /and5P[known' sep low same large].
have each' (K' : fieldType) (h' : {rmorphism rat -> K'}) (S' : multichannel K' n p q) : represents (resolve s0 t) S' ->
    [/\ each (known S') (c_factors c), size ys = size (c_factors c) & separate K' (c_factors c)].
  by move=> re'; have [kf sy] := all_knownP ok h' re' known'; split=> //; exact: (all_separateP sz ok h' kf sy sep).
have [kf sy _] := each' K h S re; apply: (claim_by_confined h kf _ (check_large_most h re large) (all_lowP ok h re kf (fun f => id) sy low) same).
by apply: (check_large_confined h re large) => K' h' S' /each'[].
Qed.

Lemma step_sound s0 e r f : sized_system s0 -> all_hold s0 e -> step s0 e r = Some f -> holds (resolve s0 f.1) f.2.
Proof.
move=> sz ok; case: r => [t|t c|t c|t g c d|t g c d|t Z D g c d|t Z D g c d|f1 g c|t blk ps|t g w|t g c|t g k c|t g d c|t c pb ys|t c ps g pm ys|t c w ys] /=.
- by case=> <- K h n m p q S re; apply: nothing_bounded.
- by case ch: check_krylov => // -[<-] K h n m p q S re; apply: (check_krylov_sound ch h re).
- by case ch: check_two => // -[<-] K h n m p q S re; rewrite /= -(re_n re); apply: (check_two_sound h re ch).
- by case ch: check_shrunk => // -[<-] K h n m p q S re; apply: (check_shrunk_sound h re ch).
- by case ch: check_shrunk => // -[<-] K h n m p q S re; apply: (check_dual_sound h re ch).
- by case: ifP => // /andP[dr ch] -[<-] K h n m p q S re; apply: (check_local_sound h re dr ch).
- by case: ifP => // /andP[dr ch] -[<-] K h n m p q S re; apply: (check_local_dual_sound h re dr ch).
- by case ch: check_coprime => // -[<-] K h n m p q S re; apply: (check_coprime_sound ch h).
- case: ifP => // /andP[few ord]; case pb: part_bounds => [L|] // -[<-] K h n m p q S re.
  have [g -> gE] := part_boundsE ok pb; apply: (blocks_sound re few ord) => i ir n' S' re'.
  exact: (gE i ir K h _ _ _ _ _ re').
- case ch: check_spectrum => // -[<-] K h n m p q S re; case: (re) => _ en _ _ _ eA _ _; rewrite /= eA.
  by have := check_spectrum_sound ch h; rewrite -en.
- by case ch: check_moved => // -[<-] K h n m p q S re; apply: (check_moved_sound h re ch).
- by case ch: check_at_most => // -[<-] K h n m p q S re; apply: (check_at_most_sound h re ch).
- by case ch: check_low => // -[<-] K h n m p q S re; apply: (check_low_sound h re ch).
- by case ch: check_all_blocks => // -[<-] K h n m p q S re; apply: (check_all_blocksP sz ok h re ch).
- by case ch: check_all_two => // -[<-] K h n m p q S re; apply: (check_all_twoP ok h re ch).
by case ch: check_all_large => // -[<-] K h n m p q S re; exact: (check_all_largeP h sz ok re ch).
Qed.

Theorem run_sound s rs e e' : sized_system s -> all_hold s e -> run s e rs = Some e' -> all_hold s e'.
Proof.
move=> sz; elim: rs e => [e ok [<-]//|r rs IH e ok] /=; case st: step => [f|//]; apply: IH => k.
rewrite /premise nth_rcons; case: ltnP => _; first exact: (@ok k).
case: eqP => _; first exact: (step_sound sz ok st).
by move=> K h n m p q S _; apply: nothing_bounded.
Qed.
Lemma start_holds s : all_hold s [::].
Proof. by move=> k K h n m p q S re; rewrite /premise nth_nil; apply: nothing_bounded. Qed.

(* The kind fixed_spectrum: the rules are applied, and the last fact is the claim, about the plant itself. *)
Definition fixed_spectrum_of (e : env) : option zclaim := if last ([::], Bounded 0) e is ([::], AllFixed c) then Some c else None.
Definition check_fixed_spectrum (s : zsystem) (rs : seq rule) : option zclaim :=
  if sized_system s then if run s [::] rs is Some e then fixed_spectrum_of e else None else None.
Theorem check_fixed_spectrum_sound s rs c : check_fixed_spectrum s rs = Some c ->
  forall (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat) (S : multichannel K n p q), represents s S -> claim_holds S c.
Proof.
rewrite /check_fixed_spectrum; case: ifP => // sz; case rn: run => [e|] //; have ok := run_sound sz (@start_holds s) rn.
rewrite /fixed_spectrum_of -nth_last -/(premise e (size e).-1); have := @ok (size e).-1; case: (premise _ _) => -[|? ?] [| | | | | | |c'] //= hc [<-].
exact: hc.
Qed.
(* For the plant of the list itself. *)
Corollary check_fixed_spectrum_plant s rs c : check_fixed_spectrum s rs = Some c ->
  forall (K : fieldType) (h : {rmorphism rat -> K}), claim_holds (system_of K s) c.
Proof.
move=> ok K h; apply: (check_fixed_spectrum_sound ok h); apply: system_of_represents.
by move: ok; rewrite /check_fixed_spectrum; case: ifP.
Qed.

(* The whole claim, with what it says of the complex plane, over every closed field with a conjugation and a norm. *)
Definition check_whole (s : zsystem) (rs : seq rule) (g : zregions) : option zclaim :=
  if check_fixed_spectrum s rs is Some c then if check_regions c g then Some c else None else None.
Theorem check_whole_sound s rs g c : check_whole s rs g = Some c ->
  (forall (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat) (S : multichannel K n p q), represents s S -> claim_holds S c) /\
  (forall (C : numClosedFieldType) n m (p q : 'I_m -> nat) (S : multichannel C n p q), represents s S -> regions_hold S c g).
Proof.
rewrite /check_whole; case ok: check_fixed_spectrum => [c'|] //; case: ifP => // reg -[<-].
split; first exact: check_fixed_spectrum_sound ok.
move=> C n m p q S re; apply: check_regions_sound reg.
exact: (check_fixed_spectrum_sound ok [rmorphism of ratr] re).
Qed.
Corollary check_whole_plant s rs g c : check_whole s rs g = Some c ->
  (forall (K : fieldType) (h : {rmorphism rat -> K}), claim_holds (system_of K s) c) /\
  (forall C : numClosedFieldType, regions_hold (system_of C s) c g).
Proof.
move=> ok; have sz : sized_system s by move: ok; rewrite /check_whole /check_fixed_spectrum; case: ifP.
have [h1 h2] := check_whole_sound ok; split=> [K h|C]; [apply: (h1 K h) | apply: h2]; exact: system_of_represents.
Qed.
