"""What certificates about a plant with a parameter imply, for all of its values."""

from collections.abc import Callable
from itertools import combinations, pairwise

from . import reading
from .parameters import ends_of, ends_text, where_text
from .parametric_system import FunctionSystem, ParametricSystem, common_divisor
from .reading import Json
from .sentences import HAUTUS, PLANT, RANK_RULE, Holds, Premise, Role, restate, rule
from .system import described, edge_set, polynomial_text

MODES = Role(("parametric_fixed_spectrum",), PLANT)
CONTROLLED = Role(MODES.kinds, (("full_output",), ("merged", "full_output")))
OBSERVED = Role(MODES.kinds, (("dual", "full_output"), ("dual", "merged", "full_output")))
ALONE = Role(MODES.kinds, (("full_output",), ("restricted", "full_output")))
SEEN = Role(MODES.kinds, (("dual", "full_output"), ("dual", "restricted", "full_output")))
STEADY = Role(("parametric_rank",), PLANT)
RANKS = Role(STEADY.kinds, PLANT, many=True)
DUAL_RANKS = Role(STEADY.kinds, (("dual",),), many=True)


@rule("parametric-heading")
def _given(known: list[Premise]) -> str:
    """The sizes of the plant, its parameter, and where an entry is undefined."""
    plant = known[0].meant
    known[0].expect(isinstance(plant, FunctionSystem), "the plant has no parameter")
    if not isinstance(plant, ParametricSystem):
        ends = ", ".join(
            f"{name} between {ends_of(bounds)}" for name, bounds in plant.ranges.items()
        )
        return f"For {described(plant)}: its parameters are {ends}"
    told = f"For {described(plant)}: its parameter is {plant.parameter}, between {ends_text(plant)}"
    poles = dict.fromkeys(polynomial_text(q, plant.parameter) for q in plant.poles if len(q) > 1)
    return f"{told}; an entry is undefined at the roots of {', '.join(poles)}" if poles else told


# Modes: none for every value, none unless, some, some and others.


def of_modes(keys: str, role: Role, theorem: str, about: Callable[[Premise], bool]) -> None:
    """Enter four rules, by whether modes are lost for every value, and others at some."""
    for key, (whole, more) in zip(keys.split(), WAYS, strict=True):

        def holds(found: Premise, whole: bool = whole, more: bool = more) -> bool:
            found.expect(about(found), "about other channels")
            return (bool(found["generic"]), bool(found["exceptional"])) == (whole, more)

        restate(key, role, holds, theorem)


WAYS = ((False, False), (False, True), (True, False), (True, True))


def together(found: Premise) -> bool:
    """Whether one channel is left, which has the ports of all."""
    return bool(found.system.m == 1)


def ways(stem: str) -> str:
    """The keys of the four rules."""
    return " ".join(f"parametric-{stem}-{way}" for way in ("always", "unless", "some", "more"))


of_modes(ways("modes"), MODES, "", lambda found: True)
of_modes(ways("controllable"), CONTROLLED, HAUTUS, together)
of_modes(ways("observable"), OBSERVED, HAUTUS, together)
of_modes(ways("channel-controllable"), ALONE, HAUTUS, together)
of_modes(ways("channel-observable"), SEEN, HAUTUS, together)
restate("parametric-nothing-fixed", MODES, lambda found: not found["generic"])
restate("parametric-fixed", MODES, lambda found: found["generic"])
restate("parametric-another", MODES, lambda found: found["exceptional"])


# What several certificates imply together: only for values of which each one speaks.


def concluded(found: list[Premise], told: str) -> str:
    """The claims of the certificates, and the conclusion for the values that all are about."""
    outside = {str(entry["value"]): entry for each in found for entry in each["outside"]}
    where = where_text({"outside": [*outside.values()]}, found[0].meant)
    return "; ".join([*(each.statement for each in found), f"so {where}, {told}"])


def except_at(values: list[Json], t: str) -> str:
    """The words that leave out the roots of some polynomials; empty if there are none."""
    roots = [f"the roots of {polynomial_text(q, t)}" for q in values]
    return f" except at {' and '.join(roots)}" if roots else ""


# The transfer graph and completeness.

Lost = dict[tuple[str, str], list[Json]]


def edges(found: list[Premise]) -> Lost:
    """The edges for almost every value, each with the polynomials at whose roots it vanishes."""
    decided: Lost = {}
    for each in found:
        each.expect(each["matrix"]["name"] == "transfer", "not about the inputs of a channel")
        j, i = each["matrix"]["from"], each["matrix"]["to"]
        decided[j, i] = [value["value"] for value in each["exceptional"]]
    names = found[0].system.names
    missing = [(j, i) for j in names for i in names if (j, i) not in decided]
    found[0].expect(not missing, f"nothing is said of the edges {edge_set(missing[:3])}")
    ranks = {(e["matrix"]["from"], e["matrix"]["to"]): e["rank"] for e in found}
    return {edge: lost for edge, lost in decided.items() if ranks[edge]}


def connected(names: list[str], kept: list[tuple[str, str]]) -> bool:
    """Whether edges lead from the first channel to all others, and back."""
    for ends in (kept, [(i, j) for j, i in kept]):
        reached, new = set[str](), {names[0]}
        while new:
            reached |= new
            new = {i for j, i in ends if j in new} - reached
        if len(reached) < len(names):
            return False
    return True


def _graph(keys: str, lost: bool) -> None:
    @rule(keys, RANKS)
    def _say(found: list[Premise]) -> str:
        """The edges for almost every value, and what is proved of each."""
        kept = edges(found)
        found[0].expect(any(kept.values()) == lost, "the claim is different")
        values = [*{str(q): q for gone in kept.values() for q in gone}.values()]
        less = except_at(values, found[0].meant.parameter)
        return concluded(found, f"the transfer graph has the edges {edge_set(kept)}{less}")


_graph("parametric-graph-always", False)
_graph("parametric-graph-lost", True)


def require_apart(values: list[Json], found: Premise) -> None:
    """Stop if two polynomials have a common root, at which the edges of both would vanish."""
    known = [reading.polynomial(q, found.file, 1) for q in values]
    for p, q in combinations(known, 2):
        found.expect(len(common_divisor(p, q)) == 1, "edges vanish at some roots of a value alone")


def complete(spectrum: Premise, found: list[Premise]) -> list[Json] | None:
    """The polynomials at whose roots the plant is not complete; None if it is for no value."""
    kept, names = edges(found), spectrum.system.names
    if spectrum["generic"] or not connected(names, list(kept)):
        return None
    where = [value["value"] for value in spectrum["exceptional"]]
    values = [*{str(q): q for lost in kept.values() for q in lost}.values()]
    require_apart(values, spectrum)
    for q in values:
        left = [edge for edge, lost in kept.items() if q not in lost]
        if q not in where and not connected(names, left):
            where.append(q)
    return where


def _complete(key: str, holds: Callable[[list[Json] | None], bool], told: str) -> None:
    @rule(key, MODES, RANKS)
    def _say(spectrum: Premise, found: list[Premise]) -> str:
        """No fixed mode and a strongly connected transfer graph."""
        where, t = complete(spectrum, found), spectrum.meant.parameter
        spectrum.expect(holds(where), "the claim is different")
        return concluded([spectrum, *found], told + except_at(where or [], t))


_complete("parametric-complete-always", lambda where: where == [], "it is complete")
_complete("parametric-complete-unless", bool, "it is complete")
_complete("parametric-complete-never", lambda where: where is None, "it is not complete")


# Indices and set-points.


def _indices(stem: str, role: Role) -> None:
    def said(found: list[Premise]) -> bool:
        """Whether the ranks of all numbers of blocks are known, and whether they change."""
        n = found[0].system.n
        found.sort(key=lambda each: int(each["matrix"].get("blocks", 0)))
        for k, each in enumerate(found, 1):
            matrix = each["matrix"]
            right = matrix["name"] == "controllability" and matrix["blocks"] == k
            each.expect(right, f"not about {k} blocks")
            each.expect(matrix["channels"] == each.system.names, "not about all channels")
        last = [_ranks(each) for each in found[-2:]]
        settled = len(found) >= n or (len(last) == 2 and last[0] == last[1])
        found[0].expect(settled, "the ranks may grow with more blocks")
        return any(each["exceptional"] for each in found)

    for way, lost in (("always", False), ("unless", True)):

        @rule(f"parametric-{stem}-indices-{way}", role)
        def _say(found: list[Premise], lost: bool = lost) -> str:
            """The ranks block by block, and the numbers of columns that each input adds to them."""
            found[0].expect(said(found) == lost, "the claim is different")
            ranks = [0, *(each["rank"] for each in found)]
            growth = [b - a for a, b in pairwise(ranks)]
            indices = [sum(g > j for g in growth) for j in range(growth[0])]
            listed = {str(e["value"]): e["value"] for each in found for e in each["exceptional"]}
            less = except_at([*listed.values()], found[0].meant.parameter)
            return concluded(found, f"the {stem} indices are {indices}{less}")


def _ranks(found: Premise) -> Json:
    listed = sorted([[str(c) for c in e["value"]], e["rank"]] for e in found["exceptional"])
    return found["rank"], listed, sorted([str(c) for c in e["value"]] for e in found["outside"])


_indices("controllability", RANKS)
_indices("observability", DUAL_RANKS)


def solvable(found: Premise) -> bool:
    """Whether the rank is full for almost every value."""
    found.expect(found["matrix"]["name"] == "setpoint", "not about equilibria")
    return bool(found["rank"] == found.system.n + sum(M[0].nrows for M in found.system.C))


ALWAYS, UNLESS, NEVER = (f"parametric-setpoint-{way}" for way in ("always", "unless", "never"))
restate(ALWAYS, STEADY, lambda c: solvable(c) and not c["exceptional"], RANK_RULE)
restate(UNLESS, STEADY, lambda c: solvable(c) and c["exceptional"], RANK_RULE)
restate(NEVER, STEADY, lambda c: not solvable(c), RANK_RULE)


# Several parameters.  A certificate is about a line, where s is any complex number: what it says is
# repeated.  What holds at one point of it, and fails where polynomials in the parameters are 0,
# holds for almost all values: that no mode is fixed, or that a rank is at least so large.  A mode
# is fixed where pencils lose rank at a root of det(xI - A), which is monic: so the values at which
# one is fixed are zeros of polynomials, apart from the poles.


def on_a_line(role: Role) -> Role:
    """The role for premises whose subject is constructed from the plant on a line."""
    return Role(role.kinds, tuple(("line", *path) for path in role.paths), role.many)


LINES, LINE_RANKS = on_a_line(MODES), on_a_line(RANKS)
RANK_ON_LINE = on_a_line(STEADY)


def almost(found: list[Premise], told: str) -> str:
    """The claims about lines, and the conclusion for almost all values."""
    parameters = ", ".join(found[0].meant.ranges)
    every = f"so for almost all complex values of the parameters {parameters}, {told}"
    return "; ".join([*(each.statement for each in found), every])


def of_lines(stem: str, role: Role, theorem: str, about: Callable[[Premise], bool]) -> None:
    """Enter the rule that repeats what modes are on a line."""

    def holds(found: Premise) -> bool:
        found.expect(about(found), "about other channels")
        return True

    restate(f"parametric-line-{stem}", on_a_line(role), holds, theorem)


def almost_no_mode(key: str, role: Role, told: str, theorem: str = "") -> None:
    """Enter the rule that nothing is lost for almost all values if nothing is at one point."""

    @rule(key, on_a_line(role), theorem=theorem)
    def _say(found: Premise) -> str:
        """No mode at some point of a line."""
        found.expect(not found["generic"], "the claim is different")
        found.expect(key == "parametric-almost-nothing-fixed" or together(found), "other channels")
        return almost([found], told)


of_lines("modes", MODES, "", lambda found: True)
of_lines("controllable", CONTROLLED, "", together)
of_lines("observable", OBSERVED, "", together)
of_lines("channel-controllable", ALONE, "", together)
of_lines("channel-observable", SEEN, "", together)
almost_no_mode("parametric-almost-nothing-fixed", MODES, "no mode is fixed")
almost_no_mode(
    "parametric-almost-controllable", CONTROLLED, "all channels control every mode", HAUTUS
)
almost_no_mode("parametric-almost-observable", OBSERVED, "all channels observe every mode", HAUTUS)
almost_no_mode(
    "parametric-almost-channel-controllable", ALONE, "the channel controls every mode", HAUTUS
)
almost_no_mode(
    "parametric-almost-channel-observable", SEEN, "the channel observes every mode", HAUTUS
)


def named(matrix: str) -> Holds:
    """Whether a certificate is about the rank of such a matrix."""
    return lambda found: found["matrix"]["name"] == matrix


restate("parametric-line-graph", RANK_ON_LINE, named("transfer"))
restate("parametric-line-setpoint", RANK_ON_LINE, named("setpoint"))
restate("parametric-line-controllability-indices", RANK_ON_LINE, named("controllability"))
restate(
    "parametric-line-observability-indices",
    Role(STEADY.kinds, (("line", "dual"),)),
    named("controllability"),
)


def some_edges(found: list[Premise]) -> list[tuple[str, str]]:
    """The edges that are proved at a point."""
    for each in found:
        each.expect(each["matrix"]["name"] == "transfer", "not about the inputs of a channel")
    pairs = [(each["matrix"]["from"], each["matrix"]["to"]) for each in found if each["rank"]]
    return [*dict.fromkeys(pairs)]


@rule("parametric-almost-graph", LINE_RANKS)
def _almost_edges(found: list[Premise]) -> str:
    """The edges that a point of a line has; others may be edges as well."""
    edges_known = some_edges(found)
    found[0].expect(bool(edges_known), "no edge is proved")
    return almost(found, f"the transfer graph has the edges {edge_set(edges_known)}")


@rule("parametric-almost-complete", LINES, LINE_RANKS)
def _almost_complete(spectrum: Premise, found: list[Premise]) -> str:
    """No mode is fixed at a point, and the edges of other points connect all channels."""
    spectrum.expect(not spectrum["generic"], "the claim is different")
    spectrum.expect(connected(spectrum.meant.names, some_edges(found)), "the claim is different")
    return almost([spectrum, *found], "it is complete")


@rule("parametric-almost-setpoint", RANK_ON_LINE, theorem=RANK_RULE)
def _almost_steady(found: Premise) -> str:
    """Full rank at a point of a line."""
    found.expect(solvable(found), "the claim is different")
    return almost([found], "the rank is as large")
