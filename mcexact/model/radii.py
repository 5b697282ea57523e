"""Radii of uncertain entries: how far each entry of a system may be from its value.

`Radii` holds one exact number, at least 0, for each entry of A, B_i and C_i; 0 means that the
entry is certain.  `read_radii` reads the key ``uncertainty`` of a system file, which gives a
common part, radii of their own, or the digits as typed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, from_cells, is_sparse_array, rows_of
from mcexact.exact.rational import Limits, as_fraction, as_part, written
from mcexact.model.entries import as_table, read_matrix, read_number, require_shape
from mcexact.model.text import expect_object, expect_string, kind_of, quoted
from mcexact.shown import Shown

AS_TYPED = "as typed"
_DECIMAL = re.compile(r"-?[0-9]+(?:\.(?P<decimals>[0-9]+))?(?:[eE](?P<exponent>[+-]?[0-9]+))?")


@dataclass(frozen=True, init=False, repr=False)
class Radii(Shown):
    """How far each entry of A, B_i and C_i may be from its value; 0 means that it is certain.

    Parameters
    ----------
    A : matrix, n×n
    B, C : sequences of m matrices
        Of the shapes of B_i and C_i.  Entries are at least 0, as `MultiChannelSystem` takes them.

    Raises
    ------
    FloatRefused
        If an entry is a float.
    InputError
        If an entry is negative or not rational, or the numbers of matrices differ.

    Examples
    --------
    >>> Radii([["1/100"]], [[[0]]], [[[0]]]).A[0, 0]
    Fraction(1, 100)
    >>> Radii([["-1/100"]], [[[0]]], [[[0]]])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: A[0][0]: expected a radius that is at least 0, found -1/100
    """

    A: Matrix
    B: tuple[Matrix, ...]
    C: tuple[Matrix, ...]

    def __init__(self, A: Any, B: Sequence[Any], C: Sequence[Any]) -> None:
        if len(B) != len(C):
            raise InputError(f"expected as many matrices as in B, {len(B)}, found {len(C)}")
        D_A = as_table(A, "A").matrix()
        object.__setattr__(self, "A", _nonnegative(D_A, "A"))
        for key, matrices in (("B", B), ("C", C)):
            read = [as_table(M, f"{key}[{i}]", D_A.nrows).matrix() for i, M in enumerate(matrices)]
            checked = (_nonnegative(M, f"{key}[{i}]") for i, M in enumerate(read))
            object.__setattr__(self, key, tuple(checked))

    @classmethod
    def relative(cls, A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix], radius: Any) -> Radii:
        """The radii that are a part, the same for all, of the moduli of the entries.

        Raises
        ------
        InputError
            If the part is negative or not rational.
        """
        part = as_part(radius, where="relative")
        return cls(moduli(A), [moduli(M) for M in B], [moduli(M) for M in C]) * part

    def __mul__(self, factor: int | Fraction) -> Radii:
        """All radii times a number that is at least 0."""
        return Radii(self.A * factor, [M * factor for M in self.B], [M * factor for M in self.C])

    def matrices(self) -> Iterator[tuple[str, Matrix]]:
        """Yield A, the B_i and the C_i, with their places."""
        yield "A", self.A
        for key, parts in (("B", self.B), ("C", self.C)):
            for i, M in enumerate(parts):
                yield f"{key}[{i}]", M

    def is_zero(self) -> bool:
        """Whether every entry is certain."""
        return all(M.is_zero() for _, M in self.matrices())

    def require_shapes(self, A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix]) -> None:
        """Raise an error unless these are the radii of matrices of such shapes.

        Raises
        ------
        InputError
            If a shape, or the number of channels, differs.
        """
        if len(self.B) != len(B):
            raise InputError(f"expected radii of {len(B)} channels, found {len(self.B)}")
        others = [A, *B, *C]
        for (place, M), other in zip(self.matrices(), others, strict=True):
            require_shape(M, place, other.nrows, other.ncols)

    def document(self, names: Sequence[str]) -> dict[str, Any]:
        """The object ``uncertainty`` of the system of a certificate: the radii that are not 0."""
        absolute: dict[str, Any] = {} if self.A.is_zero() else {"A": _listed(self.A)}
        for key, parts in (("B", self.B), ("C", self.C)):
            by_name = {
                name: _listed(M) for name, M in zip(names, parts, strict=True) if not M.is_zero()
            }
            absolute |= {key: by_name} if by_name else {}
        return {"absolute": absolute}

    def explain(self) -> str:
        """Say how many entries are uncertain."""
        count = sum(sum(1 for _ in M.nonzero()) for _, M in self.matrices())
        if not count:
            return "no entry is uncertain"
        return "one entry is uncertain" if count == 1 else f"{count} entries are uncertain"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the radii of each matrix that is not certain."""
        for place, M in self.matrices():
            if not M.is_zero():
                yield f"radii of {place}", M

    def __repr__(self) -> str:
        return f"Radii({self.explain()})"


def _listed(M: Matrix) -> dict[str, Any]:
    """The entries of a matrix that are not 0, as plain data."""
    entries = [[i, j, written(Fraction(x, M.denominator))] for i, j, x in M.nonzero()]
    return {"shape": list(M.shape), "entries": entries}


def moduli(M: Matrix) -> Matrix:
    """The matrix of the moduli of the entries.

    Examples
    --------
    >>> moduli(Matrix.from_rows([[-1, "1/2"]])).numerators
    ((2, 1),)
    """
    entries = list(M.nonzero())
    cells = [i * M.ncols + j for i, j, _ in entries]
    return from_cells(M.shape, cells, (abs(x) for _, _, x in entries), M.denominator)


def typed_radius(entry: Any) -> Fraction:
    """Half a unit of the last digit of a decimal as it is typed; 0 for every other number.

    Parameters
    ----------
    entry : str, Decimal or another number
        A decimal has a point or an exponent.  Integers, quotients and every zero are certain.

    Examples
    --------
    >>> typed_radius("0.10"), typed_radius("0.1"), typed_radius("2.5e3")
    (Fraction(1, 200), Fraction(1, 20), Fraction(50, 1))
    >>> typed_radius("3"), typed_radius("1/3"), typed_radius("0.00")
    (Fraction(0, 1), Fraction(0, 1), Fraction(0, 1))
    """
    text = str(entry) if isinstance(entry, (str, Decimal)) else ""
    decimal = _DECIMAL.fullmatch(text)
    if decimal is None or (decimal["decimals"] is None and decimal["exponent"] is None):
        return Fraction(0)
    if not as_fraction(entry):
        return Fraction(0)
    power = int(decimal["exponent"] or 0) - len(decimal["decimals"] or "")
    return Fraction(10) ** power / 2


def typed_radii(value: Any, where: str, ncols: int | None = None) -> Matrix:
    """The radii of the entries of a matrix as they are typed.

    Parameters
    ----------
    value : list of rows, or mapping with "shape" and "entries"
        As in a system file, or as `MultiChannelSystem` takes it.
    where : str
        Its place, for messages.
    ncols : int, optional
        The number of columns of a matrix without rows.

    Examples
    --------
    >>> typed_radii([["0.50", 1]], "A").numerators, typed_radii([["0.50", 1]], "A").denominator
    (((1, 0),), 200)
    """
    if isinstance(value, dict):
        entries = [(i, j, typed_radius(entry)) for i, j, entry in value["entries"]]
        return Matrix.from_entries(tuple(value["shape"]), entries, where=where)
    if isinstance(value, Matrix) or is_sparse_array(value):
        return as_table(value, where, ncols).matrix() * 0
    rows = [[typed_radius(entry) for entry in row] for row in rows_of(value, where)]
    return Matrix.from_rows(rows, None if rows else ncols, where=where)


def read_radii(
    value: Any,
    document: dict[str, Any],
    names: Sequence[str],
    A: Matrix,
    B: Sequence[Matrix],
    C: Sequence[Matrix],
    limits: Limits,
) -> Radii:
    """Read the key ``uncertainty`` of a system file.

    Parameters
    ----------
    value : object
        ``{"relative": r}``, ``{"digits": "as typed"}``, or ``{"absolute": {"A": M, "B": {name: M},
        "C": {name: M}}}``, where what is left out is certain.
    document : dict
        The file, whose numbers are as they are typed.
    names : sequence of str
        The channels.
    A, B, C : matrices
        The matrices of the file, which are read already.
    limits : Limits

    Raises
    ------
    InputError
        If it is malformed, a radius is negative or has too many digits, or a shape differs.
    """
    radii = _radii(value, document, names, A, B, C, limits)
    for place, M in radii.matrices():
        for i, j, x in M.nonzero():
            radius = Fraction(x, M.denominator)
            longest = max(radius.numerator, radius.denominator)
            if longest.bit_length() > 3 * limits.digits and longest >= 10**limits.digits:
                raise InputError(
                    f"the radius of {place}[{i}][{j}] has more than {limits.digits} digits "
                    "(Limits.digits), and no file with it would be read: shorten the radii",
                    where="uncertainty",
                )
    return radii


def _radii(
    value: Any,
    document: dict[str, Any],
    names: Sequence[str],
    A: Matrix,
    B: Sequence[Matrix],
    C: Sequence[Matrix],
    limits: Limits,
) -> Radii:
    """Read the radii from the one of three forms that the value has."""
    where = "uncertainty"
    if not isinstance(value, dict):
        raise InputError(
            f'expected an object such as {{"relative": "1/100"}}, found {kind_of(value)}',
            where=where,
        )
    form = expect_object(value, where, (), ("relative", "digits", "absolute"))
    if len(form) != 1:
        raise InputError(
            f"expected one of 'relative', 'digits' and 'absolute', found {len(form)}", where=where
        )
    if "relative" in form:
        part = _read_part(form["relative"], f"{where}.relative", limits)
        return Radii(moduli(A), [moduli(M) for M in B], [moduli(M) for M in C]) * part
    if "digits" in form:
        if expect_string(form["digits"], f"{where}.digits") != AS_TYPED:
            raise InputError(f'expected "{AS_TYPED}"', where=f"{where}.digits")
        channels = list(zip(document["channels"], B, C, strict=True))
        return Radii(
            typed_radii(document["A"], "A"),
            [typed_radii(c["B"], "B", B_i.ncols) for c, B_i, _ in channels],
            [typed_radii(c["C"], "C", C_i.ncols) for c, _, C_i in channels],
        )
    place = f"{where}.absolute"
    parts = expect_object(form["absolute"], place, (), ("A", "B", "C"))

    def read(value: Any, at: str, like: Matrix) -> Matrix:
        return _nonnegative(read_matrix(value, at, *like.shape, limits), at)

    def ports(key: str, like: Sequence[Matrix]) -> list[Matrix]:
        at = f"{place}.{key}"
        by_name = expect_object(parts.get(key, {}), at, (), names)
        return [
            read(by_name[name], f"{at}[{quoted(name)}]", M)
            if name in by_name
            else Matrix.zeros(*M.shape)
            for name, M in zip(names, like, strict=True)
        ]

    D_A = read(parts["A"], f"{place}.A", A) if "A" in parts else Matrix.zeros(*A.shape)
    return Radii(D_A, ports("B", B), ports("C", C))


def _read_part(value: Any, where: str, limits: Limits) -> Fraction:
    """Read a part of every entry; percentages are told how to write it."""
    if isinstance(value, str) and value.endswith("%"):
        raise InputError(
            f'a file gives a part as a number such as 0.1 or "1/10", found "{value}"', where=where
        )
    part = read_number(value, where, limits)
    _require_nonnegative(part, where)
    return part


def _nonnegative(M: Matrix, where: str) -> Matrix:
    """Return radii of which none is negative."""
    for i, j, x in M.nonzero():
        if x < 0:
            _require_nonnegative(Fraction(x, M.denominator), f"{where}[{i}][{j}]")
    return M


def _require_nonnegative(radius: Fraction, where: str) -> None:
    if radius < 0:
        raise InputError(f"expected a radius that is at least 0, found {radius}", where=where)
