"""The table of kinds, what is expected, and the verdict.

`KINDS` maps the name of each kind to its `Rule`: a function that stops unless the witness proves
the claim, and one that says the claim in words.  `check_document` is the one function that gives
the verdict VALID.  It reads the document strictly, compares it with what the caller expects
(`Expectation`: the plant, the controller, the statement or the claim), builds the subject from the
plant, and applies the rule.  An exception on the way becomes another verdict (`attempt`).

`Clock` and `memory` limit the time and the memory of a run; the work is limited by `budget`.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from types import FrameType
from typing import Any, TypeVar

from . import (
    boxes,
    loops,
    modes,
    parameters,
    patterns,
    performance,
    saturation,
    sharing,
    sharing_gap,
    steps,
    structure,
)
from .cells import subject_of
from .constructions import read_subject
from .controllers import Saturation, read_controller_file
from .core import fixed_modes, reach
from .core.arithmetic import NotAUnit
from .core.budget import MORE, Budget, current, kept, limited
from .core.budget import NOT_ABOUT as NOT_ABOUT
from .core.budget import Verdict as Verdict
from .core.reading import (
    Json,
    Limits,
    Refused,
    fields,
    incomplete,
    items,
    malformed,
    parse,
    require,
    shown,
    string,
)
from .core.system import System, canonical_json, described, digest_of, parse_canonical
from .core.system import digest as plant_digest
from .discs import LOOPS, SAMPLED, at_values
from .parametric_system import FunctionSystem, digest_of_values, plant_of, plant_of_file
from .summaries import summary

# What is asked of a certificate: the plant, the controller, and the statement or the claim.

DIGEST = re.compile(r"[0-9a-f]{64}")
LINE = re.compile(r"(?:VALID (?:[0-9]+ )?(?:'[^']*' )?([0-9a-f]{64}) )?(For .*)")
"""A statement, alone or in the line of its verdict."""
CLAIM = 'a claim as a JSON object {"kind": ..., "subject": [...], "claim": {...}}'
PLANT = ".plant"
"""The end of the name of a plant's file, behind its digest."""
Plant = System | FunctionSystem


def require_asked(holds: bool, code: str, place: str, message: str) -> None:
    """Stop unless a certificate is about what was asked for, whatever it proves."""
    if not holds:
        raise Refused(NOT_ABOUT, code, place, message)


Beside = Callable[[str], bytes | None]
"""The bytes of the file of a plant beside a certificate, by its digest; None if there is none."""


@dataclass(frozen=True)
class Expectation:
    """The system, the controller and the statement that a certificate must have.

    Attributes
    ----------
    system : str
        The digest of the plant; empty for any.  Where the plant has no radii, a certificate about
        a box around it is about it, too.
    plant : object
        The plant as in a certificate, which may then name it by its digest; None where only its
        digest is known, or any will do.
    size : int
        The bytes of the plant as JSON, which are granted work as if they stood in the certificate.
    controller : str
        The digest of the controller of the loop; empty for any, or for none.
    made_for : str
        The digest of the plant, without radii, that the file of the controller names; empty for
        any.
    statement : str
        The digest of the statement; empty for any.
    kind : str
        The kind of the claim; empty for any.
    subject : list
        The constructions of the subject; None for any, unless a controller is given without a
        statement: then the plant itself is in the loop.  With a controller, its closed loop follows
        on them where they do not end with one.
    claim : object
        The claim as in a certificate; None for any.
    saturation : tuple
        For each agent the limits and the anti-windup gains in the file of the controller; empty
        for any.
    among : bool
        Whether it is one of several certificates, of which some are about the plant and not about
        a loop: these are not asked for the controller.
    base : list
        The constructions of the manifest: where they sample the plant, a controller may name this
        system also in certificates about another step.
    at_samples : bool
        Whether a controller in continuous time is asked for, and a loop of samples may have one
        that is compared with it later.
    """

    system: str = ""
    plant: Json = None
    size: int = 0
    controller: str = ""
    made_for: str = ""
    statement: str = ""
    kind: str = ""
    subject: Json = None
    claim: Json = None
    saturation: Saturation = ()
    among: bool = False
    base: Json = ()
    at_samples: bool = False

    def about(self, data: bytes, limits: Limits) -> Expectation:
        """Expect, in addition, that the certificate is about the plant in a system file."""
        plant = plant_of_file(data, limits)
        text = canonical_json(plant)
        return replace(self, system=digest_of(text), plant=plant, size=len(text))

    def controlled(self, data: bytes, limits: Limits) -> Expectation:
        """Expect, in addition, that it is about a loop with the controller in a controller file."""
        controller, made_for, saturation = read_controller_file(data, limits)
        return replace(self, controller=controller, made_for=made_for, saturation=saturation)

    def saying(self, data: bytes, limits: Limits) -> Expectation:
        """Expect, in addition, a statement: as text, digest, line of a verdict, or claim.

        Raises
        ------
        Refused
            If the text is neither.
        """
        if data.lstrip()[:1] == b"{":
            with limited(current(limits.work), len(data)):
                return self._claiming(parse(data, limits))
        text = data.decode("ascii", "replace").strip()
        if DIGEST.fullmatch(text.lower()):
            return replace(self, statement=text.lower())
        line = LINE.fullmatch(text)
        if not line or not text.isascii() or len(text.splitlines()) != 1:
            malformed("file", f"expected a statement, its SHA-256, or {CLAIM}")
        digest = digest_of(line[2])
        if line[1] not in (None, digest):
            malformed("file", f"the statement has not the digest before it, but {digest}")
        return replace(self, statement=digest)

    def _claiming(self, value: Json) -> Expectation:
        """Expect, in addition, a claim of a kind, about the subject if one is expected already."""
        if "claim" not in value:
            malformed("file", f'expected {CLAIM}, found no "claim"')
        kind, claim, steps = fields(value, "file", "kind", "claim", optional=("subject",))
        subject = self.subject or [] if steps is None else items(steps, "subject")
        if not isinstance(claim, dict):
            malformed("claim", f"expected an object, found {shown(claim)}")
        return replace(self, kind=string(kind, "kind"), subject=subject, claim=claim)

    def named(self, value: str, beside: Beside, limits: Limits) -> Plant:
        """The plant that a certificate names by its digest: the expected one, or its file's."""
        if not DIGEST.fullmatch(value):
            malformed("system", f"expected a system or its SHA-256, found {shown(value)}")
        expected = self.plant is not None and value == self.system
        data = None if expected else kept(("file", value), lambda: beside(value))
        if data is None and self.plant is None:
            message = f"give the system of digest {value} (--system), or {value}{PLANT} beside it"
            incomplete("system", "system", message)
        if data is None:
            self._require_system(value, "")
        current(limits.work).grant(self.size if data is None else len(data))
        return kept(("plant", value), lambda: self._read(value, data, limits))

    def _read(self, value: str, data: bytes | None, limits: Limits) -> Plant:
        """The expected plant, or the one of this digest in a file, which has no other bytes."""
        if data is None:
            return plant_of(self.plant)
        right = len(data) > limits.bytes or hashlib.sha256(data).hexdigest() == value
        require(right, "digest", "system", f"not the bytes of {value}{PLANT}")
        return plant_of(parse_canonical(data, limits))

    def require_plant(self, digest: str, values: str, named: str, ranged: bool = False) -> None:
        """Stop unless the certificate is about the plant, or about a box around it.

        ``digest`` is the digest of the certificate's plant, ``values`` that of it without radii,
        and ``named`` the one that controllers are made for; of a plant whose parameters are
        ``ranged`` they are made for some values.
        """
        self._require_system(digest, values)
        message = f"about the system of digest {named}, the controller is for {self.made_for}"
        fits = ranged or self.made_for in ("", named)
        require_asked(fits, "controller", "system", message)

    def _require_system(self, digest: str, values: str) -> None:
        message = f"about another system, of digest {digest}, not {self.system}"
        require_asked(self.system in ("", digest, values), "system", "system", message)

    def require_subject(self, steps: Json, digest: str) -> None:
        """Stop unless the certificate has the subject, and the controller where one is given."""
        expected = self.subject
        if self.controller and (digest or not self.among):
            require_asked(bool(digest), "controller", "subject", "about no closed loop")
            message = f"about another controller, of digest {digest}, not {self.controller}"
            require_asked(digest == self.controller, "controller", "subject", message)
            if expected is None and not self.statement:
                # the digest that the controller names has the step
                expected = sampling_of(steps) if self.made_for else []
            if expected is not None and not looped(expected):
                expected = [*expected, *(step for step in steps[-1:] if looped([step]))]
        if expected is not None:
            names = ", ".join(made_by(steps)) or "none"
            message = f"another subject than asked for; its constructions are: {names}"
            require_asked(same(steps, expected), "expected", "subject", message)

    def require_statement(self, kind: str, claim: Json, statement: str) -> None:
        """Stop unless the certificate makes the statement, or the claim of its kind."""
        other = f"a claim of another kind, {kind}"
        require_asked(self.kind in ("", kind), "expected", "kind", other)
        other = f"it states something else: {statement}"
        require_asked(self.statement in ("", digest_of(statement)), "expected", "claim", other)
        if self.saturation and kind == "saturation":
            message = "other limits or anti-windup gains than those of the controller's file"
            right = saturation.agrees(claim, self.saturation)
            require_asked(right, "controller", "claim", message)
        right = self.claim is None or same(claim, self.claim)
        message = f"another claim, which differs in {difference(claim, self.claim)}"
        require_asked(right, "expected", "claim", f"{message} and states: {statement}")


def looped(steps: Json) -> bool:
    """Whether the last construction is a loop."""
    return any(name in LOOPS for name in made_by(steps)[-1:])


def difference(claim: Json, asked: Json) -> str:
    """The keys in which two claims differ, as a message shows them."""
    asked = asked or {}
    keys = {k for k in claim.keys() & asked.keys() if not same(claim[k], asked[k])}
    return ", ".join(map(shown, sorted(keys | claim.keys() ^ asked.keys())))


def made_by(steps: Json) -> list[Json]:
    """The names of constructions."""
    return [step.get("construction") if isinstance(step, dict) else None for step in steps]


def sampling_of(steps: Json) -> list[Json]:
    """The first construction, if it samples the plant."""
    return [step for step in steps[:1] if made_by([step]) == [SAMPLED]]


def sampled_again(steps: Json, base: Json) -> bool:
    """Whether a subject begins with a plant that is sampled as another one, but for its step."""
    first = [*sampling_of(steps), *sampling_of(base)]
    alike = [{**step, "step": None} for step in first]
    return len(base) == 1 and len(first) == 2 and same(*alike)


def same(a: Json, b: Json) -> bool:
    """Whether two values are equal as JSON: true differs from 1, and keys have no order."""
    if type(a) is not type(b):
        return False
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return bool(a == b)


# The table of certificate kinds, and the one function that gives the verdict VALID.

FORMAT = "mcexact-certificate/1"
T = TypeVar("T")


@dataclass(frozen=True)
class Rule:
    """The rule of one kind of certificates.

    Attributes
    ----------
    check : callable
        ``check(claim, witness, system)`` stops unless the witness proves the claim.
    statement : callable
        ``statement(claim, system)`` says the claim in words, from the claim and the subject alone.
    feedthrough : bool
        Whether it may be about a system with feedthrough: no claim of it depends on D.
    """

    check: Callable[..., None]
    statement: Callable[..., str]
    feedthrough: bool = False


KINDS = {
    "assignability": Rule(modes.check_assignability, modes.assignability_statement),
    "box_controllable": Rule(boxes.check_box_controllable, boxes.box_controllable_statement),
    "box_fixed": Rule(boxes.check_box_fixed, boxes.box_fixed_statement),
    "box_stable": Rule(boxes.check_box_stable, boxes.box_stable_statement),
    "closed_loop_spectrum": Rule(
        loops.check_closed_loop_spectrum, loops.closed_loop_spectrum_statement
    ),
    "common_dimension": Rule(sharing.check_common_dimension, sharing.common_dimension_statement),
    "communication": Rule(sharing.check_communication, sharing.communication_statement),
    "complementary_subsystem": Rule(
        structure.check_complementary_subsystem, structure.complementary_subsystem_statement
    ),
    "completeness": Rule(fixed_modes.check_completeness, fixed_modes.completeness_statement),
    "controllability": Rule(
        reach.check_controllability, reach.controllability_statement, feedthrough=True
    ),
    "controllability_indices": Rule(
        structure.check_controllability_indices,
        structure.controllability_indices_statement,
        feedthrough=True,
    ),
    "cost_bound": Rule(performance.check_cost_bound, performance.cost_bound_statement),
    "deficiency": Rule(modes.check_deficiency, modes.deficiency_statement),
    "disk_margin": Rule(performance.check_disk_margin, performance.disk_margin_statement),
    "distributed_observer": Rule(
        loops.check_distributed_observer, loops.distributed_observer_statement
    ),
    "exceptional_gains": Rule(
        structure.check_exceptional_gains, structure.exceptional_gains_statement
    ),
    "fixed_spectrum": Rule(fixed_modes.check_fixed_spectrum, fixed_modes.fixed_spectrum_statement),
    "loop_cost": Rule(performance.check_loop_cost, performance.loop_cost_statement),
    "neighbor_graph": Rule(structure.check_neighbor_graph, structure.neighbor_graph_statement),
    "parametric_box_controllable": Rule(
        boxes.check_parametric_box_controllable, boxes.parametric_box_controllable_statement
    ),
    "parametric_box_fixed": Rule(
        boxes.check_parametric_box_fixed, boxes.parametric_box_fixed_statement
    ),
    "parametric_box_stable": Rule(
        boxes.check_parametric_box_stable, boxes.parametric_box_stable_statement
    ),
    "parametric_fixed_spectrum": Rule(
        parameters.check_parametric_fixed_spectrum, parameters.parametric_fixed_spectrum_statement
    ),
    "parametric_rank": Rule(parameters.check_parametric_rank, parameters.parametric_rank_statement),
    "pencil_rank": Rule(modes.check_pencil_rank, modes.pencil_rank_statement),
    "saturation": Rule(saturation.check_saturation, saturation.saturation_statement),
    "sector": Rule(performance.check_sector, performance.sector_statement),
    "setpoint": Rule(reach.check_setpoint, reach.setpoint_statement),
    "shared_dimensions": Rule(sharing.check_shared_dimensions, sharing.shared_dimensions_statement),
    "sharing_gap": Rule(sharing_gap.check_sharing_gap, sharing_gap.sharing_gap_statement),
    "single_channel_gains": Rule(
        structure.check_single_channel_gains, structure.single_channel_gains_statement
    ),
    "stability": Rule(loops.check_stability, loops.stability_statement),
    "step_peaks": Rule(steps.check_step_peaks, steps.step_peaks_statement),
    "structural_fixed_modes": Rule(
        patterns.check_structural_fixed_modes, patterns.structural_fixed_modes_statement
    ),
    "transfer_graph": Rule(reach.check_transfer_graph, reach.transfer_graph_statement),
}
"""The rule of each kind."""


def check_document(
    data: bytes | Mapping[str, Json],
    expected: Expectation | None = None,
    limits: Limits | None = None,
    beside: Beside | None = None,
) -> Verdict:
    """Check one certificate.

    Parameters
    ----------
    data : bytes or mapping
        The text of the file, or the document that it would parse to.
    expected : Expectation, optional
        What the certificate must be about, and what it must say.
    limits : Limits, optional
    beside : callable, optional
        What gives the files of plants that stand beside the certificate; by default there is none.

    Returns
    -------
    Verdict
        After anything unexpected, including an exception, the verdict is not VALID.
    """
    return Check(expected or Expectation(), limits or Limits(), beside or nothing_beside).of(data)


def nothing_beside(digest: str) -> None:
    """No file of a plant, for a certificate that is in no folder."""


@dataclass
class Check:
    """The check of one certificate, and what it was about if that could be read.

    Attributes
    ----------
    wanted : Expectation
    allowed : Limits
    beside : callable
    digest, controller : str
        The digests of the plant and of the controller.
    document, plant, system, words : object
        The certificate, its plant, its subject, and the words of its claim.
    """

    wanted: Expectation
    allowed: Limits
    beside: Beside
    digest: str = ""
    controller: str = ""
    document: Json = None
    plant: Any = None
    system: Any = None
    words: str = ""

    def of(self, data: bytes | Mapping[str, Json]) -> Verdict:
        """The verdict on a certificate."""
        budget = current(self.allowed.work)
        before = budget.spent
        verdict = attempt(lambda: self._verdict(data, budget))
        plant, controller = self.digest, self.controller
        verdict = replace(verdict, system_digest=plant, controller_digest=controller)
        return replace(verdict, spent=budget.spent - before)

    def _verdict(self, data: bytes | Mapping[str, Json], budget: Budget) -> Verdict:
        """VALID, or the exception `Refused`."""
        text, wanted = data if isinstance(data, bytes) else _text(data), self.wanted
        with limited(budget, len(text)):
            self.document = parse(text, self.allowed)
            kind, _, steps, claim, witness = _parts(self.document)
            self.read_plant()
            ranged = isinstance(self.plant, FunctionSystem)
            budget.times = MORE if ranged else budget.times
            values = digest_of_values(self.plant, self.digest)
            wanted.require_plant(self.digest, values, self._named(values), ranged)
            budget.builds = True
            self.build_subject()
            budget.builds = False
            wanted.require_subject(steps, self.controller)
            loop = getattr(self.system, "loop", None)
            if loop is not None and loop.system.D is not None and kind not in OF_MATRICES:
                message = f"{kind} is not known for loops of systems with feedthrough"
                incomplete("feedthrough", "system", message)
            if getattr(self.system, "D", None) is not None and not KINDS[kind].feedthrough:
                message = f"{kind} is not known for systems with feedthrough"
                incomplete("feedthrough", "system", message)
            KINDS[kind].check(claim, witness, self.system)
            self.words = KINDS[kind].statement(claim, self.system)
            statement = f"For {described(self.system)}: {self.words}"
            wanted.require_statement(kind, claim, statement)
            words = summary(self.document, self.system, self.words)
            return Verdict("VALID", statement, digest_of(statement), words)

    def _named(self, values: str) -> str:
        """The digest that controllers name: that of the sampled plant, if it is sampled first."""
        steps = sampling_of(self.document["subject"]) if self.wanted.made_for else []
        if not steps or isinstance(self.plant, FunctionSystem) or self.wanted.at_samples:
            return values
        steps = self.wanted.base if sampled_again(steps, self.wanted.base) else steps
        held = read_subject(steps, at_values(self.plant))
        return plant_digest(replace(held, uncertainty=None))

    def read_plant(self) -> None:
        """Read the plant of the certificate, whose words are its digest."""
        value = self.document["system"]
        if type(value) is str:
            plant, known = self.wanted.named(value, self.beside, self.allowed), value
        else:
            known = digest_of(canonical_json(value))
            plant = kept(("plant", known), lambda: plant_of(value))
        self.plant = kept("named", lambda: replace(plant, words=f"the plant {known}"), plant)
        self.digest = known

    def build_subject(self) -> None:
        """Apply the constructions of the certificate to its plant."""
        kind, steps = self.document["kind"], self.document["subject"]
        name = "subject", kind, canonical_json(steps)
        self.system = kept(name, lambda: subject_of(steps, self.plant, kind), self.plant)
        self.controller = self.system.controller


OF_MATRICES = ("closed_loop_spectrum", "stability")
"""The kinds about loops that depend on the matrix of the loop alone."""
Found = tuple[dict[str, str], Verdict]
"""A verdict behind what it is about: a ``file``, or the ``text`` of a sentence."""


def refusal(verdict: str, code: str, place: str, message: str) -> Verdict:
    """A verdict that proves nothing, and why."""
    return Verdict(verdict, code=code, place=place, message=message)


def attempt(work: Callable[[], T]) -> T | Verdict:
    """Do some work, and turn an exception into a verdict."""
    digits = sys.get_int_max_str_digits()
    try:
        # The reader limits the number of digits; the interpreter's own limit would stop some
        # messages.
        sys.set_int_max_str_digits(0)
        return work()
    except Refused as refused:
        return refusal(*refused.args)
    except MemoryError:
        return refusal("INCOMPLETE", "memory", "checker", "more memory than there is")
    except NotAUnit:
        return refusal("INVALID", "unit", "witness.modulus", "a number is not invertible modulo l")
    except Exception as error:
        message = f"{type(error).__name__}: {error}".splitlines()[0][:200]
        return refusal("ERROR", "internal", "checker", ascii(message))
    finally:
        sys.set_int_max_str_digits(digits)


def _text(document: Json) -> bytes:
    """The text of a document in memory, which is then read as strictly as a file."""
    try:
        return json.dumps(dict(document)).encode("ascii")
    except (TypeError, ValueError, RecursionError) as error:
        malformed("file", f"expected a document of JSON: {ascii(str(error))[1:101]}")


def _parts(document: Json) -> list[Json]:
    """The five parts of a certificate of a known version and kind."""
    if not isinstance(document, Mapping):
        malformed("file", f"expected a certificate, found {shown(document)}")
    version = string(document.get("format"), "format")
    if version != FORMAT:
        if version.startswith(FORMAT.partition("/")[0] + "/"):
            incomplete("version", "format", f"{shown(version)} is not a version known here")
        malformed("format", f"expected {FORMAT!r}, found {shown(version)}")
    _, *parts = fields(document, "file", "format", "kind", "system", "subject", "claim", "witness")
    if string(parts[0], "kind") not in KINDS:
        incomplete("kind", "kind", f"{shown(parts[0])} is not a kind known here")
    return parts


# Limits of a run: time, also while it waits for a file, and memory.

SUPPORTED = hasattr(signal, "setitimer")
"""Whether the platform has alarms, and limits on memory."""
AGAIN = 0.05
"""Seconds between two alarms: the first is lost if Python runs a callback that ignores errors."""


class OutOfTime(BaseException):
    """The time is over; no handler of errors takes this for one of its own."""


class Clock:
    """A limit on the time of a run.

    Parameters
    ----------
    seconds : float or None
        None means that there is no limit.
    """

    def __init__(self, seconds: float | None = None) -> None:
        self.seconds, self.over, self.armed = seconds, False, False

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        """Let the time run."""
        if self.seconds is None:
            yield
            return
        before = signal.signal(signal.SIGALRM, self._ring)
        signal.setitimer(signal.ITIMER_REAL, min(self.seconds, 1e9), AGAIN)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        self.over = True
        if self.armed:
            raise OutOfTime

    def within(self, work: Callable[[], T]) -> T:
        """Do some work, which OutOfTime interrupts; it is raised here and nowhere else."""
        try:
            self.armed = True
            if self.over:
                raise OutOfTime
            return work()
        finally:
            self.armed = False

    def verdict(self) -> Verdict:
        """The verdict on what there was no time for."""
        self.armed = False
        message = f"not decided after {self.seconds:g} s (--timeout allows more)"
        return Verdict("INCOMPLETE", code="time", place="checker", message=message)

    def limited(self, verdicts: Iterator[Found], about: dict[str, str]) -> Iterator[Found]:
        """Yield the same verdicts as long as there is time, then an INCOMPLETE one."""
        try:
            while (item := self.within(lambda: next(verdicts, None))) is not None:
                yield item
        except OutOfTime:
            yield about, self.verdict()


@contextlib.contextmanager
def memory(mebibytes: int | None) -> Iterator[None]:
    """Limit the memory that may be added to what the process occupies now."""
    if mebibytes is None:
        yield
        return
    import resource

    occupied = 0
    with contextlib.suppress(OSError), open("/proc/self/statm", encoding="ascii") as pages:
        occupied = int(pages.read().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    most = min(occupied + mebibytes * 2**20, 2**62 if hard == resource.RLIM_INFINITY else hard)
    resource.setrlimit(resource.RLIMIT_AS, (most, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
