"""What evidence is: one frozen dataclass per kind of certificate, and the codec that writes them.

Takes exact objects (matrices, polynomials) from the finder, gives JSON documents in the format of
``FORMAT.md``, and refuses anything that has no exact form.  Pure data: nothing here decides
anything, and nothing of the rest of the package is imported.  One file per kind, named as the kind.
"""

from .codec import digest, document, encode, write
from .evidence import Certificate, RateInterval, RootDisc, ShrunkSubspace, ZeroTransfer

__all__ = [
    "Certificate",
    "RateInterval",
    "RootDisc",
    "ShrunkSubspace",
    "ZeroTransfer",
    "digest",
    "document",
    "encode",
    "write",
]
