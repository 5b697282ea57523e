"""Failures: which modes are fixed after single ones, the fewest that matter, and the sentences.

`Failures` are certificates of the fixed modes of the plant after single failures (construction
`failed`).  What is fixed after some failures is fixed after more of them
(``failures.fixed_after_more``): where no further mode is fixed without an agent at all, none is
after the failure of one of its actuators, sensors or links, and no certificate is about these.

`ANSWER_RULES` say after how many single failures no control stabilizes the plant, and `TABLE_RULES`
after which, and which modes are fixed then.  What is said of all others rests on certificates that
cover every single failure, which the checker counts.

`FewestFailures` are such certificates after several failures of one part of agents, actuators,
sensors or links.  Where no further mode is fixed after the failures L, none is after those in L;
so k failures leave no further mode fixed, whichever they are, if no k of them meet the complements
of all such L (``failures.at_least_so_many``).  `hitting_set` decides that.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from mcexact.answer.analysis import control, slowest
from mcexact.answer.modes import FixedFactor, FixedSpectrum
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import Certified, Claim, Context, Rulebook, Several
from mcexact.answer.templates import Sentence, Template, failures_in_words
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import fitting

# The answers: one certificate for each failure.


PARTS = ("agents", "actuators", "sensors", "links")
"""What can fail."""


class Failure(NamedTuple):
    """A single failure.

    Attributes
    ----------
    part : {"agents", "actuators", "sensors", "links"}
        What failed.
    agent : str
        The agent that it belongs to; of a link, the agent that sends.
    which : int, str or None
        The number of the actuator or sensor, from 1 on; of a link, the agent that receives.
    """

    part: str
    agent: str
    which: int | str | None = None

    def __str__(self) -> str:
        return failures_in_words([self])


def failure_of(subject: Sequence[Mapping[str, Any]]) -> Failure:
    """The single failure with which the subject of a certificate begins.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.constructions import failed
    >>> plant = MultiChannelSystem([[0]], [[[1, 2]]], [[[3]]], names=["left"])
    >>> print(failure_of(failed(plant, actuators=[("left", 2)]).subject))
    actuator 2 of agent left
    """
    step = {key: value for key, value in subject[0].items() if key != "construction" and value}
    [(part, [one])] = step.items()
    return Failure(part, one) if part == "agents" else Failure(part, *one)


def failures_of(subject: Sequence[Mapping[str, Any]]) -> list[Failure]:
    """The failures with which the subject of a certificate begins.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.constructions import failed
    >>> plant = MultiChannelSystem([[0]], [[[1, 2]]], [[[3]]], names=["left"])
    >>> for each in failures_of(failed(plant, actuators=[("left", 1), ("left", 2)]).subject):
    ...     print(each)
    actuator 1 of agent left
    actuator 2 of agent left
    """
    step = {key: value for key, value in subject[0].items() if key != "construction"}
    return [
        Failure(part, one) if part == "agents" else Failure(part, *one)
        for part, lost in step.items()
        for one in lost
    ]


def every(part: str, plant: MultiChannelSystem) -> list[Failure]:
    """All agents, actuators, sensors or links of a plant, in their order.

    Parameters
    ----------
    part : {"agents", "actuators", "sensors", "links"}
    plant : MultiChannelSystem
    """
    names, graph = plant.names, plant.neighbors
    if part == "agents":
        return [Failure(part, name) for name in names]
    if part == "links":
        edges = () if graph is None else graph.edges()
        return [Failure(part, names[j], names[i]) for j, i in edges]
    sizes = [p if part == "actuators" else q for p, q in plant.sizes]
    ports = zip(names, sizes, strict=True)
    return [Failure(part, name, k + 1) for name, size in ports for k in range(size)]


class Failures(tuple[FixedSpectrum, ...]):
    """The fixed modes after single failures, a certificate for each.

    `print` writes a line for each failure that was decided by itself.
    """

    def __repr__(self) -> str:
        return f"Failures({len(self)} certificates; print them, or ask for .leaving())"

    def __str__(self) -> str:
        lines = (
            f"{failure_of(each.about.subject)}: "
            + (", ".join(str(factor.polynomial) for factor in each.factors) or "nothing is fixed")
            for each in self
        )
        return "\n".join(fitting(line, 1000) for line in lines)

    def leaving(self, rate: Any = None, radius: Any = None) -> dict[Failure, list[FixedFactor]]:
        """After which failures a fixed mode is not stable, or slower than a rate or radius.

        Parameters
        ----------
        rate, radius : rational or float, optional
            Modes with Re λ ≥ −rate or |λ| ≥ radius are too slow; by default those that are not
            stable.

        Returns
        -------
        dict
            The factors with such a mode, by failures.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem
        >>> from mcexact.questions import failures
        >>> plant = MultiChannelSystem([[-1]], [[[1]]], [[[1], [2]]])
        >>> for failure, modes in failures(plant).leaving(rate=2).items():
        ...     print(failure, "|", *(each.polynomial for each in modes))
        agent 1 | x + 1
        actuator 1 of agent 1 | x + 1
        >>> failures(plant).leaving()
        {}
        """
        outside = {}
        for each in self:
            region = StabilityRegion.of(each.about.time, rate, radius)
            if modes := each.outside(region):
                outside[failure_of(each.about.subject)] = [*modes]
        return outside


# The fewest failures.


def hitting_set(sets: Collection[int], most: int, work: Callable[[], object]) -> int | None:
    """A set of at most so many elements that has one in common with each set; None if none has.

    Parameters
    ----------
    sets : collection of int
        Their elements are the bits that are 1; so are those of the result.
    most : int
    work : callable
        It is called at each node of the search, and may end it by an exception.

    Notes
    -----
    Some element of the smallest set is in the result: each is tried, without those tried before.
    More than ``most`` sets that are disjoint, which a greedy choice finds, end the search at a
    node.  NP-hard: the nodes are at most the power ``most`` of the size of a set.

    Examples
    --------
    >>> bin(hitting_set([0b011, 0b110, 0b101], 2, lambda: None))
    '0b11'
    >>> hitting_set([0b011, 0b110, 0b101], 1, lambda: None) is None
    True
    """
    work()
    if not sets:
        return 0
    ordered = sorted(sets, key=int.bit_count)
    if not ordered[0] or most < _disjoint(ordered):
        return None
    for one in _elements(ordered[0]):
        tried = ordered[0] & (one - 1)
        rest = hitting_set([each & ~tried for each in ordered if not each & one], most - 1, work)
        if rest is not None:
            return one | rest
    return None


def _elements(bits: int) -> Iterator[int]:
    while bits:
        yield bits & -bits
        bits &= bits - 1


def _disjoint(sets: Iterable[int]) -> int:
    """The number of disjoint sets that are taken one after another."""
    taken = count = 0
    for each in sets:
        if not each & taken:
            taken |= each
            count += 1
    return count


class Fewest(NamedTuple):
    """The fewest failures after which something is lost.

    Attributes
    ----------
    part : {"agents", "actuators", "sensors", "links"}
        What fails.
    spared : int
        k: after any k failures nothing is lost; proved.
    failures : tuple of Failure or None
        So many failures after which it is lost; proved.  None if it is not lost after any.
    """

    part: str
    spared: int
    failures: tuple[Failure, ...] | None

    @property
    def number(self) -> int | None:
        """The least number of failures; None if there is none, or if a limit was reached."""
        least = self.failures is not None and len(self.failures) == self.spared + 1
        return self.spared + 1 if least else None


def _fewest(
    of: Sequence[tuple[Sequence[Failure], bool]], plant: MultiChannelSystem
) -> tuple[Fewest, int | None]:
    """What follows of failures of a part, each with whether all is fine after them.

    The second value is the place of those after which it is not, the fewest of them.
    """
    part = of[0][0][0].part
    bit = {one: 1 << k for k, one in enumerate(every(part, plant))}
    whole = (1 << len(bit)) - 1
    left = {whole - sum(bit[one] for one in lost) for lost, fine in of if fine} | {whole}
    bad = min(
        (k for k, (_, fine) in enumerate(of) if not fine), key=lambda k: len(of[k][0]), default=None
    )
    lost = None if bad is None else tuple(of[bad][0])
    most = len(bit) if lost is None else len(lost)
    spared = 0
    while spared < most and hitting_set(left, spared + 1, lambda: None) is None:
        spared += 1
    return Fewest(part, spared, lost), bad


class FewestFailures(tuple[FixedSpectrum, ...]):
    """The fixed modes after several failures, which prove the fewest after which modes are fixed.

    Attributes
    ----------
    before : FixedSpectrum
        That without failures.
    """

    before: FixedSpectrum

    def __new__(
        cls, certificates: Iterable[FixedSpectrum], before: FixedSpectrum
    ) -> FewestFailures:
        made = super().__new__(cls, certificates)
        made.before = before
        return made

    def __getnewargs__(self) -> tuple[Any, ...]:
        return tuple(self), self.before

    def __repr__(self) -> str:
        return f"FewestFailures({len(self)} certificates; print them, or ask for .fixing())"

    def __str__(self) -> str:
        rows = [("further fixed", self.fixing()), ("not stabilizable", self.destabilizing())]
        lines = (
            f"{words}: "
            + (failures_in_words(each.failures, "and") if each.failures else f"by no {part}")
            + f"; by any {each.spared} {part}: no" * (each.spared > 0 and each.failures is not None)
            for words, found in rows
            for part, each in found.items()
        )
        return "\n".join(fitting(line, 1000) for line in lines)

    def fixing(self) -> dict[str, Fewest]:
        """After which failures a further mode is fixed, by parts.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem
        >>> from mcexact.questions import fewest_failures
        >>> plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]])
        >>> fewest_failures(plant).fixing()["agents"].number
        2
        """
        before = self.before.polynomial
        return self._by_part(lambda each: each.polynomial == before)

    def destabilizing(self) -> dict[str, Fewest]:
        """After which failures a mode is fixed that is not stable, by parts.

        It is empty if there is one without failures.
        """
        if not self.before.stabilizable:
            return {}
        return self._by_part(lambda each: each.stabilizable)

    def _by_part(self, fine: Callable[[FixedSpectrum], bool]) -> dict[str, Fewest]:
        parts: dict[str, list[tuple[list[Failure], bool]]] = {}
        for each in self:
            lost = failures_of(each.about.subject)
            parts.setdefault(lost[0].part, []).append((lost, fine(each)))
        return {part: _fewest(of, self.before.about.plant)[0] for part, of in parts.items()}


# The sentences.

Said = Iterator[Sentence]

_MORE = "failures.fixed_after_more"
_STILL = f"{_MORE}; S. H. Wang and E. J. Davison 1973"
UNSTABLE = Template(
    "failures-unstable",
    "After {k:int} of {all:int} single failures of an {parts:parts}, {control:control} cannot "
    "stabilize the plant.",
    f"evidence.shrunk_subspace_fixed_dynamic; {_STILL}",
)
STABLE = Template(
    "failures-stabilizable",
    "After any single failure of an {parts:parts}, {control:control} can stabilize the plant.",
    _STILL,
)
UNSTABLE_ROW = Template(
    "failures-unstable-row",
    "{failures:failures}",
    "evidence.shrunk_subspace_fixed_dynamic",
    "unstable after failure",
)
_LABEL = "fixed after failure of"
FURTHER = Template(
    "failures-fixed",
    "{failures:failures}: {modes:several modes}; the slowest fixed mode {slowest:behavior}",
    "failures.fixed_after_failure",
    _LABEL,
)
OTHERS_NONE = Template(
    "failures-fixed-others", "any other single {parts:parts}: nothing further", _MORE, _LABEL
)
NONE = Template("failures-fixed-none", "any single {parts:parts}: nothing further", _MORE, _LABEL)

_SO_MANY = "failures.at_least_so_many"
_FEWEST = "fewest failures"
FEWEST_UNSTABLE = Template(
    "failures-fewest-unstable",
    "{failures:failures together}: not stabilizable any more"
    "{spared:still stabilizable}{between:not decided}",
    f"evidence.shrunk_subspace_fixed_dynamic; {_SO_MANY}; S. H. Wang and E. J. Davison 1973",
    _FEWEST,
)
FEWEST_FIXED = Template(
    "failures-fewest-fixed",
    "{failures:failures together}: {modes:several modes}{spared:nothing further}"
    "{between:not decided}",
    _SO_MANY,
    _FEWEST,
)
ALL_STABLE = Template(
    "failures-all-stabilizable",
    "even all {part:words} together: still stabilizable",
    "S. H. Wang and E. J. Davison 1973",
    _FEWEST,
)
ALL_NONE = Template(
    "failures-all-none", "even all {part:words} together: nothing further", "", _FEWEST
)

ANSWER_RULES, TABLE_RULES = Rulebook(), Rulebook()


def _parts(context: Context) -> str:
    return "outputs" if context.information == "outputs" else "own"


def _all_of_them(context: Context) -> int:
    """The number of all single failures."""
    parts = PARTS if context.information == "outputs" else PARTS[:3]
    return sum(len(every(part, context.system.plant)) for part in parts)


def _fatal(failures: Several) -> list[Failure]:
    """The failures after which a fixed mode is not stable."""
    return [failure_of(each.subject) for each in failures if not each.stabilizable]


@ANSWER_RULES.rule("answer", UNSTABLE, STABLE, premises=("fixed_spectrum", "failures"))
def _stabilized(fixed_spectrum: Claim, failures: Several, context: Context) -> Said:
    """After how many failures the plant cannot be stabilized, if it can be without them."""
    if not fixed_spectrum.stabilizable:
        return
    by, parts = control(fixed_spectrum, context), _parts(context)
    if fatal := _fatal(failures):
        yield UNSTABLE(k=len(fatal), all=_all_of_them(context), parts=parts, control=by)
    else:
        yield STABLE(parts=parts, control=by)


@TABLE_RULES.rule("table", UNSTABLE_ROW, premises=("fixed_spectrum", "failures"))
def _unstable(fixed_spectrum: Claim, failures: Several, context: Context) -> Said:
    if fixed_spectrum.stabilizable and (fatal := _fatal(failures)):
        yield UNSTABLE_ROW(failures=fatal)


@TABLE_RULES.rule("table", FURTHER, OTHERS_NONE, NONE, premises=("fixed_spectrum", "failures"))
def _further(fixed_spectrum: Claim, failures: Several, context: Context) -> Said:
    """The modes that are fixed after failures and not without them; one row for equal ones."""
    before = fixed_spectrum.polynomial
    further, parts = 0, _parts(context)
    for group in failures.grouped("polynomial"):
        [p] = {each.polynomial for each in group}
        if p == before:
            continue
        further += len(group)
        yield FURTHER(
            modes=[
                factor.polynomial
                for factor in group[0].factors
                if not factor.polynomial.divides(before)
            ],
            slowest=slowest(group[0], context),
            failures=[failure_of(each.subject) for each in group],
        )
    if not further:
        yield NONE(parts=parts)
    elif further < _all_of_them(context):
        yield OTHERS_NONE(parts=parts)


def _of_part(answer: Answer) -> str:
    return failures_of(answer.subject)[0].part


def _what_follows(
    group: Sequence[Certified], context: Context, fine: Callable[[Any], bool]
) -> tuple[dict[str, Any], Any]:
    """The values of a sentence about the fewest failures, and the certificate after these."""
    of = [(failures_of(each.subject), fine(each)) for each in group]
    found, bad = _fewest(of, context.system.plant)
    if found.failures is None or bad is None:
        after_all = found.spared == len(every(found.part, context.system.plant))
        return {"part": found.part} if after_all else {}, None
    between = found.spared + 1, len(found.failures) - 1
    return {
        "failures": found.failures,
        "spared": (found.part, found.spared),
        "between": (found.part, *between) if between[0] <= between[1] else None,
    }, group[bad]


@TABLE_RULES.rule(
    "table", FEWEST_UNSTABLE, ALL_STABLE, premises=("fixed_spectrum", "fewest_failures")
)
def _fewest_unstable(fixed_spectrum: Claim, fewest_failures: Several, context: Context) -> Said:
    """The fewest failures of each part after which the plant cannot be stabilized."""
    if not fixed_spectrum.stabilizable:
        return
    for group in fewest_failures.grouped(_of_part):
        values, bad = _what_follows(group, context, lambda each: each.stabilizable)
        if bad is not None:
            yield FEWEST_UNSTABLE(**values)
        elif values and any(each.polynomial != fixed_spectrum.polynomial for each in group):
            yield ALL_STABLE(**values)


@TABLE_RULES.rule("table", FEWEST_FIXED, ALL_NONE, premises=("fixed_spectrum", "fewest_failures"))
def _fewest_fixed(fixed_spectrum: Claim, fewest_failures: Several, context: Context) -> Said:
    """The fewest failures of each part after which a further mode is fixed.

    Nothing is said where no fewer of them are enough for one that is not stable.
    """
    before = fixed_spectrum.polynomial
    for group in fewest_failures.grouped(_of_part):
        values, bad = _what_follows(group, context, lambda each: each.polynomial == before)
        if bad is None:
            if values:
                yield ALL_NONE(**values)
        elif bad.stabilizable or not fixed_spectrum.stabilizable:
            more = [f.polynomial for f in bad.factors if not f.polynomial.divides(before)]
            yield FEWEST_FIXED(modes=more, **values)
