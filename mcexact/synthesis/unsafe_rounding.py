"""A way of rounding a controller's entries with which the loop fails, decided exactly."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from scipy.linalg import eig

from mcexact.analysis.boxes.float_pencils import Floats
from mcexact.analysis.boxes.gain_radii import rounded_ends, with_gains
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.answer.stability import StabilityVerdict
from mcexact.exact.floats import matrix_to_float
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.floating.margins import is_within
from mcexact.model.controller import Controller
from mcexact.model.loop import ClosedLoop, LoopPencil
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import certify_controller

_MODES, _ROUNDS = 8, 4


def unsafe_rounding(
    loop: ClosedLoop, digits: int, region: StabilityRegion
) -> tuple[Controller, StabilityVerdict] | None:
    """Search a rounding of all entries to significant digits that leaves the region.

    Each entry is rounded up or down to the next number with so many digits.

    Parameters
    ----------
    loop : ClosedLoop
    digits : int
    region : StabilityRegion

    Returns
    -------
    tuple of Controller and StabilityVerdict, or None
        The rounded controller and the exact verdict on its loop; None if none was found, which
        proves nothing.

    Notes
    -----
    For each of the eigenvalues nearest to the border, every entry is moved to the side on which
    this eigenvalue comes nearer, to first order; and again from there.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[["-1.06"]]]))
    >>> rounded, verdict = unsafe_rounding(loop, 2, StabilityRegion("continuous", "1/20"))
    >>> rounded.agents[0].input.outputs[0][0, 0], verdict.stable
    (Fraction(-1, 1), False)
    """
    ends = _ends(loop.controller, digits)
    with one_thread():
        for rounded in _roundings(loop, ends, region.discrete):
            if is_within(matrix_to_float(replace(loop, controller=rounded).matrix), region):
                continue
            bound: dict[str, Any] = {region.word: region.bound}
            verdict = certify_controller(loop.given, rounded, loop.graph, **bound)
            if not verdict.stable:
                return rounded, verdict
    return None


def _ends(controller: Controller, digits: int) -> list[tuple[Fraction, Fraction]]:
    """The numbers with so many digits next to each entry, in the order of the entries."""
    found: list[tuple[Fraction, Fraction]] = []

    def kept(M: Matrix) -> Matrix:
        for _, _, x in M.nonzero():
            found.append(rounded_ends(Fraction(x, M.denominator), digits))
        return M

    with_gains(controller, kept)
    return found


def _with_entries(controller: Controller, entries: Iterable[int | Fraction]) -> Controller:
    """The controller with other entries, in the order of those that are not 0."""
    values = iter(entries)

    def of(M: Matrix) -> Matrix:
        return Matrix.from_entries(M.shape, [(i, j, next(values)) for i, j, _ in M.nonzero()])

    return with_gains(controller, of)


def _roundings(
    loop: ClosedLoop, ends: list[tuple[Fraction, Fraction]], discrete: bool
) -> Iterator[Controller]:
    """Controllers whose entries are rounded to the side on which an eigenvalue gets slower."""
    seen = set[bytes]()
    for k in range(_MODES):
        controller = loop.controller
        for _ in range(_ROUNDS):
            slopes = _slopes(replace(loop, controller=controller), len(ends), k, discrete)
            if slopes is None:
                break
            up = slopes > 0
            pairs = zip(ends, up, strict=True)
            controller = _with_entries(loop.controller, (pair[int(side)] for pair, side in pairs))
            if up.tobytes() in seen:
                break
            seen.add(up.tobytes())
            yield controller


def _slopes(loop: ClosedLoop, count: int, k: int, discrete: bool) -> Floats | None:
    """How fast the k-th slowest eigenvalue gets slower where each entry grows."""
    signals = LoopPencil(loop.given, loop.controller, loop.graph)
    Z, N = matrix_to_float(signals.matrix), signals.states
    static = np.linalg.solve(Z[N:, N:], np.hstack([Z[N:, :N], np.eye(len(Z) - N)]))
    M = Z[:N, :N] - Z[:N, N:] @ static[:, :N]
    if not np.all(np.isfinite(M)):
        return None
    solved: Any = eig(M, left=True)
    values, left, right = solved
    slow = np.abs(values) if discrete else values.real
    order = [i for i in np.argsort(-slow) if values[i].imag >= 0]
    if k >= len(order):
        return None
    i = order[k]
    v, w, value = right[:, i], left[:, i].conj(), values[i]
    r = np.concatenate([v, -static[:, :N] @ v])
    row = np.concatenate([w, -(w @ Z[:N, N:]) @ static[:, N:]])
    turn = np.conj(value) if discrete else 1.0
    places = _places(signals, count)
    return np.asarray((turn * row[places[0]] * r[places[1]] / (w @ v)).real)


def _places(signals: LoopPencil, count: int) -> tuple[list[int], list[int]]:
    """The row and the column in the pencil of each entry of the controller."""
    given = signals.given
    nothing = MultiChannelSystem(
        given.A * 0, [M * 0 for M in given.B], [M * 0 for M in given.C], time=given.time
    )
    numbered = _with_entries(signals.controller, range(1, count + 1))
    found = sorted((x, i, j) for i, j, x in signals.with_entries(nothing, numbered, 0).nonzero())
    return [i for _, i, _ in found], [j for _, _, j in found]
