"""Folders of .csv files, one for each matrix, with numbers as typed."""

from __future__ import annotations

import csv
import io
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mcexact.errors import InputError, NotWritten
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Limits, decimal_or_quotient
from mcexact.model.atomic import write_text
from mcexact.model.formats.parts import ROUNDING, TEXTS, Parts, require_known
from mcexact.model.json_text import read_bytes
from mcexact.model.names import quoted

SETTINGS = tuple(text for text in TEXTS if text != ROUNDING)
"""The texts in ``system.csv``."""
MARK = "A.csv"
"""The file that every such folder has."""


def packed(folder: str | os.PathLike[str], limits: Limits) -> bytes:
    """Read the .csv files of a folder as an archive.

    Raises
    ------
    InputError
        If one cannot be read, or they are too large.
    """
    stream, size = io.BytesIO(), 0
    with zipfile.ZipFile(stream, "w") as archive:
        for path in sorted(Path(folder).glob("*.csv")):
            with InputError.inside(path.name):
                content = read_bytes(path, limits)
                size += len(content)
                if size > limits.bytes:
                    raise InputError(f"expected at most {limits.bytes} bytes (Limits.bytes)")
            archive.writestr(zipfile.ZipInfo(path.name), content)
    return stream.getvalue()


def read_csv_files(files: Mapping[str, bytes]) -> Parts:
    """Read the tables of a folder: A.csv, B_1.csv, C_1.csv and others, as in `Parts`.

    ``names.csv`` has the name of a channel on each line, and ``system.csv`` has lines ``key,value``
    with the keys time, sample_time, name and source.

    Raises
    ------
    InputError
        If a file is no table of numbers, or is unknown.
    """
    tables: dict[str, Any] = {}
    texts: dict[str, str] = {}
    names = None
    for file, data in files.items():
        stem = file.removesuffix(".csv")
        with InputError.inside(file):
            if stem == "system":
                texts = _settings(data, tables)
            elif stem == "names":
                names = [_single(row) for row in _rows(data)]
            else:
                require_known([stem], "table")
                if stem in SETTINGS:
                    raise InputError("write it into system.csv, as 'key,value'")
                if stem == ROUNDING:
                    raise InputError("leave it out: numbers in .csv files are read as typed")
                tables[stem] = [_entries(row) for row in _rows(data)]
                _require_width(tables[stem])
    return Parts(tables, texts, names)


def _settings(data: bytes, tables: dict[str, Any]) -> dict[str, str]:
    """Read ``system.csv``; the sample time is a table of one number."""
    texts: dict[str, str] = {}
    for row in _rows(data):
        if len(row) != 2:
            raise InputError(f"expected lines 'key,value', found {len(row)} entries")
        key, value = row
        if key == "sample_time" and key not in tables:
            tables[key] = [[_entry(value)]]
        elif key not in SETTINGS or key in texts:
            raise InputError(
                f"expected time, sample_time, name and source, each at most once, "
                f"found {quoted(key)}"
            )
        else:
            texts[key] = value
    return texts


def _single(row: list[str]) -> str:
    """The only entry of a row."""
    if len(row) != 1:
        raise InputError(f"expected one name on each line, found {len(row)} entries")
    return row[0]


def _entries(row: list[str]) -> list[str]:
    """The numbers of a row without the blanks around them."""
    plain = {text: _entry(text) for text in dict.fromkeys(row)}
    return row if all(map(str.__eq__, plain, plain.values())) else [plain[text] for text in row]


def _entry(text: str) -> str:
    """A number without the blanks around it."""
    found = text.strip()
    if "," in found or ";" in found:
        raise InputError(
            f"found {found[:40]!a}: write decimals with a point, and a comma between entries"
        )
    return found


def _require_width(rows: list[list[str]]) -> None:
    """Refuse rows of different lengths; the message counts lines as editors do."""
    for k, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise InputError(
                f"expected {len(rows[0])} entries in row {k} as in row 1, found {len(row)}"
            )


def _rows(data: bytes) -> list[list[str]]:
    """Read a table; lines without entries are left out."""
    try:
        text = data.decode("utf-8-sig")
        return [row for row in csv.reader(io.StringIO(text, newline=""), strict=True) if row]
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text: byte {error.start}") from None
    except csv.Error as error:
        raise InputError(f"no table of entries between commas: {error}") from None


def csv_texts(parts: Parts) -> dict[str, str]:
    """Write the tables of a system, exactly; the keys are the names of files."""
    found = {f"{name}.csv": _table(M) for name, M in parts.tables.items() if name != "sample_time"}
    if not parts.tables["A"].nrows:  # matrices without rows or without columns are empty files
        channels = range(1, len(parts.names or ()) + 1)
        found["inputs.csv"] = _lines([[str(parts.tables[f"B_{k}"].ncols) for k in channels]])
        found["outputs.csv"] = _lines([[str(parts.tables[f"C_{k}"].nrows) for k in channels]])
    if parts.names is not None:
        found["names.csv"] = _lines([[name] for name in parts.names])
    settings = dict(parts.texts)
    if "sample_time" in parts.tables:
        settings["sample_time"] = str(decimal_or_quotient(parts.tables["sample_time"][0, 0]))
    found["system.csv"] = _lines([[key, settings[key]] for key in sorted(settings)])
    return found


def write_csv_files(folder: str | os.PathLike[str], files: Mapping[str, str]) -> None:
    """Write the .csv files of a system into a folder, and remove those of another system.

    Other files stay.  The file that every such folder has is removed first and written last, so
    that an interrupted folder is not read as a mixture of two systems.

    Raises
    ------
    NotWritten
        If a file cannot be written.
    InputError
        If the folder has a .csv file of something else.
    """
    place = Path(folder)
    try:
        place.mkdir(parents=True, exist_ok=True)
        former = sorted(path for path in place.glob("*.csv") if path.name not in files)
        for path in former:
            if path.stem not in ("system", "names"):
                with InputError.inside(os.fspath(path)):
                    require_known([path.stem], "table")
        for path in [place / MARK, *former]:
            path.unlink(missing_ok=True)
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror}", where=os.fspath(folder)) from None
    for name in sorted(files, key=lambda name: name == MARK):
        write_text(place / name, files[name])


def _table(M: Matrix) -> str:
    return _lines([[str(decimal_or_quotient(x)) for x in row] for row in M.rows() if row])


def _lines(rows: list[list[str]]) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue()
