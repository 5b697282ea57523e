(* What a claim is about: the plant after some constructions, or the loop of the plant with a controller.  Trusted.

   `made` are the constructions as those of the kernel, and `system` is what they make of the plant as a list. *)
open Refused

type t = { made : Kernel.construction list; system : Kernel.zsystem; known : string list; words : string; ports : string;
           loop : Controller.t option }

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
  after subject (Kernel.ToFeedback { Kernel.ga_den = e; ga_F = List.map (Plant.times e) rows }) (Words.suffixed words subject.words)

(* Other constructions are not verified here, nor are loops of what constructions make. *)
let read (plant : Plant.t) value =
  let known = plant.Plant.names and system = Plant.listed plant in
  let start = { made = []; system; known; words = Words.plant plant.Plant.digest plant.Plant.uncertain; ports = ""; loop = None } in
  let step subject (k, value) =
    let place = Printf.sprintf "subject[%d]" k in
    let parameters keys = List.tl (Json.fields place ("construction" :: keys) value) in
    let name = match value with Json.Object l -> List.assoc_opt "construction" l | _ -> None in
    match name, subject.loop with
    | Some (Json.String _), Some _ -> incomplete place "no construction after a closed loop is verified here"
    | Some (Json.String "dual"), None ->
      ignore (parameters []);
      after subject Kernel.ToDual (Words.prefixed "the dual" subject.words)
    | Some (Json.String "feedback"), None ->
      (match parameters [ "gains" ] with [ gains ] -> feedback place gains subject | _ -> assert false)
    | Some (Json.String "closed_loop"), None when k = 0 ->
      let c = match parameters [ "controller" ] with [ value ] -> Controller.read plant place value | _ -> assert false in
      let n = system.Kernel.zn and channels = Words.channel_set known (List.mapi (fun i _ -> i) known) in
      let ports = Printf.sprintf "%d of the controlled system and %d added by the controller of the channels %s" n c.Controller.added channels in
      let words = "the closed loop with the controller with " ^ Words.with_digest c.Controller.text in
      { subject with loop = Some c; words = Words.prefixed words subject.words; ports }
    | Some (Json.String _), None -> incomplete place "a construction that is not verified here"
    | _ -> malformed place "expected an object with the key \"construction\"" in
  List.fold_left step start (List.mapi (fun k value -> (k, value)) (Json.items "subject" value))

let statement (plant : Plant.t) subject sentence =
  let added = match subject.loop with Some c -> c.Controller.added | None -> 0 in
  let ports = if subject.ports = "" then "channels " ^ Words.braced (List.map Words.json subject.known) else subject.ports in
  Words.statement subject.words (subject.system.Kernel.zn + added) ports plant.Plant.time sentence
