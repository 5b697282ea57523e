"""The paper's sections III to V on drawn systems: decisions, designs, networks; prints the counts.

Run as ``python -m tests.assurance.campaigns.extended [COUNT] [SEED]``; the tests call it with small
counts.
"""

from __future__ import annotations

import random
import sys
import time
from collections import Counter
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import completeness
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import extended_system
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import jointly_controllable_system, system_with_fixed_mode
from mcexact.errors import Impossible, LimitReached
from mcexact.exact.linear_algebra import left_nullspace
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.gate import Arithmetic
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.setpoint import SetpointMethod, design_setpoint
from tests.oracle.networks import connectivity, extended_verdict, held_verdict, lifted_verdict

RADIUS = Fraction(1, 2)


def required(condition: bool, what: str, where: str) -> None:
    """Stop the campaign at the first counterexample.

    Raises
    ------
    AssertionError
        If the condition does not hold.
    """
    if not condition:
        raise AssertionError(f"{where}: {what}")


def valid(certificates: Iterable[Any], where: str) -> int:
    """Check certificates with the independent checker; their number."""
    count = 0
    for made in certificates:
        verdict = check_document(encode(made).encode("ascii"))
        required(verdict.verdict == "VALID", verdict.line()[:300], where)
        count += 1
    return count


def drawn_network(seed: int) -> MultiChannelSystem:
    """A discrete-time plant, n ≤ 4, 2 ≤ m ≤ 4, on a graph with delays up to 3.

    Jointly controllable and observable; half of them have a fixed mode planted; two graphs of
    three are strongly connected.
    """
    choices, rng = SeededChoices(f"extended {seed}"), random.Random(seed)
    n, m = rng.randint(1, 4), rng.randint(2, 4)
    if rng.random() < 0.5:
        system = system_with_fixed_mode(choices, n, m, time="discrete").system
    else:
        system = jointly_controllable_system(choices, n, m, time="discrete").system
    graph = drawn_graph(choices, system.names, rng.random() < 0.67, longest_delay=rng.randint(0, 3))
    return system.with_neighbors(graph)


def statements(count: int, seed: int) -> Counter[str]:
    """Theorems 2 to 4, Remark 2, Proposition 3, both corollaries and the smaller claims.

    Raises
    ------
    AssertionError
        On the first counterexample.
    """
    seen = Counter[str]()
    for number in range(seed, seed + count):
        system, where = drawn_network(number), f"system {number}"
        graph = system.neighbors
        if graph is None:
            raise AssertionError(where)
        undelayed = NeighborGraph(graph.names, graph.neighbors)
        plain = system.with_neighbors(undelayed)
        seen["systems"] += 1
        seen["strongly connected graphs"] += graph.is_strongly_connected()
        seen["with delays"] += bool(graph.delays)
        both = shared_dimension_bound(plain).deficiency
        alone = shared_dimension_bound(plain, share="states").deficiency
        seen["bound positive, outputs sent"] += both > 0
        seen["bound positive, sub-states alone"] += alone > 0
        made = _smaller_claims(system, plain, random.Random(number), where)
        if graph.is_strongly_connected():
            made += _theorems(system, plain, both, alone, where)
            made += _corollaries(system, plain, both, where, seen)
        seen["certificates VALID"] += made
    return seen


def _theorems(
    system: MultiChannelSystem, plain: MultiChannelSystem, both: int, alone: int, where: str
) -> int:
    """Theorem 2, Remark 2, Theorem 3 in both ways of sharing, Theorem 4."""
    m = system.m
    second = extended_verdict(plain, [both] * m)
    required(second.nothing_fixed, "Theorem 2", where)
    remark = extended_verdict(plain, [alone] * m, share="states")
    required(remark.nothing_fixed, "Remark 2", where)
    third = lifted_verdict(system, [both] * m)
    required(third.only_zero_fixed, "Theorem 3", where)
    only = lifted_verdict(system, [alone] * m, share="states")
    required(only.only_zero_fixed, "Theorem 3, sub-states only", where)
    fourth = held_verdict(system, [alone] * m)
    required(fourth.nothing_fixed, "Theorem 4", where)
    return sum(valid(v.certificates, where) for v in (second, remark, third, only, fourth))


def _smaller_claims(
    system: MultiChannelSystem, plain: MultiChannelSystem, rng: random.Random, where: str
) -> int:
    """Proposition 3, and what the paper says whatever the graph."""
    sizes = [rng.randint(0, 2) for _ in range(system.m)]
    positive = [rng.randint(1, 2) for _ in range(system.m)]
    extended, lifted = extended_verdict(plain, sizes), lifted_verdict(system, sizes)
    held = held_verdict(system, positive)
    for verdict, name in ((extended, "extended"), (held, "held")):
        required(verdict.controllability.controllable, f"{name}: jointly controllable", where)
        required(verdict.observability.controllable, f"{name}: jointly observable", where)
    required(lifted.only_zero_uncontrollable, "lifted: only 0 uncontrollable", where)
    required(lifted.observability.controllable, "lifted: jointly observable", where)
    inclusion = connectivity(plain, extended_system(plain, positive))
    required(inclusion.union_contained, "Proposition 3", where)
    later = connectivity(system, lifted_verdict(system, positive).system)
    required(later.union_contained, "the union lies in the lifted transfer graph", where)
    joined = connectivity(system, held.system)
    required(joined.union_connected == joined.network_connected, "held connected iff union", where)
    graphs = [inclusion.plant, inclusion.network, later.network, joined.network]
    made = valid(graphs, where)
    return made + sum(valid(v.certificates, where) for v in (extended, lifted, held))


def _corollaries(
    system: MultiChannelSystem,
    plain: MultiChannelSystem,
    bound: int,
    where: str,
    seen: Counter[str],
) -> int:
    """Corollary 1 with n_i ≥ 1, decided; Corollary 2 by a design for a radius, run late."""
    free = completeness(extended_system(plain, [max(bound, 1)] * system.m))
    required(free.complete, "Corollary 1, n_i at least 1", where)
    design = design_extended(system, radius="1/100", network="lifted", aims=THEOREM)
    required(design.certificates["stability"].claim()["stable"], "Corollary 2", where)
    seen["designs below the observer's order"] += design.order < design.parts["observer_order"]
    run = simulate(system, design.controller, horizon=2 * design.loop.closed.dimension + 2)
    required(not any(run.snapshots[-1].plant), "the network does not come to rest", where)
    return valid([free, *design.certificates.values()], where)


def drawn_square_plant(seed: int) -> MultiChannelSystem:
    """A plant with as many outputs as inputs in every channel, over a connected graph."""
    choices, rng = SeededChoices(f"set-point {seed}"), random.Random(seed)
    n, m = rng.randint(1, 3), rng.randint(1, 3)
    time_domain = rng.choice(["continuous", "discrete"])

    def entries(nrows: int, ncols: int) -> list[list[int]]:
        return [[rng.randint(-2, 2) for _ in range(ncols)] for _ in range(nrows)]

    while True:
        ports = [1 if n > 1 or m == 1 else rng.randint(0, 1) for _ in range(m)]
        system = MultiChannelSystem(
            Matrix.from_rows(entries(n, n), ncols=n),
            [Matrix.from_rows(entries(n, p), ncols=p) for p in ports],
            [Matrix.from_rows(entries(p, n), ncols=n) for p in ports],
            time=time_domain,
        )
        if n > sum(ports) > 0 and rng.random() < 0.4:
            system = with_zero(system)
        reachable = joint_controllability(system).controllable
        if reachable and joint_observability(system).controllable:
            graph = drawn_graph(choices, system.names, strongly_connected=True)
            return system.with_neighbors(graph)


def with_zero(system: MultiChannelSystem) -> MultiChannelSystem:
    """The same plant with an output replaced, so that it has a zero where integrators are.

    With w B = 0 the output w (A − e I) x is 0 in every equilibrium (e = 1 in discrete time).
    """
    w = left_nullspace(system.input_matrix()).take(rows=[0])
    row = w @ system.A - w * int(system.time == "discrete")
    seen = next(i for i in range(system.m) if system.q(i))
    C = [row if i == seen else system.C(i) for i in range(system.m)]
    return MultiChannelSystem(system.A, [system.B(i) for i in range(system.m)], C, time=system.time)


def setpoints(count: int, seed: int) -> Counter[str]:
    """Set-point designs until so many plants met the condition, run for 20 time constants.

    Raises
    ------
    AssertionError
        If an output misses its reference by more than 1e-6, or a refusal is not proved.
    """
    seen, number = Counter[str](), seed
    while seen["plants that satisfy the condition"] < count:
        system, where = drawn_square_plant(number), f"square plant {number}"
        number += 1
        found = setpoint_solvability(system)
        seen["certificates VALID"] += valid([found], where)
        if not found.solvable:
            _refused(system, where, seen)
            continue
        method: SetpointMethod = "extended" if number % 4 < 2 else "observer"
        arithmetic: Arithmetic = "float" if number % 2 else "exact"
        wanted: dict[str, Any] = {"radius": RADIUS} if system.time == "discrete" else {"rate": 1}
        try:
            design = design_setpoint(system, method=method, arithmetic=arithmetic, **wanted)
        except LimitReached:
            # A drawn plant may leave floating point too little room on some processors.
            required(arithmetic == "float", "exact arithmetic finds a design", where)
            seen["nothing found in floating point"] += 1
            continue
        required(design.certificates["stability"].claim()["stable"], "stable", where)
        error = tracking_error(system, design.controller, random.Random(number))
        required(error <= 1e-6, f"an output misses its reference by {error}", where)
        seen["plants that satisfy the condition"] += 1
        seen[f"{system.time} time, the method {method}, {arithmetic} arithmetic"] += 1
        seen["certificates VALID"] += valid(design.certificates.values(), where)
    return seen


def _refused(system: MultiChannelSystem, where: str, seen: Counter[str]) -> None:
    """A plant that fails the condition is refused with the combination, and with a zero or not."""
    try:
        design_setpoint(system, rate=1 if system.time == "continuous" else None,
                        radius=RADIUS if system.time == "discrete" else None)  # fmt: skip
    except Impossible as refusal:
        claim = refusal.certificate.claim()
        named = "invariant zero" in str(refusal)
        required(named == claim["invariant_zero"], "the zero is named iff it is one", where)
        required("r ≠ 0" in str(refusal), "no combination", where)
        seen["refused, an invariant zero" if named else "refused, dependent outputs"] += 1
        return
    raise AssertionError(f"{where}: not refused")


def tracking_error(system: MultiChannelSystem, controller: Any, rng: random.Random) -> float:
    """The largest relative distance of an output from its set-point at 20 time constants.

    The time constant is 1 / rate, rate 1; in discrete time 1 / ln 2 steps, radius 1/2.
    """
    reference = [
        [Fraction(rng.choice([-1, 1]) * rng.randint(1, 9)) for _ in range(system.q(i))]
        for i in range(system.m)
    ]
    if system.time == "continuous":
        run = simulate(
            system,
            controller,
            horizon=20,
            points=20,
            reference=reference,
            arithmetic="multiprecision",
        )
    else:
        run = simulate(system, controller, horizon=29, reference=reference)
    state = run.snapshots[-1].plant
    worst = 0.0
    for i in range(system.m):
        for row, wanted in zip(system.C(i).rows(), reference[i], strict=True):
            output = sum(float(c) * float(x) for c, x in zip(row, state, strict=True))
            worst = max(worst, abs(output - float(wanted)) / abs(float(wanted)))
    return worst


def main(arguments: list[str]) -> None:
    """Run both and print the counts."""
    count = int(arguments[0]) if arguments else 500
    seed = int(arguments[1]) if len(arguments) > 1 else 1
    for name, run, number in (
        ("statements of the paper", statements, count),
        ("set-points", setpoints, max(1, count // 10)),
    ):
        begun = time.perf_counter()
        seen = run(number, seed)
        print(f"{name} ({time.perf_counter() - begun:.0f} s)")
        for what, times in sorted(seen.items()):
            print(f"  {times:6d}  {what}")


if __name__ == "__main__":
    main(sys.argv[1:])
