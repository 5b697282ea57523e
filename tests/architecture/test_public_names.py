"""Every public name is documented, and what public functions return and raise is public."""

import inspect
import typing

import pytest

import mcexact
from mcexact.answer.protocol import all_kinds
from mcexact.checker.kinds import KINDS as RULES
from mcexact.errors import McexactError


@pytest.mark.parametrize("name", sorted(mcexact.__all__))
def test_every_public_name_says_what_it_is(name: str) -> None:
    said = inspect.getdoc(getattr(mcexact, name))
    assert said, name
    assert len(said.splitlines()[0]) > len(name), name


def test_what_a_public_function_returns_is_public() -> None:
    public = [getattr(mcexact, name) for name in mcexact.__all__]
    for function in filter(inspect.isfunction, public):
        home = {name: getattr(mcexact, name) for name in mcexact.__all__} | function.__globals__
        found = typing.get_type_hints(function, home)["return"]
        for each in (found, *typing.get_args(found)):
            if getattr(each, "__module__", "").startswith("mcexact."):
                assert each in public, function.__name__


def test_every_error_is_public() -> None:
    errors: set[type] = {McexactError, *McexactError.__subclasses__()}
    errors |= {each for error in errors for each in error.__subclasses__()}
    assert {error.__name__ for error in errors} <= set(mcexact.__all__)


def test_every_kind_of_answer_is_public() -> None:
    assert set(all_kinds()) == set(RULES)
    assert {kind.__name__ for kind in all_kinds().values()} <= set(mcexact.__all__)
