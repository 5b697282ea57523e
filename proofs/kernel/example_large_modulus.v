(* All fixed modes of the plant 2a0c798f751d93f36b7d042ce2bc8512b1d804cf739db7b144239748ee41d4bc.
   The lists have A, B_i and C_i over one denominator.  claim_holds, in mcexact.kernel.fixed_rule, and regions_hold, in
   mcexact.kernel.regions_rule, say what the claim means. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mcexact Require Import multichannel completeness.
From mcexact.kernel Require Import lists systems residues krylov_rule shrunk_rule coprime_rule blocks_rule hessenberg_rule spectrum_rule loop_rule fixed_rule large_rule regions_rule facts reach_rule arcs_rule setpoint_rule program_rule kinds.

Definition plant : zsystem := (ZSystem 2 2%coqZ [:: [:: 1%coqZ; 2%coqZ]; [:: 0%coqZ; 1%coqZ]] [:: (ZChannel 1 1 [:: [:: 0%coqZ]; [:: 0%coqZ]] [:: [:: 2%coqZ; 0%coqZ]])] [::]).
Definition claim : zclaim := (ZClaim [:: (-1)%coqZ; 2%coqZ] [:: (ZFactor [:: (-1)%coqZ; 2%coqZ] None 2 [:: false] 1)]).
Definition regions : zregions := (ZRegions 2%coqZ true [:: false] [:: [:: (ZDisc 1%coqZ 0%coqZ 0%coqZ)]] false (Some ((-1)%coqZ, (-1)%coqZ))).
Definition rules : seq rule := [:: (RShrunk [::] [:: (-1)%coqZ; 2%coqZ] (ShrunkWitness [:: true] [:: [:: [:: 1%coqZ]; [:: 0%coqZ]]] [:: [::]] 1%coqZ [:: 0] 0 [:: [::]; [::]] [:: [::]] 1%coqZ) 1); (RCoprime [:: (-1)%coqZ; 2%coqZ] [:: 1%coqZ] (Bezout 5%coqZ 3%coqZ [::] [:: 1%coqZ])); (RLow [::] [:: (-1)%coqZ; 2%coqZ] 1 (LowWitness (LoopWitness 5%coqZ 3%coqZ [:: [:: [:: 1%coqZ]]] (Similar [:: [:: 3%coqZ; 1%coqZ]; [:: 1%coqZ; 3%coqZ]] [:: [:: 1%coqZ; 0%coqZ]; [:: 0%coqZ; 1%coqZ]] [:: 0; 1])) [:: [:: 0%coqZ]; [:: 1%coqZ]] [:: [:: 1%coqZ; 0%coqZ]] 3%coqZ [:: 1%coqZ; 3%coqZ] [:: 4%coqZ])); (RAllLarge [::] (ZClaim [:: (-1)%coqZ; 2%coqZ] [:: (ZFactor [:: (-1)%coqZ; 2%coqZ] None 2 [:: false] 1)]) (LargeWitness (LoopWitness 5%coqZ 3%coqZ [:: [:: [:: 1%coqZ]]] (Similar [:: [:: 3%coqZ; 1%coqZ]; [:: 0%coqZ; 3%coqZ]] [:: [:: 1%coqZ; 0%coqZ]; [:: 0%coqZ; 1%coqZ]] [:: 0; 1])) (Similar [:: [:: 3%coqZ; 1%coqZ]; [:: 0%coqZ; 3%coqZ]] [:: [:: 1%coqZ; 0%coqZ]; [:: 0%coqZ; 1%coqZ]] [:: 0; 1]) [:: (Power 3%coqZ [::] [:: 1%coqZ] 0 1%coqZ)] [:: 1%coqZ] [:: 1%coqZ] [::] 2%coqZ [:: [:: 1%coqZ; 2%coqZ]; [:: 0%coqZ; 1%coqZ]] 2%coqZ [:: (-1)%coqZ; 1%coqZ]) [:: (FactorPremises 0 1 0 0 2 0 (ExponentWitness [::] [::] [::] 0%coqZ))])].
Lemma sized : sized_system plant. Proof. by vm_compute. Qed.
Theorem fixed_spectrum : (forall (K : fieldType) (h : {rmorphism rat -> K}), claim_holds (system_of K plant) claim) /\
  (forall C : numClosedFieldType, regions_hold (system_of C plant) claim regions).
Proof. by apply: (@check_whole_plant plant rules regions claim); vm_compute. Qed.

