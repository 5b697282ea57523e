"""Conversion of python-control systems to plants with channels, and to closed loops."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.floats import Rounding, from_float, matrix_from_float
from mcexact.exact.matrix import Matrix
from mcexact.model.names import nearest, quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

Signals = Sequence[Iterable[int | str]]


def from_statespace(
    statespace: Any,
    inputs: Signals,
    outputs: Signals,
    *,
    rounding: Rounding,
    names: Sequence[str] | None = None,
    neighbors: NeighborGraph | Mapping[str, Iterable[str]] | None = None,
) -> MultiChannelSystem:
    """Convert a python-control state-space system to a multi-channel system.

    Parameters
    ----------
    statespace : control.StateSpace
        With D = 0.
    inputs, outputs : sequence of m iterables of int or str
        The signals of each channel, by position or by label.  A signal belongs to at most one
        channel.
    rounding : {"decimal", "dyadic"}
        How its floats become exact numbers, as in `MultiChannelSystem.from_float`.  There is no
        default, since python-control has already rounded fractions, and integers above 2**53.
    names, neighbors : optional
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
    >>> plant = control.ss([[0, 1], [0, -0.1]], [[0], [1]], [[1, 0]], [[0]])
    >>> from_statespace(plant, inputs=[[0]], outputs=[[0]], rounding="decimal").A[1, 1]
    Fraction(-1, 10)
    """
    A, B, C, D = _matrices(statespace, "ABCD", rounding)
    if not D.is_zero():
        raise InputError(
            "expected D = 0: outputs are y_i = C_i x, without direct feedthrough of an input; "
            "the theory used here does not cover it",
            where="statespace.D",
        )
    columns = _split(inputs, B.ncols, getattr(statespace, "input_labels", None), "inputs")
    rows = _split(outputs, C.nrows, getattr(statespace, "output_labels", None), "outputs")
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


def _split(
    signals: Signals, count: int, labels: Sequence[str] | None, where: str
) -> list[list[int]]:
    """Return the positions of each channel's signals."""
    known = list(labels or ())
    used: set[int] = set()
    split = []
    for k, chosen in enumerate(signals):
        place = f"{where}[{k}]"
        if isinstance(chosen, (str, int)):
            raise InputError(
                f"expected a list of signals, found {chosen!r}; write [{chosen!r}]", where=place
            )
        positions = []
        for signal in chosen:
            if isinstance(signal, str):
                if signal not in known:
                    raise InputError(
                        f"there is no signal {quoted(signal)}{nearest(signal, known)}", where=place
                    )
                signal = known.index(signal)
            if isinstance(signal, bool) or not isinstance(signal, int):
                raise InputError(f"expected a position or a label, found {signal!r}", where=place)
            if not 0 <= signal < count:
                raise InputError(f"expected positions 0 … {count - 1}, found {signal}", where=place)
            if signal in used:
                raise InputError(f"the signal {signal} is used twice", where=place)
            used.add(signal)
            positions.append(signal)
        split.append(positions)
    return split
