"""All controllers of a structure as one gain matrix with free entries.

`FeedbackProblem` writes a network of agents, with or without private and shared states, as the loop
M(K) = A + B K C, with K zero outside a mask.  Structures without communication and with shared
sub-states differ in A, B, C and the mask alone, and one search serves them all.  `controller_of`
converts a gain matrix to agent programs, `problem_of` a controller to a gain matrix.

The search also needs from here: `Weights` of the linear-quadratic cost; `Ties`, which keep entries
equal for agents that use the same program; `SchurForm`, one decomposition of a loop for the
Gramians of all its shifts; `balanced` and `rounded` gain matrices; and `Effort`, the work of a
search, which is counted and not timed so that it ends at the same step on every machine.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import accumulate
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from scipy.linalg import block_diag, lapack
from threadpoolctl import threadpool_limits

from mcexact.analysis.performance import default_weights
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, matrix_from_float, matrix_to_float, to_float
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import Controller
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import Units, inverted, scaled, system_in
from mcexact.synthesis.channel_controller import ChannelController
from mcexact.synthesis.networks import (
    DerivedNetwork,
    Signal,
    decentralized_network,
    degree_of,
    integrated_plant,
    network_programs,
    without_integrators,
)

# Floating-point arithmetic in one thread, without warnings about numbers that are dropped.


@contextmanager
def quiet_floats() -> Iterator[None]:
    """Compute in one thread and without warnings.

    For matrices of some hundred rows threads cost more time than they save.  Numbers that overflow
    or are nearly singular belong to controllers that are dropped, or to figures that are then NaN
    or infinite.
    """
    with threadpool_limits(1, "blas"), np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


# The work that a search may do: counted, not timed, so that results are reproducible.

_OVERHEAD = 48
"""The number of states at which the arithmetic of one cost takes as long as what surrounds it."""
PER_SECOND = 3000
"""About as many units as a processor of 2024 does in a second."""


@dataclass
class Effort:
    """A number of units, each about the cost of one loop of a few states.

    Attributes
    ----------
    limit : float
    spent : float
    whole : Effort or None
        The effort of which this is a part, in which all work is counted as well.
    deadline : float or None
        The time of `time.monotonic` after which nothing is left, whatever was spent; results depend
        on the machine's load only where it passes.

    Examples
    --------
    >>> effort = Effort(100)
    >>> part = effort.part(0.5)
    >>> part.take(0, times=50)
    >>> part.over, effort.left
    (True, 50.0)
    """

    limit: float
    spent: float = 0.0
    whole: Effort | None = field(default=None, repr=False)
    deadline: float | None = None

    def take(self, states: int, times: float = 1.0) -> None:
        """Count some costs of a loop of some states, of O(N³) operations each."""
        self._add(times * (1 + (states / _OVERHEAD) ** 3))

    def _add(self, cost: float) -> None:
        self.spent += cost
        if self.whole is not None:
            self.whole._add(cost)

    @property
    def left(self) -> float:
        """What is left, 0 or more."""
        return max(self.limit - self.spent, 0.0)

    @property
    def over(self) -> bool:
        """Whether nothing is left."""
        return self.late or self.left <= 0

    @property
    def late(self) -> bool:
        """Whether the deadline has passed."""
        return self.deadline is not None and time.monotonic() >= self.deadline

    def part(self, share: float) -> Effort:
        """Return a share of the units that are left, as an effort of its own."""
        return Effort(self.left * share, whole=self, deadline=self.deadline)


# Weights of the linear-quadratic cost of a plant.

Floats = npt.NDArray[np.float64]

_ROUNDING = 1e-12
NAMES = ("Q", "R", "W", "V")


@dataclass(frozen=True, eq=False)
class Weights:
    """Weights of the cost E[x'Qx + u'Ru], and the covariances of the noises of state and outputs.

    Attributes
    ----------
    Q, W : ndarray, n × n
        The weight of the state, and the covariance of its noise.
    R : ndarray, p × p
        The weight of all inputs, in the order of the channels.
    V : ndarray, q × q
        The intensity of the noise of all outputs, in the order of the channels; in discrete time
        its covariance.
    bandwidth : float or None
        ω in continuous time, where the noise ν of the outputs has ν̇ = ω(n − ν), n white; without it
        the noise is white, and what a controller passes on at once counts tr(R K V K').
    """

    Q: Floats
    R: Floats
    W: Floats
    V: Floats
    bandwidth: float | None = None

    @classmethod
    def unit(cls, system: MultiChannelSystem) -> Weights:
        """Return the weights of `default_weights`, which certificates of costs have by default.

        Examples
        --------
        >>> weights = Weights.unit(MultiChannelSystem([[1]], [[[1]]], [[[1]]]))
        >>> weights.Q.tolist(), weights.V.tolist(), weights.bandwidth
        ([[1.0]], [[0.01]], 100.0)
        """
        chosen = default_weights(system)
        parts = (chosen.states, chosen.inputs, chosen.disturbances, chosen.noise)
        Q, R, W, V = (np.diag([to_float(x) for x in part]) for part in parts)
        bandwidth = None if chosen.bandwidth is None else to_float(chosen.bandwidth)
        return cls(Q, R, W, V, bandwidth)

    @classmethod
    def of(
        cls,
        system: MultiChannelSystem,
        chosen: Mapping[str, Any] | None = None,
        units: Units | None = None,
    ) -> Weights:
        """Return the chosen weights, completed by those of `unit`.

        Parameters
        ----------
        system : MultiChannelSystem
        chosen : mapping of {"Q", "R", "W", "V"} to matrix, optional
            Symmetric matrices of numbers, as arrays or as lists of rows.  Q and W are positive
            semidefinite, R and V are positive definite.
        units : Units, optional
            Those in which the plant is measured for which the weights are; the system and the
            chosen weights are in the units of the file.

        Raises
        ------
        InputError
            If a name is unknown, or a matrix has another size or is not as described.

        Examples
        --------
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
        >>> Weights.of(plant, {"R": [["1/4"]]}).R.tolist()
        [[0.25]]
        >>> Weights.of(plant, {"R": [[0]]})
        Traceback (most recent call last):
            ...
        mcexact.errors.InputError: weights.R: expected a positive definite matrix
        """
        weights = cls.unit(system if units is None else system_in(units, system))
        for name, entries in (chosen or {}).items():
            where = f"weights.{name}"
            if name not in NAMES:
                raise InputError(f"expected one of {', '.join(NAMES)}, found {name!r}", where=where)
            size = len(getattr(weights, name))
            checked = _checked(entries, size, where, definite=name in "RV")
            if units is not None:
                by = {"R": units.of_inputs, "V": inverted(units.of_outputs)}
                own = by.get(name, units.states if name == "Q" else inverted(units.states))
                each = np.array([to_float(unit) for unit in own])
                checked = checked * np.outer(each, each)
            changed: dict[str, Any] = {name: checked}
            weights = replace(weights, **changed)
        return weights

    def with_integrators(
        self,
        selection: Sequence[Matrix],
        sizes: Sequence[Fraction] | None = None,
        degree: int = 1,
    ) -> Weights:
        """Return the weights of `integrated_plant`, for the weights of a system.

        Integrators are weighed by 1 and have noise of covariance 1, in units of their sizes.  What
        agents measure of them has the noise of the combinations S_i y_i of outputs, independently.

        Parameters
        ----------
        selection : sequence of m Matrix
        sizes : sequence of Fraction, optional
            Of the integrators; by default 1.
        degree : int
            The blocks of each model, if models of other signals stand in place of integrators.
        """
        S = block_diag(np.zeros((0, 0)), *map(matrix_to_float, selection))
        large = np.array([to_float(size) for size in sizes or [Fraction(1)] * (degree * len(S))])
        order = list[int]()
        first = second = 0
        for each in selection:
            # The integrals of a channel come first, then its outputs.
            for block in range(degree):
                order += range(block * len(S) + first, block * len(S) + first + each.nrows)
            order += range(degree * len(S) + second, degree * len(S) + second + each.ncols)
            first, second = first + each.nrows, second + each.ncols
        V = block_diag(*[S @ self.V @ S.T] * degree, self.V)[np.ix_(order, order)]
        Q, W = block_diag(self.Q, np.diag(large**-2)), block_diag(self.W, np.diag(large**2))
        return Weights(Q, self.R, W, V, self.bandwidth)


def integrated_problem(
    system: MultiChannelSystem,
    selection: Sequence[Matrix],
    chosen: Mapping[str, Any] | None = None,
    signals: Polynomial | None = None,
) -> tuple[MultiChannelSystem, Weights, Units | None]:
    """The plant with its integrators in units near its sizes, its weights, and these units.

    Parameters
    ----------
    system : MultiChannelSystem
    selection : sequence of m Matrix
    signals : Polynomial, optional
        As for `integrated_plant`.
    chosen : mapping, optional
        As for `Weights.of`, for the plant without integrators.
    """
    plant, d = integrated_plant(system, selection, signals), degree_of(signals)
    units, count = Units.of(plant), d * sum(S.nrows for S in selection)
    if units is None:
        sizes = None if plant.typical_sizes is None else plant.typical_sizes.of_states(plant.n)
        large = None if sizes is None else sizes[system.n :]
        return plant, Weights.of(system, chosen).with_integrators(selection, large, d), None
    measured = system_in(units, plant)
    own = measured.typical_sizes or TypicalSizes()
    weights = Weights.of(system, chosen, without_integrators(units, selection, d))
    parts = [
        scaled(S, inverted(each[: S.nrows]), each[d * S.nrows :])
        for S, each in zip(selection, units.outputs, strict=True)
    ]
    large = own.of_states(plant.n)[plant.n - count :]
    return measured, weights.with_integrators(parts, large, d), units


def _checked(entries: Any, size: int, where: str, *, definite: bool) -> Floats:
    """Convert a symmetric matrix of a size, and check that it is (semi)definite."""
    if isinstance(entries, Matrix):
        M = entries
    elif isinstance(entries, np.ndarray):
        M = matrix_from_float(entries, "dyadic", where=where)
    else:
        M = _read(entries, where)
    if M.shape != (size, size):
        raise InputError(
            f"expected a {size} × {size} matrix, found {M.nrows} × {M.ncols}", where=where
        )
    if M != M.T:
        raise InputError("expected a symmetric matrix", where=where)
    array = matrix_to_float(M)
    if not np.all(np.isfinite(array)):
        raise InputError("expected numbers in the range of double precision", where=where)
    least, largest = np.linalg.eigvalsh(array)[[0, -1]] if size else (1.0, 1.0)
    if definite and not least > _ROUNDING * largest:
        raise InputError("expected a positive definite matrix", where=where)
    if not least >= -_ROUNDING * abs(largest):
        raise InputError("expected a positive semidefinite matrix", where=where)
    return array


def _read(entries: Any, where: str) -> Matrix:
    """Read rows of numbers, which may be floats or exact."""
    if not isinstance(entries, list | tuple) or not all(
        isinstance(row, list | tuple) for row in entries
    ):
        raise InputError("expected a list of rows of numbers", where=where)
    if any(isinstance(entry, float) for row in entries for entry in row):
        return matrix_from_float(entries, "decimal", where=where)
    return Matrix.from_rows(entries, where=where)


Places = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Ties:
    """Which free entries of K are equal.

    Attributes
    ----------
    number : ndarray of int
        For each free entry the number of the value that it has.
    chosen : ndarray of bool
        The free entry, one for each value, from which the value of a given K is taken.
    """

    number: Places
    chosen: npt.NDArray[np.bool_]

    @property
    def count(self) -> int:
        """The number of values."""
        return int(np.count_nonzero(self.chosen))

    def values(self, entries: Floats) -> Floats:
        """Return the values of some entries."""
        distinct = np.empty(self.count)
        distinct[self.number[self.chosen]] = entries[self.chosen]
        return distinct

    def summed(self, entries: Floats) -> Floats:
        """Sum the entries that have the same value, as the chain rule does with gradients."""
        sums = np.bincount(self.number, entries, minlength=self.count)
        return np.asarray(sums, dtype=np.float64)


# All controllers of one structure as the free entries of one gain matrix.

Sources = dict[tuple[Signal, bytes], slice]
"""The rows of each signal of each age, which is known by the bytes of its output matrix."""
Structure = tuple[DerivedNetwork, tuple[int, ...]]
"""A network, and the dimensions of the agents' private states."""

_SMALL = 1e-6
"""The weight of sub-states, of their updates and of their noise, which makes optima isolated."""


@dataclass(frozen=True, eq=False)
class AgentPlaces:
    """The rows and columns of K that belong to one agent.

    Attributes
    ----------
    inputs, updates, private_rows : ndarray of int
        The rows of u_i, of the update of x_i, and of the update of z_i.
    heard, private_columns : ndarray of int
        The columns of the signals that the agent receives, in their order, and of z_i.
    own : ndarray of int
        The columns of y_i.
    signals : mapping
        The columns of each signal that the agent receives.
    """

    inputs: Places
    updates: Places
    private_rows: Places
    heard: Places
    private_columns: Places
    own: Places
    signals: Mapping[Signal, Places]

    @property
    def rows(self) -> Places:
        """The rows of (u_i, x_i, z_i)."""
        return np.concatenate([self.inputs, self.updates, self.private_rows])

    @property
    def columns(self) -> Places:
        """The columns of everything that the agent uses."""
        return np.concatenate([self.heard, self.private_columns])


@dataclass(frozen=True, eq=False)
class Sizes:
    """Sizes of the signals of a plant, by which the entries of K are made comparable.

    Attributes
    ----------
    inputs, outputs : ndarray
        Of all inputs and outputs, in the order of the channels.
    pace : float
        Of the derivative of an agent's state that is of size 1; in discrete time 1.
    """

    inputs: Floats
    outputs: Floats
    pace: float = 1.0


@dataclass(frozen=True, eq=False)
class FeedbackProblem:
    """The loops M(K) = A + B K C of a network, K zero outside a mask, and weights of their cost.

    In block form, with the derived system (Ā, B̄_i, C̄_i) of the network and private states z::

            ⎡ Ā  0 ⎤        ⎡ B̄  0 ⎤        ⎡ C̄  0 ⎤        u, v ⎡ F̄     C_z ⎤
        A = ⎣ 0  0 ⎦ ,  B = ⎣ 0  I ⎦ ,  C = ⎣ 0  I ⎦ ,  K = ż    ⎣ B_z   A_z ⎦

    A row of C̄ that several agents receive occurs once.

    Attributes
    ----------
    network : DerivedNetwork
    orders : tuple of int
        The dimensions of the private states z_1 … z_m.
    A, B, C : ndarray, N × N, N × P and L × N
    mask : ndarray of bool, P × L
    agents : tuple of AgentPlaces
    n, p : int
        The numbers of plant states and plant inputs, which come first.
    Q, R, W, V : ndarray
        The weights of N states, P rows of K, N state noises and L noises of signals.
    scale : ndarray, P × L
        The entries of K are multiples of these.
    ties : Ties or None
        Free entries that are equal, if any are.
    bandwidth : float or None
        That of the noise; see `Weights`.
    """

    network: DerivedNetwork
    orders: tuple[int, ...]
    A: Floats
    B: Floats
    C: Floats
    mask: npt.NDArray[np.bool_]
    agents: tuple[AgentPlaces, ...]
    n: int
    p: int
    Q: Floats
    R: Floats
    W: Floats
    V: Floats
    scale: Floats
    ties: Ties | None = None
    bandwidth: float | None = None

    @classmethod
    def of(
        cls,
        network: DerivedNetwork,
        orders: Sequence[int],
        weights: Weights,
        sizes: Sizes | None = None,
    ) -> FeedbackProblem:
        """Make the problem of a network whose agents have private states of some dimensions.

        Parameters
        ----------
        network : DerivedNetwork
        orders : sequence of m int
        weights : Weights
            Of the plant.
        sizes : Sizes, optional
            By default 1.

        Examples
        --------
        >>> from mcexact.model.system import MultiChannelSystem
        >>> from mcexact.synthesis.networks import decentralized_network
        >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
        >>> problem = FeedbackProblem.of(decentralized_network(plant), [1], Weights.unit(plant))
        >>> problem.loop(np.array([-2.0, 3.0, 1.0, -4.0])).tolist()
        [[0.0, 1.0, 0.0], [-2.0, 0.0, 3.0], [1.0, 0.0, -4.0]]
        """
        plant, derived, z = network.plant, network.system, sum(orders)
        rows, sources = _signals(network)
        agents, (n, N, p) = (
            _places(network, orders, sources),
            (plant.n, derived.n, weights.R.shape[0]),
        )
        inputs = [matrix_to_float(derived.B(i)) for i in range(plant.m)]
        own = [plant.p(i) for i in range(plant.m)]
        upper = [B[:, :k] for B, k in zip(inputs, own, strict=True)]
        lower = [B[:, k:] for B, k in zip(inputs, own, strict=True)]
        B, C = np.hstack([*upper, *lower]), rows
        mask = np.zeros((B.shape[1] + z, len(C) + z), dtype=np.bool_)
        for each in agents:
            mask[np.ix_(each.rows, each.columns)] = True
        return cls(
            network,
            tuple(orders),
            _corner(matrix_to_float(derived.A), z, 0.0),
            _corner(B, z, 1.0),
            _corner(C, z, 1.0),
            mask,
            agents,
            n,
            p,
            _corner(_corner(weights.Q, N - n, _SMALL), z, _SMALL),
            _corner(weights.R, B.shape[1] - p + z, _SMALL),
            _corner(_corner(weights.W, N - n, _SMALL), z, _SMALL),
            _corner(_noise(network, sources, weights.V), z, 0.0),
            _scale(mask.shape, _outputs(network, sources), sizes),
            bandwidth=weights.bandwidth,
        )

    @property
    def discrete(self) -> bool:
        """Whether the plant is in discrete time."""
        return is_discrete(self.network.plant.time)

    @property
    def size(self) -> int:
        """The number of free entries of K, of equal ones only one."""
        return int(self._free.size) if self.ties is None else self.ties.count

    @property
    def order(self) -> int:
        """The dimension of all agents' states."""
        return sum(self.orders) + sum(self.network.dimensions)

    @cached_property
    def _free(self) -> Places:
        return np.flatnonzero(self.mask)

    def with_ties(self, ties: Ties) -> FeedbackProblem:
        """Return the problem in which some free entries are equal, and so are their scales."""
        scale = self.scale.ravel().copy()
        logarithms = ties.summed(np.log(scale[self._free])) / ties.summed(np.ones(self._free.size))
        scale[self._free] = np.exp(logarithms)[ties.number]
        return replace(self, scale=scale.reshape(self.scale.shape), ties=ties)

    @property
    def untied(self) -> FeedbackProblem:
        """The same problem in which no entries have to be equal."""
        return self if self.ties is None else replace(self, ties=None)

    def gain(self, x: Floats) -> Floats:
        """Return K with the free entries x."""
        K = np.zeros(self.mask.size)
        entries = x if self.ties is None else x[self.ties.number]
        K[self._free] = entries * self.scale.ravel()[self._free]
        return K.reshape(self.mask.shape)

    def entries(self, K: Floats) -> Floats:
        """Return the free entries of K as multiples of their scale, for which K is the gain.

        Of equal ones it is one, and K is the gain if they are equal in K.
        """
        scaled: Floats = K.ravel()[self._free] / self.scale.ravel()[self._free]
        return scaled if self.ties is None else self.ties.values(scaled)

    def gradient(self, G: Floats) -> Floats:
        """Return the gradient in the free entries, for the gradient in K."""
        scaled: Floats = G.ravel()[self._free] * self.scale.ravel()[self._free]
        return scaled if self.ties is None else self.ties.summed(scaled)

    @cached_property
    def bare(self) -> FeedbackProblem:
        """The same problem without the small weights of sub-states."""
        n, p = self.n, self.p

        def corner(M: Floats, size: int) -> Floats:
            padded = np.zeros(M.shape)
            padded[:size, :size] = M[:size, :size]
            return padded

        return replace(self, Q=corner(self.Q, n), R=corner(self.R, p), W=corner(self.W, n))

    @cached_property
    def columns_of_states(self) -> tuple[Places, ...]:
        """For each row of K from the p-th on, the columns in which its state is used."""
        places: list[Places] = []
        sent = {
            (signal[1], tuple(columns)): columns
            for agent in self.agents
            for signal, columns in agent.signals.items()
            if signal[0] == "x"
        }
        for j, agent in enumerate(self.agents):
            blocks = [columns for (of, _), columns in sent.items() if of == j]
            places += [
                np.array([b[k] for b in blocks], dtype=np.intp) for k in range(len(agent.updates))
            ]
        places += [np.array([c]) for agent in self.agents for c in agent.private_columns]
        return tuple(places)

    def closed(self, K: Floats) -> Floats:
        """Return M = A + B K C."""
        M: Floats = self.A + self.B @ K @ self.C
        return M

    def loop(self, x: Floats) -> Floats:
        """Return M = A + B K C for the free entries x of K."""
        return self.closed(self.gain(x))


def _corner(M: Floats, size: int, diagonal: float) -> Floats:
    """Append a multiple of the identity as a diagonal block."""
    rows, columns = M.shape
    bordered = np.zeros((rows + size, columns + size))
    bordered[:rows, :columns] = M
    bordered[rows:, columns:] = diagonal * np.eye(size)
    return bordered


def _signals(network: DerivedNetwork) -> tuple[Floats, Sources]:
    """Return the rows of all signals, each once, and where each signal of each age stands."""
    blocks: list[Floats] = []
    places: Sources = {}
    start = 0
    for _, signal, rows in _received(network):
        key = signal, rows.tobytes()
        if key not in places:
            places[key] = slice(start, start + len(rows))
            blocks.append(rows)
            start += len(rows)
    return np.vstack([np.zeros((0, network.system.n)), *blocks]), places


def _received(network: DerivedNetwork) -> list[tuple[int, Signal, Floats]]:
    """Return what each agent receives, in its order: the agent, the signal and the rows of C̄_i."""
    received: list[tuple[int, Signal, Floats]] = []
    for i, signals in enumerate(network.signals):
        C, start = matrix_to_float(network.system.C(i)), 0
        for signal in signals:
            stop = start + network.size(signal)
            received.append((i, signal, C[start:stop]))
            start = stop
    return received


def _places(
    network: DerivedNetwork, orders: Sequence[int], sources: Sources
) -> tuple[AgentPlaces, ...]:
    """Number the rows (u, v, z) and the columns (signals, z) of K, agent by agent."""
    plant, signals = network.plant, max((s.stop for s in sources.values()), default=0)
    p = [0, *accumulate(plant.p(i) for i in range(plant.m))]
    v = [p[-1] + k for k in (0, *accumulate(network.dimensions))]
    z = [0, *accumulate(orders)]
    heard: list[list[int]] = [[] for _ in range(plant.m)]
    columns: list[dict[Signal, Places]] = [{} for _ in range(plant.m)]
    for i, signal, rows in _received(network):
        place = sources[signal, rows.tobytes()]
        heard[i] += range(place.start, place.stop)
        columns[i][signal] = np.arange(place.start, place.stop)
    return tuple(
        AgentPlaces(
            np.arange(p[i], p[i + 1]),
            np.arange(v[i], v[i + 1]),
            np.arange(v[-1] + z[i], v[-1] + z[i + 1]),
            np.array(heard[i], dtype=np.intp),
            np.arange(signals + z[i], signals + z[i + 1]),
            columns[i].get(("y", i), np.arange(0)),
            columns[i],
        )
        for i in range(plant.m)
    )


def _outputs(network: DerivedNetwork, sources: Sources) -> Places:
    """Return for each signal the output of the plant that it is, −1 for sub-states."""
    plant = network.plant
    starts = [0, *accumulate(plant.q(i) for i in range(plant.m))]
    places = np.full(max((s.stop for s in sources.values()), default=0), -1)
    for ((what, j), _), where in sources.items():
        if what == "y":
            places[where] = np.arange(starts[j], starts[j + 1])
    return places


def _noise(network: DerivedNetwork, sources: Sources, V: Floats) -> Floats:
    """Return the covariance of the noise of all signals.

    Outputs carry the noise of the plant, sub-states none.  The noises of one output at two ages are
    independent.
    """
    place = _outputs(network, sources)
    age = np.zeros(len(place), dtype=np.intp)
    for k, ((_, rows), where) in enumerate(sources.items()):
        seen = np.frombuffer(rows).reshape(where.stop - where.start, network.system.n)
        # What is under way is read from the states after those of the plant.
        age[where] = k + 1 if seen[:, network.plant.n :].any() else 0
    together = (place[:, None] >= 0) & (place >= 0) & (age[:, None] == age)
    return np.where(together, V[np.ix_(place, place)] if V.size else 0.0, 0.0)


def _scale(shape: tuple[int, ...], outputs: Places, sizes: Sizes | None) -> Floats:
    """Return the sizes of rows over the sizes of columns."""
    if sizes is None:
        return np.ones(shape)
    rows, columns = np.full(shape[0], sizes.pace), np.ones(shape[1])
    rows[: len(sizes.inputs)] = sizes.inputs
    seen = np.flatnonzero(outputs >= 0)
    columns[seen] = sizes.outputs[outputs[seen]]
    return np.outer(rows, 1 / columns)


# One real Schur form of a loop: its eigenvalues, and the Gramians of its shifts.


@dataclass(frozen=True, eq=False)
class SchurForm:
    """M = Z T Z', Z orthogonal and T quasi upper triangular.

    Attributes
    ----------
    T, Z : ndarray, N × N
    eigenvalues : ndarray of complex, N
    discrete : bool
    """

    T: Floats
    Z: Floats
    eigenvalues: npt.NDArray[np.complex128]
    discrete: bool

    @classmethod
    def of(cls, M: Floats, *, discrete: bool) -> SchurForm | None:
        """Compute the Schur form; None if M is not finite or the iteration fails.

        Examples
        --------
        >>> form = SchurForm.of(np.array([[0.0, 1.0], [-2.0, -3.0]]), discrete=False)
        >>> round(form.bound, 6)
        -1.0
        """
        if not len(M):
            return cls(M, M, np.zeros(0, dtype=np.complex128), discrete)
        if not np.all(np.isfinite(M)):
            return None
        T, _, real, imaginary, Z, _, info = lapack.dgees(lambda *_: 0, M, lwork=8 * len(M))
        return None if info else cls(T, Z, real + 1j * imaginary, discrete)

    @property
    def bound(self) -> float:
        """The largest real part (continuous time) or modulus (discrete time) of an eigenvalue."""
        if not len(self.T):
            return 0.0 if self.discrete else -np.inf
        sizes = np.abs(self.eigenvalues) if self.discrete else self.eigenvalues.real
        return float(np.max(sizes))

    def gramians(self, W: Floats, Q: Floats, shift: float) -> tuple[Floats, Floats] | None:
        """Solve the two Lyapunov equations of the shifted loop.

        Parameters
        ----------
        W, Q : ndarray, N × N
            Symmetric, positive semidefinite.
        shift : float
            a in continuous time, where the shifted loop is M + aI, or ρ in discrete time, where it
            is M/ρ; it has to be stable.

        Returns
        -------
        S, P : ndarray, N × N, or None
            M S + S M' + W = 0 and M'P + P M + Q = 0 (discrete time: M S M' − S + W = 0 and
            M'P M − P + Q = 0) for the shifted M.  None if they are not finite, or not positive
            semidefinite up to rounding.

        Notes
        -----
        In discrete time (T + I)⁻¹(T − I) is quasi triangular with T, with zeros where T has them,
        and has the equations of continuous time with 2(T + I)⁻¹W(T + I)⁻ᵀ.
        """
        T, Z = self.T, self.Z
        if not len(T):
            return W, Q
        W, Q = Z.T @ W @ Z, Z.T @ Q @ Z
        if self.discrete:
            inverse = np.linalg.inv(T / shift + np.eye(len(T)))
            W, Q = 2 * inverse @ W @ inverse.T, 2 * inverse.T @ Q @ inverse
            T = np.eye(len(T)) - 2 * inverse
        else:
            T = T + shift * np.eye(len(T))
        S, scale, _ = lapack.dtrsyl(T, T, -W, trana="N", tranb="T")
        P, dual, _ = lapack.dtrsyl(T, T, -Q, trana="T", tranb="N")
        if not scale or not dual:
            return None
        S, P = Z @ (S / scale) @ Z.T, Z @ (P / dual) @ Z.T
        for each in (S, P):
            if not np.all(np.isfinite(each)) or np.min(np.diag(each)) < -1e-9 * np.max(
                np.abs(each)
            ):
                return None
        return S, P


def filtered_noise(
    M: Floats, entering: Floats, V: Floats, bandwidth: float, shift: float = 0.0
) -> tuple[Floats, Floats]:
    """Compute the covariances of filtered noise ν, ν̇ = ω(n − ν), with a loop ẋ = M x + G ν, and ν.

    Parameters
    ----------
    M, entering : ndarray, N × N and N × q
        M and G; with a shift a the loop is M + aI and the filter has ω − a in place of ω, but for
        the size of the noise.
    V : ndarray, q × q
        The intensity of n.
    bandwidth : float
        ω, above 2a.
    shift : float

    Returns
    -------
    X, Y : ndarray, N × q and q × q
        E[xν'] and E[νν']: 2(ω − a) Y = ω² V and (ω − 2a − M) X = G Y.
    """
    Y = V * (bandwidth**2 / (2 * (bandwidth - shift)))
    slower = (bandwidth - 2 * shift) * np.eye(len(M)) - M
    return solved_or_nan(slower, entering @ Y), Y


AnyNumbers = TypeVar("AnyNumbers", Floats, npt.NDArray[np.complex128])


def solved_or_nan(M: AnyNumbers, right: AnyNumbers) -> AnyNumbers:
    """Solve a linear system; NaN where floating point cannot."""
    try:
        return np.asarray(np.linalg.solve(M, right), dtype=M.dtype)
    except np.linalg.LinAlgError:
        return np.full((len(M), right.shape[1]), np.nan, dtype=M.dtype)


# Controllers as gain matrices, and gain matrices as controllers.

NetworkController = tuple[DerivedNetwork, Controller]
"""A network, and a controller of it."""

single_channel = decentralized_network
"""The network of a plant in which one channel has all inputs and outputs."""


def controller_of(problem: FeedbackProblem, K: Floats) -> Controller:
    """Write the agents' programs of a gain matrix, every entry as its shortest decimal.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.networks import decentralized_network
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [0], Weights.unit(plant))
    >>> controller_of(problem, np.array([[-2.5]])).agents[0].input.outputs[0].rows()
    ((Fraction(-5, 2),),)
    """

    def part(rows: Floats) -> Matrix:
        return matrix_from_float(rows, "decimal", where="K")

    gains, channels = [], {}
    for i, agent in enumerate(problem.agents):
        rows = np.concatenate([agent.inputs, agent.updates])
        own, heard, z = agent.private_rows, agent.heard, agent.private_columns
        gains.append(part(K[np.ix_(rows, heard)]))
        if len(own):
            channels[i] = ChannelController(
                part(K[np.ix_(own, z)]),
                part(K[np.ix_(own, heard)]),
                part(K[np.ix_(rows, z)]),
                Matrix.zeros(len(rows), len(heard)),
                None,
            )
    return network_programs(problem.network, gains, channels)


def problem_of(
    network: DerivedNetwork,
    controller: Controller,
    weights: Weights,
    sizes: Sizes | None = None,
) -> tuple[FeedbackProblem, Floats]:
    """Return the problem in which a controller of a network is a gain matrix, and this matrix.

    Parameters
    ----------
    network : DerivedNetwork
    controller : Controller
        Made for the same network, with its dimensions of sub-states.
    weights : Weights
    sizes : Sizes, optional
    """
    orders = [each.private for each in controller.agents]
    problem = FeedbackProblem.of(network, orders, weights, sizes)
    K = np.zeros(problem.mask.shape)
    for program, agent in zip(controller.agents, problem.agents, strict=True):
        rows = agent.updates, agent.private_rows, agent.inputs
        for used, place in zip(program.maps(), rows, strict=True):
            for j, M in used.outputs.items():
                K[np.ix_(place, agent.signals["y", j])] = matrix_to_float(M)
            for j, M in used.shared.items():
                K[np.ix_(place, agent.signals["x", j])] = matrix_to_float(M)
            if used.private is not None:
                K[np.ix_(place, agent.private_columns)] = matrix_to_float(used.private)
    return problem, K


def balanced(problem: FeedbackProblem, K: Floats) -> Floats:
    """Scale every state of the agents by a power of two, so that what enters and leaves it agree.

    Notes
    -----
    Exact in floating point; the eigenvalues of the loop stay.  Agents that look alike could be
    scaled differently, so that nothing is scaled while their entries have to be equal.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.networks import decentralized_network
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [1], Weights.unit(plant))
    >>> balanced(problem, np.array([[-2.0, 64.0], [1.0, -1.0]])).tolist()
    [[-2.0, 8.0], [8.0, -1.0]]
    """
    K = K.copy()
    if problem.ties is not None:
        return K
    for _ in range(5):
        for row, columns in enumerate(problem.columns_of_states, start=problem.p):
            entering, leaving = K[row].copy(), K[:, columns].copy()
            entering[columns], leaving[row] = 0.0, 0.0
            sizes = float(np.linalg.norm(entering)), float(np.linalg.norm(leaving))
            if not min(sizes) > 0:
                continue
            scale = 2.0 ** round(float(np.log2(sizes[0] / sizes[1])) / 2)
            K[row] /= scale
            K[:, columns] *= scale
    return K


def rounded(K: Floats, digits: int) -> Floats:
    """Round every entry to some significant decimal digits.

    Examples
    --------
    >>> rounded(np.array([[-0.12345, 678.9]]), 2).tolist()
    [[-0.12, 680.0]]
    """
    entries = [float(f"{entry:.{digits - 1}e}") for entry in K.ravel()]
    return np.array(entries, dtype=np.float64).reshape(K.shape)
