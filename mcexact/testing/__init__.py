"""Hypothesis strategies that draw exact systems of known structure.

They serve the tests of this package, and the tests of other control algorithms::

    from hypothesis import given
    from mcexact.testing import jointly_controllable_systems

    @given(jointly_controllable_systems(max_states=4))
    def test_my_rank_test_agrees(drawn):
        A = np.array(drawn.system.A)
        ...

A strategy draws a `Drawn`: a system, and what is known about it *by construction*.  No example is
filtered away, and examples shrink to few states, few channels and small entries.  The systems are
exact; ``np.array(drawn.system.A)`` is an array of floats.  Hypothesis prints a counterexample as
code, which makes an equal system where it is pasted.

`assert_valid` asserts that the independent checker accepts a certificate.  pytest finds it as a
fixture, too, and the fixture ``gallery_plant``, with which a test runs for every published plant.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
