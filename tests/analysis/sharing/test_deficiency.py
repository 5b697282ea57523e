"""The largest deficiency of all pencils."""

import random
from collections import Counter

import pytest

from mcexact.analysis import sharing as module
from mcexact.analysis.sharing import deficiency
from mcexact.answer import protocol
from mcexact.answer.sharing import ByBlocks
from mcexact.checker.kinds import check_document
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system
from tests.oracle.planted import planted


@pytest.mark.parametrize("multiplicity", range(4))
def test_a_multiple_mode_that_nobody_drives_counts_as_often_as_it_can(multiplicity: int) -> None:
    """A = diag(0, …, 0, 5): the zeros are driven by nobody, 5 is free."""
    n = multiplicity + 1
    A = [[5 * (i == j == multiplicity) for j in range(n)] for i in range(n)]
    unit = [int(i == multiplicity) for i in range(n)]
    system = MultiChannelSystem(A, [[[value] for value in unit]], [[unit]])
    found = deficiency(system)
    assert found.deficiency == multiplicity
    assert (found.channels is None) == (multiplicity == 0)
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"


def test_the_mode_of_largest_deficiency_is_named_with_its_channels() -> None:
    A = [[1, 0, 0], [0, 2, 0], [0, 0, 2]]
    system = MultiChannelSystem(A, [[[0]] * 3], [[[1, 1, 1]]])
    found = deficiency(system)
    assert found.deficiency == 2
    assert str(found.polynomial) == "x - 2"
    assert found.channels == ()


def test_the_evidence_of_large_systems_gives_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    counted: Counter[str] = Counter()
    for number in range(80):
        system = exact(sparse_system(random.Random(number)))
        expected = deficiency(system)
        with monkeypatch.context() as patched:
            patched.setattr(module, "_SMALL", -1)
            found = deficiency(system)
        assert found.claim() == expected.claim()
        assert found.total == expected.total
        assert (found.channels is None) == (found.deficiency == 0)
        assert check_document(protocol.encode(found).encode()).verdict == "VALID"
        counted[f"{type(found.evidence).__name__} {min(found.deficiency, 2)}"] += 1
    assert all(counted[f"ByBlocks {rho}"] > 0 for rho in range(3)), counted
    assert sum(n for name, n in counted.items() if "Completion" in name) < 15, counted


def test_a_mode_of_a_large_sparse_system_loses_one_rank() -> None:
    found = deficiency(planted(600, 60, 1))
    assert found.deficiency == 1
    assert isinstance(found.evidence, ByBlocks)
    assert found.channels == found.about.names[1:]
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"
