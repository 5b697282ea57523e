"""Print every theorem in this folder; fail if one rests on an assumption or says nothing.

`theorems.txt` names for every rule of the checker the theorem that justifies it; each name there
must be a theorem here, and be applied to a concrete system in one of the files `instances*.v`.  A
theorem that the ledger of the paper's statements cites has to be applied by a statement that has no
hypothesis left and is about a system with two or more states and channels and A ≠ 0, or about a
graph of two or more agents (`concrete.v`).  `real_numbers.v` alone may rest on axioms: those of
the real numbers, which are printed apart.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

CLOSED = "Closed under the global context"
HERE = Path(__file__).parent
LEDGER = HERE.parent / "mcexact" / "reproduce"
WITH_AXIOMS = "real_numbers"
"""The file that may rest on axioms."""
AXIOMS = {
    "ClassicalDedekindReals.sig_forall_dec": "Coq's real numbers",
    "ClassicalDedekindReals.sig_not_dec": "Coq's real numbers",
    "FunctionalExtensionality.functional_extensionality_dep": "Coq's real numbers",
    "Epsilon.epsilon_statement": "Coq's standard library",
    "boolp.functional_extensionality_dep": "mathcomp-analysis",
    "boolp.propositional_extensionality": "mathcomp-analysis",
    "boolp.constructive_indefinite_description": "mathcomp-analysis",
}
"""These axioms, and what declares each."""


def theorems() -> list[str]:
    """Every `Theorem` in the folder as file.name, in the order of the files.

    In `paper.v` lemmas and remarks are the paper's; elsewhere they are steps of proofs.  What is
    said of the real numbers is among them, with its applications.  The kernel's are those of the
    folder ``kernel``, whose files have names of their own.
    """
    words = {
        "paper": "Theorem|Corollary|Proposition|Lemma|Remark",
        WITH_AXIOMS: "Theorem|Example",
    }
    return [
        f"{path.stem}.{name}"
        for path in [*sorted(HERE.glob("*.v")), *sorted(HERE.glob("kernel/*.v"))]
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


def cited() -> set[str]:
    """The theorems that the ledger cites for statements of the paper."""
    ledger = tomllib.loads((LEDGER / "statements.toml").read_text("utf-8"))
    return {name for row in ledger["statement"] for name in row.get("proofs", ())}


def instances() -> list[Path]:
    """The files that apply theorems to concrete systems."""
    return [*sorted(HERE.glob("instances*.v")), HERE / f"{WITH_AXIOMS}.v"]


def used_by(record: list[str], stem: str) -> dict[str, set[str]]:
    """Each theorem, and the statements of a file that are proved by it.

    From the record that Coq keeps of every definition and reference, in the order of the file: what
    is referred to belongs to the definition before it.
    """
    entry = re.compile(
        r"(?:(?:prf|def|inst) \d+:\d+ <> (?P<made>\w+)"
        r"|R\d+:\d+ mcexact\.(?P<file>\w+) \S+ (?P<used>\w+) thm)$"
    )
    found: dict[str, set[str]] = {}
    here = ""
    for match in filter(None, map(entry.match, record)):
        if match["made"]:
            here = f"{stem}.{match['made']}"
        elif here:
            found.setdefault(f"{match['file']}.{match['used']}", set()).add(here)
    return found


def applications() -> dict[str, set[str]]:
    """Each theorem, and the statements that the files of instances prove by it."""
    found: dict[str, set[str]] = {}
    for source in instances():
        record = source.with_suffix(".glob").read_text(encoding="utf-8").splitlines()
        if record[0].split() != ["DIGEST", hashlib.md5(source.read_bytes()).hexdigest()]:
            raise SystemExit(f"{source.name} has changed since it was compiled")
        for name, made in used_by(record, source.stem).items():
            found.setdefault(name, set()).update(made)
    return found


def answers(text: str, flags: list[str]) -> subprocess.CompletedProcess[str]:
    """What Coq says about some sentences."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "asked.v"
        source.write_text(text, encoding="utf-8")
        command = ["coqc", *flags, str(source)]
        return subprocess.run(command, cwd=HERE, capture_output=True, text=True, check=False)


def required(names: Iterable[str]) -> str:
    """The sentence that loads the files of some names."""
    return f"From mcexact Require {' '.join(sorted({name.split('.')[0] for name in names}))}.\n"


def concrete(names: set[str], flags: list[str]) -> dict[str, str]:
    """Of each statement, whether it is CONCRETE, or ABSTRACT, or has HYPOTHESES left."""
    order = sorted(names)
    asked = "".join(
        f"Goal True. let T := type of (@{name}) in describe T. Abort.\n" for name in order
    )
    load = "From mathcomp Require Import all_ssreflect all_algebra.\n"
    load += f"From mcexact Require Import concrete.\n{required(names)}"
    run = answers(load + asked, flags)
    if run.returncode:
        raise SystemExit(run.stderr)
    return dict(zip(order, run.stdout.split(), strict=True))


def vacuous(wanted: set[str], flags: list[str]) -> Iterator[str]:
    """The theorems that no statement without hypotheses applies to a concrete system."""
    applied = applications()
    said = concrete({name for theorem in wanted for name in applied.get(theorem, ())}, flags)
    for theorem in sorted(wanted):
        found = {name: said[name] for name in sorted(applied.get(theorem, ()))}
        if "CONCRETE" not in found.values():
            told = ", ".join(f"{name} ({word})" for name, word in found.items())
            yield f"{theorem}: {told or 'not applied'}"


def rests_on(names: list[str], flags: list[str]) -> list[str]:
    """What Coq prints as the assumptions of some theorems together."""
    uses = "".join(f"assert (H := @{name}); clear H.\n" for name in names)
    run = answers(
        f"{required(names)}Lemma all_theorems : True.\nProof.\n{uses}exact I.\nQed.\n"
        "Print Assumptions all_theorems.\n",
        flags,
    )
    return run.stdout.splitlines() if not run.returncode else [run.stderr]


def main(flags: list[str]) -> int:
    """Compile one file that uses every theorem, and read what it rests on."""
    names = theorems()
    missing = sorted((set(listed()) | cited()) - set(names))
    if missing:
        print("listed, but not a theorem:", ", ".join(missing))
        return 1
    unused = sorted(set(listed()) - set(applications()))
    if unused:
        print("listed, but never applied in instances*.v:", ", ".join(unused))
        return 1
    real = [name for name in names if name.startswith(f"{WITH_AXIOMS}.")]
    pure = [name for name in names if name not in real]
    with ThreadPoolExecutor(2) as pool:
        resting = [pool.submit(rests_on, some, flags) for some in (pure, real)]
        empty = list(vacuous(cited(), flags))
    found, found_of_real = (each.result() for each in resting)
    if empty:
        print("cited by the ledger, but applied to no concrete system without hypotheses:")
        print("\n".join(empty))
        return 1
    for name in names:
        print(name)
    if found != [CLOSED]:
        print("\n".join(found))
        return 1
    axioms = re.findall(r"^(\w[\w.]*)\s*:?", "\n".join(found_of_real[1:]), re.MULTILINE)
    undeclared = [name for name in axioms if name not in AXIOMS]
    if undeclared:
        print("axioms that are not those of the real numbers:", ", ".join(undeclared))
        return 1
    print(f"{len(pure)} theorems, all: {CLOSED}")
    print(f"{len(listed())} listed in theorems.txt, each applied to a concrete system")
    print(f"{len(cited())} cited by the ledger, each proved of a concrete system or graph")
    print(f"{len(real)} theorems of {WITH_AXIOMS}.v, which rest on the axioms of the real numbers:")
    for name in axioms:
        print(f"  {name} ({AXIOMS[name]})")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
