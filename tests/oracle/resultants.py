"""Resultants of polynomials in x and t over Q, by flint's polynomials in two variables."""

from __future__ import annotations

from typing import Any

import flint

from mcexact.exact.bivariate import Bivariate, joined


def resultant(f: Bivariate, g: Bivariate) -> flint.fmpq_poly:
    """The resultant with respect to x, a polynomial in t."""
    found: dict[int, Any] = {
        int(i): c for (i, _), c in joined(f).resultant(joined(g), "x").to_dict().items()
    }
    return flint.fmpq_poly([found.get(i, 0) for i in range(max(found, default=-1) + 1)])
