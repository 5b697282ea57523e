"""Two questions that floating point answers wrongly, computed now, beside the exact answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.model.system import MultiChannelSystem

SEEDS = 200
DIGITS = (6, 8, 10)


@dataclass(frozen=True)
class Demonstration:
    """The numbers that `mcexact demo` shows.

    Attributes
    ----------
    states : int
        n of the first system, A = diag(1, …, n), B = (1, …, 1)'.
    numerical_rank, exact_rank : int
        Of [B AB … A^(n−1)B].
    name : str
        Of the second system.
    none_found : tuple of (int, int)
        Digits kept, and in how many of the `SEEDS` runs no fixed mode was found.
    fixed : tuple of (str, int)
        The fixed factors and the multiplicity that no gain removes.
    channels : tuple of str
        The channels of the obstruction.
    """

    states: int
    numerical_rank: int
    exact_rank: int
    name: str
    none_found: tuple[tuple[int, int], ...]
    fixed: tuple[tuple[str, int], ...]
    channels: tuple[str, ...]

    def as_text(self) -> str:
        """The demonstration as plain text."""
        n = self.states
        powers = " * ".join(
            f"({factor})" + (f"^{multiplicity}" if multiplicity > 1 else "")
            for factor, multiplicity in self.fixed
        )
        lines = [
            f"1. Is A = diag(1, ..., {n}), B = (1, ..., 1)' controllable?",
            "",
            f"   numpy    matrix_rank([B AB ... A^{n - 1}B]) = {self.numerical_rank}:"
            f" {_controllable(self.numerical_rank, n)}",
            f"   mcexact  rank = {self.exact_rank}: {_controllable(self.exact_rank, n)}",
            "",
            f"2. Which modes of '{self.name}' (5 states, 2 channels, integers below 10)",
            "   stay under every decentralized gain?",
            "",
            *(
                f"   numpy    eigenvalues of 5 drawn closed loops, rounded to {digits} digits:"
                f" none, in {none} of {SEEDS} runs"
                for digits, none in self.none_found
            ),
            f"   mcexact  {powers}: unstable, whatever constant gains",
            "",
        ]
        return "\n".join(lines)

    def as_json(self) -> dict[str, Any]:
        """The demonstration as plain data."""
        return {
            "controllability": {
                "states": self.states,
                "numpy": {"rank": self.numerical_rank},
                "mcexact": {"rank": self.exact_rank},
            },
            "fixed_modes": {
                "system": self.name,
                "numpy": [
                    {"digits": digits, "runs": SEEDS, "runs_that_found_none": none}
                    for digits, none in self.none_found
                ],
                "mcexact": [
                    {"factor": factor, "multiplicity_at_most": multiplicity}
                    for factor, multiplicity in self.fixed
                ],
            },
        }


def demonstration() -> Demonstration:
    """Compute both failures and both exact answers.

    Examples
    --------
    >>> shown = demonstration()
    >>> shown.numerical_rank, shown.exact_rank
    (7, 20)
    >>> shown.none_found, shown.fixed
    (((6, 200), (8, 200), (10, 200)), (('x - 1', 3),))
    """
    from mcexact.analysis.controllability import joint_controllability
    from mcexact.analysis.fixed_spectrum import fixed_spectrum
    from mcexact.floating.controllability import controllability_rank
    from mcexact.model import gallery
    from mcexact.model.system import MultiChannelSystem

    n = 20
    diagonal = [[i + 1 if i == j else 0 for j in range(n)] for i in range(n)]
    chain = MultiChannelSystem(diagonal, [[[1]] * n], [[[1] * n]])
    A, B, _ = _arrays(chain)
    plant = gallery.load("hidden-triple-mode")
    spectrum = fixed_spectrum(plant)
    return Demonstration(
        states=n,
        numerical_rank=controllability_rank(A, B[0]),
        exact_rank=joint_controllability(chain).dimension,
        name=plant.name or "hidden-triple-mode",
        none_found=tuple((digits, _none_found(plant, digits)) for digits in DIGITS),
        fixed=tuple((str(f.polynomial), f.multiplicity_at_most) for f in spectrum.factors),
        channels=spectrum.factors[0].channels,
    )


def _none_found(plant: MultiChannelSystem, digits: int) -> int:
    """In how many runs rounding finds no fixed mode."""
    from mcexact.floating.fixed_modes import rounded_fixed_modes

    A, B, C = _arrays(plant)
    runs = (rounded_fixed_modes(A, B, C, digits=digits, seed=seed) for seed in range(SEEDS))
    return sum(not found for found in runs)


def _arrays(system: MultiChannelSystem) -> tuple[Any, Sequence[Any], Sequence[Any]]:
    """A, the B_i and the C_i as arrays of floats."""
    from mcexact.exact.floats import matrix_to_float

    return (
        matrix_to_float(system.A),
        [matrix_to_float(channel.B) for channel in system.channels],
        [matrix_to_float(channel.C) for channel in system.channels],
    )


def _controllable(rank: int, n: int) -> str:
    return "controllable" if rank == n else f"not controllable (full rank is {n})"
