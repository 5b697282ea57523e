"""Polynomials in x whose coefficients are polynomials in a parameter t."""

from operator import mul

from . import budget, reading
from .arithmetic import Matrix, Polynomial, Rows, poly_divide, stack, stripped
from .arithmetic import poly_product as times
from .characteristic_polynomial import characteristic_polynomial, characteristic_polynomial_modulo
from .interpolation import interpolated
from .parametric_system import Layers
from .reading import Json, items, malformed
from .statement import polynomial_text

Bivariate = list[Polynomial]
"""Coefficients of the powers of x, constant first, each without zeros at its end; 0 is []."""


def read(value: Json, place: str, q: Polynomial | None = None) -> Bivariate:
    """A polynomial that is monic in x, of degree ≥ 1, with coefficients reduced modulo q."""
    result = read_coefficients(value, place)
    if any(c[-1:] == [0] or (q is not None and len(c) >= len(q)) for c in result):
        malformed(place, "expected reduced coefficients without zeros at the end")
    if len(result) < 2 or result[-1] != [1]:
        malformed(place, "expected a polynomial that is monic in x, of degree at least 1")
    return result


def read_coefficients(value: Json, place: str = "claim") -> Bivariate:
    """Lists of rationals."""
    budget.spend(100 * sum(len(items(c, place)) for c in items(value, place)))
    return [[reading.rational(entry, place) for entry in c] for c in value]


def text(p: Bivariate, t: str) -> str:
    """A polynomial such as x^2 + (t + 1)*x + (-2)."""
    terms = []
    for k, c in reversed([*enumerate(p)]):
        power = "" if k == 0 else "x" if k == 1 else f"x^{k}"
        if c == [1] and power:
            terms.append(power)
        elif c:
            terms.append(f"({polynomial_text(c, t)})" + ("*" if power else "") + power)
    return " + ".join(terms)


def modulo(f: Bivariate, q: Polynomial | None) -> Bivariate:
    """f with its coefficients reduced modulo q."""
    return list(f) if q is None else [poly_divide(c, q)[1] for c in f]


def divide(f: Bivariate, g: Bivariate, q: Polynomial | None = None) -> tuple[Bivariate, Bivariate]:
    """Quotient and remainder of f by g, monic in x, with coefficients reduced modulo q."""
    rest, quotient = list(f), []
    turns = max(len(f) - len(g) + 1, 0)
    budget.spend(budget.STEP + 10 * (len(f) + turns * len(g)))
    for _ in budget.counted(range(len(f) - len(g) + 1)):
        top = rest.pop()
        quotient.append(top)
        for k in range(len(g) - 1):
            if top and g[k]:
                place = len(rest) - len(g) + 1 + k
                rest[place] = _less(rest[place], times(top, g[k]))
                rest[place] = modulo([rest[place]], q)[0]
    return quotient[::-1], rest if any(rest) else []


def difference(f: Bivariate, g: Bivariate) -> Bivariate:
    """f − g."""
    length = max(len(f), len(g))
    first, second = ([*p, *[[]] * (length - len(p))] for p in (f, g))
    return [_less(a, b) for a, b in zip(first, second, strict=True)]


def _less(a: Polynomial, b: Polynomial) -> Polynomial:
    budget.spend(budget.fractions(len(a) + len(b), budget.limbs_of(a) + budget.limbs_of(b)))
    length = max(len(a), len(b))
    a, b = ([*p, *[0] * (length - len(p))] for p in (a, b))
    return stripped([x - y for x, y in zip(a, b, strict=True)])


def without(f: Bivariate, g: Bivariate, q: Polynomial | None = None) -> Bivariate:
    """f divided by g as often as it goes, over Q[t], or over Q[t]/(q)."""
    while True:
        quotient, rest = divide(f, g, q)
        if rest or len(f) < len(g):
            return f
        f = quotient


def degree(f: Bivariate) -> int:
    """The degree in t."""
    return max(map(len, f)) - 1


def characteristic(A: Layers, ell: int = 0) -> Bivariate:
    """det(xI − A(t)) through its values at t = 0, 1, …, over Q, or modulo ℓ if one is given.

    Open: see ``proofs/OPEN.md``.
    """
    return interpolated(_characteristic_values(A, ell), ell)


def determinant(A: Layers, ell: int = 0) -> Polynomial:
    """The determinant of A(t) or of −A(t), over Q, or modulo ℓ if one is given.

    Open: see ``proofs/OPEN.md``.
    """
    return interpolated([value[:1] for value in _characteristic_values(A, ell)], ell)[0]


def _characteristic_values(A: Layers, ell: int) -> list[Polynomial]:
    """det(xI − A(t)) for t = 0, 1, …, as many as its degree in t asks for."""
    n = A[0].nrows
    sides = [[_length(A, i, False) for i in range(n)], [_length(A, i, True) for i in range(n)]]
    many = min(map(sum, sides)) + 1
    if ell:
        rows = [layer.modulo(ell) for layer in A]
        return [
            characteristic_polynomial_modulo(_at(rows, t, ell), ell)
            for t in budget.counted(range(many))
        ]
    above = stack(A, n)
    rows, d = [above.rows[k * n : (k + 1) * n] for k in range(len(A))], above.denominator
    values = []
    for t in budget.counted(range(many)):
        budget.build(n, n, above.limbs, budget.limbs([t]) * len(A), len(A))
        values.append(characteristic_polynomial(Matrix(_values(rows, t), n, d)))
    return values


def _length(A: Layers, i: int, column: bool) -> int:
    """The largest degree of an entry of a row or of a column."""
    budget.spend(len(A) * (20 + 4 * A[0].nrows))
    return max(
        k * any(row[i] for row in layer.rows) if column else k * any(layer.rows[i])
        for k, layer in enumerate(A)
    )


def _at(rows: list[Rows], t: int, ell: int) -> Rows:
    budget.spend(budget.reductions(len(rows), budget.limbs([ell])))
    budget.build(len(rows[0]), len(rows[0]), budget.limbs([ell]), 1, 2 * len(rows))
    return [[entry % ell for entry in row] for row in _values(rows, t, ell)]


def _values(rows: list[Rows], t: int, ell: int = 0) -> Rows:
    """The values of entries at t, whose powers may be reduced modulo ℓ."""
    powers = [1]
    for _ in rows[1:]:
        powers.append(powers[-1] * t % ell if ell else powers[-1] * t)
    return [
        [sum(map(mul, cell, powers)) for cell in zip(*row, strict=True)]
        for row in zip(*rows, strict=True)
    ]
