"""Every target of make that a page names exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import mcexact

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
RULES = set(re.findall(r"^([a-z][a-z-]*):", MAKEFILE, re.MULTILINE))


def test_every_target_without_a_file_has_a_rule() -> None:
    (phony,) = re.findall(r"^\.PHONY: (.*)$", MAKEFILE, re.MULTILINE)
    assert set(phony.split()) <= RULES


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md", "SECURITY.md", "ARCHITECTURE.md"])
def test_the_targets_that_a_page_names_have_rules(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    named = set(re.findall(r"`make ([a-z][a-z-]*)", text)) | set(
        re.findall(r"^ +make ([a-z][a-z-]*)", text, re.MULTILINE)
    )
    assert named <= RULES


@pytest.mark.parametrize("page", [".github/workflows/tests.yml", ".pre-commit-config.yaml"])
def test_the_targets_that_a_service_would_run_have_rules(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    assert set(re.findall(r"(?:run: |`)make ([a-z][a-z-]*)", text)) <= RULES


@pytest.mark.parametrize("file", [".github/workflows/tests.yml", "Dockerfile"])
def test_what_nobody_has_run_says_so_in_its_first_line(file: str) -> None:
    first = (ROOT / file).read_text(encoding="utf-8").splitlines()[0]
    assert first.startswith("# Untested")


def test_the_citation_names_the_version_of_the_package() -> None:
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {mcexact.__version__}\n" in text
    assert "the mcexact authors" in text
