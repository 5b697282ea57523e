"""Resultants of polynomials in x and t over Q, by flint's polynomials in two variables."""

from __future__ import annotations

from typing import Any

import flint

RING = flint.fmpq_mpoly_ctx.get(("t", "x"), flint.Ordering.lex)


def resultant(f: list[Any], g: list[Any]) -> flint.fmpq_poly:
    """The resultant with respect to x, a polynomial in t."""
    terms: dict[int, Any] = {
        int(i): c for (i, _), c in _joined(f).resultant(_joined(g), "x").to_dict().items()
    }
    return flint.fmpq_poly([terms.get(i, 0) for i in range(max(terms, default=-1) + 1)])


def _joined(f: list[Any]) -> Any:
    """The polynomial with these coefficients of the powers of x, polynomials in t."""
    coefficients = ((i, k, c) for k, part in enumerate(f) for i, c in enumerate(part.coeffs()))
    return RING.from_dict({(i, k): c for i, k, c in coefficients if c != 0})
