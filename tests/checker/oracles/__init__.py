"""Slow oracles for the claims of certificates: one module for kinds that belong together.

Each module has ``KINDS``, a mapping of kinds to :class:`tests.checker.mutations.Registration`.
"""
