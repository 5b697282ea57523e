(* max over F of rank(N0 - sum_i B_i F_i C_i) = min over s of rank [N0, B_{m-s}; C_s, 0],
   over every field, with gains F whose entries are natural numbers.
   Rows act as vectors: U is a row space, U *m B i is what channel i feels of it. *)
From mathcomp Require Import all_ssreflect all_algebra.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Preimage.
Variable L : fieldType.

(* the largest row space that N maps into the row space of S *)
Definition preimage k n r (N : 'M[L]_(k, n)) (S : 'M[L]_(r, n)) : 'M_k :=
  kermx (N *m cokermx S).

Lemma sub_preimage k n r t (N : 'M[L]_(k, n)) (S : 'M_(r, n)) (U : 'M_(t, k)) :
  (U <= preimage N S)%MS = (U *m N <= S)%MS.
Proof. by rewrite sub_kermx mulmxA -submxE. Qed.

Lemma rank_adds_coker r1 r2 n k (X : 'M[L]_(r1, n)) (Y : 'M_(r2, n)) (Z : 'M_(n, k)) :
  (kermx Z :=: Y)%MS -> \rank (X + Y)%MS = (\rank Y + \rank (X *m Z))%N.
Proof.
move=> kZ; have := mxrank_mul_ker X Z; have := mxrank_sum_cap X Y.
rewrite (cap_eqmx (eqmx_refl X) kZ) => e1 e2; apply/eqP.
by rewrite -(eqn_add2r (\rank (X :&: Y)%MS)) e1 -addnA e2 addnC.
Qed.

Lemma kermx_coker r n (Y : 'M[L]_(r, n)) : (kermx (cokermx Y) :=: Y)%MS.
Proof.
by apply/eqmxP/andP; split; last rewrite sub_kermx mulmx_coker //; rewrite submxE mulmx_ker.
Qed.

(* rank [N, B; C, 0] = (number of rows of N) + rank C - dim {x : x N in C, x B = 0} *)
Lemma rank_pencil k n p q (N : 'M[L]_(k, n)) (B : 'M_(k, p)) (C : 'M_(q, n)) :
  (\rank (block_mx N B C 0) + \rank (preimage N C :&: kermx B)%MS = k + \rank C)%N.
Proof.
have kZ : (kermx (block_mx (cokermx C) 0 0 1%:M : 'M_(n + p)) :=: row_mx C (0 : 'M_(q, p)))%MS.
  apply/eqmxP/andP; split; last first.
    by rewrite sub_kermx mul_row_block mulmx_coker !(mul0mx, mulmx0, addr0) row_mx0.
  apply/rV_subP => v; rewrite -[v]hsubmxK sub_kermx mul_row_block !(mulmx0, addr0, add0r) mulmx1.
  rewrite -[0](@row_mx0 _ _ n) => /eqP/eq_row_mx[/eqP]; rewrite -submxE => /submxP[D ->] ->.
  by apply/submxP; exists D; rewrite mul_mx_row mulmx0.
rewrite block_mxEv -addsmxE (rank_adds_coker _ kZ) rank_row_mx0.
rewrite mul_row_block !(mulmx0, add0r, addr0) mulmx1.
set M := row_mx _ _.
have -> : \rank (preimage N C :&: kermx B)%MS = \rank (kermx M).
  apply: eqmx_rank; apply/andP; split; apply/rV_subP => v.
    rewrite sub_capmx => /andP[]; rewrite !sub_kermx mul_mx_row => /eqP -> /eqP ->.
    by rewrite row_mx0.
  rewrite sub_capmx !sub_kermx mul_mx_row -[0](@row_mx0 _ _ n) => /eqP/eq_row_mx[-> ->].
  by rewrite !eqxx.
by rewrite mxrank_ker -addnA subnKC ?rank_leq_row // addnC.
Qed.

Lemma rank_preimage k n r (N : 'M[L]_(k, n)) (S : 'M_(r, n)) :
  (S <= N)%MS -> (\rank (preimage N S) + \rank N = k + \rank S)%N.
Proof.
move=> sSN; have := mxrank_mul_ker N (cokermx S).
rewrite (cap_eqmx (eqmx_refl N) (kermx_coker S)) => e.
have -> : \rank S = \rank (N :&: S)%MS.
  by apply: eqmx_rank; apply/andP; split; rewrite ?capmxSr // sub_capmx sSN /=.
by rewrite mxrank_ker -e addnA subnK ?rank_leq_row.
Qed.

End Preimage.

Section Repair.
Variables (L : fieldType) (I : finType) (n : nat) (p q : I -> nat).
Variables (B : forall i, 'M[L]_(n, p i)) (C : forall i, 'M[L]_(q i, n)) (N0 : 'M[L]_n).

(* gains with natural entries, and what they become over L *)
Definition natural (G : forall i, 'M[nat]_(p i, q i)) i : 'M[L]_(p i, q i) :=
  map_mx (fun k => k%:R) (G i).

Definition perturbed (F : forall i, 'M[L]_(p i, q i)) : 'M[L]_n :=
  N0 - \sum_i B i *m F i *m C i.

(* row space of C_s, column space of B_s, as square matrices *)
Definition output_space (s : {set I}) : 'M[L]_n := (\sum_(i in s) <<C i>>)%MS.
Definition input_space (s : {set I}) : 'M[L]_n := ((\sum_(i in s) <<(B i)^T>>)%MS)^T.

Definition touched m (U : 'M[L]_(m, n)) : {set I} := [set i | U *m B i != 0].

Lemma touchedS m1 m2 (U : 'M[L]_(m1, n)) (V : 'M_(m2, n)) :
  (U <= V)%MS -> touched U \subset touched V.
Proof.
case/submxP=> D ->; apply/subsetP => i; rewrite !inE; apply: contraNneq => e.
by rewrite -mulmxA e mulmx0.
Qed.

Lemma output_spaceS (s t : {set I}) : s \subset t -> (output_space s <= output_space t)%MS.
Proof.
move/subsetP => st; apply/sumsmx_subP => i /st ti.
by apply: (sumsmx_sup i).
Qed.

Lemma output_space_sup (s : {set I}) i : i \in s -> (C i <= output_space s)%MS.
Proof. by move=> si; apply: (sumsmx_sup i) => //; rewrite genmxE. Qed.

Lemma output_space_sub (s : {set I}) m (S : 'M[L]_(m, n)) :
  (forall i, i \in s -> (C i <= S)%MS) -> (output_space s <= S)%MS.
Proof. by move=> h; apply/sumsmx_subP => i /h; rewrite genmxE. Qed.

Lemma mul_input_space0 (s : {set I}) m (U : 'M[L]_(m, n)) :
  (U *m input_space s == 0) = [forall (i | i \in s), U *m B i == 0].
Proof.
apply/eqP/forallP => [e i|h].
  apply/implyP => si; apply/eqP; apply: trmx_inj; rewrite trmx_mul trmx0.
  have : ((B i)^T <= (input_space s)^T)%MS.
    by rewrite trmxK; apply: (sumsmx_sup i) => //; rewrite genmxE.
  by case/submxP=> D ->; rewrite -mulmxA -trmx_mul e trmx0 mulmx0.
apply: trmx_inj; rewrite trmx_mul trmx0 trmxK; apply/eqP; rewrite -sub_kermx.
apply/sumsmx_subP => i si; rewrite genmxE sub_kermx -trmx_mul trmx_eq0.
by have := h i; rewrite si.
Qed.

(* the Wong sequence of N *)
Fixpoint wong (N : 'M[L]_n) k : 'M[L]_n :=
  if k is k'.+1 then preimage N (output_space (touched (wong N k'))) else kermx N.

Lemma wongS N k : (wong N k <= wong N k.+1)%MS.
Proof.
elim: k => [|k IH]; rewrite sub_preimage; first by rewrite mulmx_ker sub0mx.
apply: submx_trans (output_spaceS (touchedS IH)).
by rewrite -sub_preimage.
Qed.

Lemma wong_le N j k : (j <= k)%N -> (wong N j <= wong N k)%MS.
Proof.
move/subnK => <-; elim: (k - j)%N => [|d IH] //.
exact: submx_trans IH (wongS _ _).
Qed.

(* one entry of one gain raised by one changes N into N - b c *)
Definition raise (G : forall i, 'M[nat]_(p i, q i)) i (l : 'I_(p i)) (a : 'I_(q i)) j :
  'M[nat]_(p j, q j) :=
  \matrix_(x, y) (G j x y + [&& j == i, x == l :> nat & y == a :> nat])%N.

Arguments raise G {i} l a j.

Lemma perturbed_raise G i (l : 'I_(p i)) (a : 'I_(q i)) :
  perturbed (natural (raise G l a)) =
  perturbed (natural G) - col l (B i) *m row a (C i).
Proof.
rewrite /perturbed -addrA -opprD; congr (_ - _).
rewrite (bigD1 i) //= [in RHS](bigD1 i) //= addrAC; congr (_ + _); last first.
  apply: eq_bigr => j ji; congr (_ *m _ *m _); apply/matrixP => x y; rewrite !mxE.
  by rewrite (negbTE ji) addn0.
rewrite colE rowE mulmxA -(mulmxA (B i) (delta_mx _ _)) mul_delta_mx.
rewrite -mulmxDl -mulmxDr.
congr (_ *m _ *m _); apply/matrixP => x y; rewrite !mxE eqxx natrD.
by congr (_ + _); rewrite !(inj_eq val_inj).
Qed.

(* a violation at any level of the Wong sequence raises the rank: the repair *)
Lemma repair k G N : N = perturbed (natural G) ->
  ~~ (output_space (touched (wong N k)) <= N)%MS ->
  exists G', (\rank N < \rank (perturbed (natural G')))%N.
Proof.
elim: k G N => [|k IH] G N defN; last first.
  have [okk|] := boolP (output_space (touched (wong N k)) <= N)%MS; last by move/(IH _ _ defN).
  move=> viol.
  have [i Ti Ci] : exists2 i, i \in touched (wong N k.+1) & ~~ (C i <= N)%MS.
    have [/forallP h|] :=
      boolP [forall i, (i \in touched (wong N k.+1)) ==> (C i <= N)%MS].
      by case/negP: viol; apply: output_space_sub => i Ti; have := h i; rewrite Ti.
    by rewrite negb_forall => /existsP[i]; rewrite negb_imply => /andP[Ti Ci]; exists i.
  have Wk : wong N k *m B i = 0.
    apply/eqP; apply: contraNT Ci => Wi; apply: submx_trans okk; apply: output_space_sup.
    by rewrite inE.
  case/row_subPn: Ci => a; set c := row a _ => cN.
  rewrite inE in Ti; case/matrix0Pn: Ti => j [l ujl].
  pose u := row j (wong N k.+1); pose b := col l (B i).
  have Wb : wong N k *m b = 0 by rewrite /b colE mulmxA Wk mul0mx.
  have ub : u *m b != 0.
    apply: contraNneq ujl => /matrixP/(_ 0 0); rewrite /b /u colE mulmxA -row_mul -colE.
    by rewrite !mxE => ->.
  have [N' defN'] : {N' | N' = perturbed (natural (raise G l a))} by exists (perturbed (natural (raise G l a))).
  have eN' : N' = N - b *m c by rewrite defN' perturbed_raise -defN.
  (* x N' within the row space of N forces x b = 0 *)
  have key (x : 'rV_n) : (x *m N' <= N)%MS -> x *m b = 0.
    move=> xN; apply/eqP; apply: contraNT cN => xb0.
    have : (x *m b *m c <= N)%MS.
      have -> : x *m b *m c = x *m N - x *m N' by rewrite eN' mulmxBr mulmxA subKr.
      by rewrite addmx_sub ?submxMl // eqmx_opp.
    rewrite [x *m b]mx11_scalar mul_scalar_mx => h.
    rewrite -(eqmx_scale c (_ : (x *m b) 0 0 != 0)) //.
    by apply: contraNneq xb0 => e; rewrite [x *m b]mx11_scalar e -scalemx1 scale0r.
  have rkN' : (\rank N <= \rank N')%N.
    have : (kermx N' <= kermx N)%MS.
      apply/rV_subP => x; rewrite !sub_kermx => /eqP xN'.
      have xb : x *m b = 0 by apply: key; rewrite xN' sub0mx.
      by move: xN'; rewrite eN' mulmxBr mulmxA xb mul0mx subr0 => ->.
    move/mxrankS; rewrite !mxrank_ker => h.
    by rewrite -(subKn (rank_leq_row N)) -(subKn (rank_leq_row N')) leq_sub2l.
  have WW j' : (j' <= k)%N -> (wong N j' <= wong N' j')%MS.
    have stay t : (t <= k)%N -> wong N t *m N' = wong N t *m N.
      move=> tk; case/submxP: (wong_le N tk) => D ->.
      by rewrite eN' mulmxBr (mulmxA _ b) -(mulmxA D _ b) Wb mulmx0 mul0mx subr0.
    elim: j' => [|t IHt] tk.
      by rewrite sub_kermx -/(wong N 0) stay // mulmx_ker.
    rewrite [wong N' _]/= sub_preimage stay //.
    apply: submx_trans (output_spaceS (touchedS (IHt (ltnW tk)))).
    by rewrite -sub_preimage.
  suff viol' : ~~ (output_space (touched (wong N' k)) <= N')%MS.
    by have [G' lt'] := IH _ _ defN' viol'; exists G'; apply: leq_ltn_trans lt'.
  apply: contraNN ub => ok'.
  have : (u *m N <= N')%MS.
    apply: submx_trans ok'; apply: submx_trans (output_spaceS (touchedS (WW _ (leqnn k)))).
    by rewrite -sub_preimage; apply: row_sub.
  case/submxP => v uN.
  have vb : v *m b = 0 by apply: key; rewrite -uN submxMl.
  have : (u - v <= wong N k)%MS.
    apply: submx_trans (wong_le N (leq0n k)); rewrite sub_kermx mulmxBl uN eN' mulmxBr mulmxA vb.
    by rewrite mul0mx subr0 subrr.
  by case/submxP => D /(congr1 (mulmx^~ b)); rewrite -mulmxA Wb mulmx0 mulmxBl vb subr0 => ->.
move=> viol.
have [i Ti Ci] : exists2 i, i \in touched (wong N 0) & ~~ (C i <= N)%MS.
  have [/forallP h|] :=
    boolP [forall i, (i \in touched (wong N 0)) ==> (C i <= N)%MS].
    by case/negP: viol; apply: output_space_sub => i Ti; have := h i; rewrite Ti.
  by rewrite negb_forall => /existsP[i]; rewrite negb_imply => /andP[Ti Ci]; exists i.
case/row_subPn: Ci => a; set c := row a _ => cN.
rewrite inE in Ti; case/matrix0Pn: Ti => j [l ujl].
pose u := row j (wong N 0); pose b := col l (B i).
have ub : (u *m b) 0 0 != 0.
  by apply: contraNneq ujl; rewrite /b /u colE mulmxA -row_mul -colE !mxE => ->.
have uN : u *m N = 0 by apply/eqP; rewrite -sub_kermx; apply: row_sub.
exists (raise G l a); rewrite perturbed_raise -defN -/b -/c.
have cN' : (c <= N - b *m c)%MS.
  have : (u *m (N - b *m c) <= N - b *m c)%MS by apply: submxMl.
  rewrite mulmxBr uN sub0r mulmxA [u *m b]mx11_scalar mul_scalar_mx eqmx_opp.
  by rewrite eqmx_scale.
apply: rank_ltmx; rewrite ltmxE; apply/andP; split; last first.
  by apply: contraNN cN => h; apply: submx_trans cN' h.
rewrite -{1}(subrK (b *m c) N) addmx_sub //.
exact: submx_trans (submxMl b c) cN'.
Qed.

(* the shrunk_space subspace of s: what N0 maps into C_s and no channel outside s feels *)
Definition shrunk_space (s : {set I}) : 'M[L]_n := (preimage N0 (output_space s) :&: kermx (input_space (~: s)))%MS.

Definition wong_pencil (s : {set I}) : 'M[L]_(n + n) :=
  block_mx N0 (input_space (~: s)) (output_space s) 0.

Lemma rank_pencil_shrunk_space s : (\rank (wong_pencil s) + \rank (shrunk_space s) = n + \rank (output_space s))%N.
Proof. exact: rank_pencil. Qed.

(* easy half: no gain exceeds any wong_pencil *)
Lemma rank_perturbed_le F s : (\rank (perturbed F) <= \rank (wong_pencil s))%N.
Proof.
have [Y eY] : exists Y, \sum_(i in s) B i *m F i *m C i = Y *m output_space s.
  apply/submxP; apply: summx_sub => i si.
  by apply: submx_trans (output_space_sup si); rewrite submxMl.
have [X eX] : exists X, \sum_(i in ~: s) B i *m F i *m C i = input_space (~: s) *m X.
  have : ((\sum_(i in ~: s) B i *m F i *m C i)^T <= (input_space (~: s))^T)%MS.
    rewrite linear_sum /=; apply: summx_sub => i si; rewrite trmxK -mulmxA trmx_mul.
    by apply: submx_trans (submxMl _ _) _; apply: (sumsmx_sup i) => //; rewrite genmxE.
  by case/submxP=> D /(congr1 trmx); rewrite trmxK trmx_mul trmxK => ->; exists D^T.
have -> : perturbed F = row_mx 1%:M (- Y) *m wong_pencil s *m col_mx 1%:M (- X).
  rewrite mul_row_block mul_row_col !mul1mx mulmx0 addr0 mulmx1 mulmxN mulNmx -eX -eY -addrA.
  rewrite -opprD; congr (_ - _); rewrite (bigID [pred i | i \in s]) /=; congr (_ + _).
  by apply: eq_bigl => i; rewrite inE.
exact: leq_trans (mxrankM_maxl _ _) (mxrankM_maxr _ _).
Qed.

(* when the Wong sequence of N violates nothing, its limit reaches the rank *)
Lemma wong_reaches G (N := perturbed (natural G)) :
  (forall k, (k <= n)%N -> (output_space (touched (wong N k)) <= N)%MS) ->
  exists s, (\rank (wong_pencil s) <= \rank N)%N.
Proof.
move=> ok.
have [k kn stop] : exists2 k, (k <= n)%N & (wong N k.+1 <= wong N k)%MS.
  have [/existsP[k h]|] := boolP [exists k : 'I_n.+1, (wong N k.+1 <= wong N k)%MS].
    by exists k; rewrite // -ltnS.
  rewrite negb_exists => /forallP h.
  have grow k : (k <= n.+1)%N -> (k <= \rank (wong N k))%N.
    elim: k => // k IH kn; apply: leq_ltn_trans (IH (ltnW kn)) _.
    by apply: rank_ltmx; rewrite ltmxE wongS (h (Ordinal kn)).
  by have := grow _ (leqnn _); rewrite leqNgt ltnS rank_leq_row.
pose s := touched (wong N k); exists s.
have fr : (wong N k.+1 <= shrunk_space s)%MS.
  have W0 : [forall (i | i \in ~: s), wong N k.+1 *m B i == 0].
    apply/forallP => i; apply/implyP; rewrite inE; apply: contraNT => Wi.
    by apply: (subsetP (touchedS stop)); rewrite inE.
  rewrite sub_capmx [X in _ && X]sub_kermx mul_input_space0 W0 andbT sub_preimage.
  have -> : N0 = N + \sum_i B i *m natural G i *m C i by rewrite subrK.
  rewrite mulmxDr addmx_sub //; first by rewrite -sub_preimage.
  rewrite mulmx_sumr; apply: summx_sub => i _; have [si|si] := boolP (i \in s).
    by rewrite !mulmxA; apply: submx_trans (submxMl _ _) (output_space_sup si).
  have := forallP W0 i; rewrite inE si /= => /eqP Wi.
  by rewrite !mulmxA Wi !mul0mx sub0mx.
have := rank_preimage (ok k kn); rewrite -/s -/(wong N k.+1) => e1.
have := rank_pencil_shrunk_space s; have := mxrankS fr => h e2.
by rewrite -(leq_add2r (\rank (shrunk_space s))) e2 -e1 [leqRHS]addnC leq_add2r.
Qed.

(* max over F of rank (N0 - sum B F C) = min over s of rank [N0, B_{m-s}; C_s, 0] *)
Theorem max_rank_min_pencil :
  exists G, exists s, \rank (perturbed (natural G)) = \rank (wong_pencil s).
Proof.
suff [G [s h]] : exists G, exists s, (\rank (wong_pencil s) <= \rank (perturbed (natural G)))%N.
  by exists G, s; apply/eqP; rewrite eqn_leq h rank_perturbed_le.
pose z i : 'M[nat]_(p i, q i) := \matrix_(x, y) 0%N.
pose rk G := \rank (perturbed (natural G)).
suff: forall d G, (n - rk G < d)%N -> exists G s, (\rank (wong_pencil s) <= rk G)%N.
  by move=> h; apply: (h _ z); apply: ltnSn.
elim=> [|d IH] G dG //.
have [N defN] : {N | N = perturbed (natural G)} by exists (perturbed (natural G)).
have [/forallP h|] :=
    boolP [forall k : 'I_n.+1, (output_space (touched (wong N k)) <= N)%MS].
  exists G; apply: wong_reaches => k kn; rewrite -defN.
  by have := h (Ordinal (kn : (k < n.+1)%N)).
rewrite negb_forall => /existsP[k /(repair defN)[G' lt]]; apply: (IH G').
have rG : (rk G < rk G')%N by rewrite /rk -defN.
apply: (@leq_trans (n - rk G)%N); last by rewrite -ltnS.
by apply: ltn_sub2l => //; apply: leq_trans rG (rank_leq_row _).
Qed.

End Repair.
