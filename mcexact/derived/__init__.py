"""Stage 2: systems made from systems.

Takes a `MultiChannelSystem`, and where messages are sent a neighbor graph; gives another
`MultiChannelSystem` that remembers the plant it came from and the constructions on the way, as the
certificate format names them; refuses gains and dimensions of the wrong shape.
"""
