"""Floating-point verdicts beside exact ones: what practice answers, and what is true.

Takes systems; gives tables in which each floating-point verdict is quoted as the library's own call
with its default tolerance.  Refuses nothing: where a library gives no answer, that is the answer.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcexact.crosscheck.table import CrossChecks
    from mcexact.model.system import MultiChannelSystem


class _Stage(ModuleType):
    """This package, which can be called: `mcexact.crosscheck` names the function as well."""

    def __call__(self, system: "MultiChannelSystem") -> "CrossChecks":
        from mcexact.crosscheck.table import crosscheck

        return crosscheck(system)


sys.modules[__name__].__class__ = _Stage
