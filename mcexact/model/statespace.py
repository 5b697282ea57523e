"""Conversion from and to python-control.

A state-space system of python-control is one matrix of inputs and one of outputs in floats, so
`from_statespace` needs to know which signals belong to which channel, and how floats become
exact.  `to_statespace` converts a plant, a controller or a closed loop to floats.
`local_controllers` makes one decentralized controller of matrices or systems of python-control,
one for each channel.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import (
    FloatRefused,
    InputError,
    MissingExtra,
    UsageError,
    several,
    warn_of_rounding,
)
from mcexact.exact.matrix import (
    BINARY,
    Matrix,
    Rounding,
    from_float,
    hstack,
    matrix_from_float,
    matrix_to_float,
    vstack,
)
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.entries import as_matrix, require_shape, require_square
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem, any_system, read_by, with_links
from mcexact.model.text import nearest, quoted

# Conversion of python-control systems to plants with channels, and to closed loops.

Signals = int | str | Iterable[int | str]
"""One signal or several, each by its position or its label."""
Channels = Mapping[str, tuple[Signals, Signals]] | Sequence[tuple[Signals, Signals]]


def from_statespace(
    statespace: Any,
    channels: Channels,
    *,
    rounding: Rounding = BINARY,
    neighbors: NeighborGraph | Mapping[str, Iterable[str]] | None = None,
) -> MultiChannelSystem:
    """Convert a python-control state-space system to a multi-channel system.

    Parameters
    ----------
    statespace : control.StateSpace
        Its D is the feedthrough of the system.
    channels : sequence of m pairs, or mapping from m names to pairs
        The inputs and the outputs of each channel.  A signal is given by its position or its label,
        and several signals by a list; a signal belongs to at most one channel.
    rounding : {"decimal", "dyadic", "simplest"}
        How its floats become exact numbers, as in `MultiChannelSystem.from_float`.  By default a
        fraction that python-control rounded, such as 1/3, becomes this fraction again.
    neighbors : optional
        As in `MultiChannelSystem`.

    Returns
    -------
    MultiChannelSystem
        A system in discrete time if ``statespace.dt`` is True or positive.

    Raises
    ------
    InputError
        If a signal is unknown or used twice, or an entry is not finite.

    Examples
    --------
    >>> import control
    >>> plant = control.ss(
    ...     [[0, 1], [0, -0.1]], [[0], [1]], [[1, 0]], [[0]], inputs=["force"], outputs=["place"]
    ... )
    >>> cart = from_statespace(plant, channels={"cart": ("force", "place")})
    >>> cart.names, cart.A[1, 1]
    (('cart',), Fraction(-1, 10))
    >>> from_statespace(plant, channels=[("force", "speed")])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[0] outputs: there is no signal 'speed'; the signals are \
'place'
    """
    A, B, C, D = _matrices(statespace, "ABCD", rounding)
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
    made = MultiChannelSystem(
        A,
        [B.take(cols=chosen) for chosen in columns],
        [C.take(rows=chosen) for chosen in rows],
        D=D.take(
            rows=[k for part in rows for k in part], cols=[k for part in columns for k in part]
        ),
        time=time,
        names=names,
        neighbors=neighbors,
        sample_time=sample_time,
    )
    return warn_of_rounding(read_by(rounding, made, _tables(statespace, "ABCD")))


def loop_from_statespace(statespace: Any, *, rounding: Rounding = BINARY) -> MultiChannelSystem:
    """Convert a closed loop made with python-control, such as ``control.feedback(P, K)``.

    Parameters
    ----------
    statespace : control.StateSpace
        Only its matrix A is used; inputs, outputs and D may be arbitrary.
    rounding : {"decimal", "dyadic", "simplest"}
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
    >>> loop_from_statespace(loop).A.rows()
    ((Fraction(-2, 1),),)
    """
    (A,) = _matrices(statespace, "A", rounding)
    time, sample_time = sampling(statespace.dt, rounding)
    N = A.nrows
    made = MultiChannelSystem(
        A,
        [Matrix.zeros(N, 0)],
        [Matrix.zeros(0, N)],
        time=time,
        names=["loop"],
        sample_time=sample_time,
    )
    return read_by(rounding, made, _tables(statespace, "A"))


def _tables(statespace: Any, parts: str) -> list[Any]:
    """Some matrices of a state-space system and its sample time, in floats."""
    dt = statespace.dt
    return [*(getattr(statespace, part) for part in parts), [[0 if dt is None else dt]]]


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
    rounding : {"decimal", "dyadic", "simplest"}
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
    """Return the position of a signal, from its position or its label."""
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


# Conversion of plants, controllers and closed loops to systems of python-control.

Parts = tuple[Matrix, Matrix, Matrix, Matrix]


def to_statespace(subject: Any, plant: MultiChannelSystem | None = None) -> Any:
    """Convert a plant, a controller or a closed loop to a state-space system of python-control.

    Parameters
    ----------
    subject : MultiChannelSystem, Controller, ClosedLoop, CertifiedLoop or Design
        - A system gets the inputs ``u[…]`` and the outputs ``y[…]`` of all channels.
        - A controller gets the inputs ``y[…]`` of all agents, then the set-points ``r[…]`` if it
          uses some, and the outputs ``u[…]``.  The sign is u = +K y, as everywhere here:
          ``control.feedback(P, K, sign=1)`` closes the loop.
        - A closed loop gets the inputs ``d[…]``, which are added to the agents' inputs u, then the
          set-points, and the outputs ``y[…]``.
    plant : MultiChannelSystem, optional
        The system that a controller is for, with its neighbor graph and delays.

    Returns
    -------
    control.StateSpace
        A signal is labeled by its channel, such as ``u[pump]``, or ``u[pump,0]`` if the channel has
        several.  In discrete time ``dt`` is the plant's sample time, or True.

    Raises
    ------
    UsageError
        If it is something else, or a controller without its plant.
    MissingExtra
        If python-control is not installed.

    Notes
    -----
    python-control computes in floating point, so that every entry is rounded to the nearest float.
    `from_statespace` and `loop_from_statespace` convert back, by the rounding "simplest" or
    another.  A link with delays makes the messages under way states of the controller.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> tanks = to_statespace(gallery.load("quadruple-tank-pminus"))
    >>> tanks.nstates, tanks.input_labels
    (4, ['u[1]', 'u[2]'])
    """
    loop = getattr(subject, "loop", subject)
    loop = getattr(loop, "closed", loop)
    if isinstance(loop, ClosedLoop):
        return _statespace(loop.plant, _of_loop(loop), ("d", "r")[: 1 + _tracks(loop)], ("y",))
    if isinstance(subject, MultiChannelSystem):
        B, C = subject.input_matrix(), subject.output_matrix()
        parts = subject.A, B, C, subject.feedthrough_matrix()
        return _statespace(subject, parts, ("u",), ("y",))
    if isinstance(subject, Controller):
        if plant is None:
            raise UsageError("a controller needs its plant: write to_statespace(controller, plant)")
        alone = _without_dynamics(plant, subject)
        parts = _of_controller(alone)
        return _statespace(plant, parts, ("y", "r")[: 1 + _tracks(alone)], ("u",))
    raise UsageError(
        "expected a MultiChannelSystem, a Controller, a closed loop or a Design, "
        f"found {type(subject).__name__}"
    )


def _tracks(loop: ClosedLoop) -> int:
    """1 if the controller uses set-points, otherwise 0."""
    maps = (each for agent in loop.controller.agents for each in agent.maps())
    return int(any(each.without_zeros().reference is not None for each in maps))


def _of_loop(loop: ClosedLoop) -> Parts:
    """The loop from disturbances of all inputs, and set-points if it has some, to all outputs."""
    plant, N = loop.plant, loop.dimension
    disturbed = plant.input_matrix()
    B = vstack([disturbed, Matrix.zeros(N - plant.n, disturbed.ncols)], ncols=disturbed.ncols)
    if _tracks(loop):
        B = hstack([B, loop.reference], nrows=N)
    C = plant.output_matrix() @ loop.pick("x")
    return loop.matrix, B, C, Matrix.zeros(C.nrows, B.ncols)


def _without_dynamics(plant: MultiChannelSystem, controller: Controller) -> ClosedLoop:
    """The loop of a controller and a plant whose state is its outputs, which no input changes.

    The rows of its matrix below this state are the controller's equations, over the outputs of the
    plant and the states of the agents.
    """
    plant, graph = with_links(plant)
    counts = [plant.q(i) for i in range(plant.m)]
    eye, starts = Matrix.identity(sum(counts)), [sum(counts[:i]) for i in range(plant.m)]
    outputs = MultiChannelSystem(
        Matrix.zeros(sum(counts), sum(counts)),
        [Matrix.zeros(sum(counts), plant.p(i)) for i in range(plant.m)],
        [eye.take(rows=range(start, start + q)) for start, q in zip(starts, counts, strict=True)],
        time=plant.time,
        names=plant.names,
        neighbors=plant.neighbors,
    )
    return closed_loop(outputs, controller, graph)


def _of_controller(loop: ClosedLoop) -> Parts:
    """The controller from all outputs, and set-points if it uses some, to all inputs."""
    agents, plant = loop.controller.agents, loop.plant
    signals, states = range(plant.n), range(plant.n, loop.dimension)
    used = vstack(
        [loop.rows(agent.input, i, plant.p(i)) for i, agent in enumerate(agents)],
        ncols=loop.dimension,
    )
    B, D = loop.matrix.take(rows=states, cols=signals), used.take(cols=signals)
    if _tracks(loop):
        direct = [
            _spread(agent.input.reference, i, plant.p(i), plant) for i, agent in enumerate(agents)
        ]
        B = hstack([B, loop.reference.take(rows=states)], nrows=len(states))
        D = hstack([D, vstack(direct, ncols=plant.n)], nrows=D.nrows)
    return loop.matrix.take(rows=states, cols=states), B, used.take(cols=states), D


def _spread(M: Matrix | None, i: int, nrows: int, plant: MultiChannelSystem) -> Matrix:
    """The coefficients of r_i as coefficients of all set-points."""
    parts = [Matrix.zeros(nrows, plant.q(j)) for j in range(plant.m)]
    if M is not None:
        parts[i] = M
    return hstack(parts, nrows=nrows)


def _statespace(
    plant: MultiChannelSystem, parts: Parts, inputs: Sequence[str], outputs: Sequence[str]
) -> Any:
    """Make the system of python-control, with labels and the time domain of the plant."""
    with MissingExtra.named("control"):
        import control

    return control.ss(
        *(matrix_to_float(part) for part in parts),
        plant.dt,
        inputs=[label for letter in inputs for label in _labels(letter, plant)],
        outputs=[label for letter in outputs for label in _labels(letter, plant)],
        name=plant.name or None,
    )


def _labels(letter: str, plant: MultiChannelSystem) -> list[str]:
    """The labels of the inputs (u, d) or of the outputs and set-points (y, r) of all channels."""
    size = plant.p if letter in "ud" else plant.q
    return [
        f"{letter}[{name}]" if size(i) == 1 else f"{letter}[{name},{k}]"
        for i, name in enumerate(plant.names)
        for k in range(size(i))
    ]


# Decentralized controllers from matrices or python-control systems, one for each channel.


def local_controllers(
    system: MultiChannelSystem, parts: Sequence[Any], *, rounding: Rounding | None = None
) -> Controller:
    """Make a controller from local controllers z_i' = A z_i + B y_i, u_i = C z_i + D y_i.

    Parameters
    ----------
    system : MultiChannelSystem
        m channels.
    parts : sequence of m parts
        Each part is four matrices (A, B, C, D) of shapes k×k, k×q_i, p_i×k and p_i×q_i; or a
        `control.StateSpace`; or one matrix D, a static gain.  The sign is u_i = +K y_i: negate a
        controller made for negative feedback.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats become exact numbers; required if there are floats.

    Returns
    -------
    Controller

    Raises
    ------
    InputError
        If a shape or the number of parts is not as expected, or there are floats and no rounding.

    Examples
    --------
    >>> from mcexact.model.loop import closed_loop
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> controller = local_controllers(plant, [([[-5]], [[1]], [[-6]], [[0]])])
    >>> closed_loop(plant, controller).matrix.numerators
    ((0, -6), (1, -5))
    """
    any_system(system)
    parts = several(parts, "parts", "controllers, one for each channel")
    if len(parts) != system.m:
        raise InputError(f"expected {system.m} controllers, found {len(parts)}", where="parts")
    agents = tuple(
        _program(system, i, part, f"parts[{i}]", rounding) for i, part in enumerate(parts)
    )
    return Controller(system.time, system.digest_of_values(), agents)


def _program(
    system: MultiChannelSystem, i: int, part: Any, where: str, rounding: Rounding | None
) -> AgentProgram:
    """Make the program of agent i, whose state is private."""
    p, q = system.p(i), system.q(i)
    if all(hasattr(part, name) for name in ("A", "B", "C", "D", "dt")):
        time, _ = sampling(part.dt, "decimal")
        if time != system.time:
            raise InputError(f"the controller is in {time} time", where=where)
        parts: tuple[Any, ...] = (part.A, part.B, part.C, part.D)
    elif isinstance(part, tuple) and len(part) == 4:
        parts = part
    elif isinstance(part, tuple):
        raise InputError(f"expected (A, B, C, D), found {len(part)} matrices", where=where)
    else:
        parts = ((), Matrix.zeros(0, q), Matrix.zeros(p, 0), part)

    def matrix(k: int, ncols: int | None = None) -> Matrix:
        value, place = parts[k], f"{where}.{'ABCD'[k]}"
        empty = hasattr(value, "__len__") and not len(value)
        if rounding is not None and not empty and not isinstance(value, Matrix):
            return matrix_from_float(value, rounding, where=place)
        try:
            return as_matrix(value, place, ncols=ncols)
        except FloatRefused:
            raise FloatRefused(
                'a float is not exact: give local_controllers the rounding "decimal", which reads '
                '0.1 as 1/10, or "dyadic", which takes the binary value',
                where=place,
            ) from None

    A = require_square(matrix(0), f"{where}.A")
    k = A.nrows
    B = require_shape(matrix(1, q), f"{where}.B", k, q)
    C = require_shape(matrix(2, k), f"{where}.C", p, k)
    D = require_shape(matrix(3, q), f"{where}.D", p, q)
    return AgentProgram(
        system.names[i],
        0,
        k,
        private_update=LinearMap({i: B}, private=A).without_zeros(),
        input=LinearMap({i: D}, private=C).without_zeros(),
    )
