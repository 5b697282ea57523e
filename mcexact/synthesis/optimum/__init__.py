"""Controllers of low order by local search, in floating point; the gate certifies them.

All controllers of a structure are the free entries of one gain matrix K, and the loop is M(K) = A +
B K C.  The search minimizes a linear-quadratic cost over these entries, from starts of ascending
order: static gains first, the controller of the theorem last.

================  ====================================================================
`problem`         the structure as a matrix K with a mask, the weights, the counted effort
`figures`         cost, margins and eigenvalues of a loop with gradients; what is aimed at
`starts`          gain matrices from which a search starts
`corners`         plants nearby at which a loop fails first
`descent`         from a start into the region, and to a local optimum
`diagnosis`       figures and curves of any loop, and which rates are affordable
`search`          all starts in their order, and the best results
`continuation`    from a result to another aim: damping, a box, the fastest rate
`proposals`       the best result, rounded for the gate
================  ====================================================================
"""
