"""Stage 3: exact decisions about systems.

Each function takes a `MultiChannelSystem`, a plant or one derived from it, and gives an
answer, which holds its proof.  No subset of channels is enumerated.
What decides is arithmetic modulo word-size primes wherever that proves something, and arithmetic
over Q for what a certificate holds; floating point only proposes integer solutions, in allocations.

===============  ==========================================================================
`analyze`        everything that can be asked about one system, each question decided once
`questions`      the table of questions
`accounts`       what has to be shared, told: the least beside the bound, or the links to add
`engine`         what decisions rest on; answers no question
`structure`      controllability, indices, transfer graph, set-points, subsystems
`fixed_modes`    which modes stay, why, and what gains do with the others
`sharing`        what agents must send each other
`stability`      where the eigenvalues of a loop lie
===============  ==========================================================================
"""
