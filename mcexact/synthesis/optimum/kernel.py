"""Floating-point arithmetic in one thread, without warnings about numbers that are dropped."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from threadpoolctl import threadpool_limits


@contextmanager
def quiet_floats() -> Iterator[None]:
    """Compute in one thread and without warnings.

    For matrices of some hundred rows threads cost more than they bring.  What overflows or is
    nearly singular belongs to controllers that are dropped, or to figures that say so.
    """
    with threadpool_limits(1, "blas"), np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
