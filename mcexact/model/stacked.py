"""Systems from stacked matrices B = [B_1 … B_m] and C = [C_1; …; C_m] and the channels' sizes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate
from typing import Any

from mcexact.arguments import several
from mcexact.errors import InputError
from mcexact.exact.floats import Rounding, matrix_from_float
from mcexact.exact.matrix import Matrix
from mcexact.model.matrix_entry import as_matrix, require_shape
from mcexact.model.system import MultiChannelSystem


def from_stacked(
    A: Any,
    B: Any,
    C: Any,
    *,
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
    inputs, outputs : iterables of m integers
        p_1 … p_m and q_1 … q_m, the numbers of inputs and outputs of the channels.
    rounding : {"decimal", "dyadic"}, optional
        How floats become exact numbers, as in `MultiChannelSystem.from_float`; needed for floats.
    **options
        As in `MultiChannelSystem`.

    Raises
    ------
    FloatRefused
        If an entry is a float, and there is no rounding.
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
            return as_matrix(value, where)
        return matrix_from_float(value, rounding, where=where)

    state = exact(A, "A")
    stacked_B = require_shape(exact(B, "B"), "B", state.nrows, None)
    stacked_C = require_shape(exact(C, "C"), "C", None, state.nrows)
    return MultiChannelSystem(
        state, *split_by_sizes(stacked_B, stacked_C, inputs, outputs), **options
    )


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
    """Split the positions below a count into consecutive parts of given sizes."""
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
