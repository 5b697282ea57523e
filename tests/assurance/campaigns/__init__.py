"""Long comparisons with slow oracles.

Run one as ``python -m tests.assurance.campaigns.<topic> COUNT SEED``.
"""
