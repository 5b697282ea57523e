"""Controllers as code: C99, and Structured Text of IEC 61131-3.

C: a header and a file for each agent, with a structure of its state, a function that resets it, one
that runs a step, and one for each follower that copies what is sent to it.  Nothing is allocated
and no library is used.  A step reads all of its arguments and writes the inputs before it changes
the state.  Compilers may contract a product and a sum to one rounding (`-ffp-contract=off` forbids
it to gcc and clang); then the last bits differ from those of `AgentRun`.

Structured Text: a function block for each agent, called once in each sampling period, after it was
given what was measured and received; then its outputs are the inputs of the plant, and what it
sends in the next period.  All numbers are of the type LREAL, and all states are 0 at first.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from mcexact.errors import one_of
from mcexact.exact.matrix import to_float
from mcexact.export.equations import AgentStep, Row, Signal, equations_document, steps_of
from mcexact.model.controller import Controller

INDENT = "    "
Language = Literal["c", "st", "json"]
EQUATIONS = "equations.json"
"""The file that every folder of code contains."""


def export_controller(controller: Controller, language: Language) -> dict[str, str]:
    """Write a controller as code.

    Parameters
    ----------
    controller : Controller
        In discrete time.
    language : {"c", "st", "json"}
        C99, Structured Text of IEC 61131-3, or the equations alone.

    Returns
    -------
    dict of str
        Files by name: ``equations.json`` with all sums, and the code of each agent.

    Raises
    ------
    UsageError
        If the controller is in continuous time, or the language is another one.
    InputError
        If a number is beyond double precision.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> sorted(export_controller(local_controllers(plant, [[["-1/2"]]]), "st"))
    ['agent_1.st', 'equations.json']
    """
    one_of(language, ("c", "st", "json"), "language")
    steps, system = steps_of(controller), controller.system
    files = {EQUATIONS: json.dumps(equations_document(steps, system), indent=1) + "\n"}
    for step in steps:
        if language == "c":
            files[f"{step.identifier}.h"] = _header(step, steps, system)
            files[f"{step.identifier}.c"] = _source(step, steps)
        elif language == "st":
            files[f"{step.identifier}.st"] = _block(step, steps, system)
    return files


# What both languages have in common.


@dataclass(frozen=True)
class Dialect:
    """How a language writes numbers, and the agent's own signals that a step reads.

    Attributes
    ----------
    number : callable
        Writes a double.
    x, z : str
        Before the index of its own x, with a field for the steps for which it is held, and z.
    break_ : str
        What stands before a further term.
    """

    number: Callable[[float], str]
    x: str
    z: str
    break_: str

    def sum(self, row: Row, step: AgentStep, steps: Sequence[AgentStep]) -> str:
        """The sum as an expression, which both languages add from the left to the right."""
        own = {"y": "y", "r": "r", "x": self.x.format(step.held), "z": self.z}

        def term(c: Fraction, signal: Signal) -> str:
            theirs = f"{signal.kind}_{steps[signal.agent].identifier}"
            name = own[signal.kind] if signal.agent == step.position else theirs
            return f"{self.number(to_float(c))} * {name}[{signal.entry}]"

        return f"{self.break_}+ ".join(term(c, signal) for c, signal in row) or "0.0"

    def sums(self, step: AgentStep, steps: Sequence[AgentStep], assign: str) -> list[str]:
        """The statements that compute u and the next states."""
        return [
            f"{target}[{k}] {assign} {self.sum(row, step, steps)};"
            for target, rows in (("u", step.u), ("next_x", step.x), ("next_z", step.z))
            for k, row in enumerate(rows)
        ]


def described(step: AgentStep, steps: Sequence[AgentStep], system: str) -> list[str]:
    """What the code is, line by line."""
    rounded, numbers = step.rounded()
    lines = [f"Agent {step.name!a} of a distributed controller in discrete time."]
    if system:
        lines.append(f"Made for the plant of digest {system}.")
    exact = f"All {numbers} numbers are those of the controller exactly."
    nearest = f"{rounded} of its {numbers} numbers are rounded to the nearest double."
    lines.append(nearest if rounded else exact)
    order = ["measure y", "run the step", "set u"]
    if step.sent or step.received:
        order[1:1] = ["send", "receive"]
    lines.append(f"In each sampling period: {', '.join(order)}.")
    for kind, j, _ in step.received:
        what = "outputs" if kind == "y" else "shared sub-state"
        lines.append(f"{kind}_{steps[j].identifier}: the {what} that agent {steps[j].name!a} sent.")
    if not step.u:
        lines.append("It sets no input: those of this agent stay 0.")
    if step.received:
        lines.append("Until a first message has arrived, what is received is 0.")
    # A name must neither end the comment that it stands in nor begin another one.
    return [line.replace("*", "\\x2a") for line in lines]


# C99.

C = Dialect(repr, "s->x[{}]", "s->z", f"\n{INDENT * 2}")


def signature(step: AgentStep, steps: Sequence[AgentStep]) -> str:
    """The declaration of the function that runs a step, without its semicolon."""
    arguments = [f"{step.identifier}_state *s"]
    arguments += [f"const double y[{step.outputs}]"] * bool(step.outputs)
    arguments += [f"const double r[{step.references}]"] * bool(step.references)
    for kind, j, size in step.received:
        arguments.append(f"const double {kind}_{steps[j].identifier}[{size}]")
    arguments += [f"double u[{len(step.u)}]"] * bool(step.u)
    return f"void {step.identifier}_step({', '.join(arguments)})"


def _header(step: AgentStep, steps: Sequence[AgentStep], system: str) -> str:
    name = step.identifier
    guard = f"{name.upper()}_H"
    comment = "\n".join(f" * {line}" for line in described(step, steps, system))
    members = [f"{INDENT}double x[{step.remembered + 1}][{len(step.x)}];"] * bool(step.x)
    members += [f"{INDENT}double z[{len(step.z)}];"] * bool(step.z)
    members = members or [f"{INDENT}char none;"]
    parts = [
        f"/*\n{comment}\n */",
        f"#ifndef {guard}\n#define {guard}",
        "typedef struct {\n" + "\n".join(members) + f"\n}} {name}_state;",
        f"void {name}_reset({name}_state *s);",
        *(f"{_send(step, steps, j)};" for j in step.sent),
        f"{signature(step, steps)};",
        "#endif",
    ]
    return "\n\n".join(parts) + "\n"


def _send(step: AgentStep, steps: Sequence[AgentStep], j: int) -> str:
    other, name = steps[j].identifier, step.identifier
    return f"void {name}_send_to_{other}(const {name}_state *s, double x[{len(step.x)}])"


def _source(step: AgentStep, steps: Sequence[AgentStep]) -> str:
    name, states, kept = step.identifier, len(step.x), len(step.z)
    reset = [f"s->x[{d}][{k}] = 0.0;" for d in range(step.remembered + 1) for k in range(states)]
    reset += [f"s->z[{k}] = 0.0;" for k in range(kept)]
    reset = reset or ["s->none = 0;"]
    functions = [_function(f"void {name}_reset({name}_state *s)", reset)]
    for j, held in step.sent.items():
        copied = [f"x[{k}] = s->x[{held}][{k}];" for k in range(states)]
        functions.append(_function(_send(step, steps, j), copied))
    body = [f"double next_x[{states}];"] * bool(states) + [f"double next_z[{kept}];"] * bool(kept)
    body += C.sums(step, steps, "=")
    for d in range(step.remembered, 0, -1):
        body += [f"s->x[{d}][{k}] = s->x[{d - 1}][{k}];" for k in range(states)]
    body += [f"s->x[0][{k}] = next_x[{k}];" for k in range(states)]
    body += [f"s->z[{k}] = next_z[{k}];" for k in range(kept)]
    body += [] if states or kept else ["(void)s;"]
    functions.append(_function(signature(step, steps), body))
    return f'#include "{name}.h"\n\n' + "\n".join(functions)


def _function(declaration: str, body: Sequence[str]) -> str:
    lines = "\n".join(f"{INDENT}{line}" for line in body)
    return f"{declaration}\n{{\n{lines}\n}}\n"


# Structured Text.


def literal(number: float) -> str:
    """A number of the type LREAL, which needs a point.

    Examples
    --------
    >>> literal(1e-05), literal(-2.0), literal(1.5e+300)
    ('1.0E-05', '-2.0', '1.5E+300')
    """
    digits, mark, exponent = repr(number).partition("e")
    digits = digits if "." in digits else f"{digits}.0"
    return f"{digits}E{exponent}" if mark else digits


TEXT = Dialect(literal, "x_{}", "z", f"\n{INDENT}")


def _block(step: AgentStep, steps: Sequence[AgentStep], system: str) -> str:
    states, kept = len(step.x), len(step.z)
    comment = "\n".join(f"   {line}" for line in described(step, steps, system))
    entering = {"y": step.outputs, "r": step.references}
    entering |= {f"{kind}_{steps[j].identifier}": size for kind, j, size in step.received}
    leaving = {"u": len(step.u)}
    leaving |= {f"sent_to_{steps[j].identifier}": states for j in step.sent}
    kept_names = {f"x_{d}": states for d in range(step.remembered + 1)}
    kept_names |= {"z": kept, "next_x": states, "next_z": kept}
    body = TEXT.sums(step, steps, ":=")
    for d in range(step.remembered, 0, -1):
        body += [f"x_{d}[{k}] := x_{d - 1}[{k}];" for k in range(states)]
    body += [f"x_0[{k}] := next_x[{k}];" for k in range(states)]
    body += [f"z[{k}] := next_z[{k}];" for k in range(kept)]
    for j, held in step.sent.items():
        body += [f"sent_to_{steps[j].identifier}[{k}] := x_{held}[{k}];" for k in range(states)]
    sections = [
        f"(*\n{comment}\n*)",
        f"FUNCTION_BLOCK {step.identifier}",
        *_variables("VAR_INPUT", entering),
        *_variables("VAR_OUTPUT", leaving),
        *_variables("VAR", kept_names),
        *body,
        "END_FUNCTION_BLOCK",
    ]
    return "\n".join(sections) + "\n"


def _variables(section: str, sizes: dict[str, int]) -> list[str]:
    """Declare arrays, if there are any."""
    used = {name: size for name, size in sizes.items() if size}
    if not used:
        return []
    declared = [f"{INDENT}{name} : ARRAY[0..{k - 1}] OF LREAL;" for name, k in used.items()]
    return [section, *declared, "END_VAR"]
