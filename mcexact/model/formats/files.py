"""`load_system` and `save_system`, for files of every known kind."""

from __future__ import annotations

import os
from collections.abc import Sequence

from mcexact.errors import InputError, UsageError, place_of
from mcexact.exact.floats import Rounding
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model.atomic import write_bytes
from mcexact.model.formats.csv_folder import csv_texts, write_csv_files
from mcexact.model.formats.mat import mat_bytes
from mcexact.model.formats.npz import npz_bytes
from mcexact.model.formats.parts import parts_of
from mcexact.model.formats.reading import Reading
from mcexact.model.formats.recognize import read_any, read_input, read_plant
from mcexact.model.names import quoted
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text

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
    rounding : {"decimal", "dyadic"}, optional
        How the floats of .mat and .npz files become exact, as in `MultiChannelSystem.from_float`;
        by default as the file says, or else only integers are accepted among floats.
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
        return read_any(read_input(path, limits), os.fspath(path), reading)


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
        found = read_plant(read_input(path, limits), os.fspath(path), Reading(limits))
        if not isinstance(found, ParametricSystem):
            raise InputError("found a system without parameters, which load_system reads")
        return found


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
    rounding : {"decimal", "dyadic"}, optional
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
    made = system_files(system, path, rounding=rounding, nearest=nearest)
    if isinstance(made, bytes):
        write_bytes(path, made)
    else:
        write_csv_files(path, made)


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
    InputError.require(system, MultiChannelSystem, "system")
    if (rounding is not None or nearest) and suffix not in (".mat", ".npz"):
        raise UsageError("numbers are rounded in .mat and .npz files only: leave it out")
    made: bytes | dict[str, str]
    if suffix == ".mat":
        made = mat_bytes(parts_of(system), rounding, nearest=nearest)
    elif suffix == ".npz":
        made = npz_bytes(parts_of(system), rounding, nearest=nearest)
    elif is_folder(path):
        made = csv_texts(parts_of(system))
    else:
        return system_text(system).encode("ascii")
    return made


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
