"""Exact arithmetic over Q, Z/ℓ and Q[x]/(p), and enclosures of roots.

This stage takes integers, Fractions, Decimals, strings in the grammar of files and sympy Rationals.
It gives immutable matrices and polynomials, exact linear algebra over Q and modulo word-size
primes, null spaces over number fields, discs and intervals around roots, and decisions whether the
roots of a polynomial lie in a stability region.  Floats are refused; `from_float` and
`matrix_from_float` convert them explicitly.

No other stage imports flint.  This stage refuses sizes and moduli for which flint would abort.

========================  ================================================================
`rational`                rational numbers: conversion of entries, the grammar of numbers
`tables`                  integer numerators: all of them, or those that are not 0
`matrix`                  rational matrices, their blocks, and conversions of floats
`polynomial`              rational polynomials
`modular`                 matrices and polynomials modulo primes, rational reconstruction
`krylov`                  Krylov sequences modulo primes, recurrences, invariant subspaces
`linear_algebra`          ranks, null spaces, solutions over Q, Q[x] and Q[x]/(p)
`balls`                   matrix exponentials and trajectories with errors proved
`rational_functions`      rational functions of parameters, and matrices of them
`bivariate`               routines on polynomials in x and one parameter, as plain data
`parametric_polynomials`  polynomials in x and parameters, their determinants and null spaces
`roots`                   discs around roots, Hurwitz and Schur tests, stability regions
========================  ================================================================
"""
