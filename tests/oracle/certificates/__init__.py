"""Whether the claim of a certificate is true, from ``FORMAT.md`` and the definitions alone.

Nothing here imports ``mcexact``.  Ranks, polynomials and enclosures of roots come from
python-flint; what quantifies over subsets, dimensions or links is enumerated.
"""
