(* The three ways to stop: as in the checker in Python, a document does not have the form that FORMAT.md prescribes, it
   proves nothing, or it is beyond what is read here. *)

type verdict = Malformed | Invalid | Incomplete

exception Refused of verdict * string * string

let malformed place message = raise (Refused (Malformed, place, message))
let invalid place message = raise (Refused (Invalid, place, message))
let incomplete place message = raise (Refused (Incomplete, place, message))
let name = function Malformed -> "MALFORMED" | Invalid -> "INVALID" | Incomplete -> "INCOMPLETE"
