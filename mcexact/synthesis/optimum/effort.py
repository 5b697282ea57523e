"""The work that a search may do, counted and not timed, so that it ends alike everywhere."""

from __future__ import annotations

from dataclasses import dataclass, field

_OVERHEAD = 48
"""The number of states at which the arithmetic of one cost takes as long as what surrounds it."""
PER_SECOND = 3000
"""About as many units as a processor of 2024 does in a second."""


@dataclass
class Effort:
    """A number of units, each about the cost of one loop of a few states.

    Attributes
    ----------
    limit : float
    spent : float
    whole : Effort or None
        What this is a part of, where everything is counted too.

    Examples
    --------
    >>> effort = Effort(100)
    >>> part = effort.part(0.5)
    >>> part.take(0, times=50)
    >>> part.over, effort.left
    (True, 50.0)
    """

    limit: float
    spent: float = 0.0
    whole: Effort | None = field(default=None, repr=False)

    def take(self, states: int, times: float = 1.0) -> None:
        """Count some costs of a loop of some states, of O(N³) operations each."""
        self._add(times * (1 + (states / _OVERHEAD) ** 3))

    def _add(self, cost: float) -> None:
        self.spent += cost
        if self.whole is not None:
            self.whole._add(cost)

    @property
    def left(self) -> float:
        """What is left, 0 or more."""
        return max(self.limit - self.spent, 0.0)

    @property
    def over(self) -> bool:
        """Whether nothing is left."""
        return self.left <= 0

    def part(self, share: float) -> Effort:
        """Return a part of what is left."""
        return Effort(self.left * share, whole=self)
