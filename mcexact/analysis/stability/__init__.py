"""Where the eigenvalues of a loop lie, decided exactly."""
