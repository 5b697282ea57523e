"""Designs: from a system to a controller of m agent programs, and the gate that certifies the loop.

Takes systems and neighbor graphs, gives controllers together with certified closed loops, and
refuses, with a certificate that says why, what no choice of gains could do.
"""
