"""Controllers of low order by local search, in floating point; the gate certifies them.

All controllers of a structure are the free entries of one gain matrix K, and the loop is
M(K) = A + B K C.  A ladder of starts leads from static gains to the controller of the theorem.

=============  =========================================================================
`aims`         what a search aims at
`weights`      what the cost weighs
`ties`         which entries of K are equal
`problem`      the structure as a matrix K with a mask
`alike`        agents that look alike use the same program
`programs`     gain matrices as agent programs, balanced and rounded
`spectrum`     one Schur form of a loop, and the Gramians of its shifts
`cost`         the linear-quadratic cost with its gradient
`sensitivity`  the response at the inputs of the plant, and the penalty on it
`shape`        how well damped eigenvalues are, and how fast at most
`objective`    cost, barrier of the region, margin, size of the gains and shape
`descent`      the BFGS method, which accepts infinite values
`effort`       the work of a search, counted
`kernel`       one thread, and no warnings about numbers that are dropped
`regulator`    optimal controllers of one channel
`starts`       controllers that each agent designs for itself, and drawn ones
`cuts`         the controller of all agents together, cut to what each agent knows
`alone`        controllers of low order that each agent finds for its own part
`polish`       from a start into the region and to a local optimum
`ladder`       what a search tries and finds, and how it is ranked
`steps`        the starts of each step
`climb`        all steps in their order, to the best result
`figures`      order, gains, margin, peak and cost of a loop; the central optimum
`loop_figures` the same of the controller of any loop, and how far it can be rounded
`curves`       how robust a loop is over the frequency, and how it decays
`structures`   the networks that a search tries
`proposals`    the result with as few digits as the gate certifies
`diagnosis`    the sensible rate, and the modes that are nearly fixed
=============  =========================================================================
"""
