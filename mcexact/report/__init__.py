"""Display of results as text, JSON, HTML and figures.

This stage takes answers, sentences and trajectories of earlier stages, and decides nothing itself.
"""
