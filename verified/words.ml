(* Statements in words, those of the checker in Python.  Trusted: whoever reads a statement takes it for what was proved. *)

let json s = let buffer = Buffer.create 16 in Json.text_of_string buffer s; Buffer.contents buffer
let denied holds = if holds then "" else "not "
let names known places = List.map (fun i -> json (List.nth known i)) places
let braced l = "{" ^ String.concat ", " l ^ "}"
let channel_set known places = braced (names known places)

(* Highest power first, such as x^2 - 3/2*x + 1. *)
let polynomial p =
  let term k c =
    let power = if k = 0 then "" else if k = 1 then "x" else Printf.sprintf "x^%d" k in
    let size = if Q.equal (Q.abs c) Q.one && power <> "" then "" else Q.to_string (Q.abs c) in
    ((if Q.sign c < 0 then "-" else "+"), size ^ (if size <> "" && power <> "" then "*" else "") ^ power) in
  let terms = List.filter (fun (_, c) -> Q.sign c <> 0) (List.mapi (fun k c -> (k, c)) p) in
  match List.rev_map (fun (k, c) -> term k c) terms with
  | [] -> "0"
  | (sign, first) :: rest -> String.concat " " (((if sign = "-" then "-" else "") ^ first) :: List.concat_map (fun (sign, each) -> [ sign; each ]) rest)

(* A digest, and what it is of where this is short. *)
let with_digest text = Printf.sprintf "SHA-256 %s%s" (Sha256.digest text) (if String.length text <= 80 then " = " ^ text else "")

let counted number noun = Printf.sprintf "%d %s%s" number noun (if number = 1 then "" else "s")

(* The plant, and systems named before or behind what they are made from: what begins with a construction stands in
   parentheses behind which another one is named. *)
let plant digest uncertain = Printf.sprintf "the plant %s%s" digest (if uncertain then " at its nominal values" else "")
let prefixed words before = Printf.sprintf "%s of: %s" words before
let suffixed words before =
  let alone = String.starts_with ~prefix:"the plant" before || String.starts_with ~prefix:"(" before in
  Printf.sprintf "%s %s" (if alone then before else "(" ^ before ^ ")") words

(* About a system with so many states. *)
let statement system states ports time sentence =
  Printf.sprintf "For %s (%s, %s, %s time): %s" system (counted states "state") ports time sentence

let fixed = "fixed under linear time-invariant decentralized control"
let pencil = "[xI - A, B; C, 0]"

(* Sorted by center and radius. *)
let disc_set discs =
  let rec less a b = match a, b with x :: a, y :: b -> let c = Q.compare x y in if c = 0 then less a b else c | _ -> 0 in
  let text = function
    | [ re; im; radius ] ->
      let imaginary = if Q.sign im = 0 then "" else Printf.sprintf " %s %si" (if Q.sign im < 0 then "-" else "+") (Q.to_string (Q.abs im)) in
      Printf.sprintf "%s%s +- %s" (Q.to_string re) imaginary (Q.to_string radius)
    | _ -> assert false in
  braced (List.map text (List.sort less discs))

let factor time known (f : Claim.factor) =
  let exponent = match f.Claim.in_A with None -> "some exponent" | Some a -> Printf.sprintf "the exponent %d" a in
  Printf.sprintf
    "%s is %s%s, has %s in det(xI - A) and at most %d in the greatest common divisor of det(xI - A_F) over all constant gains F, and one root \
     in each of the discs %s, where the least rank of %s over all sets of channels, C the outputs of the set and B the inputs of the others, \
     is %d, reached by %s"
    (polynomial f.Claim.polynomial) (denied f.Claim.stable) (if time = "continuous" then "Hurwitz" else "Schur") exponent f.Claim.at_most
    (disc_set f.Claim.discs) pencil f.Claim.rank (channel_set known f.Claim.channels)

let fixed_spectrum time known (claim : Claim.t) =
  let whole = polynomial claim.Claim.whole in
  let start = if whole = "1" then "no mode is " ^ fixed else Printf.sprintf "the modes that are %s are the roots of %s" fixed whole in
  let factors = List.sort compare (List.map (fun (f : Claim.factor) -> (List.length f.Claim.polynomial, factor time known f)) claim.Claim.factors) in
  let slowest = if time = "continuous" then "minus the largest real part of a fixed mode" else "the largest modulus of a fixed mode" in
  let rate = match claim.Claim.rate with
    | [ low; high ] -> Printf.sprintf "; %s is from %s to %s" slowest (Q.to_string low) (Q.to_string high) | _ -> "" in
  let last = Printf.sprintf "it is %sstabilizable by linear time-invariant decentralized control%s" (denied claim.Claim.stabilizable) rate in
  String.concat "; " ((start :: List.map snd factors) @ [ last ])

let controllability known (claim : Claim.reach) =
  Printf.sprintf "the channels %s together control a subspace of dimension exactly %d; it is %scontrollable through them, with the uncontrollable polynomial %s"
    (channel_set known claim.Claim.together) claim.Claim.dimension (denied claim.Claim.whole_space) (polynomial claim.Claim.rest)

let transfer_graph known (claim : Claim.graph) =
  let name i = json (List.nth known i) in
  let edges = braced (List.map (fun (j, i) -> name j ^ " -> " ^ name i) claim.Claim.arcs) in
  Printf.sprintf
    "its transfer graph, in which j -> i means that C_i (xI - A)^-1 B_j is not zero, has exactly the edges %s, the strong components %s, and is %sstrongly connected"
    edges (String.concat ", " (List.map (channel_set known) claim.Claim.parts)) (denied claim.Claim.connected)

let completeness holds =
  Printf.sprintf "it is %scomplete, where complete means that its transfer graph is strongly connected and no mode is %s" (denied holds) fixed

let setpoint time (claim : Claim.setpoint) =
  let shift, place = if time = "discrete" then (" - I", 1) else ("", 0) in
  let rows = Printf.sprintf "[A%s, B; C, 0], B and C those of all channels, has rank exactly %d, which is %sits number of rows" shift
      claim.Claim.steady_rank (denied claim.Claim.solvable) in
  match claim.Claim.zero with
  | None -> rows ^ ", so that integrators of all outputs add no uncontrollable mode"
  | Some zero ->
    Printf.sprintf
      "%s, so that in no stable linear time-invariant loop every output tends to every constant set-point; the normal rank of %s is %sits number of rows%s"
      rows pencil (denied zero) (if zero then Printf.sprintf ", so that %d is an invariant zero" place else "")

let closed_loop_spectrum p = "the characteristic polynomial of A is " ^ polynomial p

let stability time (claim : Claim.stability) =
  let inside = if time = "discrete" then "modulus below " ^ Q.to_string claim.Claim.bound else "real part below " ^ Q.to_string (Q.neg claim.Claim.bound) in
  Printf.sprintf "%severy eigenvalue of A has %s" (denied claim.Claim.stable_loop) inside
