"""The reports in a real browser: ``make look``."""
