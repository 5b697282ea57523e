"""Single failures: which modes are fixed after each of them, and the sentences about it.

`Failures` are certificates of the fixed modes of the plant after single failures (construction
`failed`).  What is fixed after some failures is fixed after more of them
(``failures.fixed_after_more``): where no further mode is fixed without an agent at all, none is
after the failure of one of its actuators, sensors or links, and no certificate is about these.

`ANSWER_RULES` say after how many single failures no control stabilizes the plant, and `TABLE_RULES`
after which, and which modes are fixed then.  What is said of all others rests on certificates that
cover every single failure, which the checker counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from mcexact.answer.analysis import control, slowest
from mcexact.answer.modes import FixedFactor, FixedSpectrum
from mcexact.answer.sentence import Claim, Context, Rulebook, Several
from mcexact.answer.templates import Sentence, Template, failures_in_words
from mcexact.exact.roots import StabilityRegion
from mcexact.shown import fitting

# The answers: one certificate for each failure.


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

ANSWER_RULES, TABLE_RULES = Rulebook(), Rulebook()


def _parts(context: Context) -> str:
    return "outputs" if context.information == "outputs" else "own"


def _all_of_them(context: Context) -> int:
    """The number of all single failures."""
    graph = context.system.plant.neighbors if context.information == "outputs" else None
    links = () if graph is None else graph.edges()
    return len(context.system.plant.names) + sum(context.signals) + len(links)


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
