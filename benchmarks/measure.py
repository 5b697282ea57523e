"""Times of several commands in turn, and the ratios of their medians."""

from __future__ import annotations

import gc
import resource
import statistics
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

Result = TypeVar("Result")


@dataclass(frozen=True)
class Timing:
    """Seconds of the counted runs of one contender."""

    name: str
    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The median of the runs."""
        return statistics.median(self.seconds)


def processor_seconds() -> float:
    """The seconds of the processor that this process and the ones it waited for have used."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def in_turns(
    contenders: Mapping[str, Callable[[], Result]], *, runs: int
) -> dict[str, list[Result]]:
    """What the contenders return, run A B C A B C …: a drift of the machine meets all of them."""
    results: dict[str, list[Result]] = {name: [] for name in contenders}
    for _ in range(runs):
        for name, run in contenders.items():
            gc.collect()
            results[name].append(run())
    return results


def interleaved(
    contenders: Mapping[str, Callable[[], object]], *, runs: int = 5, warmup: int = 1
) -> dict[str, Timing]:
    """Time the contenders `in_turns`.

    Parameters
    ----------
    contenders : mapping from name to a function without arguments
        Each builds what it needs from scratch: nothing may be cached from run to run.
    runs : int
        Counted runs of each.
    warmup : int
        Runs before, not counted.
    """

    def seconds(run: Callable[[], object]) -> float:
        start = processor_seconds()
        run()
        return processor_seconds() - start

    timed = {name: partial(seconds, run) for name, run in contenders.items()}
    turns = in_turns(timed, runs=warmup + runs)
    return {name: Timing(name, tuple(values[warmup:])) for name, values in turns.items()}
