"""Floating-point verdicts beside exact ones, and recorded ones.

`crosscheck` asks a system the same structural questions twice: exactly, and by functions of numpy,
scipy and python-control at their default tolerances, on the floats nearest to the entries.  Each
row quotes the call.  Where a library raises an error, the row says that it gives no answer.

A wrong answer often depends on the sign of a rounding error, which differs between processors.
Therefore wrong answers are recorded with the libraries and the BLAS kernel that computed them
(`Record`); the records ship with the package, and `recording` writes them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, partial
from importlib import metadata, resources
from typing import TYPE_CHECKING, Any

from mcexact.analysis.boxes.failure import FailingPlant
from mcexact.analysis.boxes.largest import nearest_fixed
from mcexact.analysis.controllability import (
    controllability_indices,
    joint_controllability,
    joint_observability,
    observability_indices,
)
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.nearby.plants import Nearby
from mcexact.analysis.nearby.search import nearby_plants
from mcexact.analysis.performance import PortResponse, Side, response_of, single_margin
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.nearby import Lost
from mcexact.errors import InputError, LimitReached, MissingExtra
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import matrix_to_float, to_float
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.floating import margins, verdicts
from mcexact.floating.verdicts import transfer_edges
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph, strong_components
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.shown import Shown, grid

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


# Recorded floating-point answers, with the libraries and the BLAS kernel that computed them.

RECORDS = "records.json"
_LIBRARIES = ("numpy", "scipy", "control")


@dataclass(frozen=True)
class Libraries:
    """The libraries that compute in floating point, and the BLAS kernel that multiplies matrices.

    Attributes
    ----------
    versions : tuple of (str, str)
        Names and versions; the last library contains the kernel.
    kernel : str or None
        The kernel that this library chose for the processor; None if it is unknown.

    Examples
    --------
    >>> str(Libraries((("numpy", "2.4.6"), ("OpenBLAS", "0.3.31")), "Haswell"))
    'numpy 2.4.6, OpenBLAS 0.3.31 (kernel Haswell)'
    """

    versions: tuple[tuple[str, str], ...]
    kernel: str | None

    def __str__(self) -> str:
        listed = ", ".join(" ".join(each) for each in self.versions)
        return f"{listed} (kernel {self.kernel or 'unknown'})"

    def document(self) -> dict[str, Any]:
        """The libraries as plain data of a JSON document."""
        return {"versions": dict(self.versions), "kernel": self.kernel}


@dataclass(frozen=True)
class Record:
    """A floating-point answer and the libraries that computed it.

    Attributes
    ----------
    floating : str
        The answer, worded as in `CrossCheck`.
    libraries : Libraries
    """

    floating: str
    libraries: Libraries


def libraries_here() -> Libraries:
    """Return the libraries of this process.

    Examples
    --------
    >>> libraries_here().versions[0][0]
    'numpy'
    """
    import numpy as np
    from threadpoolctl import threadpool_info

    versions = [(name, version) for name in _LIBRARIES if (version := _version(name))]
    products = [each for each in threadpool_info() if each["user_api"] == "blas"]
    # scipy may contain a BLAS library of its own; numpy's computes most of the answers.
    products.sort(key=lambda each: np.__name__ not in each["filepath"])
    if not products:
        return Libraries(tuple(versions), None)
    name = products[0]["internal_api"].replace("openblas", "OpenBLAS")
    version = products[0]["version"]
    return Libraries(
        (*versions, *([(name, version)] if version else ())), products[0].get("architecture")
    )


def _version(distribution: str) -> str | None:
    """The installed version of a package."""
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None


@cache
def recorded() -> Mapping[str, Any]:
    """Return the document of records, keyed by what was answered."""
    text = resources.files("mcexact.crosschecks").joinpath(RECORDS).read_text("utf-8")
    document: dict[str, Any] = json.loads(text)
    return document


def libraries_of(document: Mapping[str, Any]) -> Libraries:
    """Return the libraries that a record names."""
    return Libraries(tuple(document["versions"].items()), document["kernel"])


# `crosscheck`, which compares each floating-point verdict on a system with the exact one.

_SEED = 0
_DIGITS = (6, 8, 10)
_SMALL_ENOUGH = 30
"""The states up to which floating point is judged by plants nearby, which are decided, too."""
_TRIES, _SMALL = 3, 12
"""Tries for a plant nearby with a fixed mode, and the states up to which one is searched."""


@dataclass(frozen=True)
class CrossCheck:
    """One question with its floating-point and its exact answer.

    Attributes
    ----------
    question : str
    call : str
        The library function that was called, with its default tolerance.
    floating, exact : str
        Both answers in words.
    agree : bool or None
        None if the floating-point call gave no answer.
    within_data : bool
        Whether the answers differ, and that of floating point is the exact one of a plant nearby
        that the data allow as well: then neither is wrong.
    """

    question: str
    call: str
    floating: str
    exact: str
    agree: bool | None
    within_data: bool = False


@dataclass(frozen=True, eq=False)
class CrossChecks(Shown):
    """The cross-checks of one system.

    Attributes
    ----------
    system : MultiChannelSystem
    rows : tuple of CrossCheck
    nearest : FailingPlant or None
        A plant nearby that has a fixed mode, which is decided exactly; None if none was found.
    libraries : Libraries
        The libraries that computed the floating-point answers.
    nearby : Nearby or None
        The plants nearby that the data allow as well; None if they were not looked for.
    """

    system: MultiChannelSystem
    rows: tuple[CrossCheck, ...]
    nearest: FailingPlant | None
    libraries: Libraries
    nearby: Nearby | None = None

    def __repr__(self) -> str:
        wrong = len(self.disagreements)
        return f"CrossChecks({len(self.rows)} questions, {wrong} wrong in floating point)"

    def explain(self) -> str:
        """Say in plain words where floating point is wrong, one question a line."""
        wrong = self.disagreements
        lines = [f"Floating point is wrong in {len(wrong)} of {len(self.rows)} questions."]
        for row in wrong:
            lines.append(f"{row.question}: {row.floating} ({row.call}); exact: {row.exact}")
        return "\n".join(lines)

    def _html(self) -> str:
        """Return a row in HTML for each question."""
        rows = ([row.question, row.call, row.floating, row.exact, row.agree] for row in self.rows)
        return grid(["question", "call", "in floating point", "exact", "agree"], rows)

    def _labeled(self) -> Iterator[tuple[str, str]]:
        """Yield the questions, each with both answers."""
        for row in self.rows:
            yield row.question, f"{row.floating}; exact: {row.exact}"

    def to_dict(self) -> list[dict[str, Any]]:
        """Return a mapping for each question."""
        return [vars(row) for row in self.rows]

    @property
    def disagreements(self) -> tuple[CrossCheck, ...]:
        """The rows with a wrong floating-point answer."""
        return tuple(row for row in self.rows if row.agree is False and not row.within_data)

    @property
    def within_data(self) -> tuple[CrossCheck, ...]:
        """The rows whose answers differ within what the data allow."""
        return tuple(row for row in self.rows if row.within_data)


@dataclass(frozen=True)
class _Floats:
    """The matrices of a system as arrays of floats."""

    A: Array
    B: tuple[Array, ...]
    C: tuple[Array, ...]

    @property
    def inputs(self) -> Array:
        """All columns of all B_i."""
        import numpy as np

        return np.hstack([np.zeros((len(self.A), 0)), *self.B])

    @property
    def outputs(self) -> Array:
        """All rows of all C_i."""
        import numpy as np

        return np.vstack([np.zeros((0, len(self.A))), *self.C])


def crosscheck(
    system: MultiChannelSystem,
    controller: Controller | None = None,
    graph: NeighborGraph | None = None,
) -> CrossChecks:
    """Answer structural questions about a system in floating point and exactly.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller, optional
        The disk margins of its loops are asked for, too.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Notes
    -----
    The floating-point functions are those of numpy, scipy and python-control at their default
    tolerances, applied to the floats nearest to the entries.  Random gains are drawn from a fixed
    seed.  A verdict that depends on rounding errors can differ between processors, so `libraries`
    names the libraries and the kernel.  Where the answers differ, those of floating point are
    compared with the exact ones of plants nearby, too, if rounding errors or digits that were not
    typed may have led to these (`Analysis.nearby`): then neither answer is wrong.

    ``control.disk_margins`` looks at the frequencies of a grid, which this takes as users do: 1,000
    of them over four decades.  A margin is an artifact of the grid if it is more than 1 % above
    both the proved one and what the same function gives at the worst frequency.  A loop that is not
    stable has no margin, which the function does not notice.

    Examples
    --------
    An input matrix of 10⁻²⁰ is not zero, but any tolerance treats it as zero:

    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], ["1e-20"]]], [[[1, 1]]])
    >>> row = crosscheck(plant).disagreements[0]
    >>> row.question, row.floating, row.exact
    ('joint controllability', 'no, rank 1 of 2', 'yes, rank 2 of 2')
    """
    InputError.require(system, MultiChannelSystem, "system")
    floats = _Floats(
        matrix_to_float(system.A),
        tuple(matrix_to_float(system.B(i)) for i in range(system.m)),
        tuple(matrix_to_float(system.C(i)) for i in range(system.m)),
    )
    spectrum = fixed_spectrum(system)
    rows, near = _rows(system, floats, spectrum), _nearby(system, spectrum)
    for each in () if near is None else near.leading:
        others = _rows(each.plant, floats, fixed_spectrum(each.plant))
        rows = [
            replace(row, within_data=True) if row.agree is False and other.agree else row
            for row, other in zip(rows, others, strict=True)
        ]
    if controller is not None:
        InputError.require(controller, Controller, "controller")
        rows += _margins(closed_loop(system, controller, graph))
    return CrossChecks(
        system,
        tuple(rows),
        _nearest(system, spectrum),
        libraries_here(),
        near,
    )


def _rows(system: MultiChannelSystem, floats: _Floats, spectrum: FixedSpectrum) -> list[CrossCheck]:
    """All questions, with the answers of floats and the exact ones of a system."""
    return [
        *_controllability(system, floats),
        *_indices(system, floats),
        *_fixed_modes(system, floats, spectrum),
        *_graph(system, floats),
        _stability(system, floats),
    ]


def _nearby(system: MultiChannelSystem, spectrum: FixedSpectrum) -> Nearby | None:
    """The plants near a small one of which an answer is another one."""
    if system.subject or system.n > _SMALL_ENOUGH:
        return None
    lost: list[Lost] = []
    if spectrum.stabilizable:
        lost.append("unstable")
    if spectrum.empty:
        lost.append("fixed")
    if joint_controllability(system).controllable:
        lost.append("uncontrollable")
    if joint_observability(system).controllable:
        lost.append("unobservable")
    return nearby_plants(system, lost)


def _nearest(system: MultiChannelSystem, spectrum: FixedSpectrum) -> FailingPlant | None:
    """The system itself if it has a fixed mode, or else a plant nearby that has one."""
    plant = as_plant(system)
    if not spectrum.empty:
        return FailingPlant(plant, Fraction(0), 0j, spectrum.factors[0].channels)
    try:
        return nearest_fixed(plant, _TRIES) if plant.n <= _SMALL else None
    except LimitReached:
        return None


@dataclass(frozen=True)
class _NoAnswer:
    """A library call that raised an error."""

    reason: str

    def __str__(self) -> str:
        return f"no answer ({self.reason})"


def _answer(call: Callable[[], Any]) -> Any:
    """The value that a library call returns, or the reason why it returns none."""
    import warnings

    import numpy as np

    with warnings.catch_warnings():
        # A call may warn and still return an answer, and the answer is what is compared.
        warnings.simplefilter("ignore")
        try:
            return call()
        except ModuleNotFoundError as error:
            return _NoAnswer(f"{error.name} is not installed")
        except (np.linalg.LinAlgError, ArithmeticError, ValueError) as error:
            return _NoAnswer(type(error).__name__)


def _row(
    question: str, call: str, floating: Any, truth: Any, words: Callable[[Any], str]
) -> CrossCheck:
    """Compare a floating-point answer with the exact one."""
    if isinstance(floating, _NoAnswer):
        return CrossCheck(question, call, str(floating), words(truth), None)
    return CrossCheck(question, call, words(floating), words(truth), bool(floating == truth))


def _yes(answer: Any) -> str:
    return "yes" if answer else "no"


def _controllability(system: MultiChannelSystem, floats: _Floats) -> list[CrossCheck]:
    """Joint controllability or observability from ranks, and from the Hautus test."""
    n, A, rows = system.n, floats.A, []
    for name, truth, letter, call, matrix in (
        ("controllability", joint_controllability(system), "B", "ctrb", floats.inputs),
        ("observability", joint_observability(system), "C", "obsv", floats.outputs),
    ):
        rows.append(
            _row(
                f"joint {name}",
                f"numpy.linalg.matrix_rank(control.{call}(A, {letter}))",
                _answer(partial(verdicts.control_rank, call, A, matrix)),
                truth.dimension,
                lambda rank: f"{_yes(rank == n)}, rank {rank} of {n}",
            )
        )
        pair = (A, matrix) if call == "ctrb" else (A.T, matrix.T)
        shown = "[x*I - A, B]" if call == "ctrb" else "[x*I - A; C]"
        rows.append(
            _row(
                f"joint {name}, Hautus",
                f"numpy.linalg.matrix_rank({shown}) for x in numpy.linalg.eigvals(A)",
                _answer(partial(verdicts.hautus_controllable, *pair)),
                truth.controllable,
                _yes,
            )
        )
    return rows


def _indices(system: MultiChannelSystem, floats: _Floats) -> list[CrossCheck]:
    """The controllability or observability index, from the ranks of the first blocks."""
    rows = []
    for name, truth, blocks, pair in (
        (
            "controllability",
            controllability_indices(system),
            "[B, AB, ...]",
            (floats.A, floats.inputs),
        ),
        (
            "observability",
            observability_indices(system),
            "[C; CA; ...]",
            (floats.A.T, floats.outputs.T),
        ),
    ):
        rows.append(
            _row(
                f"{name} index",
                f"least k with numpy.linalg.matrix_rank({blocks}) = n",
                _answer(partial(verdicts.controllability_index, *pair)),
                truth.index,
                lambda index: "none" if index is None else str(index),
            )
        )
    return rows


def _fixed_modes(
    system: MultiChannelSystem, floats: _Floats, spectrum: FixedSpectrum
) -> list[CrossCheck]:
    """Fixed modes from rounded eigenvalues of drawn loops, and from numerical ranks of pencils."""
    count, rows = spectrum.polynomial.degree, []

    def words(number: int) -> str:
        return "none" if not number else f"{number} distinct"

    for digits in _DIGITS:
        rounded = _answer(partial(_rounded, floats, digits))
        count_of_rounded = rounded if isinstance(rounded, _NoAnswer) else len(rounded)
        call = f"numpy.round(numpy.linalg.eigvals(A + sum B_i F_i C_i), {digits}) of 5 draws"
        rows.append(_row(f"fixed modes, {digits} digits", call, count_of_rounded, count, words))
    tried = verdicts.few_subsets(system.m)
    named = {frozenset(system.index(c) for c in f.channels) for f in spectrum.factors}
    modes = _answer(
        lambda: bool(verdicts.pencil_fixed_modes(floats.A, floats.B, floats.C, tried | named))
    )
    call = "numpy.linalg.matrix_rank([x*I - A, B; C, 0]) < n for x in numpy.linalg.eigvals(A)"
    rows.append(_row("any fixed mode, pencils", call, modes, not spectrum.empty, _yes))
    return rows


def _rounded(floats: _Floats, digits: int) -> tuple[complex, ...]:
    """The eigenvalues that the loops of drawn gains have in common when rounded to some digits."""
    return verdicts.rounded_fixed_modes(floats.A, floats.B, floats.C, digits=digits, seed=_SEED)


def _graph(system: MultiChannelSystem, floats: _Floats) -> list[CrossCheck]:
    """The transfer graph, and completeness decided from it and from the rounded fixed modes."""
    exact = transfer_graph(system)
    truth = frozenset((system.index(j), system.index(i)) for j, i in exact.arcs)
    arcs = _answer(lambda: transfer_edges(floats.A, floats.B, floats.C))
    edges = _row(
        "transfer graph",
        "numpy.allclose(scipy.signal.ss2tf(A, B_j, C_i, 0)[0], 0)",
        arcs,
        truth,
        lambda edges: f"{len(edges)} edges",
    )
    rounded = _answer(
        lambda: (
            not _rounded(floats, _DIGITS[1]) and len(strong_components(system.m, sorted(arcs))) <= 1
        )
    )
    return [
        edges,
        _row(
            "completeness",
            "networkx.is_strongly_connected(edges) and no mode fixed to 8 digits",
            arcs if isinstance(arcs, _NoAnswer) else rounded,
            completeness(system).complete,
            _yes,
        ),
    ]


def _stability(system: MultiChannelSystem, floats: _Floats) -> CrossCheck:
    """Whether A is stable."""
    region = StabilityRegion(system.time)
    verdict = _answer(lambda: margins.is_within(floats.A, region))
    call = (
        "abs(numpy.linalg.eigvals(A)).max() < 1"
        if region.discrete
        else "numpy.linalg.eigvals(A).real.max() < 0"
    )
    truth = region.contains_roots_of(characteristic_polynomial(system.A))
    return _row("stability of A", call, verdict, truth, _yes)


# Disk margins of a loop, by python-control on a grid of frequencies and proved.

_SIDES: tuple[Side, ...] = ("inputs", "outputs")
_GRID, _DECADES = 1000, (-2.0, 2.0)
"""The frequencies that python-control looks at, in radians, as powers of ten."""
_TOO_LARGE = 1.01
"""By how much a margin on the grid may exceed that at the worst frequency."""


def _margins(loop: ClosedLoop) -> list[CrossCheck]:
    """The disk margin of each input and of each output by itself."""
    names, rows = loop.plant.names, list[CrossCheck]()
    for side in _SIDES:
        response, size = response_of(loop, side), loop.plant.p if side == "inputs" else loop.plant.q
        owners = [(i, k) for i in range(loop.plant.m) for k in range(size(i))]
        for port, (i, k) in enumerate(owners):
            which = f" {k + 1}" if size(i) > 1 else ""
            port_name = f"{side.removesuffix('s')}{which} of agent {names[i]}"
            rows.append(_margin(loop, response, port, f"disk margin of the {port_name}"))
    return rows


def _margin(loop: ClosedLoop, response: PortResponse, port: int, question: str) -> CrossCheck:
    """The margin that python-control finds beside the one that is proved."""
    ends = ", ".join(f"{end:g}" for end in _DECADES)
    call = f"control.disk_margins(L, numpy.logspace({ends}, {_GRID}))"
    found = _answer(lambda: _by_control(loop, response, port))
    floating = str(found) if isinstance(found, _NoAnswer) else f"{found[0]:.4g}"
    if response.unstable:
        # disk_margins takes the loop for stable, and answers all the same
        agree = None if isinstance(found, _NoAnswer) else False
        return CrossCheck(question, call, floating, "none, the loop is not stable", agree)
    proved = single_margin(response, port)
    if proved is None:
        return CrossCheck(question, call, floating, "not proved", None)
    exact = f"at least {to_float(proved):.3g}"
    if isinstance(found, _NoAnswer):
        return CrossCheck(question, call, floating, exact, None)
    on_grid, at_worst, frequency = found
    more = on_grid / to_float(proved) - 1
    said = f"{on_grid:.4g}, {100 * abs(more):.3g} % {'more' if more >= 0 else 'less'}"
    # a proof may lose some per cent, which is no fault of the grid
    right = on_grid <= _TOO_LARGE * max(to_float(proved), at_worst)
    if not right:
        unit = "rad a step" if is_discrete(loop.plant.time) else "rad/s"
        said += f", an artifact of the grid: {at_worst:.4g} at {frequency:.4g} {unit}"
    return CrossCheck(question, call, said, exact, right)


def _by_control(
    loop: ClosedLoop, response: PortResponse, port: int
) -> tuple[float, float, float] | _NoAnswer:
    """The margin on the grid, that at the worst frequency which we know, and this frequency."""
    import cmath

    with MissingExtra.named("control"):
        import control
    import numpy as np

    if not hasattr(control, "disk_margins"):
        return _NoAnswer("control has no disk_margins before 0.10.2")
    M, enter, leave = map(matrix_to_float, response.exact)
    e, y = enter[:, [port]], leave[[port]]
    discrete = is_discrete(loop.plant.time)
    # the loop opened at the port, with the usual sign of feedback
    L = control.ss(M - e @ y, e, -y, 0, True if discrete else 0)
    grid = np.logspace(*_DECADES, _GRID)
    grid = grid[grid <= np.pi] if discrete else grid
    z = response.worst_point(port)
    worst = abs(cmath.phase(z)) if discrete else abs(z.imag)
    on_grid, at_worst = (
        float(control.disk_margins(L, np.asarray(points))[0]) for points in (grid, [worst])
    )
    return on_grid, at_worst, worst
