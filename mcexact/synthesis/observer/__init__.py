"""Observer-based distributed control: Theorem 1, exactly and in floating point."""
