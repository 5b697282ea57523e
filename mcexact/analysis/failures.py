"""Single failures of agents, actuators, sensors and links, and the modes that are fixed after them.

`failures` decides the fixed spectrum of the plant without each agent.  What is fixed without one of
its actuators or sensors is also fixed without the agent, and what is fixed without a link is also
fixed without either of its ends.  So parts are decided by themselves only at those agents without
which some further mode is fixed: of a plant that tolerates the loss of each agent, m certificates
prove that it tolerates every single failure.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.check import constructed
from mcexact.answer.failures import Failures
from mcexact.answer.modes import FixedSpectrum
from mcexact.derived.constructions import augmented_outputs, failed
from mcexact.derived.feedthrough import without_feedthrough
from mcexact.errors import UsageError, one_of
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
    any_system(system)
    one_of(information, ("own", "outputs"), "information")
    system = without_feedthrough(system)
    plant, heard = system.plant, information == "outputs"
    if heard and plant.neighbors is None:
        raise UsageError("the links of a plant without a neighbor graph cannot fail")
    steps: Any = plain(system.subject)

    def after(**lost: Any) -> MultiChannelSystem:
        made: MultiChannelSystem = constructed(failed(plant, **lost), steps)
        return augmented_outputs(made) if heard else made

    whole = augmented_outputs(system) if heard else system
    known = FixedSpectrum.known(spectrum, whole, "spectrum")
    if known is None:
        known = fixed_spectrum(whole)
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
