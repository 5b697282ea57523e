"""Designs of controllers with m agent programs, and the gate that certifies closed loops.

This stage takes systems and neighbor graphs, and gives linear time-invariant controllers with
certified closed loops.  If no such controller exists, it raises an error with a certificate that
proves this.  The modules stand here from the gate and the methods to the designers:

======================  ===================================================================
`gate`                  requests, proposals, and the certification of closed loops
`state_feedback`        prescribed spectra, and state feedback that assigns them
`channel_controller`    controllers of a single channel
`networks`              extended, lifted and held systems, as networks of agents
`network_design`        decentralized control of a network, as the theorems construct it
`optimum`               controllers of low order for the same networks, by local search
`observer`              distributed observers with a channel controller (Theorem 1)
`robustness`            how far a plant may differ from its values before a loop fails
`design`                what every designer returns
`rate`                  requests without a rate
`decentralized`         the designers without communication, and with shared sub-states
`distributed_observer`  the designer of distributed observers
`setpoint`              the designer of set-point controllers, with integrators
`certify`               the certification of any controller, and of its rounded entries
`assessment`            whether a person would install a controller
======================  ===================================================================
"""
