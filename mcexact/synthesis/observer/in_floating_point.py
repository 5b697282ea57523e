"""Distributed observers designed in floating point and certified exactly."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import joint_controllability, joint_observability
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.wording import refusals as say
from mcexact.derived.error_system import error_system
from mcexact.derived.feedback import closed_by
from mcexact.derived.modular_system import generator
from mcexact.errors import LimitReached
from mcexact.exact.floats import dyadic_matrix, matrix_to_float
from mcexact.exact.location import StabilityRegion, is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.floating.margins import is_within
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Proposal
from mcexact.synthesis.methods import riccati_feedback, split_by_channel
from mcexact.synthesis.observer.coordinates import observer_coordinates
from mcexact.synthesis.observer.error_observer import (
    ErrorObserver,
    full_order_observer,
    reduced_order_observer,
)
from mcexact.synthesis.observer.programs import observer_programs
from mcexact.synthesis.observer.promising import most_promising, rounds
from mcexact.synthesis.request import Request

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]

_BITS = (36, 52)
_EFFORTS = (1.0, 1e2, 1e4, 1e-2)
_GRID = 8


@dataclass(frozen=True)
class _Candidate:
    """Observer gains [K_i, H_ij …], with gains for the resulting error system."""

    observer_gains: tuple[Matrix, ...]
    G: Matrix
    observer: ErrorObserver
    size: float


def float_proposals(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    request: Request,
    *,
    gains: Sequence[Matrix] | None = None,
    reduced: bool = False,
) -> Iterator[Proposal]:
    """Propose distributed observers for a region from Riccati equations, the most promising first.

    Parameters
    ----------
    system : MultiChannelSystem
        A system with n states and m channels; modes inside the region need not be controllable or
        observable.
    graph : NeighborGraph
        Without delays.
    agent : int
        q, counted from 0.
    request : Request
    gains : sequence of m Matrix, optional
        Given F_i (p_i×n).
    reduced : bool
        Whether to propose observers of reduced order first.

    Raises
    ------
    Impossible
        At the end, if all channels together do not control or do not observe a mode outside the
        region, or it is fixed for the error system of these F_i; the certificate proves this.
    LimitReached
        At the end, if no such obstruction exists.

    Notes
    -----
    Floating point proposes F_i, K_i, H_ij, G and L; the gate certifies the loop with these rational
    numbers block by block (`observer_coordinates`).  Of several draws of K_i, H_ij the one with the
    smallest G and L comes first.  The channel controller, of order nm, is

        z' = (E − B̃G − LC̃) z + L ỹ,     ũ = −G z,

    with its first matrix exact, so that the separation is exact; for the reduced order nm − rank C̃
    see `reduced_order_observer`.  O((nm)³) operations.  The proposals, and hence the controller and
    its certificate, depend on the processor and on the versions of numpy and scipy.
    """
    _require_doubles(system)
    tried, region = 0, request.region
    for each in rounds(region, system.n * system.m):
        found = list[tuple[_Candidate, tuple[Matrix, ...]]]()
        for target, price in each.targets:
            request.tell("state feedback")
            F = _state_feedback(system, target, price) if gains is None else tuple(gains)
            if F is None:
                continue
            error = error_system(system, F, graph)
            for drawn in islice(_drawn_gains(system, graph, error, F), each.draws):
                tried += 1
                request.tell(f"observer gains K, H number {tried}")
                found += [(made, F) for made in _solved(error, agent, drawn, target, reduced)]
        found.sort(key=lambda made: (made[0].observer.channel.order, made[0].size))
        proposed = (_proposal(system, graph, agent, F, made, tried) for made, F in found)
        yield from most_promising(system, graph, region, proposed) if each.ranked else proposed
    refuse_if_impossible(system, graph, region, gains)
    raise LimitReached(
        f"{tried} draws of observer gains K_i, H_ij and their Riccati equations led to no loop "
        f"that could be certified for {region}; try another agent, or a larger region"
    )


def _proposal(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    F: tuple[Matrix, ...],
    each: _Candidate,
    tried: int,
) -> Proposal:
    """A candidate as programs."""
    observer = each.observer
    controller = observer_programs(system, graph, agent, F, each.observer_gains, observer.channel)
    parts = {
        "agent": system.names[agent],
        "channel_order": observer.channel.order,
        "feedback": F,
        "observer_gains": each.observer_gains,
        "G": each.G,
        "L": observer.L,
        "estimated": Matrix.identity(system.n),
        "attempts": tried,
    }
    coordinates = observer_coordinates(system.n, controller, observer.Y)
    return Proposal(controller, (), coordinates, parts)


def _require_doubles(system: MultiChannelSystem) -> None:
    """Raise an error for entries beyond the range of double precision.

    Raises
    ------
    LimitReached
    """
    import numpy as np

    for M in (system.A, system.input_matrix(), system.output_matrix()):
        if not np.all(np.isfinite(matrix_to_float(M))):
            raise LimitReached(
                "the plant has entries beyond the range of double precision: use exact arithmetic"
            )


def _state_feedback(
    system: MultiChannelSystem, target: StabilityRegion, price: float
) -> tuple[Matrix, ...] | None:
    """Compute dyadic F_i from a Riccati equation; None if there is no solution."""
    rounded = _gain(system.A, system.input_matrix(), target, price)
    if rounded is None:
        return None
    return split_by_channel(system, rounded)


def _drawn_gains(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    error: MultiChannelSystem,
    feedback: Sequence[Matrix],
) -> Iterator[tuple[Matrix, ...]]:
    """Draw moderate [K_i, H_ij …], with which each agent mostly follows one neighbor.

    In continuous time H_ij = −h I + noise for one j, which pulls x_i towards x_j; in discrete time
    a part of the difference is taken over.  Fewer draws for larger systems.
    """
    import numpy as np

    n, discrete = system.n, is_discrete(system.time)
    rng = np.random.default_rng(generator(error, "lists").getrandbits(64))
    spread = float(np.max(np.abs(np.linalg.eigvals(matrix_to_float(system.A))), initial=1.0))
    strengths = (0.5, 1.0, 0.0) if discrete else (2 * spread, spread, 4 * spread)
    count = 12 if error.n <= 60 else 6 if error.n <= 150 else 2
    for draw in range(count):
        h, noise = strengths[draw % len(strengths)], 0.25 if draw % 2 else 0.5
        gains = []
        for i in range(system.m):
            others = [j for j in graph.neighborhood(i) if j != i]
            parts = [noise * rng.standard_normal((n, system.q(i)))]
            leader = others[int(rng.integers(len(others)))] if others else None
            for j in others:
                H = noise * rng.standard_normal((n, n))
                parts.append(H - h * np.eye(n) if j == leader else H)
            on_grid = np.round(np.hstack(parts) * _GRID).astype(int)
            gains.append(Matrix.from_integers(on_grid.tolist(), _GRID, ncols=on_grid.shape[1]))
        yield tuple(gains)


def _solved(
    error: MultiChannelSystem,
    agent: int,
    observer_gains: tuple[Matrix, ...],
    target: StabilityRegion,
    reduced: bool,
) -> list[_Candidate]:
    """Observers of the errors under these gains, of full order and, if asked, of reduced order."""
    import numpy as np

    E, B, C = closed_by(error, observer_gains), error.B(agent), error.C(agent)
    G = _gain(E, B, target)
    if G is None:
        return []
    made = []
    L = _gain(E.T, C.T, target)
    if L is not None:
        made.append(full_order_observer(E, B, C, -G, -L.T))
    if reduced:

        def gain(E22: Matrix, E12: Matrix) -> Matrix | None:
            found = _gain(E22.T, E12.T, target)
            return None if found is None else -found.T

        less = reduced_order_observer(E, B, C, -G, gain)
        made += [] if less is None else [less]
    size = float(np.linalg.norm(matrix_to_float(G)))
    return [
        _Candidate(observer_gains, -G, each, size * float(np.linalg.norm(matrix_to_float(each.L))))
        for each in made
    ]


def _gain(A: Matrix, B: Matrix, target: StabilityRegion, price: float = 1.0) -> Matrix | None:
    """Compute a dyadic F for A + B F from a Riccati equation; None if there is no solution."""
    floats, inputs = matrix_to_float(A), matrix_to_float(B)
    F = _first_feedback(floats, inputs, target, price)
    return None if F is None else _rounded(floats, inputs, F, target)


def _first_feedback(A: Floats, B: Floats, target: StabilityRegion, price: float) -> Floats | None:
    """Compute a gain with the least effort for which the computed loop is fast enough."""
    for effort in _EFFORTS:
        F = riccati_feedback(A, B, target, effort=price * effort)
        if F is not None and is_within(A + B @ F, target):
            return F
    return None


def _rounded(A: Floats, B: Floats, F: Floats, target: StabilityRegion) -> Matrix:
    """Round a gain to few bits if these suffice, otherwise to the bits of a double."""
    few, many = _BITS
    found = dyadic_matrix(F, few)
    reached = is_within(A + B @ matrix_to_float(found), target)
    return found if reached else dyadic_matrix(F, many)


def refuse_if_impossible(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    gains: Sequence[Matrix] | None = None,
) -> None:
    """Raise an error that proves that no observer exists, if that can be proved.

    Raises
    ------
    Impossible
    """
    for verb, found in (
        ("move", joint_controllability(system)),
        ("see", joint_observability(system)),
    ):
        if not region.contains_roots_of(found.uncontrollable_polynomial):
            raise refusal("unreached", found, told=say.UNREACHED[verb], region=region)
    if gains is None:
        return
    decision = fixed_spectrum(error_system(system, gains, graph))
    if decision.outside(region):
        raise refusal("fixed", decision, told=say.ERRORS_FIXED, region=region)
