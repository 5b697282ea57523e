"""Channel controllers that observe the estimation errors, of full or of reduced order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import inverse, row_echelon
from mcexact.exact.matrix import Matrix
from mcexact.synthesis.methods import ChannelController

Gain = Callable[[Matrix, Matrix], Matrix | None]


@dataclass(frozen=True)
class ErrorObserver:
    """A channel controller, with the combination of errors that its state estimates.

    Attributes
    ----------
    channel : ChannelController
    Y : Matrix, k×N
        z estimates Y e, and the error Y e − z is autonomous.
    L : Matrix
        The gain of the observer.
    """

    channel: ChannelController
    Y: Matrix
    L: Matrix


def full_order_observer(E: Matrix, B: Matrix, C: Matrix, G: Matrix, L: Matrix) -> ErrorObserver:
    """z' = (E − BG − LC) z + L y, u = −G z: of order N, exact for any G and L.

    Parameters
    ----------
    E : Matrix, N×N
    B, C : Matrix, N×p and q×N
    G, L : Matrix, p×N and N×q
    """
    channel = ChannelController(
        A=E - B @ G - L @ C,
        B=L,
        C=-G,
        D=Matrix.zeros(B.ncols, C.nrows),
        polynomial=None,
    )
    return ErrorObserver(channel, Matrix.identity(E.nrows), L)


def reduced_order_observer(
    E: Matrix, B: Matrix, C: Matrix, G: Matrix, gain: Gain
) -> ErrorObserver | None:
    """Make an observer of reduced order N − rank C, for the states that the outputs do not measure.

    Parameters
    ----------
    E, B, C, G : Matrix
        As in `full_order_observer`.
    gain : callable
        A function that returns L for a pair (E_22, E_12), such that E_22 − L E_12 is fast enough,
        or None.

    Returns
    -------
    ErrorObserver or None
        None if there is no gain.

    Notes
    -----
    With R = XC the echelon form of C, y_1 = Xy = Re and e_2 the entries of e without a pivot,
    e = V_1 y_1 + V_2 e_2; E_ij and B_i are the blocks of E and B in the coordinates (y_1, e_2), and

        z' = (E_22 − L E_12)(z + L y_1) + (E_21 − L E_11) y_1 + (B_2 − L B_1) u,
        u  = −G (V_1 y_1 + V_2 (z + L y_1)),

    so that z estimates Ye with Y e = e_2 − L y_1, and the spectrum of the loop is that of E − BG
    and of E_22 − L E_12 together (Luenberger).
    """
    R, pivots = row_echelon(C)
    X = _combination(C, pivots)
    N, rest = E.nrows, [j for j in range(E.nrows) if j not in set(pivots)]
    identity = Matrix.identity(N)
    V1 = identity.take(cols=list(pivots))
    W = identity.take(rows=rest)
    V2 = W.T - V1 @ R.take(cols=rest)
    L = gain(W @ E @ V2, R @ E @ V2)
    if L is None:
        return None
    Y = W - L @ R
    onto = V1 + V2 @ L
    driven = Y @ B
    feedback = G @ onto
    channel = ChannelController(
        A=Y @ E @ V2 - driven @ G @ V2,
        B=(Y @ E @ onto - driven @ feedback) @ X,
        C=-(G @ V2),
        D=-(feedback @ X),
        polynomial=None,
    )
    return ErrorObserver(channel, Y, L)


def _combination(C: Matrix, pivots: tuple[int, ...]) -> Matrix:
    """X with XC the echelon form of C, from rows of C that are independent."""
    _, independent = row_echelon(C.T)
    square = C.take(rows=list(independent), cols=list(pivots))
    X = inverse(square)
    if X is None:
        raise InternalError("independent rows are singular in their pivots")
    return X @ Matrix.identity(C.nrows).take(rows=list(independent))
