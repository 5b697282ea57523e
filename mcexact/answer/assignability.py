"""Answer: how the characteristic polynomial of A_F splits over the strong components."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.answer.transfer_graph import TransferGraph
from mcexact.exact.matrix import Matrix


@dataclass(frozen=True)
class MinimalRealization(Part):
    """A minimal realization of C_c (xI − A)⁻¹ B_c: the subspace im X, reduced by the rows of W.

    Attributes
    ----------
    X : Matrix
        n × a, im X the smallest A-invariant subspace that contains im B_c.
    pivots : tuple of int
        a rows of X that form the identity.
    W : Matrix
        d × a, W A_x = Â W and C_c X = Ĉ W.
    columns : tuple of int
        d columns of W that form the identity.
    """

    X: Matrix
    pivots: tuple[int, ...]
    W: Matrix
    columns: tuple[int, ...]


@dataclass(frozen=True)
class SpectrumBlock(Part):
    """A strong component of the transfer graph and its part of the spectrum.

    Attributes
    ----------
    channels : tuple of str
        c.
    dimension : int
        The number of eigenvalues, a symmetric set, that depend on the gains of c and on no others:
        the McMillan degree of C_c (xI − A)⁻¹ B_c.
    """

    brief = ("channels", "dimension")

    channels: tuple[str, ...]
    dimension: int


@answer("assignability")
class Assignability(Answer):
    """det(xI − A_F) is one fixed polynomial times one polynomial for each strong component.

    Attributes
    ----------
    blocks : tuple of SpectrumBlock
        One for each strong component.  Without fixed modes each can be assigned independently:
        together with the states of its controllers, to every symmetric set of that size, which
        contains a real number if the size is odd.
    fixed_degree : int
        The number of eigenvalues, with multiplicity, that belong to no block and depend on no gain;
        0 if no mode is fixed.
    modulus : int
        ℓ ≥ 2, modulo which the realizations are controllable and observable.
    transfer_graph : TransferGraph
        The transfer graph of the same system.
    realizations : tuple of MinimalRealization
        One for each block.
    """

    blocks: tuple[SpectrumBlock, ...] = claim()
    fixed_degree: int = claim()
    modulus: int = witness()
    transfer_graph: TransferGraph = witness()
    realizations: tuple[MinimalRealization, ...] = witness()

    @property
    def undivided(self) -> bool:
        """Whether at most one block has a dimension above 0.

        If no mode is fixed either, and only then, dynamic linear time-invariant channel controllers
        can assign every symmetric spectrum.
        """
        return sum(block.dimension > 0 for block in self.blocks) <= 1
