"""Answer: whether every output can be held at any set-point."""

from __future__ import annotations

from functools import cached_property

from mcexact.answer.protocol import Answer, answer, claim, shown, witness
from mcexact.exact.linear_algebra import PolynomialMatrix, row_echelon
from mcexact.exact.matrix import Matrix


@answer("setpoint")
class SetpointSolvability(Answer):
    """S = [A, B; C, 0] (discrete time: A − I) has rank r, of n + Σ q_i rows.

    Attributes
    ----------
    solvable : bool
        Whether r = n + Σ q_i; then the plant with integrators of all outputs is jointly
        controllable if the plant is.
    rank : int
        r.
    invariant_zero : bool or None
        If S does not have full rank, whether [xI − A, B; C, 0] has full rank for some x, so that 0
        (discrete time: 1) is an invariant zero.  If not, the outputs are dependent at every
        frequency.
    modulus : int
        ℓ ≥ 2, modulo which the ranks are reached.
    left : Matrix
        W, (n + Σ q_i − r) × (n + Σ q_i), W S = 0; its columns ``pivots`` form the identity.
    pivots : tuple of int
    point : int or None
        A point where the pencil has full rank modulo ℓ, for an invariant zero.
    normal : PolynomialMatrix or None
        A nonzero row that annihilates the pencil identically, if there is no such point.
    """

    solvable: bool = claim("every set-point has an equilibrium")
    rank: int = claim("rank of [A, B; C, 0]")
    invariant_zero: bool | None = claim("an invariant zero forbids it")
    modulus: int = witness()
    left: Matrix = witness()
    pivots: tuple[int, ...] = witness()
    point: int | None = witness()
    normal: PolynomialMatrix | None = witness()

    @cached_property
    @shown("conditions on set-points")
    def combinations(self) -> Matrix:
        """Rows w ≠ 0 with w · r = 0 for every vector r of set-points that an equilibrium holds.

        A row has one entry for each output; there are no rows if every set-point can be held.
        """
        outputs = self.about.output_matrix().nrows
        kept = []
        if self.left.nrows:
            last_columns = range(self.about.n, self.about.n + outputs)
            for row in row_echelon(self.left.take(cols=last_columns))[0].numerators:
                last = next((x for x in reversed(row) if x), 0)
                if last:
                    kept.append([x if last > 0 else -x for x in row])
        return Matrix.from_integers(kept, ncols=outputs)
