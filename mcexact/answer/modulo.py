"""Sentences about plants without a part of their state, or with their inputs as states.

What no output shows and what no input moves, of all channels together, no controller changes: these
modes are *joint* fixed modes.  Others are *decentralized* ones.  `PART_RULES` says of answers about
a plant without such a part that they are about the rest, and which modes stay in every loop of the
plant; `LOOP_PART_RULES` says the same of loops.  `OPTION_RULES` name the option that asks about the
rest.  `JOINT_RULES` divides the fixed modes of a plant
by the fixed spectrum of its minimal realization.

Of a plant with feedthrough the answers are about the plant with its inputs as states, which has the
same fixed modes: `FILTER_RULES` say so.
"""

from __future__ import annotations

from collections.abc import Iterator

from mcexact.answer.sentence import Certified, Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template
from mcexact.derived.feedthrough import FILTERS
from mcexact.derived.modulo import MODULO, PARTS
from mcexact.exact.polynomial import Polynomial, product

Said = Iterator[Sentence]

# Templates.

_PARTS = ", ".join(f"modulo.{part}_part" for part in reversed(PARTS))

STAYS = {
    "unobservable": Template(
        "modulo-unobservable",
        "These answers are about the plant modulo {k:count state} that no output shows: in every "
        "loop of the plant {p:modes} {p:stay}.",
        "modulo.unobservable_loop",
    ),
    "uncontrollable": Template(
        "modulo-uncontrollable",
        "These answers are about the plant without {k:count state} that no input moves: in every "
        "loop of the plant {p:modes} {p:stay}.",
        "modulo.uncontrollable_loop",
    ),
}
OPTION = {
    part: Template(f"modulo-option-{part}", f"`--modulo {part}` asks about {rest}.", claims=False)
    for part, rest in (
        ("unobservable", "the plant modulo what no output shows"),
        ("uncontrollable", "the plant without what no input moves"),
        ("both", "a minimal realization of the plant"),
    )
}
FILTERED = Template(
    "feedthrough",
    "These answers are about the system with its inputs as states, which the agents {time:inputs}, "
    "measure, and send where they send outputs; its fixed modes are those of the system with its "
    "feedthrough.",
    "feedthrough.same_fixed_modes",
)
JOINT = Template("joint-fixed", "{p:modes}", _PARTS, "joint fixed modes")
_DECENTRALIZED = "decentralized fixed modes"
NOT_DECENTRALIZED = Template("decentralized-none", "none", _PARTS, _DECENTRALIZED)
DECENTRALIZED = Template(
    "decentralized-fixed",
    "{p:modes}, {k:times}",
    f"{_PARTS}, joint_controllability.controllable_hautus",
    _DECENTRALIZED,
)
BESIDES = Template(
    "fixed-besides", "{p:modes}, {k:times}", _PARTS, "fixed besides the joint fixed modes"
)

# Rules.

PART_RULES, LOOP_PART_RULES = Rulebook(), Rulebook()
OPTION_RULES, JOINT_RULES = Rulebook(), Rulebook()
FILTER_RULES = Rulebook()


@FILTER_RULES.rule("answer", FILTERED, premises=("fixed_spectrum",))
def _filtered(fixed_spectrum: Certified, context: Context) -> Said:
    """Say what the answers are about, where the inputs were made states before all questions."""
    own = len(context.system.subject)
    last = context.system.subject[-1:]
    if [step["construction"] for step in last] == [FILTERS] and len(fixed_spectrum.subject) == own:
        yield FILTERED(time=context.time)


def _stays(claim: Certified, context: Context) -> Said:
    """Say of each part that was left out of the plant itself which modes stay."""
    if any(step["construction"] != MODULO for step in context.system.subject):
        return
    for step in claim.made_by_name(MODULO):
        chi: Polynomial = step.polynomial
        yield STAYS[step.part](k=chi.degree, p=chi)


@PART_RULES.rule("answer", *STAYS.values(), premises=("fixed_spectrum",))
def _rest(fixed_spectrum: Certified, context: Context) -> Said:
    yield from _stays(fixed_spectrum, context)


@LOOP_PART_RULES.rule("modulo", *STAYS.values(), premises=("loop",))
def _rest_of_loop(loop: Certified, context: Context) -> Said:
    yield from _stays(loop, context)


@OPTION_RULES.rule(
    "answer",
    *OPTION.values(),
    premises=("fixed_spectrum", "joint_controllability", "joint_observability"),
)
def _option(
    fixed_spectrum: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    context: Context,
) -> Said:
    """Name the option that asks about the rest, where all channels together do not move a mode."""
    lacks = [
        part
        for part, claim in (
            ("uncontrollable", joint_controllability),
            ("unobservable", joint_observability),
        )
        if not claim.controllable
    ]
    if lacks and fixed_spectrum.polynomial.degree < context.n:
        yield OPTION["both" if len(lacks) > 1 else lacks[0]]()


def _joint(minimal: Certified, context: Context) -> list[Polynomial]:
    """The characteristic polynomials of what a minimal realization leaves out."""
    own = len(context.system.subject)
    return [step.polynomial for step in minimal.made_by_name(MODULO, own)]


@JOINT_RULES.rule("table", JOINT, NOT_DECENTRALIZED, premises=("minimal_fixed_spectrum",))
def _joint_modes(minimal_fixed_spectrum: Certified, context: Context) -> Said:
    joint = _joint(minimal_fixed_spectrum, context)
    if joint:
        yield JOINT(p=product(joint))
        if not minimal_fixed_spectrum.polynomial.degree:
            yield NOT_DECENTRALIZED()


@JOINT_RULES.rule(
    "table",
    DECENTRALIZED,
    BESIDES,
    premises=("minimal_fixed_spectrum", "joint_controllability", "joint_observability"),
)
def _other_modes(
    minimal_fixed_spectrum: Certified,
    joint_controllability: Claim,
    joint_observability: Claim,
    context: Context,
) -> Said:
    """Modes that all channels together move but decentralized control does not, and others."""
    if not _joint(minimal_fixed_spectrum, context):
        return
    both: Polynomial = (
        joint_controllability.uncontrollable_polynomial
        * joint_observability.uncontrollable_polynomial
    )
    for factor in minimal_fixed_spectrum.factors.separately():
        p: Polynomial = factor.polynomial
        own = p.gcd(both).degree == 0
        yield (DECENTRALIZED if own else BESIDES)(p=p, k=factor.multiplicity_at_most)
