"""Drawn constructions, with arguments that fit the system that they are applied to."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any

from flint import fmpq_mat, fmpz_mat

from tests.oracle.certificates.algebra import beside, krylov, selection
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.reading import Unspecified
from tests.oracle.certificates.systems import System

from .plants import VALUES, Document, entries, number

CONSTRUCTIONS = (
    "augmented_outputs", "dual", "feedback", "full_output", "arcs", "extended", "lifted", "held",
    "slow", "failed", "input_filters", "integrators", "internal_model", "error", "merged",
    "modulo", "regulated", "restricted", "sampled", "servo", "closed_loop", "periodic_loop", "line",
)  # fmt: skip
NEEDS_GRAPH = ("arcs", "augmented_outputs", "extended", "lifted", "held", "slow", "error")
LARGEST = 12


def drawn_matrix(rng: random.Random, nrows: int, ncols: int) -> Document:
    """A matrix of a claim or a witness."""
    d = rng.choice((1, 1, 1, 2, 3))
    rows = [[rng.choice((0, 0, 1, -1, 2)) for _ in range(ncols)] for _ in range(nrows)]
    return {"denominator": d, "entries": rows}


def drawn_step(rng: random.Random, name: str, system: System) -> Document | None:
    """One construction, or None if it does not apply."""
    if system.neighborhoods is None and name in NEEDS_GRAPH:
        return None
    if system.time == "continuous" and name in ("lifted", "held", "periodic_loop", "slow"):
        return None
    if system.time == "discrete" and name == "sampled":
        return None
    if name == "line":  # only of plants with parameters, which `drawn_on_a_line` draws
        return None
    step: Document = {"construction": name}
    m = system.m
    if name in ("feedback", "error"):
        widths = [C.nrows() if name == "feedback" else system.n for C in system.C]
        step["gains"] = [
            drawn_matrix(rng, B.ncols(), w) for B, w in zip(system.B, widths, strict=True)
        ]
    elif name in ("regulated", "servo"):
        step["gains"] = [drawn_matrix(rng, rng.randint(0, 2), C.nrows()) for C in system.C]
    elif name == "internal_model":
        step["polynomial"] = rng.choice(([0, 0, 1], ["1/4", 0, 1], [-1, 1], [0, 1, "-1/2", 1]))
        step["gains"] = [drawn_matrix(rng, rng.choice((0, 1, 1)), C.nrows()) for C in system.C]
    elif name == "full_output":
        if not m:
            return None
        step["channel"] = rng.choice(system.names)
    elif name == "arcs":
        free = [(j, i) for j in range(m) for i in range(m) if j not in system.graph()[i]]
        if not free:
            return None
        chosen = rng.sample(free, rng.randint(1, len(free)))
        step["added"] = [[system.names[j], system.names[i]] for j, i in chosen]
    elif name in ("extended", "lifted", "held"):
        if name != "held":
            step["share"] = rng.choice(("outputs+states", "states"))
        step["dimensions"] = [rng.choice((0, 1, 1, 2)) for _ in range(m)]
    elif name == "sampled":
        step["step"] = rng.choice((1, "1/2", "1/10", "1/3"))
        step |= {"late": rng.choice((0, 0, 1, 2)), "decimals": rng.choice((3, 12, 12))}
    elif name == "slow":
        step["window"] = max(2 * system.n, 1) + rng.choice((0, 0, 1, 2, -1))
    elif name == "merged":
        labels = [rng.randrange(m) for _ in range(m)]
        parts = [
            [system.names[i] for i in range(m) if labels[i] == k] for k in dict.fromkeys(labels)
        ]
        step["parts"] = parts
    elif name == "modulo":
        return drawn_part(rng, system)
    elif name == "failed":
        return drawn_failures(rng, system)
    elif name == "restricted":
        step["channels"] = [s for s in system.names if rng.random() < 0.6] or [*system.names[:1]]
    elif name == "closed_loop":
        step["controller"] = drawn_controller(rng, system)
    elif name == "periodic_loop":
        private = [rng.choice((0, 0, 1, 2)) for _ in range(m)]
        step["phases"] = [drawn_phase(rng, system, private) for _ in range(rng.choice((1, 2, 3)))]
    return step


def drawn_failures(rng: random.Random, system: System) -> Document | None:
    """Some failures, at least one."""
    ports = {"actuators": [B.ncols() for B in system.B], "sensors": [C.nrows() for C in system.C]}
    known: Document = {"agents": [*system.names]}
    for part, sizes in ports.items():
        pairs = zip(system.names, sizes, strict=True)
        known[part] = [[name, k + 1] for name, size in pairs for k in range(size)]
    edges = [(j, i) for i, N in enumerate(system.neighborhoods or []) for j in N if j != i]
    known["links"] = [[system.names[j], system.names[i]] for j, i in sorted(edges)]
    lost = {part: [one for one in each if rng.random() < 0.3] for part, each in known.items()}
    return {"construction": "failed", **lost} if any(lost.values()) else None


def drawn_part(rng: random.Random, system: System) -> Document | None:
    """All that no output shows, or that no input moves, or what lies in both of two such parts."""
    part = rng.choice(("unobservable", "uncontrollable"))
    hidden = part == "unobservable"
    A = system.A.transpose() if hidden else system.A
    ports = system.outputs().transpose() if hidden else system.inputs()
    if rng.random() < 0.3:  # of rows that also vanish on what a drawn vector reaches
        ports = beside([ports, column(rng, system.n)], system.n)
    reached = krylov(A, ports, system.n)
    W, rank = left_kernel(reached).rref()
    if not rank:
        return None
    rows = W.tolist()[:rank]
    pivots = [next(j for j, x in enumerate(row) if x != 0) for row in rows]
    W = fmpq_mat(rank, system.n, [x for row in rows for x in row])
    own = W * A * selection(system.n, pivots).transpose()
    numerators, d = W.numer_denom()
    return {
        "construction": "modulo",
        "part": part,
        "annihilator": {
            "denominator": int(d),
            "entries": [[int(x) for x in row] for row in numerators.tolist()],
        },
        "pivots": pivots,
        "polynomial": [text_of(x) for x in own.charpoly().coeffs()],
    }


def column(rng: random.Random, n: int) -> fmpq_mat:
    """A drawn vector, mostly of zeros."""
    return fmpq_mat(n, 1, [rng.choice((0, 0, 0, 1, -1)) for _ in range(n)])


def left_kernel(M: fmpq_mat) -> fmpq_mat:
    """Rows w with w M = 0, which span all of them."""
    X, nullity = fmpz_mat(M.transpose().numer_denom()[0]).nullspace()
    return fmpq_mat(X).transpose() if nullity else fmpq_mat(0, M.nrows())


def drawn_controller(rng: random.Random, system: System) -> Document:
    """A program for each agent, with signals of neighbors, delays and holds where they may be."""
    agents = []
    shared = [rng.choice((0, 1, 1, 2)) for _ in range(system.m)]
    for i, name in enumerate(system.names):
        private = rng.choice((0, 0, 1))
        agent: Document = {"name": name, "shared": shared[i], "private": private}
        sizes = (shared[i], private, system.B[i].ncols())
        for label, size in zip(("shared_update", "private_update", "input"), sizes, strict=True):
            agent[label] = _drawn_map(rng, system, shared, i, private, size)
        if system.time == "discrete" and rng.random() < 0.3:
            followers = [j for j in range(system.m) if i in _senders(system, j)]
            agent["hold"] = {system.names[j]: rng.choice((1, 2)) for j in followers[:1]}
        agents.append(agent)
    return {"time": system.time, "agents": agents}


def drawn_phase(rng: random.Random, system: System, private: list[int]) -> Document:
    """A program for each agent that uses its own output and state, perhaps with zeros besides."""
    alone, agents = replace(system, neighborhoods=None), []
    none = [0] * system.m
    for i, (name, size) in enumerate(zip(system.names, private, strict=True)):
        agent: Document = {"name": name, "shared": 0, "private": size, "shared_update": {}}
        for label, nrows in (("private_update", size), ("input", system.B[i].ncols())):
            agent[label] = _drawn_map(rng, alone, none, i, size, nrows)
            agent[label].pop("reference", None)
        agents.append(agent)
    return {"time": system.time, "agents": agents}


def _senders(system: System, i: int) -> list[int]:
    """Whose signals agent i may use; in continuous time only those that come at once."""
    neighborhood = system.neighborhoods[i] if system.neighborhoods else (i,)
    return [j for j in neighborhood if system.time == "discrete" or not system.delays.get((i, j))]


def _drawn_map(
    rng: random.Random, system: System, shared: list[int], i: int, private: int, nrows: int
) -> Document:
    values, made = rng.choice(VALUES), {}
    if not nrows:
        return made
    for kind in ("outputs", "shared"):
        part = {}
        for j in _senders(system, i):
            width = system.C[j].nrows() if kind == "outputs" else shared[j]
            if width and rng.random() < 0.6:
                part[system.names[j]] = _drawn_table(rng, nrows, width, values)
        if part:
            made[kind] = part
    if system.C[i].nrows() and rng.random() < 0.1:
        made["reference"] = _drawn_table(rng, nrows, system.C[i].nrows(), values)
    if private and rng.random() < 0.6:
        made["private"] = _drawn_table(rng, nrows, private, values)
    return made


def _drawn_table(rng: random.Random, nrows: int, ncols: int, values: Any) -> Any:
    rows = entries(rng, nrows, ncols, 0.7, values)
    if rng.random() < 0.1:
        spelled = {1: "1.0", -1: "-2/2", 2: "2e0", "1/2": "0.5"}
        rows = [[spelled.get(v, v) for v in row] for row in rows]
    if rng.random() < 0.7:
        return rows
    cells = [[i, j, v] for i, row in enumerate(rows) for j, v in enumerate(row) if v != 0]
    return {"shape": [nrows, ncols], "entries": cells}


def drawn_subject(
    rng: random.Random, plant: Document, focus: str | None, more: float = 0.35
) -> list[Document] | None:
    """Constructions with the one in focus among them, or None if that does not apply.

    Parameters
    ----------
    focus : str, optional
        A construction that has to be there.
    more : float
        The chance of each further one.
    """
    wanted = [focus] if focus else []
    while rng.random() < more and len(wanted) < 3:
        wanted.insert(rng.randrange(len(wanted) + 1), rng.choice(CONSTRUCTIONS))
    steps: list[Document] = []
    for name in wanted:
        system = subject_of({"system": plant, "subject": steps})
        step = drawn_step(rng, name, system)
        if step is None:
            if name == focus:
                return None
            continue
        try:
            made = subject_of({"system": plant, "subject": [*steps, step]})
        except Unspecified:
            return None
        if made.n > LARGEST:
            return None if name == focus else steps
        steps.append(step)
    return steps


def text_of(value: Any) -> int | str:
    """A rational of python-flint as a certificate writes it."""
    return number(int(value.p)) if value.q == 1 else f"{value.p}/{value.q}"
