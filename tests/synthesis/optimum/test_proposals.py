"""The ladder finds controllers of low order, and the gate certifies them."""

from dataclasses import replace

import numpy as np
import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import Share
from mcexact.errors import Impossible, LimitReached
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.gate import Request
from mcexact.synthesis.network_design import network_design
from mcexact.synthesis.networks import decentralized_network, sharing_network
from mcexact.synthesis.optimum import proposals
from mcexact.synthesis.optimum.descent import (
    SLACK,
    Target,
    bound_of,
    controllers_of_parts,
    inside,
    polished,
)
from mcexact.synthesis.optimum.figures import (
    MARGINS,
    Aims,
    Limits,
    Margins,
    Peaks,
    figures_of,
)
from mcexact.synthesis.optimum.problem import PER_SECOND, Effort, FeedbackProblem, Weights
from mcexact.synthesis.optimum.proposals import (
    Family,
    optimum,
    searched_proposals,
    with_few_digits,
)
from mcexact.synthesis.optimum.search import Candidate
from mcexact.synthesis.optimum.starts import (
    local_regulators,
    localities,
    regulator,
    with_private_parts,
)
from tests.synthesis.optimum.plants import coupled, delayed
from tests.wording import refusal


def request(plant: MultiChannelSystem, bound: str, told=None) -> Request:
    name = "rate" if plant.time == "continuous" else "radius"
    return Request.of(plant, arithmetic="float", progress=told, **{name: bound})


def searched(method, family: Family, asked: Request):
    return network_design(method, family.network, asked, searched_proposals(family, asked))


def design(plant: MultiChannelSystem, bound: str, share: Share | None = None, kind=None):
    asked = request(plant, bound)
    if share is None:
        family = Family(decentralized_network(plant))
        return searched("decentralized", family, asked)
    network, _ = sharing_network(plant, None, asked, share=share, network=kind)
    return searched("extended", Family(network, share), asked)


@pytest.mark.parametrize(
    ("plant", "bound", "share", "kind"),
    [
        (coupled(), "1/2", None, None),
        (coupled(), "1/2", "outputs+states", None),
        (coupled("discrete"), "1/2", None, None),
        (coupled("discrete"), "0.6", "states", None),
        (delayed(), "0.8", "outputs+states", "lifted"),
        (delayed(), "0.8", "states", "held"),
    ],
)
def test_a_design_is_certified_and_worth_installing(plant, bound, share, kind):
    made = design(plant, bound, share, kind)
    for each in made.certificates.values():
        verdict = check_document(encode(each).encode())
        assert verdict.verdict == "VALID", verdict.line()
    found = made.parts["optimum"]
    assert made.order <= 2 * plant.n
    assert found.figures.margin >= 0.3
    assert found.relative_cost < 4
    assert found.digits <= 4
    assert found.figures.largest_gain <= 10 * max(found.central.largest_gain, 1)
    sent = {(j, i) for j, i in made.controller.edges()}
    graph = plant.neighbors
    assert graph is not None
    assert sent <= (set() if share is None else set(graph.edges()))


def test_the_same_request_gives_the_same_controller():
    first, second = (design(coupled(), "1/2") for _ in range(2))
    assert first.controller.document() == second.controller.document()


def test_a_fixed_mode_refuses_before_any_search():
    apart = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]])
    told: list[str] = []
    asked = request(apart, "1", told.append)
    with pytest.raises(Impossible) as refused:
        searched("decentralized", Family(decentralized_network(apart)), asked)
    assert refused.value.certificate.kind == "fixed_spectrum"
    assert told == ["fixed modes"]


def test_a_limit_comes_with_the_diagnosis():
    plant = coupled()
    family = Family(decentralized_network(plant))
    # Nothing is found without any effort.
    with refusal(LimitReached, part=True):
        optimum(family, request(plant, "1/2"), Aims(effort=0.0))


def test_static_gains_come_first_and_the_theorem_last():
    # A double integrator of which the position alone is measured needs a state.
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    told: list[str] = []
    made = searched(
        "decentralized", Family(decentralized_network(plant)), request(plant, "1/2", told.append)
    )
    assert made.order == 1
    steps = [each for each in told if each.startswith(("static", "order", "from"))]
    assert steps[0] == "static gains" and steps[1].startswith("order 1 per agent")
    assert not any(each.startswith("from") for each in told)


@pytest.mark.parametrize("disk", [0.4, 1.9])
def test_an_effort_that_was_given_is_that_of_all_that_is_searched(monkeypatch, disk):
    counted = list[float]()

    def add(effort: Effort, cost: float) -> None:
        effort.spent += cost
        if effort.whole is None:
            counted.append(cost)
        else:
            effort.whole._add(cost)

    monkeypatch.setattr(Effort, "_add", add)
    # With margins that no loop has, all that can follow a search follows.
    design_decentralized(gallery.load("compleib-dis2"), aims=Aims(effort=1, disk=disk))
    assert 0.3 < sum(counted) / PER_SECOND < 1.1


def test_the_region_is_not_left_by_polishing():
    plant = coupled()
    asked = request(plant, "1/2")
    target = Target(asked.region)
    of = FeedbackProblem.of(decentralized_network(plant), (1, 1, 1), Weights.unit(plant))
    start = inside(of, np.full(of.size, 0.1), target, Effort(1e5))
    assert start is not None and target.reached(bound_of(of, start))
    for x in polished(of, start, target, Effort(1e5)):
        assert target.reached(bound_of(of, x))


def test_the_dimensions_that_suffice_are_shared():
    # Two agents, each of which moves one mode that only the other one sees.
    crossed = MultiChannelSystem(
        [[1, 0], [0, 2]],
        [[[1], [0]], [[0], [1]]],
        [[[0, 1]], [[1, 0]]],
        neighbors=NeighborGraph.complete(("1", "2")),
    )
    made = design(crossed, "1/2", "outputs+states")
    assert made.parts["optimum"].figures.margin >= 0.3
    assert set(made.controller.edges()) <= {(0, 1), (1, 0)}


def test_a_margin_that_is_too_small_is_raised_at_a_price():
    # An inverted pendulum of which the angle alone is measured, and noisily.
    plant = MultiChannelSystem([[0, 1], [4, 0]], [[[0], [1]]], [[[1, 0]]])
    weights = replace(Weights.unit(plant), V=np.array([[1.0]]))
    asked = request(plant, "1/10")
    of = FeedbackProblem.of(decentralized_network(plant), (1,), weights)
    start = inside(of, np.full(of.size, -0.5), Target(asked.region), Effort(1e5))
    assert start is not None
    rounds = list(polished(of, start, Target(asked.region), Effort(1e5)))
    first, last = (figures_of(of, of.gain(x)) for x in (rounds[0], rounds[-1]))
    # The penalty is a soft one: `with_margins` insists on 0.3.
    assert 2 * first.margin < last.margin
    assert first.cost < last.cost


def test_margins_are_not_larger_than_asked_where_they_are_dear():
    plant = MultiChannelSystem([[0, 1], [1, 0]], [[[0], [1]]], [[[1, 0]]])
    asked = request(plant, "1/10")
    of = FeedbackProblem.of(decentralized_network(plant), (1,), Weights.unit(plant))
    target = Target(asked.region)
    start = inside(of, np.full(of.size, -0.5), target, Effort(1e5))
    assert start is not None
    cheapest, *_, last = polished(of, start, target, Effort(1e5))
    before, after = (Margins(of, of.gain(x)).peaks(MARGINS) for x in (cheapest, last))
    assert not before.keep(MARGINS) and after.keep(MARGINS)
    assert min(after.disk / MARGINS.disk, after.margin / MARGINS.margin) < 1.05


def test_a_start_with_less_than_the_slack_is_polished_all_the_same():
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    target = Target(request(plant, "1").region)
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    start = np.array([-2.01])
    assert not target.reached(bound_of(of, start), SLACK)
    *_, found = polished(of, start, target, Effort(1e5))
    assert target.reached(bound_of(of, found), SLACK)


def candidate_of(of: FeedbackProblem, K: np.ndarray) -> Candidate:
    """A gain matrix with its figures."""
    return Candidate("a start", of, K, figures_of(of, K), Margins(of, K).peaks(MARGINS))


@pytest.mark.parametrize(
    ("gain", "rate", "digits", "stored"),
    [(-1.2597, "1/4", 2, -1.26), (-2.1, "0.9", 1, -2.1), (-1.2449, "0.2445", 4, -1.2449)],
)
def test_the_least_number_of_digits_is_found(gain, rate, digits, stored):
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    K = np.array([[gain]])
    candidate = candidate_of(of, K)
    found = with_few_digits(candidate, Target(request(plant, rate).region), None)
    assert (found.digits, found.K.tolist()) == (digits, [[stored]])


def test_a_controller_that_the_gate_refuses_is_not_proposed():
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    K = np.array([[-1.25]])
    candidate = candidate_of(of, K)
    with refusal(LimitReached):
        with_few_digits(candidate, Target(request(plant, "1/2").region), None)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_an_agent_that_measures_its_state_starts_with_its_regulator(time):
    plant = MultiChannelSystem([[1, 1], [0, 1]], [[[0], [1]]], [[[1, 0], [0, 1]]], time=time)
    weights = Weights.unit(plant)
    of = FeedbackProblem.of(decentralized_network(plant), (0,), weights)
    [part] = localities(of, weights)
    shift = 0.9 if of.discrete else 0.5
    F = regulator(part.model, shift)
    assert np.allclose(local_regulators(of, [part], shift), F)
    assert bound_of(of, of.entries(F)) < (shift if of.discrete else -shift)


def test_a_state_that_belongs_to_nobody_joins_the_agent_it_is_coupled_with():
    plant = MultiChannelSystem(
        [[0, 0, 0], [0, 0, 1], [0, 2, 0]], [[[1], [0], [0]], [[0], [0], [1]]],
        [[[1, 0, 0]], [[0, 0, 1]]],
    )  # fmt: skip
    weights = Weights.unit(plant)
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0), weights)
    assert [each.states for each in localities(of, weights)] == [(0,), (1, 2)]


def test_a_state_that_several_agents_measure_may_belong_to_the_one_that_drives_it():
    # Two vehicles, of which the second one measures the distance to the first.
    A = [[0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0]]
    B = [[[0], [1], [0], [0]], [[0], [0], [0], [1]]]
    plant = MultiChannelSystem(A, B, [[[1, 0, 0, 0]], [[-1, 0, 1, 0]]])
    weights = Weights.unit(plant)
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0), weights)
    assert [each.states for each in localities(of, weights)] == [(0, 1), (0, 2, 3)]
    driven = localities(of, weights, driven=True)
    assert [each.states for each in driven] == [(0, 1), (2, 3)]
    assert driven[1].model.C.tolist() == [[1, 0]]


def test_agents_find_controllers_of_their_own_parts():
    # A string of vehicles, each of which measures the distance to the one before.
    m = 4
    A = np.kron(np.eye(m), [[0.0, 1.0], [0.0, 0.0]])
    B = [np.eye(2 * m)[:, [2 * i + 1]] for i in range(m)]
    C = [np.eye(2 * m)[[2 * i]] - (np.eye(2 * m)[[2 * i - 2]] if i else 0) for i in range(m)]
    plant = MultiChannelSystem.from_float(A, B, C, rounding="decimal")
    weights, target = Weights.unit(plant), Target(request(plant, "1/5").region)
    static = FeedbackProblem.of(decentralized_network(plant), (0,) * m, weights)
    made = controllers_of_parts(localities(static, weights, driven=True), 1, target, Effort(1e5))
    of = FeedbackProblem.of(static.network, (1,) * m, weights)
    K = with_private_parts(of, made)
    assert not K[~of.mask].any()
    # The string is a cascade, so that the loop of all has the spectrum of the loops of the parts.
    assert target.reached(bound_of(of, of.entries(K)))


def test_an_agent_without_input_finds_nothing():
    plant = MultiChannelSystem([[1, 0], [0, 1]], [[[1], [0]], [[0], [0]]], [[[1, 0]], [[0, 1]]])
    weights = Weights.unit(plant)
    static = FeedbackProblem.of(decentralized_network(plant), (0, 0), weights)
    made = controllers_of_parts(
        localities(static, weights), 1, Target(request(plant, "1/5").region), Effort(1e5)
    )
    assert made[0] is not None and made[1] is None


@pytest.mark.parametrize(
    ("needed", "most", "expected"),
    [(1, None, -2.12), (5, None, -2.1235), (5, 4, -2.12), (9, None, -2.12)],
)
def test_digits_are_added_as_long_as_the_margin_needs_them(monkeypatch, needed, most, expected):
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    problem = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    K = np.array([[-2.123456]])
    known = candidate_of(problem, K)

    class Seen(Margins):
        def peaks(self, limits: Limits) -> Peaks:
            digits = len(f"{abs(self._K[0, 0])}") - 1
            return replace(known.peaks, margin=0.31 if digits >= needed else 0.29)

    monkeypatch.setattr(proposals, "Margins", Seen)
    target = Target(request(plant, "1/2").region)
    robust = replace(known, peaks=replace(known.peaks, margin=0.31))
    found = with_few_digits(robust, target, None, most)
    assert found.K.tolist() == [[expected]]


def test_a_controller_that_needs_few_digits_is_better_than_one_that_is_hardly_cheaper():
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    region = request(plant, "0.24449").region
    # The border is at -1.24449, so that four digits of the first gain are too few.
    exact, other, dear = (candidate_of(of, np.array([[gain]])) for gain in (-1.244492, -1.26, -1.9))
    exact = replace(exact, figures=replace(exact.figures, cost=0.99 * other.figures.cost))
    target = Target(region)
    assert proposals._rounded(
        proposals._Result((exact, other), target), None, None, ""
    ).K.tolist() == [[-1.26]]
    dear = replace(dear, figures=replace(dear.figures, cost=2 * exact.figures.cost))
    [[kept]] = proposals._rounded(proposals._Result((exact, dear), target), None, None, "").K
    assert -1.245 < kept < -1.2444
    with pytest.raises(LimitReached, match=r"with 1 digits for .*: known"):
        proposals._rounded(proposals._Result((exact,), target), None, 1, ": known")


def test_rounding_keeps_the_damping_that_a_loop_has():
    plant = MultiChannelSystem([[0, 1], [-1, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    # with the stiffness 1.00050 the ratio is 0.1000125/2/1.00025
    candidate = candidate_of(of, np.array([[-0.000503, -0.10003]]))
    assert candidate.figures.damping > 0.05
    found = with_few_digits(candidate, Target(request(plant, "1/100").region), None)
    assert found.figures.damping >= 0.05
    assert figures_of(of, np.array([[-0.000503, -0.1]])).damping < 0.05
