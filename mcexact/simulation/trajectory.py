"""`simulate`: trajectories in discrete and continuous time.

Discrete time is stepped, by default in rational numbers, and then exact.  Continuous time is
integrated from the derivatives that the plant and the agents compute:

- `integrated`, the default: double precision with scipy's Runge–Kutta method of order 8, or where
  the fastest mode makes the equations stiff with an implicit method of order 5;
- `taylor`: sums of Taylor series in multiple precision, for loops whose entries are too large for
  double precision (`double_precision_warning`).  The equations are linear, so one round of the
  network at the k-th derivative gives the next one.

Neither encloses its numbers, so neither proves anything; for proved bounds see `envelope`.
`chosen_grid` chooses the times from the slowest and the fastest mode of the loop.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any

from mcexact.errors import InputError, LimitReached, MissingExtra, UsageError, several, shown_value
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Rounding, largest_entry, matrix_to_float, to_float
from mcexact.exact.rational import number
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem, any_system, with_links
from mcexact.plot.responses import responses
from mcexact.shown import Shown
from mcexact.simulation.network import (
    Arithmetic,
    Columns,
    Cosine,
    Drive,
    InitialState,
    Native,
    Network,
    Snapshot,
    arithmetic_named,
    initial_state,
    numbers_of,
    representable,
    set_initial,
    signal_of,
)

if TYPE_CHECKING:
    import numpy.typing as npt

# Integration in continuous time.

STIFF = 20_000.0
"""The largest product of the horizon and the fastest mode for an explicit method."""


def integrated(
    network: Network, times: Sequence[Fraction], drive: Drive, fastest: float = 0.0
) -> list[Snapshot]:
    """Integrate the derivatives that the plant and the agents compute, in double precision.

    Parameters
    ----------
    network : Network
        At its initial state.
    times : sequence of Fraction
        Ascending.
    drive : Drive
    fastest : float
        The modulus of the fastest mode; where it is large, the method is implicit.

    Raises
    ------
    LimitReached
        If a number exceeds the range of double precision, or scipy's integration stops early.
    """
    import numpy as np
    from scipy.integrate import solve_ivp

    sizes = [len(network.state)]
    for agent in network.agents:
        sizes += [len(agent.shared), len(agent.private)]
    ends = np.cumsum(sizes)[:-1]
    numbers = network.arithmetic

    def load(flat: Any) -> None:
        pieces = np.split(flat.reshape(-1, 1), ends)
        network.set_state(pieces[0], list(zip(pieces[1::2], pieces[2::2], strict=True)))

    def gathered(state: Any, parts: Any) -> Any:
        return np.concatenate([state, *(piece for part in parts for piece in part)])[:, 0]

    def floats(signal: Columns) -> list[Native]:
        return [numbers.convert(M) for M in signal]

    representable(np.array([to_float(t) for t in times]))
    flat = gathered(network.state, [(agent.shared, agent.private) for agent in network.agents])
    scale = max(1.0, float(np.abs(flat).max(initial=0.0)))
    stiff = fastest * to_float(times[-1] - times[0]) > STIFF
    accuracy: dict[str, Any] = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13 * scale}
    if stiff:
        accuracy = {"method": "Radau", "rtol": 1e-8, "atol": 1e-11 * scale}
    wanted, snapshots = set(times), list[Snapshot]()
    kinds = drive.references, drive.disturbances
    cosines = [
        [
            (floats(each.columns), to_float(each.cosine.number))
            for each in kind.changes
            if each.cosine
        ]
        for kind in kinds
    ]
    for piece in drive.pieces(times):
        levels = [floats(kind.linear.at(piece[0])) for kind in kinds]
        slopes = [floats(kind.linear.slope(piece[0])) for kind in kinds]
        grid = representable(np.array([to_float(t) for t in piece]))

        def derivative(
            t: float, flat: Any, levels: Any = levels, slopes: Any = slopes, start: Any = grid[0]
        ) -> Any:
            load(flat)
            entering = []
            for level, slope, turning in zip(levels, slopes, cosines, strict=True):
                now = [r + s * (t - start) for r, s in zip(level, slope, strict=True)]
                for columns, omega in turning:
                    factor = math.cos(omega * t)
                    now = [r + c * factor for r, c in zip(now, columns, strict=True)]
                entering.append(now)
            network.set_signals(*entering)
            return representable(gathered(*network.evolution()))

        with np.errstate(over="ignore", invalid="ignore"):
            solved = solve_ivp(derivative, (grid[0], grid[-1]), flat, t_eval=grid, **accuracy)
        if not solved.success:
            raise LimitReached(f"the integration stopped: {solved.message}")
        for time, column in zip(piece, solved.y.T, strict=True):
            # The next piece starts with the last time of this one, after the change.
            if time in wanted and (time != piece[-1] or time == times[-1]):
                load(column)
                drive.apply(network, time)
                snapshots.append(network.round()[0])
        flat = solved.y[:, -1]
    return snapshots


def taylor(
    network: Network, times: Sequence[Fraction], drive: Drive, digits: int
) -> list[Snapshot]:
    """Sum Taylor series in multiple precision until further terms change nothing.

    Parameters
    ----------
    network : Network
        At its initial state, with arithmetic in multiple precision; afterwards at the last time.
    times : sequence of Fraction
        Ascending; the first one belongs to the initial state.
    drive : Drive
    digits : int
        The decimal digits of the arithmetic.

    Returns
    -------
    list of Snapshot
        One for each time.  These numbers are not enclosed, and prove nothing.
    """
    wanted = set(times)

    def shown(time: Fraction) -> list[Snapshot]:
        drive.apply(network, time)
        return [network.round()[0]] if time in wanted else []

    snapshots = shown(times[0])
    for piece in drive.pieces(times):
        for before, after in pairwise(piece):
            step = after - before
            now = before
            while now < after:
                step = min(step, after - now)
                if _taylor_step(network, now, step, drive, digits):
                    now += step
                else:
                    step /= 2
            snapshots += shown(after)
    return snapshots


def _taylor_step(
    network: Network, time: Fraction, step: Fraction, drive: Drive, digits: int
) -> bool:
    """Take a step x(t + h) = Σ h^k x^(k) / k!; return False and change nothing if the terms grow.

    The network computes the derivatives: one round at x gives x'.  Since the programs are linear,
    one round at x^(k) with the k-th derivatives of all signals gives x^(k+1).
    """
    numbers = network.arithmetic
    parts = [(agent.shared, agent.private) for agent in network.agents]
    start = network.state, parts
    total = term = start
    limit = 0.0
    for k in range(1, 40 * digits):
        # The state is h^(k−1) x^(k−1) / (k−1)!, and the signals have the same factor.
        drive.apply_term(network, time, k - 1, step)
        term = _scaled(network.evolution(), numbers.scalar(step / k))
        network.set_state(*term)
        total = _added(total, term)
        size = _size(numbers, term)
        if k == 1:
            limit = 10.0 ** (digits // 4) * max(_size(numbers, start), size)
        if not size <= limit:
            break
        if k > 1 and size <= _size(numbers, total) * 10.0**-digits:
            network.set_state(*total)
            return True
    network.set_state(*start)
    return False


Parts = tuple[Native, list[tuple[Native, Native]]]


def _scaled(value: Parts, factor: Any) -> Parts:
    return value[0] * factor, [(x * factor, z * factor) for x, z in value[1]]


def _added(a: Parts, b: Parts) -> Parts:
    pairs = zip(a[1], b[1], strict=True)
    return a[0] + b[0], [(x + u, z + v) for (x, z), (u, v) in pairs]


def _size(numbers: Arithmetic, value: Parts) -> float:
    columns = [value[0], *(piece for part in value[1] for piece in part)]
    return max(numbers.largest(column) for column in columns)


# The times of a simulation, chosen from the slowest and the fastest mode of the loop.

CONSTANTS = 6
"""How many time constants of the slowest mode are shown; e⁻⁶ is 0.0025."""
FEWEST, MOST = 200, 1000
"""The least and the largest number of intervals in continuous time."""
STEPS = 300
"""The largest number of steps that is chosen in discrete time."""
_PER_RADIAN = 5
_NICE = (10, 12, 15, 20, 25, 30, 40, 50, 60, 80, 100)
_SLOW = 1e-9
_MOST_EXACT = 60
"""The states of loops whose eigenvalues on the border of stability are counted exactly."""


@dataclass(frozen=True)
class Grid:
    """The times of a run.

    Attributes
    ----------
    times : tuple of Fraction
    fastest : float
        The largest modulus of an eigenvalue of the loop, in floating point; 0 if it is unknown.
    note : str or None
        What these times do not show.
    """

    times: tuple[Fraction, ...]
    fastest: float = 0.0
    note: str | None = None


def chosen_grid(
    loop: ClosedLoop,
    last: Fraction,
    horizon: Fraction | None = None,
    points: int | None = None,
    *,
    most: int = STEPS,
) -> Grid:
    """Choose the times of a run.

    Parameters
    ----------
    loop : ClosedLoop
    last : Fraction
        The time of the last change of a signal, after which the loop should be seen to settle.
    horizon : Fraction, optional
        The last time, or the number of steps in discrete time.  By default `CONSTANTS` time
        constants of the slowest mode after the last change, rounded up to a short number.
    points : int, optional
        The number of equal intervals in continuous time, by default several for each radian of the
        fastest mode, within limits.
    most : int
        The largest number of steps that is chosen in discrete time.

    Notes
    -----
    Eigenvalues in floating point, and the characteristic polynomial, which says exactly how many
    eigenvalues are 0 in discrete time, or on the border of stability in continuous time, where
    floating point cannot: a double eigenvalue 0 seems to be ±1e-8.
    """
    if is_discrete(loop.plant.time):
        chosen = last + _steps(loop, _eigenvalues(loop), most) if horizon is None else horizon
        return Grid(tuple(Fraction(k) for k in range(math.ceil(chosen) + 1)))
    modes = _eigenvalues(loop)
    fastest = max(map(abs, modes), default=0.0)
    end = _nice(last + _duration(modes, _on_border(loop))) if horizon is None else horizon
    needed = math.ceil(min(to_float(end) * fastest * _PER_RADIAN, 1e9)) if fastest else FEWEST
    count = min(max(needed, FEWEST), MOST) if points is None else points
    note = None
    if points is None and needed > _PER_RADIAN * MOST:
        note = (
            f"the fastest mode has |λ| = {fastest:.3g}, too fast for times that are "
            f"{to_float(end / count):.3g} apart; a shorter horizon shows it"
        )
    return Grid(tuple(end * k / count for k in range(count + 1)), fastest, note)


def _eigenvalues(loop: ClosedLoop) -> list[complex]:
    """The eigenvalues in floating point; none if entries exceed floats."""
    import numpy as np

    M = matrix_to_float(loop.matrix)
    if not M.size or not np.all(np.isfinite(M)):
        return []
    return [complex(each) for each in np.linalg.eigvals(M)]


def _on_border(loop: ClosedLoop) -> tuple[int, int]:
    """How many roots λ of the characteristic polynomial have −λ as a root, and how many are 0.

    The former are the roots on the border of stability, and pairs of opposite ones.  Nothing is
    counted of large loops.
    """
    if loop.dimension > _MOST_EXACT:
        return 0, 0
    p = characteristic_polynomial(loop.matrix)
    both = p.gcd(p.scale(-1))
    return both.degree, next(k for k, c in enumerate(both.numerators) if c)


def _duration(modes: list[complex], on_border: tuple[int, int] = (0, 0)) -> Fraction:
    """Some time constants of the slowest mode, or the time in which unstable modes grow as much.

    So many modes nearest the border of stability are taken to be on it, and so many of these to be
    0: they neither decay nor grow, and where they move, some of their periods are shown.
    """
    border, at_rest = on_border
    scale = max(map(abs, modes), default=0.0)
    ordered = sorted(modes, key=lambda each: abs(each.real))
    moving = sorted(map(abs, ordered[:border]))[at_rest:]
    periods = Fraction(CONSTANTS * math.pi / min(moving)) if moving else Fraction(0)
    rest = ordered[border:]
    if not rest:
        return periods or Fraction(10)
    rate = -max(each.real for each in rest)
    if rate < -_SLOW * scale:
        # An unstable loop is shown until it has grown e³ times.
        return max(periods, Fraction(CONSTANTS / -rate / 2))
    if rate <= _SLOW * scale:
        moving = [abs(each) for each in rest if abs(each) > _SLOW * scale]
        return max(periods, Fraction(CONSTANTS * math.pi / min(moving)) if moving else Fraction(10))
    return max(periods, Fraction(CONSTANTS / rate))


def _steps(loop: ClosedLoop, modes: list[complex], most: int) -> int:
    """The duration in discrete time, as a number of steps."""
    states = loop.dimension
    if states <= STEPS // 5:
        # A mode 0 is gone after as many steps as it has states.
        zeros = characteristic_polynomial(loop.matrix).numerators
        at_rest = next((k for k, c in enumerate(zeros) if c), 0)
        modes = sorted(modes, key=abs)[at_rest:]
    radius = max(map(abs, modes), default=0.0)
    if radius <= _SLOW:
        return min(states + 3, most)
    constant = abs(math.log(radius))
    if constant < CONSTANTS / most:
        return most
    return min(max(states + 3, math.ceil(_nice(Fraction(CONSTANTS / constant)))), most)


def _nice(value: Fraction) -> Fraction:
    """Round up to a number of two digits that is easily read.

    Examples
    --------
    >>> [str(_nice(Fraction(x))) for x in ("0.0163", "491", "8", "1/3")]
    ['1/50', '500', '8', '2/5']
    """
    exponent = math.floor(math.log10(value)) - 1
    unit = Fraction(10) ** exponent
    digits = next((each for each in _NICE if each * unit >= value), 100)
    return digits * unit


LARGEST_FOR_DOUBLES = 10**5


def double_precision_warning(loop: ClosedLoop) -> str | None:
    """Return a warning if the matrix of a closed loop has an entry of 10⁵ or more, else None.

    Notes
    -----
    A matrix with large entries and small eigenvalues is far from normal, so rounding its entries
    moves its eigenvalues far.  In one example with n = 6 and m = 5 the spectral abscissa is −1, but
    +9 once the entries are rounded to double precision.
    """
    largest = largest_entry([loop.matrix])
    if largest < LARGEST_FOR_DOUBLES:
        return None
    return (
        f"the closed loop has entries up to {_power(largest)}, so that double precision does not "
        "show how the exact design behaves; use exact or multiprecision arithmetic"
    )


def _power(value: Fraction) -> str:
    """The order of magnitude of a number of 1 or more, such as 3e+20."""
    digits = str(int(value))
    return f"{digits[0]}e+{len(digits) - 1:02d}"


# `simulate`, and the trajectory that it returns.

SIGNALS = {"outputs": "y", "inputs": "u", "reference": "r"}
"""The letters of the signals of all agents, keyed by their names in a `Snapshot`."""


@dataclass(frozen=True, repr=False)
class Trajectory(Shown):
    """The trajectory of a plant and its agents.

    Attributes
    ----------
    time : {"continuous", "discrete"}
    arithmetic : str
    agents : tuple of str
    times : tuple of Fraction
    snapshots : tuple of Snapshot
        One for each time.
    warning : str or None
        A warning if the closed loop has entries too large for double precision, where that was
        used.
    note : str or None
        What the times do not show.
    loop : ClosedLoop
        The plant, the controller and the links.
    drive : Drive
        The set-points and disturbances.
    start : InitialState
    """

    time: str
    arithmetic: str
    agents: tuple[str, ...]
    times: tuple[Fraction, ...]
    snapshots: tuple[Snapshot, ...]
    warning: str | None
    note: str | None
    loop: ClosedLoop = field(compare=False)
    drive: Drive = field(compare=False)
    start: InitialState = field(compare=False)

    def __repr__(self) -> str:
        start, end = self.times[0], self.times[-1]
        return (
            f"Trajectory({len(self.agents)} agents, {len(self.times)} times from {start} to {end}, "
            f"{self.time} time, {self.arithmetic})"
        )

    def explain(self) -> str:
        """Say in plain words what was run, and where it ended."""
        start, end = self.times[0], self.times[-1]
        unit = "step" if is_discrete(self.time) else "time"
        sentences = [
            f"{len(self.agents)} agents ran from {unit} {start} to {end} in {self.arithmetic} "
            "arithmetic.",
            *(f"At the end {name} = {value}." for name, value in self.to_rows()[-1].items()),
        ]
        return "\n".join([*sentences, *filter(None, (self.warning, self.note))])

    def _labeled(self) -> Iterator[tuple[str, str]]:
        """Yield the signals, each at the first and at the last time."""
        first, last = self.to_rows()[0], self.to_rows()[-1]
        for name, value in first.items():
            yield name, f"{_short(value)} → {_short(last[name])}"

    def to_rows(self) -> list[dict[str, Any]]:
        """Return a flat row for each time: t, the state x of the plant, and y, u and r of agents.

        The names are those of the columns of ``mcexact simulate -o FILE.csv``.  Numbers are those
        of the arithmetic: Fractions in exact runs.
        """
        kinds = {kind: self.names(kind) for kind in SIGNALS}
        rows = []
        for time, at in zip(self.times, self.snapshots, strict=True):
            row = {"t": time, **{f"x[{k + 1}]": value for k, value in enumerate(at.plant)}}
            for kind, names in kinds.items():
                row |= zip(names, chain(*getattr(at, kind)), strict=True)
            rows.append(row)
        return rows

    def to_dict(self) -> dict[str, list[Any]]:
        """Return the signals by name, each as a list of its numbers at all times."""
        rows = self.to_rows()
        return {name: [row[name] for row in rows] for name in rows[0]}

    @property
    def t(self) -> npt.NDArray[Any]:
        """The times as floats: an array of shape (N,)."""
        return _array([[time] for time in self.times]).ravel()

    @property
    def x(self) -> npt.NDArray[Any]:
        """The plant's state as floats: an array of shape (N, n), a row for each time."""
        return _array([each.plant for each in self.snapshots])

    @property
    def y(self) -> npt.NDArray[Any]:
        """The outputs of all agents as floats: (N, outputs), in the order of ``names``."""
        return _array([[*chain(*each.outputs)] for each in self.snapshots])

    @property
    def u(self) -> npt.NDArray[Any]:
        """The inputs of all agents as floats: (N, inputs), in the order of ``names``."""
        return _array([[*chain(*each.inputs)] for each in self.snapshots])

    @property
    def r(self) -> npt.NDArray[Any]:
        """The set-points of all agents as floats: (N, outputs); without set-points (N, 0)."""
        return _array([[*chain(*each.reference)] for each in self.snapshots])

    def to_control(self) -> Any:
        """Return a ``TimeResponseData`` of python-control, with outputs y, states x and inputs u.

        Raises
        ------
        MissingExtra
            If python-control is not installed.

        Examples
        --------
        >>> from mcexact.designs import local_controllers
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
        >>> run = simulate(plant, local_controllers(plant, [[["-1/2"]]]), initial=[1], horizon=3)
        >>> run.t, run.y[:, 0]
        (array([0., 1., 2., 3.]), array([1.   , 0.5  , 0.25 , 0.125]))
        >>> run.to_control().states.shape
        (1, 4)
        """
        with MissingExtra.named("control"):
            import control

        return control.TimeResponseData(
            self.t,
            self.y.T,
            self.x.T,
            self.u.T,
            output_labels=self.names("outputs"),
            input_labels=self.names("inputs"),
            issiso=self.y.shape[1] == self.u.shape[1] == 1,
        )

    def has_estimates(self) -> bool:
        """Whether each agent's shared sub-state has the dimension of the plant's state."""
        first = self.snapshots[0]
        return all(len(x_i) == len(first.plant) for x_i in first.shared)

    def names(self, kind: str) -> list[str]:
        """Return the names of all entries of a signal, such as "y pump" or "u 2[1]".

        Parameters
        ----------
        kind : {"outputs", "inputs", "reference"}
        """
        letter, first = SIGNALS[kind], getattr(self.snapshots[0], kind)
        return [
            f"{letter} {name}" if len(values) == 1 else f"{letter} {name}[{k + 1}]"
            for name, values in zip(self.agents, first, strict=True)
            for k in range(len(values))
        ]

    def values(self, kind: str) -> dict[str, list[float]]:
        """Return all entries of a signal at all times as floats, keyed by their names.

        Parameters
        ----------
        kind : {"outputs", "inputs", "reference"}
        """
        rows = [list(map(as_float, chain(*getattr(each, kind)))) for each in self.snapshots]
        columns = zip(*rows, strict=True)
        return dict(zip(self.names(kind), map(list, columns), strict=True))

    def state_norms(self, rest: Sequence[float] | None = None) -> list[float]:
        """Return the largest absolute value of an entry of x, or of x minus a state, at every time.

        Parameters
        ----------
        rest : sequence of float, optional
        """
        if rest is None or not any(rest):
            return [_largest(snapshot.plant) for snapshot in self.snapshots]
        return [
            max(abs(as_float(x) - r) for x, r in zip(snapshot.plant, rest, strict=True))
            for snapshot in self.snapshots
        ]

    def error_norms(self) -> dict[str, list[float]]:
        """Return the largest absolute entry of e_i = x_i − x for every agent with an estimate.

        The result is empty if the agents share no estimates of the plant's state.
        """
        if not self.has_estimates():
            return {}
        rows = [[_largest(e) for e in self.errors(k)] for k in range(len(self.times))]
        return {name: [row[i] for row in rows] for i, name in enumerate(self.agents)}

    def plot(self, ax: Any = None, *, envelope: Any = None) -> Any:
        """Draw the outputs with their set-points, and the inputs; see `mcexact.plot.responses`.

        Parameters
        ----------
        ax : two axes of matplotlib, optional
        envelope : Envelope, optional
            Proved bounds, from `proved_envelope`.

        Returns
        -------
        matplotlib.figure.Figure
        """
        return responses(self, ax, envelope=envelope)

    def errors(self, k: int) -> list[list[Any]]:
        """The errors e_i = x_i − x at the k-th time, where agents share state estimates.

        Parameters
        ----------
        k : int
            A position in ``times``.

        Returns
        -------
        list of list
            e_i, n native numbers, for each agent.
        """
        snapshot = self.snapshots[k]
        return [
            [a - b for a, b in zip(x_i, snapshot.plant, strict=True)] for x_i in snapshot.shared
        ]


def _array(rows: Sequence[Sequence[Any]]) -> npt.NDArray[Any]:
    """Return rows of native numbers as an array of floats."""
    import numpy as np

    return np.array([[as_float(value) for value in row] for row in rows], dtype=float)


def as_float(value: Any) -> float:
    """A native number as the nearest float; infinity beyond floats."""
    return to_float(value) if isinstance(value, (int, Fraction)) else float(value)


def _largest(values: list[Any]) -> float:
    """Return the largest absolute value as a float: infinity beyond floats, 0 without entries."""
    return as_float(max((abs(value) for value in values), default=0))


def _short(value: Any) -> str:
    return number(value) if isinstance(value, Fraction) else f"{as_float(value):.6g}"


def simulate(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    initial: InitialState | Sequence[Any] | None = None,
    horizon: Any = None,
    points: int | None = None,
    reference: Sequence[Any] | None = None,
    steps: Sequence[tuple[Any, Sequence[Any]]] = (),
    ramps: Sequence[tuple[Any, Sequence[Any]]] = (),
    cosines: Sequence[tuple[Any, Sequence[Any]]] = (),
    disturbances: Sequence[tuple[Any, Sequence[Any]]] = (),
    arithmetic: str | None = None,
    digits: int = 60,
    rounding: Rounding | None = None,
) -> Trajectory:
    """Run a controller as a network of agents that exchange messages, with their delays.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    initial : sequence of numbers or InitialState, optional
        x(0), or the states of the agents as well, which start at 0 otherwise.  By default every
        entry of x(0) is 1.
    horizon : int or rational, optional
        Steps in discrete time, the final time in continuous time.  By default chosen from the
        slowest mode of the loop; see `chosen_grid`.
    points : int, optional
        The number of equal intervals into which the horizon is divided, in continuous time.  By
        default chosen from the fastest mode.
    reference : sequence, optional
        The set-points r_i from the start on: one sequence of numbers for each channel, or all
        numbers in the order of the channels; 0 by default.
    steps, ramps : sequences of (time, numbers), optional
        What is added to the set-points from a time on: the numbers, or the numbers times the time
        that has passed since.
    cosines : sequence of (number, numbers), optional
        Added to the set-points from the start on: the numbers times cos(ωt), for a pair (ω,
        numbers), ω in rad per unit of time.  In discrete time the numbers times cos(tθ), for a
        pair (cos θ, numbers), θ the angle per step.
    disturbances : sequence of (time, numbers), optional
        What is added at the plant to the inputs of all channels from a time on.
    arithmetic : {"exact", "multiprecision", "float"}, optional
        By default exact in discrete time, and in continuous time float, which is an adaptive
        Runge–Kutta method of order 8 from scipy (an implicit one of order 5, if fast modes need
        it).  Continuous time also has multiprecision, which sums Taylor series of the linear
        equations.
    digits : int
        The number of decimal digits in multiple precision.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats among the numbers become exact, as in `MultiChannelSystem.from_float`.  By
        default "dyadic" in the arithmetic float, which changes no float; otherwise floats are
        refused.

    Raises
    ------
    SignalNotReceived
        If a program uses a signal that its agent does not receive.
    FloatRefused
        If a number is a float in a run that is not in floating point, and no rounding is given.
    UsageError
        If the time domain does not have this arithmetic, or the horizon is not as expected.

    Examples
    --------
    >>> from mcexact import Controller, Matrix, MultiChannelSystem
    >>> from mcexact.designs import AgentProgram, LinearMap
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    >>> agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([["-3/2"]])}))
    >>> run = simulate(plant, Controller("discrete", "", (agent,)), horizon=2)
    >>> [snapshot.plant for snapshot in run.snapshots]
    [[Fraction(1, 1)], [Fraction(1, 2)], [Fraction(1, 4)]]
    >>> [snapshot.inputs for snapshot in run.snapshots]
    [[[Fraction(-3, 2)]], [[Fraction(-3, 4)]], [[Fraction(-3, 8)]]]
    """
    any_system(system)
    InputError.require(controller, Controller, "controller")
    plant = system
    system, links = with_links(system, graph)
    discrete = is_discrete(system.time)
    numbers = arithmetic_named(arithmetic or ("exact" if discrete else "float"), digits)
    if rounding is None and numbers.name == "float":
        rounding = "dyadic"
    network = Network(system, controller, links, numbers)
    if links.delays and not discrete:
        raise UsageError("delays are for discrete time; remove them from the graph")
    if not discrete and numbers.name == "exact":
        raise UsageError("in continuous time the solution is not rational; use multiprecision")
    # A round at rest changes nothing, and shows whether an agent uses a signal that it lacks.
    network.evolution()
    start = initial_state(initial, system, controller, rounding)
    set_initial(network, start, system, controller)
    outputs = [system.q(i) for i in range(system.m)]
    inputs = [system.p(i) for i in range(system.m)]
    bits = 4 * digits if numbers.name == "multiprecision" else 64
    waves = _cosines(cosines, rounding, discrete=discrete, bits=bits)
    names = "reference", "steps", "ramps"
    drive = Drive(
        signal_of(outputs, reference, steps, ramps, rounding, names, waves),
        signal_of(inputs, None, disturbances, (), rounding, ("", "disturbances", "")),
    )
    loop = closed_loop(plant, controller, graph)
    grid = _grid(loop, drive, horizon, points, rounding)
    if discrete:
        snapshots = _stepped(network, grid.times, drive)
    elif numbers.name == "float":
        snapshots = integrated(network, grid.times, drive, grid.fastest)
    else:
        snapshots = taylor(network, grid.times, drive, digits)
    warning = None
    if numbers.name == "float":
        warning = double_precision_warning(loop)
    return Trajectory(
        system.time,
        numbers.name,
        system.names,
        grid.times,
        tuple(snapshots),
        warning,
        _note(grid.note, controller),
        loop,
        drive,
        start,
    )


def _cosines(
    pairs: Sequence[tuple[Any, Sequence[Any]]],
    rounding: Rounding | None,
    *,
    discrete: bool,
    bits: int,
) -> list[tuple[Cosine, Sequence[Any]]]:
    """Read cosines with their amplitudes.

    Raises
    ------
    InputError
        If something is no pair, or a cosine of an angle is not between −1 and 1.
    """
    made = []
    for k, pair in enumerate(several(pairs, "cosines", "pairs (number, numbers)")):
        place = f"cosines[{k}]"
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise InputError(
                f"expected a pair (number, numbers), found {shown_value(pair)}", where=place
            )
        [number] = numbers_of([pair[0]], rounding, place)
        if discrete and abs(number) > 1:
            raise InputError(f"expected a cosine between -1 and 1, found {number}", where=place)
        made.append((Cosine(number, discrete, bits), pair[1]))
    return made


def _note(of_grid: str | None, controller: Controller) -> str | None:
    """What is to be known about a run, limits of inputs among it."""
    notes = [of_grid] if of_grid else []
    if any(agent.limits is not None for agent in controller.agents):
        notes.append("inputs are not cut off at the limits of the controller in this ideal loop")
    return "; ".join(notes) or None


def _grid(
    loop: ClosedLoop, drive: Drive, horizon: Any, points: int | None, rounding: Rounding | None
) -> Grid:
    """The times of a run, and the fastest mode."""
    discrete = is_discrete(loop.plant.time)
    end = None
    if horizon is not None:
        [end] = numbers_of([horizon], rounding, "horizon")
    if discrete and end is not None and (end != int(end) or end < 0):
        raise UsageError(f"expected a number of steps, found {end}", where="horizon")
    if points is not None and (isinstance(points, bool) or not isinstance(points, int)):
        raise InputError(f"expected an integer, found {shown_value(points)}", where="points")
    if not discrete and ((end is not None and end <= 0) or (points is not None and points < 1)):
        raise UsageError("expected a horizon above 0 and at least one interval")
    last = max((change.time for change in drive.changes), default=Fraction(0))
    return chosen_grid(loop, last, end, points)


def _stepped(network: Network, times: Sequence[Fraction], drive: Drive) -> list[Snapshot]:
    """Run the steps of discrete time.

    Raises
    ------
    LimitReached
        If a number exceeds the range of double precision, where that is used.
    """
    import numpy as np

    snapshots = []
    for time in times:
        drive.apply(network, time)
        with np.errstate(over="ignore", invalid="ignore"):
            snapshot, state, parts = network.round()
        if network.arithmetic.name == "float":
            representable(network.state)
        snapshots.append(snapshot)
        network.set_state(state, parts)
    return snapshots
