"""A trajectory with what is proved about its loop.

A simulation shows one trajectory and proves nothing beyond it.  `proved_envelope` adds bounds
|y_k(t) − ȳ_k| ≤ c_k d(t) for all times, from a Lyapunov matrix of the loop that is certified
exactly; the initial state and the point of rest are exact, and roundings go upwards.  There are no
bounds if a signal changes during the run, or if the search for a Lyapunov matrix fails.
`simulated_loop` joins a run with the spectrum of its loop, these bounds and warnings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.stability import certify_stability, closed_loop_spectrum
from mcexact.answer.evidence import LoopSpectrum
from mcexact.answer.loops import LyapunovMethod, StabilityVerdict
from mcexact.errors import InputError, McexactError
from mcexact.exact.balls import exponential_above, power_above
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix, vstack
from mcexact.exact.roots import StabilityRegion, is_discrete, root_above, steady_point
from mcexact.model.controller import Controller
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.network import Drive
from mcexact.simulation.trajectory import Trajectory, simulate

LARGEST = 80
"""The most states of a loop whose spectrum and envelope are computed: seconds at this size."""


@dataclass(frozen=True)
class Envelope:
    """Proved bounds |y_k(t) − ȳ_k| ≤ c_k d(t), and the same for the entries of x.

    Attributes
    ----------
    proof : StabilityVerdict
        The certificate, whose Lyapunov matrix P and bound these follow from: with the rate r,
        V = ξᵀPξ falls at least as fast as e^(−2rt), where ξ is the distance of the loop's state
        from its point of rest (with the radius ρ, as ρ^(2t)).
    time : {"continuous", "discrete"}
    bound : Fraction
        The rate r, so that d(t) = e^(−rt), or the radius ρ, so that d(t) = ρ^t.
    outputs, state : tuple of (Fraction, Fraction)
        For every output, and for every entry of x, its exact value at rest ȳ_k, and a number that
        is at least c_k = √(c P⁻¹ cᵀ V(0)) and at most 2⁻⁶² of it larger.

    Notes
    -----
    The certificate is exact, and so are the value at rest, V(0) and c P⁻¹ cᵀ; the square root of
    this fraction is rounded up, and `decay` is.  The bound is about the exact solution.
    """

    proof: StabilityVerdict
    time: str
    bound: Fraction
    outputs: tuple[tuple[Fraction, Fraction], ...]
    state: tuple[tuple[Fraction, Fraction], ...]

    def decay(self, times: Sequence[Fraction]) -> list[float]:
        """Return d(t) at these times, rounded up."""
        if is_discrete(self.time):
            return [power_above(self.bound, int(t)) for t in times]
        return [exponential_above(-self.bound * t) for t in times]

    def __str__(self) -> str:
        return f"proved: {StabilityRegion(self.time, self.bound)}"


def proved_envelope(run: Trajectory, spectrum: LoopSpectrum | None = None) -> Envelope | None:
    """Compute bounds on a trajectory from a certificate of stability.

    Parameters
    ----------
    run : Trajectory
        Its set-points and disturbances are constant.
    spectrum : LoopSpectrum, optional
        That of the loop, if it is known.  The bounds are proved for a decay a little slower than
        that of its slowest eigenvalue.

    Returns
    -------
    Envelope or None
        None if the plant has feedthrough, if a signal changes, if the loop is too large or not
        stable, or if no Lyapunov matrix was found.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.simulation.trajectory import simulate
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> envelope = proved_envelope(simulate(plant, local_controllers(plant, [[[-3]]]), initial=[4]))
    >>> envelope.bound, [(int(rest), int(size)) for rest, size in envelope.outputs]
    (Fraction(9, 5), [(0, 4)])
    >>> proved_envelope(simulate(plant, local_controllers(plant, [[[0]]]))) is None
    True
    """
    InputError.require(run, Trajectory, "run")
    loop = run.loop
    if loop.plant.D is not None or not run.drive.is_constant:
        return None
    if not 0 < loop.dimension <= LARGEST:
        return None
    if spectrum is None:
        spectrum = closed_loop_spectrum(loop.matrix, run.time)
    InputError.require(spectrum, LoopSpectrum, "spectrum")
    if not spectrum.stable or spectrum.rate is None:
        return None
    decay = Fraction(spectrum.rate.upper if is_discrete(run.time) else spectrum.rate.lower)
    distance = _distance_from_rest(run)
    for region in _regions(run.time, decay):
        try:
            proof = certify_stability(loop.system, region, method="lyapunov")
        except McexactError:
            continue
        evidence = proof.evidence
        if isinstance(evidence, LyapunovMethod) and distance is not None:
            [block] = evidence.blocks
            return _envelope(run, proof, block.P, distance)
    return None


def _regions(time: str, decay: Fraction) -> list[StabilityRegion]:
    """Regions a little larger than the one that the loop has."""
    if is_discrete(time):
        slower = [decay + (1 - decay) * share for share in (Fraction(1, 10), Fraction(1, 2))]
        return [StabilityRegion(time, radius) for radius in slower if 0 < radius < 1]
    return [StabilityRegion(time, decay * share) for share in (Fraction(9, 10), Fraction(1, 2))]


def _distance_from_rest(run: Trajectory) -> Matrix | None:
    """ξ(0), the state of the loop minus the one at which it rests; None if there is none.

    Messages under way are zeros at the start.
    """
    loop, zero = run.loop, Fraction(0)
    N = loop.dimension
    state: list[Fraction] = list(run.start.plant)
    for shared, private in zip(run.start.shared, run.start.private, strict=True):
        state += [*shared, *private]
    start = Matrix.column([*state, *[zero] * (N - len(state))])
    rest = state_at_rest(loop, run.drive, zero)
    return None if rest is None else start - rest


def state_at_rest(loop: ClosedLoop, drive: Drive, time: Fraction) -> Matrix | None:
    """The state at which a loop rests with its signals of one time; None if there is none."""
    plant, N = loop.plant, loop.dimension
    inputs = plant.input_matrix()
    pushed = vstack([inputs, Matrix.zeros(N - plant.n, inputs.ncols)], ncols=inputs.ncols)
    constant = loop.reference @ vstack(drive.references.at(time), ncols=1)
    constant = constant + pushed @ vstack(drive.disturbances.at(time), ncols=1)
    place = Matrix.identity(N) * Fraction(steady_point(plant.time))
    return solve_nonsingular(place - loop.matrix, constant)


def _envelope(run: Trajectory, proof: StabilityVerdict, P: Matrix, distance: Matrix) -> Envelope:
    """The bounds that one Lyapunov matrix proves."""
    loop = run.loop
    V = (distance.T @ P @ distance)[0, 0]
    x = loop.pick("x")

    def bounds(rows: Matrix) -> tuple[tuple[Fraction, Fraction], ...]:
        spread = solve_nonsingular(P, rows.T)
        if spread is None:
            return ()
        at_start = rows @ distance
        intervals = []
        for k in range(rows.nrows):
            size = sum((rows[k, j] * spread[j, k] for j in range(rows.ncols)), Fraction(0))
            first = _first(run, rows, k)
            intervals.append((first - at_start[k, 0], root_above(size * V)))
        return tuple(intervals)

    bound = proof.region.edge
    return Envelope(proof, run.time, bound, bounds(loop.plant.output_matrix() @ x), bounds(x))


def _first(run: Trajectory, rows: Matrix, k: int) -> Fraction:
    """The value of a row of the state at the start; all rows are about x alone."""
    return sum((rows[k, j] * entry for j, entry in enumerate(run.start.plant)), Fraction(0))


@dataclass(frozen=True)
class SimulatedLoop:
    """A simulation, with the spectrum of the closed loop if it was computed.

    Attributes
    ----------
    title : str
    run : Trajectory
    spectrum : LoopSpectrum or None
    envelope : Envelope or None
        Proved bounds on the trajectory.
    warnings : tuple of str
    """

    title: str
    run: Trajectory
    spectrum: LoopSpectrum | None
    envelope: Envelope | None
    warnings: tuple[str, ...]


def simulated_loop(
    system: MultiChannelSystem, controller: Controller, **options: Any
) -> SimulatedLoop:
    """Simulate a controller, and compute the spectrum of its loop, proved bounds and warnings.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    **options
        As in `simulate`.
    """
    run = simulate(system, controller, **options)
    return loop_of(run, system.name, controller.warnings_for(system))


def loop_of(run: Trajectory, title: str | None, warnings: tuple[str, ...]) -> SimulatedLoop:
    """Return a run with the spectrum of its loop and with proved bounds."""
    spectrum = None
    if run.loop.dimension <= LARGEST:
        spectrum = closed_loop_spectrum(run.loop.matrix, run.time)
    return SimulatedLoop(
        title or "simulation",
        run,
        spectrum,
        proved_envelope(run, spectrum),
        warnings + (() if run.warning is None else (run.warning,)),
    )
