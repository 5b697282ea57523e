"""Evidence for the optimum of a covering program: absence, cuts, and a branch tree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.answer.evidence import Block, ShrunkSubspace, ZeroTransfer
from mcexact.answer.protocol import Part
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial

Tree = Sequence[Mapping[str, Any]]
"""The nodes of a branch tree in preorder, as plain data and Fractions, as in ``FORMAT.md``."""


@dataclass(frozen=True)
class Absence(Part):
    """Evidence that no mode outside the region is fixed and, if claimed, of a connected graph.

    Attributes
    ----------
    gains : tuple of Matrix
        F̄_i of the system of the claim.
    modulus : int
        ℓ ≥ 2.
    allowed : tuple of (Polynomial, int)
        Factors p inside the region, with their exponents in the characteristic polynomial.
    arcs : tuple of (str, str, int), or None
        (j, i, k) with C̄_i Ā^k B̄_j ≠ 0 modulo ℓ.
    """

    gains: tuple[Matrix, ...]
    modulus: int
    allowed: tuple[tuple[Polynomial, int], ...] = ()
    arcs: tuple[tuple[str, str, int], ...] | None = None


@dataclass(frozen=True)
class BlocksAbsence(Part):
    """Evidence that no mode is fixed and, if claimed, of a connected graph.

    Attributes
    ----------
    blocks : tuple of Block
        Of the system of the claim; they leave no mode.
    modulus : int or None
        ℓ ≥ 2, for the edges; None if there are none.
    arcs : tuple of (str, str, int), or None
        (j, i, k) with C̄_i Ā^k B̄_j ≠ 0 modulo ℓ.
    """

    blocks: tuple[Block, ...]
    modulus: int | None = None
    arcs: tuple[tuple[str, str, int], ...] | None = None


@dataclass(frozen=True)
class DeficiencyCut(Part):
    """Σ n_i over N_s∖s is at least the deficiency of P_s at every root of p.

    Attributes
    ----------
    subset : tuple of str
        The names of s.
    polynomial : Polynomial
        p, monic, not inside the region.
    deficiency : int
        d ≥ 1.
    subspace : ShrunkSubspace
        Of deficiency d for p, with T the complement of s.
    """

    subset: tuple[str, ...]
    polynomial: Polynomial
    deficiency: int
    subspace: ShrunkSubspace


@dataclass(frozen=True)
class ConnectivityCut(Part):
    """Nothing passes from the complement of s to s, so that Σ n_i over N_s∖s is at least 1.

    Attributes
    ----------
    subset : tuple of str
        The names of s, nonempty and proper.
    zero : ZeroTransfer
        From the complement of s to s.
    """

    subset: tuple[str, ...]
    zero: ZeroTransfer


@dataclass(frozen=True)
class LinkCut(Part):
    """Evidence that one of the links j → i with i ∉ T and S_j U ≠ 0 must be added.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic, not inside the region.
    subspace : ShrunkSubspace
        For p, in the system over the given neighbor graph.
    """

    polynomial: Polynomial
    subspace: ShrunkSubspace
