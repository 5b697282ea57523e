"""Folders of .csv files, one for each matrix, with numbers as typed."""

from __future__ import annotations

import csv
import io
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Limits, decimal_or_quotient
from mcexact.model.formats.parts import TEXTS, Parts, require_known
from mcexact.model.json_text import read_bytes

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
                if stem in TEXTS:
                    raise InputError("write it into system.csv, as 'key,value'")
                tables[stem] = [[_entry(entry) for entry in row] for row in _rows(data)]
                _require_width(tables[stem])
    return Parts(tables, texts, names)


def _settings(data: bytes, tables: dict[str, Any]) -> dict[str, str]:
    """Read ``system.csv``; the sample time is a table of one number."""
    texts: dict[str, str] = {}
    for row in _rows(data):
        if len(row) != 2:
            raise InputError(f"expected lines 'key,value', found {len(row)} entries")
        key, value = row
        if key == "sample_time":
            tables[key] = [[_entry(value)]]
        elif key not in TEXTS or key in texts:
            raise InputError(
                f"expected time, sample_time, name and source, each at most once, found {key!a}"
            )
        else:
            texts[key] = value
    return texts


def _single(row: list[str]) -> str:
    """The only entry of a row."""
    if len(row) != 1:
        raise InputError(f"expected one name on each line, found {len(row)} entries")
    return row[0]


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
    if parts.names is not None:
        found["names.csv"] = _lines([[name] for name in parts.names])
    settings = dict(parts.texts)
    if "sample_time" in parts.tables:
        settings["sample_time"] = str(decimal_or_quotient(parts.tables["sample_time"][0, 0]))
    found["system.csv"] = _lines([[key, settings[key]] for key in sorted(settings)])
    return found


def _table(M: Matrix) -> str:
    return _lines([[str(decimal_or_quotient(x)) for x in row] for row in M.rows() if row])


def _lines(rows: list[list[str]]) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue()
