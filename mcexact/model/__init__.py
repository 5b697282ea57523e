"""Systems, neighbor graphs and controllers: immutable, read strictly and written canonically.

This stage takes files, exact numbers and graphs, and gives `MultiChannelSystem`, `NeighborGraph`
and `Controller`.  It refuses malformed input, and floats unless the caller says how to round them;
the error message names the place.
"""
