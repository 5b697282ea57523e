"""Kind ``single_channel_gains``: gains, or why none; ``proofs/single_channel_gains.md``."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from . import evidence, reading, subspaces
from .controllability import require_reached
from .feedback import dual
from .reading import boolean, fields, integer, items, matrix, require
from .system import System
from .words import channel, channel_set, described, polynomial_text

SIDES = ("controllable", "observable")


def check(claim: Any, witness: Any, system: System) -> str:
    """Check gains and their indices for yes; a stuck mode or a cut behind one channel for no."""
    keys: tuple[str, ...] = ("channels", "property", "exists", "cyclic", "indices")
    listed, wanted, verdict, spun, numbers = fields(claim, "claim", *keys)
    Q, cyclic = reading.names(listed, "claim.channels", system.names), boolean(spun, "claim.cyclic")
    one = reading.string(wanted, "claim.property", *SIDES, "both")
    sides = SIDES if one == "both" else (one,)
    if not boolean(verdict, "claim.exists"):
        require(numbers is None and not cyclic, "claim", "claim", "without gains, no index")
        return _lost(witness, system, Q, sides)
    keys = ("gains", "modulus", "annihilators", "generator")
    gains, ell, rows, b = fields(witness, "witness", *keys)
    F, ell = evidence.read_gains(gains, "witness.gains", system), evidence.modulus(ell, "witness")
    closed = replace(system, A=evidence.closed_loop(system, F))
    require(cyclic or b is None, "claim", "witness.generator", "expected null unless cyclic")
    if cyclic:
        b = matrix(b, "witness.generator", system.n, 1)
        require_reached(replace(closed, B=[b]), 0, ell, system.n)
    indices = [
        items(found, "claim.indices", len(sides)) for found in items(numbers, "claim", len(Q))
    ]
    rows = [
        items(part, "witness.annihilators", len(sides)) for part in items(rows, "witness", len(Q))
    ]
    for q, found, part in zip(Q, indices, rows, strict=True):
        for side, number, row in zip(sides, found, part, strict=True):
            target, nu = _seen(closed, side), integer(number, "claim.indices")
            require_reached(target, q, ell, nu)
            w = matrix(row, "witness.annihilators", 1, system.n)
            require(nu == 0 or not w.is_zero(), "row", "witness.annihilators", "zero")
            for _ in range(nu - 1):
                unseen = (w @ target.B[q]).is_zero()
                require(unseen, "identity", "witness.annihilators", f"index below {nu} is open")
                w = w @ target.A
    return (
        f"decentralized gains make {described(system)} {' and '.join(sides)} through each of "
        f"{channel_set(system, Q)}, indices {indices}{', and A_F cyclic' if cyclic else ''}"
    )


def _seen(system: System, side: str) -> System:
    return system if side == "controllable" else dual(system, {}, "")


def _lost(witness: Any, system: System, Q: list[int], sides: tuple[str, ...]) -> str:
    cut = isinstance(witness, dict) and "zero" in witness
    keys = ("zero",) if cut else ("polynomial", "subspace")
    name, side, *parts = fields(witness, "witness", "channel", "side", *keys)
    q, target = system.place_of(name, "witness"), _seen(system, reading.string(side, "witness"))
    require(q in Q and side in sides, "claim", "witness", "about what is not asked")
    if cut:
        T, X = subspaces.zero_transfer(parts[0], "witness.zero", target)
        C = evidence.outputs(target, evidence.complement(target, T))
        apart = (C @ X).is_zero() and not C.is_zero()
        require(apart, "cut", "witness.zero", "C X is not zero, or C is, outside T")
    else:
        p = reading.polynomial(parts[0], "witness.polynomial", 1)
        T = subspaces.shrunk_subspace(parts[1], "witness.subspace", target, p, 1)
    reason = "its signals do not spread" if cut else f"{polynomial_text(p)} stays out of reach"
    require(q in T, "channel", "witness.channel", "not a member of the set T")
    return f"no gains make {described(system)} {side} through {channel(system, q)}: {reason}"
