"""Floating-point answers to questions of `analysis`, for comparison.

This stage takes and gives numpy arrays of floats.  No exact decision uses its answers, which are
only shown beside exact ones.
"""
