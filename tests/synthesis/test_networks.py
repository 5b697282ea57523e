"""What agents of a derived network see, hold and compute; what single channels reach of a loop."""

from __future__ import annotations

from random import Random

import pytest

from mcexact.derived.constructions import closed_by
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import any_system, jointly_controllable_system
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.channel_controller import channel_part, drawn_gains
from mcexact.synthesis.networks import NetworkKind, network_programs, shared_network
from tests.oracle.networks import is_power_of_x


def markov(A: Matrix, B: Matrix, C: Matrix, count: int) -> list[Matrix]:
    """C A^k B for k < count."""
    return [C @ A.power(k) @ B for k in range(count)]


@pytest.mark.parametrize("seed", range(20))
def test_a_part_is_minimal_and_has_the_same_transfer_matrix(seed: int) -> None:
    system = any_system(SeededChoices(f"part {seed}"), 4, 2).system
    A, B, C = system.A, system.B(0), system.C(0)
    part = channel_part(A, B, C, Random(seed))
    d = part.A.nrows
    assert markov(A, B, C, 8) == markov(part.A, part.B, part.C, 8)
    if d:
        assert rank(hstack([part.A.power(k) @ part.B for k in range(d)])) == d
        assert rank(vstack([part.C @ part.A.power(k) for k in range(d)])) == d


def test_holding_makes_every_use_equally_late() -> None:
    graph = NeighborGraph(("1", "2", "3"), [[1, 2], [0], [0]], [(0, 1, 2), (1, 0, 1), (2, 0, 3)])
    plant = MultiChannelSystem([[1]], [[[1]]] * 3, [[[1]]] * 3, time="discrete")
    network = shared_network(plant, graph, [2, 1, 1], "states", "held")
    assert network.holds(0) == {0: 3, 1: 2}, "agent 3 hears it 3 steps late anyway"
    assert network.holds(1) == {1: 2}
    assert network.holds(2) == {}, "nobody hears it late"


@pytest.mark.parametrize("kind", ["extended", "lifted", "held"])
@pytest.mark.parametrize("seed", range(8))
def test_programs_of_drawn_gains_close_the_derived_loop(seed: int, kind: NetworkKind) -> None:
    choices, rng = SeededChoices(f"programs {seed}"), Random(seed)
    system = jointly_controllable_system(choices, 3, 3, time="discrete").system
    delay = 0 if kind == "extended" else 3
    graph = drawn_graph(choices, system.names, longest_delay=delay)
    sizes = [rng.randint(0, 2) for _ in range(3)]
    share = "states" if kind == "held" else "outputs+states"
    network = shared_network(system, graph, sizes, share, kind)  # type: ignore[arg-type]
    derived = network.system
    gains = [
        Matrix.from_integers(
            [[rng.randint(-2, 2) for _ in range(derived.q(i))] for _ in range(derived.p(i))],
            ncols=derived.q(i),
        )
        for i in range(3)
    ]
    loop = closed_loop(system, network_programs(network, gains, {}), graph).matrix
    chi, whole = (
        characteristic_polynomial(loop),
        characteristic_polynomial(closed_by(derived, gains)),
    )
    quotient, remainder = divmod(whole, chi)
    assert remainder.is_zero()
    assert is_power_of_x(quotient), "only unused messages are left out"


def test_the_best_draw_comes_first() -> None:
    system = jointly_controllable_system(SeededChoices("first"), 4, 3).system
    found = drawn_gains(system, [(0, 1, 2)], attempts=30)
    assert [d.degree for d in found] == sorted((d.degree for d in found), reverse=True)
