"""A slow second opinion: every subset of channels, with sympy's exact matrices, on small systems."""
