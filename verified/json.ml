(* Strict reading of JSON, and canonical writing.  Trusted: what it reads is what a theorem is about.

   As the checker in Python reads: UTF-8, no key twice, no number with a point or an exponent, no constants such as NaN,
   at most 16 levels, at most 4,300 digits in a row, and at most 64 MiB. *)
open Refused

type t = Null | Bool of bool | Int of Z.t | String of string | List of t list | Object of (string * t) list

let most_bytes = 64 * 1024 * 1024
let most_levels = 16
let most_digits = 4300

(* Runs of digits longer than allowed anywhere in the text, also as escapes of the form \u003d. *)
let limit_digits text =
  let n = String.length text and run = ref 0 and i = ref 0 in
  while !i < n do
    let escaped = !i + 5 < n && String.sub text !i 5 = "\\u003" && text.[!i + 5] >= '0' && text.[!i + 5] <= '9' in
    if escaped || (text.[!i] >= '0' && text.[!i] <= '9') then incr run else run := 0;
    if !run > most_digits then incomplete "file" "more than 4300 digits in a row";
    i := !i + if escaped then 6 else 1
  done

(* Well-formed UTF-8, without surrogates and overlong forms. *)
let limit_encoding text =
  let n = String.length text in
  let rec go i =
    if i < n then begin
      let b k = if i + k < n then Char.code text.[i + k] else 0 in
      let tail k = b k land 0xc0 = 0x80 in
      let c = b 0 in
      if c < 0x80 then go (i + 1)
      else if c >= 0xc2 && c < 0xe0 && tail 1 then go (i + 2)
      else if c land 0xf0 = 0xe0 && tail 1 && tail 2 && not (c = 0xe0 && b 1 < 0xa0) && not (c = 0xed && b 1 >= 0xa0) then go (i + 3)
      else if c >= 0xf0 && c <= 0xf4 && tail 1 && tail 2 && tail 3 && not (c = 0xf0 && b 1 < 0x90) && not (c = 0xf4 && b 1 >= 0x90) then go (i + 4)
      else malformed "file" "expected UTF-8 text"
    end in
  go 0

let add_code buffer code = Buffer.add_utf_8_uchar buffer (Uchar.of_int code)

let parse text =
  if String.length text > most_bytes then incomplete "file" "more than 64 MiB";
  limit_encoding text;
  limit_digits text;
  let n = String.length text and at = ref 0 in
  let bad message = malformed (Printf.sprintf "byte %d" !at) message in
  let peek () = if !at < n then text.[!at] else '\000' in
  let rec blanks () = match peek () with ' ' | '\t' | '\n' | '\r' when !at < n -> incr at; blanks () | _ -> () in
  let expect c = if !at < n && text.[!at] = c then incr at else bad (Printf.sprintf "expected %C" c) in
  let word w v = if !at + String.length w <= n && String.sub text !at (String.length w) = w then (at := !at + String.length w; v) else bad "not JSON" in
  let hex () =
    let code = ref 0 in
    for _ = 1 to 4 do
      let d = match peek () with
        | '0' .. '9' as c -> Char.code c - 48 | 'a' .. 'f' as c -> Char.code c - 87 | 'A' .. 'F' as c -> Char.code c - 55
        | _ -> bad "expected a hexadecimal digit" in
      code := (16 * !code) + d;
      incr at
    done;
    !code in
  let string () =
    expect '"';
    let buffer = Buffer.create 16 in
    let rec go () =
      if !at >= n then bad "a string without end";
      match text.[!at] with
      | '"' -> incr at
      | '\\' ->
        incr at;
        let c = peek () in
        incr at;
        (match c with
         | '"' | '\\' | '/' -> Buffer.add_char buffer c
         | 'b' -> Buffer.add_char buffer '\b' | 'f' -> Buffer.add_char buffer '\012' | 'n' -> Buffer.add_char buffer '\n'
         | 'r' -> Buffer.add_char buffer '\r' | 't' -> Buffer.add_char buffer '\t'
         | 'u' ->
           let first = hex () in
           if first >= 0xd800 && first < 0xdc00 then begin
             expect '\\'; expect 'u';
             let second = hex () in
             if second < 0xdc00 || second > 0xdfff then bad "half of a surrogate pair";
             add_code buffer (0x10000 + ((first - 0xd800) lsl 10) + (second - 0xdc00))
           end
           else if first >= 0xdc00 && first <= 0xdfff then bad "half of a surrogate pair"
           else add_code buffer first
         | _ -> bad "not an escape");
        go ()
      | c when Char.code c < 0x20 -> bad "a control character in a string"
      | c -> Buffer.add_char buffer c; incr at; go () in
    go ();
    Buffer.contents buffer in
  let number () =
    let start = !at in
    if peek () = '-' then incr at;
    (match peek () with
     | '0' when !at < n -> incr at
     | '1' .. '9' -> while !at < n && peek () >= '0' && peek () <= '9' do incr at done
     | _ -> bad "not JSON");
    (match peek () with '.' | 'e' | 'E' when !at < n -> bad "expected an integer or a string \"p/q\"" | _ -> ());
    Int (Z.of_string (String.sub text start (!at - start))) in
  let rec value depth =
    if depth > most_levels then malformed "file" "nested deeper than 16 levels";
    blanks ();
    if !at >= n then bad "not JSON";
    match peek () with
    | '{' ->
      incr at; blanks ();
      if depth + 1 > most_levels then malformed "file" "nested deeper than 16 levels";
      let known = Hashtbl.create 8 in
      let member () =
        blanks ();
        let key = string () in
        if Hashtbl.mem known key then bad "a key given twice in one object";
        Hashtbl.add known key ();
        blanks (); expect ':';
        let v = value (depth + 1) in
        blanks (); (key, v) in
      if peek () = '}' then (incr at; Object [])
      else begin
        let members = ref [ member () ] in
        while peek () = ',' do incr at; members := member () :: !members done;
        expect '}'; Object (List.rev !members)
      end
    | '[' ->
      incr at; blanks ();
      if depth + 1 > most_levels then malformed "file" "nested deeper than 16 levels";
      if peek () = ']' then (incr at; List [])
      else begin
        let item () = let v = value (depth + 1) in blanks (); v in
        let items = ref [ item () ] in
        while peek () = ',' do incr at; items := item () :: !items done;
        expect ']'; List (List.rev !items)
      end
    | '"' -> String (string ())
    | 't' -> word "true" (Bool true)
    | 'f' -> word "false" (Bool false)
    | 'n' -> word "null" Null
    | '-' | '0' .. '9' -> number ()
    | _ -> bad "not JSON" in
  let result = value 0 in
  blanks ();
  if !at < n then bad "more than one value";
  result

(* As JSON is written in statements: keys sorted by code points, no blanks, ASCII. *)
let text_of_string buffer s =
  Buffer.add_char buffer '"';
  let escape code = Buffer.add_string buffer (Printf.sprintf "\\u%04x" code) in
  let rec go i =
    if i < String.length s then begin
      let b k = Char.code s.[i + k] in
      let tail k = b k land 0x3f in
      let code, length =
        if b 0 < 0x80 then (b 0, 1)
        else if b 0 < 0xe0 then (((b 0 land 0x1f) lsl 6) lor tail 1, 2)
        else if b 0 < 0xf0 then (((b 0 land 0x0f) lsl 12) lor (tail 1 lsl 6) lor tail 2, 3)
        else (((b 0 land 0x07) lsl 18) lor (tail 1 lsl 12) lor (tail 2 lsl 6) lor tail 3, 4) in
      (match code with
       | 0x22 -> Buffer.add_string buffer "\\\"" | 0x5c -> Buffer.add_string buffer "\\\\"
       | 0x08 -> Buffer.add_string buffer "\\b" | 0x0c -> Buffer.add_string buffer "\\f" | 0x0a -> Buffer.add_string buffer "\\n"
       | 0x0d -> Buffer.add_string buffer "\\r" | 0x09 -> Buffer.add_string buffer "\\t"
       | c when c >= 0x20 && c < 0x7f -> Buffer.add_char buffer (Char.chr c)
       | c when c < 0x10000 -> escape c
       | c -> escape (0xd800 + ((c - 0x10000) lsr 10)); escape (0xdc00 + ((c - 0x10000) land 0x3ff)));
      go (i + length)
    end in
  go 0;
  Buffer.add_char buffer '"'

let canonical value =
  let buffer = Buffer.create 1024 in
  let separated write items = List.iteri (fun i x -> if i > 0 then Buffer.add_char buffer ','; write x) items in
  let rec write = function
    | Null -> Buffer.add_string buffer "null"
    | Bool b -> Buffer.add_string buffer (string_of_bool b)
    | Int z -> Buffer.add_string buffer (Z.to_string z)
    | String s -> text_of_string buffer s
    | List l -> Buffer.add_char buffer '['; separated write l; Buffer.add_char buffer ']'
    | Object l ->
      Buffer.add_char buffer '{';
      separated (fun (k, v) -> text_of_string buffer k; Buffer.add_char buffer ':'; write v) (List.sort (fun (a, _) (b, _) -> compare a b) l);
      Buffer.add_char buffer '}' in
  write value;
  Buffer.contents buffer

(* Readers, each of a value at a place. *)
let fields ?(optional = []) place names = function
  | Object l ->
    List.iter (fun name -> if not (List.mem_assoc name l) then malformed place ("the key " ^ name ^ " is missing")) names;
    List.iter (fun (k, v) ->
        if not (List.mem k names || List.mem k optional) then malformed place "unknown key";
        if List.mem k optional && v = Null then malformed place ("the key " ^ k ^ " is null; leave it out")) l;
    List.map (fun name -> Option.value (List.assoc_opt name l) ~default:Null) (names @ optional)
  | _ -> malformed place "expected an object"

let items ?length place = function
  | List l -> (match length with Some k when List.length l <> k -> malformed place (Printf.sprintf "expected %d of them" k) | _ -> l)
  | _ -> malformed place "expected a list"

let integer ?least place = function
  | Int z when (match least with Some k -> Z.geq z (Z.of_int k) | None -> true) -> z
  | _ -> malformed place "expected an integer"

let small ?(least = 0) place value =
  let z = integer ~least place value in
  if Z.fits_int z then Z.to_int z else incomplete place "too large an integer"

let boolean place = function Bool b -> b | _ -> malformed place "expected true or false"
let string place = function String s -> s | _ -> malformed place "expected a string"

(* An integer, or "p/q" in lowest terms with q from 2 on. *)
let rational place value =
  let bad () = malformed place "expected an integer or \"p/q\" in lowest terms" in
  let digits s = s <> "" && String.for_all (fun c -> c >= '0' && c <= '9') s && (s = "0" || s.[0] <> '0') in
  match value with
  | Int z -> Q.of_bigint z
  | String s ->
    (match String.index_opt s '/' with
     | None -> bad ()
     | Some i ->
       let p = String.sub s 0 i and q = String.sub s (i + 1) (String.length s - i - 1) in
       let unsigned = if p <> "" && p.[0] = '-' then String.sub p 1 (String.length p - 1) else p in
       if not (digits unsigned && digits q) then bad ();
       let p = Z.of_string p and q = Z.of_string q in
       if Z.leq q Z.one || not (Z.equal (Z.gcd p q) Z.one) then bad ();
       Q.make p q)
  | _ -> bad ()

(* The same as it is written, and a matrix by its rows. *)
let of_rational x = if Z.equal (Q.den x) Z.one then Int (Q.num x) else String (Q.to_string x)
let of_rows rows = List (List.map (fun row -> List (List.map of_rational row)) rows)

(* Integers over one denominator. *)
let integer_rows place nrows ncols value =
  List.map (fun row -> List.map (integer place) (items ~length:ncols place row)) (items ~length:nrows place value)
let denominator place value = integer ~least:1 place value
let matrix place nrows ncols value =
  match fields place [ "denominator"; "entries" ] value with
  | [ d; entries ] -> (denominator place d, integer_rows place nrows ncols entries)
  | _ -> assert false

let rec increasing = function a :: (b :: _ as rest) -> a < b && increasing rest | _ -> true

let positions place below value =
  let l = List.map (small place) (items place value) in
  if increasing l && List.for_all (fun x -> x < below) l then l else malformed place "expected increasing positions"

(* The positions of named channels, in the order of the system. *)
let names place known value =
  let index name =
    let rec go i = function [] -> malformed place "expected the name of a channel" | each :: rest -> if each = name then i else go (i + 1) rest in
    go 0 known in
  let l = List.map (fun each -> index (string place each)) (items place value) in
  if increasing l then l else malformed place "expected names in the order of the system"
