"""Exact arithmetic over Q, Z/ℓ and Q[x]/(p), and enclosures of roots.

This stage takes integers, Fractions, Decimals, strings in the grammar of files and sympy Rationals.
It gives immutable matrices and polynomials, exact linear algebra over Q and modulo word-size
primes, kernels over number fields, discs and intervals around roots, and decisions whether the
roots of a polynomial lie in a stability region.  Floats are refused; `from_float` and
`matrix_from_float` convert them explicitly.

No other stage imports flint.  This stage refuses sizes and moduli for which flint would abort.

===================  ==================================================================
`rational`           rational numbers: conversion of entries, the grammar of numbers
`matrix`             rational matrices
`tables`             their numerators: all of them, or those that are not 0
`rows`               conversion of the matrices that Python callers pass
`blocks`             rational matrices assembled from blocks
`linear_algebra`     ranks, kernels, solutions, characteristic polynomials over Q
`polynomial`         rational polynomials
`modular`            matrices and polynomials modulo word-size primes
`krylov`             Krylov sequences modulo smaller primes, by exact float products
`sparse_krylov`      the same for sparse matrices
`recurrence`         least recurrences of sequences modulo primes
`reconstruction`     rational numbers from their residues
`polynomial_matrix`  matrices of polynomials
`field_equations`    linear equations over Q[x]/(p)
`number_field`       kernels and ranks over Q[x]/(p)
`location`           Hurwitz and Schur tests, stability regions
`enclosures`         discs and intervals around roots
`floats`             floats to rational numbers and matrices, and back
===================  ==================================================================
"""
