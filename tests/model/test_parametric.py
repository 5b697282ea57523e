"""Systems with parameters: what they accept, their values, their files and their digests."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from sympy import Float, Matrix, Symbol, sin, sqrt, symbols

from mcexact import (
    MultiChannelSystem,
    ParametricSystem,
    gallery,
    load_system,
    minimal_communication,
    save_system,
)
from mcexact.errors import FloatRefused, InputError, LimitReached, UsageError
from mcexact.model.system_file import read_parametric_system
from mcexact.parameters import load_parametric_system
from tests.wording import refusal, says

t, a, b = symbols("t a b")


def scalar(entry: Any, parameters: Any = (t,), **options: Any) -> ParametricSystem:
    """A system of one state with an entry in A."""
    return ParametricSystem([[entry]], [[[1]]], [[[1]]], parameters=parameters, **options)


EQUAL = {
    "1/2 + 3*t^2": Fraction(1, 2) + 3 * t**2,
    "-t^2": -(t**2),
    "2 - 3 - t": -1 - t,
    "12/2/3*t": 2 * t,
    "(1 + t)^3": (1 + t) ** 3,
    "0.25*t": t / 4,
    "1e-3": Fraction(1, 1000),
    "-1/3": Fraction(-1, 3),
    "(t^2 - 1)/(t - 1)": t + 1,
    " ( t ) ": t,
    "t^0": 1,
    "((((t))))/(2*t + 4)": t / (2 * t + 4),
}


@pytest.mark.parametrize("text", EQUAL)
def test_a_text_and_an_expression_of_sympy_are_the_same_entry(text: str) -> None:
    assert scalar(text) == scalar(EQUAL[text])
    assert scalar(text).digest() == scalar(EQUAL[text]).digest()


@pytest.mark.parametrize("text", EQUAL)
def test_the_canonical_text_of_an_entry_is_read_as_itself(text: str) -> None:
    [[entry]] = scalar(text).canonical_document()["A"]
    assert scalar(entry).canonical_document()["A"] == [[entry]]


REFUSED: dict[Any, str] = {
    "": "its end",
    "t t": "expected an operator",
    "2t": "expected an operator",
    "t**2": "expected a number",
    "2*-t": "expected a number",
    "+t": "expected a number",
    "t^-1": "expected an exponent",
    "t^2^2": "expected an operator",
    "t^1001": "degree 1001",
    "(t^100)^100": "degree 10000",
    "t^9999999999": "at most 9 digits",
    "1e2*t": "expected an operator",
    "(t": "expected ')'",
    "t)": "expected an operator",
    "u": "unknown parameter 'u'",
    "1/(t - t)": "division by 0",
    "t;": "expected a number, a parameter or an operator",
    "__import__('os')": "expected a number",
    "(" * 60 + "t" + ")" * 60: "parentheses",
    "t + " * 40000 + "t": "more than",
    sqrt(t): "expected a rational function",
    sin(t): "expected a rational function",
    sqrt(2) * t: "expected a rational function",
    Symbol("u") * t: "'u' is not among the parameters",
}


@pytest.mark.parametrize("entry", REFUSED, ids=lambda entry: str(entry)[:20])
def test_what_is_no_rational_function_of_the_parameters_is_refused(entry: Any) -> None:
    with pytest.raises(InputError, match="A\\[0\\]\\[0\\]") as found:
        scalar(entry)
    assert REFUSED[entry] in str(found.value)


@pytest.mark.parametrize("entry", [0.5, 0.5 * t, Float("0.1") + t])
def test_floats_are_refused_with_the_ways_in(entry: Any) -> None:
    with pytest.raises(FloatRefused, match="Fraction or a string"):
        scalar(entry)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"parameters": []}, "at least one parameter"),
        ({"parameters": ["t", t]}, "none twice"),
        ({"parameters": "t"}, "a list of parameters"),
        ({"parameters": ["x"]}, "another name than 'x'"),
        ({"parameters": ["t", "2u"]}, "a letter"),
        ({"assume": {"u": (0, 1)}}, "unknown parameter 'u'"),
        ({"assume": {t: (1, 0)}}, "1 above 0"),
        ({"assume": {t: (1, 0, 2)}}, "two ends"),
        ({"assume": {t: (0.5, 1)}}, "not exact"),
        ({"names": ["a", "b"]}, "expected 1 names"),
        ({"time": "sampled"}, "sampled"),
    ],
)
def test_options_are_checked(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        scalar("t", **{"parameters": [t], **options})


def test_shapes_are_checked() -> None:
    with pytest.raises(InputError, match="B\\[0\\]: expected 1 row"):
        ParametricSystem([[t]], [[[1], [2]]], [[[1]]], parameters=[t])
    with refusal(InputError, where="C"):
        ParametricSystem([[t]], [[[1]]], [], parameters=[t])


def test_a_system_without_parameters_names_the_one_with_them() -> None:
    with pytest.raises(InputError, match="ParametricSystem"):
        MultiChannelSystem([[t]], [[[1]]], [[[1]]])


def test_the_values_at_a_point_are_those_of_sympy() -> None:
    A = Matrix([[t, 1 / (t + 1)], [t**2 - 3, Fraction(1, 7)]])
    plant = ParametricSystem(A, [[[t], [1]]], [[[0, t / 2]]], parameters=[t])
    found = plant.at({t: "2/3"})
    assert found.A.rows() == ((Fraction(2, 3), Fraction(3, 5)), (Fraction(-23, 9), Fraction(1, 7)))
    assert found.B(0)[0, 0] == Fraction(2, 3)
    assert found.C(0)[0, 1] == Fraction(1, 3)
    with pytest.raises(InputError, match=r"A: .* undefined there"):
        plant.at({t: -1})
    with refusal(InputError):
        plant.at({})
    with pytest.raises(InputError, match="unknown parameter 'u'"):
        plant.at({t: 1, "u": 2})
    assert plant.generic() == plant.generic()
    assert plant.generic(1) != plant.generic()


def test_a_system_that_is_defined_at_no_drawn_point_says_so() -> None:
    points = "*".join(f"(t - {k})" for k in range(3))
    plant = scalar(f"1/({points})")
    assert plant.generic().n == 1
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("mcexact.model.parametric._TRIES", 0)
        with pytest.raises(LimitReached, match="no drawn point"):
            plant.generic()


def test_along_a_line_the_values_are_those_at_its_points() -> None:
    plant = scalar(a * b + 1 / a, [a, b])
    line = plant.along({"a": "1 + s", b: "2*s"}, assume={"s": (0, 1)})
    for s in (0, 2, Fraction(1, 3)):
        assert line.at({"s": s}) == plant.at({a: 1 + s, b: 2 * s})
    assert plant.along({b: 5}, [a]).at({a: 2}) == plant.at({a: 2, b: 5})
    with pytest.raises(InputError, match="undefined there"):
        plant.along({a: 0, b: "s"})


def test_files_are_read_as_they_were_written(tmp_path: Path) -> None:
    plant = ParametricSystem(
        [["t/3", 1], [0, "-1e-2"]],
        [[[1], [t]], [[], []]],
        [[[0, 1]], []],
        parameters=[t],
        assume={t: (None, 5)},
        time="discrete",
        names=["pump", "valve"],
        name="a name",
        source="a source",
    )
    path = tmp_path / "plant.json"
    assert read_parametric_system(json.dumps(plant.to_dict())) == plant
    save_system(plant, path)
    read = load_parametric_system(path)
    assert read == plant
    assert (read.name, read.source, read.ranges) == ("a name", "a source", ((None, 5),))
    assert read.digest() == plant.digest()
    with pytest.raises(InputError, match="load_parametric_system"):
        load_system(path)


DOCUMENT = {
    "format": "mcexact-system/1",
    "time": "continuous",
    "parameters": {"t": {}},
    "A": [["t"]],
    "channels": [{"B": [[1]], "C": {"shape": [1, 1], "entries": [[0, 0, "t^2"]]}}],
}
BROKEN: list[tuple[dict[str, Any], str]] = [
    ({"parameters": []}, "parameters: expected an object"),
    ({"parameters": {}}, "at least one"),
    ({"parameters": {"t": {"from": 1}}}, "unknown key 'from'"),
    ({"parameters": {"t": {"range": [1]}}}, "two ends"),
    ({"parameters": {"t": {"range": [1, 0]}}}, r"^parameters\[t\]\.range: .* 1 above 0"),
    ({"parameters": {"t": {"range": ["t", 1]}}}, "range"),
    ({"parameters": {"x": {}}}, "another name"),
    ({"A": [["t", 1]]}, "square"),
    ({"A": [["t"], [1, 2]]}, "A"),
    ({"A": [[None]]}, "A\\[0\\]\\[0\\]: expected a number, found null"),
    ({"neighbors": {}}, "unknown key 'neighbors'"),
    ({"channels": []}, "at least one channel"),
    ({"channels": [{"B": [[1]], "C": {"shape": [1], "entries": []}}]}, "rows, columns"),
    (
        {"channels": [{"B": [[1]], "C": {"shape": [1, 1], "entries": [[0, 1, 1]]}}]},
        "a position inside 1 × 1",
    ),
]


@pytest.mark.parametrize(("change", "message"), BROKEN)
def test_malformed_files_are_refused(change: dict[str, Any], message: str) -> None:
    assert read_parametric_system(json.dumps(DOCUMENT)).channels[0].C[0, 0]
    with pytest.raises(InputError, match=message):
        read_parametric_system(json.dumps({**DOCUMENT, **change}))


def test_ranges_names_and_entries_change_the_digest() -> None:
    found = [
        scalar("t"),
        scalar("t", assume={t: (0, 1)}),
        scalar("t", assume={t: (0, None)}),
        scalar("u", ["u"]),
        scalar("t", ["t", "u"]),
        scalar("t + 1"),
        scalar("t", names=["a"]),
    ]
    assert len({system.digest() for system in found}) == len(found)
    assert scalar(a * b + a, [b, a]).digest() == scalar(a * b + a, [a, b]).digest()
    assert "t in (-∞, 1]" in repr(scalar("t", assume={t: (None, 1)}))
    assert "t in [0, ∞)" in repr(scalar("t", assume={t: (0, None)}))


def test_a_system_is_shown_in_words_in_html_and_in_latex() -> None:
    plant = ParametricSystem(
        [["gamma1/2", 1], [0, "1/(1 + gamma1)"]],
        [[[1], ["gamma1^2 - 3"]]],
        [[[1, 0]]],
        parameters=["gamma1"],
        assume={"gamma1": (0, 1)},
    )
    assert says(plant.explain(), "functions gamma")
    assert "1/2*gamma1" in plant._repr_html_()
    assert r"\tfrac{1}{2} \gamma_{1}" in plant._repr_latex_()
    assert r"\frac{1}{\gamma_{1} + 1}" in plant._repr_latex_()
    assert repr(plant.B[0]) == "FunctionMatrix([[1], [gamma1^2 - 3]])"


def test_matrices_and_entries_become_those_of_sympy() -> None:
    A = Matrix([[t / (1 + t), a * b - Fraction(1, 3)], [0, t**2]])
    plant = ParametricSystem(A, [[[1], [0]]], [[[1, 0]]], parameters=[t, a, b])
    assert (plant.A.to_sympy() - A).applyfunc(lambda entry: entry.simplify()).is_zero_matrix
    assert Matrix(plant.B[0].to_sympy()) == Matrix([1, 0])


def test_the_gallery_has_plants_with_parameters_by_name() -> None:
    plant = load_parametric_system("gallery:quadruple-tank-parametric")
    assert plant.at({"gamma1": "7/10", "gamma2": "3/5"}) == gallery("quadruple-tank-pminus")
    with pytest.raises(UsageError, match="load_parametric_system"):
        gallery("quadruple-tank-parametric")
    with pytest.raises(InputError, match="without parameters"):
        load_parametric_system("gallery:quadruple-tank-pminus")


def test_a_system_with_parameters_is_written_as_json_alone(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a name that ends"):
        save_system(scalar("t"), tmp_path / "plant.mat")


@pytest.mark.parametrize("entry", ["t", "-k", "a1", "1/2 + 3*t", "t^2"])
def test_a_text_with_letters_names_the_system_with_parameters(entry: str) -> None:
    with pytest.raises(InputError, match="ParametricSystem"):
        MultiChannelSystem([[entry]], [[[1]]], [[[1]]])


def test_what_needs_numbers_says_how_to_give_values() -> None:
    with pytest.raises(InputError, match=r"plant.at\(\{…\}\)"):
        minimal_communication(scalar("t"))  # type: ignore[arg-type]


def test_one_parameter_takes_a_number_alone_and_some_take_values() -> None:
    assert scalar("t^2").at("1/2") == scalar("t^2").at({t: "1/2"})
    two = scalar("a + b", [a, b], assume={b: (0, 1)})
    with pytest.raises(InputError, match="expected a mapping"):
        two.at(1)
    left = two.with_values({a: 2})
    assert isinstance(left, ParametricSystem)
    assert (str(left.A[0, 0]), left.ranges) == ("b + 2", ((0, 1),))
    assert two.with_values({a: 2, b: 1}) == two.at({a: 2, b: 1})


def test_name_and_source_stay_at_values_and_along_lines() -> None:
    plant = scalar("a*t", (a, t), name="two letters", source="made up")
    for made in (plant.at({a: 1, t: 2}), plant.with_values({a: 1}), plant.along({"a": "s", t: 1})):
        assert (made.name, made.source) == ("two letters", "made up")
    assert "two letters" not in json.dumps(plant.along({"a": "s", "t": 1}).document())
