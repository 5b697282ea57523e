"""Every rule has its page, and the index knows every other page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import mcexact
from mcexact.checker.kinds import KINDS

PROOFS = Path(mcexact.__file__).parent.parent / "proofs"
INDEX = (PROOFS / "README.md").read_text(encoding="utf-8")
PAGES = {path.name for path in PROOFS.glob("*.md")} - {"README.md"}
KNOWN = {f"{kind}.md" for kind in KINDS}


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_kind_has_a_page_that_names_its_rule(kind: str) -> None:
    page = (PROOFS / f"{kind}.md").read_text(encoding="utf-8")
    assert page.startswith(f"# `{kind}`")
    check = KINDS[kind].check
    assert f"`{check.__name__}` of `{check.__module__.replace('.', '/')}.py`" in page
    assert "ot claimed" in page


def test_the_index_links_every_other_page_and_only_what_is_there() -> None:
    assert PAGES - KNOWN <= set(re.findall(r"\]\(([^)]*\.md)\)", INDEX))
    for link in re.findall(r"\]\(([^)]*\.md)\)", INDEX):
        assert (PROOFS / link).exists(), link
