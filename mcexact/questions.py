"""Questions beside those at the top, and what the answers to all of them are.

    >>> import mcexact
    >>> from mcexact.questions import pencil_rank
    >>> plant = mcexact.gallery("liu2020-3ch-no-communication")
    >>> answer = pencil_rank(plant, ["1"], 1)
    >>> answer.rank, mcexact.check(answer).valid
    (5, True)

An answer has its claims as attributes, ``explain()`` for a reader, and is what
`mcexact.check` verifies and `mcexact.save_certificate` writes.
"""

from mcexact.analysis.analyze import Analysis
from mcexact.analysis.controllability import ExceptionalGains, exceptional_gains
from mcexact.analysis.failures import failures, fewest_failures
from mcexact.analysis.fixed_modes import pencil_rank
from mcexact.analysis.patterns import WhyFixed, structural_fixed_modes, why_fixed
from mcexact.analysis.single_channel import ErrorGains, error_gains, single_channel_gains
from mcexact.analysis.stability import certify_stability, open_loop_spectrum
from mcexact.analysis.structure import complementary_subsystem
from mcexact.answer.check import Verdict
from mcexact.answer.evidence import RateInterval, RootDisc
from mcexact.answer.failures import Failure, Failures, Fewest, FewestFailures
from mcexact.answer.loops import ClosedLoopSpectrum, StabilityVerdict
from mcexact.answer.modes import Assignability, Completeness, FixedFactor, FixedSpectrum, PencilRank
from mcexact.answer.patterns import StructuralFixedModes
from mcexact.answer.protocol import Answer
from mcexact.answer.structure import (
    ComplementarySubsystem,
    ControllabilityIndices,
    ExceptionalSet,
    JointControllability,
    SetpointSolvability,
    SingleChannelGains,
    TransferGraph,
)
from mcexact.answer.templates import Sentence
from mcexact.crosschecks.table import CrossChecks
from mcexact.sweeps.run import Record

__all__ = [
    "Analysis",
    "Answer",
    "Assignability",
    "ClosedLoopSpectrum",
    "ComplementarySubsystem",
    "Completeness",
    "ControllabilityIndices",
    "CrossChecks",
    "ErrorGains",
    "ExceptionalGains",
    "ExceptionalSet",
    "Failure",
    "Failures",
    "Fewest",
    "FewestFailures",
    "FixedFactor",
    "FixedSpectrum",
    "JointControllability",
    "PencilRank",
    "RateInterval",
    "Record",
    "RootDisc",
    "Sentence",
    "SetpointSolvability",
    "SingleChannelGains",
    "StabilityVerdict",
    "StructuralFixedModes",
    "TransferGraph",
    "Verdict",
    "WhyFixed",
    "certify_stability",
    "complementary_subsystem",
    "error_gains",
    "exceptional_gains",
    "failures",
    "fewest_failures",
    "open_loop_spectrum",
    "pencil_rank",
    "single_channel_gains",
    "structural_fixed_modes",
    "why_fixed",
]
