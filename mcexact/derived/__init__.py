"""Constructions of systems from systems.

This stage takes a `MultiChannelSystem`, and a neighbor graph if messages are sent.  It gives
another `MultiChannelSystem`, which records its plant and its constructions in the words of the
certificate format.  It refuses gains and dimensions of the wrong shape.
"""
