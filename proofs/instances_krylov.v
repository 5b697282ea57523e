(* The one-channel rule on the systems of instances.v, modulo 6; blocks; and what the rules cannot do without. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph fixed_spectrum.
From mcexact Require Import krylov_sequence gauss shrunk_multiplicity fixed_polynomial fixed_bound krylov blocks instances.
From mcexact Require Import controllability_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation R := (Zloc l6).
Notation h := ([rmorphism of (ratr : rat -> algC)]).
Notation Q S := (map_system (@Zloc_rat l6) S).
Notation free := (system 1). Notation stuck := (system 0).

(* d = x - a *)
Section Linear.
Variables (K : ringType) (s : nat -> K) (a : K).
Lemma numerator_linear : numerator s ('X - a%:P) = (s 0%N)%:P.
Proof.
apply/polyP=> i; rewrite coef_poly coefC size_XsubC /=; case: i => [|i] //=.
by rewrite big_mkcond !big_ord_recl big_ord0 /= coefB coefX coefC subr0 mul1r addr0 add0r.
Qed.
Lemma recurrence_linear k : recurrence s ('X - a%:P) k = s k.+1 - a * s k.
Proof.
rewrite /recurrence size_XsubC !big_ord_recl big_ord0 /= !coefB !coefX !coefC /= addr0.
by rewrite add0r subr0 mul1r mulNr addn1 addn0 addrC.
Qed.
End Linear.

(* free: s = 1, 0, 0, ..., nothing is fixed; stuck: s = 0, d = 1, and the mode 0 is all that is fixed. *)
Definition F0 : gains R one one := fun=> 0.
Lemma loop0 b : closed_loop (system b) F0 = 0.
Proof. by rewrite /closed_loop big_ord1 add0r /= mulmx0 mul0mx. Qed.
Lemma sequence b k : markov (closed_loop (system b) F0) (mcB (system b) ord0 *m 1%:M) (1%:M *m mcC (system b) ord0) k =
  if k is 0 then b else 0.
Proof.
rewrite loop0 /markov mulmx1 mul1mx; case: k => [|k]; first by rewrite mul1mx mxE.
by rewrite krylovS mul0mx mulmx0 mxE.
Qed.

Notation pair b := (krylov_certificate (closed_loop (system b) F0) (mcB (system b) ord0 *m 1%:M) (1%:M *m mcC (system b) ord0)).
Definition certificate_free : pair 1 1.
Proof.
apply: (@KrylovCertificate _ _ _ _ _ _ ('X - 0%:P) 1 0) => //; first exact: monicXsubC.
- exact: size_XsubC.
- by rewrite numerator_linear sequence rmorph1 mul0r addr0 mul1r.
Defined.
Definition certificate_stuck : pair 0 0.
Proof.
apply: (@KrylovCertificate _ _ _ _ _ _ 1 0 1) => //; first exact: monic1.
- exact: size_poly1.
- by rewrite mul0r add0r mul1r.
Defined.

Definition inst_krylov_free : bounded (map_system h (Q free)) 1 :=
  @krylov_bounded l6 _ _ _ _ free F0 ord0 1%:M 1%:M 1 certificate_free _ h.
Definition inst_krylov_stuck : bounded (map_system h (Q stuck)) 0 :=
  @krylov_bounded l6 _ _ _ _ stuck F0 ord0 1%:M 1%:M 0 certificate_stuck _ h.
Definition inst_bounded_absence (lambda : algC) : ~ fixed (map_system h (Q free)) lambda :=
  bounded_absence inst_krylov_free.
Definition inst_nothing_bounded : bounded (map_system h (Q stuck)) 0 := nothing_bounded _.
Lemma inst_coprime_bounded : bounded (map_system h (Q free)) 1.
Proof.
apply: (@coprime_bounded l6 _ _ _ _ free _ h (fun=> 1%:M) 1 (-1)); rewrite mul1r mulN1r.
rewrite /closed_loop big_ord1 /= add0r !mulmx1 !map_char_poly map_mx0.
have char1 (a : 'Z_l6) : char_poly (a%:M : 'M_1) = 'X - a%:P by rewrite /char_poly /char_poly_mx map_scalar_mx -raddfB det_scalar.
have -> : (0 : 'M['Z_l6]_1) = 0%:M by rewrite raddf0.
by rewrite map_scalar_mx rmorph1 !char1 opprB polyC0 subr0 addrCA subrr addr0.
Qed.
Lemma inst_bounded_reach : (1 <= \rank (reach (mcA (map_system h (Q free))) (mcB (map_system h (Q free)) ord0) 1))%N.
Proof. by apply: (bounded_reach _ inst_krylov_free) => i; exists 1%:M; rewrite mulmx1. Qed.
(* nothing is annihilated: W has no rows *)
Lemma inst_controllability_by_bound : let S := map_system h (Q free) in
  \rank (reach (mcA S) (mcB S ord0) 1) = 1%N.
Proof.
set S := map_system h (Q free); pose W : 'M[algC]_(1 - 1, 1) := 0.
have within i : exists M : 'M_1, mcB S i = mcB S ord0 *m M by exists 1%:M; rewrite mulmx1.
have no_row a (X Y : 'M[algC]_(1 - 1, a)) : X = Y by apply/matrixP => -[].
by have [] := @controllability_by_bound _ _ _ _ _ _ S (mcB S ord0) within 1 W (fun=> ord0) 1 (leqnn 1)
  (no_row _ _ _) (no_row _ _ _) (no_row _ _ _) inst_krylov_free (leqnn 1).
Qed.
Definition inst_bounded_channels := @bounded_channels _ 1 1 _ _ (map_system h (Q free)) 1 id 1 inst_krylov_free.

Notation X := ('X : {poly R}).
Lemma evidence_factor (i : 'I_1) : shrunk_subspace (Q stuck) (map_poly (@Zloc_rat l6) X) setT 1.
Proof. by apply: evidence_stuck; rewrite map_polyX. Qed.
Lemma factor_alone (i : 'I_1) : exists u v, u * map_poly (@residue l6) X +
  v * map_poly (@residue l6) (\prod_(j < 1 | (j < i)%N) X) = 1.
Proof. by exists 0, 1; rewrite ord1 big_pred0 ?rmorph1 ?mul0r ?add0r ?mul1r// => j; rewrite ord1. Qed.
Lemma factor_full : (1 <= 0 + \sum_(i < 1) 1 * (size X).-1)%N.
Proof. by rewrite big_ord1 size_polyX. Qed.

Definition inst_bounded_rule : fixed_polynomial (map_system h (Q stuck)) (\prod_(i < 1) map_poly (into h) X ^+ 1) :=
  @bounded_rule l6 _ _ _ _ stuck 0 1 (fun=> X) (fun=> setT) (fun=> 1%N)
    evidence_factor (fun=> monicX _) factor_alone factor_full _ h inst_krylov_stuck.
Definition inst_bounded_fixed (lambda : algC) :
    fixed (map_system h (Q stuck)) lambda <-> exists i : 'I_1, root (map_poly (into h) X) lambda :=
  @bounded_fixed l6 _ _ _ _ stuck 0 1 (fun=> X) (fun=> setT) (fun=> 1%N)
    evidence_factor (fun=> monicX _) factor_alone factor_full _ h inst_krylov_stuck lambda (fun=> isT).
Lemma simple_zero : ~~ (('X - 0%:P) ^+ 2 %| map_poly (into h) X).
Proof.
rewrite map_polyX subr0; apply/negP => /dvdp_leq; rewrite polyX_eq0 => /(_ isT).
by rewrite size_polyXn size_polyX.
Qed.
Lemma inst_polynomial_rank s : (1 <= \rank (pencil (map_system h (Q stuck)) s 0) + 1)%N.
Proof. by apply: (fixed_polynomial_rank inst_bounded_rule); rewrite big_ord1 expr1 simple_zero. Qed.
Lemma inst_bounded_rank : (\rank (pencil (map_system h (Q stuck)) (~: setT) 0) + 1 = 1)%N.
Proof.
have [_ //] := @bounded_rank l6 _ _ _ _ stuck 0 1 (fun=> X) (fun=> setT)
  (fun=> 1%N) evidence_factor (fun=> monicX _) factor_alone factor_full _ h inst_krylov_stuck ord0 0 root0' simple_zero.
Qed.
Lemma inst_bounded_deficiency s : (1 <= \rank (pencil (map_system h (Q stuck)) s 0) + 1)%N.
Proof.
by apply: (@bounded_deficiency l6 _ _ _ _ stuck 0 1 (fun=> X) (fun=> setT) (fun=> 1%N) evidence_factor
  (fun=> monicX _) factor_alone factor_full _ h inst_krylov_stuck 1 0) => // i; exact: simple_zero.
Qed.
Definition inst_shrunk_divides (G : gains algC one one) :
    map_poly h 'X ^+ 1 %| char_poly (closed_loop (map_system h (Q stuck)) G) :=
  shrunk_subspace_divides E h G (negbT (polyX_eq0 _)).

(* The theorems over a ring: A = 0, b = c = 1, d = x, over Z/6. *)
Section Sequence.
Notation Z6 := ('Z_l6).
Notation zero := (0 : 'M[Z6]_1). Notation unit1 := (1%:M : 'M[Z6]_1).
Lemma ones_markov k : markov zero unit1 unit1 k = if k is 0 then 1 else 0.
Proof.
rewrite /markov mul1mx; case: k => [|k]; first by rewrite mxE.
by rewrite krylovS mul0mx mxE.
Qed.
Lemma inst_annihilated k : recurrence (markov zero unit1 unit1) ('X - 0%:P) k = 0.
Proof.
apply: annihilated_recurrence; rewrite size_XsubC big_ord_recl big_ord1 /= subr0 !coefX scale0r add0r.
by rewrite /krylov /= mul0mx mulmx0 scaler0.
Qed.
Lemma ones_recurrence k : recurrence (markov zero unit1 unit1) ('X - 0%:P) k = 0.
Proof. by rewrite recurrence_linear !ones_markov mul0r subr0. Qed.
Lemma ones_comaximal : 1 * numerator (markov zero unit1 unit1) ('X - 0%:P) + 0 * ('X - 0%:P) = 1.
Proof. by rewrite numerator_linear ones_markov mul0r addr0 mul1r. Qed.
Definition inst_krylov_factor := @krylov_factor _ 1 zero unit1 unit1 ('X - 0%:P) 1 0 (monicXsubC _)
  (fun k _ => ones_recurrence k) ones_comaximal.
Definition inst_krylov_whole := @krylov_whole _ 1 zero unit1 unit1 ('X - 0%:P) 1 0 (monicXsubC _) (size_XsubC _)
  (fun k _ => ones_recurrence k) ones_comaximal.
Definition inst_krylov_degree := @krylov_degree _ 1 zero unit1 unit1 ('X - 0%:P) 1 0 1 _ _ (monicXsubC _)
  (fun k _ => ones_recurrence k) ones_comaximal (monic1 _) (esym (mul1r _)) (esym (mul1r _)).
Definition inst_rank_one := char_poly_rank_one zero unit1 unit1.
End Sequence.

Definition inst_monic_factor := @monic_factor l6 'X X (monicX _) (monicX _).
Definition inst_krylov_quotient := @krylov_quotient l6 1 _ _ _ 1 certificate_free.
Definition inst_krylov_common := @krylov_common l6 1 _ _ _ 1 certificate_free _ h 1 (dvd1p _) (dvd1p _).

(* The recurrence for k < L alone: 1, 1, 0, 0, ... satisfies s_1 = s_0, and x - 1 does not divide x^2. The degree
   is bounded all the same (krylov_common), but d is no divisor. *)
Definition nilpotent (K : ringType) : 'M[K]_(1 + 1) := block_mx 0 1 0 0.
Lemma char_nilpotent (K : comRingType) : char_poly (nilpotent K) = 'X ^+ 2.
Proof.
rewrite /char_poly /char_poly_mx /nilpotent map_block_mx scalar_mx_block opp_block_mx add_block_mx.
by rewrite !map_mx0 oppr0 !add0r !addr0 det_ublock !det_scalar1 expr2.
Qed.
Lemma short_markov (K : ringType) k :
  markov (nilpotent K) (col_mx 1%:M 1%:M) (row_mx 1%:M 0) k = if (k < 2)%N then 1 else 0.
Proof.
have e1 : nilpotent K *m col_mx 1%:M 1%:M = col_mx 1%:M 0.
  by rewrite mul_block_col !mul0mx mul1mx add0r addr0.
rewrite /markov; case: k => [|[|k]].
- by rewrite mul_row_col mul1mx mul0mx addr0 mxE.
- by rewrite krylovS e1 mul_row_col mul1mx mul0mx addr0 mxE.
have -> : krylov (nilpotent K) (col_mx 1%:M 1%:M) k.+2 = 0.
  elim: k => [|k IH]; last by rewrite krylovS IH mulmx0.
  by rewrite !krylovS e1 mul_block_col !mul0mx mulmx0 addr0 col_mx0.
by rewrite mulmx0 mxE.
Qed.
Lemma short_recurrence_no_divisor : let s := markov (nilpotent [comRingType of 'Z_l6]) (col_mx 1%:M 1%:M) (row_mx 1%:M 0) in
  let d := 'X - 1%:P in
  [/\ forall k, (k < 1)%N -> recurrence s d k = 0, 1 * numerator s d + 0 * d = 1 &
      ~ exists H, char_poly (nilpotent [comRingType of 'Z_l6]) = d * H].
Proof.
split=> [[|//] _||[H /(congr1 (horner^~ 1))]].
- by rewrite recurrence_linear !short_markov mulr1 subrr.
- by rewrite numerator_linear short_markov mul0r addr0 mul1r.
by rewrite char_nilpotent hornerM hornerXsubC subrr mul0r hornerXn expr1n => /eqP; rewrite oner_eq0.
Qed.

(* One equation of the recurrence less than krylov_common asks for: A = 1, s = 1, 1, 1, ..., d = x^2 and L = n = 2 with none of
   the recurrence; x - 1 divides both polynomials. *)
Lemma identity_markov (K : ringType) k : markov (1%:M : 'M[K]_(1 + 1)) (col_mx 1%:M 0) (row_mx 1%:M 0) k = 1.
Proof.
rewrite /markov; have -> : krylov (1%:M : 'M[K]_(1 + 1)) (col_mx 1%:M 0) k = col_mx 1%:M 0.
  by elim: k => [//|k IH]; rewrite krylovS IH mul1mx.
by rewrite mul_row_col mul1mx mul0mx addr0 mxE.
Qed.
Lemma numerator_square (K : comRingType) (s : nat -> K) : numerator s 'X^2 = (s 1%N)%:P + (s 0%N) *: 'X.
Proof.
rewrite numeratorE size_polyXn !big_ord_recl !big_ord0 /= !coefXn /= polyC0 !mul0r !add0r mul1r !addr0.
by rewrite subn1 expr0 expr1 alg_polyC addrC.
Qed.
Lemma right_neq0 : row_mx 0 1%:M != 0 :> 'rV[rat]_(1 + 1).
Proof.
apply/eqP=> /(congr1 rsubmx); rewrite row_mxKr linear0 => /matrixP/(_ 0 0)/eqP.
by rewrite !mxE oner_eq0.
Qed.
Lemma recurrence_needed : let s := markov (1%:M : 'M['Z_l6]_(1 + 1)) (col_mx 1%:M 0) (row_mx 1%:M 0) in
  let d : {poly 'Z_l6} := 'X^2 in
  [/\ d \is monic, size d = 3%N, (1 - 'X) * numerator s d + 1 * d = 1 &
   forall D : {poly rat}, D = 'X - 1%:P -> D %| char_poly (1%:M : 'M[rat]_(1 + 1)) /\
     D %| char_poly ((1%:M : 'M[rat]_(1 + 1)) + col_mx 1%:M 0 *m row_mx 1%:M 0)].
Proof.
move=> s d; split; first exact: monicXn.
- exact: size_polyXn.
- rewrite /d numerator_square /s !identity_markov scale1r mul1r mulrDr mulrBl mul1r mulrBl mul1r -expr2.
  by rewrite addrA subrK mulr1 subrK.
move=> D ->; rewrite !dvdp_XsubCl -!eigenvalue_root_char; split; apply/eigenvalueP; exists (row_mx 0 1%:M).
- by rewrite mulmx1 scale1r.
- exact: right_neq0.
- by rewrite mulmxDr mulmx1 mulmxA mul_row_col mul0mx mulmx0 add0r mul0mx addr0 scale1r.
exact: right_neq0.
Qed.

(* A leading coefficient that is no unit: modulo 4, d = 2 x + 1 is its own inverse, and s = 0 has d for a recurrence of degree
   L = n = 1, although the mode is fixed. *)
Definition l4 := @Modulus 4 isT.
Lemma monic_needed (K : fieldType) (lambda : K) : let d : {poly 'Z_l4} := 2%:R%:P * 'X + 1 in let s (k : nat) : 'Z_l4 := 0 in
  [/\ size d = 2%N, forall k, recurrence s d k = 0, 0 * numerator s d + d * d = 1 &
      fixed (Multichannel (p := one) (q := one) lambda%:M (fun=> 0) (fun=> 1%:M) : multichannel K 1 one one) lambda].
Proof.
move=> d s; split=> [|k||F].
- by rewrite size_MXaddC size_polyC; case: eqP.
- by rewrite /recurrence big1// => j _; rewrite mulr0.
- rewrite mul0r add0r /d -expr2 sqrrD1 exprMn -mulrnAl -rmorphX -polyCMn.
  have [-> ->] : (2%:R : 'Z_l4) ^+ 2 = 0 /\ (2%:R : 'Z_l4) *+ 2 = 0 by split; apply/val_inj.
  by rewrite polyC0 !mul0r !add0r.
rewrite /closed_loop big_ord1 /= !mul0mx addr0; apply/eigenvalueP; exists 1%:M; last exact: matrix_nonzero1.
by rewrite mul1mx scalemx1.
Qed.

(* The pattern of [0 1; 0 0] without inputs: deficiency 1 in each of the two blocks, and 1 in the plant. *)
Lemma ranks_not_by_blocks : \rank (nilpotent [ringType of rat]) = 1%N /\
  (\rank (ulsubmx (nilpotent [ringType of rat])) + \rank (drsubmx (nilpotent [ringType of rat])) = 0)%N.
Proof.
split; last by rewrite block_mxKul block_mxKdr !mxrank0.
by rewrite /nilpotent block_mxEv row_mx0 rank_col_mx0 rank_row_0mx mxrank1.
Qed.

(* l = 4 and the denominator 2: A = 0, b = (1/2, 1)', c = (2, -1), so that c b = 0 and every loop is nilpotent.
   Whatever residue r is given to 1/2, s = 2 r - 1, 0, 0, ... satisfies all that a certificate with d = x asks for, as if the
   fixed polynomial had degree n - L = 1. *)
Definition half_b : 'cV[rat]_(1 + 1) := col_mx (2%:R^-1)%:M 1%:M.
Definition half_c : 'rV[rat]_(1 + 1) := row_mx 2%:R%:M (- 1%:M).
Lemma prime_denominators_needed (r : 'Z_l4) : let s k := if k is 0 then 2%:R * r - 1 else 0 in
  [/\ forall k, recurrence s ('X - 0%:P) k = 0,
      (2%:R * r - 1)%:P * numerator s ('X - 0%:P) + 0 * ('X - 0%:P) = 1 &
      forall f : rat, char_poly (half_b *m f%:M *m half_c) = 'X^2].
Proof.
move=> s; split=> [k||f].
- by rewrite recurrence_linear mul0r subr0.
- rewrite numerator_linear mul0r addr0 -polyCM.
  by congr (_%:P); apply/val_inj; case: r @s => -[|[|[|[|//]]]].
have cb : half_c *m half_b = 0.
  rewrite mul_row_col -scalar_mxM mulfV ?pnatr_eq0// mulNmx mulmx1.
  exact: subrr.
have nil k : markov (0 : 'M[rat]_(1 + 1)) (half_b *m f%:M) half_c k = 0.
  rewrite /markov; case: k => [|k]; last by rewrite krylovS mul0mx mulmx0 mxE.
  by rewrite /krylov /= mulmxA cb mul0mx mxE.
rewrite -[X in char_poly X]add0r char_poly_rank_one /response transfer0_markov ?mxE ?subr0 => [|k].
  by rewrite /char_poly /char_poly_mx map_mx0 subr0 det_scalar.
by apply/matrixP=> i j; rewrite !ord1 [RHS]mxE; apply: nil.
Qed.

(* Two integrators that know nothing of each other: two blocks, and nothing is fixed for either of them. *)
Section Blocks.
Notation one2 := (fun _ : 'I_2 => 1%N).
Definition two_apart : multichannel rat 2 one2 one2 :=
  Multichannel 0 (fun i => delta_mx i 0) (fun i => delta_mx 0 i).
Definition own (a : 'I_2) : nat := a.
Lemma two_triangular : triangular two_apart own.
Proof.
split=> [a b|i a b u v]; rewrite !mxE ?eqxx//.
by case: (a =P i) => [->|]; rewrite ?eqxx//; case: (b =P i) => [->|]; rewrite ?andbF ?eqxx.
Qed.
Lemma two_few a : (own a < 2)%N. Proof. exact: ltn_ord. Qed.
Notation part k := (restrict two_apart [set a | own a == k]).

Lemma part_loop k (g : rat) : closed_loop (part k) (fun=> g%:M) = g%:M.
Proof.
rewrite closed_loop_restrict /closed_loop add0r /= (_ : \sum_i _ = g%:M).
  by apply/matrixP=> a b; rewrite !mxE (inj_eq enum_val_inj).
rewrite -[RHS]scalemx1 mx1_sum_delta scaler_sumr; apply: eq_bigr => i _.
by rewrite mul_mx_scalar -scalemxAl mul_delta_mx.
Qed.
Lemma part_char k (g : rat) : char_poly (closed_loop (part k) (fun=> g%:M)) = ('X - g%:P) ^+ #|[set a | own a == k]|.
Proof. by rewrite part_loop /char_poly /char_poly_mx map_scalar_mx -raddfB det_scalar. Qed.

Lemma part_moved k : fixed_polynomial (part k) 1.
Proof.
split=> [F|D dv]; first exact: dvd1p.
have cop : coprimep (('X - 0%:P) ^+ #|[set a | own a == k]|) (('X - (1 : rat)%:P) ^+ #|[set a | own a == k]|).
  by apply/coprimep_expl/coprimep_expr; rewrite coprimep_XsubC root_XsubC oner_eq0.
have := dv (fun=> 0%:M); have := dv (fun=> 1%:M); rewrite !part_char => d1 d0.
by move: cop; rewrite -gcdp_eqp1 => e; rewrite -(eqp_dvdr _ e) dvdp_gcd d0.
Qed.
Lemma part_not_fixed k lambda : ~ fixed (part k) lambda.
Proof. by move/(fixed_polynomial_root _ (part_moved k)); rewrite (negPf (root1 _)). Qed.

Definition inst_block_spectrum := block_spectrum two_triangular two_few.
Definition inst_block_polynomial : fixed_polynomial two_apart (\prod_(k < 2) 1) :=
  block_fixed_polynomial two_triangular two_few (fun k => part_moved k).
Lemma inst_block_bounded : bounded two_apart (\sum_(k < 2) #|[set a | own a == k]|).
Proof.
apply: (block_bounded two_triangular two_few) => k; exists 1; split; last by rewrite size_poly1.
  exact: oner_neq0.
by case: (part_moved k).
Qed.
Definition inst_block_absence lambda : ~ fixed two_apart lambda :=
  block_absence two_triangular two_few (fun k => @part_not_fixed k lambda).

(* One block that is the whole plant, of which 0 is fixed. *)
Notation stuckC := (map_system h (Q stuck)).
Lemma whole_triangular : triangular stuckC (fun=> 0%N). Proof. by split. Qed.
Lemma whole_few (a : 'I_1) : (0 < 1)%N. Proof. by []. Qed.
Lemma whole_fixed : fixed (restrict stuckC [set a | 0%N == (ord0 : 'I_1)]) 0.
Proof.
move=> F; rewrite eigenvalue_root_char; have := block_spectrum whole_triangular whole_few F.
rewrite big_ord1 => <-; rewrite -eigenvalue_root_char; exact: inst_fixed_yes.
Qed.
Definition inst_block_fixed : fixed stuckC 0 := block_fixed whole_triangular whole_few whole_fixed.
End Blocks.
