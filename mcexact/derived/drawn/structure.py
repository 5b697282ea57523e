"""Drawn systems with prescribed indices, remnant polynomial or incompleteness."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from mcexact.derived.drawn.choices import Choices, shuffled
from mcexact.derived.drawn.parts import (
    as_polynomial,
    draw_chains,
    draw_ports,
    finished,
    irreducible,
    live,
)
from mcexact.derived.drawn.primary_form import Chain, Coefficients, Draft, Ports, lay_out
from mcexact.derived.drawn.systems import Drawn, system_with_fixed_mode
from mcexact.errors import UsageError


def system_with_indices(
    choices: Choices, indices: Sequence[int], channels: int, *, time: str = "continuous"
) -> Drawn:
    """Draw a jointly observable system with prescribed controllability (Brunovsky) indices.

    Parameters
    ----------
    choices : Choices
    indices : sequence of int
        κ_1, …, κ_r, each ≥ 1; they sum to n and belong to all channels taken together.
    channels : int
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        With ``indices``, largest first.

    Notes
    -----
    A Brunovsky form with a drawn feedback and redundant inputs, neither of which changes the
    indices.  The head of every chain of integrators is measured, so the system is observable.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> system_with_indices(SeededChoices(0), [1, 3], channels=2).indices
    (3, 1)
    """
    if any(k < 1 for k in indices):
        raise UsageError(f"expected indices >= 1, found {list(indices)}")
    n, r = sum(indices), len(indices)
    heads = [sum(indices[:k]) for k in range(r)]
    tails = [head + k - 1 for head, k in zip(heads, indices, strict=True)]
    A = [[int(j == i + 1 and i not in tails) for j in range(n)] for i in range(n)]
    small = (0, 0, 1, -1, 2)
    for tail in tails:
        for j in range(n):
            A[tail][j] += choices.option(small)
    inputs = sorted([*range(channels), *(choices.integer(0, channels - 1) for _ in range(r))])
    pivots = sorted(shuffled(choices, range(len(inputs)))[:r])
    B = [[0] * len(inputs) for _ in range(n)]
    for k, tail in enumerate(tails):
        # On the pivots upper triangular with units, so of full row rank.
        for column in range(len(inputs)):
            if column not in pivots or pivots.index(column) > k:
                B[tail][column] = choices.option(small)
        B[tail][pivots[k]] = 1
    outputs = sorted([*range(channels), *(choices.integer(0, channels - 1) for _ in range(r))])
    rows = shuffled(choices, range(len(outputs)))
    C = [[0] * n for _ in outputs]
    for row, head in zip(rows, heads, strict=False):
        C[row][head] = 1
    for row in rows[r:]:
        C[row] = [choices.option(small) for _ in range(n)]
    draft = Draft(A, B, C)
    system = finished(choices, draft, inputs, outputs, channels, time)
    return Drawn(
        system,
        jointly_controllable=True,
        jointly_observable=True,
        indices=tuple(sorted(indices, reverse=True)),
    )


def system_with_remnant(
    choices: Choices,
    states: int,
    channels: int,
    *,
    nonzero_transfer: bool = False,
    time: str = "continuous",
) -> Drawn:
    """Draw a system with a complementary subsystem of known remnant polynomial.

    Parameters
    ----------
    choices : Choices
    states : int
        n ≥ 3.
    channels : int
        m ≥ 2.
    nonzero_transfer : bool
        Whether the complementary subsystem has a nonzero transfer matrix.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        With ``subset``, ``remnant`` (which may be 1), and ``complete=False`` if that follows.

    Notes
    -----
    Zones as in `primary_form`.  When zone 1 is controlled by T and zone 3 observed by s, P_s is
    equivalent to diag(I, xI − A_22, 0), and its remnant polynomial is that of zone 2. If also a
    chain of integrators leads from one input of T through zones 1 and 3 to one output of s, P_s is
    equivalent to diag(I, xI − A_22, 1, 0): then the first n invariant polynomials do not include
    the last one of xI − A_22.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> drawn = system_with_remnant(SeededChoices(1), states=4, channels=2)
    >>> drawn.remnant.degree <= 4, len(drawn.subset)
    (True, 1)
    """
    if channels < 2 or states < 3:
        raise UsageError("a prescribed remnant polynomial needs at least 2 channels and 3 states")
    order = shuffled(choices, range(channels))
    reach = frozenset(order[: choices.integer(1, channels - 1)])
    subset = frozenset(range(channels)) - reach
    # Every channel has two inputs and outputs, so that two chains of zone 2 are possible.
    owners = tuple(sorted([*range(channels)] * 2))
    middle = choices.integer(1, states - 2)
    polynomial = irreducible(choices, 1)
    if nonzero_transfer:
        first = choices.integer((middle + 1) // 2, middle)
        lengths = [first, *([middle - first] if middle > first else [])]
        # The path is nilpotent, and a mode 0 of zone 2 would need its ports.
        polynomial = polynomial if polynomial[0] else (-1, 1)
    else:
        lengths = [middle]
    between = [Chain(polynomial, (2,) * length) for length in lengths]
    before = choices.integer(1, states - middle - 1)
    after = states - middle - before
    zero: Coefficients = (0, 1)
    if nonzero_transfer:
        path = [Chain(zero, (3,) * after + (1,) * before, reach, subset, pure=True)]
    else:
        path = [
            Chain(zero, (1,) * before, reached_by=reach),
            Chain((-3, 1), (3,) * after, seen_by=subset),
        ]
    inputs, outputs = Ports(owners, reach, 1), Ports(owners, subset, 3)
    draft = lay_out(choices, [*path, *between], inputs, outputs)
    exponent = sum(sorted(lengths)[:-1]) if nonzero_transfer else middle
    remnant = as_polynomial(polynomial) ** exponent
    return Drawn(
        finished(choices, draft, owners, owners, channels, time),
        jointly_controllable=True,
        jointly_observable=True,
        subset=tuple(sorted(subset)),
        remnant=remnant,
        complete=False if exponent or not nonzero_transfer else None,
    )


def incomplete_system(
    choices: Choices,
    states: int,
    channels: int,
    reason: str,
    *,
    time: str = "continuous",
) -> Drawn:
    """Draw a jointly controllable and observable system that is not complete.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        At least 2 each.
    reason : {"fixed mode", "transfer graph"}
        Either a fixed mode; or no fixed mode, and a nonempty proper set of channels that no edge of
        the transfer graph leaves.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        With ``complete=False``; ``subset`` is s for the fixed mode, and the set that no edge enters
        for the transfer graph.

    Notes
    -----
    For the transfer graph: there is no zone 2, one channel of T alone controls and observes zone 1,
    one channel of s alone zone 3.  So no mode is fixed, and C_s (xI − A)⁻¹ B_T = 0.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> incomplete_system(SeededChoices(0), 3, 2, "transfer graph").fixed_modes
    False
    """
    if reason == "fixed mode":
        return system_with_fixed_mode(choices, states, channels, time=time)
    if reason != "transfer graph":
        raise UsageError(f'expected "fixed mode" or "transfer graph", found {reason!r}')
    if channels < 2 or states < 2:
        raise UsageError("an incomplete transfer graph needs at least 2 channels and 2 states")
    order = shuffled(choices, range(channels))
    reach = frozenset(order[: choices.integer(1, channels - 1)])
    subset = frozenset(range(channels)) - reach
    inputs, outputs = draw_ports(choices, channels, reach=reach, subset=subset)
    size = choices.integer(1, states - 1)
    chains = []
    for zone, agents, part in ((1, reach, size), (3, subset, states - size)):
        one = frozenset({choices.option(sorted(agents))})
        limit = min(live(inputs, one), live(outputs, one))
        chains += [
            replace(chain, reached_by=one, seen_by=one)
            for chain in draw_chains(choices, part, limit, zones=(zone,))
        ]
    draft = lay_out(choices, chains, inputs, outputs)
    return Drawn(
        finished(choices, draft, inputs.owners, outputs.owners, channels, time),
        jointly_controllable=True,
        jointly_observable=True,
        fixed_modes=False,
        subset=tuple(sorted(subset)),
        complete=False,
    )
