"""True certificates of every kind, found by the package's own decisions."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any
from unittest import mock

import mcexact
from mcexact.analysis import blocks as blocks_module
from mcexact.analysis import controllability, fixed_modes, structure
from mcexact.analysis import sharing as deficiency_module
from mcexact.analysis.parameters.modes import parametric_fixed_spectrum
from mcexact.analysis.parameters.ranks import parametric_rank
from mcexact.analysis.patterns import structural_fixed_modes
from mcexact.analysis.sharing import deficiency
from mcexact.answer import protocol
from mcexact.answer.check import constructed
from mcexact.answer.parameters import (
    ControllabilityMatrix,
    SetpointMatrix,
    SignalMatrix,
    TransferColumn,
)
from mcexact.errors import McexactError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_parametric_system, read_system

from .boxes import drawn_about_a_box, drawn_in_ranges
from .observers import drawn_observer
from .parametric import drawn_moves, drawn_on_a_line, drawn_parametric_plant
from .performance import KINDS as PERFORMANCE
from .performance import drawn_performance
from .plants import Document, add_feedthrough, drawn_plant
from .subjects import NEEDS_GRAPH, drawn_subject

Found = Any


def _some(rng: random.Random, names: Any) -> list[str]:
    return [name for name in names if rng.random() < 0.6]


def _pencil(rng: random.Random, system: MultiChannelSystem) -> Found:
    chi = mcexact.questions.open_loop_spectrum(system).polynomial
    factors = [p for p, _ in chi.factors()] if hasattr(chi, "factors") else [chi]
    p = rng.choice([*factors, Polynomial.from_coefficients([rng.randint(-1, 1), 1])])
    return mcexact.questions.pencil_rank(system, _some(rng, system.names), p)


def _single(rng: random.Random, system: MultiChannelSystem) -> Found:
    want: Any = rng.choice(["both", "controllable", "observable"])
    channel = rng.choice([None, *system.names])
    return mcexact.questions.single_channel_gains(
        system, channel, want=want, cyclic=want == "both" and system.m > 0 and rng.random() < 0.3
    )


def _exceptional(rng: random.Random, system: MultiChannelSystem) -> Found:
    n = system.n
    if n > 6:
        raise ValueError("too large for determinants of polynomial matrices")
    M = [[rng.randint(-1, 1) for _ in range(n)] for _ in range(n)]
    found = mcexact.questions.exceptional_gains(M, system.A, system.input_matrix())
    return found.index_set if rng.random() < 0.5 else found.controllability_set


def _bound(rng: random.Random, time: str) -> Fraction | None:
    some = {"continuous": ("0", "1", "1/2"), "discrete": ("1", "1/2", "3/4")}
    return rng.choice([None, *(Fraction(each) for each in some[time])])


def _stability(rng: random.Random, system: MultiChannelSystem) -> Found:
    bound = _bound(rng, system.time)
    if system.time == "continuous" and bound == 0:
        bound = None
    method: Any = rng.choice(["polynomial", "lyapunov", "lyapunov"])
    region = StabilityRegion(system.time, bound)
    if system.time == "continuous" and rng.random() < 0.5:
        ratios, moduli = (None, "1/2", "1/10", "9/10", "3/5"), (None, 1, 3, 10, "100")
        region = region.limited(damping=rng.choice(ratios), largest_modulus=rng.choice(moduli))
    return mcexact.questions.certify_stability(system, region, method=method)


def _dimensions(rng: random.Random, system: MultiChannelSystem) -> Found:
    m = system.m
    return mcexact.sharing.minimal_shared_dimensions(
        system,
        None,
        rng.choice(["outputs+states", "states"]),
        costs=[Fraction(rng.randint(1, 3), rng.randint(1, 2)) for _ in range(m)],
        upper=[rng.choice([None, None, 1, 0]) for _ in range(m)],
        free_assignability=rng.random() < 0.4,
        region=_region(rng, system.time),
        node_limit=rng.choice((1, 10**4)),
    )


def _region(rng: random.Random, time: str) -> StabilityRegion | None:
    bound = _bound(rng, time)
    if bound is None:
        return None
    return StabilityRegion(time, None if bound == (time == "discrete") else bound)


def _links(rng: random.Random, system: MultiChannelSystem) -> Found:
    share: Any = rng.choice(["outputs", "outputs+states", "states"])
    sizes = None if share == "outputs" else [rng.randint(0, 2) for _ in range(system.m)]
    return mcexact.minimal_communication(
        system, dimensions=sizes, share=share, region=_region(rng, system.time)
    )


def _common(rng: random.Random, system: MultiChannelSystem) -> Found:
    share: Any = rng.choice(["outputs+states", "states"])
    return mcexact.sharing.common_dimension(system, None, share)


def _joint(rng: random.Random, system: MultiChannelSystem) -> Found:
    return mcexact.joint_controllability(system, _some(rng, system.names) or None)


def _as_large(
    decide: Callable[[random.Random, MultiChannelSystem], Found],
) -> Callable[[random.Random, MultiChannelSystem], Found]:
    """Half of the time the evidence that large sparse systems have."""

    def drawn(rng: random.Random, system: MultiChannelSystem) -> Found:
        if rng.random() < 0.5:
            return decide(rng, system)
        with (
            mock.patch.object(controllability, "_SMALL", -1),
            mock.patch.object(deficiency_module, "_SMALL", -1),
            mock.patch.object(structure, "is_large_and_sparse", lambda system: True),
            mock.patch.object(fixed_modes, "_in_parts", lambda system, blocks: True),
            mock.patch.object(blocks_module, "LARGEST_DENSE", rng.choice((0, 500))),
        ):
            return decide(rng, system)

    return drawn


DECISIONS: Mapping[str, Callable[[random.Random, MultiChannelSystem], Found]] = {
    "assignability": lambda rng, s: mcexact.assignability(s),
    "closed_loop_spectrum": lambda rng, s: mcexact.questions.open_loop_spectrum(s),
    "common_dimension": _common,
    "communication": _links,
    "complementary_subsystem": lambda rng, s: mcexact.questions.complementary_subsystem(
        s, s.names[: rng.randint(1, s.m - 1)] if s.m > 1 else s.names
    ),
    "completeness": lambda rng, s: mcexact.completeness(s),
    "controllability": _as_large(_joint),
    "controllability_indices": lambda rng, s: mcexact.controllability_indices(
        s, _some(rng, s.names) or None
    ),
    "deficiency": _as_large(lambda rng, s: deficiency(s)),
    "exceptional_gains": _exceptional,
    "fixed_spectrum": _as_large(lambda rng, s: mcexact.fixed_spectrum(s)),
    "neighbor_graph": lambda rng, s: mcexact.sharing.neighbor_graph(s),
    "pencil_rank": _pencil,
    "setpoint": lambda rng, s: mcexact.setpoint_solvability(s),
    "shared_dimensions": _dimensions,
    "sharing_gap": lambda rng, s: mcexact.sharing.sharing_gap(
        s, node_limit=rng.choice((1, 3, 10**4))
    ),
    "single_channel_gains": _single,
    "stability": _stability,
    "structural_fixed_modes": lambda rng, s: structural_fixed_modes(
        s, "outputs" if s.neighbors is not None and rng.random() < 0.5 else "own"
    ),
    "transfer_graph": _as_large(lambda rng, s: mcexact.transfer_graph(s)),
}


SIGNALS = ((1, 0, 1), (0, 1), (-1, 0, 1), ("1/2", -1, 1))
"""Polynomials of signals, constant term first."""


def _rank(rng: random.Random, system: ParametricSystem) -> Found:
    some = tuple(name for name in system.names if rng.random() < 0.7)
    return parametric_rank(
        system,
        rng.choice(
            (
                SetpointMatrix(),
                SignalMatrix(Polynomial.of(*rng.choice(SIGNALS))),
                ControllabilityMatrix(some, rng.randint(1, max(system.n, 1))),
                TransferColumn(rng.choice(system.names), rng.choice(system.names)),
            )
        ),
    )


PARAMETRIC: Mapping[str, Callable[[random.Random, ParametricSystem], Found]] = {
    "parametric_fixed_spectrum": lambda rng, s: parametric_fixed_spectrum(s),
    "parametric_rank": _rank,
}
ABOUT_THE_PLANT = ("common_dimension", "communication", "shared_dimensions")
WITH_GRAPH = ("common_dimension", "neighbor_graph", "shared_dimensions", "sharing_gap")


def certified(
    rng: random.Random, kind: str, plant: Document, steps: list[Document]
) -> Document | None:
    """The certificate that the package gives, or None where it refuses the question."""
    text = json.dumps({"format": "mcexact-system/1", **plant})
    try:
        if kind in PARAMETRIC:
            answer = PARAMETRIC[kind](rng, constructed(read_parametric_system(text), steps))
        else:
            answer = DECISIONS[kind](rng, constructed(read_system(text), steps))
        found = protocol.document(answer)
    except (McexactError, ValueError):
        return None
    if found["kind"] != kind:
        return None
    subject = steps if len(found["subject"]) in (0, len(steps)) else found["subject"]
    return {**found, "system": plant, "subject": subject}


def drawn_certificate(rng: random.Random, kind: str, focus: str | None) -> Document | None:
    """One attempt at a true certificate of a kind, about a construction."""
    graph = kind in WITH_GRAPH or focus in NEEDS_GRAPH
    if kind == "distributed_observer":
        return drawn_observer(rng)
    if kind in PERFORMANCE:
        return drawn_performance(rng, kind)
    if kind.startswith("box_"):
        return drawn_about_a_box(rng, kind)
    if kind.startswith("parametric_box_"):
        return drawn_in_ranges(rng, kind)
    if kind in PARAMETRIC:
        if rng.random() < 0.25:
            return certified(rng, kind, *drawn_on_a_line(rng))
        parametric = drawn_parametric_plant(rng)
        return certified(rng, kind, parametric, drawn_moves(rng, parametric))
    plant = drawn_plant(rng, graph=graph)
    if kind in ABOUT_THE_PLANT:
        return certified(rng, kind, plant, [])
    if focus == "input_filters" and rng.random() < 0.7:
        add_feedthrough(rng, plant)
    steps = drawn_subject(rng, plant, focus)
    return None if steps is None else certified(rng, kind, plant, steps)


def some_certificate(rng: random.Random, kind: str, focus: str | None = None) -> Document:
    """A true certificate of a kind, about a construction if that applies."""
    for attempt in range(200):
        found = drawn_certificate(rng, kind, focus if attempt < 30 else None)
        if found is not None:
            return json.loads(json.dumps(found))
    raise ArithmeticError(f"no certificate of {kind} is found")
