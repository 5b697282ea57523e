"""A second writer of statements, which fills in the templates of FORMAT.md and knows no other."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from mcexact import answer
from mcexact.model.system_file import digest
from tests.checker.oracles.subjects import plant_of, subject_of

Document = dict[str, Any]
TEXT = Path(answer.__file__).with_name("FORMAT.md").read_text(encoding="utf-8")
HOLE = re.compile("⟨([^⟩]*)⟩")
NEVER = "no mode that is fixed under linear time-invariant decentralized control"


def table(title: str) -> list[list[str]]:
    """The rows of the table behind a title, the code marks taken off the last column."""
    found = TEXT.partition(f"### {title}\n")[2].partition("\n###")[0].partition("\n## ")[0]
    rows = [line[1:-1].split("|") for line in found.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows[2:]]


WORDS = {row[0].strip("`"): row[1][1:-1] for row in table("The system in words")}
SENTENCES = [row for row in table("The sentence") if row[0]]


def number(value: Any) -> str:
    """A number in lowest terms."""
    return str(Fraction(value))


def plain(value: Any) -> Any:
    """A number or a matrix of a certificate as the system object has it."""
    if isinstance(value, dict) and {"denominator", "entries"} == value.keys():
        rows = [[Fraction(x, value["denominator"]) for x in row] for row in value["entries"]]
        return [[int(x) if x.denominator == 1 else str(x) for x in row] for row in rows]
    return value


def json_of(value: Any) -> str:
    """Canonical JSON."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


def digested(value: Any) -> str:
    """The digest of the JSON, and the JSON if it is short."""
    text = json_of(value)
    key = hashlib.sha256(text.encode()).hexdigest()
    return f"SHA-256 {key} = {text}" if len(text) <= 80 else f"SHA-256 {key}"


def names(value: Sequence[str]) -> str:
    """A set of channels."""
    return "{" + ", ".join(json.dumps(name) for name in value) + "}"


def edges(value: Any) -> str:
    """A set of edges."""
    parts = []
    for j, i, *cost in value:
        tail = f": {number(cost[0])}" if cost else ""
        parts.append(f"{json.dumps(j)} -> {json.dumps(i)}{tail}")
    return "{" + ", ".join(parts) + "}"


def polynomial(p: Sequence[Any]) -> str:
    """A polynomial, highest power first."""
    text = ""
    for k in reversed(range(len(p))):
        c = Fraction(p[k])
        if c:
            power = ["", "x"][k] if k < 2 else f"x^{k}"
            size = "" if power and abs(c) == 1 else number(abs(c)) + ("*" if power else "")
            sign = (" - " if c < 0 else " + ") if text else ("-" if c < 0 else "")
            text += sign + size + power
    return text


def discs(value: Any) -> str:
    """A set of discs, in the order of their centers."""
    listed = sorted(tuple(Fraction(d[key]) for key in ("re", "im", "radius")) for d in value)
    parts = []
    for a, b, radius in listed:
        middle = f" + {b}i" if b > 0 else f" - {-b}i" if b else ""
        parts.append(f"{a}{middle} +- {radius}")
    return "{" + ", ".join(parts) + "}"


def region(bound: Any, time: str) -> str:
    """Where roots lie."""
    limit = Fraction(int(time == "discrete") if bound is None else bound)
    return f"modulus below {limit}" if time == "discrete" else f"real part below {-limit}"


def controller(value: Document) -> Document:
    """A controller without what is null or empty, and without holds of 0."""

    def dense(M: Any) -> Any:
        if isinstance(M, dict):
            r, c = M["shape"]
            rows = [[0] * c for _ in range(r)]
            for i, j, entry in M["entries"]:
                rows[i][j] = entry
            M = rows
        rows = [[Fraction(entry) for entry in row] for row in M]
        return [[int(x) if x.denominator == 1 else str(x) for x in row] for row in rows]

    def part(key: str, given: Any) -> Any:
        if key in {"private", "reference"}:
            return dense(given)
        return {name: dense(M) for name, M in given.items() if M is not None}

    agents = []
    for agent in value["agents"]:
        hold = {name: d for name, d in (agent.get("hold") or {}).items() if d}
        kept = {key: agent[key] for key in ("name", "shared", "private")} | {"hold": hold}
        for label in ("shared_update", "private_update", "input"):
            found = {k: part(k, v) for k, v in agent[label].items() if v is not None}
            kept[label] = {k: v for k, v in found.items() if v != {}}
        agents.append({k: v for k, v in kept.items() if v != {}})
    return {"time": value["time"], "agents": agents}


def words(document: Document) -> str:
    """The system of a document."""
    text = f"the plant {digest(plant_of(document))}"
    known = [channel["name"] for channel in document["system"]["channels"]]
    for step in document["subject"]:
        filled = HOLE.sub(
            lambda hole, step=step, known=known: _part(hole[1], step, known),
            WORDS[step["construction"]],
        )
        if filled.endswith("of: "):
            text = filled + text
        else:
            text = f"{text if text.startswith(('the plant', '(')) else f'({text})'} {filled}"
        if step["construction"] in {"merged", "closed_loop"}:
            known = ["+".join(part) for part in step.get("parts", [])]
    return text


def _part(hole: str, step: Document, known: list[str]) -> str:
    """A parameter of a construction."""

    def by_name(key: str) -> Document:
        return dict(zip(known, map(plain, step[key]), strict=True))

    parts: dict[str, Callable[[], str]] = {
        "gains, digested": lambda: digested(by_name("gains")),
        "channel": lambda: json.dumps(step["channel"]),
        "added, sorted in the order of the channels": lambda: edges(
            sorted(step["added"], key=lambda edge: [known.index(end) for end in edge])
        ),
        "sharing": lambda: sharing(step),
        "dimensions by channel": lambda: json_of(by_name("dimensions")),
        "the sets of channels, joined by a comma and a blank": lambda: ", ".join(
            map(names, step["parts"])
        ),
        "controller, digested": lambda: digested(controller(step["controller"])),
    }
    return parts[hole]()


def sharing(given: Document) -> str:
    """What is shared."""
    return {"outputs+states": "outputs and sub-states", "states": "sub-states"}[given["share"]]


def applies(where: str, claim: Document) -> bool:
    """Whether the row of a kind is the one for a claim."""
    if where in {"", "else"}:
        return True
    key = where.split("`")[1]
    holds = {"is null": claim[key] is None, "is 1": claim[key] == [1]}.get(
        where.rpartition("` ")[2], claim[key]
    )
    return bool(holds) != where.startswith("not ")


def statement(document: Document) -> str:
    """The statement of a VALID certificate."""
    subject, claim = subject_of(document), document["claim"]
    names_of = f"channels {names(subject.names)}" if subject.m else "no channels"
    states = f"{subject.n} state{'' if subject.n == 1 else 's'}"
    rows = [row for row in SENTENCES if row[0] == f"`{document['kind']}`"]
    template = next(row[2] for row in rows if applies(row[1], claim))
    if template.startswith("the same, then "):
        template = rows[0][2] + template.removeprefix("the same, then ")
    parts = template.replace("``", "")[1:-1]
    sentence = HOLE.sub(lambda hole: _value(hole[1], claim, subject), parts)
    return f"For {words(document)} ({states}, {names_of}, {subject.time} time): {sentence}"


def _value(hole: str, claim: Document, subject: Any) -> str:
    """What stands for a key of a claim."""
    key, form = hole.split(",")[0].split()[0], hole.partition(" ")[2]
    special = SPECIAL.get(hole)
    if special is not None:
        return special(claim, subject)
    value = claim[key]
    if form == "by channel":
        return json_of(dict(zip(subject.names, value, strict=True)))
    if form == "as JSON":
        return json_of(value)
    if isinstance(value, bool):
        return "" if value else "not "
    if key in {"polynomial", "remnant", "feedback", "error", "uncontrollable_polynomial"}:
        return polynomial(value)
    if key in {"channels", "subset"}:
        return names(value)
    if key in {"arcs", "added", "candidates"}:
        return edges(value)
    return discs(value) if key == "roots" else number(value)


def _freedom(claim: Document, subject: Any) -> str:
    bound = claim.get("bound")
    if bound is None:
        return NEVER
    where = region(bound, subject.time).replace("below", "at least")
    return NEVER.replace("no mode", f"no mode of {where}")


def _shared(claim: Document, subject: Any) -> str:
    if claim["share"] == "outputs":
        return "outputs"
    sizes = json_of(dict(zip(subject.names, claim["dimensions"], strict=True)))
    return f"{sharing(claim)} of dimensions {sizes}"


def _factors(claim: Document, subject: Any) -> str:
    (line,) = re.findall(r"⟨factors⟩ is .*?: `(.*)` \|", TEXT)
    stability = "Schur" if subject.time == "discrete" else "Hurwitz"
    parts = []
    for factor in claim["factors"]:
        fill = HOLE.sub(
            lambda hole, factor=factor: (
                stability if hole[1] == "stability" else _value(hole[1], factor, subject)
            ),
            line,
        )
        parts.append((len(factor["polynomial"]), fill))
    return "; ".join(text for _, text in sorted(parts))


PROPERTY = {"controllable": "(A_F, B_q) controllable", "observable": "(C_q, A_F) observable"}
PROPERTY["both"] = " and ".join(PROPERTY.values())
SLOWEST = {
    "continuous": "minus the largest real part of a fixed mode",
    "discrete": "the largest modulus of a fixed mode",
}
SPECIAL: dict[str, Callable[[Document, Any], str]] = {
    "n": lambda claim, subject: str(subject.n),
    "blocks": lambda claim, subject: (
        str(claim["blocks"])
        if isinstance(claim["blocks"], int)
        else ", ".join(f"{b['dimension']} for {names(b['channels'])}" for b in claim["blocks"])
        or "none"
    ),
    "sharing": lambda claim, subject: sharing(claim),
    "shared": _shared,
    "freedom": _freedom,
    "goal": lambda claim, subject: (
        _freedom(claim, subject)
        + " and a strongly connected transfer graph" * claim["free_assignability"]
    ),
    "graph": lambda claim, subject: (
        "the graph without edges" if subject.neighbors is None else "its neighbor graph"
    ),
    "region": lambda claim, subject: region(claim["bound"], subject.time),
    "factors": _factors,
    "slowest": lambda claim, subject: SLOWEST[subject.time],
    "lower": lambda claim, subject: number(claim["best_rate"]["lower"]),
    "upper": lambda claim, subject: number(claim["best_rate"]["upper"]),
    "index, or none": lambda claim, subject: (
        "none" if claim["index"] is None else str(claim["index"])
    ),
    "invariant_polynomials": lambda claim, subject: (
        ", ".join(map(polynomial, claim["invariant_polynomials"])) or "none"
    ),
    "components": lambda claim, subject: ", ".join(map(names, claim["components"])) or "none",
    "M, digested": lambda claim, subject: digested(plain(claim["M"])),
    "property": lambda claim, subject: PROPERTY[claim["property"]],
    "indices by the names in channels": lambda claim, subject: json_of(
        dict(zip(claim["channels"], claim["indices"], strict=True))
    ),
    "cyclic": lambda claim, subject: ", and A_F cyclic" if claim["cyclic"] else "",
    "S": lambda claim, subject: (
        "[A - I, B; C, 0]" if subject.time == "discrete" else "[A, B; C, 0]"
    ),
    "place": lambda claim, subject: "1" if subject.time == "discrete" else "0",
}
