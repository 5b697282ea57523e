(* What an application of a theorem has to be about: a system with two or more states and channels and a matrix A that is
   not 0, or a graph of two or more agents.  `assumptions.py` asks for every theorem that the ledger cites whether some
   statement in the files instances*.v mentions such a system or graph and has no hypothesis left; Coq answers by
   the tactics at the end. *)
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Local Open Scope ring_scope.

Class concrete_system (R : ringType) n m (p q : 'I_m -> nat) (S : multichannel R n p q) : Prop :=
  ConcreteSystem { two_states : (1 < n)%N; two_channels : (1 < m)%N; moves : mcA S != 0 }.
Class concrete_graph m (N : 'I_m -> {set 'I_m}) : Prop := ConcreteGraph { two_agents : (1 < m)%N }.

(* nothing before the conclusion is a hypothesis: what is universally quantified are objects, not proofs *)
Ltac without_hypotheses := lazymatch goal with
  | |- forall x : ?T, _ => lazymatch type of T with Prop => fail "a hypothesis is left:" T | _ => intro; without_hypotheses end
  | |- _ => idtac end.

(* the statement mentions a system or graph that is registered as concrete *)
Ltac about_concrete := match goal with
  | |- context [?S] => let c := constr:(_ : concrete_system S) in idtac
  | |- context [?N] => let c := constr:(_ : concrete_graph N) in idtac
  | |- _ => fail "no concrete system or graph" end.

(* what `assumptions.py` asks of the type of a statement *)
Ltac describe T := cut T; [exact (fun _ => I) | cbv zeta; first
  [ without_hypotheses; first [about_concrete; idtac "CONCRETE" | idtac "ABSTRACT"]
  | idtac "HYPOTHESES" ]].
