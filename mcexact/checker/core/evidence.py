"""Proofs that modes are fixed, and that no more are.

- A mode is fixed: a `shrunk_subspace`, whose columns prove that a pencil P_s loses rank at every
  root of a polynomial p.  It may be one of the dual system, whose pencils are the transposes, or of
  some states on which nothing acts that they drive (`Losses`).
- No more is fixed, by two characteristic polynomials (`TwoPolynomials`): what is left of
  det(xI − A) after the named factors is coprime modulo ℓ to det(xI − A_F), so that the gains F
  move all of it.  Or ℓ is so large that modes other than roots of the factors are not roots of
  the factors modulo ℓ either; then no polynomial over Q is needed.
- No more is fixed, block by block (`Blocks`): the states are split so that no closed loop leads
  from a block to a later one.  For each block a Krylov sequence of one channel, two polynomials,
  or the number of its states bounds the degree of what divides det(xI − A_F) for all F.  The sum
  over the blocks must equal the degrees of the named factors, as often as they lose rank.  A
  Krylov sequence needs products of rows with a matrix, which are cheap where few entries are
  nonzero (`SparseStep`), above all on few diagonals (`DiagonalStep`).
- A channel does not reach another: an invariant subspace (`zero_transfer`), or no path through
  nonzero entries (`without_path`).  That it does is a Markov parameter that is not 0 modulo ℓ.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, chain, compress, count, zip_longest
from operator import add, itemgetter, mul
from typing import Any

from . import arithmetic, budget, reading
from .arithmetic import (
    Combination,
    Entry,
    Logarithms,
    Matrix,
    PackedRows,
    Polynomial,
    Rows,
    SparseMatrix,
    beside,
    by_coefficient,
    by_coefficient_units,
    byte_sum,
    characteristic_polynomial,
    convolution,
    coprime,
    entries_of,
    logarithms,
    most_addends,
    multiples,
    poly_modulo,
    rank,
    residues,
    stack,
    stripped,
)
from .budget import counted, spend
from .reading import (
    Json,
    fields,
    integer,
    items,
    matrices,
    matrix,
    names,
    polynomial_matrix,
    positions,
    require,
    shown,
)
from .system import System, canonical_json

# Rules that the evidence of several kinds shares; ``proofs/evidence.md``.


def inputs(system: System, channels: Iterable[int]) -> Matrix:
    """B_T, the inputs of these channels side by side."""
    return beside([system.B[i] for i in channels], system.n)


def outputs(system: System, channels: Iterable[int]) -> Matrix:
    """C_s, the outputs of these channels one above the other."""
    return stack([system.C[i] for i in channels], system.n)


def complement(system: System, channels: Iterable[int]) -> list[int]:
    """The channels of the system that are not in the set."""
    return sorted(set(range(system.m)) - set(channels))


def require_identity(layers: Sequence[Matrix], pivots: list[int], place: str) -> None:
    """Stop unless the rows ``pivots`` of Σ x^k layers[k] are those of the identity matrix.

    The columns are then independent for every x.
    """
    parts = [layer.take(pivots) for layer in layers]
    first = parts[0].equals(Matrix.unit_rows(len(pivots), 0, len(pivots)))
    good = first and all(M.is_zero() for M in parts[1:])
    require(good, "pivots", place, "expected an identity matrix there")


def annihilator(
    rows: Json, columns: Json, place: str, A: Matrix, inputs: Iterable[Matrix]
) -> tuple[Matrix, Matrix]:
    """Check that independent rows W satisfy W A = Z W and W B = 0, and return W and Z.

    Theorem ``controllability.uncontrollable_space``.
    """
    pivots = positions(columns, f"{place}.pivots", A.nrows)
    W = matrix(rows, f"{place}.annihilator", len(pivots), A.nrows)
    if not pivots:
        return W, Matrix.zeros(0, 0)
    require_identity([W.T], pivots, f"{place}.pivots")
    WA = W @ A
    Z = WA.take(cols=pivots)
    require(WA.equals(Z @ W), "identity", f"{place}.annihilator", "W A is not Z W")
    unmoved = all((W @ B).is_zero() for B in inputs)
    require(unmoved, "identity", f"{place}.annihilator", "W B is not zero")
    return W, Z


def closed_loop(system: System, gains: Sequence[Matrix]) -> Matrix:
    """A_F = A + Σ B_i F_i C_i."""
    left = beside([B @ F for B, F in zip(system.B, gains, strict=True)], system.n)
    return system.A + left @ outputs(system, range(system.m))


def read_gains(value: Json, place: str, system: System) -> list[Matrix]:
    """One F_i, p_i × q_i, for each channel."""
    shapes = [(B.ncols, C.nrows) for B, C in zip(system.B, system.C, strict=True)]
    return matrices(value, place, shapes)


def modulus(value: Json, place: str) -> int:
    """Read a modulus ℓ ≥ 2; a denominator that it divides stops the check later."""
    ell = integer(value, place, -math.inf)
    require(ell >= 2, "modulus", place, f"expected an integer from 2 on, found {shown(ell)}")
    return ell


def require_coprime(a: Polynomial, b: Polynomial, ell: int, what: str) -> None:
    """Stop unless two polynomials, the first one monic, are coprime modulo ℓ and so over Q.

    Theorems ``arithmetic.coprime_modulo``, ``arithmetic.no_common_root``.
    """
    parts = poly_modulo(a, ell), poly_modulo(b, ell)
    require(coprime(*parts, ell), "common_factor", "witness", f"{what} are not coprime modulo l")


# Shrunk subspaces and zero transfers; ``proofs/evidence.md``.


def require_pencil_kernel(
    A: Matrix, B: Matrix, U: list[Matrix], V: list[Matrix], p: Polynomial, place: str
) -> None:
    """Stop unless (xI − A) U = B V modulo p, U and V reduced modulo the monic p of degree ≥ 1.

    Theorem ``deficiency.pencil_rank_upper``.
    """
    top = U[-1]  # (xI − A)U − BV has degree ≤ deg p, so it must be p·top exactly
    for t, (U_t, V_t) in enumerate(zip(U, V, strict=True)):
        left = A @ U_t + B @ V_t + top.times(p[t])
        shifted = U[t - 1] if t else Matrix.zeros(U_t.nrows, U_t.ncols)
        require(shifted.equals(left), "identity", place, "(xI - A) U differs from B V modulo p")


def shrunk_subspace(
    value: Json, place: str, system: System, p: Polynomial, deficiency: int
) -> list[int]:
    """Check a shrunk subspace of at least this deficiency ≥ 1 for p, and return its T.

    Theorems ``evidence.shrunk_subspace_fixed``, ``evidence.shrunk_subspace_fixed_dynamic``,
    ``evidence.shrunk_subspace_rank``, ``evidence.shrunk_subspace_dynamic``,
    ``evidence.shrunk_subspace_pencil``.
    """
    chosen, U_layers, V_layers, listed = fields(value, place, "channels_T", "U", "V", "pivots")
    T = names(chosen, f"{place}.channels_T", system.names)
    pivots = positions(listed, f"{place}.pivots", system.n)
    u, B_T = len(pivots), inputs(system, T)
    U = polynomial_matrix(U_layers, f"{place}.U", system.n, u, len(p) - 1)
    V = polynomial_matrix(V_layers, f"{place}.V", B_T.ncols, u, len(p) - 1)
    require_identity(U, pivots, f"{place}.pivots")
    require_pencil_kernel(system.A, B_T, U, V, p, place)
    for i in complement(system, T):
        unseen = all((system.C[i] @ layer).is_zero() for layer in U)
        require(unseen, "identity", place, f"C_i U is not zero for channel number {i + 1}")
    lost = u - rank(B_T)
    message = f"proves deficiency {lost}, not {deficiency} >= 1"
    require(lost >= deficiency >= 1, "rank", place, message)
    return T


def _loss(value: Json, place: str, system: System, p: Polynomial, deficiency: int) -> list[int]:
    """Check a shrunk subspace of the system or of the dual system, and return its T.

    P_s is the transpose of the pencil of the dual system for the complement of s.

    Theorem ``dual_subspace.dual_subspace_loss``.
    """
    if not (isinstance(value, Mapping) and "dual" in value):
        return shrunk_subspace(value, place, system, p, deficiency)
    listed, inner = fields(value, place, "channels_T", "dual")
    B, C = [M.T for M in system.C], [M.T for M in system.B]
    turned = System(system.time, system.names, system.A.T, B, C)
    T = complement(system, shrunk_subspace(inner, f"{place}.dual", turned, p, deficiency))
    same = names(listed, f"{place}.channels_T", system.names) == T
    require(same, "claim", place, "T is not the complement of that of the dual system")
    return T


class Losses:
    """Proofs that pencils of one system lose rank, each by a shrunk subspace.

    It is one of the whole system or of its dual, or one of the system of some states: these may
    drive others, but nothing that they drive acts on them.
    """

    def __init__(self, system: System) -> None:
        self.system = system

    def checked(self, value: Json, place: str, p: Polynomial, deficiency: int) -> list[int]:
        """Stop unless P_s loses at least this rank at every root of p, and return T = m − s."""
        if isinstance(value, Mapping) and "states" in value:
            return self._local_subspace(value, place, p, deficiency)
        return _loss(value, place, self.system, p, deficiency)

    def _local_subspace(self, value: Json, place: str, p: Polynomial, deficiency: int) -> list[int]:
        """Check a shrunk subspace of the system of some states Z, or of the dual of that system.

        With D the other states that Z drives, the columns of U and of the identity for D are mapped
        by xI − A into the span of the latter and of the rows of B_T for Z.  In the dual system the
        states that are neither in Z nor in D are in place of D.

        Theorems ``local_subspace.shrunk_subspace_local``, ``dual_subspace.dual_subspace_local``.
        """
        chosen, listed, inner = fields(value, place, "states", "channels_T", "subspace")
        states = positions(chosen, f"{place}.states", self.system.n)
        seeing, acting = self._channels(set(states), place)
        part = _part(self.system, states, acting)
        inside = _loss(inner, f"{place}.subspace", part, p, deficiency)
        T = sorted(seeing.difference(acting).union(acting[k] for k in inside))
        same = names(listed, f"{place}.channels_T", self.system.names) == T
        require(same, "claim", place, "T is not the channels that see what the states drive")
        return T

    def _channels(self, states: set[int], place: str) -> tuple[set[int], list[int]]:
        """The channels that see the states or what these drive, and those that act within them."""
        found, rest, seeing = {*states}, [*states], set[int]()
        while rest:
            b = rest.pop()
            spend(20 + 4 * len(self._driven[b]))
            heard = self._heard[b] - seeing
            seeing |= heard
            new = self._driven[b].union(*(self._entered[i] for i in heard))
            within = any(not states.isdisjoint(self._entered[i]) for i in self._heard[b])
            returns = within or not states.isdisjoint(new)
            require(b in states or not returns, "path", place, "what the states drive acts on them")
            rest += new - found
            found |= new
        return seeing, sorted(i for i in seeing if not states.isdisjoint(self._entered[i]))

    @cached_property
    def _driven(self) -> list[set[int]]:
        """For each state b the states a with A_ab ≠ 0."""
        entries = entries_of(self.system.A)
        spend(60 * (len(entries) + self.system.n))
        driven: list[set[int]] = [set() for _ in range(self.system.n)]
        for a, b, _ in entries:
            driven[b].add(a)
        return driven

    @cached_property
    def _heard(self) -> list[set[int]]:
        """For each state the channels whose outputs see it."""
        spend(60 * self.system.n)
        heard: list[set[int]] = [set() for _ in range(self.system.n)]
        for i, C in enumerate(self.system.C):
            for _, b, _ in entries_of(C):
                heard[b].add(i)
        return heard

    @cached_property
    def _entered(self) -> list[set[int]]:
        """For each channel the states on which its inputs act."""
        return [{a for a, _, _ in entries_of(B)} for B in self.system.B]


def zero_transfer(value: Json, place: str, system: System) -> tuple[list[int], Matrix]:
    """Check that im X is A-invariant and holds im B_j for the channels j, and return j's and X.

    Theorems ``transfer_graph.zero_transfer_no_arc``, ``transfer_graph.zero_transfer_cut``.
    """
    chosen, X_rows, listed = fields(value, place, "from", "X", "pivots")
    sources = names(chosen, f"{place}.from", system.names)
    pivots = positions(listed, f"{place}.pivots", system.n)
    X = matrix(X_rows, f"{place}.X", system.n, len(pivots))
    require_identity([X], pivots, f"{place}.pivots")
    for image, what in ((system.A @ X, "A X"), (inputs(system, sources), "B")):
        inside = image.equals(X @ image.take(pivots))
        require(inside, "identity", place, f"the columns of {what} leave the span of X")
    return sources, X


# Paths from inputs to outputs through entries that are not 0; ``proofs/transfer_graph.md``.


def without_path(system: System, pairs: Iterable[tuple[int, int]]) -> set[tuple[int, int]]:
    """Those pairs (j, i) for which no path leads from an input of j to an output of i.

    The states on the paths from j span an A-invariant subspace that contains im B_j, and C_i is 0
    there.

    Theorem ``transfer_graph.closed_states_no_arc``.
    """
    reached = [0] * system.n  # sets of channels, as bits
    for j, B in enumerate(system.B):
        for a, _, _ in entries_of(B):
            reached[a] |= 1 << j
    arcs = entries_of(system.A)
    before: list[int] = []
    while reached != before:
        spend(40 * (len(arcs) + system.n) + (len(arcs) + system.n) * system.m // 100)
        before = list(reached)
        for a, b, _ in arcs:
            reached[a] |= reached[b]
        arcs = arcs[::-1]
    seen = [0] * system.m
    for i, C in enumerate(system.C):
        for _, b, _ in entries_of(C):
            seen[i] |= reached[b]
    return {(j, i) for j, i in pairs if not seen[i] >> j & 1}


def require_cut(value: Json, place: str, system: System) -> None:
    """Stop unless some but not all channels are named, from which no path leads to another one.

    Theorem ``transfer_graph.closed_states_no_arc``.
    """
    sources = names(value, place, system.names)
    rest = complement(system, sources)
    require(bool(sources and rest), "cut", place, "expected a nonempty proper set")
    arcs = entries_of(system.A)
    spend(60 * (len(arcs) + system.n))
    driven: list[list[int]] = [[] for _ in range(system.n)]
    for a, b, _ in arcs:
        driven[b].append(a)
    reached = {a for j in sources for a, _, _ in entries_of(system.B[j])}
    left = [*reached]
    while left:
        new = set(driven[left.pop()]) - reached
        reached |= new
        left += new
    for i in rest:
        seen = any(b in reached for _, b, _ in entries_of(system.C[i]))
        require(not seen, "path", place, f"a path leads to channel number {i + 1}")


# Markov parameters of all channels at once, modulo a byte; ``proofs/transfer_graph.md``.

Triples = list[tuple[int, int, int]]
"""Edges (j, i) with a power k each."""


def unseen(system: System, triples: Triples, ell: int) -> tuple[int, int, int] | None:
    """A claimed edge (j, i, k) with C_i A^k B_j = 0 modulo ℓ, or None; ℓ is at most ``SMALL``.

    Each row of A^k [B_1 … B_m] is one long integer, with a byte for each column; rows that no later
    edge needs are left out.

    Theorem ``transfer_graph.arc_rule``.
    """
    sizes = [0, *accumulate(B.ncols for B in system.B)]
    width, power = sizes[-1], _inputs(system, sizes, ell)
    wanted: dict[int, dict[int, list[int]]] = {}
    for j, i, k in triples:
        wanted.setdefault(k, {}).setdefault(i, []).append(j)
    last = _last_steps(system, triples)
    spend(100 * system.n)
    A = SparseProduct(residues_by_row(system.A, ell), width, ell)
    outputs = [SparseProduct(residues_by_row(C, ell), width, ell) for C in system.C]
    for k in counted(range(max(wanted, default=-1) + 1)):
        for i, sources in wanted.get(k, {}).items():
            spend(len(outputs[i].lines) * (8 + width // 8))
            seen = [x.to_bytes(width, "little") for x in outputs[i](power)]
            spend(sum(40 + system.B[j].ncols * len(seen) for j in sources))
            for j in sources:
                if not any(any(row[sizes[j] : sizes[j + 1]]) for row in seen):
                    return j, i, k
        power = A(power, [step > k for step in last])
    return None


def _last_steps(system: System, triples: Triples) -> list[int]:
    """For each state a the largest k from 1 on with row a of A^k B in a claimed edge, or less.

    Row a of A^k B is in the output C_i A^(k+l) B if a path of l arcs leads from a to it.
    """
    last, largest = [-1] * system.n, dict[int, int]()
    for _, i, k in triples:
        largest[i] = max(largest.get(i, 0), k)
    top = max(largest.values(), default=0)
    states: list[list[int]] = [[] for _ in range(top + 1)]
    for i, k in largest.items():
        for _, b, _ in entries_of(system.C[i]):
            last[b] = max(last[b], k)
            states[k].append(b)
    steps = range(top, 1, -1)
    lines = by_row(entries_of(system.A), system.n) if steps else []
    for k in steps:
        spend(60 * len(states[k]))
        for a in states[k]:
            if last[a] == k:
                for b, _ in lines[a]:
                    if last[b] < k - 1:
                        last[b] = k - 1
                        states[k - 1].append(b)
    return last


def _inputs(system: System, sizes: list[int], ell: int) -> list[int]:
    """The rows of [B_1 … B_m] modulo ℓ, a byte for each column."""
    spend(system.n * (64 + sizes[-1]))
    rows = [0] * system.n
    for B, start in zip(system.B, sizes, strict=False):
        for a, u, x in residues(B, ell):
            rows[a] |= x << 8 * (start + u)
    return rows


Line = list[tuple[int, int]]
"""The columns of the entries of a row, with the entries."""


def by_row(entries: list[Entry], nrows: int) -> list[Line]:
    """The rows of a matrix that is given by its entries."""
    spend(100 * (len(entries) + nrows))
    lines: list[Line] = [[] for _ in range(nrows)]
    for i, j, x in entries:
        lines[i].append((j, x))
    return lines


def residues_by_row(M: Matrix, ell: int) -> list[Line]:
    """The entries modulo ℓ of each row of a matrix."""
    if isinstance(M, SparseMatrix):
        return by_row(residues(M, ell), M.nrows)
    spend(40 * M.nrows * M.ncols)
    return [[*zip(compress(count(), row), filter(None, row), strict=True)] for row in M.modulo(ell)]


def _getter(places: Sequence[int]) -> Callable[[Any], Sequence[Any]]:
    """What takes the entries of a sequence at these places, as a tuple or a slice."""
    if len(places) > 1:
        return itemgetter(*places)
    return itemgetter(slice(places[0], places[0] + 1) if places else slice(0))


class SparseProduct:
    """The product of a sparse matrix with one of ``width`` columns, modulo ℓ ≤ ``SMALL``.

    A row is one long integer, with a byte for each column.  Multiples of rows are added as long as
    a byte holds their sum; those of long lines are added by coefficient.
    """

    def __init__(self, lines: list[Line], width: int, ell: int) -> None:
        self.width, self.ell, most = width, ell, most_addends(ell)
        nrows, entries = len(lines), sum(map(len, lines))
        spend(100 * (entries + nrows))
        units = nrows * (60 + width // 8) + entries * (20 + width // 16)
        self.lines: list[tuple[Any, list[int], bool]] = []
        for line in lines:
            xs = [x for _, x in line]
            simple = sum(xs) <= most
            units += (
                0
                if simple
                else min(len(line) * (40 + width // 8), by_coefficient_units(len(line), width, ell))
            )
            self.lines.append((_getter([j for j, _ in line]), xs, simple))
        self.units = units // max(nrows, 1)

    def __call__(self, power: list[int], needed: Sequence[bool] | None = None) -> list[int]:
        """The rows of the product, 0 for those not needed; the rows of the factor are ``power``."""
        needed = [True] * len(self.lines) if needed is None else needed
        spend((1 + sum(needed)) * self.units + len(needed))
        of, width, table = int.from_bytes, self.width, multiples(self.ell)[1]
        return [
            0
            if not taken
            else of(
                sum(map(mul, xs, gather(power))).to_bytes(width, "little").translate(table),
                "little",
            )
            if simple
            else self._in_parts(xs, gather(power))
            for taken, (gather, xs, simple) in zip(needed, self.lines, strict=True)
        ]

    def _in_parts(self, xs: list[int], rows: Sequence[int]) -> int:
        """The sum of multiples of rows that a byte does not hold."""
        width, ell, most = self.width, self.ell, most_addends(self.ell)
        if len(xs) > 2 * ell:
            parts = by_coefficient(zip(xs, rows, strict=True), width, ell)
            return int.from_bytes(byte_sum(parts, width, ell), "little")

        def reduced(total: int, factor: int = 1) -> int:
            data = total.to_bytes(width, "little").translate(multiples(ell)[factor])
            return int.from_bytes(data, "little")

        total, room = 0, most
        for x, row in zip(xs, rows, strict=True):
            term, size = (x * row, x) if x < most else (reduced(row, x), 1)
            if size > room:
                total, room = reduced(total), most - 1
            total, room = total + term, room - size
        return reduced(total)


# Products of a row with a matrix of few entries, modulo ℓ.

LONG = 32
"""Columns of more entries are added up one by one."""


class SparseStep:
    """u ↦ uM modulo ℓ for an n × n matrix M, given by its residues that are not 0.

    The entries come in layers: of the columns of at most ``LONG`` of them, those with the most
    first, all first entries, then the second ones of those columns that have two, and so on.  The
    entries of u are in that ``order`` of the columns, unless they are ``in_place``; then the
    product has only those of the ``columns`` that are not 0.  Modulo a small prime u is bytes, and
    products are sums of logarithms.
    """

    def __init__(self, entries: Sequence[Entry], n: int, ell: int, in_place: bool = False) -> None:
        self.ell, self.n = ell, n
        spend(300 * (len(entries) + n))
        self.tables = logarithms(ell)
        columns: list[list[tuple[int, int]]] = [[] for _ in range(n)]
        for i, j, x in entries:
            columns[j].append((i, x))
        sizes = [(len(column) > LONG, -len(column), j) for j, column in enumerate(columns)]
        self.columns = [j for _, many, j in sorted(sizes) if many or not in_place]
        self.order = list(range(n)) if in_place else self.columns
        place = {j: k for k, j in enumerate(self.order)}
        ordered = [[(place[i], x) for i, x in columns[j]] for j in self.columns]
        short = [column for column in ordered if len(column) <= LONG]
        self.short = len(short)
        self.layers: list[tuple[Any, int, Any]] = []
        for e in range(len(short[0]) if short else 0):
            layer = [column[e] for column in short if len(column) > e]
            xs = [x for _, x in layer]
            factors = self.tables.packed(xs) if self.tables else xs
            self.layers.append((_getter([i for i, _ in layer]), len(layer), factors))
        self.long = [
            (itemgetter(*(i for i, _ in column)), [x for _, x in column])
            for column in ordered[self.short :]
        ]
        self.units = 1000 + len(entries) * (1 if self.tables else 4)

    def start(self, row: Sequence[int]) -> Sequence[int]:
        """A row with its entries in ``order``, as `__call__` takes it."""
        placed = [row[j] for j in self.order]
        return bytes(placed) if self.tables else placed

    def __call__(self, u: Sequence[int]) -> Sequence[int]:
        """The product of a row with M; it takes ``units`` of work, which the caller charges."""
        long = [sum(map(mul, gather(u), xs)) % self.ell for gather, xs in self.long]
        if self.tables:
            return self._added(bytes(u), self.tables) + bytes(long)
        total = [0] * self.short
        for gather, many, xs in self.layers:
            total[:many] = map(add, total, map(mul, gather(u), xs))
        return [x % self.ell for x in total] + long

    def _added(self, u: bytes, tables: Logarithms) -> bytes:
        """The same of bytes, for the columns in layers: sums of logarithms are products."""
        logs = u.translate(tables.of)
        layers = (
            tables.products(int.from_bytes(bytes(gather(logs)), "little") + of, many)
            for gather, many, of in self.layers
        )
        return byte_sum(layers, self.short, self.ell)


FULL = 12
"""A diagonal of at least n / 12 entries is multiplied as a whole."""
WHOLE = (3, 7, 31)
"""The primes 2^b − 1 modulo which a row is one long integer, with a byte for each entry."""


class DiagonalStep:
    """u ↦ uM for a matrix with full diagonals, modulo an ℓ of ``WHOLE``, u one long integer.

    An entry of u is from 0 to ℓ, which stands for 0.  A full diagonal multiplies a shifted u, bit
    by bit of its entries: each bit has a mask, with 255 where it is set.  As 2^b = 1, a byte is
    reduced by adding what is above its lowest b bits to these (`_folded`).  The other entries are
    those of a `SparseStep`.
    """

    def __init__(self, entries: Sequence[Entry], n: int, ell: int) -> None:
        self.n, self.ell, self.bits = n, ell, ell.bit_length()
        spend(300 * (len(entries) + n))
        full = {k: bytearray(n) for k in full_diagonals(entries, n)}
        rest: list[Entry] = []
        for i, j, x in entries:
            if i - j in full:
                full[i - j][j] = x
            else:
                rest.append((i, j, x))
        tables = [bytes(255 * (x >> b & 1) for x in range(256)) for b in range(self.bits)]
        spend(len(full) * self.bits * (100 + n))
        self.diagonals = [
            (8 * k, [int.from_bytes(row.translate(table), "little") for table in tables])
            for k, row in full.items()
        ]
        self.low, above = int.from_bytes(bytes([ell]) * n, "little"), 255 >> self.bits
        self.high = int.from_bytes(bytes([above]) * n, "little")
        # twice a folded byte, and so many terms, are a byte
        folded = ell + above
        self.most, self.again = (255 - 2 * folded) // ell, -(-folded // ell)
        self.folds, bound = 0, folded + ell
        while bound > ell:
            bound = max((x & ell) + (x >> self.bits) for x in range(bound + 1))
            self.folds += 1
        self.rest = SparseStep(rest, n, ell, in_place=True) if rest else None
        self.units = 1000 + n * self.bits * (len(full) + 4) // 40
        self.units += n // 4 + self.rest.units if self.rest else 0

    def start(self, row: Sequence[int]) -> int:
        """A row of residues as `__call__` takes it."""
        return int.from_bytes(bytes(row), "little")

    def residues(self, u: int) -> bytes:
        """The residues of a row."""
        return u.to_bytes(self.n, "little").translate(multiples(self.ell)[1])

    def __call__(self, u: int) -> int:
        """The product of a row with M; it takes ``units`` of work, which the caller charges."""
        sums, room, total = [0] * self.bits, self.most, 0
        for shift, masks in self.diagonals:
            if not room:
                sums, room = [self._folded(x) for x in sums], self.most - self.again
            moved = u >> shift if shift >= 0 else u << -shift
            sums = [x + (moved & mask) for x, mask in zip(sums, masks, strict=True)]
            room -= 1
        for x in reversed(sums):
            total = self._folded(total + total + x)
        if self.rest:
            row = bytearray(self.n)
            for j, x in zip(self.rest.columns, self.rest(self.residues(u)), strict=True):
                row[j] = x
            total += int.from_bytes(row, "little")
        for _ in range(self.folds):
            total = self._folded(total)
        return total

    def _folded(self, total: int) -> int:
        """Bytes that are the same modulo ℓ, and at most ℓ + 255 / 2^b."""
        return (total & self.low) + (total >> self.bits & self.high)


def full_diagonals(entries: Sequence[Entry], n: int) -> list[int]:
    """The differences i − j that at least n / ``FULL`` of the entries have."""
    spend(100 * len(entries))
    often = Counter(i - j for i, j, _ in entries)
    return sorted(k for k, many in often.items() if FULL * many >= n)


def loop_entries(system: System, gains: Sequence[Matrix], ell: int) -> list[Entry] | None:
    """The residues of A + Σ B_i F_i C_i that are not 0; None if there may be many, for some F."""
    A, n = system.A, system.n
    if not isinstance(A, SparseMatrix):
        return None
    ports = [(entries_of(B), entries_of(C)) for B, C in zip(system.B, system.C, strict=True)]
    most = len(A.entries) + sum(len(B) * len(C) for B, C in ports)
    if arithmetic.SHARE * most > n * n:
        return None
    spend(200 * (most + system.m))
    entries = {(i, j): x for i, j, x in residues(A, ell)}
    for B, F, C in zip(system.B, gains, system.C, strict=True):
        seen, inputs = residues_by_row(C, ell), residues(B, ell)
        gain = residues_by_row(F, ell)
        for a, g, x in inputs:
            for h, f in gain[g]:
                for b, y in seen[h]:
                    entries[a, b] = (entries.get((a, b), 0) + x * f * y) % ell
    return [(i, j, x) for (i, j), x in entries.items() if x]


# An upper bound on the number of fixed modes, by one Krylov sequence; ``proofs/krylov.md``.

Row = Sequence[int]

KEYS = ("modulus", "gains", "channel", "inputs", "outputs", "recurrence", "cofactors")


def unmoved_degree(value: Json, place: str, system: System) -> int:
    """n − L, the most degrees of a common divisor of det(xI − A_F) for all F.

    With b = B_q x, c = y C_q and s_k = c A_F^k b, the monic d of degree L modulo ℓ satisfies
    Σ_j d_j s_{k+j} = 0 for k < L − 1, and a·num + e·d = 1, num the polynomial part of
    d·Σ s_k x^{−k−1}.

    Theorem ``krylov.krylov_bounded``.
    """
    number, gains, name, *lists, pair = fields(value, place, *KEYS)
    ell = modulus(number, f"{place}.modulus")
    F = read_gains(gains, f"{place}.gains", system)
    q = system.place_of(name, f"{place}.channel")
    x, y, d = (_residues(entry, place, ell) for entry in lists)
    a, e = (_residues(entry, place, ell) for entry in items(pair, f"{place}.cofactors", 2))
    items(x, f"{place}.inputs", system.B[q].ncols)
    items(y, f"{place}.outputs", system.C[q].nrows)
    require(d[-1:] == [1], "monic", f"{place}.recurrence", "expected a monic polynomial")
    L, n = len(d) - 1, system.n
    b, c = [0] * n, [0] * n
    for i, j, entry in arithmetic.residues(system.B[q], ell):
        b[i] = (b[i] + entry * x[j]) % ell
    for i, j, entry in arithmetic.residues(system.C[q], ell):
        c[j] = (c[j] + y[i] * entry) % ell
    s = _numbers(system, F, ell, b, c, d)
    if s[L:]:
        holds = not any(convolution(d, s[::-1], ell)[L : 2 * L - 1])
        require(holds, "recurrence", f"{place}.recurrence", "the sequence does not satisfy it")
    num = convolution(d, s[:L][::-1], ell)[L:]
    sums = zip_longest(convolution(a, num, ell), convolution(e, d, ell), fillvalue=0)
    one = stripped([(f + g) % ell for f, g in sums]) == [1]
    require(one, "common_factor", f"{place}.cofactors", "a num + e d is not 1 modulo l")
    return n - L


def _numbers(
    system: System, gains: Sequence[Matrix], ell: int, b: Row, c: Row, d: Row
) -> list[int]:
    """s_k for k < L, if Σ_k d_k c A_F^k = 0: then the recurrence holds; otherwise for k < 2L − 1.

    Theorem ``krylov_sequence.annihilated_recurrence``.
    """
    L, s, total = len(d) - 1, [], Combination(system.n, ell)
    advance, u, units = _steps(system, gains, ell, b, c)
    spend(L * units)
    for k in counted(range(L)):
        total.add(d[k], u)
        u, number = advance(u)
        s.append(number)
    total.add(1, u)
    if not total.is_zero():
        spend(L * units)
        for _ in counted(range(L - 1)):
            u, number = advance(u)
            s.append(number)
    return s


def _steps(
    system: System, gains: Sequence[Matrix], ell: int, b: Row, c: Row
) -> tuple[Callable[[Any], tuple[Any, int]], Any, int]:
    """The step u ↦ (u A_F, u b) modulo ℓ, its first u = c, and the units that a caller charges.

    What stands for u depends on the entries of A_F; a `Combination` takes all of them.
    """
    n, entries = system.n, loop_entries(system, gains, ell)
    if entries is None:
        pairs = zip(krylov_loop(system, gains, ell), b, strict=True)
        rows = PackedRows([[*row, entry] for row, entry in pairs], n + 1, ell)

        def dense(u: Row) -> tuple[Row, int]:
            *product, last = rows.combined(u)
            return product, last

        return dense, c, 0
    if ell in WHOLE and full_diagonals(entries, n):
        whole, active = DiagonalStep(entries, n, ell), [(k, f) for k, f in enumerate(b) if f]

        def by_diagonals(u: int) -> tuple[int, int]:
            data = u.to_bytes(n, "little")
            return whole(u), sum(data[k] * f for k, f in active) % ell

        return by_diagonals, whole.start(c), whole.units + n // 20 + 2 * len(active)
    step = SparseStep(entries, n, ell)
    seen = [(k, b[j]) for k, j in enumerate(step.order) if b[j]]

    def gathered(u: Row) -> tuple[Row, int]:
        return step(u), sum(u[k] * f for k, f in seen) % ell

    return gathered, step.start(c), step.units + 2 * len(seen)


def _residues(value: Json, place: str, ell: int) -> list[int]:
    """Read a list of integers ≥ 0, and reduce them modulo ℓ."""
    numbers = [integer(entry, place) for entry in items(value, place)]
    spend(budget.reductions(len(numbers), budget.limbs(numbers), budget.limbs([ell])))
    return [number % ell for number in numbers]


def krylov_loop(system: System, gains: Sequence[Matrix], ell: int) -> Rows:
    """A + Σ B_i F_i C_i modulo ℓ, which is coprime to every denominator."""
    n, fed = system.n, []
    for F, C in zip(gains, system.C, strict=True):
        outputs = PackedRows(C.modulo(ell), n, ell)
        fed += [outputs.combined(row) for row in F.modulo(ell)]
    fed_rows, B = PackedRows(fed, n, ell), inputs(system, range(system.m)).modulo(ell)
    spend(budget.products(n * n, budget.limbs([ell]), 1))
    return [
        [(left + right) % ell for left, right in zip(row, fed_rows.combined(u), strict=True)]
        for row, u in zip(system.A.modulo(ell), B, strict=True)
    ]


# Blocks of states, each with evidence of its own; ``proofs/krylov.md``, K8.


def split(value: Json, place: str, system: System) -> list[tuple[str, System, Json]]:
    """The systems of the blocks, each with the channels that act within it, and their evidence.

    Every state is in one block, and no closed loop leads from a block to a later one.

    Theorems ``blocks.block_bounded``, ``fixed_bound.bounded_channels``.
    """
    listed, states, n = [], [], system.n
    for k, entry in enumerate(items(value, place)):
        where = f"{place}[{k}]"
        chosen, proof = fields(entry, where, "states", "evidence")
        spend(20 * len(items(chosen, f"{where}.states")))
        states.append(positions(chosen, f"{where}.states", n))
        listed.append((f"{where}.evidence", proof))
    once = sorted(chain(*states)) == list(range(n))
    require(once, "partition", place, "expected every state in one block")
    at = {a: k for k, block in enumerate(states) for a in block}
    within = _channels(system, at, place, len(states))
    entered = set() if len(states) < 2 else _entered(system, at)
    parts: list[tuple[str, System, Json]] = []
    turns = zip(counted(states), within, listed, strict=True)
    for k, (block, acting, (where, proof)) in enumerate(turns):
        require(k not in entered, "order", where, "an earlier block acts on it")
        parts.append((where, _part(system, block, acting), proof))
    return parts


def _entered(system: System, at: dict[int, int]) -> set[int]:
    """The positions of the blocks on which an earlier block acts."""
    entries = arithmetic.entries_of(system.A)
    spend(8 * len(entries))
    return {at[a] for a, b, _ in entries if at[b] < at[a]}


def _channels(system: System, at: dict[int, int], place: str, count: int) -> list[list[int]]:
    """For each block the channels that have inputs and outputs in it."""
    ports = list(enumerate(zip(system.B, system.C, strict=True)))
    if count == 1:
        return [[i for i, (B, C) in ports if not (B.is_zero() or C.is_zero())]]
    acting: list[list[int]] = [[] for _ in range(count)]
    for i, (B, C) in ports:
        driven = [at[a] for a, _, _ in arithmetic.entries_of(B)]
        seen = [at[b] for _, b, _ in arithmetic.entries_of(C)]
        spend(8 * (len(driven) + len(seen)))
        if driven and seen:
            message = f"channel number {i + 1} leads to a later block"
            require(max(driven) <= min(seen), "order", place, message)
            if max(driven) == min(seen):
                acting[min(seen)].append(i)
    return acting


def _part(system: System, block: list[int], acting: list[int]) -> System:
    """The system of the states in a block, with the channels that act within it."""
    spend(40 * len(block))
    places = None if len(block) == system.n else {a: k for k, a in enumerate(block)}
    B = [arithmetic.within(system.B[i], places, None) for i in acting]
    C = [arithmetic.within(system.C[i], None, places) for i in acting]
    named = [system.names[i] for i in acting]
    return System(system.time, named, arithmetic.within(system.A, places, places), B, C)


# Proofs that no more is fixed than the factors named; ``proofs/krylov.md``, ``evidence.md``.

Loss = tuple[Polynomial, int]
"""A factor, and by how much the rank of a pencil is less at its roots."""


def by_blocks(witness: Json) -> bool:
    """Whether the evidence is block by block; else it is two characteristic polynomials."""
    return isinstance(witness, Mapping) and "blocks" in witness


class Blocks:
    """Proof, block by block, that at most ``left`` modes are fixed."""

    def __init__(self, value: Json, place: str, system: System, number: Json = None) -> None:
        self.place, self.number = f"{place}.blocks", number

        def left() -> int:
            parts = split(value, self.place, system)
            return sum(_left(proof, where, part) for where, part, proof in counted(parts))

        self.left: int = system.kept(("blocks", canonical_json(value)), left)

    @property
    def ell(self) -> int:
        """The modulus ℓ modulo which factors have to be coprime."""
        return modulus(self.number, "witness.modulus")

    def multiplicity(self, p: Polynomial, loss: int) -> int:
        """The multiplicity of a factor: its loss of rank; stop if it may have multiple roots."""
        derivative = [k * c for k, c in enumerate(p)][1:]
        require_coprime(p, derivative, self.ell, "a factor and its derivative")
        return loss

    def require_no_more(self, losses: list[Loss]) -> None:
        """Stop unless the factors, as often as they lose rank, are all that is left.

        Theorems ``fixed_bound.bounded_absence``, ``fixed_bound.bounded_rule``,
        ``fixed_bound.bounded_fixed``, ``fixed_bound.bounded_rank``.
        """
        if not losses:
            require(self.number is None, "claim", "witness.modulus", "expected null: no factors")
        more = self.left - sum(loss * (len(p) - 1) for p, loss in losses)
        require(more == 0, "degree", self.place, f"{more} more modes may be fixed")


def _left(proof: Json, place: str, block: System) -> int:
    """The most degrees of a common divisor of det(xI − A_F) for all F, by the evidence of a block.

    Theorems ``fixed_bound.nothing_bounded``, ``fixed_bound.coprime_bounded``.
    """
    if proof is None:
        return block.n
    if isinstance(proof, Mapping) and "channel" in proof:
        return unmoved_degree(proof, place, block)
    gains, number = fields(proof, place, "gains", "modulus")
    TwoPolynomials(gains, number, place, block).require_moved([])
    return 0


SQUARES = 3
"""How often a matrix is squared to bound its eigenvalues by the norm of its power."""


class TwoPolynomials:
    """Proof that gains move every root of det(xI − A) besides those of the named factors."""

    def __init__(self, gains: Json, number: Json, place: str, system: System) -> None:
        self.ell, self.A = modulus(number, f"{place}.modulus"), system.A
        F = read_gains(gains, f"{place}.gains", system)
        self.A_F = closed_loop(system, F)
        self.chi_F = characteristic_polynomial(self.A_F, self.ell)

    def multiplicity(self, p: Polynomial, loss: int) -> int:
        """How often a factor occurs in det(xI − A_F) modulo ℓ, and so at most in all of them.

        Theorem ``fixed_spectrum.multiplicity_at_most``.
        """
        return arithmetic.exponent(arithmetic.poly_modulo(p, self.ell), self.chi_F, self.ell)[0]

    def require_moved(self, rest: Polynomial) -> None:
        """Stop unless det(xI − A) without some factors, or if there are none, has no fixed root.

        Theorems ``fixed_spectrum.absence``, ``fixed_spectrum.absence_all``.
        """
        rest = rest or characteristic_polynomial(self.A, self.ell)
        what = "det(xI - A) without the factors named and det(xI - A_F)"
        require_coprime(rest, self.chi_F, self.ell, what)

    def require_bounded(self, losses: list[Loss]) -> None:
        """Stop unless a large ℓ proves that nothing is fixed but roots of the factors.

        Modulo ℓ, Π p^e is all that det(xI − A_F) and det(xI − A) have in common; Π p^d, d the loss
        of rank, divides both for every F.  What is left of the former is h, of degree k.  With D a
        denominator of A and ρ^8 at least the largest sum of a row, or of a column, of |(D·A)^8|,
        the D^(k−j)·h_j are integers, and ℓ is above Σ_j |D^(k−j)·h_j|·ρ^j.

        Theorem ``large_modulus.large_modulus``.
        """
        h, rest = [Fraction(1)], self.chi_F
        for p, d in losses:
            modular = arithmetic.poly_modulo(p, self.ell)
            times, rest = arithmetic.exponent(modular, rest, self.ell)
            for _ in counted(range(d, times)):
                h = arithmetic.poly_product(h, p)
        what = "det(xI - A) and what is left of det(xI - A_F)"
        require_coprime(characteristic_polynomial(self.A, self.ell), rest, self.ell, what)
        D, k, power = self.A.denominator, len(h) - 1, Matrix(self.A.rows, self.A.ncols)
        for _ in range(SQUARES):
            power = power @ power
        power = arithmetic.absolute(power)
        rho = min(max(map(sum, M.rows)) for M in (power, power.T))
        for _ in range(SQUARES):
            rho = rho and math.isqrt(rho - 1) + 1
        longest = budget.limbs([D, rho]) * (k + 1) + budget.limbs_of(h)
        spend(budget.fractions(3 * k + 3, longest))
        scaled = [Fraction(D ** (k - j) * c) for j, c in enumerate(h)]
        whole = all(c.denominator == 1 for c in scaled)
        require(whole, "modulus", "witness.modulus", "a factor is not integral beside A")
        least = sum(abs(c) * rho**j for j, c in enumerate(scaled))
        require(least < self.ell, "modulus", "witness.modulus", "expected a larger one")

    def require_ranks(self, completion: Json, losses: list[Loss]) -> None:
        """Stop unless A_F + B_0 C_0, with d columns and rows, has no root of a p that loses d.

        Theorems ``fixed_spectrum.completion``, ``fixed_spectrum.rank_exact``.
        """
        left, right = fields(completion, "witness.completion", "B0", "C0")
        rho, n = max(loss for _, loss in losses), self.A.nrows
        B0 = reading.matrix(left, "witness.completion.B0", n, rho)
        C0 = reading.matrix(right, "witness.completion.C0", rho, n)
        completed = dict[int, Polynomial]()
        for p, d in losses:
            if d not in completed:
                loop = self.A_F + B0.take(cols=range(d)) @ C0.take(range(d))
                completed[d] = characteristic_polynomial(loop, self.ell)
            what = "a factor, and det(xI - A_F - B0 C0),"
            require_coprime(p, completed[d], self.ell, what)
