"""Exact, certified analysis and design of multi-channel linear systems.

    >>> import mcexact
    >>> plant = mcexact.gallery("liu2020-3ch-no-communication")
    >>> answer = mcexact.fixed_spectrum(plant)
    >>> str(answer.polynomial), mcexact.check(answer).valid
    ('x - 1', True)

Plants and controllers
    MultiChannelSystem  NeighborGraph  Controller  ParametricSystem  Matrix  Polynomial
    StabilityRegion  gallery  load_system  save_system  load_controller  save_controller
    from_statespace  to_statespace
Questions about a plant; ``analyze`` asks all of them
    analyze  fixed_spectrum  transfer_graph  completeness  controllability_indices
    observability_indices  joint_controllability  joint_observability  assignability
    pencil_ranks  setpoint_solvability  minimal_communication  minimal_realization
Controllers
    design_decentralized  design_extended  design_observer  design_setpoint
    certify_controller  assess  simulate  export_controller
Many plants, tables, comparison with floating point
    sweep  to_pandas  crosscheck
Certificates
    check  load_certificate  save_certificate
Errors
    McexactError  InputError  LimitReached

More is in modules, each of which opens with its use:

=================  ==============================================================
`constructions`    systems made from systems: dual, merged, sampled, variants, ...
`questions`        further questions, and what the answers are
`parameters`       answers for all values of parameters
`boxes`            answers for all plants within uncertain data
`performance`      cost, its bound, margins, step peaks, saturation
`sharing`          what agents must share, and how much
`designs`          what designs are made of; code for agents
`simulation`       the real loop, late, rounded and limited
`plot`             pictures, with matplotlib
`testing`          Hypothesis strategies
`errors`           all errors
=================  ==============================================================

Controllers are linear and time-invariant here, static or dynamic, and a fixed mode is one that
none of these moves.  Controllers that vary with time can move some fixed modes.

Each name is loaded when it is first used.  All other names may change without notice.
"""

import lazy_loader

from mcexact.errors import examine_rounded_by

__version__ = "0.1.0"
__getattr__, __dir__, _names = lazy_loader.attach_stub(__name__, __file__)


def _doubts(system):
    # Only when a plant is made of floats: it loads flint and the questions.
    from mcexact.analysis.analyze import rounding_doubts

    return rounding_doubts(system)


examine_rounded_by(_doubts)
