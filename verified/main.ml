(* mcexact-verified: checks certificates by the program that Coq extracted from its own proof.

   For each file one line: the verdict, and for CONFIRMED the statement that was proved, behind its digest: the same as
   that of the checker in Python. *)
open Refused

let version = "3"

(* What a certificate says in words, whether the kernel proves it, and the theorem as a file of Rocq. *)
type read = { statement : string; proves : unit -> bool; theorem : unit -> string }

(* Of the system that the claim is about: what constructions make of the plant, or a loop. *)
let claimed kind (plant : Plant.t) subject claim witness =
  let known = subject.Subject.known and s = subject.Subject.system and loop = subject.Subject.loop in
  let m = List.length known and about = Subject.statement plant subject in
  let file = Rocq.file plant.Plant.digest (Plant.listed plant) subject in
  let of_no_loop () = if loop <> None then incomplete "subject" "of loops, spectrum and stability are verified here" in
  match kind with
  | "fixed_spectrum" ->
    of_no_loop ();
    let said = Claim.read known claim in
    let meant = Claim.listed m said and regions = Claim.regions plant.Plant.time said in
    let rules = Witness.fixed_spectrum s known meant witness in
    { statement = about (Words.fixed_spectrum plant.Plant.time known said);
      proves = (fun () -> Kernel.check_whole s rules regions = Some meant); theorem = (fun () -> file (Rocq.fixed_spectrum meant regions rules)) }
  | "controllability" ->
    of_no_loop ();
    let said = Claim.read_reach known claim in
    let meant = Claim.listed_reach m said in
    let annihilator, below = Structure.controllability s known meant witness in
    { statement = about (Words.controllability known said);
      proves = (fun () -> Kernel.check_controllability s meant annihilator below); theorem = (fun () -> file (Rocq.controllability meant annihilator below)) }
  | "transfer_graph" ->
    of_no_loop ();
    let said = Claim.read_graph known claim in
    let meant = Claim.listed_graph m said in
    let evidence = Structure.transfer_graph s known said meant witness in
    { statement = about (Words.transfer_graph known said);
      proves = (fun () -> Kernel.check_graph s meant evidence); theorem = (fun () -> file (Rocq.transfer_graph meant evidence)) }
  | "completeness" ->
    of_no_loop ();
    let said = Claim.read_complete claim in
    let evidence = Structure.completeness s known said witness in
    { statement = about (Words.completeness said);
      proves = (fun () -> Kernel.check_complete s evidence = Some said); theorem = (fun () -> file (Rocq.completeness said evidence)) }
  | "setpoint" ->
    of_no_loop ();
    let said = Claim.read_setpoint claim in
    let meant = Claim.listed_setpoint said and discrete = plant.Plant.time = "discrete" in
    let evidence = Structure.setpoint s discrete meant witness in
    { statement = about (Words.setpoint plant.Plant.time said);
      proves = (fun () -> Kernel.check_setpoint s discrete meant evidence); theorem = (fun () -> file (Rocq.setpoint discrete meant evidence)) }
  | "closed_loop_spectrum" ->
    let said = Claim.read_spectrum claim in
    let meant = Claim.integers said in
    let d, rows = Structure.loop_matrix s loop in
    let f, w = Structure.spectrum d rows said witness in
    { statement = about (Words.closed_loop_spectrum said);
      proves = (fun () ->
          match loop with Some c -> Kernel.check_loop_spectrum s c.Controller.listed meant f w | None -> Kernel.check_open_spectrum s meant f w);
      theorem = (fun () -> file (Rocq.closed_loop_spectrum loop meant (f, w))) }
  | "stability" ->
    let said = Claim.read_stability plant.Plant.time claim in
    let flag = said.Claim.stable_loop and continuous = plant.Plant.time = "continuous" in
    let u = Q.num said.Claim.bound and v = Q.den said.Claim.bound in
    Structure.require_by_polynomial witness;
    let d, rows = Structure.loop_matrix s loop in
    let f, w = Modular.spectrum d rows in
    { statement = about (Words.stability plant.Plant.time said);
      proves = (fun () ->
          match loop with
          | Some c -> Kernel.check_loop_stability s c.Controller.listed continuous u v flag f w
          | None -> Kernel.check_open_stability s continuous u v flag f w);
      theorem = (fun () -> file (Rocq.stability loop continuous u v flag (f, w))) }
  | _ -> incomplete "kind" "not a kind that is verified here"

let certificate text =
  let document = Json.parse text in
  let member key = match document with
    | Json.Object l -> List.assoc_opt key l | _ -> malformed "file" "expected a certificate" in
  (match member "format" with
   | Some (Json.String "mcexact-certificate/1") -> ()
   | _ -> malformed "format" "expected \"mcexact-certificate/1\"");
  match Json.fields "file" [ "format"; "kind"; "system"; "subject"; "claim"; "witness" ] document with
  | [ _; kind; system; subject; claim; witness ] ->
    let kind = Json.string "kind" kind in
    let plant = Plant.read system in
    let subject = Subject.read plant subject in
    Subject.require_coprime subject.Subject.den witness;
    (try claimed kind plant subject claim witness
     with Division_by_zero -> incomplete "witness.modulus" "a number is not invertible modulo l, as evidence is prepared here")
  | _ -> assert false

let proved text =
  let read = certificate text in
  if not (read.proves ()) then invalid "witness" "the kernel does not prove the claim";
  read

let check text =
  let read = proved text in
  Printf.sprintf "CONFIRMED %s %s" (Sha256.digest read.statement) read.statement

let rocq text = (proved text).theorem ()

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
