"""Limits of inputs: in Python, in system files, in controller files."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact import (
    Matrix,
    MultiChannelSystem,
    load_controller,
    load_system,
    save_controller,
    save_system,
)
from mcexact.checker.controllers import read_controller_file
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import read_system_file
from mcexact.derived.sampling import c2d, sampled_system
from mcexact.designs import local_controllers
from mcexact.errors import InputError, UsageError
from mcexact.model.controller import read_controller
from mcexact.model.limits import limits_document, limits_in, limits_in_words, read_input_limits
from mcexact.model.system_file import read_system, system_text
from tests.wording import refusal, says

NAMES, COUNTS = ("left", "right"), (2, 1)
HALF = Fraction(1, 2)


def plant(limits: Any = None) -> MultiChannelSystem:
    B = [[[0, 1], [1, 0]], [[1], [0]]]
    return MultiChannelSystem([[0, 1], [0, 0]], B, [[[1, 0]], [[0, 1]]], names=NAMES, limits=limits)


@pytest.mark.parametrize(
    ("given", "limits"),
    [
        ({"left": [[-1, 1], None]}, (((-1, 1), None), (None,))),
        ({0: [None, ["-1/2", 0]], "right": [[0, "0.25"]]}, ((None, (-HALF, 0)), ((0, HALF / 2),))),
        ({}, None),
        ({"right": [None]}, None),
    ],
)
def test_limits_are_read_by_name_or_position_and_written_again(given: Any, limits: Any) -> None:
    read = read_input_limits(given, NAMES, COUNTS)
    assert read == limits
    if read is not None:
        assert read_input_limits(limits_document(read, NAMES), NAMES, COUNTS) == read


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"middle": [[-1, 1]]}, "there is no channel 'middle'"),
        ({2: [[-1, 1]]}, "there is no channel '2'"),
        ({"left": [[-1, 1]]}, "expected 2 pairs"),
        ({"left": [[-1, 1]], 0: [[-1, 1], None]}, "expected 2 pairs|occurs twice"),
        ({"right": [[1, 2]]}, "contain 0"),
        ({"right": [[-2, -1]]}, "contain 0"),
        ({"right": [[1, -1]]}, "contain 0"),
        ({"right": [[0, 0]]}, "contain 0"),
        ({"right": [[-1, 0, 1]]}, "the least and the largest"),
        ({"right": [5]}, "the least and the largest"),
        ({"right": "-1,1"}, "expected 1 pairs"),
        ({"right": [[-0.5, 1]]}, "float"),
        ([[-1, 1]], "by channel"),
    ],
)
def test_limits_that_make_no_sense_are_refused(given: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_input_limits(given, NAMES, COUNTS)


def test_a_plant_keeps_its_limits_and_no_digest_depends_on_them(tmp_path: Path) -> None:
    limited = plant({"left": [[-1, "1/3"], None]})
    assert limited.digest() == plant().digest() and limited == plant()
    assert limited.with_limits(None).limits is None
    assert plant().with_limits({0: [[-1, "1/3"], None]}).limits == limited.limits
    for suffix in ("json", "yaml"):
        save_system(limited, tmp_path / f"plant.{suffix}")
        assert load_system(tmp_path / f"plant.{suffix}").limits == limited.limits
    assert read_system(json.dumps(limited.to_dict())).limits == limited.limits
    with pytest.raises(InputError, match="limits of inputs"):
        save_system(limited, tmp_path / "plant.npz")
    assert "left[1] from -1 to 1/3" in limited.explain()
    assert limits_in_words(limited.limits or (), NAMES) == "left[1] from -1 to 1/3"


def test_the_sampled_plant_has_the_limits_of_the_plant() -> None:
    limited = plant({"right": [[-1, 1]]})
    assert sampled_system(limited, "1/10", 1).limits == limited.limits
    assert c2d(limited, "1/10").limits == limited.limits
    with refusal(UsageError):
        sampled_system(limited, "1/10").with_limits(None)


@pytest.mark.parametrize(
    ("texts", "limits"),
    [
        (["-1,1"], (((-1, 1), (-1, 1)), ((-1, 1),))),
        (["right:0, 1/2", "-1,1"], (((-1, 1), (-1, 1)), ((0, HALF),))),
        (["-1,1", "right:0,0.5"], (((-1, 1), (-1, 1)), ((0, HALF),))),
        ([], None),
    ],
)
def test_the_option_gives_limits_to_all_inputs_or_to_those_of_a_channel(
    texts: list[str], limits: Any
) -> None:
    assert limits_in(texts, NAMES, COUNTS) == limits


@pytest.mark.parametrize("text", ["1", "-1,0,1", "up:-1,1", "-1,x", "1,2"])
def test_an_option_of_another_form_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        limits_in([text], NAMES, COUNTS)


TEXT = system_text(plant({"left": [[-1, "1/3"], None]}))


def accepts(read: Any, refusal: type[Exception]) -> bool:
    """Whether a reader does not refuse."""
    try:
        read()
    except refusal:
        return False
    return True


@pytest.mark.parametrize(
    "limits",
    [
        {"left": [[-1, 1], None]},
        {"right": [["-1/2", 0.5]]},
        {"right": [None]},
        {},
        {"left": [[-1, 1]]},
        {"middle": [[-1, 1]]},
        {"right": [[1, 2]]},
        {"right": [[0, 0]]},
        {"right": [[-1]]},
        {"right": -1},
        {"right": [["x", 1]]},
        [],
        {"0": [[-1, 1], None]},
    ],
)
def test_both_readers_of_system_files_accept_the_same_limits(limits: Any) -> None:
    text = json.dumps(json.loads(TEXT) | {"limits": limits})

    ours = accepts(lambda: read_system(text), InputError)
    assert ours == accepts(lambda: read_system_file(text.encode(), Limits()), Refused)


def test_a_controller_file_keeps_limits_and_anti_windup_gains(tmp_path: Path) -> None:
    single = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    controller = local_controllers(single, [([[-1]], [[1]], [[-2]], [[-3]])])
    saturated = controller.with_saturation(
        (((Fraction(-1), HALF),),), [Matrix.from_rows([["1/3"]])]
    )
    save_controller(saturated, tmp_path / "controller.json")
    read = load_controller(tmp_path / "controller.json")
    assert read.agents[0].limits == ((-1, HALF),)
    assert read.agents[0].back_calculation == Matrix.from_rows([["1/3"]])
    assert says(read.explain(), "cuts corrects")
    assert says(read._repr_html_(), "cut off")
    # certificates about linear loops have the linear program alone
    assert read.document() == controller.document() and read == saturated != controller


def test_limits_and_gains_of_other_shapes_do_not_fit_a_plant() -> None:
    single = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    controller = local_controllers(single, [([[-1]], [[1]], [[-2]], [[-3]])])
    graph = single.with_neighbors({"1": []}).neighbors
    assert graph is not None
    two: Any = (((Fraction(-1), HALF), None),)
    with pytest.raises(InputError, match="expected 1 pairs"):
        controller.with_saturation(two).require_fits(single, graph)
    wide = controller.with_saturation((((Fraction(-1), HALF),),), [Matrix.from_rows([[1, 2]])])
    with pytest.raises(InputError, match="back_calculation"):
        wide.require_fits(single, graph)


@pytest.mark.parametrize(
    "keys",
    [
        {"limits": [[-1, 1]]},
        {"limits": [["-1/2", 0.5]], "back_calculation": [["1/3"]]},
        {"limits": [None]},
        {"back_calculation": [[0]]},
        {"limits": [[-1, 1], None]},
        {"limits": []},
        {"limits": {}},
        {"limits": [[1, 2]]},
        {"limits": [[0, 0]]},
        {"back_calculation": [[1, 2]]},
        {"back_calculation": [[1], [2]]},
        {"back_calculation": []},
        {"back_calculation": [["x"]]},
        {"limits": None},
        {"back_calculation": None},
    ],
)
def test_both_readers_of_controller_files_accept_the_same_limits_and_gains(keys: Any) -> None:
    single = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    document = local_controllers(single, [([[-1]], [[1]], [[-2]], [[-3]])]).to_dict()
    document["agents"][0].update(keys)
    text = json.dumps(document)

    ours = accepts(lambda: read_controller(text), InputError)
    assert ours == accepts(lambda: read_controller_file(text.encode(), Limits()), Refused)


@pytest.mark.parametrize(
    ("texts", "limits"),
    [
        (["-1,1"], (((-1, 1), (-1, 1)), ((-1, 1),))),
        (["left[2]:0,1/2"], ((None, (0, HALF)), (None,))),
        (["left[2]:0,1/2", "-1,1"], (((-1, 1), (0, HALF)), ((-1, 1),))),
        (["left[1]:-2,2", "left:0,1", "right:-1,0"], (((-2, 2), (0, 1)), ((-1, 0),))),
    ],
)
def test_the_closer_of_several_limits_on_the_command_line_holds(
    texts: list[str], limits: Any
) -> None:
    assert limits_in(texts, NAMES, COUNTS) == limits


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["left[3]:0,1"], "the channel 'left' has 2 inputs, from 1 on"),
        (["left[0]:0,1"], "the channel 'left' has 2 inputs, from 1 on"),
        (["lefd[1]:0,1"], "there is no channel 'lefd'"),
        (["left[1]:0,1", "left[1]:0,2"], r"limits of the channel 'left\[1\]' are given twice"),
        (["left:,1"], "expected two numbers"),
    ],
)
def test_limits_on_the_command_line_name_an_input_that_exists(
    texts: list[str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        limits_in(texts, NAMES, COUNTS)


def test_an_agent_may_be_called_like_an_input_of_another_one() -> None:
    assert limits_in(["a[1]:0,1"], ("a", "a[1]"), (1, 1)) == ((None,), ((0, 1),))
