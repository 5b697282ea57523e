(* krylov.md: one Krylov sequence of one closed loop, modulo l, bounds the fixed polynomial.

   b = B_o x and c = y C_o are an input and an output of one channel o; A_F' = A_F + b c for F' = F but
   F'_o = F_o + x y.  The certificate holds modulo l, which need not be prime; the data are rationals whose
   denominators are prime to l, and h embeds Q into any field K. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph.
From mcexact Require Import fixed_spectrum krylov_sequence gauss shrunk_multiplicity fixed_polynomial.
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
Theorem krylov_bound D : (forall G : gains K p q, D %| char_poly (closed_loop SK G)) -> (size D + L <= n.+1)%N.
Proof.
move=> dv; apply: (@krylov_common _ _ _ _ _ _ E _ h); rewrite -?changed_loop map_char_poly map_loop_into; exact: dv.
Qed.
End Rule.

Section Rules.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Variables (F : gains (Zloc l) p q) (o : 'I_m) (x : 'cV[Zloc l]_(p o)) (y : 'rV[Zloc l]_(q o)).
Notation SQ := (map_system (@Zloc_rat l) S).
Notation res := (map_poly (@residue l)).
Notation certificate L := (krylov_certificate (closed_loop S F) (mcB S o *m x) (y *m mcC S o) L).

(* Rule "absence by one channel": d of degree n, nothing is fixed over any field that contains Q. *)
Theorem krylov_absence (E : certificate n) (K : fieldType) (h : {rmorphism rat -> K}) lambda :
  ~ fixed (map_system h SQ) lambda.
Proof.
move=> fx; have dv G : 'X - lambda%:P %| char_poly (closed_loop (map_system h SQ) G).
  by rewrite dvdp_XsubCl -eigenvalue_root_char.
by have := krylov_bound E dv; rewrite size_XsubC !addSn ltnn.
Qed.

(* With factors: pairwise coprime monic p_i, each with a shrunk subspace of deficiency d_i, whose degrees times
   d_i sum to n - L.  Their product is all that is fixed, with multiplicities. *)
Variables (L : nat) (E : certificate L) (r : nat) (P : 'I_r -> {poly Zloc l}) (T : 'I_r -> {set 'I_m}).
Variables (d : 'I_r -> nat) (sh : forall i, shrunk_subspace SQ (map_poly (@Zloc_rat l) (P i)) (T i) (d i)).
Hypotheses (mP : forall i, P i \is monic).
Hypothesis cop : forall i, exists u v, u * res (P i) + v * res (\prod_(j < r | (j < i)%N) P j) = 1.
Hypothesis full : (n <= L + \sum_i d i * (size (P i)).-1)%N.
Variables (K : fieldType) (h : {rmorphism rat -> K}).
Notation SK := (map_system h SQ).
Notation PK i := (map_poly (into h) (P i)).

Lemma factors_coprime i j : i != j -> coprimep (PK i) (PK j).
Proof.
have earlier k : coprimep (PK k) (\prod_(t < r | (t < k)%N) PK t).
  by have [u [v bez]] := cop k; rewrite -rmorph_prod (coprime_modulo h (monic_unit_lead (mP k)) bez).
have lt (k t : 'I_r) : (t < k)%N -> coprimep (PK k) (PK t).
  by move=> tk; apply: coprimep_dvdl (earlier k); rewrite (bigD1 t)//= dvdp_mulr.
by rewrite neq_ltn => /orP[/lt|/lt//]; rewrite coprimep_sym.
Qed.

Theorem krylov_rule : fixed_polynomial SK (\prod_i PK i ^+ d i).
Proof.
set Pi := \prod_i _.
have mI i : PK i \is monic by apply: monic_map.
have mPi : Pi \is monic by apply: monic_prod => i _; apply: monic_exp.
have each i G : PK i ^+ d i %| char_poly (closed_loop SK G).
  rewrite map_poly_into; apply: (shrunk_subspace_divides (sh i)).
  by rewrite monic_neq0// monic_map.
have copP i j : i != j -> coprimep (PK i ^+ d i) (PK j ^+ d j).
  by move=> ij; apply: coprimep_expl; apply: coprimep_expr; apply: factors_coprime.
have dv G : Pi %| char_poly (closed_loop SK G).
  rewrite /Pi; elim: (index_enum _) (index_enum_uniq [finType of 'I_r]) => [_|i s IH /= /andP[si us]].
    by rewrite big_nil dvd1p.
  rewrite big_cons Gauss_dvdp ?each ?IH//; rewrite big_seq.
  apply: (big_ind (coprimep _)) => [|b c cb cc|j js]; first exact: coprimep1.
    by rewrite coprimepMr cb.
  by apply: copP; apply: contraNneq si => ->.
have sPi : size Pi = (\sum_i d i * (size (P i)).-1).+1%N.
  apply: (proj2 (big_rec2 (fun (Q : {poly K}) s => Q \is monic /\ size Q = s.+1) _ _)).
    by rewrite monic1 size_poly1.
  move=> i Q s _ [mQ sQ]; have me : PK i ^+ d i \is monic by apply: monic_exp.
  rewrite monicMl ?mQ// size_monicM ?monic_neq0// sQ addnS /=; split=> //.
  rewrite -[size (map_poly _ _ ^+ _)]prednK ?size_poly_gt0 ?monic_neq0// size_exp size_map_poly_id0.
    by rewrite mulnC.
  by rewrite (monicP (mP i)) rmorph1 oner_eq0.
split=> // D dvD; pose g := gcdp (char_poly (closed_loop SK (fun i => map_mx (into h) (F i))))
  (char_poly (closed_loop SK (fun i => map_mx (into h) (changed F x y i)))).
have Pg : Pi %| g by rewrite dvdp_gcd !dv.
have Dg : D %| g by rewrite dvdp_gcd !dvD.
have : (size g + L <= n.+1)%N.
  apply: (krylov_common E (h := h)); rewrite -?changed_loop map_char_poly map_loop_into.
    exact: dvdp_gcdl.
  exact: dvdp_gcdr.
move=> sg; suff e : Pi %= g by rewrite (eqp_dvdr _ e).
have g0 : g != 0 by rewrite gcdp_eq0 negb_and monic_neq0 ?char_poly_monic.
rewrite -dvdp_size_eqp// eqn_leq (dvdp_leq g0 Pg) sPi -(leq_add2r L) (leq_trans sg)//.
by rewrite addSn ltnS addnC.
Qed.

(* The fixed modes are the roots. *)
Theorem krylov_fixed lambda : (forall i, 0 < d i)%N -> fixed SK lambda <-> exists i, root (PK i) lambda.
Proof.
move=> d0; rewrite (fixed_polynomial_root lambda krylov_rule) /root horner_prod.
split=> [/prodf_eq0[i _]|[i ri]]; first by rewrite horner_exp expf_eq0 => /andP[_ ri]; exists i.
by apply/prodf_eq0; exists i => //; rewrite horner_exp expf_eq0 d0.
Qed.

(* At a simple root of p_i no pencil has a rank below n - d_i, and that of the subset named has this rank. *)
Theorem krylov_rank i lambda : root (PK i) lambda -> ~~ (('X - lambda%:P) ^+ 2 %| PK i) ->
  (forall s, n <= \rank (pencil SK s lambda) + d i)%N /\ (\rank (pencil SK (~: T i) lambda) + d i = n)%N.
Proof.
move=> ri simple; have low : forall s, (n <= \rank (pencil SK s lambda) + d i)%N.
  apply: (fixed_polynomial_rank krylov_rule); apply: contra simple; rewrite (bigD1 i)//=.
  set t := 'X - _; have [R eR] := factor_theorem _ _ ri; rewrite -/t in eR.
  have t0 : t != 0 by rewrite polyXsubC_eq0.
  rewrite Gauss_dvdpl => [|]; last first.
    apply: coprimep_expl; apply: (big_ind (coprimep t)) => [|a b ca cb|j ji]; first exact: coprimep1.
      by rewrite coprimepMr ca.
    by apply/coprimep_expr/(coprimep_dvdr _ (factors_coprime (_ : i != j))); rewrite ?dvdp_XsubCl// eq_sym.
  rewrite eR exprMn exprS dvdp_mul2r ?expf_neq0// => tR.
  rewrite expr2 dvdp_mul2r// dvdp_XsubCl; move: tR; rewrite dvdp_XsubCl /root horner_exp expf_eq0.
  by case/andP.
split=> //; apply/eqP; rewrite eqn_leq low andbT.
apply: (shrunk_subspace_pencil (sh i)); by rewrite -map_poly_into.
Qed.
End Rules.
