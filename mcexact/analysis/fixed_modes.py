"""The fixed spectrum, completeness, assignability, and ranks of pencils.

A mode is fixed if no decentralized feedback u_i = F_i y_i moves it, that is, by the theorem of
Anderson and Clements, if the pencil P_s(λ) = [λI − A, B_{m−s}; C_s, 0] of some set s of channels
has rank below n.  There are 2^m such sets; none is enumerated.

`fixed_spectrum` tries, in this order:

1. Blocks of states, each with a Krylov sequence of drawn gains (`blocks`).  These bound how many
   modes are fixed; without fixed modes they nearly always suffice, and this takes O(n³).
2. For large systems of several blocks, or sparse ones, each block that leaves modes by itself
   (`local_subspaces`): its shrunk subspaces are evidence about the whole system.
3. The dense search (`subspaces`): all fixed factors of χ_A, each with a shrunk subspace that proves
   it fixed.  That no other mode is fixed is proved by the blocks, or by gains F and a prime modulo
   which χ_{A_F} is coprime to the rest of χ_A; this also serves modes fixed by Jordan chains.

`completeness` adds that the transfer graph is strongly connected, `assignability` gives the degrees
into which the assignable spectrum splits over its strong components, and `pencil_rank` decides one
set s and one mode.  All answers are exact.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, Any, cast, overload

from mcexact.analysis.blocks import (
    MODULI,
    best_sequences,
    bounded_blocks,
    completed_blocks,
    local_subspaces,
    longest_sequence,
    modes_left,
)
from mcexact.analysis.sparse import (
    edge_powers,
    is_connected,
    is_large_and_sparse,
    reachable_pairs,
)
from mcexact.analysis.stability import located, open_loop_spectrum
from mcexact.analysis.structure import (
    Edge,
    short_powers,
    suspected_edges,
    transfer_graph,
    witnessed_powers,
    zero_transfer,
)
from mcexact.analysis.subspaces import Decision, Obstruction, decide, evidence
from mcexact.answer.evidence import (
    Block,
    KrylovSequence,
    RateInterval,
    RootDisc,
    Subspace,
    ZeroTransfer,
)
from mcexact.answer.loops import ClosedLoopSpectrum
from mcexact.answer.modes import (
    Assignability,
    BlocksWitness,
    ByBlocks,
    ByDegrees,
    Completeness,
    Completion,
    CutWitness,
    Degree,
    Evidence,
    FixedFactor,
    FixedModeWitness,
    FixedSpectrum,
    FreedomWitness,
    OrderedComponents,
    PathCutWitness,
    PencilRank,
    SpectrumBlock,
    TwoPolynomials,
)
from mcexact.answer.structure import TransferGraph
from mcexact.derived.feedthrough import without_feedthrough
from mcexact.derived.modular import (
    ModularSystem,
    closed_loop,
    generator,
    lifted,
    lifted_gains,
    residue_systems,
)
from mcexact.errors import InputError, InternalError, LimitReached
from mcexact.exact.krylov import controllable_subspace, stays_sparse
from mcexact.exact.linear_algebra import PolynomialMatrix, inflate, nullspace_at
from mcexact.exact.matrix import Matrix, block, block_diagonal, hstack, vstack
from mcexact.exact.modular import (
    ModularPolynomial,
    polynomial_residues,
    primes,
    random_matrix,
    residues,
)
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.rational import as_fraction
from mcexact.exact.roots import StabilityRegion, Time
from mcexact.model.graph import components_of, strong_components
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

if TYPE_CHECKING:
    from mcexact.analysis.parameters.hypersurfaces import ParametricCompleteness
    from mcexact.answer.parameters import ParametricFixedSpectrum

# The fixed spectrum.

# Up to this size dense matrices are searched, which finds Jordan chains as well.
_DENSE = 500
# From here on blocks are decided one after the other.
_WHOLE = 100
# From here on the exponents in χ_A are left open where blocks prove all else: no check of them is
# known that takes less than some n⁴ operations.
_EXPONENTS = 60
# How often the checker squares A for a bound of its eigenvalues.
_SQUARES = 3


@overload
def fixed_spectrum(system: MultiChannelSystem) -> FixedSpectrum: ...


@overload
def fixed_spectrum(system: ParametricSystem) -> ParametricFixedSpectrum: ...


def fixed_spectrum(
    system: MultiChannelSystem | ParametricSystem,
) -> FixedSpectrum | ParametricFixedSpectrum:
    """Decide which modes no linear time-invariant decentralized feedback can move.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant or a derived system; or a plant with one parameter, for all of whose values the
        question is decided (`ParametricFixedSpectrum`).

        One with feedthrough is decided with its inputs as states (`input_filters`), which has the
        same fixed modes.

    Notes
    -----
    Paper, Proposition 2 (Anderson and Clements): λ is fixed iff for some set s of channels the
    pencil, with the outputs of s and the inputs of all other channels, loses rank::

        rank P_s(λ) < n,    P_s(λ) = ⎡ λI − A   B_{m−s} ⎤
                                     ⎣   C_s       0    ⎦

    Each fixed factor has such an s as its ``channels``, and this rank as its ``rank``.

    Exact; no subset of channels is enumerated.  With χ_M = det(xI − M) and the loop
    A_F = A + Σ B_i F_i C_i: in large sparse systems the factors come from products with sparse
    matrices.  How often factors occur in χ_A is left open from 60 states on, where blocks prove all
    else.  The certificate splits the states into
    blocks that share no gain.  For each it has one Krylov sequence of drawn gains and one channel,
    modulo a small prime, which bounds how much is fixed; for each fixed factor it has a shrunk
    subspace: one that λI − A_F maps into a smaller one, im B_T, for all gains F, T the channels
    outside s.  So λI − A_F is singular for all F.
    Where the blocks leave more than the factors, because a mode is fixed by Jordan chains, the
    certificate has gains F and a modulus ℓ such that χ_{A_F} is coprime modulo ℓ to χ_A without
    its fixed factors.  Without fixed modes it takes O(n³), by products in floating point that are
    exact from 128 states on.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A = [[1, 0, 0], [0, 1, 0], [0, 1, 1]]
    >>> B = [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]]
    >>> C = [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]]
    >>> [factor] = fixed_spectrum(MultiChannelSystem(A, B, C)).factors
    >>> str(factor.polynomial), factor.channels, factor.rank
    ('x - 1', ('2', '3'), 2)
    >>> fixed_spectrum(MultiChannelSystem([[1]], [[[1]]], [[[1]]])).empty
    True
    """
    if isinstance(system, ParametricSystem):
        # start-up: few plants need it
        from mcexact.analysis.parameters.modes import parametric_fixed_spectrum

        return parametric_fixed_spectrum(system)
    system = without_feedthrough(system)
    blocks = bounded_blocks(system)
    if not modes_left(blocks):
        return _answer(system, (), None, ByBlocks(blocks, None, ()))
    reason = ""
    if _in_parts(system, blocks):
        try:
            return _part_by_part(system, blocks)
        except LimitReached as limit:
            reason = str(limit)
    rng = generator(system, "fixed_spectrum")
    try:
        decision = decide(system, rng)
    except LimitReached as limit:
        raise LimitReached(
            f"{limit}; block by block: {reason}" if reason else str(limit)
        ) from limit
    region = StabilityRegion(cast(Time, system.time))
    discs, rate = located(system.time, [o.polynomial for o in decision.obstructions])
    subspaces = tuple(evidence(system.names, o.subspace) for o in decision.obstructions)
    by_blocks = _by_blocks(system, blocks, decision, subspaces)
    factors = tuple(
        _factor(system, decision, o, roots, region, by_blocks is not None)
        for o, roots in zip(decision.obstructions, discs, strict=True)
    )
    if by_blocks is not None:
        return _answer(system, factors, rate, by_blocks)
    if system.n > _EXPONENTS:
        return _answer(system, factors, rate, _beyond_bound(system, factors, subspaces, rng))
    proof = TwoPolynomials(
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        subspaces=subspaces,
        completion=_completion(decision, rng) if factors else None,
    )
    return _answer(system, factors, rate, proof)


def _in_parts(system: MultiChannelSystem, blocks: tuple[Block, ...]) -> bool:
    """Whether the blocks are decided one after the other, without the polynomial of A."""
    channels = system.channels
    sparse = system.n > _DENSE and stays_sparse(
        system.A, [c.B for c in channels], [c.C for c in channels]
    )
    return sparse or (system.n > _WHOLE and len(blocks) > 1)


def _part_by_part(system: MultiChannelSystem, blocks: tuple[Block, ...]) -> FixedSpectrum:
    """The fixed spectrum from those of the blocks, without χ_A."""
    blocks, subspaces = local_subspaces(system, blocks)
    ell = _separating(product(p for p, _, _ in subspaces), MODULI[-1]) if subspaces else None
    if modes_left(blocks) != sum(p.degree * deficiency for p, deficiency, _ in subspaces):
        raise LimitReached("two polynomials modulo one prime do not prove that a block is free")
    if subspaces and ell is None:
        raise LimitReached("factors have common roots modulo each prime that is tried")
    region = StabilityRegion(cast(Time, system.time))
    discs, rate = located(system.time, [p for p, _, _ in subspaces])
    factors = tuple(
        FixedFactor(
            polynomial=p,
            multiplicity_in_A=None,
            multiplicity_at_most=deficiency,
            channels=tuple(name for name in system.names if name not in set(space.channels_T)),
            rank=system.n - deficiency,
            stable=region.contains_roots_of(p),
            roots=roots,
        )
        for (p, deficiency, space), roots in zip(subspaces, discs, strict=True)
    )
    spaces = tuple(space for _, _, space in subspaces)
    return _answer(system, factors, rate, ByBlocks(blocks, ell, spaces))


def _answer(
    system: MultiChannelSystem,
    factors: tuple[FixedFactor, ...],
    rate: RateInterval | None,
    proof: ByBlocks | TwoPolynomials,
) -> FixedSpectrum:
    return FixedSpectrum(
        system,
        polynomial=product(factor.polynomial for factor in factors),
        factors=factors,
        stabilizable=all(factor.stable for factor in factors),
        best_rate=rate,
        evidence=proof,
    )


def _by_blocks(
    system: MultiChannelSystem,
    blocks: tuple[Block, ...],
    decision: Decision,
    subspaces: tuple[Subspace, ...],
) -> ByBlocks | None:
    """The proof by blocks, if they leave just as many modes as the fixed factors account for."""
    obstructions = decision.obstructions
    fixed = sum(o.polynomial.degree * o.subspace.deficiency for o in obstructions)
    if modes_left(blocks) > fixed and len(blocks) > 1:
        blocks = completed_blocks(system, blocks)
    if modes_left(blocks) > fixed:
        return None
    if not obstructions:
        return ByBlocks(blocks, None, ())
    ell = _separating(product(o.polynomial for o in obstructions), decision.modular.modulus)
    return None if ell is None else ByBlocks(blocks, ell, subspaces)


def _separating(whole: Polynomial, last: int) -> int | None:
    """A prime modulo which a product of different factors has no multiple root."""
    for ell in (*MODULI, last):
        if all(c.denominator % ell for c in whole.coefficients):
            p = polynomial_residues(whole, ell)
            if p.gcd(polynomial_residues(whole.derivative(), ell)).degree == 0:
                return ell
    return None


def _factor(
    system: MultiChannelSystem,
    decision: Decision,
    obstruction: Obstruction,
    roots: tuple[RootDisc, ...],
    region: StabilityRegion,
    by_blocks: bool,
) -> FixedFactor:
    T, deficiency = set(obstruction.subspace.channels_T), obstruction.subspace.deficiency
    p, at_most = obstruction.polynomial, deficiency
    open_exponent = system.n > _EXPONENTS
    if not by_blocks:
        at_most = polynomial_residues(p, decision.closed.modulus).multiplicity_in(decision.closed)
    return FixedFactor(
        polynomial=p,
        multiplicity_in_A=None if open_exponent else obstruction.multiplicity_in_A,
        multiplicity_at_most=at_most,
        channels=system.named(i for i in range(system.m) if i not in T),
        rank=system.n - deficiency,
        stable=region.contains_roots_of(p),
        roots=roots,
    )


def _completion(decision: Decision, rng: random.Random) -> Completion:
    """Compute B_0 (n × ρ) and C_0 (ρ × n); d columns and rows move the factors of deficiency d."""
    modular = decision.modular
    n, ell = modular.system.n, modular.modulus
    rho = max(o.subspace.deficiency for o in decision.obstructions)
    closed = closed_loop(modular, decision.gains)
    of_deficiency: dict[int, Polynomial] = {}
    for o in decision.obstructions:
        d = o.subspace.deficiency
        of_deficiency[d] = of_deficiency.get(d, product([])) * o.polynomial
    while True:
        B0, C0 = random_matrix(n, rho, ell, rng), random_matrix(rho, n, ell, rng)
        for d, factors in of_deficiency.items():
            completed = closed + B0.take(cols=range(d)) @ C0.take(rows=range(d))
            chi = completed.characteristic_polynomial()
            if chi.gcd(polynomial_residues(factors, ell)).degree > 0:
                break
        else:
            return Completion(lifted(B0), lifted(C0))


def _beyond_bound(
    system: MultiChannelSystem,
    factors: Sequence[FixedFactor],
    subspaces: tuple[Subspace, ...],
    rng: random.Random,
) -> TwoPolynomials:
    """Two polynomials modulo ℓ beyond a bound, so that nobody needs χ_A over Q.

    ℓ is a product of primes of a machine word: what is coprime modulo each of them is coprime
    modulo ℓ.
    """
    bits = _bound(system, factors).bit_length()
    count = -(-bits // 60)
    size = max(31, -(-bits // count) + 1)
    rho = max((system.n - factor.rank for factor in factors), default=0)
    while True:
        gains = [_drawn(p, q, rng) for p, q in system.sizes]
        B0, C0 = _drawn(system.n, rho, rng), _drawn(rho, system.n, rng)
        chosen = list(islice(residue_systems(system, rng, size), count))
        moduli = {modular.modulus for modular in chosen}
        if len(moduli) == count and all(
            _moves_the_rest(modular, gains, B0, C0, factors) for modular in chosen
        ):
            completion = Completion(B0, C0) if factors else None
            return TwoPolynomials(tuple(gains), math.prod(moduli), subspaces, completion)


def _drawn(nrows: int, ncols: int, rng: random.Random) -> Matrix:
    """Integers of 20 bits: the exponents in χ_{A_F} are nearly always the least ones."""
    rows = [[rng.getrandbits(20) for _ in range(ncols)] for _ in range(nrows)]
    return Matrix.from_integers(rows, ncols=ncols)


def _bound(system: MultiChannelSystem, factors: Sequence[FixedFactor]) -> int:
    """What ℓ has to exceed: Σ_j |D^(k−j) h_j| ρ^j for h = Π p^(e−d) of degree k, d = n − rank.

    ρ^8 is at least the norm of (D·A)^8, which is much less than that of D·A to the power 8.
    """
    n, D = system.n, system.A.denominator
    more = [(each.polynomial, each.multiplicity_at_most - n + each.rank) for each in factors]
    h = product(p**times for p, times in more)
    power = system.A * D
    for _ in range(_SQUARES):
        power = power @ power
    sums = [[sum(map(abs, row)) for row in M.numerators] for M in (power, power.T)]
    rho = min(max(each, default=0) for each in sums)
    for _ in range(_SQUARES):
        rho = rho and math.isqrt(rho - 1) + 1
    return sum(
        math.ceil(abs(c) * D ** (h.degree - j) * rho**j) for j, c in enumerate(h.coefficients)
    )


def _moves_the_rest(
    modular: ModularSystem,
    gains: Sequence[Matrix],
    B0: Matrix,
    C0: Matrix,
    factors: Sequence[FixedFactor],
) -> bool:
    """Whether, modulo ℓ, gains leave the factors as often as claimed, and nothing else of χ_A.

    B_0 C_0, cut to the deficiency of a factor, has to move all of its roots.
    """
    ell, n = modular.modulus, modular.system.n
    reduced = tuple(tuple(tuple(x % ell for x in row) for row in F.numerators) for F in gains)
    closed = closed_loop(modular, reduced)
    rest = closed.characteristic_polynomial()
    b, c = residues(B0, ell), residues(C0, ell)
    completed: dict[int, ModularPolynomial] = {}
    for factor in factors:
        p, d = polynomial_residues(factor.polynomial, ell), n - factor.rank
        if p.multiplicity_in(rest) != factor.multiplicity_at_most:
            return False
        for _ in range(factor.multiplicity_at_most):
            rest = rest // p
        if d not in completed:
            loop = closed + b.take(cols=range(d)) @ c.take(rows=range(d))
            completed[d] = loop.characteristic_polynomial()
        if completed[d].gcd(p).degree > 0:
            return False
    return rest.gcd(modular.A.characteristic_polynomial()).degree == 0


# Completeness.

Freedom = ByBlocks | tuple[Matrix, ...]
"""The proof that no mode is fixed: by blocks, or gains that move every mode."""


@overload
def completeness(
    system: MultiChannelSystem, *, spectrum: FixedSpectrum | None = None
) -> Completeness: ...


@overload
def completeness(system: ParametricSystem) -> ParametricCompleteness: ...


def completeness(
    system: MultiChannelSystem | ParametricSystem, *, spectrum: FixedSpectrum | None = None
) -> Completeness | ParametricCompleteness:
    """Decide whether a system is complete.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answer says whether it is complete for almost every
        value, and for which values it is not (`ParametricCompleteness`).
    spectrum : FixedSpectrum, optional
        ``fixed_spectrum(system)`` of a plant without parameters, if it is known already.

    Notes
    -----
    Exact.  The certificate for yes proves that no mode is fixed, and has edges that connect all
    channels.  The certificate for no has a shrunk subspace for one fixed mode, or a set of channels
    whose inputs do not affect the outputs of the others.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> I = [[1, 0], [0, 1]]
    >>> apart = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> completeness(apart).complete
    False
    >>> ring = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[0, 1]], [[1, 0]]])
    >>> completeness(ring).complete
    True
    >>> completeness(MultiChannelSystem([], [[], []], [[], []])).complete
    False
    """
    if not isinstance(system, ParametricSystem):
        system = without_feedthrough(system)
    known = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        # start-up: few plants need it
        from mcexact.analysis.parameters.hypersurfaces import parametric_completeness

        return parametric_completeness(system)
    spectrum = fixed_spectrum(system) if known is None else known
    rng = generator(system, "completeness")
    evidence = _evidence(system, spectrum, rng)
    complete = isinstance(evidence, BlocksWitness | FreedomWitness)
    return Completeness(system, complete=complete, evidence=evidence)


def _evidence(system: MultiChannelSystem, spectrum: FixedSpectrum, rng: random.Random) -> Evidence:
    if not spectrum.empty:
        return FixedModeWitness(spectrum.factors[0].polynomial, spectrum.evidence.subspaces[0])
    if isinstance(spectrum.evidence, ByBlocks) and is_large_and_sparse(system):
        shown = _by_structure(system, spectrum.evidence)
        if shown is not None:
            return shown
    # Some edges vanish by accident, perhaps modulo one prime for all draws.
    for modular, proof in _freedom(system, spectrum, rng):
        suspected = suspected_edges(modular, rng)
        closed = _closed_set(system.m, suspected)
        if closed is None:
            return _connected(modular, proof, _connecting_edges(system.m, suspected))
        subspace = controllable_subspace(system.A, system.input_matrix(closed), rng)
        rest = [i for i in range(system.m) if i not in closed]
        if (system.output_matrix(rest) @ subspace.X).is_zero():
            return CutWitness(zero_transfer(system, closed, subspace))
    raise InternalError("the stream of primes is endless")


def _by_structure(system: MultiChannelSystem, proof: ByBlocks) -> Evidence | None:
    """A cut of a large sparse system that no path crosses, or edges of the least powers."""
    paths = {(int(j), int(i)) for j, i in zip(*reachable_pairs(system).nonzero(), strict=True)}
    closed = _closed_set(system.m, paths)
    if closed is not None:
        return PathCutWitness(system.named(closed))
    found = _connecting_arcs(system)
    return None if found is None else BlocksWitness(proof.blocks, *found)


def _connecting_arcs(
    system: MultiChannelSystem,
) -> tuple[int, tuple[tuple[str, str, int], ...]] | None:
    """A modulus, and edges of the least powers that connect all channels of a sparse system."""
    found = edge_powers(system, is_connected)
    if found is None:
        return None
    (ell, powers), names = found, system.names
    edges = {(int(j), int(i)) for j, i in zip(*(powers >= 0).nonzero(), strict=True)}
    chosen = sorted(_connecting_edges(system.m, edges))
    return ell, tuple((names[j], names[i], int(powers[j, i])) for j, i in chosen)


def _connected(modular: ModularSystem, proof: Freedom, chosen: set[Edge]) -> Evidence:
    """The evidence for yes, with edges that connect all channels."""
    found, ell, names = witnessed_powers(modular, chosen), modular.modulus, modular.system.names
    powers = {edge: found[edge] for edge in chosen}
    if isinstance(proof, ByBlocks):
        ell, powers = short_powers(modular, powers)
    arcs = tuple((names[j], names[i], powers[j, i]) for j, i in sorted(chosen))
    if isinstance(proof, ByBlocks):
        return BlocksWitness(proof.blocks, ell, arcs)
    return FreedomWitness(ell, proof, arcs)


def _freedom(
    system: MultiChannelSystem, spectrum: FixedSpectrum, rng: random.Random
) -> Iterator[tuple[ModularSystem, Freedom]]:
    """Yield systems modulo primes for the edges, each with a proof that nothing is fixed.

    That gains move every mode may be proved modulo another prime than the edges.
    """
    if isinstance(spectrum.evidence, ByBlocks):
        for modular in residue_systems(system, rng):
            yield modular, spectrum.evidence
        return
    yield ModularSystem(system, spectrum.evidence.modulus), spectrum.evidence.gains
    while True:
        decision = decide(system, rng)
        yield decision.modular, lifted_gains(decision.modular, decision.gains)


def _reached(m: int, start: int, edges: set[Edge]) -> list[Edge]:
    """Edges of a tree from ``start`` to every node that it reaches, nearest first."""
    successors: list[list[int]] = [[] for _ in range(m)]
    for j, i in sorted(edges):
        successors[j].append(i)
    seen, level, tree = {start}, [start], []
    while level:
        following = []
        for j in level:
            for i in successors[j]:
                if i not in seen:
                    seen.add(i)
                    following.append(i)
                    tree.append((j, i))
        level = following
    return tree


def _closed_set(m: int, edges: set[Edge]) -> tuple[int, ...] | None:
    """A smallest nonempty proper set of nodes that no edge leaves, if any: a strong component."""
    components = strong_components(m, edges)
    at = {node: k for k, component in enumerate(components) for node in component}
    left = {at[j] for j, i in edges if at[i] != at[j]}
    closed = [s for k, s in enumerate(components) if k not in left and len(s) < m]
    return min(closed, key=lambda s: (len(s), s), default=None)


def _connecting_edges(m: int, edges: set[Edge]) -> set[Edge]:
    """At most 2(m − 1) edges of a strongly connected graph that keep it so."""
    if m < 2:
        return set()
    backwards = _reached(m, 0, {(i, j) for j, i in edges})
    return set(_reached(m, 0, edges)) | {(j, i) for i, j in backwards}


# Assignability of the spectrum, over the strong components of the transfer graph.


def assignability(
    system: MultiChannelSystem, *, graph: TransferGraph | None = None
) -> Assignability:
    """Compute the degrees into which det(xI − A_F) splits over the strong components.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : TransferGraph, optional
        ``transfer_graph(system)``, if it is known already.

    Notes
    -----
    Paper, end of section IV-A.  det(xI − A_F) = det(xI − A) det(I − C(xI − A)⁻¹B F), and the
    transfer matrix is block triangular in an order of the components, so the second factor is the
    product over the components c of the same for C_c (xI − A)⁻¹ B_c, F_c, which a minimal
    realization of degree d_c turns into a quotient of polynomials of degree d_c.  This holds with
    fixed modes, inactive channels and without joint controllability.  Exact.  The certificate has a
    Krylov sequence for each component, which bounds d_c from below; and the states that are not
    controlled or not observed, which bound it from above.  O(n³) word operations if d_c = n.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> B, C = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> answer = assignability(MultiChannelSystem([[0, 0], [1, 0]], B, C))
    >>> answer.undivided, [(block.channels, block.dimension) for block in answer.blocks]
    (False, [(('1',), 1), (('2',), 1)])
    """
    system = without_feedthrough(system)
    known = TransferGraph.known(graph, system, "graph")
    quick = known is None and is_large_and_sparse(system)
    found = _connecting_arcs(system) if quick and is_connected(reachable_pairs(system)) else None
    parts: tuple[tuple[str, ...], ...] = (system.names,)
    if found is not None:
        components = OrderedComponents(*found, order=(0,), zeros=())
    else:
        graph = transfer_graph(system) if known is None else known
        parts, components = graph.components, _ordered(graph)
    rng = generator(system, "assignability")
    arcs = _arcs(system.A) if system.A.is_sparse or len(parts) > 1 else None
    degrees = tuple(_degree(system, system.indices(c), rng, arcs) for c in parts)
    blocks = tuple(
        SpectrumBlock(c, degree.number) for c, degree in zip(parts, degrees, strict=True)
    )
    return Assignability(
        system,
        blocks=blocks,
        fixed_degree=system.n - sum(block.dimension for block in blocks),
        evidence=ByDegrees(components, degrees),
    )


def _ordered(graph: TransferGraph) -> OrderedComponents:
    """Edges that connect each component, and what no edge of a transfer graph leads back from."""
    at = {name: k for k, part in enumerate(graph.components) for name in part}
    chosen = set[tuple[str, str]]()
    for k, part in enumerate(graph.components):
        place = {name: i for i, name in enumerate(part)}
        inside = {(place[j], place[i]) for j, i in graph.arcs if at[j] == at[i] == k}
        chosen |= {(part[j], part[i]) for j, i in _connecting_edges(len(part), inside)}
    into, out = ([list[int]() for _ in graph.components] for _ in range(2))
    for j, i in graph.arcs:
        into[at[i]].append(at[j])
        out[at[j]].append(at[i])
    order = [k for part in reversed(components_of(into, out)) for k in part]
    return OrderedComponents(
        modulus=graph.modulus,
        arcs=tuple(
            (*arc, k) for arc, k in zip(graph.arcs, graph.powers, strict=True) if arc in chosen
        ),
        order=tuple(order),
        zeros=tuple(zero for zero in graph.zeros if _leads_back(zero, graph, at, order)),
    )


def _leads_back(
    zero: ZeroTransfer, graph: TransferGraph, at: dict[str, int], order: list[int]
) -> bool:
    """Whether some source does not act on a channel of an earlier component."""
    place = {k: turn for turn, k in enumerate(order)}
    return any(
        place[at[i]] < place[at[j]]
        for j in zero.channels_from
        for i in at.keys() - set(graph.successors.get(j, ()))
    )


def _degree(
    system: MultiChannelSystem, c: Sequence[int], rng: random.Random, arcs: Arcs | None
) -> Degree:
    """The McMillan degree of C_c (xI − A)⁻¹ B_c with its evidence.

    ``arcs`` are given if some states may be on no path.
    """
    A, inputs, outputs = system.A, [system.B(i) for i in c], [system.C(i) for i in c]
    states = None if arcs is None else _on_paths(arcs, inputs, outputs)
    if states is not None:
        A = A.take(states, states)
        inputs = [M.take(rows=states) for M in inputs]
        outputs = [M.take(cols=states) for M in outputs]
    n, B, C = A.nrows, hstack(inputs), vstack(outputs)
    merged = MultiChannelSystem(A, [B], [C], time=system.time)
    # Gains of the channels alone leave a sparse loop sparse.
    apart = MultiChannelSystem(A, inputs, outputs, time=system.time) if A.is_sparse else merged
    drawn = best_sequences(apart, system.denominator)
    best = _of_all_channels(max(drawn, key=lambda each: each.degree), apart)
    if best.degree == n:
        return Degree(states, Matrix.zeros(0, n), (), Matrix.zeros(0, n), (), best if n else None)
    reached = controllable_subspace(A, B, rng)
    W = reached.annihilator()
    observed = controllable_subspace(A.T, vstack([C, W]).T, rng)
    degree = reached.dimension + observed.dimension - n
    primes_in_turn = residue_systems(merged, rng, bits=61)
    while best.degree < degree:
        modular = next(each for each in primes_in_turn if system.denominator % each.modulus)
        best = longest_sequence(modular, rng, None)
    kernel = observed.annihilator()
    sequence = best if degree else None
    return Degree(states, W, reached.free, kernel, observed.free, sequence)


def _of_all_channels(sequence: KrylovSequence, parts: MultiChannelSystem) -> KrylovSequence:
    """The same numbers by all channels taken as one, with the name "1"."""
    q = parts.index(sequence.channel)
    before = parts.channels[:q]
    p, r = sum(c.B.ncols for c in before), sum(c.C.nrows for c in before)
    return replace(
        sequence,
        gains=(block_diagonal(sequence.gains),),
        channel="1",
        inputs=_padded(sequence.inputs, p, sum(c.B.ncols for c in parts.channels)),
        outputs=_padded(sequence.outputs, r, sum(c.C.nrows for c in parts.channels)),
    )


def _padded(numbers: Sequence[int], start: int, size: int) -> tuple[int, ...]:
    return (*(0,) * start, *numbers, *(0,) * (size - start - len(numbers)))


Arcs = tuple[list[list[int]], list[list[int]]]
"""For each state those that it drives, and those that drive it."""


def _arcs(A: Matrix) -> Arcs:
    ahead: list[list[int]] = [[] for _ in range(A.nrows)]
    behind: list[list[int]] = [[] for _ in range(A.nrows)]
    for a, b, _ in A.nonzero():
        ahead[b].append(a)
        behind[a].append(b)
    return ahead, behind


def _on_paths(
    arcs: Arcs, inputs: Sequence[Matrix], outputs: Sequence[Matrix]
) -> tuple[int, ...] | None:
    """The states on paths from inputs to outputs; None for all."""
    ahead, behind = arcs
    driven = _closure({a for B in inputs for a, _, _ in B.nonzero()}, ahead)
    measured = _closure({b for C in outputs for _, b, _ in C.nonzero()}, behind)
    states = tuple(sorted(driven & measured))
    return None if len(states) == len(ahead) else states


def _closure(start: set[int], arcs: list[list[int]]) -> set[int]:
    """The nodes that some arcs lead to from a set, with the set itself."""
    reached, rest = set(start), list(start)
    while rest:
        new = [a for a in arcs[rest.pop()] if a not in reached]
        reached.update(new)
        rest += new
    return reached


# The rank of one pencil P_s(λ).


def pencil(system: MultiChannelSystem, s: Iterable[int]) -> tuple[Matrix, Matrix]:
    """The two coefficients of P_s(x) = M_0 + x M_1.

    Parameters
    ----------
    system : MultiChannelSystem
    s : iterable of int
        Positions of channels.

    Returns
    -------
    M0, M1 : Matrix
        Both (n + q_s) × (n + p_{m−s}), where q_s is the number of outputs of the channels in s,
        and p_{m−s} the number of inputs of all others:

            [ xI − A   B_{m−s} ]
            [   C_s       0    ]
    """
    inside = set(s)
    n = system.n
    B = system.input_matrix(i for i in range(system.m) if i not in inside)
    C = system.output_matrix(inside)
    M0 = block([[-system.A, B], [C, Matrix.zeros(C.nrows, B.ncols)]])
    M1 = block(
        [
            [Matrix.identity(n), Matrix.zeros(n, B.ncols)],
            [Matrix.zeros(C.nrows, n), Matrix.zeros(C.nrows, B.ncols)],
        ]
    )
    return M0, M1


def pencil_rank(system: MultiChannelSystem, subset: Iterable[str], mode: Any) -> PencilRank:
    """Compute the rank of P_s(λ) = [λI − A, B_{m−s}; C_s, 0].

    Parameters
    ----------
    system : MultiChannelSystem
    subset : iterable of str
        s, by the names of its channels; the empty set and all channels are allowed.
    mode : Polynomial, or a rational number
        An irreducible polynomial whose roots are the λ, or λ itself.

    Raises
    ------
    InputError
        If the polynomial is constant or reducible: its roots could have different ranks.
    UsageError
        If there is no channel of that name.

    Notes
    -----
    Exact.  With p the irreducible polynomial of the mode, the certificate has the null space over
    Q[x]/(p), which bounds the rank from above, and a prime modulo which elimination with unit
    pivots bounds it from below.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    >>> pencil_rank(system, ["1"], 1).rank
    2
    >>> pencil_rank(system, [], 3).rank
    2
    """
    system = without_feedthrough(system)
    p = _irreducible(mode)
    inside = system.indices(subset)
    M0, M1 = pencil(system, inside)
    null_space, pivots = nullspace_at(M0, M1, p)
    rank = M0.ncols - len(pivots)
    return PencilRank(
        system,
        subset=system.named(inside),
        polynomial=p,
        rank=rank,
        modulus=_pencil_modulus(system, M0, M1, p, rank),
        kernel=null_space,
        pivots=pivots,
    )


def pencil_ranks(
    system: MultiChannelSystem,
    subset: Iterable[str],
    *,
    spectrum: ClosedLoopSpectrum | None = None,
) -> tuple[PencilRank, ...]:
    """Compute the rank of P_s at every mode of A, one for each irreducible factor of det(xI − A).

    Parameters
    ----------
    system : MultiChannelSystem
    subset : iterable of str
        s, by the names of its channels.
    spectrum : ClosedLoopSpectrum, optional
        ``open_loop_spectrum(system)``, if it is known already.
    """
    system = without_feedthrough(system)
    names = system.named(system.indices(subset))
    known = ClosedLoopSpectrum.known(spectrum, system, "spectrum")
    modes = open_loop_spectrum(system) if known is None else known
    return tuple(pencil_rank(system, names, mode) for mode, _ in modes.polynomial.factor())


def _irreducible(mode: Any) -> Polynomial:
    p = (
        mode
        if isinstance(mode, Polynomial)
        else Polynomial.from_roots([as_fraction(mode, where="mode")])
    )
    if p.degree < 1:
        raise InputError("expected a number or a polynomial of degree at least 1", where="mode")
    factors = [factor for factor, _ in p.factor()]
    if factors != [p.monic()]:
        listed = ", ".join(map(str, factors))
        raise InputError(
            f"expected an irreducible polynomial; ask for each of its factors: {listed}",
            where="mode",
        )
    return factors[0]


def _pencil_modulus(
    system: MultiChannelSystem, M0: Matrix, M1: Matrix, p: Polynomial, rank: int
) -> int:
    """A prime modulo which the pencil keeps its rank at every root of p."""
    inflated = inflate(PolynomialMatrix.pencil(M0, M1), p)
    for ell in primes(generator(system, "pencil_rank").getrandbits(64), bits=61):
        if (inflated.denominator * M0.denominator) % ell == 0 or p.denominator % ell == 0:
            continue
        if residues(inflated, ell).rank() == rank * p.degree:
            return ell
    raise InternalError("the stream of primes is endless")
