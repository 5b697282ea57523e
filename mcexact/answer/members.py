"""What is said first of a plant with radii: the answers about every plant within them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from mcexact.model.box import radii_in_words
from mcexact.model.system import MultiChannelSystem

QUESTIONS = (
    "box_fixed_modes",
    "box_stabilizability",
    "box_controllability",
    "box_observability",
    "box_setpoints",
)


FAILS = {
    "box_fixed_modes": "some plant has a fixed mode",
    "box_stabilizability": "some plant is not stabilizable by any such controller",
    "box_controllability": "some plant is not controllable by all channels together",
    "box_observability": "some plant is not observable by all channels together",
}
"""What is said where a plant within the radii is known that lacks what was asked."""


def leading(
    system: MultiChannelSystem,
    answers: Mapping[str, Any],
    open_: Collection[str],
    failing: Collection[str] = (),
) -> tuple[str, ...]:
    """How large the radii are, and the sentences about every plant within them.

    Parameters
    ----------
    system : MultiChannelSystem
    answers : mapping
        The answers about it by name.
    open_ : collection of str
        The questions that were asked and have no answer.
    failing : collection of str
        Those of them for which a plant within the radii is known that lacks what was asked.

    Returns
    -------
    tuple of str
        The last one says that what follows is about the nominal values; empty if nothing is said
        of all plants.
    """
    known = [name for name in QUESTIONS if name in answers]
    if "box_fixed_modes" in known and "box_stabilizability" in known:
        # A plant without fixed modes is stabilizable.
        known.remove("box_stabilizability")
    said = [answers[name].explain() for name in known]
    said += [f"within the radii: {FAILS[name]}" for name in FAILS if name in failing]
    if left := _left(answers, {*open_} - {*failing}):
        said.append(f"within the radii: open, as no proof was found: {', '.join(left)}")
    return (f"radii: {radii_in_words(system)}", *said, "At the nominal values:") if said else ()


def _left(answers: Mapping[str, Any], open_: Collection[str]) -> list[str]:
    """The questions about every plant within the radii that are told to be open."""
    told = {*open_} - answers.keys()
    if "box_fixed_modes" in answers:
        told.discard("box_stabilizability")
    if "setpoint" in answers and not answers["setpoint"].solvable:
        # The nominal plant fails, of which its own sentence tells.
        told.discard("box_setpoints")
    return [name.removeprefix("box_").replace("_", " ") for name in QUESTIONS if name in told]
