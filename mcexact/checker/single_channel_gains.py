"""Kind ``single_channel_gains``: gains, or an obstruction; ``proofs/single_channel_gains.md``."""

from dataclasses import replace

from . import evidence, reading, subspaces
from .controllability import require_reached
from .feedback import dual
from .reading import Json, boolean, fields, integer, items, matrix, require
from .statement import canonical_json, channel_set
from .system import System

SIDES = ("controllable", "observable")
PAIRS = dict(zip(SIDES, ("(A_F, B_q)", "(C_q, A_F)"), strict=True))
CLAIM = ("channels", "property", "exists", "cyclic", "indices")
WITNESS = ("gains", "modulus", "annihilators", "generator")


def check(claim: Json, witness: Json, system: System) -> None:
    """Check gains and their indices for yes; a mode or a cut out of reach of one channel for no.

    Theorem ``single_channel_gains.single_channel_yes``.
    """
    listed, wanted, verdict, spun, numbers = fields(claim, "claim", *CLAIM)
    Q, cyclic = reading.names(listed, "claim.channels", system.names), boolean(spun, "claim.cyclic")
    sides = SIDES if wanted == "both" else (reading.string(wanted, "claim.property", *SIDES),)
    if not boolean(verdict, "claim.exists"):
        require(numbers is None and not cyclic, "claim", "claim", "without gains, no index")
        return _require_lost(witness, system, Q, sides)
    gains, modulus, rows, b = fields(witness, "witness", *WITNESS)
    A_F = evidence.closed_loop(system, evidence.read_gains(gains, "witness.gains", system))
    closed, k, n = replace(system, A=A_F), len(sides), system.n
    ell = evidence.modulus(modulus, "witness.modulus")
    require(cyclic or b is None, "claim", "witness.generator", "expected null unless cyclic")
    if cyclic:
        require_reached(replace(closed, B=[matrix(b, "witness.generator", n, 1)]), 0, ell, n)
    indices = [items(part, "claim.indices", k) for part in items(numbers, "claim", len(Q))]
    rows = [items(part, "witness.annihilators", k) for part in items(rows, "witness", len(Q))]
    for q, found, part in zip(Q, indices, rows, strict=True):
        for side, number, row in zip(sides, found, part, strict=True):
            target, nu = _seen(closed, side), integer(number, "claim.indices")
            require_reached(target, q, ell, nu)
            w = matrix(row, "witness.annihilators", 1, n)
            require(nu == 0 or not w.is_zero(), "row", "witness.annihilators", "a row of zeros")
            for _ in range(nu - 1):
                gone = (w @ target.B[q]).is_zero()
                require(gone, "identity", "witness.annihilators", f"index below {nu} is open")
                w = w @ target.A


def statement(claim: Json, system: System) -> str:
    """What gains do for every channel named, or that none do."""
    wanted, listed = claim["property"], claim["channels"]
    sides = SIDES if wanted == "both" else (wanted,)
    goal = f"{' and '.join(f'{PAIRS[side]} {side}' for side in sides)} for every q"
    among = f"{goal} in {channel_set(listed)}"
    if not claim["exists"]:
        return f"no constant gains F, the same for all q, make {among}"
    indices = canonical_json(dict(zip(listed, claim["indices"], strict=True)))
    end = ", and A_F cyclic" if claim["cyclic"] else ""
    start = f"some constant gains F, the same for all q, make {among}"
    return f"{start}, with the indices {indices}{end}"


def _seen(system: System, side: str) -> System:
    return system if side == "controllable" else dual(system, {}, "")


def _require_lost(witness: Json, system: System, Q: list[int], sides: tuple[str, ...]) -> None:
    """Check a mode or a cut out of reach of one channel.

    Theorems ``single_channel_gains.single_channel_no_mode``,
    ``single_channel_gains.single_channel_no_cut``.
    """
    cut = isinstance(witness, dict) and "zero" in witness
    keys = ("zero",) if cut else ("polynomial", "subspace")
    name, side, *parts = fields(witness, "witness", "channel", "side", *keys)
    q, side = system.place_of(name, "witness.channel"), reading.string(side, "witness.side", *sides)
    target = _seen(system, side)
    if cut:
        T, X = subspaces.zero_transfer(parts[0], "witness.zero", target)
        C = evidence.outputs(target, evidence.complement(target, T))
        require(not C.is_zero() and (C @ X).is_zero(), "cut", "witness.zero", "C = 0 or C X is not")
    else:
        p = reading.polynomial(parts[0], "witness.polynomial", 1)
        T = subspaces.shrunk_subspace(parts[1], "witness.subspace", target, p, 1)
    require(q in T and q in Q, "channel", "witness.channel", "not in the set T, or not asked about")
