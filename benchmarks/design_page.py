"""The page ``DESIGNS.md`` of what `gallery_designs` and `families` measured, exceptions first.

Run as ``python -m benchmarks.design_page``; both write it, too.  Nothing in it is typed by hand
but the remarks about exceptions below.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path

from benchmarks.kept_rows import ROWS, Row, kept

PAGE = Path(__file__).with_name("DESIGNS.md")
MARGIN, _DISK, _DAMPING = 0.3, 0.4, 0.05
_PEAK, _TIMES, _DIGITS, _SECONDS, _CHEAPER = 100.0, 10.0, 4, 60.0, 0.8
_HAND = ("local LQR", "local LQG", "python-control")

_NEARLY_EQUAL = "its two pairs of modes differ by one millionth"
REMARKS: Mapping[str, str] = {
    "compleib-tf1 decentralized": "the rate is slower than the mode -1/100000, which is fixed",
    "farina-string-of-vehicles-4 decentralized": "the search keeps away from the border of the "
    "rate, and the gains by hand are near it",
    "slicot-ctdsx-2-2-arnold-laub-eps1e-6 decentralized": _NEARLY_EQUAL,
    "slicot-ctdsx-2-2-arnold-laub-eps1e-6 extended": _NEARLY_EQUAL,
}
"""What is known of exceptions that their figures do not tell."""

_HEAD = """\
# Controllers for published plants, and for families of plants

`python -m benchmarks.gallery_designs` asks for a decentralized controller, one with shared
sub-states (over the plant's own links, or else over a ring) and one that holds set-points, for
every plant of the gallery, without a rate; a row has the rate that was certified.
`python -m benchmarks.families` asks for rates of eight families. Each loop is certified exactly at
the rate of its row. All other figures are computed in floating point and not proved:

- order: the states of all agents together;
- gain: the largest number in a controller;
- margin: an error of the plant's inputs, as a part of them, below which the loop stays stable;
- disk: the least disk margin of a single input or output, with the other loops closed;
- damping: the least damping ratio of an eigenvalue;
- J/bound: the linear-quadratic cost over a lower bound for every linear controller;
- J: the linear-quadratic cost, with weights 1 and 1/100 for the noise of outputs, relative to that
  of the optimal controller of all agents together at the same rate;
- peak: the largest norm of the state from a start of norm 1;
- digits: significant decimal digits of all numbers with which the rate is still certified;
- seconds: of a processor, on a machine that had other work.

In parentheses stands the figure of the optimal controller of all agents together, which nobody can
build who has no fast links between all agents. The last columns are controllers by hand, which
are asked for no rate: for each agent the optimal state feedback of its own part of the plant
(local LQR) and the optimal controller of its own part (local LQG), and the optimal controller of
all agents together by python-control. They have order, margin, J and the slowest eigenvalue.
"""


def exceptions(row: Row) -> list[str]:
    """What a practitioner should know of a row before using the controller."""
    if row["answer"] in ("refused", "Impossible"):
        return []
    if row["answer"] != "designed":
        return [row.get("told") or "the controller of the theorem"]
    told, central = list[str](), row["central"] or {}
    if "slower" in row:
        told.append(f"{row['slower']}, the fastest that was found with the margins")
    if row["margin"] < MARGIN:
        told.append(f"margin {row['margin']:.2g}")
    if row.get("disk", _DISK) < _DISK:
        told.append(f"disk margin {row['disk']:.2g}")
    if row.get("damping", _DAMPING) < _DAMPING:
        told.append(f"damping {row['damping']:.2g}")
    if row["peak"] > _PEAK:
        told.append(f"peak {row['peak']:.3g}")
    if row["cost"] is not None and row["cost"] > _TIMES:
        told.append(f"{row['cost']:.3g} times the cost of one controller for all agents")
    if central and row["gain"] > _TIMES * max(central["gain"], 1.0):
        told.append(f"gain {row['gain']:.3g}, {central['gain']:.3g} for all agents together")
    if row["digits"] is None or row["digits"] > _DIGITS:
        told.append(f"{row['digits'] or 'more than 12'} digits")
    if row["seconds"] > _SECONDS:
        told.append(f"{row['seconds']:.0f} seconds")
    return told + [f"dearer than {name}, {cost:.2f}" for name, cost in _cheaper_by_hand(row)]


def _cheaper_by_hand(row: Row) -> Iterator[tuple[str, float]]:
    """Controllers of single agents of no higher order, which meet the rate and cost much less."""
    for name, seen in row["by hand"].items():
        if seen is None or seen["cost"] is None or name == "python-control":
            continue
        if seen["order"] > row["order"]:
            continue
        robust = seen["margin"] >= min(row["margin"], MARGIN)
        if robust and _meets(row, seen["bound"]) and seen["cost"] < _CHEAPER * row["cost"]:
            yield name, seen["cost"]


def _meets(row: Row, bound: float) -> bool:
    if "radius" in row:
        return bound < float(Fraction(row["radius"]))
    return bound < -float(Fraction(row["rate"]))


def reason(row: Row) -> str:
    """Why a row is an exception, where that is known."""
    told, central = list[str](), row.get("central") or {}
    if central and central["margin"] < MARGIN:
        told.append(f"the margin of one controller for all agents is {central['margin']:.2g}")
    if row.get("step") == "from the theorem's controller":
        told.append("of all starts only the theorem's controller led to the rate")
    if row["name"] in REMARKS:
        told.append(REMARKS[row["name"]])
    return "; ".join(told)


def page(published: Mapping[str, Row], families: Mapping[str, Row]) -> str:
    """The whole page."""
    both = [*published.values(), *families.values()]
    lines = [_HEAD, f"Measured on {'; '.join(sorted({row['machine'] for row in both}))}.", ""]
    lines += ["## Exceptions", "", _told_of_exceptions(both), ""]
    odd = [row for row in both if exceptions(row)]
    lines += _table(
        ("plant or family", "asked", "what", "why"),
        [(row["name"], _asked(row), "; ".join(exceptions(row)), reason(row)) for row in odd],
    )
    for title, rows in (("Published plants", published), ("Families", families)):
        answers = Counter(row["answer"] for row in rows.values())
        counted = ", ".join(f"{count} {_ANSWERS[each]}" for each, count in answers.items())
        lines += [f"## {title}", "", f"Of {len(rows)} requests: {counted}.", ""]
        made = [row for row in rows.values() if row["answer"] == "designed"]
        lines += _table(_COLUMNS, [_designed(row) for row in made])
        refused = [row for row in rows.values() if row["answer"] in ("refused", "Impossible")]
        if refused:
            lines += [f"### {title}: refused, with a proof", ""]
            lines += _table(
                ("plant", "because", "seconds"),
                [(row["name"], _short(row["told"]), f"{row['seconds']}") for row in refused],
            )
    return "\n".join(lines)


_COLUMNS = (
    "plant", "asked", "order", "gain", "margin", "disk", "damping", "J/bound", "J", "peak",
    "digits", "seconds", *_HAND,
)  # fmt: skip
_ANSWERS = {
    "designed": "designed",
    "refused": "refused with a proof",
    "Impossible": "refused with a proof",
    "theorem": "answered by the controller of the theorem",
    "limit": "ended at a limit",
    "LimitReached": "ended at a limit",
    "out of reach": "out of reach for all agents together",
    "OutOfReach": "out of reach for all agents together",
}


def _told_of_exceptions(rows: list[Row]) -> str:
    made = [row for row in rows if row["answer"] == "designed"]
    odd = sum(1 for row in rows if exceptions(row))
    return (
        f"Of {len(made)} designed controllers and {len(rows)} requests, {odd} are exceptions: a "
        "rate that is slower than asked, a "
        f"margin below {MARGIN}, a disk margin below {_DISK}, a damping ratio below {_DAMPING}, a "
        f"peak above {_PEAK:.0f}, a cost or a gain above {_TIMES:.0f} "
        f"times that of one controller for all agents, more than {_DIGITS} digits, more than "
        f"{_SECONDS:.0f} seconds, or controllers by hand, each for one agent, that meet the rate, "
        f"have no higher order, are as robust, and cost less than {_CHEAPER} times as much. The "
        "first line of each design says so, except for time and cost by hand."
    )


def _designed(row: Row) -> tuple[str, ...]:
    central = row["central"] or {}

    def beside(name: str, form: str) -> str:
        told = f"{row[name]:{form}}"
        return f"{told} ({central[name]:{form}})" if name in central else told

    return (
        row["name"], _asked(row), str(row["order"]), beside("gain", ".3g"),
        beside("margin", ".2g"), *(_known(row, name) for name in ("disk", "damping", "over bound")),
        f"{row['cost']:.3g}", beside("peak", ".3g"),
        str(row["digits"]), f"{row['seconds']}",
        *(_by_hand(row["by hand"], name) for name in _HAND),
    )  # fmt: skip


def _known(row: Row, name: str) -> str:
    """A figure that rows of before, and set-points, do not have."""
    return "–" if row.get(name) is None else f"{row[name]:.3g}"


def _by_hand(found: Row, name: str) -> str:
    """Order, margin, relative cost and the slowest eigenvalue."""
    if name not in found:
        return "–"
    seen = found[name]
    if seen is None:
        return "not stable"
    cost = "–" if seen["cost"] is None else f"{seen['cost']:.3g}"
    return f"{seen['order']}, {seen['margin']:.2g}, {cost}, {seen['bound']:.2g}"


def _asked(row: Row) -> str:
    if "radius" in row:
        return f"radius {_decimal(row['radius'])}"
    return f"rate {_decimal(row['rate'])}" if "rate" in row else ""


def _decimal(edge: str) -> str:
    return f"{float(Fraction(edge)):.5g}"


def _short(told: str, most: int = 160) -> str:
    return told if len(told) <= most else f"{told[:most].rsplit(' ', 1)[0]} …"


def _table(columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    lines = [" | ".join(columns), "|".join("---" for _ in columns)]
    lines += [" | ".join(cell.replace("|", "\\|") for cell in row) for row in rows]
    return [f"| {line} |" if k != 1 else f"|{line}|" for k, line in enumerate(lines)] + [""]


def written() -> str:
    """The page of the rows that are kept."""
    found = (kept(ROWS / f"{name}.jsonl") for name in ("gallery_designs", "families"))
    return page(*found)


if __name__ == "__main__":
    PAGE.write_text(written(), encoding="utf-8")
