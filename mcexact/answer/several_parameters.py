"""Several parameters: hypersurfaces, lines that prove them, and sentences.

`Hypersurfaces` says what holds for almost all values of several parameters, and on which
hypersurfaces more modes are fixed or a rank is less.  It is no kind of certificate.  It holds
answers for one parameter along lines through the space of the parameters, each a certificate:

- That no mode is fixed at one point, or that a rank is at least so large, holds for almost all
  values.  Rules make such sentences from certificates, and the checker verifies them.
- What each certificate says of its own line is also said by rules.
- Where else modes are fixed or ranks are less is computed, and confirmed only on the lines.  It is
  said with the templates of one parameter, and no manifest claims it.
- What happens only where several hypersurfaces meet is not decided.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Generic, TypeVar

from mcexact.answer import parameters as say
from mcexact.answer.parameters import (
    MODES,
    RANGE_RULES,
    ControllabilityMatrix,
    Edge,
    LeftOut,
    ParametricFixedSpectrum,
    ParametricRank,
    Row,
    Said,
    SetpointMatrix,
    SignalMatrix,
    TransferColumn,
    Values,
    another,
    complete,
    fixed,
    graph,
    heading,
    in_parameter,
    in_table,
    indices,
    mode_text,
    rows_left_out,
    setpoints,
    value_text,
    within,
)
from mcexact.answer.sentence import Claim, Context, Rulebook, Several
from mcexact.answer.templates import Sentence, blame, polynomial_in_x
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import rational_latex, rational_text
from mcexact.exact.rational_functions import (
    RationalFunction,
    least_denominator,
    parameter_latex,
)
from mcexact.model.graph import connects
from mcexact.model.parametric import ParametricSystem
from mcexact.shown import LINE, Shown, escaped, fitting

# Answers: lines, and hypersurfaces.

A = TypeVar("A", bound=ParametricFixedSpectrum | ParametricRank)


@dataclass(frozen=True, repr=False)
class Line(Shown, Generic[A]):
    """A line through the space of the parameters, and what is decided along it.

    Attributes
    ----------
    at : mapping
        For each parameter its value, a function of the parameter of the line: s, unless the plant
        has such a parameter.
    answer : ParametricFixedSpectrum or ParametricRank
        The answer for every value of this parameter, a certificate about the plant on the line.
    """

    at: Mapping[str, RationalFunction]
    answer: A

    @property
    def parameter(self) -> str:
        """The parameter of the line."""
        return self.answer.about.parameters[0]

    def __str__(self) -> str:
        return ", ".join(f"{name} = {value}" for name, value in self.at.items())

    def __repr__(self) -> str:
        return fitting(f"Line({self})")

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "line", str(self)
        yield from ((label, value) for label, value in self.answer._labeled())


@dataclass(frozen=True, repr=False)
class Hypersurface(Shown):
    """Where a polynomial in the parameters is 0, more is fixed, or a rank is less.

    Attributes
    ----------
    polynomial : RationalFunction
        Irreducible; its coefficients are coprime integers.
    channels : tuple of tuples of str
        Sets s of channels whose pencils lose rank where the lines meet the hypersurface; none where
        the question is what some channels control or observe.
    rank : int or None
        The rank there; None if the question is about modes.
    example : tuple of a mapping and polynomials, or None
        For modes a point of the hypersurface on a line, if one is rational, and the irreducible
        polynomials of the modes that are fixed there besides those for almost all values.
    """

    polynomial: RationalFunction
    channels: tuple[tuple[str, ...], ...] = ()
    rank: int | None = None
    example: tuple[Mapping[str, Fraction], tuple[Polynomial, ...]] | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        more = {"channels": [[*s] for s in self.channels]} if self.rank is None else {}
        rank = {} if self.rank is None else {"rank": self.rank}
        found = {"polynomial": str(self.polynomial), **more, **rank}
        if self.example is not None:
            at, modes = self.example
            point = {name: rational_text(value) for name, value in at.items()}
            found["example"] = {"at": point, "modes": [str(p) for p in modes]}
        return found

    def to_sympy(self) -> Any:
        """The polynomial as a ``sympy.Poly`` in the parameters."""
        import sympy

        symbols = sympy.symbols(self.polynomial.parameters)
        return sympy.Poly(self.polynomial.to_sympy(), *symbols, domain="QQ")

    @property
    def value(self) -> tuple[str, Fraction] | None:
        """The parameter and its value, if the condition is that one has this value."""
        occurring = self.polynomial.occurring
        if len(occurring) != 1:
            return None
        [name] = occurring
        s = RationalFunction.parameter("s", ("s",))
        values = [s if name == each else s * 0 for each in self.polynomial.parameters]
        p = self.polynomial.substituted(values, s * 0).polynomials()[0]
        return None if p.degree > 1 else (name, -p.coefficients[0] / p.leading)

    def __str__(self) -> str:
        if self.value is None:
            return f"{self.polynomial} = 0"
        name, value = self.value
        return f"{name} = {rational_text(value)}"

    def inside(self, about: ParametricSystem) -> str:
        """The condition, and whether a value of one parameter is in its range, if it has one."""
        if self.value is None:
            return str(self)
        return str(self) + within(
            self.meets(about), about.ranges[about.parameters.index(self.value[0])]
        )

    def meets(self, about: ParametricSystem) -> bool:
        """Whether the hypersurface may meet the ranges; not, where one parameter is beyond its."""
        if self.value is None:
            return True
        name, value = self.value
        low, high = about.ranges[about.parameters.index(name)]
        return (low is None or low <= value) and (high is None or value <= high)

    @property
    def modes_in_words(self) -> str:
        """What is fixed at a point of the hypersurface, if one is known."""
        if self.example is None:
            return ""
        at, modes = self.example
        point = ", ".join(f"{name} = {rational_text(value)}" for name, value in at.items())
        return f", such as {', '.join(map(str, modes))} at {point}"

    def __repr__(self) -> str:
        told = f"channels={self.channels}" if self.rank is None else f"rank={self.rank}"
        return fitting(f"Hypersurface({str(self)!r}, {told})")

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "where", str(self)
        if self.rank is None:
            yield "channels", str(self.channels)
        else:
            yield "rank", str(self.rank)

    def _latex(self) -> str:
        if self.value is None:
            return f"{self.polynomial.latex()} = 0"
        name, value = self.value
        return f"{parameter_latex(name)} = {rational_latex(value)}"


@dataclass(frozen=True, repr=False)
class Hypersurfaces(Shown, Generic[A]):
    """What holds for almost all values of several parameters, and on which hypersurfaces more.

    Along each line all of this is proved by a certificate: what holds there for almost all values,
    and that the exceptional values are those on the hypersurfaces.  That a hypersurface is
    exceptional between the lines is computed and not certified.  Of what only happens where two
    conditions meet, such as both of two entries being 0, nothing is said.

    Attributes
    ----------
    about : ParametricSystem
    hypersurfaces : tuple of Hypersurface
        The polynomials in the parameters that are exceptional.
    undefined_at : tuple of RationalFunction
        The polynomials at whose roots an entry is undefined.
    lines : tuple of Line
        Lines through drawn points, which meet all hypersurfaces.
    """

    about: ParametricSystem
    hypersurfaces: tuple[Hypersurface, ...]
    undefined_at: tuple[RationalFunction, ...]
    lines: tuple[Line[A], ...]

    @property
    def certificates(self) -> dict[str, A]:
        """The certificates, each about the system along a line."""
        return {f"line_{k}": each.answer for k, each in enumerate(self.lines, 1)}

    @property
    def exceptional(self) -> tuple[Hypersurface, ...]:
        """The hypersurfaces, by the name that exceptional values of one parameter have."""
        return self.hypersurfaces

    @property
    def exceptional_at(self) -> tuple[RationalFunction, ...]:
        """The polynomials of the hypersurfaces."""
        return tuple(each.polynomial for each in self.hypersurfaces)

    def of_almost_all(self) -> tuple[str, ...]:
        """What holds for almost all values."""
        raise NotImplementedError

    def worth_a_row(self) -> tuple[str, ...]:
        """As `of_almost_all`, but empty if no mode is fixed generically."""
        return self.of_almost_all()

    def there(self, each: Hypersurface) -> tuple[str, str]:
        """What holds on a hypersurface, and why."""
        raise NotImplementedError

    @property
    def words(self) -> tuple[str, ...]:
        """What holds for almost all values, what else on hypersurfaces, and what is proved."""
        named = ", ".join(self.about.parameters)
        told: list[str] = []
        told += [f"{each} for almost all values of {named}" for each in self.of_almost_all()]
        for each in self.hypersurfaces:
            what, why = self.there(each)
            told.append(f"{what} where {each}" + (f": {why}" if why else ""))
        told += [f"proved for every value of {each.parameter}: {each}" for each in self.lines]
        return (*told, "not decided: values at which several conditions meet")

    @property
    def rows(self) -> tuple[Row, ...]:
        """Where, what holds there, and why."""
        return *self.told, *rows_left_out([self.left_out])

    @property
    def told(self) -> tuple[Row, ...]:
        """The rows about values at which all entries are defined."""
        generic = [("almost all values", said, "") for said in self.worth_a_row()]
        return *generic, *(
            (each.inside(self.about), *self.there(each)) for each in self.hypersurfaces
        )

    @property
    def left_out(self) -> LeftOut:
        """The values at which an entry is undefined."""
        undefined = tuple(Hypersurface(q).inside(self.about) for q in self.undefined_at)
        return LeftOut(outside=(), assumed="", undefined=undefined)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "parameters": list(self.about.parameters),
            **self._generic(),
            "hypersurfaces": [each.to_dict() for each in self.hypersurfaces],
            "undefined_at": [str(each) for each in self.undefined_at],
            "lines": [{name: str(value) for name, value in each.at.items()} for each in self.lines],
            "in_words": list(self.words),
        }

    def _generic(self) -> dict[str, Any]:
        raise NotImplementedError

    def explain(self) -> str:
        """Say in plain words what holds where, one condition a line."""
        return "\n".join(self.words)

    def __repr__(self) -> str:
        shown = "; ".join(map(str, self.hypersurfaces)) or "none"
        generic = "; ".join(self.of_almost_all())
        text = f"{type(self).__name__}({generic}, exceptional: {shown}"
        return f"{fitting(text, LINE - 1)})"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "for almost all values", "; ".join(self.of_almost_all())
        for each in self.hypersurfaces:
            yield f"where {each}", ": ".join(filter(None, self.there(each)))
        for entry in self.undefined_at:
            yield "undefined where", f"{entry} = 0"
        for each_line in self.lines:
            yield "proved along", str(each_line)

    def _latex(self) -> str:
        rows = r" \\ ".join(
            rf"{each._latex()} & \text{{{escaped(': '.join(filter(None, self.there(each))))}}}"
            for each in self.hypersurfaces
        )
        return rf"\begin{{array}}{{ll}} {rows} \end{{array}}" if rows else r"\emptyset"

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the hypersurfaces of two parameters as curves; see `mcexact.plot.hypersurfaces`."""
        from mcexact.plot.parameters import hypersurfaces

        return hypersurfaces(self, ax, **options)


@dataclass(frozen=True, repr=False)
class ExceptionalHypersurfaces(Hypersurfaces[ParametricFixedSpectrum]):
    """What is fixed for almost all values of several parameters, and on which hypersurfaces more.

    If nothing is fixed at one point of a line, then nothing is for almost all values; generic modes
    beyond the lines are computed and not certified.

    Attributes
    ----------
    generic : tuple of tuples of RationalFunction
        The irreducible polynomials in x whose roots are fixed for almost all values, each by its
        coefficients, constant first, which are polynomials in the parameters.  The modes are these
        roots divided by the denominator of A.
    """

    generic: tuple[tuple[RationalFunction, ...], ...]

    def of_almost_all(self) -> tuple[str, ...]:
        """The polynomials in x whose roots are fixed."""
        return tuple(f"the roots of {each}" for each in self.modes) or ("no mode",)

    @property
    def scale(self) -> RationalFunction:
        """The denominator of A, by which the roots of the generic polynomials are divided."""
        return least_denominator(self.about.A, self.about.parameters)

    @property
    def divided(self) -> str:
        """What the roots of the generic polynomials are divided by, as words to append."""
        return "" if self.scale.is_constant else f", divided by {self.scale}"

    @property
    def modes(self) -> tuple[str, ...]:
        """The generic polynomials in words, with what their roots are divided by."""
        return tuple(mode_in_x(p) + self.divided for p in self.generic)

    def worth_a_row(self) -> tuple[str, ...]:
        """The polynomials in x whose roots are fixed, perhaps none."""
        return self.of_almost_all() if self.generic else ()

    def there(self, each: Hypersurface) -> tuple[str, str]:
        """The words for the modes that are fixed on a hypersurface, and which channels cause this.

        If the question is what some channels control or observe, no channels are named.
        """
        besides = " besides these" if self.generic else ""
        what = f"a mode{besides}{each.modes_in_words}"
        return what, ", or ".join(blame(s, self.about.names) for s in each.channels)

    def _generic(self) -> dict[str, Any]:
        return {"generic": [[str(c) for c in p] for p in self.generic]}


@dataclass(frozen=True, repr=False)
class RankHypersurfaces(Hypersurfaces[ParametricRank]):
    """The rank of a matrix for almost all values of several parameters, and where it is less.

    The rank at one point of a line is proved, and no larger one is anywhere if it is full.

    Attributes
    ----------
    matrix : SetpointMatrix, SignalMatrix, ControllabilityMatrix or TransferColumn
        How it is made.
    rank : int
        The rank for almost all values.
    """

    matrix: SetpointMatrix | SignalMatrix | ControllabilityMatrix | TransferColumn
    rank: int

    @property
    def said(self) -> tuple[object, ...]:
        """The ranks, and where they are, to compare with those of another matrix."""
        return self.rank, {(each.polynomial, each.rank) for each in self.hypersurfaces}

    def of_almost_all(self) -> tuple[str, ...]:
        """The rank."""
        return (f"rank {self.rank}",)

    def there(self, each: Hypersurface) -> tuple[str, str]:
        """The lower rank."""
        return f"rank {each.rank}", ""

    def _generic(self) -> dict[str, Any]:
        return {"matrix": self.matrix.to_dict(), "rank": self.rank}


def mode_in_x(p: tuple[RationalFunction, ...]) -> str:
    """A polynomial in x whose coefficients depend on several parameters.

    Examples
    --------
    >>> a = RationalFunction.parameter("a", ("a", "b"))
    >>> mode_in_x((a * a - 2, a, RationalFunction.constant(1, ("a", "b"))))
    'x^2 + a*x + (a^2 - 2)'
    """
    return polynomial_in_x([str(c) for c in p])


# Rules about certificates along lines, and sentences that no certificate implies.

RULES = Rulebook()
"""The rules that read certificates, with those about ranges."""


@RULES.rule("title", say.HEADING)
def _heading(context: Context) -> Said:
    yield heading(context)


RULES.extend(RANGE_RULES)


def _almost(question: str, place: str, holds: Callable[[Claim, Context], bool]) -> None:
    """Add the rule of a sentence about almost all values that one certificate implies."""

    @RULES.rule(place, say.ALMOST[question], premises=(question,))
    def _said(found: Several, context: Context) -> Said:
        for each in found.separately():
            if holds(each, context):
                yield say.ALMOST[question](parameters=context.parameter)
                return


def _nothing(found: Claim, context: Context) -> bool:
    return not len(found.generic)


_almost("fixed_spectrum", "answer", _nothing)
for each in MODES:
    if each != "fixed_spectrum":
        _almost(each, "proved", _nothing)
_almost(
    "setpoint", "proved", lambda found, context: bool(found.rank == context.n + context.outputs)
)


def _edges(found: Iterable[Claim]) -> list[Edge]:
    """The edges that some point of a line has; others may be edges elsewhere."""
    pairs = [((getattr(each.matrix, "from"), each.matrix.to), each.rank) for each in found]
    return [*dict.fromkeys(edge for edge, rank in pairs if rank)]


@RULES.rule("proved", say.ALMOST["transfer_graph"], premises=("transfer_graph",))
def _graph(transfer_graph: Iterable[Claim], context: Context) -> Said:
    if edges := _edges(transfer_graph):
        yield say.ALMOST["transfer_graph"](parameters=context.parameter, edges=edges)


@RULES.rule("proved", say.ALMOST["completeness"], premises=("fixed_spectrum", "transfer_graph"))
def _completeness(
    fixed_spectrum: Several, transfer_graph: Iterable[Claim], context: Context
) -> Said:
    free = any(_nothing(each, context) for each in fixed_spectrum.separately())
    if free and connects(context.names, _edges(transfer_graph)):
        yield say.ALMOST["completeness"](parameters=context.parameter)


def _on_line(question: str, told: Callable[[Claim, str, Context], str]) -> None:
    """Add the rule that repeats what each certificate says of its line."""

    @RULES.rule("line", say.ON_LINE[question], premises=(question,))
    def _said(found: Several, context: Context) -> Said:
        for each in found.separately():
            line, s = _line(each.subject[0])
            yield say.ON_LINE[question](line=line, found=told(each, s, context))


def _line(step: Mapping[str, Any]) -> tuple[str, str]:
    """A line in words, and its parameter."""
    s = step["parameter"]
    ends = {
        name: Polynomial.of(Fraction(a), Fraction(step["direction"][name]))
        for name, a in step["point"].items()
    }
    return ", ".join(f"{name} = {in_parameter(p, s)}" for name, p in ends.items()), s


def _conditions(found: Claim, s: str) -> str:
    return " or ".join(value_text(each.value, each.roots, s) for each in found.exceptional)


def _modes_there(found: Claim, s: str, context: Context) -> str:
    """The modes for every value of s, and where others are."""
    modes = ", ".join(mode_text(p, s) for p in found.generic)
    always = f"the roots of {modes}{context.divided}" if modes else "none"
    where = _conditions(found, s)
    return always + (f"{'; others, too,' if modes else ', but'} where {where}" if where else "")


def _ranks_there(found: Claim, s: str, context: Context) -> str:
    """The rank for almost every value of s, and where it is less."""
    matrix, where = found.matrix, _conditions(found, s)
    named = ""
    if matrix.name == "controllability":
        named = f"{matrix.blocks} block{'s' * (matrix.blocks > 1)}: "
    elif matrix.name == "transfer":
        named = f"{getattr(matrix, 'from')} -> {matrix.to}: "
    return f"{named}rank {found.rank}" + (f", less where {where}" if where else "")


for each in say.ON_LINE:
    _on_line(each, _modes_there if each in MODES else _ranks_there)


def sentences_of_several(answers: Mapping[str, Any], context: Context) -> Iterator[Sentence]:
    """Yield the sentences that no certificate implies, each with its place."""
    if "fixed_spectrum" in answers:
        spectrum = answers["fixed_spectrum"]
        modes, values = _hypersurface_modes(spectrum), _values(spectrum, context)
        for said in (*(fixed(modes, values) if modes else ()), *another(modes, values)):
            yield said.bound("answer", ())
    for name, decided in answers.items():
        if name.startswith("box_"):  # it is about ranges, and not about almost all values
            continue
        for said in _row(name, decided, answers, context):
            yield said.bound("table", ())


def _row(name: str, answer: Any, answers: Mapping[str, Any], context: Context) -> Said:
    t = context.parameter
    if name in MODES:
        yield from in_table(name, _hypersurface_modes(answer), _values(answer, context))
    elif name == "setpoint":
        values = _values(answer, context)
        yield from setpoints(answer.rank, context.n + context.outputs, values, t)
    elif name == "transfer_graph":
        yield from graph(_hypersurface_columns(answer, context))
    elif name == "completeness":
        modes, values = _hypersurface_modes(answer.spectrum), _values(answer.spectrum, context)
        yield from complete(
            context.names, modes, values, _hypersurface_columns(answer.graph, context), t
        )
    else:
        where = dict.fromkeys(at for each in answer for at in _values(each, context).where)
        values = Values(_every(context), tuple(where))
        ranks = [each.rank for each in answer]
        yield from indices(name.removesuffix("_indices"), ranks, values)


def _hypersurface_modes(spectrum: Any) -> str:
    modes = ", ".join(map(mode_in_x, spectrum.generic))
    return modes and modes + spectrum.divided


def _every(context: Context) -> str:
    return f"almost all values of {context.parameter}"


def _values(answer: Hypersurfaces[Any], context: Context) -> Values:
    return Values(_every(context), tuple(map(str, answer.hypersurfaces)))


def _hypersurface_columns(found: Any, context: Context) -> list[Any]:
    return [(edge, each.rank, _values(each, context)) for edge, each in found.columns.items()]
