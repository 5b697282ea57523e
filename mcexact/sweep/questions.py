"""What a sweep can ask about every system."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any

from mcexact.analysis.assignability import assignability
from mcexact.analysis.completeness import completeness
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.controllability_indices import (
    controllability_indices,
    observability_indices,
)
from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.transfer_graph import transfer_graph
from mcexact.errors import UsageError
from mcexact.model.system import MultiChannelSystem

QUESTIONS: MappingProxyType[str, Callable[[MultiChannelSystem], Any]] = MappingProxyType(
    {
        "fixed_spectrum": fixed_spectrum,
        "completeness": completeness,
        "joint_controllability": joint_controllability,
        "joint_observability": joint_observability,
        "controllability_indices": controllability_indices,
        "observability_indices": observability_indices,
        "transfer_graph": transfer_graph,
        "assignability": assignability,
    }
)
"""The decisions by name; each returns a result with a ``certificate``."""

# Where it is not a certificate of the question's own name about the plant itself.
_KIND = {
    "joint_controllability": "controllability",
    "joint_observability": "controllability",
    "observability_indices": "controllability_indices",
}
_ABOUT_THE_DUAL = {"joint_observability", "observability_indices"}


def chosen(names: Iterable[str]) -> tuple[str, ...]:
    """The questions of these names, each once, in the order of the table.

    Raises
    ------
    UsageError
        If there is none, or no question of a name.
    """
    asked = {names} if isinstance(names, str) else set(names)
    unknown = sorted(asked - set(QUESTIONS))
    if unknown or not asked:
        found = repr(unknown[0]) if unknown else "none"
        raise UsageError(f"expected questions out of {', '.join(QUESTIONS)}; found {found}")
    return tuple(name for name in QUESTIONS if name in asked)


def answered(name: str, certificate: Mapping[str, Any]) -> bool:
    """Whether a certificate is an answer to this question: by its kind, subject and channels.

    Parameters
    ----------
    name : str
        A question.
    certificate : mapping
        A document that the checker has found VALID.
    """
    subject = [{"construction": "dual"}] if name in _ABOUT_THE_DUAL else []
    channels = [channel["name"] for channel in certificate["system"]["channels"]]
    about = (certificate["kind"], certificate["subject"])
    named = certificate["claim"].get("channels", channels)
    return about == (_KIND.get(name, name), subject) and bool(named == channels)
