"""A slow second opinion on small systems: every subset of channels, sympy's exact matrices."""
