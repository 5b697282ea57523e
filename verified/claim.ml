(* The claims, as records and as lists of the kernel.  Trusted: they are what the theorems say of the plant. *)
open Refused

(* The kind `fixed_spectrum`. *)

type factor = { polynomial : Q.t list; in_A : int option; at_most : int; channels : int list; rank : int;
                stable : bool; discs : Q.t list list }
type t = { whole : Q.t list; factors : factor list; stabilizable : bool; rate : Q.t list }

let read_polynomial place least value =
  let l = List.map (Json.rational place) (Json.items place value) in
  if List.length l <= least || not (Q.equal (List.nth l (List.length l - 1)) Q.one) then malformed place "expected a monic polynomial";
  l

let read_decimal place value =
  let s = Json.string place value in
  let digits s = s <> "" && String.for_all (fun c -> c >= '0' && c <= '9') s in
  let unsigned = if s <> "" && s.[0] = '-' then String.sub s 1 (String.length s - 1) else s in
  let whole, rest = match String.index_opt unsigned '.' with
    | None -> (unsigned, None) | Some i -> (String.sub unsigned 0 i, Some (String.sub unsigned (i + 1) (String.length unsigned - i - 1))) in
  if not (digits whole && (whole = "0" || whole.[0] <> '0') && match rest with None -> true | Some r -> digits r) then
    malformed place "expected a decimal such as \"-1.25\"";
  let digits, places = match rest with None -> (whole, 0) | Some r -> (whole ^ r, String.length r) in
  let value = Q.make (Z.of_string digits) (Z.pow (Z.of_int 10) places) in
  if unsigned = s then value else Q.neg value

let read_factor known value =
  let place = "claim.factors" in
  match Json.fields place [ "polynomial"; "channels"; "stable"; "roots"; "multiplicity_in_A"; "multiplicity_at_most"; "rank" ] value with
  | [ p; s; stable; roots; a; e; r ] ->
    let polynomial = read_polynomial place 1 p in
    let discs = List.map (fun disc -> List.map (read_decimal place) (Json.fields place [ "re"; "im"; "radius" ] disc))
        (Json.items ~length:(List.length polynomial - 1) place roots) in
    { polynomial; stable = Json.boolean place stable; discs; channels = Json.names place known s; in_A = (if a = Json.Null then None else Some (Json.small ~least:1 place a));
      at_most = Json.small ~least:1 place e; rank = Json.small place r }
  | _ -> assert false

let read known value =
  match Json.fields "claim" [ "polynomial"; "factors"; "stabilizable"; "best_rate" ] value with
  | [ whole; factors; flag; rate ] ->
    let rate = if rate = Json.Null then [] else List.map (read_decimal "claim.best_rate") (Json.fields "claim.best_rate" [ "lower"; "upper" ] rate) in
    { whole = read_polynomial "claim.polynomial" 0 whole; factors = List.map (read_factor known) (Json.items "claim.factors" factors);
      stabilizable = Json.boolean "claim.stabilizable" flag; rate }
  | _ -> assert false

(* Integers over the last one. *)
let integers p =
  let d = List.fold_left (fun d x -> Z.lcm d (Q.den x)) Z.one p in
  List.map (fun x -> Z.divexact (Z.mul d (Q.num x)) (Q.den x)) p

let listed m claim =
  { Kernel.c_poly = integers claim.whole;
    c_factors = List.map (fun f ->
        { Kernel.f_p = integers f.polynomial; f_in_A = f.in_A; f_most = f.at_most; f_rank = f.rank;
          f_channels = List.init m (fun i -> List.mem i f.channels) }) claim.factors }

(* What it says of the complex plane: discs and rate over one denominator. *)
let regions time claim =
  let numbers = claim.rate :: List.concat_map (fun f -> f.discs) claim.factors in
  let w = List.fold_left (List.fold_left (fun d x -> Z.lcm d (Q.den x))) Z.one numbers in
  let up x = Z.divexact (Z.mul w (Q.num x)) (Q.den x) in
  let disc = function [ re; im; radius ] -> { Kernel.d_re = up re; d_im = up im; d_rad = up radius } | _ -> assert false in
  { Kernel.g_w = w; g_continuous = time = "continuous"; g_stable = List.map (fun f -> f.stable) claim.factors;
    g_discs = List.map (fun f -> List.map disc f.discs) claim.factors; g_stabilizable = claim.stabilizable;
    g_rate = (match claim.rate with [ low; high ] -> Some (up low, up high) | _ -> None) }

(* The kind `controllability`. *)
type reach = { together : int list; dimension : int; whole_space : bool; rest : Q.t list }

let read_reach known value =
  match Json.fields "claim" [ "channels"; "dimension"; "controllable"; "uncontrollable_polynomial" ] value with
  | [ together; d; flag; p ] ->
    { together = Json.names "claim.channels" known together; dimension = Json.small "claim.dimension" d;
      whole_space = Json.boolean "claim.controllable" flag; rest = read_polynomial "claim.uncontrollable_polynomial" 0 p }
  | _ -> assert false

let mask m places = List.init m (fun i -> List.mem i places)
let listed_reach m claim =
  { Kernel.r_T = mask m claim.together; r_dim = claim.dimension; r_all = claim.whole_space; r_poly = integers claim.rest }

(* The kind `transfer_graph`: parts are in the order of their first members, and every channel is in one of them. *)
type graph = { arcs : (int * int) list; parts : int list list; connected : bool }

let read_arc place known value =
  match Json.items ~length:2 place value with
  | [ j; i ] ->
    let channel name = match Json.names place known (Json.List [ name ]) with [ i ] -> i | _ -> assert false in
    (channel j, channel i)
  | _ -> assert false

let read_graph known value =
  match Json.fields "claim" [ "arcs"; "components"; "strongly_connected" ] value with
  | [ arcs; parts; flag ] ->
    let arcs = List.map (read_arc "claim.arcs" known) (Json.items "claim.arcs" arcs) in
    if not (Json.increasing arcs) then malformed "claim.arcs" "expected them sorted, none twice";
    let parts = List.map (Json.names "claim.components" known) (Json.items "claim.components" parts) in
    let once = List.sort compare (List.concat parts) = List.init (List.length known) Fun.id in
    if not (once && List.for_all (fun part -> part <> []) parts && Json.increasing (List.map List.hd parts)) then
      invalid "claim.components" "these are not the strong components";
    { arcs; parts; connected = Json.boolean "claim.strongly_connected" flag }
  | _ -> assert false

let listed_graph m claim =
  let rec place k i = function part :: rest -> if List.mem i part then k else place (k + 1) i rest | [] -> assert false in
  let joined = Array.make_matrix m m false in
  List.iter (fun (j, i) -> joined.(j).(i) <- true) claim.arcs;
  { Kernel.g_edges = Array.to_list (Array.map Array.to_list joined); g_parts = List.init m (fun i -> place 0 i claim.parts); g_connected = claim.connected }

(* The kind `completeness`. *)
let read_complete value =
  match Json.fields "claim" [ "complete" ] value with [ flag ] -> Json.boolean "claim.complete" flag | _ -> assert false

(* The kind `setpoint`. *)
type setpoint = { solvable : bool; steady_rank : int; zero : bool option }

let read_setpoint value =
  match Json.fields "claim" [ "solvable"; "rank"; "invariant_zero" ] value with
  | [ flag; rank; zero ] ->
    { solvable = Json.boolean "claim.solvable" flag; steady_rank = Json.small "claim.rank" rank;
      zero = (if zero = Json.Null then None else Some (Json.boolean "claim.invariant_zero" zero)) }
  | _ -> assert false

let listed_setpoint claim = { Kernel.p_solvable = claim.solvable; p_rank = claim.steady_rank; p_zero = claim.zero }

(* The kind `closed_loop_spectrum`: a polynomial. *)
let read_spectrum value =
  match Json.fields "claim" [ "polynomial" ] value with [ p ] -> read_polynomial "claim.polynomial" 0 p | _ -> assert false

(* The kind `stability`: a rate in continuous time, a radius in discrete time, and whether all eigenvalues meet it. *)
type stability = { bound : Q.t; stable_loop : bool }

let read_stability time value =
  match Json.fields ~optional:[ "damping"; "largest_modulus" ] "claim" [ "bound"; "stable" ] value with
  | [ bound; flag; damping; largest ] ->
    let discrete = time = "discrete" in
    let bound = if bound = Json.Null then (if discrete then Q.one else Q.zero) else Json.rational "claim.bound" bound in
    if (if discrete then Q.sign bound <= 0 || Q.gt bound Q.one else Q.sign bound < 0) then invalid "claim.bound" "expected a rate >= 0, or a radius in (0, 1]";
    let stable_loop = Json.boolean "claim.stable" flag in
    if damping <> Json.Null || largest <> Json.Null then incomplete "claim" "damping ratios and largest moduli are not verified here";
    { bound; stable_loop }
  | _ -> assert false
