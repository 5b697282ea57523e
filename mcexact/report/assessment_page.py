"""The page that `mcexact analyze --html` writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from mcexact.answer.wording import details as say
from mcexact.checker import Verdict
from mcexact.errors import LimitReached
from mcexact.report.assessment import Assessment
from mcexact.report.assessment_tables import assessment_tables, bound_holds
from mcexact.report.graph_figures import dimensions_picture, graph_picture
from mcexact.report.page import page
from mcexact.report.picture import EmbeddedPicture
from mcexact.report.text import Table
from mcexact.report.words import answer


@dataclass(frozen=True)
class AssessmentPage:
    """Everything that was decided about a system, but for the verdicts on its certificates.

    Attributes
    ----------
    title, heading : str
    good : bool
        Whether control with the given information can stabilize the plant.
    answer : tuple of str
    pictures : tuple of EmbeddedPicture
    tables : tuple of Table
    """

    title: str
    heading: str
    good: bool
    answer: tuple[str, ...]
    pictures: tuple[EmbeddedPicture, ...]
    tables: tuple[Table, ...]

    def rendered(
        self,
        certificates: Mapping[str, str],
        verdicts: Mapping[str, Verdict],
        latex: str | None = None,
    ) -> str:
        """The whole page.

        Parameters
        ----------
        certificates : mapping from names of files to texts
        verdicts : mapping from names of files to Verdict
            What the checker said of each; of one that is missing the page says that it was not
            re-checked.
        latex : str, optional
            The results as LaTeX.
        """
        evidence = []
        for name, text in certificates.items():
            said = verdicts.get(name)
            evidence.append(
                {
                    "title": name,
                    "verdict": said.verdict if said else "not re-checked",
                    "theorem": said.line() if said else "",
                    "text": text,
                }
            )
        if latex is not None:
            evidence.append({"title": "LaTeX", "verdict": "", "theorem": "", "text": latex})
        return page("assessment", **vars(self), evidence=evidence)


def assessment_page(assessment: Assessment) -> AssessmentPage:
    """Everything that was decided about a system, the answer in plain words first."""
    system = assessment.system
    pictures = [
        graph_picture(
            system,
            fixed=assessment.fixed_spectrum,
            transfer=assessment.transfer_graph,
            information=assessment.information,
        )
    ]
    least = {
        share: found
        for share, found in (assessment.minimal_shared_dimensions or {}).items()
        if not isinstance(found, LimitReached)
    }
    if least:
        bounds = assessment.shared_dimension_bounds if bound_holds(assessment) else None
        pictures.append(dimensions_picture(system, least, bounds))
    first, *rest = assessment_tables(assessment)
    return AssessmentPage(
        title=system.name or "A multi-channel system",
        heading=say.PAGE_HEADING(
            n=system.n, m=system.m, time=system.time, information=assessment.control
        ),
        good=assessment.fixed_spectrum.stabilizable,
        answer=tuple(answer(assessment)),
        pictures=tuple(drawn.embedded() for drawn in pictures),
        tables=(replace(first, title="All answers"), *rest),
    )
