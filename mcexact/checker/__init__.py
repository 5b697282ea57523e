"""The independent checker of certificates: standard library only, nothing of the rest of mcexact.

Takes documents of ``mcexact-certificate/1``, gives verdicts, and never searches: what it says is
VALID follows from equalities that it has recomputed, by rules proved in ``proofs/``.  Of a manifest
(``mcexact-manifest/1``) it says what the certificates imply, in its own words.  The folder can be
copied away and run with ``python -S -E -m checker FILE…`` or ``--manifest FOLDER``.
"""

from .kinds import Verdict, check_document
from .reading import Limits

__all__ = ["Limits", "Verdict", "check_document"]
