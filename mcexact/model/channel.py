"""Channels, and the lists of matrices from which they are made."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.model.matrix_entry import as_table, require_shape
from mcexact.model.names import checked_names, quoted
from mcexact.shown import Shown, fitting


@dataclass(frozen=True, repr=False)
class Channel(Shown):
    """One channel: the agent's name, B_i (n×p_i) and C_i (q_i×n)."""

    name: str
    B: Matrix
    C: Matrix

    def __repr__(self) -> str:
        return fitting(f"Channel({quoted(self.name)}, B={self.B!r}, C={self.C!r})")

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the name and the matrices."""
        yield from vars(self).items()


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
    if isinstance(value, Matrix) or getattr(value, "ndim", 0) == 2:
        return True
    row = value[0] if isinstance(value, (list, tuple)) and value else None
    return isinstance(row, (list, tuple)) and any(
        isinstance(entry, str) or not hasattr(entry, "__iter__") for entry in row
    )


def channels_of(
    n: int, B: Sequence[Any], C: Sequence[Any], names: Sequence[str] | None
) -> tuple[Channel, ...]:
    """Convert the matrices of all channels, and check their shapes and names.

    Raises
    ------
    InputError
        If there are no channels, or a matrix, a shape or a name is not as expected.
    """
    B, C = listed_matrices(B, "B"), listed_matrices(C, "C")
    m = len(B)
    if m != len(C):
        raise InputError(f"expected as many matrices as in B, {m}, found {len(C)}", where="C")
    if not m:
        raise InputError("expected at least one channel, found none", where="B")
    if isinstance(names, str):
        raise InputError("expected a list of names, found a string", where="names")
    labels = [str(i + 1) for i in range(m)] if names is None else list(names)
    if len(labels) != m:
        raise InputError(f"expected {m} names, found {len(labels)}", where="names")
    checked = checked_names(labels, [f"names[{i}]" for i in range(m)])
    tables = [
        (
            require_shape(as_table(B[i], f"B[{i}]"), f"B[{i}]", n, None),
            require_shape(as_table(C[i], f"C[{i}]", ncols=n), f"C[{i}]", None, n),
        )
        for i in range(m)
    ]
    return tuple(
        Channel(name, B_i.matrix(), C_i.matrix())
        for name, (B_i, C_i) in zip(checked, tables, strict=True)
    )
