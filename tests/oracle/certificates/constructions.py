"""The subject of a certificate: constructions applied to the plant, in their order."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import fmpq_mat

from .algebra import below, beside, identity, selection, stacked
from .controllers import closed_loop
from .networks import held, lifted
from .one_parameter import along, read_parametric
from .reading import (
    demand,
    integer,
    listed,
    matrix,
    place,
    polynomial,
    positions,
    rational,
    record,
    text,
)
from .rearranged import REARRANGING, rearranged
from .sampling import sampled
from .several_parameters import read_several
from .systems import System, read_plant

LINE = "line"


def subject_of(document: Mapping[str, Any], most: int | None = None) -> Any:
    """The system that the claim of a document is about.

    Parameters
    ----------
    most : int, optional
        How many constructions to apply; all by default.
    """
    if is_ranged(document):
        several = read_several(document["system"])
        whole = listed(document["subject"])
        for k, step in enumerate(whole):
            demand(isinstance(step, Mapping), "expected a construction")
            last = document["kind"] == "parametric_box_stable" and k == len(whole) - 1
            known = step.get("construction") in (*REARRANGING, *["closed_loop"] * last)
            demand(known, "expected one that only places entries, or at last a closed loop")
        steps = whole[:most]
        return built(several.at(next(several.points())), steps)
    if isinstance(document["system"], Mapping) and "parameters" in document["system"]:
        steps = listed(document["subject"])[:most]
        if steps and isinstance(steps[0], Mapping) and steps[0].get("construction") == LINE:
            return rearranged(along(read_several(document["system"]), steps[0]), steps[1:], built)
        if most == 0:
            return read_several(document["system"])
        return rearranged(read_parametric(document["system"]), steps, built)
    return built(read_plant(document["system"]), listed(document["subject"])[:most])


def is_ranged(document: Mapping[str, Any]) -> bool:
    """Whether a document is about all values within ranges of parameters."""
    known = isinstance(document["system"], Mapping) and "parameters" in document["system"]
    return known and str(document.get("kind")).startswith("parametric_box_")


def built(system: System, steps: Sequence[Any]) -> System:
    """What constructions make from a system."""
    for step in steps:
        demand(isinstance(step, Mapping), "expected a construction")
        name = step.get("construction")
        demand(isinstance(name, str) and name in CONSTRUCTIONS, "expected a known construction")
        demand(system.D is None or name in DIRECT, "expected no feedthrough")
        keys, build = CONSTRUCTIONS[name]
        system = build(system, record(step, "construction", *keys))
    return system


def augmented_outputs(system: System, _: Mapping[str, Any]) -> System:
    """C_i becomes C_{N_i}."""
    heard = [j for N in system.graph() for j in N]
    D = system.between(heard, range(system.m))
    return replace(system, C=tuple(system.outputs(N) for N in system.graph()), D=D)


def dual(system: System, _: Mapping[str, Any]) -> System:
    """A', and B_i and C_i change places, transposed."""
    B, C = ([M.transpose() for M in Ms] for Ms in (system.C, system.B))
    D = None if system.D is None else system.D.transpose()
    return replace(system, A=system.A.transpose(), B=tuple(B), C=tuple(C), D=D).plain()


def feedback(system: System, given: Mapping[str, Any]) -> System:
    """A_F instead of A."""
    A = system.A
    for B, F, C in zip(system.B, output_gains(system, given["gains"]), system.C, strict=True):
        A = A + B * F * C
    return replace(system, A=A)


def output_gains(system: System, value: Any) -> list[fmpq_mat]:
    """Matrices F_i of p_i rows and q_i columns."""
    return [
        matrix(F, B.ncols(), C.nrows())
        for F, B, C in zip(listed(value, system.m), system.B, system.C, strict=True)
    ]


def full_output(system: System, given: Mapping[str, Any]) -> System:
    """C_q becomes the identity."""
    q = place(given["channel"], system.names)
    C = [identity(system.n) if i == q else C for i, C in enumerate(system.C)]
    return replace(system, C=tuple(C))


def arcs(system: System, given: Mapping[str, Any]) -> System:
    """Every link [j, i] that is added makes j a member of N_i."""
    neighborhoods = [set(h) for h in system.graph()]
    for source, target in (listed(edge, 2) for edge in listed(given["added"])):
        j, i = place(source, system.names), place(target, system.names)
        demand(j not in neighborhoods[i], "expected links that the graph lacks")
        neighborhoods[i].add(j)
    return replace(system, neighborhoods=tuple(tuple(sorted(h)) for h in neighborhoods))


def shares(system: System, given: Mapping[str, Any]) -> tuple[list[int], bool]:
    """The dimensions of the shared sub-states, and whether outputs are shared."""
    sizes = [integer(d, 0) for d in listed(given["dimensions"], system.m)]
    share = given.get("share", "states")
    demand(share in ("outputs+states", "states"), "expected what is shared")
    return sizes, share == "outputs+states"


def extended(system: System, given: Mapping[str, Any]) -> System:
    """State (x, x_1, …, x_m), with Ā, B̄_i and C̄_i of the table."""
    sizes, outputs = shares(system, given)
    graph, n, total = system.graph(), system.n, sum(sizes)
    starts = [sum(sizes[:i]) for i in range(system.m + 1)]

    def own(i: int) -> fmpq_mat:
        return selection(total, range(starts[i], starts[i + 1]))

    A = stacked(
        [[system.A, fmpq_mat(n, total)], [fmpq_mat(total, n), fmpq_mat(total, total)]],
        n + total,
        n + total,
    )
    B, C = [], []
    for i in range(system.m):
        p = system.B[i].ncols()
        E = own(i).transpose()
        upper, lower = [system.B[i], fmpq_mat(n, sizes[i])], [fmpq_mat(total, p), E]
        B.append(stacked([upper, lower], n + total, p + sizes[i]))
        sent = system.outputs(graph[i]) if outputs else system.C[i]
        received = below([own(j) for j in graph[i]], total)
        rows = sent.nrows() + received.nrows()
        first = [sent, fmpq_mat(sent.nrows(), total)]
        C.append(stacked([first, [fmpq_mat(received.nrows(), n), received]], rows, n + total))
    return replace(system, A=A, B=tuple(B), C=tuple(C))


def integrators(system: System, _: Mapping[str, Any]) -> System:
    """State (x, w), w' = C x or w(t+1) = C x + w; the outputs of channel i are its part of w."""
    n, C = system.n, system.outputs()
    q = C.nrows()
    memory = identity(q) if system.time == "discrete" else fmpq_mat(q, q)
    A = stacked([[system.A, fmpq_mat(n, q)], [C, memory]], n + q, n + q)
    B = [below([b, fmpq_mat(q, b.ncols())], b.ncols()) for b in system.B]
    outputs, start = [], n
    for c in system.C:
        outputs.append(selection(n + q, range(start, start + c.nrows())))
        start += c.nrows()
    return replace(system, A=A, B=tuple(B), C=tuple(outputs))


def chosen(system: System, given: Mapping[str, Any]) -> list[fmpq_mat]:
    """S_i for each channel, of as many columns as the channel has outputs."""
    return [
        matrix(S, len(S["entries"]), C.nrows())
        for S, C in zip(listed(given["gains"], system.m), system.C, strict=True)
    ]


def regulated(system: System, given: Mapping[str, Any]) -> System:
    """The outputs S_i y_i in place of y_i."""
    picked = chosen(system, given)
    outputs = [S * C for S, C in zip(picked, system.C, strict=True)]
    rows = [system.between([i], range(system.m)) for i in range(system.m)]
    p = system.inputs().ncols()
    direct = [
        fmpq_mat(S.nrows(), p) if D is None else S * D for S, D in zip(picked, rows, strict=True)
    ]
    D = below(direct, p)
    nonzero = any(x != 0 for x in D.entries())
    return replace(system, C=tuple(outputs), D=D if nonzero else None)


def servo(system: System, given: Mapping[str, Any]) -> System:
    """The integrators of the system with outputs S_i y_i; y_i is measured, too."""
    made = integrators(regulated(system, given), {})
    k = made.n - system.n
    kept = [stacked([[C, fmpq_mat(C.nrows(), k)]], C.nrows(), made.n) for C in system.C]
    return replace(made, C=tuple(below([w, C], made.n) for w, C in zip(made.C, kept, strict=True)))


def internal_model(system: System, given: Mapping[str, Any]) -> System:
    """State (x, w_1, …, w_m), w_i = companion(alpha) (x) I behind S_i y_i; outputs w_i and y_i."""
    alpha = polynomial(given["polynomial"], monic=True)
    d = alpha.degree()
    demand(d >= 1, "expected a polynomial that is not constant")
    C, D = system.outputs(), system.between(range(system.m), range(system.m))
    S = chosen(system, given)
    n, p, q = system.n, system.inputs().ncols(), C.nrows()
    N = n + d * sum(s.nrows() for s in S)
    model = fmpq_mat(N - n, N - n)
    into = fmpq_mat(N - n, q)
    row = column = 0
    for s in S:
        k = s.nrows()
        for a in range(k):
            for j in range(d):
                here = row + j * k + a
                if j + 1 < d:
                    model[here, here + k] = 1
                else:
                    for e in range(d):
                        model[here, row + e * k + a] = -alpha[e]
                    for b in range(s.ncols()):
                        into[here, column + b] = s[a, b]
        row, column = row + d * k, column + s.ncols()
    A = stacked([[system.A, fmpq_mat(n, N - n)], [into * C, model]], N, N)
    B = below([system.inputs(), into * (D if D is not None else fmpq_mat(q, p))], p)
    B_of, C_of, D_of = list[fmpq_mat](), list[fmpq_mat](), list[fmpq_mat]()
    start, first = 0, n
    for i, (driven, c, s) in enumerate(zip(system.B, system.C, S, strict=True)):
        B_of.append(B * selection(p, range(start, start + driven.ncols())).transpose())
        own = selection(N, range(first, first + d * s.nrows()))
        C_of.append(below([own, stacked([[c, fmpq_mat(c.nrows(), N - n)]], c.nrows(), N)], N))
        own_D = system.between([i], range(system.m))
        seen = fmpq_mat(c.nrows(), p) if own_D is None else own_D
        D_of.append(below([fmpq_mat(d * s.nrows(), p), seen], p))
        start, first = start + driven.ncols(), first + d * s.nrows()
    return replace(
        system, A=A, B=tuple(B_of), C=tuple(C_of), D=None if D is None else below(D_of, p)
    )


def error(system: System, given: Mapping[str, Any]) -> System:
    """The open-loop error system of gains F_i of n columns."""
    graph, n, m = system.graph(), system.n, system.m
    gains = [
        matrix(F, B.ncols(), n) for F, B in zip(listed(given["gains"], m), system.B, strict=True)
    ]
    moved = [B * F for B, F in zip(system.B, gains, strict=True)]
    loop = system.A
    for BF in moved:
        loop = loop + BF
    A = stacked(
        [[(loop if i == j else fmpq_mat(n, n)) - moved[j] for j in range(m)] for i in range(m)],
        n * m,
        n * m,
    )
    unit, zero = identity(n), fmpq_mat(n, n)
    B = [below([unit if i == k else zero for i in range(m)], n) for k in range(m)]
    C = []
    for i in range(m):
        blocks = [beside([system.C[i] if k == i else fmpq_mat(system.C[i].nrows(), n)
                          for k in range(m)], system.C[i].nrows())]  # fmt: skip
        for j in graph[i]:
            if j != i:
                signs = [unit if k == i else -unit if k == j else zero for k in range(m)]
                blocks.append(beside(signs, n))
        C.append(below(blocks, n * m))
    return replace(system, A=A, B=tuple(B), C=tuple(C))


def merged(system: System, given: Mapping[str, Any]) -> System:
    """The channels of each part taken as one."""
    parts = [positions(part, system.names) for part in listed(given["parts"])]
    demand(bool(parts) and all(parts), "expected parts, none of them empty")
    demand(sorted(i for part in parts for i in part) == list(range(system.m)), "expected parts")
    demand(parts == sorted(parts), "expected parts by their first members")
    names = tuple("+".join(system.names[i] for i in part) for part in parts)
    demand(len(set(names)) == len(names), "expected different names")
    B = tuple(system.inputs(part) for part in parts)
    C = tuple(system.outputs(part) for part in parts)
    order = [i for part in parts for i in part]
    D = system.between(order, order)
    return replace(system, names=names, B=B, C=C, D=D).plain()


def modulo(system: System, given: Mapping[str, Any]) -> System:
    """The block of A that is left where a change of the basis splits the part off."""
    n, part = system.n, text(given["part"])
    demand(part in ("unobservable", "uncontrollable"), "expected a part")
    pivots = [integer(j, 0) for j in listed(given["pivots"])]
    k = len(pivots)
    demand(pivots == sorted(set(pivots)) and all(j < n for j in pivots), "expected positions")
    demand(k > 0, "expected a part that is not empty")
    W = matrix(given["annihilator"], k, n)
    units = selection(n, pivots).transpose()
    demand(W * units == identity(k), "expected the identity at the pivots")
    others = selection(n, [j for j in range(n) if j not in pivots]).transpose()
    whole, z = fmpq_mat(system.A), n - k
    # The part comes last: along it, or what its rows measure.
    P = beside([others, W.transpose()], n)
    if part == "uncontrollable":
        P = beside([others - units * (W * others), units], n)
    left = P.inv()
    A, B, C = left * whole * P, left * system.inputs(), system.outputs() * P
    kept, gone = selection(n, range(z)), selection(n, range(z, n))
    if part == "unobservable":
        leaks = [kept * A * gone.transpose(), C * gone.transpose()]
    else:
        leaks = [gone * A * kept.transpose(), gone * B]
    demand(all(x == 0 for M in leaks for x in M.entries()), "expected a part of this sort")
    own = gone * A * gone.transpose()
    demand(own.charpoly() == polynomial(given["polynomial"], monic=True), "expected another one")
    down, up = kept * left, P * kept.transpose()
    return replace(
        system,
        A=kept * A * kept.transpose(),
        B=tuple(down * B_i for B_i in system.B),
        C=tuple(C_i * up for C_i in system.C),
    )


def restricted(system: System, given: Mapping[str, Any]) -> System:
    """These channels, and no others."""
    chosen = positions(given["channels"], system.names)
    demand(bool(chosen), "expected a channel")
    names = tuple(system.names[i] for i in chosen)
    B, C = (tuple(part[i] for i in chosen) for part in (system.B, system.C))
    D = system.between(chosen, chosen)
    return replace(system, names=names, B=B, C=C, D=D).plain()


def failed(system: System, given: Mapping[str, Any]) -> System:
    """Zeros for what failed, in B_i, C_i and D, and a graph without the links that failed."""
    demand(any(given[part] for part in given if part != "construction"), "expected a failure")
    gone = positions(given["agents"], system.names)
    lost = {}
    for part, sizes in (
        ("actuators", [B.ncols() for B in system.B]),
        ("sensors", [C.nrows() for C in system.C]),
    ):
        pairs = [(place(i, system.names), integer(k, 1)) for i, k in map(_two, listed(given[part]))]
        demand(all(k <= sizes[i] for i, k in pairs), "expected inputs and outputs that exist")
        demand(pairs == sorted(set(pairs)), "expected inputs and outputs in their order")
        lost[part] = {
            (i, k)
            for i in range(system.m)
            for k in range(sizes[i])
            if i in gone or (i, k + 1) in pairs
        }
    cut = [
        (place(j, system.names), place(i, system.names))
        for j, i in map(_two, listed(given["links"]))
    ]
    graph = system.neighborhoods
    demand(all(graph is not None and i != j and j in graph[i] for j, i in cut), "expected links")
    demand(cut == sorted(set(cut)), "expected links in their order")

    def without(M: fmpq_mat, rows: set[int], columns: set[int]) -> fmpq_mat:
        cells = ((r, c) for r in range(M.nrows()) for c in range(M.ncols()))
        entries = [0 if r in rows or c in columns else M[r, c] for r, c in cells]
        return fmpq_mat(M.nrows(), M.ncols(), entries)

    def flat(part: str, blocks: Sequence[int]) -> set[int]:
        return {sum(blocks[:i]) + k for i, k in lost[part]}

    def own(part: str, i: int) -> set[int]:
        return {k for j, k in lost[part] if j == i}

    B = tuple(without(B_i, set(), own("actuators", i)) for i, B_i in enumerate(system.B))
    C = tuple(without(C_i, own("sensors", i), set()) for i, C_i in enumerate(system.C))
    D = system.D
    if D is not None:
        rows = flat("sensors", [M.nrows() for M in system.C])
        D = without(D, rows, flat("actuators", [M.ncols() for M in system.B]))
    made = replace(system, B=B, C=C, D=D)
    if graph is None:
        return made
    works = {
        (j, i)
        for i, N in enumerate(graph)
        for j in N
        if j == i or not ((j, i) in cut or j in gone or i in gone)
    }
    kept = tuple(tuple(j for j in N if (j, i) in works) for i, N in enumerate(graph))
    delays = {(i, j): d for (i, j), d in system.delays.items() if (j, i) in works}
    return replace(made, neighborhoods=kept, delays=delays)


def _two(pair: Any) -> tuple[Any, Any]:
    first, second = listed(pair, 2)
    return first, second


def input_filters(system: System, _: Mapping[str, Any]) -> System:
    """State (x, u), with Ã, B̃_i and C̃_i of the table."""
    n, p = system.n, system.inputs().ncols()
    blocks = [[system.A, system.inputs()], [fmpq_mat(p, n), fmpq_mat(p, p)]]
    A = stacked(blocks, n + p, n + p)
    B, C, everything = [], [], range(system.m)
    for i in everything:
        before = sum(M.ncols() for M in system.B[:i])
        own = selection(p, range(before, before + system.B[i].ncols()))
        direct = system.between([i], everything) or fmpq_mat(system.C[i].nrows(), p)
        B.append(below([fmpq_mat(n, own.nrows()), own.transpose()], own.nrows()))
        blocks = [[system.C[i], direct], [fmpq_mat(own.nrows(), n), own]]
        C.append(stacked(blocks, system.C[i].nrows() + own.nrows(), n + p))
    return replace(system, A=A, B=tuple(B), C=tuple(C), D=None)


def line(system: System, _: Mapping[str, Any]) -> System:
    """Only a plant with parameters has a line, and only as the first construction."""
    demand(False, "expected parameters")
    return system


def slow(system: System, given: Mapping[str, Any]) -> System:
    """Windows of Q steps: all outputs of the first n steps, all inputs of the last n."""
    Q, n = integer(given["window"], 1), system.n
    graph = system.graph()
    demand(system.time == "discrete" and Q >= 2 * n, "expected discrete time and Q at least 2n")
    powers = [identity(n)]
    for _ in range(Q):
        powers.append(powers[-1] * system.A)
    B = tuple(
        fmpq_mat(
            n,
            n * B_i.ncols(),
            [
                (powers[n - 1 - k] * B_i)[row, column]
                for row in range(n)
                for k in range(n)
                for column in range(B_i.ncols())
            ],
        )
        for B_i in system.B
    )
    C = tuple(
        fmpq_mat(
            n * C_i.nrows(),
            n,
            [
                (C_i * powers[k])[row, column]
                for k in range(n)
                for row in range(C_i.nrows())
                for column in range(n)
            ],
        )
        for C_i in system.C
    )
    late = {(i, j): 1 for i, heard in enumerate(graph) for j in heard if j != i}
    return replace(system, A=powers[Q], B=B, C=C, delays=late)


def periodic_loop(system: System, given: Mapping[str, Any]) -> System:
    """No channels; the matrices of the loops of all phases multiplied, the first one right."""
    demand(system.time == "discrete", "expected discrete time")
    phases = listed(given["phases"])
    demand(bool(phases), "expected a phase")
    product, sizes = None, set()
    for phase in phases:
        loop = closed_loop(system, phase)
        for agent in phase["agents"]:
            _demand_own(agent)
        sizes.add(tuple(agent["private"] for agent in phase["agents"]))
        product = loop.A if product is None else loop.A * product
    demand(len(sizes) == 1, "expected as many states in every phase")
    return replace(loop, A=product)


def _demand_own(agent: Mapping[str, Any]) -> None:
    """An agent uses y_i and z_i alone."""
    demand(agent["shared"] == 0, "expected no shared states")
    demand(not any(agent.get("hold", {}).values()), "expected nothing held")
    for label in ("shared_update", "private_update", "input"):
        for name, table in agent[label].get("outputs", {}).items():
            demand(name == agent["name"] or _is_zero(table), "expected the own output alone")
        demand(_is_zero(agent[label].get("reference", [])), "expected no set-points")


def _is_zero(table: Any) -> bool:
    """Whether a matrix of a controller has no entry that is not 0."""
    if isinstance(table, Mapping):
        return not table["entries"]
    return all(rational(entry) == 0 for row in table for entry in row)


DIRECT = (
    "arcs", "augmented_outputs", "closed_loop", "dual", "failed", "input_filters", "merged",
    "internal_model", "modulo", "regulated", "restricted",
)  # fmt: skip
"""The constructions of systems with feedthrough."""
Build = Callable[[System, Mapping[str, Any]], System]
CONSTRUCTIONS: Mapping[str, tuple[Sequence[str], Build]] = {
    "augmented_outputs": ((), augmented_outputs),
    "dual": ((), dual),
    "feedback": (("gains",), feedback),
    "full_output": (("channel",), full_output),
    "arcs": (("added",), arcs),
    "extended": (("share", "dimensions"), extended),
    "lifted": (("share", "dimensions"), lambda system, g: lifted(system, *shares(system, g))),
    "held": (("dimensions",), lambda system, g: held(system, shares(system, g)[0])),
    "slow": (("window",), slow),
    "input_filters": ((), input_filters),
    "integrators": ((), integrators),
    "internal_model": (("polynomial", "gains"), internal_model),
    LINE: (("parameter", "point", "direction"), line),
    "error": (("gains",), error),
    "merged": (("parts",), merged),
    "modulo": (("part", "annihilator", "pivots", "polynomial"), modulo),
    "regulated": (("gains",), regulated),
    "restricted": (("channels",), restricted),
    "failed": (("agents", "actuators", "sensors", "links"), failed),
    "sampled": (("step", "late", "decimals"), sampled),
    "servo": (("gains",), servo),
    "closed_loop": (("controller",), lambda system, g: closed_loop(system, g["controller"])),
    "periodic_loop": (("phases",), periodic_loop),
}
