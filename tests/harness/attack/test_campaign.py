"""A few thousand tries of the campaign, the same ones every time."""

from __future__ import annotations

import ast
import random
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.core import arithmetic
from mcexact.checker.kinds import KINDS, check_document
from mcexact.exact import tables
from tests.assurance.attack.campaign import misstated, run, run_batch
from tests.assurance.attack.forgeries.subjects import other_feedthrough
from tests.assurance.attack.report import Report
from tests.assurance.attack.tries import ORDER, SIZE, batch_numbers, drawn_batch, tries
from tests.checker.handmade import VALID, certificate
from tests.checker.saturation_plants import FALLING, held
from tests.oracle import certificates as oracle
from tests.oracle.certificates import reading as oracle_reading
from tests.oracle.certificates.constructions import CONSTRUCTIONS as KNOWN
from tests.oracle.certificates.judge import KINDS as JUDGED
from tests.oracle.certificates.judge import TRUE, judge
from tests.oracle.drawn.certificates import some_certificate
from tests.oracle.drawn.subjects import CONSTRUCTIONS


def test_nothing_false_is_accepted_and_nothing_true_is_refused() -> None:
    report = run(4000, processes=1)
    assert report.findings == []
    assert report.total("undecided") <= report.total("tries") / 100
    assert report.total("true") > report.total("tries") / 10
    assert report.total("rejected") > report.total("tries") / 4


def test_forgeries_about_feedthrough_are_refused_unless_they_are_true() -> None:
    """D of the other sign, or with two rows or columns exchanged, often changes what is fixed."""
    verdicts: Counter[tuple[bool, bool]] = Counter()
    for seed in range(200):
        rng = random.Random(seed // 2)
        kind = ("fixed_spectrum", "transfer_graph")[seed % 2]
        forgery = some_certificate(rng, kind, "input_filters")
        if "D" in forgery["system"]:
            forgery = other_feedthrough(rng, forgery)
            accepted = check_document(forgery).verdict == "VALID"
            true = judge(forgery)[0] == TRUE
            assert true or not accepted, seed
            verdicts[true, accepted] += 1
    assert verdicts[False, False] > 10 and verdicts[True, True] > 10


def test_the_same_holds_where_matrices_list_their_entries(monkeypatch: pytest.MonkeyPatch) -> None:
    for module, least, share in (
        (arithmetic, "LEAST", "SHARE"),
        (oracle_reading, "LEAST", "SHARE"),
        (tables, "LEAST_SPARSE", "_SHARE"),
    ):
        monkeypatch.setattr(module, least, 2)
        monkeypatch.setattr(module, share, 1)
    report = run(2000, processes=1)
    assert report.findings == []
    assert report.total("true") > report.total("tries") / 10


def test_the_oracle_knows_every_kind_and_every_construction() -> None:
    assert set(JUDGED) == set(KINDS)
    assert set(KNOWN) == set(CONSTRUCTIONS)


@pytest.mark.parametrize(
    "path", sorted(Path(oracle.__path__[0]).glob("*.py")), ids=lambda p: p.stem
)
def test_the_oracle_shares_nothing_with_the_package(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found = [node.module or ""] if not node.level else []
            assert node.level < 2, node.module
        else:
            continue
        assert not any(name.split(".")[0] in ("mcexact", "tests") for name in found), found


@pytest.mark.parametrize("number", [3, 64 * 5 + 17])
def test_a_try_is_repeated_alone(number: int) -> None:
    alone = run_batch(number // SIZE, Report(), number)
    assert alone is not None
    assert alone.number == number
    again = run_batch(number // SIZE, Report(), number)
    assert again == alone


def test_some_kinds_are_tried_alone_by_the_same_numbers() -> None:
    kinds = ("parametric_rank", "setpoint")
    numbers = batch_numbers(3 * SIZE + 1, kinds)
    assert [ORDER[number % len(ORDER)] for number in numbers] == [*kinds, *kinds]
    assert numbers[0] == ORDER.index("parametric_rank")
    assert batch_numbers(1) == [0]


def test_a_batch_is_the_same_every_time() -> None:
    first, second = (list(tries(11, drawn_batch(11))) for _ in range(2))
    assert first == second


@pytest.mark.parametrize("document", VALID.values(), ids=list(VALID))
def test_the_oracle_confirms_certificates_made_by_hand(document: dict[str, Any]) -> None:
    assert judge(document) == (TRUE, "")


def test_every_bound_holds_for_a_plant_that_no_controller_stabilizes() -> None:
    group = {
        "agents": ["b"], "disturbances": [1, 1], "noise": [7], "share": "524183/524288",
        "P": {"exponents": [-7, -7], "entries": [760489, 616700, 626218]},
        "S": {"exponents": [-8, -8], "entries": [1586097, 1787828, 2087100]},
        "F": {"denominator": 262144, "entries": [[-325369, -228038]]},
    }  # fmt: skip
    weights = {"states": [1, 7], "inputs": [1], "disturbances": [1, 1], "noise": [7]}
    unseen = {"name": "b", "B": [[-2], [1]], "C": [[0, 0]]}
    system = {"time": "discrete", "A": [[-1, "-1/2"], [-1, -1]], "channels": [unseen]}
    document = {
        "format": "mcexact-certificate/1", "kind": "cost_bound", "subject": [],
        "system": {**system, "neighbors": {"b": []}},
        "claim": {"weights": weights, "cost": "22559119/2500"}, "witness": {"groups": [group]},
    }  # fmt: skip
    assert check_document(document).verdict == "VALID"
    assert judge(document) == (TRUE, "")


def test_no_bound_of_samples_means_the_unit_circle() -> None:
    report = Report()
    samples = held(FALLING, 6, "-1")
    for bound in (None, 1):
        claim = {"bound": bound, "stable": True}
        made = certificate("stability", FALLING, claim, {"method": "polynomial"}, *samples)
        assert misstated(made, check_document(made), report) == ""
    assert len(report.meanings) == len(report.statements) == 1
