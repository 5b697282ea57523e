(* Rule ShrunkSubspace, checker/core/evidence.py, shrunk_subspace and _local_subspace: p^d divides det(xI - A_F) for all
   gains F, and the pencil of the channels outside T loses the rank d at every root of p.

   Modulo p, (xI - A) U = Y V and C_i U = 0 for i outside T; the columns of the integer matrix Y span the B_i for i in
   T; some rows of U are the identity, and U has d columns more than Y.  Certificates have B_T in place of Y, and its
   rank in place of the number of columns: who prepares the witness finds Y and X with B_i = Y X_i.  One of some states Z
   that drive others, D, proves the same of the whole system, if no others follow Z and D without acting on Z
   (local_subspace.v).  One of the dual system proves the same for the other channels (dual_subspace.v). *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence shrunk_multiplicity local_subspace dual_subspace.
From mcexact.kernel Require Import lists systems.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* U over b_den, V over zD b_den, X_i over zD b_dX. *)
Record shrunk_witness := ShrunkWitness { b_T : seq bool; b_U : seq zmat; b_V : seq zmat; b_den : Z; b_pivots : seq nat;
  b_rank : nat; b_Y : zmat; b_X : seq zmat; b_dX : Z }.
(* The rows at the pivots are d times the identity in the first layer, and 0 in the others. *)
Definition pivots_ok (first : bool) (d : Z) (piv : seq nat) (U : zmat) : bool :=
  all (fun rp => zrow0 (zaxpy (-1) (if first then zunit d rp.1 else [::]) (nth [::] U rp.2))) (zip (iota 0 (size piv)) piv).
Definition check_shrunk (s : zsystem) (p : zrow) (c : shrunk_witness) (d : nat) : bool :=
  let: (n, chs, T, U, V) := (zn s, zchannels s, b_T c, b_U c, b_V c) in
  let: (L, dp, m) := ((size p).-1, last z0 p, size chs) in
  let top := nth [::] U L.-1 in
  [&& 1 < size p, ~~ Z.eqb dp 0, ~~ Z.eqb (b_den c) 0, ~~ Z.eqb (b_dX c) 0 &
  [&& size T == m, size U <= L, size V <= L, all (fun M : zmat => size M <= n) U, all (fun M : zmat => size M <= b_rank c) V &
  [&& all (fun t => zmat0 (zmaxpy (- (zD s * dp)) (if t is t'.+1 then nth [::] U t' else [::])
        (zmaxpy dp (zmaxpy 1 (zmm (zA s) (nth [::] U t)) (zmm (b_Y c) (nth [::] V t)))
           (zmaxpy (zD s * nth z0 p t) top [::])))) (iota 0 L.+1),
      all (fun bc => bc.1 || all (fun M => zmat0 (zmm (zC bc.2) M)) U) (zip T chs) &
  [&& all (fun i => i < n) (b_pivots c), all (fun tM => pivots_ok (tM.1 == 0) (b_den c) (b_pivots c) tM.2) (zip (iota 0 (size U)) U), 0 < size U,
      size (b_X c) == m,
      all (fun bcX => let: (b, (ch, X)) := bcX in ~~ b || (size X <= b_rank c) && zmat0 (zmaxpy (- b_dX c) (zB ch) (zmm (b_Y c) X)))
        (zip T (zip chs (b_X c))) &
      b_rank c + d <= size (b_pivots c)]]]]%N.

Section PolyMatrix.
Variables (K : fieldType) (a b L : nat) (f : nat -> 'M[K]_(a, b)).
Definition polymx : 'M[{poly K}]_(a, b) := \matrix_(i, j) \poly_(t < L) f t i j.
Hypothesis f0 : forall t, (L <= t)%N -> f t = 0.
Lemma coef_polymx i j t : (polymx i j)`_t = f t i j.
Proof. by rewrite mxE coef_poly; case: ltnP => // /f0 ->; rewrite mxE. Qed.
Lemma coef_polymx_mul e (M : 'M[K]_(e, a)) i j t : ((map_mx polyC M *m polymx) i j)`_t = (M *m f t) i j.
Proof.
rewrite !mxE coef_sum; apply: eq_bigr => k _; by rewrite [map_mx _ _ _ _]mxE coefCM coef_polymx.
Qed.
End PolyMatrix.
Lemma sub3 (R : ringType) a b (M N P : 'M[R]_(a, b)) i j : (M - N - P) i j = M i j - N i j - P i j.
Proof. by rewrite !mxE. Qed.

(* The channels at which a mask is true. *)
Definition channels_at m (mk : seq bool) : {set 'I_m} := [set i : 'I_m | nth false mk i].
Lemma channels_at_compl m mk : size mk = m -> channels_at m (map negb mk) = ~: channels_at m mk.
Proof. by move=> sm; apply/setP=> i; rewrite !inE (nth_map false) // sm. Qed.

Section Shrunk.
Variables (s : zsystem) (pl : zrow) (c : shrunk_witness) (d : nat).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Notation T := (channels_at m (b_T c)).
Notation phi := (phi [comRingType of K]).
Notation mx := (mx [comRingType of K]).

Theorem check_shrunk_subspace : check_shrunk s pl c d -> shrunk_subspace S (up K pl) T d.
Proof.
have D0 := represented_D re; case: (re) => _ en em ep eq eA eB eC.
rewrite /check_shrunk -en; set L := (size pl).-1; set dp := last _ pl.
case/and5P=> p1 dp0 den0 dX0; case/and5P=> /eqP sT sU sV /(all_nthP [::]) nU.
case/andP=> /(all_nthP [::]) rV; case/and3P=> /allP ident /(all_nthP (false, zch0)) out.
case/and5P=> /(all_nthP 0%N) piv /(all_nthP (0%N, [::])) pivs U0 /eqP sX /andP[/(all_nthP (false, (zch0, [::]))) rk count].
have sp : size pl = L.+1 by rewrite /L prednK // ltnW.
have L0 : (0 < L)%N by rewrite -ltnS -sp.
have phiD0 : phi (zD s) != 0 by apply: (phi_neq0 h); apply/negP => /Z.eqb_eq e; rewrite e in D0.
have phid0 := phi_neq0 h den0; have phip0 := phi_neq0 h dp0; have phiX0 := phi_neq0 h dX0.
pose u := size (b_pivots c); pose r := b_rank c.
pose lay w a (Ms : seq zmat) t : 'M[K]_(a, u) := (phi w)^-1 *: mx a u (nth [::] Ms t).
have lay0 w a Ms t : (size Ms <= t)%N -> lay w a Ms t = 0 by move=> le; rewrite /lay nth_default // mx_nil scaler0.
pose dV := (zD s * b_den c)%coqZ.
have layV0 t : (L <= t)%N -> lay dV r (b_V c) t = 0 by move=> le; apply: lay0; rewrite (leq_trans sV).
have layU0 t : (L <= t)%N -> lay (b_den c) n (b_U c) t = 0 by move=> le; apply: lay0; rewrite (leq_trans sU).
pose U := polymx L (lay (b_den c) n (b_U c)); pose V := polymx L (lay dV r (b_V c)).
pose Y : 'M[K]_(n, r) := mx n r (b_Y c).
have nUt t : (size (nth [::] (b_U c) t) <= n)%N.
  by have [lt|le] := ltnP t (size (b_U c)); [apply: nU|rewrite nth_default].
have rVt t : (size (nth [::] (b_V c) t) <= r)%N.
  by have [lt|le] := ltnP t (size (b_V c)); [apply: rV|rewrite nth_default].
pose top := lay (b_den c) n (b_U c) L.-1.
have AU t : mcA S *m lay (b_den c) n (b_U c) t = (phi dV)^-1 *: mx n u (zmm (zA s) (nth [::] (b_U c) t)).
  by rewrite eA /over /lay (zmmE _ _ _ _ (nUt t)) -scalemxAl -scalemxAr scalerA phiM -invfM.
have YV t : Y *m lay dV r (b_V c) t = (phi dV)^-1 *: mx n u (zmm (b_Y c) (nth [::] (b_V c) t)).
  by rewrite /lay /Y -scalemxAr -(zmmE _ _ _ _ (rVt t)).
have E t : (if t is t'.+1 then lay (b_den c) n (b_U c) t' else 0) - mcA S *m lay (b_den c) n (b_U c) t
    - Y *m lay dV r (b_V c) t = (up K pl)`_t *: top.
  have [tL|tL] := leqP t L; last first.
    rewrite layU0 ?(ltnW tL) // layV0 ?(ltnW tL) // !mulmx0 !subr0 upE nth_default ?sp // phi0 mulr0 scale0r.
    by case: t tL => // t; rewrite ltnS => tL; apply: layU0.
  have := ident t; rewrite mem_iota add0n ltnS tL => /(_ isT) /(zmat0E [comRingType of K] n u).
  rewrite AU YV !zmaxpyE phiN !phiM phi1 scale1r mx_nil addr0 upE -/dp.
  have -> : (if t is t'.+1 then lay (b_den c) n (b_U c) t' else 0) =
      (phi (b_den c))^-1 *: mx n u (if t is t'.+1 then nth [::] (b_U c) t' else [::]).
    by case: t {tL} => [|t] //; rewrite mx_nil scaler0.
  rewrite /top /lay; move: (mx n u _) (mx n u _) (mx n u _) (mx n u _) => M4 M3 M2 M1.
  rewrite scaleNr addrC => /eqP; rewrite subr_eq0 => /eqP e.
  have -> : (phi (b_den c))^-1 *: M1 = (phi (zD s) * phi dp * phi (b_den c))^-1 *: ((phi (zD s) * phi dp) *: M1).
    by rewrite scalerA invfM mulrAC mulVf ?mul1r // mulf_neq0.
  rewrite -e !scalerDr !scalerA.
  have -> : (phi (zD s) * phi dp * phi (b_den c))^-1 * phi dp = (phi (zD s) * phi (b_den c))^-1.
    by rewrite [_ * phi dp * _]mulrAC invfM mulfVK.
  have -> : (phi (zD s) * phi dp * phi (b_den c))^-1 * (phi (zD s) * phi (nth z0 pl t)) = (phi dp)^-1 * phi (nth z0 pl t) / phi (b_den c).
    by rewrite -mulrA invfM mulrACA mulVf // mul1r invfM mulrAC.
  by rewrite -addrA -opprD [X in X - _]addrC addrK.
have hp (k : 'I_u) : (nth 0%N (b_pivots c) k < n)%N by apply: piv.
pose pv (k : 'I_u) := Ordinal (hp k).
have stateE : ('X%:M - map_mx polyC (mcA S)) *m U - map_mx polyC Y *m V = up K pl *: map_mx polyC top.
  apply/matrixP=> i j; apply/polyP=> t.
  rewrite mulmxBl mul_scalar_mx [LHS](_ : _ = ((if t is t'.+1 then lay (b_den c) n (b_U c) t' else 0)
    - mcA S *m lay (b_den c) n (b_U c) t - Y *m lay dV r (b_V c) t) i j); last first.
    rewrite !sub3 !coefB; congr (_ - _ - _).
    - by rewrite mxE coefXM; case: t => [|t] /=; [rewrite mxE | apply: coef_polymx].
    - exact: coef_polymx_mul.
    exact: coef_polymx_mul.
  by rewrite E !mxE coefMC.
refine (@ShrunkSubspace _ _ _ _ _ _ _ _ _ r u Y U V pv _ _ _ _ _).
- apply/inputs_within => k; rewrite inE => kT.
  exists ((phi (zD s) * phi (b_dX c))^-1 *: mx r (p k) (nth [::] (b_X c) k)).
  have := rk k; rewrite !size_zip sT sX !minnn -em ltn_ord => /(_ isT); rewrite !nth_zip ?size_zip ?sT ?sX ?minnn //= kT /=.
  case/andP=> sXk /(zmat0E [comRingType of K] n (p k)); rewrite zmaxpyE (zmmE _ _ _ _ sXk) phiN scaleNr addrC => /eqP.
  by rewrite subr_eq0 -scalemxAr => /eqP ->; rewrite eB /over scalerA invfM mulfVK.
- by move=> i j; rewrite stateE !mxE dvdp_mulr.
- move=> i iT k j; suff -> : map_mx polyC (mcC S i) *m U = 0 by rewrite mxE dvdp0.
  apply/matrixP=> a b; apply/polyP=> t; rewrite (coef_polymx_mul layU0) [in RHS]mxE coef0.
  suff -> : mcC S i *m lay (b_den c) n (b_U c) t = 0 by rewrite mxE.
  have [lt|le] := ltnP t (size (b_U c)); last by rewrite lay0 // mulmx0.
  rewrite eC /over -scalemxAl -scalemxAr -(zmmE _ _ _ _ (nUt t)).
  have := out i; rewrite size_zip sT -em minnn ltn_ord => /(_ isT); rewrite nth_zip ?sT //= => /orP[iT'|/(all_nthP [::]) z].
    by rewrite inE iT' in iT.
  by rewrite zmat0E ?scaler0 //; apply: z.
- move=> k j; suff -> : rowsub pv U = 1%:M by rewrite subrr mxE dvdp0.
  apply/matrixP=> a b; apply/polyP=> t; rewrite mxE coef_polymx // /lay !mxE.
  have [lt|le] := ltnP t (size (b_U c)); last first.
    rewrite (nth_default _ le) !nth_nil mulr0; have t0 : (0 < t)%N by apply: leq_trans le.
    by case: eqP; rewrite ?coefC ?coef0 // eqn0Ngt t0.
  have := pivs t; rewrite size_zip size_iota minnn lt => /(_ isT); rewrite nth_zip ?size_iota //= nth_iota // add0n.
  move/(all_nthP (0%N, 0%N))/(_ a); rewrite size_zip size_iota minnn ltn_ord => /(_ isT).
  rewrite nth_zip ?size_iota //= nth_iota // add0n => /(zrow0_nth [comRingType of K] b).
  rewrite zaxpy_nth phiN1 mulN1r addrC => /eqP; rewrite subr_eq0 => /eqP ->.
  case: eqP => [->|/eqP t0].
    rewrite /zunit nth_ncons -val_eqE /=; case: ltngtP => ab; rewrite ?phi0 ?mulr0 ?coefC //.
      by rewrite nth_default ?phi0 ?mulr0 ?coef0 //= subn_gt0.
    by rewrite ab subnn /= mulVf.
  by rewrite nth_nil phi0 mulr0; case: (a == b); rewrite ?coefC ?coef0 // (negPf t0).
exact: count.
Qed.

Lemma closed_loop_id (F : gains K p q) : closed_loop (map_system idfun S) F = closed_loop S F.
Proof. by rewrite /closed_loop /= map_mx_id //; congr (_ + _); apply: eq_bigr => k _; rewrite !map_mx_id. Qed.
Lemma pencil_id T' lambda : pencil (map_system idfun S) T' lambda = pencil S T' lambda.
Proof.
have := @map_pencil _ _ [rmorphism of @idfun K] _ _ _ _ S T' lambda; rewrite map_mx_id // => ->.
Qed.

Lemma loss_sound (P : {poly K}) T' : P != 0 -> rank_loss S P T' d ->
  (forall F, P ^+ d %| char_poly (closed_loop S F)) /\
  (forall lambda, root P lambda -> (\rank (pencil S (~: T') lambda) + d <= n)%N).
Proof.
move=> P0 loss; split=> [F|lambda rt].
  have := @shrunk_subspace_divides _ _ _ _ _ S _ _ _ loss _ [rmorphism of @idfun K] F P0.
  by rewrite map_poly_id // closed_loop_id.
have := @shrunk_subspace_pencil _ _ _ _ _ S _ _ _ loss _ [rmorphism of @idfun K] lambda.
by rewrite map_poly_id // pencil_id; apply.
Qed.

Lemma checked_nonzero s' : check_shrunk s' pl c d -> up K pl != 0.
Proof. by move=> ok; apply/monic_neq0/(up_monic h); move: ok; rewrite /check_shrunk => /and5P[]. Qed.

Theorem check_shrunk_sound : check_shrunk s pl c d ->
  (forall F, up K pl ^+ d %| char_poly (closed_loop S F)) /\
  (forall lambda, root (up K pl) lambda -> (\rank (pencil S (~: T) lambda) + d <= n)%N).
Proof. by move=> ok; apply: loss_sound (checked_nonzero ok) _; apply: check_shrunk_subspace. Qed.
End Shrunk.

(* The channels of the dual system's subspace are s, and T are the others. *)
Theorem check_dual_sound s pl c d (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> check_shrunk (zdual s) pl c d ->
  (forall F, up K pl ^+ d %| char_poly (closed_loop S F)) /\
  (forall lambda, root (up K pl) lambda -> (\rank (pencil S (~: channels_at m (map negb (b_T c))) lambda) + d <= n)%N).
Proof.
move=> re ok; apply: loss_sound (checked_nonzero h ok) _.
have sT : size (b_T c) = m.
  move: ok; rewrite /check_shrunk => /and5P[_ _ _ _ /and5P[/eqP -> _ _ _ _]].
  by rewrite size_map (re_m re).
apply: dual_subspace_loss; rewrite channels_at_compl // setCK.
exact: (check_shrunk_subspace h (dual_represents re) ok).
Qed.

(* The subspace of some states Z: nothing that they drive, D, acts on them. *)
Definition check_driven (s : zsystem) (Z D T : seq bool) : bool :=
  [&& size Z == zn s, size D == zn s, all (fun zd => ~~ (zd.1 && zd.2)) (zip Z D),
      all (fun x => let: (z, (d, r)) := x in d || zrow0 (mask D r) && (z || zrow0 (mask Z r))) (zip Z (zip D (zA s))) &
      (size T == size (zchannels s)) && all (fun bc => if bc.1
        then all (fun x => let: (z, (d, r)) := x in [|| z, d | zrow0 r]) (zip Z (zip D (zB bc.2)))
        else all (fun r => zrow0 (mask D r)) (zC bc.2)) (zip T (zchannels s))].
Lemma mask_zero (R : comRingType) held r b : zrow0 (mask held r) -> nth false held b -> phi R (nth z0 r b) = 0.
Proof.
elim: held r b => [|c held IH] [|x r] b; rewrite ?nth_nil ?phi0 //; case: b => [|b]; case: c => //=.
- by case/andP=> /Z.eqb_eq ->.
- by case/andP=> _; apply: IH.
exact: IH.
Qed.
Section Local.
Variables (s : zsystem) (Z D T : seq bool).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypotheses (re : represents s S) (ok : check_driven s Z D T).
Notation inZ := (masked Z n).
Notation inD := (masked D n).
Record driven_states : Prop := DrivenStates {
  ds_apart : forall a, a \in inD -> a \notin inZ;
  ds_closed : forall a b, a \notin inD -> b \in inD -> mcA S a b = 0;
  ds_driven : forall a b, a \notin inZ -> a \notin inD -> b \in inZ -> mcA S a b = 0;
  ds_acting : forall i a u, i \in channels_at m T -> a \notin inZ -> a \notin inD -> mcB S i a u = 0;
  ds_unseen : forall i v b, i \notin channels_at m T -> b \in inD -> mcC S i v b = 0 }.
Lemma driven_states_of : driven_states /\ size Z = n.
Proof.
have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC; move: ok; rewrite /check_driven -en.
case/and5P=> /eqP sZ /eqP sD /(all_nthP (false, false)) ap /(all_nthP (false, (false, [::]))) rows /andP[/eqP sT /(all_nthP (false, zch0)) chs].
have row (a : 'I_n) : nth false D a || zrow0 (mask D (nth [::] (zA s) a)) && (nth false Z a || zrow0 (mask Z (nth [::] (zA s) a))).
  have := rows a; rewrite !size_zip sZ sD (shape_size sA) !minnn ltn_ord => /(_ isT).
  by rewrite !nth_zip ?size_zip ?sZ ?sD ?(shape_size sA) ?minnn.
have ch (i : 'I_m) : if nth false T i then all (fun x => let: (z, (d, r)) := x in [|| z, d | zrow0 r]) (zip Z (zip D (zB (channel s i))))
    else all (fun r => zrow0 (mask D r)) (zC (channel s i)).
  by have := chs i; rewrite size_zip sT minnn -em ltn_ord => /(_ isT); rewrite nth_zip.
split=> //; split=> [a|a b|a b|i a u|i v b]; rewrite ?inE.
- move=> Da; have := ap a; rewrite size_zip sZ sD minnn ltn_ord => /(_ isT); rewrite nth_zip ?sZ ?sD //= Da andbT.
  by [].
- move=> Da Db; have := row a; rewrite (negPf Da) /= => /andP[/(mask_zero [comRingType of K])/(_ Db) e _].
  by rewrite eA overE e mulr0.
- move=> Za Da Zb; have := row a; rewrite (negPf Da) (negPf Za) /= => /andP[_ /(mask_zero [comRingType of K])/(_ Zb) e].
  by rewrite eA overE e mulr0.
- move=> iT Za Da; have := ch i; rewrite iT => /(all_nthP (false, (false, [::])))/(_ a); have [sB _] := represented_channel re i.
  rewrite !size_zip sZ sD (shape_size sB) !minnn ltn_ord => /(_ isT).
  rewrite !nth_zip ?size_zip ?sZ ?sD ?(shape_size sB) ?minnn //= (negPf Za) (negPf Da) /= => /(zrow0_nth [comRingType of K] u) e.
  by rewrite eB overE e mulr0.
move=> iT Db; have := ch i; rewrite (negPf iT) => /(all_nthP [::])/(_ v); have [_ sC] := represented_channel re i.
rewrite (shape_size sC) ltn_ord => /(_ isT)/(mask_zero [comRingType of K])/(_ Db) e.
by rewrite eC overE e mulr0.
Qed.
End Local.
Section LocalRules.
Variables (s : zsystem) (Z D : seq bool) (pl : zrow) (c : shrunk_witness) (d : nat).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.
Theorem check_local_sound : check_driven s Z D (b_T c) -> check_shrunk (zpart s Z) pl c d ->
  (forall F, up K pl ^+ d %| char_poly (closed_loop S F)) /\
  (forall lambda, root (up K pl) lambda -> (\rank (pencil S (~: channels_at m (b_T c)) lambda) + d <= n)%N).
Proof.
move=> dr ok; have [[apart closed driven acting unseen] sZ] := driven_states_of re dr; apply: loss_sound (checked_nonzero h ok) _.
apply: loss_of; apply: (@shrunk_subspace_local _ _ _ _ _ S _ _ d _ _ apart closed driven acting unseen m id (channels_at m (b_T c))).
- by move=> i iT; right; exists i.
- by move=> i iT; right; exists i.
exact: (check_shrunk_subspace h (part_represents re sZ) ok).
Qed.
Theorem check_local_dual_sound : check_driven s Z D (map negb (b_T c)) -> check_shrunk (zdual (zpart s Z)) pl c d ->
  (forall F, up K pl ^+ d %| char_poly (closed_loop S F)) /\
  (forall lambda, root (up K pl) lambda -> (\rank (pencil S (~: channels_at m (map negb (b_T c))) lambda) + d <= n)%N).
Proof.
move=> dr ok; have [[apart closed driven acting unseen] sZ] := driven_states_of re dr; apply: loss_sound (checked_nonzero h ok) _.
have sT : size (b_T c) = m.
  move: ok; rewrite /check_shrunk => /and5P[_ _ _ _ /and5P[/eqP -> _ _ _ _]].
  by rewrite !size_map (re_m re).
apply: (@dual_subspace_local _ _ _ _ _ S _ _ d _ _ apart closed driven acting unseen m id (channels_at m (map negb (b_T c)))).
- by move=> i iT; right; exists i.
- by move=> i iT; right; exists i.
have -> : ~: channels_at m (map negb (b_T c)) = channels_at m (b_T c) by rewrite channels_at_compl // setCK.
exact: (check_shrunk_subspace h (dual_represents (part_represents re sZ)) ok).
Qed.
End LocalRules.
