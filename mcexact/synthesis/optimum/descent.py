"""The BFGS method with a line search that accepts infinite values (Lewis and Overton 2013)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mcexact.synthesis.optimum.cost import Valued
from mcexact.synthesis.optimum.weights import Floats

Function = Callable[[Floats], Valued]

_DECREASE, _CURVATURE = 1e-4, 0.9
_SEARCH = 40
_WINDOW = 15


@dataclass(frozen=True, eq=False)
class _Step:
    """An accepted step of the line search."""

    x: Floats
    value: float
    gradient: Floats


def minimize(
    function: Function,
    x: Floats,
    *,
    steps: int = 200,
    tolerance: float = 1e-6,
    enough: Callable[[float], bool] | None = None,
    stop: Callable[[], bool] | None = None,
) -> tuple[Floats, float]:
    """Find a local minimum from a point where a function is finite.

    Parameters
    ----------
    function : callable
        The value and the gradient; the value may be infinite, where the gradient is not used.
    x : ndarray
    steps : int
        The largest number of steps.
    tolerance : float
        Ends when 15 steps together decrease the value by less than this part of it.
    enough : callable, optional
        Ends when it holds for the value.
    stop : callable, optional
        Ends when it holds; it is asked before each step.

    Returns
    -------
    x : ndarray
    value : float
        Infinite if it is infinite at the start.

    Examples
    --------
    >>> def barrier(x):
    ...     inside = x[0] > 1
    ...     return (x[0] - np.log(x[0] - 1), 1 - 1 / (x - 1)) if inside else (np.inf, x)
    >>> minimize(barrier, np.array([5.0]))[0].round(3).tolist()
    [2.0]
    """
    value, gradient = function(x)
    if not np.isfinite(value) or not x.size:
        return x, value
    H, fresh, values = _first(x, gradient), True, [value]
    for _ in range(steps):
        if stop is not None and stop():
            break
        direction = -H @ gradient
        if not float(gradient @ direction) < 0:
            H, fresh = _first(x, gradient), True
            direction = -H @ gradient
        step = _line_search(function, x, value, gradient, direction)
        if step is None:
            break
        moved, change = step.x - x, step.gradient - gradient
        H, fresh = _updated(H, moved, change, fresh=fresh)
        x, value, gradient = step.x, step.value, step.gradient
        values.append(value)
        settled = len(values) > _WINDOW and values[-_WINDOW] - value < tolerance * abs(value)
        if settled or (enough is not None and enough(value)):
            break
    return x, value


def _first(x: Floats, gradient: Floats) -> Floats:
    """A multiple of the identity with which the first step is short."""
    length = max(0.05, 0.1 * float(np.linalg.norm(x)))
    return np.eye(len(x)) * (length / max(float(np.linalg.norm(gradient)), 1e-300))


def _updated(H: Floats, moved: Floats, change: Floats, *, fresh: bool) -> tuple[Floats, bool]:
    """Update the inverse of the Hessian matrix; a first one is scaled before."""
    curvature = float(moved @ change)
    if not curvature > 1e-14 * np.linalg.norm(moved) * np.linalg.norm(change):
        return H, fresh
    if fresh:
        H = np.eye(len(H)) * (curvature / float(change @ change))
    r, Hy = 1 / curvature, H @ change
    crossed = np.outer(Hy, moved)
    H = H + (1 + r * float(change @ Hy)) * r * np.outer(moved, moved) - r * (crossed + crossed.T)
    return H, False


def _line_search(
    function: Function, x: Floats, value: float, gradient: Floats, direction: Floats
) -> _Step | None:
    """Bisect for a step of sufficient decrease and curvature; None if no step decreases."""
    slope, low, high, t = float(gradient @ direction), 0.0, np.inf, 1.0
    best: _Step | None = None
    for k in range(_SEARCH):
        point = x + t * direction
        found, G = function(point)
        if not found <= value + _DECREASE * t * slope:
            high = t
        else:
            best = _Step(point, found, G)
            if float(G @ direction) >= _CURVATURE * slope:
                break
            low = t
        t = (low + high) / 2 if np.isfinite(high) else 2 * low
        if best is not None and k > 12:
            break
    return best
