"""Multi-channel systems, the subject of everything else in this package."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Any, ClassVar, Self

from mcexact.errors import InputError, UsageError
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.floats import Rounding, matrix_from_float
from mcexact.exact.location import is_discrete, require_time
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import as_fraction
from mcexact.model.canonical import canonical
from mcexact.model.channel import ByChannel, Channel, channels_of, listed_matrices
from mcexact.model.matrix_entry import as_table, require_square
from mcexact.model.matrix_json import canonical_matrix_text, number_json
from mcexact.model.names import checked_text, quoted
from mcexact.model.neighbor_graph import NeighborGraph, graph_for
from mcexact.model.system_forms import SystemForms
from mcexact.model.uncertainty import Radii
from mcexact.shown import LINE, fitting

Construction = Mapping[str, Any]
# These constructions depend on the neighbor graph of the plant, or lead to systems without one.
_GRAPH_IN_USE = frozenset(
    {
        "augmented_outputs",
        "arcs",
        "dual",
        "error",
        "extended",
        "held",
        "lifted",
        "merged",
        "restricted",
    }
)


@dataclass(frozen=True, init=False, repr=False)
class MultiChannelSystem(ByChannel[Matrix], SystemForms):
    """A linear time-invariant system with m channels and rational matrices.

    In continuous time ẋ = A x + Σ B_i u_i, y_i = C_i x; in discrete time x(t+1) replaces ẋ. Agent i
    measures y_i and sets u_i.  (Paper, section I; equations `mcs` and `mcsd`.)

    Parameters
    ----------
    A : matrix, n×n
        A list of rows, a numpy array of integers, a sparse array of scipy, which stays sparse if it
        is large, or a sympy matrix; n = 0 is legal.  Entries are int, Fraction, Decimal, sympy
        Rational, or strings such as "1/3" and "0.25".
    B : sequence of m matrices
        B_i is n×p_i; p_i = 0 is legal.
    C : sequence of m matrices
        C_i is q_i×n; q_i = 0 is legal.
    time : {"continuous", "discrete"}
    names : sequence of str, optional
        The channels, by default "1" … "m".
    neighbors : NeighborGraph or mapping of names, optional
        The directed graph of who receives whose messages, with its delays.
    sample_time : rational, optional
        The sample time in discrete time, which no decision uses.
    uncertainty : Radii, optional
        How far each entry may be from its value; `Box` makes them.  Without a radius above 0 there
        are none.  Decisions are about the values unless they say that they are about every plant in
        the box.
    name, source : str, optional
        A name and a source, which no decision uses.

    Attributes
    ----------
    A : Matrix, n×n
    B, C : ChannelMatrices
        B_i and C_i by position or name: ``B[0]``, ``B["1"]``; ``channels[0].B`` is the same.
    plant : MultiChannelSystem
        The system from which this one was constructed, or this one.
    subject : tuple of mappings
        The constructions that lead from the plant to this system, in order, in the words of the
        certificate format; empty for a plant.

    Raises
    ------
    FloatRefused
        If an entry is a float; use `from_float` for floats.
    InputError
        If there are no channels, or a shape, an entry, a name or the graph is not as expected.

    Examples
    --------
    >>> system = MultiChannelSystem(A=[[0, 1], [0, 0]], B=[[[0], [1]]], C=[[["1/3", 0]]])
    >>> system
    MultiChannelSystem(n=2, m=1, continuous time, channels: '1')
    >>> MultiChannelSystem(A=[[0]], B=[[[1], [2]]], C=[[[1]]])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: B[0]: expected 1 row, found 2
    """

    _made_by: ClassVar[str] = (
        "MultiChannelSystem(A, B, C), where B and C list a matrix for each channel, "
        "or with load_system(file) or from_statespace(model, …)"
    )
    """What an error says to a caller who gives something else."""
    parameters: ClassVar[tuple[str, ...]] = ()
    """`ParametricSystem` has some."""

    A: Matrix
    channels: tuple[Channel[Matrix], ...]
    time: str
    neighbors: NeighborGraph | None
    sample_time: Fraction | None
    uncertainty: Radii | None
    name: str | None = field(compare=False)
    source: str | None = field(compare=False)
    subject: tuple[Construction, ...] = field(hash=False)
    _plant: MultiChannelSystem | None

    def __init__(
        self,
        A: Any,
        B: Sequence[Any],
        C: Sequence[Any],
        *,
        time: str = "continuous",
        names: Sequence[str] | None = None,
        neighbors: NeighborGraph | Mapping[str, Iterable[str]] | None = None,
        sample_time: Any = None,
        uncertainty: Radii | None = None,
        name: str | None = None,
        source: str | None = None,
    ) -> None:
        table = require_square(as_table(A, "A"), "A")
        # All shapes are compared before any entry is converted.
        channels = channels_of(table.shape[0], B, C, names, as_table)
        labels = tuple(channel.name for channel in channels)
        require_time(time)
        self._fill(
            A=table.matrix(),
            channels=channels,
            time=time,
            neighbors=graph_for(neighbors, labels),
            sample_time=_checked_sample_time(sample_time, time),
            uncertainty=None,
            name=None if name is None else checked_text(name, "name"),
            source=None if source is None else checked_text(source, "source"),
            subject=(),
            _plant=None,
        )
        if uncertainty is not None:
            self._fill(uncertainty=self._fitting(uncertainty))

    def _fitting(self, uncertainty: Radii) -> Radii | None:
        """Return radii that have the shapes of the matrices; None if all entries are certain."""
        InputError.require(uncertainty, Radii, "uncertainty")
        with InputError.inside("uncertainty"):
            uncertainty.require_shapes(self.A, self.B, self.C)
        return None if uncertainty.is_zero() else uncertainty

    def _fill(self, **fields: Any) -> None:
        for key, value in fields.items():
            object.__setattr__(self, key, value)

    @classmethod
    def from_float(
        cls, A: Any, B: Sequence[Any], C: Sequence[Any], *, rounding: Rounding, **options: Any
    ) -> MultiChannelSystem:
        """Build an exact system from matrices of floats.

        Parameters
        ----------
        A, B, C : matrices of floats
            Shapes as in the constructor.
        rounding : {"decimal", "dyadic"}
            How a float becomes exact: "decimal" takes the shortest decimal that prints it (0.1
            becomes 1/10), and "dyadic" its exact binary value (0.1 becomes
            3602879701896397/36028797018963968).
        **options
            As in the constructor.

        Examples
        --------
        >>> A, B, C = [[0.1]], [[[1.0]]], [[[1.0]]]
        >>> MultiChannelSystem.from_float(A, B, C, rounding="decimal").A[0, 0]
        Fraction(1, 10)
        """

        def exact(M: Any, where: str) -> Matrix:
            return matrix_from_float(M, rounding, where=where)

        return cls(
            exact(A, "A"),
            [exact(b, f"B[{i}]") for i, b in enumerate(listed_matrices(B, "B"))],
            [exact(c, f"C[{i}]") for i, c in enumerate(listed_matrices(C, "C"))],
            **options,
        )

    @property
    def plant(self) -> MultiChannelSystem:
        """The system from which this one was constructed, or this one."""
        return self if self._plant is None else self._plant

    @cached_property
    def denominator(self) -> int:
        """The least common denominator of all entries of A, B_i and C_i."""
        ports = [M.denominator for c in self.channels for M in (c.B, c.C)]
        return lcm(self.A.denominator, *set(ports))

    @cached_property
    def active(self) -> tuple[int, ...]:
        """The channels with B_i ≠ 0 and C_i ≠ 0.

        Examples
        --------
        >>> MultiChannelSystem([[0]], [[[1]], [[0]]], [[[1]], [[1]]]).active
        (0,)
        """
        ports = enumerate(self.channels)
        return tuple([i for i, c in ports if not (c.B.is_zero() or c.C.is_zero())])

    def input_matrix(self, channels: Iterable[int] | None = None) -> Matrix:
        """Return B_T = [B_i, i ∈ T], n × Σ p_i; T is all channels by default.

        The blocks are in the order of the channels, whatever the order of the argument.

        Examples
        --------
        >>> system = MultiChannelSystem([[0]], [[[1]], [[2, 3]]], [[[1]], [[1]]])
        >>> system.input_matrix().numerators, system.input_matrix([]).shape
        (((1, 2, 3),), (1, 0))
        """
        chosen = range(self.m) if channels is None else sorted(set(channels))
        return hstack([self.B(i) for i in chosen], nrows=self.n)

    def output_matrix(self, channels: Iterable[int] | None = None) -> Matrix:
        """Return C_T, Σ q_i × n, which stacks the C_i, i ∈ T, in the order of the channels.

        T is all channels by default; the dual of this is `input_matrix`.
        """
        chosen = range(self.m) if channels is None else sorted(set(channels))
        return vstack([self.C(i) for i in chosen], ncols=self.n)

    def derived(
        self,
        A: Matrix,
        B: Sequence[Matrix],
        C: Sequence[Matrix],
        construction: Construction,
        *,
        neighbors: NeighborGraph | None = None,
        names: Sequence[str] | None = None,
    ) -> MultiChannelSystem:
        """Return a system constructed from this one, which records the plant and the construction.

        Parameters
        ----------
        A : Matrix, N×N
        B, C : sequences of Matrix
            One for each channel of the result, N×r_i and s_i×N; or none, for a closed loop.
        construction : mapping
            The construction in the words of the certificate format, appended to ``subject``.
        neighbors : NeighborGraph, optional
            The neighbor graph of the result.
        names : sequence of str, optional
            The channels of the result, by default those of this system.
        """
        if names is None:
            names = self.names if B else ()
        made = object.__new__(MultiChannelSystem)
        made._fill(
            A=require_square(A, "A"),
            channels=tuple(Channel(*each) for each in zip(names, B, C, strict=True)),
            time=self.time,
            neighbors=neighbors,
            sample_time=self.sample_time,
            uncertainty=None,
            name=self.name,
            source=self.source,
            subject=(*self.subject, dict(construction)),
            _plant=self.plant,
        )
        return made

    def with_neighbors(self, graph: NeighborGraph | Mapping[str, Iterable[str]]) -> Self:
        """Return the same system with another neighbor graph, which its plant gets as well.

        Raises
        ------
        UsageError
            If the graph has other agents, or the construction of this system used another graph.
        """
        found = graph_for(graph, self.names)
        if found == self.neighbors:
            return self
        if any(c["construction"] in _GRAPH_IN_USE for c in self.subject):
            raise UsageError(
                f"the system was already made by {self.subject[-1]['construction']!r}; "
                "give the graph to the plant",
                where="graph",
            )
        other = object.__new__(type(self))
        other._fill(**{name: getattr(self, name) for name in self.__dataclass_fields__})
        plant = None if self._plant is None else self._plant.with_neighbors(graph)
        other._fill(neighbors=found, _plant=plant)
        return other

    def with_uncertainty(self, uncertainty: Radii | None) -> Self:
        """Return the same plant with other radii, or with none: then its data are certain.

        Raises
        ------
        UsageError
            If this system was made by a construction.
        InputError
            If the radii have other shapes than the matrices.
        """
        if self.subject:
            raise UsageError("radii belong to the plant, and not to a derived system")
        found = None if uncertainty is None else self._fitting(uncertainty)
        other = object.__new__(type(self))
        other._fill(**{name: getattr(self, name) for name in self.__dataclass_fields__})
        other._fill(uncertainty=found)
        return other

    def _as_canonical_text(self) -> str:
        channels = ",".join(
            f'{{"B":{canonical_matrix_text(channel.B)},"C":{canonical_matrix_text(channel.C)},'
            f'"name":{canonical(channel.name)}}}'
            for channel in self.channels
        )
        parts = [f'"A":{canonical_matrix_text(self.A)},"channels":[{channels}]']
        graph = {} if self.neighbors is None else self.neighbors.to_dict()
        parts += [f'"{key}":{canonical(graph[key])}' for key in sorted(graph)]
        parts.append(f'"time":"{self.time}"')
        if self.uncertainty is not None:
            parts.append(f'"uncertainty":{canonical(self.uncertainty.document(self.names))}')
        return "{" + ",".join(parts) + "}"

    def _own_document(self) -> dict[str, Any]:
        document = (as_plant(self) if self.subject else self).canonical_document()
        if self.sample_time is not None:
            document = {"sample_time": number_json(self.sample_time)} | document
        return document

    def __repr__(self) -> str:
        shown = ", ".join(quoted(name) for name in self.names[:8]) + (", …" if self.m > 8 else "")
        made = "".join(f", {c['construction']}" for c in self.subject)
        made += "" if self.uncertainty is None else f", {self.uncertainty.explain()}"
        text = f"n={self.n}, m={self.m}, {self.time} time, channels: {shown}{made}"
        return f"{fitting(f'MultiChannelSystem({text}', LINE - 1)})"


def require_discrete(system: MultiChannelSystem) -> None:
    """Raise an error for a system in continuous time.

    Raises
    ------
    UsageError
        If the system is in continuous time.
    """
    if not is_discrete(system.time):
        raise UsageError(
            'delays are analyzed in discrete time only; this system has "time": "continuous"'
        )


def as_plant(system: MultiChannelSystem) -> MultiChannelSystem:
    """A derived system, as if it were a plant: it forgets what it was made from.

    It keeps the matrices, the time domain, the names of the channels and the neighbor graph.  A
    certificate about it contains these matrices, and names no construction.
    """
    return MultiChannelSystem(
        system.A,
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )


def _checked_sample_time(value: Any, time: str) -> Fraction | None:
    """Check and return a sample time: a positive rational, in discrete time only."""
    if value is None:
        return None
    if not is_discrete(time):
        raise InputError("only discrete time has a sample time; remove it", where="sample_time")
    exact = as_fraction(value, where="sample_time")
    if exact <= 0:
        raise InputError(f"expected a number > 0, found {exact}", where="sample_time")
    return exact
