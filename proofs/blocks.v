(* Strong components of the digraph of |A| + sum_i |B_i| J |C_i|: in an order in which no arc goes down, every
   A_F is block triangular, and the fixed polynomial is the product of those of the blocks.

   `block` a gives the block of the state a.  A channel that acts within a block, by a row of B_i and a column of
   C_i there, does so in no other: no gain is shared by two blocks. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
From mcexact Require Import multichannel evidence fixed_polynomial fixed_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Determinant.
Variable R : comRingType.

(* A principal minor depends on the set of its rows alone. *)
Lemma det_principal n (M : 'M[R]_n) a b (f : 'I_a -> 'I_n) (g : 'I_b -> 'I_n) :
  injective f -> injective g -> codom f =i codom g -> \det (mxsub f f M) = \det (mxsub g g M).
Proof.
move=> fi gi same; have ab : a = b.
  by rewrite -[a]card_ord -[b]card_ord -(card_codom fi) -(card_codom gi); apply: eq_card.
case: _ / ab g gi same => g gi same.
have inv i : f i \in codom g by rewrite -same codom_f.
pose s i := iinv (inv i); have gs i : g (s i) = f i by apply: f_iinv.
have si : injective s by move=> i j e; apply: fi; rewrite -!gs e.
have -> : mxsub f f M = row_perm (perm si) (col_perm (perm si) (mxsub g g M)).
  by apply/matrixP=> i j; rewrite !mxE !permE !gs.
rewrite row_permE col_permE !det_mulmx !det_perm mulrCA -signr_addb odd_permV.
by rewrite addbb mulr1.
Qed.

Definition principal n (M : 'M[R]_n) (c : {set 'I_n}) : 'M_#|c| := mxsub enum_val enum_val M.

Lemma enum_val_codom n (c : {set 'I_n}) i : (i \in codom (@enum_val _ (mem c))) = (i \in c).
Proof.
apply/codomP/idP=> [[j ->]|ic]; first exact: enum_valP.
by exists (enum_rank_in ic i); rewrite enum_rankK_in.
Qed.

Lemma det_two n (M : 'M[R]_n) (c : {set 'I_n}) : (forall a b, a \notin c -> b \in c -> M a b = 0) ->
  \det M = \det (principal M c) * \det (principal M (~: c)).
Proof.
move=> z; pose f (k : 'I_(#|c| + #|~: c|)) : 'I_n := match split k with inl a => enum_val a | inr b => enum_val b end.
have fl a : f (lshift _ a) = enum_val a by rewrite /f (unsplitK (inl _ a)).
have fr b : f (rshift _ b) = enum_val b by rewrite /f (unsplitK (inr _ b)).
have fi : injective f.
  move=> i j; rewrite -[i]splitK -[j]splitK; case: (split i) => a; case: (split j) => b /=; rewrite ?fl ?fr.
  - by move/enum_val_inj->.
  - by move=> e; have := enum_valP b; rewrite inE -e enum_valP.
  - by move=> e; have := enum_valP a; rewrite inE e enum_valP.
  - by move/enum_val_inj->.
have -> : \det M = \det (mxsub f f M).
  rewrite -[M in LHS]mxsub_id; apply: det_principal => // i.
  have -> : i \in codom id by apply/codomP; exists i.
  apply/esym/codomP; have [ic|nc] := boolP (i \in c).
    by exists (lshift _ (enum_rank_in ic i)); rewrite fl enum_rankK_in.
  have ic : i \in ~: c by rewrite inE.
  by exists (rshift _ (enum_rank_in ic i)); rewrite fr enum_rankK_in.
rewrite -[mxsub f f M]submxK; have -> : dlsubmx (mxsub f f M) = 0.
  apply/matrixP=> b a; rewrite !mxE fl fr z ?enum_valP//.
  by have := enum_valP b; rewrite inE.
rewrite det_ublock; congr (_ * _); congr (\det _); apply/matrixP=> a b; by rewrite !mxE ?fl ?fr.
Qed.

(* No entry below the diagonal blocks: the determinant is the product of those of the diagonal blocks. *)
Lemma det_blocks r n (M : 'M[R]_n) (block : 'I_n -> nat) : (forall a, (block a < r)%N) ->
  (forall a b, (block b < block a)%N -> M a b = 0) ->
  \det M = \prod_(k < r) \det (principal M [set a | block a == k]).
Proof.
elim: r n M block => [|r IH] n M block lt z.
  by case: n M block lt z => [|n] M block lt _; [rewrite big_ord0 det_mx00 | have := lt ord0].
pose c := [set a | (block a < r)%N]; rewrite (det_two (c := c)) => [|a b]; last first.
  by rewrite !inE => ar br; apply: z; apply: leq_trans br _; rewrite leqNgt.
rewrite big_ord_recr /=; congr (_ * _); last first.
  apply: det_principal; try exact: enum_val_inj; move=> a.
  by rewrite !enum_val_codom !inE -leqNgt eqn_leq -(ltnS (block a) r) lt.
rewrite (IH _ _ (fun a => block (enum_val a))) => [|a|a b ba].
- apply: eq_bigr => k _; rewrite /principal -mxsub_comp.
  apply: det_principal; [exact: inj_comp enum_val_inj enum_val_inj | exact: enum_val_inj |].
  move=> a; rewrite enum_val_codom inE; apply/codomP/eqP=> [[j ->]|ak].
    by have := enum_valP j; rewrite inE => /eqP.
  have ac : a \in c by rewrite inE ak.
  have aj : enum_rank_in ac a \in [set a | block (enum_val a) == k] by rewrite inE enum_rankK_in ?ak.
  by exists (enum_rank_in aj (enum_rank_in ac a)); rewrite /= !enum_rankK_in.
- by have := enum_valP a; rewrite inE.
by rewrite mxE z.
Qed.
End Determinant.

Section Blocks.
Variables (R : comRingType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel R n p q) (c : {set 'I_n}).

(* The states of c by themselves. *)
Definition restrict S c : multichannel R #|c| p q :=
  Multichannel (principal (mcA S) c) (fun i => rowsub enum_val (mcB S i)) (fun i => colsub enum_val (mcC S i)).

Lemma closed_loop_restrict S c (F : gains R p q) : closed_loop (restrict S c) F = principal (closed_loop S F) c.
Proof.
apply/matrixP=> a b; rewrite !mxE !summxE; congr (_ + _); apply: eq_bigr => i _.
rewrite !mxE; apply: eq_bigr => v _; rewrite !mxE; congr (_ * _).
by apply: eq_bigr => u _; rewrite !mxE.
Qed.

(* No arc b -> a goes down. *)
Record triangular S (block : 'I_n -> nat) : Prop := Triangular {
  tr_state : forall a b, mcA S a b != 0 -> (block a <= block b)%N;
  tr_channel : forall i a b u v, mcB S i a u != 0 -> mcC S i v b != 0 -> (block a <= block b)%N }.

Variables (S : multichannel R n p q) (block : 'I_n -> nat) (r : nat).
Hypotheses (tri : triangular S block) (few : forall a, (block a < r)%N).
Notation part k := (restrict S [set a | block a == k]).

Lemma closed_loop_triangular (F : gains R p q) a b : (block b < block a)%N -> closed_loop S F a b = 0.
Proof.
rewrite ltnNge => ba; rewrite /closed_loop mxE.
rewrite [X in X + _](_ : _ = 0) ?add0r; last by apply/eqP; apply: contraNT ba; apply: tr_state.
rewrite summxE big1// => i _; rewrite mxE big1// => v _.
have [->|Cv] := eqVneq (mcC S i v b) 0; first by rewrite mulr0.
rewrite mxE big1 ?mul0r// => u _.
have [->|Bu] := eqVneq (mcB S i a u) 0; first by rewrite mul0r.
by case/negP: ba; apply: tr_channel Bu Cv.
Qed.

(* Rule "blocks": det(xI - A_F) is the product of those of the blocks, for every F. *)
Theorem block_spectrum (F : gains R p q) :
  char_poly (closed_loop S F) = \prod_(k < r) char_poly (closed_loop (part k) F).
Proof.
rewrite {1}/char_poly (det_blocks few) => [|a b ba].
  apply: eq_bigr => k _; rewrite /char_poly closed_loop_restrict; congr (\det _).
  by apply/matrixP=> a b; rewrite !mxE (inj_eq enum_val_inj).
rewrite /char_poly_mx mxE [X in X + _]mxE [X in _ + X]mxE [X in - X]mxE closed_loop_triangular// polyC0 subr0.
by case: eqVneq ba => [->|]; rewrite ?ltnn ?mulr0n.
Qed.

(* The gains that each block would like, at once. *)
Lemma block_gains (G : 'I_r -> gains R p q) : exists F : gains R p q,
  forall k : 'I_r, closed_loop (part k) F = closed_loop (part k) (G k).
Proof.
pose active k i := (mcB (part k) i != 0) && (mcC (part k) i != 0).
have once k k' i : active k i -> active k' i -> k = k'.
  move=> /andP[/matrix0Pn[a [u Bu]] /matrix0Pn[v [b Cv]]] /andP[/matrix0Pn[a' [u' Bu']] /matrix0Pn[v' [b' Cv']]].
  rewrite !mxE in Bu Cv Bu' Cv'.
  have /[!inE]/eqP ea := enum_valP a; have /[!inE]/eqP eb := enum_valP b.
  have /[!inE]/eqP ea' := enum_valP a'; have /[!inE]/eqP eb' := enum_valP b'.
  have := tr_channel tri Bu Cv'; have := tr_channel tri Bu' Cv; rewrite ea eb ea' eb' => k'k kk'.
  by apply/eqP; rewrite eqn_leq kk' k'k.
pose F i := if [pick k : 'I_r | active k i] is Some k then G k i else 0.
exists F => k; rewrite /closed_loop; congr (_ + _); apply: eq_bigr => i _.
have [ki|] := boolP (active k i); last first.
  by rewrite /active negb_and !negbK => /orP[]/eqP->; rewrite ?mul0mx ?mulmx0.
rewrite /F; case: pickP => [k' k'i|/(_ k)]; last by rewrite ki.
by have /val_inj-> := once _ _ _ k'i ki.
Qed.
End Blocks.

(* The blocks may be taken before or after the field is extended. *)
Lemma restrict_map (R R' : comRingType) (f : {rmorphism R -> R'}) n m (p q : 'I_m -> nat)
    (S : multichannel R n p q) c (F : gains R' p q) :
  closed_loop (map_system f (restrict S c)) F = closed_loop (restrict (map_system f S) c) F.
Proof.
rewrite /closed_loop /= /principal map_mxsub; congr (_ + _); apply: eq_bigr => i _.
by rewrite !map_mxsub.
Qed.

Lemma fixed_polynomial_restrict (K L : fieldType) (f : {rmorphism K -> L}) n m (p q : 'I_m -> nat)
    (S : multichannel K n p q) c phi :
  fixed_polynomial (map_system f (restrict S c)) phi -> fixed_polynomial (restrict (map_system f S) c) phi.
Proof. by apply: fixed_polynomial_same => F; apply: restrict_map. Qed.

Lemma bounded_restrict (K L : fieldType) (f : {rmorphism K -> L}) n m (p q : 'I_m -> nat)
    (S : multichannel K n p q) c d : bounded (map_system f (restrict S c)) d -> bounded (restrict (map_system f S) c) d.
Proof. by apply: bounded_loops => F; exists F; rewrite restrict_map. Qed.

Lemma triangular_map (K L : fieldType) (f : {rmorphism K -> L}) n m (p q : 'I_m -> nat)
    (S : multichannel K n p q) block : triangular S block -> triangular (map_system f S) block.
Proof.
case=> ta tc; split=> [a b|i a b u v]; rewrite !mxE !fmorph_eq0; [exact: ta | exact: tc].
Qed.

Section Fixed.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Variables (block : 'I_n -> nat) (r : nat).
Hypotheses (tri : triangular S block) (few : forall a, (block a < r)%N).
Notation part k := (restrict S [set a | block a == k]).

(* The fixed polynomial is the product of those of the blocks, multiplicities included, over every field. *)
Theorem block_fixed_polynomial (phi : 'I_r -> {poly K}) :
  (forall k : 'I_r, fixed_polynomial (part k) (phi k)) -> fixed_polynomial S (\prod_k phi k).
Proof.
move=> gr; have [dv top] := greatest_product (fun=> fun=> 0) gr.
split=> [F|D dvD]; first by rewrite (block_spectrum tri few); apply: (dv (fun=> F)).
apply: top => G; have [F FG] := block_gains tri G.
have -> : \prod_(k < r) char_poly (closed_loop (part k) (G k)) = char_poly (closed_loop S F); last exact: dvD.
by rewrite (block_spectrum tri few); apply: eq_bigr => k _; rewrite FG.
Qed.

(* Bounds for the blocks add up, whatever each of them rests on. *)
Theorem block_bounded (L : 'I_r -> nat) : (forall k : 'I_r, bounded (part k) (L k)) -> bounded S (\sum_k L k).
Proof.
move=> bd; have [g gP] := fin_all_exists bd; have g0 k : g k != 0 by case: (gP k).
exists (\prod_k g k); split; first by apply/prodf_neq0 => k _.
  have top : dominated (fun G : 'I_r -> gains K p q => \prod_(k < r) char_poly (closed_loop (part k) (G k))) (\prod_k g k).
    have each (k : 'I_r) : dominated (fun G : gains K p q => char_poly (closed_loop (part k) G)) (g k) by case: (gP k).
    exact: (dominated_product (fun=> fun=> 0) each).
  move=> D dv; apply: top => G; have [F FG] := block_gains tri G.
  suff -> : \prod_(k < r) char_poly (closed_loop (part k) (G k)) = char_poly (closed_loop S F) by apply: dv.
  by rewrite (block_spectrum tri few); apply: eq_bigr => k _; rewrite FG.
have := size_char_poly (closed_loop S (fun=> 0)); rewrite (block_spectrum tri few) size_prod => [<-|k _]; last first.
  by rewrite monic_neq0 ?char_poly_monic.
rewrite size_prod// !cardT /= size_enum_ord.
have : (\sum_(k < r) (size (g k) + L k) <= \sum_(k < r) size (char_poly (closed_loop (part k) (fun=> 0%R))))%N.
  by apply: leq_sum => k _; rewrite size_char_poly; case: (gP k).
have few' : (r <= \sum_(k < r) size (g k))%N.
  by rewrite -[X in (X <= _)%N]card_ord -sum1_card; apply: leq_sum => k _; rewrite lt0n size_poly_eq0.
rewrite big_split /= => total; rewrite addnBAC ?(leqW few')//.
by rewrite leq_sub2r// addSn ltnS.
Qed.

(* What is fixed for a block is fixed for the plant. *)
Theorem block_fixed (k : 'I_r) lambda : fixed (part k) lambda -> fixed S lambda.
Proof.
move=> fx F; rewrite eigenvalue_root_char (block_spectrum tri few) (bigD1 k)//= rootM.
by rewrite -eigenvalue_root_char fx.
Qed.

(* What is fixed for no block is not fixed for the plant. *)
Theorem block_absence lambda : (forall k : 'I_r, ~ fixed (part k) lambda) -> ~ fixed S lambda.
Proof.
move=> none fx; pose f (k : 'I_r) (G : gains K p q) := char_poly (closed_loop (part k) G).
have stage (s : seq 'I_r) : forall G : 'I_r -> gains K p q, uniq s -> root (\prod_(k | k \notin s) f k (G k)) lambda.
  elim: s => [G _|j s IH G /andP[js us]].
    have [F FG] := block_gains tri G.
    have -> : \prod_(k | k \notin [::]) f k (G k) = char_poly (closed_loop S F).
      by rewrite (block_spectrum tri few); apply: eq_bigr => k _; rewrite /f FG.
    by rewrite -eigenvalue_root_char; apply: fx.
  apply: contraT => nr; case: (none j) => v; rewrite eigenvalue_root_char -/(f j v).
  pose G' := @exchange _ (fun=> gains K p q) G j v.
  have := IH G' us; rewrite (bigD1 j)//= {1}/G' exchange_same rootM.
  have -> : \prod_(k | (k \notin s) && (k != j)) f k (G' k) = \prod_(k | k \notin j :: s) f k (G k).
    apply: eq_big => [k|k /andP[_ kj]]; first by rewrite inE negb_or andbC.
    by rewrite /G' exchange_other.
  by rewrite (negPf nr) orbF.
have := stage (enum 'I_r) (fun=> fun=> 0) (enum_uniq _); rewrite big_pred0 ?(negPf (root1 _))// => k.
by rewrite mem_enum.
Qed.
End Fixed.
