(* What a claim is about: the plant after some constructions, or the loop of the plant with a controller.  Trusted.

   `made` are the constructions as those of the kernel, `system` is what they make of the plant as a list, and `den` has
   the factors of all denominators under feedback, also of those that cancel. *)
open Refused

type t = { made : Kernel.construction list; system : Kernel.zsystem; known : string list; heard : int list list option; words : string;
           ports : string; den : Z.t; loop : Controller.t option }

(* The system after one more construction, over the least denominator. *)
let after subject c words =
  let apply s c = match Kernel.zmade s c with Some s -> s | None -> invalid "subject" "the construction cannot be applied" in
  let s = apply subject.system c in
  let common = List.fold_left (List.fold_left Z.gcd) in
  let g = List.fold_left (fun g (ch : Kernel.zchannel) -> common (common g ch.Kernel.zB) ch.Kernel.zC) (common s.Kernel.zD s.Kernel.zA) s.Kernel.zchannels in
  let lowest = if Z.equal g Z.one then [] else [ Kernel.ToLowest g ] in
  { subject with made = subject.made @ (c :: lowest); system = List.fold_left apply s lowest; words }

let feedback place value subject =
  let channels = subject.system.Kernel.zchannels in
  let gains = List.map2 (fun (ch : Kernel.zchannel) value -> Json.matrix place ch.Kernel.zp ch.Kernel.zq value)
      channels (Json.items ~length:(List.length channels) place value) in
  let rows = List.map (fun (d, rows) -> List.map (List.map (fun x -> Q.make x d)) rows) gains in
  let e = List.fold_left (fun e rows -> Z.lcm e (Plant.common_denominator rows)) Z.one rows in
  let text = Json.canonical (Json.Object (List.map2 (fun name rows -> (name, Json.of_rows rows)) subject.known rows)) in
  let words = Printf.sprintf "under the decentralized gains F with %s" (Words.with_digest text) in
  let made = after subject (Kernel.ToFeedback { Kernel.ga_den = e; ga_F = List.map (Plant.times e) rows }) (Words.suffixed words subject.words) in
  { made with den = Z.lcm subject.den (Z.mul subject.system.Kernel.zD e) }

let mask subject places = List.mapi (fun i _ -> List.mem i places) subject.known

(* For each agent whom it hears, itself among them. *)
let heard place subject =
  match subject.heard with
  | None -> invalid place "the system has no neighbor graph"
  | Some sets -> List.mapi (fun i l -> mask subject (i :: l)) sets

let augmented_outputs place subject =
  after subject (Kernel.ToNeighbors (heard place subject)) (Words.suffixed "with the outputs of neighbors measured by each agent" subject.words)

let extended place share dimensions subject =
  let shared = match share with
    | Json.String "outputs+states" -> "outputs and sub-states" | Json.String "states" -> "sub-states"
    | _ -> malformed place "expected what is shared" in
  let sizes = List.map (Json.small place) (Json.items ~length:(List.length subject.known) place dimensions) in
  if List.exists (fun size -> size > 10_000) sizes || List.fold_left ( + ) 0 sizes > 10_000 then incomplete place "too large";
  let sets = heard place subject in
  let own = if shared = "sub-states" then List.mapi (fun i _ -> mask subject [ i ]) sets else sets in
  let text = Json.canonical (Json.Object (List.map2 (fun name size -> (name, Json.Int (Z.of_int size))) subject.known sizes)) in
  let words = Printf.sprintf "the extended system without delays sharing %s of dimensions %s" shared text in
  after subject (Kernel.ToExtended (sizes, own, sets)) (Words.prefixed words subject.words)

let full_output place value subject =
  let k = match Json.names place subject.known (Json.List [ value ]) with [ k ] -> k | _ -> assert false in
  let words = Printf.sprintf "with the whole state measured by channel %s" (Words.json (List.nth subject.known k)) in
  after subject (Kernel.ToFullOutput k) (Words.suffixed words subject.words)

(* Parts of which every channel is in exactly one, by their first members. *)
let merged place value subject =
  let parts = List.map (Json.names place subject.known) (Json.items place value) in
  if List.mem [] parts || parts <> List.sort compare parts then malformed place "expected parts that are not empty, by their first members";
  let once = List.sort compare (List.concat parts) = List.mapi (fun i _ -> i) subject.known in
  if parts = [] || not once then invalid place "expected every channel in exactly one part, and a part";
  let known = List.map (fun part -> String.concat "+" (List.map (List.nth subject.known) part)) parts in
  if List.length (List.sort_uniq compare known) <> List.length known then invalid place "two channels would have the same name";
  let words = "with its channels merged into " ^ String.concat ", " (List.map (Words.channel_set subject.known) parts) in
  let made = after subject (Kernel.ToMerged (List.map (mask subject) parts)) (Words.suffixed words subject.words) in
  { made with known; heard = None }

let restricted place value subject =
  let chosen = Json.names place subject.known value in
  if chosen = [] then invalid place "expected at least one channel";
  let words = Printf.sprintf "with the channels %s alone" (Words.channel_set subject.known chosen) in
  let made = after subject (Kernel.ToRestricted (mask subject chosen)) (Words.suffixed words subject.words) in
  { made with known = List.map (List.nth subject.known) chosen; heard = None }

(* Other constructions are not verified here, nor are loops of what constructions make. *)
let read (plant : Plant.t) value =
  let known = plant.Plant.names and system = Plant.listed plant in
  let start = { made = []; system; known; heard = plant.Plant.heard; words = Words.plant plant.Plant.digest plant.Plant.uncertain; ports = ""; den = Z.one; loop = None } in
  let step subject (k, value) =
    let place = Printf.sprintf "subject[%d]" k in
    let parameters keys = List.tl (Json.fields place ("construction" :: keys) value) in
    let name = match value with Json.Object l -> List.assoc_opt "construction" l | _ -> None in
    match name, subject.loop with
    | Some (Json.String _), Some _ -> incomplete place "no construction after a closed loop is verified here"
    | Some (Json.String "dual"), None ->
      ignore (parameters []);
      { (after subject Kernel.ToDual (Words.prefixed "the dual" subject.words)) with heard = None }
    | Some (Json.String "feedback"), None ->
      feedback place (List.hd (parameters [ "gains" ])) subject
    | Some (Json.String "augmented_outputs"), None -> ignore (parameters []); augmented_outputs place subject
    | Some (Json.String "extended"), None ->
      (match parameters [ "share"; "dimensions" ] with [ share; dimensions ] -> extended place share dimensions subject | _ -> assert false)
    | Some (Json.String "full_output"), None -> full_output place (List.hd (parameters [ "channel" ])) subject
    | Some (Json.String "merged"), None -> merged place (List.hd (parameters [ "parts" ])) subject
    | Some (Json.String "restricted"), None -> restricted place (List.hd (parameters [ "channels" ])) subject
    | Some (Json.String "closed_loop"), None when k = 0 ->
      let c = Controller.read plant place (List.hd (parameters [ "controller" ])) in
      let n = system.Kernel.zn and channels = Words.channel_set known (List.mapi (fun i _ -> i) known) in
      let ports = Printf.sprintf "%d of the controlled system and %d added by the controller of the channels %s" n c.Controller.added channels in
      let words = "the closed loop with the controller with " ^ Words.with_digest c.Controller.text in
      { subject with loop = Some c; words = Words.prefixed words subject.words; ports }
    | Some (Json.String _), None -> incomplete place "a construction that is not verified here"
    | _ -> malformed place "expected an object with the key \"construction\"" in
  List.fold_left step start (List.mapi (fun k value -> (k, value)) (Json.items "subject" value))

(* The checker in Python takes no modulus that has a factor in common with a denominator, even of one that cancels. *)
let rec require_coprime den = function
  | Json.Object l ->
    let modulus = function
      | Json.Int l when not (Z.equal (Z.gcd l den) Z.one) -> incomplete "witness.modulus" "not coprime to the denominators of the subject"
      | _ -> () in
    List.iter (function
        | ("modulus", value) -> modulus value
        | ("moduli", Json.List l) -> List.iter modulus l
        | (_, value) -> require_coprime den value) l
  | Json.List l -> List.iter (require_coprime den) l
  | _ -> ()

let statement (plant : Plant.t) subject sentence =
  let added = match subject.loop with Some c -> c.Controller.added | None -> 0 in
  let ports = if subject.ports = "" then "channels " ^ Words.braced (List.map Words.json subject.known) else subject.ports in
  Words.statement subject.words (subject.system.Kernel.zn + added) ports plant.Plant.time sentence
