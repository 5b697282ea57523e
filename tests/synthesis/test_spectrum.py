"""Prescribed spectra: what is read, and what each mistake is answered with."""

from fractions import Fraction

import numpy as np
import pytest

from mcexact.errors import InputError, UsageError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Request
from mcexact.synthesis.state_feedback import default_polynomial, spectrum_polynomial


@pytest.mark.parametrize(
    ("spectrum", "degree", "expected"),
    [
        ([], 0, [1]),
        ([1], 0, [1]),
        (["-1", "-3/2"], 2, ["3/2", "5/2", 1]),
        ([2, 3, 1], 2, [2, 3, 1]),
        ([{"re": "0", "im": "1/2"}], 2, ["1/4", 0, 1]),
        ([{"re": -1, "im": -2}, -1], 3, [5, 7, 3, 1]),
        (["0", "0", "0"], 3, [0, 0, 0, 1]),
        (["1", "1"], 2, [1, -2, 1]),
        (["1", "1"], 1, [1, 1]),
        (Polynomial.of(4, 1), 1, [4, 1]),
        ([-1.5], 1, ["3/2", 1]),
        ([0.1, 1.0], 1, ["1/10", 1]),
        (["-1+2i"], 2, [5, 2, 1]),
        (["-1-2j", -3], 3, [15, 11, 5, 1]),
        (["1/2-i"], 2, ["5/4", -1, 1]),
        (["i", "2i"], 4, [4, 0, 5, 0, 1]),
        (["1e-1+2.5e+1i"], 2, ["62501/100", "-1/5", 1]),
        (["-1+2i", "-1-2i"], 2, [5, 2, 1]),
        (["-1+2i", "-1+2i"], 4, [25, 20, 14, 4, 1]),
        (["-1+2i", "-1-2i", "-1-2i", "-1+2i"], 4, [25, 20, 14, 4, 1]),
        ([-1 + 2j, "-1-2i", {"re": -1, "im": 2}, -1 - 2j], 4, [25, 20, 14, 4, 1]),
        (np.array([-1 + 2j, -3, -1 - 2j]), 3, [15, 11, 5, 1]),
        (np.array([-1.5, -0.1]), 2, ["3/20", "8/5", 1]),
        (np.array([-0.1], dtype=np.float32), 1, ["1/10", 1]),
        (np.array([2, 3, 1]), 2, [2, 3, 1]),
    ],
)
def test_coefficients_or_roots_become_a_monic_polynomial(spectrum, degree, expected):
    assert spectrum_polynomial(spectrum, degree) == Polynomial.of(*expected)


@pytest.mark.parametrize(
    ("spectrum", "degree", "message"),
    [
        ([-1], 3, "expected 3 numbers"),
        ([{"re": -1, "im": 1}], 3, "a pair counts twice"),
        ([1, 2, 3, 4], 3, "last coefficient 1"),
        ([{"re": -1, "im": 0}, -1], 3, "imaginary part that is not 0"),
        ([{"re": -1}, -1, -1], 3, '{"re": a, "im": b}'),
        ("-1", 1, "expected a list"),
        (Polynomial.of(1, 1), 3, "degree 3, found degree 1"),
        (["x"], 1, "expected an integer"),
        (["1 + 2i"], 2, 'such as "-1+2i" or "1/2-3i"'),
        (["1+2+3i"], 2, 'such as "-1+2i" or "1/2-3i"'),
        (["xi"], 2, "found 'xi'"),
        (["1/0i"], 2, "found '1/0i'"),
        (["9" * 100_000 + "i"], 2, "such as"),
        (["-1+2i", "-1+2i", "-1-2i"], 4, "as many of -1+2i as of its conjugate"),
        ([-1 + 2j], 3, "a pair counts twice"),
        ([float("nan")], 1, "finite"),
        (np.array([[1.0]]), 1, "found ndarray"),
    ],
)
def test_a_wrong_spectrum_says_what_is_right(spectrum, degree, message):
    with pytest.raises(InputError, match="spectrum") as caught:
        spectrum_polynomial(spectrum, degree)
    assert message in str(caught.value)


@pytest.mark.parametrize(("time", "bound"), [("continuous", "5/2"), ("discrete", "1/3")])
@pytest.mark.parametrize("degree", [0, 1, 7])
def test_the_default_meets_its_bound(time, bound, degree):
    region = StabilityRegion(time, Fraction(bound))
    p = default_polynomial(region, degree)
    assert p.degree == degree and p.leading == 1
    assert region.contains_roots_of(p)


def static(time):
    """A plant without states."""
    return MultiChannelSystem([], [[]], [[]], time=time)


@pytest.mark.parametrize(
    ("time", "options"),
    [
        ("continuous", {"radius": 1}),
        ("discrete", {"rate": 1}),
        ("continuous", {"rate": 0}),
        ("continuous", {"rate": -1}),
        ("discrete", {"radius": 0}),
        ("discrete", {"radius": 2}),
        ("discrete", {}),
        ("continuous", {}),
    ],
)
def test_the_wrong_bound_is_wrong_usage(time, options):
    with pytest.raises(UsageError):
        Request.of(static(time), **options)


def test_a_bound_may_be_left_out_beside_a_spectrum():
    assert Request.of(static("continuous"), spectrum=[-1]).region.bound is None
    assert Request.of(static("discrete"), radius="1/2").region.bound == Fraction(1, 2)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"arithmetic": "decimal"}, 'expected "exact" or "float"'),
        ({"arithmetic": "float", "spectrum": [-1]}, "a spectrum needs exact arithmetic"),
        ({"agent": "2"}, "no channel"),
    ],
)
def test_what_no_method_can_do_is_refused_before_any_work(options, message):
    with pytest.raises(UsageError, match=message):
        Request.of(static("continuous"), rate=1, **options)
