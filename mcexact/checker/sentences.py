"""Rules of sentences: premises, analysis and sharing.

A manifest lists the sentences that a command printed, each with the key of a rule and pointers into
the certificates that it was read from.  The checker never parses such a sentence.  It applies its
own rule of the same key (`RULES`) to the VALID certificates (`Premise`) and prints what they imply,
in its own words; whether the two texts agree is for the reader to see.

A `Rule` has a `Role` for each premise: a kind of certificate, and the constructions that lead from
the system of the manifest to its subject.  Its function takes the premises in the order of the
roles, stops unless the claims imply the sentence, and returns the statement.  Most sentences say
what one certificate claims, and have a rule by `restate` or `either`.  A rule that draws a
conclusion names its theorem: of ``proofs/`` or of the literature.

This module has the rules about an analysis and about sharing; `sentences_nearby` has those about
other plants of which an answer is another one, `sentences_loops` those about
loops and boxes, `sentences_performance` those about costs and margins of loops,
`sentences_parameters` those about all values of parameters.
"""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

from .constructions import FAILURES, SHARED, read_subject
from .core.arithmetic import exponent
from .core.budget import spend
from .core.evidence import require_coprime
from .core.reading import polynomial, require
from .core.roots import in_stability_region
from .core.system import PENCIL, System, channel_set, counted, described, edge_set, polynomial_text
from .kinds import same
from .modes import no_fixed_mode

# Rules for sentences: premises, the roles that premises play, and the table of rules.

Path = tuple[str, ...]
"""The names of the constructions that lead from the manifest's system to a subject."""

SYSTEM: tuple[Path, ...] = ((), ("augmented_outputs",))
"""What agents receive: their own outputs, or also those of their neighbors."""
DUAL = tuple((*path, "dual") for path in SYSTEM)
FAILED = tuple(("failed", *path) for path in SYSTEM)
"""The system as it is made of the plant after failures."""
PLANT, HEARD = SYSTEM[:1], SYSTEM[1:]
ANOTHER_STEP = "another step"
"""Where a path begins of the plant sampled as for the manifest, but with another step."""

AT_SAMPLES: Path = ("sampled", "closed_loop")
"""The path of a loop of samples, where the manifest is about the plant in continuous time."""


@dataclass(frozen=True)
class Premise:
    """A VALID certificate, from which sentences follow.

    Attributes
    ----------
    file : str
    document : dict
        The whole certificate, whose witness has been verified as well.
    plant, system, meant : System or ParametricSystem
        The plant, the subject that was built from it, and the system that the manifest is about.
    statement : str
        The statement that the checker verified, without the sizes of the system.
    path : tuple of str, or None
        The constructions of the subject; None if they do not begin at the manifest's system, or
        at what this would be with `ANOTHER_STEP`, which then stands first.
    pointers : tuple of str
        The pointers of a sentence into this certificate.
    nearby : bool
        Whether the plant is another one than that of the manifest: then no rule but those about
        such plants takes it.
    """

    file: str
    document: dict[str, Any]
    plant: Any
    system: Any
    meant: Any
    statement: str
    path: Path | None
    pointers: tuple[str, ...] = ()
    nearby: bool = False

    def __getitem__(self, key: str) -> Any:
        return self.document["claim"][key]

    @property
    def kind(self) -> str:
        """The kind of the certificate."""
        return str(self.document["kind"])

    @property
    def witness(self) -> Any:
        """The evidence, verified."""
        return self.document["witness"]

    @property
    def about(self) -> str:
        """The subject in words, with which a sentence begins."""
        return f"For {self.system.words}"

    def expect(self, holds: bool, message: str) -> None:
        """Stop unless the claims are as the sentence needs them."""
        require(holds, "claim", self.file, message)

    def cited(self, part: str, key: str) -> list[Any]:
        """The members of a list to which the sentence points; all of them if it points to none."""
        paths = [pointer.split("/")[1:] for pointer in self.pointers]
        numbers = {int(path[2]) for path in paths if path[:2] == [part, key] and path[2:]}
        members = enumerate(self.document[part][key])
        return [member for k, member in members if k in numbers or not numbers]


@dataclass(frozen=True)
class Role:
    """The requirements on a premise: one of these kinds, with one of these subjects.

    With ``many``, all fitting premises, at least one, are taken as a list; with ``nearby`` those
    about another plant than that of the manifest, and no others.  With ``apart``, what premises
    show is true by itself of the manifest's system, so that their constructions may differ.
    """

    kinds: Path
    paths: tuple[Path, ...] = SYSTEM
    many: bool = False
    nearby: bool = False
    apart: bool = False

    def fits(self, premise: Premise, heard: bool) -> bool:
        """Whether a premise can play the role, for agents with or without their neighbors' outputs.

        All premises with such a role must have the same information structure.
        """
        ways = self.paths
        if ways in (SYSTEM, DUAL, FAILED):
            ways = ways[heard : heard + 1]
        right = premise.kind in self.kinds and premise.path in ways
        return right and premise.nearby == self.nearby

    def words(self) -> str:
        """The role, for a message."""
        ways = " or ".join("+".join(path) or "the plant" for path in self.paths)
        whose = " of a plant that is listed as nearby" if self.nearby else ""
        return f"a premise of the kind {' or '.join(self.kinds)}, about {ways}{whose}"


@dataclass(frozen=True)
class Rule:
    """The premises that imply a sentence, the theorem, and the implied statement in words.

    ``say`` takes the premises in the order of the roles, and stops if their claims do not imply the
    sentence.  Without roles it takes all premises, those of the sentence first, and describes the
    plant or a controller.  ``claims`` is false of a remark, which says nothing that could be true
    or false of the system: its verdict is REMARK and never IMPLIED.
    """

    theorem: str
    roles: tuple[Role, ...]
    say: Callable[..., str]
    claims: bool = True

    def implied(self, cited: list[Premise], known: list[Premise]) -> str:
        """The statement that the premises imply.

        Raises
        ------
        Refused
            If a premise is missing, or they do not imply the sentence.
        """
        if not self.roles:
            return self.say([each for each in [*cited, *known] if not each.nearby])
        casts = [list(self._cast(cited, heard)) for heard in (False, True)]
        cast = max(casts, key=len)
        if len(cast) < len(self.roles):
            wanted = self.roles[len(cast)].words()
            require(False, "premise", "because", f"expected {wanted}")
        self._require_same_steps(cast)
        return self.say(*cast)

    def _cast(self, cited: list[Premise], heard: bool) -> Iterator[Any]:
        """The premise for each role, up to the first role without a premise."""
        for role in self.roles:
            able = [premise for premise in cited if role.fits(premise, heard)]
            if not able:
                return
            yield able if role.many else able[0]

    def _require_same_steps(self, cast: list[Any]) -> None:
        """Stop if constructions of the same names are others in two premises.

        Paths are names alone: with other parts, or another controller, a premise of the same path
        is about another system.
        """
        first: dict[tuple[Path | None, bool], Premise] = {}
        for role, part in zip(self.roles, cast, strict=True):
            for premise in [] if role.apart else part if role.many else [part]:
                other = first.setdefault((premise.path, premise.nearby), premise)
                alike = same(premise.document["subject"], other.document["subject"])
                premise.expect(alike, "its constructions are others than those of another premise")


RULES: dict[str, Rule] = {}
"""The rule of each sentence, by the key that the manifest names."""

Say = Callable[..., str]
Holds = Callable[[Premise], object]


def rule(keys: str, *roles: Role, theorem: str = "") -> Callable[[Say], Say]:
    """Enter a rule under these keys, with blanks between them."""

    def enter(say: Say) -> Say:
        RULES.update({key: Rule(theorem, roles, say) for key in keys.split()})
        return say

    return enter


def remark(keys: str) -> None:
    """Add rules of sentences that claim nothing: titles, and what is not decided or proved."""

    def enter(key: str) -> None:
        def say(known: list[Premise]) -> str:
            return f"For {known[0].meant.words}: the sentence {key} claims nothing"

        RULES[key] = Rule("", (), say, claims=False)

    for each in keys.split():
        enter(each)


def repeated(premise: Premise) -> str:
    """The certificate's claim, as it was verified."""
    return premise.statement


def restate(keys: str, role: Role, holds: Holds, theorem: str = "", words: Say = repeated) -> None:
    """Enter a rule with one premise, which by default repeats the certificate's claim."""

    def say(premise: Premise) -> str:
        premise.expect(bool(holds(premise)), "the claim is different")
        return words(premise)

    rule(keys, role, theorem=theorem)(say)


def either(yes: str, no: str, role: Role, holds: Holds) -> None:
    """Enter a rule that repeats what holds, and one that repeats that it does not."""
    restate(yes, role, holds)
    restate(no, role, lambda premise: not holds(premise))


# What the certificates of an analysis imply: modes, structure, one channel, set-points.

WANG_DAVISON = "S. H. Wang and E. J. Davison 1973"
FIXED_DYNAMIC = "evidence.shrunk_subspace_fixed_dynamic"
PENCIL_MODES = "evidence.shrunk_subspace_pencil, joint_controllability.controllable_hautus"
SPLIT = "component_assignment.component_assignment"
MOVED = "fixed_spectrum.multiplicity_at_most, spectrum_split.spectrum_split"
HAUTUS = "joint_controllability.controllable_hautus"
DAVISON = "setpoint.setpoint_rank; E. J. Davison 1976"

SIDES = ("controllable", "observable")
LARGE = 2**61 - 1
"""A prime, modulo which polynomials that are coprime nearly always stay so."""

FIXED = Role(("fixed_spectrum",))
COMPLETE = Role(("completeness",))
BLOCKS = Role(("assignability",))
CONTROLLABLE, OBSERVABLE = Role(("controllability",)), Role(("controllability",), DUAL)
GAINS = Role(("single_channel_gains",))
SUBSYSTEM = Role(("complementary_subsystem",))
RANK, RANKS = Role(("pencil_rank",)), Role(("pencil_rank",), many=True)
SPECTRUM = Role(("closed_loop_spectrum",))
SETPOINT = Role(("setpoint",), (*PLANT, ("regulated",)))


def everywhere(premise: Premise) -> bool:
    """Whether a certificate about a set of channels is about all of them."""
    return bool(premise["channels"] == premise.system.names)


def controls(premise: Premise) -> bool:
    """Whether all channels together control the subject."""
    premise.expect(everywhere(premise), "not about all channels together")
    return bool(premise["controllable"])


# Titles, and remarks on what is not proved or was not decided; they claim nothing.


def plain(known: list[Premise]) -> System:
    """The system that the sentences are about, which has no parameters."""
    meant: System = known[0].meant
    known[0].expect(isinstance(meant, System), "the plant has parameters")
    return meant


@rule("heading page-heading information")
def _heading(known: list[Premise]) -> str:
    """The sizes of what the manifest is about, and the names of its channels."""
    plant = plain(known)
    p, q = sum(M.ncols for M in plant.B), sum(M.nrows for M in plant.C)
    ports = f"{p} inputs and {q} outputs in all"
    return f"For {described(plant)}: {ports}"


remark("subsystem channel picture-fixed-mode picture-graphs picture-graphs-outputs")
remark("picture-dimensions certify-loop")
remark("design-measured periodic-loop time-varying-option")
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
    """The edges of the neighbor graph: j → i if agent i receives messages from agent j."""
    plant = plain(known)
    known[0].expect(plant.neighbors is not None, "the plant has no neighbor graph")
    sets, names = enumerate(plant.neighbors or []), plant.names
    edges = edge_set((names[j], names[i]) for i, N_i in sets for j in N_i if i != j)
    return f"For {plant.words}: its neighbor graph has the edges {edges}"


# Fixed modes.


def followed(words: str) -> Callable[[Premise], str]:
    """The words for a claim, and for what follows from it."""
    return lambda premise: f"{premise.statement}; {words}"


def free(premise: Premise) -> bool:
    """Whether no mode is fixed."""
    return not premise["factors"]


ANY_RATE = followed("every decay rate is reached by linear time-invariant control")
restate("nothing-fixed", FIXED, free, "fixed_spectrum.absence_all")
restate("any-rate", FIXED, free, WANG_DAVISON, ANY_RATE)
restate("stabilizable table-stabilizable", FIXED, lambda c: c["stabilizable"], WANG_DAVISON)
NEVER = "not-stabilizable table-not-stabilizable"
restate(NEVER, FIXED, lambda c: not c["stabilizable"], FIXED_DYNAMIC)
LISTED = "fixed slowest fixed-modes-row fixed-modes-note latex-fixed-mode picture-obstruction"
either("fixed-none latex-nothing-fixed", LISTED, FIXED, free)
restate("fixed-modes", FIXED, lambda c: c["factors"], FIXED_DYNAMIC)


def _blame(key: str, why: str, wanted: Callable[[int, int], bool]) -> None:
    """Enter the rule about the fixed modes whose sets have a wanted size, among m channels."""

    @rule(key, FIXED, theorem=PENCIL_MODES)
    def _say(premise: Premise) -> str:
        texts, names = [], premise.system.names
        for factor in premise.cited("claim", "factors"):
            s, modes = factor["channels"], polynomial_text(factor["polynomial"])
            if wanted(len(s), len(names)):
                sets = channel_set(name for name in names if name not in s), channel_set(s)
                texts.append(f"the roots of {modes} are fixed, {why.format(*sets)}")
        premise.expect(bool(texts), "the claim is different")
        return f"{premise.about}: {'; '.join(texts)}"


_blame("fixed-mode", "not controlled by {} and not observed by {}", lambda size, m: 0 < size < m)
_blame("fixed-mode-uncontrolled", "not controlled by all of {}", lambda size, m: size == 0)
_blame("fixed-mode-unobserved", "not observed by all of {1}", lambda size, m: size == m)


# Parts that no controller changes: left out of the plant, or told from other fixed modes.

PART_OF = ("uncontrollable", "unobservable")
LEFT_OUT = ", ".join(f"modulo.{side}_part" for side in PART_OF)
MINIMAL = Role(FIXED.kinds, tuple((*path, *["modulo"] * k) for path in SYSTEM for k in (1, 2)))
remark(" ".join(f"modulo-option-{which}" for which in (*PART_OF, "both")))


REST = Role(
    (*FIXED.kinds, *SPECTRUM.kinds, "stability", "distributed_observer"),
    (*SYSTEM, ("closed_loop",)),
)


def stays(side: str) -> None:
    """Enter the rule about modes that stay in every loop, as a part of this side has them."""

    @rule(f"modulo-{side}", REST, theorem=f"modulo.{side}_loop")
    def _say(rest: Premise) -> str:
        subject = rest.document["subject"]
        base = subject[: len(subject) - len(rest.path or ())]
        # of a system that was made from the plant in another way, the loops are other ones
        own = all(step["construction"] == "modulo" for step in base)
        rest.expect(own, "the parts are not those of the plant itself")
        chis = [polynomial_text(step["polynomial"]) for step in base if step["part"] == side]
        rest.expect(bool(chis), f"no {side} part is left out")
        parts = " and of ".join(chis)
        return f"For {rest.plant.words}: the roots of {parts} are eigenvalues of every loop"


for _side in PART_OF:
    stays(_side)


def joint(rest: Premise) -> str:
    """What the last constructions left out, by the characteristic polynomials."""
    path = rest.path or ()
    parts = rest.document["subject"][-path.count("modulo") :]
    chis = ", ".join(polynomial_text(step["polynomial"]) for step in parts)
    heard = ", each agent measuring what it receives of its neighbors too" * (HEARD[0][0] in path)
    return f"For {rest.meant.words}{heard}: the roots of {chis} are fixed, each as often as a root"


@rule("joint-fixed", MINIMAL, theorem=LEFT_OUT)
def _joint_fixed(rest: Premise) -> str:
    """The modes of what was left out, with their multiplicities."""
    return joint(rest)


@rule("decentralized-none", MINIMAL, theorem=LEFT_OUT)
def _none_besides(rest: Premise) -> str:
    """Nothing else is fixed."""
    rest.expect(free(rest), "a mode is fixed besides")
    return f"{joint(rest)}, and nothing else is"


@rule("fixed-besides", MINIMAL, theorem=LEFT_OUT)
def besides(rest: Premise) -> str:
    """What else is fixed."""
    factors = rest.cited("claim", "factors")
    rest.expect(bool(factors), "nothing is fixed besides")
    named = [(polynomial_text(f["polynomial"]), f["multiplicity_at_most"]) for f in factors]
    modes = ", ".join(f"of {p} at most {k} times" for p, k in named)
    return f"{joint(rest)}, and besides those {modes}"


@rule("decentralized-fixed", MINIMAL, CONTROLLABLE, OBSERVABLE, theorem=f"{LEFT_OUT}, {HAUTUS}")
def _decentralized(rest: Premise, controls_: Premise, observes: Premise) -> str:
    """What else is fixed, and all channels together control and observe it."""
    for premise in (controls_, observes):
        premise.expect(everywhere(premise), "not about all channels together")
        lost = polynomial(premise["uncontrollable_polynomial"], premise.file)
        for factor in rest.cited("claim", "factors"):
            p = polynomial(factor["polynomial"], rest.file, 1)
            require_coprime(p, lost, LARGE, "a mode and those that all channels do not move")
    return f"{besides(rest)}; all channels together control and observe them"


@rule("feedthrough", Role(FIXED.kinds, PLANT), theorem="feedthrough.same_fixed_modes")
def _feedthrough(filtered: Premise) -> str:
    """What was made by `input_filters` last has the fixed modes of what it was made from."""
    *before, last = filtered.document["subject"] or [{"construction": ""}]
    own = last["construction"] == "input_filters"
    filtered.expect(own, "the inputs are no states that were made last")
    base = read_subject(before, filtered.plant)
    modes = "modes at which [xI - A, -B; C, D] has rank below n for some set of channels"
    return f"For {base.words}: the {modes} are the fixed modes of {filtered.system.words}"


# Control that varies in time or is nonlinear: the plant with its strong components merged.

OWN_GRAPH = Role(("transfer_graph",), PLANT)
QUOTIENT = Role(FIXED.kinds, (("merged",),))
TIME_VARYING = (
    "B. D. O. Anderson and J. B. Moore 1981; P. P. Khargonekar and A. B. Ozguler 1994; "
    "L. Gong and M. Aldeen 1997"
)
ANY = "no causal decentralized control, also none that varies in time or is nonlinear,"
CAUSAL = "time_varying.no_causal_control_moves"


def quotient(key: str, holds: Holds, what: str, theorem: str = "") -> None:
    """Enter a rule about a system whose parts are the strong components of the transfer graph."""

    @rule(key, QUOTIENT, OWN_GRAPH, theorem=theorem)
    def _say(modes: Premise, graph: Premise) -> str:
        parts = modes.document["subject"][-1]["parts"]
        strong = sorted(map(sorted, parts)) == sorted(map(sorted, graph["components"]))
        modes.expect(strong, "the merged channels are not the strong components")
        modes.expect(bool(holds(modes)), "the claim is different")
        return f"{graph.about}: {what.format(polynomial_text(modes['polynomial']))}"


quotient("quotient-fixed-none", free, "merged by strong components it has no fixed mode")
quotient("quotient-fixed", lambda c: not free(c), f"{ANY} moves the roots of {{}}", CAUSAL)
quotient(
    "no-causal-control",
    lambda c: not c["stabilizable"],
    f"{ANY} stabilizes it, as none moves the roots of {{}}",
    CAUSAL,
)
quotient(
    "time-varying-stabilizes",
    lambda c: c["stabilizable"],
    "some causal decentralized control stabilizes it",
    TIME_VARYING,
)


# Single failures: what is fixed after them, and after which no control stabilizes the plant.

AFTER = Role(FIXED.kinds, FAILED, many=True, apart=True)
MORE = "failures.fixed_after_more"
STILL = f"{MORE}; {WANG_DAVISON}"
SO_MANY = "failures.at_least_so_many"
Failure = tuple[str, Any]
"""Which part failed: "agents", "actuators", "sensors" or "links", and the one of them."""


def failure(after: Premise) -> Failure:
    """The only failure of a subject."""
    step = after.document["subject"][0]
    each = [(what, one) for what in FAILURES for one in step[what]]
    after.expect(len(each) == 1, "more than one failure")
    return each[0]


def every_failure(after: Premise) -> list[Failure]:
    """All single failures of the plant, those of links if outputs are sent over them."""
    plant, heard = after.plant, (after.path or ())[1:] == HEARD[0]
    ports = {"actuators": [B.ncols for B in plant.B], "sensors": [C.nrows for C in plant.C]}
    listed: list[Failure] = [("agents", name) for name in plant.names]
    for what, sizes in ports.items():
        sized = zip(plant.names, sizes, strict=True)
        listed += [(what, [name, k + 1]) for name, size in sized for k in range(size)]
    for i, N_i in enumerate(plant.neighbors or []) if heard else ():
        listed += [("links", [plant.names[j], plant.names[i]]) for j in N_i if j != i]
    spend(1000 * len(listed))
    return listed


def failed_in(one: Failure, whole: Failure) -> bool:
    """Whether all that fails in the first failure fails in the other one as well.

    An agent that fails has no actuators, sensors and links any more.
    """
    part, which = one
    ends = which if part == "links" else which[:1]
    return one == whole or (part != "agents" and whole[0] == "agents" and whole[1] in ends)


def require_all_others(after: list[Premise], fine: Holds) -> list[Failure]:
    """The failures after which something is not fine; stop unless it is fine after all others."""
    known = [(failure(each), bool(fine(each))) for each in after]
    bad = [one for one, good in known if not good]
    good = [one for one, good in known if good]
    spend(200 * len(known) * len(known))
    for one in every_failure(after[0]):
        proved = one in bad or any(failed_in(one, whole) for whole in good)
        after[0].expect(proved, f"nothing is known of the failure {json.dumps(one)}")
    return bad


def failures(listed: list[Failure]) -> str:
    """Failures as a statement lists them."""
    return ", ".join(f"{what} {json.dumps(one)}" for what, one in listed)


def stabilizable(premise: Premise) -> bool:
    """Whether every fixed mode is stable."""
    return bool(premise["stabilizable"])


LTI = "linear time-invariant decentralized control"


@rule("failures-unstable-row", AFTER, theorem=FIXED_DYNAMIC)
def _unstable(after: list[Premise]) -> str:
    """Single failures after which a mode is fixed that is not stable."""
    bad = [failure(each) for each in after if not stabilizable(each)]
    after[0].expect(bool(bad), "every fixed mode is stable")
    return f"{of_failures(after)}: not stabilizable by {LTI} after the failure of {failures(bad)}"


@rule("failures-unstable", AFTER, theorem=f"{FIXED_DYNAMIC}; {STILL}")
def _so_many(after: list[Premise]) -> str:
    """The same, and after all other single failures each fixed mode is stable."""
    bad, number = require_all_others(after, stabilizable), len(every_failure(after[0]))
    after[0].expect(bool(bad), "every fixed mode is stable")
    many = f"{len(bad)} of {number} single failures"
    return f"{of_failures(after)}: not stabilizable by {LTI} after {many}: {failures(bad)}"


@rule("failures-stabilizable", AFTER, theorem=STILL)
def _stable(after: list[Premise]) -> str:
    """After all single failures each fixed mode is stable."""
    after[0].expect(not require_all_others(after, stabilizable), "a mode is not stable")
    number = len(every_failure(after[0]))
    return f"{of_failures(after)}: stabilizable by {LTI} after each of {number} single failures"


def of_failures(after: list[Premise]) -> str:
    """The system that failures of its plant are about, in words."""
    heard = ", each agent measuring what it receives of its neighbors too"
    return f"For {after[0].meant.words}{heard * ((after[0].path or ())[1:] == HEARD[0])}"


MEASURE = {"continuous": "the best rate", "discrete": "the largest modulus"}


@rule("failures-fixed", FIXED, AFTER, theorem="failures.fixed_after_failure")
def _fixed_after(before: Premise, after: list[Premise]) -> str:
    """What is fixed after some failures, which is more than without them."""
    texts, known = [], before["polynomial"]
    for each in after:
        each.expect(len(each["polynomial"]) > len(known), "no further mode is fixed")
        modes = polynomial_text(each["polynomial"])
        rate = each["best_rate"]
        measured = f"{MEASURE[each.system.time]} from {rate['lower']} to {rate['upper']}"
        texts.append(f"of {modes} after the failure of {failures([failure(each)])}, {measured}")
    if len(known) > 1:
        texts.append(f"of {polynomial_text(known)} without a failure")
    return f"{of_failures(after)}: fixed are the roots {', '.join(texts)}"


@rule("failures-fixed-none failures-fixed-others", FIXED, AFTER, theorem=MORE)
def _none_after(before: Premise, after: list[Premise]) -> str:
    """No further mode is fixed after all single failures but some."""
    bad = require_all_others(after, lambda each: same(each["polynomial"], before["polynomial"]))
    besides = f", but for {failures(bad)}" if bad else ""
    return f"{of_failures(after)}: every single failure{besides} leaves no further mode fixed"


# Several failures: the fewest after which something is lost.


def lost_together(after: Premise) -> tuple[str, list[Any]]:
    """The failures of a subject, all of them of agents, of actuators, of sensors or of links."""
    step = after.document["subject"][0]
    parts = [what for what in FAILURES if step[what]]
    after.expect(len(parts) == 1, "failures of different parts")
    return parts[0], step[parts[0]]


def fewest_lost(after: list[Premise], fine: Holds) -> tuple[str, int, list[Premise]]:
    """What fails, the largest k for which premises prove all fine after k failures, and the rest.

    Every k failures are among those of one premise that is fine: no k of them meet, for every such
    premise, the parts that are left.  The last part of the result has the other premises, those
    about the fewest failures first.

    Theorem ``failures.at_least_so_many``.
    """
    part = lost_together(after[0])[0]
    every = [json.dumps(one) for what, one in every_failure(after[0]) if what == part]
    bit = {one: 1 << k for k, one in enumerate(every)}
    left, others = [(1 << len(every)) - 1], []
    for each in after:
        what, lost = lost_together(each)
        each.expect(what == part, "failures of other parts than those of another premise")
        each.expect(all(json.dumps(one) in bit for one in lost), "links over which nothing is sent")
        if fine(each):
            left.append(left[0] - sum(bit[json.dumps(one)] for one in lost))
        else:
            others.append((len(lost), each))
    others.sort(key=lambda pair: pair[0])
    most = others[0][0] if others else len(every)
    k = 0
    while k < most and not hit([*{*left}], k + 1):
        k += 1
    return part, k, [each for _, each in others]


def hit(sets: list[int], most: int) -> bool:
    """Whether at most so many elements meet all sets, which are given by bits."""
    spend(100 * (len(sets) + 1))
    if not sets:
        return True
    sets = sorted(sets, key=int.bit_count)
    taken = disjoint = 0
    for each in sets:
        if not each & taken:
            taken |= each
            disjoint += 1
    if not sets[0] or disjoint > most:
        return False
    first, passed = sets[0], 0
    while first:
        one = first & -first
        # what meets the first set in an element that was passed has been tried
        if hit([each & ~passed for each in sets if not each & one], most - 1):
            return True
        passed |= one
        first -= one
    return False


def any_of(k: int, part: str) -> str:
    """Any k failures, in words."""
    return f"any {k} of the {part}"


@rule("failures-fewest-unstable", AFTER, theorem=f"{FIXED_DYNAMIC}; {SO_MANY}; {WANG_DAVISON}")
def _fewest_unstable(after: list[Premise]) -> str:
    """Failures after which a mode is fixed that is not stable, and how many there are at least."""
    part, k, bad = fewest_lost(after, stabilizable)
    after[0].expect(bool(bad), "every fixed mode is stable")
    lost = ", ".join(map(json.dumps, lost_together(bad[0])[1]))
    fewer = f", and stabilizable after that of {any_of(k, part)}" if k else ""
    return (
        f"{of_failures(after)}: not stabilizable by {LTI} after the failure of {part} {lost}{fewer}"
    )


@rule("failures-fewest-fixed", FIXED, AFTER, theorem=SO_MANY)
def _fewest_fixed(before: Premise, after: list[Premise]) -> str:
    """Failures after which a further mode is fixed, and how many there are at least."""
    part, k, bad = fewest_lost(after, lambda each: same(each["polynomial"], before["polynomial"]))
    after[0].expect(bool(bad), "no further mode is fixed")
    lost = ", ".join(map(json.dumps, lost_together(bad[0])[1]))
    modes, known = polynomial_text(bad[0]["polynomial"]), before["polynomial"]
    besides = f", of {polynomial_text(known)} without a failure" if len(known) > 1 else ""
    fewer = f", and no further ones after that of {any_of(k, part)}" if k else ""
    fixed = f"fixed are the roots of {modes} after the failure of {part} {lost}"
    return f"{of_failures(after)}: {fixed}{besides}{fewer}"


def without_all(after: list[Premise]) -> tuple[Premise, str]:
    """A premise about the failure of all parts of a sort, and the failure in words."""

    def missing(each: Premise) -> int:
        part, lost = lost_together(each)
        return sum(what == part for what, _ in every_failure(each)) - len(lost)

    last = min(after, key=missing)
    last.expect(missing(last) == 0, "not all parts of a sort have failed")
    return last, f"the failure of all {lost_together(last)[0]}"


@rule("failures-all-stabilizable", AFTER, theorem=WANG_DAVISON)
def _all_stable(after: list[Premise]) -> str:
    """Each fixed mode is stable after the failure of all parts of a sort."""
    last, lost = without_all(after)
    last.expect(stabilizable(last), "a mode is not stable")
    return f"{of_failures(after)}: stabilizable by {LTI} after {lost}"


@rule("failures-all-none", FIXED, AFTER)
def _all_none(before: Premise, after: list[Premise]) -> str:
    """No further mode is fixed after the failure of all parts of a sort."""
    last, lost = without_all(after)
    last.expect(same(last["polynomial"], before["polynomial"]), "a further mode is fixed")
    return f"{of_failures(after)}: {lost} leaves no further mode fixed"


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
    parts = ", ".join(f"degree {size} by {names}" for size, names in blocks if size)
    return f"{split.about}: the spectrum is assigned in parts: {parts}"


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
    number = f"{least}" if least == most else f"from {least} to {most}"
    return f"{split.about}: gains move {number} of the {split.system.n} eigenvalues"


@rule("spectrum-moved", FIXED, BLOCKS, theorem=MOVED)
def _moved_exactly(spectrum: Premise, split: Premise) -> str:
    """How many eigenvalues gains move, where the bounds meet."""
    least, most = moved(spectrum, split)
    spectrum.expect(least == most, f"only known to be from {least} to {most}")
    return moved_between(spectrum, split)


# Structure, a set of channels, one channel.


def alone(premise: Premise) -> bool:
    """Whether a certificate about a set of channels is about one."""
    return len(premise["channels"]) == 1


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


def completeness(premise: Premise) -> tuple[bool, bool]:
    """Whether the transfer matrix is zero, and whether the rank drops below n anywhere."""
    return premise["transfer_zero"], len(premise["remnant"]) > 1


restate("subsystem-complete", SUBSYSTEM, lambda c: completeness(c) == (False, False))
restate("subsystem-zero", SUBSYSTEM, lambda c: completeness(c) == (True, False))
restate("subsystem-drops", SUBSYSTEM, lambda c: completeness(c) == (False, True))
restate("subsystem-zero-and-drops", SUBSYSTEM, lambda c: completeness(c) == (True, True))


@rule("pencil", SPECTRUM, RANKS, theorem="closed_loop_spectrum.closed_loop_spectrum")
def _pencil(spectrum: Premise, ranks: list[Premise]) -> str:
    """The rank of one pencil at every root of the polynomial of A."""
    left, listed = polynomial(spectrum["polynomial"], spectrum.file), ranks[0]["subset"]
    for premise in ranks:
        premise.expect(premise["subset"] == listed, "about another set of channels")
        left = exponent(polynomial(premise["polynomial"], premise.file, 1), left)[1]
    spectrum.expect(len(left) == 1, f"no rank is claimed at the roots of {polynomial_text(left)}")
    least, s = min(premise["rank"] for premise in ranks), channel_set(listed)
    which = f"the pencil {PENCIL}, C the outputs of the channels {s} and B the inputs of the others"
    return f"{spectrum.about}: {which}, has rank {least} or more at every mode of A"


def gains(key: str, wanted: str, about: Callable[[Premise], bool]) -> None:
    """Enter the rules about gains for one channel, or for every channel."""

    def asked(premise: Premise) -> bool:
        right = about(premise) and premise["property"] == wanted
        premise.expect(right, "another question was asked")
        return bool(premise["exists"])

    def lost(part: str, *sides: str) -> Holds:
        return lambda c: not asked(c) and part in c.witness and c.witness["side"] in sides

    def reason(premise: Premise) -> str:
        p, q, side = (premise.witness.get(part) for part in ("polynomial", "channel", "side"))
        why = f"the roots of {polynomial_text(p)} stay out of reach" if p else "it cannot spread"
        return f"{premise.statement}: not {side} through {json.dumps(q)}, for {why}"

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


def of_all_outputs(premise: Premise) -> None:
    """Stop unless the outputs are those of the manifest's system, without inputs that are states.

    Where its inputs were made states, agents measure these behind the outputs.
    """
    if not premise.path:
        return
    *_, filters, step = premise.document["subject"]
    premise.expect(filters["construction"] == "input_filters", "other outputs are regulated")
    for S_i, B_i, C_i in zip(step["gains"], premise.meant.B, premise.meant.C, strict=True):
        q, width = C_i.nrows - B_i.ncols, C_i.nrows
        rows = [[int(j == k) for j in range(width)] for k in range(q)]
        premise.expect(S_i == {"denominator": 1, "entries": rows}, "other outputs are regulated")


@rule("setpoint", SETPOINT, CONTROLLABLE, OBSERVABLE, theorem=DAVISON)
def _setpoint(premise: Premise, c: Premise, o: Premise, *_: Premise) -> str:
    """Integrators behind all outputs, and everything within reach."""
    of_all_outputs(premise)
    premise.expect(premise["solvable"], "the rank of [A, B; C, 0] is not full")
    c.expect(controls(c) and controls(o), "not jointly controllable and observable")
    return f"{premise.about}: {HELD}"


@rule("setpoint-stable-rest", SETPOINT, CONTROLLABLE, OBSERVABLE, FIXED, theorem=DAVISON)
def _setpoint_beside(premise: Premise, c: Premise, o: Premise, _: Premise) -> str:
    """Integrators behind all outputs, and what is out of reach is stable."""
    of_all_outputs(premise)
    premise.expect(premise["solvable"], "the rank of [A, B; C, 0] is not full")
    c.expect(not unreached(c, o), "what is out of reach is not stable")
    return f"{premise.about}: {HELD}; every mode out of its reach is stable"


@rule("setpoint-unstable-rest", SETPOINT, CONTROLLABLE, OBSERVABLE, FIXED, theorem=HAUTUS)
def _setpoint_lost(premise: Premise, c: Premise, o: Premise, _: Premise) -> str:
    """No loop is stable: a mode out of reach is not."""
    c.expect(bool(unreached(c, o)), "what is out of reach is stable")
    lost = f"out of reach are roots of {' and of '.join(unreached(c, o))}"
    return f"{premise.about}: no linear time-invariant loop is stable: {lost}"


RANK_RULE = "setpoint.setpoint_rank"


def _lost_outputs(key: str, zero: bool) -> None:
    """Enter the rule about set-points that no stable loop holds, with an invariant zero or not."""

    @rule(key, SETPOINT, theorem=RANK_RULE)
    def _say(premise: Premise) -> str:
        of_all_outputs(premise)
        premise.expect(premise["invariant_zero"] is zero, "the claim is different")
        return premise.statement


_lost_outputs("setpoint-zero", True)
_lost_outputs("setpoint-dependent", False)


@rule("setpoint-fewer-inputs", SETPOINT, theorem=RANK_RULE)
def _fewer_inputs(premise: Premise) -> str:
    """[A, B; C, 0] has more rows than columns."""
    of_all_outputs(premise)
    inputs = sum(B_i.ncols for B_i in premise.system.B)
    outputs = sum(C_i.nrows for C_i in premise.system.C)
    premise.expect(inputs < outputs, "there are as many inputs as outputs")
    return (
        f"{premise.about}: {counted(inputs, 'input')} for {counted(outputs, 'output')}, so that in "
        "no stable linear time-invariant loop every output tends to every constant set-point"
    )


# What the certificates about sharing imply: bounds, least dimensions, links, delays.

OBSERVABLE_HAUTUS = "joint_controllability.observable_hautus"

CONNECTED = Role(("neighbor_graph",), PLANT)
LEAST = Role(("shared_dimensions",), PLANT)
LINKS = Role(("communication",), PLANT)
HYPOTHESES = (CONNECTED, CONTROLLABLE, OBSERVABLE)
UNCONNECTED = "neighbor-graph-not-connected enough-unknown"
either("neighbor-graph-connected", UNCONNECTED, CONNECTED, lambda c: c["strongly_connected"])

restate("sharing-in-vain-controllability", CONTROLLABLE, lambda c: not controls(c), HAUTUS)
restate("sharing-in-vain-observability", OBSERVABLE, lambda c: not controls(c), OBSERVABLE_HAUTUS)
for delayed in ("lifted", "held"):
    NETWORK = Role(("fixed_spectrum",), ((delayed,),))
    either(f"{delayed}-nothing-fixed", f"{delayed}-fixed", NETWORK, free)


def enough(bound: Premise, *hypotheses: Premise) -> str:
    """No mode is fixed if every agent shares sub-states of this bound: Theorem 2 or Remark 2."""
    graph, c, o = hypotheses
    graph.expect(graph["strongly_connected"], "the neighbor graph is not strongly connected")
    c.expect(controls(c), "not jointly controllable")
    o.expect(controls(o), "not jointly observable")
    what = "outputs" if bound.path == HEARD[0] else "no outputs"
    shared = f"{what} and at least {counted(bound['deficiency'], 'sub-state')} with its neighbors"
    return f"{graph.about}: no mode is fixed where every agent shares {shared}, without delay"


def _enter_bound(key: str, paths: tuple[Path, ...], theorem: str, positive: bool) -> None:
    """Enter the rule about a bound for one way of sharing that is positive, or 0."""

    @rule(key, Role(("deficiency",), paths), *HYPOTHESES, theorem=theorem)
    def _say(bound: Premise, *hypotheses: Premise) -> str:
        bound.expect((bound["deficiency"] > 0) == positive, "the bound is another one")
        return enough(bound, *hypotheses)


_enter_bound("enough-outputs-states", HEARD, "extended_bound.theorem_2", positive=True)
_enter_bound("enough-outputs", HEARD, "extended_bound.theorem_2", positive=False)
_enter_bound("enough-states", PLANT, "extended_bound.remark_2", positive=True)
_enter_bound("enough-nothing", PLANT, "extended_bound.remark_2", positive=False)


# What stays however much agents share over a graph that need not be strongly connected.

OVER_LINKS: Path = ("arcs", "augmented_outputs")
WHATEVER_SHARED = Role(FIXED.kinds, (OVER_LINKS,))
ANY_SHARING = "any_graph.any_sharing"
NO_SHARING = f"{ANY_SHARING}, {PENCIL_MODES}"
SHARE = "however much its agents share over its links, with no delay"


def before_links(premise: Premise) -> System:
    """The system to whose graph the last links were added; these must complete its paths.

    The links must be those of the transitive closure: the new graph has them and no others.
    """
    system: System = read_subject(premise.document["subject"][:-2], premise.plant)
    N = [set(N_i) for N_i in system.neighbors or []]
    spend(len(N) * sum(map(len, premise.system.neighbors or [])))
    for j in range(len(N)):
        for N_i in N:
            if j in N_i:
                N_i |= N[j]
    closed = list(map(set, premise.system.neighbors or [])) == N
    premise.expect(closed, "the links are not those from all agents with a path to an agent")
    return system


def whose(premise: Premise, factor: dict[str, Any]) -> tuple[list[str], list[str]]:
    """The agents from which paths lead to those that do not observe a mode, and the others."""
    names, N = premise.system.names, premise.system.neighbors or []
    s = {j for name in factor["channels"] for j in N[names.index(name)]}
    inside = [name for i, name in enumerate(names) if i in s]
    return inside, [name for i, name in enumerate(names) if i not in s]


def stays_shared(premise: Premise) -> str:
    """The modes that stay, by some agents, not all, which receive from no other."""
    base, texts = before_links(premise), []
    for factor in premise.cited("claim", "factors"):
        inside, outside = whose(premise, factor)
        if inside and outside:
            texts.append(
                f"the roots of {polynomial_text(factor['polynomial'])} are fixed, not observed by "
                f"{channel_set(inside)}, which receives from no other agent, and not controlled by "
                f"{channel_set(outside)}"
            )
    premise.expect(bool(texts), "no such mode is fixed")
    return f"For {base.words}, {SHARE}: {'; '.join(texts)}"


rule("stays-shared", WHATEVER_SHARED, theorem=NO_SHARING)(stays_shared)


@rule("free-shared", WHATEVER_SHARED, theorem=ANY_SHARING)
def _free_shared(premise: Premise) -> str:
    """No mode stays where enough states are shared."""
    base = before_links(premise)
    premise.expect(free(premise), "a mode is fixed")
    what = "no mode is fixed if its agents share enough states over its links, with no delay"
    return f"For {base.words}: {what}"


@rule("source-components design-source-components", WHATEVER_SHARED)
def _sources(premise: Premise) -> str:
    """The strong components into which no link leads: sets that are closed, and no smaller ones."""
    base = before_links(premise)
    N = [frozenset(N_i) for N_i in premise.system.neighbors or []]
    parts = {N_i for N_i in N if all(N[j] == N_i for j in N_i)}
    listed = ", ".join(
        channel_set(base.names[i] for i in sorted(s)) for s in sorted(parts, key=min)
    )
    return f"For {base.words}: its neighbor graph has the source components {listed}"


# The least dimensions.


def proved_least(least: Premise) -> bool:
    """Whether the cost is the least, and not only between two bounds."""
    return "at_least" not in least.document["claim"]


def usual(least: Premise, share: str) -> bool:
    """Whether the least number is asked for, without limits, so that no mode at all is fixed."""
    asked = least["share"] == share and least["bound"] is None and not least["free_assignability"]
    prices = all(cost == 1 for cost in least["costs"])
    return asked and prices and all(most is None for most in least["upper"])


def _enter_least(share: str, key: str, some: str = "", none: str = "", never: str = "") -> None:
    """Enter the rules about the least dimensions for one way of sharing."""

    def feasible(premise: Premise, positive: bool) -> bool:
        return (
            usual(premise, share)
            and premise["feasible"]
            and proved_least(premise)
            and any(premise["dimensions"]) == positive
        )

    restate(f"{key} {some}", LEAST, partial(feasible, positive=True))
    restate(f"{key}-none {none}", LEAST, partial(feasible, positive=False))
    restate(f"{key}-impossible {never}", LEAST, lambda c: usual(c, share) and not c["feasible"])
    restate(f"{key}-between", LEAST, lambda c: usual(c, share) and not proved_least(c))


BOTH = ("sharing-removes", "outputs-remove", "no-sharing")
_enter_least("outputs+states", "least-outputs-states", *BOTH)
_enter_least("states", "least-states")
ALLOCATED = "allocate-least allocate-row allocate-total"
restate(ALLOCATED, LEAST, lambda c: c["feasible"] and proved_least(c))
restate("allocate-impossible", LEAST, lambda c: not c["feasible"])
restate("allocate-within", LEAST, lambda c: not proved_least(c))


def _enter_common(share: str, key: str, name: str) -> None:
    """Enter the rules about the least common dimension for one way of sharing."""

    def asked(premise: Premise) -> bool:
        premise.expect(premise["share"] == share, "about the other way of sharing")
        return bool(premise["feasible"])

    key, common = f"common-dimension-{key}", Role(("common_dimension",), PLANT)
    restate(key, common, lambda c: asked(c) and c["dimension"], f"shared_dimensions.{name}")
    restate(f"{key}-none", common, lambda c: asked(c) and not c["dimension"])
    restate(f"{key}-impossible", common, lambda c: not asked(c), f"shared_dimensions.no_{name}")


_enter_common("outputs+states", "outputs-states", "common_dimension_outputs")
_enter_common("states", "states", "common_dimension_states")


BOUND = Role(("deficiency",), HEARD + PLANT)
COMMON = Role(("common_dimension",), PLANT)
GAP = Role(("sharing_gap",), PLANT)
BOUNDS = "extended_bound.theorem_2, extended_bound.remark_2"


@rule("allocate-row-bound allocate-total-bound", LEAST, BOUND, *HYPOTHESES, theorem=BOUNDS)
def _allocated(least: Premise, bound: Premise, *hypotheses: Premise) -> str:
    """The least dimensions together with the bound for the same way of sharing."""
    fits = bound.path == (HEARD if least["share"] == "outputs+states" else PLANT)[0]
    bound.expect(fits, "the bound is for the other way of sharing")
    least.expect(least["feasible"] and not least["free_assignability"], "more is asked for")
    least.expect(proved_least(least), "not proved to be the least")
    more = enough(bound, *hypotheses).removeprefix(f"{least.about}: ")
    return f"{least.statement}; {more}"


@rule("allocate-proof allocate-cost-proof", LEAST)
@rule("allocate-links-proof", LINKS)
def _proved(least: Premise) -> str:
    """The claim, with the numbers of cuts and of nodes that prove that nothing costs less."""
    least.expect(proved_least(least), "not proved to be the least")
    cuts, nodes = (len(least.witness[key]) for key in ("cuts", "tree"))
    return f"{least.statement}, by {counted(cuts, 'cut')} and {counted(nodes, 'node')} of a tree"


@rule("allocate-within-proof", LEAST)
def _bounded(least: Premise) -> str:
    """The claim with both bounds, and the number of cuts that prove the lower one."""
    least.expect(not proved_least(least), "proved to be the least")
    return f"{least.statement}, by {counted(len(least.witness['cuts']), 'cut')}"


@rule("allocate-nested-proof allocate-nested-cost-proof", LEAST)
def _nested(least: Premise) -> str:
    """The claim, with the nested sets that prove that nothing costs less."""
    tree = least.witness["tree"]
    least.expect(proved_least(least), "not proved to be the least")
    least.expect(bool(tree) and "nested" in tree[0], "proved by a branch tree")
    listed = ", ".join(
        f"{channel_set(least.witness['cuts'][number]['subset'])} {y} times"
        for number, y in tree[0]["nested"]
    )
    return f"{least.statement}, by the boundaries of the nested sets {listed or 'none'}"


def demands(least: Premise, agents: str, alone: bool = False) -> str:
    """Cuts of the evidence in words, and why: a mode, or no transfer to their agents.

    Of a mode those of none, some or all ``agents`` are meant, or those that are cut off; if
    ``alone``, only those of agents that receive messages from no other agent.
    """
    system, lacking = least.system, []
    N = system.neighbors or [[i] for i in range(system.m)]
    sharing = f"sharing {SHARED[least['share']]} without delay"
    for cut in least.cited("witness", "cuts"):
        s, p = [system.names.index(name) for name in cut["subset"]], cut.get("polynomial")
        which = "none" if not s else "all" if len(s) == system.m else "some"
        senders = sorted({j for i in s for j in N[i]} - set(s))
        if agents == (which if p else "cut off") and not (alone and senders):
            goal, why = "a strongly connected transfer graph", "the others do not act on it"
            if p:
                goal = no_fixed_mode(least["bound"], system)
                why = f"the roots of {polynomial_text(p)}"
            others = channel_set(system.names[j] for j in senders)
            lacks = f"{channel_set(cut['subset'])} receives from {others}"
            needed = f"at least {counted(cut.get('deficiency', 1), 'sub-state')} in all"
            lacking.append(f"for {goal}, {sharing}, {lacks}, which must share {needed}: {why}")
    least.expect(bool(lacking), "the evidence has no such cut")
    return f"{least.about}: {'; '.join(lacking)}"


rule("allocate-reason", LEAST)(partial(demands, agents="some"))
rule("allocate-reason-do-not-control", LEAST)(partial(demands, agents="none"))
rule("allocate-reason-do-not-observe", LEAST)(partial(demands, agents="all"))
rule("allocate-reason-cut-off", LEAST)(partial(demands, agents="cut off"))


# How far the bounds can be from the least common dimension, over one neighbor graph.

FACTORS = {"outputs+states": "relays_at_most", "states": "boundary_at_most"}
THEOREMS = {"outputs+states": "Theorem 2", "states": "Remark 2"}
AT_MOST = {
    "outputs+states": "sharing_gap.bound_26_at_most",
    "states": "sharing_gap.bound_27_at_most",
}


def factor(gap: Premise, share: str) -> str:
    """By how much a bound exceeds the least common dimension of any plant at most."""
    return (
        f"the bound of {THEOREMS[share]} is at most {gap[FACTORS[share]]} times the least common "
        "dimension that suffices, if one does"
    )


@rule("sharing-gap", GAP, theorem=", ".join(AT_MOST.values()))
def _factors(gap: Premise) -> str:
    """The factors of the graph alone."""
    both = " and ".join(factor(gap, share) for share in FACTORS)
    return f"For {gap.system.words}: for every plant over this neighbor graph, {both}"


def _enter_gap(keys: str, share: str) -> None:
    """Enter the rules that compare the bound of a plant with its least common dimension."""
    paths = HEARD if share == "outputs+states" else PLANT

    @rule(keys, Role(("deficiency",), paths), COMMON, GAP, theorem=AT_MOST[share])
    def _compare(bound: Premise, common: Premise, gap: Premise) -> str:
        common.expect(common["share"] == share, "about the other way of sharing")
        common.expect(common["feasible"] and common["dimension"] > 0, "no dimension to compare")
        return (
            f"{common.statement}; {bound.statement.partition(': ')[2]}; "
            f"for every plant over this neighbor graph, {factor(gap, share)}"
        )


_enter_gap(
    "bound-and-least-outputs-states allocate-bound-and-least-outputs-states", "outputs+states"
)
_enter_gap("bound-and-least-states allocate-bound-and-least-states", "states")


# Links.


def fewest(links: Premise) -> bool:
    """Whether the fewest links for outputs are asked for, so that no mode at all is fixed."""
    system, listed = links.system, links["candidates"]
    heard = sum(len(N_i) - 1 for N_i in system.neighbors or [])
    everywhere = len(listed) == system.m * (system.m - 1) - heard
    asked = links["share"] == "outputs" and links["bound"] is None
    return asked and everywhere and all(cost == 1 for *_, cost in listed)


restate("links", LINKS, lambda c: fewest(c) and c["added"] and c.system.neighbors is None)
restate("links-beside-graph", LINKS, lambda c: fewest(c) and c["added"] and c.system.neighbors)
restate("table-links", LINKS, lambda c: fewest(c) and c["added"])
restate("links-none table-links-none", LINKS, lambda c: fewest(c) and c["added"] == [])
restate("no-links table-links-impossible", LINKS, lambda c: fewest(c) and not c["feasible"])
restate("allocate-links allocate-link allocate-links-total", LINKS, lambda c: c["added"])
restate("allocate-no-links-needed", LINKS, lambda c: c["added"] == [])
restate("allocate-no-links", LINKS, lambda c: not c["feasible"])
