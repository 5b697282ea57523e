"""Forgeries about fixed modes, pencils, gains for single channels, and exceptional gains."""

from __future__ import annotations

import random
from typing import Any

from tests.oracle.certificates import algebra
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.modes import transfer_edges
from tests.oracle.certificates.reading import polynomial
from tests.oracle.drawn.plants import Document

from ..mutators import copied
from . import sequences
from .joined import factors_joined
from .writing import PRIME, coefficients, drawn, drawn_gains, left_kernel, unit, written, zeros

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
    if rng.random() < 0.5:
        document["witness"] = {"from": sources}
    return document


def unconnected(rng: random.Random, document: Document) -> Forged:
    """Complete, by edges that are there and do not connect all channels."""
    system = subject_of(document)
    document["claim"]["complete"] = True
    made = sequences.blocks(rng, system) if rng.random() < 0.4 else None
    proof = {"gains": drawn_gains(rng, system)} if made is None else {"blocks": made}
    document["witness"] = {"modulus": PRIME, "arcs": shown_edges(system), **proof}
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


def fixed_within_states(rng: random.Random, document: Document) -> Forged:
    """Not complete, by a mode of some states, on which what they drive may act."""
    made = _local_subspace(rng, subject_of(document))
    if made is None:
        return None
    p, space = made
    document["claim"]["complete"] = False
    document["witness"] = {"polynomial": coefficients(p), "subspace": space}
    return document


def _local_subspace(rng: random.Random, system: Any) -> tuple[Any, Document] | None:
    """An eigenvector of A within drawn states, and channels that may be too few or too many."""
    states = [a for a in range(system.n) if rng.random() < 0.5]
    A = sequences.picked(system.A, states, states)
    roots = [p for p, _ in algebra.irreducible_factors(A.charpoly()) if p.degree() == 1]
    if not roots:
        return None
    p = rng.choice(roots)
    shifted = A + p[0] * algebra.identity(len(states))
    rows, pivots = left_kernel(shifted.transpose())
    if rng.random() < 0.2:
        p *= algebra.X - rng.randint(-3, 3)
    seeing = [
        name
        for name, C in zip(system.names, system.C, strict=True)
        if any(row[a] != 0 for row in C.tolist() for a in states)
    ]
    inner = [name for name in seeing if rng.random() < 0.2]
    width = sum(system.B[system.names.index(name)].ncols() for name in inner)
    U = written(rows.transpose())
    space = {
        "channels_T": inner,
        "U": {"denominator": U["denominator"], "coefficients": [U["entries"]]},
        "V": {"denominator": 1, "coefficients": [[[0] * len(pivots) for _ in range(width)]]},
        "pivots": pivots,
    }
    outside = [name for name in system.names if name in seeing or rng.random() < 0.3]
    T = outside if rng.random() < 0.7 else seeing
    return p, {"channels_T": T, "states": states, "subspace": space}


def fixed_by_rows(rng: random.Random, document: Document) -> Forged:
    """Not complete, by rows W with W (xI − A) = Z C_s, which inputs may move."""
    system = subject_of(document)
    roots = [p for p, _ in algebra.irreducible_factors(system.A.charpoly()) if p.degree() == 1]
    if not roots:
        return None
    p = rng.choice(roots)
    document["claim"]["complete"] = False
    document["witness"] = {
        "polynomial": coefficients(p),
        "subspace": _dual_subspace(rng, system, p),
    }
    return document


def _dual_subspace(rng: random.Random, system: Any, p: Any) -> Document:
    """Left eigenvectors of A, or all rows, with a set that may be wrong or not the complement."""
    s = [name for name in system.names if rng.random() < 0.4]
    T = [name for name in system.names if name not in s]
    rows, pivots = left_kernel(system.A + p[0] * algebra.identity(system.n))
    U = written(rows.transpose())
    width = sum(system.C[system.names.index(name)].nrows() for name in s)
    space = {
        "channels_T": s,
        "U": {"denominator": U["denominator"], "coefficients": [U["entries"]]},
        "V": {"denominator": 1, "coefficients": [[[0] * len(pivots) for _ in range(width)]]},
        "pivots": pivots,
    }
    if rng.random() < 0.3:
        T = [name for name in system.names if rng.random() < 0.5]
    return {"channels_T": T, "dual": space}


def _movable(rng: random.Random, system: Any) -> Document:
    factors = algebra.irreducible_factors(system.A.charpoly())
    p = rng.choice(factors)[0] if factors else algebra.X
    chosen = [name for name in system.names if rng.random() < 0.5]
    return {"polynomial": coefficients(p), "subspace": _empty_subspace(rng, system, chosen)}


def _empty_subspace(rng: random.Random, system: Any, T: list[str]) -> Document:
    """A subspace of no columns, or of columns of zeros."""
    width = sum(system.B[system.names.index(name)].ncols() for name in T)
    u = rng.choice((0, system.n))
    layer = {"denominator": 1, "coefficients": [[[0] * u for _ in range(system.n)]]}
    V = {"denominator": 1, "coefficients": [[[0] * u for _ in range(width)]]}
    return {"channels_T": T, "U": layer, "V": V, "pivots": list(range(u))}


def other_deficiency(rng: random.Random, document: Document) -> Forged:
    """More or less rank lost, completed by as many columns and rows."""
    system, witness = subject_of(document), document["witness"]
    rho = max(document["claim"]["deficiency"] + rng.choice((-2, -1, 1)), 0)
    document["claim"]["deficiency"] = rho
    made = sequences.blocks(rng, system) if rng.random() < 0.5 else None
    if made is not None:
        _by_other_blocks(rng, document, made, rho)
        return document
    n = system.n
    witness |= {"B0": drawn(rng, n, rho), "C0": drawn(rng, rho, n), "modulus": PRIME}
    if not rho:
        witness |= {"polynomial": None, "subspace": None}
    return document


def _by_other_blocks(
    rng: random.Random, document: Document, made: list[Document], rho: int
) -> None:
    """Blocks that prove too much, and the factor that loses rank with another loss, or none."""
    witness = document["witness"]
    losses = witness.get("losses", [])
    if witness.get("subspace"):
        space = {key: witness[key] for key in ("polynomial", "subspace")}
        losses = [{**space, "deficiency": max(rho, 1)}]
    losses = losses if rho else []
    ell = rng.choice((2, 7, 101)) if losses else None
    document["witness"] = {"blocks": made, "modulus": ell, "losses": losses}


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
    made = _local_subspace(rng, system) if rng.random() < 0.4 else None
    if rng.random() < 0.3:
        made = p, _dual_subspace(rng, system, p)
    space = _empty_subspace(rng, system, T) if made is None else made[1]
    if made is not None:
        factor = claim["factors"][-1]
        factor["channels"] = [name for name in system.names if name not in space["channels_T"]]
    document["witness"]["subspaces"].append(space)
    _restated(rng, document)
    return document


def by_two_polynomials(rng: random.Random, document: Document) -> Forged:
    """The same factors, with drawn gains, exponents and completion in place of a sequence."""
    witness, system = document["witness"], subject_of(document)
    if "blocks" not in witness:
        return None
    spaces = witness["subspaces"]
    document["witness"] = {"modulus": PRIME, "subspaces": spaces, "gains": drawn_gains(rng, system)}
    document["witness"]["completion"] = None
    return factor_details(rng, document) if rng.random() < 0.5 else factor_dropped(rng, document)


def exponents_unsaid(rng: random.Random, document: Document) -> Forged:
    """Two polynomials that say nothing of A, with ℓ below or above the bound, or a false claim."""
    if "blocks" in document["witness"]:
        made = by_two_polynomials(rng, document)
    else:
        made = document if rng.random() < 0.4 else factor_dropped(rng, document)
    if made is None:
        return None
    for factor in made["claim"]["factors"]:
        factor["multiplicity_in_A"] = None
    made["witness"]["modulus"] = rng.choice((2, 3, 5, 7, 11, PRIME))
    return made


def _restated(rng: random.Random, document: Document) -> None:
    """The rest of the claim, as it follows from its factors."""
    claim, witness, n = document["claim"], document["witness"], subject_of(document).n
    product = algebra.ONE
    for factor in claim["factors"]:
        product *= polynomial(factor["polynomial"])
    claim["polynomial"] = coefficients(product)
    claim["stabilizable"] = all(factor["stable"] for factor in claim["factors"])
    rho = max((n - factor["rank"] for factor in claim["factors"]), default=0)
    if "blocks" not in witness:
        completion = {"B0": drawn(rng, n, rho), "C0": drawn(rng, rho, n)}
        witness["completion"] = completion if claim["factors"] else None
    if not claim["factors"]:
        claim["best_rate"] = None
        return
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
        key = rng.choice(("multiplicity_in_A", "multiplicity_at_most"))
        factor[key] = (factor[key] or 0) + rng.choice((-1, 1))
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
    what = rng.randrange(6) if len(discs) < 2 or rng.random() < 0.5 else 2
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


def vanishing_kernel(rng: random.Random, document: Document) -> Forged:
    """A root at which the kernel vanishes, being multiplied by 1 − x/a."""
    claim, kernel = document["claim"], document["witness"]["kernel"]
    a = rng.choice((-3, -2, -1, 1, 2, 3))
    claim["polynomial"] = coefficients(polynomial(claim["polynomial"]) * (algebra.X - a))
    layers = kernel["coefficients"]
    zero = [[0] * len(row) for row in layers[0]]
    kernel["denominator"] *= abs(a)
    sign = 1 if a > 0 else -1
    kernel["coefficients"] = [
        [
            [sign * (a * v - w) for v, w in zip(*rows, strict=True)]
            for rows in zip(new, old, strict=True)
        ]
        for new, old in zip([*layers, zero], [zero, *layers], strict=True)
    ]
    return document


COMPLETENESS = (
    *(no_subset_at_all, unconnected, unconnected, fixed_by_nothing),
    *(fixed_within_states, fixed_within_states, fixed_by_rows, fixed_by_rows),
)
DEFICIENCY = (other_deficiency,)
SPECTRUM = (
    *(factor_dropped, factor_twice, factor_added, factor_details, factor_details),
    *(by_two_polynomials, by_two_polynomials, exponents_unsaid, exponents_unsaid),
    factors_joined,
    *sequences.SPECTRUM,
)
PENCIL = (pencil_of_another_set, vanishing_kernel)
