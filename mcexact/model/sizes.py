"""Typical sizes of states and inputs, and errors of sensors, from which costs have their weights.

A cost x'Qx + u'Ru depends on the units of the file.  `TypicalSizes` says how large each signal
typically is, in these units, and the weights follow from it (Bryson's rule), so that they mean the
same in all units: Q = 1/x², R = 1/u², W = r x² and V = e².  Without sizes every size is 1, every
error 1/10 and r = 1, in the units of the file.  `read_sizes` reads the key ``sizes`` of a system
file.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.rational import Limits, as_fraction, rational_text, written
from mcexact.model.entries import read_number
from mcexact.model.text import expect_list, expect_object, quoted
from mcexact.shown import Shown

STANDARD_ERROR = Fraction(1, 10)
"""The error of a sensor for which no other one is given, in the units of the file."""
KEYS = ("states", "inputs", "errors", "disturbances")

PerChannel = tuple[tuple[Fraction, ...], ...]


@dataclass(frozen=True, init=False, repr=False)
class TypicalSizes(Shown):
    """How large states and inputs typically are, and the errors of sensors, in units of the file.

    Parameters
    ----------
    states : sequence of n rationals, optional
        The size x_k of each state; by default 1.
    inputs : sequence of m sequences, optional
        For each channel the size u_k of each of its inputs; by default 1.
    errors : sequence of m sequences, optional
        For each channel the error e_k of each of its outputs; by default 1/10.
    disturbances : rational
        r: in the time unit of the file (in discrete time in each step) disturbances move each state
        by √r times its size.

    Raises
    ------
    FloatRefused
        If a number is a float.
    InputError
        If a number is not positive, or not rational.

    Examples
    --------
    >>> sizes = TypicalSizes(states=["1/50"], inputs=[[200]])
    >>> sizes.states, sizes.inputs, sizes.errors
    ((Fraction(1, 50),), ((Fraction(200, 1),),), None)
    >>> TypicalSizes(states=[0])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: states[0]: expected a size above 0, found 0
    """

    states: tuple[Fraction, ...] | None
    inputs: PerChannel | None
    errors: PerChannel | None
    disturbances: Fraction

    def __init__(
        self,
        states: Sequence[Any] | None = None,
        inputs: Sequence[Sequence[Any]] | None = None,
        errors: Sequence[Sequence[Any]] | None = None,
        disturbances: Any = 1,
    ) -> None:
        own = None if states is None else _positive(states, "states")
        object.__setattr__(self, "states", own)
        for key, channels in (("inputs", inputs), ("errors", errors)):
            read = None
            if channels is not None:
                read = tuple(_positive(each, f"{key}[{i}]") for i, each in enumerate(channels))
            object.__setattr__(self, key, read)
        (ratio,) = _positive([disturbances], "disturbances", numbered=False)
        object.__setattr__(self, "disturbances", ratio)

    def require_shapes(self, n: int, p: Sequence[int], q: Sequence[int]) -> None:
        """Raise an error unless there is a size for each state, input and output.

        Parameters
        ----------
        n : int
        p, q : sequences of m int
            The numbers of inputs and of outputs of the channels.

        Raises
        ------
        InputError
            If a number differs.
        """
        if self.states is not None and len(self.states) != n:
            raise InputError(f"expected {n} sizes, found {len(self.states)}", where="states")
        for key, channels, counts in (("inputs", self.inputs, p), ("errors", self.errors, q)):
            if channels is None:
                continue
            if len(channels) != len(counts):
                raise InputError(f"expected {len(counts)} lists, found {len(channels)}", where=key)
            for i, (each, count) in enumerate(zip(channels, counts, strict=True)):
                if len(each) != count:
                    message = f"expected {count} sizes, found {len(each)}"
                    raise InputError(message, where=f"{key}[{i}]")

    def of_states(self, n: int) -> tuple[Fraction, ...]:
        """The size of each of n states."""
        return self.states if self.states is not None else (Fraction(1),) * n

    def of_inputs(self, p: Sequence[int]) -> PerChannel:
        """The sizes of the inputs of channels that have so many."""
        if self.inputs is not None:
            return self.inputs
        return tuple((Fraction(1),) * count for count in p)

    def of_errors(self, q: Sequence[int]) -> PerChannel:
        """The errors of the outputs of channels that have so many."""
        if self.errors is not None:
            return self.errors
        return tuple((STANDARD_ERROR,) * count for count in q)

    def document(self, names: Sequence[str]) -> dict[str, Any]:
        """The object ``sizes`` of a system file."""
        document: dict[str, Any] = {}
        if self.states is not None:
            document["states"] = [written(x) for x in self.states]
        for key, channels in (("inputs", self.inputs), ("errors", self.errors)):
            if channels is not None:
                listed = zip(names, channels, strict=True)
                document[key] = {name: [written(x) for x in each] for name, each in listed}
        if self.disturbances != 1:
            document["disturbances"] = written(self.disturbances)
        return document

    def explain(self) -> str:
        """Say what has a size of its own, and what is measured in the units of the file."""
        words = {"states": "states", "inputs": "inputs", "errors": "errors of sensors"}
        own = [word for key, word in words.items() if getattr(self, key) is not None]
        others = [word for key, word in words.items() if getattr(self, key) is None]
        parts = [f"{_listed(own)} have their own sizes"] if own else []
        parts += [f"{_listed(others)} have standard ones in the units of the file"] * bool(others)
        return ", ".join(parts)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the sizes that are given."""
        if self.states is not None:
            yield "sizes of states", _texts(self.states)
        for label, channels in (("inputs", self.inputs), ("errors", self.errors)):
            if channels is not None:
                yield label, "; ".join(map(_texts, channels))
        yield "disturbances", rational_text(self.disturbances)

    def __repr__(self) -> str:
        return f"TypicalSizes({self.explain()})"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words[:-1]) + (" and " if words[1:] else "") + words[-1]


def _texts(numbers: Sequence[Fraction]) -> str:
    return ", ".join(map(rational_text, numbers))


def _positive(entries: Sequence[Any], where: str, *, numbered: bool = True) -> tuple[Fraction, ...]:
    """Convert numbers, and check that they are above 0."""
    if isinstance(entries, str) or not hasattr(entries, "__iter__"):
        raise InputError("expected a list of numbers", where=where)
    exact = []
    for k, entry in enumerate(entries):
        place = f"{where}[{k}]" if numbered else where
        x = as_fraction(entry, where=place)
        if x <= 0:
            raise InputError(f"expected a size above 0, found {rational_text(x)}", where=place)
        exact.append(x)
    return tuple(exact)


def read_sizes(
    value: Any, names: Sequence[str], n: int, p: Sequence[int], q: Sequence[int], limits: Limits
) -> TypicalSizes:
    """Read the key ``sizes`` of a system file.

    Parameters
    ----------
    value : object
        ``{"states": list, "inputs": {name: list}, "errors": {name: list}, "disturbances": r}``,
        where anything may be left out; by default every size is 1, every error 1/10, and r = 1.
    names : sequence of str
        The channels.
    n : int
    p, q : sequences of m int
        The numbers of inputs and of outputs of the channels.
    limits : Limits

    Raises
    ------
    InputError
        If it is malformed, a size is not positive, or one of a channel is missing.
    """
    parts = expect_object(value, "sizes", (), KEYS)

    def numbers(entries: Any, where: str) -> list[Fraction]:
        listed = enumerate(expect_list(entries, where))
        return [read_number(entry, f"{where}[{k}]", limits) for k, entry in listed]

    def channels(key: str, counts: Sequence[int]) -> list[list[Fraction]] | None:
        if key not in parts:
            return None
        where = f"sizes.{key}"
        by_name = expect_object(parts[key], where, (), names)
        for name, count in zip(names, counts, strict=True):
            if count and name not in by_name:
                raise InputError(f"the channel {quoted(name)} is missing", where=where)
        return [numbers(by_name.get(name, []), f"{where}[{quoted(name)}]") for name in names]

    states = numbers(parts["states"], "sizes.states") if "states" in parts else None
    inputs, errors = channels("inputs", p), channels("errors", q)
    ratio = Fraction(1)
    if "disturbances" in parts:
        ratio = read_number(parts["disturbances"], "sizes.disturbances", limits)
    with InputError.inside("sizes"):
        sizes = TypicalSizes(states, inputs, errors, ratio)
        sizes.require_shapes(n, p, q)
    return sizes
