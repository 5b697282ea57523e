"""The questions of `mcexact analyze` by the names of its options."""

from __future__ import annotations

from typing import Any

from mcexact.analysis.analyze import Analysis, analyze
from mcexact.answer.account import Account
from mcexact.cli.analyze import _BESIDES
from mcexact.model.system import MultiChannelSystem


def asked(plant: MultiChannelSystem, **question: Any) -> Analysis:
    """As the command asks, with ``minimal=True`` and so on."""
    options = {option: question.pop(option.replace("-", "_"), False) for option in _BESIDES}
    named = [name for option, wanted in options.items() if wanted for name in _BESIDES[option]]
    return analyze(plant, besides=named, **question)


def account_of(plant: MultiChannelSystem, **question: Any) -> Account:
    """Everything decided, with what follows from it."""
    return asked(plant, **question).account
