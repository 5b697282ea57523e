(* A bound for the fixed polynomial, and what follows from it: the fixed modes with their multiplicities and ranks.

   The evidence for the bound is one Krylov sequence (krylov.v), two characteristic polynomials (here), or one of
   these for each block of states (blocks.v).  The data are rationals whose denominators are prime to l, and h embeds
   Q into any field K. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence fixed_spectrum shrunk_multiplicity fixed_polynomial.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* Whatever divides det(xI - A_F) for all F divides one polynomial of a degree of at most n - L. *)
Definition bounded (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) (L : nat) :=
  exists g : {poly K}, [/\ g != 0, dominated (fun F : gains K p q => char_poly (closed_loop S F)) g & (size g + L <= n.+1)%N].

Section Bounded.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).

(* Without evidence. *)
Theorem nothing_bounded : bounded S 0.
Proof.
exists (char_poly (closed_loop S (fun=> 0))); split; last by rewrite addn0 size_char_poly.
  by rewrite monic_neq0 ?char_poly_monic.
by move=> D; apply.
Qed.

(* Fewer closed loops leave no less. *)
Lemma bounded_loops m' (p' q' : 'I_m' -> nat) (S' : multichannel K n p' q') L :
  (forall F', exists F, closed_loop S F = closed_loop S' F') -> bounded S' L -> bounded S L.
Proof.
move=> ex [g [g0 top sg]]; exists g; split=> // D dv; apply: top => F'.
by have [F <-] := ex F'; apply: dv.
Qed.

(* Some of the channels are enough. *)
Theorem bounded_channels (m' : nat) (f : 'I_m' -> 'I_m) (L : nat) :
  bounded (@Multichannel K n m' (fun j => p (f j)) (fun j => q (f j)) (mcA S) (fun j => mcB S (f j)) (fun j => mcC S (f j))) L -> bounded S L.
Proof.
apply: bounded_loops => F'; pose X i := 'M[K]_(p i, q i); pose G j : forall i, X i := @exchange _ X (fun=> 0) (f j) (F' j).
pose F i : X i := \sum_j G j i; exists F; rewrite /closed_loop /=; congr (_ + _).
rewrite (eq_bigr (fun i => \sum_j mcB S i *m G j i *m mcC S i)) => [|i _]; last by rewrite /F mulmx_sumr mulmx_suml.
rewrite exchange_big; apply: eq_bigr => j _; rewrite (bigD1 (f j))//= [G j _]exchange_same big1 ?addr0// => i ij.
by rewrite [G j i]exchange_other// mulmx0 mul0mx.
Qed.

(* A bound of all degrees: nothing is fixed. *)
Theorem bounded_absence lambda : bounded S n -> ~ fixed S lambda.
Proof.
case=> g [g0 top sg] fx; have : 'X - lambda%:P %| g.
  by apply: top => F; rewrite dvdp_XsubCl -eigenvalue_root_char; apply: fx.
by move/(dvdp_leq g0); rewrite size_XsubC => s2; move: sg; rewrite leqNgt (leq_trans _ (leq_add s2 (leqnn n))).
Qed.
End Bounded.

Section Rules.
Variables (l : modulus) (n m : nat) (p q : 'I_m -> nat) (S : multichannel (Zloc l) n p q).
Notation SQ := (map_system (@Zloc_rat l) S).
Notation res := (map_poly (@residue l)).

(* Two polynomials that are coprime modulo l: nothing is left. *)
Theorem coprime_bounded (K : fieldType) (h : {rmorphism rat -> K}) (F : gains (Zloc l) p q) u v :
  u * res (char_poly (mcA S)) + v * res (char_poly (closed_loop S F)) = 1 -> bounded (map_system h SQ) n.
Proof.
move=> bez; have cop := coprime_modulo h (monic_unit_lead (char_poly_monic _)) bez.
exists 1; split; [exact: oner_neq0 | move=> D dv | by rewrite size_poly1].
have cop' : gcdp (map_poly (into h) (char_poly (mcA S))) (map_poly (into h) (char_poly (closed_loop S F))) %= 1.
  by rewrite gcdp_eqp1.
rewrite -(eqp_dvdr _ cop') dvdp_gcd; apply/andP; split.
  have := dv (fun=> 0); rewrite /closed_loop big1 => [|i _]; last by rewrite mulmx0 mul0mx.
  by rewrite addr0 /= -map_mx_comp map_char_poly.
by rewrite map_char_poly map_loop_into; apply: dv.
Qed.

(* With factors: pairwise coprime monic p_i, each with a shrunk subspace of deficiency d_i, whose degrees times
   d_i sum to n - L.  Their product is all that is fixed, with multiplicities. *)
Variables (L r : nat) (P : 'I_r -> {poly Zloc l}) (T : 'I_r -> {set 'I_m}).
Variables (d : 'I_r -> nat) (sh : forall i, rank_loss SQ (map_poly (@Zloc_rat l) (P i)) (T i) (d i)).
Hypotheses (mP : forall i, P i \is monic).
Hypothesis cop : forall i, exists u v, u * res (P i) + v * res (\prod_(j < r | (j < i)%N) P j) = 1.
Hypothesis full : (n <= L + \sum_i d i * (size (P i)).-1)%N.
Variables (K : fieldType) (h : {rmorphism rat -> K}).
Notation SK := (map_system h SQ).
Hypothesis bd : bounded SK L.
Notation PK i := (map_poly (into h) (P i)).

Lemma factors_coprime i j : i != j -> coprimep (PK i) (PK j).
Proof.
have earlier k : coprimep (PK k) (\prod_(t < r | (t < k)%N) PK t).
  by have [u [v bez]] := cop k; rewrite -rmorph_prod (coprime_modulo h (monic_unit_lead (mP k)) bez).
have lt (k t : 'I_r) : (t < k)%N -> coprimep (PK k) (PK t).
  by move=> tk; apply: coprimep_dvdl (earlier k); rewrite (bigD1 t)//= dvdp_mulr.
by rewrite neq_ltn => /orP[/lt|/lt//]; rewrite coprimep_sym.
Qed.

Theorem bounded_rule : fixed_polynomial SK (\prod_i PK i ^+ d i).
Proof.
set Pi := \prod_i _.
have mI i : PK i \is monic by apply: monic_map.
have mPi : Pi \is monic by apply: monic_prod => i _; apply: monic_exp.
have each i G : PK i ^+ d i %| char_poly (closed_loop SK G).
  rewrite map_poly_into; apply: (shrunk_subspace_divides (sh i)).
  by rewrite monic_neq0// monic_map.
have copP i j : i != j -> coprimep (PK i ^+ d i) (PK j ^+ d j).
  by move=> ij; apply: coprimep_expl; apply: coprimep_expr; apply: factors_coprime.
have dv G : Pi %| char_poly (closed_loop SK G).
  rewrite /Pi; elim: (index_enum _) (index_enum_uniq [finType of 'I_r]) => [_|i s IH /= /andP[si us]].
    by rewrite big_nil dvd1p.
  rewrite big_cons Gauss_dvdp ?each ?IH//; rewrite big_seq.
  apply: (big_ind (coprimep _)) => [|b c cb cc|j js]; first exact: coprimep1.
    by rewrite coprimepMr cb.
  by apply: copP; apply: contraNneq si => ->.
have sPi : size Pi = (\sum_i d i * (size (P i)).-1).+1%N.
  apply: (proj2 (big_rec2 (fun (Q : {poly K}) s => Q \is monic /\ size Q = s.+1) _ _)).
    by rewrite monic1 size_poly1.
  move=> i Q s _ [mQ sQ]; have me : PK i ^+ d i \is monic by apply: monic_exp.
  rewrite monicMl ?mQ// size_monicM ?monic_neq0// sQ addnS /=; split=> //.
  rewrite -[size (map_poly _ _ ^+ _)]prednK ?size_poly_gt0 ?monic_neq0// size_exp size_map_poly_id0.
    by rewrite mulnC.
  by rewrite (monicP (mP i)) rmorph1 oner_eq0.
case: bd => g [g0 top sg]; have Pg : Pi %| g by apply: top.
split=> // D dvD; suff e : Pi %= g by rewrite (eqp_dvdr _ e); apply: top.
rewrite -dvdp_size_eqp// eqn_leq (dvdp_leq g0 Pg) sPi -(leq_add2r L) (leq_trans sg)//.
by rewrite addSn ltnS addnC.
Qed.

(* The fixed modes are the roots. *)
Theorem bounded_fixed lambda : (forall i, 0 < d i)%N -> fixed SK lambda <-> exists i, root (PK i) lambda.
Proof.
move=> d0; rewrite (fixed_polynomial_root lambda bounded_rule) /root horner_prod.
split=> [/prodf_eq0[i _]|[i ri]]; first by rewrite horner_exp expf_eq0 => /andP[_ ri]; exists i.
by apply/prodf_eq0; exists i => //; rewrite horner_exp expf_eq0 d0.
Qed.

(* At a simple root of p_i no pencil has a rank below n - d_i, and that of the subset named has this rank. *)
Theorem bounded_rank i lambda : root (PK i) lambda -> ~~ (('X - lambda%:P) ^+ 2 %| PK i) ->
  (forall s, n <= \rank (pencil SK s lambda) + d i)%N /\ (\rank (pencil SK (~: T i) lambda) + d i = n)%N.
Proof.
move=> ri simple; have low : forall s, (n <= \rank (pencil SK s lambda) + d i)%N.
  apply: (fixed_polynomial_rank bounded_rule); apply: contra simple; rewrite (bigD1 i)//=.
  set t := 'X - _; have [R eR] := factor_theorem _ _ ri; rewrite -/t in eR.
  have t0 : t != 0 by rewrite polyXsubC_eq0.
  rewrite Gauss_dvdpl => [|]; last first.
    apply: coprimep_expl; apply: (big_ind (coprimep t)) => [|a b ca cb|j ji]; first exact: coprimep1.
      by rewrite coprimepMr ca.
    by apply/coprimep_expr/(coprimep_dvdr _ (factors_coprime (_ : i != j))); rewrite ?dvdp_XsubCl// eq_sym.
  rewrite eR exprMn exprS dvdp_mul2r ?expf_neq0// => tR.
  rewrite expr2 dvdp_mul2r// dvdp_XsubCl; move: tR; rewrite dvdp_XsubCl /root horner_exp expf_eq0.
  by case/andP.
split=> //; apply/eqP; rewrite eqn_leq low andbT.
apply: (shrunk_subspace_pencil (sh i)); by rewrite -map_poly_into.
Qed.

(* No pencil loses more than the largest d_i, at no lambda. *)
Theorem bounded_deficiency rho lambda : (forall i, d i <= rho)%N ->
  (forall i, ~~ (('X - lambda%:P) ^+ 2 %| PK i)) -> forall s, (n <= \rank (pencil SK s lambda) + rho)%N.
Proof.
move=> dr simple s; have [/existsP[i ri]|] := boolP [exists i, root (PK i) lambda].
  have [low _] := bounded_rank ri (simple i); by rewrite (leq_trans (low s))// leq_add2l dr.
rewrite negb_exists => /forallP none; rewrite (leq_trans _ (leq_addr rho _))// -[X in (_ <= X)%N]addn0.
apply: (fixed_polynomial_rank bounded_rule); rewrite expr1 dvdp_XsubCl /root horner_prod.
by apply/prodf_neq0 => i _; rewrite horner_exp expf_neq0//; apply: none.
Qed.
End Rules.
