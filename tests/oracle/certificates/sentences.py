"""The sentence of each kind, from the templates of ``FORMAT.md``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import fmpq

from .parametric import parametric_sentence
from .parametric_rank import rank_sentence
from .reading import decimal, listed, matrix, polynomial, rational
from .systems import System
from .words import (
    by_channel,
    channels,
    digested,
    discs,
    edges,
    json_text,
    name,
    number,
    polynomial_text,
)

LTI = "under linear time-invariant decentralized control"
PENCIL = "[xI - A, B; C, 0]"
OF_THE_SET = "C the outputs of the set and B the inputs of the others"
SHARING = {"outputs+states": "outputs and sub-states", "states": "sub-states"}


def _bound(value: Any) -> fmpq | None:
    return None if value is None else rational(value)


def _region(value: Any, time: str, how: str = "below") -> str:
    bound = _bound(value)
    if time == "continuous":
        return f"real part {how} {number(-bound if bound is not None else 0)}"
    return f"modulus {how} {number(bound if bound is not None else 1)}"


def _freedom(bound: Any, time: str) -> str:
    where = "" if bound is None else f" of {_region(bound, time, 'at least')}"
    return f"no mode{where} that is fixed {LTI}"


def _not(value: bool) -> str:
    return "" if value else "not "


def _joined(parts: Sequence[str], by: str = ", ") -> str:
    return by.join(parts) or "none"


def _structural(claim: Any, system: System) -> str:
    whose = {"own": "its own outputs", "outputs": "the outputs of its neighbors"}
    states = _joined([str(a + 1) for a in claim["without_feedback"]])
    return (
        f"where each agent feeds back {whose[claim['information']]}, for all systems with zeros "
        "wherever it has zeros, and all constant gains F, det(xI - A_F) is a multiple of "
        f"x^{claim['at_zero']} det(xI - A_UU), U the states {states}; almost all such systems have "
        "no more that divides det(xI - A_F) for all F; with its own entries this is "
        f"{polynomial_text(claim['polynomial'])}"
    )


def _assignability(claim: Any, system: System) -> str:
    blocks = [f"{b['dimension']} for {channels(b['channels'])}" for b in claim["blocks"]]
    return (
        "for all constant gains F, det(xI - A_F) = phi(x) times the product of chi_c(x) over the "
        "strong components c of the transfer graph; phi is monic of degree "
        f"{claim['fixed_degree']} and the same for all F; chi_c is monic, depends on the F_i with "
        "i in c alone, and its degree is the McMillan degree of C_c (xI - A)^-1 B_c, "
        f"{_joined(blocks)}"
    )


def _common(claim: Any, system: System) -> str:
    start = (
        f"the extended system without delays sharing {SHARING[claim['share']]} of dimension k for "
        f"each agent has {_freedom(None, system.time)}"
    )
    return (
        f"{start} exactly for k >= {claim['dimension']}"
        if claim["feasible"]
        else f"{start} for no k"
    )


def _communication(claim: Any, system: System) -> str:
    share = claim["share"]
    shared = "outputs"
    if share != "outputs":
        shared = f"{SHARING[share]} of dimensions {by_channel(system.names, claim['dimensions'])}"
    graph = "its neighbor graph" if system.neighborhoods is not None else "the graph without edges"
    candidates = edges([(j, i, rational(c)) for j, i, c in claim["candidates"]])
    freedom = _freedom(claim["bound"], system.time)
    end = f"sharing {shared} with neighbors, without delay, leaves {freedom}"
    if claim["feasible"]:
        return (
            f"with the links {edges(claim['added'])}, of cost {number(rational(claim['cost']))}, "
            f"added to {graph}, {end}, and so it does with no set of lower cost out of the "
            f"candidate links, with their costs, {candidates}"
        )
    return (
        f"no set out of the candidate links, with their costs, {candidates}, added to {graph}, is "
        f"such that {end}"
    )


def _complementary(claim: Any, system: System) -> str:
    f = [polynomial_text(p) for p in claim["invariant_polynomials"]]
    return (
        f"the pencil {PENCIL}, C the outputs of the channels {channels(claim['subset'])} and B the "
        f"inputs of the others, has normal rank {claim['normal_rank']}; its invariant polynomials "
        f"of degree at least 1 are {_joined(f)}; the greatest common divisor of its minors of "
        f"order {system.n}, the remnant polynomial, is {polynomial_text(claim['remnant'])}; "
        f"C (xI - A)^-1 B is {_not(claim['transfer_zero'])}zero; the complementary subsystem is "
        f"{_not(claim['complete'])}complete"
    )


def _completeness(claim: Any, system: System) -> str:
    return (
        f"it is {_not(claim['complete'])}complete, where complete means that its transfer graph is "
        f"strongly connected and no mode is fixed {LTI}"
    )


def _controllability(claim: Any, system: System) -> str:
    return (
        f"the channels {channels(claim['channels'])} together control a subspace of dimension "
        f"exactly {claim['dimension']}; it is {_not(claim['controllable'])}controllable through "
        "them, with the uncontrollable polynomial "
        f"{polynomial_text(claim['uncontrollable_polynomial'])}"
    )


def _indices(claim: Any, system: System) -> str:
    index = "none" if claim["index"] is None else claim["index"]
    return (
        f"the ranks of [B, A B, ..., A^(k-1) B], B the inputs of the channels "
        f"{channels(claim['channels'])}, for k = 1, 2, ... are {json_text(claim['ranks'])} and do "
        f"not grow further; the controllability indices are {json_text(claim['indices'])} and the "
        f"controllability index is {index}"
    )


def _deficiency(claim: Any, system: System) -> str:
    return (
        f"the largest {system.n} - rank {PENCIL}, over all complex x and all sets of channels, "
        f"{OF_THE_SET}, is {claim['deficiency']}"
    )


def _observer(claim: Any, system: System) -> str:
    end = (
        ""
        if claim["bound"] is None
        else f"; every root of both has {_region(claim['bound'], system.time)}"
    )
    return (
        "in the coordinates (x, e_1, z_1, e_2, z_2, ...), e_i = x_i - x for the x_i that agent i "
        "shares, the matrix of the loop is [M_F, *; 0, M_E], where M_F has the characteristic "
        f"polynomial {polynomial_text(claim['feedback'])} and M_E has "
        f"{polynomial_text(claim['error'])}{end}"
    )


def _cost(weights: Any) -> str:
    Q, R, W, V = (
        ", ".join(number(rational(x)) for x in weights[key])
        for key in ("states", "inputs", "disturbances", "noise")
    )
    filtered = ""
    if "bandwidth" in weights:
        omega = number(rational(weights["bandwidth"]))
        filtered = f", which passes v' = -w v + w n with w = {omega}"
    return (
        f"the stationary mean of x'Qx + u'Ru, Q = diag({Q}), R = diag({R}), under white "
        f"disturbances of the states of intensity diag({W}) and white noise of intensity "
        f"diag({V}) at the outputs{filtered}"
    )


def _loop_cost(claim: Any, system: System) -> str:
    cost = number(rational(claim["cost"]))
    return f"the loop is stable, and {_cost(claim['weights'])}, is at most {cost}"


def _cost_bound(claim: Any, system: System) -> str:
    whose = "every linear time-invariant controller"
    if system.time == "continuous" and "bandwidth" not in claim["weights"]:
        whose += " whose inputs do not depend on the outputs at once"
    if "graph" in claim:
        owners = ", ".join(name(each) for each in claim["graph"]["states"])
        whose += (
            " by which agents act on others along the edges "
            f"{edges([tuple(edge) for edge in claim['graph']['edges']])} alone, the states of the "
            f"plant being those of {owners} in turn"
        )
    return (
        f"with {whose} that makes the loop stable, {_cost(claim['weights'])}, is at least "
        f"{number(rational(claim['cost']))}"
    )


def _disk_margin(claim: Any, system: System) -> str:
    together, margin = claim["together"], number(rational(claim["margin"]))
    each = f"all {claim['at']} are" if together else f"any one {claim['at'][:-1]} is"
    apart = ", with a d for each," if together else ""
    return (
        f"the loop is stable, also where {each} multiplied by (1 + d/2)/(1 - d/2){apart} for "
        f"complex numbers d with |d| <= {margin}: disk margin {margin}"
    )


def _step_peaks(claim: Any, system: System) -> str:
    added = "a constant 1 is added to the {} k"
    step = {"inputs": added.format("input"), "outputs": added.format("output")}.get(
        claim["at"], "the set-point of the output k is 1"
    )

    def row(values: Any) -> str:
        return f"({', '.join(number(rational(x)) for x in values)})"

    pairs = zip(claim["inputs"], claim["outputs"], strict=True)
    bounds = [f"k = {k}: {row(u)} and {row(y)}" for k, (u, y) in enumerate(pairs, 1)]
    return (
        f"the loop is stable, and if it is at rest and from then on {step}, the absolute values of "
        "all inputs that the agents compute, and of all outputs, never exceed the following "
        f"bounds, in the order of the channels: {'; '.join(bounds) or 'none'}"
    )


def _sector(claim: Any, system: System) -> str:
    pairs = ((number(rational(a)), number(rational(b))) for a, b in claim["sectors"])
    sectors = ", ".join(f"[{a}, {b}]" for a, b in pairs)
    return (
        "every solution tends to 0 exponentially where each input of the plant is a function "
        "f(t, v) of the input v that its agent computes, between a v and b v for the ends a and b "
        f"of its sector, the sectors being {sectors} in turn"
    )


def _saturation(claim: Any, system: System) -> str:
    def pair(ends: Any) -> str:
        return "no limits" if ends is None else " to ".join(number(rational(x)) for x in ends)

    def rows(L: Any) -> str:
        d = L["denominator"]
        texts = [", ".join(number(fmpq(x, d)) for x in row) for row in L["entries"]]
        return f"[{'; '.join(texts)}]" if any(L["entries"]) else "none"

    limits = "; ".join(", ".join(map(pair, own)) or "none" for own in claim["limits"])
    gains = "; ".join(map(rows, claim["back_calculation"]))
    cut = (
        "where the plant receives each input cut off at its limits, and each agent adds L (w - v) "
        "to its next states, in continuous time to their derivatives, v being the inputs that it "
        f"computes and w these cut off; limits of each agent in turn: {limits}; L in turn: {gains}"
    )
    exact = "; all of this holds as well for the plant sampled without rounding"
    exact = exact if "exact" in claim else ""
    if "region" not in claim:
        same = "any two solutions with the same set-points and disturbances approach each other"
        return f"{same} exponentially, {cut}{exact}"
    sizes = ", ".join(number(rational(x)) for x in claim["region"].get("sizes", []))
    divided = f", each of its entries divided by one of ({sizes}) in turn" if sizes else ""
    P, radius = claim["region"]["P"], number(rational(claim["region"]["radius"]))
    return (
        "every solution without set-points and disturbances that starts where z'Pz <= 1 stays "
        f"there and tends to 0 exponentially, z the state of the loop, {cut}; P_ij = s_ij "
        f"2^(e_i + e_j) with e = {P['exponents']} and the lower triangle s = {P['entries']}, row "
        f"by row; z'Pz <= 1 holds for every state of the system that is controlled, of norm at "
        f"most {radius}{divided}, where all "
        f"else is 0{exact}"
    )


def _exceptional(claim: Any, system: System) -> str:
    M = matrix(claim["M"], system.n, system.n)
    return (
        f"the first {claim['blocks']} blocks of [B, (M + gA) B, (M + gA)^2 B, ...], B the inputs "
        f"of all channels and M the matrix with {digested(M)}, have rank below {system.n} exactly "
        f"where g is a root of {polynomial_text(claim['polynomial'])}; its roots are simple and "
        f"lie one in each of the discs {discs(claim['roots'])}, real ones where the disc is "
        "centered on the real axis, and only there"
    )


def _spectrum(claim: Any, system: System) -> str:
    verdict = f"{_not(claim['stabilizable'])}stabilizable"
    end = f"it is {verdict} by linear time-invariant decentralized control"
    if polynomial(claim["polynomial"]) == 1:
        return f"no mode is fixed {LTI}; {end}"
    continuous = system.time == "continuous"
    place = "Hurwitz" if continuous else "Schur"
    slowest = "minus the largest real part" if continuous else "the largest modulus"
    rows = []
    for factor in claim["factors"]:
        p = polynomial(factor["polynomial"])
        times = factor["multiplicity_in_A"]
        exponent = "some exponent" if times is None else f"the exponent {times}"
        text = (
            f"{polynomial_text(p)} is {_not(factor['stable'])}{place}, has {exponent} "
            "in det(xI - A) and at most "
            f"{factor['multiplicity_at_most']} in the greatest common divisor of det(xI - A_F) "
            "over all constant gains F, and one root in each of the discs "
            f"{discs(factor['roots'])}, "
            f"where the least rank of {PENCIL} over all sets of channels, {OF_THE_SET}, is "
            f"{factor['rank']}, reached by {channels(factor['channels'])}"
        )
        rows.append((p.degree(), text))
    rate = claim["best_rate"]
    lower, upper = (number(decimal(rate[key])) for key in ("lower", "upper"))
    return (
        f"the modes that are fixed {LTI} are the roots of {polynomial_text(claim['polynomial'])}; "
        f"{'; '.join(text for _, text in sorted(rows))}; {end}; {slowest} of a fixed mode is from "
        f"{lower} to {upper}"
    )


def _pencil_rank(claim: Any, system: System) -> str:
    return (
        f"the pencil {PENCIL}, C the outputs of the channels {channels(claim['subset'])} and B the "
        f"inputs of the others, has rank exactly {claim['rank']} at every root of "
        f"{polynomial_text(claim['polynomial'])}"
    )


def _setpoint(claim: Any, system: System) -> str:
    shift, place = ("", 0) if system.time == "continuous" else (" - I", 1)
    start = f"[A{shift}, B; C, 0], B and C those of all channels, has rank exactly {claim['rank']}"
    if claim["solvable"]:
        return (
            f"{start}, which is its number of rows, so that integrators of all outputs add no "
            "uncontrollable mode"
        )
    start += (
        ", which is not its number of rows, so that in no stable linear time-invariant loop every "
        f"output tends to every constant set-point; the normal rank of {PENCIL} is "
    )
    if claim["invariant_zero"]:
        return f"{start}its number of rows, so that {place} is an invariant zero"
    return f"{start}not its number of rows"


def _dimensions(claim: Any, system: System) -> str:
    goal = _freedom(claim["bound"], system.time)
    if claim["free_assignability"]:
        goal += " and a strongly connected transfer graph"
    names = system.names
    limits = (
        f"dimensions with the upper bounds {by_channel(names, claim['upper'])} and the costs "
        f"{by_channel(names, map(rational, claim['costs']))} of one dimension each"
    )
    start = f"the extended system without delays sharing {SHARING[claim['share']]} has {goal}"
    if claim["feasible"]:
        cheaper = "no" if "at_least" in claim else "no cheaper"
        if "at_least" in claim:
            limits += f", of cost below {number(rational(claim['at_least']))}"
        return (
            f"{start} for the dimensions {by_channel(names, claim['dimensions'])} of cost "
            f"{number(rational(claim['cost']))}, and for {cheaper} {limits}"
        )
    return f"{start} for no {limits}"


def _single(claim: Any, system: System) -> str:
    sides = ["(A_F, B_q) controllable", "(C_q, A_F) observable"]
    chosen = {"controllable": sides[:1], "observable": sides[1:], "both": sides}
    goal = f"make {' and '.join(chosen[claim['property']])}"
    goal = f"{goal} for every q in {channels(claim['channels'])}"
    if not claim["exists"]:
        return f"no constant gains F, the same for all q, {goal}"
    indices = by_channel(claim["channels"], claim["indices"])
    return (
        f"some constant gains F, the same for all q, {goal}, with the indices {indices}"
        f"{', and A_F cyclic' if claim['cyclic'] else ''}"
    )


def _box_controllable(claim: Any, system: System, members: str) -> str:
    bound = claim["bound"]
    beyond = "" if bound is None else f" of {_region(bound, system.time, 'at least')}"
    named = channels(claim["channels"])
    return f"{members}, the channels {named} together control every mode{beyond}"


def _box_stable(claim: Any, system: System, members: str) -> str:
    gains, radii = "", claim["gain_radii"]
    if radii is not None:
        near, text = radii
        gains = (
            f", and for all controllers whose entries differ from those of the controller {near}, "
            f"the radii being those with {text}"
        )
    disk = ""
    if "disk" in claim:
        port = {"inputs": "input", "outputs": "output"}[claim["disk"]["at"]]
        size = rational(claim["disk"]["margin"])
        disk = (
            f", also where any one {port} is multiplied by (1 + d/2)/(1 - d/2) for complex numbers "
            f"d with |d| <= {size} (disk margin {size} of each {port} by itself)"
        )
    region = _region(claim["bound"], system.time)
    return f"{members}{gains}{disk}, every eigenvalue of A has {region}"


def _transfer_graph(claim: Any, system: System) -> str:
    parts = _joined([channels(c) for c in listed(claim["components"])])
    return (
        "its transfer graph, in which j -> i means that C_i (xI - A)^-1 B_j is not zero, has "
        f"exactly the edges {edges(claim['arcs'])}, the strong components {parts}, and is "
        f"{_not(claim['strongly_connected'])}strongly connected"
    )


SENTENCES: dict[str, Any] = {
    "assignability": _assignability,
    "box_controllable": _box_controllable,
    "box_fixed": lambda claim, system, members: (
        f"{members}, there is {_freedom(claim['bound'], system.time)}"
    ),
    "box_stable": _box_stable,
    "closed_loop_spectrum": lambda claim, system: (
        f"the characteristic polynomial of A is {polynomial_text(claim['polynomial'])}"
    ),
    "common_dimension": _common,
    "communication": _communication,
    "complementary_subsystem": _complementary,
    "completeness": _completeness,
    "controllability": _controllability,
    "controllability_indices": _indices,
    "cost_bound": _cost_bound,
    "deficiency": _deficiency,
    "disk_margin": _disk_margin,
    "distributed_observer": _observer,
    "exceptional_gains": _exceptional,
    "fixed_spectrum": _spectrum,
    "loop_cost": _loop_cost,
    "neighbor_graph": lambda claim, system: (
        f"its neighbor graph is {_not(claim['strongly_connected'])}strongly connected"
    ),
    "parametric_box_controllable": _box_controllable,
    "parametric_box_fixed": lambda claim, system, values: (
        f"{values}, there is {_freedom(claim['bound'], system.time)}"
    ),
    "parametric_box_stable": _box_stable,
    "parametric_fixed_spectrum": parametric_sentence,
    "parametric_rank": rank_sentence,
    "pencil_rank": _pencil_rank,
    "saturation": _saturation,
    "sector": _sector,
    "setpoint": _setpoint,
    "shared_dimensions": _dimensions,
    "sharing_gap": lambda claim, system: (
        "over its neighbor graph, in which every agent receives from itself, of sets S and R of "
        "agents where no agent of S receives messages of R, "
        f"{claim['relays']} agents send to S and receive from R for some, and at most "
        f"{claim['relays_at_most']} for all; of sets s of agents {claim['boundary']} agents "
        f"outside s send to s for some, and at most {claim['boundary_at_most']} for all"
    ),
    "single_channel_gains": _single,
    "stability": lambda claim, system: (
        f"{_not(claim['stable'])}every eigenvalue of A has {_region(claim['bound'], system.time)}"
        + "".join(
            f" and {words} {number(rational(claim[key]))}"
            for key, words in (
                ("damping", "damping ratio above"),
                ("largest_modulus", "modulus below"),
            )
            if key in claim
        )
    ),
    "step_peaks": _step_peaks,
    "structural_fixed_modes": _structural,
    "transfer_graph": _transfer_graph,
}
