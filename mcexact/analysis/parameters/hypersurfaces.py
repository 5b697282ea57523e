"""Several parameters: generic answers and exceptional hypersurfaces.

With several parameters a question has an answer that holds for almost all values, and hypersurfaces
of values on which it differs.  `exceptional_hypersurfaces` decides both for fixed modes, joint
controllability and observability, set-points, indices, the transfer graph and completeness.

The method has two steps.  Candidates are irreducible polynomials in the parameters: those that the
resultants for several drawn gains share (modes), or the factors of one minor of full order (ranks,
`parameters.ranks`).  Then lines are drawn through the space of parameters.  Along a line there is
one parameter, so the question is decided and proved for all its values (`parameters.modes`), and
the candidates are kept at whose points on the line the answer differs.  Resultants and minors are
polynomials in all parameters, which limits this to some ten states.

The transfer graph and completeness are also decided here for one parameter, since both cases have
the same results: `parametric_transfer_graph` by the ranks of columns C_i A^k B_j, and
`parametric_completeness` by that graph and the fixed modes.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from typing import Any, Literal, overload

from mcexact.analysis.parameters.modes import parametric_controllability, parametric_fixed_spectrum
from mcexact.analysis.parameters.ranks import (
    DRAWS,
    Along,
    confirming_lines,
    in_order,
    indices_for_all_values,
    poles,
    rank_for_all_values,
    setpoint_rank,
)
from mcexact.answer.evidence import RootDisc
from mcexact.answer.parameters import (
    ParametricFixedSpectrum,
    ParametricRank,
    TransferColumn,
    joined,
    rows_left_out,
    value_text,
    within,
)
from mcexact.answer.several_parameters import (
    ExceptionalHypersurfaces,
    Hypersurface,
    Line,
    RankHypersurfaces,
)
from mcexact.derived.modular import generator
from mcexact.errors import InputError, LimitReached, UsageError, one_of
from mcexact.exact.parametric_polynomials import (
    ParametricPolynomial,
    characteristic,
    common_factors,
    resultant_factors,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import (
    FunctionMatrix,
    RationalFunction,
    cleared,
    product,
    ring,
    total,
)
from mcexact.exact.roots import root_discs
from mcexact.model.entries import as_functions
from mcexact.model.graph import connects
from mcexact.model.parametric import ParametricSystem

# Fixed, uncontrollable and unobservable modes.

_NUMBER = RationalFunction.constant(0, ())
"""What a function of parameters is when they have values."""


def mode_hypersurfaces(system: ParametricSystem) -> ExceptionalHypersurfaces:
    """Decide which modes are fixed for almost all values, and where further modes are."""
    rng = generator(system, "exceptional_hypersurfaces")
    return _Search(system, system, parametric_fixed_spectrum, rng).answer()


def controllability_hypersurfaces(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, observed: bool = False
) -> ExceptionalHypersurfaces:
    """Decide which modes channels do not control for almost all values, and where further ones.

    Parameters
    ----------
    system : ParametricSystem
    channels : iterable of str, optional
        By default all.
    observed : bool
        Whether the question is about observability.
    """
    chosen = system.names if channels is None else system.named(system.indices(channels))
    rng = generator(system, "controllability_hypersurfaces")

    def decide(line: ParametricSystem) -> ParametricFixedSpectrum:
        return parametric_controllability(line, chosen, observed)

    return _Search(system, _with_full_ports(system, chosen, observed), decide, rng).answer()


def _with_full_ports(
    system: ParametricSystem, chosen: tuple[str, ...], observed: bool
) -> ParametricSystem:
    """The one-channel system with the chosen inputs and C = I, or the chosen outputs and B = I."""
    one = [[int(i == j) for j in range(system.n)] for i in range(system.n)]
    identity = as_functions(one, "identity", system.parameters, system.n).matrix()
    named = [channel for channel in system.channels if channel.name in chosen]
    if observed:
        outputs = tuple(row for channel in named for row in channel.C.rows)
        B, C = identity, FunctionMatrix(outputs, system.n)
    else:
        inputs = tuple(sum((channel.B.rows[i] for channel in named), ()) for i in range(system.n))
        B, C = FunctionMatrix(inputs, sum(channel.B.ncols for channel in named)), identity
    return ParametricSystem(system.A, [B], [C], parameters=system.parameters, time=system.time)


class _Search:
    """Draws gains, then lines, until the candidates from gains agree with the answers along lines.

    Parameters
    ----------
    about : ParametricSystem
        The system of the answer.
    system : ParametricSystem
        The system whose fixed modes are the modes in question.
    decide : callable
        Answers the question about ``about`` along a line.
    rng : random.Random
    """

    def __init__(
        self,
        about: ParametricSystem,
        system: ParametricSystem,
        decide: Callable[[ParametricSystem], ParametricFixedSpectrum],
        rng: random.Random,
    ) -> None:
        self.about, self.decide = about, decide
        self.system, self.rng, self.names = system, rng, system.parameters
        parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
        rows = [cleared(M, self.names)[0] for M in parts]
        entries = [about.A, *(M for c in about.channels for M in (c.B, c.C))]
        self.A, self.B, self.C = rows[0], rows[1::2], rows[2::2]
        self.poles = poles(entries, self.names)
        self.chi = characteristic(self.A, self.names)

    def answer(self) -> ExceptionalHypersurfaces:
        """The answer."""
        for attempt in range(DRAWS):
            drawn = self._candidates(1 + attempt)
            if drawn is None:
                continue
            generic, candidates = drawn
            degree = sum(p.degree for p in generic)

            def is_generic(answer: ParametricFixedSpectrum, degree: int = degree) -> bool:
                return sum(len(p) - 1 for p in answer.generic) == degree

            result = confirming_lines(self.about, self.decide, is_generic, candidates, self.rng)
            if result is not None:
                break
        else:
            raise LimitReached("no drawn gains leave the fixed modes alone")
        lines, confirmed = result
        # Where a line meets two hypersurfaces at once, either may be why a mode is fixed.
        met = Counter(id(value) for values in confirmed.values() for value in values)
        alone = {
            h: [value for value in values if met[id(value)] == 1] or values
            for h, values in confirmed.items()
        }
        sets = {
            h: {mode.channels for value in values for mode in value.modes}
            for h, values in alone.items()
        }
        return ExceptionalHypersurfaces(
            about=self.about,
            hypersurfaces=tuple(
                Hypersurface(
                    h,
                    channels=() if self.system is not self.about else tuple(sorted(sets[h])),
                    example=_example(alone[h], lines),
                )
                for h in in_order(sets)
            ),
            undefined_at=tuple(in_order(self.poles)),
            lines=lines,
            generic=tuple(p.functions() for p in generic),
        )

    def _loop(self, size: int) -> ParametricPolynomial:
        """det(xI − A − Σ B_i F_i C_i) for drawn gains of this size."""
        inside = ring(self.names)
        zero, closed = inside.constant(0), self.A
        for B_i, C_i, (p, q) in zip(self.B, self.C, self.system.sizes, strict=True):
            if p and q and self.system.n:
                F = [
                    [inside.constant(self.rng.randint(-size, size)) for _ in range(q)]
                    for _ in range(p)
                ]
                closed = total(closed, product(product(B_i, F, zero), C_i, zero))
        return characteristic(closed, self.names)

    def _candidates(
        self, size: int
    ) -> tuple[list[ParametricPolynomial], list[RationalFunction]] | None:
        """The factors that drawn gains do not move, and the candidates for hypersurfaces.

        None if one of the two loops keeps more factors than the other: then resultants are 0, and
        there are no candidates.
        """
        psi = [self.chi, self._loop(size), self._loop(size)]
        generic = common_factors(psi)
        for p in generic:
            psi = [f.without(p) for f in psi]
        if not all(psi[0].is_coprime(f) for f in psi[1:]):
            return None
        left, first, second = (f.factors() for f in psi)
        in_both = resultant_factors(left, first) & resultant_factors(left, [*second, *generic])
        return generic, [h for h in in_both if h not in self.poles]


def _example(
    values: Iterable[Any], lines: Iterable[Line[ParametricFixedSpectrum]]
) -> tuple[dict[str, Fraction], tuple[Polynomial, ...]] | None:
    """A value at which a line meets a hypersurface, and the modes that are fixed only there."""
    chosen = {id(value) for value in values}
    for line in lines:
        for each in line.answer.exceptional:
            s = each.exact
            if s is not None and id(each) in chosen:
                at = {
                    name: value.substituted([s], _NUMBER).value for name, value in line.at.items()
                }
                scale = line.answer.scale(s)
                modes = {
                    p.monic()
                    for mode in each.modes
                    for p, _ in Polynomial.from_coefficients([c(s) for c in mode.polynomial])
                    .scale(scale)
                    .factor()
                }
                return at, tuple(sorted(modes, key=lambda p: (p.degree, p.coefficients)))
    return None


# The transfer graph and completeness, for one parameter or several.

Pair = tuple[str, str]
Surface = Polynomial | RationalFunction
"""A polynomial in the parameters, at whose roots something is lost."""


@dataclass(frozen=True)
class ParametricTransferGraph:
    """The transfer graph for all values of a parameter, or for almost all of several.

    Attributes
    ----------
    columns : mapping of (str, str) to ParametricRank or RankHypersurfaces
        For each pair (j, i) of channels the rank, 1 or 0, of the column of all entries of
        C_i A^k B_j, k < n.
    """

    columns: Mapping[Pair, Any]

    @property
    def arcs(self) -> tuple[Pair, ...]:
        """The edges j → i for almost every value."""
        return tuple(pair for pair, answer in self.columns.items() if answer.rank)

    @property
    def lost(self) -> dict[Pair, tuple[Any, ...]]:
        """The values at which an edge vanishes, for each edge that vanishes somewhere."""
        return {pair: each.exceptional for pair, each in self.columns.items() if each.exceptional}

    @property
    def certificates(self) -> tuple[Along, ...]:
        """The answers that prove it, with several parameters those along lines."""
        return tuple(proof for each in self.columns.values() for proof in _proofs(each))

    @property
    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """For each pair of channels, the values for which it is an edge."""
        rows = joined((f"{start} -> {end}", each) for (start, end), each in self.columns.items())
        return tuple((at, _as_edge(what), why) for at, what, why in rows)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: the edges for almost every value."""
        return {"arcs": [[*pair] for pair in self.arcs]}

    @property
    def lost_at(self) -> tuple[Surface, ...]:
        """The polynomials at whose roots an edge vanishes."""
        return tuple({q: None for each in self.columns.values() for q in each.exceptional_at})

    def strongly_connected(self, without: Surface | None = None) -> bool:
        """Whether the edges for almost every value, or for the roots of a polynomial, connect."""
        names = {name for pair in self.columns for name in pair}
        lasting = (p for p in self.arcs if without not in self.columns[p].exceptional_at)
        return connects(names, lasting)


def parametric_transfer_graph(system: ParametricSystem) -> ParametricTransferGraph:
    """Decide for every pair of channels for which values of a parameter C_i (xI − A)⁻¹ B_j ≠ 0.

    Examples
    --------
    >>> B, C = [[[1]], [["t"]]], [[[1]], [["t^2 - 2"]]]
    >>> plant = ParametricSystem([["t"]], B, C, parameters=["t"])
    >>> lost = parametric_transfer_graph(plant).lost
    >>> [(pair, [str(each.value) for each in values]) for pair, values in lost.items()]
    [(('1', '2'), ['x^2 - 2']), (('2', '1'), ['x']), (('2', '2'), ['x', 'x^2 - 2'])]
    """
    return ParametricTransferGraph(
        {
            (j, i): rank_for_all_values(system, TransferColumn(j, i))
            for j in system.names
            for i in system.names
        }
    )


@dataclass(frozen=True)
class ParametricCompleteness:
    """For which values of parameters no mode is fixed and the transfer graph connects.

    Attributes
    ----------
    spectrum : ParametricFixedSpectrum or ExceptionalHypersurfaces
    graph : ParametricTransferGraph
    """

    spectrum: ParametricFixedSpectrum | ExceptionalHypersurfaces
    graph: ParametricTransferGraph

    @property
    def generic(self) -> bool:
        """Whether the plant is complete for almost every value; else it is for none."""
        return not self.spectrum.generic and self.graph.strongly_connected()

    @cached_property
    def exceptional(self) -> tuple[Surface, ...]:
        """The polynomials at whose roots a generically complete plant is not complete."""
        if not self.generic:
            return ()
        cut = [q for q in self.graph.lost_at if not self.graph.strongly_connected(q)]
        polynomials = {*self.spectrum.exceptional_at, *cut}
        surfaces = in_order([q for q in polynomials if isinstance(q, RationalFunction)])
        values = [q for q in polynomials if isinstance(q, Polynomial)]
        return (*surfaces, *sorted(values, key=lambda q: (q.degree, q.coefficients)))

    @property
    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """The values for which the plant is complete, in words."""
        about = self.spectrum.about
        beyond = any(
            each.left_out.outside for each in (self.spectrum, *self.graph.columns.values())
        )
        names = ", ".join(about.parameters_in_words if beyond else about.parameters)
        some = "almost " if self.exceptional else ""
        verdict = "complete" if self.generic else "not complete"
        lines = [(f"{some}every value of {names}", verdict, "")]
        for q in self.exceptional:
            lines.append((self._at(q), "not complete", ""))
        parts = [self.spectrum, *self.graph.columns.values()]
        return *lines, *rows_left_out(each.left_out for each in parts)

    def _at(self, q: Surface) -> str:
        """The words for the roots of a polynomial in the parameters."""
        about = self.spectrum.about
        if isinstance(q, RationalFunction):
            return Hypersurface(q).inside(about)
        [t], [bounds] = about.parameters, about.ranges
        discs = tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(q))
        return value_text(q, discs, t) + within(True, bounds)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {"complete_for_almost_every_value": self.generic}

    @property
    def certificates(self) -> tuple[Along, ...]:
        """The answers that prove it, with several parameters those along lines."""
        return *_proofs(self.spectrum), *self.graph.certificates


def _as_edge(what: str) -> str:
    """A row about the rank of a column in words of edges."""
    for rank, edge in ((": rank 1", ": an edge"), (": rank 0", ": no edge")):
        what = what.removesuffix(rank) + edge if what.endswith(rank) else what
    return what


def _proofs(
    answer: Along | ExceptionalHypersurfaces | RankHypersurfaces,
) -> tuple[Along, ...]:
    """The certificates of an answer: itself, or with several parameters those along lines."""
    if isinstance(answer, ParametricFixedSpectrum | ParametricRank):
        return (answer,)
    return tuple(answer.certificates.values())


def parametric_completeness(
    system: ParametricSystem,
    spectrum: ParametricFixedSpectrum | ExceptionalHypersurfaces | None = None,
    graph: ParametricTransferGraph | None = None,
) -> ParametricCompleteness:
    """Decide for which values of parameters a plant is complete.

    Parameters
    ----------
    system : ParametricSystem
    spectrum, graph : optional
        The fixed modes and the transfer graph, if they are known already.
    """
    if spectrum is None:
        one = len(system.parameters) == 1
        spectrum = (parametric_fixed_spectrum if one else mode_hypersurfaces)(system)
    return ParametricCompleteness(spectrum, graph or parametric_transfer_graph(system))


# All questions that are decided for several parameters.

Modes = Literal[
    "fixed_spectrum",
    "joint_controllability",
    "joint_observability",
    "channel_controllability",
    "channel_observability",
]
Indices = Literal["controllability_indices", "observability_indices"]

_DECIDED: dict[str, Callable[..., Any]] = {
    "fixed_spectrum": mode_hypersurfaces,
    "joint_controllability": controllability_hypersurfaces,
    "joint_observability": partial(controllability_hypersurfaces, observed=True),
    "channel_controllability": controllability_hypersurfaces,
    "channel_observability": partial(controllability_hypersurfaces, observed=True),
    "controllability_indices": indices_for_all_values,
    "observability_indices": partial(indices_for_all_values, observed=True),
    "transfer_graph": parametric_transfer_graph,
    "completeness": parametric_completeness,
    "setpoint": setpoint_rank,
}
_OF_SOME = frozenset(name for name in _DECIDED if "ability" in name)


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem,
    question: Modes = "fixed_spectrum",
    *,
    channels: Iterable[str] | None = None,
) -> ExceptionalHypersurfaces: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Literal["setpoint"]
) -> RankHypersurfaces: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Indices, *, channels: Iterable[str] | None = None
) -> tuple[RankHypersurfaces, ...]: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Literal["transfer_graph"]
) -> ParametricTransferGraph: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Literal["completeness"]
) -> ParametricCompleteness: ...


def exceptional_hypersurfaces(
    system: ParametricSystem,
    question: str = "fixed_spectrum",
    *,
    channels: Iterable[str] | None = None,
) -> Any:
    """Decide a question for almost all values of several parameters, and where its answer differs.

    Parameters
    ----------
    system : ParametricSystem
    question : str
        By default which modes are fixed.  "joint_controllability" and "joint_observability" are
        about modes, too.  "setpoint" is about the rank of [A, B; C, 0], and
        "controllability_indices" and "observability_indices" about the ranks of the first k blocks
        [B, A B, …].  "transfer_graph" and "completeness" have results of the same form as with one
        parameter.
    channels : iterable of str, optional
        For controllability, observability and indices the channels in question, by default all.

    Raises
    ------
    LimitReached
        If a degree exceeds a limit.
    UsageError
        If the question is not one of these, or not about some channels.

    Notes
    -----
    Exact.  The irreducible factors that resultants for several drawn gains have in common, or those
    of one minor of full order, are the candidates; those are kept at whose points the answer
    differs on drawn lines.  Along each line a certificate proves the answer for every value.
    Resultants and minors are polynomials in all parameters, which limits this to some ten states.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[0, "a"], [0, 1]], [[[0], [1]]], [[["b - a", 1]]], parameters=["a", "b"]
    ... )
    >>> answer = exceptional_hypersurfaces(plant)
    >>> [str(each) for each in answer.hypersurfaces]
    ['a = 0', 'a - b = 0', 'a^2 - a*b - 1 = 0']
    >>> [str(each) for each in exceptional_hypersurfaces(plant, "setpoint").hypersurfaces]
    ['a = 0', 'a - b = 0']
    """
    InputError.require(system, ParametricSystem, "system")
    one_of(question, tuple(_DECIDED), "question")
    if channels is None:
        return _DECIDED[question](system)
    if question not in _OF_SOME:
        raise UsageError(f"{question} is about all channels: leave out channels")
    return _DECIDED[question](system, channels)
