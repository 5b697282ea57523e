"""Examination of every statement of the paper, with one module for each section.

This stage gives a finding for every statement of F. Liu, L. Wang, D. Fullmer and A. S. Morse,
*Distributed Feedback Control of Multi-Channel Linear Systems*: the checks, the instances, the
certificates, and whether the statement holds.  ``ledger.toml`` lists the statements and names the
machine-checked theorems that prove them in general.
"""
