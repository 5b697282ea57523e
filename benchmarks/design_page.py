"""The page ``DESIGNS.md`` of what `gallery_designs` and `families` measured, exceptions first.

Run as ``python -m benchmarks.design_page``; both write it, too.  Nothing in it is typed by hand
but the remarks about exceptions below.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from math import inf, isfinite
from pathlib import Path
from statistics import median

from benchmarks.kept_rows import ROWS, Row, kept
from mcexact.synthesis.assessment import FAILS
from mcexact.synthesis.optimum.figures import DISK, TOGETHER
from mcexact.synthesis.optimum.figures import LEAST_DAMPING as DAMPING

PAGE = Path(__file__).with_name("DESIGNS.md")
RATIO, SECONDS = 2.0, 60.0
_HAND = ("static BFGS", "local LQR", "local LQG", "python-control")
Rows = Mapping[str, Row]

REMARKS: Mapping[str, str] = {
    "compleib-tf1 decentralized": "the mode -1/100000 is fixed without communication, and no bound "
    "for controllers without communication is known",
}
"""What is known of exceptions that their figures do not tell, by the names of rows."""

_HEAD = """\
# Controllers for published plants, and for families of plants

`make designs` asks for a controller without a rate, that is for the least cost with disk margins of
0.4 in every single loop. `python -m benchmarks.gallery_designs` does so for every plant of the
gallery: without communication, with shared sub-states (over the plant's own links, or else over a
ring), and for set-points. `python -m benchmarks.families` does so for eight families of 10, 40 and
120 states, in continuous time and sampled. Both continue after an interruption, and a row is
measured again once it is removed from `rows/`.

- cost/bound: the cost over a lower bound for every linear controller, both proved; ≈ where they are
  computed; in parentheses that of the recorded controller of before. The bound holds for
  controllers without integrators, too, so that set-points have their price in it;
- disk: the least disk margin of a single input or output, with the other loops closed, proved; ≈
  where it is computed;
- joint: the smaller one of the margins of all inputs together and of all outputs together;
- damping: the least damping ratio of an eigenvalue, computed;
- box: every plant whose entries differ by at most this part is proved to be stable;
- order: the states of all agents together (before: in parentheses);
- seconds: of a processor, for the search, the proofs and the box, on a machine that had other work.

Before: each controller of the gallery was asked for at half the sensible rate, and those of the
families at fixed rates. Their cost was recorded with white noise of outputs and without proof; here
it stands over today's bound. Their disk margins, dampings and boxes were not recorded, and verdicts
of the gallery alone. The last columns are controllers by hand, with cost/bound and the least disk
margin, computed: one static gain for each agent by BFGS on the same cost (for up to 60 states); for
each agent the optimal state feedback of its own part of the plant (local LQR) and the optimal
controller of its own part (local LQG); and the optimal controller of all agents together by
python-control, which nobody can build who has no fast links between all agents.

`python -m benchmarks.one_agent` asks for the exceptions again, for one agent that has all outputs
and all inputs: where the same search finds nothing better, the plant is the reason, and not what
its agents do not know.
"""


def is_refused(row: Row) -> bool:
    """Whether no controller exists, which is proved."""
    return bool(row["answer"] in ("refused", "Impossible"))


def ratio_of(row: Row) -> float:
    """The proved cost over the bound; infinite without a controller or without a proof."""
    return float(row.get("proved ratio") or inf)


def exceptions(row: Row) -> list[str]:
    """What a practitioner should know of a row before using the controller."""
    if is_refused(row):
        return []
    if row["answer"] not in ("designed", "theorem"):
        return [f"no controller: {_short(row['told'])}"]
    told = list[str]()
    if row["answer"] == "theorem":
        told.append("the controller of the theorem")
    if row["proved ratio"] is None:
        told.append(f"cost/bound is not proved ({_why_not(row)})")
    elif row["proved ratio"] > RATIO:
        told.append(f"cost/bound {row['proved ratio']:.3g}")
    if row["disk"] is None or row["disk"] < DISK:
        told.append(f"disk margin {_figure(row['disk'])}")
    if row["damping"] is not None and row["damping"] < DAMPING:
        told.append(f"damping {row['damping']:.2g}")
    if row["seconds"] > SECONDS:
        told.append(f"{row['seconds']:.0f} seconds")
    if row["install"] != "yes":
        told.append("not to be installed" if row["install"] == "no" else "with care")
    return told


def is_open(row: Row) -> bool:
    """Whether a controller is an exception for what it does, and no proof says why."""
    if row["answer"] not in ("designed", "theorem") or (row.get("beyond all") or inf) < FAILS:
        return False
    slow = row["damping"] is not None and row["damping"] < DAMPING
    fragile = row["disk"] is None or row["disk"] < DISK
    return slow or fragile or row["install"] != "yes" or (row["ratio"] or inf) > RATIO


def _why_not(row: Row) -> str:
    reasons = row["why not"]
    told = [f"{name}: {reasons[name]}" for name in ("loop_cost", "cost_bound") if name in reasons]
    return "; ".join(told).replace("_", " ") or "the loop is not stable in double precision"


def reason(row: Row, alone: Row | None = None) -> str:
    """Why a row is an exception, where that is known.

    Parameters
    ----------
    row : dict
    alone : dict, optional
        What the same search finds for one agent that has all outputs and all inputs.
    """
    told = list[str]()
    if row["name"] in REMARKS:
        told.append(REMARKS[row["name"]])
    if row["name"].endswith(" setpoint") and (row.get("ratio") or 0.0) > RATIO:
        told.append("the bound is for controllers that hold no set-points")
    central = (row.get("by hand") or {}).get("python-control")
    if alone is not None and is_open(row):
        told.append(_of_one_agent(row, alone))
    elif central is not None and central["disk"] < DISK:
        told.append(
            f"the cheapest controller for all agents has a disk margin of {central['disk']:.2g}"
        )
    if (row.get("beyond all") or inf) < FAILS:
        told.append(
            f"no controller, not even one for all agents, stabilizes a plant within "
            f"{100 * row['beyond all']:.3g} % of each entry (proved)"
        )
    if row["answer"] in ("designed", "theorem"):
        told += row["warnings"][:1]
        told += row.get("missed", [])
    return "; ".join(told)


def _of_one_agent(row: Row, alone: Row) -> str:
    """What the same search finds for one agent, in the figures that make the row an exception."""
    whose = "by the same search one controller for all agents"
    if alone["answer"] not in ("designed", "theorem"):
        return f"{whose} was not found: {_short(alone['told'])}"
    figures = list[str]()
    if row["ratio"] is None or row["ratio"] > RATIO:
        figures.append(f"cost/bound {_figure(alone['ratio'])}")
    if row["disk"] is None or row["disk"] < DISK:
        figures.append(f"disk margin {_figure(alone['disk'])}")
    if row["joint"] is None or row["joint"] < TOGETHER:
        figures.append(f"joint margin {_figure(alone['joint'])}")
    if row["damping"] is not None and row["damping"] < DAMPING:
        figures.append(f"damping {_figure(alone['damping'])}")
    if (row["fails within"] or inf) < FAILS:
        within = alone["fails within"]
        part = "none" if within is None else f"one within {100 * within:.3g} %"
        figures.append(f"plants nearby that fail: {part}")
    verdict = _VERDICTS[alone["install"]]
    return f"{whose} has {', '.join([*figures, verdict])}"


def page(gallery: Rows, families: Rows, before: Rows, alone: Rows | None = None) -> str:
    """The whole page.

    Parameters
    ----------
    gallery, families : mapping of str to row
        What was measured.
    before : mapping of str to row
        What was recorded of the same requests before there was a search for the least cost.
    alone : mapping of str to row, optional
        What the same search finds for one agent in place of several, for exceptions.
    """
    both, alone = {**gallery, **families}, alone or {}
    lines = [_HEAD, f"Measured on {'; '.join(sorted({r['machine'] for r in both.values()}))}.", ""]
    lines += ["## Summary", "", *_summary(gallery, families, before), ""]
    lines += [_verdicts(both, before), ""]
    missing = [name for name in before if name not in both]
    if missing:
        told = f"Not measured yet, {len(missing)} of {len(both) + len(missing)} requests"
        lines += [f"{told}: {', '.join(missing)}.", ""]
    lines += ["## Exceptions", "", _told_of_exceptions(both), ""]
    odd = [row for row in both.values() if exceptions(row)]
    lines += _table(
        ("plant or family", "what", "why"),
        [
            (row["name"], "; ".join(exceptions(row)), reason(row, alone.get(row["name"])))
            for row in odd
        ],
    )
    for title, rows in (("Published plants", gallery), ("Families", families)):
        answers = Counter(_ANSWERS[row["answer"]] for row in rows.values())
        counted = ", ".join(f"{count} {each}" for each, count in answers.items())
        lines += [f"## {title}", "", f"Of {len(rows)} requests: {counted}.", ""]
        shown = [
            _designed(row, before.get(row["name"])) for row in rows.values() if not is_refused(row)
        ]
        lines += _table(_COLUMNS, shown)
        refused = [row for row in rows.values() if is_refused(row)]
        if refused:
            lines += [f"### {title}: refused, with a proof", ""]
            lines += _table(
                ("plant", "because", "seconds"),
                [(row["name"], _short(row["told"]), f"{row['seconds']}") for row in refused],
            )
    return "\n".join(lines)


_COLUMNS = (
    "plant", "cost/bound", "disk", "joint", "damping", "box", "order", "seconds", "verdict", *_HAND,
)  # fmt: skip
_VERDICTS = {"yes": "worth installing", "with care": "with care", "no": "do not install"}
_ANSWERS = {
    "designed": "designed",
    "refused": "refused with a proof",
    "theorem": "answered by the controller of the theorem",
    "limit": "ended at a limit",
    "out of reach": "out of reach for all agents together",
}


def _summary(gallery: Rows, families: Rows, before: Rows) -> Iterator[str]:
    """Medians and counts, with everything that is no proved refusal."""
    for title, rows in (
        ("published plants without communication", _only(gallery, "decentralized")),
        ("published plants with shared sub-states", _only(gallery, "extended")),
        ("published plants with set-points", _only(gallery, "setpoint")),
        ("families", families),
        ("all rows", {**gallery, **families}),
    ):
        able = [row for row in rows.values() if not is_refused(row)]
        if not able:
            continue
        ratios = [ratio_of(row) for row in able]
        old = [value for row in able if (value := _old_ratio(before.get(row["name"]), row))]
        disks = sum((row.get("disk") or 0.0) >= DISK for row in able)
        accepted = [row for row in able if row.get("install") == "yes"]
        least = min((row["disk"] or 0.0 for row in accepted), default=inf)
        were = sum((before.get(name) or {}).get("install") == "yes" for name in rows)
        known = any("install" in (before.get(name) or {}) for name in rows)
        median_before = f" (before {median(old):.3g} of {len(old)}, computed)" if old else ""
        counted = f" (before {were} of those recorded, less strictly)" if known else ""
        yield (
            f"- {title}: {len(able)} of {len(rows)} requests are not refused with a proof; median "
            f"of cost/bound {median(ratios):.3g}{median_before}, an open one counted as infinite; "
            f"single-loop disk at least {DISK} for {disks}; worth installing "
            f"{len(accepted)}{counted}, with a disk margin of at least {least:.3g}."
        )


def _verdicts(rows: Rows, before: Rows) -> str:
    """Which rows are worth installing now and were so before, where a verdict was recorded."""
    were = [name for name, old in before.items() if old.get("install") == "yes" and name in rows]
    are = {name for name, row in rows.items() if row.get("install") == "yes"}
    told = [name for name in rows if "install" in before.get(name, {})]
    lost = [name for name in were if name not in are]
    never = [name for name in lost if (rows[name].get("beyond all") or inf) < FAILS]
    open_ = [name for name in lost if name not in never]
    new = [name for name in told if name in are and name not in were]
    rest = [name for name in rows if name in are and name not in told]
    kept_ones = len(were) - len(lost)
    return (
        f"Worth installing: a verdict of before was recorded for {len(told)} rows. {len(were)} of "
        f"them were worth installing, and {kept_ones} of these {len(were)} are so now, besides "
        f"{len(new)} others of the {len(told)} ({_listed(new)}) and {len(rest)} rows without a "
        f"recorded verdict. Of the {len(lost)} that no longer are, {len(never)} cannot be: a plant "
        f"within 1 % of each entry has no controller at all, which is proved ({_listed(never)}). "
        f"No controller of the others was found that is: {_listed(open_)}."
    )


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"


def _only(rows: Rows, structure: str) -> Rows:
    return {name: row for name, row in rows.items() if name.endswith(f" {structure}")}


def _old_ratio(old: Row | None, new: Row) -> float | None:
    """The recorded cost over today's bound; None where one of the two is not known."""
    central = (old or {}).get("central") or {}
    least = new.get("least")
    if old is None or not old.get("cost") or not central or not least:
        return None
    if new["name"].endswith(" setpoint"):  # what was recorded counts the integrals, too
        return None
    return float(old["cost"] * central["cost"] / least)


def _told_of_exceptions(rows: Rows) -> str:
    odd = sum(1 for row in rows.values() if exceptions(row))
    return (
        f"Of {len(rows)} requests, {odd} are exceptions: no controller, that of the theorem, a "
        f"cost above {RATIO:g} times the bound or not proved, a disk margin below {DISK}, a "
        f"damping ratio below {DAMPING}, more than {SECONDS:.0f} seconds, or a controller that "
        "is to be installed with care or not at all. The most important warning of each is the "
        "reason."
    )


def _designed(row: Row, old: Row | None) -> tuple[str, ...]:
    if row["answer"] not in ("designed", "theorem"):
        blank = ("∞", *["–"] * 5, f"{row['seconds']}", _ANSWERS[row["answer"]])
        return row["name"], *blank, *(_by_hand(row["by hand"], name) for name in _HAND)
    ratio, was = row["ratio"], _old_ratio(old, row)
    cost = _proved(ratio, proved=row["proved ratio"] is not None)
    order = str(row["order"])
    return (
        row["name"],
        cost if was is None else f"{cost} ({was:.3g})",
        _proved(row["disk"], proved=row["disk is proved"]),
        *(_figure(row[name]) for name in ("joint", "damping")),
        "–" if row["box"] is None else f"{100 * row['box']:.2g} %",
        order if old is None or "order" not in old else f"{order} ({old['order']})",
        f"{row['seconds']}",
        _VERDICTS[row["install"]],
        *(_by_hand(row["by hand"], name) for name in _HAND),
    )


def _proved(value: float | None, *, proved: bool) -> str:
    return _figure(value) if proved or value is None else f"≈ {_figure(value)}"


def _figure(value: float | None) -> str:
    """Three digits, or a dash where a figure is not known."""
    return "–" if value is None or not isfinite(value) else f"{value:.3g}"


def _by_hand(found: Row, name: str) -> str:
    """Cost over the bound, and the least disk margin."""
    if name not in found:
        return "–"
    seen = found[name]
    return "not stable" if seen is None else f"{_figure(seen['over bound'])}, {seen['disk']:.2g}"


def _short(told: str, most: int = 160) -> str:
    return told if len(told) <= most else f"{told[:most].rsplit(' ', 1)[0]} …"


def _table(columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    lines = [" | ".join(columns), "|".join("---" for _ in columns)]
    lines += [" | ".join(cell.replace("|", "\\|") for cell in row) for row in rows]
    return [f"| {line} |" if k != 1 else f"|{line}|" for k, line in enumerate(lines)] + [""]


def written() -> str:
    """The page of the rows that are kept."""
    names = "gallery_designs", "families"
    gallery, families = (kept(ROWS / f"{name}.jsonl") for name in names)
    before = [kept(ROWS / f"{name}_before.jsonl") for name in names]
    return page(gallery, families, before[0] | before[1], kept(ROWS / "one_agent.jsonl"))


if __name__ == "__main__":
    PAGE.write_text(written(), encoding="utf-8")
