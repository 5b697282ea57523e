"""Free assignability of the spectrum, or its partition over the strong components."""

from __future__ import annotations

from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.answer.assignability import Assignability, MinimalRealization, SpectrumBlock
from mcexact.answer.transfer_graph import TransferGraph
from mcexact.derived.modular import generator, residue_systems
from mcexact.errors import InputError, InternalError
from mcexact.exact.krylov import controllable_subspace, krylov_rows
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem


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
    fixed modes, inactive channels and without joint controllability.  Exact.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> B, C = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> found = assignability(MultiChannelSystem([[0, 0], [1, 0]], B, C))
    >>> found.undivided, [(block.channels, block.dimension) for block in found.blocks]
    (False, [(('1',), 1), (('2',), 1)])
    """
    InputError.require(system, MultiChannelSystem, "system")
    known = TransferGraph.known(graph, system, "graph")
    graph = transfer_graph(system) if known is None else known
    rng = generator(system, "assignability")
    realizations, degrees = [], []
    for component in graph.components:
        channels = system.indices(component)
        space = controllable_subspace(system.A, system.input_matrix(channels), rng)
        inner = (system.A @ space.X).take(rows=space.pivots)
        seen = controllable_subspace(inner.T, (system.output_matrix(channels) @ space.X).T, rng)
        realizations.append(MinimalRealization(space.X, space.pivots, seen.X.T, seen.pivots))
        driven = seen.X.T @ system.input_matrix(channels).take(rows=space.pivots)
        reduced = (seen.X.T @ inner).take(cols=seen.pivots)
        measured = (system.output_matrix(channels) @ space.X).take(cols=seen.pivots)
        degrees.append((seen.dimension, reduced, driven, measured))
    blocks = tuple(
        SpectrumBlock(c, d) for c, (d, *_) in zip(graph.components, degrees, strict=True)
    )
    return Assignability(
        system,
        blocks=blocks,
        fixed_degree=system.n - sum(block.dimension for block in blocks),
        modulus=_modulus(system, degrees),
        transfer_graph=graph,
        realizations=tuple(realizations),
    )


def _modulus(system: MultiChannelSystem, parts: list[tuple[int, Matrix, Matrix, Matrix]]) -> int:
    """A prime modulo which every realization is controllable and observable."""
    for modular in residue_systems(system, generator(system, "assignability"), bits=61):
        ell = modular.modulus
        for d, A, B, C in parts:
            if (A.denominator * B.denominator * C.denominator) % ell == 0:
                break
            if len(krylov_rows(A, B, ell)[1]) < d or len(krylov_rows(A.T, C.T, ell)[1]) < d:
                break
        else:
            return ell
    raise InternalError("the stream of primes is endless")
