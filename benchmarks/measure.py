"""Times of several commands in turn, and the ratios of their medians."""

from __future__ import annotations

import gc
import resource
import statistics
from collections.abc import Callable, Mapping
from dataclasses import dataclass


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


def interleaved(
    contenders: Mapping[str, Callable[[], object]], *, runs: int = 5, warmup: int = 1
) -> dict[str, Timing]:
    """Run the contenders A B C A B C …, so that a drift of the machine meets all of them.

    Parameters
    ----------
    contenders : mapping from name to a function without arguments
        Each builds what it needs from scratch: nothing may be cached from run to run.
    runs : int
        Counted runs of each.
    warmup : int
        Runs before, not counted.
    """
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    for turn in range(warmup + runs):
        for name, run in contenders.items():
            gc.collect()
            start = processor_seconds()
            run()
            elapsed = processor_seconds() - start
            if turn >= warmup:
                seconds[name].append(elapsed)
    return {name: Timing(name, tuple(values)) for name, values in seconds.items()}
