"""Answers about parameters: their words, their display, and what they become in sympy."""

from __future__ import annotations

from sympy import CRootOf, Interval, Poly, Rational, symbols

from mcexact import ParametricSystem, analyze, fixed_spectrum
from mcexact.errors import UsageError
from mcexact.parameters import load_parametric_system
from tests.report.schemas import faults
from tests.wording import says, worded

PLANT = ParametricSystem(
    [["t", 0, 0], [0, "1/(t - 3)", 0], [0, 0, 2]],
    [[[0], ["t^2 - 2"], ["t - 1/2"]]],
    [[[1, 1, 1]]],
    parameters=["t"],
    assume={"t": (0, 1)},
)


def test_rows_say_where_what_is_fixed_and_what_is_out_of_range() -> None:
    found = fixed_spectrum(PLANT)
    where = {row[0]: row[1:] for row in found.rows}
    assert where["every t"] == ("x + (-t^2 + 3*t), divided by t - 3", "")
    assert worded(where["t = 1/2 (in range)"][1])
    [beyond] = [at for at, (what, _) in where.items() if what == "not decided"]
    assert "t^2 - 2 = 0 (t about -1.41421, 1.41421)" in beyond and beyond.endswith("(out of range)")
    assert where["t = 3 (out of range)"] == ("undefined", "a denominator is 0")
    assert found.explain().splitlines() == list(found.words)
    assert "t = 1/2 (in range)" in found._repr_html_()
    assert r"\text{every t}" in found._repr_latex_()


def test_answers_become_polynomials_roots_and_intervals_of_sympy() -> None:
    free = ParametricSystem(
        [["t", 0], [0, 2]], [[["t^3 - 2"], ["2*t - 1"]]], [[[1, 1]]], parameters=["t"]
    )
    found = fixed_spectrum(free).to_sympy()
    x, t = symbols("x t")
    root = CRootOf(x**3 - 2, 0)
    assert found[Rational(1, 2)] == [Poly(x - 2, x, domain="QQ[t]")]
    assert found[root] == [Poly(x - t, x, domain="QQ[t]")] and found[True] == []
    [cubic] = [each for each in fixed_spectrum(free).exceptional if each.value.degree == 3]
    interval = cubic.real[0].to_sympy()
    assert isinstance(interval, Interval) and interval.contains(root) == True  # noqa: E712
    assert sum(disc.to_sympy().is_empty for disc in cubic.roots) == 2


def test_an_analysis_has_all_answers_by_attribute() -> None:
    found = analyze(load_parametric_system("gallery:two-areas-parametric"))
    assert found.fixed_spectrum.exceptional[0].exact == 0
    assert found.joint_controllability.exceptional == ()
    assert "jointly observable: every mode, unless T = 0" in found.explain()
    assert "joint_observability" in dir(found) and "T in [0, 5]" in repr(found)
    assert says(found._repr_html_(), "modes observes")
    checked = found.to_dict() | {"re_checked": {"valid": 13, "open": []}}
    assert faults("analyze-parameters", checked) == []


def test_questions_about_numbers_are_refused_for_letters() -> None:
    import pytest

    with pytest.raises(UsageError, match="without parameters"):
        analyze(PLANT, subset=["1"])  # type: ignore[call-overload]
    with pytest.raises(UsageError, match="no question 'assignability'"):
        analyze(PLANT, ["assignability"])
    with pytest.raises(AttributeError, match="assignability"):
        _ = analyze(PLANT).assignability


def test_modes_say_once_by_what_all_are_divided() -> None:
    words = []
    for names, bottom, gain in ((["t"], "t - 2", 1), (["s", "t"], "s - t", "t")):
        A = [[f"1/({bottom})", 0, 0], [0, f"3/({bottom})", 0], [0, 0, 1]]
        plant = ParametricSystem(A, [[[0], [0], [gain]]], [[[0, 0, 1]]], parameters=names)
        found = [each for each in analyze(plant).explain().splitlines() if "divided" in each]
        assert all(each.count(f", divided by {bottom}") == 1 for each in found)
        words += found
    assert len(words) == 8 and not any(",," in each or ",;" in each for each in words)
