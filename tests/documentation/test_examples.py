"""Every script in examples/ runs, and says what its page says of it."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
SAYS = {
    "canal": ("cannot be stabilized", "Links to add: farm → gate", "Re λ < -1/10 is VALID"),
    "rooms": ("Every set-point can be held: True", "Re λ < -1/2 is VALID"),
    "areas": ("states: the roots of x\n", "|λ| < 19/20 is VALID"),
}


def test_every_script_is_on_the_page_and_tested() -> None:
    scripts = {path.stem for path in EXAMPLES.glob("*.py")}
    assert scripts == SAYS.keys()
    page = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    assert all(f"| `{stem}.py` |" in page for stem in scripts)


@pytest.mark.parametrize("stem", SAYS)
def test_a_script_says_what_it_shows(stem: str, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / f"{stem}.py"), run_name="__main__")
    said = capsys.readouterr().out
    assert all(part in said for part in SAYS[stem]), said
