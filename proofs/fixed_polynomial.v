(* The fixed polynomial: the greatest common divisor of det(xI - A_F) over all gains F. Its roots are the fixed
   modes; it says in addition how often each occurs whatever the gains are. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel evidence.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Greatest.
Variable K : fieldType.

(* phi divides every f_x, and whatever divides them all divides phi. *)
Definition greatest (X : Type) (f : X -> {poly K}) (phi : {poly K}) :=
  (forall x, phi %| f x) /\ (forall D, (forall x, D %| f x) -> D %| phi).

(* Whatever divides them all divides g, which need not divide them. *)
Definition dominated (X : Type) (f : X -> {poly K}) (g : {poly K}) := forall D, (forall x, D %| f x) -> D %| g.

Lemma dominated_multiple (X : Type) (f : X -> {poly K}) phi (g D : {poly K}) :
  dominated f phi -> (forall x, D %| g * f x) -> D %| g * phi.
Proof.
move=> top dv; have [->|g0] := eqVneq g 0; first by rewrite mul0r dvdp0.
have G0 : gcdp D g != 0 by rewrite gcdp_eq0 (negPf g0) andbF.
have cop : coprimep (D %/ gcdp D g) (g %/ gcdp D g) by rewrite coprimep_div_gcd// g0 orbT.
have eD := divpK (dvdp_gcdl D g); have eg := divpK (dvdp_gcdr D g).
rewrite -eD -[X in X * phi]eg mulrAC dvdp_mul2r// dvdp_mull//; apply: top => x.
by have := dv x; rewrite -[X in X %| _]eD -[X in _ %| X * _]eg mulrAC dvdp_mul2r// Gauss_dvdpr.
Qed.

(* One member of a family exchanged. *)
Definition exchange (I : eqType) (X : I -> Type) (x : forall i, X i) j (v : X j) i : X i :=
  if eqP is ReflectT e then eq_rect j X v i e else x i.

Lemma exchange_same (I : eqType) (X : I -> Type) (x : forall i, X i) j (v : X j) : exchange x v j = v.
Proof. by rewrite /exchange; case: eqP => // e; rewrite (eq_axiomK e). Qed.

Lemma exchange_other (I : eqType) (X : I -> Type) (x : forall i, X i) j (v : X j) i :
  i != j -> exchange x v i = x i.
Proof. by rewrite /exchange eq_sym; case: eqP. Qed.

(* Families that are chosen independently: what divides all products divides the product. *)
Lemma dominated_product (I : finType) (X : I -> Type) (f : forall i, X i -> {poly K}) (phi : I -> {poly K})
    (x0 : forall i, X i) : (forall i, dominated (f i) (phi i)) ->
  dominated (fun x : forall i, X i => \prod_i f i (x i)) (\prod_i phi i).
Proof.
move=> gr D dv; have stage (s : seq I) : uniq s ->
    (forall x : forall i, X i, D %| (\prod_(i in s) phi i) * \prod_(i | i \notin s) f i (x i)).
  elim: s => [_ x|j s IH /andP[js us] x].
    by rewrite big_pred0 ?mul1r// => i; rewrite inE.
  rewrite (bigD1 j) ?mem_head//= -mulrA mulrC; apply: (dominated_multiple (gr j)) => v.
  have := IH us (exchange x v); rewrite [X in _ * X](bigD1 j)//= exchange_same mulrCA mulrC.
  congr (_ %| _ * _ * _).
    by apply: eq_bigl => i; rewrite inE; case: eqVneq => [->|]; rewrite ?(negPf js) ?andbF ?andbT.
  apply: eq_big => [i|i /andP[_ ij]]; last by rewrite exchange_other.
  by rewrite inE negb_or andbC.
have := stage (enum I) (enum_uniq _) x0; rewrite [X in _ * X]big_pred0 ?mulr1 => [|i].
  by congr (_ %| _); apply: eq_bigl => i; rewrite mem_enum.
by rewrite mem_enum.
Qed.

(* The greatest common divisor of the products is the product. *)
Lemma greatest_product (I : finType) (X : I -> Type) (f : forall i, X i -> {poly K}) (phi : I -> {poly K})
    (x0 : forall i, X i) : (forall i, greatest (f i) (phi i)) ->
  greatest (fun x : forall i, X i => \prod_i f i (x i)) (\prod_i phi i).
Proof.
move=> gr; split=> [x|]; last by apply: dominated_product => // i; case: (gr i).
by apply: (big_ind2 (fun a b => a %| b)) => // [a b c d|i _]; [apply: dvdp_mul | case: (gr i)].
Qed.
End Greatest.

(* n - rank (lambda I - M) is at most the multiplicity of lambda in det(xI - M). *)
Lemma rank_divides (K : fieldType) n (M : 'M[K]_n) lambda d :
  (\rank (lambda%:M - M)%R + d <= n)%N -> ('X - lambda%:P) ^+ d %| char_poly M.
Proof.
set N := _ - M; set t := 'X - _ => rd; pose r := \rank N.
pose B := map_mx polyC (col_base N); pose C := map_mx polyC (row_base N).
have eM : char_poly_mx M = t%:M + B *m C.
  rewrite -map_mxM mulmx_base map_mxB map_scalar_mx /char_poly_mx /t /= addrA; congr (_ - _).
  by rewrite -raddfD /= subrK.
have e1 : t ^+ r * char_poly M = \det (block_mx 1%:M (- B) C t%:M) * t ^+ n.
  have -> : t ^+ r * char_poly M = \det (block_mx (t%:M) (- B) (t *: C) t%:M).
    have e : block_mx t%:M (- B) C 1%:M = block_mx (char_poly_mx M) (- B) 0 1%:M *m block_mx 1%:M 0 C 1%:M.
      by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r, addr0) eM mulNmx addrK.
    have -> : block_mx t%:M (- B) (t *: C) t%:M = block_mx 1%:M 0 0 t%:M *m block_mx t%:M (- B) C 1%:M.
      by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, mul0mx, add0r, addr0) mul_scalar_mx.
    by rewrite e !det_mulmx !det_ublock det_lblock !det1 !mulr1 mul1r det_scalar.
  have -> : block_mx t%:M (- B) (t *: C) t%:M = block_mx 1%:M (- B) C t%:M *m block_mx t%:M 0 0 1%:M.
    by rewrite mulmx_block !(mulmx1, mul1mx, mulmx0, add0r, addr0) mul_mx_scalar.
  by rewrite det_mulmx det_ublock det1 mulr1 det_scalar.
have : t ^+ r * t ^+ d %| t ^+ r * char_poly M by rewrite e1 -exprD dvdp_mull// dvdp_exp2l.
by rewrite dvdp_mul2l// expf_neq0// polyXsubC_eq0.
Qed.

Section Fixed.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).

Definition fixed_polynomial := greatest (fun F : gains K p q => char_poly (closed_loop S F)).

Lemma fixed_polynomial_root phi lambda : fixed_polynomial phi -> fixed S lambda <-> root phi lambda.
Proof.
case=> dv top; split=> [fx|r F]; last first.
  by rewrite eigenvalue_root_char -dvdp_XsubCl (dvdp_trans _ (dv F))// dvdp_XsubCl.
rewrite -dvdp_XsubCl; apply: top => F.
by rewrite dvdp_XsubCl -eigenvalue_root_char.
Qed.

(* A mode that occurs at most d times is fixed with deficiency at most d: no pencil has a lower rank. *)
Theorem fixed_polynomial_rank phi lambda d : fixed_polynomial phi -> ~~ (('X - lambda%:P) ^+ d.+1 %| phi) ->
  forall s, (n <= \rank (pencil S s lambda) + d)%N.
Proof.
case=> _ top nd s; rewrite leqNgt; apply: contra nd => low; apply: top => F; apply: rank_divides.
by rewrite addnS; apply: leq_ltn_trans low; rewrite leq_add2r loop_rank_pencil.
Qed.

(* Systems with the same closed loops, with inputs and outputs that may be written otherwise. *)
Lemma fixed_polynomial_same (S' : multichannel K n p q) phi :
  (forall F, closed_loop S F = closed_loop S' F) -> fixed_polynomial phi ->
  greatest (fun F : gains K p q => char_poly (closed_loop S' F)) phi.
Proof.
move=> same [dv top]; split=> [F|D dvD]; first by rewrite -same.
by apply: top => F; rewrite same.
Qed.
End Fixed.
