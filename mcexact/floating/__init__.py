"""The questions of `analysis` as practice answers them, in floating point.

Takes and gives numpy arrays of floats.  Nothing exact imports this package: its answers are shown
beside the exact ones, never used for them.
"""
