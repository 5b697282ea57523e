"""Exact, certified analysis of multi-channel linear systems.

Control and controllers are linear and time-invariant here, with states of their own or without:
a fixed mode is one that none of these moves.  Controllers that vary with time can move some.

Names are loaded when they are first used, so that importing the package is quick and loads none of
the heavy libraries.
"""

import importlib
from typing import TYPE_CHECKING, Any

from mcexact.analysis.questions import QUESTIONS

if TYPE_CHECKING:
    from mcexact.analysis.analyze import analyze as analyze
    from mcexact.analysis.fixed_modes.assignability import assignability as assignability
    from mcexact.analysis.fixed_modes.completeness import completeness as completeness
    from mcexact.analysis.fixed_modes.error_gains import error_gains as error_gains
    from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum as fixed_spectrum
    from mcexact.analysis.fixed_modes.pencil import pencil_rank as pencil_rank
    from mcexact.analysis.fixed_modes.pencil import pencil_ranks as pencil_ranks
    from mcexact.analysis.fixed_modes.single_channel_gains import (
        single_channel_gains as single_channel_gains,
    )
    from mcexact.analysis.sharing.allocation import (
        minimal_shared_dimensions as minimal_shared_dimensions,
    )
    from mcexact.analysis.sharing.allocation import shared_dimension_bound as shared_dimension_bound
    from mcexact.analysis.sharing.communication import (
        minimal_communication as minimal_communication,
    )
    from mcexact.analysis.stability.closed_loop_spectrum import (
        open_loop_spectrum as open_loop_spectrum,
    )
    from mcexact.analysis.stability.stability import certify_stability as certify_stability
    from mcexact.analysis.stability.stability import matrix_system as matrix_system
    from mcexact.analysis.structure.complementary_subsystem import (
        complementary_subsystem as complementary_subsystem,
    )
    from mcexact.analysis.structure.controllability import (
        joint_controllability as joint_controllability,
    )
    from mcexact.analysis.structure.controllability import (
        joint_observability as joint_observability,
    )
    from mcexact.analysis.structure.controllability_indices import (
        controllability_indices as controllability_indices,
    )
    from mcexact.analysis.structure.controllability_indices import (
        observability_indices as observability_indices,
    )
    from mcexact.analysis.structure.exceptional_gains import exceptional_gains as exceptional_gains
    from mcexact.analysis.structure.setpoint import setpoint_solvability as setpoint_solvability
    from mcexact.analysis.structure.transfer_graph import transfer_graph as transfer_graph
    from mcexact.answer.check import check as check
    from mcexact.answer.codec import save_certificate as save_certificate
    from mcexact.answer.reading import load_certificate as load_certificate
    from mcexact.crosscheck.table import crosscheck as crosscheck
    from mcexact.derived.augmented_outputs import augmented_outputs as augmented_outputs
    from mcexact.derived.delayed import held_system as held_system
    from mcexact.derived.delayed import lifted_system as lifted_system
    from mcexact.derived.dual import dual as dual
    from mcexact.derived.error_system import error_system as error_system
    from mcexact.derived.extended import extended_system as extended_system
    from mcexact.derived.integrators import setpoint_system as setpoint_system
    from mcexact.model.controller_file import load_controller as load_controller
    from mcexact.model.controller_file import save_controller as save_controller
    from mcexact.model.local_controllers import local_controllers as local_controllers
    from mcexact.model.neighbor_graph import NeighborGraph as NeighborGraph
    from mcexact.model.statespace import loop_from_statespace as loop_from_statespace
    from mcexact.model.system import MultiChannelSystem as MultiChannelSystem
    from mcexact.model.system_file import load_system as load_system
    from mcexact.model.system_file import save_system as save_system
    from mcexact.simulation.trajectory import simulate as simulate
    from mcexact.synthesis.certify import certify_controller as certify_controller
    from mcexact.synthesis.decentralized import design_decentralized as design_decentralized
    from mcexact.synthesis.extended import design_extended as design_extended
    from mcexact.synthesis.observer import design_observer as design_observer
    from mcexact.synthesis.setpoint import design_setpoint as design_setpoint

_HOME = {
    "MultiChannelSystem": "model.system",
    "NeighborGraph": "model.neighbor_graph",
    "analyze": "analysis.analyze",
    "augmented_outputs": "derived.augmented_outputs",
    "certify_controller": "synthesis.certify",
    "certify_stability": "analysis.stability.stability",
    "check": "answer.check",
    "crosscheck": "crosscheck.table",
    "design_decentralized": "synthesis.decentralized",
    "design_extended": "synthesis.extended",
    "design_observer": "synthesis.observer",
    "design_setpoint": "synthesis.setpoint",
    "dual": "derived.dual",
    "error_gains": "analysis.fixed_modes.error_gains",
    "error_system": "derived.error_system",
    "exceptional_gains": "analysis.structure.exceptional_gains",
    "extended_system": "derived.extended",
    "held_system": "derived.delayed",
    "lifted_system": "derived.delayed",
    "load_certificate": "answer.reading",
    "load_controller": "model.controller_file",
    "load_system": "model.system_file",
    "local_controllers": "model.local_controllers",
    "loop_from_statespace": "model.statespace",
    "matrix_system": "analysis.stability.stability",
    "pencil_rank": "analysis.fixed_modes.pencil",
    "save_certificate": "answer.codec",
    "save_controller": "model.controller_file",
    "save_system": "model.system_file",
    "setpoint_system": "derived.integrators",
    "simulate": "simulation.trajectory",
}
# A question is the function that decides it.
_HOME |= {
    question.function: f"analysis.{question.module}"
    for question in QUESTIONS.values()
    if question.function != "neighbor_graph"
}

__version__ = "0.1.0"
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(set(globals()) | set(_HOME))
