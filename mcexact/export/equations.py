"""What each agent computes in a step: sums of signals, in a fixed order, in double precision.

A step of an agent has three parts.  It takes its outputs y, its set-points r, and what it received
from others; it computes its inputs u and its next states x, which it sends, and z, which it keeps;
and it puts the next states in the place of the old ones.  What others receive of it are its outputs
and, perhaps held for some steps, its x.

`steps_of` writes this as an `AgentStep` for each agent: rows of terms, each a number times a
signal, to be added from the left to the right.  `AgentRun` carries it out in double precision.  The
writers of code (`export.code`) write the same sums in the same order, so that they
compute the same bits where a compiler does not contract a product and a sum.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any, Literal

from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix, to_float
from mcexact.exact.rational import rational_text
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.text import quoted

FORMAT = "mcexact-code/1"
EQUATIONS, CONTROLLER = "equations.json", "controller.json"
"""The files that every folder of code contains."""
Language = Literal["c", "st", "json"]
Kind = Literal["y", "x", "z", "r"]


@dataclass(frozen=True)
class Signal:
    """One entry of y_j, x_j, or of the agent's own z and r.

    Attributes
    ----------
    kind : {"y", "x", "z", "r"}
    agent : int
        j; the agent itself for z and r.
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

    @property
    def remembered(self) -> int:
        """For how many steps old values of x are kept."""
        return max([self.held, *self.sent.values()], default=0)

    def rows(self) -> Iterator[Row]:
        """All sums."""
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
    >>> from mcexact import MultiChannelSystem, local_controllers
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
    )
    if not all(isfinite(to_float(c)) for row in made.rows() for c, _ in row):
        raise InputError(f"agent {quoted(agent.name)} has a number beyond double precision")
    return made


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
    return tuple(
        tuple(
            (M[row, k], Signal(kind, j, k))
            for kind, j, M in parts
            for k in range(M.ncols)
            if M[row, k]
        )
        for row in range(size)
    )


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
    "r", "s", "u", "x", "y", "z",
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
    >>> from mcexact import MultiChannelSystem, local_controllers
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
        u, x, z = ([_sum(row, own) for row in self._sums[part]] for part in ("u", "x", "z"))
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

    Each term is ``[number, double, signal]``, the number exactly as certified.
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
            }
            for step in steps
        ],
    }
