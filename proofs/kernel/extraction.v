(* The kernel as OCaml: binary integers are those of Zarith, and numbers of rows are machine integers.  What is trusted
   here: Coq's extraction, and that the operations named below are what they stand for. *)
From Coq Require Import ZArith Extraction ExtrOcamlBasic ExtrOcamlNatInt.
From mathcomp Require Import all_ssreflect.
From mcexact.kernel Require Import lists systems packed shrunk_rule hessenberg_rule loop_rule fixed_rule large_rule facts reach_rule arcs_rule setpoint_rule program_rule kinds subjects.
Extract Inductive positive => "Zarith_integers.t"
  [ "(fun p -> Zarith_integers.succ (Zarith_integers.shift_left p 1))" "(fun p -> Zarith_integers.shift_left p 1)" "Zarith_integers.one" ]
  "(fun _ _ _ _ -> assert false)".
Extract Inductive Z => "Zarith_integers.t" [ "Zarith_integers.zero" "(fun p -> p)" "Zarith_integers.neg" ]
  "(fun zero positive negative z -> let s = Zarith_integers.sign z in if s = 0 then zero () else if s > 0 then positive z else negative (Zarith_integers.neg z))".
Extract Constant Z.add => "Zarith_integers.add".
Extract Constant Z.mul => "Zarith_integers.mul".
Extract Constant Z.sub => "Zarith_integers.sub".
Extract Constant Z.gcd => "Zarith_integers.gcd".
Extract Constant Z.div => "Zarith_integers.quotient".
Extract Constant Z.of_nat => "Zarith_integers.of_int".
Extract Constant Z.opp => "Zarith_integers.neg".
Extract Constant Z.abs => "Zarith_integers.abs".
Extract Constant Z.eqb => "Zarith_integers.equal".
Extract Constant Z.ltb => "Zarith_integers.lt".
Extract Constant Z.leb => "Zarith_integers.leq".
Extract Constant Z.shiftl => "Zarith_integers.shifted_left".
Extract Constant Z.shiftr => "Zarith_integers.shifted_right".
Extract Constant Z.land => "Zarith_integers.logand".
Extract Constant Z.log2 => "Zarith_integers.logarithm".
Extract Constant Z.modulo => "Zarith_integers.modulo".
Set Extraction Output Directory ".".
Extraction "kernel.ml" check_whole loop_residues completed zchar zpart zdual zmade zpmul zmm check_controllability check_graph check_complete check_setpoint zpick ztogether zlower
  check_open_spectrum check_loop_spectrum check_open_stability check_loop_stability zclosed zclosed_den zsquare zcolumn_sums zexcess.
