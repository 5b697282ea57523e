"""Folders with a manifest, written by hand about the paper's example, and what is said of them."""

from __future__ import annotations

import copy
import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation, Verdict
from mcexact.checker.sentences import RULES
from tests.checker.handmade import (
    FIXED,
    LOSS,
    MODE,
    PAPER,
    RING,
    Document,
    certificate,
    changed,
    layers,
    matrix,
)

DUAL = {"construction": "dual"}
HEARD = {"construction": "augmented_outputs"}
REACHED = {
    "channels": ["1", "2", "3"],
    "dimension": 3,
    "controllable": True,
    "uncontrollable_polynomial": [1],
}
KRYLOV = {"modulus": 7, "annihilator": matrix(), "pivots": []}
CONTROLLABLE = certificate("controllability", PAPER, REACHED, KRYLOV)
OBSERVABLE = certificate("controllability", PAPER, REACHED, KRYLOV, DUAL)
HEARD_LOSS = changed(
    LOSS,
    ("subject", [HEARD]),
    ("witness.gains", [matrix([1, 0, 0]), matrix([2, 0]), matrix([0, 0, 0])]),
    ("witness.subspace.channels_T", ["1", "3"]),
    ("witness.subspace.V", layers([[0, 0], [0, 0]])),
)

EVIDENCE: dict[str, Document] = {
    "fixed_spectrum": FIXED,
    "completeness": MODE,
    "neighbor_graph": RING,
    "joint_controllability": CONTROLLABLE,
    "joint_observability": OBSERVABLE,
    "shared_dimension_bound_outputs_states": HEARD_LOSS,
    "shared_dimension_bound_states": LOSS,
}
"""Certificates about the paper's example, by the stem of their files."""
BOUND = ("neighbor_graph", "joint_controllability", "joint_observability")


def sentence(rule: str, *premises: str, evidence: Mapping[str, Document] = EVIDENCE) -> Document:
    """A sentence by a rule that rests on all claims of some certificates."""
    because = [
        [f"{name}.json", f"/claim/{key}", value]
        for name in premises
        for key, value in evidence[name]["claim"].items()
    ]
    theorem = RULES[rule].theorem if rule in RULES else ""
    return {"text": "", "rule": rule, "theorem": theorem, "because": because}


SENTENCES = [
    sentence("heading"),
    sentence("not-stabilizable", "fixed_spectrum"),
    sentence("fixed-mode", "fixed_spectrum"),
    sentence("complete", "completeness"),
    sentence("controllable", "joint_controllability"),
    sentence("observable", "joint_observability"),
    sentence("neighbor-graph-connected", "neighbor_graph"),
    sentence("enough-outputs-states", "shared_dimension_bound_outputs_states", *BOUND),
    sentence("enough-states", "shared_dimension_bound_states", *BOUND),
]


def text_of(document: Any) -> bytes:
    """The bytes of a document."""
    return json.dumps(document, sort_keys=True, separators=(",", ":")).encode("ascii") + b"\n"


def sampled_subject(documents: Iterable[Document]) -> Document:
    """The subject of a manifest about a sampled plant; nothing where another one is sampled."""
    first = [each["subject"][:1] for each in documents]
    steps = [step for steps in first for step in steps if step["construction"] == "sampled"]
    return {"subject": steps[:1]} if steps and len(steps) == len(first) else {}


def manifest(
    evidence: Mapping[str, Document] = EVIDENCE, sentences: Sequence[Document] = SENTENCES
) -> Document:
    """The manifest of these certificates."""
    files = {f"{name}.json": text_of(document) for name, document in evidence.items()}
    return {
        "format": "mcexact-manifest/1",
        **sampled_subject(evidence.values()),
        "certificates": {name: hashlib.sha256(text).hexdigest() for name, text in files.items()},
        "sentences": copy.deepcopy(list(sentences)),
    }


def write(
    folder: Path, evidence: Mapping[str, Document] = EVIDENCE, listed: Document | None = None
) -> Path:
    """Write certificates and their manifest, or another one."""
    for name, document in evidence.items():
        (folder / f"{name}.json").write_bytes(text_of(document))
    document = manifest(evidence) if listed is None else listed
    (folder / "manifest.json").write_bytes(text_of(document))
    return folder


def said(
    folder: Path, expected: Expectation | None = None, limits: Limits | None = None
) -> list[Verdict]:
    """The verdicts on a folder, of certificates that are not VALID first."""
    found = manifest_verdicts(str(folder), expected or Expectation(), limits or Limits())
    return [verdict for _, verdict in found if verdict.verdict != "VALID"]


def one(folder: Path, what: Document, evidence: Mapping[str, Document] = EVIDENCE) -> Verdict:
    """The verdict on one sentence, all certificates being VALID."""
    (verdict,) = said(write(folder, evidence, manifest(evidence, [what])))
    return verdict


def places(node: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[Any, Any]]:
    """Every node of a document with its path, the root first."""
    yield path, node
    children: Any = ()
    if isinstance(node, dict):
        children = node.items()
    elif isinstance(node, list):
        children = enumerate(node)
    for key, child in children:
        yield from places(child, (*path, key))


def replaced(document: Document, path: tuple[str | int, ...], value: Any) -> Document:
    """A copy in which one node is another one."""
    result = copy.deepcopy(document)
    node: Any = result
    for key in path[:-1]:
        node = node[key]
    node[path[-1]] = value
    return result


def digest_of(file: Path) -> str:
    """The SHA-256 of the bytes of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
