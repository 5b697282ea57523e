"""Two questions that floating point answers wrongly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.crosschecks.table import Libraries, libraries_here, libraries_of, recorded
from mcexact.exact.matrix import matrix_to_float
from mcexact.floating.verdicts import controllability_rank, rounded_fixed_modes
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
        fixed_modes = [
            {"digits": digits, "runs_that_found_none": none} for digits, none in self.none_found
        ]
        return {
            "rank": self.rank,
            "fixed_modes": fixed_modes,
            "libraries": self.libraries.document(),
        }

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
    return sum(not modes for modes in runs)


def _arrays(system: MultiChannelSystem) -> tuple[Any, Sequence[Any], Sequence[Any]]:
    """A, the B_i and the C_i as arrays of floats."""
    return (
        matrix_to_float(system.A),
        [matrix_to_float(channel.B) for channel in system.channels],
        [matrix_to_float(channel.C) for channel in system.channels],
    )


# Its display; the recorded part of the text is the same on every machine.


def demonstration_text(shown: Demonstration) -> str:
    """The recorded answers beside the exact ones, then the answers of this machine."""
    return f"{_recorded_text(shown)}\n{_text_here(shown)}"


def _recorded_text(shown: Demonstration) -> str:
    """The recorded answers beside the exact ones; nothing is computed in floating point."""
    powers = " * ".join(
        f"({factor})" + (f"^{multiplicity}" if multiplicity > 1 else "")
        for factor, multiplicity in shown.fixed
    )
    recorded = shown.recorded
    lines = [
        f"1. Is A = diag(1, ..., {STATES}), B = (1, ..., 1)' controllable?",
        "",
        f"   numpy    {_rank(recorded)}: {_controllable(recorded.rank)}",
        f"   mcexact  rank = {shown.rank}: {_controllable(shown.rank)}",
        "",
        f"2. Which modes of '{shown.name}' (5 states, 2 channels, integers below 10)",
        "   stay under every decentralized gain?",
        "",
        *(f"   numpy    {line}" for line in _rounded(recorded)),
        f"   mcexact  {powers}: unstable under all constant gains",
        "",
        "numpy's answers depend on how a processor rounds; these were recorded with",
        f"{recorded.libraries}.",
        "",
    ]
    return "\n".join(lines)


def _text_here(shown: Demonstration) -> str:
    """The floating-point answers of this machine, if they differ from the recorded ones."""
    here, recorded = shown.here, shown.recorded
    now = [f"1. {_rank(here)}", *(f"2. {line}" for line in _rounded(here))]
    then = [f"1. {_rank(recorded)}", *(f"2. {line}" for line in _rounded(recorded))]
    other = [line for line, old in zip(now, then, strict=True) if line != old]
    if not other:
        return f"On this machine they are the same, with\n{here.libraries}.\n"
    listed = "".join(f"   {line}\n" for line in other)
    return f"On this machine they differ, with\n{here.libraries}:\n\n{listed}"


def _rank(answers: FloatingAnswers) -> str:
    return f"matrix_rank([B AB ... A^{STATES - 1}B]) = {answers.rank}"


def _rounded(answers: FloatingAnswers) -> list[str]:
    """A line for each number of digits."""
    return [
        f"eigenvalues of 5 drawn closed loops, rounded to {digits} digits:"
        f" none, in {none} of {SEEDS} runs"
        for digits, none in answers.none_found
    ]


def _controllable(rank: int) -> str:
    full = f"not controllable (full rank is {STATES})"
    return "controllable" if rank == STATES else full


def demonstration_view(shown: Demonstration) -> dict[str, Any]:
    """The demonstration as plain data."""
    return {
        "controllability": {"states": STATES, "mcexact": {"rank": shown.rank}},
        "fixed_modes": {
            "system": shown.name,
            "mcexact": [
                {"factor": factor, "multiplicity_at_most": multiplicity}
                for factor, multiplicity in shown.fixed
            ],
        },
        "numpy": {
            "runs": SEEDS,
            "recorded": shown.recorded.document(),
            "here": shown.here.document(),
        },
    }
