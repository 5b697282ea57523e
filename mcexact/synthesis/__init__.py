"""Designs of controllers with m agent programs, and the gate that certifies closed loops.

This stage takes systems and neighbor graphs, and gives linear time-invariant controllers with
certified closed loops.  If no such controller exists, it raises an error with a certificate that
proves this.

======================  ===================================================================
`request`               what is asked of a design
`gate`                  proposals, and the certification of the first loop that holds
`design`                what every designer returns
`methods`               how gains and single controllers are found
`observer`              the distributed observer of Theorem 1
`network`               decentralized control, and control of extended systems
`optimum`               controllers of low order for the same systems, by local search
`asking`                requests without a rate
`decentralized`         control without communication
`extended`              control with shared sub-states
`distributed_observer`  control by a distributed observer
`setpoint`              control to set-points, for the plant with integrators
`certify`               the certification of a controller from anywhere
`assessment`            whether a person would install a controller
======================  ===================================================================
"""
