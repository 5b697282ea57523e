"""The work that a check may take, counted before it is done, alike on every machine.

One unit is about the product of two limbs (30 bits) in a loop, or one byte of a matrix that is
built.  A document of N bytes is granted ``GRANTED`` + ``PER_BYTE`` · N units, ``MORE`` times as
many if its plant has a parameter, unless ``Limits.work`` says otherwise; a check that would take
more is INCOMPLETE.  Units say nothing of the claim.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any, TypeVar

GRANTED = 4 * 10**7
PER_BYTE = 4000
MORE = 4
"""Plants with a parameter are small, and long to compute with."""
LIMB = 30
"""The bits of a limb."""
STEP = 400
"""What a step takes besides its numbers, as it does where there are none."""
LOOK = 50
"""What it takes to look how long a rational is."""
MOST = 10**30
"""More than any machine can do; no more is named."""

Item = TypeVar("Item")


class Refused(Exception):
    """The end of a check that is not VALID: a verdict, a code, a place and a message."""

    def __init__(self, verdict: str, code: str, place: str, message: str) -> None:
        super().__init__(verdict, code, place, message)
        self.verdict, self.code, self.place, self.message = verdict, code, place, message


@dataclass
class Budget:
    """The units that a check may take, those that are granted by default, and those taken.

    ``most`` is None where no more is granted than usual; reading a document adds to that what is
    granted for its bytes.
    ``loops`` holds four numbers for each loop under way: the units that were spent when it began
    and when its turn began, the turns before this one, and all turns.  ``builds`` says that the
    subject is being built, so that the rule still follows; ``largest`` is the largest step of that.
    ``usual`` is granted ``times`` over.
    """

    most: int | None = None
    usual: int = GRANTED
    spent: int = 0
    loops: list[list[int]] = field(default_factory=list)
    builds: bool = False
    largest: int = 0
    times: int = 1

    def spend(self, units: int, after: int = 0) -> None:
        """Count the units of a step that follows, or stop before it.

        ``after`` are about the units of the steps after it, for the work that is named.

        Raises
        ------
        Refused
            If they are more than are left.
        """
        if self.builds:
            self.largest = max(self.largest, units)
        most = self.granted if self.most is None else self.most
        if self.spent + units > most:
            total = self._total(units + after)
            named = f"allow {self._named(total)} (Limits.work), {_duration(total)}"
            message = f"takes more than {most} units of work: {named}"
            raise Refused("INCOMPLETE", "work", "checker", message)
        self.spent += units

    @property
    def granted(self) -> int:
        """The units that are granted by default."""
        return self.usual * self.times

    def grant(self, size: int) -> None:
        """Allow what is granted for so many bytes."""
        self.usual += PER_BYTE * size

    def _total(self, whole: int) -> int:
        """The units of a check where a step was refused: loops are counted to their ends."""
        reached = self.spent
        for start, turn, before, turns in reversed(self.loops):
            each = max(whole + reached - turn, (turn - start) // max(before, 1))
            whole, reached = each * (turns - before), turn
        if self.builds:
            # the largest square matrix so far, and its characteristic polynomial with short entries
            n = math.isqrt(self.largest // 8) + 1
            whole += products(2 * n**3, n // 8 + 1, n // 8 + 1)
        return reached + whole

    def _named(self, total: int) -> int:
        """A budget that should do where so many units were counted."""
        total = min(max(4 * total, self.granted), MOST)
        digit = int(10 ** max(len(str(total)) - 2, 0))
        return -(-total // digit) * digit


def _duration(units: int) -> str:
    """The time that so many units take at 30 ns each, as on a processor of 2025."""
    seconds = 3 * units // 10**8
    for limit, size, name in ((120, 1, "s"), (7200, 60, "min"), (10**6, 3600, "h")):
        if seconds < limit:
            return f"about {seconds // size + 1} {name}"
    return "weeks or more"


_current: ContextVar[Budget | None] = ContextVar("budget", default=None)


@contextmanager
def limited(budget: Budget, size: int = 0) -> Iterator[None]:
    """Charge what is done inside, perhaps after a document of so many bytes was read."""
    budget.grant(size)
    token = _current.set(budget)
    try:
        yield
    finally:
        _current.reset(token)


def current(work: int | None) -> Budget:
    """The budget of the check under way, or else a new one of so many units.

    None stands for what is granted, which grows with the bytes that are read.
    """
    return _current.get() or Budget(work)


def spend(units: int, after: int = 0) -> None:
    """Charge a step that follows to the current budget; perhaps tell what those after it take."""
    budget = _current.get()
    if budget is not None:
        budget.spend(units, after)


def counted(items: Sequence[Item]) -> Iterator[Item]:
    """The items of a loop of similar turns, for the estimate of what all of them take."""
    budget = _current.get()
    if budget is None:
        yield from items
        return
    loop = [budget.spent, budget.spent, 0, len(items)]
    depth = len(budget.loops)
    budget.loops.append(loop)
    try:
        for turn, item in enumerate(items):
            loop[1:3] = budget.spent, turn
            yield item
    finally:
        del budget.loops[depth:]


# The units of a step.


def limbs(numbers: Iterable[int]) -> int:
    """The limbs of the longest number; looking takes a unit for each."""
    return max(map(int.bit_length, numbers), default=0) // LIMB + 1


def limbs_of(p: Collection[Any]) -> int:
    """The limbs of the longest numerator or denominator of rationals; looking takes units, too."""
    spend(LOOK * len(p))
    return max((limbs((c.numerator, c.denominator)) for c in p), default=1)


def products(number: int, a: int, b: int) -> int:
    """So many products of numbers of a and b limbs, which Python splits if they are long."""
    return number * (20 + a * b * 8 // max(8, math.isqrt(min(a, b)))) // 20


def reductions(number: int, a: int, b: int = 0) -> int:
    """So many products of numbers of a limbs, or two of them, each divided by a number of b."""
    return number * (32 + a * (b or a)) // 8


def inversions(number: int, a: int) -> int:
    """So many inverses modulo a number of a limbs."""
    return number * (20 + 50 * a + a * a)


def fractions(number: int, a: int) -> int:
    """So many sums or products of rationals of a limbs, with the gcd, or their texts."""
    return number * (600 + 60 * a + a * a) // 12


def build(nrows: int, ncols: int, a: int, b: int = 0, terms: int = 1) -> None:
    """Charge a table of new numbers, each a sum of products of numbers of a and b limbs."""
    spend(table(nrows, ncols, a + b) + products((nrows * ncols + 1) * terms, a, b))


def table(nrows: int, ncols: int, a: int = 0) -> int:
    """The bytes of a table of new numbers of a limbs; without a, of numbers that exist."""
    return STEP + nrows * (64 + ncols * (36 + 4 * a if a else 8))
