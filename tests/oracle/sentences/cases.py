"""What a sentence is about, in plain data, and the algebra by which judges decide on their own.

A `Case` holds the plant as `tests.oracle.certificates` reads it from JSON, the request, the
controller, and all sentences that were said together.  `Facts` knows of one system what enumeration
over the subsets of channels, drawn gains and certified balls of roots tell.  Nothing here asks the
package: a value that fills a template is copied into plain data first.
"""

from __future__ import annotations

import itertools
import json
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

from mcexact.answer.templates import Sentence
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from tests.oracle.certificates.algebra import krylov
from tests.oracle.certificates.constructions import built
from tests.oracle.certificates.controllers import Loop, read_agents
from tests.oracle.certificates.roots import decided, roots_of
from tests.oracle.certificates.systems import System, read_plant

DRAWS = 3
"""How many sets of gains are drawn: what all of them leave is taken for fixed."""


class UnjudgedError(Exception):
    """This one sentence is beyond its judge, such as one about more plants than can be tried."""


@dataclass(frozen=True)
class Region:
    """Where eigenvalues should lie."""

    time: str
    bound: fmpq | None = None
    damping: fmpq | None = None
    largest_modulus: fmpq | None = None

    def contains(self, p: fmpq_poly) -> bool:
        """Whether all roots of a polynomial lie in the region."""
        return bool(decided(lambda sign: all(self._holds(z, sign) for z in roots_of(p))))

    def _holds(self, z: Any, sign: Callable[[Any], int]) -> bool:
        square = z.real * z.real + z.imag * z.imag
        if self.time == "discrete":
            radius = fmpq(1) if self.bound is None else self.bound
            return sign(radius * radius - square) > 0
        if sign(-z.real - (self.bound or 0)) <= 0:
            return False
        if self.damping is not None:
            inside = z.real * z.real - self.damping * self.damping * square
            if sign(inside) <= 0:
                return False
        limit = self.largest_modulus
        return limit is None or sign(limit * limit - square) > 0


@dataclass(frozen=True)
class Said:
    """A sentence: the key of its template, the values of its fields as plain data, and the text."""

    rule: str
    values: Mapping[str, Any]
    text: str = ""


def said(sentence: Sentence) -> Said:
    """A sentence of the package as plain data."""
    values = {name: plain(value) for name, value in sentence.values.items()}
    return Said(sentence.template.key, values, sentence.line)


def plain(value: Any) -> Any:
    """A value of a field without the package's types."""
    if isinstance(value, Polynomial):
        return fmpq_poly([fmpq(c.numerator, c.denominator) for c in value.coefficients])
    if isinstance(value, StabilityRegion):
        parts = (value.bound, value.damping, value.largest_modulus)
        return Region(value.time, *(None if x is None else number(x) for x in parts))
    if isinstance(value, str | None):
        return value
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, Sequence):
        return [plain(each) for each in value]
    return value


def number(value: Any) -> fmpq:
    """A rational number in flint's form."""
    exact = Fraction(value)
    return fmpq(exact.numerator, exact.denominator)


def irreducible(p: fmpq_poly) -> list[tuple[fmpq_poly, int]]:
    """The monic irreducible factors with their exponents."""
    return [(monic(fmpq_poly(q)), e) for q, e in p.numer().factor()[1] if q.degree() > 0]


def monic(p: fmpq_poly) -> fmpq_poly:
    """The monic associate of a polynomial that is not 0."""
    return p / p[p.degree()]


def same_roots(p: fmpq_poly, factors: Sequence[fmpq_poly]) -> bool:
    """Whether the distinct irreducible factors of p are these."""
    return sorted(str(q) for q, _ in irreducible(p)) == sorted(map(str, factors))


def divides(p: fmpq_poly, q: fmpq_poly) -> bool:
    """Whether p divides q."""
    return bool(divmod(q, p)[1] == 0)


def at_root(M: fmpq_mat, shifted: int, p: fmpq_poly) -> int:
    """The rank of M + λ·diag(1, …, 1, 0, …) at a root λ of p, with so many ones.

    The companion matrix of p stands for λ, which multiplies every rank by the degree of p.
    """
    d = p.degree()
    if d == 1:
        moved = fmpq_mat(M)
        for i in range(shifted):
            moved[i, i] = moved[i, i] - p[0] / p[1]
        return int(moved.rank())
    large = fmpq_mat(M.nrows() * d, M.ncols() * d)
    for i, j in itertools.product(range(M.nrows()), range(M.ncols())):
        for k in range(d):
            large[i * d + k, j * d + k] = M[i, j]
    for i in range(shifted):
        for k in range(d):
            if k:
                large[i * d + k, i * d + k - 1] = large[i * d + k, i * d + k - 1] + 1
            large[i * d + k, i * d + d - 1] = large[i * d + k, i * d + d - 1] - p[k] / p[d]
    return int(large.rank()) // d


class Facts:
    """What is known of one system by enumeration and by drawn gains."""

    def __init__(self, system: System, seed: int = 0) -> None:
        self.system, self.n, self.m = system, system.n, system.m
        self.rng = random.Random(seed)

    @cached_property
    def chi(self) -> fmpq_poly:
        """det(xI − A)."""
        return self.system.A.charpoly()

    @cached_property
    def modes(self) -> list[tuple[fmpq_poly, int]]:
        """The irreducible factors of det(xI − A)."""
        return irreducible(self.chi)

    def pencil(self, s: Sequence[int], A: fmpq_mat | None = None) -> fmpq_mat:
        """[−A, B_{m−s}; C_s, 0], to which λ is added on the first n places of the diagonal."""
        system, n = self.system, self.n
        B = system.inputs([i for i in range(self.m) if i not in s])
        C = system.outputs(s)
        A = system.A if A is None else A
        M = fmpq_mat(n + C.nrows(), n + B.ncols())
        for i, j in itertools.product(range(n), range(n)):
            M[i, j] = -A[i, j]
        for i, j in itertools.product(range(n), range(B.ncols())):
            M[i, n + j] = B[i, j]
        for i, j in itertools.product(range(C.nrows()), range(n)):
            M[n + i, j] = C[i, j]
        return M

    def rank(self, s: Sequence[int], p: fmpq_poly) -> int:
        """The rank of [λI − A, B_{m−s}; C_s, 0] at a root of p."""
        return at_root(self.pencil(s), self.n, p)

    def controls(self, channels: Sequence[int], p: fmpq_poly, A: fmpq_mat | None = None) -> bool:
        """Whether rank [λI − A, B_channels] = n at a root of p."""
        alone = replace(self.system, C=tuple(fmpq_mat(0, self.n) for _ in self.system.C))
        others = [i for i in range(self.m) if i not in channels]
        return at_root(Facts(alone).pencil(others, A), self.n, p) == self.n

    def observes(self, channels: Sequence[int], p: fmpq_poly, A: fmpq_mat | None = None) -> bool:
        """Whether rank [λI − A; C_channels] = n at a root of p."""
        alone = replace(self.system, B=tuple(fmpq_mat(self.n, 0) for _ in self.system.B))
        return at_root(Facts(alone).pencil(channels, A), self.n, p) == self.n

    @cached_property
    def fixed(self) -> list[fmpq_poly]:
        """The irreducible factors that some subset of channels makes fixed."""
        subsets = [s for k in range(self.m + 1) for s in itertools.combinations(range(self.m), k)]
        return [p for p, _ in self.modes if any(self.rank(s, p) < self.n for s in subsets)]

    def drawn(self, channels: Sequence[int] | None = None, A: fmpq_mat | None = None) -> fmpq_mat:
        """A + Σ B_i F_i C_i for drawn gains of these channels, or of all."""
        A = self.system.A if A is None else A
        for i in range(self.m) if channels is None else channels:
            B, C = self.system.B[i], self.system.C[i]
            entries = [self.rng.randint(-999, 999) for _ in range(B.ncols() * C.nrows())]
            A = A + B * fmpq_mat(B.ncols(), C.nrows(), entries) * C
        return A

    @cached_property
    def loops(self) -> list[fmpq_mat]:
        """Loops under drawn gains."""
        return [self.drawn() for _ in range(DRAWS)]

    @cached_property
    def fixed_polynomial(self) -> fmpq_poly:
        """The greatest common divisor of det(xI − A) and of det(xI − A_F) for all drawn gains."""
        found = self.chi
        for A in self.loops:
            found = found.gcd(A.charpoly())
        return monic(found)

    @cached_property
    def parts(self) -> list[int]:
        """The degrees of the irreducible factors of a drawn loop, as few as drawn gains reach."""
        found: list[list[int]] = [
            [p.degree() for p, e in irreducible(A.charpoly()) for _ in range(e)] for A in self.loops
        ]
        _, fewest = min((len(degrees), sorted(degrees)) for degrees in found)
        return fewest

    @cached_property
    def arcs(self) -> list[tuple[int, int]]:
        """The pairs (j, i) with C_i A^k B_j ≠ 0 for some k < n."""
        found = []
        for j in range(self.m):
            reached = krylov(self.system.A, self.system.B[j], self.n)
            for i in range(self.m):
                if any((self.system.C[i] * reached).entries()):
                    found.append((j, i))
        return found

    def reachable(self, start: int) -> set[int]:
        """The channels on which a channel acts, also by way of others."""
        reached = {start}
        while new := {i for j, i in self.arcs if j in reached} - reached:
            reached |= new
        return reached

    @cached_property
    def components(self) -> list[list[int]]:
        """The strong components of the transfer graph, in the order of their first members."""
        return components(self.m, self.arcs)

    def uncontrolled(self, channels: Sequence[int] | None = None) -> list[fmpq_poly]:
        """The modes that channels together do not control."""
        chosen = list(range(self.m)) if channels is None else channels
        return [p for p, _ in self.modes if not self.controls(chosen, p)]

    def unobserved(self, channels: Sequence[int] | None = None) -> list[fmpq_poly]:
        """The modes that channels together do not observe."""
        chosen = list(range(self.m)) if channels is None else channels
        return [p for p, _ in self.modes if not self.observes(chosen, p)]

    def steady_rank(self) -> int:
        """The rank of [A − σI, B; C, 0], σ the eigenvalue of a constant."""
        return at_root(self.merged.pencil_of_all, self.n, fmpq_poly([-self.place, 1]))

    def normal_rank(self) -> int:
        """The largest rank of [xI − A, B; C, 0] at drawn points."""
        M = self.merged.pencil_of_all
        points = (fmpq_poly([fmpq(-self.rng.randint(10**3, 10**6), 7), 1]) for _ in range(2))
        return max(at_root(M, self.n, p) for p in points)

    @property
    def place(self) -> int:
        """The eigenvalue of a constant: 0, or 1 in discrete time."""
        return int(self.system.time == "discrete")

    @cached_property
    def merged(self) -> Facts:
        """The system with all channels in one hand."""
        B, C = self.system.inputs(), self.system.outputs()
        return Facts(replace(self.system.plain(), names=("all",), B=(B,), C=(C,)))

    @cached_property
    def pencil_of_all(self) -> fmpq_mat:
        """[−A, B; C, 0] with all inputs and all outputs."""
        n, B, C = self.n, self.system.inputs(), self.system.outputs()
        M = fmpq_mat(n + C.nrows(), n + B.ncols())
        for i, j in itertools.product(range(M.nrows()), range(M.ncols())):
            if i < n and j < n:
                M[i, j] = -self.system.A[i, j]
            elif i < n:
                M[i, j] = B[i, j - n]
            elif j < n:
                M[i, j] = C[i - n, j]
        return M


def components(m: int, arcs: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Strong components by transitive closure, sorted by first member."""
    reach = [[i == j or (i, j) in arcs for j in range(m)] for i in range(m)]
    for k, i, j in itertools.product(range(m), repeat=3):
        reach[i][j] = reach[i][j] or (reach[i][k] and reach[k][j])
    found: list[list[int]] = []
    for i in range(m):
        if not any(i in each for each in found):
            found.append([j for j in range(m) if reach[i][j] and reach[j][i]])
    return found


@dataclass(frozen=True)
class Case:
    """What sentences are about.

    Attributes
    ----------
    plant : System
    asked : mapping
        The request: ``information``, ``subset``, ``channel``, ``share``, ``region`` and so on.
    controller : mapping, optional
        The document of the controller whose loop sentences are about.
    rows : sequence of Said
        All that was said together, such as the rows of one table.
    parametric : object, optional
        The plant with parameters, of which `tests.oracle.parametric` takes values.
    """

    plant: System
    asked: Mapping[str, Any] = field(default_factory=dict)
    controller: Mapping[str, Any] | None = None
    rows: Sequence[Said] = ()
    parametric: Any = None

    @cached_property
    def own(self) -> Facts:
        """The plant."""
        return Facts(self.plant)

    @cached_property
    def with_outputs(self) -> Facts:
        """The plant whose agents receive the outputs of their neighbors."""
        return Facts(self.made({"construction": "augmented_outputs"}))

    @property
    def subject(self) -> Facts:
        """The plant with the information that is asked for."""
        return self.with_outputs if self.asked.get("information") == "outputs" else self.own

    def made(self, *steps: Mapping[str, Any]) -> System:
        """What constructions make from the plant; without a graph, over the one without edges."""
        plant = self.plant
        if plant.neighborhoods is None:
            plant = replace(plant, neighborhoods=tuple((i,) for i in range(plant.m)))
        return built(plant, steps)

    def extended(self, sizes: Sequence[int], share: str) -> Facts:
        """The plant with so many shared states of each agent."""
        sizes = list(sizes)
        step = {"construction": "extended", "dimensions": sizes, "share": share}
        return Facts(self.made(step))

    def indices(self, names: Sequence[str]) -> list[int]:
        """The places of channels."""
        return [self.plant.names.index(name) for name in names]

    def senders(self, s: Sequence[int]) -> set[int]:
        """N_s∖s, the agents outside a set from which agents of it receive."""
        neighborhoods = self.plant.neighborhoods or [(i,) for i in range(self.plant.m)]
        return {j for i in s for j in neighborhoods[i]} - set(s)

    @property
    def slow(self) -> str:
        """Whether messages take time: the keyword of the sentences that assume they do not."""
        return "delays" if self.plant.delays else "none"

    def others(self, *rules: str) -> list[Said]:
        """What was said by these rules."""
        return [each for each in self.rows if each.rule in rules]

    @cached_property
    def loop(self) -> Loop:
        """The loop with the controller, signal by signal."""
        if self.controller is None:
            raise UnjudgedError("there is no controller")
        return Loop(self.plant, read_agents(self.plant, self.controller))

    @cached_property
    def loop_matrix(self) -> fmpq_mat:
        """The matrix of the loop."""
        return self.loop.matrix()

    @cached_property
    def spectrum(self) -> fmpq_poly:
        """The characteristic polynomial of the loop."""
        return self.loop_matrix.charpoly()


def plant_of(system: Any) -> System:
    """A plant of the package as the oracle of certificates reads it from JSON."""
    return read_plant(json.loads(json.dumps(system.canonical_document())))


def index_ranks(A: fmpq_mat, B: fmpq_mat) -> list[int]:
    """The ranks of [B, A B, …] until they no longer grow."""
    ranks = [0]
    while len(ranks) <= A.nrows() and ((found := int(krylov(A, B, len(ranks)).rank())) > ranks[-1]):
        ranks.append(found)
    return ranks[1:]


def partition(ranks: Sequence[int]) -> list[int]:
    """The controllability indices: by how many steps each input goes on."""
    steps = [b - a for a, b in itertools.pairwise([0, *ranks])]
    return [sum(step > i for step in steps) for i in range(max(steps, default=0))]
