"""Files of other programs that are damaged, hostile, or of a kind that is not read."""

import io
import pickle
import struct
import zipfile
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse

GOOD: dict[str, Any] = {
    "A": np.array([[0.0, 1.0], [2.0, 3.0]]),
    "B": np.array([[1.0], [0.0]]),
    "C": np.array([[1.0, 0.0]]),
    "inputs": np.array([1.0]),
    "outputs": np.array([1.0]),
}


def mat(compressed: bool = True, **changed: Any) -> bytes:
    """A file of MATLAB with some variables changed, or left out if they are None."""
    stream: Any = io.BytesIO()
    variables = {key: value for key, value in (GOOD | changed).items() if value is not None}
    scipy.io.savemat(stream, variables, do_compression=compressed)
    return stream.getvalue()


def array(
    name: str, sides: tuple[int, ...], content: bytes, kind: int = 6, flags: int = 0
) -> bytes:
    """One variable of a MATLAB file, with a shape and contents as they are told."""
    shape = struct.pack(f"<{len(sides)}i", *sides)
    label = name.encode()
    body = struct.pack("<IIII", 6, 8, kind | flags << 8, 0)
    body += struct.pack("<II", 5, len(shape)) + shape + bytes(-len(shape) % 8)
    body += struct.pack("<II", 1, len(label)) + label + bytes(-len(label) % 8)
    body += struct.pack("<II", 9, len(content)) + content + bytes(-len(content) % 8)
    return struct.pack("<II", 14, len(body)) + body


def element(kind: int, content: bytes, size: int | None = None) -> bytes:
    """One element of a MATLAB file, with a type and a size as they are told."""
    told = struct.pack("<II", kind, len(content) if size is None else size)
    return told + content + bytes(-len(content) % 8)


def variable(name: str, sides: tuple[int, ...], *contents: bytes, kind: int = 6) -> bytes:
    """One variable of a MATLAB file with these elements after its header."""
    head = array(name, sides, b"", kind)[8:-8]
    return element(14, head + b"".join(contents))


def sparse(rows: list[int], starts: list[int], values: list[float], **told: int) -> bytes:
    """A sparse matrix A of two rows and two columns, with positions as they are told."""
    ints = [struct.pack(f"<{len(each)}i", *each) for each in (rows, starts)]
    floats = struct.pack(f"<{len(values)}d", *values)
    kinds = {"first": 5, "last": 9} | told
    parts = [element(kinds["first"], ints[0]), element(5, ints[1])]
    return mat_of(
        variable("A", (2, 2), *parts, *[element(kinds["last"], floats)] * bool(values), kind=5)
    )


def cells(name: str, sides: tuple[int, ...], *elements: bytes) -> bytes:
    """A cell array of a MATLAB file."""
    empty = array(name, sides, b"", kind=1)[8:-8]
    body = empty + b"".join(elements)
    return struct.pack("<II", 14, len(body)) + body


def mat_of(*elements: bytes) -> bytes:
    """A MATLAB file of some elements."""
    return b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + b"".join(elements)


def compressed(element: bytes) -> bytes:
    """An element of a MATLAB file, compressed."""
    packed = zlib.compress(element)
    return struct.pack("<II", 15, len(packed)) + packed


def npz(**changed: Any) -> bytes:
    """An archive of numpy with some arrays changed, or left out if they are None."""
    stream: Any = io.BytesIO()
    arrays = {key: value for key, value in (GOOD | changed).items() if value is not None}
    np.savez(stream, **arrays)
    return stream.getvalue()


def archive(files: Mapping[str, bytes], compression: int = zipfile.ZIP_DEFLATED) -> bytes:
    """An archive of some files."""
    stream: Any = io.BytesIO()
    with zipfile.ZipFile(stream, "w", compression) as made:
        for name, content in files.items():
            made.writestr(name, content)
    return stream.getvalue()


def npy(header: str, content: bytes = b"") -> bytes:
    """An array of numpy with a header and contents as they are told."""
    line = header.encode().ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(line)) + line + content


def shaped(shape: str, content: bytes = b"", descr: str = "'<f8'") -> bytes:
    """An archive of numpy whose A has the shape that is told."""
    header = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}"
    return archive({"A.npy": npy(header, content)})


def shifted(data: bytes) -> bytes:
    """An archive whose first member is said to begin before the file."""
    end = data.rindex(b"PK\x05\x06")
    (directory,) = struct.unpack_from("<I", data, end + 16)
    return data[: end + 16] + struct.pack("<I", directory + 5000) + data[end + 20 :]


def csv(**changed: str | bytes) -> dict[str, bytes]:
    """The files of a folder with some changed, or left out if they are empty."""
    files = {"A": "0,1\n2,3\n", "B_1": "1\n0\n", "C_1": "1,0\n"} | changed
    return {
        f"{name}.csv": text.encode() if isinstance(text, str) else text
        for name, text in files.items()
    }


def cell(*values: Any) -> Any:
    """A cell array."""
    made = np.empty((1, len(values)), dtype=object)
    for k, value in enumerate(values):
        made[0, k] = value
    return made


def _sparse() -> bytes:
    """A sparse matrix whose columns point beyond its entries."""
    good = mat(compressed=False, A=scipy.sparse.csc_array(np.eye(2)))
    return good.replace(struct.pack("<3i", 0, 1, 2), struct.pack("<3i", 0, 10**9, 2))


EIGHT = struct.pack("<d", 1.0)
MAT: dict[str, tuple[bytes, str]] = {
    "negative sides": (mat_of(array("A", (-3, 2), EIGHT * 2)), "A: expected 0 to 1048576 rows"),
    "negative sides in a cell": (
        mat_of(cells("B", (1, 1), array("", (-3, 2), EIGHT * 2))), "B: expected 0 to 1048576 rows"
    ),
    "cells that are not there": (
        mat_of(cells("B", (1, 3), array("", (1, 1), EIGHT))), "B: the file is damaged: a cell array"
    ),
    "three dimensions": (mat(A=np.zeros((2, 2, 2))), "A: expected a matrix, found 3 dimensions, 2"),
    "3 GB": (mat_of(compressed(struct.pack("<II", 14, 2**31) + bytes(2**20))), "when decompressed"),
    "3 GB claimed": (mat_of(array("A", (20000, 20000), EIGHT)), "1 numbers do not fill 20000 × "),
    "a type that no element has": (
        mat_of(variable("A", (1, 1), element(41, EIGHT))), "A: .* found an element of type 41"
    ),
    "half a number": (mat_of(variable("A", (1, 1), element(9, EIGHT[:4]))), "4 bytes are no numb"),
    "two elements of numbers": (
        mat_of(variable("A", (1, 1), element(9, EIGHT), element(9, EIGHT))), "found 2"
    ),
    "floats as integers": (
        mat_of(variable("A", (1, 1), element(9, EIGHT), kind=12)), "class 12 does not hold"
    ),
    "integers beyond their class": (
        mat_of(variable("A", (1, 1), element(5, struct.pack("<i", 300)), kind=8)), "class 8 does"
    ),
    "a float beyond its precision": (
        mat_of(variable("A", (1, 1), element(9, struct.pack("<d", 0.1)), kind=7)), "class 7 does"
    ),
    "a size beyond the file": (mat_of(variable("A", (1, 1), element(9, EIGHT, 2**31))), "it ends"),
    "a short element that is long": (
        mat_of(variable("A", (1, 1), struct.pack("<HHI", 9, 8, 0))), "at most 4 bytes in a short"
    ),
    "flags of another type": (
        mat_of(element(14, element(5, bytes(8)) * 3)), "an array has no flags or no shape"
    ),
    "a name of another type": (
        mat_of(element(14, element(6, bytes(8)) + element(5, bytes(8)) + element(9, EIGHT))),
        "a name is of type 9"
    ),
    "version 2 in the header": (mat()[:124] + b"\0\2IM" + mat()[128:], "expected version 1 in"),
    "an incomplete compressed variable": (
        mat_of(element(15, zlib.compress(array("A", (1, 1), EIGHT))[:-9])), "variable is incomplete"
    ),
    "names as a matrix": (mat(names=np.eye(2)), "names: expected a cell array of texts"),
    "a text of two lines": (mat(time=np.array(["ab", "cd"])), "time: expected a text of one line"),
    "a text of numbers": (
        mat_of(variable("time", (1, 1), element(9, EIGHT), kind=4)), "time: .* no characters"
    ),
    "a text that is too short": (
        mat_of(variable("time", (1, 9), element(4, b"a\0"), kind=4)), "1 characters do not fill 9"
    ),
    "half a character": (mat_of(variable("time", (1, 1), element(16, b"\xc3"), kind=4)), "damaged"),
    "a sparse matrix without entries": (sparse([0], [0, 1, 1], []), "matrix is incomplete"),
    "positions as floats": (sparse([0, 1], [0, 1, 2], [1, 1], first=9), "positions are of type 9"),
    "columns that go back": (sparse([0, 1], [0, 2, 1], [1, 1]), "have no positions"),
    "too few columns": (sparse([0, 1], [0, 2], [1, 1]), "have no positions"),
    "fewer entries than positions": (sparse([0, 1], [0, 1, 3], [1, 1]), "fewer entries than"),
    "a row outside": (sparse([0, 7], [0, 1, 2], [1, 1]), "outside or not in order"),
    "a row twice": (sparse([1, 1], [0, 2, 2], [1, 1]), "outside or not in order"),
    "an unknown rounding": (mat(rounding="up"), "rounding: expected"),
    "sizes of other channels": (
        mat(B=cell(np.ones((2, 1))), C=cell(np.ones((1, 2))), inputs=[1.0, 1.0]),
        "inputs: expected the sizes of 1 channels, found 2"
    ),
    "too many entries": (
        mat(A=np.ones((400, 400), dtype=np.int8)), "at most 131072 entries that are not 0"
    ),
    "complex": (mat(A=np.array([[1j]])), "A: expected real numbers, found complex numbers"),
    "a struct": (mat(A={"x": 1}), "A: expected a matrix, found a struct"),
    "a text": (mat(A="hello"), "A: expected a matrix of numbers, found another class"),
    "a number as text": (mat(time=np.array([[1.0]])), "time: expected a text, found another class"),
    "a cell of texts": (mat(B=cell("x"), inputs=None), "B: expected a matrix of numbers, found"),
    "a cell in a cell": (mat(B=cell(cell(np.eye(2)))), "B: expected a matrix of numbers"),
    "a cell as A": (mat(A=cell(np.eye(2))), "A: expected a matrix, found a cell array"),
    "NaN": (mat(A=np.array([[np.nan, 0], [0, 1]])), "A: expected finite numbers, found nan"),
    "an infinity": (mat(A=np.array([[-np.inf, 0], [0, 1]])), "A: expected finite numbers"),
    "a misspelled variable": (mat(inputz=[1.0]), r"'inputz' \(did you mean 'inputs'\?\)"),
    "another variable": (mat(ans=[1.0]), "unknown variable 'ans'; known are A, B_1, C_1"),
    "no sizes": (mat(inputs=None), "B is stacked, and 'inputs' is missing.* --inputs 1,1 -o"),
    "no A": (mat(A=None), "the matrix A is missing"),
    "no C": (mat(C=None), "the matrix C is missing"),
    "sizes that are no integers": (mat(inputs=[0.5]), "inputs: expected a list of integers"),
    "a table of sizes": (mat(inputs=np.ones((2, 2))), "inputs: expected a list of integers"),
    "wrong sizes": (mat(inputs=[2.0]), "B: expected 2 columns, found 1"),
    "feedthrough": (mat(D=np.array([[1.0, 2.0]])), "D: expected 1 column, found 2"),
    "a truncated file": (mat(compressed=False)[:300], "damaged"),
    "half a compressed file": (mat()[:200], "damaged"),
    "half a header": (mat()[:130], "damaged"),
    "no byte order": (mat()[:126] + b"XX" + mat()[128:], "its byte order is unknown"),
    "noise after the header": (mat()[:128] + bytes(range(200)), "damaged"),
    "a variable given twice": (mat_of(*[array("A", (1, 1), EIGHT)] * 2), "'A' is given twice"),
    "no header of an array": (mat_of(struct.pack("<II", 14, 0)), "an array has no header"),
    "a sparse matrix out of bounds": (_sparse(), "damaged|cannot read"),
    "a long side": (mat_of(array("A", (2**21, 0), b"")), "0 to 1048576 rows and columns"),
    "version 7.3": (b"MATLAB 7.3 MAT-file, \x00", "an HDF5 file of MATLAB: save it with .* -v7"),
    "version 4": (struct.pack("<5i", 0, 1, 1, 0, 2) + b"A\0" + EIGHT, "version 5: save it with"),
}  # fmt: skip
NPZ: dict[str, tuple[bytes, str]] = {
    "objects": (npz(A=np.array([[{}]], dtype=object)), "A: expected numbers or texts"),
    "a structured array": (npz(A=np.zeros(2, dtype="f8,i4")), "A: expected numbers or texts"),
    "complex": (npz(A=np.array([[1j]])), "A: expected real numbers, found complex numbers"),
    "dates": (npz(A=np.array([["2020-01-01"]], dtype="datetime64[D]")), "entries of type datetime"),
    "NaN": (npz(A=np.array([[np.nan]])), "A: expected finite numbers, found nan"),
    "negative sides": (shaped("(-3, 2)", EIGHT * 2), "A: expected 0 to 1048576 rows"),
    "3 GB claimed": (shaped("(20000, 20000)", EIGHT), "8 bytes do not hold 20000 × 20000 entries"),
    "true as a side": (shaped("(True, 1)", EIGHT), "A: .* its shape is not of integers"),
    "nothing, often": (shaped("(1000000000, 1000000000)", b"", "'<U0'"), "bytes do not hold"),
    "many columns of nothing": (shaped("(0, 1000000000)"), "A: expected 0 to 1048576 rows"),
    "three dimensions": (npz(A=np.zeros((1, 1, 1))), "A: expected a matrix, found 3 dimensions"),
    "one dimension": (npz(A=np.zeros(4)), "A: expected a matrix, found 1 dimensions, 4"),
    "a zip bomb": (archive({"A.npy": bytes(2**21)}), "when decompressed"),
    "a program as header": (archive({"A.npy": npy("__import__('os')")}), "A: the array is damaged"),
    "no header": (archive({"A.npy": b"xyz"}), "A: the array is damaged"),
    "an unknown version": (archive({"A.npy": b"\x93NUMPY\x09\x00"}), "version of this array"),
    "a misspelled array": (npz(AA=np.eye(2)), r"unknown array 'AA'"),
    "a number as name": (npz(names=np.array([1])), "names: expected texts"),
    "a list as time": (npz(time=np.array(["discrete"])), "time: expected a text"),
    "a text that is no number": (npz(A=np.array([["0,5"]])), "A.*: expected an integer, a decimal"),
    "half an archive": (npz()[:200], "the archive is damaged"),
    "half of numpy's and half of others": (
        archive({"A.npy": b"", "B.txt": b""}), "an archive, but not one of .npy or .csv files"
    ),
    "a negative position": (shifted(npz()), "the archive is damaged: negative"),
    "a way to compress": (archive({"A.npy": b""}, zipfile.ZIP_BZIP2), "in a way that is not read"),
    "no character": (
        shaped("(1, 1)", struct.pack("<I", 0x110000), "'<U1'"), "A: .* has a character that is none"
    ),
    "a spreadsheet": (archive({"xl/workbook.xml": b""}), "an archive, but not one of"),
    "a single array": (npy("{}"), "a single array: put A, B_1, C_1"),
    "a pickle": (pickle.dumps([[1.0]]), "a pickle, which could run any program"),
    "HDF5": (b"\x89HDF\r\n\x1a\n", "an HDF5 file: write its matrices"),
    "a gap": (npz(B=None, C=None, B_1=np.eye(2), C_1=np.eye(2), B_3=np.eye(2)), "B_2 is miss"),
    "both kinds": (npz(B_1=np.eye(2), C_1=np.eye(2)), "both stacked matrices"),
}  # fmt: skip
CSV: dict[str, tuple[dict[str, bytes], str]] = {
    "ragged": (csv(A="1,2\n3\n"), "A.csv: expected 2 entries in row 2 as in row 1, found 1"),
    "decimal commas": (csv(A='"0,5",1\n2,3\n'), r"A.csv: found '0,5': write decimals with a point"),
    "semicolons": (csv(A="0,5;1\n2;3\n"), "A.csv: found '5;1': write decimals with a point"),
    "NaN": (csv(A="NaN,1\n2,3\n"), r"A\[0\]\[0\]: expected an integer, a decimal"),
    "tabs": (csv(A="0\t1\n2\t3\n"), r"A\[0\]\[0\]: expected an integer, a decimal"),
    "a heading": (csv(A="x1,x2\n0,1\n2,3\n"), r"A\[0\]\[0\]: expected an integer"),
    "not square": (csv(A="0,1\n"), "B_1: expected 1 row, found 2"),
    "another encoding": (csv(A=b"\xff\xfe0"), "A.csv: not UTF-8 text: byte 0"),
    "a NUL": (csv(A="0,1\n2,\0\n"), r"A\[1\]\[1\]: expected an integer|A.csv: no table"),
    "an open quote": (csv(A='"0,1\n2,3\n'), "A.csv: no table of entries between commas"),
    "a long number": (csv(A=f"{'1' * 5000},1\n2,3\n"), "4300 digits"),
    "an unknown table": (csv(notes="hello"), "notes.csv: unknown table 'notes'"),
    "time as a table": (csv(time="discrete"), "time.csv: write it into system.csv"),
    "a setting too many": (csv(system="colour,red\n"), "system.csv: expected time, sample_time"),
    "a setting twice": (csv(system="time,discrete\ntime,discrete\n"), "each at most once"),
    "a long key": (csv(system=f"{'x' * 9000},1\n"), "system.csv: .* found 'x{40}'…"),
    "a sample time twice": (csv(system="sample_time,1\nsample_time,2\n"), "each at most once"),
    "a rounding": (csv(rounding="decimal"), "rounding.csv: leave it out"),
    "a rounding as a setting": (csv(system="rounding,decimal\n"), "expected time, sample_time"),
    "sizes of other channels": (csv(inputs="1,1\n"), "inputs: expected the sizes of 1 channels"),
    "another size": (csv(outputs="2\n"), "C_1: expected 2 rows, found 1"),
    "a setting of three": (csv(system="time,a,b\n"), "expected lines 'key,value', found 3 entries"),
    "an unknown time": (csv(system="time,now\n"), "now"),
    "two names on a line": (csv(names="a,b\n"), "names.csv: expected one name on each line"),
    "names too many": (csv(names="a\nb\n"), "names: expected 1 names, found 2"),
    "delays alone": (csv(delays="0\n"), "delays: delays need links"),
    "a neighbor of two": (csv(neighbors="2\n"), "neighbors: expected zeros and ones"),
    "half a step": (csv(neighbors="0\n", delays="1/2\n"), "delays: expected integers"),
    "a delay without link": (csv(neighbors="0\n", delays="1\n"), "delay"),
    "no outputs": ({k: v for k, v in csv().items() if k != "C_1.csv"}, "C_1 is missing; it may be"),
}
YAML: dict[str, tuple[str, str]] = {
    "aliases": ("a: &a [x, x]\nb: [*a, *a]\n", "anchors are not read: .* at line 1"),
    "an alias of nothing": ("a: *b\n", "anchors are not read|not YAML"),
    "a program": ("!!python/object/apply:os.system [x]\n", "tags are not read"),
    "a key twice": ("A: [[0]]\nA: [[1]]\n", "the key 'A' is given twice"),
    "a list as key": ("? [a]\n: 1\n", "expected a text as key at line 1"),
    "a tab": ("A:\n\t- 1\n", "not YAML: .* at line 2, column 1"),
    "an empty file": ("# nothing\n", "expected an object, found an empty file"),
    "deep": ("[" * 40 + "]" * 40, "expected at most 16 nested levels"),
    "base 8 or 10": ("a: [1, 010]\n", "the number 010 at line 1"),
    "a list of a sign": ("a:\n- -007.5\n", "the number -007.5 at line 2"),
    "two documents": ("a: 1\n---\nb: 2\n", "not YAML: .* at line"),
    "another format": ("format: other/1\n", "expected \"mcexact-system/1\", found 'other/1'"),
    "noise": ("\x01", "not YAML"),
    "yes as a number": (
        "format: mcexact-system/1\ntime: continuous\nA: [[yes]]\n"
        "channels: [{B: [[1]], C: [[1]]}]\n", r"A\[0\]\[0\]: expected an integer"
    ),
    "a name that is a number": (
        "format: mcexact-system/1\ntime: continuous\nA: [[1]]\n"
        "channels: [{name: 1, B: [[1]], C: [[1]]}]\n", r"channels\[0\].name: expected a name as a"
    ),
}  # fmt: skip
TEXTS: dict[str, tuple[bytes, str]] = {
    "a MATLAB script": (b"A = [1 2; 3 4]\n", "not JSON: found 'A' at the beginning; a system file"),
    "TOML": (b"[[A]]\n", "not JSON: expected a value|not JSON"),
    "a picture": (b"\x89PNG\r\n\x1a\n", "not JSON: found the byte 0x89 at the beginning"),
    "a missing value": (b'{"A": ,}', "not JSON: expected a value at line 1, column 7"),
    "an empty file": (b"", "expected a JSON object, found an empty file"),
    "null": (b" null\n", 'expected a JSON object with "format": .*, found null'),
    "a text": (b'"A"', "expected a JSON object with .*, found the string 'A'"),
}
