"""Constructions ``dual``, ``feedback``, ``full_output``, ``integrators`` and ``error``."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from .arithmetic import Matrix, beside, stack
from .evidence import closed_loop, outputs, read_gains
from .information_structure import neighbors_of
from .reading import fields, matrices
from .system import System


def dual(system: System, step: dict[str, Any], place: str) -> System:
    """A', (C_i)', (B_i)'; no neighbor graph.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    B, C = [M.T for M in system.C], [M.T for M in system.B]
    return System(system.time, system.names, system.A.T, B, C, words=f"the dual of {system.words}")


def feedback(system: System, step: dict[str, Any], place: str) -> System:
    """A_F instead of A.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "gains")
    A_F = closed_loop(system, read_gains(listed, place, system))
    return replace(system, A=A_F, words=f"{system.words} under the decentralized gains given")


def full_output(system: System, step: dict[str, Any], place: str) -> System:
    """C_q becomes the identity.

    Open: see ``proofs/OPEN.md``.
    """
    (name,) = fields(step, place, "channel")
    q = system.place_of(name, place)
    identity = Matrix.unit_rows(system.n, 0, system.n)
    C = [identity if i == q else C_i for i, C_i in enumerate(system.C)]
    return replace(system, C=C, words=f"{system.words} with the state measured by channel {q + 1}")


def integrators(system: System, step: dict[str, Any], place: str) -> System:
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
    return replace(system, A=A, B=B, C=C, words=f"{system.words} with integrators of its outputs")


def error(system: System, step: dict[str, Any], place: str) -> System:
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
    words = f"the open-loop error system of {system.words} under the state feedback given"
    return replace(system, A=A, B=[e_i.T for e_i in e], C=C, words=words)
