"""Which free entries of a gain matrix are equal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mcexact.synthesis.optimum.weights import Floats

Places = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Ties:
    """Which free entries of K are equal.

    Attributes
    ----------
    number : ndarray of int
        For each free entry the number of the value that it has.
    chosen : ndarray of bool
        The free entry, one for each value, from which the value of a given K is taken.
    """

    number: Places
    chosen: npt.NDArray[np.bool_]

    @property
    def count(self) -> int:
        """The number of values."""
        return int(np.count_nonzero(self.chosen))

    def values(self, entries: Floats) -> Floats:
        """Return the values of some entries."""
        found = np.empty(self.count)
        found[self.number[self.chosen]] = entries[self.chosen]
        return found

    def summed(self, entries: Floats) -> Floats:
        """Sum the entries that have the same value, as the chain rule does with gradients."""
        found = np.bincount(self.number, entries, minlength=self.count)
        return np.asarray(found, dtype=np.float64)
