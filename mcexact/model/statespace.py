"""Conversion of python-control systems to plants with channels, and to closed loops."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.arguments import several
from mcexact.errors import InputError
from mcexact.exact.floats import Rounding, from_float, matrix_from_float
from mcexact.exact.matrix import Matrix
from mcexact.model.names import nearest, quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

Signals = int | str | Iterable[int | str]
"""One signal or several, each by its position or its label."""
Channels = Mapping[str, tuple[Signals, Signals]] | Sequence[tuple[Signals, Signals]]


def from_statespace(
    statespace: Any,
    channels: Channels,
    *,
    rounding: Rounding,
    neighbors: NeighborGraph | Mapping[str, Iterable[str]] | None = None,
) -> MultiChannelSystem:
    """Convert a python-control state-space system to a multi-channel system.

    Parameters
    ----------
    statespace : control.StateSpace
        With D = 0.
    channels : sequence of m pairs, or mapping from m names to pairs
        The inputs and the outputs of each channel.  A signal is given by its position or its label,
        and several signals by a list; a signal belongs to at most one channel.
    rounding : {"decimal", "dyadic"}
        How its floats become exact numbers, as in `MultiChannelSystem.from_float`.  There is no
        default, since python-control has already rounded fractions, and integers above 2**53.
    neighbors : optional
        As in `MultiChannelSystem`.

    Returns
    -------
    MultiChannelSystem
        A system in discrete time if ``statespace.dt`` is True or positive.

    Raises
    ------
    InputError
        If D is not zero, a signal is unknown or used twice, or an entry is not finite.

    Examples
    --------
    >>> import control
    >>> plant = control.ss(
    ...     [[0, 1], [0, -0.1]], [[0], [1]], [[1, 0]], [[0]], inputs=["force"], outputs=["place"]
    ... )
    >>> found = from_statespace(plant, channels={"cart": ("force", "place")}, rounding="decimal")
    >>> found.names, found.A[1, 1]
    (('cart',), Fraction(-1, 10))
    >>> from_statespace(plant, channels=[("force", "speed")], rounding="decimal")
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[0] outputs: there is no signal 'speed'; the signals are \
'place'
    """
    A, B, C, D = _matrices(statespace, "ABCD", rounding)
    if not D.is_zero():
        raise InputError(
            "expected D = 0: outputs are y_i = C_i x, without direct feedthrough of an input; "
            "the theory used here does not cover it",
            where="statespace.D",
        )
    names, pairs = _listed(channels)
    shown = [quoted(name) for name in names] if names else list(map(str, range(len(pairs))))
    columns, rows = (
        _split(
            [pair[side] for pair in pairs],
            getattr(statespace, f"{what}_labels", None),
            count,
            [f"channels[{label}] {what}s" for label in shown],
        )
        for side, what, count in ((0, "input", B.ncols), (1, "output", C.nrows))
    )
    time, sample_time = sampling(statespace.dt, rounding)
    return MultiChannelSystem(
        A,
        [B.take(cols=chosen) for chosen in columns],
        [C.take(rows=chosen) for chosen in rows],
        time=time,
        names=names,
        neighbors=neighbors,
        sample_time=sample_time,
    )


def loop_from_statespace(statespace: Any, *, rounding: Rounding) -> MultiChannelSystem:
    """Convert a closed loop made with python-control, such as ``control.feedback(P, K)``.

    Parameters
    ----------
    statespace : control.StateSpace
        Only its matrix A is used; inputs, outputs and D may be arbitrary.
    rounding : {"decimal", "dyadic"}
        How its floats become exact numbers, as in `MultiChannelSystem.from_float`.

    Returns
    -------
    MultiChannelSystem
        A system with one channel without inputs and outputs, for `certify_stability`.

    Raises
    ------
    InputError
        If it is not a state-space system, or an entry is not finite.

    Examples
    --------
    >>> import control
    >>> loop = control.feedback(control.ss([[1]], [[1]], [[1]], [[0]]), 3)
    >>> loop_from_statespace(loop, rounding="decimal").A.rows()
    ((Fraction(-2, 1),),)
    """
    (A,) = _matrices(statespace, "A", rounding)
    time, sample_time = sampling(statespace.dt, rounding)
    N = A.nrows
    return MultiChannelSystem(
        A,
        [Matrix.zeros(N, 0)],
        [Matrix.zeros(0, N)],
        time=time,
        names=["loop"],
        sample_time=sample_time,
    )


def _matrices(statespace: Any, parts: str, rounding: Rounding) -> list[Matrix]:
    """Some matrices of a state-space system."""
    if not all(hasattr(statespace, part) for part in (*parts, "dt")):
        raise InputError(
            f"expected a control.StateSpace, found {type(statespace).__name__}; "
            "control.ss makes one of a transfer function",
            where="statespace",
        )
    return [
        matrix_from_float(getattr(statespace, part), rounding, where=f"statespace.{part}")
        for part in parts
    ]


def sampling(dt: Any, rounding: Rounding) -> tuple[str, Fraction | None]:
    """Time domain and sample time; None and 0 mean continuous time, True an unknown sample time.

    Parameters
    ----------
    dt : None, bool or float
        The attribute ``dt`` of a state-space system.
    rounding : {"decimal", "dyadic"}
        How the sample time becomes a rational number, as in `MultiChannelSystem.from_float`.

    Examples
    --------
    >>> sampling(0.1, "decimal"), sampling(True, "decimal"), sampling(None, "decimal")
    (('discrete', Fraction(1, 10)), ('discrete', None), ('continuous', None))
    """
    if dt is True:
        return "discrete", None
    if dt is None or dt == 0:
        return "continuous", None
    return "discrete", from_float(float(dt), rounding, where="statespace.dt")


def _listed(channels: Channels) -> tuple[list[str] | None, list[tuple[Signals, Signals]]]:
    """Return the names, if there are some, and the pairs of inputs and outputs."""
    names = None
    if isinstance(channels, Mapping):
        names, channels = list(channels), list(channels.values())
    pairs = list(several(channels, "channels", "pairs (inputs, outputs)"))
    if not pairs:
        raise InputError("expected at least one channel, found none", where="channels")
    for k, pair in enumerate(pairs):
        if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
            raise InputError(
                f"expected a pair (inputs, outputs), found {pair!r}; "
                'write (0, 0), ("force", "place") or ([0, 1], [2])',
                where=f"channels[{quoted(names[k]) if names else k}]",
            )
    return names, pairs


def _split(
    signals: Sequence[Signals], labels: Sequence[str] | None, count: int, places: Sequence[str]
) -> list[list[int]]:
    """Return the positions of each channel's signals."""
    known = list(labels or ())
    used: set[int] = set()
    split = []
    for chosen, place in zip(signals, places, strict=True):
        listed = [chosen] if isinstance(chosen, (str, int)) else chosen
        positions = [_position(signal, known, count, place) for signal in listed]
        for position in positions:
            if position in used:
                raise InputError(f"the signal {position} is used twice", where=place)
            used.add(position)
        split.append(positions)
    return split


def _position(signal: int | str, known: list[str], count: int, place: str) -> int:
    """Return the position of a signal that is given by its position or its label."""
    if isinstance(signal, str):
        if signal not in known:
            hint = nearest(signal, known) or f"; the signals are {', '.join(map(quoted, known))}"
            raise InputError(f"there is no signal {quoted(signal)}{hint}", where=place)
        return known.index(signal)
    if isinstance(signal, bool) or not hasattr(signal, "__index__"):
        raise InputError(f"expected a position or a label, found {signal!r}", where=place)
    if not 0 <= signal < count:
        raise InputError(f"expected positions 0 … {count - 1}, found {signal}", where=place)
    return int(signal)
