"""The roles of premises, and what agents receive in the systems they are about."""

from __future__ import annotations

import pytest

from mcexact.checker.core.system import read_plant
from mcexact.checker.sentences import DUAL, HEARD, PLANT, SYSTEM, Path, Premise, Role
from tests.checker.handmade import FREE

AUGMENTED = ("augmented_outputs",)


@pytest.mark.parametrize(
    ("paths", "path", "without", "with_neighbors"),
    [
        (SYSTEM, (), True, False),
        (SYSTEM, AUGMENTED, False, True),
        (DUAL, ("dual",), True, False),
        (DUAL, (*AUGMENTED, "dual"), False, True),
        (PLANT, (), True, True),
        (PLANT, AUGMENTED, False, False),
        (HEARD, (), False, False),
        (HEARD, AUGMENTED, True, True),
    ],
)
def test_a_role_is_played_by_what_agents_receive(
    paths: tuple[Path, ...], path: Path, without: bool, with_neighbors: bool
) -> None:
    system = read_plant(FREE["system"])
    premise = Premise("a.json", FREE, system, system, system, "", path)
    role = Role((FREE["kind"],), paths)
    assert [role.fits(premise, heard) for heard in (False, True)] == [without, with_neighbors]
