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
let system s = record "ZSystem" [ nat s.zn; z s.zD; matrix s.zA; list channel s.zchannels; matrix s.zfeed ]
let factor f =
  let in_A = match f.f_in_A with None -> "None" | Some a -> Printf.sprintf "(Some %d)" a in
  record "ZFactor" [ row f.f_p; in_A; nat f.f_most; list bool f.f_channels; nat f.f_rank ]
let claim c = record "ZClaim" [ row c.c_poly; list factor c.c_factors ]
let disc c = record "ZDisc" [ z c.d_re; z c.d_im; z c.d_rad ]
let regions g =
  let rate = match g.g_rate with None -> "None" | Some (low, high) -> Printf.sprintf "(Some (%s, %s))" (z low) (z high) in
  record "ZRegions" [ z g.g_w; bool g.g_continuous; list bool g.g_stable; list (list disc) g.g_discs; bool g.g_stabilizable; rate ]
let similar w = record "Similar" [ matrix w.h_H; matrix w.h_L; matrix w.h_Y ]
let loop w = record "LoopWitness" [ z w.w_ell; z w.w_inv; list matrix w.w_gains; similar w.w_similar ]
let exponent x = record "ExponentWitness" [ row x.x_w; row x.x_q; row x.x_r; z x.x_k ]
let premises y =
  record "FactorPremises" [ nat y.y_fixed; nat y.y_coprime; nat y.y_simple; nat y.y_most; nat y.y_low; nat y.y_spectrum; exponent y.y_exponent ]
let residue w = record "ResidueWitness" [ z w.m_ell; z w.m_inv; z w.m_scale; z w.m_before; similar w.m_similar ]

let shrunk name t p c d =
  record name [ subject t; row p; record "ShrunkWitness" [ list bool c.b_T; list matrix c.b_U; list matrix c.b_V; z c.b_den; list nat c.b_pivots; nat c.b_rank; matrix c.b_Y; list matrix c.b_X; z c.b_dX ]; nat d ]

let rule = function
  | RNothing t -> record "RNothing" [ subject t ]
  | RKrylov (t, c) ->
    record "RKrylov" [ subject t; record "KrylovWitness" [ z c.k_ell; z c.k_inv; list matrix c.k_F; nat c.k_channel; row c.k_x; row c.k_y; row c.k_d; row c.k_a; row c.k_e ] ]
  | RTwo (t, c) -> record "RTwo" [ subject t; record "TwoWitness" [ loop c.tw_loop; similar c.tw_similar; row c.tw_u; row c.tw_v ] ]
  | RShrunk (t, p, c, d) -> shrunk "RShrunk" t p c d
  | RDual (t, p, c, d) -> shrunk "RDual" t p c d
  | RCoprime (p, q, c) -> record "RCoprime" [ row p; row q; record "Bezout" [ z c.z_ell; z c.z_inv; row c.z_u; row c.z_v ] ]
  | RBlocks (t, blocks, places) -> record "RBlocks" [ subject t; list nat blocks; list nat places ]
  | RSpectrum (t, f, w) -> record "RSpectrum" [ subject t; row f; record "SpectrumWitness" [ row w.s_ds; matrix w.s_N; list residue w.s_moduli ] ]
  | RMoved (t, g, c) -> record "RMoved" [ subject t; row g; record "MovedWitness" [ loop c.mv_loop; z c.mv_inv; row c.mv_u; row c.mv_v ] ]
  | RAtMost (t, p, e, c) ->
    record "RAtMost" [ subject t; row p; nat e; record "PowerWitness" [ loop c.pw_loop; z c.pw_inv; row c.pw_q; row c.pw_r; nat c.pw_place; z c.pw_unit ] ]
  | RLow (t, p, d, c) ->
    record "RLow" [ subject t; row p; nat d; record "LowWitness" [ loop c.lw_loop; matrix c.lw_B0; matrix c.lw_C0; z c.lw_inv; row c.lw_u; row c.lw_v ] ]
  | RAllBlocks (t, c, place, ys) -> record "RAllBlocks" [ subject t; claim c; nat place; list premises ys ]
  | RAllTwo (t, c, spectrum, g, moved, ys) -> record "RAllTwo" [ subject t; claim c; nat spectrum; row g; nat moved; list premises ys ]

let file digest s c g rules =
  String.concat "\n"
    [ "(* All fixed modes of the plant " ^ digest ^ ".";
      "   The lists have A, B_i and C_i over one denominator.  claim_holds, in mcexact.kernel.fixed_rule, and regions_hold, in
   mcexact.kernel.regions_rule, say what the claim means. *)";
      "From Coq Require Import ZArith.";
      "From mathcomp Require Import all_ssreflect all_algebra.";
      "From mcexact.kernel Require Import lists systems residues krylov_rule shrunk_rule coprime_rule blocks_rule hessenberg_rule spectrum_rule loop_rule fixed_rule regions_rule facts.";
      "";
      "Definition plant : zsystem := " ^ system s ^ ".";
      "Definition claim : zclaim := " ^ claim c ^ ".";
      "Definition regions : zregions := " ^ regions g ^ ".";
      "Definition rules : seq rule := " ^ list rule rules ^ ".";
      "Theorem fixed_spectrum : (forall (K : fieldType) (h : {rmorphism rat -> K}), claim_holds (system_of K plant) claim) /\\";
      "  (forall C : numClosedFieldType, regions_hold (system_of C plant) claim regions).";
      "Proof. by apply: (@check_whole_plant plant rules regions claim); vm_compute. Qed.";
      "" ]
