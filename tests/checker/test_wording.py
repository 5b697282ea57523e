"""The text of a sentence has the words of its rule, and the numbers that follow."""

from fractions import Fraction
from pathlib import Path

import pytest

from mcexact.answer import listing
from mcexact.checker.command import main
from mcexact.checker.sentences import RULES
from mcexact.checker.wording import Known, known_numbers, left_open, wordings
from tests.checker.manifests import manifest, sentence, write


def known(*numbers: str) -> Known:
    """What is known if these numbers are cited as a bound, and follow."""
    because = [["a", "/claim/bound", x] for x in numbers]
    return Known(because, [Fraction(x) for x in numbers])


@pytest.mark.parametrize(
    ("part", "numbers", "good", "bad"),
    [
        (["of", "yes", "no"], [], ["yes", "no"], ["maybe", "", "yesno"]),
        (["int", "k"], [], ["0", "17", "-2"], ["", "a", "1.5"]),
        (
            ["count", "k", "state"],
            [],
            ["1 state", "2 states"],
            ["1 states", "2 state", "states", "1"],
        ),
        (["yes", "k"], [], ["yes", "no"], ["maybe", ""]),
        (["any"], [], ["", "x - 1", "the mode 0"], []),
        (["below", "a"], ["2/3"], ["0.666"], ["0.667", "0.65", "6.66", "1e9999", "1/0", "x"]),
        (["above", "a"], ["2/3"], ["0.667"], ["0.666", "0.68", "2"]),
        (["percent below", "a"], ["1/3"], ["33.3 %"], ["33.4 %", "33.3", "3.33 %"]),
        (["percent above", "a"], ["1/3"], ["33.4 %"], ["33.3 %", "34 %"]),
        (["part above", "a"], ["1/3000"], ["0.00034"], ["0.00033", "0.0004"]),
        (["near", "a"], ["1/7"], ["≈0.142857", "1/7"], ["≈0.143", "≈", "1/8"]),
        (
            ["region"],
            ["1/10", "4"],
            ["Re λ < -1/10", "Re λ < 0 and |λ| < 4", "Re λ < about -0.1, |λ| < 1 and x > 4"],
            ["Re λ < -1/9", "Re λ < 1/10", "Re λ < -1", "Re λ", "|λ| < 0", "Re λ < 0/0"],
        ),
        (
            ["maybe", " within ", ["percent below", "a"]],
            ["1/3"],
            ["", " within 33.3 %"],
            [" within"],
        ),
        (
            ["if", "bound", " behind ω = ", ["near", "bound"]],
            ["100"],
            [" behind ω = 100"],
            ["", " behind ω = 10"],
        ),
        (["if", "bound", " behind"], [], [""], [" behind"]),
    ],
    ids=lambda value: value[0] if isinstance(value, list) and value else None,
)
def test_a_field_has_texts_of_its_kind(
    part: list[str], numbers: list[str], good: list[str], bad: list[str]
) -> None:
    for text, wanted in [*((each, True) for each in good), *((each, False) for each in bad)]:
        template = ["a: ", part, " end"]
        told = left_open(f"a: {text} end", template, known(*numbers))
        assert (told is not None) is wanted, text
    assert left_open("b: ", ["a: ", part], known(*numbers)) is None


@pytest.mark.parametrize(
    ("entries", "good", "bad"),
    [
        ([1, 1, 1], ["I", "1 I", "diag(1, 1, 1)"], ["2 I", "diag(1, 1)", "diag(1, 1, 2)", "Ix"]),
        (["1/100", "1/100"], ["1/100 I", "0.01 I"], ["I", "1/10 I", "x I", "diag(1/100)"]),
        ([1, 2], ["diag(1, 2)"], ["I", "diag(2, 1)", "diag()", "diag(1, )"]),
        ([*range(9)], ["diag(0, 1, 2, 6 more)"], ["diag(0, 1, 2, 5 more)"]),
        ([], ["diag()", "I"], ["diag(1)"]),
        (None, [], ["I", "diag(1)"]),
    ],
)
def test_weights_are_those_of_the_certificate(
    entries: object, good: list[str], bad: list[str]
) -> None:
    read = Known([["a", "/claim/weights/states", entries]], [])
    for text, wanted in [*((each, ()) for each in good), *((each, None) for each in bad)]:
        assert left_open(text, [["diagonal", "states"]], read) == wanted, text


@pytest.mark.parametrize(
    ("part", "value", "good", "bad", "open_"),
    [
        (["yes", "k"], True, "yes", "no", "other"),
        (["yes", "k"], False, "no", "yes", "other"),
        (["int", "k"], 3, "3", "4", "other"),
        (["count", "k", "state"], 1, "1 state", "2 states", "other"),
    ],
)
def test_a_value_that_is_cited_is_compared(
    part: list[str], value: object, good: str, bad: str, open_: str
) -> None:
    read = Known([["a", "/claim/k", value], ["a", "/claim/k", "x"]], [])
    assert left_open(good, [part], read) == ()
    assert left_open(bad, [part], read) is None
    assert left_open(bad, [[part[0], open_, *part[2:]]], read) == ((0, len(bad)),)


def test_the_places_of_what_is_not_compared_are_told() -> None:
    template = [
        "modes: ",
        ["any"],
        " (",
        ["of", "yes", "no"],
        "), ",
        ["count", "k", "state"],
        ["int", "k"],
    ]
    text = "modes: x - 1 (no), 3 states7"
    places = left_open(text, template, known())
    assert [text[a:b] for a, b in places or ()] == ["x - 1", "no", "3 states", "7"]
    assert left_open("modes: ", ["modes: ", ["any"]], known()) == ()
    assert left_open("ab", ["a", ["of", "", "b"]], known()) == ((1, 2),)
    assert left_open("a", ["a", ["of", "", "b"]], known()) == ()
    assert left_open("are", [["agree", "is", "are"]], known()) == ()


def test_a_number_longer_than_any_that_is_shown_is_not_compared() -> None:
    long = "0." + "6" * 500
    assert left_open(long, [["below", "a"]], known("2/3")) is None


def test_a_number_is_known_by_its_name_and_from_what_follows() -> None:
    because = [["a", "/claim/margin", "39/25"], ["b", "/claim/margin", 2], ["b", "/x", True]]
    digest = "4" * 64
    least = known_numbers(because, f"{digest} has a disk margin of at least 39/25, every 15")
    assert least.following == [Fraction(39, 25), 15]
    assert least.of("margin") == [Fraction(39, 25)]
    assert (least.of("gains"), known("1/3").of("gains")) == ([15], [])
    assert least.of("ratio") == [Fraction(39, 25), 15]
    assert known_numbers(because, "").of("margin") == [Fraction(39, 25), 2]
    assert known_numbers([["a", "/claim/margin", True]], "7").of("margin") == [7]
    steps = known_numbers([["a", "/subject/0/step", "7/40"], ["b", "/subject/0/step", 15]], "15")
    assert steps.of("step") == [Fraction(7, 40), 15]
    assert left_open("7", [["below", "a"]], known()) == ((0, 1),)
    assert left_open("Re x < -5", [["region"]], known_numbers([], "2")) == ((0, 9),)


def test_every_rule_has_the_template_of_its_sentences() -> None:
    assert wordings().keys() == RULES.keys()
    assert listing.WORDINGS.read_text(encoding="utf-8") == listing.wordings()


@pytest.mark.parametrize(
    ("text", "status"),
    [
        ("", 0),
        ("jointly controllable: every mode", 0),
        ("jointly controllable: every node", 1),
        ("jointly controllable: every mode, also of other plants", 1),
        ("jointly observable: every mode", 1),
    ],
)
def test_a_sentence_with_other_words_is_refused(
    text: str, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = sentence("controllable", "joint_controllability") | {"text": text}
    write(tmp_path, listed=manifest(sentences=[said]))
    assert main([str(tmp_path)]) == status
    assert ("text sentences[0]" in capsys.readouterr().out) is bool(status)
