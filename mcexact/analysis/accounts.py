"""The answers of `mcexact allocate` with their sentences."""

from __future__ import annotations

from typing import Any

from mcexact.analysis.sharing.allocation import minimal_shared_dimensions, shared_dimension_bound
from mcexact.analysis.sharing.communication import minimal_communication
from mcexact.analysis.sharing.neighbor_graph import neighbor_graph
from mcexact.analysis.structure.controllability import joint_controllability, joint_observability
from mcexact.answer.account import Account
from mcexact.answer.rules import ALLOCATION, LINKS
from mcexact.answer.sentence import Given
from mcexact.derived.constructions import Share
from mcexact.model.system import MultiChannelSystem


def account_of_dimensions(
    system: MultiChannelSystem, *, share: Share = "outputs+states", **options: Any
) -> Account:
    """Compute the least dimensions that agents must share, and the bound of the paper.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with a neighbor graph.
    share : {"outputs+states", "states"}
    **options
        The other keywords of `minimal_shared_dimensions`.
    """
    least = minimal_shared_dimensions(system, share=share, **options)
    answers = {
        "minimal_shared_dimensions": least,
        "shared_dimension_bound": shared_dimension_bound(system, share=share),
        "neighbor_graph": neighbor_graph(system),
        "joint_controllability": joint_controllability(system),
        "joint_observability": joint_observability(system),
    }
    given = Given(system, {"cuts": len(least.cuts), "nodes": len(least.tree)})
    return Account(answers, given, ALLOCATION.sentences(answers, given))


def account_of_links(system: MultiChannelSystem, **options: Any) -> Account:
    """Compute the cheapest links to add.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    **options
        The keywords of `minimal_communication`.
    """
    least = minimal_communication(system, **options)
    given = Given(system, {"cuts": len(least.cuts), "nodes": len(least.tree)})
    answers = {"minimal_communication": least}
    return Account(answers, given, LINKS.sentences(answers, given))
