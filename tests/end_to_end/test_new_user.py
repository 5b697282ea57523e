"""What a new user types first, each with what it prints, or the advice that it is answered with."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy

import mcexact
from mcexact import MultiChannelSystem
from mcexact.errors import FloatRefused, InputError, UsageError

PLANT = MultiChannelSystem(
    [[1, "1/2"], [1, -2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], names=["pump", "valve"]
)
DESIGN = mcexact.design_decentralized(PLANT, spectrum=[-1, -2, -3])
ONE = [[[1]]]

PRINTED: dict[str, str] = {
    "np.array(PLANT.A)": "array([[ 1. ,  0.5],\n       [ 1. , -2. ]])",
    "sympy.Matrix(PLANT.A)": "Matrix([\n[1, 1/2],\n[1,  -2]])",
    "PLANT": "MultiChannelSystem(n=2, m=2, continuous time, channels: 'pump', 'valve')",
    "PLANT.A": "Matrix.from_rows([[1, '1/2'], [1, -2]])",
    "PLANT.A.tolist()[0]": "[Fraction(1, 1), Fraction(1, 2)]",
    "PLANT.A / 2": "Matrix.from_rows([['1/2', '1/4'], ['1/2', -1]])",
    "PLANT.B[0]": "Matrix.from_rows([[1], [0]])",
    "PLANT.C['valve']": "Matrix.from_rows([[0, 1]])",
    "PLANT.channels[0]": "Channel('pump', B=Matrix.from_rows([[1], [0]]), "
    "C=Matrix.from_rows([[1, 0]]))",
    "PLANT.neighbors": "None",
    "mcexact.fixed_spectrum(PLANT)": "FixedSpectrum(polynomial=1, factors=(), stabilizable=True, "
    "best_rate=None)",
    "mcexact.questions.open_loop_spectrum(PLANT).polynomial": "Polynomial.of('-5/2', 1, 1)",
    "mcexact.questions.open_loop_spectrum(PLANT).polynomial.to_sympy().as_expr()": "x**2 + x - 5/2",
    "DESIGN": "Design(decentralized, exact, order 1, certified)",
    "DESIGN.controller": "Controller(2 agents, order 1, continuous time)",
    "DESIGN.certificates['closed_loop_spectrum'].polynomial": "Polynomial.of(6, 11, 6, 1)",
    "mcexact.certify_controller(PLANT, DESIGN.controller, rate=0.5).stable": "True",
    "mcexact.StabilityRegion.of('continuous', rate=0.5).bound": "Fraction(1, 2)",
    "mcexact.constructions.c2d(PLANT, 0.5).sample_time": "Fraction(1, 2)",
    "mcexact.simulate(PLANT, DESIGN.controller, initial=[1.0, 0], horizon=0.5)": "Trajectory("
    "2 agents, 201 times from 0 to 1/2, continuous time, float)",
    "float32(0.1, 'decimal')": "Fraction(1, 10)",
    "float32(0.1, 'dyadic')": "Fraction(13421773, 134217728)",
    "MultiChannelSystem.from_float([[0.5, Fraction(1, 3)], [0, 1]], [[[1.0], [0]]], [[[1, 0]]], "
    "rounding='decimal').A": "Matrix.from_rows([['1/2', '1/3'], [0, 1]])",
    "next(mcexact.sweep([mcexact.constructions.Draw(1)])).to_row()['n']": "4",
}


def float32(number: float, rounding: Any) -> Fraction:
    matrix = np.array([[number]], dtype=np.float32)
    return MultiChannelSystem.from_float(matrix, ONE, ONE, rounding=rounding).A[0, 0]


@pytest.mark.parametrize("typed", PRINTED)
def test_what_is_typed_prints(typed: str) -> None:
    names = {"np": np, "sympy": sympy, "mcexact": mcexact, "float32": float32, "Fraction": Fraction}
    names |= {"MultiChannelSystem": MultiChannelSystem, "PLANT": PLANT, "DESIGN": DESIGN}
    assert repr(eval(typed, names)) == PRINTED[typed]


REFUSED: dict[str, tuple[type[Exception], str]] = {
    "mcexact.fixed_spectrum([[1, 2], [3, 4]])": (
        InputError,
        "system: expected a MultiChannelSystem, found list; make one with "
        "MultiChannelSystem(A, B, C), where B and C list a matrix for each channel, or with "
        "load_system(file) or from_statespace(model, …)",
    ),
    "mcexact.check(DESIGN)": (InputError, "found Design; check each of its .certificates.values()"),
    "mcexact.check(mcexact.analyze(PLANT))": (
        InputError,
        "found Analysis; check each of its .decided().values()",
    ),
    "mcexact.simulate(PLANT, DESIGN)": (
        InputError,
        "controller: expected a Controller, found Design; make one with "
        "local_controllers(system, parts) or load_controller(file); a design has it as .controller",
    ),
    "mcexact.save_controller(DESIGN, 'c.json')": (InputError, "a design has it as .controller"),
    "mcexact.save_certificate(DESIGN, 'c.json')": (InputError, "expected an Answer, found Design"),
    "mcexact.sweep(PLANT)": (UsageError, "expected several systems, such as [plant]"),
    "mcexact.designs.local_controllers(PLANT, [np.eye(1), np.eye(1)])": (
        FloatRefused,
        'parts[0].D: a float is not exact: give local_controllers the rounding "decimal"',
    ),
    "mcexact.questions.pencil_rank(PLANT, ['pump'], 1.0)": (
        FloatRefused,
        "mode: a float is not exact",
    ),
    "MultiChannelSystem(np.eye(2), ONE, ONE)": (FloatRefused, "from_float"),
    "MultiChannelSystem([[0, 1], [0, 0]], [[0], [1]], [[1, 0]])": (
        InputError,
        "B: expected a list of matrices, one for each channel, found one matrix: write [B] for one "
        "channel, or from_stacked(A, B, C, sizes) for several",
    ),
    "MultiChannelSystem(PLANT.A, np.array([[1], [0]]), [[[1, 0]]])": (InputError, "write [B]"),
    "PLANT.B['pumb']": (UsageError, "did you mean 'pump'?"),
    "bool(mcexact.check(mcexact.fixed_spectrum(PLANT)))": (TypeError, "ask whether .verdict"),
    "bool(mcexact.fixed_spectrum(PLANT))": (TypeError, "ask for .empty or .stabilizable"),
    "bool(mcexact.certify_controller(PLANT, DESIGN.controller))": (TypeError, "ask for .stable"),
}


@pytest.mark.parametrize("typed", REFUSED)
def test_what_cannot_be_meant_is_answered_with_the_right_advice(typed: str) -> None:
    kind, advice = REFUSED[typed]
    names = {"np": np, "mcexact": mcexact, "PLANT": PLANT, "DESIGN": DESIGN, "ONE": ONE}
    with pytest.raises(kind) as caught:
        eval(typed, names | {"MultiChannelSystem": MultiChannelSystem})
    assert advice in str(caught.value) and "\n" not in str(caught.value)


def test_tab_completion_offers_what_a_user_can_use() -> None:
    found = [mcexact.fixed_spectrum(PLANT), PLANT, PLANT.A, DESIGN, mcexact.analyze(PLANT)]
    for each in found:
        offered = [name for name in dir(each) if not name.startswith("_")]
        assert not {"piece_of_html", "labeled", "made_by"} & set(offered)
    assert "fixed_spectrum" in dir(found[-1])


def test_a_misspelled_question_is_corrected_by_the_interpreter() -> None:
    found = mcexact.analyze(PLANT)
    with pytest.raises(AttributeError) as caught:
        found.fixed_spectum  # noqa: B018
    assert caught.value.name == "fixed_spectum" and caught.value.obj is found
