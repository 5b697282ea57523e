(* Corollary 1 as it is printed, with some n_i = 0 and an extended transfer graph that need not be strongly connected: any
   symmetric set of 2 (n + sum n_i) numbers is the spectrum of a closed loop.

   A spectrum splits into one symmetric set for each strong component of the transfer graph (component_assignment.v).  A
   symmetric set with an even number of members splits into symmetric sets of any even sizes (even_factors): its members are
   pairs of conjugates and an even number of reals.  With private states as many as its states, every component takes a set
   of even size. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp.real_closed Require Import complex.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements joint_controllability gain_lines.
From mcexact Require Import extended neighbor_graph extended_bound sequential_gains feedback.
From mcexact Require Import theorem_1 strong_components component_gains component_assignment.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Factors.
Variables (K : fieldType) (C : numClosedFieldType) (f : {rmorphism K -> C}).
Hypothesis reals : forall x, x \is Num.real <-> exists y, f y = x.
Hypothesis symmetric : forall Lambda : seq C, perm_eq Lambda [seq x^* | x <- Lambda] ->
  exists P : {poly K}, [/\ P \is monic, size P = (size Lambda).+1 &
    map_poly f P = \prod_(x <- Lambda) ('X - x%:P)].
Implicit Types (P Q : {poly K}).

Lemma root_or_quadratic P : (1 < size P)%N ->
  (exists x, root P x) \/ (exists Q, [/\ Q \is monic, size Q = 3%N & Q %| P]).
Proof.
move=> sP; have sP' : size (map_poly f P) != 1%N by rewrite size_map_poly; case: (size P) sP => [|[]].
have [z rz] := closed_rootP (map_poly f P) sP'.
have [/reals[x e]|nz] := boolP (z \is Num.real); first by left; exists x; rewrite -(fmorph_root f) e.
right; have zz : z^* != z by apply: contraNneq nz => e; apply/CrealP.
have [|Q [mQ sQ eQ]] := symmetric (Lambda := [:: z; z^*]).
  by rewrite /= conjCK -[X in perm_eq X _]cat1s -[X in perm_eq _ X]cat1s perm_catC.
exists Q; split=> //; rewrite -(dvdp_map f) eQ big_cons big_seq1 Gauss_dvdp; last first.
  by rewrite coprimep_XsubC root_XsubC.
rewrite !dvdp_XsubCl rz /=; have -> : map_poly f P = map_poly conjC (map_poly f P); last by rewrite fmorph_root.
rewrite -map_poly_comp; apply: eq_map_poly => x /=; apply/esym/CrealP.
by apply/reals; exists x.
Qed.

Lemma quadratic_factor P : (2 < size P)%N -> exists Q, [/\ Q \is monic, size Q = 3%N & Q %| P].
Proof.
move=> sP; have [|[x rx]|//] := root_or_quadratic (P := P); first exact: ltnW.
have /dvdpP[P1 e] : 'X - x%:P %| P by rewrite dvdp_XsubCl.
have P0 : P1 != 0 by apply: contraTneq sP => e0; rewrite e e0 mul0r size_poly0.
have sP1 : (1 < size P1)%N by move: sP; rewrite e size_Mmonic ?monicXsubC // size_XsubC addn2.
have [[y ry]|[Q [mQ sQ /dvdpP[D eD]]]] := root_or_quadratic sP1; last first.
  by exists Q; split=> //; rewrite e eD -mulrA [Q * _]mulrC mulrA dvdp_mull.
have /dvdpP[D eD] : 'X - y%:P %| P1 by rewrite dvdp_XsubCl.
exists (('X - y%:P) * ('X - x%:P)); split; first by rewrite rpredM ?monicXsubC.
  by rewrite size_Mmonic ?monicXsubC ?polyXsubC_eq0 // !size_XsubC.
by rewrite e eD -mulrA dvdp_mull.
Qed.

Lemma even_factor P a b : P \is monic -> size P = (a.*2 + b.*2).+1 ->
  exists Q Q', [/\ Q \is monic, Q' \is monic, size Q = a.*2.+1, size Q' = b.*2.+1 & P = Q * Q'].
Proof.
elim: a P => [|a IH] P mP sP.
  by exists 1, P; rewrite monic1 mP size_poly1 sP add0n mul1r.
have [|q [mq sq /dvdpP[D e]]] := quadratic_factor (P := P); first by rewrite sP doubleS !addSn.
have mD : D \is monic by move: mP; rewrite e monicMr.
have sD : size D = (a.*2 + b.*2).+1.
  by move: sP; rewrite e size_Mmonic ?monic_neq0 // sq addn3 /= doubleS !addSn => -[].
have [Q [Q' [mQ mQ' sQ sQ' eD]]] := IH D mD sD.
exists (q * Q), Q'; split=> //; first by rewrite rpredM.
  by rewrite size_Mmonic ?monic_neq0 // sq sQ doubleS.
by rewrite e eD mulrC mulrA.
Qed.

(* one monic factor of degree 2 d c for every c of a list *)
Theorem even_factors (I : eqType) (r : seq I) (d : I -> nat) P : uniq r -> P \is monic ->
  size P = (\sum_(c <- r) d c).*2.+1 ->
  exists Q : I -> {poly K}, (forall c, c \in r -> Q c \is monic /\ size (Q c) = (d c).*2.+1) /\
    P = \prod_(c <- r) Q c.
Proof.
elim: r P => [|c r IH] P /=.
  move=> _ mP; rewrite big_nil => /eqP/size_poly1P[x x0 e]; exists (fun=> 1); split=> //.
  by move: mP; rewrite big_nil e monicE lead_coefC => /eqP ->.
move=> /andP[cr ur] mP; rewrite big_cons doubleD => sP.
have [Q [Q' [mQ mQ' sQ sQ' e]]] := even_factor mP sP.
have [D [hD eD]] := IH Q' ur mQ' sQ'.
exists (fun i => if i == c then Q else D i); split.
  by move=> i; rewrite inE; case: eqP => [->|_ /hD] //; rewrite mQ sQ.
rewrite big_cons eqxx e eD; congr (_ * _); rewrite !big_seq; apply: eq_bigr => i ir.
by case: eqP => // ei; rewrite -ei ir in cr.
Qed.
End Factors.

Section Assignment.
Variable R : rcfType.
Notation C := (complex R).
Notation f := [rmorphism of real_complex R].

Fact real_or_not (x : C) : x \is Num.real <-> exists y, f y = x.
Proof.
split=> [|[y <-]]; last by apply/complex_realP; exists y.
by case/complex_realP => y ->; exists y.
Qed.
Fact real_value (x : C) : x \is Num.real -> exists y, f y = x. Proof. by case/real_or_not => y; exists y. Qed.

Variables (n m : nat) (p q : 'I_m -> nat) (S : multichannel R n p q).
Hypothesis m0 : (0 < m)%N.

Theorem even_assignment : (forall lambda : C, ~ fixed_over f S lambda) ->
  forall P : {poly R}, P \is monic -> size P = n.*2.+1 ->
  exists k (D : controllers R p q k), char_poly (dynamic_loop S D) = P.
Proof.
move=> nofix P mP sP.
have inf : infinite R := @reals_infinite _ [numClosedFieldType of C] f.
have [d [T [sd _ _ assign]]] := component_assignment inf nofix.
have sP' : size P = (\sum_(c <- enum (components S)) d c).*2.+1 by rewrite big_enum sd.
have [Q [hQ eP]] := even_factors real_or_not (@symmetric_polynomial _ _ f real_value) (enum_uniq _) mP sP'.
pose o (c : {set 'I_m}) : 'I_m := if [pick i in c] is Some i then i else Ordinal m0.
have [|k [D [_ e]]] := assign o d Q.
  move=> c cX; have [mQ sQ] : Q c \is monic /\ size (Q c) = (d c).*2.+1 by apply: hQ; rewrite mem_enum.
  split=> //; last by rewrite sQ addnn.
  rewrite /o; case: pickP => // none; move: cX => /imsetP[j _ ec].
  by have := none j; rewrite ec in_component.
by exists k, D; rewrite e eP big_enum.
Qed.
End Assignment.
