"""Verify certificates, and print one line for each.

The line is VALID and what the certificate proves in short, with --statements the SHA-256 of the
statement and the whole statement; or INVALID, MALFORMED or INCOMPLETE, a code and a place; or NOT
ABOUT, if it is about another plant, loop or claim than asked for. With several files it names its
file. A file named manifest.json is read as a manifest: its certificates have numbers, and each of
its sentences is quoted behind what follows from its premises, which have numbers. A folder stands
for its manifest, and without one for all its certificates. With --controller there is nothing else
in the loop unless --expect says so; of several certificates, those about no loop are about the
plant. Work is limited by default to 40,000,000 units and 4,000 for each byte, four times as many if
the plant has a parameter.
"""

import argparse
import errno
import hashlib
import io
import json
import os
import re
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import IO, NoReturn

from . import sentences_loops, sentences_nearby, sentences_parameters, sentences_performance
from .cells import constructed
from .core import reading
from .core.budget import Budget, Kept, current, keeping, limited, spend
from .core.reading import (
    Json,
    Limits,
    Refused,
    fields,
    items,
    malformed,
    parse,
    read_file,
    require,
    shown,
    string,
)
from .core.system import System, counted
from .discs import at_values
from .kinds import (
    CLAIM,
    DIGEST,
    NOT_ABOUT,
    PLANT,
    SUPPORTED,
    Beside,
    Check,
    Clock,
    Expectation,
    Found,
    OutOfTime,
    Verdict,
    attempt,
    check_document,
    made_by,
    memory,
    nothing_beside,
    refusal,
    require_asked,
    same,
    sampled_again,
)
from .page import Audit, bytes_of
from .parametric_system import FunctionSystem, digest_of_values
from .sentences import ANOTHER_STEP, AT_SAMPLES, RULES, Premise
from .sentences_loops import CLOSED
from .sentences_performance import held_from
from .summaries import cut
from .wording import Places, known_numbers, left_open, wordings

# Manifests: sentences, and the certificates that imply them; ``FORMAT.md`` specifies them.

RULE_MODULES = (sentences_loops, sentences_nearby, sentences_parameters, sentences_performance)
"""The modules that enter their rules into `RULES` when they are imported, besides `sentences`."""
MANIFEST_FORMAT = "mcexact-manifest/1"
NAME = "manifest.json"
FILE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_+-]{0,99}\.json")
"""The name of a certificate's file beside the manifest, which is not a path on any system."""
POINTER = re.compile(r"(?:/(?:[^/~]|~[01])*+)*+")
INDEX = re.compile(r"0|[1-9][0-9]{0,9}")
WITH_DIGEST = re.compile(r" with SHA-256 [0-9a-f]{64}")
NUMBER = re.compile(r"\[[0-9]+\]")
"""The number of a certificate, in place of its statement."""
MOST_CUT = 200
"""The most characters of what follows from premises, on a line."""
Read = Callable[[str], bytes]
"""What gives the bytes of a certificate by its name, and of the manifest by ""."""


def manifest_verdicts(path: str, expected: Expectation, limits: Limits) -> Iterator[Found]:
    """Yield verdicts on the manifest if unreadable, on certificates, and on sentences.

    Parameters
    ----------
    path : str
        A manifest, or a folder that contains one under its usual name.
    expected : Expectation
        The plant of all certificates, by default that of the first one, and the controller of all
        closed loops, of which there must then be one.
    limits : Limits
        For the manifest and for each certificate.
    """
    path = manifest_file(path)
    beside = plants_beside(path, limits)
    return verdicts_of(lambda name: _bytes(path, name, limits), expected, limits, beside)


def manifest_file(manifest: str) -> str:
    """The file of a manifest, which may be named by its folder; never standard input."""
    folder = os.path.isdir(manifest)
    return os.path.join(manifest, NAME) if folder else os.path.join(".", manifest)


def verdicts_of(
    read: Read, expected: Expectation, limits: Limits, beside: Beside = nothing_beside
) -> Iterator[Found]:
    """The verdicts on a manifest from anywhere: ``read`` takes the name of a file, or "" for it."""
    budget = current(limits.work)

    def start() -> tuple[Json, ...]:
        one = not expected.statement and expected.claim is None
        require(one, "expected", "file", "a manifest makes more than one statement")
        data = read("")
        with limited(budget, len(data)):
            return _parts(parse(data, limits))

    parts = attempt(start)
    if isinstance(parts, Verdict):
        yield {"file": NAME}, parts
        return
    digests, sentences, base, nearby = parts
    known = Evidence(read, base, limits, expected, budget, nearby, beside)
    for k, name in enumerate(sorted(digests), 1):
        yield {"file": name, "number": str(k)}, known.taken(name, digests[name])
    refused = attempt(known.make_subject)
    if refused is not None:
        yield {"file": NAME}, refused
        return
    if expected.controller and not any(each.system.controller for each in known.premises.values()):
        yield {"file": NAME}, refusal(NOT_ABOUT, "controller", "file", "about no closed loop")
    strange = attempt(known.require_held) if expected.controller else None
    if strange is not None:
        yield {"file": NAME}, strange
    numbers = {name: str(k) for k, name in enumerate(sorted(digests), 1)}
    for k, sentence in enumerate(sentences):
        cited = dict.fromkeys(numbers[name] for name, *_ in sentence["because"])
        about = {key: sentence[key] for key in ("text", "rule")} | {"premises": ", ".join(cited)}
        yield about, known.judged(sentence, f"sentences[{k}]")


def _bytes(manifest: str, name: str, limits: Limits) -> bytes:
    """Read a regular file beside a manifest, or without a name the manifest itself.

    A link to a manifest is followed, and one to a certificate is not.
    """
    path = os.path.join(os.path.dirname(manifest), name) if name else manifest
    if name:
        require(os.path.lexists(path), "missing", "file", "is not beside the manifest")
        regular = os.path.isfile(path) and not os.path.islink(path)
        require(regular, "file", "file", "not a regular file of this folder")
    elif os.path.exists(path) and not os.path.isfile(path):
        malformed("file", "a manifest is a regular file")
    return reading.read_file(path, limits)


def plants_beside(path: str, limits: Limits) -> Beside:
    """What reads the regular files of plants in the folder of a file, which are no links."""
    folder = os.path.dirname(path)

    def read(digest: str) -> bytes | None:
        beside = os.path.join(folder, digest + PLANT)
        if not os.path.lexists(beside):
            return None
        regular = os.path.isfile(beside) and not os.path.islink(beside)
        require(regular, "file", "system", f"{digest}{PLANT} is not a regular file of this folder")
        return reading.read_file(beside, limits)

    return read


def _parts(document: Json) -> tuple[Json, ...]:
    """Read the digests by name, the sentences, the subject, and what is about nearby plants."""
    required, more = ("format", "certificates", "sentences"), ("subject", "nearby")
    version, listed, sentences, base, near = fields(document, "manifest", *required, optional=more)
    if string(version, "format") != MANIFEST_FORMAT:
        malformed("format", f"expected {MANIFEST_FORMAT!r}, found {shown(version)}")
    if not isinstance(listed, dict) or not items(sentences, "sentences"):
        malformed("manifest", "expected digests by the names of files, and at least one sentence")
    for name, value in listed.items():
        if not FILE.fullmatch(name) or name == NAME:
            malformed("certificates", f"expected a name such as setpoint.json, found {shown(name)}")
        if not DIGEST.fullmatch(string(value, "certificates")):
            malformed("certificates", f"expected a SHA-256 in hexadecimal, found {shown(value)}")
    for k, sentence in enumerate(sentences):
        place = f"sentences[{k}]"
        *texts, because = fields(sentence, place, "text", "rule", "theorem", "because")
        for name, pointer, _ in (items(entry, place, 3) for entry in items(because, place)):
            texts += [name, pointer]
            if string(name, place) not in listed:
                malformed(place, f"{shown(name)} is not a certificate of this manifest")
        for text in texts:
            string(text, place)
    nearby = [] if near is None else [string(each, "nearby") for each in items(near, "nearby")]
    if nearby != sorted({*nearby}) or not {*nearby} <= listed.keys():
        malformed("nearby", "expected names of certificates of this manifest, sorted, each once")
    return listed, sentences, [] if base is None else items(base, "subject"), nearby


@dataclass
class Evidence:
    """The certificates of a manifest, all about one plant.

    Attributes
    ----------
    read : callable
        The bytes of a certificate by its name.
    base : list
        The constructions that lead to the system that the sentences are about.
    limits : Limits
    expected : Expectation
        The plant, by default the values of that of the first VALID certificate, around which others
        may be about boxes; and the controller of all loops.
    budget : Budget
        The work that all of them may take together.
    nearby : collection of str
        The names of certificates that may be about another plant, with the controller of the loops.
    beside : callable
        The bytes of the file of a plant, by its digest.
    verdicts, premises : dict
        The verdicts on all certificates, and the premises made of VALID ones.
    kept : dict
        What is made once for all certificates.
    """

    read: Read
    base: list[Json]
    limits: Limits
    expected: Expectation
    budget: Budget = field(default_factory=lambda: current(None))
    nearby: Collection[str] = ()
    beside: Beside = nothing_beside
    verdicts: dict[str, Verdict] = field(default_factory=dict)
    premises: dict[str, Premise] = field(default_factory=dict)
    kept: Kept = field(default_factory=dict)

    def taken(self, name: str, wanted: str) -> Verdict:
        """Check one certificate; if it is VALID it becomes a premise."""

        def check() -> Verdict:
            data = self.read(name)
            large = len(data) > self.limits.bytes
            right = large or hashlib.sha256(data).hexdigest() == wanted
            require(right, "digest", "file", "not the bytes that the manifest names")
            with limited(self.budget), keeping(self.kept):
                held = not self.base
                any_loop = replace(self.expected, controller="", base=self.base, at_samples=held)
                any_loop = Expectation() if name in self.nearby else any_loop
                found = Check(any_loop, self.limits, self.beside)
                verdict = found.of(data)
                if verdict.verdict == "VALID":
                    steps = found.document["subject"]
                    # that of a loop of samples is compared when all loops are known
                    if found.controller and (self.base or tuple(made_by(steps)) != AT_SAMPLES):
                        self.expected.require_subject(steps, found.controller)
                    self.premises[name] = self._premise(name, found)
                    if name in self.nearby:
                        verdict = replace(verdict, summary=f"of a plant nearby: {verdict.summary}")
                return verdict

        self.verdicts[name] = attempt(check).inside(name)
        return self.verdicts[name]

    def make_subject(self) -> None:
        """Make the system that the sentences are about, out of the plant of the certificates."""
        known = sorted(self.own(), key=lambda each: is_uncertain(each.plant))
        first = next(iter(known), None)
        if first is not None:
            with limited(self.budget):
                meant = constructed(self.base, first.plant)
            for name, each in self.premises.items():
                self.premises[name] = replace(each, meant=meant)

    def require_held(self) -> None:
        """Stop unless every loop of samples has the controller of a loop in continuous time."""
        loops = [each for each in self.own() if each.path in CLOSED]
        for known in [] if self.base else [e for e in self.own() if e.path == AT_SAMPLES]:
            with limited(self.budget):
                held = any(held_from(known, loop) for loop in loops)
            message = "about another controller than that of the loop at samples, by Tustin's rule"
            require_asked(held, "controller", known.file, message)

    def own(self) -> list[Premise]:
        """The certificates about the plant of the manifest, or boxes around it."""
        return [each for each in self.premises.values() if not each.nearby]

    def _premise(self, name: str, found: Check) -> Premise:
        """A certificate that was found VALID."""
        document, known, system = found.document, found.plant, found.system
        nearby, steps = name in self.nearby, document["subject"]
        if not (self.expected.system or nearby):
            values = digest_of_values(known, found.digest)
            self.expected = replace(self.expected, system=values)
        plant = known if isinstance(known, FunctionSystem) else at_values(known)
        own = same(steps[: len(self.base)], self.base)
        path = tuple(step["construction"] for step in steps[len(self.base) :]) if own else None
        if fails_first(steps, self.base):
            path = tuple(step["construction"] for step in [steps[0], *steps[len(self.base) + 1 :]])
        elif not own and sampled_again(steps, self.base):
            path = (ANOTHER_STEP, *(step["construction"] for step in steps[1:]))
        statement = f"For {system.words}: {found.words}"
        return Premise(name, document, plant, system, plant, statement, path, nearby=nearby)

    def judged(self, sentence: dict[str, Json], place: str) -> Verdict:
        """The verdict on one sentence."""
        key, because = sentence["rule"], sentence["because"]

        def check() -> Verdict:
            if key not in RULES:
                raise Refused("INCOMPLETE", "rule", "rule", "not a rule known here")
            theorem = RULES[key].theorem
            named = sentence["theorem"] == theorem
            require(named, "theorem", "theorem", f"expected {theorem or 'none'}")
            spend(1000 + 10 * len(because))
            cited = list(dict.fromkeys(name for name, *_ in because))
            for name in cited if self.own() else self.verdicts:
                verdict = self.verdicts[name]
                open_ = "INCOMPLETE" if verdict.status == 5 else "INVALID"
                if name not in self.premises:
                    raise Refused(open_, "premise", name, f"this certificate is {_judged(verdict)}")
            for name, pointer, value in because:
                entry = pointed(self.premises[name].document, pointer, name)
                require(same(entry, value), "value", name, f"another value at {shown(pointer)}")
            require(bool(self.own()), "premise", "because", "no certificate is about the plant")
            spend(2 * len(cited) * len(because) + 100 * len(self.premises))
            pointers = {name: tuple(p for n, p, _ in because if n == name) for name in cited}
            premises = [replace(self.premises[name], pointers=pointers[name]) for name in cited]
            words = RULES[key].implied(premises, [*self.premises.values()])
            left = self._left_open(sentence, words, premises)
            short = self._in_short(words, premises)
            words += f" [{theorem}]" if theorem else ""
            spend(len(words))
            if not RULES[key].claims:
                return Verdict("REMARK", words)
            words += f" from {', '.join(cited)}" if cited else ""
            return Verdict("IMPLIED", words, summary=short, left_open=left)

        with limited(self.budget):
            return attempt(check).inside(f"{place} {shown(key)}")

    def _left_open(
        self, sentence: dict[str, Json], words: str, premises: Sequence[Premise]
    ) -> Places:
        """The places of a text that are not compared; stop unless the others are as they should be.

        They are what the rule says, with the numbers that follow.
        """
        if not sentence["text"]:
            return ()
        for premise in premises:
            words = words.replace(premise.statement, "")
        known = known_numbers(sentence["because"], words)
        places = left_open(sentence["text"], wordings()[sentence["rule"]], known)
        if places is None:
            message = "other words than those of its rule, or other numbers"
            raise Refused("INVALID", "text", "text", message)
        return places

    def _in_short(self, words: str, premises: Sequence[Premise]) -> str:
        """What follows, in one line: without digests, and with numbers for whole statements.

        Where that is what one of the certificates states, it is the summary of this.
        """
        numbers = {name: k for k, name in enumerate(self.verdicts, 1)}
        for premise in premises:
            words = words.replace(premise.statement, f"[{numbers[premise.file]}]")
        short = words.replace(self.own()[0].plant.words, "the plant").removeprefix("For ")
        short = WITH_DIGEST.sub("", short.removeprefix("the plant: "))
        short = short.replace(
            "the closed loop with the controller of: the plant: ", "closed loop: "
        )
        alone = [each.file for each in premises if short == f"[{numbers[each.file]}]"]
        return self.verdicts[alone[0]].summary if alone else short


def fails_first(steps: list[Json], base: list[Json]) -> bool:
    """Whether a subject is made as the system of the manifest, of the plant after failures."""
    failed = [step["construction"] for step in steps[:1]] == ["failed"]
    return failed and same(steps[1 : len(base) + 1], base)


def is_uncertain(plant: System | FunctionSystem) -> bool:
    """Whether entries of a plant have radii."""
    return isinstance(plant, System) and plant.uncertainty is not None


def pointed(document: Json, pointer: str, place: str) -> Json:
    """The value to which a JSON pointer (RFC 6901) leads."""
    node, good = document, bool(POINTER.fullmatch(pointer))
    for token in pointer.split("/")[1:]:
        key = token.replace("~1", "/").replace("~0", "~")
        if isinstance(node, list) and INDEX.fullmatch(key) and int(key) < len(node):
            node = node[int(key)]
        elif isinstance(node, dict) and key in node:
            node = node[key]
        else:
            good = False
    require(good, "pointer", place, f"{shown(pointer)} points to nothing")
    return node


def _judged(verdict: Verdict) -> str:
    """What a sentence says of a premise that it cannot have."""
    return verdict.message if verdict.verdict == NOT_ABOUT else "not VALID"


# Verify certificates, and print one line for each.

PRECEDENCE = (70, 3, 1, 5, 0)
"""Of these statuses the first that any verdict has is that of the run."""
FORMAT = "mcexact-verdicts/1"
UNWRITTEN = 74
"""The status if the verdicts cannot be written."""


Asking = Sequence[str | None]
"""The files that hold a system, a controller, and a statement or claim; None for any."""


class NotAsked(Exception):
    """What a file asks cannot be read; the verdict on this file says why."""

    def __init__(self, path: str, verdict: Verdict) -> None:
        place = f"{ascii(path)[1:-1]}: {verdict.place}"
        super().__init__(as_options(f"{place}: {verdict.message}"))
        self.found: Found = {"file": path}, verdict


def as_options(text: str) -> str:
    """A message that names the limits as options."""
    return text.replace("(Limits.", "(--max-")


def line_of(result: Found, *, named: bool, statements: bool = False) -> str:
    """A verdict as one line; ``named`` with the name of its file, ``statements`` with all words.

    A certificate of a manifest has its number before its name.  Of a sentence that is implied, the
    numbers of its premises come first, and in words of the checker what follows from them; its
    text is quoted at the end, with the words that were not compared.
    """
    about, verdict = result
    if "text" in about:
        text = about["text"]
        name = ascii(text)
        name = cut(name, MOST_CUT) if verdict.status and not statements else name
        if verdict.verdict == "IMPLIED":
            by = f"by {about['premises']}" if about["premises"] else ""
            verdict = replace(verdict, summary=cut(verdict.summary, MOST_CUT))
            open_ = ", ".join(ascii(text[start:end]) for start, end in verdict.left_open)
            words = f"{verdict.line(by, short=not statements)}; in the report: {name}"
            return as_options(f"{words}; compare {open_}" if open_ else words)
    else:
        name = ascii(about["file"]) if named or "number" in about else ""
        name = f"{about['number']} {name}" if "number" in about else name
    return as_options(verdict.line(name, short=not statements))


def misuse(paths: Sequence[str], manifest: str | None, asking: Asking, bounded: bool) -> str:
    """Why the arguments contradict each other, or nothing."""
    if not paths and manifest is None:
        return "expected a FILE or --manifest"
    if [*paths, *asking].count("-") > 1:
        return "standard input can be read once: give - once"
    many = manifest is not None or NAME in map(os.path.basename, paths)
    if many and asking[-1] is not None:
        return "a manifest makes more than one statement: leave out --expect"
    if bounded and not SUPPORTED:
        return "this platform has no limits on time and memory"
    return ""


def _expectation(
    path: str, read: Callable[..., Expectation], limits: Limits, clock: Clock
) -> Expectation:
    """The expectation that one file adds; a file that cannot be read is the error `NotAsked`."""
    try:
        expectation = clock.within(lambda: attempt(lambda: read(read_file(path, limits), limits)))
    except OutOfTime:
        expectation = clock.verdict()
    if isinstance(expectation, Verdict):
        raise NotAsked(path, expectation)
    return expectation


def _certificate(path: str, wanted: Expectation, limits: Limits) -> Iterator[Found]:
    """The verdict on the certificate in a file."""
    beside = None if path == "-" else plants_beside(path, limits)
    about = {"file": path}
    yield about, attempt(lambda: check_document(read_file(path, limits), wanted, limits, beside))


def _named(manifest: str, limits: Limits) -> set[str]:
    """The paths of the certificates that a manifest names, and therefore judges.

    A manifest that cannot be read names none: its own verdict says why.
    """

    def names() -> list[str]:
        data = read_file(manifest, limits)
        with limited(current(limits.work), len(data)):
            return list(_parts(parse(data, limits))[0])

    listed, folder = attempt(names), os.path.dirname(manifest)
    known = [] if isinstance(listed, Verdict) else listed
    return {os.path.normpath(os.path.join(folder, name)) for name in known}


def _manifest(path: str, wanted: Expectation, limits: Limits) -> Iterator[Found]:
    """The verdicts on a manifest, its certificates and its sentences, and then their numbers.

    The numbers stand with the digest of the manifest, which binds the words of its sentences and
    the bytes of its certificates, and with what nobody asked to compare with.
    """
    numbers, remarks, plant, in_loop = Counter[tuple[str, bool]](), 0, "", False
    file, digests = manifest_file(path), list[str]()

    def read(name: str) -> bytes:
        data = _bytes(file, name, limits)
        if not name:
            digests.append(hashlib.sha256(data).hexdigest())
        return data

    for about, verdict in verdicts_of(read, wanted, limits, plants_beside(file, limits)):
        own = about == {"file": NAME}
        in_loop = in_loop or bool(verdict.controller_digest)
        if verdict.verdict == "REMARK":
            remarks += 1
        elif not own:
            numbers["text" if "text" in about else "file", not verdict.status] += 1
        if "file" in about and verdict.verdict == "VALID":
            plant = plant or verdict.system_digest
        yield {"file": path} if own else {**about, "manifest": path}, verdict
    implied, rest = numbers["text", True], numbers["text", False]
    valid, other = numbers["file", True], numbers["file", False]
    lacking = ["plant"] if plant and not wanted.system else []
    lacking += ["controller"] if in_loop and not wanted.controller else []
    parts = [f"no {' and no '.join(lacking)} was given to compare with"] if lacking else []
    parts.append(f"{implied} sentences implied, {rest} not, {counted(remarks, 'remark')}")
    parts.append(f"{valid} certificates valid, {other} not")
    parts += [f"manifest of SHA-256 {digest}" for digest in digests]
    numbers_text = "; ".join(parts)
    yield {"file": path}, Verdict("COUNTED", numbers_text, system_digest=plant)


def _listed(paths: Sequence[str], manifest: str | None) -> Iterator[tuple[str, bool]]:
    """Each file, and whether it is a manifest: that of a folder, or else its certificates."""
    for path in paths:
        if os.path.isdir(path) and os.path.basename(path) != NAME:
            inside = os.path.join(path, NAME)
            found = [inside] if os.path.lexists(inside) else sorted(_certificates_in(path))
            yield from ((each, each == inside) for each in found or [path])
        else:
            yield path, os.path.basename(path) == NAME
    if manifest is not None:
        yield manifest, True


def _certificates_in(folder: str) -> list[str]:
    """The files of a folder that may be certificates."""
    with suppress(OSError):
        return [os.path.join(folder, name) for name in os.listdir(folder) if FILE.fullmatch(name)]
    return []


def verdicts(
    paths: Sequence[str], manifest: str | None, asking: Asking, limits: Limits, clock: Clock
) -> Iterator[Found]:
    """Yield each verdict after its subject, a ``file`` or the ``text`` of a sentence.

    What a manifest holds is followed by the path of the ``manifest``.

    A path that ends with the usual name of a manifest is read as a manifest, and a folder stands
    for its manifest, or else for its certificates.  Every certificate is asked for what three files
    hold: a system, a controller, and a statement or claim.  One that a manifest of this call names
    is judged with the manifest alone.  Of several certificates some may be about the plant and not
    about a loop with the controller, but not all of them.

    Raises
    ------
    NotAsked
        If one of the three cannot be read, or not in time.
    """
    wanted, new = Expectation(), Expectation
    for path, read in zip(asking, (new.about, new.controlled, new.saying), strict=True):
        if path is not None:
            wanted = _expectation(path, partial(read, wanted), limits, clock)
    listed = list(_listed(paths, manifest))
    judged: set[str] = set()
    for manifest_path in (manifest_file(path) for path, many in listed if many):
        with suppress(OutOfTime):
            judged |= clock.within(partial(_named, manifest_path, limits))
    listed = [(path, many) for path, many in listed if many or os.path.normpath(path) not in judged]
    several = replace(wanted, among=len(listed) > 1)
    loops = not wanted.controller or not several.among
    for path, many in listed:
        look = partial(_manifest, path, wanted) if many else partial(_certificate, path, several)
        for about, verdict in clock.limited(look(limits), {"file": path}):
            loops = loops or many or verdict.controller_digest == wanted.controller
            yield about, verdict
    if not loops:
        message = "none of these certificates is about a loop with this controller"
        yield {"file": str(asking[1])}, refusal(NOT_ABOUT, "controller", "subject", message)


def status_of(results: Sequence[Found]) -> int:
    """The exit status of a run with these verdicts."""
    return next(status for status in PRECEDENCE if status in {0, *(v.status for _, v in results)})


def count(text: str) -> int:
    """An integer from 1 on, in digits alone."""
    if not (text.isascii() and text.isdigit() and int(text)):
        raise argparse.ArgumentTypeError(f"expected an integer from 1 on, found {text!a}")
    return int(text)


def seconds(text: str) -> float:
    """A number of seconds above 0."""
    with suppress(ValueError):
        if 0 < float(text) < float("inf"):
            return float(text)
    raise argparse.ArgumentTypeError(f"expected a number of seconds above 0, found {text!a}")


def page_name(text: str) -> str:
    """The file of a page, which no certificate and no plant has."""
    if text.endswith(".html"):
        return text
    raise argparse.ArgumentTypeError(f"expected a name that ends with .html, found {text!a}")


OPTIONS: tuple[tuple[str, str, Callable[[str], object], str], ...] = (
    ("manifest", "FILE", str, "verify the sentences of this manifest from its certificates"),
    (
        "system",
        "FILE",
        str,
        "require this system; certificates with a digest alone need it, or the plant beside",
    ),
    ("controller", "FILE", str, "require loops of the plant with the controller in this file"),
    ("expect", "FILE", str, f"require a statement, its SHA-256, its line of a verdict, or {CLAIM}"),
    ("max-bytes", "N", count, "most bytes of a file"),
    ("max-digits", "N", count, "most digits in a row"),
    ("max-depth", "N", count, "most nested levels"),
    ("max-work", "N", count, "most units for a file, or for a manifest with its certificates"),
    ("timeout", "SECONDS", seconds, "the time of the run; what is not decided is INCOMPLETE"),
    ("max-memory", "MIB", count, "the memory that may be added; what needs more is INCOMPLETE"),
    ("html", "FILE", page_name, "write a page that an auditor can sign"),
)
"""Name, value, how it is read, and help; what begins with ``max-`` may stand in ``Limits``."""


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are ASCII that prints, whatever the arguments are."""

    def error(self, message: str) -> NoReturn:
        """End with wrong usage."""
        super().error(ascii(message)[1:-1])


def _parser() -> argparse.ArgumentParser:
    """The options, and in the help what these docstrings say."""
    parser = Parser("checker", None, __doc__, main.__doc__, allow_abbrev=False)
    parser.add_argument("files", nargs="*", metavar="FILE", help="certificates; - is the input")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    whole = "print whole statements, each behind its SHA-256, which --expect takes"
    parser.add_argument("--statements", action="store_true", help=whole)
    for name, value, read, usage in OPTIONS:
        default = getattr(Limits, name.removeprefix("max-"), None)
        usage += f" (default: {default:,})" if default else ""
        parser.add_argument(f"--{name}", metavar=value, type=read, default=default, help=usage)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status: the first that applies of 70, 3, 1, 5, 0.

    70 is a bug in this checker, 3 MALFORMED, 1 INVALID, 5 INCOMPLETE, 0 all VALID or IMPLIED, or a
    REMARK, which claims nothing; 2 is wrong usage, 74 the verdicts cannot be written, 130
    interrupted.  Python itself ends with 1 if it cannot start: a status of 1 without a line that
    says INVALID or NOT ABOUT is no verdict.
    """
    try:
        try:
            status = _run(_parser(), arguments)
        except SystemExit as end:  # help, or wrong usage
            status = int(end.code or 0)
        _flush(sys.stdout)
    except OSError as error:
        # An OSError about an input has become a verdict.
        if not isinstance(error, BrokenPipeError):
            _complain(f"the verdicts cannot be written: {error.strerror}")
        status = UNWRITTEN
        _drop(sys.stdout)
    except KeyboardInterrupt:
        status = 130
    try:
        _flush(sys.stderr)
    except OSError:
        _drop(sys.stderr)
    return status


def _run(parser: argparse.ArgumentParser, arguments: Sequence[str] | None) -> int:
    """Check what the arguments name, print the verdicts, and return the exit status."""
    options = parser.parse_args(arguments)
    files, manifest = options.files, options.manifest
    asking = options.system, options.controller, options.expect
    if wrong := misuse(files, manifest, asking, bool(options.timeout or options.max_memory)):
        parser.error(wrong)
    limits = Limits(options.max_bytes, options.max_depth, options.max_digits, work=options.max_work)
    sys.set_int_max_str_digits(0)
    # A character that the terminal's encoding lacks must not raise an error.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    results, clock = [], Clock(options.timeout)
    named = len(files) > 1 or manifest is not None or any(map(os.path.isdir, files))
    try:
        with memory(options.max_memory), clock.running():
            for each in verdicts(files, manifest, asking, limits, clock):
                results.append(each)
                if not options.json:
                    _say(line_of(each, named=named, statements=options.statements))
    except NotAsked as error:
        _complain(str(error))
        results = [error.found]
    if options.json:
        rows = [about | asdict(verdict) for about, verdict in results]
        _say(json.dumps({"format": FORMAT, "verdicts": rows}, indent=1))
    status = status_of(results)
    if options.html:
        archive = "".join(each for _, each in bytes_of(getattr(__spec__.loader, "archive", "")))
        ends = {"status": status, "last": line_of(results[-1], named=named)}
        made = {"archive": archive, "program": "the checker"}
        audit = Audit.of(results, files, manifest, asking, **ends, **made)
        with open(options.html, "w", encoding="utf-8") as page:
            page.write(audit.page())
    return status


def _say(text: str) -> None:
    """Print a line, or raise an OSError if that is impossible."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    print(text, flush=True)


def _complain(text: str) -> None:
    """Print a line on standard error, if that is possible."""
    if sys.stderr is not None:  # to print to None is to print to standard output
        with suppress(OSError):  # at the end it is tried again
            print(f"checker: {text}", file=sys.stderr, flush=True)


def _flush(stream: IO[str] | None) -> None:
    if stream is not None:
        stream.flush()


def _drop(stream: IO[str] | None) -> None:
    """Lead a stream nowhere: the interpreter flushes it at its end, which must not fail again."""
    if stream is not None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
