"""Eigenvalues in the complex plane, with their region, multiplicities and certified discs."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.errors import UsageError
from mcexact.exact.matrix import to_float
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import power_of_ten_above
from mcexact.exact.roots import StabilityRegion, is_discrete, root_discs
from mcexact.plot.canvas import BLUE, GRAY, LIGHT, RED, legend_below, one_axis

_WIDE, _POWERS, _TICKS = 100.0, 3, 5
_NEAR = 3
"""A circle is drawn if its radius is at most this multiple of the largest modulus."""
_SAMPLES = [10 ** (-each / 50) for each in range(401)]
"""A geometric sequence from 1 to 10⁻⁸."""
_SEEN = 1 / 200
"""The least radius of a disc that is drawn, as a part of the picture's width."""


@dataclass(frozen=True)
class Point:
    """An eigenvalue in the picture.

    Attributes
    ----------
    place : complex
    radius : Fraction
        Of the disc that is proved to contain it; 0 if it is exact or nothing is proved.
    multiplicity : int or None
        The number of times it is a root, if that is proved.
    """

    place: complex
    radius: Fraction = Fraction(0)
    multiplicity: int | None = None


def points_of(source: Any) -> tuple[Point, ...]:
    """Return the eigenvalues that an object has.

    Parameters
    ----------
    source : Polynomial, object with ``polynomial``, or sequence of complex
        For a polynomial each root has a verified disc, and its multiplicity is exact.

    Raises
    ------
    UsageError
        If the object is neither of these.

    Examples
    --------
    >>> [(each.place, each.multiplicity) for each in points_of(Polynomial.from_roots([-1, -1, 2]))]
    [((-1+0j), 2), ((2+0j), 1)]
    >>> points_of([1j])
    (Point(place=1j, radius=Fraction(0, 1), multiplicity=None),)
    """
    polynomial = source if isinstance(source, Polynomial) else getattr(source, "polynomial", None)
    if isinstance(polynomial, Polynomial):
        known = getattr(source, "discs", ())
        parts = [(known, 1)]
        if len(known) != polynomial.degree:
            factors = polynomial.factor()
            parts = [(root_discs(each), count) for each, count in factors if each.degree]
        points = [
            Point(
                complex(to_float(disc.re), to_float(disc.im)),
                Fraction(disc.radius),
                count,
            )
            for discs, count in parts
            for disc in discs
        ]
        return tuple(sorted(points, key=lambda each: (each.place.real, each.place.imag)))
    if isinstance(source, Iterable):
        return tuple(Point(complex(each)) for each in source)
    raise UsageError(
        f"expected a polynomial, something that has one, or numbers; found {type(source).__name__}"
    )


def eigenvalues(
    found: Any,
    ax: Any = None,
    *,
    time: str = "continuous",
    region: StabilityRegion | None = None,
    title: str = "eigenvalues",
) -> Any:
    """Draw eigenvalues, the stability region in gray and the edges of the region as dashed lines.

    Parameters
    ----------
    found : Polynomial, object with ``polynomial``, or sequence of complex
        A characteristic polynomial, an answer that states one, or numbers.  Roots of a polynomial
        have exact multiplicities, which are written beside them, and verified discs, which are
        drawn where they can be seen.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.
    time : {"continuous", "discrete"}
        The time domain; that of the region, if there is one.
    region : StabilityRegion, optional
        The region in which the eigenvalues should lie.
    title : str

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> figure = eigenvalues(Polynomial.from_roots([-1, -1, -2]))
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['×2']
    """
    axis = one_axis(ax)
    points = points_of(found)
    draw_places(
        axis, [each.place for each in points], time if region is None else region.time, region
    )
    axis.set_title(title, fontsize="medium")
    _draw_discs(axis, points)
    for each in points:
        if each.multiplicity is not None and each.multiplicity > 1:
            axis.annotate(
                f"×{each.multiplicity}",
                (each.place.real, each.place.imag),
                xytext=(4, 4),
                textcoords="offset points",
                fontsize="small",
            )
    return axis.figure


def draw_places(
    axis: Any, places: Sequence[complex], time: str, region: StabilityRegion | None
) -> None:
    """Draw crosses, the stability region in gray, and the edges of a region as dashed lines.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    places : sequence of complex
        Infinities and NaN are left out.
    time : {"continuous", "discrete"}
    region : StabilityRegion or None
        None draws no edges.
    """
    finite = [each for each in places if cmath.isfinite(each)]
    edge = None if region is None else to_float(region.edge)
    if is_discrete(time):
        _draw_disc(axis, edge, finite)
    else:
        limits = {} if region is None else region.limits
        corners = [-size, size * 1j] if (size := circle_near(finite, limits)) else []
        _draw_half_plane(axis, edge, [*finite, *corners])
        _draw_limits(axis, limits)
    axis.plot(
        [each.real for each in finite],
        [each.imag for each in finite],
        linestyle="none",
        marker="x",
        color=BLUE,
    )
    axis.axhline(0, color=GRAY, linewidth=0.6, zorder=0.5)
    axis.set_xlabel("real part")
    axis.set_ylabel("imaginary part")
    if axis.get_xscale() == "linear":
        axis.locator_params(axis="x", nbins=_TICKS)


def circle_near(places: Sequence[complex], limits: Mapping[str, Fraction]) -> float:
    """The largest modulus whose circle is in a picture of these places; 0 if there is none.

    Examples
    --------
    >>> [circle_near([-2], {"largest_modulus": Fraction(each)}) for each in (5, 50)]
    [5.0, 0.0]
    """
    size = to_float(limits.get("largest_modulus", Fraction(0)))
    return size if size <= _NEAR * max(map(abs, places), default=1.0) else 0.0


def _draw_disc(axis: Any, edge: float | None, places: Sequence[complex]) -> None:
    """The unit disc in gray, and the circle of the radius."""
    from matplotlib.patches import Circle

    axis.add_patch(Circle((0, 0), 1, color=LIGHT, zorder=0))
    if edge is not None:
        axis.add_patch(Circle((0, 0), edge, fill=False, edgecolor=RED, linestyle="--", linewidth=1))
    reach = 1.1 * max([1.0, *(abs(part) for each in places for part in (each.real, each.imag))])
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal", adjustable="box")


def _draw_half_plane(axis: Any, edge: float | None, places: Sequence[complex]) -> None:
    """The left half-plane in gray, and the line of the rate."""
    sizes = [abs(each) for each in places if each]
    least, largest = min(sizes, default=1.0), max(sizes, default=1.0)
    reals = [*(each.real for each in places), 0.0, -(edge or 0.0)]
    left, right = min(reals), max(reals)
    height = max((abs(each.imag) for each in places), default=0.0)
    if largest > _WIDE * least:
        # Slow eigenvalues would lie on one spot.
        ticks = _decades(least, largest)
        for scale in (axis.set_xscale, axis.set_yscale):
            scale("symlog", linthresh=least, linscale=0.6)
        for ticked in (axis.xaxis, axis.yaxis):
            ticked.set_ticks(ticks, [f"{each:g}" for each in ticks])
        limits = 3 * left or -least, 3 * right or least / 2
        height = max(3 * height, *(1.5 * each for each in ticks if 0 < each < 10.1 * least), least)
    else:
        room = 0.15 * max(right - left, height / 2, 1e-300)
        limits = left - room, right + room
        height = 1.2 * height or (right - left) / 2 or 1.0
    axis.axvspan(min(10 * limits[0], -largest), 0, color=LIGHT, zorder=0, linewidth=0)
    axis.axvline(0, color=GRAY, linewidth=0.8, zorder=0.5)
    if edge is not None:
        axis.axvline(-edge, color=RED, linestyle="--", linewidth=1)
    axis.set_xlim(*limits)
    axis.set_ylim(-height, height)


def _draw_limits(axis: Any, limits: Mapping[str, Fraction]) -> None:
    """The two rays of a damping ratio, and the half circle of a largest modulus."""
    reach = max(map(abs, (*axis.get_xlim(), *axis.get_ylim())))
    if "damping" in limits:
        ratio = to_float(limits["damping"])
        slope = math.sqrt(1 - ratio**2) / ratio
        steps = [-2 * reach * each for each in reversed(_SAMPLES)]
        for side in (-slope, slope):
            _draw_dashed(axis, [(0.0, 0.0), *((x, side * x) for x in steps)])
    if "largest_modulus" in limits:
        radius = to_float(limits["largest_modulus"])
        # Samples are dense where the circle meets an axis, which may be logarithmic.
        first = [(-radius * each, radius * math.sqrt(1 - each**2)) for each in _SAMPLES]
        second = [(-y, -x) for x, y in reversed(first)]
        upper = sorted(first + second, reverse=True)
        _draw_dashed(axis, [*upper, *((x, -y) for x, y in reversed(upper))])


def _draw_dashed(axis: Any, points: Sequence[tuple[float, float]]) -> None:
    """A dashed curve, which does not change what is in the picture."""
    limits = axis.get_xlim(), axis.get_ylim()
    axis.plot(*zip(*points, strict=True), color=RED, linestyle="--", linewidth=1)
    axis.set_xlim(*limits[0])
    axis.set_ylim(*limits[1])


def _decades(least: float, largest: float) -> list[float]:
    """0 and some powers of ten on both sides, none of them close to 0."""
    powers = range(math.ceil(math.log10(least)), math.floor(math.log10(largest)) + 1)
    shown = [10.0**k for k in powers[:: -(-len(powers) // _POWERS) or 1]]
    return [*(-each for each in reversed(shown)), 0.0, *shown]


def _draw_discs(axis: Any, points: Sequence[Point]) -> None:
    """Draw the discs that are large enough to be seen; the legend names the largest radius."""
    from matplotlib.patches import Circle

    proved = [each for each in points if each.multiplicity is not None]
    if not proved:
        return
    left, right = axis.get_xlim()
    for each in proved:
        if each.radius > _SEEN * (right - left):
            center = (each.place.real, each.place.imag)
            axis.add_patch(Circle(center, to_float(each.radius), color=RED, alpha=0.3))
    largest = max(each.radius for each in proved)
    if largest:
        digits = power_of_ten_above(largest)
        axis.plot([], [], "x", color=BLUE, label=f"located within $10^{{{digits}}}$, with proof")
    else:
        axis.plot([], [], "x", color=BLUE, label="exact")
    legend_below(axis)
