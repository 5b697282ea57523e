"""Channels by position and by name: what systems of numbers and of functions have in common."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar

from mcexact.arguments import several
from mcexact.errors import InputError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.matrix import Matrix
from mcexact.model.channel_matrices import ChannelMatrices, position
from mcexact.model.matrix_entry import Table, require_shape
from mcexact.model.names import checked_names, quoted
from mcexact.shown import Shown, fitting

M = TypeVar("M", Matrix, FunctionMatrix)


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


class ByChannel(Generic[M]):
    """The sizes and the channels of a system with a matrix A and channels."""

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
        The shape of a value with its place, and of one without rows its number of columns.

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
