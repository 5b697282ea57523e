(* The operations of Zarith that the kernel's extraction names.  Coq's modulo by a positive number lies from 0 to below
   it, as Zarith's `erem` does; the kernel asks for no other.  Coq's quotients are rounded down, and by 0 they are 0.
   Numbers are moved by no fewer than 0 binary digits, and a logarithm is that of a positive number, or 0. *)
include Z

let modulo a b = if sign b > 0 then erem a b else invalid_arg "modulus"
let quotient a b = if sign b = 0 then zero else fdiv a b
let shifted_left a k = shift_left a (to_int k)
let shifted_right a k = shift_right a (to_int k)
let logarithm a = if sign a > 0 then of_int (log2 a) else zero
