"""The questions that a sweep can ask about every system."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from mcexact.analysis.questions import QUESTIONS as ALL
from mcexact.errors import UsageError, several
from mcexact.model.properties import PROPERTIES

QUESTIONS = {
    name: question for name, question in ALL.items() if question.by_default and not question.needs
}
"""The questions of `mcexact.analysis.questions` that need the plant alone and are cheap."""
WITHIN_RADII = {name: ALL[name] for name in PROPERTIES}
"""The questions about every plant within the radii, which may be left open."""
KNOWN = QUESTIONS | WITHIN_RADII
NEAR_QUESTIONS = {"fixed_spectrum", "joint_controllability", "joint_observability"}
"""The questions whose answer may be another one for a plant that the data allow as well."""


def chosen(names: Iterable[str]) -> tuple[str, ...]:
    """Return the questions with some names, each once, in the order of the table.

    Raises
    ------
    UsageError
        If no name is given, or a name is not a question.
    """
    asked = {names} if isinstance(names, str) else set(several(names, "questions"))
    unknown = sorted(asked - set(KNOWN))
    if unknown or not asked:
        problem = repr(unknown[0]) if unknown else "none"
        raise UsageError(f"expected questions out of {', '.join(KNOWN)}; found {problem}")
    return tuple(name for name in KNOWN if name in asked)


_OF_FEEDTHROUGH = ("input_filters", "regulated")
"""The constructions with which plants with feedthrough are decided, and the set-points of those."""


def answered(name: str, certificate: Mapping[str, Any]) -> bool:
    """Whether a certificate answers a question, according to its kind, subject and channels.

    Parameters
    ----------
    name : str
        A question.
    certificate : mapping
        The document of a certificate that the checker found VALID.
    """
    question = KNOWN[name]
    subject = [{"construction": "dual"}] if question.dual else []
    channels = [channel["name"] for channel in certificate["system"]["channels"]]
    steps = certificate["subject"]
    if "D" in certificate["system"]:  # which is decided with the inputs as states
        steps = [each for each in steps if each["construction"] not in _OF_FEEDTHROUGH]
    if (certificate["kind"], steps) != (question.kind or name, subject):
        return False
    claim = certificate["claim"]
    if name in WITHIN_RADII and (claim["bound"] is None) is (name == "box_stabilizability"):
        return False
    return bool(claim.get("channels", channels) == channels)


def denied(name: str, certificate: Mapping[str, Any]) -> bool:
    """Whether a certificate proves that its plant lacks the property that a question is about.

    Parameters
    ----------
    name : str
        A question about every plant within the radii.
    certificate : mapping
        The document of a certificate that the checker found VALID.
    """
    claim = certificate["claim"]
    subject = [{"construction": "dual"}] if KNOWN[name].dual else []
    if certificate["subject"] != subject:
        return False
    if name in ("box_controllability", "box_observability"):
        channels = [channel["name"] for channel in certificate["system"]["channels"]]
        lacks = certificate["kind"] == "controllability" and claim["channels"] == channels
        return lacks and not claim["controllable"]
    if certificate["kind"] != "fixed_spectrum":
        return False
    return bool(claim["factors"]) if name == "box_fixed_modes" else not claim["stabilizable"]
