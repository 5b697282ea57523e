"""Stage 1: what things are.  Frozen data, read strictly, written canonically.

Takes files, exact numbers and graphs; gives `MultiChannelSystem`, `NeighborGraph` and `Controller`;
refuses floats that were not let in by name, anything malformed, and says where it is.
"""
