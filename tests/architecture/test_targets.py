"""Every target of make that a page names exists."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

import mcexact

ROOT = Path(__file__).parents[2]
MAKEFILES = {
    name: (ROOT / name).read_text(encoding="utf-8") for name in ("Makefile", "campaigns.mk")
}
OF = {name: re.findall(r"^([a-z][a-z-]*):", text, re.M) for name, text in MAKEFILES.items()}
RULES = {*OF["Makefile"], *OF["campaigns.mk"]}
MOST = 14
"""So many targets a person can know by heart."""


@pytest.mark.parametrize("name", MAKEFILES)
def test_every_target_without_a_file_has_a_rule(name: str) -> None:
    (phony,) = re.findall(r"^\.PHONY: (.*)$", MAKEFILES[name], re.MULTILINE)
    assert set(phony.split()) == set(OF[name])


def test_what_people_use_is_few_and_the_rest_are_campaigns() -> None:
    assert len(OF["Makefile"]) <= MOST
    assert not {*OF["Makefile"]} & {*OF["campaigns.mk"]}


def printed(*arguments: str) -> str:
    """What make would do, or prints."""
    call = ["make", "--no-print-directory", *arguments]
    return subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def test_a_campaign_can_be_named_to_make_itself_with_its_variables() -> None:
    assert "tests.assurance.attack 5" in printed("-n", "attack", "N=5")
    with pytest.raises(subprocess.CalledProcessError):
        printed("-n", "no-target-of-this-name")


def test_the_campaigns_are_listed_with_what_each_does() -> None:
    said = printed("-f", "campaigns.mk")
    for name in OF["campaigns.mk"]:
        assert re.search(rf"^{name}\n    \w", said, re.MULTILINE), name


def test_the_page_for_contributors_says_when_to_run_each() -> None:
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for name in RULES - {"help"}:
        assert f"`make {name}`" in page, name


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


@pytest.mark.parametrize(
    ("file", "said"),
    [
        (".github/workflows/tests.yml", "# Untested"),
        ("Dockerfile", "# Tried by"),
        ("verified/Containerfile", "# Untested"),
    ],
)
def test_the_first_line_says_whether_anybody_has_run_it(file: str, said: str) -> None:
    assert (ROOT / file).read_text(encoding="utf-8").startswith(said)


def test_the_citation_names_the_version_of_the_package() -> None:
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {mcexact.__version__}\n" in text
    assert "the mcexact authors" in text
