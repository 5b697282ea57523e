"""Certificates as searches at a limit, or of larger plants, have them.

Their evidence are two polynomials, where the blocks leave more; or their cost has a lower bound.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast
from unittest import mock

from mcexact.analysis.sharing import absence
from mcexact.answer.protocol import Answer, document
from mcexact.answer.sharing import SharedDimensions
from mcexact.derived.constructions import Share, extended_system
from tests.checker.handmade import Document


def by_polynomials(decide: Callable[..., Answer], *arguments: Any, **keywords: Any) -> Document:
    """The certificate of a decision about what agents share."""
    with mock.patch("mcexact.analysis.sharing.free_blocks", return_value=None):
        return document(decide(*arguments, **keywords))


def generous(least: SharedDimensions) -> SharedDimensions:
    """Dimensions that suffice and are one more than the least of each agent, with both bounds.

    The proof that nothing costs less than the least proves the lower bound.
    """
    assert least.dimensions is not None and least.cost is not None
    sizes, share = [k + 1 for k in least.dimensions], cast(Share, least.share)
    larger = extended_system(least.about, sizes, share)
    return replace(
        least,
        dimensions=tuple(sizes),
        cost=least.cost + sum(least.costs),
        at_least=least.cost,
        absence=absence(larger, None, random.Random(1), connected=least.free_assignability),
    )
