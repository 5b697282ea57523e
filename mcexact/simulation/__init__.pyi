"""The public names."""

from .envelope import Envelope as Envelope
from .envelope import proved_envelope as proved_envelope
from .network import SignalNotReceived as SignalNotReceived
from .periodic import simulate_periodic as simulate_periodic
from .real import Quantizer as Quantizer
from .real import RealRun as RealRun
from .real import simulate_real as simulate_real
from .trajectory import Trajectory as Trajectory
