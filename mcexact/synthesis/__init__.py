"""Designs: from a system to a controller of m agent programs, and the gate that certifies the loop.

Takes systems and neighbor graphs, gives linear time-invariant controllers together with certified
closed loops, and refuses, with a certificate that says why, what none of these could do.
"""
