"""Requests, and the gate, which alone makes certified loops.

A `Request` is what all methods of design share: region, spectrum, agent and arithmetic, checked
before any work.  A `Proposal` is a designer's result: agent programs, and perhaps claims about the
characteristic polynomials of their loop, from exact or floating-point computation.

`certify` assembles the closed loop from the programs alone and decides it exactly.  If polynomials
are claimed, they are compared with those of the loop modulo primes whose product exceeds twice a
bound on the coefficients, and stability follows from the polynomials.  Otherwise stability is
decided, by Lyapunov matrices block by block where the proposal offers coordinates in which the loop
may be block triangular.  A `CertifiedLoop` has no other constructor, so that having one is the
proof.  `first_certified` takes the first proposal of a designer that passes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import accumulate
from typing import Any, Literal, get_args

from mcexact.analysis.stability import Method, Separation, agreeing_moduli, certify_stability
from mcexact.answer.loops import ClosedLoopSpectrum, DistributedObserver, refusal
from mcexact.answer.protocol import Answer
from mcexact.derived.modular import generator
from mcexact.errors import Impossible, InternalError, LimitReached, UsageError, one_of, telling
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown

# Requests: the arguments that all methods of design share, checked before any work.

Arithmetic = Literal["exact", "float"]
Progress = Callable[[str], None]


class Warned(str):
    """The description of a step that a user ought to read before the design ends."""

    __slots__ = ()


@dataclass(frozen=True)
class Request:
    """The arguments that all methods of design share.

    Attributes
    ----------
    region : StabilityRegion
        The region in which every eigenvalue of the loop should lie; without a bound if only a
        spectrum is prescribed.
    agent : int or None
        The position of the agent with the channel controller, from 0.
    spectrum : object
        The prescribed numbers, in the form of the method; None if they are free.
    arithmetic : {"exact", "float"}
    tell : callable
        A function that is called with a short description of each step.
    notes : tuple of str
        What was chosen for the user.
    brisk : StabilityRegion or None
        Where no rate was asked for and the cost is to be least: a faster region than `region`,
        where a search starts, too.
    deadline : float or None
        The time of `time.monotonic` at which a search ends with the best controller so far.
    chosen : ChosenRegions or None
        What the choice of a rate computed, where none was asked for (`optimum.diagnosis`).
    """

    region: StabilityRegion
    agent: int | None
    spectrum: Any
    arithmetic: Arithmetic
    tell: Progress
    notes: tuple[str, ...] = ()
    brisk: StabilityRegion | None = None
    deadline: float | None = None
    chosen: Any = None

    @classmethod
    def of(
        cls,
        system: MultiChannelSystem,
        agent: str | None = None,
        spectrum: Any = None,
        rate: Any = None,
        radius: Any = None,
        arithmetic: Arithmetic = "exact",
        progress: Progress | None = None,
    ) -> Request:
        """Check the arguments of a ``design_…`` function.

        Raises
        ------
        UsageError
            If there is no spectrum, rate or radius; if floating point gets a spectrum; if the agent
            or the arithmetic is unknown; if ``progress`` is no function; or as in
            `StabilityRegion.of`.
        """
        region = StabilityRegion.of(system.time, rate, radius)
        if spectrum is None and region.bound is None:
            raise UsageError(
                f"give a {region.word} or a spectrum, which says how fast the loop has to be"
            )
        one_of(arithmetic, get_args(Arithmetic), "arithmetic")
        if arithmetic == "float" and spectrum is not None:
            raise UsageError(
                "a design in floating point takes a rate or a radius; a spectrum needs exact "
                "arithmetic"
            )
        carrier = None if agent is None else system.index(agent)
        return cls(region, carrier, spectrum, arithmetic, telling(progress))


# The gate, which alone makes certified closed loops from agent programs.

_KEY = object()


@dataclass(frozen=True)
class Coordinates:
    """New coordinates for the state of a loop, in which it may be block upper triangular.

    Attributes
    ----------
    T, inverse : Matrix, N×N
        The state is T times the new one.
    sizes : tuple of int
        The sizes of the diagonal blocks.
    """

    T: Matrix
    inverse: Matrix
    sizes: tuple[int, ...]

    def separation(self, M: Matrix) -> Separation | None:
        """Transform a loop to these coordinates; None if a block below the diagonal is not 0.

        Parameters
        ----------
        M : Matrix, N×N
            A loop of another size gives None, too.

        Returns
        -------
        Separation or None
            With T⁻¹ M T, block upper triangular, and the sizes of its nonempty diagonal blocks.
        """
        if M.shape != self.T.shape:
            return None
        Delta = self.inverse @ (M @ self.T)
        for stop, size in zip(accumulate(self.sizes), self.sizes, strict=True):
            below, columns = range(stop, M.nrows), range(stop - size, stop)
            if not Delta.take(rows=below, cols=columns).is_zero():
                return None
        return Separation(self.T, Delta, tuple(filter(None, self.sizes)), self.inverse)

    def of_states(self, places: tuple[int, ...]) -> Coordinates:
        """Return the coordinates for a loop whose k-th state was the one at ``places[k]``."""
        T, inverse = self.T.take(rows=places), self.inverse.take(cols=places)
        return Coordinates(T, inverse, self.sizes)


@dataclass(frozen=True)
class Proposal:
    """Agent programs proposed by a designer, with claims about their closed loop.

    Attributes
    ----------
    controller : Controller
    polynomials : tuple of Polynomial
        The claimed characteristic polynomials of the two diagonal blocks of a distributed
        observer's loop, or of the whole loop, or none.
    coordinates : tuple of Coordinates
        Coordinates in which the loop may be block triangular, the finest first.
    parts : mapping
        The parts of the controller by names.
    region : StabilityRegion or None
        Where its eigenvalues are, if that is not the region that was asked for.
    notes : tuple of str
        What is to be told of aims that it misses.
    """

    controller: Controller
    polynomials: tuple[Polynomial, ...] = ()
    coordinates: tuple[Coordinates, ...] = ()
    parts: Mapping[str, Any] = field(default_factory=dict)
    region: StabilityRegion | None = None
    notes: tuple[str, ...] = ()

    @property
    def is_tentative(self) -> bool:
        """Whether the Lyapunov method decides, which may fail for one proposal and not the next."""
        return bool(self.coordinates) and not self.polynomials


@dataclass(frozen=True, eq=False)
class CertifiedLoop(Shown):
    """A closed loop whose claims were verified exactly.

    Attributes
    ----------
    closed : ClosedLoop
    polynomial : Polynomial or None
        The characteristic polynomial of the whole loop, if a certificate states it.
    proofs : tuple of Answer
        The certificates, of which the first is about all eigenvalues.

    Raises
    ------
    InternalError
        If it is made outside this module.
    """

    closed: ClosedLoop
    polynomial: Polynomial | None
    proofs: tuple[Answer, ...]
    key: object

    def __post_init__(self) -> None:
        if self.key is not _KEY:
            raise InternalError("a certified closed loop is made by the functions of the gate")

    def __repr__(self) -> str:
        proved = ", ".join(each.kind for each in self.proofs)
        return f"CertifiedLoop({self.matrix.nrows} states, proved: {proved})"

    def explain(self) -> str:
        """Say in plain words what is proved of the loop."""
        return "\n".join(each.explain() for each in self.proofs)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the matrix of the loop, and what is proved of it."""
        yield "matrix", self.matrix
        for proof in self.proofs:
            yield proof.kind.replace("_", " "), proof

    def to_dict(self) -> dict[str, Any]:
        """Return what is proved as plain data, keyed by the kinds of the certificates."""
        return {each.kind: each.to_dict() for each in self.proofs}

    @property
    def controller(self) -> Controller:
        """m agent programs."""
        return self.closed.controller

    @property
    def matrix(self) -> Matrix:
        """The matrix of the loop, with the state (x, x_1, z_1, …)."""
        return self.closed.matrix

    @property
    def proof(self) -> Answer:
        """The certificate about all eigenvalues."""
        return self.proofs[0]


def certify(
    system: MultiChannelSystem,
    proposal: Proposal,
    region: StabilityRegion,
    graph: NeighborGraph | None = None,
    *,
    stable: bool = False,
) -> CertifiedLoop:
    """Assemble the closed loop of a proposal, and verify its claims.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, or a system made from one.
    proposal : Proposal
    region : StabilityRegion
        The region in which every eigenvalue should lie, if it has a bound.
    graph : NeighborGraph, optional
    stable : bool
        Whether to require stability if the region has no bound.

    Raises
    ------
    Impossible
        If the proposal has no claims and an eigenvalue lies outside; the certificate proves this.
    UsageError
        If a claimed eigenvalue lies outside, or the Lyapunov method was inconclusive.
    InternalError
        If a claim is false, which is a bug in the designer.

    Notes
    -----
    Exact, for controllers designed in any arithmetic.  The loop is assembled once, and its
    stability is decided once: by the claimed polynomials, if there are any, which must agree with
    those of the loop modulo primes whose product exceeds twice a bound on their coefficients
    (`proofs/closed_loop_spectrum.md`, `proofs/distributed_observer.md`, `proofs/stability.md`).
    """
    loop = closed_loop(system, proposal.controller, graph)
    if not proposal.polynomials:
        return _decided(loop, proposal, region)
    asked = stable or region.bound is not None
    if asked and not all(map(region.contains_roots_of, proposal.polynomials)):
        raise UsageError(
            f"the spectrum that was prescribed, or that the given gains lead to, violates {region}:"
            " give one of the two"
        )
    if proposal.coordinates:
        return _observer(loop, proposal, region)
    polynomial = _of_the_messages_in_use(product(proposal.polynomials), loop.dimension)
    seed = generator(loop.system, "closed_loop_spectrum").getrandbits(64)
    moduli = agreeing_moduli([(loop.matrix, polynomial)], seed)
    proofs: list[Answer] = [ClosedLoopSpectrum(loop.system, polynomial=polynomial, moduli=moduli)]
    if asked:
        proofs.append(certify_stability(loop.system, region, polynomial=polynomial))
    return CertifiedLoop(loop, polynomial, tuple(proofs), _KEY)


def first_certified(
    system: MultiChannelSystem,
    proposals: Iterable[Proposal],
    region: StabilityRegion,
    graph: NeighborGraph | None = None,
    *,
    stable: bool = False,
    tell: Progress,
) -> tuple[Proposal, CertifiedLoop]:
    """Return the first of a designer's proposals that passes; see `certify`.

    Raises
    ------
    LimitReached
        If none passes.
    """
    for proposal in proposals:
        tell("certificate")
        try:
            inside = proposal.region or region
            return proposal, certify(system, proposal, inside, graph, stable=stable)
        except (Impossible, UsageError):
            if not proposal.is_tentative:
                raise
    raise LimitReached(f"no controller that was found could be certified for {region}")


def _decided(loop: ClosedLoop, proposal: Proposal, region: StabilityRegion) -> CertifiedLoop:
    """Decide stability, block by block if the loop separates."""
    separations = (each.separation(loop.matrix) for each in proposal.coordinates)
    separation = next(filter(None, separations), None)
    method: Method | None = "lyapunov" if proposal.coordinates else None
    verdict = certify_stability(loop.system, region, method=method, separation=separation)
    if not verdict.stable:
        raise refusal("outside", verdict, region=verdict.region)
    return CertifiedLoop(loop, None, (verdict,), _KEY)


def _observer(loop: ClosedLoop, proposal: Proposal, region: StabilityRegion) -> CertifiedLoop:
    """Certify the separation of a distributed observer, and the spectra of both parts."""
    (coordinates,), (feedback, error) = proposal.coordinates, proposal.polynomials
    separation = coordinates.separation(loop.matrix)
    if separation is None:
        raise InternalError("the estimation errors are not autonomous")
    M_F, M_E = replace(separation, sizes=coordinates.sizes).blocks()
    seed = generator(loop.system, "distributed_observer").getrandbits(64)
    proof = DistributedObserver(
        loop.system,
        feedback=feedback,
        error=error,
        bound=region.bound,
        moduli=agreeing_moduli([(M_F, feedback), (M_E, error)], seed),
    )
    proofs: list[Answer] = [proof]
    if region.limits:
        proofs.append(certify_stability(loop.system, region, polynomial=feedback * error))
    return CertifiedLoop(loop, feedback * error, tuple(proofs), _KEY)


def _of_the_messages_in_use(polynomial: Polynomial, dimension: int) -> Polynomial:
    """Remove the factors x of messages that no program uses, which are not part of the loop."""
    unused = max(polynomial.degree - dimension, 0)
    if any(polynomial.coefficients[:unused]):
        raise InternalError("a polynomial lacks the modes 0 of unused messages")
    return Polynomial(polynomial.coefficients[unused:])
