"""What a system can do at all: controllability, indices, transfer graph, set-points, subsystems."""
