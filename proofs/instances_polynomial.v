(* The characteristic polynomial of [3/2], read off modulo 11, and that of [1, 1; 1, 1], by columns. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import arithmetic hessenberg characteristic_polynomial.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Definition l11 := @Modulus 11 isT.
Definition N : 'M[int]_1 := 3%:R%:M.
Definition h (i : 'I_1) : nat := 3.
Definition c : {poly int} := 'X - 3%:R%:P.
Lemma rows_N i : \sum_j N i j ^+ 2 <= (h i)%:R ^+ 2.
Proof. by rewrite big_ord1 mxE !ord1. Qed.
Lemma large_l11 : (2 * \prod_(i < 1) (1 + h i) < l11)%N. Proof. by rewrite big_ord1. Qed.
Lemma least_c k : (2 * `|(c`_k)%R| <= l11)%N.
Proof. by rewrite coefB coefX coefC; case: k => [|[|k]]. Qed.
Lemma residues_c : map_poly intr c = char_poly (map_mx intr N) :> {poly 'Z_l11}.
Proof.
rewrite /char_poly det_mx11 !mxE eqxx rmorphB /= map_polyX map_polyC.
by rewrite !mulr1n.
Qed.
Definition inst_integers : char_poly N = c := characteristic_polynomial_integers rows_N large_l11 least_c residues_c.
Lemma inst_rational :
  char_poly (\matrix_(i, j) ((N i j)%:~R / 2%:R) : 'M[rat]_1) = \poly_(k < 2) ((c`_k)%:~R / 2%:R ^+ (1 - k)).
Proof. exact: (characteristic_polynomial_rule rows_N large_l11 least_c _ residues_c). Qed.

Notation ones := (hessenberg (fun _ _ => 1) (fun=> 1) 2 : 'M[int]_2).
Lemma inst_hessenberg_polynomial : char_poly ones = ('X - 1) ^+ 2 - 1.
Proof.
rewrite hessenberg_polynomial /hessenberg_poly /= !big_ord_recl !big_ord0 /=.
rewrite !big_nat1 /bump /= !big_geq// !mulr1 !scale1r !addr0 opprD addrA addrAC.
by rewrite expr2 mulrBl mul1r.
Qed.
