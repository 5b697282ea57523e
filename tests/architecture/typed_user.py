"""A program of a user who checks types: `make lint` reads it with mypy, and a test runs it."""

from fractions import Fraction
from typing import assert_type

import numpy as np
import numpy.typing as npt

import mcexact
from mcexact import (
    Matrix,
    MultiChannelSystem,
    Polynomial,
    analyze,
    check,
    design_decentralized,
    fixed_spectrum,
)
from mcexact.designs import Design
from mcexact.questions import Analysis, FixedSpectrum, Verdict
from mcexact.testing import Drawn, assert_valid, systems


def used() -> str:
    """Use what most programs use, with the types that a reader would expect."""
    plant = MultiChannelSystem(
        A=np.array([[0, 1], [2, 0]]), B=[[[0], [1]]], C=[[["1/2", 0]]], names=["pump"]
    )
    assert_type(plant.A, Matrix)
    assert_type(plant.B[0], Matrix)
    assert_type(plant.C["pump"], Matrix)
    assert_type(plant.B(0), Matrix)
    assert_type(plant.A[0, 1], Fraction)
    assert_type(plant.A[0], tuple[Fraction, ...])
    floats: npt.NDArray[np.float64] = np.array(plant.A, dtype=np.float64)
    spectrum = fixed_spectrum(plant)
    assert_type(spectrum, FixedSpectrum)
    assert_type(spectrum.polynomial, Polynomial)
    assert_type(spectrum.stabilizable, bool)
    assert_type(analyze(plant), Analysis)
    design = design_decentralized(plant, rate=0.5)
    assert_type(design, Design)
    verdict = check(spectrum, plant)
    assert_type(verdict, Verdict)
    assert_type(verdict.valid, bool)
    drawn: type[Drawn] = Drawn
    assert_type(assert_valid(spectrum), str)
    said: str = design.explain()
    return f"{said}\n{floats.sum()} {drawn.__name__} {systems.__name__} {mcexact.__version__}"
