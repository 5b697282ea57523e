"""Files of MATLAB, version 5, which ``save -v7`` and ``save -v6`` write.

Headers are read here and values by scipy: scipy takes a shape as it is claimed, and decompresses
3 GB from a file of 3 MB.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.floats import Rounding
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Limits
from mcexact.model.formats.arrays import floats_of, integers_or_none, require_sides
from mcexact.model.formats.parts import TEXTS, Parts, require_known

MAGIC = b"MATLAB 5.0 MAT-file"
_HEADER = 128
_ARRAY, _COMPRESSED = 14, 15
_CELL, _TEXT, _SPARSE = 1, 4, 5
_NUMBERS = frozenset({_SPARSE, *range(6, 16)})
_CLASSES = {2: "a struct", 3: "an object", 16: "a function", 17: "an object"}
_COMPLEX = 0x0800


@dataclass(frozen=True)
class _Header:
    """The header of an array: its name, class and shape, and where its contents begin and end."""

    name: str
    kind: int
    shape: tuple[int, ...]
    begin: int
    end: int


def read_mat(data: bytes, limits: Limits) -> Parts:
    """Read the variables of a file: A, B, C and others, as in `Parts`; B and C may be cells.

    Raises
    ------
    InputError
        If it is damaged, larger than ``Limits.bytes`` when decompressed, or has a variable that is
        unknown or no matrix of real numbers.
    """
    import numpy as np
    import scipy.io

    try:
        plain = _decompressed(data, limits)
        headers = list(_headers(plain))
        _require_arrays(plain, headers)
        with np.errstate(all="ignore"):
            loaded = scipy.io.loadmat(io.BytesIO(plain))  # type: ignore[arg-type]
    except (struct.error, zlib.error, UnicodeDecodeError, IndexError) as error:
        raise InputError(f"the file is damaged: {error}") from None
    except InputError:
        raise
    except Exception as error:  # of scipy's readers, which raise all kinds for a damaged file
        said = str(error).partition("\n")[0]
        raise InputError(f"scipy cannot read the file: {said or type(error).__name__}") from None
    return _parts({header.name: loaded[header.name] for header in headers})


def _decompressed(data: bytes, limits: Limits) -> bytes:
    """The file with every variable decompressed, no larger than a file may be."""
    if data[126:128] not in (b"IM", b"MI"):
        raise InputError("the file is damaged: its byte order is unknown")
    found, size = [data[:_HEADER]], _HEADER
    for kind, begin, end, _ in _elements(data, _order(data), _HEADER, len(data)):
        if kind == _COMPRESSED:
            stream = zlib.decompressobj()
            part = stream.decompress(data[begin:end], limits.bytes + 1 - size)
            if stream.unconsumed_tail or len(part) + size > limits.bytes:
                raise InputError(
                    f"expected at most {limits.bytes} bytes when decompressed (Limits.bytes), "
                    "found more"
                )
        else:
            part = data[begin - 8 : end]
        found.append(part + bytes(-len(part) % 8))
        size += len(found[-1])
    return b"".join(found)


def _order(data: bytes) -> str:
    """How `struct` writes the byte order of a file."""
    return "<" if data[126:128] == b"IM" else ">"


def _elements(data: bytes, order: str, begin: int, end: int) -> Iterator[tuple[int, int, int, int]]:
    """Yield type, begin and end of the elements in a part of a file, and where the next begins."""
    while begin < end:
        kind, size = struct.unpack_from(f"{order}II", data, begin)
        small = kind >> 16
        start, kind, size = (begin + 4, kind & 0xFFFF, small) if small else (begin + 8, kind, size)
        stop = start + size
        if stop > end:
            raise InputError("the file is damaged: it ends within a variable")
        begin = begin + 8 if small else stop + (0 if kind == _COMPRESSED else -size % 8)
        yield kind, start, stop, begin


def _headers(data: bytes) -> Iterator[_Header]:
    """Yield the header of every variable."""
    order = _order(data)
    for kind, begin, end, _ in _elements(data, order, _HEADER, len(data)):
        if kind != _ARRAY:
            raise InputError(f"the file is damaged: it has an element of type {kind}")
        yield _header(data, order, begin, end)


def _header(data: bytes, order: str, begin: int, end: int, cell: str = "") -> _Header:
    """Read the header of an array of real entries, possibly in a cell, and check its shape."""
    parts = _elements(data, order, begin, end)
    try:
        flags, shape, name = next(parts), next(parts), next(parts)
    except StopIteration:
        raise InputError("the file is damaged: an array has no header") from None
    (word,) = struct.unpack_from(f"{order}I", data, flags[1])
    sides = struct.unpack(f"{order}{(shape[2] - shape[1]) // 4}i", data[shape[1] : shape[2]])
    label = cell or data[name[1] : name[2]].decode("ascii")
    kind = word & 0xFF
    if kind in _CLASSES:
        raise InputError(f"expected a matrix, found {_CLASSES[kind]}", where=label or None)
    if word & _COMPLEX:
        raise InputError("expected real numbers, found complex numbers", where=label or None)
    require_sides(sides, label)
    return _Header(label, kind, sides, name[3], end)


def _require_arrays(data: bytes, headers: list[_Header]) -> None:
    """Refuse variables that are unknown, and cells of anything but matrices and texts."""
    names = [header.name for header in headers]
    require_known(names, "variable")
    for k, header in enumerate(headers):
        if header.name in names[:k]:
            raise InputError(f"the variable '{header.name}' is given twice")
        inner = _inner(data, header) if header.kind == _CELL else []
        if header.kind == _CELL and header.name not in ("B", "C", "names"):
            raise InputError("expected a matrix, found a cell array", where=header.name)
        wanted = {_TEXT} if header.name in ("names", *TEXTS) else _NUMBERS
        for found in inner or [header]:
            if found.kind not in wanted and not (found is header and found.kind == _CELL):
                what = "a text" if _TEXT in wanted else "a matrix of numbers"
                raise InputError(f"expected {what}, found another class", where=header.name)


def _inner(data: bytes, cell: _Header) -> list[_Header]:
    """The headers of the arrays in a cell array."""
    order = _order(data)
    parts = list(_elements(data, order, cell.begin, cell.end))
    if len(parts) != cell.shape[0] * cell.shape[1] or any(kind != _ARRAY for kind, *_ in parts):
        raise InputError("the file is damaged: a cell array is incomplete", where=cell.name)
    return [_header(data, order, begin, end, cell.name) for _, begin, end, _ in parts]


def _parts(loaded: dict[str, Any]) -> Parts:
    """Sort the variables; the cells of B and C become B_1, C_1 and so on."""
    tables: dict[str, Any] = {}
    texts: dict[str, str] = {}
    names = None
    for name, value in loaded.items():
        if name in TEXTS:
            texts[name] = str(value[0]) if value.size else ""
        elif name == "names":
            names = [str(each[0]) if each.size else "" for each in value.ravel()]
        elif value.dtype == object:
            for k, each in enumerate(value.ravel(order="F"), start=1):
                tables[f"{name}_{k}"] = _sound(each, f"{name}_{k}")
        else:
            tables[name] = _sound(value, name)
    return Parts(tables, texts, names)


def _sound(value: Any, where: str) -> Any:
    """A matrix whose positions, if it is sparse, were checked: conversions would trust them."""
    if hasattr(value, "check_format"):
        try:
            value.check_format(full_check=True)
        except ValueError as error:
            raise InputError(f"the sparse matrix is damaged: {error}", where=where) from None
    return value


def mat_bytes(parts: Parts, rounding: Rounding | None, *, nearest: bool) -> bytes:
    """Write the variables of a system, with B and C as cells; equal parts give equal bytes.

    Raises
    ------
    InputError
        If a number is no float from which the rounding makes it again, and `nearest` is false.
    """
    import numpy as np
    import scipy.io

    def array(M: Matrix, where: str) -> Any:
        whole = integers_or_none(M)
        if whole is not None and np.all(np.abs(whole) < 2**53):
            return whole.astype(float)
        return floats_of(M, where, rounding, nearest=nearest)

    cells: dict[str, list[Any]] = {"B": [], "C": []}
    variables: dict[str, Any] = {}
    for name, M in parts.tables.items():
        letter, _, number = name.partition("_")
        if number.isdigit():
            cells[letter].append(array(M, name))
        else:
            variables[name] = array(M, name)
    for letter, listed in cells.items():
        variables[letter] = _cell(listed)
    variables |= {"names": _cell(parts.names or ()), **parts.texts}
    stream = io.BytesIO()
    scipy.io.savemat(stream, variables, do_compression=True)  # type: ignore[arg-type]
    header = MAGIC + b", written by mcexact"
    return header.ljust(124) + stream.getvalue()[124:]


def _cell(values: Any) -> Any:
    """A row of cells."""
    import numpy as np

    cell = np.empty((1, len(values)), dtype=object)
    for k, value in enumerate(values):
        cell[0, k] = value
    return cell
