"""The members of a zip archive, no more of them than a file may have bytes."""

from __future__ import annotations

import io
import zipfile
import zlib

from mcexact.errors import InputError
from mcexact.exact.rational import Limits


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
                if member.is_dir():
                    continue
                if member.filename in found:
                    raise InputError(f"the archive has two files {member.filename!a}")
                with archive.open(member) as stream:
                    content = stream.read(limits.bytes + 1 - size)
                size += len(content)
                if size > limits.bytes:
                    raise InputError(
                        f"expected at most {limits.bytes} bytes when decompressed (Limits.bytes), "
                        "found more"
                    )
                found[member.filename] = content
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError) as error:
        raise InputError(f"the archive is damaged: {error}") from None
    return found
