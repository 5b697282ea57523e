(* What the matrices of the extended, the lifted and the held system stand for, as equations.

   extended   (24), (25): the plant moves by the u_i, every shared sub-state x_i by its own v_i, and agent i receives the
              outputs and the sub-states of its neighbors.  Agents' programs, linear in what an agent receives and in its
              private state z_i, and channel controllers of the extended system are the same thing: they make the same
              loop (distributed_is_decentralized, decentralized_is_distributed).
   lifted     (32) to (35): agent i receives y_j(t - d_ij) and x_j(t - d_ij).
   held       (37), (38): agent i receives x_j(t - d_j), whatever the delay d_ij is; and this is what arrives where agent
              j holds x_j for d_j - d_ij steps before sending it to i (held_then_sent).

   Sub-states are named by the coordinates of the matrices: held_state j t is x_j(t' - t) at the time t', and so are
   sub_state and past_output of the lifted system. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel rank_one_repair pencil_space extended delayed_systems.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

Lemma sum_col_mx (K : fieldType) m a b c (A : 'I_m -> 'M[K]_(a, c)) (B : 'I_m -> 'M[K]_(b, c)) :
  \sum_i col_mx (A i) (B i) = col_mx (\sum_i A i) (\sum_i B i).
Proof. by elim/big_rec3: _ => [|i x y z _ ->]; rewrite ?col_mx0 // add_col_mx. Qed.

Section Loop.
Variables (K : fieldType) (n m : nat) (p q k : 'I_m -> nat) (S : multichannel K n p q) (D : controllers K p q k).

(* the loop of a system and channel controllers: u_i = F_i y_i + G_i z_i, z_i' = L_i y_i + K_i z_i *)
Theorem loop_equations (x : 'cV[K]_n) (z : forall i, 'cV[K]_(k i)) (y := fun i => mcC S i *m x) :
  dynamic_loop S D *m col_mx x (\mxcol_i z i) =
  col_mx (mcA S *m x + \sum_i mcB S i *m (ctF D i *m y i + ctG D i *m z i))
         (\mxcol_i (ctL D i *m y i + ctK D i *m z i)).
Proof.
rewrite /dynamic_loop mul_block_col; congr col_mx.
  rewrite mul_mxrow_mxcol /closed_loop mulmxDl -addrA mulmx_suml -big_split; congr (_ + _).
  by apply: eq_bigr => i _; rewrite mulmxDr !mulmxA.
rewrite mxcol_mul mul_mxdiag_mxcol -mxcolD; apply: eq_mxcol => i.
by rewrite mulmxA.
Qed.
End Loop.

Section Extended.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (k : 'I_m -> nat).
Variable S : multichannel K n p q.
Notation E := (extended N k S).
Variables (x : 'cV[K]_n) (X : forall i, 'cV[K]_(k i)).
Notation state := (col_mx x (\mxcol_i X i)).

Lemma sum_shared (v : forall i, 'cV[K]_(k i)) : \sum_i shared_input K k i *m v i = \mxcol_i v i.
Proof.
have <- : \mxrow_i shared_input K k i *m \mxcol_i v i = \sum_i shared_input K k i *m v i by exact: mul_mxrow_mxcol.
by rewrite /shared_input submxrowK mul1mx.
Qed.

(* (1) and (24) *)
Theorem extended_equations (u : forall i, 'cV[K]_(p i)) (v : forall i, 'cV[K]_(k i)) :
  mcA E *m state + \sum_i mcB E i *m col_mx (u i) (v i) =
  col_mx (mcA S *m x + \sum_i mcB S i *m u i) (\mxcol_i v i).
Proof.
rewrite /= mul_block_col !mul0mx !addr0 (eq_bigr (fun i => col_mx (mcB S i *m u i) (shared_input K k i *m v i))).
  by rewrite sum_col_mx add_col_mx add0r sum_shared.
by move=> i _; rewrite mul_block_col !mul0mx addr0 add0r.
Qed.

(* what agent i receives *)
Theorem extended_output i : mcC E i *m state =
  col_mx (\mxcol_j (if j \in N i then mcC S j *m x else 0)) (\mxcol_j (if j \in N i then X j else 0)).
Proof.
rewrite /= mul_block_col !mul0mx addr0 add0r; congr col_mx.
  by rewrite /outputs mxcol_mul; apply: eq_mxcol => j; case: ifP => _; rewrite ?mul0mx.
rewrite /shared_output mxcol_mul; apply: eq_mxcol => j; case: ifP => _; last by rewrite mul0mx.
by rewrite /shared_input tr_submxrow trmx1 submxcol_mul mul1mx mxcolK.
Qed.
End Extended.

(* Programs: what agent i does with the y_j and x_j of its neighbors and with its private state z_i. *)
Section Programs.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}) (k l : 'I_m -> nat).
Variable S : multichannel K n p q.

(* r i numbers from the y_j, the x_j and z_i *)
Record program (r : 'I_m -> nat) := Program {
  of_output : forall i j, 'M[K]_(r i, q j);
  of_shared : forall i j, 'M[K]_(r i, k j);
  of_private : forall i, 'M[K]_(r i, l i) }.
Definition run r (P : program r) x (X : forall i, 'cV[K]_(k i)) (z : forall i, 'cV[K]_(l i)) i : 'cV[K]_(r i) :=
  \sum_(j in N i) (of_output P i j *m (mcC S j *m x) + of_shared P i j *m X j) + of_private P i *m z i.

(* one step of the plant and all agents, who have three programs: for u_i, for x_i' and for z_i' *)
Definition distributed_step (U : program p) (V : program k) (Z : program l) x X z :=
  col_mx (col_mx (mcA S *m x + \sum_i mcB S i *m run U x X z i) (\mxcol_i run V x X z i)) (\mxcol_i run Z x X z i).

Notation controllers := (controllers K (fun i => p i + k i)%N (fun=> \sum_i q i + \sum_i k i)%N l).

Lemma run_rows r (P : program r) i (F : 'M[K]_(r i, \sum_i q i)) (H : 'M[K]_(r i, \sum_i k i)) x X z :
  (forall j, submxrow F j = of_output P i j) -> (forall j, submxrow H j = of_shared P i j) ->
  run P x X z i = row_mx F H *m (mcC (extended N k S) i *m col_mx x (\mxcol_i X i)) + of_private P i *m z i.
Proof.
move=> eF eH; rewrite extended_output mul_row_col /run; congr (_ + _).
rewrite -[F in RHS]submxrowK -[H in RHS]submxrowK.
have -> : \mxrow_j submxrow F j *m \mxcol_j (if j \in N i then mcC S j *m x else 0) =
    \sum_j submxrow F j *m (if j \in N i then mcC S j *m x else 0) by exact: mul_mxrow_mxcol.
have -> : \mxrow_j submxrow H j *m \mxcol_j (if j \in N i then X j else 0) =
    \sum_j submxrow H j *m (if j \in N i then X j else 0) by exact: mul_mxrow_mxcol.
rewrite [LHS]big_mkcond -big_split /=; apply: eq_bigr => j _; rewrite eF eH.
by case: ifP => _; rewrite ?mulmx0 ?addr0.
Qed.

Definition programs_of (D : controllers) : program p * program k * program l :=
  (Program (fun i j => submxrow (lsubmx (usubmx (ctF D i))) j) (fun i j => submxrow (rsubmx (usubmx (ctF D i))) j)
     (fun i => usubmx (ctG D i)),
   Program (fun i j => submxrow (lsubmx (dsubmx (ctF D i))) j) (fun i j => submxrow (rsubmx (dsubmx (ctF D i))) j)
     (fun i => dsubmx (ctG D i)),
   Program (fun i j => submxrow (lsubmx (ctL D i)) j) (fun i j => submxrow (rsubmx (ctL D i)) j) (fun i => ctK D i)).
Definition controllers_of (U : program p) (V : program k) (Z : program l) : controllers := Controllers
  (fun i => block_mx (\mxrow_j of_output U i j) (\mxrow_j of_shared U i j) (\mxrow_j of_output V i j) (\mxrow_j of_shared V i j))
  (fun i => col_mx (of_private U i) (of_private V i))
  (fun i => row_mx (\mxrow_j of_output Z i j) (\mxrow_j of_shared Z i j)) (of_private Z).

(* decentralized control of the extended system is distributed control of the plant *)
Theorem decentralized_is_distributed (D : controllers) x X z :
  dynamic_loop (extended N k S) D *m col_mx (col_mx x (\mxcol_i X i)) (\mxcol_i z i) =
  distributed_step (programs_of D).1.1 (programs_of D).1.2 (programs_of D).2 x X z.
Proof.
rewrite loop_equations /distributed_step; congr col_mx; last first.
  apply: eq_mxcol => i; rewrite (@run_rows _ (programs_of D).2 i (lsubmx (ctL D i)) (rsubmx (ctL D i))) //.
  by rewrite hsubmxK.
pose u i := run (programs_of D).1.1 x X z i; pose v i := run (programs_of D).1.2 x X z i.
rewrite -[RHS](extended_equations N S x X u v); congr (_ + _); apply: eq_bigr => i _; congr (_ *m _).
rewrite -[ctF D i]vsubmxK -[ctG D i]vsubmxK; set y := mcC _ i *m _; rewrite mul_col_mx mul_col_mx add_col_mx /u /v.
congr col_mx.
  rewrite (@run_rows _ (programs_of D).1.1 i (lsubmx (usubmx (ctF D i))) (rsubmx (usubmx (ctF D i)))) //.
  by rewrite hsubmxK.
rewrite (@run_rows _ (programs_of D).1.2 i (lsubmx (dsubmx (ctF D i))) (rsubmx (dsubmx (ctF D i)))) //.
by rewrite hsubmxK.
Qed.

(* and the other way around, for every choice of programs *)
Theorem distributed_is_decentralized (U : program p) (V : program k) (Z : program l) x X z :
  dynamic_loop (extended N k S) (controllers_of U V Z) *m col_mx (col_mx x (\mxcol_i X i)) (\mxcol_i z i) =
  distributed_step U V Z x X z.
Proof.
rewrite loop_equations /distributed_step; congr col_mx; last first.
  by apply: eq_mxcol => i; rewrite (@run_rows _ Z i (\mxrow_j of_output Z i j) (\mxrow_j of_shared Z i j)) // => j;
    rewrite mxrowK.
pose u i := run U x X z i; pose v i := run V x X z i.
rewrite -[RHS](extended_equations N S x X u v); congr (_ + _); apply: eq_bigr => i _; congr (_ *m _).
set y := mcC _ i *m _; rewrite /= block_mxEv mul_col_mx mul_col_mx add_col_mx /u /v; congr col_mx.
  by rewrite (@run_rows _ U i (\mxrow_j of_output U i j) (\mxrow_j of_shared U i j)) // => j; rewrite mxrowK.
by rewrite (@run_rows _ V i (\mxrow_j of_output V i j) (\mxrow_j of_shared V i j)) // => j; rewrite mxrowK.
Qed.
End Programs.

(* A shift register: at each step its cells move on by one, and the first is filled. *)
Section Register.
Variables (K : fieldType) (k r : nat).
Notation cell t := (pick K r k t).

Lemma first_cell (c : 'cV[K]_(\sum_(i < r) k)) v : (0 < r)%N -> cell 0 *m (shift K r k *m c + (cell 0)^T *m v) = v.
Proof. by move=> r0; rewrite mulmxDr !mulmxA pick_shift0 mul0mx add0r pick_tr // mul1mx. Qed.

Lemma next_cell (c : 'cV[K]_(\sum_(i < r) k)) v t : (t.+1 < r)%N ->
  cell t.+1 *m (shift K r k *m c + (cell 0)^T *m v) = cell t *m c.
Proof. by move=> tr; rewrite mulmxDr !mulmxA pick_shiftS // pick_tr0 // mul0mx addr0. Qed.
End Register.

Section Delays.
Variables (K : fieldType) (n m : nat) (p q : 'I_m -> nat) (N : 'I_m -> {set 'I_m}).
Variables (k : 'I_m -> nat) (d : 'I_m -> 'I_m -> nat) (S : multichannel K n p q).
Notation dmax := (dmax N d).

(* Section V-B *)
Section Held.
Notation H := (held N k d S).
Notation cell := (held_state K N k d).
Variables (x : 'cV[K]_n) (Y : 'cV[K]_(\sum_i chain N k d i)).
Variables (u : forall i, 'cV[K]_(p i)) (v : forall i, 'cV[K]_(k i)).
Notation next := (mcA H *m col_mx x Y + \sum_i mcB H i *m col_mx (u i) (v i)).

Lemma held_next : next = col_mx (mcA S *m x + \sum_i mcB S i *m u i)
  ((\mxdiag_i shift K (dmax i).+1 (k i)) *m Y + \sum_i (cell i 0)^T *m v i).
Proof.
rewrite /= mul_block_col !mul0mx addr0 add0r.
rewrite (eq_bigr (fun i => col_mx (mcB S i *m u i) ((cell i 0)^T *m v i))) => [|i _].
  by rewrite sum_col_mx add_col_mx.
by rewrite mul_block_col !mul0mx addr0 add0r.
Qed.

Lemma own_cells i : agent_block K (chain N k d) i *m dsubmx next =
  shift K (dmax i).+1 (k i) *m (agent_block K (chain N k d) i *m Y) + (pick K (dmax i).+1 (k i) 0)^T *m v i.
Proof.
rewrite held_next col_mxKd mulmxDr !mulmxA block_diag; congr (_ + _); rewrite mulmx_sumr [LHS](bigD1 i) //= [X in _ + X]big1 => [|j ji].
  by rewrite addr0 /held_state trmx_mul !mulmxA block_tr mul1mx.
by rewrite /held_state trmx_mul !mulmxA block_tr0 1?eq_sym // !mul0mx.
Qed.

Theorem held_plant : usubmx next = mcA S *m x + \sum_i mcB S i *m u i.
Proof. by rewrite held_next col_mxKu. Qed.

(* x_i(t + 1) = v_i(t) *)
Theorem held_first i : cell i 0 *m dsubmx next = v i.
Proof. by rewrite /held_state -mulmxA own_cells first_cell. Qed.

Theorem held_later i t : (t < dmax i)%N -> cell i t.+1 *m dsubmx next = cell i t *m Y.
Proof. by move=> td; rewrite /held_state -!mulmxA own_cells next_cell. Qed.

(* agent i receives y_i, and x_j of d_j steps before *)
Theorem held_output i : mcC H i *m col_mx x Y =
  col_mx (mcC S i *m x) (\mxcol_j (if j \in N i then cell j (dmax j) *m Y else 0)).
Proof.
rewrite /= mul_block_col !mul0mx addr0 add0r; congr col_mx.
by rewrite mxcol_mul; apply: eq_mxcol => j; case: ifP => _; rewrite ?mul0mx.
Qed.
End Held.

Section HeldTrajectory.
Notation H := (held N k d S).
Notation cell := (held_state K N k d).
Variables (x : nat -> 'cV[K]_n) (Y : nat -> 'cV[K]_(\sum_i chain N k d i)).
Variables (u : nat -> forall i, 'cV[K]_(p i)) (v : nat -> forall i, 'cV[K]_(k i)).
Hypothesis steps : forall t, col_mx (x t.+1) (Y t.+1) = mcA H *m col_mx (x t) (Y t) + \sum_i mcB H i *m col_mx (u t i) (v t i).

Lemma held_step t : Y t.+1 = dsubmx (mcA H *m col_mx (x t) (Y t) + \sum_i mcB H i *m col_mx (u t i) (v t i)).
Proof. by rewrite -steps col_mxKd. Qed.

(* the cell a + b at the time t holds what the cell a has held b steps before *)
Theorem held_delay j a b t : (a + b <= dmax j)%N -> (b <= t)%N -> cell j (a + b) *m Y t = cell j a *m Y (t - b)%N.
Proof.
elim: b t => [|b IH] t; first by rewrite addn0 subn0.
case: t => // t ab bt; have lt : (a + b < dmax j)%N by rewrite -addnS.
by rewrite addnS held_step held_later // IH // ltnW.
Qed.

(* x_j(t) itself, late by d_j *)
Corollary held_arrives j t : (dmax j <= t)%N -> cell j (dmax j) *m Y t = cell j 0 *m Y (t - dmax j)%N.
Proof. by move=> dt; rewrite -[X in cell j X *m Y t]add0n held_delay. Qed.

(* Agent j holds x_j for d_j - d_ij steps and sends it to i, where it arrives d_ij steps later: what has been sent then
   is what (37) puts into the output of i now. *)
Corollary held_then_sent i j t : j \in N i -> (d i j <= t)%N ->
  cell j (dmax j) *m Y t = cell j (dmax j - d i j) *m Y (t - d i j)%N.
Proof.
move=> Nj dt; have le : (d i j <= dmax j)%N by apply: (leq_bigmax_cond (F := fun i => d i j)).
by rewrite -{1}(subnK le) held_delay // subnK.
Qed.
End HeldTrajectory.

(* Section V-A *)
Section Lifted.
Notation H := (lifted N k d S).
Notation blk := (agent_block K (memory q N k d)).
Notation sub := (sub_state K q N k d).
Notation out := (past_output K q N k d).
Variables (x : 'cV[K]_n) (Y : 'cV[K]_(\sum_i memory q N k d i)).
Variables (u : forall i, 'cV[K]_(p i)) (v : forall i, 'cV[K]_(k i)).
Notation next := (mcA H *m col_mx x Y + \sum_i mcB H i *m col_mx (u i) (v i)).

Lemma lifted_next : next = col_mx (mcA S *m x + \sum_i mcB S i *m u i)
  (lifted_G N k d S *m x + lifted_K K q N k d *m Y + \sum_i (sub i 0)^T *m v i).
Proof.
rewrite /= mul_block_col !mul0mx addr0.
rewrite (eq_bigr (fun i => col_mx (mcB S i *m u i) ((sub i 0)^T *m v i))) => [|i _].
  by rewrite sum_col_mx add_col_mx.
by rewrite mul_block_col !mul0mx addr0 add0r.
Qed.

(* the cells of x_i and those of y_i *)
Lemma own_memory i (c := usubmx (blk i *m Y)) (w := dsubmx (blk i *m Y)) : blk i *m dsubmx next =
  col_mx (shift K (dmax i).+1 (k i) *m c + (pick K (dmax i).+1 (k i) 0)^T *m v i)
         (shift K (dmax i) (q i) *m w + (pick K (dmax i) (q i) 0)^T *m (mcC S i *m x)).
Proof.
have e0 : blk i *m (lifted_G N k d S *m x) = col_mx 0 ((pick K (dmax i) (q i) 0)^T *m (mcC S i *m x)).
  by rewrite mulmxA block_col mul_col_mx mul0mx mulmxA.
have e1 : blk i *m (lifted_K K q N k d *m Y) = col_mx (shift K (dmax i).+1 (k i) *m c) (shift K (dmax i) (q i) *m w).
  by rewrite mulmxA block_diag -mulmxA -[blk i *m Y]vsubmxK mul_block_col !mul0mx addr0 add0r.
have e2 : blk i *m (\sum_j (sub j 0)^T *m v j) = col_mx ((pick K (dmax i).+1 (k i) 0)^T *m v i) 0.
  rewrite mulmx_sumr [LHS](bigD1 i) //= [X in _ + X]big1 => [|j ji].
    by rewrite addr0 /sub_state trmx_mul !mulmxA block_tr mul1mx tr_row_mx trmx0 mul_col_mx mul0mx.
  by rewrite /sub_state trmx_mul !mulmxA block_tr0 1?eq_sym // !mul0mx.
by rewrite lifted_next col_mxKd !mulmxDr e0 e1 e2 !add_col_mx add0r addr0 [X in col_mx _ X]addrC.
Qed.

Lemma sub_cell i t (M : 'cV[K]_(\sum_i memory q N k d i)) : sub i t *m M = pick K (dmax i).+1 (k i) t *m usubmx (blk i *m M).
Proof. by rewrite /sub_state -mulmxA -[blk i *m M]vsubmxK mul_row_col mul0mx addr0 vsubmxK. Qed.
Lemma out_cell i t (M : 'cV[K]_(\sum_i memory q N k d i)) : out i t *m M = pick K (dmax i) (q i) t.-1 *m dsubmx (blk i *m M).
Proof. by rewrite /past_output -mulmxA -[blk i *m M]vsubmxK mul_row_col mul0mx add0r vsubmxK. Qed.

Theorem lifted_plant : usubmx next = mcA S *m x + \sum_i mcB S i *m u i.
Proof. by rewrite lifted_next col_mxKu. Qed.

(* (32), and (33): the lifts store what has been *)
Theorem lifted_first i : sub i 0 *m dsubmx next = v i.
Proof. by rewrite sub_cell own_memory col_mxKu first_cell. Qed.

Theorem lifted_later i t : (t < dmax i)%N -> sub i t.+1 *m dsubmx next = sub i t *m Y.
Proof. by move=> td; rewrite !sub_cell own_memory col_mxKu next_cell. Qed.

Theorem lifted_stored i : (0 < dmax i)%N -> out i 1 *m dsubmx next = mcC S i *m x.
Proof. by move=> d0; rewrite out_cell own_memory col_mxKd first_cell. Qed.

Theorem lifted_kept i t : (0 < t)%N -> (t < dmax i)%N -> out i t.+1 *m dsubmx next = out i t *m Y.
Proof. by case: t => // t _ td; rewrite !out_cell own_memory col_mxKd next_cell. Qed.

(* (34), in the order of (35): outputs that arrive at once, late outputs, sub-states *)
Theorem lifted_output i : mcC H i *m col_mx x Y =
  col_mx (\mxcol_j (if (j \in N i) && (d i j == 0)%N then mcC S j *m x else 0))
    (col_mx (\mxcol_j (if (j \in N i) && (d i j != 0)%N then out j (d i j) *m Y else 0))
            (\mxcol_j (if j \in N i then sub j (d i j) *m Y else 0))).
Proof.
rewrite /= mul_block_col !mul0mx addr0 add0r mul_col_mx !mxcol_mul.
by congr (col_mx _ (col_mx _ _)); apply: eq_mxcol => j; case: ifP => _; rewrite ?mul0mx.
Qed.
End Lifted.

Section LiftedTrajectory.
Notation H := (lifted N k d S).
Notation sub := (sub_state K q N k d).
Notation out := (past_output K q N k d).
Variables (x : nat -> 'cV[K]_n) (Y : nat -> 'cV[K]_(\sum_i memory q N k d i)).
Variables (u : nat -> forall i, 'cV[K]_(p i)) (v : nat -> forall i, 'cV[K]_(k i)).
Hypothesis steps : forall t, col_mx (x t.+1) (Y t.+1) = mcA H *m col_mx (x t) (Y t) + \sum_i mcB H i *m col_mx (u t i) (v t i).

Lemma lifted_step t : Y t.+1 = dsubmx (mcA H *m col_mx (x t) (Y t) + \sum_i mcB H i *m col_mx (u t i) (v t i)).
Proof. by rewrite -steps col_mxKd. Qed.

(* x_j(t - a) *)
Theorem lifted_shared j a t : (a <= dmax j)%N -> (a <= t)%N -> sub j a *m Y t = sub j 0 *m Y (t - a)%N.
Proof.
elim: a t => [|a IH] t; first by rewrite subn0.
by case: t => // t lt le; rewrite lifted_step lifted_later // IH // ltnW.
Qed.

(* y_j(t - a) *)
Theorem lifted_outputs j a t : (0 < a)%N -> (a <= dmax j)%N -> (a <= t)%N -> out j a *m Y t = mcC S j *m x (t - a)%N.
Proof.
elim: a t => // a IH t _; case: t => // t lt le; rewrite lifted_step.
case: a IH lt le => [|a] IH lt le; first by rewrite lifted_stored // subSS subn0.
by rewrite lifted_kept // IH // ltnW.
Qed.
End LiftedTrajectory.
End Delays.
