"""Plots of answers, controllers and trajectories, drawn with matplotlib.

Every function takes ``ax`` (by default it draws on a new figure) and returns the figure.  None uses
pyplot, changes a global setting or shows a window: a figure is shown by a notebook, or saved with
``savefig``.  Pages and ``.plot()`` methods draw with the same functions.  This stage takes plain
numbers and objects with the named attributes, and needs the extra ``plot``.

    >>> import mcexact
    >>> plant = mcexact.gallery("liu2020-3ch-no-communication")
    >>> figure = mcexact.plot.graph(mcexact.transfer_graph(plant))
    >>> figure.savefig("arcs.svg")  # doctest: +SKIP
"""

from mcexact.plot.eigenvalues import eigenvalues as eigenvalues
from mcexact.plot.graphs import fixed_mode as fixed_mode
from mcexact.plot.graphs import gains as gains
from mcexact.plot.graphs import graph as graph
from mcexact.plot.graphs import structure as structure
from mcexact.plot.margins import margins as margins
from mcexact.plot.margins import nyquist as nyquist
from mcexact.plot.margins import step_peaks as step_peaks
from mcexact.plot.parameters import hypersurfaces as hypersurfaces
from mcexact.plot.parameters import parameter_modes as parameter_modes
from mcexact.plot.parameters import uncertainty as uncertainty
from mcexact.plot.parameters import uncertainty_shares as uncertainty_shares
from mcexact.plot.responses import decay as decay
from mcexact.plot.responses import loop as loop
from mcexact.plot.responses import responses as responses
