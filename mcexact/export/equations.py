"""What each agent computes in a step: sums of signals, in a fixed order, in double precision.

A step of an agent has three parts.  It takes its outputs y, its set-points r, and what it received
from others; it computes its inputs u and its next states x, which it sends, and z, which it keeps;
and it puts the next states in the place of the old ones.  What others receive of it are its outputs
and, perhaps held for some steps, its x.  Inputs with limits are cut off as soon as they are
computed, and e, by how much that changed them, is one of the signals of the next states
(back-calculation).

A run starts with zeros, or without a bump: `AgentStep.start` gives the states in which an agent is
at rest while y and r stay what they are at first.  It exists where the agent uses no signals of
others and has no integrator.

`steps_of` writes this as an `AgentStep` for each agent: rows of terms, each a number times a
signal, to be added from the left to the right.  `AgentRun` carries it out in double precision.  The
writers of code (`export.code`) write the same sums in the same order, so that they
compute the same bits where a compiler does not contract a product and a sum.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any, Literal

from mcexact.errors import InputError, UsageError
from mcexact.exact.linear_algebra import solve
from mcexact.exact.matrix import Matrix, hstack, to_float, vstack
from mcexact.exact.rational import rational_text
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.limits import Range
from mcexact.model.text import quoted

FORMAT = "mcexact-code/1"
EQUATIONS, CONTROLLER = "equations.json", "controller.json"
"""The files that every folder of code contains."""
Language = Literal["c", "st", "json"]
Kind = Literal["y", "x", "z", "r", "e"]


@dataclass(frozen=True)
class Signal:
    """One entry of y_j, x_j, or of the agent's own z, r and e.

    Attributes
    ----------
    kind : {"y", "x", "z", "r", "e"}
    agent : int
        j; the agent itself for z, r and e.
    entry : int
        From 0 on.
    """

    kind: Kind
    agent: int
    entry: int


Row = tuple[tuple[Fraction, Signal], ...]
"""A sum of numbers times signals, from the left to the right."""


@dataclass(frozen=True)
class AgentStep:
    """What one agent computes in a step.

    Attributes
    ----------
    name, identifier : str
        The agent, and its name in code.
    position : int
    outputs, references : int
        The numbers of entries of y and r; 0 where it uses none.
    received : tuple of (kind, j, size)
        The signals of others that it uses.
    sent : mapping of int to int
        The followers that use its x, and for how many steps it holds x for each.
    held : int
        For how many steps it holds x before it uses it itself.
    u, x, z : tuple of Row
        The inputs, and the next states.
    limits : tuple of pairs of Fraction, or None
        At which each input is cut off; None for one without limits.
    start : tuple of Row, or None
        The states (x, z) in which the agent is at rest with its first y and r, as sums of these;
        None where it starts at 0, or one of their numbers is beyond double precision.
    """

    name: str
    identifier: str
    position: int
    outputs: int
    references: int
    received: tuple[tuple[Kind, int, int], ...]
    sent: Mapping[int, int]
    held: int
    u: tuple[Row, ...]
    x: tuple[Row, ...]
    z: tuple[Row, ...]
    limits: tuple[Range | None, ...] = ()
    start: tuple[Row, ...] | None = None

    @property
    def winds(self) -> bool:
        """Whether the next states depend on by how much inputs were cut off."""
        return any(signal.kind == "e" for row in (*self.x, *self.z) for _, signal in row)

    def cut(self) -> Iterator[tuple[int, float, float]]:
        """The inputs with limits, as doubles."""
        for k, pair in enumerate(self.limits):
            if pair is not None:
                yield k, to_float(pair[0]), to_float(pair[1])

    @property
    def remembered(self) -> int:
        """For how many steps old values of x are kept."""
        return max([self.held, *self.sent.values()], default=0)

    def rows(self) -> Iterator[Row]:
        """The sums of a step, whose numbers are those of the controller."""
        yield from (*self.u, *self.x, *self.z)


def steps_of(controller: Controller) -> tuple[AgentStep, ...]:
    """Write the program of each agent as sums.

    Parameters
    ----------
    controller : Controller
        In discrete time.

    Raises
    ------
    UsageError
        If the controller is in continuous time.
    InputError
        If a number is beyond double precision.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> [step] = steps_of(local_controllers(plant, [[["-1/2"]]]))
    >>> step.identifier, step.u
    ('agent_1', (((Fraction(-1, 2), Signal(kind='y', agent=0, entry=0)),),))
    """
    InputError.require(controller, Controller, "controller")
    if not is_discrete(controller.time):
        raise UsageError(
            "only a controller in discrete time is a program of steps; design one for the sampled "
            "plant, which `mcexact c2d` writes"
        )
    names = identifiers([agent.name for agent in controller.agents])
    return tuple(_step(controller, i, names[i]) for i in range(len(controller.agents)))


def _step(controller: Controller, i: int, identifier: str) -> AgentStep:
    agents, agent = controller.agents, controller.agents[i]
    maps = [each.without_zeros() for each in agent.maps()]
    counts = (agent.shared, agent.private, _inputs(maps[2]))
    x, z, u = (_rows(each, i, size) for each, size in zip(maps, counts, strict=True))
    if agent.back_calculation is not None:
        added = _terms("e", i, agent.back_calculation)
        states = [row + more for row, more in zip((*x, *z), added, strict=True)]
        x, z = tuple(states[: agent.shared]), tuple(states[agent.shared :])
    received = list[tuple[Kind, int, int]]()
    for kind in ("y", "x"):
        sizes = {
            j: M.ncols
            for each in maps
            for j, M in (each.outputs if kind == "y" else each.shared).items()
        }
        received += [(kind, j, size) for j, size in sorted(sizes.items()) if j != i]
    own = [each.outputs[i].ncols for each in maps if i in each.outputs]
    asked = [each.reference.ncols for each in maps if each.reference is not None]
    followers = [j for j, other in enumerate(agents) if j != i and _uses_shared(other, i)]
    made = AgentStep(
        agent.name,
        identifier,
        i,
        max(own, default=0),
        max(asked, default=0),
        tuple(received),
        {j: agent.hold.get(j, 0) for j in followers},
        agent.hold.get(i, 0) if any(i in each.shared for each in maps) else 0,
        u,
        x,
        z,
        tuple(agent.limits or ()),
        _start(agent, i, (max(own, default=0), max(asked, default=0))),
    )
    limits = (end for pair in made.limits if pair is not None for end in pair)
    if not (_are_doubles(made.rows()) and all(isfinite(to_float(end)) for end in limits)):
        raise InputError(f"agent {quoted(agent.name)} has a number beyond double precision")
    return made


def _are_doubles(rows: Iterable[Row]) -> bool:
    """Whether all numbers are within double precision."""
    return all(isfinite(to_float(c)) for row in rows for c, _ in row)


def _start(agent: AgentProgram, i: int, sizes: tuple[int, int]) -> tuple[Row, ...] | None:
    """The states in which an agent is at rest while its y and r stay as they are.

    With (x, z)' = A (x, z) + B y + R r they are (I − A)⁻¹(B y + R r).
    """
    others = any(j != i for each in agent.maps() for j in (*each.outputs, *each.shared))
    if others or not agent.shared + agent.private or agent.hold.get(i, 0):
        return None
    q, asked = sizes
    A, B, R = list[Matrix](), list[Matrix](), list[Matrix]()
    for each, size in zip(agent.maps()[:2], (agent.shared, agent.private), strict=True):
        none = Matrix.zeros(size, agent.private)
        own = each.private if each.private is not None else none
        A.append(hstack([each.shared.get(i, Matrix.zeros(size, agent.shared)), own], nrows=size))
        B.append(each.outputs.get(i, Matrix.zeros(size, q)))
        R.append(each.reference if each.reference is not None else Matrix.zeros(size, asked))
    count = agent.shared + agent.private
    whole = hstack([vstack(B, ncols=q), vstack(R, ncols=asked)], nrows=count)
    rest = solve(Matrix.identity(count) - vstack(A, ncols=count), whole)
    if rest is None:
        return None
    measured = _terms("y", i, rest.take(cols=range(q)))
    wanted = _terms("r", i, rest.take(cols=range(q, q + asked)))
    rows = tuple(y + r for y, r in zip(measured, wanted, strict=True))
    return rows if _are_doubles(rows) else None


def _terms(kind: Kind, j: int, M: Matrix) -> tuple[Row, ...]:
    """The rows of a matrix times a signal."""
    return tuple(
        tuple((M[row, k], Signal(kind, j, k)) for k in range(M.ncols) if M[row, k])
        for row in range(M.nrows)
    )


def _inputs(each: LinearMap) -> int:
    """The number of rows of a map; 0 if it uses nothing."""
    return max((M.nrows for M in each.matrices()), default=0)


def _uses_shared(agent: AgentProgram, j: int) -> bool:
    return any(j in each.without_zeros().shared for each in agent.maps())


def _rows(each: LinearMap, i: int, size: int) -> tuple[Row, ...]:
    """The sums of a map: outputs, sub-states, the private state, set-points."""
    parts: list[tuple[Kind, int, Matrix]] = [("y", j, M) for j, M in each.outputs.items()]
    parts += [("x", j, M) for j, M in each.shared.items()]
    parts += [("z", i, each.private)] if each.private is not None else []
    parts += [("r", i, each.reference)] if each.reference is not None else []
    rows: tuple[Row, ...] = ((),) * size
    for kind, j, M in parts:
        rows = tuple(row + more for row, more in zip(rows, _terms(kind, j, M), strict=True))
    return rows


def identifiers(names: Sequence[str]) -> list[str]:
    """Return different names that C and Structured Text take, in lower-case ASCII.

    Examples
    --------
    >>> identifiers(["left", "1", "Pump 2", "pump-2"])
    ['left', 'agent_1', 'pump_2', 'pump_2_4']
    """
    found = list[str]()
    for k, name in enumerate(names, start=1):
        plain = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
        plain = plain if plain[:1].isalpha() and plain not in _RESERVED else f"agent_{plain or k}"
        while plain in found:
            plain = f"{plain}_{k}"
        found.append(plain)
    return found


# fmt: off
_RESERVED = frozenset({
    "e", "r", "s", "start", "u", "x", "y", "z",
    "and", "array", "auto", "bool", "break", "by", "byte", "case", "char", "const", "continue",
    "default", "do", "double", "else", "end", "enum", "exit", "extern", "false", "float", "for",
    "function", "goto", "if", "inline", "int", "long", "lreal", "mod", "not", "of", "or",
    "program", "real", "register", "repeat", "restrict", "return", "short", "signed", "sizeof",
    "static", "struct", "switch", "then", "to", "true", "type", "typedef", "union", "unsigned",
    "until", "var", "void", "volatile", "while", "word", "xor",
})
# fmt: on
"""Words of C and of Structured Text, and the signals of a step."""


class AgentRun:
    """An agent that runs its step in double precision, as the exported code does.

    Parameters
    ----------
    step : AgentStep

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> [step] = steps_of(local_controllers(plant, [[["-1/2"]]]))
    >>> AgentRun(step)([3.0], [], {})
    [-1.5]
    """

    def __init__(self, step: AgentStep) -> None:
        self.step = step
        self.z = [0.0] * len(step.z)
        self.past = [[0.0] * len(step.x) for _ in range(step.remembered + 1)]
        self._sums = {
            part: [[(to_float(c), signal) for c, signal in row] for row in getattr(step, part)]
            for part in ("u", "x", "z")
        }

    def start(self, y: Sequence[float], r: Sequence[float]) -> None:
        """Put the states at rest for these outputs and set-points, or at 0."""
        own: dict[tuple[Kind, int], Sequence[float]] = {
            ("y", self.step.position): y,
            ("r", self.step.position): r,
        }
        rows = self.step.start or ((),) * (len(self.step.x) + len(self.step.z))
        rest = [_sum([(to_float(c), signal) for c, signal in row], own) for row in rows]
        x, self.z = rest[: len(self.step.x)], rest[len(self.step.x) :]
        self.past = [list(x) for _ in self.past]

    def sent_to(self, follower: int) -> list[float]:
        """What a follower receives of x in this step, before delays."""
        return self.past[self.step.sent[follower]]

    def __call__(
        self,
        y: Sequence[float],
        r: Sequence[float],
        received: Mapping[tuple[Kind, int], Sequence[float]],
    ) -> list[float]:
        """Run one step, and return the inputs.

        Parameters
        ----------
        y, r : sequences of float
        received : mapping of (kind, j)
            What arrives from others in this step.
        """
        own: dict[tuple[Kind, int], Sequence[float]] = {
            ("y", self.step.position): y,
            ("r", self.step.position): r,
            ("x", self.step.position): self.past[self.step.held],
            ("z", self.step.position): self.z,
            **received,
        }
        u = [_sum(row, own) for row in self._sums["u"]]
        computed = list(u)
        for k, low, high in self.step.cut():
            u[k] = low if u[k] < low else high if u[k] > high else u[k]
        own["e", self.step.position] = [a - v for a, v in zip(u, computed, strict=True)]
        x, z = ([_sum(row, own) for row in self._sums[part]] for part in ("x", "z"))
        self.past, self.z = [x, *self.past[:-1]], z
        return u


def _sum(
    row: Sequence[tuple[float, Signal]], known: Mapping[tuple[Kind, int], Sequence[float]]
) -> float:
    """Add products from the left to the right, each rounded."""
    total: float | None = None
    for c, signal in row:
        product = c * known[signal.kind, signal.agent][signal.entry]
        total = product if total is None else total + product
    return 0.0 if total is None else total


def equations_document(steps: Sequence[AgentStep], system: str) -> dict[str, Any]:
    """Return the sums of all agents, made for the plant of this digest, as plain data.

    Each term is ``[number, double, signal]``, the number exactly.
    """
    names = [step.name for step in steps]

    def terms(row: Row) -> list[list[Any]]:
        return [
            [rational_text(c), to_float(c), f"{s.kind}[{s.entry}] of {names[s.agent]}"]
            for c, s in row
        ]

    return {
        "format": FORMAT,
        "arithmetic": "double, products added from the left to the right",
        "order": "u, cut off at its limits; e, the input less what was computed; next x and z",
        "system": system,
        "agents": [
            {
                "name": step.name,
                "outputs": step.outputs,
                "references": step.references,
                "receives": [
                    {"signal": kind, "of": names[j], "entries": size}
                    for kind, j, size in step.received
                ],
                "sends x to": {names[j]: {"held": held} for j, held in step.sent.items()},
                "uses its x held for": step.held,
                **{
                    key: [terms(row) for row in rows]
                    for key, rows in (("u", step.u), ("next x", step.x), ("next z", step.z))
                },
                "limits": [
                    None if pair is None else [rational_text(end) for end in pair]
                    for pair in step.limits
                ],
                "start": None if step.start is None else [terms(row) for row in step.start],
            }
            for step in steps
        ],
    }
