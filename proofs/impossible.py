"""Give theorems of paper.v a hypothesis that is never true, and show that each is then refused.

Every one of them compiles with the hypothesis 0 > n, and says nothing any more.  Two things have to
refuse it.  The application in `instances_reproduction.v` as it is has to stop compiling; and where
somebody rewrites the application so that it carries the hypothesis along, `assumptions.vacuous` has
to find that no statement about a concrete system is left without hypotheses.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import assumptions

HERE = Path(__file__).parent
THEOREMS = (
    "theorem_2", "theorem_3", "theorem_4", "corollary_1_printed", "corollary_2", "proposition_1",
    "theorem_1", "suitable_dimensions", "held_assignment", "gap_26",
)  # fmt: skip
"""The theorems of the experiment."""
APPLIED = "instances_reproduction"


def weakened(source: str, name: str) -> str:
    """paper.v with a hypothesis more in one theorem, which its other proofs do not use."""
    found = re.search(rf"^(\w+) {name}\b(.*?)\nProof\..*?Qed\.\n", source, re.MULTILINE | re.DOTALL)
    if found is None:
        raise SystemExit(f"paper.v has no {name}")
    head, begin, body = source.partition("Section Paper.")
    spared = head + begin + re.sub(rf"(?<![\w.]){name}\b", f"{name}_", body)
    end = spared.index(f"{found[1]} {name}_")
    end = spared.index("Qed.\n", end) + len("Qed.\n")
    weak = f"{found[1]} {name} (impossible : (n < 0)%N){found[2]}\n"
    weak += "Proof. by have := impossible; rewrite ltn0. Qed.\n"
    return spared[:end] + weak + spared[end:]


def compiled(folder: Path, name: str, flags: list[str]) -> str:
    """The error of a file of the folder, or an empty text."""
    command = ["coqc", *flags, f"{name}.v"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return "" if run.returncode == 0 else re.sub(r"\s+", " ", run.stderr)[-300:] or "?"


def main(flags: list[str]) -> int:
    """Print for every theorem what refuses it."""
    paper = (HERE / "paper.v").read_text(encoding="utf-8")
    applied = (HERE / f"{APPLIED}.v").read_text(encoding="utf-8")
    bad = 0
    for name in THEOREMS:
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place)
            for path in HERE.glob("*.vo"):
                if path.stem not in ("paper", APPLIED):
                    (folder / path.name).symlink_to(path)
            (folder / "paper.v").write_text(weakened(paper, name), encoding="utf-8")
            (folder / f"{APPLIED}.v").write_text(applied, encoding="utf-8")
            if error := compiled(folder, "paper", flags):
                print(f"{name}: the theorem itself does not compile: {error}")
                bad += 1
                continue
            stops = compiled(folder, APPLIED, flags)
            # not in the imports above the section, where a file can have the name of a theorem
            imports, section, body = applied.partition("Section ")
            careless = f"{section}{body}\nExample careless := @paper.{name}.\n"
            kept = re.sub(rf"(?<![\w.]){name}\b(?=[ ;)(]| *\n)", f"paper.{name}_", careless)
            kept = imports + kept
            kept = kept.replace(f"@paper.paper.{name}_", f"@paper.{name}")
            (folder / f"{APPLIED}.v").write_text(kept, encoding="utf-8")
            if error := compiled(folder, APPLIED, flags):
                print(f"{name}: the careless application does not compile: {error}")
                bad += 1
                continue
            said = verdict(folder, name, flags)
        refused = bool(stops) and said != "CONCRETE"
        bad += not refused
        print(
            f"{name}: {'refused' if refused else 'ACCEPTED'}: the application as it is "
            f"{'fails' if stops else 'COMPILES'}, one that keeps the hypothesis is {said}",
            flush=True,
        )
    return 1 if bad else 0


def verdict(folder: Path, name: str, flags: list[str]) -> str:
    """What the gate says of the theorem in this folder."""
    here, assumptions.HERE = assumptions.HERE, folder
    try:
        used = assumptions.used_by(
            (folder / f"{APPLIED}.glob").read_text(encoding="utf-8").splitlines(), APPLIED
        )
        said = assumptions.concrete(used.get(f"paper.{name}", set()), flags)
    finally:
        assumptions.HERE = here
    return (
        "CONCRETE"
        if "CONCRETE" in said.values()
        else ", ".join(sorted(set(said.values()))) or "not applied"
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
