"""The way in from python-control."""

from fractions import Fraction

import control
import pytest

from mcexact.errors import InputError
from mcexact.model.statespace import from_statespace


def plant(D=0.0, dt=0):
    """Two states, two inputs and two outputs with labels."""
    return control.ss(
        [[0, 1], [0, -0.1]],
        [[0, 1], [1, 0]],
        [[1, 0], [0, 1]],
        [[0, D], [0, 0]],
        dt,
        inputs=["valve", "pump"],
        outputs=["level", "flow"],
    )


def test_channels_are_split_by_position_or_label():
    by_label = from_statespace(plant(), [["pump"], ["valve"]], [["level"], [1]], rounding="decimal")
    by_position = from_statespace(plant(), [[1], [0]], [[0], [1]], rounding="decimal")
    assert by_label == by_position and by_label.time == "continuous"
    assert by_label.A[1, 1] == Fraction(-1, 10) and by_label.B(0).numerators == ((1,), (0,))
    assert from_statespace(plant(), [[0, 1]], [[]], rounding="dyadic").A[1, 1] == Fraction(-0.1)


@pytest.mark.parametrize(
    ("dt", "time", "sample_time"),
    [
        (0, "continuous", None),
        (None, "continuous", None),
        (True, "discrete", None),
        (0.1, "discrete", Fraction(1, 10)),
    ],
)
def test_the_time_domain_is_taken_over(dt, time, sample_time):
    system = from_statespace(plant(dt=dt), [[0], [1]], [[0], [1]], rounding="decimal")
    assert (system.time, system.sample_time) == (time, sample_time)


@pytest.mark.parametrize(
    ("statespace", "inputs", "outputs", "message"),
    [
        (plant(D=1.0), [[0]], [[0]], "statespace.D: expected D = 0"),
        (control.tf([1], [1, 1]), [[0]], [[0]], "expected a control.StateSpace, found Transfer"),
        (plant(), [["valv"]], [[0]], r"inputs\[0\]: there is no signal 'valv' \(did you mean"),
        (plant(), [[0], [0]], [[0], [1]], r"inputs\[1\]: the signal 0 is used twice"),
        (plant(), [[2]], [[0]], r"inputs\[0\]: expected positions 0 … 1, found 2"),
        (plant(), [[True]], [[0]], r"inputs\[0\]: expected a position or a label, found True"),
        (plant(), [0], [[0]], r"inputs\[0\]: expected a list of signals, found 0; write \[0\]"),
        (plant(), [[0]], ["level"], r"outputs\[0\]: expected a list of signals"),
    ],
)
def test_what_does_not_fit_is_refused(statespace, inputs, outputs, message):
    with pytest.raises(InputError, match=message):
        from_statespace(statespace, inputs, outputs, rounding="decimal")


def test_a_rounding_has_to_be_chosen():
    with pytest.raises(TypeError, match="rounding"):
        from_statespace(plant(), [[0]], [[0]])
