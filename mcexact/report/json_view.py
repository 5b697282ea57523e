"""The JSON that the command line prints: plain data, channels by name, numbers as exact strings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from mcexact.errors import LimitReached
from mcexact.report.assessment import Assessment, stem

if TYPE_CHECKING:
    from mcexact.analysis.allocation import SharedDimensions
    from mcexact.model.system import MultiChannelSystem


def polynomial_view(polynomial: Any) -> list[str]:
    """The coefficients, constant term first, as strings."""
    return [str(coefficient) for coefficient in polynomial.coefficients]


def assessment_view(assessment: Assessment, *, with_certificates: bool = False) -> dict[str, Any]:
    """What `analyze --json` prints.

    Parameters
    ----------
    assessment : Assessment
    with_certificates : bool
        Name the certificate file of each answer.
    """
    system = assessment.system
    spectrum = assessment.fixed_spectrum
    view: dict[str, Any] = {
        "system": {
            "name": system.name,
            "n": system.n,
            "m": system.m,
            "time": system.time,
            "channels": list(system.names),
        },
        "information": assessment.information,
        "jointly_controllable": assessment.controllability.controllable,
        "jointly_observable": assessment.observability.controllable,
        "transfer_graph": transfer_graph_view(assessment),
        "fixed_spectrum": {
            "empty": spectrum.empty,
            "polynomial": polynomial_view(spectrum.polynomial),
            "factors": [
                {
                    "polynomial": polynomial_view(factor.polynomial),
                    "multiplicity_in_A": factor.multiplicity_in_A,
                    "multiplicity_at_most": factor.multiplicity_at_most,
                    "channels": list(factor.channels),
                    "rank": factor.rank,
                    "roots": [disc.document() for disc in factor.roots],
                    "stable": factor.stable,
                }
                for factor in spectrum.factors
            ],
        },
        "stabilizable": spectrum.stabilizable,
        "best_rate": None if spectrum.best_rate is None else spectrum.best_rate.document(),
        "complete": assessment.completeness.complete,
    }
    if assessment.pencil_ranks:
        view["pencil_ranks"] = [
            {
                "subset": list(found.subset),
                "polynomial": polynomial_view(found.polynomial),
                "rank": found.rank,
            }
            for found in assessment.pencil_ranks
        ]
    if assessment.neighbor_graph is not None:
        connected = assessment.neighbor_graph.strongly_connected
        view["neighbor_graph"] = {"strongly_connected": connected}
        view["shared_dimension_bound"] = {
            share: {"per_agent": bound.per_agent, "total": bound.total}
            for share, bound in assessment.shared_dimension_bounds.items()
        }
        least = assessment.minimal_shared_dimensions
        view["minimal_shared_dimensions"] = least and {
            share: shared_dimensions_view(system, found) for share, found in least.items()
        }
    if with_certificates:
        _name_certificates(view, assessment.certificates())
    return view


def shared_dimensions_view(
    system: MultiChannelSystem, found: SharedDimensions | LimitReached
) -> dict[str, Any]:
    """The least dimensions by agent; the bounds on their sum where the node limit was reached."""
    if isinstance(found, LimitReached):
        return {name: getattr(found, name, None) for name in ("lower", "upper")}
    dimensions = None
    if found.dimensions is not None:
        dimensions = dict(zip(system.names, found.dimensions, strict=True))
    return {"feasible": found.feasible, "total": found.total, "dimensions": dimensions}


def transfer_graph_view(assessment: Assessment) -> dict[str, Any]:
    """Arcs ``[from, to]`` and strong components, by name."""
    graph = assessment.transfer_graph
    return {
        "arcs": [list(arc) for arc in graph.arcs],
        "strongly_connected": graph.strongly_connected,
        "components": [list(component) for component in graph.components],
    }


_ANSWERS = {
    "jointly_controllable": "joint_controllability.json",
    "jointly_observable": "joint_observability.json",
    "transfer_graph": "transfer_graph.json",
    "fixed_spectrum": "fixed_spectrum.json",
    "stabilizable": "fixed_spectrum.json",
    "best_rate": "fixed_spectrum.json",
    "complete": "completeness.json",
    "neighbor_graph": "neighbor_graph.json",
}


def _name_certificates(view: dict[str, Any], files: Iterable[str]) -> None:
    """Say under ``certificate`` where the evidence for each answer is."""
    files = set(files)
    named = {answer: file for answer, file in _ANSWERS.items() if file in files and answer in view}
    for answer, file in named.items():
        if isinstance(view[answer], dict) and answer != "best_rate":
            view[answer]["certificate"] = file
    for number, rank in enumerate(view.get("pencil_ranks", ()), start=1):
        rank["certificate"] = f"pencil_rank_{number}.json"
    for question in ("shared_dimension_bound", "minimal_shared_dimensions"):
        for share, answer in (view.get(question) or {}).items():
            file = f"{question}_{stem(share)}.json"
            if file in files:
                answer["certificate"] = named[f"{question}[{share}]"] = file
    view["certificate"] = named
