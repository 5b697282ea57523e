(* mcexact-verified: checks certificates by the program that Coq extracted from its own proof.

   For each file one line: the verdict, and for CONFIRMED the digests of the plant and of the claim that were read, both
   of their canonical JSON. *)
open Refused

let version = "1"

(* The plant, the claim, and the rules of a certificate; the digests of plant and claim. *)
let prepared text =
  let document = Json.parse text in
  let member key = match document with
    | Json.Object l -> List.assoc_opt key l | _ -> malformed "file" "expected a certificate" in
  (match member "format" with
   | Some (Json.String "mcexact-certificate/1") -> ()
   | _ -> malformed "format" "expected \"mcexact-certificate/1\"");
  match Json.fields "file" [ "format"; "kind"; "system"; "subject"; "claim"; "witness" ] document with
  | [ _; kind; system; subject; claim; witness ] ->
    if Json.string "kind" kind <> "fixed_spectrum" then incomplete "kind" "not a kind that is verified here";
    if Json.items "subject" subject <> [] then incomplete "subject" "no constructions are verified here";
    let plant = Plant.read system in
    let known = plant.Plant.names in
    let listed = Plant.listed plant in
    let said = Claim.read known claim in
    let meant = Claim.listed (List.length known) said and regions = Claim.regions plant.Plant.time said in
    let rules = try Witness.fixed_spectrum listed known meant witness with Division_by_zero -> invalid "witness.modulus" "a number is not invertible modulo l" in
    (plant.Plant.digest, Sha256.digest (Json.canonical claim), listed, meant, regions, rules)
  | _ -> assert false

let proved text =
  let (_, _, listed, meant, regions, rules) as parts = prepared text in
  (match Kernel.check_whole listed rules regions with
   | Some claim when claim = meant -> ()
   | _ -> invalid "witness" "the rules do not prove the claim");
  parts

let check text =
  let plant, claim, _, _, _, _ = proved text in
  Printf.sprintf "CONFIRMED %s %s" plant claim

let rocq text =
  let plant, _, listed, meant, regions, rules = proved text in
  Rocq.file plant listed meant regions rules

let read_file path =
  let channel = if path = "-" then stdin else open_in_bin path in
  set_binary_mode_in channel true;
  let buffer = Buffer.create 65536 in
  (try
     while Buffer.length buffer <= Json.most_bytes do
       Buffer.add_channel buffer channel 1
     done
   with End_of_file -> ());
  if path <> "-" then close_in channel;
  Buffer.contents buffer

let verdict work path =
  match work (read_file path) with
  | line -> (0, line)
  | exception Refused (verdict, place, message) ->
    ((match verdict with Malformed -> 3 | Invalid -> 1 | Incomplete -> 5), Printf.sprintf "%s %s: %s" (name verdict) place message)
  | exception Sys_error message -> (3, "MALFORMED file: cannot be read: " ^ message)
  | exception (Stack_overflow | Out_of_memory) -> (5, "INCOMPLETE checker: more memory than there is")
  | exception error -> (70, "ERROR checker: " ^ Printexc.to_string error)

let () =
  match Array.to_list Sys.argv with
  | [ _; "--version" ] -> print_endline ("mcexact-verified " ^ version)
  | [ _; "--rocq"; path ] -> let status, text = verdict rocq path in print_endline text; exit status
  | _ :: (_ :: _ as paths) ->
    let statuses = List.map (fun path -> let status, line = verdict check path in print_endline line; status) paths in
    exit (Option.value (List.find_opt (fun status -> List.mem status statuses) [ 70; 3; 1; 5 ]) ~default:0)
  | _ -> prerr_endline "usage: mcexact-verified FILE... | --rocq FILE | --version"; exit 2
