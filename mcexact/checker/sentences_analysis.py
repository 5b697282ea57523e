"""What the certificates of an analysis imply: modes, structure, one channel, set-points."""

import json
from collections.abc import Callable

from .arithmetic import exponent
from .location import in_stability_region
from .reading import polynomial
from .sentence import DUAL, PLANT, SYSTEM, Holds, Premise, Role, either, remark, restate, rule
from .statement import PENCIL, channel_set, described, edge_set, polynomial_text
from .system import System

WANG_DAVISON = "S. H. Wang and E. J. Davison 1973"
FIXED_DYNAMIC = "evidence.shrunk_subspace_fixed_dynamic"
PENCIL_MODES = "evidence.shrunk_subspace_pencil, joint_controllability.controllable_hautus"
SPLIT = "component_assignment.component_assignment"
MOVED = "fixed_spectrum.multiplicity_at_most, spectrum_split.spectrum_split"
HAUTUS = "joint_controllability.controllable_hautus"
DAVISON = "setpoint.setpoint_rank; E. J. Davison 1976"

SIDES = ("controllable", "observable")

FIXED = Role(("fixed_spectrum",))
COMPLETE = Role(("completeness",))
BLOCKS = Role(("assignability",))
CONTROLLABLE, OBSERVABLE = Role(("controllability",)), Role(("controllability",), DUAL)
GAINS = Role(("single_channel_gains",))
SUBSYSTEM = Role(("complementary_subsystem",))
RANK, RANKS = Role(("pencil_rank",)), Role(("pencil_rank",), many=True)
SPECTRUM = Role(("closed_loop_spectrum",))
SETPOINT = Role(("setpoint",), PLANT)


def everywhere(found: Premise) -> bool:
    """Whether a certificate about a set of channels is about all of them."""
    return bool(found["channels"] == found.system.names)


def controls(found: Premise) -> bool:
    """Whether all channels together control the subject."""
    found.expect(everywhere(found), "not about all channels together")
    return bool(found["controllable"])


# What is given, and remarks: titles, what is not proved, and what was not decided.


def plain(known: list[Premise]) -> System:
    """The system that the sentences are about, which has no parameters."""
    meant: System = known[0].meant
    known[0].expect(isinstance(meant, System), "the plant has parameters")
    return meant


@rule("heading page-heading information")
def _given(known: list[Premise]) -> str:
    """The sizes of what the manifest is about, and the names of its channels."""
    plant = plain(known)
    p, q = sum(M.ncols for M in plant.B), sum(M.nrows for M in plant.C)
    ports = f"{p} inputs and {q} outputs in all"
    return f"For {described(plant)}: {ports}"


remark("subsystem channel picture-graphs picture-graphs-outputs picture-dimensions certify-loop")
remark("design-measured")
remark("table-links-limit least-outputs-states-limit least-states-limit")
remark("controllability-indices-left-out observability-indices-left-out")


@rule("inactive-channels")
def _inactive(known: list[Premise]) -> str:
    """The channels that no edge of the transfer graph can touch."""
    seen = [premise for premise in known if premise.kind == "transfer_graph"]
    system = seen[0].system if seen else plain(known)
    ports = enumerate(zip(system.B, system.C, strict=True))
    idle = [system.names[i] for i, (B, C) in ports if B.is_zero() or C.is_zero()]
    known[0].expect(bool(idle), "no channel is without inputs or outputs that act")
    return f"For {system.words}: B_i = 0 or C_i = 0 for the channels {channel_set(idle)}"


@rule("picture-neighbor-graph picture-heard")
def _neighbors(known: list[Premise]) -> str:
    """Who receives messages from whom."""
    plant = plain(known)
    known[0].expect(plant.neighbors is not None, "the plant has no neighbor graph")
    sets, names = enumerate(plant.neighbors or []), plant.names
    told = edge_set((names[j], names[i]) for i, N_i in sets for j in N_i if i != j)
    return f"For {plant.words}: its neighbor graph has the edges {told}"


# Fixed modes.


def followed(words: str) -> Callable[[Premise], str]:
    """The words for a claim, and for what follows from it."""
    return lambda premise: f"{premise.statement}; {words}"


def free(found: Premise) -> bool:
    """Whether no mode is fixed."""
    return not found["factors"]


ANY_RATE = followed("every decay rate is reached by linear time-invariant control")
restate("nothing-fixed", FIXED, free, "fixed_spectrum.absence_all")
restate("any-rate", FIXED, free, WANG_DAVISON, ANY_RATE)
restate("stabilizable table-stabilizable", FIXED, lambda c: c["stabilizable"], WANG_DAVISON)
NEVER = "not-stabilizable table-not-stabilizable"
restate(NEVER, FIXED, lambda c: not c["stabilizable"], FIXED_DYNAMIC)
LISTED = "fixed slowest fixed-modes-row fixed-modes-note latex-fixed-mode picture-obstruction"
either("fixed-none latex-nothing-fixed", LISTED, FIXED, free)
restate("fixed-modes", FIXED, lambda c: c["factors"], FIXED_DYNAMIC)


def _blame(key: str, told: str, wanted: Callable[[int, int], bool]) -> None:
    """Enter the rule about the fixed modes whose sets have a wanted size, among m channels."""

    @rule(key, FIXED, theorem=PENCIL_MODES)
    def _say(found: Premise) -> str:
        texts, names = [], found.system.names
        for factor in found.cited("claim", "factors"):
            s, modes = factor["channels"], polynomial_text(factor["polynomial"])
            if wanted(len(s), len(names)):
                sets = channel_set(name for name in names if name not in s), channel_set(s)
                texts.append(f"the roots of {modes} are fixed, {told.format(*sets)}")
        found.expect(bool(texts), "the claim is different")
        return f"{found.about}: {'; '.join(texts)}"


_blame("fixed-mode", "not controlled by {} and not observed by {}", lambda size, m: 0 < size < m)
_blame("fixed-mode-uncontrolled", "not controlled by all of {}", lambda size, m: size == 0)
_blame("fixed-mode-unobserved", "not observed by all of {1}", lambda size, m: size == m)


# How the spectrum can be assigned.

ANY_CHANNEL = followed("channel controllers in any one channel assign the whole spectrum")
COROLLARY = "corollary_1.free_assignment"
restate("free-through-any-channel", COMPLETE, lambda c: c["complete"], COROLLARY, ANY_CHANNEL)


@rule("free spectrum-free", FIXED, BLOCKS, theorem=SPLIT)
def _free(spectrum: Premise, split: Premise) -> str:
    """Nothing is fixed, and there is one part at most."""
    spectrum.expect(not spectrum["factors"], "a mode is fixed")
    split.expect(sum(b["dimension"] > 0 for b in split["blocks"]) <= 1, "the spectrum splits")
    return f"{split.about}: linear time-invariant channel controllers assign the whole spectrum"


@rule("parts spectrum-parts", FIXED, BLOCKS, theorem=SPLIT)
def _parts(spectrum: Premise, split: Premise) -> str:
    """Nothing is fixed, and strong components have parts of their own."""
    spectrum.expect(not spectrum["factors"], "a mode is fixed")
    blocks = [(b["dimension"], channel_set(b["channels"])) for b in split["blocks"]]
    told = ", ".join(f"degree {size} by {names}" for size, names in blocks if size)
    return f"{split.about}: the spectrum is assigned in parts: {told}"


def moved(spectrum: Premise, split: Premise) -> tuple[int, int]:
    """Between which numbers of eigenvalues gains move, by the degree of what divides every loop.

    That is a multiple of every factor and of what belongs to no strong component, and divides the
    product of the p^a, as the rest of det(xI - A) is coprime to the loop of the certificate.  The
    loop's exponent is of p as a whole, and limits that of a root only where p has a single one.
    """
    sizes, n = [], spectrum.system.n
    for factor in spectrum["factors"]:
        degree, times = len(factor["polynomial"]) - 1, factor["multiplicity_in_A"]
        if degree == 1:
            at_most = factor["multiplicity_at_most"]
            times = at_most if times is None else min(times, at_most)
        spectrum.expect(times is not None, "a multiplicity in A is left open")
        sizes.append(degree * times)
    return n - sum(sizes), n - max(len(spectrum["polynomial"]) - 1, split["fixed_degree"])


@rule("spectrum-moved-between", FIXED, BLOCKS, theorem=MOVED)
def moved_between(spectrum: Premise, split: Premise) -> str:
    """Bounds on how many eigenvalues gains move."""
    least, most = moved(spectrum, split)
    return f"{split.about}: gains move from {least} to {most} of the {split.system.n} eigenvalues"


@rule("spectrum-moved", FIXED, BLOCKS, theorem=MOVED)
def _moved_exactly(spectrum: Premise, split: Premise) -> str:
    """How many eigenvalues gains move, where the bounds meet."""
    least, most = moved(spectrum, split)
    spectrum.expect(least == most, f"only known to be from {least} to {most}")
    return moved_between(spectrum, split)


# Structure, a set of channels, one channel.


def alone(found: Premise) -> bool:
    """Whether a certificate about a set of channels is about one."""
    return len(found["channels"]) == 1


either("controllable", "uncontrollable", CONTROLLABLE, controls)
either("observable", "unobservable", OBSERVABLE, controls)
GRAPH, CUT = Role(("transfer_graph",)), "transfer-graph-parts"
either("transfer-graph-connected", CUT, GRAPH, lambda c: c["strongly_connected"])
restate("picture-transfer-graph", GRAPH, lambda c: True)
restate("complete", COMPLETE, lambda c: True)
for side, path in (("controllability", SYSTEM), ("observability", DUAL)):
    INDICES, ALONE = Role(("controllability_indices",), path), Role(("controllability",), path)
    restate(f"{side}-index", INDICES, lambda c: everywhere(c) and c["index"] is not None)
    restate(f"{side}-indices", INDICES, lambda c: everywhere(c) and c["index"] is None)
    restate(f"channel-{side}", ALONE, lambda c: alone(c) and c["controllable"])
    restate(f"channel-no-{side}", ALONE, lambda c: alone(c) and not c["controllable"])

restate("pencil-row", RANK, lambda c: True)
restate("subsystem-normal-rank subsystem-remnant", SUBSYSTEM, lambda c: True)
either("subsystem-zeros", "subsystem-no-zeros", SUBSYSTEM, lambda c: c["invariant_polynomials"])


def completeness(found: Premise) -> tuple[bool, bool]:
    """Whether the transfer matrix is zero, and whether the rank drops below n anywhere."""
    return found["transfer_zero"], len(found["remnant"]) > 1


restate("subsystem-complete", SUBSYSTEM, lambda c: completeness(c) == (False, False))
restate("subsystem-zero", SUBSYSTEM, lambda c: completeness(c) == (True, False))
restate("subsystem-drops", SUBSYSTEM, lambda c: completeness(c) == (False, True))
restate("subsystem-zero-and-drops", SUBSYSTEM, lambda c: completeness(c) == (True, True))


@rule("pencil", SPECTRUM, RANKS, theorem="closed_loop_spectrum.closed_loop_spectrum")
def _pencil(spectrum: Premise, ranks: list[Premise]) -> str:
    """The rank of one pencil at every root of the polynomial of A."""
    left, listed = polynomial(spectrum["polynomial"], spectrum.file), ranks[0]["subset"]
    for found in ranks:
        found.expect(found["subset"] == listed, "about another set of channels")
        left = exponent(polynomial(found["polynomial"], found.file, 1), left)[1]
    spectrum.expect(len(left) == 1, f"no rank is claimed at the roots of {polynomial_text(left)}")
    least, s = min(found["rank"] for found in ranks), channel_set(listed)
    which = f"the pencil {PENCIL}, C the outputs of the channels {s} and B the inputs of the others"
    return f"{spectrum.about}: {which}, has rank {least} or more at every mode of A"


def gains(key: str, wanted: str, about: Callable[[Premise], bool]) -> None:
    """Enter the rules about gains for one channel, or for every channel."""

    def asked(found: Premise) -> bool:
        right = about(found) and found["property"] == wanted
        found.expect(right, "another question was asked")
        return bool(found["exists"])

    def lost(part: str, *sides: str) -> Holds:
        return lambda c: not asked(c) and part in c.witness and c.witness["side"] in sides

    def reason(found: Premise) -> str:
        p, q, side = (found.witness.get(part) for part in ("polynomial", "channel", "side"))
        why = f"the roots of {polynomial_text(p)} stay out of reach" if p else "it cannot spread"
        return f"{found.statement}: not {side} through {json.dumps(q)}, for {why}"

    restate(f"{key}-gains", GAINS, asked)
    restate(f"{key}-stuck", GAINS, lost("polynomial", *SIDES), words=reason)
    for side in SIDES if wanted == "both" else (wanted,):
        no_cut = "single_channel_gains.single_channel_no_cut"
        restate(f"{key}-unreached-{side}", GAINS, lost("zero", side), no_cut, reason)


for each in (*SIDES, "both"):
    gains(f"channel-{each}", each, alone)
gains("every-channel", "both", everywhere)


# Set-points.

HELD = "linear time-invariant centralized control holds all outputs at any constant set-points"


def unreached(c: Premise, o: Premise) -> list[str]:
    """The uncontrollable and the unobservable polynomials that are not stable."""
    lost = [polynomial(p["uncontrollable_polynomial"], p.file) for p in (c, o)]
    c.expect(everywhere(c) and everywhere(o), "not about all channels together")
    return [polynomial_text(p) for p in lost if not in_stability_region(p, c.system.time)]


@rule("setpoint", SETPOINT, CONTROLLABLE, OBSERVABLE, theorem=DAVISON)
def _setpoint(found: Premise, c: Premise, o: Premise, *_: Premise) -> str:
    """Integrators behind all outputs, and everything within reach."""
    found.expect(found["solvable"], "the rank of [A, B; C, 0] is not full")
    c.expect(controls(c) and controls(o), "not jointly controllable and observable")
    return f"{found.about}: {HELD}"


@rule("setpoint-stable-rest", SETPOINT, CONTROLLABLE, OBSERVABLE, FIXED, theorem=DAVISON)
def _setpoint_beside(found: Premise, c: Premise, o: Premise, _: Premise) -> str:
    """Integrators behind all outputs, and what is out of reach is stable."""
    found.expect(found["solvable"], "the rank of [A, B; C, 0] is not full")
    c.expect(not unreached(c, o), "what is out of reach is not stable")
    return f"{found.about}: {HELD}; every mode out of its reach is stable"


@rule("setpoint-unstable-rest", SETPOINT, CONTROLLABLE, OBSERVABLE, FIXED, theorem=HAUTUS)
def _setpoint_lost(found: Premise, c: Premise, o: Premise, _: Premise) -> str:
    """No loop is stable: a mode out of reach is not."""
    c.expect(bool(unreached(c, o)), "what is out of reach is stable")
    lost = f"out of reach are roots of {' and of '.join(unreached(c, o))}"
    return f"{found.about}: no linear time-invariant loop is stable: {lost}"


RANK_RULE = "setpoint.setpoint_rank"
restate("setpoint-zero", SETPOINT, lambda c: c["invariant_zero"] is True, RANK_RULE)
restate("setpoint-dependent", SETPOINT, lambda c: c["invariant_zero"] is False, RANK_RULE)
