"""Files of MATLAB, version 5, which ``save -v7`` and ``save -v6`` write.

They are read here, and written by scipy, whose reader believes the types, sizes and shapes of a
file: one wrong byte ends the interpreter, and 3 MB become 3 GB.  A file is a header and elements;
an element has a type, a size and contents; and a variable is an element whose contents are
elements: flags, shape, name and values.  Every type and size is compared with what the class and
the shape of its variable allow, before numpy reads the values.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.floats import Rounding, matrix_to_float
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Limits
from mcexact.model.formats.arrays import WHOLE, floats_of, require_sides
from mcexact.model.formats.parts import ROUNDING, TEXTS, Parts, require_known

MAGIC = b"MATLAB 5.0 MAT-file"
_HEADER = 128
_ARRAY, _COMPRESSED = 14, 15
_CELL, _TEXT, _SPARSE = 1, 4, 5
_NUMBERS = frozenset({_SPARSE, *range(6, 16)})
_CLASSES = {2: "a struct", 3: "an object", 16: "a function", 17: "an object"}
_COMPLEX, _LOGICAL = 0x0800, 0x0200
_BYTES, _INT32, _UINT32 = 2, 5, 6
_STORED = {
    **dict(enumerate(("i1", "u1", "i2", "u2", "i4", "u4", "f4"), start=1)),
    **dict(zip((9, 12, 13), ("f8", "i8", "u8"), strict=True)),
}
"""How numpy calls the types of elements that hold numbers."""
_MEANT = {
    **dict(enumerate(("f8", "f8", "f4", "i1", "u1", "i2", "u2"), start=_SPARSE)),
    **dict(enumerate(("i4", "u4", "i8", "u8"), start=12)),
}
"""How numpy calls the classes of matrices; a class is stored in any type that holds its numbers."""
_ENCODINGS = {1: "ascii", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
"""The types of elements that hold texts."""


@dataclass(frozen=True)
class _Element:
    """An element: its type, and where its contents begin and end."""

    kind: int
    begin: int
    end: int

    @property
    def size(self) -> int:
        """The number of bytes of its contents."""
        return self.end - self.begin


@dataclass(frozen=True)
class _Array:
    """A variable, or an array in a cell: name, class and shape; the elements after these."""

    name: str
    kind: int
    shape: tuple[int, int]
    contents: list[_Element]
    logical: bool = False

    @property
    def count(self) -> int:
        """The number of entries."""
        return self.shape[0] * self.shape[1]


def read_mat(data: bytes, limits: Limits) -> Parts:
    """Read the variables of a file: A, B, C and others, as in `Parts`; B and C may be cells.

    Raises
    ------
    InputError
        If it is damaged, larger than ``Limits.bytes`` when decompressed, or has a variable that is
        unknown or no matrix of real numbers.
    """
    try:
        return _File(*_decompressed(data, limits)).parts()
    except (struct.error, zlib.error, UnicodeDecodeError) as error:
        raise InputError(f"the file is damaged: {error}") from None


def _damaged(said: str, where: str | None = None) -> InputError:
    return InputError(f"the file is damaged: {said}", where=where or None)


def _decompressed(data: bytes, limits: Limits) -> tuple[bytes, str]:
    """The file with every variable decompressed, no larger than a file may be; its byte order."""
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if order is None:
        raise _damaged("its byte order is unknown")
    (version,) = struct.unpack_from(f"{order}H", data, 124)
    if version >> 8 != 1:
        raise _damaged(f"expected version 1 in its header, found {version >> 8}")
    found, size = [data[:_HEADER]], _HEADER
    for element in _elements(data, order, _HEADER, len(data)):
        if element.kind == _COMPRESSED:
            stream = zlib.decompressobj()
            part = stream.decompress(data[element.begin : element.end], limits.bytes + 1 - size)
            if stream.unconsumed_tail or len(part) + size > limits.bytes:
                raise InputError(
                    f"expected at most {limits.bytes} bytes when decompressed (Limits.bytes), "
                    "found more"
                )
            if not stream.eof:
                raise _damaged("a compressed variable is incomplete")
        else:
            part = data[element.begin - 8 : element.end]
        found.append(part + bytes(-len(part) % 8))
        size += len(found[-1])
    return b"".join(found), order


def _elements(data: bytes, order: str, begin: int, end: int) -> Iterator[_Element]:
    """Yield the elements in a part of a file, whose ends are inside of it."""
    while begin < end:
        kind, size = struct.unpack_from(f"{order}II", data, begin)
        if kind >> 16:  # a size of at most 4, and contents within the 8 bytes
            kind, size, start, following = kind & 0xFFFF, kind >> 16, begin + 4, begin + 8
            if size > 4:
                raise _damaged(f"expected at most 4 bytes in a short element, found {size}")
        else:
            start = begin + 8
            following = start + size + (0 if kind == _COMPRESSED else -size % 8)
        if start + size > end:
            raise _damaged("it ends within a variable")
        yield _Element(kind, start, start + size)
        begin = following


class _File:
    """A file whose variables are decompressed."""

    def __init__(self, data: bytes, order: str) -> None:
        self._data, self._order = data, order

    def parts(self) -> Parts:
        """Read all variables; the cells of B and C become B_1, C_1 and so on."""
        variables = self._variables()
        _require_variables(variables)
        tables: dict[str, Any] = {}
        texts: dict[str, str] = {}
        names = None
        for variable in variables:
            name = variable.name
            if name in TEXTS:
                texts[name] = self._text(variable)
            elif name == "names":
                names = [self._text(each) for each in self._listed(variable)]
            elif variable.kind == _CELL:
                for k, each in enumerate(self._listed(variable), start=1):
                    tables[f"{name}_{k}"] = self._table(each)
            else:
                tables[name] = self._table(variable)
        return Parts(tables, texts, names)

    def _variables(self) -> list[_Array]:
        found = []
        for element in _elements(self._data, self._order, _HEADER, len(self._data)):
            if element.kind != _ARRAY:
                raise _damaged(f"it has an element of type {element.kind}")
            found.append(self._array(element))
        return found

    def _array(self, element: _Element, cell: str = "") -> _Array:
        """Read the header of an array of real entries, possibly in a cell, and check its shape."""
        if cell and not element.size:  # how MATLAB writes a cell that was never set
            return _Array(cell, 6, (0, 0), [_Element(9, element.end, element.end)])
        contents = list(_elements(self._data, self._order, element.begin, element.end))
        if len(contents) < 3:
            raise _damaged("an array has no header", cell)
        flags, shape, name = contents[:3]
        if (flags.kind, flags.size) != (_UINT32, 8) or (shape.kind, shape.size % 4) != (_INT32, 0):
            raise _damaged("an array has no flags or no shape", cell)
        if name.kind != 1:
            raise _damaged(f"a name is of type {name.kind}", cell)
        (word,) = struct.unpack_from(f"{self._order}I", self._data, flags.begin)
        sides = struct.unpack_from(f"{self._order}{shape.size // 4}i", self._data, shape.begin)
        label = cell or self._data[name.begin : name.end].decode("ascii")
        kind = word & 0xFF
        if kind in _CLASSES:
            raise InputError(f"expected a matrix, found {_CLASSES[kind]}", where=label or None)
        if word & _COMPLEX:
            raise InputError("expected real numbers, found complex numbers", where=label or None)
        require_sides(sides, label)
        return _Array(label, kind, (sides[0], sides[1]), contents[3:], bool(word & _LOGICAL))

    def _listed(self, cell: _Array) -> list[_Array]:
        """The arrays in a cell array, column by column."""
        if len(cell.contents) != cell.count or any(e.kind != _ARRAY for e in cell.contents):
            raise _damaged("a cell array is incomplete", cell.name)
        wanted = {_TEXT} if cell.name == "names" else _NUMBERS
        found = [self._array(element, cell.name) for element in cell.contents]
        for each in found:
            _require_class(each, wanted)
        return found

    def _table(self, array: _Array) -> Any:
        """The numbers of an array."""
        if array.kind == _SPARSE:
            return self._sparse(array)
        if len(array.contents) != 1:
            raise _damaged(
                f"expected 1 element of numbers, found {len(array.contents)}", array.name
            )
        values = self._numbers(array.contents[0], array)
        if values.size != array.count:
            raise _damaged(
                f"{values.size} numbers do not fill {array.shape[0]} × {array.shape[1]} entries",
                array.name,
            )
        return values.reshape(array.shape, order="F")

    def _numbers(self, element: _Element, array: _Array) -> Any:
        """The numbers of an element: floats in the precision of their class, and integers.

        A class of floats is often stored as short integers, which are exact as they are.
        """
        import numpy as np

        stored, meant = self._stored(element, array.name), np.dtype(_MEANT[array.kind])
        if stored.dtype.kind == "f" == meant.kind:
            with np.errstate(all="ignore"):
                values = stored.astype(meant)
            if meant.itemsize >= stored.itemsize or np.array_equal(values, stored, equal_nan=True):
                return values
        elif stored.dtype.kind != "f":
            most = 2 ** (np.finfo(meant).nmant + 1) if meant.kind == "f" else np.iinfo(meant).max
            least = -most if meant.kind == "f" else np.iinfo(meant).min
            if not stored.size or (int(stored.min()) >= least and int(stored.max()) <= most):
                return stored
        raise _damaged(f"class {array.kind} does not hold its numbers", array.name)

    def _stored(self, element: _Element, where: str) -> Any:
        """The numbers of an element as they are stored."""
        import numpy as np

        if element.kind not in _STORED:
            raise _damaged(f"expected numbers, found an element of type {element.kind}", where)
        kind = np.dtype(self._order + _STORED[element.kind])
        if element.size % kind.itemsize:
            raise _damaged(
                f"{element.size} bytes are no numbers of {kind.itemsize} bytes each", where
            )
        return np.frombuffer(self._data, kind, element.size // kind.itemsize, element.begin)

    def _sparse(self, array: _Array) -> Any:
        """A sparse matrix, whose positions have to be inside, column by column and ascending.

        Its elements are the rows of its entries, for each column the position of its first entry
        among them, with the end of the last, and the entries; there can be room for more.
        """
        import numpy as np
        from scipy.sparse import csc_array

        nrows, ncols = array.shape
        if len(array.contents) != 3:
            raise _damaged("a sparse matrix is incomplete", array.name)
        for element in array.contents[:2]:
            if element.kind != _INT32:
                raise _damaged(f"positions are of type {element.kind}", array.name)
        rows, starts = (self._stored(each, array.name) for each in array.contents[:2])
        entries = array.contents[2]
        if array.logical and entries.size == rows.size:  # bytes, though MATLAB calls them floats
            entries = replace(entries, kind=_BYTES)
        values = self._numbers(entries, array)
        if starts.size != ncols + 1 or starts[0] != 0 or np.any(starts[1:] < starts[:-1]):
            raise _damaged("the columns of a sparse matrix have no positions", array.name)
        count = int(starts[-1])
        if min(rows.size, values.size) < count:
            raise _damaged("a sparse matrix has fewer entries than positions", array.name)
        rows, values = rows[:count].astype("i4"), values[:count]
        column = np.repeat(np.arange(ncols), np.diff(starts))
        place = column * nrows + rows
        if np.any((rows < 0) | (rows >= nrows)) or np.any(place[1:] <= place[:-1]):
            raise _damaged("a sparse matrix has rows that are outside or not in order", array.name)
        return csc_array((values, rows, starts.astype("i4")), shape=array.shape)

    def _text(self, array: _Array) -> str:
        """A text in one row."""
        if not array.contents and not array.count:
            return ""
        if array.shape[0] > 1:
            raise InputError(
                f"expected a text of one line, found {array.shape[0]}", where=array.name
            )
        if len(array.contents) != 1 or array.contents[0].kind not in _ENCODINGS:
            raise _damaged("a text has no characters", array.name)
        (element,) = array.contents
        encoding = _ENCODINGS[element.kind]
        if encoding[-2:] in ("16", "32"):
            encoding += "-le" if self._order == "<" else "-be"
        data = self._data[element.begin : element.end]
        text = data.decode(encoding)
        # Programs count characters, or the bytes or pairs of bytes that they stored.
        if array.count not in (len(text), len(data), len(text.encode("utf-16-le")) // 2):
            raise _damaged(f"{len(text)} characters do not fill {array.count}", array.name)
        return text


def _require_variables(variables: list[_Array]) -> None:
    """Refuse variables that are unknown, given twice, or of another class than their name has."""
    names = [variable.name for variable in variables]
    require_known(names, "variable")
    for k, variable in enumerate(variables):
        name = variable.name
        if name in names[:k]:
            raise InputError(f"the variable '{name}' is given twice")
        if name in ("B", "C") and variable.kind == _CELL:
            continue
        if variable.kind == _CELL and name != "names":
            raise InputError("expected a matrix, found a cell array", where=name)
        _require_class(
            variable, {_CELL} if name == "names" else {_TEXT} if name in TEXTS else _NUMBERS
        )


def _require_class(array: _Array, wanted: frozenset[int] | set[int]) -> None:
    """Refuse an array of another class."""
    if array.kind not in wanted:
        what = {_TEXT: "a text", _CELL: "a cell array of texts"}.get(
            min(wanted), "a matrix of numbers"
        )
        raise InputError(f"expected {what}, found another class", where=array.name)


def mat_bytes(parts: Parts, rounding: Rounding | None, *, nearest: bool) -> bytes:
    """Write the variables of a system, with B and C as cells; equal parts give equal bytes.

    Raises
    ------
    InputError
        If a number is no float from which the rounding makes it again, and `nearest` is false.
    """
    import scipy.io

    def array(M: Matrix, where: str) -> Any:
        if _is_whole(M):
            return matrix_to_float(M)
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
    if not all(_is_whole(M) for M in parts.tables.values()):
        variables[ROUNDING] = rounding or "dyadic"
    stream = io.BytesIO()
    scipy.io.savemat(stream, variables, do_compression=True)  # type: ignore[arg-type]
    header = MAGIC + b", written by mcexact"
    return header.ljust(124) + stream.getvalue()[124:]


def _is_whole(M: Matrix) -> bool:
    """Whether every entry is an integer that a float is, whatever the rounding."""
    return M.denominator == 1 and all(abs(x) < WHOLE for _, _, x in M.nonzero())


def _cell(values: Any) -> Any:
    """A row of cells."""
    import numpy as np

    cell = np.empty((1, len(values)), dtype=object)
    for k, value in enumerate(values):
        cell[0, k] = value
    return cell
