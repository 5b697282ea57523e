"""Pages parse strictly, need no other file, and are harmless whatever they are given."""

from __future__ import annotations

import base64
import re
from pathlib import Path

import pytest

from mcexact.answer.check import recheck
from mcexact.cli import main
from mcexact.exact import matrix
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.canvas import GRAY
from mcexact.plot.graphs import PLAIN
from mcexact.report.figures import graph_pictures
from mcexact.report.pages import account_page
from mcexact.report.text import latex
from tests.answer.asking import account_of
from tests.report.strict_html import Page, external_addresses

ATTACK = "<script>alert(1)</script>"
GALLERY = Path(gallery.__file__).parent


def hostile() -> MultiChannelSystem:
    return MultiChannelSystem(
        [[1, 0], [0, 2]],
        [[[0], [0]], [[1], [1]]],
        [[[1, 1]], [[0, 0]]],
        names=('"><img src=x onerror=alert(1)>', "${{7*7}} $\\frac$ &amp;"),
        neighbors={'"><img src=x onerror=alert(1)>': []},
        name=ATTACK,
    )


def page_of(plant: MultiChannelSystem, **question: bool) -> str:
    """The page with all its evidence, checked, and the results as LaTeX."""
    account = account_of(plant, **question)
    verdicts = recheck(account.files(), plant.canonical_text())
    return account_page(account).rendered(account.certificates, verdicts, latex(account))


@pytest.mark.parametrize("name", ["hidden-triple-mode", "farina-string-of-vehicles-4"])
def test_the_page_of_an_analysis_parses_strictly_and_asks_nobody(name: str) -> None:
    text = page_of(gallery.load(name))
    assert external_addresses(text) == []
    assert 'http-equiv="Content-Security-Policy"' in text and "prefers-color-scheme" in text


def test_pictures_have_the_colors_of_the_page_in_the_dark() -> None:
    uri = graph_pictures(account_of(hostile()))[-1].embedded().uri
    drawn = base64.b64decode(uri.partition(",")[2]).decode()
    style = drawn.partition("<style>@media screen and (prefers-color-scheme:dark)")[2]
    changed = dict(re.findall(r"(\[style[^]]*\])\{(\w+:#\w{6})!important", style))
    assert changed['[style*="fill: #ffffff"]'] == "fill:#16181b"
    # What lies on the paper is changed with it.
    assert {f'[style*="stroke: {each}"]' for each in (PLAIN, GRAY, "#000000")} <= changed.keys()
    assert drawn.index("<style>") < drawn.index("<defs>")


def test_names_that_look_like_html_are_harmless() -> None:
    text = page_of(hostile(), minimal=True)
    page = Page(text)
    assert "script" not in {tag for tag, _ in page.tags}
    assert {given["src"][:11] for tag, given in page.tags if tag == "img"} == {"data:image/"}
    assert ATTACK not in text and "&lt;script&gt;alert(1)&lt;/script&gt;" in text
    assert external_addresses(text) == []


def test_pictures_carry_no_script_and_no_link() -> None:
    uri = graph_pictures(account_of(hostile()))[-1].embedded().uri
    image = base64.b64decode(uri.partition(",")[2]).decode("utf-8")
    assert "<script" not in image and "onerror" not in image and 'href="http' not in image


def test_a_picture_is_the_same_bytes_every_time_and_says_what_it_shows() -> None:
    plant = gallery.load("liu2020-3ch-augmented-outputs")
    drawn = graph_pictures(account_of(plant))[-1]
    assert drawn.embedded() == graph_pictures(account_of(plant))[-1].embedded()
    assert "orange: channel 2" in drawn.alternative


@pytest.mark.parametrize("bad", ["<p>", "<p></b>", "<p>a & b</p>", "<table></table>", "<p/>"])
def test_the_strict_reader_refuses_what_a_browser_forgives(bad: str) -> None:
    good = "<html><head><title>t</title></head><body><h1>h</h1>{}</body></html>"
    Page(good.format("<p>a &amp; b</p>"))
    with pytest.raises(ValueError):
        Page(good.format(bad))


def test_an_address_in_a_page_is_found() -> None:
    good = "<html><head><title>t</title></head><body><h1>h</h1>{}</body></html>"
    assert external_addresses(good.format('<a href="https://example.org">x</a>'))


def test_a_certificate_that_was_not_re_checked_says_so() -> None:
    page = account_page(account_of(gallery.load("hidden-triple-mode")))
    text = page.rendered({"fixed_spectrum.json": "{}"}, {})
    assert "not re-checked" in text and "VALID" not in text


def test_latex_escapes_names_and_writes_fractions() -> None:
    text = latex(account_of(hostile()))
    assert "\\textbackslash{}frac" in text and "\\&amp;" in text
    assert "\\tfrac{1}{3}" in matrix.latex(Matrix.from_rows([["-1/3"]]), whole=True)


def test_analyze_writes_the_page_and_latex(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "page.html"
    plant = str(GALLERY / "hidden-triple-mode.json")
    with pytest.raises(SystemExit) as ended:
        main(["analyze", plant, "--html", str(page)])
    assert ended.value.code == 0
    assert external_addresses(page.read_text(encoding="utf-8")) == []
    with pytest.raises(SystemExit):
        main(["analyze", plant, "--latex"])
    assert "\\begin{bmatrix}" in capsys.readouterr().out
