"""When and by which version a page was written."""

from __future__ import annotations

import os
from datetime import UTC, datetime

from mcexact import __version__


def stamp(*, dated: bool) -> str:
    """Return the version and the date.

    Parameters
    ----------
    dated : bool
        Whether today's date is given where ``SOURCE_DATE_EPOCH`` is not set.  Pages that promise
        the same bytes on every day are not dated.

    Notes
    -----
    ``SOURCE_DATE_EPOCH`` is the number of seconds since 1970 that reproducible builds agree on.
    """
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if epoch.isascii() and epoch.isdigit():
        return f"mcexact {__version__}, {datetime.fromtimestamp(int(epoch), UTC):%Y-%m-%d}"
    if not dated:
        return f"mcexact {__version__}"
    return f"mcexact {__version__}, {datetime.now(UTC):%Y-%m-%d}"
