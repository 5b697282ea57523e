"""The members of a zip archive, no more of them than a file may have bytes."""

from __future__ import annotations

import io
import zipfile

from mcexact.errors import InputError
from mcexact.exact.rational import Limits
from mcexact.model.names import quoted


def members(data: bytes, limits: Limits) -> dict[str, bytes]:
    """Return the contents of all files in an archive, by name.

    Raises
    ------
    InputError
        If it is damaged or encrypted, names a file twice, or is too large when decompressed.
    """
    found: dict[str, bytes] = {}
    size = 0
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for member in archive.infolist():
                if member.filename.endswith("/"):
                    continue
                if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                    raise InputError(
                        f"the file {quoted(member.filename)} of the archive is compressed in a way "
                        "that is not read: expected 'deflate' or none"
                    )
                if member.filename in found:
                    raise InputError(f"the archive has two files {quoted(member.filename)}")
                with archive.open(member) as stream:
                    content = stream.read(limits.bytes + 1 - size)
                size += len(content)
                if size > limits.bytes:
                    raise InputError(
                        f"expected at most {limits.bytes} bytes when decompressed (Limits.bytes), "
                        "found more"
                    )
                found[member.filename] = content
    except InputError:
        raise
    except Exception as error:  # of zipfile, which raises all kinds for a damaged archive
        said = ascii(str(error))[1:-1][:200] or type(error).__name__
        raise InputError(f"the archive is damaged: {said}") from None
    return found
