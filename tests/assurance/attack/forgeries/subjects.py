"""The same claim about another subject, made by other constructions or in another order."""

from __future__ import annotations

import copy
import random
from fractions import Fraction

from flint import fmpq, fmpq_mat

from tests.oracle.certificates.algebra import selection
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.reading import Unspecified
from tests.oracle.drawn.plants import Document, number, rows_of, table
from tests.oracle.drawn.subjects import CONSTRUCTIONS, drawn_step, text_of

from ..mutators import PARTS, renamed


def colliding_names(rng: random.Random, document: Document) -> Document | None:
    """Three channels "1+2", "1" and "2", of which the last two are taken as one."""
    names = [channel["name"] for channel in document["system"]["channels"]]
    for step in document["subject"]:
        sizes = sorted(map(len, step.get("parts", ())))
        if sizes == [1, 2]:
            fresh = iter(("1", "2"))
            mapping = {name: "1+2" if [name] in step["parts"] else next(fresh) for name in names}
            return renamed(document, mapping, PARTS)
    return None


def other_time(rng: random.Random, document: Document) -> Document:
    """The plant and its controllers in the other time domain."""
    time = {"continuous": "discrete", "discrete": "continuous"}[document["system"]["time"]]
    document["system"]["time"] = time
    for step in document["subject"]:
        for controller in (step.get("controller"), *step.get("phases", ())):
            if controller is not None:
                controller["time"] = time
    return document


def other_feedthrough(rng: random.Random, document: Document) -> Document:
    """D of the other sign, one entry of the other sign, or two rows or columns exchanged."""
    rows = [[*row] for row in rows_of(document["system"]["D"])]
    what, (q, p) = rng.randrange(4), (len(rows), len(rows[0]))
    if what == 0:
        rows = [[negative(entry) for entry in row] for row in rows]
    elif what == 1:
        i, j = rng.choice([(i, j) for i in range(q) for j in range(p) if rows[i][j]])
        rows[i][j] = negative(rows[i][j])
    elif what == 2:
        i, k = rng.randrange(q), rng.randrange(q)
        rows[i], rows[k] = rows[k], rows[i]
    else:
        j, k = rng.randrange(p), rng.randrange(p)
        for row in rows:
            row[j], row[k] = row[k], row[j]
    document["system"]["D"] = table(rows, p)
    return document


def negative(entry: int | str) -> int | str:
    """The negative of an entry of a plant, as it is written."""
    return number(-Fraction(entry))


def other_phases(rng: random.Random, document: Document) -> Document | None:
    """A phase missing, twice, in another place or with programs of another agent's signals."""
    step = next((s for s in document["subject"] if "phases" in s), None)
    if step is None:
        return None
    phases, what = step["phases"], rng.randrange(6)
    k = rng.randrange(len(phases))
    if what == 0:
        del phases[k]
    elif what == 1:
        phases.insert(rng.randrange(len(phases) + 1), copy.deepcopy(phases[k]))
    elif what == 2:
        rng.shuffle(phases)
    elif what == 3:
        step["phases"] = phases * 2
    elif what == 4:
        program = rng.choice(phases[k]["agents"])
        other = rng.choice(phases[k]["agents"])
        table = {"shape": [1, 1], "entries": [[0, 0, 1]]}
        program["input"].setdefault("outputs", {})[other["name"]] = table
    else:
        rng.choice(phases[k]["agents"])[rng.choice(("shared", "private"))] += 1
    return document


def other_line(rng: random.Random, document: Document) -> Document | None:
    """Another line, a point, another name, no line, or a line behind another construction."""
    steps = document["subject"]
    if not steps or steps[0]["construction"] != "line":
        return None
    line, what = steps[0], rng.randrange(7)
    values = line[rng.choice(("point", "direction"))]
    if what == 0:
        values[rng.choice(sorted(values))] = rng.choice((0, 1, -2, "1/3"))
    elif what == 1:
        line["point"], line["direction"] = line["direction"], line["point"]
    elif what == 2:
        first, second = sorted(values)
        values[first], values[second] = values[second], values[first]
    elif what == 3:
        steps.append(steps.pop(0))
    elif what == 4:
        line["direction"] = dict.fromkeys(line["direction"], 0)
    elif what == 5:
        line["parameter"] = rng.choice(("x", "1", *sorted(values)))
    else:
        document["subject"] = steps[1:]
    return document


def other_part(rng: random.Random, document: Document) -> Document | None:
    """Another subspace, whose polynomial fits: no part of the state that no controller changes."""
    k = next((k for k, s in enumerate(document["subject"]) if "annihilator" in s), None)
    if k is None:
        return None
    step, system = document["subject"][k], subject_of(document, k)
    if rng.random() < 0.3:
        sides = {"unobservable": "uncontrollable", "uncontrollable": "unobservable"}
        step["part"] = sides.get(step["part"], step["part"])
    size, n = len(step["pivots"]), system.n
    pivots = sorted(rng.sample(range(n), size))
    known = step["annihilator"]["denominator"]
    rows = [
        [known * (pivots.index(j) == i) if j in pivots else rng.choice((0, 0, 1, -1, known))
         for j in range(n)]
        for i in range(size)
    ]  # fmt: skip
    if rng.random() < 0.5 and pivots == step["pivots"]:
        rows = step["annihilator"]["entries"]
        rows[rng.randrange(size)][rng.randrange(n)] += rng.choice((1, -1))
    A = system.A.transpose() if step["part"] == "unobservable" else system.A
    W = fmpq_mat(size, n, [fmpq(x, known) for row in rows for x in row])
    own = W * A * selection(n, pivots).transpose()
    step |= {
        "annihilator": {"denominator": known, "entries": rows},
        "pivots": pivots,
        "polynomial": [text_of(x) for x in own.charpoly().coeffs()],
    }
    return document


def other_subject(rng: random.Random, document: Document) -> Document | None:
    """One change of the list of constructions."""
    steps = document["subject"]
    k = rng.randrange(len(steps) + 1)
    what = rng.randrange(4)
    if what == 0 and k < len(steps):
        del steps[k]
    elif what == 1 and len(steps) > 1:
        rng.shuffle(steps)
    else:
        try:
            system = subject_of(document, k)
            name = steps[k]["construction"] if what == 2 and k < len(steps) else None
            step = drawn_step(rng, name or rng.choice(CONSTRUCTIONS), system)
        except (Unspecified, ValueError):
            return None
        if step is None:
            return None
        steps[k : k + bool(name)] = [step]
    return document
