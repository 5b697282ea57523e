"""Whether the spectrum is freely assignable, or how it splits over the strong components."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.invariant_subspace import controllable_subspace, krylov_rows
from mcexact.analysis.modular_system import generator, residue_systems
from mcexact.analysis.transfer_graph import TransferGraph, transfer_graph
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.certificate.assignability import AssignabilityCertificate, MinimalRealization
from mcexact.errors import InternalError
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import canonical_document


@dataclass(frozen=True)
class SpectrumBlock:
    """A strong component of the transfer graph and its part of the spectrum.

    Attributes
    ----------
    channels : tuple of str
        c.
    dimension : int
        How many eigenvalues, a symmetric set, depend on the gains of c, and on no others: the
        McMillan degree of C_c (xI − A)⁻¹ B_c.
    """

    channels: tuple[str, ...]
    dimension: int


@dataclass(frozen=True)
class Assignability:
    """How the spectrum of A_F depends on the gains.

    Attributes
    ----------
    free : bool
        No mode is fixed, and at most one block has a dimension above 0: with dynamic linear
        time-invariant channel controllers every symmetric spectrum can be assigned.
    blocks : tuple of SpectrumBlock
        One for each strong component.  Without fixed modes each can be assigned by itself, to
        every symmetric set of its dimension and of the states of its controllers; where the
        number of all of them is odd, one is real.
    fixed_degree : int
        How many eigenvalues, with multiplicity, belong to no block and depend on no gain; 0 if no
        mode is fixed.
    certificate : AssignabilityCertificate
    """

    free: bool
    blocks: tuple[SpectrumBlock, ...]
    fixed_degree: int
    certificate: AssignabilityCertificate


def assignability(
    system: MultiChannelSystem,
    *,
    spectrum: FixedSpectrum | None = None,
    graph: TransferGraph | None = None,
) -> Assignability:
    """Compute the degrees into which det(xI − A_F) splits over the strong components.

    Parameters
    ----------
    system : MultiChannelSystem
    spectrum, graph : optional
        ``fixed_spectrum(system)`` and ``transfer_graph(system)``, where they are known already.

    Notes
    -----
    Paper, end of section IV-A.  det(xI − A_F) = det(xI − A) det(I − C(xI − A)⁻¹B F), and the
    transfer matrix is block triangular in an order of the components, so the second factor is the
    product over the components c of the same for C_c (xI − A)⁻¹ B_c, F_c, which a minimal
    realization of degree d_c turns into a quotient of polynomials of degree d_c.  This holds with
    fixed modes, dead channels and without joint controllability.  Exact.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> B, C = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> found = assignability(MultiChannelSystem([[0, 0], [1, 0]], B, C))
    >>> found.free, [(block.channels, block.dimension) for block in found.blocks]
    (False, [(('1',), 1), (('2',), 1)])
    """
    spectrum = fixed_spectrum(system) if spectrum is None else spectrum
    graph = transfer_graph(system) if graph is None else graph
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
    certificate = AssignabilityCertificate(
        system=canonical_document(system.plant),
        subject=system.subject,
        blocks=tuple((block.channels, block.dimension) for block in blocks),
        fixed_degree=system.n - sum(block.dimension for block in blocks),
        modulus=_modulus(system, degrees),
        transfer_graph=graph.certificate,
        realizations=tuple(realizations),
    )
    free = spectrum.empty and sum(block.dimension > 0 for block in blocks) <= 1
    return Assignability(free, blocks, certificate.fixed_degree, certificate)


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
