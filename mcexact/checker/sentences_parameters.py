"""Rules of sentences about all values of parameters.

With one parameter a certificate names the polynomials at whose roots its claim differs, and values
of which it claims nothing (``outside``).  A sentence that needs several certificates holds only for
the values of which all of them speak: `concluded` repeats their claims and joins what they leave
out.  Completeness, for example, needs the fixed modes and the rank of every entry of the transfer
matrix.

With several parameters a certificate is about a line in their space.  What holds at one of its
points holds for almost all values, if it fails only where a polynomial vanishes (`almost`).
"""

from collections.abc import Callable
from itertools import combinations, pairwise

from .core import reading
from .core.reading import Json
from .core.system import described, edge_set, polynomial_text
from .parameters import ends_of, ends_text, where_text
from .parametric_system import FunctionSystem, ParametricSystem, common_divisor
from .sentences import HAUTUS, PLANT, RANK_RULE, Holds, Premise, Role, restate, rule

MODES = Role(("parametric_fixed_spectrum",), PLANT)
CONTROLLED = Role(MODES.kinds, (("full_output",), ("merged", "full_output")))
OBSERVED = Role(MODES.kinds, (("dual", "full_output"), ("dual", "merged", "full_output")))
ALONE = Role(MODES.kinds, (("full_output",), ("restricted", "full_output")))
SEEN = Role(MODES.kinds, (("dual", "full_output"), ("dual", "restricted", "full_output")))
STEADY = Role(("parametric_rank",), PLANT)
RANKS = Role(STEADY.kinds, PLANT, many=True)
DUAL_RANKS = Role(STEADY.kinds, (("dual",),), many=True)


@rule("parametric-heading")
def _heading(known: list[Premise]) -> str:
    """The sizes of the plant, its parameter, and where an entry is undefined."""
    plant = known[0].meant
    known[0].expect(isinstance(plant, FunctionSystem), "the plant has no parameter")
    if not isinstance(plant, ParametricSystem):
        ends = ", ".join(
            f"{name} between {ends_of(bounds)}" for name, bounds in plant.ranges.items()
        )
        return f"For {described(plant)}: its parameters are {ends}"
    heading = (
        f"For {described(plant)}: its parameter is {plant.parameter}, between {ends_text(plant)}"
    )
    poles = dict.fromkeys(polynomial_text(q, plant.parameter) for q in plant.poles if len(q) > 1)
    return (
        f"{heading}; an entry is undefined at the roots of {', '.join(poles)}" if poles else heading
    )


# Modes: none for every value, none unless, some, some and others.


def of_modes(keys: str, role: Role, theorem: str, about: Callable[[Premise], bool]) -> None:
    """Enter four rules, by whether modes are lost for every value, and others at some."""
    for key, (whole, more) in zip(keys.split(), WAYS, strict=True):

        def holds(premise: Premise, whole: bool = whole, more: bool = more) -> bool:
            premise.expect(about(premise), "about other channels")
            return (bool(premise["generic"]), bool(premise["exceptional"])) == (whole, more)

        restate(key, role, holds, theorem)


WAYS = ((False, False), (False, True), (True, False), (True, True))


def together(premise: Premise) -> bool:
    """Whether one channel is left, which has the ports of all."""
    return bool(premise.system.m == 1)


def ways(stem: str) -> str:
    """The keys of the four rules."""
    return " ".join(f"parametric-{stem}-{way}" for way in ("always", "unless", "some", "more"))


of_modes(ways("modes"), MODES, "", lambda premise: True)
of_modes(ways("controllable"), CONTROLLED, HAUTUS, together)
of_modes(ways("observable"), OBSERVED, HAUTUS, together)
of_modes(ways("channel-controllable"), ALONE, HAUTUS, together)
of_modes(ways("channel-observable"), SEEN, HAUTUS, together)
restate("parametric-nothing-fixed", MODES, lambda premise: not premise["generic"])
restate("parametric-fixed", MODES, lambda premise: premise["generic"])
restate("parametric-another", MODES, lambda premise: premise["exceptional"])


# What several certificates imply together: only for values of which each one speaks.


def concluded(premises: list[Premise], conclusion: str) -> str:
    """The claims of the certificates, and the conclusion for the values that all are about."""
    outside = {str(entry["value"]): entry for each in premises for entry in each["outside"]}
    where = where_text({"outside": [*outside.values()]}, premises[0].meant)
    return "; ".join([*(each.statement for each in premises), f"so {where}, {conclusion}"])


def except_at(values: list[Json], t: str) -> str:
    """The words that leave out the roots of some polynomials; empty if there are none."""
    roots = [f"the roots of {polynomial_text(q, t)}" for q in values]
    return f" except at {' and '.join(roots)}" if roots else ""


# The transfer graph and completeness.

Lost = dict[tuple[str, str], list[Json]]


def edges(premises: list[Premise]) -> Lost:
    """The edges for almost every value, each with the polynomials at whose roots it vanishes."""
    decided: Lost = {}
    for each in premises:
        each.expect(each["matrix"]["name"] == "transfer", "not about the inputs of a channel")
        j, i = each["matrix"]["from"], each["matrix"]["to"]
        decided[j, i] = [value["value"] for value in each["exceptional"]]
    names = premises[0].system.names
    missing = [(j, i) for j in names for i in names if (j, i) not in decided]
    premises[0].expect(not missing, f"nothing is said of the edges {edge_set(missing[:3])}")
    ranks = {(e["matrix"]["from"], e["matrix"]["to"]): e["rank"] for e in premises}
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
    def _say(premises: list[Premise]) -> str:
        """The edges for almost every value, and what is proved of each."""
        kept = edges(premises)
        premises[0].expect(any(kept.values()) == lost, "the claim is different")
        values = [*{str(q): q for gone in kept.values() for q in gone}.values()]
        less = except_at(values, premises[0].meant.parameter)
        return concluded(premises, f"the transfer graph has the edges {edge_set(kept)}{less}")


_graph("parametric-graph-always", False)
_graph("parametric-graph-lost", True)


def require_apart(values: list[Json], premise: Premise) -> None:
    """Stop if two polynomials have a common root, at which the edges of both would vanish."""
    known = [reading.polynomial(q, premise.file, 1) for q in values]
    for p, q in combinations(known, 2):
        premise.expect(
            len(common_divisor(p, q)) == 1, "edges vanish at some roots of a value alone"
        )


def complete(spectrum: Premise, premises: list[Premise]) -> list[Json] | None:
    """The polynomials at whose roots the plant is not complete; None if it is for no value."""
    kept, names = edges(premises), spectrum.system.names
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


def _complete(key: str, holds: Callable[[list[Json] | None], bool], conclusion: str) -> None:
    @rule(key, MODES, RANKS)
    def _say(spectrum: Premise, premises: list[Premise]) -> str:
        """No fixed mode and a strongly connected transfer graph."""
        where, t = complete(spectrum, premises), spectrum.meant.parameter
        spectrum.expect(holds(where), "the claim is different")
        return concluded([spectrum, *premises], conclusion + except_at(where or [], t))


_complete("parametric-complete-always", lambda where: where == [], "it is complete")
_complete("parametric-complete-unless", bool, "it is complete")
_complete("parametric-complete-never", lambda where: where is None, "it is not complete")


# Indices and set-points.


def _indices(stem: str, role: Role) -> None:
    def changing(premises: list[Premise]) -> bool:
        """Whether the ranks of all numbers of blocks are known, and whether they change."""
        n = premises[0].system.n
        premises.sort(key=lambda each: int(each["matrix"].get("blocks", 0)))
        for k, each in enumerate(premises, 1):
            matrix = each["matrix"]
            right = matrix["name"] == "controllability" and matrix["blocks"] == k
            each.expect(right, f"not about {k} blocks")
            each.expect(matrix["channels"] == each.system.names, "not about all channels")
        last = [_ranks(each) for each in premises[-2:]]
        settled = len(premises) >= n or (len(last) == 2 and last[0] == last[1])
        premises[0].expect(settled, "the ranks may grow with more blocks")
        return any(each["exceptional"] for each in premises)

    for way, lost in (("always", False), ("unless", True)):

        @rule(f"parametric-{stem}-indices-{way}", role)
        def _say(premises: list[Premise], lost: bool = lost) -> str:
            """The ranks block by block, and the numbers of columns that each input adds to them."""
            premises[0].expect(changing(premises) == lost, "the claim is different")
            ranks = [0, *(each["rank"] for each in premises)]
            growth = [b - a for a, b in pairwise(ranks)]
            indices = [sum(g > j for g in growth) for j in range(growth[0])]
            listed = {str(e["value"]): e["value"] for each in premises for e in each["exceptional"]}
            less = except_at([*listed.values()], premises[0].meant.parameter)
            return concluded(premises, f"the {stem} indices are {indices}{less}")


def _ranks(premise: Premise) -> Json:
    listed = sorted([[str(c) for c in e["value"]], e["rank"]] for e in premise["exceptional"])
    return premise["rank"], listed, sorted([str(c) for c in e["value"]] for e in premise["outside"])


_indices("controllability", RANKS)
_indices("observability", DUAL_RANKS)


def solvable(premise: Premise) -> bool:
    """Whether the rank is full for almost every value."""
    premise.expect(premise["matrix"]["name"] == "setpoint", "not about equilibria")
    return bool(premise["rank"] == premise.system.n + sum(M[0].nrows for M in premise.system.C))


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
    """The role for premises whose subject is constructed from the plant on a line, each its own."""
    paths = tuple(("line", *path) for path in role.paths)
    return Role(role.kinds, paths, role.many, apart=True)


LINES, LINE_RANKS = on_a_line(MODES), on_a_line(RANKS)
RANK_ON_LINE = on_a_line(STEADY)


def almost(premises: list[Premise], conclusion: str) -> str:
    """The claims about lines, and the conclusion for almost all values."""
    parameters = ", ".join(premises[0].meant.ranges)
    every = f"so for almost all complex values of the parameters {parameters}, {conclusion}"
    return "; ".join([*(each.statement for each in premises), every])


def of_lines(stem: str, role: Role, theorem: str, about: Callable[[Premise], bool]) -> None:
    """Enter the rule that repeats what modes are on a line."""

    def holds(premise: Premise) -> bool:
        premise.expect(about(premise), "about other channels")
        return True

    restate(f"parametric-line-{stem}", on_a_line(role), holds, theorem)


def almost_no_mode(key: str, role: Role, conclusion: str, theorem: str = "") -> None:
    """Enter the rule that nothing is lost for almost all values if nothing is at one point."""

    @rule(key, on_a_line(role), theorem=theorem)
    def _say(premise: Premise) -> str:
        """No mode at some point of a line."""
        premise.expect(not premise["generic"], "the claim is different")
        premise.expect(
            key == "parametric-almost-nothing-fixed" or together(premise), "other channels"
        )
        return almost([premise], conclusion)


of_lines("modes", MODES, "", lambda premise: True)
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
    return lambda premise: premise["matrix"]["name"] == matrix


restate("parametric-line-graph", RANK_ON_LINE, named("transfer"))
restate("parametric-line-setpoint", RANK_ON_LINE, named("setpoint"))
restate("parametric-line-controllability-indices", RANK_ON_LINE, named("controllability"))
restate(
    "parametric-line-observability-indices",
    Role(STEADY.kinds, (("line", "dual"),)),
    named("controllability"),
)


def some_edges(premises: list[Premise]) -> list[tuple[str, str]]:
    """The edges that are proved at a point."""
    for each in premises:
        each.expect(each["matrix"]["name"] == "transfer", "not about the inputs of a channel")
    pairs = [(each["matrix"]["from"], each["matrix"]["to"]) for each in premises if each["rank"]]
    return [*dict.fromkeys(pairs)]


@rule("parametric-almost-graph", LINE_RANKS)
def _almost_edges(premises: list[Premise]) -> str:
    """The edges that a point of a line has; others may be edges as well."""
    edges_known = some_edges(premises)
    premises[0].expect(bool(edges_known), "no edge is proved")
    return almost(premises, f"the transfer graph has the edges {edge_set(edges_known)}")


@rule("parametric-almost-complete", LINES, LINE_RANKS)
def _almost_complete(spectrum: Premise, premises: list[Premise]) -> str:
    """No mode is fixed at a point, and the edges of other points connect all channels."""
    spectrum.expect(not spectrum["generic"], "the claim is different")
    spectrum.expect(connected(spectrum.meant.names, some_edges(premises)), "the claim is different")
    return almost([spectrum, *premises], "it is complete")


@rule("parametric-almost-setpoint", RANK_ON_LINE, theorem=RANK_RULE)
def _almost_steady(premise: Premise) -> str:
    """Full rank at a point of a line."""
    premise.expect(solvable(premise), "the claim is different")
    return almost([premise], "the rank is as large")
