"""The rules of the sentences of `mcexact design` and `certify`."""

from __future__ import annotations

from mcexact.answer.rules.analysis import Said
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.wording import design as say
from mcexact.exact.roots import LIMITS, StabilityRegion

RULES = Rulebook()
rule = RULES.rule


def inside(loop: Claim, region: StabilityRegion) -> bool:
    """Whether the claim about a loop is that every eigenvalue lies in a region."""
    if loop.has("stable"):
        return bool(loop.stable and about(loop, region))
    parts = (loop.polynomial,) if loop.has("polynomial") else (loop.feedback, loop.error)
    return all(region.contains_roots_of(p) for p in parts)


def about(loop: Claim, region: StabilityRegion) -> bool:
    """Whether a claim of the kind ``stability`` is about this region."""
    limits = {name: getattr(loop, name) for name in LIMITS if loop.has(name)}
    return bool(loop.bound == region.bound and limits == region.limits)


# All loops of a box.

EVERY_LOOP = Rulebook()


@EVERY_LOOP.rule("table", say.EVERY_LOOP, say.EVERY_LOOP_PART, say.EVERY_VALUE)
def _every_loop(box_stability: Claim, given: Given) -> Said:
    """Where the eigenvalues of all loops are, with radii or parameters as they were asked for."""
    region = StabilityRegion.of(given.time, bound=box_stability.bound)
    gains = None if box_stability.gain_radii is None else given.part_of_gains
    if given.has("parameters"):
        yield say.EVERY_VALUE(region=region, parameters=given.parameters, gains=gains)
    elif given.part_of_plant is None:
        yield say.EVERY_LOOP(region=region, gains=gains)
    else:
        yield say.EVERY_LOOP_PART(region=region, part=given.part_of_plant, gains=gains)


@EVERY_LOOP.rule("table", say.FAILING_PLANT, say.FAILING_PLANT_RADII)
def _failing_plant(failing_loop: Claim, loop: Claim, given: Given) -> Said:
    """How near a plant is whose loop with the same controller is not stable."""
    if not failing_loop.stable and failing_loop.bound is None and inside(loop, given.region):
        told = say.FAILING_PLANT_RADII if given.of_radii else say.FAILING_PLANT
        yield told(distance=given.fails_within)


# Designs.


@rule("title", say.OBSERVER, say.OBSERVER_FLOAT, say.NETWORK, say.SETPOINT, say.LOOP)
def _title(loop: Claim, given: Given) -> Said:
    """The heading of a design; without a certified region there is no other sentence."""
    if not inside(loop, given.region):
        yield say.LOOP()
    elif given.has("solvability"):
        yield say.SETPOINT(method=given.method)
    elif given.method == "observer":
        yield (say.OBSERVER if given.arithmetic == "exact" else say.OBSERVER_FLOAT)()
    else:
        yield say.NETWORK(kind=given.network)


@rule("table", say.ORDER, say.ORDER_INTEGRATORS)
def _order(given: Given) -> Said:
    told = say.ORDER_INTEGRATORS if given.has("solvability") else say.ORDER
    yield told(order=given.order)


@rule("table", say.OBSERVER_ORDER)
def _observer_order(given: Given) -> Said:
    if given.has("observer_order"):
        yield say.OBSERVER_ORDER(order=given.observer_order)


@rule("table", say.SHARED)
def _shared(given: Given) -> Said:
    if given.has("network") and given.network != "decentralized":
        yield say.SHARED(sizes=list(given.dimensions.items()))


@rule("table", say.CARRIER, say.CARRIER_FOR)
def _carrier(given: Given) -> Said:
    if given.has("agent"):
        yield say.CARRIER(agent=given.agent, order=given.channel_order)
    blocks = given.blocks if given.has("blocks") else ()
    told = say.CARRIER if len(blocks) == 1 else say.CARRIER_FOR
    for block in blocks:
        yield told(agent=block.agent, order=block.order, channels=block.channels)


@rule("table", say.ASSIGNED)
def _assigned(loop: Claim, given: Given) -> Said:
    if given.has("blocks") and loop.has("polynomial"):
        for block in given.blocks:
            if block.polynomial.divides(loop.polynomial):
                yield say.ASSIGNED(p=block.polynomial)


@rule("table", say.KEPT)
def _kept(loop: Claim, fixed_spectrum: Claim, given: Given) -> Said:
    """The fixed modes that remain under the design."""
    if given.has("kept") and given.kept.degree and inside(loop, given.region):
        fixed = fixed_spectrum.polynomial
        if all(p.divides(fixed) for p, _ in given.kept.factor()):
            yield say.KEPT(p=given.kept)


@rule("table", say.FEEDBACK)
def _feedback(loop: Claim) -> Said:
    if loop.has("feedback"):
        yield say.FEEDBACK(p=loop.feedback)


@rule("table", say.ERRORS)
def _errors(loop: Claim) -> Said:
    if loop.has("error"):
        yield say.ERRORS(p=loop.error)


@rule("table", say.REGION)
def _region(bounded_loop: Claim, given: Given) -> Said:
    loop, bound = bounded_loop, given.region.bound
    if bound is not None and loop.bound == bound and inside(loop, given.region):
        yield say.REGION(region=given.region)


@rule("table", say.OUTSIDE)
def _unstable(stability: Claim, given: Given) -> Said:
    """A loop whose prescribed spectrum is not stable was wanted, and is not to be installed."""
    if not stability.stable:
        yield say.OUTSIDE(region=given.region)


@rule("table", say.STEADY)
def _steady(loop: Claim, given: Given) -> Said:
    if given.has("solvability") and inside(loop, given.region):
        yield say.STEADY()


@rule("table", say.LONGEST)
def _longest(given: Given) -> Said:
    yield say.LONGEST(bits=given.bits)


@rule("measured.title", say.MEASURED)
def _measured(given: Given) -> Said:
    yield say.MEASURED()


DESIGN = Rulebook([*RULES, *EVERY_LOOP])

# Verdicts.

RULES = Rulebook()
rule = RULES.rule


@rule("title", say.LOOP)
def _verdict(loop: Claim) -> Said:
    """The title of a verdict."""
    _ = loop.stable
    yield say.LOOP()


@rule("table", say.LOOP_STATES)
def _states(given: Given) -> Said:
    yield say.LOOP_STATES(n=given.states)


@rule("table", say.INSIDE, say.OUTSIDE)
def _location(loop: Claim, given: Given) -> Said:
    if about(loop, given.region):
        yield (say.INSIDE if loop.stable else say.OUTSIDE)(region=given.region)


@rule("table", say.DECIDED, say.DECIDED_BLOCKS)
def _decided(loop: Claim) -> Said:
    """The method of the decision, and the blocks to which it was applied."""
    proof = loop.proof
    sizes = [block.size for block in proof.blocks] if proof.has("blocks") else []
    yield say.DECIDED_BLOCKS(sizes=sizes) if len(sizes) > 1 else say.DECIDED(method=proof.method)


@rule("table", say.LARGEST, say.LEAST)
def _largest(loop: Claim, given: Given) -> Said:
    if given.largest and loop.stable and loop.bound is not None:
        yield (say.LEAST if given.region.discrete else say.LARGEST)(bound=loop.bound)


VERDICT = Rulebook([*RULES, *EVERY_LOOP])
