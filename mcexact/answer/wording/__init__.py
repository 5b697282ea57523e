"""The words of every sentence that the commands print about a system, and its theorem."""
