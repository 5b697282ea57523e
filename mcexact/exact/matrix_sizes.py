"""The sizes that matrices can have, and the positions in them."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.errors import InputError, LimitReached

# 2 GiB of machine words
_MOST_ENTRIES = 2**28


def require_sides(nrows: int, ncols: int) -> None:
    """Raise an error for numbers of rows and columns that no matrix has."""
    for size, name in ((nrows, "rows"), (ncols, "columns")):
        if type(size) is not int or size < 0:
            raise InputError(f"expected a number of {name} that is at least 0, found {size!r}")
    if max(nrows, ncols) > _MOST_ENTRIES:
        raise _too_large(nrows, ncols)


def require_sizes(nrows: int, ncols: int) -> None:
    """Raise an error for sizes for which flint would abort, or that exceed the memory."""
    require_sides(nrows, ncols)
    if nrows * ncols > _MOST_ENTRIES:
        raise _too_large(nrows, ncols)


def _too_large(nrows: int, ncols: int) -> LimitReached:
    return LimitReached(
        f"a {nrows} × {ncols} matrix has more than {_MOST_ENTRIES} entries: too many for memory"
    )


def require_positions(
    shape: tuple[int, int], rows: Sequence[int] | None, cols: Sequence[int] | None
) -> None:
    """Refuse rows and columns that a matrix of this shape does not have."""
    for chosen, size, name in zip((rows, cols), shape, ("row", "column"), strict=True):
        for k in chosen or ():
            if not 0 <= k < size:
                raise IndexError(f"no {name} {k} in a {shape[0]} × {shape[1]} matrix")
