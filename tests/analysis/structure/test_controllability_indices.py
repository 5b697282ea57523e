"""Controllability and observability indices."""

import json
import random

import pytest

from mcexact.analysis import controllability
from mcexact.analysis.controllability import controllability_indices, observability_indices
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import dual
from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import ModularMatrix, residues
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import PlainSystem, product, rank
from tests.wording import refusal


def oracle_ranks(system: PlainSystem) -> tuple[int, ...]:
    """The ranks of [B … A^{k−1}B] until they stop growing."""
    n = system.n
    block = [[value for t in range(system.m) for value in system.B[t][i]] for i in range(n)]
    rows, ranks = [list(row) for row in block], [0]
    while (found := rank(rows)) > ranks[-1]:
        ranks.append(found)
        block = product(system.A, block)
        rows = [a + b for a, b in zip(rows, block, strict=True)]
    return tuple(ranks[1:])


def test_drawn_systems_agree_with_plain_ranks_and_are_certified() -> None:
    rng = random.Random(8)
    for _ in range(150):
        small = sparse_system(rng)
        system = exact(small)
        for answer, wanted in (
            (controllability_indices(system), oracle_ranks(small)),
            (observability_indices(system), oracle_ranks(small.dual)),
        ):
            assert answer.ranks == wanted
            assert sum(answer.indices) == (wanted[-1] if wanted else 0)
            verdict = check_document(protocol.encode(answer).encode())
            assert verdict.verdict == "VALID", verdict


def test_a_chain_of_integrators_has_one_long_index() -> None:
    n = 8
    A = [[int(i == j + 1) for j in range(n)] for i in range(n)]
    system = MultiChannelSystem(A, [[[1]] + [[0]] * (n - 1)], [[[0] * n]])
    found = controllability_indices(system)
    assert (found.index, found.indices) == (n, (n,))
    assert observability_indices(system).ranks == ()


def test_without_states_the_index_is_0() -> None:
    system = MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])
    found = controllability_indices(system)
    assert (found.ranks, found.index, found.indices) == ((), 0, ())
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"


def masses(n: int, m: int, seed: int, rest: int = 0) -> MultiChannelSystem:
    """n/2 masses in a row: force by channel, position and speed measured; the last ones are alone.

    No channel moves the last ``rest`` masses.
    """
    rng, half = random.Random(seed), n // 2
    entries = {(a, half + a): 1 for a in range(half)}
    for a in range(half - 1):
        if a != half - rest - 1:
            k = rng.randint(1, 9)
            for i, j, x in ((a, a, -k), (a, a + 1, k), (a + 1, a, k), (a + 1, a + 1, -k)):
                entries[half + i, j] = entries.get((half + i, j), 0) + x
    places = [a * (half - rest) // m + rng.randint(0, 2) for a in range(m)]
    return MultiChannelSystem(
        Matrix.from_entries((n, n), [(i, j, x) for (i, j), x in entries.items()]),
        [Matrix.from_entries((n, 1), [(half + a, 0, 1)]) for a in places],
        [Matrix.from_entries((2, n), [(0, a, 1), (1, half + a, 1)]) for a in places],
    )


def modular_ranks(system: MultiChannelSystem) -> tuple[int, ...]:
    """The ranks of [B … A^{k−1}B] modulo a long prime until they stop growing, with all zeros."""
    ell = 2**61 - 1
    A, power = residues(system.A, ell), residues(system.input_matrix(), ell)
    blocks, ranks = list[list[int]](), [0]
    while len(ranks) < 2 or ranks[-1] > ranks[-2]:
        blocks += power.T.rows()
        ranks.append(ModularMatrix.from_rows(blocks, ell, ncols=system.n).rank())
        power = A @ power
    return tuple(ranks[1:-1])


@pytest.mark.parametrize("rest", [0, 2])
def test_large_sparse_plants_are_decided_and_checked_in_bands(rest: int) -> None:
    m = 12
    system = masses(140, m, m, rest)
    assert system.A.is_sparse
    for answer, wanted in (
        (controllability_indices(system), modular_ranks(system)),
        (observability_indices(system), modular_ranks(dual(system))),
    ):
        assert answer.evidence.modulus < 64
        assert answer.ranks == wanted
        assert (answer.index is None) == (rest > 0)
        document = json.loads(protocol.encode(answer))
        assert verdict_of(document) == "VALID"
        # modulo a long prime nothing is in bands, and the verdict is the same
        for ell, verdict in ((2**61 - 1, "VALID"), (answer.evidence.modulus, "INVALID")):
            document["witness"]["modulus"] = ell
            if verdict == "INVALID":  # an input more in the second block
                document["claim"]["ranks"][1] += 1
                document["claim"]["indices"] = conjugate(document["claim"]["ranks"])
            assert verdict_of(document) == verdict
    assert len(answer.evidence.inputs) >= m  # speeds are derivatives of positions


def conjugate(ranks: list[int]) -> list[int]:
    steps = [b - a for a, b in zip([0, *ranks], ranks, strict=False)]
    return [sum(step > i for step in steps) for i in range(max(steps))]


def verdict_of(document: dict[str, object]) -> str:
    return check_document(json.dumps(document).encode()).verdict


def test_without_a_narrow_band_indices_are_left_open_if_the_plant_is_large(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    system = masses(140, 5, 1)
    in_bands = controllability_indices(system).ranks
    monkeypatch.setattr(controllability, "_MOST_IN_BANDS", 10**4)
    assert controllability_indices(system).ranks == in_bands
    monkeypatch.setattr(controllability, "_MOST_DENSE", 100)
    with pytest.raises(LimitReached, match="indices of 140 states: a Krylov matrix"):
        controllability_indices(system)


def test_many_relations_are_left_open_if_the_plant_is_large(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    system = masses(140, 5, 1)
    monkeypatch.setattr(controllability, "_MOST_RELATED", 5)
    monkeypatch.setattr(controllability, "_MOST_DENSE", 100)
    with refusal(LimitReached):
        observability_indices(system)
