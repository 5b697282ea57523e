"""What a certificate says, however it is written: two that say different things must differ here.

Written from ``FORMAT.md``, like the oracle; statements of a checker are compared with it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.controllers import read_agents
from tests.oracle.certificates.systems import read_plant

SETS = ("factors", "roots", "added")
"""Lists whose order says nothing."""

NULL_IS_STABLE = ("stability", "box_stable", "parametric_box_stable")
"""Kinds whose bound null stands for 0 in continuous and for 1 in discrete time."""

DECIMALS = ("re", "im", "radius", "lower", "upper")


def meaning(document: Mapping[str, Any]) -> str:
    """One text for each meaning of a readable document."""
    steps = [_step(document, k) for k in range(len(document["subject"]))]
    claim = dict(document["claim"])
    if document["kind"] in NULL_IS_STABLE and claim["bound"] is None:
        claim["bound"] = int(_is_discrete(document))  # what null stands for
    if claim.get("gain_radii") is not None:
        inner = subject_of(document, len(steps) - 1)
        claim["gain_radii"] = _agents(inner, claim["gain_radii"])
    parts = (document["kind"], _plant(document["system"]), steps, _plain(claim, ""))
    return _text(parts)


def _is_discrete(document: Mapping[str, Any]) -> bool:
    """Whether the subject is in discrete time: the plant is, or it is sampled."""
    sampled = any(step["construction"] == "sampled" for step in document["subject"])
    return sampled or bool(document["system"]["time"] == "discrete")


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True)


def _plant(value: Mapping[str, Any]) -> Any:
    if "parameters" in value:
        return value
    plant = read_plant(value)
    channels = [
        [name, _matrix(B), _matrix(C)]
        for name, B, C in zip(plant.names, plant.B, plant.C, strict=True)
    ]
    delays = sorted([i, j, steps] for (i, j), steps in plant.delays.items())
    A, B, C = plant.radii or (plant.A * 0, [M * 0 for M in plant.B], [M * 0 for M in plant.C])
    radii = [_matrix(A), *map(_matrix, (*B, *C))]
    D = None if plant.D is None else _matrix(plant.D)
    return [plant.time, _matrix(plant.A), channels, D, plant.neighborhoods, delays, radii]


def _matrix(M: Any) -> Any:
    return [M.nrows(), M.ncols(), [str(v) for v in M.entries()]]


def _step(document: Mapping[str, Any], k: int) -> Any:
    step = document["subject"][k]
    if step["construction"] == "periodic_loop":
        system = subject_of(document, k)
        return ["periodic_loop", *(_agents(system, phase) for phase in step["phases"])]
    if step["construction"] != "closed_loop":
        return _plain(step, "")
    return ["closed_loop", _agents(subject_of(document, k), step["controller"])]


def _agents(system: Any, controller: Any) -> Any:
    return [
        [
            agent.shared,
            agent.private,
            {label: _map(parts) for label, parts in agent.maps.items()},
            sorted([i, steps] for i, steps in agent.hold.items() if steps),
        ]
        for agent in read_agents(system, controller)
    ]


def _map(parts: Mapping[tuple[str, int], Any]) -> Any:
    return sorted([kind, j, _matrix(M)] for (kind, j), M in parts.items())


def _plain(value: Any, key: str) -> Any:
    if isinstance(value, dict):
        if set(value) == {"denominator", "entries"}:
            d = value["denominator"]
            return [[str(Fraction(v, d)) for v in row] for row in value["entries"]]
        return {k: _plain(v, k) for k, v in value.items()}
    if isinstance(value, list | tuple):
        found = [_plain(v, "") for v in value]
        return sorted(found, key=_text) if key in SETS else found
    if key in DECIMALS and isinstance(value, str):
        return str(Fraction(value))
    return value
