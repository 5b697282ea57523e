"""The kind ``step_peaks``: how large inputs and outputs of a loop become after a step.

A loop at rest receives a constant 1 at an input, at an output, or as a set-point, from the time 0
on.  The checker computes its response in integers, in continuous time a Taylor polynomial for each
step of time, and bounds what it neglects in the norm of a positive definite matrix P,
abs(v)² = v'Pv, which falls along the loop:

- An error that is made at one time only becomes smaller, so that errors add up.
- After the last step the derivative falls at least as exp(−at), discrete its values as (1 − a)^t or
  faster, and its integral is at most its norm divided by a.
- A signal c v of a vector v is at most σ abs(v), where P − cc'/σ² is positive definite.

Coordinates are scaled by powers of 2 such that abs(v) is at most the sum of the absolute values of
the entries of v.  The responses to all steps are computed at once: one long integer holds an entry
of all of them, each in its own lane of bits.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from operator import mul
from typing import NamedTuple

from .constructions import Disturbed, references
from .core import budget
from .core.arithmetic import Matrix, stack
from .core.budget import spend
from .core.reading import Json, fields, integer, items, malformed, rational, require, string
from .core.system import System
from .performance import LARGEST, diagonal_of, loop_of, lyapunov, require_positive, symmetric

SIDES = ("inputs", "outputs", "setpoints")
LEAST_BITS, MOST_BITS = 16, 1000
MOST_TERMS = 500
"""The terms of a Taylor polynomial; lanes of LEAST_BITS hold sums of so many numbers."""
REST = 8
"""The bits of the first term of a Taylor series that is left out."""
DEPTH = 20
"""How often a step of time is halved at most."""


class Response(NamedTuple):
    """z' = M z + b_k, s_k = S z + d_k, or z(t+1): the step k, and the signals s = (u, y)."""

    M: Matrix
    b: Matrix
    S: Matrix
    d: Matrix


def response_of(system: System, loop: Disturbed, at: str) -> Response:
    """What a step at each input, at each output, or of each set-point does to a loop."""
    p, q, N = loop.U.nrows, loop.Y.nrows, loop.M.nrows
    if at == "inputs":
        entering, through = loop.E, Matrix.zeros(p, p)
    elif at == "outputs" or system.loop is None:
        entering, through = loop.G, loop.K
    else:
        entering, through = references(system.loop)
    S, count = stack([loop.U, loop.Y], N), entering.ncols
    return Response(loop.M, entering, S, stack([through, Matrix.zeros(q, count)], count))


def check_step_peaks(claim: Json, witness: Json, system: System) -> None:
    """The response in integers, until a Lyapunov matrix shows that nothing larger follows.

    Theorems ``step_peaks.peaks_continuous``, ``step_peaks.peaks_discrete``.
    """
    side, *tables = fields(claim, "claim", "at", "inputs", "outputs")
    at = string(side, "claim.at", *SIDES)
    _, loop = loop_of(system)
    response = response_of(system, loop, at)
    peaks = read_peaks(tables, response.b.ncols, (loop.U.nrows, loop.Y.nrows))
    keys = ("P", "rate", "sizes", "bits", "unit", "times")
    *parts, step = fields(witness, "witness", *keys, optional=("step",))
    form, speed, listed, bits, unit, times = parts
    N, count = response.M.nrows, integer(times, "witness.times")
    P, a = symmetric(form, "witness.P", N), rational(speed, "witness.rate")
    sizes = positive(listed, "witness.sizes", response.S.nrows)
    require(a > 0, "rate", "witness.rate", "expected a rate above 0")
    h = read_step(step, system.time)
    places, e = integer(bits, "witness.bits", LEAST_BITS), integer(unit, "witness.unit", -FARTHEST)
    if places > MOST_BITS or e > FARTHEST:
        malformed("witness", f"expected up to {MOST_BITS} bits, and a unit up to 2^{FARTHEST}")
    squares = response.S.T @ (diagonal_of([1 / each**2 for each in sizes]) @ response.S)
    require_positive(P - squares, "witness.sizes", "the sizes of signals are not shown")
    decrease = lyapunov(P, response.M, system.time) - P.times(2 * a)
    require_positive(decrease, "witness.P", "not shown to decrease at this rate along the loop")
    grid = Grid.of(response, P, sizes, (places, e), h)
    bounds = [
        [scaled(peak / size, 0, e) for peak, size in zip(row, sizes, strict=True)] for row in peaks
    ]
    grid.require_within(bounds, count, a)


FARTHEST = 3 * LARGEST
"""The largest exponent of a unit."""


def read_step(value: Json, time: str) -> Fraction | None:
    """The step of time in continuous time; None in discrete time."""
    if (value is None) == (time == "continuous"):
        malformed("witness.step", "expected a step in continuous time, and only there")
    if value is None:
        return None
    h = rational(value, "witness.step")
    require(h > 0, "step", "witness.step", "expected a step above 0")
    return h


def positive(value: Json, place: str, count: int) -> list[Fraction]:
    """Numbers above 0."""
    numbers = [rational(entry, place) for entry in items(value, place, count)]
    require(all(each > 0 for each in numbers), "size", place, "expected numbers above 0")
    return numbers


def read_peaks(tables: list[Json], steps: int, widths: tuple[int, int]) -> list[list[Fraction]]:
    """For each step the bounds of all inputs, then those of all outputs."""
    rows: list[list[Fraction]] = [[] for _ in range(steps)]
    for key, value, width in zip(("inputs", "outputs"), tables, widths, strict=True):
        place = f"claim.{key}"
        for row, listed in zip(rows, items(value, place, steps), strict=True):
            row += [rational(entry, place) for entry in items(listed, place, width)]
        spend(budget.LOOK * steps * width)
    if any(entry < 0 for row in rows for entry in row):
        malformed("claim", "expected no bound below 0")
    return rows


def scaled(x: Fraction, up: int, down: int) -> int:
    """The largest integer up to x 2^(up − down)."""
    shift = up - down
    if shift >= 0:
        return (x.numerator << shift) // x.denominator
    return x.numerator // (x.denominator << -shift)


def exponents_of(P: Matrix) -> list[int]:
    """The least f_i with P_ii ≤ 4^f_i, so that √v'Pv is at most Σ 2^f_i abs(v_i).

    Theorem ``step_peaks.norm_entries``.
    """
    result = []
    for i in range(P.nrows):
        above, below = P.rows[i][i], P.denominator
        f = (above.bit_length() - below.bit_length()) // 2 - 1
        while above > below * 4**f if f >= 0 else above * 4**-f > below:
            f += 1
        result.append(f)
    return result


# Numbers of all responses in one integer.

Row = tuple[list[int], list[int]]
"""The places of the entries of a row that are not 0, and these entries."""


class Lanes:
    """Vectors of integers of at most 2^bits, one in each lane of a long integer.

    Lanes have signs: a vector v is the integer Σ v_k 2^(Wk) for lanes of W bits.
    """

    def __init__(self, count: int, bits: int, rows: Sequence[Row]) -> None:
        largest = max((sum(map(abs, entries)) for _, entries in rows), default=0)
        self.count, self.bits = count, bits
        self.size = -(-(bits + max(bits, largest.bit_length()) + 2) // 8)
        self.width = 8 * self.size
        self.ones = ((1 << self.width * count) - 1) // ((1 << self.width) - 1)
        self.limbs = self.width * count // budget.LIMB + 1
        self._offset = self.ones << (self.width - 1)
        self._kept = self.ones * ((1 << (self.width - bits)) - 1)
        self._moved = self.ones << (self.width - 1 - bits)

    def packed(self, numbers: Sequence[int]) -> int:
        """Numbers within 2^bits, each in its lane."""
        least, size = 1 << self.bits, self.size
        data = b"".join((number + least).to_bytes(size, "little") for number in numbers)
        return int.from_bytes(data, "little") - (self.ones << self.bits)

    def numbers(self, packed: int) -> list[int]:
        """The numbers of lanes that are within 2^bits."""
        data = (packed + (self.ones << self.bits)).to_bytes(self.size * self.count, "little")
        least, size = 1 << self.bits, self.size
        starts = range(0, len(data), size)
        return [int.from_bytes(data[k : k + size], "little") - least for k in starts]

    def is_within(self, vector: Sequence[int], bits: int) -> bool:
        """Whether all numbers are from −2^bits to 2^bits − 1; those of each lane fit into it."""
        bias, seen = self.ones << bits, 0
        for entry in vector:
            seen |= entry + bias
        return not seen & (self.ones * ((1 << self.width) - (1 << (bits + 1))))

    def require_within(self, vector: Sequence[int], bits: int, message: str) -> None:
        """Stop unless `is_within`."""
        require(self.is_within(vector, bits), "range", "witness", message)

    def products(self, rows: Sequence[Row], vector: Sequence[int]) -> list[int]:
        """The products of rows and a vector, divided by 2^bits and rounded down.

        Open: see ``proofs/OPEN.md``.
        """
        bits, offset, kept, moved = self.bits, self._offset, self._kept, self._moved
        result = []
        for places, entries in rows:
            total = sum(map(mul, entries, [vector[k] for k in places]))
            result.append((((total + offset) >> bits) & kept) - moved)
        self.require_within(result, bits, LARGE)
        return result

    def work(self, rows: Sequence[Row]) -> int:
        """The units of `products`."""
        entries = sum(len(places) for places, _ in rows)
        limbs = self.bits // budget.LIMB + 2
        sums = budget.products(entries, limbs, self.limbs) + entries
        return sums + len(rows) * (10 + self.limbs // 2)


# The response in integers.


class Grid:
    """The response at the times 0, h, 2h, …, where it is a Taylor polynomial in between.

    Attributes
    ----------
    flow : list of Row
        hM in scaled coordinates, discrete M, times 2^bits.
    signals : list of Row
        The signals, each divided by its size, times 2^bits.
    entering : list of int
        What the steps add to each state.
    direct : list of list of int
        What each step adds to the signals.
    """

    def __init__(
        self,
        rows: tuple[list[Row], list[Row]],
        added: tuple[list[list[int]], list[list[int]]],
        bits: int,
        h: Fraction | None,
    ) -> None:
        (self.flow, self.signals), (entering, self.direct), self.h = rows, added, h
        self.N, self.discrete = len(entering), h is None
        self.lanes = Lanes(len(self.direct), bits, [*self.flow, *self.signals])
        fits = all(abs(number) < 1 << bits for row in entering for number in row)
        require(fits, "range", "witness.unit", "the step is too large")
        self.entering = [self.lanes.packed(row) for row in entering]
        self._orders = [self.flow]

    @classmethod
    def of(
        cls,
        response: Response,
        P: Matrix,
        sizes: Sequence[Fraction],
        numbers: tuple[int, int],
        h: Fraction | None,
    ) -> "Grid":
        """Round a response: one unit has the norm 2^e."""
        (bits, e), (M, b, S, d) = numbers, response
        f = exponents_of(P)
        N, steps, count = M.nrows, b.ncols, S.nrows
        limbs = max(M.limbs, b.limbs, S.limbs, d.limbs) + (bits + max(map(abs, f), default=0)) // 30
        spend(budget.fractions((N + count) * (N + steps), limbs) + budget.table(N, N, 2))
        spend(budget.table(N, 1, steps * (2 * bits // budget.LIMB + 1)))
        flow = rows_of(M.times(h or 1), f, f, bits)
        entering = integers_of(b.times(h or 1), f, [0] * steps, -e)
        relative = diagonal_of([1 / size for size in sizes])
        signals = rows_of(relative @ S, [0] * count, f, bits)
        direct = integers_of(relative @ d, [0] * count, [0] * steps, -e)
        columns = [[row[k] for row in direct] for k in range(steps)]
        return cls((flow, signals), (entering, columns), bits, h)

    def require_within(self, bounds: list[list[int]], times: int, a: Fraction) -> None:
        """Stop unless the signals of each step stay within its bounds, in units, at all times.

        Open: see ``proofs/OPEN.md``.
        """
        N, z, error = self.N, [0] * self.N, 0
        for _ in budget.counted(range(times)):
            terms = [*self._terms(z)]
            if self.discrete:
                polynomial, made = [z], N * (N + 2)
            else:
                polynomial = [z, *terms]
                made = N * (len(polynomial) * (N + 1) + 1 + (1 << REST))
            slack = error + len(polynomial) * (N + 1) + 1 + (0 if self.discrete else made)
            for step, signal, c in self._signals(polynomial):
                within = stays_within(c, bounds[step][signal] - slack)
                require(within, "peak", "claim", "larger than claimed at some time")
            z = terms[0] if self.discrete else [sum(each) for each in zip(*polynomial, strict=True)]
            self.lanes.require_within(z, self.lanes.bits, LARGE)
            error += made
        self._require_tail(z, bounds, error, a)

    def _terms(self, z: list[int]) -> Iterator[list[int]]:
        """The terms of the Taylor polynomial after z; in discrete time the next state alone."""
        term = self._first(z)
        yield term
        if self.discrete:
            return
        for j in range(1, MOST_TERMS):
            term = self._products(self._order(j), term)
            if self.lanes.is_within(term, REST):
                return
            yield term
        require(False, "series", "witness.step", "the Taylor series is too long")

    def _first(self, z: list[int]) -> list[int]:
        """h(Mz + b), in discrete time Mz + b."""
        first = self._products(self.flow, z)
        added = [x + y for x, y in zip(first, self.entering, strict=True)]
        self.lanes.require_within(added, self.lanes.bits, LARGE)
        return added

    def _order(self, j: int) -> list[Row]:
        """hM/(j + 1)."""
        if len(self._orders) == j:
            spend(budget.table(self.N, self.N, self.lanes.bits // budget.LIMB + 1))
            self._orders.append([(at, [x // (j + 1) for x in row]) for at, row in self.flow])
        return self._orders[j]

    def _products(self, rows: list[Row], vector: list[int]) -> list[int]:
        spend(self.lanes.work(rows))
        return self.lanes.products(rows, vector)

    def _signals(self, terms: list[list[int]]) -> Iterator[tuple[int, int, list[int]]]:
        """The coefficients of each signal after each step: step, signal, coefficients."""
        lanes = self.lanes
        spend(len(terms) * len(self.signals) * lanes.count * 10)
        orders = [[*map(lanes.numbers, self._products(self.signals, term))] for term in terms]
        for signal in range(len(self.signals)):
            for step, direct in enumerate(self.direct):
                first, *rest = (order[signal][step] for order in orders)
                yield step, signal, [first + direct[signal], *rest]

    def _require_tail(self, z: list[int], bounds: list[list[int]], error: int, a: Fraction) -> None:
        """Stop unless what follows stays within the bounds: its derivative falls at the rate a."""
        lanes, N, change = self.lanes, self.N, self._first(z)
        if self.discrete:
            change = [x - y for x, y in zip(change, z, strict=True)]
            lanes.require_within(change, lanes.bits, LARGE)
        totals = [0] * lanes.count
        for entry in change:
            totals = [x + abs(y) for x, y in zip(totals, lanes.numbers(entry), strict=True)]
        # the change in a unit of time is the derivative
        after = [-(-(total + N * (N + 2)) // (a * (self.h or 1))) for total in totals]
        for step, signal, (last,) in self._signals([z]):
            bound = bounds[step][signal] - error - (N + 2) - after[step]
            require(abs(last) <= bound, "peak", "claim", "what follows may be larger than claimed")


LARGE = "numbers become too large"


def integers_of(M: Matrix, up: list[int], down: list[int], bits: int) -> list[list[int]]:
    """M_ij 2^(up_i − down_j + bits), rounded down."""
    d = M.denominator
    return [
        [scaled(Fraction(x, d), f + bits, g) if x else 0 for x, g in zip(row, down, strict=True)]
        for row, f in zip(M.rows, up, strict=True)
    ]


def rows_of(M: Matrix, up: list[int], down: list[int], bits: int) -> list[Row]:
    """The same, row by row, without the entries of M that are 0."""
    result = list[Row]()
    for numbers, row in zip(integers_of(M, up, down, bits), M.rows, strict=True):
        places = [k for k, entry in enumerate(row) if entry]
        result.append((places, [numbers[k] for k in places]))
    return result


def stays_within(c: list[int], bound: int) -> bool:
    """Whether abs(c_0 + c_1 s + c_2 s² + …) ≤ bound for all s from 0 to 1; may say no in doubt.

    Theorem ``step_peaks.polynomial_between``.
    """
    waiting, n = [(c, bound, 0)], len(c) - 1
    while waiting:
        c, bound, depth = waiting.pop()
        ends = abs(c[0]) if n < 1 else max(abs(c[0]), abs(c[0] + c[1]))
        if ends + sum(map(abs, c[2:])) <= bound:
            continue
        if depth == DEPTH or abs(c[0]) > bound or n < 1:
            return False
        spend(n * n * (2 + budget.limbs(c) // 8))
        left = [x << (n - j) for j, x in enumerate(c)]
        right = left[:]
        for start in range(n):
            for j in range(n - 1, start - 1, -1):
                right[j] += right[j + 1]
        waiting += [(left, bound << n, depth + 1), (right, bound << n, depth + 1)]
    return True


def step_peaks_statement(claim: Json, system: System) -> str:
    """The statement: the bounds of all inputs and outputs, for each step."""
    step = {
        "inputs": "a constant 1 is added to the input k",
        "outputs": "a constant 1 is added to the output k",
        "setpoints": "the set-point of the output k is 1",
    }[claim["at"]]
    rows = enumerate(zip(claim["inputs"], claim["outputs"], strict=True), 1)
    bounds = "; ".join(
        f"k = {k}: ({', '.join(map(str, u))}) and ({', '.join(map(str, y))})" for k, (u, y) in rows
    )
    return (
        f"the loop is stable, and if it is at rest and from then on {step}, the absolute values of "
        "all inputs that the agents compute, and of all outputs, never exceed the following "
        f"bounds, in the order of the channels: {bounds or 'none'}"
    )
