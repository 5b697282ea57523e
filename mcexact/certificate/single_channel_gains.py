"""Certificate: gains with which single channels control or observe a system, or why none do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.answer.evidence import ShrunkSubspace, ZeroTransfer
from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class GainsWitness:
    """Evidence for yes: the gains, and rows that no index can be smaller for.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i, one list for all channels named.
    modulus : int
        ℓ ≥ 2, modulo which the ranks reach n.
    annihilators : tuple of tuple of Matrix
        For each channel and each thing asked, a 1 × n row that annihilates the blocks before the
        last one that is needed.
    generator : Matrix or None
        b, n × 1, with b, A_F b, …, A_F^{n−1} b independent modulo ℓ: A_F is cyclic.
    """

    gains: tuple[Matrix, ...]
    modulus: int
    annihilators: tuple[tuple[Matrix, ...], ...]
    generator: Matrix | None

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {
            "gains": self.gains,
            "modulus": self.modulus,
            "annihilators": self.annihilators,
            "generator": self.generator,
        }


@dataclass(frozen=True)
class StuckWitness:
    """Evidence for no: a mode that no gains let the channel control or observe.

    Attributes
    ----------
    channel : str
        q.
    side : str
        ``"controllable"``, or ``"observable"``: then the subspace is one of the dual.
    polynomial : Polynomial
        p, monic of degree at least 1.
    subspace : ShrunkSubspace
        For p, with q in T.
    """

    channel: str
    side: str
    polynomial: Polynomial
    subspace: ShrunkSubspace

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {
            "channel": self.channel,
            "side": self.side,
            "polynomial": self.polynomial,
            "subspace": self.subspace,
        }


@dataclass(frozen=True)
class UnreachedWitness:
    """Evidence for no: channels that nothing leads to from the channel in question.

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

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"channel": self.channel, "side": self.side, "zero": self.zero}


@dataclass(frozen=True)
class SingleChannelGainsCertificate(Certificate):
    """One list of decentralized gains serves every channel named, or none serves one of them.

    Attributes
    ----------
    channels : tuple of str
        The q, in the order of the system.
    wanted : str
        ``"controllable"``, ``"observable"`` or ``"both"``.
    exists : bool
    cyclic : bool
        Whether the certificate says that A_F is cyclic, too; False says nothing.
    indices : tuple of tuple of int, or None
        For each channel the controllability index of (A_F, B_q) and the observability index of
        (C_q, A_F), whichever was asked for.
    evidence : GainsWitness, StuckWitness or UnreachedWitness
        The first for yes, one of the others for no.
    """

    kind: ClassVar[str] = "single_channel_gains"

    channels: tuple[str, ...]
    wanted: str
    exists: bool
    cyclic: bool
    indices: tuple[tuple[int, ...], ...] | None
    evidence: GainsWitness | StuckWitness | UnreachedWitness

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "channels": self.channels,
            "property": self.wanted,
            "exists": self.exists,
            "cyclic": self.cyclic,
            "indices": self.indices,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return self.evidence.document()
