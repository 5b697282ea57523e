"""Sources of the choices from which systems are drawn, such as a seed."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Protocol, TypeVar

T = TypeVar("T")


class Choices(Protocol):
    """A source of choices.

    Small numbers and early options should give simple systems, since a search for a simple example
    prefers these.
    """

    def integer(self, low: int, high: int) -> int:
        """Draw an integer from ``low`` to ``high``, both included."""
        ...  # pragma: no cover

    def option(self, options: Sequence[T]) -> T:
        """Draw one of the options."""
        ...  # pragma: no cover


class SeededChoices:
    """Pseudorandom choices, which are determined by a seed.

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
        """Draw an integer from ``low`` to ``high``, both included, uniformly."""
        return self._random.randint(low, high)

    def option(self, options: Sequence[T]) -> T:
        """Draw one of the options uniformly."""
        return options[self._random.randrange(len(options))]


def shuffled(choices: Choices, items: Sequence[T]) -> list[T]:
    """Draw a permutation of the items; the simplest choices keep their order."""
    rest = list(items)
    return [rest.pop(choices.integer(0, len(rest) - 1)) for _ in items]
