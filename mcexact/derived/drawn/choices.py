"""Where drawn systems get their choices from: a seed, or whoever else can choose."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Protocol, TypeVar

T = TypeVar("T")


class Choices(Protocol):
    """A source of choices.

    Implementations should make small numbers and early options the simple ones, so that a search
    for a simple example goes there.
    """

    def integer(self, low: int, high: int) -> int:
        """An integer from ``low`` to ``high``, both included."""
        ...  # pragma: no cover

    def option(self, options: Sequence[T]) -> T:
        """One of the options."""
        ...  # pragma: no cover


class SeededChoices:
    """Choices from a seed: the same seed makes the same choices.

    Parameters
    ----------
    seed : int or str

    Examples
    --------
    >>> first, second = SeededChoices(7), SeededChoices(7)
    >>> first.integer(0, 10**6) == second.integer(0, 10**6)
    True
    """

    def __init__(self, seed: int | str) -> None:
        self._random = random.Random(seed)

    def integer(self, low: int, high: int) -> int:
        """An integer from ``low`` to ``high``, both included, uniformly."""
        return self._random.randint(low, high)

    def option(self, options: Sequence[T]) -> T:
        """One of the options, uniformly."""
        return options[self._random.randrange(len(options))]


def shuffled(choices: Choices, items: Sequence[T]) -> list[T]:
    """The items in a drawn order; the simplest choices keep the order."""
    rest = list(items)
    return [rest.pop(choices.integer(0, len(rest) - 1)) for _ in items]
