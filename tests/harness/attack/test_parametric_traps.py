"""Traps about parameters: what each condition and each short-cut would let pass is false."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from functools import partial, reduce
from itertools import chain
from typing import Any

import pytest

from mcexact import MultiChannelSystem, fixed_spectrum
from mcexact.analysis.parameters.modes import parametric_fixed_spectrum
from mcexact.answer import protocol
from mcexact.checker import parameters
from mcexact.checker.bivariate import characteristic, without
from mcexact.checker.core.arithmetic import cleared, poly_modulo
from mcexact.checker.kinds import check_document
from mcexact.model.system_file import read_parametric_system
from tests.assurance.attack.campaign import judged
from tests.assurance.attack.conditions import GATES, require_one_gate, weakened_checker
from tests.assurance.attack.forgeries.parametric_traps import RANKS, SPECTRA
from tests.assurance.attack.harmless import HARMLESS
from tests.assurance.attack.weakened import Holes, attempt_traps
from tests.oracle.certificates.judge import FALSE

TRAPS = {**SPECTRA, **RANKS}
DIVIDED = ("ℓ divides the denominator of a value", "ℓ divides the denominator of a root of a minor")
NO_UNIT = "the leading coefficient of a resultant is no unit"


@pytest.mark.parametrize("trap", TRAPS)
def test_every_trap_is_false(trap: str) -> None:
    assert judged(TRAPS[trap])[0] == FALSE


@pytest.mark.parametrize("trap", sorted(TRAPS.keys() - {*DIVIDED, NO_UNIT}))
def test_every_trap_is_closed_by_one_condition(trap: str) -> None:
    require_one_gate(TRAPS[trap])


ABOUT_PARAMETERS = {"bivariate.py", "parameters.py"}


def test_every_condition_about_parameters_is_closed_by_a_trap_or_is_harmless() -> None:
    weakened_checker()
    assert {site.file for site in GATES.sites} >= ABOUT_PARAMETERS
    attempt_traps(holes := Holes())
    left = [site.key for k, site in enumerate(GATES.sites) if k not in holes.found]
    GATES.open = None
    assert not [
        key for key in left if key.partition(":")[0] in ABOUT_PARAMETERS and key not in HARMLESS
    ]


def divided_out(ell: int, q: Any, f: Any) -> tuple[int, Any]:
    """The short-cut: f modulo ℓ, divided by q modulo ℓ as often as it goes."""
    f, q, times = poly_modulo(f, ell), poly_modulo(q, ell), 0
    while True:
        rest, quotient = list(f), []
        while len(rest) >= len(q):
            quotient.insert(0, rest[-1])
            shift = len(rest) - len(q)
            rest = [c - rest[-1] * q[k - shift] * (k >= shift) for k, c in enumerate(rest[:-1])]
        if any(c % ell for c in rest) or len(f) < len(q):
            return times, f
        f, times = [c % ell for c in quotient], times + 1


def multiple_modulo(f: Any, ell: int) -> Any:
    """The short-cut: what is left of an integer multiple modulo ℓ, whatever its degree becomes."""
    numbers, _ = cleared([Fraction(c) for c in f])
    return poly_modulo([Fraction(c) for c in numbers], ell)


def divided_characteristic(A: Any, ell: int = 0) -> Any:
    """The short-cut: det(xI − A_G) modulo ℓ without the powers of x, which is generic."""
    found = characteristic(A, ell)
    return reduce(without, [[[], [1]]], found) if ell else found


SHORT_CUTS: list[tuple[str, Any, str, Callable[..., Any]]] = [
    (
        "a value is divided out modulo ℓ, with one that is congruent to it",
        parameters,
        "exponent",
        partial(divided_out, 7),
    ),
    (
        "a value is divided out of a minor modulo ℓ",
        parameters,
        "exponent",
        partial(divided_out, 7),
    ),
    (DIVIDED[0], parameters, "poly_modulo", multiple_modulo),
    (DIVIDED[1], parameters, "poly_modulo", multiple_modulo),
    (NO_UNIT, parameters, "inverse", lambda number, ell: 1),
    (
        "powers of a generic polynomial are divided out modulo ℓ",
        parameters,
        "characteristic",
        divided_characteristic,
    ),
]


@pytest.mark.parametrize(
    ("trap", "module", "name", "short_cut"), SHORT_CUTS, ids=[row[0] for row in SHORT_CUTS]
)
def test_a_short_cut_would_accept_what_is_false(
    trap: str, module: Any, name: str, short_cut: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert check_document(TRAPS[trap]).verdict == "INVALID"
    monkeypatch.setattr(module, name, short_cut)
    found = check_document(TRAPS[trap])
    assert found.verdict == "VALID", found.line()


def test_gains_of_a_companion_matrix_move_what_constant_gains_do_not() -> None:
    """The plant of the trap with [0, 2; 1, 0] for t."""
    zero, one, T = [[0, 0], [0, 0]], [[1, 0], [0, 1]], [[0, 2], [1, 0]]

    def rows(*parts: Any) -> Any:
        return [[*chain(*row)] for part in parts for row in zip(*part, strict=True)]

    restricted = MultiChannelSystem(
        rows((T, zero, zero), (zero, T, one), (zero, one, T)),
        [rows((zero,), (one,), (zero,)), rows((one,), (zero,), (zero,))],
        [rows((one, zero, zero)), rows((zero, one, zero))],
    )
    assert not fixed_spectrum(restricted).factors
    document = SPECTRA["scalars are restricted to a companion matrix"]
    system = {"format": "mcexact-system/1", **document["system"]}
    plant = read_parametric_system(json.dumps(system))
    [exceptional] = protocol.document(parametric_fixed_spectrum(plant))["claim"]["exceptional"]
    assert exceptional["value"] == [-2, 0, 1]
