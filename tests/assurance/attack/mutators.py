"""Ways to change a certificate: tokens of its text, nodes and numbers, names, splices, systems."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from tests.oracle.drawn.plants import Document

Path = tuple[str | int, ...]
PARTS = ("system", "subject", "claim", "witness")
LARGE_PRIMES = (2147483647, 1000000007, 2305843009213693951, 998244353, 4294967291, 1000003)
SMALL_MODULI = (2, 3, 4, 5, 6, 7, 9, 11, 15, 35, 30, 77, 101, 1001, 1, 0, -1, -7)
TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|-?[0-9]+|[\[\]{},:]|true|false|null')
ODD_TOKENS = (
    "0", "1", "-1", "2", '"1/2"', '"2/4"', '""', "null", "true", "false", "[]", "{}", "1.0", "1e1",
    "-0", '"1"', "10000000000000000000000", "[0]", '"x"', "[[0]]", "[[]]",
)  # fmt: skip


def copied(document: Any) -> Any:
    """A copy that shares nothing."""
    return json.loads(json.dumps(document))


def nodes(node: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Every node below the root with its path."""
    children: Any = ()
    if isinstance(node, dict):
        children = node.items()
    elif isinstance(node, list):
        children = enumerate(node)
    for key, child in children:
        yield (*path, key), child
        yield from nodes(child, (*path, key))


def at(document: Any, path: Path) -> Any:
    """The node at a path."""
    for key in path:
        document = document[key]
    return document


def put(document: Any, path: Path, value: Any) -> None:
    """Set the node at a path, in place."""
    at(document, path[:-1])[path[-1]] = value


def _is_number(value: Any) -> bool:
    if isinstance(value, bool):
        return False
    return isinstance(value, int) or (isinstance(value, str) and value[:1] in "-0123456789")


def other_number(rng: random.Random, value: Any, modulus: Any = None) -> Any:
    """Another number of the same form: one more or less, 0, the negative, a congruent one.

    In an expression with parameters one number becomes another.
    """
    if isinstance(value, str):
        if "*" in value or " " in value:
            one = rng.choice(list(re.finditer("[0-9]+", value)))
            return f"{value[: one.start()]}{rng.randrange(12)}{value[one.end() :]}"
        if "/" in value:
            p, _, q = value.partition("/")
            return rng.choice([f"{int(p) + int(q)}/{q}", int(p), f"{-int(p)}/{q}", 0])
        digits = len(value.partition(".")[2])
        step = rng.choice((-10, -1, 1, 10)) * 10.0**-digits
        try:
            return f"{float(value) + step:.{digits}f}"
        except ValueError:
            return value
    choices = [value + 1, value - 1, 0, 1, -value, 2 * value, value + 2, "1/2", "-1/3"]
    if isinstance(modulus, int):
        choices.append(value + modulus)
    return rng.choice(choices)


def change_number(rng: random.Random, document: Document, within: str) -> None:
    """One number of a part becomes another."""
    found = [path for path, value in nodes(document[within], (within,)) if _is_number(value)]
    if found:
        path = rng.choice(found)
        modulus = document["witness"].get("modulus") if within == "witness" else None
        put(document, path, other_number(rng, at(document, path), modulus))


def change_node(rng: random.Random, document: Document, within: str) -> None:
    """A node is removed, repeated, swapped, emptied, or gives way to another one."""
    found = [path for path, _ in nodes(document[within], (within,))]
    if not found:
        return
    path = rng.choice(found)
    parent, key = at(document, path[:-1]), path[-1]
    what = rng.randrange(7)
    if what == 0:
        del parent[key]
    elif what == 1 and isinstance(parent, list):
        parent.insert(int(key), copied(parent[int(key)]))
    elif what == 2 and isinstance(parent, list):
        other = rng.randrange(len(parent))
        parent[key], parent[other] = parent[other], parent[key]  # type: ignore[index]
    elif what == 3 and isinstance(parent[key], list | dict):
        parent[key] = type(parent[key])()
    elif what == 4:
        parent[key] = copied(at(document, rng.choice(found)))
    elif isinstance(parent[key], bool):
        parent[key] = not parent[key]
    elif parent[key] is None:
        parent[key] = rng.choice((0, 1, [], {}, "1"))
    elif what == 5:
        parent[key] = None
    else:
        parent[key] = rng.choice((0, 1, [], True, "1"))


def change_token(rng: random.Random, document: Document) -> str:
    """The text with one or two tokens removed, repeated, swapped or replaced."""
    tokens = TOKEN.findall(json.dumps(document))
    for _ in range(rng.choice((1, 1, 2))):
        k = rng.randrange(len(tokens))
        what = rng.randrange(4)
        if what == 0:
            del tokens[k]
        elif what == 1:
            tokens.insert(k, tokens[k])
        elif what == 2:
            other = rng.randrange(len(tokens))
            tokens[k], tokens[other] = tokens[other], tokens[k]
        else:
            tokens[k] = rng.choice((*ODD_TOKENS, rng.choice(tokens)))
    return "".join(tokens)


def respelled(rng: random.Random, document: Document) -> str:
    """The same document in another text: other blanks, escapes and order of keys."""
    shuffled = _shuffled(rng, document)
    return json.dumps(shuffled, indent=rng.choice((None, 0, 1)), ensure_ascii=rng.random() < 0.5)


def _shuffled(rng: random.Random, node: Any) -> Any:
    if isinstance(node, dict):
        keys = list(node)
        rng.shuffle(keys)
        return {key: _shuffled(rng, node[key]) for key in keys}
    return [_shuffled(rng, child) for child in node] if isinstance(node, list) else node


def splice(rng: random.Random, document: Document, other: Document, within: str) -> None:
    """A node gives way to the one at the same place, or under the same key, of another document."""
    there = dict(nodes(other[within], (within,)))
    same = [
        path
        for path, value in nodes(document[within], (within,))
        if there.get(path, value) != value
    ]
    if same and rng.random() < 0.7:
        path = rng.choice(same)
        put(document, path, copied(there[path]))
        return
    by_key: dict[Any, list[Any]] = {}
    for path, value in there.items():
        by_key.setdefault(path[-1], []).append(value)
    found = [path for path, _ in nodes(document[within], (within,)) if path[-1] in by_key]
    if found:
        path = rng.choice(found)
        put(document, path, copied(rng.choice(by_key[path[-1]])))


def crossed(rng: random.Random, document: Document, other: Document) -> Document:
    """Some parts of one document and the rest of another."""
    chosen = [part for part in PARTS if rng.random() < 0.5] or [rng.choice(PARTS)]
    return {**document, **{part: copied(other[part]) for part in chosen}}


FIXED_WORDS = (
    "format", "kind", "time", "construction", "parameter", "share", "property", "side", "method"
)  # fmt: skip
DECIMALS = ("re", "im", "radius", "lower", "upper")


def renamed(document: Document, names: dict[str, str], parts: tuple[str, ...]) -> Document:
    """Names of channels replaced in some parts of a document; in all of them the truth follows."""
    joined = dict(names)
    for step in document["subject"]:
        if isinstance(step, dict) and step.get("construction") == "merged":
            joined |= {"+".join(p): "+".join(names.get(n, n) for n in p) for p in step["parts"]}

    def walk(node: Any, key: Any) -> Any:
        if isinstance(node, dict):
            return {joined.get(k, k): walk(v, k) for k, v in node.items()}
        if isinstance(node, list):
            return [walk(v, key) for v in node]
        renames = isinstance(node, str) and key not in FIXED_WORDS and key not in DECIMALS
        return joined.get(node, node) if renames else node

    return {k: walk(v, k) if k in parts else copied(v) for k, v in document.items()}


def permuted(rng: random.Random, document: Document, parts: tuple[str, ...]) -> Document:
    """Channels in another order: lists of one entry a channel, and sets of names, follow."""
    names = [channel["name"] for channel in document["system"]["channels"]]
    m = len(names)
    order = list(range(m))
    rng.shuffle(order)
    rank = {names[k]: position for position, k in enumerate(order)}

    def by_rank(value: Any) -> Any:
        head = value
        while isinstance(head, list) and head and isinstance(head[0], list):
            head = head[0]
        return (
            [rank.get(v, 0) for v in head if isinstance(v, str)] if isinstance(head, list) else []
        )

    def walk(node: Any, key: Any) -> Any:
        if isinstance(node, dict):
            return {k: walk(v, k) for k, v in node.items()}
        if not isinstance(node, list):
            return node
        made = [walk(v, key) for v in node]
        if (
            key in ("channels", "agents", "gains", "dimensions", "costs", "upper")
            and len(made) == m
        ) and (key != "channels" or isinstance(made[0], dict)):
            return [made[k] for k in order]
        if made and all(isinstance(v, str) and v in rank for v in made):
            return sorted(made, key=rank.__getitem__)
        in_order = key in ("arcs", "added", "candidates", "components", "parts")
        if in_order and all(isinstance(v, list) for v in made):
            return sorted(made, key=by_rank)
        return made

    return {k: walk(v, k) if k in parts else copied(v) for k, v in document.items()}


def multiplied(rng: random.Random, document: Document) -> None:
    """Some matrices with a larger denominator that cancels: the same matrices."""
    factor = rng.choice((2, 3, -1))
    for _, node in list(nodes(document)):
        if isinstance(node, dict) and "denominator" in node and rng.random() < 0.7:
            node["denominator"] *= factor
            key = "entries" if "entries" in node else "coefficients"
            node[key] = _scaled(node[key], factor)


def _scaled(node: Any, factor: int) -> Any:
    return [_scaled(v, factor) for v in node] if isinstance(node, list) else node * factor


def other_modulus(rng: random.Random, document: Document, choices: tuple[int, ...]) -> None:
    """Another modulus wherever there is one."""
    for path, _ in list(nodes(document["witness"], ("witness",))):
        if path[-1] == "modulus" and at(document, path) is not None:
            put(document, path, rng.choice(choices))
        elif path[-1] == "moduli" and rng.random() < 0.5:
            value = at(document, path)
            if isinstance(value, list) and value:
                value[rng.randrange(len(value))] = rng.choice(choices)


def other_gains(rng: random.Random, document: Document, most: int) -> None:
    """Drawn gains in the witness; 0 draws zeros."""
    for path, node in list(nodes(document["witness"], ("witness",))):
        if path[-1] == "gains" and isinstance(node, list):
            for F in node:
                if isinstance(F, dict) and isinstance(F.get("entries"), list):
                    F["entries"] = [[rng.randint(-most, most) for _ in row] for row in F["entries"]]


Edit = Callable[[random.Random, Document], Any]


def edits() -> dict[str, Edit]:
    """Changes of one document, in place, by name."""
    made: dict[str, Edit] = {}
    for part in PARTS:
        made[f"number in {part}"] = partial(change_number, within=part)
        made[f"node in {part}"] = partial(change_node, within=part)
    made["denominators"] = multiplied
    made["large prime"] = lambda rng, d: other_modulus(rng, d, LARGE_PRIMES)
    made["small or composite modulus"] = lambda rng, d: other_modulus(rng, d, SMALL_MODULI)
    made["other gains"] = lambda rng, d: other_gains(rng, d, rng.choice((1, 10, 10**9)))
    made["zero gains"] = lambda rng, d: other_gains(rng, d, 0)
    return made


EDITS = edits()
