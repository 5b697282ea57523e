(* The controller of a loop: in its canonical form, for the words, and as programs of the kernel.  Trusted: it is what the
   theorem is about.

   What is absent, empty or a matrix of zeros is not used, and left out of the canonical form.  Loops in which messages are
   under way have more states, and are not verified here. *)
open Refused

type used = { from : string; sender : int; coefficients : Q.t list list }
type program = { outputs : used list; shared : used list; own : Q.t list list option; reference : Q.t list list option }
type agent = { name : string; shares : int; keeps : int; hold : (int * int) list; programs : (string * program) list }
type t = { text : string; added : int; listed : Kernel.zcontroller }

let labels = [ "shared_update"; "private_update"; "input" ]

(* Numbers have more forms in a controller than in a plant: others than the canonical ones are not read here. *)
let number place value =
  match value with
  | Json.String _ -> (try Json.rational place value with Refused (Malformed, _, _) -> incomplete place "a number that is not in lowest terms is not read here")
  | _ -> Json.rational place value

(* A matrix of this size; None if it is zero. *)
let read_matrix place nrows ncols value =
  let _, m = Plant.read_any ~shape:(nrows, ncols) ~ordered:false number place value in
  if List.for_all (List.for_all (fun x -> Q.sign x = 0)) m.Plant.rows then None else Some m.Plant.rows

(* Entries by some of the names, in the order of the system. *)
let by_name place known value =
  if value = Json.Null then []
  else
    List.concat (List.mapi (fun j (name, entry) -> if entry = Json.Null then [] else [ (name, j, entry) ])
                   (List.combine known (Json.fields ~optional:known place [] value)))

let read_program place known outputs shares nrows own value =
  match Json.fields ~optional:[ "outputs"; "shared"; "private"; "reference" ] place [] value with
  | [ by_outputs; by_shared; by_private; by_reference ] ->
    let used widths entries = List.filter_map (fun (from, sender, entry) ->
        Option.map (fun coefficients -> { from; sender; coefficients }) (read_matrix place nrows (List.nth widths sender) entry)) (by_name place known entries) in
    let one width value = if value = Json.Null then None else read_matrix place nrows width value in
    let outputs' = used outputs by_outputs in
    let shared = used shares by_shared in
    let own' = one (snd own) by_private in
    { outputs = outputs'; shared; own = own'; reference = one (List.nth outputs (fst own)) by_reference }
  | _ -> assert false

(* The canonical form: keys that say nothing are left out. *)
let json_of agents names time =
  let whole i = Json.Int (Z.of_int i) in
  let kept key empty value = if empty then [] else [ (key, value) ] in
  let named l = Json.Object (List.map (fun u -> (u.from, Json.of_rows u.coefficients)) l) in
  let single key = function None -> [] | Some rows -> [ (key, Json.of_rows rows) ] in
  let program p =
    kept "outputs" (p.outputs = []) (named p.outputs) @ kept "shared" (p.shared = []) (named p.shared) @ single "private" p.own @ single "reference" p.reference in
  let agent a =
    Json.Object ([ ("name", Json.String a.name); ("shared", whole a.shares); ("private", whole a.keeps) ]
                 @ kept "hold" (a.hold = []) (Json.Object (List.map (fun (j, d) -> (List.nth names j, whole d)) a.hold))
                 @ List.concat_map (fun (label, p) -> let maps = program p in kept label (maps = []) (Json.Object maps)) a.programs) in
  Json.Object [ ("time", Json.String time); ("agents", Json.List (List.map agent agents)) ]

(* Whether each agent gets what it uses, and at once. *)
let require_received (plant : Plant.t) place agents =
  let discrete = plant.Plant.time = "discrete" in
  List.iteri (fun i a ->
      let gets j = j = i || match plant.Plant.heard with None -> false | Some sets -> List.mem j (List.nth sets i) in
      let delay j = Option.value ~default:0 (List.assoc_opt (i, j) plant.Plant.waits) in
      let use held u =
        let steps = if held then Option.value ~default:0 (List.assoc_opt i (List.nth agents u.sender).hold) else 0 in
        let age = delay u.sender + steps in
        if not (gets u.sender && (age = 0 || discrete)) then invalid place "an agent does not get what it uses";
        if age > 0 then incomplete place "loops in which messages are under way are not verified here" in
      List.iter (fun (_, p) -> List.iter (use true) p.shared; List.iter (use false) p.outputs) a.programs) agents

(* All coefficients over one denominator: columns are the outputs of all channels, then x_1, z_1, x_2, z_2, ... *)
let list_of (plant : Plant.t) agents =
  let starts first l = List.rev (snd (List.fold_left (fun (at, l) width -> (at + width, at :: l)) (first, []) l)) in
  let q = List.map (fun (c : Plant.channel) -> c.Plant.outputs.Plant.nrows) plant.Plant.channels in
  let outputs = List.fold_left ( + ) 0 q in
  let states = List.map (fun a -> a.shares + a.keeps) agents in
  let width = outputs + List.fold_left ( + ) 0 states in
  let y = starts 0 q and w = starts outputs states in
  let rows i a nrows label =
    let p = List.assoc label a.programs in
    let cells = Array.make_matrix nrows width Q.zero in
    let put start = List.iteri (fun r -> List.iteri (fun c x -> cells.(r).(start + c) <- x)) in
    List.iter (fun u -> put (List.nth y u.sender) u.coefficients) p.outputs;
    List.iter (fun u -> put (List.nth w u.sender) u.coefficients) p.shared;
    Option.iter (put (List.nth w i + a.shares)) p.own;
    Array.to_list (Array.map Array.to_list cells) in
  let made = List.mapi (fun i a ->
      let p = (List.nth plant.Plant.channels i).Plant.inputs.Plant.ncols in
      (a, rows i a a.shares "shared_update" @ rows i a a.keeps "private_update", rows i a p "input")) agents in
  let d = List.fold_left (fun d (_, update, input) -> Z.lcm d (Plant.common_denominator (update @ input))) Z.one made in
  { Kernel.co_den = d; co_agents = List.map (fun (a, update, input) ->
        { Kernel.ag_states = a.shares + a.keeps; ag_update = Plant.times d update; ag_input = Plant.times d input }) made }

let read (plant : Plant.t) place value =
  match Json.fields place [ "time"; "agents" ] value with
  | [ time; listed ] ->
    let known = plant.Plant.names in
    let listed = List.map (fun each -> match Json.fields ~optional:[ "hold" ] place [ "name"; "shared"; "private"; "shared_update"; "private_update"; "input" ] each with
        | name :: shared :: kept :: rest -> (Json.string place name, Json.small place shared, Json.small place kept, rest) | _ -> assert false) (Json.items place listed) in
    let time = Json.string place time in
    if time <> "continuous" && time <> "discrete" then malformed place "expected \"continuous\" or \"discrete\"";
    if listed = [] then malformed place "expected at least one agent";
    if time <> plant.Plant.time || List.map (fun (name, _, _, _) -> name) listed <> known then invalid place "expected a controller for these agents and this time";
    let sizes = List.concat_map (fun (_, x, z, _) -> [ x; z ]) listed in
    if List.exists (fun size -> size > 10_000) sizes || List.fold_left ( + ) 0 sizes > 10_000 then incomplete place "too large";
    let outputs = List.map (fun (c : Plant.channel) -> c.Plant.outputs.Plant.nrows) plant.Plant.channels in
    let shares = List.map (fun (_, x, _, _) -> x) listed in
    let agents = List.mapi (fun i (name, x, z, rest) ->
        match rest with
        | [ shared_update; private_update; input; hold ] ->
          let hold = List.filter (fun (_, d) -> d > 0) (List.map (fun (_, j, d) -> (j, Json.small place d)) (by_name place known hold)) in
          let p = (List.nth plant.Plant.channels i).Plant.inputs.Plant.ncols in
          let programs = List.map2 (fun label (value, nrows) -> (label, read_program place known outputs shares nrows (i, z) value)) labels
              [ (shared_update, x); (private_update, z); (input, p) ] in
          { name; shares = x; keeps = z; hold; programs }
        | _ -> assert false) listed in
    require_received plant place agents;
    { text = Json.canonical (json_of agents known time); added = List.fold_left ( + ) 0 sizes; listed = list_of plant agents }
  | _ -> assert false
