"""Answer: gains with which single channels control or observe a system, or an obstruction."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.answer.evidence import ShrunkSubspace, ZeroTransfer
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


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
    subspace : ShrunkSubspace
        For p, with q in T.
    """

    channel: str
    side: str
    polynomial: Polynomial
    subspace: ShrunkSubspace


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
