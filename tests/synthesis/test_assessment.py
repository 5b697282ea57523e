"""Whether to install a controller: figures of any loop, and what to beware of."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from mcexact.errors import InputError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.controller import read_controller
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import Assessment, assess, assessed_loop
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.optimum.diagnosis import (
    curves_of,
    digits_that_suffice,
    figures_of_loop,
    integrators_of,
    least_disk_margin,
    rounded_controller,
)
from mcexact.synthesis.optimum.figures import THEOREM, Aims, Figures
from mcexact.synthesis.optimum.problem import Weights
from mcexact.synthesis.setpoint import design_setpoint
from tests.synthesis.optimum.plants import coupled, delayed
from tests.synthesis.test_setpoint import two_tanks
from tests.wording import says, worded

ONE = MultiChannelSystem([[1]], [[[1]]], [[[1]]])


def loop_of(gain: str) -> ClosedLoop:
    return closed_loop(ONE, local_controllers(ONE, [[[gain]]]))


@pytest.mark.parametrize(
    ("design", "time", "options"),
    [
        (design_decentralized, "continuous", {"rate": "1/2"}),
        (design_decentralized, "discrete", {"radius": "1/2"}),
        (design_extended, "discrete", {"radius": "0.6", "share": "states"}),
    ],
)
def test_the_figures_of_a_loop_are_those_of_the_search(design, time, options) -> None:
    made = design(coupled(time), aims=Aims(effort=2), **options)
    searched = made.parts["optimum"].figures
    found = figures_of_loop(made.loop.closed, Weights.unit(made.loop.closed.plant))
    for name in ("order", "largest_gain", "bound", "peak", "cost"):
        assert getattr(found, name) == pytest.approx(getattr(searched, name), rel=1e-6), name
    # The margin is that of a grid, which is not the same one.
    assert found.margin == pytest.approx(searched.margin, rel=0.05)


def test_the_cost_over_delays_is_that_of_a_simulation() -> None:
    plant = delayed()
    made = design_extended(plant, radius="0.8", network="lifted", aims=Aims(effort=2))
    loop = made.loop.closed
    found = figures_of_loop(loop, Weights.unit(plant))
    # E[x'Qx + u'Ru] as a sum over the responses to noise, one noise at a time, message by message.
    n, total = plant.n, 0.0
    for k in range(n + sum(plant.q(i) for i in range(plant.m))):
        total += _power_of(loop, k)
    assert found.cost == pytest.approx(total, rel=1e-6)


def _power_of(loop: ClosedLoop, k: int) -> float:
    """Σ_t x'x + u'u after an impulse of noise k at time 0, by the programs of the agents."""
    from mcexact.exact.matrix import matrix_to_float

    plant, agents = loop.plant, loop.controller.agents
    A = matrix_to_float(plant.A)
    B = [matrix_to_float(plant.B(i)) for i in range(plant.m)]
    C = [matrix_to_float(plant.C(i)) for i in range(plant.m)]
    starts = np.cumsum([0, *(plant.q(i) for i in range(plant.m))])
    x, outputs, shared = np.zeros(plant.n), [], []
    if k < plant.n:
        x[k] = 1.0
    states = [(np.zeros(a.shared), np.zeros(a.private)) for a in agents]
    total = 0.0
    for t in range(400):
        y = [c @ x for c in C]
        if t == 0 and k >= plant.n:
            noise = np.zeros(int(starts[-1]))
            noise[k - plant.n] = 0.1
            y = [y[i] + noise[starts[i] : starts[i + 1]] for i in range(plant.m)]
        outputs.append(y)
        shared.append([s for s, _ in states])

        def value(each, i, size, t=t, states=states):
            found = np.zeros(size)
            for j, M in each.outputs.items():
                age = loop.waits(j, i)[1]
                found += matrix_to_float(M) @ outputs[t - age][j] if age <= t else 0.0
            for j, M in each.shared.items():
                age = loop.waits(j, i)[0]
                found += matrix_to_float(M) @ shared[t - age][j] if age <= t else 0.0
            if each.private is not None:
                found += matrix_to_float(each.private) @ states[i][1]
            return found

        u = [value(a.input, i, plant.p(i)) for i, a in enumerate(agents)]
        total += float(x @ x) + sum(float(v @ v) for v in u)
        states = [
            (value(a.shared_update, i, a.shared), value(a.private_update, i, a.private))
            for i, a in enumerate(agents)
        ]
        x = A @ x + sum((b @ v for b, v in zip(B, u, strict=True)), np.zeros(plant.n))
    return total


@pytest.mark.parametrize(
    ("gain", "rate", "digits"), [("-3", "1", 1), ("-1.26", "1/4", 2), ("-10/3", "2.333", 5)]
)
def test_the_digits_that_suffice_keep_the_region_and_one_less_does_not(gain, rate, digits) -> None:
    region = StabilityRegion.of("continuous", rate=rate)
    loop = loop_of(gain)
    assert digits_that_suffice(loop, region) == digits
    made = closed_loop(ONE, rounded_controller(loop.controller, digits))
    assert made.matrix[0, 0] < region.limit


def test_the_digits_that_suffice_leave_a_robust_loop_robust() -> None:
    """The gain −12.6 has the disk margin 0.45, and −10 is stable with 0.22."""
    region = StabilityRegion("continuous")
    plant = MultiChannelSystem([[8]], [[[1]]], [[[1]]])
    loop = closed_loop(plant, local_controllers(plant, [[["-12.6"]]]))
    assert least_disk_margin(closed_loop(plant, rounded_controller(loop.controller, 1))) < 0.3
    assert digits_that_suffice(loop, region) == 2
    assert assessed_loop(loop, region, certified=True).digits == 2
    # A fragile loop keeps most of what it has: −1.3 is enough for −1.31.
    assert assessed_loop(loop_of("-1.31"), region, certified=True).digits == 2


def test_a_loop_that_no_rounding_keeps_has_no_digits() -> None:
    region = StabilityRegion.of("continuous", rate="1/3")
    loop = closed_loop(ONE, local_controllers(ONE, [[["-4/3"]]]))
    assert digits_that_suffice(loop, region) is None


def test_integrators_are_recognized_and_assessed_with_the_plant(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = design_setpoint(two_tanks(), rate="1/2", aims=Aims(effort=2))
    loop = made.loop.closed
    held = integrators_of(loop)
    assert held is not None and len(held.places) == 2 and min(held.places) >= 2
    found = assess(made)
    assert found.step_peak is not None and 1 - 1e-9 <= found.step_peak < 5
    assert found.figures.cost == pytest.approx(
        made.parts["designed"]["optimum"].figures.cost, rel=1e-6
    )
    # The peak is that of the plant's state alone, and not compared.
    assert found.figures.peak < made.parts["designed"]["optimum"].figures.peak
    assert "one controller" not in dict(found.rows())["peak of the state"]
    peaked = replace(found, step_peak=1.5, figures=replace(found.figures, peak=99.0))
    assert peaked.install == "yes"
    monkeypatch.setattr(Assessment, "relative_cost", 1e3)
    assert peaked.install == "yes" and replace(peaked, step_peak=None).install == "with care"
    overshot = replace(found, step_peak=2.5)
    assert overshot.install == "with care"
    assert any("reaches 2.5 after a unit step" in each for each in overshot.warnings)
    assert integrators_of(loop_of("-3")) is None


@pytest.mark.parametrize(
    "update",
    [
        {"private": [[-1]]},  # a filter of the error
        {"private": [["1/2"]]},
        {"reference": [[-2]]},
        {"outputs": {"1": [[0]]}, "reference": [[0]]},
    ],
)
def test_a_state_that_something_else_moves_is_no_integrator(update: dict[str, Any]) -> None:
    integrating = {"outputs": {"1": [[1]]}, "reference": [[-1]]}
    agent: dict[str, Any] = {"name": "1", "shared": 0, "private": 1, "shared_update": {}}
    agent["input"] = {"outputs": {"1": [[-3]]}, "private": [[-1]]}
    for change, count in (({}, 1), (update, 0)):
        agent["private_update"] = integrating | change
        document = {"format": "mcexact-controller/1", "system": "", "time": "continuous"}
        text = json.dumps(document | {"agents": [agent]})
        found = integrators_of(closed_loop(ONE, read_controller(text)))
        assert (0 if found is None else len(found.places)) == count


def assessed(gain: str = "-3", **figures: Any) -> Assessment:
    """An assessment, some of whose figures are others."""
    region = StabilityRegion.of("continuous", rate="1/2")
    found = assessed_loop(loop_of(gain), region, certified=True)
    return replace(found, figures=replace(found.figures, **figures))


def with_seen(found: Assessment, **computed: float) -> Assessment:
    """The same, with other computed figures of its performance."""
    known = found.performance
    assert known is not None
    return replace(found, performance=replace(known, computed={**known.computed, **computed}))


def test_a_good_controller_is_worth_installing() -> None:
    found = assessed()
    assert (found.install, found.warnings) == ("yes", ())
    assert says(found.verdict, "worth installing") and "2.33" in found.verdict
    assert found.first_line() == "Worth installing"


@pytest.mark.parametrize(
    ("changes", "install", "said"),
    [
        ({"input_margin": 0.09}, "no", "the disk margin of the input of agent 1 is 0.09"),
        ({"output_margin": 0.39}, "with care", "the disk margin of the input of agent 1 is 0.39"),
        ({"all_inputs_margin": 0.19}, "with care", "together is 0.19"),
        ({"all_outputs_margin": 0.19}, "with care", "together is 0.19"),
        ({"cost_bound": 2.3}, "with care", "its cost is 3.02 times a bound"),
        ({"damping": 0.049}, "with care", "the least damping ratio is 0.049"),
        ({"margin": 0.0}, "no", "not even stable"),
        ({"fails_within": Fraction(1, 10**5)}, "no", "a plant within 0.001 % of each entry"),
        ({"fails_within": Fraction(9, 1000)}, "with care", "a plant within 0.9 % of each entry"),
        ({"digits": 5}, "with care", "need 5 digits"),
        ({"digits": None}, "with care", "the programs lose"),
    ],
)
def test_what_a_person_would_not_install_is_heard(
    changes: dict[str, Any], install: str, said: str
) -> None:
    found = assessed()
    parts = {name: changes[name] for name in ("fails_within", "digits") if name in changes}
    figures = {name: changes[name] for name in ("damping", "margin") if name in changes}
    found = replace(found, figures=replace(found.figures, **figures), **parts)
    seen = {name: x for name, x in changes.items() if name not in {*parts, *figures}}
    found = with_seen(found, **seen)
    assert found.install == install
    assert said in found.verdict and said in found.warnings[0]
    told = {"no": "Do not install: ", "with care": "Install with care: "}
    assert found.verdict.startswith(told[install])
    assert told[install].rstrip(": ") in found.first_line(["cost ≤ 2"])


@pytest.mark.parametrize("figures", [{"peak": 1e9}, {"largest_gain": 1e9}, {"cost": 1e9}])
def test_figures_that_depend_on_units_decide_nothing(figures: dict[str, Any]) -> None:
    assert assessed(**figures).install == "yes"


def test_a_plant_that_fails_beyond_one_percent_is_no_warning() -> None:
    assert replace(assessed(), fails_within=Fraction(1, 100)).install == "yes"


def test_a_loop_slower_than_the_open_loop_is_heard() -> None:
    plant = MultiChannelSystem([[-2]], [[[1]]], [[[1]]])
    loop = closed_loop(plant, local_controllers(plant, [[[1]]]))
    found = assessed_loop(loop, StabilityRegion("continuous"), certified=True)
    assert found.install == "with care"
    text = "the slowest eigenvalue has Re λ = -1, and -2 without the controller"
    assert found.warnings[0] == text
    sampled = MultiChannelSystem([["1/4"]], [[[1]]], [[[1]]], time="discrete")
    loop = closed_loop(sampled, local_controllers(sampled, [[["1/4"]]]))
    found = assessed_loop(loop, StabilityRegion("discrete"), certified=True)
    assert "and 0.25 without the controller" in found.warnings[0]


def test_the_first_line_has_what_is_proved_and_fits() -> None:
    proved = ["cost ≤ 1.22 × any LTI controller's", "disk margin ≥ 0.4 at each input and output"]
    proved.append("stable within 0.13 % of each entry")
    found = replace(assessed(), fails_within=Fraction(1, 500))
    line = found.first_line(proved)
    assert line == (f"Proved: {', '.join(proved)}. Install with care: fails within 0.2 %")
    assert found.first_line() == f"Install with care: {found.warnings[0]}"
    for more in range(120):
        line = found.first_line([*proved, "x" * more])
        assert len(line) <= 172 or line.endswith("x. Install with care")
    refused = assessed_loop(loop_of("1"), StabilityRegion("continuous"), certified=False)
    assert worded(refused.first_line(proved))


def test_a_verdict_that_no_certificate_proves_says_so() -> None:
    for found in (assessed(), with_seen(assessed(), input_margin=0.05)):
        assert found.verdict.endswith(" (computed)")
    refused = assessed_loop(loop_of("1"), StabilityRegion("continuous"), certified=False)
    assert "computed" not in refused.verdict


def test_agents_with_as_many_states_are_told_together() -> None:
    found = replace(assessed(), orders={"a": 2, "b": 2, "c": 2})
    assert dict(found.rows())["states of each agent"] == "2, alike for all 3"
    found = replace(found, orders={"a": 2, "b": 0})
    assert dict(found.rows())["states of each agent"] == "a: 2, b: 0"


def test_the_cost_is_compared_with_a_bound_of_the_same_weights() -> None:
    rows = dict(with_seen(assessed(), loop_cost=3.0, cost_bound=2.0).rows())
    assert rows["cost relative to the bound"] == "1.5"
    assert rows["least disk margin"] == "1 (input of agent 1)"


def test_costs_with_weights_that_are_not_diagonal_are_not_compared() -> None:
    plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [1]]], [[[1, 0]]])
    loop = closed_loop(plant, local_controllers(plant, [[["-1"]]]))
    weights = {"Q": [[2, 1], [1, 2]]}
    found = assessed_loop(loop, StabilityRegion("continuous"), certified=True, weights=weights)
    assert np.isnan(found.relative_cost) and found.install == "yes"
    assert "not known" not in found.verdict and "disk margin" in found.verdict
    assert found.performance is not None and found.performance.least_margin > 0.4


def test_digits_are_told_of_rates_that_hold_alone() -> None:
    assert "digits that suffice" in dict(assessed().rows())
    region = StabilityRegion.of("continuous", rate=10)
    found = assessed_loop(loop_of("-3"), region, certified=False)
    assert "digits that suffice" not in dict(found.rows())


def test_only_in_discrete_time_numbers_are_sent_at_each_step() -> None:
    assert dict(assessed().rows())["numbers sent"] == "none"
    sampled = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    loop = closed_loop(sampled, local_controllers(sampled, [[["-1/4"]]]))
    found = assessed_loop(loop, StabilityRegion("discrete"), certified=True)
    assert dict(found.rows())["numbers sent at each step"] == "none"


def test_an_unstable_loop_is_not_to_be_installed() -> None:
    region = StabilityRegion("continuous")
    found = assessed_loop(loop_of("1"), region, certified=False)
    assert found.install == "no" and "does not satisfy" in found.verdict
    assert len(found.warnings) == 1
    rows = dict(found.rows())
    assert says(rows["peak of the state"], "one controller")
    assert rows["cost relative to the bound"] == "not known"
    assert rows["fastest eigenvalue"] == "|λ| = 2"
    assert found.to_dict()["margin"] == 0 and found.to_dict()["cost"] is None
    json.dumps(found.to_dict(), allow_nan=False)
    assert curves_of(loop_of("1"), region) is None


def test_a_controller_that_hardly_helps_is_told() -> None:
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    region = StabilityRegion("continuous", Fraction(1, 2))
    loop = closed_loop(plant, local_controllers(plant, [[["-0.001"]]]))
    found = assessed_loop(loop, region, certified=True)
    assert found.uncontrolled is not None and found.uncontrolled.bound == -1
    assert "it satisfies Re λ < -1/2, too" in found.notes[-1]
    assert dict(found.rows())["without a controller"] == "Re λ = -1, cost 0.5"
    faster = assessed_loop(loop, StabilityRegion("continuous", Fraction(1)), certified=True)
    assert says(faster.notes[-1], "satisfy")


def test_an_unstable_plant_has_no_cost_without_a_controller() -> None:
    found = assessed()
    assert dict(found.rows())["without a controller"] == "Re λ = 1, not stable"
    assert found.to_dict()["without_a_controller"]["cost"] is None and not found.notes


def test_the_controller_of_the_theorem_comes_with_its_figures() -> None:
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    found = assess(design_decentralized(plant, rate=20, aims=THEOREM))
    assert found.install != "yes"
    assert found.figures.largest_gain > 1000


def test_links_carry_what_their_receiver_uses() -> None:
    made = design_extended(coupled(), rate="1/2", dimensions=[1, 0, 1], aims=Aims(effort=2))
    found = assess(made)
    used = {(link.sender, link.receiver) for link in found.links}
    names = made.controller.agents
    assert used == {(names[j].name, names[i].name) for j, i in made.controller.edges()}
    assert all(link.numbers >= 1 for link in found.links)


def test_the_weights_are_those_that_were_asked_for() -> None:
    region = StabilityRegion.of("continuous", rate="1/2")
    cheap = assessed_loop(loop_of("-3"), region, certified=True, weights={"R": [["1/100"]]})
    plain = assessed_loop(loop_of("-3"), region, certified=True)
    assert cheap.figures.cost < plain.figures.cost
    with pytest.raises(InputError, match=r"weights\.R: expected a 1 × 1 matrix, found 2 × 2"):
        assessed_loop(loop_of("-3"), region, certified=True, weights={"R": [[1, 0], [0, 1]]})


def test_only_designs_are_assessed() -> None:
    with pytest.raises(InputError, match="design: expected a Design"):
        assess(3)  # type: ignore[arg-type]
    assert isinstance(assessed().figures, Figures)


def test_an_observer_tells_what_it_is_for_and_what_tries_lower_orders() -> None:
    plant = MultiChannelSystem(
        [[1, 1], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )  # fmt: skip
    told = assess(design_observer(plant, rate=1, arithmetic="float"))
    assert says(told.notes, "order tries")
    searched = assess(design_extended(plant, rate=1))
    assert not any("tries controllers" in each for each in searched.notes)


def test_a_plant_within_the_given_radii_that_fails_forbids_the_controller() -> None:
    found = assessed_loop(loop_of("-3"), StabilityRegion("continuous"), certified=True)
    assert found.install == "yes"
    assert replace(found, within_radii="proved").verdict == found.verdict
    refuted, left = (replace(found, within_radii=each) for each in ("refuted", "open"))
    assert refuted.install == "no" and says(refuted.verdict, "whose stable")
    assert left.install == "with care" and "is not proved" in left.verdict
    # Both are exact: nothing is computed in floating point.
    assert "(computed)" not in refuted.verdict + left.verdict
    # What is known of all loops is asked of a design; without it nothing is proved of them.
    near = design_decentralized(Box.absolute(ONE, A=[["1/4"]]).system, rate="1/2")
    assert assess(near).install == "with care"
    assert assess(near, every_loop=near.every_loop()).install == "yes"
    unstable = assessed_loop(loop_of("-1/2"), StabilityRegion("continuous"), certified=False)
    assert replace(unstable, within_radii="open").warnings == unstable.warnings


def test_figures_say_what_they_are() -> None:
    rows = dict(assessed_loop(loop_of("-3"), StabilityRegion("continuous"), certified=True).rows())
    assert says(rows["digits that suffice"], "number nearest")
    assert says(rows["sensible rate"], "largest margin") and "0.3" in rows["sensible rate"]
    assert says(rows["sensible rate"], "times cost")
