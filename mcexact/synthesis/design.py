"""Designs: certified controllers, with proofs about their loops and measures in floating point."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from math import isfinite
from typing import Any, Literal

from mcexact.analysis.boxes.failure import FAILING
from mcexact.analysis.stability import certify_stability
from mcexact.answer.account import Account, ShownByAccount
from mcexact.answer.listing import DESIGN
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import Context
from mcexact.errors import UsageError
from mcexact.exact.matrix import finite, matrix_to_float, to_float
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import written
from mcexact.exact.roots import StabilityRegion
from mcexact.floating.margins import loop_margins
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.responses import loop as loop_figure
from mcexact.synthesis.gate import Arithmetic, CertifiedLoop, Proposal, Request, first_certified
from mcexact.synthesis.longest_step import LongestStep
from mcexact.synthesis.optimum.diagnosis import bound_of_eigenvalues, curves_of
from mcexact.synthesis.performance import Performance
from mcexact.synthesis.robustness import (
    EveryLoop,
    every_loop,
    margin_answers,
    margins_part,
)

Method = Literal["decentralized", "observer", "extended"]

_SHOWN = (
    "agent", "network", "dimensions", "observer_order", "feedback_polynomial",
    "error_polynomial", "blocks", "kept", "followed",
)  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class Design(ShownByAccount):
    """The result of every ``design_…`` function.

    Attributes
    ----------
    method : {"decentralized", "observer", "extended"}
    arithmetic : {"exact", "float"}
        The arithmetic in which the controller was found; all proofs are exact.
    loop : CertifiedLoop
    region : StabilityRegion
        The requested region; if it has a bound, every eigenvalue of the loop lies in it.  Without
        one the loop may be unstable, if its spectrum was prescribed so; see `stable`.
    certificates : mapping
        All certificates, keyed by the names of their files.
    parts : mapping
        The parts of the controller by name, ``"solvability"`` if it holds set-points, and
        ``"followed"``, their polynomial, if it follows other signals:

        - observer: ``feedback`` (F_i), ``observer_gains`` ([K_i, H_ij …]), ``estimated`` (L: the
          agents estimate L x); with a channel controller also ``agent`` (who carries it) and
          ``channel_order``, exact ``feedback_polynomial`` and ``error_polynomial``, in floating
          point ``G``, ``L`` and ``attempts``;
        - decentralized and extended: ``network`` (its kind), ``dimensions``, ``kept`` (the modes
          that stay, all fixed), ``observer_order`` (nm + m − 1); extended also ``allocation``.
          A controller that was searched has ``optimum`` and ``diagnosis``, the controller of the
          theorem ``blocks`` and ``gains`` (F̄_i).
    notes : tuple of str
        What was chosen for the user, such as the rate.
    """

    method: Method
    arithmetic: Arithmetic
    loop: CertifiedLoop
    region: StabilityRegion
    certificates: Mapping[str, Answer]
    parts: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def controller(self) -> Controller:
        """m agent programs."""
        return self.loop.controller

    @property
    def order(self) -> int:
        """The dimension of all agents' states."""
        return self.controller.order

    @cached_property
    def stable(self) -> bool:
        """Whether every eigenvalue lies in the region; only a prescribed spectrum may not."""
        return _is_inside(self.loop, self.region)

    @property
    def name(self) -> str:
        """``"setpoint"``, or the method."""
        follows = not self.parts.keys().isdisjoint(("followed", "solvability"))
        return "setpoint" if follows else self.method

    def measures(self) -> dict[str, float | None]:
        """Compute robustness measures of the loop in floating point; None if numbers exceed floats.

        See `LoopMargins`; ``largest_gain`` is the largest absolute entry of the programs.
        """
        return dict(self._measures)

    @cached_property
    def _measures(self) -> dict[str, float | None]:
        M = matrix_to_float(self.loop.matrix)
        figures = {"largest_gain": to_float(self.controller.largest_entry())}
        if all(map(isfinite, M.ravel())):
            figures |= vars(loop_margins(M, self.region.time))
            known = bound_of_eigenvalues(self.loop.matrix, discrete=self.region.discrete)
            if known is not None:
                figures["spectral"] = known
        return {name: finite(figure) for name, figure in figures.items()}

    @property
    def account(self) -> Account:
        """The certificates, with the sentences that follow from them."""
        return self.account_with(None)

    def every_loop(
        self, effort: float = 5.0, deadline: float | None = None, part: Fraction | None = None
    ) -> EveryLoop:
        """Search a proof for all loops in a box around the plant, and a plant whose loop fails.

        Parameters
        ----------
        effort : float
            About the seconds that the search of a proof may take.
        deadline : float, optional
            The time of `time.monotonic` after which no further work is begun.
        part : Fraction, optional
            The part of all entries that is tried first.

        Returns
        -------
        EveryLoop
            If the plant has radii, the box has these.  Otherwise each radius is the same part of
            its entry, which the search chooses.
        """
        return every_loop(self.loop.closed, self.region, effort, deadline, part)

    def account_with(
        self,
        around: EveryLoop | None,
        performance: Performance | None = None,
        longest: LongestStep | None = None,
    ) -> Account:
        """Return the account with certificates about a box, performance and a longer step."""
        facts: dict[str, Any] = {
            "method": self.method,
            "arithmetic": self.arithmetic,
            "region": self.region,
            "order": self.order,
            "bits": self.controller.bit_length(),
        }
        closed, answers = self.loop.closed.system, dict(self.certificates)
        if around is not None and around.proof is not None:
            answers["box_stability"] = around.proof
            facts |= {"part_of_plant": around.part, "part_of_gains": around.gains}
        if around is not None and around.margins:
            answers |= margin_answers(around.margins)
            facts["part_of_margins"] = margins_part(around.margins)
        failing = None if around is None else around.failing
        if failing is not None and failing.refutation is not None:
            answers[FAILING] = failing.refutation
            facts |= failing.facts(closed.plant)
        if performance is not None:
            answers |= performance.answers
        own = self.loop.closed.plant.sample_time
        if longest is not None and (longest.held or longest.step != own):
            answers |= {f"longest_step_{name}": each for name, each in longest.answers.items()}
        context = Context(closed.at_samples, {**facts, **self.parts})
        sentences = DESIGN.sentences(answers, context)
        return Account(answers, context, sentences, closed.subject[:-1], nearby=(FAILING,))

    def plot(self, ax: Any = None) -> Any:
        """Draw the loop's eigenvalues, robustness, decay, and effort or step responses.

        Parameters
        ----------
        ax : four axes of matplotlib, optional

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        UsageError
            If the loop is not stable in floating point, so that it has no such curves.

        Notes
        -----
        Computed in floating point, not certified; the page of ``mcexact design --html`` shows the
        same.  `Controller.plot` draws the gains, and `Trajectory.plot` what `simulate` returns.
        """
        curves = curves_of(self.loop.closed, self.region)
        if curves is None:
            raise UsageError("the loop is not stable: there are no curves of its return to rest")
        return loop_figure(curves, ax)

    def to_dict(self) -> dict[str, Any]:
        """Return the design as plain data; a polynomial is a list of its coefficients."""
        polynomial, bound = self.loop.polynomial, self.region.bound
        return {
            "design": self.name,
            "method": self.method,
            "arithmetic": self.arithmetic,
            "order": self.order,
            "certified_bound": None if bound is None else str(bound),
            "region": str(self.region),
            "closed_loop_polynomial": None if polynomial is None else _plain(polynomial),
            "bits_of_longest_number": self.controller.bit_length(),
            **{key: _plain(self.parts[key]) for key in _SHOWN if key in self.parts},
            "floating_point": self.measures(),
            "controller": self.controller.document(),
        }

    def __repr__(self) -> str:
        bound = f", {self.region}" if self.region.bound is not None else ""
        verdict = "certified" if self.stable else "certified to be unstable"
        return f"Design({self.name}, {self.arithmetic}, order {self.order}{bound}, {verdict})"


def designed(
    method: Method,
    request: Request,
    system: MultiChannelSystem,
    graph: NeighborGraph | None,
    proposals: Iterable[Proposal],
    *,
    stable: bool = False,
) -> Design:
    """Make the design of the first proposal that passes the gate; see `first_certified`."""
    proposal, loop = first_certified(
        system, proposals, request.region, graph, stable=stable, tell=request.tell
    )
    certificates = {proof.kind: proof for proof in loop.proofs}
    region = proposal.region or request.region
    if not _is_inside(loop, region):
        unstable = certify_stability(loop.closed.system)
        certificates[unstable.kind] = unstable
    return Design(
        method,
        request.arithmetic,
        loop,
        region,
        certificates,
        proposal.parts,
        (*request.notes, *proposal.notes),
    )


def with_stays(design: Design, stays: FixedSpectrum | None) -> Design:
    """Add the certificate of what stays however much is shared over a graph, if there is one."""
    if stays is None:
        return design
    return replace(design, certificates={**design.certificates, "shared_fixed_spectrum": stays})


def _is_inside(loop: CertifiedLoop, region: StabilityRegion) -> bool:
    """Whether the certificates of a loop prove that every eigenvalue lies in a region."""
    return loop.polynomial is None or region.contains_roots_of(loop.polynomial)


def _plain(value: Any) -> Any:
    """Convert a part to plain data."""
    if isinstance(value, Polynomial):
        return [written(c) for c in value.coefficients]
    if isinstance(value, Mapping):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return _plain(vars(value)) if hasattr(value, "__dataclass_fields__") else value
