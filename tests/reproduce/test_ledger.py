"""The ledger has every statement, and says no more than is proved."""

from __future__ import annotations

import importlib
import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

from mcexact.checker.kinds import KINDS as CERTIFICATES
from mcexact.reproduce.ledger import KINDS, Statement, statements
from mcexact.reproduce.reproduction import procedures

PROOFS = Path(__file__).parents[2] / "proofs"
NUMBERED = [
    *(f"Proposition {k}" for k in (1, 2, 3)),
    *(f"Theorem {k}" for k in (1, 2, 3, 4)),
    *(f"Lemma {k}" for k in (1, 2, 3, 4)),
    *(f"Corollary {k}" for k in (1, 2)),
    *(f"Remark {k}" for k in (1, 2)),
]
EVERY = pytest.mark.parametrize("said", statements(), ids=lambda said: said.key)


def script(name: str) -> ModuleType:
    """A script of the folder of proofs."""
    spec = importlib.util.spec_from_file_location(name, PROOFS / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_numbered_statement_of_the_paper_has_a_row() -> None:
    titles = [said.title for said in statements() if said.kind == "numbered"]
    assert sorted(titles) == sorted(NUMBERED)


def test_every_row_has_a_procedure_and_every_procedure_a_row() -> None:
    keys = [said.key for said in statements()]
    assert len(keys) == len(set(keys))
    assert set(keys) == set(procedures())


@EVERY
def test_a_row_names_what_exists(said: Statement) -> None:
    assert said.kind in KINDS and said.says and said.code
    for name in said.code:
        module, _, function = name.rpartition(".")
        assert hasattr(importlib.import_module(module), function), name
    assert set(said.certificates) <= set(CERTIFICATES)


@EVERY
def test_a_row_is_called_proved_only_where_theorems_cover_it(said: Statement) -> None:
    assert (said.covers == "all") == said.proved
    assert bool(said.proofs) == bool(said.covers)
    assert (said.covers == "part") == bool(said.part)
    if not said.proved:
        assert "proved in general, " not in said.status(3)


def test_every_formal_proof_in_the_ledger_is_one_that_make_proofs_prints() -> None:
    printed = set(script("assumptions").theorems())
    named = {name for said in statements() for name in said.proofs}
    assert named <= printed, named - printed


def test_the_table_in_the_readme_of_proofs_is_the_ledger() -> None:
    table = script("ledger_table")
    text = (PROOFS / "README.md").read_text(encoding="utf-8")
    assert table.renewed(text) == text, "run make ledger"


def test_every_correction_is_in_the_errata() -> None:
    """Each label that a corrected row stands for is spoken of there."""
    errata = (PROOFS / "ERRATA.md").read_text(encoding="utf-8")
    words = {"det": "gnd", "bound-reached": "reached", "funch": "pppp", "emcsdd": "G_i"}
    words["cor:free-assign"] = "Corollary 1"
    corrected = {said.key for said in statements() if said.erratum}
    assert corrected == set(words)
    assert all(re.search(re.escape(words[key]), errata) for key in corrected)
