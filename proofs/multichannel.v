(* Multi-channel linear systems: the one place where the objects of all proofs are defined.

   Letters are the paper's: n states, m channels, A is n x n, B_i is n x p_i, C_i is q_i x n.
   Dimensions p_i, q_i are arbitrary functions of the channel, so nothing is lost by padding.
   Channels are the ordinals 'I_m.  A stack over a set of channels keeps the place of every channel
   and writes zero blocks for those outside the set; this changes neither a rank nor an image. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory.
Local Open Scope ring_scope.

(* (mcs): x' = A x + sum_i B_i u_i, y_i = C_i x; (mcsd) in discrete time has the same data. *)
Record multichannel (R : Type) (n m : nat) (p q : 'I_m -> nat) := Multichannel {
  mcA : 'M[R]_n;
  mcB : forall i : 'I_m, 'M[R]_(n, p i);
  mcC : forall i : 'I_m, 'M[R]_(q i, n) }.

(* Constant decentralized gains: one F_i for each channel, u_i = F_i y_i. *)
Notation gains R p q := (forall i, 'M[R]_(p i, q i)).

Section Ring.
Variables (R : ringType) (n m : nat) (p q : 'I_m -> nat).
Implicit Types (S : multichannel R n p q) (T s : {set 'I_m}) (N : 'I_m -> {set 'I_m}).

(* A_F = A + sum_i B_i F_i C_i *)
Definition closed_loop S (F : gains R p q) : 'M[R]_n :=
  mcA S + \sum_i mcB S i *m F i *m mcC S i.

(* B_T and C_s *)
Definition inputs S T : 'M[R]_(n, \sum_i p i) := \mxrow_i (if i \in T then mcB S i else 0).
Definition outputs S s : 'M[R]_(\sum_i q i, n) := \mxcol_i (if i \in s then mcC S i else 0).

(* P_s(lambda) = [lambda I - A, B_{m-s}; C_s, 0] *)
Definition pencil S s (lambda : R) : 'M[R]_(n + \sum_i q i, n + \sum_i p i) :=
  block_mx (lambda%:M - mcA S) (inputs S (~: s)) (outputs S s) 0.

(* Dynamic linear time-invariant channel controllers z_i' = K_i z_i + L_i y_i, u_i = G_i z_i + F_i y_i;
   loop state (x, z). *)
Record controllers (k : 'I_m -> nat) := Controllers {
  ctF : gains R p q;
  ctG : forall i, 'M[R]_(p i, k i);
  ctL : forall i, 'M[R]_(k i, q i);
  ctK : forall i, 'M[R]_(k i) }.

Definition dynamic_loop k S (D : controllers k) : 'M[R]_(n + \sum_i k i) :=
  block_mx (closed_loop S (ctF D)) (\mxrow_i (mcB S i *m ctG D i))
           (\mxcol_i (ctL D i *m mcC S i)) (\mxdiag_i ctK D i).

(* N_s, the union of the neighbor sets of the members of s. *)
Definition neighborhood N s : {set 'I_m} := \bigcup_(i in s) N i.

(* (mss): every agent hears the outputs of its neighbors, C_i becomes C_{N_i}. *)
Definition augmented_outputs N S : multichannel R n p (fun=> \sum_i q i)%N :=
  Multichannel (mcA S) (mcB S) (fun i => outputs S (N i)).

(* E_i, the columns of the identity that belong to the shared sub-state x_i, and E'_{N_i}. *)
Definition shared_input (k : 'I_m -> nat) i : 'M[R]_(\sum_i k i, k i) := submxrow 1%:M i.
Definition shared_output (k : 'I_m -> nat) T : 'M[R]_(\sum_i k i) :=
  \mxcol_i (if i \in T then (shared_input k i)^T else 0).

(* (emcs): state (x, x_1, ..., x_m), outputs and sub-states shared. *)
Definition extended N (k : 'I_m -> nat) S :
    multichannel R (n + \sum_i k i) (fun i => p i + k i)%N (fun=> \sum_i q i + \sum_i k i)%N :=
  Multichannel (block_mx (mcA S) 0 0 0)
    (fun i => block_mx (mcB S i) 0 0 (shared_input k i))
    (fun i => block_mx (outputs S (N i)) 0 0 (shared_output k (N i))).

(* Remark 2: only sub-states shared. *)
Definition extended_states N (k : 'I_m -> nat) S :
    multichannel R (n + \sum_i k i) (fun i => p i + k i)%N (fun i => q i + \sum_i k i)%N :=
  Multichannel (block_mx (mcA S) 0 0 0)
    (fun i => block_mx (mcB S i) 0 0 (shared_input k i))
    (fun i => block_mx (mcC S i) 0 0 (shared_output k (N i))).
End Ring.

(* The same system over a larger ring or modulo l. *)
Definition map_system (R R' : Type) (f : R -> R') n m (p q : 'I_m -> nat)
    (S : multichannel R n p q) : multichannel R' n p q :=
  Multichannel (map_mx f (mcA S)) (fun i => map_mx f (mcB S i)) (fun i => map_mx f (mcC S i)).

(* Transposes of all matrices, inputs and outputs exchanged. *)
Definition dual (R : Type) n m (p q : 'I_m -> nat) (S : multichannel R n p q) : multichannel R n q p :=
  Multichannel (mcA S)^T (fun i => (mcC S i)^T) (fun i => (mcB S i)^T).

(* lambda is in the fixed spectrum: it is an eigenvalue of A_F for all gains F over the field of
   lambda.  For a system over K and lambda in an extension field L, with f : K -> L, the statement
   is fixed (map_system f S) lambda; gains over K alone give the weaker fixed_over f S lambda. *)
Definition fixed (K : fieldType) n m (p q : 'I_m -> nat) (S : multichannel K n p q) (lambda : K) :=
  forall F : gains K p q, eigenvalue (closed_loop S F) lambda.
Definition fixed_over (K L : fieldType) (f : K -> L) n m (p q : 'I_m -> nat)
    (S : multichannel K n p q) (lambda : L) :=
  forall F : gains K p q, eigenvalue (map_mx f (closed_loop S F)) lambda.
