"""Stage 0: arithmetic over Q, Z/ℓ and Q[x]/(p), and enclosures of roots.

Takes integers, Fractions, Decimals, strings in the written grammar and sympy Rationals.  Gives
immutable matrices and polynomials, exact linear algebra over them, the same modulo word-size
primes, kernels over number fields, discs and intervals around roots, and the exact place of a
polynomial's roots with respect to a stability region.  Refuses floats, except through
`from_float` and `matrix_from_float`, which say how a float is meant.

No other stage imports flint: sizes and moduli that it would abort on are refused here.

===================  ==================================================================
`rational`           one number: entries, the written grammar
`matrix`             rational matrices
`rows`               matrices as users hand them over
`blocks`             rational matrices put together from blocks
`linear_algebra`     ranks, kernels, solutions, characteristic polynomials over Q
`polynomial`         rational polynomials
`modular`            matrices and polynomials modulo word-size primes
`krylov`             characteristic polynomials modulo smaller primes, by exact float products
`reconstruction`     rational numbers from their residues
`polynomial_matrix`  matrices of polynomials
`number_field`       kernels and ranks over Q[x]/(p)
`location`           Hurwitz and Schur tests, stability regions
`enclosures`         discs and intervals around roots
`floats`             floats to rational numbers and matrices, and back
===================  ==================================================================
"""
