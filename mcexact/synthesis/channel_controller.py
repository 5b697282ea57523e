"""Channel controllers: Brasch and Pearson's, and from Riccati equations.

A channel controller is the dynamic controller of a single channel, which moves every mode that this
channel controls and observes.  There are two kinds:

- `channel_controller` (Brasch and Pearson 1970) is exact and assigns the whole spectrum.  Its order
  is one less than the controllability or the observability index, so it is small; but its numbers
  grow with the dimension.  O((n + ν)³) operations on integers whose length grows with n + ν.
- `riccati_channel_controller` is an observer with state feedback, from two Riccati equations in
  floating point.  Its order is that of the controlled and observed part, and it is designed for a
  rate or a radius; that its spectrum lies there is decided exactly.

Both need gains of the other channels with which the channel reaches many modes.  `drawn_gains`
draws small ones, and sorts them by the number of modes that channels move.  It computes ranks
modulo one prime, which bound the ranks over Q from below: what is drawn is a proposal, which the
caller verifies.  `channel_part` is the controllable and observable part of a channel, exactly.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import TYPE_CHECKING

from mcexact.analysis.single_channel import drawn_integers, reach_index
from mcexact.derived.modular import ModularSystem, generator, residue_systems
from mcexact.errors import InputError, InternalError, LimitReached
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import characteristic_polynomial, solve
from mcexact.exact.matrix import (
    Matrix,
    bit_length,
    block_diagonal,
    dyadic_matrix,
    largest_entry,
    matrix_to_float,
    to_float,
)
from mcexact.exact.matrix import hstack as matrix_hstack
from mcexact.exact.matrix import vstack as matrix_vstack
from mcexact.exact.modular import ModularMatrix, primes, random_matrix, residues
from mcexact.exact.modular import hstack as modular_hstack
from mcexact.exact.modular import vstack as modular_vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]


# Brasch–Pearson controllers of low order, which assign the whole spectrum through one channel.

_ROWS_TRIED = 200


@dataclass(frozen=True)
class ChannelController:
    """A controller of one channel: ż = A z + B y, u = C z + D y.

    Attributes
    ----------
    A : Matrix, k×k
        The companion matrix of the controller's own polynomial p_c, or its transpose.
    B : Matrix, k×q
    C : Matrix, p×k
    D : Matrix, p×q
    polynomial : Polynomial or None
        The prescribed closed-loop polynomial, of degree n + k; None if the controller was designed
        for a rate or a radius.
    """

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    polynomial: Polynomial | None

    @property
    def order(self) -> int:
        """k, the dimension of z."""
        return self.A.nrows

    @property
    def matrices(self) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """A, B, C, D."""
        return self.A, self.B, self.C, self.D

    @property
    def bit_length(self) -> int:
        """The number of bits of the longest numerator or denominator."""
        return bit_length(self.matrices)

    @property
    def largest(self) -> Fraction:
        """The largest absolute value of an entry."""
        return largest_entry(self.matrices)


def channel_controller(
    A: Matrix,
    B: Matrix,
    C: Matrix,
    polynomial: Polynomial,
    *,
    index: int,
    row: Sequence[int] | None = None,
    seed: int = 0,
) -> ChannelController:
    """Assign the spectrum of the loop around a controllable, observable and cyclic (A, B, C).

    Parameters
    ----------
    A : Matrix, n×n
        Its minimal polynomial has degree n (A is cyclic).
    B : Matrix, n×p
        (A, B) controllable.
    C : Matrix, q×n
        (C, A) observable.
    polynomial : Polynomial
        Monic, of degree n + index − 1: the prescribed closed-loop polynomial.
    index : int
        ν, at least the controllability index of (A, B), and at least 1.  The controller gets order
        ν − 1.  For the observability index, design for (A', C', B') and call `transposed`.
    row : sequence of int, optional
        h, 1×q, with (hC, A) observable; drawn if not given.
    seed : int
        The seed for the draws of h.

    Returns
    -------
    ChannelController

    Raises
    ------
    LimitReached
        If no h was found: A is not cyclic, or (C, A) is not observable.
    InputError
        If the degree of the polynomial is not n + index − 1.

    Notes
    -----
    Exact.  With d = χ_A and N(s) = h C adj(sI − A) B, u = (n_c / p_c) h y has the closed-loop
    polynomial d p_c − N n_c.  The monic p_c of degree ν−1 and the column n_c of degree ≤ ν−1 are a
    solution of a linear system with ν−1+pν unknowns and n+ν−1 equations, which is onto; unknowns
    beyond a set of pivot columns modulo a prime are 0.  O((n+ν)³) operations on integers whose
    length grows with n + ν.  (Brasch and Pearson 1970; paper, sections II-B and II-D.)

    Examples
    --------
    A double integrator, position measured; ν = 2, so the controller has order 1:

    >>> A, B = Matrix.from_rows([[0, 1], [0, 0]]), Matrix.from_rows([[0], [1]])
    >>> C = Matrix.from_rows([[1, 0]])
    >>> wanted = Polynomial((Fraction(1), Fraction(3), Fraction(3), Fraction(1)))
    >>> controller = channel_controller(A, B, C, wanted, index=2)  # s² (s + 3) + 3 (s + 3) − 8
    >>> controller.A.numerators, controller.B.numerators  # u = (8 / (s + 3) − 3) y
    (((-3,),), ((1,),))
    >>> controller.C.numerators, controller.D.numerators
    (((8,),), ((-3,),))
    """
    n, order = A.nrows, index - 1
    if polynomial.degree != n + order or polynomial.leading != 1:
        raise InputError(
            f"expected a monic polynomial of degree {n + order}, found degree {polynomial.degree}"
        )
    if row is None:
        row = next(observing_rows(A, C, Random(seed)), None)
        if row is None:
            raise LimitReached(
                f"no row h with (hC, A) observable among {_ROWS_TRIED} drawn ones: "
                "the pair is not observable, or A is not cyclic"
            )
    h = Matrix.from_rows([list(row)], ncols=C.nrows)
    d = characteristic_polynomial(A)
    numerators = _numerators(A, B, h @ C, d)
    own, n_c = _assigned(d, numerators, polynomial, order)
    return _realized(own, n_c, h, polynomial)


def assigning_controllers(
    A: Matrix, B: Matrix, C: Matrix, polynomial: Polynomial, *, index: int, side: str, rng: Random
) -> Iterator[ChannelController]:
    """Yield the controllers of `channel_controller` for drawn rows h.

    Parameters
    ----------
    A, B, C, polynomial, index
        As there.
    side : {"controllable", "observable"}
        The property to which the index belongs; for "observable" the transposed loop is designed.
    rng : Random
    """
    if side == "observable":
        turned = assigning_controllers(
            A.T, C.T, B.T, polynomial, index=index, side="controllable", rng=rng
        )
        yield from map(transposed, turned)
        return
    for h in observing_rows(A, C, rng):
        yield channel_controller(A, B, C, polynomial, index=index, row=h)


def transposed(controller: ChannelController) -> ChannelController:
    """Transpose a controller for (A', C', B') into a controller for (A, B, C).

    The two loops are transposes of each other, so they have the same characteristic polynomial.
    """
    return ChannelController(
        controller.A.T, controller.C.T, controller.B.T, controller.D.T, controller.polynomial
    )


def observing_rows(A: Matrix, C: Matrix, rng: Random) -> Iterator[tuple[int, ...]]:
    """Small integer rows h with (hC, A) observable, proved by a rank modulo a prime.

    Rows with one entry come first, then drawn ones of growing range; at most `_ROWS_TRIED` in all.
    """
    n, q = A.nrows, C.nrows
    ell = next(p for p in primes(rng.getrandbits(64)) if A.denominator % p and C.denominator % p)
    for trial in range(_ROWS_TRIED):
        if trial < q:
            h = tuple(int(k == trial) for k in range(q))
        else:
            bound = 1 + trial // (2 * q + 8)
            h = tuple(rng.randint(-bound, bound) for _ in range(q))
        row = residues(Matrix.from_rows([h], ncols=q), ell) @ residues(C, ell)
        if reach_index(residues(A, ell).T, row.T, n) is not None:
            yield h


def _numerators(A: Matrix, B: Matrix, c: Matrix, d: Polynomial) -> Matrix:
    """The polynomials of c adj(sI − A) B: for each column of B a row of n coefficients.

    adj(sI − A) = Σ_k s^k Σ_{l>k} d_l A^{l−k−1}.
    """
    n = A.nrows
    markov, vector = [], c
    for _ in range(n):
        markov.append((vector @ B).rows()[0])
        vector = vector @ A
    weights = Matrix.from_rows(
        [[d.coefficients[k + 1 + i] if k + 1 + i <= n else 0 for i in range(n)] for k in range(n)],
        ncols=n,
    )
    return (weights @ Matrix.from_rows(markov, ncols=B.ncols)).T


def _assigned(
    d: Polynomial, numerators: Matrix, wanted: Polynomial, order: int
) -> tuple[Matrix, Matrix]:
    """Solve d p_c − Σ_j N_j n_j = wanted, deg p_c = k.

    Returns
    -------
    own : Matrix, 1×k
        p_c without its leading coefficient.
    n_c : Matrix, p×(k+1)
        All n_j.
    """
    n = d.degree
    size = n + order
    shifts = [[Fraction(0)] * k + list(d.coefficients) for k in range(order)]
    for row in (-numerators).rows():
        negative = list(row)
        shifts += [[Fraction(0)] * k + negative for k in range(order + 1)]
    padded = [shift + [Fraction(0)] * (size - len(shift)) for shift in shifts]
    leading = [Fraction(0)] * order + list(d.coefficients)
    rest = [wanted.coefficients[k] - leading[k] for k in range(size)]
    S = Matrix.from_rows(padded, ncols=size).T
    pivots = _pivot_columns(S)
    solution = solve(S.take(cols=pivots), Matrix.column(rest))
    if solution is None:
        raise InternalError("the equations of the channel controller have no solution")
    values = [0] * len(shifts)
    for pivot, (numerator,) in zip(pivots, solution.numerators, strict=True):
        values[pivot] = numerator
    starts = range(order, len(values), order + 1)
    table = [values[start : start + order + 1] for start in starts]
    return (
        Matrix.from_integers([values[:order]], solution.denominator),
        Matrix.from_integers(table, solution.denominator, ncols=order + 1),
    )


def _pivot_columns(S: Matrix) -> list[int]:
    """Columns that form a square nonsingular matrix, found modulo primes; all if S is square."""
    if S.nrows == S.ncols:
        return list(range(S.ncols))
    for trial, ell in enumerate(primes(S.ncols)):
        if S.denominator % ell == 0:
            continue
        _, pivots = residues(S, ell).rref()
        if len(pivots) == S.nrows:
            return list(pivots)
        if trial > 3:
            break
    raise InputError(
        "the spectrum cannot be assigned at this order: the index given is below the "
        "controllability index, or the pair is not controllable"
    )


def _realized(own: Matrix, n_c: Matrix, h: Matrix, polynomial: Polynomial) -> ChannelController:
    """u = (n_c / p_c) h y in controllable canonical form, with n_c of degree ≤ deg p_c = k:

    A = [0 1; ⋱ ; −p_0 … −p_{k−1}],  B = e_k h,  C = [n_c − D_0 p_c],  D = D_0 h.
    """
    k = own.ncols
    direct = n_c.take(cols=[k])
    C = n_c.take(cols=range(k)) - direct @ own
    if k == 0:
        A, input_row = Matrix.zeros(0, 0), Matrix.zeros(0, 1)
    else:
        upper = matrix_hstack([Matrix.zeros(k - 1, 1), Matrix.identity(k - 1)])
        A = matrix_vstack([upper, -own])
        input_row = Matrix.column([0] * (k - 1) + [1])
    return ChannelController(A, input_row @ h, C, direct @ h, polynomial)


# Parts of a closed loop that single channels control and observe, and gains that enlarge them.


@dataclass(frozen=True)
class ChannelReach:
    """The dimension and an index of the part that one channel controls and observes.

    Attributes
    ----------
    channel : int
        q.
    degree : int
        The McMillan degree of C_q (sI − A_F)⁻¹ B_q: the dimension of the part of the loop that the
        channel controls and observes.
    index : int
        The smaller of the two indices of that part, at least 1.
    side : {"controllable", "observable"}
        The property to which the index belongs.
    cyclic : bool
        Whether this part is cyclic, so that one drawn row of C_q observes it.
    """

    channel: int
    degree: int
    index: int
    side: str
    cyclic: bool


@dataclass(frozen=True)
class DrawnGains:
    """Decentralized gains, with the channel chosen in every strong component.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i.
    reaches : tuple of ChannelReach
        One for each component of which a channel moves some modes.
    """

    gains: tuple[Matrix, ...]
    reaches: tuple[ChannelReach, ...]

    @property
    def degree(self) -> int:
        """The number of modes that the chosen channels move."""
        return sum(reach.degree for reach in self.reaches)

    @property
    def order(self) -> int:
        """The order of their controllers: index − 1 each."""
        return sum(reach.index - 1 for reach in self.reaches)

    @property
    def size(self) -> int:
        """The sum of the absolute values of the gains, which are integers."""
        return sum(abs(x) for F in self.gains for row in F.numerators for x in row)


@dataclass(frozen=True)
class ChannelPart:
    """The part of a loop that a channel controls and observes: a minimal triple.

    Attributes
    ----------
    A : Matrix, d × d
    B : Matrix, d × p_q
    C : Matrix, q_q × d
    """

    A: Matrix
    B: Matrix
    C: Matrix


def channel_part(A: Matrix, B: Matrix, C: Matrix, rng: Random) -> ChannelPart:
    """Compute the controllable and observable part of (A, B, C), exactly.

    Notes
    -----
    On X = ⟨A | B⟩ in echelon form A acts as (AX)[pivots]; then the same for the dual.  A
    controllable and observable triple is returned unchanged.
    """
    subspace = controllable_subspace(A, B, rng)
    A1, B1, C1 = (A @ subspace.X).take(subspace.pivots), B.take(subspace.pivots), C @ subspace.X
    seen = controllable_subspace(A1.T, C1.T, rng)
    return ChannelPart((A1.T @ seen.X).take(seen.pivots).T, seen.X.T @ B1, C1.T.take(seen.pivots).T)


def drawn_gains(
    system: MultiChannelSystem,
    components: Sequence[Sequence[int]],
    *,
    attempts: int,
    least: int = 0,
) -> list[DrawnGains]:
    """Draw small decentralized gains, and sort them by the number of modes that channels move.

    Parameters
    ----------
    system : MultiChannelSystem
    components : sequence of sequences of int
        For each strong component of the transfer graph, the channels to choose from.
    attempts : int
        The number of draws.
    least : int
        Draws with a smaller degree are dropped; the search ends early after many draws with this
        degree.

    Returns
    -------
    list of DrawnGains
        By degree, falling; then by the order that the controllers need, then by the size of the
        gains.

    Notes
    -----
    The search uses ranks modulo one word-size prime, which bound ranks over Q from below.  The
    caller verifies its proposals.
    """
    rng = generator(system, "drawn_gains")
    modular = next(iter(residue_systems(system, rng)))
    candidates = []
    for gains in _draws(system, rng, attempts):
        drawn = _measured(modular, gains, components, rng)
        if drawn.degree >= least:
            candidates.append(drawn)
    return sorted(candidates, key=lambda each: (-each.degree, each.order, each.size))


def _draws(system: MultiChannelSystem, rng: Random, attempts: int) -> Iterator[tuple[Matrix, ...]]:
    """Yield zero gains first, then sparse and full gains of growing range."""
    for trial in range(attempts):
        bound = 1 + trial // 24
        density = 0.0 if trial == 0 else (0.25, 0.5, 1.0)[trial % 3]
        yield tuple(
            drawn_integers(rng, system.p(i), system.q(i), bound, density) for i in range(system.m)
        )


def _measured(
    modular: ModularSystem,
    gains: tuple[Matrix, ...],
    components: Sequence[Sequence[int]],
    rng: Random,
) -> DrawnGains:
    """The best channel of every component, for these gains."""
    F = residues(block_diagonal(gains), modular.modulus)
    M = modular.A + modular.B @ F @ modular.C
    chosen = []
    for channels in components:
        reaches = [_reach(modular, M, q, rng) for q in channels]
        best = min(reaches, key=lambda r: (-r.degree, not r.cyclic, r.index), default=None)
        if best is not None and best.degree and best.cyclic:
            chosen.append(best)
    return DrawnGains(gains, tuple(chosen))


def _reach(modular: ModularSystem, M: ModularMatrix, q: int, rng: Random) -> ChannelReach:
    """Degree and indices of channel q, from ranks of parts of its Hankel matrix modulo ℓ."""
    n, ell = M.nrows, M.modulus
    B = modular.B.take(cols=list(modular.inputs[q]))
    C = modular.C.take(rows=list(modular.outputs[q]))
    if not n or not B.ncols or not C.nrows:
        return ChannelReach(q, 0, 1, "controllable", False)
    R, S = _blocks(M, B), _blocks(M.T, C.T)
    reached_by, seen_by = modular_hstack(R), modular_hstack(S).T
    degree = (seen_by @ reached_by).rank()
    if not degree:
        return ChannelReach(q, 0, 1, "controllable", False)
    reached = _first(degree, len(R), lambda k: (seen_by @ modular_hstack(R[:k])).rank())
    seen = _first(degree, len(S), lambda k: (modular_hstack(S[:k]).T @ reached_by).rank())
    row = random_matrix(1, C.nrows, ell, rng) @ C
    alone = modular_vstack([block.T for block in _blocks(M.T, row.T)])
    cyclic = (alone @ reached_by).rank() == degree
    if reached <= seen:
        return ChannelReach(q, degree, reached, "controllable", cyclic)
    return ChannelReach(q, degree, seen, "observable", cyclic)


def _blocks(M: ModularMatrix, B: ModularMatrix) -> list[ModularMatrix]:
    """B, MB, …, M^{n−1}B."""
    blocks = [B]
    while len(blocks) < M.nrows:
        blocks.append(M @ blocks[-1])
    return blocks


def _first(degree: int, most: int, rank_of: Callable[[int], int]) -> int:
    """The least k with rank_of(k) = degree, by bisection; the ranks do not fall."""
    low, high = 1, most
    while low < high:
        middle = (low + high) // 2
        if rank_of(middle) == degree:
            high = middle
        else:
            low = middle + 1
    return low


# Gains from shifted Riccati equations, in floating point, for a rate or a radius.


def riccati_feedback(
    A: Floats, B: Floats, region: StabilityRegion, *, effort: float = 1.0
) -> Floats | None:
    """Compute F for which the spectrum of A + B F lies in a region, in floating point.

    Parameters
    ----------
    A : ndarray, n × n
    B : ndarray, n × p
    region : StabilityRegion
        The region of a rate α ≥ 0 or a radius ρ.
    effort : float
        The weight of the input against that of the state.

    Returns
    -------
    ndarray, p × n, or None
        None if the equation could not be solved, for example if a mode outside is not controllable.

    Notes
    -----
    A proposal in floating point: the gain of the regulator for A + αI, or for (A/ρ, B/ρ) in
    discrete time.  The gain of an observer is F' for (A', C').

    Examples
    --------
    >>> import numpy as np
    >>> A, B = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]])
    >>> F = riccati_feedback(A, B, StabilityRegion("continuous", 2))
    >>> bool(np.linalg.eigvals(A + B @ F).real.max() < -2)
    True
    """
    import numpy as np
    from scipy.linalg import LinAlgError, solve_continuous_are, solve_discrete_are

    (n, p), bound = B.shape, to_float(region.edge)
    if n == 0 or p == 0:
        return np.zeros((p, n))
    Q, R = np.eye(n), effort * np.eye(p)
    with warnings.catch_warnings():
        # The result is certified exactly or dropped.
        warnings.simplefilter("ignore")
        try:
            if region.discrete:
                scaled = B / bound
                X = solve_discrete_are(A / bound, scaled, Q, R)
                weighted = scaled.T @ X
                gain = np.linalg.solve(R + weighted @ scaled, weighted @ (A / bound))
            else:
                X = solve_continuous_are(A + bound * np.eye(n), B, Q, R)
                gain = (B.T @ X) / effort
            F: Floats = np.asarray(-gain, dtype=np.float64)
        except (LinAlgError, ValueError):
            return None
    return F if np.all(np.isfinite(F)) else None


# Channel controllers from two Riccati equations, in floating point.

_BITS = 36
_EFFORTS = (1.0, 1e2, 1e-2)
_MARGINS = (Fraction(0), Fraction(1, 16), Fraction(1, 4))


def riccati_channel_controller(
    part: ChannelPart, region: StabilityRegion
) -> ChannelController | None:
    """Compute an observer and a state feedback for a minimal triple; None if they are too slow.

    Parameters
    ----------
    part : ChannelPart
        d states.
    region : StabilityRegion

    Returns
    -------
    ChannelController or None
        The controller ż = (A + BG + LC) z − L y, u = G z, of order d.  Its closed-loop polynomial
        χ_{A+BG} χ_{A+LC} has every root in the region, decided exactly.

    Notes
    -----
    Floating point proposes G and L, as dyadic rationals that depend on the processor and on the
    versions of numpy and scipy; the rest is exact.
    """
    G = _gain(part.A, part.B, region)
    L = None if G is None else _gain(part.A.T, part.C.T, region)
    if G is None or L is None:
        return None
    feedback, injection = part.A + part.B @ G[0], part.A + L[0].T @ part.C
    return ChannelController(
        feedback + injection - part.A, -L[0].T, G[0], Matrix.zeros(G[0].nrows, part.C.nrows),
        G[1] * L[1],
    )  # fmt: skip


def _gain(A: Matrix, B: Matrix, region: StabilityRegion) -> tuple[Matrix, Polynomial] | None:
    """Compute a gain for which A + BG lies in the region, and the polynomial that proves it."""
    states, inputs = matrix_to_float(A), matrix_to_float(B)
    for effort in _EFFORTS:
        for margin in _MARGINS:
            target = region.tightened(margin, offset=1)
            F = riccati_feedback(states, inputs, target, effort=effort)
            if F is None:
                break
            G = dyadic_matrix(F, bits=_BITS)
            polynomial = characteristic_polynomial(A + B @ G)
            if region.contains_roots_of(polynomial):
                return G, polynomial
    return None
