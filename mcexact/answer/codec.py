"""Answers as certificates: the JSON of ``FORMAT.md``, equal answers with equal bytes.

Evidence that is found exactly is equal on every processor; Lyapunov matrices, and controllers that
are designed in floating point, are not: ``FORMAT.md`` says which certificates are only valid.
"""

from __future__ import annotations

import json
import os
from typing import Any

from mcexact.answer.protocol import Answer
from mcexact.model.atomic import write_text
from mcexact.model.canonical import PlainObject, plain, text_of

FORMAT = "mcexact-certificate/1"


def document(answer: Answer) -> dict[str, Any]:
    """The certificate as one JSON object of plain data, with the six keys of ``FORMAT.md``."""
    system = answer.system
    return {
        "format": FORMAT,
        "kind": answer.kind,
        "system": json.loads(system.text) if isinstance(system, PlainObject) else plain(system),
        "subject": plain(answer.subject),
        "claim": plain(answer.claim()),
        "witness": plain(answer.witness()),
    }


def encode(answer: Answer) -> str:
    """The certificate as JSON text with a final line feed; equal answers give equal text.

    Notes
    -----
    The same question gives an equal certificate on every processor, unless its evidence was
    proposed in floating point: quadratic forms of the kind ``stability``, and whatever is about the
    loop of a controller designed in floating point.  These are only valid.
    """
    parts = {
        "claim": answer.claim(),
        "format": FORMAT,
        "kind": answer.kind,
        "subject": answer.subject,
        "system": answer.system,
        "witness": answer.witness(),
    }
    return "{" + ",".join(f'"{key}":{text_of(value)}' for key, value in parts.items()) + "}\n"


def save_certificate(answer: Answer, path: str | os.PathLike[str]) -> None:
    """Write an answer as a certificate file, whole or not at all.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    write_text(path, encode(answer))
