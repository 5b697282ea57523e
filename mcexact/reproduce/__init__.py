"""Examination of every statement of the paper, with one module for each section.

This stage gives a finding for every examination of F. Liu, L. Wang, D. Fullmer and A. S. Morse,
*Distributed Feedback Control of Multi-Channel Linear Systems*: the checks, the instances, the
certificates, and the false statements next to it that they refute.  ``ledger.toml`` lists the
examinations, ``statements.toml`` all statements of the paper with what is known of each, and both
name the machine-checked theorems that prove them in general.
"""
