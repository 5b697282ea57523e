"""Which kind of file some bytes are, and the system in them."""

from __future__ import annotations

import os
import shlex
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model import gallery
from mcexact.model.formats import csv_folder, mat, npz
from mcexact.model.formats.archive import members
from mcexact.model.formats.parts import Parts, system_of
from mcexact.model.formats.reading import AS_TYPED, Reading
from mcexact.model.formats.yaml_text import read_yaml
from mcexact.model.json_text import parse, read_bytes, require_short_numbers, require_start
from mcexact.model.parametric import ParametricSystem
from mcexact.model.parametric_file import read_parametric_document
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_document

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
    return suffix in _SUFFIXES or os.path.isfile(os.path.join(path, csv_folder.MARK))


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
    if os.path.isfile(os.path.join(name, csv_folder.MARK)):
        return csv_folder.packed(name, limits)
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
    for magic, said in _FOREIGN.items():
        if data.startswith(magic):
            raise InputError(f"found {said}")
    if data.startswith(b"{"):
        return None
    if data.startswith(mat.MAGIC):
        return mat.read_mat(data, limits)
    if suffix == ".mat":
        raise InputError("expected a file of MATLAB, version 5: save it with '-v7' or '-v6'")
    if suffix == ".csv":
        raise InputError(f"found a single table; {_READ}")
    if not data.startswith(b"PK"):
        return None
    files = members(data, limits)
    kinds = {os.path.splitext(name)[1] for name in files}
    if kinds == {".npy"}:
        return npz.read_npz(files, limits)
    if kinds == {".csv"}:
        return csv_folder.read_csv_files(files)
    raise InputError(f"found an archive, but not one of .npy or .csv files; {_READ}")
