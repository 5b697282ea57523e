"""Methods for gains and channel controllers, exact and in floating point.

====================  =====================================================================
`spectrum`            the spectrum of a design, from a rate or as prescribed
`scaled_spectrum`     for a rate, a spectrum near that of what is moved
`state_feedback`      gains for given eigenvalues
`fast_modes`          gains that do not move fast modes
`channel_controller`  a controller at one channel for a given spectrum (Brasch and Pearson)
`channel_parts`       the parts of a loop that single channels control and observe
`riccati`             Riccati equations in floating point
`riccati_channel`     a controller at one channel by Riccati equations
====================  =====================================================================
"""

from mcexact.synthesis.methods.channel_controller import ChannelController, assigning_controllers
from mcexact.synthesis.methods.channel_parts import (
    ChannelReach,
    DrawnGains,
    channel_part,
    drawn_gains,
)
from mcexact.synthesis.methods.fast_modes import feedback_for_region, observable_part
from mcexact.synthesis.methods.riccati import riccati_feedback
from mcexact.synthesis.methods.riccati_channel import riccati_channel_controller
from mcexact.synthesis.methods.scaled_spectrum import scaled_polynomial
from mcexact.synthesis.methods.spectrum import default_polynomial, spectrum_polynomial
from mcexact.synthesis.methods.state_feedback import (
    StateFeedback,
    given_feedback,
    loop_matrix,
    split_by_channel,
    state_feedback,
)

__all__ = [
    "ChannelController",
    "ChannelReach",
    "DrawnGains",
    "StateFeedback",
    "assigning_controllers",
    "channel_part",
    "default_polynomial",
    "drawn_gains",
    "feedback_for_region",
    "given_feedback",
    "loop_matrix",
    "observable_part",
    "riccati_channel_controller",
    "riccati_feedback",
    "scaled_polynomial",
    "spectrum_polynomial",
    "split_by_channel",
    "state_feedback",
]
