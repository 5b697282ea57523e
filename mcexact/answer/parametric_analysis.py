"""What is decided about a system with parameters, in words, rows and plain data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

from mcexact.answer.exceptional_hypersurfaces import ExceptionalHypersurfaces, mode_in_x
from mcexact.answer.parametric_fixed_spectrum import (
    ParametricFixedSpectrum,
    value_text,
)
from mcexact.model.parametric import ParametricSystem
from mcexact.shown import Shown, grid

FORMAT = "mcexact-parametric-analysis/1"
LABELS = {
    "fixed_spectrum": "fixed modes",
    "joint_controllability": "modes that no channel controls",
    "joint_observability": "modes that no channel observes",
}
"""The questions, with what their answers are about."""
_VERBS = {"fixed_spectrum": "fixed", "joint_controllability": "uncontrollable",
          "joint_observability": "unobservable"}  # fmt: skip
COLUMNS = ("where", "modes: the roots of", "because")
_OPEN = (
    "This is proved along the lines that are listed. What is fixed where several conditions meet "
    "is not decided."
)
Row = tuple[str, str, str]


@dataclass(frozen=True, repr=False)
class ParametricAnalysis(Shown):
    """Answers about a system with parameters, for almost all values and at exceptional ones.

    Attributes
    ----------
    plant : ParametricSystem
    answers : mapping
        For each question a `ParametricFixedSpectrum`, or with several parameters
        `ExceptionalHypersurfaces`; both are attributes, too: ``.fixed_spectrum``.
    """

    plant: ParametricSystem
    answers: Mapping[str, ParametricFixedSpectrum | ExceptionalHypersurfaces]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in LABELS or name not in self.answers:
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self
            )
        return self.answers[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.answers})

    @property
    def certificates(self) -> dict[str, ParametricFixedSpectrum]:
        """The certificates by name, with several parameters one for each line."""
        found: dict[str, ParametricFixedSpectrum] = {}
        for name, answer in self.answers.items():
            if isinstance(answer, ExceptionalHypersurfaces):
                found |= {f"{name}_line_{k}": each.answer for k, each in enumerate(answer.lines, 1)}
            else:
                found[name] = answer
        return found

    @property
    def sentences(self) -> tuple[str, ...]:
        """The answer to each question in a sentence or two, and what is left open."""
        said = [each for name, answer in self.answers.items() for each in _sentences(name, answer)]
        return (*said, _OPEN) if len(self.plant.parameters) > 1 else tuple(said)

    def rows(self, name: str) -> tuple[Row, ...]:
        """Where which modes are fixed, for every value and at exceptional ones, and why."""
        answer = self.answers[name]
        if isinstance(answer, ExceptionalHypersurfaces):
            return tuple(_rows_of_several(answer, name == "fixed_spectrum"))
        return answer.rows

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        plant = self.plant
        return {
            "format": FORMAT,
            "system": {
                "name": plant.name,
                "n": plant.n,
                "m": plant.m,
                "time": plant.time,
                "channels": list(plant.names),
            },
            "parameters": plant.document()["parameters"],
            "answer": list(self.sentences),
            **{name: self._view(name) for name in self.answers},
        }

    def _view(self, name: str) -> dict[str, Any]:
        """The answer to a question with the names of its certificates."""
        files = [f"{each}.json" for each in self.certificates if each.startswith(name)]
        rows = [dict(zip(("where", "modes", "because"), row, strict=True))
                for row in self.rows(name)]  # fmt: skip
        return self.answers[name].to_dict() | {"rows": rows, "certificates": files}

    def explain(self) -> str:
        """Say in plain words what was found, one sentence a line."""
        return "\n".join(self.sentences)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the modes against one parameter, or the hypersurfaces of two."""
        return self.fixed_spectrum.plot(ax, **options)

    def __repr__(self) -> str:
        named = ", ".join(self.plant.parameters_in_words)
        return f"ParametricAnalysis(n={self.plant.n}, m={self.plant.m}, parameters: {named})"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield from (("", said) for said in self.sentences)

    def _html(self) -> str:
        """Return the sentences and a table for each question in HTML."""
        said = "".join(f"<li>{escape(each)}</li>" for each in self.sentences)
        made = [grid(COLUMNS, self.rows(name), LABELS[name]) for name in self.answers]
        return f'<ul class="said">{said}</ul>' + "".join(made)


def _sentences(
    name: str, answer: ParametricFixedSpectrum | ExceptionalHypersurfaces
) -> Iterator[str]:
    """What holds for almost all values, and where else."""
    verb, named = _VERBS[name], ", ".join(answer.about.parameters)
    if isinstance(answer, ExceptionalHypersurfaces):
        generic = [mode_in_x(p) for p in answer.generic]
        every, where = f"almost all values of {named}", [str(h) for h in answer.hypersurfaces]
    else:
        generic = [modes for _, modes, _ in answer.rows[: len(answer.generic)]]
        where = [value_text(each.value, each.roots, named) for each in answer.exceptional]
        told = answer.about.parameters_in_words[0] if answer.outside else named
        every = f"almost every value of {named}" if where else f"every value of {told}"
    what = f"the roots of {', '.join(generic)} are" if generic else "no mode is"
    yield f"For {every} {what} {verb}."
    if where:
        yield f"{'Another' if generic else 'A'} mode is {verb} where {', or '.join(where)}."


def _rows_of_several(answer: ExceptionalHypersurfaces, blamed: bool) -> Iterator[Row]:
    for p in answer.generic:
        yield "almost all values", mode_in_x(p), ""
    for each in answer.hypersurfaces:
        what, why = answer.there(each)
        yield str(each), what, why if blamed else ""
    for q in answer.undefined_at:
        yield f"{q} = 0", "undefined", "a denominator is 0"
    for line in answer.lines:
        yield str(line), "", "proved along this line by a certificate, for every s"
