(* checker/core/roots.py, is_hurwitz (L2 and L3 of location.md): Routh's array in integers.
   Each row is a positive multiple of Routh's, so the signs of the first entries decide as the recursion on
   rational polynomials does (location.is_hurwitzP).  A division that is not exact gives no answer. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location mobius moved_roots.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Two rows, and the numbers by which the next two are divided. *)
Fixpoint routh_array k (u v : seq int) (d e : int) : option bool :=
  if v is v0 :: v' then
    if v0 <= 0 then Some false else
    let next := [seq v0 * ab.1 - head 0 u * ab.2 | ab <- zip (behead u) (rcons v' 0)] in
    if all (fun x => d %| x)%Z next then
      if k is k'.+1 then routh_array k' v [seq (x %/ d)%Z | x <- next] e v0 else None
    else None
  else Some true.

Definition evens (s : seq int) := mkseq (fun j => s`_j.*2) (uphalf (size s)).
Definition odds (s : seq int) := mkseq (fun j => s`_j.*2.+1) (size s)./2.

(* is_hurwitz, from the integer coefficients in descending order. *)
Definition hurwitz_integers (s : seq int) := routh_array (size s) (evens s) (odds s) 1 1.

Section Rows.
Implicit Types (p : {poly rat}) (u v : seq int).

Lemma size_routh_step p n : size p = n.+2 -> p`_n != 0 ->
  size (routh_step p) = n.+1 /\ lead_coef (routh_step p) = p`_n.
Proof.
move=> sp pn; have qn : (routh_step p)`_n = p`_n by rewrite /routh_step sp coef_poly ltnSn subSnn andbF.
have sq : size (routh_step p) = n.+1.
  apply/eqP; rewrite eqn_leq {1}/routh_step sp size_poly ltnNge.
  by apply: contra pn => /leq_sizeP/(_ n (leqnn n)); rewrite qn => ->.
by rewrite lead_coefE sq.
Qed.

(* u and v are positive multiples of p_n, p_(n-2), ... and p_(n-1), p_(n-3), ... *)
Record tracks p n u v a b := Tracks {
  tracks_a : 0 < a; tracks_b : 0 < b;
  tracks_u : size u = n./2.+1; tracks_v : size v = uphalf n;
  upper : forall j, (j.*2 <= n)%N -> (u`_j)%:~R = a * p`_(n - j.*2);
  lower : forall j, (j.*2 < n)%N -> (v`_j)%:~R = b * p`_(n - j.*2.+1) }.

Lemma tracks_next p n u v a b d (v0 := v`_0) (next := [seq v0 * ab.1 - head 0 u * ab.2 | ab <- zip (behead u) (rcons (behead v) 0)]) :
  size p = n.+2 -> tracks p n.+1 u v a b -> 0 < v0 -> 0 < d -> all (fun x => d %| x)%Z next ->
  tracks (routh_step p) n v [seq (x %/ d)%Z | x <- next] b (a * v0%:~R / d%:~R).
Proof.
move=> sp [a0 b0 su sv hu hv] v00 d0 /allP dvd.
have sz : size (zip (behead u) (rcons (behead v) 0)) = uphalf n.
  rewrite size_zip size_rcons !size_behead su sv; apply/minn_idPl.
  by rewrite -[(n.+1)./2.+1.-1]/(uphalf n) -[uphalf n.+1]/(n./2.+1) /= uphalf_half; case: odd.
have dr : d%:~R != 0 :> rat by rewrite intr_eq0 gt_eqF.
have v0r : 0 < v0%:~R :> rat by rewrite ltr0z.
have v0E : v0%:~R = b * p`_n by have := hv 0%N isT; rewrite subSS subn0.
have pn : p`_n != 0 by move: v0r; rewrite v0E; apply: contraTneq => ->; rewrite mulr0 ltxx.
have u0E : (head 0 u)%:~R = a * p`_n.+1 by rewrite -nth0; have := hu 0%N isT; rewrite subn0.
split; rewrite ?size_map ?sz //; first by rewrite divr_gt0 ?mulr_gt0// ltr0z.
  move=> j jn; rewrite hv ?ltnS// subSS; congr (_ * _); rewrite coef_poly sp /= ltnS leq_subr.
  by rewrite subSn ?leq_subr// subKn// /= odd_double andbF.
move=> j jn; have jz : (j < uphalf n)%N by rewrite ltnNge leq_uphalf_double -ltnNge.
have jn' : (j < size next)%N by rewrite size_map sz.
apply: (mulIf dr); rewrite [RHS]mulrAC divfK// (nth_map 0)// -rmorphM /= divzK ?dvd ?mem_nth//.
rewrite (nth_map (0, 0)) ?sz// nth_zip_cond sz jz /= nth_rcons_default !nth_behead.
rewrite rmorphB !rmorphM /= u0E hu ?doubleS ?ltnS// subSS subnS.
rewrite -subnS; pose i := (n - j.*2.+1)%N; have ij : (n.+1 - i)%N = j.*2.+2 by rewrite /i subSn ?leq_subr// subKn.
rewrite -/i coef_poly sp /= ltnS leq_subr ij /= negbK odd_double andbT.
have [i0|i1] := posnP i.
  rewrite [v`_j.+1]nth_default; first by rewrite mulr0 subr0 mulrCA mulrA.
  have -> : size v = n./2.+1 by [].
  by rewrite ltnS -(subnK jn) -/i i0 /= uphalf_double.
rewrite (hv j.+1); last by rewrite doubleS ltnS -subn_gt0.
rewrite doubleS subSS subnS -/i v0E mulrBr; congr (_ - _); first by rewrite mulrCA mulrA.
rewrite [p`_n.+1 / _]mulrC -!mulrA mulVKf//.
by congr (_ * _); rewrite mulrCA.
Qed.

(* The signs of the first entries decide as the recursion on polynomials does. *)
Lemma routh_arrayE k p n u v a b d e t : size p = n.+1 -> tracks p n u v a b -> 0 < d -> 0 < e ->
  routh_array k u v d e = Some t -> t = is_hurwitz n p.
Proof.
elim: k p n u v a b d e => [|k IH] p [|n] u v a b d e sp tr d0 e0.
- by have := tracks_v tr; case: v {tr} => //= _ [<-].
- have := tracks_v tr; case: v tr => // v0 v tr _ /=; rewrite sp /=.
  have := lower tr (isT : (0.*2 < n.+1)%N); rewrite subSS subn0 /= => v0E.
  have <- : (0 < v0) = (0 < p`_n) by rewrite -(ltr0z [numDomainType of rat]) v0E pmulr_rgt0 ?(tracks_b tr).
  by case: ltP => //; [case: ifP|move=> _ [<-]].
- by have := tracks_v tr; case: v {tr} => //= _ [<-].
have := tracks_v tr; case: v tr => // v0 v tr _ /=; rewrite sp /=.
have := lower tr (isT : (0.*2 < n.+1)%N); rewrite subSS subn0 /= => v0E.
have <- : (0 < v0) = (0 < p`_n) by rewrite -(ltr0z [numDomainType of rat]) v0E pmulr_rgt0 ?(tracks_b tr).
case: (ltP 0 v0) => [v00|_ [<-]//]; case: ifP => // dvd h; rewrite /=.
have pn : p`_n != 0.
  by apply: contraTneq v00 => e1; rewrite -(ltr0z [numDomainType of rat]) v0E e1 mulr0 ltxx.
have [sq _] := size_routh_step sp pn.
exact: (IH _ _ _ _ _ _ _ _ sq (tracks_next sp tr v00 d0 dvd) e0 v00 h).
Qed.

(* The first two rows. *)
Lemma tracks_start p (w : seq int) n : size p = n.+1 -> size w = n.+1 ->
  (forall k, (k <= n)%N -> (w`_k)%:~R = p`_(n - k)) -> tracks p n (evens w) (odds w) 1 1.
Proof.
move=> sp sw e; split=> //; rewrite ?size_mkseq ?sw//.
  by move=> j jn; rewrite nth_mkseq ?e ?mul1r// sw -[uphalf _]/(n./2.+1) ltnS geq_half_double.
by move=> j jn; rewrite nth_mkseq ?e ?mul1r// sw -[(_.+1)./2]/(uphalf n) ltnNge leq_uphalf_double -ltnNge.
Qed.
End Rows.

(* The rule: p made monic, x / t in place of x, and all coefficients multiplied by s, in descending order. *)
Section Rule.
Variable C : numClosedFieldType.
Notation up := (map_poly (ratr : rat -> C)).

Theorem is_hurwitz_integers (p : {poly rat}) (t s : rat) (w : seq int) answer : p != 0 -> 0 < t -> 0 < s ->
  size w = size p -> (forall k, (k < size p)%N -> (w`_k)%:~R = s * (p`_((size p).-1 - k) / lead_coef p * t ^+ k)) ->
  hurwitz_integers w = Some answer -> hurwitz (up p) <-> answer.
Proof.
move=> p0 t0 s0 sw hw hh; pose d := (size p).-1.
have sp : size p = d.+1 by rewrite /d prednK// size_poly_gt0.
have l0 : lead_coef p != 0 by rewrite lead_coef_eq0.
have tn : t != 0 by rewrite gt_eqF.
pose c := s * t ^+ d / lead_coef p; pose P := c *: scaled p t^-1.
have c0 : c != 0 by rewrite /c !mulf_neq0 ?invr_eq0 ?expf_neq0// gt_eqF.
have Pk k : (k <= d)%N -> P`_(d - k) = s * (p`_(d - k) / lead_coef p * t ^+ k).
  move=> kd; rewrite coefZ coef_poly sp ltnS leq_subr exprVn /c -(subnK kd) exprD addnK.
  rewrite -!mulrA; congr (_ * _); rewrite mulrC -!mulrA mulVf ?expf_neq0// mulr1.
  by rewrite mulrCA [RHS]mulrCA; congr (_ * _); rewrite mulrC.
have sP : size P = d.+1.
  by rewrite size_scale// /scaled size_poly_eq// mulf_neq0 ?expf_neq0 ?invr_eq0//.
have lP : lead_coef P = s.
  by rewrite lead_coefE sP -[d.+1.-1]subn0 Pk// subn0 expr0 mulr1 -lead_coefE divff ?mulr1.
have tr : tracks P d (evens w) (odds w) 1 1.
  by apply: tracks_start => // [|k kd]; rewrite ?sw// hw ?sp ?ltnS// Pk.
have -> : answer = is_hurwitz (size P).-1 P.
  by rewrite sP; apply: (routh_arrayE sP tr ltr01 ltr01 hh).
have e : hurwitz (up P) <-> hurwitz (up p).
  have bt : 0 < ratr t^-1 :> C by rewrite ltr0q invr_gt0.
  have cC : ratr c != 0 :> C by rewrite fmorph_eq0.
  have rE z : root (up P) z = root (up p) (ratr t^-1 * z).
    by rewrite map_polyZ rootZ// map_scaled scaled_roots.
  have reE z : ('Re (ratr t^-1 * z) < 0) = ('Re z < 0).
    by rewrite (ReMl (ratr_real _ _)) /= pmulr_rlt0 ?ltr0q ?invr_gt0.
  split=> h z; last by rewrite rE -reE => /h.
  by have := h ((ratr t^-1)^-1 * z); rewrite rE -reE mulVKf ?gt_eqF.
rewrite -e; split; first by move/routh_rational => ->//; rewrite lP.
by move=> hk; apply/routh_rational => //; rewrite lP.
Qed.

(* in_region with Routh's array: w are the integer coefficients made from q, in descending order. *)
Definition integers_of (q : {poly rat}) (w : seq int) := exists t s : rat, [/\ 0 < t, 0 < s, size w = size q &
  forall k, (k < size q)%N -> (w`_k)%:~R = s * (q`_((size q).-1 - k) / lead_coef q * t ^+ k)].

Theorem in_region_continuous (p : {poly rat}) b w answer : p != 0 -> integers_of (shifted p b) w ->
  hurwitz_integers w = Some answer -> (forall z : C, root (up p) z -> 'Re z < - ratr b) <-> answer.
Proof.
move=> p0 [t [s [t0 s0 sw hw]]] h; have n0 : shifted p b != 0.
  by rewrite shiftedE -size_poly_gt0 size_comp_poly2 ?size_XsubC// size_poly_gt0.
by rewrite -(is_hurwitz_integers n0 t0 s0 sw hw h) map_shifted; apply: rate_rule; apply: ratr_real.
Qed.

Theorem in_region_discrete (p : {poly rat}) b (q := moebius (scaled p b)) w answer : p != 0 -> 0 < b ->
  (q`_(size p).-1 = 0 -> answer = false) ->
  (q`_(size p).-1 != 0 -> integers_of q w /\ hurwitz_integers w = Some answer) ->
  (forall z : C, root (up p) z -> `|z| < ratr b) <-> answer.
Proof.
move=> p0 b0 zero other; have b0' : 0 < ratr b :> C by rewrite ltr0q.
have ss : size (scaled p b) = size p.
  by rewrite /scaled size_poly_eq// mulf_neq0 -?lead_coefE ?lead_coef_eq0// expf_neq0// gt_eqF.
have s0 : up (scaled p b) != 0 by rewrite map_poly_eq0 -size_poly_gt0 ss size_poly_gt0.
have eq : transformed (up (scaled p b)) = up q by rewrite map_moebius moebiusE.
have el : (q`_(size p).-1 != 0) = ((up (scaled p b)).[-1] != 0).
  have -> : -1 = ratr (-1) :> C by rewrite rmorphN1.
  by rewrite /q -ss moebius_lead mulf_eq0 signr_eq0 horner_map fmorph_eq0.
rewrite (radius_rule _ b0') -map_scaled (schur_mobius s0) eq -el.
have [/zero ->|nq] := eqVneq; first by split=> // -[].
have [[t [s [t0 s0' sw hw]]] h] := other nq.
have q0 : q != 0 by apply: contraNneq nq => ->; rewrite coef0.
by rewrite (is_hurwitz_integers q0 t0 s0' sw hw h); split=> // -[].
Qed.
End Rule.
