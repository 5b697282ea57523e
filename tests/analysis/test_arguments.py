"""Channels, and answers that are known already, are the same arguments in all decisions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import mcexact
from mcexact import MultiChannelSystem, ParametricSystem
from mcexact.answer.protocol import Answer, encode
from mcexact.boxes import Box
from mcexact.checker.kinds import check_document
from mcexact.errors import InputError, McexactError, UsageError
from tests.public import PUBLIC

PORTS = [[[0], [1]], [[1], [1]]], [[[1, 0]], [[0, 1]]]
PLANT = MultiChannelSystem([[1, 1], [0, -2]], *PORTS)
OTHER = MultiChannelSystem([[1, 1], [0, -3]], *PORTS)
FIXED = MultiChannelSystem([[1, 0], [0, -2]], [[[0], [1]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
SYSTEMS: dict[str, Any] = {
    "plain": PLANT,
    "box": Box.relative(PLANT, "1/1000").system,
    "one": ParametricSystem([["t", 1], [0, -2]], *PORTS, parameters=["t"], assume={"t": (1, 2)}),
    "several": ParametricSystem(
        [["t", "k"], [0, -2]], *PORTS, parameters=["t", "k"], assume={"t": (1, 2), "k": (1, 2)}
    ),
}
BOXES = ("box_controllability", "box_observability")
NO_BOX = {(name, "plain") for name in BOXES}
OF_CHANNELS = (
    "joint_controllability",
    "joint_observability",
    "controllability_indices",
    "observability_indices",
    *BOXES,
)
ASKED = [(name, key) for name in OF_CHANNELS for key in SYSTEMS if (name, key) not in NO_BOX]


def asked(name: str, system: str, channels: Any) -> Any:
    """The answer for some channels, by the function for as many parameters."""
    if system == "several" and not name.startswith("box"):
        decide: Any = mcexact.parameters.exceptional_hypersurfaces
        return decide(SYSTEMS[system], name, channels=channels)
    return PUBLIC[name](SYSTEMS[system], channels)


def of_text(answer: Any) -> str:
    """The certificates of an answer, as one text."""
    if isinstance(answer, Answer):
        return encode(answer)
    if isinstance(answer, tuple):
        return "".join(map(of_text, answer))
    return "".join(map(of_text, answer.certificates.values()))


@pytest.mark.parametrize(("name", "system"), ASKED)
def test_channels_are_a_set_in_the_order_of_the_system(name: str, system: str) -> None:
    whole = of_text(asked(name, system, ["1", "2"]))
    assert of_text(asked(name, system, ["2", "1", "2"])) == whole
    assert of_text(asked(name, system, ["1", "1"])) == of_text(asked(name, system, ["1"])) != whole


@pytest.mark.parametrize(("name", "system"), ASKED)
def test_a_text_or_an_unknown_name_are_no_channels(name: str, system: str) -> None:
    for channels, error in (("12", InputError), ("1", InputError), (5, InputError)):
        with pytest.raises(error):
            asked(name, system, channels)
    with pytest.raises(UsageError):
        asked(name, system, ["1", "7"])


@pytest.mark.parametrize("channels", [["1", "1"], ["2", "1"], ["2"]])
def test_the_checker_accepts_what_is_said_of_channels_within_ranges(channels: list[str]) -> None:
    found = encode(asked("box_controllability", "one", channels))
    assert check_document(found.encode()).verdict == "VALID"


def spectrum(name: str) -> tuple[Callable[..., Any], str, Callable[[Any], Any]]:
    """A function with the fixed spectrum as an argument."""
    return PUBLIC[name], "spectrum", mcexact.fixed_spectrum


KNOWN: dict[str, tuple[Callable[..., Any], str, Callable[[Any], Any]]] = {
    **{
        name: spectrum(name)
        for name in (
            "box_fixed_modes",
            "box_stabilizability",
            "completeness",
            "joint_controllability",
            "joint_observability",
        )
    },
    "assignability": (mcexact.assignability, "graph", mcexact.transfer_graph),
    "box_setpoints": (mcexact.boxes.box_setpoints, "solvability", mcexact.setpoint_solvability),
    "pencil_ranks": (
        lambda system, **known: mcexact.pencil_ranks(system, ["1"], **known),
        "spectrum",
        mcexact.questions.open_loop_spectrum,
    ),
}


@pytest.mark.parametrize("name", KNOWN)
def test_an_answer_that_is_known_is_about_this_system(name: str) -> None:
    function, argument, decide = KNOWN[name]
    box = SYSTEMS["box"] if name.startswith("box") else PLANT
    assert function(box, **{argument: decide(PLANT)}) == function(box)
    with pytest.raises(UsageError):
        function(box, **{argument: decide(OTHER)})
    with pytest.raises(InputError):
        function(box, **{argument: 3})
    with pytest.raises(McexactError):
        function(SYSTEMS["one"], **{argument: decide(PLANT)})


def test_with_a_mode_that_is_fixed_nominally_no_proof_is_searched() -> None:
    box, found = Box.relative(FIXED, "1/1000").system, mcexact.fixed_spectrum(FIXED)
    for function in (mcexact.boxes.box_fixed_modes, mcexact.boxes.box_stabilizability):
        with pytest.raises(mcexact.LimitReached, match="the plant itself"):
            function(box, spectrum=found)
