"""Signals that outputs follow, such as steps and sinusoids, and the polynomials that they solve.

A signal r is a solution of a polynomial α if α(d/dt) r = 0, in discrete time if α(shift) r = 0:
constants are the solutions of s (discrete time: z − 1), ramps of s², sinusoids of ω rad per unit
of time of s² + ω².  Several signals together are solutions of the least common multiple.  α has
rational coefficients, so in discrete time a sinusoid is given by the cosine of its angle per step.

`signal_polynomial` reads signals, `signals_in_words` says them, and `followed_outputs` tells which
ones the outputs of a given controller follow, by the models in its agents.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from math import isqrt
from typing import Any

from mcexact.errors import InputError, InternalError, McexactError
from mcexact.exact.linear_algebra import left_nullspace, nullspace, solve
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import number, parse_rational
from mcexact.exact.roots import StabilityRegion, is_discrete, steady_point
from mcexact.model.controller import AgentProgram, Controller
from mcexact.model.entries import parse_expression
from mcexact.model.text import kind_of, nearest, quoted

MOST_SIGNALS = 40
"""The largest degree of α."""
NOTATION = {
    "continuous": "step, ramp, sine:OMEGA (rad per unit of time) or poly:P, such as poly:s^2+2",
    "discrete": "step, ramp, cosine:C (of the angle per step) or poly:P, such as poly:z^2-z+1",
}


def constant_signals(time: str) -> Polynomial:
    """The polynomial of constants: s, or z − 1 in discrete time."""
    return Polynomial.of(-steady_point(time), 1)


def signal_polynomial(signals: Any, time: str) -> Polynomial:
    """Return the least polynomial α of which all signals are solutions.

    Parameters
    ----------
    signals : str, sequence of str, or Polynomial
        ``step``, ``ramp``, ``sine:OMEGA`` in continuous time, ``cosine:C`` with −1 < C < 1 in
        discrete time, and ``poly:P``, P a polynomial in s or z; in one text they are separated by
        commas.  Or α itself.
    time : {"continuous", "discrete"}

    Returns
    -------
    Polynomial
        Monic, of degree 1 to 40.

    Raises
    ------
    InputError
        If a signal is unknown, a number is not rational, or α is constant or of a larger degree.

    Examples
    --------
    >>> print(signal_polynomial("step,ramp,sine:1/2", "continuous"))
    x^4 + 1/4*x^2
    >>> print(signal_polynomial(["ramp", "cosine:3/5"], "discrete"))
    x^4 - 16/5*x^3 + 22/5*x^2 - 16/5*x + 1
    >>> print(signal_polynomial("poly:s^2+2", "continuous"))
    x^2 + 2
    >>> signal_polynomial("sine:sqrt(2)", "continuous")
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: signals: 'sine:sqrt(2)': expected a rational number, found \
'sqrt(2)'; poly:P takes any sinusoid whose polynomial is rational
    """
    if isinstance(signals, Polynomial):
        parts = [signals]
    else:
        names = signals.split(",") if isinstance(signals, str) else signals
        if not isinstance(names, Iterable) or not all(isinstance(name, str) for name in names):
            raise InputError(
                f"expected {NOTATION[time]}, found {kind_of(signals)}", where="signals"
            )
        parts = [_polynomial(name.strip(), time) for name in names]
    if not parts:
        raise InputError("expected at least one signal, found none", where="signals")
    for p in parts:
        if p.degree < 1:
            raise InputError(f"expected a polynomial with roots, found {p}", where="signals")
    alpha = reduce(_common_multiple, parts).monic()
    if alpha.degree > MOST_SIGNALS:
        raise InputError(
            f"expected signals of a degree up to {MOST_SIGNALS}, found {alpha.degree}",
            where="signals",
        )
    return alpha


def _common_multiple(p: Polynomial, q: Polynomial) -> Polynomial:
    return p * q // p.gcd(q)


def _polynomial(text: str, time: str) -> Polynomial:
    """The polynomial of one signal."""
    name, colon, value = text.partition(":")
    known = _DISCRETE if is_discrete(time) else _CONTINUOUS
    if name not in known or (name in ("step", "ramp")) == bool(colon):
        here = f" in {time} time" if name in {*_CONTINUOUS, *_DISCRETE} - {*known} else ""
        here = here or (nearest(name, known) if name not in known else "")
        raise InputError(f"expected {NOTATION[time]}, found {quoted(text)}{here}", where="signals")
    try:
        return known[name](value, time)
    except McexactError as refused:
        raise InputError(f"{quoted(text)}: {refused}", where="signals") from None


def _step(_: str, time: str) -> Polynomial:
    return constant_signals(time)


def _ramp(_: str, time: str) -> Polynomial:
    return constant_signals(time) ** 2


def _rational(text: str) -> Fraction:
    try:
        return parse_rational(text)
    except McexactError:
        raise InputError(
            f"expected a rational number, found {quoted(text)}; poly:P takes any sinusoid whose "
            "polynomial is rational"
        ) from None


def _sine(text: str, _: str) -> Polynomial:
    """s² + ω²."""
    omega = _rational(text)
    if not omega:
        raise InputError("expected a frequency other than 0")
    return Polynomial.of(omega**2, 0, 1)


def _cosine(text: str, _: str) -> Polynomial:
    """z² − 2 c z + 1."""
    c = _rational(text)
    if not -1 < c < 1:
        raise InputError(f"expected a cosine between -1 and 1, found {number(c)}")
    return Polynomial.of(1, -2 * c, 1)


def _given(text: str, time: str) -> Polynomial:
    """A polynomial in s, or in z."""
    variable = _variable(time)
    top, bottom = parse_expression(text, (variable,)).polynomials()
    if bottom.degree:
        raise InputError(f"expected a polynomial in {variable}, found a quotient")
    return top


_SHARED: Mapping[str, Callable[[str, str], Polynomial]] = {
    "step": _step,
    "ramp": _ramp,
    "poly": _given,
}
_CONTINUOUS = {**_SHARED, "sine": _sine}
_DISCRETE = {**_SHARED, "cosine": _cosine}


def _variable(time: str) -> str:
    return "z" if is_discrete(time) else "s"


def signals_in_words(alpha: Polynomial, time: str) -> str:
    """Say which signals are solutions of a polynomial.

    Examples
    --------
    >>> signals_in_words(signal_polynomial("ramp,sine:1/2", "continuous"), "continuous")
    'steps, ramps, sinusoids of 1/2 rad per unit of time'
    >>> signals_in_words(signal_polynomial("cosine:3/5", "discrete"), "discrete")
    'sinusoids whose angle per step has the cosine 3/5'
    >>> signals_in_words(signal_polynomial("poly:s^2+2", "continuous"), "continuous")
    'solutions of s^2 + 2'
    """
    constant, said = constant_signals(time), list[str]()
    degree = constant.multiplicity_in(alpha)
    said += ["steps"] * (degree > 0) + ["ramps"] * (degree > 1)
    said += [f"polynomials of degrees up to {degree - 1}"] * (degree > 2)
    rest = alpha
    for _ in range(degree):
        rest //= constant
    for p, k in rest.factor():
        words = _oscillation(p, time) if k == 1 else None
        said.append(words or f"solutions of {_text(p**k, time)}")
    return ", ".join(said)


def _oscillation(p: Polynomial, time: str) -> str | None:
    """Which sinusoids are the solutions of an irreducible polynomial, if they have a short name."""
    if p.degree != 2:
        return None
    last, middle, _ = p.coefficients
    if is_discrete(time):
        if last != 1 or not -2 < middle < 2:
            return None
        return f"sinusoids whose angle per step has the cosine {number(-middle / 2)}"
    omega = _root(last)
    if middle or omega is None:
        return None
    return f"sinusoids of {number(omega)} rad per unit of time"


def _root(square: Fraction) -> Fraction | None:
    """The positive rational square root, if there is one."""
    if square <= 0:
        return None
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    return root if root**2 == square else None


def _text(p: Polynomial, time: str) -> str:
    return str(p).replace("x", _variable(time))


def followed_signals(agent: AgentProgram, i: int, s: Matrix) -> Polynomial:
    """Return the largest polynomial of which an agent has a model behind s (y_i − r_i).

    Parameters
    ----------
    agent : AgentProgram
    i : int
        Its position.
    s : Matrix, 1 × q_i
        A combination of its outputs, not 0.

    Returns
    -------
    Polynomial
        The largest monic p with p(d/dt) v z_i = s (y_i − r_i) for a row v, but for what nothing
        drives; in discrete time with the shift in place of d/dt.  1 if there is none.  In a stable
        loop s (y_i − r_i) tends to 0 if all references and disturbances of the plant are solutions
        of p (``proofs/internal_model.md``, claim 3).

    Notes
    -----
    Exact.  Let V span the v such that v z_i, v ż_i, v z̈_i, … depend on z_i and s (y_i − r_i) alone:
    V ż_i = N V z_i + g s (y_i − r_i).  Then p is the least polynomial with p(N) g = 0.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mcexact.model.controller import LinearMap
    >>> program = LinearMap({0: Matrix.column([0, 3])}, private=Matrix.from_rows([[0, 2], [-2, 0]]),
    ...                     reference=Matrix.column([0, -3]))
    >>> agent = AgentProgram("1", 0, 2, private_update=program)
    >>> print(followed_signals(agent, 0, Matrix.identity(1)))
    x^2 + 4
    >>> deaf = AgentProgram("1", 0, 2, private_update=replace(program, reference=None))
    >>> print(followed_signals(deaf, 0, Matrix.identity(1)))
    1
    """
    update, k, q = agent.private_update, agent.private, s.ncols
    none = Matrix.zeros(k, q)
    own, less = update.outputs.get(i, none), update.reference or none
    place, entry = next((j, x) for j, x in enumerate(s[0]) if x)
    gains = own.take(cols=[place]) * (1 / entry)
    error, others = gains @ s, (M for j, M in update.outputs.items() if j != i)
    disturbing = hstack([own - error, less + error, *others, *update.shared.values()])
    inner = update.private or Matrix.zeros(k, k)
    V = left_nullspace(disturbing)
    while V.nrows:
        relations = left_nullspace(vstack([V @ inner, V]))
        if relations.nrows == V.nrows:
            break
        V = relations.take(cols=range(V.nrows)) @ V
    motion = solve(V.T, (V @ inner).T)
    if motion is None:
        raise InternalError("an invariant space is not invariant")
    powers = [V @ gains]
    while not (relation := nullspace(hstack(powers))).ncols:
        powers.append(motion.T @ powers[-1])
    return Polynomial.of(*(row[0] for row in relation.rows())).monic()


def followed_outputs(
    controller: Controller, selection: Sequence[Matrix]
) -> dict[Polynomial, tuple[tuple[str, tuple[tuple[Fraction, ...], ...]], ...]]:
    """Tell which signals the agents of a stable loop follow with which combinations of outputs.

    Parameters
    ----------
    controller : Controller
    selection : sequence of m Matrix
        The combinations S_i.

    Returns
    -------
    dict
        Rows of S_i by the names of agents, for each polynomial of the signals that these follow,
        without the factors whose solutions tend to 0.
    """
    region, rows = StabilityRegion(controller.time), dict[Polynomial, dict[str, list[Any]]]()
    for i, (agent, S) in enumerate(zip(controller.agents, selection, strict=True)):
        for k in range(S.nrows):
            s = S.take(rows=[k])
            signals = Polynomial.of(1) if s.is_zero() else followed_signals(agent, i, s)
            lasting = Polynomial.of(1)
            for p, multiplicity in signals.factor():
                if not region.contains_roots_of(p):
                    lasting *= p**multiplicity
            if lasting.degree:
                rows.setdefault(lasting, {}).setdefault(agent.name, []).append(s[0])
    return {
        alpha: tuple((name, tuple(held)) for name, held in each.items())
        for alpha, each in rows.items()
    }
