"""Multi-channel systems, their channels, and their display.

`MultiChannelSystem` is the subject of the whole package: ẋ = A x + Σ B_i u_i, y_i = C_i x, or
x(t+1) = …, with rational matrices and perhaps a neighbor graph and radii of entries.  It is
immutable.  A plant may have a feedthrough, y_i = C_i x + Σ D_ij u_j.  Functions that do not take
one refuse it: `InputError.require` by ``_unfit``, and `MultiChannelSystem.derived` for a
construction that says nothing of D.  A plant comes from the user; a derived system also records
its plant and the constructions that lead to it.

`ByChannel` is what it has in common with `ParametricSystem`: sizes, channels by position or name,
display, canonical JSON and its digest.  The digest identifies a plant in certificates; it does not
depend on the form in which numbers are written, nor on ``name``, ``source``, ``regulated`` and
``limits``.

`with_graph` and `with_links` combine a system with the graph of an argument: the first requires a
graph, the second takes the graph without edges if there is none.  `from_stacked` makes a system
of stacked matrices B = [B_1 … B_m] and C = [C_1; …; C_m].  What makes a system of floats states by
`read_by` how they were read.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import accumulate
from math import lcm
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    Generic,
    Literal,
    Self,
    SupportsIndex,
    TypeVar,
    overload,
)

from mcexact import shown
from mcexact.errors import (
    FloatRefused,
    InputError,
    UsageError,
    several,
    shown_value,
    warn_of_rounding,
)
from mcexact.exact.matrix import (
    BINARY,
    Matrix,
    Rounding,
    has_rounded,
    hstack,
    matrix_from_float,
    matrix_to_float,
    reading_in_words,
    to_float,
    vstack,
)
from mcexact.exact.rational import as_fraction, rational_text
from mcexact.exact.rational_functions import FunctionMatrix
from mcexact.exact.roots import is_discrete, require_time
from mcexact.model.entries import (
    Shaped,
    Table,
    as_matrix,
    as_table,
    canonical_matrix_text,
    number_json,
    require_shape,
    require_square,
)
from mcexact.model.graph import NeighborGraph, graph_for
from mcexact.model.limits import (
    InputLimits,
    limits_document,
    limits_in_words,
    read_input_limits,
)
from mcexact.model.radii import Radii
from mcexact.model.regulated import (
    Selection,
    read_selection,
    selection_document,
    selection_in_words,
)
from mcexact.model.sizes import TypicalSizes
from mcexact.model.text import (
    LONGEST_TEXT,
    canonical,
    checked_names,
    checked_text,
    nearest,
    numbers_of_any_length,
    quoted,
    sha256,
)
from mcexact.shown import LINE, Shown, fitting, latex, table, words

if TYPE_CHECKING:
    import numpy.typing as npt

# The matrices B_i or C_i of all channels, by position or by name.

AnyMatrix = TypeVar("AnyMatrix", bound=Shaped)


def position(name: str, names: Sequence[str]) -> int:
    """Return the position of a channel.

    Raises
    ------
    UsageError
        If no channel has this name.
    """
    if not isinstance(name, str) or name not in names:
        raise UsageError(
            f"there is no channel {shown_value(name)}{nearest(str(name), names)}; "
            f"the channels are {', '.join(map(quoted, names))}"
        )
    return names.index(name)


class ChannelMatrices(tuple[AnyMatrix, ...]):
    """One matrix for each channel: ``B[0]``, ``B["pump"]`` and ``B(0)`` are the same.

    Parameters
    ----------
    matrices : iterable of matrices
    names : tuple of str
        The channels, in order.

    Examples
    --------
    >>> from mcexact.exact.matrix import Matrix
    >>> B = ChannelMatrices([Matrix.identity(1), Matrix.zeros(1, 2)], ("pump", "valve"))
    >>> B["valve"].shape, B[1] == B(1), len(B)
    ((1, 2), True, 2)
    """

    names: tuple[str, ...]

    def __new__(
        cls, matrices: Iterable[AnyMatrix], names: tuple[str, ...]
    ) -> ChannelMatrices[AnyMatrix]:
        self = super().__new__(cls, matrices)
        self.names = names
        return self

    def __getnewargs__(self) -> tuple[Any, ...]:
        return tuple(self), self.names

    @overload
    def __getitem__(self, channel: SupportsIndex | str) -> AnyMatrix: ...

    @overload
    def __getitem__(self, channel: slice) -> tuple[AnyMatrix, ...]: ...

    def __getitem__(self, channel: Any) -> Any:
        """Return the matrix of a channel, by the position of the channel, from 0, or its name."""
        if isinstance(channel, str):
            channel = position(channel, self.names)
        return super().__getitem__(channel)

    def __call__(self, channel: int | str) -> AnyMatrix:
        """Return the matrix of a channel."""
        return super().__getitem__(channel) if type(channel) is int else self[channel]

    def __repr__(self) -> str:
        whole = super().__repr__()
        if len(whole) <= shown.LINE:
            return whole
        sizes = ", ".join(f"{each.shape[0]} × {each.shape[1]}" for each in self[:8])
        return f"<matrices of {len(self)} channels: {sizes}{', …' if len(self) > 8 else ''}>"

    def _repr_html_(self) -> str:
        return shown.framed(shown.grid(["channel", ""], zip(self.names, self, strict=True)))


# What systems of numbers and systems with parameters have in common.

M = TypeVar("M", Matrix, FunctionMatrix)

FORMAT = "mcexact-system/1"
_MOST_CHANNELS = 12


@dataclass(frozen=True, repr=False)
class Channel(Shown, Generic[M]):
    """One channel: the agent's name, B_i (n×p_i) and C_i (q_i×n)."""

    name: str
    B: M
    C: M

    def __repr__(self) -> str:
        return fitting(f"Channel({quoted(self.name)}, B={self.B!r}, C={self.C!r})")

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the name and the matrices."""
        yield from vars(self).items()


class ByChannel(Shown, Generic[M]):
    """The sizes, the channels and the display of a system with a matrix A and channels."""

    A: M
    channels: tuple[Channel[M], ...]

    @property
    def n(self) -> int:
        """The number of states."""
        return self.A.nrows

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.channels)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the channels, in order."""
        return tuple(channel.name for channel in self.channels)

    @cached_property
    def sizes(self) -> tuple[tuple[int, int], ...]:
        """The numbers (p_i, q_i) of inputs and outputs of each channel."""
        return tuple([(channel.B.ncols, channel.C.nrows) for channel in self.channels])

    @cached_property
    def B(self) -> ChannelMatrices[M]:
        """The B_i, n×p_i: ``B[0]`` or ``B["1"]`` is that of the first channel."""
        return ChannelMatrices((channel.B for channel in self.channels), self.names)

    @cached_property
    def C(self) -> ChannelMatrices[M]:
        """The C_i, q_i×n: ``C[0]`` or ``C["1"]`` is that of the first channel."""
        return ChannelMatrices((channel.C for channel in self.channels), self.names)

    def p(self, i: int) -> int:
        """Return p_i, the number of inputs of channel i."""
        return self.channels[i].B.ncols

    def q(self, i: int) -> int:
        """Return q_i, the number of outputs of channel i."""
        return self.channels[i].C.nrows

    def index(self, name: str) -> int:
        """Return the position of a channel.

        Raises
        ------
        UsageError
            If no channel has this name.
        """
        return position(name, self.names)

    def indices(self, names: Iterable[str]) -> tuple[int, ...]:
        """Return the positions of some channels, in the order of the system.

        Raises
        ------
        UsageError
            If no channel has one of the names.
        InputError
            If a single name is given instead of a list.
        """
        return tuple(sorted({self.index(name) for name in several(names, "channels")}))

    def named(self, channels: Iterable[int]) -> tuple[str, ...]:
        """Return the names of some channels, in the order of the system.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem
        >>> ones = [[[1]], [[1]]]
        >>> system = MultiChannelSystem([[0]], ones, ones, names=["left", "right"])
        >>> system.named([1, 0])
        ('left', 'right')
        """
        return tuple(self.channels[i].name for i in sorted(set(channels)))

    def explain(self: Any) -> str:
        """Say in plain words what the system is: sizes, equations, channels and links."""
        return "\n".join(_sentences(self))

    def _labeled(self: Any) -> Iterator[tuple[str, Any]]:
        """Yield the matrices, and the other attributes that are set."""
        if self.subject:
            yield "made by", ", ".join(each["construction"] for each in self.subject)
        yield "A", self.A
        for channel in self.channels[:_MOST_CHANNELS]:
            yield f"B of {channel.name}", channel.B
            yield f"C of {channel.name}", channel.C
        if self.D is not None:
            yield "D", self.D
        if self.m > _MOST_CHANNELS:
            yield "more channels", str(self.m - _MOST_CHANNELS)
        if self.parameters:
            yield "parameters", ", ".join(self.parameters_in_words)
        if self.neighbors is not None:
            yield "neighbors", self.neighbors
        if self.sample_time is not None:
            yield "sample time", rational_text(self.sample_time)
        if self.uncertainty is not None:
            yield "uncertainty", self.uncertainty
        if self.regulated is not None:
            yield "regulated", selection_in_words(self.regulated, self.names)
        if self.limits is not None:
            yield "limits of inputs", limits_in_words(self.limits, self.names)
        if self.typical_sizes is not None:
            yield "typical sizes", self.typical_sizes
        if self.source is not None:
            yield "source", self.source

    def _direct(self: Any) -> Iterator[str]:
        """Yield the terms D_ij u_j of each output in LaTeX."""
        for i in range(self.m):
            blocks = [self.feedthrough(i, j) for j in range(self.m)] if self.D is not None else []
            yield "".join(
                rf" + {latex(block)} u_{{{words(name)}}}"
                for name, block in zip(self.names, blocks, strict=False)
                if not block.is_zero()
            )

    def _html(self: Any) -> str:
        """Return the sizes and the matrices in HTML."""
        return table(_heading(self), self._labeled())

    def _latex(self: Any) -> str:
        """Return the equations of the system with its matrices in LaTeX."""
        change = r"x(t+1)" if is_discrete(self.time) else r"\dot{x}"
        inputs = "".join(
            rf" + {latex(channel.B)} u_{{{words(channel.name)}}}"
            for channel in self.channels[:_MOST_CHANNELS]
        )
        lines = [rf"{change} &= {latex(self.A)} x{inputs}"]
        lines += [
            rf"y_{{{words(channel.name)}}} &= {latex(channel.C)} x" + direct
            for channel, direct in zip(self.channels, self._direct(), strict=True)
        ][:_MOST_CHANNELS]
        more = r" \\ &\;\;\vdots" if self.m > _MOST_CHANNELS else ""
        equations = r" \\ ".join(lines) + more
        return rf"\begin{{aligned}} {equations} \end{{aligned}}"

    def canonical_text(self: Any) -> str:
        """Return the plant of the system as the text of the ``system`` object of a certificate.

        Notes
        -----
        Keys are sorted; matrices are rows of reduced rationals, or list their entries if they are
        large and sparse; name and source are left out.  Systems are immutable, so the text is made
        once and shared by all certificates.
        """
        plant = self.plant
        known: str | None = plant.__dict__.get("_canonical_text")
        if known is None:
            known = plant._as_canonical_text()
            object.__setattr__(plant, "_canonical_text", known)
        return known

    def canonical_document(self) -> dict[str, Any]:
        """Return the plant as the ``system`` object of a certificate, as plain data."""
        with numbers_of_any_length():
            document: dict[str, Any] = json.loads(self.canonical_text())
        return document

    def digest(self: Any) -> str:
        """Return the SHA-256 of the plant's canonical JSON, in lower-case hexadecimal.

        Examples
        --------
        Names, order, graph and every number change the digest.  The form in which a number is
        written, ``name`` and ``source`` do not:

        >>> from mcexact import MultiChannelSystem
        >>> first = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], name="a")
        >>> second = MultiChannelSystem([["0.50"]], [[[1]]], [[[1]]], source="b")
        >>> first.digest() == second.digest()
        True
        """
        plant = self.plant
        known: str | None = plant.__dict__.get("_digest")
        if known is None:
            known = sha256(plant.canonical_text())
            object.__setattr__(plant, "_digest", known)
        return known

    @property
    def at_samples(self: Any) -> Any:
        """The plant, as agents meet it: a sampled one only at the samples."""
        return self.plant

    def digest_of_values(self: Any) -> str:
        """Return the digest of the plant without radii, by which a controller names its plant.

        A controller of a sampled plant runs at its samples: it names the sampled plant, so that
        the digest contains the step and the delay.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem
        >>> from mcexact.boxes import Box
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
        >>> Box.relative(plant, "1/100").system.digest_of_values() == plant.digest()
        True
        """
        plant = self.at_samples
        plant = as_plant(plant) if plant.subject else plant
        digest: str = (
            plant if plant.uncertainty is None else plant.with_uncertainty(None)
        ).digest()
        return digest

    def to_dict(self: Any) -> dict[str, Any]:
        """Return the system as plain data, with quotients as strings; `read_system` reads it.

        A derived system is written with its own matrices, as a plant.
        """
        document: dict[str, Any] = {"format": FORMAT}
        for key, value in (("name", self.name), ("source", self.source)):
            if value is not None:
                document[key] = value
        document |= self._own_document()
        return document


def _heading(system: Any) -> str:
    name = f"{system.name}: " if system.name else ""
    return f"{name}{_count(system.n, 'state')}, {_count(system.m, 'channel')}, {system.time} time"


def _count(size: int, noun: str) -> str:
    return f"{size} {noun}{'' if size == 1 else 's'}"


def _sentences(system: Any) -> Iterator[str]:
    yield f"{_heading(system)}."
    if system.subject:
        constructions = ", ".join(each["construction"] for each in system.subject)
        yield f"It was made from a plant by: {constructions}."
    left = "x(t+1)" if is_discrete(system.time) else "x'"
    direct = "" if system.D is None else " + the sum of D_ij u_j"
    yield (
        f"{left} = A x + the sum of B_i u_i, y_i = C_i x{direct}; agent i measures y_i and sets "
        "u_i."
    )
    for i, name in enumerate(system.names[:_MOST_CHANNELS]):
        sizes = f"{_count(system.p(i), 'input')} and {_count(system.q(i), 'output')}"
        yield fitting(f"Channel {name} has {sizes}.")
    if system.m > _MOST_CHANNELS:
        yield f"There are {system.m - _MOST_CHANNELS} more channels."
    if system.parameters:
        yield f"Its entries are functions of {', '.join(system.parameters_in_words)}."
    if system.neighbors is not None:
        yield system.neighbors.explain()
    if system.uncertainty is not None:
        yield f"Of the data, {system.uncertainty.explain()}."
    if system.regulated is not None:
        held = selection_in_words(system.regulated, system.names)
        yield fitting(f"A controller is to hold at set-points: {held}.")
    if system.limits is not None:
        yield fitting(f"Inputs have limits: {limits_in_words(system.limits, system.names)}.")
    if system.typical_sizes is not None:
        yield f"For costs, {system.typical_sizes.explain()}."
    if system.rounding is not None:
        yield f"{reading_in_words(system.rounding).capitalize()}."


def listed_matrices(value: Any, where: str) -> list[Any]:
    """Return the matrices of all channels as a list.

    Raises
    ------
    InputError
        If it is one matrix, or no list.
    """
    if _is_one_matrix(value):
        raise InputError(
            "expected a list of matrices, one for each channel, found one matrix: write "
            f"[{where}] for one channel, or from_stacked(A, B, C, sizes) for several",
            where=where,
        )
    one = isinstance(value, (str, bytes, Mapping))
    if one or not hasattr(value, "__iter__"):
        raise InputError(
            f"expected a list of matrices, one for each channel, found {type(value).__name__}",
            where=where,
        )
    return list(value)


def _is_one_matrix(value: Any) -> bool:
    """Whether a value is a matrix, and no list of matrices: its rows hold numbers."""
    if isinstance(value, (Matrix, FunctionMatrix)) or getattr(value, "ndim", 0) == 2:
        return True
    row = value[0] if isinstance(value, (list, tuple)) and value else None
    return isinstance(row, (list, tuple)) and any(
        isinstance(entry, str) or not hasattr(entry, "__iter__") for entry in row
    )


def channels_of(
    n: int,
    B: Sequence[Any],
    C: Sequence[Any],
    names: Sequence[str] | None,
    table: Callable[[Any, str, int | None], Table[M]],
) -> tuple[Channel[M], ...]:
    """Make the channels of matrices, whose shapes are compared before their entries are read.

    Parameters
    ----------
    n : int
    B, C : sequences of matrix-like values
    names : sequence of str, optional
        By default "1", "2", ….
    table : callable
        Makes a `Table` of a value, its place, and the number of columns that it has without rows.

    Raises
    ------
    InputError
        If there are no channels, or a number, a name or a shape is not as expected.
    """
    B, C = listed_matrices(B, "B"), listed_matrices(C, "C")
    m = len(B)
    if m != len(C):
        raise InputError(f"expected as many matrices as in B, {m}, found {len(C)}", where="C")
    if not m:
        raise InputError("expected at least one channel, found none", where="B")
    labels = [str(i + 1) for i in range(m)] if names is None else several(names, "names")
    if len(labels) != m:
        raise InputError(f"expected {m} names, found {len(labels)}", where="names")
    checked = checked_names(labels, [f"names[{i}]" for i in range(m)])
    tables = [
        (
            require_shape(table(B[i], f"B[{i}]", None), f"B[{i}]", n, None),
            require_shape(table(C[i], f"C[{i}]", n), f"C[{i}]", None, n),
        )
        for i in range(m)
    ]
    return tuple(
        Channel(name, B_i.matrix(), C_i.matrix())
        for name, (B_i, C_i) in zip(checked, tables, strict=True)
    )


# Multi-channel systems.

Construction = Mapping[str, Any]
# These constructions depend on the neighbor graph of the plant, or lead to systems without one.
_GRAPH_IN_USE = frozenset(
    {
        "augmented_outputs",
        "arcs",
        "dual",
        "error",
        "extended",
        "failed",
        "held",
        "lifted",
        "merged",
        "restricted",
        "slow",
    }
)


@dataclass(frozen=True, init=False, repr=False)
class MultiChannelSystem(ByChannel[Matrix]):
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
    neighbors : NeighborGraph, networkx.DiGraph or mapping of names, optional
        The directed graph of who receives whose messages, with its delays.
    D : matrix, Σ q_i × Σ p_i, optional
        The feedthrough: y_i = C_i x + Σ D_ij u_j, with a row for each output and a column for each
        input of all channels, in order.  None, or zeros, for a plant without one.  What takes no
        feedthrough refuses the plant; `input_filters` makes a system without feedthrough of it,
        which has the same fixed modes.
    sample_time : rational, optional
        The sample time in discrete time, which no decision uses.
    uncertainty : Radii, optional
        How far each entry may be from its value; `Box` makes them.  Without a radius above 0 there
        are none.  Decisions are about the values unless they say that they are about every plant in
        the box.
    regulated : mapping, optional
        What a controller is to hold at set-points, for each agent that holds something: positions
        of its outputs from 1 on, or a matrix S_i of q_i columns.  No decision uses it, nor does the
        digest depend on it; `design_setpoint` takes it where nothing else is asked for.
    limits : mapping, optional
        Between which values inputs have to be, for each agent whose inputs have limits, by name or
        by position from 0 on: a list with the least and the largest value for each of its inputs,
        or None for an input without limits.  They contain 0.  No decision uses them but those about
        inputs that are cut off (`saturation_stability`), nor does the digest depend on them.
    typical_sizes : TypicalSizes, optional
        How large signals typically are, for the weights of costs; no other decision uses them, and
        the digest does not depend on them.
    name, source : str, optional
        A name and a source, which no decision uses.

    Attributes
    ----------
    A : Matrix, n×n
    B, C : ChannelMatrices
        B_i and C_i by position or name: ``B[0]``, ``B["1"]``; ``channels[0].B`` is the same.
    D : Matrix or None
        The feedthrough, if it is not zero; `feedthrough` returns its blocks.
    plant : MultiChannelSystem
        The system from which this one was constructed, or this one.
    subject : tuple of mappings
        The constructions that lead from the plant to this system, in order, in the words of the
        certificate format; empty for a plant.
    rounding : {"decimal", "dyadic", "simplest"} or None
        How the floats were read of which the plant was made, if some are no integers.

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
    """Advice in an error for a caller who passes something else."""
    parameters: ClassVar[tuple[str, ...]] = ()
    """`ParametricSystem` has some."""

    A: Matrix
    channels: tuple[Channel[Matrix], ...]
    time: str
    neighbors: NeighborGraph | None
    sample_time: Fraction | None
    uncertainty: Radii | None
    typical_sizes: TypicalSizes | None
    D: Matrix | None
    name: str | None = field(compare=False)
    source: str | None = field(compare=False)
    regulated: Selection | None = field(compare=False)
    limits: InputLimits | None = field(compare=False)
    subject: tuple[Construction, ...] = field(hash=False)
    rounding: Rounding | None = field(compare=False)
    _plant: MultiChannelSystem | None
    _sampled: MultiChannelSystem | None = field(compare=False)
    """The sampled plant from which a system was derived by further constructions."""

    def __init__(
        self,
        A: Any,
        B: Sequence[Any],
        C: Sequence[Any],
        *,
        D: Any = None,
        time: str = "continuous",
        names: Sequence[str] | None = None,
        neighbors: Any = None,
        sample_time: Any = None,
        uncertainty: Radii | None = None,
        regulated: Mapping[str, Any] | None = None,
        limits: Mapping[Any, Any] | None = None,
        typical_sizes: TypicalSizes | None = None,
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
            typical_sizes=None,
            D=_read_feedthrough(D, channels),
            name=None if name is None else checked_text(name, "name"),
            source=None if source is None else checked_text(source, "source"),
            regulated=None,
            limits=None,
            subject=(),
            rounding=None,
            _plant=None,
            _sampled=None,
        )
        if regulated is not None:
            counts = [channel.C.nrows for channel in channels]
            self._fill(regulated=read_selection(regulated, labels, counts, "regulated"))
        if limits is not None:
            widths = [channel.B.ncols for channel in channels]
            self._fill(limits=read_input_limits(limits, labels, widths))
        if uncertainty is not None:
            self._fill(uncertainty=self._fitting(uncertainty))
        if typical_sizes is not None:
            self._fill(typical_sizes=self._with_shapes(typical_sizes))

    def _with_shapes(self, sizes: TypicalSizes) -> TypicalSizes:
        """Return sizes of which there is one for each state, input and output."""
        InputError.require(sizes, TypicalSizes, "sizes")
        p, q = ([size(i) for i in range(self.m)] for size in (self.p, self.q))
        with InputError.inside("sizes"):
            sizes.require_shapes(self.n, p, q)
        return sizes

    def _fitting(self, uncertainty: Radii) -> Radii | None:
        """Return radii that have the shapes of the matrices; None if all entries are certain."""
        InputError.require(uncertainty, Radii, "uncertainty")
        with InputError.inside("uncertainty"):
            uncertainty.require_shapes(self.A, self.B, self.C)
        if uncertainty.is_zero():
            return None
        if self.D is not None:
            raise InputError(f"radii: {self._unfit}", where="uncertainty")
        return uncertainty

    @property
    def nstates(self) -> int:
        """The number of states, n, by the name that python-control uses."""
        return self.n

    @property
    def ninputs(self) -> int:
        """The number of inputs of all channels."""
        return sum(self.p(i) for i in range(self.m))

    @property
    def noutputs(self) -> int:
        """The number of outputs of all channels."""
        return sum(self.q(i) for i in range(self.m))

    @property
    def dt(self) -> float | bool:
        """The sample time as in python-control: 0 in continuous time, True if it is not known."""
        if not is_discrete(self.time):
            return 0
        return True if self.sample_time is None else to_float(self.sample_time)

    def poles(self) -> npt.NDArray[Any]:
        """Compute the eigenvalues of A in floating point.

        Returns
        -------
        array of complex, n
            For exact enclosures use `mcexact.questions.open_loop_spectrum`.

        Examples
        --------
        >>> MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]]).poles()
        array([-1.+0.j, -2.+0.j])
        """
        import numpy as np

        return np.linalg.eigvals(matrix_to_float(self.A)).astype(complex)

    def _fill(self, **fields: Any) -> None:
        for key, value in fields.items():
            object.__setattr__(self, key, value)

    @classmethod
    def from_float(
        cls,
        A: Any,
        B: Sequence[Any],
        C: Sequence[Any],
        *,
        rounding: Rounding = BINARY,
        **options: Any,
    ) -> MultiChannelSystem:
        """Build an exact system from matrices of floats.

        Parameters
        ----------
        A, B, C : matrices of floats
            Shapes as in the constructor.
        rounding : {"decimal", "dyadic", "simplest"}
            How a float becomes exact: "decimal" takes the shortest decimal that prints it (0.1
            becomes 1/10), and "dyadic" its exact binary value (0.1 becomes
            3602879701896397/36028797018963968).  "simplest", the default, takes a short fraction or
            decimal within 4 units in the last place, if there is one, or else the shortest decimal:
            what was computed from numbers with few digits becomes what it was before rounding.
        **options
            As in the constructor.

        Returns
        -------
        MultiChannelSystem
            Its ``rounding`` and its ``source`` say how the floats were read, if some are no
            integers.

        Raises
        ------
        InputError
            If an entry is not a finite real number, or as in the constructor.

        Notes
        -----
        What was rounded cannot be known.  "simplest" recovers quotients, sums and inverses of
        numbers with few digits in most cases, and leaves irrational numbers as they print;
        `mcexact.exact.matrix.from_float` has the rule, and ``benchmarks/ROUNDING.md`` the counts.

        Examples
        --------
        >>> A, B, C = [[0.1 + 0.2]], [[[1 / 3]]], [[[1.0]]]
        >>> plant = MultiChannelSystem.from_float(A, B, C)
        >>> plant.A[0, 0], plant.B(0)[0, 0]
        (Fraction(3, 10), Fraction(1, 3))
        >>> MultiChannelSystem.from_float(A, B, C, rounding="decimal").A[0, 0]
        Fraction(7500000000000001, 25000000000000000)
        """

        def exact(M: Any, where: str) -> Matrix:
            return matrix_from_float(M, rounding, where=where)

        inputs, outputs = listed_matrices(B, "B"), listed_matrices(C, "C")
        direct = options.pop("D", None)
        made = cls(
            exact(A, "A"),
            [exact(b, f"B[{i}]") for i, b in enumerate(inputs)],
            [exact(c, f"C[{i}]") for i, c in enumerate(outputs)],
            D=None if direct is None else exact(direct, "D"),
            **options,
        )
        tables = (A, *inputs, *outputs, *([] if direct is None else [direct]))
        return warn_of_rounding(read_by(rounding, made, tables))

    @property
    def plant(self) -> MultiChannelSystem:
        """The system from which this one was constructed, or this one."""
        return self if self._plant is None else self._plant

    @cached_property
    def denominator(self) -> int:
        """The least common denominator of all entries of A, B_i and C_i."""
        ports = [M.denominator for c in self.channels for M in (c.B, c.C)]
        return lcm(self.A.denominator, *set(ports))

    @property
    def _unfit(self) -> str:
        """Why a function that takes no feedthrough refuses the system; empty if it has none."""
        if self.D is None:
            return ""
        return (
            "expected a system without feedthrough, found D that is not zero; "
            "input_filters(system) makes one with the same fixed modes"
        )

    def feedthrough(self, i: int, j: int) -> Matrix:
        """Return D_ij, q_i×p_j: what the inputs of channel j add at once to the outputs of i.

        Examples
        --------
        >>> system = MultiChannelSystem([[0]], [[[1]], [[1]]], [[[1]], [[1]]], D=[[0, 2], [0, 0]])
        >>> system.feedthrough(0, 1).numerators, system.feedthrough(1, 0).is_zero()
        (((2,),), True)
        """
        rows, columns = self._rows_and_columns
        if self.D is None:
            return Matrix.zeros(len(rows[i]), len(columns[j]))
        return self.D.take(rows=rows[i], cols=columns[j])

    def feedthrough_matrix(
        self, outputs: Iterable[int] | None = None, inputs: Iterable[int] | None = None
    ) -> Matrix:
        """Return D_{s,T}, the rows of the outputs of s and the columns of the inputs of T.

        The blocks are in the order in which channels are given, each by default all of them.
        """
        rows, columns = self._rows_and_columns
        s = [k for i in (range(self.m) if outputs is None else outputs) for k in rows[i]]
        T = [k for j in (range(self.m) if inputs is None else inputs) for k in columns[j]]
        if self.D is None:
            return Matrix.zeros(len(s), len(T))
        return self.D.take(rows=s, cols=T)

    @cached_property
    def _rows_and_columns(self) -> tuple[list[range], list[range]]:
        """The rows and the columns of D that belong to each channel."""
        ends = [accumulate(sizes) for sizes in zip(*self.sizes, strict=True)]
        columns, rows = (
            [range(end - size, end) for end, size in zip(each, sizes, strict=True)]
            for each, sizes in zip(ends, zip(*self.sizes, strict=True), strict=True)
        )
        return rows, columns

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
        D: Matrix | Literal["not carried"] | None = "not carried",
        neighbors: NeighborGraph | None = None,
        names: Sequence[str] | None = None,
        **others: Any,
    ) -> MultiChannelSystem:
        """Return a system constructed from this one, which records the plant and the construction.

        Parameters
        ----------
        A : Matrix, N×N
        B, C : sequences of Matrix
            One for each channel of the result, N×r_i and s_i×N; or none, for a closed loop.
        construction : mapping
            The construction in the words of the certificate format, appended to ``subject``.
        D : Matrix or None
            The feedthrough of the result.  A construction that says nothing of it refuses systems
            with feedthrough.
        neighbors : NeighborGraph, optional
            The neighbor graph of the result.
        names : sequence of str, optional
            The channels of the result, by default those of this system.
        **others
            Other fields in which the result differs from this system, such as its ``time``.
        """
        if D == "not carried":
            if self.D is not None:
                name = construction["construction"]
                raise InputError(f"the construction {name!r}: {self._unfit}", where="system")
            D = None
        if names is None:
            names = self.names if B else ()
        system = object.__new__(MultiChannelSystem)
        system._fill(
            A=require_square(A, "A"),
            channels=tuple(Channel(*each) for each in zip(names, B, C, strict=True)),
            time=self.time,
            neighbors=neighbors,
            sample_time=self.sample_time,
            uncertainty=None,
            typical_sizes=None,
            D=None if D is None or D.is_zero() else D,
            name=self.name,
            source=self.source,
            regulated=None,
            limits=None,
            subject=(*self.subject, dict(construction)),
            rounding=self.rounding,
            _plant=self.plant,
            _sampled=self if self._is_sampled else self._sampled,
        )
        system._fill(**others)
        return system

    @property
    def _is_sampled(self) -> bool:
        """Whether sampling alone made the system from its plant."""
        return [each["construction"] for each in self.subject] == ["sampled"]

    @property
    def at_samples(self) -> MultiChannelSystem:
        """The plant, or where it was sampled before all other constructions the sampled plant."""
        if self._is_sampled:
            return self
        return self._sampled or self.plant

    def with_neighbors(self, graph: Any) -> Self:
        """Return the same system with another neighbor graph, which its plant gets as well.

        Parameters
        ----------
        graph : NeighborGraph, networkx.DiGraph, or mapping of str to iterable of str

        Raises
        ------
        UsageError
            If the graph has other agents, or the construction of this system used another graph.
        """
        neighbors = graph_for(graph, self.names)
        if neighbors == self.neighbors:
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
        other._fill(neighbors=neighbors, _plant=plant)
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
        radii = None if uncertainty is None else self._fitting(uncertainty)
        other = object.__new__(type(self))
        other._fill(**{name: getattr(self, name) for name in self.__dataclass_fields__})
        other._fill(uncertainty=radii)
        return other

    def with_typical_sizes(self, sizes: TypicalSizes | None) -> Self:
        """Return the same plant with other typical sizes of its signals, or with none.

        Raises
        ------
        UsageError
            If this system was made by a construction.
        InputError
            If there is not one size for each state, input and output.
        """
        if self.subject:
            raise UsageError("sizes belong to the plant, and not to a derived system")
        other = object.__new__(type(self))
        other._fill(**{name: getattr(self, name) for name in self.__dataclass_fields__})
        other._fill(typical_sizes=None if sizes is None else self._with_shapes(sizes))
        return other

    def with_limits(self, limits: Mapping[Any, Any] | None) -> Self:
        """Return the same plant with other limits of its inputs, or with none.

        Parameters
        ----------
        limits : mapping or None
            As for the constructor.

        Raises
        ------
        UsageError
            If this system was made by a construction.
        InputError
            If limits do not fit the inputs, or do not contain 0.
        """
        if self.subject:
            raise UsageError("limits belong to the plant, and not to a derived system")
        other = object.__new__(type(self))
        other._fill(**{name: getattr(self, name) for name in self.__dataclass_fields__})
        widths = [self.p(i) for i in range(self.m)]
        own = None if limits is None else read_input_limits(limits, self.names, widths)
        other._fill(limits=own)
        return other

    def _as_canonical_text(self) -> str:
        channels = ",".join(
            f'{{"B":{canonical_matrix_text(channel.B)},"C":{canonical_matrix_text(channel.C)},'
            f'"name":{canonical(channel.name)}}}'
            for channel in self.channels
        )
        direct = "" if self.D is None else f'"D":{canonical_matrix_text(self.D)},'
        parts = [f'"A":{canonical_matrix_text(self.A)},{direct}"channels":[{channels}]']
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
        if self.regulated is not None:
            document["regulated"] = selection_document(self.regulated, self.names)
        if self.limits is not None:
            document["limits"] = limits_document(self.limits, self.names)
        if self.typical_sizes is not None:
            document["sizes"] = self.typical_sizes.document(self.names)
        return document

    def __repr__(self) -> str:
        shown = ", ".join(quoted(name) for name in self.names[:8]) + (", …" if self.m > 8 else "")
        extras = "" if self.D is None else ", with feedthrough"
        extras += "".join(f", {c['construction']}" for c in self.subject)
        extras += "" if self.uncertainty is None else f", {self.uncertainty.explain()}"
        text = f"n={self.n}, m={self.m}, {self.time} time, channels: {shown}{extras}"
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
    """Return a derived system as a plant, without the record of its constructions.

    It keeps the matrices, the time domain, the names of the channels and the neighbor graph.  A
    certificate about it contains these matrices, and names no construction.
    """
    return MultiChannelSystem(
        system.A,
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        D=system.D,
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )


def any_system(value: object, where: str = "system") -> MultiChannelSystem:
    """Return a system, with feedthrough or without.

    Raises
    ------
    InputError
        If it is something else.
    """
    if not isinstance(value, MultiChannelSystem):
        InputError.require(value, MultiChannelSystem, where)
    system: MultiChannelSystem = value  # type: ignore[assignment]
    return system


def _read_feedthrough(value: Any, channels: Sequence[Channel[Matrix]]) -> Matrix | None:
    """Read D, with a row for each output and a column for each input; None if it is zero."""
    if value is None:
        return None
    q, p = sum(each.C.nrows for each in channels), sum(each.B.ncols for each in channels)
    D = require_shape(as_matrix(value, "D", ncols=p), "D", q, p)
    return None if D.is_zero() else D


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


def read_by(
    rounding: Rounding, system: MultiChannelSystem, tables: Iterable[Any]
) -> MultiChannelSystem:
    """Return a plant that says how the floats were read of which it was made.

    Parameters
    ----------
    rounding : {"decimal", "dyadic", "simplest"}
    system : MultiChannelSystem
    tables : iterable of matrix-like values
        What the plant was made of.  If all floats among them are integers up to 2**53, which
        every rounding reads alike, nothing is said.
    """
    if not any(map(has_rounded, tables)):
        return system
    reading = reading_in_words(rounding)
    source = reading if system.source is None else f"{system.source}; {reading}"
    other = object.__new__(type(system))
    other._fill(**{name: getattr(system, name) for name in system.__dataclass_fields__})
    # A source that is too long for a file stays as it is.
    other._fill(rounding=rounding, source=source if len(source) <= LONGEST_TEXT else system.source)
    return other


# The neighbor graph over which the agents of a system communicate.


def with_graph(
    system: MultiChannelSystem, graph: NeighborGraph | Mapping[str, Iterable[str]] | None = None
) -> tuple[MultiChannelSystem, NeighborGraph]:
    """Return a system with a neighbor graph, and the graph.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph or mapping of names, optional
        Overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If neither the system nor the argument gives a neighbor graph.
    """
    if graph is not None:
        system = system.with_neighbors(graph)
    if system.neighbors is None:
        raise UsageError(
            "a neighbor graph is needed, and the system has none: add 'neighbors' to it"
        )
    return system, system.neighbors


def with_links(
    system: MultiChannelSystem, graph: NeighborGraph | Mapping[str, Iterable[str]] | None = None
) -> tuple[MultiChannelSystem, NeighborGraph]:
    """Return a system, and the graph over which its controllers communicate.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph or mapping of names, optional
        Overrides ``system.neighbors``.  Without either, the controller graph has no edges; the
        system itself stays without a graph, so that certificates about the closed loop are about
        the user's plant.
    """
    if graph is None and system.neighbors is None:
        return system, NeighborGraph.empty(system.names)
    return with_graph(system, graph)


# Systems from stacked matrices B = [B_1 … B_m] and C = [C_1; …; C_m] and the channels' sizes.


def from_stacked(
    A: Any,
    B: Any,
    C: Any,
    *,
    D: Any = None,
    inputs: Iterable[int],
    outputs: Iterable[int],
    rounding: Rounding | None = None,
    **options: Any,
) -> MultiChannelSystem:
    """Make a system from stacked matrices, whose columns and rows the channels take in order.

    Parameters
    ----------
    A : matrix, n×n
    B : matrix, n × Σ p_i
        [B_1 … B_m].
    C : matrix, Σ q_i × n
        The C_i, one below the other.
    D : matrix, Σ q_i × Σ p_i, optional
        The feedthrough.
    inputs, outputs : iterables of m integers
        p_1 … p_m and q_1 … q_m, the numbers of inputs and outputs of the channels.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats become exact numbers, as in `MultiChannelSystem.from_float`, whose default it
        is for matrices with floats.  Without floats, texts such as "1/3" are read as typed.
    **options
        As in `MultiChannelSystem`.

    Raises
    ------
    InputError
        If the sizes do not add up to the shapes, or a matrix is not as expected.

    Examples
    --------
    >>> A, B, C = [[0, 1], [0, 0]], [[1, 0, 0], [0, 1, 2]], [[1, 0], [0, 1]]
    >>> plant = from_stacked(A, B, C, inputs=[1, 2], outputs=[1, 1])
    >>> plant.B(1).numerators
    ((0, 0), (1, 2))
    >>> from_stacked([[0]], [[1, 1]], [[1]], inputs=[1], outputs=[1])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: inputs: expected sizes that add up to the 2 columns of B, found 1
    """

    def exact(value: Any, where: str) -> Matrix:
        if rounding is None or isinstance(value, Matrix):
            with contextlib.suppress(FloatRefused):
                return as_matrix(value, where)
        return matrix_from_float(value, rounding or BINARY, where=where)

    state = exact(A, "A")
    stacked_B = require_shape(exact(B, "B"), "B", state.nrows, None)
    stacked_C = require_shape(exact(C, "C"), "C", None, state.nrows)
    direct = None if D is None else exact(D, "D")
    made = MultiChannelSystem(
        state, *split_by_sizes(stacked_B, stacked_C, inputs, outputs), D=direct, **options
    )
    tables = (A, B, C) if D is None else (A, B, C, D)
    return warn_of_rounding(read_by(rounding or BINARY, made, tables))


def split_by_sizes(
    B: Matrix, C: Matrix, inputs: Iterable[int], outputs: Iterable[int]
) -> tuple[list[Matrix], list[Matrix]]:
    """Split stacked matrices into B_1 … B_m and C_1 … C_m.

    Raises
    ------
    InputError
        If the sizes do not add up to the columns of B and the rows of C.
    """
    columns = _parts(inputs, B.ncols, "inputs", "columns of B")
    rows = _parts(outputs, C.nrows, "outputs", "rows of C")
    if len(columns) != len(rows):
        raise InputError(
            f"expected a number of outputs for each of the {len(columns)} channels, "
            f"found {len(rows)}",
            where="outputs",
        )
    return [B.take(cols=part) for part in columns], [C.take(rows=part) for part in rows]


def _parts(sizes: Iterable[int], count: int, where: str, what: str) -> list[Sequence[int]]:
    """Split the positions below a count into consecutive parts of these sizes."""
    known = []
    for k, size in enumerate(several(sizes, where, "integers")):
        if isinstance(size, bool) or not hasattr(size, "__index__") or size < 0:
            raise InputError(f"expected an integer >= 0, found {size!r}", where=f"{where}[{k}]")
        known.append(int(size))
    if sum(known) != count:
        raise InputError(
            f"expected sizes that add up to the {count} {what}, found {sum(known)}", where=where
        )
    ends = accumulate(known)
    return [range(end - size, end) for end, size in zip(ends, known, strict=True)]
