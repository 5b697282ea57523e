"""Systems made from the plant.

A claim is about a subject: the plant after a list of constructions.  `read_subject` applies them in
order, each a function from a system to a system; ``CONSTRUCTIONS`` has them by name, and
``FORMAT.md`` specifies them.  `closed_loop` is the longest one: it writes the plant and the
programs of all agents, with what they remember of messages, as one matrix.  It treats the loop as a
linear map of signals, which `discs` uses again to bound loops of uncertain plants.
"""

import json
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from typing import NamedTuple

from .controllers import MAPS, read_controller
from .core import evidence
from .core.arithmetic import Matrix, Polynomial, beside, characteristic_polynomial, diagonal, stack
from .core.budget import spend, table
from .core.evidence import inputs, outputs, read_gains
from .core.reading import (
    Json,
    fields,
    incomplete,
    integer,
    items,
    malformed,
    matrices,
    matrix,
    names,
    polynomial,
    positions,
    rational,
    require,
    shown,
    string,
)
from .core.system import (
    System,
    by_channel,
    canonical_json,
    channel_set,
    counted,
    digest_of,
    dual,
    edge_set,
    polynomial_text,
    prefixed,
    suffixed,
    with_digest,
)
from .sampling import divided, enclosure

# Construction ``closed_loop``: the plant and the programs of its agents, as one matrix.

STATES = (("x", "shared"), ("z", "private"))
MOST_DECIMALS = 1000
Signal = tuple[str, int, int]
"""(signal, j, age): signal is "X" for the plant's state, "x", "y" or "z" for x_j, y_j, z_j."""
Terms = list[tuple[Signal, Matrix]]
"""The signals that a map uses, with their coefficients."""


def closed_loop(system: System, step: dict[str, Json], place: str) -> System:
    """State (x, x_1, z_1, x_2, …), then for each j the x_j(t−1), …, y_j(t−1), … that are in use.

    Open: see ``proofs/OPEN.md``.
    """
    (value,) = fields(step, place, "controller")
    controller = read_controller(value, place, system)
    A, made = looped(system, controller, place)
    words, text = "the closed loop with the controller", canonical_json(controller)
    return _loop(system, A, made, words, text, one=True)


def looped(system: System, controller: Json, place: str) -> tuple[Matrix, "Loop"]:
    """The matrix of the loop with a controller, and what it was made from.

    Open: see ``proofs/OPEN.md``.
    """
    agents = controller["agents"]
    fits = controller["time"] == system.time and [a["name"] for a in agents] == system.names
    require(fits, "subject", place, "expected a controller for these agents and this time")
    programs = programs_of(system, agents, place)
    order = signals_of(system, agents, programs)
    reads = rows_that_read(order)
    x = reads["X", 0, 0]
    reads |= {("y", j, 0): C_j @ x for j, C_j in enumerate(system.C)}
    inputs = [mapped(programs[i][2], reads, B_i.ncols, x.ncols) for i, B_i in enumerate(system.B)]
    if system.D is not None:
        inputs = _at_once(system, programs, reads, inputs, place)
    A = stack(rows_of_states(system, programs, order, reads, inputs), x.ncols)
    return A, Loop(system, programs, order, agents)


def _loop(system: System, A: Matrix, made: "Loop", words: str, text: str, one: bool) -> System:
    """A loop as a system without channels; ``text`` is the JSON of what identifies its controller.

    What is known of loops from one step to the next is kept of ``one`` such loop alone.
    """
    alone = System(system.time, [], A, [], [], words=system.words)
    blocks = tuple(width for _, width in made.order[: 2 * system.m + 1])
    own = f"{system.n} of the controlled system and {A.nrows - system.n} added by the controller"
    ports = f"{own} of the channels {channel_set(system.names)}"
    kept = (blocks, ports, made) if one else ((), ports, None)
    return prefixed(f"{words} with {with_digest(text)}", alone, *kept, controller=digest_of(text))


def periodic_loop(system: System, step: dict[str, Json], place: str) -> System:
    """State (x, z_1, z_2, …): the product of the matrices of all phases, the last one left.

    Theorems ``periodic.periods``, ``periodic.any_step``.
    """
    (listed,) = fields(step, place, "phases")
    require(system.time == "discrete", "subject", place, "expected discrete time")
    phases = [
        read_controller(phase, f"{place}.phases[{t}]", system)
        for t, phase in enumerate(items(listed, place))
    ]
    if not phases:
        malformed(place, "expected at least one phase")
    sizes = [agent["private"] for agent in phases[0]["agents"]]
    A, made = looped(system, phases[0], f"{place}.phases[0]")
    for t, phase in enumerate(phases):
        where = f"{place}.phases[{t}]"
        same_sizes = [agent["private"] for agent in phase["agents"]] == sizes
        require(same_sizes, "subject", where, "expected as many states as in the first phase")
        for agent in phase["agents"]:
            own = _uses_its_own_output(agent)
            require(own, "subject", where, "an agent uses more than its own output and state")
        if t:
            A = looped(system, phase, where)[0] @ A
    words = f"the loop over {counted(len(phases), 'step')} with the periodic controller"
    return _loop(system, A, made, words, canonical_json({"phases": phases}), one=False)


def _uses_its_own_output(agent: Json) -> bool:
    """Whether a program has no shared states and no set-points, and uses y_i and z_i alone."""
    maps = [agent.get(label, {}) for label in MAPS]
    others = {name for used in maps for name in used.get("outputs", {})} - {agent["name"]}
    wanted = any("reference" in used for used in maps)
    return not (agent["shared"] or others or wanted or "hold" in agent)


def _at_once(
    system: System,
    programs: list[list[Terms]],
    reads: dict[Signal, Matrix],
    inputs: list[Matrix],
    place: str,
) -> list[Matrix]:
    """The inputs, by (I − K D) u = K C x + …, of u = K y + …, y = C x + D u; ``reads`` gets y."""
    p, everything = [u_i.nrows for u_i in inputs], list(range(system.m))
    K = [
        beside(
            [
                sum(
                    (M for signal, M in programs[i][2] if signal == ("y", j, 0)),
                    Matrix.zeros(p[i], C_j.nrows),
                )
                for j, C_j in enumerate(system.C)
            ],
            p[i],
        )
        for i in everything
    ]
    D = direct(system, everything, everything)
    unit = Matrix.unit_rows(sum(p), 0, sum(p))
    inner = unit if D is None else unit - stack(K, D.nrows) @ D
    u = divided(inner, stack(inputs, inputs[0].ncols))
    if u is None:
        require(False, "subject", place, "the loop is not well posed: I - K D is singular")
        return inputs
    for j in everything:
        D_j = direct(system, [j], everything)
        if D_j is not None:
            reads["y", j, 0] += D_j @ u
    return [u.take(range(sum(p[:i]), sum(p[: i + 1]))) for i in everything]


class Loop(NamedTuple):
    """What a loop was made from: the system, the programs of its agents, and the loop's states.

    ``programs`` are the signals that the agents use, and ``agents`` their programs as documents.
    """

    system: System
    programs: list[list[Terms]]
    order: list[tuple[Signal, int]]
    agents: list[Json]


class Disturbed(NamedTuple):
    """z' = M z + E d + G e, u = U z + K e, y = Y z, or z(t+1): d at the inputs, e at the outputs.

    u are the inputs as the agents compute them, of which the plant receives u + d, and y are the
    outputs of the plant, of which everybody who uses them receives y + e.
    """

    M: Matrix
    E: Matrix
    G: Matrix
    U: Matrix
    K: Matrix
    Y: Matrix


def disturbed(loop: Loop) -> Disturbed:
    """The loop with a signal added to every input, and one to every output.

    Signals are linear maps of (z, d, e), so that the loop is formed as `closed_loop` forms it.

    Open: see ``proofs/OPEN.md``.
    """
    system, programs, order, _ = loop
    N, p, q = sum(width for _, width in order), *ports_of(system)
    total = N + p + q
    wide = rows_that_read([*order, (("d", 0, 0), p), (("e", 0, 0), q)])
    x, d, e = wide["X", 0, 0], wide["d", 0, 0], wide["e", 0, 0]
    y, start, reads = [C_j @ x for C_j in system.C], 0, dict(wide)
    for j, y_j in enumerate(y):
        reads["y", j, 0] = y_j + e.at(range(start, start + y_j.nrows))
        start += y_j.nrows
    u = [mapped(programs[i][2], reads, B_i.ncols, total) for i, B_i in enumerate(system.B)]
    start, fed = 0, []
    for u_i in u:
        fed.append(u_i + d.at(range(start, start + u_i.nrows)))
        start += u_i.nrows
    after = stack(rows_of_states(system, programs, order, reads, fed), total)
    z, ds, es = range(N), range(N, N + p), range(N + p, total)
    inputs, outputs_ = stack(u, total), stack(y, total)
    M, E, G = (after.take(cols=part) for part in (z, ds, es))
    return Disturbed(M, E, G, inputs.take(cols=z), inputs.take(cols=es), outputs_.take(cols=z))


def references(loop: Loop) -> tuple[Matrix, Matrix]:
    """R and J of z' = M z + R r, u = U z + J r, with r the set-points of all outputs.

    Open: see ``proofs/OPEN.md``.
    """
    system, _, order, agents = loop
    q = [C_j.nrows for C_j in system.C]
    total = sum(q)

    def wanted(i: int, label: str, nrows: int) -> Matrix:
        M = agents[i].get(label, {}).get("reference")
        own = Matrix.unit_rows(total, sum(q[:i]), q[i])
        return Matrix.zeros(nrows, total) if M is None else M @ own

    J = [wanted(i, "input", B_i.ncols) for i, B_i in enumerate(system.B)]
    acting = (B_i @ J_i for B_i, J_i in zip(system.B, J, strict=True))
    rows = [sum(acting, Matrix.zeros(system.n, total))]
    for (what, j, age), width in order[1:]:
        label = MAPS["xz".index(what)] if not age else ""
        rows.append(wanted(j, label, width))
    return stack(rows, total), stack(J, total)


def ports_of(system: System) -> tuple[int, int]:
    """The numbers of all inputs and of all outputs."""
    return sum(B_i.ncols for B_i in system.B), sum(C_i.nrows for C_i in system.C)


def programs_of(system: System, agents: list[Json], place: str) -> list[list[Terms]]:
    """The signals that the three maps of each agent use."""
    return [_terms(system, agents, i, place) for i in range(system.m)]


def signals_of(
    system: System, agents: list[Json], programs: list[list[Terms]]
) -> list[tuple[Signal, int]]:
    """The signals that make up the state of the loop, with their widths."""
    m = system.m
    width = {what: [agent[key] for agent in agents] for what, key in STATES}
    width |= {"X": [system.n], "y": [C_j.nrows for C_j in system.C]}
    used = {signal for maps in programs for terms in maps for signal, _ in terms}
    spend(30 * m * len(used))
    order: list[Signal] = [("X", 0, 0), *((what, j, 0) for j in range(m) for what in "xz")]
    for what, j in ((what, j) for j in range(m) for what in "xy"):
        oldest = max((age for w, k, age in used if (w, k) == (what, j)), default=0)
        spend(500 * oldest)
        order += [(what, j, age + 1) for age in range(oldest)]
    return [((what, j, age), width[what][j]) for what, j, age in order]


def rows_that_read(order: list[tuple[Signal, int]]) -> dict[Signal, Matrix]:
    """For each signal, the matrix that takes it out of all of them."""
    total, start, reads = sum(width for _, width in order), 0, {}
    spend(table(total, total))
    for signal, width in order:
        reads[signal] = Matrix.unit_rows(total, start, width)
        start += width
    return reads


def mapped(terms: Terms, reads: dict[Signal, Matrix], nrows: int, ncols: int) -> Matrix:
    """The matrix from all signals to the output of a map of an agent."""
    return sum((M @ reads[signal] for signal, M in terms), Matrix.zeros(nrows, ncols))


def rows_of_states(
    system: System,
    programs: list[list[Terms]],
    order: list[tuple[Signal, int]],
    reads: dict[Signal, Matrix],
    inputs: list[Matrix],
    one: int = 1,
) -> list[Matrix]:
    """The next value of each signal of the state; ``inputs`` are the u_i in terms of all signals.

    The next value of a stored message is ``one`` times the younger message: with 0, only the
    entries that can be uncertain are left.
    """
    x = reads["X", 0, 0]
    rows = [sum((B_i @ u_i for B_i, u_i in zip(system.B, inputs, strict=True)), system.A @ x)]
    for (what, j, age), width in order[1:]:
        if age:
            rows.append(reads[what, j, age - 1].times(one))
        else:
            rows.append(mapped(programs[j]["xz".index(what)], reads, width, x.ncols))
    return rows


def _terms(system: System, agents: list[Json], i: int, place: str) -> list[Terms]:
    """The signals that the three maps of agent i use, with their coefficients."""
    N_i, result = system.neighbors[i] if system.neighbors else [i], []
    for label in MAPS:
        used, terms = agents[i].get(label, {}), []
        for what, key in (("x", "shared"), ("y", "outputs")):
            for name, M in used.get(key, {}).items():
                j = system.names.index(name)
                steps = agents[j].get("hold", {}).get(system.names[i], 0)
                age = system.delays.get((i, j), 0) + steps * (what == "x")
                right = j in N_i and (not age or system.time == "discrete")
                message = f"agent {i + 1} does not get this from {j + 1}"
                require(right, "subject", f"{place}.{label}", message)
                terms.append(((what, j, age), M))
        if "private" in used:
            terms.append((("z", i, 0), used["private"]))
        result.append(terms)
    return result


# Constructions ``augmented_outputs``, ``arcs``, ``extended``, ``lifted``, ``held`` and ``slow``.

SHARED = {"outputs+states": "outputs and sub-states", "states": "sub-states"}


def neighbors_of(system: System, place: str) -> list[list[int]]:
    """The sets N_i; the system must have a neighbor graph."""
    message = "the system has no neighbor graph"
    require(system.neighbors is not None, "subject", place, message)
    return system.neighbors or []


def augmented_outputs(system: System, step: dict[str, Json], place: str) -> System:
    """C_i becomes C_{N_i}.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    N = neighbors_of(system, place)
    C = [outputs(system, N_i) for N_i in N]
    D = direct(system, [j for N_i in N for j in N_i], list(range(system.m)))
    return suffixed(system, "with the outputs of neighbors measured by each agent", C=C, D=D)


def arcs(system: System, step: dict[str, Json], place: str) -> System:
    """j joins N_i for each added edge [j, i].

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "added")
    spend(40 * sum(map(len, neighbors_of(system, place))) + 100 * system.m)
    sets, added = [set(N_i) for N_i in neighbors_of(system, place)], []
    for arc in items(listed, place):
        j, i = (system.place_of(end, place) for end in items(arc, place, 2))
        require(j not in sets[i], "subject", place, "the edge is there already")
        sets[i].add(j)
        added.append((j, i))
    named = edge_set((system.names[j], system.names[i]) for j, i in sorted(added))
    words = f"with the links {named} added to its neighbor graph"
    return suffixed(system, words, neighbors=[sorted(N_i) for N_i in sets])


def read_shares(system: System, step: dict[str, Json], place: str) -> tuple[str, list[int]]:
    """Read which signals are shared, and the dimensions n_i of the sub-states."""
    share, listed = fields(step, place, "share", "dimensions")
    return string(share, place, *SHARED), read_dimensions(system, listed, place)


def read_dimensions(system: System, value: Json, place: str) -> list[int]:
    """The dimensions n_i, one for each agent."""
    return [integer(size, place) for size in items(value, place, system.m)]


def shared(system: System, share: str, sizes: list[int]) -> str:
    """What agents share, and in how many dimensions."""
    return f"{SHARED[share]} of dimensions {canonical_json(by_channel(system, sizes))}"


def extended(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section IV-C: state (x, x_1, …, x_m); x_i' or x_i(t+1) is an input of agent i.

    Open: see ``proofs/OPEN.md``.
    """
    (share, sizes), N = read_shares(system, step, place), neighbors_of(system, place)
    total = sum(sizes)
    E = [Matrix.unit_rows(total, sum(sizes[:i]), size) for i, size in enumerate(sizes)]
    B = [diagonal(B_i, E_i.T) for B_i, E_i in zip(system.B, E, strict=True)]
    own = [outputs(system, N_i if share == "outputs+states" else [i]) for i, N_i in enumerate(N)]
    heard = [stack([E[j] for j in N_i], total) for N_i in N]
    C = [diagonal(C_i, E_N) for C_i, E_N in zip(own, heard, strict=True)]
    A = diagonal(system.A, Matrix.zeros(total, total))
    words = f"the extended system without delays sharing {shared(system, share, sizes)}"
    return prefixed(words, system, A=A, B=B, C=C)


def lifted(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section V-A: x, then for each j the x_j(t), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j).

    Open: see ``proofs/OPEN.md``.
    """
    return _delayed(system, *read_shares(system, step, place), place, hold=False)


def held(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section V-B: x, then for each j the x_j(t), …, x_j(t−d_j); all receive x_j(t−d_j).

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "dimensions")
    return _delayed(system, "states", read_dimensions(system, listed, place), place, hold=True)


def _delayed(system: System, share: str, sizes: list[int], place: str, hold: bool) -> System:
    """Shift registers behind the plant; x(j, δ) and y(j, δ) read what is δ steps old."""
    require(system.time == "discrete", "subject", place, "expected a plant in discrete time")
    N, n, m, with_outputs = neighbors_of(system, place), system.n, system.m, share != "states"
    d = [max([system.delays.get((i, j), 0) for i in range(m)]) for j in range(m)]
    q = [C_j.nrows if with_outputs else 0 for C_j in system.C]
    widths = [(d[j] + 1) * sizes[j] + d[j] * q[j] for j in range(m)]
    spend(500 * sum(d) + table(n + sum(widths), n + sum(widths)) + m * m)
    total, starts = n + sum(widths), [n + sum(widths[:j]) for j in range(m)]
    plant = Matrix.unit_rows(total, 0, n)

    def x(j: int, delta: int) -> Matrix:
        return Matrix.unit_rows(total, starts[j] + delta * sizes[j], sizes[j])

    def y(j: int, delta: int) -> Matrix:
        if not delta:
            return system.C[j] @ plant
        first = starts[j] + (d[j] + 1) * sizes[j] + (delta - 1) * q[j]
        return Matrix.unit_rows(total, first, q[j])

    rows, B, C = [system.A @ plant], [], []
    for j in range(m):
        rows += [Matrix.zeros(sizes[j], total), *(x(j, delta) for delta in range(d[j]))]
        rows += [y(j, delta) for delta in range(d[j]) if with_outputs]
        B.append(beside([plant.T @ system.B[j], x(j, 0).T], total))
        waits = [(k, d[k] if hold else system.delays.get((j, k), 0)) for k in N[j]]
        late = sorted(waits, key=lambda wait: wait[1] > 0)  # signals without delay come first
        own = [y(*wait) for wait in late] if with_outputs else [y(j, 0)]
        C.append(stack([*own, *(x(*wait) for wait in waits)], total))
    form = f"{'held' if hold else 'lifted'}, sharing {shared(system, share, sizes)}"
    words = f"the extended system with delays, {form}"
    return prefixed(words, system, A=stack(rows, total), B=B, C=C)


def slow(system: System, step: dict[str, Json], place: str) -> System:
    """A^Q, [A^{n−1}B_i … B_i] and [C_i; …; C_iA^{n−1}], with the delay 1 on every link.

    Open: see ``proofs/OPEN.md``.
    """
    (window,) = fields(step, place, "window")
    require(system.time == "discrete", "subject", place, "expected a plant in discrete time")
    N, n = neighbors_of(system, place), system.n
    Q = integer(window, f"{place}.window")
    enough = max(2 * n, 1)
    require(enough <= Q, "subject", place, f"expected a window of at least {enough} steps")
    spend(table(n, n) * n)
    powers = [Matrix.unit_rows(n, 0, n)]
    for _ in range(n - 1):
        powers.append(powers[-1] @ system.A)
    inputs = [[P @ B_i for P in reversed(powers[:n])] for B_i in system.B]
    outputs = [[C_i @ P for P in powers[:n]] for C_i in system.C]
    whole, square = powers[0], system.A
    while Q:
        if Q % 2:
            whole = whole @ square
        Q //= 2
        if Q:
            square = square @ square
    return prefixed(
        f"the system in windows of {window} steps",
        system,
        A=whole,
        B=[beside(parts, n) for parts in inputs],
        C=[stack(parts, n) for parts in outputs],
        delays={(i, j): 1 for i, N_i in enumerate(N) for j in N_i if j != i},
    )


# Construction ``sampled``: a plant in continuous time at the samples, with its inputs held.


def sampled(system: System, step: dict[str, Json], place: str) -> System:
    """A_h, B_h to some decimals, and registers of the inputs that are not in use yet.

    Theorem ``servo.registered_late``.
    """
    certain = [Matrix.zeros(system.n, B_i.ncols) for B_i in system.B]
    D = replace(system, A=Matrix.zeros(system.n, system.n), B=certain)
    center, missed = sampled_within(system, D, step, place)
    return replace(center, missed=missed)


def sampled_within(
    system: System, radii: System, step: dict[str, Json], place: str
) -> tuple[System, System]:
    """The sampled system, and the radii for all systems within radii of the one in continuous time.

    Theorem ``servo.registered_within``.
    """
    length, waits, digits = fields(step, place, "step", "late", "decimals")
    h, late = rational(length, f"{place}.step"), integer(waits, f"{place}.late")
    decimals = integer(digits, f"{place}.decimals")
    require(system.time == "continuous", "subject", place, "expected a plant in continuous time")
    require(h > 0, "subject", place, "expected a step above 0")
    require(decimals <= MOST_DECIMALS, "subject", place, f"expected at most {MOST_DECIMALS}")
    n = system.n
    M, D = (beside([each.A, *each.B], n) for each in (system, radii))
    center, missed = enclosure(M, D, h, decimals)
    delay = f" and {counted(late, 'step')} late" if late else ""
    words = f"sampled every {h} with its inputs held{delay}, to {counted(decimals, 'decimal')}"
    made = suffixed(system, words, time="discrete")
    return _registered(made, center, late, 1), _registered(radii, missed, late, 0)


def _registered(system: System, M: Matrix, late: int, one: int) -> System:
    """State (x, v_1, …, v_late), x(t+1) = M (x, v_1), v_k(t+1) = v_(k+1), and the last one is u.

    The entries of registers are ``one``: with 0, only those that can be uncertain are left.
    """
    n, widths = system.n, [B_i.ncols for B_i in system.B]
    p = sum(widths)
    starts = [sum(widths[:i]) for i in range(system.m)]
    parts = [*zip(starts, widths, strict=True)]
    if not late:
        B = [M.take(None, range(n + start, n + start + p_i)) for start, p_i in parts]
        return replace(system, A=M.take(None, range(n)), B=B)
    N = n + late * p
    spend(table(N, N))
    x, after = Matrix.unit_rows(N, 0, n), Matrix.unit_rows(N, n + p, N - n - p).times(one)
    A = stack([M @ Matrix.unit_rows(N, 0, n + p), after, Matrix.zeros(p, N)], N)
    last = [Matrix.unit_rows(N, N - p + start, p_i) for start, p_i in parts]
    return replace(
        system, A=A, B=[rows.T.times(one) for rows in last], C=[C_i @ x for C_i in system.C]
    )


# Constructions ``failed``, ``feedback``, ``merged``, ``modulo`` and others; the core has ``dual``.

MODULO = ("part", "annihilator", "pivots", "polynomial")


def direct(system: System, outputs_: list[int], inputs_: list[int]) -> Matrix | None:
    """The feedthrough from the inputs of some channels to the outputs of some, in these orders."""
    if system.D is None:
        return None
    p, q = ([M.ncols for M in system.B], [M.nrows for M in system.C])
    rows = [k for i in outputs_ for k in range(sum(q[:i]), sum(q[: i + 1]))]
    columns = [k for j in inputs_ for k in range(sum(p[:j]), sum(p[: j + 1]))]
    return system.D.take(rows, columns)


def feedback(system: System, step: dict[str, Json], place: str) -> System:
    """A_F instead of A.

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "gains")
    F = read_gains(listed, place, system)
    digest = with_digest(canonical_json(by_channel(system, F)))
    words = f"under the decentralized gains F with {digest}"
    return suffixed(system, words, A=evidence.closed_loop(system, F))


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
    order = [i for part in parts for i in part]
    D = direct(system, order, order)
    return suffixed(system, words, names=known, B=B, C=C, D=D, neighbors=None, delays={})


def modulo(system: System, step: dict[str, Json], place: str) -> System:
    """x modulo the span of W, which no output shows; or x with W x = 0, as no input moves W x.

    The first is the dual of the second for the dual system.

    Theorems ``modulo.unobservable_part``, ``modulo.uncontrollable_part``.
    """
    side, rows, columns, factor = fields(step, place, *MODULO)
    hidden = string(side, place, "unobservable", "uncontrollable") == "unobservable"
    A, B, C = _turned(system.A, system.B, system.C) if hidden else (system.A, system.B, system.C)
    chi = polynomial(factor, f"{place}.polynomial", 1)
    W, Z = evidence.annihilator(rows, columns, place, A, B)
    same = characteristic_polynomial(Z) == chi
    require(same, "claim", f"{place}.polynomial", "not det(xI - Z)")
    pivots = positions(columns, f"{place}.pivots", system.n)
    kept = sorted(set(range(system.n)) - set(pivots))
    D = W.take(None, kept)
    A, *C = (M.take(None, kept) - M.take(None, pivots) @ D for M in (A, *C))
    A, B = A.take(kept), [M.take(kept) for M in B]
    if hidden:
        A, B, C = _turned(A, B, C)
    digest = with_digest(canonical_json({"pivots": pivots, "W": W}))
    words = f"modulo an {side} part with the characteristic polynomial {polynomial_text(chi)}"
    return suffixed(system, f"{words} and W with {digest}", A=A, B=B, C=C)


def _turned(
    A: Matrix, B: list[Matrix], C: list[Matrix]
) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """The matrices of the dual system."""
    return A.T, [M.T for M in C], [M.T for M in B]


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
    D = direct(system, chosen, chosen)
    return suffixed(system, words, names=known, B=B, C=C, D=D, neighbors=None, delays={})


FAILURES = ("agents", "actuators", "sensors", "links")
Ports = set[tuple[int, int]]
"""Agents, each with the position of one of its inputs or outputs from 0 on."""


def failed(system: System, step: dict[str, Json], place: str) -> System:
    """Zeros in the columns of B_i, the rows of C_i, and those of D, and no links, of what failed.

    Theorems ``failures.failed_loop``, ``failures.fixed_after_failure``,
    ``failures.fixed_after_more``.
    """
    listed = dict(zip(FAILURES, fields(step, place, *FAILURES), strict=True))
    require(any(listed.values()), "subject", place, "expected a failure")
    gone = {*names(listed["agents"], place, system.names)}
    p, q = [M.ncols for M in system.B], [M.nrows for M in system.C]
    idle = _ports(system, listed["actuators"], place, p) | _all_of(gone, p)
    blind = _ports(system, listed["sensors"], place, q) | _all_of(gone, q)
    left = [_left(i, p_i, idle) for i, p_i in enumerate(p)]
    seen = [_left(i, q_i, blind) for i, q_i in enumerate(q)]
    D = system.D
    if D is not None:
        none = Matrix.zeros(0, 0)
        D = reduce(diagonal, seen, none) @ D @ reduce(diagonal, left, none)
    words = f"after the failures {canonical_json({k: v for k, v in listed.items() if v})}"
    made = suffixed(
        system,
        words,
        B=[B_i @ P_i for B_i, P_i in zip(system.B, left, strict=True)],
        C=[Q_i @ C_i for Q_i, C_i in zip(seen, system.C, strict=True)],
        D=D,
    )
    return _without_links(made, listed["links"], gone, place)


def _ports(system: System, value: Json, place: str, sizes: list[int]) -> Ports:
    """Pairs of an agent and the number of an input or output of it, from 1 on, in their order."""
    read = []
    for pair in items(value, place):
        name, number = items(pair, place, 2)
        i, k = system.place_of(name, place), integer(number, place, 1)
        if k > sizes[i]:
            malformed(place, f"expected a number up to {sizes[i]}, found {k}")
        read.append((i, k - 1))
    if read != sorted(set(read)):
        malformed(place, "expected inputs and outputs in their order, none of them twice")
    return {*read}


def _all_of(gone: set[int], sizes: list[int]) -> Ports:
    """All inputs or outputs of the agents that failed."""
    return {(i, k) for i in gone for k in range(sizes[i])}


def _left(i: int, size: int, lost: Ports) -> Matrix:
    """The diagonal matrix of what works at channel i: 1, and 0 for what failed."""
    spend(table(size, size))
    return Matrix(
        [[int(j == k and (i, k) not in lost) for j in range(size)] for k in range(size)], size
    )


def _without_links(system: System, value: Json, gone: set[int], place: str) -> System:
    """The neighbor graph without links that failed, and without all those of some agents."""
    lost = []
    for link in items(value, place):
        j, i = (system.place_of(end, place) for end in items(link, place, 2))
        there = i != j and system.neighbors is not None and j in system.neighbors[i]
        require(there, "subject", place, "there is no such link")
        lost.append((j, i))
    if lost != sorted(set(lost)):
        malformed(place, "expected links in their order, none of them twice")
    if system.neighbors is None:
        return system
    spend(40 * sum(map(len, system.neighbors)))

    def works(j: int, i: int) -> bool:
        return j == i or not ((j, i) in lost or j in gone or i in gone)

    sets = [[j for j in N_i if works(j, i)] for i, N_i in enumerate(system.neighbors)]
    delays = {(i, j): d for (i, j), d in system.delays.items() if works(j, i)}
    return replace(system, neighbors=sets, delays=delays)


def input_filters(system: System, step: dict[str, Json], place: str) -> System:
    """State (x, u), u' = v or u(t+1) = v, and agent i measures C_i x + D_i u and u_i; no D.

    Theorems ``feedthrough.same_rank``, ``feedthrough.same_fixed_modes``.
    """
    fields(step, place)
    n, p = system.n, sum(B_i.ncols for B_i in system.B)
    spend(table(n + p, n + p))
    x, u = Matrix.unit_rows(n + p, 0, n), Matrix.unit_rows(n + p, n, p)
    everything = list(range(system.m))
    A = stack([system.A @ x + inputs(system, everything) @ u, Matrix.zeros(p, n + p)], n + p)
    B, C, start = [], [], 0
    for i, (B_i, C_i) in enumerate(zip(system.B, system.C, strict=True)):
        u_i, D_i = Matrix.unit_rows(n + p, n + start, B_i.ncols), direct(system, [i], everything)
        y_i = C_i @ x if D_i is None else C_i @ x + D_i @ u
        B.append(u_i.T)
        C.append(stack([y_i, u_i], n + p))
        start += B_i.ncols
    words = f"with its inputs as states, which their agents {FILTERED[system.time]} and measure"
    return suffixed(system, words, A=A, B=B, C=C, D=None)


FILTERED = {"continuous": "set by their derivatives", "discrete": "set one step late"}


def integrators(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section III: w' = y or w(t+1) = w + y at the outputs, and agent i measures its w_i.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    A, B, w = modeled(system, system.C, _constants(system))
    return suffixed(system, "with integrators of its outputs", A=A, B=B, C=w)


def _constants(system: System) -> Polynomial:
    """The polynomial whose signals are constant: x, or x - 1 in discrete time."""
    return [Fraction(-int(system.time == "discrete")), Fraction(1)]


def modeled(
    system: System, rows: list[Matrix], alpha: Polynomial
) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """State (x, w_1, w_2, …), w_i of d = deg alpha blocks: A, the B_i, and what selects each w_i.

    The block k + 1 is the derivative, or the next value, of the block k < d, and alpha of this
    applied to the first block is ``rows[i]`` x.

    Open: see ``proofs/OPEN.md``.
    """
    n, d = system.n, len(alpha) - 1
    N = n + d * sum(rows_i.nrows for rows_i in rows)
    spend(table(N, N))
    x, start, w = Matrix.unit_rows(N, 0, n), n, list[Matrix]()
    after = [system.A @ x]
    for rows_i in rows:
        k = rows_i.nrows
        blocks = [Matrix.unit_rows(N, start + j * k, k) for j in range(d)]
        last = rows_i @ x
        for a, block in zip(alpha, blocks, strict=False):
            last = last - block.times(a) if a else last
        after += [*blocks[1:], last]
        w.append(Matrix.unit_rows(N, start, d * k))
        start += d * k
    B = [stack([B_i, Matrix.zeros(N - n, B_i.ncols)], B_i.ncols) for B_i in system.B]
    return stack(after, N), B, w


def read_selection(value: Json, place: str, system: System) -> list[Matrix]:
    """S_i, of any number of rows and of q_i columns, for each channel.

    Open: see ``proofs/OPEN.md``.
    """
    read = []
    for S_i, C_i in zip(items(value, place, system.m), system.C, strict=True):
        _, rows = fields(S_i, place, "denominator", "entries")
        read.append(matrix(S_i, place, len(items(rows, place)), C_i.nrows))
    return read


def regulated(system: System, step: dict[str, Json], place: str) -> System:
    """S_i y_i in place of y_i.

    Theorems ``servo.regulated_loop``, ``servo.regulated_fixed``.
    """
    (listed,) = fields(step, place, "gains")
    S = read_selection(listed, place, system)
    digest = with_digest(canonical_json(by_channel(system, S)))
    words = f"with the combinations S of its outputs with {digest}"
    C = [S_i @ C_i for S_i, C_i in zip(S, system.C, strict=True)]
    D = None if system.D is None else reduce(diagonal, S, Matrix.zeros(0, 0)) @ system.D
    return suffixed(system, words, C=C, D=D)


def servo(system: System, step: dict[str, Json], place: str) -> System:
    """z' = S y or z(t+1) = z + S y, and agent i measures its z_i and y_i.

    Theorems ``servo.servo_loop``, ``servo.servo_fixed``, ``servo.servo_equilibrium``,
    ``servo.servo_solvable``.
    """
    (listed,) = fields(step, place, "gains")
    S = read_selection(listed, place, system)
    A, B, C = _with_models(system, S, _constants(system))
    digest = with_digest(canonical_json(by_channel(system, S)))
    words = f"with integrators of the combinations S of its outputs with {digest}"
    return suffixed(system, words, A=A, B=B, C=C)


def _with_models(
    system: System, S: list[Matrix], alpha: Polynomial
) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """A, the B_i and the C_i where agent i measures its own w_i, with S_i y_i behind, and y_i."""
    A, B, w = modeled(system, [S_i @ C_i for S_i, C_i in zip(S, system.C, strict=True)], alpha)
    x = Matrix.unit_rows(A.ncols, 0, system.n)
    C = [stack([w_i, C_i @ x], A.ncols) for w_i, C_i in zip(w, system.C, strict=True)]
    return A, B, C


def internal_model(system: System, step: dict[str, Json], place: str) -> System:
    """Signals of a polynomial, continued by models of S_i y_i; agent i measures its w_i and y_i.

    With D, the last block of w_i has S_i D_i u beside S_i C_i x, D_i the rows of D of agent i.
    The theorems have no D; ``proofs/internal_model.md`` has one.

    Theorems ``internal_model.signal_fixed``, ``internal_model.other_fixed``.
    """
    coefficients, listed = fields(step, place, "polynomial", "gains")
    alpha = polynomial(coefficients, f"{place}.polynomial", 1)
    S = read_selection(listed, place, system)
    A, B, C = _with_models(system, S, alpha)
    D, d, everything = None, len(alpha) - 1, list(range(system.m))
    if system.D is not None:
        p, into, seen = system.D.ncols, list[Matrix](), list[Matrix]()
        for i, S_i in enumerate(S):
            D_i = direct(system, [i], everything)
            k, D_i = S_i.nrows, D_i if D_i is not None else Matrix.zeros(S_i.ncols, p)
            into += [Matrix.zeros((d - 1) * k, p), S_i @ D_i]
            seen += [Matrix.zeros(d * k, p), D_i]
        whole = stack([inputs(system, everything), *into], p)
        starts = [sum(B_j.ncols for B_j in system.B[:i]) for i in range(system.m + 1)]
        B = [whole.across(range(*ends)) for ends in pairwise(starts)]
        D = stack(seen, p)
    digest = with_digest(canonical_json(by_channel(system, S)))
    which = f"signals of {polynomial_text(alpha)} for the combinations S of its outputs"
    return suffixed(system, f"with models of the {which} with {digest}", A=A, B=B, C=C, D=D)


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
    digest = with_digest(canonical_json(by_channel(system, F)))
    words = f"the open-loop error system under the state feedback F with {digest}"
    return prefixed(words, system, A=A, B=[e_i.T for e_i in e], C=C)


# The system that a claim is about, built from the plant by the constructions of ``FORMAT.md``.

LINE = "line"
"""The construction that only plants with parameters have, and before all others."""
LISTED = (arcs, augmented_outputs, closed_loop, dual, error, extended, feedback, full_output)
LAST = (periodic_loop, regulated, restricted, sampled, servo, slow)
MORE = (failed, held, input_filters, integrators, internal_model, lifted, merged, modulo)
CONSTRUCTIONS = {rule.__name__: rule for rule in (*LISTED, *MORE, *LAST)}
_OTHERS = closed_loop, dual, input_filters, internal_model
CARRYING = arcs, augmented_outputs, failed, merged, modulo, regulated, restricted, *_OTHERS
CARRIED = {rule.__name__ for rule in CARRYING}
"""The constructions that apply to systems with feedthrough."""


def read_subject(value: Json, plant: System, before: int = 0) -> System:
    """Apply the constructions in order, perhaps behind some that were applied already.

    Open: see ``proofs/OPEN.md``.
    """
    system = plant
    for k, step in enumerate(items(value, "subject"), before):
        place = f"subject[{k}]"
        if not isinstance(step, dict) or type(step.get("construction")) is not str:
            malformed(place, 'expected an object with the key "construction"')
        name = step["construction"]
        message = "a line needs a plant with parameters, and comes before all other constructions"
        require(name != LINE, "subject", place, message)
        if name not in CONSTRUCTIONS:
            incomplete("construction", place, f"{shown(name)} is not a construction known here")
        if system.D is not None and name not in CARRIED:
            incomplete("feedthrough", place, f"{name} is not known for systems with feedthrough")
        spend(1000 + 200 * system.m + len(system.words))
        parameters = {key: part for key, part in step.items() if key != "construction"}
        system = CONSTRUCTIONS[name](system, parameters, place)
        if system.D is not None and system.D.is_zero():
            system = replace(system, D=None)
        if k:
            system = replace(system, missed=None)  # it is that of the plant, which has changed
    return system
