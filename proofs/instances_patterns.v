(* x' = 2 x + 0 u, y = x: no input moves the mode 2, whatever its number is, and one factor x of a matrix of one entry. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel patterns.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation ones := (fun _ : 'I_1 => 1%N).
Notation one := (1%:M : 'M[rat]_1).
Definition undriven : multichannel rat 1 ones ones := Multichannel 2%:R%:M (fun=> 0) (fun=> one).

(* the pattern: no place in B *)
Notation size := (\sum_(i < 1) 1)%N.
Notation there := (const_mx true).
Notation none := (const_mx false).
Definition edge := @pattern_edge 1 size size there none there there.
Definition states : {set 'I_(1 + (size + size))} := [set lshift (size + size) a | a in [set: 'I_1]].

Lemma in_states i : (i \in states) = state i.
Proof.
rewrite /state; case: split_ordP => [a ->|k ->]; first by apply/imsetP; exists a; rewrite ?inE.
by apply/imsetP => -[a _ /eqP]; rewrite eq_rlshift.
Qed.

Lemma no_way_in i j : connect edge i j -> i \notin states -> j \notin states.
Proof.
move=> /connectP[w]; elim: w i => [i _ ->//|k w IH i /= /andP[ik kw] jw Di]; apply: (IH k) => //.
move: ik Di; rewrite !in_states /edge /pattern_edge /state /places.
case: (split_ordP k) => [a ->|a ->]; case: (split_ordP i) => [b ->|b ->] //=; rewrite ?eq_lrshift //.
by rewrite block_mxEur; case: (split_ordP b) => [c ->|c ->]; rewrite ?row_mxEl ?row_mxEr mxE.
Qed.

Lemma closed : of_components edge states.
Proof.
move=> i j ij ji; have [Dj|Dj] := boolP (j \in states); last exact/negbTE/(no_way_in ji).
by apply: contraTT Dj; apply: no_way_in.
Qed.

Lemma fit_A : fits there (mcA undriven). Proof. by move=> i j _; rewrite mxE. Qed.
Lemma fit_B : fits none (\mxrow_i mcB undriven i).
Proof. by move=> i j; rewrite mxE /= mxE eqxx. Qed.
Lemma fit_C : fits there (\mxcol_i mcC undriven i). Proof. by move=> i j _; rewrite mxE. Qed.
Lemma fit_K (K : 'M[rat]_(size, size)) : fits there K. Proof. by move=> i j _; rewrite mxE. Qed.

Notation nought := (fun _ : 'I_(1 + (size + size)) => 0 : int).
Lemma below i j : i \notin states -> j \notin states -> edge j i ->
  nought i + nought j <= (@factors_x 1 size size there none there there i j)%:Z.
Proof. by rewrite addr0. Qed.
Lemma total : \sum_(i | i \notin states) (nought i + nought i) = 0%N%:Z.
Proof. by rewrite big1. Qed.

Definition inst_structural_modes (K : 'M[rat]_(size, size)) := structural_modes fit_A fit_B (@fit_K K) fit_C closed below total.
Definition inst_det_split (K : 'M[rat]_(size, size)) :=
  det_split (fun i j h => (loop_places fit_A fit_B (@fit_K K) fit_C h).1) closed.

Lemma mode : root (\det (within [set: 'I_1] (char_poly_mx (mcA undriven))) * 'X^0) 2%:R.
Proof.
rewrite expr0 mulr1 det_mx11 !mxE !inE /= mulr1n /root hornerD hornerN hornerX hornerC.
by rewrite mulr1n subrr.
Qed.
Definition inst_structural_fixed := structural_fixed fit_A fit_B fit_C closed below total mode (fun f => @fit_K _).
Definition inst_structural_fixed_received :=
  structural_fixed_received fit_A fit_B fit_C closed below total mode (N := fun=> [set: 'I_1]) (fun f => @fit_K _).

(* one factor x *)
Definition alone : 'M[{poly rat}]_1 := 'X%:M.
Lemma one_factor i j : alone i j != 0 -> ('X^1 %| alone i j) /\ (1 + 0 <= 1%N%:Z :> int).
Proof. by rewrite mxE (ord1 i) (ord1 j) mulr1n expr1 dvdpp. Qed.
Lemma adds_up : (1%N%:Z <= \sum_(i < 1) 1 + \sum_(i < 1) 0 :> int).
Proof. by rewrite !big_ord1. Qed.
Definition inst_potentials_bound := potentials_bound one_factor adds_up.
