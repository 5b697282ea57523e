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

(* Residues modulo l.  A sum of products is reduced in the end by `residue`, where this is faster. *)
module type Residues = sig
  type t
  val of_z : Z.t -> t
  val to_z : t -> Z.t
  val zero : t
  val one : t
  val is_zero : t -> bool
  val inverse : t -> t
  val product : t -> t -> t
  val less : t -> t -> t -> t    (* a - u x *)
  val plus : t -> t -> t -> t    (* a + u x, or something that `residue` takes to it *)
  val residue : t -> t
end

(* u x modulo l, below 2^61, in machine integers.  The quotient is 1 beside that in floating point at most, for x up to
   2^31, so that the remainder is right although products overflow. *)
let[@inline] within l r = if r < 0 then r + l else if r >= l then r - l else r
let[@inline] times l inverse u x = within l ((u * x) - (l * int_of_float (float_of_int u *. float_of_int x *. inverse)))
let half = 1 lsl 31
let[@inline] product l inverse u x =
  if x < half then times l inverse u x
  else within l (times l inverse (times l inverse u (x lsr 31)) half + times l inverse u (x land (half - 1)) - l)

let word number =
  let l = Z.to_int number in
  let inverted = 1. /. float_of_int l in
  (module struct
    type t = int
    let of_z x = Z.to_int (Z.erem x number)
    let to_z = Z.of_int
    let zero = 0 and one = 1
    let is_zero x = x = 0
    let inverse x = Z.to_int (Z.invert (Z.of_int x) number)
    let product u x = product l inverted u x
    let less a u x = within l (a - product u x)
    let plus a u x = within l (a + product u x - l)
    let residue a = a
  end : Residues)

let large l =
  (module struct
    type t = Z.t
    let of_z x = Z.erem x l
    let to_z x = x
    let zero = Z.zero and one = Z.one
    let is_zero x = Z.sign x = 0
    let inverse x = Z.invert x l
    let product u x = Z.erem (Z.mul u x) l
    let less a u x = Z.erem (Z.sub a (Z.mul u x)) l
    let plus a u x = Z.add a (Z.mul u x)
    let residue x = Z.erem x l
  end : Residues)

let residues l = if Z.numbits l <= 61 then word l else large l

(* A L = L H and L Y = I modulo the prime l, H zero below its first subdiagonal.  Modulo a number that is not prime every
   pivot has to be a unit, the last one too, as in the checker in Python. *)
let hessenberg l rows =
  let (module R) = residues l in
  let n = List.length rows in
  let unit () = Array.init n (fun i -> Array.init n (fun j -> if i = j then R.one else R.zero)) in
  let h = Array.of_list (List.map (fun row -> Array.of_list (List.map R.of_z row)) rows) and left = unit () and right = unit () in
  let swap_rows m i j = let t = m.(i) in m.(i) <- m.(j); m.(j) <- t in
  let swap_columns m i j = Array.iter (fun row -> let t = row.(i) in row.(i) <- row.(j); row.(j) <- t) m in
  let less_row m r k u first last =
    let row = m.(r) and other = m.(k) in
    for j = first to last do if not (R.is_zero other.(j)) then row.(j) <- R.less row.(j) u other.(j) done in
  (* Column k and u_r times column r for r > k. *)
  let add_columns m k u =
    Array.iter (fun row ->
        let sum = ref row.(k) in
        for r = k + 1 to n - 1 do if not (R.is_zero row.(r) || R.is_zero u.(r)) then sum := R.plus !sum u.(r) row.(r) done;
        row.(k) <- R.residue !sum) m in
  for k = 1 to n - 1 do
    let pivot = ref k in
    while !pivot < n && R.is_zero h.(!pivot).(k - 1) do incr pivot done;
    if !pivot < n then begin
      if !pivot <> k then begin
        swap_rows h k !pivot; swap_columns h k !pivot; swap_columns left k !pivot; swap_rows right k !pivot
      end;
      let i = R.inverse h.(k).(k - 1) and u = Array.make n R.zero in
      for r = k + 1 to n - 1 do
        if not (R.is_zero h.(r).(k - 1)) then begin
          u.(r) <- R.product h.(r).(k - 1) i;
          less_row h r k u.(r) (k - 1) (n - 1);
          less_row right r k u.(r) 0 (n - 1)
        end
      done;
      add_columns h k u;
      add_columns left k u
    end
  done;
  let rows m = Array.to_list (Array.map (fun row -> Array.to_list (Array.map R.to_z row)) m) in
  { Kernel.h_H = rows h; h_L = rows left; h_Y = rows right }

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

(* det(xI - H): p_(k+1) = x p_k - sum_(i <= k) h_ik b_i ... b_(k-1) p_i, b the first subdiagonal, as `zchar` in
   hessenberg_rule.v. *)
let characteristic l n (w : Kernel.similar) =
  let (module R) = residues l in
  let h = Array.of_list (List.map (fun row -> Array.of_list (List.map R.of_z row)) w.Kernel.h_H) in
  let p = Array.make (n + 1) [| R.one |] in
  for k = 0 to n - 1 do
    let next = Array.append [| R.zero |] p.(k) and product = ref R.one in
    for i = k downto 0 do
      let u = R.less R.zero R.one (R.product h.(i).(k) !product) in
      if not (R.is_zero u) then Array.iteri (fun j x -> next.(j) <- R.plus next.(j) u x) p.(i);
      if i > 0 then product := R.product !product h.(i).(i - 1)
    done;
    p.(k + 1) <- Array.map R.residue next
  done;
  List.map R.to_z (Array.to_list p.(n))

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
