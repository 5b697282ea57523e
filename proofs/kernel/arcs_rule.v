(* Kind `transfer_graph`, checker/core/reach.py, check_transfer_graph: which channels reach which.

   An edge is a C_i A^k B_j, k < n, that is not 0 modulo l.  That there is none, by the states on which the inputs of j
   act, directly and through A, none of which C_i measures; or by the columns of a matrix X with an identity at the
   pivots, whose span A does not leave and contains B_j, with C_i X = 0.  Strong components, by paths from every channel
   to one channel of its part and back, and an order of the parts in which no edge leads back. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability transfer_graph strong_components.
From mcexact.kernel Require Import lists systems residues shrunk_rule hessenberg_rule spectrum_rule.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* Edges. *)
Definition nonzero_mod (l : Z) (a b : nat) (M : zmat) : bool := has (fun r => has (fun x => ~~ Z.eqb (Z.modulo x l) 0) (take b r)) (take a M).
(* targets: for k = 0, 1, ... the channels i with C_i A^k P not 0 *)
Fixpoint zseen (l : Z) (A : zmat) (chs : seq zchannel) (b : nat) (P : zmat) (targets : seq (seq nat)) : bool :=
  if targets is t :: ts then
    all (fun i => let ch := nth zch0 chs i in nonzero_mod l (zq ch) b (zmm (zC ch) P)) t && (nilp ts || zseen l A chs b (zmat_mod l (zmm A P)) ts)
  else true.
Record arcs_witness := ArcsWitness { e_ell : Z; e_inv : Z; e_targets : seq (seq (seq nat)) }.
Definition shown (w : arcs_witness) (j i : nat) : bool := has (fun t => i \in t) (nth [::] (e_targets w) j).
Definition check_arcs (s : zsystem) (w : arcs_witness) : bool :=
  let: (l, i) := (e_ell w, e_inv w) in
  let chs := [seq reduced l i ch | ch <- zchannels s] in
  let A := zscale_mod l i (zA s) in
  [&& inverse_modulo l (zD s) i, size (e_targets w) <= size chs, all (fun t => size t <= zn s) (e_targets w) &
      all (fun ct => zseen l A chs (zp ct.1) (zB ct.1) ct.2) (zip chs (e_targets w))]%N.

(* No edges. *)
Definition closed_mask (s : zsystem) (held : seq bool) (ch : zchannel) : bool :=
  [&& size held == zn s, all (fun br => br.1 || zrow0 br.2) (zip held (zB ch)) & all (fun br => br.1 || zrow0 (mask held br.2)) (zip held (zA s))].
Definition unseen_mask (held : seq bool) (ch : zchannel) : bool := all (fun r => zrow0 (mask held r)) (zC ch).
Record zero_witness := ZeroWitness { z_from : seq bool; z_den : Z; z_X : zmat; z_pivots : seq nat }.
Definition ztake (places : seq nat) (M : zmat) : zmat := [seq nth [::] M i | i <- places].
Definition within_span (z : zero_witness) (M : zmat) : bool := zmat0 (zmaxpy (- z_den z) M (zmm (z_X z) (ztake (z_pivots z) M))).
Definition check_zero (s : zsystem) (z : zero_witness) : bool :=
  [&& Z.ltb 0 (z_den z), all (fun i => i < zn s) (z_pivots z), size (z_X z) == zn s,
      zmat0 (zmaxpy (-1) (zidentity (z_den z) (size (z_pivots z))) (ztake (z_pivots z) (z_X z))), within_span z (zmm (zA s) (z_X z)) &
      all (fun bc => ~~ bc.1 || within_span z (zB bc.2)) (zip (z_from z) (zchannels s))]%N.
Definition unseen_zero (z : zero_witness) (ch : zchannel) : bool := zmat0 (zmm (zC ch) (z_X z)).

Section Lists.
Variable R : comRingType.
Lemma ztakeE a b (piv : seq nat) M (pv : 'I_(size piv) -> 'I_a) : (forall k, pv k = nth 0%N piv k :> nat) ->
  mx R (size piv) b (ztake piv M) = rowsub pv (mx R a b M).
Proof. by move=> e; apply/matrixP=> k j; rewrite !mxE (nth_map 0%N) // e. Qed.
End Lists.

Section Modulus.
Variables (lz : Z) (l1 : (1 < lz)%coqZ).
Notation l := (modulus_of l1).
Notation Zl := [comRingType of 'Z_l].
Lemma phi_residue0 x : phi Zl x = 0 -> (x mod lz = 0)%coqZ.
Proof.
rewrite -(phi_mod (modulus_gt0 l1) (phi_modulus l1)); have [x0 xl] := Z.mod_pos_bound x lz (modulus_gt0 l1).
set y := (x mod lz)%coqZ in x0 xl *; rewrite /phi (to_natE x0) -pmulrn => /(congr1 (fun t : 'Z_l => t : nat)).
rewrite val_Zp_nat ?modulus_gt1 // modn_small => [e|]; first by rewrite -[y](Z2Nat.id _ x0) e.
by apply/ltP/Z2Nat.inj_lt => //; apply: Z.lt_le_incl; apply: modulus_gt0 l1.
Qed.
Lemma nonzero_modE a b M : nonzero_mod lz a b M -> mx Zl a b M != 0.
Proof.
case/(has_nthP [::])=> i; rewrite size_take => ia /(has_nthP z0)[j]; rewrite size_take => jb nz.
have lt k c d : (k < if c < d then c else d)%N -> (k < c)%N by case: (ltnP c d) => // dc kd; apply: leq_trans kd dc.
move/lt in ia; move/lt in jb.
apply: contraNneq nz => /matrixP/(_ (Ordinal ia) (Ordinal jb)); rewrite !mxE /= => /phi_residue0 e.
by rewrite !nth_take // e.
Qed.
End Modulus.

Section Sound.
Variables (s : zsystem).
Variables (K : fieldType) (h : {rmorphism rat -> K}) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.

Theorem check_arcs_sound w (j i : 'I_m) : check_arcs s w -> shown w j i -> arc S j i.
Proof.
have D0 := represented_D re; have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC.
rewrite /check_arcs -en; set lz := e_ell w; set iv := e_inv w; set Az := zscale_mod _ _ _; set chs := map _ _.
case/and4P=> /andP[/Z.ltb_lt l1 /Z.eqb_eq inv] few /(all_nthP [::]) short /(all_nthP (zch0, [::])) seen /(has_nthP [::])[k kt ik].
set ts := nth _ _ _ in kt ik; have tj : (j < size (e_targets w))%N by rewrite ltnNge; apply: contraTN kt => /(nth_default [::]); rewrite /ts => ->.
have jc : (j < size chs)%N by rewrite size_map -em.
have := seen j; rewrite size_zip leq_min jc tj => /(_ isT); rewrite nth_zip_cond size_zip leq_min jc tj /= -/ts => {}seen.
have kn : (k < n)%N := leq_trans kt (short j tj).
pose l := modulus_of l1; have l0 := modulus_gt0 l1; pose Zl := [comRingType of 'Z_l]; have pl : phi Zl lz = 0 := phi_modulus l1.
pose SL : multichannel (Zloc l) n p q := local_system l1 D0 inv s n p q.
have resR a d M : map_mx (@residue l) (local l1 D0 inv a d M) = mx Zl a d (zscale_mod lz iv M) := residue_local l1 D0 inv a d M.
have up a d M : map_mx (into h) (local l1 D0 inv a d M) = over K (zD s) a d M by rewrite -(into_local l1 D0 inv h) -map_mx_comp.
have chE (c : 'I_m) : nth zch0 chs c = reduced lz iv (channel s c) by rewrite (nth_map zch0) // -em.
have -> : arc S j i = arc (map_system (into h) SL) j i by rewrite /arc /= !up -eA -eB -eC.
apply: (arc_rule h kn); rewrite map_mxM map_krylov !resR.
set A := mx Zl n n _; have sAz : (size Az <= n)%N by rewrite size_map (shape_size sA).
have main b P ts' k' : (size P <= n)%N -> zseen lz Az chs b P ts' -> (k' < size ts')%N -> val i \in nth [::] ts' k' ->
    mx Zl (q i) n (zscale_mod lz iv (zC (channel s i))) *m krylov A (mx Zl n b P) k' != 0.
  elim: ts' P k' => [//|t ts' IH] P [|k'] sP /= /andP[/allP a rest].
    by move=> _ /a; rewrite chE /= -eq => /(nonzero_modE l1); rewrite (zmmE _ _ _ _ sP).
  rewrite ltnS => k'ts ik'; have {}rest : zseen lz Az chs b (zmat_mod lz (zmm Az P)) ts' by case/orP: rest => // /nilP e; rewrite e in k'ts.
  have := IH (zmat_mod lz (zmm Az P)) k' _ rest k'ts ik'; rewrite (zmat_modE l0 pl) (zmmE _ _ _ _ sP) {1}/krylov -iterSr; apply.
  by rewrite /zmat_mod size_map /zmm size_map.
have sB : (size (zscale_mod lz iv (zB (channel s j))) <= n)%N by rewrite size_map (shape_size (represented_channel re j).1).
by move: seen; rewrite chE /= -ep => /main; apply.
Qed.

Theorem closed_mask_sound held (j i : 'I_m) : closed_mask s held (channel s j) -> unseen_mask held (channel s i) -> ~~ arc S j i.
Proof.
have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC.
case/and3P=> /eqP sh /(all_nthP (false, [::])) inp /(all_nthP (false, [::])) st /(all_nthP [::]) out.
have [sB _] := represented_channel re j; have [_ sC] := represented_channel re i.
have nz d z : (phi [comRingType of K] d)^-1 * phi [comRingType of K] z != 0 -> phi [comRingType of K] z != 0 by apply: contraNneq => ->; rewrite mulr0.
apply: (@closed_states_no_arc _ _ _ _ _ _ _ _ [set a : 'I_n | nth false held a]); split=> [a u|a b|v b]; rewrite ?inE.
- rewrite eB overE => /nz ne; have := inp a; rewrite size_zip sh (shape_size sB) -en minnn ltn_ord => /(_ isT).
  by rewrite nth_zip /= ?sh ?(shape_size sB) // => /orP[//|/(zrow0_nth [comRingType of K] u) e]; rewrite e eqxx in ne.
- move=> hb; rewrite eA overE => /nz ne; have := st a; rewrite size_zip sh (shape_size sA) -en minnn ltn_ord => /(_ isT).
  by rewrite nth_zip /= ?sh ?(shape_size sA) // => /orP[//|/(mask_zero [comRingType of K])/(_ hb) e]; rewrite e eqxx in ne.
move=> hb; rewrite eC overE; have := out v; rewrite (shape_size sC) ltn_ord => /(_ isT)/(mask_zero [comRingType of K])/(_ hb) ->.
by rewrite mulr0.
Qed.

Lemma zero_transfer_of z (T' : {set 'I_m}) : check_zero s z -> (forall i, i \in T' -> unseen_zero z (channel s i)) ->
  zero_transfer S (channels_at m (z_from z)) T'.
Proof.
have D0 := represented_D re; have sA := represented_A re; case: (re) => _ en em ep eq eA eB eC.
rewrite /check_zero -en; set e := z_den z; set X := z_X z; set piv := z_pivots z; set r := size piv.
case/and5P=> /Z.ltb_lt e0 /(all_nthP 0%N) pn /eqP sX _ /andP[inv inp] out.
have nz d : (0 < d)%coqZ -> phi [comRingType of K] d != 0.
  by move=> d0; apply: phi_neq0 h _ _; apply/negP => /Z.eqb_eq ed; rewrite ed in d0.
have u0 := nz _ e0; pose pv (k : 'I_r) := Ordinal (pn k (ltn_ord k)).
have spanE b M : within_span z M -> mx [comRingType of K] n b M = over K e n r X *m rowsub pv (mx [comRingType of K] n b M).
  move/(zmat0E [comRingType of K] n b); rewrite zmaxpyE (@zmmE _ n b r) ?size_map // phiN scaleNr addrC => /eqP; rewrite subr_eq0 => /eqP.
  by rewrite (@ztakeE _ n b piv M pv) // /over -scalemxAl => ->; rewrite scalerA mulVf ?scale1r.
have scaled c k (M : 'M[K]_(n, c)) : rowsub pv (k *: M) = k *: rowsub pv M by apply/matrixP=> i j; rewrite !mxE.
apply: (@ZeroTransfer _ _ _ _ _ _ _ _ r (over K e n r X) pv).
- have AX : mcA S *m over K e n r X = ((phi [comRingType of K] (zD s))^-1 * (phi [comRingType of K] e)^-1) *: mx _ n r (zmm (zA s) X).
    by rewrite eA /over -scalemxAl -scalemxAr scalerA (zmmE _ _ _ _ (eq_leq sX)).
  by rewrite AX scaled -scalemxAr -spanE.
- move=> j; rewrite inE => jT; rewrite eB /over; move/(all_nthP (false, zch0)): inp => /(_ j).
  have jT' : (j < size (z_from z))%N by rewrite ltnNge; apply: contraTN jT => /(nth_default false) ->.
  rewrite size_zip leq_min jT' -em ltn_ord nth_zip_cond size_zip leq_min jT' -em ltn_ord /= jT => /(_ isT)/spanE e1.
  by rewrite scaled -scalemxAr -e1.
by move=> i /out ok; rewrite eC /over -scalemxAl -scalemxAr -(zmmE _ _ _ _ (eq_leq sX)) (zmat0E _ _ _ ok) !scaler0.
Qed.
End Sound.

(* Parts. *)
Definition edges := seq (seq bool).
Definition edge (e : edges) (j i : nat) : bool := nth false (nth [::] e j) i.
(* For each part one channel; for each channel the next one on a path to it and on a path from it, and how far it is. *)
Record parts_witness := PartsWitness { q_roots : seq nat; q_next : seq nat; q_far : seq nat; q_before : seq nat; q_deep : seq nat }.
Definition check_parts (m : nat) (e : edges) (parts : seq nat) (w : parts_witness) : bool :=
  let part := nth 0%N parts in
  all (fun j => let: (r, t, b) := (nth 0 (q_roots w) (part j), nth 0 (q_next w) j, nth 0 (q_before w) j) in
    (j == r) || [&& t < m, b < m, edge e j t, edge e b j & [&& part t == part j, part b == part j,
      nth 0 (q_far w) t < nth 0 (q_far w) j & nth 0 (q_deep w) b < nth 0 (q_deep w) j]])%N (iota 0 m).
(* No edge leads from a part to one that is earlier in the order: `order` has the place of each part. *)
Definition check_order_of (m : nat) (e : edges) (parts order : seq nat) : bool :=
  let at_ j := nth 0%N order (nth 0%N parts j) in
  [&& uniq order, all (fun c => c < size order)%N parts, size parts == m &
      all (fun jr => all (fun ib => ~~ ib.2 || (at_ jr.1 <= at_ ib.1)%N) (zip (iota 0 (size jr.2)) jr.2)) (zip (iota 0 (size e)) e)].

Lemma zip_iotaP (T : Type) (x : T) (P : nat * T -> bool) (r : seq T) : reflect (forall i, (i < size r)%N -> P (i, nth x r i)) (all P (zip (iota 0 (size r)) r)).
Proof.
apply: (iffP (all_nthP (0%N, x))) => ok i ir.
  by have := ok i; rewrite size_zip size_iota minnn => /(_ ir); rewrite nth_zip ?size_iota // nth_iota.
by rewrite size_zip size_iota minnn in ir; rewrite nth_zip ?size_iota // nth_iota //; apply: ok.
Qed.
Section Parts.
Variables (m : nat) (e : edges) (parts : seq nat).
Notation E := (fun j i : 'I_m => edge e j i).
Notation part j := (nth 0%N parts j).
Theorem check_parts_sound w : check_parts m e parts w -> forall j i : 'I_m, part j = part i -> connect E j i.
Proof.
move=> /allP ok; have inI (j : 'I_m) : val j \in iota 0 m by rewrite mem_iota add0n ltn_ord.
have each (j : 'I_m) := ok j (inI j).
have there (j : 'I_m) : exists2 r : 'I_m, r = nth 0%N (q_roots w) (part j) :> nat & connect E j r.
  have [k] := ubnP (nth 0%N (q_far w) j); elim: k j => // k IH j jk; have := each j; rewrite /=.
  case: eqP => [ej|_] /=; first by move=> _; exists j; rewrite ?connect0.
  case/and5P=> tm _ jt _ /and4P[/eqP pt _ far _]; have [r er tr] := IH (Ordinal tm) (leq_trans far jk).
  by exists r; [rewrite er /= pt | apply: connect_trans (connect1 (_ : E j (Ordinal tm))) tr].
have back (j : 'I_m) : exists2 r : 'I_m, r = nth 0%N (q_roots w) (part j) :> nat & connect E r j.
  have [k] := ubnP (nth 0%N (q_deep w) j); elim: k j => // k IH j jk; have := each j; rewrite /=.
  case: eqP => [ej|_] /=; first by move=> _; exists j; rewrite ?connect0.
  case/and5P=> _ bm _ bj /and4P[_ /eqP pb _ deep]; have [r er rb] := IH (Ordinal bm) (leq_trans deep jk).
  by exists r; [rewrite er /= pb | apply: connect_trans rb (connect1 (_ : E (Ordinal bm) j))].
move=> j i eji; have [r er jr] := there j; have [r' er' ri] := back i.
have err : r = r' by apply: val_inj; rewrite /= er er' eji.
by rewrite err in jr; apply: connect_trans jr ri.
Qed.
Theorem check_order_sound w order : check_parts m e parts w -> check_order_of m e parts order ->
  forall j i : 'I_m, connect E j i && connect E i j = (part j == part i).
Proof.
move=> within /and4P[un /(all_nthP 0%N) few /eqP sp /(zip_iotaP [::]) back] j i.
pose at_ (c : 'I_m) := nth 0%N order (part c).
have fewE (a : 'I_m) : (part a < size order)%N by apply: few; rewrite sp.
have inj a b : (at_ a == at_ b) = (part a == part b) by rewrite /at_ nth_uniq ?fewE.
rewrite (@ordered_components m E E at_ (fun _ _ ee => ee)) ?inj // => a b; last by move/eqP; rewrite inj => /eqP; apply: (check_parts_sound within).
rewrite ltnNge; apply: contra => eab.
have ae : (a < size e)%N by rewrite ltnNge; apply: contraTN eab => /(nth_default [::]); rewrite /edge => ->; rewrite nth_nil.
have bs : (b < size (nth [::] e a))%N by rewrite ltnNge; apply: contraTN eab => /(nth_default false); rewrite /edge => ->.
by have /(zip_iotaP false)/(_ b bs) := back a ae; rewrite /= -/(edge e a b) eab.
Qed.
End Parts.

(* The claim. *)
Record zgraph := ZGraph { g_edges : edges; g_parts : seq nat; g_connected : bool }.
Section Claim.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q) (c : zgraph).
Definition graph_holds : Prop :=
  [/\ forall j i, arc S j i = edge (g_edges c) j i,
      forall j i, connect (arc S) j i && connect (arc S) i j = (nth 0%N (g_parts c) j == nth 0%N (g_parts c) i) &
      strongly_connected S <-> g_connected c].
End Claim.

(* For each channel the states that its inputs act on, directly and through A. *)
Record graph_witness := GraphWitness { t_arcs : arcs_witness; t_held : seq (seq bool); t_zeros : seq zero_witness; t_parts : parts_witness; t_order : seq nat }.
(* Which sources and targets a matrix X shows to have no edges. *)
Definition zero_pairs (s : zsystem) (z : zero_witness) : seq bool * seq bool := (z_from z, [seq unseen_zero z ch | ch <- zchannels s]).
Definition check_pairs (s : zsystem) (e : edges) (w : graph_witness) (j : nat) : bool :=
  let: (chs, held, apart) := (zchannels s, nth [::] (t_held w) j, map (zero_pairs s) (t_zeros w)) in
  let places := iota 0 (size chs) in
  let closed := has (fun i => ~~ edge e j i) places && closed_mask s held (nth zch0 chs j) in
  all (fun i => if edge e j i then shown (t_arcs w) j i
    else closed && unseen_mask held (nth zch0 chs i) || has (fun fu => nth false fu.1 j && nth false fu.2 i) apart) places.
Definition check_graph (s : zsystem) (c : zgraph) (w : graph_witness) : bool :=
  let m := size (zchannels s) in
  [&& check_arcs s (t_arcs w), all (check_zero s) (t_zeros w), size (g_parts c) == m, all (check_pairs s (g_edges c) w) (iota 0 m) &
  [&& check_parts m (g_edges c) (g_parts c) (t_parts w), check_order_of m (g_edges c) (g_parts c) (t_order w) &
      g_connected c == all (fun k => k == head 0%N (g_parts c)) (g_parts c)]].

Theorem check_graph_sound s c w : check_graph s c w -> forall (K : fieldType) (h : {rmorphism rat -> K}) n m (p q : 'I_m -> nat)
  (S : multichannel K n p q), represents s S -> graph_holds S c.
Proof.
move=> ok K h n m p q S re; have em := re_m re; move: ok; rewrite /check_graph -em.
case/and5P=> arcs zeros /eqP sp /allP pairs /and3P[parts order /eqP conn].
have inI (j : 'I_m) : val j \in iota 0 m by rewrite mem_iota add0n ltn_ord.
have aE j i : arc S j i = edge (g_edges c) j i.
  have := pairs j (inI j); rewrite /check_pairs -em => /allP/(_ i (inI i)).
  case: ifP => [_|_ /orP[/andP[/andP[_ cl] un]|]]; first exact: (check_arcs_sound h re arcs).
    by apply/negbTE/(closed_mask_sound re cl un).
  case/(has_nthP ([::], [::]))=> k; rewrite size_map => kz /andP[].
  pose z0 := ZeroWitness [::] 0 [::] [::]; rewrite (nth_map z0) //=; set z := nth _ _ _ => from.
  rewrite (nth_map zch0) -?em // => un; apply/negbTE.
  apply: (zero_transfer_no_arc (T' := [set i]) (zero_transfer_of h re ((all_nthP z0 zeros) k kz) _)); rewrite ?inE //.
  by move=> i'; rewrite inE => /eqP ->.
have cE : connect (arc S) =2 connect (fun j i : 'I_m => edge (g_edges c) j i) by apply: eq_connect => j i; rewrite aE.
have pE j i : connect (arc S) j i && connect (arc S) i j = (nth 0%N (g_parts c) j == nth 0%N (g_parts c) i).
  by rewrite !cE (check_order_sound parts order).
split=> //; rewrite conn; split=> [sc|/all_nthP same j i].
  apply/(all_nthP 0%N) => k; rewrite sp => km; have m0 : (0 < m)%N by apply: leq_ltn_trans km.
  by have := pE (Ordinal km) (Ordinal m0); rewrite !sc /= nth0 => <-.
have at0 (k : 'I_m) : nth 0%N (g_parts c) k = head 0%N (g_parts c) by apply/eqP/same; rewrite sp.
by have := pE j i; rewrite !at0 eqxx => /andP[].
Qed.
