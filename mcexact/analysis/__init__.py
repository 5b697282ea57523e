"""Exact decisions about systems.

Each function takes a `MultiChannelSystem`, a plant or one derived from it, and gives an answer,
which is its own certificate.  No subset of channels is enumerated.  Decisions use arithmetic modulo
word-size primes where this suffices for a proof, and arithmetic over Q for the contents of
certificates.  Floating point only proposes what is then verified exactly: integer solutions of
covering programs, Lyapunov matrices, and proofs about boxes.

Functions import numpy, scipy and networkx where they use them: most questions about one system need
none of these, and would wait for them up to half a second.

=================  ============================================================================
`covering`         covering integer programs with a proof of optimality
`lyapunov`         Lyapunov matrices and quadratic forms
`subspaces`        shrunk subspaces, which prove that a mode is fixed, and the search for them
`sparse`           fixed modes, controllability and transfer graphs of large sparse systems
`blocks`           Krylov sequences and blocks of states, which prove that no more is fixed
`parameters`       the same questions for all values of parameters
`controllability`  controllability, observability, their indices, and exceptional gains
`structure`        transfer graph, complementary subsystems, and set-points
`stability`        the location of the eigenvalues of a loop, and its rate
`fixed_modes`      the fixed spectrum, completeness, assignability, and ranks of pencils
`single_channel`   gains with which single channels control and observe
`sharing`          the least that agents must share, and over which links
`boxes`            all plants in a box, or within ranges of parameters
`questions`        the table of questions
`analyze`          all questions about one system, each decided once
=================  ============================================================================
"""
