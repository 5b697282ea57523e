"""Sentences are made again of certificates alone, and one that was changed is not among them."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from mcexact import analyze, load_certificate
from mcexact.answer.account import Account
from mcexact.answer.sentence import MANIFEST
from mcexact.cli import main
from mcexact.cli.audit import sentences_of
from mcexact.model import gallery

ALONE = re.compile(r"<tr><td>(?:IMPLIED|INVALID)</td>.*<td></td></tr>")
"""A row of a page whose sentence was not computed again."""
FOLDER = Path(gallery.__file__).parent
PLANTS = ["quadruple-tank-pminus", "liu2020-3ch-no-communication", "feedthrough-that-cancels"]


def sentences(folder: Path) -> set[tuple[str, str]]:
    """What the manifest of a folder says, by rules and texts."""
    manifest = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    return {(each["rule"], each["text"]) for each in manifest["sentences"]}


def again(folder: Path) -> frozenset[tuple[str, str]]:
    """What the package makes of the certificates of a folder."""
    files = [file for file in folder.glob("*.json") if file.name != MANIFEST]
    return sentences_of({file.stem: load_certificate(file) for file in files})


def called(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.mark.parametrize("name", PLANTS)
def test_all_that_an_analysis_says_is_made_again_but_the_name(name: str, tmp_path: Path) -> None:
    account: Account = analyze(gallery.load(name)).account
    for file, text in account.files().items():
        (tmp_path / file).write_text(text, encoding="utf-8")
    assert {rule for rule, _ in sentences(tmp_path) - again(tmp_path)} == {"heading"}


@pytest.fixture(scope="module")
def designed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the certificates of a design."""
    folder = tmp_path_factory.mktemp("designed")
    plant: dict[str, Any] = {
        "format": "mcexact-system/1",
        "A": [[0, 1], [0, -1]],
        "time": "continuous",
    }
    plant["channels"] = [{"name": "1", "B": [[0], [1]], "C": [[1, 0]]}]
    (folder / "plant.json").write_text(json.dumps(plant), encoding="utf-8")
    files = [str(folder / "plant.json"), "-o", str(folder / "gains.json")]
    assert called("design", "decentralized", *files, "--certificates", str(folder / "loop")) == 0
    return folder


def test_all_that_a_design_says_is_made_again(designed: Path) -> None:
    said = sentences(designed / "loop")
    assert len(said) > 15
    assert said <= again(designed / "loop")


def test_a_sentence_that_was_changed_is_refused_or_left_to_compare(designed: Path) -> None:
    """The checker refuses another rounded number; of a whole number the page says it."""
    manifest, page = designed / "loop" / MANIFEST, designed / "page.html"
    made = manifest.read_text(encoding="utf-8")

    def compared(rule: str, old: str, new: str) -> tuple[int, int]:
        document: dict[str, Any] = json.loads(made)
        for each in document["sentences"]:
            if each["rule"] == rule:
                assert old in each["text"]
                each["text"] = each["text"].replace(old, new)
        manifest.write_text(json.dumps(document), encoding="utf-8")
        arguments = ["--system", str(designed / "plant.json"), "--html", str(page)]
        status = called("check", str(designed / "loop"), *arguments)
        return status, len(ALONE.findall(page.read_text(encoding="utf-8")))

    assert compared("", "", "") == (0, 0)
    assert compared("first-margin", "≥ ", "≥ 1") == (1, 1)
    assert compared("design-order", ": ", ": 1") == (0, 1)
