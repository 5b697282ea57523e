"""Weights of the linear-quadratic cost of a plant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mcexact.model.system import MultiChannelSystem

Floats = npt.NDArray[np.float64]

_NOISE = 1e-2


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
