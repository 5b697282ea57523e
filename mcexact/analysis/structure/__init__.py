"""Structure of a system: controllability, indices, transfer graph, set-points, subsystems."""
