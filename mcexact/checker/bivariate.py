"""Polynomials in x and t, and matrices of polynomials by name.

A polynomial in x and t is kept as the coefficients of the powers of x, which are polynomials in t;
a matrix of polynomials in t is kept as its coefficients, one matrix for each power of t.

Characteristic polynomials, determinants and resultants with respect to x are computed at
t = 0, 1, …, at as many values as a bound on their degree in t requires, and interpolated: all
steps between work with numbers instead of polynomials.  A resultant over Z is combined from those
modulo several numbers, whose product is more than twice a bound on its coefficients.

`named_matrix` makes the matrices of which claims about ranks speak, such as that of equilibria,
from the plant.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise, zip_longest
from operator import mul
from typing import Any

from .core import budget, reading
from .core.arithmetic import (
    Matrix,
    Polynomial,
    Rows,
    beside,
    characteristic_polynomial,
    characteristic_polynomial_modulo,
    cleared,
    inverse,
    poly_divide,
    poly_modulo,
    poly_product,
    stack,
    stripped,
)
from .core.budget import counted
from .core.reading import (
    Json,
    fields,
    integer,
    items,
    malformed,
    names,
    polynomial,
    require,
    shown,
    string,
)
from .core.system import channel_set, polynomial_text, quoted
from .parametric_system import Layers, ParametricSystem

# Polynomials in x whose coefficients are polynomials in a parameter t.

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
                rest[place] = _less(rest[place], poly_product(top, g[k]))
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
    """det(xI − A(t)) through its values at t = 0, 1, …, over Q, or modulo ℓ unless it is 0.

    Open: see ``proofs/OPEN.md``.
    """
    return interpolated(_characteristic_values(A, ell), ell)


def determinant(A: Layers, ell: int = 0) -> Polynomial:
    """The determinant of A(t) or of −A(t), over Q, or modulo ℓ unless it is 0.

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


# Matrices of polynomials in the parameter t, by their coefficients, perhaps modulo a monic q.


def product(P: Layers, Q: Layers, q: Polynomial | None = None) -> Layers:
    """P·Q, reduced modulo q unless it is None.

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


def layered_difference(P: Layers, Q: Layers) -> Layers:
    """P − Q."""
    zero = Matrix.zeros(P[0].nrows, P[0].ncols)
    return [a - b for a, b in zip_longest(P, Q, fillvalue=zero)]


def is_zero(P: Layers) -> bool:
    """Whether every entry is 0."""
    return all(layer.is_zero() for layer in P)


# Resultants with respect to x of polynomials in x and t, modulo ℓ and over Q.

Residues = list[list[int]]


def residues(f: Bivariate, ell: int) -> Residues:
    """f modulo ℓ, which divides no denominator."""
    return [poly_modulo(c, ell) for c in f]


def resultant(f: Residues, g: Residues, ell: int) -> Polynomial:
    """The resultant of f and g, both monic in x, modulo ℓ, through its values at t = 0, 1, …

    Open: see ``proofs/OPEN.md``.
    """
    many = degree_bound(f, g) + 1
    values = [
        [_of_values(_at_point(f, t, ell), _at_point(g, t, ell), ell)]
        for t in budget.counted(range(many))
    ]
    return interpolated(values, ell)[0]


def degree_bound(f: Bivariate, g: Bivariate) -> int:
    """A bound for the degree in t of the resultant of f, monic in x, and g.

    It is the product of g(α) over the roots x = α of f, which are series in t at infinity.  The
    slopes do not increase, and the k-th coefficient of f has at most the degree that is the sum of
    the first slopes, as many as its degree in x exceeds k: this is all that the theorem needs.

    Theorem ``resultant_degree.resultant_degree``.
    """
    budget.spend(budget.fractions(len(f) * (len(f) + len(g)), 1))
    total: float | Fraction = 0
    for slope, steps in _degrees_of_roots(f):
        values = (len(c) - 1 + (k and k * slope) for k, c in enumerate(g) if c)
        total += steps * max(values, default=-math.inf)
    return int(max(total, 0))


def _degrees_of_roots(f: Bivariate) -> list[tuple[Fraction | float, int]]:
    """The degrees in t of the roots x, each with their number: slopes of the Newton polygon.

    The root 0 has the degree −∞.
    """
    slopes: list[tuple[Fraction | float, int]] = []
    k = len(f) - 1
    while k > 0:
        lines = ((Fraction(len(f[j]) - len(f[k]), k - j), k - j) for j in range(k) if f[j])
        slopes.append(max(lines, default=(-math.inf, k)))
        k -= slopes[-1][1]
    return slopes


def _at_point(f: Residues, t: int, ell: int) -> Polynomial:
    a = budget.limbs([ell])
    budget.spend(budget.STEP + budget.reductions(sum(map(len, f)) + 2 * len(f) + degree(f), a))
    powers = [1]
    for _ in range(degree(f)):
        powers.append(powers[-1] * t % ell)
    return [sum(map(mul, c, powers)) % ell for c in f]


def _of_values(f: Polynomial, g: Polynomial, ell: int) -> int:
    """Res(f, g) by remainders r of c·f, c a power of b, b leading in g, and one inverse at the end.

    Res(f, g) = (−1)^(deg f · deg g) b^(deg f − deg r) Res(g, r) / c^(deg g).
    """
    top, bottom, a = 1, 1, budget.limbs([ell])
    budget.spend(budget.inversions(2, a) + budget.reductions(20, a))
    while len(g) > 1:
        rest, power, b = _remainder(f, g, ell)
        # a power modulo ℓ, by the square and multiply method, of a number or of its inverse
        budget.spend(budget.inversions(1, a) + budget.reductions(20, a))
        # one b more above and below: the last inverse tells whether every b is a unit
        top, lost = top * b, (len(f) - len(rest)) - power * (len(g) - 1)
        bottom = bottom * pow(b, 1 - lost, ell) % ell
        if not rest:
            return 0 * inverse(bottom, ell)
        if (len(f) - 1) * (len(g) - 1) % 2:
            top = -top
        top, f, g = top % ell, g, rest
    return top * inverse(bottom, ell) * pow(g[0], len(f) - 1, ell) % ell


def _remainder(f: Polynomial, g: Polynomial, ell: int) -> tuple[Polynomial, int, int]:
    """The remainder of b^k f by g, k ≥ 2, with k and b, the leading coefficient of g."""
    rest, b, k = [*f, *[0] * (len(g) + 1 - len(f))], g[-1], 2
    turns = len(rest) - len(g)
    budget.spend(100 + 2 * budget.reductions(turns * len(rest) + 16, budget.limbs([ell])))
    while len(rest) > len(g) + 1:
        last, k = rest.pop(), k + 1
        shifted = [*[0] * (len(rest) + 1 - len(g)), *g]
        rest = [(b * c - last * d) % ell for c, d in zip(rest, shifted, strict=False)]
    # the last two turns at once, with one reduction for each coefficient
    last, factor = rest[-1], b * b % ell
    both, before = b * last % ell, (b * rest[-2] - last * g[-2]) % ell
    triples = zip(rest[:-2], g, [0, *g], strict=False)
    return stripped([(factor * c - before * d - both * e) % ell for c, d, e in triples]), k, b


def integer_resultant(f: Bivariate, g: Bivariate, moduli: list[int]) -> list[int]:
    """The resultant of the least integer multiples of f and g, both monic in x, over Z.

    Its coefficients are at most |f|₁^(deg g) |g|₁^(deg f), |f|₁ the sum of the absolute values of
    all coefficients of the multiple, and the product of the moduli, pairwise coprime, is larger
    than twice this.
    """
    (c, first), (d, second) = map(_multiple, (f, g))
    a, b = budget.limbs([first, c]) * (len(g) - 1), budget.limbs([second, d]) * (len(f) - 1)
    budget.spend(budget.products(8, a + b + 1, a + b + 1))
    size = first ** (len(g) - 1) * second ** (len(f) - 1)
    factor, product, coefficients = c ** (len(g) - 1) * d ** (len(f) - 1), 1, [0]
    for ell in budget.counted(moduli):
        part = resultant(residues(f, ell), residues(g, ell), ell)
        part = [factor * entry % ell for entry in part]
        length, shift = max(len(part), len(coefficients)), inverse(product, ell)
        coefficients, part = ([*p, *[0] * (length - len(p))] for p in (coefficients, part))
        longest = budget.limbs([product, ell]) * 2
        budget.spend(budget.products(4 * length, longest, longest))
        pairs = zip(coefficients, part, strict=True)
        coefficients = [old + (new - old) * shift % ell * product for old, new in pairs]
        product *= ell
    enough = product > 2 * size
    require(enough, "modulus", "witness.moduli", f"expected a product above 2^{size.bit_length()}")
    return stripped([entry - product if 2 * entry > product else entry for entry in coefficients])


def _multiple(f: Bivariate) -> tuple[int, int]:
    """The least d ≥ 1 that makes d·f integer, and the sum of the absolute values of d·f."""
    budget.spend(10 * sum(map(len, f)))
    numbers, d = cleared([c for part in f for c in part])
    return d, sum(map(abs, numbers))


# Matrices of polynomials in a parameter that are made from a plant, by name.

KEYS = {
    "setpoint": (),
    "signal": ("polynomial",),
    "controllability": ("channels", "blocks"),
    "transfer": ("from", "to"),
}


def named_matrix(value: Json, system: ParametricSystem) -> Layers:
    """The coefficients of a matrix, from those of A', B_i' and C_i'.

    Where no denominator vanishes, its rank is that of the same matrix made from A, B_i and C_i.

    Open: see ``proofs/OPEN.md``.
    """
    place = "claim.matrix"
    name = value.get("name") if isinstance(value, dict) else None
    if type(name) is not str or name not in KEYS:
        malformed(place, f"expected the name of a matrix, found {shown(name)}")
    _, *parts = fields(value, place, "name", *KEYS[name])
    if name == "setpoint":
        return _signals([-1 if system.time == "discrete" else 0, 1], system)
    if name == "signal":
        return _signals(polynomial(parts[0], f"{place}.polynomial", 1), system)
    if name == "controllability":
        T, k = names(parts[0], place, system.names), integer(parts[1], place, 1)
        require(k <= max(system.n, 1), "claim", place, f"expected at most {system.n} blocks")
        power, blocks = _side_by_side([system.B[i] for i in T], system.n), []
        for _ in counted(range(k)):
            blocks.append(power)
            power = product(system.A, power)
        return _side_by_side(blocks, system.n)
    j, i = (names([name], place, system.names)[0] for name in parts)
    row, columns = system.C[i], []
    for _ in counted(range(system.n)):
        block = product(row, system.B[j])
        columns += [[layer.take(cols=[k]) for layer in block] for k in range(block[0].ncols)]
        row = product(row, system.A)
    return _below_each_other(columns, 1)


def _signals(p: Polynomial, system: ParametricSystem) -> Layers:
    """[I x A' - K x δI, I x B'; I x C', 0], K the companion matrix of p, which is monic."""
    n, d = system.n, len(p) - 1
    B, C = _side_by_side(list(system.B), n), _below_each_other(list(system.C), n)
    identity, q = Matrix.unit_rows(n, 0, n), C[0].nrows
    blank = {ends: [Matrix.zeros(*ends)] for ends in ((n, B[0].ncols), (q, n), (q, B[0].ncols))}
    upper, lower = [], []
    for i in counted(range(d)):
        row: list[Layers] = []
        for j in counted(range(d)):
            # the entry of -K: -1 below the diagonal, the coefficients of p in the last column
            c = (p[i] if j == d - 1 else 0) - (j == i - 1)
            block = [identity.times(-c * value) for value in system.scale]
            start = system.A if i == j else [Matrix.zeros(n, n)]
            row.append(layered_difference(start, block))
        inputs = [B if i == j else blank[n, B[0].ncols] for j in range(d)]
        upper.append(_side_by_side([*row, *inputs], n))
        outputs = [C if i == j else blank[q, n] for j in range(d)]
        lower.append(_side_by_side([*outputs, *[blank[q, B[0].ncols]] * d], q))
    return _below_each_other([*upper, *lower], d * (n + B[0].ncols))


def _side_by_side(parts: list[Layers], nrows: int) -> Layers:
    many = max([len(part) for part in parts] + [1])
    return [beside([_layer(part, k) for part in parts], nrows) for k in range(many)]


def _below_each_other(parts: list[Layers], ncols: int) -> Layers:
    many = max([len(part) for part in parts] + [1])
    return [stack([_layer(part, k) for part in parts], ncols) for k in range(many)]


def _layer(part: Layers, k: int) -> Matrix:
    return part[k] if k < len(part) else Matrix.zeros(part[0].nrows, part[0].ncols)


def named_text(value: Json, system: ParametricSystem) -> str:
    """A matrix in words."""
    string(value["name"], "claim.matrix.name", *KEYS)
    everyone = "the matrices A, B and C of all channels"
    if value["name"] == "setpoint":
        shift = " - I" if system.time == "discrete" else ""
        return f"[A{shift}, B; C, 0] with {everyone}"
    if value["name"] == "signal":
        blocks = "[kron(I, A) - kron(K, I), kron(I, B); kron(I, C), 0]"
        companion = f"the companion matrix K of {polynomial_text(value['polynomial'])}"
        return f"{blocks} with {everyone}, {companion} and the Kronecker product kron"
    if value["name"] == "controllability":
        blocks = f"the matrix of the first {value['blocks']} of the blocks B, A B, A^2 B, ..."
        inputs = f"the inputs of the channels {channel_set(value['channels'])}"
        return f"{blocks} with the matrix A and the matrix B of {inputs}"
    factors = f"the column of all entries of the first {system.n} of C B, C A B, C A^2 B, ..."
    inputs = f"the matrix B of the inputs of channel {quoted(value['from'])}"
    outputs = f"the matrix C of the outputs of channel {quoted(value['to'])}"
    return f"{factors} with the matrix A, {inputs} and {outputs}"


# Polynomials in a parameter t from their values at 0, 1, …, over Q and modulo ℓ.


def interpolated(values: list[Polynomial], ell: int = 0) -> list[Polynomial]:
    """The coefficients with these values at t = 0, 1, …, one polynomial in t for each (Newton).

    Open: see ``proofs/OPEN.md``.
    """
    many, longest = len(values), max(map(budget.limbs_of, values))
    units = budget.reductions(1, longest) if ell else budget.fractions(1, longest + many // 8)
    budget.spend(2 * units * many * many * len(values[0]))
    inverses = [inverse(k, ell) if ell else Fraction(1, k) for k in range(1, many)]
    return [_of_column([*column], inverses, ell) for column in zip(*values, strict=True)]


def _of_column(values: list[Any], inverses: list[Any], ell: int) -> Polynomial:
    """Σ Δ^k / k! · t (t − 1) … (t − k + 1), Δ^k the differences of order k at 0."""
    slopes: list[Any] = values[:1]
    scale: Any = 1
    for f in inverses:
        scale = scale * f % ell if ell else scale * f
        differences = [b - a for a, b in pairwise(values)]
        values = [c % ell for c in differences] if ell else differences
        slopes.append(values[0] * scale)
    p: Polynomial = []
    for t in reversed(range(len(slopes))):
        p = [a - t * b for a, b in zip([slopes[t], *p], [*p, 0], strict=True)]
        p = [c % ell for c in p] if ell else p
    return stripped(p)
