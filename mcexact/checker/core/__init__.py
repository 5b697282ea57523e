"""The core of the checker: what rests on no other part of it.

Here are the kinds ``fixed_spectrum``, ``controllability``, ``transfer_graph``, ``completeness`` and
``setpoint`` of a plant or of its dual, with the exact arithmetic, the reading of plants and the
evidence that they need.  The core imports the standard library alone.  These are the questions that
``mcexact-verified`` confirms, whose rules are proved down to lists of integers in
``proofs/kernel``; the other kinds build upon the core.
"""
