"""Control without any message."""

from __future__ import annotations

import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import any_system
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.design import Design
from mcexact.synthesis.optimum.figures import THEOREM
from tests.synthesis.three_channels import three_channels
from tests.wording import says


def require_valid(design: Design) -> None:
    for name, made in design.certificates.items():
        verdict = check_document(encode(made).encode())
        assert verdict.verdict == "VALID", f"{name}: {verdict.line()}"


@pytest.mark.parametrize("arithmetic", ["exact", "float"])
@pytest.mark.parametrize(
    "case", ["farina-three-rooms", "quadruple-tank-pminus", "quadruple-tank-pplus"]
)
def test_published_plants_get_a_controller_without_messages(case: str, arithmetic: str) -> None:
    plant = gallery.load(case)
    design = design_decentralized(plant, rate="1/100", arithmetic=arithmetic)  # type: ignore[arg-type]
    assert not design.controller.edges()
    assert all(agent.shared == 0 for agent in design.controller.agents)
    assert "stability" in design.certificates
    assert design.certificates["stability"].claim()["stable"]
    require_valid(design)


def test_the_papers_example_is_refused_with_mode_1() -> None:
    with pytest.raises(Impossible, match="moves the mode 1") as refusal:
        design_decentralized(three_channels(), rate=1)
    certificate = refusal.value.certificate
    assert certificate.kind == "fixed_spectrum"
    assert certificate.polynomial == Polynomial.from_roots([1])
    assert check_document(encode(certificate).encode()).verdict == "VALID"


def test_a_prescribed_spectrum_is_met_exactly() -> None:
    plant = gallery.load("farina-three-rooms")
    wanted = ["-1", "-2", "-3", {"re": "-1", "im": "1"}]
    design = design_decentralized(plant, spectrum={"closed_loop": wanted})
    loop = characteristic_polynomial(closed_loop(plant, design.controller).matrix)
    assert loop == Polynomial.from_roots([-1, -2, -3]) * Polynomial.of(2, 2, 1)


def test_one_channel_is_output_feedback() -> None:
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]], time="discrete")
    design = design_decentralized(plant, radius="1/2", aims=THEOREM)
    assert (design.order, design.parts["observer_order"]) == (1, 2)


def test_no_states_and_inactive_channels_need_nothing() -> None:
    empty = MultiChannelSystem([], [[]], [[]])
    assert design_decentralized(empty, rate=1).order == 0
    inactive = MultiChannelSystem([[-3]], [[[0]], [[1]]], [[[1]], [[0]]])
    design = design_decentralized(inactive, rate=1)
    assert (design.order, design.parts["kept"]) == (0, Polynomial.from_roots([-3]))


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("seed", range(20))
def test_what_no_fixed_mode_forbids_is_done(seed: int, time: str) -> None:
    drawn = any_system(SeededChoices(f"decentralized {seed}"), 4, 3, time=time).system
    bound = {"rate": 1} if time == "continuous" else {"radius": "1/2"}
    try:
        design = design_decentralized(drawn, **bound)
    except Impossible as refusal:
        assert refusal.certificate.kind == "fixed_spectrum"
        assert check_document(encode(refusal.certificate).encode()).verdict == "VALID"
        return
    require_valid(design)
    assert "stability" in design.certificates
    region: StabilityRegion = design.region
    loop = closed_loop(drawn, design.controller).matrix
    assert region.contains_roots_of(characteristic_polynomial(loop))
    assert not design.controller.edges()


@pytest.mark.parametrize(
    ("time", "unstable"), [("continuous", 1), ("continuous", 0), ("discrete", 2)]
)
def test_a_prescribed_root_that_is_not_stable_is_placed_and_the_loop_is_said_to_be_unstable(
    time: str, unstable: int
) -> None:
    plant = MultiChannelSystem([[0, 1], [2, 0]], [[[0], [1]]], [[[1, 0]]], time=time)
    design = design_decentralized(plant, spectrum=["-1/2", "-1/2", unstable])
    require_valid(design)
    assert characteristic_polynomial(design.loop.matrix)(unstable) == 0
    assert not design.stable and not design.certificates["stability"].claim()["stable"]
    assert says(repr(design), "certified unstable")
    assert says(design.explain(), "eigenvalues satisfies")
    assert says(assess(design).verdict, "install satisfy")


def test_a_prescribed_stable_spectrum_is_not_said_to_be_unstable() -> None:
    plant = MultiChannelSystem([[0, 1], [2, 0]], [[[0], [1]]], [[[1, 0]]])
    design = design_decentralized(plant, spectrum=["-1+2i", -1])
    assert design.stable and "stability" not in design.certificates
    assert "not every one" not in design.explain()
