"""The answer of an analysis in plain words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from mcexact.errors import LimitReached
from mcexact.report.assessment import Assessment
from mcexact.report.text import count, shorten

if TYPE_CHECKING:
    from mcexact.analysis.communication import MinimalCommunication
    from mcexact.analysis.fixed_spectrum import FixedFactor

_TIMES = {1: "once", 2: "twice", 3: "three times"}


def answer(assessment: Assessment, wires: MinimalCommunication | None = None) -> list[str]:
    """What a user wants to know first, one sentence after the other.

    Parameters
    ----------
    assessment : Assessment
    wires : MinimalCommunication, optional
        The cheapest wires with which sharing outputs leaves nothing fixed.
    """
    spectrum = assessment.fixed_spectrum
    if spectrum.empty:
        sentences = ["Every mode can be moved: no mode is fixed with this information."]
        if assessment.completeness.complete:
            sentences.append(
                "The whole closed-loop spectrum can be assigned freely, through any one channel."
            )
        else:
            components = len(assessment.transfer_graph.components)
            sentences.append(
                "The closed-loop spectrum falls into symmetric sets, one for each of "
                f"{count(components, 'strong component')} of the transfer graph."
            )
        return sentences
    both = assessment.controllability.controllable and assessment.observability.controllable
    names = assessment.system.names
    sentences = [_blame(factor, names, both) for factor in spectrum.factors[:8]]
    if len(spectrum.factors) > 8:
        sentences.append(f"So it is with {len(spectrum.factors) - 8} more factors.")
    sentences.append(
        "All fixed modes are stable, so decentralized control can stabilize the system."
        if spectrum.stabilizable
        else "No controller with this information stabilizes the system."
    )
    return sentences + _remedies(assessment, wires)


def _blame(factor: FixedFactor, names: Sequence[str], both: bool) -> str:
    """Which mode stays, and because of whom.

    In Anderson and Clements' normal form the mode belongs to a part of the state that no channel
    outside s drives and no channel of s sees; with joint controllability and observability
    (``both``) the channels of s then drive it and the others see it.
    """
    times, stuck = factor.multiplicity_in_A, factor.multiplicity_at_most
    often = f"{_TIMES.get(times, f'{times} times')} in A"
    if stuck < times:
        often += f", of which {'one stays' if stuck == 1 else f'at most {stuck} stay'}"
    if factor.polynomial.degree == 1:
        mode = f"Mode {shorten(str(-factor.polynomial.coefficients[0]), 30)}"
    else:
        mode = f"The modes that are the roots of {shorten(str(factor.polynomial), 60)}"
    it = "it" if factor.polynomial.degree == 1 else "them"
    inside = factor.channels
    outside = [name for name in names if name not in set(inside)]
    if not inside:
        why = f"no channel reaches {it}"
    elif not outside:
        why = f"no channel sees {it}"
    else:
        why = (
            f"{channels(inside)} {_ends(inside, 'reach')} {it} but {_do(inside)} not see {it}, "
            f"{channels(outside)} {_ends(outside, 'see')} {it} but {_do(outside)} not reach {it}"
        )
        if not both:
            why = (
                f"{channels(outside)} {_do(outside)} not reach {it}, and {channels(inside)} "
                f"{_do(inside)} not see {it}"
            )
    return f"{mode} ({often}) cannot be moved by any controller with this information: {why}."


def _ends(names: Sequence[str], verb: str) -> str:
    if len(names) > 1:
        return verb
    return verb + ("es" if verb.endswith("ch") else "s")


def _do(names: Sequence[str]) -> str:
    return "does" if len(names) == 1 else "do"


def channels(names: Iterable[str], limit: int = 8) -> str:
    """Channels by name, as a phrase.

    Examples
    --------
    >>> channels(["1"]), channels(["1", "2", "3"])
    ('channel 1', 'channels 1, 2 and 3')
    """
    listed = list(names)
    if len(listed) == 1:
        return f"channel {listed[0]}"
    if len(listed) > limit:
        return f"channels {', '.join(listed[:limit])} and {len(listed) - limit} more"
    return f"channels {', '.join(listed[:-1])} and {listed[-1]}"


def _remedies(assessment: Assessment, wires: MinimalCommunication | None) -> list[str]:
    """What removes the fixed modes: shared sub-states, or wires."""
    sentences = []
    if wires is not None and wires.added:
        told = " and ".join(f"{start} → {end}" for start, end in wires.added)
        outputs = "outputs" if len(wires.added) > 1 else "the output"
        sentences.append(f"Sending {outputs} along {told} removes every fixed mode.")
    least = (assessment.minimal_shared_dimensions or {}).get("outputs+states")
    if least is None or isinstance(least, LimitReached):
        return sentences
    if least.dimensions is None:
        return [*sentences, "No sharing over this neighbor graph removes them."]
    names = assessment.system.names
    used = [
        f"{count(size, 'number')} by agent {name}"
        for name, size in zip(names, least.dimensions, strict=True)
        if size
    ]
    if used:
        told = " and ".join(used)
        sentences.append(f"Over the neighbor graph it is enough, and the least, to share {told}.")
    else:
        sentences.append("Over the neighbor graph sharing measured outputs is enough.")
    return sentences
