"""Controllers run as a network of agents, which send messages along the edges of a graph only.

This stage takes a plant, a controller and a neighbor graph, and gives trajectories.  It refuses a
program that uses a signal which its agent does not receive.  No run uses the matrix of the closed
loop, so the tests can compare trajectories with those that this matrix predicts; `simulated_loop`
adds its spectrum to a trajectory.

    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> from mcexact.simulation import simulate_real
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> controller = local_controllers(plant, [[["-1/2"]]])
    >>> run = simulate_real(plant, controller, initial=[1], limits=[("-1/4", "1/4")], horizon=9)
    >>> run.inputs[0].at_limit
    3
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
