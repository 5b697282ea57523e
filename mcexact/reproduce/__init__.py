"""The paper, reproduced: one module per section, and the ledger of its statements.

Takes nothing from the user, gives a finding for every statement of F. Liu, L. Wang, D. Fullmer and
A. S. Morse, *Distributed Feedback Control of Multi-Channel Linear Systems*: what was checked, on
which instances, with which certificates, and whether it holds.  What is proved in general is said
by ``ledger.toml``, and only where a machine-checked theorem covers the statement.
"""
