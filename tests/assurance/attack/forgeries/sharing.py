"""Forgeries about what must be shared: other optima, with trees and gains that go with them."""

from __future__ import annotations

import itertools
import json
import math
import random
from collections.abc import Callable, Sequence
from fractions import Fraction

import mcexact
from mcexact.answer import protocol
from mcexact.model.system_file import read_system
from tests.oracle.certificates.constructions import arcs as with_arcs
from tests.oracle.certificates.constructions import augmented_outputs, extended, subject_of
from tests.oracle.certificates.reading import demand
from tests.oracle.certificates.systems import System
from tests.oracle.drawn.plants import Document, number

from ..mutators import copied
from .modes import cut_off, shown_edges
from .sequences import blocks
from .writing import PRIME, drawn_gains

Forged = Document | None
Cut = tuple[set[int], int]


def absence(rng: random.Random, system: System, *, connected: bool = False) -> Document:
    """Drawn gains, which prove that nothing is fixed if nothing is; or a sequence."""
    arcs = rng.choice((shown_edges(system), [])) if connected else None
    made = blocks(rng, system) if rng.random() < 0.4 else None
    if made is None:
        proof = {"gains": drawn_gains(rng, system), "allowed": []}
        return {**proof, "modulus": PRIME, "arcs": arcs}
    return {"blocks": made, "modulus": PRIME if connected else None, "arcs": arcs}


class Tree:
    """A branch tree that proves a cost from cuts, as far as they prove it.

    Parameters
    ----------
    name : callable
        The node that splits variable i at k.
    negative : bool
        Whether leaves may use a negative multiplier of a cut that is met with room to spare.
    """

    def __init__(
        self,
        costs: Sequence[Fraction],
        cuts: Sequence[Cut],
        value: Fraction | None,
        name: Callable[[int, int], Document],
        negative: bool,
    ) -> None:
        self.costs, self.cuts, self.value = costs, cuts, value
        self.name, self.negative = name, negative
        self.nodes: list[Document] = []

    def built(self, low: list[int], high: list[int | None]) -> list[Document]:
        """The nodes of a box, in preorder."""
        if len(self.nodes) > 60:
            return self.nodes
        for k, (support, least) in enumerate(self.cuts):
            tops = [high[i] for i in support]
            if None not in tops and sum(t or 0 for t in tops) < least:
                self.nodes.append({"violated": k})
                return self.nodes
        if self.value is not None:
            least_cost = sum((c * v for c, v in zip(self.costs, low, strict=True)), Fraction(0))
            if least_cost >= self.value:
                self.nodes.append({"multipliers": []})
                return self.nodes
            for k, (support, least) in enumerate(self.cuts):
                room = sum(low[i] for i in support) - least
                if self.negative and room > 0:
                    y = -math.ceil((self.value - least_cost) / room)
                    self.nodes.append({"multipliers": [[k, y]]})
                    return self.nodes
        self._split(low, high)
        return self.nodes

    def _split(self, low: list[int], high: list[int | None]) -> None:
        for i, (least, most) in enumerate(zip(low, high, strict=True)):
            if most is None or least < most:
                self.nodes.append(self.name(i, least))
                self.built(low, [*high[:i], least, *high[i + 1 :]])
                self.built([*low[:i], least + 1, *low[i + 1 :]], high)
                return
        self.nodes.append({"multipliers": []})


def _base(system: System, share: str) -> System:
    return augmented_outputs(system, {}) if share == "outputs+states" else system


def _upper(claim: Document, value: Fraction) -> list[int | None]:
    implied = [math.floor(value / Fraction(c)) for c in claim["costs"]]
    return [b if u is None else min(u, b) for u, b in zip(claim["upper"], implied, strict=True)]


def other_dimensions(rng: random.Random, document: Document) -> Forged:
    """More than is needed, as if nothing less sufficed; or less, or nothing of what there is."""
    system, claim = subject_of(document), document["claim"]
    share = claim["share"]
    cuts = false_cuts(rng, document, system)
    if rng.random() < 0.3:
        claim["free_assignability"] = not claim["free_assignability"]
    if rng.random() < 0.2:
        claim["upper"] = [rng.choice((None, 0, 1)) for _ in range(system.m)]
    sizes = optimum(claim, cuts, system.m) if rng.random() < 0.7 else None
    if sizes is None:
        old = claim["dimensions"] or [0] * system.m
        sizes = [max(d + rng.choice((-1, 0, 0, 1, 2)), 0) for d in old]
    costs = [Fraction(c) for c in claim["costs"]]
    value = sum((c * d for c, d in zip(costs, sizes, strict=True)), Fraction(0))
    if rng.random() < 0.15:
        value = max(value + rng.choice((-1, 1)), Fraction(0))
    claim |= {"feasible": True, "dimensions": sizes, "cost": number(value)}
    built = extended(system, {"share": share, "dimensions": sizes})
    document["witness"]["absence"] = absence(rng, built, connected=claim["free_assignability"])
    if claim["bound"] is not None and rng.random() < 0.5:
        claim["bound"] = None
    names = system.names
    tree = Tree(
        costs, cuts, value, lambda i, k: {"agent": names[i], "at_most": k}, rng.random() < 0.4
    )
    nodes = tree.built([0] * system.m, _upper(claim, value))
    document["witness"]["tree"] = rng.choice((nodes, nodes, nodes, [], [{"multipliers": []}]))
    return document


def other_nested(rng: random.Random, document: Document) -> Forged:
    """More than is needed, by sets that are not nested, or taken too often, or not at all."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    if not claim["feasible"]:
        return None
    cuts = false_cuts(rng, document, system) if rng.random() < 0.4 else []
    claim["free_assignability"] = rng.random() < 0.1
    sizes = [d + rng.choice((0, 0, 1, 2)) for d in claim["dimensions"]]
    costs = [Fraction(c) for c in claim["costs"]]
    value = sum((c * d for c, d in zip(costs, sizes, strict=True)), Fraction(0))
    claim |= {"dimensions": sizes, "cost": number(value)}
    built = extended(system, {"share": claim["share"], "dimensions": sizes})
    witness["absence"] = absence(rng, built, connected=claim["free_assignability"])
    count = len(witness["cuts"])
    weights = (1, 1, 1, 0, -1, 2, "1/2", 100)
    numbers = [k for k in range(count) for _ in range(rng.choice((0, 1, 1, 2)))]
    rng.shuffle(numbers)
    entries = [[k, rng.choice(weights)] for k in sorted(numbers) or [0]]
    if cuts and rng.random() < 0.3:
        entries.append([count, 100])
    witness["tree"] = [{"nested": entries}]
    return document


def false_cuts(rng: random.Random, document: Document, system: System) -> list[Cut]:
    """The cuts of the witness, some about another subset, or by a zero transfer of nothing."""
    claim, witness = document["claim"], document["witness"]
    base = _base(system, claim["share"])
    graph = system.graph()
    for cut in witness["cuts"]:
        if rng.random() < 0.3:
            cut["subset"] = [name for name in system.names if rng.random() < 0.5]
        if "deficiency" in cut and rng.random() < 0.3:
            cut["deficiency"] = max(cut["deficiency"] + rng.choice((-1, -1, 1)), 1)
    if system.m > 1 and rng.random() < 0.4:
        some = [i for i in range(system.m) if rng.random() < 0.5]
        s = rng.choice(([], list(range(system.m)), some, some))
        outside = [system.names[i] for i in range(system.m) if i not in s]
        zero = cut_off(system.n, outside, whole=rng.random() < 0.7)
        witness["cuts"].append({"subset": [system.names[i] for i in s], "zero": zero})
        claim["free_assignability"] = True
    demand(base.m == system.m, "the base has the channels of the plant")
    found = []
    for cut in witness["cuts"]:
        s = [system.names.index(name) for name in cut["subset"]]
        around = {j for i in s for j in graph[i]} - set(s)
        found.append((around, cut.get("deficiency", 1)))
    return found


def optimum(claim: Document, cuts: Sequence[Cut], m: int) -> list[int] | None:
    """The cheapest dimensions that the cuts allow."""
    most = max((d for _, d in cuts), default=0)
    ranges = [range(min(most, most if u is None else u) + 1) for u in claim["upper"]]
    costs = [Fraction(c) for c in claim["costs"]]
    fitting = [
        sizes
        for sizes in itertools.product(*ranges)
        if all(sum(sizes[i] for i in support) >= d for support, d in cuts)
    ]
    if not fitting:
        return None
    return list(
        min(fitting, key=lambda sizes: sum(c * d for c, d in zip(costs, sizes, strict=True)))
    )


def nothing_suffices(rng: random.Random, document: Document) -> Forged:
    """Not feasible, by a tree without leaves, by one that proves nothing, or by false cuts."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    key = "dimensions" if document["kind"] == "shared_dimensions" else "added"
    trees: list[list[Document]] = [[], [{"multipliers": []}]]
    trees += [[{"violated": 0}]] * 2
    if key == "dimensions" and rng.random() < 0.6:
        cuts = false_cuts(rng, document, system)
        names = system.names
        tree = Tree(
            [Fraction(c) for c in claim["costs"]],
            cuts,
            None,
            lambda i, k: {"agent": names[i], "at_most": k},
            False,
        )
        trees += [tree.built([0] * system.m, list(claim["upper"]))] * 3
    claim |= {"feasible": False, "cost": None}
    claim[key] = None
    witness |= {"absence": None, "tree": rng.choice(trees)}
    if rng.random() < 0.1:
        claim["cost"] = 0
    return document


def beyond_bounds(rng: random.Random, document: Document) -> Forged:
    """Dimensions above an upper bound, with everything else as it was."""
    claim = document["claim"]
    large = [i for i, d in enumerate(claim["dimensions"] or []) if d]
    if not large:
        return None
    i = rng.choice(large)
    claim["upper"][i] = claim["dimensions"][i] - 1
    return document


def unbounded_leaf(rng: random.Random, document: Document) -> Forged:
    """Nothing suffices, because upper bounds that are none are too small for a cut."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    if not witness["cuts"]:
        return None
    claim |= {"feasible": False, "dimensions": None, "cost": None, "upper": [None] * system.m}
    witness |= {"absence": None, "tree": [{"violated": 0}]}
    return document


def free_cost(rng: random.Random, document: Document) -> Forged:
    """Costs of which some are 0 or negative."""
    key = "costs" if document["kind"] == "shared_dimensions" else "candidates"
    entries = document["claim"][key]
    if not entries:
        return None
    k = rng.randrange(len(entries))
    value = rng.choice((0, -1, "-1/2"))
    if key == "costs":
        entries[k] = value
    else:
        entries[k][2] = value
    return document


def other_common_dimension(rng: random.Random, document: Document) -> Forged:
    """One dimension more than suffices, or none, with the cut that there is."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    k = max((claim["dimension"] or 0) + rng.choice((1, 1, 2, -1)), 0)
    if claim["feasible"] and rng.random() < 0.3:
        claim |= {"feasible": False, "dimension": None}
        witness["absence"] = None
        return document
    claim |= {"feasible": True, "dimension": k}
    step = {"share": claim["share"], "dimensions": [k] * system.m}
    witness["absence"] = absence(rng, extended(system, step))
    if k == 0 or rng.random() < 0.1:
        witness["cut"] = None
    return document


def another_cut(rng: random.Random, document: Document) -> Forged:
    """The cut of a common dimension taken for one about other agents."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    cut = witness["cut"]
    if cut is None:
        return None
    cut["subset"] = [name for name in system.names if rng.random() < 0.5]
    s = {system.names.index(name) for name in cut["subset"]}
    around = {j for i in s for j in system.graph()[i]} - s
    if not around:
        claim |= {"feasible": False, "dimension": None}
        witness["absence"] = None
        return document
    k = -(-cut["deficiency"] // len(around))
    claim |= {"feasible": True, "dimension": k}
    step = {"share": claim["share"], "dimensions": [k] * system.m}
    witness["absence"] = absence(rng, extended(system, step))
    return document


def slack_cut(rng: random.Random, document: Document) -> Forged:
    """Two integrators that agent 1 drives and agent 2 measures, and a weaker cut beside the cut.

    A negative multiplier of a cut that is met with room to spare would prove any cost.
    """
    names = ["1", "2"]
    ports = ([[1, 0], [0, 1]], {"shape": [0, 2], "entries": []}), ([[], []], [[1, 0], [0, 1]])
    channels = [{"name": i, "B": B, "C": C} for i, (B, C) in zip(names, ports, strict=True)]
    plant = {
        "time": document["system"]["time"],
        "A": [[0, 0], [0, 0]],
        "channels": channels,
        "neighbors": {"1": ["2"], "2": []},
    }
    text = json.dumps({"format": "mcexact-system/1", **plant})
    found = mcexact.sharing.minimal_shared_dimensions(read_system(text), None, "states")
    made: Document = copied(protocol.document(found))
    system, claim, witness = subject_of(made), made["claim"], made["witness"]
    cuts = witness["cuts"]
    if not cuts or max(cut["deficiency"] for cut in cuts) < 2:
        return None
    cuts += [{**cut, "deficiency": cut["deficiency"] - 1} for cut in copied(cuts)]
    cuts[:] = [cut for cut in cuts if cut["deficiency"]]
    sizes = [d + rng.choice((0, 1)) for d in claim["dimensions"]]
    claim |= {"dimensions": sizes, "cost": sum(sizes)}
    step = {"share": "states", "dimensions": sizes}
    witness["absence"] = absence(rng, extended(system, step))
    needed = []
    for cut in cuts:
        s = {names.index(name) for name in cut["subset"]}
        around = {j for i in s for j in system.graph()[i]} - s
        needed.append((around, cut["deficiency"]))
    value = Fraction(sum(sizes))
    tree = Tree(
        [Fraction(1)] * 2, needed, value, lambda i, k: {"agent": names[i], "at_most": k}, True
    )
    witness["tree"] = tree.built([0, 0], _upper(claim, value))
    return made


def other_links(rng: random.Random, document: Document) -> Forged:
    """Links that are no candidates, or cost something else, or are more than needed."""
    system, claim = subject_of(document), document["claim"]
    names = list(system.names)
    heard = system.neighborhoods or tuple((i,) for i in range(system.m))
    free = [(j, i) for j in range(system.m) for i in range(system.m) if j not in heard[i]]
    added = [edge for edge in free if rng.random() < 0.7]
    if rng.random() < 0.5:
        claim["candidates"] = [c for c in claim["candidates"] if rng.random() < 0.5]
    prices = {(names.index(j), names.index(i)): Fraction(c) for j, i, c in claim["candidates"]}
    value = sum((prices.get(edge, Fraction(0)) for edge in added), Fraction(0))
    if rng.random() < 0.4:
        value = Fraction(rng.choice((0, 1)))
    claim |= {"feasible": True, "added": [[names[j], names[i]] for j, i in added]}
    claim["cost"] = number(value)
    if added and rng.random() < 0.15:
        claim["added"].append(claim["added"][-1])
    wider = with_arcs(system, {"added": [[names[j], names[i]] for j, i in added]})
    if claim["share"] == "outputs":
        built = augmented_outputs(wider, {})
    else:
        built = extended(wider, {"share": claim["share"], "dimensions": claim["dimensions"]})
    document["witness"]["absence"] = absence(rng, built)
    if rng.random() < 0.5:
        document["witness"]["cuts"] = []
    claim["bound"] = claim["bound"] if rng.random() < 0.5 else None
    tree = _links_tree(rng, document, names, value)
    document["witness"]["tree"] = tree
    return document


def _links_tree(
    rng: random.Random, document: Document, names: list[str], value: Fraction
) -> list[Document]:
    """A tree by cuts that every candidate is taken to break."""
    candidates = document["claim"]["candidates"]
    costs = [Fraction(c) for _, _, c in candidates]
    every = set(range(len(candidates)))
    cuts = [(every, 1) for _ in document["witness"]["cuts"]]
    labels = [[j, i] for j, i, _ in candidates]
    tree = Tree(costs, cuts, value, lambda i, k: {"arc": labels[i], "at_most": k}, False)
    nodes = tree.built([0] * len(costs), [1] * len(costs))
    return rng.choice((nodes, nodes, [], [{"multipliers": []}]))


def other_bound(rng: random.Random, document: Document) -> Forged:
    """Another region, under which other modes count."""
    document["claim"]["bound"] = rng.choice((None, 0, 1, "1/2", "1/4", 2, -1))
    return document


DIMENSIONS = (
    other_dimensions, other_dimensions, other_dimensions, nothing_suffices, free_cost, other_bound,
    slack_cut, unbounded_leaf, beyond_bounds, other_nested, other_nested,
)  # fmt: skip
COMMON = (other_common_dimension, another_cut)
LINKS = (other_links, other_links, nothing_suffices, free_cost, other_bound)
