"""Rules of sentences about loops and boxes.

- Certified loops (``design``, ``certify``): where their eigenvalues lie, how many states the
  controller has, which modes stay fixed, and that outputs tend to their set-points.  The controller
  is a part of the subject, so that `controller` reads its programs from a certificate.
- Plants near the plant of a loop whose own loop is not stable (`fails_near`).
- Refusals (``refused-…``): the uncontrollable or unobservable modes, fixed modes, or set-points
  without an equilibrium that make a request impossible.
- Boxes and ranges of parameters (`of_plants`): sentences about all members.
"""

import json
from fractions import Fraction

from .boxes import gain_pairs
from .cells import constructed
from .constructions import read_subject
from .controllers import MAPS
from .core import budget
from .core.reading import Json, polynomial
from .core.roots import in_stability_region
from .core.system import System, counted, polynomial_text, quoted, read_matrix, read_radii
from .discs import Pair, pairs_of
from .internal_model import Row, Rows, largest_model
from .kinds import same
from .sentences import (
    ANOTHER_STEP,
    AT_SAMPLES,
    DUAL,
    FIXED_DYNAMIC,
    HAUTUS,
    NO_SHARING,
    OVER_LINKS,
    WANG_DAVISON,
    Holds,
    Path,
    Premise,
    Role,
    controls,
    demands,
    either,
    everywhere,
    followed,
    restate,
    rule,
    stays_shared,
)
from .sentences_nearby import differences, farthest

# What the certificates of a design, of a verdict on a controller and of a refusal imply.

UNCONTROLLABLE = "controllability.uncontrollable_modes"


MODELS = ("integrators", "servo", "internal_model")


def behind(*paths: Path) -> tuple[Path, ...]:
    """These ways to make a subject, from the plant or from the plant with integrators or models."""
    return (*paths, *((first, *path) for first in MODELS for path in paths))


CLOSED: tuple[Path, ...] = (("closed_loop",),)
LOOP = Role(("closed_loop_spectrum", "stability", "distributed_observer"), CLOSED)
STABLE, OBSERVER = Role(("stability",), CLOSED), Role(("distributed_observer",), CLOSED)
NETWORKS: tuple[Path, ...] = (("extended",), ("lifted",), ("held",))
KEPT = Role(("fixed_spectrum",), behind((), *NETWORKS))
DIMENSIONS = Role(("shared_dimensions",), behind(()))
EQUILIBRIUM = Role(("setpoint",), ((), ("regulated",)))


# The controller of a loop, which is a part of the subject.


def controller(known: list[Premise]) -> tuple[Premise, list[Json]]:
    """The programs of the agents, out of a certificate about their loop."""
    loops = [
        premise
        for premise in known
        if premise.path and premise.path[-1] == "closed_loop" and premise.path != AT_SAMPLES
        if premise.path[0] != ANOTHER_STEP
    ]
    known[0].expect(bool(loops), "no certificate about such a closed loop is VALID")
    return loops[0], loops[0].document["subject"][-1]["controller"]["agents"]


def controlled(loop: Premise) -> System:
    """The system in the loop: the plant, or what was made from it."""
    return read_subject(loop.document["subject"][:-1], loop.plant)


@rule(
    "design-carrier design-carrier-for design-order design-order-integrators design-order-models "
    "design-shared"
)
def _sizes(known: list[Premise]) -> str:
    """How many states each agent has, shared and of its own."""
    loop, agents = controller(known)
    order = sum(agent["shared"] + agent["private"] for agent in agents)
    sizes = ((json.dumps(agent["name"]), agent["shared"], agent["private"]) for agent in agents)
    listed = "; ".join(f"{name}: {x} shared, {z} private" for name, x, z in sizes)
    return f"{loop.about}: the controller has {counted(order, 'state')} ({listed})"


@rule("design-observer-order")
def _observer_order(known: list[Premise]) -> str:
    """The order of the paper's observer for what the controller controls, n m + m − 1."""
    loop, _ = controller(known)
    system = constructed(loop.document["subject"][:-1], loop.plant)
    order = system.n * system.m + system.m - 1
    return (
        f"For {system.words}: the observer of Liu, Wang, Fullmer and Morse has "
        f"{counted(order, 'state')}"
    )


@rule("design-longest-number")
def _longest(known: list[Premise]) -> str:
    """The bits of the longest numerator or denominator in the controller."""
    loop, agents = controller(known)
    bits = [0]
    for program in (agent[label] for agent in agents for label in MAPS):
        numbers = [x for rows in signals(program).values() for row in rows for x in row]
        bits += [number.bit_length() for x in numbers for number in x.as_integer_ratio()]
    size = counted(max(bits), "bit")
    return f"{loop.about}: the longest numerator or denominator in the controller has {size}"


def signals(program: Json) -> dict[tuple[str, str], list[list[Fraction]]]:
    """The rows of each matrix of a program, by the signal that it multiplies."""
    parts = {(key, ""): program[key] for key in ("private", "reference") if key in program}
    for key in ("outputs", "shared"):
        parts |= {(key, name): entries for name, entries in program.get(key, {}).items()}
    return {signal: entries(value) for signal, value in parts.items()}


def entries(value: Json) -> list[list[Fraction]]:
    """The rows of a matrix of a controller."""
    M = read_matrix(value, "controller", None, None)
    return [[Fraction(entry, M.denominator) for entry in row] for row in M.rows]


@rule("certify-states")
def _states(known: list[Premise]) -> str:
    """The number of states of the loop."""
    loop, _ = controller(known)
    return f"{loop.about}: the loop has {counted(loop.system.n, 'state')}"


@rule("certify-decided certify-decided-blocks")
def _decided(known: list[Premise]) -> str:
    """By which evidence it is decided where the eigenvalues of the loop lie."""
    loop, _ = controller([premise for premise in known if STABLE.fits(premise, False)] or known)
    loop.expect(loop.kind == "stability", "expected a certificate of the kind stability")
    blocks = [str(block["size"]) for block in loop.witness.get("blocks", [])]
    sizes = f", blocks of {', '.join(blocks)} states" if blocks else ""
    return f"{loop.statement}, by the method {loop.witness['method']}{sizes}"


# The loop.


def _is_stable(loop: Premise) -> bool:
    """Whether every eigenvalue of the loop is where it decays."""
    if loop.kind == "stability":
        return bool(loop["stable"])
    keys = ("polynomial",) if loop.kind == "closed_loop_spectrum" else ("feedback", "error")
    polynomials = [polynomial(loop[key], loop.file) for key in keys]
    return all(in_stability_region(p, loop.system.time) for p in polynomials)


def decays(loop: Premise) -> str:
    """The claim about the loop, followed by the words that the loop is stable."""
    stable = "modulus below 1" if loop.system.time == "discrete" else "negative real part"
    return f"{loop.statement}; every eigenvalue has {stable}"


CERTIFIED = "design-observer design-observer-float design-network design-setpoint design-tracking"
restate(CERTIFIED, LOOP, _is_stable, words=decays)
BOUNDED = Role(("stability", "distributed_observer"), CLOSED)
restate("design-region", BOUNDED, lambda c: _is_stable(c) and c["bound"] is not None)
restate("design-feedback design-errors", OBSERVER, lambda c: True)
restate("design-assigned", LOOP, lambda c: True)
either("certify-inside", "certify-outside refused-outside", STABLE, lambda c: c["stable"])


def bounded(loop: Premise, time: str) -> bool:
    """Whether the loop was certified with a rate or a radius, in the right time domain."""
    return bool(loop["stable"] and loop["bound"] is not None and loop.system.time == time)


restate("certify-largest", STABLE, lambda c: bounded(c, "continuous"))
restate("certify-least", STABLE, lambda c: bounded(c, "discrete"))


@rule("design-kept", LOOP, KEPT)
def _kept(_: Premise, spectrum: Premise) -> str:
    """The fixed modes, which every controller leaves where they are."""
    spectrum.expect(bool(spectrum["factors"]), "no mode is fixed")
    return spectrum.statement


@rule("design-steady-state", LOOP, theorem="B. A. Francis and W. M. Wonham 1976")
def _steady_state(loop: Premise) -> str:
    """The loop is stable, and agents integrate the difference of output and set-point.

    Then all states tend to an equilibrium where nothing that enters varies: a set-point of any
    other agent, too.
    """
    system, found = _models(loop)
    for i, models in enumerate(found):
        held = [row for row, p in models if _has_constants(p, system)]
        good = all(unit in held for unit in _units(system.C[i].nrows))
        loop.expect(good, f"agent number {i + 1} does not integrate its outputs less set-points")
    return f"{loop.about}: every output tends to its set-point if {CONSTANT}"


@rule("design-steady-regulated", LOOP, theorem="B. A. Francis and W. M. Wonham 1976")
def _steady_regulated(loop: Premise) -> str:
    """The loop is stable, and agents integrate combinations of output less set-point.

    As for all outputs, these then tend to those of the set-points.
    """
    system, found = _models(loop)
    held = []
    for i, models in enumerate(found):
        rows = [_combination(row) for row, p in models if _has_constants(p, system)]
        held += [f"{quoted(system.names[i])}: {', '.join(rows)}"] if rows else []
    loop.expect(bool(held), "no agent integrates outputs less set-points")
    which = f"these combinations of the outputs of agents, {'; '.join(held)}"
    return f"{loop.about}: {which}, tend to those of the set-points if {CONSTANT}"


@rule("design-steady-signals", LOOP, theorem="B. A. Francis and W. M. Wonham 1976")
def _steady_signals(loop: Premise) -> str:
    """The loop is stable, and agents have models of signals behind output less reference.

    With all that enters a solution of p the loop has one trajectory of solutions of p; in it what
    drives a model of p is 0 (``proofs/internal_model.md``).
    """
    system, found = _models(loop)
    follow = []
    for i, models in enumerate(found):
        rows = [f"{_combination(row)} for {polynomial_text(p)}" for row, p in models]
        follow += [f"{quoted(system.names[i])}: {', '.join(rows)}"] if rows else []
    loop.expect(bool(follow), "the agents have no models of signals")
    return (
        f"{loop.about}: these combinations of the outputs of agents differ from those of the "
        "references by what tends to 0 if every reference, and every disturbance of the plant, is "
        f"a solution of the polynomial beside the combination, {'; '.join(follow)}"
    )


CONSTANT = "every set-point, and every disturbance of the plant, is constant"


def _has_constants(p: Row, system: System) -> bool:
    """Whether constants are solutions of p."""
    return (sum(p) if system.time == "discrete" else p[0]) == 0


def _combination(row: Row) -> str:
    """A combination of outputs."""
    return f"({', '.join(map(str, row))})"


def _units(q: int) -> Rows:
    """The single outputs."""
    return [[Fraction(int(a == b)) for b in range(q)] for a in range(q)]


def _models(loop: Premise) -> tuple[System, list[list[tuple[Row, Row]]]]:
    """The system in a stable loop, and what `models_of` says of each agent."""
    loop.expect(_is_stable(loop), "the loop is not stable")
    _, agents = controller([loop])
    system = controlled(loop)
    return system, [models_of(system, i, agent) for i, agent in enumerate(agents)]


def models_of(system: System, i: int, agent: Json) -> list[tuple[Row, Row]]:
    """The s and p, p of degree ≥ 1, such that agent i has a model of p behind s.

    The s are single outputs, and combinations that enter a private state less those of references.
    """
    update, k, q = signals(agent["private_update"]), agent["private"], system.C[i].nrows
    own = update.pop(("outputs", system.names[i]), [[Fraction(0)] * q] * k)
    reference = update.pop(("reference", ""), [[Fraction(0)] * q] * k)
    inner = update.pop(("private", ""), [[Fraction(0)] * k] * k)
    others = [[x for M in update.values() for x in M[z]] for z in range(k)]
    combinations = {tuple(s): s for s in _units(q)}
    for y, r in zip(own, reference, strict=True):
        if sum(map(bool, y)) > 1 and r == [-x for x in y]:
            combinations[tuple(y)] = y
    found = ((s, largest_model(inner, own, reference, others, s)) for s in combinations.values())
    return [(s, p) for s, p in found if len(p) > 1]


# The loop of a periodic decentralized controller over one period.

PERIODIC = Role(("stability",), (("periodic_loop",),))
ANY_STEP = "periodic.any_step"


def periodic(key: str, holds: Holds, what: str) -> None:
    """Enter a rule about the loop of a periodic controller, in words with its number of steps."""

    @rule(key, PERIODIC, theorem=ANY_STEP)
    def _say(loop: Premise) -> str:
        loop.expect(bool(holds(loop)), "the claim is different")
        steps = counted(len(loop.document["subject"][-1]["phases"]), "step")
        return f"{loop.statement}; {what.format(steps)}"


periodic(
    "periodic-stabilizes",
    lambda c: c["stable"],
    "of the steps of the loop the matrices repeat after {}, so that from every start in every step "
    "its state tends to 0",
)
periodic(
    "periodic-unstable",
    lambda c: not c["stable"] and c["bound"] is None,
    "of the steps of the loop the matrices repeat after {}, so that from some start its state does "
    "not tend to 0",
)
periodic(
    "periodic-radius",
    lambda c: c["stable"] and c["bound"] is not None,
    "that is the modulus over {}",
)
periodic(
    "periodic-slow",
    lambda c: not c["stable"] and c["bound"] is not None,
    "that is the modulus over {}",
)


@rule("periodic-states periodic-order", PERIODIC)
def _periodic_sizes(loop: Premise) -> str:
    """The numbers of states of the loop, and of the controller."""
    own = loop.system.n - read_subject(loop.document["subject"][:-1], loop.plant).n
    states = counted(loop.system.n, "state")
    return f"{loop.about}: the loop has {states}, and the controller {counted(own, 'state')}"


# A plant nearby whose loop fails.

FAILS = Role(("stability",), CLOSED, nearby=True)


def fails_near(key: str, unit: str, *, of_radii: bool) -> None:
    """Enter the rule about a plant nearby whose loop is not stable."""

    @rule(key, FAILS, LOOP)
    def _say(near: Premise, loop: Premise) -> str:
        near.expect(not near["stable"], "the loop is stable")
        near.expect(set(near.document["claim"]) == {"bound", "stable"}, "limits are claimed, too")
        near.expect(near["bound"] is None, "a bound is claimed")
        near.expect(same(near.document["subject"], loop.document["subject"]), "another loop")
        own, units = loop.plant, None
        if of_radii and isinstance(own, System):
            units = read_radii(own.uncertainty, own.names, [own.A, *own.B, *own.C])
        shifts = differences(near, loop, units)
        fits = all(unit for moved, unit in shifts if moved)
        near.expect(fits, "an entry without a radius is moved")
        far = farthest(shifts)
        whose = f"each entry of its plant differs from that of {loop.plant.words}"
        return f"{near.statement}; {whose} by at most {far} of the {unit} of the latter"


fails_near("certify-failing-plant", "absolute value", of_radii=False)
fails_near("certify-failing-plant-radii", "radius", of_radii=True)


# Refusals.


def lost(keys: str, *paths: Path) -> None:
    """Enter the rule about modes that all channels together do not control, or observe."""
    restate(keys, Role(("controllability",), paths), lambda c: not controls(c), UNCONTROLLABLE)


lost("refused-not-controllable refused-not-controllable-in refused-uncontrollable", *behind(()))
lost("refused-unobservable refused-not-observable", *behind(("dual",)))
lost("refused-integrators-control", ("integrators",), ("servo",))
lost("refused-integrators-observe", ("integrators", "dual"), ("servo", "dual"))
lost("refused-models-control", ("internal_model",))
lost("refused-models-observe", ("internal_model", "dual"))
ERRORS, CONVERSE = behind(("error",)), "free_assignment.corfmat_morse_converse"
INCOMPLETE = Role(("completeness",), ERRORS)
restate("refused-errors-not-complete", INCOMPLETE, lambda c: not c["complete"], CONVERSE)


def stuck(key: str, *paths: Path, holds: Holds = lambda c: True) -> None:
    """Enter the rule about fixed modes."""
    role = Role(("fixed_spectrum",), paths)
    restate(key, role, lambda c: c["factors"] and holds(c), FIXED_DYNAMIC)


def _shares_all(spectrum: Premise) -> bool:
    """Whether every agent shares as many states as the system has that is extended."""
    sizes = spectrum.document["subject"][-1]["dimensions"]
    return all(size >= spectrum.system.n - sum(sizes) for size in sizes)


stuck("refused-fixed", *behind(()))
stuck("refused-fixed-shared", *behind(*NETWORKS))
stuck("refused-errors-fixed", *ERRORS)
SHARED_INTEGRATORS = (("integrators", "extended"), ("servo", "extended"))
stuck("refused-integrators-fixed", *SHARED_INTEGRATORS, holds=_shares_all)
stuck("refused-models-alone", ("internal_model",))
stuck("refused-models-fixed", ("internal_model", "extended"), holds=_shares_all)


@rule("refused-over-links", Role(("fixed_spectrum",), behind(OVER_LINKS)), theorem=NO_SHARING)
def _refused_over_links(stays: Premise) -> str:
    """Modes that stay however much is shared."""
    return stays_shared(stays)


@rule("refused-no-connection", DIMENSIONS, theorem="transfer_graph.zero_transfer_cut")
def _refused_no_connection(least: Premise) -> str:
    """Agents that lack shared states and receive from no other agent."""
    least.expect(not least["feasible"], "some dimensions suffice")
    return demands(least, "cut off", alone=True)


def conditions(premise: Premise) -> list[str]:
    """The conditions on r = C x of an equilibrium, out of the left kernel of [A, B; C, 0]."""
    left, n = premise.witness["left"], premise.system.n
    rows = [[Fraction(x, left["denominator"]) for x in row[n:]] for row in left["entries"]]
    return [f"({', '.join(map(str, row))}) r != 0" for row in rows if any(row)]


@rule("refused-no-equilibrium", EQUILIBRIUM, theorem="setpoint.setpoint_unreachable")
def no_equilibrium(premise: Premise) -> str:
    """Some set-points have no equilibrium."""
    lost = conditions(premise)
    premise.expect(bool(lost), "no set-points are excluded")
    return f"{premise.about}: no equilibrium holds outputs r with {' or '.join(lost)}"


@rule("refused-no-equilibrium-zero", EQUILIBRIUM, theorem="setpoint.setpoint_unreachable")
def _no_equilibrium_zero(premise: Premise) -> str:
    """Some set-points have no equilibrium, because of an invariant zero."""
    premise.expect(premise["invariant_zero"] is True, "the defect is no invariant zero")
    return (
        f"{no_equilibrium(premise)}; {int(premise.system.time == 'discrete')} is an invariant zero"
    )


@rule("refused-mode-of-the-integrators", EQUILIBRIUM, theorem="setpoint.setpoint_output_part")
def _mode_of_the_integrators(premise: Premise) -> str:
    """A mode of the plant at the place of the integrators is not controlled."""
    lost = not premise["solvable"] and not conditions(premise)
    premise.expect(lost, "every row of the evidence is about the outputs, or there is none")
    place = int(premise.system.time == "discrete")
    return f"{premise.about}: the mode {place} is not controlled by all channels together"


# What certificates about boxes imply: sentences about all members, or values in ranges.


def all_modes(premise: Premise) -> bool:
    """Whether all channels act on every mode."""
    premise.expect(everywhere(premise), "not about all channels together")
    return premise["bound"] is None


NOTHING = "boxes.regular_not_fixed"
OWN = "is stabilized by some decentralized controller of its own"


def of_plants(stem: str, kinds: str, each: str) -> None:
    """Enter four rules about all plants within radii or ranges, and what follows of each."""
    modes, control = Role((f"{kinds}_fixed",)), f"{kinds}_controllable"
    restate(f"{stem}-nothing-fixed", modes, lambda c: c["bound"] is None, NOTHING)
    restate(f"{stem}-stabilizable", modes, lambda c: True, WANG_DAVISON, followed(each))
    restate(f"{stem}-controllable", Role((control,)), all_modes, HAUTUS)
    restate(f"{stem}-observable", Role((control,), DUAL), all_modes, HAUTUS)


of_plants("members", "box", f"each of them {OWN}")
of_plants("parametric-ranges", "parametric_box", f"each of these plants {OWN}")
HOLDS = "some decentralized controller of its own holds all outputs at any constant set-points"
restate(
    "members-setpoints",
    Role(("box_fixed",), (("integrators",),)),
    lambda c: True,
    f"{WANG_DAVISON}; E. J. Davison 1976",
    followed(f"so for each plant {HOLDS}"),
)


LOOPS = Role(("box_stable",), CLOSED)


def least(pairs: list[Pair]) -> Fraction:
    """The largest number such that every radius is at least so many times the absolute value."""
    longest = budget.limbs_of([number for pair in pairs for number in pair])
    budget.spend(budget.fractions(len(pairs), longest))
    return min((radius / value for radius, value in pairs if value), default=Fraction(0))


def within(loops: Premise) -> str:
    """The claim, and changes of entries that it allows, whatever the radii are."""
    plant, radii = loops.plant, loops["gain_radii"]
    nominal = [plant.A, *plant.B, *plant.C]
    spread = read_radii(plant.uncertainty, plant.names, nominal)
    part = f"by more than {least(pairs_of(nominal, spread))} of its modulus"
    changes = f"no entry of the plant changes {part}"
    pairs = [] if radii is None else gain_pairs(loops.document["subject"][-1]["controller"], radii)
    if any(value for _, value in pairs):
        changes += f", and none of the controller by more than {least(pairs)} of its modulus"
    return f"{loops.statement}; it holds if {changes}"


restate("members-in-region", LOOPS, lambda c: True)
restate("members-in-region-part", LOOPS, lambda c: True, words=within)


def sampled(premise: Premise) -> bool:
    """Whether the plant was sampled, before all other constructions."""
    return bool(premise.document["subject"][0]["construction"] == "sampled")


def alone(loops: Premise) -> bool:
    """Whether the plant is sampled, and has no radii: the box is about its exact samples alone."""
    return sampled(loops) and loops.plant.uncertainty is None


restate("sampled-loop first-sampled", LOOP, sampled)
restate("members-sampled-region", LOOPS, sampled)
restate("members-sampled-region-part", LOOPS, sampled, words=within)
restate("members-sampled-exactly", LOOPS, alone)


def of_disk(key: str, at: str) -> None:
    """Enter the rules about the disk margin of single inputs or outputs for all members."""

    def holds(loops: Premise) -> bool:
        claim = loops.document["claim"]
        return "disk" in claim and claim["disk"]["at"] == at

    restate(key, LOOPS, holds)
    restate(f"{key}-part", LOOPS, holds, words=within)


of_disk("members-input-margin", "inputs")
of_disk("members-output-margin", "outputs")
restate("parametric-ranges-in-region", Role(("parametric_box_stable",), CLOSED), lambda c: True)
