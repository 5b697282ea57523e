"""The questions of `mcexact analyze` by the names of its options."""

from __future__ import annotations

from typing import Any

from mcexact.analysis.analyze import Analysis, analyze
from mcexact.analysis.questions import asked_by
from mcexact.answer.account import Account
from mcexact.model.system import MultiChannelSystem


def asked(plant: MultiChannelSystem, **question: Any) -> Analysis:
    """As the command asks, with ``minimal=True`` and so on."""
    names = ("minimal", "links", "delayed", "failures", "fewest-failures")
    options = [name for name in names if question.pop(name.replace("-", "_"), False)]
    options += ["every-channel"] * question.pop("every_channel", False)
    return analyze(plant, also=asked_by(*options), **question)


def account_of(plant: MultiChannelSystem, **question: Any) -> Account:
    """Everything decided, with what follows from it."""
    return asked(plant, **question).account
