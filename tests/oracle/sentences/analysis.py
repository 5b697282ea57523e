"""Judges of the sentences of `analyze`: modes, structure, a set of channels, one channel, pictures.

Fixed modes are decided by the rank of the pencil of every subset, and what gains can move by the
greatest common divisor of drawn loops; whether something is assigned in parts by the irreducible
factors of such a loop, which are as many as strong components have modes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from types import FunctionType
from typing import Any

from flint import fmpq_poly

from tests.oracle.certificates.roots import roots_of
from tests.oracle.sentences.cases import (
    Case,
    Facts,
    Region,
    Said,
    divides,
    index_ranks,
    irreducible,
    number,
    partition,
    same_roots,
)
from tests.oracle.structure import RING, minors_divisor
from tests.oracle.structure import X as RING_X

Judge = Callable[[Said, Case], bool]
JUDGES: dict[str, Judge] = {}


def judge(*rules: str) -> Callable[[Judge], Judge]:
    """Enter a judge of the sentences of some rules.

    A module that is run once more, as a collector of doctests does, enters its judges once more.
    """

    def made(decides: Judge) -> Judge:
        for rule in rules:
            known = JUDGES.setdefault(rule, decides)
            if known is not decides and not _run_again(known, decides):
                raise ValueError(f"two judges of {rule}")
        return decides

    return made


def _run_again(known: Judge, decides: Judge) -> bool:
    """Whether two judges are of one line of one file, which has been run twice."""
    if not (isinstance(known, FunctionType) and isinstance(decides, FunctionType)):
        return False
    same = known.__code__.co_filename == decides.__code__.co_filename
    lines = known.__code__.co_firstlineno == decides.__code__.co_firstlineno
    return same and lines and known.__globals__ is not decides.__globals__


# What is given.


@judge("heading", "page-heading")
def _heading(said: Said, case: Case) -> bool:
    v, plant = said.values, case.plant
    sizes = v["n"] == plant.n and v["m"] == plant.m and v["time"] == plant.time
    named = "names" not in v or tuple(v["names"]) == plant.names
    return sizes and named and ("information" not in v or _information(said, case))


@judge("information")
def _information(said: Said, case: Case) -> bool:
    """Outputs of neighbors, and that they arrive without delay where links have delays."""
    received = "instant" if case.plant.delays else "outputs"
    own = case.asked.get("information", "own") == "own"
    return bool(said.values["information"] == ("own" if own else received))


@judge("inactive-channels")
def _inactive(said: Said, case: Case) -> bool:
    """The channels without inputs that act, or without outputs that an agent can feed back."""
    system = case.subject.system
    ports = zip(system.names, system.B, system.C, strict=True)
    idle = [name for name, B, C in ports if not any(B.entries()) or not any(C.entries())]
    return bool(said.values["names"] == idle)


@judge("channel")
def _channel(said: Said, case: Case) -> bool:
    return bool(said.values["name"] == case.asked["channel"])


@judge("picture-neighbor-graph")
def _neighbors(said: Said, case: Case) -> bool:
    names, neighborhoods = case.plant.names, case.plant.neighborhoods or ()
    edges = {(names[j], names[i]) for i, N in enumerate(neighborhoods) for j in N if i != j}
    return _pairs(said.values["arcs"]) == edges


@judge("picture-heard")
def _picture_heard(said: Said, case: Case) -> bool:
    """The agents outside the set of the picture from which some of it receive."""
    shown = case.others("picture-obstruction")
    s = case.indices(shown[0].values["s"]) if shown else []
    return set(case.indices(said.values["heard"])) == case.senders(s)


def _pairs(arcs: Sequence[Sequence[str]]) -> set[tuple[str, str]]:
    return {(start, end) for start, end in arcs}


# Fixed modes.


def control(said: Said, case: Case) -> bool:
    """Whether the words for the control fit the information and the delays of links."""
    own = case.asked.get("information", "own") == "own"
    received = "instant" if case.plant.delays else "outputs"
    told = said.values.get("control", "own" if own else received)
    return bool(told == received or (own and told in {"own", "alone"}))


def facts_of(said: Said, case: Case) -> Facts:
    """The plant with what the control that is named lets agents feed back."""
    told = said.values.get("control")
    return (
        case.subject
        if told is None
        else case.own
        if told in {"own", "alone"}
        else case.with_outputs
    )


@judge("nothing-fixed", "fixed-none", "latex-nothing-fixed", "any-rate")
def _nothing_fixed(said: Said, case: Case) -> bool:
    facts = facts_of(said, case)
    return not facts.fixed and facts.fixed_polynomial.degree() == 0 and control(said, case)


@judge("fixed")
def _fixed(said: Said, case: Case) -> bool:
    return same_roots(said.values["p"], case.subject.fixed) and case.subject.fixed != []


@judge("fixed-modes")
def _some_fixed(said: Said, case: Case) -> bool:
    return bool(case.subject.fixed) and control(said, case)


@judge("fixed-modes-note")
def _note(said: Said, case: Case) -> bool:
    return bool(said.values["n"] == case.plant.n)


def stable(facts: Facts) -> bool:
    """Whether every fixed mode is stable."""
    return all(Region(facts.system.time).contains(p) for p in facts.fixed)


@judge("table-stabilizable")
def _table_stabilizable(said: Said, case: Case) -> bool:
    return stable(facts_of(said, case)) and control(said, case)


@judge("table-not-stabilizable")
def _table_not_stabilizable(said: Said, case: Case) -> bool:
    return not stable(facts_of(said, case)) and control(said, case)


@judge("stabilizable")
def _stabilizable(said: Said, case: Case) -> bool:
    return _table_stabilizable(said, case) and _slowest(said, case)


@judge("not-stabilizable")
def _not_stabilizable(said: Said, case: Case) -> bool:
    return _table_not_stabilizable(said, case) and _slowest(said, case)


@judge("slowest")
def _slowest(said: Said, case: Case) -> bool:
    """The slowest fixed mode lies in the enclosure, and the text says how it behaves."""
    return slowest_of(facts_of(said, case), said, case)


def slowest_of(facts: Facts, said: Said, case: Case) -> bool:
    """Whether the slowest fixed mode of a system is as it is said."""
    time, low, high, is_stable = said.values["slowest"]
    if not facts.fixed or time != case.plant.time or is_stable != stable(facts):
        return False
    roots = [z for p in facts.fixed for z in roots_of(p)]
    if time == "discrete":
        value = max(abs(complex(z)) for z in roots)
    else:
        value = min(-float(z.real) for z in roots)
    near = 1e-9 * max(1.0, abs(value))
    if not Fraction(low) - Fraction(near) <= Fraction(value) <= Fraction(high) + Fraction(near):
        return False
    return not said.text or _behaves(said.text, time, value, is_stable)


def _behaves(text: str, time: str, value: float, is_stable: bool) -> bool:
    """Whether the words for a rate, or for a factor, fit its value."""
    told = re.search(r"(rate|becomes) (?:about )?([-+\d./e]+)", text)
    if told is None:
        edge = abs(value - (time == "discrete")) < 1e-6
        return edge and ("does not decay" in text) == (not is_stable)
    figure = float(Fraction(told[2].rstrip(".")))
    if time == "continuous":
        if ("decays" in text) != (value > 0) or ("grows" in text) != (value < 0):
            return False
        value = abs(value)
    return abs(figure - value) <= 1e-3 * max(value, 1e-12)


def often(values: Mapping[str, Any], facts: Facts) -> bool:
    """Whether a mode is so often in A, and at most so often fixed."""
    p = values["p"]
    in_A, at_most = values["often"] if "often" in values else (values["in_A"], values["stays"])
    exact = {str(q): e for q, e in facts.modes}.get(str(p), 0)
    fixed = {str(q): e for q, e in irreducible(facts.fixed_polynomial)}.get(str(p), 0)
    return in_A in (None, exact) and fixed <= at_most and (in_A is None or at_most <= in_A)


def blamed(p: fmpq_poly, outside: Sequence[int], inside: Sequence[int], facts: Facts) -> bool:
    """Whether some channels do not control a mode and others do not observe it, for all gains."""
    for A in (facts.system.A, *facts.loops):
        if outside and facts.controls(outside, p, A):
            return False
        if inside and facts.observes(inside, p, A):
            return False
    return bool(outside or inside)


def _is_fixed(said: Said, case: Case) -> bool:
    facts, p = case.subject, said.values["p"]
    right = str(p) in map(str, facts.fixed) and often(said.values, facts)
    kept = said.values["often"][1]
    return right and (kept != 1 or divides(p, facts.fixed_polynomial))


@judge("fixed-mode")
def _blame(said: Said, case: Case) -> bool:
    """Fixed, by channels that all are on one of the two sides."""
    outside, inside = (case.indices(said.values[side]) for side in ("outside", "inside"))
    whole = sorted([*outside, *inside]) == list(range(case.plant.m))
    facts, p = case.subject, said.values["p"]
    return whole and _is_fixed(said, case) and blamed(p, outside, inside, facts)


@judge("fixed-mode-uncontrolled")
def _uncontrolled_mode(said: Said, case: Case) -> bool:
    return _is_fixed(said, case) and str(said.values["p"]) in map(str, case.subject.uncontrolled())


@judge("fixed-mode-unobserved")
def _unobserved_mode(said: Said, case: Case) -> bool:
    return _is_fixed(said, case) and str(said.values["p"]) in map(str, case.subject.unobserved())


@judge("fixed-modes-row")
def _row(said: Said, case: Case) -> bool:
    v, facts = said.values, case.subject
    roots = sorted((complex(z) for z in roots_of(v["p"])), key=lambda z: (z.real, z.imag))
    shown = sorted((complex(re_, im) for re_, im in v["roots"]), key=lambda z: (z.real, z.imag))
    near = len(roots) == len(shown) and all(
        min(abs(a - b) for b in shown) < 1e-5 * max(1, abs(a)) for a in roots
    )
    rank = facts.rank(case.indices(v["s"]), v["p"])
    inside = Region(case.plant.time).contains(v["p"])
    known = str(v["p"]) in map(str, facts.fixed) and often(v, facts)
    return near and known and rank == v["rank"] < facts.n and inside == v["stable"]


@judge("latex-fixed-mode")
def _latex_row(said: Said, case: Case) -> bool:
    v, facts = said.values, case.subject
    exact = {str(q): e for q, e in facts.modes}.get(str(v["p"]), 0)
    rank = facts.rank(case.indices(v["s"]), v["p"])
    return v["in_A"] in (None, exact) and rank == v["rank"] < facts.n and exact > 0


@judge("picture-obstruction")
def _obstruction(said: Said, case: Case) -> bool:
    facts = case.subject
    fixed = str(said.values["p"]) in map(str, facts.fixed)
    return fixed and facts.rank(case.indices(said.values["s"]), said.values["p"]) < facts.n


# How the spectrum can be assigned.


def through(facts: Facts, channel: int) -> bool:
    """Whether under drawn gains one channel controls and observes everything."""
    system = facts.system
    for _ in range(3):
        A = facts.drawn([i for i in range(facts.m) if i != channel])
        ends = (index_ranks(A, system.B[channel]),
                index_ranks(A.transpose(), system.C[channel].transpose()))  # fmt: skip
        if all((ranks or [0])[-1] == facts.n for ranks in ends):
            return True
    return False


@judge("free-through-any-channel")
def _any_channel(said: Said, case: Case) -> bool:
    return all(through(case.subject, q) for q in range(case.plant.m))


@judge("complete")
def _complete(said: Said, case: Case) -> bool:
    """A strongly connected transfer graph, and no fixed mode."""
    facts = case.subject
    return bool(said.values["complete"] == (len(facts.components) == 1 and not facts.fixed))


@judge("free", "spectrum-free")
def _free(said: Said, case: Case) -> bool:
    """No mode is fixed, and a drawn loop has one irreducible factor."""
    return case.subject.fixed_polynomial.degree() == 0 and len(case.subject.parts) <= 1


@judge("parts")
def _parts(said: Said, case: Case) -> bool:
    facts = case.subject
    return facts.fixed_polynomial.degree() == 0 and len(facts.parts) == said.values["k"] > 1


@judge("spectrum-parts")
def _blocks(said: Said, case: Case) -> bool:
    """The degrees are those of a drawn loop, and gains of one block move that factor alone."""
    facts = case.subject
    blocks = [(size, case.indices(names)) for size, names in said.values["blocks"] if size]
    if facts.fixed_polynomial.degree() or sorted(size for size, _ in blocks) != facts.parts:
        return False
    before = facts.loops[0]
    for size, channels in blocks:
        after = facts.drawn(channels, before)
        if before.charpoly().gcd(after.charpoly()).degree() != facts.n - size:
            return False
    return True


@judge("spectrum-moved")
def _moved(said: Said, case: Case) -> bool:
    facts = case.subject
    return bool(
        said.values["k"] == facts.n - facts.fixed_polynomial.degree()
        and said.values["n"] == facts.n
    )


@judge("spectrum-moved-between")
def _moved_between(said: Said, case: Case) -> bool:
    facts, v = case.subject, said.values
    return bool(
        v["k"] <= facts.n - facts.fixed_polynomial.degree() <= v["most"] and v["n"] == facts.n
    )


# Structure.


@judge("controllable")
def _controllable(said: Said, case: Case) -> bool:
    return not case.own.uncontrolled()


@judge("observable")
def _observable(said: Said, case: Case) -> bool:
    return not case.own.unobserved()


@judge("uncontrollable")
def _uncontrollable(said: Said, case: Case) -> bool:
    return lost(said, case.own.uncontrolled())


@judge("unobservable")
def _unobservable(said: Said, case: Case) -> bool:
    return lost(said, case.own.unobserved())


def lost(said: Said, modes: Sequence[fmpq_poly]) -> bool:
    """Whether the modes named are these, and at least one."""
    return bool(modes) and same_roots(said.values["p"], modes)


def _asked_channel(case: Case) -> list[int]:
    return case.indices([case.asked["channel"]])


@judge("channel-controllability")
def _alone(said: Said, case: Case) -> bool:
    return not case.subject.uncontrolled(_asked_channel(case))


@judge("channel-no-controllability")
def _not_alone(said: Said, case: Case) -> bool:
    return lost(said, case.subject.uncontrolled(_asked_channel(case)))


@judge("channel-observability")
def _sees(said: Said, case: Case) -> bool:
    return not case.subject.unobserved(_asked_channel(case))


@judge("channel-no-observability")
def _sees_not(said: Said, case: Case) -> bool:
    return lost(said, case.subject.unobserved(_asked_channel(case)))


def _arcs(case: Case) -> set[tuple[str, str]]:
    names = case.plant.names
    return {(names[j], names[i]) for j, i in case.subject.arcs}


@judge("transfer-graph-connected", "transfer-graph-parts")
def _graph(said: Said, case: Case) -> bool:
    names = case.plant.names
    parts = [[names[i] for i in part] for part in case.subject.components]
    told = said.values.get("components")
    right = sorted(told) == sorted(parts) if told is not None else len(parts) == 1
    whole = (said.rule == "transfer-graph-connected") == (len(parts) == 1)
    return right and whole and _pairs(said.values["arcs"]) == _arcs(case)


@judge("picture-transfer-graph")
def _graph_drawn(said: Said, case: Case) -> bool:
    return _pairs(said.values["arcs"]) == {(j, i) for j, i in _arcs(case) if i != j}


def _index(transposed: bool) -> Judge:
    def decides(said: Said, case: Case) -> bool:
        """The indices of all inputs, or of all outputs, and their largest if all states count."""
        system = case.subject.system
        A, B = system.A, system.inputs()
        if transposed:
            A, B = A.transpose(), system.outputs().transpose()
        ranks = index_ranks(A, B)
        whole = (ranks or [0])[-1] == system.n
        if said.rule.endswith("-index"):
            right = whole and said.values["index"] == len(ranks)
        else:
            right = not whole
        return right and said.values["indices"] == [k for k in partition(ranks) if k]

    return decides


judge("controllability-index", "controllability-indices")(_index(False))
judge("observability-index", "observability-indices")(_index(True))


# A set of channels.


def _subset(said: Said, case: Case) -> list[int]:
    return case.indices(case.asked["subset"])


@judge("pencil")
def _pencil(said: Said, case: Case) -> bool:
    """The rows below name every mode of A."""
    rows = case.others("pencil-row")
    named = {str(q) for row in rows for q, _ in irreducible(row.values["p"])}
    every = {str(p) for p, _ in case.subject.modes}
    return said.values["s"] == list(case.asked["subset"]) and named == every


@judge("pencil-row")
def _pencil_row(said: Said, case: Case) -> bool:
    v, facts = said.values, case.subject
    ranks = {facts.rank(_subset(said, case), q) for q, _ in irreducible(v["p"])}
    return (
        ranks == {v["rank"]} and v["below"] == (v["rank"] < facts.n) and divides(v["p"], facts.chi)
    )


def _minors(case: Case, size: int) -> fmpq_poly:
    """The greatest common divisor of minors of the pencil of the subset."""
    M = case.subject.pencil(_subset(Said("", {}), case))
    n = case.plant.n
    rows = [
        [RING(Fraction(int(v.p), int(v.q))) + (RING_X if i == j < n else 0)
         for j, v in enumerate(row)]
        for i, row in enumerate(M.tolist())
    ]  # fmt: skip
    found = minors_divisor(rows, size)
    if not found:
        return fmpq_poly([])
    terms = {power[0]: c for power, c in found.monic().terms()}
    return fmpq_poly([_flint(terms.get(k, 0)) for k in range(max(terms) + 1)])


def _flint(value: Any) -> Any:
    return number(Fraction(int(value.numerator), int(value.denominator)) if value else 0)


def _normal(case: Case) -> int:
    """The largest rank of the pencil of the subset at drawn points."""
    facts = case.subject
    points = [fmpq_poly([-(10**5 + 17 * k), 1]) for k in range(2)]
    return max(facts.rank(_subset(Said("", {}), case), p) for p in points)


@judge("subsystem")
def _subsystem(said: Said, case: Case) -> bool:
    return bool(said.values["s"] == list(case.asked["subset"]))


@judge("subsystem-normal-rank")
def _normal_rank(said: Said, case: Case) -> bool:
    return bool(said.values["rank"] == _normal(case))


@judge("subsystem-zeros")
def _zeros(said: Said, case: Case) -> bool:
    """The points where the rank is below the normal one, which are roots of all large minors."""
    zeros = irreducible(_minors(case, _normal(case)))
    return bool(zeros) and sorted(map(str, said.values["zeros"])) == sorted(
        str(p) for p, _ in zeros
    )


@judge("subsystem-no-zeros")
def _no_zeros(said: Said, case: Case) -> bool:
    return _minors(case, _normal(case)).degree() == 0


@judge("subsystem-remnant")
def _remnant(said: Said, case: Case) -> bool:
    return bool(said.values["p"] == _minors(case, case.plant.n))


def _drops(case: Case) -> list[str]:
    """The modes of A where the rank of the pencil is below n."""
    s, facts = _subset(Said("", {}), case), case.subject
    return sorted(str(p) for p, _ in facts.modes if facts.rank(s, p) < facts.n)


def _zero_transfer(case: Case) -> bool:
    """Whether no channel outside the set acts on one in it."""
    s = set(_subset(Said("", {}), case))
    return not any(j not in s and i in s for j, i in case.subject.arcs)


@judge("subsystem-complete")
def _subsystem_complete(said: Said, case: Case) -> bool:
    return not _zero_transfer(case) and not _drops(case)


@judge("subsystem-zero")
def _subsystem_zero(said: Said, case: Case) -> bool:
    return _zero_transfer(case) and not _drops(case)


@judge("subsystem-drops")
def _subsystem_drops(said: Said, case: Case) -> bool:
    drops = sorted(map(str, said.values["zeros"]))
    return not _zero_transfer(case) and drops == _drops(case) != []


@judge("subsystem-zero-and-drops")
def _subsystem_both(said: Said, case: Case) -> bool:
    return _zero_transfer(case) and sorted(map(str, said.values["zeros"])) == _drops(case) != []


# Gains for one channel.


def reaches(facts: Facts, q: int, side: str) -> list[int]:
    """The least lengths with which drawn gains let a channel control and observe everything."""
    best: list[int] | None = None
    for _ in range(3):
        A, B, C = facts.drawn(), facts.system.B[q], facts.system.C[q]
        ends = {"controllable": (A, B), "observable": (A.transpose(), C.transpose())}
        wanted = ends if side == "both" else {side: ends[side]}
        ranks = [index_ranks(*pair) for pair in wanted.values()]
        if all((each or [0])[-1] == facts.n for each in ranks):
            lengths = [len(each) for each in ranks]
            best = lengths if best is None else min(best, lengths)
    return best or ([] if facts.n else [0])


def _gains(rules: str, side: str) -> None:
    def asked(case: Case) -> list[int]:
        every = rules == "every-channel"
        return list(range(case.plant.m)) if every else _asked_channel(case)

    @judge(f"{rules}-gains")
    def _reached(said: Said, case: Case) -> bool:
        """Some gains do, and the lengths told are no shorter than drawn gains need."""
        least = [reaches(case.subject, q, side) for q in asked(case)]
        told, n = said.values["reached"], case.plant.n
        if any(not each for each in least) or len(told) != len(least):
            return False
        pairs = [pair for a, b in zip(told, least, strict=True) for pair in zip(a, b, strict=True)]
        return all(b <= a <= n for a, b in pairs)

    @judge(f"{rules}-stuck")
    def _stuck(said: Said, case: Case) -> bool:
        """The channel does not reach the mode, whichever gains are drawn."""
        facts, v = case.subject, said.values
        q = case.indices([v["name"]])
        if q[0] not in asked(case) or side not in ("both", v["side"]):
            return False
        look = facts.controls if v["side"] == "controllable" else facts.observes
        parts = irreducible(v["p"])
        loops = (facts.system.A, *facts.loops)
        return bool(parts) and not any(look(q, p, A) for p, _ in parts for A in loops)

    for each in ("controllable", "observable"):
        if side in ("both", each):
            judge(f"{rules}-unreached-{each}")(_unreached(each, asked))


def _unreached(side: str, asked: Callable[[Case], list[int]]) -> Judge:
    def decides(said: Said, case: Case) -> bool:
        """No path leads to the channels named, or from them, and drawn gains do not help."""
        facts, rest = case.subject, case.indices(said.values["rest"])
        [q] = case.indices([said.values["name"]])
        apart = [
            k not in facts.reachable(q) if side == "controllable" else q not in facts.reachable(k)
            for k in rest
        ]
        return q in asked(case) and all(apart) and not reaches(facts, q, side) and bool(rest)

    return decides


for each in ("controllable", "observable", "both"):
    _gains(f"channel-{each}", each)
_gains("every-channel", "both")


# Set-points.


def _full(facts: Facts) -> int:
    return facts.n + int(facts.system.outputs().nrows())


def _held(facts: Facts) -> bool:
    """Whether every set-point has an equilibrium, and all unstable modes are within reach."""
    unreached = [*facts.uncontrolled(), *facts.unobserved()]
    inside = Region(facts.system.time)
    return facts.steady_rank() == _full(facts) and all(map(inside.contains, unreached))


@judge("setpoint")
def _setpoint(said: Said, case: Case) -> bool:
    return _held(case.own)


@judge("setpoint-stable-rest")
def _setpoint_rest(said: Said, case: Case) -> bool:
    return _held(case.own) and bool(case.own.uncontrolled() or case.own.unobserved())


@judge("setpoint-unstable-rest")
def _setpoint_never(said: Said, case: Case) -> bool:
    """All modes that are named are out of reach, and not all of them are stable."""
    facts, p = case.own, said.values["p"]
    unreached = {str(q) for q in (*facts.uncontrolled(), *facts.unobserved())}
    parts = {str(q) for q, _ in irreducible(p)}
    return bool(parts) and parts <= unreached and not Region(facts.system.time).contains(p)


@judge("setpoint-zero")
def _setpoint_zero(said: Said, case: Case) -> bool:
    facts = case.own
    drop = facts.steady_rank() < facts.normal_rank()
    return bool(said.values["place"] == facts.place and drop and facts.steady_rank() < _full(facts))


@judge("setpoint-dependent")
def _setpoint_dependent(said: Said, case: Case) -> bool:
    return case.own.normal_rank() < _full(case.own)


@judge("setpoint-fewer-inputs")
def _setpoint_fewer(said: Said, case: Case) -> bool:
    """The numbers are those of the columns and rows, and no rank is that of all rows."""
    system, values = case.own.system, said.values
    sizes = int(system.inputs().ncols()), int(system.outputs().nrows())
    return (values["inputs"], values["outputs"]) == sizes and case.own.normal_rank() < _full(
        case.own
    )
