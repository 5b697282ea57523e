"""The location of the eigenvalues of a closed loop, decided exactly."""
