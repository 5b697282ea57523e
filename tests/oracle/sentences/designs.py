"""Judges of the sentences of `design` and `certify`, and of refusals.

The loop is put together signal by signal from the plant and the controller's document alone.  Its
eigenvalues are certified balls around the roots of its characteristic polynomial; that outputs tend
to set-points is simulated from drawn initial states.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat, fmpq_poly
from scipy.linalg import expm
from sympy import Poly, Symbol, sympify

from tests.oracle.certificates.controllers import MAPS
from tests.oracle.sentences.analysis import blamed, judge, lost
from tests.oracle.sentences.cases import (
    Case,
    Facts,
    Region,
    Said,
    UnjudgedError,
    divides,
    irreducible,
    monic,
    number,
)
from tests.oracle.sentences.sharing import OUTPUTS, stays_shared

# What the controller is.


def _agents(case: Case) -> Any:
    return case.loop.agents


def _messages(case: Case) -> set[str]:
    """Which signals of others some agent uses: outputs, shared states, both or none."""
    return {
        kind
        for i, agent in enumerate(_agents(case))
        for parts in agent.maps.values()
        for kind, j in parts
        if j != i and kind in ("outputs", "shared")
    }


def _kind(name: str, case: Case) -> bool:
    """Whether agents exchange what the words for a network say."""
    sizes = [agent.shared for agent in _agents(case)]
    held = any(agent.hold for agent in _agents(case))
    if name == "decentralized":
        return not _messages(case) and not any(sizes)
    late = bool(case.plant.delays)
    if name == "without":
        return not any(sizes) and not held
    return (
        any(sizes)
        and {"extended": not late, "lifted": late, "held": late}[name]
        and (not held or name == "held")
    )


@judge("design-observer", "design-observer-float")
def _observer(said: Said, case: Case) -> bool:
    """Every agent shares an estimate of the same states, and the loop is stable."""
    arithmetic = "float" if said.rule.endswith("float") else "exact"
    estimates = len({agent.shared for agent in _agents(case)}) == 1
    return arithmetic == case.asked["arithmetic"] and estimates and _certified(case)


@judge("design-network")
def _network(said: Said, case: Case) -> bool:
    return _kind(said.values["kind"], case) and _certified(case)


@judge("design-setpoint", "design-tracking")
def _setpoint(said: Said, case: Case) -> bool:
    """A controller with set-points, by the way that the words name, whose loop is stable."""
    told, shared = said.values["method"], "shared" in _messages(case)
    kind = not _messages(case) if told == "decentralized" else shared or told != "observer"
    return kind and _has_references(case) and _certified(case)


def _has_references(case: Case) -> bool:
    return all(
        any(("reference", i) in agent.maps[label] for label in MAPS)
        for i, agent in enumerate(_agents(case))
        if case.plant.C[i].nrows()
    )


def _certified(case: Case) -> bool:
    """Whether every eigenvalue is in the region that was asked for, at least stable."""
    asked = case.asked.get("region") or Region(case.plant.time)
    return bool(asked.contains(case.spectrum))


@judge("certify-states")
def _states(said: Said, case: Case) -> bool:
    return bool(said.values["n"] == case.loop.total)


@judge("design-order", "design-order-integrators", "design-order-models")
def _order(said: Said, case: Case) -> bool:
    order = sum(agent.shared + agent.private for agent in _agents(case))
    holds = said.rule != "design-order"
    return said.values["order"] == order and holds == _has_references(case)


@judge("design-observer-order")
def _observer_order(said: Said, case: Case) -> bool:
    """n for every agent's estimate, and m − 1 for the channel controller."""
    n, m = case.plant.n, case.plant.m
    return bool(said.values["order"] == n * m + m - 1)


@judge("design-shared")
def _shared(said: Said, case: Case) -> bool:
    sizes = [
        [name, agent.shared] for name, agent in zip(case.plant.names, _agents(case), strict=True)
    ]
    return bool([list(pair) for pair in said.values["sizes"]] == sizes)


@judge("design-carrier", "design-carrier-for")
def _carrier(said: Said, case: Case) -> bool:
    """The agent has so many private states besides its integrators."""
    v = said.values
    [i] = case.indices([v["agent"]])
    integrators = int(case.plant.C[i].nrows()) if _has_references(case) else 0
    named = i in case.indices(v["channels"]) if "channels" in v else True
    private = _agents(case)[i].private - integrators
    return named and private == v["order"]


@judge("design-longest-number")
def _longest(said: Said, case: Case) -> bool:
    numbers = [
        x for agent in _agents(case) for parts in agent.maps.values()
        for M in parts.values() for x in M.entries()
    ]  # fmt: skip
    bits = [max(int(abs(x.p)).bit_length(), int(x.q).bit_length()) for x in numbers]
    return bool(said.values["bits"] == max(bits, default=0))


# The spectrum of the loop.


def _feedback_gains(case: Case) -> list[fmpq_mat]:
    """The F_i by which agents multiply their own estimates of the whole state."""
    gains = []
    for i, agent in enumerate(_agents(case)):
        p = case.plant.B[i].ncols()
        if agent.shared != case.plant.n or any(
            kind != "shared" or j != i for kind, j in agent.maps["input"]
        ):
            raise UnjudgedError("agents do not estimate the whole state")
        gains.append(agent.maps["input"].get(("shared", i), fmpq_mat(p, case.plant.n)))
    return gains


@judge("design-feedback")
def _feedback(said: Said, case: Case) -> bool:
    """det(xI − A − Σ B_i F_i), F_i what agents multiply their estimates by."""
    A = case.plant.A
    for B, F in zip(case.plant.B, _feedback_gains(case), strict=True):
        A = A + B * F
    return bool(A.charpoly() == said.values["p"])


@judge("design-errors")
def _errors(said: Said, case: Case) -> bool:
    """What the loop has besides the spectrum of A + Σ B_i F_i."""
    A = case.plant.A
    for B, F in zip(case.plant.B, _feedback_gains(case), strict=True):
        A = A + B * F
    return bool(A.charpoly() * said.values["p"] == case.spectrum)


@judge("design-region", "certify-inside")
def _inside(said: Said, case: Case) -> bool:
    return bool(said.values["region"].contains(case.spectrum))


@judge("certify-outside", "refused-outside")
def _outside(said: Said, case: Case) -> bool:
    return not said.values["region"].contains(case.spectrum)


@judge("certify-largest", "certify-least")
def _extreme(said: Said, case: Case) -> bool:
    """The loop has the rate, or the radius, of its time domain; that none is better is not said."""
    right = (said.rule == "certify-least") == (case.plant.time == "discrete")
    return right and Region(case.plant.time, number(said.values["bound"])).contains(case.spectrum)


@judge("design-assigned")
def _assigned(said: Said, case: Case) -> bool:
    return said.values["p"].degree() > 0 and divides(said.values["p"], case.spectrum)


def _networked(case: Case) -> Facts:
    """The plant with the states that its agents share, over links with their delays."""
    sizes = [agent.shared for agent in _agents(case)]
    kind = case.asked.get("network", "decentralized")
    if kind == "decentralized":
        return case.own
    step: dict[str, Any] = {"construction": kind, "dimensions": sizes}
    if kind != "held":
        step["share"] = case.asked.get("share", OUTPUTS)
    return Facts(case.made(step))


@judge("design-kept")
def _kept(said: Said, case: Case) -> bool:
    """Modes that no gains move, and that the loop still has."""
    p = said.values["p"]
    fixed = [str(q) for q, _ in irreducible(_networked(case).fixed_polynomial)]
    parts = irreducible(p)
    return bool(parts) and all(str(q) in fixed for q, _ in parts) and divides(p, case.spectrum)


# Set-points.


def references(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """The loop's matrix, and the one by which all set-points act on its state."""
    loop = case.loop
    widths = [int(C.nrows()) for C in case.plant.C]
    starts = np.concatenate([[0], np.cumsum(widths)]).astype(int)
    E = np.zeros((loop.total, int(starts[-1])))
    for i, agent in enumerate(loop.agents):
        columns = slice(starts[i], starts[i + 1])
        for label in MAPS:
            R = agent.maps[label].get(("reference", i))
            if R is None:
                continue
            if label == "input":
                E[: case.plant.n, columns] += floats(case.plant.B[i] * R)
            else:
                first = loop.start[label.removesuffix("_update"), i, 0]
                E[first : first + R.nrows(), columns] += floats(R)
    return floats(case.loop_matrix), E


def floats(M: fmpq_mat) -> np.ndarray:
    """A matrix in double precision."""
    entries = [float(Fraction(int(x.p), int(x.q))) for x in M.entries()]
    return np.array(entries, dtype=float).reshape(int(M.nrows()), int(M.ncols()))


def tracks(
    case: Case, varying: Sequence[bool], disturbed: bool = True, seed: int = 0, held: Any = None
) -> bool:
    """Whether outputs whose set-points are constant tend to these, by simulation.

    Parameters
    ----------
    case : Case
    varying : sequence of bool
        For each output whether its set-point is a sine; otherwise it is a drawn constant.
    disturbed : bool
        Whether a drawn constant acts on the plant's states as well.
    held : matrix, optional
        The combinations of the outputs that count, by default each output.
    """
    rng = np.random.default_rng(seed)
    M, E = references(case)
    size, count = E.shape
    C = floats(case.plant.outputs())
    discrete = case.plant.time == "discrete"
    level = rng.uniform(-2, 2, count)
    push = np.zeros(size)
    if disturbed:
        push[: case.plant.n] = rng.uniform(-1, 1, case.plant.n)
    # the whole is autonomous: the state, a constant 1, and a sine with its cosine
    turn = np.array([[np.cos(1), np.sin(1)], [-np.sin(1), np.cos(1)]])
    signal = turn if discrete else np.array([[0.0, 1.0], [-1.0, 0.0]])
    constant = np.where(varying, 0.0, level)
    waves = np.array(varying, dtype=float)
    whole = np.zeros((size + 3, size + 3))
    whole[:size, :size] = M
    whole[:size, size] = E @ constant + push
    whole[:size, size + 1] = E @ waves
    whole[size, size] = float(discrete)
    whole[size + 1 :, size + 1 :] = signal
    values = np.linalg.eigvals(M) if size else np.array([-1.0])
    slow = -np.log(np.abs(values).max() + 1e-300) if discrete else -values.real.max()
    if slow <= 0:
        return False
    span = min(60 / slow, 1e6)
    if not np.isfinite(whole).all() or np.abs(whole).max() > 1e9:
        raise UnjudgedError("the numbers of the loop are too large for double precision")
    step = np.linalg.matrix_power(whole, max(1, int(span))) if discrete else expm(whole * span)
    state = np.concatenate([rng.uniform(-1, 1, size), [1.0, 0.0, 1.0]])
    scale = 1e-5 * (1 + np.abs(level).max(initial=0) + np.abs(C).sum())
    state = step @ state
    for _ in range(5):
        error = C @ state[: case.plant.n] - constant
        if not np.isfinite(error).all():
            raise UnjudgedError("the loop is beyond double precision")
        if held is not None:
            error, varying = held @ error, [False] * len(held)
        away = [abs(e) for e, moves in zip(error, varying, strict=True) if not moves]
        if max(away, default=0.0) > scale * max(1.0, np.abs(state).max() * 1e-3):
            return False
        state = (whole if discrete else expm(whole)) @ state
    return True


@judge("design-steady-state")
def _steady_state(said: Said, case: Case) -> bool:
    """The outputs of the loop, from drawn states, with drawn set-points that are all constant.

    The hypotheses are those of the text: what it does not demand to be constant is varied.
    """
    count = int(case.plant.outputs().nrows())
    every = not said.text or "every set-point, and every disturbance" in said.text
    still = [False] * count
    if not _certified(case):
        return False
    if every:
        return tracks(case, still) and _equilibrium(case)
    return all(
        tracks(case, [k != own for k in range(count)], disturbed=False) for own in range(count)
    )


@judge("design-steady-regulated")
def _steady_regulated(said: Said, case: Case) -> bool:
    """The combinations of the outputs, from drawn states, with drawn constant set-points."""
    S = np.array(_selection(said.values["held"], case), dtype=float)
    still = [False] * int(case.plant.outputs().nrows())
    return bool(len(S)) and _certified(case) and tracks(case, still, held=S)


def _selection(held: Sequence[Sequence[Any]], case: Case) -> list[list[Fraction]]:
    """The rows of combinations over the outputs of all channels."""
    widths = [int(C.nrows()) for C in case.plant.C]
    rows = []
    for name, listed in held:
        i = case.plant.names.index(name)
        for row in listed:
            whole = [Fraction(0)] * sum(widths)
            whole[sum(widths[:i]) : sum(widths[: i + 1])] = [Fraction(x) for x in row]
            rows.append(whole)
    return rows


NAMED = re.compile(
    r"(steps|ramps)|sinusoids of (\S+) rad|cosine (\S+)|solutions of (.+)|degrees up to (\d+)"
)


def signals_of(words: str, case: Case) -> fmpq_poly:
    """The polynomial of signals, from their words: the least one of all of them."""
    x, alpha = fmpq_poly([0, 1]), fmpq_poly([1])
    for part in words.split(", "):
        named = NAMED.search(part)
        if named is None:
            raise UnjudgedError(f"signals in other words: {part}")
        kind, omega, cosine, text, degree = named.groups()
        if kind or degree:
            p = (x - case.own.place) ** (int(degree) + 1 if degree else 1 + (kind == "ramps"))
        elif omega:
            p = x**2 + number(omega) ** 2
        elif cosine:
            p = x**2 - 2 * number(cosine) * x + 1
        else:
            variable = Symbol("sz"[case.own.place])
            found = Poly(sympify(text.replace("^", "**")), variable).all_coeffs()[::-1]
            p = monic(fmpq_poly([fmpq(int(c.p), int(c.q)) for c in found]))
        alpha = monic(alpha * p // alpha.gcd(p))
    return alpha


@judge("design-steady-signals")
def _steady_signals(said: Said, case: Case) -> bool:
    """The exact response to all solutions of the polynomial, as references and disturbances.

    With v' = M v, M the companion matrix, the response is x = X v with X M = L X + E v_1, and
    there is one X for each place where v_1 enters.
    """
    rows = _selection(said.values["held"], case)
    S = [[fmpq(x.numerator, x.denominator) for x in row] for row in rows]
    if not S or not _certified(case):
        return False
    alpha, E = signals_of(said.values["signals"], case), exact_references(case)
    total, n, d, q = case.loop.total, case.plant.n, alpha.degree(), E.ncols()
    whole = fmpq_mat(total * d, total * d)
    L = case.loop_matrix
    for k in range(d):
        for i in range(total):
            for j in range(total):
                whole[k * total + i, k * total + j] = -L[i, j]
            if k:  # the column k of X M is column k − 1 of X, less the last one times a_k
                whole[k * total + i, (k - 1) * total + i] += 1
            whole[k * total + i, (d - 1) * total + i] -= alpha[k]
    enters = fmpq_mat(total * d, q + n)
    for i in range(total):
        for j in range(q):
            enters[i, j] = E[i, j]
    for i in range(n):
        enters[i, q + i] = 1
    X = whole.solve(enters)
    C = case.plant.outputs()
    for row in S:
        for j in range(q + n):
            for k in range(d):
                error = fmpq(0)
                for a, s in enumerate(row):
                    y = sum((C[a, i] * X[k * total + i, j] for i in range(n)), fmpq(0))
                    error += s * (y - int(k == 0 and j == a))
                if error != 0:
                    return False
    return True


def exact_references(case: Case) -> fmpq_mat:
    """The matrix by which all set-points act on the state of the loop."""
    total = case.loop.total
    widths = [int(C.nrows()) for C in case.plant.C]
    E = fmpq_mat(total, sum(widths))
    column = 0
    for i, agent in enumerate(case.loop.agents):
        for label in MAPS:
            R = agent.maps[label].get(("reference", i))
            if R is None:
                continue
            first = 0 if label == "input" else case.loop.start[label.removesuffix("_update"), i, 0]
            part = case.plant.B[i] * R if label == "input" else R
            for a in range(part.nrows()):
                for b in range(part.ncols()):
                    E[first + a, column + b] = E[first + a, column + b] + part[a, b]
        column += widths[i]
    return E


def _equilibrium(case: Case) -> bool:
    """Whether the exact equilibrium of constant set-points has the outputs equal to them."""
    total, n = case.loop.total, case.plant.n
    E = exact_references(case)
    column = int(E.ncols())
    M = fmpq_mat(case.loop_matrix)
    for k in range(total):
        M[k, k] = M[k, k] - case.own.place
    rest = M.solve(-1 * E)
    C = case.plant.outputs()
    held = C * fmpq_mat(n, column, [rest[i, j] for i in range(n) for j in range(column)])
    return all(held[i, j] == int(i == j) for i in range(column) for j in range(column))


# Refusals.


def _refused(case: Case) -> Facts:
    """The system that the sentence names: the plant, or its error system, or its integrators."""
    steps = [step for step in case.asked["steps"] if step["construction"] != "dual"]
    return Facts(case.made(*steps))


def _escapes(said: Said, p: fmpq_poly) -> bool:
    region = said.values.get("region")
    return region is None or not region.contains(p)


@judge("refused-not-controllable", "refused-not-controllable-in", "refused-uncontrollable")
def _no_control(said: Said, case: Case) -> bool:
    return lost(said, case.own.uncontrolled()) and _escapes(said, said.values["p"])


@judge("refused-unobservable", "refused-not-observable")
def _no_observation(said: Said, case: Case) -> bool:
    return lost(said, case.own.unobserved()) and _escapes(said, said.values["p"])


def _integrators(case: Case) -> Mapping[str, Any]:
    """The construction of the integrators that the sentence is about."""
    named = ("integrators", "servo", "internal_model")
    made = [step for step in case.asked.get("steps", ()) if step["construction"] in named]
    return made[0] if made else {"construction": "integrators"}


def _integrated(case: Case) -> Facts:
    return Facts(case.made(_integrators(case)))


@judge("refused-integrators-control", "refused-models-control")
def _integrators_control(said: Said, case: Case) -> bool:
    return lost(said, _integrated(case).uncontrolled())


@judge("refused-integrators-observe", "refused-models-observe")
def _integrators_observe(said: Said, case: Case) -> bool:
    return lost(said, _integrated(case).unobserved())


@judge("refused-integrators-fixed", "refused-models-fixed")
def _integrators_fixed(said: Said, case: Case) -> bool:
    """Fixed with as many shared states as there are states, and with outputs sent as well."""
    plant = replace(case, plant=case.made(_integrators(case)))
    most = [plant.plant.n] * plant.plant.m
    fixed = plant.extended(most, OUTPUTS).fixed_polynomial
    p = monic(said.values["p"])
    return p.degree() > 0 and all(divides(q, fixed) for q, _ in irreducible(p))


@judge("refused-models-alone")
def _models_alone(said: Said, case: Case) -> bool:
    """Fixed without messages between the agents of the plant with its models."""
    fixed, p = _integrated(case).fixed_polynomial, monic(said.values["p"])
    return p.degree() > 0 and all(divides(q, fixed) for q, _ in irreducible(p))


@judge("refused-errors-not-complete")
def _errors_not_complete(said: Said, case: Case) -> bool:
    """No channel of the error system controls and observes everything under drawn gains."""
    facts = _refused(case)
    return len(facts.components) > 1 or facts.fixed_polynomial.degree() > 0


@judge("refused-errors-fixed")
def _errors_fixed(said: Said, case: Case) -> bool:
    facts, p = _refused(case), said.values["p"]
    return p.degree() > 0 and divides(p, facts.fixed_polynomial) and _escapes(said, p)


def _fixed_in(said: Said, case: Case, facts: Facts) -> bool:
    """Fixed, not in the region, and by the channels that are blamed."""
    p = said.values["p"]
    outside, inside = (case.indices(names) for names in said.values["sides"])
    slow = not case.asked["region"].contains(p)
    parts = irreducible(p)
    fixed = bool(parts) and all(divides(q, facts.fixed_polynomial) for q, _ in parts)
    return slow and fixed and all(blamed(q, outside, inside, facts) for q, _ in parts)


@judge("refused-fixed")
def _fixed(said: Said, case: Case) -> bool:
    """The mode is one of the plant, of which the sentence speaks, and not of its integrators."""
    return _fixed_in(said, case, case.own)


@judge("refused-fixed-shared")
def _fixed_shared(said: Said, case: Case) -> bool:
    sizes = [size for _, size in said.values["sizes"]]
    kinds = [step for step in case.asked["steps"] if "dimensions" in step]
    if [list(step["dimensions"]) for step in kinds] != [sizes]:
        return False
    return _fixed_in(said, case, Facts(case.made(*kinds)))


def _shared_at_most(case: Case) -> Facts:
    sizes = [case.plant.n] * case.plant.m
    return case.extended(sizes, case.asked.get("share") or OUTPUTS)


def _cut(said: Said, case: Case) -> bool:
    """The agents named receive from nobody else, as told, and need something."""
    s = case.indices(said.values["agents"])
    right = set(case.indices(said.values["senders"])) == case.senders(s) == set()
    return right and said.values["k"] > 0 and bool(s)


@judge("refused-over-links")
def _over_links(said: Said, case: Case) -> bool:
    """A slow mode stays with as many shared states as the plant has."""
    return _escapes(said, said.values["p"]) and stays_shared(said, case)


@judge("refused-no-connection")
def _no_connection(said: Said, case: Case) -> bool:
    """The transfer graph is not strongly connected with as many shared states as help."""
    return len(_shared_at_most(case).components) > 1 and _cut(said, case)


def _no_equilibrium_for(rows: Sequence[Sequence[Any]], case: Case) -> bool:
    """Whether w · y vanishes at every equilibrium, for each of these rows and for some row."""
    facts = case.own
    n, q = facts.n, int(case.plant.outputs().nrows())
    M = facts.merged.pencil_of_all
    steady = fmpq_mat(M)
    for i in range(n):
        steady[i, i] = steady[i, i] + facts.place
    before = steady.rank()
    for row in rows:
        # (x, u) with w C x = 1 and (A − σ) x + B u = 0 exists iff the rank grows
        w = [number(Fraction(x)) for x in row]
        C = case.plant.outputs()
        top = [[steady[i, j] for j in range(steady.ncols())] for i in range(n)]
        last = [sum((w[k] * C[k, j] for k in range(q)), number(0)) for j in range(n)]
        last += [number(0)] * (steady.ncols() - n)
        upper = fmpq_mat(n, steady.ncols(), [v for line in top for v in line])
        both = fmpq_mat(n + 1, steady.ncols(), [v for line in (*top, last) for v in line])
        if not any(w) or both.rank() > upper.rank():
            return False
    return bool(rows) and before < n + q


@judge("refused-no-equilibrium")
def _no_equilibrium(said: Said, case: Case) -> bool:
    return _no_equilibrium_for(said.values["w"], case)


@judge("refused-no-equilibrium-zero")
def _no_equilibrium_zero(said: Said, case: Case) -> bool:
    facts = case.own
    zero = said.values["place"] == facts.place and facts.steady_rank() < facts.normal_rank()
    return zero and _no_equilibrium_for(said.values["w"], case)


@judge("refused-mode-of-the-integrators")
def _mode_of_integrators(said: Said, case: Case) -> bool:
    place = said.values["place"]
    return place == case.own.place and str(fmpq_poly([-place, 1])) in map(
        str, case.own.uncontrolled()
    )


def document_of(controller: Mapping[str, Any]) -> dict[str, Any]:
    """The parts of a controller's document that make the loop."""
    keys = ("name", "shared", "private", "hold", *MAPS)
    agents = [{key: a[key] for key in keys if key in a} for a in controller["agents"]]
    return {"time": controller["time"], "agents": agents}
