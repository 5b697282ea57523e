"""Documents made by hand about plants without parameters and radii, each false."""

from __future__ import annotations

from typing import Any

from tests.checker.handmade import (
    CHAIN,
    COMPLETE,
    CUT,
    FIXED,
    FREE,
    GENERIC,
    GRAPH,
    INTEGRATOR,
    OSCILLATION,
    PAIR,
    PAPER,
    PAPER_SUBSPACE,
    STAR,
    UNCONTROLLABLE,
    certificate,
    changed,
    layers,
    matrix,
    plant,
)
from tests.oracle.drawn.plants import Document

AT_ONE: list[Any] = [-1, 1]
"""The polynomial x − 1."""
TWICE = plant([[1, 0], [0, 1]], ([[0], [0]], [[1, 0]]))
"""The mode 1 twice, and an input that does nothing."""
SHIFTED = plant([[0, 1], [-1, -2]], ([[0], [1]], [[0, 1]]))
"""The output is the rate of the first state: 0 is an invariant zero."""
CROSSED = plant(
    [[0, 0], [0, 1]],
    ([[1], [0]], [[1, 1]]),
    ([[0], [1]], [[1, 1]]),
    neighbors={"1": [], "2": []},
)
"""Two channels that see both states; nothing is fixed."""
ALONE = {**INTEGRATOR, "neighbors": {"1": []}}
UNMOVED = plant([[1]], ([[0]], [[1]]), neighbors={"1": []})
COPIES = plant([[0]], ([[1]], [[1]]), ([[1]], [[1]]))
SENDER = plant([[1]], ([[0]], [[1]]), ([[1]], [[0]]), neighbors={"1": [], "2": ["1"]})
"""Channel 1 sees a state that channel 2 drives."""


def gains(*rows: list[int], allowed: list[Any] | None = None) -> Document:
    """That these gains leave no mode where it is."""
    moved = [matrix(row) for row in rows]
    return {"gains": moved, "modulus": 7, "allowed": allowed or [], "arcs": None}


NO_DEGREE = {
    "states": [],
    "annihilator": matrix(),
    "pivots": [],
    "kernel": matrix(),
    "kernel_pivots": [],
    "sequence": None,
}
"""A component of degree 0, by no states."""
WHOLE_CHAIN = {
    **NO_DEGREE,
    "states": None,
    "sequence": {
        "modulus": 7,
        "gains": [matrix([0, 0], [0, 0])],
        "channel": "1",
        "inputs": [1, 0],
        "outputs": [0, 1],
        "recurrence": [0, 0, 1],
        "cofactors": [[1], []],
    },
}
"""The degree 2 of both channels of :data:`CHAIN` together."""


def apart(order: list[int]) -> Document:
    """That two channels which act on each other, and none on itself, are two components."""
    blocks = [{"channels": [name], "dimension": 0} for name in ("1", "2")]
    return certificate(
        "assignability",
        plant([[0, 0], [0, 0]], ([[1], [0]], [[0, 1]]), ([[0], [1]], [[1, 0]])),
        {"blocks": blocks, "fixed_degree": 2},
        {
            "components": {"modulus": 7, "arcs": [], "order": order, "zeros": []},
            "degrees": [NO_DEGREE, NO_DEGREE],
        },
    )


def dimensions(
    system: Document, answer: list[int] | None, cost: int, witness: Document, **parts: Any
) -> Document:
    """A claim about the least dimensions of sub-states; None says that nothing suffices."""
    m = len(system["channels"])
    claim = {
        "share": "states",
        "bound": None,
        "free_assignability": False,
        "costs": [1] * m,
        "upper": [None] * m,
        "feasible": answer is not None,
        "dimensions": answer,
        "cost": None if answer is None else cost,
    }
    return certificate("shared_dimensions", system, {**claim, **parts}, witness)


def nothing(cut: Document) -> Document:
    """That a cut excludes everything."""
    return {"absence": None, "cuts": [cut], "tree": [{"violated": 0}]}


def behind(s: list[str], space: Document = PAPER_SUBSPACE) -> Document:
    """A cut of the mode 1."""
    return {"subset": s, "polynomial": AT_ONE, "deficiency": 1, "subspace": space}


def unseen(s: list[str], sources: list[str], *X: list[int]) -> Document:
    """A cut that no signal of the sources crosses."""
    pivots = [i for i, row in enumerate(X) if any(row)]
    return {"subset": s, "zero": {"from": sources, "X": matrix(*X), "pivots": pivots}}


def free(cut: Document) -> Document:
    """That nothing makes all modes of :data:`CROSSED` assignable."""
    return dimensions(CROSSED, None, 0, nothing(cut), free_assignability=True)


STILL = plant([[1, 0], [0, 0]], ([[1], [0]], [[1, 0]]))
"""The second state stays where it is."""

NO_MORE = {"cuts": [], "tree": [{"multipliers": []}]}
MEASURED = {"channels_T": ["1"], "U": layers([[1]]), "V": layers([[0]]), "pivots": [0]}
"""The mode of :data:`SENDER`, which channel 1 does not move and channel 2 does not see."""

TRAPS: dict[str, Document] = {
    "potentials that prove fewer modes at 0": changed(
        STAR,
        ("claim.at_zero", 3),
        ("claim.polynomial", [0, 0, 0, -7, 1]),
        ("witness.matching", [1, 2, 3, 4, 5, 6, 7]),
    ),
    "a column for two rows": changed(
        STAR,
        ("claim.at_zero", 0),
        ("claim.polynomial", [-7, 1]),
        ("witness.rows", [0] * 7),
        ("witness.columns", [0] * 7),
        ("witness.matching", [4, 1, 1, 6, 5, 2, 7]),
    ),
    "a multiplicity that is too small": certificate(
        "fixed_spectrum",
        TWICE,
        {
            "polynomial": AT_ONE,
            "factors": [
                {
                    "polynomial": AT_ONE,
                    "multiplicity_in_A": 2,
                    "multiplicity_at_most": 1,
                    "channels": [],
                    "rank": 0,
                    "stable": False,
                    "roots": [{"re": "1", "im": "0", "radius": "0"}],
                }
            ],
            "stabilizable": False,
            "best_rate": {"lower": "-1", "upper": "-1"},
        },
        {
            "gains": [matrix([0])],
            "modulus": 101,
            "subspaces": [
                {
                    "channels_T": ["1"],
                    "U": layers([[1, 0], [0, 1]]),
                    "V": layers([[0, 0]]),
                    "pivots": [0, 1],
                }
            ],
            "completion": {"B0": matrix([1, 0], [0, 1]), "C0": matrix([1, 0], [0, 1])},
        },
    ),
    "two discs around the same root": changed(OSCILLATION, ("claim.factors.0.roots.0.im", "1")),
    "a recurrence that is not monic": certificate(
        "fixed_spectrum",
        PAIR,
        FREE["claim"],
        {
            "blocks": [
                {
                    "states": [0, 1],
                    "evidence": {
                        "modulus": 7,
                        "gains": [matrix([0])],
                        "channel": "1",
                        "inputs": [1],
                        "outputs": [1],
                        "recurrence": [6, 1, 0],
                        "cofactors": [[1], []],
                    },
                }
            ],
            "modulus": None,
            "subspaces": [],
        },
    ),
    "a cut that a channel sees through": changed(CUT, ("system.channels.0.C", [[1, 1]])),
    "a mode of states on which what they drive acts": certificate(
        "completeness",
        plant([[0, 1], [1, 0]], ([[0], [1]], [[0, 1]])),
        {"complete": False},
        {
            "polynomial": [0, 1],
            "subspace": {
                "channels_T": ["1"],
                "states": [0],
                "subspace": {
                    "channels_T": [],
                    "U": layers([[1]]),
                    "V": layers([]),
                    "pivots": [0],
                },
            },
        },
    ),
    "ranks that stop too soon": certificate(
        "controllability_indices",
        CHAIN,
        {"channels": ["1"], "ranks": [1], "index": None, "indices": [1]},
        GENERIC,
    ),
    "an edge against the direction of a chain, by a large modulus": certificate(
        "transfer_graph",
        CHAIN,
        {
            "arcs": [["1", "1"], ["1", "2"], ["2", "1"], ["2", "2"]],
            "components": [["1", "2"]],
            "strongly_connected": True,
        },
        {"modulus": 101, "powers": [0, 1, 0, 0], "zeros": []},
    ),
    "a path that leaves the states and comes back": certificate(
        "assignability",
        plant([[0, 0, 0], [1, 0, 0], [0, 1, 0]], ([[1], [0], [0]], [[0, 0, 1]])),
        {"blocks": [{"channels": ["1"], "dimension": 0}], "fixed_degree": 3},
        {
            "components": {"modulus": 7, "arcs": [], "order": [0], "zeros": []},
            "degrees": [
                {
                    "states": [0, 2],
                    "annihilator": matrix([0, 1]),
                    "pivots": [1],
                    "kernel": matrix([1, 0]),
                    "kernel_pivots": [0],
                    "sequence": None,
                }
            ],
        },
    ),
    "components that an edge leads back to": apart([0, 1]),
    "components in an order that leaves one out": apart([0, 0]),
    "components joined without edges": certificate(
        "assignability",
        CHAIN,
        {"blocks": [{"channels": ["1", "2"], "dimension": 2}], "fixed_degree": 0},
        {
            "components": {"modulus": 7, "arcs": [], "order": [0], "zeros": []},
            "degrees": [WHOLE_CHAIN],
        },
    ),
    "a row of zeros for a pencil of full rank": certificate(
        "setpoint",
        SHIFTED,
        {"solvable": False, "rank": 2, "invariant_zero": False},
        {
            "modulus": 101,
            "left": matrix([1, 0, -1]),
            "pivots": [0],
            "point": None,
            "normal": layers([[0, 0, 0]]),
        },
    ),
    "a form that turns with the loop": certificate(
        "stability",
        plant([[1, -10], [10, 1]], ([[1], [0]], [[1, 0]])),
        {"bound": None, "stable": True},
        {
            "method": "lyapunov",
            "transformation": None,
            "blocks": [
                {
                    "size": 2,
                    "P": matrix([2, -1], [1, 2]),
                    "R": matrix([1, 0], [0, 1]),
                    "R2": matrix([1, 0], [0, 1]),
                }
            ],
        },
    ),
    "a link that is no candidate": certificate(
        "communication",
        COPIES,
        {
            "share": "outputs",
            "dimensions": None,
            "bound": None,
            "candidates": [],
            "feasible": True,
            "added": [["1", "2"]],
            "cost": 0,
        },
        {"absence": gains([1], [0, 0]), **NO_MORE},
    ),
    "a mode that stays beyond the bound": dimensions(
        UNMOVED, [0], 0, {"absence": gains([0], allowed=[[AT_ONE, 1]]), **NO_MORE}, bound=0
    ),
    "a cost that is not that of the dimensions": dimensions(
        ALONE, [0], -1, {"absence": gains([1]), **NO_MORE}
    ),
    "dimensions above the largest ones": dimensions(
        SENDER,
        [1, 0],
        1,
        {
            "absence": {**gains(), "gains": [matrix([0, 0], [1, 0]), matrix([0, 1])]},
            "cuts": [behind(["2"], MEASURED)],
            "tree": [{"violated": 0}],
        },
        upper=[0, None],
    ),
    "a cut around all channels": free(unseen(["1", "2"], [], [], [])),
    "a cut of connections that a channel sees through": free(unseen(["1"], ["2"], [0], [1])),
    "a cut around channels that another one sees": dimensions(
        PAPER, None, 0, nothing(behind(["1", "2", "3"]))
    ),
    "a cut that unlimited dimensions satisfy": dimensions(
        PAPER, None, 0, nothing(behind(["2", "3"]))
    ),
    "a cut that a path crosses": certificate(
        "completeness", CROSSED, {"complete": False}, {"from": ["1"]}
    ),
    "a cut behind which there is no channel": changed(
        COMPLETE,
        ("claim.complete", False),
        ("witness", {"zero": {"from": ["1"], "X": matrix([1]), "pivots": [0]}}),
    ),
    "another multiplicity in A": changed(FIXED, ("claim.factors.0.multiplicity_in_A", 2)),
    "a state in no block": certificate(
        "fixed_spectrum",
        STILL,
        FREE["claim"],
        {
            "blocks": [
                {
                    "states": [0],
                    "evidence": {"gains": [matrix([1])], "modulus": 7},
                }
            ],
            "modulus": None,
            "subspaces": [],
        },
    ),
    "a direction in which the form is positive": certificate(
        "stability",
        plant([[-1]], ([[1]], [[1]])),
        {"bound": None, "stable": False},
        {"method": "instability", "P": matrix([1]), "R2": matrix([1]), "v": matrix([1])},
    ),
    "a mode that another channel does not move": certificate(
        "single_channel_gains",
        plant([[1]], ([[0]], [[1]]), ([[1]], [[0]])),
        {
            "channels": ["2"],
            "property": "controllable",
            "exists": False,
            "cyclic": False,
            "indices": None,
        },
        {
            "channel": "2",
            "side": "controllable",
            "polynomial": AT_ONE,
            "subspace": MEASURED,
        },
    ),
    "no direction": certificate(
        "stability",
        plant([[-1]], ([[1]], [[1]])),
        {"bound": None, "stable": False},
        {"method": "instability", "P": matrix([1]), "R2": matrix([1]), "v": matrix([0])},
    ),
    "blocks that act on each other": certificate(
        "stability",
        plant([[-1, 10], [10, -1]], ([[1], [0]], [[1, 0]])),
        {"bound": None, "stable": True},
        {
            "method": "lyapunov",
            "transformation": None,
            "blocks": [{"size": 1, "P": matrix([1]), "R": matrix([1]), "R2": matrix([1])}] * 2,
        },
    ),
    "two components taken as one": certificate(
        "assignability",
        CHAIN,
        {"blocks": [{"channels": ["1", "2"], "dimension": 2}], "fixed_degree": 0},
        {
            "modulus": 7,
            "transfer_graph": {"claim": GRAPH["claim"], "witness": GRAPH["witness"]},
            "realizations": [
                {
                    "X": matrix([1, 0], [0, 1]),
                    "pivots": [0, 1],
                    "W": matrix([1, 0], [0, 1]),
                    "columns": [0, 1],
                }
            ],
        },
    ),
    "a plant without channels": certificate(
        "controllability",
        PAIR,
        {
            "channels": [],
            "dimension": 0,
            "controllable": False,
            "uncontrollable_polynomial": [2, -3, 1],
        },
        {"modulus": 7, "annihilator": matrix([1, 0], [0, 1]), "pivots": [0, 1]},
        {"construction": "restricted", "channels": []},
    ),
    "a row that annihilates the pencil at 0 alone": certificate(
        "setpoint",
        SHIFTED,
        {"solvable": False, "rank": 2, "invariant_zero": False},
        {
            "modulus": 101,
            "left": matrix([1, 0, -1]),
            "pivots": [0],
            "point": None,
            "normal": layers([[1, 0, -1]]),
        },
    ),
    "a determinant of 0 beside one that is a unit modulo 7 alone": certificate(
        "exceptional_gains",
        plant([[0, 7], [0, 0]], ([[0], [1]], [[0, 0]])),
        {"M": matrix([0, -1], [0, 0]), "blocks": 2, "polynomial": [1], "roots": []},
        {
            "modulus": 7,
            "factors": [],
            "compressions": [matrix([0, 0], [0, 0]), matrix([1, 0], [0, 1])],
        },
    ),
    "another mode of what no output shows": certificate(
        "fixed_spectrum",
        plant([[0, 0], [0, 0]], ([[1], [0]], [[1, -1]]), ([[0], [1]], [[-1, 1]])),
        FREE["claim"],
        {**FREE["witness"], "gains": [matrix([1]), matrix([1])]},
        {
            "construction": "modulo",
            "part": "unobservable",
            "annihilator": matrix([1, 1]),
            "pivots": [0],
            "polynomial": [1, 1],
        },
    ),
    "channels merged without one of them": changed(
        UNCONTROLLABLE,
        ("system.channels", [*PAIR["channels"], {"name": "2", "B": [[0], [1]], "C": [[0, 1]]}]),
        ("subject", [{"construction": "merged", "parts": [["1"]]}]),
    ),
}
