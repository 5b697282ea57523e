"""Loops whose inputs are cut off at their limits: the answer, and its sentences.

`SaturationStability` says that a loop is stable where the plant receives each input cut off at its
limits, with the anti-windup gains that its agents have: from every initial state, or from an
ellipsoid of them.  One symmetric matrix proves it by the circle criterion (``FORMAT.md``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from mcexact.answer.performance import Symmetric
from mcexact.answer.protocol import LEFT_OUT, Answer, Part, answer, claim, witness
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template
from mcexact.derived.sampling import is_sampled
from mcexact.exact.matrix import Matrix


@dataclass(frozen=True)
class Ellipsoid(Part):
    """The states z of a loop with zᵀPz ≤ 1.

    Attributes
    ----------
    P : Symmetric
    radius : Fraction
        Every state of the system that is controlled, of this norm or a smaller one, is in it, where
        all else is 0.
    sizes : tuple of Fraction or None
        What each state is divided by for this norm; None for 1.
    """

    P: Symmetric
    radius: Fraction
    sizes: tuple[Fraction, ...] | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@dataclass(frozen=True)
class SaturationProof(Part):
    """The proof of a saturated loop by the circle criterion.

    Attributes
    ----------
    scaling, sectors : tuple of Fraction
        For each input with limits a number above 0, and the end a of its sector [a, 1].
    P : Symmetric or None
        The form that falls; None where it is that of the region.
    """

    scaling: tuple[Fraction, ...]
    sectors: tuple[Fraction, ...]
    P: Symmetric | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@answer("saturation")
class SaturationStability(Answer):
    """The loop is stable where each input is cut off at its limits.

    Agent i computes v_i, the plant receives v_i cut off at the limits, sat(v_i), and the agent adds
    L_i (sat(v_i) − v_i) to its next states (x_i, z_i), in continuous time to their derivatives.

    Attributes
    ----------
    limits : tuple of tuples
        For each channel, for each input, its least and its largest value, or None.
    back_calculation : tuple of Matrix
        The anti-windup gains L_i, (x_i, z_i) × inputs.
    region : Ellipsoid or None
        Without one, any two solutions with the same set-points and disturbances approach each other
        exponentially.  With one, this holds for the solutions without set-points and disturbances
        that start in it: they tend to 0 exponentially, and stay in it.
    exact : bool or None
        True if all of this holds as well for the plant sampled without rounding.
    proof : SaturationProof
    """

    limits: tuple[tuple[tuple[Fraction, Fraction] | None, ...], ...] = claim()
    back_calculation: tuple[Matrix, ...] = claim()
    region: Ellipsoid | None = claim(optional=True)
    exact: bool | None = claim(optional=True)
    proof: SaturationProof = witness(whole=True)


ALWAYS = Template(
    "saturation-global",
    "stable with each input cut off at its limits ({limits:input limits}){gains:windup}: any two "
    "solutions with the same set-points and disturbances approach each other exponentially"
    "{samples:rounded samples}",
    label="inputs at their limits",
)
REGION = Template(
    "saturation-region",
    "stable with each input cut off at its limits ({limits:input limits}){gains:windup}, from "
    "every state of the controlled system of norm at most {radius:digits_below}{sizes:in sizes} "
    "where all else is at rest{samples:rounded samples}",
    label="inputs at their limits",
)
FIRST = Template("first-saturation", "stable at every saturation of the inputs")
FIRST_REGION = Template(
    "first-saturation-region",
    "stable with saturated inputs from states of norm at most {radius:digits_below}"
    "{sizes:in sizes}",
)

RULES = Rulebook()
Said = Iterator[Sentence]


@RULES.rule("first", FIRST, FIRST_REGION, premises=("saturation",))
def _first(saturation: Claim, context: Context) -> Said:
    """Whether the loop is stable with inputs cut off, and from where."""
    if saturation.has("region"):
        yield FIRST_REGION(radius=saturation.region.radius, sizes=_sizes(saturation))
    else:
        _ = saturation.limits
        yield FIRST()


@RULES.rule("table", ALWAYS, REGION, premises=("saturation",))
def _saturation(saturation: Claim, context: Context) -> Said:
    """The same with the limits."""
    known: dict[str, Any] = {
        "limits": tuple(zip(context.names, saturation.limits, strict=True)),
        "gains": any(not L.is_zero() for L in saturation.back_calculation),
        "samples": _samples(saturation, context),
    }
    if saturation.has("region"):
        yield REGION(**known, radius=saturation.region.radius, sizes=_sizes(saturation))
    else:
        yield ALWAYS(**known)


def _sizes(saturation: Claim) -> tuple[Fraction, ...] | None:
    """What each state is divided by; None where these are all 1."""
    region = saturation.region
    return tuple(Fraction(x) for x in region.sizes) if region.has("sizes") else None


def _samples(saturation: Claim, context: Context) -> str | None:
    """Of a sampled plant, whether this is known of the exact samples."""
    if not is_sampled(context.system):
        return None
    return "exact" if saturation.has("exact") and saturation.exact else "rounded"
