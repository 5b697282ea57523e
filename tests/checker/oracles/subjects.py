"""The system that a document's claim is about, built by the finder's own constructions."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

from mcexact.derived.augmented_outputs import augmented_outputs
from mcexact.derived.dual import dual
from mcexact.derived.extended import extended_system
from mcexact.derived.feedback import feedback, full_output
from mcexact.derived.integrators import setpoint_system
from mcexact.derived.links import add_links
from mcexact.derived.merged import merged
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller_file import read_controller
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system

Document = dict[str, Any]


def plant_of(document: Document) -> MultiChannelSystem:
    """The plant of a certificate."""
    return read_system(json.dumps({"format": "mcexact-system/1", **document["system"]}))


def subject_of(document: Document) -> MultiChannelSystem:
    """The plant with all constructions applied."""
    system = plant_of(document)
    for step in document["subject"]:
        system = _applied(system, step)
    return system


def _applied(system: MultiChannelSystem, step: Document) -> MultiChannelSystem:
    names = list(system.names)
    match step["construction"]:
        case "augmented_outputs":
            return augmented_outputs(system)
        case "dual":
            return dual(system)
        case "integrators":
            return setpoint_system(system)
        case "extended":
            return extended_system(system, step["dimensions"], share=step["share"])
        case "full_output":
            return full_output(system, names.index(step["channel"]))
        case "arcs":
            return add_links(system, [(names.index(j), names.index(i)) for j, i in step["added"]])
        case "merged":
            return merged(system, step["parts"])
        case "feedback":
            return feedback(system, [matrix_of(gain) for gain in step["gains"]])
        case "closed_loop":
            head = {"format": "mcexact-controller/1", "system": ""}
            return closed_loop(
                system, read_controller(json.dumps(head | step["controller"]))
            ).system
    raise NotImplementedError(step["construction"])


def matrix_of(value: Document, ncols: int | None = None) -> Matrix:
    """A matrix of a certificate."""
    return Matrix.from_integers(value["entries"], value["denominator"], ncols=ncols)


def coefficients_of(value: list[int | str]) -> tuple[Fraction, ...]:
    """The coefficients of a polynomial of a certificate."""
    return tuple(map(Fraction, value))


def polynomial_of(value: list[int | str]) -> Polynomial:
    """A polynomial of a certificate, as the package holds it."""
    return Polynomial(coefficients_of(value))
