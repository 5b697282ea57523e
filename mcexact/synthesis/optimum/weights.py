"""Weights of the linear-quadratic cost of a plant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import block_diag

from mcexact.errors import InputError
from mcexact.exact.floats import matrix_from_float, matrix_to_float
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem

Floats = npt.NDArray[np.float64]

_NOISE = 1e-2
_ROUNDING = 1e-12
NAMES = ("Q", "R", "W", "V")


@dataclass(frozen=True, eq=False)
class Weights:
    """Weights of the cost E[x'Qx + u'Ru], and the covariances of the noises of state and outputs.

    Attributes
    ----------
    Q, W : ndarray, n × n
        The weight of the state, and the covariance of its noise.
    R : ndarray, p × p
        The weight of all inputs, in the order of the channels.
    V : ndarray, q × q
        The covariance of the noise of all outputs, in the order of the channels.
    """

    Q: Floats
    R: Floats
    W: Floats
    V: Floats

    @classmethod
    def unit(cls, system: MultiChannelSystem) -> Weights:
        """Return Q = R = W = I and V = I/100.

        Examples
        --------
        >>> weights = Weights.unit(MultiChannelSystem([[1]], [[[1]]], [[[1]]]))
        >>> weights.Q.tolist(), weights.V.tolist()
        ([[1.0]], [[0.01]])
        """
        p = sum(system.p(i) for i in range(system.m))
        q = sum(system.q(i) for i in range(system.m))
        return cls(np.eye(system.n), np.eye(p), np.eye(system.n), _NOISE * np.eye(q))

    @classmethod
    def of(cls, system: MultiChannelSystem, given: Mapping[str, Any] | None = None) -> Weights:
        """Return the weights that are given, and those of `unit` for the others.

        Parameters
        ----------
        system : MultiChannelSystem
        given : mapping of {"Q", "R", "W", "V"} to matrix, optional
            Symmetric matrices of numbers, as arrays or as lists of rows.  Q and W are positive
            semidefinite, R and V are positive definite.

        Raises
        ------
        InputError
            If a name is unknown, or a matrix has another size or is not as described.

        Examples
        --------
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
        >>> Weights.of(plant, {"R": [["1/4"]]}).R.tolist()
        [[0.25]]
        >>> Weights.of(plant, {"R": [[0]]})
        Traceback (most recent call last):
            ...
        mcexact.errors.InputError: weights.R: expected a positive definite matrix
        """
        found = cls.unit(system)
        for name, entries in (given or {}).items():
            where = f"weights.{name}"
            if name not in NAMES:
                raise InputError(f"expected one of {', '.join(NAMES)}, found {name!r}", where=where)
            size = len(getattr(found, name))
            found = replace(found, **{name: _checked(entries, size, where, definite=name in "RV")})
        return found

    def with_integrators(self, system: MultiChannelSystem) -> Weights:
        """Return the weights of `integrated_plant`, for the weights of a system.

        Integrators are weighed by 1 and have noise of covariance 1.  What agents measure of them
        has the noise of the outputs, independently.
        """
        sizes = [system.q(i) for i in range(system.m)]
        one, starts = np.eye(sum(sizes)), np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp)
        places = [np.arange(a, b) for a, b in pairwise(starts)]
        # The integrals of a channel come first, then its outputs.
        order = np.concatenate([[], *(p + k for p in places for k in (0, len(one)))]).astype(
            np.intp
        )
        V = block_diag(self.V, self.V)[np.ix_(order, order)]
        return Weights(block_diag(self.Q, one), self.R, block_diag(self.W, one), V)


def _checked(entries: Any, size: int, where: str, *, definite: bool) -> Floats:
    """Convert a symmetric matrix of a size, and check that it is (semi)definite."""
    if isinstance(entries, Matrix):
        M = entries
    elif isinstance(entries, np.ndarray):
        M = matrix_from_float(entries, "dyadic", where=where)
    else:
        M = _read(entries, where)
    if M.shape != (size, size):
        raise InputError(
            f"expected a {size} × {size} matrix, found {M.nrows} × {M.ncols}", where=where
        )
    if M != M.T:
        raise InputError("expected a symmetric matrix", where=where)
    found = matrix_to_float(M)
    if not np.all(np.isfinite(found)):
        raise InputError("expected numbers in the range of double precision", where=where)
    least, largest = np.linalg.eigvalsh(found)[[0, -1]] if size else (1.0, 1.0)
    if definite and not least > _ROUNDING * largest:
        raise InputError("expected a positive definite matrix", where=where)
    if not least >= -_ROUNDING * abs(largest):
        raise InputError("expected a positive semidefinite matrix", where=where)
    return found


def _read(entries: Any, where: str) -> Matrix:
    """Read rows of numbers, which may be floats or exact."""
    if not isinstance(entries, list | tuple) or not all(
        isinstance(row, list | tuple) for row in entries
    ):
        raise InputError("expected a list of rows of numbers", where=where)
    if any(isinstance(entry, float) for row in entries for entry in row):
        return matrix_from_float(entries, "decimal", where=where)
    return Matrix.from_rows(entries, where=where)
