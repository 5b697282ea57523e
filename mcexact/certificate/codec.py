"""Writing certificates: exact objects to the JSON of ``FORMAT.md``, equal ones with equal bytes.

Evidence that is found exactly is equal on every processor; Lyapunov matrices, and controllers that
are designed in floating point, are not: ``FORMAT.md`` says which certificates are only valid.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

from .evidence import Certificate, Document

FORMAT = "mcexact-certificate/1"


class PlainObject(dict[str, Any]):
    """A JSON object made of plain data, not to be changed; its canonical text is made once.

    The system is most of a certificate, and all certificates about it share it.
    """

    @cached_property
    def text(self) -> str:
        """The canonical JSON text."""
        return canonical(self)


def plain(value: Any) -> Any:
    """Turn exact objects into the plain data of a JSON document.

    Parameters
    ----------
    value : object
        None, a bool, an int, a string, a Fraction, a matrix, a polynomial matrix, a polynomial,
        shared evidence, or a mapping or sequence of such.

    Returns
    -------
    object
        Made of dict, list, str, int, bool and None.

    Raises
    ------
    TypeError
        If the value has no exact form, as a float has none.

    Examples
    --------
    >>> plain({"half": Fraction(1, 2), "channels": ("1", "2")})
    {'half': '1/2', 'channels': ['1', '2']}
    >>> plain(0.5)
    Traceback (most recent call last):
        ...
    TypeError: a certificate holds exact data only, found float
    """
    if value is None or isinstance(value, (bool, int, str, PlainObject)):
        return value
    if isinstance(value, Fraction):
        if value.denominator == 1:
            return value.numerator
        return f"{value.numerator}/{value.denominator}"
    if hasattr(value, "document"):
        return plain(value.document())
    if hasattr(value, "as_json"):
        return value.as_json()
    if hasattr(value, "numerators"):
        return {"denominator": value.denominator, "entries": _integers(value.numerators)}
    if hasattr(value, "coefficients"):
        if hasattr(value, "denominator"):
            layers = [_integers(layer) for layer in value.coefficients]
            return {"denominator": value.denominator, "coefficients": layers}
        return [plain(Fraction(coefficient)) for coefficient in value.coefficients]
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return [plain(item) for item in value]
    raise TypeError(f"a certificate holds exact data only, found {type(value).__name__}")


def _integers(rows: Sequence[Sequence[int]]) -> list[list[int]]:
    """Copy rows of integers as lists."""
    return [list(map(int, row)) for row in rows]


def canonical(value: Any) -> str:
    """The one JSON text of plain data: sorted keys, no blanks, non-ASCII characters escaped."""
    digits = sys.get_int_max_str_digits()
    try:
        # Exact evidence may have longer numbers than the interpreter prints by default.
        sys.set_int_max_str_digits(0)
        return json.dumps(
            value, sort_keys=True, separators=(",", ":"), ensure_ascii=True, check_circular=False
        )
    finally:
        sys.set_int_max_str_digits(digits)


def digest(system: Document) -> str:
    """The SHA-256 of the canonical JSON of a canonical system object, in lower-case hexadecimal."""
    return hashlib.sha256(_text(system).encode("ascii")).hexdigest()


def _text(value: Any) -> str:
    """The canonical JSON text of exact objects."""
    return value.text if isinstance(value, PlainObject) else canonical(plain(value))


def document(certificate: Certificate) -> dict[str, Any]:
    """The certificate as one JSON object of plain data, with the six keys of ``FORMAT.md``."""
    system = certificate.system
    return {
        "format": FORMAT,
        "kind": certificate.kind,
        "system": json.loads(system.text) if isinstance(system, PlainObject) else plain(system),
        "subject": plain(certificate.subject),
        "claim": plain(certificate.claim()),
        "witness": plain(certificate.witness()),
    }


def encode(certificate: Certificate) -> str:
    """The certificate as JSON text with a final line feed; equal certificates give equal text.

    Notes
    -----
    The same question gives an equal certificate on every processor, unless its evidence was
    proposed in floating point: quadratic forms of the kind ``stability``, and whatever is about the
    loop of a controller designed in floating point.  These are only valid.
    """
    parts = {
        "claim": certificate.claim(),
        "format": FORMAT,
        "kind": certificate.kind,
        "subject": certificate.subject,
        "system": certificate.system,
        "witness": certificate.witness(),
    }
    return "{" + ",".join(f'"{key}":{_text(value)}' for key, value in parts.items()) + "}\n"


def write(certificate: Certificate, path: str | os.PathLike[str]) -> None:
    """Write the certificate to a file, under a temporary name that is then renamed.

    Parameters
    ----------
    certificate : Certificate
    path : path
        An existing file is replaced; nothing is ever half written.

    Raises
    ------
    OSError
        If the folder does not exist or cannot be written.
    """
    target = Path(path)
    text = encode(certificate)
    handle, temporary = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    try:
        with os.fdopen(handle, "w", encoding="ascii", newline="\n") as stream:
            stream.write(text)
        # mkstemp makes files private; a certificate is as readable as any other new file.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
