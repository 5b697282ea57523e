"""Controllers run as a network of agents, which send messages along the edges of a graph only.

This stage takes a plant, a controller and a neighbor graph, and gives trajectories.  It refuses a
program that uses a signal which its agent does not receive.  No run uses the matrix of the closed
loop, so the tests can compare trajectories with those that this matrix predicts; `simulated_loop`
adds its spectrum to a trajectory.
"""
