"""Floating-point verdicts beside exact ones: what practice answers, and what is true.

Takes systems; gives tables in which each floating-point verdict is quoted as the library's own call
with its default tolerance.  Refuses nothing: where a library gives no answer, that is the answer.
"""
