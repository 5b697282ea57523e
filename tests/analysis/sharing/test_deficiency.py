"""The largest deficiency of all pencils."""

import pytest

from mcexact.analysis.sharing.deficiency import deficiency
from mcexact.answer import codec
from mcexact.checker import check_document
from mcexact.model.system import MultiChannelSystem


@pytest.mark.parametrize("multiplicity", range(4))
def test_a_multiple_mode_that_nobody_drives_counts_as_often_as_it_can(multiplicity: int) -> None:
    """A = diag(0, …, 0, 5): the zeros are driven by nobody, 5 is free."""
    n = multiplicity + 1
    A = [[5 * (i == j == multiplicity) for j in range(n)] for i in range(n)]
    unit = [int(i == multiplicity) for i in range(n)]
    system = MultiChannelSystem(A, [[[value] for value in unit]], [[unit]])
    found = deficiency(system)
    assert found.deficiency == multiplicity
    assert (found.polynomial is None) == (multiplicity == 0)
    assert check_document(codec.encode(found).encode()).verdict == "VALID"


def test_the_mode_of_largest_deficiency_is_named_with_its_channels() -> None:
    A = [[1, 0, 0], [0, 2, 0], [0, 0, 2]]
    system = MultiChannelSystem(A, [[[0]] * 3], [[[1, 1, 1]]])
    found = deficiency(system)
    assert found.deficiency == 2
    assert str(found.polynomial) == "x - 2"
    assert found.channels == ()
