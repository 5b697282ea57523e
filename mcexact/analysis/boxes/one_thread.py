"""Floating point for proposals: in one thread, and without warnings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from threadpoolctl import threadpool_limits


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep floating point in one thread, and its overflows silent: what it proposes is tested."""
    with threadpool_limits(1, "blas"), np.errstate(all="ignore"):
        yield
