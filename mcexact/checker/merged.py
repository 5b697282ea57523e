"""Construction ``merged``: channels that are merged into one."""

from dataclasses import replace

from . import reading
from .evidence import inputs, outputs
from .statement import channel_set, suffixed
from .system import System


def merged(system: System, step: dict[str, reading.Json], place: str) -> System:
    """One channel for each part T of a partition of the channels, (B_T, C_T); no neighbor graph.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = reading.fields(step, place, "parts")
    parts = [reading.names(part, place, system.names) for part in reading.items(listed, place)]
    if not all(parts) or parts != sorted(parts):
        reading.malformed(place, "expected parts that are not empty, by their first members")
    whole = sorted(i for part in parts for i in part) == list(range(system.m))
    message = "expected every channel in exactly one part, and a part"
    reading.require(bool(parts) and whole, "subject", place, message)
    known = ["+".join(system.names[i] for i in part) for part in parts]
    distinct = len(set(known)) == len(known)
    reading.require(distinct, "subject", place, "two channels would have the same name")
    sets = ", ".join(channel_set(system.names[i] for i in part) for part in parts)
    words = suffixed(system, f"with its channels merged into {sets}")
    B, C = [inputs(system, part) for part in parts], [outputs(system, part) for part in parts]
    return replace(system, names=known, B=B, C=C, neighbors=None, delays={}, words=words)
