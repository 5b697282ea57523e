"""Further kinds about structure, beyond those of the core (`core.reach`).

Each kind has a function ``check_…``, which stops unless the witness proves the claim, and a
function ``…_statement``, which says the claim in words.

Ranks and dimensions are bounded from above by rows or subspaces that are annihilated exactly, and
from below by ranks modulo ℓ (`krylov_ranks`), which take short numbers.  The neighbor graph needs
no witness: its strong components are recomputed.
"""

import math
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from itertools import accumulate, pairwise

from .constructions import neighbors_of
from .core import budget, evidence, reading, roots
from .core.arithmetic import (
    SMALL,
    Matrix,
    Polynomial,
    SparseMatrix,
    banded_pivots,
    by_breadth,
    characteristic_polynomial,
    diagonal,
    exponent,
    poly_divide,
    poly_product,
    rank_modulo,
    residues,
    stack,
    stripped,
)
from .core.budget import counted, spend
from .core.evidence import SparseProduct, annihilator, by_row, inputs, modulus
from .core.reach import PAIRS, components, krylov_ranks, read_arcs, require_arcs, require_no_edges
from .core.reading import (
    Json,
    boolean,
    fields,
    integer,
    items,
    malformed,
    matrix,
    names,
    polynomial,
    polynomial_matrix,
    require,
)
from .core.system import (
    PENCIL,
    System,
    canonical_json,
    channel_set,
    denied,
    dual,
    polynomial_text,
    with_digest,
)


def banded_krylov_ranks(system: System, T: list[int], ell: int, blocks: int) -> list[int]:
    """Ranks modulo ℓ ≤ ``SMALL`` of no block, [B_T], …, so many blocks, for an A of few entries.

    The rows of A^k B_T are long integers with a byte for each input, and the states are in an order
    in which those that A joins are near each other.

    Theorem ``arithmetic.rank_from_below``.
    """
    n, B, entries = system.n, inputs(system, T), residues(system.A, ell)
    spend(200 * (len(entries) + n))
    place, power = by_breadth(entries, n, n), [0] * n
    for a, u, x in residues(B, ell):
        power[place[a]] |= x << 8 * u
    spend(n * (B.ncols + 8))
    lines = by_row([(place[a], place[b], x) for a, b, x in entries], n)
    A = SparseProduct(lines, B.ncols, ell)
    starting: list[list[tuple[int, int]]] = [[] for _ in range(n)]
    for k in counted(range(blocks)):
        spend(n * (60 + B.ncols // 2))
        table = b"".join(row.to_bytes(B.ncols, "little") for row in power)
        for u in range(B.ncols):
            column = table[u :: B.ncols]
            kept = column.lstrip(b"\0")
            if kept:
                starting[n - len(kept)].append((k, int.from_bytes(kept, "little")))
        power = A(power)
    return [0, *accumulate(banded_pivots(starting, blocks, ell))]


def require_reached(system: System, channel: int, ell: int, blocks: int) -> None:
    """Stop unless [B_q, …, A^{blocks−1}B_q] has rank n modulo ℓ."""
    reached = krylov_ranks(system, [channel], ell, blocks)[-1]
    message = f"only {reached} dimensions are reached modulo l in {blocks} blocks"
    require(reached == system.n, "rank", "witness", message)


# Kind ``controllability_indices``; ``proofs/controllability_indices.md``.


def check_controllability_indices(claim: Json, witness: Json, system: System) -> None:
    """Check ranks of [B … A^{k−1}B] from above by rows and relations, from below modulo ℓ.

    Theorems ``controllability.indices_stationary``, ``controllability.rank_from_above``.
    """
    listed, claimed, top, parts = fields(claim, "claim", "channels", "ranks", "index", "indices")
    keys = ("modulus", "annihilator", "pivots", "relations", "inputs")
    number, *shown = fields(witness, "witness", *keys)
    T, n = names(listed, "claim.channels", system.names), system.n
    ranks = [0, *(integer(r, "claim.ranks", 1) for r in items(claimed, "claim.ranks"))]
    increasing = ranks == sorted(set(ranks)) and ranks[-1] <= n
    require(increasing, "claim", "claim.ranks", f"expected strictly increasing ranks up to {n}")
    ell, nu, B = modulus(number, "witness.modulus"), len(ranks) - 1, inputs(system, T)
    _require_growth(shown, ranks, system.A, B)
    few = ell <= SMALL and isinstance(system.A, SparseMatrix)
    reached = (banded_krylov_ranks if few else krylov_ranks)(system, T, ell, nu)
    # Where the blocks stop growing modulo ℓ, the last rank stands for all that follow.
    reached += [reached[-1]] * (nu + 1 - len(reached))
    enough = all(low >= r for low, r in zip(reached, ranks, strict=True))
    require(enough, "rank", "claim.ranks", f"only {reached[1:]} are reached modulo l")
    index = None if top is None else integer(top, "claim.index")
    require(index == (nu if ranks[-1] == n else None), "claim", "claim.index", "does not follow")
    steps = [b - a for a, b in pairwise(ranks)]
    conjugate = [sum(step > i for step in steps) for i in range(max(steps, default=0))]
    kappa = [integer(part, "claim.indices") for part in items(parts, "claim.indices")]
    require(kappa == conjugate, "claim", "claim.indices", f"the ranks give {conjugate}")


def _require_growth(shown: list[Json], ranks: list[int], A: Matrix, B: Matrix) -> None:
    """Stop unless the ranks of [B … A^{k−1}B] are at most these, if they are at least these.

    A step from one rank to the next is at most the step before, and at most the number of inputs
    without a relation of this degree; and the rows that annihilate all blocks bound every rank.

    Theorems ``rank_growth.growth_rule``, ``rank_growth.relations_bound``.
    """
    rows, columns, polynomials, chosen = shown
    W, _ = annihilator(rows, columns, "witness", A, [B])
    degrees = relation_degrees(polynomials, chosen, A, B)
    step = B.ncols
    for k, (r, following) in enumerate(pairwise([*ranks, ranks[-1]])):
        step = min(step, B.ncols - sum(degree <= k for degree in degrees))
        most = min(A.nrows - W.nrows, r + step)
        message = f"the rank of {k + 1} blocks is shown to be at most {most}"
        require(following >= most, "rank", "claim.ranks", message)
        step = following - r


def relation_degrees(polynomials: Json, chosen: Json, A: Matrix, B: Matrix) -> list[int]:
    """The degrees of the columns v of V, for which Σ A^i B v_i = 0.

    The last coefficients of the columns are independent: each is not 0 at an input of its own, at
    which the last coefficients of all later columns are 0.

    Theorem ``rank_growth.own_inputs_free``.
    """
    place = "witness.relations"
    own = [integer(j, "witness.inputs") for j in items(chosen, "witness.inputs")]
    if any(j >= B.ncols for j in own):
        malformed("witness.inputs", f"expected positions below {B.ncols}")
    V = polynomial_matrix(polynomials, place, B.ncols, len(own))
    spend(8 * (len(V) + len(own)) * B.ncols * len(own))
    degrees = []
    for t, j in enumerate(own):
        columns = enumerate([row[t] for row in layer.rows] for layer in V)
        degree, last = max(((k, v) for k, v in columns if any(v)), default=(-1, []))
        independent = degree >= 0 and last[j] and not any(last[i] for i in own[:t])
        require(bool(independent), "relation", place, "the last coefficients are not independent")
        degrees.append(degree)
    total = Matrix.zeros(A.nrows, len(own))
    for layer in counted(V[::-1]):
        total = A @ total + B @ layer
    require(total.is_zero(), "identity", place, "the sum of A^i B v_i is not zero")
    return degrees


def controllability_indices_statement(claim: Json, system: System) -> str:
    """The statement: the ranks block by block, and the indices that follow from them."""
    index = "none" if claim["index"] is None else claim["index"]
    return (
        "the ranks of [B, A B, ..., A^(k-1) B], B the inputs of the channels "
        f"{channel_set(claim['channels'])}, for k = 1, 2, ... are {canonical_json(claim['ranks'])} "
        f"and do not grow further; the controllability indices are "
        f"{canonical_json(claim['indices'])} and the controllability index is {index}"
    )


# Kind ``complementary_subsystem``: a Smith form; ``proofs/complementary_subsystem.md``.

SUBSYSTEM_CLAIM = [
    "subset",
    "normal_rank",
    "invariant_polynomials",
    "remnant",
    "transfer_zero",
    "complete",
]
SUBSYSTEM_WITNESS = ["modulus", "reachable", "X", "F", "A1", "S", "B1", "L", "G", "N"]


def check_complementary_subsystem(claim: Json, witness: Json, system: System) -> None:
    """Check bases that bring the pencil to block triangular form, and read off its Smith form.

    Theorems ``complementary_subsystem.invariant_polynomials``,
    ``complementary_subsystem.normal_rank``, ``complementary_subsystem.remnant_gcd``,
    ``complementary_subsystem.remnant_roots``, ``complementary_subsystem.transfer_zero``,
    ``complementary_subsystem.complete_rule``.
    """
    listed, rank, invariants, rest, zero, verdict = fields(claim, "claim", *SUBSYSTEM_CLAIM)
    number, size, *values = fields(witness, "witness", *SUBSYSTEM_WITNESS)
    s, n = reading.names(listed, "claim.subset", system.names), system.n
    others = evidence.complement(system, s)
    require(bool(s and others), "claim", "claim.subset", "expected a nonempty proper subset")
    B, C = evidence.inputs(system, others), evidence.outputs(system, s)
    f = [
        polynomial(g, "claim.invariant_polynomials", 1)
        for g in items(invariants, SUBSYSTEM_CLAIM[2])
    ]
    require(not any(poly_divide(g, h)[1] for h, g in pairwise(f)), "divisor", "claim", "no chain")
    a, k = integer(size, "witness.reachable"), integer(rank, "claim.normal_rank", n)
    v, free = a + sum(len(g) - 1 for g in f), n + B.ncols - k
    require(v <= n and free >= 0, "claim", "claim.normal_rank", "the dimensions do not fit")
    c, p, q = n - v, B.ncols, C.nrows
    shapes = [(n, v), (p, v), (a, v), (p, free), (a, free), (c, n), (c, q), (c, c)]
    X, F, A1, S, B1, L, G, N = reading.matrices(values, "witness", shapes)
    K = reduce(diagonal, map(_companion, f), Matrix.zeros(0, a))
    identities = {
        "A X + B F = X [A1; 0 K]": (system.A @ X + B @ F).equals(X @ stack([A1, K], v)),
        "B S = X1 B1": (B @ S).equals(X.take(cols=range(a)) @ B1),
        "[C; L] X = 0": (stack([C, L], n) @ X).is_zero(),
        "L = G C + N L A": L.equals(G @ C + N @ L @ system.A),
        "N L B = 0": (N @ L @ B).is_zero(),
        "N strictly lower triangular": not any(any(row[i:]) for i, row in enumerate(N.rows)),
    }
    for name, good in identities.items():
        require(good, "identity", "witness", f"expected {name}")
    ell = evidence.modulus(number, "witness.modulus")
    for M, least in ((X.T, v), (L, c), (S.T, free), (L @ B, k - n)):
        reached = rank_modulo(M, ell)
        require(reached == least, "rank", "witness", f"rank {reached} modulo l, not {least}")
    require_reached(replace(system, A=A1.take(cols=range(a)), B=[B1]), 0, ell, a)
    remnant = reduce(poly_product, f[: max(len(f) - (k - n), 0)], [Fraction(1)])
    claimed = polynomial(rest, "claim.remnant"), boolean(zero, "claim"), boolean(verdict, "claim")
    implied = remnant, k == n, k > n and len(remnant) == 1
    require(claimed == implied, "claim", "claim", "does not follow from the invariant polynomials")


def complementary_subsystem_statement(claim: Json, system: System) -> str:
    """The statement: the Smith form of the pencil, and what follows from it."""
    polynomials = ", ".join(map(polynomial_text, claim["invariant_polynomials"]))
    return (
        f"the pencil {PENCIL}, C the outputs of the channels {channel_set(claim['subset'])} and B "
        f"the inputs of the others, has normal rank {claim['normal_rank']}; its invariant "
        f"polynomials of degree at least 1 are {polynomials or 'none'}; the greatest common "
        f"divisor of its minors of order {system.n}, the remnant polynomial, is "
        f"{polynomial_text(claim['remnant'])}; C (xI - A)^-1 B is {denied(claim['transfer_zero'])}"
        f"zero; the complementary subsystem is {denied(claim['complete'])}complete"
    )


def _companion(p: list[Fraction]) -> Matrix:
    """Ones below the diagonal, −p in the last column."""
    d = math.lcm(*(c.denominator for c in p))
    rows = [[d * (i == j + 1) for j in range(len(p) - 2)] + [int(-c * d)] for i, c in enumerate(p)]
    return Matrix(rows[:-1], len(p) - 1, d)


# Kind ``exceptional_gains``: where [B, (M+gA)B, …] loses rank; ``proofs/exceptional_gains.md``.


def check_exceptional_gains(claim: Json, witness: Json, system: System) -> None:
    """Check a row at every root of each factor, and two determinants without other common roots.

    Theorems ``exceptional_gains.exceptional_lost``, ``exceptional_gains.exceptional_kept``.
    """
    rows, number, p, discs = fields(claim, "claim", "M", "blocks", "polynomial", "roots")
    modulus, listed, drawn = fields(witness, "witness", "modulus", "factors", "compressions")
    n, blocks = system.n, integer(number, "claim.blocks", 1)
    require(blocks <= max(n, 1), "blocks", "claim.blocks", f"expected at most {n}")
    M, B = matrix(rows, "claim.M", n, n), evidence.inputs(system, range(system.m))
    ell, parts = evidence.modulus(modulus, "witness.modulus"), (system.A, M, B, blocks)
    whole = reading.polynomial(p, "claim.polynomial")
    disjoint = roots.root_discs(discs, "claim.roots", whole)
    roots.require_real_or_not(disjoint, "claim.roots")
    place = "witness.factors"
    factors = [_lost_at(entry, place, *parts) for entry in items(listed, place)]
    require(reduce(poly_product, factors, [Fraction(1)]) == whole, "product", "claim", "no product")
    R = reading.matrices(drawn, "witness.compressions", [(blocks * B.ncols, n)] * 2)
    first, second = (_determinant(system.A, M, B, part, blocks) for part in R)
    require(any(first), "product", "witness.compressions", "the first determinant is zero")
    first = reduce(lambda left, f: exponent(f, left)[1], factors, first)
    # monic: a coefficient that only ℓ makes vanish could hide a common root
    first = [c / first[-1] for c in first]
    evidence.require_coprime(first, second, ell, "the rest of det(K R) and det(K R')")


def exceptional_gains_statement(claim: Json, system: System) -> str:
    """For which g the blocks lose rank."""
    n, k = system.n, claim["blocks"]
    M = canonical_json(matrix(claim["M"], "claim.M", n, n))
    discs = roots.disc_set(claim["roots"])
    return (
        f"the first {k} blocks of [B, (M + gA) B, (M + gA)^2 B, ...], B the inputs of all channels "
        f"and M the matrix with {with_digest(M)}, have rank below {n} exactly where g is a root of "
        f"{polynomial_text(claim['polynomial'])}; its roots are simple and lie one in each of the "
        f"discs {discs}, real ones where the disc is centered on the real axis, and only there"
    )


def _lost_at(value: Json, place: str, A: Matrix, M: Matrix, B: Matrix, blocks: int) -> Polynomial:
    """A factor f; a row with an entry 1 annihilates all blocks modulo f."""
    p, row, pivot = fields(value, place, "polynomial", "row", "pivot")
    f = reading.polynomial(p, f"{place}.polynomial", 1)
    w = reading.polynomial_matrix(row, f"{place}.row", 1, A.nrows, len(f) - 1)
    pivots = reading.positions([pivot], f"{place}.pivot", A.nrows)
    evidence.require_identity([layer.T for layer in w], pivots, f"{place}.pivot")
    for _ in budget.counted(range(blocks)):
        gone = all((layer @ B).is_zero() for layer in w)
        require(gone, "identity", f"{place}.row", "it does not annihilate every block")
        images = [Matrix.zeros(1, A.nrows), *(layer @ A for layer in w)]
        terms = zip(w, images, f, strict=False)
        w = [layer @ M + image - images[-1].times(c) for layer, image, c in terms]
    return f


def _determinant(A: Matrix, M: Matrix, B: Matrix, R: Matrix, blocks: int) -> Polynomial:
    """det([B, (M+gA)B, …] R), through its values at 0, 1, … (Newton).

    Theorem ``interpolation.determinant_by_values``.
    """
    result, basis = Polynomial(), [Fraction(1)]
    for g in budget.counted(range(A.nrows * (blocks - 1) + 1)):
        total = Matrix.zeros(A.nrows, A.nrows)
        for k in reversed(range(0, R.nrows, B.ncols or 1)):
            total = B @ R.take(range(k, k + B.ncols)) + (M + A.times(g)) @ total
        wanted = (-1) ** A.nrows * characteristic_polynomial(total)[0]
        longest = budget.limbs_of((wanted, *result, *basis))
        longest += g.bit_length() * len(basis) // budget.LIMB
        budget.spend(budget.fractions(8 * len(basis), longest))
        now, room = (sum(c * g**k for k, c in enumerate(p)) for p in (result, basis))
        slope = (wanted - now) / room
        result = [a + slope * b for a, b in zip([*result, Fraction(0)], basis, strict=True)]
        basis = poly_product(basis, [Fraction(-g), Fraction(1)])
    return stripped(result)


# Kind ``neighbor_graph``: whether it is strongly connected; ``proofs/neighbor_graph.md``.


def check_neighbor_graph(claim: Json, witness: Json, system: System) -> None:
    """Recompute the answer from the sets of neighbors.

    Theorem ``strong_components.strongly_connected_rule``.
    """
    (verdict,) = fields(claim, "claim", "strongly_connected")
    fields(witness, "witness")
    arcs = [(j, i) for i, N_i in enumerate(neighbors_of(system, "subject")) for j in N_i]
    connected = len(components(system.m, arcs)) <= 1
    place, answer = "claim.strongly_connected", f"{denied(connected)}strongly connected"
    require(boolean(verdict, place) == connected, "claim", place, f"the graph is {answer}")


def neighbor_graph_statement(claim: Json, system: System) -> str:
    """The statement: whether the neighbor graph is strongly connected."""
    return f"its neighbor graph is {denied(claim['strongly_connected'])}strongly connected"


def require_components(value: Json, place: str, system: System, parts: list[list[int]]) -> None:
    """Stop unless these sets of channels are the strong components of the transfer graph.

    Edges connect each of them, and in an order of them none leads from a later one to an earlier
    one.

    Theorem ``strong_components.ordered_components``.
    """
    keys = ("modulus", "arcs", "order", "zeros")
    number, listed, order, zeros = fields(value, place, *keys)
    triples = read_arcs(listed, f"{place}.arcs", system)
    require_arcs(system, triples, modulus(number, f"{place}.modulus"))
    connected = components(system.m, [(j, i) for j, i, _ in triples])
    require(connected == parts, "component", f"{place}.arcs", "not the sets that they connect")
    sequence = [integer(k, f"{place}.order") for k in items(order, f"{place}.order", len(parts))]
    once = sorted(sequence) == list(range(len(parts)))
    require(once, "order", f"{place}.order", "expected every component once")
    spend(PAIRS * (system.m**2 if len(parts) > 1 else 1))
    backwards, earlier = set[tuple[int, int]](), list[int]()
    for k in sequence:
        backwards |= {(j, i) for j in parts[k] for i in earlier}
        earlier += parts[k]
    require_no_edges(backwards, zeros, f"{place}.zeros", system)


# Kind ``single_channel_gains``: gains, or an obstruction; ``proofs/single_channel_gains.md``.

SIDES = ("controllable", "observable")
GAIN_PAIRS = dict(zip(SIDES, ("(A_F, B_q)", "(C_q, A_F)"), strict=True))
GAINS_CLAIM = ("channels", "property", "exists", "cyclic", "indices")
GAINS_WITNESS = ("gains", "modulus", "annihilators", "generator")


def check_single_channel_gains(claim: Json, witness: Json, system: System) -> None:
    """Check gains and their indices for yes; a mode or a cut out of reach of one channel for no.

    Theorem ``single_channel_gains.single_channel_yes``.
    """
    listed, wanted, verdict, spun, numbers = fields(claim, "claim", *GAINS_CLAIM)
    Q, cyclic = reading.names(listed, "claim.channels", system.names), boolean(spun, "claim.cyclic")
    sides = SIDES if wanted == "both" else (reading.string(wanted, "claim.property", *SIDES),)
    if not boolean(verdict, "claim.exists"):
        require(numbers is None and not cyclic, "claim", "claim", "without gains, no index")
        return _require_lost(witness, system, Q, sides)
    gains, modulus, rows, b = fields(witness, "witness", *GAINS_WITNESS)
    A_F = evidence.closed_loop(system, evidence.read_gains(gains, "witness.gains", system))
    closed, k, n = replace(system, A=A_F), len(sides), system.n
    ell = evidence.modulus(modulus, "witness.modulus")
    require(cyclic or b is None, "claim", "witness.generator", "expected null unless cyclic")
    if cyclic:
        require_reached(replace(closed, B=[matrix(b, "witness.generator", n, 1)]), 0, ell, n)
    indices = [items(part, "claim.indices", k) for part in items(numbers, "claim", len(Q))]
    rows = [items(part, "witness.annihilators", k) for part in items(rows, "witness", len(Q))]
    for q, pair, part in zip(Q, indices, rows, strict=True):
        for side, number, row in zip(sides, pair, part, strict=True):
            target, nu = _seen(closed, side), integer(number, "claim.indices")
            require_reached(target, q, ell, nu)
            w = matrix(row, "witness.annihilators", 1, n)
            require(nu == 0 or not w.is_zero(), "row", "witness.annihilators", "a row of zeros")
            for _ in range(nu - 1):
                gone = (w @ target.B[q]).is_zero()
                require(gone, "identity", "witness.annihilators", f"index below {nu} is open")
                w = w @ target.A


def single_channel_gains_statement(claim: Json, system: System) -> str:
    """The statement: through which channels some gains control or observe, or that none do."""
    wanted, listed = claim["property"], claim["channels"]
    sides = SIDES if wanted == "both" else (wanted,)
    goal = f"{' and '.join(f'{GAIN_PAIRS[side]} {side}' for side in sides)} for every q"
    among = f"{goal} in {channel_set(listed)}"
    if not claim["exists"]:
        return f"no constant gains F, the same for all q, make {among}"
    indices = canonical_json(dict(zip(listed, claim["indices"], strict=True)))
    end = ", and A_F cyclic" if claim["cyclic"] else ""
    start = f"some constant gains F, the same for all q, make {among}"
    return f"{start}, with the indices {indices}{end}"


def _seen(system: System, side: str) -> System:
    return system if side == "controllable" else dual(system, {}, "")


def _require_lost(witness: Json, system: System, Q: list[int], sides: tuple[str, ...]) -> None:
    """Check a mode or a cut out of reach of one channel.

    Theorems ``single_channel_gains.single_channel_no_mode``,
    ``single_channel_gains.single_channel_no_cut``.
    """
    cut = isinstance(witness, dict) and "zero" in witness
    keys = ("zero",) if cut else ("polynomial", "subspace")
    name, side, *parts = fields(witness, "witness", "channel", "side", *keys)
    q, side = system.place_of(name, "witness.channel"), reading.string(side, "witness.side", *sides)
    target = _seen(system, side)
    if cut:
        T, X = evidence.zero_transfer(parts[0], "witness.zero", target)
        C = evidence.outputs(target, evidence.complement(target, T))
        require(not C.is_zero() and (C @ X).is_zero(), "cut", "witness.zero", "C = 0 or C X is not")
    else:
        p = reading.polynomial(parts[0], "witness.polynomial", 1)
        T = evidence.Losses(target).checked(parts[1], "witness.subspace", p, 1)
    require(q in T and q in Q, "channel", "witness.channel", "not in the set T, or not asked about")
