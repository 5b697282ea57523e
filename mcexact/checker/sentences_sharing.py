"""What the certificates about sharing imply: bounds, least dimensions, links, delays."""

from functools import partial

from .information_structure import SHARED
from .region import no_fixed_mode
from .sentence import HEARD, PLANT, Path, Premise, Role, either, restate, rule
from .sentences_analysis import CONTROLLABLE, HAUTUS, OBSERVABLE, controls, free
from .statement import channel_set, counted, polynomial_text

OBSERVABLE_HAUTUS = "joint_controllability.observable_hautus"

CONNECTED = Role(("neighbor_graph",), PLANT)
LEAST = Role(("shared_dimensions",), PLANT)
LINKS = Role(("communication",), PLANT)
HYPOTHESES = (CONNECTED, CONTROLLABLE, OBSERVABLE)
UNCONNECTED = "neighbor-graph-not-connected enough-unknown"
either("neighbor-graph-connected", UNCONNECTED, CONNECTED, lambda c: c["strongly_connected"])

restate("sharing-in-vain-controllability", CONTROLLABLE, lambda c: not controls(c), HAUTUS)
restate("sharing-in-vain-observability", OBSERVABLE, lambda c: not controls(c), OBSERVABLE_HAUTUS)
for delayed in ("lifted", "held"):
    NETWORK = Role(("fixed_spectrum",), ((delayed,),))
    either(f"{delayed}-nothing-fixed", f"{delayed}-fixed", NETWORK, free)


def enough(bound: Premise, *hypotheses: Premise) -> str:
    """So many sub-states of every agent leave no mode fixed, by Theorem 2 or Remark 2."""
    graph, c, o = hypotheses
    graph.expect(graph["strongly_connected"], "the neighbor graph is not strongly connected")
    c.expect(controls(c), "not jointly controllable")
    o.expect(controls(o), "not jointly observable")
    what = "outputs" if bound.path == HEARD[0] else "no outputs"
    shared = f"{what} and at least {counted(bound['deficiency'], 'sub-state')} with its neighbors"
    return f"{graph.about}: no mode is fixed where every agent shares {shared}, without delay"


def _enter_bound(key: str, paths: tuple[Path, ...], theorem: str, positive: bool) -> None:
    """Enter the rule about a bound for one way of sharing that is positive, or 0."""

    @rule(key, Role(("deficiency",), paths), *HYPOTHESES, theorem=theorem)
    def _say(bound: Premise, *hypotheses: Premise) -> str:
        bound.expect((bound["deficiency"] > 0) == positive, "the bound is another one")
        return enough(bound, *hypotheses)


_enter_bound("enough-outputs-states", HEARD, "extended_bound.theorem_2", positive=True)
_enter_bound("enough-outputs", HEARD, "extended_bound.theorem_2", positive=False)
_enter_bound("enough-states", PLANT, "extended_bound.remark_2", positive=True)
_enter_bound("enough-nothing", PLANT, "extended_bound.remark_2", positive=False)


# The least dimensions.


def usual(least: Premise, share: str) -> bool:
    """Whether the least number is asked for, without limits, so that no mode at all is fixed."""
    asked = least["share"] == share and least["bound"] is None and not least["free_assignability"]
    prices = all(cost == 1 for cost in least["costs"])
    return asked and prices and all(most is None for most in least["upper"])


def _enter_least(share: str, key: str, some: str = "", none: str = "", never: str = "") -> None:
    """Enter the rules about the least dimensions for one way of sharing."""

    def feasible(found: Premise, positive: bool) -> bool:
        return usual(found, share) and found["feasible"] and any(found["dimensions"]) == positive

    restate(f"{key} {some}", LEAST, partial(feasible, positive=True))
    restate(f"{key}-none {none}", LEAST, partial(feasible, positive=False))
    restate(f"{key}-impossible {never}", LEAST, lambda c: usual(c, share) and not c["feasible"])


BOTH = ("sharing-removes", "outputs-remove", "no-sharing")
_enter_least("outputs+states", "least-outputs-states", *BOTH)
_enter_least("states", "least-states")
ALLOCATED = "allocate-least allocate-row allocate-total"
either(ALLOCATED, "allocate-impossible", LEAST, lambda c: c["feasible"])


def _enter_common(share: str, key: str, name: str) -> None:
    """Enter the rules about the least common dimension for one way of sharing."""

    def asked(found: Premise) -> bool:
        found.expect(found["share"] == share, "about the other way of sharing")
        return bool(found["feasible"])

    key, common = f"common-dimension-{key}", Role(("common_dimension",), PLANT)
    restate(key, common, lambda c: asked(c) and c["dimension"], f"shared_dimensions.{name}")
    restate(f"{key}-none", common, lambda c: asked(c) and not c["dimension"])
    restate(f"{key}-impossible", common, lambda c: not asked(c), f"shared_dimensions.no_{name}")


_enter_common("outputs+states", "outputs-states", "common_dimension_outputs")
_enter_common("states", "states", "common_dimension_states")


BOUND = Role(("deficiency",), HEARD + PLANT)
BOUNDS = "extended_bound.theorem_2, extended_bound.remark_2"


@rule("allocate-row-bound allocate-total-bound", LEAST, BOUND, *HYPOTHESES, theorem=BOUNDS)
def _allocated(least: Premise, bound: Premise, *hypotheses: Premise) -> str:
    """What is least, beside the bound for the same way of sharing."""
    fits = bound.path == (HEARD if least["share"] == "outputs+states" else PLANT)[0]
    bound.expect(fits, "the bound is for the other way of sharing")
    least.expect(least["feasible"] and not least["free_assignability"], "more is asked for")
    more = enough(bound, *hypotheses).removeprefix(f"{least.about}: ")
    return f"{least.statement}; {more}"


@rule("allocate-proof allocate-cost-proof", LEAST)
@rule("allocate-links-proof", LINKS)
def _proved(least: Premise) -> str:
    """How long the proof is that nothing costs less."""
    cuts, nodes = (len(least.witness[key]) for key in ("cuts", "tree"))
    return f"{least.statement}, by {counted(cuts, 'cut')} and {counted(nodes, 'node')} of a tree"


def demands(least: Premise, agents: str, alone: bool = False) -> str:
    """Cuts of the evidence in words, and why: a mode, or no transfer to their agents.

    Of a mode those of none, some or all ``agents`` are meant, or those that are cut off; if
    ``alone``, only those of agents that receive messages from no other agent.
    """
    system, told = least.system, []
    N = system.neighbors or [[i] for i in range(system.m)]
    sharing = f"sharing {SHARED[least['share']]} without delay"
    for cut in least.cited("witness", "cuts"):
        s, p = [system.names.index(name) for name in cut["subset"]], cut.get("polynomial")
        which = "none" if not s else "all" if len(s) == system.m else "some"
        senders = sorted({j for i in s for j in N[i]} - set(s))
        if agents == (which if p else "cut off") and not (alone and senders):
            goal, why = "a strongly connected transfer graph", "the others do not act on it"
            if p:
                goal = no_fixed_mode(least["bound"], system)
                why = f"the roots of {polynomial_text(p)}"
            others = channel_set(system.names[j] for j in senders)
            lacks = f"{channel_set(cut['subset'])} receives from {others}"
            needed = f"at least {counted(cut.get('deficiency', 1), 'sub-state')} in all"
            told.append(f"for {goal}, {sharing}, {lacks}, which must share {needed}: {why}")
    least.expect(bool(told), "the evidence has no such cut")
    return f"{least.about}: {'; '.join(told)}"


rule("allocate-reason", LEAST)(partial(demands, agents="some"))
rule("allocate-reason-do-not-control", LEAST)(partial(demands, agents="none"))
rule("allocate-reason-do-not-observe", LEAST)(partial(demands, agents="all"))
rule("allocate-reason-cut-off", LEAST)(partial(demands, agents="cut off"))


# Links.


def fewest(links: Premise) -> bool:
    """Whether the fewest links for outputs are asked for, so that no mode at all is fixed."""
    system, listed = links.system, links["candidates"]
    heard = sum(len(N_i) - 1 for N_i in system.neighbors or [])
    everywhere = len(listed) == system.m * (system.m - 1) - heard
    asked = links["share"] == "outputs" and links["bound"] is None
    return asked and everywhere and all(cost == 1 for *_, cost in listed)


restate("links", LINKS, lambda c: fewest(c) and c["added"] and c.system.neighbors is None)
restate("links-beside-graph", LINKS, lambda c: fewest(c) and c["added"] and c.system.neighbors)
restate("table-links", LINKS, lambda c: fewest(c) and c["added"])
restate("links-none table-links-none", LINKS, lambda c: fewest(c) and c["added"] == [])
restate("no-links table-links-impossible", LINKS, lambda c: fewest(c) and not c["feasible"])
restate("allocate-links allocate-link allocate-links-total", LINKS, lambda c: c["added"])
restate("allocate-no-links-needed", LINKS, lambda c: c["added"] == [])
restate("allocate-no-links", LINKS, lambda c: not c["feasible"])
