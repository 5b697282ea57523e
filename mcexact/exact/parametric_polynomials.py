"""Polynomials in x over Q[t, …] for one parameter and several, determinants and null spaces.

A `ParametricPolynomial` is c_0 + c_1 x + … + c_d x^d, with coefficients in Q[t_1, …, t_k] or, at
the roots of an irreducible polynomial q in one parameter, in the number field L = Q[t]/(q).  The
code of analysis holds all polynomials in x and parameters in this type; it becomes a tuple of
`Polynomial` or of `RationalFunction` where an answer is made.

It has two forms of plain data, and each is computed from the other when an operation needs it:

- dense, a list of flint's polynomials in t, the coefficients of the powers of x.  It needs one
  parameter.  Division by monic polynomials, values, residues, and all of arithmetic over L are
  several times faster in it.  Its routines are those of `exact.bivariate`.
- joined, one polynomial of flint in the parameters and x.  Greatest common divisors, factors and
  resultants over Q are computed in it, and everything for several parameters.

Matrices over Q[t] are `PolynomialMatrix`, which is fast for products; over Q[t_1, …, t_k] they are
rows of flint's polynomials (`exact.rational_functions`).  `characteristic` is computed by values
for the former and by traces (Faddeev and Le Verrier) for the latter, where values would be too
many.  Null spaces over L[x]/(p) and over Q(t)[x]/(p) take one parameter, and the matrix by its
coefficients of the powers of x.

Polynomials modulo a prime are not of this type.  They have residues of one word, the only operation
on them is the resultant with respect to x at many values of t, and a prime at which a degree drops
has to be seen by the caller; `exact.bivariate` has them as `Residues`.  What they lead to is a
`ModularPolynomial` in t.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import Any

import flint

from mcexact.errors import InputError, InternalError
from mcexact.exact import bivariate, rational_functions
from mcexact.exact.bivariate import Bivariate, Residues, Tower, X
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.modular import ModularPolynomial
from mcexact.exact.polynomial import Polynomial, from_fmpq_poly, to_fmpq_poly
from mcexact.exact.rational_functions import VARIABLE, RationalFunction, Rows, in_parameters, ring


@dataclass(frozen=True, eq=False)
class ParametricPolynomial:
    """A polynomial in x whose coefficients are in Q[t_1, …, t_k], or in L = Q[t]/(q).

    Operations on two polynomials need the same parameters and the same q, and raise `InputError`
    otherwise; so does `dense` with several parameters.

    Attributes
    ----------
    parameters : tuple of str
        At least one.
    form : list of flint.fmpq_poly, or flint.fmpq_mpoly
        The form that it was computed in; `dense` and `joined` give either.  Never changed.
    modulus : Polynomial or None
        q, monic and irreducible; then there is one parameter, and the form is dense and reduced.

    Examples
    --------
    x² − t, at all values of t, and where t = 4:

    >>> t, one = Polynomial.x(), Polynomial.of(1)
    >>> f = ParametricPolynomial.from_polynomials([-t, Polynomial.of(0), one], ("t",))
    >>> [str(c) for c in f.polynomials()], len(f.factors())
    (['-x', '0', '1'], 1)
    >>> [[str(c) for c in p.polynomials()] for p in f.modulo(Polynomial.of(-4, 1)).factors()]
    [['-2', '1'], ['2', '1']]
    """

    parameters: tuple[str, ...]
    form: Any
    modulus: Polynomial | None = None

    @classmethod
    def from_polynomials(
        cls, coefficients: Iterable[Polynomial], parameters: tuple[str, ...]
    ) -> ParametricPolynomial:
        """The polynomial with these coefficients, constant term first, for one parameter."""
        return cls(parameters, [to_fmpq_poly(c) for c in coefficients])

    # The two forms, and what answers hold.

    @cached_property
    def dense(self) -> Bivariate:
        """The coefficients of the powers of x, for one parameter."""
        if isinstance(self.form, list):
            return self.form
        if not self._is_single:
            names = ", ".join(self.parameters)
            raise InputError(f"expected a polynomial with one parameter, found {names}")
        rows: list[dict[int, Any]] = [{} for _ in range(self.degree + 1)]
        for (i, k), c in self.form.to_dict().items():
            rows[int(k)][int(i)] = c
        return [
            flint.fmpq_poly([row.get(i, 0) for i in range(max(row, default=-1) + 1)])
            for row in rows
        ]

    @cached_property
    def joined(self) -> Any:
        """One polynomial in the parameters and x."""
        if not isinstance(self.form, list):
            return self.form
        terms = enumerate(self.form)
        return ring(self.parameters).from_dict(
            {(i, k): c for k, p in terms for i, c in enumerate(p.coeffs()) if c != 0}
        )

    def polynomials(self) -> tuple[Polynomial, ...]:
        """The coefficients of the powers of x, constant first, for one parameter."""
        return tuple(map(from_fmpq_poly, self.dense))

    def functions(self) -> tuple[RationalFunction, ...]:
        """The coefficients of the powers of x, constant first, as functions of the parameters."""
        rows: list[dict[tuple[int, ...], Any]] = [{} for _ in range(self.degree + 1)]
        for exponents, c in self.joined.to_dict().items():
            rows[int(exponents[-1])][(*map(int, exponents[:-1]), 0)] = c
        inside = ring(self.parameters)
        return tuple(in_parameters(inside.from_dict(row), self.parameters) for row in rows)

    # Arithmetic.

    @property
    def degree(self) -> int:
        """The degree in x, and 0 for the polynomial 0."""
        if isinstance(self.form, list):
            return max(len(self.form) - 1, 0)
        return max(int(self.form.degrees()[-1]), 0)

    @property
    def denominator(self) -> int:
        """The least common denominator of the rational numbers in it, for one parameter."""
        return math.lcm(*bivariate.denominators(self.dense))

    @cached_property
    def _q(self) -> Any:
        return None if self.modulus is None else to_fmpq_poly(self.modulus)

    @property
    def _is_single(self) -> bool:
        return len(self.parameters) == 1

    def _same(self, other: ParametricPolynomial) -> None:
        if self.parameters != other.parameters or self.modulus != other.modulus:
            raise InputError("polynomials in different parameters, or over different fields")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ParametricPolynomial):
            return NotImplemented
        if self.parameters != other.parameters or self.modulus != other.modulus:
            return False
        if self._is_single:
            return self.dense == other.dense
        return bool(self.joined == other.joined)

    def __hash__(self) -> int:
        return hash((self.parameters, self.modulus, self.degree))

    def _like(self, form: Any) -> ParametricPolynomial:
        return ParametricPolynomial(self.parameters, form, self.modulus)

    def __mul__(self, other: ParametricPolynomial) -> ParametricPolynomial:
        self._same(other)
        if not self._is_single:
            return self._like(self.joined * other.joined)
        result = bivariate.product(self.dense, other.dense)
        return self._like(result if self._q is None else bivariate.reduced(result, self._q))

    def modulo(self, q: Polynomial) -> ParametricPolynomial:
        """The polynomial over Q[t]/(q), q monic and irreducible."""
        result = bivariate.reduced(self.dense, to_fmpq_poly(q))
        return ParametricPolynomial(self.parameters, result, q)

    def divides(self, other: ParametricPolynomial) -> bool:
        """Whether the other one is a multiple of this one, which is monic in x."""
        self._same(other)
        return not bivariate.divided(other.dense, self.dense, self._q)[1]

    def without(self, divisor: ParametricPolynomial) -> ParametricPolynomial:
        """The polynomial divided by a divisor, monic in x, as often as this divides it."""
        self._same(divisor)
        if self._is_single:
            return self._like(bivariate.without(self.dense, divisor.dense, self._q))
        f = self.joined
        while (pair := divmod(f, divisor.joined))[1] == 0:
            f = pair[0]
        return self._like(f)

    def gcd(self, other: ParametricPolynomial) -> ParametricPolynomial:
        """The greatest common divisor, monic over L; this polynomial is not 0."""
        self._same(other)
        if self._q is not None:
            return self._like(bivariate.gcd(self.dense, other.dense, self._q))
        return self._like(self.joined.gcd(other.joined))

    def is_coprime(self, other: ParametricPolynomial) -> bool:
        """Whether two polynomials over Q, monic in x, have no common factor."""
        self._same(other)
        return _are_apart_somewhere([self, other]) or bool(
            self.joined.gcd(other.joined).is_constant()
        )

    def factors(self) -> list[ParametricPolynomial]:
        """The distinct irreducible factors that depend on x, monic in x, in a fixed order.

        Over Q the polynomial is monic in x, up to a constant.  Certificates depend on the order:
        for one parameter it is by degrees, for several by the factors with integer coefficients.
        """
        if self._q is not None:
            return [self._like(p) for p in bivariate.factors(self.dense, self._q)]
        factors = [p for p, _ in self.joined.factor()[1] if p.degrees()[-1] > 0]
        if not self._is_single:
            return [self._like(_monic(p)) for p in sorted(factors, key=str)]
        monic = [self._like(self._like(_monic(p)).dense) for p in factors]
        return sorted(monic, key=lambda p: (p.degree, str(p.dense)))

    # Residues modulo primes, for one parameter.

    def residues(self, ell: int) -> Residues:
        """The polynomial modulo a prime that divides no denominator."""
        return bivariate.residues_in_x(self.dense, ell)

    def size(self) -> int:
        """The sum of the absolute values of all coefficients of the least integer multiple."""
        return bivariate.size(self.dense)

    def roots_modulo(self, q: Polynomial, ell: int) -> Iterator[tuple[int, int]]:
        """Yield the roots of q modulo a prime, each with the roots of this polynomial there."""
        return bivariate.roots_modulo(to_fmpq_poly(q), self.dense, ell)


def _monic(p: Any) -> Any:
    """A polynomial of flint, divided by its leading coefficient in x, which is constant."""
    degree = p.degrees()[-1]
    lead = {exponents[:-1]: c for exponents, c in p.to_dict().items() if exponents[-1] == degree}
    if len(lead) != 1 or any(*lead):
        raise InternalError("a factor of a monic polynomial is not monic")
    return p / lead.popitem()[1]


def _are_apart_somewhere(polynomials: Sequence[ParametricPolynomial]) -> bool:
    """Whether they have no common root at one value of t modulo a prime: then no common factor."""
    return len(polynomials[0].parameters) == 1 and bivariate.are_apart_somewhere(
        [f.dense for f in polynomials]
    )


def common_factors(polynomials: Sequence[ParametricPolynomial]) -> list[ParametricPolynomial]:
    """The factors (`ParametricPolynomial.factors`) of the greatest common divisor over Q."""
    if _are_apart_somewhere(polynomials):
        return []
    return reduce(ParametricPolynomial.gcd, polynomials).factors()


# Resultants with respect to x.


def resultant_factors(
    f: Sequence[ParametricPolynomial], g: Sequence[ParametricPolynomial]
) -> set[RationalFunction]:
    """The irreducible factors of the resultants of two lists of polynomials.

    No polynomial of the one list has a factor in common with one of the other, so that no resultant
    is 0.  Their coefficients are coprime integers, the first one positive.
    """
    return {
        h
        for a in f
        for b in g
        for h in rational_functions.irreducible_factors(
            a.joined.resultant(b.joined, VARIABLE), a.parameters
        )
    }


def resultant_modulo(f: Residues, g: Residues, ell: int) -> ModularPolynomial:
    """The resultant of two polynomials modulo a prime, monic in x."""
    return ModularPolynomial(ell, bivariate.resultant_modulo(f, g, ell))


def reduced_residues(f: Residues, q: Polynomial, ell: int) -> Residues:
    """A polynomial modulo a prime, with coefficients reduced modulo q."""
    return bivariate.reduced(f, bivariate.residues(to_fmpq_poly(q), ell))


def resultant_degree_bound(f: ParametricPolynomial, g: ParametricPolynomial) -> int:
    """A bound for the degree in t of Res(f, g) = ± Res(f, g − f), f and g monic in x."""
    return bivariate.resultant_degree_bound(f.dense, bivariate.difference(g.dense, f.dense))


def common_divisor(
    f: ParametricPolynomial,
    g: ParametricPolynomial,
    h: ParametricPolynomial,
    primes: Iterable[int],
) -> Polynomial:
    """The monic greatest common divisor of Res(f, g) ≠ 0 and Res(f, h), to be verified.

    Parameters
    ----------
    f, g, h : ParametricPolynomial
        With one parameter, monic in x.
    primes : iterable of int
        Without end, and none divides a denominator.
    """
    return from_fmpq_poly(bivariate.common_divisor(f.dense, g.dense, h.dense, primes))


# Determinants of matrices over Q[t, …].


def characteristic(M: PolynomialMatrix | Rows, parameters: tuple[str, ...]) -> ParametricPolynomial:
    """det(xI − M), by values for a `PolynomialMatrix`, by traces for rows.

    Examples
    --------
    >>> M = PolynomialMatrix.from_polynomials([[Polynomial.x()]])
    >>> a, b, x = ring(("a", "b")).gens()
    >>> [str(c) for c in characteristic(M, ("t",)).polynomials()]
    ['-x', '1']
    >>> characteristic([[a]], ("a", "b")).joined == x - a
    True
    """
    if isinstance(M, PolynomialMatrix):
        return ParametricPolynomial(parameters, bivariate.characteristic(M))
    inside = ring(parameters)
    x, zero, n = inside.gens()[-1], inside.constant(0), len(M)
    result, coefficient = x**n, inside.constant(1)
    power = [[zero] * n for _ in range(n)]
    for k in range(1, n + 1):
        power = rational_functions.product(M, power, zero)
        for i in range(n):
            power[i][i] = power[i][i] + coefficient
        below = rational_functions.product(M, power, zero)
        coefficient = sum((below[i][i] for i in range(n)), zero) / -k
        result = result + coefficient * x ** (n - k)
    return ParametricPolynomial(parameters, result)


def determinant(M: PolynomialMatrix) -> Polynomial:
    """det(M), by values.

    Examples
    --------
    >>> linear = PolynomialMatrix.identity(2).times_x()
    >>> str(determinant(linear - PolynomialMatrix.identity(2) - PolynomialMatrix.identity(2)))
    'x^2 - 4*x + 4'
    """
    where = bivariate.points(bivariate.degree_bound(M) + 1)
    values = []
    for t in where:
        part = M.at(t)
        entries = [flint.fmpq(v, part.denominator) for row in part.numerators for v in row]
        values.append(flint.fmpq_mat(part.nrows, part.ncols, entries).det())
    return from_fmpq_poly(bivariate.interpolated(values, where))


def determinant_modulo(M: PolynomialMatrix, ell: int) -> ModularPolynomial:
    """det(M) modulo a prime that divides no denominator, by values."""
    many = bivariate.degree_bound(M) + 1
    values = [M.at_residue(t, ell).determinant() for t in range(many)]
    return ModularPolynomial(ell, bivariate.interpolated_modulo(values, ell))


# Null spaces of matrices over Q[t], and over Q[t][x], at the roots of p.

Layers = Sequence[PolynomialMatrix]
"""A matrix over Q[t][x]: the coefficients of 1, x, …, matrices over Q[t] of one shape."""
Basis = tuple[tuple[int, ...], tuple[PolynomialMatrix, ...]]
"""The rows that form an identity matrix, or a multiple of it, and the columns, by layers."""


def nullspace_over_field(M: Layers, q: Polynomial, p: ParametricPolynomial | None = None) -> Basis:
    """The null space over Q[t]/(q)[x]/(p), in echelon form.

    Parameters
    ----------
    M : layers
        One if there is no p, and otherwise at most two.
    q : Polynomial
        Irreducible.
    p : ParametricPolynomial, optional
        Monic in x, irreducible over Q[t]/(q); without it nothing depends on x.
    """
    modulus = to_fmpq_poly(q)
    rows = [[[c % modulus for c in entry] for entry in row] for row in _entries(M)]
    basis = Tower(modulus, X if p is None else p.dense).nullspace(rows, M[0].ncols)
    return _basis(basis, M[0].ncols, 1 if p is None else p.degree)


def generic_nullspace(M: Layers, p: ParametricPolynomial | None = None) -> Basis:
    """The null space over Q(t)[x]/(p), multiplied by the least common denominator.

    It has the null spaces at some integers t as values, which is no proof.
    """
    rows = _entries(M)

    def sample(t: int) -> bivariate.Nullspace | None:
        value = X if p is None else bivariate.modulus_at(p.dense, t)
        if value is None:
            return None
        entries = [[[flint.fmpq_poly([c(t)]) for c in entry] for entry in row] for row in rows]
        return Tower(bivariate.line(t), value).nullspace(entries, M[0].ncols)

    basis = bivariate.over_functions(sample)
    return _basis(basis, M[0].ncols, 1 if p is None else p.degree)


def _entries(M: Layers) -> list[list[Bivariate]]:
    """The entries as polynomials in x, by their coefficients in Q[t]."""
    layers = list(map(entries_of, M))
    return [
        [[layer[i][j] for layer in layers] for j in range(M[0].ncols)] for i in range(M[0].nrows)
    ]


def _basis(basis: bivariate.Nullspace, nrows: int, degree: int) -> Basis:
    pivots, vectors = basis
    layers = (
        matrix_of([[v[i][k] for v in vectors] for i in range(nrows)], len(vectors))
        for k in range(degree)
    )
    return pivots, tuple(layers)


def entries_of(M: PolynomialMatrix) -> list[list[Any]]:
    """The entries as polynomials of flint."""
    layers, denominator = M.coefficients, M.denominator
    return [
        [flint.fmpq_poly([layer[i][j] for layer in layers], denominator) for j in range(M.ncols)]
        for i in range(M.nrows)
    ]


def matrix_of(rows: list[list[Any]], ncols: int) -> PolynomialMatrix:
    """The matrix of polynomials of flint in one variable."""
    polynomials = [[from_fmpq_poly(entry) for entry in row] for row in rows]
    return PolynomialMatrix.from_polynomials(polynomials, ncols=ncols)
