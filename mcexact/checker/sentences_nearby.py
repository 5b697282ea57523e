"""Rules of sentences about plants nearby, of which an answer is another one.

A manifest lists certificates about another plant as ``nearby``.  Only the rules of this module, and
those about a loop that is not stable (`sentences_loops`), take them, together with a certificate
about the manifest's own plant.  How far the other plant is from it is computed from both
(`differences`): nothing is believed about the distance.

===================  ===========================================================================
``nearby-…``         no entry differs by more than 10^-12 of its absolute value
``nearby-…-digits``  no entry differs by more than half a unit of its last digit (`last_digit`)
``nearby-…-part``    the distance is said, and no more
===================  ===========================================================================

``structural-…`` say what is fixed for all numbers at the places of the plant's entries.
``fixed-by-…`` divide the fixed modes of the plant by what is fixed for all numbers at its places.
``law-…`` and ``nearby-law-…`` name the vector that all channels do not observe, or not control.
"""

from collections.abc import Callable
from fractions import Fraction

from .core import budget
from .core.arithmetic import FIRST, Matrix, absolute, coprime, exponent, poly_modulo
from .core.reading import polynomial
from .core.roots import in_stability_region
from .core.system import System, polynomial_text
from .discs import Pair, pairs_of
from .sentences import DUAL, PLANT, Premise, Role, everywhere, rule

EXACT_PART = Fraction(1, 10**12)
"""The part of an entry that rounding errors explain."""
FEWEST, MOST = 3, 12
"""Decimals of so many significant digits have further ones that were not typed."""
LOOP_RANK = "evidence.loop_rank_pencil, dynamic_controllers.fixed_dynamic"
CONTROLLED = "joint_controllability.controllable_hautus"
OBSERVED = "joint_controllability.observable_hautus"
Allows = Callable[[Fraction], Fraction | None]
"""What an entry may differ by; None for anything."""


def differences(near: Premise, own: Premise, units: list[Matrix] | None = None) -> list[Pair]:
    """What each entry differs by in the plant nearby, and the entry's absolute value, or a unit.

    Both plants have the same time, channels, neighbors, delays and shapes.
    """
    for plant in (own.plant, near.plant):
        near.expect(isinstance(plant, System), "a plant has parameters")
    parts = ("time", "names", "neighbors", "delays")
    alike = all(getattr(own.plant, part) == getattr(near.plant, part) for part in parts)
    near.expect(alike, "another time, or other channels, neighbors or delays")
    values, others = ([each.A, *each.B, *each.C] for each in (own.plant, near.plant))
    pairs = list(zip(values, others, strict=True))
    fits = all((M.nrows, M.ncols) == (N.nrows, N.ncols) for M, N in pairs)
    near.expect(fits, "matrices of other shapes")
    return pairs_of(units or values, [absolute(N + M.times(-1)) for M, N in pairs])


def farthest(shifts: list[Pair]) -> Fraction:
    """The largest difference in its unit; there is one wherever an entry differs."""
    budget.spend(budget.fractions(len(shifts), 2 * budget.limbs_of([x for p in shifts for x in p])))
    return max((moved / unit for moved, unit in shifts if moved), default=Fraction(0))


def last_digit(x: Fraction) -> Fraction:
    """Half a unit of the last digit of a decimal of 3 to 12 significant digits, no integer.

    Of any other number 10^-12 of it: integers, quotients and shorter decimals count as exact.
    """
    twos = (x.denominator & -x.denominator).bit_length() - 1
    odd = x.denominator >> twos
    fives = (1000 * odd.bit_length() - 1) // 2321  # 2^2.321 < 5: at most one too many
    fives -= 5**fives > odd
    places = max(twos, fives)
    decimal = places > 0 and 5**fives == odd and places - twos < 40 and places - fives < 20
    digits = x.numerator * 2 ** (places - twos) * 5 ** (places - fives) if decimal else 0
    if not 10 ** (FEWEST - 1) <= digits < 10**MOST:
        return x * EXACT_PART
    return Fraction(1, 2 * 10**places)


ALLOWED: dict[str, Allows] = {
    "": lambda x: x * EXACT_PART,
    "-digits": last_digit,
    "-part": lambda x: None,
}
NEAR = Role(("pencil_rank",), (*PLANT, *DUAL[:1]), nearby=True)


def of_mode(
    lost: str,
    own: Role,
    holds: Callable[[Premise], bool],
    lacks: Callable[[Premise], bool],
    words: str,
    theorem: str,
) -> None:
    """Enter the rules about a plant nearby that lacks what the own plant has."""

    def enter(key: str, allowed: Allows) -> None:
        @rule(key, NEAR, own, theorem=theorem)
        def _say(near: Premise, known: Premise) -> str:
            known.expect(holds(known), "the plant itself lacks it")
            near.expect(near["rank"] < near.plant.A.nrows, "the rank is not below the states")
            near.expect(lacks(near), "another set of channels, or a stable mode")
            shifts = differences(near, known)
            near.expect(all(size for moved, size in shifts if moved), "an entry that is 0 is moved")
            part = farthest(shifts)
            for moved, size in shifts:
                most = allowed(size) if moved else None
                near.expect(most is None or moved <= most, "an entry is moved too far")
            whose = f"each entry of its plant differs from that of {known.plant.words}"
            return (
                f"{near.statement}, which is below the number of states, so that {words}; {whose} "
                f"by at most {part} of the absolute value of the latter"
            )

    for suffix, allowed in ALLOWED.items():
        enter(f"nearby-{lost}{suffix}", allowed)


def whole(near: Premise, *, shown: bool) -> bool:
    """Whether the pencil is [λI − A, B], or [λI − A; C] if the outputs are ``shown``."""
    dual = near.path == ("dual",)
    names = list(near.plant.names)
    return bool(near["subset"] == (names if shown != dual else []))


FIXED, JOINT = Role(("fixed_spectrum",), PLANT), ("controllability",)
of_mode(
    "fixed",
    FIXED,
    lambda own: not own["factors"],
    lambda near: True,
    "these roots are fixed modes of its plant",
    LOOP_RANK,
)
of_mode(
    "unstable",
    FIXED,
    lambda own: bool(own["stabilizable"]),
    lambda near: (
        not in_stability_region(
            polynomial(near["polynomial"], "claim.polynomial", 1), near.plant.time
        )
    ),
    "these roots, not all of which are stable, are fixed modes of its plant",
    LOOP_RANK,
)
of_mode(
    "uncontrollable",
    Role(JOINT, PLANT),
    lambda own: everywhere(own) and bool(own["controllable"]),
    lambda near: whole(near, shown=False),
    "all channels of its plant together do not control these roots",
    CONTROLLED,
)
of_mode(
    "unobservable",
    Role(JOINT, DUAL[:1]),
    lambda own: everywhere(own) and bool(own["controllable"]),
    lambda near: whole(near, shown=True),
    "all channels of its plant together do not observe these roots",
    OBSERVED,
)


# What is fixed for all numbers; modes that the zeros fix, and that equalities between entries fix.

STRUCTURAL = Role(("structural_fixed_modes",), PLANT)
SOURCES = "M. E. Sezer and D. D. Siljak 1981"
ALIKE = (
    "systems with these entries where rows and columns of states without feedback meet, and zeros "
    "wherever it has zeros"
)


def pattern(key: str, theorem: str, *, some: bool) -> None:
    """Enter the rule about a pattern alone: that something is fixed for all numbers, or nothing."""

    @rule(key, STRUCTURAL, theorem=theorem)
    def _pattern(structural: Premise) -> str:
        structural.expect((len(structural["polynomial"]) > 1) == some, "the claim is different")
        return structural.statement


pattern("structural-none", SOURCES, some=False)
pattern("structural-modes", f"patterns.structural_modes; {SOURCES}", some=True)


def why(key: str, kept: bool, words: str, theorem: str) -> None:
    """Enter the rule about fixed modes that are roots of the structural polynomial, or are not."""

    @rule(key, STRUCTURAL, FIXED, theorem=theorem)
    def _why(structural: Premise, own: Premise) -> str:
        alone = structural["information"] == "own"
        structural.expect(alone, "agents feed back outputs of neighbors")
        p = polynomial(structural["polynomial"], "claim.polynomial")
        cited = own.cited("claim", "factors")
        own.expect(bool(cited), "no mode is fixed")
        listed = [polynomial(each["polynomial"], "claim.factors", 1) for each in cited]
        for factor in listed:
            if kept:
                times, _ = exponent(factor, p)
                structural.expect(times > 0, "a mode is not among the structural ones")
            else:
                apart = coprime(poly_modulo(factor, FIRST), poly_modulo(p, FIRST), FIRST)
                structural.expect(apart, "a mode is among the structural ones")
        names = " and of ".join(map(polynomial_text, listed))
        return f"{own.statement}; {words.format(names)}; {structural.statement}"


why(
    "fixed-by-zeros",
    True,
    f"the roots of {{}} are fixed for all {ALIKE}",
    "patterns.structural_modes",
)
why(
    "fixed-by-equalities",
    False,
    f"the roots of {{}} are not fixed for almost all {ALIKE}",
    SOURCES,
)


# The vector of a mode that all channels together do not observe, or not control.


def law(key: str, ways: Role, *, shown: bool, theorem: str) -> None:
    """Enter the rule about the null space of [λI − A; C], or with transposes of [λI − A, B]."""

    @rule(key, ways, theorem=theorem)
    def _law(rank: Premise) -> str:
        rank.expect(whole(rank, shown=shown), "another set of channels")
        rank.expect(rank["rank"] < rank.plant.A.nrows, "the rank is not below the states")
        rank.expect(len(rank["polynomial"]) == 2, "the mode is not rational")
        null_space = rank.witness["kernel"]
        (rows,) = null_space["coefficients"]
        d, number = null_space["denominator"], len(rows[0])
        budget.spend(sum(100 + len(str(x)) for row in rows for x in row))
        columns = [", ".join(str(Fraction(row[k], d)) for row in rows) for k in range(number)]
        return f"{rank.statement}; its null space is spanned by ({'), ('.join(columns)})"


for _near in (False, True):
    _start = "nearby-law" if _near else "law"
    law(
        f"{_start}-unobserved",
        Role(("pencil_rank",), PLANT, nearby=_near),
        shown=True,
        theorem=OBSERVED,
    )
    law(
        f"{_start}-uncontrolled",
        Role(("pencil_rank",), DUAL[:1], nearby=_near),
        shown=False,
        theorem=CONTROLLED,
    )
