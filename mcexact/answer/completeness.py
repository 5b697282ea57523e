"""Answer: whether the transfer graph is strongly connected and no mode is fixed."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.answer.evidence import Block, ShrunkSubspace, ZeroTransfer
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class FreedomWitness(Part):
    """Evidence for yes: gains that move every mode of A, and edges that connect all channels.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which all conditions hold.
    gains : tuple of Matrix
        F_i, p_i × q_i: χ_A and χ_{A_F} are coprime modulo ℓ.
    arcs : tuple of (str, str, int)
        Edges (j, i, k) with C_i A^k B_j ≠ 0 modulo ℓ, sorted by (from, to), which make the graph
        strongly connected.
    """

    modulus: int
    gains: tuple[Matrix, ...]
    arcs: tuple[tuple[str, str, int], ...]


@dataclass(frozen=True)
class BlocksWitness(Part):
    """Evidence for yes: blocks that leave no mode, and edges that connect all channels.

    Attributes
    ----------
    blocks : tuple of Block
        One block, unless there are no states.
    modulus : int
        ℓ ≥ 2, for the edges.
    arcs : tuple of (str, str, int)
        As in `FreedomWitness`.
    """

    blocks: tuple[Block, ...]
    modulus: int
    arcs: tuple[tuple[str, str, int], ...]


@dataclass(frozen=True)
class FixedModeWitness(Part):
    """Evidence for no: a polynomial whose roots are fixed modes.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic of degree at least 1.
    subspace : ShrunkSubspace
        Of deficiency at least 1 for p.
    """

    polynomial: Polynomial
    subspace: ShrunkSubspace


@dataclass(frozen=True)
class CutWitness(Part):
    """Evidence for no: a nonempty proper set of channels without transfer to the others.

    Attributes
    ----------
    zero : ZeroTransfer
        From that set to its complement.
    """

    zero: ZeroTransfer


Evidence = BlocksWitness | FreedomWitness | FixedModeWitness | CutWitness


@answer("completeness")
class Completeness(Answer):
    """Whether the system is complete: no fixed mode, and a strongly connected transfer graph.

    Attributes
    ----------
    complete : bool
        Whether the transfer graph is strongly connected and the fixed spectrum is empty, with all
        subsets of channels included.  For n ≥ 1 this holds if and only if some F makes the system
        controllable and observable through every single channel.  For n = 0 every F does, but a
        system with several channels is not complete, since no channel affects another.
    evidence : BlocksWitness, FreedomWitness, FixedModeWitness or CutWitness
        One of the first two for yes, one of the others for no.
    """

    complete: bool = claim()
    evidence: Evidence = witness(whole=True)
