"""Comparison of floating-point verdicts on structural questions with exact ones.

This stage takes systems and gives tables of verdicts.  Each floating-point verdict comes from a
library's own function at its default tolerance, and the table quotes the call.  No system is
refused: where a library raises an error, the table says that it gives no answer.
"""
