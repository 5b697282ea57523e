"""Every public name is documented, and what public functions return and raise is public."""

import inspect
import pydoc
import re
import sys
import typing

import pytest

import mcexact
from mcexact.answer.protocol import all_kinds
from mcexact.checker.kinds import KINDS as RULES
from mcexact.errors import McexactError
from tests.public import PLACES, PUBLIC, SAID, TOP


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_every_public_name_says_what_it_is(name: str) -> None:
    said = inspect.getdoc(PUBLIC[name])
    assert said, name
    assert len(said.splitlines()[0]) > len(name), name


def test_what_a_public_function_returns_is_public() -> None:
    public = [*PUBLIC.values()]
    for function in filter(inspect.isfunction, public):
        home = PUBLIC | function.__globals__
        found = typing.get_type_hints(function, home)["return"]
        for each in (found, *typing.get_args(found)):
            if getattr(each, "__module__", "").startswith("mcexact."):
                assert each in public, function.__name__


def test_every_error_is_public() -> None:
    errors: set[type] = {McexactError, *McexactError.__subclasses__()}
    errors |= {each for error in errors for each in error.__subclasses__()}
    assert {error.__name__ for error in errors} <= set(PUBLIC)


def test_every_kind_of_answer_is_public() -> None:
    assert set(all_kinds()) == set(RULES)
    assert {kind.__name__ for kind in all_kinds().values()} <= set(PUBLIC)


def test_the_help_of_the_package_names_what_is_at_the_top() -> None:
    listed = re.findall(r"^    ((?:\w+(?:  )?)+)$", SAID, re.M)
    assert sorted(" ".join(listed).split()) == sorted(TOP)
    assert len(TOP) <= 45


def test_a_public_name_has_one_place() -> None:
    places = [each for names in PLACES.values() for each in map(id, names.values())]
    twice = {name for name, value in PUBLIC.items() if places.count(id(value)) > 1}
    assert twice == {"McexactError", "InputError", "LimitReached"}


def test_the_help_of_the_package_fits_two_screens() -> None:
    shown = pydoc.plain(pydoc.render_doc(mcexact))
    assert len(shown.splitlines()) <= 100


@pytest.mark.parametrize("place", sorted(PLACES))
def test_a_public_module_opens_with_its_use(place: str) -> None:
    assert re.search(r"^    (>>> |from )", inspect.getdoc(sys.modules[place]) or "", re.MULTILINE)
