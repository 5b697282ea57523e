"""The independent checker of certificates, which uses the standard library only.

The checker takes documents of ``mcexact-certificate/1`` and gives verdicts.  It never searches: a
VALID claim follows from equalities that the checker has recomputed, by rules proved in ``proofs/``.
For a manifest (``mcexact-manifest/1``) it states in its own words what the certificates imply.  The
folder ``core`` has what rests on nothing else of it: fixed spectra, controllability, the transfer
graph, completeness and set-points.

The checker shares no code with the rest of mcexact; it can be copied and run with ``python checker
FILE…`` or ``--manifest FOLDER``, and as an archive with ``python -I mcexact-checker.pyz FILE…``.

Importing this package imports nothing of the standard library, and leaves ``sys.path`` alone.
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .core.reading import Limits
    from .kinds import Expectation, Verdict, check_document

__all__ = ["Expectation", "Limits", "Verdict", "check_document"]
_FILES = dict(zip(__all__, ("kinds", "core.reading", "kinds", "kinds"), strict=True))
"""The module of each public name."""


def __getattr__(name: str) -> object:
    """Load a public name when it is first used."""
    if name not in _FILES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(__import__(f"{__name__}.{_FILES[name]}", fromlist=[name]), name)
