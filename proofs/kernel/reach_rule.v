(* Kind `controllability`, checker/core/reach.py, check_controllability: what the inputs of some channels T reach.

   From above by rows W with an identity at the pivots, W A = Z W and W B_T = 0.  From below by vectors, each of which is
   a column of some B_i, i in T, or A times an earlier one, with X times the k-th of them the k-th unit vector modulo l;
   or by facts (facts.v) that bound what is fixed for the channels T alone, whatever these measure.  Observability is
   the same of the dual system. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability joint_controllability fixed_bound controllability_bound.
From mcexact.kernel Require Import lists systems residues shrunk_rule hessenberg_rule spectrum_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Columns u of B_i, and A times the j-th vector before. *)
Inductive source := FromInput of nat & nat | FromEarlier of nat.
Definition zcolumn (M : zmat) (u : nat) : zrow := [seq nth z0 r u | r <- M].
Fixpoint zvectors (l : Z) (A : zmat) (chs : seq zchannel) (vs : seq zrow) (xs : seq source) : seq zrow :=
  if xs is x :: xs' then
    let v := match x with FromInput i u => zcolumn (zB (nth zch0 chs i)) u | FromEarlier j => zmod l (zmv A (nth [::] vs j)) end in
    zvectors l A chs (rcons vs v) xs'
  else vs.
Definition allowed (T : seq bool) (chs : seq zchannel) (x : source) : bool :=
  if x is FromInput i u then [&& i < size chs, nth false T i & u < zp (nth zch0 chs i)]%N else true.
(* X v_k is the k-th unit vector modulo l *)
Definition unit_images (l : Z) (X : zmat) (vs : seq zrow) : bool :=
  all (fun kv => zero_mod l (zaxpy (-1) (zunit 1 kv.1) (zmv X kv.2))) (zip (iota 0 (size vs)) vs).

(* A and B_i, i in T, over a smaller denominator: l may divide that of the outputs. *)
Definition zdivs (g : Z) (M : zmat) : zmat := [seq [seq (x / g)%coqZ | x <- r] | r <- M].
Definition divisible (g : Z) (M : zmat) : bool := all (all (fun x => Z.eqb (Z.modulo x g) 0)) M.
Definition zlower (g : Z) (s : zsystem) : zsystem :=
  ZSystem (zn s) (zD s / g)%coqZ (zdivs g (zA s)) [seq ZChannel (zp ch) (zq ch) (zdivs g (zB ch)) (zC ch) | ch <- zchannels s] (zfeed s).
Definition lowers (g : Z) (s : zsystem) (T : seq bool) : bool :=
  [&& Z.ltb 0 g, Z.eqb (Z.modulo (zD s) g) 0, divisible g (zA s) & all (fun bc => ~~ bc.1 || divisible g (zB bc.2)) (zip T (zchannels s))].

Record reach_witness := ReachWitness { v_lower : Z; v_ell : Z; v_inv : Z; v_sources : seq source; v_X : zmat }.
Definition reach_of (w : reach_witness) : nat := size (v_sources w).
Definition check_reach (s0 : zsystem) (T : seq bool) (w : reach_witness) : bool :=
  let: (l, i, s) := (v_ell w, v_inv w, zlower (v_lower w) s0) in
  let chs := [seq reduced l i ch | ch <- zchannels s] in
  let vs := zvectors l (zscale_mod l i (zA s)) chs [::] (v_sources w) in
  [&& lowers (v_lower w) s0 T, inverse_modulo l (zD s) i, all (allowed T (zchannels s)) (v_sources w), shape (reach_of w) (zn s) (v_X w) &
      unit_images l (v_X w) vs].

(* Rows W over the denominator a_den, and the polynomial of Z in the form that is proved of it. *)
Record annihilator := Annihilator { a_den : Z; a_W : zmat; a_pivots : seq nat; a_f : zrow; a_spectrum : spectrum_witness }.
Definition zpick (places : seq nat) (M : zmat) : zmat := [seq [seq nth z0 r j | j <- places] | r <- M].
Definition check_annihilator (s : zsystem) (T : seq bool) (f : zrow) (a : annihilator) : bool :=
  let: (e, W, piv) := (a_den a, a_W a, a_pivots a) in
  let WA := zmm W (zA s) in
  let Z := zpick piv WA in
  [&& Z.ltb 0 e, size W == size piv, all (fun j => j < zn s) piv, zmat0 (zmaxpy (-1) (zidentity e (size piv)) (zpick piv W)),
      zmat0 (zmaxpy (- e) WA (zmm Z W)), all (fun bc => ~~ bc.1 || zmat0 (zmm W (zB bc.2))) (zip T (zchannels s)) &
      same_up_to_scale (a_f a) f && check_spectrum (size piv) (e * zD s)%coqZ Z (a_f a) (a_spectrum a)]%N.

(* The channels T with any outputs: sizes and matrices. *)
Definition ztogether (s : zsystem) (T : seq bool) (outs : seq (nat * zmat)) : zsystem :=
  ZSystem (zn s) (zD s) (zA s) [seq ZChannel (zp co.1) co.2.1 (zB co.1) co.2.2 | co <- zip (mask T (zchannels s)) outs] [::].

Section Lists.
Variable R : comRingType.
Lemma zcolumnE n b M u (ub : (u < b)%N) : cv R n (zcolumn M u) = col (Ordinal ub) (mx R n b M).
Proof.
apply/matrixP=> i j; rewrite !mxE; have [im|im] := ltnP i (size M); first by rewrite (nth_map [::]).
by rewrite /zcolumn nth_default ?size_map // nth_default // nth_default.
Qed.
Lemma zpickE a (piv : seq nat) M (i : 'I_a) (j : 'I_(size piv)) : mx R a (size piv) (zpick piv M) i j = phi R (nth z0 (nth [::] M i) (nth 0%N piv j)).
Proof.
rewrite mxE; have [im|im] := ltnP i (size M); first by rewrite (nth_map [::]) // (nth_map 0%N).
by rewrite (@nth_default _ [::]) ?size_map // (@nth_default _ [::] M) // !nth_nil.
Qed.
Lemma zunitE r (k : 'I_r) : cv R r (zunit 1 k) = delta_mx k 0.
Proof.
apply/matrixP=> i j; rewrite !mxE ord1 eqxx andbT /zunit nth_ncons -val_eqE /=.
case: ltngtP => ij; rewrite ?phi0 ?phi1 //; last by rewrite ij subnn phi1.
by rewrite nth_default // subn_gt0.
Qed.
(* A matrix with a right inverse, column by column. *)
Lemma right_inverse a b r (X : 'M[R]_(r, a)) (M : 'M[R]_(a, b)) :
  (forall k : 'I_r, exists y : 'cV_b, X *m (M *m y) = delta_mx k 0) -> exists Y, X *m M *m Y = 1%:M.
Proof.
case/fin_all_exists=> f e; exists (\matrix_(i, k) f k i 0); apply/matrixP=> i k.
have ck : col k (\matrix_(i, k) f k i 0) = f k by apply/matrixP=> i' j; rewrite !mxE ord1.
have := e k; rewrite -ck colE !mulmxA -colE => /matrixP/(_ i 0); rewrite !mxE => ->.
by rewrite !eqxx andbT.
Qed.
Lemma unit_imagesE lz (l0 : (0 < lz)%coqZ) (pl : phi R lz = 0) n (X : zmat) vs k : shape (size vs) n X ->
  unit_images lz X vs -> (k < size vs)%N -> forall k' : 'I_(size vs), k' = k :> nat -> mx R (size vs) n X *m cv R n (nth [::] vs k) = delta_mx k' 0.
Proof.
move=> sX /(all_nthP (0%N, [::])) ok kv k' ek; have := ok k; rewrite size_zip size_iota minnn => /(_ kv).
rewrite nth_zip ?size_iota //= nth_iota // add0n => /(zero_modE l0 pl (size vs)).
by rewrite zaxpyE -ek zunitE phiN1 scaleN1r (zmvE _ _ sX) addrC => /eqP; rewrite subr_eq0 => /eqP.
Qed.
End Lists.

Lemma same_up (K : fieldType) (h : {rmorphism rat -> K}) f g : same_up_to_scale f g -> up K f = up K g.
Proof.
case/(same_up_to_scaleP h)=> f0 g0 e; apply: (scalerI (mulf_neq0 f0 g0)); rewrite /up !scalerA mulrAC mulfV // mul1r.
by rewrite -mulrA mulfV // mulr1.
Qed.

Section Below.
Variables (R : comRingType) (lz : Z) (n b : nat) (A : 'M[R]_n) (B : 'M[R]_(n, b)).
(* A combination of the first N blocks. *)
Definition spanned N (v : 'cV[R]_n) := exists y : nat -> 'cV_b, v = \sum_(t < N) krylov A B t *m y t.
Lemma spanned_more N N' v : (N <= N')%N -> spanned N v -> spanned N' v.
Proof.
move=> le [y ->]; exists (fun t => if (t < N)%N then y t else 0); rewrite (big_ord_widen _ (fun t => krylov A B t *m y t) le) [in LHS]big_mkcond.
by apply: eq_bigr => t _; case: ifP => _; rewrite ?mulmx0.
Qed.
Lemma spanned_input v : (exists M : 'cV_b, v = B *m M) -> spanned 1 v.
Proof. by case=> M ->; exists (fun=> M); rewrite big_ord1. Qed.
Lemma spanned_next N v : spanned N v -> spanned N.+1 (A *m v).
Proof.
case=> y ->; exists (fun t => if t is t'.+1 then y t' else 0); rewrite big_ord_recl mulmx0 add0r mulmx_sumr.
by apply: eq_bigr => t _; rewrite lift0 krylovS mulmxA.
Qed.
Lemma spanned_reach N v : spanned N v -> exists y, v = reach A B N *m y.
Proof. by case=> y ->; exists (\mxcol_(t < N) y t); rewrite /reach mul_mxrow_mxcol. Qed.
Lemma spanned0 N : spanned N 0.
Proof. by exists (fun=> 0); rewrite big1 // => t _; rewrite mulmx0. Qed.

Hypotheses (l0 : (0 < lz)%coqZ) (pl : phi R lz = 0).
Variables (Az : zmat) (chs : seq zchannel).
Hypothesis stepE : forall v, cv R n (zmv Az v) = A *m cv R n v.
Definition entered (x : source) := if x is FromInput i u then exists M : 'cV_b, cv R n (zcolumn (zB (nth zch0 chs i)) u) = B *m M else True.
Lemma zvectorsE xs vs : (forall k, spanned (size vs) (cv R n (nth [::] vs k))) -> (forall k, entered (nth (FromEarlier 0) xs k)) ->
  size (zvectors lz Az chs vs xs) = (size vs + size xs)%N /\
  forall k, spanned (size vs + size xs) (cv R n (nth [::] (zvectors lz Az chs vs xs) k)).
Proof.
elim: xs vs => [|x xs IH] vs sp en /=; first by rewrite addn0.
set v := (X in rcons vs X); have := IH (rcons vs v); rewrite size_rcons addSnnS; apply=> [k|k]; last exact: (en k.+1).
have nil : cv R n [::] = 0 by apply/matrixP=> i j; rewrite !mxE nth_nil.
rewrite nth_rcons; case: ltnP => _; first exact: (spanned_more (leqnSn _) (sp k)).
case: eqP => _; last by rewrite nil; apply: spanned0.
have := en 0%N; rewrite /v /=; case: (x) => [i u /spanned_input|j _]; first by apply: spanned_more.
by rewrite (zmodE l0 pl) stepE; apply: spanned_next.
Qed.
End Below.

(* The same matrices over the smaller denominator. *)
Section Lower.
Variables (K : fieldType) (h : {rmorphism rat -> K}) (g d : Z).
Hypotheses (g0 : (0 < g)%coqZ) (d0 : (0 < d)%coqZ) (dg : Z.eqb (Z.modulo d g) 0).
Lemma quotientE x : Z.eqb (Z.modulo x g) 0 -> (x = g * (x / g))%coqZ.
Proof. by move/Z.eqb_eq => e; apply/Z.div_exact => // ge; move: g0; rewrite ge. Qed.
Lemma lower_denominator : (0 < d / g)%coqZ.
Proof.
have gd : (0 < g * (d / g))%coqZ by rewrite -(quotientE dg).
exact: (proj1 (Z.mul_pos_cancel_l _ _ g0) gd).
Qed.
Lemma lower_over a b M : divisible g M -> over K (d / g) a b (zdivs g M) = over K d a b M.
Proof.
move/(all_nthP [::]) => ok; apply/matrixP=> i j; rewrite !overE.
have nz x : (0 < x)%coqZ -> phi [comRingType of K] x != 0.
  by move=> x0; apply: phi_neq0 h _ _; apply/negP => /Z.eqb_eq e; rewrite e in x0.
have g1 := nz _ g0; have q1 := nz _ lower_denominator; have -> : phi [comRingType of K] d = phi _ g * phi _ (d / g)%coqZ by rewrite -phiM -(quotientE dg).
rewrite invfM.
have -> : phi [comRingType of K] (nth z0 (nth [::] M i) j) = phi _ g * phi _ (nth z0 (nth [::] (zdivs g M) i) j).
  have [iM|iM] := ltnP i (size M); last by rewrite (@nth_default _ [::] M) // (@nth_default _ [::] (zdivs g M)) ?size_map // nth_nil phi0 mulr0.
  rewrite (nth_map [::]) //; have [jr|jr] := ltnP j (size (nth [::] M i)); last by rewrite [nth z0 _ j]nth_default // [nth z0 (map _ _) j]nth_default ?size_map // phi0 mulr0.
  by rewrite (nth_map z0) // -phiM -quotientE //; have /(all_nthP z0) := ok i iM; apply.
by rewrite mulrACA mulVf // mul1r.
Qed.
Lemma shape_divs a b M : shape a b (zdivs g M) = shape a b M.
Proof. by rewrite /shape size_map all_map; congr (_ && _); apply: eq_all => r /=; rewrite size_map. Qed.
End Lower.

Section Sound.
Variables (s : zsystem) (T : seq bool).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Notation B_T := (inputs S (channels_at m T)).

Theorem check_reach_sound w : check_reach s T w -> (reach_of w <= \rank (reach (mcA S) B_T n))%N.
Proof.
rewrite /check_reach; case/and5P; set g := v_lower w; set s' := zlower g s => /and4P[/Z.ltb_lt g0 dg gA gB].
have D0 := lower_denominator g0 (represented_D re) dg; have sA : shape n n (zA s') by rewrite shape_divs; apply: represented_A re.
case: (re) => _ en em ep0 _ eA0 eB0 _; have eA : mcA S = over K (zD s') n n (zA s') by rewrite (lower_over h g0 (represented_D re) dg).
have chE (k : 'I_m) : channel s' k = ZChannel (zp (channel s k)) (zq (channel s k)) (zdivs g (zB (channel s k))) (zC (channel s k)).
  by rewrite /channel (nth_map zch0) // -em.
have ep (k : 'I_m) : p k = zp (channel s' k) by rewrite chE ep0.
have em' : m = size (zchannels s') by rewrite size_map.
have sB (k : 'I_m) : shape n (p k) (zB (channel s' k)) by rewrite chE shape_divs; case: (represented_channel re k).
have eB (k : 'I_m) : k \in channels_at m T -> mcB S k = over K (zD s') n (p k) (zB (channel s' k)).
  rewrite inE => kT; rewrite chE (lower_over h g0 (represented_D re) dg) //; have /(all_nthP (false, zch0))/(_ k) := gB.
  have kT' : (k < size T)%N by rewrite ltnNge; apply: contraTN kT => /(nth_default false) ->.
  by rewrite size_zip leq_min kT' -em ltn_ord nth_zip_cond size_zip leq_min kT' -em ltn_ord /= kT; apply.
rewrite -en; set lz := v_ell w; set i := v_inv w; set Az := zscale_mod _ _ _; set chs := map _ _; set vs := zvectors _ _ _ _ _.
move=> /andP[/Z.ltb_lt l1 /Z.eqb_eq inv] /(all_nthP (FromEarlier 0)) al sX ok.
pose l := modulus_of l1; have l0 := modulus_gt0 l1; pose Zl := [comRingType of 'Z_l]; have pl : phi Zl lz = 0 := phi_modulus l1.
pose SL : multichannel (Zloc l) n p q := local_system l1 D0 inv s' n p q.
pose A := map_mx (@residue l) (mcA SL); pose B := map_mx (@residue l) (inputs SL (channels_at m T)).
have resR a d M : map_mx (@residue l) (local l1 D0 inv a d M) = mx Zl a d (zscale_mod lz i M) := residue_local l1 D0 inv a d M.
have stepE v : cv Zl n (zmv Az v) = A *m cv Zl n v by rewrite /A resR; apply: zmvE; rewrite shape_scale.
have bE (k : 'I_m) : k \in channels_at m T -> mx Zl n (p k) (zscale_mod lz i (zB (channel s' k))) = B *m submxrow 1%:M k.
  by move=> kT; rewrite -resR /B map_inputs mul_submxrow mulmx1 mxrowK kT.
have en0 k : entered B chs (nth (FromEarlier 0) (v_sources w) k).
  have [kw|kw] := ltnP k (size (v_sources w)); last by rewrite nth_default.
  have := al _ kw; case: (nth _ _ _) => [c u|//] /and3P[cm cT up] /=.
  rewrite -em' in cm; pose c' := Ordinal cm; have up' : (u < p c')%N by rewrite ep.
  rewrite (nth_map zch0) -?em' // -[c]/(val c') (@zcolumnE _ n _ _ _ up') bE ?inE // colE -mulmxA.
  by exists (submxrow 1%:M c' *m delta_mx (Ordinal up') 0).
have nil : cv Zl n [::] = 0 by apply/matrixP=> r t; rewrite !mxE nth_nil.
have [|sv sp] := @zvectorsE Zl lz n _ A B l0 pl Az chs stepE (v_sources w) [::] _ en0.
  by move=> k; rewrite nth_nil nil; apply: spanned0.
rewrite -/vs add0n in sv sp; have ev : reach_of w = size vs by []. rewrite -sv in sp.
set N := maxn n (size vs); have nN : (n <= N)%N := leq_maxl _ _.
rewrite -(rank_reach_n _ _ nN); have eAB : reach (mcA S) B_T N = map_mx (into h) (reach (mcA SL) (inputs SL (channels_at m T)) N).
  rewrite map_reach map_inputs; have up a d M : map_mx (into h) (local l1 D0 inv a d M) = over K (zD s') a d M.
    by rewrite -(into_local l1 D0 inv h) -map_mx_comp.
  congr (reach _ _ N); first by rewrite up.
  by apply: eq_mxrow => k; case: ifP => // kT; rewrite eB //= up.
rewrite eAB ev in sX *; have [Y eY] : exists Y, mx Zl (size vs) n (v_X w) *m reach A B N *m Y = 1%:M.
  apply: right_inverse => k; have [y ey] := spanned_reach (spanned_more (leq_maxr n (size vs)) (sp k)).
  exists y; rewrite -ey; exact: (unit_imagesE l0 pl sX ok (ltn_ord k) erefl).
by apply: (rank_from_below h (X := mx Zl (size vs) n (v_X w)) (Y := Y)); rewrite map_reach.
Qed.

Theorem check_annihilator_sound f a : check_annihilator s T f a ->
  exists (W : 'M[K]_(size (a_pivots a), n)) (Z : 'M[K]_(size (a_pivots a))), [/\ row_free W, W *m mcA S = Z *m W, W *m B_T = 0 & char_poly Z = up K f].
Proof.
have D0 := represented_D re; have sA := represented_A re; case: (re) => _ en em ep _ eA eB _.
pose Kc := [comRingType of K]; rewrite /check_annihilator -en; set e := a_den a; set Wz := a_W a; set piv := a_pivots a; set WA := zmm _ (zA s); set Zz := zpick _ WA.
case/and5P=> /Z.ltb_lt e0 /eqP sW /(all_nthP 0%N) pn /(zmat0E Kc (size piv) (size piv)) idW /andP[/(zmat0E Kc (size piv) n) eqW /andP[ann /andP[same spec]]].
set w := size piv in idW eqW *; have nz d : (0 < d)%coqZ -> phi [comRingType of K] d != 0.
  by move=> d0; apply: phi_neq0 h _ _; apply/negP => /Z.eqb_eq ed; rewrite ed in d0.
have u0 := nz _ e0; have D1 := nz _ D0.
exists (over K e w n Wz), (over K (e * zD s) w w Zz).
have WAE : mx [comRingType of K] w n WA = mx _ w n Wz *m mx _ n n (zA s) by rewrite (zmmE _ _ _ _ (eq_leq (shape_size sA))).
split; last by rewrite -(same_up h same); apply: (check_spectrum_sound spec h).
- pose pv (k : 'I_w) := Ordinal (pn k (ltn_ord k)); apply: (pivots_free (piv := pv)); apply/matrixP=> k j.
  have /matrixP/(_ k j) := idW; rewrite zmaxpyE zidentityE phiN1 scaleN1r [in X in _ = X]mxE.
  rewrite mxE [X in X + _]mxE zpickE [X in - X + _]mxE mxE => /eqP; rewrite addrC subr_eq0 => /eqP e1.
  by rewrite !mxE /= e1 [in RHS]mulrb; case: eqP => _; rewrite ?mulr1n ?mulVf // ?mulr0n mulr0.
- have := eqW; rewrite zmaxpyE (zmmE _ _ _ _ (eq_leq sW)) phiN scaleNr addrC => /eqP; rewrite subr_eq0 => /eqP e1.
  rewrite eA /over -!scalemxAl -!scalemxAr !scalerA -WAE e1 phiM invfM scalerA.
  by congr (_ *: _); rewrite -[RHS]mulrA mulVf ?mulr1 // mulrC.
rewrite /inputs mul_mxrow; apply/mxrowP=> k; rewrite mxrowK submxrow0; case: ifP => [|_]; last by rewrite mulmx0.
rewrite inE => kT; rewrite eB /over -scalemxAl -scalemxAr.
have sB : (size (zB (channel s k)) <= n)%N by rewrite (shape_size (represented_channel re k).1).
rewrite -(zmmE _ _ _ _ sB) zmat0E ?scaler0 //; move/(all_nthP (false, zch0)): ann => /(_ k).
have kT' : (k < size T)%N by rewrite ltnNge; apply: contraTN kT => /(nth_default false) ->.
by rewrite size_zip leq_min kT' -em ltn_ord nth_zip_cond size_zip leq_min kT' -em ltn_ord /= kT; apply.
Qed.
End Sound.

(* By a bound for the channels T alone. *)
Lemma nth_mask_exists (X : Type) (x : X) T r k : (k < size (mask T r))%N ->
  exists t, [/\ (t < size r)%N, nth false T t & nth x (mask T r) k = nth x r t].
Proof.
elim: T r k => [|b T IH] [|y r] k //=; case: b => /=; last first.
  by move=> /IH[t [tr Tt ->]]; exists t.+1.
by case: k => [_|k] /=; [exists 0%N | move=> /IH[t [tr Tt ->]]; exists t.+1].
Qed.
Theorem together_reach s T outs L (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> bounded (system_of K (ztogether s T outs)) L ->
  (L <= \rank (reach (mcA S) (inputs S (channels_at m T)) n))%N.
Proof.
move=> re; case: (re) => sz en em ep _ eA eB _; subst n; rewrite eA; set B_T := inputs _ _.
have within c Bz (t : 'I_m) : t \in channels_at m T -> c = zp (channel s t) -> Bz = zB (channel s t) ->
    exists M : 'M_(\sum_i p i, c), over K (zD s) (zn s) c Bz = B_T *m M.
  move=> tT -> ->; have [|X eX] := (inputs_within S (channels_at m T) B_T).1 _ t tT.
    by exists 1%:M; rewrite mulmx1.
  by move: X eX; rewrite eB (ep t) => X ->; exists X.
apply: bounded_reach => k; have := ltn_ord k; rewrite /= /channel; move: (nat_of_ord k) => j; rewrite /= => jc.
move: (jc); rewrite size_map size_zip leq_min => /andP[/(nth_mask_exists zch0)[t [tm Tt et]] ko].
have kz : (j < size (zip (mask T (zchannels s)) outs))%N by move: jc; rewrite size_map.
rewrite -em in tm; rewrite (nth_map (zch0, (0%N, [::]))) // nth_zip_cond kz /= et.
by apply: (within _ _ (Ordinal tm)); rewrite ?inE.
Qed.

(* The claim: the dimension of what the inputs of T reach, and how A acts on the rows that annihilate it. *)
Record zreach := ZReach { r_T : seq bool; r_dim : nat; r_all : bool; r_poly : zrow }.
Section Claim.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q) (c : zreach).
Notation B_T := (inputs S (channels_at m (r_T c))).
Definition reach_holds : Prop :=
  [/\ \rank (reach (mcA S) B_T n) = r_dim c, r_all c = (r_dim c == n),
      forall lambda, uncontrollable_mode (mcA S) B_T lambda = root (up K (r_poly c)) lambda &
      exists w (W : 'M[K]_(w, n)) (Z : 'M[K]_w), (w + r_dim c)%N = n /\
        [/\ row_free W, W *m mcA S = Z *m W, W *m B_T = 0 & char_poly Z = up K (r_poly c)]].
Definition reach_sizes (s : zsystem) (a : annihilator) : bool := (size (a_pivots a) + r_dim c == zn s)%N && (r_all c == (r_dim c == zn s)).

Theorem reach_claim s (h : {rmorphism rat -> K}) a : represents s S -> check_annihilator s (r_T c) (r_poly c) a -> reach_sizes s a ->
  (r_dim c <= \rank (reach (mcA S) B_T n))%N -> reach_holds.
Proof.
move=> re ok /andP[/eqP sw /eqP all] low; have [W [Z [fW eW zW eZ]]] := check_annihilator_sound h re ok.
have en := re_n re; rewrite -en in sw all; set w := size _ in sw W Z fW eW zW eZ.
have dn : (n - w)%N = r_dim c by rewrite -sw addKn.
split=> //; last by exists w, W, Z.
  by apply/eqP; rewrite eqn_leq low -dn (uncontrollable_space n fW eW zW).
by move=> lambda; rewrite -eZ; apply: (uncontrollable_modes lambda fW eW zW (k := n)); rewrite dn.
Qed.
End Claim.
