"""What designs consist of, controllers that come from elsewhere, and controllers as code.

    >>> import mcexact
    >>> from mcexact.designs import local_controllers
    >>> plant = mcexact.MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> mcexact.certify_controller(plant, local_controllers(plant, [[[-2]]])).stable
    True

The designs themselves are at the top: `mcexact.design_decentralized` and others.  Controllers whose
gains vary periodically are here: `design_periodic` and `certify_periodic`.
"""

from mcexact.answer.loops import DistributedObserver
from mcexact.derived.sampling import tustin
from mcexact.export.fixed import FixedPoint, SafeBits, least_fixed_point
from mcexact.model.controller import AgentProgram, LinearMap
from mcexact.model.periodic import (
    PeriodicController,
    load_periodic_controller,
    save_periodic_controller,
)
from mcexact.model.statespace import local_controllers, loop_from_statespace
from mcexact.synthesis.assessment import Assessment
from mcexact.synthesis.design import Design
from mcexact.synthesis.gate import CertifiedLoop
from mcexact.synthesis.longest_step import LongestStep, longest_step
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.periodic import PeriodicDesign, certify_periodic, design_periodic

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
    "PeriodicController",
    "PeriodicDesign",
    "SafeBits",
    "certify_periodic",
    "design_periodic",
    "least_fixed_point",
    "load_periodic_controller",
    "local_controllers",
    "longest_step",
    "loop_from_statespace",
    "save_periodic_controller",
    "tustin",
]
