"""The page of an audit: what was checked, what is proved, and how anybody repeats it."""

from __future__ import annotations

import hashlib
import os
import platform
import shlex
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

from mcexact import __version__
from mcexact.analysis.boxes.failure import FAILING, FailingPlant
from mcexact.answer.account import repeated_of
from mcexact.answer.check import answer_in, controller_of_loop
from mcexact.answer.listing import TOPICS
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import LOOP, Context, Rule
from mcexact.answer.templates import Sentence
from mcexact.checker.command import line_of, status_of
from mcexact.checker.core.budget import Verdict
from mcexact.checker.kinds import Found
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box, matrices_of
from mcexact.model.files import load_parametric_system, load_system
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, plain
from mcexact.report.html import AnswerPage
from mcexact.report.text import Table

ARCHIVE = "mcexact-checker.pyz"


_ATTESTED = (
    "I ran the checker as it says above, on the files of the table “What was checked”. It ended "
    "with the verdicts of this page. I made this page myself by the command above, or I compared "
    "what the checker did not compare of every sentence with what follows beside it, and with the "
    "whole statements."
)
"""What the signature says."""


def _certificates(found: Sequence[Found], second: Mapping[int, str]) -> Table:
    """Each certificate with its verdict, and what it proves or why it does not."""
    rows, note = [], "Whole statements stand under Evidence."
    for k, (about, verdict) in enumerate(found):
        if "text" in about or verdict.verdict == "COUNTED":
            continue
        said = verdict.summary or f"{verdict.code} {verdict.place}: {verdict.message}"
        twice = second.get(k, "").startswith("CONFIRMED") and verdict.verdict == "VALID"
        row = (about.get("number", ""), about["file"], verdict.verdict, said)
        rows.append((*row, "confirmed" if twice else "") if second else row)
    columns: tuple[str, ...] = ("number", "certificate", "verdict", "what is proved")
    if second:
        columns += ("mcexact-verified",)
        note += " mcexact-verified is the program extracted from the proof of its own soundness."
    return Table("Certificates", columns, tuple(rows), note)


def sentences_again(
    evidence: Iterable[tuple[str, bytes, Verdict]], plant: str | None
) -> frozenset[tuple[str, str]]:
    """Return the sentences that the package makes of the VALID ones of certificates.

    Parameters
    ----------
    evidence : iterable
        The file of each certificate, its bytes, and the verdict on it.
    plant : str, optional
        The file of the plant, which has a name.
    """
    known, answers = None if plant is None else _named(plant), {}
    for file, data, verdict in evidence:
        own = known is not None and known.digest() == verdict.system_digest
        if verdict.verdict == "VALID":
            with suppress(InputError):
                answers[Path(file).stem] = answer_in(file, data, known if own else None)
    return sentences_of(answers)


def _named(plant: str) -> MultiChannelSystem | ParametricSystem | None:
    """The plant of a file, whose name no certificate has; None if it cannot be read."""
    for read in (load_system, load_parametric_system):
        with suppress(InputError):
            return read(plant)
    return None


def _sentences(found: Sequence[Found], worded: Collection[tuple[str, str]]) -> Table:
    """Each sentence of the report, quoted, and from which certificates it follows."""
    rows = tuple(
        (
            verdict.verdict,
            about["premises"],
            verdict.summary if not verdict.status else f"{verdict.code}: {verdict.message}",
            about["text"],
            "as computed" if (about["rule"], about["text"]) in worded else "compare",
        )
        for about, verdict in found
        if "text" in about
    )
    note = (
        "What follows is what the checker proved from the certificates of these numbers: [3] "
        "stands for what the certificate 3 proves, which is under Evidence, with all its numbers. "
        "The verdict is about this. The sentence is quoted from the manifest; the checker compared "
        "its fixed words, and its costs, margins, distances, rates and steps. It did not compare "
        "what else it says: yes or no and other choices, modes, names, channels, weights, whole "
        "numbers. “As computed” means that mcexact, when this page was made, computed exactly this "
        "sentence from these certificates. If you did not make the page, compare that yourself, "
        "with what follows and with whole statements. A REMARK claims nothing. "
        "What else a report says, such as “worth installing” or what it calls computed and not "
        "certified, is not covered by this page."
    )
    columns = (
        "verdict",
        "certificates",
        "what follows from them",
        "sentence of the report",
        "wording",
    )
    return Table("Sentences of the report", columns, rows, note)


def audit_page(
    found: Sequence[Found],
    second: Mapping[int, str],
    arguments: Sequence[str],
    archive: str,
    *,
    asked: Mapping[str, str],
    worded: Collection[tuple[str, str]],
) -> AnswerPage:
    """Return the page of one run of the checker.

    Parameters
    ----------
    found : sequence of Found
        The verdicts, each behind what it is about.
    second : mapping
        What mcexact-verified says of certificates, by their places among the verdicts.
    arguments : sequence of str
        What the command was called with.
    archive : str
        The SHA-256 of the checker as one file.
    asked : mapping
        The files of the plant and the controller that were asked for, by these words.
    worded : collection of tuple
        The rules and the texts of the sentences that the package makes of the certificates.
    """
    verdicts = [verdict for _, verdict in found]
    good = not any(verdict.status for verdict in verdicts)
    proved = sum(verdict.verdict == "VALID" for verdict in verdicts)
    implied = sum(verdict.verdict == "IMPLIED" for verdict in verdicts)
    refused = sum(bool(verdict.status) for verdict in verdicts)
    answer = [f"{proved} certificates are VALID."]
    if implied:
        own = sum(
            each.verdict == "IMPLIED" and (about["rule"], about["text"]) in worded
            for about, each in found
        )
        number = "all" if own == implied else f"{own} of {implied}"
        answer.append(
            f"From them follows what stands beside {implied} sentences of the report. When this "
            f"page was made, mcexact computed {number} of these sentences again from the "
            f"certificates, word for word"
            + ("." if own == implied else "; compare the others with what follows.")
        )
    if refused:
        answer.append(f"warning: {refused} certificates or sentences are not proved; see below.")
    plants, loops = defaultdict[str, list[str]](list), defaultdict[str, list[str]](list)
    for about, each in found:
        number = about.get("number", about.get("file", ""))
        if each.verdict == "VALID":
            plants[each.system_digest].append(number)
        if each.controller_digest:
            loops[each.controller_digest].append(number)
    for words, digests in (("plant", plants), ("controller", loops)):
        if digests and words not in asked:
            answer.append(f"warning: no {words} was given to compare with: compare the digest.")
    facts = []
    for words, path in asked.items():
        facts += [(f"the {words} asked for", path), *_bytes_of(path)]
    for manifest in dict.fromkeys(about["manifest"] for about, _ in found if "manifest" in about):
        facts += [("the manifest", manifest), *_bytes_of(manifest)]
    for words, digests in (("plant", plants), ("controller", loops)):
        for k, (digest, numbers) in enumerate(digests.items()):
            which = f"another {words}, nearby, in a box, or at samples," if k else f"the {words}"
            whose = f"SHA-256 of the numbers of {which} of the certificates {', '.join(numbers)}"
            facts.append((whose, digest))
    asking = "compare it with that of a copy that you trust, not the sender's"
    facts.append((f"SHA-256 of {ARCHIVE}", f"{archive} ({asking})"))
    facts += [("version", f"mcexact {__version__}, Python {platform.python_version()}")]
    status = status_of(found)
    last = line_of(found[-1], named=True) if found else ""
    again = [
        ("with mcexact", shlex.join(["mcexact", "check", *arguments])),
        ("make the checker as one file", f"mcexact check --export {ARCHIVE}"),
        ("with Python alone", shlex.join(["python", "-I", ARCHIVE, *arguments])),
        ("to make this page", "the same with mcexact and --html FILE"),
        ("it ends with, letter by letter", f"status {status}, and the line {last}"),
        ("whole statements", "the same with --statements"),
        ("SHA-256 of a file", "sha256sum FILE, or on Windows certutil -hashfile FILE SHA256"),
    ]
    signed = [("name", ""), ("date", ""), ("signature", "")]
    names = [os.path.basename(path) for path in asked.values()]
    about_what = f": {' and '.join(names)}" if names else ""
    tables = (
        Table("What was checked", (), tuple(facts)),
        _certificates(found, second),
        _sentences(found, worded),
        Table("How to repeat it", (), tuple(again)),
        Table("Signed", (), tuple(signed), _ATTESTED),
    )
    return AnswerPage(
        f"Audit of certificates{about_what}",
        "What a checker verified that shares no code with the program that found it, and how "
        "anybody can repeat it.",
        good,
        tuple(answer),
        (),
        tuple(table for table in tables if table.rows),
    )


def _bytes_of(path: str) -> list[tuple[str, str]]:
    """The digest of the bytes of a file, as `sha256sum` prints it; nothing of standard input."""
    with suppress(OSError):
        return [("its SHA-256, as a file", hashlib.sha256(Path(path).read_bytes()).hexdigest())]
    return []


# The sentences that the package makes of certificates, to compare with those of a manifest.
#
# The rules are applied again to the claims, and to what the certificates say of plant and
# controller.  This is no proof, as the rules are the writer's own; it finds a sentence that was
# changed afterwards.

_UNKNOWN = (AttributeError, LookupError, TypeError, ValueError)
"""What a rule raises whose context no certificate says."""
_DESIGNS = [
    {"network": network, "method": method, "arithmetic": arithmetic}
    for network, method, arithmetic in product(
        ("decentralized", "extended", "lifted", "held"), ("network", "observer"), ("exact", "float")
    )
] + [
    {"solvability": True, "held": None, "method": method}
    for method in ("decentralized", "extended", "observer")
]


def sentences_of(answers: Mapping[str, Answer]) -> frozenset[tuple[str, str]]:
    """Return the keys and the lines of all sentences that the rules make of certificates.

    Parameters
    ----------
    answers : mapping
        The answers of VALID certificates, by the names of their files without the ending.
    """
    rules = [rule for rulebook, _ in TOPICS.values() for rule in rulebook]
    contexts = list(_contexts(answers))
    return frozenset(
        (sentence.template.key, sentence.line)
        for rule, context in product(rules, contexts)
        for sentence in _said(rule, answers, context)
    )


def _said(rule: Rule, answers: Mapping[str, Answer], context: Context) -> Iterator[Sentence]:
    """The sentences that one rule makes, none where it needs what no certificate says."""
    with suppress(*_UNKNOWN):
        yield from rule.apply(answers, context, (rule.missing,))


def _contexts(answers: Mapping[str, Answer]) -> Iterator[Context]:
    """The contexts in which the sentences may have been made, as far as certificates say them."""
    facts, systems = _of_loop(answers), {}
    for answer in answers.values():
        of: Any = answer.about
        for each in (of.plant, of, getattr(of, "at_samples", of)):
            systems[canonical([each.plant.digest(), *map(plain, each.subject)])] = each
    about = answers["fixed_spectrum"].subject if "fixed_spectrum" in answers else ()
    outputs = any(each["construction"] == "augmented_outputs" for each in about)
    facts["information"] = "outputs" if outputs else "own"
    for system in systems.values():
        if isinstance(system, ParametricSystem):
            yield Context(system, repeated_of(system, answers))
        else:
            for more in _DESIGNS if "region" in facts else ({},):
                yield Context(system, facts | more)


def _of_loop(answers: Mapping[str, Answer]) -> dict[str, Any]:
    """What sentences about a loop repeat: of the region, its controller, and plants around it."""
    loop: Any = next((answers[name] for name in LOOP if name in answers), None)
    if loop is None or [each["construction"] for each in loop.subject[-1:]] != ["closed_loop"]:
        return {}
    controller, plant = controller_of_loop(loop.subject[-1]["controller"]), loop.about.plant
    names = (agent.name for agent in controller.agents)
    facts: dict[str, Any] = {
        "region": StabilityRegion.of(loop.about.time, bound=getattr(loop, "bound", None)),
        "states": loop.about.n,
        "order": controller.order,
        "bits": controller.bit_length(),
        "dimensions": dict(zip(names, (agent.shared for agent in controller.agents), strict=True)),
        "observer_order": plant.n * plant.m + plant.m - 1,
    }
    box: Any = answers.get("box_stability")
    if box is not None:
        facts["part_of_plant"] = Box(box.about.plant).part
        if box.gain_radii is not None:
            radii = controller_of_loop(box.gain_radii)
            facts["part_of_gains"] = _largest(radii.matrices()) / _largest(controller.matrices())
    for name in answers.keys() & {"box_input_margin", "box_output_margin"}:
        facts["part_of_margins"] = Box(answers[name].about.plant).part
    if FAILING in answers:
        facts |= _failing(plant, answers[FAILING].about.plant)
    return facts


def _largest(matrices: Iterable[Matrix]) -> Fraction:
    """The largest modulus of an entry."""
    return max(Fraction(abs(x), M.denominator) for M in matrices for *_, x in M.nonzero())


def _failing(plant: MultiChannelSystem, near: MultiChannelSystem) -> dict[str, Any]:
    """How far a plant nearby is, in the radii of a plant or in parts of its entries."""
    radii = (Box.relative(plant, 1) if plant.uncertainty is None else Box(plant)).radii
    distance = Fraction(0)
    for (_, R), M, N in zip(radii.matrices(), matrices_of(plant), matrices_of(near), strict=True):
        units = {(i, j): Fraction(x, R.denominator) for i, j, x in R.nonzero()}
        for i, j, x in (M - N).nonzero():
            distance = max(distance, abs(Fraction(x, (M - N).denominator)) / units[i, j])
    return FailingPlant(near, distance, 0j, ()).facts(plant)
