"""Conversion of plants, controllers and closed loops to systems of python-control."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.errors import MissingExtra, UsageError
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.floats import matrix_to_float, to_float
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import Controller
from mcexact.model.linked_system import with_links
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem

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
    `from_statespace` and `loop_from_statespace` convert back, by a rounding of your choice.  A link
    with delays makes the messages under way states of the controller.

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
        return _statespace(loop.given, _of_loop(loop), ("d", "r")[: 1 + _tracks(loop)], ("y",))
    if isinstance(subject, MultiChannelSystem):
        B, C = subject.input_matrix(), subject.output_matrix()
        parts = subject.A, B, C, Matrix.zeros(C.nrows, B.ncols)
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
    given, N = loop.given, loop.dimension
    disturbed = given.input_matrix()
    B = vstack([disturbed, Matrix.zeros(N - given.n, disturbed.ncols)], ncols=disturbed.ncols)
    if _tracks(loop):
        B = hstack([B, loop.reference], nrows=N)
    C = given.output_matrix() @ loop.pick("x")
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
    agents, given = loop.controller.agents, loop.given
    signals, states = range(given.n), range(given.n, loop.dimension)
    used = vstack(
        [loop.rows(agent.input, i, given.p(i)) for i, agent in enumerate(agents)],
        ncols=loop.dimension,
    )
    B, D = loop.matrix.take(rows=states, cols=signals), used.take(cols=signals)
    if _tracks(loop):
        direct = [
            _spread(agent.input.reference, i, given.p(i), given) for i, agent in enumerate(agents)
        ]
        B = hstack([B, loop.reference.take(rows=states)], nrows=len(states))
        D = hstack([D, vstack(direct, ncols=given.n)], nrows=D.nrows)
    return loop.matrix.take(rows=states, cols=states), B, used.take(cols=states), D


def _spread(M: Matrix | None, i: int, nrows: int, given: MultiChannelSystem) -> Matrix:
    """The coefficients of r_i as coefficients of all set-points."""
    parts = [Matrix.zeros(nrows, given.q(j)) for j in range(given.m)]
    if M is not None:
        parts[i] = M
    return hstack(parts, nrows=nrows)


def _statespace(
    plant: MultiChannelSystem, parts: Parts, inputs: Sequence[str], outputs: Sequence[str]
) -> Any:
    """Make the system of python-control, with labels and the time domain of the plant."""
    with MissingExtra.named("control"):
        import control

    dt: Any = 0
    if is_discrete(plant.time):
        dt = True if plant.sample_time is None else to_float(plant.sample_time)
    return control.ss(
        *(matrix_to_float(part) for part in parts),
        dt,
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
