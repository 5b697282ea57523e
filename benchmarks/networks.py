"""How long do answers about large sparse networks take, and the check of one?"""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.fixed_spectrum import Row, copied_out
from benchmarks.measure import processor_seconds
from mcexact import analyze
from mcexact.answer.protocol import encode
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.errors import LimitReached


def network_rows(network: str, n: int, m: int, found: float, checked: float = 0) -> Iterator[Row]:
    """Every question that is asked of a network, and the check of its fixed spectrum.

    Parameters
    ----------
    network : str
    n, m : int
    found : float
        The seconds in which the fixed spectrum is to be found.
    checked : float
        The seconds in which it is to be checked; 0 leaves the check out.
    """
    answers = analyze(drawn_system(Draw(0, n, m, network=network)))
    said = f"{network}, n={n}, m={m}"
    for name in answers.by_default:
        start = processor_seconds()
        try:
            answer = repr(answers[name])
        except LimitReached as reached:
            answer = f"left open: {reached}"
        seconds = processor_seconds() - start
        first = name == "fixed_spectrum"
        limit = f"<= {found:g} s" if first else "reported"
        good = seconds <= found or not first
        yield Row(f"{said}, {name}", seconds, limit, good, answer[:60], unit="s")
    for name, reason in answers.left_out.items():
        yield Row(f"{said}, {name}", 0.0, "reported", True, f"left out: {reason}", unit="s")
    if checked:
        seconds, line = copied_out(encode(answers.fixed_spectrum))
        good = seconds <= checked and line.startswith("VALID")
        yield Row(
            f"{said}, fixed_spectrum checked", seconds, f"<= {checked:g} s", good, line[:60], "s"
        )


def absence_rows(network: str, n: int, m: int, limit: float) -> Iterator[Row]:
    """The fixed spectrum alone."""
    system = drawn_system(Draw(0, n, m, network=network))
    start = processor_seconds()
    found = analyze(system, ["fixed_spectrum"]).fixed_spectrum
    seconds = processor_seconds() - start
    yield Row(
        f"{network}, n={n}, m={m}, fixed_spectrum alone",
        seconds,
        f"<= {limit:g} s",
        seconds <= limit,
        repr(found)[:60],
        unit="s",
    )
