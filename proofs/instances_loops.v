(* The rules for loops and for the places of their roots applied to concrete polynomials and matrices, with
   every hypothesis discharged and every equivalence on either side; see instances.v for the other rules. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra all_field.
From mcexact Require Import multichannel arithmetic location mobius moved_roots closed_loop_spectrum.
From mcexact Require Import error_system distributed_observer routh_integers hessenberg.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.
Notation up := (map_poly (ratr : rat -> algC)).

(* x + 2: every real part is below -1, but not below -3. *)
Lemma shifted_XsubC (a b : rat) : shifted ('X - a%:P) b = 'X - (a + b)%:P.
Proof. by rewrite shiftedE comp_polyB comp_polyX comp_polyC polyCD opprD addrA addrAC. Qed.
Lemma hurwitz1 (a : rat) : is_hurwitz 1 ('X - a%:P) = (a < 0).
Proof. by rewrite /= size_XsubC /= coefB coefX coefC /= sub0r oppr_gt0 andbT. Qed.
Lemma inst_rate (z : algC) : root (up ('X - (-2%:~R)%:P)) z -> 'Re z < - ratr 1.
Proof.
move: z; apply/(region_continuous _ 1 (monicXsubC _)).
by rewrite size_XsubC shifted_XsubC hurwitz1.
Qed.
Lemma inst_not_rate : ~ (forall z : algC, root (up ('X - (-2%:~R)%:P)) z -> 'Re z < - ratr 3%:~R).
Proof.
apply/(region_continuous _ _ (monicXsubC _)).
by rewrite size_XsubC shifted_XsubC hurwitz1.
Qed.

(* x - 1/2: every modulus is below 1, but not below 1/4, and the root of x - 1 is not below 1. *)
Lemma moebius1 (a b : rat) : b != 0 ->
  moebius (scaled ('X - a%:P) b) = (b + a) *: 'X + (b - a)%:P.
Proof.
move=> b0; rewrite /moebius /scaled size_XsubC polyseq_poly; last by rewrite coefB coefX coefC subr0 mul1r expr1.
rewrite /mkseq /= !coefB !coefX !coefC /= sub0r subr0 expr0 expr1 !mulr1 mul1r mulr0 add0r.
rewrite -scalerAr mulr1 scalerDr scalerBr !alg_polyC polyCB scalerDl scaleNr opprK -polyCN.
by rewrite addrACA addrC.
Qed.
Lemma hurwitz_moebius1 (a b : rat) : 0 < b ->
  schur_by_moebius (scaled ('X - a%:P) b) = (b + a != 0) && (0 < (b + a)^-1 * (b - a)).
Proof.
move=> b0; have nb : b != 0 by rewrite gt_eqF.
have s2 : size (scaled ('X - a%:P) b) = 2%N.
  rewrite /scaled size_XsubC size_poly_eq// coefB coefX coefC subr0 mul1r expr1 //.
rewrite /schur_by_moebius s2 moebius1//= coefD coefZ coefX coefC mulr1 addr0; case: eqP => //= /eqP n0.
have -> : size ((b + a)^-1 *: ((b + a) *: 'X + (b - a)%:P)) = 2%N.
  by rewrite size_scale ?invr_eq0// -mul_polyC size_MXaddC polyC_eq0 (negPf n0) /= size_polyC n0.
by rewrite /= andbT coefZ coefD coefZ coefX coefC mulr0 add0r.
Qed.
Lemma inst_radius (z : algC) : root (up ('X - 2%:R^-1%:P)) z -> `|z| < ratr 1.
Proof.
move: z; apply/(region_discrete _ (monic_neq0 (monicXsubC _)) ltr01).
by rewrite hurwitz_moebius1.
Qed.
Lemma inst_not_radius : ~ (forall z : algC, root (up ('X - 2%:R^-1%:P)) z -> `|z| < ratr 4%:R^-1).
Proof.
apply/(@region_discrete _ _ 4%:R^-1 (monic_neq0 (monicXsubC _))); first by [].
by rewrite hurwitz_moebius1.
Qed.
Lemma scaled1 (p : {poly rat}) : scaled p 1 = p.
Proof. by apply/polyP=> i; rewrite coef_poly expr1n mulr1; case: ltnP => // /leq_sizeP->. Qed.
Lemma inst_schur_by_moebius : schur (up ('X - 2%:R^-1%:P)).
Proof. by apply/(schur_by_moebiusP _ (monic_neq0 (monicXsubC _))); rewrite -[_ - _]scaled1 hurwitz_moebius1. Qed.
Lemma inst_not_schur_by_moebius : ~ schur (up ('X - (-1)%:P)).
Proof. by apply/(schur_by_moebiusP _ (monic_neq0 (monicXsubC _))); rewrite -['X - _]scaled1 hurwitz_moebius1. Qed.
Lemma inst_shifted_roots : root (shifted ('X : {poly algC}) 3%:R) 3%:R.
Proof. by rewrite shifted_roots subrr rootX. Qed.
Lemma inst_scaled_roots : root (scaled ('X - 6%:R%:P : {poly algC}) 3%:R) 2%:R.
Proof. by rewrite scaled_roots -natrM root_XsubC. Qed.
Lemma inst_rate_rule : hurwitz (shifted (up ('X - (-2%:~R)%:P)) (ratr 1)).
Proof. by apply/(rate_rule _ (ratr_real _ _)); apply: inst_rate. Qed.

(* The spectrum of the matrix 1/2 by the moduli 3 and 5; their product is above 2 * 3. *)
Definition moduli_3_5 (a : 'I_2) : modulus := if val a == 0%N then @Modulus 3 isT else @Modulus 5 isT.
Definition matrix_half : 'M[rat]_1 := \matrix_(i, j) (1%:~R / 2%:R).
Lemma inst_closed_loop_spectrum : char_poly matrix_half = 'X - 2%:R^-1%:P.
Proof.
have e : matrix_half = \matrix_(i, j) (((1%:M : 'M[int]_1) i j)%:~R / 2%:R).
  by apply/matrixP=> i j; rewrite !mxE !ord1.
have eD : D 2 (1%:M : 'M_1) = 2%N by rewrite /D /row_gcd !big_ord1 mxE eqxx.
have eb : beta 2 (1%:M : 'M_1) = 3%N by rewrite /beta /row_gcd !big_ord1 mxE eqxx.
rewrite e; apply: (@closed_loop_spectrum 1 2 moduli_3_5) => //; rewrite ?eD ?eb.
- case=> [|[|k]]; rewrite coefB coefX coefC /=.
  + by exists (-1).
  + by exists 2%:Z.
  + by exists 0; rewrite // subrr mulr0.
- by move=> [[|[|a]] lt] //; rewrite big_mkcond /= !big_ord_recl big_ord0.
- by rewrite !big_ord_recl big_ord0.
- by case=> [[|[|a]]].
move=> a; set l := moduli_3_5 a; have l2 : coprime l 2 by rewrite /l; case: a {l} => [[|[|]]].
have u2 := unit_nat_modulus l2; rewrite /char_poly det_mx11 !mxE eqxx mulr1n.
apply/polyP=> k; rewrite [RHS]coef_poly size_XsubC 2!coefB 2!coefX 2!coefC.
case: k => [|[|k]] //=; last by rewrite !subr0.
  apply: (mulIr u2); rewrite !sub0r mulNr divrK//.
  by rewrite (@residue_ratE _ _ _ (-1))// rmorphN1.
by rewrite !subr0; apply: (mulIr u2); rewrite (@residue_ratE _ _ _ 2%:Z)// mul1r -pmulrn.
Qed.

(* A loop of one agent, in the coordinates of the errors [a, 1; 0, c]. *)
Notation one := (fun _ : 'I_1 => 1%N).
Notation nothing := (fun _ : 'I_1 => 0%N).
Notation estimate := (estimates rat_Ring 1 nothing).
Definition loop (a c : rat) : 'M[rat]_(1 + \sum_(i < 1) (1 + 0)) :=
  change estimate *m block_mx a%:M (const_mx 1) 0 c%:M *m change (- estimate).
Lemma separated_loop a c : separated (loop a c) estimate = block_mx a%:M (const_mx 1) 0 c%:M.
Proof. by rewrite /separated /loop !mulmxA changeN mul1mx -mulmxA changeN mulmx1. Qed.
Lemma char_scalar n (c : rat) : char_poly (c%:M : 'M_n) = ('X - c%:P) ^+ n.
Proof.
rewrite char_poly_trig ?scalar_mx_is_trig// (eq_bigr (fun=> 'X - c%:P)) => [|i _]; last by rewrite mxE eqxx.
by rewrite prodr_const card_ord.
Qed.
Lemma loop_error (c : rat) : char_poly (c%:M : 'M_(\sum_(i < 1) (1 + 0))) = 'X - c%:P.
Proof. by rewrite char_scalar big_ord1. Qed.
Lemma inst_observer_rate (lambda : algC) :
  eigenvalue (map_mx ratr (loop (-2%:~R) (-3%:~R))) lambda -> 'Re lambda < - ratr 1.
Proof.
apply: (@observer_rate _ 1 1 nothing _ ('X - (-2%:~R)%:P) ('X - (-3%:~R)%:P));
  rewrite ?separated_loop ?block_mxKdl ?block_mxKul ?block_mxKdr ?loop_error ?char_scalar//.
- by rewrite size_XsubC shifted_XsubC hurwitz1.
- by rewrite size_XsubC shifted_XsubC hurwitz1.
Qed.
Lemma inst_observer_radius (lambda : algC) :
  eigenvalue (map_mx ratr (loop 2%:R^-1 3%:R^-1)) lambda -> `|lambda| < ratr 1.
Proof.
apply: (@observer_radius _ 1 1 nothing _ ('X - 2%:R^-1%:P) ('X - 3%:R^-1%:P));
  rewrite ?separated_loop ?block_mxKdl ?block_mxKul ?block_mxKdr ?loop_error ?char_scalar//.
- by rewrite hurwitz_moebius1.
- by rewrite hurwitz_moebius1.
Qed.
Lemma inst_separation : char_poly (loop 1 2%:R) = ('X - 1%:P) * ('X - 2%:R%:P).
Proof.
have [_ ->] := @separation _ _ _ (loop 1 2%:R) estimate (etrans (congr1 _ (separated_loop _ _)) (block_mxKdl _ _ _ _)).
by rewrite separated_loop block_mxKul block_mxKdr loop_error char_scalar.
Qed.

(* The paper's observer for one agent with A = B = C = 1 and F = -2, whose channel controller has one state. *)
Definition plant : multichannel rat 1 one one := Multichannel 1%:M (fun=> 1%:M) (fun=> 1%:M).
Definition channel_controller : controllers [ringType of rat] one (fun=> 1 + \sum_(i < 1) 1)%N one :=
  Controllers (fun=> row_mx (-3%:~R)%:M 0) (fun=> 1%:M) (fun=> row_mx 1%:M 0) (fun=> (-1)%:M).
Notation errors := (dynamic_loop (error_system (fun=> setT) plant (fun=> (-2%:~R)%:M)) channel_controller).
Lemma inst_paper_spectrum :
  char_poly (observer_loop (fun=> setT) plant (fun=> (-2%:~R)%:M) channel_controller) = ('X - (-1)%:P) * char_poly errors.
Proof.
by rewrite paper_spectrum /feedback_loop big_ord1 /= mul1mx -raddfD /= char_scalar.
Qed.
Lemma inst_paper_separation : drsubmx (separated
  (observer_loop (fun=> setT) plant (fun=> (-2%:~R)%:M) channel_controller) (copied _ _ _)) = errors.
Proof. by rewrite paper_separation block_mxKdr. Qed.

(* Routh's array: x^3 + 6 x^2 + 11 x + 6 is Hurwitz, x^3 + x^2 + x + 2 is not; the second with x/2 in place
   of x and all coefficients doubled. *)
Lemma size_Poly4 (a b c : rat) : size (Poly [:: a; b; c; 1]) = 4%N.
Proof. by rewrite (@PolyK _ 0). Qed.
Lemma inst_routh_integers : hurwitz (up (Poly [:: 6%:R; 11%:R; 6%:R; 1])).
Proof.
apply/(@is_hurwitz_integers _ _ 1 1 [:: 1%:Z; 6%:Z; 11%:Z; 6%:Z] true) => //.
- by rewrite -size_poly_eq0 size_Poly4.
- by rewrite size_Poly4.
by rewrite /lead_coef size_Poly4 (@PolyK _ 0)//; case=> [|[|[|[|k]]]].
Qed.
Lemma inst_not_routh_integers : ~ hurwitz (up (Poly [:: 2%:R; 1; 1; 1])).
Proof.
apply/(@is_hurwitz_integers _ _ 2%:R 2%:R [:: 2%:Z; 4%:Z; 8%:Z; 32%:Z] false) => //.
- by rewrite -size_poly_eq0 size_Poly4.
- by rewrite size_Poly4.
by rewrite /lead_coef size_Poly4 (@PolyK _ 0)//; case=> [|[|[|[|k]]]].
Qed.

(* The same two linear polynomials with their rates and radii, by integers; x + 1 has p(-1) = 0. *)
Lemma integers_linear (l c : rat) (s w : int) : l != 0 -> 0 < s -> w%:~R = s%:~R * (c / l) ->
  integers_of (l *: 'X + c%:P) [:: s; w].
Proof.
move=> l0 s0 e; have sz : size (l *: 'X + c%:P) = 2%N.
  by rewrite -mul_polyC size_MXaddC polyC_eq0 (negPf l0) /= size_polyC l0.
exists 1, s%:~R; split; rewrite ?sz ?ltr0z//.
have lE : lead_coef (l *: 'X + c%:P) = l by rewrite lead_coefE sz coefD coefZ coefX coefC mulr1 addr0.
by rewrite lE; case=> [|[|k]] //= _; rewrite coefD coefZ coefX coefC expr1n !mulr1 ?mulr0 ?addr0 ?add0r ?divff ?mulr1.
Qed.
Lemma integers_shifted (a b : rat) (w : int) : w%:~R = - (a + b) -> integers_of (shifted ('X - a%:P) b) [:: 1; w].
Proof.
move=> e; rewrite shifted_XsubC -['X]scale1r -polyCN; apply: integers_linear => //.
by rewrite divr1 mul1r.
Qed.
Lemma inst_in_region_rate (z : algC) : root (up ('X - (-2%:~R)%:P)) z -> 'Re z < - ratr 1.
Proof.
move: z; apply/(@in_region_continuous _ _ _ [:: 1; 1] true) => //; first by rewrite polyXsubC_eq0.
exact: integers_shifted.
Qed.
Lemma inst_not_in_region_rate : ~ (forall z : algC, root (up ('X - (-2%:~R)%:P)) z -> 'Re z < - ratr 3%:~R).
Proof.
apply/(@in_region_continuous _ _ _ [:: 1; -1] false) => //; first by rewrite polyXsubC_eq0.
exact: integers_shifted.
Qed.
Lemma top_moebius1 (a b : rat) : b != 0 -> (moebius (scaled ('X - a%:P) b))`_(size ('X - a%:P)).-1 = b + a.
Proof. by move=> b0; rewrite moebius1// size_XsubC coefD coefZ coefX coefC mulr1 addr0. Qed.
Lemma inst_in_region_radius (z : algC) : root (up ('X - 2%:R^-1%:P)) z -> `|z| < ratr 1.
Proof.
have n0 : (1 + 2%:R^-1 : rat) != 0 by [].
move: z; apply/(@in_region_discrete _ _ _ [:: 3%:Z; 1] true); rewrite ?polyXsubC_eq0 ?ltr01//.
  by rewrite top_moebius1 ?oner_neq0// => e; rewrite e eqxx in n0.
by move=> _; rewrite moebius1 ?oner_neq0//; split; first apply: integers_linear.
Qed.
Lemma inst_not_in_region_radius : ~ (forall z : algC, root (up ('X - 2%:R%:P)) z -> `|z| < ratr 1).
Proof.
apply/(@in_region_discrete _ _ _ [:: 3%:Z; -1] false); rewrite ?polyXsubC_eq0 ?ltr01//.
by move=> _; rewrite moebius1 ?oner_neq0//; split; first apply: integers_linear.
Qed.
Lemma inst_root_at_minus_1 : ~ (forall z : algC, root (up ('X - (-1)%:P)) z -> `|z| < ratr 1).
Proof. by apply/(@in_region_discrete _ _ _ [::] false); rewrite ?polyXsubC_eq0// top_moebius1. Qed.

(* Hessenberg form modulo 6, L not the identity: x^3 - x. *)
Definition rows3 (rows : seq (seq nat)) : 'M['Z_6]_3 := \matrix_(i, j) (nth 0%N (nth [::] rows i) j)%:R.
Definition swaps := rows3 [:: [:: 0; 1; 0]; [:: 1; 0; 0]; [:: 1; 0; 0]]%N.
Definition unit_lower := rows3 [:: [:: 1; 0; 0]; [:: 0; 1; 0]; [:: 0; 1; 1]]%N.
Definition above (i j : nat) : 'Z_6 := ((i == 0%N) && (j == 1%N))%:R.
Definition below (j : nat) : 'Z_6 := (j == 0%N)%:R.
Lemma inst_hessenberg : char_poly swaps = hessenberg_poly above below 3.
Proof.
apply: (@characteristic_polynomial_modulo _ _ swaps unit_lower 1%g).
- by apply/is_trig_mxP; move=> [[|[|[|?]]] ?] [[|[|[|?]]] ?] //= _; rewrite mxE.
- by move=> [[|[|[|?]]] ?] //; rewrite mxE.
apply/matrixP=> -[[|[|[|?]]] ?] [[|[|[|?]]] ?] //;
  by rewrite !mxE !big_ord_recl !big_ord0 /swaps /unit_lower /rows3 !mxE ?perm1.
Qed.
Lemma inst_hessenberg_poly : hessenberg_poly above below 3 = 'X ^+ 3 - 'X.
Proof.
rewrite /hessenberg_poly /= !big_ord_recl !big_ord0 /= /above /below /=.
by rewrite !mul0r !scale0r !addr0 !subr0 big_nat1 !mul1r scale1r !mulr1 mulrBr mulr1 -expr2 -exprS.
Qed.
Lemma inst_hessenberg_matrix : char_poly (hessenberg above below 3) = 'X ^+ 3 - 'X.
Proof. by rewrite hessenberg_polynomial inst_hessenberg_poly. Qed.
