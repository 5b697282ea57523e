(* Systems as lists of integers over one denominator, and the systems that they represent.

   "The system of the list that `zpart` builds is the part of the system of the list" has no type: the numbers of
   states of both sides are equal, but not by computation.  So a list *represents* systems, over every field that
   contains Q, and what is proved of a list is proved of everything that it represents (facts.v).

   A list has room for a feedthrough, y = Cx + Du.  Outputs of `multichannel` have none, so a list represents a system
   only if its feedthrough is zero. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel blocks.
From mcexact.kernel Require Import lists.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Record zchannel := ZChannel { zp : nat; zq : nat; zB : zmat; zC : zmat }.
(* All entries over the one denominator zD; zfeed has the rows of D. *)
Record zsystem := ZSystem { zn : nat; zD : Z; zA : zmat; zchannels : seq zchannel; zfeed : zmat }.
Definition zch0 := ZChannel 0 0 [::] [::].
Definition sized_channel n ch := shape n (zp ch) (zB ch) && shape (zq ch) n (zC ch).
Definition sized_system (s : zsystem) : bool :=
  [&& Z.ltb 0 (zD s), zmat0 (zfeed s), shape (zn s) (zn s) (zA s) & all (sized_channel (zn s)) (zchannels s)].

(* The states at which the mask is true, by themselves; all channels stay. *)
Definition zpart_channel mk ch := ZChannel (zp ch) (zq ch) (mask mk (zB ch)) [seq mask mk r | r <- zC ch].
Definition zpart (s : zsystem) (mk : seq bool) : zsystem :=
  ZSystem (count id mk) (zD s) [seq mask mk r | r <- mask mk (zA s)] (map (zpart_channel mk) (zchannels s)) (zfeed s).
(* The transpose of an a x b matrix, and the dual system. *)
Definition ztranspose a b (M : zmat) : zmat := mkseq (fun j => mkseq (fun i => nth z0 (nth [::] M i) j) a) b.
Definition zdual_channel n ch := ZChannel (zq ch) (zp ch) (ztranspose (zq ch) n (zC ch)) (ztranspose n (zp ch) (zB ch)).
Definition zdual (s : zsystem) : zsystem :=
  ZSystem (zn s) (zD s) (ztranspose (zn s) (zn s) (zA s)) (map (zdual_channel (zn s)) (zchannels s)) (zfeed s).

Section Represents.
Variable K : fieldType.
Notation phi := (phi [comRingType of K]).
Notation mx := (mx [comRingType of K]).

(* The matrix of a list, over the denominator. *)
Definition over (d : Z) a b (M : zmat) : 'M[K]_(a, b) := (phi d)^-1 *: mx a b M.
Lemma overE d a b M i j : over d a b M i j = (phi d)^-1 * phi (nth z0 (nth [::] M i) j).
Proof. by rewrite !mxE. Qed.

Definition channel s m (k : 'I_m) := nth zch0 (zchannels s) k.
Record represents (s : zsystem) n m (p q : 'I_m -> nat) (S : multichannel K n p q) : Prop := Represents {
  re_sized : sized_system s;
  re_n : n = zn s;
  re_m : m = size (zchannels s);
  re_p : forall k, p k = zp (channel s k);
  re_q : forall k, q k = zq (channel s k);
  re_A : mcA S = over (zD s) n n (zA s);
  re_B : forall k, mcB S k = over (zD s) n (p k) (zB (channel s k));
  re_C : forall k, mcC S k = over (zD s) (q k) n (zC (channel s k)) }.

(* A list of the right sizes represents a system. *)
Definition system_of (s : zsystem) :
    multichannel K (zn s) (fun k : 'I_(size (zchannels s)) => zp (channel s k)) (fun k => zq (channel s k)) :=
  Multichannel (over (zD s) _ _ (zA s)) (fun k => over (zD s) _ _ (zB (channel s k))) (fun k => over (zD s) _ _ (zC (channel s k))).
Lemma system_of_represents s : sized_system s -> represents s (system_of s).
Proof. by move=> sz; split. Qed.
End Represents.

Section Sizes.
Variables (K : fieldType) (s : zsystem) (n m : nat) (p q : 'I_m -> nat) (S : multichannel K n p q).
Hypothesis re : represents s S.

Lemma row_size a b M i : shape a b M -> (i < a)%N -> size (nth [::] M i) = b.
Proof. by case/andP=> /eqP sM /(all_nthP [::]) al ia; apply/eqP/al; rewrite sM. Qed.
Lemma shape_size a b M : shape a b M -> size M = a. Proof. by case/andP=> /eqP. Qed.
Lemma represented_A : shape n n (zA s).
Proof. by case: re => /and4P[_ _ sA _] en *; rewrite en. Qed.
Lemma represented_channel (k : 'I_m) : shape n (p k) (zB (channel s k)) /\ shape (q k) n (zC (channel s k)).
Proof.
case: re => /and4P[_ _ _ /(all_nthP zch0) al] en em ep eq _ _ _.
have km : (k < size (zchannels s))%N by rewrite -em.
by have /andP[] := al k km; rewrite ep eq en.
Qed.
Lemma represented_D : (0 < zD s)%coqZ.
Proof. by case: re => /and4P[/Z.ltb_lt]. Qed.
End Sizes.

Section Part.
Variables (s : zsystem) (mk : seq bool).

Lemma mask_states n : size mk = n -> mask mk (iota 0 n) = [seq a <- iota 0 n | nth false mk a].
Proof. by move=> smk; rewrite filter_mask -smk map_nth_iota0 // take_size. Qed.
Lemma nth_mask_states n (X : Type) (x : X) (r : seq X) i : size mk = n -> size r = n -> (i < count id mk)%N ->
  nth x (mask mk r) i = nth x r (nth 0%N (mask mk (iota 0 n)) i).
Proof.
move=> smk sr il; have -> : mask mk r = [seq nth x r a | a <- mask mk (iota 0 n)].
  by rewrite map_mask -sr map_nth_iota0 // take_size.
by rewrite (nth_map 0%N) // size_mask ?size_iota.
Qed.

Variables (n : nat).
Hypothesis smk : size mk = n.
Definition masked : {set 'I_n} := [set a : 'I_n | nth false mk a].
Lemma masked_enum : map val (enum masked) = mask mk (iota 0 n).
Proof.
rewrite (mask_states smk) -val_enum_ord filter_map; congr map.
by rewrite {1}/enum_mem enumT; apply: eq_filter => a; rewrite /= inE.
Qed.
Lemma card_masked : #|masked| = count id mk.
Proof. by rewrite cardE -(size_map val) masked_enum size_mask // size_iota. Qed.
Lemma enum_val_masked (i : 'I_#|masked|) : enum_val i = nth 0%N (mask mk (iota 0 n)) i :> nat.
Proof.
rewrite -masked_enum /enum_val; set x := enum_default i.
by rewrite (nth_map x) // -cardE.
Qed.
End Part.

Lemma all_mask (T : Type) (a : pred T) mk (r : seq T) : all a r -> all a (mask mk r).
Proof. by elim: mk r => [|b mk IH] [|x r] //= /andP[ax /IH]; case: b => //= ->; rewrite ax. Qed.
Lemma shape_mask_cols a b mk M : shape a b M -> size mk = b -> shape a (count id mk) [seq mask mk r | r <- M].
Proof.
case/andP=> sM al smk; rewrite /shape size_map sM all_map; apply: sub_all al => r /eqP sr /=.
by rewrite size_mask ?sr.
Qed.
Lemma shape_mask_rows a b mk M : shape a b M -> size mk = a -> shape (count id mk) b (mask mk M).
Proof.
by case/andP=> /eqP sM al smk; rewrite /shape size_mask ?sM ?smk // eqxx all_mask.
Qed.

(* The list of a part represents the part. *)
Theorem part_represents (K : fieldType) s mk n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> size mk = n -> represents (zpart s mk) (restrict S (masked mk n)).
Proof.
move=> re smk; have sA := represented_A re; have sBC := represented_channel re.
case: (re) => /and4P[D0 feed _ al] en em ep eq eA eB eC.
have chE (k : 'I_m) : channel (zpart s mk) k = zpart_channel mk (channel s k).
  by rewrite /channel (nth_map zch0) // -em.
have idx i := enum_val_masked smk i; have lt (i : 'I_#|masked mk n|) : (i < count id mk)%N by rewrite -(card_masked smk).
split=> //=.
- apply/and4P; split=> //=; first by apply: shape_mask_cols (shape_mask_rows sA smk) smk.
  rewrite all_map; apply: sub_all al => ch /andP[]; rewrite -en => sB sC /=.
  by apply/andP; split; [apply: shape_mask_rows sB smk | apply: shape_mask_cols sC smk].
- exact: card_masked.
- by rewrite size_map.
- by move=> k; rewrite chE ep.
- by move=> k; rewrite chE eq.
- apply/matrixP=> i j; rewrite !mxE eA overE; congr (_ * _); congr (phi _ _).
  have sM : size (mask mk (zA s)) = count id mk by rewrite size_mask ?smk ?(shape_size sA).
  have e1 := nth_mask_states [::] smk (shape_size sA) (lt i); rewrite -idx in e1.
  have e2 := nth_mask_states z0 smk (row_size sA (ltn_ord (enum_val i))) (lt j); rewrite -idx in e2.
  have ri : (i < size (mask mk (zA s)))%N by rewrite sM.
  by have e3 := @nth_map _ [::] _ [::] (mask mk) i (mask mk (zA s)) ri; rewrite e3 e1 e2.
- move=> k; have [sB sC] := sBC k; apply/matrixP=> i u; rewrite chE !mxE eB overE; congr (_ * _); congr (phi _ _).
  by have e1 := nth_mask_states [::] smk (shape_size sB) (lt i); rewrite -idx in e1; rewrite e1.
move=> k; have [sB sC] := sBC k; apply/matrixP=> v j; rewrite chE !mxE eC overE; congr (_ * _); congr (phi _ _).
have e2 := nth_mask_states z0 smk (row_size sC (ltn_ord v)) (lt j); rewrite -idx in e2.
have rv : (v < size (zC (channel s k)))%N by rewrite (shape_size sC).
by have e3 := @nth_map _ [::] _ [::] (mask mk) v (zC (channel s k)) rv; rewrite e3 e2.
Qed.

Lemma transpose_nth a b M i j : (i < b)%N -> (j < a)%N -> nth z0 (nth [::] (ztranspose a b M) i) j = nth z0 (nth [::] M j) i.
Proof. by move=> ib ja; rewrite nth_mkseq // nth_mkseq. Qed.
Lemma shape_transpose a b M : shape b a (ztranspose a b M).
Proof. rewrite /shape size_mkseq eqxx all_map; apply: sub_all (all_predT _) => j _ /=; by rewrite size_mkseq. Qed.
Theorem dual_represents (K : fieldType) s n m (p q : 'I_m -> nat) (S : multichannel K n p q) :
  represents s S -> represents (zdual s) (dual S).
Proof.
case=> /and4P[D0 feed _ _] en em ep eq eA eB eC.
have chE (k : 'I_m) : channel (zdual s) k = zdual_channel (zn s) (channel s k).
  by rewrite /channel (nth_map zch0) // -em.
split=> //=.
- apply/and4P; split=> //=; first exact: shape_transpose.
  by rewrite all_map; apply: sub_all (all_predT _) => ch _; rewrite /= /sized_channel !shape_transpose.
- by rewrite size_map.
- by move=> k; rewrite chE eq.
- by move=> k; rewrite chE ep.
- by apply/matrixP=> i j; rewrite mxE eA !overE transpose_nth // -?en.
- by move=> k; apply/matrixP=> i u; rewrite mxE eC !overE chE transpose_nth // -?en -?eq.
by move=> k; apply/matrixP=> v j; rewrite mxE eB !overE chE transpose_nth // -?en -?ep.
Qed.
