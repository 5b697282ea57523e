(* Kinds `closed_loop_spectrum` and `stability`: det(xI - A) of a plant, of its dual, or of the loop with a controller, and
   whether all its roots lie in a half-plane or in a disc.

   A controller has a program for each agent: numbers of its state w_i, which holds what the agent shares and what it
   keeps, and the input u_i are sums over all outputs y and all states w.  Who may use what is not said here. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel location.
From mcexact.kernel Require Import lists systems fixed_rule regions_rule spectrum_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* x' = A x + sum_i B_i u_i, y_i = C_i x, u_i = U_i (y, w), w_i' = V_i (y, w); loop state (x, w_1, ..., w_m). *)
Section Programs.
Variables (R : ringType) (n m : nat) (p q k : 'I_m -> nat) (S : multichannel R n p q).
Notation signals := (\sum_i q i + \sum_i k i)%N.
Variables (U : forall i, 'M[R]_(p i, signals)) (V : forall i, 'M[R]_(k i, signals)).
Definition readings : 'M[R]_(signals, n + \sum_i k i) := block_mx (\mxcol_i mcC S i) 0 0 1%:M.
Definition program_loop : 'M[R]_(n + \sum_i k i) :=
  col_mx (row_mx (mcA S) 0 + \sum_i mcB S i *m (U i *m readings)) (\mxcol_i (V i *m readings)).
Lemma program_loopE (x : 'cV_n) (w : forall i, 'cV_(k i)) (now := col_mx (\mxcol_i (mcC S i *m x)) (\mxcol_i w i)) :
  program_loop *m col_mx x (\mxcol_i w i) =
  col_mx (mcA S *m x + \sum_i mcB S i *m (U i *m now)) (\mxcol_i (V i *m now)).
Proof.
have e : readings *m col_mx x (\mxcol_i w i) = now by rewrite mul_block_col !mul0mx addr0 add0r mul1mx mxcol_mul.
rewrite mul_col_mx mulmxDl mul_row_col mul0mx addr0 mulmx_suml mxcol_mul; congr (col_mx (_ + _) _).
  by apply: eq_bigr => i _; rewrite -!mulmxA e.
by apply: eq_mxcol => i; rewrite -mulmxA e.
Qed.
End Programs.

(* A row for each number of the state of an agent, and for each of its inputs; a column for each entry of all outputs, and
   then of all states, over one denominator. *)
Record zagent := ZAgent { ag_states : nat; ag_update : zmat; ag_input : zmat }.
Record zcontroller := ZController { co_den : Z; co_agents : seq zagent }.
Definition zagent0 := ZAgent 0 [::] [::].
Definition zoutputs (s : zsystem) : zmat := flatten [seq zC ch | ch <- zchannels s].
Definition zstates (c : zcontroller) : nat := sumn [seq ag_states a | a <- co_agents c].
Definition sized_agent (signals : nat) (ca : zchannel * zagent) : bool :=
  shape (ag_states ca.2) signals (ag_update ca.2) && shape (zp ca.1) signals (ag_input ca.2).
Definition sized_controller (s : zsystem) (c : zcontroller) : bool :=
  [&& Z.ltb 0 (co_den c), size (co_agents c) == size (zchannels s) &
      all (sized_agent (size (zoutputs s) + zstates c)) (zip (zchannels s) (co_agents c))].
(* All outputs and states, as d times their coefficients in the state of the loop. *)
Definition zreadings (s : zsystem) (c : zcontroller) : zmat := zoutputs s ++ [seq zunit (zD s) (zn s + r) | r <- iota 0 (zstates c)].
(* The first a rows of a matrix, with b numbers in each. *)
Definition zwide b (r : zrow) : zrow := take b (r ++ nseq b z0).
Definition zblock a b (M : zmat) : zmat := mkseq (fun i => zwide b (nth [::] M i)) a.
Definition zinputs (s : zsystem) (c : zcontroller) : zmat :=
  foldr (fun ca acc => zmaxpy 1 (zmm (zB ca.1) (zmm (ag_input ca.2) (zreadings s c))) acc) [::] (zip (zchannels s) (co_agents c)).
Definition zupdates (s : zsystem) (c : zcontroller) : zmat := flatten [seq zmm (ag_update a) (zreadings s c) | a <- co_agents c].
Definition zclosed (s : zsystem) (c : zcontroller) : zmat :=
  let N := (zn s + zstates c)%N in
  zblock (zn s) N (zmaxpy (zD s * co_den c) (zA s) (zinputs s c)) ++ zblock (zstates c) N (zmaxpy (zD s) (zupdates s c) [::]).
Definition zclosed_den (s : zsystem) (c : zcontroller) : Z := (zD s * (zD s * co_den c))%coqZ.
Definition check_without (s : zsystem) (f : zrow) (w : spectrum_witness) : bool :=
  sized_system s && check_spectrum (zn s) (zD s) (zA s) f w.
Definition check_programs (s : zsystem) (c : zcontroller) (f : zrow) (w : spectrum_witness) : bool :=
  [&& sized_system s, sized_controller s c & check_spectrum (zn s + zstates c) (zclosed_den s c) (zclosed s c) f w].

(* Lists put below each other. *)
Section Stacks.
Variable R : comRingType.
Notation mx := (mx R).
Lemma zblockE a b M : mx a b (zblock a b M) = mx a b M.
Proof.
apply/matrixP=> i j; rewrite !mxE nth_mkseq // /zwide nth_take // nth_cat nth_nseq if_same.
by case: ifP => // /negbT; rewrite -leqNgt => h; rewrite [in RHS]nth_default.
Qed.
Lemma mx_cat a b c M N : size M = a -> mx (a + b) c (M ++ N) = col_mx (mx a c M) (mx b c N).
Proof.
move=> sM; apply/matrixP=> i j; case: (split_ordP i) => i' ->; rewrite ?col_mxEu ?col_mxEd !mxE /= nth_cat sM.
  by rewrite ltn_ord.
by rewrite ltnNge leq_addr /= addKn.
Qed.
Lemma mx_narrow a b b' (M : zmat) : all (fun r : zrow => size r <= b)%N M -> mx a (b + b') M = row_mx (mx a b M) 0.
Proof.
move/(all_nthP [::])=> narrow; apply/matrixP=> i j; case: (split_ordP j) => j' ->; rewrite ?row_mxEl ?row_mxEr !mxE //=.
rewrite nth_default // (leq_trans _ (leq_addr _ _)) //; have [il|il] := ltnP i (size M); last by rewrite nth_default.
exact: narrow.
Qed.
Lemma scale_mxcol a m (k : 'I_m -> nat) b (M : forall i, 'M[R]_(k i, b)) : a *: \mxcol_i M i = \mxcol_i (a *: M i).
Proof. by apply/matrixP=> i j; rewrite !mxE. Qed.
Lemma all_flatten (a : pred zrow) (Ms : seq zmat) : all (all a) Ms -> all a (flatten Ms).
Proof. by elim: Ms => //= M Ms IH /andP[aM /IH al]; rewrite all_cat aM. Qed.
Lemma sumn_take (l : seq nat) i : (i <= size l)%N -> sumn (take i l) = (\sum_(j < i) nth 0 l j)%N.
Proof.
elim: i => [|i IH] il; first by rewrite take0 big_ord0.
by rewrite (take_nth 0%N il) sumn_rcons (IH (ltnW il)) big_ord_recr.
Qed.
Lemma sumn_ord (l : seq nat) m (k : 'I_m -> nat) : size l = m -> (forall i : 'I_m, nth 0%N l i = k i) -> sumn l = (\sum_i k i)%N.
Proof. by move=> sl e; rewrite -[l]take_size sumn_take // sl; apply: eq_bigr. Qed.
Lemma nth_flatten_sig (X : Type) (x : X) m (k : 'I_m -> nat) (Ms : seq (seq X)) (r : 'I_(\sum_i k i)) : size Ms = m ->
  (forall i : 'I_m, size (nth [::] Ms i) = k i) -> nth x (flatten Ms) r = nth x (nth [::] Ms (tagnat.sig1 r)) (tagnat.sig2 r).
Proof.
move=> sm sk; set i := tagnat.sig1 r; set t := tagnat.sig2 r.
have sh (l : 'I_m) : nth 0%N (seq.shape Ms) l = k l by rewrite (nth_map [::]) ?sk // sm.
have -> : r = flatten_index (seq.shape Ms) i t :> nat.
  have <- : (\sum_(l < m | l < i) k l + t)%N = r by rewrite -tagnat.RankEsum tagnat.sig2K.
  have im := ltnW (ltn_ord i); have ish : (i <= size (seq.shape Ms))%N by rewrite size_map sm.
  rewrite /flatten_index (sumn_take ish) (big_ord_widen m (fun l => nth 0%N (seq.shape Ms) l) im); congr (_ + _)%N.
  by apply: eq_bigr => l _; rewrite sh.
have ti : (t < nth 0 (seq.shape Ms) i)%N by rewrite sh.
by rewrite nth_flatten flatten_indexKl // flatten_indexKr.
Qed.
Lemma mx_flatten m (k : 'I_m -> nat) c (Ms : seq zmat) : size Ms = m -> (forall i : 'I_m, size (nth [::] Ms i) = k i) ->
  mx (\sum_i k i) c (flatten Ms) = \mxcol_i mx (k i) c (nth [::] Ms i).
Proof. by move=> sm sk; apply/matrixP=> r j; rewrite !mxE (nth_flatten_sig _ _ sm sk). Qed.
End Stacks.
Lemma shape_block a b M : shape a b (zblock a b M).
Proof.
rewrite /shape size_mkseq eqxx all_map; apply: sub_all (all_predT _) => i _ /=.
by rewrite /zwide size_takel // size_cat size_nseq leq_addl.
Qed.

(* The loop of the plant of a list with the controller of a list. *)
Section System.
Variables (K : fieldType) (s : zsystem) (c : zcontroller).
Notation m := (size (zchannels s)).
Definition agent (i : 'I_m) := nth zagent0 (co_agents c) i.
Definition system_loop := program_loop (system_of K s)
  (fun i => over K (co_den c) (zp (channel s i)) _ (ag_input (agent i))) (fun i => over K (co_den c) (ag_states (agent i)) _ (ag_update (agent i))).
Notation k := (fun i : 'I_m => ag_states (agent i)).
Notation q := (fun i : 'I_m => zq (channel s i)).

Variable h : {rmorphism rat -> K}.
Hypotheses (sz : sized_system s) (sc : sized_controller s c).
Notation mx := (mx [comRingType of K]).
Notation phi := (phi [comRingType of K]).
Notation n := (zn s).
Notation d := (zD s).
Notation e := (co_den c).
Let sizes : size (co_agents c) = m. Proof. by case/and3P: sc => _ /eqP. Qed.
Let d0 : phi d != 0. Proof. by case/and4P: sz => /Z.ltb_lt d0 _ _ _; apply: (phi_neq0 h); apply/negP => /Z.eqb_eq z; rewrite z in d0. Qed.
Let e0 : phi e != 0. Proof. by case/and3P: sc => /Z.ltb_lt e0 _ _; apply: (phi_neq0 h); apply/negP => /Z.eqb_eq z; rewrite z in e0. Qed.
Lemma statesE : zstates c = (\sum_i k i)%N.
Proof. by rewrite /zstates (sumn_ord (k := k)) ?size_map // => i; rewrite (nth_map zagent0) ?sizes. Qed.
Let channel_shapes (i : 'I_m) : shape n (zp (channel s i)) (zB (channel s i)) /\ shape (zq (channel s i)) n (zC (channel s i)).
Proof. exact: (represented_channel (system_of_represents K sz)). Qed.
Lemma outputs_size : size (zoutputs s) = (\sum_i q i)%N.
Proof.
rewrite /zoutputs size_flatten (sumn_ord (m := m) (k := q)) // ?size_map // => i.
by rewrite (nth_map [::]) ?size_map // (nth_map zch0) // (shape_size (channel_shapes i).2).
Qed.
Lemma outputsE : mx (\sum_i q i) n (zoutputs s) = \mxcol_i mx (q i) n (zC (channel s i)).
Proof.
rewrite /zoutputs (@mx_flatten _ m) ?size_map // => [|i]; rewrite ?(nth_map zch0) ?(shape_size (channel_shapes i).2) //.
by apply: eq_mxcol => i; rewrite (nth_map zch0).
Qed.
Let agent_shapes (i : 'I_m) : shape (k i) (\sum_i q i + \sum_i k i) (ag_update (agent i)) /\ shape (zp (channel s i)) (\sum_i q i + \sum_i k i) (ag_input (agent i)).
Proof.
case/and3P: sc => _ _ /(all_nthP (zch0, zagent0))/(_ i); rewrite size_zip sizes minnn => /(_ (ltn_ord i)).
by rewrite nth_zip ?sizes // -outputs_size -statesE => /andP[].
Qed.
Notation N := (n + \sum_i k i)%N.
Notation Q := (\sum_i q i + \sum_i k i)%N.
Lemma readingsE : mx Q N (zreadings s c) = phi d *: readings k (system_of K s).
Proof.
rewrite /zreadings mx_cat ?outputs_size // mx_narrow; last first.
  apply: all_flatten; rewrite all_map; apply/(all_nthP zch0) => i im /=.
  by case/andP: (channel_shapes (Ordinal im)).2 => _; apply: sub_all => r /eqP ->.
rewrite /readings outputsE block_mxEv scale_col_mx !scale_row_mx !scaler0; congr (col_mx (row_mx _ _) _).
  by apply/matrixP=> r j; rewrite !mxE mulrA divff // mul1r.
have -> : mx (\sum_i k i) N [seq zunit d (n + r) | r <- iota 0 (zstates c)] = row_mx 0 (phi d)%:M.
  apply/matrixP=> i j; rewrite !mxE (nth_map 0%N) ?size_iota ?statesE // nth_iota ?statesE // add0n /zunit nth_ncons.
  case: (split_ordP j) => j' ->; rewrite ?row_mxEl ?row_mxEr !mxE /=.
    by rewrite (leq_trans (ltn_ord j')) ?leq_addr.
  rewrite ltn_add2l; case: ltngtP => [ji|ij|ij].
  - by rewrite (_ : (i == j') = false) // eq_sym -val_eqE ltn_eqF.
  - by rewrite subnDl; case: (j' - i)%N (subn_gt0 i j') => [|t]; rewrite ?ij //= nth_nil (_ : (i == j') = false) // -val_eqE ltn_eqF.
  have -> : j' = i by apply: val_inj.
  by rewrite subnn /= eqxx mulr1n.
by rewrite scalemx1.
Qed.
Lemma foldr_sum a b (l : seq (zchannel * zagent)) (f : zchannel * zagent -> zmat) :
  mx a b (foldr (fun x acc => zmaxpy 1 (f x) acc) [::] l) = \sum_(i < size l) mx a b (f (nth (zch0, zagent0) l i)).
Proof.
elim: l => [|x l IH]; first by rewrite big_ord0 mx_nil.
by rewrite big_ord_recl /= zmaxpyE phi1 scale1r IH.
Qed.
Lemma inputsE : mx n N (zinputs s c) =
  \sum_i mx n (zp (channel s i)) (zB (channel s i)) *m (mx _ Q (ag_input (agent i)) *m (phi d *: readings k (system_of K s))).
Proof.
have sR : size (zreadings s c) = Q by rewrite size_cat size_map size_iota outputs_size statesE.
rewrite /zinputs foldr_sum size_zip sizes minnn; apply: eq_bigr => i _; rewrite nth_zip ?sizes // -/(channel s i) -/(agent i).
have [_ /shape_size sU] := agent_shapes i.
have le : (size (zmm (ag_input (agent i)) (zreadings s c)) <= zp (channel s i))%N by rewrite size_map sU.
have le' : (size (zreadings s c) <= Q)%N by rewrite sR.
by rewrite (zmmE _ _ _ _ le) (zmmE _ _ _ _ le') readingsE.
Qed.
Lemma updatesE : mx (\sum_i k i) N (zupdates s c) = \mxcol_i (mx (k i) Q (ag_update (agent i)) *m (phi d *: readings k (system_of K s))).
Proof.
have sR : (size (zreadings s c) <= Q)%N by rewrite size_cat size_map size_iota outputs_size statesE.
have sk (i : 'I_m) : size (zmm (ag_update (agent i)) (zreadings s c)) = k i by rewrite size_map (shape_size (agent_shapes i).1).
have e1 (i : 'I_m) : nth [::] [seq zmm (ag_update a) (zreadings s c) | a <- co_agents c] i = zmm (ag_update (agent i)) (zreadings s c).
  by rewrite (nth_map zagent0) // sizes.
rewrite /zupdates (@mx_flatten _ m k) ?size_map // => [|i]; last by rewrite e1.
by apply: eq_mxcol => i; rewrite e1 (zmmE _ _ _ _ sR) readingsE.
Qed.
Lemma loopE : over K (zclosed_den s c) N N (zclosed s c) = system_loop.
Proof.
have dd : phi (zclosed_den s c) = phi d * (phi d * phi e) by rewrite /zclosed_den !phiM.
rewrite /over /zclosed statesE mx_cat ?size_mkseq // !zblockE !zmaxpyE mx_nil addr0 inputsE updatesE scale_col_mx scalerDr !scalerA dd phiM.
have de : phi d * phi e != 0 by rewrite mulf_neq0.
have c1 : (phi d * (phi d * phi e))^-1 * (phi d * phi e) = (phi d)^-1 by rewrite invfM -mulrA mulVf // mulr1.
have c2 : (phi d * (phi d * phi e))^-1 * phi d = (phi d * phi e)^-1 by rewrite invfM mulrAC mulVf // mul1r.
rewrite c1 c2 scale_mxcol; congr (col_mx (_ + _) _).
- have sA : shape n n (zA s) by case/and4P: sz.
  rewrite mx_narrow; last by case/andP: sA => _; apply: sub_all => r /eqP ->.
  by rewrite scale_row_mx scaler0.
- rewrite scaler_sumr; apply: eq_bigr => i _; rewrite -!scalemxAr -!scalemxAl -scalemxAr !scalerA c2; congr (_ *: _).
  by rewrite invfM.
apply: eq_mxcol => i; rewrite -scalemxAr -scalemxAl scalerA; congr (_ *: _).
by rewrite invfM mulrAC mulVf // mul1r.
Qed.
End System.

Theorem check_programs_sound s c f w : check_programs s c f w -> forall (K : fieldType) (h : {rmorphism rat -> K}),
  char_poly (system_loop K s c) = up K f.
Proof.
case/and3P=> sz sc ok K h; rewrite -(loopE h sz sc); rewrite (statesE sc) in ok; exact: (check_spectrum_sound ok h).
Qed.
Theorem check_without_sound s f w : check_without s f w -> forall (K : fieldType) (h : {rmorphism rat -> K}) n m
  (p q : 'I_m -> nat) (S : multichannel K n p q), represents s S -> char_poly (mcA S) = up K f.
Proof.
case/andP=> _ ok K h n m p q S [_ en _ _ _ -> _ _]; rewrite -en in ok; exact: (check_spectrum_sound ok h).
Qed.

(* The polynomial of a claim is over its last coefficient, as that of the evidence. *)
Definition check_open_spectrum (s : zsystem) (f g : zrow) (w : spectrum_witness) : bool := same_up_to_scale f g && check_without s g w.
Definition check_loop_spectrum (s : zsystem) (c : zcontroller) (f g : zrow) (w : spectrum_witness) : bool := same_up_to_scale f g && check_programs s c g w.
Lemma same_up (K : fieldType) (h : {rmorphism rat -> K}) f g : same_up_to_scale f g -> up K f = up K g.
Proof.
case/(same_up_to_scaleP h)=> f0 g0 e; rewrite /up.
have -> : pol _ f = ((phi _ (last z0 g))^-1 * phi _ (last z0 f)) *: pol [comRingType of K] g by rewrite -scalerA -e scalerA mulVf // scale1r.
by rewrite scalerA mulrCA mulVf // mulr1.
Qed.
Theorem check_open_spectrum_sound s f g w : check_open_spectrum s f g w -> forall (K : fieldType) (h : {rmorphism rat -> K}) n m
  (p q : 'I_m -> nat) (S : multichannel K n p q), represents s S -> char_poly (mcA S) = up K f.
Proof. by case/andP=> same ok K h n m p q S re; rewrite (same_up h same); apply: (check_without_sound ok h re). Qed.
Theorem check_loop_spectrum_sound s c f g w : check_loop_spectrum s c f g w -> forall (K : fieldType) (h : {rmorphism rat -> K}),
  char_poly (system_loop K s c) = up K f.
Proof. by case/andP=> same ok K h; rewrite (same_up h same); apply: (check_programs_sound ok h). Qed.

(* Stability: all roots are left of -u/v, or have modulus below u/v. *)
(* sum_k p_k L^k v^(d - k), d the degree *)
Definition zsubstitute_step (L : zrow) (v c : Z) (a : zrow * Z) : zrow * Z := (zaxpy 1 (zpmul L a.1) [:: (c * a.2)%coqZ], (v * a.2)%coqZ).
Definition zsubstitute (L : zrow) (v : Z) (p : zrow) : zrow := ztrim (foldr (zsubstitute_step L v) ([::], 1%coqZ) p).1.
Definition zmoved (continuous : bool) (u v : Z) (p : zrow) : zrow :=
  zsubstitute (if continuous then [:: (- u)%coqZ; 1%coqZ] else [:: z0; u]) v p.
Definition check_within (continuous : bool) (u v : Z) (flag : bool) (f : zrow) : bool :=
  [&& Z.ltb 0 u || continuous, Z.ltb 0 v, ~~ nilp (zmoved continuous u v f) & flag == zstable continuous (zmoved continuous u v f)].

Section Within.
Variables (C : numClosedFieldType) (u v : Z) (p : zrow).
Notation phi := (phi [comRingType of C]).
Notation pol := (pol [comRingType of C]).
Hypothesis v0 : Z.ltb 0 v.
Let vp : 0 < phi v. Proof. by rewrite phi_gt0. Qed.
Lemma zsubstituteE L y : phi v * (pol (zsubstitute L v p)).[y] = phi v ^+ size p * (pol p).[(pol L).[y] / phi v].
Proof.
rewrite /zsubstitute ztrimE; set st := zsubstitute_step L v.
suff [] : phi v * (pol (foldr st ([::], 1%coqZ) p).1).[y] = phi v ^+ size p * (pol p).[(pol L).[y] / phi v] /\ phi (foldr st ([::], 1%coqZ) p).2 = phi v ^+ size p by [].
elim: (p) => [|c r [IH1 IH2]]; first by rewrite pol_nil !horner0 !mulr0 phi1 expr0.
rewrite [foldr _ _ (_ :: _)]/= [fst _]/= [snd _]/= [size _]/= phiM IH2 exprS; split=> //.
set P := (pol r).[_] in IH1 *; set X := (pol L).[y] in P IH1 *.
rewrite pol_axpy phi1 polyC1 mul1r pol_mul pol_size1 phiM IH2 pol_cons !(hornerD, hornerM, hornerC, hornerX) -/X -/P mulrDr mulrCA IH1 [RHS]mulrDr; congr (_ + _).
  have w0 : phi v != 0 by rewrite gt_eqF.
  have e1 : phi v * (X / phi v) = X by rewrite mulrC divfK.
  by rewrite [P * _]mulrC -[RHS]mulrA [_ ^+ _ * (_ * P)]mulrCA [RHS]mulrA e1.
by rewrite mulrCA [RHS]mulrC.
Qed.

(* The root y of the substituted polynomial belongs to the root L(y)/v of p. *)
Lemma zsubstitute_root L y : root (pol (zsubstitute L v p)) y = root (pol p) ((pol L).[y] / phi v).
Proof.
have w0 : phi v != 0 by rewrite gt_eqF.
apply/rootP/rootP => r0; have := zsubstituteE L y; rewrite r0 mulr0 => /eqP.
  by rewrite eq_sym mulf_eq0 expf_eq0 (negPf w0) andbF => /eqP.
by rewrite mulf_eq0 (negPf w0) => /eqP.
Qed.
Definition within (continuous : bool) (z : C) : bool := if continuous then 'Re z < - (phi u / phi v) else `|z| < phi u / phi v.
Lemma zmovedP continuous : Z.ltb 0 u || continuous -> ~~ nilp (zmoved continuous u v p) ->
  zstable continuous (zmoved continuous u v p) <-> (forall z, root (pol p) z -> within continuous z).
Proof.
move=> u0 nn; have w0 : phi v != 0 by rewrite gt_eqF.
have l0 : ~~ Z.eqb (last z0 (zmoved continuous u v p)) 0 by have := ztrim_last (foldr (zsubstitute_step (if continuous then [:: (- u)%coqZ; 1%coqZ] else [:: z0; u]) v) ([::], 1%coqZ) p).1; rewrite -/(zsubstitute _ v p) -/(zmoved continuous u v p) (negPf nn).
have s0 : (0 < size (zmoved continuous u v p))%N by rewrite lt0n.
rewrite /zstable /within; case: continuous u0 nn l0 s0 => /= u0 nn l0 s0.
  have at_line y : (pol [:: (- u)%coqZ; 1%coqZ]).[y] = y - phi u.
    by rewrite !pol_cons pol_nil mul0r add0r phi1 phiN hornerD hornerMX !hornerC mul1r.
  have re z : 'Re (phi v * z + phi u) = phi v * 'Re z + phi u by rewrite raddfD /= ReMl ?phi_real // (Creal_ReP _ (phi_real C u)).
  have iff z : ('Re (phi v * z + phi u) < 0) = ('Re z < - (phi u / phi v)).
    by rewrite re -ltr_subr_addr sub0r mulrC -ltr_pdivl_mulr // mulNr.
  rewrite -(zhurwitzP C l0 s0); split=> st z rz.
    by rewrite -iff; apply: st; rewrite zsubstitute_root at_line addrK [phi v * z]mulrC mulfK.
  have := st _ (etrans (esym (zsubstitute_root _ _)) rz); rewrite -iff at_line [phi v * _]mulrC divfK // subrK //.
have up : 0 < phi u by rewrite phi_gt0 -[Z.ltb _ _]orbF.
have at_line y : (pol [:: z0; u]).[y] = phi u * y.
  by rewrite !pol_cons pol_nil mul0r add0r phi0 hornerD hornerMX !hornerC addr0.
have iff z : (`|phi v / phi u * z| < 1) = (`|z| < phi u / phi v).
  have vu : 0 < phi v / phi u by rewrite divr_gt0.
  by rewrite normrM (ger0_norm (ltW vu)) [_ * `|z|]mulrC -(ltr_pdivl_mulr _ _ vu) div1r invf_div.
have u1 : phi u != 0 by rewrite gt_eqF.
have there z : phi u * (phi v / phi u * z) / phi v = z by rewrite mulrA [phi u * _]mulrCA divff // mulr1 mulrC mulKf.
have back z : phi v / phi u * (phi u * z / phi v) = z by rewrite -!mulrA mulKf // mulrCA divff // mulr1.
rewrite -(zschurP C l0 s0); split=> st z rz.
  by rewrite -iff; apply: st; rewrite zsubstitute_root at_line there.
have := st _ (etrans (esym (zsubstitute_root _ _)) rz); rewrite -iff at_line.
by rewrite back.
Qed.
End Within.

Lemma spectrum_root (C : numClosedFieldType) N (M : 'M[C]_N) f : char_poly M = up C f ->
  forall z, eigenvalue M z = root (pol [comRingType of C] f) z.
Proof.
move=> e z; have l0 : ~~ Z.eqb (last z0 f) 0.
  apply/negP => /Z.eqb_eq l0; have := char_poly_monic M; rewrite e /up l0 phi0 invr0 scale0r.
  by rewrite monicE lead_coef0 eq_sym oner_eq0.
by rewrite eigenvalue_root_char e up_root.
Qed.
Definition check_loop_stability (s : zsystem) (c : zcontroller) (continuous : bool) (u v : Z) (flag : bool) (f : zrow) (w : spectrum_witness) : bool :=
  check_programs s c f w && check_within continuous u v flag f.
Theorem check_loop_stability_sound s c continuous u v flag f w : check_loop_stability s c continuous u v flag f w ->
  forall C : numClosedFieldType, flag <-> (forall z, eigenvalue (system_loop C s c) z -> within u v continuous z).
Proof.
case/andP=> ok /and4P[u0 v0 nn /eqP ->] C; have e := spectrum_root (check_programs_sound ok [rmorphism of @ratr C]).
rewrite (zmovedP C v0 u0 nn); by split=> st z; have := st z; rewrite e.
Qed.
Definition check_open_stability (s : zsystem) (continuous : bool) (u v : Z) (flag : bool) (f : zrow) (w : spectrum_witness) : bool :=
  check_without s f w && check_within continuous u v flag f.
Theorem check_open_stability_sound s continuous u v flag f w : check_open_stability s continuous u v flag f w ->
  forall (C : numClosedFieldType) n m (p q : 'I_m -> nat) (S : multichannel C n p q), represents s S ->
  flag <-> (forall z, eigenvalue (mcA S) z -> within u v continuous z).
Proof.
case/andP=> ok /and4P[u0 v0 nn /eqP ->] C n m p q S re; have e := spectrum_root (check_without_sound ok [rmorphism of @ratr C] re).
rewrite (zmovedP C v0 u0 nn); by split=> st z; have := st z; rewrite e.
Qed.
