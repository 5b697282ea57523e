"""The independent checker of certificates, which uses the standard library only.

The checker takes documents of ``mcexact-certificate/1`` and gives verdicts.  It never searches: a
VALID claim follows from equalities that the checker has recomputed, by rules proved in ``proofs/``.
For a manifest (``mcexact-manifest/1``) it states in its own words what the certificates imply.  The
folder shares no code with the rest of mcexact; it can be copied and run with ``python -S -E -m
checker FILE…`` or ``--manifest FOLDER``.
"""

from .kinds import Verdict, check_document
from .reading import Limits

__all__ = ["Limits", "Verdict", "check_document"]
