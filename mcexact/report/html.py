"""Self-contained pages with pictures, matrices and words."""

from __future__ import annotations

import base64
import io
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from fractions import Fraction
from functools import cache
from itertools import islice
from typing import Any

from mcexact import __version__
from mcexact.answer.templates import count
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import approximated
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.box import radii_in_words
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.report.formulas import matrix
from mcexact.report.text import Table

# When and by which version a page was written.


def stamp(*, dated: bool) -> str:
    """Return the version and the date.

    Parameters
    ----------
    dated : bool
        Whether today's date is given where ``SOURCE_DATE_EPOCH`` is not set.  Pages that promise
        the same bytes on every day are not dated.

    Notes
    -----
    ``SOURCE_DATE_EPOCH`` is the number of seconds since 1970 that reproducible builds agree on.
    """
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if epoch.isascii() and epoch.isdigit():
        return f"mcexact {__version__}, {datetime.fromtimestamp(int(epoch), UTC):%Y-%m-%d}"
    if not dated:
        return f"mcexact {__version__}"
    return f"mcexact {__version__}, {datetime.now(UTC):%Y-%m-%d}"


# Self-contained HTML pages with one layout, in which all inserted texts are escaped.


@cache
def _environment() -> Any:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader("mcexact.report", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def page(template: str, *, dated: bool = True, **content: Any) -> str:
    """Fill a template.

    Parameters
    ----------
    template : str
        The name of the template without its suffix.
    dated : bool
        Whether the page has today's date at its end; see `stamp`.
    **content
        Texts, numbers, and `EmbeddedPicture` for pictures.

    Returns
    -------
    str
        A complete document with its styles and images; a content security policy forbids everything
        else, including scripts.
    """
    text: str = (
        _environment().get_template(f"{template}.html").render(**content, made=stamp(dated=dated))
    )
    return text


# Figures with text alternatives, and their embedding in a page.


@dataclass(frozen=True, eq=False)
class Picture:
    """A matplotlib figure with a description in words.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        A figure that does not depend on the state of pyplot; change its style before `embedded`.
    title : str
    alternative : str
        A description for readers who cannot see the figure.
    """

    figure: Any
    title: str
    alternative: str

    def embedded(self) -> EmbeddedPicture:
        """Return the picture as an SVG to embed, always with the same bytes."""
        import matplotlib

        image = io.BytesIO()
        with matplotlib.rc_context({"svg.hashsalt": "mcexact", "svg.fonttype": "path"}):
            self.figure.savefig(image, format="svg", metadata={"Date": None, "Creator": None})
        text = base64.b64encode(in_the_dark(image.getvalue())).decode("ascii")
        width = float(self.figure.get_figwidth())
        uri = f"data:image/svg+xml;base64,{text}"
        return EmbeddedPicture(self.title, self.alternative, uri, width)


DARK = {
    "#ffffff": "#16181b",
    "#000000": "#e6e7e9",
    "#333333": "#c9ccd1",
    "#555555": "#b4b8be",
    "#888888": "#a4a9b0",
    "#ebebeb": "#2a2e33",
    "#e8e8e8": "#3a3f45",
    "#f4f4f4": "#202327",
    "#1f4e79": "#8ab8f0",
    "#1f78b4": "#6db3e8",
    "#b03a2e": "#ff9a86",
}
"""The colors of pictures, and those that take their places where a reader prefers the dark."""


def in_the_dark(image: bytes) -> bytes:
    """Return an SVG with a style for the dark; what has no color in an SVG is black."""
    ink = DARK["#000000"]
    rules = [f"svg{{fill:{ink};color-scheme:light dark}}"]
    rules += [
        f'[style*="{part}: {light}"]{{{part}:{dark}!important}}'
        for light, dark in DARK.items()
        for part in ("fill", "stroke")
    ]
    style = f"<style>@media screen and (prefers-color-scheme:dark){{{''.join(rules)}}}</style>"
    before, mark, after = image.partition(b"<defs>")
    return before + style.encode("ascii") + mark + after


@dataclass(frozen=True)
class EmbeddedPicture:
    """A picture for a page.

    Attributes
    ----------
    title, alternative : str
    uri : str
        A ``data:`` address that contains the whole image.
    width : float
        The width in inches.
    """

    title: str
    alternative: str
    uri: str
    width: float


# The page of an answer: words, pictures, tables, the system, certificates.


@dataclass(frozen=True)
class AnswerPage:
    """The contents of a page, except for the verdicts on certificates.

    Attributes
    ----------
    title, heading : str
    good : bool or None
        Whether the answer is what a user hopes for; None if it is neither good nor bad.
    answer : tuple of str
        Sentences; those that start with ``"warning: "`` are shown as warnings.
    pictures : tuple of EmbeddedPicture
    tables : tuple of Table
    plant : mapping, optional
        The matrices and the source of the system, as `shown_plant` returns them.
    """

    title: str
    heading: str
    good: bool | None
    answer: tuple[str, ...]
    pictures: tuple[EmbeddedPicture, ...]
    tables: tuple[Table, ...]
    plant: Mapping[str, Any] | None = None

    def rendered(
        self,
        certificates: Mapping[str, str] | None = None,
        verdicts: Mapping[str, Any] | None = None,
        latex: str | None = None,
    ) -> str:
        """Return the whole page.

        Parameters
        ----------
        certificates : mapping from names of files to texts, optional
        verdicts : mapping from names of files to Verdict, optional
            The checker's verdicts; a certificate without verdict is marked as not re-checked.
        latex : str, optional
            The results as LaTeX.
        """
        evidence = []
        for name, text in (certificates or {}).items():
            verdict = (verdicts or {}).get(name)
            evidence.append(
                {
                    "title": name,
                    "verdict": verdict.verdict if verdict is not None else "not re-checked",
                    "theorem": verdict.line() if verdict is not None else "",
                    "text": text,
                }
            )
        if latex is not None:
            evidence.append({"title": "LaTeX", "verdict": "", "theorem": "", "text": latex})
        return page("answer", **vars(self), evidence=evidence)


# The display of a system: its matrices, of large ones a corner, and its properties.

LARGEST, CUT = 12, 8
"""The most rows and columns of a matrix that is shown whole, and those shown of a larger one.  The
same numbers hold for channels."""
_SINGLE = re.compile(r"\((\w+(?:\^\d+)?)\)")
"""A number, a parameter or its power in parentheses, which it does not need."""


def shown_plant(system: MultiChannelSystem | ParametricSystem) -> dict[str, Any]:
    """Return what a page shows of a system.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem

    Returns
    -------
    dict
        ``rows`` of labels and values, ``matrices`` in MathML, ``listed`` large matrices with few
        entries as labels and texts, and ``notes`` that say what was cut or rounded.
    """
    shown = _first(system.m)
    # Matrices of columns side by side, and matrices of rows side by side, take the least room.
    named: list[tuple[str, Any]] = [
        ("A", system.A),
        *((f"B_{k + 1}", system.B(k)) for k in range(shown)),
    ]
    named += [(f"C_{k + 1}", system.C(k)) for k in range(shown)]
    listed = {name: M for name, M in named if _is_listed(M)}
    drawn = [(name, M) for name, M in named if name not in listed]
    notes = []
    cut = [f"{name} is {M.nrows} × {M.ncols}" for name, M in drawn if max(M.shape) > LARGEST]
    if cut:
        some = ", ".join(cut[:4]) + (", …" if len(cut) > 4 else "")
        notes.append(
            f"Large matrices are cut: {some}; their first {CUT} rows and columns are shown."
        )
    if shown < system.m:
        notes.append(f"Of {system.m} channels the first {shown} are shown.")
    corners = [(name, _corner(M)) for name, M in drawn]
    entries = [x for _, M in corners for row in M.tolist() for x in row]
    entries += [M[i, j] for M in listed.values() for i, j, _ in M.nonzero()]
    if any(map(_is_rounded, entries)):
        notes.append("Numbers with ≈ are rounded; the system file has them exactly.")
    return {
        "rows": _facts(system),
        "matrices": [
            matrix(name, _texts(M, whole))
            for (name, M), (_, whole) in zip(corners, drawn, strict=True)
        ],
        "listed": [(f"{name}, {M.nrows} × {M.ncols}", _entries(M)) for name, M in listed.items()],
        "notes": notes,
    }


def _is_listed(M: Matrix | FunctionMatrix) -> bool:
    """Whether a matrix is large and has so few entries that these say more than a corner."""
    if isinstance(M, FunctionMatrix):
        return False
    return max(M.shape) > LARGEST and next(islice(M.nonzero(), CUT, None), None) is None


def _entries(M: Matrix) -> str:
    """The entries of a matrix that are not 0, with their places counted from 1."""
    texts = [f"({i + 1}, {j + 1}) is {_short(M[i, j])}" for i, j, _ in M.nonzero()]
    return f"0 except for {', '.join(texts)}" if texts else "0"


def _facts(system: MultiChannelSystem | ParametricSystem) -> tuple[tuple[str, str], ...]:
    names = ", ".join(system.names[: _first(system.m)])
    more = ", …" if _first(system.m) < system.m else ""
    rows = [
        ("time", system.time),
        ("states", str(system.n)),
        ("channels", f"{system.m}: {names}{more}"),
    ]
    if isinstance(system, ParametricSystem):
        rows.append(("parameters", ", ".join(system.parameters_in_words)))
    elif system.neighbors is not None:
        edges = sum(1 for j, i in system.neighbors.edges() if i != j)
        rows.append(("links between agents", count(edges, "link")))
    if system.uncertainty is not None:
        radii = radii_in_words(system)
        rows.append(("uncertainty", f"{radii}; the matrices are those of the nominal values"))
    if system.typical_sizes is not None:
        rows.append(
            ("sizes", f"{system.typical_sizes.explain()}; weights of costs follow from them")
        )
    rows.append(("source", system.source or "not stated in the system file"))
    rows.append(("SHA-256 of the system", system.digest()))
    return tuple(rows)


def _first(number: int) -> int:
    """The number of channels, out of all, that a page shows."""
    return number if number <= LARGEST else CUT


def _corner(M: Any) -> Any:
    rows, columns = map(_first, M.shape)
    return M.take(rows=range(rows), cols=range(columns))


def _texts(corner: Any, whole: Any) -> list[list[str]]:
    """The entries of a corner as texts, with dots where the matrix goes on."""
    texts = [[_short(entry) for entry in row] for row in corner.tolist()]
    if corner.ncols < whole.ncols:
        texts = [[*row, "⋯"] for row in texts]
    if corner.nrows < whole.nrows:
        texts.append(["⋮"] * len(texts[0]) if texts else [])
    return texts


def _short(x: Fraction | RationalFunction) -> str:
    """A number exactly if that is short, otherwise rounded; a function as its text."""
    return _SINGLE.sub(r"\1", str(x)) if isinstance(x, RationalFunction) else approximated(x)


def _is_rounded(x: Fraction | RationalFunction) -> bool:
    return isinstance(x, Fraction) and approximated(x).startswith("≈")
