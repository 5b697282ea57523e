"""The distributed observer: prescribed spectra on the paper's example and on drawn plants."""

from fractions import Fraction

import numpy as np
import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import Expectation, check_document
from mcexact.derived.constructions import feedback
from mcexact.errors import Impossible, InputError, UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix, bit_length, largest_entry
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import controller_text, read_controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.state_feedback import spectrum_polynomial
from tests.assurance.campaigns.observer import one_design
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal, says

ELEVEN = {
    "distinct real numbers": [-k for k in range(1, 12)],
    "complex pairs": [-1, -2, -3, *({"re": -k, "im": 1} for k in range(1, 5))],
    "all equal": [-2] * 11,
}


def verdict_on(certificate):
    return check_document(encode(certificate).encode())


@pytest.mark.parametrize("q", ["1", "2", "3"])
@pytest.mark.parametrize("reason", ELEVEN)
def test_eleven_prescribed_numbers_through_each_agent(reason, q):
    error = ELEVEN[reason]
    design = design_observer(
        three_channels(), agent=q, spectrum={"feedback": [-1, -2, -3], "error": error}
    )
    assert design.parts["error_polynomial"] == spectrum_polynomial(error, 11)
    assert design.parts["channel_order"] == 2
    assert [a.private for a in design.controller.agents] == [2 * (name == q) for name in "123"]
    chi = characteristic_polynomial(design.loop.matrix)
    assert chi == Polynomial.from_roots([-1, -2, -3]) * design.parts["error_polynomial"]
    verdict = verdict_on(design.loop.proof)
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize("q", ["1", "2", "3"])
def test_the_numbers_stay_short(q):
    design = design_observer(
        three_channels(), agent=q, spectrum={"feedback": [-1, -2, -3], "error": [-2] * 11}
    )
    assert design.controller.bit_length() < 150
    assert largest_entry([design.loop.matrix]) < 10**5


@pytest.mark.parametrize("seed", range(8))
def test_drawn_plants_get_the_prescribed_polynomials(seed):
    one_design(1000 + seed)


def test_a_rate_is_certified():
    design = design_observer(three_channels(), rate="3/2")
    verdict = verdict_on(design.loop.proof)
    assert verdict.verdict == "VALID" and says(verdict.statement, "part below")


def test_a_radius_is_certified_and_met_by_deadbeat():
    design = design_observer(three_channels("discrete"), radius="1/10")
    assert design.parts["error_polynomial"] == Polynomial.of(*[0] * 11, 1)
    verdict = verdict_on(design.loop.proof)
    assert verdict.verdict == "VALID" and "has modulus below 1/10" in verdict.statement


def test_gains_from_outside_are_used_as_they_are():
    gains = [[[-1, 0, 0]], [[0, -2, -1]], [[0, 0, 0]]]
    design = design_observer(three_channels(), gains=gains, spectrum={"error": [-1] * 11})
    assert [F.numerators for F in design.parts["feedback"]] == [tuple(map(tuple, F)) for F in gains]
    assert verdict_on(design.loop.proof).verdict == "VALID"


def test_without_feedback_it_is_the_open_loop_observer():
    system = three_channels()
    zero = [Matrix.zeros(1, 3)] * 3
    design = design_observer(system, gains=zero, spectrum={"error": [-2] * 11})
    assert design.parts["feedback_polynomial"] == Polynomial.from_roots([1, 1, 1])
    assert all(not agent.input.shared for agent in design.controller.agents)
    assert verdict_on(design.loop.proof).verdict == "VALID"


@pytest.mark.parametrize(
    "options",
    [
        {"gains": [[[0, 0, 0]]] * 3, "rate": 1},
        {"spectrum": {"feedback": [-1] * 3, "error": [-3] * 11}, "rate": 2},
        {"spectrum": {"feedback": [-3] * 3, "error": [-1] * 11}, "rate": 2},
    ],
)
def test_a_spectrum_that_misses_the_rate_besides_it_is_wrong_usage(options):
    with refusal(UsageError):
        design_observer(three_channels(), **options)


def test_the_least_order_can_be_below_the_usual_one():
    graph = NeighborGraph.complete(("1", "2", "3"))
    system = three_channels().with_neighbors(graph)
    design = design_observer(system, order="least", rate=1)
    assert design.parts["channel_order"] < 2
    assert design.parts["error_polynomial"].degree == 9 + design.parts["channel_order"]
    assert verdict_on(design.loop.proof).verdict == "VALID"


def test_one_agent_alone_is_an_ordinary_observer():
    plant = MultiChannelSystem([[0, 1], [2, 1]], [[[0], [1]]], [[[1, 0]]], neighbors={"1": []})
    design = design_observer(plant, spectrum={"feedback": [-1, -1], "error": [-3, -4]})
    assert design.parts["channel_order"] == 0
    assert characteristic_polynomial(design.loop.matrix) == Polynomial.from_roots([-1, -1, -3, -4])


def test_the_controller_survives_its_file():
    design = design_observer(three_channels(), rate=1)
    assert read_controller(controller_text(design.controller)) == design.controller


def test_the_same_input_gives_the_same_bytes():
    first, second = (design_observer(three_channels(), rate=1) for _ in range(2))
    assert encode(first.loop.proof) == encode(second.loop.proof)
    assert controller_text(first.controller) == controller_text(second.controller)


def test_a_wrong_length_is_an_error_that_states_the_right_one():
    spectrum = {"feedback": [-1] * 3, "error": [-1] * 10}
    with pytest.raises(InputError, match=r"spectrum.error: expected 11 numbers"):
        design_observer(three_channels(), spectrum=spectrum)
    with pytest.raises(InputError, match=r"spectrum.feedback: expected 3 numbers"):
        design_observer(three_channels(), spectrum={"feedback": [-1], "error": [-1] * 11})


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"radius": 1}, "a radius is for discrete time"),
        ({"rate": 1, "agent": "4"}, "no channel"),
        ({"rate": 1, "order": "most"}, 'order: expected "least" or "low"'),
    ],
)
def test_arguments_that_make_no_sense_are_wrong_usage(options, message):
    with pytest.raises(UsageError, match=message):
        design_observer(three_channels(), **options)


@pytest.mark.parametrize("spectrum", [{"error": [-1] * 11}, {"feedback": [-1] * 3}, [-1] * 14])
def test_a_spectrum_has_both_parts(spectrum):
    with pytest.raises(InputError, match="spectrum"):
        design_observer(three_channels(), spectrum=spectrum)


def test_delays_are_for_another_design():
    graph = NeighborGraph(("1", "2", "3"), [[1], [2], [0]], [(0, 1, 1)])
    with pytest.raises(UsageError, match="no delays"):
        design_observer(three_channels("discrete"), graph, radius=1)


@pytest.mark.parametrize("arithmetic", ["exact", "float"])
def test_a_derived_system_is_designed_for_like_a_plant(arithmetic):
    plant = three_channels()
    loose = feedback(plant, [[[0, 1]], [[1]], [[1]]])
    design = design_observer(loose, rate=1, arithmetic=arithmetic)
    certificate = design.loop.proof
    assert [each["construction"] for each in certificate.subject] == ["feedback", "closed_loop"]
    verdict = check_document(encode(certificate).encode(), Expectation(system=plant.digest()))
    assert verdict.verdict == "VALID", verdict.line()


def test_an_uncontrollable_mode_refuses_with_its_certificate():
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [0]]] * 2, [[[1, 1]], [[1, 1]]], neighbors={"1": ["2"], "2": ["1"]}
    )
    with pytest.raises(Impossible, match="not jointly controllable") as caught:
        design_observer(plant, rate=1)
    assert verdict_on(caught.value.certificate).verdict == "VALID"


def test_an_unobservable_mode_refuses_with_its_certificate():
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [1]]] * 2, [[[1, 0]]] * 2, neighbors={"1": ["2"], "2": ["1"]}
    )
    with refusal(Impossible) as caught:
        design_observer(plant, rate=1)
    verdict = verdict_on(caught.value.certificate)
    assert verdict.verdict == "VALID" and "dual" in verdict.statement


def test_the_obstruction_is_that_of_the_error_system():
    plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": [], "2": []})
    with pytest.raises(Impossible, match="error system") as caught:
        design_observer(plant, rate=1)
    assert caught.value.certificate.subject[-1]["construction"] == "error"
    assert verdict_on(caught.value.certificate).verdict == "VALID"


def test_strong_connectivity_is_sufficient_but_not_necessary():
    # The terms B_j F_j (e_i − e_j) couple the errors through the plant.
    plant = MultiChannelSystem([[0]], [[[1]]] * 2, [[[1]]] * 2, neighbors={"1": [], "2": []})
    design = design_observer(plant, gains=[[[-1]], [[-1]]], spectrum={"error": [-1, -2, -3]})
    assert verdict_on(design.loop.proof).verdict == "VALID"
    assert design.controller.edges() == ()


def test_no_states_leave_the_channel_controller_alone():
    system = MultiChannelSystem(
        Matrix.zeros(0, 0),
        [Matrix.zeros(0, 1)] * 2,
        [Matrix.zeros(1, 0)] * 2,
        neighbors={"1": ["2"], "2": ["1"]},
    )
    design = design_observer(system, rate=1)
    assert design.loop.matrix.nrows == design.controller.order
    assert verdict_on(design.loop.proof).verdict == "VALID"


def test_progress_is_told():
    told = []
    design_observer(three_channels(), rate=1, progress=told.append)
    assert told[0] == "state feedback" and told[-1] == "certificate"


def test_the_bit_length_is_that_of_the_controller():
    design = design_observer(three_channels(), rate=1)
    entries = [
        M for agent in design.controller.agents for each in agent.maps() for M in each.matrices()
    ]
    assert design.controller.bit_length() == bit_length(entries)


def test_gains_of_floats_need_a_named_rounding() -> None:
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]], neighbors={"1": []})
    gains = [np.array([[-0.1]])]
    with pytest.raises(InputError, match="float"):
        design_observer(plant, rate=1, gains=gains)
    found = design_observer(plant, gains=[[[-3.1]]], rounding="decimal", spectrum={"error": [-2]})
    assert found.parts["feedback"][0].rows() == ((Fraction(-31, 10),),)
