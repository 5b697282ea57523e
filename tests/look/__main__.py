"""Open the reports at two widths, light and dark; write screenshots; end with 1 if one is wrong.

Run as ``python -m tests.look FOLDER [PAGE…]``: the pages default to a report of the reproduction
and one of an analysis, which are made first.
"""

from __future__ import annotations

import base64
import contextlib
import sys
from pathlib import Path

from mcexact.cli import main as mcexact
from mcexact.model import gallery
from tests.look.browser import Browser, NoBrowser, closed_panels, open_page

WIDTHS = (1280, 400)
SCHEMES = ("light", "dark")
TALLEST = 5000


def pages(folder: Path) -> list[Path]:
    """The two reports, made now."""
    plant = Path(gallery.__file__).parent / "liu2020-3ch-augmented-outputs.json"
    analysis = folder / "analysis.html"
    made = (
        ("analyze", str(plant), "--html", str(analysis)),
        ("reproduce", "-o", str(folder / "paper")),
    )
    for arguments in made:
        with contextlib.redirect_stdout(sys.stderr), contextlib.suppress(SystemExit):
            mcexact(arguments)
    return [folder / "paper" / "report.html", analysis]


def look(browser: Browser, page: Path, folder: Path) -> int:
    """Open one page four times; the number of complaints."""
    name = page.parent.name if page.stem == "report" else page.stem
    count = 0
    for closed in closed_panels(browser, page):
        print(f"{page}: {closed} is linked, and its panel stays closed")
        count += 1
    for width in WIDTHS:
        for scheme in SCHEMES:
            wrong = open_page(browser, page, width, scheme)
            height = min(browser.evaluate("document.documentElement.scrollHeight"), TALLEST)
            shot = browser.call(
                "Page.captureScreenshot",
                captureBeyondViewport=True,
                clip={"x": 0, "y": 0, "width": width, "height": height, "scale": 1},
            )
            path = folder / f"{name}-{width}-{scheme}.png"
            path.write_bytes(base64.b64decode(shot["data"]))
            print(f"{path}: {'; '.join(wrong) if wrong else 'nothing wrong'}")
            count += len(wrong)
    return count


def main(arguments: list[str]) -> int:
    """Look at every page."""
    folder = Path(arguments[0] if arguments else "look")
    folder.mkdir(parents=True, exist_ok=True)
    shown = [Path(each) for each in arguments[1:]] or pages(folder)
    try:
        with Browser() as browser:
            return 1 if sum(look(browser, page, folder) for page in shown) else 0
    except NoBrowser as error:
        print(f"look: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
