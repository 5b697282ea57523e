"""The page that `mcexact analyze --html` writes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from mcexact.errors import Impossible, LimitReached
from mcexact.report.assessment import Assessment
from mcexact.report.graph_figures import dimensions_picture, graph_picture
from mcexact.report.latex import assessment_latex
from mcexact.report.page import page
from mcexact.report.text import assessment_tables, count
from mcexact.report.words import answer

if TYPE_CHECKING:
    from mcexact.analysis.communication import MinimalCommunication

_LARGEST_FOR_WIRES = 12


def assessment_page(assessment: Assessment, *, latex: bool = False) -> str:
    """Everything that was decided about a system, the answer in plain words first.

    Parameters
    ----------
    assessment : Assessment
    latex : bool
        Whether the results are added as LaTeX.
    """
    from mcexact.certificate import codec
    from mcexact.checker import check_document

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
        bounds = {share: assessment.shared_dimension_bounds[share] for share in least}
        pictures.append(dimensions_picture(system, bounds, least))
    evidence = []
    for name, made in assessment.certificates().items():
        text = codec.encode(made)
        said = check_document(text.encode("ascii"))
        evidence.append(
            {"title": name, "verdict": said.verdict, "theorem": said.line(), "text": text}
        )
    if latex:
        text = assessment_latex(assessment)
        evidence.append({"title": "LaTeX", "verdict": "", "theorem": "", "text": text})
    first, *rest = assessment_tables(assessment)
    tables = [replace(first, title="All answers"), *rest]
    return page(
        "assessment",
        title=system.name or "A multi-channel system",
        heading=(
            f"{count(system.n, 'state')}, {count(system.m, 'channel')}, {system.time} time; "
            + (
                "each agent feeds back the outputs of all its neighbors"
                if assessment.information == "outputs"
                else "each agent feeds back its own output"
            )
        ),
        good=assessment.fixed_spectrum.stabilizable,
        answer=answer(assessment, _wires(assessment)),
        pictures=[drawn.embedded() for drawn in pictures],
        tables=tables,
        evidence=evidence,
    )


def _wires(assessment: Assessment) -> MinimalCommunication | None:
    """The cheapest wires for outputs that leave nothing fixed; None where that is not at hand."""
    from mcexact.analysis.communication import minimal_communication
    from mcexact.model.neighbor_graph import NeighborGraph

    plant = assessment.system.plant
    if assessment.fixed_spectrum.empty or not 1 < plant.m <= _LARGEST_FOR_WIRES:
        return None
    graph = NeighborGraph.empty(plant.names)
    if assessment.information == "outputs" and plant.neighbors is not None:
        graph = plant.neighbors
    try:
        return minimal_communication(plant, graph)
    except (LimitReached, Impossible):
        return None
