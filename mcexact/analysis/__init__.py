"""Stage 3: exact decisions about systems.

Each function takes a `MultiChannelSystem`, a plant or one derived from it, and gives a frozen
result with the answer in named fields and a ``certificate``.  No subset of channels is enumerated.
What decides is arithmetic modulo word-size primes wherever that proves something, and arithmetic
over Q for what a certificate holds; floating point only proposes integer solutions, in allocations.
"""
