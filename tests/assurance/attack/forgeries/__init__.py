"""Claims that are plausible and false, with all of a proof but one part of it.

Each forger takes a true certificate and gives a document that is false, or at least is proved in no
way: the one condition that stands against it is meant to be found by leaving it out.
"""

from __future__ import annotations

import random

from tests.oracle.drawn.plants import Document

from ..mutators import SMALL_MODULI, other_modulus
from . import (
    box_traps,
    boxes,
    construction_traps,
    gains,
    graph_traps,
    loops,
    modes,
    parametric,
    parametric_rank,
    parametric_traps,
    performance,
    plain_traps,
    ranges,
    saturation,
    sharing,
    structure,
    subjects,
)
from .anything import altered

FORGERS = {
    "assignability": structure.ASSIGNABILITY,
    "box_controllable": boxes.COVERED,
    "box_fixed": boxes.FIXED,
    "box_stable": boxes.STABLE,
    "closed_loop_spectrum": loops.SPECTRUM,
    "common_dimension": sharing.COMMON,
    "communication": sharing.LINKS,
    "complementary_subsystem": structure.COMPLEMENTARY,
    "completeness": modes.COMPLETENESS,
    "controllability": structure.CONTROLLABILITY,
    "controllability_indices": structure.INDICES,
    "cost_bound": performance.BOUNDS,
    "deficiency": modes.DEFICIENCY,
    "disk_margin": performance.MARGINS,
    "distributed_observer": loops.OBSERVER,
    "exceptional_gains": gains.EXCEPTIONAL,
    "fixed_spectrum": modes.SPECTRUM,
    "loop_cost": performance.COSTS,
    "parametric_box_controllable": ranges.RANGED,
    "parametric_box_fixed": ranges.RANGED,
    "parametric_box_stable": ranges.STABLE,
    "parametric_fixed_spectrum": (*parametric.PARAMETRIC, parametric_traps.trap_about_modes),
    "parametric_rank": (*parametric_rank.RANKS, parametric_traps.trap_about_ranks),
    "pencil_rank": modes.PENCIL,
    "saturation": saturation.SATURATED,
    "sector": performance.SECTORS,
    "setpoint": structure.SETPOINT,
    "shared_dimensions": sharing.DIMENSIONS,
    "sharing_gap": structure.GAP,
    "single_channel_gains": gains.SINGLE,
    "stability": loops.STABILITY,
    "step_peaks": performance.STEPS,
    "structural_fixed_modes": structure.PATTERNS,
    "transfer_graph": structure.GRAPH,
}

TRAPS: dict[str, Document] = {
    **plain_traps.TRAPS,
    **construction_traps.TRAPS,
    **box_traps.TRAPS,
    **graph_traps.TRAPS,
    **performance.TRAPS,
    **saturation.TRAPS,
    **parametric_traps.SPECTRA,
    **parametric_traps.RANKS,
}
"""Documents made by hand, which are false and would be accepted without one condition."""


def forged(rng: random.Random, document: Document) -> Document:
    """One forgery of the kind, or of any kind."""
    if "D" in document["system"] and rng.random() < 0.5:
        return subjects.other_feedthrough(rng, document)
    if rng.random() < 0.1:
        made = subjects.colliding_names(rng, document)
        if made is not None:
            return made
    if rng.random() < 0.3:
        made = subjects.other_line(rng, document)
        if made is not None:
            return made
    if rng.random() < 0.5:
        made = subjects.other_phases(rng, document)
        if made is not None:
            return made
    if rng.random() < 0.3:
        made = subjects.other_part(rng, document)
        if made is not None:
            return made
    if document["subject"] and rng.random() < 0.1:
        return subjects.other_time(rng, document)
    own = FORGERS.get(document["kind"], ())
    if own and rng.random() < 0.7:
        made = rng.choice(own)(rng, document)
        if made is not None:
            if rng.random() < 0.1:
                other_modulus(rng, made, SMALL_MODULI)
            return made
    if rng.random() < (0.4 if document["subject"] else 0.2):
        made = subjects.other_subject(rng, document)
        if made is not None:
            return made
    return altered(rng, document)
