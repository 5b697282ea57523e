"""What designs consist of, controllers that come from elsewhere, and controllers as code.

    >>> import mcexact
    >>> from mcexact.designs import local_controllers
    >>> plant = mcexact.MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> mcexact.certify_controller(plant, local_controllers(plant, [[[-2]]])).stable
    True

The designs themselves are at the top: `mcexact.design_decentralized` and others.
"""

from mcexact.answer.loops import DistributedObserver
from mcexact.derived.sampling import tustin
from mcexact.export.fixed import FixedPoint, SafeBits, least_fixed_point
from mcexact.model.controller import AgentProgram, LinearMap
from mcexact.model.statespace import local_controllers, loop_from_statespace
from mcexact.synthesis.assessment import Assessment
from mcexact.synthesis.design import Design
from mcexact.synthesis.gate import CertifiedLoop
from mcexact.synthesis.longest_step import LongestStep, longest_step
from mcexact.synthesis.optimum.figures import Aims

__all__ = [
    "AgentProgram",
    "Aims",
    "Assessment",
    "CertifiedLoop",
    "Design",
    "DistributedObserver",
    "FixedPoint",
    "LinearMap",
    "LongestStep",
    "SafeBits",
    "least_fixed_point",
    "local_controllers",
    "longest_step",
    "loop_from_statespace",
    "tustin",
]
