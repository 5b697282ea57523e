"""Models of signals in agents: which solutions of which polynomials drive them without an error.

An agent has a model of p behind a combination s of its outputs y and references r if a combination
v z of its private states satisfies p(d/dt) v z = s (y − r), or with the next value in place of the
derivative, but for what nothing drives.  In a stable loop s (y − r) then tends to 0 while all that
enters is a solution of p (``proofs/internal_model.md``, claims 2 and 3).
"""

from collections.abc import Sequence
from fractions import Fraction
from operator import mul

from .core import budget

Row = list[Fraction]
Rows = list[Row]


def largest_model(inner: Rows, own: Rows, reference: Rows, others: Rows, s: Row) -> Row:
    """The largest monic p of which z' = inner z + own y + reference r + … has a model behind s.

    It is 1 if there is none.  ``others`` are the coefficients of all other signals.

    Open: see ``proofs/OPEN.md``.
    """
    place = next(j for j, x in enumerate(s) if x)
    gains = [row[place] / s[place] for row in own]
    disturbing = [
        [x - g * a for x, a in zip(y, s, strict=True)]
        + [x + g * a for x, a in zip(r, s, strict=True)]
        + rest
        for y, r, rest, g in zip(own, reference, others, gains, strict=True)
    ]
    states, places = undisturbed(inner, disturbing)
    motion = [[row[j] for j in places] for row in times(states, inner)]
    moved = [sum(map(mul, row, gains), Fraction(0)) for row in states]
    return minimal_polynomial(motion, moved)


def undisturbed(inner: Rows, disturbing: Rows) -> tuple[Rows, list[int]]:
    """The largest space of v with v M in it and v D = 0, in reduced echelon form, with pivots."""
    rows, places = reduced(left_kernel(disturbing), len(inner))
    while rows:
        away = []
        for row in times(rows, inner):
            inside = times([[row[j] for j in places]], rows)[0]
            away.append([x - y for x, y in zip(row, inside, strict=True)])
        kept = left_kernel(away)
        if len(kept) == len(rows):
            break
        rows, places = reduced(times(kept, rows), len(inner))
    return rows, places


def minimal_polynomial(motion: Rows, start: Row) -> Row:
    """The least monic p with p(M) times the start = 0, from the constant coefficient on."""
    powers = [start]
    while not (relation := left_kernel(powers)):
        powers.append([row[0] for row in times(motion, [[x] for x in powers[-1]])])
    return [x / relation[0][-1] for x in relation[0]]


def left_kernel(rows: Rows) -> Rows:
    """A basis of the v with v M = 0."""
    n, width = len(rows), len(rows[0]) if rows else 0
    units = ([Fraction(int(i == j)) for j in range(n)] for i in range(n))
    whole, places = reduced([[*row, *unit] for row, unit in zip(rows, units, strict=True)], width)
    return [row[width:] for row in whole[len(places) :]]


def reduced(rows: Sequence[Row], width: int) -> tuple[Rows, list[int]]:
    """The rows after elimination in the first columns, and their pivots; the others follow."""
    rest, done, places = [*rows], list[Row](), list[int]()
    for j in range(width):
        pivot = next((k for k, row in enumerate(rest) if row[j]), None)
        if pivot is None:
            continue
        row = rest.pop(pivot)
        longest = budget.limbs_of(row)
        budget.spend(budget.fractions(2 * len(row) * (len(rest) + len(done) + 1), longest))
        row = [x / row[j] for x in row]
        done, rest = ([without(each, row, j) for each in group] for group in (done, rest))
        done.append(row)
        places.append(j)
    return [*done, *rest], places


def without(row: Row, pivot: Row, j: int) -> Row:
    """The row less the multiple of the pivot's that makes its entry j vanish."""
    f = row[j]
    return [x - f * y for x, y in zip(row, pivot, strict=True)] if f else row


def times(left: Rows, right: Rows) -> Rows:
    """The product of two matrices, the right one with at least one row."""
    budget.spend(sum(budget.fractions(len(row), budget.limbs_of(row)) for row in right) * len(left))
    columns = [*zip(*right, strict=True)]
    return [[sum(map(mul, row, column), Fraction(0)) for column in columns] for row in left]
