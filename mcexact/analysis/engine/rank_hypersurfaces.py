"""Where a matrix of polynomials in several parameters has less than its generic rank."""

from __future__ import annotations

from functools import partial
from itertools import islice
from typing import Any

from mcexact.analysis.engine.named_matrices import Entries, Named, Rows
from mcexact.analysis.engine.parameter_lines import DRAWS, confirming_lines, in_order, poles
from mcexact.analysis.engine.parametric_minors import parametric_rank
from mcexact.answer.exceptional_hypersurfaces import Hypersurface, RankHypersurfaces
from mcexact.answer.parametric_rank import ParametricRank
from mcexact.derived.constructions import dual, moved
from mcexact.derived.modular import generator
from mcexact.errors import LimitReached
from mcexact.exact import rational_functions
from mcexact.exact.modular import ModularMatrix, primes
from mcexact.exact.roots import steady_point
from mcexact.model.parametric import ParametricSystem

_BITS = 61


def rank_for_all_values(
    system: ParametricSystem, matrix: Named
) -> ParametricRank | RankHypersurfaces:
    """Decide the rank of a matrix for all values of one parameter, or almost all of several."""
    if len(system.parameters) == 1:
        return parametric_rank(system, matrix)
    return rank_hypersurfaces(system, matrix)


def rank_hypersurfaces(
    system: ParametricSystem, matrix: Named, *, observed: bool = False
) -> RankHypersurfaces:
    """Decide the rank of a matrix for almost all values of parameters, and where it is less.

    Parameters
    ----------
    system : ParametricSystem
    matrix : SetpointMatrix, SignalMatrix, ControllabilityMatrix or TransferColumn
    observed : bool
        Whether it is made from the dual system.

    Notes
    -----
    Exact.  Where the rank is less, one minor of full order is 0 that is not 0 everywhere: its
    irreducible factors are the candidates.  Of these, the ones are kept on which the rank is less
    along drawn lines, where it is proved for every value.
    """
    rng = generator(system, "rank_hypersurfaces")
    names, entries = system.parameters, _entries(moved(system, dual) if observed else system)
    rows, width = entries.matrix(matrix), entries.columns(matrix)
    parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    undefined = poles(parts, names)
    for ell in islice(primes(rng.getrandbits(64), _BITS), DRAWS):
        above, beside = _pivots(rows, width, [rng.randrange(ell) for _ in names], ell)
        minor = [[rows[i][j] for j in beside] for i in above]
        factors = rational_functions.factors(rational_functions.determinant(minor, names))
        candidates = [rational_functions.in_parameters(h, names) for h in factors]

        def is_generic(answer: ParametricRank, rank: int = len(above)) -> bool:
            return answer.rank == rank

        def decide(line: ParametricSystem) -> ParametricRank:
            return parametric_rank(moved(line, dual) if observed else line, matrix)

        left = [h for h in candidates if h not in undefined]
        made = confirming_lines(system, decide, is_generic, left, rng)
        if made is not None:
            break
    else:
        raise LimitReached("no drawn point has the rank of almost all")
    lines, confirmed = made
    return RankHypersurfaces(
        about=system,
        hypersurfaces=tuple(
            Hypersurface(h, rank=max(value.rank for value in confirmed[h]))
            for h in in_order(confirmed)
        ),
        undefined_at=tuple(in_order(undefined)),
        lines=lines,
        matrix=matrix,
        rank=len(above),
    )


def _entries(system: ParametricSystem) -> Entries:
    """The entries of A', B_i' and C_i' as polynomials in all parameters."""
    names = system.parameters
    zero = rational_functions.ring(names).constant(0)
    A, scale = rational_functions.cleared(system.A, names)
    return Entries(
        names=system.names,
        A=A,
        B=[rational_functions.cleared(c.B, names)[0] for c in system.channels],
        C=[rational_functions.cleared(c.C, names)[0] for c in system.channels],
        widths=[c.B.ncols for c in system.channels],
        scale=scale,
        steady=steady_point(system.time),
        zero=zero,
        product=partial(rational_functions.product, zero=zero),
    )


def _pivots(
    rows: Rows, width: int, point: list[int], ell: int
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Rows and columns of a minor of full order that is not 0 at a point modulo a prime."""

    def residue(entry: Any) -> int:
        value = rational_functions.value(entry, point)
        return int(value.p) * pow(int(value.q), -1, ell) % ell

    table = [[residue(entry) for entry in row] for row in rows]
    value = ModularMatrix.from_rows(table, ell, ncols=width)
    columns = tuple(value.rref()[1])
    return tuple(value.take(cols=columns).T.rref()[1]), columns
