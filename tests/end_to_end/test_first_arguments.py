"""Every public function about a system says how to make one, whatever it gets in its place."""

import inspect
from typing import Any

import pytest

from mcexact.errors import InputError
from tests.public import PUBLIC

ABOUT_SYSTEMS = [
    name
    for name, function in PUBLIC.items()
    if inspect.isfunction(function)
    and next(iter(inspect.signature(function).parameters.values())).annotation
    == "MultiChannelSystem"
]


def test_functions_about_systems_are_recognized_by_their_annotations() -> None:
    assert {"design_observer", "dual"} <= {*ABOUT_SYSTEMS}


@pytest.mark.parametrize("name", ABOUT_SYSTEMS)
@pytest.mark.parametrize("wrong", [[[1, 2], [3, 4]], "plant.json", None], ids=repr)
def test_a_wrong_first_argument_is_named_with_the_right_call(name: str, wrong: Any) -> None:
    function = PUBLIC[name]
    needed = [
        each
        for each in list(inspect.signature(function).parameters.values())[1:]
        if each.default is each.empty and each.kind is each.POSITIONAL_OR_KEYWORD
    ]
    with pytest.raises(InputError) as caught:
        function(wrong, *[None for _ in needed])
    said = str(caught.value)
    assert f"expected a MultiChannelSystem, found {type(wrong).__name__}; make one with" in said
    assert "MultiChannelSystem(A, B, C)" in said and "load_system(file)" in said
