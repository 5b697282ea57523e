"""Print every theorem in this folder, and fail if one of them rests on an assumption.

`theorems.txt` names for every rule of the checker the theorem that justifies it; each name there
must be a theorem here, and be applied to a concrete system in one of the files `instances*.v`.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
import tempfile
from pathlib import Path

CLOSED = "Closed under the global context"
HERE = Path(__file__).parent


def theorems() -> list[str]:
    """Every `Theorem` in the folder as file.name, in the order of the files.

    In `paper.v` lemmas and remarks are the paper's; elsewhere they are steps of proofs.
    """
    words = {"paper": "Theorem|Corollary|Proposition|Lemma|Remark"}
    return [
        f"{path.stem}.{name}"
        for path in sorted(HERE.glob("*.v"))
        for name in re.findall(
            rf"^(?:{words.get(path.stem, 'Theorem|Corollary|Proposition')}) (\w+)",
            path.read_text(),
            re.MULTILINE,
        )
    ]


def listed() -> list[str]:
    """The theorems that `theorems.txt` names."""
    lines = (HERE / "theorems.txt").read_text().splitlines()
    return [line.split()[0] for line in lines if line.strip() and not line.startswith("#")]


def applied() -> set[str]:
    """What the files of instances refer to, by the record that Coq keeps of every reference."""
    reference = re.compile(r"^R\d+:\d+ mcexact\.(\w+) \S+ (\w+) thm$", re.MULTILINE)
    found = set()
    for source in sorted(HERE.glob("instances*.v")):
        record = source.with_suffix(".glob").read_text(encoding="utf-8")
        if record.split()[:2] != ["DIGEST", hashlib.md5(source.read_bytes()).hexdigest()]:
            raise SystemExit(f"{source.name} has changed since it was compiled")
        found |= {".".join(names) for names in reference.findall(record)}
    return found


def main(flags: list[str]) -> int:
    """Compile one file that uses every theorem, and read what it rests on."""
    names = theorems()
    missing = sorted(set(listed()) - set(names))
    if missing:
        print("listed, but not a theorem:", ", ".join(missing))
        return 1
    vacuous = sorted(set(listed()) - applied())
    if vacuous:
        print("listed, but never applied in instances*.v:", ", ".join(vacuous))
        return 1
    files = " ".join(sorted({name.split(".")[0] for name in names}))
    uses = "".join(f"assert (H := @{name}); clear H.\n" for name in names)
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "assumptions_all.v"
        source.write_text(
            f"From mcexact Require {files}.\n"
            f"Lemma all_theorems : True.\nProof.\n{uses}exact I.\nQed.\n"
            "Print Assumptions all_theorems.\n"
        )
        command = ["coqc", *flags, str(source)]
        run = subprocess.run(command, cwd=HERE, capture_output=True, text=True, check=False)
    for name in names:
        print(name)
    if run.returncode or run.stdout.splitlines() != [CLOSED]:
        print(run.stdout, run.stderr)
        return 1
    print(f"{len(names)} theorems, all: {CLOSED}")
    print(f"{len(listed())} listed in theorems.txt, each applied to a concrete system")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
