"""Hypothesis strategies that draw exact systems of known structure.

They serve the tests of this package, and the tests of other control algorithms::

    from hypothesis import given
    from mcexact.testing import jointly_controllable_systems

    @given(jointly_controllable_systems(max_states=4))
    def test_my_rank_test_agrees(drawn):
        A = drawn.system.A
        ...

A strategy draws a `Drawn`: a system, and what is known about it *by construction*.  No example is
filtered away, and examples shrink to few states, few channels and small entries.  The systems are
exact; ``mcexact.exact.floats.matrix_to_float`` converts their matrices to arrays of floats.
"""

from mcexact.derived.drawn.systems import Drawn
from mcexact.testing.strategies import (
    HypothesisChoices,
    incomplete_systems,
    jointly_controllable_systems,
    neighbor_graphs,
    sparse_systems,
    systems,
    systems_on_graphs,
    systems_with_deficiency,
    systems_with_fixed_mode,
    systems_with_indices,
    systems_with_remnant,
    uncontrollable_systems,
)

__all__ = [
    "Drawn",
    "HypothesisChoices",
    "incomplete_systems",
    "jointly_controllable_systems",
    "neighbor_graphs",
    "sparse_systems",
    "systems",
    "systems_on_graphs",
    "systems_with_deficiency",
    "systems_with_fixed_mode",
    "systems_with_indices",
    "systems_with_remnant",
    "uncontrollable_systems",
]
