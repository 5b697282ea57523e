"""What is decided about a system with parameters: tables, a page, and LaTeX."""

from __future__ import annotations

from mcexact.answer.exceptional_hypersurfaces import Hypersurfaces
from mcexact.answer.parametric_account import LABELS, MODES, PROOFS, PROVED, ParametricAccount
from mcexact.plot.parameters import hypersurfaces, parameter_modes
from mcexact.report.answer_page import AnswerPage
from mcexact.report.picture import Picture
from mcexact.report.plant import shown_plant
from mcexact.report.text import Table
from mcexact.shown import array, escaped


def parameter_tables(account: ParametricAccount, *, whole: bool = False) -> tuple[Table, ...]:
    """Return the table of all answers, then one for each question of which it says too little.

    Parameters
    ----------
    account : ParametricAccount
    whole : bool
        Whether all questions have a table, and not only those about modes: on a page.
    """
    said = account.sentences
    rows = tuple(each.cells for each in said.at("table"))
    title = "All answers" if whole else "".join(said.at("title"))
    first = (Table(title, (), rows),) if rows else ()
    shown = account.detailed(LABELS) if whole else account.detailed(MODES)
    proofs = account.proofs(LABELS if whole else MODES)
    told = (Table(PROVED, PROOFS, proofs),) if proofs else ()
    return (*first, *(Table(LABELS[name], *account.table(name)) for name in shown), *told)


def parameter_page(account: ParametricAccount) -> AnswerPage:
    """Return the page of an analysis for all values of parameters."""
    return AnswerPage(
        title=account.plant.name or "A system with parameters",
        heading="".join(account.sentences.at("title")),
        good=None,
        answer=tuple(account.at("answer")),
        pictures=tuple(drawn.embedded() for drawn in _pictures(account)),
        tables=parameter_tables(account, whole=True),
        plant=shown_plant(account.plant),
    )


def _pictures(account: ParametricAccount) -> list[Picture]:
    """The modes against one parameter, or the hypersurfaces of two."""
    spectrum, said = account.answers.get("fixed_spectrum"), " ".join(account.at("answer")[:2])
    if spectrum is None:
        return []
    if not isinstance(spectrum, Hypersurfaces):
        return [Picture(parameter_modes(spectrum), "Modes against the parameter", said)]
    if len(account.plant.parameters) == 2 and spectrum.hypersurfaces:
        return [Picture(hypersurfaces(spectrum), "Where another mode is fixed", said)]
    return []


def parameter_latex(account: ParametricAccount) -> str:
    """Return the system and the answers in LaTeX."""
    lines = [f"% {escaped(account.plant.name or 'system')}", rf"\[ {account.plant._latex()} \]"]
    lines += [escaped(said) for said in account.at("answer")]
    lines += [escaped(said.line) for said in account.sentences.at("table")]
    for name in account.detailed():
        rows = ((where, "; ".join(filter(None, rest))) for where, *rest in account.rows(name))
        lines.append(rf"\[ {array(rows)} \]")
    if proofs := account.proofs(MODES):
        rows = ((about, "; ".join(rest)) for about, *rest in proofs)
        lines += [escaped(PROVED), rf"\[ {array(rows)} \]"]
    return "\n".join(lines) + "\n"
