"""Stage 3: exact decisions about systems.

Each function takes a `MultiChannelSystem`, a plant or one derived from it, and gives a frozen
result with the answer in named fields and a ``certificate``.  Nothing here computes in floating
point, and no subset of channels is enumerated: what decides is arithmetic modulo word-size primes
wherever it proves something, and arithmetic over Q for what a certificate holds.
"""
