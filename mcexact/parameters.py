"""Answers for all values of parameters, with the values and hypersurfaces that are exceptions.

    >>> import mcexact
    >>> from mcexact.parameters import exceptional_hypersurfaces
    >>> plant = mcexact.ParametricSystem(
    ...     [[0, "a"], [0, 1]], [[[0], [1]]], [[["b - a", 1]]], parameters=["a", "b"]
    ... )
    >>> [str(each) for each in exceptional_hypersurfaces(plant).hypersurfaces]
    ['a = 0', 'a - b = 0', 'a^2 - a*b - 1 = 0']

`mcexact.fixed_spectrum`, `mcexact.analyze` and several others take systems with parameters, too.
"""

from mcexact.analysis.parameters.hypersurfaces import (
    ParametricCompleteness,
    ParametricTransferGraph,
    exceptional_hypersurfaces,
)
from mcexact.analysis.parameters.modes import ParametricSharing, shared_dimensions_for_every_value
from mcexact.analysis.parameters.ranks import signal_solvability
from mcexact.answer.parameters import (
    ExceptionalValue,
    LowerRank,
    ParametricFixedSpectrum,
    ParametricRank,
)
from mcexact.answer.several_parameters import (
    ExceptionalHypersurfaces,
    Hypersurface,
    RankHypersurfaces,
)
from mcexact.model.files import load_parametric_system

__all__ = [
    "ExceptionalHypersurfaces",
    "ExceptionalValue",
    "Hypersurface",
    "LowerRank",
    "ParametricCompleteness",
    "ParametricFixedSpectrum",
    "ParametricRank",
    "ParametricSharing",
    "ParametricTransferGraph",
    "RankHypersurfaces",
    "exceptional_hypersurfaces",
    "load_parametric_system",
    "shared_dimensions_for_every_value",
    "signal_solvability",
]
