"""What must be shared: the paper's example, published instances, and exhaustive search."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from mcexact.analysis.sharing import (
    minimal_communication,
    minimal_shared_dimensions,
    shared_dimension_bound,
)
from mcexact.answer.check import check
from mcexact.answer.protocol import Answer, encode
from mcexact.answer.sharing import SharedDimensions
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import augmented_outputs, extended_system
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.allocation import (
    compare_arcs,
    compare_dimensions,
    drawn,
    drawn_neighbors,
)
from tests.oracle.allocation import boundary
from tests.oracle.draws import exact
from tests.oracle.enumeration import (
    characteristic_polynomial,
    irreducible_factors,
    pencil_rank,
    plain,
    subsets,
)
from tests.wording import refusal

PLANT = gallery.load("liu2020-3ch-no-communication")
RING = NeighborGraph.ring(PLANT.names)


def assert_valid(certificate: Answer) -> None:
    verdict = check_document(encode(certificate).encode("ascii"))
    assert verdict.verdict == "VALID", verdict.line()


def integrator_ring(k: int) -> MultiChannelSystem:
    """k integrators on a directed ring of 2k agents: the first k measure, the others drive."""
    names = [str(i + 1) for i in range(2 * k)]
    unit = Matrix.identity(k)
    B = [Matrix.zeros(k, 0)] * k + [unit.take(cols=[j]) for j in range(k)]
    C = [unit.take(rows=[j]) for j in range(k)] + [Matrix.zeros(0, k)] * k
    heard = tuple(tuple(sorted({i, (i - 1) % (2 * k)})) for i in range(2 * k))
    return MultiChannelSystem(
        Matrix.zeros(k, k), B, C, names=names, neighbors=NeighborGraph(names, heard)
    )


def triangles(copies: int) -> MultiChannelSystem:
    """Copies of diag(1, 2, 3): agents 4, 5, 6 drive, 7, 8, 9 measure, 1, 2, 3 pass on in pairs."""
    n, m = 3 * copies, 9 * copies
    unit = Matrix.identity(n)
    A = Matrix.from_rows([[(i % 3 + 1) * int(i == j) for j in range(n)] for i in range(n)])
    pairs = [(1, 2, 6, 7, 8), (0, 2, 6, 7, 8), (0, 1, 6, 7, 8), (0, 1), (1, 2), (0, 2)]
    pairs += [(3,), (4,), (5,)]
    B, C, heard = [], [], []
    for copy in range(copies):
        for agent in range(9):
            state = [3 * copy + agent % 3]
            B.append(unit.take(cols=state if 3 <= agent < 6 else []))
            C.append(unit.take(rows=state if agent >= 6 else []))
            heard.append(tuple(sorted(9 * copy + i for i in {agent, *pairs[agent]})))
    names = [str(i + 1) for i in range(m)]
    return MultiChannelSystem(A, B, C, names=names, neighbors=NeighborGraph(names, tuple(heard)))


@pytest.mark.parametrize(
    ("share", "dimensions"), [("outputs+states", (0, 0, 1)), ("states", (1, 0, 1))]
)
def test_the_papers_example_needs_less_than_its_bound(
    share: str, dimensions: tuple[int, ...]
) -> None:
    bound = shared_dimension_bound(PLANT, RING, share)  # type: ignore[arg-type]
    assert (bound.deficiency, bound.total) == (1, 3)
    assert_valid(bound)
    found = minimal_shared_dimensions(PLANT, RING, share)  # type: ignore[arg-type]
    assert found.dimensions == dimensions
    assert_valid(found)


def test_the_least_dimensions_equal_an_exhaustive_search() -> None:
    seen = compare_dimensions(60, seed=7)
    assert seen["feasible"] and seen["infeasible"] and seen["something to share, connected graph"]


def test_the_fewest_arcs_equal_an_exhaustive_search() -> None:
    assert compare_arcs(20, seed=7)["systems"] == 20


def test_one_arc_to_agent_2_suffices_in_the_papers_example() -> None:
    graph = NeighborGraph.from_names(PLANT.names, {"1": ["2"], "3": ["1"]})
    found = minimal_communication(PLANT, graph, dimensions=(0, 0, 1))
    assert found.added == (("3", "2"),)
    assert_valid(found)


def test_a_forbidden_arc_is_not_added_and_a_dear_one_is_avoided() -> None:
    graph = NeighborGraph.from_names(PLANT.names, {"1": ["2"], "3": ["1"]})
    other = minimal_communication(PLANT, graph, dimensions=(0, 0, 1), forbidden=[("3", "2")])
    assert other.added == (("1", "2"),) or not other.feasible or ("3", "2") not in other.added
    assert_valid(other)
    dear = minimal_communication(PLANT, graph, costs={("1", "2"): 7})
    assert dear.feasible and dear.cost is not None
    assert_valid(dear)


@pytest.mark.parametrize(("copies", "relaxed", "least"), [(1, Fraction(3, 2), 2), (2, 3, 4)])
def test_rounding_up_the_relaxation_is_not_enough(
    copies: int, relaxed: Fraction, least: int
) -> None:
    found = minimal_shared_dimensions(triangles(copies))
    assert found.total == least
    bound = sum((Fraction(1, 2) for _ in range(3 * copies)), Fraction(0))
    assert bound == relaxed
    assert (len(found.tree) > 1) == (copies > 1)
    assert_valid(found)


def test_sharing_sub_states_alone_adds_one_for_every_sensor() -> None:
    found = minimal_shared_dimensions(triangles(2), share="states")
    assert found.total == 10 and len(found.tree) > 1
    assert_valid(found)


@pytest.mark.parametrize("k", [2, 3, 5])
def test_a_ring_of_integrators_needs_half_of_the_uniform_bound(k: int) -> None:
    system = integrator_ring(k)
    found = minimal_shared_dimensions(system)
    assert found.dimensions == (*range(k), *reversed(range(k)))
    assert shared_dimension_bound(system).total == 2 * k * (k - 1)
    assert_valid(found)


def test_a_cut_of_the_graph_is_named_when_nothing_suffices() -> None:
    found = minimal_shared_dimensions(PLANT, NeighborGraph.empty(PLANT.names))
    assert not found.feasible and found.dimensions is None
    assert len(found.cuts) == 1 and found.cuts[0].subset == ("2", "3")
    assert_valid(found)


def test_upper_bounds_move_the_optimum_or_make_it_impossible() -> None:
    moved = minimal_shared_dimensions(integrator_ring(2), upper=[None, 1, None, 1])
    assert moved.dimensions == (0, 1, 1, 0)
    blocked = minimal_shared_dimensions(integrator_ring(2), upper=[0, 0, 0, 0])
    assert not blocked.feasible
    assert_valid(blocked)


def test_only_modes_that_violate_the_rate_have_to_be_freed() -> None:
    unit, graph = Matrix.identity(2), NeighborGraph.complete(["1", "2", "3", "4"])
    none = Matrix.zeros(2, 0)
    slow = MultiChannelSystem(
        [[-1, 0], [0, -5]],
        [unit.take(cols=[0]), none, unit.take(cols=[1]), none],
        [none.T, unit.take(rows=[0]), none.T, unit.take(rows=[1])],
        neighbors=graph,
    )
    everything = minimal_shared_dimensions(slow, share="states")
    violating = minimal_shared_dimensions(slow, share="states", rate=3)
    nothing = minimal_shared_dimensions(slow, share="states", rate=Fraction(1, 2))
    assert (everything.total, violating.total, nothing.total) == (2, 1, 0)
    for found in (everything, violating, nothing):
        assert_valid(found)


def test_free_assignability_asks_for_a_connected_graph_besides() -> None:
    apart = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    assert minimal_shared_dimensions(apart, share="states").total == 0
    free = minimal_shared_dimensions(apart, share="states", free_assignability=True)
    assert free.dimensions == (1, 1)
    assert_valid(free)


def test_the_node_limit_ends_with_what_is_proved() -> None:
    found = minimal_shared_dimensions(triangles(2), node_limit=1)
    assert (found.at_least, found.cost) == (3, 4)
    assert found.dimensions is not None and sum(found.dimensions) == 4
    assert len(found.tree) == 1 and check(found).verdict == "VALID"
    exact = minimal_shared_dimensions(triangles(2))
    assert (exact.at_least, exact.cost) == (None, 4)


@pytest.mark.parametrize("change", [4, "7/2", 5, -1])
def test_a_lower_bound_beyond_what_is_proved_is_refused(change: Any) -> None:
    found = minimal_shared_dimensions(triangles(2), node_limit=1)
    assert check(replace(found, at_least=Fraction(change))).verdict != "VALID"


def test_less_than_what_is_proved_may_be_claimed() -> None:
    found = minimal_shared_dimensions(triangles(2), node_limit=1)
    assert check(replace(found, at_least=Fraction(2))).verdict == "VALID"


def test_a_lower_bound_below_the_price_of_everything_is_proved_with_prices_and_limits() -> None:
    plant = triangles(2)
    costs, upper = [Fraction(3, 2)] * plant.m, [1] * plant.m
    found = minimal_shared_dimensions(plant, costs=costs, upper=upper, node_limit=1)
    assert found.at_least is not None and found.cost == 6 and 0 < found.at_least < 6
    assert check(found).verdict == "VALID"
    document = found.claim()
    assert document["at_least"] == found.at_least


@pytest.mark.parametrize("limit", [0, -1, True, 2.5, "3", None])
def test_a_node_limit_that_leaves_no_tree_is_refused_before_any_work(
    limit: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mcexact.analysis.sharing.minimize", pytest.fail)
    with refusal(UsageError, where="node_limit"):
        minimal_shared_dimensions(triangles(2), node_limit=limit)
    with refusal(UsageError, where="node_limit"):
        minimal_communication(triangles(2), node_limit=limit)


def test_what_is_infeasible_is_proved_by_one_node() -> None:
    plant = gallery.load("liu2020-3ch-no-communication")
    alone = NeighborGraph.empty(plant.names)
    assert not minimal_shared_dimensions(plant, alone, node_limit=1).feasible


def test_a_radius_of_0_is_not_taken_for_the_unit_disc() -> None:
    discrete = MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete", neighbors={})
    for decide in (minimal_shared_dimensions, minimal_communication):
        with pytest.raises(UsageError, match="a radius above 0"):
            decide(discrete, radius=0)


def test_what_an_arc_cannot_carry_is_refused() -> None:
    with pytest.raises(InputError, match="found 'inputs'"):
        minimal_communication(PLANT, RING, dimensions=[1, 1, 1], share="inputs")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"costs": [1, 0, 1]}, "positive"),
        ({"upper": [1, 2]}, "3 integers"),
        ({"upper": [0.5, 1, 1]}, "3 integers"),
        ({"rate": -1}, "a rate above 0, found -1"),
        ({"graph": None}, "neighbor graph is needed"),
    ],
)
def test_what_does_not_fit_is_refused(options: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        minimal_shared_dimensions(PLANT, **{"graph": RING, **options})  # type: ignore[arg-type]


def test_a_derived_system_is_refused() -> None:
    with pytest.raises(UsageError, match="give the plant"):
        minimal_shared_dimensions(augmented_outputs(PLANT.with_neighbors(RING)))


def test_the_rank_of_an_extended_pencil_counts_each_boundary_agent_once() -> None:
    """rank P̄_s = rank P_s + Σ n_i + Σ over N_s∖s of n_i, at irrational eigenvalues too."""
    rng, degrees = random.Random(3), set()
    for _ in range(12):
        small = drawn(rng, states=3, channels=3)
        heard = drawn_neighbors(rng, small.m)
        system = exact(small)
        graph = NeighborGraph(system.names, tuple(map(tuple, heard)))
        sizes = [rng.randint(0, 2) for _ in range(small.m)]
        for share in ("outputs+states", "states"):
            extended = extended_system(system, sizes, share, graph)
            linked = system.with_neighbors(graph)
            base = plain(augmented_outputs(linked) if share == "outputs+states" else linked)
            for p in irreducible_factors(characteristic_polynomial(small.A)):
                degrees.add(len(p) - 1)
                for s in subsets(small.m):
                    available = sum(sizes[i] for i in boundary(s, heard))
                    assert pencil_rank(plain(extended), s, p) == (
                        pencil_rank(base, s, p) + sum(sizes) + available
                    )
    assert degrees == {1, 2}


def test_the_same_question_gives_the_same_bytes() -> None:
    def text() -> str:
        found: SharedDimensions = minimal_shared_dimensions(triangles(2))
        return encode(found)

    assert text() == text()
