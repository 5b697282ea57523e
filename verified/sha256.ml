(* SHA-256 (FIPS 180-4), in lower-case hexadecimal. *)

let primes count =
  let rec go found k = if List.length found = count then List.rev found
    else go (if List.for_all (fun p -> k mod p <> 0) found then k :: found else found) (k + 1) in
  go [] 2

(* The first 32 bits of the fractional part of the r-th root of p. *)
let root_bits r p =
  let root = Z.root (Z.shift_left (Z.of_int p) (32 * r)) r in
  Z.to_int (Z.logand root (Z.of_string "4294967295"))

let k = Array.of_list (List.map (root_bits 3) (primes 64))
let start = Array.of_list (List.map (root_bits 2) (primes 8))
let mask = 0xffffffff
let rotate x n = ((x lsr n) lor (x lsl (32 - n))) land mask

let digest text =
  let bits = 8 * String.length text in
  let zeros = (119 - (String.length text mod 64)) mod 64 in
  let length = String.init 8 (fun i -> Char.chr ((bits lsr (8 * (7 - i))) land 0xff)) in
  let padded = text ^ "\128" ^ String.make zeros '\000' ^ length in
  let h = Array.copy start and w = Array.make 64 0 in
  for block = 0 to (String.length padded / 64) - 1 do
    for i = 0 to 15 do
      w.(i) <- Int32.to_int (String.get_int32_be padded ((64 * block) + (4 * i))) land mask
    done;
    for i = 16 to 63 do
      let s0 = rotate w.(i - 15) 7 lxor rotate w.(i - 15) 18 lxor (w.(i - 15) lsr 3) in
      let s1 = rotate w.(i - 2) 17 lxor rotate w.(i - 2) 19 lxor (w.(i - 2) lsr 10) in
      w.(i) <- (w.(i - 16) + s0 + w.(i - 7) + s1) land mask
    done;
    let v = Array.copy h in
    for i = 0 to 63 do
      let e = v.(4) and a = v.(0) in
      let s1 = rotate e 6 lxor rotate e 11 lxor rotate e 25 in
      let choice = e land v.(5) lxor (lnot e land mask land v.(6)) in
      let t1 = (v.(7) + s1 + choice + k.(i) + w.(i)) land mask in
      let s0 = rotate a 2 lxor rotate a 13 lxor rotate a 22 in
      let majority = a land v.(1) lxor (a land v.(2)) lxor (v.(1) land v.(2)) in
      for j = 7 downto 1 do v.(j) <- v.(j - 1) done;
      v.(4) <- (v.(4) + t1) land mask;
      v.(0) <- (t1 + s0 + majority) land mask
    done;
    Array.iteri (fun i x -> h.(i) <- (h.(i) + x) land mask) v
  done;
  String.concat "" (Array.to_list (Array.map (Printf.sprintf "%08x") h))
