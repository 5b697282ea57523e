(* x' = x + u_1 + u_2, y_1 = y_2 = x: either agent moves the mode 1, and it is fixed once both have failed. *)
From mathcomp Require Import all_ssreflect all_algebra all_field.
From mcexact Require Import multichannel failures arithmetic fixed_spectrum large_modulus.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Notation ones := (fun _ : 'I_2 => 1%N).
Notation one := (1%:M : 'M[rat]_1).
Definition double : multichannel rat 1 ones ones := Multichannel one (fun=> one) (fun=> one).
Definition working (i : 'I_2) : 'M[rat]_1 := 1%:M.
Definition without (j i : 'I_2) : 'M[rat]_1 := (i != j)%:R%:M.
Definition lost (i : 'I_2) : 'M[rat]_1 := 0.

Lemma both_fixed : fixed (failed double lost working) 1.
Proof.
move=> F; apply/eigenvalueP; exists one; last by rewrite -[1%:M]/one oner_eq0.
by rewrite /closed_loop big1 => [|i _]; rewrite /= ?mulmx0 ?mul0mx// addr0 mul1mx scale1r.
Qed.

Definition inst_failed_loop := failed_loop double (without ord0) working (fun=> - 2%:R%:M).
Definition inst_fixed_after_failure := fixed_after_failure working working both_fixed.
Definition inst_fixed_after_more := fixed_after_more working (without ord0) both_fixed.

(* One agent is enough: without the first one, the gain -1 of the second moves the mode to 0. *)
Lemma one_moves : ~ fixed (failed double (without ord0) working) 1.
Proof.
move=> /(_ (fun=> - one)) /eigenvalueP [v h nz]; case/negP: nz.
move: h; rewrite /closed_loop big_ord_recl big_ord1 /=.
rewrite /without eqxx /= mulr0n raddf0 mulmx0 !mul0mx add0r mulmx1 !mul1mx mulmx1 subrr mulmx0 scale1r.
by move=> <-.
Qed.

(* Either agent alone may fail, so that two have to before the mode is fixed. *)
Definition works (S : {set 'I_2}) (i : 'I_2) : 'M[rat]_1 := (i \in S)%:R%:M.
Lemma works_both S S' i : works (S :&: S') i = works S i *m works S' i.
Proof. by rewrite /works inE -scalar_mxM -natrM mulnb. Qed.
Lemma works_both_turned S S' i : works (S :&: S') i = works S' i *m works S i.
Proof. by rewrite setIC works_both. Qed.

Lemma one_works (j : 'I_2) : \sum_(i < 2) (i \in ~: [set j])%:R = 1 :> rat.
Proof. by rewrite !big_ord_recl big_ord0 !inE; case: j => [[|[|//]] ?]. Qed.

Lemma each_moves j : ~ fixed (after double works works [set j]) 1.
Proof.
move=> /(_ (fun=> - one)) /eigenvalueP [v h nz]; case/negP: nz.
have loop : closed_loop (after double works works [set j]) (fun=> - one) = 0.
  rewrite /closed_loop (eq_bigr (fun i => - ((i \in ~: [set j])%:R%:M : 'M[rat]_1))) => [|i _].
    by rewrite sumrN -raddf_sum /= one_works subrr.
  by rewrite /= /works mulmxN mul1mx mulmx1 mulNmx -scalar_mxM -natrM mulnb andbb.
by move: h; rewrite loop mulmx0 scale1r => <-.
Qed.

Lemma all_fixed : fixed (after double works works setT) 1.
Proof.
move=> F; apply/eigenvalueP; exists one; last by rewrite -[1%:M]/one oner_eq0.
rewrite /closed_loop big1 => [|i _]; first by rewrite addr0 mul1mx scale1r.
by rewrite /= /works setCT inE raddf0 mulmx0 !mul0mx.
Qed.

Definition inst_fixed_after_all_in :=
  fixed_after_all_in works_both works_both_turned (subsetT setT) all_fixed.

Lemma inst_at_least_so_many : (1 < #|[set: 'I_2]|)%N.
Proof.
apply: (at_least_so_many works_both works_both_turned (harmless := [:: [set ord0]; [set lift ord0 ord0]]))
    all_fixed => [G | H].
  by rewrite !inE => /orP [] /eqP ->; apply: each_moves.
rewrite leq_eqVlt ltnS leqn0 cards_eq0 => /orP [/cards1P [j ->] | /eqP ->]; last first.
  by exists [set ord0]; rewrite ?inE ?eqxx // disjoints_subset sub0set.
exists [set j]; last by rewrite disjoints_subset setCK.
by rewrite !inE !(inj_eq set1_inj); case: j => [[|[|//]] ?].
Qed.

(* Modulo 7 a system without states has no fixed mode: the bound of `large_modulus` is the empty case. *)
Definition seven : modulus := @Modulus 7 isT.
Definition stateless : multichannel (Zloc seven) 0 ones ones := Multichannel 0 (fun=> 0) (fun=> 0).
Lemma without_states (K : fieldType) (hK : {rmorphism rat -> K}) lambda :
  fixed (map_system hK (map_system (@Zloc_rat seven) stateless)) lambda -> False.
Proof.
have empty (R : comRingType) (A : 'M[R]_0) : char_poly A = 1 by rewrite /char_poly det_mx00.
move=> fx.
have : root (map_poly (into hK) (1 * 1 : {poly Zloc seven})) lambda.
  apply: (@large_modulus seven 0 _ _ _ stateless (fun=> 0) 1 1 1 1 0 _ _ _ _ _ 1 0 0 0 1) fx.
  - exact: monic1.
  - exact: monic1.
  - by rewrite empty !mulr1.
  - by move=> G; rewrite empty rmorph1 dvd1p.
  - by rewrite mul0r addr0 mulr1.
  - by [].
  - by case.
  - by rewrite !size_poly1.
  - by move=> i; rewrite size_poly1 ltnS leqn0 => /eqP->; rewrite !coefC /= expr0 mul1r rmorph1.
  - by left; case.
  - by rewrite size_poly1 big_ord_recl big_ord0 coefC /= normr1 expr0 mulr1 addr0.
by rewrite mulr1 rmorph1 (negPf (root1 _)).
Qed.
