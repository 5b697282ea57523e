"""The least that agents must share, and the links over which."""
