"""The work that a check may take, counted before it is done, and the same on every machine.

A certificate is untrusted input: a few hundred bytes can describe a computation of years.  A limit
on seconds alone would make the verdict depend on the machine.  Therefore every step that can be
long is charged before it starts, by a formula in the sizes of its numbers and matrices:

- One unit is about the product of two limbs (of 30 bits) in a loop, or one byte of a matrix that
  is built; 30 ns on a processor of 2025.  The functions at the end of this module give the units
  of products, reductions, inverses, fractions and tables.
- A document of N bytes is granted ``GRANTED`` + ``PER_BYTE`` · N units, ``MORE`` times as many if
  its plant has a parameter, unless ``Limits.work`` sets another limit.
- `spend` charges the budget of the check under way, a context variable, so that arithmetic need not
  pass it along.  It raises `Refused`, and the verdict is INCOMPLETE, which says nothing about the
  claim.
- The message names a budget that should suffice.  For this estimate loops run through `counted`,
  which records how many turns are left.

A check ends with a `Verdict`, which says also what the check took.  It is here because a process
that reads the verdicts of another one needs nothing else of the checker.

What several certificates of a manifest need is made once (`kept`): the plant, a subject, a proof
that each of them repeats.  Then it is charged once, too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import Any, NoReturn, TypeVar

GRANTED = 4 * 10**7
PER_BYTE = 4000
MORE = 4
"""A plant with a parameter takes few bytes, and long computations."""
LIMB = 30
"""The bits of a limb."""
STEP = 400
"""The units of a step without its numbers, also where it has no numbers."""
LOOK = 50
"""The units for the length of one rational."""
MOST = 10**30
"""More than any machine can do: the largest budget that a message names."""

Item = TypeVar("Item")


class Refused(Exception):
    """The end of a check that is not VALID: a verdict, a code, a place and a message."""

    def __init__(self, verdict: str, code: str, place: str, message: str) -> None:
        super().__init__(verdict, code, place, message)
        self.verdict, self.code, self.place, self.message = verdict, code, place, message


NOT_ABOUT = "NOT ABOUT"
"""The verdict on a certificate about something else than what was asked for."""
STATUSES = dict.fromkeys(("VALID", "IMPLIED", "REMARK", "COUNTED"), 0)
STATUSES |= {"INVALID": 1, NOT_ABOUT: 1, "MALFORMED": 3, "INCOMPLETE": 5}


@dataclass(frozen=True)
class Verdict:
    """The verdict on one certificate or one sentence.

    Attributes
    ----------
    verdict : str
        VALID (for a sentence IMPLIED, or REMARK if it claims nothing), INVALID, NOT ABOUT,
        MALFORMED, INCOMPLETE, or ERROR for a bug in this checker; COUNTED for the numbers of these
        in a manifest.
    statement : str
        What was proved, in words, or counted; else empty.
    statement_digest : str
        The SHA-256 of the statement of a certificate.
    summary : str
        What it says in one line, without all that its words mean; of a sentence what follows from
        its premises.
    left_open : tuple of pairs of int
        Where words of a sentence begin and end that were not compared with what follows.
    system_digest : str
        The SHA-256 of the certificate's plant; empty if it could not be read.
    controller_digest : str
        The SHA-256 of the controller of the closed loop that the certificate is about; empty if it
        is about none.
    code, place, message : str
        If it is not VALID, a word for the reason, the place in the document, and a sentence.
    spent : int
        The units of work that it took.
    """

    verdict: str
    statement: str = ""
    statement_digest: str = ""
    summary: str = ""
    left_open: tuple[tuple[int, int], ...] = ()
    system_digest: str = ""
    controller_digest: str = ""
    code: str = ""
    place: str = ""
    message: str = ""
    spent: int = field(default=0, compare=False)

    def __bool__(self) -> NoReturn:
        raise TypeError("a verdict is neither true nor false: ask whether .verdict is VALID")

    @property
    def status(self) -> int:
        """The exit status that belongs to this verdict."""
        return STATUSES.get(self.verdict, 70)

    def inside(self, where: str) -> Verdict:
        """The verdict with its place inside of a larger document, if it is not good."""
        return replace(self, place=f"{where} {self.place}" if self.status else "")

    def line(self, name: str = "", *, short: bool = False) -> str:
        """The verdict as one line of text, with the name of what it is about behind it.

        It has the statement and its digest, or with ``short`` the summary.
        """
        words = [self.statement_digest, self.statement]
        if self.status:
            words = [self.code, f"{self.place}: {self.message}"]
        elif short and self.verdict in ("VALID", "IMPLIED", "REMARK"):
            words = [self.summary]
            name += ":" if name and self.summary else ""
        return " ".join(part for part in (self.verdict, name, *words) if part)


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
        """Add the units that are granted for a document of ``size`` bytes."""
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
        """A budget that should suffice for a check of ``total`` units, rounded up to two digits."""
        total = min(max(4 * total, self.granted), MOST)
        digit = int(10 ** max(len(str(total)) - 2, 0))
        return -(-total // digit) * digit


def _duration(units: int) -> str:
    """The time that these units take at 30 ns each, as on a processor of 2025."""
    seconds = 3 * units // 10**8
    for limit, size, name in ((120, 1, "s"), (7200, 60, "min"), (10**6, 3600, "h")):
        if seconds < limit:
            return f"about {seconds // size + 1} {name}"
    return "weeks or more"


_current: ContextVar[Budget | None] = ContextVar("budget", default=None)


@contextmanager
def limited(budget: Budget, size: int = 0) -> Iterator[None]:
    """Charge the steps inside to a budget, after granting it the units for ``size`` bytes."""
    budget.grant(size)
    token = _current.set(budget)
    try:
        yield
    finally:
        _current.reset(token)


def current(work: int | None) -> Budget:
    """The budget of the check under way, or else a new one of ``work`` units.

    If ``work`` is None, the budget is what is granted for the bytes that are read.
    """
    return _current.get() or Budget(work)


def spend(units: int, after: int = 0) -> None:
    """Charge the next step to the current budget.

    ``after`` estimates the units of the steps after it, for the budget that a message names.
    """
    budget = _current.get()
    if budget is not None:
        budget.spend(units, after)


def counted(items: Sequence[Item]) -> Iterator[Item]:
    """Yield the items of a loop of similar turns, and record the turns for `Budget.spend`."""
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


# What is made once for all certificates of a manifest.

Kept = dict[Hashable, tuple[tuple[object, ...], Any]]
_kept: ContextVar[Kept | None] = ContextVar("kept", default=None)


@contextmanager
def keeping(known: Kept) -> Iterator[None]:
    """Let `kept` find what is known, and add to it."""
    token = _kept.set(known)
    try:
        yield
    finally:
        _kept.reset(token)


def kept(name: Hashable, make: Callable[[], Item], *about: object) -> Item:
    """What was made before under this name about the very same objects, or else is made now.

    The objects are kept as well, so that no other one can have the identity of one of them.  An
    exception is not kept.
    """
    known = _kept.get()
    if known is None:
        return make()
    key = name, *map(id, about)
    spend(STEP)
    if key not in known:
        known[key] = about, make()
    made: Item = known[key][1]
    return made


# The units of a step.


def limbs(numbers: Iterable[int]) -> int:
    """The limbs of the longest number."""
    return max(map(int.bit_length, numbers), default=0) // LIMB + 1


def limbs_of(p: Collection[Any]) -> int:
    """The limbs of the longest numerator or denominator of rationals; charges for the search."""
    spend(LOOK * len(p))
    return max((limbs((c.numerator, c.denominator)) for c in p), default=1)


def products(number: int, a: int, b: int) -> int:
    """The units of ``number`` products of numbers of a and b limbs; Python splits long ones."""
    return number * (20 + a * b * 8 // max(8, math.isqrt(min(a, b)))) // 20


def reductions(number: int, a: int, b: int = 0) -> int:
    """The units of ``number`` products or pairs of products of a limbs, each divided by b limbs."""
    return number * (32 + a * (b or a)) // 8


def inversions(number: int, a: int) -> int:
    """The units of ``number`` inverses modulo a number of a limbs."""
    return number * (20 + 50 * a + a * a)


def fractions(number: int, a: int) -> int:
    """The units of ``number`` sums, products or texts of rationals of a limbs, with their gcd."""
    return number * (600 + 60 * a + a * a) // 12


def build(nrows: int, ncols: int, a: int, b: int = 0, terms: int = 1) -> None:
    """Charge a table of new numbers, each a sum of products of numbers of a and b limbs."""
    spend(table(nrows, ncols, a + b) + products((nrows * ncols + 1) * terms, a, b))


def table(nrows: int, ncols: int, a: int = 0) -> int:
    """The bytes of a table of new numbers of a limbs; without a, of numbers that exist."""
    return STEP + nrows * (64 + ncols * (36 + 4 * a if a else 8))
