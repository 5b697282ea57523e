"""The independent checker as one file, which Python runs without anything else."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

FIRST_DAY = (1980, 1, 1, 0, 0, 0)
"""The earliest time of a member, so that the bytes do not depend on when the archive is made."""


def checker_archive() -> bytes:
    """The folder of the checker as an archive that ``python -I`` runs.

    Returns
    -------
    bytes
        The same for the same sources: the members are sorted, not compressed, and have no times.
    """
    from mcexact import checker

    folder, archive = Path(checker.__path__[0]), io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as packed:
        for path in sorted(folder.glob("*.py")):
            member = zipfile.ZipInfo(path.name, FIRST_DAY)
            member.create_system, member.external_attr = 3, 0o644 << 16
            packed.writestr(member, path.read_bytes())
    return archive.getvalue()
