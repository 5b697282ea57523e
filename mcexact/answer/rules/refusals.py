"""The rules of refusals: why no requested design exists, from the certificate of the refusal."""

from __future__ import annotations

from typing import Any

from mcexact.answer.protocol import Answer
from mcexact.answer.rules.analysis import Said
from mcexact.answer.rules.design import about
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.wording import refusals as say
from mcexact.errors import Impossible, InternalError
from mcexact.exact.roots import steady_point

RULES = Rulebook()
rule = RULES.rule


def refusal(place: str, answer: Answer, **asked: Any) -> Impossible:
    """Return the error that says why no design exists, with the certificate that proves it.

    Parameters
    ----------
    place : str
        The place of the rules.
    answer : Answer
    **asked
        The request, such as the ``region``; and the template ``told``, if the certificate does not
        determine it.

    Raises
    ------
    InternalError
        If no rule applies to the certificate.
    """
    rules = Rulebook(rule for rule in RULES if rule.place == place)
    for sentence in rules.sentences({answer.kind: answer}, Given(answer.about, asked)):
        return Impossible(sentence, answer)
    raise InternalError(f"no reason follows from a certificate of the kind {answer.kind}: {place}")


@rule(
    "unreached",
    say.NOT_CONTROLLABLE,
    say.NOT_CONTROLLABLE_IN,
    *say.UNREACHED.values(),
    say.NOT_OBSERVABLE,
    *say.INTEGRATORS_UNREACHED.values(),
)
def _unreached(controllability: Claim, given: Given) -> Said:
    if not controllability.controllable:
        p = controllability.uncontrollable_polynomial
        yield given.told(p=p, region=given.region if given.has("region") else None)


@rule("not complete", say.ERRORS_NOT_COMPLETE)
def _not_complete(completeness: Claim) -> Said:
    if not completeness.complete:
        yield say.ERRORS_NOT_COMPLETE()


@rule("fixed", say.FIXED, say.FIXED_SHARED, say.ERRORS_FIXED)
def _fixed(fixed_spectrum: Claim, given: Given) -> Said:
    """The first fixed mode that is outside the region."""
    sizes = []
    if fixed_spectrum.subject and "dimensions" in fixed_spectrum.subject[-1]:
        sizes = list(zip(given.names, fixed_spectrum.subject[-1]["dimensions"], strict=False))
    for factor in fixed_spectrum.factors:
        p = factor.polynomial
        if not given.region.contains_roots_of(p):
            others = [name for name in given.names if name not in factor.channels]
            sides = others, factor.channels
            yield given.told(p=p, sides=sides, sizes=sizes, region=given.region)
            return


@rule("integrators", say.INTEGRATORS_FIXED)
def _integrators_fixed(fixed_spectrum: Claim) -> Said:
    if fixed_spectrum.polynomial.degree:
        yield say.INTEGRATORS_FIXED(p=fixed_spectrum.polynomial)


@rule("dimensions", say.NO_DIMENSIONS, say.NOT_CONTROLLED, say.NOT_OBSERVED, say.NO_CONNECTION)
def _no_dimensions(shared_dimensions: Claim, given: Given) -> Said:
    """A set of agents that need shared states and receive from no other agent."""
    if shared_dimensions.feasible:
        return
    for cut in shared_dimensions.proof.cuts:
        subset, senders = cut.subset, given.senders(cut.subset)
        if senders:
            continue
        told, p, k = say.NO_CONNECTION, None, 1
        if cut.has("polynomial"):
            told, p, k = say.NO_DIMENSIONS, cut.polynomial, cut.deficiency
            if len(subset) in {0, given.m}:
                told = say.NOT_OBSERVED if subset else say.NOT_CONTROLLED
        yield told(agents=subset, senders=senders, k=k, p=p)
        return


@rule("outside", say.OUTSIDE)
def _outside(stability: Claim, given: Given) -> Said:
    if not stability.stable and about(stability, given.region):
        yield say.OUTSIDE(region=given.region)


@rule("equilibrium", say.NO_EQUILIBRIUM, say.NO_EQUILIBRIUM_ZERO, say.MODE_OF_THE_INTEGRATORS)
def _no_equilibrium(setpoint: Claim, given: Given) -> Said:
    if not setpoint.solvable:
        zero = setpoint.invariant_zero
        told = say.NO_EQUILIBRIUM_ZERO if zero else say.NO_EQUILIBRIUM
        if not given.combinations:
            told = say.MODE_OF_THE_INTEGRATORS
        yield told(w=given.combinations, place=steady_point(given.time))
