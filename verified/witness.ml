(* From the witness of a certificate to the rules of a run.  Not trusted: the kernel refuses what does not prove the
   claim.  The form is checked all the same, so that what the checker in Python calls MALFORMED is so here. *)
open Refused

let layers place nrows ncols degree value =
  match Json.fields place [ "denominator"; "coefficients" ] value with
  | [ d; l ] ->
    let l = List.map (Json.integer_rows place nrows ncols) (Json.items place l) in
    if l = [] || List.length l > degree then malformed place "expected from 1 matrix to the degree of p";
    (Json.denominator place d, l)
  | _ -> assert false

let modulus place value =
  let l = Json.integer place value in
  if Z.lt l (Z.of_int 2) then invalid place "expected an integer from 2 on" else l

let residue_list place l value =
  List.map (fun x -> Z.erem (Json.integer ~least:0 place x) l) (Json.items place value)

let nonzero = List.exists (fun x -> Z.sign x <> 0)
let columns places row = let row = Array.of_list row in List.map (fun j -> row.(j)) places
let picked places rows = let rows = Array.of_list rows in List.map (fun i -> rows.(i)) places
let range n = List.init n Fun.id
let mask n places = let m = Array.make n false in List.iter (fun i -> m.(i) <- true) places; Array.to_list m

(* What a run consists of so far: rules, last one first. *)
type run = { mutable rules : Kernel.rule list; mutable count : int }

let add run rule =
  run.rules <- rule :: run.rules;
  run.count <- run.count + 1;
  run.count - 1

let residues_over l (d, rows) = let i = Modular.inverse l d in List.map (List.map (fun x -> Z.erem (Z.mul i x) l)) rows

(* One matrix for each of some channels; no rows for the others. *)
let gains place l (channels : Kernel.zchannel list) acting value =
  let given = Json.items ~length:(List.length (List.filter Fun.id acting)) place value in
  let rec go channels acting given = match channels, acting, given with
    | ch :: channels, true :: acting, g :: given ->
      residues_over l (Json.matrix place ch.Kernel.zp ch.Kernel.zq g) :: go channels acting given
    | _ :: channels, false :: acting, given -> [] :: go channels acting given
    | _ -> [] in
  go channels acting given

let loop l d gains similar = { Kernel.w_ell = l; w_inv = Modular.inverse l d; w_gains = gains; w_similar = similar }
let nothing = { Kernel.h_H = []; h_L = []; h_order = [] }

(* A loop with the polynomial of its matrix modulo l. *)
let with_polynomial (s : Kernel.zsystem) l gains =
  let w = loop l s.Kernel.zD gains nothing in
  let similar = Modular.hessenberg l (Kernel.loop_residues s w) in
  ({ w with Kernel.w_similar = similar }, Modular.characteristic l s.Kernel.zn similar)

let two (s : Kernel.zsystem) l gains =
  let w, p = with_polynomial s l gains in
  let similar = Modular.hessenberg l (List.map (List.map (fun x -> Z.erem (Z.mul w.Kernel.w_inv x) l)) s.Kernel.zA) in
  let u, v = Modular.bezout l (Modular.characteristic l s.Kernel.zn similar) p in
  { Kernel.tw_loop = w; tw_similar = similar; tw_u = u; tw_v = v }

(* For each block the channels that act within it. *)
let acting_block blocks (ch : Kernel.zchannel) =
  let last = ref (-1) and first = ref max_int in
  List.iteri (fun a row -> if nonzero row then last := max !last blocks.(a)) ch.Kernel.zB;
  List.iter (List.iteri (fun b x -> if Z.sign x <> 0 then first := min !first blocks.(b))) ch.Kernel.zC;
  if !last = !first then !last else -1

let read_blocks run (s : Kernel.zsystem) known place value =
  let n = s.Kernel.zn in
  let parts = List.map (fun each -> match Json.fields place [ "states"; "evidence" ] each with
      | [ states; evidence ] -> (Json.positions place n states, evidence) | _ -> assert false) (Json.items place value) in
  let blocks = Array.make n (-1) in
  List.iteri (fun k (states, _) -> List.iter (fun a -> if blocks.(a) >= 0 then invalid place "expected every state in one block"; blocks.(a) <- k) states) parts;
  if Array.exists (fun k -> k < 0) blocks then invalid place "expected every state in one block";
  let blk = Array.to_list blocks in
  let within = List.map (acting_block blocks) s.Kernel.zchannels in
  let fact k (_, evidence) =
    let subject = [ List.map (fun b -> b = k) blk ] in
    let acting = List.map (fun w -> w = k) within in
    match evidence with
    | Json.Null -> add run (Kernel.RNothing subject)
    | Json.Object l when List.mem_assoc "channel" l ->
      (match Json.fields place [ "modulus"; "gains"; "channel"; "inputs"; "outputs"; "recurrence"; "cofactors" ] evidence with
       | [ number; given; name; x; y; d; cofactors ] ->
         let l = modulus place number in
         let k_F = gains place l s.Kernel.zchannels acting given in
         let channel = match Json.names place known (Json.List [ name ]) with [ i ] -> i | _ -> assert false in
         if not (List.nth acting channel) then malformed place "expected a channel of the block";
         let x = residue_list place l x and y = residue_list place l y and d = residue_list place l d in
         let a, e = match Json.items ~length:2 place cofactors with [ a; e ] -> (residue_list place l a, residue_list place l e) | _ -> assert false in
         let ch = List.nth s.Kernel.zchannels channel in
         if List.length x <> ch.Kernel.zp || List.length y <> ch.Kernel.zq then malformed place "expected one number for each input and output";
         add run (Kernel.RKrylov (subject, { Kernel.k_ell = l; k_inv = Modular.inverse l s.Kernel.zD; k_F; k_channel = channel;
                                             k_x = x; k_y = y; k_d = d; k_a = a; k_e = e }))
       | _ -> assert false)
    | _ ->
      (match Json.fields place [ "gains"; "modulus" ] evidence with
       | [ given; number ] ->
         let l = modulus place number in
         let gains = gains place l s.Kernel.zchannels acting given in
         add run (Kernel.RTwo (subject, two (Kernel.zpart s (List.hd subject)) l gains))
       | _ -> assert false) in
  let facts = List.mapi fact parts in
  add run (Kernel.RBlocks ([], blk, facts))

(* B_T = Y X for the channels T, X over one denominator, in parts for each channel. *)
let factor (channels : Kernel.zchannel list) chosen n =
  let within = List.filteri (fun i _ -> List.mem i chosen) channels in
  let total = List.fold_left (fun acc ch -> acc + ch.Kernel.zp) 0 within in
  let whole = List.init n (fun i -> List.concat_map (fun ch -> List.nth ch.Kernel.zB i) within) in
  let y, x = Modular.factorize whole total in
  let d = Plant.common_denominator x in
  let x = Array.of_list (List.map Array.of_list (Plant.times d x)) and at = ref 0 in
  let parts = List.mapi (fun i ch ->
      if List.mem i chosen then begin
        let start = !at in
        at := start + ch.Kernel.zp;
        Array.to_list (Array.map (fun row -> Array.to_list (Array.sub row start ch.Kernel.zp)) x)
      end else []) channels in
  (y, d, parts, Array.to_list (Array.map Array.to_list x), total)

let scale_rows k = List.map (List.map (Z.mul k))

(* A shrunk subspace of a system of so many states with these channels out of m, the places of which are `acting`. *)
let shrunk m acting size (channels : Kernel.zchannel list) known p place value =
  (match value with
   | Json.Object l when List.mem_assoc "states" l || List.mem_assoc "dual" l -> malformed place "expected a shrunk subspace"
   | _ -> ());
  match Json.fields place [ "channels_T"; "U"; "V"; "pivots" ] value with
  | [ t; u; v; pivots ] ->
    let degree = List.length p - 1 in
    let t = Json.names place known t and pivots = Json.positions place size pivots in
    let y, dX, parts, x, total = factor channels t size in
    let width = List.length pivots in
    let du, us = layers place size width degree u in
    let dv, vs = layers place total width degree v in
    let common = Z.lcm du dv in
    let us = List.map (scale_rows (Z.mul dX (Z.divexact common du))) us in
    let vs = List.map (fun v -> Kernel.zmm x (scale_rows (Z.divexact common dv) v)) vs in
    let xs = Array.make m [] in
    List.iter2 (fun i part -> xs.(i) <- part) acting parts;
    { Kernel.b_T = mask m (picked t acting); b_U = us; b_V = vs; b_den = Z.mul common dX; b_pivots = pivots;
      b_rank = (match y with row :: _ -> List.length row | [] -> 0); b_Y = y; b_X = Array.to_list xs; b_dX = dX }
  | _ -> assert false

(* A shrunk subspace, or one of the dual system: which, and its witness.  `turn` is the dual. *)
let turned_or_not (s : Kernel.zsystem) acting known p place value =
  let m = List.length s.Kernel.zchannels in
  let read (s : Kernel.zsystem) value = shrunk m acting s.Kernel.zn (picked acting s.Kernel.zchannels) (picked acting known) p place value in
  match value with
  | Json.Object l when List.mem_assoc "dual" l ->
    (match Json.fields place [ "channels_T"; "dual" ] value with
     | [ t; inner ] ->
       let w = read (Kernel.zdual s) inner in
       let others = List.filter (fun i -> not (List.nth w.Kernel.b_T i)) acting in
       if picked (Json.names place (picked acting known) t) acting <> others then invalid place "T is not the complement of that of the dual system";
       (true, others, w)
     | _ -> assert false)
  | _ -> let w = read s value in (false, List.filter (fun i -> List.nth w.Kernel.b_T i) acting, w)

(* The states that some drive, and the channels that see these or those. *)
let followed (s : Kernel.zsystem) states =
  let n = s.Kernel.zn and m = List.length s.Kernel.zchannels in
  let driven = Array.make n [] in
  List.iteri (fun a row -> List.iteri (fun b x -> if Z.sign x <> 0 then driven.(b) <- a :: driven.(b)) row) s.Kernel.zA;
  let entered = Array.of_list (List.map (fun (ch : Kernel.zchannel) ->
      List.concat (List.mapi (fun a row -> if nonzero row then [ a ] else []) ch.Kernel.zB)) s.Kernel.zchannels) in
  let heard = Array.make n [] in
  List.iteri (fun i (ch : Kernel.zchannel) -> List.iter (List.iteri (fun b x ->
      if Z.sign x <> 0 && not (List.mem i heard.(b)) then heard.(b) <- i :: heard.(b))) ch.Kernel.zC) s.Kernel.zchannels;
  let found = Array.make n false and seeing = Array.make m false in
  List.iter (fun a -> found.(a) <- true) states;
  let rec follow = function
    | [] -> ()
    | b :: rest ->
      let fresh = List.filter (fun i -> not seeing.(i)) heard.(b) in
      List.iter (fun i -> seeing.(i) <- true) fresh;
      let next = List.sort_uniq compare (List.filter (fun a -> not found.(a)) (driven.(b) @ List.concat_map (fun i -> entered.(i)) fresh)) in
      List.iter (fun a -> found.(a) <- true) next;
      follow (next @ rest) in
  follow states;
  (found, seeing, entered)

(* The loss of rank of a pencil as a rule. *)
let loss (s : Kernel.zsystem) known p d place value =
  let n = s.Kernel.zn and m = List.length known in
  match value with
  | Json.Object l when List.mem_assoc "states" l ->
    (match Json.fields place [ "states"; "channels_T"; "subspace" ] value with
     | [ states; t; subspace ] ->
       let states = Json.positions place n states in
       let found, seeing, entered = followed s states in
       let inside = Array.of_list (mask n states) in
       let acting = List.filter (fun i -> seeing.(i) && List.exists (fun a -> inside.(a)) entered.(i)) (range m) in
       let turned, within, w = turned_or_not (Kernel.zpart s (Array.to_list inside)) acting known p place subspace in
       let chosen = List.filter (fun i -> seeing.(i) && (not (List.mem i acting) || List.mem i within)) (range m) in
       if Json.names place known t <> chosen then invalid place "T is not the channels that see what the states drive";
       let chosen = mask m chosen and driven = List.map2 (fun f i -> f && not i) (Array.to_list found) (Array.to_list inside) in
       let states = Array.to_list inside in
       if turned then Kernel.RLocalDual ([], states, driven, p, { w with Kernel.b_T = List.map not chosen }, d)
       else Kernel.RLocal ([], states, driven, p, { w with Kernel.b_T = chosen }, d)
     | _ -> assert false)
  | _ ->
    (match turned_or_not s (range m) known p place value with
     | true, _, w -> Kernel.RDual ([], p, w, d)
     | false, _, w -> Kernel.RShrunk ([], p, w, d))

(* Polynomials over Q. *)
let rational p = List.map Q.of_bigint p
let rec trim_q v = match List.rev v with x :: rest when Q.sign x = 0 -> trim_q (List.rev rest) | _ -> v

let divide_q a b =
  let b = trim_q b in
  let lead = List.nth b (List.length b - 1) in
  let rec go q a =
    if List.length a < List.length b then (q, a)
    else
      let k = Q.div (List.nth a (List.length a - 1)) lead and s = List.length a - List.length b in
      let shifted = List.init s (fun _ -> Q.zero) @ List.map (Q.mul k) b in
      let q = List.mapi (fun i x -> if i = s then k else x) (q @ List.init (max 0 (s + 1 - List.length q)) (fun _ -> Q.zero)) in
      go q (trim_q (List.map2 Q.sub a shifted)) in
  go [] (trim_q a)

(* The exponent of p: f = p^a w, and w = q p + r. *)
let exponent f p a =
  let rec go w k = if k = 0 then Some w else match divide_q w (rational p) with w, [] -> go w (k - 1) | _ -> None in
  match go (rational f) a with
  | None -> invalid "claim.factors" "not the multiplicity in A"
  | Some w ->
    let q, r = divide_q w (rational p) in
    let d = List.fold_left (fun d x -> Z.lcm d (Q.den x)) Z.one (w @ q @ r) in
    let up = List.map (fun x -> Z.divexact (Z.mul d (Q.num x)) (Q.den x)) in
    let w' = up w in
    { Kernel.x_w = w'; x_q = up q; x_r = up r; x_k = Z.one }

let no_exponent = { Kernel.x_w = []; x_q = []; x_r = []; x_k = Z.zero }
let derivative p = match p with [] -> [] | _ :: rest -> List.mapi (fun i c -> Z.mul (Z.of_int (i + 1)) c) rest

let coprime run l p q =
  let u, v = Modular.bezout l p q in
  add run (Kernel.RCoprime (p, q, { Kernel.z_ell = l; z_inv = Modular.inverse l (Modular.lead p); z_u = u; z_v = v }))

let rec product = function [] -> [ Z.one ] | f :: rest -> Kernel.zpmul f.Kernel.f_p (product rest)

(* That all fixed modes are roots of the factors, by a large l: psi is what is left of det(xI - A_F). *)
let large (s : Kernel.zsystem) l factors lg_loop lg_powers psi =
  let n = s.Kernel.zn and i = lg_loop.Kernel.w_inv in
  let similar = Modular.hessenberg l (List.map (List.map (fun x -> Z.erem (Z.mul i x) l)) s.Kernel.zA) in
  let u, v = Modular.bezout l psi (Modular.characteristic l n similar) in
  let common = List.fold_left (List.fold_left Z.gcd) s.Kernel.zD s.Kernel.zA in
  let d = Z.divexact s.Kernel.zD common in
  let rows = List.map (List.map (fun x -> Z.divexact x common)) s.Kernel.zA in
  let eighth = Kernel.zsquare (Kernel.zsquare (Kernel.zsquare rows)) in
  let most = List.fold_left Z.max Z.zero in
  let sums = Z.min (most (List.map Kernel.zabs_sum eighth)) (most (Kernel.zcolumn_sums eighth)) in
  let root x = if Z.sign x = 0 then x else Z.succ (Z.sqrt (Z.pred x)) in
  let f = Kernel.zexcess n factors in
  let scaled, _ = List.fold_right (fun x (h, power) ->
      let q, r = Z.div_rem (Z.mul power x) (Modular.lead f) in
      if Z.sign r <> 0 then invalid "witness.modulus" "a factor is not integral beside A";
      (q :: h, Z.mul power d)) f ([], Z.one) in
  { Kernel.lg_loop; lg_similar = similar; lg_powers; lg_psi = psi; lg_u = u; lg_v = v; lg_D = d; lg_N = rows;
    lg_r = root (root (root sums)); lg_H = scaled }

(* The rules that prove the claim of the kind `fixed_spectrum`. *)
let fixed_spectrum (s : Kernel.zsystem) known (claim : Kernel.zclaim) value =
  let run = { rules = []; count = 0 } in
  let factors = claim.Kernel.c_factors and n = s.Kernel.zn in
  let spectrum = lazy (let f, w = Modular.spectrum s.Kernel.zD s.Kernel.zA in (f, add run (Kernel.RSpectrum ([], f, w)))) in
  let blocks = match value with Json.Object l -> List.mem_assoc "blocks" l | _ -> false in
  let subspaces spaces = Json.items ~length:(List.length factors) "witness.subspaces" spaces in
  let premises ell separate simple bounds f rest space =
    let y_fixed = add run (loss s known f.Kernel.f_p (n - f.Kernel.f_rank) "witness.subspaces" space) in
    let y_coprime = if separate then coprime run ell f.Kernel.f_p (product rest) else 0 in
    let y_simple = if simple then coprime run ell f.Kernel.f_p (derivative f.Kernel.f_p) else 0 in
    let y_spectrum, y_exponent = match f.Kernel.f_in_A with
      | None -> (0, no_exponent)
      | Some a -> let g, k = Lazy.force spectrum in (k, exponent g f.Kernel.f_p a) in
    let y_most, y_low = bounds f in
    { Kernel.y_fixed; y_coprime; y_simple; y_most; y_low; y_spectrum; y_exponent } in
  let rec each ell separate simple bounds fs spaces = match fs, spaces with
    | f :: fs, space :: spaces -> let y = premises ell separate simple bounds f fs space in y :: each ell separate simple bounds fs spaces
    | _ -> [] in
  if blocks then begin
    match Json.fields "witness" [ "blocks"; "modulus"; "subspaces" ] value with
    | [ parts; number; spaces ] ->
      let spaces = subspaces spaces in
      let bounded = read_blocks run s known "witness.blocks" parts in
      if factors = [] && number <> Json.Null then invalid "witness.modulus" "expected null: no factors";
      let ell = if factors = [] then Z.of_int 2 else modulus "witness.modulus" number in
      let ys = each ell true true (fun _ -> (0, 0)) factors spaces in
      ignore (add run (Kernel.RAllBlocks ([], claim, bounded, ys)))
    | _ -> assert false
  end
  else begin
    match Json.fields "witness" [ "gains"; "modulus"; "subspaces"; "completion" ] value with
    | [ given; number; spaces; completion ] ->
      let ell = modulus "witness.modulus" number in
      let all = List.map (fun _ -> true) s.Kernel.zchannels in
      let gains = gains "witness.gains" ell s.Kernel.zchannels all given in
      let spaces = subspaces spaces in
      if factors = [] then begin
        if completion <> Json.Null then invalid "claim" "expected null for both";
        let bounded = add run (Kernel.RTwo ([], two s ell gains)) in
        ignore (add run (Kernel.RAllBlocks ([], claim, bounded, [])))
      end else begin
        let rho = List.fold_left (fun r f -> max r (n - f.Kernel.f_rank)) 0 factors in
        let b0, c0 = match Json.fields "witness.completion" [ "B0"; "C0" ] completion with
          | [ b; c ] -> (residues_over ell (Json.matrix "witness.completion.B0" n rho b), residues_over ell (Json.matrix "witness.completion.C0" rho n c))
          | _ -> assert false in
        let w, chi = with_polynomial s ell gains in
        let divided f polynomial k =
          let inv = Modular.inverse ell (Modular.lead f.Kernel.f_p) in
          let monic = List.map (fun x -> Z.erem (Z.mul inv x) ell) f.Kernel.f_p in
          let rec reduce q k = if k = 0 then q else
              match Modular.divide ell q monic with q, [] -> reduce q (k - 1) | _ -> invalid "claim.factors" "not the largest multiplicity" in
          (inv, monic, reduce polynomial k) in
        let power f =
          let inv, monic, rest = divided f chi f.Kernel.f_most in
          let q, r = Modular.divide ell rest monic in
          let rec first i = function [] -> (0, Z.zero) | x :: rest -> if Z.sign x <> 0 then (i, Modular.inverse ell x) else first (i + 1) rest in
          let pw_place, pw_unit = first 0 r in
          { Kernel.pw_inv = inv; pw_q = q; pw_r = r; pw_place; pw_unit } in
        let lows = Hashtbl.create 4 in
        (* One fact for all factors with the same rank. *)
        let low f =
          let d = n - f.Kernel.f_rank in
          if not (Hashtbl.mem lows d) then begin
            let p = product (List.filter (fun g -> g.Kernel.f_rank = f.Kernel.f_rank) factors) in
            let take k l = List.filteri (fun i _ -> i < k) l in
            let inv = Modular.inverse ell (Modular.lead p) in
            let start = { Kernel.lw_loop = w; lw_B0 = List.map (take d) b0; lw_C0 = take d c0; lw_inv = inv; lw_u = []; lw_v = [] } in
            let similar = Modular.hessenberg ell (Kernel.completed s start) in
            let u, v = Modular.bezout ell p (Modular.characteristic ell n similar) in
            Hashtbl.add lows d (add run (Kernel.RLow ([], p, d, { start with Kernel.lw_loop = { w with Kernel.w_similar = similar }; lw_u = u; lw_v = v })))
          end;
          Hashtbl.find lows d in
        let most f = add run (Kernel.RAtMost ([], f.Kernel.f_p, f.Kernel.f_most, { Kernel.pw_loop = w; pw_power = power f })) in
        let unsaid = List.filter (fun f -> f.Kernel.f_in_A = None) factors in
        if unsaid <> [] then begin
          if List.length unsaid < List.length factors then invalid "claim.factors" "expected multiplicities in A, or none";
          let lg_powers = List.map power factors in
          let psi = List.fold_left (fun f g -> let _, _, rest = divided g f g.Kernel.f_most in rest) chi factors in
          let ys = each ell true false (fun f -> (0, low f)) factors spaces in
          let witness = large s ell factors w lg_powers psi in
          ignore (add run (Kernel.RAllLarge ([], claim, witness, ys)))
        end else begin
        let bounds f = let most = most f in (most, low f) in
        let ys = each ell false false bounds factors spaces in
        let rec separate = function f :: rest -> ignore (Modular.bezout ell f.Kernel.f_p (product rest)); separate rest | [] -> () in
        separate factors;
        let f_A, place = Lazy.force spectrum in
        let powers = List.concat_map (fun f -> List.init (Option.value f.Kernel.f_in_A ~default:0) (fun _ -> f.Kernel.f_p)) factors in
        let rest = List.fold_left (fun g p -> match divide_q g (rational p) with g, [] -> g | _ -> invalid "claim.factors" "not the multiplicity in A") (rational f_A) powers in
        let d = List.fold_left (fun d x -> Z.lcm d (Q.den x)) Z.one rest in
        let g = List.map (fun x -> Z.divexact (Z.mul d (Q.num x)) (Q.den x)) rest in
        let common = List.fold_left Z.gcd Z.zero g in
        let g = List.map (fun x -> Z.divexact x common) g in
        let u, v = Modular.bezout ell g chi in
        let moved = add run (Kernel.RMoved ([], g, { Kernel.mv_loop = w; mv_inv = Modular.inverse ell (Modular.lead g); mv_u = u; mv_v = v })) in
        ignore (add run (Kernel.RAllTwo ([], claim, place, g, moved, ys)))
        end
      end
    | _ -> assert false
  end;
  List.rev run.rules
