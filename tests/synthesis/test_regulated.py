"""Set-point control of some outputs: what is held and what is measured, told apart."""

from __future__ import annotations

import random
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, setpoint_solvability
from mcexact.analysis.controllability import joint_controllability
from mcexact.derived.constructions import regulated_outputs, servo_system, setpoint_system
from mcexact.errors import Impossible, InputError
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix, block_diagonal, hstack, vstack
from mcexact.exact.roots import steady_point
from mcexact.model.loop import closed_loop
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.optimum.diagnosis import integrators_of
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.setpoint import (
    SetpointMethod,
    design_setpoint,
    held_together,
    selected,
)
from tests.synthesis.test_derived_systems import require_implied
from tests.synthesis.test_setpoint import require_valid
from tests.wording import refusal, says

BRIEF = Aims(effort=1)
CONTINUOUS = [[0, 1, 0, 0], [-1, 0, 1, 0], [0, 0, 0, 1], [1, 0, -1, 0]]
DISCRETE = [
    *([1, "1/4", 0, 0], ["-1/4", 1, "1/4", 0]),
    *([0, 0, 1, "1/4"], ["1/4", 0, "-1/4", 1]),
]


def carts(**options: Any) -> MultiChannelSystem:
    """Two carts and a spring: each agent pushes its cart, and measures position and velocity."""
    A = DISCRETE if options.get("time") == "discrete" else CONTINUOUS
    B = [[[0], [1], [0], [0]], [[0], [0], [0], [1]]]
    C = [[[1, 0, 0, 0], [0, 1, 0, 0]], [[0, 0, 1, 0], [0, 0, 0, 1]]]
    return MultiChannelSystem(A, B, C, names=["left", "right"], **options)


POSITIONS = {"left": [1], "right": [1]}


@pytest.mark.parametrize("method", [None, "observer", "extended"])
@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_positions_are_held_where_velocities_are_measured_too(
    time: str, method: SetpointMethod | None, tmp_path: Path
) -> None:
    plant = carts(time=time, neighbors={"left": ["right"], "right": ["left"]})
    edge: dict[str, Any] = {"rate": "1/10"} if time == "continuous" else {"radius": "99/100"}
    design = design_setpoint(
        plant, regulate=POSITIONS, method=method, arithmetic="float", aims=BRIEF, **edge
    )
    require_valid(design)
    require_implied(design.account, tmp_path)
    [step] = design.certificates["setpoint"].about.subject
    assert step["construction"] == "regulated"
    gain, S = design.loop.closed.steady_gain, Matrix.from_rows([[1, 0, 0, 0], [0, 0, 1, 0]])
    assert gain is not None and S @ gain == S
    rows = [row for row in design.account.sentences if row.template.key.startswith("design-steady")]
    assert [row.template.key for row in rows] == ["design-steady-regulated"]
    assert says(str(rows[0]), "right tends")


def test_a_simulated_loop_holds_what_is_regulated() -> None:
    plant = carts(regulated=POSITIONS)
    design = design_setpoint(plant, aims=BRIEF)
    wanted = [[3, 0], [-1, 0]]
    run = simulate(plant, design.controller, horizon=400, points=3, reference=wanted)
    last = run.values("outputs")
    reached = [float(values[-1]) for values in last.values()]
    assert reached == pytest.approx([3, 0, -1, 0], abs=1e-3)


def test_a_combination_is_held_at_that_of_the_set_points() -> None:
    plant = carts()
    S = {"left": [[2, "1/2"]], "right": [[1, 0]]}
    design = design_setpoint(plant, regulate=S, aims=BRIEF)
    require_valid(design)
    loop = closed_loop(plant, design.controller)
    held = integrators_of(loop)
    assert held is not None
    assert held.selection == (Matrix.from_rows([[2, "1/2"]]), Matrix.from_rows([[1, 0]]))
    whole = block_diagonal(held.selection)
    assert loop.steady_gain is not None and whole @ loop.steady_gain == whole
    found = assess(design)
    assert found.step_peak is not None and 1 - 1e-9 <= found.step_peak < 20
    wanted = design.parts["designed"]["optimum"].figures.cost
    assert found.figures.cost == pytest.approx(wanted, rel=1e-6)


def test_all_outputs_named_is_what_no_name_asks_for() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    first = design_setpoint(plant, rate=1, regulate={"1": [1]})
    assert first.controller == design_setpoint(plant, rate=1).controller
    assert first.certificates["setpoint"].about == plant


def test_velocities_cannot_be_held_and_the_refusal_names_what_can() -> None:
    with refusal(Impossible) as refused:
        design_setpoint(carts())
    assert not refused.value.certificate.solvable
    kept = held_together(carts())
    assert [S.numerators for S in kept] == [((1, 0),), ((1, 0),)]
    with pytest.raises(Impossible) as refused:
        design_setpoint(carts(), regulate={"left": [2]})
    assert refused.value.certificate.about.subject[0]["construction"] == "regulated"
    with refusal(InputError):
        design_setpoint(carts(), regulate={"middle": [1]})


def ring_of_tanks(m: int = 10) -> MultiChannelSystem:
    """Pump k moves water from tank k to the next one; what is in all of them decays by itself."""
    return MultiChannelSystem(
        [["-1/10" if i == j else 0 for j in range(m)] for i in range(m)],
        [[[(i == (k + 1) % m) - (i == k)] for i in range(m)] for k in range(m)],
        [[[int(i == k) for i in range(m)]] for k in range(m)],
    )


@pytest.mark.parametrize("free", range(10))
def test_nine_of_ten_levels_can_be_held_whichever_is_left_out(free: int) -> None:
    nine = {str(k + 1): [1] for k in range(10) if k != free}
    selection = [[[1]] if k != free else [] for k in range(10)]
    assert setpoint_solvability(regulated_outputs(ring_of_tanks(), selection)).solvable
    assert held_together(ring_of_tanks(), selected(ring_of_tanks(), nine)) == selected(
        ring_of_tanks(), nine
    )


@pytest.mark.slow
def test_nine_of_ten_levels_are_held_and_ten_are_refused(tmp_path: Path) -> None:
    plant = ring_of_tanks()
    with pytest.raises(Impossible, match=r"with \(1, 1, 1, 1, 1, 1, 1, 1, 1, 1\) r ≠ 0"):
        design_setpoint(plant)
    kept = held_together(plant)
    assert [S.nrows for S in kept] == [1] * 9 + [0]
    nine = {name: [1] for name, S in zip(plant.names, kept, strict=True) if S.nrows}
    design = design_setpoint(plant, regulate=nine, rate="1/20", aims=BRIEF)
    require_valid(design)
    require_implied(design.account, tmp_path)
    wanted = [[k] for k in (1, 0, -1, 2, 0, 3, 1, 1, 1, 7)]
    run = simulate(plant, design.controller, horizon=400, points=3, reference=wanted)
    reached = [float(values[-1]) for values in run.values("outputs").values()]
    assert reached == pytest.approx([1, 0, -1, 2, 0, 3, 1, 1, 1, -8], abs=1e-3)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("seed", range(40))
def test_the_most_outputs_are_chosen_and_their_set_points_have_equilibria(
    seed: int, time: str
) -> None:
    rng = random.Random(f"{time} {seed}")
    n, q = rng.randint(1, 3), [rng.randint(0, 2), rng.randint(1, 2)]

    def drawn(rows: int, columns: int) -> list[list[int]]:
        return [[rng.choice((0, 0, 0, 1, -1, 2)) for _ in range(columns)] for _ in range(rows)]

    plant = MultiChannelSystem(
        Matrix.from_rows(drawn(n, n), ncols=n),
        [Matrix.from_rows(drawn(n, 1), ncols=1) for _ in q],
        [Matrix.from_rows(drawn(k, n), ncols=n) for k in q],
        time=time,
    )
    steady = hstack([plant.A - Matrix.identity(n) * steady_point(time), plant.input_matrix()])
    full = rank(steady) == n
    outputs = plant.output_matrix()

    def together(rows: tuple[int, ...]) -> bool:
        below = hstack([outputs.take(rows=rows), Matrix.zeros(len(rows), 2)])
        return rank(vstack([steady, below])) == rank(steady) + len(rows)

    most = max(k for k in range(sum(q) + 1) if any(map(together, combinations(range(sum(q)), k))))
    kept = held_together(plant)
    assert sum(S.nrows for S in kept) == most
    answer = setpoint_solvability(regulated_outputs(plant, kept))
    assert answer.solvable == full
    reached = joint_controllability(servo_system(plant, kept)).controllable
    assert reached == (full and joint_controllability(plant).controllable)


@pytest.mark.parametrize("seed", range(20))
def test_a_servo_of_all_outputs_is_the_plant_with_integrators(seed: int) -> None:
    rng = random.Random(seed)
    system = MultiChannelSystem(
        [[rng.randint(-2, 2) for _ in range(2)] for _ in range(2)],
        [[[1], [rng.randint(-1, 1)]], [[0], [1]]],
        [[[1, rng.randint(-1, 1)]], [[0, 1]]],
    )
    whole, servo = setpoint_system(system), servo_system(system, [[[1]], [[1]]])
    assert servo.A == whole.A and servo.B == whole.B
    for i in range(2):
        assert servo.C(i).take(rows=[0]) == whole.C(i)
        assert servo.C(i).take(rows=[1]).take(cols=range(2)) == system.C(i)
