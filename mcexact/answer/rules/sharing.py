"""The rules of the table of `mcexact analyze` about links, shared states and delays."""

from __future__ import annotations

from mcexact.answer.rules.analysis import Said, empty, fewest, usual
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.wording import analysis as say

RULES = Rulebook()
rule = RULES.rule


@rule("table", *[told for key, told in say.TABLE_LINKS.items() if key != "limit"])
def _links(minimal_communication: Claim, given: Given) -> Said:
    found = minimal_communication
    if fewest(found):
        which = "impossible" if found.added is None else "some" if found.added else "none"
        yield say.TABLE_LINKS[which](added=found.added, time=given.delays)


@rule("table", say.TABLE_LINKS["limit"], missing="minimal_communication")
def _links_open() -> Said:
    yield say.TABLE_LINKS["limit"]()


@rule("table", say.CONNECTED, say.NOT_CONNECTED)
def _connected(neighbor_graph: Claim) -> Said:
    yield say.CONNECTED() if neighbor_graph.strongly_connected else say.NOT_CONNECTED()


@rule("table", say.NEVER_CONTROLLED)
def _never_controlled(joint_controllability: Claim, given: Given) -> Said:
    if given.neighbors is not None and not joint_controllability.controllable:
        yield say.NEVER_CONTROLLED(p=joint_controllability.uncontrollable_polynomial)


@rule("table", say.NEVER_OBSERVED)
def _never_observed(joint_observability: Claim, given: Given) -> Said:
    if given.neighbors is not None and not joint_observability.controllable:
        yield say.NEVER_OBSERVED(p=joint_observability.uncontrollable_polynomial)


@rule("table", say.NO_BOUND)
def _no_bound(
    neighbor_graph: Claim, joint_controllability: Claim, joint_observability: Claim
) -> Said:
    reach = (joint_controllability, joint_observability)
    if not neighbor_graph.strongly_connected and all(found.controllable for found in reach):
        yield say.NO_BOUND()


def theorem_2(graph: Claim, *reach: Claim) -> bool:
    """Whether the hypotheses of Theorem 2 and Remark 2 hold."""
    return bool(graph.strongly_connected and all(found.controllable for found in reach))


def _sharing_rules(share: str, stem: str) -> None:
    """Make the rules of the bound and of the least dimensions for one way of sharing."""
    some, none = say.ENOUGH[share]

    @rule("table", some, none, about={"bound": f"shared_dimension_bound_{stem}"})
    def _enough(
        bound: Claim,
        neighbor_graph: Claim,
        joint_controllability: Claim,
        joint_observability: Claim,
        given: Given,
    ) -> Said:
        if theorem_2(neighbor_graph, joint_controllability, joint_observability):
            k = bound.deficiency
            yield (some if k else none)(k=k, total=k * given.m, time=given.delays)


def _least_rules(share: str, stem: str) -> None:
    """Make the rules of the least dimensions for one way of sharing."""
    some, none, impossible, limit = say.LEAST[share]
    question = f"minimal_shared_dimensions_{stem}"

    @rule("table", some, none, impossible, about={"least": question})
    def _least_of(least: Claim, given: Given) -> Said:
        if not usual(least, share):
            return
        if least.dimensions is None:
            yield impossible()
        else:
            sizes = list(zip(given.names, least.dimensions, strict=True))
            yield (some if any(least.dimensions) else none)(sizes=sizes, time=given.delays)

    @rule("table", limit, missing=question)
    def _least_open() -> Said:
        yield limit()


SHARES = {"outputs+states": "outputs_states", "states": "states"}
for made in (_sharing_rules, _least_rules):
    for share, stem in SHARES.items():
        made(share, stem)


def _delayed_rules(network: str) -> None:
    """Make the rules of the fixed modes of a network with delays."""
    nothing, something = say.DELAYED[network]

    @rule("table", nothing, something, about={"spectrum": f"{network}_fixed_spectrum"})
    def _delayed(spectrum: Claim) -> Said:
        [step] = spectrum.subject
        told = nothing if empty(spectrum) else something
        yield told(p=spectrum.polynomial, k=step["dimensions"][0])


for network in ("lifted", "held"):
    _delayed_rules(network)
