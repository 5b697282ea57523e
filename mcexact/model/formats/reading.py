"""How a file is read: how much of it, and what some kinds of files leave open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mcexact.exact.floats import Rounding
from mcexact.exact.rational import DEFAULT_LIMITS, Limits


@dataclass(frozen=True)
class Reading:
    """What every reader of system files is told.

    Attributes
    ----------
    limits : Limits
    rounding : {"decimal", "dyadic"}, optional
        How floats become exact numbers, as in `MultiChannelSystem.from_float`; without it as the
        file says, or else a float is accepted only if it is an integer.
    inputs, outputs : sequences of int, optional
        The numbers of inputs and outputs of the channels, where B and C are stacked and the file
        does not say.
    """

    limits: Limits = DEFAULT_LIMITS
    rounding: Rounding | None = None
    inputs: Sequence[int] | None = None
    outputs: Sequence[int] | None = None


AS_TYPED = Reading()
"""The files of this package, in which numbers are exact as they are typed."""
