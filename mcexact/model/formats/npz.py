"""Archives of numpy, which ``numpy.savez`` writes; nothing in them is unpickled."""

from __future__ import annotations

import io
import sys
import zipfile
from collections.abc import Mapping
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.floats import Rounding
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Limits, decimal_or_quotient
from mcexact.model.formats.arrays import floats_of, integers_or_none, require_sides
from mcexact.model.formats.parts import ROUNDING, TEXTS, Parts, require_known


def read_npz(files: Mapping[str, bytes], limits: Limits) -> Parts:
    """Read the arrays of an archive: A, B_1, C_1 and others, as in `Parts`.

    Parameters
    ----------
    files : mapping
        The contents of the members of the archive, by their names.
    limits : Limits

    Raises
    ------
    InputError
        If an array is damaged, unknown, or of objects.
    """
    known = {name.removesuffix(".npy"): data for name, data in files.items()}
    require_known(known, "array")
    tables: dict[str, Any] = {}
    texts: dict[str, str] = {}
    names = None
    for name, data in known.items():
        array = _array(data, name)
        if name in TEXTS or name == "names":
            if array.dtype.kind != "U" or array.ndim != (name == "names"):
                raise InputError(
                    "expected a text" if name in TEXTS else "expected texts", where=name
                )
            if name == "names":
                names = array.tolist()
            else:
                texts[name] = str(array)
        else:
            # A list and a number are matrices of one row.
            tables[name] = array.reshape(1, -1) if array.ndim < 2 and name != "A" else array
            require_sides(tables[name].shape, name)
    return Parts(tables, texts, names)


def _array(data: bytes, name: str) -> Any:
    """Read one array, whose size has to be that of its data."""
    import numpy as np
    from numpy.lib import format as npy

    stream = io.BytesIO(data)
    try:
        version = npy.read_magic(stream)
        read = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}[version]
        shape, by_columns, dtype = read(stream)
    except KeyError:
        raise InputError("the version of this array is unknown", where=name) from None
    except Exception:  # the header is a Python literal, of which anything can be wrong
        raise InputError("the array is damaged: it has no header of numpy", where=name) from None
    if any(type(side) is not int for side in shape):  # numpy takes true for 1, not everywhere
        raise InputError("the array is damaged: its shape is not of integers", where=name)
    if dtype.hasobject or dtype.names is not None:
        raise InputError(
            "expected numbers or texts, found objects, which would have to be unpickled", where=name
        )
    if len(shape) > 2 or any(side < 0 for side in shape):
        require_sides(shape, name)
    count = 1
    for side in shape:
        count *= side
    rest = data[stream.tell() :]
    if max((0, *shape)) > len(data) or count * dtype.itemsize != len(rest) or not dtype.itemsize:
        if count == 0 and not rest and dtype.itemsize:
            return np.zeros(shape, dtype)
        raise InputError(
            f"the array is damaged: {len(rest)} bytes do not hold {' × '.join(map(str, shape))} "
            "entries",
            where=name,
        )
    if dtype.kind == "U" and np.any(np.frombuffer(rest, dtype.byteorder + "u4") > sys.maxunicode):
        raise InputError("the array is damaged: it has a character that is none", where=name)
    return np.frombuffer(rest, dtype).reshape(shape, order="F" if by_columns else "C")


def npz_bytes(parts: Parts, rounding: Rounding | None, *, nearest: bool) -> bytes:
    """Write the arrays of a system; equal parts give equal bytes.

    Integers become integers of 64 bits.  Other numbers become texts, which are exact, or floats if
    a rounding is given or the nearest ones are wanted.

    Raises
    ------
    InputError
        If a number is no float from which the rounding makes it again, and `nearest` is false.
    """
    import numpy as np

    def array(M: Matrix, where: str) -> Any:
        whole = integers_or_none(M)
        if whole is not None:
            return whole
        if rounding is not None or nearest:
            return floats_of(M, where, rounding, nearest=nearest)
        texts = [[str(decimal_or_quotient(x)) for x in row] for row in M.rows()]
        return np.array(texts)

    arrays = {name: array(M, name) for name, M in parts.tables.items()}
    arrays |= {name: np.array(text) for name, text in parts.texts.items()}
    arrays["names"] = np.array(parts.names)
    if any(value.dtype.kind == "f" for value in arrays.values()):
        arrays[ROUNDING] = np.array(rounding or "dyadic")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, value in arrays.items():
            member = io.BytesIO()
            np.lib.format.write_array(member, value, version=(1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), member.getvalue())
    return stream.getvalue()
