(* The plant of a certificate, in its canonical form, and its digest.  Trusted: it is what the theorem is about. *)
open Refused

type matrix = { nrows : int; ncols : int; rows : Q.t list list }
type channel = { name : string; inputs : matrix; outputs : matrix }
type t = { time : string; states : matrix; channels : channel list; names : string list; uncertain : bool; digest : string;
           heard : int list list option; waits : ((int * int) * int) list }

let longest = 1 lsl 20

(* Large matrices of few entries are listed by entries, and no others are, but those without rows. *)
let is_listed nrows ncols count = nrows * ncols >= 2048 && 8 * count <= nrows * ncols

(* A matrix by rows, or by its shape and entries, each position once; None instead of a number of entries if by rows.
   Entries of plants are `ordered`, and none is 0; controllers know the `shape` that is expected. *)
let read_any ?shape ~ordered number place value =
  let sized r c = match shape with Some expected when expected <> (r, c) -> malformed place "expected another shape" | _ -> () in
  match value with
  | Json.Object _ ->
    (match Json.fields place [ "shape"; "entries" ] value with
     | [ size; entries ] ->
       let nrows, ncols = match List.map (Json.small place) (Json.items ~length:2 place size) with [ r; c ] -> (r, c) | _ -> assert false in
       sized nrows ncols;
       if max nrows ncols > longest then incomplete place "too large";
       if nrows * ncols > 100_000_000 then incomplete place "too large";
       let cells = Array.make_matrix nrows ncols None and last = ref (-1, -1) in
       let entries = Json.items place entries in
       List.iter (fun triple ->
           match Json.items ~length:3 place triple with
           | [ i; j; x ] ->
             let i = Json.small place i and j = Json.small place j in
             if i >= nrows || j >= ncols || cells.(i).(j) <> None then malformed place "expected a position of its own";
             let x = number place x in
             if ordered && ((i, j) <= !last || Q.sign x = 0) then malformed place "expected the canonical form";
             last := (i, j);
             cells.(i).(j) <- Some x
           | _ -> assert false) entries;
       let rows = Array.map (fun row -> List.map (Option.value ~default:Q.zero) (Array.to_list row)) cells in
       (Some (List.length entries), { nrows; ncols; rows = Array.to_list rows })
     | _ -> assert false)
  | _ ->
    let rows = List.map (fun row -> List.map (number place) (Json.items place row)) (Json.items place value) in
    let nrows = List.length rows
    and ncols = match rows, shape with row :: _, _ -> List.length row | [], Some (_, c) -> c | [], None -> 0 in
    if List.exists (fun row -> List.length row <> ncols) rows then malformed place "expected rows of one length";
    sized nrows ncols;
    (None, { nrows; ncols; rows })

let read_entries place value = match read_any ~ordered:true Json.rational place value with
  | Some count, m -> (count, m) | None, _ -> malformed place "expected a shape and entries"

let read_matrix place value =
  let entries, m = read_any ~ordered:true Json.rational place value in
  let nonzero row = List.length (List.filter (fun x -> Q.sign x <> 0) row) in
  let canonical = match entries with
    | Some count -> is_listed m.nrows m.ncols count || (m.nrows = 0 && m.ncols > 0)
    | None -> not (is_listed m.nrows m.ncols (List.fold_left (fun sum row -> sum + nonzero row) 0 m.rows)) in
  if not canonical then malformed place "expected the canonical form";
  m

(* Names that are not ASCII have normal forms, which are not computed here. *)
let read_name place value =
  let name = Json.string place value in
  if String.exists (fun c -> Char.code c >= 0x80) name then incomplete place "names that are not ASCII are not read here";
  if name = "" || String.length name > 256 || String.exists (fun c -> Char.code c < 0x20 || Char.code c = 0x7f) name then
    malformed place "expected 1 to 256 characters that print";
  name

let read_channel k n value =
  let place = Printf.sprintf "channels[%d]" k in
  match Json.fields place [ "name"; "B"; "C" ] value with
  | [ name; b; c ] ->
    let inputs = read_matrix (place ^ ".B") b and outputs = read_matrix (place ^ ".C") c in
    if inputs.nrows <> n || outputs.ncols <> n then malformed place "expected another shape";
    { name = read_name place name; inputs; outputs }
  | _ -> assert false

(* For each agent whom it hears, besides itself, and the delays of (receiver, sender): loops depend on both. *)
let read_graph known heard waits =
  let by_name place value = match value with
    | Json.Object l -> List.map (fun (k, v) -> match Json.names place known (Json.List [ Json.String k ]) with [ i ] -> (i, v) | _ -> assert false) l
    | _ -> malformed place "expected an object" in
  if heard = Json.Null && waits <> Json.Null then malformed "delays" "expected neighbors, too";
  if heard = Json.Null then (None, [])
  else begin
    let sets = List.map (fun (i, v) ->
        let l = Json.names "neighbors" known v in
        if List.mem i l then malformed "neighbors" "an agent is not listed as its own neighbor";
        (i, l)) (by_name "neighbors" heard) in
    if List.length sets <> List.length known then malformed "neighbors" "expected every agent";
    let delays =
      if waits = Json.Null then []
      else begin
        let rows = by_name "delays" waits in
        if rows = [] then malformed "delays" "expected the canonical form";
        List.concat_map (fun (i, row) ->
            let row = by_name "delays" row in
            if row = [] then malformed "delays" "expected the canonical form";
            List.map (fun (j, steps) ->
                let steps = Json.small ~least:1 "delays" steps in
                if not (List.mem j (List.assoc i sets)) then malformed "delays" "nothing is received from there";
                ((i, j), steps)) row) rows
      end in
    (Some (List.mapi (fun i _ -> List.assoc i sets) known), delays)
  end

(* Radii are in the digest alone: the claims that are checked here are about the nominal values. *)
let read_radii states channels value =
  if value <> Json.Null then begin
    let place = "uncertainty" in
    let part m value =
      let count, radii = read_entries place value in
      if (radii.nrows, radii.ncols) <> (m.nrows, m.ncols) || count = 0 || List.exists (List.exists (fun x -> Q.sign x < 0)) radii.rows then
        malformed place "expected radii above 0" in
    let absolute = match Json.fields place [ "absolute" ] value with [ x ] -> x | _ -> assert false in
    if absolute = Json.Object [] then malformed place "expected the canonical form";
    let ports side = function
      | Json.Null -> ()
      | Json.Object (_ :: _ as l) ->
        List.iter (fun (name, v) -> match List.find_opt (fun each -> each.name = name) channels with
            | Some each -> part (side each) v | None -> malformed place "unknown key") l
      | _ -> malformed place "expected the canonical form" in
    match Json.fields ~optional:[ "A"; "B"; "C" ] place [] absolute with
    | [ a; b; c ] -> if a <> Json.Null then part states a; ports (fun each -> each.inputs) b; ports (fun each -> each.outputs) c
    | _ -> assert false
  end

let read value =
  (match value with
   | Json.Object l when List.mem_assoc "D" l -> incomplete "system" "plants with feedthrough are not read here"
   | Json.Object l when List.mem_assoc "parameters" l -> incomplete "system" "plants with parameters are not read here"
   | Json.String _ -> incomplete "system" "a plant that is named by its digest is not read here"
   | _ -> ());
  match Json.fields ~optional:[ "neighbors"; "delays"; "uncertainty" ] "system" [ "time"; "A"; "channels" ] value with
  | [ time; a; channels; heard; waits; radii ] ->
    let time = Json.string "time" time in
    if time <> "continuous" && time <> "discrete" then malformed "time" "expected \"continuous\" or \"discrete\"";
    let states = read_matrix "A" a in
    let channels = Json.items "channels" channels in
    if states.nrows <> states.ncols || channels = [] then malformed "system" "expected a square A and at least one channel";
    let channels = List.mapi (fun k each -> read_channel k states.nrows each) channels in
    let names = List.map (fun each -> each.name) channels in
    if List.length (List.sort_uniq compare names) <> List.length names then malformed "channels" "expected names of their own";
    let heard, waits = read_graph names heard waits in
    read_radii states channels radii;
    { time; states; channels; names; uncertain = radii <> Json.Null; digest = Sha256.digest (Json.canonical value); heard; waits }
  | _ -> assert false

(* The same as lists of integers over one denominator. *)
let common_denominator rows = List.fold_left (List.fold_left (fun d x -> Z.lcm d (Q.den x))) Z.one rows
let times d rows = List.map (List.map (fun x -> Z.divexact (Z.mul d (Q.num x)) (Q.den x))) rows

let listed plant =
  let d = List.fold_left (fun d each -> Z.lcm (Z.lcm d (common_denominator each.inputs.rows)) (common_denominator each.outputs.rows))
      (common_denominator plant.states.rows) plant.channels in
  { Kernel.zn = plant.states.nrows; zD = d; zA = times d plant.states.rows; zfeed = [];
    zchannels = List.map (fun each ->
        { Kernel.zp = each.inputs.ncols; zq = each.outputs.nrows; zB = times d each.inputs.rows; zC = times d each.outputs.rows })
        plant.channels }
