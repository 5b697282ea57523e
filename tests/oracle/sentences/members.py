"""Judges of sentences about many plants: all within radii, and all at values within ranges.

Such a sentence is refuted by one member that lacks what it says.  Corners and inner members are
drawn; a sentence that none of them refutes is taken for true.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

from flint import fmpq, fmpq_mat

from tests.oracle.certificates.constructions import built
from tests.oracle.certificates.controllers import Loop, read_agents
from tests.oracle.certificates.sampling import sharpened
from tests.oracle.certificates.systems import System
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Facts, Region, Said, number
from tests.oracle.sentences.parameters import inner_points

MEMBERS = 24
"""How many members are drawn, half of them corners."""
Share = Callable[[], fmpq]


def shares(rng: random.Random, corner: bool) -> Share:
    """Parts of radii from −1 to 1, or the ends alone."""
    if corner:
        return lambda: fmpq(rng.choice((-1, 1)))
    return lambda: fmpq(rng.randint(-16, 16), 16)


def moved(M: fmpq_mat, radii: fmpq_mat, share: Share) -> fmpq_mat:
    """A matrix whose entries are moved by parts of their radii."""
    found = fmpq_mat(M)
    for i in range(M.nrows()):
        for j in range(M.ncols()):
            if radii[i, j]:
                found[i, j] = found[i, j] + radii[i, j] * share()
    return found


def scaled(M: fmpq_mat, part: fmpq) -> fmpq_mat:
    """So large a part of the modulus of each entry."""
    return fmpq_mat(M.nrows(), M.ncols(), [abs(x) * part for x in M.entries()])


def members(plant: System, part: fmpq | None = None, seed: int = 0) -> Iterator[System]:
    """The plant itself, corners of its box, and members inside; of a part of each entry if told."""
    rng = random.Random(seed)
    yield plant
    for k in range(MEMBERS):
        share = shares(rng, k % 2 == 0)
        if part is None:
            A, B, C = plant.radii or (scaled(plant.A, fmpq(0)), [], [])
        else:
            A = scaled(plant.A, part)
            B, C = ([scaled(M, part) for M in Ms] for Ms in (plant.B, plant.C))
        ports = [
            tuple(moved(M, D, share) for M, D in zip(Ms, Ds, strict=True)) if Ds else Ms
            for Ms, Ds in ((plant.B, B), (plant.C, C))
        ]
        yield replace(plant, A=moved(plant.A, A, share), B=ports[0], C=ports[1])


def _every(holds: Callable[[Facts], bool]) -> Callable[[Said, Case], bool]:
    def decides(_: Said, case: Case) -> bool:
        return all(holds(Facts(plant)) for plant in members(case.plant))

    return decides


def stabilizable(facts: Facts) -> bool:
    """Whether every mode that gains leave is stable."""
    return Region(facts.system.time).contains(facts.fixed_polynomial)


def nothing_fixed(facts: Facts) -> bool:
    """Whether gains leave no mode."""
    return facts.fixed_polynomial.degree() == 0


def controllable(facts: Facts) -> bool:
    """Whether all channels together control every mode."""
    return not facts.uncontrolled()


def observable(facts: Facts) -> bool:
    """Whether all channels together observe every mode."""
    return not facts.unobserved()


def holds_setpoints(facts: Facts) -> bool:
    """Whether a decentralized controller stabilizes the plant with integrators of its outputs."""
    made = Case(facts.system).made({"construction": "integrators"})
    full = facts.n + int(facts.system.outputs().nrows())
    return facts.steady_rank() == full and stabilizable(Facts(made))


judge("members-nothing-fixed")(_every(nothing_fixed))
judge("members-stabilizable")(_every(stabilizable))
judge("members-controllable")(_every(controllable))
judge("members-observable")(_every(observable))
judge("members-setpoints")(_every(holds_setpoints))


# Loops.


def loop_of(plant: System, document: Any, part: fmpq | None, share: Share) -> fmpq_mat:
    """The loop of a plant with a controller whose gains are moved by a part of their moduli."""
    agents = read_agents(plant, document)
    if part is not None:
        for agent in agents:
            for maps in agent.maps.values():
                for signal, M in maps.items():
                    maps[signal] = moved(M, scaled(M, part), share)
    return Loop(plant, agents).matrix()


def _loops(said: Said, case: Case, plants: Iterator[System]) -> bool:
    """Whether the loops of these plants, with moved gains if told, are in the region."""
    rng = random.Random(1)
    gains = said.values.get("gains")
    part = None if gains is None else number(Fraction(gains))
    for k, plant in enumerate(plants):
        share = shares(rng, k % 2 == 0)
        matrix = loop_of(plant, case.controller, part, share)
        if not said.values["region"].contains(matrix.charpoly()):
            return False
    return case.controller is not None


@judge("members-in-region")
def _in_region(said: Said, case: Case) -> bool:
    return case.plant.radii is not None and _loops(said, case, members(case.plant))


@judge("members-in-region-part")
def _in_region_part(said: Said, case: Case) -> bool:
    part = number(Fraction(said.values["part"]))
    return _loops(said, case, members(case.plant, part))


def at_samples(said: Said, case: Case, plants: Iterator[System]) -> bool:
    """Whether the loops of the exact samples of these plants are in the region."""
    how = case.asked.get("sampling")
    if how is None or case.controller is None:
        return False
    steps = sharpened([{"construction": "sampled", **how}])
    rng = random.Random(1)
    gains = said.values.get("gains")
    part = None if gains is None else number(Fraction(gains))
    for k, plant in enumerate(plants):
        held = built(replace(plant, radii=None), steps)
        matrix = loop_of(held, case.controller, part, shares(rng, k % 2 == 0))
        region = said.values.get("region", Region("discrete"))
        if not region.contains(matrix.charpoly()):
            return False
    return True


@judge("members-sampled-region")
def _sampled_region(said: Said, case: Case) -> bool:
    return case.plant.radii is not None and at_samples(said, case, members(case.plant))


@judge("members-sampled-region-part")
def _sampled_region_part(said: Said, case: Case) -> bool:
    part = number(Fraction(said.values["part"]))
    return at_samples(said, case, members(case.plant, part))


@judge("members-sampled-exactly", "first-exact")
def _sampled_exactly(said: Said, case: Case) -> bool:
    return at_samples(said, case, iter([case.plant]))


@judge("sampled-loop", "first-sampled")
def _sampled(said: Said, case: Case) -> bool:
    """The step, and what else is told of the way in which the plant is sampled."""
    how = case.asked.get("sampling")
    if how is None:
        return False
    told = {key: value for key, value in said.values.items() if key != "step"}
    same = all(how[key] == value for key, value in told.items())
    return same and Fraction(how["step"]) == Fraction(said.values["step"])


@judge("certify-failing-plant", "certify-failing-plant-radii")
def _failing(said: Said, case: Case) -> bool:
    """The loop of the plant that is known is not stable, and no entry is further off than told."""
    failing: System = case.asked["failing_plant"]
    own = case.plant
    part = number(Fraction(said.values["distance"]))
    within = own.radii if said.rule.endswith("radii") else None
    A, B, C = within or (
        scaled(own.A, fmpq(1)),
        [scaled(M, fmpq(1)) for M in own.B],
        [scaled(M, fmpq(1)) for M in own.C],
    )
    triples = zip(
        (own.A, *own.B, *own.C), (failing.A, *failing.B, *failing.C), (A, *B, *C), strict=True
    )
    near = all(
        abs(x - y) <= part * d
        for M, N, D in triples
        for x, y, d in zip(M.entries(), N.entries(), D.entries(), strict=True)
    )
    matrix = loop_of(failing, case.controller, None, lambda: fmpq(0))
    return near and not Region(own.time).contains(matrix.charpoly())


# Values within ranges.


def _ranged(case: Case, said: Said) -> Iterator[System]:
    """The plants at corners and at inner values of the ranges that the sentence names."""
    family = case.parametric
    if said.values["parameters"] != family.words():
        raise ValueError(f"ranges {said.values['parameters']}, not {family.words()}")
    return (family.at(point) for point in inner_points(family))


def _every_value(holds: Callable[[Facts], bool]) -> Callable[[Said, Case], bool]:
    def decides(said: Said, case: Case) -> bool:
        if said.values["parameters"] != case.parametric.words():
            return False
        return all(holds(Facts(plant)) for plant in _ranged(case, said))

    return decides


judge("parametric-ranges-nothing-fixed")(_every_value(nothing_fixed))
judge("parametric-ranges-stabilizable")(_every_value(stabilizable))
judge("parametric-ranges-controllable")(_every_value(controllable))
judge("parametric-ranges-observable")(_every_value(observable))


@judge("parametric-ranges-in-region")
def _ranges_in_region(said: Said, case: Case) -> bool:
    if said.values["parameters"] != case.parametric.words():
        return False
    return _loops(said, case, _ranged(case, said))
