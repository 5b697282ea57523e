"""The files of machine-checked proofs in an order to read them, and what each rests on.

`make ledger` writes both into READING.md.
"""

from __future__ import annotations

import re
from pathlib import Path

HERE = Path(__file__).parent


def required() -> dict[str, set[str]]:
    """Each file without its ending, and the files of this folder that it requires."""
    sentence = re.compile(r"^From mcexact Require Import ([\w\s]+)\.$", re.MULTILINE)
    return {
        path.stem: {name for names in sentence.findall(path.read_text()) for name in names.split()}
        for path in sorted(HERE.glob("*.v"))
    }


def below(graph: dict[str, set[str]]) -> dict[str, set[str]]:
    """Each file, and all files that it rests on, directly or not."""
    found: dict[str, set[str]] = {}

    def reach(name: str) -> set[str]:
        if name not in found:
            found[name] = graph[name].union(*(reach(other) for other in graph[name]))
        return found[name]

    for name in graph:
        reach(name)
    return found


def direct(graph: dict[str, set[str]]) -> dict[str, list[str]]:
    """The arcs that no path of others replaces."""
    rests = below(graph)
    return {
        name: sorted(
            other for other in others if not any(other in rests[third] for third in others)
        )
        for name, others in graph.items()
    }


def subject(name: str) -> str:
    """The first sentence of the comment at the head of a file."""
    text = (HERE / f"{name}.v").read_text()
    comment = re.sub(r"\s+", " ", text[2 : text.index("*)")]).strip()
    sentence = re.match(r".*?\.(?= |$)", comment)
    return (sentence[0] if sentence else comment).rstrip(".").replace("|", "\\|")


def reading_table() -> str:
    """The files, each after all that it rests on, with those directly below it."""
    graph = required()
    rests, arcs = below(graph), direct(graph)
    lines = ["| file | about | rests directly on |", "|---|---|---|"]
    for name in sorted(graph, key=lambda each: (len(rests[each]), each)):
        others = ", ".join(f"`{other}`" for other in arcs[name])
        lines.append(f"| [`{name}`]({name}.v) | {subject(name)} | {others} |")
    return "\n".join(lines) + "\n"


PAGE = """# The proofs in an order to read them

The folder [kernel](kernel) is read apart: lists, systems and residues, then the rules, facts and
kinds last. Here is every file after all that it rests on; the comment at its head says what it
proves and defines.
[paper.v](paper.v) is the paper in its own order, and `instances*.v` apply the theorems to concrete
systems. The table is the graph of the files, without arcs that follow from others; `make ledger`
makes it.

"""


if __name__ == "__main__":
    (HERE / "READING.md").write_text(PAGE + reading_table(), encoding="utf-8")
