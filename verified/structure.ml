(* From the witnesses of the kinds about structure to those of the kernel.  Not trusted: the kernel refuses what does not
   prove the claim.  The form is checked all the same, so that what the checker in Python calls MALFORMED is so here. *)
open Refused
open Witness

let zero v = Array.for_all (fun x -> Z.sign x = 0) v

(* Vectors modulo l, of which those are kept that are independent of the ones before; at most so many. *)
type basis = { l : Z.t; mutable rows : (int * Z.t array) list; mutable kept : Z.t array list }

let add basis v =
  let v' = Array.copy v in
  List.iter (fun (p, row) ->
      let c = v'.(p) in
      if Z.sign c <> 0 then Array.iteri (fun k x -> if Z.sign x <> 0 then v'.(k) <- Z.erem (Z.sub v'.(k) (Z.mul c x)) basis.l) row)
    (List.rev basis.rows);
  if zero v' then false
  else begin
    let p = ref 0 in
    while Z.sign v'.(!p) = 0 do incr p done;
    let i = Modular.inverse basis.l v'.(!p) in
    basis.rows <- (!p, Array.map (fun x -> Z.erem (Z.mul i x) basis.l) v') :: basis.rows;
    basis.kept <- v :: basis.kept;
    true
  end

(* Rows X, of `width` numbers, with X v_k the k-th unit vector modulo l for the vectors that were kept. *)
let dual_rows basis width =
  let places = Array.of_list (List.rev_map fst basis.rows) and kept = Array.of_list (List.rev basis.kept) in
  let r = Array.length kept in
  let inverse = Modular.inverted basis.l (Array.init r (fun k -> Array.init r (fun t -> kept.(t).(places.(k))))) in
  List.init r (fun i ->
      let row = Array.make width Z.zero in
      Array.iteri (fun k p -> row.(p) <- inverse.(i).(k)) places;
      Array.to_list row)

let scaled l i rows = List.map (fun row -> Array.of_list (List.map (fun x -> Z.erem (Z.mul i x) l) row)) rows
let sparse row = List.filter (fun (_, x) -> Z.sign x <> 0) (List.mapi (fun j x -> (j, x)) (Array.to_list row))
let column rows u = Array.of_list (List.map (fun row -> row.(u)) rows)

(* `controllability`: from below. *)
let krylov (given : Kernel.zsystem) chosen l d =
  (* What is measured is not used, so that l may divide its denominators. *)
  let common = List.fold_left (List.fold_left Z.gcd) in
  let used = List.concat (List.map2 (fun b (ch : Kernel.zchannel) -> if b then ch.Kernel.zB else []) chosen given.Kernel.zchannels) in
  let v_lower = common (common given.Kernel.zD given.Kernel.zA) used in
  let s = Kernel.zlower v_lower given in
  let i = Modular.inverse l s.Kernel.zD in
  let a = Array.of_list (List.map sparse (scaled l i s.Kernel.zA)) in
  let times v = Array.map (fun row -> Z.erem (List.fold_left (fun acc (j, x) -> Z.add acc (Z.mul x v.(j))) Z.zero row) l) a in
  let basis = { l; rows = []; kept = [] } and sources = ref [] and count = ref 0 in
  let offer source v =
    if !count < d && add basis v then begin sources := source :: !sources; incr count; Some (!count - 1, v) end else None in
  let inputs = List.concat (List.mapi (fun k (ch : Kernel.zchannel) ->
      if List.nth chosen k then
        let rows = scaled l i ch.Kernel.zB in
        List.init ch.Kernel.zp (fun u -> (Kernel.FromInput (k, u), column rows u))
      else []) s.Kernel.zchannels) in
  let rec go = function
    | [] -> ()
    | fresh -> go (List.filter_map (fun (k, v) -> offer (Kernel.FromEarlier k) (times v)) fresh) in
  go (List.filter_map (fun (source, v) -> offer source v) inputs);
  { Kernel.v_lower; v_ell = l; v_inv = i; v_sources = List.rev !sources; v_X = dual_rows basis s.Kernel.zn }

(* The same by blocks of the system of some channels, with outputs that are those of the channels or given states. *)
let by_blocks (s : Kernel.zsystem) known chosen parts measured =
  let n = s.Kernel.zn in
  let within = List.filteri (fun k _ -> List.nth chosen k) s.Kernel.zchannels in
  let outs = match measured with
    | Json.Null -> List.map (fun (ch : Kernel.zchannel) -> (ch.Kernel.zq, ch.Kernel.zC)) within
    | _ ->
      List.map (fun places ->
          let places = Json.positions "witness.measured" n places in
          (List.length places, List.map (fun b -> List.init n (fun k -> if k = b then s.Kernel.zD else Z.zero)) places))
        (Json.items ~length:(List.length within) "witness.measured" measured) in
  let run = { rules = []; count = 0 } in
  ignore (read_blocks run (Kernel.ztogether s chosen outs) (List.filteri (fun k _ -> List.nth chosen k) known) "witness.blocks" parts);
  Kernel.ByFacts (outs, List.rev run.rules)

let controllability (s : Kernel.zsystem) known (claim : Kernel.zreach) value =
  let n = s.Kernel.zn and chosen = claim.Kernel.r_T in
  let keys = match value with Json.Object l when List.mem_assoc "blocks" l -> [ "blocks"; "measured" ] | _ -> [ "modulus" ] in
  let parts = Json.fields "witness" (keys @ [ "annihilator"; "pivots" ]) value in
  let rows, pivots = match List.rev parts with pivots :: rows :: _ -> (rows, Json.positions "witness.pivots" n pivots) | _ -> assert false in
  let den, w = Json.matrix "witness.annihilator" (List.length pivots) n rows in
  if List.length pivots <> n - claim.Kernel.r_dim then invalid "witness.pivots" "expected another number of them";
  let z = Kernel.zpick pivots (Kernel.zmm w s.Kernel.zA) in
  let f, spectrum = Modular.spectrum (Z.mul den s.Kernel.zD) z in
  let annihilator = { Kernel.a_den = den; a_W = w; a_pivots = pivots; a_f = f; a_spectrum = spectrum } in
  let below = match parts with
    | [ number; _; _ ] -> Kernel.ByRank (krylov s chosen (modulus "witness.modulus" number) claim.Kernel.r_dim)
    | [ blocks; measured; _; _ ] -> by_blocks s known chosen blocks measured
    | _ -> assert false in
  (annihilator, below)

(* Edges j -> i with a power each: for each j and each power the channels i. *)
let targets (s : Kernel.zsystem) given triples =
  let m = List.length s.Kernel.zchannels in
  (* Without edges no number is taken modulo l. *)
  let l = if triples = [] then Z.nextprime (Z.add s.Kernel.zD Z.one) else given in
  let most = Array.make m (-1) in
  List.iter (fun (j, _, k) ->
      if k >= s.Kernel.zn then invalid "witness" "a power is not below the number of states";
      most.(j) <- max most.(j) k) triples;
  let table = Array.map (fun top -> Array.make (top + 1) []) most in
  List.iter (fun (j, i, k) -> table.(j).(k) <- i :: table.(j).(k)) triples;
  { Kernel.e_ell = l; e_inv = Modular.inverse l s.Kernel.zD; e_targets = Array.to_list (Array.map Array.to_list table) }

(* The states on which the inputs of some channels act, directly and through A. *)
let held (s : Kernel.zsystem) =
  let n = s.Kernel.zn in
  let driven = Array.make n [] in
  List.iteri (fun a row -> List.iteri (fun b x -> if Z.sign x <> 0 then driven.(b) <- a :: driven.(b)) row) s.Kernel.zA;
  fun sources ->
    let found = Array.make n false in
    let rec follow = function
      | [] -> ()
      | a :: rest -> if found.(a) then follow rest else begin found.(a) <- true; follow (List.rev_append driven.(a) rest) end in
    List.iter (fun j ->
        List.iteri (fun a row -> if nonzero row then follow [ a ]) (List.nth s.Kernel.zchannels j).Kernel.zB) sources;
    Array.to_list found

let read_zero (s : Kernel.zsystem) known place value =
  match Json.fields place [ "from"; "X"; "pivots" ] value with
  | [ sources; x; pivots ] ->
    let sources = Json.names place known sources and pivots = Json.positions place s.Kernel.zn pivots in
    let den, x = Json.matrix place s.Kernel.zn (List.length pivots) x in
    { Kernel.z_from = mask (List.length known) sources; z_den = den; z_X = x; z_pivots = pivots }
  | _ -> assert false

(* Paths within parts to and from the first channel of each. *)
let paths m joined part =
  let first = Array.make (m + 1) (-1) in
  for j = m - 1 downto 0 do first.(part.(j)) <- j done;
  let search step =
    let next = Array.make m 0 and far = Array.make m 0 and known = Array.make m false in
    let rec go = function
      | [] -> ()
      | level ->
        go (List.concat_map (fun j ->
            List.filter (fun i ->
                let fresh = step i j && part.(i) = part.(j) && not known.(i) in
                if fresh then begin known.(i) <- true; next.(i) <- j; far.(i) <- far.(j) + 1 end;
                fresh) (range m)) level) in
    let roots = List.filter (fun j -> first.(part.(j)) = j) (range m) in
    List.iter (fun j -> known.(j) <- true) roots;
    go roots;
    (Array.to_list next, Array.to_list far) in
  let next, far = search (fun i j -> joined.(i).(j)) and before, deep = search (fun i j -> joined.(j).(i)) in
  { Kernel.q_roots = List.map (max 0) (Array.to_list first); q_next = next; q_far = far; q_before = before; q_deep = deep }

let edge_table m edges = let t = Array.make_matrix m m false in List.iter (fun (j, i) -> t.(j).(i) <- true) edges; t

(* The place of each part in an order in which no edge leads back. *)
let in_order m joined part many =
  let seen = Array.make many false and order = ref [] in
  let rec visit k =
    if not seen.(k) then begin
      seen.(k) <- true;
      for j = 0 to m - 1 do
        if part.(j) = k then for i = 0 to m - 1 do if joined.(j).(i) && part.(i) <> k then visit part.(i) done
      done;
      order := k :: !order
    end in
  for k = 0 to many - 1 do visit k done;
  let places = Array.make many 0 in
  List.iteri (fun at k -> places.(k) <- at) !order;
  Array.to_list places

let transfer_graph (s : Kernel.zsystem) known (said : Claim.graph) (claim : Kernel.zgraph) value =
  match Json.fields "witness" [ "modulus"; "powers"; "zeros" ] value with
  | [ number; powers; zeros ] ->
    let m = List.length known and l = modulus "witness.modulus" number in
    let powers = List.map (Json.small "witness.powers") (Json.items ~length:(List.length said.Claim.arcs) "witness.powers" powers) in
    let arcs = targets s l (List.map2 (fun (j, i) k -> (j, i, k)) said.Claim.arcs powers) in
    let zeros = List.map (read_zero s known "witness.zeros") (Json.items "witness.zeros" zeros) in
    let joined = edge_table m said.Claim.arcs and part = Array.of_list claim.Kernel.g_parts in
    let follow = held s in
    { Kernel.t_arcs = arcs; t_held = List.init m (fun j -> if Array.for_all Fun.id joined.(j) then [] else follow [ j ]); t_zeros = zeros;
      t_parts = paths m joined part; t_order = in_order m joined part (List.length said.Claim.parts) }
  | _ -> assert false

let read_triples known value =
  let triple each = match Json.items ~length:3 "witness.arcs" each with
    | [ j; i; k ] -> let j, i = Claim.read_arc "witness.arcs" known (Json.List [ j; i ]) in (j, i, Json.small "witness.arcs" k)
    | _ -> assert false in
  let triples = List.map triple (Json.items "witness.arcs" value) in
  if not (Json.increasing (List.map (fun (j, i, _) -> (j, i)) triples)) then malformed "witness.arcs" "expected them sorted, none twice";
  triples

let completeness (s : Kernel.zsystem) known holds value =
  let m = List.length known and has key = match value with Json.Object l -> List.mem_assoc key l | _ -> false in
  let run = { rules = []; count = 0 } in
  let rules () = List.rev run.rules in
  if holds then begin
    let number, proof, arcs = match Json.fields "witness" [ "modulus"; (if has "blocks" then "blocks" else "gains"); "arcs" ] value with
      | [ number; proof; arcs ] -> (modulus "witness.modulus" number, proof, arcs) | _ -> assert false in
    if has "blocks" then ignore (read_blocks run s known "witness.blocks" proof)
    else begin
      let all = List.map (fun _ -> true) s.Kernel.zchannels in
      ignore (Witness.add run (Kernel.RTwo ([], two s number (gains "witness.gains" number s.Kernel.zchannels all proof))))
    end;
    let triples = read_triples known arcs in
    let joined = edge_table m (List.map (fun (j, i, _) -> (j, i)) triples) in
    Kernel.IsComplete (rules (), targets s number triples, paths m joined (Array.make m 0))
  end
  else if has "zero" then
    (match Json.fields "witness" [ "zero" ] value with [ zero ] -> Kernel.ByZero (read_zero s known "witness.zero" zero) | _ -> assert false)
  else if has "from" then
    (match Json.fields "witness" [ "from" ] value with
     | [ sources ] -> let sources = Json.names "witness.from" known sources in Kernel.ByCut (mask m sources, held s sources)
     | _ -> assert false)
  else
    (match Json.fields "witness" [ "polynomial"; "subspace" ] value with
     | [ p; space ] ->
       let p = Claim.integers (Claim.read_polynomial "witness.polynomial" 1 p) in
       ignore (Witness.add run (loss s known p 1 "witness.subspace" space));
       Kernel.ByMode (rules ())
     | _ -> assert false)

(* `setpoint`.  The columns of [a A + b, B; C, 0] modulo l, and which they are. *)
let steady_columns (s : Kernel.zsystem) l a b =
  let n = s.Kernel.zn and i = Modular.inverse l s.Kernel.zD in
  let states = scaled l i s.Kernel.zA in
  let outputs = List.map (fun (ch : Kernel.zchannel) -> scaled l i ch.Kernel.zC) s.Kernel.zchannels in
  let many = List.fold_left (fun t (ch : Kernel.zchannel) -> t + ch.Kernel.zq) 0 s.Kernel.zchannels in
  let state c =
    let top = Array.mapi (fun r x -> Z.erem (Z.add (Z.mul a x) (if r = c then b else Z.zero)) l) (column states c) in
    (Kernel.OfState c, Array.concat (top :: List.map (fun rows -> column rows c) outputs)) in
  let inputs = List.mapi (fun k (ch : Kernel.zchannel) ->
      let rows = scaled l i ch.Kernel.zB in
      List.init ch.Kernel.zp (fun u -> (Kernel.OfPort (k, u), Array.append (column rows u) (Array.make many Z.zero)))) s.Kernel.zchannels in
  (i, n + many, List.init n state @ List.concat inputs)

(* A row of n + sum q_i numbers in its parts. *)
let rec taken k = function rest when k = 0 -> ([], rest) | [] -> ([], []) | x :: rest -> let a, b = taken (k - 1) rest in (x :: a, b)
let split (s : Kernel.zsystem) rows =
  let first = List.map (fun row -> fst (taken s.Kernel.zn row)) rows and rest = List.map (fun row -> snd (taken s.Kernel.zn row)) rows in
  let _, parts = List.fold_left (fun (rest, parts) (ch : Kernel.zchannel) ->
      (List.map (fun row -> snd (taken ch.Kernel.zq row)) rest, List.map (fun row -> fst (taken ch.Kernel.zq row)) rest :: parts))
      (rest, []) s.Kernel.zchannels in
  (first, List.rev parts)

let below (s : Kernel.zsystem) l a b r place =
  let i, width, columns = steady_columns s l a b in
  let basis = { l; rows = []; kept = [] } and places = ref [] and count = ref 0 in
  List.iter (fun (place, v) -> if !count < r && add basis v then begin places := place :: !places; incr count end) columns;
  if !count < r then invalid place "not reached modulo l";
  let first, rest = split s (dual_rows basis width) in
  { Kernel.w_l = l; w_i = i; w_X1 = first; w_X2 = rest; w_columns = List.rev !places }

let nothing_below = { Kernel.w_l = Z.zero; w_i = Z.zero; w_X1 = []; w_X2 = []; w_columns = [] }

let setpoint (s : Kernel.zsystem) discrete (claim : Kernel.zsetpoint) value =
  match Json.fields "witness" [ "modulus"; "left"; "pivots"; "point"; "normal" ] value with
  | [ number; left; pivots; point; normal ] ->
    let many = List.fold_left (fun t (ch : Kernel.zchannel) -> t + ch.Kernel.zq) 0 s.Kernel.zchannels in
    let rows = s.Kernel.zn + many and r = claim.Kernel.p_rank and l = modulus "witness.modulus" number in
    if r > rows then invalid "claim.rank" "not reached modulo l";
    let pivots = Json.positions "witness.pivots" rows pivots in
    if List.length pivots <> rows - r then invalid "witness.pivots" "expected another number of them";
    let den, w = Json.matrix "witness.left" (rows - r) rows left in
    let w1, w2 = split s w in
    (* Which part of a row a position is in. *)
    let rec port at k = function
      | (ch : Kernel.zchannel) :: rest -> if at < ch.Kernel.zq then Kernel.OfPort (k, at) else port (at - ch.Kernel.zq) (k + 1) rest
      | [] -> assert false in
    let part at = if at < s.Kernel.zn then Kernel.OfState at else port (at - s.Kernel.zn) 0 s.Kernel.zchannels in
    let above = { Kernel.x_den = den; x_W1 = w1; x_W2 = w2; x_places = List.map part pivots } in
    let steady = below s l Z.one (if discrete then Z.minus_one else Z.zero) r "claim.rank" in
    let none place value = if value <> Json.Null then invalid place "expected null" in
    let sp_point, sp_full, sp_row = match claim.Kernel.p_zero with
      | None -> none "witness.point" point; none "witness.normal" normal; (Z.zero, nothing_below, [])
      | Some true ->
        none "witness.normal" normal;
        let x = Json.integer ~least:0 "witness.point" point in
        (x, below s l Z.minus_one x rows "witness.point", [])
      | Some false ->
        none "witness.point" point;
        let _, layers = layers "witness.normal" 1 rows (rows + 1) normal in
        (Z.zero, nothing_below, List.map (split s) layers) in
    { Kernel.sp_below = steady; sp_above = above; sp_point; sp_full; sp_row }
  | _ -> assert false

(* The matrix of the plant or of the loop, over one denominator. *)
let loop_matrix (s : Kernel.zsystem) = function
  | Some c -> (Kernel.zclosed_den s c.Controller.listed, Kernel.zclosed s c.Controller.listed)
  | None -> (s.Kernel.zD, s.Kernel.zA)

(* The polynomial p of a claim as that of the matrix, times the denominators of its rows, by the moduli of the witness. *)
let spectrum d rows p value =
  let place = "witness.moduli" in
  let moduli = match Json.fields "witness" [ "moduli" ] value with
    | [ l ] -> List.map (Json.integer ~least:2 place) (Json.items place l) | _ -> assert false in
  ignore (List.fold_left (fun product l ->
      if not (Z.equal (Z.gcd product l) Z.one) then invalid place "not coprime to those before it";
      Z.mul product l) Z.one moduli);
  if List.length p <> List.length rows + 1 then invalid "claim.polynomial" "expected another degree";
  let ds, scaled = Modular.rows_of d rows in
  let scale = List.fold_left Z.mul Z.one ds in
  if List.exists (fun l -> not (Z.equal (Z.gcd scale l) Z.one)) moduli then invalid place "divides a denominator";
  let f = List.map (fun c -> Q.mul (Q.of_bigint scale) c) p in
  if List.exists (fun c -> not (Z.equal (Q.den c) Z.one)) f then invalid "claim.polynomial" "a coefficient that no matrix with these rows has";
  (List.map Q.num f, { Kernel.s_ds = ds; s_N = scaled; s_moduli = Modular.residues d rows scale moduli })

let require_by_polynomial value =
  let keys = match value with Json.Object l -> l | _ -> malformed "witness.method" "expected a method" in
  match List.assoc_opt "method" keys with
  | Some (Json.String "polynomial") -> ignore (Json.fields "witness" [ "method" ] value)
  | Some (Json.String ("lyapunov" | "instability")) -> incomplete "witness.method" "quadratic forms are not verified here"
  | _ -> malformed "witness.method" "expected a method"
