"""Designs of controllers with m agent programs, and the gate that certifies closed loops.

This stage takes systems and neighbor graphs, and gives linear time-invariant controllers with
certified closed loops.  If no such controller exists, it raises an error with a certificate that
proves this.
"""
