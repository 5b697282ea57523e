"""Failures of agents, actuators, sensors and links, and the modes that are fixed after them.

`failures` decides the fixed spectrum of the plant without each agent.  What is fixed without one of
its actuators or sensors is also fixed without the agent, and what is fixed without a link is also
fixed without either of its ends.  So parts are decided by themselves only at those agents without
which some further mode is fixed: of a plant that tolerates the loss of each agent, m certificates
prove that it tolerates every single failure.

`fewest_failures` finds the fewest failures that matter.  A set of parts is enough if no further
mode is fixed while these work; some failures matter if and only if they meet every set that is
enough.  So the fewest are a least hitting set, by a search that alternates: the least set of
failures that meets all known sets either matters, and is the answer, or the parts that it leaves
are enough, and a smallest part of them is a new set.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.check import constructed
from mcexact.answer.failures import PARTS, Failures, FewestFailures, every, hitting_set
from mcexact.answer.modes import FixedSpectrum
from mcexact.derived.constructions import augmented_outputs, failed
from mcexact.derived.feedthrough import without_feedthrough
from mcexact.errors import LimitReached, UsageError, one_of, several
from mcexact.model.system import MultiChannelSystem, any_system
from mcexact.model.text import plain


def failures(
    system: MultiChannelSystem,
    information: str = "own",
    *,
    spectrum: FixedSpectrum | None = None,
) -> Failures:
    """Decide which modes are fixed after each single failure.

    Parameters
    ----------
    system : MultiChannelSystem
        With feedthrough or without.  Of a derived system, such as one without a part of its state,
        it is the plant that fails, and the same constructions follow.
    information : {"own", "outputs"}
        Whether each agent feeds back its own outputs, or also those of its neighbors; then links
        can fail, too.
    spectrum : FixedSpectrum, optional
        That of the system without a failure, if it is known.

    Returns
    -------
    Failures
        A certificate for the failure of each agent; then for each actuator, each sensor, and with
        neighbors each link, at agents without which some further mode is fixed.

    Raises
    ------
    UsageError
        If neighbors are meant and there is no neighbor graph.

    Notes
    -----
    Exact.  One fixed spectrum for each agent, and one for each part of those that matter: at most
    m + Σ (p_i + q_i) and the links.  That no other failure leaves a further mode fixed follows by
    ``failures.fixed_after_more``.

    Examples
    --------
    Without agent 1 no mode is fixed, and without any part of agent 2 the unstable one is:

    >>> B, C = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[1, 1]]]
    >>> print(failures(MultiChannelSystem([[-1, 1], [0, 2]], B, C)))
    agent 1: nothing is fixed
    agent 2: x - 2
    actuator 1 of agent 2: x - 2
    sensor 1 of agent 2: x - 2
    """
    some = _Failing.of(system, information, spectrum)
    plant, heard, known, after = some.plant, some.heard, some.known, some.after
    alone = [fixed_spectrum(after(agents=[name])) for name in plant.names]
    pairs = zip(plant.names, alone, strict=True)
    names = {name for name, each in pairs if each.polynomial != known.polynomial}
    parts = [
        fixed_spectrum(after(**{what: [(name, k + 1)]}))
        for what, size in _sizes(plant).items()
        for i, name in enumerate(plant.names)
        if name in names
        for k in range(size(i))
    ]
    if heard and plant.neighbors is not None:
        links = [(plant.names[j], plant.names[i]) for j, i in plant.neighbors.edges()]
        parts += [fixed_spectrum(after(links=[edge])) for edge in links if names.issuperset(edge)]
    return Failures([*alone, *parts])


def _sizes(plant: MultiChannelSystem) -> dict[str, Callable[[int], int]]:
    """The numbers of actuators and of sensors by agents."""
    return {"actuators": plant.p, "sensors": plant.q}


@dataclass(frozen=True)
class _Failing:
    """A system whose plant fails: the plant, the constructions that follow, and what is fixed."""

    plant: MultiChannelSystem
    heard: bool
    steps: Any
    known: FixedSpectrum

    @classmethod
    def of(
        cls, system: MultiChannelSystem, information: str, spectrum: FixedSpectrum | None
    ) -> _Failing:
        any_system(system)
        one_of(information, ("own", "outputs"), "information")
        system = without_feedthrough(system)
        plant, heard = system.plant, information == "outputs"
        if heard and plant.neighbors is None:
            raise UsageError("the links of a plant without a neighbor graph cannot fail")
        whole = augmented_outputs(system) if heard else system
        known = FixedSpectrum.known(spectrum, whole, "spectrum")
        known = fixed_spectrum(whole) if known is None else known
        return cls(plant, heard, plain(system.subject), known)

    def usual(self) -> list[str]:
        """The parts that are asked about: those of agents only where their failures differ."""
        plant, links = self.plant, ["links"] * self.heard
        sizes = _sizes(plant).items()
        ports = [
            what for what, size in sizes if self.heard or any(size(i) > 1 for i in range(plant.m))
        ]
        return ["agents", *ports, *links]

    def after(self, **lost: Any) -> MultiChannelSystem:
        """The system after failures."""
        made: MultiChannelSystem = constructed(failed(self.plant, **lost), self.steps)
        return augmented_outputs(made) if self.heard else made


# The fewest failures.

DEFAULT_NODE_LIMIT = 10_000
"""The nodes of the search for each part after which the bounds that were reached are returned."""


def fewest_failures(
    system: MultiChannelSystem,
    information: str = "own",
    *,
    parts: Iterable[str] | None = None,
    spectrum: FixedSpectrum | None = None,
    node_limit: int = DEFAULT_NODE_LIMIT,
) -> FewestFailures:
    """Find the fewest agents after whose failure a further mode is fixed, or one is unstable.

    Parameters
    ----------
    system : MultiChannelSystem
        As for `failures`.
    information : {"own", "outputs"}
        Whether each agent feeds back its own outputs, or also those of its neighbors.
    parts : sequence of str, optional
        Of "agents", "actuators", "sensors" and "links", those of which the fewest are looked for,
        each by itself.  By default agents, and actuators and sensors where an agent has several;
        with neighbors all four.
    spectrum : FixedSpectrum, optional
        That of the system without a failure, if it is known.
    node_limit : int, optional
        The most nodes of the search for each part.

    Returns
    -------
    FewestFailures
        For each part certificates that prove the least number, or bounds if the limit was reached.

    Raises
    ------
    UsageError
        If neighbors are meant and there is no neighbor graph.

    Notes
    -----
    Exact.  NP-hard, as hitting sets are.  The certificates are fixed spectra after failures: one
    after the fewest, and those after which no further mode is fixed, of which each proves the same
    of all failures in it (``failures.at_least_so_many``).  A mode of geometric multiplicity 1 has a
    minimum cut between its null vectors, and as many disjoint paths through agents; these paths are
    sets of parts that are enough, so that the search ends at the same number.

    Examples
    --------
    Each of three agents moves the mode 1, and the first two only move the mode 2:

    >>> B, C = [[[1], [1]]] * 2 + [[[1], [0]]], [[[1, 0], [0, 1]]] * 2 + [[[1, 0]]]
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], B, C)
    >>> fewest = fewest_failures(plant, parts=["agents"])
    >>> print(fewest)
    further fixed: agent 1 and agent 2; by any 1 agents: no
    not stabilizable: agent 1 and agent 2; by any 1 agents: no
    """
    some = _Failing.of(system, information, spectrum)
    asked = some.usual() if parts is None else several(parts, "parts", "parts")
    for part in asked:
        one_of(part, PARTS if some.heard else PARTS[:3], "parts")
    if type(node_limit) is not int or node_limit < 1:
        expected = f"expected an integer of at least 1, found {node_limit!r}"
        raise UsageError(expected, where="node_limit")
    certificates: list[FixedSpectrum] = []
    for part in dict.fromkeys(asked):
        if every(part, some.plant):
            certificates += _Search(some, part, node_limit).certificates()
    return FewestFailures(certificates, some.known)


class _Search:
    """The search for the fewest failures of a part, which are sets of bits.

    Attributes
    ----------
    parts : list of Failure
    spectra : dict
        The fixed spectra that were decided, by failures.
    nodes : int
        The nodes that are left.
    """

    def __init__(self, some: _Failing, part: str, node_limit: int) -> None:
        self._some, self._part = some, part
        self.parts = every(part, some.plant)
        self.all = (1 << len(self.parts)) - 1
        self.spectra: dict[int, FixedSpectrum] = {0: some.known}
        self.nodes = node_limit

    def certificates(self) -> list[FixedSpectrum]:
        """The certificates that prove the least numbers, or bounds."""
        before = self._some.known.polynomial
        used = self._proof(lambda each: each.polynomial == before, [])
        if self._some.known.stabilizable:
            enough = [lost for lost in used if self._after(lost).stabilizable]
            used += self._proof(lambda each: each.stabilizable, enough)
        return [self._after(lost) for lost in dict.fromkeys(used) if lost]

    def _after(self, lost: int) -> FixedSpectrum:
        if lost not in self.spectra:
            named = [one for k, one in enumerate(self.parts) if lost >> k & 1]
            what: list[Any] = [one.agent if one.which is None else one[1:] for one in named]
            self.spectra[lost] = fixed_spectrum(self._some.after(**{self._part: what}))
        return self.spectra[lost]

    def _proof(self, fine: Callable[[FixedSpectrum], bool], known: list[int]) -> list[int]:
        """Failures after which all is fine, of which those before are known; then the fewest.

        If it is still fine after all of them, these alone.
        """
        if fine(self._after(self.all)):
            return [self.all]
        spared, size = [0, *known], 0
        while True:
            try:
                lost = hitting_set({self.all - each for each in spared}, size, self._node)
            except LimitReached:
                return [*spared, self._fewer(self.all, lambda some: not fine(self._after(some)))]
            if lost is None:
                size += 1
            elif not fine(self._after(lost)):
                return [*spared, lost]
            else:
                spared.append(self._more(lost, spared, fine))

    def _node(self) -> None:
        if not self.nodes:
            raise LimitReached("the limit of nodes was reached")
        self.nodes -= 1

    def _more(self, lost: int, spared: list[int], fine: Callable[[FixedSpectrum], bool]) -> int:
        """As many failures as possible after which all is fine, these among them.

        Parts that few of the sets before spare come first: sets that differ prove more.
        """
        used = [sum(not each >> k & 1 for each in spared[1:]) for k in range(len(self.parts))]
        for k in sorted(range(len(used)), key=lambda k: -used[k]):
            if not lost >> k & 1 and fine(self._after(lost | 1 << k)):
                lost |= 1 << k
        return lost

    def _fewer(self, lost: int, matters: Callable[[int], bool]) -> int:
        """Failures that still matter, and of which none can be left out."""
        for k in range(len(self.parts)):
            if matters(lost & ~(1 << k)):
                lost &= ~(1 << k)
        return lost
