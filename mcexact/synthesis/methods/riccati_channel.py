"""Channel controllers from two Riccati equations, in floating point."""

from __future__ import annotations

from fractions import Fraction

from mcexact.exact.floats import dyadic_matrix, matrix_to_float
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.synthesis.methods.channel_controller import ChannelController
from mcexact.synthesis.methods.channel_parts import ChannelPart
from mcexact.synthesis.methods.riccati import riccati_feedback

_BITS = 36
_EFFORTS = (1.0, 1e2, 1e-2)
_MARGINS = (Fraction(0), Fraction(1, 16), Fraction(1, 4))


def riccati_channel_controller(
    part: ChannelPart, region: StabilityRegion
) -> ChannelController | None:
    """Compute an observer and a state feedback for a minimal triple; None if they are too slow.

    Parameters
    ----------
    part : ChannelPart
        d states.
    region : StabilityRegion

    Returns
    -------
    ChannelController or None
        The controller ż = (A + BG + LC) z − L y, u = G z, of order d.  Its closed-loop polynomial
        χ_{A+BG} χ_{A+LC} has every root in the region, decided exactly.

    Notes
    -----
    Floating point proposes G and L, as dyadic rationals that depend on the processor and on the
    versions of numpy and scipy; the rest is exact.
    """
    G = _gain(part.A, part.B, region)
    L = None if G is None else _gain(part.A.T, part.C.T, region)
    if G is None or L is None:
        return None
    feedback, injection = part.A + part.B @ G[0], part.A + L[0].T @ part.C
    return ChannelController(
        feedback + injection - part.A, -L[0].T, G[0], Matrix.zeros(G[0].nrows, part.C.nrows),
        G[1] * L[1],
    )  # fmt: skip


def _gain(A: Matrix, B: Matrix, region: StabilityRegion) -> tuple[Matrix, Polynomial] | None:
    """Compute a gain for which A + BG lies in the region, and the polynomial that proves it."""
    states, inputs = matrix_to_float(A), matrix_to_float(B)
    for effort in _EFFORTS:
        for margin in _MARGINS:
            target = region.tightened(margin, offset=1)
            found = riccati_feedback(states, inputs, target, effort=effort)
            if found is None:
                break
            G = dyadic_matrix(found, bits=_BITS)
            polynomial = characteristic_polynomial(A + B @ G)
            if region.contains_roots_of(polynomial):
                return G, polynomial
    return None
