"""Plants with feedthrough, y_i = C_i x + Σ D_ij u_j, as systems without one.

`input_filters` makes every input a state of the system, which its own agent sets by its derivative
and measures.  Nothing acts on an output at once any more, and the pencils of complementary
subsystems are equivalent to those of the plant with its D (``proofs/feedthrough.v``): the result
has the fixed modes of the plant, with their multiplicities, its transfer graph, and what all
channels together control and observe.  So every decision about systems without feedthrough answers
for the plant, and a controller of the result is a strictly proper one of the plant.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

from mcexact.derived.constructions import regulated_outputs
from mcexact.exact.matrix import Matrix, block, hstack, vstack
from mcexact.model.system import MultiChannelSystem, any_system

FILTERS = "input_filters"
"""The name of the construction."""


def input_filters(system: MultiChannelSystem) -> MultiChannelSystem:
    """Make the inputs states: u̇_i = v_i, in discrete time u_i(t+1) = v_i, and agent i measures u_i.

    Parameters
    ----------
    system : MultiChannelSystem
        With feedthrough or without.

    Returns
    -------
    MultiChannelSystem
        n + Σ p_i states (x, u), the inputs v_i, the outputs (y_i, u_i), no feedthrough, and the
        same neighbor graph.

    Notes
    -----
    Exact.  In block form, with D_i for the rows of D that belong to y_i, and E_i for the columns of
    the identity of size Σ p_i that belong to u_i::

            ⎡ A  B ⎤            ⎡  0  ⎤           ⎡ C_i  D_i  ⎤
        Ã = ⎣ 0  0 ⎦ ,    B̃_i = ⎣ E_i ⎦ ,    C̃_i = ⎣  0   E_i' ⎦

    For all sets s of channels, with T for the others, and every λ::

        rank [λI − Ã, B̃_T; C̃_s, 0] = rank [λI − A, −B_T; C_s, D_{s,T}] + Σ p_i

    so λ is a fixed mode of the result iff it is one of the plant.  Mind the sign of B_T: with D it
    matters.  A controller of the result, v_i' = …, with its state u_i is one of the plant that is
    strictly proper, so that its loop is well posed.  The agent may feed back u_i with any gain, and
    so a pole a in u̇_i = a u_i + v_i makes no other system than a = 0.

    Examples
    --------
    >>> from mcexact import fixed_spectrum
    >>> filtered = input_filters(MultiChannelSystem([[3]], [[[1]]], [[[2]]], D=[[5]]))
    >>> filtered.A.numerators, filtered.B(0).numerators, filtered.C(0).numerators
    (((3, 1), (0, 0)), ((0,), (1,)), ((2, 5), (0, 1)))

    The sign of D can decide whether a mode is fixed:

    >>> A, B, C = [[-1, -1], [-1, -1]], [[[-1], [-1]], [[1], [0]]], [[[1, 0]], [[1, 1]]]
    >>> for sign in (1, -1):
    ...     plant = MultiChannelSystem(A, B, C, D=[[0, 0], [sign, 0]])
    ...     print(fixed_spectrum(input_filters(plant)).polynomial)
    x
    1
    """
    any_system(system)
    n, p = system.n, sum(width for width, _ in system.sizes)
    identity = Matrix.identity(p)
    B, C = [], []
    for i, own in enumerate(_consecutive([width for width, _ in system.sizes])):
        B.append(vstack([Matrix.zeros(n, len(own)), identity.take(cols=own)], ncols=len(own)))
        measured = hstack([system.C(i), system.feedthrough_matrix([i])], nrows=system.q(i))
        known = hstack([Matrix.zeros(len(own), n), identity.take(rows=own)], nrows=len(own))
        C.append(vstack([measured, known], ncols=n + p))
    return system.derived(
        block([[system.A, system.input_matrix()], [Matrix.zeros(p, n), Matrix.zeros(p, p)]]),
        B,
        C,
        {"construction": FILTERS},
        D=None,
        neighbors=system.neighbors,
    )


def _consecutive(sizes: Sequence[int]) -> list[range]:
    """Consecutive ranges of these sizes, from 0 on."""
    return [range(end - size, end) for end, size in zip(accumulate(sizes), sizes, strict=True)]


def without_feedthrough(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the system itself, or with its inputs as states if it has feedthrough."""
    return system if any_system(system).D is None else input_filters(system)


def own_outputs(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the system without the measured inputs that `input_filters` has just added.

    What a controller holds at set-points are the y_i, and not the inputs.  Another system is
    returned as it is.
    """
    if [step["construction"] for step in system.subject[-1:]] != [FILTERS]:
        return system
    selection = []
    for p, outputs in system.sizes:
        q = outputs - p
        selection.append(hstack([Matrix.identity(q), Matrix.zeros(q, p)], nrows=q))
    return regulated_outputs(system, selection)
