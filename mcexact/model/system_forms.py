"""Forms of a multi-channel system: words, a table for notebooks, and plain data."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from mcexact.exact.location import is_discrete
from mcexact.exact.rational import rational_text
from mcexact.model.canonical import numbers_of_any_length, sha256
from mcexact.shown import Shown, fitting, latex, table, words

FORMAT = "mcexact-system/1"
_MOST_CHANNELS = 12


class SystemForms(Shown):
    """The display of systems of numbers and of functions."""

    def explain(self: Any) -> str:
        """Say in plain words what the system is: sizes, equations, channels and links."""
        return "\n".join(_sentences(self))

    def _labeled(self: Any) -> Iterator[tuple[str, Any]]:
        """Yield the matrices, and the other attributes that are set."""
        if self.subject:
            yield "made by", ", ".join(each["construction"] for each in self.subject)
        yield "A", self.A
        for channel in self.channels[:_MOST_CHANNELS]:
            yield f"B of {channel.name}", channel.B
            yield f"C of {channel.name}", channel.C
        if self.m > _MOST_CHANNELS:
            yield "more channels", str(self.m - _MOST_CHANNELS)
        if self.parameters:
            yield "parameters", ", ".join(self.parameters_in_words)
        if self.neighbors is not None:
            yield "neighbors", self.neighbors
        if self.sample_time is not None:
            yield "sample time", rational_text(self.sample_time)
        if self.uncertainty is not None:
            yield "uncertainty", self.uncertainty
        if self.source is not None:
            yield "source", self.source

    def _html(self: Any) -> str:
        """Return the sizes and the matrices in HTML."""
        return table(_heading(self), self._labeled())

    def _latex(self: Any) -> str:
        """Return the equations of the system with its matrices in LaTeX."""
        change = r"x(t+1)" if is_discrete(self.time) else r"\dot{x}"
        inputs = "".join(
            rf" + {latex(channel.B)} u_{{{words(channel.name)}}}"
            for channel in self.channels[:_MOST_CHANNELS]
        )
        lines = [rf"{change} &= {latex(self.A)} x{inputs}"]
        lines += [
            rf"y_{{{words(channel.name)}}} &= {latex(channel.C)} x"
            for channel in self.channels[:_MOST_CHANNELS]
        ]
        more = r" \\ &\;\;\vdots" if self.m > _MOST_CHANNELS else ""
        equations = r" \\ ".join(lines) + more
        return rf"\begin{{aligned}} {equations} \end{{aligned}}"

    def canonical_text(self: Any) -> str:
        """Return the plant of the system as the text of the ``system`` object of a certificate.

        Notes
        -----
        Keys are sorted; matrices are rows of reduced rationals, or list their entries if they are
        large and sparse; name and source are left out.  Systems are immutable, so the text is made
        once and shared by all certificates.
        """
        plant = self.plant
        known: str | None = plant.__dict__.get("_canonical_text")
        if known is None:
            known = plant._as_canonical_text()
            object.__setattr__(plant, "_canonical_text", known)
        return known

    def canonical_document(self) -> dict[str, Any]:
        """Return the plant as the ``system`` object of a certificate, as plain data."""
        with numbers_of_any_length():
            document: dict[str, Any] = json.loads(self.canonical_text())
        return document

    def digest(self: Any) -> str:
        """Return the SHA-256 of the plant's canonical JSON, in lower-case hexadecimal.

        Examples
        --------
        Names, order, graph and every number change the digest.  The form in which a number is
        written, ``name`` and ``source`` do not:

        >>> from mcexact import MultiChannelSystem
        >>> first = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], name="a")
        >>> second = MultiChannelSystem([["0.50"]], [[[1]]], [[[1]]], source="b")
        >>> first.digest() == second.digest()
        True
        """
        plant = self.plant
        known: str | None = plant.__dict__.get("_digest")
        if known is None:
            known = sha256(plant.canonical_text())
            object.__setattr__(plant, "_digest", known)
        return known

    def digest_of_values(self: Any) -> str:
        """Return the digest of the plant without radii, which controllers name as made for.

        Examples
        --------
        >>> from mcexact import Box, MultiChannelSystem
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
        >>> Box.relative(plant, "1/100").system.digest_of_values() == plant.digest()
        True
        """
        plant = self.plant
        digest: str = (
            plant if plant.uncertainty is None else plant.with_uncertainty(None)
        ).digest()
        return digest

    def to_dict(self: Any) -> dict[str, Any]:
        """Return the system as plain data, with quotients as strings; `read_system` reads it.

        A derived system is written with its own matrices, as a plant.
        """
        document: dict[str, Any] = {"format": FORMAT}
        for key, value in (("name", self.name), ("source", self.source)):
            if value is not None:
                document[key] = value
        document |= self._own_document()
        return document


def _heading(system: Any) -> str:
    name = f"{system.name}: " if system.name else ""
    return f"{name}{_count(system.n, 'state')}, {_count(system.m, 'channel')}, {system.time} time"


def _count(size: int, noun: str) -> str:
    return f"{size} {noun}{'' if size == 1 else 's'}"


def _sentences(system: Any) -> Iterator[str]:
    yield f"{_heading(system)}."
    if system.subject:
        made = ", ".join(each["construction"] for each in system.subject)
        yield f"It was made from a plant by: {made}."
    left = "x(t+1)" if is_discrete(system.time) else "x'"
    yield f"{left} = A x + the sum of B_i u_i, y_i = C_i x; agent i measures y_i and sets u_i."
    for i, name in enumerate(system.names[:_MOST_CHANNELS]):
        sizes = f"{_count(system.p(i), 'input')} and {_count(system.q(i), 'output')}"
        yield fitting(f"Channel {name} has {sizes}.")
    if system.m > _MOST_CHANNELS:
        yield f"There are {system.m - _MOST_CHANNELS} more channels."
    if system.parameters:
        yield f"Its entries are functions of {', '.join(system.parameters_in_words)}."
    if system.neighbors is not None:
        yield system.neighbors.explain()
    if system.uncertainty is not None:
        yield f"Of the data, {system.uncertainty.explain()}."
