"""The state without a part that no output shows, or that no input moves.

`without_part` makes the system x modulo N, where N is an A-invariant subspace that no output shows;
or the system within R, an A-invariant subspace that contains all that inputs move.  The two are
dual to each other, and have one construction.  No controller changes what is left out: for every F
the characteristic polynomial of A_F is that of the part, which `parts_of` returns, times that of
the result.  The subspaces themselves are decided in `mcexact.analysis.modulo`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal, get_args

from mcexact.errors import InputError, UsageError, one_of
from mcexact.exact.linear_algebra import characteristic_polynomial, row_echelon
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.entries import as_matrix
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem, any_system

Part = Literal["unobservable", "uncontrollable"]
PARTS: tuple[Part, ...] = get_args(Part)
MODULO = "modulo"
"""The name of the construction."""


@dataclass(frozen=True)
class LeftOut:
    """A part of the state that a construction left out.

    Attributes
    ----------
    part : {"unobservable", "uncontrollable"}
    polynomial : Polynomial
        The characteristic polynomial of A on the part, whose roots stay in every loop of the plant.
    """

    part: Part
    polynomial: Polynomial

    @property
    def dimension(self) -> int:
        """The number of states that were left out."""
        return self.polynomial.degree


def without_part(
    system: MultiChannelSystem, part: Part, subspace: Any, pivots: Sequence[int] | None = None
) -> MultiChannelSystem:
    """Leave out a part of the state that no output shows, or that no input moves.

    Parameters
    ----------
    system : MultiChannelSystem
        With n states.
    part : {"unobservable", "uncontrollable"}
    subspace : matrix, k×n
        W with k ≥ 1 independent rows.  "unobservable": they span N, with A N ⊂ N and C_i N = 0.
        "uncontrollable": W vanishes on R, with A R ⊂ R and im B_i ⊂ R, so that no input moves W x.
    pivots : sequence of int, optional
        k columns of W that form the identity.  By default those of the reduced row echelon form,
        which then takes the place of W.

    Returns
    -------
    MultiChannelSystem
        With n − k states, the same channels and the same neighbor graph.  Its states are x_j for
        the columns j that are no pivots, less their values along N if the part is unobservable.

    Raises
    ------
    UsageError
        If the part is none of the two, or the subspace is not one as the part needs it.
    InputError
        If the matrix has another shape, or an entry is no rational number.

    Notes
    -----
    Exact.  With the columns of W in two blocks, the k pivots and the others, which D stands for::

            ⎡ A_pp  A_pk ⎤        ⎡ B_p ⎤
        A = ⎣ A_kp  A_kk ⎦ ,  B = ⎣ B_k ⎦ ,   C = [ C_p  C_k ],   W = [ I  D ]

    the results are, for "unobservable" and "uncontrollable",

        A_kk − D' A_pk,  B_k − D' B_p,  C_k      and      A_kk − A_kp D,  B_k,  C_k − C_p D.

    The first is x modulo N with the states T x, T = [−D'  I], since T W' = 0; the second is the
    system on R, where x = (−D z, z) with the states z.

    Examples
    --------
    Three integrators that measure relative positions; the agreement subspace stays:

    >>> B = [[[1], [0], [0]], [[0], [1], [0]], [[0], [0], [1]]]
    >>> C = [[[1, -1, 0]], [[0, 1, -1]], [[-1, 0, 1]]]
    >>> plant = MultiChannelSystem([[0] * 3] * 3, B, C)
    >>> relative = without_part(plant, "unobservable", [[1, 1, 1]])
    >>> relative.n, relative.B(0).numerators, relative.C(0).numerators
    (2, ((-1,), (-1,)), ((-1, 0),))
    >>> without_part(plant, "unobservable", [[1, 0, 0]])
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: subspace: expected a subspace that no output shows
    """
    any_system(system)
    one_of(part, PARTS, "part")
    W, columns = _echelon(as_matrix(subspace, "subspace", ncols=system.n), system.n, pivots)
    hidden = part == "unobservable"
    A = system.A.T if hidden else system.A
    ports = system.output_matrix().T if hidden else system.input_matrix()
    WA = W @ A
    Z = WA.take(cols=columns)
    if WA != Z @ W:
        raise UsageError("expected a subspace that A maps into itself", where="subspace")
    if not (W @ ports).is_zero():
        found = "no output shows" if hidden else "contains what every input moves"
        raise UsageError(f"expected a subspace that {found}", where="subspace")
    kept = [j for j in range(system.n) if j not in set(columns)]
    construction = {
        "construction": MODULO,
        "part": part,
        "annihilator": W,
        "pivots": columns,
        "polynomial": characteristic_polynomial(Z),
    }
    within = _Within(W.take(cols=kept), columns, kept)
    channels = system.channels
    if hidden:
        B = [within.measured(c.B.T).T for c in channels]
        C = [within.driven(c.C.T).T for c in channels]
    else:
        B, C = [within.driven(c.B) for c in channels], [within.measured(c.C) for c in channels]
    A = within.measured(within.driven(A))
    return system.derived(
        A.T if hidden else A,
        B,
        C,
        construction,
        D=system.D,
        neighbors=system.neighbors,
        regulated=system.regulated,
        limits=system.limits,
        typical_sizes=_sizes_of(system.typical_sizes, kept),
    )


@dataclass(frozen=True)
class _Within:
    """The subspace W x = 0 by its coordinates: the states that are kept; D are these columns."""

    D: Matrix
    pivots: tuple[int, ...]
    kept: list[int]

    def driven(self, M: Matrix) -> Matrix:
        """The rows of a matrix that are kept."""
        return M.take(rows=self.kept)

    def measured(self, M: Matrix) -> Matrix:
        """A matrix on the subspace."""
        return M.take(cols=self.kept) - M.take(cols=self.pivots) @ self.D


def _echelon(rows: Matrix, n: int, pivots: Sequence[int] | None) -> tuple[Matrix, tuple[int, ...]]:
    """Independent rows with these pivots, or else in reduced row echelon form."""
    if rows.ncols != n or not rows.nrows:
        raise InputError(
            f"expected at least one row of {n} entries, found {rows.nrows} of {rows.ncols}",
            where="subspace",
        )
    if pivots is None:
        rows, found = row_echelon(rows)
        if not found:
            raise UsageError("expected a row that is not zero", where="subspace")
        return rows.take(rows=range(len(found))), tuple(found)
    columns = tuple(pivots)
    proper = list(columns) == sorted({*columns} & {*range(n)})
    if not proper or rows.take(cols=columns) != Matrix.identity(rows.nrows):
        raise UsageError("expected the columns of the identity, in order", where="pivots")
    return rows, columns


def _sizes_of(sizes: TypicalSizes | None, kept: Sequence[int]) -> TypicalSizes | None:
    """The typical sizes of the states that are kept, and of all inputs and outputs."""
    if sizes is None or sizes.states is None:
        return sizes
    states = [sizes.states[j] for j in kept]
    return TypicalSizes(states, sizes.inputs, sizes.errors, sizes.disturbances)


def parts_of(system: MultiChannelSystem) -> tuple[LeftOut, ...]:
    """Return the parts of the state that were left out of a system, in order.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 0], [0, 2]], [[[1], [1]]], [[[0, 1]]])
    >>> [(each.part, str(each.polynomial)) for each in parts_of(
    ...     without_part(plant, "unobservable", [[1, 0]]))]
    [('unobservable', 'x')]
    """
    return tuple(
        LeftOut(each["part"], each["polynomial"])
        for each in system.subject
        if each["construction"] == MODULO
    )


def states_of_rest(system: MultiChannelSystem, states: Sequence[Fraction | int]) -> list[Fraction]:
    """Return the states of a system without parts, from those of the system it was made from.

    Parameters
    ----------
    system : MultiChannelSystem
        Made by `without_part`, once or several times.
    states : sequence of n rationals

    Raises
    ------
    InputError
        If a part that no input moves was left out, and these states are not 0 along it.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 0], [0, 0]], [[[1], [0]]], [[[1, -1]]])
    >>> states_of_rest(without_part(plant, "unobservable", [[1, 1]]), [Fraction(3), Fraction(5)])
    [Fraction(2, 1)]
    """
    x = Matrix.column(states)
    for step in system.subject:
        if step["construction"] != MODULO:
            continue
        W, pivots = step["annihilator"], step["pivots"]
        kept = [j for j in range(W.ncols) if j not in set(pivots)]
        along = W @ x
        if step["part"] == "uncontrollable" and not along.is_zero():
            raise InputError(
                "expected an initial state without the part that no input moves", where="initial"
            )
        own = x.take(rows=kept)
        if step["part"] == "unobservable":
            own = own - W.take(cols=kept).T @ x.take(rows=pivots)
        x = own
    return [row[0] for row in x.rows()]
