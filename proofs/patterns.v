(* checker/patterns.py: kind `structural_fixed_modes`, what is fixed whatever the numbers at the places of a pattern are.

   The matrix M = [x I - A, -B, 0; 0, I, -K; -C, 0, I] has the determinant char_poly (A + B K C) (det_loop).  A place of
   M at which an entry may differ from 0 is an edge from its column to its row.  Every permutation that gives a product
   other than 0 goes around cycles of these edges, and so maps every union of strong components to itself: the
   determinant splits (det_split).  Of a union of components of states alone the factor is that of x I - A; potentials
   bound from below how often x divides every product of the rest (potentials_bound).

   structural_modes    for all numbers at the places, and all gains at theirs, both divide char_poly (A + B K C)
   structural_fixed    so that their roots are fixed modes of every multi-channel system of the pattern *)
From mathcomp Require Import all_ssreflect all_fingroup all_algebra.
From mcexact Require Import multichannel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(* the principal minor of D is the determinant of this matrix, which is that of the identity elsewhere *)
Definition within (R : ringType) N (D : {set 'I_N}) (M : 'M[R]_N) : 'M[R]_N :=
  \matrix_(i, j) if (i \in D) && (j \in D) then M i j else (i == j)%:R.

(* D is a union of strong components of the graph e *)
Definition of_components N (e : rel 'I_N) (D : {set 'I_N}) :=
  forall i j, connect e i j -> connect e j i -> (i \in D) = (j \in D).

Section Split.
Variables (R : comRingType) (N : nat) (e : rel 'I_N) (D : {set 'I_N}) (M : 'M[R]_N).
Hypothesis edges : forall i j, M i j != 0 -> e j i.
Hypothesis closed : of_components e D.

Lemma permuted_within (s : 'S_N) : (forall i, M i (s i) != 0) -> forall i, (s i \in D) = (i \in D).
Proof.
move=> h i; apply: closed; first exact/connect1/edges.
have back k x : connect e ((s ^+ k)%g x) x.
  elim: k x => [|k IH] x; first by rewrite expg0 perm1.
  by rewrite expgSr permM; apply: connect_trans (IH x); apply/connect1/edges.
have {1}-> : i = ((s ^+ #[s]%g.-1)%g (s i)); last exact: back.
by rewrite -permM -expgS prednK ?order_gt0 // expg_order perm1.
Qed.

Lemma within_product i j : (within D M *m within (~: D) M) i j = if (i \in D) == (j \in D) then M i j else 0.
Proof.
rewrite mxE; have [Di|Di] := boolP (i \in D).
  have out k : k \notin D -> (i == k) = false by move=> Dk; apply/negbTE; apply: contraNneq Dk => <-.
  rewrite (bigD1 j) //= big1 ?addr0 => [|k kj]; rewrite !mxE Di !inE /=.
    by case: (boolP (j \in D)) => Dj /=; rewrite ?eqxx ?mulr1 // out // mul0r.
  by case: (boolP (k \in D)) => Dk /=; rewrite ?(negbTE kj) ?mulr0 // out // mul0r.
rewrite (bigD1 i) //= big1 ?addr0 => [|k ki]; last by rewrite !mxE (negbTE Di) /= eq_sym (negbTE ki) mul0r.
rewrite !mxE (negbTE Di) /= eqxx mul1r !inE Di /=; case: (boolP (j \in D)) => Dj //=.
by have [ij|] := eqVneq i j; rewrite // ij Dj in Di.
Qed.

(* checker: the states without feedback are a factor by themselves *)
Theorem det_split : \det M = \det (within D M) * \det (within (~: D) M).
Proof.
rewrite -det_mulmx; apply: eq_bigr => s _; congr (_ * _).
have [/forallP all|/forallPn[i /negPn/eqP Mi]] := boolP [forall i, M i (s i) != 0].
  by apply: eq_bigr => i _; rewrite within_product permuted_within // eqxx.
by rewrite (bigD1 i) //= [RHS](bigD1 i) //= within_product Mi if_same !mul0r.
Qed.
End Split.

Section Potentials.
Variables (F : fieldType) (N : nat).
Variables (M : 'M[{poly F}]_N) (v : 'I_N -> 'I_N -> nat) (r c : 'I_N -> int) (z : nat).
Hypothesis factors : forall i j, M i j != 0 -> ('X^(v i j) %| M i j) /\ (r i + c j <= (v i j)%:Z).
Hypothesis total : (z%:Z <= \sum_i r i + \sum_j c j).

(* checker: potentials below the numbers of factors x at the places bound that of every product *)
Theorem potentials_bound : 'X^z %| \det M.
Proof.
rewrite /determinant; elim/big_ind: _ => [|f g|s _]; [exact: dvdp0|exact: dvdp_add|].
rewrite dvdp_mull //.
have [/forallP all|/forallPn[i /negPn/eqP Mi]] := boolP [forall i, M i (s i) != 0]; last first.
  by rewrite (bigD1 i) //= Mi mul0r dvdp0.
have le : (z <= \sum_i v i (s i))%N.
  rewrite -lez_nat; apply: le_trans total _.
  rewrite [X in _ + X](reindex_inj (@perm_inj _ s)) /= -big_split /=.
  rewrite -(natz (\sum_i v i (s i))) natr_sum; apply: ler_sum => i _; rewrite natz.
  by case: (factors (all i)).
apply: dvdp_trans (dvdp_exp2l 'X le) _.
elim/big_rec2: _ => [|i f g _ fg]; first by rewrite expr0.
by rewrite exprD dvdp_mul //; case: (factors (all i)).
Qed.
End Potentials.

(* The matrix of a loop u = K y, and the pattern of its places. *)
Section Loop.
Variables (F : fieldType) (n p q : nat).
Implicit Types (A : 'M[F]_n) (B : 'M[F]_(n, p)) (K : 'M[F]_(p, q)) (C : 'M[F]_(q, n)).
Local Notation N := (n + (p + q))%N.
Local Notation const := (map_mx (@polyC F)).

Definition loop_matrix A B K C : 'M[{poly F}]_N :=
  block_mx (char_poly_mx A) (row_mx (- const B) 0) (col_mx 0 (- const C)) (block_mx 1%:M (- const K) 0 1%:M).

(* eliminating y = C x and u = K y *)
Definition eliminated K C : 'M[{poly F}]_N :=
  block_mx 1%:M 0 (col_mx (const K *m const C) (const C)) (block_mx 1%:M (const K) 0 1%:M).

Lemma det_loop A B K C : \det (loop_matrix A B K C) = char_poly (A + B *m K *m C).
Proof.
have one : \det (eliminated K C) = 1 by rewrite det_lblock det1 mul1r det_ublock !det1 mulr1.
rewrite -[LHS]mulr1 -[X in _ * X]one -det_mulmx /loop_matrix /eliminated mulmx_block !mulmx1 !mulmx0 ?add0r.
rewrite mul_row_col mulmx_block mul_col_mx !mulmx1 !mul1mx !mul0mx !mulmx0 ?add0r ?addr0.
rewrite !mul_row_col !mul1mx !mul0mx add0r add_col_mx add0r addNr !mulNmx subrr col_mx0.
rewrite det_ublock [X in _ * X]det_ublock !det1 !mulr1 /char_poly /char_poly_mx.
by congr (\det _); rewrite map_mxD !map_mxM /= mulmxA opprD addrA.
Qed.

(* Where A, B, K and C may have entries other than 0, and where M may besides its diagonal. *)
Definition fits k l (P : 'M[bool]_(k, l)) (M : 'M[F]_(k, l)) := forall i j, M i j != 0 -> P i j.

Definition places (PA : 'M[bool]_n) (PB : 'M[bool]_(n, p)) (PK : 'M[bool]_(p, q)) (PC : 'M[bool]_(q, n)) : 'M[bool]_N :=
  block_mx PA (row_mx PB (const_mx false)) (col_mx (const_mx false) PC)
    (block_mx (const_mx false) PK (const_mx false) (const_mx false)).

Definition state (i : 'I_N) := if split i is inl _ then true else false.

Section Modes.
Variables (PA : 'M[bool]_n) (PB : 'M[bool]_(n, p)) (PK : 'M[bool]_(p, q)) (PC : 'M[bool]_(q, n)).
Local Notation P := (places PA PB PK PC).

(* from the column to the row; the diagonal joins nothing *)
Definition pattern_edge : rel 'I_N := fun j i => (i == j) || P i j.
(* the factors x at a place: one where x stands alone *)
Definition factors_x (i j : 'I_N) : nat := (i == j) && state i && ~~ P i j.

Variables (A : 'M[F]_n) (B : 'M[F]_(n, p)) (K : 'M[F]_(p, q)) (C : 'M[F]_(q, n)).
Hypotheses (fA : fits PA A) (fB : fits PB B) (fK : fits PK K) (fC : fits PC C).
Local Notation M := (loop_matrix A B K C).

Lemma loop_places i j : M i j != 0 -> pattern_edge j i /\ 'X^(factors_x i j) %| M i j.
Proof.
rewrite /pattern_edge /factors_x /state.
case: (split_ordP i) => [a ->|k ->]; case: (split_ordP j) => [b ->|l ->].
- rewrite /loop_matrix /places !block_mxEul !mxE (inj_eq (@lshift_inj _ _)).
  have [-> _|ab h] := eqVneq a b; last by rewrite /= dvd1p fA //; apply: contraNneq h => ->; rewrite polyC0 subrr.
  rewrite /=; split=> //; case Pb: (PA b b); first exact: dvd1p.
  have -> : A b b = 0 by apply/eqP; apply: contraFT Pb; apply: fA.
  by rewrite polyC0 subr0 mulr1n expr1.
- rewrite eq_lrshift /= dvd1p /loop_matrix /places !block_mxEur => h; split=> //.
  move: h; case: (split_ordP l) => [x ->|x ->]; rewrite ?row_mxEl ?row_mxEr !mxE ?eqxx //.
  by rewrite oppr_eq0 polyC_eq0; apply: fB.
- rewrite eq_rlshift /= dvd1p /loop_matrix /places !block_mxEdl => h; split=> //.
  move: h; case: (split_ordP k) => [x ->|x ->]; rewrite ?col_mxEu ?col_mxEd !mxE ?eqxx //.
  by rewrite oppr_eq0 polyC_eq0; apply: fC.
- rewrite andbF /= dvd1p /loop_matrix /places !block_mxEdr (inj_eq (@rshift_inj _ _)) => h; split=> //.
  move: h; case: (split_ordP k) => [x ->|x ->]; case: (split_ordP l) => [y ->|y ->];
    rewrite ?block_mxEul ?block_mxEur ?block_mxEdl ?block_mxEdr !mxE.
  + by rewrite (inj_eq (@lshift_inj _ _)); have [//|_] := eqVneq x y; rewrite mulr0n eqxx.
  + by rewrite oppr_eq0 polyC_eq0 => /fK ->; rewrite orbT.
  + by rewrite eqxx.
  + by rewrite (inj_eq (@rshift_inj _ _)); have [//|_] := eqVneq x y; rewrite mulr0n eqxx.
Qed.

(* The checker's conditions: U is a union of strong components, potentials are below the factors x, and add up to z. *)
Variables (U : {set 'I_n}) (r c : 'I_N -> int) (z : nat).
Let D : {set 'I_N} := [set lshift (p + q) a | a in U].
Hypothesis closed : of_components pattern_edge D.
Hypothesis below : forall i j, i \notin D -> j \notin D -> pattern_edge j i -> r i + c j <= (factors_x i j)%:Z.
Hypothesis total : \sum_(i | i \notin D) (r i + c i) = z%:Z.

Lemma det_states : \det (within D M) = \det (within U (char_poly_mx A)).
Proof.
suff -> : within D M = block_mx (within U (char_poly_mx A)) 0 0 1%:M by rewrite det_ublock det1 mulr1.
have inl a : (lshift (p + q) a \in D) = (a \in U) by rewrite mem_imset //; apply: lshift_inj.
have inr k : (rshift n k \in D) = false by apply/negbTE/imsetP => -[a _ /eqP]; rewrite eq_rlshift.
apply/matrixP => i j; case: (split_ordP i) => [a ->|k ->]; case: (split_ordP j) => [b ->|l ->];
  rewrite ?block_mxEul ?block_mxEur ?block_mxEdl ?block_mxEdr [LHS]mxE ?inl ?inr ?andbF /=.
- by rewrite [RHS]mxE (inj_eq (@lshift_inj _ _)) /loop_matrix block_mxEul.
- by rewrite eq_lrshift mxE.
- by rewrite eq_rlshift mxE.
- by rewrite mxE (inj_eq (@rshift_inj _ _)).
Qed.

Theorem structural_modes : \det (within U (char_poly_mx A)) * 'X^z %| char_poly (A + B *m K *m C).
Proof.
rewrite -det_loop (@det_split _ _ pattern_edge D) ?det_states; last exact: closed; last first.
  by move=> i j /loop_places[].
apply: dvdp_mul => //.
pose r' i := if i \in D then 0 else r i; pose c' i := if i \in D then 0 else c i.
pose v i j := if (i \in D) || (j \in D) then 0%N else factors_x i j.
apply: (@potentials_bound _ _ _ v r' c') => [i j|].
  rewrite mxE /v /r' /c' !inE; have [Di|Di] := boolP (i \in D).
    rewrite dvd1p; case: (boolP (j \in D)) => Dj; first by rewrite addr0.
    by have [ij|_] := eqVneq i j; [rewrite -ij Di in Dj|rewrite eqxx].
  have [Dj|Dj] /= := boolP (j \in D).
    by have [ij|_] := eqVneq i j; [rewrite ij Dj in Di|rewrite eqxx].
  by move=> /loop_places[Pij ->]; split=> //; apply: below.
rewrite -total big_mkcond /= -big_split /=.
by rewrite le_eqVlt; apply/orP; left; apply/eqP/eq_bigr => i _; rewrite /r' /c'; case: ifP; case: ifP.
Qed.
End Modes.
End Loop.

(* Multi-channel systems: K has the gains of each agent for its own outputs, or for those that it receives. *)
Section Fixed.
Variables (F : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel F n p q).
Local Notation ins := (\mxrow_i mcB S i).
Local Notation outs := (\mxcol_i mcC S i).

(* E_i, which takes the outputs of channel i from all *)
Definition taken i : 'M[F]_(q i, \sum_i q i) := submxcol 1%:M i.

Lemma loop_own (f : gains F p q) : closed_loop S f = mcA S + ins *m (\mxcol_i (f i *m taken i)) *m outs.
Proof.
rewrite /closed_loop mul_mxrow_mxcol mulmx_suml; congr (_ + _); apply: eq_bigr => i _.
by rewrite -!mulmxA /taken submxcol_mul mul1mx mxcolK.
Qed.

Definition received (N : {set 'I_m}) : 'M[F]_(\sum_i q i) := \mxdiag_j (if j \in N then 1%:M else 0).

Lemma loop_received N (f : gains F p (fun=> \sum_i q i)%N) :
  closed_loop (augmented_outputs N S) f = mcA S + ins *m (\mxcol_i (f i *m received (N i))) *m outs.
Proof.
rewrite /closed_loop /= mul_mxrow_mxcol mulmx_suml; congr (_ + _); apply: eq_bigr => i _.
rewrite -!mulmxA; congr (_ *m (_ *m _)); rewrite /outputs /received mul_mxdiag_mxcol.
by apply: eq_mxcol => j; case: ifP; rewrite ?mul1mx ?mul0mx.
Qed.

Variables (PA : 'M[bool]_n) (PB : 'M[bool]_(n, \sum_i p i)) (PK : 'M[bool]_(\sum_i p i, \sum_i q i)).
Variables (PC : 'M[bool]_(\sum_i q i, n)) (U : {set 'I_n}) (r c : 'I_(n + (\sum_i p i + \sum_i q i)) -> int) (z : nat).
Hypotheses (fA : fits PA (mcA S)) (fB : fits PB ins) (fC : fits PC outs).
Let D := [set lshift (\sum_i p i + \sum_i q i) a | a in U].
Hypothesis closed : of_components (pattern_edge PA PB PK PC) D.
Hypothesis below : forall i j, i \notin D -> j \notin D -> pattern_edge PA PB PK PC j i ->
  r i + c j <= (factors_x PA PB PK PC i j)%:Z.
Hypothesis total : \sum_(i | i \notin D) (r i + c i) = z%:Z.
Variable lambda : F.
Hypothesis mode : root (\det (within U (char_poly_mx (mcA S))) * 'X^z) lambda.

Lemma mode_of_loop K : fits PK K -> eigenvalue (mcA S + ins *m K *m outs) lambda.
Proof.
move=> fK; rewrite eigenvalue_root_char.
have /dvdpP[g ->] := structural_modes fA fB fK fC closed below total.
by rewrite rootM mode orbT.
Qed.

(* each agent feeds back its own outputs *)
Theorem structural_fixed : (forall f : gains F p q, fits PK (\mxcol_i (f i *m taken i))) -> fixed S lambda.
Proof. by move=> fK f; rewrite loop_own; apply: mode_of_loop. Qed.

(* each agent feeds back the outputs of its neighbors *)
Theorem structural_fixed_received N :
  (forall f : gains F p (fun=> \sum_i q i)%N, fits PK (\mxcol_i (f i *m received (N i)))) ->
  fixed (augmented_outputs N S) lambda.
Proof. by move=> fK f; rewrite loop_received; apply: mode_of_loop. Qed.
End Fixed.
