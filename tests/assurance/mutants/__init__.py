"""Mutation testing: every small change of the checker has to make one of its tests fail."""
