"""load_system and save_system: which kind of file some bytes are.

`load_system`, `load_parametric_system` and `save_system` are the functions for users; `read_any`
and `read_plant` read the bytes that `read_input` returns.  MATLAB files and archives are
recognized by their first bytes, YAML by the end of the name; other texts are JSON.  A folder of
.csv files is read as an archive, and archives are decompressed only up to the limit on the size
of a file.  Files of other programs are refused with a hint how to save them.  The YAML reader
accepts what JSON can express, and refuses anchors, tags and numbers that versions of YAML read
differently.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.errors import InputError, MissingExtra, UsageError, place_of, warn_of_rounding
from mcexact.exact.matrix import Rounding
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model import arrays, gallery
from mcexact.model.arrays import (
    AS_TYPED,
    Parts,
    Reading,
    csv_texts,
    mat_bytes,
    npz_bytes,
    parts_of,
    system_of,
    write_csv_files,
)
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem, any_system
from mcexact.model.system_file import read_document, read_parametric_document, system_text
from mcexact.model.text import (
    JsonObject,
    NumberText,
    parse,
    quoted,
    read_bytes,
    require_short_numbers,
    require_start,
    write_bytes,
)

# Zip archives, decompressed up to the limit on the size of a file.


def members(data: bytes, limits: Limits) -> dict[str, bytes]:
    """Return the contents of all files in an archive, by name.

    Raises
    ------
    InputError
        If it is damaged or encrypted, names a file twice, or is too large when decompressed.
    """
    contents: dict[str, bytes] = {}
    size = 0
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for member in archive.infolist():
                if member.filename.endswith("/"):
                    continue
                if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                    raise InputError(
                        f"the file {quoted(member.filename)} of the archive is compressed in a way "
                        "that is not read: expected 'deflate' or none"
                    )
                if member.filename in contents:
                    raise InputError(f"the archive has two files {quoted(member.filename)}")
                with archive.open(member) as stream:
                    content = stream.read(limits.bytes + 1 - size)
                size += len(content)
                if size > limits.bytes:
                    raise InputError(
                        f"expected at most {limits.bytes} bytes when decompressed (Limits.bytes), "
                        "found more"
                    )
                contents[member.filename] = content
    except InputError:
        raise
    except Exception as error:  # of zipfile, which raises all kinds for a damaged archive
        fault = ascii(str(error))[1:-1][:200] or type(error).__name__
        raise InputError(f"the archive is damaged: {fault}") from None
    return contents


# System files in YAML: the keys of the JSON format, and numbers as typed.

_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?", re.ASCII)
_SHORT = re.compile(r"-?[0-9]{1,17}", re.ASCII)
_LEADING_ZERO = re.compile(r"[-+]?0[0-9_]+([.eE].*)?", re.ASCII)
_CONSTANTS = {"null": None, "true": True, "false": False}


def read_yaml(data: bytes, limits: Limits) -> Any:
    """Parse one YAML document as that of JSON is parsed.

    A plain scalar that is a value of JSON is this value, a number as typed; every other scalar is a
    text, also ``yes`` and ``1e3_0``.  Anchors, tags and numbers such as ``010`` are refused: that
    is 8 in YAML 1.1, and 10 in YAML 1.2.  A file of JSON, which is valid YAML 1.2, is read as JSON.

    Raises
    ------
    InputError
        If it is malformed, repeats a key, or is nested too deeply.
    MissingExtra
        If PyYAML is not installed.
    """
    with MissingExtra.named("yaml"):
        import yaml
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text: byte {error.start}") from None
    if text.lstrip()[:1] == "{":
        with contextlib.suppress(InputError):
            return parse(text, limits)
    try:
        return _plain(yaml, text, limits)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        problem = getattr(error, "problem", None) or str(error).partition("\n")[0]
        raise InputError(f"not YAML: {problem}{place}") from None


def _plain(yaml: Any, text: str, limits: Limits) -> Any:
    """The plain data of the only document, read in one pass over the events of the parser.

    Anchors, which can expand beyond the memory, and deep nesting are refused where they begin.  The
    parser in C is used where it is installed, since it is ten times as fast.
    """
    open_: list[_Open] = [_Open([])]
    for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
        line = event.start_mark.line + 1
        if isinstance(event, yaml.ScalarEvent):
            _require_plain(event, line)
            open_[-1].add(event.value, event.implicit[0], line)
        elif isinstance(event, yaml.CollectionStartEvent):
            _require_plain(event, line)
            open_[-1].require_value(line)
            if len(open_) > limits.depth:
                raise InputError(f"expected at most {limits.depth} nested levels (Limits.depth)")
            open_.append(_Open([] if isinstance(event, yaml.SequenceStartEvent) else JsonObject()))
        elif isinstance(event, yaml.CollectionEndEvent):
            closed = open_.pop().container
            open_[-1].put(closed)
        elif isinstance(event, yaml.AliasEvent):
            raise _anchored(line)
        elif isinstance(event, yaml.DocumentStartEvent) and open_[0].container:
            raise InputError(f"not YAML: expected a single document, found another at line {line}")
    if not open_[0].container:
        raise InputError("expected an object, found an empty file")
    return open_[0].container[0]


def _require_plain(event: Any, line: int) -> None:
    """Refuse an anchor and a tag."""
    if event.anchor is not None:
        raise _anchored(line)
    if event.tag is not None:
        raise InputError(f"tags are not read, found one at line {line}")


def _anchored(line: int) -> InputError:
    return InputError(f"anchors are not read: write the value out at line {line}")


@dataclass
class _Open:
    """A list or an object that is being read, and the key whose value comes next."""

    container: Any
    key: str | None = None

    def add(self, text: str, plain: bool, line: int) -> None:
        """Take a scalar as a key or as a value."""
        if isinstance(self.container, dict) and self.key is None:
            if text in self.container:
                raise InputError(f"the key {text[:40]!a} is given twice")
            self.key = text
        else:
            self.put(_value(text, line) if plain else text)

    def require_value(self, line: int) -> None:
        """Refuse a list or an object as a key."""
        if isinstance(self.container, dict) and self.key is None:
            raise InputError(f"expected a text as key at line {line}")

    def put(self, value: Any) -> None:
        """Take a value."""
        if self.key is None:
            self.container.append(value)
        else:
            self.container[self.key], self.key = value, None


def _value(text: str, line: int) -> Any:
    """The value of a plain scalar."""
    if _NUMBER.fullmatch(text):
        return int(text) if _SHORT.fullmatch(text) else NumberText(text)
    if _LEADING_ZERO.fullmatch(text):
        raise InputError(
            f"found the number {text[:40]} at line {line}, which some programs read with the base "
            "8: write it without zeros in front"
        )
    return _CONSTANTS.get(text, text)


# Recognizing the kind of a file, and reading the system in it.

GALLERY = "gallery:"
_SUFFIXES = (".mat", ".npz", ".yaml", ".yml", ".csv")
_READ = (
    "a system file is JSON ('mcexact sample --template' prints one), .yaml, .mat, .npz, "
    "or a folder with A.csv, B_1.csv, C_1.csv and so on"
)
_FOREIGN = {
    b"MATLAB 7.3": "an HDF5 file of MATLAB: save it with 'save plant.mat A B C inputs outputs -v7'",
    b"\x89HDF": "an HDF5 file: write its matrices with numpy.savez or as .csv files",
    b"\x93NUMPY": "a single array: put A, B_1, C_1, … into one archive with numpy.savez",
    b"\x80\x04": "a pickle, which could run any program: write the matrices with numpy.savez",
    b"\x80\x05": "a pickle, which could run any program: write the matrices with numpy.savez",
}


def is_foreign(path: str) -> bool:
    """Whether the name of a file says that it is no JSON, or it is a folder of .csv files."""
    suffix = os.path.splitext(path)[1].lower()
    return suffix in _SUFFIXES or os.path.isfile(os.path.join(path, arrays.MARK))


def read_input(path: str | os.PathLike[str], limits: Limits = DEFAULT_LIMITS) -> bytes:
    """Read a file, a folder of .csv files as an archive, or for ``gallery:NAME`` a published plant.

    Raises
    ------
    InputError
        If it is missing, unreadable or too large.
    UsageError
        If the gallery has no plant of this name.
    """
    name = os.fspath(path)
    if name.startswith(GALLERY):
        return gallery.text(gallery.require_name(name.removeprefix(GALLERY))).encode()
    if os.path.isfile(os.path.join(name, arrays.MARK)):
        return arrays.packed(name, limits)
    return read_bytes(path, limits)


def read_any(data: bytes, place: str, reading: Reading = AS_TYPED) -> MultiChannelSystem:
    """Read the system in a file of any known kind.

    Parameters
    ----------
    data : bytes
        As `read_input` returns them.
    place : str
        The name of the file, of which the end counts for texts.
    reading : Reading, optional

    Raises
    ------
    InputError
        If it is malformed, or of another kind; the message says what to do.
    """
    suffix, limits = os.path.splitext(place)[1].lower(), reading.limits
    parts = _parts(data, suffix, limits)
    if parts is not None:
        try:
            return system_of(parts, reading)
        except InputError as error:  # a command in a hint can be copied
            error.message = error.message.replace("convert FILE", f"convert {shlex.quote(place)}")
            raise
    system = read_document(_document(data, suffix, limits), limits)
    require_short_numbers(data, limits)
    return system


def read_plant(
    data: bytes, place: str, reading: Reading = AS_TYPED
) -> MultiChannelSystem | ParametricSystem:
    """Read the system in a file, with parameters where the file names some.

    Parameters
    ----------
    data : bytes
    place : str
    reading : Reading, optional
        As `read_any` takes them.

    Raises
    ------
    InputError
        If it is malformed, or of another kind; the message says what to do.
    """
    suffix, limits = os.path.splitext(place)[1].lower(), reading.limits
    if _parts(data, suffix, limits) is not None:
        return read_any(data, place, reading)
    document = _document(data, suffix, limits)
    parametric = isinstance(document, dict) and "parameters" in document
    system = (read_parametric_document if parametric else read_document)(document, limits)
    require_short_numbers(data, limits)
    return system


def _document(data: bytes, suffix: str, limits: Limits) -> Any:
    """The parsed document of a text."""
    if suffix in (".yaml", ".yml"):
        return read_yaml(data, limits)
    if len(data) <= limits.bytes:
        require_start(data, _READ)
    return parse(data, limits)


def _parts(data: bytes, suffix: str, limits: Limits) -> Parts | None:
    """The parts of a file of arrays; None for a text."""
    for magic, kind in _FOREIGN.items():
        if data.startswith(magic):
            raise InputError(f"found {kind}")
    if data.startswith(b"{"):
        return None
    if data.startswith(arrays.MAGIC):
        return arrays.read_mat(data, limits)
    if suffix == ".mat":
        raise InputError("expected a file of MATLAB, version 5: save it with '-v7' or '-v6'")
    if suffix == ".csv":
        raise InputError(f"found a single table; {_READ}")
    if not data.startswith(b"PK"):
        return None
    files = members(data, limits)
    kinds = {os.path.splitext(name)[1] for name in files}
    if kinds == {".npy"}:
        return arrays.read_npz(files, limits)
    if kinds == {".csv"}:
        return arrays.read_csv_files(files)
    raise InputError(f"found an archive, but not one of .npy or .csv files; {_READ}")


# `load_system` and `save_system`, for files of every known kind.

SUFFIXES = (".json", ".yaml", ".yml", ".mat", ".npz")
"""The ends of the names of files that systems are written to."""


def load_system(
    path: str | os.PathLike[str],
    *,
    limits: Limits = DEFAULT_LIMITS,
    rounding: Rounding | None = None,
    inputs: Sequence[int] | None = None,
    outputs: Sequence[int] | None = None,
) -> MultiChannelSystem:
    """Read a system from a file.

    Parameters
    ----------
    path : path
        A JSON file, or one that ends in .mat, .npz, .yaml or .yml; a folder of .csv files; ``-``
        for the standard input; or ``gallery:NAME`` for a published plant.
    limits : Limits, optional
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How the floats of .mat and .npz files become exact, as in `MultiChannelSystem.from_float`;
        by default as the file says, or else "simplest".  Numbers in other files are as typed.
    inputs, outputs : sequences of int, optional
        The numbers of inputs and outputs of the channels, where the file has stacked B and C and
        does not say.

    Raises
    ------
    InputError
        If the file is missing, unreadable, too large or malformed; the message says where.

    Examples
    --------
    >>> load_system("gallery:quadruple-tank-pminus").n
    4
    """
    InputError.require(limits, Limits, "limits")
    made_by = "; matrices make a system with MultiChannelSystem(A, B, C)"
    with InputError.inside(place_of(path, made_by)):
        reading = Reading(limits, rounding, inputs, outputs)
        system = read_any(read_input(path, limits), os.fspath(path), reading)
    return warn_of_rounding(system)


def load_parametric_system(
    path: str | os.PathLike[str], *, limits: Limits = DEFAULT_LIMITS
) -> ParametricSystem:
    """Read a system with parameters from a file.

    Parameters
    ----------
    path : path
        A JSON file, or one that ends in .yaml or .yml; ``-`` for the standard input; or
        ``gallery:NAME`` for a published plant.
    limits : Limits, optional

    Raises
    ------
    InputError
        If the file is missing, unreadable, too large or malformed, or has no parameters; the
        message says where.

    Examples
    --------
    >>> load_parametric_system("gallery:quadruple-tank-parametric").parameters
    ('gamma1', 'gamma2')
    """
    with InputError.inside(place_of(path)):
        system = read_plant(read_input(path, limits), os.fspath(path), Reading(limits))
        if not isinstance(system, ParametricSystem):
            raise InputError("found a system without parameters, which load_system reads")
        return system


def save_system(
    system: MultiChannelSystem | ParametricSystem,
    path: str | os.PathLike[str],
    *,
    rounding: Rounding | None = None,
    nearest: bool = False,
) -> None:
    """Write a system to a file, completely or not at all.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A derived system is written with its own matrices, as a plant.  A system with parameters is
        written as JSON, which YAML is too, and `load_parametric_system` reads it.
    path : path
        Its end says the kind: .json, .mat, .npz, .yaml or .yml; a name without one is a folder for
        .csv files, in which those of another system are replaced.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        For .mat and .npz: numbers are written as floats from which this rounding makes them again.
        The file names it, so that `load_system` needs none.
    nearest : bool
        Whether other numbers are written as the nearest floats.

    Raises
    ------
    NotWritten
        If the file cannot be written.
    InputError
        If it would not hold the numbers of the system.
    UsageError
        If the end of the name is none of these.
    """
    contents = system_files(system, path, rounding=rounding, nearest=nearest)
    if isinstance(contents, bytes):
        write_bytes(path, contents)
    else:
        write_csv_files(path, contents)


def system_files(
    system: MultiChannelSystem | ParametricSystem,
    path: str | os.PathLike[str],
    *,
    rounding: Rounding | None = None,
    nearest: bool = False,
) -> bytes | dict[str, str]:
    """The contents of the file that `save_system` writes, or of the files in its folder.

    Raises
    ------
    InputError
        If it would not hold the numbers of the system.
    UsageError
        If the end of the name is that of no system file.
    """
    place_of(path)
    require_suffix(path)
    suffix = os.path.splitext(path)[1].lower()
    if isinstance(system, ParametricSystem):
        if suffix in (".mat", ".npz") or is_folder(path):
            raise InputError(
                "a system with parameters is written as JSON: choose a name that ends in .json or "
                f".yaml, or give values, --at {system.parameters[0]}=1/3, which is "
                f"plant.at({{{system.parameters[0]!r}: …}}) in Python"
            )
        return system_text(system).encode("ascii")
    any_system(system)
    if (rounding is not None or nearest) and suffix not in (".mat", ".npz"):
        raise UsageError("numbers are rounded in .mat and .npz files only: leave it out")
    contents: bytes | dict[str, str]
    if suffix == ".mat":
        contents = mat_bytes(parts_of(system), rounding, nearest=nearest)
    elif suffix == ".npz":
        contents = npz_bytes(parts_of(system), rounding, nearest=nearest)
    elif is_folder(path):
        contents = csv_texts(parts_of(system))
    else:
        return system_text(system).encode("ascii")
    return contents


def require_suffix(path: str | os.PathLike[str]) -> None:
    """Refuse to write a system to a file of a kind that is not known.

    Raises
    ------
    UsageError
        If the end of the name is that of no system file.
    """
    suffix = os.path.splitext(path)[1]
    if suffix and suffix.lower() not in SUFFIXES:
        raise UsageError(
            f"no system is written to a file that ends in {quoted(suffix)}: choose "
            f"{', '.join(SUFFIXES)}, or a folder for .csv files, whose name has no end",
            where=os.fspath(path),
        )


def is_folder(path: str | os.PathLike[str]) -> bool:
    """Whether a system is written to a folder of this name, and not to a file."""
    return not os.path.splitext(path)[1]
