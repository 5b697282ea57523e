"""Comparison of floating-point verdicts on structural questions with exact ones.

This stage takes systems and gives tables of verdicts.  Each floating-point verdict comes from a
library's own function at its default tolerance, and the table quotes the call.  No system is
refused: where a library raises an error, the table says that it gives no answer.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcexact.crosscheck.table import CrossChecks
    from mcexact.model.system import MultiChannelSystem


class _Stage(ModuleType):
    """A package that can be called, since `mcexact.crosscheck` is also the name of its function."""

    def __call__(self, system: "MultiChannelSystem") -> "CrossChecks":
        from mcexact.crosscheck.table import crosscheck

        return crosscheck(system)


sys.modules[__name__].__class__ = _Stage
