"""The distributed observer designed in floating point and certified exactly."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.modular_system import generator
from mcexact.derived.error_system import error_system
from mcexact.derived.feedback import closed_by
from mcexact.errors import Impossible, LimitReached, UsageError
from mcexact.exact.floats import dyadic_matrix, matrix_to_float
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.floating.margins import spectral_bound
from mcexact.model.closed_loop import closed_loop_matrix
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.channel_controller import ChannelController
from mcexact.synthesis.gate import CertifiedClosedLoop, certify_rate
from mcexact.synthesis.observer_programs import observer_programs
from mcexact.synthesis.observer_separation import observer_separation
from mcexact.synthesis.riccati import riccati_feedback

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]

_BITS = (36, 52)
_MARGINS = (Fraction(1, 4), Fraction(1, 16), Fraction(1, 256))
_EFFORTS = (1.0, 1e2, 1e4, 1e-2)
_LIST_GRID = 8
Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class FloatObserverDesign:
    """A distributed observer designed in floating point, with an exact proof of its rate.

    Attributes
    ----------
    controller : Controller
        m agent programs; agent i shares its estimate x_i of the plant's state.
    loop : CertifiedClosedLoop
    agent : str
        q, whose channel controller observes and moves all errors.
    bound : Fraction
        The certified rate or radius.
    feedback : tuple of Matrix
        F_i, p_i×n, dyadic.
    lists : tuple of Matrix
        [K_i, H_ij …] of the open-loop observer.
    G : Matrix, n×nm
        ũ = −G z, dyadic.
    L : Matrix, nm×(q_q + n(|N_q| − 1))
        The gain of the observer of the errors, dyadic.
    attempts : int
        How many lists were drawn.
    """

    controller: Controller
    loop: CertifiedClosedLoop
    agent: str
    bound: Fraction
    feedback: tuple[Matrix, ...]
    lists: tuple[Matrix, ...]
    G: Matrix
    L: Matrix
    attempts: int

    @property
    def certificate(self) -> Any:
        """The certificate of the loop, of kind ``stability``."""
        return self.loop.certificate

    @property
    def height(self) -> int:
        """Bits of the longest numerator or denominator in the controller."""
        return self.controller.height()

    def gain_norms(self) -> dict[str, float]:
        """The largest singular values of F, G, L and of all K_i, H_ij, in floating point."""
        import numpy as np

        named = {"F": self.feedback, "K, H": self.lists, "G": (self.G,), "L": (self.L,)}
        return {
            name: max(
                (float(np.linalg.norm(matrix_to_float(M), 2)) for M in each if 0 not in M.shape),
                default=0.0,
            )
            for name, each in named.items()
        }


@dataclass(frozen=True)
class _Candidate:
    """Lists, and gains for the error system that they lead to."""

    lists: tuple[Matrix, ...]
    E: Matrix
    G: Matrix
    L: Matrix
    size: float


def design_observer_float(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    bound: Fraction,
    *,
    gains: Sequence[Matrix] | None = None,
    progress: Progress,
) -> FloatObserverDesign:
    """Design a distributed observer for a rate or a radius by Riccati equations; certify it.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with n states and m channels; modes inside the region need neither be controllable
        nor observable.
    graph : NeighborGraph
        Without delays.
    agent : int
        q, counted from 0.
    bound : Fraction
    gains : sequence of m Matrix, optional
        F_i (p_i×n) from outside.
    progress : callable

    Raises
    ------
    Impossible
        If a mode outside the region is not controllable or not observable by all channels
        together, or fixed for the error system of these F_i; the certificate says which.
    LimitReached
        If nothing was found that could be certified.

    Notes
    -----
    Floating point proposes F_i, K_i, H_ij, G and L; the loop with these rational numbers is
    certified exactly, diagonal block by diagonal block (`observer_separation`).  Of several lists
    the one with the smallest G and L is kept.  The channel controller, of order nm, is

        z' = (E − B̃G − LC̃) z + L ỹ,     ũ = −G z,

    its first matrix exact, since the separation is.  O((nm)³) operations.
    """
    _require_doubles(system)
    region = StabilityRegion(system.time, bound)
    tried = 0
    for margin in _MARGINS:
        target = _target(system.time, bound, margin)
        progress("state feedback")
        F = _state_feedback(system, target) if gains is None else tuple(gains)
        if F is None:
            continue
        error = error_system(system, F, graph)
        candidates = []
        for lists in _drawn_lists(system, graph, error, F):
            tried += 1
            progress(f"lists K, H number {tried}")
            found = _solved(error, agent, lists, target)
            if found is not None:
                candidates.append(found)
        for each in sorted(candidates, key=lambda candidate: candidate.size):
            progress("certificate")
            controller = _programs(system, graph, agent, F, error, each)
            loop = _certified(system, graph, controller, bound)
            if loop is not None:
                name = system.names[agent]
                return FloatObserverDesign(
                    controller, loop, name, bound, F, each.lists, each.G, each.L, tried
                )
    _refuse_if_impossible(system, graph, region, gains)
    raise LimitReached(
        f"{tried} draws of lists K_i, H_ij and their Riccati equations led to no loop that could "
        f"be certified for {region}; try another agent, or a milder bound"
    )


def _require_doubles(system: MultiChannelSystem) -> None:
    """Refuse entries beyond the range of double precision.

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


def _target(time: str, bound: Fraction, margin: Fraction) -> float:
    """What to design for, so that the bound is met with something to spare."""
    return float(bound * (1 + margin) if time == "continuous" else bound * (1 - margin))


def _state_feedback(system: MultiChannelSystem, target: float) -> tuple[Matrix, ...] | None:
    """Dyadic F_i by a Riccati equation; None if there is no solution."""
    A, B = matrix_to_float(system.A), matrix_to_float(system.input_matrix())
    F = _first_feedback(A, B, system.time, target)
    if F is None:
        return None
    rounded, gains, start = _rounded(A, B, F, system.time, target), [], 0
    for i in range(system.m):
        gains.append(rounded.take(rows=range(start, start + system.p(i))))
        start += system.p(i)
    return tuple(gains)


def _drawn_lists(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    error: MultiChannelSystem,
    feedback: Sequence[Matrix],
) -> Iterator[tuple[Matrix, ...]]:
    """Moderate [K_i, H_ij …]: each agent leans on one neighbor, and a little on the others.

    In continuous time H_ij = −h I + noise for one j, which pulls x_i towards x_j; in discrete time
    a part of the difference is taken over.  Fewer draws for larger systems.
    """
    import numpy as np

    n, discrete = system.n, system.time == "discrete"
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
            on_grid = np.round(np.hstack(parts) * _LIST_GRID).astype(int)
            gains.append(Matrix.from_integers(on_grid.tolist(), _LIST_GRID, ncols=on_grid.shape[1]))
        yield tuple(gains)


def _solved(
    error: MultiChannelSystem, agent: int, lists: tuple[Matrix, ...], target: float
) -> _Candidate | None:
    """G and L for the error system under these lists, rounded."""
    import numpy as np

    E = closed_by(error, lists)
    E_float = matrix_to_float(E)
    B, C = matrix_to_float(error.B(agent)), matrix_to_float(error.C(agent))
    minus_G = _first_feedback(E_float, B, error.time, target)
    if minus_G is None:
        return None
    minus_L = _first_feedback(E_float.T, C.T, error.time, target)
    if minus_L is None:
        return None
    size = float(np.linalg.norm(minus_G) * np.linalg.norm(minus_L))
    G = -_rounded(E_float, B, minus_G, error.time, target)
    L = -_rounded(E_float.T, C.T, minus_L, error.time, target).T
    return _Candidate(lists, E, G, L, size)


def _first_feedback(A: Floats, B: Floats, time: str, target: float) -> Floats | None:
    """A gain with the least effort that leads to a solution that computes as fast enough."""
    for effort in _EFFORTS:
        F = riccati_feedback(A, B, time, target, effort=effort)
        if F is not None and _is_reached(A + B @ F, time, target):
            return F
    return None


def _is_reached(M: Floats, time: str, target: float) -> bool:
    """Whether the computed eigenvalues meet the target."""
    computed = spectral_bound(M, time)
    return computed < (-target if time == "continuous" else target)


def _rounded(A: Floats, B: Floats, F: Floats, time: str, target: float) -> Matrix:
    """A gain in few bits if these are enough, else in as many as a double has."""
    few, many = _BITS
    found = dyadic_matrix(F, few)
    reached = _is_reached(A + B @ matrix_to_float(found), time, target)
    return found if reached else dyadic_matrix(F, many)


def _programs(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    feedback: Sequence[Matrix],
    error: MultiChannelSystem,
    found: _Candidate,
) -> Controller:
    """The agents' programs with the observer-based channel controller."""
    B, C = error.B(agent), error.C(agent)
    channel = ChannelController(
        A=found.E - B @ found.G - found.L @ C,
        B=found.L,
        C=-found.G,
        D=Matrix.zeros(B.ncols, C.nrows),
        polynomial=None,
    )
    return observer_programs(system, graph, agent, feedback, found.lists, channel)


def _certified(
    system: MultiChannelSystem, graph: NeighborGraph, controller: Controller, bound: Fraction
) -> CertifiedClosedLoop | None:
    """The loop through the gate, block by block; None if Lyapunov matrices do not prove it."""
    separation = observer_separation(
        closed_loop_matrix(system, controller, graph), system.n, controller
    )
    try:
        return certify_rate(
            system, controller, bound=bound, graph=graph, separation=separation, method="lyapunov"
        )
    except (Impossible, UsageError):
        return None


def _refuse_if_impossible(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    gains: Sequence[Matrix] | None,
) -> None:
    """Say why there is nothing to find, where that can be proved.

    Raises
    ------
    Impossible
    """
    for what, verb, found in (
        ("controllable", "move", joint_controllability(system)),
        ("observable", "see", joint_observability(system)),
    ):
        polynomial = found.uncontrollable_polynomial
        if not region.contains_roots_of(polynomial):
            raise Impossible(
                f"not all roots of {polynomial} lie in {region}, and they are not {what} by all "
                f"channels together: no controller can {verb} them",
                found.certificate,
            )
    if gains is None:
        return
    decision = fixed_spectrum(error_system(system, gains, graph))
    outside = decision.outside(region)
    if outside:
        raise Impossible(
            f"the error system for these F_i has the fixed modes {outside[0].polynomial}, not all "
            f"of them in {region}: no lists K_i, H_ij and no channel controller can move them",
            decision.certificate,
        )
