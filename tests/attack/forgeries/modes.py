"""Forgeries about fixed modes, pencils, gains for single channels, and exceptional gains."""

from __future__ import annotations

import random
from typing import Any

from ..draws.plants import Document
from ..mutators import copied
from ..oracle import algebra
from ..oracle.constructions import subject_of
from ..oracle.modes import transfer_edges
from ..oracle.reading import polynomial
from .writing import PRIME, coefficients, drawn, drawn_gains, unit, zeros

Forged = Document | None


def cut_off(n: int, sources: list[str], *, whole: bool) -> Document:
    """A zero transfer by the whole space, or by nothing."""
    if whole:
        return {"from": sources, "X": unit(n), "pivots": list(range(n))}
    return {"from": sources, "X": zeros(n, 0), "pivots": []}


def no_subset_at_all(rng: random.Random, document: Document) -> Forged:
    """Not complete, for want of transfer from all channels or from none."""
    system = subject_of(document)
    chosen = [name for name in system.names if rng.random() < 0.5]
    sources = rng.choice(([], list(system.names), chosen))
    document["claim"]["complete"] = False
    document["witness"] = {"zero": cut_off(system.n, sources, whole=rng.random() < 0.5)}
    return document


def unconnected(rng: random.Random, document: Document) -> Forged:
    """Complete, by edges that are there and do not connect all channels."""
    system = subject_of(document)
    document["claim"]["complete"] = True
    document["witness"] = {
        "modulus": PRIME,
        "gains": drawn_gains(rng, system),
        "arcs": shown_edges(system),
    }
    return document


def shown_edges(system: Any) -> list[list[Any]]:
    """Every edge with the least power that shows it."""
    found = []
    for j, i in transfer_edges(system):
        M, k = system.B[j], 0
        while not any(v != 0 for v in (system.C[i] * M).entries()):
            M, k = system.A * M, k + 1
        found.append([system.names[j], system.names[i], k])
    return found


def fixed_by_nothing(rng: random.Random, document: Document) -> Forged:
    """A mode that is movable, said to be fixed by a subspace that shrinks by nothing."""
    system = subject_of(document)
    document["claim"]["complete"] = False
    document["witness"] = _movable(rng, system)
    return document


def _movable(rng: random.Random, system: Any) -> Document:
    factors = algebra.irreducible_factors(system.A.charpoly())
    p = rng.choice(factors)[0] if factors else algebra.X
    chosen = [name for name in system.names if rng.random() < 0.5]
    return {"polynomial": coefficients(p), "subspace": _empty_subspace(system, chosen)}


def _empty_subspace(system: Any, T: list[str]) -> Document:
    width = sum(system.B[system.names.index(name)].ncols() for name in T)
    layer = {"denominator": 1, "coefficients": [[[] for _ in range(system.n)]]}
    V = {"denominator": 1, "coefficients": [[[] for _ in range(width)]]}
    return {"channels_T": T, "U": layer, "V": V, "pivots": []}


def other_deficiency(rng: random.Random, document: Document) -> Forged:
    """More or less rank lost, completed by as many columns and rows."""
    system, witness = subject_of(document), document["witness"]
    rho = max(document["claim"]["deficiency"] + rng.choice((-2, -1, 1)), 0)
    document["claim"]["deficiency"] = rho
    n = system.n
    witness |= {"B0": drawn(rng, n, rho), "C0": drawn(rng, rho, n), "modulus": PRIME}
    if not rho:
        witness |= {"polynomial": None, "subspace": None}
    return document


def factor_dropped(rng: random.Random, document: Document) -> Forged:
    """A fixed mode left out, with everything that belongs to it."""
    claim, witness = document["claim"], document["witness"]
    if not claim["factors"]:
        return None
    k = rng.randrange(len(claim["factors"]))
    claim["factors"].pop(k)
    witness["subspaces"].pop(k)
    _restated(rng, document)
    return document


def factor_twice(rng: random.Random, document: Document) -> Forged:
    """A fixed mode counted twice."""
    claim, witness = document["claim"], document["witness"]
    if not claim["factors"]:
        return None
    k = rng.randrange(len(claim["factors"]))
    for entries in (claim["factors"], witness["subspaces"]):
        entries.append(copied(entries[k]))
    _restated(rng, document)
    return document


def factor_added(rng: random.Random, document: Document) -> Forged:
    """A movable mode said to be fixed."""
    system, claim = subject_of(document), document["claim"]
    factors = [f for f, _ in algebra.irreducible_factors(system.A.charpoly()) if f.degree() == 1]
    if not factors:
        return None
    p = rng.choice(factors)
    T = [name for name in system.names if rng.random() < 0.5]
    root = -p[0]
    if root.q not in (1, 2):
        return None
    digits = str(int(root.p)) if root.q == 1 else f"{int(root.p) / 2}"
    stable = root < 0 if system.time == "continuous" else abs(root) < 1
    claim["factors"].append(
        {
            "polynomial": coefficients(p),
            "multiplicity_in_A": algebra.multiplicity(p, system.A.charpoly()),
            "multiplicity_at_most": 1,
            "channels": [name for name in system.names if name not in T],
            "rank": system.n - 1,
            "stable": bool(stable),
            "roots": [{"re": digits, "im": "0", "radius": "0"}],
        }
    )
    document["witness"]["subspaces"].append(_empty_subspace(system, T))
    _restated(rng, document)
    return document


def _restated(rng: random.Random, document: Document) -> None:
    """The rest of the claim, as it follows from its factors."""
    claim, witness, n = document["claim"], document["witness"], subject_of(document).n
    product = algebra.ONE
    for factor in claim["factors"]:
        product *= polynomial(factor["polynomial"])
    claim["polynomial"] = coefficients(product)
    claim["stabilizable"] = all(factor["stable"] for factor in claim["factors"])
    if not claim["factors"]:
        claim["best_rate"] = witness["completion"] = None
        return
    rho = max(n - factor["rank"] for factor in claim["factors"])
    witness["completion"] = {"B0": drawn(rng, n, rho), "C0": drawn(rng, rho, n)}
    if claim["best_rate"] is None:
        claim["best_rate"] = {"lower": "-100", "upper": "100"}


def factor_details(rng: random.Random, document: Document) -> Forged:
    """One detail of a factor: rank, multiplicities, channels, stability."""
    system, claim = subject_of(document), document["claim"]
    if not claim["factors"]:
        claim["best_rate"] = {"lower": "0", "upper": "1"}
        return document
    factor = rng.choice(claim["factors"])
    what = rng.randrange(6)
    if what == 0:
        factor["rank"] += rng.choice((-1, 1))
        _restated(rng, document)
    elif what == 1:
        factor[rng.choice(("multiplicity_in_A", "multiplicity_at_most"))] += rng.choice((-1, 1))
    elif what == 2:
        factor["channels"] = [name for name in system.names if rng.random() < 0.5]
    elif what == 3:
        factor["stable"] = not factor["stable"]
        _restated(rng, document)
    elif what == 4:
        claim["best_rate"] = _interval(rng)
    else:
        other_discs(rng, factor["roots"])
    return document


def _interval(rng: random.Random) -> Document:
    lower = rng.randint(-4, 4)
    return {"lower": str(lower), "upper": str(lower + rng.choice((0, 1, 4, -1, -8)))}


def other_discs(rng: random.Random, discs: list[Document]) -> None:
    """Discs elsewhere, larger, twice the same, or around no root."""
    if not discs:
        return
    k = rng.randrange(len(discs))
    what = rng.randrange(6)
    if what == 0:
        discs[k]["re"] = str(rng.randint(-5, 5))
    elif what == 1:
        discs[k]["radius"] = rng.choice(("0", "-1", "1", "10", "1000"))
    elif what == 2:
        discs[k] = copied(rng.choice(discs))
    elif what == 3:
        discs[k] |= {
            "im": rng.choice(("0.001", "0.5", "-0.5")),
            "radius": rng.choice(("0.01", "1", "2")),
        }
    elif what == 4:
        discs[k] |= {
            "re": str(rng.randint(-3, 3)),
            "im": "0",
            "radius": rng.choice(("0", "5", "100")),
        }
    else:
        for disc in discs:
            disc["radius"] = rng.choice(("-5", "5"))


def pencil_of_another_set(rng: random.Random, document: Document) -> Forged:
    """Another set of channels, rank or kernel."""
    system, claim, witness = subject_of(document), document["claim"], document["witness"]
    what = rng.randrange(3)
    if what == 0:
        claim["subset"] = [name for name in system.names if rng.random() < 0.5]
    elif what == 1:
        layers = witness["kernel"]["coefficients"]
        if not witness["pivots"]:
            return None
        k = rng.randrange(len(witness["pivots"]))
        witness["pivots"].pop(k)
        for layer in layers:
            for row in layer:
                row.pop(k)
        claim["rank"] += 1
    else:
        outside = [i for i in range(system.m) if system.names[i] not in claim["subset"]]
        c = system.n + sum(system.B[i].ncols() for i in outside)
        r = rng.randint(0, c)
        pivots = sorted(rng.sample(range(c), c - r))
        rows = [[int(i == k) for k in pivots] for i in range(c)]
        claim["rank"], witness["pivots"] = r, pivots
        witness["kernel"] = {"denominator": 1, "coefficients": [rows]}
    return document


def no_gains(rng: random.Random, document: Document) -> Forged:
    """Gains exist, and are denied by a cut that cuts nothing off."""
    system, claim = subject_of(document), document["claim"]
    if not system.m:
        return None
    sides = ["controllable", "observable"] if claim["property"] == "both" else [claim["property"]]
    q = rng.choice(system.names)
    if rng.random() < 0.5:
        claim["channels"] = [name for name in system.names if name != q]
    chosen = [name for name in system.names if rng.random() < 0.6]
    sources = rng.choice((list(system.names), [q], [], chosen))
    claim |= {
        "exists": False,
        "cyclic": rng.random() < 0.1,
        "indices": rng.choice((None, None, [])),
    }
    document["witness"] = {
        "channel": q,
        "side": rng.choice(sides),
        "zero": cut_off(system.n, sources, whole=rng.random() < 0.5),
    }
    return document


def asked_elsewhere(rng: random.Random, document: Document) -> Forged:
    """What is out of reach of one channel, said of others."""
    system, claim = subject_of(document), document["claim"]
    if claim["exists"] or not system.m:
        return None
    claim["channels"] = [name for name in system.names if rng.random() < 0.5]
    if rng.random() < 0.3:
        document["witness"]["channel"] = rng.choice(system.names)
    if rng.random() < 0.2:
        claim["cyclic"] = True
    return document


def larger_index(rng: random.Random, document: Document) -> Forged:
    """An index more than there is, shown by a row of zeros or by any row."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exists"] or not claim["indices"]:
        return None
    a = rng.randrange(len(claim["indices"]))
    b = rng.randrange(len(claim["indices"][a]))
    claim["indices"][a][b] += 1
    n = subject_of(document).n
    row = zeros(1, n) if rng.random() < 0.6 else drawn(rng, 1, n, 1)
    witness["annihilators"][a][b] = row
    return document


def not_cyclic(rng: random.Random, document: Document) -> Forged:
    """A_F said to be cyclic, with any generator or none."""
    claim, n = document["claim"], subject_of(document).n
    claim["cyclic"] = not claim["cyclic"]
    generator = rng.choice((None, drawn(rng, n, 1), zeros(n, 1)))
    if claim["exists"]:
        document["witness"]["generator"] = generator
    return document


def without_gains(rng: random.Random, document: Document) -> Forged:
    """Gains that reach nothing: zeros, with the indices that another certificate has."""
    system, claim = subject_of(document), document["claim"]
    if not claim["exists"]:
        n, sides = system.n, 2 if claim["property"] == "both" else 1
        claim |= {"exists": True, "indices": [[n] * sides for _ in claim["channels"]]}
        rows = [[unit(1) | {"entries": [[1] * n]} for _ in range(sides)] for _ in claim["channels"]]
        document["witness"] = {"gains": drawn_gains(rng, system), "modulus": PRIME}
        document["witness"] |= {"annihilators": rows, "generator": None}
        return document
    document["witness"]["gains"] = [
        zeros(B.ncols(), C.nrows()) for B, C in zip(system.B, system.C, strict=True)
    ]
    return document


def extra_root(rng: random.Random, document: Document) -> Forged:
    """A value of g where no rank is lost, with a row that annihilates nothing."""
    claim, witness = document["claim"], document["witness"]
    n = subject_of(document).n
    if not n:
        return None
    a = rng.randint(-3, 3)
    p = polynomial(claim["polynomial"]) * (algebra.X - a)
    claim["polynomial"] = coefficients(p)
    claim["roots"].append({"re": str(a), "im": "0", "radius": "0"})
    pivot = rng.randrange(n)
    row = [[int(j == pivot) for j in range(n)]]
    witness["factors"].append(
        {
            "polynomial": [-a, 1],
            "row": {"denominator": 1, "coefficients": [row]},
            "pivot": pivot,
        }
    )
    return document


def root_left_out(rng: random.Random, document: Document) -> Forged:
    """A value of g where rank is lost is left out of the claim, the witness, or both."""
    claim, witness = document["claim"], document["witness"]
    if not witness["factors"]:
        return None
    kept = [f for f in witness["factors"] if rng.random() < 0.5]
    product = algebra.ONE
    for f in kept:
        product *= polynomial(f["polynomial"])
    claim["polynomial"] = coefficients(product)
    claim["roots"] = claim["roots"][: product.degree()]
    if product == 1:
        claim["roots"] = []
    if rng.random() < 0.5:
        witness["factors"] = kept
    return document


def hidden_root(rng: random.Random, document: Document) -> Forged:
    """No root at all: the first determinant is 0, and ℓ makes the second one constant."""
    claim, witness = document["claim"], document["witness"]
    denominators = [
        int(polynomial(claim["polynomial"])[k].q) for k in range(len(claim["polynomial"]))
    ]
    primes = [ell for ell in (2, 3, 5, 7) if any(d % ell == 0 for d in denominators)]
    if primes:
        witness["modulus"] = rng.choice(primes)
    claim |= {"polynomial": [1], "roots": []}
    witness["factors"] = []
    rows = witness["compressions"][0]["entries"]
    witness["compressions"][0]["entries"] = [[0] * len(row) for row in rows]
    return document


def more_blocks(rng: random.Random, document: Document) -> Forged:
    """More or fewer blocks than the claim was about."""
    claim, system = document["claim"], subject_of(document)
    k = claim["blocks"] + rng.choice((-1, 1, 1))
    width = system.inputs().ncols()
    claim["blocks"] = k
    shapes = [drawn(rng, max(k, 0) * width, system.n, 5) for _ in range(2)]
    document["witness"]["compressions"] = shapes
    return document


def discs_elsewhere(rng: random.Random, document: Document) -> Forged:
    """Other discs for the exceptional gains."""
    other_discs(rng, document["claim"]["roots"])
    return document


COMPLETENESS = (no_subset_at_all, unconnected, unconnected, fixed_by_nothing)
DEFICIENCY = (other_deficiency,)
SPECTRUM = (factor_dropped, factor_twice, factor_added, factor_details, factor_details)
PENCIL = (pencil_of_another_set,)
SINGLE = (no_gains, no_gains, asked_elsewhere, larger_index, not_cyclic, without_gains)
EXCEPTIONAL = (extra_root, root_left_out, hidden_root, more_blocks, discs_elsewhere)
