"""Exact, certified analysis of multi-channel linear systems.

Controllers are linear and time-invariant here, static or dynamic, and a fixed mode is one that none
of these moves.  Controllers that vary with time can move some fixed modes.

The public names are those of ``__init__.pyi``.  Each is loaded when it is first used, so that
importing the package is fast and loads no large libraries.
"""

import lazy_loader

__version__ = "0.1.0"
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
