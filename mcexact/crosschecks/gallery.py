"""Systems with a recorded wrong verdict, and their display.

An `Exhibit` is a system, a question that floating point was recorded to answer wrongly, and the
cause of the error.  Some verdicts depend on the sign of a rounding error, which differs between
processors, so an exhibit is shown with the recorded answer beside the answer of this machine.
`exhibit_tables` and `exhibits_page` display exhibits; `crosscheck_tables` displays the cross-checks
of any system.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.templates import blame
from mcexact.crosschecks.table import (
    CrossCheck,
    CrossChecks,
    Libraries,
    Record,
    crosscheck,
    libraries_of,
    recorded,
)
from mcexact.errors import InternalError, UsageError
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import rounded, written
from mcexact.model import gallery as published
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import nearest, quoted
from mcexact.report.html import page, shown_plant
from mcexact.report.text import Table


@dataclass(frozen=True)
class Exhibit:
    """A system, a question that floating point answered wrongly, and the cause of the error.

    Attributes
    ----------
    name : str
    question : str
        The question, worded as in a `CrossCheck`.
    why : str
    make : callable
        Returns the system.
    """

    name: str
    question: str
    why: str
    make: Callable[[], MultiChannelSystem]

    @property
    def record(self) -> Record:
        """The recorded floating-point answer."""
        entry = recorded()["exhibits"][self.name]
        return Record(entry["floating"], libraries_of(entry["libraries"]))


@dataclass(frozen=True)
class Shown:
    """An exhibit beside the answers of this machine.

    Attributes
    ----------
    exhibit : Exhibit
        The exhibit, with its record.
    here : CrossCheck
        The answers to its question on this machine, exact and in floating point.
    libraries : Libraries
        The libraries of this machine.
    """

    exhibit: Exhibit
    here: CrossCheck
    libraries: Libraries


def shown(exhibit: Exhibit) -> Shown:
    """Answer an exhibit's question on this machine, exactly and in floating point.

    Examples
    --------
    >>> weak = shown(exhibit("weak-input"))
    >>> weak.exhibit.record.floating, weak.here.exact
    ('no, rank 1 of 2', 'yes, rank 2 of 2')
    """
    return _shown(exhibit, crosscheck(exhibit.make()))


def shown_in(crosschecks: CrossChecks) -> tuple[Shown, ...]:
    """Return the exhibits about the system of a table of cross-checks."""
    asked = crosschecks.system.digest()
    return tuple(_shown(each, crosschecks) for each in exhibits() if each.make().digest() == asked)


def _shown(exhibit: Exhibit, crosschecks: CrossChecks) -> Shown:
    rows = {row.question: row for row in crosschecks.rows}
    return Shown(exhibit, rows[exhibit.question], crosschecks.libraries)


def exhibits() -> tuple[Exhibit, ...]:
    """Return all exhibits, published plants first.

    Examples
    --------
    >>> len(exhibits()) >= 10
    True
    """
    return (*_PUBLISHED, *_MADE)


def exhibit(name: str) -> Exhibit:
    """Return the exhibit with a name.

    Raises
    ------
    UsageError
        If no exhibit has this name.
    """
    by_name = {each.name: each for each in exhibits()}
    if name not in by_name:
        raise UsageError(f"there is no exhibit {quoted(name)}{nearest(name, list(by_name))}")
    return by_name[name]


def _from_gallery(name: str) -> Callable[[], MultiChannelSystem]:
    """An exhibit about a system of the gallery, loaded when it is needed."""
    return lambda: published.load(name)


def _published(name: str, question: str, why: str) -> Exhibit:
    return Exhibit(name, question, why, _from_gallery(name))


_PUBLISHED = (
    _published(
        "compleib-tg1",
        "joint controllability",
        "the powers of A grow apart by more than 16 digits, so that columns of the controllability "
        "matrix that are small against the largest pass for zero",
    ),
    _published(
        "compleib-rea3-m1",
        "joint observability",
        "time constants of a reactor spread over many decades: the tolerance, relative to the "
        "largest singular value, leaves 1 of the 10 observable directions",
    ),
    _published(
        "compleib-cse1",
        "stability of A",
        "an eigenvalue lies exactly on the boundary; the computed one fell on the stable side",
    ),
    _published(
        "siljak-two-subsystems-farina",
        "stability of A",
        "an eigenvalue is exactly 0; the computed one was a negative rounding error",
    ),
    _published(
        "farina-three-rooms",
        "transfer graph",
        "heat flows so slowly that the numerators are below the absolute tolerance, although "
        "every room warms every other one",
    ),
    _published(
        "hidden-triple-mode",
        "fixed modes, 8 digits",
        "a fixed mode that is a triple eigenvalue is computed with an error of the order of the "
        "cube root of the machine precision, other in every draw, so that no digits agree",
    ),
    _published(
        "liu2020-unimodular",
        "any fixed mode, pencils",
        "the pencil loses rank at the eigenvalue 1 exactly, but the computed eigenvalue was off by "
        "the square root of the machine precision, and there it has full rank",
    ),
    _published(
        "slicot-ctdsx-2-2-arnold-laub-eps1e-6",
        "fixed modes, 8 digits",
        "a mode is controllable and observable to 1e-6 each, so gains move it by 1e-12: rounding "
        "takes that for not at all",
    ),
)


def _integers_to_twenty() -> MultiChannelSystem:
    """The system A = diag(1, …, 20) with one input that acts on every state."""
    A = [[(i + 1) * (i == j) for j in range(20)] for i in range(20)]
    return MultiChannelSystem(A, [[[1]] * 20], [[[1] * 20]], name="diag(1, ..., 20)")


def _hidden_block() -> MultiChannelSystem:
    """A transformed Jordan block of size 6 for the eigenvalue 2, its first state uncontrollable."""
    J = [[2 * (i == j) + (i == j + 1) for j in range(6)] for i in range(6)]
    S = _unimodular(6)
    back = inverse(S)
    if back is None:
        raise InternalError("a product of triangular matrices with unit diagonals is singular")
    A = S @ Matrix.from_integers(J) @ back
    B = S @ Matrix.column([0, 1, 0, 0, 0, 0])
    C = Matrix.from_integers([[1, 0, 0, 0, 0, 0]])
    return MultiChannelSystem(A, [B], [C], name="an unreachable state of a defective block")


def _slow_and_fast() -> MultiChannelSystem:
    """Two decoupled states, one of them reached by an input of 10⁻²⁰."""
    return MultiChannelSystem([[1, 0], [0, 2]], [[[1], ["1e-20"]]], [[[1, 1]]], name="a weak input")


def _beyond_doubles() -> MultiChannelSystem:
    """Two inputs whose matrix of integers has determinant −1."""
    large = 2**53
    return MultiChannelSystem(
        [[-1, 0], [0, -1]],
        [[[large + 1], [large]], [[large], [large - 1]]],
        [[[1, 0]], [[0, 1]]],
        name="integers beyond 2^53",
    )


def _tenfold_pole() -> MultiChannelSystem:
    """A stable discrete-time system whose one eigenvalue, 99/100, has multiplicity 10."""
    p = Polynomial.of("-99/100", 1) ** 10
    rows = [[int(j == i + 1) for j in range(10)] for i in range(9)]
    A = Matrix.from_rows([*rows, [-c for c in p.coefficients[:10]]])
    B, C = Matrix.column([0] * 9 + [1]), Matrix.from_rows([[1] + [0] * 9])
    return MultiChannelSystem(A, [B], [C], time="discrete", name="a pole of multiplicity 10")


def _stiff_chain() -> MultiChannelSystem:
    """A chain of six states, each a thousand times faster than the one before."""
    A = [[-(1000**i) * (i == j) + (i == j + 1) for j in range(6)] for i in range(6)]
    return MultiChannelSystem(
        A, [[[1], [0], [0], [0], [0], [0]]], [[[0, 0, 0, 0, 0, 1]]], name="a stiff chain"
    )


def _unimodular(n: int) -> Matrix:
    """An integer matrix of determinant 1."""
    lower = Matrix.from_integers(
        [[1 if i == j else (i + 2 * j) % 5 - 2 if i > j else 0 for j in range(n)] for i in range(n)]
    )
    return lower @ lower.T


_MADE = (
    Exhibit(
        "integers-to-twenty",
        "joint controllability",
        "the columns of the controllability matrix are powers of 1, …, 20, up to 20^19: numpy's "
        "tolerance leaves 7 of the 20 directions",
        _integers_to_twenty,
    ),
    Exhibit(
        "unreachable-state",
        "joint controllability, Hautus",
        "the uncontrollable mode belongs to a defective eigenvalue; where it is computed to be, "
        "the rank is full",
        _hidden_block,
    ),
    Exhibit(
        "weak-input",
        "joint controllability",
        "an input of 10^-20 is an input: the tolerance, relative to the other one, drops it",
        _slow_and_fast,
    ),
    Exhibit(
        "beyond-doubles",
        "joint controllability, Hautus",
        "2^53 + 1 is read as 2^53, and even unrounded the determinant, -1, would be far below the "
        "tolerance: two inputs pass for one",
        _beyond_doubles,
    ),
    Exhibit(
        "tenfold-pole",
        "stability of A",
        "an eigenvalue 99/100 of multiplicity 10 is computed as a ring around it, whose radius is "
        "about the tenth root of the machine precision; a part of it is outside the unit circle",
        _tenfold_pole,
    ),
    Exhibit(
        "stiff-chain",
        "controllability index",
        "each state is a thousand times faster than the one before: the ranks of the first blocks "
        "never reach 6 in double precision",
        _stiff_chain,
    ),
)


# The display of cross-checks and of exhibits.

_WORDS = {True: "agree", False: "DISAGREE", None: "no answer"}


def _word(row: CrossCheck) -> str:
    return "within the data" if row.within_data else _WORDS[row.agree]


def crosscheck_view(crosschecks: CrossChecks) -> dict[str, Any]:
    """The cross-checks as plain data: every row, and a plant nearby that has a fixed mode."""
    near = crosschecks.nearest
    return {
        "system": {
            "n": crosschecks.system.n,
            "m": crosschecks.system.m,
            "time": crosschecks.system.time,
        },
        "rows": [
            {
                "question": row.question,
                "call": row.call,
                "floating": row.floating,
                "exact": row.exact,
                "agree": row.agree,
                "within_data": row.within_data,
            }
            for row in crosschecks.rows
        ],
        "disagreements": [row.question for row in crosschecks.disagreements],
        "libraries": crosschecks.libraries.document(),
        "exhibits": exhibits_view(shown_in(crosschecks)),
        "fixed_mode_nearby": None
        if near is None
        else {
            "within": written(near.distance),
            "channels": list(near.channels),
            "plant": near.plant.to_dict(),
        },
    }


def crosscheck_tables(crosschecks: CrossChecks) -> tuple[Table, ...]:
    """The cross-checks as tables: a row for each question, then how near a fixed mode is."""
    rows = tuple(
        (row.question, row.floating, row.exact, _word(row), row.call) for row in crosschecks.rows
    )
    count = len(crosschecks.disagreements)
    verdict = "no disagreement" if not count else f"{count} wrong in floating point"
    if others := len(crosschecks.within_data):
        verdict = f"{count} wrong in floating point, {others} within what the data allow"
    tables = [
        Table(
            f"{crosschecks.system.name or 'system'}: floating point beside exact, {verdict}",
            ("question", "floating point", "exact", "", "floating-point call, default tolerance"),
            rows,
            note=f"in floating point: {crosschecks.libraries}",
        )
    ]
    recorded = shown_in(crosschecks)
    if recorded:
        tables += exhibit_tables(recorded)
    if others and crosschecks.nearby is not None:
        plants = tuple((each.within or "", each.explain()) for each in crosschecks.nearby.leading)
        tables.append(Table("plants that the data allow as well, decided exactly", (), plants))
    near = crosschecks.nearest
    if near is not None:
        lines = (
            ("changes of entries, at most", _part(near.distance)),
            ("the mode that is fixed then", blame(near.channels, near.plant.names)),
        )
        tables.append(Table("a plant nearby with a fixed mode, decided exactly", (), lines))
    return tuple(tables)


def _part(distance: Fraction) -> str:
    """The change of the entries, relative to the largest of them."""
    return f"{rounded(distance)} times the largest entries of A, of all B_i and of all C_i"


def exhibit_tables(shown: Sequence[Shown]) -> tuple[Table, ...]:
    """The exhibits as tables: recorded, local and exact answers; machines; causes."""
    machines = [("recorded", str(libraries)) for libraries in _recorded_by(shown)]
    machines += [("here", str(libraries)) for libraries in _answered_by(shown)]
    return (
        Table(
            "where floating point was recorded to be wrong",
            ("exhibit", "question", "recorded", "here", "exact"),
            tuple(
                (
                    each.exhibit.name,
                    each.here.question,
                    each.exhibit.record.floating,
                    each.here.floating,
                    each.here.exact,
                )
                for each in shown
            ),
        ),
        Table("what answered in floating point", (), tuple(machines)),
        Table("why it erred", (), tuple((each.exhibit.name, each.exhibit.why) for each in shown)),
    )


def exhibits_view(shown: Sequence[Shown]) -> list[dict[str, Any]]:
    """The exhibits as plain data."""
    return [
        {
            "exhibit": each.exhibit.name,
            "question": each.here.question,
            "call": each.here.call,
            "exact": each.here.exact,
            "recorded": {
                "floating": each.exhibit.record.floating,
                "libraries": each.exhibit.record.libraries.document(),
            },
            "here": {
                "floating": each.here.floating,
                "agree": each.here.agree,
                "libraries": each.libraries.document(),
            },
            "why": each.exhibit.why,
        }
        for each in shown
    ]


def exhibits_page(shown: Sequence[Shown]) -> str:
    """The exhibits as one page of HTML."""
    return page(
        "exhibits",
        title="Where floating point was recorded to be wrong",
        exhibits=[
            view | {"plant": shown_plant(each.exhibit.make())}
            for each, view in zip(shown, exhibits_view(shown), strict=True)
        ],
        recorded=[str(libraries) for libraries in _recorded_by(shown)],
        here=[str(libraries) for libraries in _answered_by(shown)],
    )


def _recorded_by(shown: Sequence[Shown]) -> list[Libraries]:
    """The libraries with which these exhibits were recorded, each once."""
    return list(dict.fromkeys(each.exhibit.record.libraries for each in shown))


def _answered_by(shown: Sequence[Shown]) -> list[Libraries]:
    """The libraries of this machine, once."""
    return list(dict.fromkeys(each.libraries for each in shown))
