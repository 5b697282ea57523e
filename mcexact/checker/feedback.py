"""Constructions ``dual``, ``feedback``, ``full_output``, ``merged``, ``restricted`` and others."""

import json

from .arithmetic import Matrix, beside, stack
from .evidence import closed_loop, inputs, outputs, read_gains
from .information_structure import neighbors_of
from .reading import Json, fields, items, malformed, matrices, names, require
from .statement import by_channel, canonical_json, channel_set, prefixed, suffixed, with_digest
from .system import System


def dual(system: System, step: dict[str, Json], place: str) -> System:
    """A', (C_i)', (B_i)'; no neighbor graph.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    B, C = [M.T for M in system.C], [M.T for M in system.B]
    return prefixed("the dual", system, A=system.A.T, B=B, C=C, neighbors=None, delays={})


def feedback(system: System, step: dict[str, Json], place: str) -> System:
    """A_F instead of A.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "gains")
    F = read_gains(listed, place, system)
    given = with_digest(canonical_json(by_channel(system, F)))
    words = f"under the decentralized gains F with {given}"
    return suffixed(system, words, A=closed_loop(system, F))


def full_output(system: System, step: dict[str, Json], place: str) -> System:
    """C_q becomes the identity.

    Open: see ``proofs/OPEN.md``.
    """
    (name,) = fields(step, place, "channel")
    q = system.place_of(name, place)
    identity = Matrix.unit_rows(system.n, 0, system.n)
    C = [identity if i == q else C_i for i, C_i in enumerate(system.C)]
    words = f"with the whole state measured by channel {json.dumps(name)}"
    return suffixed(system, words, C=C)


def merged(system: System, step: dict[str, Json], place: str) -> System:
    """One channel for each part T of a partition of the channels, (B_T, C_T); no neighbor graph.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "parts")
    parts = [names(part, place, system.names) for part in items(listed, place)]
    if not all(parts) or parts != sorted(parts):
        malformed(place, "expected parts that are not empty, by their first members")
    whole = sorted(i for part in parts for i in part) == list(range(system.m))
    message = "expected every channel in exactly one part, and a part"
    require(bool(parts) and whole, "subject", place, message)
    known = ["+".join(system.names[i] for i in part) for part in parts]
    distinct = len(set(known)) == len(known)
    require(distinct, "subject", place, "two channels would have the same name")
    sets = ", ".join(channel_set(system.names[i] for i in part) for part in parts)
    words = f"with its channels merged into {sets}"
    B, C = [inputs(system, part) for part in parts], [outputs(system, part) for part in parts]
    return suffixed(system, words, names=known, B=B, C=C, neighbors=None, delays={})


def restricted(system: System, step: dict[str, Json], place: str) -> System:
    """Only some of the channels, at least one; no neighbor graph.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "channels")
    chosen = names(listed, place, system.names)
    require(bool(chosen), "subject", place, "expected at least one channel")
    known = [system.names[i] for i in chosen]
    B, C = [system.B[i] for i in chosen], [system.C[i] for i in chosen]
    words = f"with the channels {channel_set(known)} alone"
    return suffixed(system, words, names=known, B=B, C=C, neighbors=None, delays={})


def integrators(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section III: w' = y or w(t+1) = w + y at the outputs, and agent i measures its w_i.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    n, q = system.n, [C_i.nrows for C_i in system.C]
    N = n + sum(q)
    x, w = Matrix.unit_rows(N, 0, n), Matrix.unit_rows(N, n, sum(q))
    change = outputs(system, range(system.m)) @ x
    A = stack([system.A @ x, change + w if system.time == "discrete" else change], N)
    B = [stack([B_i, Matrix.zeros(sum(q), B_i.ncols)], B_i.ncols) for B_i in system.B]
    C = [Matrix.unit_rows(N, n + sum(q[:i]), q_i) for i, q_i in enumerate(q)]
    return suffixed(system, "with integrators of its outputs", A=A, B=B, C=C)


def error(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section II: the errors e_i of m estimates, I⊗(A + ΣB_jF_j) − Q with Q_ij = B_jF_j.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "gains")
    n, N = system.n, neighbors_of(system, place)
    F = matrices(listed, place, [(B_i.ncols, n) for B_i in system.B])
    BF = [B_i @ F_i for B_i, F_i in zip(system.B, F, strict=True)]
    e = [Matrix.unit_rows(n * system.m, i * n, n) for i in range(system.m)]
    closed, Q = sum(BF, system.A), beside(BF, n)
    A = stack([closed @ e_i - Q for e_i in e], n * system.m)
    C = []
    for i, N_i in enumerate(N):
        seen = [e[i] - e[j] for j in N_i if j != i]
        C.append(stack([system.C[i] @ e[i], *seen], n * system.m))
    given = with_digest(canonical_json(by_channel(system, F)))
    words = f"the open-loop error system under the state feedback F with {given}"
    return prefixed(words, system, A=A, B=[e_i.T for e_i in e], C=C)
