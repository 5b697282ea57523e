"""Manifests with a plant nearby that lacks something: no other rule takes what is about it."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum, pencil_rank
from mcexact.analysis.nearby.allowances import rounding, typed
from mcexact.answer.protocol import document
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.command import verdicts as command_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import NOT_ABOUT, Clock, Expectation
from mcexact.checker.sentences_nearby import last_digit
from mcexact.derived.constructions import dual
from mcexact.exact.polynomial import Polynomial
from mcexact.model.box import Box
from mcexact.model.controller import controller_text
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from mcexact.synthesis.certify import certify_controller
from mcexact.synthesis.decentralized import design_decentralized
from tests.checker.handmade import Document, changed
from tests.checker.manifests import manifest, sentence, write
from tests.checker.recorded import compare, keys
from tests.wording import says

GAIN = [[[-3]], [[0]]]


def plant(a: Any = 1, c: Any = 0, **parts: Any) -> MultiChannelSystem:
    """One state that the first channel controls and measures."""
    return MultiChannelSystem([[a]], [[[1]], [[0]]], [[[1]], [[c]]], **parts)


def loop(system: MultiChannelSystem, gains: Any = GAIN, **asked: Any) -> Document:
    """The certificate about the loop of a plant with constant gains."""
    return document(certify_controller(system, local_controllers(system, gains), **asked))


def verdicts(
    folder: Path, given: Document, near: Document, rule: str, nearby: Any = ("near.json",)
) -> list[Any]:
    """The verdicts where a sentence rests on a plant nearby, and on the loop of the given one."""
    evidence = {"given": given, "near": near}
    told = sentence(rule, "near", "given", evidence=evidence)
    listed = manifest(evidence, [told]) | ({"nearby": [*nearby]} if nearby is not None else {})
    write(folder, evidence, listed)
    return [found for _, found in manifest_verdicts(str(folder), Expectation(), Limits())]


STABLE, FAILS, WIDE = plant(), plant(3), Box.absolute(plant(), A=[["1/2"]]).system
PART, RADII = "certify-failing-plant", "certify-failing-plant-radii"
DELAYED = {"1": ["2"]}
ROWS: list[tuple[str, Document, Document, str, str]] = [
    ("a plant whose only moved entry is 3 for 1", loop(STABLE), loop(FAILS), PART, "IMPLIED"),
    ("a rate was asked of the loop", loop(STABLE, rate=1), loop(FAILS), PART, "IMPLIED"),
    ("the radius of the entry is 1/2", loop(WIDE), loop(FAILS), RADII, "IMPLIED"),
    ("the radii do not matter for parts", loop(WIDE), loop(FAILS), PART, "IMPLIED"),
    ("the loop of the plant nearby is stable", loop(STABLE), loop(plant(2)), PART, "INVALID"),
    ("it is only too slow", loop(STABLE), loop(plant(2), rate=9), PART, "INVALID"),
    ("another controller", loop(STABLE), loop(FAILS, [[[1]], [[0]]]), PART, "INVALID"),
    ("the plant has no radii", loop(STABLE), loop(FAILS), RADII, "INVALID"),
    ("an entry without a radius is moved", loop(WIDE), loop(plant(3, 1)), RADII, "INVALID"),
    ("an entry that is 0 is moved", loop(STABLE), loop(plant(3, 1)), PART, "INVALID"),
    ("another time", loop(STABLE), loop(plant(3, time="discrete")), PART, "INVALID"),
    ("other channels", loop(STABLE), loop(plant(3, names=["a", "b"])), PART, "INVALID"),
    ("another graph", loop(STABLE), loop(plant(3, neighbors=DELAYED)), PART, "INVALID"),
    ("the plant itself, at the distance 0", loop(FAILS), loop(FAILS), PART, "IMPLIED"),
    (
        "another rule, which is about the plant",
        loop(FAILS),
        loop(FAILS),
        "certify-outside",
        "IMPLIED",
    ),
    ("that rule and a plant nearby", loop(STABLE), loop(FAILS), "certify-outside", "INVALID"),
]


@pytest.mark.parametrize(("given", "near", "rule", "verdict"), [row[1:] for row in ROWS])
def test_a_plant_nearby_fails_as_it_is_said(
    tmp_path: Path, given: Document, near: Document, rule: str, verdict: str
) -> None:
    *certificates, found = verdicts(tmp_path, given, near, rule)
    assert {each.verdict for each in certificates} == {"VALID"}
    assert found.verdict == verdict, found.line()


@pytest.mark.parametrize(("given", "rule", "far"), [(STABLE, PART, 2), (WIDE, RADII, 4)])
def test_the_distance_is_computed_from_both_plants(
    tmp_path: Path, given: MultiChannelSystem, rule: str, far: int
) -> None:
    found = verdicts(tmp_path, loop(given), loop(FAILS), rule)[-1]
    assert f"of: the plant {FAILS.digest()}: not every eigenvalue" in found.statement
    assert says(found.statement, "differs plant") and given.digest() in found.statement
    assert f"by at most {far} of the " in found.statement


def test_a_certificate_about_another_plant_is_listed_as_nearby_or_refused(tmp_path: Path) -> None:
    first, second, found = verdicts(tmp_path, loop(STABLE), loop(FAILS), PART, None)
    assert (first.verdict, second.verdict, second.code) == ("VALID", NOT_ABOUT, "system")
    assert (found.verdict, found.code) == ("INVALID", "premise")


def test_plants_nearby_alone_prove_nothing_of_the_plant(tmp_path: Path) -> None:
    both = ("given.json", "near.json")
    for rule in (PART, "certify-states", "certify-outside"):
        found = verdicts(tmp_path, loop(STABLE), loop(FAILS), rule, both)[-1]
        assert (found.verdict, found.code) == ("INVALID", "premise")


def test_what_repeats_data_repeats_none_of_a_plant_nearby(tmp_path: Path) -> None:
    found = verdicts(tmp_path, loop(STABLE), loop(FAILS), "certify-states")[-1]
    assert STABLE.digest() in found.statement and FAILS.digest() not in found.statement


BAD = [
    ("unknown", ["far.json"]),
    ("twice", ["near.json", "near.json"]),
    ("unsorted", ["near.json", "given.json"]),
    ("no name", [1]),
]


@pytest.mark.parametrize("nearby", [names for _, names in BAD])
def test_names_of_what_is_nearby_are_known_and_sorted(tmp_path: Path, nearby: Any) -> None:
    (found,) = verdicts(tmp_path, loop(STABLE), loop(FAILS), PART, nearby)
    assert found.verdict == "MALFORMED"


def test_a_plant_nearby_is_in_a_loop_with_the_controller_that_is_asked_for(tmp_path: Path) -> None:
    near = changed(loop(FAILS), ("subject.0.controller.agents.0.input.outputs.1", [[-2]]))
    verdicts(tmp_path, loop(STABLE), near, PART)
    asked = controller_text(local_controllers(STABLE, GAIN)).encode()
    wanted = Expectation().controlled(asked, Limits())
    found = [each for _, each in manifest_verdicts(str(tmp_path), wanted, Limits())]
    assert [each.verdict for each in found] == ["VALID", NOT_ABOUT, "INVALID"]
    assert found[1].code == "controller"


# Plants nearby of which an answer is another one.


def sums(a: Any, b: Any, shift: Any = 0, *, shown: bool = False, **parts: Any) -> Any:
    """Two states whose sum no input moves if a = b, or that no output shows; its mode is shift."""
    A = [[f"{-a + shift}", "3/4"], [f"{b}", f"{Fraction(-3, 4) + shift}"]]
    columns, rows = [[1], [-1]], [[1, 0]]
    if shown:
        A, columns, rows = [*map(list, zip(*A, strict=True))], [[1], [0]], [[1, -1]]
    return MultiChannelSystem(A, [columns], [rows], **parts)


def ranked(system: MultiChannelSystem, mode: Any, subset: Sequence[str] = ()) -> Document:
    return document(pencil_rank(system, subset, mode))


def spectrum(system: MultiChannelSystem) -> Document:
    return document(fixed_spectrum(system))


def controls(system: MultiChannelSystem) -> Document:
    return document(joint_controllability(system))


def observes(system: MultiChannelSystem) -> Document:
    return document(joint_observability(system))


HALF, OFF, DIGIT = Fraction(1, 2), Fraction(1, 10**13), Fraction("0.00005")
OWN, THERE = sums(HALF, HALF + OFF), sums(HALF, HALF)
SHOWN, HIDDEN = (sums(HALF, HALF + off, shown=True) for off in (OFF, 0))
FAST, STILL = (sums(HALF, HALF + off, Fraction(-2)) for off in (OFF, 0))
SHORT = sums(Fraction("0.5004"), Fraction("0.5003"))
LONG, WRONG = sums(Fraction("0.50035"), Fraction("0.50035")), sums(Fraction("0.5"), HALF)
COARSE = sums(HALF, Fraction("0.49"))


ROWS_OF_PLANTS: list[tuple[str, Document, Document, str, str]] = [
    ("a rounding error", spectrum(OWN), ranked(THERE, 0), "nearby-fixed", "IMPLIED"),
    ("the mode is not stable", spectrum(OWN), ranked(THERE, 0), "nearby-unstable", "IMPLIED"),
    ("no input moves it", controls(OWN), ranked(THERE, 0), "nearby-uncontrollable", "IMPLIED"),
    (
        "no output shows it",
        observes(SHOWN),
        ranked(HIDDEN, 0, ["1"]),
        "nearby-unobservable",
        "IMPLIED",
    ),
    ("of the dual plant", spectrum(OWN), ranked(dual(THERE), 0, ["1"]), "nearby-fixed", "IMPLIED"),
    (
        "the dual plant's outputs",
        controls(OWN),
        ranked(dual(THERE), 0, ["1"]),
        "nearby-uncontrollable",
        "IMPLIED",
    ),
    (
        "half a unit of the last digit",
        spectrum(SHORT),
        ranked(LONG, 0),
        "nearby-unstable-digits",
        "IMPLIED",
    ),
    (
        "said without what the data allow",
        spectrum(SHORT),
        ranked(LONG, 0),
        "nearby-unstable-part",
        "IMPLIED",
    ),
    ("a stable mode", spectrum(FAST), ranked(STILL, -2), "nearby-fixed", "IMPLIED"),
    ("a stable mode is no reason", spectrum(FAST), ranked(STILL, -2), "nearby-unstable", "INVALID"),
    ("no rounding error", spectrum(SHORT), ranked(LONG, 0), "nearby-unstable", "INVALID"),
    (
        "more than half a unit",
        spectrum(SHORT),
        ranked(WRONG, 0),
        "nearby-unstable-digits",
        "INVALID",
    ),
    (
        "two digits count as exact",
        spectrum(COARSE),
        ranked(THERE, 0),
        "nearby-fixed-digits",
        "INVALID",
    ),
    ("a rank of all states", spectrum(OWN), ranked(THERE, 1), "nearby-fixed", "INVALID"),
    (
        "it is controlled",
        controls(OWN),
        ranked(HIDDEN, 0, ["1"]),
        "nearby-uncontrollable",
        "INVALID",
    ),
    ("all outputs are needed", observes(OWN), ranked(THERE, 0), "nearby-unobservable", "INVALID"),
    ("the plant itself lacks it", spectrum(THERE), ranked(THERE, 0), "nearby-fixed", "INVALID"),
    (
        "it is not stabilizable either",
        spectrum(THERE),
        ranked(THERE, 0),
        "nearby-unstable",
        "INVALID",
    ),
    (
        "it is not controlled either",
        controls(THERE),
        ranked(THERE, 0),
        "nearby-uncontrollable",
        "INVALID",
    ),
    ("of another question", observes(OWN), ranked(THERE, 0), "nearby-uncontrollable", "INVALID"),
    (
        "another time",
        spectrum(OWN),
        ranked(sums(HALF, HALF, time="discrete"), 0),
        "nearby-fixed",
        "INVALID",
    ),
    (
        "other channels",
        spectrum(OWN),
        ranked(sums(HALF, HALF, names=["a"]), 0),
        "nearby-fixed",
        "INVALID",
    ),
    ("a zero is moved", spectrum(SHOWN), ranked(THERE, 0), "nearby-fixed-part", "INVALID"),
    (
        "a rule about the plant itself",
        spectrum(OWN),
        spectrum(THERE),
        "not-stabilizable",
        "INVALID",
    ),
]


@pytest.mark.parametrize(
    ("given", "near", "rule", "verdict"),
    [row[1:] for row in ROWS_OF_PLANTS],
    ids=[f"{row[0]}, {row[3]}" for row in ROWS_OF_PLANTS],
)
def test_a_plant_nearby_lacks_what_is_said(
    tmp_path: Path, given: Document, near: Document, rule: str, verdict: str
) -> None:
    *certificates, found = verdicts(tmp_path, given, near, rule)
    assert {each.verdict for each in certificates} == {"VALID"}
    assert found.verdict == verdict, found.line()


LAWS = [
    ("no output shows the vector", HIDDEN, False, 0, ["1"], "law-unobserved", "IMPLIED"),
    ("no input moves the sum", THERE, True, 0, ["1"], "law-uncontrolled", "IMPLIED"),
    ("an output shows it", THERE, False, 0, ["1"], "law-unobserved", "INVALID"),
    ("outputs are left out", HIDDEN, False, 0, [], "law-unobserved", "INVALID"),
    ("inputs are left out", THERE, True, 0, [], "law-uncontrolled", "INVALID"),
    ("of the plant, not of its dual", HIDDEN, False, 0, ["1"], "law-uncontrolled", "INVALID"),
    ("of the dual plant", THERE, True, 0, ["1"], "law-unobserved", "INVALID"),
    (
        "an irrational mode",
        HIDDEN,
        False,
        Polynomial.of(2, 0, 1),
        ["1"],
        "law-unobserved",
        "INVALID",
    ),
]


@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize(
    ("own", "turned", "mode", "subset", "rule", "verdict"),
    [row[1:] for row in LAWS],
    ids=[row[0] for row in LAWS],
)
def test_a_law_is_the_null_space_of_all_channels(
    tmp_path: Path,
    near: bool,
    own: Any,
    turned: bool,
    mode: Any,
    subset: Any,
    rule: str,
    verdict: Any,
) -> None:
    rank = ranked(dual(own) if turned else own, mode, subset)
    evidence = {"given": spectrum(own), "near": rank}
    key = f"nearby-{rule}" if near else rule
    listed = manifest(evidence, [sentence(key, "near", "given", evidence=evidence)])
    write(tmp_path, evidence, listed | ({"nearby": ["near.json"]} if near else {}))
    *_, found = (each for _, each in manifest_verdicts(str(tmp_path), Expectation(), Limits()))
    assert found.verdict == verdict, found.line()
    if verdict == "IMPLIED":
        assert says(found.statement, "null spanned")


def test_how_far_a_plant_is_follows_from_both_plants(tmp_path: Path) -> None:
    found = verdicts(tmp_path, spectrum(SHORT), ranked(LONG, 0), "nearby-fixed-part")[-1]
    part = DIGIT / Fraction("0.5003")
    assert says(found.statement, "absolute value") and f" by at most {part} of" in found.statement
    assert f"the plant {SHORT.digest()}" in found.statement


@pytest.mark.parametrize(
    ("number", "half"),
    [
        ("0.475", "0.0005"), ("12.5", "0.05"), ("0.000001234", "0.0000000005"),
        ("123456.789012", "0.0000005"), ("0.47", None), ("120", None), ("1/3", None),
        ("1234567.8901234", None), ("1e-400", None), ("1.25e-300", "5e-303"),
    ],
)  # fmt: skip
def test_what_the_last_digit_of_a_number_allows(number: str, half: str | None) -> None:
    x = Fraction(number)
    assert last_digit(x) == (x / 10**12 if half is None else Fraction(half))
    assert typed(x) == rounding(x) if half is None else typed(x) == Fraction(half)


@pytest.mark.parametrize("key", keys("nearby"))
def test_a_rule_about_plants_nearby_answers_as_it_did(key: str) -> None:
    compare(key)


FILES = ("given.json", "manifest.json", "near.json")


@pytest.mark.parametrize(
    ("names", "nearby", "system", "gain", "judged"),
    [
        (FILES, ["near.json"], STABLE, -3, {}),
        (("near.json", "given.json"), ["near.json"], STABLE, -3, {"near.json": "system"}),
        (("manifest.json", "near.json"), ["given.json"], STABLE, -3, {"near.json": "system"}),
        (FILES, None, STABLE, -3, {"near.json": "system"}),
        (FILES, ["near.json"], FAILS, -3, {"given.json": "system"}),
        (FILES, ["near.json"], STABLE, -2, {"given.json": "controller", "near.json": "controller"}),
        (FILES, ["near.json", "near.json"], STABLE, -3, {"near.json": "system"}),
    ],
    ids=[
        "beside its manifest",
        "without the manifest",
        "another one is listed",
        "none is listed",
        "only those listed are about other plants",
        "the controller is asked of all",
        "of a malformed manifest nothing is believed",
    ],
)
def test_a_file_beside_its_manifest_may_be_about_a_plant_nearby(
    tmp_path: Path, names: Any, nearby: Any, system: Any, gain: int, judged: Any
) -> None:
    verdicts(tmp_path, loop(STABLE), loop(FAILS), PART, nearby)
    plant_file, controller = tmp_path / "plant.file", tmp_path / "controller.file"
    plant_file.write_text(system_text(system), "utf-8")
    agents = local_controllers(STABLE, [[[gain]], [[0]]])
    controller.write_text(controller_text(agents), "utf-8")
    asking = str(plant_file), str(controller), None
    files = [str(tmp_path / name) for name in names]
    rows = list(command_verdicts(files, None, asking, Limits(), Clock(None)))
    codes = [(Path(about["file"]).name, each.code) for about, each in rows if "file" in about]
    single = [(name, code) for name, code in codes if name != "manifest.json"]
    assert {name: code for name, code in single if code} == judged
    assert len(single) == len({*single}) and {*names} <= {name for name, _ in codes}


class Ending(Clock):
    """A clock whose time is over after the first piece of work."""

    def within(self, work: Any) -> Any:
        try:
            return super().within(work)
        finally:
            self.over = True


def test_after_the_time_is_over_no_manifest_is_read_and_all_is_incomplete(tmp_path: Path) -> None:
    verdicts(tmp_path, loop(STABLE), loop(FAILS), PART)
    plant_file = tmp_path / "plant.file"
    plant_file.write_text(system_text(STABLE), "utf-8")
    files = [str(tmp_path / name) for name in FILES]
    rows = command_verdicts(files, None, (str(plant_file), None, None), Limits(), Ending(60))
    assert [each.code for _, each in rows] == ["time"] * len(FILES)


@pytest.mark.parametrize("uncertain", [False, True])
def test_a_design_says_of_which_plant_nearby_the_loop_is_not_stable(
    tmp_path: Path, uncertain: bool
) -> None:
    given = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    given = Box.absolute(given, A=[["1/100"]], B=[[["1/50"]]]).system if uncertain else given
    design = design_decentralized(given, rate="1/2")
    account = design.account_with(design.every_loop(1))
    rule = RADII if uncertain else PART
    (told,) = (each for each in account.sentences if each.template.key == rule)
    assert {name for name, *_ in told.because} >= {"failing_loop.json"}
    account.save(tmp_path, system_by_digest=True)
    wanted = Expectation().about(system_text(given).encode(), Limits())
    for about, found in manifest_verdicts(str(tmp_path), wanted, Limits()):
        assert found.status == 0, (about, found.line())
