"""Fixed modes, completeness, assignability, and gains."""
