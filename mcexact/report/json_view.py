"""The JSON that the command line prints: plain data, channels by name, numbers as exact strings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from mcexact.errors import LimitReached
from mcexact.exact.rational import written
from mcexact.report.assessment import Assessment, DelayedNetworks, stem
from mcexact.report.assessment_tables import bound_holds, gains_row, movable, subsystem_completeness
from mcexact.report.words import answer

if TYPE_CHECKING:
    from mcexact.analysis.allocation import SharedDimensions
    from mcexact.analysis.communication import MinimalCommunication
    from mcexact.analysis.complementary_subsystem import ComplementarySubsystem
    from mcexact.analysis.single_channel_gains import SingleChannelGains
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
        "answer": [str(sentence) for sentence in answer(assessment)],
        "stabilizable": spectrum.stabilizable,
        "best_rate": None if spectrum.best_rate is None else spectrum.best_rate.document(),
        "complete": assessment.completeness.complete,
        **structure_view(assessment),
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
        holds = bound_holds(assessment)
        view["shared_dimension_bound"] = {
            share: {
                "deficiency": bound.per_agent,
                "per_agent": bound.per_agent if holds else None,
                "total": bound.total if holds else None,
            }
            for share, bound in assessment.shared_dimension_bounds.items()
        }
        least = assessment.minimal_shared_dimensions
        view["minimal_shared_dimensions"] = least and {
            share: shared_dimensions_view(system, found) for share, found in least.items()
        }
    if assessment.minimal_communication is not None:
        view["minimal_communication"] = links_view(assessment.minimal_communication)
    if with_certificates:
        _name_certificates(view, assessment.certificates())
    return view


def shared_dimensions_view(
    system: MultiChannelSystem, found: SharedDimensions | LimitReached
) -> dict[str, Any]:
    """The least dimensions by agent.

    Where the node limit was reached, the bounds on their sum that were computed until then, which
    no certificate proves.
    """
    if isinstance(found, LimitReached):
        ends = {"lower": found.lower, "upper": found.upper}
        bounds = {name: None if end is None else written(end) for name, end in ends.items()}
        return {"decided": False, "computed_not_certified": bounds}
    dimensions = None
    if found.dimensions is not None:
        dimensions = dict(zip(system.names, found.dimensions, strict=True))
    return {"feasible": found.feasible, "total": found.total, "dimensions": dimensions}


def links_view(found: MinimalCommunication | LimitReached) -> dict[str, Any] | None:
    """The links to add, by name; None where the node limit was reached."""
    if isinstance(found, LimitReached):
        return None
    return {
        "feasible": found.feasible,
        "added": None if found.added is None else [list(edge) for edge in found.added],
        "cost": None if found.cost is None else written(found.cost),
    }


def transfer_graph_view(assessment: Assessment) -> dict[str, Any]:
    """Arcs ``[from, to]`` and strong components, by name."""
    graph = assessment.transfer_graph
    return {
        "arcs": [list(arc) for arc in graph.arcs],
        "strongly_connected": graph.strongly_connected,
        "components": [list(component) for component in graph.components],
        "dead_channels": list(graph.dead),
    }


def structure_view(assessment: Assessment) -> dict[str, Any]:
    """Indices, the parts of the spectrum, and what was asked about a subset or a channel."""
    split = assessment.assignability
    view: dict[str, Any] = {
        name: found and {"index": found.index, "indices": list(found.indices)}
        for name, found in (
            ("controllability_indices", assessment.controllability_indices),
            ("observability_indices", assessment.observability_indices),
        )
    }
    view["assignability"] = {
        "free": split.free,
        "blocks": [
            {"channels": list(block.channels), "dimension": block.dimension}
            for block in split.blocks
        ],
        "fixed_degree": split.fixed_degree,
        "movable": dict(zip(("at_least", "at_most"), movable(assessment), strict=True)),
    }
    view["setpoint"] = {
        "solvable": assessment.setpoint.solvable,
        "rank": assessment.setpoint.rank,
        "invariant_zero": assessment.setpoint.invariant_zero,
        "combinations": [list(map(str, row)) for row in assessment.setpoint.combinations.rows()],
    }
    if assessment.delayed is not None:
        view["delayed"] = delayed_view(assessment.delayed, assessment.system)
    subsystem, channel = assessment.complementary_subsystem, assessment.channel
    if subsystem is not None:
        view["complementary_subsystem"] = complementary_subsystem_view(
            subsystem, assessment.system.n
        )
    if channel is not None:
        view["channel"] = {
            "name": channel.name,
            "controllable": channel.controllability.controllable,
            "observable": channel.observability.controllable,
            "with_gains": {want: gains_view(want, found) for want, found in channel.gains.items()},
        }
    if assessment.every_channel is not None:
        view["every_channel"] = gains_view("every", assessment.every_channel)
    return view


def delayed_view(found: DelayedNetworks, system: MultiChannelSystem) -> dict[str, Any]:
    """The lifted and the held network, by what they share and what stays fixed."""
    view = {}
    for name, verdict, dimensions in (
        ("lifted", found.lifted, found.lifted_dimensions),
        ("held", found.held, found.held_dimensions),
    ):
        view[name] = {
            "states": verdict.system.n,
            "dimensions": dict(zip(system.names, dimensions, strict=True)),
            "fixed_polynomial": polynomial_view(verdict.spectrum.polynomial),
            "jointly_controllable": verdict.controllability.controllable,
            "jointly_observable": verdict.observability.controllable,
        }
    return view


def complementary_subsystem_view(found: ComplementarySubsystem, n: int) -> dict[str, Any]:
    """Rank, zeros, remnant polynomial and completeness of one subsystem."""
    return {
        "subset": list(found.subset),
        "normal_rank": found.normal_rank,
        "invariant_polynomials": [polynomial_view(f) for f in found.invariant_polynomials],
        "zeros": [
            {
                "polynomial": polynomial_view(zeros.polynomial),
                "multiplicity": zeros.multiplicity,
                "rank": zeros.rank,
                "roots": [disc.document() for disc in zeros.roots],
            }
            for zeros in found.zeros
        ],
        "remnant": polynomial_view(found.remnant),
        "transfer_zero": found.transfer_zero,
        "complete": found.complete,
        "reason": subsystem_completeness(found, n)[1],
    }


def gains_view(want: str, found: SingleChannelGains) -> dict[str, Any]:
    """The gains by channel and the indices they reach, or why there are none."""
    if found.gains is None or found.indices is None:
        return {"exists": False, "reason": gains_row(want, found)[1]}
    names = [channel["name"] for channel in found.certificate.system["channels"]]
    rows = [[[str(entry) for entry in row] for row in F.rows()] for F in found.gains]
    return {
        "exists": True,
        "gains": dict(zip(names, rows, strict=True)),
        "indices": dict(zip(found.channels, map(list, found.indices), strict=True)),
    }


_ANSWERS = {
    "jointly_controllable": "joint_controllability.json",
    "jointly_observable": "joint_observability.json",
    "transfer_graph": "transfer_graph.json",
    "fixed_spectrum": "fixed_spectrum.json",
    "stabilizable": "fixed_spectrum.json",
    "best_rate": "fixed_spectrum.json",
    "complete": "completeness.json",
    "controllability_indices": "controllability_indices.json",
    "observability_indices": "observability_indices.json",
    "assignability": "assignability.json",
    "complementary_subsystem": "complementary_subsystem.json",
    "setpoint": "setpoint.json",
    "every_channel": "every_channel.json",
    "neighbor_graph": "neighbor_graph.json",
    "minimal_communication": "minimal_communication.json",
}


def _name_certificates(view: dict[str, Any], files: Iterable[str]) -> None:
    """Say under ``certificate`` where the evidence for each answer is."""
    files = set(files)
    named = {name: file for name, file in _ANSWERS.items() if file in files and name in view}
    for name, file in named.items():
        if isinstance(view[name], dict) and name != "best_rate":
            view[name]["certificate"] = file
    if "spectrum_of_A.json" in files:
        named["pencil_ranks"] = "spectrum_of_A.json"
    for number, rank in enumerate(view.get("pencil_ranks", ()), start=1):
        rank["certificate"] = f"pencil_rank_{number}.json"
    for name, network in view.get("delayed", {}).items():
        network["certificate"] = f"{name}_fixed_spectrum.json"
    if "channel" in view:
        answers = {"controllable": "controllability", "observable": "observability"}
        view["channel"]["certificate"] = {
            name: f"channel_{kind}.json" for name, kind in answers.items()
        }
        for want, answer in view["channel"]["with_gains"].items():
            answer["certificate"] = f"channel_gains_{want}.json"
    for question in ("shared_dimension_bound", "minimal_shared_dimensions"):
        for share, answer in (view.get(question) or {}).items():
            file = f"{question}_{stem(share)}.json"
            if file in files:
                answer["certificate"] = named[f"{question}[{share}]"] = file
    view["certificate"] = named
