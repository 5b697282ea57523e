"""Exact, certified analysis of multi-channel linear systems.

Control and controllers are linear and time-invariant here, with states of their own or without:
a fixed mode is one that none of these moves.  Controllers that vary with time can move some.

The public names are those of ``__init__.pyi``.  Each is loaded when it is first used, so that
importing the package is quick and loads none of the heavy libraries.
"""

import lazy_loader

__version__ = "0.1.0"
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
