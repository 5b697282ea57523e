(* The kinds other than `fixed_spectrum`, for which facts are not enough: `controllability` (of the dual system,
   observability), `transfer_graph`, `completeness`, `setpoint`, and without a controller `closed_loop_spectrum` and
   `stability`, which program_rule.v has with one.  Each check proves its claim of every system that a
   list represents, and so of the plant of the list, and of the subjects of subjects.v. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel fixed_bound transfer_graph completeness.
From mcexact.kernel Require Import lists systems residues shrunk_rule fixed_rule regions_rule reach_rule arcs_rule setpoint_rule program_rule facts.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* The last fact of a run, if it is about the plant itself. *)
Definition last_fact (s : zsystem) (rs : seq rule) : option fact :=
  if sized_system s then if run s [::] rs is Some e then if last ([::], Bounded 0) e is ([::], f) then Some f else None else None else None.
Lemma last_fact_holds s rs f : last_fact s rs = Some f -> holds s f.
Proof.
rewrite /last_fact; case: ifP => // sz; case rn: run => [e|] //; have ok := run_sound sz (@start_holds s) rn.
by rewrite -nth_last -/(premise e (size e).-1); have := ok (size e).-1; case: (premise _ _) => -[|? ?] f' //= hf [<-].
Qed.
Lemma map_represents (K L : fieldType) (f : {rmorphism K -> L}) s n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> represents s (map_system f S).
Proof.
have up d a b M : map_mx f (over K d a b M) = over L d a b M.
  by apply/matrixP=> i j; rewrite !mxE rmorphM fmorphV !map_phi.
by case=> sz en em ep eq eA eB eC; split=> //= [|k|k]; rewrite ?eA ?eB ?eC up.
Qed.

(* Controllability. *)
Inductive reach_evidence := ByRank of reach_witness | ByFacts of seq (nat * zmat) & seq rule.
(* Nothing where the evidence is wrong, even if no dimension is left to prove. *)
Definition reached (s : zsystem) (T : seq bool) (ev : reach_evidence) : option nat :=
  match ev with
  | ByRank w => if check_reach s T w then Some (reach_of w) else None
  | ByFacts outs rs => if last_fact (ztogether s T outs) rs is Some (Bounded L) then Some L else None end.
Definition check_controllability (s : zsystem) (c : zreach) (a : annihilator) (ev : reach_evidence) : bool :=
  [&& check_annihilator s (r_T c) (r_poly c) a, reach_sizes c s a &
      if reached s (r_T c) ev is Some L then (r_dim c <= L)%N else false].
Theorem check_controllability_sound s c a ev : check_controllability s c a ev -> forall (K : fieldType) (h : {rmorphism rat -> K}) n m
  (p q : 'I_m -> nat) (S : multichannel K n p q), represents s S -> reach_holds S c.
Proof.
case/and3P=> ann sizes; case ok: reached => [L|//] low K h n m p q S re; apply: (reach_claim h re ann sizes); apply: leq_trans low _.
case: ev ok => [w|outs rs] /=; first by case: ifP => // /(check_reach_sound h re) lw [<-].
case lf: last_fact => [[L'| | | | | | |]|] // [<-]; apply: (together_reach (outs := outs) re).
have sz : sized_system (ztogether s (r_T c) outs) by move: lf; rewrite /last_fact; case: ifP.
exact: (last_fact_holds lf h (system_of_represents K sz)).
Qed.

(* Completeness. *)
Inductive complete_evidence :=
 | IsComplete of seq rule & arcs_witness & parts_witness  (* nothing is fixed, and edges connect all channels *)
 | ByMode of seq rule                                     (* something is fixed *)
 | ByZero of zero_witness                                 (* no edge leads from some channels to the others *)
 | ByCut of seq bool & seq bool.                          (* nor does a path: the channels, and the states they act on *)
Definition proper (m : nat) (T : seq bool) : bool := has (nth false T) (iota 0 m) && has (fun i => ~~ nth false T i) (iota 0 m).
Definition shown_edges (m : nat) (w : arcs_witness) : edges := mkseq (fun j => mkseq (shown w j) m) m.
Definition check_complete (s : zsystem) (ev : complete_evidence) : option bool :=
  let: (chs, m) := (zchannels s, size (zchannels s)) in
  match ev with
  | IsComplete rs w parts =>
    if last_fact s rs is Some (Bounded L) then
      if [&& (zn s <= L)%N, check_arcs s w & check_parts m (shown_edges m w) (nseq m 0%N) parts] then Some true else None
    else None
  | ByMode rs =>
    if last_fact s rs is Some (Fixed f T d) then if [&& 0 < d, 1 < size f & ~~ Z.eqb (last z0 f) 0]%N then Some false else None else None
  | ByZero z =>
    if [&& check_zero s z, proper m (z_from z) & all (fun i => nth false (z_from z) i || unseen_zero z (nth zch0 chs i)) (iota 0 m)]
    then Some false else None
  | ByCut T held =>
    if proper m T && all (fun i => if nth false T i then closed_mask s held (nth zch0 chs i) else unseen_mask held (nth zch0 chs i)) (iota 0 m)
    then Some false else None end.

Section Complete.
Variables (s : zsystem) (n m : nat) (p q : 'I_m -> nat) (S : multichannel rat n p q).
Hypothesis re : represents s S.
Let h0 : {rmorphism rat -> rat} := [rmorphism of @idfun rat].
Let inI (j : 'I_m) : val j \in iota 0 m. Proof. by rewrite mem_iota add0n ltn_ord. Qed.

Lemma never (P : Prop) : ~ P -> (P <-> false). Proof. by split. Qed.
Lemma not_connected (T : seq bool) : proper m T -> (forall j i : 'I_m, nth false T j -> ~~ nth false T i -> ~~ arc S j i) -> ~ complete S.
Proof.
case/andP=> /hasP[j0 + jT] /hasP[i0 + iT]; rewrite !mem_iota !add0n /= => jm im cut [sc _].
have cut' (j i : 'I_m) : j \in channels_at m T -> i \notin channels_at m T -> ~~ arc S j i by rewrite !inE; apply: cut.
by have := connect_cut cut' (sc (Ordinal jm) (Ordinal im)); rewrite !inE /= jT (negPf iT) => /(_ isT).
Qed.
Theorem check_complete_sound ev b : check_complete s ev = Some b -> complete S <-> b.
Proof.
have em := re_m re; have en := re_n re; rewrite /check_complete -em -en; case: ev => [rs w parts|rs|z|T held].
- case lf: last_fact => [[L| | | | | | |]|] //; case: ifP => // /and3P[nL arcs con] -[<-]; split=> // _; split.
    apply: (strongly_connected_arcs (e := fun j i => edge (shown_edges m w) j i)) => j i.
      by rewrite /edge !nth_mkseq // => /(check_arcs_sound h0 re arcs).
    by apply: (check_parts_sound con); rewrite !nth_nseq !if_same.
  move=> K h lambda; apply: bounded_absence; have [g [g0 top sg]] := last_fact_holds lf h (map_represents h re).
  by exists g; split=> //; apply: leq_trans sg; rewrite leq_add2l.
- case lf: last_fact => [[|f T d| | | | | |]|] //; case: ifP => // /and3P[d0 sf l0] -[<-]; apply: never => -[_ no].
  pose h : {rmorphism rat -> algCfield} := [rmorphism of @ratr algCfield].
  have [dv _] := last_fact_holds lf h (map_represents h re).
  have [x rx] : exists x, root (up algCfield f) x.
    by apply/closed_rootP; rewrite (up_size h l0) gtn_eqF.
  apply: (no _ h x) => F; rewrite eigenvalue_root_char -dvdp_XsubCl; apply: dvdp_trans (dv F).
  by rewrite -(prednK d0) exprS dvdp_mulr // dvdp_XsubCl.
- case: ifP => // /and3P[okz pr /allP un] -[<-]; apply: never; apply: (not_connected pr) => j i jT iT.
  apply: (zero_transfer_no_arc (T' := [set i]) (zero_transfer_of h0 re okz _)); rewrite ?inE //.
  by move=> i'; rewrite inE => /eqP ->; have := un i (inI i); rewrite (negPf iT).
case: ifP => // /andP[pr /allP ok] -[<-]; apply: never; apply: (not_connected pr) => j i jT iT.
have := ok j (inI j); rewrite jT => cl; have := ok i (inI i); rewrite (negPf iT) => un.
exact: (closed_mask_sound re cl un).
Qed.
End Complete.

(* The plant of a list. *)
Section Plant.
Variable s : zsystem.
Hypothesis sz : sized_system s.
Let plain (K : fieldType) := system_of_represents K sz.
Corollary controllability_plant c a ev : check_controllability s c a ev -> forall (K : fieldType) (h : {rmorphism rat -> K}), reach_holds (system_of K s) c.
Proof. by move=> ok K h; apply: (check_controllability_sound ok h). Qed.
Corollary transfer_graph_plant c w : check_graph s c w -> forall (K : fieldType) (h : {rmorphism rat -> K}), graph_holds (system_of K s) c.
Proof. by move=> ok K h; apply: (check_graph_sound ok h). Qed.
Corollary completeness_plant ev b : check_complete s ev = Some b -> complete (system_of [fieldType of rat] s) <-> b.
Proof. exact: check_complete_sound (plain _) _ _. Qed.
Corollary setpoint_plant d c w : check_setpoint s d c w -> forall (K : fieldType) (h : {rmorphism rat -> K}), setpoint_holds d (system_of K s) c.
Proof. by move=> ok K h; apply: (check_setpoint_sound ok h). Qed.
Corollary closed_loop_spectrum_plant f g w : check_open_spectrum s f g w ->
  forall (K : fieldType) (h : {rmorphism rat -> K}), char_poly (mcA (system_of K s)) = up K f.
Proof. by move=> ok K h; apply: (check_open_spectrum_sound ok h). Qed.
Corollary stability_plant continuous u v flag f w : check_open_stability s continuous u v flag f w ->
  forall C : numClosedFieldType, flag <-> (forall z, eigenvalue (mcA (system_of C s)) z -> within u v continuous z).
Proof. by move=> ok C; apply: (check_open_stability_sound ok). Qed.
End Plant.
