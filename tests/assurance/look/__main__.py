"""Open all kinds of pages at two widths, light and dark, and in print; write screenshots.

Run as ``python -m tests.assurance.look FOLDER [PAGE…]``: by default every kind of page is made
first.  The status is 1 if something is wrong with a page.
"""

from __future__ import annotations

import base64
import contextlib
import sys
from pathlib import Path

from mcexact import Controller, load_system, save_controller, save_system
from mcexact.cli import main as mcexact
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.designs import AgentProgram
from mcexact.model import gallery
from tests.assurance.look.browser import Browser, NoBrowser, closed_panels, open_page

LOOKS = (
    *((1280, "light"), (1280, "dark"), (400, "light"), (400, "dark")),
    # The width of A4 paper between margins of 2 cm.
    (642, "print"),
)
TALLEST = 6000


def pages(folder: Path) -> list[Path]:
    """One page of every kind, made now."""
    plants = Path(gallery.__file__).parent
    example = str(plants / "liu2020-3ch-augmented-outputs.json")
    tanks, discrete = str(plants / "quadruple-tank-pminus.json"), str(plants / "compleib-dis5.json")
    drawn, crowd, short = (folder / f"{name}.json" for name in ("drawn", "crowd", "short"))
    gains, holding = str(folder / "gains.json"), str(folder / "holding.json")
    linked, shared = str(folder / "linked.json"), str(folder / "shared.json")
    estimates, levels = str(folder / "estimates.json"), _of_tanks("plant.json")
    made = {
        "analysis": ("analyze", example),
        "analysis-10": ("analyze", str(drawn)),
        "analysis-60": ("analyze", str(crowd)),
        "decentralized": ("design", "decentralized", tanks, "--effort", "2", "-o", gains),
        "setpoint": ("design", "setpoint", tanks, "--effort", "2", "-o", holding),
        "extended": ("design", "extended", linked, "--effort", "2", "-o", shared),
        "observer": ("design", "observer", linked, "--arithmetic", "float", "-o", estimates),
        "certified": ("certify", tanks, gains),
        "exhibits": ("crosscheck", "--exhibits"),
        "dimensions": ("allocate", str(short)),
        "links": ("allocate", example, "--links"),
        "sweep": ("sweep", "--draws", "9", "--plant-fixed-mode", "--question", "completeness"),
    }
    runs = {
        "run": (tanks, gains),
        "run-setpoint": (tanks, holding, "--reference=1,-1/2", "--initial=0,0,0,0"),
        "run-observer": (linked, estimates),
        "run-real": (
            *(levels, _of_tanks("controller.json"), "--step", "5", "--late", "1"),
            *("--reference=2,1", "--initial=0", "--limits=-0.3,0.3", "--quantize-outputs=8:-4,4"),
            *("--fixed-point", "5"),
        ),
        "run-unstable": (discrete, str(folder / "idle.json")),
    }
    for path, channels in ((drawn, 10), (crowd, 60)):
        system = drawn_system(Draw(1, states=12, channels=channels, neighbors=True))
        save_system(system, path)
    save_system(drawn_system(Draw(1, states=6, channels=4, deficiency=2)), short)
    pair = {"1": ["2"], "2": ["1"]}
    save_system(load_system(tanks).with_neighbors(pair), linked)
    _idle(discrete, folder / "idle.json")
    for name, arguments in made.items():
        _run(*arguments, "--html", str(folder / f"{name}.html"))
    for name, arguments in runs.items():
        _run("simulate", *arguments, "-o", str(folder / f"{name}.html"))
    _run("reproduce", "-o", str(folder / "paper"))
    return [folder / "paper" / "report.html", *(folder / f"{name}.html" for name in [*made, *runs])]


def _of_tanks(name: str) -> str:
    """A file of the example that goes from a plant to compiled code."""
    return str(Path(__file__).parents[3] / "examples" / "tanks" / name)


def _idle(plant: str, path: Path) -> None:
    """Write a controller that does nothing."""
    system = load_system(plant)
    agents = tuple(AgentProgram(name, 0, 0) for name in system.names)
    save_controller(Controller(system.time, "", agents), path)


def _run(*arguments: str) -> None:
    """Run a command; what it prints is no page."""
    with contextlib.redirect_stdout(sys.stderr), contextlib.suppress(SystemExit):
        mcexact(arguments)


def look(browser: Browser, page: Path, folder: Path) -> int:
    """Open one page in every way; the number of complaints."""
    name = page.parent.name if page.stem == "report" else page.stem
    if not page.exists():
        print(f"{page}: was not written")
        return 1
    count = 0
    for closed in closed_panels(browser, page):
        print(f"{page}: {closed} is linked, and its panel stays closed")
        count += 1
    for width, scheme in LOOKS:
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
