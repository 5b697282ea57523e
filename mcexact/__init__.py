"""Exact, certified analysis of multi-channel linear systems.

Controllers are linear and time-invariant here, static or dynamic, and a fixed mode is one that none
of these moves.  Controllers that vary with time can move some fixed modes.

The public names are those of ``__init__.pyi``.  Each is loaded when it is first used, so that
importing the package is fast and loads no large libraries.
"""

import lazy_loader

from mcexact.errors import examine_rounded_by

__version__ = "0.1.0"
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def _doubts(system):
    # Only when a plant is made of floats: it loads flint and the questions.
    from mcexact.analysis.analyze import rounding_doubts

    return rounding_doubts(system)


examine_rounded_by(_doubts)
