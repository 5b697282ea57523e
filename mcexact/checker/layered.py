"""Matrices of polynomials in the parameter t, by their coefficients, perhaps modulo a monic q."""

from itertools import zip_longest

from .arithmetic import Matrix, Polynomial
from .budget import counted
from .parametric_system import Layers


def product(P: Layers, Q: Layers, q: Polynomial | None = None) -> Layers:
    """P·Q, reduced modulo q if it is given.

    Open: see ``proofs/OPEN.md``.
    """
    result = [Matrix.zeros(P[0].nrows, Q[0].ncols) for _ in range(len(P) + len(Q) - 1)]
    some = [(j, right) for j, right in enumerate(Q) if not right.is_zero()]
    for i, left in counted([*enumerate(P)]):
        if not left.is_zero():
            for j, right in some:
                result[i + j] = result[i + j] + left @ right
    return reduced(result, q)


def reduced(P: Layers, q: Polynomial | None) -> Layers:
    """The remainder modulo q, which is monic of degree ≥ 1."""
    rest = list(P)
    while q is not None and len(rest) >= len(q):
        top = rest.pop()
        for k, c in enumerate(q[:-1]):
            if c and not top.is_zero():
                place = len(rest) - len(q) + 1 + k
                rest[place] = rest[place] - top.times(c)
    return rest


def difference(P: Layers, Q: Layers) -> Layers:
    """P − Q."""
    zero = Matrix.zeros(P[0].nrows, P[0].ncols)
    return [a - b for a, b in zip_longest(P, Q, fillvalue=zero)]


def is_zero(P: Layers) -> bool:
    """Whether every entry is 0."""
    return all(layer.is_zero() for layer in P)
