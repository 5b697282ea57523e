"""The sentences that the package makes of certificates, to compare with those of a manifest.

The rules are applied again to the claims, and to what the certificates say of plant and controller.
This is no proof, as the rules are the writer's own; it finds a sentence that was changed
afterwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

from mcexact.analysis.boxes.failure import FAILING, FailingPlant
from mcexact.answer.account import repeated_of
from mcexact.answer.check import answer_in, controller_of_loop, followed_in
from mcexact.answer.listing import TOPICS
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import LOOP, Context, Rule
from mcexact.answer.templates import Sentence
from mcexact.checker.core.budget import Verdict
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box, matrices_of
from mcexact.model.files import load_parametric_system, load_system
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, plain


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


_UNKNOWN = (AttributeError, LookupError, TypeError, ValueError)
"""What a rule raises whose context no certificate says."""
_DESIGNS = [
    {"network": network, "method": method, "arithmetic": arithmetic}
    for network, method, arithmetic in product(
        ("decentralized", "extended", "lifted", "held"), ("network", "observer"), ("exact", "float")
    )
]
_METHODS = ("decentralized", "extended", "observer")


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
            for more in [*_DESIGNS, *_following(facts)] if "region" in facts else ({},):
                yield Context(system, facts | more)


def _following(facts: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """What designs may have asked for that follow set-points or other signals."""
    groups = facts.get("follows", {})
    asked: list[dict[str, Any]] = [{"solvability": None, "held": None}] * bool(groups)
    for alpha, held in groups.items():
        asked += [{"solvability": None, "held": held}, {"followed": alpha, "held": held}]
    yield from ({"method": method} | each for method, each in product(_METHODS, asked))


def _of_loop(answers: Mapping[str, Answer]) -> dict[str, Any]:
    """What sentences about a loop repeat: of the region, its controller, and plants around it."""
    loops: list[Any] = [answers[name] for name in LOOP if name in answers]
    loop: Any = next(iter(loops), None)
    if loop is None or [each["construction"] for each in loop.subject[-1:]] != ["closed_loop"]:
        return {}
    controller, plant = controller_of_loop(loop.subject[-1]["controller"]), loop.about.plant
    bound = next((each.bound for each in loops if getattr(each, "bound", None)), None)
    names = (agent.name for agent in controller.agents)
    facts: dict[str, Any] = {
        "region": StabilityRegion.of(loop.about.time, bound=bound),
        "states": loop.about.n,
        "order": controller.order,
        "bits": controller.bit_length(),
        "dimensions": dict(zip(names, (agent.shared for agent in controller.agents), strict=True)),
        "observer_order": plant.n * plant.m + plant.m - 1,
    }
    if getattr(loop, "stable", True):
        facts |= followed_in(loop)
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
