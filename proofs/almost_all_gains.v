(* "Almost any gains will do": the gains that make a system controllable and observable through every
   channel are the complement of a proper algebraic set, as are those that give a controllability index.

   polynomial g: the function g of the gains is a polynomial in their entries; almost_all P: P holds
   exactly where one of finitely many polynomials does not vanish, and it holds somewhere. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability.
From mcexact Require Import joint_controllability gain_lines neighbor_graph extended_bound feedback.
From mcexact Require Import corfmat_morse error_system.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Polynomials.
Variables (K : fieldType) (m : nat) (p q : 'I_m -> nat).
Notation G := (gains K p q).

Inductive polynomial : (G -> K) -> Prop :=
| PolynomialConstant c : polynomial (fun=> c)
| PolynomialEntry i a b : polynomial (fun F => F i a b)
| PolynomialSum g h : polynomial g -> polynomial h -> polynomial (fun F => g F + h F)
| PolynomialProduct g h : polynomial g -> polynomial h -> polynomial (fun F => g F * h F)
| PolynomialSame g h : polynomial g -> g =1 h -> polynomial h.

Definition almost_all (P : G -> Prop) := exists (I : finType) (g : I -> G -> K),
  [/\ forall i, polynomial (g i), forall F, P F <-> exists i, g i F != 0 & exists F, P F].

Lemma polynomial_sum (I : Type) (r : seq I) (g : I -> G -> K) :
  (forall i, polynomial (g i)) -> polynomial (fun F => \sum_(i <- r) g i F).
Proof.
move=> h; elim: r => [|i r IH].
  by apply: (PolynomialSame (PolynomialConstant 0)) => F; rewrite big_nil.
by apply: (PolynomialSame (PolynomialSum (h i) IH)) => F; rewrite big_cons.
Qed.

Lemma polynomial_prod (I : Type) (r : seq I) (g : I -> G -> K) :
  (forall i, polynomial (g i)) -> polynomial (fun F => \prod_(i <- r) g i F).
Proof.
move=> h; elim: r => [|i r IH].
  by apply: (PolynomialSame (PolynomialConstant 1)) => F; rewrite big_nil.
by apply: (PolynomialSame (PolynomialProduct (h i) IH)) => F; rewrite big_cons.
Qed.

(* matrices all of whose entries are polynomials *)
Definition polynomials a b (M : G -> 'M[K]_(a, b)) := forall i j, polynomial (fun F => M F i j).

Lemma polynomials_mul a b c (M : G -> 'M[K]_(a, b)) (M' : G -> 'M_(b, c)) :
  polynomials M -> polynomials M' -> polynomials (fun F => M F *m M' F).
Proof.
move=> h h' i j; apply: PolynomialSame (polynomial_sum _ (fun k => PolynomialProduct (h i k) (h' k j))) _.
by move=> F; rewrite mxE.
Qed.

Lemma polynomials_constant a b (M : 'M[K]_(a, b)) : polynomials (fun=> M).
Proof. by move=> i j; apply: PolynomialConstant. Qed.

Lemma polynomials_tr a b (M : G -> 'M[K]_(a, b)) : polynomials M -> polynomials (fun F => (M F)^T).
Proof. by move=> h i j; apply: PolynomialSame (h j i) _ => F; rewrite mxE. Qed.

Lemma polynomial_det a (M : G -> 'M[K]_a) : polynomials M -> polynomial (fun F => \det (M F)).
Proof.
move=> h; apply: polynomial_sum => s; apply: PolynomialProduct; first exact: PolynomialConstant.
by apply: polynomial_prod => i; apply: h.
Qed.

Lemma polynomials_loop n (S : multichannel K n p q) : polynomials (closed_loop S).
Proof.
move=> a b; have entry i : polynomials (fun F : G => F i) by move=> c d; apply: PolynomialEntry.
have term i := polynomials_mul (polynomials_mul (polynomials_constant (mcB S i)) (entry i))
  (polynomials_constant (mcC S i)).
apply: PolynomialSame (PolynomialSum (PolynomialConstant (mcA S a b))
  (polynomial_sum (index_enum [finType of 'I_m]) (fun i => term i a b))) _ => F.
by rewrite /closed_loop mxE summxE.
Qed.

Lemma polynomials_reach n b (M : G -> 'M[K]_n) (B : 'M_(n, b)) k :
  polynomials M -> polynomials (fun F => reach (M F) B k).
Proof.
move=> h i j; suff kr t : polynomials (fun F => krylov (M F) B t).
  by apply: PolynomialSame (kr _ i _) _ => F; rewrite [RHS]mxE.
elim: t => [|t IH]; first exact: polynomials_constant.
exact: polynomials_mul.
Qed.

Lemma full_rank_minor a b (M : 'M[K]_(a, b)) :
  \rank M = a <-> exists s : {ffun 'I_a -> 'I_b}, \det (colsub s M) != 0.
Proof.
split=> [r|[s]]; last first.
  rewrite -unitfE -unitmxE => /mxrank_unit e; apply/eqP; rewrite eqn_leq rank_leq_row -{1}e.
  have -> : colsub s M = M *m colsub s 1%:M by rewrite mulmx_colsub mulmx1.
  exact: mxrankM_maxl.
have fM : row_full M^T by rewrite /row_full mxrank_tr r.
exists [ffun i => fullrankfun fM i]; rewrite -unitfE -unitmxE -unitmx_tr.
have -> : (colsub [ffun i => fullrankfun fM i] M)^T = rowsub (fullrankfun fM) M^T.
  by apply/matrixP => i j; rewrite !mxE ffunE.
exact: fullrowsub_unit.
Qed.

Lemma almost_all_rank a b (M : G -> 'M[K]_(a, b)) : polynomials M ->
  (exists F, \rank (M F) = a) -> almost_all (fun F => \rank (M F) = a).
Proof.
move=> h ex; exists [finType of {ffun 'I_a -> 'I_b}], (fun (s : {ffun 'I_a -> 'I_b}) F => \det (colsub s (M F))); split=> //.
  move=> s; apply: polynomial_det => i j; apply: PolynomialSame (h i (s j)) _ => F.
  by rewrite mxE.
by move=> F; apply: full_rank_minor.
Qed.

Lemma almost_all_and P P' : almost_all P -> almost_all P' -> (exists F, P F /\ P' F) ->
  almost_all (fun F => P F /\ P' F).
Proof.
move=> [I [g [pg e _]]] [I' [g' [pg' e' _]]] ex.
exists [finType of I * I'], (fun ij F => g ij.1 F * g' ij.2 F); split=> //.
  by move=> ij; apply: PolynomialProduct.
move=> F; rewrite e e'; split=> [[[i gi] [j gj]]|[[i j]]]; first by exists (i, j); rewrite mulf_neq0.
by rewrite mulf_eq0 negb_or => /andP[gi gj]; split; [exists i | exists j].
Qed.

Lemma almost_all_list (I : eqType) (P : I -> G -> Prop) (js : seq I) :
  (forall i, almost_all (P i)) -> (exists F, forall i, i \in js -> P i F) ->
  almost_all (fun F => forall i, i \in js -> P i F).
Proof.
move=> h; elim: js => [|i js IH] [F hF].
  exists [finType of unit], (fun _ _ => 1); split=> [_|F'|]; first exact: PolynomialConstant.
    by split=> // _; exists tt; rewrite oner_neq0.
  by exists F.
have some : exists F, forall j, j \in js -> P j F.
  by exists F => j jjs; apply: hF; rewrite inE jjs orbT.
have [|I' [g [pg e ex]]] := almost_all_and (h i) (IH some).
  by exists F; split=> [|j jjs]; apply: hF; rewrite inE ?eqxx ?jjs ?orbT.
exists I', g; split=> // [F'|]; last by exists F.
rewrite -e; split=> [h'|[Pi Pjs] j]; last by rewrite inE => /orP[/eqP->|/Pjs].
by split=> [|j jjs]; apply: h'; rewrite inE ?eqxx ?jjs ?orbT.
Qed.

Lemma almost_all_same P P' : (forall F, P F <-> P' F) -> almost_all P -> almost_all P'.
Proof.
move=> PP [I [g [pg e [F ex]]]]; exists I, g; split=> // [F'|]; first by rewrite -PP.
by exists F; rewrite -PP.
Qed.

Lemma almost_all_channels (P : 'I_m -> G -> Prop) : (forall i, almost_all (P i)) ->
  (exists F, forall i, P i F) -> almost_all (fun F => forall i, P i F).
Proof.
move=> h [F hF]; apply: almost_all_same (almost_all_list (js := enum 'I_m) h _) => [F'|].
  by split=> h' i => [|_]; apply: h'; rewrite ?mem_enum.
by exists F => i _.
Qed.

Variables (n : nat) (S : multichannel K n p q).

(* where some gains reach rank n with k blocks through every channel, almost all do *)
Theorem almost_all_reached k : (exists F, forall o, \rank (reach (closed_loop S F) (mcB S o) k) = n) ->
  almost_all (fun F => forall o, \rank (reach (closed_loop S F) (mcB S o) k) = n).
Proof.
move=> ex; apply: almost_all_channels => // o; apply: almost_all_rank.
  exact/polynomials_reach/polynomials_loop.
by have [F h] := ex; exists F.
Qed.

(* and the same for observability *)
Theorem almost_all_observed k :
  (exists F, forall o, \rank (reach (closed_loop S F)^T (mcC S o)^T k) = n) ->
  almost_all (fun F => forall o, \rank (reach (closed_loop S F)^T (mcC S o)^T k) = n).
Proof.
move=> ex; apply: almost_all_channels => // o; apply: almost_all_rank.
  exact/polynomials_reach/polynomials_tr/polynomials_loop.
by have [F h] := ex; exists F.
Qed.

Lemma almost_all_both k : (exists F, forall o, \rank (reach (closed_loop S F) (mcB S o) k) = n /\
    controllable (closed_loop S F)^T (mcC S o)^T) ->
  almost_all (fun F => forall o, \rank (reach (closed_loop S F) (mcB S o) k) = n /\
    controllable (closed_loop S F)^T (mcC S o)^T).
Proof.
move=> [F h]; have [|||I [g [pg e ex]]] := @almost_all_and
  (fun F => forall o, \rank (reach (closed_loop S F) (mcB S o) k) = n)
  (fun F => forall o, \rank (reach (closed_loop S F)^T (mcC S o)^T n) = n).
- by apply: almost_all_reached; exists F => o; case: (h o).
- by apply: almost_all_observed; exists F => o; case: (h o) => _ /eqP.
- by exists F; split=> o; case: (h o) => // _ /eqP.
exists I, g; split=> // [F'|]; last by exists F.
rewrite -e; split=> [h'|[h1 h2] o]; last by split; [exact: h1 | exact/eqP/h2].
by split=> o; case: (h' o) => // _ /eqP.
Qed.

(* Corfmat and Morse: almost all gains make every channel control and observe the loop *)
Theorem corfmat_morse_almost_all (L : closedFieldType) (f : {rmorphism K -> L}) : infinite K ->
  strongly_connected (transfer_arc S) -> (forall lambda : L, ~ fixed_over f S lambda) ->
  almost_all (fun F => forall o, controllable (closed_loop S F) (mcB S o) /\
                                 controllable (closed_loop S F)^T (mcC S o)^T).
Proof.
move=> inf sc nf; have [F h] := corfmat_morse inf sc nf.
apply: almost_all_same (@almost_all_both n _) => [F'|].
  by split=> h' o; case: (h' o) => [h1 h2]; split=> //; apply/eqP.
by exists F => o; case: (h o) => /eqP.
Qed.
End Polynomials.

(* Proposition 1: almost all gains [K_i H_i] *)
Section ErrorSystem.
Variables (K : fieldType) (L : closedFieldType) (f : {rmorphism K -> L}).
Variables (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Hypothesis inf : infinite K.
Hypothesis sc : strongly_connected (neighbor_arc N).
Hypothesis n0 : (0 < n)%N.
Variables (S : multichannel K n p q) (F : forall i, 'M[K]_(p i, n)).
Notation E := (error_system N S F).
Notation nm := (\sum_(i < m) n)%N.

Lemma index_rank (KH : gains K (fun=> n) (fun i => q i + nm)%N) (o : 'I_m) :
  controllability_index (closed_loop E KH) (mcB E o) m <->
  \rank (reach (closed_loop E KH) (mcB E o) m) = nm.
Proof. by split=> [[]|] //; apply: index_of_rank. Qed.

(* the gains of Lemma 4 *)
Theorem lemma_4_almost_all :
  almost_all (fun KH => forall o, controllability_index (closed_loop E KH) (mcB E o) m).
Proof.
apply: almost_all_same (almost_all_reached (k := m) _) => [KH|].
  by split=> h o; have := h o; rewrite index_rank.
have [H h] := lemma_4 f inf sc n0 S F (fun=> 0).
by exists (fun j => row_mx 0 (H j)) => o; case: (h o).
Qed.

(* those that make it observable through every channel *)
Theorem observed_almost_all : jointly_observable S ->
  almost_all (fun KH => forall o, controllable (closed_loop E KH)^T (mcC E o)^T).
Proof.
move=> jo; apply: almost_all_same (almost_all_observed (k := nm) _) => [KH|].
  by split=> h o; apply/eqP/h.
have [KH h] := proposition_1 f inf sc n0 F jo.
by exists KH => o; apply/eqP; case: (h o).
Qed.

(* and those of Proposition 1, which do both *)
Theorem proposition_1_almost_all : jointly_observable S ->
  almost_all (fun KH => forall o, controllability_index (closed_loop E KH) (mcB E o) m /\
                                  controllable (closed_loop E KH)^T (mcC E o)^T).
Proof.
move=> jo; have [KH h] := proposition_1 f inf sc n0 F jo.
apply: almost_all_same (almost_all_both (k := m) _) => [KH'|].
  by split=> h' o; have := h' o; rewrite index_rank.
by exists KH => o; case: (h o) => [[]].
Qed.
End ErrorSystem.
