"""The demonstration as text, the recorded part the same on every machine, and as plain data."""

from __future__ import annotations

from typing import Any

from mcexact.crosschecks.demonstration import SEEDS, STATES, Demonstration, FloatingAnswers


def demonstration_text(shown: Demonstration) -> str:
    """What was recorded beside what is true, then what this machine says."""
    return f"{_recorded_text(shown)}\n{_text_here(shown)}"


def _recorded_text(shown: Demonstration) -> str:
    """What was recorded beside what is true: nothing here is computed in floating point."""
    powers = " * ".join(
        f"({factor})" + (f"^{multiplicity}" if multiplicity > 1 else "")
        for factor, multiplicity in shown.fixed
    )
    recorded = shown.recorded
    lines = [
        f"1. Is A = diag(1, ..., {STATES}), B = (1, ..., 1)' controllable?",
        "",
        f"   numpy    {_rank(recorded)}: {_controllable(recorded.rank)}",
        f"   mcexact  rank = {shown.rank}: {_controllable(shown.rank)}",
        "",
        f"2. Which modes of '{shown.name}' (5 states, 2 channels, integers below 10)",
        "   stay under every decentralized gain?",
        "",
        *(f"   numpy    {line}" for line in _rounded(recorded)),
        f"   mcexact  {powers}: unstable under all constant gains",
        "",
        "numpy's answers depend on how a processor rounds; these were recorded with",
        f"{recorded.libraries}.",
        "",
    ]
    return "\n".join(lines)


def _text_here(shown: Demonstration) -> str:
    """What floating point answers on this machine, if it is anything else."""
    here, recorded = shown.here, shown.recorded
    now = [f"1. {_rank(here)}", *(f"2. {line}" for line in _rounded(here))]
    then = [f"1. {_rank(recorded)}", *(f"2. {line}" for line in _rounded(recorded))]
    other = [line for line, old in zip(now, then, strict=True) if line != old]
    if not other:
        return f"On this machine they are the same, with\n{here.libraries}.\n"
    listed = "".join(f"   {line}\n" for line in other)
    return f"On this machine they differ, with\n{here.libraries}:\n\n{listed}"


def _rank(answers: FloatingAnswers) -> str:
    return f"matrix_rank([B AB ... A^{STATES - 1}B]) = {answers.rank}"


def _rounded(answers: FloatingAnswers) -> list[str]:
    """A line for each number of digits."""
    return [
        f"eigenvalues of 5 drawn closed loops, rounded to {digits} digits:"
        f" none, in {none} of {SEEDS} runs"
        for digits, none in answers.none_found
    ]


def _controllable(rank: int) -> str:
    full = f"not controllable (full rank is {STATES})"
    return "controllable" if rank == STATES else full


def demonstration_view(shown: Demonstration) -> dict[str, Any]:
    """The demonstration as plain data."""
    return {
        "controllability": {"states": STATES, "mcexact": {"rank": shown.rank}},
        "fixed_modes": {
            "system": shown.name,
            "mcexact": [
                {"factor": factor, "multiplicity_at_most": multiplicity}
                for factor, multiplicity in shown.fixed
            ],
        },
        "numpy": {
            "runs": SEEDS,
            "recorded": shown.recorded.document(),
            "here": shown.here.document(),
        },
    }
