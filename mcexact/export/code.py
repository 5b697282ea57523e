"""Controllers as code: C99, and Structured Text of IEC 61131-3, in doubles or in fixed point.

C: a header and a file for each agent, with a structure of its state, a function that resets it, one
that puts it at rest for the first outputs and set-points, one that runs a step, and one for each
follower that copies what is sent to it.  Nothing is allocated
and no library is used.  A step reads all of its arguments and writes the inputs before it changes
the state.  Compilers may contract a product and a sum to one rounding (`-ffp-contract=off` forbids
it to gcc and clang); then the last bits differ from those of `AgentRun`.

Structured Text: a function block for each agent, called once in each sampling period, after it was
given what was measured and received; then its outputs are the inputs of the plant, and what it
sends in the next period.  All numbers are of the type LREAL, and all states are 0 at first, unless
`start` is true in the first period: then they are at rest for what was measured.

In fixed point (`export.fixed`) signals are integers of 32 bits (int32_t, DINT) and sums have 64
(int64_t, LINT).  A function rounds a sum to the nearest integer, since `/` truncates in both
languages, and no expression leaves its type, whatever the signals are.

Beside the code stands ``controller.json``: the controller that the code is, with the numbers of the
code exactly, so that what runs can be certified.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from mcexact.errors import one_of
from mcexact.exact.matrix import Matrix, to_float
from mcexact.export.equations import (
    CONTROLLER,
    EQUATIONS,
    AgentStep,
    Language,
    Row,
    Signal,
    equations_document,
    steps_of,
)
from mcexact.export.fixed import LARGEST, FixedPoint
from mcexact.model.controller import Controller, controller_text, with_limits, with_matrices
from mcexact.model.limits import Range

INDENT = "    "


def export_controller(
    controller: Controller, language: Language, fixed: FixedPoint | None = None
) -> dict[str, str]:
    """Write a controller as code.

    Parameters
    ----------
    controller : Controller
        In discrete time.
    language : {"c", "st", "json"}
        C99, Structured Text of IEC 61131-3, or the equations alone.
    fixed : FixedPoint, optional
        The arithmetic in integers; by default doubles.

    Returns
    -------
    dict of str
        Files by name: ``equations.json`` with all sums, ``controller.json`` with the controller
        that the code is, and the code of each agent.

    Raises
    ------
    UsageError
        If the controller is in continuous time, or the language is another one.
    InputError
        If a number is beyond double precision, or a sum in fixed point could leave 64 bits.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> sorted(export_controller(local_controllers(plant, [[["-1/2"]]]), "st"))
    ['agent_1.st', 'controller.json', 'equations.json']
    """
    one_of(language, ("c", "st", "json"), "language")
    steps = steps_of(controller) if fixed is None else fixed.steps(controller)
    code = _Code(steps, controller.system, fixed)
    files = {EQUATIONS: json.dumps(code.document(), indent=1) + "\n"}
    files[CONTROLLER] = controller_text(in_code(controller, fixed))
    for step in code.steps:
        if language == "c":
            files[f"{step.identifier}.h"] = _header(step, code)
            files[f"{step.identifier}.c"] = _source(step, code)
        elif language == "st":
            files[f"{step.identifier}.st"] = _block(step, code)
    return files


def in_code(controller: Controller, fixed: FixedPoint | None = None) -> Controller:
    """Return the controller that its code is: numbers and limits that doubles, or integers, are.

    Raises
    ------
    InputError
        If no value of the code lies between the limits of an input.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> [agent] = in_code(local_controllers(plant, [[["-1/10"]]])).agents
    >>> agent.input.outputs[0][0, 0]
    Fraction(-3602879701896397, 36028797018963968)
    """
    if fixed is not None:
        return fixed.rounded(controller)

    def nearest(M: Matrix) -> Matrix:
        rows = [[Fraction(to_float(x)) for x in row] for row in M.rows()]
        return Matrix.from_rows(rows, ncols=M.ncols)

    return with_limits(with_matrices(controller, nearest), _as_doubles)


def _as_doubles(pair: Range) -> Range:
    """Limits as they are in the code in doubles."""
    return Fraction(to_float(pair[0])), Fraction(to_float(pair[1]))


# What both languages have in common.


@dataclass(frozen=True)
class _Code:
    """The steps of all agents, the plant that they were made for, and their arithmetic."""

    steps: Sequence[AgentStep]
    system: str
    fixed: FixedPoint | None

    def number(self, c: Fraction) -> Fraction:
        """A number as it is in the code, exactly."""
        return Fraction(to_float(c)) if self.fixed is None else self.fixed.number(c)

    def _rows(self, rows: Sequence[Row]) -> tuple[Row, ...]:
        return tuple(tuple((self.number(c), signal) for c, signal in row) for row in rows)

    def ends(self, pair: Range) -> Range:
        """Limits of an input as they are in the code, exactly."""
        return _as_doubles(pair) if self.fixed is None else self.fixed.ends(pair)

    def document(self) -> dict[str, Any]:
        """The sums of all agents as plain data, with numbers and limits as they are in the code."""
        steps = [
            replace(
                step,
                u=self._rows(step.u),
                x=self._rows(step.x),
                z=self._rows(step.z),
                limits=tuple(None if pair is None else self.ends(pair) for pair in step.limits),
                start=None if step.start is None else self._rows(step.start),
            )
            for step in self.steps
        ]
        document = equations_document(steps, self.system)
        if self.fixed is not None:
            document["arithmetic"] = "integers of 32 bits, sums of 64 bits, each rounded once"
            document["fixed point"] = self.fixed.document()
        return document


@dataclass(frozen=True)
class Dialect:
    """How a language writes numbers, and the agent's own signals that a step reads.

    Attributes
    ----------
    number : callable
        Writes a double.
    type, whole : str
        The types of signals in doubles, and in fixed point.
    x, z : str
        Before the index of its own x, with a field for the steps for which it is held, and z.
    long, widened : str
        How an integer of 64 bits is written, and a signal as one.
    break_ : str
        What stands before a further term.
    limited : str
        A value that is cut off, with fields for the value and both limits.
    """

    number: Callable[[float], str]
    type: str
    whole: str
    x: str
    z: str
    long: str
    widened: str
    break_: str
    limited: str

    def signals(self, code: _Code) -> str:
        """The type of signals."""
        return self.type if code.fixed is None else self.whole

    def zero(self, code: _Code) -> str:
        """The number 0 as a signal."""
        return self.number(0.0) if code.fixed is None else "0"

    def sum(self, row: Row, kind: str, step: AgentStep, code: _Code) -> str:
        """The sum as an expression, which both languages add from the left to the right."""
        own = {"y": "y", "r": "r", "x": self.x.format(step.held), "z": self.z, "e": "e"}

        def name(signal: Signal) -> str:
            theirs = f"{signal.kind}_{code.steps[signal.agent].identifier}"
            array = own[signal.kind] if signal.agent == step.position else theirs
            return f"{array}[{signal.entry}]"

        plus = f"{self.break_}+ "
        if code.fixed is None:
            terms = [f"{self.number(to_float(c))} * {name(signal)}" for c, signal in row]
            return plus.join(terms) or self.number(0.0)
        whole = code.fixed.sum(row, kind, step.name)
        terms = [
            f"{self.long.format(m)} * {self.widened.format(name(signal))}"
            for m, signal in whole.terms
        ]
        if not terms:
            return "0"
        return f"{step.identifier}_nearest({plus.join(terms)}, {self.long.format(whole.unit)})"

    def rest(self, step: AgentStep, code: _Code) -> list[str]:
        """The states x and z at rest as expressions of y and r; none without code that starts."""
        kinds = ["x"] * len(step.x) + ["z"] * len(step.z)
        rows = zip(step.start or (), kinds, strict=step.start is not None)
        return [self.sum(row, kind, step, code) for row, kind in rows]

    def sums(self, step: AgentStep, code: _Code, assign: str) -> list[str]:
        """The statements that compute u, cut off at its limits, and the next states."""
        u, x, z = (
            [
                f"{target}[{k}] {assign} {self.sum(row, kind, step, code)};"
                for k, row in enumerate(rows)
            ]
            for target, kind, rows in (
                ("u", "u", step.u),
                ("next_x", "x", step.x),
                ("next_z", "z", step.z),
            )
        )
        cut = list[str]()
        for k, low, high in step.cut():
            ends = (self.number(end) for end in (low, high))
            if code.fixed is not None:
                ends = (str(end) for end in code.fixed.limits(low, high))
            limited = self.limited.format(f"u[{k}]", *ends)
            cut += [f"e[{k}] {assign} u[{k}];"] * step.winds + [f"u[{k}] {assign} {limited};"]
            cut += [f"e[{k}] {assign} u[{k}] - e[{k}];"] * step.winds
        return [*u, *cut, *x, *z]


def described(step: AgentStep, code: _Code) -> list[str]:
    """What the code is, line by line."""
    steps, fixed = code.steps, code.fixed
    lines = [f"Agent {step.name!a} of a distributed controller in discrete time."]
    if code.system:
        lines.append(f"Made for the plant of digest {code.system}.")
    lines += _counted(step.rows(), "", code)
    if fixed is not None:
        lines += _scales(step, fixed)
    order = ["measure y", "run the step", "set u"]
    if step.sent or step.received:
        order[1:1] = ["send", "receive"]
    lines.append(f"In each sampling period: {', '.join(order)}.")
    for kind, j, _ in step.received:
        what = "outputs" if kind == "y" else "shared sub-state"
        lines.append(f"{kind}_{steps[j].identifier}: the {what} that agent {steps[j].name!a} sent.")
    if not step.u:
        lines.append("It sets no input: those of this agent stay 0.")
    if any(step.cut()):
        more = ", and its states are corrected by what was cut off" * step.winds
        lines.append(f"Inputs are cut off at their limits{more}.")
        if _limits_are_rounded(step, code):
            how = "to the nearest doubles" if fixed is None else "inwards to units of u"
            lines.append(f"These limits are those of the controller, rounded {how}.")
    if step.start is not None:
        lines.append("Start puts the states at rest for the first y, and r if there is any.")
        lines += _counted(step.start or (), " for start", code)
    elif step.x or step.z:
        lines.append("All states start at 0.")
    if step.received:
        lines.append("Until a first message has arrived, what is received is 0.")
    # A name must neither end the comment that it stands in nor begin another one.
    return [line.replace("*", "\\x2a") for line in lines]


def _counted(rows: Iterable[Row], what: str, code: _Code) -> list[str]:
    """How many numbers are rounded; nothing where there are none."""
    numbers = [c for row in rows for c, _ in row]
    rounded = sum(code.number(c) != c for c in numbers)
    fixed, count = code.fixed, len(numbers)
    if not numbers:
        return []
    if not rounded:
        if what:
            return [f"The code has its numbers{what} exactly."]
        if count == 1:
            return ["Its only number is that of the controller exactly."]
        return [f"All {count} numbers are those of the controller exactly."]
    of = f"Its only number{what}" if count == 1 else f"{rounded} of its {count} numbers{what}"
    to = "the nearest double" if fixed is None else f"{fixed.bits} fractional bits"
    return [f"{of} {'is' if rounded == 1 else 'are'} rounded to {to}."]


def _limits_are_rounded(step: AgentStep, code: _Code) -> bool:
    """Whether the code cuts off at other limits than the controller."""
    return any(pair is not None and code.ends(pair) != pair for pair in step.limits)


def _scales(step: AgentStep, fixed: FixedPoint) -> list[str]:
    """What the integers of the signals stand for."""
    used: dict[str, int] = {
        "y": step.outputs,
        "r": step.references,
        "u": len(step.u),
        "x": len(step.x),
    }
    used.update({kind: size for kind, _, size in step.received}, z=len(step.z))
    lines = ["Signals are integers, in units of a power of two; beyond its range a value stays at"]
    lines.append("the end of the range. No sum leaves 64 bits, whatever the signals are.")
    for kind, size in used.items():
        if size:
            f = fixed.fractional(kind)
            reach = to_float(Fraction(LARGEST, 2**f)) if f >= 0 else LARGEST * 2.0**-f
            lines.append(f"{kind}: units of 2^{-f}, from {-reach:.6g} to {reach:.6g}.")
    return lines


# C99.

C = Dialect(
    repr,
    "double",
    "int32_t",
    "s->x[{}]",
    "s->z",
    "INT64_C({})",
    "{}",
    f"\n{INDENT * 2}",
    "{0} < {1} ? {1} : {0} > {2} ? {2} : {0}",
)
_NEAREST_IN_C = """\
/* The nearest integer to sum / unit, halves upwards, within 32 bits. */
static int32_t {0}_nearest(int64_t sum, int64_t unit)
{{
    const int64_t moved = sum + unit / 2;
    int64_t q = moved / unit;
    if (q * unit > moved)
        q -= 1;
    if (q > INT64_C({1}))
        q = INT64_C({1});
    if (q < INT64_C(-{1}))
        q = INT64_C(-{1});
    return (int32_t)q;
}}
"""


def signature(step: AgentStep, code: _Code) -> str:
    """The declaration of the function that runs a step, without its semicolon."""
    type_ = C.signals(code)
    arguments = [f"{step.identifier}_state *s"]
    arguments += [f"const {type_} y[{step.outputs}]"] * bool(step.outputs)
    arguments += [f"const {type_} r[{step.references}]"] * bool(step.references)
    for kind, j, size in step.received:
        arguments.append(f"const {type_} {kind}_{code.steps[j].identifier}[{size}]")
    arguments += [f"{type_} u[{len(step.u)}]"] * bool(step.u)
    return f"void {step.identifier}_step({', '.join(arguments)})"


def _header(step: AgentStep, code: _Code) -> str:
    name, type_ = step.identifier, C.signals(code)
    guard = f"{name.upper()}_H"
    comment = "\n".join(f" * {line}" for line in described(step, code))
    members = [f"{INDENT}{type_} x[{step.remembered + 1}][{len(step.x)}];"] * bool(step.x)
    members += [f"{INDENT}{type_} z[{len(step.z)}];"] * bool(step.z)
    members = members or [f"{INDENT}char none;"]
    parts = [
        f"/*\n{comment}\n */",
        f"#ifndef {guard}\n#define {guard}",
        *["#include <stdint.h>"] * (code.fixed is not None),
        "typedef struct {\n" + "\n".join(members) + f"\n}} {name}_state;",
        f"void {name}_reset({name}_state *s);",
        *[f"{_starting(step, code)};"] * (step.start is not None),
        *(f"{_send(step, code, j)};" for j in step.sent),
        f"{signature(step, code)};",
        "#endif",
    ]
    return "\n\n".join(parts) + "\n"


def _send(step: AgentStep, code: _Code, j: int) -> str:
    other, name, type_ = code.steps[j].identifier, step.identifier, C.signals(code)
    return f"void {name}_send_to_{other}(const {name}_state *s, {type_} x[{len(step.x)}])"


def _starting(step: AgentStep, code: _Code) -> str:
    """The declaration of the function that starts without a bump, without its semicolon."""
    type_ = C.signals(code)
    arguments = [f"{step.identifier}_state *s"]
    arguments += [f"const {type_} y[{step.outputs}]"] * bool(step.outputs)
    arguments += [f"const {type_} r[{step.references}]"] * bool(step.references)
    return f"void {step.identifier}_start({', '.join(arguments)})"


def _started(step: AgentStep, code: _Code) -> list[str]:
    """The statements of this function."""
    states, body = len(step.x), list[str]()
    rows = C.rest(step, code)
    for k, text in enumerate(rows[:states]):
        body += [f"s->x[0][{k}] = {text};"]
        body += [f"s->x[{d}][{k}] = s->x[0][{k}];" for d in range(1, step.remembered + 1)]
    body += [f"s->z[{k}] = {text};" for k, text in enumerate(rows[states:])]
    used = {signal.kind for row in step.start or () for _, signal in row}
    sizes = ("y", step.outputs), ("r", step.references)
    return body + [f"(void){name};" for name, size in sizes if size and name not in used]


def _source(step: AgentStep, code: _Code) -> str:
    name, states, kept = step.identifier, len(step.x), len(step.z)
    type_, zero = C.signals(code), C.zero(code)
    reset = [f"s->x[{d}][{k}] = {zero};" for d in range(step.remembered + 1) for k in range(states)]
    reset += [f"s->z[{k}] = {zero};" for k in range(kept)]
    reset = reset or ["s->none = 0;"]
    functions = [_function(f"void {name}_reset({name}_state *s)", reset)]
    if step.start is not None:
        functions.append(_function(_starting(step, code), _started(step, code)))
    for j, held in step.sent.items():
        copied = [f"x[{k}] = s->x[{held}][{k}];" for k in range(states)]
        functions.append(_function(_send(step, code, j), copied))
    body = [f"{type_} next_x[{states}];"] * bool(states)
    body += [f"{type_} next_z[{kept}];"] * bool(kept)
    body += [f"{type_} e[{len(step.u)}] = {{{zero}}};"] * step.winds
    sums = C.sums(step, code, "=")
    if any(f"{name}_nearest" in each for each in (*sums, *C.rest(step, code))):
        functions.insert(0, _NEAREST_IN_C.format(name, LARGEST))
    body += sums
    for d in range(step.remembered, 0, -1):
        body += [f"s->x[{d}][{k}] = s->x[{d - 1}][{k}];" for k in range(states)]
    body += [f"s->x[0][{k}] = next_x[{k}];" for k in range(states)]
    body += [f"s->z[{k}] = next_z[{k}];" for k in range(kept)]
    body += [] if states or kept else ["(void)s;"]
    functions.append(_function(signature(step, code), body))
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


TEXT = Dialect(
    literal,
    "LREAL",
    "DINT",
    "x_{}",
    "z",
    "LINT#{}",
    "DINT_TO_LINT({})",
    f"\n{INDENT}",
    "LIMIT({1}, {0}, {2})",
)
_NEAREST_IN_TEXT = """\
(* The nearest integer to sum / unit, halves upwards, within 32 bits. *)
FUNCTION {0}_nearest : DINT
VAR_INPUT
    sum : LINT;
    unit : LINT;
END_VAR
VAR
    moved : LINT;
    q : LINT;
END_VAR
moved := sum + unit / LINT#2;
q := moved / unit;
IF q * unit > moved THEN q := q - LINT#1; END_IF;
IF q > LINT#{1} THEN q := LINT#{1}; END_IF;
IF q < LINT#-{1} THEN q := LINT#-{1}; END_IF;
{0}_nearest := LINT_TO_DINT(q);
END_FUNCTION

"""


def _block(step: AgentStep, code: _Code) -> str:
    states, kept, steps = len(step.x), len(step.z), code.steps
    comment = "\n".join(f"   {line}" for line in described(step, code))
    entering = {"y": step.outputs, "r": step.references}
    entering |= {f"{kind}_{steps[j].identifier}": size for kind, j, size in step.received}
    leaving = {"u": len(step.u)}
    leaving |= {f"sent_to_{steps[j].identifier}": states for j in step.sent}
    kept_names = {f"x_{d}": states for d in range(step.remembered + 1)}
    kept_names |= {"z": kept, "next_x": states, "next_z": kept, "e": len(step.u) * step.winds}
    starts = step.start is not None
    body = [*(_first_states(step, code) if starts else ()), *TEXT.sums(step, code, ":=")]
    nearest = _NEAREST_IN_TEXT.format(step.identifier, LARGEST)
    used = any(f"{step.identifier}_nearest" in each for each in body)
    type_ = TEXT.signals(code)
    for d in range(step.remembered, 0, -1):
        body += [f"x_{d}[{k}] := x_{d - 1}[{k}];" for k in range(states)]
    body += [f"x_0[{k}] := next_x[{k}];" for k in range(states)]
    body += [f"z[{k}] := next_z[{k}];" for k in range(kept)]
    for j, held in step.sent.items():
        body += [f"sent_to_{steps[j].identifier}[{k}] := x_{held}[{k}];" for k in range(states)]
    sections = [
        f"(*\n{comment}\n*)",
        f"FUNCTION_BLOCK {step.identifier}",
        *_variables("VAR_INPUT", entering, type_, ["start : BOOL;"] * starts),
        *_variables("VAR_OUTPUT", leaving, type_),
        *_variables("VAR", kept_names, type_),
        *body,
        "END_FUNCTION_BLOCK",
    ]
    return nearest * used + "\n".join(sections) + "\n"


def _first_states(step: AgentStep, code: _Code) -> list[str]:
    """The statements that put the states at rest while `start` is true."""
    states, body = len(step.x), list[str]()
    rows = TEXT.rest(step, code)
    for k, text in enumerate(rows[:states]):
        every = range(step.remembered + 1)
        body += [f"x_{d}[{k}] := SEL(start, x_{d}[{k}], {text});" for d in every]
    return body + [f"z[{k}] := SEL(start, z[{k}], {text});" for k, text in enumerate(rows[states:])]


def _variables(
    section: str, sizes: dict[str, int], type_: str, others: Sequence[str] = ()
) -> list[str]:
    """Declare arrays and other variables, if there are any."""
    used = {name: size for name, size in sizes.items() if size}
    if not used and not others:
        return []
    declared = [f"{INDENT}{name} : ARRAY[0..{k - 1}] OF {type_};" for name, k in used.items()]
    declared += [f"{INDENT}{each}" for each in others]
    return [section, *declared, "END_VAR"]
