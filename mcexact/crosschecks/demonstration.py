"""Two questions that floating point answers wrongly: recorded, local and exact answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.crosschecks.records import Libraries, libraries_here, libraries_of, recorded
from mcexact.exact.matrix import matrix_to_float
from mcexact.floating.controllability import controllability_rank
from mcexact.floating.fixed_modes import rounded_fixed_modes
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem

STATES = 20
SEEDS = 200
_DIGITS = (6, 8, 10)
_PLANT = "hidden-triple-mode"


@dataclass(frozen=True)
class FloatingAnswers:
    """The answers of floating point to both questions.

    Attributes
    ----------
    rank : int
        The computed rank of [B AB … A^(n−1)B] for A = diag(1, …, n), B = (1, …, 1)'.
    none_found : tuple of (int, int)
        For several numbers of digits, in how many of the `SEEDS` runs no fixed mode was found.
    libraries : Libraries
        The libraries that computed the answers.
    """

    rank: int
    none_found: tuple[tuple[int, int], ...]
    libraries: Libraries

    @property
    def misleading(self) -> bool:
        """Whether the rank is too small, and no number of digits shows the fixed modes."""
        return self.rank < STATES and all(none for _, none in self.none_found)

    def document(self) -> dict[str, Any]:
        """The answers as plain data of a JSON document."""
        found = [
            {"digits": digits, "runs_that_found_none": none} for digits, none in self.none_found
        ]
        return {"rank": self.rank, "fixed_modes": found, "libraries": self.libraries.document()}

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> FloatingAnswers:
        """Read the answers from the data that `document` returns."""
        none_found = tuple(
            (row["digits"], row["runs_that_found_none"]) for row in document["fixed_modes"]
        )
        return cls(document["rank"], none_found, libraries_of(document["libraries"]))


@dataclass(frozen=True)
class Demonstration:
    """The recorded, local and exact answers that `mcexact demo` shows.

    Attributes
    ----------
    rank : int
        The exact rank of the controllability matrix of the first system.
    name : str
        The name of the second system.
    fixed : tuple of (str, int)
        Its fixed factors and their multiplicities under all gains, computed exactly.
    recorded, here : FloatingAnswers
        The answers of floating point that ship with the package, and those of this machine.
    """

    rank: int
    name: str
    fixed: tuple[tuple[str, int], ...]
    recorded: FloatingAnswers
    here: FloatingAnswers


def demonstration() -> Demonstration:
    """Answer both questions exactly and in floating point, and load the recorded answers.

    Examples
    --------
    >>> shown = demonstration()
    >>> shown.rank, shown.fixed
    (20, (('x - 1', 3),))
    """
    plant = gallery.load(_PLANT)
    spectrum = fixed_spectrum(plant)
    return Demonstration(
        rank=joint_controllability(_diagonal()).dimension,
        name=plant.name or _PLANT,
        fixed=tuple((str(f.polynomial), f.multiplicity_at_most) for f in spectrum.factors),
        recorded=FloatingAnswers.from_document(recorded()["demonstration"]),
        here=floating_answers(),
    )


def floating_answers() -> FloatingAnswers:
    """Answer both questions in floating point on this machine."""
    A, B, _ = _arrays(_diagonal())
    hidden = _arrays(gallery.load(_PLANT))
    return FloatingAnswers(
        controllability_rank(A, B[0]),
        tuple((digits, _none_found(*hidden, digits)) for digits in _DIGITS),
        libraries_here(),
    )


def _diagonal() -> MultiChannelSystem:
    """The system A = diag(1, …, n) with one input that acts on every state."""
    A = [[(i + 1) * (i == j) for j in range(STATES)] for i in range(STATES)]
    return MultiChannelSystem(A, [[[1]] * STATES], [[[1] * STATES]])


def _none_found(A: Any, B: Sequence[Any], C: Sequence[Any], digits: int) -> int:
    """The number of runs in which comparing rounded eigenvalues finds no fixed mode."""
    runs = (rounded_fixed_modes(A, B, C, digits=digits, seed=seed) for seed in range(SEEDS))
    return sum(not found for found in runs)


def _arrays(system: MultiChannelSystem) -> tuple[Any, Sequence[Any], Sequence[Any]]:
    """A, the B_i and the C_i as arrays of floats."""
    return (
        matrix_to_float(system.A),
        [matrix_to_float(channel.B) for channel in system.channels],
        [matrix_to_float(channel.C) for channel in system.channels],
    )
