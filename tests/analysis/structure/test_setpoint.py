"""Whether set-points can be held, beside an independent computation."""

from __future__ import annotations

import random

import pytest
import sympy

from mcexact.analysis import structure
from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import setpoint_system
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import any_system
from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem


def as_sympy(M: Matrix) -> sympy.Matrix:
    entries = [sympy.Rational(x.numerator, x.denominator) for row in M.rows() for x in row]
    return sympy.Matrix(M.nrows, M.ncols, entries)


def pencil(system: MultiChannelSystem, x: sympy.Expr) -> sympy.Matrix:
    """[xI − A, B; C, 0]."""
    A, B = as_sympy(system.A), as_sympy(system.input_matrix())
    C = as_sympy(system.output_matrix())
    top = (x * sympy.eye(system.n) - A).row_join(B)
    return top.col_join(C.row_join(sympy.zeros(C.rows, B.cols)))


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("seed", range(40))
def test_rank_and_normal_rank_agree_with_sympy(seed: int, time: str) -> None:
    rng = random.Random(seed)
    system = any_system(
        SeededChoices(f"solvability {seed}"), rng.randint(1, 4), rng.randint(1, 3), time=time
    ).system
    found = setpoint_solvability(system)
    rows = system.n + sum(system.q(i) for i in range(system.m))
    rank = pencil(system, sympy.Integer(int(time == "discrete"))).rank()
    assert (found.rank, found.solvable) == (rank, rank == rows)
    if not found.solvable:
        normal = max(pencil(system, sympy.Integer(v)).rank() for v in range(11, 17))
        assert found.invariant_zero == (normal == rows)
    else:
        assert found.invariant_zero is None
    verdict = check_document(encode(found).encode())
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("seed", range(20))
def test_solvable_is_joint_controllability_of_the_plant_with_integrators(
    seed: int, time: str
) -> None:
    system = any_system(SeededChoices(f"integrators {seed}"), 3, 2, time=time).system
    both = joint_controllability(system).controllable and setpoint_solvability(system).solvable
    assert joint_controllability(setpoint_system(system)).controllable == both


def test_the_combination_holds_for_every_equilibrium() -> None:
    plant = MultiChannelSystem([[-1, 1], [0, -2]], [[[1], [1]]], [[[1, 0], [0, 1], [1, 1]]])
    found = setpoint_solvability(plant)
    assert not found.solvable
    A, B = as_sympy(plant.A), as_sympy(plant.input_matrix())
    C = as_sympy(plant.output_matrix())
    equilibrium = C * A.inv() * B
    assert found.combinations.nrows == 2
    assert (as_sympy(found.combinations) * equilibrium).is_zero_matrix


def test_an_uncontrollable_integrator_leaves_every_combination_open() -> None:
    plant = MultiChannelSystem([[0, 0], [0, -1]], [[[0], [1]]], [[[1, 1]]])
    found = setpoint_solvability(plant)
    assert not found.solvable
    assert found.combinations.nrows == 0


@pytest.mark.parametrize(
    ("states", "inputs", "outputs"), [(0, 1, 2), (3, 0, 1), (12, 1, 2), (12, 3, 5), (6, 4, 6)]
)
def test_more_outputs_than_inputs_are_dependent_at_every_frequency(
    states: int, inputs: int, outputs: int
) -> None:
    rng = random.Random(states)

    def drawn(rows: int, columns: int) -> Matrix:
        table = [[rng.randint(-3, 3) for _ in range(columns)] for _ in range(rows)]
        return Matrix.from_integers(table, ncols=columns)

    plant = MultiChannelSystem(
        drawn(states, states), [drawn(states, inputs)], [drawn(outputs, states)]
    )
    found = setpoint_solvability(plant)
    assert (found.solvable, found.invariant_zero) == (False, False)
    assert check_document(encode(found).encode()).verdict == "VALID"
    row = found.normal
    assert row is not None and len(row.coefficients) <= max(1, states + 1)


def coupled_chains(n: int, m: int, time: str, dependent: bool = False) -> MultiChannelSystem:
    """Chains with a channel from end to end, coupled to the next one; or the last output twice."""
    size, rng = n // m, random.Random(n)
    entries = {(a, a): rng.randint(-9, 9) for a in range(n)}
    entries |= {(a, a - 1): rng.randint(1, 9) for a in range(1, n)}
    entries |= {(a, a + 1): 1 for a in range(n - 1) if (a + 1) % size}
    ends = [size * k + size - 1 for k in range(m)]
    if dependent:
        ends[-1] = ends[0]
    return MultiChannelSystem(
        Matrix.from_entries((n, n), [(i, j, x) for (i, j), x in entries.items() if x]),
        [Matrix.from_entries((n, 1), [(size * k, 0, 1)]) for k in range(m)],
        [Matrix.from_entries((1, n), [(0, a, 1)]) for a in ends],
        time=time,
    )


@pytest.mark.parametrize(
    ("time", "dependent"),
    [
        ("continuous", False),
        ("discrete", False),
        pytest.param("discrete", True, marks=pytest.mark.slow),
    ],
)
def test_large_sparse_plants_are_decided_in_a_band_where_the_rank_is_full(
    time: str, dependent: bool
) -> None:
    system = coupled_chains(136, 4, time, dependent)
    assert system.A.is_sparse
    found = setpoint_solvability(system)
    assert found.solvable is not dependent
    assert found.rank == 140 - dependent
    data = encode(found)
    verdict = check_document(data.encode())
    assert verdict.verdict == "VALID", verdict.line()
    wrong = data.replace('"solvable":true', '"solvable":false')
    if not dependent:
        assert check_document(wrong.encode()).verdict == "INVALID"


def test_ranks_that_are_not_full_are_left_open_where_zeros_cannot_be_written_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(structure, "LARGEST_WRITTEN_OUT", 1000)
    with pytest.raises(LimitReached, match="no rank 140 modulo small primes"):
        setpoint_solvability(coupled_chains(136, 4, "continuous", dependent=True))
    monkeypatch.setattr(structure, "_MOST_IN_BANDS", 100)
    with pytest.raises(LimitReached, match="no narrow band"):
        setpoint_solvability(coupled_chains(136, 4, "continuous"))


def test_two_thousand_states_are_decided_and_checked() -> None:
    found = setpoint_solvability(coupled_chains(2000, 50, "continuous"))
    assert found.solvable
    assert check_document(encode(found).encode()).verdict == "VALID"


def test_the_identity_is_taken_off_in_discrete_time_in_a_band_too() -> None:
    n, end = 136, Matrix.from_entries((136, 1), [(0, 0, 1)])
    for number, solvable in ((-1, True), (1, False)):
        A = Matrix.from_entries((n, n), [(a, a, number) for a in range(n)])
        answer = setpoint_solvability(MultiChannelSystem(A, [end], [end.T], time="discrete"))
        assert answer.solvable is solvable
        assert check_document(encode(answer).encode()).verdict == "VALID"
