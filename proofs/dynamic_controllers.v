(* The fixed spectrum is the same under dynamic controllers: a fixed mode is an eigenvalue of every
   loop with channel controllers z_i' = K_i z_i + L_i y_i, u_i = G_i z_i + F_i y_i of any dimensions.
   Where a pencil has rank below n, its kernel is a shrunk subspace. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel arithmetic evidence controllability rank_one_repair.
From mcexact Require Import pencil_space anderson_clements delays example.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Kernel.
Variables (L : fieldType) (n m : nat) (p q : 'I_m -> nat).
Variables (S : multichannel L n p q) (s : {set 'I_m}) (lambda : L).
Notation P := (pencil S s lambda).
Notation B := (inputs S (~: s)).
Notation N := (kermx P^T).
Notation first := (col_mx 1%:M 0 : 'M[L]_(n + \sum_i p i, n)).

Lemma kernel_equations : (lambda%:M - mcA S) *m (lsubmx N)^T + B *m (rsubmx N)^T = 0 /\
  outputs S s *m (lsubmx N)^T = 0.
Proof.
have : P *m N^T = 0 by apply: trmx_inj; rewrite trmx_mul trmxK mulmx_ker trmx0.
rewrite -[N in N^T]hsubmxK tr_row_mx /pencil mul_block_col mul0mx addr0 => /eqP.
by rewrite col_mx_eq0 => /andP[/eqP-> /eqP->].
Qed.

Lemma kernel_left : N *m first = lsubmx N.
Proof. by rewrite -[N in LHS]hsubmxK mul_row_col mulmx1 mulmx0 addr0. Qed.

Lemma kernel_silent : (N :&: kermx first <= row_mx 0 (kermx B^T))%MS.
Proof.
apply/rV_subP => v; rewrite sub_capmx => /andP[/sub_kermxP vP /sub_kermxP vF].
move: vP vF; rewrite -[v]hsubmxK; set v1 := lsubmx v; set v2 := rsubmx v.
rewrite mul_row_col mulmx1 mulmx0 addr0 => vP v10; move: vP.
rewrite v10 /pencil tr_block_mx mul_row_block !mul0mx !add0r -[0 in RHS]row_mx0 => /eq_row_mx[e _].
have /submxP[D ->] : (v2 <= kermx B^T)%MS by apply/sub_kermxP.
by apply/submxP; exists D; rewrite mul_mx_row mulmx0.
Qed.

Lemma kernel_rank : (\rank P < n)%N -> (\rank B + 1 <= \rank (lsubmx N))%N.
Proof.
move=> low; have := mxrank_mul_ker N first; rewrite kernel_left mxrank_ker mxrank_tr => e.
have le : (\rank (N :&: kermx first) <= \sum_i p i - \rank B)%N.
  by have := mxrankS kernel_silent; rewrite rank_row_0mx mxrank_ker mxrank_tr.
have rB : (\rank B <= \sum_i p i)%N by exact: rank_leq_col.
have : (n + \sum_i p i - \rank P <= \rank (lsubmx N) + (\sum_i p i - \rank B))%N.
  by rewrite -e leq_add2l.
rewrite leq_subLR -{1}(subnK rB) => h.
have {}h : (n + \rank B <= \rank P + \rank (lsubmx N))%N.
  by rewrite -(leq_add2l (\sum_i p i - \rank B)) addnCA [X in (_ <= X)%N]addnC -addnA.
by rewrite -(leq_add2l (\rank P)); apply: leq_trans h; rewrite [(\rank B + 1)%N]addnC addnA addn1 leq_add2r.
Qed.

Lemma kernel_shrunk : (\rank P < n)%N -> exists u (U : 'M[L]_(n, u)) V,
  [/\ shrunk S lambda (~: s) U V, \rank U = u & (\rank B + 1 <= u)%N].
Proof.
move=> low; have [e z] := kernel_equations.
have [R eR] : exists R, row_base (lsubmx N) = R *m lsubmx N.
  by apply/submxP; rewrite eq_row_base.
exists (\rank (lsubmx N)), (row_base (lsubmx N))^T, (- (R *m rsubmx N)^T); split.
- split; first rewrite eR !trmx_mul mulmxA.
    by move/eqP: e; rewrite addr_eq0 => /eqP ->; rewrite mulNmx mulmxN mulmxA.
  move=> i; rewrite inE negbK => si; rewrite eR trmx_mul mulmxA.
  by have /outputs_eq0 -> := z; rewrite ?mul0mx.
- by rewrite mxrank_tr eq_row_base.
exact: kernel_rank.
Qed.
End Kernel.

(* the same controllers over a larger field *)
Definition map_controllers (R R' : ringType) (f : R -> R') m (p q k : 'I_m -> nat)
    (D : controllers R p q k) : controllers R' p q k :=
  Controllers (fun i => map_mx f (ctF D i)) (fun i => map_mx f (ctG D i))
              (fun i => map_mx f (ctL D i)) (fun i => map_mx f (ctK D i)).

Lemma map_dynamic_loop (K L : fieldType) (f : {rmorphism K -> L}) n m (p q k : 'I_m -> nat)
    (S : multichannel K n p q) (D : controllers K p q k) :
  map_mx f (dynamic_loop S D) = dynamic_loop (map_system f S) (map_controllers f D).
Proof.
rewrite /dynamic_loop map_block_mx map_mxcol map_mxdiag; congr block_mx.
- exact: closed_loop_map.
- by apply/matrixP => i j; rewrite !mxE rmorph_sum; apply: eq_bigr => l _; rewrite rmorphM !mxE.
by apply: eq_mxcol => i; rewrite map_mxM.
Qed.

Section Dynamic.
Variables (n m : nat) (p q : 'I_m -> nat).

(* IV-A: all linear time-invariant channel controllers leave the same fixed modes *)
Theorem fixed_dynamic (L : fieldType) (S : multichannel L n p q) lambda : fixed S lambda ->
  forall k (D : controllers L p q k), eigenvalue (dynamic_loop S D) lambda.
Proof.
move=> /anderson_clements[s low] k D; have [u [U [V [sh fU h]]]] := kernel_shrunk low.
by have := shrunk_dynamic_rank D sh fU h; rewrite eigenvalue_rank addn1.
Qed.

Theorem fixed_dynamic_over (K L : fieldType) (f : {rmorphism K -> L}) (S : multichannel K n p q)
    lambda : fixed_over f S lambda ->
  forall k (D : controllers L p q k), eigenvalue (dynamic_loop (map_system f S) D) lambda.
Proof. by move/fixed_over_fixed; exact: fixed_dynamic. Qed.
End Dynamic.

(* IV-B and VI: where outputs alone are shared, no local dynamics move the mode 1 of the example, which
   is stable in neither time domain. *)
Theorem example_dynamic (L : fieldType) k
    (D : controllers L p3 (fun=> \sum_(i < 3) q3 i)%N k) :
  eigenvalue (dynamic_loop (augmented_outputs N3 (plant L)) D) 1.
Proof. exact: fixed_dynamic (@example_mss_fixed L) _ D. Qed.
