(* What a claim is about: the plant, its dual, or the loop with a controller.  Trusted. *)
open Refused

type t = Plain | Dual | Loop of Controller.t

(* Other constructions are not verified here. *)
let read (plant : Plant.t) value =
  let step place = function
    | Json.Object l when List.assoc_opt "construction" l = Some (Json.String "dual") ->
      if List.length l > 1 then malformed place "unknown key";
      Dual
    | Json.Object l as step when List.assoc_opt "construction" l = Some (Json.String "closed_loop") ->
      (match Json.fields place [ "construction"; "controller" ] step with [ _; value ] -> Loop (Controller.read plant place value) | _ -> assert false)
    | _ -> incomplete place "no construction but one dual, or one closed loop, is verified here" in
  match Json.items "subject" value with
  | [] -> Plain
  | [ one ] -> step "subject" one
  | _ -> incomplete "subject" "no construction but one dual, or one closed loop, is verified here"
