"""Forgeries about costs, bounds for every controller, disk margins, sectors and steps."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

from tests.checker.handmade import certificate, changed, matrix, plant
from tests.checker.performance_plants import (
    CONTINUOUS_STEP,
    DRIVEN,
    FALLING,
    STEP,
    form,
    static,
    weights,
)
from tests.oracle.drawn.plants import Document, number

Forged = Document | None


def _scaled(value: Any, by: Fraction) -> Any:
    return number(Fraction(value) * by)


def better(rng: random.Random, document: Document) -> Forged:
    """A lower cost, a higher bound, a larger margin, wider sectors: by much, or by little."""
    claim = document["claim"]
    by = rng.choice((Fraction(1001, 1000), Fraction(101, 100), Fraction(3, 2), Fraction(20)))
    if "margin" in claim:
        claim["margin"] = _scaled(claim["margin"], by)
    elif claim.get("sectors"):
        pair = rng.choice(claim["sectors"])
        pair[1] = _scaled(pair[1], by)
    elif "at" in claim and any(claim.get("inputs", ())):
        row = rng.choice([row for key in ("inputs", "outputs") for row in claim[key] if row])
        k = rng.randrange(len(row))
        row[k] = _scaled(row[k], 1 / by)
    elif "cost" in claim:
        claim["cost"] = _scaled(claim["cost"], by if document["kind"] == "cost_bound" else 1 / by)
    return document


def other_weights(rng: random.Random, document: Document) -> Forged:
    """Other weights, or another bandwidth, or none, with the same cost and the same witness."""
    weights = document["claim"].get("weights")
    if weights is None:
        return None
    if "bandwidth" in weights and rng.random() < 0.5:
        if rng.random() < 0.5:
            del weights["bandwidth"]
        else:
            weights["bandwidth"] = _scaled(weights["bandwidth"], Fraction(rng.choice((2, 100))))
        return document
    lists = [each for each in weights.values() if isinstance(each, list) and each]
    if not lists:
        return None
    entries = rng.choice(lists)
    entries[rng.randrange(len(entries))] = rng.choice((0, 5, 1000, "1/1000", -1))
    return document


def _forms(value: Any) -> list[Document]:
    """All symmetric matrices of a witness."""
    if isinstance(value, list):
        return [form for each in value for form in _forms(each)]
    if not isinstance(value, dict):
        return []
    own = [value] if "exponents" in value else []
    return own + [form for each in value.values() for form in _forms(each)]


def other_form(rng: random.Random, document: Document) -> Forged:
    """A matrix that is negated, scaled, or of another size, and a claim that it would prove."""
    forms = _forms(document["witness"])
    if not forms:
        return None
    form = rng.choice(forms)
    what = rng.randrange(4)
    if what == 0:
        form["entries"] = [-x for x in form["entries"]]
    elif what == 1:
        by = rng.choice((-20, -1, 1, 20))
        form["exponents"] = [e + by for e in form["exponents"]]
    elif what == 2 and form["exponents"]:
        k = rng.randrange(len(form["exponents"]))
        form["exponents"][k] += rng.choice((-3, 3, 5000))
    else:
        form["entries"] = [0] * len(form["entries"])
    return better(rng, document) if rng.random() < 0.7 else document


def other_group(rng: random.Random, document: Document) -> Forged:
    """A group that is not closed, too much of a disturbance, no graph, or a share of 1."""
    groups = document["witness"].get("groups")
    if not groups:
        return None
    group = rng.choice(groups)
    what = rng.randrange(6)
    if what == 0 and len(group["agents"]) > 1:
        del group["agents"][rng.randrange(len(group["agents"]))]
    elif what == 1:
        document["witness"]["groups"] = [*groups, group]
        document["claim"]["cost"] = _scaled(document["claim"]["cost"], Fraction(3, 2))
    elif what == 2:
        document["claim"].pop("graph", None)
    elif what == 3 and "graph" in document["claim"]:
        graph = document["claim"]["graph"]
        if graph["edges"] and rng.random() < 0.6:
            del graph["edges"][rng.randrange(len(graph["edges"]))]
        elif graph["states"]:
            names = [channel["name"] for channel in document["system"]["channels"]]
            graph["states"][rng.randrange(len(graph["states"]))] = rng.choice(names)
    elif what == 4:
        group["share"] = rng.choice((1, "3/2", "-1/2"))
    else:
        key = rng.choice(("disturbances", "noise"))
        group[key] = [_scaled(x, Fraction(rng.choice((2, 10)))) for x in group[key]]
    return document


def other_ports(rng: random.Random, document: Document) -> Forged:
    """Single margins told of all ports at once, a port left out, or a scaling that hides one."""
    witness = document["witness"]
    if "parts" in witness:
        what = rng.randrange(5)
        if what == 0:
            document["claim"]["together"] = not document["claim"]["together"]
        elif what == 1 and witness["parts"]:
            del witness["parts"][rng.randrange(len(witness["parts"]))]
        elif what == 2:
            document["claim"]["at"] = rng.choice(("inputs", "outputs"))
        elif witness["parts"]:
            part = rng.choice(witness["parts"])
            if what == 3 and part["ports"]:
                del part["ports"][0], part["scaling"][0]
            else:
                part["scaling"] = [rng.choice((0, -1, 1, "1/64")) for _ in part["scaling"]]
        return document
    if "scaling" in witness:
        witness["scaling"] = [rng.choice((0, -1, 1, "1/64")) for _ in witness["scaling"]]
        return document
    return None


def other_sector(rng: random.Random, document: Document) -> Forged:
    """Ends in the wrong order, or far apart, or on the other side of 0."""
    sectors = document["claim"].get("sectors")
    if not sectors:
        return None
    sectors[rng.randrange(len(sectors))] = rng.choice(([2, 1], [-1, 1], [0, 100], [-5, -4], [1, 1]))
    return document


def other_gain(rng: random.Random, document: Document) -> Forged:
    """A controller with a gain more, so that the loop is another one, perhaps unstable."""
    if not document["subject"]:
        return None
    agents = document["subject"][-1]["controller"]["agents"]
    maps = [m["outputs"] for agent in agents if (m := agent["input"]).get("outputs")]
    tables = [M for each in maps for M in each.values() if isinstance(M, list) and M and M[0]]
    if not tables:
        return None
    row = rng.choice(rng.choice(tables))
    row[rng.randrange(len(row))] = rng.choice((-20, -3, 3, 20, "1/7"))
    return document


def other_response(rng: random.Random, document: Document) -> Forged:
    """A response that ends too early, falls faster or is too coarse, and lower peaks."""
    witness, claim = document["witness"], document["claim"]
    what = rng.randrange(8)
    if what == 0:
        witness["times"] = rng.choice((0, 1, witness["times"] // 2, witness["times"] + 1))
    elif what == 1:
        witness["rate"] = rng.choice((0, -1, 10, 1000, _scaled(witness["rate"], Fraction(3, 2))))
    elif what == 2:
        witness["sizes"] = [
            _scaled(x, Fraction(1, rng.choice((2, 1000)))) for x in witness["sizes"]
        ]
    elif what == 3:
        witness["bits"] = rng.choice((0, 1, 8, 16, 17, 20, 1001))
    elif what == 4:
        witness["unit"] += rng.choice((-40, -12, -2, 2, 12, 40))
    elif what == 5 and "step" in witness:
        witness["step"] = _scaled(witness["step"], Fraction(rng.choice((-1, 0, 2, 10, 100))))
    elif what == 6:
        claim["at"] = rng.choice(("inputs", "outputs", "setpoints"))
    else:
        claim["inputs"], claim["outputs"] = claim["outputs"], claim["inputs"]
    return better(rng, document) if rng.random() < 0.7 else document


COSTS = (better, other_weights, other_form, other_gain)
BOUNDS = (better, other_weights, other_form, other_group)
MARGINS = (better, other_ports, other_form, other_gain)
SECTORS = (better, other_sector, other_ports, other_form, other_gain)
STEPS = (better, other_response, other_form, other_gain)

# x' = -x/2 + u tends to 2u, and x(t+1) = -x(t)/2 + u never exceeds u.
HALF = plant([["-1/2"]], ([[1]], [[1]]))
# Two agents see the one state, on which the first one acts.
SEEN = plant([[0]], ([[1]], [[1]]), ([[0]], [[1]]), time="discrete")
# 1/(1 - M) is 256.9, and with M rounded down to 16 bits 256.
CREEPING = plant([["652809/655360"]], ([[1]], [[1]]), time="discrete")
# Agent 1 moves the state of agent 2, which agent 2 itself can hardly move.
HELPED = plant(
    [[0, 0], [1, 2]],
    ([[1], [0]], [[1, 0]]),
    ([[0], ["1/16"]], [[0, 1]]),
    time="discrete",
)
# Nothing is measured of a state that grows.
BLIND = plant([[1]], ([[1]], {"shape": [0, 1], "entries": []}))
PRECISE = {"states": [1], "inputs": [1], "disturbances": [1], "noise": ["1/1000000"]}
TRAPS: dict[str, Document] = {
    "a share below 0": certificate(
        "cost_bound",
        DRIVEN,
        {"weights": PRECISE, "cost": 4},
        {
            "groups": [
                {
                    "agents": ["1"],
                    "disturbances": [1],
                    "noise": ["1/1000000"],
                    "P": form([4]),
                    "S": form([2], exponent=-6),
                    "F": matrix([0]),
                    "share": -1,
                }
            ]
        },
    ),
    "a group whose agent is helped by one outside": certificate(
        "cost_bound",
        HELPED,
        {
            "weights": weights(2, 2),
            "cost": 500,
            "graph": {"states": ["1", "2"], "edges": [["1", "2"], ["2", "1"]]},
        },
        {
            "groups": [
                {
                    "agents": ["2"],
                    "disturbances": [1],
                    "noise": [1],
                    "P": form([512]),
                    "S": form([1], exponent=-1),
                    "F": matrix([0]),
                    "share": 0,
                }
            ]
        },
    ),
    "white noise that passes to the input": certificate(
        "loop_cost",
        FALLING,
        {"weights": weights(1, 1), "cost": 3},
        {"P": form([1])},
        static(FALLING, -1),
    ),
    "no margins of a loop that is not stable": certificate(
        "disk_margin",
        BLIND,
        {"at": "outputs", "together": False, "margin": 1},
        {"parts": []},
        static(BLIND, 0),
    ),
    "a scaling below 0": certificate(
        "disk_margin",
        FALLING,
        {"at": "inputs", "together": False, "margin": 4},
        {"parts": [{"ports": [0], "scaling": [-1], "P": form([1], exponent=-1)}]},
        static(FALLING, 0),
    ),
    "errors that need not fall": certificate(
        "step_peaks",
        STEP,
        {"at": "inputs", "inputs": [[1]], "outputs": [[1]]},
        {"P": form([3]), "rate": -1, "sizes": [1, 1], "bits": 24, "unit": -18, "times": 0},
        static(STEP, 0),
    ),
    "a step of discrete time in continuous time": certificate(
        "step_peaks",
        HALF,
        {"at": "inputs", "inputs": [["1/1000"]], "outputs": [["101/100"]]},
        {"P": form([3]), "rate": "1/8", "sizes": [1, 1], "bits": 30, "unit": -24, "times": 30},
        static(HALF, 0),
    ),
    "time that runs backward": changed(
        CONTINUOUS_STEP,
        ("claim.inputs", [["1/10"]]),
        ("claim.outputs", [["1/10"]]),
        ("witness.step", -1),
        ("witness.times", 0),
    ),
    "a number that falls into the lane of another step": certificate(
        "step_peaks",
        SEEN,
        {"at": "inputs", "inputs": [["1/1000"] * 2] * 2, "outputs": [["1/1000"] * 2] * 2},
        {"P": form([3]), "rate": "1/4", "sizes": [1] * 4, "bits": 24, "unit": -55, "times": 1},
        static(SEEN, 0, 0),
    ),
    "numbers beyond the bits to which matrices are rounded": certificate(
        "step_peaks",
        CREEPING,
        {"at": "inputs", "inputs": [[300]], "outputs": [["1027/4"]]},
        {"P": form([1]), "rate": "1/260", "sizes": [1, "65/64"], "bits": 16, "unit": -14}
        | {"times": 2200},
        static(CREEPING, 0),
    ),
}
