"""Measurements; each file says which question it answers, ``python -m benchmarks`` asks all."""
