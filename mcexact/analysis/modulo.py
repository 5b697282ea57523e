"""What no output shows and what no input moves: systems without these states, minimal realizations.

`modulo` leaves out of a system what all channels together do not observe, or do not control, or
both; or a subspace of the user's.  All questions can be asked of the result, and controllers be
designed for it: they are controllers of the plant, in whose loops the modes of what was left out
stay.  So formations and consensus, whose common position is meant to stay, have answers about the
rest.  `minimal_realization` leaves out both, and proves that nothing else can be.

The fixed modes of a plant are those of its minimal realization, *decentralized* ones, and those of
the states that were left out, *joint* ones, with multiplicities (``proofs/modulo.v``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.answer.structure import JointControllability
from mcexact.derived.modulo import PARTS, LeftOut, Part, parts_of, without_part
from mcexact.errors import UsageError, one_of
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem, any_system
from mcexact.shown import Shown, fitting

WHOLE: tuple[str, ...] = (*PARTS, "both")
"""What can be left out by name."""


def modulo(
    system: MultiChannelSystem,
    part: Part | Literal["both"] | Mapping[str, Any] = "unobservable",
) -> MultiChannelSystem:
    """Leave out the states that all channels together do not observe, or do not control, or both.

    Parameters
    ----------
    system : MultiChannelSystem
    part : {"unobservable", "uncontrollable", "both"}, or mapping
        A mapping such as ``{"unobservable": [[1, 1, 1]]}`` leaves out a subspace of the user's: for
        "unobservable" the one that the rows of the matrix span, which no output shows; for
        "uncontrollable" what the rows measure of the state, which no input moves.

    Returns
    -------
    MultiChannelSystem
        The system itself if there is nothing to leave out; else one with fewer states, and with
        the same channels, neighbor graph and transfer matrix.

    Raises
    ------
    UsageError
        If a subspace is not one as its part needs it; see `without_part`.
    InputError
        If the part is none of those that are expected.

    Notes
    -----
    Exact.  A certificate about the result contains the subspace and the characteristic polynomial
    of A on it, and the checker constructs the result again.  For all gains, and for all controllers
    of the channels, the characteristic polynomial of the plant's loop is that polynomial times the
    one of the loop of the result.  O(n³) operations on integers of the size of the subspace.

    Examples
    --------
    Four integrators that measure their positions relative to the next one:

    >>> from mcexact import analyze, fixed_spectrum
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("relative-positions-4")
    >>> str(fixed_spectrum(plant).polynomial)
    'x'
    >>> relative = modulo(plant)
    >>> relative.n, fixed_spectrum(relative).empty
    (3, True)
    >>> modulo(relative) is relative
    True
    >>> modulo(plant, {"unobservable": [[1, 0, 0, 0]]})
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: subspace: expected a subspace that no output shows
    """
    any_system(system)
    if isinstance(part, Mapping):
        if len(part) != 1:
            raise UsageError("expected one subspace, such as {'unobservable': rows}", where="part")
        [(own, subspace)] = part.items()
        return without_part(system, _part(own), subspace)
    one_of(part, WHOLE, "part")
    for name, decide in _DECIDE.items():
        if part in (name, "both"):
            system = _without(system, name, decide(system))
    return system


_DECIDE: Mapping[Part, Callable[[MultiChannelSystem], JointControllability]] = {
    "uncontrollable": joint_controllability,
    "unobservable": joint_observability,
}
"""What decides which states a part has; of both, what inputs do not move is left out first."""


def _part(name: Any) -> Part:
    """The part of this name."""
    one_of(name, PARTS, "part")
    found: Part = name
    return found


def _without(
    system: MultiChannelSystem, part: Part, decided: JointControllability
) -> MultiChannelSystem:
    """Leave out a part whose annihilator is known."""
    if decided.controllable:
        return system
    return without_part(system, part, decided.evidence.annihilator)


@dataclass(frozen=True, eq=False, repr=False)
class MinimalRealization(Shown):
    """A system with the transfer matrix of another one and with the fewest states.

        Â = T A S,   B̂_i = T B_i,   Ĉ_i = C_i S,   T S = I

    Attributes
    ----------
    given : MultiChannelSystem
        The system that is realized, with n states.
    system : MultiChannelSystem
        The realization (Â, B̂_i, Ĉ_i), with r states; the checker constructs it again.
    controllability, observability : JointControllability
        Proofs that all channels together control and observe the realization, so that no system
        with the same transfer matrix has fewer states.
    """

    given: MultiChannelSystem
    system: MultiChannelSystem
    controllability: JointControllability
    observability: JointControllability

    @property
    def order(self) -> int:
        """r, the number of states; the McMillan degree of the transfer matrix."""
        return self.system.n

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The parts of the state that were left out, with their characteristic polynomials."""
        return parts_of(self.system)[len(parts_of(self.given)) :]

    @cached_property
    def T(self) -> Matrix:
        """T, r×n: the states of the realization are T x for every x that inputs reach from 0."""
        return self._maps[0]

    @cached_property
    def S(self) -> Matrix:
        """S, n×r: S z is a state of the given system with the same outputs as z."""
        return self._maps[1]

    @cached_property
    def _maps(self) -> tuple[Matrix, Matrix]:
        """T and S, as products of those of the steps."""
        n = self.given.n
        T, S = Matrix.identity(n), Matrix.identity(n)
        for step in self.system.subject[len(self.given.subject) :]:
            W, pivots = step["annihilator"], set(step["pivots"])
            unit = Matrix.identity(W.ncols)
            kept = [j for j in range(W.ncols) if j not in pivots]
            selected = unit.take(rows=kept)
            slanted = selected.T - unit.take(cols=sorted(pivots)) @ W.take(cols=kept)
            if step["part"] == "unobservable":
                T, S = slanted.T @ T, S @ selected.T
            else:
                T, S = selected @ T, S @ slanted
        return T, S

    def explain(self) -> str:
        """Say in plain words how many states remain, and what was left out."""
        lines = [
            f"{self.order} of {self.given.n} states are needed; all channels together control and "
            "observe them."
        ]
        lines += [
            f"Left out: an {each.part} part of dimension {each.dimension}, with the "
            f"characteristic polynomial {each.polynomial}."
            for each in self.left_out
        ]
        return "\n".join(lines)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what is shown in notebooks."""
        yield "states", f"{self.order} of {self.given.n}"
        yield "realization", self.system
        yield from ((f"{each.part} part", each.polynomial) for each in self.left_out)

    def __repr__(self) -> str:
        return fitting(f"MinimalRealization({self.order} of {self.given.n} states)")


def minimal_realization(system: MultiChannelSystem) -> MinimalRealization:
    """Realize the transfer matrix of a system with the fewest states, exactly.

    Parameters
    ----------
    system : MultiChannelSystem
        With all channels together as its inputs and outputs.

    Returns
    -------
    MinimalRealization
        The realization, with the coordinates T and S and proofs that it is minimal.

    Notes
    -----
    Exact, and so is the order: that of the numbers as they are given.  Physical data that were
    rounded often have another order than the plant that they describe; `analyze` looks for plants
    within the rounding errors that have fewer (`Analysis.nearby`).

    What no input moves is left out first, then what no output shows of the rest.  O(n³) operations.

    Examples
    --------
    >>> from mcexact import check
    >>> A = [[-1, 0, 0], [0, -2, 0], [0, 0, -2]]
    >>> system = MultiChannelSystem(A, [[[1], [1], [2]]], [[[1, "1/3", "1/3"]]])
    >>> minimal = minimal_realization(system)
    >>> print(minimal.explain())
    2 of 3 states are needed; all channels together control and observe them.
    Left out: an uncontrollable part of dimension 1, with the characteristic polynomial x + 2.
    >>> minimal.T @ system.A @ minimal.S == minimal.system.A
    True
    >>> check(minimal.controllability).valid and check(minimal.observability).valid
    True
    """
    reduced = modulo(system, "both")
    return MinimalRealization(
        system, reduced, joint_controllability(reduced), joint_observability(reduced)
    )
