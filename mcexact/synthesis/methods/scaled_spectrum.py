"""Spectra for designs that name a rate alone: the eigenvalues that are moved, no faster than asked.

Numbers are decimals of a fixed precision, so that a spectrum is the same on every processor.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from decimal import ROUND_DOWN, Context, Decimal, localcontext
from fractions import Fraction

from mcexact.errors import InputError
from mcexact.exact.enclosures import root_discs
from mcexact.exact.location import StabilityRegion
from mcexact.exact.polynomial import Polynomial, product

_FASTER = Decimal("1.25")
_INSIDE = Decimal("0.9")
_PRECISION, _DIGITS = Context(prec=28), Context(prec=2)

Root = tuple[Decimal, Decimal]
"""Real and imaginary part; of a pair the one above the axis."""


def scaled_polynomial(own: Polynomial, region: StabilityRegion, degree: int) -> Polynomial:
    """Return a polynomial with every root in a region, the most of them roots of a given one.

    Parameters
    ----------
    own : Polynomial
        The characteristic polynomial of what a controller moves, of the given degree at most.
    region : StabilityRegion
        With a rate or a radius.
    degree : int
        Further roots are those of the controller.

    Returns
    -------
    Polynomial
        Continuous time: a root gets the real part −max(5/4·rate, |Re λ|), and further roots are
        minus the geometric mean of the moduli.  Discrete time: a modulus r becomes the least of r,
        1/r and ρ^(5/4) for the radius ρ, 9/10 for the radius 1, and further roots are the geometric
        mean of the moduli; what has a modulus below about 1/100 becomes 0.  Of equal roots the
        second and the third are two and three times as fast.  All numbers have two digits, in
        discrete time of their distance to 1.

    Raises
    ------
    InputError
        If the degree is less than that of the polynomial.

    Notes
    -----
    What is fast stays where it is, since gains grow with the distances by which roots are moved:
    for the four tanks of Johansson and the rate 1/100 from 9e24, with the roots −1, −2 and −3, to
    1.

    Examples
    --------
    >>> own = Polynomial.from_roots([-4, "1/3", 0])
    >>> found = scaled_polynomial(own, StabilityRegion.of("continuous", rate="1/10"), 4)
    >>> [float(-factor.coefficients[0]) for factor, _ in found.factor()]
    [-0.12, -0.33, -0.55, -4.0]
    """
    if degree < own.degree:
        raise InputError(f"expected a degree of at least {own.degree}, found {degree}")
    with localcontext(_PRECISION):
        roots = [_moved(each, region) for each in _roots(own)]
        mean = _mean([_modulus(each) for each in roots], region)
        more = (mean if region.discrete else -mean), Decimal(0)
        roots += [more] * (degree - own.degree)
        return product(_factor(each, region) for each in _apart(roots, region))


def _roots(own: Polynomial) -> Iterator[Root]:
    """The roots on the real axis and above it, each as often as it occurs, to twelve digits."""
    left = own
    while left.degree > 0:
        single = left.squarefree_part()
        for disc in root_discs(single):
            if not disc.im.startswith("-"):
                yield Decimal(disc.re), Decimal(disc.im)
        left = left // single


def _modulus(root: Root) -> Decimal:
    return (root[0] * root[0] + root[1] * root[1]).sqrt()


def _limit(region: StabilityRegion) -> Decimal:
    """The least rate, or the largest radius, of a root."""
    edge = Decimal(region.edge.numerator) / Decimal(region.edge.denominator)
    if not region.discrete:
        return _FASTER * edge
    return _INSIDE if edge == 1 else edge**_FASTER


def _moved(root: Root, region: StabilityRegion) -> Root:
    """Move a root into the region."""
    (re, im), limit, size = root, _limit(region), _modulus(root)
    if not region.discrete:
        return -max(limit, abs(re)), im
    if size <= limit:
        return root
    shrunk = min(limit, 1 / size) / size
    return shrunk * re, shrunk * im


def _mean(sizes: Sequence[Decimal], region: StabilityRegion) -> Decimal:
    """The geometric mean of the moduli that are not 0; the limit without any."""
    logarithms = [each.ln() for each in sizes if each]
    if not logarithms:
        return _limit(region)
    return (sum(logarithms, Decimal(0)) / len(logarithms)).exp()


def _apart(roots: Sequence[Root], region: StabilityRegion) -> Iterator[Root]:
    """Make the second and the third of equal roots faster, the fourth not, and so on."""
    seen = Counter[Root]()
    for root in roots:
        times = seen[root] % 3 + 1
        seen[root] += 1
        if region.discrete:
            part = _modulus(root) ** (times - 1) if times > 1 else Decimal(1)
            yield root[0] * part, root[1] * part
        else:
            yield root[0] * times, root[1]


def _factor(root: Root, region: StabilityRegion) -> Polynomial:
    """The monic factor of a root with two digits, and of its conjugate."""
    if region.discrete:
        # Towards 0, so that the modulus does not grow.
        unit = Decimal(10) ** ((1 - _modulus(root)).adjusted() - 1)
        re, im = (Fraction(each.quantize(unit, ROUND_DOWN)) for each in root)
    else:
        re, im = (Fraction(_DIGITS.plus(each)) for each in root)
    if not root[1]:
        return Polynomial((-re, Fraction(1)))
    return Polynomial((re * re + im * im, -2 * re, Fraction(1)))
