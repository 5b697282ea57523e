"""Kinds about how well a loop performs: its cost, bounds for every controller, and margins.

Each claim is proved by few symmetric matrices, since a matrix inequality that holds for one matrix
P bounds the cost or the gain of the whole loop.  The checker forms the loop from the plant and the
controller, forms the inequality in integers, and decides that it is strict.

- ``loop_cost``: the mean of x'Qx + u'Ru under white disturbances is at most c.
- ``cost_bound``: this mean is at least c for every linear time-invariant controller, or for those
  whose agents act on each other along the edges of a graph alone.
- ``disk_margin``: the loop stays stable while inputs or outputs are multiplied by complex numbers
  near 1, each by itself or all of them at once.
- ``sector``: it stays stable while inputs pass through nonlinearities within sectors.

A symmetric matrix S is positive definite if R'SR is strictly diagonally dominant for a square R.
R is computed here in floating point, from Cholesky's factor, and no certificate contains it.
Whether the product dominates is decided in integers, so that R need not be right; its sums are
correctly rounded, so that every version of Python computes the same R.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from operator import mul
from typing import NamedTuple

from .constructions import Disturbed, disturbed, ports_of
from .core import budget
from .core.arithmetic import Matrix, beside, entries_of, stack
from .core.budget import spend
from .core.evidence import inputs, outputs
from .core.reading import (
    Json,
    boolean,
    fields,
    integer,
    items,
    malformed,
    matrix,
    names,
    positions,
    rational,
    require,
    string,
)
from .core.system import System, edge_set, quoted

# Symmetric matrices, and that they are positive definite.

HALF = Fraction(1, 2)
LARGEST = 4000
"""The largest exponent of a coordinate."""
BITS = 30
"""The bits of each entry of R."""
SHIFTS = (0.0, 1e-14, 1e-12)
"""What is added to the diagonal, scaled to 1, before Cholesky's factor is computed."""


def symmetric(value: Json, place: str, n: int) -> Matrix:
    """The matrix of entries s_ij 2^(e_i + e_j), of which the s_ij with j ≤ i are listed by rows."""
    listed, triangle = fields(value, place, "exponents", "entries")
    where = f"{place}.exponents"
    e = [integer(each, where, -LARGEST) for each in items(listed, where, n)]
    if any(each > LARGEST for each in e):
        malformed(where, f"expected exponents up to {LARGEST}")
    count = n * (n + 1) // 2
    s = [integer(each, place, -math.inf) for each in items(triangle, f"{place}.entries", count)]
    least = min(e, default=0)
    longest = budget.limbs(s) + 2 * (max(e, default=0) - least) // budget.LIMB + 1
    budget.build(n, n, longest)
    rows = [[0] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            entry = s[i * (i + 1) // 2 + j] << (e[i] + e[j] - 2 * least)
            rows[i][j] = rows[j][i] = entry
    return Matrix(rows, n).times(Fraction(4) ** least)


def require_positive(S: Matrix, place: str, message: str) -> None:
    """Stop unless R'SR is strictly diagonally dominant for an R that is proposed here.

    Theorem ``stability.dominant_congruence``.
    """
    n, longest = S.nrows, S.limbs
    spend(budget.table(3 * n, n, longest) + 6 * n**3)
    even = all(S.rows[i][j] == S.rows[j][i] for i in range(n) for j in range(i))
    require(even and all(S.rows[i][i] > 0 for i in range(n)), "definite", place, message)
    # |s_ij|^2 < s_ii s_jj in every definite matrix; the scaled entries are below 4 then
    bits = [[entry.bit_length() for entry in row] for row in S.rows]
    small = all(2 * bits[i][j] <= bits[i][i] + bits[j][j] + 1 for i in range(n) for j in range(i))
    require(small, "definite", place, message)
    halves = [S.rows[i][i].bit_length() // 2 for i in range(n)]
    scaled = [[_scaled(S.rows[i][j], halves[i] + halves[j]) for j in range(n)] for i in range(n)]
    proved = any(_dominates(S, halves, _congruence(scaled, shift)) for shift in SHIFTS)
    require(proved, "definite", place, message)


def _scaled(number: int, halvings: int) -> float:
    """A number divided by 2^halvings, without overflow on the way."""
    shift = max(number.bit_length() - 60, 0)
    part = number >> shift if number >= 0 else -(-number >> shift)
    return math.ldexp(part, shift - halvings)


def _congruence(S: list[list[float]], shift: float) -> list[list[int]]:
    """The columns of a multiple of L'^-1 in integers, S = LL'; none where S has no factor L."""
    n, L = len(S), list[list[float]]()
    for i, row in enumerate(S):
        left = list[float]()
        for j in range(i):
            above = L[j]
            left.append((row[j] - math.fsum(map(mul, left, above))) / above[j])
        rest = row[i] + shift - math.fsum(map(mul, left, left))
        if not 0 < rest < math.inf:
            return []
        L.append([*left, math.sqrt(rest)])
    columns = list[list[int]]()
    inverse = [[0.0] * n for _ in range(n)]
    for i, row in enumerate(L):
        for k in range(i):
            factor, above = row[k], inverse[k]
            if factor:
                for j in range(k + 1):
                    inverse[i][j] -= factor * above[j]
        inverse[i] = [entry / row[i] for entry in inverse[i]]
        inverse[i][i] = 1 / row[i]
        size = max(map(abs, inverse[i]))
        if not 0 < size < math.inf:
            return []
        power = BITS - math.frexp(size)[1]
        columns.append([round(math.ldexp(entry, power)) for entry in inverse[i]])
    return columns


def _dominates(S: Matrix, halves: list[int], columns: list[list[int]]) -> bool:
    """Whether R'SR is strictly diagonally dominant, R with these columns in scaled coordinates."""
    if len(columns) != S.nrows:
        return False
    most = max(halves, default=0)
    scaled = [[x << (most - e) for x, e in zip(column, halves, strict=True)] for column in columns]
    R = Matrix(scaled, S.nrows)
    Z = R @ (Matrix(S.rows, S.ncols) @ R.T)
    spend(budget.products(2 * S.nrows * (S.nrows + 4), Z.limbs, 1))
    sizes = enumerate((row, sum(map(abs, row))) for row in Z.rows)
    return all(row[i] > 0 and 2 * row[i] > total for i, (row, total) in sizes)


def bordered(top: Matrix, right: Matrix, corner: Matrix) -> Matrix:
    """[top right; right' corner]."""
    upper = beside([top, right], top.nrows)
    lower = beside([right.T, corner], corner.nrows)
    return stack([upper, lower], top.ncols + corner.ncols)


def diagonal_of(entries: Sequence[Fraction | int]) -> Matrix:
    """The diagonal matrix of rationals."""
    n, d = len(entries), math.lcm(*(entry.denominator for entry in entries))
    spend(budget.table(n, n, budget.limbs([d])) + budget.fractions(n, budget.limbs_of(entries)))
    rows = [[0] * n for _ in range(n)]
    for i, entry in enumerate(entries):
        rows[i][i] = entry.numerator * (d // entry.denominator)
    return Matrix(rows, n, d)


def trace(S: Matrix) -> Fraction:
    """The sum of the diagonal."""
    spend(budget.fractions(1, 2 * S.limbs))
    return Fraction(sum(S.rows[i][i] for i in range(S.nrows)), S.denominator)


def lyapunov(P: Matrix, M: Matrix, time: str) -> Matrix:
    """−(PM + M'P), discrete P − M'PM."""
    half = P @ M
    return (half + half.T).times(-1) if time == "continuous" else P - M.T @ half


# The loop that a claim is about, and the weights of a cost.


class Weights(NamedTuple):
    """J = mean of x'Qx + u'Ru, under w of intensity W and noise v of intensity V at the outputs.

    All four are diagonal.  In continuous time v passes a first-order filter of the bandwidth ω,
    v' = −ωv + ωn, unless ω is None, which is for strictly proper controllers alone.
    """

    Q: Matrix
    R: Matrix
    W: Matrix
    V: Matrix
    bandwidth: Fraction | None


def read_weights(value: Json, plant: System) -> Weights:
    """Read the diagonals, of which R has positive entries and the others none below 0."""
    place, (p, q) = "claim.weights", ports_of(plant)
    *lists, band = fields(value, place, *DIAGONALS, optional=("bandwidth",))
    sizes, diagonals = (plant.n, p, plant.n, q), list[Matrix]()
    for key, listed, size in zip(DIAGONALS, lists, sizes, strict=True):
        where = f"{place}.{key}"
        entries = [rational(entry, where) for entry in items(listed, where, size)]
        spend(budget.LOOK * size)
        least = min(entries, default=Fraction(1))
        if least < 0 or (key == "inputs" and not least):
            malformed(where, "expected no entry below 0, and none that is 0 for an input")
        diagonals.append(diagonal_of(entries))
    omega = None if band is None else rational(band, f"{place}.bandwidth")
    if omega is not None and (omega <= 0 or plant.time != "continuous"):
        malformed(f"{place}.bandwidth", "expected a number above 0, in continuous time alone")
    Q, R, W, V = diagonals
    return Weights(Q, R, W, V, omega)


DIAGONALS = ("states", "inputs", "disturbances", "noise")
"""The keys of the diagonals of Q, R, W and V."""


def weights_in_words(value: Json) -> str:
    """The cost, the disturbances and the noise of a claim."""
    Q, R, W, V = (", ".join(map(str, value[key])) for key in DIAGONALS)
    filtered = ""
    if "bandwidth" in value:
        filtered = f", which passes v' = -w v + w n with w = {value['bandwidth']}"
    return (
        f"the stationary mean of x'Qx + u'Ru, Q = diag({Q}), R = diag({R}), under white "
        f"disturbances of the states of intensity diag({W}) and white noise of intensity "
        f"diag({V}) at the outputs{filtered}"
    )


def loop_of(system: System) -> tuple[System, Disturbed]:
    """The system that a loop was closed around, and the loop with its inputs and outputs."""
    require(system.loop is not None, "subject", "subject", "not a closed loop")
    return system.loop.system, disturbed(system.loop)


# Kind ``loop_cost``: an upper bound on the cost of one loop.


def check_loop_cost(claim: Json, witness: Json, system: System) -> None:
    """One Lyapunov inequality for the loop with its noise, whose matrix bounds the cost.

    Theorems ``performance.cost_continuous``, ``performance.cost_filtered``,
    ``performance.cost_discrete``.
    """
    given, most = fields(claim, "claim", "weights", "cost")
    (form,) = fields(witness, "witness", "P")
    plant, loop = loop_of(system)
    weights, c = read_weights(given, plant), rational(most, "claim.cost")
    M, U, noise = _with_noise(loop, weights, system.time)
    N, n = M.nrows, plant.n
    P = symmetric(form, "witness.P", N)
    x = Matrix.unit_rows(N, 0, n)
    spent = x.T @ (weights.Q @ x) + U.T @ (weights.R @ U)
    require_positive(P, "witness.P", "not shown to be positive definite")
    decrease = lyapunov(P, M, system.time) - spent
    require_positive(decrease, "witness.P", "the cost does not decrease so fast along the loop")
    cost = trace(P.take(range(n), range(n)) @ weights.W) + trace(noise.T @ (P @ noise) @ weights.V)
    if system.time == "discrete":
        cost += trace(loop.K.T @ (weights.R @ loop.K) @ weights.V)
    require(cost <= c, "cost", "claim.cost", "the witness shows a larger cost only")


def _with_noise(loop: Disturbed, weights: Weights, time: str) -> tuple[Matrix, Matrix, Matrix]:
    """The loop with its filtered noise, the inputs, and the matrix through which n or v enters."""
    M, G, U, K = loop.M, loop.G, loop.U, loop.K
    if time == "discrete":
        return M, U, G
    if weights.bandwidth is None:
        message = "the noise passes to the inputs at once: the cost is infinite without a bandwidth"
        require(K.is_zero(), "cost", "claim.weights", message)
        return M, U, G
    q, omega = G.ncols, weights.bandwidth
    filtered = diagonal_of([omega] * q)
    above = beside([M, G], M.nrows)
    below = beside([Matrix.zeros(q, M.ncols), filtered.times(-1)], q)
    entering = stack([Matrix.zeros(M.nrows, q), filtered], q)
    return stack([above, below], M.ncols + q), beside([U, K], U.nrows), entering


def loop_cost_statement(claim: Json, system: System) -> str:
    """The statement: the loop is stable, and its cost is at most c."""
    return (
        f"the loop is stable, and {weights_in_words(claim['weights'])}, is at most {claim['cost']}"
    )


# Kind ``cost_bound``: a lower bound for every controller, or for every one within a graph.


class Part(NamedTuple):
    """The plant as a group of agents has it: the places of its states, inputs and outputs."""

    states: list[int]
    inputs: list[int]
    outputs: list[int]


def check_cost_bound(claim: Json, witness: Json, system: System) -> None:
    """Two matrix inequalities for each group of agents, whose bounds add up.

    Theorems ``cost_groups.bound_by_groups_continuous``, ``cost_groups.bound_by_groups_proper``,
    ``cost_groups.bound_by_groups_discrete``.
    """
    given, least, graph = fields(claim, "claim", "weights", "cost", optional=("graph",))
    weights, c = read_weights(given, system), rational(least, "claim.cost")
    owners, after = read_graph(graph, system)
    (listed,) = fields(witness, "witness", "groups")
    total, left = Fraction(0), [diagonal_entries(M) for M in (weights.W, weights.V)]
    for k, entry in enumerate(budget.counted(items(listed, "witness.groups"))):
        place = f"witness.groups[{k}]"
        keys = ("agents", "disturbances", "noise", "P", "S", "F", "share")
        members, *intensities, P, S, F, share = fields(entry, place, *keys)
        group = names(members, f"{place}.agents", system.names)
        closed = all(after[j] <= {*group} for j in group)
        message = "an agent outside of the group receives something from one inside"
        require(closed, "group", f"{place}.agents", message)
        part = part_of(system, owners, group)
        for key, value, rest, where in zip(
            ("disturbances", "noise"), intensities, left, (part.states, part.outputs), strict=True
        ):
            taken = nonnegative(value, f"{place}.{key}", len(where))
            spend(budget.fractions(len(taken), budget.limbs_of(taken) + budget.limbs_of(rest)))
            for at, amount in zip(where, taken, strict=True):
                rest[at] -= amount
                message = "the groups take more than there is"
                require(rest[at] >= 0, "intensity", f"{place}.{key}", message)
        W, V = (diagonal_of(nonnegative(v, place, len(v))) for v in intensities)
        Q, R = weights.Q.take(part.states, part.states), weights.R.take(part.inputs, part.inputs)
        own = Weights(Q, R, W, V, weights.bandwidth)
        total += group_bound(own, matrices_of(system, part), (P, S, F, share), place, system.time)
    require(total >= c, "cost", "claim.cost", "the witness shows a smaller bound only")


def read_graph(value: Json, system: System) -> tuple[list[int], list[set[int]]]:
    """The agent to whom each state belongs, and the agents on whom each agent may act.

    An edge leads from j to i wherever something of agent j, a state or an input, enters something
    of agent i, a state or an output.  Without a graph everybody may act on everybody.
    """
    place, m = "claim.graph", system.m
    if value is None:
        return [0] * system.n, [{*range(m)}] * m
    states, listed = fields(value, place, "states", "edges")
    spend(4 * system.n * m)
    where = f"{place}.states"
    owners = [system.place_of(name, where) for name in items(states, where, system.n)]
    after, before = [{i} for i in range(m)], (-1, -1)
    for edge in items(listed, f"{place}.edges"):
        j, i = (system.place_of(end, f"{place}.edges") for end in items(edge, place, 2))
        if (j, i) <= before or j == i:
            malformed(f"{place}.edges", "expected edges between different agents, in order")
        before = j, i
        after[j].add(i)
    used = {(owners[c], owners[r]) for r, c, _ in entries_of(system.A)}
    for i, (B_i, C_i) in enumerate(zip(system.B, system.C, strict=True)):
        used |= {(i, owners[r]) for r, _, _ in entries_of(B_i)}
        used |= {(owners[c], i) for _, c, _ in entries_of(C_i)}
    message = "the plant itself acts along an edge that the graph does not have"
    require(all(i in after[j] for j, i in used), "graph", place, message)
    return owners, after


def part_of(system: System, owners: list[int], group: list[int]) -> Part:
    """The places of what belongs to the agents of a group, of the whole plant for all agents."""
    whole, members = len(group) == system.m, {*group}
    states = [k for k, owner in enumerate(owners) if whole or owner in members]
    inputs = _places([B_i.ncols for B_i in system.B], members)
    return Part(states, inputs, _places([C_i.nrows for C_i in system.C], members))


def _places(sizes: list[int], members: set[int]) -> list[int]:
    """The places, in the list of all ports, of those of some agents."""
    result, start = list[int](), 0
    for i, size in enumerate(sizes):
        result += range(start, start + size) if i in members else ()
        start += size
    return result


def matrices_of(system: System, part: Part) -> tuple[Matrix, Matrix, Matrix]:
    """A, B and C of a part of the plant."""
    everyone, x = range(system.m), part.states
    B, C = inputs(system, everyone), outputs(system, everyone)
    return system.A.take(x, x), B.take(x, part.inputs), C.take(part.outputs, x)


def group_bound(
    weights: Weights,
    plant: tuple[Matrix, Matrix, Matrix],
    forms: tuple[Json, Json, Json, Json],
    place: str,
    time: str,
) -> Fraction:
    """tr(PW) + tr(F'R_sFS), a lower bound on the cost if both inequalities are strict.

    For R_s = sR, discrete s(R + B'PB), and S₊ = ASA' + W they are

        N₁ = [PA + A'P + Q, PB; ·, R] − [F, −I]'R_s[F, −I],
             discrete [A'PA + Q − P, A'PB; ·, R + B'PB] − [F, −I]'R_s[F, −I],
        N₂ = [AS + SA' + W, (I − A/ω)SC'; ·, V − (2/ω)CSC'], without ω [·, SC'; CS, V],
             discrete [S₊ − S, S₊C'; ·, CS₊C' + V].

    Theorems ``cost_bound.bound_continuous``, ``cost_bound.bound_proper``,
    ``cost_bound.bound_discrete``.
    """
    (A, B, C), (Q, R, W, V, omega) = plant, weights
    n, p = A.nrows, B.ncols
    P, S = (symmetric(forms[k], f"{place}.{key}", n) for k, key in enumerate("PS"))
    F, s = matrix(forms[2], f"{place}.F", p, n), rational(forms[3], f"{place}.share")
    require(0 <= s < 1, "share", f"{place}.share", "expected a share from 0 on, below 1")
    if time == "continuous":
        R_s, half, drift = R.times(s), P @ A, A @ S
        first = bordered(half + half.T + Q, P @ B, R)
        slow = Fraction(0) if omega is None else 1 / omega
        SC = S @ C.T
        second = bordered(
            drift + drift.T + W, SC - (A @ SC).times(slow), V - (C @ SC).times(2 * slow)
        )
    else:
        spent, after = R + B.T @ (P @ B), A @ (S @ A.T) + W
        R_s, half = spent.times(s), A.T @ P
        first = bordered(half @ A + Q - P, half @ B, spent)
        second = bordered(after - S, after @ C.T, C @ (after @ C.T) + V)
    gain = beside([F, Matrix.unit_rows(p, 0, p).times(-1)], p)
    first = first - gain.T @ (R_s @ gain)
    named = {"P": P, "S": S, "F": first, "share": second}
    for key, M in named.items():
        require_positive(M, f"{place}.{key}", "a matrix is not shown to be positive definite")
    return trace(P @ W) + trace(F.T @ (R_s @ F) @ S)


def nonnegative(value: Json, place: str, size: int) -> list[Fraction]:
    """Rationals from 0 on."""
    entries = [rational(entry, place) for entry in items(value, place, size)]
    spend(budget.LOOK * size)
    if any(entry < 0 for entry in entries):
        malformed(place, "expected no number below 0")
    return entries


def diagonal_entries(M: Matrix) -> list[Fraction]:
    """The diagonal."""
    spend(budget.fractions(M.nrows, M.limbs))
    return [Fraction(M.rows[i][i], M.denominator) for i in range(M.nrows)]


def cost_bound_statement(claim: Json, system: System) -> str:
    """The statement: for which controllers the cost is at least c."""
    whose = "every linear time-invariant controller"
    kept = "bandwidth" in claim["weights"] or system.time == "discrete"
    whose += "" if kept else " whose inputs do not depend on the outputs at once"
    if "graph" in claim:
        graph = claim["graph"]
        owned = ", ".join(map(quoted, graph["states"]))
        edges = edge_set(map(tuple, graph["edges"]))
        whose += (
            f" by which agents act on others along the edges {edges} alone, the states of the "
            f"plant being those of {owned} in turn"
        )
    return (
        f"with {whose} that makes the loop stable, {weights_in_words(claim['weights'])}, "
        f"is at least {claim['cost']}"
    )


# Kind ``disk_margin``: inputs or outputs are multiplied by complex numbers near 1.


def check_disk_margin(claim: Json, witness: Json, system: System) -> None:
    """‖T + I/2‖ < 1/α by the bounded real lemma, T the response to what is added at the ports.

    Theorems ``performance.margin_continuous``, ``performance.margin_discrete``.
    """
    side, all_at_once, size = fields(claim, "claim", "at", "together", "margin")
    ports, together = string(side, "claim.at", *PORTS), boolean(all_at_once, "claim.together")
    alpha = rational(size, "claim.margin")
    require(alpha > 0, "margin", "claim.margin", "expected a number above 0")
    (listed,) = fields(witness, "witness", "parts")
    _, loop = loop_of(system)
    enter, leave = (loop.E, loop.U) if ports == "inputs" else (loop.G, loop.Y)
    proved, every = set[int](), {*range(leave.nrows)}
    require(bool(items(listed, "witness.parts")), "ports", "witness.parts", "expected a part")
    for k, entry in enumerate(budget.counted(listed)):
        place = f"witness.parts[{k}]"
        chosen, theta, form = fields(entry, place, "ports", "scaling", "P")
        where = positions(chosen, f"{place}.ports", leave.nrows)
        scaling = nonnegative(theta, f"{place}.scaling", len(where))
        require(all(scaling), "scaling", f"{place}.scaling", "expected numbers above 0")
        P = symmetric(form, f"{place}.P", loop.M.nrows)
        signals = loop.M, enter.take(cols=where), leave.at(where)
        gain = bounded_real(P, signals, diagonal_of(scaling), 1 / alpha**2, system.time)
        require_positive(P, f"{place}.P", "not shown to be positive definite")
        require_positive(gain, f"{place}.P", "the inequality is not shown to be strict")
        if not together or {*where} == every:
            proved |= {*where}
    require(proved == every, "ports", "witness.parts", "some ports are left out")


def bounded_real(
    P: Matrix, signals: tuple[Matrix, Matrix, Matrix], Theta: Matrix, square: Fraction, time: str
) -> Matrix:
    """[−(PM+M'P) − Y'ΘY, −PE − Y'Θ/2; ·, γ²Θ − Θ/4], discrete with P − M'PM, −M'PE and −E'PE.

    Positive definite, it shows ‖Θ^½(T + I/2)Θ^−½‖ < γ for T = Y(xI − M)⁻¹E.
    """
    M, E, Y = signals
    seen = Y.T @ Theta
    corner = Theta.times(square - HALF**2)
    if time == "discrete":
        corner = corner - E.T @ (P @ E)
    right = (P @ E if time == "continuous" else M.T @ (P @ E)) + seen.times(HALF)
    return bordered(lyapunov(P, M, time) - seen @ Y, right.times(-1), corner)


PORTS = ("inputs", "outputs")


def disk_margin_statement(claim: Json, system: System) -> str:
    """The statement: which ports may be multiplied by which complex numbers."""
    port = claim["at"].removesuffix("s")
    each = f"all {claim['at']} are" if claim["together"] else f"any one {port} is"
    size = claim["margin"]
    apart = ", with a d for each," if claim["together"] else ""
    return (
        f"the loop is stable, also where {each} multiplied by (1 + d/2)/(1 - d/2){apart} for "
        f"complex numbers d with |d| <= {size}: disk margin {size}"
    )


# Kind ``sector``: inputs pass through nonlinearities within sectors.


def check_sector(claim: Json, witness: Json, system: System) -> None:
    """The circle criterion: a quadratic form decreases wherever the nonlinearities may be.

    Theorems ``performance.sector_continuous``, ``performance.sector_discrete``.
    """
    (listed,) = fields(claim, "claim", "sectors")
    theta, form = fields(witness, "witness", "scaling", "P")
    _, loop = loop_of(system)
    p = loop.U.nrows
    ends = [
        [rational(end, "claim.sectors") for end in items(pair, "claim.sectors", 2)]
        for pair in items(listed, "claim.sectors", p)
    ]
    require(all(a <= b for a, b in ends), "sector", "claim.sectors", "expected [a, b] with a <= b")
    scaling = nonnegative(theta, "witness.scaling", p)
    require(all(scaling), "scaling", "witness.scaling", "expected numbers above 0")
    P = symmetric(form, "witness.P", loop.M.nrows)
    products = diagonal_of([t * a * b for t, (a, b) in zip(scaling, ends, strict=True)])
    means = diagonal_of([t * (a + b) / 2 for t, (a, b) in zip(scaling, ends, strict=True)])
    # z' = (M − EU)z + E φ, and Σ θ (φ − a v)(b v − φ) ≥ 0 for v = Uz
    apart, U = loop.M - loop.E @ loop.U, loop.U
    corner = diagonal_of(scaling)
    if system.time == "discrete":
        corner = corner - loop.E.T @ (P @ loop.E)
    right = P @ loop.E if system.time == "continuous" else apart.T @ (P @ loop.E)
    right = (right + U.T @ means).times(-1)
    decrease = bordered(lyapunov(P, apart, system.time) + U.T @ (products @ U), right, corner)
    require_positive(P, "witness.P", "not shown to be positive definite")
    require_positive(decrease, "witness.P", "the form is not shown to decrease")


def sector_statement(claim: Json, system: System) -> str:
    """The statement: between which multiples of its argument each nonlinearity lies."""
    sectors = ", ".join(f"[{a}, {b}]" for a, b in claim["sectors"])
    return (
        "every solution tends to 0 exponentially where each input of the plant is a function "
        "f(t, v) of the input v that its agent computes, between a v and b v for the ends a and b "
        f"of its sector, the sectors being {sectors} in turn"
    )
