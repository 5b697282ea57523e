(* checker/performance.py: kind `cost_bound`, where the bounds of groups of agents add up.

   A group acts on nobody outside of it.  So the loop of its own parts of the plant and of the controller is a loop of the
   plant restricted to the group, and the covariance under the group's own disturbances is that of this loop, 0 elsewhere.
   The covariance is linear in the intensities. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import location stability instability positive_forms performance cost_bound.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Groups.
Variable C : numClosedFieldType.
Local Notation "X ^H" := (adjoint X) (at level 2, format "X ^H").

Lemma adj_sum (I : Type) (s : seq I) a b (X : I -> 'M[C]_(a, b)) : (\sum_(i <- s) X i)^H = \sum_(i <- s) (X i)^H.
Proof. by elim: s => [|i s IH]; rewrite ?big_nil ?adj0// !big_cons adjD IH. Qed.
Lemma psd_sum (I : finType) n (X : I -> 'M[C]_n) : (forall i, psd (X i)) -> psd (\sum_i X i).
Proof. by move=> p; apply: big_ind => //; [exact: psd0 | exact: psdD]. Qed.

(* A matrix M, and smaller ones that it contains: M J = J M'. *)
Section Superposition.
Variables (N r : nat) (M X I H : 'M[C]_N) (m : 'I_r -> nat) (J : forall l, 'M[C]_(N, m l)).
Variables (M' I' X' : forall l, 'M[C]_(m l)).
Hypotheses (one : forall l, (J l)^H *m J l = 1%:M) (inner : forall l, M *m J l = J l *m M' l).
Hypotheses (pI' : forall l, psd (I' l)) (rest : psd (I - \sum_l J l *m I' l *m (J l)^H)) (pH : psd H).

Lemma inner_eigenvalue l lambda : eigenvalue (M' l) lambda -> eigenvalue M lambda.
Proof.
move=> /right_eigenvector[v nv e]; have nJ : J l *m v != 0.
  by apply: contra nv => /eqP z; rewrite -[v]mul1mx -(one l) -mulmxA z mulmx0.
have eJ : M^H^H *m (J l *m v) = lambda *: (J l *m v) by rewrite adjK mulmxA inner -mulmxA e scalemxAr.
have /right_eigenvector[w nw ew] := adjoint_eigenvalue nJ eJ.
by have := adjoint_eigenvalue nw ew; rewrite conjCK.
Qed.

Lemma padded l (Y : 'M[C]_(m l)) : M *m (J l *m Y *m (J l)^H) = J l *m (M' l *m Y) *m (J l)^H.
Proof. by rewrite !mulmxA inner. Qed.
Lemma padded_adj l (Y : 'M[C]_(m l)) : J l *m Y *m (J l)^H *m M^H = J l *m (Y *m (M' l)^H) *m (J l)^H.
Proof. by rewrite -!mulmxA -adjM inner adjM. Qed.

Lemma parts_psd : psd I.
Proof. by rewrite -[I](subrK (\sum_l J l *m I' l *m (J l)^H)); apply: psdD => //; apply: psd_sum => l; apply: psd_of. Qed.

Lemma parts_trace Z : psd Z -> X = \sum_l J l *m X' l *m (J l)^H + Z ->
  \sum_l \tr ((J l)^H *m H *m J l *m X' l) <= \tr (H *m X).
Proof.
move=> pZ ->; rewrite mulmxDr mxtraceD mulmx_sumr raddf_sum /=.
have -> : \sum_l \tr ((J l)^H *m H *m J l *m X' l) = \sum_i \tr (H *m (J i *m X' i *m (J i)^H)).
  by apply: eq_bigr => l _; rewrite trace_around.
by rewrite ler_addl psd_trace.
Qed.

Theorem parts_continuous : stable_continuous M -> M *m X + X *m M^H + I = 0 ->
  (forall l, M' l *m X' l + X' l *m (M' l)^H + I' l = 0) ->
  \sum_l \tr ((J l)^H *m H *m J l *m X' l) <= \tr (H *m X).
Proof.
move=> st eX eX'; have [Z [eZ pZ _]] := covariance_continuous st rest.
apply: (parts_trace pZ); have [Y [_ _ un]] := covariance_continuous st parts_psd.
rewrite (un _ eX); symmetry; apply: un; set G := \sum_l J l *m X' l *m (J l)^H.
have eG : M *m G + G *m M^H = - \sum_l J l *m I' l *m (J l)^H.
  rewrite mulmx_sumr mulmx_suml -big_split -sumrN; apply: eq_bigr => l _ /=.
  rewrite padded padded_adj -mulmxDl -mulmxDr; move/eqP: (eX' l); rewrite addr_eq0 => /eqP ->.
  by rewrite mulmxN mulNmx.
have {}eZ : M *m Z + Z *m M^H = - (I - \sum_l J l *m I' l *m (J l)^H) by apply/eqP; rewrite -addr_eq0 eZ.
by rewrite mulmxDr mulmxDl addrACA eG eZ opprB addrA addNr add0r addNr.
Qed.

Theorem parts_discrete : stable_discrete M -> X = M *m X *m M^H + I ->
  (forall l, X' l = M' l *m X' l *m (M' l)^H + I' l) ->
  \sum_l \tr ((J l)^H *m H *m J l *m X' l) <= \tr (H *m X).
Proof.
move=> st eX eX'; have [Z [eZ pZ _]] := covariance_discrete st rest.
apply: (parts_trace pZ); have [Y [_ _ un]] := covariance_discrete st parts_psd.
rewrite (un _ eX); symmetry; apply: un; set G := \sum_l J l *m X' l *m (J l)^H.
have eG : G = M *m G *m M^H + \sum_l J l *m I' l *m (J l)^H.
  rewrite mulmx_sumr mulmx_suml -big_split; apply: eq_bigr => l _ /=.
  rewrite padded padded_adj -mulmxDl -mulmxDr; congr (_ *m _ *m _); exact: eX'.
rewrite {1}eG {1}eZ mulmxDr mulmxDl addrACA; congr (_ + _).
by rewrite addrC subrK.
Qed.
End Superposition.

(* Parts of the plant and of the controller, each with an owner; an edge from j to i wherever something of j enters
   something of i. *)
Section Owners.
Variables (T : finType) (edge : rel T) (G : {set T}).
Hypothesis closed : forall j i, edge j i -> j \in G -> i \in G.

Definition along a b (o : 'I_a -> T) (o' : 'I_b -> T) (X : 'M[C]_(a, b)) :=
  forall i j, X i j != 0 -> o' j = o i \/ edge (o' j) (o i).
Definition owned a (o : 'I_a -> T) := [set i | o i \in G].
Definition chosen a (o : 'I_a -> T) : 'M[C]_(a, #|owned o|) := \matrix_(i, j) (i == enum_val j)%:R.
Definition restricted a b (o : 'I_a -> T) (o' : 'I_b -> T) X := (chosen o)^H *m X *m chosen o'.

Lemma chosen_adj a (o : 'I_a -> T) b (X : 'M[C]_(a, b)) l j : ((chosen o)^H *m X) l j = X (enum_val l) j.
Proof.
rewrite mxE (bigD1 (enum_val l))//= big1 ?addr0 => [|i ne]; first by rewrite !mxE eqxx conjC_nat mul1r.
by rewrite !mxE (negPf ne) conjC_nat mul0r.
Qed.
Lemma chosen_mul a (o : 'I_a -> T) b (X : 'M[C]_(b, a)) i l : (X *m chosen o) i l = X i (enum_val l).
Proof.
rewrite mxE (bigD1 (enum_val l))//= big1 ?addr0 => [|j ne]; first by rewrite !mxE eqxx mulr1.
by rewrite !mxE (negPf ne) mulr0.
Qed.
Lemma chosen_one a (o : 'I_a -> T) : (chosen o)^H *m chosen o = 1%:M.
Proof. by apply/matrixP => l j; rewrite chosen_adj !mxE (inj_eq enum_val_inj). Qed.

Lemma chosen_all a (o : 'I_a -> T) b (Y : 'M[C]_(a, b)) : (forall i j, i \notin owned o -> Y i j = 0) ->
  chosen o *m ((chosen o)^H *m Y) = Y.
Proof.
move=> zero; apply/matrixP => i j; rewrite mxE; have [io|no] := boolP (i \in owned o).
  rewrite (bigD1 (enum_rank_in io i))//= big1 ?addr0 => [|l ne].
    by rewrite chosen_adj mxE enum_rankK_in// eqxx mul1r.
  rewrite mxE; case: eqP => [e|_]; last by rewrite mul0r.
  by case/eqP: ne; apply: enum_val_inj; rewrite enum_rankK_in.
rewrite zero// big1// => l _; rewrite mxE; case: eqP => [e|_]; last by rewrite mul0r.
by case/negP: no; rewrite e enum_valP.
Qed.

(* What a group acts on is in the group. *)
Lemma stays a b (o : 'I_a -> T) (o' : 'I_b -> T) X : along o o' X -> X *m chosen o' = chosen o *m restricted o o' X.
Proof.
move=> al; rewrite /restricted -[_^H *m X *m _]mulmxA chosen_all// => i l no; rewrite chosen_mul.
apply/eqP/negPn/negP => /al h; case/negP: no; rewrite inE; have := enum_valP l; rewrite inE => g.
by case: h => [<-//|/closed]; apply.
Qed.
End Owners.

(* The costs of the small loops add up to at most that of the whole. *)
Section Costs.
Variables (N n p r : nat) (M X I : 'M[C]_N) (x : 'M[C]_(n, N)) (u : 'M[C]_(p, N)) (Q : 'M[C]_n) (R : 'M[C]_p).
Variables (m n' p' : 'I_r -> nat) (J : forall l, 'M[C]_(N, m l)) (M' I' : forall l, 'M[C]_(m l)).
Variables (Sx : forall l, 'M[C]_(n, n' l)) (Su : forall l, 'M[C]_(p, p' l)).
Variables (x' : forall l, 'M[C]_(n' l, m l)) (u' : forall l, 'M[C]_(p' l, m l)) (least : 'I_r -> C).
Hypotheses (one : forall l, (J l)^H *m J l = 1%:M) (inner : forall l, M *m J l = J l *m M' l).
Hypotheses (pI' : forall l, psd (I' l)) (rest : psd (I - \sum_l J l *m I' l *m (J l)^H)).
Hypotheses (pQ : psd Q) (pR : psd R) (xJ : forall l, x *m J l = Sx l *m x' l) (uJ : forall l, u *m J l = Su l *m u' l).

Lemma small_cost l (Y : 'M[C]_(m l)) : \tr ((J l)^H *m spent x u Q R *m J l *m Y) =
  \tr ((Sx l)^H *m Q *m Sx l *m (x' l *m Y *m (x' l)^H)) + \tr ((Su l)^H *m R *m Su l *m (u' l *m Y *m (u' l)^H)).
Proof.
rewrite -spent_trace; congr (\tr (_ *m Y)); rewrite /spent mulmxDr mulmxDl; congr (_ + _).
  have -> : (J l)^H *m (x^H *m Q *m x) *m J l = (x *m J l)^H *m Q *m (x *m J l) by rewrite adjM !mulmxA.
  by rewrite xJ adjM !mulmxA.
have -> : (J l)^H *m (u^H *m R *m u) *m J l = (u *m J l)^H *m R *m (u *m J l) by rewrite adjM !mulmxA.
by rewrite uJ adjM !mulmxA.
Qed.

Lemma costs_continuous : stable_continuous M -> M *m X + X *m M^H + I = 0 ->
  (forall l, stable_continuous (M' l) -> forall Y, M' l *m Y + Y *m (M' l)^H + I' l = 0 ->
    least l <= \tr ((Sx l)^H *m Q *m Sx l *m (x' l *m Y *m (x' l)^H)) +
      \tr ((Su l)^H *m R *m Su l *m (u' l *m Y *m (u' l)^H))) ->
  \sum_l least l <= \tr (Q *m (x *m X *m x^H)) + \tr (R *m (u *m X *m u^H)).
Proof.
move=> st eX h; have st' l : stable_continuous (M' l) by move=> y /(inner_eigenvalue one inner)/st.
have [X' eX'] : exists X' : forall l, 'M[C]_(m l), forall l, M' l *m X' l + X' l *m (M' l)^H + I' l = 0.
  apply: (fin_all_exists (P := fun l Y => M' l *m Y + Y *m (M' l)^H + I' l = 0)) => l.
  by have [Y [eY _ _]] := covariance_continuous (st' l) (@pI' l); exists Y.
have pH : psd (spent x u Q R) by apply: spent_psd.
have le := parts_continuous inner pI' rest pH st eX eX'.
rewrite -spent_trace; apply: le_trans le.
by apply: ler_sum => l _; rewrite small_cost; apply: h.
Qed.

Lemma costs_discrete : stable_discrete M -> X = M *m X *m M^H + I ->
  (forall l, stable_discrete (M' l) -> forall Y, Y = M' l *m Y *m (M' l)^H + I' l ->
    least l <= \tr ((Sx l)^H *m Q *m Sx l *m (x' l *m Y *m (x' l)^H)) +
      \tr ((Su l)^H *m R *m Su l *m (u' l *m Y *m (u' l)^H))) ->
  \sum_l least l <= \tr (Q *m (x *m X *m x^H)) + \tr (R *m (u *m X *m u^H)).
Proof.
move=> st eX h; have st' l : stable_discrete (M' l) by move=> y /(inner_eigenvalue one inner)/st.
have [X' eX'] : exists X' : forall l, 'M[C]_(m l), forall l, X' l = M' l *m X' l *m (M' l)^H + I' l.
  apply: (fin_all_exists (P := fun l Y => Y = M' l *m Y *m (M' l)^H + I' l)) => l.
  by have [Y [eY _ _]] := covariance_discrete (st' l) (@pI' l); exists Y.
have pH : psd (spent x u Q R) by apply: spent_psd.
have le := parts_discrete inner pI' rest pH st eX eX'.
rewrite -spent_trace; apply: le_trans le.
by apply: ler_sum => l _; rewrite small_cost; apply: h.
Qed.
End Costs.

Lemma sum_block (I : finType) a b (X : I -> 'M[C]_a) (Y : I -> 'M[C]_b) :
  \sum_i block_mx (X i) 0 0 (Y i) = block_mx (\sum_i X i) 0 0 (\sum_i Y i).
Proof.
elim/big_rec3: _ => [|i z y' z' _ ->]; first by rewrite -[RHS]/(block_mx 0 0 0 0) block_mx0.
by rewrite add_block_mx !addr0.
Qed.

Section Sum.
Variables (T : finType) (edge : rel T) (n p q k r : nat).
Variables (ox : 'I_n -> T) (ou : 'I_p -> T) (oy : 'I_q -> T) (oz : 'I_k -> T).
Variables (A : 'M[C]_n) (B : 'M[C]_(n, p)) (Cy : 'M[C]_(q, n)).
Variables (K : 'M[C]_k) (L : 'M[C]_(k, q)) (H : 'M[C]_(p, k)) (D : 'M[C]_(p, q)).
Hypotheses (aA : along edge ox ox A) (aB : along edge ox ou B) (aC : along edge oy ox Cy).
Hypotheses (aK : along edge oz oz K) (aL : along edge oz oy L) (aH : along edge ou oz H) (aD : along edge ou oy D).
Variables (Q W : 'M[C]_n) (R : 'M[C]_p) (V : 'M[C]_q) (omega : C).
Hypotheses (pQ : psd Q) (pR : psd R).
(* The groups, with their shares of the disturbances and of the noise, and their certificates. *)
Variable G : 'I_r -> {set T}.
Hypothesis closed : forall l j i, edge j i -> j \in G l -> i \in G l.
Local Notation on o l := #|owned (G l) o|.
Variables (W' : forall l, 'M[C]_(on ox l)) (V' : forall l, 'M[C]_(on oy l)).
Variables (P' S' : forall l, 'M[C]_(on ox l)) (F' : forall l, 'M[C]_(on ou l, on ox l)) (Rs' : forall l, 'M[C]_(on ou l)).
Local Notation Sx l := (chosen (G l) ox). Local Notation Su l := (chosen (G l) ou).
Local Notation Sy l := (chosen (G l) oy). Local Notation Sz l := (chosen (G l) oz).
Local Notation within := (fun l => restricted (G l)).
Hypotheses (pW' : forall l, psd (W' l)) (pV' : forall l, psd (V' l)) (hS' : forall l, (S' l)^H = S' l).
Hypotheses (pRs' : forall l, psd (Rs' l)).
Hypotheses (restW : psd (W - \sum_l Sx l *m W' l *m (Sx l)^H)) (restV : psd (V - \sum_l Sy l *m V' l *m (Sy l)^H)).

Lemma move_in l a b (o : 'I_a -> T) (o' : 'I_b -> T) (X : 'M[C]_(a, b)) : along edge o o' X ->
  X *m chosen (G l) o' = chosen (G l) o *m restricted (G l) o o' X.
Proof. by move=> al; apply: (stays (closed (l := l))). Qed.

Lemma move_two l a b c (o : 'I_a -> T) (o' : 'I_b -> T) (o2 : 'I_c -> T) (X : 'M[C]_(a, b)) (Y : 'M[C]_(b, c)) :
  along edge o o' X -> along edge o' o2 Y -> X *m Y *m chosen (G l) o2 =
  chosen (G l) o *m (restricted (G l) o o' X *m restricted (G l) o' o2 Y).
Proof. by move=> aX aY; rewrite -mulmxA (move_in l aY) mulmxA (move_in l aX) mulmxA. Qed.

Theorem bound_by_groups_proper X : stable_continuous (loop_proper A B Cy K L H) ->
  loop_proper A B Cy K L H *m X + X *m (loop_proper A B Cy K L H)^H + noise_proper L W V = 0 ->
  (forall l, psd (first_continuous (restricted (G l) ox ox A) (restricted (G l) ox ou B) (restricted (G l) ox ox Q) (P' l)
    (restricted (G l) ou ou R) (Rs' l) (F' l))) ->
  (forall l, psd (second_proper (restricted (G l) ox ox A) (restricted (G l) oy ox Cy) (W' l) (V' l) (S' l))) ->
  \sum_l (\tr (P' l *m W' l) + \tr ((F' l)^H *m Rs' l *m F' l *m S' l)) <=
  \tr (Q *m (state_proper C n k *m X *m (state_proper C n k)^H)) +
    \tr (R *m (inputs_proper n H *m X *m (inputs_proper n H)^H)).
Proof.
move=> st eX p1 p2.
pose J l : 'M[C]_(n + k, on ox l + on oz l) := block_mx (Sx l) 0 0 (Sz l).
apply: (costs_continuous (J := J) (M' := fun l => loop_proper (restricted (G l) ox ox A) (restricted (G l) ox ou B)
  (restricted (G l) oy ox Cy) (restricted (G l) oz oz K) (restricted (G l) oz oy L) (restricted (G l) ou oz H))
  (I' := fun l => noise_proper (restricted (G l) oz oy L) (W' l) (V' l)) (Sx := fun l => Sx l) (Su := fun l => Su l)
  (x' := fun l => state_proper C _ _) (u' := fun l => inputs_proper _ (restricted (G l) ou oz H))
  _ _ _ _ pQ pR _ _ st eX) => l.
- by rewrite /J adj_block !adj0 mulmx_block !(mulmx0, mul0mx, addr0, add0r) !chosen_one -scalar_mx_block.
- rewrite /J /loop_proper !mulmx_block !(mulmx0, mul0mx, addr0, add0r).
  by rewrite (move_in l aA) (move_two l aB aH) (move_two l aL aC) (move_in l aK).
- by apply: psd_blocks; [apply: pW' | apply/psd_of/pV'].
- have -> : noise_proper L W V - \sum_l J l *m noise_proper (restricted (G l) oz oy L) (W' l) (V' l) *m (J l)^H =
      block_mx (W - \sum_l Sx l *m W' l *m (Sx l)^H) 0 0 (L *m (V - \sum_l Sy l *m V' l *m (Sy l)^H) *m L^H).
    rewrite (eq_bigr (fun l => block_mx (Sx l *m W' l *m (Sx l)^H) 0 0 (L *m (Sy l *m V' l *m (Sy l)^H) *m L^H))) => [|i _].
      rewrite sum_block /noise_proper opp_block_mx add_block_mx !oppr0 !addr0 mulmxBr mulmxBl.
      by rewrite mulmx_sumr mulmx_suml.
    rewrite /J /noise_proper adj_block !adj0 !mulmx_block !(mulmx0, mul0mx, addr0, add0r) !mulmxA.
    have -> : L *m Sy i *m V' i *m (Sy i)^H *m L^H = L *m Sy i *m V' i *m (L *m Sy i)^H by rewrite adjM !mulmxA.
    by rewrite (move_in i aL) adjM !mulmxA.
  by apply: psd_blocks => //; apply: psd_of.
- by rewrite /J mul_row_block mul_mx_row !(mulmx0, mul0mx, addr0, add0r) mul1mx mulmx1.
- by rewrite /J mul_row_block mul_mx_row !(mulmx0, mul0mx, addr0, add0r) (move_in l aH).
move=> st' Y eY.
exact: (bound_proper (@pW' l) (@pV' l) (hS' l) (@pRs' l) st' eY (p1 l) (p2 l)).
Qed.

Lemma move_three l a b c d (o : 'I_a -> T) (o' : 'I_b -> T) (o2 : 'I_c -> T) (o3 : 'I_d -> T) (X : 'M[C]_(a, b)) (Y : 'M[C]_(b, c))
    (Z : 'M[C]_(c, d)) : along edge o o' X -> along edge o' o2 Y -> along edge o2 o3 Z -> X *m Y *m Z *m chosen (G l) o3 =
  chosen (G l) o *m (restricted (G l) o o' X *m restricted (G l) o' o2 Y *m restricted (G l) o2 o3 Z).
Proof. by move=> aX aY aZ; rewrite -mulmxA (move_in l aZ) mulmxA (move_two l aX aY) -mulmxA. Qed.

Theorem bound_by_groups_continuous X : 0 < omega -> stable_continuous (loop_filtered A B Cy K L H D omega) ->
  loop_filtered A B Cy K L H D omega *m X + X *m (loop_filtered A B Cy K L H D omega)^H + noise_filtered k W V omega = 0 ->
  (forall l, psd (first_continuous (restricted (G l) ox ox A) (restricted (G l) ox ou B) (restricted (G l) ox ox Q) (P' l)
    (restricted (G l) ou ou R) (Rs' l) (F' l))) ->
  (forall l, psd (second_filtered (restricted (G l) ox ox A) (restricted (G l) oy ox Cy) (W' l) (V' l) (S' l) omega)) ->
  \sum_l (\tr (P' l *m W' l) + \tr ((F' l)^H *m Rs' l *m F' l *m S' l)) <=
  \tr (Q *m (state_filtered C n q k *m X *m (state_filtered C n q k)^H)) +
    \tr (R *m (inputs_filtered Cy H D *m X *m (inputs_filtered Cy H D)^H)).
Proof.
move=> o0 st eX p1 p2; have oo : 0 <= omega ^+ 2 by rewrite exprn_ge0// ltW.
pose J l : 'M[C]_(n + q + k, on ox l + on oy l + on oz l) := block_mx (block_mx (Sx l) 0 0 (Sy l)) 0 0 (Sz l).
apply: (costs_continuous (J := J) (M' := fun l => loop_filtered (restricted (G l) ox ox A) (restricted (G l) ox ou B)
  (restricted (G l) oy ox Cy) (restricted (G l) oz oz K) (restricted (G l) oz oy L) (restricted (G l) ou oz H)
  (restricted (G l) ou oy D) omega)
  (I' := fun l => noise_filtered _ (W' l) (V' l) omega) (Sx := fun l => Sx l) (Su := fun l => Su l)
  (x' := fun l => state_filtered C _ _ _)
  (u' := fun l => inputs_filtered (restricted (G l) oy ox Cy) (restricted (G l) ou oz H) (restricted (G l) ou oy D))
  _ _ _ _ pQ pR _ _ st eX) => l.
- rewrite /J !adj_block !adj0 !mulmx_block !(mulmx0, mul0mx, addr0, add0r) !chosen_one.
  by rewrite -!scalar_mx_block.
- rewrite /J /loop_filtered !mulmx_block !(mulmx0, mul0mx, addr0, add0r) [col_mx _ _ *m _]mul_col_mx mul_block_col.
  rewrite !(mulmx0, mul0mx, addr0, add0r) mul_row_block mul_mx_row !(mulmx0, mul0mx, addr0, add0r).
  rewrite mulmxDl mulmxDr (move_in l aA) (move_three l aB aD aC).
  rewrite (move_two l aB aD) (move_two l aB aH) (move_two l aL aC) (move_in l aL) (move_in l aK).
  by rewrite mulNmx mulmxN mul_scalar_mx mul_mx_scalar.
- by apply: psd_corner; apply: psd_blocks; [apply: pW' | apply: psdZ].
- have -> : noise_filtered k W V omega - \sum_l J l *m noise_filtered _ (W' l) (V' l) omega *m (J l)^H =
      block_mx (block_mx (W - \sum_l Sx l *m W' l *m (Sx l)^H) 0 0
        (omega ^+ 2 *: (V - \sum_l Sy l *m V' l *m (Sy l)^H))) 0 0 0.
    rewrite (eq_bigr (fun l => block_mx (block_mx (Sx l *m W' l *m (Sx l)^H) 0 0 (omega ^+ 2 *: (Sy l *m V' l *m (Sy l)^H))) 0 0 0)) => [|i _].
      rewrite sum_block sum_block /noise_filtered !opp_block_mx !add_block_mx !oppr0 !addr0 scalerBr scaler_sumr.
      by rewrite big1_eq subrr.
    rewrite /J /noise_filtered !adj_block !adj0 !mulmx_block !(mulmx0, mul0mx, addr0, add0r) !mulmx_block.
    by rewrite !(mulmx0, mul0mx, addr0, add0r) -scalemxAr -scalemxAl.
  by apply: psd_corner; apply: psd_blocks => //; apply: psdZ.
- rewrite /J /state_filtered !mul_row_block !mul_mx_row !(mulmx0, mul0mx, addr0, add0r).
  by rewrite mul1mx mulmx1.
- rewrite /J /inputs_filtered !mul_row_block !mul_mx_row !(mulmx0, mul0mx, addr0, add0r).
  by rewrite (move_two l aD aC) (move_in l aD) (move_in l aH).
move=> st' Y eY.
exact: (bound_continuous (@pW' l) (@pV' l) (hS' l) (@pRs' l) o0 st' eY (p1 l) (p2 l)).
Qed.

Theorem bound_by_groups_discrete X : stable_discrete (loop_discrete A B Cy K L H D) ->
  X = loop_discrete A B Cy K L H D *m X *m (loop_discrete A B Cy K L H D)^H + noise_discrete B L D W V ->
  (forall l, psd (first_discrete (restricted (G l) ox ox A) (restricted (G l) ox ou B) (restricted (G l) ox ox Q) (P' l)
    (restricted (G l) ou ou R) (Rs' l) (F' l))) ->
  (forall l, psd (second_discrete (restricted (G l) ox ox A) (restricted (G l) oy ox Cy) (W' l) (V' l) (S' l))) ->
  \sum_l (\tr (P' l *m W' l) + \tr ((F' l)^H *m Rs' l *m F' l *m S' l)) <=
  \tr (Q *m (state_proper C n k *m X *m (state_proper C n k)^H)) +
    \tr (R *m (inputs_discrete Cy H D *m X *m (inputs_discrete Cy H D)^H + D *m V *m D^H)).
Proof.
move=> st eX p1 p2; rewrite mulmxDr mxtraceD addrA.
pose D' l := restricted (G l) ou oy D; pose R' l := restricted (G l) ou ou R.
have noise : \sum_l \tr (R' l *m (D' l *m V' l *m (D' l)^H)) <= \tr (R *m (D *m V *m D^H)).
  have -> : \sum_l \tr (R' l *m (D' l *m V' l *m (D' l)^H)) =
      \tr (R *m (D *m (\sum_l Sy l *m V' l *m (Sy l)^H) *m D^H)).
    rewrite mulmx_sumr mulmx_suml mulmx_sumr raddf_sum; apply: eq_bigr => l _ /=.
    have -> : D *m (Sy l *m V' l *m (Sy l)^H) *m D^H = (D *m Sy l) *m V' l *m (D *m Sy l)^H by rewrite adjM !mulmxA.
    by rewrite (move_in l aD) trace_around adjM -/(D' l) !mulmxA.
  by apply: psd_trace_le => //; rewrite -mulmxBl -mulmxBr; apply: psd_of.
apply: le_trans (ler_add (lexx _) noise); rewrite -ler_subl_addr -sumrB.
pose J l : 'M[C]_(n + k, on ox l + on oz l) := block_mx (Sx l) 0 0 (Sz l).
apply: (costs_discrete (J := J) (M' := fun l => loop_discrete (restricted (G l) ox ox A) (restricted (G l) ox ou B)
  (restricted (G l) oy ox Cy) (restricted (G l) oz oz K) (restricted (G l) oz oy L) (restricted (G l) ou oz H) (D' l))
  (I' := fun l => noise_discrete (restricted (G l) ox ou B) (restricted (G l) oz oy L) (D' l) (W' l) (V' l))
  (Sx := fun l => Sx l) (Su := fun l => Su l) (x' := fun l => state_proper C _ _)
  (u' := fun l => inputs_discrete (restricted (G l) oy ox Cy) (restricted (G l) ou oz H) (D' l))
  _ _ _ _ pQ pR _ _ st eX) => l.
- by rewrite /J adj_block !adj0 mulmx_block !(mulmx0, mul0mx, addr0, add0r) !chosen_one -scalar_mx_block.
- rewrite /J /loop_discrete !mulmx_block !(mulmx0, mul0mx, addr0, add0r) mulmxDl mulmxDr.
  by rewrite (move_in l aA) (move_three l aB aD aC) (move_two l aB aH) (move_two l aL aC) (move_in l aK).
- by apply: psdD; [apply: psd_corner; apply: pW' | apply: psd_of; apply: pV'].
- pose Gv : 'M[C]_(n + k, q) := col_mx (B *m D) L.
  have -> : noise_discrete B L D W V -
      \sum_l J l *m noise_discrete (restricted (G l) ox ou B) (restricted (G l) oz oy L) (D' l) (W' l) (V' l) *m (J l)^H =
      block_mx (W - \sum_l Sx l *m W' l *m (Sx l)^H) 0 0 0 + Gv *m (V - \sum_l Sy l *m V' l *m (Sy l)^H) *m Gv^H.
    rewrite (eq_bigr (fun l => block_mx (Sx l *m W' l *m (Sx l)^H) 0 0 0 + Gv *m (Sy l *m V' l *m (Sy l)^H) *m Gv^H)) => [|i _].
      rewrite big_split /= sum_block big1_eq opprD addrACA opp_block_mx add_block_mx !oppr0 !addr0; congr (_ + _).
      by rewrite mulmxBr mulmxBl mulmx_sumr mulmx_suml.
    have eG : J i *m col_mx (restricted (G i) ox ou B *m D' i) (restricted (G i) oz oy L) = Gv *m Sy i.
      by rewrite /J /Gv mul_block_col !mul0mx addr0 add0r mul_col_mx (move_two i aB aD) (move_in i aL).
    rewrite /noise_discrete mulmxDr mulmxDl; congr (_ + _).
      by rewrite /J adj_block !adj0 !mulmx_block !(mulmx0, mul0mx, addr0, add0r).
    set g := col_mx _ _ in eG *; have -> : J i *m (g *m V' i *m g^H) *m (J i)^H = (J i *m g) *m V' i *m (J i *m g)^H.
      by rewrite adjM !mulmxA.
    by rewrite eG adjM !mulmxA.
  by apply: psdD; [apply: psd_corner | apply: psd_of].
- by rewrite /J /state_proper mul_row_block mul_mx_row !(mulmx0, mul0mx, addr0, add0r) mul1mx mulmx1.
- by rewrite /J /inputs_discrete mul_row_block mul_mx_row !(mulmx0, mul0mx, addr0, add0r) (move_in l aH) (move_two l aD aC).
move=> st' Y eY; rewrite ler_subl_addr.
by have := bound_discrete (@pW' l) (@pV' l) (hS' l) (@pRs' l) st' eY (p1 l) (p2 l); rewrite mulmxDr mxtraceD addrA.
Qed.
End Sum.
End Groups.
