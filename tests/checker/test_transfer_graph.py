"""The rule of ``transfer_graph``."""

from __future__ import annotations

import itertools
import math
import random

import pytest

from mcexact.checker.core.arithmetic import Matrix, product
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.evidence import unseen, without_path
from mcexact.checker.core.reach import read_arcs, require_arcs, require_connected
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, read_plant
from tests.checker.handmade import GRAPH, certificate, changed, checked, matrix, plant
from tests.checker.tables import accepts, rejects

WHOLE = {"from": ["1", "2"], "X": matrix([1, 0], [0, 1]), "pivots": [0, 1]}
ZEROS = GRAPH["witness"]["zeros"]
THIRDS = matrix([0], [3], denominator=3)
TOO_MANY = [["1", "1"], ["1", "2"], ["2", "1"], ["2", "2"]]
DEAD = changed(
    GRAPH,
    ("system.channels.1.C", [[0, 0]]),
    ("claim.arcs", [["1", "1"]]),
    ("witness.powers", [0]),
    ("witness.zeros", [WHOLE, *ZEROS]),
)

GROWING = certificate(
    "transfer_graph",
    plant([[2]], ([[1]], [[1]])),
    {"arcs": [["1", "1"]], "components": [["1"]], "strongly_connected": True},
    {"modulus": 7, "powers": [0], "zeros": []},
)
"""C A^k B = 2^k for every k."""

CANCELS = certificate(
    "transfer_graph",
    plant([[0, 0], [0, 0]], ([[1], [-1]], [[1, 1]])),
    {"arcs": [], "components": [["1"]], "strongly_connected": True},
    {
        "modulus": 7,
        "powers": [],
        "zeros": [{"from": ["1"], "X": matrix([1], [-1]), "pivots": [0]}],
    },
)
"""The output is the sum of two states that the input drives in opposite directions."""
ROUND = certificate(
    "transfer_graph",
    plant(
        [[0, 0, 0], [0, 0, 1], [1, 0, 0]],
        ([[1], [0], [0]], [[0, 1, 0]]),
        ([[0], [0], [0]], [[0, 0, 1]]),
        ([[0], [2], [0]], [[1, 0, 0], [0, 0, 0]]),
    ),
    {
        "arcs": [["1", "1"], ["1", "2"], ["1", "3"], ["3", "1"]],
        "components": [["1", "3"], ["2"]],
        "strongly_connected": False,
    },
    {"modulus": 7, "powers": [2, 1, 0, 0], "zeros": []},
)
"""x_1 drives x_3, which drives x_2; no path leads to the other outputs."""

ACCEPTED = [
    ("terms that cancel on a path", CANCELS),
    ("paths against the order of the states", ROUND),
    ("the same modulo a prime of many bits", changed(ROUND, ("witness.modulus", 2**31 - 1))),
    ("the same modulo 64", changed(ROUND, ("witness.modulus", 64))),
    ("the same modulo 65", changed(ROUND, ("witness.modulus", 65))),
    ("no path, and no zero transfer", changed(GRAPH, ("witness.zeros", []))),
    ("one state", GROWING),
    ("a chain of two channels", GRAPH),
    ("a channel whose outputs see nothing", DEAD),
    ("a zero transfer that is not needed", changed(GRAPH, ("witness.zeros", [*ZEROS, WHOLE]))),
    ("another modulus", changed(GRAPH, ("witness.modulus", 2))),
    ("a column over a denominator", changed(GRAPH, ("witness.zeros.0.X", THIRDS))),
]  # fmt: skip

REJECTED = [
    ("an arc left out", ("claim.arcs", [["1", "1"], ["1", "2"]]), ("witness.powers", [0, 1])),
    ("an arc that is not there", ("claim.arcs", TOO_MANY), ("witness.powers", [0, 1, 0, 0])),
    ("arcs out of order", ("claim.arcs", [["1", "2"], ["1", "1"], ["2", "2"]])),
    ("an arc twice", ("claim.arcs", [["1", "1"], ["1", "1"], ["2", "2"]])),
    ("an arc to nowhere", ("claim.arcs.1", ["1", "3"])),
    ("an arc of three", ("claim.arcs.1", ["1", "2", "2"])),
    ("a power that gives 0", ("witness.powers.1", 0)),
    ("a power of n", ("witness.powers.1", 2)),
    ("a negative power", ("witness.powers.1", -1)),
    ("a power missing", ("witness.powers", [0, 1])),
    ("a zero transfer from the wrong channel", ("witness.zeros.0.from", ["1"])),
    ("X empty", ("witness.zeros.0.X", matrix([], [])), ("witness.zeros.0.pivots", [])),
    ("X not invariant", ("witness.zeros.0.X", matrix([1], [0])), ("witness.zeros.0.pivots", [0])),
    ("components merged", ("claim.components", [["1", "2"]])),
    ("components in another order", ("claim.components", [["2"], ["1"]])),
    ("a component left out", ("claim.components", [["1"]])),
    ("called strongly connected", ("claim.strongly_connected", True)),
    ("modulus 1", ("witness.modulus", 1)),
    ("a transfer that vanishes modulo ℓ", ("system.A.1.0", 7)),
    ("a plant with a transfer back", ("system.A.0.1", 1)),
]  # fmt: skip


PATHS = [
    ("a path, and no zero transfer", CANCELS, ("witness.zeros", [])),
    ("a path, and X that C sees", CANCELS, ("witness.zeros.0.X", matrix([1], [1]))),
    ("a path, and a zero transfer from nobody", CANCELS, ("witness.zeros.0.from", [])),
    (
        "an arc left out at the end of a path",
        ROUND,
        (("claim.arcs.1", ["1", "3"]), ("claim.arcs.2", ["3", "1"]), ("claim.arcs.3", ["3", "3"])),
    ),
    ("a power too low on a path", ROUND, ("witness.powers.0", 1)),
    ("a power too high on a path", ROUND, ("witness.powers.3", 1)),
    ("another output", ROUND, ("system.channels.1.C", [[1, 0, 0]])),
    ("another input", ROUND, ("system.channels.1.B", [[1], [0], [0]])),
    ("another path", ROUND, ("system.A.0.1", 1)),
    ("ℓ divides the input", ROUND, ("witness.modulus", 2)),
    ("ℓ divides a denominator", changed(ROUND, ("system.A.1.2", "1/3")), ("witness.modulus", 3)),
]
test_what_a_path_connects_needs_a_power_or_a_zero_transfer = rejects(PATHS)


@pytest.mark.parametrize("ell", [2, 7, 19, 31])
def test_long_rows_are_added_by_coefficient_to_the_same_powers(ell: int) -> None:
    rng, n = random.Random(ell), 3 * ell + 60

    def drawn(nrows: int, ncols: int, share: float) -> Matrix:
        rows = [
            [rng.randint(1, 99) if rng.random() < share else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]
        return Matrix(rows, ncols)

    shown = set()
    for share in (0.05, 0.9):
        B, C = [drawn(n, 2, 0.02), drawn(n, 1, 0.5)], [drawn(1, n, 0.02), drawn(2, n, 1.0)]
        system = System("continuous", ["a", "b"], drawn(n, n, share), B, C)
        for j, i, k in itertools.product(range(2), range(2), range(3)):
            power = B[j].modulo(ell)
            for _ in range(k):
                power = product(system.A.modulo(ell), power, B[j].ncols, ell)
            nonzero = any(map(any, product(C[i].modulo(ell), power, B[j].ncols, ell)))
            assert unseen(system, [(j, i, k)], ell) == (None if nonzero else (j, i, k))
            shown.add(nonzero)
    assert True in shown


@pytest.mark.parametrize("ell", [2, 3, 7, 31, 61, 64])
def test_powers_of_all_channels_at_once_are_those_of_each(ell: int) -> None:
    rng, shown = random.Random(ell), set()
    for _ in range(12):
        n, widths = rng.randint(1, 8), [rng.randint(0, 3) for _ in range(3)]

        def drawn(nrows: int, ncols: int) -> Matrix:
            rows = [
                [rng.choice((0, rng.randint(-99, 99))) for _ in range(ncols)] for _ in range(nrows)
            ]
            return Matrix(
                rows, ncols, rng.choice([d for d in (1, 5, 7, 11) if math.gcd(d, ell) == 1])
            )

        B, C = [drawn(n, p) for p in widths], [drawn(rng.randint(0, 2), n) for _ in widths]
        system = System("continuous", ["a", "b", "c"], drawn(n, n), B, C)
        A = system.A.modulo(ell)
        for j, i, k in itertools.product(range(3), range(3), range(n)):
            power = B[j].modulo(ell)
            for _ in range(k):
                power = product(A, power, widths[j], ell)
            nonzero = any(map(any, product(C[i].modulo(ell), power, widths[j], ell)))
            assert unseen(system, [(j, i, k)], ell) == (None if nonzero else (j, i, k))
            shown.add(nonzero)
    assert shown == {True, False}


@pytest.mark.parametrize("power", [1, 2, 10**9])
def test_no_power_beyond_the_number_of_states_is_computed(power: int) -> None:
    verdict = checked(changed(GROWING, ("witness.powers", [power])))
    assert (verdict.verdict, verdict.code) == ("INVALID", "arc"), verdict.line()


@pytest.mark.parametrize(
    ("arcs", "good"),
    [
        ([["1", "1", 0], ["1", "2", 1], ["2", "2", 0]], True),
        ([["1", "2", 1], ["1", "1", 0], ["2", "2", 0]], False),
        ([["2", "2", 0], ["1", "1", 0]], False),
        ([["1", "1", 0], ["1", "1", 0]], False),
        ([["1", "1", 0], ["1", "1", 1]], False),
        ([["1", "1", 0], ["1", "1", 0], ["2", "2", 0]], False),
        ([["1", "1", -1]], False),
        ([["1", "1"]], False),
    ],
)
def test_edges_are_sorted_and_none_is_given_twice(arcs: list[list[object]], good: bool) -> None:
    system = read_plant(GRAPH["system"])
    if good:
        assert read_arcs(arcs, "arcs", system) == [(0, 0, 0), (0, 1, 1), (1, 1, 0)]
    else:
        with pytest.raises(Refused) as found:
            read_arcs(arcs, "arcs", system)
        assert found.value.verdict == "MALFORMED"


test_sound_evidence_is_accepted = accepts(ACCEPTED)


@pytest.mark.parametrize("edits", REJECTED, ids=lambda row: str(row[0]))
def test_a_change_is_rejected(edits: tuple[object, ...]) -> None:
    verdict = checked(changed(GRAPH, *edits[1:]))  # type: ignore[arg-type]
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


def test_a_transfer_that_vanishes_is_named_by_the_numbers_of_its_channels() -> None:
    system = read_plant(GRAPH["system"])
    require_arcs(system, [(0, 1, 1), (1, 1, 0)], 7)
    for ends, text in (((0, 1), "1 to 2"), ((1, 0), "2 to 1")):
        with pytest.raises(Refused) as found:
            require_arcs(system, [(*ends, 0)], 7)
        assert found.value.message == f"C A^0 B is 0 modulo l from channel number {text}"


RING = read_plant(
    plant(
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        *[([[int(i == k)] for i in range(3)], [[int(i == k) for i in range(3)]]) for k in range(3)],
    )
)
"""Channel 1 drives the state of channel 2, this one that of channel 3, and this one the first."""


@pytest.mark.parametrize(
    ("arcs", "good"),
    [
        ([["1", "2", 1], ["2", "3", 1], ["3", "1", 1]], True),
        ([["1", "2", 1], ["1", "3", 2], ["2", "1", 2], ["3", "1", 1]], True),
        ([["1", "2", 1], ["2", "1", 2]], False),
        ([["1", "2", 1], ["2", "3", 1]], False),
        ([["1", "2", 1], ["2", "3", 1], ["3", "1", 0]], False),
        ([], False),
    ],
)
def test_edges_connect_all_channels_or_prove_nothing(arcs: list[list[object]], good: bool) -> None:
    if good:
        require_connected(arcs, "arcs", RING, 7)
    else:
        with pytest.raises(Refused) as found:
            require_connected(arcs, "arcs", RING, 7)
        assert (found.value.verdict, found.value.code) == ("INVALID", "arc")


def test_no_power_is_computed_where_no_edge_is_claimed() -> None:
    system = read_plant(plant([[1, 2], [3, 4]], ([[1], [1]], [[1, 0]])))

    def units(triples: list[tuple[int, int, int]]) -> int:
        budget = Budget(10**9, 0)
        with limited(budget):
            assert unseen(system, triples, 31) is None
        return budget.spent

    assert units([(0, 0, 1)]) - units([(0, 0, 0)]) >= 200
    assert units([(0, 0, 0)]) - units([]) > 200


@pytest.mark.parametrize("step", [1, -1])
def test_long_paths_are_found_in_a_few_turns_whatever_way_they_lead(step: int) -> None:
    n = 100
    order = list(range(n))[::step]
    arcs = sorted([b, a, 1] for a, b in itertools.pairwise(order))
    A = {"shape": [n, n], "entries": arcs}
    first, last = ([[int(a == state)] for a in range(n)] for state in (order[0], order[-1]))
    channels = [
        {"name": name, "B": B, "C": [[entry for (entry,) in C]]}
        for name, B, C in (("1", first, first), ("2", last, last))
    ]
    system = read_plant({"time": "continuous", "A": A, "channels": channels})
    budget = Budget(10**9, 0)
    with limited(budget):
        assert without_path(system, itertools.product(range(2), range(2))) == {(1, 0)}
    assert budget.spent < 10 * 40 * 2 * n


@pytest.mark.parametrize("way", [1, -1])
def test_rows_that_no_later_edge_needs_are_left_out(way: int) -> None:
    """Edges of different powers at once, along a ring with a chord, and one that is none."""
    n, ell = 24, 31
    rows = [[0] * n for _ in range(n)]
    for a in range(n):
        rows[a][(a - way) % n] = 1 + a % 3
    rows[5][17] = 2
    ports = [
        ([[int(a == 6 * c)] for a in range(n)], [[int(a == 6 * c + 1) for a in range(n)]])
        for c in range(4)
    ]
    system = read_plant(plant(rows, *ports))
    markov: dict[tuple[int, int, int], int] = {}
    for j, B in enumerate(system.B):
        state = [row[0] for row in B.rows]
        for k in range(2 * n):
            for i, C in enumerate(system.C):
                total = sum(x * y for x, y in zip(C.rows[0], state, strict=True))
                markov[j, i, k] = total % ell
            state = [sum(x * y for x, y in zip(row, state, strict=True)) % ell for row in rows]
    true = sorted(triple for triple, number in markov.items() if number)
    rng = random.Random(way)
    for _ in range(30):
        chosen = sorted(rng.sample(true, rng.randint(1, 12)))
        assert unseen(system, chosen, ell) is None
        j, i, k = rng.choice(sorted(markov.keys() - set(true)))
        assert unseen(system, sorted([*chosen, (j, i, k)]), ell) == (j, i, k)


def test_a_state_that_two_outputs_see_is_needed_for_the_longer_path() -> None:
    rows = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    seen = ([[0], [0], [0]], [[0, 0, 1]])
    system = read_plant(
        plant(rows, ([[1], [0], [0]], [[0, 0, 1]]), ([[0], [0], [1]], [[0, 0, 1]]), seen)
    )
    for triples in ([(0, 0, 2), (1, 1, 0)], [(0, 1, 2), (1, 0, 0)], [(0, 2, 2), (1, 0, 0)]):
        assert unseen(system, triples, 7) is None
    assert unseen(system, [(0, 0, 2), (1, 1, 1)], 7) == (1, 1, 1)
