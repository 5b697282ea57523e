(* krylov.md: one Krylov sequence of one closed loop, modulo l, bounds the fixed polynomial.

   b = B_o x and c = y C_o are an input and an output of one channel o; A_F' = A_F + b c for F' = F but
   F'_o = F_o + x y.  The certificate holds modulo l, which need not be prime; the data are rationals whose
   denominators are prime to l, and h embeds Q into any field K. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import fixed_spectrum krylov_sequence gauss fixed_polynomial fixed_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Lemma map_response (R R' : comRingType) (f : {rmorphism R -> R'}) n (A : 'M[R]_n) b c :
  map_poly f (response A b c) = response (map_mx f A) (map_mx f b) (map_mx f c).
Proof.
have fC a d (M : 'M[R]_(a, d)) : map_mx (map_poly f) (map_mx polyC M) = map_mx polyC (map_mx f M).
  by apply/matrixP=> i j; rewrite !mxE map_polyC.
by rewrite /response /transfer -[in RHS]map_char_poly_mx -!fC -map_mx_adj -!map_mxM [RHS]mxE.
Qed.

(* Modulo l: d monic of degree L, a recurrence of s_k = c A^k b for k < L - 1, coprime to its numerator. *)
Record krylov_certificate (l : modulus) n (A : 'M[Zloc l]_n) (b : 'cV_n) (c : 'rV_n) (L : nat) := KrylovCertificate {
  kc_d : {poly 'Z_l}; kc_a : {poly 'Z_l}; kc_e : {poly 'Z_l};
  kc_monic : kc_d \is monic;
  kc_degree : size kc_d = L.+1;
  kc_recurrence : forall k, (k.+1 < L)%N -> recurrence (fun k => residue (markov A b c k)) kc_d k = 0;
  kc_comaximal : kc_a * numerator (fun k => residue (markov A b c k)) kc_d + kc_e * kc_d = 1 }.

Section Pair.
Variables (l : modulus) (n : nat) (A : 'M[Zloc l]_n) (b : 'cV[Zloc l]_n) (c : 'rV[Zloc l]_n) (L : nat).
Notation res := (map_poly (@residue l)).
Notation resM := (map_mx (@residue l)).
Notation seq := (fun k => residue (markov A b c k)).
Notation seqM := (markov (resM A) (resM b) (resM c)).

Lemma residue_recurrence d k : recurrence seq d k = recurrence seqM d k.
Proof. by apply: eq_bigr => j _; rewrite map_markov. Qed.
Lemma residue_numerator d : numerator seq d = numerator seqM d.
Proof. by apply: eq_poly => i; apply: eq_bigr => j _; rewrite map_markov. Qed.
Lemma residue_char : char_poly (resM A) = res (char_poly A).
Proof. by rewrite map_char_poly. Qed.

(* The common divisors of det(xI - A) and det(xI - A - b c) have degrees at most n - L. *)
Theorem krylov_common (E : krylov_certificate A b c L) (K : fieldType) (h : {rmorphism rat -> K}) D :
  D %| map_poly (into h) (char_poly A) -> D %| map_poly (into h) (char_poly (A + b *m c)) ->
  (size D + L <= n.+1)%N.
Proof.
case: E => d a e md sd rec bez; rewrite char_poly_rank_one rmorphB /= => dC dvB.
have dN : D %| map_poly (into h) (response A b c) by rewrite -(dvdp_subr _ dC).
pose up := map_poly (@Zloc_rat l); pose g := gcdp (up (char_poly A)) (up (response A b c)).
have mC : up (char_poly A) \is monic by rewrite monic_map// char_poly_monic.
have g0 : g != 0 by rewrite gcdp_eq0 (negPf (monic_neq0 mC)).
have sD : (size D <= size g)%N.
  rewrite -(size_map_poly h); apply: dvdp_leq; first by rewrite map_poly_eq0.
  by rewrite gcdp_map dvdp_gcd -!map_poly_into dC.
pose P := (lead_coef g)^-1 *: g; have sP : size P = size g by rewrite size_scale ?invr_eq0 ?lead_coef_eq0.
have mP : P \is monic by rewrite monicE lead_coefZ mulVf// lead_coef_eq0.
have Pg : P %| g by rewrite dvdpZl ?invr_eq0 ?lead_coef_eq0.
have [P' mP' eP] := monic_factor mP (char_poly_monic A) (dvdp_trans Pg (dvdp_gcdl _ _)).
have idE (r : {poly Zloc l}) : map_poly (into [rmorphism of @idfun rat]) r = map_poly (@Zloc_rat l) r by [].
have [r er] : exists r, char_poly A = r * P'.
  by apply: (@monic_divides _ _ [rmorphism of @idfun rat]) => //; rewrite !idE -eP (dvdp_trans Pg)// dvdp_gcdl.
have [r' er'] : exists r, response A b c = r * P'.
  by apply: (@monic_divides _ _ [rmorphism of @idfun rat]) => //; rewrite !idE -eP (dvdp_trans Pg)// dvdp_gcdr.
have sP' : size (res P') = size g.
  rewrite size_map_poly_id0 ?(monicP mP') ?rmorph1 ?oner_eq0//.
  by rewrite -sP eP size_map_poly_id0// (monicP mP') rmorph1 oner_eq0.
have := @krylov_degree _ n (resM A) (resM b) (resM c) d a e (res P') (res r) (res r') md.
rewrite sP' sd addnS ltnS => main; apply: leq_trans (leq_add sD (leqnn L)) (main _ _ _ _ _).
- by move=> k kL; rewrite -residue_recurrence rec.
- by rewrite -residue_numerator.
- exact: monic_map.
- by rewrite residue_char er rmorphM mulrC.
by rewrite -map_response er' rmorphM mulrC.
Qed.
End Pair.

(* d divides det(xI - A) modulo l if the recurrence holds for all k < n; what divides both polynomials divides
   the quotient. *)
Theorem krylov_quotient (l : modulus) n (A : 'M[Zloc l]_n) b c (L : nat) (E : krylov_certificate A b c L) :
  let res := map_poly (@residue l) in let s k := residue (markov A b c k) in
  (forall k, (k < n)%N -> recurrence s (kc_d E) k = 0) -> exists2 H : {poly 'Z_l},
  [/\ res (char_poly A) = kc_d E * H, H \is monic & (size H + L = n.+1)%N] &
  forall phi r r', char_poly A = r * phi -> char_poly (A + b *m c) = r' * phi ->
  exists t, H = t * res phi.
Proof.
case: E => d a e md sd _ bez /= rec; set res := map_poly _.
have rec' k : (k < n)%N -> recurrence (markov (map_mx (@residue l) A) (map_mx (@residue l) b) (map_mx (@residue l) c)) d k = 0.
  by move=> kn; rewrite -residue_recurrence rec.
rewrite residue_numerator in bez; have [e1 _ mH sH] := krylov_factor md rec' bez.
eexists; first by split; [rewrite /res -residue_char e1| exact: mH | move: sH; rewrite sd addSn addnC => -[]].
move=> phi r r' er er'; have eN : response A b c = (r - r') * phi.
  by rewrite mulrBl -er -er' char_poly_rank_one opprB addrC subrK.
exists (a * res (r - r') + e * res r); rewrite mulrDl -!mulrA -!rmorphM -er -eN residue_char.
by rewrite -map_response.
Qed.

Section Rule.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Variables (F : gains (Zloc l) p q) (o : 'I_m) (x : 'cV[Zloc l]_(p o)) (y : 'rV[Zloc l]_(q o)).
Notation SQ := (map_system (@Zloc_rat l) S).
Notation res := (map_poly (@residue l)).
Notation AF := (closed_loop S F).

(* F_o + x y through the channel o, F_i through the others. *)
Definition changed : gains (Zloc l) p q := exchange F (F o + x *m y).

Lemma changed_loop : closed_loop S changed = AF + (mcB S o *m x) *m (y *m mcC S o).
Proof.
rewrite /closed_loop /changed -addrA; congr (_ + _); rewrite (bigD1 o)//= [in RHS](bigD1 o)//= exchange_same.
rewrite mulmxDr mulmxDl [RHS]addrAC !mulmxA; congr (_ + _).
by apply: eq_bigr => i io; rewrite exchange_other.
Qed.

Variables (L : nat) (E : krylov_certificate AF (mcB S o *m x) (y *m mcC S o) L).
Variables (K : fieldType) (h : {rmorphism rat -> K}).
Notation SK := (map_system h SQ).

(* Whatever divides det(xI - A_F) for all F has a degree of at most n - L. *)
Theorem krylov_bounded : bounded SK L.
Proof.
pose at_gains G := map_poly (into h) (char_poly (closed_loop S G)).
have at_one G : at_gains G = char_poly (closed_loop SK (fun i => map_mx (into h) (G i))).
  by rewrite /at_gains map_char_poly map_loop_into.
exists (gcdp (at_gains F) (at_gains changed)); split.
- by rewrite gcdp_eq0 negb_and at_one [X in ~~ X || _](negPf (monic_neq0 (char_poly_monic _))).
- by move=> D dv; rewrite dvdp_gcd !at_one !dv.
apply: (@krylov_common _ _ _ _ _ _ E _ h); last by rewrite -changed_loop dvdp_gcdr.
exact: dvdp_gcdl.
Qed.
End Rule.
