"""Judges of the sentences about links, shared states and delays.

A network is built and its loops under drawn gains are compared: what shares no root leaves nothing
fixed.  That fewer states or links do not suffice is tried for all of them.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from flint import fmpq_poly

from tests.oracle.certificates.modes import subsets
from tests.oracle.certificates.structure import boundary_sizes, numbers_of_relays
from tests.oracle.sentences.analysis import Judge, judge, lost
from tests.oracle.sentences.cases import (
    Case,
    Facts,
    Region,
    Said,
    UnjudgedError,
    components,
    divides,
    irreducible,
    number,
    same_roots,
)

OUTPUTS, STATES = "outputs+states", "states"
MOST_TRIES = 400


def leaves(facts: Facts, bound: Any = None, free: bool = False) -> bool:
    """Whether no mode is fixed that is as slow as a bound, and the spectrum is free if asked."""
    if bound is None:
        forbidden = facts.fixed_polynomial.degree() > 0
    else:
        fast = Region(facts.system.time, number(bound))
        forbidden = any(not fast.contains(p) for p, _ in irreducible(facts.fixed_polynomial))
    return not forbidden and (
        not free or (facts.fixed_polynomial.degree() == 0 and len(facts.parts) <= 1)
    )


def instant(said: Said, case: Case) -> bool:
    """Whether a sentence says that delays are left out of account where there are some."""
    return bool(said.values.get("time", case.slow) == case.slow)


def linked(case: Case, added: Sequence[Sequence[str]]) -> Case:
    """The case with more links in its neighbor graph."""
    plant = case.plant
    neighborhoods = [set(N) for N in plant.neighborhoods or [(i,) for i in range(plant.m)]]
    for start, end in added:
        [j], [i] = case.indices([start]), case.indices([end])
        neighborhoods[i].add(j)
    wider = replace(plant, neighborhoods=tuple(tuple(sorted(N)) for N in neighborhoods))
    return Case(wider, case.asked)


# The neighbor graph.


def _connected(case: Case) -> bool:
    neighborhoods = case.plant.neighborhoods or ()
    return (
        len(components(case.plant.m, [(j, i) for i, N in enumerate(neighborhoods) for j in N])) == 1
    )


@judge("neighbor-graph-connected")
def _is_connected(said: Said, case: Case) -> bool:
    return case.plant.neighborhoods is not None and _connected(case)


@judge("neighbor-graph-not-connected", "enough-unknown")
def _is_not_connected(said: Said, case: Case) -> bool:
    return case.plant.neighborhoods is not None and not _connected(case)


@judge("source-components", "design-source-components")
def _source_components(said: Said, case: Case) -> bool:
    """The strong components into which no edge leads from others."""
    neighborhoods = case.plant.neighborhoods or ()
    edges = [(j, i) for i, N in enumerate(neighborhoods) for j in N]
    sources = [s for s in components(case.plant.m, edges) if not case.senders(s)]
    return sorted(sorted(case.indices(names)) for names in said.values["parts"]) == sorted(sources)


# What suffices, and what does not.


def stays_shared(said: Said, case: Case) -> bool:
    """The modes stay with as many shared states as the plant has, by agents that are closed."""
    inside, outside = (case.indices(said.values[side]) for side in ("inside", "outside"))
    parts = [q for q, _ in irreducible(said.values["p"])]
    left = case.extended([case.plant.n] * case.plant.m, OUTPUTS).fixed_polynomial
    lost = [not case.own.observes(inside, q) and not case.own.controls(outside, q) for q in parts]
    stay = [divides(q, left) and case.own.rank(inside, q) < case.own.n for q in parts]
    closed = bool(inside) and bool(outside) and not case.senders(inside)
    everybody = sorted([*inside, *outside]) == list(range(case.plant.m))
    return bool(parts) and all([*lost, *stay]) and closed and everybody


judge("stays-shared")(stays_shared)


@judge("free-shared")
def _free_shared(said: Said, case: Case) -> bool:
    return instant(said, case) and leaves(case.extended([case.plant.n] * case.plant.m, OUTPUTS))


def _enough(share: str, positive: bool) -> Judge:
    def decides(said: Said, case: Case) -> bool:
        k = said.values.get("k", 0)
        total = said.values.get("total", 0)
        right = (k > 0) == positive and total == k * case.plant.m and instant(said, case)
        return right and leaves(case.extended([k] * case.plant.m, share))

    return decides


judge("enough-outputs-states")(_enough(OUTPUTS, True))
judge("enough-outputs")(_enough(OUTPUTS, False))
judge("enough-states")(_enough(STATES, True))
judge("enough-nothing")(_enough(STATES, False))


@judge("sharing-in-vain-controllability")
def _vain_control(said: Said, case: Case) -> bool:
    return lost(said, case.own.uncontrolled())


@judge("sharing-in-vain-observability")
def _vain_observe(said: Said, case: Case) -> bool:
    return lost(said, case.own.unobserved())


def below(
    cost: Fraction, costs: Sequence[Fraction], upper: Sequence[int]
) -> Iterator[tuple[int, ...]]:
    """The largest vectors within upper limits whose cost is below a number."""
    ranges = [range(limit + 1) for limit in upper]
    size = 1
    for each in ranges:
        size *= len(each)
    if size > 10**5:
        raise UnjudgedError("too many dimensions to try")
    price = lambda v: sum((c * k for c, k in zip(costs, v, strict=True)), Fraction(0))  # noqa: E731
    for v in itertools.product(*ranges):
        if price(v) < cost:
            more = ((*v[:i], v[i] + 1, *v[i + 1 :]) for i in range(len(v)) if v[i] < upper[i])
            if all(price(w) >= cost for w in more):
                yield v


def least(
    case: Case, sizes: Sequence[int], share: str, asked: dict[str, Any] | None = None
) -> bool:
    """Whether these dimensions suffice within their limits, and none that cost less do."""
    asked = asked or {}
    bound, free = asked.get("bound"), asked.get("free", False)
    m, n = case.plant.m, case.plant.n
    costs = [Fraction(c) for c in asked.get("costs") or [1] * m]
    if any(
        k > u for k, u in zip(sizes, asked.get("upper") or [n] * m, strict=True) if u is not None
    ):
        return False
    if not leaves(case.extended(sizes, share), bound, free):
        return False
    cost = sum((c * k for c, k in zip(costs, sizes, strict=True)), Fraction(0))
    return nothing_below(case, cost, share, asked)


def nothing_below(
    case: Case, cost: Fraction, share: str, asked: dict[str, Any] | None = None
) -> bool:
    """Whether no dimensions within their limits that cost less suffice."""
    asked = asked or {}
    m, n = case.plant.m, case.plant.n
    costs = [Fraction(c) for c in asked.get("costs") or [1] * m]
    limits = [n if u is None else min(u, n) for u in asked.get("upper") or [None] * m]
    for count, v in enumerate(below(Fraction(cost), costs, limits)):
        if count >= MOST_TRIES:
            raise UnjudgedError("too many dimensions to try")
        if leaves(case.extended(v, share), asked.get("bound"), asked.get("free", False)):
            return False
    return True


def none_suffice(case: Case, share: str, asked: dict[str, Any] | None = None) -> bool:
    """Whether as much as is allowed does not suffice; no more than n states each help."""
    asked = asked or {}
    m, n = case.plant.m, case.plant.n
    most = [n if u is None else min(u, n) for u in asked.get("upper") or [None] * m]
    return not leaves(case.extended(most, share), asked.get("bound"), asked.get("free", False))


def _sizes(said: Said, case: Case) -> list[int]:
    if [name for name, _ in said.values["sizes"]] != list(case.plant.names):
        raise UnjudgedError("the sizes are of other agents")
    return [size for _, size in said.values["sizes"]]


def _least(share: str, *rules: str) -> None:
    some, none, impossible = rules

    @judge(*some.split())
    def _some(said: Said, case: Case) -> bool:
        sizes = _sizes(said, case)
        return any(sizes) and least(case, sizes, share) and instant(said, case)

    @judge(some.split()[-1] + "-between")
    def _between(said: Said, case: Case) -> bool:
        sizes, lower = _sizes(said, case), said.values["lower"]
        enough = leaves(case.extended(sizes, share)) and lower < sum(sizes)
        return enough and instant(said, case) and nothing_below(case, lower, share)

    @judge(*none.split())
    def _none(said: Said, case: Case) -> bool:
        return leaves(case.extended([0] * case.plant.m, share)) and instant(said, case)

    @judge(*impossible.split())
    def _impossible(said: Said, case: Case) -> bool:
        return none_suffice(case, share)


_least(
    OUTPUTS,
    "sharing-removes least-outputs-states",
    "outputs-remove least-outputs-states-none common-dimension-outputs-states-none",
    "no-sharing least-outputs-states-impossible common-dimension-outputs-states-impossible",
)
_least(
    STATES,
    "least-states",
    "least-states-none common-dimension-states-none",
    "least-states-impossible common-dimension-states-impossible",
)


def _common(share: str) -> Judge:
    def decides(said: Said, case: Case) -> bool:
        """k states of each agent suffice, and k − 1 do not."""
        k, m = said.values["k"], case.plant.m
        if k < 1 or said.values["total"] != k * m or not instant(said, case):
            return False
        less, enough = ([size] * m for size in (k - 1, k))
        return leaves(case.extended(enough, share)) and not leaves(case.extended(less, share))

    return decides


judge("common-dimension-outputs-states")(_common(OUTPUTS))
judge("common-dimension-states")(_common(STATES))


# Links.


def _carried(case: Case) -> tuple[list[int], str, Any]:
    """The dimensions and signals that links carry, and the bound of modes that may stay."""
    sizes = case.asked.get("dimensions") or [0] * case.plant.m
    return list(sizes), case.asked.get("link_share", OUTPUTS), case.asked.get("bound")


def fewest(case: Case, added: Sequence[Sequence[str]], prices: dict[tuple[str, str], Any]) -> bool:
    """Whether these links suffice, and no cheaper ones do."""
    sizes, share, bound = _carried(case)
    if not leaves(linked(case, added).extended(sizes, share), bound):
        return False
    cost = sum((Fraction(prices[j, i]) for j, i in added), Fraction(0))
    tried = 0
    for count in range(len(prices)):
        for chosen in itertools.combinations(prices, count):
            if sum((Fraction(prices[link]) for link in chosen), Fraction(0)) < cost:
                tried += 1
                if tried > MOST_TRIES:
                    raise UnjudgedError("too many links to try")
                if leaves(linked(case, chosen).extended(sizes, share), bound):
                    return False
    return True


def candidates(case: Case) -> dict[tuple[str, str], Any]:
    """The links that the graph lacks, at the price of one each or as it was asked."""
    names, neighborhoods = (
        case.plant.names,
        case.plant.neighborhoods or [(i,) for i in range(case.plant.m)],
    )
    asked = case.asked.get("prices")
    if asked is not None:
        return dict(asked)
    every = itertools.permutations(range(len(names)), 2)
    return {(names[j], names[i]): 1 for j, i in every if j not in neighborhoods[i]}


@judge("links", "links-beside-graph", "table-links")
def _links(said: Said, case: Case) -> bool:
    graph = (said.rule == "links-beside-graph") == (case.plant.neighborhoods is not None)
    right = graph or said.rule == "table-links"
    added = said.values["added"]
    return right and bool(added) and instant(said, case) and fewest(case, added, candidates(case))


@judge("links-none", "table-links-none")
def _no_links_needed(said: Said, case: Case) -> bool:
    return leaves(case.extended([0] * case.plant.m, OUTPUTS)) and instant(said, case)


@judge("no-links", "table-links-impossible")
def _links_in_vain(said: Said, case: Case) -> bool:
    every = list(candidates(case))
    return not leaves(linked(case, every).extended([0] * case.plant.m, OUTPUTS))


# How far the bounds can be from the least common dimension.


def _graph(case: Case) -> list[set[int]]:
    return [set(N) for N in case.plant.neighborhoods or ()]


@judge("sharing-gap")
def _factors(said: Said, case: Case) -> bool:
    relays, boundary = max(numbers_of_relays(_graph(case))), max(boundary_sizes(_graph(case)))
    return (said.values["relays"], said.values["boundary"]) == (relays, boundary)


def _farthest(share: str) -> Judge:
    def decides(said: Said, case: Case) -> bool:
        """The bound is the largest loss of rank, and the least is tried."""
        base, v = case.with_outputs if share == OUTPUTS else case.own, said.values
        modes = [p for p, _ in irreducible(base.system.A.charpoly())]
        every = subsets(base.m)
        bound = max(base.n - base.rank(s, p) for s in every for p in modes)
        count = numbers_of_relays if share == OUTPUTS else boundary_sizes
        sizes = ([v["c"] + more] * base.m for more in (0, -1))
        enough = [leaves(case.extended(each, share)) for each in sizes]
        right = v["k"] == bound and v["factor"] == max(count(_graph(case)))
        return right and enough == [True, False] and bound <= v["factor"] * v["c"]

    return decides


for start in ("bound-and-least", "allocate-bound-and-least"):
    judge(f"{start}-outputs-states")(_farthest(OUTPUTS))
    judge(f"{start}-states")(_farthest(STATES))


# Delays.


def _delayed(network: str, share: dict[str, str]) -> None:
    def fixed_polynomial(said: Said, case: Case) -> fmpq_poly:
        sizes = [said.values["k"]] * case.plant.m
        made = case.made({"construction": network, "dimensions": sizes, **share})
        return Facts(made).fixed_polynomial

    @judge(f"{network}-nothing-fixed")
    def _nothing(said: Said, case: Case) -> bool:
        return fixed_polynomial(said, case).degree() == 0

    @judge(f"{network}-fixed")
    def _some(said: Said, case: Case) -> bool:
        p = fixed_polynomial(said, case)
        return p.degree() > 0 and same_roots(said.values["p"], [q for q, _ in irreducible(p)])


_delayed("lifted", {"share": OUTPUTS})
_delayed("held", {})


# What `allocate` says.


def _request(case: Case) -> dict[str, Any]:
    return {key: case.asked.get(key) for key in ("bound", "costs", "upper")} | {
        "free": case.asked.get("free_assignability", False)
    }


def _scope(said: Said, case: Case, free: bool) -> bool:
    time, bound, assigned = said.values["scope"]
    return (time, bound, assigned) == (case.plant.time, case.asked.get("bound"), free)


def _rows(case: Case, said: Said | None = None) -> list[int]:
    """The sizes in the table, with those of one row in the place of what the table has."""
    rows = case.others("allocate-row", "allocate-row-bound")
    sizes = {row.values["agent"]: row.values["size"] for row in rows}
    if said is not None:
        sizes[said.values["agent"]] = said.values["size"]
    return [sizes[name] for name in case.plant.names]


@judge("allocate-least")
def _allocated(said: Said, case: Case) -> bool:
    """What the table gives is least, of what is asked."""
    v, asked = said.values, _request(case)
    cheap = "least" if all(c == 1 for c in asked["costs"] or [1]) else "cheapest"
    limits = "upper" if any(u is not None for u in asked["upper"] or []) else "none"
    told = (v["share"], v["price"], v["limits"]) == (case.asked["share"], cheap, limits)
    right = told and instant(said, case) and _scope(said, case, asked["free"])
    return right and least(case, _rows(case), case.asked["share"], asked)


@judge("allocate-within")
def _allocated_within(said: Said, case: Case) -> bool:
    """What is given suffices, at its cost, and nothing below the lower bound does."""
    v, asked, share = said.values, _request(case), case.asked["share"]
    sizes = _sizes(said, case)
    prices = [Fraction(c) for c in asked["costs"] or [1] * len(sizes)]
    limits = "upper" if any(u is not None for u in asked["upper"] or []) else "none"
    told = (v["share"], v["limits"]) == (share, limits)
    cost = sum((c * k for c, k in zip(prices, sizes, strict=True)), Fraction(0))
    right = told and instant(said, case) and _scope(said, case, asked["free"])
    priced = Fraction(v["lower"]) < Fraction(v["cost"]) == cost
    enough = leaves(case.extended(sizes, share), asked["bound"], asked["free"])
    return right and priced and enough and nothing_below(case, v["lower"], share, asked)


@judge("allocate-impossible")
def _allocated_none(said: Said, case: Case) -> bool:
    right = said.values["share"] == case.asked["share"]
    asked = _request(case)
    scope = _scope(said, case, asked["free"])
    return right and scope and none_suffice(case, case.asked["share"], asked)


@judge("allocate-row")
def _allocated_row(said: Said, case: Case) -> bool:
    return least(case, _rows(case, said), case.asked["share"], _request(case))


@judge("allocate-row-bound")
def _allocated_row_bound(said: Said, case: Case) -> bool:
    """The bound beside it suffices for every agent."""
    k = said.values["bound"]
    enough = leaves(case.extended([k] * case.plant.m, case.asked["share"]))
    return enough and k >= 0 and _bounded(case, k) and _allocated_row(said, case)


def _bounded(case: Case, k: int) -> bool:
    """Whether all rows of the table have the bound, and their sum is told."""
    rows = case.others("allocate-row-bound")
    total = case.others("allocate-total-bound")
    whole = all(row.values["bound"] == k * case.plant.m for row in total)
    return whole and all(row.values["bound"] == k for row in rows)


@judge("allocate-total")
def _allocated_total(said: Said, case: Case) -> bool:
    return bool(said.values["size"] == sum(_rows(case)))


@judge("allocate-total-bound")
def _allocated_total_bound(said: Said, case: Case) -> bool:
    rows = case.others("allocate-row-bound")
    bound = said.values["bound"] == sum(row.values["bound"] for row in rows)
    return _allocated_total(said, case) and bound


@judge("allocate-cost-proof", "allocate-nested-cost-proof")
def _allocated_cost(said: Said, case: Case) -> bool:
    """The cost of the table, and how the search proved it is not judged."""
    costs = [Fraction(c) for c in case.asked["costs"]]
    cost = sum((c * k for c, k in zip(costs, _rows(case), strict=True)), Fraction(0))
    return Fraction(said.values["cost"]) == cost


def _base(case: Case) -> Facts:
    return case.with_outputs if case.asked["share"] == OUTPUTS else case.own


def _received(said: Said, case: Case, s: Sequence[int]) -> bool:
    return set(case.indices(said.values["senders"])) == case.senders(s)


@judge("allocate-reason")
def _reason(said: Said, case: Case) -> bool:
    """n − rank P_s is the number of states that the set must get at a mode."""
    facts, v = _base(case), said.values
    s = case.indices(v["subset"])
    ranks = [facts.rank(s, p) for p, _ in irreducible(v["p"])]
    need = bool(ranks) and all(facts.n - rank == v["deficiency"] > 0 for rank in ranks)
    return need and _received(said, case, s)


@judge("allocate-reason-do-not-control")
def _reason_control(said: Said, case: Case) -> bool:
    facts, v = case.own, said.values
    parts = [p for p, _ in irreducible(v["p"])]
    lost_here = {str(p) for p in facts.uncontrolled()}
    need = all(facts.n - facts.rank([], p) == v["deficiency"] for p in parts)
    return bool(parts) and need and {str(p) for p in parts} <= lost_here


@judge("allocate-reason-do-not-observe")
def _reason_observe(said: Said, case: Case) -> bool:
    facts, v = case.own, said.values
    parts = [p for p, _ in irreducible(v["p"])]
    lost_here = {str(p) for p in facts.unobserved()}
    every = range(facts.m)
    need = all(facts.n - facts.rank(every, p) == v["deficiency"] for p in parts)
    return bool(parts) and need and {str(p) for p in parts} <= lost_here


@judge("allocate-reason-cut-off")
def _reason_cut_off(said: Said, case: Case) -> bool:
    """No channel outside the set acts on it, and it needs a state that others share."""
    facts = _base(case)
    s = case.indices(said.values["subset"])
    apart = bool(s) and not any(j not in s and i in s for j, i in facts.arcs)
    return apart and said.values["deficiency"] == 1 and _received(said, case, s)


# What `allocate --links` says.


def _price(case: Case) -> dict[tuple[str, str], Any]:
    return candidates(case)


def _added(case: Case) -> list[tuple[str, str]]:
    rows = case.others("allocate-link")
    return [(row.values["start"], row.values["end"]) for row in rows]


def _links_told(said: Said, case: Case) -> bool:
    sizes, share, _ = _carried(case)
    outputs = case.asked.get("dimensions") is None
    told, given = said.values["what"]
    right = told == ("outputs" if outputs else share)
    return right and (outputs or list(given) == sizes) and _scope(said, case, False)


@judge("allocate-links")
def _links_allocated(said: Said, case: Case) -> bool:
    prices = _price(case)
    usual = "least" if all(Fraction(price) == 1 for price in prices.values()) else "cheapest"
    right = said.values["price"] == usual and _links_told(said, case) and instant(said, case)
    return right and bool(_added(case)) and fewest(case, _added(case), prices)


@judge("allocate-no-links-needed")
def _links_not_needed(said: Said, case: Case) -> bool:
    sizes, share, bound = _carried(case)
    right = _links_told(said, case) and instant(said, case)
    return right and leaves(case.extended(sizes, share), bound)


@judge("allocate-no-links")
def _links_impossible(said: Said, case: Case) -> bool:
    sizes, share, bound = _carried(case)
    wider = linked(case, list(_price(case)))
    return _links_told(said, case) and not leaves(wider.extended(sizes, share), bound)


@judge("allocate-link")
def _link(said: Said, case: Case) -> bool:
    """A link of a cheapest set, at its price."""
    v, prices = said.values, _price(case)
    link = (v["start"], v["end"])
    right = link in prices and Fraction(prices[link]) == Fraction(v["cost"])
    others = [each for each in _added(case) if each != link]
    return right and fewest(case, [*others, link], prices)


@judge("allocate-links-total")
def _links_total(said: Said, case: Case) -> bool:
    cost = sum((Fraction(_price(case)[link]) for link in _added(case)), Fraction(0))
    return Fraction(said.values["cost"]) == cost
