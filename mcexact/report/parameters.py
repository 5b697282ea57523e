"""What is decided about a system with parameters: tables, a page, and LaTeX."""

from __future__ import annotations

from mcexact.answer.exceptional_hypersurfaces import ExceptionalHypersurfaces
from mcexact.answer.parametric_analysis import COLUMNS, LABELS, ParametricAnalysis
from mcexact.plot.parameters import hypersurfaces, parameter_modes
from mcexact.report.answer_page import AnswerPage
from mcexact.report.picture import Picture
from mcexact.report.plant import shown_plant
from mcexact.report.text import Table
from mcexact.shown import array, escaped

_NONE = ("every value", "none", "")
_PROVED = (
    "With several parameters the certificates are about the plant along lines; between these, "
    "the conditions are computed and not certified."
)


def parameter_tables(found: ParametricAnalysis) -> tuple[Table, ...]:
    """Return a table for each question: where which modes are fixed, and why."""
    return tuple(
        Table(LABELS[name], COLUMNS, found.rows(name) or (_NONE,)) for name in found.answers
    )


def parameter_page(found: ParametricAnalysis) -> AnswerPage:
    """Return the page of an analysis for all values of parameters."""
    several = len(found.plant.parameters) > 1
    return AnswerPage(
        title=found.plant.name or "A system with parameters",
        heading=f"For all values of {', '.join(found.plant.parameters_in_words)}.",
        good=None,
        answer=(*found.sentences, *((_PROVED,) if several else ())),
        pictures=tuple(drawn.embedded() for drawn in _pictures(found)),
        tables=parameter_tables(found),
        plant=shown_plant(found.plant),
    )


def _pictures(found: ParametricAnalysis) -> list[Picture]:
    """The modes against one parameter, or the hypersurfaces of two."""
    spectrum, said = found.answers["fixed_spectrum"], " ".join(found.sentences[:2])
    if not isinstance(spectrum, ExceptionalHypersurfaces):
        return [Picture(parameter_modes(spectrum), "Modes against the parameter", said)]
    if len(found.plant.parameters) == 2 and spectrum.hypersurfaces:
        return [Picture(hypersurfaces(spectrum), "Where another mode is fixed", said)]
    return []


def parameter_latex(found: ParametricAnalysis) -> str:
    """Return the system and the answers in LaTeX."""
    lines = [f"% {escaped(found.plant.name or 'system')}", rf"\[ {found.plant._latex()} \]"]
    lines += [escaped(said) for said in found.sentences]
    for name in found.answers:
        rows = ((where, "; ".join(filter(None, rest))) for where, *rest in found.rows(name))
        lines.append(rf"\[ {array(rows)} \]")
    return "\n".join(lines) + "\n"
