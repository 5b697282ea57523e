"""Mutants of the paper's examinations: each has to make its examination fail.

Run as ``python -m tests.assurance.paper_mutants [KEY…]``.  A mutant replaces a text in the
procedure of one examination, or in the helpers of its module: an instance, a bound, a sign, an
index, a neighbor, a radius or a hypothesis.  The exit status is 1 if an examination holds with a
mutant, if a mutant no longer applies, or if an examination has fewer than two.
"""

from __future__ import annotations

import ast
import sys
import tomllib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from mcexact.reproduce import instances
from mcexact.reproduce.notebook import Procedure, examinations, examined
from mcexact.reproduce.reproduction import procedures

KINDS = ("instance", "bound", "sign", "index", "neighbor", "radius", "hypothesis")
LIST = Path(__file__).parent / "mutants.toml"


@dataclass(frozen=True)
class Mutant:
    """One change of the procedure of an examination.

    Attributes
    ----------
    key : str
        The examination.
    kind : str
        What is changed, one of `KINDS`.
    old, new : str
    """

    key: str
    kind: str
    old: str
    new: str


def mutants() -> list[Mutant]:
    """All mutants of the list."""
    listed = tomllib.loads(LIST.read_text(encoding="utf-8"))
    return [Mutant(key, *change) for key, changes in listed.items() for change in changes]


def mutated(mutant: Mutant, procedure: Procedure) -> Procedure | None:
    """The procedure with the change, or None if the text to be replaced is not there."""
    module = sys.modules[procedure.__module__]
    text = Path(str(module.__file__)).read_text(encoding="utf-8")
    lines = text.splitlines(keepends=True)
    (node,) = (
        node
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef) and node.name == procedure.__name__
    )
    first, last = node.lineno - 1, node.end_lineno
    body = "".join(lines[first:last])
    if mutant.old in body:
        changed = body.replace(mutant.old, mutant.new)
        whole = "".join(lines[:first]) + changed + "".join(lines[last:])
    elif mutant.old in text:
        whole = text.replace(mutant.old, mutant.new)
    else:
        return None
    made = ModuleType(module.__name__)
    made.__file__ = module.__file__
    # Changes may name plants that the module does not use.
    made.__dict__.update({n: v for n, v in vars(instances).items() if not n.startswith("_")})
    exec(compile(whole, str(module.__file__), "exec"), made.__dict__)
    found: Procedure = made.__dict__[procedure.__name__]
    return found


def outcome(mutant: Mutant) -> str:
    """Why the examination fails with a mutant; an empty text if it holds.

    Raises
    ------
    ValueError
        If the mutant does not apply.
    """
    procedure = mutated(mutant, procedures()[mutant.key])
    if procedure is None:
        raise ValueError(f"{mutant.key}: this is no longer there: {mutant.old}")
    return examined(mutant.key, procedure).failure


def main(keys: list[str]) -> int:
    """Try all mutants, or those of some examinations, and list them."""
    chosen = [each for each in mutants() if not keys or each.key in keys]
    survivors = []
    for mutant in chosen:
        why = outcome(mutant)
        said = f"caught: {why}" if why else "SURVIVES"
        print(f"{mutant.key}: {mutant.kind}: {mutant.old} -> {mutant.new}\n    {said}", flush=True)
        survivors += [mutant] if not why else []
    count = Counter(each.key for each in chosen)
    few = [each.key for each in examinations() if not keys and count[each.key] < 2]
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} mutants are caught")
    if few:
        print(f"fewer than two: {', '.join(few)}")
    return 1 if survivors or few else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
