"""Build the release twice, compare it byte for byte, check it, install it, and run the tutorial.

Run as ``python -m tests.assurance.release``, or by ``make release``.  What is committed is built,
in two folders of different names, with the time of the commit as `SOURCE_DATE_EPOCH`; the wheel is
made from the source distribution.  Then twine checks both, the wheel is installed into a new
environment without the libraries of the tests, and the commands of the tutorial run there, with the
files of the wheel alone.  What was built is in ``dist/``.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import venv
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = ("README.md", "docs/tutorial.md")
INSIDE = {"mcexact", "mcexact-{version}.dist-info"}
"""What a wheel may hold: nothing else appears among the packages of a user."""


class Failed(Exception):
    """The release is not as it has to be; the message says where."""


def run(*call: str | Path, folder: Path = ROOT, **variables: str) -> str:
    """Run a program, and return what it prints.

    Raises
    ------
    Failed
        With all that was printed, if the program fails.
    """
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")} | variables
    done = subprocess.run(
        [str(each) for each in call],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
    )
    if done.returncode:
        raise Failed(f"{' '.join(map(str, call))} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def committed(folder: Path) -> Path:
    """Unpack what is committed, and nothing else, into a folder."""
    folder.mkdir()
    archive = folder.with_suffix(".tar")
    run("git", "archive", "--output", archive, "HEAD")
    with tarfile.open(archive) as packed:
        packed.extractall(folder, filter="data")
    return folder


def built(folder: Path, moment: str) -> dict[str, Path]:
    """Build both distributions in a folder: their files by name."""
    run(sys.executable, "-m", "build", "--outdir", "dist", ".", folder=folder, **epoch(moment))
    return {path.name: path for path in sorted((folder / "dist").iterdir())}


def epoch(moment: str) -> dict[str, str]:
    """The time that is written into archives."""
    return {"SOURCE_DATE_EPOCH": moment}


def names_in(path: Path) -> list[str]:
    """The files in a distribution."""
    if path.suffix == ".whl":
        with zipfile.ZipFile(path) as wheel:
            return wheel.namelist()
    with tarfile.open(path) as packed:
        return packed.getnames()


def require_contents(files: dict[str, Path], version: str) -> None:
    """Stop unless there are one wheel and one source distribution, and each has what it has to."""
    if set(files) != {f"mcexact-{version}.tar.gz", f"mcexact-{version}-py3-none-any.whl"}:
        raise Failed(f"built {sorted(files)} for the version {version}")
    for name, path in files.items():
        listed = names_in(path)
        tops = {each.partition("/")[0] for each in listed}
        allowed = {each.format(version=version) for each in INSIDE}
        if path.suffix == ".whl" and tops != allowed:
            raise Failed(f"{name} holds {sorted(tops)}")
        print(f"{name}: {path.stat().st_size:,} bytes, {len(listed)} files")


def walked(wheel: Path, folder: Path) -> None:
    """Install a wheel into a new environment, and run the pages there."""
    place, pages = folder / "environment", folder / "pages"
    venv.create(place, with_pip=True)
    python = place / ("Scripts" if os.name == "nt" else "bin") / "python"
    run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", f"{wheel}[plot]")
    pages.mkdir()
    shutil.copy(ROOT / "tests" / "documentation" / "pages.py", pages)
    size = sum(path.stat().st_size for path in place.rglob("*") if path.is_file())
    print(f"installed with the extra plot: {size / 1e6:.0f} MB")
    for page in PAGES:
        shutil.copy(ROOT / page, pages)
        work = pages / Path(page).stem
        work.mkdir()
        code = (
            "import mcexact, pages; from pathlib import Path; "
            f"assert Path(mcexact.__file__).is_relative_to({str(place)!r}), mcexact.__file__; "
            f"print(pages.run(Path({Path(page).name!r}).resolve(), Path({str(work)!r})))"
        )
        count = run(python, "-c", code, folder=pages).split()[-1]
        print(f"{page}: {count} commands and examples")


def main() -> None:
    """Build, compare, check and install; the status is 1 where something fails."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    moment = run("git", "log", "-1", "--format=%ct").strip()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        once, again = (
            built(committed(folder / each), moment) for each in ("once", "in-another-place")
        )
        require_contents(once, project["version"])
        for file, path in once.items():
            digests = {hashlib.sha256(p.read_bytes()).hexdigest() for p in (path, again[file])}
            if len(digests) > 1:
                raise Failed(f"two builds of {file} differ")
            print(f"{file}: the same bytes in two builds, SHA-256 {digests.pop()}")
        print(run(sys.executable, "-m", "twine", "check", "--strict", *once.values()).strip())
        walked(next(path for path in once.values() if path.suffix == ".whl"), folder)
        (ROOT / "dist").mkdir(exist_ok=True)
        for path in once.values():
            shutil.copy(path, ROOT / "dist")
    if "urls" not in project:
        print("pyproject.toml names no address: add [project.urls] before this is published")


if __name__ == "__main__":
    try:
        main()
    except Failed as failed:
        sys.exit(f"release: {failed}")
