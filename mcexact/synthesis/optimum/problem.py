"""All controllers of one structure as the free entries of one gain matrix."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate

import numpy as np
import numpy.typing as npt

from mcexact.exact.floats import matrix_to_float
from mcexact.exact.location import is_discrete
from mcexact.synthesis.network.networks import DerivedNetwork, Signal
from mcexact.synthesis.optimum.ties import Places, Ties
from mcexact.synthesis.optimum.weights import Floats, Weights

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
        >>> from mcexact.synthesis.network.networks import decentralized_network
        >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
        >>> problem = FeedbackProblem.of(decentralized_network(plant), [1], Weights.unit(plant))
        >>> problem.loop(np.array([-2.0, 3.0, 1.0, -4.0])).tolist()
        [[0.0, 1.0, 0.0], [-2.0, 0.0, 3.0], [1.0, 0.0, -4.0]]
        """
        given, derived, z = network.given, network.system, sum(orders)
        rows, sources = _signals(network)
        agents, (n, N, p) = (
            _places(network, orders, sources),
            (given.n, derived.n, weights.R.shape[0]),
        )
        inputs = [matrix_to_float(derived.B(i)) for i in range(given.m)]
        own = [given.p(i) for i in range(given.m)]
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
        )

    @property
    def discrete(self) -> bool:
        """Whether the plant is in discrete time."""
        return is_discrete(self.network.given.time)

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
        found: Floats = K.ravel()[self._free] / self.scale.ravel()[self._free]
        return found if self.ties is None else self.ties.values(found)

    def gradient(self, G: Floats) -> Floats:
        """Return the gradient in the free entries, for the gradient in K."""
        found: Floats = G.ravel()[self._free] * self.scale.ravel()[self._free]
        return found if self.ties is None else self.ties.summed(found)

    @cached_property
    def bare(self) -> FeedbackProblem:
        """The same problem without the small weights of sub-states."""
        n, p = self.n, self.p

        def corner(M: Floats, size: int) -> Floats:
            found = np.zeros(M.shape)
            found[:size, :size] = M[:size, :size]
            return found

        return replace(self, Q=corner(self.Q, n), R=corner(self.R, p), W=corner(self.W, n))

    @cached_property
    def columns_of_states(self) -> tuple[Places, ...]:
        """For each row of K from the p-th on, the columns in which its state is used."""
        found: list[Places] = []
        sent = {
            (signal[1], tuple(columns)): columns
            for agent in self.agents
            for signal, columns in agent.signals.items()
            if signal[0] == "x"
        }
        for j, agent in enumerate(self.agents):
            blocks = [columns for (of, _), columns in sent.items() if of == j]
            found += [
                np.array([b[k] for b in blocks], dtype=np.intp) for k in range(len(agent.updates))
            ]
        found += [np.array([c]) for agent in self.agents for c in agent.private_columns]
        return tuple(found)

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
    found = np.zeros((rows + size, columns + size))
    found[:rows, :columns] = M
    found[rows:, columns:] = diagonal * np.eye(size)
    return found


def _signals(network: DerivedNetwork) -> tuple[Floats, Sources]:
    """Return the rows of all signals, each once, and where each signal of each age stands."""
    found: list[Floats] = []
    places: Sources = {}
    start = 0
    for _, signal, rows in _received(network):
        key = signal, rows.tobytes()
        if key not in places:
            places[key] = slice(start, start + len(rows))
            found.append(rows)
            start += len(rows)
    return np.vstack([np.zeros((0, network.system.n)), *found]), places


def _received(network: DerivedNetwork) -> list[tuple[int, Signal, Floats]]:
    """Return what each agent receives, in its order: the agent, the signal and the rows of C̄_i."""
    found: list[tuple[int, Signal, Floats]] = []
    for i, signals in enumerate(network.signals):
        C, start = matrix_to_float(network.system.C(i)), 0
        for signal in signals:
            stop = start + network.size(signal)
            found.append((i, signal, C[start:stop]))
            start = stop
    return found


def _places(
    network: DerivedNetwork, orders: Sequence[int], sources: Sources
) -> tuple[AgentPlaces, ...]:
    """Number the rows (u, v, z) and the columns (signals, z) of K, agent by agent."""
    given, signals = network.given, max((s.stop for s in sources.values()), default=0)
    p = [0, *accumulate(given.p(i) for i in range(given.m))]
    v = [p[-1] + k for k in (0, *accumulate(network.dimensions))]
    z = [0, *accumulate(orders)]
    heard: list[list[int]] = [[] for _ in range(given.m)]
    columns: list[dict[Signal, Places]] = [{} for _ in range(given.m)]
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
        for i in range(given.m)
    )


def _outputs(network: DerivedNetwork, sources: Sources) -> Places:
    """Return for each signal the output of the plant that it is, −1 for sub-states."""
    given = network.given
    starts = [0, *accumulate(given.q(i) for i in range(given.m))]
    found = np.full(max((s.stop for s in sources.values()), default=0), -1)
    for ((what, j), _), where in sources.items():
        if what == "y":
            found[where] = np.arange(starts[j], starts[j + 1])
    return found


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
        age[where] = k + 1 if seen[:, network.given.n :].any() else 0
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
