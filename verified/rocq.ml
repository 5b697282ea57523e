(* A file of Rocq about one certificate: the plant and the rules as lists, and the claim as a theorem that one
   computation proves.  Coq reads the plant and the claim again, so nothing of this program is trusted. *)
open Kernel

let z x = if Zarith_integers.sign x < 0 then Printf.sprintf "(%s)%%coqZ" (Zarith_integers.to_string x) else Zarith_integers.to_string x ^ "%coqZ"
let nat = string_of_int
let bool b = if b then "true" else "false"
let list write l = if l = [] then "[::]" else "[:: " ^ String.concat "; " (List.map write l) ^ "]"
let row = list z
let matrix = list row
let subject = list (list bool)
let record name parts = "(" ^ String.concat " " (name :: parts) ^ ")"

let channel c = record "ZChannel" [ nat c.zp; nat c.zq; matrix c.zB; matrix c.zC ]
let system_text s = record "ZSystem" [ nat s.zn; z s.zD; matrix s.zA; list channel s.zchannels; matrix s.zfeed ]
let factor f =
  let in_A = match f.f_in_A with None -> "None" | Some a -> Printf.sprintf "(Some %d)" a in
  record "ZFactor" [ row f.f_p; in_A; nat f.f_most; list bool f.f_channels; nat f.f_rank ]
let claim c = record "ZClaim" [ row c.c_poly; list factor c.c_factors ]
let disc c = record "ZDisc" [ z c.d_re; z c.d_im; z c.d_rad ]
let regions g =
  let rate = match g.g_rate with None -> "None" | Some (low, high) -> Printf.sprintf "(Some (%s, %s))" (z low) (z high) in
  record "ZRegions" [ z g.g_w; bool g.g_continuous; list bool g.g_stable; list (list disc) g.g_discs; bool g.g_stabilizable; rate ]
let similar w = record "Similar" [ matrix w.h_H; matrix w.h_L; list nat w.h_order ]
let loop w = record "LoopWitness" [ z w.w_ell; z w.w_inv; list matrix w.w_gains; similar w.w_similar ]
let power w = record "Power" [ z w.pw_inv; row w.pw_q; row w.pw_r; nat w.pw_place; z w.pw_unit ]
let exponent x = record "ExponentWitness" [ row x.x_w; row x.x_q; row x.x_r; z x.x_k ]
let premises y =
  record "FactorPremises" [ nat y.y_fixed; nat y.y_coprime; nat y.y_simple; nat y.y_most; nat y.y_low; nat y.y_spectrum; exponent y.y_exponent ]
let residue w = record "ResidueWitness" [ z w.m_ell; z w.m_inv; z w.m_scale; z w.m_before; similar w.m_similar ]

let shrunk name places p c d =
  record name (places @ [ row p; record "ShrunkWitness" [ list bool c.b_T; list matrix c.b_U; list matrix c.b_V; z c.b_den; list nat c.b_pivots; nat c.b_rank; matrix c.b_Y; list matrix c.b_X; z c.b_dX ]; nat d ])

let rule = function
  | RNothing t -> record "RNothing" [ subject t ]
  | RKrylov (t, c) ->
    record "RKrylov" [ subject t; record "KrylovWitness" [ z c.k_ell; z c.k_inv; list matrix c.k_F; nat c.k_channel; row c.k_x; row c.k_y; row c.k_d; row c.k_a; row c.k_e ] ]
  | RTwo (t, c) -> record "RTwo" [ subject t; record "TwoWitness" [ loop c.tw_loop; similar c.tw_similar; row c.tw_u; row c.tw_v ] ]
  | RShrunk (t, p, c, d) -> shrunk "RShrunk" [ subject t ] p c d
  | RDual (t, p, c, d) -> shrunk "RDual" [ subject t ] p c d
  | RLocal (t, states, driven, p, c, d) -> shrunk "RLocal" [ subject t; list bool states; list bool driven ] p c d
  | RLocalDual (t, states, driven, p, c, d) -> shrunk "RLocalDual" [ subject t; list bool states; list bool driven ] p c d
  | RCoprime (p, q, c) -> record "RCoprime" [ row p; row q; record "Bezout" [ z c.z_ell; z c.z_inv; row c.z_u; row c.z_v ] ]
  | RBlocks (t, blocks, places) -> record "RBlocks" [ subject t; list nat blocks; list nat places ]
  | RSpectrum (t, f, w) -> record "RSpectrum" [ subject t; row f; record "SpectrumWitness" [ row w.s_ds; matrix w.s_N; list residue w.s_moduli ] ]
  | RMoved (t, g, c) -> record "RMoved" [ subject t; row g; record "MovedWitness" [ loop c.mv_loop; z c.mv_inv; row c.mv_u; row c.mv_v ] ]
  | RAtMost (t, p, e, c) ->
    record "RAtMost" [ subject t; row p; nat e; record "PowerWitness" [ loop c.pw_loop; power c.pw_power ] ]
  | RLow (t, p, d, c) ->
    record "RLow" [ subject t; row p; nat d; record "LowWitness" [ loop c.lw_loop; matrix c.lw_B0; matrix c.lw_C0; z c.lw_inv; row c.lw_u; row c.lw_v ] ]
  | RAllBlocks (t, c, place, ys) -> record "RAllBlocks" [ subject t; claim c; nat place; list premises ys ]
  | RAllTwo (t, c, spectrum, g, moved, ys) -> record "RAllTwo" [ subject t; claim c; nat spectrum; row g; nat moved; list premises ys ]
  | RAllLarge (t, c, w, ys) ->
    record "RAllLarge" [ subject t; claim c; record "LargeWitness" [ loop w.lg_loop; similar w.lg_similar; list power w.lg_powers; row w.lg_psi;
      row w.lg_u; row w.lg_v; z w.lg_D; matrix w.lg_N; z w.lg_r; row w.lg_H ]; list premises ys ]

let option write = function None -> "None" | Some x -> "(Some " ^ write x ^ ")"

(* `controllability` *)
let source = function FromInput (i, u) -> record "FromInput" [ nat i; nat u ] | FromEarlier j -> record "FromEarlier" [ nat j ]
let spectrum w = record "SpectrumWitness" [ row w.s_ds; matrix w.s_N; list residue w.s_moduli ]
let annihilator a = record "Annihilator" [ z a.a_den; matrix a.a_W; list nat a.a_pivots; row a.a_f; spectrum a.a_spectrum ]
let from_below = function
  | ByRank w -> record "ByRank" [ record "ReachWitness" [ z w.v_lower; z w.v_ell; z w.v_inv; list source w.v_sources; matrix w.v_X ] ]
  | ByFacts (outs, rules) -> record "ByFacts" [ list (fun (q, c) -> Printf.sprintf "(%d, %s)" q (matrix c)) outs; list rule rules ]

(* `transfer_graph` *)
let arcs w = record "ArcsWitness" [ z w.e_ell; z w.e_inv; list (list (list nat)) w.e_targets ]
let zero w = record "ZeroWitness" [ list bool w.z_from; z w.z_den; matrix w.z_X; list nat w.z_pivots ]
let parts w = record "PartsWitness" [ list nat w.q_roots; list nat w.q_next; list nat w.q_far; list nat w.q_before; list nat w.q_deep ]

(* `completeness` *)
let complete = function
  | IsComplete (rules, w, p) -> record "IsComplete" [ list rule rules; arcs w; parts p ]
  | ByMode rules -> record "ByMode" [ list rule rules ]
  | ByZero w -> record "ByZero" [ zero w ]
  | ByCut (sources, held) -> record "ByCut" [ list bool sources; list bool held ]

(* `setpoint` *)
let place = function OfState a -> record "OfState" [ nat a ] | OfPort (i, u) -> record "OfPort" [ nat i; nat u ]
let below w = record "BelowWitness" [ z w.w_l; z w.w_i; matrix w.w_X1; list matrix w.w_X2; list place w.w_columns ]
let above w = record "AboveWitness" [ z w.x_den; matrix w.x_W1; list matrix w.x_W2; list place w.x_places ]
let layer (first, rest) = Printf.sprintf "(%s, %s)" (matrix first) (list matrix rest)

(* What a theorem is about and where the meaning of its words is said; its definitions with their types; what it says of
   the system over a field; and the lemmas that prove it of the plant and of what constructions make of it, with their arguments. *)
type theorem = { name : string; about : string; meaning : string; definitions : (string * string * string) list;
                 says : (string -> string) -> string; plain : string; turned : string }

let over_fields holds = Printf.sprintf "forall (K : fieldType) (h : {rmorphism rat -> K}), %s" holds

let fixed_spectrum c g rules =
  { name = "fixed_spectrum"; about = "All fixed modes of";
    meaning = "claim_holds, in mcexact.kernel.fixed_rule, and regions_hold, in\n   mcexact.kernel.regions_rule, say what the claim means.";
    definitions = [ ("claim", "zclaim", claim c); ("regions", "zregions", regions g); ("rules", "seq rule", list rule rules) ];
    says = (fun system -> Printf.sprintf "(%s) /\\\n  (forall C : numClosedFieldType, regions_hold %s claim regions)"
        (over_fields (Printf.sprintf "claim_holds %s claim" (system "K"))) (system "C"));
    plain = "@check_whole_plant plant rules regions claim"; turned = "@fixed_spectrum_subject plant constructions subject sized made rules regions claim" }

let controllability (c : zreach) a w =
  { name = "controllability"; about = "What the inputs of some channels reach, of"; meaning = "reach_holds, in mcexact.kernel.reach_rule, says what the claim means.";
    definitions = [ ("claim", "zreach", record "ZReach" [ list bool c.r_T; nat c.r_dim; bool c.r_all; row c.r_poly ]);
                    ("above", "annihilator", annihilator a); ("below", "reach_evidence", from_below w) ];
    says = (fun system -> over_fields (Printf.sprintf "reach_holds %s claim" (system "K")));
    plain = "@controllability_plant plant sized claim above below"; turned = "@controllability_subject plant constructions subject sized made claim above below" }

let transfer_graph (c : zgraph) w =
  { name = "transfer_graph"; about = "Which channels reach which, of"; meaning = "graph_holds, in mcexact.kernel.arcs_rule, says what the claim means.";
    definitions = [ ("claim", "zgraph", record "ZGraph" [ list (list bool) c.g_edges; list nat c.g_parts; bool c.g_connected ]);
                    ("evidence", "graph_witness", record "GraphWitness" [ arcs w.t_arcs; list (list bool) w.t_held; list zero w.t_zeros; parts w.t_parts; list nat w.t_order ]) ];
    says = (fun system -> over_fields (Printf.sprintf "graph_holds %s claim" (system "K")));
    plain = "@transfer_graph_plant plant sized claim evidence"; turned = "@transfer_graph_subject plant constructions subject sized made claim evidence" }

let completeness holds w =
  { name = "completeness"; about = "Whether it is complete: for"; meaning = "complete is defined in mcexact.completeness.";
    definitions = [ ("evidence", "complete_evidence", complete w) ];
    says = (fun system -> Printf.sprintf "complete %s <-> %s" (system "[fieldType of rat]") (bool holds));
    plain = "@completeness_plant plant sized evidence " ^ bool holds; turned = "@completeness_subject plant constructions subject sized made evidence " ^ bool holds }

let setpoint discrete (c : zsetpoint) w =
  { name = "setpoint"; about = "The rank that decides set-points, of"; meaning = "setpoint_holds, in mcexact.kernel.setpoint_rule, says what the claim means.";
    definitions = [ ("claim", "zsetpoint", record "ZSetpoint" [ bool c.p_solvable; nat c.p_rank; option bool c.p_zero ]);
                    ("evidence", "setpoint_witness", record "SetpointWitness" [ below w.sp_below; above w.sp_above; z w.sp_point; below w.sp_full; list layer w.sp_row ]) ];
    says = (fun system -> over_fields (Printf.sprintf "setpoint_holds %s %s claim" (bool discrete) (system "K")));
    plain = Printf.sprintf "@setpoint_plant plant sized %s claim evidence" (bool discrete);
    turned = Printf.sprintf "@setpoint_subject plant constructions subject sized made %s claim evidence" (bool discrete) }

(* `closed_loop_spectrum` and `stability`, whose loops are systems of their own *)
let agent a = record "ZAgent" [ nat a.ag_states; matrix a.ag_update; matrix a.ag_input ]
let evidence (f, w) = [ ("polynomial", "zrow", row f); ("evidence", "spectrum_witness", spectrum w) ]
let controlled loop definitions = match loop with
  | Some c ->
    let c = c.Controller.listed in
    ("controller", "zcontroller", record "ZController" [ z c.co_den; list agent c.co_agents ]) :: definitions
  | None -> definitions
let matrix_of loop system field =
  if loop = None then Printf.sprintf "(mcA %s)" (system field) else Printf.sprintf "(system_loop %s plant controller)" field
let about_matrix loop words = if loop = None then words else words ^ " the loop of the controller with"
let meaning_of loop words = if loop = None then words else words ^ " system_loop, in mcexact.kernel.program_rule,\n   is the matrix of the loop."

let closed_loop_spectrum loop p proof =
  { name = "closed_loop_spectrum"; about = about_matrix loop "The characteristic polynomial of";
    meaning = meaning_of loop "up, in mcexact.kernel.lists, is the monic polynomial of a list.";
    definitions = controlled loop (("claim", "zrow", row p) :: evidence proof);
    says = (fun system -> Printf.sprintf "forall (K : fieldType) (h : {rmorphism rat -> K}), char_poly %s = up K claim" (matrix_of loop system "K"));
    plain = (match loop with
        | Some _ -> "@check_loop_spectrum_sound plant controller claim polynomial evidence" | None -> "@closed_loop_spectrum_plant plant sized claim polynomial evidence");
    turned = "@closed_loop_spectrum_subject plant constructions subject sized made claim polynomial evidence" }

let stability loop continuous u v flag proof =
  let claim = Printf.sprintf "%s %s %s %s" (bool continuous) (z u) (z v) (bool flag) in
  { name = "stability"; about = about_matrix loop "Whether the region has all eigenvalues of";
    meaning = meaning_of loop "within, in mcexact.kernel.program_rule, is the region.";
    definitions = controlled loop (evidence proof);
    says = (fun system -> Printf.sprintf "forall C : numClosedFieldType, %s <-> (forall z, eigenvalue %s z -> within %s %s %s z)"
        (bool flag) (matrix_of loop system "C") (z u) (z v) (bool continuous));
    plain = (match loop with
        | Some _ -> Printf.sprintf "@check_loop_stability_sound plant controller %s polynomial evidence" claim
        | None -> Printf.sprintf "@stability_plant plant sized %s polynomial evidence" claim);
    turned = Printf.sprintf "@stability_subject plant constructions subject sized made %s polynomial evidence" claim }

(* Constructions *)
let construction = function
  | ToDual -> "ToDual"
  | ToFeedback g -> record "ToFeedback" [ record "ZGains" [ z g.ga_den; list matrix g.ga_F ] ]
  | ToNeighbors sets -> record "ToNeighbors" [ list (list bool) sets ]
  | ToMerged parts -> record "ToMerged" [ list (list bool) parts ]
  | ToRestricted chosen -> record "ToRestricted" [ list bool chosen ]
  | ToFullOutput k -> record "ToFullOutput" [ nat k ]
  | ToExtended (sizes, own, sets) -> record "ToExtended" [ list nat sizes; list (list bool) own; list (list bool) sets ]
  | ToLowest g -> record "ToLowest" [ z g ]

let file digest s (subject : Subject.t) t =
  let changed = subject.Subject.made <> [] in
  let system field = if changed then Printf.sprintf "(sy_system (subject_of %s plant constructions))" field else Printf.sprintf "(system_of %s plant)" field in
  let define (name, kind, text) = Printf.sprintf "Definition %s : %s := %s." name kind text in
  String.concat "\n"
    ([ Printf.sprintf "(* %s %s %s.\n   The lists have A, B_i and C_i over one denominator.  %s%s *)" t.about
         (if changed then "what constructions make of the plant" else "the plant") digest t.meaning
         (if changed then "\n   subject_of, in mcexact.kernel.subjects, applies the constructions." else "");
       "From Coq Require Import ZArith.";
       "From mathcomp Require Import all_ssreflect all_algebra.";
       "From mcexact Require Import multichannel completeness.";
       "From mcexact.kernel Require Import lists systems residues krylov_rule shrunk_rule coprime_rule blocks_rule hessenberg_rule spectrum_rule loop_rule fixed_rule large_rule regions_rule facts reach_rule arcs_rule setpoint_rule program_rule kinds"
       ^ (if changed then " subjects." else ".");
       "";
       define ("plant", "zsystem", system_text s) ]
     @ (if changed then
          [ define ("constructions", "seq construction", list construction subject.Subject.made);
            define ("subject", "zsystem", "if zsubject plant constructions is Some s then s else plant") ]
        else [])
     @ List.map define t.definitions
     @ [ "Lemma sized : sized_system plant. Proof. by vm_compute. Qed." ]
     @ (if changed then [ "Lemma made : zsubject plant constructions = Some subject. Proof. by vm_compute. Qed." ] else [])
     @ [ Printf.sprintf "Theorem %s : %s." t.name (t.says system);
         Printf.sprintf "Proof. by apply: (%s); vm_compute. Qed." (if changed then t.turned else t.plain);
         "" ])
