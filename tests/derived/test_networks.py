"""Drawn networks have the equations of their kind, in any size, and stay sparse."""

from __future__ import annotations

import pytest

from mcexact import fixed_spectrum
from mcexact.cli.options import NETWORKS as OFFERED
from mcexact.derived.drawn.networks import NETWORKS, network_system
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from tests.wording import says


def made(network: str, states: int = 24, channels: int = 3, seed: int = 0) -> MultiChannelSystem:
    """A network that is drawn from a seed."""
    return network_system(SeededChoices(seed), network, states, channels)


def test_the_command_line_offers_every_network() -> None:
    assert tuple(NETWORKS) == OFFERED


@pytest.mark.parametrize("network", NETWORKS)
def test_every_agent_acts_and_measures_and_the_seed_decides(network: str) -> None:
    plant = made(network)
    assert (plant.n, plant.m, plant.time) == (24, 3, "continuous")
    for channel in plant.channels:
        assert not channel.B.is_zero()
        assert not channel.C.is_zero()
    assert plant == made(network)
    assert plant != made(network, seed=1)
    assert drawn_system(Draw(0, 24, 3, network=network)) == plant
    assert says(str(plant.source), "drawn equations")
    assert made(network, NETWORKS[network].states * 2, 1).m == 1


@pytest.mark.parametrize("network", NETWORKS)
def test_rows_have_a_handful_of_entries_in_any_size(network: str) -> None:
    plant = made(network, 6000, 60)
    assert plant.A.is_sparse
    assert sum(1 for _ in plant.A.nonzero()) < 8 * plant.n


@pytest.mark.parametrize("network", ["swing-grid", "swing-hubs", "swing-speed"])
def test_lines_pull_buses_together_and_never_turn_all_of_them(network: str) -> None:
    plant = made(network)
    turned = Matrix.column([1, 0] * 12)
    assert (plant.A @ turned).is_zero()
    rows = plant.A.rows()
    for i in range(12):
        assert [rows[2 * i][j] for j in range(24)] == [int(j == 2 * i + 1) for j in range(24)]
        assert rows[2 * i + 1][2 * i + 1] < 0
        for j in range(12):
            there, back = rows[2 * i + 1][2 * j], rows[2 * j + 1][2 * i]
            assert (there > 0) == (back > 0) if i != j else there < 0


def test_hubs_have_many_lines_and_a_mesh_has_at_most_four() -> None:
    def most(network: str) -> int:
        counts = [0] * 400
        for i, j, value in made(network, 800).A.nonzero():
            counts[i // 2] += i % 2 == 1 and j % 2 == 0 and value > 0
        return max(counts)

    assert most("swing-grid") == 4
    assert most("swing-hubs") > 15


def test_who_measures_speeds_alone_cannot_move_the_common_angle() -> None:
    [factor] = fixed_spectrum(made("swing-speed")).factors
    assert (str(factor.polynomial), factor.channels) == ("x", ("1", "2", "3"))
    assert fixed_spectrum(made("swing-grid")).empty


def test_an_average_is_kept_without_agents() -> None:
    plant = made("consensus")
    assert (plant.A @ Matrix.column([1] * 24)).is_zero()
    assert plant.A == plant.A.T


def test_heat_flows_from_warm_to_cold_and_out_of_the_walls() -> None:
    plant = made("building", 200, 5)
    rows = plant.A.rows()
    for i, row in enumerate(rows):
        assert all(value >= 0 for j, value in enumerate(row) if j != i)
        assert sum(row) == 0 if i % 2 == 0 else -1 < sum(row) < 0
    heated = sorted(i for channel in plant.channels for i, _, _ in channel.B.nonzero())
    assert heated == list(range(0, 200, 2))


def test_every_vehicle_has_one_agent() -> None:
    plant = made("platoon", 30, 4)
    assert sum(plant.p(i) for i in range(4)) == 10
    assert sum(plant.q(i) for i in range(4)) == 20


def test_a_network_may_have_a_strongly_connected_neighbor_graph() -> None:
    graph = drawn_system(Draw(0, 24, 3, network="platoon", neighbors=True)).neighbors
    assert graph is not None
    assert graph.is_strongly_connected()


@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (Draw(0, 24, 3, network="mesh"), "expected a network out of swing-grid, "),
        (Draw(0, 25, 3, network="swing-grid"), "a multiple of 2, at least 4 states, found 25"),
        (Draw(0, 3, 1, network="platoon"), "a multiple of 3, at least 6 states, found 3"),
        (Draw(0, 1, 1, network="consensus"), "expected at least 2 states, found 1"),
        (Draw(0, 24, 13, network="building"), "1 to 12 channels for 24 states, found 13"),
        (Draw(0, 24, 3, network="platoon", fixed_degree=1), "prescribe none, and no bound"),
        (Draw(0, 24, 3, network="platoon", deficiency=1), "prescribe none, and no bound"),
        (Draw(0, 24, 3, network="platoon", time="discrete"), "in continuous time: sample one"),
    ],
)
def test_what_is_no_network_is_refused(draw: Draw, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        drawn_system(draw)


def test_a_network_that_fits_in_no_file_is_not_drawn() -> None:
    with pytest.raises(LimitReached, match="at most 131072 states of a network are drawn"):
        drawn_system(Draw(0, 200_000, 3, network="consensus"))
