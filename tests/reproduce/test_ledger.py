"""The ledger has every examination, and says no more than is proved."""

from __future__ import annotations

import importlib
import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

from mcexact.checker.kinds import KINDS as CERTIFICATES
from mcexact.errors import UsageError
from mcexact.reproduce.notebook import KINDS, STATUSES, Examination, examinations, statements
from mcexact.reproduce.reproduction import chosen, procedures

PROOFS = Path(__file__).parents[2] / "proofs"
NUMBERED = [
    *(f"Proposition {k}" for k in (1, 2, 3)),
    *(f"Theorem {k}" for k in (1, 2, 3, 4)),
    *(f"Lemma {k}" for k in (1, 2, 3, 4)),
    *(f"Corollary {k}" for k in (1, 2)),
    *(f"Remark {k}" for k in (1, 2)),
]
EVERY = pytest.mark.parametrize("said", examinations(), ids=lambda said: said.key)


def script(name: str) -> ModuleType:
    """A script of the folder of proofs."""
    spec = importlib.util.spec_from_file_location(name, PROOFS / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_numbered_statement_of_the_paper_has_a_row() -> None:
    titles = [said.title for said in examinations() if said.kind == "numbered"]
    assert sorted(titles) == sorted(NUMBERED)


def test_every_printed_equation_has_one_row() -> None:
    numbers = [number for said in examinations() for number in said.equations]
    assert sorted(numbers) == list(range(1, 39))


def test_every_row_has_a_procedure_and_every_procedure_a_row() -> None:
    keys = [said.key for said in examinations()]
    assert len(keys) == len(set(keys))
    assert set(keys) == set(procedures())


def test_every_name_means_one_row() -> None:
    names = [name for said in examinations() for name in {each.lower() for each in said.names}]
    assert len(names) == len(set(names))
    assert all(chosen([name]) == (said.key,) for said in examinations() for name in said.names)


@pytest.mark.parametrize("name", ["31", "(31)", "Equation 31", "eq. (31)", "statement 106"])
def test_an_equation_is_found_by_its_number_however_that_is_written(name: str) -> None:
    assert chosen([name]) == chosen(["sys:contr-obs-thru-q"]) == ("equation-31",)


def test_a_section_means_all_that_it_says() -> None:
    assert chosen(["section iv-b"]) == ("equation-23", "example", "dynamic", "sharing-states")
    assert set(chosen(["section IV-B"])) < set(chosen(["section IV"]))
    assert set(chosen(["section VI"])) == {"any-controller", "dynamic"}


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("39", r"the paper has no statement '39'"),
        ("statement 135", "the paper has no statement 'statement 135'; did you mean"),
        ("statement 134", "nothing examines statement 134: The paper names them as open"),
    ],
)
def test_what_nothing_examines_is_said(name: str, why: str) -> None:
    with pytest.raises(UsageError, match=why):
        chosen([name])


@EVERY
def test_a_row_names_what_exists(said: Examination) -> None:
    assert said.kind in KINDS and said.says and said.code
    for name in said.code:
        module, _, function = name.rpartition(".")
        assert hasattr(importlib.import_module(module), function), name
    assert set(said.certificates) <= set(CERTIFICATES)
    assert said.nearest_false, "which false statement is near?"
    assert all(text.endswith(".") for text in said.nearest_false.values())


@EVERY
def test_the_verdict_on_a_row_is_that_on_its_statements(said: Examination) -> None:
    about = [each for each in statements() if said.key in each.examined]
    assert list(said.about) == about and about
    for each in about:
        if each.status not in ("defined", "informal"):
            assert STATUSES[each.status] in said.verdicts
        assert set(each.proofs) <= set(said.proofs)
        assert bool(each.erratum) == (f"Statement {each.number}: {each.note}" in said.erratum)
    if "proved" in said.verdicts or "answered" in said.verdicts:
        assert said.proofs


def test_every_formal_proof_in_the_ledger_is_one_that_make_proofs_prints() -> None:
    printed = set(script("assumptions").theorems())
    named = {name for said in examinations() for name in said.proofs}
    assert named <= printed, named - printed


@pytest.mark.parametrize(
    "name",
    ["README.md", "STATEMENTS.md", "OPEN.md", "ERRATA.md", "THEOREMS.md"],
)
def test_what_the_pages_say_of_the_paper_is_made_from_the_ledger(name: str) -> None:
    made = script("ledger_table")
    assert len(made.TABLES) == 5
    text = (PROOFS / name).read_text(encoding="utf-8")
    assert made.renewed(text, made.TABLES[name]()) == text, "run make ledger"


def test_every_theorem_on_the_pages_is_a_link_to_its_line() -> None:
    for page in ("README.md", "STATEMENTS.md"):
        text = (PROOFS / page).read_text(encoding="utf-8")
        links = re.findall(r"\[`(\w+)\.(\w+)`\]\((\w+)\.v#L(\d+)\)", text)
        assert links
        for stem, name, file, line in links:
            source = (PROOFS / f"{file}.v").read_text(encoding="utf-8").splitlines()
            assert stem == file and re.search(rf"^\w+ {name}\b", source[int(line) - 1]), name


def test_the_front_page_begins_with_the_verdict_on_every_numbered_result() -> None:
    text = (PROOFS / "README.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ")][1:]
    named = [row.split("|")[1].strip(" []").partition("]")[0] for row in rows]
    assert sorted(named) == sorted([*NUMBERED, "Open question (IV-D)"])
    assert len(text.partition(rows[-1])[0].splitlines()) < 24, "they do not fit on one screen"


def test_a_result_on_the_front_page_leads_to_its_statement_in_coq_and_that_back_to_the_paper() -> (
    None
):
    pages = {
        name: (PROOFS / name).read_text(encoding="utf-8")
        for name in ("README.md", "THEOREMS.md", "STATEMENTS.md")
    }
    led = dict(re.findall(r"^\| \[([^\]]+)\]\(THEOREMS\.md#([\w-]+)\)", pages["README.md"], re.M))
    assert set(led) == {*NUMBERED, "Open question (IV-D)"} - {"Remark 1"}
    for name, place in led.items():
        entry = pages["THEOREMS.md"].partition(f'<a id="{place}"></a>')[2].partition("\n### ")[0]
        assert name.startswith("Open") or name in entry, name
        code, theorem = entry.partition("```coq")[2], place.partition("-")[2]
        assert re.search(rf"^\w+ {theorem}\b", code, re.M)
        back = re.findall(r"\(STATEMENTS\.md#(\d+)\)", entry)
        assert back
        for number in back:
            row = pages["STATEMENTS.md"].partition(f'| <a id="{number}"></a>{number} |')[2]
            assert f"`{place.replace('-', '.', 1)}`" in row.partition("\n")[0]


def test_a_theorem_is_shown_with_the_definitions_of_its_file_that_it_uses() -> None:
    made = script("ledger_table")
    shown = made.abbreviations("paper", made.texts("paper")["theorem_2"][1])
    assert len(shown) == 3
    assert [text.split()[1] for text in shown] == [
        "no_fixed_mode",
        "strongly_connected_neighbors",
        "bound_26",
    ]
    assert shown[-1].endswith("<= k i)%N.")
