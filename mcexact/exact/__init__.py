"""Stage 0: arithmetic over Q, Z/ℓ and Q[x]/(p), and enclosures of roots.

Takes integers, Fractions, Decimals, strings in the written grammar and sympy Rationals.  Gives
immutable matrices and polynomials, exact linear algebra over them, the same modulo word-size
primes, kernels over number fields, discs and intervals around roots, and the exact place of a
polynomial's roots with respect to a stability region.  Refuses floats, except through
`from_float` and `matrix_from_float`, which say how a float is meant.

No other stage imports flint: sizes and moduli that it would abort on are refused here.
"""
