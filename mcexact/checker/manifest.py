"""Manifests: sentences, and the certificates that imply them; ``FORMAT.md`` specifies them."""

import hashlib
import os
import re
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field, replace

from . import (
    reading,
    sentences_analysis,
    sentences_boxes,
    sentences_design,
    sentences_parameters,
    sentences_sharing,
)
from .boxes import at_values
from .budget import Budget, current, limited, spend
from .expectation import DIGEST, Expectation, same
from .kinds import KINDS, Found, Verdict, attempt, check_document, refusal
from .moved_entries import constructed, subject_of
from .parametric_system import FunctionSystem, digest_of_values, plant_of
from .reading import (
    Json,
    Limits,
    Refused,
    fields,
    items,
    malformed,
    parse,
    require,
    shown,
    string,
)
from .sentence import RULES, Premise
from .system import System

__all__ = ["NAME", "RULES", "manifest_verdicts", "verdicts_of"]

TOPICS = (
    sentences_analysis,
    sentences_sharing,
    sentences_design,
    sentences_boxes,
    sentences_parameters,
)
"""The modules of the rules that do not belong to one kind."""
FORMAT = "mcexact-manifest/1"
NAME = "manifest.json"
FILE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_+-]{0,99}\.json")
"""The name of a certificate's file beside the manifest, which is not a path on any system."""
POINTER = re.compile(r"(?:/(?:[^/~]|~[01])*+)*+")
INDEX = re.compile(r"0|[1-9][0-9]{0,9}")
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
    path = os.path.join(path, NAME) if os.path.isdir(path) else os.path.join(".", path)
    return verdicts_of(lambda name: _bytes(path, name, limits), expected, limits)


def verdicts_of(read: Read, expected: Expectation, limits: Limits) -> Iterator[Found]:
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
    known = Evidence(read, base, limits, expected, budget, nearby)
    for name in sorted(digests):
        yield {"file": name}, known.taken(name, digests[name])
    refused = attempt(known.make_subject)
    if refused is not None:
        yield {"file": NAME}, refused
        return
    if expected.controller and not any(each.system.controller for each in known.premises.values()):
        yield {"file": NAME}, refusal("INVALID", "controller", "file", "about no closed loop")
    for k, sentence in enumerate(sentences):
        yield {"text": sentence["text"]}, known.judged(sentence, f"sentences[{k}]")


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


def _parts(document: Json) -> tuple[Json, ...]:
    """Read the digests by name, the sentences, the subject, and what is about nearby plants."""
    given, more = ("format", "certificates", "sentences"), ("subject", "nearby")
    version, listed, sentences, base, near = fields(document, "manifest", *given, optional=more)
    if string(version, "format") != FORMAT:
        malformed("format", f"expected {FORMAT!r}, found {shown(version)}")
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
    verdicts, premises : dict
        The verdicts on all certificates, and the premises made of VALID ones.
    """

    read: Read
    base: list[Json]
    limits: Limits
    expected: Expectation
    budget: Budget = field(default_factory=lambda: current(None))
    nearby: Collection[str] = ()
    verdicts: dict[str, Verdict] = field(default_factory=dict)
    premises: dict[str, Premise] = field(default_factory=dict)

    def taken(self, name: str, wanted: str) -> Verdict:
        """Check one certificate; if it is VALID it becomes a premise."""

        def check() -> Verdict:
            data = self.read(name)
            large = len(data) > self.limits.bytes
            right = large or hashlib.sha256(data).hexdigest() == wanted
            require(right, "digest", "file", "not the bytes that the manifest names")
            with limited(self.budget):
                any_loop = replace(self.expected, controller="")
                any_loop = Expectation() if name in self.nearby else any_loop
                verdict = check_document(data, any_loop, self.limits)
                if verdict.verdict == "VALID":
                    document, controller = parse(data, self.limits), verdict.controller_digest
                    if controller:
                        self.expected.require_subject(document["subject"], controller)
                    self.premises[name] = self._premise(name, document, verdict.system_digest)
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

    def own(self) -> list[Premise]:
        """The certificates about the plant of the manifest, or boxes around it."""
        return [each for each in self.premises.values() if not each.nearby]

    def _premise(self, name: str, document: Json, digest: str) -> Premise:
        """A certificate that was found VALID."""
        given, steps = document["system"], document["subject"]
        given = self.expected.named(given) if type(given) is str else given
        known, kind = replace(plant_of(given), words=f"the plant {digest}"), document["kind"]
        nearby = name in self.nearby
        if not (self.expected.system or nearby):
            values = digest_of_values(known, digest)
            self.expected = replace(self.expected, system=values)
        plant = known if isinstance(known, FunctionSystem) else at_values(known)
        own = same(steps[: len(self.base)], self.base)
        path = tuple(step["construction"] for step in steps[len(self.base) :]) if own else None
        system = subject_of(steps, known, kind)
        sentence = KINDS[kind].statement(document["claim"], system)
        said = f"For {system.words}: {sentence}"
        return Premise(name, document, plant, system, plant, said, path, nearby=nearby)

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
            for name in cited if self.premises else self.verdicts:
                open_ = "INCOMPLETE" if self.verdicts[name].status == 5 else "INVALID"
                if name not in self.premises:
                    raise Refused(open_, "premise", name, "this certificate is not VALID")
            for name, pointer, value in because:
                found = pointed(self.premises[name].document, pointer, name)
                require(same(found, value), "value", name, f"another value at {shown(pointer)}")
            require(bool(self.own()), "premise", "because", "no certificate is about the plant")
            spend(2 * len(cited) * len(because) + 100 * len(self.premises))
            pointers = {name: tuple(p for n, p, _ in because if n == name) for name in cited}
            told = [replace(self.premises[name], pointers=pointers[name]) for name in cited]
            words = RULES[key].implied(told, [*self.premises.values()])
            words += f" [{theorem}]" if theorem else ""
            spend(len(words))
            if not RULES[key].claims:
                return Verdict("REMARK", words)
            return Verdict("IMPLIED", f"{words} from {', '.join(cited)}" if cited else words)

        with limited(self.budget):
            return attempt(check).inside(f"{place} {shown(key)}")


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
