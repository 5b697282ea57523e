"""With typical sizes, what is shown of a loop and what is designed do not depend on units."""

from __future__ import annotations

import random
import re
from fractions import Fraction
from pathlib import Path

import pytest

from mcexact.analysis.in_units import cost_bound, disk_margin, loop_cost, sector_stability
from mcexact.analysis.performance import influences
from mcexact.answer.check import check
from mcexact.model import gallery
from mcexact.model.controller import Controller, save_controller
from mcexact.model.files import save_system
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import Units, controller_in, system_in
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.performance import performance_of
from mcexact.synthesis.setpoint import design_setpoint
from tests.end_to_end.command_line import run
from tests.synthesis.test_setpoint import two_tanks
from tests.wording import says


def drawn_sizes(rng: random.Random, plant: MultiChannelSystem) -> TypicalSizes:
    def draw(count: int) -> list[Fraction]:
        return [Fraction(rng.randint(3, 3000), 100) for _ in range(count)]

    return TypicalSizes(
        draw(plant.n),
        [draw(plant.p(i)) for i in range(plant.m)],
        [draw(plant.q(i)) for i in range(plant.m)],
        Fraction(1, 2),
    )


def drawn_units(rng: random.Random, plant: MultiChannelSystem) -> Units:
    def draw(count: int) -> tuple[Fraction, ...]:
        return tuple(Fraction(10) ** rng.randint(-6, 6) for _ in range(count))

    return Units(
        draw(plant.n),
        tuple(draw(plant.p(i)) for i in range(plant.m)),
        tuple(draw(plant.q(i)) for i in range(plant.m)),
    )


def measured(
    units: Units, plant: MultiChannelSystem, controller: Controller
) -> tuple[MultiChannelSystem, Controller]:
    """The plant and its controller as a file in other units has them."""
    other = system_in(units, plant)
    return other, controller_in(units, controller, other.digest_of_values())


PLANTS = [
    "farina-three-rooms",
    "compleib-dis5",
    *(
        pytest.param(name, marks=pytest.mark.slow)
        for name in ("quadruple-tank-pplus", "compleib-dis2", "compleib-dis3", "compleib-psm")
    ),
]


@pytest.mark.parametrize("name", PLANTS)
def test_certify_prints_the_same_in_all_units(name: str, tmp_path: Path) -> None:
    """All but the weights, which are in the units of the file."""
    rng = random.Random(name)
    plant = gallery.load(name)
    plant = plant.with_typical_sizes(drawn_sizes(rng, plant))
    design = design_decentralized(plant)
    shown = set[str]()
    for k in range(3):
        units = drawn_units(rng, plant)
        about, controller = measured(units, plant, design.controller) if k else (
            plant, design.controller
        )  # fmt: skip
        save_system(about, tmp_path / "plant.json")
        save_controller(controller, tmp_path / "controller.json")
        done = run("certify", str(tmp_path / "plant.json"), str(tmp_path / "controller.json"))
        assert done.status == 0, done.stderr
        text = " ".join(done.stdout.split())
        shown.add(re.sub(r"the mean of x'Qx .*? (?=cost|disk margin)", "", text))
    assert len(shown) == 1, "\n=====\n".join(shown)


@pytest.mark.parametrize("name", PLANTS)
def test_a_design_is_the_same_in_all_units(name: str) -> None:
    rng = random.Random(f"design {name}")
    plant = gallery.load(name)
    plant = plant.with_typical_sizes(drawn_sizes(rng, plant))
    first = design_decentralized(plant)
    units = drawn_units(rng, plant)
    about, controller = measured(units, plant, first.controller)
    second = design_decentralized(about)
    assert second.controller == controller
    ratios = [performance_of(each.loop.closed).ratio for each in (first, second)]
    assert ratios[0] is not None and ratios[0] == ratios[1]


def test_a_set_point_design_is_the_same_in_all_units() -> None:
    rng = random.Random(5)
    plant = two_tanks()
    plant = plant.with_typical_sizes(drawn_sizes(rng, plant))
    first = design_setpoint(plant)
    units = drawn_units(rng, plant)
    # integrators keep the units of their outputs
    other = system_in(units, plant)
    second = design_setpoint(other)
    moved = controller_in(units, first.controller, other.digest_of_values(), units.outputs)
    assert second.controller == moved


def test_proofs_in_units_near_the_sizes_are_about_the_plant_of_the_file() -> None:
    rng = random.Random(7)
    for name in ("compleib-dis5", "farina-string-of-vehicles-4", "quadruple-tank-pplus"):
        plain = gallery.load(name)
        controller = design_decentralized(plain, aims=Aims(effort=1)).controller
        plant = plain.with_typical_sizes(drawn_sizes(rng, plain))
        for k in range(2):
            about, program = (
                measured(drawn_units(rng, plant), plant, controller) if k else (plant, controller)
            )
            assert Units.of(about) is not None
            graph = influences(about, messages=False)
            sectors = [("9/10", "11/10")] * sum(map(about.p, range(about.m)))
            answers = [
                loop_cost(about, program),
                cost_bound(about),
                cost_bound(about, graph=graph),
                disk_margin(about, program, "inputs"),
                disk_margin(about, program, "outputs", together=True),
                sector_stability(about, program, sectors),
            ]
            for answer in answers:
                assert answer.about.plant.digest() == about.digest()
                assert check(answer, about).verdict == "VALID"


def test_a_file_of_sizes_replaces_those_of_the_plant(tmp_path: Path) -> None:
    plant, sizes = tmp_path / "plant.json", tmp_path / "sizes.json"
    save_system(gallery.load("farina-three-rooms"), plant)
    sizes.write_text('{"states": [2, 2, "1/5"]}')
    made = run("design", "decentralized", str(plant), "-o", str(tmp_path / "c.json"))
    assert says(" ".join(made.stdout.split()), "units file")
    controller = str(tmp_path / "c.json")
    plain = run("certify", str(plant), controller)
    sized = run("certify", str(plant), controller, "--sizes", str(sizes))
    assert sized.status == 0 and sized.stdout != plain.stdout
    assert says(" ".join(sized.stdout.split()), "typical sizes")
    options = ("--sizes", str(sizes), "-o", str(tmp_path / "d.json"))
    other = run("design", "decentralized", str(plant), *options)
    assert other.status == 0 and says(" ".join(other.stdout.split()), "typical sizes 2")
    sizes.write_text('{"states": [2, 2]}')
    refused = run("certify", str(plant), controller, "--sizes", str(sizes))
    assert refused.status == 3 and "sizes: states: expected 3 sizes, found 2" in refused.stderr
