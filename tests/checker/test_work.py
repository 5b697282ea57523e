"""The work of a check is counted before it is done, and the count is that of the document alone."""

from __future__ import annotations

import hashlib
import json
import re
import threading
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import comb
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, check, fixed_spectrum
from mcexact.checker import kinds
from mcexact.checker.command import verdicts_of
from mcexact.checker.controllers import read_controller_file
from mcexact.checker.core import budget
from mcexact.checker.core.arithmetic import (
    ByteEchelon,
    Echelon,
    Matrix,
    Polynomial,
    characteristic_polynomial,
    cleared,
    poly_divide,
    poly_modulo,
    poly_product,
    product,
    rank,
    stack,
)
from mcexact.checker.core.arithmetic import characteristic_polynomial_modulo as char_modulo
from mcexact.checker.core.budget import GRANTED, MORE, PER_BYTE, Budget, current, limited
from mcexact.checker.core.reach import components
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.roots import in_region, is_hurwitz, is_schur
from mcexact.checker.core.system import read_system_file
from mcexact.checker.kinds import Expectation, check_document
from mcexact.checker.loops import require_spectrum, turned
from mcexact.errors import InputError
from tests import effort
from tests.checker import heavy
from tests.checker.handmade import FIXED, VALID, changed, plant

ENOUGH = Limits(work=10**15)


def data_of(document: Any) -> bytes:
    return json.dumps(document, separators=(",", ":")).encode()


def named(message: str) -> int:
    """The work that a message asks for."""
    return int(message.split("allow ")[1].split()[0])


def half_plane(p: Polynomial) -> bool:
    """Whether all roots are to the left of a rate."""
    return in_region(p, "continuous", Fraction(1, 1000))


# Documents that ask for much work.


@pytest.mark.parametrize("name", heavy.HEAVY)
def test_a_heavy_document_is_small_and_gets_the_verdict_for_it(name: str) -> None:
    data, (verdict, code) = heavy.text(name), heavy.EXPECTED.get(name, ("INCOMPLETE", "work"))
    assert len(data) <= 10_000
    found = check_document(data)
    assert (found.verdict, found.code) == (verdict, code), found.line()
    times = MORE if b'"parameters"' in data else 1
    assert found.spent <= times * (GRANTED + PER_BYTE * len(data))


@pytest.mark.parametrize("name", heavy.HEAVY)
def test_no_more_steps_are_taken_than_are_counted(name: str) -> None:
    data = heavy.text(name)
    allowed = 10**6 + 50 * len(data)
    with effort.at_most(allowed):
        found = check_document(data, limits=Limits(work=allowed))
    assert found.verdict in {"INCOMPLETE", heavy.EXPECTED.get(name, ("", ""))[0]}


@pytest.mark.parametrize("name", heavy.FINISHED)
def test_the_work_that_is_named_suffices(name: str) -> None:
    data = data_of(heavy.FINISHED[name])
    needed = check_document(data, limits=ENOUGH)
    assert needed.code != "work", needed.line()
    for part in (2, 5, 20, 100):
        refused = check_document(data, limits=Limits(work=needed.spent // part))
        assert (refused.verdict, refused.code) == ("INCOMPLETE", "work")
        again = check_document(data, limits=Limits(work=named(refused.message)))
        assert again == needed


@pytest.mark.parametrize("kind", VALID)
def test_the_work_that_is_named_decides_a_certificate_of_each_kind(kind: str) -> None:
    data = data_of(VALID[kind])
    needed = check_document(data, limits=ENOUGH).spent
    for part in (2, 5, 20, 100):
        refused = check_document(data, limits=Limits(work=needed // part))
        again = check_document(data, limits=Limits(work=named(refused.message)))
        assert again.verdict == "VALID"


@pytest.mark.parametrize(
    ("domain", "subject"),
    [
        ("continuous", [heavy.step("extended", share="states", dimensions=[60])]),
        ("continuous", [heavy.step("full_output", channel="1"), heavy.step("integrators")] * 6),
        ("continuous", [heavy.controlled("continuous", private=60)]),
        ("discrete", [heavy.step("lifted", share="outputs+states", dimensions=[50])]),
    ],
)
def test_the_work_that_is_named_while_the_subject_is_built_decides_what_follows(
    domain: str, subject: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mcexact.checker.core.budget.GRANTED", 0)
    monkeypatch.setattr("mcexact.checker.core.budget.PER_BYTE", 0)
    document = heavy.plant([[0]], heavy.port(1), time=domain, **heavy.heard(1))
    to_build = check_document(data_of(heavy.connected(document, *subject)), limits=ENOUGH).spent
    data = data_of(heavy.stable(document, *subject))
    needed = check_document(data, limits=ENOUGH)
    assert needed.code != "work"
    for most in (to_build // 2, to_build - to_build // 10):
        refused = check_document(data, limits=Limits(work=most))
        assert (refused.verdict, refused.code) == ("INCOMPLETE", "work")
        assert check_document(data, limits=Limits(work=named(refused.message))) == needed


ROUTH = {
    "short at first": [Fraction(comb(60, k) * 3**k) for k in range(61)],
    "long from the start": [Fraction(comb(12, k) * 7 ** (150 * (12 - k))) for k in range(13)],
}
"""(3x + 1)^60, (x + 7^150)^12."""


@pytest.mark.parametrize(
    ("place", "parts"),
    [(is_hurwitz, (2, 3, 5, 10, 20, 50, 100)), (is_schur, (2, 3, 5)), (half_plane, (2, 3, 5))],
)
@pytest.mark.parametrize("name", ROUTH)
def test_the_work_that_is_named_in_rouths_array_suffices(
    place: Callable[[Polynomial], bool], parts: tuple[int, ...], name: str
) -> None:
    p = ROUTH[name] if place is not is_schur else ROUTH[name][::-1]
    reading, ample = (Budget(10**12, 0) for _ in range(2))
    with limited(reading):
        cleared(p)
    with limited(ample):
        found = place(p)
    for part in parts:
        most = max(ample.spent // part, reading.spent)
        with limited(Budget(most, 0)), pytest.raises(Refused) as refused:
            place(p)
        enough = named(refused.value.message)
        assert enough < 200 * ample.spent
        with limited(Budget(enough, 0)):
            assert place(p) == found


def test_no_more_work_is_named_than_any_machine_can_do() -> None:
    name = "an extension by more states than a number can count"
    assert named(check_document(heavy.text(name)).message) == budget.MOST


# The count.


@pytest.mark.parametrize("kind", VALID)
def test_the_count_is_that_of_the_document_and_exactly_what_is_needed(kind: str) -> None:
    data = data_of(VALID[kind])
    first = check_document(data, limits=ENOUGH)
    assert first.verdict == "VALID"
    assert first.spent == check_document(data).spent > 40 * len(data)
    assert check_document(data, limits=Limits(work=first.spent)) == first
    refused = check_document(data, limits=Limits(work=first.spent - 1))
    assert (refused.verdict, refused.code) == ("INCOMPLETE", "work")
    assert named(refused.message) >= first.spent
    assert re.search(r"\(Limits\.work\), about [0-9]+ s$", refused.message)


@pytest.mark.parametrize(
    ("units", "words"),
    [
        (1, "about 1 s"),
        (10**8, "about 4 s"),
        (4 * 10**9 - 1, "about 120 s"),
        (4 * 10**9, "about 3 min"),
        (24 * 10**10 - 1, "about 120 min"),
        (24 * 10**10, "about 3 h"),
        (10**15 // 30 - 1, "about 278 h"),
        (10**15 // 30 + 1, "weeks or more"),
    ],
)
def test_the_time_that_a_check_takes_is_said_in_words(units: int, words: str) -> None:
    with pytest.raises(Refused) as refused:
        Budget(0).spend(units)
    assert refused.value.message.endswith(f" (Limits.work), {words}")


def test_a_document_in_memory_is_granted_as_much_as_its_text() -> None:
    assert check_document(FIXED).verdict == "VALID"
    large = json.loads(heavy.text("a zero of 1400 rows in a controller"))
    assert check_document(large).code == "work"


def test_a_check_in_another_thread_has_a_budget_of_its_own() -> None:
    found = []
    with limited(Budget(10, 10)):
        thread = threading.Thread(target=lambda: found.append(check_document(data_of(FIXED))))
        thread.start()
        thread.join()
        assert check_document(data_of(FIXED)).code == "work"
    assert found[0].verdict == "VALID"
    assert current(None).spent == 0


def test_a_manifest_and_its_certificates_share_one_budget() -> None:
    folder = {f"{k}.json": data_of(document) for k, document in enumerate(VALID.values())}
    digests = {name: sha256(data) for name, data in folder.items()}
    sentence = {"text": "", "rule": "subsystem", "theorem": "", "because": []}
    manifest = {"format": "mcexact-manifest/1", "certificates": digests, "sentences": [sentence]}
    folder[""] = data_of(manifest)

    def verdicts(limits: Limits) -> list[str]:
        return [found.code for _, found in verdicts_of(folder.__getitem__, Expectation(), limits)]

    alone = max(check_document(data).spent for name, data in folder.items() if name)
    assert "work" not in verdicts(Limits())
    assert "work" in verdicts(Limits(work=3 * alone))


def sha256(data: bytes) -> str:
    """The SHA-256 of a file."""
    return hashlib.sha256(data).hexdigest()


def test_a_system_file_is_read_within_a_budget() -> None:
    entries = {"shape": [2**20, 0], "entries": []}
    text = data_of({"format": "mcexact-system/1", "time": "discrete", "A": entries, "channels": []})
    with pytest.raises(Refused, match=r"Limits\.work"):
        read_system_file(text, Limits(work=10**6))


def test_matrices_of_zeros_are_read_at_once_however_large() -> None:
    zeros, none = {"shape": [2**20, 2**20], "entries": []}, {"shape": [0, 2**20], "entries": []}
    system = plant(zeros, *[({"shape": [2**20, 1], "entries": []}, none)] * 50, time="discrete")
    data = data_of({"format": "mcexact-system/1", **system})
    assert read_system_file(data, Limits(work=40 * len(data) + 10**5)).n == 2**20


@pytest.mark.parametrize("sparse", [True, False])
def test_a_controller_file_is_read_within_a_budget(sparse: bool, tmp_path: Path) -> None:
    private: dict[str, Any] = {"private": [[0] * 2048]}
    if sparse:
        private = {"outputs": {"1": {"shape": [2**20, 0], "entries": []}}}
    maps = {"shared_update": {}, "private_update": private, "input": {}}
    agent = {"name": "1", "shared": 0, "private": 2**20 if sparse else 2048, **maps}
    head = {"format": "mcexact-controller/1", "system": "", "time": "discrete"}
    text = data_of({**head, "agents": [agent]})
    if not sparse:
        with pytest.raises(Refused, match=r"Limits\.work"):
            read_controller_file(text, Limits(work=40 * len(text)))
        return
    with pytest.raises(Refused, match=r"Limits\.work"):
        read_controller_file(text, Limits())
    (tmp_path / "controller.json").write_bytes(text)
    system = MultiChannelSystem([[1]], [[[1]]], [[]])
    with pytest.raises(InputError, match="units of work"):
        check(fixed_spectrum(system), controller=tmp_path / "controller.json")


def test_an_expected_claim_is_read_within_a_budget() -> None:
    text = data_of({"kind": "", "claim": {"bound": "1" * 4000}})
    with pytest.raises(Refused, match=r"Limits\.work"):
        Expectation().saying(text, Limits(work=1000))


def test_memory_that_is_not_there_leaves_a_check_open(monkeypatch: pytest.MonkeyPatch) -> None:
    def exhausted(*arguments: object) -> None:
        raise MemoryError

    rule = replace(kinds.KINDS["fixed_spectrum"], check=exhausted)
    monkeypatch.setitem(kinds.KINDS, "fixed_spectrum", rule)
    found = check_document(FIXED)
    assert (found.verdict, found.code) == ("INCOMPLETE", "memory")


# Steps that are charged for.


class Number(int):
    """An integer that must not be computed with: its operations fail."""

    def _refuse(self, *others: object) -> Any:
        raise AssertionError("computed before it was charged for")

    __mul__ = __rmul__ = __add__ = __radd__ = __sub__ = __rsub__ = __mod__ = _refuse
    __floordiv__ = __truediv__ = __pow__ = _refuse


SQUARE = Matrix([[Number(2), Number(3)], [Number(5), Number(7)]], 2)
ROWS: Any = [[Number(2), Number(3)], [Number(5), Number(7)]]
ONE: Any = Number(1)
POLYNOMIAL = [Number(2), Number(3), Number(1)]
CHARGED = {
    "a product": lambda: SQUARE @ SQUARE,
    "a product modulo a number": lambda: product(ROWS, ROWS, 2, 11),
    "a sum": lambda: SQUARE + SQUARE,
    "residues": lambda: SQUARE.modulo(11),
    "a rank": lambda: rank(SQUARE),
    "a row of an echelon form": lambda: Echelon(101).add(ROWS[0]),
    "a row of an echelon form of bytes": lambda: ByteEchelon(11, 2).add([1, 2]),
    "a characteristic polynomial": lambda: characteristic_polynomial(SQUARE),
    "a product of polynomials": lambda: poly_product(POLYNOMIAL, POLYNOMIAL),
    "a division": lambda: poly_divide(POLYNOMIAL, POLYNOMIAL, 11),
    "a rate": lambda: in_region(POLYNOMIAL, "continuous", ONE),
    "Routh's array": lambda: is_hurwitz(POLYNOMIAL),
    "a polynomial moved to the half-plane": lambda: is_schur(POLYNOMIAL),
    "components": lambda: components(3, []),
    "a zero matrix": lambda: Matrix.zeros(1000, 1000),
    "unit rows": lambda: Matrix.unit_rows(1000, 0, 1000),
    "a transpose": lambda: Matrix([], 10**5).T,
}


@pytest.mark.parametrize("step", CHARGED)
def test_a_step_is_charged_before_it_is_done(step: str) -> None:
    with limited(Budget(0, 0)), pytest.raises(Refused, match="units of work"):
        CHARGED[step]()


LONG = Matrix(
    [[7**320 + pow(3 * i + 5, j + 2, 101) for j in range(12)] for i in range(12)], 12, 5**100
)
"""A matrix of 12 × 12 numbers of 30 limbs."""
ELL = 10**270 + 7
FACTORS = [Fraction(c, 3**50) for c in LONG.rows[0]]
STRANGE = [*(Fraction(1, 10**22 + 2 * k + 1) for k in range(60)), Fraction(1)]
"""A polynomial whose sums have a common denominator of 145 limbs."""
LEAST = {
    "a product": (lambda: LONG @ LONG, 12**3 * 58),
    "a sum": (lambda: LONG + LONG, 12**2 * 450),
    "a multiple": (lambda: LONG.times(Fraction(3**50, 7)), 12**2 * 150),
    "residues": (lambda: LONG.modulo(ELL), 12**2 * 300),
    "matrices on each other": (lambda: stack([LONG, LONG], 12), 2 * 12**2 * 150),
    "a rank": (lambda: rank(LONG), 12**2 * 600),
    "a row of an echelon form": (lambda: Echelon(ELL).add(LONG.rows[0]), 12 * 400),
    "a polynomial modulo a number": (lambda: poly_modulo(FACTORS, ELL), 12 * 2000),
    "a characteristic polynomial": (lambda: characteristic_polynomial(LONG), 12**3 * 2500),
    "one modulo a number": (lambda: char_modulo(LONG.rows, ELL), 12**3 * 110),
    "Routh's array": (
        lambda: is_hurwitz([Fraction(comb(60, k) * 3**k) for k in range(61)]),
        60**2 * 360,
    ),
    "a polynomial moved to the disc": (lambda: is_schur(STRANGE[-31:]), 30**2 * 40_000),
    "a polynomial moved by a rate": (
        lambda: in_region(STRANGE, "continuous", Fraction(1)),
        60**2 * 100,
    ),
    "a polynomial turned by a damping ratio": (
        lambda: turned([*FACTORS[:2], Fraction(1)], Fraction(10**300, 10**300 + 1)),
        80_000,
    ),
    "a product of strange denominators": (lambda: poly_product(STRANGE, STRANGE), 60**2 * 2000),
    "a division of strange denominators": (
        lambda: poly_divide(STRANGE, STRANGE[-20:]),
        60 * 20 * 100_000,
    ),
}


@pytest.mark.parametrize("step", LEAST)
def test_a_step_is_charged_for_its_size(step: str) -> None:
    run, least = LEAST[step]
    allowed = Budget(10**12, 0)
    with limited(allowed):
        run()
    assert allowed.spent >= least


@pytest.mark.parametrize("change", [("claim.bound", "1/3"), ("subject", [])])
def test_reading_alone_is_charged_for(change: tuple[str, Any]) -> None:
    data = data_of(changed(FIXED, change))
    assert check_document(data, limits=Limits(work=40 * len(data) - 1)).code == "work"


def test_short_moduli_are_charged_for_by_the_length_of_the_denominators() -> None:
    d, spent = 3**20000, []
    for times in (100, 200):
        allowed = Budget(10**12, 0)
        with limited(allowed):
            moduli = [5**5500] * 3 + [5**10] * times
            require_spectrum(Matrix([[1]], 1, d), [Fraction(-1, d), Fraction(1)], "", moduli)
        spent.append(allowed.spent)
    # the matrix and the polynomial take 3/2 units for each limb, and the denominators 1/4
    steps = 2 * 100 * budget.STEP
    assert 160 * budget.limbs([d]) < spent[1] - spent[0] - steps < 200 * budget.limbs([d])


def test_long_numbers_are_charged_by_the_square_of_their_length() -> None:
    spent = [
        check_document(data_of(changed(FIXED, ("format", "1" * k)))).spent for k in (1000, 4000)
    ]
    assert spent[1] - spent[0] > (4000**2 - 1000**2) // 500


def test_the_work_of_a_loop_is_named_to_its_end() -> None:
    with limited(Budget(1000, 0)), pytest.raises(Refused) as refused:
        for _ in budget.counted(range(50)):
            for _ in budget.counted(range(10)):
                budget.spend(10)
    assert 5000 <= named(refused.value.message) <= 25_000
