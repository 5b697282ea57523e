"""All questions that are decided for all values of parameters."""

from __future__ import annotations

from functools import partial
from typing import Any

from mcexact.analysis.exceptional_hypersurfaces import exceptional_hypersurfaces
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import (
    joint_controllability,
    joint_observability,
)
from mcexact.answer.parametric_analysis import ParametricAnalysis
from mcexact.model.parametric import ParametricSystem

_ONE: dict[str, Any] = {
    "fixed_spectrum": fixed_spectrum,
    "joint_controllability": joint_controllability,
    "joint_observability": joint_observability,
}
_SEVERAL: dict[str, Any] = {
    "fixed_spectrum": exceptional_hypersurfaces,
    "joint_controllability": partial(exceptional_hypersurfaces, question="joint_controllability"),
    "joint_observability": partial(exceptional_hypersurfaces, question="joint_observability"),
}


def parametric_analysis(plant: ParametricSystem) -> ParametricAnalysis:
    """Decide the fixed modes, joint controllability and joint observability for all values.

    Parameters
    ----------
    plant : ParametricSystem

    Examples
    --------
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
    >>> print(parametric_analysis(plant).sentences[1])
    A mode is fixed where t = 0.
    """
    asked = _ONE if len(plant.parameters) == 1 else _SEVERAL
    return ParametricAnalysis(plant, {name: decide(plant) for name, decide in asked.items()})
