"""Plants in continuous time, sampled."""

from __future__ import annotations

from mcexact.errors import InputError, UsageError
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.exponential import exponential
from mcexact.exact.floats import as_requested
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Entry, rational_text
from mcexact.model.system import MultiChannelSystem

DECIMALS = 12


def c2d(system: MultiChannelSystem, step: Entry, *, decimals: int = DECIMALS) -> MultiChannelSystem:
    """Sample a plant whose inputs are held between samples.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in continuous time.
    step : rational or float
        The time h between samples; 0.1 stands for 1/10.
    decimals : int
        To which the matrix exponential is rounded.

    Returns
    -------
    MultiChannelSystem
        x(t+h) = A_h x + Σ B_{i,h} u_i with exact data, which are the rounded entries of::

                ⎡ A  B ⎤     ⎡ A_h  B_h ⎤
            exp ⎣ 0  0 ⎦ h = ⎣ 0     I  ⎦

        Outputs, names and neighbors stay.  ``source`` states the rounding.  Whatever is decided
        about this plant is decided about the rounded one.  Radii of entries are not carried over,
        which ``source`` states, too: every entry of A_h and B_h depends on many of A and B.

    Raises
    ------
    UsageError
        If the system is in discrete time or no plant, the step is not above 0, or the number of
        decimals is not from 0 to 1000.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> sampled = c2d(plant, "1/10")
    >>> sampled.A.rows()[0], sampled.B(0).rows()
    ((Fraction(1, 1), Fraction(1, 10)), ((Fraction(1, 200),), (Fraction(1, 10),)))
    >>> print(sampled.source)
    sampled every 1/10 with inputs held; every entry of A and B differs from the exact one by at \
most 0.51e-12
    """
    InputError.require(system, MultiChannelSystem, "system")
    if is_discrete(system.time):
        raise UsageError("the system is in discrete time already", where="system")
    if system.subject:
        raise UsageError("expected a plant, found a derived system", where="system")
    h = as_requested(step, where="step")
    if h <= 0:
        raise UsageError(f"expected a time above 0, found {rational_text(h)}", where="step")
    if type(decimals) is not int or not 0 <= decimals <= 1000:
        raise UsageError(f"expected 0 to 1000 decimals, found {decimals!r}", where="decimals")
    n, B = system.n, system.input_matrix()
    upper = hstack([system.A, B]) * h
    found = exponential(vstack([upper, Matrix.zeros(B.ncols, n + B.ncols)]), decimals)
    rows, inputs, start = range(n), list[Matrix](), n
    for i in range(system.m):
        inputs.append(found.take(rows=rows, cols=range(start, start + system.p(i))))
        start += system.p(i)
    told = (
        f"sampled every {rational_text(h)} with inputs held; every entry of A and B differs from "
        f"the exact one by at most 0.51e-{decimals}"
    )
    if system.uncertainty is not None:
        told += "; the values were sampled, and the radii of uncertain entries not carried over"
    return MultiChannelSystem(
        found.take(rows=rows, cols=range(n)),
        inputs,
        [system.C(i) for i in range(system.m)],
        time="discrete",
        names=system.names,
        neighbors=system.neighbors,
        sample_time=h if system.sample_time is None else system.sample_time,
        name=system.name,
        source=told if system.source is None else f"{system.source}; {told}",
    )
