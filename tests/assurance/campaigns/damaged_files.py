"""Damaged files of every format: none ends the interpreter, is not refused in words, or takes long.

    python -m tests.assurance.campaigns.damaged_files [COUNT [FIRST [FILE]]]

Of each format, COUNT damaged files are read by every reader that takes it, in child processes whose
time and memory are limited.  A failure is a death by a signal, an error that is none of the
package's or would end the command line with status 70, or more than five seconds of a processor.
The files of failures are kept beside FILE.  A file is a function of its format and number.
"""

from __future__ import annotations

import io
import json
import os
import random
import resource
import shutil
import struct
import sys
import tempfile
import time
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse
import yaml

from mcexact.errors import McexactError
from mcexact.exact.matrix import matrix_to_float
from mcexact.model.arrays import csv_texts, mat_bytes, npz_bytes, parts_of
from mcexact.model.controller import load_controller
from mcexact.model.files import load_parametric_system, load_system
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system
from tests.assurance.campaigns import controller_grammar, grammar
from tests.assurance.campaigns.grammar_tokens import BYTES, KEYS, NASTY
from tests.assurance.campaigns.resumed import Examined, main

FILE = Path("build") / "damaged-files.jsonl"
BATCH = 100
"""The number of files of each format in one row."""
MOST_SECONDS = 5.0
MOST_BYTES = 3 * 2**30
"""What a process may map, with the libraries that it has loaded."""
EXTREMES = [0, 1, -1, 2, 7, 14, 15, 41, 255, 256, 2**15, 2**16, 2**20, 2**24, 2**31 - 1, -(2**31)]
TYPES = ["<f8", ">f8", "<f4", "<f2", "<f16", "<i8", "|i1", "<u8", "|b1", "|O", "<U3", ">U3", "<U0"]
TYPES += ["|S4", "|V8", "<c16", "<M8[D]", "<m8[s]", "(2,)<f8", "f8,i4", "<U99999999", "", "<", "x"]
SHAPES = ["()", "(1,)", "(-1, 2)", "(2, -1)", "(0, 0)", "(0, 9)", "(10**9, 10**9)", "(1, 1, 1)"]
SHAPES += ["(1e9, 1)", "(True, 2)", "((1, 2), 3)", "(2147483648, 0)", "(99999999999999999999, 1)"]
SHAPES += [
    "(" * 90 + "1" + ")" * 90,
    "(" * 9000,
    "-" * 9000 + "1",
    "[1, 1]",
    "None",
    "'x'",
    "(1L, 1L)",
]
Rng = random.Random


def drawn_system(rng: Rng) -> MultiChannelSystem:
    """A system with names, neighbors, delays, texts, sample time, or none of these."""
    text = grammar.text_of(grammar.drawn_document(rng), rng)
    return read_system(text.encode("utf-8", "surrogatepass"))


def within_floats(system: MultiChannelSystem) -> bool:
    """Whether no number is beyond the range of floats."""
    tables = parts_of(system).tables.values()
    return all(bool(np.all(np.isfinite(matrix_to_float(M)))) for M in tables)


def extreme(rng: Rng) -> bytes:
    """An integer of 2, 4 or 8 bytes at which sizes and positions go wrong, in either byte order."""
    size = rng.choice([2, 4, 4, 4, 8])
    value = rng.choice([*EXTREMES, rng.getrandbits(62)]) % 2 ** (8 * size)
    return value.to_bytes(size, rng.choice(["little", "big"]))


def damaged(data: bytes, rng: Rng, tokens: list[bytes] | None = None) -> bytes:
    """Change a few places: bits, bytes, integers, slices that move, the end."""
    found = bytearray(data)
    for _ in range(rng.choice([1, 1, 1, 2, 3, 9])):
        at = rng.randrange(len(found) + 1)
        size = rng.choice([1, 1, 2, 4, 8, 16, rng.randrange(len(found) + 1)])
        what = rng.randrange(9)
        if what == 0 and found:
            found[at % len(found)] ^= 1 << rng.randrange(8)
        elif what == 1 and found:
            found[at % len(found)] = rng.choice([0, 1, 41, 127, 128, 255, rng.randrange(256)])
        elif what == 2:
            number = extreme(rng)
            at -= at % rng.choice([1, 4, 8])
            found[at : at + len(number)] = number
        elif what == 3 and rng.random() < 0.3:
            del found[at:]
        elif what == 4:
            del found[at : at + size]
        elif what == 5:
            found[at:at] = found[(start := rng.randrange(len(found) + 1)) : start + size]
        elif what == 6:
            found[at : at + size] = rng.randbytes(min(size, 64))
        elif what == 7 and tokens:
            found[at : at + rng.choice([0, 0, 1, 3])] = rng.choice(tokens)
        else:
            start = rng.randrange(len(found) + 1)
            one, two = found[at : at + size], found[start : start + size]
            found[at : at + size], found[start : start + size] = two, one
    return bytes(found)


def _tokens() -> list[bytes]:
    """What is put into texts: values, keys, bytes, nesting, and marks of YAML and of tables."""
    found = [token.encode("utf-8", "surrogatepass") for token in [*NASTY, *KEYS]] + BYTES
    found += [
        mark * size
        for mark in (b"[", b"{", b"- ", b"? ", b"a: ", b'"', b"\n")
        for size in (17, 5000)
    ]
    found += [
        b"&a ",
        b"*a",
        b"!!int ",
        b"!",
        b"%YAML 1.1\n",
        b"---\n",
        b"...\n",
        b"|\n",
        b">\n",
        b"<<: ",
    ]
    found += [
        b"010",
        b"0x1F",
        b"1:30",
        b"~",
        b"\t",
        b"\r",
        b";",
        b'""',
        b"'",
        b"#",
        b"9" * 10**5,
        b"-" * 5000,
    ]
    return found


TOKENS = _tokens()


def mat_file(rng: Rng) -> bytes:
    """A file of MATLAB, damaged in its plain elements or as it is stored."""
    system = drawn_system(rng)
    if rng.random() < 0.3 and within_floats(system):
        good = mat_bytes(parts_of(system), None, nearest=True)
    else:
        good = _stacked_mat(system, rng, compressed=rng.random() < 0.3)
    if rng.random() < 0.3:
        return damaged(good, rng)
    plain = _decompressed(good)
    head, body = plain[:128], bytearray(plain[128:])
    for _ in range(rng.choice([1, 1, 2, 4])):  # words of tags, flags, shapes and positions
        at = 4 * rng.randrange(len(body) // 4)
        (old,) = struct.unpack_from("<I", body, at)
        new = rng.choice(
            [rng.choice(EXTREMES), rng.randrange(64), old + rng.choice([-8, -4, -1, 1, 4, 8])]
        )
        struct.pack_into("<I", body, at, new % 2**32)
    changed = bytes(body) if rng.random() < 0.6 else damaged(bytes(body), rng)
    if rng.random() < 0.5:
        return head + changed
    return head + b"".join(_compressed(changed))


def _stacked_mat(system: MultiChannelSystem, rng: Rng, compressed: bool) -> bytes:
    """A file as MATLAB writes it, with matrices of several classes, some of them sparse."""

    def array(M: Any) -> Any:
        small = np.clip(np.nan_to_num(np.round(matrix_to_float(M))), -99, 99)
        kind = rng.choice(["f8", "f8", "f4", "i1", "u1", "i2", "i4", "i8", "u8", "?", "sparse"])
        return scipy.sparse.csc_array(small) if kind == "sparse" else np.abs(small).astype(kind)

    m = range(system.m)
    variables = {"A": array(system.A), "time": str(system.time), "names": _cell(system.names)}
    variables |= {"B": _cell([array(system.channels[k].B) for k in m])}
    variables |= {"C": _cell([array(system.channels[k].C) for k in m])}
    if rng.random() < 0.5:
        variables |= {
            "neighbors": np.eye(system.m),
            "delays": scipy.sparse.csc_array((system.m, system.m)),
        }
    stream: Any = io.BytesIO()
    scipy.io.savemat(stream, variables, do_compression=compressed)
    found: bytes = stream.getvalue()
    return found


def _cell(values: Any) -> Any:
    """A row of cells."""
    made = np.empty((1, len(values)), dtype=object)
    for k, value in enumerate(values):
        made[0, k] = value
    return made


def _elements(data: bytes) -> Iterator[tuple[int, bytes]]:
    """The type of each whole element of a file of MATLAB, and its bytes."""
    at = 0
    while at + 8 <= len(data):
        kind, size = struct.unpack_from("<II", data, at)
        end = at + 8 + size
        yield kind, data[at:end]
        at = end


def _decompressed(data: bytes) -> bytes:
    """A file of MATLAB that is not compressed."""
    found = data[:128]
    for kind, element in _elements(data[128:]):
        found += zlib.decompress(element[8:]) if kind == 15 else element
    return found


def _compressed(body: bytes) -> Iterator[bytes]:
    """The elements of a file of MATLAB, compressed as far as they can be told apart."""
    for _, element in _elements(body):
        packed = zlib.compress(element)
        yield struct.pack("<II", 15, len(packed)) + packed


def npz_file(rng: Rng) -> bytes:
    """An archive of numpy, damaged in an array, in its header, or as an archive."""
    system = drawn_system(rng)
    made = npz_bytes(parts_of(system), None, nearest=rng.random() < 0.3 and within_floats(system))
    if rng.random() < 0.2:
        return damaged(made, rng)
    with zipfile.ZipFile(io.BytesIO(made)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    for name in rng.sample(sorted(members), rng.choice([0, 1, 1, 1, 2])):
        members[name] = _damaged_array(members[name], rng)
    return _zipped(members, rng)


def _damaged_array(data: bytes, rng: Rng) -> bytes:
    """An array of numpy with another header, other contents, or other bytes."""
    size = 10 + struct.unpack_from("<H", data, 8)[0]
    content = data[size:]
    if rng.random() < 0.4:
        content = damaged(content, rng)
    elif content and rng.random() < 0.4:
        at = 4 * rng.randrange((len(content) + 3) // 4)  # a character of a text, or half a number
        code = rng.choice([0xD800, 0x10FFFF, 0x110000, 2**31, 2**32 - 1, 0, 0x202E, 10])
        content = content[:at] + struct.pack(rng.choice("<>") + "I", code) + content[at + 4 :]
    header = data[10:size].decode("latin-1")
    said = eval(header, {})  # as the writer of numpy made it
    shape, kind = str(said["shape"]), repr(said["descr"])
    if rng.random() < 0.3:
        shape = rng.choice(SHAPES)
    if rng.random() < 0.3:
        kind = rng.choice([repr(rng.choice(TYPES)), "[('a', '<f8')]", "[" * 500, "{}", "None", "9"])
    order = rng.choice(["False", "False", "True", "None", "2"])
    line = f"{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}".encode() + b"\n"
    version = rng.choice([1, 1, 1, 1, 2, 3, 0, 255])
    length = len(line) if rng.random() < 0.9 else rng.choice([0, 1, 65535, len(line) - 1])
    made = b"\x93NUMPY" + bytes([version, 0])
    made += struct.pack("<I" if version > 1 else "<H", length % 65536) + line + content
    return damaged(made, rng) if rng.random() < 0.1 else made


def _zipped(members: dict[str, bytes], rng: Rng) -> bytes:
    """An archive, some of whose records are damaged, or whose members are doubled or renamed."""
    stream = io.BytesIO()
    way = rng.choice([zipfile.ZIP_DEFLATED] * 4 + [zipfile.ZIP_STORED] * 4 + [zipfile.ZIP_LZMA])
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in members.items():
            if rng.random() < 0.02:
                name = rng.choice(
                    ["A.npy", "../A.npy", "A", "x/", "\udc80.npy", "B_0.npy", "B_999999.npy", ""]
                )
            archive.writestr(
                zipfile.ZipInfo(name.encode("utf-8", "replace").decode()), content, way
            )
    data = stream.getvalue()
    if rng.random() < 0.4:
        mark = rng.choice([b"PK\x01\x02", b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06"])
        places = [at for at in range(len(data)) if data.startswith(mark, at)]
        at = rng.choice(places) + rng.randrange(
            4, {b"PK\x01\x02": 46, b"PK\x03\x04": 30}.get(mark, 22)
        )
        changed = extreme(rng)
        data = data[:at] + changed + data[at + len(changed) :]
    return damaged(data, rng) if rng.random() < 0.1 else data


def csv_files(rng: Rng) -> dict[str, bytes]:
    """The files of a folder, some of them damaged, renamed, exchanged or missing."""
    files = {name: text.encode() for name, text in csv_texts(parts_of(drawn_system(rng))).items()}
    if rng.random() < 0.2:
        files |= {
            f"{name}.csv": rng.choice([b"1\n", b"", b"0,0\n"])
            for name in ("inputs", "outputs", "D")
        }
    for _ in range(rng.choice([1, 1, 2, 3])):
        name, other = rng.choice(sorted(files)), rng.choice(sorted(files))
        what = rng.randrange(8)
        if what == 0:
            files[name], files[other] = files[other], files[name]
        elif what == 1:
            files[rng.choice(["B_3.csv", "rounding.csv", "delays.csv", "x.csv", "B.csv"])] = files[
                name
            ]
        elif what == 2 and name != "A.csv":
            del files[name]
        else:
            files[name] = damaged(files[name], rng, TOKENS)
    return files


def json_file(rng: Rng) -> bytes:
    """A system, a system with parameters, or a controller in JSON, damaged as text or as bytes."""
    kind = rng.randrange(4)
    document = controller_grammar.drawn_document(rng) if kind == 0 else grammar.drawn_document(rng)
    if kind == 1:
        document.pairs.append(['"parameters"', _parameters(rng)])
        rows = [each for each in grammar.containers(document) if isinstance(each, list) and each]
        for row in rows:
            if isinstance(row[0], grammar.Token) and rng.random() < 0.5:
                row[rng.randrange(len(row))] = grammar.Token(rng.choice(EXPRESSIONS))
    data, _ = grammar.damaged_file(document, rng)
    return damaged(data, rng, TOKENS) if rng.random() < 0.6 else data


EXPRESSIONS = [
    '"t"',
    '"1/t"',
    '"(t + 1)^9"',
    '"t^1000"',
    '"t^99999999"',
    '"((((t))))"',
    '"-t*-s/(t - t)"',
    '"t^t"',
    '"1/(t^200 - s^200)^9"',
    '"' + "(" * 5000 + '"',
    '"t' + "+t" * 2000 + '"',
    '"u"',
    '"2t"',
    '"t.5"',
]


def _parameters(rng: Rng) -> grammar.Token:
    """What the key ``parameters`` says."""
    said = [
        "{}",
        '{"range": [0, 1]}',
        '{"range": [null, "1/2"]}',
        '{"range": [1, 0]}',
        '{"range": 1}',
        '{"range": [0, 1e999]}',
        "null",
    ]
    names = rng.sample(
        ['"t"', '"s"', '"t1"', '""', '"i"', '"time"', '"\\u00e9"'], rng.choice([1, 1, 2])
    )
    return grammar.Token("{" + ", ".join(f"{name}: {rng.choice(said)}" for name in names) + "}")


def yaml_file(rng: Rng) -> bytes:
    """The same in YAML, by lines or in brackets."""
    if rng.random() < 0.3:
        return json_file(rng)
    document = (
        controller_grammar.drawn_document(rng)
        if rng.random() < 0.2
        else grammar.drawn_document(rng)
    )
    plain = json.loads(
        grammar.text_of(document, Rng(0)).encode("utf-8", "surrogatepass"),
        parse_int=str,
        parse_float=str,
    )
    text = yaml.dump(
        plain,
        Dumper=yaml.CSafeDumper,
        default_flow_style=rng.choice([None, False, True]),
        allow_unicode=rng.random() < 0.5,
        sort_keys=False,
    )
    if rng.random() < 0.5:
        text = text.replace("'", "")  # numbers as numbers, and some names that are none
    return damaged(text.encode("utf-8", "surrogatepass"), rng, TOKENS)


Made = bytes | dict[str, bytes]
Read = Callable[[Path], Any]


def _read_system(path: Path) -> None:
    load_system(path).digest()


def _read_rounded(path: Path) -> None:
    load_system(path, rounding="decimal").digest()


FORMATS: dict[str, tuple[str, Callable[[Rng], Made], tuple[Read, ...]]] = {
    "mat": ("plant.mat", mat_file, (_read_system, _read_rounded)),
    "npz": ("plant.npz", npz_file, (_read_system, _read_rounded)),
    "csv": ("plant", csv_files, (_read_system,)),
    "yaml": ("plant.yaml", yaml_file, (_read_system, load_parametric_system)),
    "json": ("plant.json", json_file, (_read_system, load_parametric_system, load_controller)),
}
"""Name, maker and readers of the files of each format."""


def made_file(form: str, number: int) -> Made:
    """The damaged file of a format with a number."""
    return FORMATS[form][1](Rng(f"{form} {number}"))


def write(made: Made, path: Path) -> None:
    """Write a file, or a folder of files with their names as far as they are names."""
    if isinstance(made, bytes):
        path.write_bytes(made)
        return
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir()
    for name, content in made.items():
        (path / name).write_bytes(content)


def outcome(reader: Read, path: Path) -> str:
    """What a reader says of a file: accepted, refused, or an error that is a failure."""
    try:
        reader(path)
    except McexactError as error:
        message = str(error)
        if error.exit_status == 70:
            return f"status 70: {message[:200]}"
        return (
            "refused"
            if "\n" not in message and len(message) < 5000
            else f"a long message: {message[:200]!a}"
        )
    except BaseException as error:
        return f"{type(error).__name__}: {str(error)[:200]}"
    return "accepted"


def _read_in_child(form: str, numbers: list[int], folder: Path, pipe: int) -> None:
    """Read files one after another, and tell the number and the outcome of each."""
    name, _, readers = FORMATS[form]
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    with os.fdopen(pipe, "w", encoding="utf-8", buffering=1) as told:
        for number in numbers:
            write(made_file(form, number), folder / name)
            for reader in readers:
                start = time.process_time()
                # The processor's time of the whole process, after which the kernel ends it.
                resource.setrlimit(
                    resource.RLIMIT_CPU, (int(start + 2 * MOST_SECONDS) + 1, resource.RLIM_INFINITY)
                )
                found = outcome(reader, folder / name)
                seconds = time.process_time() - start
                if seconds > MOST_SECONDS:
                    found = f"{seconds:.1f} seconds of a processor, then {found}"
                print(json.dumps([number, reader.__name__, found]), file=told)


def read_files(form: str, numbers: list[int], folder: Path) -> Iterator[tuple[int, str]]:
    """Number and outcome of each file and reader; a process that dies is followed by another."""
    while numbers:
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            status = 1
            try:
                os.close(reading)
                sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
                _read_in_child(form, numbers, folder, writing)
                status = 0
            finally:
                os._exit(status)
        os.close(writing)
        counted: Counter[int] = Counter()
        with os.fdopen(reading, encoding="utf-8") as told:
            for line in told:
                number, _, found = json.loads(line)
                counted[number] += 1
                yield number, found
        _, status = os.waitpid(child, 0)
        left = [number for number in numbers if counted[number] < len(FORMATS[form][2])]
        if left:
            yield left[0], f"the process died: signal {status & 127}, status {status >> 8}"
        numbers = left[1:]


def examined(number: int, kept: Path = FILE.parent / "damaged-files") -> Examined:
    """What is wrong with one batch of files of each format, and how many were read."""
    wrong, seen = [], Counter[str]()
    numbers = list(range(number * BATCH, (number + 1) * BATCH))
    with tempfile.TemporaryDirectory() as place:
        for form in FORMATS:
            seen[f"{form} files"] += len(numbers)
            for each, found in read_files(form, numbers, Path(place)):
                seen[
                    f"{form} {found}" if found in ("accepted", "refused") else f"{form} failures"
                ] += 1
                if found not in ("accepted", "refused"):
                    path = kept / f"{form}-{each}" / FORMATS[form][0]
                    path.parent.mkdir(parents=True, exist_ok=True)
                    write(made_file(form, each), path)
                    wrong.append(f"{path}: {found}")
    return wrong, seen


if __name__ == "__main__":
    count, *rest = [*sys.argv[1:], "20000"][: max(1, len(sys.argv) - 1)]
    batches = str(-(-int(count) // BATCH))
    sys.exit(main([batches, *rest], 200, FILE, examined, "failures", "batch"))
