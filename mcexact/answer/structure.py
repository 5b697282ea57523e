"""Answers about controllability, transfer graph, subsystems, set-points, single channels.

Each answer about controllability is one about observability if it is about the dual system.  The
docstring of each class says what its fields claim; the classes named ``…Witness``, `ByRank` and
`ByBlocks` are the alternative forms of its evidence.  `ByRank` takes ranks modulo ℓ, and `ByBlocks`
the evidence of fixed modes, block by block, which suits large systems with few nonzero entries.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar

from mcexact.answer.evidence import Block, RootDisc, Subspace, ZeroTransfer
from mcexact.answer.protocol import Answer, Part, answer, claim, is_about_dual, shown, witness
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import PolynomialMatrix, row_echelon
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.rational import as_fraction
from mcexact.exact.roots import real_root_intervals, root_discs
from mcexact.plot.graphs import graph

# Answer: the subspace that a set of channels controls, and the uncontrollable modes.


@dataclass(frozen=True)
class ByRank(Part):
    """Evidence by a rank: d vectors of [B_T, AB_T, …] are independent modulo ℓ.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which the rank d is reached.
    annihilator : Matrix
        W, (n − d) × n: its columns ``pivots`` form the identity, WA = (WA)[:, pivots] W, WB_T = 0.
    pivots : tuple of int
        n − d columns of W, strictly increasing.
    """

    modulus: int
    annihilator: Matrix
    pivots: tuple[int, ...]


@dataclass(frozen=True)
class ByBlocks(Part):
    """Evidence block by block: feedback of the channels T alone moves all but n − d modes.

    Modes that T does not control stay under every feedback, whatever the channels measure.

    Attributes
    ----------
    blocks : tuple of Block
        Of the system with the channels T alone; they leave n − d modes.
    measured : tuple of tuple of int, or None
        For each channel of T the states that it measures in that system; None if these are its own
        outputs.
    annihilator : Matrix
    pivots : tuple of int
        As in `ByRank`.
    """

    blocks: tuple[Block, ...]
    measured: tuple[tuple[int, ...], ...] | None
    annihilator: Matrix
    pivots: tuple[int, ...]


@answer("controllability")
class JointControllability(Answer):
    """The controllable subspace of a set T of channels; for observability, of the dual system.

    The controllable subspace of (A, B_T) has dimension d.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    dimension : int
        d = dim ⟨A | B_T⟩.
    controllable : bool
        Whether d = n: ⟨A | B_T⟩ is the whole state space.
    uncontrollable_polynomial : Polynomial
        Monic, of degree n − d: the characteristic polynomial of A on the quotient by ⟨A | B_T⟩.
        Its roots are the modes that T does not control.
    evidence : ByRank or ByBlocks
        The second for large systems, if the search yields such blocks.
    """

    with_feedthrough = True

    dual_keys: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "controllable": "observable",
            "uncontrollable_polynomial": "unobservable_polynomial",
        }
    )

    channels: tuple[str, ...] = claim()
    dimension: int = claim()
    controllable: bool = claim()
    uncontrollable_polynomial: Polynomial = claim()
    evidence: ByRank | ByBlocks = witness(whole=True)

    @property
    def observable(self) -> bool:
        """Whether (C_T, A) is observable, for an answer about the dual system.

        Raises
        ------
        UsageError
            If the answer is not about a dual system.
        """
        if not is_about_dual(self.subject):
            raise UsageError("this answer is about controllability: ask .controllable")
        return self.controllable


# Answer: the controllability index and the controllability (Brunovsky) indices.


@dataclass(frozen=True)
class ByGrowth(Part):
    """Evidence by relations, after which ranks cannot grow as before, and by rows.

    With r_0 = 0, rank r_{k+1} is at most n less the rows of W, r_k + (r_k − r_{k−1}), and r_k plus
    the number of inputs less that of relations of degree at most k.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which the ranks are reached.
    annihilator : Matrix
        W: its columns ``pivots`` form the identity, WA = (WA)[:, pivots] W, WB_T = 0.
    pivots : tuple of int
        Columns of W, strictly increasing.
    relations : PolynomialMatrix
        V = Σ x^i V_i with a column for each relation: Σ A^i B_T V_i = 0.
    inputs : tuple of int
        For each column v of degree k a column j of B_T with v_k,j not 0, and 0 in all later columns
        of V at their own degrees.
    """

    modulus: int
    annihilator: Matrix
    pivots: tuple[int, ...]
    relations: PolynomialMatrix
    inputs: tuple[int, ...]


@answer("controllability_indices")
class ControllabilityIndices(Answer):
    """The ranks r_k of [B_T … A^{k−1}B_T], and the resulting indices.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    ranks : tuple of int
        r_1 < … < r_ν, the ranks until they stop growing; empty if B_T = 0 (ν = 0).
    index : int or None
        The controllability index: ν if r_ν = n, else None.
    indices : tuple of int
        The controllability (Brunovsky) indices κ_1 ≥ κ_2 ≥ …, the conjugate partition of
        r_1, r_2 − r_1, …; they sum to r_ν.
    evidence : ByGrowth
    """

    with_feedthrough = True

    channels: tuple[str, ...] = claim()
    ranks: tuple[int, ...] = claim()
    index: int | None = claim()
    indices: tuple[int, ...] = claim()
    evidence: ByGrowth = witness(whole=True)


# Answer: the edges and the strong components of the transfer graph.


@answer("transfer_graph")
class TransferGraph(Answer):
    """The transfer graph: exactly the edges j → i with C_i (xI − A)⁻¹ B_j ≠ 0.

    Attributes
    ----------
    arcs : tuple of (str, str)
        The edges (from, to) by name, in the order of the channels.
    components : tuple of tuple of str
        The strong components, each in the order of the channels, sorted by first member.
    strongly_connected : bool
        Whether there is at most one component.
    modulus : int
        ℓ ≥ 2, modulo which each edge has a nonzero C_i A^k B_j.
    powers : tuple of int
        k < n, one for each edge.
    zeros : tuple of ZeroTransfer
        Zero transfers for all pairs that are not edges.
    """

    arcs: tuple[tuple[str, str], ...] = claim()
    components: tuple[tuple[str, ...], ...] = claim()
    strongly_connected: bool = claim()
    modulus: int = witness()
    powers: tuple[int, ...] = witness()
    zeros: tuple[ZeroTransfer, ...] = witness()

    @cached_property
    @shown("channels that take part in no feedback")
    def inactive(self) -> tuple[str, ...]:
        """The channels with B_i = 0 or C_i = 0, which cannot take part in any feedback."""
        return tuple(c.name for c in self.about.channels if c.B.is_zero() or c.C.is_zero())

    @cached_property
    def successors(self) -> dict[str, tuple[str, ...]]:
        """For each channel that an edge leaves, the channels at the ends of its edges."""
        receivers: dict[str, list[str]] = {}
        for j, i in self.arcs:
            receivers.setdefault(j, []).append(i)
        return {j: tuple(reached) for j, reached in receivers.items()}

    def to_networkx(self) -> Any:
        """Return a ``networkx.DiGraph`` on the names of the channels, with the edges."""
        import networkx

        found = networkx.DiGraph(list(self.arcs))
        found.add_nodes_from(self.about.names)
        return found

    def plot(self, ax: Any = None) -> Any:
        """Draw the graph; see `mcexact.plot.graph`."""
        return graph(self, ax, title="transfer graph")


# Answer: the Smith form of P_s(x) = [xI − A, B_{m−s}; C_s, 0].


@dataclass(frozen=True)
class InvariantZeros(Part):
    """An irreducible polynomial whose roots are invariant zeros, with discs around these.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible over Q.
    multiplicity : int
        The exponent of p in the product of all invariant polynomials.
    rank : int
        The rank of P_s at every root of p, below the normal rank.
    roots : tuple of RootDisc
        Disjoint discs, each with exactly one root of p.
    """

    polynomial: Polynomial
    multiplicity: int
    rank: int
    roots: tuple[RootDisc, ...]


@answer("complementary_subsystem")
class ComplementarySubsystem(Answer):
    """Properties of the complementary subsystem (C_s, A, B_{m−s}), from its pencil P_s(x).

    Attributes
    ----------
    subset : tuple of str
        s, nonempty and proper, in the order of the system.
    normal_rank : int
        The rank k of P_s over Q(x), at least n.
    invariant_polynomials : tuple of Polynomial
        The invariant polynomials of degree at least 1, each dividing the next; the others of the k
        are 1.  Their roots are the invariant zeros.
    remnant : Polynomial
        The product of the first n invariant polynomials: the greatest common divisor of the n × n
        minors of P_s.
    transfer_zero : bool
        Whether C_s (xI − A)⁻¹ B_{m−s} = 0.
    complete : bool
        Whether the transfer matrix is not 0 and rank P_s(λ) ≥ n for every λ.
    reachable : int
        The number of columns of X that span the controlled part.
    modulus : int
        ℓ ≥ 2, modulo which all ranks are reached.
    X, F, A1, S, B1, L, G, N : Matrix
        As in ``FORMAT.md``.
    """

    subset: tuple[str, ...] = claim()
    normal_rank: int = claim()
    invariant_polynomials: tuple[Polynomial, ...] = claim()
    remnant: Polynomial = claim()
    transfer_zero: bool = claim()
    complete: bool = claim()
    reachable: int = witness()
    modulus: int = witness()
    X: Matrix = witness()
    F: Matrix = witness()
    A1: Matrix = witness()
    S: Matrix = witness()
    B1: Matrix = witness()
    L: Matrix = witness()
    G: Matrix = witness()
    N: Matrix = witness()

    @cached_property
    @shown("invariant zeros")
    def zeros(self) -> tuple[InvariantZeros, ...]:
        """The irreducible factors of the invariant polynomials."""
        return tuple(
            InvariantZeros(
                polynomial=p,
                multiplicity=e,
                rank=self.normal_rank - sum(p.divides(f) for f in self.invariant_polynomials),
                roots=tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(p)),
            )
            for p, e in product(self.invariant_polynomials).factor()
        )


# Answer: whether every output can be held at any set-point.


@answer("setpoint")
class SetpointSolvability(Answer):
    """S = [A, B; C, 0] (discrete time: A − I) has rank r, of n + Σ q_i rows.

    Attributes
    ----------
    solvable : bool
        Whether r = n + Σ q_i; then the plant with integrators of all outputs is jointly
        controllable if the plant is.
    rank : int
        r.
    invariant_zero : bool or None
        If S does not have full rank, whether [xI − A, B; C, 0] has full rank for some x, so that 0
        (discrete time: 1) is an invariant zero.  If not, the outputs are dependent at every
        frequency.
    modulus : int
        ℓ ≥ 2, modulo which the ranks are reached.
    left : Matrix
        W, (n + Σ q_i − r) × (n + Σ q_i), W S = 0; its columns ``pivots`` form the identity.
    pivots : tuple of int
    point : int or None
        A point where the pencil has full rank modulo ℓ, for an invariant zero.
    normal : PolynomialMatrix or None
        A nonzero row that annihilates the pencil identically, if there is no such point.
    """

    solvable: bool = claim("every set-point has an equilibrium")
    rank: int = claim("rank of [A, B; C, 0]")
    invariant_zero: bool | None = claim("an invariant zero forbids it")
    modulus: int = witness()
    left: Matrix = witness()
    pivots: tuple[int, ...] = witness()
    point: int | None = witness()
    normal: PolynomialMatrix | None = witness()

    @cached_property
    @shown("conditions on set-points")
    def combinations(self) -> Matrix:
        """Rows w ≠ 0 with w · r = 0 for every vector r of set-points that some equilibrium has.

        A row has one entry for each output; there are no rows if every set-point can be held.
        """
        outputs = self.about.output_matrix().nrows
        kept = []
        if self.left.nrows:
            last_columns = range(self.about.n, self.about.n + outputs)
            for row in row_echelon(self.left.take(cols=last_columns))[0].numerators:
                last = next((x for x in reversed(row) if x), 0)
                if last:
                    kept.append([x if last > 0 else -x for x in row])
        return Matrix.from_integers(kept, ncols=outputs)


# Answer: the values of g at which [B, (M+gA)B, …] loses rank.


@dataclass(frozen=True)
class ExceptionalFactor(Part):
    """A factor f, with a row that annihilates all blocks at every root g of f.

    Attributes
    ----------
    polynomial : Polynomial
        f, monic of degree at least 1.
    row : PolynomialMatrix
        1 × n, reduced modulo f, with row · [B, (M+gA)B, …] = 0 modulo f.
    pivot : int
        The position of an entry 1.
    """

    polynomial: Polynomial
    row: PolynomialMatrix
    pivot: int


@answer("exceptional_gains")
class ExceptionalSet(Answer):
    """The values of g for which the first blocks of [B, (M+gA)B, …] lose rank n.

    K(g) = [B, (M+gA)B, …, (M+gA)^{blocks−1}B] loses rank n at the roots of a polynomial alone.

    Attributes
    ----------
    M : Matrix
        n × n; A and B are those of the subject, all its channels taken together.
    blocks : int
        At least 1.
    polynomial : Polynomial
        In g, monic and squarefree: the exceptional g, complex ones included, are its roots.
    roots : tuple of RootDisc
        One for each root of the polynomial, with a real center if the root is real.
    modulus : int
        ℓ ≥ 2.
    factors : tuple of ExceptionalFactor
        Their product is the polynomial.
    compressions : tuple of two Matrix
        R and R', blocks·p × n: det(K(g) R), without the factors, and det(K(g) R') are coprime
        modulo ℓ.
    """

    M: Matrix = claim()
    blocks: int = claim()
    polynomial: Polynomial = claim()
    roots: tuple[RootDisc, ...] = claim()
    modulus: int = witness()
    factors: tuple[ExceptionalFactor, ...] = witness()
    compressions: tuple[Matrix, Matrix] = witness()

    @cached_property
    def real_roots(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """Ascending disjoint intervals, each with one exceptional real g.

        The ends are equal if g is a short decimal.
        """
        return real_root_intervals(self.polynomial)

    def __contains__(self, g: Any) -> bool:
        """Whether a rational g is exceptional, exactly."""
        return self.polynomial(as_fraction(g)) == 0


# Answer: gains with which single channels control or observe a system, or an obstruction.


@dataclass(frozen=True)
class GainsWitness(Part):
    """Evidence for yes: the gains, and rows that exclude smaller indices.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i, the same for all channels named.
    modulus : int
        ℓ ≥ 2, modulo which the ranks reach n.
    annihilators : tuple of tuple of Matrix
        For each channel and each property, a 1 × n row that annihilates all blocks of the index
        except the last.
    generator : Matrix or None
        b, n × 1, with b, A_F b, …, A_F^{n−1} b independent modulo ℓ: A_F is cyclic.
    """

    gains: tuple[Matrix, ...]
    modulus: int
    annihilators: tuple[tuple[Matrix, ...], ...]
    generator: Matrix | None


@dataclass(frozen=True)
class StuckWitness(Part):
    """Evidence for no: a mode that no gains let the channel control or observe.

    Attributes
    ----------
    channel : str
        q.
    side : str
        ``"controllable"``, or ``"observable"``: then the subspace is one of the dual.
    polynomial : Polynomial
        p, monic of degree at least 1.
    subspace : Subspace
        For p, with q in T.
    """

    channel: str
    side: str
    polynomial: Polynomial
    subspace: Subspace


@dataclass(frozen=True)
class UnreachedWitness(Part):
    """Evidence for no: channels that are not reachable from the channel.

    Attributes
    ----------
    channel : str
        q.
    side : str
        ``"controllable"``, or ``"observable"``: then the zero transfer is one of the dual.
    zero : ZeroTransfer
        From a set T with q in it to its complement, where some C_i is not 0.
    """

    channel: str
    side: str
    zero: ZeroTransfer


@answer("single_channel_gains")
class SingleChannelGains(Answer):
    """Whether some decentralized gains make each named channel control and observe the system.

    Attributes
    ----------
    channels : tuple of str
        The q, in the order of the system.
    wanted : str
        ``"controllable"``, ``"observable"`` or ``"both"``.
    exists : bool
    cyclic : bool
        Whether the certificate also proves that A_F is cyclic; False claims nothing.
    indices : tuple of tuple of int, or None
        For each channel the controllability index of (A_F, B_q) and the observability index of
        (C_q, A_F), as far as asked.
    evidence : GainsWitness, StuckWitness or UnreachedWitness
        The first for yes, one of the others for no.
    """

    channels: tuple[str, ...] = claim()
    wanted: str = claim(key="property")
    exists: bool = claim()
    cyclic: bool = claim()
    indices: tuple[tuple[int, ...], ...] | None = claim()
    evidence: GainsWitness | StuckWitness | UnreachedWitness = witness(whole=True)

    @property
    @shown()
    def gains(self) -> tuple[Matrix, ...] | None:
        """F_i, p_i × q_i; None if there are none."""
        return self.evidence.gains if isinstance(self.evidence, GainsWitness) else None
