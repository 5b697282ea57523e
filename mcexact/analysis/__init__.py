"""Exact decisions about systems.

Each function takes a `MultiChannelSystem`, a plant or one derived from it, and gives an answer,
which is its own certificate.  No subset of channels is enumerated.  Decisions use arithmetic modulo
word-size primes where this suffices for a proof, and arithmetic over Q for the contents of
certificates.  Floating point only proposes integer solutions of covering programs, and Lyapunov
matrices.

===========================  ==============================================================
`analyze`                    all questions about one system, each decided once
`asking`                     which are asked, how long each takes, and what is left open
`questions`                  the table of questions
`parametric_analysis`        the questions that are decided for all values of parameters
`exceptional_hypersurfaces`  what is fixed for several parameters, and where more is
`accounts`                   least dimensions beside the bound, or links to add, in words
`engine`                     the algorithms that several decisions use
`structure`                  controllability, indices, transfer graph, set-points, subsystems
`fixed_modes`                fixed modes, completeness, assignability, and gains
`sharing`                    the least that agents must share
`stability`                  the location of the eigenvalues of a closed loop
===========================  ==============================================================
"""
