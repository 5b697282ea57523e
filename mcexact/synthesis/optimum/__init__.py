"""Controllers of low order by local search, in floating point; the gate certifies them.

All controllers of a structure are the free entries of one gain matrix K, and the loop is M(K) = A +
B K C.  The search minimizes a linear-quadratic cost over these entries, from starts of ascending
order: static gains first, the controller of the theorem last.

===========  =========================================================================
`problem`    the structure as a matrix K with a mask, the weights, and the counted effort
`figures`    cost, sensitivity and eigenvalues of a loop with gradients; what a search aims at
`starts`     gain matrices from which a search starts
`descent`    from a start into the region, and to a local optimum
`diagnosis`  figures and curves of any loop, and which rates are affordable
`search`     all starts in their order, the best result, and its rounding for the gate
===========  =========================================================================
"""
