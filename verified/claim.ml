(* The claim of the kind `fixed_spectrum`.  Trusted: it is what the theorem says of the plant. *)
open Refused

type factor = { polynomial : Q.t list; in_A : int option; at_most : int; channels : int list; rank : int }
type t = { whole : Q.t list; factors : factor list }

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
    malformed place "expected a decimal such as \"-1.25\""

(* Discs, flags and the rate have their forms checked, and are not verified: `unverified` names them. *)
let unverified = [ "stable"; "roots"; "stabilizable"; "best_rate" ]

let read_factor known value =
  let place = "claim.factors" in
  match Json.fields place [ "polynomial"; "channels"; "stable"; "roots"; "multiplicity_in_A"; "multiplicity_at_most"; "rank" ] value with
  | [ p; s; stable; roots; a; e; r ] ->
    let polynomial = read_polynomial place 1 p in
    ignore (Json.boolean place stable);
    List.iter (fun disc -> List.iter (read_decimal place) (Json.fields place [ "re"; "im"; "radius" ] disc))
      (Json.items ~length:(List.length polynomial - 1) place roots);
    { polynomial; channels = Json.names place known s; in_A = (if a = Json.Null then None else Some (Json.small ~least:1 place a));
      at_most = Json.small ~least:1 place e; rank = Json.small place r }
  | _ -> assert false

let read known value =
  match Json.fields "claim" [ "polynomial"; "factors"; "stabilizable"; "best_rate" ] value with
  | [ whole; factors; flag; rate ] ->
    ignore (Json.boolean "claim.stabilizable" flag);
    if rate <> Json.Null then List.iter (read_decimal "claim.best_rate") (Json.fields "claim.best_rate" [ "lower"; "upper" ] rate);
    { whole = read_polynomial "claim.polynomial" 0 whole; factors = List.map (read_factor known) (Json.items "claim.factors" factors) }
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
