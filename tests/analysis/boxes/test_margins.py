"""Disk margins of single inputs and outputs for every plant in a box."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mcexact import MultiChannelSystem, check, load_certificate, save_certificate
from mcexact.analysis.boxes.margins import MarginSearch, PortPencil, margin_in_box
from mcexact.analysis.boxes.pencils import ComplexRows
from mcexact.answer.boxes import BoxStability
from mcexact.answer.protocol import encode
from mcexact.boxes import Box, box_disk_margin
from mcexact.designs import local_controllers
from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.loop import closed_loop
from mcexact.performance import disk_margin
from tests.checker.handmade import Document, changed, checked, without
from tests.checker.tables import rejects
from tests.oracle.certificates.judge import FALSE, TRUE, judge
from tests.wording import refusal

PLANT = MultiChannelSystem(
    [[1, "1/2"], ["1/3", -1]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
)
GAINS = local_controllers(PLANT, [[[-4]], [[-2]]])
SAMPLED = MultiChannelSystem(
    [["6/5", "1/10"], [0, "1/2"]],
    [[[1], [0]], [[0], [1]]],
    [[[1, 0]], [[0, 1]]],
    time="discrete",
)
SLOW = local_controllers(SAMPLED, [[["-9/10"]], [["-1/5"]]])
SWINGS = MultiChannelSystem([[0, 1], [-9, "-1/5"]], [[[0], [1]]], [[[1, 0]]])
DAMPS = local_controllers(SWINGS, [[["-3/2"]]])
"""A loop that numbers δ with Re δ = 0 turn unstable before real ones do."""


def written(answer: BoxStability) -> Document:
    """The certificate as plain data."""
    return json.loads(encode(answer))  # type: ignore[no-any-return]


def proved(plant: Any, gains: Any, part: str = "1/20", **options: Any) -> Document:
    """A certificate about a box of relative radii."""
    return written(box_disk_margin(Box.relative(plant, part).system, gains, **options))


CONTINUOUS, OUTPUTS = proved(PLANT, GAINS), proved(PLANT, GAINS, at="outputs")
DISCRETE = proved(SAMPLED, SLOW)
TURNED = proved(SWINGS, DAMPS, "1/1000")
ALL = [CONTINUOUS, OUTPUTS, DISCRETE, TURNED]
MARGIN = "claim.disk.margin"
FRAME = "witness.frames.0"


@pytest.mark.parametrize("certificate", ALL)
def test_a_margin_in_a_box_is_proved_and_is_true(certificate: Document) -> None:
    verdict = checked(certificate)
    assert verdict.verdict == "VALID", verdict.line()
    size = Fraction(certificate["claim"]["disk"]["margin"])
    assert f"disk margin {size}" in verdict.statement
    assert judge(certificate)[0] == TRUE


@pytest.mark.parametrize("certificate", ALL)
def test_a_margin_of_a_box_is_below_that_of_the_plant_and_much_more_is_false(
    certificate: Document,
) -> None:
    size = Fraction(certificate["claim"]["disk"]["margin"])
    assert size > 0
    larger = changed(certificate, (MARGIN, str(min(size * 3 / 2, Fraction(199, 100)))))
    assert checked(larger).verdict == "INVALID"
    assert judge(larger)[0] == FALSE


def test_the_nominal_margin_is_not_exceeded_and_shrinks_with_the_box() -> None:
    nominal = disk_margin(PLANT, GAINS, "inputs").margin
    sizes = [
        box_disk_margin(Box.relative(PLANT, part).system, GAINS).disk.margin  # type: ignore[union-attr]
        for part in ("1/1000", "1/20", "1/5")
    ]
    assert nominal * Fraction(11, 10) > sizes[0] >= sizes[1] > sizes[2] > 0
    assert sizes[0] > nominal * Fraction(8, 10)


def test_real_numbers_alone_would_allow_more() -> None:
    """Every real δ of the disk leaves the loop stable where some complex δ does not."""
    claimed = changed(TURNED, (MARGIN, 1))
    assert checked(claimed).verdict == "INVALID"
    assert judge(claimed)[0] == FALSE
    A, product = np.array([[0, 1], [-9, -0.2]]), np.array([[0, 0], [-1.5, 0]])
    for delta in np.linspace(-1, 1, 41):
        f = (1 + delta / 2) / (1 - delta / 2)
        assert np.linalg.eigvals(A + f * product).real.max() < 0


def exchanged(certificate: Document) -> list[Any]:
    """The weights of the ports in another order, in every frame."""
    return [
        (f"witness.frames.{k}.w", frame["w"][::-1])
        for k, frame in enumerate(certificate["witness"]["frames"])
    ]


def without_last(certificate: Document) -> list[Any]:
    """Without the later half of the border."""
    witness = certificate["witness"]
    half = len(witness["points"]) // 2
    return [
        ("witness.points", witness["points"][:half]),
        ("witness.segments", witness["segments"][: half + ("growth" not in witness)]),
    ]


POINTS = CONTINUOUS["witness"]["points"]
W = CONTINUOUS["witness"]["frames"][0]["w"]
test_what_proves_less_is_refused = rejects(
    [
        ("the margin is 0", CONTINUOUS, (MARGIN, 0), "INVALID"),
        ("the margin is negative", CONTINUOUS, (MARGIN, -1), "INVALID"),
        ("the margin is 2", CONTINUOUS, (MARGIN, 2), "INVALID"),
        ("the margin is larger, sampled", DISCRETE, (MARGIN, "19/10"), "INVALID"),
        ("the ports are others", CONTINUOUS, ("claim.disk.at", "outputs"), "INVALID"),
        ("the ports are others still", OUTPUTS, ("claim.disk.at", "inputs"), "INVALID"),
        ("ports of another name", CONTINUOUS, ("claim.disk.at", "states"), "MALFORMED"),
        ("no margin", CONTINUOUS, ("claim.disk", {"at": "inputs"}), "MALFORMED"),
        ("a disk that is null", CONTINUOUS, ("claim.disk", None), "MALFORMED"),
        ("a port is missing", CONTINUOUS, (f"{FRAME}.w", W[:1]), "MALFORMED"),
        ("a port too many", CONTINUOUS, (f"{FRAME}.w", [*W, W[0]]), "MALFORMED"),
        ("the ports are exchanged", CONTINUOUS, exchanged(CONTINUOUS), "INVALID"),
        ("weights of the loop alone", CONTINUOUS, (f"{FRAME}.w", W[0]), "MALFORMED"),
        ("weights without the signals", CONTINUOUS, (f"{FRAME}.w", [w[:-2] for w in W])),
        ("a weight is 0", CONTINUOUS, (f"{FRAME}.w.0.0", 0), "MALFORMED"),
        ("half of the border", CONTINUOUS, without_last(CONTINUOUS), "INVALID"),
        (
            "the last point is nearer",
            CONTINUOUS,
            (f"witness.points.{len(POINTS) - 1}", str((Fraction(POINTS[-2]) + 7) / 2)),
            "INVALID",
        ),
        (
            "the radii of the box are larger",
            CONTINUOUS,
            ("system.uncertainty.absolute.A.entries.0.2", "1/2"),
            "INVALID",
        ),
        (
            "V is another",
            CONTINUOUS,
            (f"{FRAME}.V", CONTINUOUS["witness"]["frames"][-1]["V"]),
            "INVALID",
        ),
        ("a rate besides", CONTINUOUS, ("claim.bound", "9/10"), "INVALID"),
    ]
)


def test_a_proof_without_the_disk_does_not_prove_it_and_the_reverse() -> None:
    assert checked(without(CONTINUOUS, "claim.disk")).verdict == "MALFORMED"


def test_growth_counts_what_a_port_is_multiplied_by() -> None:
    """|λ| ≤ 1 + 3 for the loop, and 1 + 3·(5/3) with the multiples of α = 1/2."""
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    gain = local_controllers(plant, [[[-3]]])
    made = proved(plant, gain, "1/1000", margin="1/2")
    last = len(made["witness"]["points"]) - 1
    assert Fraction(made["witness"]["points"][last]) > 6
    for k in range(last + 1):
        shorter = changed(made, (f"witness.points.{last}", "5"))
        shorter["witness"]["points"] = [*made["witness"]["points"][:k], "5"]
        shorter["witness"]["segments"] = made["witness"]["segments"][: k + 1]
        verdict = checked(shorter)
        assert verdict.verdict in ("INVALID", "MALFORMED")


def test_without_a_controller_nothing_is_multiplied() -> None:
    stripped = changed(CONTINUOUS, ("subject", []), ("claim.gain_radii", None))
    assert checked(stripped).verdict == "INVALID"


def test_what_is_asked_for_makes_sense() -> None:
    box = Box.relative(PLANT, "1/20").system
    for margin in (0, 2, "-1/2"):
        with pytest.raises(InputError, match="above 0 and below 2"):
            box_disk_margin(box, GAINS, margin=margin)
    with pytest.raises(InputError, match="inputs"):
        box_disk_margin(box, GAINS, at="states")  # type: ignore[arg-type]
    with refusal(LimitReached):
        box_disk_margin(box, GAINS, margin="19/10")


def test_what_is_saved_is_read_back(tmp_path: Path) -> None:
    answer = box_disk_margin(Box.relative(PLANT, "1/20").system, GAINS, margin="1/4")
    save_certificate(answer, tmp_path / "margin.json")
    assert load_certificate(tmp_path / "margin.json") == answer


def test_the_answer_passes_the_check_about_its_plant() -> None:
    box = Box.relative(PLANT, "1/20").system
    assert check(box_disk_margin(box, GAINS, margin="1/4"), box).verdict == "VALID"


def extended_exactly(V: ComplexRows, k: int) -> ComplexRows:
    """The approximate inverse of the pencil of a port, from that of the loop, entry by entry."""
    N, half = V.re.nrows, Fraction(1, 2)
    parts = []
    for M, real in ((V.re, 1), (V.im, 0)):
        rows = [[*row, row[k], row[k]] for row in M.rows()]
        rows += [[Fraction(0)] * (N + 2), list(rows[k])]
        rows[k][N] -= half * real
        rows[k][N + 1] -= real
        rows[N][N] = Fraction(real)
        parts.append(Matrix.from_rows(rows))
    return ComplexRows(*parts)


@pytest.mark.parametrize("at", ["inputs", "outputs"])
@pytest.mark.parametrize(("plant", "gains"), [(PLANT, GAINS), (SAMPLED, SLOW), (SWINGS, DAMPS)])
def test_discs_of_all_ports_hold_where_the_pencils_of_the_ports_say_so(
    plant: MultiChannelSystem, gains: Any, at: Any
) -> None:
    box = Box.relative(plant, "1/1000").system
    search = MarginSearch(closed_loop(box, gains), StabilityRegion(plant.time))
    search.with_disk(at, Fraction(1, 10))
    pencil = search.pencil
    assert isinstance(pencil, PortPencil)
    c = (Fraction(3, 5), Fraction(4, 5))
    discs = pencil.proposal(complex(0.6, 0.8), 0.01, Fraction(1))
    assert discs is not None
    slow = [
        part.tested(extended_exactly(discs.V, k), w, Fraction(1))
        for k, part, w in zip(pencil.ports, pencil.parts, discs.w, strict=True)
    ]
    verdicts = set()
    for rho in (Fraction(x, 200) for x in range(0, 400, 7)):
        expected = all(each.hold(c, rho) for each in slow)
        assert discs.hold(c, rho) == expected
        seems = discs.seem(complex(0.6, 0.8), float(rho))
        assert seems == all(each.seem(complex(0.6, 0.8), float(rho)) for each in slow)
        verdicts.add(expected)
    assert verdicts == {True, False}
    for (fixed, step), each in zip(discs.sums, slow, strict=True):
        assert list(step) == list(each.step)
        assert all(
            abs(x - y) < Fraction(1, 10**6) * (1 + y)
            for x, y in zip(fixed, each.fixed, strict=True)
        )


def test_a_proof_that_takes_the_checker_long_is_not_begun() -> None:
    loop = closed_loop(Box.relative(SAMPLED, "1/20").system, SLOW)
    assert margin_in_box(loop, "inputs", most=200) is not None
    assert margin_in_box(loop, "inputs", most=200, seconds=1e-6) is None
    assert margin_in_box(loop, "inputs", most=2) is None
