"""Running a controller as a network: one object per agent, messages along edges only.

Takes a plant, a controller and a neighbor graph, gives trajectories, and refuses a program that
asks for a signal which its agent does not receive.  The matrix of the whole loop is never used
here; that it predicts the same trajectory is what the tests compare.
"""
