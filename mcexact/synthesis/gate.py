"""The gate: the one way to a certified closed loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mcexact.analysis.closed_loop_spectrum import agreeing_moduli
from mcexact.analysis.modular_system import generator
from mcexact.analysis.stability import Method, Separation, certify_stability
from mcexact.answer.closed_loop_spectrum import ClosedLoopSpectrum
from mcexact.answer.distributed_observer import DistributedObserver
from mcexact.answer.wording import refusals as say
from mcexact.errors import Impossible, InternalError
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.closed_loop import closed_loop
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

_KEY = object()


@dataclass(frozen=True, eq=False)
class CertifiedClosedLoop:
    """A loop whose claim was verified exactly; holding one is the proof that it was.

    Attributes
    ----------
    loop : MultiChannelSystem
        The whole loop, a system without channels that remembers plant and controller.
    controller : Controller
    polynomial : Polynomial or None
        The characteristic polynomial of the whole loop, where the certificate states it.
    certificate : Certificate
        What an independent checker needs.

    Raises
    ------
    InternalError
        If it is made anywhere but in the functions of this module.
    """

    loop: MultiChannelSystem
    controller: Controller
    polynomial: Polynomial | None
    certificate: Any
    key: object

    def __post_init__(self) -> None:
        if self.key is not _KEY:
            raise InternalError("a certified closed loop is made by the functions of the gate")

    @property
    def matrix(self) -> Matrix:
        """The matrix of the loop, state (x, x_1, z_1, …)."""
        return self.loop.A


def certify_spectrum(
    system: MultiChannelSystem,
    controller: Controller,
    polynomial: Polynomial,
    graph: NeighborGraph | None = None,
) -> CertifiedClosedLoop:
    """Verify that the loop, assembled from the agents' programs, has a characteristic polynomial.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    controller : Controller
    polynomial : Polynomial
        Monic, of the dimension of the loop.
    graph : NeighborGraph, optional

    Raises
    ------
    InternalError
        If it has another: the design that promised it is wrong.

    Notes
    -----
    Exact: the coefficients agree modulo primes whose product exceeds twice a bound on them
    (`proofs/closed_loop_spectrum.md`).
    """
    loop = closed_loop(system, controller, graph)
    seed = generator(loop, "closed_loop_spectrum").getrandbits(64)
    moduli = agreeing_moduli([(loop.A, polynomial)], seed)
    certificate = ClosedLoopSpectrum(loop, polynomial=polynomial, moduli=moduli)
    return CertifiedClosedLoop(loop, controller, polynomial, certificate, _KEY)


def certify_observer(
    system: MultiChannelSystem,
    controller: Controller,
    feedback: Polynomial,
    error: Polynomial,
    *,
    region: StabilityRegion | None = None,
    graph: NeighborGraph | None = None,
) -> CertifiedClosedLoop:
    """Verify the separation of a distributed observer, and the spectra of both parts.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with n states.
    controller : Controller
        Every agent shares an estimate of the n states.
    feedback, error : Polynomial
        The characteristic polynomials of A + Σ B_i F_i and of the error system.
    region : StabilityRegion, optional
        Where every root of both lies.
    graph : NeighborGraph, optional

    Raises
    ------
    InternalError
        If one of the statements fails: the design that promised it is wrong.

    Notes
    -----
    With e_i = x_i − x the loop becomes, in the coordinates (x, e_1, z_1, …)::

        ⎡ A + Σ B_i F_i    *  ⎤
        ⎣       0         M_E ⎦

    Soundness: `proofs/distributed_observer.md`.
    """
    loop = closed_loop(system, controller, graph)
    M_F, M_E = separated(loop.A, system.n, [agent.private for agent in controller.agents])
    bound = None
    if region is not None and region.bound is not None:
        bound = region.bound
        if not all(map(region.contains_roots_of, (feedback, error))):
            raise InternalError(f"a root is not in the region {region}")
    seed = generator(loop, "distributed_observer").getrandbits(64)
    moduli = agreeing_moduli([(M_F, feedback), (M_E, error)], seed)
    certificate = DistributedObserver(
        loop, feedback=feedback, error=error, bound=bound, moduli=moduli
    )
    return CertifiedClosedLoop(loop, controller, feedback * error, certificate, _KEY)


def certify_rate(
    system: MultiChannelSystem,
    controller: Controller,
    *,
    region: StabilityRegion | None = None,
    graph: NeighborGraph | None = None,
    separation: Separation | None = None,
    method: Method | None = None,
) -> CertifiedClosedLoop:
    """Verify that every eigenvalue of a loop lies in a region.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    controller : Controller
        Any one, from anywhere.
    region : StabilityRegion, optional
        By default that of stability.
    graph : NeighborGraph, optional
    separation : Separation, optional
        To go block by block; see `observer_separation`.
    method : {"polynomial", "lyapunov"}, optional
        See `certify_stability`.

    Raises
    ------
    Impossible
        If an eigenvalue lies outside; the certificate proves it.
    UsageError
        If the method asked for does not decide.

    Notes
    -----
    Exact (`proofs/stability.md`), whatever arithmetic the controller was designed in.
    """
    loop = closed_loop(system, controller, graph)
    verdict = certify_stability(loop, region, method=method, separation=separation)
    if not verdict.stable:
        raise Impossible(say.OUTSIDE(region=verdict.region), verdict.certificate)
    return CertifiedClosedLoop(loop, controller, None, verdict.certificate, _KEY)


def separated(M: Matrix, n: int, private: list[int]) -> tuple[Matrix, Matrix]:
    """The diagonal blocks of the loop in the coordinates (x, e_1, z_1, …), e_i = x_i − x.

    Raises
    ------
    InternalError
        If the block below the first is not 0: the errors do not evolve by themselves.
    """
    rows = [[int(i == j) for j in range(M.nrows)] for i in range(M.nrows)]
    start = n
    for k in private:
        for i in range(n):
            rows[start + i][i] = 1
        start += n + k
    if start != M.nrows:
        raise InternalError("the loop is not made of a plant and m estimates of its state")
    S = Matrix.from_integers(rows, ncols=M.nrows)
    inverse = Matrix.identity(M.nrows) * 2 - S
    moved = inverse @ M @ S
    first, rest = list(range(n)), list(range(n, M.nrows))
    if not moved.take(rest, first).is_zero():
        raise InternalError("the estimation errors do not evolve by themselves")
    return moved.take(first, first), moved.take(rest, rest)
