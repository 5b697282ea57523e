(* Computations that prepare witnesses.  Not trusted: the kernel refuses what is wrong.  A number that has no inverse
   modulo l raises Division_by_zero. *)

let inverse l x = Z.invert (Z.erem x l) l
let reduce l v = List.map (fun x -> Z.erem x l) v

(* Polynomials modulo l, without zeros at the end. *)
let trim v =
  let rec go = function x :: rest when Z.sign x = 0 -> go rest | rest -> rest in
  List.rev (go (List.rev v))

let rec add u v = match u, v with [], w | w, [] -> w | x :: u, y :: v -> Z.add x y :: add u v
let scale k v = List.map (Z.mul k) v
let rec shift k v = if k = 0 then v else Z.zero :: shift (k - 1) v
let lead v = List.nth v (List.length v - 1)

(* Quotient and remainder; the last coefficient of b is a unit. *)
let divide l a b =
  let b = trim (reduce l b) in
  let i = inverse l (lead b) in
  let rec go q a =
    if List.length a < List.length b then (trim (reduce l q), a)
    else
      let k = Z.erem (Z.mul (lead a) i) l and s = List.length a - List.length b in
      go (add q (shift s [ k ])) (trim (reduce l (add a (shift s (scale (Z.neg k) b))))) in
  go [] (trim (reduce l a))

let multiply l a b = trim (reduce l (Kernel.zpmul a b))

(* u p + v q = 1 modulo l. *)
let bezout l p q =
  let rec euclid (a, ua, va) (b, ub, vb) =
    match b with
    | [] -> (match a with [ g ] -> let i = inverse l g in (reduce l (scale i ua), reduce l (scale i va)) | _ -> Refused.invalid "witness" "a common factor modulo l")
    | _ ->
      let q, r = divide l a b in
      let less u w = trim (reduce l (add u (scale Z.minus_one (multiply l q w)))) in
      euclid (b, ub, vb) (r, less ua ub, less va vb) in
  euclid (trim (reduce l p), [ Z.one ], []) (trim (reduce l q), [], [ Z.one ])

(* A L = L H modulo l with H zero below its first subdiagonal; row i of L is that of a unit lower triangular matrix at
   the place of i in `order`.  Modulo a number that is not prime every pivot has to be a unit, the last one too, as in the
   checker in Python, and column by column as there: a column is a few integers, in which sums of products have room.
   OCaml moves larger integers through its slow heap. *)
let short = 7680
let hessenberg l rows =
  let n = List.length rows in
  let width = Z.numbits (Z.mul (Z.of_int ((2 * n) + 1)) (Z.mul l l)) in
  let many = max 1 (short / width) in
  let parts = (n + many - 1) / many in
  let rec packed entry first last =
    if first >= last then Z.zero
    else if last - first = 1 then entry first
    else let middle = (first + last) / 2 in
      Z.add (packed entry first middle) (Z.shift_left (packed entry middle last) (width * (middle - first))) in
  let column entry = Array.init parts (fun b -> packed entry (b * many) (min n ((b + 1) * many))) in
  let digit x i = Z.extract x.(i / many) (i mod many * width) width in
  let plus u x first total =
    for b = first to parts - 1 do if Z.sign x.(b) <> 0 then total.(b) <- Z.add total.(b) (Z.mul u x.(b)) done in
  let exchange i j x =
    let change = Z.sub (digit x j) (digit x i) in
    let add k u = x.(k / many) <- Z.add x.(k / many) (Z.shift_left u (k mod many * width)) in
    add i change; add j (Z.neg change) in
  let swap m i j = let t = m.(i) in m.(i) <- m.(j); m.(j) <- t in
  let a = Array.of_list (List.map (fun row -> Array.of_list (reduce l row)) rows) in
  let columns = Array.init n (fun j -> column (fun i -> a.(i).(j))) and lower = Array.make n [||] in
  let order = Array.init n Fun.id and h = Array.make_matrix n n Z.zero in
  let current = ref (Array.init n (fun i -> if i = 0 then Z.one else Z.zero)) in
  for j = 0 to n - 1 do
    lower.(j) <- column (fun i -> if i > j then !current.(i) else Z.zero);
    let total = Array.make parts Z.zero in
    for i = j to n - 1 do if Z.sign !current.(i) <> 0 then plus !current.(i) columns.(i) 0 total done;
    for i = 0 to j do
      let x = Z.erem (digit total i) l in
      h.(i).(j) <- x;
      if Z.sign x <> 0 && i + 1 < n then plus (Z.sub l x) lower.(i) ((i + 1) / many) total
    done;
    if j + 1 < n then begin
      let rest = Array.init n (fun i -> if i > j then Z.erem (digit total i) l else Z.zero) and k = ref (j + 1) in
      while !k < n && Z.sign rest.(!k) = 0 do incr k done;
      if !k = n then k := j + 1;
      h.(j + 1).(j) <- rest.(!k);
      if !k > j + 1 then begin
        swap rest (j + 1) !k; swap columns (j + 1) !k; swap order (j + 1) !k;
        Array.iter (exchange (j + 1) !k) columns;
        for i = 0 to j do exchange (j + 1) !k lower.(i) done
      end;
      let f = if Z.sign rest.(j + 1) = 0 then Z.zero else inverse l rest.(j + 1) in
      current := Array.mapi (fun i x -> if i = j + 1 then Z.one else if i > j then Z.erem (Z.mul f x) l else Z.zero) rest
    end
  done;
  let left = Array.make n [] in
  Array.iteri (fun r place -> left.(place) <- List.init (r + 1) (fun c -> if c = r then Z.one else digit lower.(c) r)) order;
  { Kernel.h_H = Array.to_list (Array.map Array.to_list h); h_L = Array.to_list left; h_order = Array.to_list order }

(* The inverse of a square matrix modulo l, by pivots that are units. *)
let inverted l m =
  let n = Array.length m in
  let a = Array.mapi (fun i row -> Array.append (Array.map (fun x -> Z.erem x l) row) (Array.init n (fun j -> if i = j then Z.one else Z.zero))) m in
  for k = 0 to n - 1 do
    let p = ref k in
    while !p < n && Z.sign a.(!p).(k) = 0 do incr p done;
    if !p = n then raise Division_by_zero;
    let t = a.(!p) in
    a.(!p) <- a.(k);
    let i = inverse l t.(k) in
    let t = Array.map (fun x -> Z.erem (Z.mul i x) l) t in
    a.(k) <- t;
    Array.iteri (fun r row ->
        let c = row.(k) in
        if r <> k && Z.sign c <> 0 then Array.iteri (fun j x -> if Z.sign x <> 0 then row.(j) <- Z.erem (Z.sub row.(j) (Z.mul c x)) l) t) a
  done;
  Array.map (fun row -> Array.sub row n n) a

(* det(xI - H) *)
let characteristic l n (w : Kernel.similar) = trim (Kernel.zchar l w.Kernel.h_H n)

(* Primes from 2^60 downwards. *)
let primes =
  let rec from p () = if Z.probab_prime (Z.of_int p) 25 > 0 then Seq.Cons (Z.of_int p, from (p - 1)) else from (p - 1) () in
  from (1 lsl 60)

(* Integers Y and rationals X with M = Y X, Y some columns of M. *)
let factorize rows ncols =
  let a = Array.of_list (List.map (fun row -> Array.of_list (List.map Q.of_bigint row)) rows) in
  let n = Array.length a and pivots = ref [] and r = ref 0 in
  for j = 0 to ncols - 1 do
    let i = ref !r in
    while !i < n && Q.sign a.(!i).(j) = 0 do incr i done;
    if !i < n then begin
      let t = a.(!i) in
      a.(!i) <- a.(!r); a.(!r) <- t;
      let p = Q.inv t.(j) in
      Array.iteri (fun k x -> t.(k) <- Q.mul p x) t;
      Array.iteri (fun k row ->
          if k <> !r && Q.sign row.(j) <> 0 then
            let f = row.(j) in
            Array.iteri (fun q x -> if Q.sign x <> 0 then row.(q) <- Q.sub row.(q) (Q.mul f x)) t) a;
      pivots := j :: !pivots; incr r
    end
  done;
  let pivots = List.rev !pivots in
  (List.map (fun row -> let row = Array.of_list row in List.map (fun j -> row.(j)) pivots) rows,
   Array.to_list (Array.map Array.to_list (Array.sub a 0 !r)))

(* Denominators of rows, and integer rows. *)
let rows_of d rows =
  let row_denominator row = List.fold_left (fun acc x -> Z.lcm acc (Z.divexact d (Z.gcd d x))) Z.one row in
  let ds = List.map row_denominator rows in
  (ds, List.map2 (fun e row -> List.map (fun x -> Z.divexact (Z.mul e x) d) row) ds rows)

(* What is known of a matrix over d modulo l, behind the moduli whose product is `before`. *)
let residue d rows scale before l =
  let i = inverse l d in
  let similar = hessenberg l (List.map (fun row -> List.map (fun x -> Z.erem (Z.mul i x) l) row) rows) in
  { Kernel.m_ell = l; m_inv = i; m_scale = inverse l scale; m_before = inverse l before; m_similar = similar }
let residues d rows scale moduli =
  List.rev (snd (List.fold_left (fun (before, l) ell -> (Z.mul before ell, residue d rows scale before ell :: l)) (Z.one, []) moduli))

(* det(xI - A) over Q, integers with the last one the product of ds, and what proves it (spectrum_rule.v). *)
let spectrum d rows =
  let n = List.length rows in
  let ds, scaled = rows_of d rows in
  let scale = List.fold_left Z.mul Z.one ds in
  let bound = List.fold_left2 (fun acc e row -> Z.mul acc (List.fold_left (fun acc x -> Z.add acc (Z.abs x)) e row)) Z.one ds scaled in
  let rec go before moduli value primes =
    if Z.gt before (Z.mul (Z.of_int 2) bound) then (List.rev moduli, before, value)
    else match primes () with
      | Seq.Nil -> assert false
      | Seq.Cons (l, rest) ->
        if not (Z.equal (Z.gcd l d) Z.one) then go before moduli value rest
        else begin
          let w = residue d rows scale before l in
          let p = List.map (fun c -> Z.erem (Z.mul scale c) l) (characteristic l n w.Kernel.m_similar) in
          let value = List.map2 (fun v c -> Z.add v (Z.mul before (Z.erem (Z.mul (Z.sub c v) w.Kernel.m_before) l))) value p in
          go (Z.mul before l) (w :: moduli) value rest
        end in
  let moduli, product, value = go Z.one [] (List.init (n + 1) (fun _ -> Z.zero)) primes in
  let lift v = if Z.gt (Z.mul (Z.of_int 2) v) product then Z.sub v product else v in
  (List.map lift value, { Kernel.s_ds = ds; s_N = scaled; s_moduli = moduli })
