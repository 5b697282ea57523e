"""Answers written as certificates, in the JSON of ``FORMAT.md``.

Equal answers have equal bytes.  Exact computations find the same evidence on every processor;
Lyapunov matrices and controllers designed in floating point differ.  ``FORMAT.md`` says which
certificates are reproducible, and which are only valid.
"""

from __future__ import annotations

import os
from typing import Any

from mcexact.answer.protocol import Answer
from mcexact.errors import InputError
from mcexact.model.text import plain, text_of, write_text

FORMAT = "mcexact-certificate/1"


def document(answer: Answer) -> dict[str, Any]:
    """Return the certificate as a JSON object of plain data, with the six keys of ``FORMAT.md``."""
    return {
        "format": FORMAT,
        "kind": answer.kind,
        "system": answer.system,
        "subject": plain(answer.subject),
        "claim": plain(answer.claim()),
        "witness": plain(answer.witness()),
    }


def encode(answer: Answer, *, system_by_digest: bool = False) -> str:
    """Return the certificate as JSON text with a final line feed; equal answers give equal text.

    Parameters
    ----------
    answer : Answer
    system_by_digest : bool
        Whether it names the plant by its digest alone: the checker then needs the system file, too.

    Notes
    -----
    The same question gives the same certificate on every processor, unless floating point proposed
    the evidence: the quadratic forms of the kind ``stability``, and all answers about the loop of a
    controller designed in floating point.  Such certificates are only valid.
    """
    parts = {
        "claim": text_of(answer.claim()),
        "format": text_of(FORMAT),
        "kind": text_of(answer.kind),
        "subject": text_of(answer.subject),
        "system": text_of(answer.about.plant.digest())
        if system_by_digest
        else answer.about.plant.canonical_text(),
        "witness": text_of(answer.witness()),
    }
    return "{" + ",".join(f'"{key}":{text}' for key, text in parts.items()) + "}\n"


def save_certificate(
    answer: Answer, path: str | os.PathLike[str], *, system_by_digest: bool = False
) -> None:
    """Write an answer to a certificate file, completely or not at all.

    Parameters
    ----------
    answer : Answer
    path : path
    system_by_digest : bool
        Whether it names the plant by its digest alone, which is much shorter for a large plant: the
        checker and `load_certificate` then need the plant, too.

    Raises
    ------
    NotWritten
        If the file cannot be written.
    InputError
        If the answer is something else.
    """
    InputError.require(answer, Answer, "answer")
    write_text(path, encode(answer, system_by_digest=system_by_digest))
