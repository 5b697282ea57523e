"""Every exhibit is what it says: floating point answers, and wrongly."""

import pytest

from mcexact.crosscheck.gallery import exhibit, exhibits
from mcexact.crosscheck.table import crosscheck
from mcexact.errors import UsageError


@pytest.mark.parametrize("name", [each.name for each in exhibits()])
def test_floating_point_gives_a_wrong_structural_verdict(name):
    shown = exhibit(name)
    wrong = {row.question: row for row in crosscheck(shown.make()).disagreements}
    assert shown.question in wrong
    assert wrong[shown.question].floating != wrong[shown.question].exact
    assert len(shown.why) > 40


def test_there_are_ten_and_more_most_of_them_published():
    names = [each.name for each in exhibits()]
    assert len(names) == len(set(names)) >= 10


def test_an_unknown_exhibit_is_answered_with_the_nearest():
    with pytest.raises(UsageError, match="compleib-tg1"):
        exhibit("compleib-tg2")
