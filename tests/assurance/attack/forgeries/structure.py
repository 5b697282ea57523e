"""Forgeries about controllability, transfer, zeros and set-points."""

from __future__ import annotations

import json
import random
from typing import Any

from flint import fmpq, fmpq_mat

import mcexact
from mcexact.answer import protocol
from mcexact.model.system_file import read_system
from tests.oracle.certificates import algebra
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.modes import transfer_edges
from tests.oracle.certificates.reading import polynomial, positions
from tests.oracle.certificates.systems import System
from tests.oracle.drawn.plants import Document, rows_of

from ..mutators import copied
from .sequences import blocks, picked, sequence
from .writing import (
    PRIME,
    coefficients,
    left_kernel,
    names_of,
    unit,
    written,
    zeros,
)

Forged = Document | None


def smaller_dimension(rng: random.Random, document: Document) -> Forged:
    """A subspace that B_T reaches at once is taken for the controllable one."""
    system, claim = subject_of(document), document["claim"]
    B = system.inputs(positions(claim["channels"], system.names))
    W, pivots = left_kernel(B)
    if rng.random() < 0.5 and W.nrows():
        # any rows that annihilate B, not only all of them
        W, pivots = fmpq_mat(1, system.n, W.tolist()[0]), pivots[:1]
    d = system.n - W.nrows()
    Z = [[row[k] for k in pivots] for row in (W * system.A).tolist()]
    claim["dimension"], claim["controllable"] = d, d == system.n
    size = len(pivots)
    chi = fmpq_mat(size, size, [v for row in Z for v in row]).charpoly()
    claim["uncontrollable_polynomial"] = coefficients(chi)
    document["witness"] |= {"annihilator": written(W), "pivots": pivots}
    return document


def larger_dimension(rng: random.Random, document: Document) -> Forged:
    """Everything is said to be controllable, and nothing has to be annihilated."""
    n = subject_of(document).n
    document["claim"] |= {
        "dimension": n,
        "controllable": True,
        "uncontrollable_polynomial": [1],
    }
    document["witness"] |= {"annihilator": {"denominator": 1, "entries": []}, "pivots": []}
    return document


def reached_by_blocks(rng: random.Random, document: Document) -> Forged:
    """More said to be controllable than is, by blocks of too many channels or of other outputs."""
    system, claim = subject_of(document), document["claim"]
    T = positions(claim["channels"], system.names)
    wrong = rng.random() < 0.3
    acting = list(range(system.m)) if wrong else T
    measured = None
    if rng.random() < 0.6:
        measured = [[a for a in range(system.n) if rng.random() < 0.7] for _ in T]
    part = _measuring(system, acting, None if wrong else measured)
    made = blocks(rng, part)
    if made is None:
        return None
    if rng.random() < 0.5:
        larger_dimension(rng, document)
    W = {key: document["witness"][key] for key in ("annihilator", "pivots")}
    document["witness"] = {"blocks": made, "measured": measured, **W}
    return document


def _measuring(system: System, acting: list[int], measured: list[list[int]] | None) -> System:
    """Some channels, with outputs of their own or with states that they measure."""
    C = [system.C[i] for i in acting]
    if measured is not None:
        states = range(system.n)
        C = [
            fmpq_mat(len(part), system.n, [int(a == b) for a in part for b in states])
            for part in measured
        ]
    named, B = [system.names[i] for i in acting], [system.B[i] for i in acting]
    return System(system.time, system.A, tuple(named), tuple(B), tuple(C))


def ranks_by_false_relations(rng: random.Random, document: Document) -> Forged:
    """Ranks as they follow from relations that do not hold, or of which one stands twice."""
    system, claim = subject_of(document), document["claim"]
    B = system.inputs(positions(claim["channels"], system.names))
    p = B.ncols()
    if not p or not system.n:
        return None
    columns = _true_relations(rng, system.A, B)
    for _ in range(rng.randint(0 if columns else 1, 2)):
        degree = rng.randint(0, 2)
        columns.append([[rng.choice((0, 0, 1, -1)) for _ in range(p)] for _ in range(degree + 1)])
    if rng.random() < 0.5:
        columns.append(rng.choice(columns))
    own, kept = [], []
    for column in sorted(columns, key=len)[:p]:
        if rng.random() < 0.2:
            column = [*column, [0] * p]
        last = next((row for row in reversed(column) if any(row)), column[-1])
        choices = [j for j in range(p) if last[j]] or list(range(p))
        own.append(rng.choice([j for j in choices if j not in own] or choices))
        kept.append(column)
    length = max(map(len, kept))
    layers = [
        [[c[k][j] if k < len(c) else 0 for c in kept] for j in range(p)] for k in range(length)
    ]
    W, pivots = (unit(0), []) if rng.random() < 0.6 else _some_rows(rng, system.n)
    ranks = _implied(system.n - len(pivots), p, [len(column) - 1 for column in kept])
    _restated(claim, ranks, system.n)
    document["witness"] = {
        "modulus": document["witness"]["modulus"],
        "annihilator": W,
        "pivots": pivots,
        "relations": {"denominator": 1, "coefficients": layers},
        "inputs": own,
    }
    return document


def _true_relations(rng: random.Random, A: fmpq_mat, B: fmpq_mat) -> list[list[list[int]]]:
    """Relations of one degree, by the kernel of the first blocks."""
    p, degree = B.ncols(), rng.randint(0, 2)
    blocks = [B]
    for _ in range(degree):
        blocks.append(A * blocks[-1])
    rows = [[v for M in blocks for v in M.tolist()[i]] for i in range(A.nrows())]
    K = fmpq_mat(len(rows), p * (degree + 1), [v for row in rows for v in row])
    kernel, _ = left_kernel(K.transpose())
    made = []
    for row in written(kernel)["entries"]:
        made.append([row[k * p : (k + 1) * p] for k in range(degree + 1)])
    return rng.sample(made, min(len(made), 2))


def _some_rows(rng: random.Random, n: int) -> tuple[Document, list[int]]:
    """Rows with an identity matrix, which annihilate nothing."""
    pivots = sorted(rng.sample(range(n), rng.randint(1, n)))
    rows = [[rng.choice((0, 1, -1)) for _ in range(n)] for _ in pivots]
    for i, row in enumerate(rows):
        for j, column in enumerate(pivots):
            row[column] = int(i == j)
    return {"denominator": 1, "entries": rows}, pivots


def _implied(most: int, p: int, degrees: list[int]) -> list[int]:
    """The largest ranks that the rule allows with relations of these degrees."""
    ranks, step = [0], p
    while True:
        k = len(ranks) - 1
        step = min(step, p - sum(degree <= k for degree in degrees))
        following = min(most, ranks[-1] + step)
        if following <= ranks[-1]:
            return ranks[1:]
        ranks, step = [*ranks, following], following - ranks[-1]


def ranks_cut_short(rng: random.Random, document: Document) -> Forged:
    """Ranks that grow further, with rows of zeros as annihilators."""
    claim, n = document["claim"], subject_of(document).n
    ranks = claim["ranks"][: rng.randint(0, len(claim["ranks"]))]
    if ranks and rng.random() < 0.5:
        ranks[-1] = max(ranks[-1] - 1, 1)
    _restated(claim, ranks, n)
    rows = n - (ranks[0] if ranks else 0)
    document["witness"] |= {"annihilator": zeros(rows, n), "pivots": list(range(rows))}
    return document


def ranks_too_large(rng: random.Random, document: Document) -> Forged:
    """A rank more than there is, as if the plant were generic."""
    claim, n = document["claim"], subject_of(document).n
    ranks = claim["ranks"] + [n] if rng.random() < 0.5 else [*claim["ranks"][:-1], n]
    _restated(claim, ranks, n)
    p = sum(len(channel["B"][0]) for channel in document["system"]["channels"] if channel["B"])
    nothing = {"denominator": 1, "coefficients": [[[] for _ in range(p)]]}
    if len(document["witness"].get("relations", {"coefficients": [[]]})["coefficients"][0]) == p:
        document["witness"] |= {"relations": nothing, "inputs": []}
    document["witness"] |= {"annihilator": {"denominator": 1, "entries": []}, "pivots": []}
    return document


def _restated(claim: Document, ranks: list[int], n: int) -> None:
    steps = [b - a for a, b in zip([0, *ranks], ranks, strict=False)]
    claim["ranks"], claim["index"] = (
        ranks,
        len(ranks) if [*ranks, 0][-1 - bool(ranks)] == n else None,
    )
    if ranks and ranks[-1] == n:
        claim["index"] = len(ranks)
    elif ranks or n:
        claim["index"] = None
    claim["indices"] = [sum(s > i for s in steps) for i in range(max([*steps, 0]))]


def missing_edge(rng: random.Random, document: Document) -> Forged:
    """An edge is denied: the zero transfer from everything by everything."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    if not claim["arcs"]:
        return None
    k = rng.randrange(len(claim["arcs"]))
    source, _ = claim["arcs"].pop(k)
    witness["powers"].pop(k)
    everything = {"from": [source], "X": unit(system.n), "pivots": list(range(system.n))}
    nothing = {"from": [source], "X": zeros(system.n, 0), "pivots": []}
    witness["zeros"].append(rng.choice((everything, nothing)))
    _connected_again(document, system.names)
    return document


def unsorted_edges(rng: random.Random, document: Document) -> Forged:
    """Two edges exchanged, with the powers that show them."""
    arcs, powers = document["claim"]["arcs"], document["witness"]["powers"]
    if len(arcs) < 2:
        return None
    i, j = rng.sample(range(len(arcs)), 2)
    for entries in (arcs, powers):
        entries[i], entries[j] = entries[j], entries[i]
    return document


def extra_edge(rng: random.Random, document: Document) -> Forged:
    """An edge that is not there."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    names = list(system.names)
    free = [[j, i] for j in names for i in names if [j, i] not in claim["arcs"]]
    if not free:
        return None
    pairs = [
        *zip(claim["arcs"], witness["powers"], strict=True),
        (rng.choice(free), rng.randint(0, 3)),
    ]
    pairs.sort(key=lambda pair: [names.index(name) for name in pair[0]])
    claim["arcs"], witness["powers"] = ([pair[k] for pair in pairs] for k in (0, 1))
    _connected_again(document, system.names)
    return document


def _connected_again(document: Document, names: Any) -> None:
    from tests.oracle.certificates.modes import components

    order = list(names)
    arcs = [(order.index(j), order.index(i)) for j, i in document["claim"]["arcs"]]
    parts = components(len(order), arcs)
    document["claim"]["components"] = [[order[i] for i in part] for part in parts]
    document["claim"]["strongly_connected"] = len(parts) <= 1


def other_degree(rng: random.Random, document: Document) -> Forged:
    """Another McMillan degree, by rows, columns, states or a sequence that do not show it."""
    system, claim = subject_of(document), document["claim"]
    if not claim["blocks"] or "degrees" not in document["witness"]:
        return None
    k = rng.randrange(len(claim["blocks"]))
    shown = document["witness"]["degrees"][k]
    c = positions(claim["blocks"][k]["channels"], system.names)
    A, B, C = system.A, system.inputs(c), system.outputs(c)
    states = shown["states"]
    if rng.random() < 0.4:
        states = [a for a in range(system.n) if rng.random() < 0.6]
        states = None if rng.random() < 0.3 else states
    if states is not None:
        A, B, C = picked(A, states, states), picked(B, states, None), picked(C, None, states)
    n = A.nrows()
    proof, degree = shown["sequence"], claim["blocks"][k]["dimension"]
    if rng.random() < 0.6:
        merged = System(system.time, A, ("1",), (B,), (C,))
        proof = sequence(rng, merged) if rng.random() < 0.7 else None
        degree = len(proof["recurrence"]) - 1 if proof else 0
    W, pivots = left_kernel(B) if rng.random() < 0.5 else (fmpq_mat(0, n), [])
    U, places = left_kernel(C.transpose()) if rng.random() < 0.5 else (fmpq_mat(0, n), [])
    parts = [(written(W)["entries"], pivots), (written(U)["entries"], places)]
    denominators = [written(W)["denominator"], written(U)["denominator"]]
    while sum(len(rows) for rows, _ in parts) > max(n - degree, 0):
        rows, at = rng.choice([part for part in parts if part[0]])
        rows.pop()
        at.pop()
    missing = n - degree - sum(len(rows) for rows, _ in parts)
    if missing > 0 and rng.random() < 0.8:
        side = rng.randrange(2)
        free = [a for a in range(n) if a not in parts[side][1]]
        chosen = sorted([*parts[side][1], *rng.sample(free, min(missing, len(free)))])
        rows = [[int(a == b) for b in range(n)] for a in chosen]
        parts[side], denominators[side] = (rows, chosen), 1
    claim["fixed_degree"] += claim["blocks"][k]["dimension"] - degree
    claim["blocks"][k]["dimension"] = degree
    document["witness"]["degrees"][k] = {
        "states": states,
        "annihilator": {"denominator": denominators[0], "entries": parts[0][0]},
        "pivots": parts[0][1],
        "kernel": {"denominator": denominators[1], "entries": parts[1][0]},
        "kernel_pivots": parts[1][1],
        "sequence": proof,
    }
    return document


def _by_realizations(document: Document) -> Document:
    """The witness of an earlier version for a certificate; the minimal realizations are true."""
    witness = document["witness"]
    if "realizations" in witness:
        return witness
    system, shown = subject_of(document), []
    for block in document["claim"]["blocks"]:
        c = positions(block["channels"], system.names)
        X, pivots = _controlled(system.A, system.inputs(c))
        inner = picked(system.A * X, pivots, None)
        seen = (system.outputs(c) * X).transpose()
        V, columns = _controlled(inner.transpose(), seen)
        W = {"W": written(V.transpose()), "columns": columns}
        shown.append({"X": written(X), "pivots": pivots, **W})
    graph = _whole_graph(document)
    document["witness"] = {"modulus": PRIME, "transfer_graph": graph, "realizations": shown}
    made: Document = document["witness"]
    return made


def _controlled(A: fmpq_mat, B: fmpq_mat) -> tuple[fmpq_mat, list[int]]:
    """A basis of the controllable subspace as columns, with an identity matrix in some rows."""
    n = A.nrows()
    K = algebra.krylov(A, B, n)
    reduced, rank = K.transpose().rref()
    rows = reduced.tolist()[:rank]
    pivots = [next(j for j in range(n) if row[j] != 0) for row in rows]
    return fmpq_mat(rank, n, [v for row in rows for v in row]).transpose(), pivots


def _whole_graph(document: Document) -> Document:
    """Claim and witness of the whole transfer graph, as earlier versions had."""
    witness = document["witness"]
    if "transfer_graph" in witness:
        return dict(witness["transfer_graph"])
    system = subject_of(document)

    def texts(M: fmpq_mat) -> list[list[str]]:
        return [[str(v) for v in row] for row in M.tolist()]

    found = mcexact.transfer_graph(
        mcexact.MultiChannelSystem(
            texts(system.A),
            [texts(B) for B in system.B],
            [texts(C) for C in system.C],
            names=system.names,
        )
    )
    graph = json.loads(protocol.encode(found))
    return {"claim": graph["claim"], "witness": graph["witness"]}


def by_the_whole_graph(rng: random.Random, document: Document) -> Forged:
    """Realizations beside a transfer graph, as earlier versions wrote, and other edges."""
    graph = _by_realizations(document)["transfer_graph"]
    if rng.random() < 0.3:
        return document
    change = rng.choice((missing_edge, extra_edge))
    inner = {**document, **copied(graph)}
    made = change(rng, inner)
    if made is None:
        return None
    document["witness"]["transfer_graph"] = {key: made[key] for key in ("claim", "witness")}
    return _of_components(document, made["claim"]["components"], "realizations")


def other_components(rng: random.Random, document: Document) -> Forged:
    """Components in another order, joined, or taken apart, with edges and zero transfers left."""
    witness, blocks = document["witness"], document["claim"]["blocks"]
    if "components" not in witness:
        return None
    shown = witness["components"]
    way = rng.randrange(5)
    if way == 0:
        rng.shuffle(shown["order"])
    elif way == 1 and shown["order"]:
        shown["order"][rng.randrange(len(blocks))] = rng.randint(0, len(blocks))
    elif way == 2 and shown["arcs"]:
        shown["arcs"].pop(rng.randrange(len(shown["arcs"])))
    elif way == 3 and shown["zeros"]:
        shown["zeros"].pop(rng.randrange(len(shown["zeros"])))
    else:
        names = list(subject_of(document).names)
        listed = [block["channels"] for block in blocks]
        if rng.random() < 0.5 and len(listed) > 1:
            i, j = sorted(rng.sample(range(len(listed)), 2))
            listed[i] = [name for name in names if name in (*listed[i], *listed.pop(j))]
        else:
            part = rng.choice([part for part in listed if len(part) > 1] or [None])
            if part is None:
                return None
            listed.append([part.pop(rng.randrange(len(part)))])
        shown["order"] = rng.sample(range(len(listed)), len(listed))
        place = {name: k for k, part in enumerate(listed) for name in part}
        shown["arcs"] = [a for a in shown["arcs"] if place[a[0]] == place[a[1]]]
        return _of_components(document, sorted(listed, key=lambda p: names.index(p[0])))
    return document


_NONE = {"denominator": 1, "entries": []}
_DEGREE_0: dict[str, Document] = {
    "degrees": {
        "states": [],
        "annihilator": _NONE,
        "pivots": [],
        "kernel": _NONE,
        "kernel_pivots": [],
        "sequence": None,
    },
    "realizations": {"X": _NONE, "pivots": [], "W": _NONE, "columns": []},
}


def _of_components(document: Document, parts: list[list[str]], key: str = "degrees") -> Forged:
    """The claim with these components, and evidence of the degree 0 for those that are new."""
    claim, witness = document["claim"], document["witness"]
    known = {
        tuple(block["channels"]): (block["dimension"], degree)
        for block, degree in zip(claim["blocks"], witness[key], strict=True)
    }
    degrees = [known.get(tuple(part), (0, copied(_DEGREE_0[key]))) for part in parts]
    total = claim["fixed_degree"] + sum(block["dimension"] for block in claim["blocks"])
    claim["blocks"] = [
        {"channels": part, "dimension": d} for part, (d, _) in zip(parts, degrees, strict=True)
    ]
    claim["fixed_degree"] = total - sum(d for d, _ in degrees)
    witness[key] = [degree for _, degree in degrees]
    return document


def smaller_realization(rng: random.Random, document: Document) -> Forged:
    """A McMillan degree less, with a quotient that is none."""
    claim, witness = document["claim"], _by_realizations(document)
    large = [k for k, block in enumerate(claim["blocks"]) if block["dimension"]]
    if not large:
        return None
    k = rng.choice(large)
    shown = witness["realizations"][k]
    width = len(shown["pivots"])
    d = rng.randrange(claim["blocks"][k]["dimension"])
    columns = sorted(rng.sample(range(width), d))
    rows = [[rng.choice((0, 1, -1, 2)) for _ in range(width)] for _ in range(d)]
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            row[column] = int(i == j)
    claim["fixed_degree"] += claim["blocks"][k]["dimension"] - d
    claim["blocks"][k]["dimension"] = d
    shown |= {"W": {"denominator": 1, "entries": rows}, "columns": columns}
    return document


def outputs_alone(rng: random.Random, document: Document) -> Forged:
    """A quotient by what the outputs do not show at once."""
    system, claim = subject_of(document), document["claim"]
    if not claim["blocks"]:
        return None
    k = rng.randrange(len(claim["blocks"]))
    shown = _by_realizations(document)["realizations"][k]
    rows, width = shown["X"], len(shown["pivots"])
    entries = [fmpq(v, rows["denominator"]) for row in rows["entries"] for v in row]
    c = positions(claim["blocks"][k]["channels"], system.names)
    reduced, d = (system.outputs(c) * fmpq_mat(system.n, width, entries)).rref()
    lines = reduced.tolist()[:d]
    W = fmpq_mat(d, width, [v for line in lines for v in line])
    columns = [next(j for j in range(width) if line[j] != 0) for line in lines]
    claim["fixed_degree"] += claim["blocks"][k]["dimension"] - d
    claim["blocks"][k]["dimension"] = d
    shown |= {"W": written(W), "columns": columns}
    return document


def larger_realization(rng: random.Random, document: Document) -> Forged:
    """The whole reachable space as a realization, minimal or not."""
    claim, witness = document["claim"], _by_realizations(document)
    if not claim["blocks"]:
        return None
    k = rng.randrange(len(claim["blocks"]))
    shown = witness["realizations"][k]
    d = len(shown["pivots"])
    claim["fixed_degree"] += claim["blocks"][k]["dimension"] - d
    claim["blocks"][k]["dimension"] = d
    shown |= {"W": unit(d), "columns": list(range(d))}
    return document


def whole_space(rng: random.Random, document: Document) -> Forged:
    """Every state in the realization of one component."""
    system, claim = subject_of(document), document["claim"]
    if not claim["blocks"]:
        return None
    k, n = rng.randrange(len(claim["blocks"])), system.n
    claim["fixed_degree"] += claim["blocks"][k]["dimension"] - n
    claim["blocks"][k]["dimension"] = n
    _by_realizations(document)["realizations"][k] = {
        "X": unit(n), "pivots": list(range(n)), "W": unit(n), "columns": list(range(n)),
    }  # fmt: skip
    return document


def no_zeros(rng: random.Random, document: Document) -> Forged:
    """A pencil without zeros of any normal rank, with matrices of zeros as bases."""
    system, claim = subject_of(document), document["claim"]
    s = positions(claim["subset"], system.names)
    n = system.n
    p = sum(system.B[i].ncols() for i in range(system.m) if i not in s)
    q = sum(system.C[i].nrows() for i in s)
    k = n + rng.randint(0, p)
    shapes = {
        "X": (n, 0), "F": (p, 0), "A1": (0, 0), "S": (p, n + p - k), "B1": (0, n + p - k),
        "L": (n, n), "G": (n, q), "N": (n, n),
    }  # fmt: skip
    claim |= {
        "normal_rank": k,
        "invariant_polynomials": [],
        "remnant": [1],
        "transfer_zero": k == n,
        "complete": k > n,
    }
    matrices = {key: zeros(*shape) for key, shape in shapes.items()}
    document["witness"] |= {"reachable": 0, **matrices}
    return document


def split_zeros(rng: random.Random, document: Document) -> Forged:
    """An invariant polynomial in two coprime factors, neither of which divides the other."""
    claim, witness = document["claim"], document["witness"]
    f = [polynomial(g) for g in claim["invariant_polynomials"]]
    chosen = [k for k, g in enumerate(f) if len(algebra.irreducible_factors(g)) > 1]
    if not chosen:
        return None
    k = rng.choice(chosen)
    parts = [g**e for g, e in algebra.irreducible_factors(f[k])]
    left, right = parts[0], f[k] / parts[0]
    left, right = algebra.monic(left), algebra.monic(right)
    d, K = f[k].degree(), algebra.companion(f[k])
    columns = []
    for cofactor, part in ((right, left), (left, right)):
        v = fmpq_mat(d, 1, [cofactor[i] for i in range(d)])
        for _ in range(part.degree()):
            columns.append([row[0] for row in v.tolist()])
            v = K * v
    T = fmpq_mat(d, d, [column[i] for i in range(d) for column in columns])
    start = witness["reachable"] + sum(g.degree() for g in f[:k])
    for key in ("X", "F", "A1"):
        _columns_changed(witness, key, start, T)
    f[k : k + 1] = [left, right]
    claim["invariant_polynomials"] = [coefficients(g) for g in f]
    free = claim["normal_rank"] - subject_of(document).n
    remnant = algebra.ONE
    for g in f[: max(len(f) - free, 0)]:
        remnant *= g
    claim["remnant"] = coefficients(remnant)
    claim["complete"] = free > 0 and remnant == 1
    return document


def _columns_changed(witness: Document, key: str, start: int, T: fmpq_mat) -> None:
    """The columns from ``start`` on times T."""
    value = witness[key]
    rows, d = [[fmpq(v, value["denominator"]) for v in row] for row in value["entries"]], T.nrows()
    if not rows:
        return
    block = fmpq_mat(len(rows), d, [v for row in rows for v in row[start : start + d]]) * T
    made = [
        [*row[:start], *new, *row[start + d :]]
        for row, new in zip(rows, block.tolist(), strict=True)
    ]
    witness[key] = written(fmpq_mat(len(made), len(made[0]), [v for row in made for v in row]))


def improper_subset(rng: random.Random, document: Document) -> Forged:
    """The pencil of all channels or of none, as that of a set whose complement has no ports."""
    plant = document["system"]
    if document["subject"] or len(plant["channels"]) < 2:
        return None
    inside = document["claim"]["subset"]
    all_of_them = rng.random() < 0.5
    others = [c for c in plant["channels"] if (c["name"] in inside) != all_of_them]
    names = [c["name"] for c in others]
    for channel in others:
        n = len(rows_of(plant["A"]))
        channel["B"] = [[] for _ in range(n)]
        channel["C"] = {"shape": [0, n], "entries": []} if n else []
    text = json.dumps({"format": "mcexact-system/1", **plant})
    made = protocol.document(mcexact.questions.complementary_subsystem(read_system(text), inside))
    plant["channels"] = [c for c in plant["channels"] if c["name"] not in names]
    plant.pop("neighbors", None)
    plant.pop("delays", None)
    document |= copied({"claim": made["claim"], "witness": made["witness"]})
    document["claim"]["subset"] = [name for name in inside if name not in names]
    return document


def other_rank(rng: random.Random, document: Document) -> Forged:
    """Another rank at 0, with rows that fit in number alone."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    full = system.n + sum(C.nrows() for C in system.C)
    r = rng.randint(0, full)
    claim |= {"rank": r, "solvable": r == full, "invariant_zero": None}
    pivots = sorted(rng.sample(range(full), full - r))
    rows = [[int(j == k) for j in range(full)] for k in pivots]
    witness |= {"left": {"denominator": 1, "entries": rows}, "pivots": pivots}
    witness |= {"point": None, "normal": None}
    if r < full:
        _zero_or_not(rng, document, full)
    return document


def other_zero(rng: random.Random, document: Document) -> Forged:
    """An invariant zero denied by a row that annihilates nothing, or claimed at any point."""
    system, claim = subject_of(document), document["claim"]
    full = system.n + sum(C.nrows() for C in system.C)
    if claim["solvable"]:
        if rng.random() < 0.5:
            claim["solvable"] = False
        _zero_or_not(rng, document, full)
        return document
    if rng.random() < 0.3:
        claim["solvable"], claim["invariant_zero"] = True, None
        document["witness"] |= {"point": None, "normal": None}
        return document
    _zero_or_not(rng, document, full, zero=False if claim["invariant_zero"] else None)
    return document


def _zero_or_not(
    rng: random.Random, document: Document, full: int, zero: bool | None = None
) -> None:
    if zero is None:
        zero = rng.random() < 0.5
    document["claim"]["invariant_zero"] = zero
    row = {"denominator": 1, "coefficients": [[[rng.choice((0, 0, 1)) for _ in range(full)]]]}
    if rng.random() < 0.5:
        row["coefficients"] = [[[0] * full]]
    witness = (
        {"point": rng.randint(0, 50), "normal": None} if zero else {"point": None, "normal": row}
    )
    document["witness"] |= witness


def lower_rank_kept(rng: random.Random, document: Document) -> Forged:
    """The rank of the certificate one more, and a row less."""
    witness, claim = document["witness"], document["claim"]
    if not witness["pivots"]:
        return None
    k = rng.randrange(len(witness["pivots"]))
    witness["pivots"].pop(k)
    witness["left"]["entries"].pop(k)
    claim["rank"] += 1
    if not witness["pivots"]:
        claim |= {"solvable": True, "invariant_zero": None}
        witness |= {"point": None, "normal": None}
    return document


def all_edges(rng: random.Random, document: Document) -> Forged:
    """Every edge with the power that shows it, and others with powers that show nothing."""
    system = subject_of(document)
    arcs = set(transfer_edges(system))
    document["claim"]["arcs"] = [names_of(system, edge) for edge in sorted(arcs)]
    powers = []
    for j, i in sorted(arcs):
        M, k = system.B[j], 0
        while not any(v != 0 for v in (system.C[i] * M).entries()):
            M, k = system.A * M, k + 1
        powers.append(k + rng.choice((0, 0, 0, 1, system.n)))
    document["witness"] |= {"powers": powers, "modulus": PRIME}
    _connected_again(document, system.names)
    return document


CONTROLLABILITY = (
    smaller_dimension,
    smaller_dimension,
    larger_dimension,
    reached_by_blocks,
    reached_by_blocks,
)
INDICES = (
    ranks_by_false_relations,
    ranks_by_false_relations,
    ranks_by_false_relations,
    ranks_cut_short,
    ranks_too_large,
)
GRAPH = (missing_edge, extra_edge, all_edges, unsorted_edges)
ASSIGNABILITY = (
    *(other_degree,) * 6,
    *(other_components,) * 4,
    by_the_whole_graph,
    smaller_realization,
    outputs_alone,
    larger_realization,
    whole_space,
)
COMPLEMENTARY = (no_zeros, split_zeros, improper_subset)
SETPOINT = (other_rank, other_zero, lower_rank_kept)


def other_gap(rng: random.Random, document: Document) -> Document:
    """Other numbers of a neighbor graph, with other sets, or with a tree that proves less."""
    claim, witness = document["claim"], document["witness"]
    names = [channel["name"] for channel in document["system"]["channels"]]

    def some() -> list[str]:
        return [name for name in names if rng.random() < 0.5]

    for key in ("receivers", "senders", "dominating"):
        if rng.random() < 0.4:
            witness[key] = some()
    if rng.random() < 0.5:
        claim["boundary"] = len(names) - len(witness["dominating"])
    for key in claim:
        if rng.random() < 0.3:
            claim[key] = max(claim[key] + rng.choice((-1, 1)), 0)
    if rng.random() < 0.3:
        weight = rng.choice((1, 2, "1/2"))
        witness["tree"] = [{"multipliers": [[k, weight] for k in range(len(names))]}]
    return document


GAP = (other_gap,)


def other_numbers(rng: random.Random, document: Document) -> Document:
    """More or fewer modes at 0, with potentials that add up, or with a matching of so many."""
    claim, witness = document["claim"], document["witness"]
    z = max(claim["at_zero"] + rng.choice((-1, 1)), 0)
    moved = z - claim["at_zero"]
    states = claim["without_feedback"]
    _with_modes(document, z, states)
    if rng.random() < 0.7 and witness["rows"]:
        witness["rows"][rng.randrange(len(witness["rows"]))] += moved
    if rng.random() < 0.3:
        rng.shuffle(witness["matching"])
    return document


def other_matching(rng: random.Random, document: Document) -> Forged:
    """As many modes at 0 as there are states, and potentials and a matching that say so."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    U = claim["without_feedback"]
    kept = [a for a in range(system.n) if a not in U]
    loops = [not system.A[a, a] for a in kept]
    rest = len(witness["rows"]) - len(kept)
    if rng.random() < 0.5:
        # one column for all rows, or an entry that is 0
        witness["matching"] = [rng.choice(witness["matching"]) for _ in witness["matching"]]
    else:
        own = [*kept, *range(system.n, system.n + rest)]
        witness["matching"] = own
        witness["rows"] = [*map(int, loops), *[0] * rest]
        witness["columns"] = [0] * len(own)
        _with_modes(document, sum(loops), U)
    return document


def other_states(rng: random.Random, document: Document) -> Forged:
    """Another set of states without feedback, with potentials and a matching for the rest."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    before = claim["without_feedback"]
    a = rng.randrange(system.n) if system.n else None
    if a is None:
        return None
    U = sorted({*before} ^ {a})
    left = [b for b in range(system.n) if b not in U]
    rest = len(witness["rows"]) + len(before) - system.n
    _with_modes(document, 0, U)
    size = len(left) + rest
    zeros = [0] * size
    own = [*left, *range(system.n, system.n + rest)]
    document["witness"] = {"rows": zeros, "columns": [*zeros], "matching": own}
    return document


def _with_modes(document: Document, z: int, U: list[int]) -> None:
    """The claim that x^z det(xI − A_UU) is fixed."""
    A = subject_of(document).A
    chi = fmpq_mat(len(U), len(U), [A[a, b] for a in U for b in U]).charpoly()
    document["claim"] |= {
        "without_feedback": U,
        "at_zero": z,
        "polynomial": [0] * z + coefficients(chi),
    }


def other_polynomial(rng: random.Random, document: Document) -> Document:
    """Other modes than those of the states, with the same evidence."""
    listed = document["claim"]["polynomial"]
    listed.insert(0, rng.choice((0, 1)))
    return document


PATTERNS = (other_numbers, other_numbers, other_matching, other_states, other_polynomial)
