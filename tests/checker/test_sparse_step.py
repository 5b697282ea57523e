"""Products with matrices of few entries, and Krylov sequences by them, beside dense ones."""

from __future__ import annotations

import random
from typing import Any

import pytest

from mcexact.checker.core import arithmetic, evidence
from mcexact.checker.core.arithmetic import (
    SMALL,
    Matrix,
    SparseMatrix,
    entries_of,
    logarithms,
    residues,
    within,
)
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.evidence import (
    LONG,
    WHOLE,
    DiagonalStep,
    SparseStep,
    full_diagonals,
    krylov_loop,
    loop_entries,
    residues_by_row,
    split,
)
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System
from tests.checker.handmade import Document, changed, checked
from tests.checker.test_krylov import ACCEPTED, FALSE, REJECTED, spectrum
from tests.checker.test_sparse import drawn, same

MODULI = [2, 3, 7, 31, 33, SMALL, SMALL + 1, 2**19 - 1, 10**20 + 39]


def in_sparse_form(M: Matrix) -> SparseMatrix:
    return SparseMatrix(M.nrows, M.ncols, entries_of(M), M.denominator)


def sparsely(system: System) -> System:
    """The same system, its matrices by their entries."""
    B, C = [[in_sparse_form(M) for M in parts] for parts in (system.B, system.C)]
    return System(system.time, system.names, in_sparse_form(system.A), B, C)  # type: ignore[arg-type]


def products(rows: list[list[int]], u: list[int], ell: int) -> list[int]:
    pairs = [[x * y for y in row] for x, row in zip(u, rows, strict=True)]
    return [sum(row[j] for row in pairs) % ell for j in range(len(u))]


@pytest.mark.parametrize("ell", MODULI)
@pytest.mark.parametrize("n", [0, 1, 2, 5, 9, LONG + 20])
def test_rows_are_multiplied_as_number_by_number(ell: int, n: int) -> None:
    rng = random.Random(n)
    rows = [[rng.choice([0, 0, 0, rng.randrange(ell)]) for _ in range(n)] for _ in range(n)]
    for i in range(min(LONG + 1, n)):
        rows[i][n // 2] = ell - 1  # a column of more entries than are added up in layers
        if i < LONG:
            rows[i][0] = ell - 1
    entries = [(i, j, x) for i, row in enumerate(rows) for j, x in enumerate(row) if x]
    rng.shuffle(entries)
    step = SparseStep(entries, n, ell)
    assert sorted(step.order) == list(range(n))
    for u in ([rng.randrange(ell) for _ in range(n)], [ell - 1] * n, [1] * n, [0] * n):
        found, expected = step.start(u), u
        for _ in range(3):
            assert list(found) == [expected[j] for j in step.order]
            found, expected = step(found), products(rows, expected, ell)
        assert isinstance(found, bytes) == (ell in {2, 3, 7, 31})


@pytest.mark.parametrize("ell", WHOLE)
@pytest.mark.parametrize("n", [1, 4, 12, LONG + 20])
def test_full_diagonals_are_multiplied_as_number_by_number(ell: int, n: int) -> None:
    rng = random.Random(n)
    rows = [[0] * n for _ in range(n)]
    for k in {0, 1, -1, n - 1, 2 - n, n // 3}:
        for i in range(n):
            if 0 <= i - k < n and rng.random() < 0.7:
                rows[i][i - k] = rng.randrange(ell)
    for _ in range(n // 4):
        rows[rng.randrange(n)][rng.randrange(n)] = ell - 1
    for i in range(min(LONG + 1, n)):
        rows[i][n // 2] = 1
    entries = [(i, j, x) for i, row in enumerate(rows) for j, x in enumerate(row) if x]
    step = DiagonalStep(entries, n, ell)
    assert step.diagonals
    assert step.rest or n <= 12
    for u in ([rng.randrange(ell) for _ in range(n)], [ell - 1] * n):
        found, expected = step.start(u), u
        for _ in range(3):
            found, expected = step(found), products(rows, expected, ell)
            assert list(step.residues(found)) == expected


def test_a_diagonal_is_full_from_a_twelfth_of_its_places_on() -> None:
    entries = [(k, k, 1) for k in range(3)] + [(0, 1, 1), (1, 2, 1)]
    assert full_diagonals(entries, 36) == [0]
    assert full_diagonals(entries, 37) == []
    assert full_diagonals(entries, 24) == [-1, 0]


@pytest.mark.parametrize("ell", WHOLE)
@pytest.mark.parametrize("size", [1, 5, 6, 25, 26, 41, 42, 70, 103])
def test_bytes_hold_the_sums_of_any_number_of_diagonals(ell: int, size: int) -> None:
    """Every bit of every entry is set as often as it can be, and every entry of u is ℓ."""
    n = 52
    for x in (ell - 1, ell - 2, ell // 2, 1):
        rows = [[x * (-size <= 2 * (i - j) <= size) for j in range(n)] for i in range(n)]
        entries = [(i, j, y) for i, row in enumerate(rows) for j, y in enumerate(row) if y]
        entries += [(0, 51, 1), (51, 0, ell - 1)] * (size < 70)
        rows[0][51], rows[51][0] = [1, ell - 1] if size < 70 else [rows[0][51], rows[51][0]]
        step = DiagonalStep(entries, n, ell)
        for start in (ell, ell - 1, 1):
            u = int.from_bytes(bytes([start]) * n, "little")
            expected = [start % ell] * n
            for _ in range(4):
                u, expected = step(u), products(rows, expected, ell)
                assert list(step.residues(u)) == expected
                assert max(u.to_bytes(n, "little")) <= ell


@pytest.mark.parametrize("ell", WHOLE)
def test_a_folded_byte_is_the_same_modulo_l(ell: int) -> None:
    step = DiagonalStep([(k, k, 1) for k in range(256)], 256, ell)
    found = step._folded(int.from_bytes(bytes(range(256)), "little")).to_bytes(256, "little")
    assert [x % ell for x in found] == [x % ell for x in range(256)]
    assert 2 * max(found) + step.most * ell <= 255
    assert max(found) + (step.most - step.again) * ell <= step.most * ell <= 255


@pytest.mark.parametrize("ell", [2, 3, 5, 13, 61])
def test_products_are_sums_of_logarithms(ell: int) -> None:
    tables = logarithms(ell)
    assert tables
    for x in range(ell):
        total = tables.packed([x] * ell) + tables.packed(range(ell))
        assert list(tables.products(total, ell)) == [x * y % ell for y in range(ell)]


def test_there_are_no_logarithms_modulo_what_is_not_prime_or_large() -> None:
    assert [ell for ell in range(1, 80) if logarithms(ell) is None] == [
        ell
        for ell in range(1, 80)
        if ell > SMALL or ell < 2 or any(ell % k == 0 for k in range(2, ell))
    ]


def test_one_number_is_multiplied() -> None:
    for ell in MODULI:
        step = SparseStep([(0, 0, ell - 1)], 1, ell)
        assert list(step(step.start([ell - 1]))) == [1]


def test_columns_of_many_entries_are_not_added_up_in_layers() -> None:
    for count, layers in ((LONG, LONG), (LONG + 1, 1)):
        entries = [(i, 3, 1) for i in range(count)] + [(0, 7, 1)]
        step = SparseStep(entries, 50, 7)
        assert (len(step.layers), len(step.long)) == (layers, int(count > LONG))


def test_what_a_step_takes_grows_with_the_entries_and_with_the_diagonals() -> None:
    entries = [(i, i, 1 + i % 3) for i in range(640)] + [(0, 1, 1)]
    assert SparseStep(entries, 640, 31).units == 1000 + 641
    assert SparseStep(entries, 640, 97).units == 1000 + 641 * 4
    assert SparseStep([], 640, 31).units == 1000
    assert DiagonalStep(entries[:-1], 640, 31).units == 1000 + 640 * 5 * 5 // 40
    assert DiagonalStep(entries, 640, 31).units == 2000 + 640 * 5 * 5 // 40 + 160 + 1


def drawn_system(rng: random.Random, n: int) -> tuple[System, list[Matrix]]:
    def integers(r: int, c: int) -> Matrix:
        rows = [[rng.choice([0, 0, 1, -3, 10]) for _ in range(c)] for _ in range(r)]
        return Matrix(rows, c, rng.choice([1, 5]))

    widths = [(rng.randint(0, 2), rng.randint(0, 2)) for _ in range(rng.randint(1, 3))]
    B, C = [integers(n, p) for p, _ in widths], [integers(q, n) for _, q in widths]
    names = [str(k) for k in range(len(widths))]
    gains = [integers(p, q) for p, q in widths]
    return System("discrete", names, integers(n, n), B, C), gains


@pytest.mark.parametrize("seed", range(20))
def test_the_entries_of_a_closed_loop_are_those_of_its_rows(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = random.Random(seed)
    n, ell = rng.randint(1, 5), rng.choice([3, 7, 64, 2**19 - 1])
    system, gains = drawn_system(rng, n)
    assert loop_entries(system, gains, ell) is None
    monkeypatch.setattr(arithmetic, "SHARE", 0)
    assert loop_entries(system, gains, ell) is None
    found = loop_entries(sparsely(system), gains, ell)
    assert found is not None
    rows = [[0] * n for _ in range(n)]
    for i, j, x in found:
        assert x
        rows[i][j] = x
    assert rows == krylov_loop(system, gains, ell)


@pytest.mark.parametrize("seed", range(20))
def test_steps_by_entries_are_those_by_rows(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = random.Random(seed)
    n, ell = rng.randint(1, 5), rng.choice([3, 31, 2**19 - 1])
    system, gains = drawn_system(rng, n)
    b, c = ([rng.choice([0, rng.randrange(ell)]) for _ in range(n)] for _ in range(2))
    by_rows, u, none = evidence._steps(system, gains, ell, b, c)
    monkeypatch.setattr(arithmetic, "SHARE", 0)
    by_entries, v, units = evidence._steps(sparsely(system), gains, ell, b, c)
    entries = loop_entries(sparsely(system), gains, ell) or []
    whole = ell in WHOLE and bool(full_diagonals(entries, n))
    step = DiagonalStep(entries, n, ell) if whole else SparseStep(entries, n, ell)
    assert none == 0
    assert units == step.units + 2 * sum(map(bool, b)) + (n // 20 if whole else 0)
    for _ in range(4):
        if isinstance(step, DiagonalStep):
            assert list(step.residues(v)) == list(u)
        else:
            assert list(v) == [u[j] for j in step.order]
        (u, number), (v, other) = by_rows(u), by_entries(v)
        assert number == other


def test_a_loop_is_sparse_if_no_gain_fills_more_than_an_eighth() -> None:
    n = 48
    A = SparseMatrix(n, n, [(i, i, 1) for i in range(n)])
    for inputs, good in ((15, True), (16, True), (17, False)):
        B = Matrix([[int(i < inputs)] for i in range(n)], 1)
        C = SparseMatrix(1, n, [(0, j, 1) for j in range(15)])
        most = n + 15 * inputs
        assert (8 * most <= n * n) == good
        system = System("discrete", ["1"], A, [B], [C])
        found = loop_entries(system, [Matrix([[0]], 1)], 7)
        assert (found is not None) == good
        if found is not None:
            assert sorted(found) == A.entries  # none of the entries that may be 0


def edited(document: Any, edits: Any, *_: str) -> Document:
    return changed(document, *((edits,) if isinstance(edits[0], str) else edits))


DOCUMENTS = [
    *ACCEPTED,
    *((row[0], edited(row[1], row[2])) for row in REJECTED),
    *((reason, spectrum(system, found)) for reason, system, found, _ in FALSE),
]


@pytest.mark.parametrize(("reason", "document"), DOCUMENTS)
def test_verdicts_do_not_depend_on_the_form(
    reason: str, document: Document, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected, used = checked(document), []
    monkeypatch.setattr(arithmetic, "SHARE", 0)

    def entries(system: System, gains: Any, ell: int) -> Any:
        used.append(system)
        return loop_entries(sparsely(system), gains, ell)

    monkeypatch.setattr(evidence, "loop_entries", entries)
    found = checked(document)
    assert (found.verdict, found.code, found.place) == (
        expected.verdict,
        expected.code,
        expected.place,
    )
    none = ("all modes fixed, and no channel that acts", "no states at all")
    assert used or expected.verdict != "VALID" or reason in none


@pytest.mark.parametrize("seed", range(40))
def test_blocks_do_not_depend_on_the_form(seed: int) -> None:
    rng = random.Random(seed)
    n = rng.randint(1, 5)
    system, _ = drawn_system(rng, n)
    rows = [
        [x if j >= i or rng.random() < 0.1 else 0 for j, x in enumerate(row)]
        for i, row in enumerate(system.A.rows)
    ]
    system = System("discrete", system.names, Matrix(rows, n), system.B, system.C)
    for i, M in enumerate(system.B):
        if rng.random() < 0.6:
            system.B[i] = M.times(0)
    cuts = sorted(rng.sample(range(n + 1), rng.randint(0, min(3, n))))
    parts = [list(range(a, b)) for a, b in zip([0, *cuts], [*cuts, n], strict=True)]
    rng.shuffle(parts)
    listed = [{"states": part, "evidence": None} for part in parts]

    def found(given: System) -> Any:
        try:
            return split(listed, "blocks", given)
        except Refused as refused:
            return refused.args

    dense, entries = found(system), found(sparsely(system))
    assert len(dense) == len(entries)
    for one, other in zip(dense, entries, strict=True):
        if isinstance(one, str):
            assert one == other
            continue
        (where, part, proof), (place, same_part, same_proof) = one, other
        assert (where, proof, part.names) == (place, same_proof, same_part.names)
        assert same(part.A, same_part.A)
        for M, N in zip(part.B + part.C, same_part.B + same_part.C, strict=True):
            assert same(M, N)


@pytest.mark.parametrize("seed", range(10))
def test_parts_and_residues_are_those_of_the_rows(seed: int) -> None:
    rng = random.Random(seed)
    r, c = rng.randint(0, 5), rng.randint(0, 5)
    S, M = drawn(rng, r, c)
    rows = {i: k for k, i in enumerate(sorted(rng.sample(range(r), rng.randint(0, r))))}
    cols = {j: k for k, j in enumerate(sorted(rng.sample(range(c), rng.randint(0, c))))}
    for down in (None, rows):
        for across in (None, cols):
            assert same(within(S, down, across), M.take(down, across))
            assert same(within(M, down, across), M.take(down, across))
            assert isinstance(within(S, down, across), SparseMatrix)
    assert entries_of(S) == entries_of(M)
    assert (
        residues(S, 7) == residues(M, 7) == [(i, j, M.modulo(7)[i][j]) for i, j, _ in entries_of(M)]
    )
    lines = residues_by_row(M, 7)
    assert lines == [[(j, x) for j, x in enumerate(row) if x] for row in M.modulo(7)]
    assert lines == [[(j, x) for j, x in line if x] for line in residues_by_row(S, 7)]


def test_rows_of_residues_leave_out_what_the_modulus_divides() -> None:
    assert residues_by_row(Matrix([[7, 1, 0], [0, 14, -3]], 3), 7) == [[(1, 1)], [(2, 4)]]


def test_what_is_sparse_is_charged() -> None:
    S = SparseMatrix(1000, 1000, [(i, i, 1) for i in range(1000)])
    M = Matrix([[1] * 100] * 10, 100)
    steps: list[Any] = [
        lambda: within(S, None, {1: 0}),
        lambda: within(S, {i: i for i in range(5)}, None),
        lambda: entries_of(M),
        lambda: residues(S, 7),
        lambda: SparseStep(S.entries, 1000, 7),
        lambda: SparseStep([], 1000, 7),
        lambda: DiagonalStep(S.entries, 1000, 7),
        lambda: full_diagonals(S.entries, 1000),
    ]
    for step in steps:
        with limited(Budget(900)), pytest.raises(Refused, match="units of work"):
            step()
    with limited(Budget(2000)), pytest.raises(Refused, match="units of work"):
        entries_of(M)
    system = System("discrete", ["1"], S, [S.take(cols=[0])], [S.take([0])])
    with limited(Budget(150_000)), pytest.raises(Refused, match="units of work"):
        loop_entries(system, [Matrix([[0]], 1)], 7)


def test_all_steps_are_charged_before_the_first_one(monkeypatch: pytest.MonkeyPatch) -> None:
    n = 1000
    A = SparseMatrix(n, n, [(i, (i + 1) % n, 1) for i in range(n)])
    b, c = SparseMatrix(n, 1, [(0, 0, 1)]), SparseMatrix(1, n, [(0, 0, 1)])
    system = System("discrete", ["1"], A, [b], [c])
    monkeypatch.setattr(SparseStep, "__call__", None)
    value = {
        "modulus": 7,
        "gains": [{"denominator": 1, "entries": [[0]]}],
        "channel": "1",
        "inputs": [1],
        "outputs": [1],
        "recurrence": [6] + [0] * (n - 1) + [1],
        "cofactors": [[1], []],
    }
    with limited(Budget(10**6)), pytest.raises(Refused, match="units of work"):
        evidence.unmoved_degree(value, "witness", system)
    monkeypatch.undo()
    assert evidence.LONG == 32
