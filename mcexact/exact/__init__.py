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

from mcexact.exact.blocks import block, block_diagonal, hstack, kronecker, vstack
from mcexact.exact.enclosures import Disc, real_root_intervals, root_discs
from mcexact.exact.floats import (
    dyadic_matrix,
    from_float,
    matrix_from_float,
    matrix_to_float,
    to_float,
)
from mcexact.exact.linear_algebra import (
    characteristic_polynomial,
    column_echelon,
    determinant,
    inverse,
    left_nullspace,
    minimal_polynomial,
    nullspace,
    rank,
    row_echelon,
    solve,
)
from mcexact.exact.location import StabilityRegion, is_hurwitz, is_schur
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    low_rank_update,
    polynomial_residues,
    primes,
    random_matrix,
    residues,
)
from mcexact.exact.number_field import kernel_at
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.rational import (
    DEFAULT_LIMITS,
    Entry,
    Limits,
    as_fraction,
    parse_rational,
    written,
)

__all__ = [
    "DEFAULT_LIMITS",
    "Disc",
    "Entry",
    "Limits",
    "Matrix",
    "ModularMatrix",
    "ModularPolynomial",
    "Polynomial",
    "PolynomialMatrix",
    "StabilityRegion",
    "as_fraction",
    "block",
    "block_diagonal",
    "characteristic_polynomial",
    "column_echelon",
    "determinant",
    "dyadic_matrix",
    "from_float",
    "hstack",
    "inverse",
    "is_hurwitz",
    "is_schur",
    "kernel_at",
    "kronecker",
    "left_nullspace",
    "low_rank_update",
    "matrix_from_float",
    "matrix_to_float",
    "minimal_polynomial",
    "nullspace",
    "parse_rational",
    "polynomial_residues",
    "primes",
    "product",
    "random_matrix",
    "rank",
    "real_root_intervals",
    "residues",
    "root_discs",
    "row_echelon",
    "solve",
    "to_float",
    "vstack",
    "written",
]
