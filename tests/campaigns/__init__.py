"""Long comparisons with slow oracles: ``python -m tests.campaigns.<topic> COUNT SEED``."""
