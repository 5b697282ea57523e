"""Every page of the documentation says what its commands and examples give."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.documentation.pages import blocks, run

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(
    path
    for path in (DOCS.parent / "README.md", *DOCS.rglob("*.md"))
    if "generated" not in path.parts
    and any(each.language in {"console", "pycon"} for each in blocks(path.read_text("utf-8")))
)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(DOCS.parent)))
def test_a_page_says_what_happens(path: Path, tmp_path: Path) -> None:
    assert run(path, tmp_path) > 0


def test_the_walks_with_other_libraries_take_ten_lines_each() -> None:
    page = (DOCS / "how-to" / "five-libraries.md").read_text(encoding="utf-8")
    walks = [each for each in blocks(page) if each.language in {"pycon", "python"}]
    assert len(walks) == 5
    for walk in walks:
        code = re.findall(r"^(?:>>>|\.\.\.) .*$", walk.text, re.MULTILINE)
        code = code or [line for line in walk.text.splitlines() if line.strip()]
        assert 0 < len(code) <= 10, walk.line


WRONG = {
    "an output": "```console\n$ mcexact demo\nnothing\n```\n",
    "a status": "```console\n$ mcexact demo # status 1\n...\n```\n",
    "a program": "```console\n$ other demo\n...\n```\n",
    "an example": "```pycon\n>>> 1 + 1\n3\n```\n",
    "an error": "```pycon\n>>> 1 / 0\n```\n",
}


@pytest.mark.parametrize("text", WRONG.values(), ids=WRONG)
def test_what_a_page_says_wrongly_is_found(text: str, tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(text, encoding="utf-8")
    with pytest.raises((AssertionError, KeyError)):
        run(page, tmp_path)


def test_examples_share_names_and_files(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "```{code-block} text\n:caption: a.txt\nkept\n```\n\n"
        "```pycon\n>>> import pathlib\n>>> x, path = 1, pathlib.Path('a.txt')\n\n```\n"
        "\n```pycon\n>>> x, path.read_text()\n(1, 'kept\\n')\n\n```\n",
        encoding="utf-8",
    )
    assert run(page, tmp_path) == 3
