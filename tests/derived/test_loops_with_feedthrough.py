"""Loops of plants with feedthrough, against determinants and against runs, step by step."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from pathlib import Path

import pytest
from flint import fmpq, fmpq_mat

import mcexact
from mcexact import (
    Controller,
    Matrix,
    MultiChannelSystem,
    NeighborGraph,
    certify_controller,
    check,
    design_decentralized,
    simulate,
)
from mcexact.checker.constructions import read_subject
from mcexact.checker.core.system import read_plant
from mcexact.constructions import input_filters, plant_controller
from mcexact.designs import AgentProgram, LinearMap, local_controllers
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.model.loop import closed_loop
from mcexact.model.text import plain
from tests.cli.calling import call
from tests.derived.test_feedthrough import SIGNED, all_drawn
from tests.oracle.certificates.constructions import built
from tests.oracle.certificates.systems import read_plant as read_oracle


def entries(rng: random.Random, nrows: int, ncols: int) -> Matrix:
    """Small integers."""
    return Matrix.from_rows(
        [[rng.randint(-2, 2) for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
    )


def controller_for(rng: random.Random, system: MultiChannelSystem) -> Controller:
    """A program with states for each agent, over the neighbor graph."""
    m, graph = system.m, system.neighbors or NeighborGraph.empty(system.names)
    shared, private = ([rng.randint(0, 2) for _ in range(m)] for _ in range(2))

    def drawn(i: int, nrows: int) -> LinearMap:
        heard = graph.neighborhood(i)
        return LinearMap(
            {j: entries(rng, nrows, system.q(j)) for j in heard},
            {j: entries(rng, nrows, shared[j]) for j in heard},
            entries(rng, nrows, private[i]),
        )

    sizes = [(shared[i], private[i], system.p(i)) for i in range(m)]
    agents = [
        AgentProgram(system.names[i], x, z, drawn(i, x), drawn(i, z), drawn(i, u))
        for i, (x, z, u) in enumerate(sizes)
    ]
    return Controller(system.time, system.digest_of_values(), tuple(agents))


def linked(system: MultiChannelSystem) -> MultiChannelSystem:
    """The system with a ring of neighbors."""
    return system.with_neighbors(NeighborGraph.ring(system.names))


def flint(M: Matrix) -> fmpq_mat:
    """A matrix of flint."""
    cells = [fmpq(x.numerator, x.denominator) for row in M.rows() for x in row]
    return fmpq_mat(M.nrows, M.ncols, cells)


def at_instants(system: MultiChannelSystem) -> MultiChannelSystem:
    """The same matrices in discrete time."""
    ports = list(system.B), list(system.C)
    return MultiChannelSystem(system.A, *ports, D=system.D, time="discrete")


def test_package_checker_and_oracle_close_the_same_loops() -> None:
    rng, closed, refused = random.Random(5), 0, 0
    for system in map(linked, all_drawn(60, seed=21)):
        controller = controller_for(rng, system)
        try:
            loop = closed_loop(system, controller).system
        except UsageError as error:
            assert "not well posed" in str(error)
            refused += 1
            continue
        closed += 1
        steps, document = plain(loop.subject), system.canonical_document()
        ours = read_subject(steps, read_plant(document))
        rows = [[Fraction(x, ours.A.denominator) for x in row] for row in ours.A.rows]
        assert rows == loop.A.tolist()
        assert built(read_oracle(document), steps).A == flint(loop.A)
    assert closed > 40 and refused < 20


def test_static_loops_are_those_of_determinants() -> None:
    """det(xI − A_F) det(I − FD) = det [xI − A, −B; −FC, I − FD], at some x."""
    rng = random.Random(6)
    for system in all_drawn(40, seed=22):
        gains = [entries(rng, system.p(i), system.q(i)) for i in range(system.m)]
        F = flint(mcexact.exact.matrix.block_diagonal(gains))
        A, B, C, D = map(
            flint,
            (system.A, system.input_matrix(), system.output_matrix(), system.feedthrough_matrix()),
        )
        n, p = system.n, B.ncols()
        try:
            loop = closed_loop(system, local_controllers(system, gains))
            found = characteristic_polynomial(loop.matrix)
        except UsageError:
            continue
        for x in (2, fmpq(1, 3), -5):
            rows = [
                [-A[i, j] + (x if i == j else 0) for j in range(n)] + [-B[i, j] for j in range(p)]
                for i in range(n)
            ]
            lower, inner = F * C, F * D
            rows += [
                [-lower[i, j] for j in range(n)] + [int(i == j) - inner[i, j] for j in range(p)]
                for i in range(p)
            ]
            whole = fmpq_mat(n + p, n + p, [v for row in rows for v in row]).det()
            corner = fmpq_mat(p, p, [rows[n + i][n + j] for i in range(p) for j in range(p)]).det()
            value = found(Fraction(int(fmpq(x).p), int(fmpq(x).q)))
            assert whole == corner * fmpq(value.numerator, value.denominator)


def test_a_controller_with_inputs_as_states_is_one_of_the_plant() -> None:
    """The loop is the same, in another order of its states; outputs of neighbors are used, too."""
    rng, sent = random.Random(7), 0
    for system in map(linked, all_drawn(40, seed=23)):
        filtered = input_filters(system)
        controller = controller_for(rng, filtered)
        of_plant = plant_controller(controller, system)
        sent += any(agent.shared for agent in of_plant.agents)
        ours, theirs = closed_loop(system, of_plant), closed_loop(filtered, controller)
        assert characteristic_polynomial(ours.matrix) == characteristic_polynomial(theirs.matrix)
        assert all(not agent.input.outputs for agent in of_plant.agents)
    assert sent > 10


def test_a_run_is_the_power_of_the_loop() -> None:
    plant = at_instants(SIGNED[-1])
    gains = local_controllers(input_filters(plant), [[["1/2", 0]], [["1/3", "1/5"]]])
    controller = plant_controller(gains, plant)
    run = simulate(plant, controller, horizon=4, initial=[1, 2])
    matrix = closed_loop(plant, controller).matrix
    state = Matrix.column([1, 2, 0, 0])
    for snapshot in run.snapshots:
        known = [row[0] for row in state.rows()]
        assert known == [*snapshot.plant, *(x for part in snapshot.private for x in part)]
        u = Matrix.column([x for part in snapshot.inputs for x in part])
        y = plant.output_matrix() @ Matrix.column(snapshot.plant) + plant.feedthrough_matrix() @ u
        assert [row[0] for row in y.rows()] == [x for part in snapshot.outputs for x in part]
        state = matrix @ state


def test_inputs_that_depend_on_outputs_at_once_are_certified_and_not_run() -> None:
    plant = SIGNED[-1]
    controller = local_controllers(plant, [[["1/2"]], [["1/3"]]])
    assert check(certify_controller(plant, controller), plant, controller).valid
    with pytest.raises(UsageError, match="own states"):
        simulate(plant, controller)


def test_a_designed_controller_is_certified_for_the_plant() -> None:
    plant = SIGNED[-1]
    design = design_decentralized(input_filters(plant), rate="1/2")
    controller = plant_controller(design.controller, plant)
    verdict = certify_controller(plant, controller, rate="1/2")
    assert verdict.stable and check(verdict, plant, controller).valid


def test_what_is_no_controller_of_the_plant_is_refused() -> None:
    plant = linked(at_instants(SIGNED[1]))
    filtered, one = input_filters(plant), Matrix.from_rows([[0, 1]])
    own = AgentProgram("2", 0, 0)
    reference = AgentProgram("1", 0, 0, input=LinearMap(reference=one))
    sending = AgentProgram("1", 1, 0, LinearMap({0: one}), hold={1: 1})
    using = AgentProgram("2", 0, 0, input=LinearMap({0: one}))
    for agents, message in (((reference, own), "set-points"), ((sending, using), "holds")):
        controller = Controller(plant.time, filtered.digest_of_values(), agents)
        with pytest.raises(UsageError, match=message):
            plant_controller(controller, plant)


def test_the_command_line_certifies_and_runs_it(tmp_path: Path) -> None:
    plant = SIGNED[-1]
    gains = local_controllers(input_filters(plant), [[[0, -3]], [[1, -3]]])
    names = tmp_path / "plant.json", tmp_path / "controller.json"
    mcexact.save_system(plant, names[0])
    mcexact.save_controller(plant_controller(gains, plant), names[1])
    files = [str(name) for name in names]
    status, out, _ = call("certify", *files, "--json")
    document = json.loads(out)
    assert document["certified"] == (status == 0) and "assessment" not in document
    status, _, err = call("certify", *files, "--gains", "0.01")
    assert status == 2 and "--gains" in err
    assert call("simulate", *files)[0] == 0


def test_the_command_line_designs_for_it(tmp_path: Path) -> None:
    """The controller that is written is one of the plant, and a certificate is about this loop."""
    names = tmp_path / "plant.json", tmp_path / "controller.json", tmp_path / "evidence"
    files = [str(name) for name in names]
    mcexact.save_system(SIGNED[-1], names[0])
    options = ["-o", files[1], "--certificates", files[2], "--effort", "0", "--rate", "1/10"]
    assert call("design", "decentralized", files[0], *options)[0] == 0
    controller = mcexact.load_controller(names[1])
    loop = mcexact.load_certificate(names[2] / "loop_of_plant.json")
    assert loop.about == closed_loop(SIGNED[-1], controller).system
    assert call("certify", *files[:2], "--rate", "1/10")[0] == 0
    mcexact.save_system(SIGNED[1], names[0])
    status, _, err = call("design", "decentralized", files[0])
    assert status == 1 and "the mode 0" in err
    assert call("design", "setpoint", files[0])[0] == 1  # 0 is an invariant zero
    status, _, err = call("design", "decentralized", files[0], "--box", "1%")
    assert status == 2 and "--box" in err
